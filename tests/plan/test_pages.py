"""The reference page of the plan: every JSON block on it is of the form it shows."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from articad.findings.codes import CODES
from articad.plan.check import check_plan
from articad.plan.joint_forms import COUPLING_TYPES, JOINT_TYPES, AnyJoint, CouplingSpec
from articad.plan.schema import Allow, AnyPart, AssemblyPlan, MaterialSpec, Parameter

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "plan.md").read_text()
BLOCKS = [json.loads(text) for text in re.findall(r"^```json\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)]
FORMS: list[Any] = [Parameter, MaterialSpec, AnyPart, AnyJoint, CouplingSpec, Allow]


def fits(form: Any, block: object) -> bool:
    try:
        TypeAdapter(form).validate_python(block)
    except ValidationError:
        return False
    return True


@pytest.mark.parametrize("block", [block for block in BLOCKS if "schema" not in block], ids=lambda block: block.get("name", "allow"))
def test_every_fragment_is_of_one_form(block: object) -> None:
    assert sum(fits(form, block) for form in FORMS) == 1


@pytest.mark.parametrize("block", [block for block in BLOCKS if "schema" in block], ids=lambda block: block["name"])
def test_every_whole_plan_has_no_finding(block: object) -> None:
    assert not check_plan(AssemblyPlan.from_json(block))


def test_every_field_of_a_plan_and_every_type_is_named() -> None:
    named = set(re.findall(r"`\"?([a-z_0-9]+)\"?`", PAGE))
    fields = {field.alias or name for name, field in AssemblyPlan.model_fields.items()}
    assert fields - named == set()
    assert {*JOINT_TYPES, *COUPLING_TYPES} - named == set()


def test_every_code_that_the_page_names_exists() -> None:
    assert set(re.findall(r"\b[EWI]_[A-Z_]+\b", PAGE)) <= CODES.keys()
