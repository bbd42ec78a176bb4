"""What holds what at rest: parts that are fixed but apart, and parts that touch nothing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.interference.body import Body
from articad.interference.overlap import distance, se3_of, surfaces_touch
from articad.interference.relations import Groups
from articad.interference.report import PairCheck
from articad.interference.scene import Placement
from articad.kinematics.joints import Joint, JointType

TOUCH_MM = 0.1  # largest distance of surfaces that are fixed to each other: glue, or a bolt in its hole
NEAR_MM = 5.0  # a part within this distance of another is held by it: runners, shadow gaps
NEAR_LEAST_MM = 0.5  # … but for small parts the limit is a tenth of their size, and at least this
NEAR_SHARE = 0.1
_STEPS = 3  # from one body to the other and back: mostly enough to find two vertices that are near
_NEAR_SAMPLES = 48  # vertices compared before FCL is queried


class Holding:
    """What holds what at rest: contact within rigid groups, and proximity for everything else."""

    def __init__(self, placed: Placement, pairs: dict[tuple[str, str], PairCheck]) -> None:
        self.scene, self.placed, self.pairs = placed.scene, placed, pairs

    def fixed_apart(self) -> list[Finding]:
        """Find parts that are fixed to each other without touching, and that no third part of their group connects."""
        scene = self.scene
        fixed = [joint for joint in scene.relations.joints if joint.type is JointType.FIXED]
        fixed = [joint for joint in fixed if joint.parent in scene.bodies and joint.child in scene.bodies]
        fixed = [joint for joint in fixed if not {joint.parent, joint.child} & scene.environment]
        touching = Groups(scene.bodies)
        for (a, b), pair in self.pairs.items():
            if pair.volume > 0 and scene.relations.rigid.together(a, b):
                touching.join(a, b)
        loose: list[tuple[Joint, float]] = []
        for joint in fixed:
            if touching.together(joint.parent, joint.child):
                continue
            gap = self._gap(joint.parent, joint.child)
            if gap <= self._touch_limit(joint):
                touching.join(joint.parent, joint.child)
            else:
                loose.append((joint, gap))
        if loose:
            self._join_touching_neighbours(touching)
        return [self._apart_finding(joint, gap) for joint, gap in loose if not touching.together(joint.parent, joint.child)]

    def _join_touching_neighbours(self, touching: Groups) -> None:
        """Add contacts between the other pairs of rigid groups, which now matter."""
        for a, b in self._candidates(TOUCH_MM):
            apart = self.scene.relations.rigid.together(a, b) and not touching.together(a, b)
            if apart and self._gap(a, b) <= TOUCH_MM + self.scene.deflection_of(a, b):
                touching.join(a, b)

    def floating(self, ground: str, bare: Sequence[str]) -> list[Finding]:
        """Find groups of parts that are near each other but not connected to the ground."""
        scene = self.scene
        near = Groups([*(name for name in scene.bodies if name not in scene.environment), *bare])
        # a part without geometry may hold anything joined to it; fixed parts are checked separately, and nothing holds free ones
        for joint in scene.relations.joints:
            if {joint.parent, joint.child} & scene.environment:
                continue
            if joint.parent in bare or joint.child in bare or joint.type in {JointType.FIXED, JointType.FREE}:
                near.join(joint.parent, joint.child)
        candidates = self._candidates(max([NEAR_MM, *(fit.gap_max or 0.0 for fit in scene.fits.values())]))
        candidates.sort(key=lambda pair: not scene.relations.between(*pair))  # parts that a joint connects are mostly near
        for a, b in candidates:
            if not near.together(a, b) and self._is_near(a, b):
                near.join(a, b)
        groups = near.sets()
        if len(groups) < 2:
            return []
        return [self._floating_finding(group) for group in groups if ground not in group]

    def _candidates(self, within: float) -> list[tuple[str, str]]:
        """Return the pairs of parts of the product whose boxes are within a distance [mm]."""
        return [pair for pair in self.placed.candidates(within) if self.scene.environment.isdisjoint(pair)]

    def _is_near(self, a: str, b: str) -> bool:
        pair = self.pairs.get((a, b))
        if pair is not None and (pair.volume > 0 or pair.verdict == "unknown"):
            return True
        bodies = self.scene.bodies
        limit = min(max(NEAR_LEAST_MM, NEAR_SHARE * min(bodies[a].diagonal, bodies[b].diagonal)), NEAR_MM)
        for joint in self.scene.relations.between(a, b):
            fit = self.scene.fits.get(joint.name)
            limit = max(limit, (fit.gap_max or 0.0) if fit is not None else 0.0)
        if pair is not None and pair.gap is not None:
            return pair.gap <= limit
        return self._vertices_within(a, b, limit) or distance(bodies[a], bodies[b], self._relative(a, b)) <= limit

    def _vertices_within(self, a: str, b: str, limit: float) -> bool:
        """Return whether two vertices are within the limit: often true, and cheaper than a search of all triangles."""
        T, bodies = self.placed.relative(a, b), self.scene.bodies
        return _stepping_within(bodies[a], bodies[b], T, limit) or _sampled_within(bodies[a], bodies[b], T, limit)

    def _gap(self, a: str, b: str) -> float:
        bodies, T_a_b = self.scene.bodies, self._relative(a, b)
        gap = 0.0 if surfaces_touch(bodies[a], bodies[b], T_a_b) else distance(bodies[a], bodies[b], T_a_b)
        for key in ((a, b), (b, a)):
            if key in self.pairs and self.pairs[key].verdict != "unknown":
                pair = self.pairs[key]
                values = {**pair.__dict__, "gap": gap}
                if gap <= TOUCH_MM + self.scene.deflection_of(a, b) and pair.verdict == "clear":
                    values["verdict"] = "contact"
                self.pairs[key] = PairCheck(**values)
        return gap

    def _touch_limit(self, joint: Joint) -> float:
        fit = self.scene.fits.get(joint.name)
        declared = fit.gap_max if fit is not None and fit.gap_max is not None else 0.0
        return max(TOUCH_MM, declared) + self.scene.deflection_of(joint.parent, joint.child)

    def _relative(self, a: str, b: str) -> SE3:
        return se3_of(self.placed.relative(a, b))

    def _apart_finding(self, joint: Joint, gap: float) -> Finding:
        return Finding(
            code="E_NOT_TOUCHING",
            where=f"joints.{joint.name}",
            parts=(joint.parent, joint.child),
            message=f"{joint.parent} and {joint.child} are fixed to each other but are {gap:.4g} mm apart, and no third part connects them.",
            hint=f"Extend one of them by {gap:.4g} mm towards the other, or fix it to a part that it touches.",
            value=gap,
            limit=self._touch_limit(joint),
            unit="mm",
            cause="not_touching",
        )

    def _floating_finding(self, group: tuple[str, ...]) -> Finding:
        inside = set(group)
        outside = [name for name in self.scene.bodies if name not in inside | self.scene.environment]
        gaps = [
            (distance(self.scene.bodies[a], self.scene.bodies[b], self._relative(a, b)), a, b)
            for a in group
            if a in self.scene.bodies
            for b in outside
        ]
        gap, here, there = min(gaps)
        names = group[0] if len(group) == 1 else f"{', '.join(group[:-1])} and {group[-1]}"
        joints = [joint for joint in self.scene.relations.joints if (joint.parent in inside) != (joint.child in inside)]
        return Finding(
            code="E_FLOATING",
            where=f"joints.{joints[0].name}" if joints else f"parts.{group[0]}",
            parts=group,
            message=f"{names} touch{'es' if len(group) == 1 else ''} nothing: the nearest is {there}, {gap:.4g} mm from {here}.",
            hint=f"Move {here} to the part that holds it, or extend one of the two by about {gap:.4g} mm; a gap within {NEAR_MM:g} mm counts as held.",
            value=gap,
            limit=NEAR_MM,
            unit="mm",
            cause="floating",
        )


def _stepping_within(a: Body, b: Body, T_a_b: FloatArray, limit: float) -> bool:
    """Return whether two vertices within the limit are found by going a few times to the nearest vertex of the other body."""
    p, q = a.scattered, b.scattered
    R, t = T_a_b[:, :3], T_a_b[:, 3]
    low_b, high_b = b.mesh.bounds
    low, high = a.mesh.bounds
    middle, reach = R @ ((low_b + high_b) / 2) + t, np.abs(R) @ ((high_b - low_b) / 2)
    at = (np.maximum(low, middle - reach) + np.minimum(high, middle + reach)) / 2  # the middle of the intersection of both boxes
    for _ in range(_STEPS):
        back = (at - t) @ R
        near = q[np.argmin(b.scattered_squares - 2.0 * (q @ back))]
        there = R @ near + t
        at = p[np.argmin(a.scattered_squares - 2.0 * (p @ there))]
        away = at - there
        if away @ away <= limit * limit:
            return True
    return False


def _sampled_within(a: Body, b: Body, T_a_b: FloatArray, limit: float) -> bool:
    """Return whether two of the vertices in the intersection of two bodies' boxes are within the limit."""
    p, q = a.scattered, b.scattered @ T_a_b[:, :3].T + T_a_b[:, 3]
    low, high = a.mesh.bounds
    q = q[((q >= low - limit) & (q <= high + limit)).all(axis=1)]
    if not len(q):
        return False
    p = p[((p >= q.min(axis=0) - limit) & (p <= q.max(axis=0) + limit)).all(axis=1)]
    p, q = (v[:: max(1, len(v) // _NEAR_SAMPLES)] for v in (p, q))
    away = p[:, None] - q
    return bool(len(p)) and bool((np.einsum("pqi,pqi->pq", away, away) <= limit**2).any())
