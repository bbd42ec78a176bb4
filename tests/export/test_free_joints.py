"""Free joints: what nothing holds comes out of every format as free as it went in, where it was, with nothing invented."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.mjcf import write_mjcf
from articad.export.plan import plan_of
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.importers.mjcf import read_mjcf
from articad.importers.urdf import read_urdf
from articad.interference.relations import Relations
from articad.kinematics import declare
from articad.kinematics.joints import Joint, JointType
from articad.plan.resolve import resolve
from tests.assemblies import block, four_bar, frame, walker

pytestmark = pytest.mark.engines

SEEDS = range(6)


def random_frame(rng: np.random.Generator, reach: float = 300.0) -> SE3:
    q = rng.normal(size=4)
    return SE3.from_quaternion(q / np.linalg.norm(q), rng.uniform(-reach, reach, 3))


def mobile(seed: int) -> Assembly:
    """Bases that float over the ground, a post that stands on it, or a part that moves; each carries a chain of joints."""
    rng = np.random.default_rng(seed)

    def part(name: str) -> Any:
        ends = {key: random_frame(rng, 60.0) for key in ("root", "tip", "top")}
        return block(name, tuple(rng.uniform(10, 60, 3)), **ends)

    ground, post = part("ground"), part("post")
    parts, joints = [ground, post], [declare.fixed("stands", ground["tip"], post["root"], mate="opposed")]
    carriers = [ground["top"], post["tip"]]
    for at in range(int(rng.integers(1, 4))):
        base, leg, foot = (part(f"{name}_{at}") for name in ("base", "leg", "foot"))
        under = carriers[int(rng.integers(len(carriers)))]
        rest = random_frame(rng) if rng.random() < 0.7 else None
        joints += [
            declare.free(f"root_{at}", under, base["root"], rest=rest, mate=("aligned", "opposed")[int(rng.integers(2))]),
            declare.revolute(f"hip_{at}", base["tip"], leg["root"], limits=(-1.0, 2.0), rest=0.3),
            declare.ball(f"ankle_{at}", leg["tip"], foot["root"], cone=1.0),
        ]
        parts += [base, leg, foot]
        carriers.append(leg["top"])  # the next base may be free against what moves
    return Assembly.from_parts("mobile", parts=parts, joints=joints, ground="ground", T_ground=random_frame(rng))


def written(bundle: Bundle, folder: Path) -> Path:
    bundle.write(folder)
    return folder / bundle.main


def placed(assembly: Assembly) -> dict[tuple[str, str], np.ndarray]:
    """Where every connector stands at rest [m], by part and name."""
    rest = assembly.at()
    found = {}
    for name, part in assembly.parts.items():
        for connector in part.connectors.values():
            found[name, connector.name] = (rest[name] @ connector.frame).matrix
            found[name, connector.name][:3, 3] /= 1000
    return found


@pytest.mark.parametrize("seed", SEEDS)
def test_mujoco_has_free_bodies_of_the_world_where_they_rest(seed: int, tmp_path: Path) -> None:
    import mujoco

    assembly = mobile(seed)
    path = written(write_mjcf(assembly), tmp_path)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_kinematics(model, data)
    free = [joint.name for joint in assembly.joints if joint.type is JointType.FREE]
    assert {model.joint(i).name for i in range(model.njnt) if model.jnt_type[i] == mujoco.mjtJoint.mjJNT_FREE} == set(free)
    assert not any(model.dof_damping[model.joint(name).dofadr[0] + k] for name in free for k in range(6))
    for (part, connector), T in placed(assembly).items():
        site = data.site(f"{part}__{connector}")
        np.testing.assert_allclose(site.xpos, T[:3, 3], atol=1e-9)
        np.testing.assert_allclose(site.xmat.reshape(3, 3), T[:3, :3], atol=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_pinocchio_has_a_free_flyer_and_reads_the_same_values(seed: int, tmp_path: Path) -> None:
    import pinocchio as pin

    assembly = mobile(seed)
    model = pin.buildModelFromUrdf(str(written(write_urdf(assembly), tmp_path)))
    for joint in assembly.joints:
        if joint.type is JointType.FREE:
            assert model.joints[model.getJointId(joint.name)].shortname() == "JointModelFreeFlyer"
    # the base stands where its own coordinates put it, in the frame of the joint
    first = next(joint for joint in assembly.joints if joint.type is JointType.FREE)
    q = pin.neutral(model)
    at = model.joints[model.getJointId(first.name)].idx_q
    values = random_frame(np.random.default_rng(seed)).data
    q[at : at + 7] = [*(values[:3] / 1000), *values[3:]]
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    link = data.oMf[model.getFrameId(first.child)].homogeneous
    poses = assembly.at(**{first.name: values.tolist()})
    T = (poses[first.child] @ first.T_child_connector).matrix  # the link's frame is the joint's, turned over with an opposed mate
    T[:3, :3] = T[:3, :3] @ np.diag([1, -1, -1]) if first.mate == "opposed" else T[:3, :3]
    np.testing.assert_allclose(link[:3, 3], T[:3, 3] / 1000, atol=1e-9)
    np.testing.assert_allclose(link[:3, :3], T[:3, :3], atol=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_records_bring_free_joints_back_as_they_were(seed: int, tmp_path: Path) -> None:
    assembly = mobile(seed)
    for write, read in ((write_mjcf, read_mjcf), (write_urdf, read_urdf)):
        again = read(written(write(assembly), tmp_path / read.__name__))
        assert again.joints == assembly.joints


@pytest.mark.parametrize("seed", SEEDS)
def test_sdf_has_no_joint_that_holds_a_free_base_and_poses_it_at_rest(seed: int) -> None:
    assembly = mobile(seed)
    bundle = write_sdf(assembly)
    root = etree.fromstring(bundle.files[bundle.main])
    children = {joint.findtext("child") for joint in root.iter("joint")}
    ends = placed(assembly)
    for joint in assembly.joints:
        if joint.type is not JointType.FREE or joint.parent not in {"ground", "post"}:
            continue
        assert joint.child not in children
        (link,) = root.xpath(f"//link[@name='{joint.child}']")
        position = [float(word) for word in link.findtext("pose").split()[:3]]
        T_ground = assembly.mechanism.T_ground
        assert T_ground is not None
        np.testing.assert_allclose(position, ends[joint.child, joint.child_connector][:3, 3], atol=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_usd_makes_each_free_base_the_root_of_an_articulation_and_nests_none(seed: int, tmp_path: Path) -> None:
    pxr = pytest.importorskip("pxr")
    from pxr import Usd, UsdPhysics

    assert pxr
    assembly = mobile(seed)
    stage = Usd.Stage.Open(str(written(write_usd(assembly), tmp_path)))
    free = {joint.child for joint in assembly.joints if joint.type is JointType.FREE}
    roots = [prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.ArticulationRootAPI)]
    assert {prim.GetName() for prim in roots} == free | {"to_world"}
    for prim in roots:
        above = prim.GetParent()
        while above:
            assert not above.HasAPI(UsdPhysics.ArticulationRootAPI)
            above = above.GetParent()
    held = {str(target.name) for prim in stage.Traverse() for target in UsdPhysics.Joint(prim).GetBody1Rel().GetTargets()}
    assert not held & free


def original(seed: int) -> str:
    """An MJCF of bodies that fall and tumble: placed anyhow, off-centre masses, legs on damped hinges, with a key or without."""
    rng = np.random.default_rng(seed)
    bodies, qpos = [], []
    for at in range(int(rng.integers(1, 4))):
        numbers = [" ".join(f"{x:.12g}" for x in rng.normal(size=n)) for n in (3, 4, 3, 3, 3)]
        tag = (
            f'<freejoint name="root_{at}"/>' if rng.random() < 0.5 else f'<joint type="free" name="root_{at}" damping=".3" armature=".2"/>'
        )
        bodies.append(
            f'<frame pos="0 {at} 1"><body name="base_{at}" pos="{numbers[0]}" quat="{numbers[1]}">{tag}'
            f'<inertial pos="{numbers[2]}" mass="3" diaginertia=".2 .3 .4"/>'
            f'<body name="leg_{at}" pos="{numbers[3]}"><joint name="hip_{at}" axis="{numbers[4]}" damping=".1" range="-40 70"/>'
            f'<inertial pos=".1 .2 .1" mass=".5" diaginertia=".01 .02 .02"/></body></body></frame>'
        )
        pose = rng.normal(size=7)
        pose[3:] /= np.linalg.norm(pose[3:])
        qpos += [*pose, 0.2]
    key = f'<keyframe><key name="home" qpos="{" ".join(f"{x:.17g}" for x in qpos)}"/></keyframe>' if seed % 2 else ""
    return f'<mujoco model="drop"><option integrator="implicitfast"/><worldbody>{"".join(bodies)}</worldbody>{key}</mujoco>'


def fallen(path: Path, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return MuJoCo's qpos0, and qpos at the start and after 1 s, from random speeds."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    data.qvel[:] = np.random.default_rng(seed).normal(size=model.nv)
    start = data.qpos.copy()
    while data.time < 1.0 - 1e-9:
        mujoco.mj_step(model, data)
    return _upright(model, model.qpos0), _upright(model, start), _upright(model, data.qpos)


def _upright(model: Any, qpos: np.ndarray) -> np.ndarray:
    """Return qpos with the one of a quaternion's two signs that makes w positive."""
    found = qpos.copy()
    for at in model.jnt_qposadr[model.jnt_type == 0]:
        found[at + 3 : at + 7] *= math.copysign(1.0, found[at + 3])
    return found


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("own", [True, False])
def test_what_falls_for_a_second_falls_as_the_original(seed: int, own: bool, tmp_path: Path) -> None:
    first = tmp_path / "first.xml"
    first.write_text(original(seed))
    assembly = read_mjcf(first)
    assert [joint.type for joint in assembly.joints].count(JointType.FREE) == len(assembly.parts) // 2
    second = written(write_mjcf(assembly), tmp_path / "second")
    if not own:  # as others read it: without our records, once more in and out
        second = written(write_mjcf(read_mjcf(second, metadata=False)), tmp_path / "third")
    before, start, end = fallen(first, seed)
    after, start_again, end_again = fallen(second, seed)
    np.testing.assert_allclose(after, before, atol=1e-12)
    np.testing.assert_allclose(start_again, start, atol=1e-12)
    np.testing.assert_allclose(end_again, end, rtol=1e-6, atol=1e-6)
    assert np.abs(end - start).max() > 1.0


def test_a_urdf_that_floats_falls_as_the_original(tmp_path: Path) -> None:
    inertia = '<inertia ixx=".05" iyy=".04" izz=".03" ixy="0" ixz="0" iyz="0"/>'
    first = tmp_path / "first.urdf"
    first.write_text(
        '<robot name="f"><link name="world"/>'
        f'<link name="box"><inertial><origin xyz=".1 0 .2"/><mass value="8"/>{inertia}</inertial></link>'
        f'<link name="leg"><inertial><mass value="1"/>{inertia}</inertial></link>'
        '<joint name="root" type="floating"><parent link="world"/><child link="box"/><origin xyz="1 2 5" rpy=".3 .2 .1"/></joint>'
        '<joint name="hip" type="continuous"><parent link="box"/><child link="leg"/><origin xyz="0 0 -.2"/><axis xyz="0 1 0"/>'
        '<dynamics damping=".2"/></joint></robot>'
    )
    assembly = read_urdf(first)
    assert not assembly.kept
    before, start, end = fallen(first, 0)
    assert end[2] != pytest.approx(start[2])
    for write in (write_urdf, write_mjcf):
        after, start_again, end_again = fallen(written(write(assembly), tmp_path / write.__name__), 0)
        np.testing.assert_allclose(after, before, atol=1e-12)
        np.testing.assert_allclose(start_again, start, atol=1e-12)
        np.testing.assert_allclose(end_again, end, rtol=1e-6, atol=1e-6)


def test_a_free_base_is_held_at_rest_by_sweeps_and_certificates_which_say_so() -> None:
    assembly = walker()
    assert assembly.mechanism.mobility == 7
    assert assembly.mechanism.driving_joints == ("shoulder",)
    swept = assembly.check_motion(steps=20)
    assert [finding.code for finding in swept.findings.errors] == ["E_MOTION_COLLISION"]
    assert {name for check in swept.pairs for name in check.over} == {"shoulder"}
    free = replace_limits(assembly, "shoulder", (-0.2, 0.2))
    certificate = free.certify()
    assert certificate.ok
    assert certificate.asked == ("shoulder",)
    assert "free joints stay at rest throughout (root)" in certificate.to_json()["covers"]
    assert certificate.refutation() is None


def replace_limits(assembly: Assembly, name: str, limits: tuple[float, float]) -> Assembly:
    joints = [
        replace(joint, limits=replace(joint.limits, lower=limits[:1], upper=limits[1:])) if joint.name == name else joint
        for joint in assembly.joints
    ]
    return Assembly.from_parts(assembly.name, parts=list(assembly.parts.values()), joints=joints, ground=assembly.ground)


def test_a_free_joint_in_a_loop_is_not_certified() -> None:
    ground, a, b = (block(name, (20, 20, 20), tip=frame(at=(50, 0, 0)), root=frame()) for name in ("ground", "a", "b"))
    joints: list[Joint] = [
        declare.free("root", ground["tip"], a["root"]),
        declare.revolute("hinge", a["tip"], b["root"], limits=(-1.0, 1.0)),
        declare.ball("closes", b["tip"], replace_connector(ground), cone=math.pi),
    ]
    ground = replace(ground, connectors={**ground.connectors, "end": replace_connector(ground).connector})
    assembly = Assembly.from_parts("loop", parts=[ground, a, b], joints=joints, ground="ground")
    assert assembly.mechanism.loop_joints[0].name == "closes"
    certificate = assembly.certify(budget=5.0)
    assert not certificate.ok
    assert any("free joint root is part of a loop" in finding.message for finding in certificate.findings)


def replace_connector(ground: Any) -> Any:
    from articad.connectors.attachment import Attachment

    return Attachment("ground", Connector("end", SE3.trans(150.0, 0.0, 0.0)))


def test_a_four_bar_on_a_free_base_closes_wherever_the_base_is(tmp_path: Path) -> None:
    import mujoco

    fixed = four_bar()
    world = block("world_frame", (5, 5, 5), top=frame())
    joints = [declare.free("root", world["top"], fixed.parts["base"]["tip"], rest=SE3.rot_x(0.4) @ SE3.trans(10, 20, 900)), *fixed.joints]
    assembly = Assembly.from_parts("walker", parts=[world, *fixed.parts.values()], joints=joints, ground="world_frame")
    still = {name: fixed.at()["base"].inverse() @ T for name, T in fixed.at().items()}
    rng = np.random.default_rng(2)
    for _ in range(3):
        values = random_frame(rng).data
        poses = assembly.at(root=values.tolist())
        assert all((poses["base"].inverse() @ poses[name]).allclose(T, mm=1e-6, rad=1e-9) for name, T in still.items())
    assert assembly.mechanism.mobility == fixed.mechanism.mobility + 6
    model = mujoco.MjModel.from_xml_path(str(written(write_mjcf(assembly), tmp_path)))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos[: data.ne]).max() < 1e-9


def test_free_parts_fit_nothing_and_may_touch_what_they_meet(tmp_path: Path) -> None:
    assembly = walker()
    assert not Relations(assembly.joints).between("ground", "base")
    bundle = write_mjcf(assembly)
    excluded = [(one.get("body1"), one.get("body2")) for one in etree.fromstring(bundle.files[bundle.main]).iter("exclude")]
    assert ("ground", "base") not in excluded


def test_a_plan_holds_a_free_joint() -> None:
    plan, features = plan_of(walker())
    assert [getattr(joint, "type", "") for joint in plan.joints] == ["free", "revolute"]
    assert ("plan.rest", "joints.root") in {feature[:2] for feature in features}
    again = resolve(plan)
    assert again.mechanism.mobility == 7
    rest = again.mechanism.rest_poses()
    assert all(rest[name].allclose(T, mm=1e-6, rad=1e-9) for name, T in walker().at(root=JointType.FREE.neutral).items())
