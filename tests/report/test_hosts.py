"""The page inside other programs: notebooks, editors with a strict policy, and hosts of agents."""

from __future__ import annotations

import json
from collections.abc import Iterator
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from articad.report import report_page
from tests.report.test_page import hinged

# Policies of the documents that hold the output of cells: JupyterLab has none there, Visual Studio Code this one
# (src/vs/workbench/contrib/notebook/browser/view/renderers/backLayerWebView.ts); `self` stands for the resources of the editor.
NOTEBOOKS = {
    "jupyter": "",
    "vscode": (
        "default-src 'none'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' https: http: data:; font-src 'self' https:; connect-src https:; child-src https: data:;"
    ),
}
# What a host of apps applies if an app asks for no addresses: specification 2026-01-26 of the extension io.modelcontextprotocol/ui.
STRICTEST = (
    "default-src 'none'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "media-src 'self' data:; connect-src 'none'; frame-src 'none'; object-src 'none'; base-uri 'self'"
)


@pytest.fixture
def context(chromium: Any) -> Iterator[Any]:
    made = chromium.new_context(viewport={"width": 1000, "height": 760})
    yield made
    made.close()


def opened(context: Any, folder: Path, text: str) -> tuple[Any, list[str]]:
    """Open a host's document; return its page, and what the browser said about errors."""
    file = folder / "host.html"
    file.write_text(text, encoding="utf-8")
    page, said = context.new_page(), []
    page.on("console", lambda message: said.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto(file.as_uri())
    return page, said


def moves(frame: Any) -> bool:
    """Move the first slider of a page in a frame; return whether its model moved as far."""
    frame.wait_for_selector("html[data-ready]", state="attached", timeout=60_000)
    frame.locator("#drivers input[type=range]").first.evaluate("s => { s.value = 40; s.dispatchEvent(new Event('input')) }")
    return bool(abs(frame.evaluate("articad.q().hinge") * 180 / 3.141592653589793 - 40) < 1e-9)


@pytest.mark.parametrize("policy", NOTEBOOKS)
def test_a_cell_of_a_notebook_shows_an_assembly_that_moves_and_a_part(context: Any, tmp_path: Path, policy: str) -> None:
    assembly = hinged()
    cells = assembly._repr_mimebundle_()["text/html"] + assembly.parts["lid"]._repr_mimebundle_()["text/html"]
    meta = f'<meta http-equiv="Content-Security-Policy" content="{escape(NOTEBOOKS[policy])}">' if NOTEBOOKS[policy] else ""
    page, said = opened(context, tmp_path, f"<!doctype html><html><head>{meta}</head><body>{cells}</body></html>")

    whole, part = page.frames[1:]
    assert moves(whole)
    part.wait_for_selector("html[data-ready]", state="attached", timeout=60_000)
    assert part.evaluate("articad.model.parts.map(p => p.name)") == ["lid"]
    assert "Nothing moves" in part.inner_text("#drivers")
    assert said == []


HOST = """<!doctype html><html><body><iframe sandbox="allow-scripts" style="width: 100%; height: 650px"></iframe><script>
const frame = document.querySelector("iframe"), { app, page, refused } = JSON.parse(document.getElementById("data").textContent);
window.heard = [];
addEventListener("message", ({ source, data }) => {
  if (source !== frame.contentWindow) return;
  heard.push(data.method);
  const answer = (message) => source.postMessage({ jsonrpc: "2.0", ...message }, "*");
  if (data.method === "ui/initialize") answer({ id: data.id, result: { protocolVersion: "2026-01-26", hostCapabilities: {}, hostInfo: {}, hostContext: {} } });
  if (data.method === "ui/notifications/initialized") {
    answer({ method: "ui/notifications/tool-input", params: { arguments: { design: "chest" } } });
    answer({ method: "ui/notifications/tool-result", params: { content: [] } });
  }
  if (data.method === "resources/read") {
    window.read = data.params.uri;
    answer(refused ? { id: data.id, error: { code: -32002, message: refused } } : { id: data.id, result: { contents: [{ uri: data.params.uri, text: page }] } });
  }
});
frame.srcdoc = app;
</script></body></html>"""


def hosted(refused: str = "") -> str:
    """Return a host that shows the app under the strictest policy, and answers it as the specification says."""
    policy = f'<meta http-equiv="Content-Security-Policy" content="{STRICTEST}">'
    app = (
        files("articad.mcp")
        .joinpath("page.html")
        .read_text(encoding="utf-8")
        .replace('<meta charset="utf-8">', f'<meta charset="utf-8">{policy}')
    )
    data = {"app": app, "page": report_page(hinged()), "refused": refused}
    held = json.dumps(data).replace("<", "\\u003c")
    return HOST.replace("<script>", f'<script type="application/json" id="data">{held}</script><script>', 1)


def test_a_host_of_agents_shows_the_model_beside_the_answer(context: Any, tmp_path: Path) -> None:
    page, said = opened(context, tmp_path, hosted())

    frame = page.frames[1]
    assert moves(frame)
    assert page.evaluate("heard.slice(0, 3)") == ["ui/initialize", "ui/notifications/initialized", "resources/read"]
    assert page.evaluate("read") == "ui://articad/designs/chest"
    frame.click("#play")
    frame.wait_for_function("() => Math.abs(articad.q().hinge - 40 * Math.PI / 180) > 1e-3")
    assert said == []


def test_an_app_says_why_it_cannot_show_the_model(context: Any, tmp_path: Path) -> None:
    page, _ = opened(context, tmp_path, hosted(refused="There is no design 'chest'."))

    page.frames[1].wait_for_function("() => document.getElementById('state').textContent.includes('There is no design')")
