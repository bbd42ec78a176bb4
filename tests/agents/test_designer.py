"""A designer who repairs a plan: by changes to it, and asked once about numbers that look like another unit."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest

from articad.agents.design import Designer
from articad.agents.llm import Scripted
from articad.agents.requirements import Requirements
from articad.errors import PlanError
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
    assert "The plan has nothing at joints.hings" in words(llm, 2)[1]


def test_changes_are_no_answer_where_there_is_no_plan_yet() -> None:
    planner, _ = designer(*[MENDED] * 5)

    with pytest.raises(PlanError):
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
