"""Findings about loops and couplings: open, inexact, locked, shaky, singular, idle, redundant."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from articad.errors import LoopError
from articad.findings import Finding
from articad.kinematics.inexact import ANGLE_TOLERANCE, Correction, shown_gap
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.mobility import NEAR_SINGULAR, idle_parts, redundancies

if TYPE_CHECKING:
    from articad.kinematics.branch import Group
    from articad.kinematics.mechanism import Mechanism

_PARALLEL = 1e-9  # rad: axes that differ less are parallel
_STILL = 1e-9  # of a unit motion of the whole mechanism: a coordinate that moves less stands still
_MOST_LOOPS_RELEASED = 4  # a proposal costs a few ms per joint; larger mechanisms compute it on request


def loop_findings(mechanism: Mechanism) -> list[Finding]:
    """Return the findings about a mechanism's loops and couplings at rest."""
    try:
        branch = mechanism.branch
    except LoopError as error:
        return list(error.findings)
    found = _inexact_findings(mechanism)
    for group in branch.groups:
        found += [*_driver_findings(group, mechanism.inconsistency), *_coupling_findings(group), *_mobility_findings(group)]
    return [*found, *_redundancy_findings(mechanism)]


# --- inexact geometry


def _inexact_findings(mechanism: Mechanism) -> list[Finding]:
    """Return the finding about connectors that were moved so that loops close and move."""
    correction = mechanism.correction
    if correction is None:
        return []
    far, turned = max(correction.moved, key=lambda one: one.distance), max(correction.moved, key=lambda one: one.angle)
    message = (
        f"The loops close and move only after connectors are moved by up to {correction.distance:.1e} mm ({far.part}.{far.connector}) "
        f"and {correction.angle:.1e} rad ({turned.part}.{turned.connector}): the given ones are rounded. "
        f"Tolerance {correction.distance_tolerance:.1e} mm and {ANGLE_TOLERANCE:.1e} rad."
    )
    hint = "Poses use the moved connectors. Give connectors with more digits to make them exact."
    return [
        Finding(
            code="W_LOOP_INEXACT",
            where=f"joints.{far.joint}",
            message=message,
            hint=hint,
            parts=tuple(dict.fromkeys((far.part, turned.part))),
            value=correction.distance,
            limit=correction.distance_tolerance,
            unit="mm",
        )
    ]


def askew_error(error: LoopError, needed: Correction) -> LoopError:
    """Return the error of an open loop with its cause: which connectors do not fit, and by how much."""
    (finding,) = error.findings
    cause, hint = inconsistency(needed)
    message = finding.message.rstrip(".") + f": {cause}."
    return LoopError(
        f"{finding.code}: {message} {hint}", loop=error.loop, gap=error.gap, findings=[replace(finding, message=message, hint=hint)]
    )


def inconsistency(needed: Correction) -> tuple[str, str]:
    """Return the reason why nearly consistent loops do not close or move, and what to do about it."""
    if needed.askew is not None and needed.askew[2] > ANGLE_TOLERANCE:
        a, b, angle = needed.askew
        cause = f"the axes of {b.part}.{b.connector} and {a.part}.{a.connector} are {math.degrees(angle):.3f}° out of parallel"
        return cause, f"Turn one of the two axes by {math.degrees(angle):.3f}°, or release a joint of the loop."
    far = max(needed.moved, key=lambda one: one.distance)
    cause = f"{far.part}.{far.connector} would have to move by {shown_gap(far.distance)} (tolerance {needed.distance_tolerance:.1e} mm)"
    return cause, f"Move {far.part}.{far.connector}, or release a joint of the loop."


# --- drivers and couplings


def _coupling_findings(group: Group) -> list[Finding]:
    """Return findings about couplings that lock each other, such as three gears in a triangle."""
    system, moving = group.system, np.abs(group.analysis.freedoms).max(axis=1, initial=0.0) > _STILL
    locked = [
        coupling for coupling, row in zip(system.couplings, system.coupling_rows, strict=True) if not moving[np.flatnonzero(row)].any()
    ]
    found = []
    for train in _connected(locked):
        names, joints = ", ".join(repr(c.name) for c in train), ", ".join(dict.fromkeys(n for c in train for n in (c.a, c.b)))
        message = f"Coupling(s) {names} cannot move: together with the rest of the mechanism they lock {joints}."
        hint = "Remove a coupling, or correct a ratio: around a closed train, the product of the ratios must be 1, so a ring of gears needs an even number."
        parts = tuple(
            dict.fromkeys(
                part
                for c in train
                for n in (c.a, c.b)
                for joint in [system.layout.joint(n.split(".")[0])]
                for part in (joint.parent, joint.child)
            )
        )
        found.append(Finding(code="E_COUPLING_LOCKED", where=f"couplings.{train[0].name}", message=message, hint=hint, parts=parts))
    return found


def _connected(couplings: Sequence[Coupling]) -> list[list[Coupling]]:
    """Return the couplings in groups that share coordinates."""
    groups: list[list[Coupling]] = []
    for coupling in couplings:
        touched = [group for group in groups if any({c.a, c.b} & {coupling.a, coupling.b} for c in group)]
        groups = [group for group in groups if group not in touched] + [[*(c for group in touched for c in group), coupling]]
    return groups


def _driver_findings(group: Group, beyond: Correction | None) -> list[Finding]:
    analysis = group.analysis
    if analysis.mobility == 0 and group.refused:
        return [_locked(group, joint, beyond) for joint in group.refused]
    names = ", ".join(c.name for c in group.drivers)
    found = []
    for joint in group.refused:
        message = f"Joint {joint.name!r} is marked as a driver, but {names} already drive(s) the {analysis.mobility} freedom(s)."
        hint = f"Remove the driver mark of {joint.name!r}, or of the joint that it is to replace: each freedom has one independent driver."
        found.append(Finding(code="E_DRIVER", where=f"joints.{joint.name}", message=message, hint=hint, value=analysis.mobility))
    return found


def _locked(group: Group, driver: Joint, beyond: Correction | None) -> Finding:
    """Return the finding about a loop that cannot move, usually because of a tilted axis."""
    sigma = group.analysis.near
    message = f"mobility 0: driver {driver.name!r} cannot move; the smallest singular value is {sigma:.2g}"
    loops = [loop for loop in group.system.loops if driver.name in {joint.name for joint in loop.joints}]
    named, hint = False, "Make the hinge axes parallel, or release a joint of the loop."
    for loop in loops[:1]:
        joint, tilt = _most_tilted(group, loop.joints)
        if tilt <= _PARALLEL:
            hint = "Its axes are parallel: change a length, add a link, or release a joint of the loop."
        elif tilt < math.radians(5):  # a larger angle means a spatial loop, not a misalignment
            named = True
            message += f" and belongs to the axis of {joint.parent}.{joint.parent_connector}, tilted by {math.degrees(tilt):.3f}°"
    parts = loops[0].parts if loops else (driver.parent, driver.child)
    if beyond is not None and beyond.closed and not named:
        cause, hint = inconsistency(beyond)
        message += f": {cause}"
    return Finding(code="E_LOOP_LOCKED", where=f"joints.{driver.name}", message=f"{message}.", hint=hint, parts=parts, value=sigma)


def _most_tilted(group: Group, joints: tuple[Joint, ...]) -> tuple[Joint, float]:
    """Return the joint whose axis differs most from the loop's common one at rest, and the angle [rad]."""
    system = group.system
    T = system.arrays.matrices(group.Q[None])[:, 0]
    axes = np.array([(T[system.parts.index(j.parent)] @ j.T_parent_connector.matrix)[:3, 2] for j in joints])
    axes *= np.where(axes @ axes[0] < 0, -1.0, 1.0)[:, None]
    common = np.median(axes, axis=0)
    tilt = np.arctan2(np.linalg.norm(np.cross(axes, common), axis=1), axes @ common)
    worst = int(np.argmax(tilt))
    return joints[worst], float(tilt[worst])


def _mobility_findings(group: Group) -> list[Finding]:
    analysis, system = group.analysis, group.system
    where = f"joints.{system.loops[0].joint.name}" if system.loops else "couplings"
    parts = system.loops[0].parts if system.loops else ()
    found = []
    if analysis.shaky:
        message = f"The linkage has {analysis.first_order} freedom(s) to first order only: it is rigid, but barely."
        found.append(
            Finding(
                code="W_SHAKY",
                where=where,
                message=message,
                hint="Change a length, so that the linkage moves or is clearly rigid.",
                parts=parts,
            )
        )
    elif analysis.multiple:
        message = (
            f"The linkage has {analysis.first_order} freedoms to first order at rest and {analysis.mobility} in fact: nearby, "
            f"{analysis.multiple} more stay(s) free to first order, although no finite motion follows. Play in the joints lets parts move there."
        )
        hint = "Use fewer links, or links that are not parallel or equal."
        if not group.follower.simple:
            message += " The drivers are followed only as far as poses of reduced accuracy allow."
        found.append(Finding(code="W_NEAR_SINGULAR", where=where, message=message, hint=hint, parts=parts, value=0.0, limit=NEAR_SINGULAR))
    elif analysis.first_order > analysis.mobility:
        message = f"The rest pose is singular: {analysis.first_order} freedoms to first order, {analysis.mobility} in general position."
        hint = "Choose a rest pose in which the links are not in line."
        found.append(Finding(code="W_NEAR_SINGULAR", where=where, message=message, hint=hint, parts=parts, value=0.0, limit=NEAR_SINGULAR))
    elif analysis.near < NEAR_SINGULAR:
        message = f"The rest pose is near-singular: σ = {analysis.near:.2g} of the largest."
        hint = "Check for a misaligned axis or a dead point nearby."
        found.append(
            Finding(code="W_NEAR_SINGULAR", where=where, message=message, hint=hint, parts=parts, value=analysis.near, limit=NEAR_SINGULAR)
        )
    for idle in idle_parts(system, analysis):
        message = f"{' and '.join(idle)} can move while all other parts stay at rest."
        hint = "This is correct for a leg that may spin; otherwise fix it."
        found.append(Finding(code="W_IDLE_FREEDOM", where=f"parts.{idle[0]}", message=message, hint=hint, parts=idle))
    return found


def _redundancy_findings(mechanism: Mechanism) -> list[Finding]:
    branch = mechanism.branch
    few = len(branch.system.loops) <= _MOST_LOOPS_RELEASED
    found = []
    for one in redundancies(
        mechanism.parts, mechanism.ground, mechanism.layout, branch.system, branch.analysis, branch.Q_rest, release=few
    ):
        twice = "once" if one.count == 1 else f"{one.count} times"
        message = f"The closed loop {'-'.join(one.loop)} is held {twice} more than its motion needs: against {', '.join(one.directions)}."
        changes = " and ".join(f"{name!r} to {new}" for name, new in one.release)
        hint = (
            f"The plan may stay as it is. Real parts are never exact and would jam: leave their joints some play, or change {changes}."
            if changes
            else "The plan may stay as it is. Real parts are never exact and would jam: leave their joints some play, or make some of them "
            "ball or cylindrical joints."
        )
        found.append(Finding(code="I_REDUNDANT", where=f"joints.{one.joint}", message=message, hint=hint, parts=one.loop, value=one.count))
    return found
