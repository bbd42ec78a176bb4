"""Files that nobody here wrote: poses of links agree with the engines that read them, before and after a round trip."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.errors import ReadError
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.mjcf import read_mjcf
from articad.importers.urdf import read_urdf
from articad.kinematics.configuration import Configuration
from articad.kinematics.joints import JointType
from articad.kinematics.mechanism import Mechanism

FloatArray = NDArray[np.float64]

pybullet_data = pytest.importorskip("pybullet_data")

ROOT = Path(pybullet_data.getDataPath())
RANDOM = [ROOT / "random_urdfs" / f"{i:03}" / f"{i:03}.urdf" for i in range(0, 1000, 100)]
URDFS = sorted(path for path in ROOT.rglob("*.urdf") if "random_urdfs" not in path.parts) + RANDOM
MJCFS = sorted((ROOT / "mjcf").glob("*.xml"))

REFUSED = {
    "racecar/racecar_differential.urdf": "has 4 numbers",
    "quadruped/microtaur/microtaur.urdf": "has 4 numbers",
    "biped/biped2d_pybullet.urdf": "XML declaration allowed only at the start",
    "differential/diff_ring.urdf": "XML declaration allowed only at the start",
    "husky/husky.urdf": "is not a number",  # xacro that was not expanded
    "bicycle/bike.urdf": "is not a number",
    "torus_deform.urdf": "0 root links",
    "torus/torus_with_plane.urdf": "0 root links",
    "torus/torus_with_separate_plane.urdf": "0 root links",
    "mjcf/ground.xml": "MuJoCo does not take it",
    "mjcf/ground_plane.xml": "MuJoCo does not take it",
    "mjcf/half_cheetah.xml": "MuJoCo does not take it",
    "mjcf/hopper.xml": "MuJoCo does not take it",
    "mjcf/humanoid_fixed.xml": "MuJoCo does not take it",
    "mjcf/humanoid_symmetric.xml": "MuJoCo does not take it",
    "mjcf/swimmer.xml": "MuJoCo does not take it",
    "mjcf/walker2d.xml": "MuJoCo does not take it",
}

UNREAD_BY_PINOCCHIO = {"spherical_joint_limit.urdf", "humanoid/humanoid.urdf"}

pytestmark = pytest.mark.engines


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def configurations(assembly: Assembly, count: int) -> FloatArray:
    """Configurations of the drivers; of a mechanism whose joints are tied, only those of the drivers are drawn."""
    mechanism = assembly.mechanism
    free = Mechanism(mechanism.parts, mechanism.ground, mechanism.joints)
    columns = Configuration.random(free.joints, np.random.default_rng(0), (count,)).columns
    names = [coordinate.name for coordinate in free.coordinates]
    return columns[:, [names.index(driver.name) for driver in assembly.drivers]]


def pinocchio_poses(assembly: Assembly, path: Path, q: FloatArray) -> dict[str, FloatArray]:
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    configuration = assembly.mechanism.configuration(q)
    types = {joint.name: joint.type for joint in assembly.joints}
    full = pin.neutral(model)
    for name in model.names[1:]:
        joint = model.joints[model.getJointId(name)]
        at = joint.idx_q
        if joint.nq == 7:
            full[at : at + 7] = [*(configuration[f"{name}__{axis}"][0] / 1000 for axis in "xyz"), *configuration[f"{name}__ball"]]
        elif types[name] is JointType.PLANAR:
            x, y, angle = configuration[name]
            full[at : at + 4] = x / 1000, y / 1000, math.cos(angle), math.sin(angle)
        else:
            value = configuration[name][0] / (1000 if types[name] is JointType.SLIDER else 1)
            full[at : at + joint.nq] = [math.cos(value), math.sin(value)] if joint.nq == 2 else [value]
    pin.framesForwardKinematics(model, data, full)
    return {
        name: data.oMf[model.getFrameId(name, pin.FrameType.BODY)].homogeneous
        for name in assembly.parts
        if model.existFrame(name, pin.FrameType.BODY)
    }


def mujoco_poses(assembly: Assembly, path: Path, q: FloatArray) -> dict[str, FloatArray]:
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    configuration = assembly.mechanism.configuration(q)
    for index in range(model.njnt):
        name, at = model.joint(index).name or f"joint_{index}", model.jnt_qposadr[index]
        kind = model.jnt_type[index]
        if kind == mujoco.mjtJoint.mjJNT_FREE:
            x, y, z, w = configuration[f"{name}__ball"]
            data.qpos[at : at + 7] = [*(configuration[f"{name}__{axis}"][0] / 1000 for axis in "xyz"), w, x, y, z]
        elif kind == mujoco.mjtJoint.mjJNT_BALL:
            x, y, z, w = configuration[name]
            data.qpos[at : at + 4] = w, x, y, z
        else:
            data.qpos[at] = configuration[name][0] / (1000 if kind == mujoco.mjtJoint.mjJNT_SLIDE else 1)
    mujoco.mj_kinematics(model, data)
    found = {}
    for body in range(model.nbody):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = data.xmat[body].reshape(3, 3), data.xpos[body]
        found[model.body(body).name or f"body_{body}"] = T
    return found


def difference(assembly: Assembly, q: FloatArray, theirs: dict[str, FloatArray]) -> float:
    matrices = assembly.poses(q).matrix.copy()
    matrices[:, :3, 3] /= 1000
    ours = dict(zip(assembly.parts, matrices, strict=True))
    common = ours.keys() & theirs.keys()
    assert len(common) >= min(len(theirs), 1)
    return max(float(np.abs(ours[name] - theirs[name]).max()) for name in common)


def test_there_are_enough_files_and_few_are_refused() -> None:
    assert len(URDFS) + len(MJCFS) >= 60
    assert len(REFUSED) <= 0.15 * (len(URDFS) + len(MJCFS))


@pytest.mark.parametrize("path", URDFS, ids=relative)
def test_a_foreign_urdf_is_posed_as_pinocchio_poses_it(path: Path) -> None:
    if relative(path) in REFUSED:
        with pytest.raises(ReadError, match=REFUSED[relative(path)]):
            read_urdf(path, root=ROOT, fuse=False)
        return
    assembly = read_urdf(path, root=ROOT, fuse=False)
    if relative(path) in UNREAD_BY_PINOCCHIO:
        return
    for q in configurations(assembly, 2):
        assert difference(assembly, q, pinocchio_poses(assembly, path, q)) < 1e-9


@pytest.mark.parametrize("path", MJCFS, ids=relative)
def test_a_foreign_mjcf_is_posed_as_mujoco_poses_it(path: Path) -> None:
    if relative(path) in REFUSED:
        with pytest.raises(ReadError, match=REFUSED[relative(path)]):
            read_mjcf(path, root=ROOT, fuse=False)
        return
    assembly = read_mjcf(path, root=ROOT, fuse=False)
    for q in configurations(assembly, 2):
        assert difference(assembly, q, mujoco_poses(assembly, path, q)) < 1e-9


ROUND = [
    "r2d2.urdf",
    "kuka_iiwa/model.urdf",
    "humanoid/humanoid.urdf",
    "laikago/laikago.urdf",
    "gripper/wsg50_one_motor_gripper_left_finger.urdf",
    "cartpole.urdf",
]


@pytest.mark.parametrize("name", ROUND)
def test_a_foreign_file_survives_the_round_trip(name: str, tmp_path: Path) -> None:
    first = read_urdf(ROOT / name, root=ROOT)
    for write, read in ((write_urdf, read_urdf), (write_mjcf, read_mjcf)):
        bundle: Any = write(first)
        bundle.write(tmp_path)
        again = read(tmp_path / bundle.main)

        assert list(again.parts) == list(first.parts)
        assert [joint.name for joint in again.joints] == [joint.name for joint in first.joints]
        for q in configurations(first, 2):
            assert (again.poses(q).data == first.poses(q).data).all()
