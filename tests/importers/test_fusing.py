"""With fuse, files of other tools have the joints that chains, points and welded bodies without shape represent, and their couplings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.mjcf import read_mjcf
from articad.importers.urdf import read_urdf
from articad.kinematics import declare
from articad.kinematics.joints import Coupling, Joint, JointType
from tests.assemblies import block, closed, four_bar, frame
from tests.export.test_loops import KINDS

pytestmark = pytest.mark.engines

BOX = '<geom type="box" size=".05 .04 .03" mass="1"/>'


def again(assembly: Assembly, folder: Path) -> Assembly:
    """Return an assembly as it is read from its MJCF without articad's records."""
    bundle = write_mjcf(assembly, collision="solid")
    bundle.write(folder)
    return read_mjcf(folder / bundle.main, metadata=False, fuse=True)


def only_loop(assembly: Assembly) -> Joint:
    (joint,) = assembly.mechanism.loop_joints
    return joint


LOOPS = {kind: closing for kind, closing in KINDS.items() if kind != "ball"}
"""All kinds but one point, whose limits MJCF does not state."""
OFTEN = ("endless revolute", "screw")


@pytest.mark.parametrize("kind", [pytest.param(kind, marks=() if kind in OFTEN else pytest.mark.soak) for kind in LOOPS])
def test_a_loop_is_closed_by_one_joint_of_its_type(kind: str, tmp_path: Path) -> None:
    first = closed(LOOPS[kind][0])
    second = again(first, tmp_path)
    wanted, joint = only_loop(first), only_loop(second)

    assert joint.type is wanted.type
    np.testing.assert_allclose(joint.limits.lower, wanted.limits.lower, atol=1e-9)
    np.testing.assert_allclose(joint.limits.upper, wanted.limits.upper, atol=1e-9)
    assert joint.lead == pytest.approx(wanted.lead)
    assert second.mechanism.mobility == first.mechanism.mobility
    assert len(second.joints) == len(first.joints) + 1  # which fixes the base to the world
    assert second.mass().mass == pytest.approx(first.mass().mass, rel=1e-6)
    np.testing.assert_allclose(second.mass().com, first.mass().com, atol=1e-5)


def test_what_was_fused_is_written_and_read_again(tmp_path: Path) -> None:
    import mujoco

    bundle = write_mjcf(again(four_bar("endless"), tmp_path / "first"))
    bundle.write(tmp_path)

    mujoco.MjModel.from_xml_path(str(tmp_path / bundle.main))
    assert only_loop(read_mjcf(tmp_path / bundle.main, metadata=False, fuse=True)).type is JointType.REVOLUTE


def linked(equality: str) -> str:
    """Return a parallelogram of three bars whose third is tied to the second at its end."""
    return (
        f'<mujoco><worldbody><body name="a"><joint name="ja" axis="0 0 1"/>{BOX}<body name="b" pos="0 1 0">'
        f'<joint name="jb" axis="0 0 1"/>{BOX}</body></body><body name="c" pos="1 0 0"><joint name="jc" axis="0 0 1"/>{BOX}</body>'
        f"</worldbody><equality>{equality}</equality></mujoco>"
    )


POINTS = '<connect name="p" body1="b" body2="c" anchor="1 0 -0.1"/><connect name="q" body1="c" body2="{}" anchor="{}"/>'


def test_two_points_are_a_hinge_whichever_body_is_named_first(tmp_path: Path) -> None:
    path = tmp_path / "m.xml"
    path.write_text(linked(POINTS.format("b", "0 1 0.1")))

    assembly = read_mjcf(path, fuse=True)
    joint, rest = only_loop(assembly), assembly.at()
    frame = rest["world"].inverse() @ rest[joint.parent] @ joint.T_parent_connector

    assert joint.type is JointType.REVOLUTE
    np.testing.assert_allclose(frame.translation, [1000, 1000, 0], atol=1e-6)
    assert abs(frame.z_axis[2]) == pytest.approx(1)
    assert assembly.mechanism.mobility == 1


def test_points_of_different_bodies_are_no_hinge(tmp_path: Path) -> None:
    path = tmp_path / "m.xml"
    path.write_text(linked(POINTS.format("a", "0 1 0.1")))

    assert [joint.type for joint in read_mjcf(path, fuse=True).joints if joint.closing] == [JointType.BALL] * 2


@pytest.mark.parametrize("form", ["urdf", "mjcf"])
def test_screws_that_follow_one_another_still_do(form: str, tmp_path: Path) -> None:
    base = block("base", (80, 20, 20), left=frame(at=(0, 0, 20)), right=frame(at=(50, 0, 20)), crank=frame(at=(-50, 0, 20)))
    parts = [block(name, root=frame()) for name in ("left", "right", "crank")]
    left, right, crank = (part["root"] for part in parts)
    joints = [
        declare.revolute("crank", base["crank"], crank, limits=(-20.0, 20.0), driver=True),
        declare.screw("right", base["right"], right, lead=-2.0, limits=(-9.0, 9.0), mate="opposed"),
        declare.screw("left", base["left"], left, lead=3.0, limits=(-9.0, 9.0)),
    ]
    couplings = [Coupling("a", "gear", "crank", "right", -0.5), Coupling("b", "gear", "right", "left", 1.5)]
    first = Assembly.from_parts("vice", parts=[base, *parts], joints=joints, couplings=couplings, ground="base")
    (write_urdf if form == "urdf" else write_mjcf)(first, collision="solid").write(tmp_path)
    file = tmp_path / ("vice.urdf" if form == "urdf" else "vice.xml")

    second = (read_urdf if form == "urdf" else read_mjcf)(file, metadata=False, fuse=True)

    leads = {joint.name: joint.lead for joint in second.joints if joint.type is JointType.SCREW}
    assert leads == {"right": pytest.approx(-2.0), "left": pytest.approx(3.0)}
    assert second.mechanism.mobility == 1
    (driver,) = second.drivers
    turn = {"crank": 2.0, "right": -1.0, "left": -1.5}[driver.name]
    for name in ("left", "right", "crank"):  # parts may have other frames, so their motion is compared
        moved, wanted = second.at(**{driver.name: turn})[name], first.at(crank=2.0)[name]
        assert (moved @ second.at()[name].inverse()).allclose(wanted @ first.at()[name].inverse(), mm=1e-6, rad=1e-8)


def test_joints_with_actuators_drive_a_linkage_but_for_those_that_follow(tmp_path: Path) -> None:
    """Both ends of the crossbar have a motor; the bars between them follow."""
    path = tmp_path / "m.xml"
    motors = '<motor name="{0}" joint="{0}"/>'
    text = linked(POINTS.format("b", "0 1 0.1"))
    drivers = []
    for joints in ((), ("jc",), ("jc", "ja")):
        path.write_text(text.replace("</mujoco>", f"<actuator>{''.join(map(motors.format, joints))}</actuator></mujoco>"))
        assembly = read_mjcf(path, fuse=True)
        assert not assembly.mechanism.findings().errors
        drivers.append([driver.joint for driver in assembly.drivers])

    assert drivers == [["ja"], ["jc"], ["ja"]]
