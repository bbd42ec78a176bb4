"""Which bodies a joint moves, seen from the ground: a body is all that is fixed together."""

from __future__ import annotations

from articad.kinematics.joints import Joint, JointType
from articad_bench.subject import Subject

__all__ = ["carried", "moved_bodies", "moving", "parts_of"]


def moving(subject: Subject) -> list[Joint]:
    """Return the joints that are not fixed."""
    return [joint for joint in subject.assembly.joints if joint.type is not JointType.FIXED]


def moved_bodies(subject: Subject, joint: Joint) -> list[str]:
    """Return the body beyond a joint, seen from the ground; both bodies of a joint in a loop, without the ground."""
    reached = _reached(subject, joint)
    ends = dict.fromkeys((subject.rigid[joint.child], subject.rigid[joint.parent]))
    return [end for end in ends if end not in reached] or [end for end in ends if end != subject.rigid[subject.assembly.ground]]


def carried(subject: Subject, joint: Joint) -> list[str]:
    """Return all parts that nothing but a joint connects to the ground; of a joint in a loop, the parts of the bodies that it moves."""
    reached = _reached(subject, joint)
    beyond = [name for name in subject.shaped if subject.rigid[name] not in reached]
    return beyond or [name for body in moved_bodies(subject, joint) for name in parts_of(subject, body)]


def parts_of(subject: Subject, body: str) -> list[str]:
    """Return the parts of a body that have a shape."""
    return [name for name in subject.shaped if subject.rigid[name] == body]


def _reached(subject: Subject, joint: Joint) -> set[str]:
    """Return the bodies that joints connect to the ground without one of them."""
    others = [(subject.rigid[each.parent], subject.rigid[each.child]) for each in moving(subject) if each is not joint]
    ground = subject.rigid[subject.assembly.ground]
    reached, fresh = {ground}, {ground}
    while fresh:
        fresh = {end for ends in others for end in ends if fresh & {*ends}} - reached
        reached |= fresh
    return reached
