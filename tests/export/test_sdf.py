"""SDFormat: read by Drake's libsdformat where it is installed, by PyBullet, and by hand."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from articad.assembly import Assembly
from articad.export.sdf import write_sdf
from articad.kinematics import declare
from articad.kinematics.joints import JointType
from tests.assemblies import all_joint_kinds, block, closed, four_bar, frame, geared_pair, random_configurations
from tests.engines import joint_values, our_poses

FloatArray = NDArray[np.float64]

pytestmark = pytest.mark.engines


def model_of(assembly: Assembly) -> Any:
    bundle = write_sdf(assembly)
    return etree.fromstring(bundle.files[bundle.main]).find("model")


def matrix(text: str) -> FloatArray:
    numbers = [float(word) for word in text.split()]
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_euler("xyz", numbers[3:]).as_matrix(), numbers[:3]
    return T


def placed(model: Any) -> dict[str, FloatArray]:
    """Poses of the parts' meshes as the file poses the model."""
    return {
        link.get("name"): matrix(link.find("pose").text) @ matrix(link.find("visual/pose").text)
        for link in model.iterfind("link")
        if link.find("visual") is not None
    }


def test_a_tree_is_posed_where_all_values_are_zero() -> None:
    assembly = all_joint_kinds()
    zero = np.array([float(driver.name.endswith("qw")) for driver in assembly.drivers])

    for name, T in placed(model_of(assembly)).items():
        assert np.allclose(T, our_poses(assembly, zero)[name], atol=1e-12)


@pytest.mark.parametrize(
    "assembly",
    [
        four_bar((-3.0, 3.0)),
        closed(lambda a, b: declare.ball("d", a, b, cone=1.0)),
        closed(lambda a, b: declare.planar("d", a, b, x=(-9, 9), y=(-9, 9), angle="endless")),
    ],
    ids=["four-bar", "ball", "planar"],
)
def test_a_model_with_loops_is_posed_at_rest_and_its_closing_joints_meet(assembly: Assembly) -> None:
    model = model_of(assembly)
    rest = our_poses(assembly, assembly.mechanism.rest)
    for name, T in placed(model).items():
        assert np.allclose(T, rest[name], atol=1e-12)
    (closing,) = assembly.mechanism.loop_joints
    written = model.find(f"joint[@name='{closing.name}']")
    if closing.type is JointType.PLANAR:
        assert written is None
        return
    link = model.find(f"link[@name='{written.find('child').text}']")
    at = (matrix(link.find("pose").text) @ matrix(written.find("pose").text))[:3, 3]
    near = rest[closing.parent] @ np.append(closing.T_parent_connector.translation / 1000, 1.0)
    assert np.allclose(at, near[:3], atol=1e-12)


def test_limits_of_a_model_with_loops_are_measured_from_rest() -> None:
    model = model_of(closed(lambda a, b: declare.ball("d", a, b, cone=1.0)))
    limit = model.find("joint[@name='slide_1']/axis/limit")

    assert [float(limit.find(name).text) for name in ("lower", "upper")] == pytest.approx([-0.055, 0.045])


def test_what_is_lost_is_told() -> None:
    planar = closed(lambda a, b: declare.planar("d", a, b, x=(-9, 9), y=(-9, 9), angle="endless"))

    assert {loss.where for loss in write_sdf(all_joint_kinds()).losses} == {"joints.head", "joints.knob"}
    assert [loss.where for loss in write_sdf(planar).losses if loss.refused] == ["joints.d"]
    assert "joints" in {loss.where for loss in write_sdf(four_bar()).losses}


def test_joints_that_bear_a_links_name_give_way_and_mimics_follow() -> None:
    model = model_of(all_joint_kinds())
    names = [element.get("name") for element in model if element.get("name")]

    assert len(names) == len(set(names))
    mimic = model_of(geared_pair()).find("joint[@name='s']/axis/mimic")
    assert mimic.get("joint") == "a"
    assert float(mimic.find("multiplier").text) == -0.01


def test_records_are_kept() -> None:
    model = model_of(all_joint_kinds())
    kinds = [json.loads(record.text)["kind"] for record in model.iter("{*}record")]

    assert kinds.count("joint") == len(all_joint_kinds().joints)


def test_pybullet_moves_the_joints_alike(tmp_path: Path) -> None:
    import pybullet

    base, arm, slide = (
        block("base", a=frame(at=(5, 6, 7), z=(0, 1, 0))),
        block("arm", r=frame(), t=frame(at=(30, 0, 9), z=(1, 0, 0))),
        block("tray", r=frame()),
    )
    joints = [
        declare.revolute("hinge", base["a"], arm["r"], limits=(-2, 2), mate="opposed"),
        declare.slider("slide", slide["r"], arm["t"], limits=(0, 80)),
    ]
    assembly = Assembly.from_parts("simple", parts=[base, arm, slide], joints=joints, ground="base")
    bundle = write_sdf(assembly)
    bundle.write(tmp_path)
    root = etree.fromstring(bundle.files[bundle.main])
    root[0].remove(root.find("model/joint[@name='to_world']"))  # PyBullet knows no joints to the world
    (tmp_path / bundle.main).write_bytes(etree.tostring(root))
    q = np.array([0.7, 33.0])
    client = pybullet.connect(pybullet.DIRECT)
    try:
        (body,) = pybullet.loadSDF(str(tmp_path / bundle.main))
        links = {}
        for index in range(pybullet.getNumJoints(body)):
            joint = pybullet.getJointInfo(body, index)
            links[joint[12].decode()] = index
            if joint[1].decode() in joint_values(assembly, q):
                pybullet.resetJointState(body, index, joint_values(assembly, q)[joint[1].decode()])
        origins = {link.get("name"): matrix(link.find("visual/pose").text) for link in model_of(assembly).iterfind("link")}
        for name in ("arm", "tray"):
            state = pybullet.getLinkState(body, links[name], computeForwardKinematics=True)
            T = np.eye(4)
            T[:3, :3], T[:3, 3] = Rotation.from_quat(state[5]).as_matrix(), state[4]
            assert np.allclose(T @ origins[name], our_poses(assembly, q)[name], atol=1e-5)
    finally:
        pybullet.disconnect(client)


def test_drake_moves_all_joint_kinds_alike(tmp_path: Path) -> None:
    drake_math: Any = pytest.importorskip("pydrake.math", reason="Drake is a nightly engine")
    parsing: Any = pytest.importorskip("pydrake.multibody.parsing")
    plants: Any = pytest.importorskip("pydrake.multibody.plant")
    assembly = all_joint_kinds()
    bundle = write_sdf(assembly)
    bundle.write(tmp_path)
    plant = plants.MultibodyPlant(0.0)
    parsing.Parser(plant).AddModels(str(tmp_path / bundle.main))
    plant.Finalize()
    context = plant.CreateDefaultContext()
    origins = {
        link.get("name"): matrix(link.find("visual/pose").text)
        for link in model_of(assembly).iterfind("link")
        if link.find("visual") is not None
    }
    for q in random_configurations(assembly, 0, 5):
        values, configuration = joint_values(assembly, q), assembly.mechanism.configuration(q)
        positions = plant.GetPositions(context)
        for index in plant.GetJointIndices():
            joint = plant.get_joint(index)
            name, at = joint.name().removesuffix("_joint"), joint.position_start()
            if joint.type_name() == "ball_rpy":
                x, y, z, w = configuration[name]
                sign = -1 if name == "knob" else 1  # crossed backwards
                R = Rotation.from_quat([sign * x, sign * y, sign * z, w]).as_matrix()
                positions[at : at + 3] = drake_math.RollPitchYaw(R).vector()
            elif joint.type_name() == "universal":
                positions[at : at + 2] = configuration[name]
            elif joint.num_positions() == 1:
                positions[at] = configuration[name][0] if joint.type_name() == "screw" else values[name]
        plant.SetPositions(context, positions)
        for name, origin in origins.items():
            T = plant.GetBodyByName(name).EvalPoseInWorld(context).GetAsMatrix4() @ origin
            assert np.allclose(T, our_poses(assembly, q)[name], atol=1e-9)
