"""A designer who repairs a plan: by changes to it, and asked once about numbers that look like another unit."""

from __future__ import annotations

import copy
import json
import re
from typing import Any

import pytest

from articad.agents.design import Designer
from articad.agents.excerpt import rules
from articad.agents.llm import Scripted
from articad.agents.requirements import Requirements
from articad.errors import OutputError
from articad.findings import Finding
from articad.plan.schema import AssemblyPlan
from articad.runs.run import RunRequest
from tests.agents import stories
from tests.agents.stories import FLAP_PLAN


def designer(*answers: Any) -> tuple[Designer, Scripted]:
    llm = Scripted({f"design/{at}": answer if isinstance(answer, str) else json.dumps(answer) for at, answer in enumerate(answers, 1)})
    return Designer(RunRequest(prompt="a flap"), Requirements.model_validate_json(stories.requirements()), llm), llm


def changed(**changes: Any) -> dict[str, Any]:
    """The flap's plan with other dimensions of the plate."""
    plan = copy.deepcopy(FLAP_PLAN)
    plan["parts"][0]["dimensions"] |= changes
    return plan


def words(llm: Scripted, at: int) -> list[str]:
    """The messages of a request, without the opening."""
    return [part["text"] for message in llm.requests[at].to_json()["messages"][2:] for part in message["content"]]


BROKEN = FLAP_PLAN | {"joints": [FLAP_PLAN["joints"][0] | {"angle_deg": [90, 0]}]}
MENDED = {"changes": {"joints.hinge.angle_deg": [0, 90]}}


def test_a_repair_is_answered_with_changes_alone() -> None:
    planner, llm = designer(BROKEN, MENDED)

    assert planner.first() == AssemblyPlan.from_json(FLAP_PLAN)
    shown, asked = words(llm, 1)
    assert json.loads(shown) == BROKEN
    assert "E_LIMITS_ORDER" in asked
    assert '{"changes": {' in asked


def test_changes_apply_to_the_last_plan_with_its_earlier_changes() -> None:
    worse = {"changes": {"joints.hinge.child": "flap.hole", "parts.plate.dimensions.length": 44}}
    planner, llm = designer(BROKEN, worse, {"changes": {"joints.hinge.child": "flap.axis", "joints.hinge.angle_deg": [0, 90]}})

    assert planner.first() == AssemblyPlan.from_json(changed(length=44))
    assert json.loads(words(llm, 2)[0])["joints"][0]["child"] == "flap.hole"


def test_a_whole_plan_is_still_an_answer() -> None:
    planner, _ = designer(BROKEN, FLAP_PLAN)

    assert planner.first() == AssemblyPlan.from_json(FLAP_PLAN)


def test_changes_that_the_plan_has_no_place_for_are_refused_by_name() -> None:
    planner, llm = designer(BROKEN, {"changes": {"joints.hings.angle_deg": [0, 90]}}, MENDED)

    assert planner.first() == AssemblyPlan.from_json(FLAP_PLAN)
    shown, asked, said, refused = words(llm, 2)
    assert json.loads(shown) == BROKEN
    assert "E_LIMITS_ORDER" in asked
    assert "joints.hings" in said
    assert "The plan has nothing at joints.hings" in refused


def test_changes_are_no_answer_where_there_is_no_plan_yet() -> None:
    planner, _ = designer(*[MENDED] * 5)

    with pytest.raises(OutputError, match="there is no plan yet"):
        planner.first()


@pytest.mark.parametrize("answer", [{"changes": {}}, changed(length=40000)])
def test_a_number_that_looks_like_another_unit_is_asked_about_once_and_then_believed(answer: dict[str, Any]) -> None:
    planner, llm = designer(changed(length=40000), answer)

    assert planner.first() == AssemblyPlan.from_json(changed(length=40000))
    assert "W_SCALE parts.plate.dimensions.length" in words(llm, 1)[1]


def test_a_number_in_another_unit_is_corrected() -> None:
    planner, llm = designer(changed(length=40000), {"changes": {"parts.plate.dimensions.length": 40}})

    assert planner.first() == AssemblyPlan.from_json(FLAP_PLAN)
    assert len(llm.requests) == 2


def test_another_doubtful_number_is_asked_about_as_well() -> None:
    planner, llm = designer(changed(length=40000), changed(length=40000, side=0.01), changed(length=40000, side=0.01))

    assert planner.first() == AssemblyPlan.from_json(changed(length=40000, side=0.01))
    assert "dimensions.side" in words(llm, 2)[1]
    assert "dimensions.length" not in words(llm, 2)[1]


def test_what_was_changed_after_the_design_is_what_changes_apply_to() -> None:
    planner, llm = designer(FLAP_PLAN, {"changes": {"parts.plate.dimensions.length": 44}})
    planner.first()
    tuned = AssemblyPlan.from_json(changed(side=10.5))
    finding = Finding(code="E_STATIC_OVERLAP", where="joints.hinge", message="They overlap.", hint="Move one.")

    assert planner.again(tuned, [finding]) == AssemblyPlan.from_json(changed(side=10.5, length=44))
    assert json.loads(words(llm, 1)[0])["parts"][0]["dimensions"]["side"] == 10.5


# ---------------------------------------------------------------- what a request for changes holds


def lots() -> dict[str, Any]:
    """The flap's plan with two more flaps on the plate, of which no finding says anything."""
    plan = copy.deepcopy(FLAP_PLAN)
    for name in ("bob", "cat"):
        plan["parts"].append(
            copy.deepcopy(plan["parts"][1]) | {"name": name, "description": f"Order of {name}.", "orientation": f"As {name}."}
        )
        plan["parts"][0]["connectors"].append(copy.deepcopy(plan["parts"][0]["connectors"][0]) | {"name": name})
        plan["joints"].append(
            copy.deepcopy(plan["joints"][0]) | {"name": f"hinge_{name}", "parent": f"plate.{name}", "child": f"{name}.axis"}
        )
    return plan | {"freedoms": 3}


def numbers(plan: dict[str, Any]) -> dict[str, Any]:
    """A plan without what its parts are told in words."""
    return plan | {
        "parts": [
            {key: value for key, value in part.items() if key not in {"description", "orientation", "role"}} for part in plan["parts"]
        ]
    }


def broken(**changes: Any) -> dict[str, Any]:
    plan = lots()
    plan["joints"][1] |= changes
    return plan


def test_a_request_for_changes_has_every_number_and_the_orders_of_the_parts_that_findings_are_about() -> None:
    faulty = broken(angle_deg=[90, 0])
    planner, llm = designer(faulty, {"changes": {"joints.hinge_bob.angle_deg": [0, 90]}})

    assert planner.first() == AssemblyPlan.from_json(lots())
    plan, asked = words(llm, 1)
    shown = json.loads(plan)
    assert numbers(shown) == numbers(faulty)
    assert {part["name"] for part in shown["parts"] if "description" in part} == {"plate", "bob"}
    assert "description, orientation, role of flap, cat are left out" in asked
    assert "Order of cat." not in json.dumps(llm.requests[1].to_json())


def test_a_part_whose_order_was_not_shown_keeps_it_where_it_is_replaced_whole() -> None:
    cat = {key: value for key, value in lots()["parts"][3].items() if key not in {"name", "description", "orientation", "role"}}
    planner, _ = designer(broken(angle_deg=[90, 0]), {"changes": {"joints.hinge_bob.angle_deg": [0, 90], "parts.cat": cat}})

    assert planner.first() == AssemblyPlan.from_json(lots())


def test_a_fault_that_comes_back_is_asked_about_with_the_whole_plan_and_every_rule() -> None:
    faulty = broken(angle_deg=[90, 0])
    planner, llm = designer(faulty, {"changes": {}}, {"changes": {"joints.hinge_bob.angle_deg": [0, 90]}})

    planner.first()
    assert llm.requests[2].messages[:2] == llm.requests[0].messages[:2]
    assert json.loads(words(llm, 2)[0]) == faulty


def test_what_was_found_of_built_parts_is_asked_with_all_rules_and_the_orders_of_what_they_are_joined_to() -> None:
    planner, llm = designer(lots(), {"changes": {"parts.bob.dimensions.length": 44}})
    planner.first()
    finding = Finding(code="E_STATIC_OVERLAP", where="joints.hinge_bob", message="They overlap.", hint="Move one.", parts=("bob", "flap"))

    planner.again(AssemblyPlan.from_json(lots()), [finding])
    system, opening = (message.to_json()["content"][0]["text"] for message in llm.requests[1].messages[:2])
    assert [title for title in ("# 1.", "# 2.", "# 3.", "# 4.", "# 5.", "# 6.") if f"\n{title}" not in system] == []
    assert "a flap" in opening
    assert {part["name"] for part in json.loads(words(llm, 1)[0])["parts"] if "description" in part} == {"plate", "flap", "bob"}


def test_a_judgement_of_the_assembly_is_asked_with_the_whole_analysis_and_the_whole_plan() -> None:
    planner, llm = designer(lots(), {"changes": {}})
    planner.first()
    finding = Finding(code="E_VERDICT_PLACEMENT", where="parts.bob", message="It is thin.", hint="Make it thicker.", parts=("bob",))

    planner.again(AssemblyPlan.from_json(lots()), [finding])
    assert llm.requests[1].messages[1] == llm.requests[0].messages[1]
    assert json.loads(words(llm, 1)[0]) == lots()


@pytest.mark.parametrize(
    ("where", "told"),
    [
        ("parameters.width.value", ["# 1.", "# 2."]),
        ("parts.plate.dimensions.length", ["# 1.", "# 2.", "# 3."]),
        ("parts.plate.connectors.hinge.o[0]", ["# 1.", "# 2.", "# 3.", "# 4.", "# 5."]),
        ("joints.hinge.angle_deg", ["# 1.", "# 2.", "# 4.", "# 5."]),
        ("freedoms", ["# 1.", "# 2.", "# 4.", "# 5."]),
    ],
)
def test_rules_that_bear_on_no_finding_are_left_out_and_the_forms_of_what_findings_name_are_told(where: str, told: list[str]) -> None:
    text = rules([Finding(code="E_SCHEMA", where=where, message="It is wrong.", hint="Write it otherwise.")])
    written = rules([Finding(code="E_EXPRESSION", where=where, message="It cannot be read.", hint="Write a number.")])

    assert re.findall(r"^# \d\.", text, re.MULTILINE) == told
    assert re.findall(r"^# \d\.", written, re.MULTILINE) == ["# 1.", "# 2."]
    assert ("\njoint:" in text) == ("# 4." in told and not where.startswith("parts"))
    assert all(f"\n{form}:" in text for form in ("plan", "parameter", "material", "part", "rest_pose", "connector"))


@pytest.mark.parametrize(
    ("words", "told"), [("a flap", False), ("a small gearbox", False), ("a rack with a pinion", True), ("two gears", True)]
)
def test_who_designs_teeth_is_told_how_they_mesh(words: str, told: bool) -> None:
    llm = Scripted({"design/1": json.dumps(FLAP_PLAN)})
    Designer(RunRequest(prompt=words), Requirements.model_validate_json(stories.requirements()), llm).first()

    assert ("A recipe for teeth" in str(llm.requests[0].to_json())) == told
