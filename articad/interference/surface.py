"""Pieces of a part's surface for a proof: within a cylinder about a joint's axis, outside it, or shrunk by the allowed depth.

Why shrinking proves something: move every vertex of a by at most τ. If the moved surface never meets b, and was not inside it at the
start, then any part of a that is in b lies between the two surfaces, so no point of a is deeper than τ in b.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, cast

import fcl
import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.interference.body import Body, body_of, make_bvh

_SHORTER = 1 - 1e-6  # so that no vertex moves farther than stated, despite rounding


@dataclass(frozen=True, eq=False)
class Surface:
    """Loose triangles in a part's frame.

    Attributes:
        corners: `(T, 3, 3)` [mm].
        body: The body of which it is the whole surface.
    """

    corners: FloatArray
    body: Body | None = None

    @classmethod
    def of(cls, mesh: TriMesh, moved: NDArray[np.float32] | None = None) -> Surface:
        """Return the whole surface with its vertices moved by `(V, 3)` [mm]."""
        return cls((mesh.vertices if moved is None else mesh.vertices + moved)[mesh.triangles])

    @property
    def is_empty(self) -> bool:
        """True if it has no triangles."""
        return not len(self.corners)

    @cached_property
    def points(self) -> FloatArray:
        """Corners without duplicates, `(P, 3)`."""
        return np.unique(self.corners.reshape(-1, 3), axis=0)

    @cached_property
    def box(self) -> tuple[FloatArray, FloatArray]:
        """Centre and half sides of the bounding box, `(3,)` each."""
        flat = self.corners.reshape(-1, 3)  # not `points`, which takes a sort
        low, high = flat.min(axis=0), flat.max(axis=0)
        return (low + high) / 2, (high - low) / 2

    @cached_property
    def standing(self) -> Any:
        """An FCL object at the identity."""
        return fcl.CollisionObject(self._bvh)

    @cached_property
    def moving(self) -> Any:
        """An FCL object that is placed anew for every query."""
        return fcl.CollisionObject(self._bvh)

    @cached_property
    def _bvh(self) -> Any:
        if self.body is not None and not self.body.is_thinned:
            return self.body.bvh
        flat = np.ascontiguousarray(self.corners.reshape(-1, 3))
        return make_bvh(flat, np.arange(len(flat), dtype=np.int64).reshape(-1, 3))


def whole_surface(mesh: TriMesh) -> Surface:
    """Return the whole surface of a mesh; cached, since every pair of the part uses it."""
    surface = mesh.derived.get("surface")
    if surface is None:
        surface = mesh.derived["surface"] = Surface(body_of(mesh).corners, body_of(mesh))
    return cast("Surface", surface)


def inwards(mesh: TriMesh, depth: float, near: Core | None = None, within: float = np.inf) -> NDArray[np.float32]:
    """Return the displacements of vertices inwards by `depth`, only for those `within` a radius of a core, `(V, 3)` [mm].

    They move along the mean of the adjacent faces' unit normals. The mean counts each face once, not weighted by area, so that every
    face at a corner recedes: by depth/√3 at a cube's.
    """
    normals = mesh.normals_of_twice_area
    lengths = np.linalg.norm(normals, axis=1)
    unit = normals / np.where(lengths > 0, lengths, 1.0)[:, None]
    total = np.zeros_like(mesh.vertices)
    corners = mesh.vertices[mesh.triangles]
    for at in range(3):  # weighted by the angle at the corner, so that the triangulation of a face does not matter
        u, v = corners[:, (at + 1) % 3] - corners[:, at], corners[:, (at + 2) % 3] - corners[:, at]
        angle = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v))
        np.add.at(total, mesh.triangles[:, at], unit * angle[:, None])
    size = np.linalg.norm(total, axis=1)
    moved = -depth * total / np.where(size > 0, size, 1.0)[:, None]
    if near is not None:
        moved = np.where((near.radii(mesh.vertices) <= within)[:, None], moved, 0.0)
    return np.asarray(moved * _SHORTER, dtype=np.float32)


def inset_vertices(mesh: TriMesh, depth: float) -> FloatArray:
    """Return the vertices of a mesh, moved inwards by a depth, `(V, 3)` [mm]."""
    return mesh.vertices if depth == 0 else mesh.vertices + inwards(mesh, depth)


class PlacedTriangles:
    """The triangles of parts at one pose, each computed once.

    Args:
        bodies: The parts by name.
        poses: `T_ground_part` of the parts.
    """

    def __init__(self, bodies: Mapping[str, Body], poses: Mapping[str, SE3]) -> None:
        self._bodies, self._poses = bodies, poses
        self._corners: dict[tuple[str, float], FloatArray] = {}

    def triangles(self, part: str, depth: float = 0.0) -> FloatArray:
        """Return the triangles of a part in the ground frame, its surface moved inwards by a depth, `(T, 3, 3)` [mm]."""
        key = (part, depth)
        if key not in self._corners:
            mesh = self._bodies[part].mesh
            self._corners[key] = np.asarray(self._poses[part].apply(inset_vertices(mesh, depth)))[mesh.triangles]
        return self._corners[key]


def split_by_radius(mesh: TriMesh, core: Core, radius: float, edge: float) -> tuple[Surface, Surface, Surface]:
    """Cut a mesh's surface at a cylinder or sphere.

    Triangles that may cross it are quartered until no edge is longer than `edge`.

    Args:
        mesh: In the part's frame.
        core: The axis or centre.
        radius: [mm].
        edge: [mm].

    Returns:
        Triangles inside; those that still cross; those that reach outside, including the crossing ones.
    """
    todo = mesh.vertices[mesh.triangles]
    none = np.empty((0, 3, 3))
    inside, crossing, outside = [none], [none], [none]
    while len(todo):
        local = core.local(todo)
        middle = local.mean(axis=1)
        is_in = (np.linalg.norm(local, axis=2) <= radius).all(axis=1)
        # certainly outside: no point of a triangle is farther from its centre than a corner is
        spread = np.linalg.norm(local - middle[:, None], axis=2).max(axis=1)
        is_out = ~is_in & (np.linalg.norm(middle, axis=1) - spread > radius)
        inside.append(todo[is_in])
        outside.append(todo[is_out])
        mixed = todo[~is_in & ~is_out]
        long = np.linalg.norm(mixed - mixed[:, [1, 2, 0]], axis=2).max(axis=1, initial=0.0) > edge
        crossing.append(mixed[~long])
        todo = quartered(mixed[long])
    seam = np.concatenate(crossing)
    return Surface(np.concatenate(inside)), Surface(seam), Surface(np.concatenate([seam, *outside]))


def quartered(corners: FloatArray) -> FloatArray:
    """Cut each triangle into four at the middles of its edges, `(T, 3, 3)` to `(4T, 3, 3)`."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    return np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])


@dataclass(frozen=True, eq=False)
class Core:
    """The axis or point about which a joint turns.

    Attributes:
        frame: `T_part_axis (4, 4)`: the axis is its z, the point its origin.
        dimensions: 2 measures radii from the axis, 3 from the point.
    """

    frame: FloatArray
    dimensions: int = 2

    def local(self, points: FloatArray) -> FloatArray:
        """Return coordinates in which the radius is the distance from 0, `(…, dimensions)`."""
        return np.asarray((points - self.frame[:3, 3]) @ self.frame[:3, : self.dimensions])

    def radii(self, points: FloatArray) -> FloatArray:
        """Return the radius of each point, `(P,)` [mm]."""
        return np.asarray(np.linalg.norm(self.local(points), axis=-1))

    def heights(self, points: FloatArray) -> tuple[float, float]:
        """Return the smallest and largest coordinate along the axis [mm]."""
        along = (points - self.frame[:3, 3]) @ self.frame[:3, 2]
        return float(along.min()), float(along.max())

    def least_radii(self, corners: FloatArray) -> FloatArray:
        """Return the smallest radius of each triangle `(T, 3, 3)`, `(T,)` [mm]; 0 where the axis pierces it."""
        flat = self.local(corners)
        least = np.full(len(flat), np.inf)
        for at in range(3):
            p, q = flat[:, at], flat[:, (at + 1) % 3]
            edge = q - p
            length = np.einsum("ij,ij->i", edge, edge)
            t = np.clip(-np.einsum("ij,ij->i", p, edge) / np.where(length > 0, length, 1.0), 0.0, 1.0)
            least = np.minimum(least, np.linalg.norm(p + t[:, None] * edge, axis=1))
        return np.asarray(np.minimum(least, _least_within(flat)))


def _least_within(flat: FloatArray) -> FloatArray:
    """Return the distance of 0 from each triangle's interior; infinite if its nearest point is on the edge."""
    a, b, c = flat[:, 0], flat[:, 1], flat[:, 2]
    if flat.shape[2] == 2:
        side = np.stack([p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] for p, q in ((a, b), (b, c), (c, a))])
        return np.asarray(np.where((side > 0).all(axis=0) | (side < 0).all(axis=0), 0.0, np.inf))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    unit = normal / np.where(length > 0, length, 1.0)[:, None]
    offset = np.einsum("ij,ij->i", a, unit)
    foot = offset[:, None] * unit
    inside = np.stack([np.einsum("ij,ij->i", np.cross(q - p, foot - p), unit) >= 0 for p, q in ((a, b), (b, c), (c, a))]).all(axis=0)
    return np.asarray(np.where(inside & (length > 0), np.abs(offset), np.inf))


def surface_distance(a: Surface, b: Surface, T_a_b: FloatArray) -> float:
    """Return the smallest distance of two surfaces [mm], `T_a_b (4, 4)`; infinite when one is empty."""
    if a.is_empty or b.is_empty:
        return float("inf")
    b.moving.setTransform(fcl.Transform(T_a_b[:3, :3], T_a_b[:3, 3]))
    return max(float(fcl.distance(a.standing, b.moving, fcl.DistanceRequest(), fcl.DistanceResult())), 0.0)


def near_by(a: Surface, b: Surface, T_a_b: FloatArray, reach: float) -> Surface:
    """Return the triangles of a that are within `reach` [mm] of b, `T_a_b (4, 4)`."""
    if a.is_empty or b.is_empty:
        return Surface(a.corners[:0])
    points = b.points @ T_a_b[:3, :3].T + T_a_b[:3, 3]
    near = (a.corners.max(axis=1) >= points.min(axis=0) - reach) & (a.corners.min(axis=1) <= points.max(axis=0) + reach)
    rows = np.flatnonzero(near.all(axis=1))
    touching = [row for row in rows if surface_distance(Surface(a.corners[row][None]), b, T_a_b) <= reach]
    return Surface(a.corners[touching])
