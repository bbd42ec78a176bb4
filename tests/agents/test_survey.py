"""Parts that no inspector saw alone are held against their orders, several in one request, before the assembly is made."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad.agents.edit import edit
from articad.agents.llm import Request, Scripted
from articad.agents.part_group import evenly
from articad.agents.survey import TOGETHER
from tests.agents import stories
from tests.agents.stories import fenced, surveyed
from tests.agents.test_part_group import DEFAULT, PEG, ROW, answer, made, model, said
from tests.agents.test_rounds import recipes

OTHER_WAY = PEG.replace("align=(Align.MIN,) * 3", "align=(Align.MIN, Align.MIN, Align.MAX)")
"""The same solid on the other side of a plane: one piece, and no check of the solid alone refuses it."""


def finds(part: str, fault: str = "script", wrong: str = "it lies below the plane z = 0, not above it") -> Any:
    """Return answers that agree with all parts but one."""

    def answered(request: Request) -> str:
        document = json.loads(surveyed(request))
        for one in document["parts"]:
            if one["part"] == part:
                one |= {"agrees": False, "fault": fault, "wrong": wrong, "remedy": "build it from z = 0 upwards"}
        return json.dumps(document)

    return answered


def test_all_parts_of_a_product_are_seen_with_their_orders_in_one_request(tmp_path: Path) -> None:
    llm = model(parts__plate__1=answer(**ROW))
    made(tmp_path / "run", llm)

    assert llm.steps == ["requirements", "design/1", "parts/plate/1", "survey/plate/1"]
    shown = llm.requests[-1]
    assert all(f"## {name}\n" in said(shown) for name in ROW)
    assert "Box x from 0 to length, y from 0 to side, z from 0 to thickness." in said(shown)
    assert "dimensions: length = 30, side = 10, thickness = 2" in said(shown)
    assert [recipe["of"] for recipe in recipes(llm, "survey/plate/1")] == ["part"] * len(ROW)


def test_a_script_that_departs_goes_back_to_its_author_and_the_others_stay(tmp_path: Path) -> None:
    llm = model(parts__plate__1=answer(**ROW | {"bob": OTHER_WAY}), survey__plate__1=finds("bob"), part__bob__2=fenced(PEG))
    run = made(tmp_path / "run", llm)

    assert llm.steps[3:] == ["survey/plate/1", "part/bob/2", "look/bob/2"]
    asked = said(llm.requests[-2])
    assert "it lies below the plane z = 0, not above it" in asked
    assert "build it from z = 0 upwards" in asked
    assert "an inspector who compared its pictures with the specification says" in asked
    assert recipes(llm, "part/bob/2")[-1]["of"] == "part"
    assert run.verdict() is None or (run.verdict() or {})["ok"]
    assert run.script("bob") == PEG.encode().lstrip()


def test_an_author_may_stand_by_a_script_and_the_opinion_stays_a_warning(tmp_path: Path) -> None:
    llm = model(parts__plate__1=answer(**ROW), survey__plate__1=finds("bob"), part__bob__2=fenced(PEG))
    run = made(tmp_path / "run", llm, inspection=True)

    assert [step for step in llm.steps if "bob" in step] == ["part/bob/2"]
    verdict = run.verdict() or {}
    assert verdict["ok"]
    assert [(finding["code"], finding["parts"]) for finding in verdict["findings"]] == [("W_LOOK_SHAPE", ["bob"])]


@pytest.mark.parametrize(
    "wrong", [fenced("def build(part):\n    return None"), '{"cannot_be_built": "it is as ordered"}'], ids=["scripts fail", "refused"]
)
def test_an_opinion_loses_no_part_whose_author_builds_no_better_one(wrong: str, tmp_path: Path) -> None:
    llm = model(parts__plate__1=answer(**ROW), survey__plate__1=finds("bob"), **{"part__bob__*": wrong})
    run = made(tmp_path / "run", llm, inspection=True)

    assert run.script("bob") == PEG.encode().lstrip()
    assert (run.checks() or {})["ok"]
    assert [finding["code"] for finding in (run.verdict() or {})["findings"]] == ["W_LOOK_SHAPE"]
    assert not [step for step in llm.steps if step == "design/2"]


def test_an_order_that_cannot_be_meant_goes_to_the_designer(tmp_path: Path) -> None:
    changes = {"changes": {"parts.bob.dimensions.thickness": 3}}
    llm = model(
        parts__plate__1=answer(**ROW),
        survey__plate__1=finds("bob", "specification", "a peg of 2 mm, ordered as a stout one"),
        design__2=json.dumps(changes),
        part__bob__2=fenced(PEG),
        part__bob__5=fenced(PEG),
    )
    made(tmp_path / "run", llm, inspection=True)

    assert "a peg of 2 mm, ordered as a stout one" in said(next(request for request in llm.requests if request.step == "design/2"))
    assert "survey/plate/1" in llm.steps
    assert not [step for step in llm.steps[llm.steps.index("design/2") :] if step.startswith("survey/") and "plate" in step]


@pytest.mark.parametrize("bad", ['{"parts": []}', '{"parts": [{"part": "bob"}]}', "no"])
def test_answers_without_the_form_are_noted_and_the_run_goes_on(bad: str, tmp_path: Path) -> None:
    llm = model(parts__plate__1=answer(**ROW), **{"survey__*": bad})
    run = made(tmp_path / "run", llm)

    assert (run.checks() or {})["ok"]
    assert "E_REPLY_SCHEMA" in (tmp_path / "run" / "trace.jsonl").read_text()


def test_nobody_surveys_without_looks_or_where_each_part_has_a_look_of_its_own(tmp_path: Path) -> None:
    for number, look in enumerate((False, True)):
        llm = model(parts__plate__1=answer(**ROW))
        made(tmp_path / f"run{number}", llm, look=look)
        assert not [step for step in llm.steps if step.startswith("survey/")]


def test_parts_that_an_edit_leaves_alone_are_not_surveyed_again(tmp_path: Path) -> None:
    run = made(tmp_path / "run", model(parts__plate__1=answer(**ROW)))
    changed = json.dumps({"summary": "a thicker peg", "touches": ["bob"], "changes": {"parts.bob.dimensions.thickness": 3}})
    answers: dict[str, Any] = {"edit/1": changed, "part/*": fenced(PEG)}
    llm = Scripted(answers | stories.watched())
    options = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **(DEFAULT | {"inspection": False}))
    edit(run.path, "make bob thicker", llm=llm, out=tmp_path / "edited", **options)

    assert not [step for step in llm.steps if step.startswith("survey/") and "plate" in step]


def test_groups_hold_every_part_once_and_no_more_than_a_model_looks_at_closely() -> None:
    for count in range(20):
        names = [f"n{number}" for number in range(count)]
        groups = evenly(names, TOGETHER)
        assert [name for group in groups for name in group] == names
        assert all(0 < len(group) <= TOGETHER for group in groups)
        assert len(groups) == -(-count // TOGETHER)
