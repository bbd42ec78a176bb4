"""Which bodies a joint moves, seen from the ground: a body is all that is fixed together."""

from __future__ import annotations

from articad.kinematics.joints import Joint, JointType
from articad_bench.subject import Subject

__all__ = ["moved_bodies", "moving"]


def moving(subject: Subject) -> list[Joint]:
    """Return the joints that are not fixed."""
    return [joint for joint in subject.assembly.joints if joint.type is not JointType.FIXED]


def moved_bodies(subject: Subject, joint: Joint) -> list[str]:
    """Return the body beyond a joint, seen from the ground; both bodies of a joint in a loop, without the ground."""
    others = [(subject.rigid[each.parent], subject.rigid[each.child]) for each in moving(subject) if each is not joint]
    ground = subject.rigid[subject.assembly.ground]
    reached, fresh = {ground}, {ground}
    while fresh:
        fresh = {end for ends in others for end in ends if fresh & {*ends}} - reached
        reached |= fresh
    ends = dict.fromkeys((subject.rigid[joint.child], subject.rigid[joint.parent]))
    return [end for end in ends if end not in reached] or [end for end in ends if end != ground]
