"""An endpoint that answers as a recorded run was answered, in a process of its own: it keeps no count, so that resumed runs are served alike."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from articad.runs.run import Run
from tests.agents.openai_stub import completion, respond


@contextmanager
def endpoint(recording: Path) -> Iterator[str]:
    """Serve the replies of a recorded run by the texts of their prompts; yield the address."""
    run = Run.view(recording)
    stored = [run.reply(step) for step in run.replies()]
    replies = {_texts(entry["messages"]): str(entry["reply"]["text"]) for entry in stored if entry is not None}

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            asked = json.loads(self.rfile.read(int(self.headers["content-length"])))
            text = replies.get(_texts(asked["messages"]))
            respond(self, 400 if text is None else 200, completion(text), {})

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the base class's name
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    pid = os.fork()
    if pid == 0:
        try:
            server.serve_forever()
        finally:
            os._exit(0)
    server.socket.close()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}/v1"
    finally:
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)


def _texts(messages: Any) -> tuple[str, ...]:
    """Return the words of a conversation, without pictures, in our form or in OpenAI's."""
    found: list[str] = []
    for message in messages:
        content = message["content"]
        parts = [{"text": content}] if isinstance(content, str) else content
        found += [part["text"] for part in parts if isinstance(part.get("text"), str)]
    return tuple(found)
