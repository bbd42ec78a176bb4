"""Travel: how far each joint goes while the drivers move one at a time, followers in loops and couplings included."""

from __future__ import annotations

import math
from typing import Final

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.kinematics.joints import Joint, JointType, swing, twist
from articad.render.pictures import motion_frames

FOLLOWED: Final = 61  # poses of each driver's range: a turn in steps of 6°, its half included
_STILL: Final = 1e-6  # rad, mm: what moves less stands still


def travels(assembly: Assembly) -> list[str]:
    """Return a line for each joint that moves, driven or following: its range, in degrees and mm."""
    driving = set(assembly.mechanism.driving_joints)
    sweeps = _sweeps(assembly) if driving and not assembly.mechanism.is_tree else []
    lines, start = [], 0
    for joint in assembly.joints:
        own = slice(start, start + len(joint.column_names))
        start = own.stop
        if joint.type is JointType.FIXED:
            continue
        if joint.type is JointType.FREE:
            lines.append(f"- {joint.name}: moves freely in all directions")
        elif joint.name in driving:
            lines += [f"{line}, drives" for line in _driven(assembly, joint)]
        elif sweeps:
            lines += [f"{line}, follows" for line in _following(joint, [rows[:, own] for rows in sweeps])]
        else:
            lines.append(f"- {joint.name}: does not move")
    return lines


def _sweeps(assembly: Assembly) -> list[FloatArray]:
    """Return all joints' coordinates `(FOLLOWED, columns)` along the range of each driving coordinate."""
    mechanism = assembly.mechanism
    sweeps: list[FloatArray] = []
    for joint in assembly.mechanism.driving_joints:
        columns = mechanism.configuration(motion_frames(assembly, joint, FOLLOWED)[1]).columns
        sweeps += list(columns.reshape(-1, FOLLOWED, columns.shape[-1]))
    return sweeps


def _driven(assembly: Assembly, joint: Joint) -> list[str]:
    if joint.type is JointType.BALL:
        cone, turn = joint.limits.cone, joint.limits.twist
        tilt = "to every side" if cone is None else f"to {_figure(math.degrees(cone))} degrees from its axis, every way"
        turned = "turns freely about it" if turn is None else f"turns {_span(*turn, 'rad')} about it"
        return [f"- {joint.name}: swivels {tilt}, {turned}"]
    lines = []
    for driver in assembly.drivers:
        if driver.joint != joint.name:
            continue
        lower, upper = driver.lower, driver.upper
        if not assembly.mechanism.is_tree:
            feasible = assembly.feasible_range(driver.name)
            lower, upper = feasible.lower, feasible.upper
        lines.append(f"- {driver.name}: {_span(lower, upper, driver.unit)}")
    return lines


def _following(joint: Joint, sweeps: list[FloatArray]) -> list[str]:
    """Return the motion of a joint that follows; `sweeps` holds its own coordinates, `(poses, columns)` for each driver."""
    if joint.type is JointType.BALL:
        (_, tilt), (low, high) = _extremes([swing(rows) for rows in sweeps]), _extremes([twist(rows) for rows in sweeps])
        return [f"- {joint.name}: swivels to {_figure(math.degrees(tilt))} degrees from its axis, turns {_span(low, high, 'rad')} about it"]
    lines = []
    for index, (name, unit) in enumerate(zip(joint.column_names, joint.type.units, strict=True)):
        low, high = _extremes([rows[:, index] for rows in sweeps])
        all_round = unit == "rad" and math.isinf(joint.limits.upper[index]) and high - low > 2 * math.pi - _STILL
        lines.append(f"- {name}: {f'turns {_figure(math.degrees(high - low))} degrees in all' if all_round else _span(low, high, unit)}")
    return lines


def _extremes(sweeps: list[FloatArray]) -> tuple[float, float]:
    """Return the smallest and largest value of a coordinate; a turning point between two poses is interpolated."""
    high = max(_summit(values) for values in sweeps)
    low = min(-_summit(-values) for values in sweeps)
    return low, high


def _summit(values: FloatArray) -> float:
    """Return the top of the parabola through the largest value and its neighbours."""
    top = int(values.argmax())
    if not 0 < top < len(values) - 1:
        return float(values[top])
    before, summit, after = map(float, values[top - 1 : top + 2])
    bend = before - 2 * summit + after
    return summit if bend >= -_STILL else summit - (after - before) ** 2 / (8 * bend)


def _span(lower: float, upper: float, unit: str) -> str:
    if math.isinf(lower) and math.isinf(upper):
        return "endless"
    if upper - lower < _STILL:
        return "does not move"
    name = "degrees" if unit == "rad" else "mm"
    figures = [_figure(math.degrees(value) if unit == "rad" else value) for value in (lower, upper)]
    return f"{figures[0] if math.isfinite(lower) else 'no end'} to {figures[1] if math.isfinite(upper) else 'no end'} {name}"


def _figure(value: float) -> str:
    """Return an angle in degrees or a length in mm to a hundredth: three digits would hide a missing millimetre of a long travel."""
    return f"{round(value, 2) + 0.0:.10g}"
