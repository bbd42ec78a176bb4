"""Smallest clearance of every two parts over the motion: estimated by sampling, then by a search near the closest pose.

Poses along each driver, on a grid of every two, and scattered over all are looked at. Each pair has a lower bound of its distance at each
pose: the gap of the boxes about both parts, and any distance measured at another pose, minus how far the corners of a box move between
the two (`_Known`). The pose of the smallest bound is measured next, until no bound is below the distance found by more than a tolerance (`_close`).
From there a compass search (Kolda, Lewis, Torczon 2003) moves one driver at a time, to the lowest point of a quadratic model of the
distances just measured, and further on in a direction that helped. Its steps shrink until a step changes the distance by less than that.
The result is the smallest distance seen: the true one may be smaller, so every row says "sampled".
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.errors import KinematicsError
from articad.findings import Findings
from articad.interference.freedoms import Freedom, scattered
from articad.interference.overlap import distance, one_contains_the_other, se3_of, volume
from articad.interference.relations import Relation
from articad.interference.report import Checks, Strength, rounded
from articad.interference.scene import relatives
from articad.interference.sweep import MotionSampler

LINE, SIDE, SCATTERED = 17, 6, 96  # poses along one driver (or each of its turns), on a side of a grid of two, and over all
MOST_GRIDS = 60  # of two drivers
NEAREST, QUICK_NEAREST = 60, 20  # pairs that are searched further, the nearest first
ROUNDS = 60  # of that search
FIRST_STEP = 1 / (LINE - 1)  # of a range, or of a turn if it has several
LEAST_STEP = 1e-5  # likewise
AROUND, LEAP = 3.5, 6.0  # steps: what is measured that near is part of a model; how far that leads at most
FURTHER = 3.0  # times the last improvement's way, at which the next pose is tried (a pattern move, Hooke and Jeeves 1961)
MODELLED = 3  # freedoms of a pair, up to which a quadratic model of its distance is fitted: valleys need not run along a freedom
JOINED, QUICK_JOINED = 9, 5  # poses of two parts that a joint connects: they keep their fit, and distances of mating surfaces cost most
_KEY_DIGITS = 6  # of mm and rotation entries: relative poses that agree so far are one
CLOSE_MM, CLOSE_SHARE = 1e-3, 1e-3  # mm, and of the distance: an improvement below both is not looked for
QUICK_SHARE = 1e-2  # of the distance: the same of a quick search
PATIENCE = 8  # poses in a row, measured without an improvement, after which a quick search leaves parts that are distant
LOOKS, FEW = 500, 3  # distances that a quick search measures before it refines, the nearest boxes first; and of each pair beyond that
STEADY = 16  # poses at which the distance was the same, after which a quick search takes it for constant
DISTANT_SHARE = 0.05  # of the diagonal of the smaller box: parts further apart are distant
FLAT_MM = 1e-6  # distances that differ by less are equal
_SAME_MM = 1e-3  # over which distances must vary for the parts to move against each other


@dataclass(frozen=True)
class Clearance:
    """The smallest distance of two parts that was seen over the motion.

    Attributes:
        parts: Their names, in the order of the mechanism.
        gap: Distance of their meshes there [mm]; 0 where they touch or overlap.
        pose: Values of the freedoms that were moved; the rest is at rest [rad, mm].
        poses: Number of poses of the pair that were sampled; more would give the same distance or a smaller one.
        relation: "mating" when a joint connects them, else "unrelated".
    """

    parts: tuple[str, str]
    gap: float
    pose: Mapping[str, float]
    poses: int
    relation: Relation

    @property
    def strength(self) -> Strength:
        """Sampled: the clearance may be smaller elsewhere."""
        return Strength.sampled(self.poses)

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a report."""
        pose = {name: rounded(value) for name, value in self.pose.items()}
        told = {"parts": list(self.parts), "relation": self.relation, "gap_mm": rounded(self.gap), "pose": pose}
        return {**told, "strength": self.strength.to_json()}


def least_clearances(
    motion: MotionSampler, joints: Sequence[str] | None = None, *, together: bool = True, quick: bool = False
) -> tuple[Clearance, ...]:
    """Return the smallest distance seen of each two parts that move against each other, the nearest first.

    Near the pose that is found, the distance is the least within `CLOSE_MM` or, if that is less, within `CLOSE_SHARE` of itself.

    Args:
        motion: Sampling of the scene.
        joints: Names of those to move; all that drive by default.
        together: Whether several drivers move at once, too.
        quick: Whether to search within a percent only, and not for ever where parts are distant or keep their distance: for use beside
            a proof that nothing collides.
    """
    ranges = motion.ranges(joints)
    points = _points(motion, ranges, together=together)
    if not len(points):
        return ()
    search = _Search(motion, ranges, quick=quick)
    kept, matrices = search.placed(points)
    reached = points[kept]
    pairs = [found for i, j in search.pairs() if (found := search.pair(i, j, reached, matrices)) is not None]
    left = LOOKS
    for pair in sorted(pairs, key=lambda pair: float(pair.bound[0])):  # the boxes that are nearest first
        left -= search.look(pair, max(left, FEW) if quick else None)
    pairs.sort(key=lambda pair: pair.gap)
    apart = [pair for pair in pairs if not search.are_joined(pair.i, pair.j)]
    search.refine(apart[: QUICK_NEAREST if quick else NEAREST], together=together)
    return tuple(sorted((pair.clearance(motion, ranges) for pair in pairs), key=lambda one: one.gap))


def searched(motion: MotionSampler, known: Checks) -> Checks:
    """Return a report on the pairs that a search near their nearest poses finds to collide, and of which a report knows no collision."""
    return collisions_at(motion, least_clearances(motion), known)


def collisions_at(motion: MotionSampler, rows: Iterable[Clearance], known: Checks) -> Checks:
    """Return a report on the pairs that collide at their nearest poses, and of which a report knows no collision."""
    told = {frozenset(finding.parts) for finding in known.findings.of("E_MOTION_COLLISION")}
    report = Checks(Findings(), (), known.deflection, known.over, known.parts)
    for one in rows:
        if one.gap <= 0 and one.pose and frozenset(one.parts) not in told:
            found = motion.sampled([one.pose], tuple(one.pose), None)
            mine = [pair for pair in found.pairs if set(pair.parts) == set(one.parts)]
            collisions = [finding for finding in found.findings.of("E_MOTION_COLLISION") if set(finding.parts) == set(one.parts)]
            report += replace(found, pairs=tuple(replace(pair, strength=one.strength) for pair in mine), findings=Findings(collisions))
    return report


def _points(motion: MotionSampler, ranges: Sequence[Freedom], *, together: bool) -> FloatArray:
    """Return values `(n, freedoms)`: along each freedom, on grids of two, and scattered over all."""
    rest = np.array([freedom.rest for freedom in ranges])
    rows = [rest[None]]
    for at, freedom in enumerate(ranges):
        values = motion.values(freedom, LINE)
        line = np.tile(rest, (len(values), 1))
        line[:, at] = values
        rows.append(line)
    for pair in itertools.islice(itertools.combinations(range(len(ranges)), 2), MOST_GRIDS if together else 0):
        grid = np.meshgrid(*(np.linspace(ranges[at].lower, ranges[at].upper, SIDE) for at in pair), indexing="ij")
        two = np.tile(rest, (grid[0].size, 1))
        two[:, pair] = np.stack([axis.ravel() for axis in grid], axis=1)
        rows.append(two)
    if together and len(ranges) > 1:
        rows.append(np.array(scattered(ranges, SCATTERED)))
    points = np.concatenate(rows) if ranges else np.empty((0, 0))
    return points[motion.within_cones(ranges, points)]


def _lowest(offsets: FloatArray, rises: FloatArray) -> tuple[FloatArray, float] | None:
    """Return where a quadratic function is lowest that fits values `(n,)` at offsets `(n, k)` from 0, and how far it falls to there.

    None where no function with a minimum fits them.

    With f(0) = 0: f(x) = g x + x'Hx/2 by least squares, and x = -H^-1 g, scaled so that no offset exceeds `LEAP`.
    """
    n, k = offsets.shape
    ways = list(itertools.combinations_with_replacement(range(k), 2))
    if n < k + len(ways):
        return None
    square = np.stack([offsets[:, a] * offsets[:, b] * (0.5 if a == b else 1.0) for a, b in ways], axis=1)
    found, _, rank, _ = np.linalg.lstsq(np.concatenate([offsets, square], axis=1), rises, rcond=None)
    H = np.zeros((k, k))
    for (a, b), value in zip(ways, found[k:], strict=True):
        H[a, b] = H[b, a] = value
    if rank < k + len(ways) or np.linalg.eigvalsh(H)[0] <= 1e-9 * np.abs(H).max():
        return None
    x = -np.linalg.solve(H, found[:k])
    return np.asarray(x / max(1.0, float(np.abs(x).max()) / LEAP)), float(-found[:k] @ x) / 2


class _Known:
    """Distances of two bodies measured so far, and the bounds of all other distances that follow from them.

    The distance d(T) of two bodies at the relative pose T differs from d(T') by at most the largest |T x - T' x| over the points x of the
    second body. That is a convex function of x, so no point of a box about the body exceeds all of its corners. The same holds for the
    first body as seen from the second; the smaller of both displacements counts.

    Args:
        a: Corners of a box about the first body in its own frame, `(8, 3)` [mm].
        b: The same of the second.
    """

    def __init__(self, a: FloatArray, b: FloatArray) -> None:
        self.a, self.b = a, b
        self.gaps: list[float] = []
        self.corners: list[FloatArray] = []

    def add(self, gap: float, T: FloatArray) -> None:
        """Note the distance [mm] at one pose `(1, 3, 4)`."""
        self.gaps.append(max(gap, 0.0))
        self.corners.append(self._placed(T)[0])

    def bounds(self, T: FloatArray, last: int = 0) -> FloatArray:
        """Return lower bounds of the distances at poses `(n, 3, 4)`, `(n,)` [mm]; from the last few measurements only, if that is asked."""
        gaps, known = np.array(self.gaps[-last:]), np.array(self.corners[-last:])
        moved = np.linalg.norm(self._placed(T)[:, None] - known, axis=4).max(axis=3).min(axis=2)
        return np.asarray((gaps - moved).max(axis=1))

    def _placed(self, T: FloatArray) -> FloatArray:
        """Return the corners of each box in the other body's frame, `(n, 2, 8, 3)`."""
        R, t = T[..., :3], T[:, None, :, 3]
        return np.stack([(self.a - t) @ R, self.b @ R.transpose(0, 2, 1) + t], axis=1)


@dataclass
class _Pair:
    """Two bodies and their closest pose so far.

    Attributes:
        i: Place of the first among the bodies.
        j: Of the second.
        movers: Which freedoms move one against the other.
        points: Values of sampled poses `(n, freedoms)`.
        relative: Relative poses there `(n, 3, 4)`, each different from the others.
        bound: Lower bounds of the distances there `(n,)` [mm]; infinite where the distance was measured.
        known: Distances measured so far.
        poses: How many relative poses were looked at.
        gap: Smallest distance [mm]; negative where they overlap.
        at: Values there `(freedoms,)`.
        step: Of the search, as a share of the ranges, or of a turn where they have several.
        measured: Values and distances beside the nearest pose.
        guess: Values at which a model of the distance is lowest, to be tried next.
        further: Values further on in the direction of the last improvement, to be tried next.
    """

    i: int
    j: int
    movers: list[int]
    points: FloatArray
    relative: FloatArray
    bound: FloatArray
    known: _Known
    poses: int
    gap: float = math.inf
    at: FloatArray = field(default_factory=lambda: np.empty(0))
    step: float = FIRST_STEP
    measured: list[tuple[FloatArray, float]] = field(default_factory=list)
    guess: FloatArray | None = None
    further: FloatArray | None = None

    def clearance(self, motion: MotionSampler, ranges: Sequence[Freedom]) -> Clearance:
        names = list(motion.scene.bodies)
        pose = {f.name: float(value) for f, value in zip(ranges, self.at, strict=True) if value != f.rest}
        parts = names[self.i], names[self.j]
        return Clearance(parts, max(self.gap, 0.0), pose, self.poses, motion.scene.relations.of(*parts))


class _Search:
    def __init__(self, motion: MotionSampler, ranges: Sequence[Freedom], *, quick: bool) -> None:
        self.motion, self.scene, self.ranges, self.quick = motion, motion.scene, ranges, quick
        self._alone_in: tuple[FloatArray, list[NDArray[np.bool_]]] | None = None
        self.names = list(self.scene.bodies)
        self.bodies = list(self.scene.bodies.values())
        self.low, self.high = (np.array([getattr(freedom, end) for freedom in ranges]) for end in ("lower", "upper"))
        self.size = (self.high - self.low) / np.array([motion.turns(freedom) for freedom in ranges])

    def pairs(self) -> list[tuple[int, int]]:
        """Return the pairs of solid bodies that joints let move relative to each other."""
        good = [at for at, name in enumerate(self.names) if name not in self.scene.broken and not self.bodies[at].is_empty]
        rigid = self.scene.relations.rigid
        return [(i, j) for i, j in itertools.combinations(good, 2) if not rigid.together(self.names[i], self.names[j])]

    def placed(self, points: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Return which points are reached, and the poses of the bodies there `(n, bodies, 3, 4)`."""
        named = [dict(zip((f.name for f in self.ranges), point, strict=True)) for point in points.tolist()]
        try:
            kept, poses, _ = self.motion.placed(named)
        except KinematicsError:
            return np.empty(0, dtype=np.int64), np.empty((0, len(self.names), 3, 4))
        return kept, poses[:, [self.motion.mechanism.part_index(name) for name in self.names], :3]

    def pair(self, i: int, j: int, points: FloatArray, matrices: FloatArray) -> _Pair | None:
        """Return two bodies with their different relative poses; None where they do not move against each other."""
        relative = relatives(matrices[:, i], matrices[:, j])
        if not len(relative) or np.abs(relative - relative[0]).max() < _SAME_MM:
            return None
        movers = [
            k for k, alone in enumerate(self._alone(points)) if np.abs(relative[alone] - relative[alone][:1]).max(initial=0.0) > _SAME_MM
        ]
        _, first = np.unique(np.round(relative, _KEY_DIGITS), axis=0, return_index=True)
        bound = self.scene.boxes_gap(i, j, relative[first])
        order = np.argsort(bound, kind="stable")
        if self.are_joined(i, j):
            order = order[np.unique(np.linspace(0, len(order) - 1, QUICK_JOINED if self.quick else JOINED).round().astype(np.int64))]
        chosen = first[order]
        known = _Known(self._box(i), self._box(j))
        movers = movers or list(range(len(self.ranges)))
        return _Pair(i, j, movers, points[chosen], relative[chosen], bound[order], known, len(order))

    def _alone(self, points: FloatArray) -> list[NDArray[np.bool_]]:
        """Return, for each freedom, at which points all others rest; found once for the same array."""
        if self._alone_in is None or self._alone_in[0] is not points:
            moved = points != np.array([freedom.rest for freedom in self.ranges])
            self._alone_in = points, [(moved.sum(axis=1) == moved[:, k]) for k in range(len(self.ranges))]
        return self._alone_in[1]

    def look(self, pair: _Pair, allowed: int | None) -> int:
        """Measure distances at the poses of smallest bounds, until no bound is below the smallest distance by more than the tolerance.

        Args:
            pair: Is updated.
            allowed: Largest number of measurements; None for any.

        Returns:
            The number of measurements.
        """
        distant = DISTANT_SHARE * 2 * min(float(np.linalg.norm(self.scene.local_boxes[1][k])) for k in (pair.i, pair.j))
        count, stale, most = 0, 0, -math.inf
        while pair.gap > 0.0 and count != allowed and np.isfinite(pair.bound).any():
            at = int(np.argmin(pair.bound))
            if pair.gap < math.inf and pair.bound[at] >= pair.gap - self._close(pair.gap):
                break
            if self.quick and (
                (stale >= PATIENCE and pair.gap > distant) or (stale >= STEADY and most - pair.gap <= self._close(pair.gap))
            ):
                break
            gap, count = self._distance(pair.i, pair.j, pair.relative[at]), count + 1
            stale, most = 0 if gap < pair.gap - self._close(gap) else stale + 1, max(most, gap)
            pair.known.add(gap, pair.relative[at : at + 1])
            pair.bound = np.maximum(pair.bound, pair.known.bounds(pair.relative, last=1))
            pair.bound[at] = math.inf
            if gap < pair.gap:
                pair.gap, pair.at = gap, pair.points[at].copy()
        return count

    def refine(self, pairs: Sequence[_Pair], *, together: bool) -> None:
        """Search for closer poses around those found, all pairs in one batch per round."""
        for _ in range(ROUNDS):
            tried = [(pair, row) for pair in pairs if pair.step >= LEAST_STEP for row in self._beside(pair, together=together)]
            if not tried:
                return
            points = np.array([row for _, row in tried])
            inside = np.flatnonzero(self.motion.within_cones(self.ranges, points))
            kept, matrices = self.placed(points[inside])
            places: dict[int, list[tuple[int, int]]] = {}
            for row, at in enumerate(inside[kept].tolist()):
                places.setdefault(id(tried[at][0]), []).append((row, at))
            for pair in pairs:
                if pair.step < LEAST_STEP:
                    continue
                rows = places.get(id(pair), [])
                relative = relatives(matrices[[row for row, _ in rows], pair.i], matrices[[row for row, _ in rows], pair.j])
                self._try(pair, points[[at for _, at in rows]], relative)

    def _try(self, pair: _Pair, points: FloatArray, relative: FloatArray) -> None:
        """Measure a pair at some poses `(n, freedoms)` beside its nearest one and go to the best, or make smaller steps."""
        start, before, seen, is_modelled = pair.at, pair.gap, list[float](), 1 < len(pair.movers) <= MODELLED
        # lower bounds first (boxes, then earlier distances); only a pose that may beat the nearest one is measured
        for k in range(len(points)):
            pair.poses += 1
            T = relative[k : k + 1]
            if self.scene.boxes_gap(pair.i, pair.j, T)[0] > max(pair.gap, 0.0):
                continue
            if pair.gap > 0 and not is_modelled and pair.known.bounds(T)[0] > pair.gap - self._close(pair.gap):
                continue
            gap = self._distance(pair.i, pair.j, T[0])
            pair.known.add(gap, T)
            seen.append(gap)
            pair.measured.append((points[k], gap))
            if gap < pair.gap:
                pair.gap, pair.at = gap, points[k]
        # a quadratic model of the distances near the best pose gives the next guess, and how far it could fall
        is_flat = len(seen) == len(points) and all(abs(gap - before) <= self._close(before) for gap in seen)
        low, high, size = self.low[pair.movers], self.high[pair.movers], pair.step * self.size[pair.movers]
        pair.guess, fall = None, math.inf
        if is_modelled and pair.measured:
            offsets = (np.array([point for point, _ in pair.measured]) - pair.at)[:, pair.movers] / size
            near = (np.abs(offsets) <= AROUND).all(axis=1)
            lowest = _lowest(offsets[near], np.array([gap for _, gap in pair.measured])[near] - pair.gap)
            if lowest is not None:
                pair.guess, fall = pair.at.copy(), lowest[1]
                pair.guess[pair.movers] = np.clip(pair.at[pair.movers] + lowest[0] * size, low, high)
        # after a success look further in the same direction; without one make smaller steps
        pair.further = None
        if pair.gap < before and len(pair.movers) > 1:
            pair.further = np.clip(start + FURTHER * (pair.at - start), self.low, self.high)
        if pair.gap == before:
            pair.step = 0.0 if is_flat or fall < self._close(before) else pair.step / 3  # flat: as two parts that turn about one axis

    def _beside(self, pair: _Pair, *, together: bool) -> Iterator[FloatArray]:
        """Yield values one step up and down each freedom that moves a pair, up both of each two of a few, and where a model is lowest."""
        moved = [k for k in pair.movers if pair.at[k] != self.ranges[k].rest]
        ways = [(k,) for k in (pair.movers if together or not moved else moved[:1])]
        both = list(itertools.combinations(pair.movers, 2)) if together and 1 < len(pair.movers) <= MODELLED else []
        for some, sign in [*itertools.product(ways, (-1.0, 1.0)), *((two, 1.0) for two in both)]:
            row = pair.at.copy()
            for k in some:
                row[k] = np.clip(row[k] + sign * pair.step * self.size[k], self.low[k], self.high[k])
            if (row != pair.at).any():
                yield row
        if together:
            yield from (row for row in (pair.guess, pair.further) if row is not None)

    def _close(self, gap: float) -> float:
        """Return the tolerance to which the least distance is found, near one that is known [mm]."""
        gap = max(gap, 0.0)
        return FLAT_MM + (QUICK_SHARE * gap if self.quick else min(CLOSE_MM, CLOSE_SHARE * gap))

    def _box(self, at: int) -> FloatArray:
        """Return the corners of the box about a body in its own frame, `(8, 3)` [mm]."""
        centre, half = (sides[at] for sides in self.scene.local_boxes)
        return np.asarray(centre + half * np.array(list(itertools.product((-1.0, 1.0), repeat=3))))

    def are_joined(self, i: int, j: int) -> bool:
        """Return whether a joint connects two bodies: then they may touch, and the depth of contact is not measured."""
        return bool(self.scene.relations.between(self.names[i], self.names[j]))

    def _distance(self, i: int, j: int, T: FloatArray) -> float:
        """Return the distance of two bodies [mm]; if no joint connects them and they overlap, minus the cube root of the common volume."""
        a, b = self.bodies[i], self.bodies[j]
        gap = distance(a, b, se3_of(T))
        if gap > 0 and not one_contains_the_other(a, b, T):
            return gap
        return -(max(volume(a, b, T), 0.0) ** (1 / 3)) if not self.are_joined(i, j) else 0.0
