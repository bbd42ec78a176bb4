"""Fine-tuning: a connector that a script placed slightly off the plan's position is taken into a new version of the plan.

The mechanism is always the plan's. Where a script placed a connector better, within the bounds of a warning, the plan follows: the
connector moves, and the parts attached to it move along. Expressions stay expressions, so that parameters keep their effect. Where the
plan would become invalid, the script has to change instead.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping

import numpy as np

from articad.aliases import Json
from articad.arrays import FloatArray
from articad.errors import PlanError
from articad.findings import Finding
from articad.kernels.contract import DRIFT_ANGLE, primary_connector, seating
from articad.kernels.parts import RealisedPart
from articad.plan.check import check_plan
from articad.plan.resolve import ResolvedPlan
from articad.plan.schema import AssemblyPlan

_DIGITS = 6  # decimals of mm


def absorbed(resolved: ResolvedPlan, realised: Mapping[str, RealisedPart]) -> AssemblyPlan | None:
    """Return the plan with the connectors where these parts have them, or None if that plan would be invalid.

    A rotated connector is not taken over, nor the one that places the part: in that case the whole part was built elsewhere.

    Args:
        resolved: The plan with its numbers.
        realised: Parts with connector drift, by name.
    """
    document: Json = json.loads(resolved.plan.dumps())
    entries: dict[str, Json] = {entry["name"]: entry for entry in document["parts"]}
    for name, part in realised.items():
        for connector, shift, turn in _drifts(resolved, name, part):
            if turn > DRIFT_ANGLE or connector == primary_connector(resolved.parts[name], part.built.brief):
                return None
            rest = resolved.parts[name].T_rest
            _move(_connector(entries[name], connector), "o", _in_frame(entries[name], connector, shift, rest.rotate(shift)))
            for follower in _followers(resolved, name, connector):
                if "derive" in entries.get(follower, {"derive": None}):
                    continue  # it follows its source; if that fails, the check below rejects it
                _carry(entries[follower], rest.rotate(shift))
    try:
        plan = AssemblyPlan.from_json(document)
    except PlanError:
        return None
    return plan if check_plan(plan).ok else None


def notes(realised: Mapping[str, RealisedPart]) -> Iterator[Finding]:
    """Yield a finding for each connector that was taken over."""
    for part in realised.values():
        for drift in part.findings.of("W_CONNECTOR_DRIFT"):
            hint = "The next version of the plan has it where the script does."
            yield Finding(code="I_ABSORBED", where=drift.where, parts=drift.parts, message=drift.message, hint=hint, value=drift.value)


def _drifts(resolved: ResolvedPlan, name: str, part: RealisedPart) -> Iterator[tuple[str, FloatArray, float]]:
    """Yield connectors that are off, with the offset in the part's frame [mm] and the angle of rotation [rad]."""
    target = resolved.parts[name]
    T = seating(target, part.built.connectors, primary_connector(target, part.built.brief))
    for finding in part.findings.of("W_CONNECTOR_DRIFT"):
        connector = finding.where.rsplit(".", maxsplit=1)[-1]
        planned, frame = target.connectors[connector], T @ part.built.connectors[connector].frame
        drift = planned.drift(frame)
        turn = max(drift.axis, 0.0 if planned.roll_free else abs(drift.roll))
        yield connector, np.asarray(frame.translation - planned.frame.translation), float(turn)


def _followers(resolved: ResolvedPlan, name: str, connector: str) -> list[str]:
    """Return the parts that are attached to a connector, seen from the ground."""
    tree = resolved.mechanism.tree
    followers: list[str] = []
    for joint, side in resolved.joints_at.get((name, connector), ()):
        other = joint.child if side == "parent" else joint.parent
        if resolved.parts[other].parent_joint == joint.name:
            followers += tree.subtree(other)
    return list(dict.fromkeys(followers))


def _connector(entry: Json, name: str) -> Json:
    found: Json = next(connector for connector in entry["connectors"] if connector["name"] == name)
    return found


def _in_frame(entry: Json, connector: str, in_part: FloatArray, in_assembly: FloatArray) -> FloatArray:
    return in_assembly if _connector(entry, connector).get("frame") == "assembly" else in_part


def _carry(entry: Json, shift: FloatArray) -> None:
    """Move a part at rest, together with what it states in the assembly's frame."""
    if entry.get("rest_pose") != "auto":
        pose = entry["rest_pose"] = dict(entry.get("rest_pose") or {})
        pose.setdefault("at", [0, 0, 0])
        _move(pose, "at", shift)
    for connector in entry["connectors"]:
        if connector.get("frame") == "assembly":
            _move(connector, "o", shift)


def _move(holder: Json, field: str, shift: FloatArray) -> None:
    holder[field] = [_sum(value, round(float(by), _DIGITS)) for value, by in zip(holder[field], shift, strict=True)]


def _sum(value: float | str, by: float) -> float | str:
    if by == 0:
        return value
    if isinstance(value, str):
        return f"({value}) {'+' if by > 0 else '-'} {abs(by):.{_DIGITS}f}".rstrip("0")
    return round(value + by, _DIGITS)
