"""Plans for the tests: two stated in full in files, and small ones that a test changes to its need."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

from articad.findings import Finding, Findings
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan

Json = dict[str, Any]

DATA = Path(__file__).parent / "data"
FILES = ("wardrobe", "geared_four_bar")

_CHEST: Json = {
    "schema": "articad.plan/1",
    "name": "chest",
    "ground": "box",
    "freedoms": 1,
    "parameters": [{"name": "width", "value": 300, "min": 200, "max": 400}],
    "materials": [{"name": "wood", "density_kg_m3": 650, "color": "#c8a46e"}],
    "parts": [
        {
            "name": "box",
            "material": "wood",
            "description": "Open box.",
            "dimensions": {"width": "width"},
            "connectors": [{"name": "hinge", "o": [0, 100, 80], "z": [1, 0, 0], "x": [0, 0, 1], "label": "hinge axis"}],
        },
        {
            "name": "lid",
            "material": "wood",
            "description": "Flat lid.",
            "rest_pose": {"at": [0, 100, 80]},
            "connectors": [{"name": "hinge", "o": [0, 0, 0], "z": [1, 0, 0], "x": [0, 0, 1], "label": "hinge axis"}],
        },
    ],
    "joints": [{"name": "hinge", "type": "revolute", "parent": "box.hinge", "child": "lid.hinge", "angle_deg": [0, 110]}],
}


def chest() -> Json:
    """Return a box with a hinged lid: valid, and without a finding."""
    return copy.deepcopy(_CHEST)


def pair(joint: Json, freedoms: int, **plan: Any) -> Json:
    """Return two parts with one connector each at the origin, z up, and the given joint between them."""
    parts = [
        {"name": name, "material": "steel", "description": "", "connectors": [{"name": "c", "o": [0, 0, 0], "z": [0, 0, 1], "label": ""}]}
        for name in ("a", "b")
    ]
    return {
        "schema": "articad.plan/1",
        "name": "pair",
        "ground": "a",
        "freedoms": freedoms,
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": parts,
        "joints": [{"name": "j", "parent": "a.c", "child": "b.c", **joint}],
        **plan,
    }


def gears(**coupling: Any) -> Json:
    """Return a frame with two turning wheels, a slider, and one coupling."""
    connectors = [{"name": name, "o": [x, 0, 0], "z": [0, 0, 1], "label": ""} for name, x in (("p", 0), ("q", 60), ("r", 120))]
    wheels = [
        {"name": name, "material": "steel", "description": "", "connectors": [{"name": "c", "o": [x, 0, 0], "z": [0, 0, 1], "label": ""}]}
        for name, x in (("small", 0), ("large", 60), ("rod", 120))
    ]
    return {
        "schema": "articad.plan/1",
        "name": "gears",
        "ground": "frame",
        "freedoms": 2,
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": [{"name": "frame", "material": "steel", "description": "", "connectors": connectors}, *wheels],
        "joints": [
            {"name": "turn_small", "type": "revolute", "parent": "frame.p", "child": "small.c", "angle_deg": "endless"},
            {"name": "turn_large", "type": "revolute", "parent": "frame.q", "child": "large.c", "angle_deg": [-180, 180]},
            {"name": "slide", "type": "slider", "parent": "frame.r", "child": "rod.c", "travel_mm": [0, 100]},
        ],
        "couplings": [{"name": "tie", **coupling}],
    }


def document(name: str) -> Json:
    """Return one of the plans in files."""
    loaded: Json = json.loads((DATA / f"{name}.json").read_text())
    return loaded


def part(plan: Json, name: str) -> Json:
    """Return a part of a document, to be changed."""
    found: Json = next(part for part in plan["parts"] if part["name"] == name)
    return found


def joint(plan: Json, name: str) -> Json:
    """Return a joint of a document, to be changed."""
    found: Json = next(joint for joint in plan["joints"] if joint["name"] == name)
    return found


def connector(plan: Json, part_name: str, name: str) -> Json:
    """Return a connector of a document, to be changed."""
    found: Json = next(connector for connector in part(plan, part_name)["connectors"] if connector["name"] == name)
    return found


def check(plan: Json) -> Findings:
    """Return the findings of a document."""
    return check_plan(AssemblyPlan.from_json(plan))


def only(findings: Findings, code: str) -> Finding:
    """Return the one finding of a code; fail if there are others of it or none."""
    found = findings.of(code)
    assert len(found) == 1, f"{len(found)} findings {code} in:\n{findings}"
    return found[0]
