"""A pin that hangs in its bore: no clearance is that wide, so whoever made it is asked, once, before models look at the assembly."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad.agents.evidence import Evidence, examine
from articad.agents.llm import Scripted
from articad.agents.part_builder import PartsError
from articad.agents.rollback import Router
from articad.assembly import Assembly
from articad.errors import ContractError
from articad.findings import Finding
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.realisation.verdicts import LOOSE_MM
from tests.agents import stories
from tests.agents.stories import fenced, watched
from tests.agents.test_orders import POST, WHEEL, made, wheel_on_a_pin

PINNED = POST.replace("PIN", 'd["pin"] - d["clearance"]')
TWICE = WHEEL.replace('d["bore"]', '2 * d["bore"]')
"""A diameter taken for a radius."""


def document(bore: float = 4.0) -> dict[str, Any]:
    """A wheel on a pin, with no fit declared."""
    plan, _ = wheel_on_a_pin(bore=bore)
    del plan["joints"][0]["fit"]
    return plan


def examined(plan: dict[str, Any], wheel: str) -> Evidence:
    scripts = {"post": PINNED, "wheel": wheel}
    return examine(Assembly.from_plan(AssemblyPlan.from_json(plan), scripts, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1))


LOST = {"value": 5.0, "limit": 0.0, "unit": "ways"}


@pytest.mark.parametrize(
    ("code", "measured", "is_due"),
    [
        ("W_JOINT_LEAVES", LOST, True),
        ("W_JOINT_LEAVES", {}, False),  # it only tilts
        ("W_HOLES_APART", {}, True),
        ("W_JOINT_SHORT", {"value": 0.2, "limit": 0.25}, False),
        ("W_JOINT_NOT_MADE", {}, False),
    ],
)
def test_a_joint_that_leaves_its_guide_and_holes_that_do_not_meet_are_asked_about_once(
    code: str, measured: dict[str, Any], is_due: bool
) -> None:
    plan = resolve(AssemblyPlan.from_json(document()))
    found = Finding(code=code, where="joints.turn", parts=("post", "wheel"), message="so", hint="do", route="design", **measured)
    router = Router(Scripted({}))

    assert bool(router.due([found])) == is_due
    assert list(router.decide(1, [found], plan, {}).design) == ([found] if is_due else [])
    assert not router.due([found])


def test_whatever_no_script_could_mend_reaches_the_designer() -> None:
    plan = resolve(AssemblyPlan.from_json(document()))
    where = "parts.wheel.dimensions.bore"
    found = Finding(code="W_RADIUS_MISTAKEN", where=where, parts=("wheel",), message="so", hint="do", route="code")
    failed = PartsError({"wheel": ContractError("so", findings=(found,), parts=("wheel",))}, 2)

    told = Router(Scripted({})).decide(1, failed.for_design, plan, {}, every=True)
    assert [(finding.code, finding.parts) for finding in told.design] == [("W_RADIUS_MISTAKEN", ("wheel",))]


@pytest.mark.parametrize(("bore", "loose"), [(4.0, False), (4.7, False), (5.3, True), (8.0, True)])
def test_play_beyond_any_clearance_is_the_designers_who_ordered_it(bore: float, loose: bool) -> None:
    found = examined(document(bore=bore), WHEEL)

    assert [finding.route for finding in found.faults_of_joints] == (["design"] if loose else [])
    for finding in found.faults_of_joints:
        assert finding.value == pytest.approx(bore - 3.8, abs=0.05)
        assert finding.limit == LOOSE_MM


def test_an_author_who_took_a_diameter_for_a_radius_mends_it_and_the_assembly_is_looked_at_once(tmp_path: Path) -> None:
    answers: dict[str, Any] = {"requirements": stories.requirements("wheel"), "design/1": json.dumps(document())}
    answers |= {"part/post/1": fenced(PINNED), "part/wheel/1": fenced(TWICE), "part/wheel/2": fenced(WHEEL)}
    llm = Scripted(answers | watched("turn"))
    run = made(tmp_path, llm)

    asked_of = [step for step in llm.steps if not step.startswith("look/")]
    assert asked_of[:2] == ["requirements", "design/1"]
    assert sorted(asked_of[2:4]) == ["part/post/1", "part/wheel/1"], "both authors are asked side by side"
    assert asked_of[4:] == ["part/wheel/2", "observe/2", "judge/2/1"]
    asked = next(request for request in llm.requests if request.step == "part/wheel/2")
    assert "4.2 mm of play along +x" in json.dumps(asked.to_json())
    assert (run.verdict() or {})["ok"]


def test_play_that_stays_is_asked_about_no_more_and_stays_a_warning(tmp_path: Path) -> None:
    plan = document(bore=8.0)
    answers: dict[str, Any] = {"requirements": stories.requirements("wheel"), "design/1": json.dumps(plan), "design/2": '{"changes": {}}'}
    llm = Scripted(answers | {"part/post/1": fenced(PINNED), "part/wheel/1": fenced(WHEEL)} | watched("turn"))
    run = made(tmp_path, llm)

    assert [step for step in llm.steps if step.startswith("design/")] == ["design/1", "design/2"]
    verdict = run.verdict() or {}
    assert verdict["ok"]
    assert [finding["code"] for finding in verdict["findings"]] == ["W_JOINT_NOT_MADE"]
