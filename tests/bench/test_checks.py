"""Every kind of check holds of a sound assembly, and refuses one that is wrong in its own way."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from types import MappingProxyType
from typing import Any

import manifold3d as m3
import numpy as np
import pytest
from pydantic import TypeAdapter

from articad import examples
from articad.assembly import Assembly
from articad.certificates.fits import CONTACT_MM
from articad.connectors import SE3
from articad.geometry import Part, box, cylinder
from articad.kinematics.joints import Coupling, Joint, JointLimits
from articad.plan.schema import AssemblyPlan
from articad_bench.checks import AnyCheck, Check
from articad_bench.path_checks import _endless, _straight
from articad_bench.reference import reference
from articad_bench.spacing_checks import spacings
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in
from tests.bench.wrong import VARIANTS, wrong_for
from tests.interference.mechanisms import manifold_mesh
from tests.kinematics.linkages import at, joint

pytestmark = pytest.mark.slow

HINGE: dict[str, Any] = {"type": "revolute", "axis": [0, 0, 1]}
DRAWER = [200, 484, 858]


def bound(name: str, kind: str) -> dict[str, Any]:
    """Return the check of a kind that binds a task to its reference."""
    ((_, task),) = tasks_in(TASKS, names=[name])
    (row,) = (check.model_dump() for check in task.checks if check.kind == kind)
    return row


CHECKS: list[tuple[str, dict[str, Any]]] = [
    ("wardrobe", {"kind": "parts", "number": [18, 18]}),
    ("desk_lamp", {"kind": "freedoms", "number": 7}),
    ("wardrobe", {"kind": "joints", "joint": HINGE, "number": [2, 2]}),
    ("wardrobe", {"kind": "joints", "joint": {"type": "slider"}, "number": [2, 2]}),
    ("wardrobe", {"kind": "size", "mm": [900, None, 1922]}),
    ("wardrobe", {"kind": "part_size", "mm": [None, None, 1800]}),
    ("wardrobe", {"kind": "part_size", "mm": DRAWER, "number": [1, 1], "above": [180, 400], "fill": 0.1}),
    ("wardrobe", {"kind": "part_size", "mm": DRAWER, "number": [2, 2], "fill": [0.05, 0.5]}),
    ("wardrobe", {"kind": "mass", "kg": [50, 80]}),
    ("wardrobe", {"kind": "solids"}),
    ("wardrobe", {"kind": "clear_at_rest"}),
    ("wardrobe", {"kind": "joined"}),
    ("wardrobe", {"kind": "clear_in_motion", "steps": 8}),
    ("slider_crank", {"kind": "certified", "seconds": 60}),
    ("four_bar", {"kind": "loops", "number": [1, 1]}),
    ("geared_four_bar", {"kind": "ratio", "driver": {"type": "revolute"}, "follower": {"type": "revolute"}, "ratio": 2}),
    ("scissor_lift", {"kind": "rise", "axis": "z", "mm": [50, 1000]}),
    ("slider_crank", {"kind": "gap", "joint": {"type": "revolute"}, "mm": [0.05, 0.5]}),
    ("wardrobe", {"kind": "captive", "number": [1, 18]}),
    ("slider_crank", {"kind": "made"}),
    ("slider_crank", {"kind": "moves", "joint": {"type": "slider"}, "volume": [0.01, 0.2], "size": [0.1, 0.4]}),
    ("toggle_clamp", {"kind": "simulates"}),
    ("four_bar", {"kind": "unchanged", "number": [8, 8]}),
    ("four_bar", {"kind": "unchanged", "number": [3, 3], "of": "moving bodies"}),
    ("four_bar", {"kind": "shifted", "axis": [1, 0, 0], "mm": [-0.1, 0.1], "number": [1, 99]}),
    ("toggle_clamp", {"kind": "holes", "diameter": 6.6, "number": [4, 4], "axis": [0, 0, 1], "through": True, "length": [6.9, 7.1]}),
    ("funnel_kitchen", {"kind": "passage", "diameter": 13, "axis": [0, 0, 1]}),
    ("heat_sink_nine_fins", {"kind": "section", "axis": "z", "at": 20, "pieces": [9, 9], "apart": [7, 7.2], "piece": [1.5, 100]}),
    ("pulley_v_80", {"kind": "section", "axis": "z", "at": 10, "pieces": [1, 1], "openings": [1, 1], "clear": [16, [18, 19]]}),
    ("toggle_clamp", {"kind": "section", "axis": "z", "at": 3, "still": True, "area": [7000, 7200]}),
    ("toggle_clamp", {"kind": "studs", "diameter": 12, "number": [1, 1]}),
    ("desk_lamp", {"kind": "wall", "mm": [1.8, 2.2], "number": [1, 1]}),
    ("wardrobe", {"kind": "volume", "cm3": [50000, 150000]}),
    ("mug_straight", {"kind": "holds", "ml": [320, 340]}),
    ("wardrobe", {"kind": "stands", "degrees": 10}),
    ("wardrobe", {"kind": "symmetric", "axis": "x"}),
    ("toggle_clamp", {"kind": "lead", "mm": 1.25}),
    ("slider_crank", {"kind": "travel", "joint": {"type": "slider"}, "by": [59.9, 60.1]}),
    ("peaucellier_board", {"kind": "straight", "mm": [90, 125], "off": 0.05}),
    ("wiper_tandem", {"kind": "level", "mm": [56, 68], "number": [1, 999]}),
    ("scissor_lift", {"kind": "floor"}),
    ("planetary_hoist", {"kind": "turns", "ratio": 4.5, "number": [1, 3]}),
    ("gears_18_36", {"kind": "meshes", "teeth": [18, 36]}),
    *(("hinge_pintle_gate", bound("hinge_pintle_gate", kind)) for kind in ("matter", "arranged", "handed", "upright")),
    ("photo_cabinet_card", bound("photo_cabinet_card", "outlined")),
    ("desk_lamp", {"kind": "extent", "side": "z", "mm": [300, 420]}),
    ("toggle_clamp", {"kind": "threads"}),
    ("plate_motor_mount", {"kind": "square", "mm": 31}),
    ("peaucellier_board", {"kind": "links", "mm": 70, "number": [4, 4]}),
    ("stool_step_two", {"kind": "put_together"}),
    ("desk_lamp", {"kind": "effort", "joint": {"type": "revolute", "span": [55, 65]}, "most": [0.05, 5]}),
    (
        "stool_step_two",
        {
            "kind": "carries",
            "kg": 150,
            "level": [449, 451],
            "top": [190, 390],
            "number": [1, 1],
            "stress": 12,
            "modulus": 9000,
            "anywhere": True,
        },
    ),
    ("scissor_lift", {"kind": "folds", "into": [400, 400, 200]}),
    ("wardrobe", {"kind": "passes", "opening": [620, 1930]}),
    ("slider_crank", {"kind": "stack", "plays": [{"joint": {"type": "revolute"}, "times": 2}], "mm": [0.2, 0.5]}),
    ("wardrobe", {"kind": "spaced", "mm": DRAWER, "axis": [0, 0, 1], "pitch": [203], "levels": 2}),
    ("wardrobe", {"kind": "ordered", "sizes": [[48, 48, 132], DRAWER, [11, 11, 32.7]], "axis": [0, 0, 1]}),
    ("wardrobe", {"kind": "turned", "mm": DRAWER, "alike": [2]}),
    ("wardrobe", {"kind": "reaches", "joint": {"type": "slider"}, "toward": [0, -1, 0], "mm": [360, 365], "number": [2, 2]}),
    ("wardrobe", {"kind": "holds", "ml": [5000, 200000], "joint": {"type": "slider"}, "number": [2, 2]}),
    ("wardrobe", {"kind": "weighs", "mm": DRAWER, "kg": [0.1, 9], "number": [2, 2]}),
    ("wardrobe", {"kind": "weighs", "joint": {"type": "slider"}, "kg": [0.1, 9], "number": [2, 2]}),
    ("brief_rack_crates", {"kind": "room", "mm": [400, 300, 280], "number": [3, 3]}),
    ("brief_table_bedside", {"kind": "room", "mm": [600, 380, 300], "at": "under"}),
    ("slider_crank", {"kind": "fitted", "diameter": 16, "play": [0.2, 0.4], "number": [1, 1]}),
    (
        "slider_crank",
        {"kind": "machined", "cm3": 2.3554, "rounds": [[10, 40, False, False, 0, 0, 0, 0, 1, 0], [5, 40, True, False, 0, 0, 0, 0, 1, 0]]},
    ),
    ("slider_crank", {"kind": "toleranced", "nominal": 10, "bore": "D10", "pin": "h9", "number": [1, 9]}),
]


@cache
def product(name: str) -> Assembly:
    """Return an example, or the reference of a task."""
    if name in examples.names():
        return Assembly.from_plan(AssemblyPlan.load(examples.folder(name)), examples.folder(name) / "parts")
    ((folder, task),) = tasks_in(TASKS, names=[name])
    return reference(folder, task)


def form(row: dict[str, Any]) -> Check:
    check: Check = TypeAdapter(AnyCheck).validate_python(row)
    return check


@pytest.mark.parametrize(("name", "row"), CHECKS, ids=[f"{row['kind']}-{name}" for name, row in CHECKS])
def test_a_check_holds_of_a_sound_assembly_and_refuses_a_wrong_one(name: str, row: dict[str, Any]) -> None:
    check, assembly = form(row), product(name)

    sound = check.judge(Subject(assembly, before=assembly))
    wrong = check.judge(wrong_for(check, assembly))

    assert sound.ok, sound
    assert not wrong.ok, wrong


def test_every_kind_of_check_is_shown_red() -> None:
    assert {row["kind"] for _, row in CHECKS} == set(VARIANTS)


@pytest.mark.parametrize(
    ("wanted", "fits"), [((10.1, 10.2, None), True), ((10.2, None, 10.1), True), ((None, 30, 30), False), ((30, 9.95, 10.15), True)]
)
def test_sides_that_are_nearly_alike_are_each_compared_with_their_own(wanted: tuple[float | None, ...], fits: bool) -> None:
    part = Part.from_mesh("block", box(9.95, 10.15, 30))
    check = form({"kind": "part_size", "mm": list(wanted)})

    assert check.judge(Subject(Assembly.from_parts("one", parts=[part], joints=[], ground="block"))).ok is fits


def of(*joints: Joint, sides: Mapping[str, float] = MappingProxyType({})) -> Subject:
    """Return small boxes that are joined like this, on the parent of the first joint."""
    names = dict.fromkeys(part for each in joints for part in (each.parent, each.child))
    parts = [Part.from_mesh(name, box(*[sides.get(name, 5)] * 3), density=1000) for name in names]
    return Subject(Assembly.from_parts("joined", parts=parts, joints=list(joints), ground=parts[0].name))


def test_lengths_of_links_are_between_the_lines_of_their_pins_and_the_centres_of_their_balls() -> None:
    """A crank of 30 and a bar of 80; where along its line a connector lies, and a part that is fixed to the bar, change nothing."""
    crank = joint("crank", "revolute", ("base", at(0)), ("crank", at(0)), limits=[(-9.0, 9.0)])
    pin = joint("pin", "revolute", ("crank", at(30, 0, 17)), ("bar", at(0, 0, 4)), limits=[(-9.0, 9.0)])
    held = joint("held", "fixed", ("bar", at(0)), ("head", at(0)))
    ball = joint("ball", "ball", ("head", at(80, 0, -13)), ("foot", at(0)))
    level = joint("level", "revolute", ("foot", SE3.rot_x(math.pi / 2) @ at(0)), ("shoe", at(0)), limits=[(-9.0, 9.0)])

    found = spacings(of(crank, pin, held, ball, level))

    assert {name: [round(mm, 9) for mm in apart] for name, apart in found.items()} == {"crank": [30.0], "bar": [80.0], "foot": [0.0]}


def test_skew_pins_are_as_far_apart_as_their_lines() -> None:
    upright = joint("upright", "revolute", ("base", at(0)), ("arm", at(0)), limits=[(-9.0, 9.0)])
    across = joint("across", "revolute", ("arm", at(40, 25, 60) @ SE3.rot_y(math.pi / 2)), ("hand", at(0)), limits=[(-9.0, 9.0)])

    assert spacings(of(upright, across)) == {"arm": [pytest.approx(25.0)]}


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("ends", [("lid", "handle"), ("handle", "lid")])
def test_what_a_joint_moves_does_not_depend_on_which_side_is_its_child(ends: tuple[str, str], closed: bool) -> None:
    """Seen from the ground, the handle is beyond its joint; if the handle is joined to the ground as well, its joint moves the handle or the lid."""
    lid = joint("lid", "revolute", ("base", at(0)), ("lid", at(0)), limits=[(-9.0, 9.0)])
    handle = joint("handle", "slider", (ends[0], at(0)), (ends[1], at(0)), limits=[(-9.0, 9.0)])
    closing = [joint("closing", "revolute", ("base", at(0)), ("handle", at(0)), limits=[(-9.0, 9.0)])] if closed else []
    subject = of(lid, handle, *closing, sides={"lid": 10, "base": 20})

    found = {
        part: form({"kind": "moves", "joint": {"type": "slider"}, "volume": [0.9 * cm3 / 9.125, 1.1 * cm3 / 9.125], "size": [0, 2]})
        .judge(subject)
        .ok
        for part, cm3 in {"handle": 0.125, "lid": 1.0, "base": 8.0}.items()
    }

    assert found == {"handle": True, "lid": closed, "base": False}


def test_which_of_two_coupled_parts_turns_faster_is_told_by_their_lengths() -> None:
    """The small one turns twice as fast as the large one."""
    joints = [joint(name, "revolute", ("base", at(x)), (name, at(0)), limits=[(-9.0, 9.0)]) for name, x in (("large", 0), ("small", 40))]
    parts = [Part.from_mesh(name, box(side, 5, 5), density=1000) for name, side in (("base", 90), ("large", 20), ("small", 8))]
    couplings = [Coupling("mesh", "gear", "large", "small", 2.0)]
    subject = Subject(Assembly.from_parts("hands", parts=parts, joints=joints, couplings=couplings, ground="base"))

    found = {longer: form({"kind": "turns", "ratio": 2.0, "longer": longer}).judge(subject).ok for longer in (None, False, True)}

    assert found == {None: True, False: True, True: False}


def test_a_ball_goes_from_side_to_side_of_its_cone() -> None:
    free = joint("ball", "ball", ("base", at(0)), ("head", at(0)))
    tilting = replace(free, limits=JointLimits(cone=math.radians(8.0)))
    check = {"kind": "joints", "joint": {"type": "ball", "span": [15, 17]}, "number": [1, 1]}

    assert form(check).judge(of(tilting)).ok
    assert not form(check).judge(of(free)).ok


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("lifted", [0.0, 0.05, 5.0])
@pytest.mark.parametrize(("bore", "fits"), [(8.2, True), (8.01, False), (9.0, False)])
def test_a_part_that_lies_on_a_shoulder_has_the_gap_of_its_pin(bore: float, fits: bool, lifted: float, turned: bool) -> None:
    """An eye with a bar drops over a pin: on its bracket, whose edges cross those of the bar, just above it or high above it."""
    pin = m3.Manifold.cylinder(62, 8, 8, 64) + m3.Manifold.cylinder(16, 15, 15, 64).translate([0, 0, -16])
    eye = m3.Manifold.cylinder(40, 15, 15, 64) + m3.Manifold.cube([60, 6, 40]).translate([0, -15, 0])
    eye -= m3.Manifold.cylinder(100, bore, bore, 64, center=True)
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("pin", pin), ("eye", eye))]
    ends = [("pin", at(0, 0, lifted)), ("eye", at(0))]
    hung = joint("hung", "cylindrical", *(ends[::-1] if turned else ends), limits=[(-9.0, 9.0), (-1.0, 1.0)])
    subject = Subject(Assembly.from_parts("hinge", parts=parts, joints=[hung], ground="pin"))

    judged = form({"kind": "gap", "joint": {"type": "cylindrical"}, "mm": [0.1, 0.3]}).judge(subject)

    assert judged.ok is fits, judged


def test_a_part_that_sits_in_its_shoulder_has_no_gap() -> None:
    """The eye overlaps its bracket by 0.5 mm: the play of its pin does not excuse it."""
    pin = m3.Manifold.cylinder(62, 8, 8, 64) + m3.Manifold.cylinder(16, 15, 15, 64).translate([0, 0, -15.5])
    eye = m3.Manifold.cylinder(40, 15, 15, 64) - m3.Manifold.cylinder(100, 8.2, 8.2, 64, center=True)
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("pin", pin), ("eye", eye))]
    hung = joint("hung", "revolute", ("pin", at(0)), ("eye", at(0)), limits=[(-1.0, 1.0)])
    subject = Subject(Assembly.from_parts("hinge", parts=parts, joints=[hung], ground="pin"))

    assert not form({"kind": "gap", "joint": {"type": "revolute"}, "mm": [0.1, 0.3]}).judge(subject).ok


@pytest.mark.parametrize("overlap", [-0.3 * CONTACT_MM, 0.0, 0.3 * CONTACT_MM])
def test_bodies_that_touch_have_no_gap_whatever_a_file_rounds(overlap: float) -> None:
    """An eye with much play lies on its shoulder."""
    pin = m3.Manifold.cylinder(62, 8, 8, 64) + m3.Manifold.cylinder(16, 15, 15, 64).translate([0, 0, -16 + overlap])
    eye = m3.Manifold.cylinder(40, 15, 15, 64) - m3.Manifold.cylinder(100, 9, 9, 64, center=True)
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("pin", pin), ("eye", eye))]
    hung = joint("hung", "revolute", ("pin", at(0)), ("eye", at(0)), limits=[(-1.0, 1.0)])
    subject = Subject(Assembly.from_parts("hinge", parts=parts, joints=[hung], ground="pin"))

    assert form({"kind": "gap", "joint": {"type": "revolute"}, "mm": [0, 0.5]}).judge(subject).ok


@pytest.mark.parametrize("kind", ["screw", "slider"])
@pytest.mark.parametrize(("bore", "fits"), [(4.15, True), (4.02, False), (4.6, False)])
def test_a_needle_that_is_drawn_shut_has_the_gap_of_its_bore(bore: float, fits: bool, kind: str) -> None:
    """Its cone is in its seat, where it has no play; it opens by 4 mm."""
    body = m3.Manifold.cylinder(60, 15, 15, 64).translate([0, 0, -25]) - m3.Manifold.cylinder(90, 3, 3, 64, center=True)
    body -= m3.Manifold.cylinder(90, bore, bore, 64)
    needle = m3.Manifold.cylinder(8, 0, 4, 64).translate([0, 0, -6]) + m3.Manifold.cylinder(60, 4, 4, 64).translate([0, 0, 2])
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("body", body), ("needle", needle))]
    opened = {"screw": (1.0, 8 * math.pi), "slider": (0.0, 4.0)}[kind]
    turned = joint("dose", kind, ("body", at(0)), ("needle", at(0)), limits=[(0.0, opened[1])], lead=opened[0])
    subject = Subject(Assembly.from_parts("valve", parts=parts, joints=[turned], ground="body"))

    assert form({"kind": "gap", "joint": {"type": kind}, "mm": [0.08, 0.22]}).judge(subject).ok is fits


@pytest.mark.parametrize(("high", "fits"), [(8.2, True), (8.0, False)])
def test_a_pin_that_is_tight_in_one_direction_has_no_gap(high: float, fits: bool) -> None:
    """A bore that is not round, on a shoulder."""
    pin = m3.Manifold.cylinder(62, 8, 8, 64) + m3.Manifold.cylinder(16, 15, 15, 64).translate([0, 0, -16])
    bore = m3.Manifold.cylinder(100, 8.2, 8.2, 64, center=True).scale([1, high / 8.2, 1])
    eye = m3.Manifold.cylinder(40, 15, 15, 64) - bore
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("pin", pin), ("eye", eye))]
    hung = joint("hung", "revolute", ("pin", at(0)), ("eye", at(0)), limits=[(-1.0, 1.0)])
    subject = Subject(Assembly.from_parts("hinge", parts=parts, joints=[hung], ground="pin"))

    assert form({"kind": "gap", "joint": {"type": "revolute"}, "mm": [0.1, 0.3]}).judge(subject).ok is fits


@pytest.mark.parametrize("bodies", [False, True])
@pytest.mark.parametrize(("thick", "fits"), [(7.8, True), (7.99, False), (7.0, False)])
def test_a_pin_of_its_own_holds_the_gap_of_the_parts_that_it_joins(thick: float, fits: bool, bodies: bool) -> None:
    """The joint is between fork and eye, 1 mm apart; the pin is fixed in the fork."""
    bored = m3.Manifold.cylinder(99, 8, 8, 64, center=True)
    fork = m3.Manifold.cube([40, 40, 10]).translate([-20, -20, -11]) - bored
    eye = m3.Manifold.cylinder(20, 15, 15, 64) - bored
    pin = m3.Manifold.cylinder(31, thick, thick, 64).translate([0, 0, -11])
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("fork", fork), ("eye", eye), ("pin", pin))]
    pressed = joint("pressed", "fixed", ("fork", at(0)), ("pin", at(0)))
    swing = joint("swing", "revolute", ("fork", at(0)), ("eye", at(0)), limits=[(-1.0, 1.0)])
    subject = Subject(Assembly.from_parts("hinge", parts=parts, joints=[pressed, swing], ground="fork"))

    judged = form({"kind": "gap", "joint": {"type": "revolute"}, "mm": [0.1, 0.3], "bodies": bodies}).judge(subject)

    assert judged.ok is fits, judged


@pytest.mark.parametrize("degrees", [0, 10, 22, 60, 111])
def test_how_far_an_arm_without_end_reaches_does_not_depend_on_where_it_rests(degrees: float) -> None:
    """An arm of 120 mm on a base of 190 mm comes 25 mm beyond it."""
    parts = [Part.from_mesh(name, mesh) for name, mesh in (("base", cylinder(95, 10)), ("arm", box(120, 4, 4, center=False)))]
    turn = joint("turn", "revolute", ("base", SE3.rot_z(math.radians(degrees)) @ at(0, 0, 6)), ("arm", at(0)))
    subject = Subject(Assembly.from_parts("orrery", parts=parts, joints=[turn], ground="base"))

    assert form({"kind": "rise", "axis": "x", "mm": [24.5, 25.2]}).judge(subject).ok


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("bore", "made"), [(5.2, True), (8.0, False)])
def test_a_pin_holds_its_bore_whichever_side_is_the_child_and_whatever_lies_near(bore: float, made: bool, turned: bool) -> None:
    """An arm that can be lifted off its post, in front of which it has a cone that is part of neither pin nor bore."""
    post = m3.Manifold.cylinder(10, 12, 12, 64).translate([0, 0, -10]) + m3.Manifold.cylinder(8, 5, 5, 64)
    arm = m3.Manifold.cube([60, 20, 8]).translate([-10, -10, 0.2]) - m3.Manifold.cylinder(99, bore, bore, 64, center=True)
    arm += m3.Manifold.cylinder(4, 0.5, 3, 64).translate([14, 0, -3.5])
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("post", post), ("arm", arm))]
    ends = [("post", at(0)), ("arm", at(0))]
    swing = joint("swing", "revolute", *(ends[::-1] if turned else ends), limits=[(-0.2, 0.2)])

    subject = Subject(Assembly.from_parts("knuckle", parts=parts, joints=[swing], ground="post"))

    assert form({"kind": "made"}).judge(subject).ok is made


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (3, 2, 1, 0), (3, 1, 0, 2)])
def test_what_a_crank_moves_does_not_depend_on_the_order_of_joints_that_state_no_driver(order: tuple[int, ...]) -> None:
    """A Scotch yoke of 24 mm throw: driven by its plunger, it would stop at both dead points."""
    x, z = 24 * math.cos(0.7), 24 * math.sin(0.7)
    upright = SE3.rot_y(math.pi / 2)
    level = SE3.rot_x(math.pi / 2)
    joints = [
        joint("crank", "revolute", ("base", level), ("crank", level)),
        joint("pin", "revolute", ("crank", at(x, 0, z) @ level), ("block", level)),
        joint("slot", "slider", ("yoke", at(x, 0, z)), ("block", at(0)), limits=[(-60.0, 60.0)]),
        joint("plunger", "slider", ("base", at(0) @ upright), ("yoke", at(0) @ upright), limits=[(-60.0, 60.0)]),
    ]
    subject = of(*(joints[i] for i in order), sides={"base": 9})

    for axis in ([0, 0, 1], [1, 0, 0]):
        judged = form({"kind": "travel", "joint": {"type": "slider", "axis": axis}, "by": [47.6, 48.4]}).judge(subject)
        assert judged.ok, judged


@pytest.mark.parametrize(("turn", "fits"), [("endless", False), ([178, 182], True), ([80, 100], False), (None, True)])
def test_a_sleeve_turns_as_far_as_is_asked_for(turn: Any, fits: bool) -> None:
    bodies = [Part.from_mesh(name, box(10, 10, 10), density=1000) for name in ("post", "sleeve")]
    sleeve = joint("lift", "cylindrical", ("post", at(0)), ("sleeve", at(0)), limits=[(0.0, 40.0), (-math.pi / 2, math.pi / 2)])
    subject = Subject(Assembly.from_parts("lift", parts=bodies, joints=[sleeve], ground="post"))
    wanted = {"type": "cylindrical", "span": [39, 41], "turn": turn}

    assert form({"kind": "joints", "joint": wanted, "number": [1, 1]}).judge(subject).ok is fits


def test_what_lies_on_a_plane_goes_as_far_as_the_longer_of_its_ways() -> None:
    bodies = [Part.from_mesh(name, box(10, 10, 10), density=1000) for name in ("table", "puck")]
    limits = [(-30.0, 30.0), (-100.0, 100.0), (-math.inf, math.inf)]
    puck = joint("slide", "planar", ("table", at(0)), ("puck", at(0)), limits=limits)
    subject = Subject(Assembly.from_parts("hockey", parts=bodies, joints=[puck], ground="table"))

    for wanted, fits in (({"span": [199, 201], "turn": "endless"}, True), ({"span": [59, 61]}, False), ({"turn": [0, 300]}, False)):
        row = {"kind": "joints", "joint": {"type": "planar"} | wanted, "number": [1, 1]}
        assert form(row).judge(subject).ok is fits


@pytest.mark.parametrize(("still", "area"), [(False, 1000.0), (True, 600.0)])
def test_a_section_has_the_area_of_what_is_cut_and_can_leave_out_what_moves(still: bool, area: float) -> None:
    parts = [Part.from_mesh(name, box(*sides)) for name, sides in (("base", (30, 20, 10)), ("slide", (20, 20, 10)))]
    slide = joint("slide", "slider", ("base", at(40, 0, 0)), ("slide", at(0)), limits=[(0.0, 9.0)])
    subject = Subject(Assembly.from_parts("slide", parts=parts, joints=[slide], ground="base"))
    row = {"kind": "section", "axis": "z", "at": 5, "still": still}

    assert form(row | {"area": [0.99 * area, 1.01 * area]}).judge(subject).ok
    assert not form(row | {"area": [1.1 * area, 9 * area]}).judge(subject).ok


@pytest.mark.parametrize(("of", "ok"), [("parts", True), ("bodies", False), ("moving parts", False), ("moving bodies", False)])
def test_crumbs_that_stay_are_no_bodies_that_stay(of: str, ok: bool) -> None:
    """An edit that was to leave a lever as it is makes it anew, and leaves a crumb on the plate."""

    def product(plate: float, lever: float) -> Assembly:
        sizes = {"plate": (plate, 40, 6), "lever": (lever, 8, 8), "crumb": (1, 1, 1)}
        parts = [Part.from_mesh(name, box(*sides), density=1000) for name, sides in sizes.items()]
        turn = joint("turn", "revolute", ("plate", at(0)), ("lever", at(0)), limits=[(0.0, 1.0)])
        return Assembly.from_parts(
            "lever", parts=parts, joints=[turn, joint("held", "fixed", ("plate", at(0)), ("crumb", at(0)))], ground="plate"
        )

    check = form({"kind": "unchanged", "number": [1, 9], "of": of})

    assert check.judge(Subject(product(90, 61), before=product(80, 60))).ok is ok
    assert check.judge(Subject(product(90, 60), before=product(80, 60))).ok


@pytest.mark.parametrize(("window", "height", "fits"), [(0.0, 60.0, True), (0.2, 60.0, True), (0.5, 60.0, False), (0.0, 0.0, False)])
def test_a_board_lies_as_high_as_the_text_says_and_has_no_window(window: float, height: float, fits: bool) -> None:
    post = box(18, 300, 900)
    board = m3.Manifold.cube((700, 300, 18), center=True) - m3.Manifold.cube((700 * window, 300 * window, 20), center=True)
    parts = [Part.from_mesh("post", post, density=1000), Part.from_mesh("board", manifold_mesh(board), density=1000)]
    held = joint("held", "fixed", ("post", at(359, 0, height + 9 - 450)), ("board", at(0)))
    subject = Subject(Assembly.from_parts("shelf", parts=parts, joints=[held], ground="post"))

    assert form({"kind": "part_size", "mm": [700, 300, 18], "number": [1, 1], "above": [59, 61], "fill": 0.8}).judge(subject).ok is fits
    assert form({"kind": "part_size", "mm": [700, 300, 18], "number": [1, 1]}).judge(subject).ok


@pytest.mark.parametrize("begun", [0, 20, 60, 110])
def test_a_closed_path_runs_as_straight_wherever_it_begins(begun: int) -> None:
    """A half circle over its chord of 100 mm, from the middle of the chord or elsewhere."""
    chord = np.linspace([-50, 0, 0], [50, 0, 0], 61)
    turn = np.linspace(0, math.pi, 61)
    once = np.concatenate([chord[:-1], 50 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)[:-1]])
    path = np.roll(once, -begun, axis=0)

    assert _straight(_endless(np.concatenate([path, path[:1]])), 0.01) == pytest.approx(100, abs=2)
    assert _straight(_endless(np.linspace([0, 0, 0], [80, 0, 0], 41)), 0.01) == pytest.approx(80)


@pytest.mark.parametrize(("broken", "fits"), [(0.0, True), (0.9, True), (1.5, False)])
def test_edges_of_a_hole_may_be_broken(broken: float, fits: bool) -> None:
    """A bore of 16 mm through a disc 30 mm thick, chamfered at both mouths."""
    disc = m3.Manifold.cylinder(30, 20, 20, 64) - m3.Manifold.cylinder(90, 8, 8, 64, center=True)
    if broken:
        mouth = m3.Manifold.cylinder(broken, 8, 8 + broken, 64)
        disc = disc - mouth.translate([0, 0, 30 - broken]) - mouth.mirror([0, 0, 1]).translate([0, 0, broken])
    subject = Subject(Assembly.from_parts("disc", parts=[Part.from_mesh("disc", manifold_mesh(disc))], joints=[], ground="disc"))

    assert form({"kind": "holes", "diameter": 16, "number": [1, 1], "length": [29.5, 30.5]}).judge(subject).ok is fits


@pytest.mark.parametrize(("height", "fits"), [(20.0, True), (60.0, False)])
def test_a_hole_lies_as_high_as_the_text_says(height: float, fits: bool) -> None:
    bore = m3.Manifold.cylinder(30, 8, 8, 64, center=True).rotate((90, 0, 0)).translate((0, 0, height - 50))
    front = Part.from_mesh("front", manifold_mesh(m3.Manifold.cube((80, 20, 100), center=True) - bore), density=1000)
    subject = Subject(Assembly.from_parts("front", parts=[front], joints=[], ground="front"))

    assert form({"kind": "holes", "diameter": 16, "number": [1, 1], "above": [19, 21]}).judge(subject).ok is fits


@pytest.mark.parametrize(
    ("wall", "flap", "still", "ok"),
    [
        (False, False, False, True),
        (True, False, False, False),
        (False, True, False, False),
        (False, True, True, True),
        (True, True, True, False),
    ],
)
def test_a_passage_that_is_walled_up_is_none(wall: bool, flap: bool, still: bool, ok: bool) -> None:
    """A pipe with a thin wall across it far from its ends, and a flap in front of it that moves."""
    body = m3.Manifold.cylinder(200, 20, 20, 64, center=True) - m3.Manifold.cylinder(210, 15, 15, 64, center=True)
    pipe = Part.from_mesh("pipe", manifold_mesh(body + m3.Manifold.cylinder(1, 16, 16, 64, center=True) if wall else body), density=1000)
    door = Part.from_mesh("flap", box(40, 40, 4), density=1000)
    turn = joint("turn", "revolute", ("pipe", at(0, 0, 110 if flap else 300)), ("flap", at(0)), limits=[(0.0, 1.0)])
    aside = joint("turn", "revolute", ("pipe", at(100, 0, 110)), ("flap", at(0)), limits=[(0.0, 1.0)])
    subject = Subject(Assembly.from_parts("valve", parts=[pipe, door], joints=[turn if flap else aside], ground="pipe"))

    assert form({"kind": "passage", "diameter": 30, "axis": [0, 0, 1], "still": still}).judge(subject).ok is ok


def alone(solid: m3.Manifold) -> Subject:
    part = Part.from_mesh("body", manifold_mesh(solid), density=1000)
    return Subject(Assembly.from_parts("one", parts=[part], joints=[], ground="body"))


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("turned", [0, 45])
@pytest.mark.parametrize(
    ("slots", "width", "deep", "fits"), [(2, 5, 8, True), (0, 5, 8, False), (1, 5, 8, False), (2, 4, 8, False), (2, 5, 5, False)]
)
def test_a_section_tells_how_many_slots_a_rim_has_and_how_wide_and_deep_they_are(
    slots: int, width: float, deep: float, fits: bool, turned: int, axis: str
) -> None:
    """The battlements of a rook, whichever way its slots and its axis point."""
    rim = m3.Manifold.cylinder(16, 15, 15, 96) - m3.Manifold.cylinder(8, 10, 10, 96).translate([0, 0, 8.0])
    for number in range(slots):
        rim -= m3.Manifold.cube([40, width, 20], center=True).rotate([0, 0, 90 * number + turned]).translate([0, 0, 26 - deep])
    subject = alone(rim.rotate({"x": [0, 90, 0], "y": [-90, 0, 0], "z": [0, 0, 0]}[axis]))
    cuts = ({"at": 9, "pieces": [4, 4], "apart": [4.8, 5.2]}, {"at": 7, "pieces": [1, 1], "piece": [30, 30]})

    judged = [form({"kind": "section", "axis": axis} | cut).judge(subject) for cut in cuts]

    assert all(row.ok for row in judged) is fits, judged


def test_parts_that_touch_are_one_piece_and_what_a_joint_moves_is_cut_alone() -> None:
    """A drawer of two boards, glued, in a cabinet that is open in front; an opening with a tongue in it is as wide as its box."""
    walls = m3.Manifold.cube([60, 60, 60]) - m3.Manifold.cube([50, 60, 50]).translate([5, -5, 5])
    solids = {"cabinet": walls, "board": m3.Manifold.cube([40, 20, 8]), "front": m3.Manifold.cube([40, 8, 20])}
    parts = [Part.from_mesh(name, manifold_mesh(solid), density=1000) for name, solid in solids.items()]
    slide = joint("slide", "slider", ("cabinet", at(10, 10, 20)), ("board", at(0)), limits=[(-30.0, 0.0)])
    glued = joint("glued", "fixed", ("board", at(0)), ("front", at(0, 8, 0)))
    subject = Subject(Assembly.from_parts("cabinet", parts=parts, joints=[slide, glued], ground="cabinet"))

    def ok(**row: Any) -> bool:
        return form({"kind": "section"} | row).judge(subject).ok

    assert ok(axis="y", at=15, pieces=[2, 2], openings=[1, 1], clear=[50, 50], apart=[4.9, 15.1])
    assert ok(axis="x", at=20, joint={"type": "slider"}, pieces=[1, 1], piece=[[27, 29], 20])
    assert not ok(axis="x", at=20, joint={"type": "revolute"}, pieces=[0, 9])
    assert not ok(axis="y", at=15, apart=[0, 4])


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_a_plane_may_be_measured_from_the_upper_end(axis: str) -> None:
    """A post with a wider roof."""
    post = m3.Manifold.cube([40, 30, 100], center=True) + m3.Manifold.cube([60, 60, 10], center=True).translate([0, 0, 55.0])
    subject = alone(post.rotate({"x": [0, 90, 0], "y": [-90, 0, 0], "z": [0, 0, 0]}[axis]))

    def ok(at: float, sides: list[float]) -> bool:
        return form({"kind": "section", "axis": axis, "at": at, "piece": sides}).judge(subject).ok

    assert ok(-5, [60, 60])
    assert ok(-15, [40, 30])
    assert ok(5, [40, 30])


@pytest.mark.parametrize(("places", "fits"), [((90,), True), ((-90,), True), ((60,), False), ((90, -60), False), ((), False)])
def test_holes_lie_as_far_off_the_axis_of_another_round_as_the_text_says(places: tuple[float, ...], fits: bool) -> None:
    """A cheek with a spindle hole."""
    cheek = m3.Manifold.cylinder(12, 130, 130, 96) - m3.Manifold.cylinder(99, 15, 15, 64, center=True)
    for x in places:
        cheek -= m3.Manifold.cylinder(99, 6, 6, 64, center=True).translate([x, 0, 0])
    check = {"kind": "holes", "diameter": 12, "number": [1, 2], "beside": [30, [90]]}

    assert form(check).judge(alone(cheek)).ok is fits


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("opened", "bore", "fits"), [(0.0, 15.1, True), (2.0, 15.1, True), (16.0, 15.1, False), (0.0, 15.3, False)])
def test_a_bearing_that_is_open_to_its_sides_does_not_hold_its_shaft_all_round(
    opened: float, bore: float, fits: bool, turned: bool
) -> None:
    """A block and its cap; the slit between them is narrow, or so high that the shaft lies bare on both sides. The shaft is hollow."""
    block = m3.Manifold.cube([90, 90, 50], center=True) - m3.Manifold.cylinder(99, bore, bore, 96, center=True)
    block -= m3.Manifold.cube([99, opened, 99], center=True)
    shaft = m3.Manifold.cylinder(120, 15, 15, 96, center=True) - m3.Manifold.cylinder(99, 9, 9, 32, center=True)
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in (("block", block), ("shaft", shaft))]
    ends = [("block", at(0)), ("shaft", at(0))]
    turn = joint("turn", "revolute", *(ends[::-1] if turned else ends))
    subject = Subject(Assembly.from_parts("bearing", parts=parts, joints=[turn], ground="block"))

    judged = form({"kind": "gap", "joint": {"type": "revolute"}, "mm": [0.08, 0.12], "around": 0.85}).judge(subject)

    assert judged.ok is fits, judged
