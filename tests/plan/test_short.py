"""The short form stands for a plan of the long form, and standard joints for features of their parts."""

from __future__ import annotations

import contextlib
import copy
import json
import math
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from articad import Assembly
from articad.errors import PlanError
from articad.geometry.mass import MassProperties
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.plan.short import expanded
from articad.plan.standard_joints import STANDARD
from benchmarks.written import GOAL, NAMES, written
from tests.plan.samples import FILES, Json, document
from tests.plan.test_short_texts import CART, ROD

PRODUCTS = Path(__file__).parents[2] / "benchmarks" / "products"
EXAMPLES = Path(__file__).parents[2] / "examples"

GATE: Json = {
    "schema": "articad.short/1",
    "name": "gate",
    "ground": "post",
    "freedoms": 2,
    "parameters": {"pin": 6, "top_deg": {"value": 90, "max": 100}},
    "parts": {
        "post": {"material": "steel", "dimensions": "width = 20, height = 10"},
        "leaf": {"material": "oak", "dimensions": "width = 20, height = 8", "rest_pose": {"at": [0, 0, 10.2]}},
        "twin": {"derive": {"from": "leaf", "op": "mirror", "plane": {"point": [30, 0, 0], "normal": [1, 0, 0]}}},
    },
    "joints": {
        "swing": {
            "type": "hinge",
            "parent": "post",
            "child": "leaf",
            "at": [-2, 0, 10],
            "pin_mm": "pin",
            "length_mm": 5,
            "depth_mm": 6,
            "angle_deg": [0, "top_deg"],
        },
        "other": {"derive": {"from": "swing", "op": "mirror"}, "parent": "post", "child": "twin"},
    },
}
SCRIPT = """
from build123d import Box, Pos

def build(part):
    d = part.dimensions
    wide = 200 if part.name == "post" else 0
    return part.made(Pos(0, 0, d.height / 2) * Box(d.width + wide, d["width"], d.height))
"""


def mass_of(assembly: Assembly, part: str) -> MassProperties:
    held = assembly.parts[part].mass
    assert held is not None
    return held


@pytest.mark.parametrize("name", FILES)
def test_a_plan_of_the_long_form_is_left_alone(name: str) -> None:
    plan = document(name)
    assert expanded(plan) is plan


def test_a_short_plan_is_a_plan_without_a_finding_and_is_not_modified() -> None:
    kept = copy.deepcopy(GATE)
    plan = AssemblyPlan.from_json(GATE)
    assert kept == GATE
    assert not list(check_plan(plan))
    assert AssemblyPlan.loads(plan.dumps()) == plan


def test_a_joint_places_both_connectors_and_its_mirror_image_both_images() -> None:
    resolved = resolve(AssemblyPlan.from_json(GATE))
    for part, connector, place in (
        ("post", "swing", (-2, 0, 10)),
        ("leaf", "swing", (-2, 0, 10)),
        ("post", "other", (62, 0, 10)),
        ("twin", "swing", (62, 0, 10)),
    ):
        held = resolved.parts[part]
        assert held.T_rest.apply([held.connectors[connector].frame.translation])[0] == pytest.approx(place)
    assert resolved.fits["swing"].gap_min == pytest.approx(0.075)
    assert resolved.fits["swing"].gap_max == pytest.approx(0.225)


def test_a_hinge_adds_its_pin_and_its_bore_with_their_clearance() -> None:
    """Volumes of the closed formulas: box, plus or minus cylinders."""
    built = Assembly.from_plan(AssemblyPlan.from_json(GATE), {name: SCRIPT.encode() for name in ("post", "leaf")})
    post = 220 * 20 * 10 + 2 * math.pi * 3**2 * 5
    leaf = 20 * 20 * 8 - math.pi * 3.15**2 * 5.8  # the bore begins 0.2 mm below the leaf
    assert mass_of(built, "post").mass == pytest.approx(post * 7850e-9, rel=1e-6)
    assert mass_of(built, "leaf").mass == pytest.approx(leaf * 700e-9, rel=1e-6)
    checks = built.check()
    assert checks.ok
    assert [row.to_json()["play_mm"] for row in checks.fits] == pytest.approx([0.15, 0.15], abs=1e-3)


STANDARD_JOINTS: dict[str, tuple[Json, Json, Json]] = {
    "dowel": ({"pin_mm": 8, "length_mm": 12}, {"j_pin": 8, "j_length": 12}, {"j_bore": 8}),
    "hinge": ({"pin_mm": 8, "length_mm": 0, "angle_deg": [0, 9]}, {}, {"j_bore": 8.3}),  # the part has its pin already
    "drawer_slide": (
        {"bar_mm": [8, 5], "length_mm": 12, "travel_mm": [0, 9]},
        {"j_bar_x": 8, "j_bar_y": 5, "j_length": 12},
        {"j_slot_x": 8.3, "j_slot_y": 5.3},
    ),
    "ball_socket": ({"ball_mm": 8, "cone_deg": 20}, {"j_ball": 8}, {"j_socket": 8.3}),
    "pin_in_clevis": (
        {"pin_mm": 8, "length_mm": 30, "eye_mm": 10, "reach_mm": 14, "angle_deg": [0, 9]},
        {"j_pin": 8, "j_span": 30, "j_gap": 10.3, "j_reach": 14},
        {"j_bore": 8.3},
    ),
    "snap_ring": ({"shaft_mm": 10, "groove_mm": [9.6, 1.1]}, {"j_shaft": 10, "j_groove": 9.6, "j_width": 1.1}, {"j_bore": 9.6}),
}


def test_every_standard_joint_has_its_features_tested() -> None:
    assert set(STANDARD_JOINTS) == set(STANDARD)


@pytest.mark.parametrize("kind", STANDARD_JOINTS)
def test_standard_joints_order_features_that_fit(kind: str) -> None:
    stated, inner, outer = STANDARD_JOINTS[kind]
    plan: Json = copy.deepcopy(GATE) | {"joints": {"j": {"type": kind, "parent": "post", "child": "leaf", "at": [0, 0, 9], **stated}}}
    del plan["parts"]["twin"]
    long = expanded(plan)
    dimensions = {part["name"]: {key: value for key, value in part["dimensions"].items() if key.startswith("j_")} for part in long["parts"]}
    assert dimensions == {"post": inner, "leaf": outer}
    (joint,) = long["joints"]
    assert joint["type"] == STANDARD[kind]
    assert {"bar_mm", "pin_mm", "ball_mm", "eye_mm", "reach_mm", "shaft_mm", "groove_mm", "length_mm"}.isdisjoint(joint)


CLEVIS: Json = {
    "schema": "articad.short/1",
    "name": "clevis",
    "ground": "fork",
    "freedoms": 1,
    "parts": {
        "fork": {"material": "steel", "dimensions": "size = 30"},
        "eye": {"material": "steel", "dimensions": "size = 20", "rest_pose": {}},
        "ring": {"material": "steel", "dimensions": "size = 3", "rest_pose": {}},
    },
    "joints": {
        "turn": {"type": "pin_in_clevis", "parent": "fork", "child": "eye", "at": [0, 0, 0], "pin_mm": 8, "length_mm": 40, "eye_mm": 10}
        | {"reach_mm": 16, "angle_deg": [-40, 40]},
        "clip": {"type": "snap_ring", "parent": "fork", "child": "ring", "at": [0, 0, 18], "shaft_mm": 8, "groove_mm": [7.6, 0.9]},
    },
}
PIECES = {
    "fork": "Pos(-15) * Box(d['size'], 20, d['size'])",
    "eye": "Cylinder(d['size'] / 2, 10) + Pos(15) * Box(d['size'], 10, 10)",
    "ring": "Pos(0, 0, 18) * Cylinder(2 * d['size'], 0.8)",
}


def test_a_clevis_clears_its_eye_and_a_snap_ring_sits_in_its_groove() -> None:
    """Volumes by closed formulas: the fork less half a disc of 16 mm cut off at its sides, plus the pin outside of the cheeks, less the groove."""
    scripts = {
        name: f"from build123d import *\ndef build(part):\n    d = part.dimensions\n    return part.made({shape})\n".encode()
        for name, shape in PIECES.items()
    }
    built = Assembly.from_plan(AssemblyPlan.from_json(CLEVIS), scripts)
    checks = built.check()
    assert checks.ok, str(checks.findings)
    assert [row.to_json()["play_mm"] for row in checks.fits] == pytest.approx([0.15], abs=1e-3)
    assert built.certify(["turn"]).ok
    half = 10.0  # of the width of the fork, beyond which there is nothing to cut
    segment = half * math.sqrt(16**2 - half**2) + 16**2 * math.asin(half / 16)
    pin = math.pi * 4**2 * 40 - math.pi * 4**2 / 2 * (30 - 10.3)  # half of the pin is inside of both cheeks
    groove = math.pi * (4**2 - 3.8**2) * 0.9
    fork = 30 * 20 * 30 - segment * 10.3 + pin - groove
    assert mass_of(built, "fork").mass == pytest.approx(fork * 7850e-9, rel=1e-6)


def test_a_joint_may_stand_where_another_joint_is() -> None:
    plan = copy.deepcopy(GATE)
    plan["parts"]["knob"] = {"material": "oak", "dimensions": "size = 9", "rest_pose": {"at": [0, 0, 20]}}
    plan["joints"] = {"grip": {"type": "fixed", "parent": "leaf", "child": "knob", "at": "swing"}} | plan["joints"]
    resolved = resolve(AssemblyPlan.from_json(plan))
    knob = resolved.parts["knob"]
    assert knob.T_rest.apply([knob.connectors["grip"].frame.translation])[0] == pytest.approx((-2, 0, 10))


@pytest.mark.parametrize("at", ["top face of post", "axis of bore 1", "post.top", "swnig", 7])
def test_an_at_that_is_no_place_is_one_finding_that_names_what_is(at: Any) -> None:
    """A plan has no shapes before its scripts run, so a face has no place in it; the axis of a bore is that of the joint which it makes."""
    plan = copy.deepcopy(GATE)
    plan["parts"]["knob"] = {"material": "oak", "dimensions": "size = 9", "rest_pose": {"at": [0, 0, 20]}}
    plan["joints"]["grip"] = {"type": "fixed", "parent": "leaf", "child": "knob", "at": at}
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(plan)
    (finding,) = refused.value.findings
    assert (finding.code, finding.where) == ("E_SCHEMA", "joints.grip.at")
    assert "Give a point [x, y, z]" in finding.hint
    assert "the name of a joint that is there: swing" in finding.hint
    assert ("Did you mean 'swing'?" in finding.hint) == (at == "swnig")
    plan["joints"]["grip"]["at"] = "swing"
    assert check_plan(AssemblyPlan.from_json(plan)).of("E_SCHEMA") == ()


@pytest.mark.parametrize("copied", ["parent", "child", "child of its own name"])
def test_a_derived_joint_of_a_part_that_is_no_copy_gets_the_image_of_the_place_and_of_the_features(copied: str) -> None:
    """A gate whose mirror image has a post or a leaf of its own; a mirrored joint turns the other way."""
    plan = copy.deepcopy(GATE)
    own = {"material": "oak", "dimensions": "width = 20, height = 8", "rest_pose": {"at": [60, 0, 10.2]}}
    if copied == "parent":  # another leaf on the image of a bracket
        plan["parts"] |= {"bracket": own | {"rest_pose": {"at": [0, 0, 1]}}, "leaf_r": own}
        plan["parts"]["bracket_r"] = {"derive": plan["parts"]["twin"]["derive"] | {"from": "bracket"}}
        plan["joints"]["swing"]["parent"] = "bracket"
        plan["joints"]["hold"] = {"type": "fixed", "parent": "post", "child": "bracket", "at": [0, 0, 5]}
        plan["joints"]["hold_r"] = {"derive": {"from": "hold", "op": "mirror"}, "parent": "post", "child": "bracket_r"}
        plan["joints"]["other"] |= {"parent": "bracket_r", "child": "leaf_r"}
        del plan["parts"]["twin"]
        owner, feature = "leaf_r", "other_bore"
    else:
        owner, feature = "post", "other_pin"
        if copied != "child":
            plan["joints"]["other"]["child"] = "twin.swing"
    resolved = resolve(AssemblyPlan.from_json(plan))
    held = resolved.parts[owner]
    assert feature in held.dimensions
    assert held.T_rest.apply([held.connectors["other"].frame.translation])[0] == pytest.approx((62, 0, 10))
    (other,) = next(joint.columns for joint in resolved.joints if joint.name == "other")
    assert [math.degrees(other.lower), math.degrees(other.upper)] == pytest.approx([-90, 0])
    assert not [finding for finding in check_plan(AssemblyPlan.from_json(plan)) if finding.severity == "error"]


@pytest.mark.parametrize("missing", [key for key in GATE["joints"]["swing"] if key != "length_mm"])
def test_a_derived_joint_whose_source_lacks_a_field_is_written_out_or_refused_by_the_plan(missing: str) -> None:
    """The image is a leaf of its own on a copy of the bracket, so the joint is written in full."""
    plan = copy.deepcopy(GATE)
    plan["parts"]["bracket"] = {"material": "oak", "dimensions": "width = 20, height = 8", "rest_pose": {"at": [0, 0, 1]}}
    plan["parts"]["bracket_r"] = {"derive": plan["parts"]["twin"]["derive"] | {"from": "bracket"}}
    plan["parts"]["leaf_r"] = plan["parts"].pop("twin") and copy.deepcopy(plan["parts"]["leaf"])
    plan["joints"]["swing"]["parent"] = "bracket"
    plan["joints"]["other"] |= {"parent": "bracket_r", "child": "leaf_r"}
    del plan["joints"]["swing"][missing]
    with suppress(PlanError):
        check_plan(AssemblyPlan.from_json(plan))


def test_what_is_wrong_in_a_short_plan_is_reported_at_its_address() -> None:
    plan = copy.deepcopy(GATE)
    plan["parts"]["leaf"]["material"] = "unobtainium"
    plan["joints"]["swing"]["angle_deg"] = ["nothing", 0]
    found = {(finding.code, finding.where) for finding in check_plan(AssemblyPlan.from_json(plan))}
    assert {("E_MATERIAL_UNKNOWN", "parts.leaf.material"), ("E_EXPRESSION", "joints.swing.angle_deg[0]")} <= found


ODD: tuple[Any, ...] = (
    None,
    0,
    1.5,
    "",
    "hinge a b c; at 1,2",
    {"at": "joint"},
    "a.b",
    [],
    [1],
    [[1]],
    ["parent"],
    {},
    {"a": 1},
    True,
    "hinge",
    [0, 0, "0"],
)
ADDED = (
    "derive",
    "name",
    "type",
    "parent",
    "child",
    "at",
    "dimensions",
    "connectors",
    "material",
    "angle_deg",
    "pin_on",
    "fit",
    "groove_mm",
    "like",
    "by",
    "head_mm",
    "blind",
    "rest_pose",
)
MOVES = (
    {"from": "swing", "op": "mirror"},
    {"from": "leaf", "op": "mirror", "plane": {"normal": [1, 0, 0], "point": 3}},
    {"from": "leaf", "op": "rigid", "move": {"at": 5}},
    {"from": "leaf", "op": "rigid", "move": {"at": ["a", None, 2]}},
)


def places(value: Any, *path: Any) -> Iterator[tuple[Any, ...]]:
    """Yield where there is anything in a document, by its keys."""
    for key in value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
        yield (*path, key)
        yield from places(value[key], *path, key)


@pytest.mark.parametrize("plan", [GATE, CLEVIS, CART, ROD], ids=["gate", "clevis", "cart", "rod"])
def test_whatever_a_short_plan_holds_is_a_plan_or_is_reported_where_it_is(plan: Json) -> None:
    """The short form itself refuses nothing: what it does not understand is left for the plan's own form to report."""
    tried = [(path, value) for path in places(plan) for value in (*ODD, *MOVES)]
    tried += [((*path, name), value) for path in places(plan) if len(path) == 2 for name in ADDED for value in (*ODD, *MOVES)]
    for path, value in tried:
        changed = copy.deepcopy(plan)
        holder = changed
        for key in path[:-1]:
            holder = holder[key]
        if path == ("schema",) or not isinstance(holder, dict | list):
            continue
        holder[path[-1]] = copy.deepcopy(value)
        with contextlib.suppress(PlanError):
            AssemblyPlan.from_json(changed)


def test_a_side_that_is_a_list_is_reported_at_its_address() -> None:
    plan = copy.deepcopy(GATE)
    plan["joints"]["swing"]["pin_on"] = ["parent"]
    with pytest.raises(PlanError) as refused:
        AssemblyPlan.from_json(plan)
    assert [finding.where for finding in refused.value.findings] == ["joints.swing.pin_on"]


@pytest.mark.parametrize("normal", [["0", "0", "1"], [0.0, 0.0, 1.0], [0, 0.0, 2.5]])
def test_a_mirror_plane_of_texts_or_decimals_is_that_of_whole_numbers(normal: list[object]) -> None:
    plan = copy.deepcopy(GATE)
    plan["parts"]["twin"]["derive"]["plane"]["normal"] = normal
    numbers = copy.deepcopy(GATE)
    numbers["parts"]["twin"]["derive"]["plane"]["normal"] = [0, 0, 1]
    first, second = (expanded(each)["joints"] for each in (plan, numbers))
    assert first == second
    places_of = [[c for part in expanded(each)["parts"] for c in part.get("connectors", [])] for each in (plan, numbers)]
    assert places_of[0] == places_of[1]


def test_the_short_wardrobe_is_the_wardrobe_of_the_examples_in_two_fifths_of_the_characters() -> None:
    """Every part has its mass, its size and its place, from 37 % of the characters."""
    short, long = PRODUCTS / "wardrobe", EXAMPLES / "wardrobe"
    ours, theirs = (Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts") for folder in (short, long))
    for mine, other in zip(ours.parts, theirs.parts, strict=True):
        assert mass_of(ours, mine).mass == pytest.approx(mass_of(theirs, other).mass, rel=1e-9)
        at = [each.at()[name].apply([mass_of(each, name).com])[0] for each, name in ((ours, mine), (theirs, other))]
        assert at[0] == pytest.approx(at[1], abs=1e-6)
    written = [
        sum(file.stat().st_size for file in [folder / "plan.json", *(folder / "parts").glob("*.py")] if ".freecad" not in file.name)
        for folder in (short, long)
    ]
    assert written[0] <= 0.4 * written[1]
    assert json.loads((short / "plan.json").read_text())["schema"] == "articad.short/1"


@pytest.mark.parametrize("name", NAMES)
def test_a_product_takes_no_more_characters_than_a_script_without_a_tool(name: str) -> None:
    now, before = written(name), NAMES[name]
    assert now <= before.alone
    assert now <= GOAL * before.long
    plan = AssemblyPlan.load(PRODUCTS / name)
    assert not [finding for finding in check_plan(plan) if finding.severity != "info"]
