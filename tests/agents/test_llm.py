"""The port's doubles: scripted, recorded, replayed, budgeted; and the key of a request."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from articad.agents.llm import Budget, Image, Recorded, Replay, Reply, Request, Scripted, Usage, assistant, system, user
from articad.errors import BudgetError, ReadError, ReplayMissError
from articad.runs.run import Run, RunRequest, canonical_json


def request(step: str = "design/1", *parts: str | Image) -> Request:
    return Request("design", step, (system("You design."), user(*(parts or ("a lamp",)))), {"type": "object"})


def run_at(path: Path) -> Run:
    return Run.create(RunRequest(prompt="x"), out=path)


def test_the_key_is_the_sha256_of_the_four_fields_of_the_contract() -> None:
    import hashlib

    form = {
        "role": "design",
        "step": "design/1",
        "messages": [
            {"role": "system", "content": [{"type": "text", "text": "You design."}]},
            {"role": "user", "content": [{"type": "text", "text": "a lamp"}]},
        ],
        "response_schema": {"type": "object"},
    }
    text = json.dumps(form, sort_keys=True, separators=(",", ":"), ensure_ascii=False)

    assert request().key == hashlib.sha256(text.encode()).hexdigest()


def test_every_field_changes_the_key() -> None:
    base = request()
    others = [
        replace(base, role="part"),
        replace(base, step="design/2"),
        replace(base, messages=(*base.messages, assistant("no"))),
        replace(base, response_schema=None),
    ]
    assert len({one.key for one in [base, *others]}) == 5


def test_a_drawn_picture_enters_the_key_by_its_recipe_and_a_given_one_by_its_bytes() -> None:
    drawn = [request("look/lid/1", Image(pixels, recipe={"view": "front"})) for pixels in (b"one gpu", b"another gpu")]
    given = [request("look/lid/1", Image(pixels)) for pixels in (b"one", b"two")]

    assert drawn[0].key == drawn[1].key != request("look/lid/1", Image(b"", recipe={"view": "top"})).key
    assert given[0].key != given[1].key
    assert b"gpu" not in canonical_json(drawn[0].to_json())


def test_a_script_answers_by_step_pattern_function_and_list() -> None:
    llm = Scripted({"a": "exact", "part/*/1": lambda asked: f"for {asked.step}", "part/*/2": ["first", "second"], "*": Reply("rest", "m")})

    assert llm.complete(request("a")).text == "exact"
    assert llm.complete(request("part/lid/1")).text == "for part/lid/1"
    assert [llm.complete(request("part/lid/2")).text for _ in range(3)] == ["first", "second", "second"]
    assert llm.complete(request("zzz")).model == "m"
    assert llm.steps == ["a", "part/lid/1", *["part/lid/2"] * 3, "zzz"]


def test_a_script_without_an_answer_names_the_nearest_step() -> None:
    with pytest.raises(ReplayMissError, match="nearest step is 'design/1'") as caught:
        Scripted({"design/1": "", "other": ""}).complete(request("design/2"))
    assert caught.value.nearest == "design/1"


def test_a_recorded_call_is_not_made_twice_and_another_question_is(tmp_path: Path) -> None:
    llm = Scripted({"*": ["one", "two"]})
    with run_at(tmp_path / "r") as run:
        assert [Recorded(llm, run).complete(request()).text for _ in range(3)] == ["one"] * 3
        assert Recorded(llm, run).complete(request("design/1", "another")).text == "two"
    assert len(llm.requests) == 2
    calls = [event for event in Run.view(tmp_path / "r").events() if event["event"] == "call"]
    assert [(call["step"], call["cost"]) for call in calls] == [("design/1", "unknown")] * 2


def test_a_record_holds_the_whole_request_the_reply_and_no_time(tmp_path: Path) -> None:
    answer = Reply("text", "m", Usage(3, 4), cost=0.5, fingerprint="f")
    with run_at(tmp_path / "r") as run:
        Recorded(Scripted({"*": answer}), run).complete(request("part/lid/1"))
    stored = json.loads((tmp_path / "r/llm/part.lid.1.json").read_text())

    assert set(stored) == {"schema", "key", "role", "step", "messages", "response_schema", "reply"}
    assert stored["key"] == request("part/lid/1").key
    assert Reply.from_json(stored["reply"]) == answer


def test_a_replay_answers_by_step_reports_drift_and_strictly_refuses_it(tmp_path: Path) -> None:
    with run_at(tmp_path / "r") as run:
        Recorded(Scripted({"*": "yes"}), run).complete(request())
    replay, strict = Replay(tmp_path / "r"), Replay(tmp_path / "r", strict=True)

    assert replay.complete(request()).text == strict.complete(request()).text == "yes"
    assert replay.findings.ok
    assert len(replay.findings) == 0
    assert replay.complete(request("design/1", "other words")).text == "yes"
    assert replay.findings.codes == ("I_PROMPT_DRIFT",)
    assert "message 2 differs" in replay.findings[0].message
    with pytest.raises(ReplayMissError, match="message 2 differs") as caught:
        strict.complete(request("design/1", "other words"))
    assert caught.value.findings.codes == ("E_REPLAY_MISS",)
    with pytest.raises(ReplayMissError, match="no reply to 'design/2'"):
        replay.complete(request("design/2"))


@pytest.mark.parametrize(
    ("limits", "reply", "passed", "words"),
    [
        ({"calls": 2}, Reply("", "m"), 2, "2 calls"),
        ({"tokens": 15}, Reply("", "m", Usage(4, 6)), 2, "15 tokens is spent: 20"),
        ({"cost": 0.5}, Reply("", "m", cost=0.3), 2, r"\$0.5 is spent: \$0.6"),
        ({"cost": 0.5}, Reply("", "m"), 1, "price of m is unknown"),
        ({"minutes": 1.0}, Reply("", "m"), 2, "1 minutes"),
    ],
)
def test_a_budget_refuses_before_the_call(limits: dict[str, float], reply: Reply, passed: int, words: str) -> None:
    now = iter(range(0, 1000, 20))
    inner = Scripted({"*": reply})
    budget = Budget(inner, clock=lambda: float(next(now)), **limits)  # type: ignore[arg-type]
    for _ in range(passed):
        budget.complete(request())
    with pytest.raises(BudgetError, match=words) as caught:
        budget.complete(request())

    assert len(inner.requests) == passed
    assert caught.value.findings.codes == ("E_BUDGET",)
    assert caught.value.spent


def test_without_limits_a_budget_only_counts() -> None:
    budget = Budget(Scripted({"*": Reply("", "m", Usage(1, 2), cost=0.25)}))
    for _ in range(4):
        budget.complete(request())
    assert (budget.calls, budget.tokens, budget.cost) == (4, 12, 1.0)


@pytest.mark.parametrize("usage", [Usage(-(10**9), 4), Usage(-6, 4)])
def test_an_endpoint_that_gives_tokens_back_is_not_believed(usage: Usage) -> None:
    budget = Budget(Scripted({"*": [Reply("", "m", Usage(3, 3)), Reply("", "m", usage)]}), tokens=10)
    budget.complete(request())
    budget.complete(request())

    with pytest.raises(BudgetError, match="10 tokens"):
        budget.complete(request())


@pytest.mark.parametrize(("cost", "more"), [(-1.0, 2), (float("nan"), 1), (float("inf"), 1)])
def test_no_price_that_is_told_lengthens_a_budget(cost: float, more: int) -> None:
    budget = Budget(Scripted({"*": [Reply("", "m", cost=0.5), Reply("", "m", cost=cost), Reply("", "m", cost=0.5)]}), cost=1.0)
    for _ in range(1 + more):
        budget.complete(request())
    with pytest.raises(BudgetError):
        budget.complete(request())


@pytest.mark.parametrize(
    "spoilt",
    [
        {},
        {"reply": 3},
        {"reply": {"text": "x"}},
        {"reply": {"text": 3, "model": "m", "usage": {"input_tokens": 1, "output_tokens": 1}, "cost": None, "fingerprint": None}},
        {"reply": {"text": "x", "model": "m", "usage": {"input_tokens": "1", "output_tokens": 1}, "cost": None, "fingerprint": None}},
        {"reply": {"text": "x", "model": "m", "usage": [], "cost": None, "fingerprint": None}},
    ],
)
@pytest.mark.parametrize("key", [request().key, "another", None])
def test_a_spoilt_recording_is_an_error_of_ours(tmp_path: Path, spoilt: dict[str, object], key: str | None) -> None:
    with Run.create(RunRequest(prompt="a box"), out=tmp_path / "run") as run:
        run.save_reply(request().step, spoilt | {"key": key})

    with pytest.raises(ReadError, match="recorded reply is incomplete"):
        Replay(tmp_path / "run").complete(request())
