"""Conversions of files of any content: what an engine reads differently has a row of the losses, and the comparison sees what is changed."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.export.losses import TABLE
from tests.differences import Compiled, Difference, Row, compare, differences, examine, facts_of, mujoco_facts, names_it
from tests.importers.test_doors import EVERYTHING, random_urdf

pytestmark = pytest.mark.engines

WHOLE = """<mujoco model="a whole one">
<compiler angle="degree" autolimits="true"/>
<option timestep="0.004" gravity="0 0.1 -3.7" integrator="RK4" cone="elliptic" impratio="2"><flag energy="enable" warmstart="disable"/></option>
<size memory="2M"/>
<visual><headlight ambient="0.3 0.3 0.3"/><map znear="0.02"/></visual>
<statistic extent="2.5" center="0 0 1"/>
<default><joint damping="0.3"/><geom friction="0.7 0.01 0.001"/><motor gear="3"/>
 <default class="stiff"><joint stiffness="4" armature="0.02" solreflimit="0.01 1"/><position kp="30"/><geom condim="4" margin="0.01"/>
  <default class="inner"><position ctrlrange="-1 1"/></default></default></default>
<asset><texture name="grid" type="2d" builtin="checker" width="16" height="16"/><material name="shiny" texture="grid" specular="0.9" rgba="1 0 0 0.5"/>
 <mesh name="wedge" vertex="0 0 0  .1 0 0  0 .1 0  0 0 .1"/></asset>
<include file="sub/more.xml"/>
<worldbody><light name="sun" pos="0 0 3" dir="0 0 -1" diffuse="0.5 0.5 0.5" castshadow="false"/><camera name="eye" pos="1 1 1" mode="targetbody" target="arm" fovy="60"/>
 <geom name="floor" type="plane" size="2 2 .1" material="shiny"/><geom name="stone" size="0.1" pos="2 0 0"/><site name="origin" size="0.01" rgba="0 1 0 0.4"/>
 <body name="arm" pos="0 0 1" childclass="stiff" gravcomp="0.5"><joint name="shoulder" axis="0 1 0.2" pos="0.1 0 0.2" range="-80 120" ref="20" frictionloss="0.1"/>
  <joint name="lift" type="slide" axis="0 0 1" range="-0.1 0.3" actuatorfrcrange="-4 9" springref="0.1" class="main"/>
  <geom name="bone" type="capsule" fromto="0 0 0 0 0 -0.4" size="0.03" mass="0.7"/><geom type="mesh" mesh="wedge" contype="0" conaffinity="0" group="2"/>
  <site name="tip" pos="0 0 -0.4" euler="10 20 30"/>
  <body pos="0 0 -0.4" euler="0 30 0"><joint axis="1 0 0" actuatorgravcomp="true" group="2" margin="0.02"/><geom name="ball" size="0.05" contype="2" conaffinity="3" priority="1"/>
   <camera name="hand" pos="0 0.1 0" quat="1 0.1 0 0"/><geom type="ellipsoid" size="0.02 0.03 0.04" pos="0.1 0 0" gap="0.001" solref="0.03 0.9"/>
   <site name="palm" pos="0 0 -0.1" type="box" size="0.01 0.02 0.03"/></body></body>
 <body name="wrist" pos="0.5 0 1"><joint name="round" type="ball" range="0 60" damping="0.2"/><geom type="box" size="0.1 0.2 0.05" rgba="0.2 0.3 0.4 1"/></body>
 <replicate count="3" offset="0.3 0 0"><body name="post" pos="0 1 0.5"><joint name="bend" axis="1 0 0"/><geom type="cylinder" size="0.02 0.1"/></body></replicate>
 <body name="hand" mocap="true" pos="0 0 2"><geom size="0.02" contype="0" conaffinity="0"/></body>
</worldbody>
<contact><exclude name="apart" body1="arm" body2="wrist"/><pair geom1="bone" geom2="floor" condim="6" friction="0.5 0.5 0.01 0.001 0.001"/></contact>
<tendon><spatial name="string" stiffness="5" width="0.004"><site site="origin"/><geom geom="ball" sidesite="tip"/><site site="palm"/></spatial>
 <fixed name="sum" range="-1 1"><joint joint="shoulder" coef="1"/><joint joint="lift" coef="-2"/></fixed></tendon>
<equality><connect name="held" body1="wrist" body2="arm" anchor="0.1 0 0" active="false"/><weld body1="arm" body2="hand" solref="0.05 1" active="false"/>
 <joint name="geared" joint1="bend0" joint2="bend1" polycoef="0.1 0.5 0 0 0"/><tendon tendon1="sum" active="false"/></equality>
<actuator><motor name="push" joint="shoulder" ctrlrange="-1 2"/><position class="inner" name="hold" joint="lift"/><general tendon="string" gainprm="2" biastype="affine" biasprm="0 -1 -0.2"/>
 <velocity name="turn" joint="round" gear="0 0 1 0 0 0" kv="2"/></actuator>
<sensor><jointpos joint="shoulder" noise="0.1"/><framepos name="where" objtype="site" objname="tip" reftype="body" refname="wrist"/><actuatorfrc actuator="push"/><touch site="palm" cutoff="3"/></sensor>
<keyframe><key name="up" qpos="0.2 0.1 0.3 1 0 0 0 0.1 0.2 0.3" ctrl="0.1 0.2 0.3 0.4"/><key time="2" qvel="1 2 3 4 5 6 7 8 9"/></keyframe>
<custom><numeric name="gains" data="1 2 3"/><text name="note" data="by hand"/><tuple name="both"><element objtype="body" objname="arm"/></tuple></custom>
</mujoco>"""

INNER = '<mujoco><worldbody><body name="from_below"><include file="deep/geom.xml"/></body></worldbody></mujoco>'


def whole(folder: Path) -> Path:
    """Write the model with all sections, and the files that it includes."""
    (folder / "sub" / "deep").mkdir(parents=True)
    (folder / "sub" / "more.xml").write_text(INNER)
    (folder / "sub" / "deep" / "geom.xml").write_text('<mujoco><geom name="deep" size="0.1" pos="3 3 3" friction="0.2"/></mujoco>')
    (folder / "whole.xml").write_text(WHOLE)
    return folder / "whole.xml"


@pytest.mark.parametrize("target", ["mjcf", "urdf"])
def test_an_mjcf_file_with_everything_is_converted_without_a_silent_difference(target: str, tmp_path: Path) -> None:
    result = examine(whole(tmp_path), target, tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result
    assert result["free"] == []
    if target == "mjcf":  # what is left are pictures
        assert result["named"] == []
        assert all("texture" in row or "material" in row for row in result["idle"]), result["idle"]


@pytest.mark.parametrize("target", ["mjcf", "urdf"])
def test_a_urdf_with_everything_is_converted_without_a_silent_difference(target: str, tmp_path: Path) -> None:
    (tmp_path / "a.urdf").write_text(EVERYTHING)
    result = examine(tmp_path / "a.urdf", target, tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result


EDITS = [
    ('timestep="0.004"', 'timestep="0.005"'),
    ('friction="0.7 0.01 0.001"', 'friction="0.8 0.01 0.001"'),
    ('ref="20"', 'ref="21"'),
    ('range="-80 120"', 'range="-80 121"'),
    ('armature="0.02"', 'armature="0.03"'),
    ('axis="0 1 0.2"', 'axis="0 1 0.3"'),
    ('mass="0.7"', 'mass="0.8"'),
    ('actuatorfrcrange="-4 9"', 'actuatorfrcrange="-4 8"'),
    ('kp="30"', 'kp="31"'),
    ('body2="wrist"/>', 'body2="post0"/>'),
    ('polycoef="0.1 0.5', 'polycoef="0.1 0.6'),
    ('coef="-2"', 'coef="-3"'),
    ('cutoff="3"', 'cutoff="4"'),
    ('key time="2"', 'key time="3"'),
    ('gravcomp="0.5"', 'gravcomp="0.4"'),
    ('fovy="60"', 'fovy="61"'),
    ('size="0.02 0.03 0.04"', 'size="0.02 0.03 0.05"'),
    ("0 .1 0  0 0 .1", "0 .1 0  0 0 .2"),
    ('euler="10 20 30"', 'euler="10 20 31"'),
    ('<touch site="palm" cutoff="3"/>', ""),
    ('name="push" joint="shoulder"', 'name="push" joint="bend0"'),
]


@pytest.mark.parametrize("edit", EDITS, ids=lambda edit: edit[0])
def test_the_comparison_sees_every_edit_and_calls_it_silent(edit: tuple[str, str], tmp_path: Path) -> None:
    path = whole(tmp_path)
    before = mujoco_facts(Compiled(path))
    assert WHOLE.count(edit[0]) == 1
    path.write_text(WHOLE.replace(*edit))
    found = differences(before, mujoco_facts(Compiled(path)))

    assert found
    assert compare(found, []).silent == found


def test_the_same_file_has_no_difference_from_itself(tmp_path: Path) -> None:
    path = whole(tmp_path)

    for target, both in (("mjcf", True), ("mjcf", False)):
        one, other = (facts_of(path, target, tmp_path, both=both) for _ in range(2))
        assert differences(one, other) == []


def random_mjcf(random: np.random.Generator) -> str:
    """Return a tree of bodies with any joints, geoms, attributes, names or none, and what refers to them."""

    def vector(size: float = 0.3, count: int = 3) -> str:
        return " ".join(f"{x:.4f}" for x in random.uniform(-size, size, count))

    def some(**attributes: str) -> str:
        return " ".join(f'{name}="{value}"' for name, value in attributes.items() if random.random() < 0.4)

    def positive() -> str:
        return f"{random.uniform(0.01, 0.2):.4f}"

    names: dict[str, list[str]] = {"joint": [], "site": [], "geom": [], "body": []}

    def named(kind: str) -> str:
        if random.random() < 0.3:
            return ""
        names[kind].append(f"{kind}/{len(names[kind])}.{random.choice(['a', 'b b', 'ö'])}")
        return f'name="{names[kind][-1]}"'

    def joint(kind: str) -> str:
        low, high = sorted(random.uniform(-2, 2, 2))
        limits = {"hinge": f'range="{low:.3f} {high:.3f}"', "slide": f'range="{low:.3f} {high:.3f}"', "ball": 'range="0 1.2"'}[kind]
        straight = (
            ""
            if kind == "ball"
            else f'axis="{vector()}" ' + some(ref=f"{random.uniform(-1, 1):.3f}", springref="0.2", actuatorfrcrange="-3 5")
        )
        more = some(
            armature=positive(),
            damping=positive(),
            frictionloss=positive(),
            stiffness="3",
            margin="0.01",
            group="3",
            solreflimit="0.03 0.8",
        )
        return f'<joint {named("joint")} type="{kind}" pos="{vector()}" {straight} {more} {limits if random.random() < 0.6 else ""}/>'

    def geom() -> str:
        form = random.choice(
            ['size="0.1"', 'type="box" size="0.1 0.2 0.3"', 'type="capsule" size="0.1 0.2"', 'type="cylinder" size="0.1 0.2"']
        )
        more = some(condim="4", friction="0.5 0.01 0.001", margin="0.01", solref="0.03 1", group="1", priority="2", rgba="0.1 0.2 0.3 0.4")
        bits = random.choice(["", 'contype="0" conaffinity="0"', 'contype="2"', 'conaffinity="0"'])
        return f'<geom {named("geom")} {form} pos="{vector()}" euler="{vector()}" {more} {bits} mass="{positive()}"/>'

    def body(depth: int) -> str:
        rows = [f'<body {named("body")} pos="{vector()}" quat="{vector(1, 4)}" {some(gravcomp="0.5")}>']
        kinds = random.choice(["", "hinge", "slide", "ball", "hinge hinge", "slide hinge", "slide slide slide hinge", "ball slide"])
        rows += [joint(kind) for kind in kinds.split()]
        rows += [geom() for _ in range(random.integers(1, 3))]
        rows += [f'<site {named("site")} pos="{vector()}"/>' for _ in range(random.integers(0, 2))]
        rows += [f'<camera pos="{vector()}"/>'] * (random.random() < 0.2)
        rows += [body(depth + 1) for _ in range(random.integers(0, 3) if depth < 3 else 0)]
        return "".join([*rows, "</body>"])

    bodies = "".join(body(0) for _ in range(2))
    actuators = "".join(f'<motor joint="{name}" gear="{positive()}"/>' for name in names["joint"][::2] if "ö" not in name)
    sensors = "".join(f'<framepos objtype="site" objname="{name}"/>' for name in names["site"])
    apart = "".join(f'<exclude body1="{a}" body2="{b}"/>' for a, b in zip(names["body"], names["body"][1:], strict=False))
    return (
        f'<mujoco><compiler angle="radian"/><option {some(timestep="0.001", gravity="0 0 -1", density="1.2")}/><worldbody>{bodies}</worldbody>'
        f"<contact>{apart}</contact><actuator>{actuators}</actuator><sensor>{sensors}</sensor></mujoco>"
    )


@pytest.mark.parametrize("target", ["mjcf", "urdf"])
@pytest.mark.parametrize("seed", range(6))
def test_random_mjcf_files_are_converted_without_a_silent_difference(seed: int, target: str, tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(random_mjcf(np.random.default_rng(seed)))
    result = examine(tmp_path / "a.xml", target, tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result
    if target == "mjcf":
        assert result["named"] == []
        assert result["idle"] == []


@pytest.mark.parametrize("target", ["mjcf", "urdf"])
@pytest.mark.parametrize("seed", range(4))
def test_random_urdf_files_are_converted_without_a_silent_difference(seed: int, target: str, tmp_path: Path) -> None:
    (tmp_path / "a.urdf").write_text(random_urdf(np.random.default_rng(seed)))
    result = examine(tmp_path / "a.urdf", target, tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result


def looped_mjcf(random: np.random.Generator) -> str:
    """Return chains of hinges and slides whose bodies are welded and pinned to others, or to the world, where they stand in the file."""
    rows, bodies = [], ["world"]
    for chain in range(random.integers(1, 4)):
        depth = int(random.integers(1, 4))
        for _ in range(depth):
            bodies.append(f"b{len(bodies)}")
            pos, axis = (" ".join(f"{x:.3f}" for x in random.uniform(-0.3, 0.3, 3)) for _ in range(2))
            kind = random.choice(["hinge", "slide"])
            rows.append(
                f'<body name="{bodies[-1]}" pos="{pos}" euler="10 20 {chain}"><joint name="j{len(bodies)}" type="{kind}" axis="{axis}" range="-1 1"/>'
                '<geom size="0.05" mass="1"/>'
            )
        rows.append("</body>" * depth)
    ties = []
    for _ in range(random.integers(1, 4)):
        one, other = random.choice(bodies, 2, replace=False)
        ties.append(
            f'<weld body1="{one}" body2="{other}"/>'
            if random.random() < 0.7
            else f'<connect body1="{one}" body2="{other}" anchor="0 0 0"/>'
        )
    return f"<mujoco><worldbody>{''.join(rows)}</worldbody><equality>{''.join(ties)}</equality></mujoco>"


@pytest.mark.parametrize("target", ["mjcf", "urdf"])
@pytest.mark.parametrize("seed", range(6))
def test_the_joints_of_a_file_carry_its_bodies_whatever_is_welded(seed: int, target: str, tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(looped_mjcf(np.random.default_rng(seed)))
    result = examine(tmp_path / "a.xml", target, tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result


@pytest.mark.parametrize("kind", ["hinge", "slide"])
def test_a_loop_of_a_single_freedom_is_read(kind: str, tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(
        f'<mujoco><worldbody><body name="a"><joint type="{kind}"/><geom size="0.1"/></body></worldbody><equality><weld body1="a" '
        f'relpose="0 0 {0.1 if kind == "slide" else 0} 1 0 0 {0.2 if kind == "hinge" else 0}"/></equality></mujoco>'
    )
    result = examine(tmp_path / "a.xml", "mjcf", tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result


def test_room_for_keys_is_no_loss(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text('<mujoco><size nkey="3"/><worldbody><body><joint/><geom size="0.1"/></body></worldbody></mujoco>')
    result = examine(tmp_path / "a.xml", "mjcf", tmp_path / "out", tmp_path)

    assert (result.get("silent"), result.get("rows")) == ([], 0), result


def test_limits_that_are_said_and_plugins_come_back(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(
        '<mujoco><compiler autolimits="false"/><extension><plugin plugin="mujoco.pid"><instance name="i"><config key="kp" value="4"/></instance>'
        '</plugin><plugin plugin="mujoco.sensor.touch_grid"/></extension><worldbody><body name="a"><joint name="j" range="-30 40" limited="true"/>'
        '<geom size="0.1"/><site name="s"/><body name="b"><joint name="k" range="-1 1" limited="false"/><geom size="0.1"/></body></body></worldbody>'
        '<actuator><motor joint="j" ctrlrange="-1 1" ctrllimited="true"/><plugin joint="j" plugin="mujoco.pid" instance="i"/>'
        '<plugin joint="k" plugin="mujoco.pid"><config key="kp" value="3"/></plugin></actuator>'
        '<sensor><plugin name="t" plugin="mujoco.sensor.touch_grid" objtype="site" objname="s"><config key="size" value="3 3"/>'
        '<config key="fov" value="45 45"/><config key="gamma" value="0"/><config key="nchannel" value="1"/></plugin></sensor></mujoco>'
    )
    result = examine(tmp_path / "a.xml", "mjcf", tmp_path / "out", tmp_path)

    assert (result.get("silent"), result.get("rows")) == ([], 0), result
    assert "extension" in str(examine(tmp_path / "a.xml", "urdf", tmp_path / "out", tmp_path)["idle"])


def tied_urdf(random: np.random.Generator) -> str:
    """Return a tree with masses that stand still, stars of mimics in any order, limits at any distance and shapes with names."""

    def inertial() -> str:
        return (
            f'<inertial><origin xyz="0.01 0 {random.uniform(0, 0.1):.3f}"/><mass value="{random.uniform(0.1, 3):.3f}"/>{INERTIA}</inertial>'
        )

    def shape(number: int) -> str:
        words = f'<capsule name="rod {number}"/>' if random.random() < 0.5 else ""  # makes a capsule of it, for Pinocchio
        form = '<geometry><cylinder radius="0.1" length="0.3"/></geometry>'
        return f'<collision name="rod {number}">{form}</collision><visual>{form}</visual><collision_checking>{words}</collision_checking>'

    count = 9
    leaders, alone = np.split(random.choice(np.arange(1, count), 4, replace=False), 2)
    rows = [f'<robot name="tied"><link name="l0">{inertial()}{shape(0)}</link><link name="foot">{inertial()}</link>']
    rows.append('<joint name="stands" type="fixed"><parent link="l0"/><child link="foot"/><origin xyz="0 0.1 -0.2" rpy="0.3 0 0"/></joint>')
    for index in range(1, count):
        low, high = random.choice([(0.0, 0.0), (0.5, 0.5), (-1e8, -1e8)] if index in alone else [(-1.0, 1.0), (-1e4, 1e16), (-1e7, 1e7)])
        ratio = f'multiplier="{random.choice([-1, 1, 0.5])}" offset="{random.choice([0, 0.1])}"'
        above = [*leaders, *(one for one in range(1, index) if one not in alone)]
        tie = f'<mimic joint="j{random.choice(above)}" {ratio}/>' if index not in [*leaders, *alone] else ""
        rows.append(
            f'<link name="l{index}">{inertial()}{shape(index)}</link><joint name="j{index}" type="{random.choice(["revolute", "prismatic"])}">'
            f'<parent link="l{random.integers(0, index)}"/><child link="l{index}"/><origin xyz="0.1 0 0.2"/><axis xyz="0 1 0"/>'
            f'<limit lower="{low}" upper="{high}" effort="3" velocity="2"/>{tie}</joint>'
        )
    return "".join([*rows, "</robot>"])


INERTIA = '<inertia ixx="0.2" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.25"/>'


@pytest.mark.parametrize("target", ["mjcf", "urdf"])
@pytest.mark.parametrize("seed", range(4))
def test_ties_far_limits_and_names_of_shapes_are_converted_without_a_silent_difference(seed: int, target: str, tmp_path: Path) -> None:
    (tmp_path / "a.urdf").write_text(tied_urdf(np.random.default_rng(seed)))
    result = examine(tmp_path / "a.urdf", target, tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result
    if target == "urdf":
        assert result["named"] == []


STANDS = [
    (r'name="l0"><inertial><origin xyz="0.01', 'name="l0"><inertial><origin xyz="0.02'),
    (r'(name="foot"><inertial>.*?<mass value=")', r"\g<1>1"),
    (r'name="stands"', 'name="stood"'),
    (r'(name="l1"><inertial>.*?ixx=")0.2', r"\g<1>0.21"),
    (r'<mimic joint="j\d" multiplier="', r"\g<0>1"),
    (r'upper="', 'upper="1'),
    (r'<collision name="rod 3"><geometry><cylinder radius="0.1"', '<collision name="rod 3"><geometry><cylinder radius="0.11"'),
]


@pytest.mark.parametrize("edit", STANDS, ids=lambda edit: edit[0])
def test_the_comparison_sees_every_edit_of_a_urdf(edit: tuple[str, str], tmp_path: Path) -> None:
    text = tied_urdf(np.random.default_rng(0))
    path = tmp_path / "a.urdf"
    path.write_text(text)
    before = facts_of(path, "urdf", tmp_path, both=True)
    path.write_text(re.sub(*edit, text, count=1))
    found = differences(before, facts_of(path, "urdf", tmp_path, both=True))

    assert found
    assert compare(found, []).silent == found


def test_a_row_names_only_the_field_that_it_is_about() -> None:
    limit = Difference("joint", "j", "l", "limit", "-1 1", "-2 2")
    velocity = Difference("joint", "j", "l", "velocity", "3", "inf")
    row = Row("joints.j", "metadata; MJCF has no limit on a joint's velocity")

    assert names_it(velocity, row)
    assert not names_it(limit, row)
    assert not names_it(limit, Row("joints.j", TABLE["effort.zero"]["mjcf"].lost))
    assert not names_it(Difference("shape", "l collision 0", "l", "type", "box", "mesh"), Row("parts.l", "nothing; group 3 of geom 'l'"))


# ---------------------------------------------------------------------- what moves

PENDULUM = """<mujoco><option timestep="0.001"/><worldbody><body name="a" pos="0.1 0 1" euler="0 80 0">
 <joint name="j" axis="0 1 0" pos="0 0 0.1" ref="10" damping="0.02" armature="0.01" frictionloss="0.001"/>
 <geom type="capsule" fromto="0 0 0 0 0 -.4" size=".02" contype="0" conaffinity="0"/></body></worldbody></mujoco>"""

FOUR_BAR = """<mujoco><option timestep="0.001" integrator="implicitfast"/><default><geom contype="0" conaffinity="0" type="capsule" size="0.01"/></default>
<worldbody><body name="crank" euler="0 20 0"><joint name="drive" axis="0 1 0"/><geom fromto="0 0 0 0.1 0 0"/>
 <body name="coupler" pos="0.1 0 0" euler="0 -50 0"><joint name="b" axis="0 1 0" damping="0.001"/><geom fromto="0 0 0 0.3 0 0"/></body></body>
 <body name="rocker" pos="0.3 0 0" euler="0 -80 0"><joint name="d" axis="0 1 0" damping="0.001"/><geom fromto="0 0 0 0.2 0 0"/></body></worldbody>
<equality><connect name="c" body1="coupler" body2="rocker" anchor="0.3 0 0" solref="0.004 1"/></equality>
<actuator><velocity name="motor" joint="drive" kv="2"/></actuator></mujoco>"""


FREE_FALL = """<mujoco><option timestep="0.001" density="1.2"/><worldbody><body name="a" pos="0.1 0.2 5" euler="10 20 30"><freejoint name="f"/>
 <geom type="box" size="0.1 0.2 0.3" pos="0.1 0 0"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize("text", [FREE_FALL, PENDULUM, FOUR_BAR], ids=["free fall", "damped pendulum", "driven four-bar"])
def test_mujoco_moves_the_copy_as_the_original(text: str, tmp_path: Path) -> None:
    """All joints after one second, 1e-6 relative."""
    import mujoco

    from articad.formats import convert

    (tmp_path / "a.xml").write_text(text)
    _, bundle = convert(tmp_path / "a.xml", tmp_path / "b.xml")
    bundle.write(tmp_path / "out")
    ends: list[Any] = []
    for path in (tmp_path / "a.xml", tmp_path / "out" / bundle.main):
        model = mujoco.MjModel.from_xml_path(str(path))
        data = mujoco.MjData(model)
        data.ctrl[:] = 3.0
        while data.time < 1:
            mujoco.mj_step(model, data)
        names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint) for joint in range(model.njnt)]
        starts = [*model.jnt_qposadr.tolist(), model.nq]
        ends.append({name: np.array(data.qpos[starts[joint] : starts[joint + 1]]) for joint, name in enumerate(names)})

    assert ends[0].keys() == ends[1].keys()
    assert max(np.abs(value).max() for value in ends[0].values()) > 0.1
    for name, value in ends[0].items():
        assert ends[1][name] == pytest.approx(value, rel=1e-6), name


def test_a_body_that_has_its_mass_from_another_gets_none(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text("""<mujoco><worldbody><body><freejoint/><body><body name="b"><geom size="0.1"/></body></body></body>
      </worldbody></mujoco>""")
    result = examine(tmp_path / "a.xml", "mjcf", tmp_path / "out", tmp_path)

    assert (result.get("silent"), result.get("free"), result.get("idle")) == ([], [], []), result


def test_what_names_something_that_is_gone_is_a_row(tmp_path: Path) -> None:
    """An actuator of a joint that was taken out, the sensor of that actuator, and the key that counts it."""
    from dataclasses import replace

    from articad.export.mjcf import write_mjcf
    from articad.importers.mjcf import read_mjcf

    path = tmp_path / "a.xml"
    path.write_text("""<mujoco><worldbody><body name="a"><joint name="j" axis="0 0 1"/><geom size="0.1"/><site name="s"/></body></worldbody>
      <actuator><motor name="m" joint="j"/><motor name="n" site="s"/></actuator><sensor><actuatorfrc name="f" actuator="m"/><touch name="t" site="s"/></sensor>
      <keyframe><key name="k" ctrl="1 2"/></keyframe></mujoco>""")
    assembly = read_mjcf(path)
    text = write_mjcf(assembly).files["a.xml"].decode()
    assert all(f'name="{name}"' in text for name in ("m", "n", "f", "t", "k"))

    without = replace(assembly, kept=tuple(replace(item, xml=item.xml.replace('joint="j"', 'joint="gone"')) for item in assembly.kept))
    bundle = write_mjcf(without)
    text = re.sub(r"<text.*", "", bundle.files["a.xml"].decode())

    assert [f'name="{name}"' in text for name in ("m", "n", "f", "t", "k")] == [False, True, False, True, False]
    lost = " ".join(loss.lost for loss in bundle.losses)
    assert all(f"'{name}'" in lost for name in ("m", "f", "k"))


# ---------------------------------------------------------------------- every attribute of MuJoCo's schema

VALUES = {
    # by attribute: a value that is not the usual one; an attribute that is not here has none, and fails
    "actuatorfrclimited": "true", "actuatorfrcrange": "-3 5", "actuatorgravcomp": "true", "active": "false", "adhesion": "0.1", "align": "true",
    "ambient": "0.1 0.2 0.3", "armature": "0.1", "attenuation": "1 0.2 0.1", "axis": "1 2 3", "axisangle": "1 0 0 0.3", "bulbradius": "0.03",
    "castshadow": "false", "childclass": "other", "class": "other", "conaffinity": "2", "condim": "4", "contype": "2", "cutoff": "30",
    "damping": "0.2", "density": "300", "diffuse": "0.1 0.2 0.3", "dir": "1 0 -1", "directional": "true", "euler": "0.1 0.2 0.3",
    "exponent": "5", "fitscale": "1.5", "fluidcoef": "0.4 0.3 1.4 1 0.9", "fluidshape": "ellipsoid", "focal": "0.01 0.02",
    "focalpixel": "500 600", "fovy": "50", "friction": "0.5 0.01 0.001", "frictionloss": "0.1", "fromto": "0 0 0 0 0 1", "gap": "0.01",
    "gravcomp": "0.4", "group": "3", "intensity": "2", "ipd": "0.1", "limited": "true", "margin": "0.02", "mass": "3", "material": "paint",
    "mode": "track", "name": "called", "output": "depth", "pos": "0.1 0.2 0.3", "principal": "0.001 0.002", "principalpixel": "10 20",
    "priority": "2", "projection": "orthographic", "quat": "1 0.1 0.2 0.3", "range": "0.1 0.9", "ref": "0.2", "resolution": "320 240",
    "rgba": "0.1 0.2 0.3 0.4", "sensorsize": "0.01 0.02", "size": "0.3 0.2 0.1", "sleep": "never", "softness": "0.3", "solimp": "0.8 0.9 0.002 0.5 2",
    "solimpfriction": "0.8 0.9 0.002 0.5 2", "solimplimit": "0.8 0.9 0.002 0.5 2", "solmix": "2", "solref": "0.03 0.9",
    "solreffriction": "0.03 0.9", "solreflimit": "0.03 0.9", "specular": "0.2 0.3 0.4", "springdamper": "0.1 1", "springref": "0.3",
    "springyield": "0.1", "stiffness": "3", "surfacevel": "0.1 0.2 0.3", "target": "other", "type": "box", "user": "1 2", "xyaxes": "0 1 0 -1 0 0",
    "zaxis": "1 0 1",
}  # fmt: skip
ELSEWHERE = {  # values that another element needs
    ("joint", "type"): "slide", ("camera", "type"): "", ("light", "type"): "directional", ("light", "texture"): "", ("light", "range"): "7",
    ("camera", "mode"): "trackcom", ("freejoint", "name"): "called",
}  # fmt: skip
BESIDE = {  # what an attribute does nothing without
    "focal": 'sensorsize="0.01 0.02"', "focalpixel": 'sensorsize="0.01 0.02" resolution="320 240"', "principal": 'sensorsize="0.01 0.02" focal="0.01 0.01"',
    "principalpixel": 'sensorsize="0.01 0.02" focal="0.01 0.01" resolution="320 240"', "sensorsize": 'focal="0.01 0.02"',
    "fromto": 'type="capsule"',
    "actuatorfrclimited": 'actuatorfrcrange="-1 1"', "limited": 'range="-1 1"', "target": 'mode="targetbody"', "fluidcoef": 'fluidshape="ellipsoid"',
    "springref": 'stiffness="2"', "springyield": 'stiffness="2"', "surfacevel": 'condim="3"',
}  # fmt: skip
NO_VALUE = {("geom", "hfield"), ("geom", "mesh"), ("site", "mesh"), ("geom", "shellinertia"), ("light", "texture"), ("body", "mocap")} | {
    ("body", "fuse"),  # of the compiler: they change what is compiled, not what it says
    ("body", "simple"),
}


def schema_cases() -> list[tuple[str, str]]:
    from tests.importers.test_doors import mujoco_schema

    schema = mujoco_schema()
    return [(tag, name) for tag in ("joint", "freejoint", "geom", "site", "camera", "light") for name in sorted(schema[f"body/{tag}"])] + [
        ("body", name) for name in sorted(schema["body"])
    ]


@pytest.mark.parametrize(("tag", "name"), schema_cases(), ids=str)
def test_every_attribute_of_mujocos_schema_survives_or_is_a_row(tag: str, name: str, tmp_path: Path) -> None:
    if (tag, name) in NO_VALUE:
        return
    value = ELSEWHERE.get((tag, name)) or VALUES[name]
    said = f'{BESIDE.get(name, "")} {name}="{value}"'
    body, joint = (
        (said, "<joint/>")
        if tag == "body"
        else ("", {"joint": f"<joint {said}/>", "freejoint": f"<freejoint {said}/>"}.get(tag, "<joint/>"))
    )
    if (tag, name) == ("body", "sleep"):
        joint = "<freejoint/>"
    size = "" if name == "size" else 'size="0.3 0.2 0.1"'
    geom = f"<geom {size} {said}/>" if tag == "geom" else '<geom size="0.1"/>'
    extra = "" if tag not in {"site", "camera", "light"} else f"<{tag} {said}/>"
    (tmp_path / "a.xml").write_text(
        f"""<mujoco><compiler angle="radian" inertiafromgeom="true"/><default><default class="other"><joint damping="0.7"/><geom group="2"/><site group="2"/>
        <camera fovy="33"/><light cutoff="33"/></default></default><asset><material name="paint" rgba="0.1 0.2 0.3 0.5"/></asset>
        <worldbody><body name="other"/><body {body}>{joint}{geom}{extra}</body></worldbody></mujoco>"""
    )
    result = examine(tmp_path / "a.xml", "mjcf", tmp_path / "out", tmp_path)

    assert result.get("silent") == [], result
    assert result["named"] == []
    rows = [row for row in result["idle"] if name not in row and "material" not in row]
    assert rows == []
