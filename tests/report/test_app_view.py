"""The view of MCP Apps in a browser, with a host that answers as the specification has it: the view becomes the design's page."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import articad.mcp
from articad.report import Documents, report_page
from tests.assemblies import four_bar
from tests.report.conftest import Opened

VIEW = (Path(articad.mcp.__file__).parent / "page.html").read_text(encoding="utf-8")
HOST = """<!doctype html><html lang="en" data-ready><meta charset="utf-8"><body><script>
const page = %s, said = [];
const frame = document.createElement("iframe");
frame.sandbox = "allow-scripts";
frame.width = 900; frame.height = 600;
const send = (message) => frame.contentWindow.postMessage({ jsonrpc: "2.0", ...message }, "*");
window.addEventListener("message", ({ data }) => {
  said.push(data);
  if (data.method === "ui/initialize") send({ id: data.id, result: { protocolVersion: data.params.protocolVersion, hostCapabilities: {} } });
  if (data.method === "ui/notifications/initialized") {
    send({ method: "ui/notifications/tool-input", params: { arguments: { design: "four bar" } } });
    send({ id: 99, method: "ping", params: {} });
    send({ method: "ui/notifications/tool-result", params: { content: [], isError: %s } });
  }
  if (data.method === "resources/read") send(page === null
    ? { id: data.id, error: { code: -32602, message: "There is no design." } }
    : { id: data.id, result: { contents: [{ uri: data.params.uri, text: page }] } });
});
frame.srcdoc = %s;
document.body.append(frame);
</script></body></html>"""


def hosted(open_page: Callable[..., Opened], page: str | None, *, failed: bool = False) -> Opened:
    texts = [json.dumps(text).replace("</", "<\\/") for text in (page, failed, VIEW)]
    return open_page(HOST % (texts[0], texts[1], texts[2]))


def test_the_view_becomes_the_page_of_the_design_that_the_tool_was_called_with(open_page: Callable[..., Opened]) -> None:
    opened = hosted(open_page, report_page(four_bar(), Documents()))
    frame = opened.page.frames[1]
    frame.wait_for_selector("html[data-ready]", state="attached", timeout=60_000)
    assert frame.query_selector("input[type=range]")
    said = opened("said")
    assert [message["params"]["uri"] for message in said if message.get("method") == "resources/read"] == [
        "ui://articad/designs/four%20bar"
    ]
    assert {"jsonrpc": "2.0", "id": 99, "result": {}} in said
    assert not [line for line in opened.console if line.startswith("error")]


@pytest.mark.parametrize(("failed", "words"), [(False, "There is no design."), (True, "The page of the design comes when it is built.")])
def test_the_view_says_why_there_is_no_page(open_page: Callable[..., Opened], failed: bool, words: str) -> None:
    opened = hosted(open_page, None, failed=failed)
    opened.page.frames[1].wait_for_function("words => document.body.innerText.includes(words)", arg=words)
