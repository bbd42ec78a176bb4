"""What a file says beyond frames is read, kept, or a row of the losses; engines read the original and the copy."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from lxml import etree

from articad import cli
from articad.errors import ReadError
from articad.export.bundle import Bundle
from articad.formats import NAMED
from articad.geometry.shapes import capsule
from articad.importers.mjcf import read_mjcf
from articad.importers.mjcf_kept import READ as READ_MJCF
from articad.importers.urdf import read_urdf
from articad.importers.urdf_kept import READ as READ_URDF
from tests.assemblies import geared_pair

pytestmark = pytest.mark.engines

EVERYTHING = """<robot name="probe" version="1.2">
<material name="glass"><color rgba="0.2 0.4 0.8 0.3"/></material><material name="tex"><texture filename="wood.png"/></material>
<link name="base"><visual><geometry><box size="0.2 0.2 0.02"/></geometry><material name="glass"/></visual>
 <collision><geometry><box size="0.2 0.2 0.02"/></geometry></collision></link>
<link name="arm"><inertial><origin xyz="0.01 0.02 0.2" rpy="0.3 -0.2 0.7"/><mass value="1.5"/>
 <inertia ixx="0.02" ixy="0.002" ixz="-0.003" iyy="0.03" iyz="0.001" izz="0.015"/></inertial>
 <visual><origin xyz="0 0 0.2" rpy="0.1 0.2 0.3"/><geometry><cylinder radius="0.02" length="0.4"/></geometry><material name="tex"/></visual>
 <collision><origin xyz="0 0 0.2" quat_xyzw="0.5 0.5 0.5 0.5"/><geometry><capsule radius="0.02" length="0.4"/></geometry></collision></link>
<link name="tool"><inertial><mass value="0.2"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial>
 <collision><geometry><sphere radius="0.03"/></geometry></collision></link>
<link name="tcp"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0.05 0 0.01" quat_xyzw="0.1 0.2 0.3 0.9"/>
 <axis xyz="1 2 2"/><limit lower="-1.2" upper="0.7" effort="33" velocity="2.5" acceleration="10" deceleration="8" jerk="100"/>
 <dynamics damping="0.7" friction="0.25"/>
 <safety_controller soft_lower_limit="-1" soft_upper_limit="0.5" k_position="10" k_velocity="5"/><calibration rising="0.1"/></joint>
<joint name="lift" type="prismatic"><parent link="arm"/><child link="tool"/><origin xyz="0 0 0.4" rpy="0 1.5707963 0"/><axis xyz="0 -1 0"/>
 <limit lower="-0.05" upper="0.1" effort="0" velocity="0"/><mimic joint="shoulder" multiplier="0.05" offset="0.01"/></joint>
<joint name="tip" type="fixed"><parent link="tool"/><child link="tcp"/><origin xyz="0 0 0.05" rpy="0 0 1"/></joint>
<transmission name="t1"><type>transmission_interface/SimpleTransmission</type><joint name="shoulder"/></transmission>
<gazebo reference="arm"><mu1>0.9</mu1><mu2>0.8</mu2></gazebo>
<ros2_control name="sys" type="system"><hardware><plugin>mock</plugin></hardware></ros2_control>
</robot>"""


def converted(text: str, target: str, folder: Path, *, suffix: str = ".urdf", **options: Any) -> tuple[Path, Path, Bundle]:
    """Write a text, read it, and write it in another format; return both files."""
    source = folder / f"source{suffix}"
    source.write_text(text)
    bundle = NAMED[target].write((read_urdf if suffix == ".urdf" else read_mjcf)(source, **options))
    bundle.write(folder / "out")
    return source, folder / "out" / bundle.main, bundle


def in_pinocchio(path: Path) -> dict[str, Any]:
    """Return frames, joints and shapes as Pinocchio reads them."""
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    pin.updateFramePlacements(model, data)
    shapes = pin.buildGeomFromUrdf(model, str(path), pin.GeometryType.COLLISION, package_dirs=[str(path.parent)])
    frames = {frame.name: data.oMf[index].homogeneous for index, frame in enumerate(model.frames)}
    numbers = {name: np.array(getattr(model, name)) for name in LIMITS}
    return {
        "frames": frames,
        "numbers": numbers | {"damping": np.array(model.damping), "friction": np.array(model.friction)},
        "inertias": {name: model.inertias[index].toDynamicParameters() for index, name in enumerate(model.names)},
        "shapes": {
            shape.name: (type(shape.geometry).__name__, shape.placement.homogeneous)
            for shape in shapes.geometryObjects
            if type(shape.geometry).__name__ not in {"BVHModelOBBRSS", "Convex"}
        },
    }


LIMITS = ("effortLimit", "velocityLimit", "lowerPositionLimit", "upperPositionLimit")


def assert_same(one: Any, other: Any, where: str = "") -> None:
    if isinstance(one, dict):
        assert one.keys() == other.keys(), where
        for name in one:
            assert_same(one[name], other[name], f"{where}.{name}")
    elif isinstance(one, tuple):
        assert one[0] == other[0], where
        assert_same(one[1], other[1], where)
    else:
        assert np.allclose(one, other, rtol=1e-9, atol=1e-9), (where, one, other)


def test_pinocchio_reads_the_same_from_a_urdf_and_its_copy(tmp_path: Path) -> None:
    source, copy, bundle = converted(EVERYTHING, "urdf", tmp_path)

    assert_same(in_pinocchio(source), in_pinocchio(copy))
    lost = [str(loss) for loss in bundle.losses]
    assert any("alpha 0.3" in row for row in lost)
    assert any("wood.png" in row for row in lost)
    written = etree.parse(copy).getroot()
    for path in ("joint/safety_controller", "joint/calibration", "transmission/type", "gazebo/mu1", "ros2_control/hardware/plugin"):
        assert written.find(path) is not None, path
    limit = written.find("joint[@name='shoulder']/limit")
    assert [limit.get(name) for name in ("acceleration", "deceleration", "jerk")] == ["10", "8", "100"]
    assert written.find("link[@name='tool']/visual") is None


def random_urdf(random: np.random.Generator) -> str:
    """Return a tree of links: every joint type, any axis, origins with angles or quaternions, dynamics stated or not."""

    def vector(size: float = 0.3) -> str:
        return " ".join(f"{x:.4f}" for x in random.uniform(-size, size, 3))

    def origin() -> str:
        turn = f'quat_xyzw="{" ".join(f"{x:.5f}" for x in random.normal(size=4))}"' if random.random() < 0.5 else f'rpy="{vector(3)}"'
        return f'<origin xyz="{vector()}" {turn}/>'

    def shape() -> str:
        form = ['box size="0.1 0.2 0.3"', 'cylinder radius="0.1" length="0.3"', 'sphere radius="0.2"', 'capsule radius="0.1" length="0.2"']
        return f"<collision>{origin()}<geometry><{random.choice(form)}/></geometry></collision>"

    inertial = '<mass value="{:.3f}"/><inertia ixx="0.2" ixy="0.01" ixz="0" iyy="0.3" iyz="0.02" izz="0.25"/>'
    rows = ['<robot name="random" version="1.2"><link name="l0"/>']
    for index in range(1, 9):
        kind = random.choice(["revolute", "continuous", "prismatic", "fixed"])
        body = (
            f"<inertial>{origin()}{inertial.format(random.uniform(0.1, 3))}</inertial>" if random.random() < 0.9 or kind != "fixed" else ""
        )
        rows.append(f'<link name="l{index}">{body}{shape() if random.random() < 0.7 else ""}</link>')
        low, high = sorted(random.uniform(-2, 2, 2))
        capacity = f'effort="{random.choice([0, 3, 33])}" velocity="{random.choice([0, 2.5])}" jerk="{index}"'
        limit = f'<limit lower="{low:.3f}" upper="{high:.3f}" {capacity}/>' if kind in {"revolute", "prismatic"} else ""
        limit = f"<limit {capacity}/>" if kind == "continuous" and random.random() < 0.5 else limit
        dynamics = (
            f'<dynamics damping="{random.uniform(0, 1):.3f}" friction="{random.uniform(0, 1):.3f}"/>' if random.random() < 0.5 else ""
        )
        axis = random.choice(["0 0 1", "0 1 0", "-1 0 0", "1 2 2", vector()])
        rows.append(
            f'<joint name="j{index}" type="{kind}"><parent link="l{random.integers(0, index)}"/><child link="l{index}"/>{origin()}'
            f'<axis xyz="{axis}"/>{"" if kind == "fixed" else limit + dynamics}</joint>'
        )
    return "".join([*rows, "</robot>"])


@pytest.mark.parametrize("seed", range(12))
def test_frames_dynamics_and_shapes_of_random_urdfs_stay_as_they_came(seed: int, tmp_path: Path) -> None:
    source, copy, bundle = converted(random_urdf(np.random.default_rng(seed)), "urdf", tmp_path)

    assert_same(in_pinocchio(source), in_pinocchio(copy))
    assert not [loss for loss in bundle.losses if "frame" in loss.lost]


def test_a_frame_that_must_move_is_a_row_with_the_offset(tmp_path: Path) -> None:
    text = """<mujoco><worldbody><body name="a" pos="0 0 1"><joint name="j" axis="1 0 0" pos="0 0.2 0.1"/><geom size=".1"/></body>
      <body name="b"><joint name="k" axis="0 0 1" pos="0 0 0.3"/><geom size=".1"/></body></worldbody></mujoco>"""
    bundle = converted(text, "urdf", tmp_path, suffix=".xml")[2]

    rows = [loss for loss in bundle.losses if "frame" in loss.lost]
    assert [loss.where for loss in rows] == ["parts.a"]  # the axis of k passes through b's origin
    assert "0, 200, 100 mm" in rows[0].kept


THREE = """<robot name="g"><link name="b"/><link name="l1"/><link name="l2"/><link name="l3"><inertial><mass value="1"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="roll" type="revolute"><parent link="b"/><child link="l1"/><origin xyz="0 0 .1"/><axis xyz="1 0 0"/><limit {0}/></joint>
<joint name="pitch" type="revolute"><parent link="l1"/><child link="l2"/><axis xyz="0 1 0"/><limit {1}/></joint>
<joint name="yaw" type="revolute"><parent link="l2"/><child link="l3"/><axis xyz="0 0 1"/><limit {2}/></joint></robot>"""
SAME = 'effort="5" velocity="1"'


def three(*ranges: tuple[float, float], efforts: tuple[float, ...] = (5, 5, 5)) -> str:
    rows = zip(ranges, efforts, strict=True)
    return THREE.format(*(f'lower="{low}" upper="{high}" effort="{effort}" velocity="1"' for (low, high), effort in rows))


def test_a_capsule_is_a_cylinder_with_two_half_balls() -> None:
    body = capsule(3.0, 10.0, 256)

    assert body.is_closed
    assert body.volume == pytest.approx(np.pi * 9 * 10 + 4 / 3 * np.pi * 27, rel=1e-3)
    assert np.allclose(body.bounds, [[-3, -3, -8], [3, 3, 8]])


def test_three_joints_stay_three_unless_fusing_is_asked_for(tmp_path: Path) -> None:
    text = three((-0.1, 2.0), (-1, 1), (0.2, 1.5), efforts=(5, 6, 7))

    for fuse in (False, True):  # no ball lies within these limits
        source, copy, _ = converted(text, "urdf", tmp_path, fuse=fuse)
        one, other = in_pinocchio(source), in_pinocchio(copy)
        assert_same(one["numbers"], other["numbers"])
        if not fuse:
            assert list(one["inertias"]) == list(other["inertias"]) == ["universe", "roll", "pitch", "yaw"]
            assert_same(one["frames"], other["frames"])


def test_a_chain_that_could_be_fused_is_a_note_and_a_fused_one_another(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(three((-1, 1), (-1, 1), (-1, 1)))

    assert [finding.code for finding in read_urdf(path).findings] == ["I_IMPORT_CHAIN"]
    assert [finding.code for finding in read_urdf(path, fuse=True).findings] == ["I_IMPORT_FUSED"]


@pytest.mark.parametrize("target", ["urdf", "mjcf", "sdf"])
def test_efforts_that_nobody_states_are_named(target: str, tmp_path: Path) -> None:
    """An assembly of our own gets efforts that carry its load; a file gets them only where the format demands one."""
    (assumed,) = NAMED[target].write(geared_pair()).findings.of("I_EFFORT_ASSUMED")
    assert "Effort" in assumed.message
    text = '<mujoco><worldbody><body name="a"><joint name="j" axis="0 1 0" range="-9 9"/><geom size=".1"/></body></worldbody></mujoco>'
    _, copy, bundle = converted(text, target, tmp_path, suffix=".xml")

    assert bool(bundle.findings.of("I_EFFORT_ASSUMED")) == (target == "urdf")
    assert bool([loss for loss in bundle.losses if "effort" in loss.kept]) == (target == "urdf")
    assert (" effort=" in re.sub("<(articad|text).*", "", copy.read_text())) == (target == "urdf")


@pytest.mark.parametrize("seed", range(6))
def test_a_fused_ball_lies_within_the_limits_of_its_three_joints(seed: int, tmp_path: Path) -> None:
    """Poses of the ball at its limits are turned into three angles by this test itself."""
    from scipy.spatial.transform import Rotation

    random = np.random.default_rng(seed)
    ranges = [(-random.uniform(0.2, 1.4), random.uniform(0.2, 1.4)) for _ in range(2)] + [(-random.uniform(0.8, 2), random.uniform(0.8, 2))]
    path = tmp_path / "a.urdf"
    path.write_text(three(*ranges))
    assembly = read_urdf(path, fuse=True)
    if [joint.type for joint in assembly.joints] != ["ball"]:
        assert seed != 0
        return
    (ball,) = assembly.joints
    assert ball.effort == (5000.0,)
    assert ball.limits.cone is not None
    assert ball.limits.twist is not None
    for heading in np.linspace(0, 2 * np.pi, 60):
        for swing in np.linspace(0, ball.limits.cone, 5):
            for twist in ball.limits.twist:
                turn = Rotation.from_rotvec([swing * np.cos(heading), swing * np.sin(heading), 0]) * Rotation.from_rotvec([0, 0, twist])
                angles = turn.as_euler("XYZ")
                assert all(low - 1e-9 <= angle <= high + 1e-9 for angle, (low, high) in zip(angles, ranges, strict=True))


@pytest.mark.parametrize("target", ["mjcf", "sdf", "usd", "step", "glb", "plan"])
def test_what_urdf_says_beyond_is_a_row_in_every_other_format(target: str, tmp_path: Path) -> None:
    lost = " ".join(loss.lost for loss in converted(EVERYTHING, target, tmp_path)[2].losses)

    for word in (
        "<safety_controller>",
        "<calibration>",
        "<transmission t1>",
        "<gazebo arm>",
        "<ros2_control sys>",
        "jerk 100",
        "alpha",
        "wood.png",
    ):
        assert word in lost, word


# urdf.xsd of urdfdom, by hand: the attributes of each element
URDF_SCHEMA = {
    "robot": "name version",
    "link": "name type",
    "inertial/origin": "xyz rpy quat_xyzw",
    "inertial/mass": "value",
    "inertial/inertia": "ixx ixy ixz iyy iyz izz",
    "visual": "name",
    "visual/origin": "xyz rpy quat_xyzw",
    "visual/material": "name",
    "material/color": "rgba",
    "material/texture": "filename",
    "collision": "name",
    "collision/origin": "xyz rpy quat_xyzw",
    "collision/verbose": "value",
    "geometry/box": "size",
    "geometry/cylinder": "radius length",
    "geometry/sphere": "radius",
    "geometry/capsule": "radius length",
    "geometry/mesh": "filename scale",
    "joint": "name type",
    "joint/origin": "xyz rpy quat_xyzw",
    "joint/axis": "xyz",
    "joint/parent": "link",
    "joint/child": "link",
    "joint/limit": "lower upper effort velocity acceleration deceleration jerk",
    "joint/dynamics": "damping friction",
    "joint/mimic": "joint multiplier offset",
    "joint/calibration": "reference_position rising falling",
    "joint/safety_controller": "soft_lower_limit soft_upper_limit k_position k_velocity",
    "transmission": "name",
    "gazebo": "reference",
    "sensor": "name update_rate",
    "loop_joint": "name type",
}


def unread_urdf() -> Iterator[tuple[str, str]]:
    for key, attributes in URDF_SCHEMA.items():
        for attribute in attributes.split():
            if attribute not in READ_URDF.get(key, frozenset()) and (key, attribute) != ("robot", "version"):
                yield key, attribute


@pytest.mark.parametrize(("key", "attribute"), list(unread_urdf()))
def test_every_attribute_of_urdfs_schema_that_is_not_read_comes_back_or_is_a_row(key: str, attribute: str, tmp_path: Path) -> None:
    root = etree.fromstring(EVERYTHING)
    places = {"joint": "joint[@name='shoulder']", "collision": "link[@name='arm']/collision", "material": "material[@name='tex']"}
    above, _, tag = key.rpartition("/")
    parent = root if not above else root.find(places[above])
    element = parent if key == "robot" else root.find(tag) if key == "link" else parent.find(tag)
    if element is None:
        element = etree.SubElement(parent, tag)
    element.set(attribute, "0.125")

    _, copy, bundle = converted(etree.tostring(root, encoding="unicode"), "urdf", tmp_path)

    there = [found for found in etree.parse(copy).iter(tag) if found.get(attribute) == "0.125"]
    rows = [loss for loss in bundle.losses if attribute in loss.lost or f"<{tag}>" in loss.lost or "0.125" in loss.lost]
    assert there or rows


FLAT = (False, False)  # no HTML, no padding


def mujoco_schema() -> dict[str, set[str]]:
    """Return the attributes of every element, by section and tag, from MuJoCo's own table."""
    import mujoco

    found: dict[str, set[str]] = {}
    stack: list[tuple[int, str]] = []
    key = ""
    for line in mujoco.mj_printSchema(*FLAT).splitlines():
        head = re.match(r"^( *)(\S+) \((.)\)(.*)$", line)
        if head:
            depth, tag = len(head[1]), head[2].replace("(world)", "")
            stack = [*(item for item in stack if item[0] < depth), (depth, tag)]
            path = [name for _, name in stack]
            section = path[1] if len(path) > 1 else ""
            key = f"{section}/{path[-1]}" if len(path) > 2 else path[-1]
            found.setdefault(key, set()).update(head[4].split())
        elif key:
            found[key].update(line.split())
    return found


def test_mujocos_schema_is_read_as_a_table() -> None:
    schema = mujoco_schema()

    assert {"armature", "damping"} <= schema["body/joint"]
    assert {"relpose", "torquescale"} <= schema["equality/weld"]
    assert {"gravity", "timestep"} <= schema["option"]


def test_what_the_reader_claims_to_read_is_in_mujocos_schema() -> None:
    schema = mujoco_schema()
    words = set().union(*schema.values())

    for key, attributes in READ_MJCF.items():
        assert attributes <= words | {"*"}, (key, attributes - words)


SAMPLES = {"joint": "j", "geom": "g", "body": "a", "freejoint": "f", "inertial": ""}


@pytest.mark.parametrize("tag", ["body", "joint", "geom", "freejoint", "site", "camera", "light"])
def test_every_attribute_of_mujocos_schema_that_is_not_read_is_a_row(tag: str) -> None:
    """Attributes are put on an element by name; MuJoCo need not compile the text, because the ledger reads the text itself."""
    from articad.importers.mjcf_kept import kept_attributes

    schema = mujoco_schema()
    attributes = schema[tag] if tag == "body" else schema[f"body/{tag}"]
    for attribute in sorted(attributes - READ_MJCF.get(tag, frozenset())):
        for place in ("worldbody/body", "default"):
            root = etree.Element("mujoco")
            above = root
            for step in place.split("/") if tag != "body" else ["worldbody"]:
                above = etree.SubElement(above, step)
            etree.SubElement(above, tag, {attribute: "7"})
            rows = [item.what for item in kept_attributes(root)]
            assert any(attribute in row or f"<{tag}>" in row for row in rows), (tag, attribute, place)


@pytest.mark.parametrize(
    "section", ["option", "actuator", "sensor", "tendon", "contact", "keyframe", "visual", "size", "statistic", "deformable"]
)
def test_every_section_of_mujocos_schema_that_is_not_read_is_a_row(section: str) -> None:
    from articad.importers.mjcf_kept import kept_attributes

    schema = mujoco_schema()
    inside = [key.partition("/")[2] for key in schema if key.startswith(f"{section}/")]
    for tag in inside:
        root = etree.Element("mujoco")
        etree.SubElement(etree.SubElement(root, section), tag, {"name": "it"})
        assert [item.what for item in kept_attributes(root)], (section, tag)
    if not inside:
        for attribute in schema[section]:
            root = etree.Element("mujoco")
            etree.SubElement(root, section, {attribute: "3"})
            assert [item.what for item in kept_attributes(root)], (section, attribute)


def test_dynamics_of_mjcf_stay_as_they_came(tmp_path: Path) -> None:
    import mujoco

    text = """<mujoco><compiler angle="radian"/><default><joint damping="0.3" frictionloss="0.1"/></default><worldbody>
      <body name="a"><joint name="j" axis="0 1 0" actuatorfrcrange="-33 33" armature="0.02" stiffness="3" springref="0.2"/><geom type="capsule" size=".1 .2"/>
       <body name="b" pos="0 0 .5"><joint name="k" type="slide" damping="7" frictionloss="0" range="0 .1"/><geom type="ellipsoid" size=".1 .2 .3"/>
       </body></body></worldbody></mujoco>"""
    source, copy, _ = converted(text, "mjcf", tmp_path, suffix=".xml")
    one, other = (mujoco.MjModel.from_xml_path(str(path)) for path in (source, copy))

    for name in (
        "dof_damping",
        "dof_frictionloss",
        "jnt_actfrclimited",
        "jnt_actfrcrange",
        "jnt_range",
        "dof_armature",
        "jnt_stiffness",
        "qpos_spring",
    ):
        assert np.allclose(getattr(one, name), getattr(other, name)), name
    assert sorted(one.geom_type) == sorted(other.geom_type)
    assert sum(one.geom_size.ravel()) == pytest.approx(sum(other.geom_size.ravel()))


MOVING = {
    "a damped pendulum with a slide": """<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
      <body name="a" euler="0 80 0"><joint name="j" axis="0 1 0" damping="0.02" armature="0.01" stiffness="0.3" springref="10"/><geom type="capsule" fromto="0 0 0 0 0 -.4" size=".02"/>
       <body name="b" pos="0 0 -.4"><joint name="k" type="slide" axis="0 0 1" damping="0.4"/><geom size=".05"/>
       </body></body></worldbody></mujoco>""",
    "a driven four-bar": """<mujoco><option timestep="0.001" integrator="implicitfast"/><worldbody>
      <body name="crank"><joint name="crank" axis="0 1 0" damping="0.01"/><geom type="capsule" fromto="0 0 0 0 0 .1" size=".01"/>
       <body name="rod" pos="0 0 .1"><joint name="rod" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .3 0 .05" size=".01"/></body></body>
      <body name="rocker" pos=".3 0 0"><joint name="rocker" axis="0 1 0" damping="0.02"/><geom type="capsule" fromto="0 0 0 0 0 .15" size=".01"/></body></worldbody>
      <equality><connect name="loop" body1="rod" body2="rocker" anchor=".3 0 .05" solref="0.002 1"/></equality>
      <actuator><position name="drive" joint="crank" kp="2" kv="0.1" ctrlrange="-3 3"/></actuator></mujoco>""",
}


@pytest.mark.parametrize("name", MOVING)
def test_mujoco_moves_the_copy_as_the_original(name: str, tmp_path: Path) -> None:
    """One second in MuJoCo. Free fall: `tests/export/test_free_joints.py`."""
    import mujoco

    source, copy, _ = converted(MOVING[name], "mjcf", tmp_path, suffix=".xml")
    ways = []
    for path in (source, copy):
        model = mujoco.MjModel.from_xml_path(str(path))
        data = mujoco.MjData(model)
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
        way = []
        while data.time < 1:
            data.ctrl[:] = np.sin(5 * data.time)
            mujoco.mj_step(model, data)
            way.append(np.array(data.qpos))
        ways.append(np.array(way))

    assert np.ptp(ways[0], axis=0).min() > 0.05  # each joint moves
    assert np.abs(ways[0] - ways[1]).max() < 1e-6 * np.abs(ways[0]).max()


@pytest.mark.parametrize("seed", range(6))
def test_mujoco_reads_from_the_mjcf_what_pinocchio_reads_from_the_urdf(seed: int, tmp_path: Path) -> None:
    import mujoco
    import pinocchio as pin

    source, copy, _ = converted(random_urdf(np.random.default_rng(100 + seed)), "mjcf", tmp_path)
    model = mujoco.MjModel.from_xml_path(str(copy))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)  # all values zero
    read, there = in_pinocchio(source), pin.buildModelFromUrdf(str(source))

    for name in (name for name in read["frames"] if name.startswith("l")):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = data.body(name).xmat.reshape(3, 3), data.body(name).xpos
        assert np.allclose(pose, read["frames"][name], atol=1e-9), name
    for joint in range(model.njnt):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)
        index = there.getJointId(name)
        at, q = there.joints[index].idx_v, there.joints[index].idx_q
        assert model.dof_damping[joint] == pytest.approx(there.damping[at])
        assert model.dof_frictionloss[joint] == pytest.approx(there.friction[at])
        if model.jnt_limited[joint]:
            assert model.jnt_range[joint] == pytest.approx([there.lowerPositionLimit[q], there.upperPositionLimit[q]])
        if model.jnt_actfrclimited[joint]:
            assert model.jnt_actfrcrange[joint][1] == pytest.approx(there.effortLimit[at])


XACRO = '<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/><xacro:include filename="b.xacro"/></robot>'


@pytest.mark.parametrize("name", ["missing.urdf", "empty", "robot.urdf.xacro"])
def test_what_cannot_be_audited_ends_with_exit_code_3_and_a_word(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "robot.urdf.xacro").write_text(XACRO)

    assert cli.main(["audit", str(tmp_path / name), "--no-engines"]) == 3
    said = " ".join(capsys.readouterr().err.split())
    assert {"missing.urdf": "There is no ", "empty": "no model below", "robot.urdf.xacro": "b.xacro"}[name] in said
    assert "JSON" not in said


def test_instructions_of_xacro_in_a_urdf_are_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(XACRO)

    with pytest.raises(ReadError, match=r"line 1: <xacro:include filename=\"b.xacro\"> is not expanded"):
        read_urdf(path)


def test_a_negative_effort_is_said(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(three((-1, 1), (-1, 1), (-1, 1), efforts=(5, -6, 5)))

    assert [finding.where for finding in read_urdf(path).findings.of("W_IMPORT_LIMITS")] == ["joints.pitch"]


def test_a_mesh_with_a_negative_scale_is_mirrored_and_its_mass_is_positive(tmp_path: Path) -> None:
    """A tetrahedron without symmetry, scaled by -1, 2, 1: trimesh scales it, and MuJoCo weighs the conversion."""
    import mujoco

    corner = trimesh.Trimesh([[0, 0, 0], [0.5, 0, 0], [0, 0.25, 0], [0, 0, 0.125]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    corner.export(tmp_path / "corner.stl")
    shape = '<geometry><mesh filename="corner.stl" scale="-1 2 1"/></geometry>'
    text = f'<robot name="n"><link name="a"><visual>{shape}</visual><collision>{shape}</collision></link></robot>'
    source, copy, _ = converted(text, "mjcf", tmp_path)
    expected = corner.apply_transform(np.diag([-1.0, 2.0, 1.0, 1.0]))
    (mesh,) = {id(item.mesh): item.mesh for item in read_urdf(source).parts["a"].visuals}.values()

    assert expected.volume > 0
    assert mesh.solid_integrals()[0] == pytest.approx(1e9 * expected.volume)
    assert np.allclose(sorted(map(tuple, mesh.vertices)), sorted(map(tuple, 1000 * expected.vertices)))

    model = mujoco.MjModel.from_xml_path(str(copy))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for geom in range(model.ngeom):
        start, count = model.mesh_vertadr[model.geom_dataid[geom]], model.mesh_vertnum[model.geom_dataid[geom]]
        placed = model.mesh_vert[start : start + count] @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
        assert np.allclose(sorted(map(tuple, placed.round(6))), sorted(map(tuple, expected.vertices)), atol=2e-6)


def colored_mesh(suffix: str, colored: bool, folder: Path) -> None:
    """Write a tetrahedron as `mesh<suffix>`, with a colour of its own or without one."""
    body = trimesh.creation.tetrahedron() if hasattr(trimesh.creation, "tetrahedron") else trimesh.creation.box()
    if suffix == ".obj":
        head = "mtllib skin.mtl\nusemtl red\n" if colored else ""
        (folder / "skin.mtl").write_text("newmtl red\nKd 1 0 0\n")
        rows = [*(f"v {x} {y} {z}" for x, y, z in body.vertices), *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in body.faces)]
        (folder / "mesh.obj").write_text(head + "\n".join(rows))
        return
    body.visual = trimesh.visual.ColorVisuals(body, face_colors=[255, 0, 0, 255]) if colored and suffix == ".ply" else None
    if suffix == ".glb" and colored:
        material = trimesh.visual.material.PBRMaterial(baseColorFactor=[255, 0, 0, 255])
        body.visual = trimesh.visual.TextureVisuals(uv=np.zeros((len(body.vertices), 2)), material=material)
    if suffix == ".stl" or not colored:
        body.visual = trimesh.visual.ColorVisuals(body)
    data = body.export(file_type=suffix[1:])
    if suffix == ".dae":
        data = data if colored else re.sub(rb"<instance_material[^>]*/?>(?:.*?</instance_material>)?", b"", data, flags=re.DOTALL)
    (folder / f"mesh{suffix}").write_bytes(data)


FORMS = {
    ".urdf": '<robot name="r"><link name="a"><visual><geometry><mesh filename="mesh{0}"/></geometry>{1}</visual></link></robot>',
    ".sdf": '<sdf version="1.9"><model name="r"><link name="a"><visual name="v"><geometry><mesh><uri>mesh{0}</uri></mesh></geometry>{1}</visual>'
    "</link></model></sdf>",
}
OWN = {
    ".urdf": '<material name="m"><color rgba="0 1 0 1"/></material>',
    ".sdf": "<material><diffuse>0 1 0 1</diffuse></material>",
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("own", [False, True], ids=["", "with a material of the file"])
@pytest.mark.parametrize("colored", [False, True], ids=["plain", "colored"])
@pytest.mark.parametrize("suffix", [".stl", ".obj", ".dae", ".glb", ".ply"])
def test_colours_of_mesh_files_are_a_row_where_they_would_be_seen(suffix: str, colored: bool, own: bool, form: str, tmp_path: Path) -> None:
    from articad import read

    colored_mesh(suffix, colored, tmp_path)
    (tmp_path / f"a{form}").write_text(FORMS[form].format(suffix, OWN[form] if own else ""))
    bundle = NAMED["urdf"].write(read(tmp_path / f"a{form}"))

    rows = [str(loss) for loss in bundle.losses if "colours of mesh" in loss.lost]
    assert bool(rows) == (colored and not own and suffix != ".stl"), rows


@pytest.mark.parametrize("form", [".urdf", ".xml", ".sdf"])
def test_a_default_namespace_means_nothing(form: str, tmp_path: Path) -> None:
    from articad import read

    texts = {
        ".urdf": '<robot{} name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>',
        ".sdf": '<sdf{} version="1.9"><model name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed"><parent>a</parent><child>b</child>'
        "</joint></model></sdf>",
        ".xml": '<mujoco{}><worldbody><body name="a"><joint name="j"/><geom size="0.1"/></body></worldbody></mujoco>',
    }
    found = []
    for words in ("", ' xmlns="http://www.ros.org" xmlns:q="http://q"'):
        (tmp_path / f"a{form}").write_text(texts[form].format(words))
        found.append([(joint.name, joint.parent, joint.child) for joint in read(tmp_path / f"a{form}").joints])

    assert found[0] == found[1]


SINGLES = {
    "link[@name='arm']/inertial": "parts.arm",
    "link[@name='arm']/inertial/origin": "parts.arm",
    "link[@name='arm']/inertial/mass": "parts.arm",
    "link[@name='arm']/visual/geometry": "parts.arm",
    "link[@name='arm']/visual/geometry/*": "parts.arm",
    "link[@name='arm']/collision/origin": "parts.arm",
    "joint[@name='shoulder']/origin": "joints.shoulder",
    "joint[@name='shoulder']/axis": "joints.shoulder",
    "joint[@name='shoulder']/limit": "joints.shoulder",
    "joint[@name='shoulder']/dynamics": "joints.shoulder",
    "joint[@name='lift']/mimic": "joints.lift",
}


@pytest.mark.parametrize("path", SINGLES)
def test_a_second_element_of_a_kind_is_a_row_and_the_first_counts(path: str, tmp_path: Path) -> None:
    root = etree.fromstring(EVERYTHING)
    first = root.find(path)
    second = etree.fromstring(etree.tostring(first))
    for name in second.attrib:
        second.set(name, "7 7 7" if len(second.get(name).split()) == 3 else second.get(name))
    first.addnext(second)

    source, copy, bundle = converted(etree.tostring(root, encoding="unicode"), "urdf", tmp_path)

    assert_same(in_pinocchio(source), in_pinocchio(copy))
    assert [loss.where for loss in bundle.losses if f"a second <{second.tag}>" in loss.lost] == [SINGLES[path]]


def test_a_link_with_two_parents_is_a_loop_and_a_finding(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    rows = [("j", "a", "b"), ("k", "a", "c"), ("l", "b", "c")]
    joints = "".join(f'<joint name="{name}" type="continuous"><parent link="{a}"/><child link="{b}"/></joint>' for name, a, b in rows)
    path.write_text(f'<robot name="r"><link name="a"/><link name="b"/><link name="c"/>{joints}</robot>')
    found = read_urdf(path)

    (finding,) = found.findings.of("W_IMPORT_LOOP")
    assert (finding.where, len(found.mechanism.loop_joints)) == ("parts.c", 1)
    assert "'k', 'l'" in finding.message
