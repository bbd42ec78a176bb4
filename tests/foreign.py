"""Files that nobody here wrote: where their engines put links and bodies, and how a file is taken through articad and back."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import KinematicsError
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.mjcf import read_mjcf
from articad.importers.urdf import read_urdf
from articad.kinematics.configuration import Configuration
from articad.kinematics.joints import JointType
from articad.kinematics.mechanism import Mechanism

FloatArray = NDArray[np.float64]
Oracle = Callable[[Assembly, Path, FloatArray], dict[str, FloatArray]]

TOLERANCE = 1e-9  # m, and entries of rotation matrices
TIMES_NEARER = 6  # that a configuration of a mechanism with loops is halved towards rest until it closes


def read(path: Path, root: Path) -> Assembly:
    """Read a URDF or MJCF with every link as the file has it."""
    return (read_urdf if path.suffix == ".urdf" else read_mjcf)(path, root=root, fuse=False)


def oracle_of(path: Path) -> Oracle:
    """Return who else places the links of a file."""
    return pinocchio_poses if path.suffix == ".urdf" else mujoco_poses


def configurations(assembly: Assembly, count: int) -> FloatArray:
    """Configurations of the drivers; those of a mechanism with loops are brought so near to rest that the loops close."""
    mechanism = assembly.mechanism
    free = Mechanism(mechanism.parts, mechanism.ground, mechanism.joints)
    columns = Configuration.random(free.joints, np.random.default_rng(0), (count,)).columns
    names = [coordinate.name for coordinate in free.coordinates]
    q = columns[:, [names.index(driver.name) for driver in assembly.drivers]]
    if not mechanism.loop_joints:
        return q
    return np.array([_closing(mechanism, one) for one in q])


def _closing(mechanism: Mechanism, q: FloatArray) -> FloatArray:
    for _ in range(TIMES_NEARER):
        try:
            mechanism.poses(q)
        except KinematicsError:
            q = mechanism.rest + (q - mechanism.rest) / 8
        else:
            return q
    return np.asarray(mechanism.rest)


def pinocchio_poses(assembly: Assembly, path: Path, q: FloatArray) -> dict[str, FloatArray]:
    """Poses of a URDF's links as Pinocchio has them [m]."""
    import pinocchio as pin

    try:
        model = pin.buildModelFromUrdf(str(path))
    except ValueError:
        model = pin.buildModelFromXML(_bare(path))
    data = model.createData()
    configuration = assembly.mechanism.configuration(q)
    types = {joint.name: joint.type for joint in assembly.joints}
    full = pin.neutral(model)
    for name in model.names[1:]:
        joint = model.joints[model.getJointId(name)]
        at = joint.idx_q
        if joint.nq == 7:
            full[at : at + 7] = [*(configuration[name][:3] / 1000), *configuration[name][3:]]
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


def _bare(path: Path) -> str:
    """Return only the elements of a URDF that place its links: no mass, no effort, no shape."""
    root = etree.parse(str(path)).getroot()
    for link in root.iterfind("link"):
        for element in list(link):
            link.remove(element)
    for limit in root.iterfind("joint/limit"):
        for name, usual in (("lower", "-1"), ("upper", "1"), ("effort", "1"), ("velocity", "1")):
            limit.set(name, limit.get(name, usual))
    return str(etree.tostring(root, encoding="unicode"))


def mujoco_poses(assembly: Assembly, path: Path, q: FloatArray) -> dict[str, FloatArray]:
    """Poses of an MJCF's bodies as MuJoCo has them [m]."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    configuration = assembly.mechanism.configuration(q)
    for index in range(model.njnt):
        name, at = model.joint(index).name or f"joint_{index}", model.jnt_qposadr[index]
        kind = model.jnt_type[index]
        if kind == mujoco.mjtJoint.mjJNT_FREE:
            start = SE3.from_quaternion(
                model.qpos0[at + 3 : at + 7][[1, 2, 3, 0]], model.qpos0[at : at + 3] * 1000
            )  # where the file has it
            placed = (start @ SE3.from_quaternion(configuration[name][3:], configuration[name][:3])).data
            data.qpos[at : at + 7] = [*(placed[:3] / 1000), placed[6], *placed[3:6]]
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


def difference(assembly: Assembly, q: FloatArray, theirs: Mapping[str, FloatArray]) -> float:
    """Return the largest difference of a pose matrix from theirs, over the links that both have."""
    matrices = assembly.poses(q).matrix.copy()
    matrices[:, :3, 3] /= 1000
    ours = dict(zip(assembly.parts, matrices, strict=True))
    common = ours.keys() & theirs.keys()
    assert len(common) >= min(len(theirs), 1)
    return max(float(np.abs(ours[name] - theirs[name]).max()) for name in common)


def assert_survives(first: Assembly, folder: Path, q: FloatArray) -> None:
    """Assert that an assembly comes back from URDF and from MJCF as it was, and that Pinocchio and MuJoCo take what was written."""
    import mujoco
    import pinocchio as pin

    pairs: tuple[tuple[Any, Any, Any], ...] = (
        (write_urdf, read_urdf, pin.buildModelFromUrdf),
        (write_mjcf, read_mjcf, mujoco.MjModel.from_xml_path),
    )
    for write, read_back, load in pairs:
        bundle = write(first)
        bundle.write(folder)
        again: Assembly = read_back(folder / bundle.main)

        assert load(str(folder / bundle.main)) is not None
        assert list(again.parts) == list(first.parts)
        assert again.joints == first.joints
        assert again.mechanism.couplings == first.mechanism.couplings
        for name, part in first.parts.items():
            assert (again.parts[name].mass is None) == (part.mass is None)
            if part.mass is not None:
                assert again.parts[name].mass.mass == part.mass.mass  # type: ignore[union-attr]
        for row in q:
            assert (again.poses(row).data == first.poses(row).data).all()
