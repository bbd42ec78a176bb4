"""Prompts are code: what they teach is true, whole, and passes the checks that answers are held to."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from pydantic import BaseModel

from articad.agents.brainstorm import Alternatives
from articad.agents.design import response_schema
from articad.agents.edit import Change
from articad.agents.inspection import Judgement, Look, Observations
from articad.agents.late import Connections
from articad.agents.live import _TOLD
from articad.agents.pictures import PART_VIEWS
from articad.agents.prompts import prompt, prompt_file
from articad.agents.replies import parse_object, parse_script
from articad.agents.requirements import Motion, Requirements
from articad.agents.review import Opinion
from articad.agents.rollback import Decisions
from articad.kinematics.joints import JointType
from articad.plan.check import check_plan
from articad.plan.expressions import FUNCTIONS
from articad.plan.fields import PlanObject
from articad.plan.joint_forms import COUPLING_TYPES, JOINT_TYPES
from articad.plan.schema import AssemblyPlan, ConnectorKind, ConnectorSpec, PartSpec
from articad.render import VIEWS
from tests.agents.stories import LOOKS_RIGHT, PROMPTS

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


def forms(root: type[PlanObject]) -> set[type[PlanObject]]:
    """All forms that a plan can hold."""
    found: set[type[PlanObject]] = set()

    def visit(annotation: object) -> None:
        if isinstance(annotation, type) and issubclass(annotation, PlanObject) and annotation not in found:
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
    not_for_models = {"kernel", "environment", "nominal_mm", "fastening", "effort_n_mm", "velocity_deg_s", "effort_n", "velocity_mm_s"}

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


def test_the_analysis_has_a_word_for_every_type_of_joint_that_moves() -> None:
    kinds = {
        "turns": JointType.REVOLUTE,
        "slides": JointType.SLIDER,
        "turns and slides": JointType.CYLINDRICAL,
        "swivels": JointType.BALL,
        "screws": JointType.SCREW,
        "slides in a plane": JointType.PLANAR,
        "tilts": JointType.UNIVERSAL,
    }
    assert set(get_args(Motion.model_fields["kind"].annotation)) == set(kinds)
    # what nothing holds to anything is no joint that an object has
    assert set(kinds.values()) == {kind for kind in JointType if kind.freedoms and kind is not JointType.FREE}
    told = prompt_file("requirements.md")
    assert [kind for kind in kinds if f'"{kind}"' not in told] == []


@pytest.mark.parametrize(
    ("name", "form"),
    [
        ("look", Look),
        ("observe", Observations),
        ("judge", Judgement),
        ("rollback", Decisions),
        ("brainstorm", Alternatives),
        ("edit", Change),
        ("review", Opinion),
        ("connect", Connections),
    ],
)
def test_the_answer_that_a_prompt_shows_has_the_form_that_is_read(name: str, form: type[BaseModel]) -> None:
    told = prompt_file(f"{name}.md")
    start = told.index("\n{") + 1
    shown, _ = json.JSONDecoder().raw_decode(told[start:])

    form.model_validate(shown)
    fields = {field for model in (form, *_inner(form)) for field in model.model_fields}
    assert {field for field in fields if f'"{field}"' not in told} == set()


def test_the_look_is_told_every_view_that_it_gets_and_every_side_is_seen_at_a_slant_in_one() -> None:
    told = prompt("look")
    assert [view for view in PART_VIEWS if f"{view}: " not in told] == []
    eyes = np.array([VIEWS[view][0] for view in PART_VIEWS])
    eyes /= np.linalg.norm(eyes, axis=1, keepdims=True)
    for side in (*np.eye(3), *-np.eye(3)):
        towards = eyes @ side
        assert ((towards > 0.3) & (towards < 0.95)).any(), side


def test_an_older_answer_of_a_look_still_has_its_form() -> None:
    answer = json.loads(LOOKS_RIGHT)
    assert all("not_visible" not in one for one in answer["findings"])
    assert [one.not_visible for one in Look.model_validate(answer).findings] == ["", "", ""]


def _inner(form: type[BaseModel]) -> set[type[BaseModel]]:
    """The forms that a form's fields hold."""
    arguments = {argument for field in form.model_fields.values() for argument in (field.annotation, *get_args(field.annotation))}
    return {argument for argument in arguments if isinstance(argument, type) and issubclass(argument, BaseModel)}


def test_every_prompt_that_wants_an_object_tells_its_form_and_is_left_alone_by_the_adapter() -> None:
    for name in (
        "requirements",
        "design",
        "look",
        "observe",
        "judge",
        "rollback",
        "brainstorm",
        "edit",
        "review",
        "design_late",
        "design_change",
        "connect",
    ):
        assert _TOLD in prompt_file(f"{name}.md"), name


def test_every_blank_of_a_prompt_is_filled_by_somebody() -> None:
    blanks = {blank for file in Path(str(PROMPTS)).glob("*.md") for blank in re.findall(r"\{\{(\w+)\}\}", file.read_text())}
    assert blanks == {"example", "findings", "failure", "problem", "note", "concept", "count", "kernel", "rules", "api", "shape"}


def test_the_prompts_have_no_blank_left_and_no_path_or_address() -> None:
    for text in (DESIGN, PART, prompt("requirements")):
        assert "{{" not in text
        assert not re.search(r"/(home|tmp|work|usr)/|https?://", text)


def test_the_worked_script_is_read_out_of_a_reply_like_any_other() -> None:
    assert parse_script(PART, step="x").decode().strip() == prompt_file("lid_left.txt")
