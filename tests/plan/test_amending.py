"""A plan is corrected at the addresses that findings name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad import examples
from articad.errors import ReadError
from articad.mcp.workbench import Workbench
from articad.plan.amending import amended
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan


@pytest.fixture
def plan() -> dict[str, Any]:
    document: dict[str, Any] = json.loads((examples.folder("wardrobe") / "plan.json").read_text())
    return document


def test_the_address_of_a_finding_is_where_its_remedy_goes(plan: dict[str, Any]) -> None:
    sound = amended(plan, {})
    wrong = amended(plan, {"joints.hinge_left.angle_deg": [5, 1], "freedoms": 1})
    (where,) = [finding.where for finding in check_plan(AssemblyPlan.loads(json.dumps(wrong))) if finding.code == "E_LIMITS_ORDER"]

    mended = amended(wrong, {where: plan["joints"][0]["angle_deg"], "freedoms": plan["freedoms"]})

    assert mended == sound == plan


def test_entries_are_added_replaced_and_removed_by_name_or_number(plan: dict[str, Any]) -> None:
    more = amended(plan, {"materials.lead": {"density_kg_m3": 11340}, "parts.cabinet.connectors.0.o.2": 7})

    assert more["materials"][-1] == {"name": "lead", "density_kg_m3": 11340}
    assert more["parts"][0]["connectors"][0]["o"][2] == 7
    assert amended(more, {"materials.lead": None})["materials"] == plan["materials"]


def test_addresses_are_taken_as_findings_write_them_and_optional_objects_are_begun(plan: dict[str, Any]) -> None:
    more = amended(
        plan, {"parts.cabinet.connectors.0.o[2]": 7, "parts.cabinet.rest_pose.at": [1, 2, 3], "materials.lacquer": {"density_kg_m3": 1}}
    )

    assert more["parts"][0]["connectors"][0]["o"][2] == 7
    assert next(part for part in more["parts"] if part["name"] == "cabinet")["rest_pose"] == {"at": [1, 2, 3]}
    assert {"name": "lacquer", "density_kg_m3": 1} in more["materials"]


def test_a_number_for_a_parameter_becomes_its_value(plan: dict[str, Any]) -> None:
    parameter = plan["parameters"][0]

    more = amended(plan, {f"parameters.{parameter['name']}": 123.0})

    assert more["parameters"][0] == parameter | {"value": 123.0}


def test_a_number_in_place_of_an_object_is_refused_with_the_fields_that_can_be_changed(plan: dict[str, Any]) -> None:
    with pytest.raises(ReadError, match=r"joints\.hinge_left\.angle_deg"):
        amended(plan, {"joints.hinge_left": 90})


@pytest.mark.parametrize(
    ("address", "words"),
    [("joints.hinge_lefd.angle_deg", "hinge_left"), ("partz.cabinet.name", "parts"), ("name.x", "nothing"), ("joints.99.name", "nothing")],
)
def test_an_address_that_leads_nowhere_is_told_and_changes_nothing(plan: dict[str, Any], tmp_path: Path, address: str, words: str) -> None:
    bench = Workbench(tmp_path)
    before = bench.write_plan("mine", plan).read_bytes()

    with pytest.raises(ReadError, match=words):
        bench.amend_plan("mine", {"freedoms": 99, address: 1})

    assert (tmp_path / "mine" / "plan.json").read_bytes() == before
