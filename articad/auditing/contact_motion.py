"""Parts that collide while joints move: over each joint's range, with two joints at once, and the value at which contact begins."""

from __future__ import annotations

import math
from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import replace
from itertools import combinations, product

import numpy as np

from articad.auditing.contact_case import ContactCase, Contacts, explained
from articad.auditing.wording import counted, listed
from articad.certificates.certificate import certify
from articad.errors import ArticadError
from articad.findings import Finding
from articad.interference.body import relative
from articad.interference.freedoms import Freedom
from articad.interference.overlap import volume
from articad.interference.relations import Groups, Relations
from articad.interference.sweep import MotionSampler
from articad.interference.work import CLOSED, POSE, WorkBudget, look_price
from articad.kinematics.joints import JointType

STEPS = 25  # poses of a joint: every 15° of a full turn
FEWEST_STEPS = 9  # … and this many if a pose takes long
SIDE = 7  # poses of each of two joints
SCAN = 24  # poses between rest and a collision, among which the first contact is looked for
BISECTIONS = 30
CONTACT_MM3 = 1e-6  # common volume at which contact begins: an edge 10 mm long is then 0.3 µm deep
MOTION = "E_MOTION_COLLISION"
UNPROVEN = "E_NOT_CHECKED"
AT_REST = ("E_OVERLAP", "E_STATIC_OVERLAP", "W_STATIC_OVERLAP")
DEEPER = 2.0  # a pair that overlaps at rest is reported again if motion makes the overlap deeper by this factor


class _Quiet(Relations):
    """Relations for motion: pairs that may overlap by design are skipped."""

    def __init__(self, case: ContactCase) -> None:
        super().__init__(case.assembly.joints, case.assembly.waivers)
        self.rigid = _Together(self.rigid, case)


class _Together(Groups):
    def __init__(self, rigid: Groups, case: ContactCase) -> None:
        super().__init__()
        self._rigid, self._case = rigid, case

    def together(self, a: str, b: str) -> bool:
        """Return whether a pair is skipped."""
        return self._rigid.together(a, b) or self._case.by_design((a, b))


def sample_motion(case: ContactCase, found: Contacts, seconds: float) -> None:
    """Move each joint over its range, then two at a time, until the nominal seconds of work are spent."""
    budget = WorkBudget(seconds)
    sweep = MotionSampler(replace(case.scene, relations=_Quiet(case)), case.assembly.mechanism, budget)
    ranges = sweep.ranges()
    guilty = {frozenset(finding.parts) for finding in found.findings}
    resting = _depths_at_rest(found)
    late: list[str] = []
    steps = FEWEST_STEPS if case.assembly.mechanism.loop_joints else STEPS  # closing loops takes long
    for at, freedom in enumerate(ranges):
        if budget.left <= 0:
            late.append(freedom.name)
            continue
        before = budget.left
        values = np.linspace(freedom.lower, freedom.upper, steps).tolist()
        checks = sweep.sampled([{freedom.name: value} for value in values], (freedom.name,), values[1] - values[0])
        left, cost = len(ranges) - at - 1, (before - budget.left) / steps
        steps = max(FEWEST_STEPS, min(STEPS, int(budget.left / max(cost * left, 1e-9)))) if left else steps
        fresh = [finding for finding in checks.findings if _is_news(finding, resting, guilty)]
        found.findings += _collisions(case, sweep, freedom, fresh, resting, budget)
        guilty |= {frozenset(finding.parts) for finding in fresh}
    if late:
        found.findings.append(_unfinished(late, len(ranges), budget))
    undone = _pairs(case, found, sweep, ranges, guilty, budget)
    if undone:
        found.undone.append(f"{undone} of {math.comb(len(ranges), 2)} pairs of joints together: {budget.reason}")


def _depths_at_rest(found: Contacts) -> dict[frozenset[str], float]:
    return {frozenset(finding.parts): finding.value or 0.0 for finding in found.findings if finding.code in AT_REST}


def _is_news(finding: Finding, resting: Mapping[frozenset[str], float], guilty: AbstractSet[frozenset[str]]) -> bool:
    """True for a new finding: which parts collide with each joint, except for pairs that already overlap at rest."""
    pair = frozenset(finding.parts)
    if pair in resting:
        return finding.code == MOTION and (finding.value or 0.0) > DEEPER * resting[pair]
    return finding.code == MOTION or pair not in guilty


def _collisions(
    case: ContactCase,
    sweep: MotionSampler,
    freedom: Freedom,
    findings: list[Finding],
    resting: Mapping[frozenset[str], float],
    budget: WorkBudget,
) -> list[Finding]:
    """Report where each collision begins. In simulators' formats, the first one of each joint represents the others."""
    met = [
        (finding, None)
        if frozenset(finding.parts) in resting or budget.left <= 0
        else _first_contact(case, sweep, freedom, finding, budget)
        for finding in findings
    ]
    if not case.foreign or len(met) < 2:
        return [_beginning(case, freedom, told, value) for finding, value in met for told in explained(case, [finding])]
    known = [(abs(value - freedom.rest), at) for at, (_, value) in enumerate(met) if value is not None]
    finding, value = met[min(known)[1]] if known else met[0]
    others = [" and ".join(other.parts) for other, _ in met if other is not finding]
    return [
        _beginning(case, freedom, replace(told, message=f"{told.message} So do {listed(others)} elsewhere in the range."), value)
        for told in explained(case, [finding])
    ]


def _pairs(
    case: ContactCase, found: Contacts, sweep: MotionSampler, ranges: list[Freedom], guilty: set[frozenset[str]], budget: WorkBudget
) -> int:
    """Move two joints at a time on a grid; return the number of pairs left out for lack of time."""
    undone, together = 0, list[Finding]()
    for first, second in combinations(ranges, 2):
        if budget.left <= 0:
            undone += 1
            continue
        names = (first.name, second.name)
        grid = [*product(*(np.linspace(freedom.lower, freedom.upper, SIDE).tolist() for freedom in (first, second)))]
        if {name.partition(".")[2] for name in names} == {"sx", "sy"} and names[0].partition(".")[0] == names[1].partition(".")[0]:
            grid = [point for point in grid if math.hypot(*point) <= first.upper]  # a ball swings within a cone, not within a square
        checks = sweep.sampled([dict(zip(names, point, strict=True)) for point in grid], names, None)
        for finding in checks.findings:
            parts = frozenset(finding.parts)
            if finding.code == MOTION and parts not in guilty:
                guilty.add(parts)
                together.append(_together(finding, names))
    if case.foreign and len(together) > 1:
        deepest = max(together, key=lambda finding: finding.value or 0.0)
        others = [" and ".join(finding.parts) for finding in together if finding is not deepest]
        together = [
            replace(
                deepest,
                message=f"{deepest.message} {counted(len(others), 'other pair')} of parts collide in the same way: {listed(others)}.",
            )
        ]
    found.findings += together
    return undone


def prove_motion(case: ContactCase, found: Contacts, budget: float) -> None:
    """Prove the motion free of collisions, or report where it is not."""
    scene = case.scene
    certificate = certify(
        scene.meshes, case.assembly.mechanism, budget=budget, deflection=scene.deflections, waivers=case.assembly.waivers, fits=scene.fits
    )
    found.strength = "certified"
    found.certificate = certificate
    guilty = {frozenset(finding.parts) for finding in found.findings}
    resting = _depths_at_rest(found)
    fresh = [finding for finding in certificate.findings if _is_news(finding, resting, guilty)]
    found.findings += explained(case, [finding for finding in fresh if finding.code != UNPROVEN])
    unproven = [finding for finding in fresh if finding.code == UNPROVEN]
    if unproven:
        found.strength = "certified in part"
        found.findings.append(_unproven(unproven))
        found.undone += [finding.message for finding in unproven]


def _together(finding: Finding, names: tuple[str, str]) -> Finding:
    return replace(
        finding,
        code="W_AUDIT_PAIR_COLLISION",
        route=None,
        stage=None,
        message=f"{finding.message} Neither {names[0]} nor {names[1]} causes this alone.",
        hint="Narrow one of the ranges, prevent this combination, or add clearance.",
    )


def _first_contact(
    case: ContactCase, sweep: MotionSampler, freedom: Freedom, finding: Finding, budget: WorkBudget
) -> tuple[Finding, float | None]:
    """Return the value at which two parts first meet on the way from rest; None if it is unknown."""
    if finding.code != MOTION or finding.pose is None or freedom.name not in finding.pose:
        return finding, None
    a, b = finding.parts
    price = look_price(*(case.scene.bodies[name].manifold_triangles for name in (a, b)))
    price += CLOSED if case.assembly.mechanism.loop_joints else POSE

    def shared(value: float) -> float:
        budget.spend(price)
        poses = case.assembly.poses(np.array(sweep.columns({freedom.name: value})))
        T = relative(*(poses[case.assembly.mechanism.part_index(name)] for name in (a, b)))
        return volume(case.scene.bodies[a], case.scene.bodies[b], T.matrix[:3])

    try:
        least = shared(freedom.rest) + CONTACT_MM3
        values = np.linspace(freedom.rest, finding.pose[freedom.name], SCAN).tolist()
        hit = next((at for at, value in enumerate(values) if shared(value) > least), None)
        if not hit:
            return finding, None
        clear, met = values[hit - 1], values[hit]
        for _ in range(BISECTIONS):
            middle = (clear + met) / 2
            clear, met = (clear, middle) if shared(middle) > least else (middle, met)
    except ArticadError:  # a linkage that does not reach a pose between two that it reaches
        return finding, None
    return finding, met


def _beginning(case: ContactCase, freedom: Freedom, finding: Finding, met: float | None) -> Finding:
    """Return the finding with the value at which contact begins."""
    if met is None:
        return finding
    value, bound, unit = met, freedom.upper if met >= freedom.rest else freedom.lower, "mm"
    if _turns(case, freedom):
        value, bound, unit = math.degrees(value), math.degrees(bound), "deg"
    return replace(
        finding,
        message=f"{finding.message} Starting from rest, they first meet at {freedom.name} = {value:.5g} {unit}.",
        value=value,
        limit=bound,
        unit=unit,
    )


def _turns(case: ContactCase, freedom: Freedom) -> bool:
    name, _, coordinate = freedom.name.partition(".")
    joint = next(joint for joint in case.assembly.joints if joint.name in {freedom.name, name})
    if joint.name == freedom.name or joint.type is JointType.BALL:
        return joint.type is not JointType.SLIDER
    return joint.type.units[joint.type.coordinates.index(coordinate)] == "rad"


def _unproven(findings: list[Finding]) -> Finding:
    """Return one finding on everything that a proof has left open; the report lists each."""
    first = findings[0]
    others = (
        f" {counted(len(findings) - 1, 'other row')} of the report's `not_checked` {'is' if len(findings) == 2 else 'are'} of this kind."
        if findings[1:]
        else ""
    )
    return Finding(
        code="W_AUDIT_NOT_CHECKED",
        where=first.where,
        message=f"{first.message}{others}",
        hint="Raise --certify, and repair the named meshes.",
        value=len(findings),
        limit=0,
    )


def _unfinished(late: list[str], count: int, budget: WorkBudget) -> Finding:
    return Finding(
        code="W_AUDIT_NOT_CHECKED",
        where=f"joints.{late[0]}",
        message=f"The motion of {len(late)} of {counted(count, 'freedom')} was not checked: {listed(late)}. {budget.ended()}",
        hint="Raise --budget.",
        value=len(late),
        limit=0,
    )
