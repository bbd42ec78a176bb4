"""Hints about calls of models, recordings and budgets, followed literally: what a hint says is done, and its finding is gone."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from articad.agents.live import LiteLLM
from articad.agents.llm import Budget, Recorded, Replay, Reply, Scripted, Usage
from articad.errors import ArticadError
from articad.findings import Finding, Findings
from articad.runs.run import Run
from tests.agents.openai_stub import Canned, openai_stub
from tests.agents.test_drift import OtherKernel, again, moved, recorded
from tests.agents.test_live import question
from tests.agents.test_llm import request, run_at
from tests.crash.stand_in import FixedKernel

__all__ = ["recorded"]

CODES = {"E_REPLAY_MISS", "I_PROMPT_DRIFT", "E_REPLAY_DIFFERS", "E_BUDGET", "E_KEY_MISSING", "E_TRANSPORT"}
OTHER = request("design/1", "other words")


def said(call: Callable[[], object]) -> Findings:
    """Return the findings of an error, none if there is none."""
    try:
        call()
    except ArticadError as error:
        return error.findings
    return Findings()


def of(found: Findings, code: str, words: str) -> Finding:
    return next(finding for finding in found.of(code) if re.search(words, finding.hint))


def record(folder: Path, asked: object = None) -> Path:
    with run_at(folder) as run:
        Recorded(Scripted({"*": "yes"}), run).complete(asked or request())  # type: ignore[arg-type]
    return folder


def test_a_step_of_those_that_the_hint_lists_has_a_reply(tmp_path: Path) -> None:
    replay = Replay(record(tmp_path / "run"))
    finding = of(said(lambda: replay.complete(request("design/2"))), "E_REPLAY_MISS", "It has: design/1")
    listed = finding.hint.removeprefix("It has: ").rstrip(".").split(", ")
    assert not [step for step in listed if said(partial(replay.complete, request(step)))]


def test_another_prompt_that_is_recorded_again_is_answered_strictly(tmp_path: Path) -> None:
    strict = Replay(record(tmp_path / "run"), strict=True)
    of(said(lambda: strict.complete(OTHER)), "E_REPLAY_MISS", "Record again")
    assert not said(lambda: Replay(record(tmp_path / "again", OTHER), strict=True).complete(OTHER))


def test_a_prompt_that_drifted_is_recorded_again_or_refused(tmp_path: Path) -> None:
    replay = Replay(record(tmp_path / "run"))
    replay.complete(OTHER)
    of(replay.findings, "I_PROMPT_DRIFT", "record again, or replay strictly to refuse")
    new = Replay(record(tmp_path / "again", OTHER))
    new.complete(OTHER)
    assert not new.findings
    assert said(lambda: Replay(tmp_path / "run", strict=True).complete(OTHER)).of("E_REPLAY_MISS")


def test_the_versions_that_recorded_a_run_replay_it(recorded: Path) -> None:
    """Another kernel builds other geometry; that of the recording builds the same."""
    mesh = next(recorded.glob("parts/*/part.npz"))
    original = mesh.read_bytes()
    moved(recorded, 1e-5)
    of(again(recorded, OtherKernel()).findings, "E_REPLAY_DIFFERS", "Replay with the versions that recorded it")
    mesh.write_bytes(original)
    shutil.rmtree(recorded.parent / "again")
    assert not again(recorded, FixedKernel()).findings


@pytest.mark.parametrize(
    ("small", "large"), [({"calls": 1}, {"calls": 2}), ({"tokens": 1}, {"tokens": 99}), ({"cost": 0.1}, {"cost": 9.0})], ids=str
)
def test_a_raised_limit_lets_the_run_go_on(small: dict[str, float], large: dict[str, float]) -> None:
    llm = Scripted({"*": Reply("yes", "m", Usage(3, 4), cost=0.5)})

    def twice(limits: dict[str, float]) -> Findings:
        budget = Budget(llm, **limits)  # type: ignore[arg-type]
        return said(lambda: [budget.complete(request()), budget.complete(request("design/2"))])

    of(twice(small), "E_BUDGET", "Raise the limit and resume the run")
    assert not twice(large)


def test_a_price_that_nobody_knows_is_limited_by_calls_or_tokens_as_the_hint_says() -> None:
    """No limit of cost is large enough here."""
    llm = Scripted({"*": Reply("yes", "m", Usage(3, 4), cost=None)})

    def twice(**limits: float) -> Findings:
        budget = Budget(llm, **limits)  # type: ignore[arg-type]
        return said(lambda: [budget.complete(request()), budget.complete(request("design/2"))])

    of(twice(cost=1e9), "E_BUDGET", "Limit calls or tokens instead of the cost, and resume the run")
    assert not twice(calls=9)
    assert not twice(tokens=99)


def test_a_key_in_the_variable_of_the_hint_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    finding = of(said(lambda: LiteLLM("gpt-5.2")), "E_KEY_MISSING", r"Set \w+")
    told = re.search(r"Set (\w+)", finding.hint)
    assert told
    monkeypatch.setenv(told[1], "a-key")
    assert not said(lambda: LiteLLM("gpt-5.2"))


def test_an_address_that_is_corrected_answers() -> None:
    with openai_stub([Canned("because")]) as stub:
        wrong = re.sub(r":\d+", ":9", stub.address)
        llm = LiteLLM("stub", api_base=wrong, sleep=lambda _: None)
        of(said(lambda: llm.complete(question())), "E_TRANSPORT", "Check --api-base and the network")
        assert not said(lambda: LiteLLM("stub", api_base=stub.address).complete(question()))


def test_a_spoilt_reply_whose_file_is_deleted_is_asked_for_again(tmp_path: Path) -> None:
    with run_at(tmp_path / "run") as run:
        run.save_reply(request().step, {"reply": 3, "key": request().key})
        llm = Scripted({"*": "yes"})
        of(said(lambda: Recorded(llm, run).complete(request())), "E_READ", "Delete its file; the question is then asked again")
        next((Run.view(run.path).path / "llm").glob("*.json")).unlink()
        assert not said(lambda: Recorded(llm, run).complete(request()))
        assert len(llm.requests) == 1
