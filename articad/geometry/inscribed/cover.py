"""The choice of pieces until all of the surface is near one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import manifold3d
import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.geometry.inscribed.growth import grown_planes, held_off
from articad.geometry.inscribed.piece import Grown, Piece, fewer_corners, polytope
from articad.geometry.inscribed.round_bodies import round_bodies
from articad.geometry.inscribed.surface import INSIDE_MM, Facets, encloses, manifold_of, mesh_of, nearest, steady, steady_size
from articad.geometry.mesh import TriMesh

MOST_PIECES: Final = 32
BOUND_MM, BOUND_SHARE = 0.5, 0.01  # how far the solid may extend beyond its pieces: the larger of the two; the share is of its diagonal
SCHEME: Final = "articad.inscribed/5"  # must change with anything that changes pieces
_SLACK_MM, _SLACK_SHARE = 0.25, 0.004  # how far a plane may move inwards: the larger of the two; the share is of the diagonal
_OF_DEPTH = 0.5  # of the material below a point: at thin walls, less may be missing
_SAMPLES = 800  # points of the surface at which the pieces are measured, and half as many corners
_COARSE_TRIANGLES = 3000  # of a mesh in which pieces are grown; a finer one is simplified first
_SIMPLIFY = 0.1  # of the bound: deviation of the surface by simplification
_MUCH = 0.2  # of the uncovered points: a recognised body that covers this share is used at once
_TRIES = 3  # points whose seeds are tried for each piece
_DEPTHS = (0.5, 0.15, 0.85)  # of the material below a point: where seeds are tried, until a piece covers it
_TIGHTER = (1.0, 0.4, 0.1)  # of the slack, in the same tries
_SURPLUS = 2  # multiple of the permitted number of pieces that are collected before a choice among them
_RELAXED = 1.1  # ratio of successive bounds that are tried, if there are too few pieces


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
    body = manifold_of(mesh)
    if body.status() != manifold3d.Error.NoError or body.volume() <= 0:
        return None
    bound = missing_bound(mesh) if bound is None else bound
    cover = _Cover(mesh, body, bound, deflection)
    while len(cover.found) < _SURPLUS * most and cover.add():
        pass
    return cover.result(most)


@dataclass(eq=False)
class _Candidate:
    """A piece that may be used: its distances from the sampled points `(M,)` [mm], and whether the finest surface is outside it."""

    grown: Grown
    far: FloatArray
    checked: bool


class _Cover:
    """The pieces found so far, and the distances of the sampled points from them."""

    def __init__(self, mesh: TriMesh, body: manifold3d.Manifold, bound: float, deflection: float) -> None:
        self.mesh, self.bound, self.deflection = mesh, bound, deflection
        self.size = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0]))
        self.volume = mesh.volume
        self.full = Facets.of(mesh)
        self.same = len(mesh.triangles) <= _COARSE_TRIANGLES  # manifold3d may swap edges, so only the mesh itself is the same
        coarse = body if self.same else body.simplify(_SIMPLIFY * bound)
        self.coarse = self.full if self.same else Facets.of(mesh_of(coarse))
        self.points, self.seeds, self.depths = _samples(self.coarse, coarse, self.size)
        self.limits = np.minimum(bound, np.maximum(BOUND_MM, _OF_DEPTH * self.depths))
        self.slack = min(bound / 2, max(_SLACK_MM, _SLACK_SHARE * self.size))
        self.far = np.full(len(self.points), np.inf)
        self.visits = np.zeros(len(self.points), dtype=int)
        self.found: list[_Candidate] = []
        self.pool = [_Candidate(one, one.distance(self.points), checked=True) for one in round_bodies(mesh, self.full, deflection)]
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
        near = open_[np.argsort(steady(np.linalg.norm(self.points[open_] - self.points[target], axis=1)), kind="stable")]
        chosen = [target, *near[[len(near) // 8, len(near) // 2]].tolist()][:_TRIES]
        for index in dict.fromkeys(chosen):
            for one in self._around(self.points[index] + share * (self.seeds[index] - self.points[index]), slack):
                self.pool.append(_Candidate(one, one.distance(self.points), checked=self.same))

    def _best(self, candidates: list[_Candidate], uncovered: NDArray[np.bool_]) -> _Candidate | None:
        return max(candidates, key=lambda one: (self._gain(one, uncovered), steady_size(one.grown.volume)), default=None)

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
        grown = polytope(held_off(one.grown.grown, self.full), one.grown.seed)
        if grown is None:
            self.pool = [other for other in self.pool if other is not one]
            return False
        one.grown, one.far, one.checked = grown, grown.distance(self.points), True
        return True

    def _first(self, open_: NDArray[np.intp]) -> int:
        """Return the index of the farthest point; without a piece, of the one with most material below it."""
        if not self.found:
            return int(self.depths[open_].argmax())
        return int(steady(self.far[open_] / self.limits[open_]).argmax())

    def _around(self, seed: FloatArray, slack: float) -> list[Grown]:
        """Return the piece around a seed, and the one around its centre."""
        found: list[Grown] = []
        for _ in range(2):
            planes = grown_planes(self.coarse, seed, slack, self.size) if encloses(self.full, seed) else None
            one = None if planes is None else polytope(planes, seed)
            if one is None:
                break
            found.append(one)
            seed = one.piece.mesh.transformed(one.piece.frame).vertices.mean(axis=0)
        return found

    def _chosen(self, most: int) -> list[Grown]:
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
        for index in np.argsort([steady_size(one.volume) for one in found], kind="stable"):
            keep[index] = False
            if not keep.any() or (far[keep].min(axis=0) > limits).any():
                keep[index] = True
        kept = [fewer_corners(one) for one, is_kept in zip(found, keep, strict=True) if is_kept]
        placed = [one.piece.mesh.transformed(one.piece.frame) for one in kept]
        together = manifold3d.Manifold.batch_boolean([manifold_of(mesh) for mesh in placed], manifold3d.OpType.Add)
        less = max(0.0, 1.0 - together.volume() / self.volume)
        missing = _distance_to(self.points, kept, placed)
        return Inscribed(tuple(one.piece for one in kept), missing, self.bound, less)


def _samples(facets: Facets, body: manifold3d.Manifold, size: float) -> tuple[FloatArray, FloatArray, FloatArray]:
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
    rays = zip((starts - lift * normals).tolist(), (starts - 2 * size * normals).tolist(), strict=True)
    for index, (near_end, far_end) in enumerate(rays):
        hits = body.ray_cast(near_end, far_end)
        depth = hits[0].distance * 2 * size if hits else 0.0
        if depth > max(10 * lift, INSIDE_MM):
            seeds.append(starts[index] - normals[index] * depth / 2)
            depths.append(depth)
            kept.append(index)
    return points[kept], np.array(seeds).reshape(-1, 3), steady(np.array(depths))


def _distance_to(points: FloatArray, grown: list[Grown], placed: list[TriMesh]) -> float:
    """Return the largest distance of points from the nearest piece [mm]."""
    least = np.array([one.distance(points) for one in grown])
    far = np.flatnonzero(least.min(axis=0) > 0)
    far = far[np.argsort(-least[:, far].min(axis=0), kind="stable")]
    facets = [Facets.of(mesh) for mesh in placed]
    worst = 0.0
    for index in far[:300].tolist():
        best = np.inf
        for which in np.argsort(least[:, index]).tolist():
            if least[which, index] >= best or best <= worst:
                break
            best = min(best, float(np.linalg.norm(nearest(facets[which], points[index]) - points[index], axis=1).min()))
        worst = max(worst, best)
    return worst
