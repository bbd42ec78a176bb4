"""The short form stands for a plan of the long form, and standard joints for features of their parts."""

from __future__ import annotations

import copy
import json
import math
from pathlib import Path
from typing import Any

import pytest

from articad import Assembly
from articad.geometry.mass import MassProperties
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.plan.short import expanded
from tests.plan.samples import FILES, Json, document

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


@pytest.mark.parametrize("kind", ["dowel", "drawer_slide", "ball_socket"])
def test_other_standard_joints_order_features_that_fit(kind: str) -> None:
    size: tuple[str, Any] = {"dowel": ("pin_mm", 8), "drawer_slide": ("bar_mm", [8, 5]), "ball_socket": ("ball_mm", 8)}[kind]
    limits: dict[str, Json] = {"dowel": {}, "drawer_slide": {"travel_mm": [0, 9]}, "ball_socket": {"cone_deg": 20}}
    plan: Json = copy.deepcopy(GATE) | {
        "joints": {"j": {"type": kind, "parent": "post", "child": "leaf", "at": [0, 0, 9], size[0]: size[1]}}
    }
    plan["joints"]["j"] |= limits[kind] | ({"length_mm": 12} if kind != "ball_socket" else {})
    del plan["parts"]["twin"]
    long = expanded(plan)
    dimensions = {part["name"]: {key: value for key, value in part["dimensions"].items() if key.startswith("j_")} for part in long["parts"]}
    assert (
        dimensions
        == {
            "dowel": {"post": {"j_pin": 8, "j_length": 12}, "leaf": {"j_bore": 8}},
            "drawer_slide": {"post": {"j_bar_x": 8, "j_bar_y": 5, "j_length": 12}, "leaf": {"j_slot_x": 8.3, "j_slot_y": 5.3}},
            "ball_socket": {"post": {"j_ball": 8}, "leaf": {"j_socket": 8.3}},
        }[kind]
    )


def test_what_is_wrong_in_a_short_plan_is_reported_at_its_address() -> None:
    plan = copy.deepcopy(GATE)
    plan["parts"]["leaf"]["material"] = "unobtainium"
    plan["joints"]["swing"]["angle_deg"] = ["nothing", 0]
    found = {(finding.code, finding.where) for finding in check_plan(AssemblyPlan.from_json(plan))}
    assert {("E_MATERIAL_UNKNOWN", "parts.leaf.material"), ("E_EXPRESSION", "joints.swing.angle_deg[0]")} <= found


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
