"""Failures whose cause is one number of the plan go to the designer, with the number; those of a script stay with its author."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from articad.agents.llm import Scripted
from articad.agents.pipeline import generate
from articad.assembly import Assembly
from articad.errors import KernelError
from articad.findings import Finding
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run
from tests.agents import stories
from tests.agents.stories import fenced

STEP = """
from build123d import Align, Box, Pos

def build(part):
    d = part.dimensions
    low = (Align.MIN,) * 3
    shape = Box(d["length"], d["side"], d["side"], align=low)
    shape += Pos(d["at"], 0, d["side"] - d["overlap"]) * Box(d["length"] / 2, d["side"], d["side"], align=low)
    return shape - Pos(1, 1, 1) * Box(d["length"] - d["wall"] * 4, d["side"] - 2, 2, align=low), {}
"""
SIZES = {"length": 60, "side": 15, "at": 20, "wall": 8, "overlap": 1}
PARTED = STEP.replace('d["side"] - d["overlap"])', 'd["side"] + d["overlap"])')


def plan(**dimensions: Any) -> AssemblyPlan:
    part = {"name": "step", "material": "oak", "description": "Two boxes.", "dimensions": {**SIZES, **dimensions}}
    document = {
        "schema": "articad.plan/1",
        "name": "slip",
        "ground": "step",
        "freedoms": 0,
        "parameters": [{"name": "deep", "value": 0.015}, {"name": "wide", "value": "2 * deep"}],
        "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#b58b5a"}],
        "parts": [part],
        "joints": [],
    }
    return AssemblyPlan.from_json(document)


def failure(plan: AssemblyPlan, script: str) -> tuple[Finding, ...]:
    with pytest.raises(KernelError) as caught:
        Assembly.from_plan(plan, {"step": script}, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1)
    return tuple(caught.value.findings.errors)


@pytest.mark.parametrize(
    ("slip", "said"),
    [
        ({"at": -40}, "parts.step.dimensions.at is 40 instead of -40 (is its sign wrong?)"),
        ({"side": "deep"}, "parameters.deep.value is 15 instead of 0.015 (were metres given?)"),
        ({"side": "wide / 2"}, "parameters.deep.value is 15 instead of 0.015 (were metres given?)"),
        ({"wall": 8000}, "parts.step.dimensions.wall is 8 instead of 8000 (were micrometres given?)"),
    ],
    ids=["sign", "parameter", "parameter of a parameter", "micrometres"],
)
def test_a_number_that_heals_the_script_is_asked_of_the_designer(slip: dict[str, Any], said: str) -> None:
    for finding in failure(plan(**slip), STEP):
        assert finding.route == "design"
        assert said in finding.hint


LEAF = """
from build123d import Align, Box, Pos

def build(part):
    d = part.dimensions
    low = (Align.MIN,) * 3
    return Box(d["width"], 20, d["height"], align=low) + Pos(d["width"] - 1, 0, d["pin_z"]) * Box(9, d["pin"], d["pin"], align=low), {}
"""


@pytest.mark.parametrize("height", [900, 1250, 2000])
def test_a_number_that_becomes_round_in_inches_is_asked_first(height: int) -> None:
    """The pin hangs beside a leaf that is too short; a thick pin would reach it as well, but nobody means 127 mm."""
    sizes = {"width": 390, "height": round(height / 25.4, 6), "pin_z": 100, "pin": 5}
    document = plan().to_json()
    document["parts"][0]["dimensions"] = sizes
    for finding in failure(AssemblyPlan.from_json(document), LEAF):
        assert finding.route == "design"
        assert finding.hint.startswith(f"The script of step builds if parts.step.dimensions.height is {height} instead of")


BUSH = """
from build123d import Align, Box, Cylinder, Plane, Rot

def build(part):
    d = part.dimensions
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    shape = Box(d["wide"], d["deep"], d["high"], align=low) - Cylinder(d["bore"] / 2, d["high"], align=low)
    return TURN * shape, dict(part.connectors)
"""


@pytest.mark.parametrize("turn", ["", "Rot(X=90)", "Rot(Y=90)", "Rot(Z=90)"])
@pytest.mark.parametrize("sides", ["xyz", "zyx", "xzy", "yxz", "zxy"])
def test_an_envelope_with_exchanged_sides_is_the_designers_and_a_turned_part_its_authors(sides: str, turn: str) -> None:
    """The bore shows in which plane a part was built, if its sides are not turned about the bore."""
    size = {"x": 40, "y": 60, "z": 10}
    document = plan().to_json()
    axis = {"name": "axis", "kind": "bore_axis", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "axis"}
    document["parts"][0] |= {"dimensions": {"wide": 40, "deep": 60, "high": 10, "bore": 8}, "connectors": [axis]}
    document["parts"][0]["envelope_mm"] = [size[side] for side in sides]
    script = BUSH.replace("TURN * ", f"{turn} * " if turn else "")
    try:
        made = Assembly.from_plan(
            AssemblyPlan.from_json(document), {"step": script}, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1
        )
        found = tuple(finding for finding in made.findings if finding.severity != "info")
    except KernelError as error:
        found = tuple(error.findings.errors)
    wrong = {finding.route for finding in found}

    if not turn:
        assert wrong == ({"design"} if sides != "xyz" else set())
        assert all('"parts.step.envelope_mm": [40, 60, 10]' in finding.hint.replace(".0", "") for finding in found)
    elif turn != "Rot(Z=90)":
        assert wrong == {"code"}


@pytest.mark.parametrize(
    "script",
    [PARTED, STEP.replace('d["wall"]', 'd["walls"]'), STEP.replace("return shape", "return None or shap")],
    ids=["two bodies", "a dimension that does not exist", "a name that does not exist"],
)
def test_a_fault_of_the_script_stays_with_its_author(script: str) -> None:
    assert {finding.route for finding in failure(plan(), script)} == {"code"}


# ---------------------------------------------------------------------- in a run


def asked(llm: Scripted, step: str) -> str:
    request = next(request for request in llm.requests if request.step == step)
    return "\n".join(part["text"] for part in request.to_json()["messages"][-1]["content"] if part["type"] == "text")


def run_of(tmp_path: Path, llm: Scripted) -> Run:
    settings = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache())
    return generate("a product", llm=llm, out=tmp_path / "run", **settings)


def test_the_author_is_not_asked_to_mend_what_the_designer_ordered(tmp_path: Path) -> None:
    right = copy.deepcopy(stories.FLAP_PLAN)
    right["parts"][1]["dimensions"]["reach"] = right["parts"][1]["dimensions"].pop("length")
    wrong = copy.deepcopy(right)
    wrong["parts"][1]["dimensions"]["reach"] = -30
    script = fenced(stories.FLAP_SCRIPTS["flap"].replace("length", "reach"))
    llm = stories.flap(design__1=json.dumps(wrong), part__flap__1=script, design__2=json.dumps(right), part__flap__5=script)
    run = run_of(tmp_path, llm)

    steps = [step for step in llm.steps if step.startswith(("design", "part/flap"))]
    assert steps == ["design/1", "part/flap/1", "design/2", "part/flap/5"]
    assert "The script of flap builds if parts.flap.dimensions.reach is 30 instead of -30" in asked(llm, "design/2")
    assert (run.checks() or {})["ok"]


def test_an_author_may_object_to_the_order_and_the_designer_reads_why(tmp_path: Path) -> None:
    objection = json.dumps({"cannot_be_built": "lift 1 and thickness 2 leave\n nothing of side 10."})
    changed = copy.deepcopy(stories.FLAP_PLAN)
    changed["parts"][1]["description"] += " The side is as wide as the plate."
    llm = stories.flap(
        part__flap__1=f"```json\n{objection}\n```", design__2=json.dumps(changed), part__flap__5=fenced(stories.FLAP_SCRIPTS["flap"])
    )
    run = run_of(tmp_path, llm)

    assert [step for step in llm.steps if step.startswith(("design", "part/flap"))] == [
        "design/1",
        "part/flap/1",
        "design/2",
        "part/flap/5",
    ]
    told = asked(llm, "design/2")
    assert "E_ORDER_REFUSED parts.flap: flap cannot be built: lift 1 and thickness 2 leave nothing of side 10." in told
    assert (run.round(1) or {})["kept"] == ["plate"]
    assert (run.verdict() or {})["ok"]
