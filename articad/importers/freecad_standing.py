"""How far the parts of a FreeCAD document stand from where its joints put them; of all joints at once, for there may be thousands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.kinematics.joints import Joint, JointType


def deviations(joints: Sequence[Joint], poses: Mapping[str, SE3]) -> tuple[FloatArray, FloatArray]:
    """Return how far apart [mm] and how much askew [rad] the sides of each joint stand `(n,)`, beyond what the joint allows.

    With T the poses of the parts, C the frames of the joint, F the turn of an opposed one and J(q) its motion, the deviation is
    J(q)⁻¹ C_p⁻¹ T_p⁻¹ T_c C_c F at the coordinates q of rest.

    Args:
        joints: The joints.
        poses: Poses of the parts.
    """
    if not joints:
        return np.zeros(0), np.zeros(0)
    near = SE3.stack([poses[joint.parent] for joint in joints]) @ SE3.stack([joint.T_parent_connector for joint in joints])
    far = SE3.stack([poses[joint.child] for joint in joints]) @ SE3.stack([joint.T_child_connector for joint in joints])
    flips = SE3.stack([FLIP if joint.mate is Mate.OPPOSED else SE3.identity() for joint in joints])
    return sizes(_at_rest(joints).inverse() @ (near.inverse() @ far @ flips))


def sizes(D: SE3) -> tuple[FloatArray, FloatArray]:
    """Return the lengths [mm] and the angles [rad] of motions."""
    return np.linalg.norm(D.translation, axis=-1), np.linalg.norm(D.log()[..., 3:], axis=-1)


def _at_rest(joints: Sequence[Joint]) -> SE3:
    """Return the motion of each joint at its coordinates of rest."""
    alike: dict[tuple[JointType, float], list[int]] = {}
    for place, joint in enumerate(joints):
        alike.setdefault((joint.type, joint.lead), []).append(place)
    data = np.empty((len(joints), 7))
    for (kind, lead), places in alike.items():
        data[places] = kind.motion([joints[place].rest for place in places], lead).data
    return SE3.from_unit_array(data)
