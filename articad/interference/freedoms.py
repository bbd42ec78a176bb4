"""Freedoms of joints as ranges of numbers, and the motion that values of them give.

A ball's coordinates here are swing and twist: one range each, where its quaternion has none.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.kinematics.joints import Joint, JointType

_PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71)
_TINY = 1e-9  # rad: for smaller angles the sine equals the angle
ENDLESS_SLIDE_MM = 1e6  # largest travel of a slide without limits: the largest size of an assembly
ABOUT_Z = frozenset(
    kind for kind in JointType if all(step.kind == "slide" or step.axis == 2 for step in kind.steps)
)  # turn about z at most
FULL_TURN = (-math.pi, math.pi)  # an endless joint is proven over one turn about its rest


class Freedom(NamedTuple):
    """One coordinate along which a joint is proven.

    Attributes:
        name: `joint`, or `joint.coordinate`; for a ball `joint.sx`, `joint.sy`, `joint.twist`: it turns by twist about z, then swings
            about (sx, sy, 0) by the length of that vector.
        lower: [rad or mm].
        upper: [rad or mm].
        rest: Value in the rest pose.
    """

    name: str
    lower: float
    upper: float
    rest: float


def freedoms(joint: Joint) -> tuple[Freedom, ...]:
    """Return the coordinates along which a joint moves.

    Without limits, the range is a whole turn about rest, or from the one limit; it is larger if rest is farther away.
    A free joint has no range to be proven or swept over: it has none of these, and is at rest in every check.
    """
    if joint.type is JointType.FREE:
        return ()
    if joint.type is JointType.BALL:
        cone = math.pi if joint.limits.cone is None else joint.limits.cone
        twist = FULL_TURN if joint.limits.twist is None else joint.limits.twist
        ranges = {"sx": (-cone, cone), "sy": (-cone, cone), "twist": twist}
        rests = swing_and_twist(np.array(joint.rest))
        return tuple(Freedom(f"{joint.name}.{key}", lo, hi, rest) for (key, (lo, hi)), rest in zip(ranges.items(), rests, strict=True))
    found = []
    for column in joint.columns:
        turn = 2 * ENDLESS_SLIDE_MM if column.unit == "mm" else 2 * math.pi
        lower, upper, rest = column.lower, column.upper, column.rest
        if math.isinf(lower) and math.isinf(upper):
            lower, upper = rest - turn / 2, rest + turn / 2
        elif math.isinf(lower):
            lower = upper - turn * max(1, math.ceil((upper - rest) / turn))
        elif math.isinf(upper):
            upper = lower + turn * max(1, math.ceil((rest - lower) / turn))
        found.append(Freedom(column.name, lower, upper, rest))
    return tuple(found)


def travels(joint: Joint) -> tuple[Freedom, ...]:
    """Return the coordinates along which a joint moves; a screw without limits has as much travel as a slide without limits."""
    if joint.type is not JointType.SCREW or not slides_endlessly(joint):
        return freedoms(joint)
    (column,), far = joint.columns, 2 * ENDLESS_SLIDE_MM * radians_per_mm(joint)
    lower, upper = column.rest - far / 2, column.rest + far / 2
    if math.isfinite(column.lower):
        lower, upper = column.lower, column.lower + far
    elif math.isfinite(column.upper):
        lower, upper = column.upper - far, column.upper
    return (Freedom(column.name, lower, upper, column.rest),)


def radians_per_mm(joint: Joint) -> float:
    """Return the angle by which a screw turns per 1 mm of travel [rad/mm]."""
    return 2 * math.pi / abs(joint.lead)


def slides_endlessly(joint: Joint) -> bool:
    """Return whether a joint without limits moves its part ever farther, so that no turn covers all of its poses."""
    endless = any(math.isinf(column.lower) or math.isinf(column.upper) for column in joint.columns if column.unit == "mm")
    screws = joint.type is JointType.SCREW and joint.lead != 0
    return endless or (screws and any(math.isinf(column.lower) or math.isinf(column.upper) for column in joint.columns))


def scattered(ranges: Sequence[Freedom], count: int) -> list[tuple[float, ...]]:
    """Return points of a Halton sequence over ranges; they cover any number of dimensions more evenly than random points.

    Beyond 20 dimensions the primes repeat, shifted.
    """
    columns = []
    for at, freedom in enumerate(ranges):
        shares = np.array([_radical_inverse(index + 1 + 409 * (at // len(_PRIMES)), _PRIMES[at % len(_PRIMES)]) for index in range(count)])
        columns.append(freedom.lower + shares * (freedom.upper - freedom.lower))
    return [tuple(row) for row in np.array(columns).T.tolist()]


def _radical_inverse(index: int, base: int) -> float:
    result, share = 0.0, 1.0
    while index:
        share /= base
        result += share * (index % base)
        index //= base
    return result


def driver_values(joint: Joint, values: Sequence[float]) -> tuple[float, ...]:
    """Return the joint's own coordinates for values of its `freedoms`: only those of a ball and of a free joint differ."""
    if joint.type is JointType.FREE:
        return joint.rest
    if joint.type is not JointType.BALL:
        return tuple(values)
    sx, sy, twist = values
    angle = math.hypot(sx, sy)
    c, s = math.cos(angle / 2), (0.5 if angle < 1e-9 else math.sin(angle / 2) / angle)  # sin(x/2)/x at 0
    x, y = s * sx, s * sy
    cz, sz = math.cos(twist / 2), math.sin(twist / 2)
    return (x * cz + y * sz, y * cz - x * sz, c * sz, c * cz)


def swing_and_twist(quaternion: FloatArray) -> list[float]:
    """Return a ball's swing (sx, sy) and twist [rad] for its quaternion x y z w: the inverse of `driver_values`."""
    x, y, z, w = quaternion.tolist()
    twist = 2 * math.atan2(z, w)
    c, s = math.cos(twist / 2), math.sin(twist / 2)
    sx, sy = x * c - y * s, y * c + x * s  # the quaternion without its twist, whose z is 0
    half = math.atan2(math.hypot(sx, sy), math.hypot(z, w))
    size = 2 * half / (math.sin(half) or 1.0) if half > _TINY else 2.0
    return [sx * size, sy * size, twist]


def motion_matrix(joint: Joint, values: Sequence[float]) -> FloatArray:
    """Return J `(4, 4)` for values of the joint's `freedoms`; the same as `Joint.motion`, without its checks."""
    if joint.type is JointType.FIXED:
        return np.eye(4)
    if joint.type not in ABOUT_Z:
        return np.asarray(joint.motion(np.array(driver_values(joint, values))).matrix)
    angle, origin = 0.0, [0.0, 0.0, 0.0]
    for step in joint.type.steps:
        value = values[step.coordinate or 0]
        if step.kind == "turn":
            angle = value
        else:
            origin[step.axis] = joint.lead / (2 * math.pi) * value if step.advances else value
    return _turn_z(angle, *origin)


def _turn_z(angle: float, x: float, y: float, z: float) -> FloatArray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]])
