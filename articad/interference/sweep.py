"""Sampled motion: one joint at a time, two on a grid, or all at scattered points. All verdicts are "sampled".

A pair is measured again only at new relative poses: while one joint moves, most pairs keep theirs.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations, compress, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.errors import KinematicsError, LoopError
from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh
from articad.interference.boxes import meeting_boxes
from articad.interference.check import broken_finding, unknown_pairs
from articad.interference.freedoms import Freedom, driver_values, freedoms, scattered
from articad.interference.overlap import VOLUME_NOISE_MM3, Overlap, common, may_overlap, overlap_of
from articad.interference.relations import FitLike, WaiverLike
from articad.interference.report import Checks, PairCheck, Strength
from articad.interference.sampled_ranges import MOST_TURNS, driving_joints, endless_beyond, sampled_ranges
from articad.interference.scene import Scene, relatives
from articad.interference.turning import Turning
from articad.interference.verdict import UNRELATED_VOLUME_MM3, judge
from articad.interference.work import CLOSED, PAIRS_PLACED, POSE, TREE_TRIANGLES, WorkBudget, look_price
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.solution import Solution

DEFAULT_STEPS = 60
LIMIT_SLACK = 1e-6  # mm or rad by which a joint that follows may exceed its limits
_KEY_DIGITS = 9  # of millimetres and of rotation entries: relative poses that agree to this count as one
_WORTH_OUTLINES = 8  # poses from which comparing outlines first is cheaper
_DEEPEST = 2  # poses of largest volume at which the depth of a pair is measured


@dataclass
class _Track:
    """Results for one pair: volume by relative pose, its place, and for the largest ones the common solid."""

    volumes: dict[bytes, float] = field(default_factory=dict)
    poses: dict[bytes, tuple[FloatArray, int]] = field(default_factory=dict)
    solids: dict[bytes, Any] = field(default_factory=dict)
    seen: int = 0

    def keep(self, key: bytes, solid: Any) -> None:
        """Keep a solid while it is among the largest."""
        self.solids[key] = solid
        if len(self.solids) > _DEEPEST:
            del self.solids[min(self.solids, key=self.volumes.__getitem__)]


def sweep(
    meshes: Mapping[str, TriMesh],
    mechanism: Mechanism,
    *,
    joints: Sequence[str] | None = None,
    steps: int = DEFAULT_STEPS,
    together: bool = False,
    samples: int = 0,
    waivers: Sequence[WaiverLike] = (),
    deflection: Mapping[str, float] | float = 0.0,
    fits: Mapping[str, FitLike] | None = None,
) -> Checks:
    """Sample the motion of every driver over its range, the others at rest.

    Args:
        meshes: By part, in the part's frame; parts without geometry are omitted.
        mechanism: The mechanism.
        joints: Names of the joints to sweep; all that drive by default.
        steps: Poses per coordinate.
        together: Whether to sweep every two coordinates on a grid as well, of √steps each way.
        samples: Further poses scattered over all coordinates at once, in a low-discrepancy sequence.
        waivers: Overlaps that the plan allows.
        deflection: How far meshes are from their solids [mm], by part or the same for all.
        fits: By joint name.

    Returns:
        A report whose strengths all are "sampled"; a collision carries its pose.
    """
    scene = Scene.of(meshes, mechanism.joints, waivers=waivers, deflection=deflection, fits=fits)
    return MotionSampler(scene, mechanism).run(joints, steps=steps, together=together, samples=samples)


class MotionSampler:
    """Sampling of one scene; each relative pose is measured only once.

    Args:
        scene: Bodies and relations.
        mechanism: Places the parts.
        budget: Counts the work; a sweep does not stop by itself.
    """

    def __init__(self, scene: Scene, mechanism: Mechanism, budget: WorkBudget | None = None) -> None:
        self.scene, self.mechanism, self.budget = scene, mechanism, budget or WorkBudget(math.inf)
        self.queries = 0
        self._known: dict[tuple[str, str], dict[bytes, float]] = {}
        self.driving: tuple[Joint, ...] = driving_joints(mechanism)  # also free joints, which stay at rest

    def run(self, joints: Sequence[str] | None, *, steps: int, together: bool, samples: int) -> Checks:
        """Sweep and report; see `sweep`."""
        ranges = self.ranges(joints)
        over = tuple(freedom.name for freedom in ranges)
        broken = Findings(broken_finding(name, reason) for name, reason in self.scene.broken.items())
        report = Checks(
            broken + self._left_out(ranges),
            tuple(unknown_pairs(self.scene, over).values()),
            self.scene.deflection,
            over,
            tuple(self.scene.bodies),
        )
        for freedom in ranges:
            values = self.values(freedom, steps)
            step = float(values[1] - values[0])
            report += self.sampled([{freedom.name: value} for value in values.tolist()], (freedom.name,), step)
        if together:
            side = max(2, round(steps**0.5))
            for pair in combinations(ranges, 2):
                report += self._several(pair, product(*(np.linspace(freedom.lower, freedom.upper, side) for freedom in pair)))
        if samples and ranges:
            report += self._several(ranges, scattered(ranges, samples))
        return report

    def _several(self, ranges: Sequence[Freedom], points: Iterable[tuple[float, ...]]) -> Checks:
        """Check values of several freedoms at once, except those outside the cone of a ball."""
        values = np.array(list(points))
        names = tuple(freedom.name for freedom in ranges)
        allowed = values[self.within_cones(ranges, values)].tolist()
        return self.sampled([dict(zip(names, point, strict=True)) for point in allowed], names, None)

    def ranges(self, joints: Sequence[str] | None = None) -> list[Freedom]:
        """Return the freedoms to move with their sampled ranges: of some joints, or of all that drive."""
        chosen = {joint.name for joint in self.driving if joints is None or joint.name in joints}
        return [freedom for freedom in self._ranges if freedom.name.split(".")[0] in chosen]

    @cached_property
    def _ranges(self) -> tuple[Freedom, ...]:
        return sampled_ranges(self.mechanism)

    def values(self, freedom: Freedom, steps: int) -> FloatArray:
        """Return the sampled values `(n,)` of a range: `steps` of it, or of each of its turns if it has several."""
        return np.linspace(freedom.lower, freedom.upper, max(math.ceil(steps * min(self.turns(freedom), MOST_TURNS)), 2))

    def turns(self, freedom: Freedom) -> float:
        """Return how many turns a range has, at least 1; 1 for a length."""
        return max((freedom.upper - freedom.lower) / (2 * math.pi), 1.0) if self._is_angle(freedom.name) else 1.0

    def _is_angle(self, name: str) -> bool:
        return any(driver.name == name and driver.unit == "rad" for driver in self.mechanism.drivers)

    def sampled(self, points: Sequence[Mapping[str, float]], over: tuple[str, ...], step: float | None) -> Checks:
        """Check poses given by values of freedoms, the others at rest."""
        findings: list[Finding] = []
        try:
            kept, poses, solution = self.placed(points)
        except KinematicsError as error:
            return Checks(self._unreached(error.findings, error.message, over), (), self.scene.deflection, over, tuple(self.scene.bodies))
        if not solution.ok:
            missed = f"{int((~solution.reached).sum())} of {len(points)} poses cannot be reached."
            findings += self._unreached(solution.findings, missed, over)
        if not len(kept):
            return Checks(Findings(findings), (), self.scene.deflection, over, tuple(self.scene.bodies))
        findings += self._cut_short(points, kept, solution, over)
        points = [points[at] for at in kept]
        # one track for each pair whose boxes meet at some pose; its worst pose is measured and judged
        matrices = poses[:, [self.mechanism.part_index(name) for name in self.scene.bodies], :3]
        turning = Turning.of(self.scene, self.mechanism, over[0], poses[0], matrices[0]) if len(over) == 1 else None
        tracks = self._tracks(matrices, turning)
        pairs: list[PairCheck] = []
        strength = Strength.sampled(len(points), step)
        for (a, b), track in tracks.items():
            check, found = self._judged((a, b), track, points, over, strength)
            pairs.append(check)
            findings += found
        bare = tuple(name for name in self.mechanism.parts if name not in self.scene.bodies)
        return Checks(Findings(findings), tuple(pairs), self.scene.deflection, over, tuple(self.scene.bodies), bare)

    def placed(self, points: Sequence[Mapping[str, float]]) -> tuple[NDArray[np.int64], FloatArray, Solution]:
        """Place all parts at values of freedoms, the others at rest.

        Returns:
            Which points are reached with all followers within their limits; matrices of all parts there `(n, N, 4, 4)`; and which points
            are reached at all.

        Raises:
            KinematicsError: If a loop is open at rest.
        """
        self.budget.spend(len(points) * (CLOSED if self.mechanism.loop_joints else POSE))
        solution = self.mechanism.solve(np.array([self.columns(point) for point in points]))
        kept = np.flatnonzero(solution.reached & self._within_limits(solution.columns))
        return kept, np.asarray(solution.poses[kept].matrix), solution

    def within_cones(self, ranges: Sequence[Freedom], points: FloatArray) -> NDArray[np.bool_]:
        """Return which values `(n, freedoms)` keep every ball within its cone: the length of a swing (sx, sy) is its angle."""
        places = {freedom.name: at for at, freedom in enumerate(ranges)}
        inside = np.ones(len(points), dtype=bool)
        for name, at in places.items():
            other = places.get(f"{name[:-2]}sy") if name.endswith(".sx") else None
            if other is not None:
                inside &= np.hypot(points[:, at], points[:, other]) <= ranges[at].upper * (1 + LIMIT_SLACK)
        return inside

    def columns(self, point: Mapping[str, float]) -> list[float]:
        """Return the drivers' values `(nq,)` for values of some freedoms, the others at rest."""
        row = list(self._resting)
        for at in {self._owner[name] for name in point if name in self._owner}:
            start, joint, moves, is_driven = self._driving[at]
            values = driver_values(joint, [point.get(freedom.name, freedom.rest) for freedom in moves])
            row[start : start + sum(is_driven)] = compress(values, is_driven)
        return row

    @cached_property
    def _resting(self) -> list[float]:
        """The drivers' values with every freedom at rest."""
        row: list[float] = []
        for _, joint, moves, is_driven in self._driving:
            row += compress(driver_values(joint, [freedom.rest for freedom in moves]), is_driven)
        return row

    @cached_property
    def _owner(self) -> dict[str, int]:
        """Index in `_driving` of the joint that has each freedom."""
        return {freedom.name: at for at, (_, _, moves, _) in enumerate(self._driving) for freedom in moves}

    @cached_property
    def _driving(self) -> list[tuple[int, Joint, tuple[Freedom, ...], list[bool]]]:
        """Index of the first driver of each driving joint, the joint, its freedoms, and which of its coordinates are drivers."""
        names = {coordinate.name for coordinate in self.mechanism.drivers}
        rows, start = [], 0
        for joint in self.driving:
            is_driven = [name in names for name in joint.column_names]
            rows.append((start, joint, freedoms(joint), is_driven))
            start += sum(is_driven)
        return rows

    def _tracks(self, matrices: FloatArray, turning: Turning | None) -> dict[tuple[str, str], _Track]:
        """Measure the overlap volume of every candidate pair at every pose: each relative pose once, and none that is excluded."""
        names = list(self.scene.bodies)
        low, high = self.scene.boxes(matrices)
        tracks: dict[tuple[str, str], _Track] = {}
        # Boxes about all poses of a body: only bodies whose boxes meet can meet at a pose.
        candidates = meeting_boxes(low.min(axis=0), high.max(axis=0))
        self.budget.spend(math.comb(len(names), 2) / PAIRS_PLACED)  # the price of comparing all, whatever is saved
        for i, j in candidates.tolist():
            a, b = names[i], names[j]
            if self.scene.relations.rigid.together(a, b) or a in self.scene.broken or b in self.scene.broken:
                continue
            near = np.flatnonzero(((low[:, i] <= high[:, j]) & (low[:, j] <= high[:, i])).all(axis=1))
            if not len(near):
                continue
            track = tracks[a, b] = _Track(seen=len(matrices))
            relative = relatives(matrices[near, i], matrices[near, j])
            asked = np.flatnonzero(~self.scene.apart(i, j, relative))
            keys = [key.tobytes() for key in np.round(relative, _KEY_DIGITS) + 0.0]
            if turning is not None and len({keys[at] for at in asked}) >= _WORTH_OUTLINES:
                self.budget.spend(sum(len(self.scene.bodies[name].mesh.triangles) for name in (a, b)) / TREE_TRIANGLES)
                asked = asked[~turning.apart(i, j, relative[asked])]
            for at in asked.tolist():
                if keys[at] not in track.volumes:
                    track.poses[keys[at]] = (relative[at], int(near[at]))
                    self._ask(track, (a, b), keys[at], relative[at])
            if len(track.volumes) == 0 or len(asked) < len(matrices):
                track.volumes.setdefault(b"", 0.0)  # boxes that are apart have no common volume
        return tracks

    def _ask(self, track: _Track, pair: tuple[str, str], key: bytes, pose: FloatArray) -> None:
        known = self._known.setdefault(pair, {})
        if key not in known:
            self.queries += 1
            a, b = (self.scene.bodies[name] for name in pair)
            self.budget.spend(look_price(a.manifold_triangles, b.manifold_triangles))
            solid = common(a, b, pose) if may_overlap(a, b, pose) else None
            known[key] = 0.0 if solid is None else float(solid.volume())
            if known[key] > VOLUME_NOISE_MM3:
                track.volumes[key] = known[key]
                track.keep(key, solid)
        track.volumes[key] = known[key]

    def _judged(
        self, parts: tuple[str, str], track: _Track, points: Sequence[Mapping[str, float]], over: tuple[str, ...], strength: Strength
    ) -> tuple[PairCheck, list[Finding]]:
        largest = sorted(track.poses, key=lambda key: -track.volumes[key])[:_DEEPEST]
        worst, where = Overlap(), None
        for key in largest:
            if track.volumes[key] > max(UNRELATED_VOLUME_MM3, VOLUME_NOISE_MM3):
                pose, at = track.poses[key]
                a, b = (self.scene.bodies[name] for name in parts)
                self.budget.spend(look_price(a.manifold_triangles, b.manifold_triangles))
                found = overlap_of(track.solids.get(key) or common(a, b, pose), a, b, pose)
                if found.depth > worst.depth:
                    worst, where = found, points[at]
        if where is None and largest and track.volumes[largest[0]] > VOLUME_NOISE_MM3:
            worst = Overlap(track.volumes[largest[0]], 0.0, 1)
        baseline = min(track.volumes.values(), default=0.0)
        check, findings = judge(self.scene, parts, worst, over=over, strength=strength, pose=where, baseline=baseline)
        return check, findings

    def _left_out(self, ranges: Sequence[Freedom]) -> Findings:
        """Name what can move and is not sampled: free joints, drivers beyond their range, and parts that loops let move while all drivers stand."""
        still = "Nothing needs to be done if nothing is in its way; `certify` covers the turn of a rod between two balls."
        further = "Set limits where the motion ends; `certify` covers endless turns, unless the followers' ratio never brings them back."
        found: list[tuple[str, tuple[str, ...], str, str]] = [
            (f"joints.{joint.name}", (joint.child,), f"{joint.name} moves freely; it stands at rest in all samples.", still)
            for joint in self.driving
            if joint.type is JointType.FREE
        ]
        endless = endless_beyond(self.mechanism)
        for freedom in (freedom for freedom in ranges if freedom.name in endless):
            message = f"{freedom.name} is sampled at {freedom.lower:.6g} to {freedom.upper:.6g} only: {endless[freedom.name]}."
            found.append((f"joints.{freedom.name.split('.')[0]}", (), message, further))
        try:
            groups = () if self.mechanism.is_tree else self.mechanism.branch.groups
        except LoopError:  # whatever is sampled says so
            groups = ()
        for parts in (parts for group in groups for parts in group.idle):
            message = (
                f"{' and '.join(parts)} can move while all drivers rest, such as a rod that spins about its axis. No sample moves it alone."
            )
            found.append((f"parts.{parts[0]}", parts, message, still))
        return Findings(
            Finding(code="I_NOT_SAMPLED", where=where, message=said, parts=parts, hint=hint) for where, parts, said, hint in found
        )

    def _cut_short(
        self, points: Sequence[Mapping[str, float]], kept: NDArray[np.int64], solution: Solution, over: tuple[str, ...]
    ) -> Iterator[Finding]:
        """Yield the finding that a single freedom is sampled over a part of its range, because followers reach their limits there."""
        if len(over) > 1 or len(kept) == int(solution.reached.sum()):
            return
        (name,), values = over, [point[over[0]] for point in points]
        low, high = (end(values[at] for at in kept) for end in (min, max))
        message = (
            f"{name} is sampled at {low:.6g} to {high:.6g}, not at {min(values):.6g} to {max(values):.6g}: "
            "elsewhere, its followers leave their limits."
        )
        hint = f"Set the limits of {name.split('.')[0]} to what the limits of its followers allow."
        yield Finding(code="I_NOT_SAMPLED", where=f"joints.{name.split('.')[0]}", message=message, hint=hint)

    def _within_limits(self, columns: FloatArray) -> NDArray[np.bool_]:
        """Return in which configurations `(n, columns)` all followers are within their limits."""
        driving = {driver.name for driver in self.mechanism.drivers}
        followers = [at for at, c in enumerate(self.mechanism.coordinates) if c.name not in driving and c.unit != "1"]
        bounds = np.array([(c.lower, c.upper) for c in self.mechanism.coordinates]).reshape(-1, 2)[followers]
        values = columns[:, followers]
        return np.asarray(((bounds[:, 0] - LIMIT_SLACK <= values) & (values <= bounds[:, 1] + LIMIT_SLACK)).all(axis=1))

    def _unreached(self, causes: Sequence[Finding] | Findings, what: str, over: tuple[str, ...]) -> Findings:
        finding = Finding(
            code="E_NOT_CHECKED",
            where=f"joints.{over[0].split('.')[0]}",
            message=f"The motion over {', '.join(over)} is not completely sampled: {what}",
            hint="Narrow the limits to what the mechanism can reach.",
        )
        return Findings([*causes, finding])
