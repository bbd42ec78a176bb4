"""What remains of a linkage when parts that were taken away have opened one of its loops: it moves farther than in the whole product.

Its joints that are moved keep their own limits. Those that follow are held by their surfaces only, which are tried: a ram may leave the
open end of its guide.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from articad.connectors.se3 import SE3
from articad.disassembly.poses import poses_at, reached_at
from articad.disassembly.steps import AssemblyStep
from articad.errors import ArticadError
from articad.interference.overlap import overlap
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism

__all__ = ["Folded", "Proof", "folded", "is_opened", "remaining", "step_poses"]

Proof = Callable[[Mechanism, str], bool]
"""Proves that no parts of a mechanism meet while a joint moves over its whole range."""

_STEPS: Final = 24  # of the way from rest to an end
_HALVINGS: Final = 3  # of a step, to the pose where parts meet
_SHARES: Final = (0.9, 0.7, 0.5, 0.3)  # of the free way, the farthest first
_MOST: Final = 2  # joints that are moved, each for itself
_SAME: Final = 1e-6  # of poses: parts that have not moved against each other
_LOOSE = (JointType.REVOLUTE, JointType.SLIDER)
_ENDLESS: Final = JointLimits((-math.inf,), (math.inf,))


class Folded(NamedTuple):
    """A pose of what remains.

    Attributes:
        mechanism: What remains, with the moved joint limited to the way there.
        joint: The joint that is moved.
        value: Its value [rad].
        poses: `T_ground_part` of the parts that remain.
    """

    mechanism: Mechanism
    joint: str
    value: float
    poses: Mapping[str, SE3]


def is_opened(mechanism: Mechanism, parts: Collection[str]) -> bool:
    """Return whether some parts alone have fewer loops than the whole."""
    inside = [joint for joint in mechanism.joints if {joint.parent, joint.child} <= set(parts)]
    return len(inside) - len(parts) < len(mechanism.joints) - len(mechanism.parts)


def remaining(mechanism: Mechanism, parts: Collection[str], base: str, joint: str) -> Mechanism | None:
    """Return the mechanism of some of the parts; None if joints do not connect them.

    Args:
        mechanism: The whole.
        parts: The parts that remain.
        base: The one that stands still.
        joint: The joint that drives it; the others have no limits.
    """
    inside = [each for each in mechanism.joints if {each.parent, each.child} <= set(parts)]
    inside = [_loosened(each) if each.name != joint else replace(each, driver=True) for each in inside]
    names = {each.name for each in inside}
    couplings = [each for each in mechanism.couplings if {each.a.split(".")[0], each.b.split(".")[0]} <= names]
    try:
        return Mechanism(
            [name for name in mechanism.parts if name in parts], base, inside, couplings, mechanism.at_rest[mechanism.part_index(base)]
        )
    except ArticadError:
        return None


def _loosened(joint: Joint) -> Joint:
    return replace(joint, driver=False, limits=_ENDLESS) if joint.type in _LOOSE else replace(joint, driver=False)


def folded(scene: Scene, mechanism: Mechanism, parts: Collection[str], base: str) -> Iterator[Folded]:
    """Yield poses that what remains of a linkage reaches without a collision, the farthest of each joint first.

    Collisions on the way are sampled here; the motion is to be proven.
    """
    if not is_opened(mechanism, parts) or len(parts) < 2:
        return
    joints = [joint for joint in mechanism.joints if {joint.parent, joint.child} <= set(parts) and joint.type is JointType.REVOLUTE]
    tried = 0
    for joint in sorted(joints, key=lambda each: -(each.limits.upper[0] - each.limits.lower[0])):
        whole = remaining(mechanism, parts, base, joint.name)
        if whole is None or [driver.joint for driver in whole.drivers].count(joint.name) != 1:
            continue
        if tried == _MOST:
            return
        tried += 1
        rest = float(joint.rest[0])
        ends = [_farthest(scene, whole, joint, end) for end in _ends(joint)]
        for share in _SHARES:
            for end in sorted(ends, key=lambda each: -abs(each - rest)):
                value = rest + share * (end - rest)
                poses = reached_at(whole, {joint.name: value})
                if poses is not None and abs(value - rest) > _SAME:
                    yield Folded(_limited(whole, joint.name, rest, value), joint.name, value, poses)


def step_poses(mechanism: Mechanism, step: AssemblyStep, base: str) -> dict[str, SE3]:
    """Return `T_ground_part` of all parts as they are when a step of an order is done.

    Args:
        mechanism: The whole.
        step: The step; where a loop is still open, only what is there so far is moved.
        base: The part that everything is put onto.
    """
    found = _opened_poses(mechanism, step, base) if step.opened else poses_at(mechanism, step.at)
    return found | {name: SE3.from_translation(offset) @ found[name] for name, offset in step.beside.items()}


def _opened_poses(mechanism: Mechanism, step: AssemblyStep, base: str) -> dict[str, SE3]:
    found = {name: mechanism.at_rest[index] for index, name in enumerate(mechanism.parts)}
    for joint, value in step.at.items():
        whole = remaining(mechanism, (*step.onto, *step.parts), base if base in step.onto else step.onto[0], joint)
        found |= (None if whole is None else reached_at(whole, {joint: value})) or {}
    return found


def _ends(joint: Joint) -> tuple[float, float]:
    """Return the values up to which a joint is moved [rad]: its own limits, half a turn at most."""
    rest = float(joint.rest[0])
    return max(joint.limits.lower[0], rest - math.pi), min(joint.limits.upper[0], rest + math.pi)


def _farthest(scene: Scene, whole: Mechanism, joint: Joint, end: float) -> float:
    """Return the value nearest to an end up to which parts are not seen to meet."""
    free, rest = float(joint.rest[0]), float(joint.rest[0])
    start = reached_at(whole, {joint.name: rest})
    if start is None:
        return rest
    step = (end - rest) / _STEPS
    for value in rest + step * np.arange(1, _STEPS + 1):
        if not _is_free(scene, start, reached_at(whole, {joint.name: float(value)})):
            break
        free = float(value)
    else:
        return free
    for _ in range(_HALVINGS):
        step /= 2
        if _is_free(scene, start, reached_at(whole, {joint.name: free + step})):
            free += step
    return free


def _is_free(scene: Scene, start: Mapping[str, SE3], poses: Mapping[str, SE3] | None) -> bool:
    """Return whether a pose is reached and no parts that have moved against each other since the start enter each other."""
    if poses is None:
        return False
    names = [name for name in poses if name in scene.bodies and name not in scene.broken]
    for at, a in enumerate(names):
        for b in names[at + 1 :]:
            T = poses[a].inverse() @ poses[b]
            moved = float(np.abs(np.asarray(T.matrix) - np.asarray((start[a].inverse() @ start[b]).matrix)).max())
            if moved > _SAME and overlap(scene.bodies[a], scene.bodies[b], T).depth > scene.passable(a, b):
                return False
    return True


def _limited(whole: Mechanism, joint: str, rest: float, value: float) -> Mechanism:
    """Return a mechanism in which one joint moves from rest to a value."""
    limits = JointLimits((min(rest, value),), (max(rest, value),))
    joints = [replace(each, limits=limits) if each.name == joint else each for each in whole.given_joints]
    return Mechanism(whole.parts, whole.ground, joints, whole.couplings, whole.T_ground)
