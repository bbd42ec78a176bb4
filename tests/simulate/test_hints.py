"""Hints of simulations, followed literally: the model is changed as the hint says and nothing else; its finding is gone, and no error has come."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest

from articad.auditing.examine import AuditOptions, audit_file
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.findings import Finding, Findings
from articad.formats import convert
from articad.simulation.examine import simulate_assembly, simulate_file
from articad.simulation.trial import try_out
from articad.simulation.verdict import SimulationVerdict
from tests.assemblies import four_bar
from tests.obedience import assert_heals
from tests.simulate.slow import take
from tests.simulate.test_verdict import ARM, MODEL, TURN

pytestmark = pytest.mark.engines

PLAIN = {"world": "", "joint": "", "arm": ARM, "more": "", "bodies": "", "rest": ""}
BLOCK = '<body name="block" pos="0.1 {y} 0.5"><geom type="box" size="0.02 0.006 0.02" {solref}/></body>'
HARD = 'solref="0.0002 0.1"'
LEVER = 0.06  # m: the ball of a post is on this circle
CODES = {"E_SIM_LOAD", "E_SIM_EXPLODES", "E_SIM_UNSETTLED", "E_SIM_RANGE", "E_SIM_RESIDUAL", "E_SIM_ENERGY"}
CODES |= {"I_SIM_LOOPS_OPEN", "I_SIM_UNREAD", "W_SIM_NOT_TRIED"}


def model(folder: Path, step: str = 'timestep="0.002"', **fields: str) -> Path:
    path = folder / "model.xml"
    path.write_text(MODEL.replace('timestep="0.002"', step).format(**PLAIN | fields))
    return path


def tried(path: Path) -> Findings:
    return SimulationVerdict(str(path), (try_out("mujoco", path),)).findings


def hinted(found: Findings, code: str, words: str) -> tuple[Finding, re.Match[str]]:
    """Return the finding of a code and where its hint has these words."""
    matches = [(one, match) for one in found.of(code) if (match := re.search(words, one.hint))]
    assert matches, str(found)
    return matches[0]


def block(y: float, solref: str = "") -> str:
    return BLOCK.format(y=y, solref=solref)


def depth_of(path: Path) -> float:
    """Return how deep the audit says that parts overlap, in m."""
    (overlap,) = audit_file(path, AuditOptions(engines=False, budget=1.0)).findings.of("E_OVERLAP")
    match = re.search(r"Move one of them by ([\d.]+) mm", overlap.hint)
    assert match
    return float(match[1]) / 1000


def post(radius: float, angle: float = 0.8) -> str:
    x, y = LEVER * math.cos(angle), LEVER * math.sin(angle)
    return f'<body name="post" pos="{x} {y} 0.5"><geom type="sphere" size="{radius}"/></body>'


def test_a_model_that_does_not_load_loads_when_the_cause_that_the_audit_names_is_mended(tmp_path: Path) -> None:
    before = tried(model(tmp_path, arm='<site name="only"/>'))
    finding, _ = hinted(before, "E_SIM_LOAD", "Run `articad audit` on the file: it names the cause")
    named = str(audit_file(tmp_path / "model.xml").findings)
    assert "mass and inertia of moving bodies" in named
    assert "'arm'" in named
    weighed = '<inertial pos="0 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/>'
    assert_heals(finding, before, tried(model(tmp_path, arm=weighed)))


@pytest.mark.parametrize(
    ("process", "needs", "given"), [("articad.simulation.trial", 30.0, 20.0), ("articad.simulation.loading", 90.0, 20.0)]
)
def test_what_had_too_little_time_is_tried_with_more(
    process: str, needs: float, given: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = model(tmp_path)
    take(monkeypatch, process, needs)
    before = simulate_file(path, engines=("mujoco",), seconds=given).findings
    finding, _ = hinted(before, "W_SIM_NOT_TRIED", "with more `--seconds`")
    after = simulate_file(path, engines=("mujoco",), seconds=3600.0).findings
    assert_heals(finding, before, after)
    assert not after.of("W_SIM_NOT_TRIED")


@pytest.mark.parametrize(("code", "solref"), [("E_SIM_EXPLODES", HARD), ("E_SIM_UNSETTLED", "")])
def test_parts_that_push_each_other_rest_when_moved_as_far_as_the_audit_says(code: str, solref: str, tmp_path: Path) -> None:
    arm = ARM.replace("/>", f" {solref}/>")
    path = model(tmp_path, arm=arm, bodies=block(0.003, solref))
    before = tried(path)
    finding, _ = hinted(before, code, "[Oo]verlap at rest .*`articad audit`")
    after = tried(model(tmp_path, arm=arm, bodies=block(0.003 + 1.5 * depth_of(path), solref)))
    left = [one for one in after if one.code != "E_SIM_RANGE"]  # the block, which is apart at rest now, still stops the arm that turns
    assert_heals(finding, before, left)


@pytest.mark.parametrize(("code", "stiffness"), [("E_SIM_EXPLODES", 50), ("E_SIM_ENERGY", 5)])
def test_a_smaller_time_step_lets_the_integrator_follow_a_spring(code: str, stiffness: float, tmp_path: Path) -> None:
    joint = f'stiffness="{stiffness}" springref="0.5"'
    before = tried(model(tmp_path, 'timestep="0.002" integrator="RK4"', joint=joint))
    finding, _ = hinted(before, code, "[Uu]se a smaller time step")
    assert_heals(finding, before, tried(model(tmp_path, 'timestep="0.00005" integrator="RK4"', joint=joint)))


def test_damping_that_feeds_the_motion_is_found_where_the_hint_says(tmp_path: Path) -> None:
    before = tried(model(tmp_path, joint='damping="-0.0002"'))
    finding, _ = hinted(before, "E_SIM_ENERGY", "check inertias, springs and damping")
    assert_heals(finding, before, tried(model(tmp_path, joint='damping="0.0002"')))


@pytest.mark.parametrize(
    ("words", "bodies", "upper"), [("Add clearance", post(0.005, 1.3), 1.0), ("or narrow the range", post(0.005), 0.6)]
)
def test_a_joint_that_a_post_stops_reaches_its_range(words: str, bodies: str, upper: float, tmp_path: Path) -> None:
    before = tried(model(tmp_path, bodies=post(0.005)))
    finding, _ = hinted(before, "E_SIM_RANGE", words)
    path = model(tmp_path, bodies=bodies)
    path.write_text(path.read_text().replace('range="-1 1"', f'range="-1 {upper}"'))
    assert_heals(finding, before, tried(path))


def test_a_joint_that_a_spring_holds_reaches_its_range_without_it(tmp_path: Path) -> None:
    """A second constraint ties the joint to the world; nothing touches it."""
    tie = '<equality><joint joint1="turn" polycoef="0 0 0 0 0"/></equality>'
    before = tried(model(tmp_path, rest=tie))
    finding, _ = hinted(before, "E_SIM_RANGE", "Check for a limit, spring or constraint that stops it")
    assert_heals(finding, before, tried(model(tmp_path)))


def test_a_driver_of_the_range_that_its_loop_allows_reaches_it() -> None:
    before = simulate_assembly(four_bar(), "four_bar", engines=("mujoco",)).findings
    finding, _ = hinted(before, "E_SIM_RANGE", "Declare the range that the loop allows")
    free = four_bar().feasible_range("a")
    bounded = four_bar(crank=(free.lower, free.upper))
    assert_heals(finding, before, simulate_assembly(bounded, "four_bar", engines=("mujoco",)).findings)


ROD = (
    '<body name="rod" pos="0.11 0 0"><joint name="elbow" axis="0 0 1" range="-1.6 1.6"/>'
    '<geom type="box" size="0.09 0.004 0.004" pos="0.1 0 0"/><site name="tip" pos="0.2 0 0"/></body>'
)
SLIDER = '<body name="slider" pos="{x} 0 {z}"><joint name="slide" type="slide" axis="1 0 0" range="-0.2 0.01"/><geom type="sphere" size="0.004" contype="0" conaffinity="0"/><site name="pin"/></body>'  # fmt: skip
TIE = '<equality><connect name="c" site1="tip" site2="pin" {soft}/></equality>'
SOFT = 'solref="0.5 1" solimp="0.1 0.1 0.001"'


@pytest.mark.parametrize(
    ("words", "fault", "mended"),
    [("Let the loop close at rest", (0.503, ""), (0.5, "")), ("or stiffen its constraint", (0.5, SOFT), (0.5, ""))],
)
def test_a_loop_closed_or_stiffened_has_no_residual(
    words: str, fault: tuple[float, str], mended: tuple[float, str], tmp_path: Path
) -> None:
    def crank(z: float, soft: str) -> Findings:
        far = 0.312 if soft else 0.31  # a soft loop that is open along the slide
        return tried(model(tmp_path, more=ROD, bodies=SLIDER.format(x=far, z=z), rest=TIE.format(soft=soft)))

    before = crank(*fault)
    finding, _ = hinted(before, "E_SIM_RESIDUAL", words)
    assert_heals(finding, before, crank(*mended))


@pytest.mark.parametrize("write", [write_urdf, write_mjcf], ids=["urdf", "mjcf"])
def test_loops_that_a_file_or_an_engine_leaves_open_are_closed_by_mjcf_in_mujoco(write: Any, tmp_path: Path) -> None:
    """Of an MJCF, PyBullet leaves loops open as well."""
    bundle = write(four_bar())
    bundle.write(tmp_path)
    before = simulate_file(tmp_path / bundle.main).findings
    finding, _ = hinted(before, "I_SIM_LOOPS_OPEN", "Simulate the MJCF in MuJoCo, which closes them")
    again = write_mjcf(four_bar())
    again.write(tmp_path)
    assert not simulate_file(tmp_path / again.main, engines=("mujoco",)).findings.of(finding.code)


def test_a_urdf_of_the_model_is_read_where_its_mjcf_is_not(tmp_path: Path) -> None:
    pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
    path = tmp_path / "model.xml"
    path.write_text(TURN.format('fullinertia="0.01 0.01 0.01 0 0 0"', "", ""))
    before = simulate_file(path).findings
    finding, _ = hinted(before, "I_SIM_UNREAD", "Simulate a URDF of the model in PyBullet")
    convert(path, tmp_path / "model.urdf")
    assert_heals(finding, before, simulate_file(tmp_path / "model.urdf", engines=("pybullet",)).findings)
