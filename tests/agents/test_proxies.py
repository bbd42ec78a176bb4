"""The proxies that the environment states are used for calls of models, those and no others."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from articad.agents.calls import Calls
from articad.agents.live import LiteLLM
from articad.agents.llm import Request, user
from tests.agents.openai_stub import completion, respond

VARIABLES = ("HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY", "NO_PROXY")


@contextmanager
def proxy() -> Iterator[tuple[str, list[str]]]:
    """Serve as a proxy that answers by itself; yield its address and the addresses that it is asked for."""
    asked: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            asked.append(self.path)
            self.rfile.read(int(self.headers["content-length"]))
            respond(self, 200, completion("hello"), {})

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the base class's name
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_address[1]}", asked
        server.shutdown()


@pytest.mark.parametrize("variable", ["HTTP_PROXY", "ALL_PROXY"])
def test_a_stated_proxy_is_used(variable: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
        monkeypatch.delenv(name.lower(), raising=False)
    monkeypatch.setenv("OPENAI_API_KEY", "sk-none")
    with proxy() as (address, asked):
        monkeypatch.setenv(variable, address)
        Calls.shared().close()
        model = LiteLLM("stub", api_base="http://models.invalid/v1")
        assert model.complete(Request(step="x", role="designer", messages=(user("hi"),))).text == "hello"
        assert asked == ["http://models.invalid/v1/chat/completions"]
