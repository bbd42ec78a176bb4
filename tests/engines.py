"""Engines that are not ours, as oracles of exports: poses of parts at given joint values, read from files on disk.

Where a part is in its link is read from the file as well: meshes are written in the part's frame, so the origin of the
first visual is it. Poses are matrices in m.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.kinematics.joints import JointType

FloatArray = NDArray[np.float64]

SUFFIXES = {
    JointType.FIXED: (),
    JointType.REVOLUTE: ("",),
    JointType.SLIDER: ("",),
    JointType.CYLINDRICAL: ("__t", "__r"),
    JointType.PLANAR: ("__x", "__y", "__r"),
    JointType.UNIVERSAL: ("__rx", "__ry"),
}


def joint_values(assembly: Assembly, q: FloatArray) -> dict[str, float]:
    """Values [rad, m] of a chain of one-freedom joints, by name, for a configuration `(nq,)` of the drivers; none of free joints."""
    configuration = assembly.mechanism.configuration(q)
    values: dict[str, float] = {}
    for joint in assembly.joints:
        own = configuration[joint.name]
        if joint.type is JointType.BALL:
            angles = Rotation.from_quat(own).as_euler("XYZ")
            values |= {f"{joint.name}__r{axis}": float(angle) for axis, angle in zip("xyz", angles, strict=True)}
        elif joint.type is JointType.SCREW:
            values |= {f"{joint.name}__t": joint.lead * own[0] / (2 * math.pi) / 1000, f"{joint.name}__r": own[0]}
        elif joint.type is not JointType.FREE:
            for suffix, unit, value in zip(SUFFIXES[joint.type], joint.type.units, own, strict=True):
                values[joint.name + suffix] = value / 1000 if unit == "mm" else value
    return values


def ball_values(assembly: Assembly, q: FloatArray) -> dict[str, FloatArray]:
    """Rotations `(3, 3)` of the balls, by joint name, as the tree crosses them."""
    configuration = assembly.mechanism.configuration(q)
    backwards = {edge.joint.name: edge.reversed for edge in assembly.mechanism.tree.edges}
    rotations = {}
    for joint in assembly.joints:
        if joint.type is JointType.BALL:
            R = Rotation.from_quat(configuration[joint.name]).as_matrix()
            rotations[joint.name] = R.T if backwards.get(joint.name) else R
    return rotations


def free_values(assembly: Assembly, q: FloatArray) -> dict[str, FloatArray]:
    """Displacements `(4, 4)` [m] of the free joints from their frames, by joint name."""
    configuration = assembly.mechanism.configuration(q)
    values = {joint.name: configuration[joint.name] for joint in assembly.joints if joint.type is JointType.FREE}
    return {name: _matrix(np.asarray(own[:3]) / 1000, Rotation.from_quat(own[3:])) for name, own in values.items()}


class PinocchioUrdf:
    """A URDF as Pinocchio reads it."""

    def __init__(self, path: Path) -> None:
        import pinocchio as pin

        self.pin = pin
        self.model = pin.buildModelFromUrdf(str(path))
        self.data = self.model.createData()
        self.origins = _urdf_origins(path)

    def poses(self, values: Mapping[str, float], free: Mapping[str, FloatArray] | None = None) -> dict[str, FloatArray]:
        q = self.pin.neutral(self.model)
        for name, T in (free or {}).items():
            joint = self.model.joints[self.model.getJointId(name)]
            assert joint.shortname() == "JointModelFreeFlyer"
            q[joint.idx_q : joint.idx_q + 7] = [*T[:3, 3], *Rotation.from_matrix(T[:3, :3]).as_quat()]
        for name, value in values.items():
            if not self.model.existJointName(name):  # it closes a loop, which a URDF cannot hold
                continue
            joint = self.model.joints[self.model.getJointId(name)]
            q[joint.idx_q : joint.idx_q + joint.nq] = [math.cos(value), math.sin(value)] if joint.nq == 2 else [value]
        self.pin.framesForwardKinematics(self.model, self.data, q)
        return {
            link: self.data.oMf[self.model.getFrameId(link, self.pin.FrameType.BODY)].homogeneous @ origin
            for link, origin in self.origins.items()
        }


class YourdfpyUrdf:
    """A URDF as yourdfpy reads it."""

    def __init__(self, path: Path) -> None:
        import yourdfpy

        self.robot = yourdfpy.URDF.load(str(path), mesh_dir=str(path.parent), build_scene_graph=True, load_meshes=True)
        self.origins = _urdf_origins(path)

    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        self.robot.update_cfg({name: value for name, value in values.items() if name in self.robot.actuated_joint_names})
        return {link: self.robot.get_transform(link) @ origin for link, origin in self.origins.items()}


class MujocoMjcf:
    """An MJCF or URDF as MuJoCo reads it."""

    def __init__(self, path: Path) -> None:
        import mujoco

        self.mujoco = mujoco
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        self.origins = _urdf_origins(path) if path.suffix == ".urdf" else _mjcf_origins(path)

    def poses(
        self, values: Mapping[str, float], balls: Mapping[str, FloatArray] | None = None, free: Mapping[str, FloatArray] | None = None
    ) -> dict[str, FloatArray]:
        """Poses at values of joints, rotations of balls, and poses `(4, 4)` [m] in the world of the bodies of free joints."""
        mujoco = self.mujoco
        self.data.qpos[:] = self.model.qpos0
        for index in range(self.model.njnt):
            name = self.model.joint(index).name
            at = self.model.jnt_qposadr[index]
            if self.model.jnt_type[index] == mujoco.mjtJoint.mjJNT_BALL:
                assert balls is not None
                x, y, z, w = Rotation.from_matrix(balls[name]).as_quat()
                self.data.qpos[at : at + 4] = w, x, y, z
            elif self.model.jnt_type[index] == mujoco.mjtJoint.mjJNT_FREE:
                assert free is not None
                x, y, z, w = Rotation.from_matrix(free[name][:3, :3]).as_quat()
                self.data.qpos[at : at + 7] = *free[name][:3, 3], w, x, y, z
            else:
                self.data.qpos[at] = values[name]
        mujoco.mj_kinematics(self.model, self.data)
        return {name: self._pose(name) @ origin for name, origin in self.origins.items()}

    def free_frames(self) -> dict[str, FloatArray]:
        """Poses of the bodies of free joints [m] as the model places them, by joint name."""
        frames = {}
        for index in np.flatnonzero(self.model.jnt_type == self.mujoco.mjtJoint.mjJNT_FREE):
            body = self.model.jnt_bodyid[index]
            w, x, y, z = self.model.body_quat[body]
            frames[self.model.joint(index).name] = _matrix(self.model.body_pos[body], Rotation.from_quat([x, y, z, w]))
        return frames

    def home(self) -> dict[str, FloatArray]:
        """Poses at the key `home`."""
        self.mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key("home").id)
        self.mujoco.mj_kinematics(self.model, self.data)
        return {name: self._pose(name) @ origin for name, origin in self.origins.items()}

    def _pose(self, body: str) -> FloatArray:
        T = np.eye(4)
        index = self.mujoco.mj_name2id(self.model, self.mujoco.mjtObj.mjOBJ_BODY, body)
        if index >= 0:  # MuJoCo's URDF reader makes the root link the world
            T[:3, :3] = self.data.xmat[index].reshape(3, 3)
            T[:3, 3] = self.data.xpos[index]
        return T


def bullet_poses(path: Path, values: Mapping[str, float]) -> dict[str, FloatArray]:
    """Poses of a URDF as PyBullet reads it."""
    pybullet = pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
    client = pybullet.connect(pybullet.DIRECT)
    try:
        body = pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client)
        origins = _urdf_origins(path)
        found = {}
        links = {}
        for index in range(pybullet.getNumJoints(body, physicsClientId=client)):
            joint = pybullet.getJointInfo(body, index, physicsClientId=client)
            links[joint[12].decode()] = index
            if joint[1].decode() in values:
                pybullet.resetJointState(body, index, values[joint[1].decode()], physicsClientId=client)
        for link, index in links.items():
            if link in origins:
                state = pybullet.getLinkState(body, index, computeForwardKinematics=True, physicsClientId=client)
                found[link] = _matrix(state[4], Rotation.from_quat(state[5])) @ origins[link]
        return found
    finally:
        pybullet.disconnect(client)


def our_poses(assembly: Assembly, q: FloatArray) -> dict[str, FloatArray]:
    """Poses of the parts as articad has them, as matrices in m."""
    matrices = assembly.poses(q).matrix.copy()
    matrices[..., :3, 3] /= 1000
    return dict(zip(assembly.parts, matrices, strict=True))


def largest_difference(ours: Mapping[str, FloatArray], theirs: Mapping[str, FloatArray]) -> float:
    """Largest difference of an entry of the pose matrices [m, 1] between the parts that both have."""
    assert theirs
    return max(float(np.abs(ours[name] - theirs[name]).max()) for name in theirs)


def disagreement(assembly: Assembly, folder: Path, configurations: FloatArray) -> float:
    """Export, read back with Pinocchio and MuJoCo, and return the largest difference of a pose matrix at any configuration or at home."""
    urdf, mjcf = write_urdf(assembly), write_mjcf(assembly)
    urdf.write(folder)
    mjcf.write(folder)
    pinocchio, mujoco = PinocchioUrdf(folder / urdf.main), MujocoMjcf(folder / mjcf.main)
    worst = largest_difference(our_poses(assembly, assembly.mechanism.rest), mujoco.home())
    for q in configurations:
        ours, values = our_poses(assembly, q), joint_values(assembly, q)
        worst = max(worst, largest_difference(ours, pinocchio.poses(values)))
        worst = max(worst, largest_difference(ours, mujoco.poses(values, ball_values(assembly, q))))
    return worst


def _urdf_origins(path: Path) -> dict[str, FloatArray]:
    origins = {}
    for link in etree.parse(str(path)).getroot().iterfind("link"):
        origin = link.find("visual/origin")
        if origin is not None:
            rotation = Rotation.from_euler("xyz", _floats(origin, "rpy"))
            origins[link.get("name")] = _matrix(_floats(origin, "xyz"), rotation)
    return origins


def _mjcf_origins(path: Path) -> dict[str, FloatArray]:
    origins = {}
    for body in etree.parse(str(path)).getroot().iterfind("worldbody//body"):
        geom = body.find("geom[@class='visual']")
        if geom is not None:
            w, x, y, z = _floats(geom, "quat")
            origins[body.get("name")] = _matrix(_floats(geom, "pos"), Rotation.from_quat([x, y, z, w]))
    return origins


def _floats(element: Any, attribute: str) -> list[float]:
    return [float(word) for word in element.get(attribute).split()]


def _matrix(xyz: Any, rotation: Rotation) -> FloatArray:
    T = np.eye(4)
    T[:3, :3] = rotation.as_matrix()
    T[:3, 3] = xyz
    return T
