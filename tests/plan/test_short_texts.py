"""Texts of the short form say what objects say; mirror images, likenesses, pins and places stand for what one would write out."""

from __future__ import annotations

import contextlib
import copy
import json
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from articad import Assembly
from articad.errors import PlanError
from articad.mcp.workbench import Workbench
from articad.plan import short_texts
from articad.plan.beyond import further_findings
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.plan.short import expanded
from articad.plan.signatures import functions_in
from tests.plan.samples import Json

POINT: Json = {"at": "-w, 0, atan2(w, 2)"}
JOINTS: list[tuple[str, Json]] = [
    ("fixed a b", {"type": "fixed"}),
    ("fixed a.top b.low", {"type": "fixed", "parent": "a.top", "child": "b.low"}),
    ("revolute a b; at -w, 0, atan2(w, 2); angle endless; driver", {"type": "revolute", **POINT, "angle_deg": "endless", "driver": True}),
    ("revolute a b; at other; angle -90,w; rest 5", {"type": "revolute", "at": "other", "angle_deg": [-90, "w"], "rest_deg": 5}),
    ("slider a b; travel 0,2*w; rest 1.5; mate opposed", {"type": "slider", "travel_mm": [0, "2*w"], "rest_mm": 1.5, "mate": "opposed"}),
    ("ball a b; cone 30; twist -9,9", {"type": "ball", "cone_deg": 30, "twist_deg": [-9, 9]}),
    ("screw a b; lead 4; angle 0,7200", {"type": "screw", "lead_mm": 4, "angle_deg": [0, 7200]}),
    ("planar a b; x_mm -5,5; y_mm -5,5; angle endless", {"type": "planar", "x_mm": [-5, 5], "y_mm": [-5, 5], "angle_deg": "endless"}),
    (
        "hinge a b pin; pin 8,w+2; head 14,4; tail 9",
        {"type": "hinge", "by": "pin", "pin_mm": 8, "length_mm": "w+2", "head_mm": [14, 4], "tail_mm": 9},
    ),
    (
        "hinge a b; pin w; depth 9; on child; clearance 0.2",
        {"type": "hinge", "pin_mm": "w", "depth_mm": 9, "pin_on": "child", "clearance_mm": 0.2},
    ),
    ("hinge a b; pin 8; fit 25 H7/g6", {"type": "hinge", "pin_mm": 8, "fit": "25 H7/g6"}),
    ("dowel a b; pin 8,0; fit 0.1,0.4", {"type": "dowel", "pin_mm": 8, "length_mm": 0, "fit": {"gap_mm": [0.1, 0.4]}}),
    (
        "pin_in_clevis a b; pin 8,30; eye 10; reach 14",
        {"type": "pin_in_clevis", "pin_mm": 8, "length_mm": 30, "eye_mm": 10, "reach_mm": 14},
    ),
    ("snap_ring a b; shaft 10; groove 9.6,1.1", {"type": "snap_ring", "shaft_mm": 10, "groove_mm": [9.6, 1.1]}),
    ("drawer_slide a b; bar 8,5; length 12; rest 3", {"type": "drawer_slide", "bar_mm": [8, 5], "length_mm": 12, "rest_mm": 3}),
    ("ball_socket a b; ball 8; cone 20", {"type": "ball_socket", "ball_mm": 8, "cone_deg": 20}),
    ("like other a b", {"like": "other"}),
    ("like other a b bolt; angle 0,9", {"like": "other", "by": "bolt", "angle_deg": [0, 9]}),
]


@pytest.mark.parametrize(("text", "stated"), JOINTS, ids=[text for text, _ in JOINTS])
def test_a_text_of_a_joint_is_its_object(text: str, stated: Json) -> None:
    assert short_texts.joint(text) == {"parent": "a", "child": "b"} | stated
    assert short_texts.joint(text.replace(";", " ;  ") + ";") == short_texts.joint(text)


PARTS: list[tuple[str, Json]] = [
    ("", {}),
    ("width, low = -atan2(w, 2), high=3", {"dimensions": "width, low = -atan2(w, 2), high=3"}),
    ("width; material oak", {"dimensions": "width", "material": "oak"}),
    ("material oak; at 1,w,-w/2", {"material": "oak", "rest_pose": {"at": [1, "w", "-w/2"]}}),
    ("like leg; turn -x 90-w", {"like": "leg", "rest_pose": {"axis": [-1, 0, 0], "angle_deg": "90-w"}}),
    (
        "at 0,0,1; turn 0,1,1 30; envelope 9,9,w",
        {"rest_pose": {"at": [0, 0, 1], "axis": [0, 1, 1], "angle_deg": 30}, "envelope_mm": [9, 9, "w"]},
    ),
    ("color #aabbcc", {"color": "#aabbcc"}),
]


@pytest.mark.parametrize(("text", "stated"), PARTS, ids=[text for text, _ in PARTS])
def test_a_text_of_a_part_is_its_object(text: str, stated: Json) -> None:
    pose = {"at": "joint"} | stated.get("rest_pose", {})
    assert short_texts.part(text) == stated | {"rest_pose": pose}


PLACES: list[tuple[Any, Any]] = [
    ("1,w,max(2, 3)", {"o": [1, "w", "max(2, 3)"], "z": [0, 0, 1]}),
    ("1,2,3 along -y", {"o": [1, 2, 3], "z": [0, -1, 0]}),
    ("1,2,3 along 0,cos(a),sin(a) x x", {"o": [1, 2, 3], "z": [0, "cos(a)", "sin(a)"], "x": [1, 0, 0]}),
    ("other", None),
    ("", None),
]


@pytest.mark.parametrize(("text", "frame"), PLACES)
def test_a_text_of_a_place_is_a_frame(text: str, frame: Any) -> None:
    assert short_texts.frame(text) == frame


NAMES = st.sampled_from(["w", "pin_2", "x"])
NUMBERS = st.one_of(st.integers(-999, 999), st.sampled_from([0.25, -1.5]), NAMES.map(lambda name: f"2*({name}-hypot(3, {name}))"))


@given(st.dictionaries(NAMES, NUMBERS, min_size=1))
@settings(max_examples=60, deadline=None)
def test_equations_are_read_back(values: dict[str, Any]) -> None:
    assert short_texts.equations(", ".join(f"{name} = {value}" for name, value in values.items())) == values


@given(st.text(alphabet="ab_;,=().xy 0-9", max_size=40))
@settings(max_examples=200, deadline=None)
def test_any_text_is_read_or_left(text: str) -> None:
    plan = copy.deepcopy(CART)
    plan["parts"]["hub_l"] = plan["joints"]["spin_l"] = plan["parameters"] = text
    with contextlib.suppress(PlanError):
        AssemblyPlan.from_json(plan)


CART: Json = {
    "schema": "articad.short/1",
    "name": "cart",
    "ground": "frame",
    "freedoms": 4,
    "mirror": "x",
    "material": "oak",
    "parameters": "half = 50, wide = 20, low = half - 30",
    "parts": {
        "frame": "half, wide",
        "hub_l": "wide; material steel",
        "cap_l": "size = 4; at -half-22, 0, 0",
        "cap_r": "size = 6; at half+22, 0, 0",
        "lever_left": "size=5",
    },
    "joints": {
        "spin_l": "hinge frame hub_l; at -half,0,0 along -x; pin 6,19; depth 20; angle -10,90",
        "close_l": "fixed hub_l cap_l; at -half-20,0,0 along -x",
        "pull_left": "slider frame lever_left; at -30,0,20; travel 0,9",
    },
}
PLANE = {"point": [0, 0, 0], "normal": [1, 0, 0]}


def written_out() -> Json:
    """The cart with everything that `mirror` stands for."""
    plan = copy.deepcopy(CART)
    del plan["mirror"]
    plan["parts"]["hub_r"] = {"derive": {"from": "hub_l", "op": "mirror", "plane": PLANE}}
    plan["parts"]["lever_right"] = {"derive": {"from": "lever_left", "op": "mirror", "plane": PLANE}}
    plan["joints"]["spin_r"] = {"derive": {"from": "spin_l", "op": "mirror"}, "parent": "frame", "child": "hub_r"}
    plan["joints"]["close_r"] = {"derive": {"from": "close_l", "op": "mirror"}, "parent": "hub_r", "child": "cap_r"}
    plan["joints"]["pull_right"] = {"derive": {"from": "pull_left", "op": "mirror"}, "parent": "frame", "child": "lever_right"}
    return plan


def by_name(plan: Json) -> Json:
    """The lists of an expanded plan without their order."""
    return {key: {entry["name"]: entry for entry in value} if isinstance(value, list) else value for key, value in expanded(plan).items()}


def test_mirror_adds_the_images_that_are_not_stated() -> None:
    assert by_name(CART) == by_name(written_out())
    assert not check_plan(AssemblyPlan.from_json(CART)).errors


def test_an_image_stands_next_to_its_source() -> None:
    assert [part["name"] for part in expanded(CART)["parts"]][:3] == ["frame", "hub_l", "hub_r"]


def test_both_parts_of_an_image_may_be_stated() -> None:
    """Then the plan's own plane says where the joint's image is, and the joint is written out."""
    plan = copy.deepcopy(CART)
    plan["parts"]["hub_r"] = "wide; material steel"
    resolved = resolve(AssemblyPlan.from_json(plan))
    hub = resolved.parts["hub_r"]
    assert hub.T_rest.translation == pytest.approx((50, 0, 0))
    assert hub.dimensions["spin_r_bore"] == pytest.approx(6.3)
    spin = next(joint.columns[0] for joint in resolved.joints if joint.name == "spin_r")
    assert (math.degrees(spin.lower), math.degrees(spin.upper)) == pytest.approx((-90, 10))


@pytest.mark.parametrize("mirror", ["w", 3, None, ["x"]])
def test_a_mirror_that_is_no_plane_is_reported(mirror: Any) -> None:
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(CART | {"mirror": mirror})
    assert "mirror" in {finding.where for finding in refused.value.findings}


def test_a_part_of_a_text_stands_at_the_joint_that_carries_it() -> None:
    resolved = resolve(AssemblyPlan.from_json(CART))
    places = {name: [float(value) for value in part.T_rest.translation] for name, part in resolved.parts.items()}
    assert {name: places[name] for name in ("frame", "hub_l", "cap_l", "lever_left")} == {
        "frame": [0, 0, 0],
        "hub_l": [-50, 0, 0],
        "cap_l": [-72, 0, 0],
        "lever_left": [-30, 0, 20],
    }


ROD: Json = {
    "schema": "articad.short/1",
    "name": "swing",
    "ground": "post",
    "freedoms": 3,
    "material": "oak",
    "parameters": "t=10",
    "parts": {"post": "thick=t, wide=160", "arm": "thick=t, wide=30", "arm_2": "like arm", "arm_3": "like arm"},
    "joints": {
        "turn": "hinge post arm bolt; at 0,0,2*t+0.4 along -z; pin 8,2*t+0.4; head 14,4; angle 0,90; driver",
        "turn_2": "like turn post arm_2 bolt_2; at 40,0,2*t+0.4 along -z; angle -30,30",
        "turn_3": "hinge post arm_3 stud; at -40,0,t+0.2 along z; pin 8,t; head 12,0.2; tail t; angle 0,90",
    },
}
FLAT = """from build123d import *


def post(thick, wide):
    return Pos(Z=thick / 2) * Box(wide, 30, thick)


def arm(thick, wide, part):
    return Pos(Z=thick / 2 + (0 if part.name == "arm_3" else -thick - 0.2)) * Box(wide, wide, thick)
"""


@pytest.fixture
def swing(tmp_path: Path) -> Path:
    (tmp_path / "plan.json").write_text(json.dumps(ROD))
    (tmp_path / "parts.py").write_text(FLAT)
    return tmp_path


def test_a_hinge_by_a_pin_makes_the_pin_and_both_bores(swing: Path) -> None:
    """Volumes of closed formulas: shank, head and tail; bores of the pin's diameter in the post, wider ones in the arms."""
    built = Assembly.from_plan(AssemblyPlan.load(swing), swing / "parts")
    volumes = {name: part.mass.mass / (7850e-9 if name[0] in "bs" else 700e-9) for name, part in built.parts.items() if part.mass}
    disc = math.pi * 4**2
    assert volumes == pytest.approx(
        {
            "post": 160 * 30 * 10 - 3 * disc * 10,
            **dict.fromkeys(("arm", "arm_2", "arm_3"), 30 * 30 * 10 - math.pi * 4.15**2 * 10),
            **dict.fromkeys(("bolt", "bolt_2"), disc * 20.4 + math.pi * 7**2 * 4),
            "stud": disc * 10 + disc * 10 + math.pi * 6**2 * 0.2,
        },
        rel=1e-4,
    )
    checks = built.check()
    assert checks.ok, str(checks.findings)
    assert [row.to_json()["play_mm"] for row in checks.fits] == pytest.approx([0.15] * 3, abs=1e-3)
    assert {joint["name"]: joint["type"] for joint in expanded(ROD)["joints"]} == {
        **dict.fromkeys(("bolt", "bolt_2", "stud"), "fixed"),
        **dict.fromkeys(("turn", "turn_2", "turn_3"), "revolute"),
    }
    assert [joint.name for joint in built.drivers] == ["turn", "turn_2", "turn_3"]


UNKNOWN = {
    "lenght 5": "Did you mean 'length'?",
    "blnd": "Did you mean 'blind'?",
    "blind; depth 3": "and no depth",
    "effrt_n_mm 5": "Did you mean 'effort_n_mm'?",
}


@pytest.mark.parametrize("clause", UNKNOWN)
def test_a_clause_that_is_unknown_is_told_once_and_at_each_joint_that_states_it(clause: str) -> None:
    plan = copy.deepcopy(ROD)
    plan["joints"]["turn"] += f"; {clause}"
    plan["joints"]["turn_4"] = "like turn_2 post arm_2 bolt_4; at 70,0,20.4 along -z"
    plan["joints"]["turn_3"] += "; lenght 7"
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(plan)
    key = clause.split(maxsplit=1)[0].rstrip(";")
    assert [one.where for one in refused.value.findings] == [f"joints.turn.{key}", "joints.turn_3.lenght"]
    assert UNKNOWN[clause] in refused.value.findings[0].hint
    plan["joints"]["turn_2"] += f"; {clause}"
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(plan)
    assert [one.where.split(".")[1] for one in refused.value.findings] == ["turn", "turn_2", "turn_3"]


@pytest.mark.parametrize("kind", ["pin_in_clevis", "ball_socket", "snap_ring"])
def test_what_does_not_end_has_no_hole_that_does(kind: str) -> None:
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(ROD | {"joints": {"turn": f"{kind} post arm; at 0,0,0; pin 8,9; blind"}})
    assert "joints.turn.blind" in {one.where for one in refused.value.findings}


@pytest.mark.parametrize(("pin", "depths"), [("bolt", {"post": 16, "arm": 16.15}), ("", {"arm": 16.15})])
def test_blind_holes_end_where_the_pin_ends(pin: str, depths: Json) -> None:
    """Without it, both bores of a bolt go through; the child's hole has its clearance at the bottom, too."""
    plan = {**ROD, "freedoms": 1, "parts": {"post": "thick=t, wide=160", "arm": "thick=t, wide=30"}}
    joint = f"hinge post arm {pin}; at 0,0,20.4 along -z; pin 8,16; angle 0,90"
    held = {}
    for clause in ("", "; blind"):
        parts = {part["name"]: part["dimensions"] for part in expanded(plan | {"joints": {"turn": joint + clause}})["parts"]}
        held[clause] = {name: size for name, sizes in parts.items() for key, size in sizes.items() if key.endswith("_depth")}
    assert held == {"": {}, "; blind": depths}


def test_a_bolt_in_a_blind_hole_fits_and_ends_in_it(tmp_path: Path) -> None:
    """The bolt goes through the arm and 5.6 mm into the post, whose hole has a bottom of 4.4 mm."""
    plan = {**ROD, "freedoms": 1, "parts": {"post": "thick=t, wide=160", "arm": "thick=t, wide=30"}}
    plan["joints"] = {"turn": "hinge post arm bolt; at 0,0,20.4 along -z; pin 8,16; head 14,4; blind; angle 0,90"}
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    (tmp_path / "parts.py").write_text(FLAT)
    built = Assembly.from_plan(AssemblyPlan.load(tmp_path), tmp_path / "parts")
    mass = built.parts["post"].mass
    assert mass is not None
    assert mass.mass == pytest.approx(700e-9 * (160 * 30 * 10 - math.pi * 16 * 5.6), rel=1e-4)
    checks = built.check()
    assert checks.ok, str(checks.findings)
    assert built.certify(["turn"]).ok


def test_what_is_like_another_has_its_fields_but_place_and_drive() -> None:
    plan = expanded(ROD)
    joints = {joint["name"]: joint for joint in plan["joints"]}
    assert joints["turn_2"]["angle_deg"] == [-30, 30]
    assert "driver" not in joints["turn_2"]
    parts = {part["name"]: part for part in plan["parts"]}
    assert parts["arm_2"]["dimensions"] == {"thick": "t", "wide": 30, "turn_2_bore": 8.3}
    assert parts["arm_2"]["rest_pose"] == {"at": [40, 0, "2*t+0.4"]}


@pytest.mark.parametrize("like", ["itself", "nothing", "loop"])
def test_a_likeness_to_nothing_is_reported(like: str) -> None:
    plan = copy.deepcopy(ROD)
    plan["parts"]["arm_2"] = {"itself": "like arm_2", "nothing": "like leg", "loop": "like arm_3"}[like]
    if like == "loop":
        plan["parts"]["arm_3"] = "like arm_2"
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(plan)
    assert "parts.arm_2.like" in {finding.where for finding in refused.value.findings}


def test_what_is_like_another_shares_nothing_with_it() -> None:
    """The pin and the connector of a joint are those of its own part, not of parts that are like it."""
    plan = copy.deepcopy(ROD)
    plan["parts"] |= {"arm": {"dimensions": {"thick": "t", "wide": 30}, "connectors": []}, "spare": "like arm"}
    parts = {part["name"]: part for part in expanded(plan)["parts"]}
    assert parts["spare"]["dimensions"] == {"thick": "t", "wide": 30}
    assert parts["spare"]["connectors"] == []
    assert [connector["name"] for connector in parts["arm"]["connectors"]] == ["turn"]


def test_a_long_chain_of_likenesses_is_followed() -> None:
    plan = {"schema": "articad.short/1", "parts": {"p0": "wide=1"} | {f"p{n}": f"like p{n - 1}" for n in reversed(range(1, 5000))}}
    assert all(part["dimensions"] == {"wide": 1} for part in expanded(plan | {"joints": {}})["parts"])


def test_likenesses_that_repeat_too_much_are_refused() -> None:
    """500 dimensions of 2000 parts would be a million in a file of 40 kB."""
    plan = copy.deepcopy(ROD)
    plan["parts"] = {"p": ", ".join(f"d{n}=1" for n in range(500))} | {f"p{n}": "like p" for n in range(2000)}
    with pytest.raises(PlanError, match="would repeat more than 2000000 characters"):
        AssemblyPlan.from_json(plan)


LONG_TEXTS: dict[str, Callable[[], Any]] = {
    "digits": lambda: short_texts.number("1" * 500_000 + "x"),
    "pieces": lambda: short_texts.split("a" * 2_000_000),
    "images": lambda: expanded(
        {"schema": "articad.short/1", "mirror": "x", "parts": {f"p{n}_l": "w=1" for n in range(20_000)}, "joints": {}}
    ),
    "sizes": lambda: expanded(
        {
            "schema": "articad.short/1",
            "mirror": "x",
            "parts": {"hub": "w=1"} | {f"b{n}_{side}": "w=1" for n in range(1500) for side in "lr"},
            "joints": {f"j{n}_l": f"hinge hub b{n}_l; at 0,0,0; pin 4,9" for n in range(1500)},
        }
    ),
    "pins": lambda: expanded(
        {"schema": "articad.short/1", "parts": {}, "joints": {f"j{n}": f"hinge a b pin{n}; pin 4,9" for n in range(20_000)}}
    ),
}


@pytest.mark.parametrize("text", [pytest.param(text, marks=pytest.mark.soak) if text == "pins" else text for text in LONG_TEXTS])
def test_the_time_to_read_grows_with_the_length_not_with_its_square(text: str) -> None:
    start = time.process_time()
    LONG_TEXTS[text]()
    assert time.process_time() - start < 10.0  # of processor time; they took minutes


DIGITS = 10**400
LARGE: dict[str, Json] = {
    **{
        f"{kind}-{key}": {"type": kind, "parent": "post", "child": "arm", "at": [0, 0, 0], key: value}
        for kind, key, value in (
            ("hinge", "pin_mm", DIGITS),
            ("drawer_slide", "bar_mm", [5, -DIGITS]),
            ("ball_socket", "ball_mm", DIGITS),
            ("pin_in_clevis", "eye_mm", DIGITS),
        )
    },
    "blind": {"type": "hinge", "parent": "post", "child": "arm", "at": [0, 0, 0], "pin_mm": 8, "length_mm": DIGITS, "blind": True},
}


@pytest.mark.parametrize("joint", LARGE)
def test_a_size_of_hundreds_of_digits_is_refused_in_words(joint: str) -> None:
    plan = copy.deepcopy(ROD)
    plan["joints"]["large"] = LARGE[joint]
    assert "E_" in _refusal(plan)


@pytest.mark.parametrize("plane", [{"point": [DIGITS, 0, 0], "normal": [1, 0, 0]}, {"point": [0, 0, 0], "normal": [DIGITS, 0, 0]}])
def test_a_plane_of_hundreds_of_digits_is_refused_in_words(plane: Json) -> None:
    plan = {"schema": "articad.short/1", "name": "x", "ground": "a", "freedoms": 2, "material": "oak", "mirror": plane}
    plan["parts"] = {"a": "w=1", "b_l": "w=1", "b_r": "w=1"}
    plan["joints"] = {"j_l": {"type": "revolute", "parent": "a", "child": "b_l", "at": [5, 0, 0], "angle_deg": [0, 9]}}
    assert "E_" in _refusal(plan)


@pytest.mark.parametrize("levels", [101, 900])
def test_a_plan_that_is_nested_too_deeply_is_refused_once(levels: int, tmp_path: Path) -> None:
    """What is wrong beside its form is not looked for."""
    (tmp_path / "plan.json").write_text(f'{{"schema": "articad.plan/1", "x": {"[" * levels}{"]" * levels}}}')
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.loads((tmp_path / "plan.json").read_text())
    assert further_findings(tmp_path, refused.value.findings) == refused.value.findings


def _refusal(plan: Json) -> str:
    try:
        return str(check_plan(AssemblyPlan.from_json(plan)).errors)
    except PlanError as error:
        return str(error)


SCRIPT = """
import os
LOW = 3
def lid(width, part, board=12, depth="2*width", edge=-1.5, label=None, place=LOW, *, open_deg=5): ...
def box(width, /, high=1): ...
crate = box
raise SystemExit
"""


def test_arguments_are_read_and_the_script_is_not_run() -> None:
    found = functions_in(SCRIPT)
    assert [argument.name for argument in found["lid"]] == ["width", "part", "board", "depth", "edge", "label", "place", "open_deg"]
    assert found["crate"] == found["box"]


@pytest.mark.parametrize("script", ["def build(part): ...\ndef lid(width): ...", "def (", "x = " + "(" * 5000, b"\xff\xfe\x00", ""])
def test_other_scripts_have_no_such_functions(script: str | bytes) -> None:
    assert functions_in(script) == {}


def test_arguments_are_dimensions_unless_the_part_states_them(tmp_path: Path) -> None:
    parts = {"lid": "board=18", "crate_l": "", "crate_r": "high=9; at 9,9,9"}
    joints = {"a": "fixed lid crate_l; at 0,0,5", "b": "fixed lid crate_r; at 9,9,9"}
    plan = {"schema": "articad.short/1", "name": "case", "ground": "lid", "freedoms": 0, "material": "oak", "parameters": "width=7"}
    (tmp_path / "plan.json").write_text(json.dumps({**plan, "parts": parts, "joints": joints}))
    (tmp_path / "parts.py").write_text(SCRIPT)
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "crate_r.py").write_text("def crate(high, deep=4): ...")
    held = {name: dict(part.dimensions) for name, part in resolve(AssemblyPlan.load(tmp_path)).parts.items()}
    assert held == {
        "lid": {"width": 7, "board": 18, "depth": 14, "edge": -1.5, "open_deg": 5},
        "crate_l": {"width": 7, "high": 1},
        "crate_r": {"high": 9, "deep": 4},
    }


def test_an_argument_that_is_nowhere_is_reported_at_the_part(tmp_path: Path) -> None:
    plan = {
        "schema": "articad.short/1",
        "name": "case",
        "ground": "lid",
        "freedoms": 0,
        "material": "oak",
        "parts": {"lid": ""},
        "joints": {},
    }
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    (tmp_path / "parts.py").write_text("def lid(width): ...")
    assert "parts.lid.dimensions.width" in {finding.where for finding in check_plan(AssemblyPlan.load(tmp_path)).errors}


def test_a_field_of_a_text_can_be_edited_at_its_address(tmp_path: Path) -> None:
    bench = Workbench(tmp_path)
    bench.write_plan("mine", ROD)
    bench.amend_plan("mine", {"joints.turn.angle_deg": [0, 45], "parts.post.dimensions.wide": 200, "parameters.t": 12})
    kept = bench.document("mine")
    assert kept["schema"] == "articad.short/1"
    assert kept["joints"]["turn"]["angle_deg"] == [0, 45]
    assert kept["parameters"] == {"t": 12}
    assert kept["parts"]["post"] == {"dimensions": {"thick": "t", "wide": 200}, "rest_pose": {"at": "joint"}}
    plan = {part["name"]: part for part in bench.plan("mine")["parts"]}
    assert plan["post"]["dimensions"]["wide"] == 200


@pytest.mark.parametrize(
    ("key", "text", "where", "words"),
    [
        ("parts", {"post": "wide 160; material oak"}, "parts.post.dimensions", "dimensions first, then clauses"),
        ("parameters", "t 10", "parameters", "by name"),
    ],
)
def test_a_text_that_cannot_be_read_is_reported_with_the_form_that_can(key: str, text: Any, where: str, words: str) -> None:
    plan = copy.deepcopy(ROD)
    plan[key] = plan[key] | text if isinstance(text, dict) else text
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(plan)
    assert {finding.where: finding.hint for finding in refused.value.findings}[where].count(words) == 1


def test_an_unknown_clause_of_a_joint_is_reported_as_a_field() -> None:
    plan = copy.deepcopy(ROD)
    plan["joints"]["turn"] += "; angel 0,90"
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(plan)
    assert refused.value.findings.errors[0].where == "joints.turn.angel"  # the joint that is like it comes second


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize(
    "text", ["hinge base arm; at 0,0,9 along z; pin 8,20; angle -9,9", "fixed base arm; at 0,0,9", "hinge base arm pin; at 0,0,9; pin 8,20"]
)
def test_a_part_that_is_misspelled_at_a_place_is_told_with_the_nearest_name(text: str, side: int) -> None:
    wrong = text.replace(("base", "arm")[side], ("bse", "amr")[side], 1)
    plan = {
        "schema": "articad.short/1",
        "name": "p",
        "ground": "base",
        "freedoms": 0,
        "material": "steel",
        "parts": {"base": "", "arm": "w=9"},
    }
    plan["joints"] = {"j": wrong}
    found = check_plan(AssemblyPlan.loads(json.dumps(plan)))
    told = [finding.hint for finding in found if finding.code == "E_PART_UNKNOWN"]
    assert told
    assert all(f"Did you mean {('base', 'arm')[side]!r}?" in hint for hint in told)
    assert "E_SCHEMA" not in found.codes
