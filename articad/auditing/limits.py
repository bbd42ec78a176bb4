"""Ranges, efforts and velocities of joints: present, in order, in the right unit, and more than placeholders."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

from articad.auditing.declared import Declared, DeclaredJoint
from articad.auditing.wording import counted, listed
from articad.findings import Finding

FULL_TURN_SLACK = math.radians(0.6)  # ±3.14 means a full turn
DEGREES_FROM = 4 * math.pi  # rad; a range that begins there and consists of round numbers was written in degrees
ROUND_DEGREES = 5.0
LEAST_ALIKE = 3  # joints with the same effort or velocity before that is not a coincidence


def reversed_limits(declared: Declared) -> Iterator[Finding]:
    """A lower bound above the upper one."""
    for joint in _bounded(declared):
        assert joint.lower is not None
        assert joint.upper is not None
        if joint.lower > joint.upper:
            lower, upper, unit = _shown(joint)
            yield Finding(
                code="E_AUDIT_LIMITS_ORDER",
                where=joint.where,
                message=f"Joint {joint.name!r} has a lower limit of {lower:.6g} {unit}, above its upper limit of {upper:.6g} {unit}.",
                hint="Exchange the two.",
                value=lower,
                limit=upper,
                unit=unit,
            )


def no_limits(declared: Declared) -> Iterator[Finding]:
    """A hinge or slide without a range."""
    if declared.format != "urdf":
        return
    for joint in declared.joints:
        if joint.type not in {"revolute", "prismatic"} or joint.mimics is not None:
            continue
        if joint.lower is None and joint.upper is None:
            yield Finding(
                code="W_AUDIT_NO_LIMITS",
                where=joint.where,
                message=f"Joint {joint.name!r} is {joint.type} and has no lower or upper limit: the standard takes 0 for both, so it cannot move; "
                "PyBullet treats it as endless.",
                hint="Give lower and upper" + (", or make it continuous." if joint.turns else "."),
            )


def locked(declared: Declared) -> Iterator[Finding]:
    """A joint whose bounds are equal."""
    if declared.format != "urdf":
        return
    for joint in _bounded(declared):
        if joint.lower == joint.upper:
            lower, _, unit = _shown(joint)
            yield Finding(
                code="W_AUDIT_LOCKED",
                where=joint.where,
                message=f"Joint {joint.name!r} has both limits at {lower:.6g} {unit}, so it cannot move.",
                hint="Make it fixed, or open its range.",
                value=0.0,
                limit=0.0,
                unit=unit,
            )


def in_degrees(declared: Declared) -> Iterator[Finding]:
    """Bounds of a turn that are round numbers of degrees although radians are required."""
    if declared.format != "urdf":
        return
    for joint in _bounded(declared):
        if joint.turns and _is_degrees(joint):
            assert joint.lower is not None
            assert joint.upper is not None
            yield Finding(
                code="W_AUDIT_DEGREES",
                where=joint.where,
                message=f"Joint {joint.name!r} turns from {joint.lower:.6g} to {joint.upper:.6g} rad, {(joint.upper - joint.lower) / math.tau:.3g} turns; "
                "the numbers look like degrees.",
                hint=f"Write {math.radians(joint.lower):.6g} and {math.radians(joint.upper):.6g}.",
                value=joint.upper - joint.lower,
                limit=math.radians(joint.upper - joint.lower),
                unit="rad",
                cause="units",
            )


def endless(declared: Declared) -> Iterator[Finding]:
    """A bounded turn of 2π or more: every direction is reached, so the bound is not a stop that geometry could make."""
    for joint in _bounded(declared):
        if not joint.turns or joint.name in declared.tied or _is_degrees(joint):
            continue
        assert joint.lower is not None
        assert joint.upper is not None
        span = joint.upper - joint.lower
        if span >= math.tau - FULL_TURN_SLACK:
            yield Finding(
                code="W_AUDIT_ENDLESS",
                where=joint.where,
                message=f"Joint {joint.name!r} is limited but spans {math.degrees(span):.5g}°, {span / math.tau:.3g} turns.",
                hint="Make it continuous (--fix does), unless a cable or a thread stops it after so many turns.",
                value=math.degrees(span),
                limit=360.0,
                unit="deg",
            )


def zero_outside(declared: Declared) -> Iterator[Finding]:
    """Ranges without zero, where every reader first places the joint; turning ones and sliding ones each in one finding."""
    if declared.format != "urdf" or declared.states_frames:
        return
    for turns in (True, False):
        rows = []
        for joint in _bounded(declared):
            lower, upper, unit = _shown(joint)
            if joint.turns == turns and joint.mimics is None and lower <= upper and not lower <= 0 <= upper:
                rows.append((max(lower, -upper), f"{joint.name} from {lower:.6g} to {upper:.6g} {unit}", joint.where, unit))
        if rows:
            out, _, where, unit = max(rows)
            yield Finding(
                code="I_AUDIT_ZERO_OUTSIDE",
                where=where,
                message=f"Readers place joints at 0, which is outside of {counted(len(rows), 'range')}, by up to {out:.4g} {unit}: "
                f"{listed([row[1] for row in rows])}.",
                hint="Rotate or shift their origins so that zero is within their range, or move them into their range before simulating.",
                value=out,
                limit=0.0,
                unit=unit,
            )


def no_effort(declared: Declared) -> Iterator[Finding]:
    """Joints whose effort or velocity is zero, negative or missing."""
    if declared.format != "urdf":
        return
    moving = [joint for joint in declared.joints if joint.type in {"revolute", "continuous", "prismatic"} and joint.mimics is None]
    for what in ("effort", "velocity"):
        told = [joint for joint in moving if joint.type != "continuous" or getattr(joint, what) is not None]
        bad = [joint.name for joint in told if (getattr(joint, what) or 0.0) <= 0]
        if bad:
            yield Finding(
                code="W_AUDIT_NO_EFFORT",
                where=f"joints.{bad[0]}",
                message=f"{len(bad)} of {counted(len(moving), 'moving joint')} have no {what} above zero: {listed(bad)}.",
                hint=f"Give each the {what} of its drive, or what its load requires.",
                value=len(bad),
                limit=0,
            )


def placeholders(declared: Declared) -> Iterator[Finding]:
    """Joints that all have the same round effort and velocity, whatever their load."""
    if declared.format != "urdf":
        return
    moving = [joint for joint in declared.joints if joint.type in {"revolute", "continuous", "prismatic"} and joint.mimics is None]
    for what in ("effort", "velocity"):
        for kind in ("turn", "slide"):
            values = [getattr(joint, what) for joint in moving if joint.turns == (kind == "turn") and getattr(joint, what)]
            if len(values) < LEAST_ALIKE:
                continue
            value, count = Counter(values).most_common(1)[0]
            shown = value / 1000 if what == "velocity" and kind == "slide" else value
            if count == len(values) and _is_round(shown):
                unit = {("effort", "turn"): "N·m", ("effort", "slide"): "N", ("velocity", "turn"): "rad/s", ("velocity", "slide"): "m/s"}[
                    what, kind
                ]
                yield Finding(
                    code="W_AUDIT_PLACEHOLDER",
                    where="joints",
                    message=f"All {count} joints that {kind} have the same {what} of {shown:g} {unit}, whatever their load.",
                    hint="State the value of each drive; articad's own export computes both from mass and worst pose.",
                    value=shown,
                    unit=unit,
                    cause="placeholder",
                )


def _bounded(declared: Declared) -> Iterator[DeclaredJoint]:
    for joint in declared.joints:
        if joint.type in {"revolute", "prismatic"} and joint.lower is not None and joint.upper is not None:
            yield joint


def _shown(joint: DeclaredJoint) -> tuple[float, float, str]:
    """Return the bounds in degrees or mm."""
    lower, upper = joint.lower or 0.0, joint.upper or 0.0
    return (math.degrees(lower), math.degrees(upper), "deg") if joint.turns else (lower, upper, "mm")


def _is_degrees(joint: DeclaredJoint) -> bool:
    lower, upper = joint.lower or 0.0, joint.upper or 0.0
    whole = all(math.isclose(bound / ROUND_DEGREES, round(bound / ROUND_DEGREES), abs_tol=1e-9) for bound in (lower, upper))
    return whole and DEGREES_FROM < upper - lower <= 1440.0


def _is_round(value: float) -> bool:
    """True for powers of ten, which are often written where nothing is known."""
    return value > 0 and math.isclose(math.log10(value), round(math.log10(value)), abs_tol=1e-9)


CHECKS = (reversed_limits, no_limits, locked, in_degrees, endless, zero_outside, no_effort, placeholders)
