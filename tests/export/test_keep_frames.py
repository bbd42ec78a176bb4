"""With `keep_frames` every link of a URDF has its part's frame: MuJoCo poses the original, Pinocchio the copy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad import cli
from articad.export.urdf import write_urdf
from articad.importers.mjcf import read_mjcf
from tests.assemblies import all_joint_kinds, random_configurations
from tests.engines import joint_values, our_poses

pytestmark = pytest.mark.engines


def random_mjcf(random: np.random.Generator) -> str:
    """Return a tree of bodies whose joints pass anywhere beside the bodies' origins; some are welded to their parents."""

    def vector(size: float = 0.3) -> str:
        return " ".join(f"{x:.4f}" for x in random.uniform(-size, size, 3))

    bodies = [f'<body name="b{index}" pos="{vector()}" euler="{vector(90)}">' for index in range(8)]
    for index in range(8):
        kind = random.choice(["hinge", "slide", "none"], p=[0.6, 0.2, 0.2])
        joint = f'<joint name="j{index}" type="{kind}" axis="{vector()}" pos="{vector()}"/>' if kind != "none" else ""
        bodies[index] += f'{joint}<geom type="box" size=".02 .03 .04" pos="{vector(0.1)}"/>'
    text, opened = "", 0
    for body in bodies:
        while opened and random.random() < 0.4:
            text, opened = f"{text}</body>", opened - 1
        text, opened = text + body, opened + 1
    return f"<mujoco><worldbody>{text}{'</body>' * opened}</worldbody></mujoco>"


def poses_in_pinocchio(path: Path, values: dict[str, float]) -> dict[str, Any]:
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    q = pin.neutral(model)
    for index in range(1, model.njoints):
        joint, value = model.joints[index], values[model.names[index]]
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else [np.cos(value), np.sin(value)]
    data = model.createData()
    pin.forwardKinematics(model, data, q)
    pin.updateFramePlacements(model, data)
    return {frame.name: data.oMf[index].homogeneous for index, frame in enumerate(model.frames) if frame.type == pin.BODY}


@pytest.mark.parametrize("seed", range(6))
def test_links_of_a_copy_stand_where_the_bodies_of_the_original_stand(seed: int, tmp_path: Path) -> None:
    import mujoco

    random = np.random.default_rng(seed)
    source = tmp_path / "source.xml"
    source.write_text(random_mjcf(random))
    bundle = write_urdf(read_mjcf(source), keep_frames=True)
    bundle.write(tmp_path / "out")
    original = mujoco.MjModel.from_xml_path(str(source))
    data = mujoco.MjData(original)
    data.qpos[:] = random.uniform(-1, 1, original.nq)
    mujoco.mj_kinematics(original, data)
    values = {original.joint(index).name: float(data.qpos[index]) for index in range(original.njnt)}

    read = poses_in_pinocchio(tmp_path / "out" / bundle.main, values)

    assert not [loss for loss in bundle.losses if "frame" in loss.lost]
    for index in range(1, original.nbody):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = data.xmat[index].reshape(3, 3), data.xpos[index]
        assert np.allclose(read[original.body(index).name], pose, atol=1e-9), original.body(index).name
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "out" / bundle.main)).nq == original.nq


def test_parts_of_our_own_keep_their_frames_but_for_the_ground(tmp_path: Path) -> None:
    assembly = all_joint_kinds()
    bundle = write_urdf(assembly, keep_frames=True)
    bundle.write(tmp_path)
    q = random_configurations(assembly, 0, 1)[0]

    read = poses_in_pinocchio(tmp_path / bundle.main, joint_values(assembly, q))

    ours = our_poses(assembly, q)
    for name in assembly.parts.keys() - {assembly.mechanism.ground}:
        assert np.allclose(read[name], ours[name], atol=1e-9), name
    assert [loss.where for loss in bundle.losses if "frame" in loss.lost] == ["parts.base"]


def test_the_flag_is_for_urdf(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "source.xml"
    source.write_text(
        '<mujoco><worldbody><body name="a"><joint name="j" pos="0 0 .3" axis="1 0 0"/><geom size=".1"/></body></worldbody></mujoco>'
    )

    assert cli.main(["convert", str(source), str(tmp_path / "moved.urdf"), "-v"]) == 0
    assert "0, 0, 300 mm" in capsys.readouterr().out
    assert cli.main(["convert", str(source), str(tmp_path / "kept.urdf"), "--keep-frames", "-v"]) == 0
    assert "frame" not in capsys.readouterr().out
    assert cli.main(["convert", str(source), str(tmp_path / "a.xml"), "--keep-frames"]) == 3
    assert "no option keep_frames" in capsys.readouterr().err
