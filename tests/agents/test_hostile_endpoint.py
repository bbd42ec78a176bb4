"""An endpoint that misbehaves: memory is bounded, the deadline holds, every call is counted, and the prompt goes nowhere else."""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

from articad.agents.calls import Calls
from articad.agents.live import LiteLLM, LiteLLMEmbedder
from articad.agents.llm import Budget, Request, user
from articad.agents.replies import parse_object
from articad.errors import BudgetError, OutputError, TransportError
from articad.runs.run import canonical_json
from tests.agents import hostile_endpoint as ways
from tests.agents.hostile_endpoint import Misbehaviour, completion, hostile, redirects_to, says

DEADLINE_S = 2.0  # of the budget; an answer that is refused comes before it
LATE_S = 2.0  # by which a deadline may be missed
MORE_MEMORY = 300 * 2**20  # bytes over what the same process holds before the call
pytestmark = pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is measured by Linux's /proc")

NESTED = b"[" * 100_000 + b"]" * 100_000
MISBEHAVIOURS: dict[str, Misbehaviour] = {
    "hang": ways.hang,
    "hang after the head": ways.hang_after_the_head,
    "drip": ways.drip,
    "drip the head": ways.drip_the_head,
    "endless head": ways.endless_head,
    "endless 100 Continue": ways.endless_continue,
    "endless body": ways.endless_body,
    "1 GiB": ways.a_gibibyte,
    "endless chunks": ways.endless_chunks,
    "gzip bomb": ways.gzip_bomb,
    "gzip in gzip": ways.gzip_in_gzip,
    "foreign compression": ways.foreign_compression,
    "spoiled gzip": ways.spoiled_gzip,
    "many small objects": ways.many_small_objects,
    "half closed": ways.half_closed,
    "reset": ways.reset,
    "no HTTP": ways.no_http,
    "429 with a long Retry-After": ways.patient,
    "503 for ever": ways.busy_for_ever,
    "nested body": says(NESTED),
    "nested error": says(b'{"error": ' + NESTED + b"}", "400 Bad Request"),
    "a gibibyte of error": lambda line: line.sendall(b"HTTP/1.1 500 X\r\ncontent-length: 1073741824\r\n\r\n" + bytes(2**24)),
    "content is a number": says(completion(5)),
    "content is a list": says(completion([1, {"type": "text"}])),
    "choices are a text": says(b'{"choices": "none"}'),
    "usage is a text": says(completion("x")[:-1] + b', "usage": "much"}'),
    "numbers beyond numbers": says(b'{"created": 1e999, "choices": [], "usage": {"prompt_tokens": ' + b"9" * 5000 + b"}}"),
    "no UTF-8": says(b'{"choices": "\xff\xfe"}'),
    "empty": says(b""),
    "204": says(b"", "204 No Content"),
}
PATIENT = ("hang", "hang after the head", "drip", "drip the head", "429 with a long Retry-After", "503 for ever", "reset", "half closed")
"""Misbehaviours against which the pauses between tries count too; after the others there is no pause here."""
QUESTION = Request("design", "design/1", (user("why?"),))


def group_peaks(leader: int) -> dict[int, int]:
    """Return the largest resident memory of each process of a group [bytes]."""
    peaks = {}
    for folder in Path("/proc").iterdir():
        with suppress(OSError, ValueError, StopIteration):
            if folder.name.isdigit() and os.getpgid(int(folder.name)) == leader:
                rows = (folder / "status").read_text().splitlines()
                peaks[int(folder.name)] = 1024 * int(next(row for row in rows if row.startswith("VmHWM")).split()[1])
    return peaks


@contextmanager
def watched() -> Iterator[list[int]]:
    """Collect the largest memory of all processes that call models, and of this one, minus what each holds now."""
    leader = Calls.shared().pid
    assert leader is not None
    normal, own = group_peaks(leader)[leader], group_peaks(os.getpgid(0)).get(os.getpid(), 0)
    found, stop = [0], threading.Event()

    def look() -> None:
        while not stop.wait(0.02):
            calls = [peak - normal for pid, peak in group_peaks(leader).items() if pid != leader]
            found[0] = max(found[0], group_peaks(os.getpgid(0)).get(os.getpid(), 0) - own, *calls, 0)

    thread = threading.Thread(target=look)
    thread.start()
    try:
        yield found
    finally:
        stop.set()
        thread.join()


@pytest.fixture(scope="module", autouse=True)
def started() -> None:
    ways.bomb()
    with hostile(says(completion("fine"))) as endpoint:
        assert LiteLLM("x", api_base=endpoint.address).complete(QUESTION).text == "fine"


@pytest.mark.parametrize("name", MISBEHAVIOURS)
def test_memory_deadline_and_count_hold_against(name: str) -> None:
    with hostile(MISBEHAVIOURS[name]) as endpoint, watched() as more:
        pause = time.sleep if name in PATIENT else lambda _: None
        budget = Budget(LiteLLM("x", api_base=endpoint.address, sleep=pause), calls=2, minutes=DEADLINE_S / 60)
        began = time.monotonic()
        with pytest.raises((TransportError, BudgetError)):
            budget.complete(QUESTION)
        assert time.monotonic() - began <= DEADLINE_S + LATE_S
        assert endpoint.requests <= budget.calls
        assert budget.calls <= 2
    assert more[0] <= MORE_MEMORY


@pytest.mark.parametrize("name", ["hang", "drip", "429 with a long Retry-After"])
def test_minutes_that_are_spent_are_told_as_such(name: str) -> None:
    with hostile(MISBEHAVIOURS[name]) as endpoint:
        budget = Budget(LiteLLM("x", api_base=endpoint.address), minutes=1 / 60)
        with pytest.raises(BudgetError, match=r"The budget of 0\.0166667 minutes"):
            budget.complete(QUESTION)


def test_each_try_is_a_call_of_the_budget() -> None:
    with hostile(ways.busy_for_ever) as endpoint:
        budget = Budget(LiteLLM("x", api_base=endpoint.address, sleep=lambda _: None), calls=3)
        with pytest.raises(BudgetError, match="3 calls"):
            budget.complete(QUESTION)
        assert endpoint.requests == budget.calls == 3


@pytest.mark.parametrize(
    ("name", "limits", "why"),
    [
        ("hang", {"minutes": 1 / 60}, r"openai/x did not answer within (0\.\d|1\.0) s, after 1 attempt"),
        ("429 with a long Retry-After", {"minutes": 0.5}, "openai/x failed with status 429, after 1 attempt"),
        ("429 with a long Retry-After", {"calls": 2}, "openai/x failed with status 429, after 2 attempts"),
    ],
)
def test_a_spent_budget_says_why_the_last_attempt_failed(name: str, limits: dict[str, Any], why: str) -> None:
    with hostile(MISBEHAVIOURS[name]) as endpoint:
        budget = Budget(LiteLLM("x", api_base=endpoint.address, sleep=lambda _: None), **limits)
        with pytest.raises(BudgetError, match=why) as caught:
            budget.complete(QUESTION)
        (finding,) = caught.value.findings
        assert re.search(why, finding.message)
        assert finding.code == "E_BUDGET"


@pytest.mark.parametrize(("seconds", "told"), [(0.84, "0.8"), (59.6, "60"), (600.0, "600"), (1800.0, "1800")])
def test_a_time_is_told_in_plain_digits(seconds: float, told: str) -> None:
    failed = LiteLLM("x", api_base="http://127.0.0.1:1")._failure({"kind": "late", "status": None, "text": ""}, "m", 1, seconds)
    assert f"did not answer within {told} s" in str(failed)


@pytest.mark.parametrize("status", ["301 Moved", "302 Found", "303 See Other", "307 Temporary Redirect", "308 Permanent Redirect"])
def test_no_redirect_takes_the_prompt_to_another_address(status: str) -> None:
    with hostile(says(completion("mine"))) as other, hostile(redirects_to(other.address + "/chat/completions", status)) as endpoint:
        llm = LiteLLM("x", api_base=endpoint.address)
        with pytest.raises(TransportError, match="another address, which is not followed, after 1 attempt"):
            llm.complete(QUESTION)
        assert (endpoint.requests, other.requests) == (1, 0)


def test_a_compressed_answer_is_read() -> None:
    import gzip
    import zlib

    raw = zlib.compressobj(9, zlib.DEFLATED, -15)
    for encoding, body in (
        ("gzip", gzip.compress(completion("packed"))),
        ("deflate", zlib.compress(completion("packed"))),
        ("deflate", raw.compress(completion("packed")) + raw.flush()),
    ):
        with hostile(says(body, "200 OK", f"content-encoding: {encoding}")) as endpoint:
            assert LiteLLM("x", api_base=endpoint.address).complete(QUESTION).text == "packed"


def test_a_call_that_was_killed_takes_no_other_with_it() -> None:
    with hostile(ways.hang) as silent, hostile(says(completion("fine"))) as honest:
        lost: list[Exception] = []

        def ask_in_vain() -> None:
            try:
                LiteLLM("x", api_base=silent.address, timeout=1.0, tries=1).complete(QUESTION)
            except TransportError as error:
                lost.append(error)

        thread = threading.Thread(target=ask_in_vain)
        thread.start()
        assert LiteLLM("x", api_base=honest.address).complete(QUESTION).text == "fine"
        thread.join()
        assert len(lost) == 1
        assert LiteLLM("x", api_base=honest.address).complete(QUESTION).text == "fine"


def test_after_the_death_of_the_process_that_calls_another_one_is_started() -> None:
    with hostile(says(completion("fine"))) as endpoint:
        llm = LiteLLM("x", api_base=endpoint.address)
        first = Calls.shared().pid
        assert first is not None
        os.kill(first, 9)
        assert llm.complete(QUESTION).text == "fine"
        assert Calls.shared().pid != first


@pytest.mark.parametrize("text", ["[" * 100_000, "[" * 500 + "]" * 500, '{"a":' * 100_000, '{"a": ' + "[" * 200 + "]" * 200 + "}"])
def test_a_reply_of_many_brackets_is_refused(text: str) -> None:
    with pytest.raises(OutputError, match=r"nested deeper than 100 levels|not one JSON object"):
        parse_object(text, step="design/1")


def test_half_of_a_surrogate_pair_is_replaced_so_that_the_reply_can_be_recorded() -> None:
    with hostile(says(completion("a\ud83db \N{GRINNING FACE}")[:-1] + b', "system_fingerprint": "\\ud800"}')) as endpoint:
        reply = LiteLLM("x", api_base=endpoint.address).complete(QUESTION)
    assert (reply.text, reply.fingerprint) == ("a?b \N{GRINNING FACE}", "?")
    assert canonical_json(reply.to_json())


def test_tokens_of_more_digits_than_can_be_printed_end_a_budget_in_words() -> None:
    usage = b', "usage": {"prompt_tokens": ' + b"9" * 4300 + b', "completion_tokens": ' + b"9" * 4300 + b', "total_tokens": 1}}'
    with hostile(says(completion("x")[:-1] + usage)) as endpoint:
        budget = Budget(LiteLLM("x", api_base=endpoint.address), tokens=10)
        budget.complete(QUESTION)
        with pytest.raises(BudgetError, match="tokens is spent"):
            budget.complete(QUESTION)


VECTORS = {
    "of two sizes": ["[1, 2]", "[1]"],
    "of no numbers": ["[]", "[]"],
    "of texts": ['"one"', '"two"'],
    "of lists": ["[[1]]", "[[2]]"],
    "not finite": ["[NaN, 1]", "[1, 1]"],
    "of two million numbers": ["[" + "1," * 2_000_000 + "1]"] * 2,
}


@pytest.mark.parametrize("name", VECTORS)
def test_vectors_that_are_none_are_refused(name: str) -> None:
    rows = ",".join(f'{{"object": "embedding", "index": {place}, "embedding": {row}}}' for place, row in enumerate(VECTORS[name]))
    body = f'{{"object": "list", "model": "m", "data": [{rows}], "usage": {{"prompt_tokens": 1, "total_tokens": 1}}}}'
    with hostile(says(body.encode())) as endpoint, watched() as more, pytest.raises(TransportError):
        LiteLLMEmbedder("x", api_base=endpoint.address).embed(["a", "b"])
    assert more[0] <= MORE_MEMORY
