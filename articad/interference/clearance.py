"""Least clearance of each two parts over the motion: looked for by sampling, then by a search near the nearest pose.

Poses along each driver, on a grid of every two, and scattered over all are looked at. Of each pair the distance is measured at the pose
whose boxes are nearest first, until no box can be nearer than the distance found. From there a compass search (Kolda, Lewis, Torczon
2003) moves one driver at a time by steps that shrink. The result is the smallest distance seen: the true one may be smaller, so every
row says "sampled".
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.errors import KinematicsError
from articad.findings import Findings
from articad.interference.motion import Freedom, scattered
from articad.interference.overlap import distance, one_contains_the_other, se3_of, volume
from articad.interference.relations import Relation
from articad.interference.report import Checks, Strength, rounded
from articad.interference.scene import relatives
from articad.interference.sweep import MotionSampler

FloatArray = NDArray[np.float64]

LINE, SIDE, SCATTERED = 17, 6, 96  # poses along one driver, on a side of a grid of two, and over all
MOST_GRIDS = 60  # of two drivers
NEAREST = 60  # pairs that are searched further, the nearest first
ROUNDS = 24  # of that search
FIRST_STEP = 1 / (LINE - 1)  # of a range
LEAST_STEP = 1e-5  # of a range
JOINED = 9  # poses of two parts that a joint connects: they keep their fit, and distances of mating surfaces cost most
_KEY_DIGITS = 6  # of mm and rotation entries: relative poses that agree so far are one
FLAT_MM = 1e-6  # a distance that varies by less about a pose does not depend on it
_SAME_MM = 1e-3  # over which distances must vary for the parts to move against each other


@dataclass(frozen=True)
class Clearance:
    """The smallest distance of two parts that was seen over the motion.

    Attributes:
        parts: Their names, in the order of the mechanism.
        gap: Distance of their meshes there [mm]; 0 where they touch or overlap.
        pose: Values of what was moved, the rest stands at rest [rad, mm].
        poses: How many poses of the two were looked at: more would find the same or less.
        relation: "mating" when a joint connects them, else "unrelated".
    """

    parts: tuple[str, str]
    gap: float
    pose: Mapping[str, float]
    poses: int
    relation: Relation

    @property
    def strength(self) -> Strength:
        """Sampled: no proof that the clearance is not smaller elsewhere."""
        return Strength.sampled(self.poses)

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a report."""
        pose = {name: rounded(value) for name, value in self.pose.items()}
        told = {"parts": list(self.parts), "relation": self.relation, "gap_mm": rounded(self.gap), "pose": pose}
        return {**told, "strength": self.strength.to_json()}


def least_clearances(motion: MotionSampler, joints: Sequence[str] | None = None, *, together: bool = True) -> tuple[Clearance, ...]:
    """Return the smallest distance seen of each two parts that move against each other, the nearest first.

    Args:
        motion: Sampling of the scene.
        joints: Names of those to move; all that drive by default.
        together: Whether several drivers move at once, too.
    """
    ranges = motion.ranges(joints)
    points = _points(motion, ranges, together=together)
    if not len(points):
        return ()
    search = _Search(motion, ranges)
    kept, matrices = search.placed(points)
    pairs = [found for i, j in search.pairs() if (found := search.nearest(i, j, points[kept], matrices)) is not None]
    pairs.sort(key=lambda pair: pair.gap)
    search.refine([pair for pair in pairs if not search.are_joined(pair.i, pair.j)][:NEAREST], together=together)
    return tuple(sorted((pair.clearance(motion, ranges) for pair in pairs), key=lambda one: one.gap))


def searched(motion: MotionSampler, known: Checks) -> Checks:
    """Return a report on the pairs that a search near their nearest poses finds to collide, and of which a report knows no collision."""
    told = {frozenset(finding.parts) for finding in known.findings.of("E_MOTION_COLLISION")}
    report = Checks(Findings(), (), known.deflection, known.over, known.parts)
    for one in least_clearances(motion):
        if one.gap <= 0 and one.pose and frozenset(one.parts) not in told:
            found = motion.sampled([one.pose], tuple(one.pose), None)
            mine = [pair for pair in found.pairs if set(pair.parts) == set(one.parts)]
            collisions = [finding for finding in found.findings.of("E_MOTION_COLLISION") if set(finding.parts) == set(one.parts)]
            report += replace(found, pairs=tuple(replace(pair, strength=one.strength) for pair in mine), findings=Findings(collisions))
    return report


def _points(motion: MotionSampler, ranges: Sequence[Freedom], *, together: bool) -> FloatArray:
    """Return values `(n, freedoms)`: along each, on grids of two, and scattered over all."""
    rest = np.array([freedom.rest for freedom in ranges])
    rows = [rest[None]]
    for at, freedom in enumerate(ranges):
        line = np.tile(rest, (LINE, 1))
        line[:, at] = np.linspace(freedom.lower, freedom.upper, LINE)
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


@dataclass
class _Pair:
    """Two bodies, and the nearest pose that was seen of them.

    Attributes:
        i: Place of the first among the bodies.
        j: Of the second.
        gap: Distance there [mm]; negative where they overlap.
        at: Values there `(freedoms,)`.
        movers: Which freedoms move one against the other.
        poses: How many relative poses were looked at.
        step: Of the search, as a share of the ranges.
    """

    i: int
    j: int
    gap: float
    at: FloatArray
    movers: list[int]
    poses: int
    step: float = FIRST_STEP

    def clearance(self, motion: MotionSampler, ranges: Sequence[Freedom]) -> Clearance:
        names = list(motion.scene.bodies)
        pose = {f.name: float(value) for f, value in zip(ranges, self.at, strict=True) if value != f.rest}
        parts = names[self.i], names[self.j]
        return Clearance(parts, max(self.gap, 0.0), pose, self.poses, motion.scene.relations.of(*parts))


class _Search:
    def __init__(self, motion: MotionSampler, ranges: Sequence[Freedom]) -> None:
        self.motion, self.scene, self.ranges = motion, motion.scene, ranges
        self.names = list(self.scene.bodies)
        self.bodies = list(self.scene.bodies.values())
        self.low, self.high = (np.array([getattr(freedom, end) for freedom in ranges]) for end in ("lower", "upper"))

    def pairs(self) -> list[tuple[int, int]]:
        """Return the bodies that joints let move against each other, and that are solids."""
        good = [at for at, name in enumerate(self.names) if name not in self.scene.broken and not self.bodies[at].is_empty]
        rigid = self.scene.relations.rigid
        return [(i, j) for i, j in itertools.combinations(good, 2) if not rigid.together(self.names[i], self.names[j])]

    def placed(self, points: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Return which points are reached, and where the bodies stand there `(n, bodies, 3, 4)`."""
        named = [dict(zip((f.name for f in self.ranges), point, strict=True)) for point in points.tolist()]
        try:
            kept, poses, _ = self.motion.placed(named)
        except KinematicsError:
            return np.empty(0, dtype=np.int64), np.empty((0, len(self.names), 3, 4))
        return kept, poses[:, [self.motion.mechanism.part_index(name) for name in self.names], :3]

    def nearest(self, i: int, j: int, points: FloatArray, matrices: FloatArray) -> _Pair | None:
        """Return the nearest of all poses; None where the two do not move against each other."""
        relative = relatives(matrices[:, i], matrices[:, j])
        if not len(relative) or np.abs(relative - relative[0]).max() < _SAME_MM:
            return None
        still = np.array([freedom.rest for freedom in self.ranges])
        movers = [
            k
            for k in range(len(self.ranges))
            if np.abs((alone := relative[(np.delete(points != still, k, axis=1) == 0).all(axis=1)]) - alone[0]).max(initial=0.0) > _SAME_MM
        ]
        _, first = np.unique(np.round(relative, _KEY_DIGITS), axis=0, return_index=True)
        bound = self.scene.boxes_gap(i, j, relative[first])
        order = np.argsort(bound, kind="stable")
        if self.are_joined(i, j):
            order = order[np.unique(np.linspace(0, len(order) - 1, JOINED).round().astype(np.int64))]
        best, where, looked = math.inf, int(first[order[0]]), len(order)
        for at in order.tolist():
            if bound[at] >= best or best <= 0.0:
                break
            gap = self._distance(i, j, relative[first[at]])
            if gap < best:
                best, where = gap, int(first[at])
        return _Pair(i, j, best, points[where].copy(), movers or list(range(len(self.ranges))), looked)

    def refine(self, pairs: Sequence[_Pair], *, together: bool) -> None:
        """Look for nearer poses beside those found, all pairs in one batch a round."""
        for _ in range(ROUNDS):
            tried = [(pair, row) for pair in pairs if pair.step >= LEAST_STEP for row in self._beside(pair, together=together)]
            if not tried:
                return
            points = np.array([row for _, row in tried])
            inside = np.flatnonzero(self.motion.within_cones(self.ranges, points))
            kept, matrices = self.placed(points[inside])
            before = {id(pair): pair.gap for pair in pairs}
            flat = set(before)
            for row, at in enumerate(inside[kept].tolist()):
                pair = tried[at][0]
                relative = relatives(matrices[row : row + 1, pair.i], matrices[row : row + 1, pair.j])
                pair.poses += 1
                if self.scene.boxes_gap(pair.i, pair.j, relative)[0] <= max(pair.gap, 0.0):
                    gap = self._distance(pair.i, pair.j, relative[0])
                    if abs(gap - before[id(pair)]) > FLAT_MM:
                        flat.discard(id(pair))
                    if gap < pair.gap:
                        pair.gap, pair.at = gap, points[at]
                else:
                    flat.discard(id(pair))
            for pair in pairs:
                if id(pair) in flat:  # such as two parts that turn about one axis
                    pair.step = 0.0
                elif pair.gap == before[id(pair)]:
                    pair.step /= 3

    def _beside(self, pair: _Pair, *, together: bool) -> Iterator[FloatArray]:
        """Yield values one step up and down each freedom that moves a pair."""
        moved = [k for k in pair.movers if pair.at[k] != self.ranges[k].rest]
        for k in pair.movers if together or not moved else moved[:1]:
            for sign in (-1.0, 1.0):
                row = pair.at.copy()
                row[k] = np.clip(row[k] + sign * pair.step * (self.high[k] - self.low[k]), self.low[k], self.high[k])
                if row[k] != pair.at[k]:
                    yield row

    def are_joined(self, i: int, j: int) -> bool:
        """Return whether a joint connects two bodies: then they may touch, and how deep they meet is not asked."""
        return bool(self.scene.relations.between(self.names[i], self.names[j]))

    def _distance(self, i: int, j: int, T: FloatArray) -> float:
        """Return the distance of two bodies; of those that no joint holds together, minus the cube root of what they share [mm]."""
        a, b = self.bodies[i], self.bodies[j]
        gap = distance(a, b, se3_of(T))
        if gap > 0 and not one_contains_the_other(a, b, T):
            return gap
        return -(max(volume(a, b, T), 0.0) ** (1 / 3)) if not self.are_joined(i, j) else 0.0
