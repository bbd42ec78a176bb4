"""Trials: single changes of a plan that end all faults of a built product, found by trying them.

What was found may follow from one number: a dimension in another unit, limits with the other sign, the ratio of a coupling, or a range beyond
the place where parts meet. Each such change is made, what it shapes is built again, and the product is examined as before. A change is
offered only if nothing is found then. It need not be the one that was meant.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

from articad.agents.orders import FITS, as_built, source_of
from articad.aliases import Json
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.findings import Finding, Findings
from articad.interference.check import check_scene
from articad.interference.scene import Scene
from articad.kernels.slips import LONGEST, UNITS, longest_other, numbers_of
from articad.kinematics.joints import Coordinate
from articad.plan.fields import lengths_in
from articad.plan.remedies import Changes, digits, of_couplings, offered, turned, with_other_sign
from articad.plan.resolve import ResolvedPlan
from articad.render.pictures import motion_frames

__all__ = ["with_trials"]

Examine = Callable[[Assembly], Findings]
"""Returns the findings about an assembly as built."""
_BUILDS: Final = 6  # products that are built for trials
_EXAMINED: Final = 3  # products that are examined whole
_OFFERED: Final = 2  # changes that a hint states
_POSES: Final = 9  # of a joint's range
_HALVINGS: Final = 6  # of the step between a free pose and the next one
_MARGIN: Final = 0.01  # of a range: distance from the pose at which parts meet
_SHORT: Final = 0.05  # of a range: a shorter one is no motion
_DECIMALS: Final = 4  # of mm in a change
_SOUGHT: Final = FITS | {
    "E_OVERLAP",
    "E_STATIC_OVERLAP",
    "E_MOTION_COLLISION",
    "E_FLOATING",
    "E_NOT_TOUCHING",
}
"""Codes of faults that one number may cause."""


def with_trials(findings: Findings, assembly: Assembly, examine: Examine) -> Findings:
    """Return findings of which the first for the designer also states single changes of the plan that end all of them, if there are any.

    Then all of them go to the designer, unless these only declare fits as they are built.

    Args:
        findings: Of an examination of the assembly.
        assembly: A product that was built from a plan.
        examine: Examines it again.
    """
    serious = [finding for finding in findings if finding.severity != "info"]
    asked = [finding for finding in serious if finding.severity == "error" and finding.route == "design" and finding.code in _SOUGHT]
    if assembly.resolved is None or not asked:
        return findings
    changes = list(itertools.islice(_healing(asked, assembly, assembly.resolved, examine), _OFFERED))
    if not changes:
        return findings
    told = replace(asked[0], hint=f"{offered(changes, len(serious))} {asked[0].hint}")
    is_cause = any(".fit." not in address for change in changes for address in change)  # a fit declared as it is built explains nothing
    whole = [replace(finding, route="design") if is_cause and finding.code in _SOUGHT else finding for finding in findings]
    return Findings([told if finding is asked[0] else other for finding, other in zip(findings, whole, strict=True)])


def _healing(asked: Sequence[Finding], assembly: Assembly, resolved: ResolvedPlan, examine: Examine) -> Iterator[Changes]:
    """Yield changes after which nothing is found."""
    examined = 0
    for change, builds in _candidates(asked, assembly, resolved):
        if examined == _EXAMINED:
            return
        try:
            other = assembly.with_changes(change, build=builds)
            if _still_overlap(other, asked):
                continue
            examined += 1
            if all(finding.severity == "info" for finding in examine(other)):
                yield change
        except (ArticadError, ValueError):
            continue


def _still_overlap(assembly: Assembly, asked: Sequence[Finding]) -> bool:
    """Return whether two parts that overlapped at rest still do."""
    pairs = {tuple(finding.parts) for finding in asked if finding.code in {"E_OVERLAP", "E_STATIC_OVERLAP"} and len(finding.parts) == 2}
    scene, at_rest = assembly.scene(), assembly.at()
    return any(set(pair) <= scene.bodies.keys() and not _is_clear(scene, pair, at_rest) for pair in sorted(pairs))


def _is_clear(scene: Scene, pair: Collection[str], poses: Mapping[str, SE3]) -> bool:
    """Return whether two parts are clear of each other, whatever all others are."""
    alone = replace(scene, meshes={name: mesh for name, mesh in scene.meshes.items() if name in pair})
    return not check_scene(alone, poses, over="pose").findings.errors


def _candidates(asked: Sequence[Finding], assembly: Assembly, resolved: ResolvedPlan) -> Iterator[tuple[Changes, bool]]:
    """Yield changes, and whether parts must be built for them: of numbers that shape the parts at fault, then of motions."""
    colliding = [finding for finding in asked if finding.code == "E_MOTION_COLLISION"]
    at_rest = [finding for finding in asked if finding.code != "E_MOTION_COLLISION" and not finding.pose]
    if declared := _declared(asked, assembly, resolved):
        yield declared, False
    if at_rest:
        pairs = [set(finding.parts) for finding in at_rest]
        between = [joint.name for joint in assembly.joints if {joint.parent, joint.child} in pairs]
        yield from ((change, False) for change in turned(resolved.plan, between))
    if at_rest or not colliding:
        yield from ((change, True) for change in itertools.islice(_units(at_rest or asked, resolved), _BUILDS))
    if colliding and not at_rest:
        yield from ((change, False) for change in _motions(colliding, assembly, resolved))
        yield from ((change, True) for change in itertools.islice(_units(colliding, resolved), _BUILDS))


def _declared(asked: Sequence[Finding], assembly: Assembly, resolved: ResolvedPlan) -> Changes:
    """Return the change that declares all fits as they were built; empty if more than fits is at fault, or parts of a fit overlap."""
    whole, change = resolved.plan.to_json(), dict[str, Any]()
    for finding in asked:
        joint = finding.where.removeprefix("joints.").removesuffix(".fit")
        fields = as_built(finding, assembly.fits[joint]) if finding.code in FITS and joint in assembly.fits else {}
        if not fields:
            return {}
        for key, value in fields.items():
            address = f"joints.{_stated(whole, joint)}.fit.{key}"
            other = change.get(address, value)
            change[address] = value if key == "contact" else [min(value[0], other[0]), max(value[1], other[1])]
    return change


def _units(asked: Sequence[Finding], resolved: ResolvedPlan) -> Iterator[Changes]:
    """Yield numbers that shape the parts at fault, in another unit or with the other sign; those that become rounder first."""
    sources = dict.fromkeys(source_of(name, resolved) for finding in asked for name in finding.parts if name in resolved.parts)
    trials: dict[tuple[str, float], float] = {}  # what a number may have been meant to be, and what it is
    for source in sources:
        lengths = lengths_in(resolved.parts[source].dimensions)
        for address, (value, driven) in numbers_of(resolved, source, lengths).items():
            for meant in _meant(value, longest_other(lengths, driven)):
                trials.setdefault((address, meant), value)
    for (address, meant), _ in sorted(trials.items(), key=lambda item: digits(item[0][1]) - digits(item[1])):
        yield {address: float(meant)}


def _meant(value: float, longest: float) -> Iterator[float]:
    """Yield what a length may have been meant to be, beside the longest other one of its part [mm]."""
    for factor in UNITS:
        meant = round(value * factor, _DECIMALS)
        if 0.0 < abs(meant) <= LONGEST * longest and digits(meant) < digits(value):
            yield meant
    if abs(value) > longest > 0.0:
        yield round(value / 1000.0, _DECIMALS)
    if value < 0.0:
        yield -value


# ---------------------------------------------------------------- motions


def _motions(colliding: Sequence[Finding], assembly: Assembly, resolved: ResolvedPlan) -> Iterator[Changes]:
    """Yield other limits and couplings of the joints in whose motion parts collide."""
    whole = resolved.plan.to_json()
    joints = list(dict.fromkeys(finding.where.removeprefix("joints.") for finding in colliding))
    moving = [joint for joint in joints if joint in assembly.mechanism.driving_joints]
    for joint in moving:
        yield from with_other_sign(whole, _stated(whole, joint))
    yield from of_couplings(whole)
    narrowed: dict[str, Any] = {}
    for joint in moving:
        narrowed |= _narrowed(joint, [finding for finding in colliding if finding.where == f"joints.{joint}"], assembly, whole)
    if narrowed:
        yield narrowed


def _stated(whole: Json, joint: str) -> str:
    """Return the joint of a plan that states the motion of a joint: that from which it is derived."""
    entries = {entry["name"]: entry for entry in whole["joints"]}
    while joint in entries and "derive" in entries[joint]:
        joint = entries[joint]["derive"]["from"]
    return joint


def _narrowed(joint: str, colliding: Sequence[Finding], assembly: Assembly, whole: Json) -> Changes:
    """Return the limits within which the pairs of some findings do not collide, with the rest value; empty if there is no such range."""
    own = [(column, driver) for column, driver in enumerate(assembly.drivers) if driver.joint == joint]
    name = _stated(whole, joint)
    entry: Json = next((entry for entry in whole["joints"] if entry["name"] == name), {})
    key = next((key for key in ("angle_deg", "travel_mm") if isinstance(entry.get(key), list)), None)
    if len(own) != 1 or key is None or name != joint:
        return {}
    ((column, driver),) = own
    clear = _clear(column, colliding, assembly)
    values = [float(q[column]) for q in motion_frames(assembly, joint, _POSES)[1]]
    low, high = (_end(driver.rest, side, clear) for side in _sides(values, driver.rest))
    margin = _MARGIN * (values[-1] - values[0])
    low, high = (bound if bound in (values[0], values[-1]) else bound + sign * margin for bound, sign in ((low, 1.0), (high, -1.0)))
    if not low <= driver.rest <= high or high - low < _SHORT * (values[-1] - values[0]):
        return {}
    return {f"joints.{joint}.{key}": _rounded_inwards(low, high, driver)}


def _sides(values: Sequence[float], rest: float) -> tuple[list[float], list[float]]:
    """Return the values on each side of rest, from rest outwards."""
    return sorted((value for value in values if value < rest), reverse=True), sorted(value for value in values if value > rest)


def _clear(column: int, colliding: Sequence[Finding], assembly: Assembly) -> Callable[[float], bool]:
    """Return a test whether the pairs of some findings are clear of each other at a value of a driver, all others at rest."""
    scene = assembly.scene()
    pairs = {frozenset(finding.parts) for finding in colliding}

    def clear(value: float) -> bool:
        q = assembly.mechanism.rest.copy()
        q[column] = value
        poses = dict(zip(assembly.mechanism.parts, assembly.poses(q), strict=True))
        return all(_is_clear(scene, pair, poses) for pair in pairs)

    return clear


def _end(rest: float, outwards: Sequence[float], clear: Callable[[float], bool]) -> float:
    """Return the last value from rest outwards at which all is clear."""
    free = rest
    for value in outwards:
        if clear(value):
            free = value
            continue
        hit = value
        for _ in range(_HALVINGS):
            middle = (free + hit) / 2.0
            free, hit = (middle, hit) if clear(middle) else (free, middle)
        break
    return free


def _rounded_inwards(low: float, high: float, driver: Coordinate) -> list[float]:
    """Return a range in degrees or mm, to a tenth."""
    scale = math.degrees(1.0) if driver.unit == "rad" else 1.0
    return [math.ceil(10.0 * scale * low - 1e-6) / 10.0 + 0.0, math.floor(10.0 * scale * high + 1e-6) / 10.0 + 0.0]
