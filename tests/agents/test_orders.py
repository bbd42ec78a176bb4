"""Faults of a plan whose scripts follow it: the designer gets them, with the number that mends them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from articad.agents.evidence import examine
from articad.agents.llm import Reply, Request, Scripted
from articad.agents.misplaced import Misplaced
from articad.agents.pipeline import generate
from articad.assembly import Assembly
from articad.findings import Finding
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run
from articad_bench.obeying import followed
from tests.agents import stories
from tests.agents.stories import fenced, watched


class Obedient:
    """A designer who does what a message says, and only that; the other answers are fixed."""

    def __init__(self, answers: dict[str, Any], rules: dict[str, Any]) -> None:
        self.scripted, self.rules, self.steps = Scripted(answers), rules, list[str]()

    def complete(self, request: Request) -> Reply:
        self.steps.append(request.step)
        if not request.step.startswith("design/") or request.step == "design/1":
            return self.scripted.complete(request)
        asked = "\n".join(part["text"] for part in request.to_json()["messages"][-1]["content"] if part["type"] == "text")
        for pattern, changes in self.rules.items():
            if found := re.search(pattern, asked):
                return Reply(json.dumps({"changes": changes(*map(float, found.groups()))}), "obedient")
        raise AssertionError(f"No rule for:\n{asked}")


def made(tmp_path: Path, llm: Any) -> Run:
    settings = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache())
    return generate("a product", llm=llm, out=tmp_path / "run", **settings)


def plan(name: str, parts: list[dict[str, Any]], joint: dict[str, Any], **parameters: float) -> dict[str, Any]:
    return {
        "schema": "articad.plan/1",
        "name": name,
        "ground": parts[0]["name"],
        "freedoms": 1,
        "parameters": [{"name": key, "value": value} for key, value in parameters.items()],
        "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#b58b5a"}],
        "parts": [{"material": "oak", **part} for part in parts],
        "joints": [joint],
    }


def axis(name: str, o: list[Any]) -> dict[str, Any]:
    return {"name": name, "o": o, "z": [0, -1, 0], "x": [1, 0, 0], "label": "axis"}


# A block with a slot, in which an arm turns about y. The slot is ordered too shallow for the arm's end.
FORK = """
from build123d import Align, Box, Pos

def build(part):
    d = part.dimensions
    body = Box(60, 40, 50, align=(Align.CENTER, Align.CENTER, Align.MAX))
    slot = Pos(0, 0, 0) * Box(60, d["slot_width"], d["slot_depth"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    return body - slot, dict(part.connectors)
"""
ARM = """
from build123d import Box

def build(part):
    d = part.dimensions
    return Box(d["length"], d["thickness"], 8), dict(part.connectors)
"""


def test_a_slot_ordered_too_shallow_is_the_designers_and_is_made_deep_enough(tmp_path: Path) -> None:
    fork = {
        "name": "fork",
        "description": "Block 60 x 40 x 50 below z = 0 with a slot along x, slot_width wide and slot_depth deep from its top.",
        "dimensions": {"slot_width": 11, "slot_depth": "slot_depth"},
        "connectors": [axis("axis", [0, 0, -8])],
    }
    arm = {
        "name": "arm",
        "description": "Bar of length along x and thickness along y, 8 high, about the origin.",
        "dimensions": {"length": 40, "thickness": 10},
        "rest_pose": "auto",
        "connectors": [axis("axis", [0, 0, 0])],
    }
    turn = {"name": "turn", "type": "revolute", "parent": "fork.axis", "child": "arm.axis", "angle_deg": [0, 90]}
    first = plan("swing", [fork, arm], turn, slot_depth=14)
    answers = {"requirements": stories.requirements("swing"), "design/1": json.dumps(first)} | watched("turn")
    answers |= {"part/fork/1": fenced(FORK), "part/arm/1": fenced(ARM)}
    llm = Obedient(
        answers, {r"remove at least x \S+ to \S+, y \S+ to \S+, z (-?[\d.]+) to": lambda low: {"parameters.slot_depth.value": 1 - low}}
    )
    run = made(tmp_path, llm)

    assert (run.checks() or {})["ok"]
    assert [step for step in llm.steps if step.startswith("part/fork")] == ["part/fork/1"]  # its author was right
    assert [step for step in llm.steps if step.startswith("design")] == ["design/1", "design/2"]
    assert len(llm.steps) - llm.steps.index("design/2") <= 6


# A lid on a box, whose axis is ordered inside the box's back wall instead of behind it.
BOX = """
from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.MIN, Align.MIN)

def build(part):
    d = part.dimensions
    inner = Pos(0, d["wall"], d["wall"]) * Box(d["width"] - 2 * d["wall"], d["depth"] - 2 * d["wall"], d["height"], align=LOW)
    return Box(d["width"], d["depth"], d["height"], align=LOW) - inner, dict(part.connectors)
"""
LID = """
from build123d import Align, Box, Pos

def build(part):
    d = part.dimensions
    return Box(d["width"], d["depth"], d["thickness"], align=(Align.CENTER, Align.MIN, Align.MIN)), dict(part.connectors)
"""


def test_an_axis_ordered_too_low_and_too_near_is_the_designers(tmp_path: Path) -> None:
    sizes = {"width": 120, "depth": 80}
    box = {
        "name": "box",
        "description": "Box width x depth x height, y and z from 0, open above, with walls of wall.",
        "dimensions": {**sizes, "height": 50, "wall": 6},
        "connectors": [{"name": "axis", "o": [0, "axis_y", "axis_z"], "z": [1, 0, 0], "x": [0, 1, 0], "label": "axis"}],
    }
    lid = {
        "name": "lid",
        "description": "Plate width x depth x thickness, y and z from 0.",
        "dimensions": {**sizes, "thickness": 8},
        "rest_pose": {"at": [0, 0, 50.2]},
        "connectors": [{"name": "axis", "o": [0, "axis_y", "axis_z - 50.2"], "z": [1, 0, 0], "x": [0, 1, 0], "label": "axis"}],
    }
    hinge = {"name": "hinge", "type": "revolute", "parent": "box.axis", "child": "lid.axis", "angle_deg": [0, 100]}
    first = plan("chest", [box, lid], hinge, axis_y=3, axis_z=40)
    answers = {"requirements": stories.requirements("chest"), "design/1": json.dumps(first)} | watched("hinge")
    answers |= {"part/box/1": fenced(BOX), "part/lid/1": fenced(LID)}
    moved = r"Move the axis by \((\S+), (\S+), (\S+)\) mm in the frame of box"
    llm = Obedient(answers, {moved: lambda _x, y, z: {"parameters.axis_y.value": 3 + y, "parameters.axis_z.value": 40 + z}})
    run = made(tmp_path, llm)

    assert (run.checks() or {})["ok"]
    assert [step for step in llm.steps if step.startswith("design")] == ["design/1", "design/2"]
    assert len(llm.steps) - llm.steps.index("design/2") <= 6


# A wheel on the pin of a post; the fit of the two is declared.
POST = """
from build123d import Align, Box, Cylinder, Pos

def build(part):
    d = part.dimensions
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    plate = Pos(0, 0, -d["plate"]) * Box(30, 30, d["plate"] - d["clearance"], align=low)
    return plate + Pos(0, 0, -d["plate"]) * Cylinder(PIN, 20 + d["plate"], align=low), dict(part.connectors)
"""
WHEEL = """
from build123d import Align, Cylinder

def build(part):
    d = part.dimensions
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    return Cylinder(d["radius"], 6, align=low) - Cylinder(d["bore"], 6, align=low), dict(part.connectors)
"""


def wheel_on_a_pin(
    pin: str = 'd["pin"] - d["clearance"]', wheel: str = WHEEL, /, fit: dict[str, Any] | None = None, **dimensions: float
) -> tuple[dict[str, Any], Assembly]:
    """A wheel whose bore has a radius of 4, on a pin with a radius of 4 less a clearance of 0.2."""
    own = {"plate": 5, "pin": 4, "clearance": 0.2, "radius": 12, "bore": 4} | dimensions
    bearing = {"z": [0, 0, 1], "x": [1, 0, 0], "o": [0, 0, 0], "label": "axis"}
    parts = [
        {
            "name": name,
            "description": name,
            "dimensions": {key: own[key] for key in keys},
            "connectors": [bearing | {"name": "axis"}],
        }
        for name, keys in {"post": ("plate", "pin", "clearance"), "wheel": ("radius", "bore")}.items()
    ]
    parts[1]["rest_pose"] = {"at": [0, 0, 0]}
    turn = {"name": "turn", "type": "revolute", "parent": "post.axis", "child": "wheel.axis", "angle_deg": "endless"}
    document = plan("wheel", parts, turn | {"fit": fit or {"gap_mm": [0.1, 0.3], "contact": "forbidden"}})
    scripts = {"post": POST.replace("PIN", pin), "wheel": wheel}
    made = Assembly.from_plan(AssemblyPlan.from_json(document), scripts, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1)
    return document, made


def test_the_hint_of_a_fit_that_is_as_ordered_states_the_dimension_that_mends_it() -> None:
    document, made = wheel_on_a_pin(bore=3.85)
    found = [finding for finding in examine(made).findings.errors if finding.code.startswith("E_FIT")]

    assert [(finding.route, finding.where) for finding in found] == [("design", "joints.turn.fit")]
    offered = [change for change in followed(found[0], document) if change["parts"] != document["parts"]]
    bores = {change["parts"][1]["dimensions"]["bore"] for change in offered}
    pins = {change["parts"][0]["dimensions"]["pin"] for change in offered}
    assert bores == {4.0, 3.85}
    assert sorted(pins) == pytest.approx([3.85, 4.0])
    assert "joints.turn.fit.gap_mm to [0.04, 0.3] if the gap is meant as it is" in found[0].hint


def test_a_clearance_that_one_script_left_out_is_its_authors() -> None:
    _, made = wheel_on_a_pin('d["pin"]')
    found = [finding for finding in examine(made).findings.errors if finding.code.startswith("E_FIT")]

    assert [(finding.route, finding.where) for finding in found] == [("code", "parts.post")]
    assert "post is ordered with 'clearance'" in found[0].hint


def test_a_wheel_as_it_was_ordered_has_no_fault() -> None:
    assert examine(wheel_on_a_pin()[1]).findings.ok


def test_a_clearance_that_a_pin_shows_was_not_left_out() -> None:
    _, made = wheel_on_a_pin(bore=3.8)  # as the plan orders it: the pin has its clearance, and fills the bore
    found = [finding for finding in examine(made).findings.errors if finding.code.startswith("E_FIT")]

    assert [(finding.route, finding.where) for finding in found] == [("design", "joints.turn.fit")]
    assert "parts.wheel.dimensions.bore to 4," in found[0].hint


COLLAR = """
    collar = Pos(0, 0, d["collar"] / 10 - 1) * Cylinder(d["collar"], d["collar"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    return shape + collar, dict(part.connectors)
"""


def post_with_a_collar(collar: float, pin: str) -> Assembly:
    """A collar below the wheel, which swallows the pin and the wheel if it is a thousand times as large."""
    document, _ = wheel_on_a_pin()
    document["parts"][0]["dimensions"]["collar"] = collar
    head, _, _ = POST.replace("PIN", pin).rpartition("    return ")
    body = head + "    shape = " + POST.replace("PIN", pin).rpartition("    return ")[2].partition(", dict(")[0] + COLLAR
    return Assembly.from_plan(
        AssemblyPlan.from_json(document), {"post": body, "wheel": WHEEL}, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1
    )


def test_a_dimension_that_a_number_out_of_proportion_hides_is_not_held_against_the_script() -> None:
    made = post_with_a_collar(6000, 'd["pin"] - d["clearance"]')
    assert made.realised["post"].findings.of("W_DIMENSION_UNUSED")
    assert {finding.route for finding in examine(made).findings.errors} == {"design"}
    assert examine(post_with_a_collar(6, 'd["pin"] - d["clearance"]')).findings.ok


def test_a_dimension_that_a_script_ignores_is_held_against_it_whatever_the_proportions() -> None:
    found = examine(post_with_a_collar(6000, "3.8")).findings.errors
    assert {(finding.route, finding.where) for finding in found} == {("code", "parts.post")}


@pytest.mark.parametrize("depth", [0.6, 1.0, 3.0])
def test_a_bore_that_is_closed_at_both_ends_is_its_authors(depth: float) -> None:
    """Its depth may be one that dimensions give."""
    shut = WHEEL.replace('Cylinder(d["bore"], 6', f'Pos(0, 0, 1) * Cylinder(d["bore"], {depth}').replace("Cylinder\n", "Cylinder, Pos\n")
    _, made = wheel_on_a_pin('d["pin"] - d["clearance"]', shut)
    found = examine(made).findings.errors

    assert {(finding.route, finding.where) for finding in found} == {("code", "parts.wheel")}
    assert "closed at both ends" in found[0].hint


def test_each_change_that_a_hint_offers_for_a_required_contact_ends_the_finding() -> None:
    document, made = wheel_on_a_pin(fit={"gap_mm": [0, 0.3], "contact": "required"})
    (found,) = [finding for finding in examine(made).findings.errors if finding.code.startswith("E_FIT")]
    changed = [plan for plan in followed(found, document) if plan != document]

    assert len({json.dumps(plan) for plan in changed}) == 3  # what was tried stands there twice
    for plan in changed:
        own = {key: value for part in plan["parts"] for key, value in part["dimensions"].items()}
        _, again = wheel_on_a_pin(fit=plan["joints"][0]["fit"], **own)
        assert examine(again).findings.ok, plan["joints"]


@pytest.mark.parametrize("radius", [4.1, 4.4, 5.0])
def test_a_pin_that_is_too_thick_was_not_built_elsewhere_though_it_would_be_clear_there(
    radius: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The pin stands beside the plate's middle. On the other side it would touch nothing, so no such motion is tried."""
    monkeypatch.setattr("articad.agents.orders.misplaced", lambda *_, **__: Misplaced("post", "mirrored at x = 0"))
    post = """
from build123d import Align, Box, Cylinder, Pos

def build(part):
    d = part.dimensions
    plate = Pos(0, 0, -d["plate"]) * Box(80, 40, d["plate"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    pin = Pos(d["at"], 0, -1) * Cylinder(d["pin"], 9, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return plate + pin, dict(part.connectors)
"""
    axis = {"name": "axis", "z": [0, 0, 1], "x": [1, 0, 0], "o": [0, 0, 0.5], "label": "axis"}
    parts = [
        {
            "name": "post",
            "description": "post",
            "dimensions": {"plate": 5, "pin": radius, "at": 20},
            "connectors": [axis | {"o": [20, 0, 0.5]}],
        },
        {
            "name": "wheel",
            "description": "wheel",
            "dimensions": {"radius": 12, "bore": 4},
            "connectors": [axis | {"o": [0, 0, 0]}],
            "rest_pose": {"at": [20, 0, 0.5]},
        },
    ]
    turn = {"name": "turn", "type": "revolute", "parent": "post.axis", "child": "wheel.axis", "angle_deg": "endless"}
    document = plan("crank", parts, turn | {"fit": {"gap_mm": [0.1, 0.3], "contact": "forbidden"}})
    made = Assembly.from_plan(
        AssemblyPlan.from_json(document), {"post": post, "wheel": WHEEL}, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1
    )
    found = examine(made).findings.errors

    assert {finding.route for finding in found} == {"design"}
    assert "parts.post.dimensions.pin to" in str(found[0].hint)


# A carriage that slides on a rail. The cone on it is a surface that nothing measures.
RAIL = """
from build123d import Box

def build(part):
    d = part.dimensions
    return Box(200, d["width"], d["height"]), dict(part.connectors)
"""
CARRIAGE = """
from build123d import Box, Cone, Pos

def build(part):
    d = part.dimensions
    return Box(40, 40, 20) + Pos(0, 0, 12) * Cone(8, 4, 6) - Box(41, d["slot"], d["opening"]), dict(part.connectors)
"""


def carriage_on_a_rail(
    carriage: str = CARRIAGE, gap: tuple[float, float] = (0.1, 0.3), **dimensions: float
) -> tuple[dict[str, Any], Assembly]:
    """A rail 12 mm wide in a slot of 12.4 mm."""
    own = {"width": 12, "height": 10, "slot": 12.4, "opening": 10.4} | dimensions
    way = {"z": [1, 0, 0], "x": [0, 0, 1], "o": [0, 0, 0], "label": "way", "name": "way"}
    parts = [
        {"name": name, "description": name, "dimensions": {key: own[key] for key in keys}, "connectors": [way]}
        for name, keys in {"rail": ("width", "height"), "carriage": ("slot", "opening")}.items()
    ]
    parts[1]["rest_pose"] = {"at": [0, 0, 0]}
    joint = {"name": "slide", "type": "slider", "parent": "rail.way", "child": "carriage.way", "travel_mm": [-50, 50]}
    document = plan("slide", parts, joint | {"fit": {"gap_mm": list(gap), "contact": "forbidden"}})
    scripts = {"rail": RAIL, "carriage": carriage}
    made = Assembly.from_plan(AssemblyPlan.from_json(document), scripts, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1)
    return document, made


def test_a_carriage_as_it_was_ordered_has_no_fault() -> None:
    assert examine(carriage_on_a_rail()[1]).findings.ok


@pytest.mark.parametrize("wrong", [{"width": 15}, {"width": 13.1}, {"slot": 9.92}, {"slot": 11.5}, {"gap": (0.5, 2)}], ids=str)
def test_slots_and_tongues_as_wide_as_they_were_ordered_are_the_designers_with_numbers_that_mend_them(wrong: dict[str, Any]) -> None:
    document, made = carriage_on_a_rail(**wrong)
    found = examine(made).findings.errors

    assert {finding.route for finding in found} == {"design"}
    (fit,) = [finding for finding in found if finding.code.startswith("E_FIT")]
    changed = [changed for changed in followed(fit, document) if changed != document]
    assert changed
    for other in changed:
        own = {key: value for part in other["parts"] for key, value in part["dimensions"].items()}
        if wrong.get("gap") is None or other["joints"] != document["joints"]:
            assert examine(carriage_on_a_rail(gap=tuple(other["joints"][0]["fit"]["gap_mm"]), **own)[1]).findings.ok, own


@pytest.mark.parametrize("aside", [1.7, -3.1, 0.9])
def test_a_slot_beside_its_way_is_its_authors(aside: float) -> None:
    _, made = carriage_on_a_rail(CARRIAGE.replace("- Box(41", f"- Pos(0, {aside}, 0) * Box(41"))
    found = examine(made).findings.errors

    assert {(finding.route, finding.where) for finding in found} == {("code", "parts.carriage")}
    assert f"the slot is {abs(aside):.4g} mm beside the axis" in found[0].hint


# A finger that is screwed on a jaw: two tapped holes, two through holes.
JAW = """
from build123d import Align, Box, Cylinder, Pos

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)

def build(part):
    d = part.dimensions
    shape = Box(d["length"], d["width"], d["height"], align=HIGH)
    for x in (d["near"], d["far"]):
        shape -= Pos(x, 0, 0) * Cylinder(d["screw"], d["depth"], align=HIGH)
    return shape, dict(part.connectors)
"""
FINGER = """
from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)

def build(part):
    d = part.dimensions
    shape = Box(d["length"], d["width"], d["height"], align=LOW)
    for x in (d["near"], d["far"]):
        shape -= Pos(x, 0, 0) * Cylinder(d["screw"], d["height"], align=LOW)
    return shape, dict(part.connectors)
"""
BESIDE_ITS_SEAT = FINGER.replace("    return shape", "    return Pos(7, 0, 0) * shape")
ELSEWHERE = FINGER.replace('d["far"])', 'd["far"] - 3.77)')


def finger_on_a_jaw(jaw: float = 20.3, finger: float = 20.3, seat: float = 0.0) -> dict[str, Any]:
    """A plan that orders the second screw of both parts 20.3 beside their seats."""
    frame = {"name": "seat", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "seat"}
    sizes = {
        "jaw": {"length": 71, "width": 18, "height": 23, "depth": 12.4, "near": 5.1, "far": jaw, "screw": 1.65},
        "finger": {"length": 63, "width": 16, "height": 9, "near": 5.1, "far": finger, "screw": 2.25},
    }
    parts = [{"name": name, "description": "A block.", "dimensions": own, "connectors": [frame]} for name, own in sizes.items()]
    parts[1] |= {"rest_pose": {"at": [-seat, 0, 0]}, "connectors": [frame | {"o": [seat, 0, 0]}]}
    fixed = {"name": "screwed", "type": "fixed", "parent": "jaw.seat", "child": "finger.seat"}
    return plan("gripper", parts, fixed) | {"freedoms": 0}


def screwed(document: dict[str, Any], finger: str = FINGER) -> tuple[Finding, ...]:
    scripts = {"jaw": JAW, "finger": finger}
    made = Assembly.from_plan(AssemblyPlan.from_json(document), scripts, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1)
    return examine(made).findings.of("W_HOLES_APART")


def test_holes_ordered_apart_are_the_designers_with_each_number_that_makes_them_meet() -> None:
    assert screwed(finger_on_a_jaw()) == ()
    (found,) = screwed(finger_on_a_jaw(finger=25.3))
    assert (found.route, found.where) == ("design", "joints.screwed")
    assert "Set parts.finger.dimensions.far to 20.3, or parts.jaw.dimensions.far to 25.3." in found.hint
    assert screwed(finger_on_a_jaw(jaw=25.3, finger=25.3)) == ()


def test_a_hole_is_measured_from_the_seat_of_its_part_too() -> None:
    (found,) = screwed(finger_on_a_jaw(finger=25.3, seat=7.0), BESIDE_ITS_SEAT)
    assert found.route == "design"
    assert "Set parts.finger.dimensions.far to 20.3, or parts.jaw.dimensions.far to 25.3." in found.hint


def test_a_hole_where_its_dimensions_do_not_put_it_is_its_authors() -> None:
    (found,) = screwed(finger_on_a_jaw(), ELSEWHERE)
    assert (found.route, found.where) == ("code", "parts.finger")
    assert "is at (16.53, 0, 0); its dimensions give (20.3, 0, 0)" in found.hint


def gripper(document: dict[str, Any], finger: str, **answers: str) -> Scripted:
    script = {"requirements": stories.requirements("gripper"), "design/1": json.dumps(document)} | watched()
    script |= {"part/jaw/1": fenced(JAW), "part/finger/1": fenced(finger)}
    return Scripted(script | {step.replace("__", "/"): answer for step, answer in answers.items()})


def test_holes_apart_are_asked_about_once_and_may_stay(tmp_path: Path) -> None:
    llm = gripper(finger_on_a_jaw(finger=25.3), FINGER, design__2='{"changes": {}}')
    run = made(tmp_path, llm)
    assert [step for step in llm.steps if step.startswith("design")] == ["design/1", "design/2"]
    assert [finding["code"] for finding in (run.verdict() or {})["findings"]] == ["W_HOLES_APART"]


def test_a_hole_that_departs_from_its_order_is_asked_of_its_author_once(tmp_path: Path) -> None:
    llm = gripper(finger_on_a_jaw(), ELSEWHERE, part__finger__2=fenced(FINGER))
    run = made(tmp_path, llm)
    asked_of = [step for step in llm.steps if step.startswith(("design", "part"))]
    assert asked_of[0] == "design/1"
    assert sorted(asked_of[1:3]) == ["part/finger/1", "part/jaw/1"], "both authors are asked side by side"
    assert asked_of[3:] == ["part/finger/2"]
    assert [finding["code"] for finding in (run.verdict() or {})["findings"]] == []
