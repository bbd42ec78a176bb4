"""Simulators say whether a model loads, stands, reaches its ranges, keeps its loops and its energy; each failure has a model of its own."""

from __future__ import annotations

import io
import math
import os
import sys
from pathlib import Path

import pytest
from PIL import Image

from articad.assembly import Assembly
from articad.importers.mjcf import read_mjcf
from articad.plan.schema import AssemblyPlan
from articad.simulation.examine import simulate_assembly, simulate_file
from articad.simulation.film import film
from articad.simulation.loading import Engine, load_in_all
from articad.simulation.trial import try_out
from articad.simulation.verdict import SHARE, SimulationVerdict
from tests.assemblies import all_joint_kinds, four_bar

pytestmark = pytest.mark.engines

ROOT = Path(__file__).resolve().parents[2]
ARM = '<geom type="box" size="0.05 0.005 0.005" pos="0.06 0 0"/>'
MODEL = """<mujoco><compiler angle="radian" autolimits="true"/><option timestep="0.002"/>
<worldbody>{world}<body name="arm" pos="0 0 0.5"><joint name="turn" axis="0 0 1" range="-1 1" {joint}/>{arm}{more}</body>{bodies}</worldbody>{rest}</mujoco>"""


def verdict_on(
    folder: Path, *, world: str = "", joint: str = "", arm: str = ARM, more: str = "", bodies: str = "", rest: str = ""
) -> SimulationVerdict:
    path = folder / "model.xml"
    path.write_text(MODEL.format(world=world, joint=joint, arm=arm, more=more, bodies=bodies, rest=rest))
    return SimulationVerdict(str(path), (try_out("mujoco", path),))


def test_a_sound_model_stands_and_moves(tmp_path: Path) -> None:
    verdict = verdict_on(tmp_path)

    assert verdict.ok, str(verdict.findings)
    (outcome,) = verdict.outcomes
    (reach,) = outcome.reaches
    assert reach.share == pytest.approx(1.0, abs=1e-3)
    assert outcome.speed_at_rest < 1e-9
    assert outcome.energy_growth is not None
    assert outcome.energy_growth <= 1e-3


def test_a_post_stops_a_joint_where_geometry_says(tmp_path: Path) -> None:
    """A ball of radius 5 mm at 60° on a circle of 60 mm: the arm, 5 mm to either side, meets it 10 mm before."""
    angle = 0.8
    x, y = 0.06 * math.cos(angle), 0.06 * math.sin(angle)
    verdict = verdict_on(tmp_path, bodies=f'<body name="post" pos="{x} {y} 0.5"><geom type="sphere" size="0.005"/></body>')

    (finding,) = verdict.findings
    (reach,) = verdict.outcomes[0].reaches
    assert finding.code == "E_SIM_RANGE"
    assert finding.cause == "collision"
    assert set(finding.parts) == {"arm", "post"}
    assert reach.high == pytest.approx(angle - math.asin(10 / 60), abs=0.03)
    assert finding.value == pytest.approx(100 * (reach.high + 1) / 2, abs=0.1)
    assert not verdict.ok


def test_a_post_out_of_the_way_does_not(tmp_path: Path) -> None:
    assert verdict_on(tmp_path, bodies='<body name="post" pos="0 0.06 0.5"><geom type="sphere" size="0.005"/></body>').ok


def test_overlap_at_rest_pushes(tmp_path: Path) -> None:
    block = '<body name="block" pos="0.1 0.003 0.5"><geom type="box" size="0.02 0.006 0.02"/></body>'
    verdict = verdict_on(tmp_path, bodies=block)

    assert {"E_SIM_UNSETTLED", "E_SIM_RANGE", "E_SIM_EXPLODES"} & set(verdict.findings.codes)
    assert not verdict.ok


def test_a_loop_that_does_not_close_has_a_residual(tmp_path: Path) -> None:
    rod = '<body name="rod" pos="0.11 0 0"><joint name="elbow" axis="0 0 1" range="-1 1"/><geom type="box" size="0.03 0.004 0.004" pos="0.03 0 0"/></body>'
    closed = '<equality><connect body1="rod" body2="world" anchor="0.06 0 {off}"/></equality>'
    apart = '<equality><connect name="c" site1="tip" site2="pin"/></equality>'
    tip = rod.replace("</body>", '<site name="tip" pos="0.06 0 0"/></body>')

    good = verdict_on(tmp_path, more=rod, rest=closed.format(off=0))
    bad = verdict_on(tmp_path, more=tip, world='<site name="pin" pos="0.17 0 0.503"/>', rest=apart)

    assert "E_SIM_RESIDUAL" not in good.findings.codes
    (finding,) = bad.findings.of("E_SIM_RESIDUAL")
    assert finding.value == pytest.approx(3.0, rel=0.05)


def test_a_driver_reaches_its_range_however_much_its_followers_weigh(tmp_path: Path) -> None:
    """A feather turns a flywheel at 1 : 60: the inertia that it feels is far more than its own."""
    wheel = (
        '<body name="wheel" pos="0.3 0 0.5"><joint name="wheel" axis="0 0 1"/><geom type="cylinder" size="0.05 0.002" mass="0.2"/></body>'
    )
    gear = '<equality><joint joint1="wheel" joint2="turn" polycoef="0 60 0 0 0"/></equality>'
    path = tmp_path / "model.xml"
    path.write_text(MODEL.format(world="", joint="", arm=ARM, more="", bodies=wheel, rest=gear))

    (outcome,) = SimulationVerdict(str(path), (try_out("mujoco", path, drivers=("turn",)),)).outcomes
    shares = {reach.joint: reach.share for reach in outcome.reaches}
    assert not outcome.exploded
    assert shares["turn"] >= 0.99
    assert outcome.top_speed < 100


SCREW = """<robot name="press"><link name="bed"/>
<link name="nut"><inertial><mass value="0.65"/><inertia ixx="4e-4" iyy="4e-4" izz="4e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="dial"><inertial><mass value="0.05"/><inertia ixx="4e-6" iyy="4e-6" izz="7e-6" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="spindle"><inertial><mass value="0.4"/><inertia ixx="4e-3" iyy="4e-3" izz="5e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="bed"/><child link="nut"/><axis xyz="1 0 0"/>
<limit lower="0.003" upper="0.055" effort="20" velocity="1"/><mimic joint="turn" multiplier="0.0006" offset="0.03"/></joint>
<joint name="turn" type="revolute"><parent link="bed"/><child link="spindle"/><axis xyz="1 0 0"/>
<limit lower="-40" upper="40" effort="2" velocity="20"/></joint>
<joint name="gauge" type="continuous"><parent link="bed"/><child link="dial"/><axis xyz="0 0 1"/>
<limit effort="1" velocity="9"/><mimic joint="slide" multiplier="20" offset="0"/></joint></robot>"""


def test_a_screw_is_driven_by_its_spindle_over_all_its_turns(tmp_path: Path) -> None:
    """A follower has no drive: driven through its nut, a spindle of 0.6 mm per radian would turn 1,600 times as fast."""
    path = tmp_path / "press.urdf"
    path.write_text(SCREW)

    verdict = simulate_file(path)

    assert verdict.ok, [str(finding) for finding in verdict.findings]
    for outcome in verdict.outcomes:
        turn = next(reach for reach in outcome.reaches if reach.joint == "turn")
        assert (turn.low, turn.high) == pytest.approx((-40, 40), abs=0.5)
    (mujoco, _) = verdict.outcomes
    reaches = {reach.joint: reach for reach in mujoco.reaches}
    assert reaches["slide"].high - reaches["slide"].low == pytest.approx(0.0006 * 80, rel=0.01)
    assert reaches["gauge"].high - reaches["gauge"].low == pytest.approx(20 * 0.0006 * 80, rel=0.01)


def test_an_equality_says_which_joint_follows_where_drivers_are_unknown(tmp_path: Path) -> None:
    nut = '<body name="nut" pos="0.3 0 0.5"><joint name="nut" type="slide" axis="1 0 0"/><geom type="box" size="0.02 0.02 0.02"/></body>'
    screw = '<equality><joint joint1="nut" joint2="turn" polycoef="0 0.0006 0 0 0"/></equality>'
    (outcome,) = verdict_on(tmp_path, bodies=nut, rest=screw).outcomes

    assert not outcome.exploded
    assert [reach.share >= SHARE for reach in outcome.judged] == [True]


def test_a_spring_that_pushes_away_gains_energy(tmp_path: Path) -> None:
    """Damping below zero does what no hinge does: it feeds the motion."""
    verdict = verdict_on(tmp_path, joint='damping="-0.0002"')

    assert "E_SIM_ENERGY" in verdict.findings.codes
    assert not verdict.ok


def test_a_model_without_mass_does_not_load(tmp_path: Path) -> None:
    verdict = verdict_on(tmp_path, arm='<site name="only"/>')

    (finding,) = verdict.findings
    assert finding.code == "E_SIM_LOAD"
    assert "mass and inertia" in finding.message
    assert verdict.outcomes[0].loads is False


def test_numbers_that_go_wild_are_an_explosion(tmp_path: Path) -> None:
    """A heavy pendulum on a feather, at a time step that no integrator survives."""
    chain = '<body pos="0.1 0 0"><joint axis="0 1 0" stiffness="1e7"/><geom type="sphere" size="0.001" density="1"/></body>'
    path = tmp_path / "model.xml"
    path.write_text(
        '<mujoco><option timestep="0.05" integrator="RK4"/><worldbody><body><joint axis="0 1 0" springref="90" stiffness="1e6"/>'
        f'<geom type="sphere" size="0.01"/>{chain}</body></worldbody></mujoco>'
    )

    verdict = SimulationVerdict(str(path), (try_out("mujoco", path),))

    assert not verdict.ok
    assert {"E_SIM_EXPLODES", "E_SIM_UNSETTLED"} & set(verdict.findings.codes)


def test_our_own_exports_are_driven_and_filmed_and_a_crank_that_cannot_turn_round_is_told() -> None:
    """The crank of this linkage is endless in its declaration only: its dead points are at -67° and 67°, says kinematics."""
    assembly = four_bar()
    free = assembly.feasible_range("a")

    verdict = simulate_assembly(assembly, "four_bar", engines=("mujoco",))

    (outcome,) = verdict.outcomes
    (reach,) = outcome.judged
    assert outcome.residual < 1e-6
    assert verdict.findings.codes == ("E_SIM_RANGE",)
    assert (reach.joint, reach.role) == ("a", "driver")
    assert reach.high == pytest.approx(free.upper, abs=0.02)
    assert reach.allowed == pytest.approx((assembly.mechanism.rest[0], free.upper))
    assert "Declare the range that the loop allows" in verdict.findings[0].hint
    strip = film(assembly, outcome)
    assert strip is not None
    assert Image.open(io.BytesIO(strip)).width > 240


@pytest.mark.slow
def test_each_joint_of_a_loop_is_held_to_what_its_drivers_bring_it_to() -> None:
    """A clamp has two: its handle moves arm and link, its spindle turns and travels by its lead; both are driven, the others follow."""
    folder = ROOT / "examples/toggle_clamp"
    assembly = Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")
    arm = assembly.drive("handle", *(getattr(assembly.feasible_range("handle"), side) for side in ("lower", "upper")))

    verdict = simulate_assembly(assembly, "toggle_clamp", engines=("mujoco",))

    assert verdict.ok, str(verdict.findings)
    reaches = {reach.joint: reach for reach in verdict.outcomes[0].judged}
    assert {name: reach.role for name, reach in reaches.items()} == {
        "handle": "driver",
        "rear_pin": "follower",
        "arm": "follower",
        "spindle__t": "follower",
        "spindle__r": "driver",
    }
    angles = arm.configuration["arm"][:, 0]
    assert (reaches["arm"].lower, reaches["arm"].upper) == pytest.approx((angles.min(), angles.max()), abs=1e-3)
    assert reaches["spindle__t"].upper == pytest.approx(2 * 1.25e-3)  # two turns of its lead, which are its range
    assert all(reach.share > 0.99 for reach in reaches.values())


@pytest.mark.slow
def test_the_other_drivers_of_a_loop_are_held_while_one_is_driven() -> None:
    """Six legs carry a platform on balls; whoever lets five of them go, or holds a ball by one of its axes, does not move the sixth."""
    folder = ROOT / "examples/stewart_platform"
    assembly = Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")

    verdict = simulate_assembly(assembly, "stewart_platform", engines=("mujoco",))

    assert verdict.ok, str(verdict.findings)
    judged = verdict.outcomes[0].judged
    assert sorted(reach.role for reach in judged) == ["driver"] * 6 + ["follower"] * 12
    assert all(reach.share > 0.99 for reach in judged)


def test_one_loop_does_not_answer_for_another_nor_a_follower_for_its_driver(tmp_path: Path) -> None:
    """Two geared pairs; a post is in the way of the second: joint by joint where drivers are unknown, the driver where they are known."""
    pair = '<body name="{n}" pos="{x} 0 0.5"><joint name="{n}" axis="0 0 1" range="-1 1"/>' + ARM + "</body>"
    names = {"b": 0.3, "c": 0.6, "d": 0.9}
    bodies = "".join(pair.format(n=name, x=x) for name, x in names.items())
    bodies += f'<body name="post" pos="{0.6 + 0.06 * math.cos(0.8)} {0.06 * math.sin(0.8)} 0.5"><geom type="sphere" size="0.005"/></body>'
    tie = '<joint joint1="{0}" joint2="{1}" polycoef="0 1 0 0 0" solref="0.004 1"/>'
    rest = f"<equality>{tie.format('b', 'turn')}{tie.format('d', 'c')}</equality>"

    verdict = verdict_on(tmp_path, bodies=bodies, rest=rest)
    known = SimulationVerdict("known", (try_out("mujoco", tmp_path / "model.xml", drivers=("turn", "c")),))

    assert [reach.role for reach in verdict.outcomes[0].reaches] == ["tied"] * 4
    assert [reach.joint in {"c", "d"} for reach in verdict.outcomes[0].judged] == [False, True]
    for one in (verdict, known):
        (finding,) = one.findings
        assert finding.code == "E_SIM_RANGE"
    assert {reach.joint: reach.role for reach in known.outcomes[0].reaches} == {
        "turn": "driver",
        "b": "follower",
        "c": "driver",
        "d": "follower",
    }
    assert {reach.joint for reach in known.outcomes[0].judged} == {"turn", "b", "c"}
    assert known.findings[0].where == "joints.c"


def test_every_kind_of_joint_is_held_and_driven() -> None:
    verdict = simulate_assembly(all_joint_kinds(), "kinds", engines=("mujoco",))

    (outcome,) = verdict.outcomes
    assert outcome.loads
    assert not outcome.exploded
    assert outcome.residual < 1e-4
    assert len(outcome.reaches) >= 10


@pytest.mark.parametrize(
    ("limits", "span"), [('lower="0.3" upper="1.2"', (0.3, 1.2)), (None, (0.0, 2 * math.pi))], ids=["hinge", "endless"]
)
def test_bullet_holds_a_model_and_drives_its_joints(limits: str | None, span: tuple[float, float], tmp_path: Path) -> None:
    """Also one whose range does not hold zero, where PyBullet would place it."""
    pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
    inertial = '<inertial><mass value="0.2"/><inertia ixx="1e-4" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>'
    shape = '<geometry><box size="0.1 0.01 0.01"/></geometry>'
    kind, limit = ("revolute", f'<limit {limits} effort="5" velocity="3"/>') if limits else ("continuous", "")
    path = tmp_path / "model.urdf"
    path.write_text(
        f'<robot name="arm"><link name="base">{inertial}</link><link name="arm">{inertial}<collision>{shape}</collision></link>'
        f'<joint name="turn" type="{kind}"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>{limit}</joint></robot>'
    )

    verdict = simulate_file(path, engines=("pybullet",))

    (outcome,) = verdict.outcomes
    assert verdict.ok, str(verdict.findings)
    (reach,) = outcome.reaches
    assert (reach.lower, reach.upper) == pytest.approx(span)
    assert (reach.low, reach.high) == pytest.approx(span, abs=0.02)
    assert outcome.speed_at_rest < 1e-6


TURN = """<mujoco><compiler angle="radian" inertiafromgeom="false"/><worldbody><body name="base"><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><body name="arm">
  <joint name="turn" type="hinge" axis="0 1 0" limited="true" range="-1 2"/>
  <inertial pos="0 0 0.1" mass="1" {}/>{}</body></body></worldbody>{}</mujoco>"""


def test_a_link_whose_inertia_bullet_does_not_read_is_told_and_nothing_is_tried(tmp_path: Path) -> None:
    """PyBullet ignores `fullinertia`; a box that states its type gives the link an inertia."""
    pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
    path = tmp_path / "model.xml"

    path.write_text(TURN.format('fullinertia="0.01 0.01 0.01 0 0 0"', "", ""))
    verdict = simulate_file(path)
    assert [finding.code for finding in verdict.findings] == ["I_SIM_UNREAD"]
    assert "PyBullet reads no inertia of arm" in str(verdict.findings)
    assert verdict.ok  # MuJoCo tried it
    assert not simulate_file(path, engines=("pybullet",)).ok

    path.write_text(TURN.format('fullinertia="0.01 0.01 0.01 0 0 0"', '<geom type="box" size="0.1 0.1 0.1"/>', ""))
    (outcome,) = simulate_file(path, engines=("pybullet",)).outcomes
    assert outcome.unread == ()
    assert len(outcome.reaches) == 1


def test_bullet_drives_the_range_of_an_mjcf_with_its_couplings_and_counts_the_loops_that_it_leaves_open(tmp_path: Path) -> None:
    pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
    path = tmp_path / "model.xml"
    geared = """<body name="wheel"><joint name="gear" type="hinge" axis="0 1 0" limited="true" range="-4 2"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/><site name="a"/></body>"""
    ties = """<equality><joint joint1="gear" joint2="turn" polycoef="0 -2 0 0 0"/><connect site1="a" site2="b"/></equality>"""
    path.write_text(TURN.format('diaginertia="0.01 0.01 0.01"', geared + '<site name="b"/>', ties))

    (outcome,) = simulate_file(path, engines=("pybullet",)).outcomes

    assert outcome.unread == ()
    assert outcome.open_loops == 1
    (reach,) = outcome.reaches  # the gear follows
    assert reach.joint == "turn"
    assert (reach.lower, reach.upper) == (-1, 2)
    assert reach.share > 0.999


def test_the_film_follows_what_the_engine_says(tmp_path: Path) -> None:
    verdict_on(tmp_path)
    outcome = try_out("mujoco", tmp_path / "model.xml")

    values = [frame.values["turn"] for frame in outcome.frames]
    assert min(values) == pytest.approx(-1, abs=0.02)
    assert max(values) == pytest.approx(1, abs=0.02)
    assert film(read_mjcf(tmp_path / "model.xml"), outcome) is not None
    assert SHARE == 0.99


@pytest.mark.skipif(sys.platform != "linux", reason="names are bytes there")
def test_a_folder_whose_name_is_no_text_is_no_fault_of_the_model(tmp_path: Path) -> None:
    """Engines take names as UTF-8; a build called its own files broken."""
    folder = tmp_path / os.fsdecode(b"a\xff")
    folder.mkdir()
    (folder / "arm.urdf").write_text('<robot name="arm"><link name="base"/></robot>')
    engines: tuple[Engine, ...] = ("mujoco", "pinocchio")
    assert [loading.loads for loading in load_in_all(folder / "arm.urdf", engines)] == [None, None]
