"""The JSON Schema that models are prompted with, against a validator that is not ours."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from articad.plan.json_schema import json_schema
from articad.plan.schema import AssemblyPlan
from tests.plan.samples import FILES, chest, connector, document, joint

jsonschema = pytest.importorskip("jsonschema")

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*/plan.json"))
COMPACT = 20_000  # characters: about 5,000 tokens of a prompt


def errors(document: object) -> list[str]:
    return [error.message for error in jsonschema.Draft202012Validator(json_schema()).iter_errors(document)]


def test_it_is_a_schema_and_compact() -> None:
    schema = json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    text = json.dumps(schema, separators=(",", ":"))
    assert len(text) < COMPACT
    assert '"title"' not in text
    assert "x-articad" not in text
    assert "plan_form" not in text


def test_every_reference_leads_somewhere() -> None:
    schema = json_schema()
    text = json.dumps(schema)
    used = {piece.split('"')[0] for piece in text.split('"$ref": "#/$defs/')[1:]}
    assert used <= schema["$defs"].keys()
    assert schema["$defs"].keys() <= used


@pytest.mark.parametrize("name", FILES)
def test_the_plans_of_the_contract_are_valid(name: str) -> None:
    assert not errors(document(name))
    assert not errors(AssemblyPlan.from_json(document(name)).to_json())


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.parent.name)
def test_the_examples_are_valid(path: Path) -> None:
    assert not errors(json.loads(path.read_text()))


def test_it_refuses_what_reading_refuses() -> None:
    for change in (
        lambda p: p.update(colour="red"),
        lambda p: p.pop("ground"),
        lambda p: connector(p, "box", "hinge").update(z=[0, 1]),
        lambda p: joint(p, "hinge").update(type="hinge"),
        lambda p: joint(p, "hinge").update(travel_mm=[0, 1]),
        lambda p: joint(p, "hinge").update(mate="opposite"),
        lambda p: p.update(name="Chest"),
    ):
        plan = chest()
        change(plan)
        assert errors(plan)


def test_it_demands_the_limits_that_reading_leaves_to_the_check() -> None:
    plan = chest()
    del joint(plan, "hinge")["angle_deg"]
    assert errors(plan)
    AssemblyPlan.from_json(plan)


def test_each_call_returns_a_schema_of_its_own() -> None:
    json_schema()["$defs"].clear()
    assert json_schema()["$defs"]
