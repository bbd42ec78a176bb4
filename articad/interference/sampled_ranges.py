"""Ranges over which drivers are sampled, so that sweeps, audits and clearances cover the same motion.

A driver with limits is sampled between them. A driver without limits is sampled over the travel after which all its followers have
returned: one turn, or several turns where couplings or loops need them. A slide or screw without limits is sampled over a piece around
rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from articad.interference.freedoms import ENDLESS_SLIDE_MM, Freedom, freedoms, radians_per_mm, slides_endlessly, travels
from articad.kinematics.joints import Coordinate, Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.motion import track_of
from articad.kinematics.track import Track

ENDLESS_SAMPLED_MM = 100.0  # in both directions from rest, for slides without limits
MOST_TURNS = 16  # for a driver whose followers return later than that, or never
_WHOLE = 1e-9  # turns: tolerance for a follower's whole number of turns


def driving_joints(mechanism: Mechanism) -> tuple[Joint, ...]:
    """Return the joints that have a driver, in the order of the drivers."""
    by_name = {joint.name: joint for joint in mechanism.joints}
    return tuple(by_name[name] for name in dict.fromkeys(coordinate.joint for coordinate in mechanism.drivers))


def sampled_ranges(mechanism: Mechanism) -> tuple[Freedom, ...]:
    """Return every driving freedom with the range over which it is sampled [rad or mm]."""
    return tuple(freedom for freedom, _ in _ranges(mechanism))


def endless_beyond(mechanism: Mechanism) -> dict[str, str]:
    """Return why parts may reach other poses beyond the range over which a driver is sampled, by the driver's name."""
    return {freedom.name: reason for freedom, reason in _ranges(mechanism) if reason}


def _ranges(mechanism: Mechanism) -> Iterator[tuple[Freedom, str]]:
    """Yield the sampled range of every driving freedom, and why the motion continues beyond it, if it does."""
    places = {driver.name: index for index, driver in enumerate(mechanism.drivers)}
    for joint in driving_joints(mechanism):
        for freedom in travels(joint):
            index = places.get(freedom.name)
            if index is not None and math.isinf(mechanism.drivers[index].upper - mechanism.drivers[index].lower):
                yield _endless(mechanism, joint, index, freedom)
            elif index is not None or joint.type is JointType.BALL:
                yield freedom, ""


def _endless(mechanism: Mechanism, joint: Joint, index: int, freedom: Freedom) -> tuple[Freedom, str]:
    """Return the range of a driver that lacks a limit, or both, and why the motion continues beyond it."""
    driver = mechanism.drivers[index]
    track = track_of(mechanism, index, mechanism.rest)
    if track is None and _slides(joint, driver):
        piece = sampled_piece(joint, freedom)
        return piece, "it slides without limits" if piece != freedom else ""
    if track is None:
        return next(one for one in freedoms(joint) if one.name == freedom.name), ""
    ends = mechanism.feasible_range(driver.name)
    lower = ends.lower if ends.lower_reason.startswith("limit of ") else driver.lower
    upper = ends.upper if ends.upper_reason.startswith("limit of ") else driver.upper
    if math.isfinite(upper - lower):
        return freedom._replace(lower=lower, upper=upper), ""
    length, reason = _return_travel(mechanism, track, driver, -1 if math.isfinite(upper) else 1)
    if math.isinf(lower) and math.isinf(upper):
        lower, upper = freedom.rest - length / 2, freedom.rest + length / 2
    elif math.isinf(lower):
        lower = upper - length * max(1, math.ceil((upper - freedom.rest) / length))
    else:
        upper = lower + length * max(1, math.ceil((freedom.rest - lower) / length))
    return freedom._replace(lower=lower, upper=upper), reason


def _slides(joint: Joint, driver: Coordinate) -> bool:
    return driver.unit == "mm" or (joint.type is JointType.SCREW and slides_endlessly(joint))


def sampled_piece(joint: Joint, freedom: Freedom) -> Freedom:
    """Return a piece around rest for a slide or screw without limits; any other range unchanged."""
    per_mm = radians_per_mm(joint) if joint.type is JointType.SCREW and joint.lead else 1.0
    if freedom.upper - freedom.lower < ENDLESS_SLIDE_MM * per_mm:
        return freedom
    far = ENDLESS_SAMPLED_MM * per_mm
    return freedom._replace(lower=max(freedom.lower, freedom.rest - far), upper=min(freedom.upper, freedom.rest + far))


def _return_travel(mechanism: Mechanism, track: Track, driver: Coordinate, sign: int) -> tuple[float, str]:
    """Return the travel of a driver after which all its followers have returned [rad or mm], or a maximum and why it is one.

    With couplings alone, followers turn at fixed rates `k` per turn of the driver. They have returned after the smallest `n` for which
    all `n k` are whole numbers. A slide never returns, so its travel sets the end.
    """
    system = track.follower.system
    rates = [(driver, 1.0), *((system.layout.coordinates[column], ratio) for column, ratio, _ in system.ties.tied_to(track.column))]
    slid = [2 * ENDLESS_SAMPLED_MM / rate for c, ratio in rates if (rate := _travel_per_unit(mechanism, c, ratio)) > 0]
    if driver.unit == "mm":
        return min(slid, default=2 * ENDLESS_SAMPLED_MM), "it slides without limits"
    period = track.period(sign) if system.loops and not slid else None
    if period is not None:
        return period.length, ""
    turns = [ratio for c, ratio in rates if c.unit == "rad"]
    count = next((n for n in range(1, MOST_TURNS + 1) if all(abs(n * k - round(n * k)) < _WHOLE for k in turns)), None)
    if slid:
        return max(2 * math.pi * (count or MOST_TURNS), min(slid)), "a joint that follows it slides without limits"
    if count is None:
        return 2 * math.pi * MOST_TURNS, f"the joints that follow it do not return within {MOST_TURNS} turns"
    return 2 * math.pi * count, ""


def _travel_per_unit(mechanism: Mechanism, coordinate: Coordinate, ratio: float) -> float:
    """Return the distance [mm] by which a coordinate without limits moves its part, per unit of the driver that it follows at a ratio."""
    joint = next(joint for joint in mechanism.joints if joint.name == coordinate.joint)
    if not slides_endlessly(joint):
        return 0.0
    if coordinate.unit == "mm":
        return abs(ratio)
    return abs(ratio) / radians_per_mm(joint) if joint.type is JointType.SCREW else 0.0
