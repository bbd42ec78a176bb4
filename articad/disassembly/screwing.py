"""Parts that leave along a thread: turned out by the lead of their joint.

The surfaces turn while they move, so no closed formula for triangles says where they meet. The motion is sampled by Booleans of the solids at 16
places of each turn, and is not proven.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.disassembly.ways import Ways
from articad.interference.overlap import overlap
from articad.kinematics.joints import Joint

__all__ = ["ScrewOut", "screwed"]

_EACH_TURN: Final = 16  # places at which parts are compared
_MOST_TURNS: Final = 64


class ScrewOut(NamedTuple):
    """How parts are turned out of a thread.

    Attributes:
        pair: The part that turns, and the one that holds it.
        turns: Whole turns until they are apart, right-handed about the offset.
        offset: The way of these turns along the axis `(3,)` [mm].
        point: A point on the axis `(3,)` [mm].
    """

    pair: tuple[str, str]
    turns: int
    offset: FloatArray
    point: FloatArray


def screwed(offset: FloatArray, turns: float, point: FloatArray) -> SE3:
    """Return the motion of a thread.

    Args:
        offset: By which it moves along its axis `(3,)` [mm].
        turns: By which it turns, right-handed about the offset.
        point: On its axis `(3,)` [mm].
    """
    return SE3.from_translation(offset) @ SE3.from_axis_angle(offset, 2 * math.pi * turns, about=point)


def screw_out(ways: Ways, joint: Joint, moving: Sequence[str], staying: Sequence[str], sense: float) -> ScrewOut | None:
    """Return how parts are turned out of a thread until the two parts of its joint are apart; None if something stops them.

    Args:
        ways: All parts, at rest.
        joint: A screw joint between one of the parts that move and one that stays.
        moving: Parts that turn together.
        staying: Parts that do not move.
        sense: 1 along the axis of the joint, -1 against it.
    """
    inside, outside = (joint.child, joint.parent) if joint.child in moving else (joint.parent, joint.child)
    frame = ways.poses[joint.parent] @ joint.T_parent_connector
    way, lead = sense * np.asarray(frame.z_axis), abs(joint.lead)
    turns = math.ceil(ways.clear_length([inside], [outside], way) / lead)
    if not 0 < turns <= _MOST_TURNS:  # parts that are apart already are not turned
        return None
    handed = math.copysign(1.0, joint.lead)
    for turned in np.arange(1, turns * _EACH_TURN + 1) / _EACH_TURN:
        T = screwed(turned * lead * way, handed * turned, frame.translation)
        for part in moving:
            for other in staying:
                T_other_part = ways.poses[other].inverse() @ T @ ways.poses[part]
                if overlap(ways.scene.bodies[other], ways.scene.bodies[part], T_other_part).depth > ways.depth(part, other):
                    return None
    return ScrewOut((inside, outside), int(handed) * turns, turns * lead * way, np.asarray(frame.translation))
