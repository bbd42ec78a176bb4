"""Bindings of a task's checks to bodies, derived from its reference: what each joint that is asked for moves, and which joints surfaces make.

The bounds are wide, because another construction of the same product is another share of its matter; a disc, a wire or a missing body is outside.
"""

from __future__ import annotations

from typing import Final

from articad.kinematics.joints import JointType
from articad_bench.checks import AnyCheck, Joints, Made, Moves, moved_share
from articad_bench.subject import Subject
from articad_bench.task import Task

__all__ = ["bindings", "bound"]

VOLUME: Final = 5.0  # times less or more of the matter
GREATEST: Final = 2.5  # times less, for the joint that moves most
SIZE: Final = 2.0  # times smaller or larger, as a share of the whole


def bindings(task: Task, subject: Subject) -> tuple[AnyCheck, ...]:
    """Return checks that bind a task's joints to bodies.

    Args:
        task: The task.
        subject: Its reference.
    """
    checks: list[AnyCheck] = []
    for check in task.checks:
        if not isinstance(check, Joints) or check.joint.type is JointType.FIXED or check.number[0] < 1:
            continue
        shares = [moved_share(subject, joint) for joint in check.joint.found(subject)]
        volume, size = zip(*shares, strict=True)
        sizes = (_rounded(min(size) / SIZE), _rounded(max(size) * SIZE))
        all_of_them = (_rounded(min(volume) / VOLUME), min(1.0, _rounded(max(volume) * VOLUME)))
        checks.append(Moves(joint=check.joint, volume=all_of_them, size=sizes, number=check.number))
        if max(volume) > GREATEST * min(volume):
            checks.append(Moves(joint=check.joint, volume=(_rounded(max(volume) / GREATEST), 1.0), size=sizes))
    if any(joint.type is not JointType.FIXED for joint in subject.assembly.joints):
        checks.append(Made(except_for=len(Made.wrong(subject))))
    return tuple(checks)


def bound(task: Task, subject: Subject) -> Task:
    """Return a task with its bindings in place of those that it has."""
    others = tuple(check for check in task.checks if not isinstance(check, Moves | Made))
    return task.model_copy(update={"checks": (*others, *bindings(task, subject))})


def _rounded(value: float) -> float:
    return float(f"{value:.2g}")
