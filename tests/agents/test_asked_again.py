"""What recorded products are asked again: a slip in a plan is mended by a request that has every number and few other words.

The whole count is made by `python benchmarks/requests.py --again`, which also builds the products.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad.agents.design import Designer
from articad.agents.replies import reader
from articad.agents.requirements import Requirements
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run
from benchmarks.requests import AGAIN, ROOT, SLIPS, AsRecorded

SHARE = 0.75  # of the first request, which has no plan in it; the whole of both, as before, was about 1.7 of it


def text(request: Any) -> list[str]:
    return ["".join(part.get("text", "") for part in message["content"]) for message in request.to_json()["messages"]]


def requirements(run: Run) -> Requirements:
    step = next(step for step in ("requirements", "concept") if run.reply(step) is not None)
    said = (run.reply(step) or {})["reply"]["text"]
    return reader(Requirements, ignore=frozenset({"schema"}))(said, step)


@pytest.mark.parametrize("name", [name for name in AGAIN if Path(name).name in SLIPS])
def test_a_slip_in_a_recorded_plan_is_mended_by_a_request_that_is_shorter_than_the_first(name: str) -> None:
    run = Run.view(ROOT / name)
    model = AsRecorded(run, Path(name).name)

    plan = Designer(run.request, requirements(run), model).first()

    assert isinstance(plan, AssemblyPlan)
    first, again = map(text, model.requests)
    assert sum(map(len, again)) < SHARE * sum(map(len, first))
    shown = json.loads(again[2])
    slipped = json.loads(model.complete(model.requests[0]).text)
    assert [part["name"] for part in shown["parts"]] == [part["name"] for part in slipped["parts"]]
    for held, part in zip(shown["parts"], slipped["parts"], strict=True):
        assert {key: value for key, value in part.items() if key not in {"description", "orientation", "role"}}.items() <= held.items()
    assert {key: value for key, value in slipped.items() if key != "parts"}.items() <= shown.items()


@pytest.mark.parametrize("name", AGAIN)
def test_an_analysis_is_told_with_every_word_and_number_that_it_states(name: str) -> None:
    analysis = requirements(Run.view(ROOT / name))
    told = analysis.told()

    def stated(value: Any) -> list[str]:
        if isinstance(value, dict):
            return [text for key, entry in value.items() if key not in {"schema", "count", "unit"} for text in stated(entry)]
        if isinstance(value, list):
            return [text for entry in value for text in stated(entry)]
        return [] if isinstance(value, bool) else [f"{value:g}" if isinstance(value, int | float) else " ".join(value.split())]

    assert [text for text in stated(analysis.to_json()) if text not in told] == []
    assert all(f"({one.count} of them)" in told for one in analysis.components if one.count > 1)
