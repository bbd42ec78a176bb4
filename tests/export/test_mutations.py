"""Ten and more mistakes of sign or order that lowering could make: each must be seen by an engine that is not ours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.export import lowering, mjcf, urdf
from articad.export.markup import rpy, wxyz
from articad.kinematics.joints import Joint, JointType
from tests.assemblies import all_joint_kinds, random_configurations
from tests.engines import disagreement

Patch = pytest.MonkeyPatch
FRAMES = lowering._frames
LOWERED = lowering._lowered
FREEDOM = lowering._freedom
METRES, JOINT = lowering.metres, mjcf._joint

pytestmark = pytest.mark.engines


def _frames(forwards: Callable[[Joint], tuple[SE3, SE3]] | None = None, backwards: Callable[[Joint], tuple[SE3, SE3]] | None = None) -> Any:
    def frames(joint: Joint, *, backwards: bool, turned: Any = backwards) -> tuple[SE3, SE3]:
        changed = turned if backwards else forwards
        return FRAMES(joint, backwards=backwards) if changed is None else changed(joint)

    return lambda patch: patch.setattr(lowering, "_frames", frames)


def _motions(kind: JointType, *order: int) -> Any:
    changed = tuple(kind.steps[at] for at in order)
    return lambda patch: patch.setattr(lowering, "motions", lambda asked: changed if asked is kind else asked.steps)


def _after(change: Callable[[lowering.LoweredJoint], lowering.LoweredJoint]) -> Any:
    return lambda patch: patch.setattr(lowering, "_lowered", lambda *args, **options: change(LOWERED(*args, **options)))


def _unturned(joint: lowering.LoweredJoint) -> lowering.LoweredJoint:
    return replace(joint, freedoms=tuple(replace(freedom, axis=abs(freedom.axis)) for freedom in joint.freedoms))


def _declared_order(joint: lowering.LoweredJoint) -> lowering.LoweredJoint:
    return replace(joint, freedoms=joint.freedoms[::-1]) if joint.backwards else joint


def _screw(factor: float) -> Any:
    def freedom(joint: Joint, *args: Any) -> lowering.AxisMotion:
        found = FREEDOM(joint, *args)
        return found if found.follows is None else replace(found, axis=found.axis * factor)

    return lambda patch: patch.setattr(lowering, "_freedom", freedom)


MUTATIONS: dict[str, Callable[[Patch], None]] = {
    "an opposed mate is not turned over": _frames(lambda joint: (joint.T_parent_connector, joint.T_child_connector.inverse())),
    "the flip comes after the child's connector": _frames(
        lambda joint: (joint.T_parent_connector, joint.T_child_connector.inverse() @ flip(joint.mate))
    ),
    "the child's connector is not inverted": _frames(lambda joint: (joint.T_parent_connector, flip(joint.mate) @ joint.T_child_connector)),
    "parent and child connectors are exchanged": _frames(
        lambda joint: (joint.T_child_connector, flip(joint.mate) @ joint.T_parent_connector.inverse())
    ),
    "a joint crossed backwards is not turned over": _frames(
        backwards=lambda joint: (joint.T_child_connector, joint.T_parent_connector.inverse())
    ),
    "the parent's connector is not inverted backwards": _frames(
        backwards=lambda joint: (joint.T_child_connector @ flip(joint.mate), joint.T_parent_connector)
    ),
    "the flip comes before the connector backwards": _frames(
        backwards=lambda joint: (flip(joint.mate) @ joint.T_child_connector, joint.T_parent_connector.inverse())
    ),
    "axes keep their sign backwards": _after(_unturned),
    "a chain keeps its order backwards": _after(_declared_order),
    "a planar joint turns before it slides": _motions(JointType.PLANAR, 2, 0, 1),
    "a universal joint turns about y first": _motions(JointType.UNIVERSAL, 1, 0),
    "a ball turns about z first": _motions(JointType.BALL, 2, 1, 0),
    "a screw has the other hand": _screw(-1.0),
    "a joint's frame ignores where its parent's link frame is": lambda patch: patch.setattr(
        lowering, "metres", _forgetful_metres(lowering.metres)
    ),
    "lengths are divided by 1000 twice": lambda patch: patch.setattr(lowering, "metres", lambda T: METRES(METRES(T))),
    "roll and yaw are exchanged": lambda patch: patch.setattr(urdf, "rpy", lambda T: rpy(T)[::-1]),
    "a quaternion is written w last": lambda patch: patch.setattr(mjcf, "wxyz", lambda T: (*wxyz(T)[1:], wxyz(T)[0])),
    "an axis is written with the other sign": lambda patch: patch.setattr(mjcf, "_joint", _joint_with_axis_against),
}


def _forgetful_metres(metres: Callable[[SE3], SE3]) -> Callable[[SE3], SE3]:
    return lambda T: metres(SE3.from_quaternion(T.quaternion))


def _joint_with_axis_against(freedom: lowering.AxisMotion, **options: bool) -> dict[str, str]:
    return JOINT(replace(freedom, axis=-freedom.axis), **options)


def test_the_unchanged_lowering_agrees(tmp_path: Path) -> None:
    assembly = all_joint_kinds()

    assert disagreement(assembly, tmp_path, random_configurations(assembly, 3, 5)) < 1e-9


@pytest.mark.parametrize("name", MUTATIONS)
def test_a_mistake_is_seen(name: str, tmp_path: Path, monkeypatch: Patch) -> None:
    assembly = all_joint_kinds()
    MUTATIONS[name](monkeypatch)

    assert disagreement(assembly, tmp_path, random_configurations(assembly, 3, 5)) > 1e-6
