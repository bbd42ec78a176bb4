"""Loops held by points: pairs of points that must meet, for formats and readers that have such constraints but no closing joints."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from articad.connectors.se3 import SE3
from articad.export.lowering import LoweredJoint, LoweredModel, metres
from articad.kinematics.joints import JointType

LEAST_HALF_LENGTH_M = 1e-3  # between the middle and the ends of a hinge that closes a loop


class TiedPoint(NamedTuple):
    """A frame on each of two links whose origins must meet.

    Attributes:
        suffix: Suffix of the name, if a joint has several points.
        near: In the parent link's frame [m].
        far: In the child link's frame [m].
    """

    suffix: str
    near: SE3
    far: SE3


def tied_points(model: LoweredModel, loop: LoweredJoint) -> tuple[TiedPoint, ...]:
    """Return the points that hold a closing joint: one for a ball, two on the axis of a hinge, three for a fixed joint.

    A sliding joint cannot be held by points; limits never can.
    """
    a = half_length(model, loop)
    offsets = {
        JointType.BALL: {"": (0.0, 0.0, 0.0)},
        JointType.REVOLUTE: {"__a": (0.0, 0.0, -a), "__b": (0.0, 0.0, a)},
        JointType.FIXED: {"__a": (0.0, 0.0, 0.0), "__b": (a, 0.0, 0.0), "__c": (0.0, a, 0.0)},
    }.get(loop.joint.type, {})
    ends = (loop.T_parent_joint, loop.T_child_joint)
    return tuple(TiedPoint(suffix, *(T @ SE3.from_translation(offset) for T in ends)) for suffix, offset in offsets.items())


def half_length(model: LoweredModel, loop: LoweredJoint) -> float:
    """Return the distance from a joint's origin at which it is held [m]: a quarter of its parts' reach, to resist tilting."""
    reach = 0.0
    for link in model.links:
        if link.name in {loop.parent, loop.child}:
            origins = [metres(connector.frame).translation for connector in link.part.connectors.values()]
            reach = max([reach, *(float(np.linalg.norm(a - b)) for a in origins for b in origins)])
    return max(reach / 4, LEAST_HALF_LENGTH_M)


def has_limits(loop: LoweredJoint) -> bool:
    """True when a closing joint has limits, which points do not hold."""
    limits = loop.joint.limits
    if loop.joint.type is JointType.BALL:
        return limits.twist is not None or (limits.cone is not None and limits.cone < math.pi)
    return any(math.isfinite(bound) for bound in (*limits.lower, *limits.upper))
