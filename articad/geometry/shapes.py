"""Simple closed meshes for users and tests: box, cylinder, tube, sphere."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from articad.arrays import FloatArray
from articad.errors import InvalidSolidError
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive

_BOX_TRIANGLES = np.array(
    [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]],
    dtype=np.int32,
)


def box(sx: float, sy: float, sz: float, *, center: bool = True) -> TriMesh:
    """Return a box with the given sides [mm], centred at the origin or with its lowest corner there."""
    _require_positive(sx=sx, sy=sy, sz=sz)
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=np.float64)
    face = np.repeat(np.arange(6, dtype=np.int32), 2)
    return TriMesh((corners - (0.5 if center else 0.0)) * (sx, sy, sz), _BOX_TRIANGLES, face)


def cylinder(r: float, h: float, segments: int = 64, *, center: bool = True, phase: float = 0.0) -> TriMesh:
    """Return a prism inscribed in a cylinder about z.

    Args:
        r: Radius [mm]; the vertices lie on it.
        h: Height [mm].
        segments: Number of side faces.
        center: Whether the origin is its centre or the centre of its lower face.
        phase: Angle of the first vertex from x [rad].
    """
    _require_positive(r=r, h=h)
    _require_segments(segments)
    bottom, top = (-h / 2, h / 2) if center else (0.0, h)
    ring = _circle(r, segments, phase)
    vertices = np.concatenate([_at_height(ring, bottom), _at_height(ring, top), [[0, 0, bottom], [0, 0, top]]])
    i, j, n = np.arange(segments), (np.arange(segments) + 1) % segments, segments
    side = np.concatenate([np.stack([i, j, n + i], 1), np.stack([j, n + j, n + i], 1)])
    caps = np.concatenate([np.stack([j, i, np.full(n, 2 * n)], 1), np.stack([n + i, n + j, np.full(n, 2 * n + 1)], 1)])
    face = np.repeat(np.array([0, 1, 2], dtype=np.int32), [2 * n, n, n])
    return TriMesh(vertices, np.concatenate([side, caps]).astype(np.int32), face)


def tube(r_inner: float, r_outer: float, h: float, segments: int = 64, *, center: bool = True, phase: float = 0.0) -> TriMesh:
    """Return a tube about z: a prism with a coaxial bore; see `cylinder` for the arguments."""
    _require_positive(r_inner=r_inner, wall=r_outer - r_inner, h=h)
    _require_segments(segments)
    bottom, top = (-h / 2, h / 2) if center else (0.0, h)
    rings = [_at_height(_circle(r, segments, phase), z) for r, z in ((r_outer, bottom), (r_outer, top), (r_inner, top), (r_inner, bottom))]
    i, j, n = np.arange(segments), (np.arange(segments) + 1) % segments, segments
    quads = []
    for ring in range(4):  # outer wall, top, bore, bottom: each joins a ring to the next
        here, there = ring * n, (ring + 1) % 4 * n
        quads += [np.stack([here + i, here + j, there + i], 1), np.stack([here + j, there + j, there + i], 1)]
    face = np.repeat(np.arange(4, dtype=np.int32), 2 * n)
    return TriMesh(np.concatenate(rings), np.concatenate(quads).astype(np.int32), face)


def sphere(r: float, segments: int = 32) -> TriMesh:
    """Return a sphere of `segments` meridians and half as many bands, its vertices on the radius [mm]."""
    _require_positive(r=r)
    _require_segments(segments)
    bands = max(segments // 2, 2)
    return _round_ended(r, 0.0, np.pi * np.arange(1, bands) / bands, segments)


def capsule(r: float, length: float, segments: int = 32) -> TriMesh:
    """Return a cylinder along z with a hemisphere on each end, its vertices on the surface.

    Args:
        r: Radius [mm].
        length: Distance of the centres of the two spheres [mm].
        segments: Meridians; a hemisphere has a quarter as many bands.
    """
    _require_positive(r=r, length=length)
    _require_segments(segments)
    quarter = max(segments // 4, 1)
    polar = np.pi / 2 * np.arange(1, quarter + 1) / quarter
    return _round_ended(r, length, np.concatenate([polar, np.pi - polar[::-1]]), segments)


def primitive_mesh(form: Primitive) -> TriMesh:
    """Return the mesh of a primitive [mm], the same for every reader.

    Raises:
        InvalidSolidError: If a size is not a positive length.
    """
    if form.kind == "ellipsoid":
        a, b, c = form.size
        _require_positive(a=a, b=b, c=c)
        ball = sphere(1.0)
        return TriMesh(ball.vertices * (a, b, c), ball.triangles)
    makers: dict[str, Callable[..., TriMesh]] = {"box": box, "sphere": sphere, "cylinder": cylinder, "capsule": capsule}
    return makers[form.kind](*form.size)


def _round_ended(r: float, length: float, polar: FloatArray, segments: int) -> TriMesh:
    """Return rings at angles from the north pole on a sphere that is cut at the equator and separated by `length`."""
    bands = len(polar) + 1
    half = np.where(np.arange(len(polar)) < len(polar) / 2, length / 2, -length / 2)
    rings = [_at_height(_circle(r * np.sin(angle), segments, 0.0), r * np.cos(angle) + up) for angle, up in zip(polar, half, strict=True)]
    vertices = np.concatenate([*rings, [[0, 0, r + length / 2], [0, 0, -r - length / 2]]])
    i, j, n = np.arange(segments), (np.arange(segments) + 1) % segments, segments
    north, south = len(vertices) - 2, len(vertices) - 1
    triangles = [np.stack([i, j, np.full(n, north)], 1)]
    for band in range(bands - 2):
        upper, lower = band * n, (band + 1) * n
        triangles += [np.stack([lower + i, lower + j, upper + i], 1), np.stack([lower + j, upper + j, upper + i], 1)]
    last = (bands - 2) * n
    triangles.append(np.stack([last + j, last + i, np.full(n, south)], 1))
    return TriMesh(vertices, np.concatenate(triangles).astype(np.int32), None)


def _circle(r: float, segments: int, phase: float) -> FloatArray:
    angle = phase + 2 * np.pi * np.arange(segments) / segments
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)


def _at_height(ring: FloatArray, z: float) -> FloatArray:
    return np.concatenate([ring, np.full((len(ring), 1), z)], axis=1)


def _require_positive(**lengths: float) -> None:
    for name, length in lengths.items():
        if not (np.isfinite(length) and length > 0):
            raise InvalidSolidError(f"{name} must be a positive length, not {length}.", status="size")


def _require_segments(segments: int) -> None:
    if segments < 3:
        raise InvalidSolidError(f"A round shape needs at least 3 segments, not {segments}.", status="size")
