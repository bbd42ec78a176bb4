"""Remedies: single changes of a plan that end all its findings.

A mistake in one place of a plan shows in several: each joint that meets there reports its own numbers, and to follow all of them one after
another does not lead back. So mistakes are tried in reverse: a pose or connector is shifted by what connectors are apart, axes are reversed
or exchanged, poses of two parts and the two ends of joints are exchanged, copies are put on the other side, couplings get the other sense
or ratio, limits the other sign. A change is offered only if the whole check of the plan then finds nothing. It need not be the one that was meant: geometry is not known here.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from articad.aliases import Json
from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.errors import ArticadError
from articad.findings import Finding, Findings
from articad.kinematics.joints import Joint
from articad.plan.amending import amended
from articad.plan.check import admitted, check_plan
from articad.plan.draft import Draft
from articad.plan.rest import identity_or
from articad.plan.schema import TURNING_KINDS, AssemblyPlan, PartSpec, Pose

__all__ = ["Changes", "advised", "digits", "of_couplings", "offered", "remedies", "turned", "with_other_sign"]

Changes = Mapping[str, Any]
"""New values by address, as `articad.plan.amending.amended` takes them."""

_MATES: Final = frozenset({"E_MATE_OFFSET", "E_MATE_FLIP", "E_MATE_TILT", "E_MATE_ROLL"})
_RANGES: Final = frozenset({"E_LOOP_LIMIT", "E_DEAD_POINT", "E_REST_OUTSIDE_LIMITS"})
_OF_NUMBERS: Final = _RANGES | {"E_PARAMETER_BOUNDS", "E_ENVELOPE_VALUE"}
_SOUGHT: Final = _MATES | _OF_NUMBERS | {"E_DISCONNECTED", "E_DOF_MISMATCH", "E_COUPLING_AXES"}
"""Codes of findings for which changes are sought."""
_TRIALS: Final = 160  # checks of a plan with findings
_OFFERED: Final = 3  # changes that a hint states
_LEAST_MM: Final = 0.01  # as far as connectors may be apart
_DECIMALS: Final = 4  # of mm in a change; axes get two more
_LIMITED: Final[Mapping[str, Json]] = {
    "ball_centre": {"type": "ball", "cone_deg": 20},
    "slide_axis": {"type": "slider", "travel_mm": [0, 100]},
    "thread_axis": {"type": "screw", "lead_mm": 2, "angle_deg": [0, 360]},
}
"""Joints that suit other kinds, with examples of limits."""


def advised(plan: AssemblyPlan) -> Findings:
    """Return what `check_plan` finds; the hint of the first finding also states single changes that end all of them, if there are any."""
    found = check_plan(plan)
    serious = [finding for finding in found if finding.severity != "info"]
    changes = remedies(plan, serious)
    if not changes:
        return found
    first = serious[0]
    told = replace(first, hint=f"{offered(changes, len(serious))} {first.hint}")
    return Findings(told if finding is first else finding for finding in found)


def offered(changes: Sequence[Changes], findings: int) -> str:
    """Return the advice to make one of some changes, each of which ends so many findings."""
    what = f"all {findings} findings" if findings > 1 else "this finding"
    how = "One change ends" if len(changes) == 1 else "Any of these changes alone ends"
    told = " or ".join(json.dumps(change) for change in changes)
    examples = " The limits of the joint are examples: give those that are meant." if any(map(_has_examples, changes)) else ""
    return f"{how} {what}: {told}.{examples}"


def _has_examples(change: Changes) -> bool:
    """Return whether a change adds a joint of `_LIMITED`, whole or field by field."""
    (value, *_) = change.values()
    joint = value if isinstance(value, dict) else {address.rpartition(".")[2]: each for address, each in change.items()}
    return any(all(joint.get(key) == each for key, each in form.items()) for form in _LIMITED.values())


def remedies(plan: AssemblyPlan, findings: Iterable[Finding]) -> list[Changes]:
    """Return single changes after which a plan has no error and no warning, at most one for each kind of change.

    Args:
        plan: A plan with findings.
        findings: Its errors and warnings; changes are sought where connectors do not meet, parts are not connected, or ranges cannot be reached.
    """
    several = list(findings)
    if _SOUGHT.isdisjoint(finding.code for finding in several):
        return []
    whole, draft = plan.to_json(), Draft(plan)
    found: dict[str, Changes] = {}
    for kind, change in itertools.islice(_unique(_candidates(draft, whole, several)), _TRIALS):
        if kind not in found and _heals(whole, change):
            found[kind] = change
        if len(found) == _OFFERED:
            break
    return list(found.values())


def _unique(candidates: Iterable[tuple[str, Changes]]) -> Iterator[tuple[str, Changes]]:
    seen = set()
    for kind, change in candidates:
        mark = json.dumps(change)
        if mark not in seen:
            seen.add(mark)
            yield kind, change


def _heals(whole: Json, change: Changes) -> bool:
    try:
        plan = AssemblyPlan.from_json(amended(whole, change))
        _, found = admitted(plan)  # without its parameters' bounds, which takes much less time
    except (ArticadError, ValueError):
        return False
    return not any(finding.severity != "info" for finding in (*found, *check_plan(plan)))


def _candidates(draft: Draft, whole: Json, findings: Sequence[Finding]) -> Iterator[tuple[str, Changes]]:
    """Yield changes by kind, those that correct most at once first."""
    joints = {joint.name: joint for joint in draft.joints}
    apart = [joints[name] for one in findings if one.code in _MATES and (name := one.where.removeprefix("joints.")) in joints]
    apart = list(dict.fromkeys(apart))
    coupled = [joints[name] for name in _coupled(whole, findings) if name in joints]
    about = dict.fromkeys(name for one in findings for name in one.parts if name in draft.parts)
    codes = {one.code for one in findings}
    if codes & _RANGES:
        yield from ((".".join(next(iter(change)).split(".")[:2]), change) for change in of_couplings(whole))
        yield from _limits(draft, whole, findings)
    if codes & _OF_NUMBERS:
        yield from _units(whole)
    if not codes & (_SOUGHT - _OF_NUMBERS):
        return
    yield from _structure(draft, whole, findings)
    yield from _copies(whole, draft, about)
    yield from _exchanged(draft, about)
    shifts = [_shift(draft, joint) for joint in apart]
    yield from _poses(draft, about, shifts)
    yield from _mates(apart, draft, joints)
    placing = [joints[name] for name in draft.auto_joints if name in joints and {joints[name].parent, joints[name].child} & about.keys()]
    yield from _connectors(draft, [*apart, *placing, *coupled], shifts)
    sources = {spec.name for name in about if (spec := draft.parts[name].spec) is not None}
    alike = [
        joint for joint in joints.values() if any((spec := draft.parts[part].spec) and spec.name in sources for part, _ in _ends(joint))
    ]
    yield from _both_ends(draft, [*apart, *placing, *coupled, *alike], shifts)


def _coupled(whole: Json, findings: Iterable[Finding]) -> list[str]:
    """Return the joints of couplings whose axes do not suit."""
    wrong = {one.where for one in findings if one.code == "E_COUPLING_AXES"}
    couplings = [one for one in whole.get("couplings", ()) if f"couplings.{one['name']}" in wrong]
    return list(dict.fromkeys(name.split(".")[0] for one in couplings for name in one["joints"]))


# ---------------------------------------------------------------- structure


def of_couplings(whole: Json) -> Iterator[Changes]:
    """Yield couplings of the other sense, or of another ratio: exchanged, halved and doubled."""
    for coupling in whole.get("couplings", ()):
        where = f"couplings.{coupling['name']}"
        for key in ("ratio", "lead_mm"):
            if key in coupling:
                value = coupling[key]
                yield from ({f"{where}.{key}": other} for other in (_minus(value), _times(value, 0.5), _times(value, 2.0)))
        for key in ("teeth", "radii_mm"):
            if isinstance(coupling.get(key), list):
                yield {f"{where}.{key}": coupling[key][::-1]}
        if coupling["type"] == "gear":
            yield {f"{where}.internal": not coupling.get("internal", False)}


def _times(value: Any, factor: float) -> Any:
    return f"({value}) * {factor:g}" if isinstance(value, str) else value * factor


def _limits(draft: Draft, whole: Json, findings: Iterable[Finding]) -> Iterator[tuple[str, Changes]]:
    """Yield limits of joints with the other sign, and limits as wide about the rest value that they do not contain."""
    for joint in whole["joints"]:
        for change in with_other_sign(whole, joint["name"]):
            yield f"limits of {joint['name']}", change
    numbers = {joint.name: joint.limits for joint in draft.joints if len(joint.limits.lower) == 1}
    for one in findings:
        name = one.where.split(".")[1] if one.code == "E_REST_OUTSIDE_LIMITS" else ""
        if name in numbers and one.value is not None:
            half = (numbers[name].upper[0] - numbers[name].lower[0]) / 2.0
            half = math.degrees(half) if one.unit == "deg" else half
            yield f"limits of {name}", {one.where: _numbers(np.array([one.value - half, one.value + half]))}


def with_other_sign(whole: Json, name: str) -> Iterator[Changes]:
    """Yield the limits of a joint with the other sign."""
    joint: Json = next((joint for joint in whole["joints"] if joint["name"] == name), {})
    for key in ("angle_deg", "travel_mm"):
        if isinstance(joint.get(key), list):
            low, high = joint[key]
            if str(low) != str(_minus(high)):
                yield {f"joints.{name}.{key}": [_minus(high), _minus(low)]}


def _units(whole: Json) -> Iterator[tuple[str, Changes]]:
    """Yield parameters that were given in another unit: those outside their bounds first, then those that get a rounder number."""
    lengths = [one for one in whole.get("parameters", ()) if isinstance(one["value"], int | float) and one.get("unit", "mm") == "mm"]
    trials = [(one, round(one["value"] * factor, _DECIMALS)) for one in lengths for factor in (25.4, 1000.0, 0.001)]
    for parameter, value in sorted(trials, key=lambda trial: (_is_within_bounds(trial[0]), digits(trial[1]) >= digits(trial[0]["value"]))):
        yield f"unit of {parameter['name']}", {f"parameters.{parameter['name']}.value": value}


def _is_within_bounds(parameter: Json) -> bool:
    low, high = (bound if isinstance(bound := parameter.get(key), int | float) else parameter["value"] for key in ("min", "max"))
    return bool(low <= parameter["value"] <= high)


def digits(value: float) -> int:
    """Return how many significant digits a number has, of six."""
    return len(f"{abs(value):.5e}".partition("e")[0].replace(".", "").rstrip("0"))


_Free = tuple[str, str, str]  # part, connector and kind of a connector that no joint uses


def _structure(draft: Draft, whole: Json, findings: Sequence[Finding]) -> Iterator[tuple[str, Changes]]:
    """Yield other ends for joints, joints between connectors that none uses, and motions for joints that are fixed."""
    used = {end for joint in whole["joints"] for end in (joint["parent"], joint["child"])}
    every = [(part.name, spec.name, spec.kind) for part in draft.parts.values() for spec in part.connector_specs]
    free = [one for one in every if f"{one[0]}.{one[1]}" not in used]
    own = [joint for joint in whole["joints"] if "derive" not in joint]
    yield from _other_ends(own, free)
    if any(one.code == "E_DISCONNECTED" for one in findings):
        yield from _further_joints(draft, free)
    kinds = {f"{part}.{name}": kind for part, name, kind in every}
    for joint in (joint for joint in own if joint["type"] == "fixed"):
        ends = dict.fromkeys(kinds.get(joint[end], "") for end in ("child", "parent"))
        for form in (form for kind in ends for form in _forms(kind)):
            if form["type"] != "fixed":
                yield f"type of {joint['name']}", {f"joints.{joint['name']}.{key}": value for key, value in form.items()}


def _other_ends(joints: Iterable[Json], free: Sequence[_Free]) -> Iterator[tuple[str, Changes]]:
    for joint, (part, name, _) in itertools.product(joints, free):
        for end, other in (("parent", "child"), ("child", "parent")):
            if joint[other].split(".")[0] != part:
                yield f"end of {joint['name']}", {f"joints.{joint['name']}.{end}": f"{part}.{name}"}


def _further_joints(draft: Draft, free: Sequence[_Free]) -> Iterator[tuple[str, Changes]]:
    for (part, name, kind), (other, at, _) in itertools.permutations(free, 2):
        if part != other and _meet(draft, (part, name), (other, at)):
            for form in _forms(kind):
                joint = {**form, "parent": f"{part}.{name}", "child": f"{other}.{at}"}
                yield f"joint of {' and '.join(sorted((part, other)))}", {f"joints.{other}_on_{part}": joint}


def _forms(kind: str) -> Iterator[Json]:
    """Yield joints that suit a kind of connector, without limits where they need none."""
    if kind in _LIMITED:
        yield dict(_LIMITED[kind])
    if kind in TURNING_KINDS:
        yield {"type": "revolute", "angle_deg": "endless"}
    yield {"type": "fixed"}


def _meet(draft: Draft, first: tuple[str, str], second: tuple[str, str]) -> bool:
    """Return whether two connectors have the same place at rest, or may have it because nothing places one of their parts."""
    places = []
    for part, name in (first, second):
        held = draft.parts[part]
        if held.T is None:
            return True
        if name not in held.connectors:
            return False
        places.append(held.T.apply(held.connectors[name].frame.translation))
    return bool(np.linalg.norm(places[0] - places[1]) < _LEAST_MM)


def turned(plan: AssemblyPlan, joints: Iterable[str]) -> Iterator[Changes]:
    """Yield the other mate of some joints, and their connectors with a reversed axis, exchanged axes, or turned about their axis."""
    draft = Draft(plan)
    chosen = [joint for joint in draft.joints if joint.name in set(joints)]
    yield from (change for _, change in _mates(chosen, draft, {}))
    owners = [(spec.name, name) for joint in chosen for part, name in _ends(joint) if (spec := draft.parts[part].spec) is not None]
    for part, name in dict.fromkeys(owners):
        yield from (change for _, change in _altered(draft, part, name, ()))


def _copies(whole: Json, draft: Draft, about: Iterable[str]) -> Iterator[tuple[str, Changes]]:
    """Yield copies on the other side, and mirror planes with another normal."""
    derived = {part["name"]: part["derive"] for part in whole["parts"] if "derive" in part}
    for name in dict.fromkeys(draft.parts[one].form.name for one in about):
        derive = derived.get(name, {})
        for key in ("move", "step"):
            at = derive.get(key, {}).get("at")
            if at:
                yield f"copy {name}", {f"parts.{name}.derive.{key}.at": [_minus(value) for value in at]}
        normal = derive.get("plane", {}).get("normal")
        for turned in [normal[1:] + normal[:1], normal[2:] + normal[:2]] if normal else []:
            yield f"copy {name}", {f"parts.{name}.derive.plane.normal": turned}


def _minus(value: Any) -> Any:
    return f"-({value})" if isinstance(value, str) else 0.0 - value


# ---------------------------------------------------------------- poses and mates


def _exchanged(draft: Draft, about: Iterable[str]) -> Iterator[tuple[str, Changes]]:
    """Yield the rest poses of two parts exchanged."""
    posed = [name for name in about if _is_posed(draft, name)]
    for one, other in itertools.combinations(posed, 2):
        poses = [draft.parts[name].form.rest_pose.model_dump(exclude_unset=True) for name in (one, other)]  # type: ignore[union-attr]
        if poses[0] != poses[1]:
            yield "poses", {f"parts.{one}.rest_pose": poses[1], f"parts.{other}.rest_pose": poses[0]}


def _is_posed(draft: Draft, name: str) -> bool:
    form = draft.parts[name].form
    return isinstance(form, PartSpec) and isinstance(form.rest_pose, Pose)


def _shift(draft: Draft, joint: Joint) -> FloatArray:
    """Return how far the child of a joint is off, `(3,)`, in the assembly's frame [mm]."""
    expected, actual = _frames(draft, joint)
    return np.asarray(actual.translation - expected.translation)


def _frames(draft: Draft, joint: Joint) -> tuple[SE3, SE3]:
    """Return where the child's connector of a joint has to be at rest, and where it is, in the assembly's frame."""
    parent, child = draft.parts[joint.parent].T, draft.parts[joint.child].T
    assert parent is not None
    assert child is not None
    return parent @ joint.T_parent_connector @ identity_or(joint), child @ joint.T_child_connector


def _poses(draft: Draft, about: Iterable[str], shifts: Sequence[FloatArray]) -> Iterator[tuple[str, Changes]]:
    """Yield rest poses that are shifted by what connectors are apart, either way."""
    for name in about:
        form = draft.parts[name].form
        if not isinstance(form, PartSpec) or not isinstance(form.rest_pose, Pose) or name == draft.plan.ground:
            continue
        for shift, sign in itertools.product(shifts, (-1.0, 1.0)):
            yield f"pose of {name}", {f"parts.{name}.rest_pose.at": _plus(form.rest_pose.at, sign * shift)}


def _mates(apart: Sequence[Joint], draft: Draft, joints: Mapping[str, Joint]) -> Iterator[tuple[str, Changes]]:
    for joint in dict.fromkeys((*apart, *(joints[name] for name in draft.auto_joints if name in joints))):
        yield f"mate of {joint.name}", {f"joints.{joint.name}.mate": "aligned" if str(joint.mate) == "opposed" else "opposed"}


# ---------------------------------------------------------------- connectors


def _connectors(draft: Draft, joints: Sequence[Joint], shifts: Sequence[FloatArray]) -> Iterator[tuple[str, Changes]]:
    """Yield connectors that meet their joint's other end, are shifted by what others are apart, reversed, or have axes exchanged."""
    ends = [(joint, part, name) for joint in joints for part, name in _ends(joint)]
    for joint, part, name in ends:
        held = draft.parts[part]
        if not held.derived:
            yield from _meeting(draft, joint, part, name)
    for part, name in dict.fromkeys((draft.parts[part].spec.name, name) for _, part, name in ends if draft.parts[part].spec is not None):  # type: ignore[union-attr]
        yield from _altered(draft, part, name, shifts)


def _both_ends(draft: Draft, joints: Iterable[Joint], shifts: Sequence[FloatArray]) -> Iterator[tuple[str, Changes]]:
    """Yield both connectors of a joint altered in the same way: they agree with each other, but not with what else is there."""
    for joint in dict.fromkeys(joints):
        specs = [draft.parts[part].spec for part, _ in _ends(joint)]
        if any(spec is None for spec in specs):
            continue
        owners = [(spec.name, name) for spec, (_, name) in zip(specs, _ends(joint), strict=True) if spec is not None]
        for (_, one), (_, other) in zip(*(_altered(draft, part, name, shifts) for part, name in owners), strict=False):
            yield f"ends of {joint.name}", {**one, **other}


def _ends(joint: Joint) -> tuple[tuple[str, str], tuple[str, str]]:
    return (joint.child, joint.child_connector), (joint.parent, joint.parent_connector)


def _meeting(draft: Draft, joint: Joint, part: str, name: str) -> Iterator[tuple[str, Changes]]:
    """Yield a connector at the place and with the axes that its joint's other end demands."""
    expected, actual = _frames(draft, joint)
    wanted = expected if part == joint.child else actual @ identity_or(joint).inverse()
    right = _stated(draft, part, name, wanted)
    spec = next(spec for spec in draft.parts[part].connector_specs if spec.name == name)
    address = f"parts.{part}.connectors.{name}"
    now = draft.parts[part].T
    assert now is not None
    off = right.translation - _stated(draft, part, name, now @ draft.parts[part].connectors[name].frame).translation
    change: dict[str, Any] = {f"{address}.o": _plus(spec.o, off)}
    yield f"connector {part}.{name}", change
    change = change | {f"{address}.z": _numbers(right.z_axis, 6)} | ({f"{address}.x": _numbers(right.x_axis, 6)} if spec.x else {})
    yield f"connector {part}.{name}", change
    yield f"connector {part}.{name}", {key: value for key, value in change.items() if not key.endswith(".o")}


def _altered(draft: Draft, part: str, name: str, shifts: Sequence[FloatArray]) -> Iterator[tuple[str, Changes]]:
    """Yield a connector shifted along what others are apart, with a reversed axis, turned about it, or with axes exchanged."""
    spec = next(spec for spec in draft.parts[part].connector_specs if spec.name == name)
    pose, now = draft.parts[part].T, draft.parts[part].connectors.get(name)
    if pose is None or now is None:
        return
    kind, address = f"connector {part}.{name}", f"parts.{part}.connectors.{name}"
    place = pose @ now.frame
    for shift, sign in itertools.product(shifts, (1.0, -1.0)):
        if np.linalg.norm(shift) > _LEAST_MM:
            there, here = (_stated(draft, part, name, one) for one in (SE3.from_translation(sign * shift) @ place, place))
            yield kind, {f"{address}.o": _plus(spec.o, there.translation - here.translation)}
    z, x = list(spec.z), list(spec.x) if spec.x else None
    yield kind, {f"{address}.z": [_minus(value) for value in z]}
    for turns in (1, 2):
        change: dict[str, Any] = {f"{address}.z": z[turns:] + z[:turns]}
        yield kind, change | ({f"{address}.x": x[turns:] + x[:turns]} if x else {})
    if x:
        frame = _stated(draft, part, name, place)
        across = np.cross(frame.z_axis, frame.x_axis)
        for axis in (across, -across, -frame.x_axis):
            yield kind, {f"{address}.x": _numbers(axis, 6)}


def _stated(draft: Draft, part: str, name: str, frame: SE3) -> SE3:
    """Return a frame of the assembly in the frame in which a connector is stated."""
    held = draft.parts[part]
    spec = next(spec for spec in held.connector_specs if spec.name == name)
    assert held.T is not None
    return frame if spec.frame == "assembly" else held.T.inverse() @ frame


def _plus(stated: Sequence[Any], shift: FloatArray) -> list[Any]:
    """Return stated coordinates plus a shift; expressions stay, so that they follow their parameters."""
    sums: list[Any] = []
    for value, more in zip(stated, _numbers(shift), strict=True):
        if isinstance(value, str):
            sums.append(f"({value}) + {more}" if more else value)
        else:
            sums += _numbers(np.array([value + more]))
    return sums


def _numbers(values: FloatArray, decimals: int = _DECIMALS) -> list[float]:
    rounded = [round(float(value), decimals) + 0.0 for value in values]
    return [int(value) if value == int(value) else value for value in rounded]
