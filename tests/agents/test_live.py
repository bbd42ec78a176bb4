"""The live adapter against an OpenAI-compatible endpoint on this machine."""

from __future__ import annotations

import base64
import json
import os
import subprocess
import sys
import traceback
from collections.abc import Callable
from pathlib import Path

import pytest

from articad.agents.live import LiteLLM, LiteLLMEmbedder, without_secrets
from articad.agents.llm import Image, Recorded, Request, closed_port, system, user
from articad.errors import TransportError
from articad.memory.case import Case
from articad.memory.experience import ExperienceStore
from articad.runs.run import Run, RunRequest
from tests.agents.openai_stub import Canned, openai_stub

SECRET = "sk-test-0123456789abcdefSECRET"
MESSAGE = {"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": "Guilty."}}
SCHEMA = {"type": "object", "required": ["a"], "properties": {"a": {"type": "integer"}}}


def question(*, schema: bool = False, image: bool = False) -> Request:
    parts = ("why?", Image(b"\x89PNG-pixels")) if image else ("why?",)
    return Request("design", "design/1", (system("You design."), user(*parts)), SCHEMA if schema else None)


@pytest.fixture(autouse=True)
def no_key(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in os.environ if name.endswith("_API_KEY")]:
        monkeypatch.delenv(name)


def live(address: str, **options: object) -> tuple[LiteLLM, list[float]]:
    waits: list[float] = []
    sleep: Callable[[float], None] = waits.append
    return LiteLLM("stub", api_base=address, sleep=sleep, **options), waits  # type: ignore[arg-type]


def test_an_answer_comes_with_model_tokens_fingerprint_and_unknown_cost() -> None:
    with openai_stub([Canned("because")]) as stub:
        reply = live(stub.address)[0].complete(question())

        assert (reply.text, reply.model, reply.usage.total, reply.cost, reply.fingerprint) == ("because", "openai/stub", 10, None, "stub")
        assert stub.received[0]["messages"] == [{"role": "system", "content": "You design."}, {"role": "user", "content": "why?"}]


def test_a_picture_arrives_intact_and_goes_to_the_model_that_sees() -> None:
    with openai_stub([Canned()]) as stub:
        llm, _ = live(stub.address, vision_model="eyes", models={"judge": "court"})
        llm.complete(question(image=True))
        llm.complete(question())

        address = stub.received[0]["messages"][1]["content"][1]["image_url"]["url"]
        assert base64.b64decode(address.removeprefix("data:image/png;base64,")) == b"\x89PNG-pixels"
        assert [request["model"] for request in stub.received] == ["eyes", "stub"]
        assert llm.model_for(Request("judge", "judge/1/1", ())) == "openai/court"


def test_a_schema_goes_along_and_where_it_is_refused_into_the_prompt() -> None:
    refusal = Canned(status=400, body=b'{"error": {"message": "response_format is not supported here", "type": "invalid_request_error"}}')
    with openai_stub([Canned("{}"), refusal, Canned("{}")]) as stub:
        llm, _ = live(stub.address)
        llm.complete(question(schema=True))
        llm.complete(question(schema=True))
        llm.complete(question(schema=True))

        first, _, retried, later = stub.received
        assert first["response_format"]["json_schema"]["schema"] == SCHEMA
        for request in (retried, later):
            assert "response_format" not in request
            assert request["messages"][0]["content"].endswith(json.dumps(SCHEMA))


def test_a_prompt_that_tells_its_form_in_prose_is_not_given_a_schema_on_top() -> None:
    refusal = Canned(status=400, body=b'{"error": {"message": "response_format is not supported here", "type": "invalid_request_error"}}')
    with openai_stub([refusal, Canned("{}")]) as stub:
        llm, _ = live(stub.address)
        llm.complete(Request("judge", "judge/1/1", (system("Answer with one JSON object and nothing else."), user("Well?")), SCHEMA))

        assert "response_format" not in stub.received[1]
        assert stub.received[1]["messages"][0]["content"] == "Answer with one JSON object and nothing else."
        assert not llm.takes_schemas()


def test_the_judge_may_be_another_model_and_the_version_that_answered_is_kept() -> None:
    body = {"id": "1", "object": "chat.completion", "created": 0, "model": "court-2026-01", "choices": [MESSAGE]}
    with openai_stub([Canned(body=json.dumps(body).encode())]) as stub:
        llm, _ = live(stub.address, judge_model="court")
        reply = llm.complete(Request("judge", "judge/1/1", (user("Well?"),)))

        assert stub.received[0]["model"] == "court"
        assert reply.model == "openai/court"
        assert reply.fingerprint is not None
        assert "court-2026-01" in reply.fingerprint


def test_a_model_that_cannot_see_is_not_asked_what_it_sees() -> None:
    refusal = Canned(status=400, body=b'{"error": {"message": "this model does not support image input"}}')
    with openai_stub([refusal, Canned("I see a lid")]) as stub:
        llm, _ = live(stub.address)
        drawn = Request("look", "look/lid/1", (user("Look:", Image(b"png", recipe={"view": "iso"})),))
        assert llm.sees
        with pytest.raises(TransportError, match="cannot see, and look/lid/1 is about pictures") as caught:
            llm.complete(drawn)
        assert "--vision-model" in caught.value.findings[0].hint
        assert len(stub.received) == 1


def test_a_model_that_cannot_see_is_asked_without_our_pictures_but_never_without_the_users() -> None:
    refusal = Canned(status=400, body=b'{"error": {"message": "this model does not support image input"}}')
    drawn = Request("part", "part/lid/2", (user("Mend it:", Image(b"png", recipe={"view": "iso"})),))
    with openai_stub([refusal, Canned("ok"), Canned("ok"), refusal]) as stub:
        llm, _ = live(stub.address)
        assert llm.complete(drawn).text == llm.complete(drawn).text == "ok"
        assert [request["messages"][0]["content"] for request in stub.received[1:]] == ["Mend it:\n\n(not shown)"] * 2
        with pytest.raises(TransportError, match="image input"):
            llm.complete(question(image=True))


@pytest.mark.parametrize("status", [429, 500, 503])
def test_a_busy_provider_is_asked_again_after_a_pause(status: int) -> None:
    with openai_stub([Canned(status=status, body=b"{}"), Canned(status=status, body=b"{}"), Canned("at last")]) as stub:
        llm, waits = live(stub.address)

        assert llm.complete(question()).text == "at last"
        assert len(waits) == 2
        assert waits[0] < waits[1]


def test_the_pause_that_a_provider_asks_for_is_kept() -> None:
    with openai_stub([Canned(status=429, body=b"{}", headers={"retry-after": "7"}), Canned()]) as stub:
        llm, waits = live(stub.address)
        llm.complete(question())

        assert waits == [7.0]


def test_an_empty_answer_is_asked_for_again() -> None:
    with openai_stub([Canned(" "), Canned("words")]) as stub:
        assert live(stub.address)[0].complete(question()).text == "words"


def test_a_provider_that_stays_busy_is_given_up_with_its_status() -> None:
    with openai_stub([Canned(status=503, body=b'{"error": {"message": "no room"}}')]) as stub:
        llm, waits = live(stub.address, tries=3)
        with pytest.raises(TransportError, match=r"status 503, after 3 attempts") as caught:
            llm.complete(question())
        assert caught.value.findings.codes == ("E_TRANSPORT",)
        assert len(waits) == 2


def test_a_refused_key_names_its_variable_and_shows_nothing_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)
    body = json.dumps({"error": {"message": f"Incorrect API key provided: {SECRET}", "code": "invalid_api_key"}}).encode()
    with openai_stub([Canned(status=401, body=body)]) as stub:
        llm, waits = live(stub.address)
        with pytest.raises(TransportError, match="OPENAI_API_KEY") as caught:
            llm.complete(question())

    assert stub.keys == [f"Bearer {SECRET}"]
    assert waits == []
    assert caught.value.findings.codes == ("E_KEY_MISSING",)
    assert SECRET not in "".join(traceback.format_exception(caught.value))


@pytest.mark.parametrize(
    "address",
    [
        "",
        "http://[",
        "http://",
        "127.0.0.1:8000/v1",
        "file:///etc/hosts",
        "http://host:99999/v1",
        "http://host:0",
        "http://host/\r\nx: y",
        "http://a b/",
    ],
)
def test_what_is_no_address_is_refused_before_anything_is_started(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.agents.live.Calls.shared", lambda: pytest.fail("a process is started"))
    with pytest.raises(TransportError, match="is not the address of an endpoint"):
        LiteLLM("x", api_base=address)


def test_a_missing_key_is_named_before_anything_is_sent() -> None:
    for model, variable in (
        ("gpt-5.2", "OPENAI_API_KEY"),
        ("gemini/gemini-3-flash", "GEMINI_API_KEY"),
        ("anthropic/c", "ANTHROPIC_API_KEY"),
    ):
        with pytest.raises(TransportError, match=variable) as caught:
            LiteLLM(model)
        assert caught.value.findings.codes == ("E_KEY_MISSING",)
    with pytest.raises(TransportError, match="OPENAI_API_KEY"):
        LiteLLM("some/model", api_base="https://models.example/v1")


def test_a_model_of_no_known_provider_is_explained() -> None:
    with pytest.raises(TransportError, match="provider/model"):
        LiteLLM("nobody/nothing")


@pytest.mark.parametrize("body", [b"<html>proxy error</html>", b'"hi"', b'{"choices": []}', b'{"object": "list"}', b""])
def test_a_body_that_is_no_completion_gives_an_error_of_ours(body: bytes) -> None:
    with openai_stub([Canned(body=body)]) as stub, pytest.raises(TransportError) as caught:
        live(stub.address, tries=2)[0].complete(question())
    assert caught.value.findings.codes == ("E_TRANSPORT",)


def test_silence_ends_in_a_timeout_and_a_closed_door_in_no_connection() -> None:
    with openai_stub([Canned(wait=1.0)]) as stub, pytest.raises(TransportError, match=r"within 0\.2 s"):
        live(stub.address, timeout=0.2, tries=1)[0].complete(question())
    with pytest.raises(TransportError, match="after 2 attempts"):
        live("http://127.0.0.1:9/v1", tries=2)[0].complete(question())


def test_a_closed_port_sends_nothing() -> None:
    with openai_stub([Canned()]) as stub:
        llm, _ = live(stub.address)
        with closed_port("assembly is deterministic"), pytest.raises(TransportError, match="assembly is deterministic"):
            llm.complete(question())
        assert stub.received == []
        assert llm.complete(question()).text == "hello"


def test_no_key_enters_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)
    with openai_stub([Canned()]) as stub, Run.create(RunRequest(prompt="x"), out=tmp_path / "r") as run:
        request = question()
        Recorded(live(stub.address)[0], run).complete(request)
        assert stub.keys == [f"Bearer {SECRET}"]
        assert SECRET not in json.dumps(request.to_json())
    files = [file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()]
    assert len(files) == 3
    assert not any(SECRET.encode() in content for content in files)


def test_text_from_outside_loses_every_key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOME_TOKEN", "plain-looking-value")
    told = "plain-looking-value, sk-proj-abc***xyz99, Authorization: Bearer abc.def, http://me:pass@host/"

    assert without_secrets(told) == "[key], [key], Authorization: [key], http:[key]host/"


def test_neither_articad_nor_the_port_imports_litellm() -> None:
    script = "import sys, articad.agents.llm, articad.agents.live; assert 'litellm' not in sys.modules"
    subprocess.run([sys.executable, "-c", script], check=True)


def test_an_answer_without_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.agents.live._LONGEST_ANSWER", 100)
    with openai_stub([Canned("x" * 101)]) as stub, pytest.raises(TransportError, match="101 characters"):
        live(stub.address)[0].complete(question())
    assert len(stub.received) == 1  # it is not asked again for as much


def test_a_providers_vectors_are_a_space_of_their_own_and_find_cases(tmp_path: Path) -> None:
    def vectors(*rows: list[float]) -> Canned:
        entries = [{"object": "embedding", "index": index, "embedding": row} for index, row in enumerate(rows)]
        whole = {"object": "list", "data": entries[::-1], "model": "m", "usage": {"prompt_tokens": 1, "total_tokens": 1}}
        return Canned(body=json.dumps(whole).encode())

    lamp, box = Case(kind="good", prompt="a lamp"), Case(kind="good", prompt="a box")
    with openai_stub([vectors([3.0, 4.0]), vectors([3.0, 4.0], [0.0, 2.0])]) as stub:
        embedder = LiteLLMEmbedder("vectors", api_base=stub.address)
        store = ExperienceStore(tmp_path, embedder)
        store.add(lamp, box)
        first, second = store.like_request("something that shines", "good")

        assert stub.received[0]["input"] == ["something that shines"]
        assert (first.case.prompt, round(first.likeness, 3), round(second.likeness, 3)) == (stub.received[1]["input"][0], 1.0, 0.8)
        assert embedder.embed([]).shape == (0, 1)


@pytest.mark.parametrize(("above", "mode"), [(False, None), (True, "DEV")])
def test_no_env_file_is_read(above: bool, mode: str | None, tmp_path: Path) -> None:
    """Where a program has no file, as here, the search for `.env` begins in the working folder; else beside litellm.

    Wherever the file is, nothing looks for one: that no loading begins is what holds for every place.
    """
    here = tmp_path / "a" / "b"
    here.mkdir(parents=True)
    (tmp_path / "a" / ".env" if above else here / ".env").write_text(
        "OPENAI_BASE_URL=http://127.0.0.1:9/v1\nHTTPS_PROXY=http://127.0.0.1:9\n"
    )
    code = """
import os, dotenv
loads, before = [], dict(os.environ)
load = dotenv.load_dotenv
dotenv.load_dotenv = lambda *words, **options: (loads.append(words), load(*words, **options))
from articad.agents import provider
provider.load()
print(loads, [name for name in ("OPENAI_BASE_URL", "HTTPS_PROXY") if os.environ.get(name) != before.get(name)])
"""
    environment = os.environ | {"OPENAI_API_KEY": "key"} | ({} if mode is None else {"LITELLM_MODE": mode})
    done = subprocess.run([sys.executable, "-c", code], cwd=here, env=environment, capture_output=True, text=True, check=False)

    assert done.stdout.strip() == "[] []", done.stderr


def test_an_env_file_does_not_name_another_host_for_the_key(tmp_path: Path) -> None:
    with openai_stub([Canned()]) as stub, openai_stub([Canned()]) as planted:
        (tmp_path / ".env").write_text(
            f"OPENAI_BASE_URL={planted.address}\nOPENAI_API_BASE={planted.address}\nHTTP_PROXY={planted.address}\n"
        )
        code = "from articad.agents.live import LiteLLM; from articad.agents.llm import *\n"
        code += "print(LiteLLM('openai/x').complete(Request('design', 'design/1', (user('why?'),))).text)"
        environment = os.environ | {"OPENAI_API_KEY": SECRET, "OPENAI_BASE_URL": stub.address}
        done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

        assert done.stdout.strip() == "hello", done.stderr
        assert (len(stub.received), len(planted.received)) == (1, 0)
