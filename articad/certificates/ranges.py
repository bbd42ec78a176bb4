"""Ranges over which a certificate is to hold, chosen before anything is proven.

A joint that moves by itself is proven over its limits, and without limits over one turn (`proven_freedoms`).
A driver of a loop or coupling is proven as far as its linkage lets it go, and without limits until all that follows it is back.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from articad.arrays import FloatArray
from articad.certificates.verifier import FLOAT, Checker
from articad.connectors.se3 import SE3
from articad.interference.freedoms import FULL_TURN, Freedom, freedoms, motion_matrix
from articad.interference.motion import Coordinates
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.motion import track_of

MOST_TURNS = 64  # turns of a driver of couplings alone, after which its followers count as never returning


def proven_freedoms(joint: Joint) -> tuple[Freedom, ...]:
    """Return the coordinates along which a joint is proven: a ball's are turns about x, y and z, one after the other.

    They cover every swing within its cone and every twist within its limits, and a little more twist: a turn about y after one
    about x twists by at most 2 atan(tan²(a/2)), where a is the corner at which both angles are equal.
    """
    if joint.type is not JointType.BALL:
        return freedoms(joint)
    cone = min(math.pi if joint.limits.cone is None else joint.limits.cone, math.pi)
    least, most = FULL_TURN if joint.limits.twist is None else joint.limits.twist
    more = 2 * math.atan(math.tan(math.acos(math.sqrt(math.cos(cone))) / 2) ** 2) if cone < math.pi / 2 else math.pi
    twist = FULL_TURN if most - least + 2 * more >= 2 * math.pi else (least - more, most + more)
    ranges = {"x": (-cone, cone), "y": (-min(cone, math.pi / 2), min(cone, math.pi / 2)), "z": twist}
    rests = _turns(SE3.from_quaternion(joint.rest).rotation)
    return tuple(Freedom(f"{joint.name}.{key}", lo, hi, rest) for (key, (lo, hi)), rest in zip(ranges.items(), rests, strict=True))


def _turns(R: FloatArray) -> list[float]:
    """Return the turns about x, y and z of a rotation `(3, 3)`, one after the other: the coordinates along which a ball is proven."""
    return [math.atan2(-R[1, 2], R[2, 2]), math.asin(max(-1.0, min(1.0, R[0, 2]))), math.atan2(-R[0, 1], R[0, 0])]


def turned(values: Sequence[float]) -> FloatArray:
    """Return the motion of a ball for its turns about x, y and z, `(4, 4)`."""
    return np.asarray((SE3.rot_x(values[0]) @ SE3.rot_y(values[1]) @ SE3.rot_z(values[2])).matrix)


def _proven_motion(joint: Joint, values: Sequence[float]) -> FloatArray:
    """Return J `(4, 4)` for values of the joint's `proven_freedoms`."""
    return turned(values) if joint.type is JointType.BALL else motion_matrix(joint, values)


PROVEN = Coordinates(proven_freedoms, _proven_motion)  # balls by turns about x, y and z


def driven_range(mechanism: Mechanism, checker: Checker, index: int) -> tuple[tuple[float, float], tuple[str, str]]:
    """Return the range over which a driver is to be followed, and what ends it below and above.

    Without limits that is the travel after which all its followers have returned: about rest, or from its only limit.

    Args:
        mechanism: A mechanism with loops or couplings.
        checker: The checker of its certificate.
        index: Index of the driver among the mechanism's.

    Raises:
        ValueError: If its followers do not return.
    """
    driver = mechanism.drivers[index]
    feasible, rest = mechanism.feasible_range(driver.name), float(checker.rest[driver.name])
    reasons = feasible.lower_reason, feasible.upper_reason
    ends, declared = (feasible.lower, feasible.upper), (driver.lower, driver.upper)
    open_ends = [
        math.isinf(limit) and (math.isinf(end) or reason in ("endless", "not followed further"))
        for limit, end, reason in zip(declared, ends, reasons, strict=True)
    ]
    if not any(open_ends):
        return ends, reasons
    length = _period(mechanism, checker, index, 1 if open_ends[1] else -1)
    if all(open_ends):
        return (rest - length / 2, rest + length / 2), reasons
    turns = max(1, math.ceil((ends[1] - rest if open_ends[0] else rest - ends[0]) / length))
    return ((ends[1] - turns * length, ends[1]) if open_ends[0] else (ends[0], ends[0] + turns * length)), reasons


def _period(mechanism: Mechanism, checker: Checker, index: int, sign: int) -> float:
    """Return the travel of a driver after which all its followers have returned up to whole turns [rad]."""
    driver = mechanism.drivers[index]
    names = checker.followers((driver.name,))
    rest = np.array([checker.rest[name] for name in names])
    _, J, share = checker.closure(names, rest, rest)
    turns = np.array([checker.turns[name][2] and not checker.turns[name][3] for name in names])
    if not turns[0]:
        raise ValueError(f"{driver.name} slides without limits")
    if not share.any():  # couplings alone: each follower turns at its own fixed rate
        rates = np.append(1.0, -np.linalg.pinv(J[:, 1:], rcond=1e-7) @ J[:, 0])
        for count in range(1, MOST_TURNS + 1):
            whole = np.where(turns, np.round(count * rates), 0.0)
            if (np.abs(count * rates - whole) <= FLOAT / 2 * np.maximum(1.0, np.abs(whole))).all():
                return 2 * math.pi * count
        raise ValueError(f"the followers of {driver.name} do not return within {MOST_TURNS} of its turns")
    track = track_of(mechanism, index, mechanism.rest)
    period = None if track is None else track.period(sign)
    if period is None:
        raise ValueError(f"the followers of {driver.name} are not known to return after a number of its turns")
    return period.length
