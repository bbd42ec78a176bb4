"""Convex pieces inside a solid: collision shapes that touch nothing that the solid does not touch.

Each piece is an intersection of half-spaces, grown around a seed point. For each triangle of the surface, some plane of the piece has
the whole triangle on its far side. So no surface point is inside the piece. The piece is connected and its seed is inside the solid,
hence so is the piece.

1. Seeds: from points of the surface, half-way through the material along the inward normal. The whole surface must enclose them: its
winding number about a seed is at least 1. So surfaces that cross or repeat themselves have pieces only where they enclose material.
2. Growth (as in IRIS, Deits and Tedrake 2015, without the ellipsoid): the triangle nearest to the seed gives a plane, all triangles
beyond that plane are done, and so on until none is left. The plane is the triangle's own one, so that flat faces are exact and bores get
tangent planes, or else the plane through its nearest point. In front of convex round surfaces the plane moves inwards a little, so that
one plane serves many facets.
3. Choice: the next seeds belong to the surface point that is farthest from all pieces, until each is within the bound. All pieces that
were ever grown are candidates, and the one that covers most points is taken. If there are too many, a greedy set cover chooses among all
candidates, for the least bound that the permitted number of pieces reaches.

Balls and cylinders are recognised by their faces and used whole if they lie inside; pieces with six perpendicular planes are boxes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final

import manifold3d
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.faces import smooth_patches
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive
from articad.geometry.shapes import box, cylinder, sphere
from articad.geometry.winding import winding_numbers

__all__ = ["INSIDE_MM", "MOST_PIECES", "Inscribed", "Piece", "inscribed", "missing_bound"]


MOST_PIECES: Final = 32
BOUND_MM, BOUND_SHARE = 0.5, 0.01  # how far the solid may extend beyond its pieces: the larger of the two; the share is of its diagonal
INSIDE_MM: Final = 1e-4  # by which rounding may move a piece outside the mesh
SCHEME: Final = "articad.inscribed/3"  # must change with anything that changes pieces

_SLACK_MM, _SLACK_SHARE = 0.25, 0.004  # how far a plane may move inwards: the larger of the two; the share is of the diagonal
_SLACKS = (0.0, 0.04, 0.25, 0.5, 1.0)  # of that: the values that are tried
_OF_DEPTH = 0.5  # of the material below a point: at thin walls, less may be missing
_MOST_CORNERS = 64  # of a piece: the limit of PhysX
_SAMPLES = 800  # points of the surface at which the pieces are measured, and half as many corners
_COARSE_TRIANGLES = 3000  # of a mesh in which pieces are grown; a finer one is simplified first
_SIMPLIFY = 0.1  # of the bound: deviation of the surface by simplification
_ROUND = 6  # digits of mm in a piece's corners
_OWN = 0.3  # a triangle's own plane is used if its distance from the seed is at least this share of the triangle's
_MUCH = 0.2  # of the uncovered points: a recognised body that covers this share is used at once
_TRIES = 3  # points whose seeds are tried for each piece
_DEPTHS = (0.5, 0.15, 0.85)  # of the material below a point: where seeds are tried, until a piece covers it
_TIGHTER = (1.0, 0.4, 0.1)  # of the slack, in the same tries
_SURPLUS = 2  # multiple of the permitted number of pieces that are collected before a choice among them
_RELAXED = 1.1  # ratio of successive bounds that are tried, if there are too few pieces
_SEGMENTS = 48  # in the meshes of recognised cylinders
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
class Inscribed:
    """The pieces of a solid and how much of it they omit.

    Attributes:
        pieces: Convex pieces; they may overlap.
        missing: Largest distance of a sampled surface point of the solid from the nearest piece [mm].
        bound: The requested bound of that distance [mm].
        less: Volume of the solid that no piece covers, as a share of the solid's.
    """

    pieces: tuple[Piece, ...]
    missing: float
    bound: float
    less: float


def missing_bound(mesh: TriMesh) -> float:
    """Return the default bound of how far a solid may extend beyond its pieces [mm]."""
    return max(BOUND_MM, BOUND_SHARE * float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0])))


def inscribed(mesh: TriMesh, *, bound: float | None = None, most: int = MOST_PIECES, deflection: float = 0.0) -> Inscribed | None:
    """Cover a solid with convex pieces inside it.

    A piece is outside the mesh by at most `INSIDE_MM`, or by the deflection if it is a ball or a cylinder.

    Args:
        mesh: Surface of the solid: closed, with outward normals.
        bound: Largest distance of the solid's surface from the pieces [mm]; `missing_bound` by default.
        most: Number of pieces.
        deflection: Largest distance between mesh and true surface [mm], by which recognised round bodies may be outside the mesh.

    Returns:
        The pieces, or None if the mesh bounds no solid or no piece fits inside.
    """
    if not mesh.is_closed or mesh.volume <= 0:
        return None
    body = _manifold(mesh)
    if body.status() != manifold3d.Error.NoError or body.volume() <= 0:
        return None
    bound = missing_bound(mesh) if bound is None else bound
    cover = _Cover(mesh, body, bound, deflection)
    while len(cover.found) < _SURPLUS * most and cover.add():
        pass
    return cover.result(most)


@dataclass(frozen=True, eq=False)
class _Grown:
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
        first = heights.argmax(axis=1)
        h = heights[np.arange(len(points)), first]
        outside = np.flatnonzero(h > 0)
        far = h.copy()
        if len(outside):
            one, other = h[outside, None], heights[outside]
            c = (self.planes[:, :3] @ self.planes[:, :3].T)[first[outside]]
            apart = 1 - c * c
            wedge = (other > c * one) & (apart > 1e-9)
            squares = (one * one + other * other - 2 * c * one * other) / np.where(wedge, apart, 1.0)
            far[outside] = np.sqrt(np.where(wedge, squares, one * one).max(axis=1))
        return np.asarray(far)


@dataclass(eq=False)
class _Candidate:
    """A piece that may be used: its distances from the sampled points `(M,)` [mm], and whether the finest surface is outside it."""

    grown: _Grown
    far: FloatArray
    checked: bool


class _Cover:
    """The pieces found so far, and the distances of the sampled points from them."""

    def __init__(self, mesh: TriMesh, body: manifold3d.Manifold, bound: float, deflection: float) -> None:
        self.mesh, self.bound, self.deflection = mesh, bound, deflection
        self.size = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0]))
        self.volume = mesh.volume
        self.full = _Facets.of(mesh)
        self.same = len(mesh.triangles) <= _COARSE_TRIANGLES  # manifold3d may swap edges, so only the mesh itself is the same
        coarse = body if self.same else body.simplify(_SIMPLIFY * bound)
        self.coarse = self.full if self.same else _Facets.of(_mesh(coarse))
        self.points, self.seeds, self.depths = _samples(self.coarse, coarse, self.size)
        self.limits = np.minimum(bound, np.maximum(BOUND_MM, _OF_DEPTH * self.depths))
        self.slack = min(bound / 2, max(_SLACK_MM, _SLACK_SHARE * self.size))
        self.far = np.full(len(self.points), np.inf)
        self.visits = np.zeros(len(self.points), dtype=int)
        self.found: list[_Candidate] = []
        self.pool = [_Candidate(one, one.distance(self.points), checked=True) for one in _round_bodies(mesh, self.full, deflection)]
        self.ready = list(self.pool)

    def add(self) -> bool:
        """Take the candidate that covers most of the rest, after growing some around one of the farthest points; False if none does."""
        while len(open_ := np.flatnonzero((self.far > self.limits) & (self.visits < len(_DEPTHS)))):
            uncovered = self.far > self.limits
            ready = self._best(self.ready, uncovered)
            if ready is not None and self._gain(ready, uncovered) >= _MUCH * len(open_):
                self._take(ready)
                return True
            target = int(open_[self._first(open_)])
            if not any(one.far[target] <= self.limits[target] for one in self.pool):
                self._grow(target, open_)
            best = self._best(self.pool, uncovered)
            if best is not None and self._gain(best, uncovered) and self._take(best):
                return True
        return False

    def _grow(self, target: int, open_: NDArray[np.intp]) -> None:
        """Add pieces around seeds below a point and two others near it to the candidates."""
        share, slack = 2 * _DEPTHS[self.visits[target]], self.slack * _TIGHTER[self.visits[target]]
        self.visits[target] += 1
        near = open_[np.argsort(np.linalg.norm(self.points[open_] - self.points[target], axis=1))]
        chosen = [target, *near[[len(near) // 8, len(near) // 2]].tolist()][:_TRIES]
        for index in dict.fromkeys(chosen):
            for one in self._around(self.points[index] + share * (self.seeds[index] - self.points[index]), slack):
                self.pool.append(_Candidate(one, one.distance(self.points), checked=self.same))

    def _best(self, candidates: list[_Candidate], uncovered: NDArray[np.bool_]) -> _Candidate | None:
        return max(candidates, key=lambda one: (self._gain(one, uncovered), one.grown.volume), default=None)

    def _gain(self, one: _Candidate, uncovered: NDArray[np.bool_]) -> int:
        return int(np.count_nonzero(uncovered & (one.far <= self.limits)))

    def _take(self, one: _Candidate) -> bool:
        """Add a candidate to the pieces; return False if nothing of it is left inside the finest surface."""
        if not self._check(one):
            return False
        self.far = np.minimum(self.far, one.far)
        self.found.append(one)
        self.ready = [other for other in self.ready if other is not one]
        return True

    def _check(self, one: _Candidate) -> bool:
        """Move a candidate's planes until the finest surface is outside; without anything left, remove it and return False."""
        if one.checked:
            return True
        grown = _polytope(_held_off(one.grown.grown, self.full), one.grown.seed)
        if grown is None:
            self.pool = [other for other in self.pool if other is not one]
            return False
        one.grown, one.far, one.checked = grown, grown.distance(self.points), True
        return True

    def _first(self, open_: NDArray[np.intp]) -> int:
        """Return the index of the farthest point; without a piece, of the one with most material below it."""
        if not self.found:
            return int(self.depths[open_].argmax())
        return int((self.far[open_] / self.limits[open_]).argmax())

    def _around(self, seed: FloatArray, slack: float) -> list[_Grown]:
        """Return the piece around a seed, and the one around its centre."""
        found: list[_Grown] = []
        for _ in range(2):
            planes = _grown(self.coarse, seed, slack, self.size) if _encloses(self.full, seed) else None
            one = None if planes is None else _polytope(planes, seed)
            if one is None:
                break
            found.append(one)
            seed = one.piece.mesh.transformed(one.piece.frame).vertices.mean(axis=0)
        return found

    def _chosen(self, most: int) -> list[_Grown]:
        """Return at most so many candidates that reach the least bound, by a greedy set cover for each of increasing bounds.

        What is left of the number is used for what most points need that are beyond the requested bound.
        """
        if len(self.found) <= most:
            return [one.grown for one in self.found]
        limits, bound = self.limits, self.bound
        while (chosen := self._set_cover(limits, most)) is None:
            limits = np.full(len(self.points), bound)
            bound *= _RELAXED
        while len(chosen) < most:
            uncovered = np.minimum.reduce([one.far for one in chosen]) > self.limits
            best = self._best(self.pool, uncovered)
            if best is None or not self._gain(best, uncovered):
                break
            if self._check(best) and self._gain(best, uncovered):
                chosen.append(best)
        return [one.grown for one in chosen]

    def _set_cover(self, limits: FloatArray, most: int) -> list[_Candidate] | None:
        """Return candidates that cover all points that any candidate covers; None if more than `most` are needed."""
        while True:
            table = np.array([one.far <= limits for one in self.pool])
            left = table.any(axis=0)
            chosen: list[_Candidate] = []
            while left.any() and len(chosen) < most:
                best = int(np.count_nonzero(table & left, axis=1).argmax())
                chosen.append(self.pool[best])
                left = left & ~table[best]
            if left.any():
                return None
            if all(one.checked for one in chosen):
                return chosen
            for one in chosen:  # which may cover less after that
                self._check(one)

    def result(self, most: int) -> Inscribed | None:
        """Return the pieces without redundant ones."""
        if not self.found:
            return None
        found = self._chosen(most)
        far = np.array([one.distance(self.points) for one in found])
        limits = np.maximum(self.limits, far.min(axis=0))  # what all pieces together reach
        keep = np.ones(len(found), dtype=bool)
        for index in np.argsort([one.volume for one in found]):
            keep[index] = False
            if not keep.any() or (far[keep].min(axis=0) > limits).any():
                keep[index] = True
        kept = [_fewer_corners(one) for one, is_kept in zip(found, keep, strict=True) if is_kept]
        placed = [one.piece.mesh.transformed(one.piece.frame) for one in kept]
        together = manifold3d.Manifold.batch_boolean([_manifold(mesh) for mesh in placed], manifold3d.OpType.Add)
        less = max(0.0, 1.0 - together.volume() / self.volume)
        missing = _distance_to(self.points, kept, placed)
        return Inscribed(tuple(one.piece for one in kept), missing, self.bound, less)


# ---------------------------------------------------------------------- surface


@dataclass(frozen=True, eq=False)
class _Facets:
    """Triangles of a surface.

    Attributes:
        corners: `(N, 3, 3)` [mm].
        normals: Outward unit normals, `(N, 3)`.
        offsets: n·x of each triangle's plane, `(N,)` [mm].
        areas: `(N,)` [mm²].
        inward: Directions in each triangle's plane that point from its edges ab, bc, ca inwards, `(3, N, 3)`.
    """

    corners: FloatArray
    normals: FloatArray
    offsets: FloatArray
    areas: FloatArray
    inward: FloatArray

    @property
    def count(self) -> int:
        return len(self.corners)

    @classmethod
    def of(cls, mesh: TriMesh) -> _Facets:
        twice = mesh.normals_of_twice_area
        length = np.linalg.norm(twice, axis=1)
        normals = twice / np.where(length > 0, length, 1.0)[:, None]
        corners = mesh.vertices[mesh.triangles]
        inward = np.array([np.cross(normals, corners[:, (edge + 1) % 3] - corners[:, edge]) for edge in range(3)])
        return cls(corners, normals, (normals * corners[:, 0]).sum(axis=1), length / 2, inward)


def _samples(facets: _Facets, body: manifold3d.Manifold, size: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return points of the surface `(M, 3)`, for each a point half-way through the material below it, and the depth there [mm]."""
    rng = np.random.default_rng(0)
    corners = facets.corners.reshape(-1, 3)
    owners = np.repeat(np.arange(facets.count), 3)
    pick = rng.permutation(len(corners))[
        : _SAMPLES // 2
    ]  # corners protrude most; points a little inside them, so that a ray has material below
    weights = rng.dirichlet((1, 1, 1), _SAMPLES)
    drawn = rng.choice(facets.count, _SAMPLES, p=facets.areas / facets.areas.sum())
    inner = (facets.corners[drawn] * weights[:, :, None]).sum(axis=1)
    middles = facets.corners.mean(axis=1)
    points = np.concatenate([inner, corners[pick]])
    starts = np.concatenate([inner, corners[pick] + 0.05 * (middles[owners[pick]] - corners[pick])])
    normals = np.concatenate([facets.normals[drawn], facets.normals[owners[pick]]])
    lift = 1e-7 * size
    seeds, depths, kept = [], [], []
    for index, (start, normal) in enumerate(zip(starts, normals, strict=True)):
        hits = body.ray_cast(tuple(start - lift * normal), tuple(start - 2 * size * normal))
        far = [hit.distance for hit in hits]
        depth = far[0] * 2 * size if far else 0.0
        if depth > max(10 * lift, INSIDE_MM):
            seeds.append(start - normal * depth / 2)
            depths.append(depth)
            kept.append(index)
    return points[kept], np.array(seeds).reshape(-1, 3), np.array(depths)


def _nearest(facets: _Facets, seed: FloatArray) -> FloatArray:
    """Return the point of each triangle nearest to the seed, `(N, 3)` (Ericson, Real-Time Collision Detection, 5.1.5)."""
    a, b, c = facets.corners[:, 0], facets.corners[:, 1], facets.corners[:, 2]
    ab, ac, bc = b - a, c - a, c - b
    inside = seed - (facets.normals @ seed - facets.offsets)[:, None] * facets.normals
    best = _on_segment(a, ab, seed)
    for start, way in ((a, ac), (b, bc)):
        other = _on_segment(start, way, seed)
        nearer = ((other - seed) ** 2).sum(axis=1) < ((best - seed) ** 2).sum(axis=1)
        best = np.where(nearer[:, None], other, best)
    within = facets.areas > 0
    for start, inward in zip((a, b, a), facets.inward, strict=True):  # the edges ab, bc, ca
        within &= ((inside - start) * inward).sum(axis=1) >= 0
    return np.asarray(np.where(within[:, None], inside, best))


def _on_segment(start: FloatArray, way: FloatArray, point: FloatArray) -> FloatArray:
    length = np.maximum((way * way).sum(axis=1), 1e-300)
    share = np.clip(((point - start) * way).sum(axis=1) / length, 0.0, 1.0)
    return np.asarray(start + share[:, None] * way)


# ---------------------------------------------------------------------- growth


def _grown(facets: _Facets, seed: FloatArray, slack: float, size: float) -> FloatArray | None:
    """Return planes `(K, 4)` around a seed such that each triangle is beyond one of them; None if the seed is on the surface."""
    nearest = _nearest(facets, seed)
    distance = np.linalg.norm(nearest - seed, axis=1)
    tolerance = 1e-9 * size
    if distance.min() < 1e-6 * size:
        return None
    heights = facets.offsets - facets.normals @ seed  # depth of the seed below each triangle's plane
    left = np.lexsort((-heights, np.round(distance, 6)))  # triangles in front of all planes so far, nearest first
    relative = np.moveaxis(facets.corners, 1, 0) - seed  # (3, N, 3): the first corners, the second, the third
    planes = []
    while len(left):
        first = left[0]
        if heights[first] >= _OWN * distance[first]:
            n, height = facets.normals[first], float(heights[first])
        else:
            n, height = (nearest[first] - seed) / distance[first], float(distance[first])
        least = _least(relative[:, left] @ n)  # how far beyond the seed each triangle is
        areas = facets.areas[left]
        beyond = [least >= height - min(share * slack, height / 2) - tolerance for share in _SLACKS]
        gained = [float(areas[mask].sum()) for mask in beyond]
        mask = beyond[next(index for index, gain in enumerate(gained) if gain >= 0.5 * gained[-1])]
        mask[0] = True
        reach = float(least[mask].min())  # as far out as its triangles allow
        planes.append([*n, float(n @ seed) + min(height, reach)])
        left = left[~mask]
    return np.array(planes)


def _least(values: FloatArray) -> FloatArray:
    """Return the minimum of three rows, `(3, N)` to `(N,)`."""
    return np.asarray(np.minimum(np.minimum(values[0], values[1]), values[2]))


def _held_off(planes: FloatArray, facets: _Facets) -> FloatArray:
    """Return the planes moved inwards until each triangle of a finer surface is beyond one of them, by the smallest motion for each."""
    corners = np.ascontiguousarray(np.moveaxis(facets.corners, 1, 0))
    need = np.full(facets.count, np.inf)  # by which a plane would have to move
    which = np.zeros(facets.count, dtype=int)
    left = np.arange(facets.count)
    for index, plane in enumerate(planes):
        moves = plane[3] - _least(corners[:, left] @ plane[:3])
        better = moves < need[left]
        need[left[better]], which[left[better]] = moves[better], index
        left = left[moves > 0]
    moves = np.zeros(len(planes))
    np.maximum.at(moves, which, np.maximum(need, 0.0))
    return np.column_stack([planes[:, :3], planes[:, 3] - moves])


def _polytope(planes: FloatArray, seed: FloatArray) -> _Grown | None:
    """Return the intersection of half-spaces around a seed as a mesh, with only the planes that bound it; None if it is too thin."""
    if ((planes[:, :3] @ seed - planes[:, 3]) >= -1e-6).any():
        return None
    try:
        corners = HalfspaceIntersection(np.column_stack([planes[:, :3], -planes[:, 3]]), seed).intersections
        corners = np.round(corners[np.isfinite(corners).all(axis=1)], _ROUND) + 0.0
        hull = ConvexHull(corners)
    except QhullError:
        return None
    mesh = _tidy(manifold3d.Manifold.hull_points(corners[np.sort(hull.vertices)]))
    if mesh is None:
        return None
    bounding = np.unique(np.round(np.column_stack([hull.equations[:, :3], -hull.equations[:, 3]]), 9), axis=0)
    boxed = _as_box(mesh)
    return _Grown(bounding, Piece(mesh, SE3.identity(), None) if boxed is None else boxed, mesh.volume, planes, seed)


def _fewer_corners(one: _Grown) -> _Grown:
    """Return the hull of a few of a piece's corners: the farthest ones, then repeatedly the one farthest from the hull so far."""
    corners = one.piece.mesh.vertices
    if one.piece.primitive is not None or len(corners) <= _MOST_CORNERS:
        return one
    directions = sphere(1.0, 4).vertices
    chosen = list(dict.fromkeys((corners @ directions.T).argmax(axis=0).tolist()))
    planes = np.zeros((0, 4))
    while len(chosen) < _MOST_CORNERS:
        hull = ConvexHull(corners[chosen])
        planes = np.column_stack([hull.equations[:, :3], -hull.equations[:, 3]])
        heights = (corners @ planes[:, :3].T - planes[:, 3]).max(axis=1)
        if heights.max() <= 10.0**-_ROUND:
            break
        chosen.append(int(heights.argmax()))
    mesh = _tidy(manifold3d.Manifold.hull_points(corners[sorted(chosen)]))
    return one if mesh is None else replace(one, planes=planes, piece=Piece(mesh, SE3.identity(), None), volume=mesh.volume)


def _tidy(solid: manifold3d.Manifold) -> TriMesh | None:
    mesh = _mesh(solid)
    return mesh if mesh.is_closed and mesh.volume > 0 else None


# ---------------------------------------------------------------------- recognised bodies


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
            return _box_piece(first, np.array([a, b, c]))
    return None


def _box_piece(first: FloatArray, edges: FloatArray) -> Piece:
    """Return the box spanned by a corner and three edges; its axes are those of the solid's frame if they agree."""
    lengths = np.linalg.norm(edges, axis=1)
    axes = edges / lengths[:, None]
    order, free = [], [0, 1, 2]
    for axis in range(2):
        best = max(free, key=lambda index: abs(float(axes[index, axis])))
        free.remove(best)
        order.append(best)
    order += free
    axes, lengths = axes[order], lengths[order]
    for index in (0, 1):
        if axes[index][int(np.abs(axes[index]).argmax())] < 0:
            axes[index] = -axes[index]
    x, z = _whole(axes[0]), _whole(np.cross(axes[0], axes[1]))
    middle = first + edges.sum(axis=0) / 2
    sides = tuple(float(side) for side in np.round(lengths, _ROUND))
    frame = SE3.from_axes(np.round(middle, _ROUND) + 0.0, z, x)
    return Piece(box(*sides), frame, Primitive("box", sides))


def _whole(axis: FloatArray) -> FloatArray:
    """Return a unit vector with components near 0 or ±1 set to these values."""
    rounded = np.round(axis)
    return np.asarray(rounded if float(np.abs(axis - rounded).max()) < 1e-9 else axis) + 0.0


def _round_bodies(mesh: TriMesh, facets: _Facets, deflection: float) -> list[_Grown]:
    """Return the balls and cylinders of which smooth faces of the solid are part and that lie inside it."""
    found = []
    for chosen in _smooth_faces(mesh, facets):
        corners, normals = facets.corners[chosen].reshape(-1, 3), facets.normals[chosen]
        weights = facets.areas[chosen]
        moments = (normals * weights[:, None]).T @ normals / weights.sum()
        spread, axes = np.linalg.eigh(moments)
        slack = max(deflection, 1e-6 * float(np.ptp(corners, axis=0).max()))
        one = None
        if spread[0] < 1e-3 < spread[1]:
            one = _cylinder(facets, corners, normals, axes[:, 0], slack)
        elif spread[0] > 0.05:
            one = _ball(facets, corners, normals, slack)
        if one is not None:
            found.append(one)
    return found


def _smooth_faces(mesh: TriMesh, facets: _Facets) -> list[NDArray[np.intp]]:
    """Return the triangles of each face of the B-rep, or of each smooth patch if the mesh has no faces; without flat ones."""
    label = smooth_patches(mesh) if mesh.face is None else np.asarray(mesh.face)
    order = np.argsort(label, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(label[order])) + 1)
    groups.sort(key=lambda group: -float(facets.areas[group].sum()))
    return [group for group in groups[:200] if len(group) >= 8 and float((facets.normals[group] @ facets.normals[group[0]]).min()) < 0.99]


def _ball(facets: _Facets, corners: FloatArray, normals: FloatArray, slack: float) -> _Grown | None:
    """Return the ball through all these corners, if the solid contains it."""
    system = np.column_stack([2 * corners, np.ones(len(corners))])
    solution, *_ = np.linalg.lstsq(system, (corners**2).sum(axis=1), rcond=None)
    center = solution[:3]
    r = float(np.sqrt(max(solution[3] + center @ center, 0.0)))
    if r <= 0 or float(np.abs(np.linalg.norm(corners - center, axis=1) - r).max()) > slack or not _encloses(facets, center):
        return None
    middles = corners.reshape(-1, 3, 3).mean(axis=1)
    if float(((middles - center) * normals).sum(axis=1).min()) <= 0:  # concave
        return None
    if float(np.linalg.norm(_nearest(facets, center) - center, axis=1).min()) < r - slack - 1e-6 * r:
        return None
    center = np.round(center, _ROUND) + 0.0
    r = round(r, _ROUND)
    directions = sphere(1.0, 24).vertices
    planes = np.column_stack([directions, directions @ center + r])
    piece = Piece(sphere(r, 32), SE3.from_translation(center), Primitive("sphere", (r,)))
    return _Grown(planes, piece, 4 / 3 * np.pi * r**3, np.zeros((0, 4)), center)


def _cylinder(facets: _Facets, corners: FloatArray, normals: FloatArray, axis: FloatArray, slack: float) -> _Grown | None:
    """Return the cylinder through all these corners, if the solid contains it between the ends of the face."""
    axis = _whole(axis if axis[int(np.abs(axis).argmax())] > 0 else -axis)
    side = np.eye(3)[int(np.abs(axis).argmin())]
    x = side - (side @ axis) * axis
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    flat = np.column_stack([corners @ x, corners @ y])
    solution, *_ = np.linalg.lstsq(np.column_stack([2 * flat, np.ones(len(flat))]), (flat**2).sum(axis=1), rcond=None)
    middle = solution[:2]
    r = float(np.sqrt(max(solution[2] + middle @ middle, 0.0)))
    if r <= 0 or float(np.abs(np.linalg.norm(flat - middle, axis=1) - r).max()) > slack:
        return None
    outward = (flat.reshape(-1, 3, 2).mean(axis=1) - middle) @ np.array([x, y])
    if float((outward * normals).sum(axis=1).min()) <= 0:  # a bore
        return None
    along = corners @ axis
    low, high = float(along.min()), float(along.max())
    planar = np.stack([facets.corners @ x - middle[0], facets.corners @ y - middle[1]], axis=-1)  # (N, 3, 2)
    heights = facets.corners @ axis
    tolerance = 1e-6 * (r + high - low)
    near = (heights.min(axis=1) < high - tolerance) & (heights.max(axis=1) > low + tolerance)
    if float(_to_origin(planar[near]).min(initial=np.inf)) < r - slack - tolerance:
        return None
    center = np.round(middle[0] * x + middle[1] * y + axis * (low + high) / 2, _ROUND) + 0.0
    if not _encloses(facets, center):
        return None
    r, length = round(r, _ROUND), round(high - low, _ROUND)
    angles = 2 * np.pi * np.arange(_SEGMENTS) / _SEGMENTS
    around = np.cos(angles)[:, None] * x + np.sin(angles)[:, None] * y
    n = np.concatenate([around, [axis, -axis]])
    reach = np.concatenate([np.full(_SEGMENTS, r), [length / 2, length / 2]])
    planes = np.column_stack([n, n @ center + reach])
    piece = Piece(cylinder(r, length, _SEGMENTS), SE3.from_axes(center, axis, _whole(x)), Primitive("cylinder", (r, length)))
    return _Grown(planes, piece, np.pi * r * r * length, np.zeros((0, 4)), center)


def _to_origin(triangles: FloatArray) -> FloatArray:
    """Return the distance of plane triangles `(N, 3, 2)` from the origin, 0 for those that contain it."""
    best = np.full(len(triangles), np.inf)
    signs = []
    for i in range(3):
        a, b = triangles[:, i], triangles[:, (i + 1) % 3]
        way = b - a
        length = np.maximum((way * way).sum(axis=1), 1e-300)
        share = np.clip(-(a * way).sum(axis=1) / length, 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(a + share[:, None] * way, axis=1))
        signs.append(way[:, 0] * -a[:, 1] + way[:, 1] * a[:, 0])
    turns = np.array(signs)
    inside = (turns > 0).all(axis=0) | (turns < 0).all(axis=0)
    return np.asarray(np.where(inside, 0.0, best))


# ---------------------------------------------------------------------- measurement


def _distance_to(points: FloatArray, grown: list[_Grown], placed: list[TriMesh]) -> float:
    """Return the largest distance of points from the nearest piece [mm]."""
    least = np.array([one.distance(points) for one in grown])
    far = np.flatnonzero(least.min(axis=0) > 0)
    far = far[np.argsort(-least[:, far].min(axis=0))]
    facets = [_Facets.of(mesh) for mesh in placed]
    worst = 0.0
    for index in far[:300].tolist():
        best = np.inf
        for which in np.argsort(least[:, index]).tolist():
            if least[which, index] >= best or best <= worst:
                break
            best = min(best, float(np.linalg.norm(_nearest(facets[which], points[index]) - points[index], axis=1).min()))
        worst = max(worst, best)
    return worst


def _encloses(facets: _Facets, point: FloatArray) -> bool:
    """Whether a whole surface encloses a point: its winding number is 1, or more where the surface overlaps itself."""
    return bool(winding_numbers(point[None], facets.corners)[0] > 0.5)


def _mesh(solid: manifold3d.Manifold) -> TriMesh:
    found = solid.to_mesh64()
    return TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))


def _manifold(mesh: TriMesh) -> manifold3d.Manifold:
    return manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
