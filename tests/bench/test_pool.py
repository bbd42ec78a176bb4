"""Workers that die at the worst moment."""

from __future__ import annotations

import sys

import pytest

from articad.batches.pool import Call, Worker
from articad.processes import launcher

CALL = Call("score", {}, "k")


@pytest.mark.parametrize("said", ["", "{", '{"ok": true'])
def test_a_worker_that_dies_within_its_answer_has_not_answered(said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def dying(worker: Worker, _call: Call) -> launcher.Child:
        words = [sys.executable, "-c", f"import sys; sys.stdin.readline(); sys.stdout.write({said!r})"]
        worker._process = launcher.start(words, stdin=launcher.PIPE)  # kept as the real one is, so that it is waited for
        return worker._process

    monkeypatch.setattr(Worker, "_running", dying)
    with Worker(1.0) as worker:
        answer = worker.tried(CALL, 1)

    assert answer == {"ok": False, "digest": "k", "made": "never", "error": "Its worker died 2 times."}
