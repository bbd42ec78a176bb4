"""A quick check of the numbers of many joints at once; joints that do not pass it are checked one by one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain
from operator import le

from articad.findings import Finding
from articad.kinematics.joints import Joint, JointType


def joint_findings(joints: Sequence[Joint]) -> list[Finding]:
    """Return all faults of the joints' own numbers."""
    return [finding for joint in _doubtful(joints) for finding in joint.findings()]


def _doubtful(joints: Sequence[Joint]) -> Sequence[Joint]:
    """Return the joints whose numbers do not pass the quick check, in the order in which they are declared."""
    types = [joint.type for joint in joints]
    doubtful = [joint for joint in joints if joint.lead or joint.driver]
    doubtful += [joint for joint, kind in zip(joints, types, strict=True) if kind in _SPECIAL and not _clear_special(joint)]
    doubtful += _unclear([joint for joint, kind in zip(joints, types, strict=True) if kind not in _ROTATED])
    return _in_order(joints, doubtful)


def _in_order(joints: Sequence[Joint], some: Sequence[Joint]) -> Sequence[Joint]:
    wanted = set(map(id, some))
    return [joint for joint in joints if id(joint) in wanted] if wanted else ()


def _clear_special(joint: Joint) -> bool:
    """Return whether a ball rests upright within its cone and twist; a screw must have a lead, so it never passes here."""
    limits = joint.limits
    turns = limits.twist is None or limits.twist[0] <= 0.0 <= limits.twist[1]
    leans = limits.cone is None or 0.0 < limits.cone <= math.pi
    return joint.type is JointType.BALL and joint.rest == _NEUTRAL and turns and leans and not limits.lower and not limits.upper


def _unclear(joints: Sequence[Joint]) -> Sequence[Joint]:
    """Return the joints that have no quaternion and whose limits are malformed or do not contain the rest value."""
    sizes = [_SIZES[joint.type] for joint in joints]
    rests, limits = [joint.rest for joint in joints], [joint.limits for joint in joints]
    lowers, uppers = [one.lower for one in limits], [one.upper for one in limits]
    if not sizes == list(map(len, rests)) == list(map(len, lowers)) == list(map(len, uppers)):
        return joints
    rest, lower, upper = (list(chain.from_iterable(values)) for values in (rests, lowers, uppers))
    good = all(map(le, lower, rest)) and all(map(le, rest, upper)) and all(map(math.isfinite, rest))
    unclear = [joint for joint, one in zip(joints, limits, strict=True) if one.cone is not None or one.twist is not None]
    return unclear if good else joints


_SPECIAL = frozenset({JointType.BALL, JointType.SCREW, JointType.FREE})
_ROTATED = frozenset({JointType.BALL, JointType.FREE})  # types without ranges of their coordinates
_NEUTRAL = JointType.BALL.neutral
_SIZES = {joint_type: len(joint_type.coordinates) for joint_type in JointType}
