"""Prompts are code: what they teach is true, whole, and passes the checks that answers are held to."""

from __future__ import annotations

import json
import re
from typing import get_args

import pytest

from articad.agents.design import response_schema
from articad.agents.prompts import prompt, prompt_file
from articad.agents.replies import parse_object, parse_script
from articad.agents.requirements import Requirements
from articad.plan.check import check_plan
from articad.plan.expressions import FUNCTIONS
from articad.plan.fields import Form
from articad.plan.joint_forms import COUPLING_TYPES, JOINT_TYPES
from articad.plan.schema import AssemblyPlan, ConnectorKind, ConnectorSpec, PartSpec

DESIGN = prompt("design", example=prompt_file("sewing_box.json"))
PART = prompt("part_build123d", example=prompt_file("lid_left.txt"))


def test_the_example_of_the_design_prompt_is_valid_without_a_warning() -> None:
    assert len(check_plan(AssemblyPlan.loads(prompt_file("sewing_box.json")))) == 0


@pytest.mark.parametrize("parameter", ["width", "height"])
def test_the_example_holds_at_the_ends_of_its_parameters(parameter: str) -> None:
    plan = json.loads(prompt_file("sewing_box.json"))
    bounds = next(entry for entry in plan["parameters"] if entry["name"] == parameter)
    for end in ("min", "max"):
        bounds["value"] = bounds[end]
        assert len(check_plan(AssemblyPlan.from_json(plan))) == 0


def test_the_example_says_of_each_part_every_dimension_that_it_has() -> None:
    for part in AssemblyPlan.loads(prompt_file("sewing_box.json")).parts:
        if isinstance(part, PartSpec):
            missing = [name for name in part.dimensions if not re.search(rf"\b{name}\b", part.description)]
            assert missing == [], part.name


def forms(root: type[Form]) -> set[type[Form]]:
    """All forms that a plan can hold."""
    found: set[type[Form]] = set()

    def visit(annotation: object) -> None:
        if isinstance(annotation, type) and issubclass(annotation, Form) and annotation not in found:
            found.add(annotation)
            for field in annotation.model_fields.values():
                visit(field.annotation)
                for extra in field.metadata:
                    visit(extra)
        for argument in get_args(annotation):
            visit(argument)

    visit(root)
    return found


def test_the_design_prompt_names_every_field_of_the_plan_that_a_model_may_use() -> None:
    fields = {field.alias or name for form in forms(AssemblyPlan) for name, field in form.model_fields.items()}
    not_for_models = {"kernel", "effort_n_mm", "velocity_deg_s", "effort_n", "velocity_mm_s"}

    assert len(fields) > 50
    assert {field for field in fields - not_for_models if not re.search(rf"\b{field}\b", DESIGN)} == set()


def test_the_design_prompt_names_every_type_kind_and_function() -> None:
    for name in (*JOINT_TYPES, *COUPLING_TYPES, *get_args(ConnectorKind), *FUNCTIONS):
        assert re.search(rf"\b{name}\b", DESIGN), name


def test_the_defaults_that_the_design_prompt_states_are_those_of_the_plan() -> None:
    assert AssemblyPlan.model_fields["tree"].default is False
    assert ConnectorSpec.model_fields["frame"].default == "part"
    assert '`frame`="part"' in DESIGN
    assert "`tree`=false" in DESIGN


def test_the_schema_of_a_plans_reply_asks_for_what_the_plan_requires() -> None:
    required = {field.alias or name for name, field in AssemblyPlan.model_fields.items() if field.is_required()}
    schema = response_schema()

    assert set(schema["required"]) == required
    assert set(schema["properties"]) <= {field.alias or name for name, field in AssemblyPlan.model_fields.items()}


def test_the_example_of_the_requirements_prompt_has_the_form() -> None:
    example = prompt_file("requirements.md").split("\n\n{", 1)[1].split("\n}", 1)[0]
    text = re.sub(r"\s+//.*", "", "{" + example + "\n}")

    assert Requirements.model_validate(parse_object(text, step="x")).name == "desk_lamp"


def test_the_prompts_have_no_blank_left_and_no_path_or_address() -> None:
    for text in (DESIGN, PART, prompt("requirements")):
        assert "{{" not in text
        assert not re.search(r"/(home|tmp|work|usr)/|https?://", text)


def test_the_worked_script_is_read_out_of_a_reply_like_any_other() -> None:
    assert parse_script(PART, step="x").decode().strip() == prompt_file("lid_left.txt")
