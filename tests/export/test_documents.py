"""What the documents say beyond poses: ties, carriers, sites, servos, metadata; and that they are the same bytes twice."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.export import mjcf
from articad.export.bundle import Bundle
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import read_mesh
from articad.geometry.part import Part, Shape
from articad.geometry.shapes import box
from articad.kinematics import declare
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.mechanism import Mechanism
from tests.assemblies import all_joint_kinds, block, frame, geared_pair

GOLDEN = Path(__file__).parent / "golden"


def root_of(bundle: Bundle) -> Any:
    return etree.fromstring(bundle.files[bundle.main])


def test_a_cylindrical_joint_is_a_slide_a_carrier_and_a_hinge() -> None:
    root = root_of(write_urdf(all_joint_kinds()))
    slide, turn = root.find("joint[@name='rod__t']"), root.find("joint[@name='rod__r']")

    assert [slide.get("type"), turn.get("type")] == ["prismatic", "continuous"]
    assert [slide.find("child").get("link"), turn.find("parent").get("link")] == ["rod__d1", "rod__d1"]
    assert turn.find("origin").get("xyz") == "0 0 0"


def test_a_joint_that_is_crossed_backwards_is_a_chain_backwards_about_turned_axes() -> None:
    root = root_of(write_urdf(all_joint_kinds()))
    chain = [joint.get("name") for joint in root.iterfind("joint") if joint.get("name").startswith(("ring__", "knob__"))]

    assert chain == ["ring__r", "ring__t", "knob__rz", "knob__ry", "knob__rx"]
    assert root.find("joint[@name='knob__ry']/axis").get("xyz") == "0 -1 0"


def test_a_screw_slide_mimics_its_turn() -> None:
    mimic = root_of(write_urdf(all_joint_kinds())).find("joint[@name='nut__t']/mimic")

    assert mimic.get("joint") == "nut__r"
    assert float(mimic.get("multiplier")) == pytest.approx(-0.003 / (2 * np.pi))


def test_couplings_become_mimics_of_the_first_driver_in_metres() -> None:
    root = root_of(write_urdf(geared_pair()))
    mimics = {mimic.getparent().get("name"): dict(mimic.attrib) for mimic in root.iterfind("joint/mimic")}

    assert mimics == {
        "b": {"joint": "a", "multiplier": "-0.5", "offset": "0"},
        "s": {"joint": "a", "multiplier": "-0.01", "offset": "0.001"},
    }


def test_couplings_become_equalities_of_joints() -> None:
    root = root_of(write_mjcf(geared_pair()))
    ties = [(tie.get("joint1"), tie.get("joint2"), tie.get("polycoef")) for tie in root.iterfind("equality/joint")]

    assert ties == [("b", "a", "0 -0.5 0 0 0"), ("s", "b", "0.001 0.02 0 0 0")]


def test_coupled_motion_is_coupled_in_mujoco(tmp_path: Path) -> None:
    import mujoco

    bundle = write_mjcf(geared_pair(), actuators="position")
    bundle.write(tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / bundle.main))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    data.ctrl[:] = -0.8
    for _ in range(2000):
        mujoco.mj_step(model, data)
    a, b, s = data.qpos

    assert a == pytest.approx(-0.8, abs=1e-2)
    assert b == pytest.approx(-0.5 * a, abs=1e-3)
    assert s == pytest.approx(0.02 * b + 0.001, abs=1e-4)


def test_every_driver_but_a_ball_gets_a_servo_of_its_effort() -> None:
    root = root_of(write_mjcf(all_joint_kinds(), actuators="position"))
    servos = {servo.get("joint"): servo for servo in root.iterfind("actuator/position")}
    key = root.find("keyframe/key")

    assert {"hinge", "rod__t", "rod__r", "nut__r", "cross__rx"} <= servos.keys()
    assert not {"nut__t", "head", "knob"} & servos.keys()
    assert len(key.get("ctrl").split()) == len(servos)
    assert servos["hinge"].get("ctrlrange") == "-1 2"
    assert servos["wheel"].get("ctrlrange") is None
    assert servos["hinge"].get("forcerange") == root.find(".//joint[@name='hinge']").get("actuatorfrcrange")


def test_a_driven_joint_gets_a_rotor_of_a_hundredth_of_what_it_moves() -> None:
    root = root_of(write_mjcf(geared_pair(), actuators="position"))
    wheel = geared_pair().parts["wheel_a"].mass
    assert wheel is not None
    joint, follower = (root.find(f".//joint[@name='{name}']") for name in "ab")

    assert float(joint.get("armature")) == pytest.approx(0.01 * wheel.inertia[2, 2] / 1e6, rel=0.2)
    assert follower.get("armature") is None
    assert root_of(write_mjcf(geared_pair())).find(".//joint[@armature]") is None


def test_sites_stand_where_connectors_are() -> None:
    assembly = all_joint_kinds()
    root = root_of(write_mjcf(assembly))
    body = root.find(".//body[@name='hinge']")

    assert {site.get("name") for site in body.iterfind("site")} == {"hinge__root", "hinge__tip"}
    # the joint's frame is the body's, and the child's connector lies in it
    assert np.abs([float(x) for x in body.find("site[@name='hinge__root']").get("pos").split()]).max() < 1e-15


def test_parts_that_share_a_joint_do_not_collide() -> None:
    root = root_of(write_mjcf(all_joint_kinds()))
    pairs = [(pair.get("body1"), pair.get("body2")) for pair in root.iterfind("contact/exclude")]

    assert ("base", "fixed") in pairs
    assert ("arm", "hand") in pairs
    assert len(pairs) == len(set(pairs))


def test_an_assembly_of_one_part_is_one_link() -> None:
    single = Assembly.from_parts("single", parts=[block("only")], joints=[], ground="only")

    assert [link.get("name") for link in root_of(write_urdf(single)).iterfind("link")] == ["only"]
    root = root_of(write_mjcf(single, actuators="position"))
    assert [root.find(tag) for tag in ("contact", "equality", "keyframe", "actuator")] == [None] * 4


def test_a_part_without_anything_is_a_frame(tmp_path: Path) -> None:
    import mujoco

    bundle = write_mjcf(Assembly.from_parts("empty", parts=[Part.without_geometry("only")], joints=[], ground="only"))
    bundle.write(tmp_path)

    assert mujoco.MjModel.from_xml_path(str(tmp_path / bundle.main)).nbody == 2


def test_shapes_keep_their_colours_frames_and_files() -> None:
    mesh, other = box(1, 2, 3), box(4, 5, 6)
    part = replace(
        block("base", a=frame()),
        visuals=(Shape(mesh, SE3.trans(10, 0, 0), "#ff0000"), Shape(mesh), Shape(other, color="#0000ff")),
        collisions=(Shape(other),),
    )
    bundle = write_urdf(Assembly.from_parts("shapes", parts=[part], joints=[], ground="base"), meshes="obj")
    root = root_of(bundle)

    assert [visual.find("geometry/mesh").get("filename") for visual in root.iterfind("link/visual")] == [
        "meshes/base.obj",
        "meshes/base.obj",
        "meshes/base_2.obj",
    ]
    assert root.find("link/visual/origin").get("xyz") == "0.01 0 0"
    assert [material.get("name") for material in root.iterfind("material")] == ["color_ff0000", "color_8a9299", "color_0000ff"]
    assert len(root.findall("link/collision")) == 1


def test_obj_files_hold_the_mesh(tmp_path: Path) -> None:
    bundle = write_mjcf(all_joint_kinds(), meshes="obj")
    bundle.write(tmp_path)

    assert (read_mesh(tmp_path / "meshes" / "base.obj").vertices == box(100, 100, 10).welded().vertices).all()


def test_meshes_beyond_what_mujoco_takes_as_stl_are_written_as_obj(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mjcf, "STL_TRIANGLES", 11)

    assert {Path(path).suffix for path in write_mjcf(all_joint_kinds()).files} == {".xml", ".obj"}


def test_an_open_mesh_is_drawn_without_being_measured(tmp_path: Path) -> None:
    import mujoco

    solid = box(10, 10, 10)
    cut = TriMesh(solid.vertices, solid.triangles[:-1])
    part = Part.from_mesh("sheet", cut)
    bundle = write_mjcf(Assembly.from_parts("open", parts=[part], joints=[], ground="sheet"))
    bundle.write(tmp_path)

    assert b'inertia="shell"' in bundle.files[bundle.main]
    assert mujoco.MjModel.from_xml_path(str(tmp_path / bundle.main)).nmesh == 1


@pytest.mark.parametrize("write", [write_urdf, write_mjcf])
def test_metadata_holds_the_mechanism_bit_for_bit(write: Any) -> None:
    assembly = all_joint_kinds()
    root = root_of(write(assembly))
    texts = [element.text for element in root.iterfind("articad")] + [text.get("data") for text in root.iterfind("custom/text")]
    records = [json.loads(text) for text in texts]
    joints = {record["name"]: record for record in records if record["kind"] == "joint"}

    assert [record["name"] for record in records if record["kind"] == "part"] == list(assembly.mechanism.parts)
    assert list(joints) == [joint.name for joint in assembly.joints]
    for joint in assembly.joints:
        record = joints[joint.name]
        assert record["parent_frame"] == joint.T_parent_connector.data.tolist()
        assert tuple(record["rest"]) == joint.rest
        assert (record["mate"], record["type"], record["lead"]) == (joint.mate, joint.type, joint.lead)
    assert joints["wheel"]["lower"] == [None]


def lidded_box() -> Assembly:
    base, lid = (
        block("base", (80, 60, 40), hinge=frame(at=(0, 30, 20), z=(1, 0, 0), x=(0, 1, 0))),
        block("lid", (80, 60, 4), hinge=frame(at=(0, 30, -2), z=(1, 0, 0), x=(0, 1, 0))),
    )
    knob = block("knob", (8, 8, 12), foot=frame(at=(0, 0, -6), z=(0, 0, -1), x=(1, 0, 0)))
    lid = replace(lid, connectors={**lid.connectors, "top": replace(lid.connectors["hinge"], name="top", frame=frame(at=(0, -25, 2)))})
    joints: list[Joint] = [
        declare.revolute("hinge", base["hinge"], lid["hinge"], limits=(-1.75, 0.0), rest=-0.25),
        declare.cylindrical("pull", lid["top"], knob["foot"], travel=(0.0, 5.0), angle="endless", mate="opposed"),
    ]
    return Assembly.from_parts("lidded_box", parts=[base, lid, knob], joints=joints, ground="base")


GOLDENS: dict[str, Callable[[], Assembly]] = {"geared": geared_pair, "lidded_box": lidded_box}


@pytest.mark.parametrize("name", GOLDENS)
def test_the_bytes_are_those_of_the_golden_bundle(name: str) -> None:
    """Refresh with `UPDATE_GOLDENS=1`, and read the difference before it is committed."""
    assembly = GOLDENS[name]()
    files = {**write_urdf(assembly).files, **write_mjcf(assembly, actuators="position").files}
    if os.environ.get("UPDATE_GOLDENS"):
        Bundle(files).write(GOLDEN / name)

    assert {path: content for path, content in files.items() if (GOLDEN / name / path).read_bytes() != content} == {}


_DIGEST = """
import hashlib, sys
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from tests.assemblies import all_joint_kinds, random_tree
total = hashlib.sha256()
for assembly in (all_joint_kinds(), random_tree(7, 9)):
    for bundle in (write_urdf(assembly), write_mjcf(assembly, actuators="position")):
        for path, content in bundle.files.items():
            total.update(path.encode() + content)
print(total.hexdigest())
"""


def test_the_bytes_do_not_depend_on_the_hash_seed() -> None:
    digests = {
        subprocess.run(
            [sys.executable, "-c", _DIGEST],
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join([".", *sys.path])},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }

    assert len(digests) == 1


def test_a_mimic_never_follows_a_follower() -> None:
    """Couplings are chained c <- b <- a with the last one as the only driver."""
    geared = geared_pair()
    chained = Mechanism(
        geared.mechanism.parts,
        "base",
        [replace(joint, driver=joint.name == "s") for joint in geared.joints],
        [Coupling("mesh", "gear", "a", "b", -0.5), Coupling("pinion", "rack", "b", "s", 20.0, 1.0)],
    )
    root = root_of(write_urdf(replace(geared, mechanism=chained)))
    leaders = {mimic.get("joint") for mimic in root.iterfind("joint/mimic")}
    followers = {mimic.getparent().get("name") for mimic in root.iterfind("joint/mimic")}

    assert len(followers) == 2
    assert not leaders & followers
