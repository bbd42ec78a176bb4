"""A convex piece as an intersection of half-spaces, and as a mesh or a primitive."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import manifold3d
import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.inscribed.surface import INSIDE_MM, mesh_of, steady
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive
from articad.geometry.shapes import box, sphere

_MOST_CORNERS = 64  # of a piece: the limit of PhysX
DIGITS = 6  # digits of mm in a piece's corners
_WEDGE = 1e-6  # squared sine of the smallest angle of two planes that form a wedge: normals of one face differ by rounding
_TIE_MM = 1e-3  # heights above planes of one face differ by less: its corners are rounded
_FLAT = 1e-5  # a box that is thinner than this share of its length has no certain axes


@dataclass(frozen=True, eq=False)
class Piece:
    """A convex piece of a solid.

    Attributes:
        mesh: In the piece's own frame [mm].
        frame: Pose of that frame in the solid's.
        primitive: The primitive that the mesh represents, or None.
    """

    mesh: TriMesh
    frame: SE3
    primitive: Primitive | None


@dataclass(frozen=True, eq=False)
class Grown:
    """A piece as an intersection of half-spaces.

    Attributes:
        planes: Those that bound it, `(K, 4)`, n·x ≤ d.
        piece: The piece.
        volume: Its volume [mm³].
        grown: All planes around the seed: each triangle is beyond one of them. Empty for recognised bodies.
        seed: A point inside [mm].
    """

    planes: FloatArray
    piece: Piece
    volume: float
    grown: FloatArray
    seed: FloatArray

    def distance(self, points: FloatArray) -> FloatArray:
        """Return a lower bound of the distance of points from the piece, `(M,)` [mm]: from the wedges of two planes.

        A point at heights h and k above two planes with c = n·m, and above both edges of the nearest point's normal cone, is at the
        distance √((h² + k² − 2chk) / (1 − c²)) from their wedge (Karush-Kuhn-Tucker with both multipliers positive).
        """
        heights = points @ self.planes[:, :3].T - self.planes[:, 3]
        top = heights.max(axis=1, keepdims=True)
        first = (heights > np.maximum(top - _TIE_MM, np.where(top > 0, 0.0, -np.inf))).argmax(axis=1)  # the first of nearly equal ones
        h = heights[np.arange(len(points)), first]
        outside = np.flatnonzero(h > 0)
        far = h.copy()
        if len(outside):
            cosines = self.planes[:, :3] @ self.planes[:, :3].T
            steep = np.where(1 - cosines * cosines > _WEDGE, cosines, np.inf)  # parallel planes form no wedge
            rows, second = np.nonzero(heights[outside] > steep[first[outside]] * h[outside, None])
            points_of = outside[rows]
            one, other, c = h[points_of], heights[points_of, second], cosines[first[points_of], second]
            squares = h[outside] ** 2
            np.maximum.at(squares, rows, (one * one + other * other - 2 * c * one * other) / (1 - c * c))
            far[outside] = np.sqrt(squares)
        return steady(far)


def polytope(planes: FloatArray, seed: FloatArray) -> Grown | None:
    """Return the intersection of half-spaces around a seed as a mesh, with only the planes that bound it; None if it is too thin."""
    if ((planes[:, :3] @ seed - planes[:, 3]) >= -1e-6).any():
        return None
    try:
        corners = HalfspaceIntersection(np.column_stack([planes[:, :3], -planes[:, 3]]), seed).intersections
        corners = np.unique(np.round(corners[np.isfinite(corners).all(axis=1)], DIGITS) + 0.0, axis=0)
        hull = ConvexHull(corners)
    except QhullError:
        return None
    mesh = _tidy(manifold3d.Manifold.hull_points(corners[np.sort(hull.vertices)]))
    if mesh is None:
        return None
    bounding = np.unique(np.round(np.column_stack([hull.equations[:, :3], -hull.equations[:, 3]]), 9), axis=0)
    boxed = _as_box(mesh)
    return Grown(bounding, Piece(mesh, SE3.identity(), None) if boxed is None else boxed, mesh.volume, planes, seed)


def fewer_corners(one: Grown) -> Grown:
    """Return the hull of a few of a piece's corners: the farthest ones, then repeatedly the one farthest from the hull so far."""
    corners = one.piece.mesh.vertices
    if one.piece.primitive is not None or len(corners) <= _MOST_CORNERS:
        return one
    directions = sphere(1.0, 4).vertices
    chosen = list(dict.fromkeys(steady(corners @ directions.T).argmax(axis=0).tolist()))
    planes = np.zeros((0, 4))
    while len(chosen) < _MOST_CORNERS:
        hull = ConvexHull(corners[chosen])
        planes = np.column_stack([hull.equations[:, :3], -hull.equations[:, 3]])
        heights = steady(corners @ planes[:, :3].T - planes[:, 3]).max(axis=1)
        if heights.max() <= 10.0**-DIGITS:
            break
        chosen.append(int(heights.argmax()))
    mesh = _tidy(manifold3d.Manifold.hull_points(corners[sorted(chosen)]))
    return one if mesh is None else replace(one, planes=planes, piece=Piece(mesh, SE3.identity(), None), volume=mesh.volume)


def _tidy(solid: manifold3d.Manifold) -> TriMesh | None:
    mesh = mesh_of(solid)
    return mesh if mesh.is_closed and mesh.volume > 0 else None


def _as_box(mesh: TriMesh) -> Piece | None:
    """Return a hull as a box if it is one: eight corners whose edges at one of them are perpendicular."""
    corners = mesh.vertices
    if len(corners) != 8:
        return None
    first = corners[0]
    ways = corners[1:] - first
    size = float(np.abs(ways).max())
    for i, j, k in combinations(range(7), 3):
        a, b, c = ways[[i, j, k]]
        if min(np.linalg.norm(a), np.linalg.norm(b), np.linalg.norm(c)) < _FLAT * size:
            return None
        if max(abs(a @ b), abs(b @ c), abs(a @ c)) > 1e-7 * size * size:
            continue
        wanted = np.array([a + b, a + c, b + c, a + b + c])
        if all(float(np.abs(ways - one).max(axis=1).min()) <= 1e-6 * size for one in wanted):
            made = _box_piece(first, np.array([a, b, c]))
            off = np.linalg.norm(made.frame.apply(made.mesh.vertices)[:, None] - corners, axis=2).min(axis=1)
            return made if float(off.max()) <= INSIDE_MM / 2 else None  # of a large hull, corners may lie farther off
    return None


def _box_piece(first: FloatArray, edges: FloatArray) -> Piece:
    """Return the box spanned by a corner and three edges; its axes are those of the solid's frame if they agree."""
    lengths = np.linalg.norm(edges, axis=1)
    axes = edges / lengths[:, None]
    order, free, sizes = [], [0, 1, 2], steady(np.abs(axes))
    for axis in range(2):
        best = max(free, key=lambda index: float(sizes[index, axis]))
        free.remove(best)
        order.append(best)
    order += free
    axes, lengths = axes[order], lengths[order]
    for index in (0, 1):
        if axes[index][int(steady(np.abs(axes[index])).argmax())] < 0:
            axes[index] = -axes[index]
    x, z = whole(axes[0]), whole(np.cross(axes[0], axes[1]))
    middle = first + edges.sum(axis=0) / 2
    sides = tuple(float(side) for side in np.round(lengths, DIGITS))
    frame = SE3.from_axes(np.round(middle, DIGITS) + 0.0, z, x)
    return Piece(box(*sides), frame, Primitive("box", sides))


def whole(axis: FloatArray) -> FloatArray:
    """Return a unit vector with components near 0 or ±1 set to these values."""
    rounded = np.round(axis)
    return np.asarray(rounded if float(np.abs(axis - rounded).max()) < 1e-9 else axis) + 0.0
