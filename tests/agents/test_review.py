"""A review scores what was made, by rules and by a model that looks; it decides nothing, and is asked only where it was asked for."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from articad.agents.llm import Image, Scripted
from articad.agents.pipeline import generate, replay
from articad.agents.recollection import StoredMemory, remember
from articad.agents.settings import Services
from articad.memory.experience import ExperienceStore
from articad.runs.run import Run
from tests.agents import stories

SCORES: dict[str, Any] = {
    aspect: {"score": score, "reason": f"{aspect} seen"} for aspect, score in (("geometry", 4), ("detail", 2), ("motion", 5))
}
LESSON = "A flap needs a knuckle round its pin."
OPINION = json.dumps(SCORES | {"lessons": [LESSON]})


def made(folder: Path, llm: Scripted, **options: Any) -> Run:
    quiet: dict[str, Any] = {"look": False, "inspection": False, "kernel": stories.kernel(), "cache": stories.shared_cache()}
    return generate(stories.FLAP_PROMPT, llm=llm, out=folder, **stories.settings(**(quiet | options)))


def test_nobody_reviews_who_was_not_asked_to(tmp_path: Path) -> None:
    llm = stories.flap()
    run = made(tmp_path / "run", llm)
    assert "review" not in run.request.options
    assert "review" not in llm.steps
    assert run.review() is None


def test_a_model_that_sees_everything_scores_it_and_the_rules_do(tmp_path: Path) -> None:
    llm = stories.flap(review=OPINION, part__flap__1="nothing", part__flap__2=stories.fenced(stories.FLAP_SCRIPTS["flap"]))
    run = made(tmp_path / "run", llm, review="model")
    report = run.review() or {}

    assert report["model"] == SCORES
    assert report["rules"]["geometric_fidelity"] == report["rules"]["kinematic_health"] == 1.0
    assert report["kind"] == "good"
    assert report["trajectory"] == {"designs": 1, "rounds": 1, "scripts": {"flap": 2, "plate": 1}}
    request = next(request for request in llm.requests if request.step == "review")
    recipes = [dict(part.recipe or {})["of"] for message in request.messages for part in message.parts if isinstance(part, Image)]
    assert recipes == ["assembly", "part", "part", "motion"]
    again = replay(run.path, out=tmp_path / "again", strict=True, services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))
    assert again.differences == ()


def test_a_reviewer_sees_first_what_the_customer_drew(tmp_path: Path) -> None:
    sketch = b"\x89PNG\r\n\x1a\n" + bytes(16)
    llm = stories.flap(review=OPINION)
    made(tmp_path / "run", llm, review="model", images=[sketch])
    request = next(request for request in llm.requests if request.step == "review")
    shown = [part for message in request.messages for part in message.parts if isinstance(part, Image)]
    assert shown[0].content == sketch
    assert [one.recipe is None for one in shown].count(True) == 1


def test_rules_alone_need_no_model(tmp_path: Path) -> None:
    llm = stories.flap()
    run = made(tmp_path / "run", llm, review="rules")
    assert "review" not in llm.steps
    assert (run.review() or {})["model"] is None


def test_a_reviewer_without_a_form_leaves_the_rules(tmp_path: Path) -> None:
    wrong = json.dumps(SCORES | {"lessons": [], "geometry": {"score": 6, "reason": "x"}})
    llm = stories.flap(review=wrong, review__2="no", review__3=wrong)
    run = made(tmp_path / "run", llm, review="model")
    assert (run.review() or {})["model"] is None
    assert "E_REPLY_SCHEMA" in [event.get("code") for event in run.events()]


def test_a_defect_that_was_measured_makes_an_issue_whatever_the_reviewer_thinks(tmp_path: Path) -> None:
    deep = json.loads(json.dumps(stories.FLAP_PLAN))
    deep["parameters"][0]["value"] = -1
    run = made(tmp_path / "run", stories.flap(review=OPINION, design__1=json.dumps(deep)), review="model", rounds=1)
    report = run.review() or {}
    assert report["kind"] == "issue"
    assert "E_STATIC_OVERLAP" in report["defects"][0]
    assert report["rules"]["geometric_fidelity"] == 0.0


def test_a_review_is_kept_with_the_case_and_its_lesson_is_told_to_the_next_designer_alone(tmp_path: Path) -> None:
    store = ExperienceStore(tmp_path / "memory")
    case = remember(made(tmp_path / "run", stories.flap(review=OPINION), review="model"), store)
    assert case is not None
    assert case.kind == "good"
    assert (case.scores["geometry"], case.scores["detail"], case.scores["first_shot"]) == (4.0, 2.0, 1.0)
    assert store.case(case.id).lessons == (LESSON,)

    llm = stories.flap()
    made(tmp_path / "next", llm, memory=StoredMemory(store))
    told = {request.step: json.dumps(request.to_json()) for request in llm.requests}
    assert [step for step, text in told.items() if LESSON in text] == ["design/1"]
