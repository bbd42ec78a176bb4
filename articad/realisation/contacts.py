"""Pairs of faces that face each other closely: pin and bore, ball and socket, plane and plane, pin and flat.

A pair limits the motion of the child at points p where both faces overlap. With n the direction from the child's surface to the parent's and
g ≥ 0 their distance, a small motion with velocity v at p is possible only while n·v ≤ g. Normals and distances come from the
surfaces themselves, and the mesh only states where each face ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from articad.arrays import BoolArray, FloatArray, IntArray
from articad.connectors.quaternion import cross
from articad.geometry.faces import Face
from articad.realisation.bores import TILT
from articad.realisation.sides import PartFace, Sides, boxes

__all__ = ["FaceReach", "Pair", "PairKind", "pairs"]

PairKind = Literal["pin in bore", "ball in socket", "face to face", "pin on flat"]

PRESS_MM: Final = 0.06  # by which two surfaces may overlap: a press fit, or the rounding of a model
_POINTS: Final = 48  # of a face's area, and as many of its corners
_INWARD: Final = 0.02  # by which corners are drawn towards the middle of their triangle
_AROUND, _LEVELS, _EXTREMES = 36, 7, 16  # points around a cylinder, along it or across a plane, and those kept of a plane
_FEW: Final = 64  # triangles that are compared with all points
_EDGE: Final = 1e-6  # of barycentric coordinates
_NAMES: Final[dict[tuple[str, str], PairKind]] = {
    ("cylinder", "cylinder"): "pin in bore",
    ("sphere", "sphere"): "ball in socket",
    ("plane", "plane"): "face to face",
    ("cylinder", "plane"): "pin on flat",
    ("plane", "cylinder"): "pin on flat",
}


class FaceReach(NamedTuple):
    """How far two surfaces may be apart and still make a joint [mm].

    Attributes:
        flat: For planes.
        round: For cylinders and spheres, at least.
        share: For these, the same as a share of the radius, if that is more.
    """

    flat: float
    round: float
    share: float

    def of(self, a: Face, b: Face) -> float:
        """Return the reach for two faces [mm]."""
        if a.kind == b.kind == "plane":
            return self.flat
        return max(self.round, self.share * min(radius for radius in (a.radius, b.radius) if radius > 0))


class Pair(NamedTuple):
    """Two faces that face each other.

    Attributes:
        kind: What they are.
        parts: The parts, on the parent's side and on the child's.
        faces: The two faces in that order.
        points: Where they overlap, `(N, 3)` [mm].
        normals: From the child's surface to the parent's, `(N, 3)`.
        gaps: Distances there, `(N,)` [mm].
        play: Difference of the radii, or the distance of the planes [mm].
        grazing: Cosine of normal and direction up to which a round body slips past a contact, although it is slightly in its way.
    """

    kind: PairKind
    parts: tuple[str, str]
    faces: tuple[Face, Face]
    points: FloatArray
    normals: FloatArray
    gaps: FloatArray
    play: float
    grazing: float


def pairs(sides: Sides, reach: FaceReach) -> list[Pair]:
    """Return all pairs of faces of the two sides that face each other within reach."""
    first, second = ([one for one in side if one.face.kind != "other"] for side in sides)
    if not first or not second:
        return []
    (low_a, high_a), (low_b, high_b) = boxes(first), boxes(second)
    margin = max(reach.flat, reach.round, reach.share * max(one.face.radius for one in (*first, *second)))
    near = ((low_a[:, None] <= high_b[None] + margin) & (low_b[None] <= high_a[:, None] + margin)).all(axis=2)
    found = (_pair(first[i], second[j], reach.of(first[i].face, second[j].face)) for i, j in np.argwhere(near & _matching(first, second)))
    return [pair for pair in found if pair is not None]


def _matching(first: Sequence[PartFace], second: Sequence[PartFace]) -> BoolArray:
    """Return which faces may be a pair by their kinds and directions, `(F, G)`."""
    kinds = np.array([[(a.face.kind, b.face.kind) in _NAMES for b in second] for a in first])
    hollow = np.array([[one.face.hollow for one in side] for side in (first, second)], dtype=object)
    axes = [np.array([one.face.axis for one in side]) for side in (first, second)]
    planes = [np.array([one.face.kind == "plane" for one in side]) for side in (first, second)]
    spheres = [np.array([one.face.kind == "sphere" for one in side]) for side in (first, second)]
    along = axes[0] @ axes[1].T
    inside = np.array(hollow[0], dtype=bool)[:, None] != np.array(hollow[1], dtype=bool)[None]
    solid = ~np.array(hollow[0], dtype=bool)[:, None] & ~np.array(hollow[1], dtype=bool)[None]
    both_planes = planes[0][:, None] & planes[1][None]
    one_plane = planes[0][:, None] ^ planes[1][None]
    both_spheres = spheres[0][:, None] & spheres[1][None]
    parallel = np.abs(along) >= 1 - TILT**2 / 2
    fits = np.where(both_planes, along <= -1 + TILT**2 / 2, np.where(one_plane, solid & (np.abs(along) <= TILT), inside & parallel))
    return np.asarray(kinds & np.where(both_spheres, inside, fits))


def _pair(a: PartFace, b: PartFace, reach: float) -> Pair | None:
    """Return a pair of faces of the parent and of the child if they overlap within reach."""
    parent, child = a.face, b.face
    if parent.kind != "plane" and child.kind != "plane" and not _centred(parent, child, reach):
        return None
    points = _candidates(parent, child)
    normals = _towards_parent(parent, child, points)
    gaps = _height(parent, points, normals) - _height(child, points, normals)
    kept = (gaps >= -PRESS_MM) & (gaps <= reach)
    points, normals, gaps = points[kept], normals[kept], gaps[kept]
    for face in (parent, child):
        inside = _hits(face, points, normals, reach + PRESS_MM + 0.1 * face.radius)
        points, normals, gaps = points[inside], normals[inside], gaps[inside]
    if not len(points):
        return None
    kind = _NAMES[parent.kind, child.kind]
    chosen = _outermost(points, normals, parent, kind)
    points, normals, gaps = points[chosen], normals[chosen], np.maximum(gaps[chosen], 0.0)
    if "plane" in (parent.kind, child.kind):
        return Pair(kind, (a.part, b.part), (parent, child), points, normals, gaps, float(gaps.min()), 0.0)
    play = abs(parent.radius - child.radius)
    return Pair(
        kind, (a.part, b.part), (parent, child), points, normals, gaps, play, grazing=_grazing(play, min(parent.radius, child.radius))
    )


def _grazing(play: float, radius: float) -> float:
    """Return the cosine up to which a round body slips past an edge of the surface about it.

    The edge whose normal has the cosine s with the way out is at (r + g) (1 - s²)^½ from the middle, and is in the way if that is less than
    r: s² > 2 g / r, where g is small beside r.
    """
    return float(min(1.0, np.sqrt(2 * play / radius)))


def _candidates(parent: Face, child: Face) -> FloatArray:
    """Return points at which two faces may overlap, `(N, 3)` [mm]."""
    if parent.kind == child.kind == "cylinder":
        return _rings(parent, child)
    if parent.kind == child.kind == "plane":
        return _grid(parent, child)
    if parent.kind == child.kind:
        return _samples(min(parent, child, key=lambda face: float(np.linalg.norm(np.ptp(face.corners, axis=(0, 1))))))
    return _line(parent, child)


def _rings(parent: Face, child: Face) -> FloatArray:
    """Return points of the child's cylinder over the height that both have."""
    heights = [(face.corners.reshape(-1, 3) - child.point) @ child.axis for face in (parent, child)]
    low, high = max(h.min() for h in heights), min(h.max() for h in heights)
    if low >= high:
        return np.zeros((0, 3))
    x = np.cross(np.eye(3)[int(np.abs(child.axis).argmin())], child.axis)
    x /= np.linalg.norm(x)
    y = np.cross(child.axis, x)
    angles = 2 * np.pi * (np.arange(_AROUND) + 0.5) / _AROUND
    ring = child.radius * (np.cos(angles)[:, None] * x + np.sin(angles)[:, None] * y)
    shares = np.concatenate([[1e-3], (np.arange(_LEVELS) + 0.5) / _LEVELS, [1 - 1e-3]])
    levels = (low + shares * (high - low))[:, None] * child.axis
    return np.asarray((child.point + ring[:, None] + levels[None]).reshape(-1, 3))


def _grid(parent: Face, child: Face) -> FloatArray:
    """Return points of the child's plane in the rectangle that both faces have, and the corners of both."""
    x = np.cross(np.eye(3)[int(np.abs(child.axis).argmin())], child.axis)
    x /= np.linalg.norm(x)
    frame = np.stack([x, np.cross(child.axis, x)])
    flat = [(face.corners.reshape(-1, 3) - child.point) @ frame.T for face in (parent, child)]
    low, high = (np.max([f.min(axis=0) for f in flat], axis=0), np.min([f.max(axis=0) for f in flat], axis=0))
    if (low >= high).any():
        return np.zeros((0, 3))
    shares = np.concatenate([[1e-3], (np.arange(_LEVELS) + 0.5) / _LEVELS, [1 - 1e-3]])
    u, v = np.meshgrid(*(low[k] + shares * (high[k] - low[k]) for k in (0, 1)))
    inner = np.stack([u.ravel(), v.ravel()], axis=1)
    ends = [(face.corners + _INWARD * (face.corners.mean(axis=1, keepdims=True) - face.corners)).reshape(-1, 3) for face in (parent, child)]
    corners = np.concatenate([end[:: max(1, len(end) // _POINTS)] for end in ends])
    return np.asarray(np.concatenate([inner, (corners - child.point) @ frame.T]) @ frame + child.point)


def _outermost(points: FloatArray, normals: FloatArray, face: Face, kind: PairKind) -> IntArray:
    """Return the indices of the contacts that decide: a contact between two others with the same normal adds nothing."""
    if kind == "face to face":
        x = np.cross(np.eye(3)[int(np.abs(face.axis).argmin())], face.axis)
        angles = 2 * np.pi * np.arange(_EXTREMES) / _EXTREMES
        ways = np.cos(angles)[:, None] * x + np.sin(angles)[:, None] * np.cross(face.axis, x)
        return np.unique((points @ ways.T).argmax(axis=0))
    if kind == "pin in bore":
        heights = points @ face.axis
        _, group = np.unique(np.round(normals, 6), axis=0, return_inverse=True)
        order = np.lexsort((heights, group.ravel()))
        ends = np.flatnonzero(np.diff(group.ravel()[order])) + 1
        return np.unique(np.concatenate([order[np.concatenate([[0], ends])], order[np.concatenate([ends - 1, [len(order) - 1]])]]))
    return np.arange(len(points))


def _centred(a: Face, b: Face, reach: float) -> bool:
    """Return whether two cylinders or spheres are one inside the other, within reach."""
    bore, pin = (a, b) if a.hollow else (b, a)
    play = bore.radius - pin.radius
    if not -PRESS_MM <= play <= reach:
        return False
    apart = pin.point - bore.point
    apart = apart - (apart @ bore.axis) * bore.axis  # of spheres, the axis is zero
    return float(np.linalg.norm(apart)) <= max(play, 0.0) + PRESS_MM


def _samples(face: Face) -> FloatArray:
    """Return points of a face, `(N, 3)` [mm]: evenly over its area, and next to corners of its triangles."""
    corners = face.corners
    middles = corners.mean(axis=1, keepdims=True)
    areas = np.linalg.norm(face.normals_of_twice_area, axis=1)
    count = np.arange(_POINTS)
    chosen = np.minimum(np.searchsorted(np.cumsum(areas) / max(areas.sum(), 1e-300), (count + 0.5) / _POINTS), len(areas) - 1)
    s, t = (count * 0.7548776662466927) % 1, (count * 0.5698402909980532) % 1  # the plastic number: evenly in the unit square
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    a, b, c = (corners[chosen, k] for k in range(3))
    inner = a + s[:, None] * (b - a) + t[:, None] * (c - a)
    ends = (corners + _INWARD * (middles - corners)).reshape(-1, 3)
    points = np.concatenate([inner, ends[:: max(1, len(ends) // _POINTS)]])
    if face.kind == "plane":
        return np.asarray(points - ((points - face.point) @ face.axis)[:, None] * face.axis)
    away = points - face.point
    flat = away - (away @ face.axis)[:, None] * face.axis
    return np.asarray(points + (face.radius / np.maximum(np.linalg.norm(flat, axis=1), 1e-12) - 1)[:, None] * flat)


def _line(a: Face, b: Face) -> FloatArray:
    """Return points of a cylinder where it comes next to a plane, `(N, 3)` [mm]."""
    pin, plane = (a, b) if a.kind == "cylinder" else (b, a)
    heights = (pin.corners.reshape(-1, 3) - pin.point) @ pin.axis
    low, high = float(heights.min()), float(heights.max())
    shares = (np.arange(_POINTS // 4) + 0.5) / (_POINTS // 4)
    return np.asarray(pin.point + (low + shares * (high - low))[:, None] * pin.axis - pin.radius * plane.axis)


def _towards_parent(parent: Face, child: Face, points: FloatArray) -> FloatArray:
    """Return the directions from the child's surface to the parent's, `(N, 3)`."""
    if child.kind == "plane":
        return np.broadcast_to(child.axis, points.shape)
    if parent.kind == "plane":
        return np.broadcast_to(-parent.axis, points.shape)
    away = points - child.point
    away = away - (away @ child.axis)[:, None] * child.axis
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
    return np.asarray(-away if child.hollow else away)


def _height(face: Face, points: FloatArray, ways: FloatArray) -> FloatArray:
    """Return how far along their directions a face is from points, `(N,)` [mm]."""
    away = points - face.point
    if face.kind == "plane":
        return np.asarray(-(away @ face.axis) / (ways @ face.axis))
    flat = away - (away @ face.axis)[:, None] * face.axis
    outward = (flat * ways).sum(axis=1)  # of one sign for all points
    distance = np.linalg.norm(flat, axis=1)
    return np.asarray(np.sign(outward) * (face.radius - distance))


def _hits(face: Face, points: FloatArray, ways: FloatArray, limit: float) -> BoolArray:
    """Return which lines through points along their directions meet a face's triangles within a distance, `(N,)`.

    Möller and Trumbore (1997): with edges e1, e2 and s = p - a, the line meets the triangle at the barycentric coordinates
    u = s·(d x e2) / det, v = d·(s x e1) / det, at the distance t = e2·(s x e1) / det, with det = e1·(d x e2).
    """
    if not len(points):
        return np.zeros(0, dtype=bool)
    which, triangle = _close(face.corners, points, limit)
    a, b, c = (face.corners[triangle, k] for k in range(3))
    e1, e2, d, s = b - a, c - a, ways[which], points[which] - a
    across, turned = cross(d, e2), cross(s, e1)
    det = (e1 * across).sum(axis=1)
    det = np.where(np.abs(det) > 1e-12, det, np.inf)
    u, v, t = (s * across).sum(axis=1) / det, (d * turned).sum(axis=1) / det, (e2 * turned).sum(axis=1) / det
    met = (u >= -_EDGE) & (v >= -_EDGE) & (u + v <= 1 + _EDGE) & (np.abs(t) <= limit) & np.isfinite(det)
    return np.asarray(np.bincount(which[met], minlength=len(points)) > 0)


def _close(corners: FloatArray, points: FloatArray, limit: float) -> tuple[IntArray, IntArray]:
    """Return the pairs of a point and a triangle that may be within a distance, as indices `(K,)` each."""
    if len(corners) <= _FEW:
        which, triangle = np.divmod(np.arange(len(points) * len(corners)), len(corners))
        return which, triangle
    middles = corners.mean(axis=1)
    reach = limit + float(np.linalg.norm(corners - middles[:, None], axis=2).max())
    lists = cKDTree(middles).query_ball_point(points, reach)
    which = np.repeat(np.arange(len(points)), [len(one) for one in lists])
    return which, np.concatenate([np.asarray(one, dtype=np.int64) for one in lists])
