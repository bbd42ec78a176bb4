"""What drives a linkage that was read from a file: what the file says, else what a person would turn, whatever the order of its joints."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from articad.errors import KinematicsError
from articad.export.hulls import rigid_groups
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism

__all__ = ["driven"]


def driven(mechanism: Mechanism, stated: Iterable[str] = ()) -> Mechanism:
    """Return a mechanism with drivers, as far as these do not follow each other.

    Args:
        mechanism: As it was read. A tree stays as it is, and so does a linkage whose loops do not close.
        stated: Names of the joints that drive by its file. Without one, and where a loop closes, these are the joints that turn without end on the
            ground, else the screws.
    """
    if mechanism.is_tree:
        return mechanism
    joints = mechanism.given_joints
    names = {joint.name for joint in joints if joint.type not in {JointType.FIXED, JointType.FREE}} & set(stated)
    if not names and len(joints) >= len(mechanism.parts):
        names = _cranks(joints, mechanism.parts, mechanism.ground)
    while names:
        marked = [replace(joint, driver=joint.name in names) for joint in joints]
        made = Mechanism(mechanism.parts, mechanism.ground, marked, mechanism.couplings, mechanism.T_ground)
        try:
            refused = {joint.name for joint in made.branch.refused}
        except KinematicsError:  # its loops do not close, which whoever asks for its poses hears
            return mechanism
        if not refused:
            return made
        names -= refused
    return mechanism


def _cranks(joints: tuple[Joint, ...], parts: tuple[str, ...], ground: str) -> set[str]:
    """Return the joints that turn without end about something fixed to the ground; if there are none, the screws."""
    group = rigid_groups(joints, parts)
    turning = [joint for joint in joints if joint.type is JointType.REVOLUTE and group[ground] in (group[joint.parent], group[joint.child])]
    endless = {joint.name for joint in turning if math.isinf(joint.limits.upper[0] - joint.limits.lower[0])}
    return endless or {joint.name for joint in joints if joint.type is JointType.SCREW}
