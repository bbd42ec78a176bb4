"""How far joints go, in the words that a judge reads: drivers and followers, in degrees and mm."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from articad.agents.travel import told_travels, travels
from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry.part import Part
from articad.kinematics import Coupling, Joint, JointLimits
from tests.assemblies import all_joint_kinds
from tests.kinematics.linkages import joint

CRANK, ROD = 30.0, 90.0  # mm


def lines(moved: Assembly) -> list[str]:
    return told_travels(travels(moved))


def assembly(*joints: Joint, couplings: tuple[Coupling, ...] = ()) -> Assembly:
    names = dict.fromkeys(name for one in joints for name in (one.parent, one.child))
    parts = [Part.without_geometry(name) for name in names]
    return Assembly.from_parts("moved", parts=parts, joints=joints, ground=joints[0].parent, couplings=couplings)


def press(rest: float) -> Assembly:
    """A crank that turns endlessly and pushes a ram through a rod, at rest where the crank stands at an angle [rad]."""
    at, turned = SE3.trans, SE3.rot_z
    sine = CRANK * math.sin(rest) / ROD
    along = CRANK * math.cos(rest) + ROD * math.cos(math.asin(sine))
    lean = -math.asin(sine)
    slide = SE3.from_rotation(SE3.rot_y(math.pi / 2).rotation)
    return assembly(
        joint("crank", "revolute", ("frame", at(0, 0, 0)), ("crank", at(0, 0, 0)), rest=[rest], driver=True),
        joint("big_end", "revolute", ("crank", at(CRANK, 0, 0)), ("rod", at(0, 0, 0)), rest=[lean - rest]),
        joint("small_end", "revolute", ("rod", at(ROD, 0, 0)), ("ram", turned(0.0)), rest=[-lean]),
        joint("slide", "slider", ("frame", slide), ("ram", slide), rest=[along], limits=[(0.0, 200.0)]),
    )


@pytest.mark.parametrize("rest", [0.0, 0.8217])
def test_what_follows_in_a_loop_is_told_with_its_stroke_wherever_the_crank_rests(rest: float) -> None:
    told = lines(press(rest))

    assert told[0] == "- crank: endless, drives"
    assert told[1] == "- big_end: turns 360 degrees in all, follows"
    lean = round(math.degrees(math.asin(CRANK / ROD)), 2)
    assert told[2] == f"- small_end: -{lean:g} to {lean:g} degrees, follows"
    assert told[3] == f"- slide: {ROD - CRANK:g} to {ROD + CRANK:g} mm, follows"


@pytest.mark.parametrize("rest", [0.0, 0.8217, math.pi / 2, math.pi])
def test_what_follows_needs_no_leeway_beyond_the_extremes_that_it_reaches(rest: float) -> None:
    """The design prompt promises that a crank turns endlessly even if its followers' limits are exactly how far they go."""
    lean = math.asin(CRANK / ROD)
    exact = {"slide": (ROD - CRANK, ROD + CRANK), "small_end": (-lean, lean)}
    limits = {name: JointLimits((low,), (high,)) for name, (low, high) in exact.items()}
    joints = [replace(one, limits=limits.get(one.name, one.limits)) for one in press(rest).joints]

    feasible = assembly(*joints).feasible_range("crank")
    assert (feasible.lower, feasible.upper) == (-math.inf, math.inf)
    assert len(feasible.findings) == 0


def test_what_a_coupling_moves_is_told_with_its_travel() -> None:
    at = SE3.trans
    pinion = joint("pinion", "revolute", ("body", at(0, 0, 0)), ("pinion", at(0, 0, 0)), limits=[(0.0, 1.5)])
    jaw = joint("jaw", "slider", ("body", at(0, 10, 0)), ("jaw", at(0, 0, 0)), limits=[(0.0, 30.0)])
    told = lines(assembly(pinion, jaw, couplings=(Coupling("rack", "rack", "pinion", "jaw", 10.0, 0.0),)))

    assert told == ["- pinion: 0 to 85.94 degrees, drives", "- jaw: 0 to 15 mm, follows"]


def test_every_kind_of_joint_that_drives_is_told_in_degrees_and_mm() -> None:
    told = lines(all_joint_kinds())

    assert "- head: swivels to 60 degrees from its axis, every way, turns -57.3 to 28.65 degrees about it, drives" in told
    assert "- drawer: 10 to 200 mm, drives" in told
    assert [line for line in told if "- rod." in line] == ["- rod.travel: -50 to 50 mm, drives", "- rod.angle: endless, drives"]
    assert [line for line in told if line.startswith("- puck.")][2] == "- puck.angle: endless, drives"
    assert "- cross.b: -28.65 to 40.11 degrees, drives" in told
    assert not [line for line in told if line.startswith("- fixed")]


@pytest.mark.parametrize(
    ("turned", "told"), [(math.pi / 2, "swivels to 22.92 degrees from its axis, turns"), (0.0, "turns -11.46 to 22.92")]
)
def test_a_ball_that_follows_is_told_by_how_far_it_tilts_and_turns(turned: float, told: str) -> None:
    at, axis = SE3.identity(), SE3.rot_y(turned)
    hinge = joint("hinge", "revolute", ("base", axis), ("arm", axis), limits=[(-0.2, 0.4)], driver=True)
    ball = joint("ball", "ball", ("base", at), ("arm", at))
    assert told in lines(assembly(hinge, ball))[1]


def test_a_travel_is_told_to_a_hundredth_however_long_it_is() -> None:
    at = SE3.identity()
    assert lines(assembly(joint("slide", "slider", ("base", at), ("tray", at), limits=[(-0.25, 1234.5)]))) == [
        "- slide: -0.25 to 1234.5 mm, drives"
    ]
