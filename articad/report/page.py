"""The page itself: one file that needs nothing else and may do nothing else.

Its policy allows exactly the one script and the one style sheet that it contains, by their digests; it has no address that a browser
would fetch. Texts from plans, files and models are escaped; the model's JSON cannot end its element.
"""

from __future__ import annotations

import base64
import hashlib
import json
from functools import cache
from html import escape
from importlib.resources import files

from articad.assembly import Assembly
from articad.report.icons import icon
from articad.report.model import drawn_steps, viewer_model
from articad.report.overlaps import drawn_overlaps
from articad.report.sections import Documents, all_sections, badges, facts_about, summary, total_mass

__all__ = ["Documents", "report_page"]

_VIEWS = ("iso", "front", "right", "top")


def report_page(assembly: Assembly, documents: Documents | None = None, *, watch: str | None = None) -> str:
    """Return the page of an assembly; the same input gives the same text.

    Args:
        assembly: The assembly to show and move.
        documents: Reports to show beside it.
        watch: Version of the page served by `articad watch`; the page then asks its server for newer ones.
    """
    documents = documents or Documents()
    model = viewer_model(assembly)
    model["overlaps"] = drawn_overlaps(assembly, documents.checks, documents.certificate)
    if documents.order is not None:
        model["order"] = drawn_steps(assembly, documents.order)
    for part in model["parts"]:
        part["facts"] = facts_about(part["name"], documents)
    if watch is not None:
        model["watch"] = watch
    script, style = _asset("viewer.js"), _asset("viewer.css")
    plan = f'<script type="application/json" id="plan">{_json_text(documents.plan)}</script>\n' if documents.plan is not None else ""
    return "".join(
        [
            '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n',
            f'<meta http-equiv="Content-Security-Policy" content="{_policy(script, style, watched=watch is not None)}">\n',
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n<meta name="referrer" content="no-referrer">\n',
            '<meta name="generator" content="articad">\n',
            f"<title>{escape(assembly.name)} – articad</title>\n<style>{style}</style>\n</head>\n<body>\n",
            _header(assembly, documents, unchecked=watch is not None and documents.checks is None),
            '<div id="banner" role="alert" hidden></div>\n<main>\n',
            _stage(assembly),
            '<div id="card" hidden></div>\n',
            '<div id="panel" tabindex="0" role="region" aria-label="controls and reports">\n<p id="status" role="status" aria-live="polite"></p>\n',
            f'<p class="unseen">{escape(summary(assembly, documents))}</p>\n',
            _motion(),
            all_sections(assembly, documents),
            _keys(),
            "</div>\n</main>\n",
            f'<script type="application/json" id="model">{_json_text(json.dumps(model, ensure_ascii=True, allow_nan=False, separators=(",", ":")))}</script>\n',
            plan,
            f"<script>{script}</script>\n</body>\n</html>\n",
        ]
    )


def _policy(script: str, style: str, *, watched: bool) -> str:
    allowed = {
        "default-src": "'none'",
        "script-src": f"'sha256-{_digest(script)}'",
        "style-src": f"'sha256-{_digest(style)}'",
        "img-src": "data: blob:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    if watched:
        allowed["connect-src"] = "'self'"
    return "; ".join(f"{key} {value}" for key, value in allowed.items())


def _digest(text: str) -> str:
    return base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")


@cache
def _asset(name: str) -> str:
    return files("articad.report").joinpath(name).read_text(encoding="utf-8").replace("\r\n", "\n")


def _json_text(text: str) -> str:
    """Return JSON that cannot end its element, nor open a comment: `<` and `>` occur in strings only."""
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _header(assembly: Assembly, documents: Documents, *, unchecked: bool) -> str:
    counts = {"part": len(assembly.parts), "joint": len(assembly.joints), "freedom": assembly.mechanism.mobility}
    told = ", ".join(f"{count} {thing}{'' if count == 1 else 's'}" for thing, count in counts.items()) + f", {total_mass(assembly)}"
    pending = '<span class="badge quiet">not checked yet</span>' if unchecked else ""
    return (
        f'<header><h1>{escape(assembly.name)}</h1><button type="button" id="theme" aria-label="light or dark">{icon("theme")}</button>'
        f'<span class="quiet">{escape(told)}</span><span class="badges">{pending}{badges(documents, moves=bool(assembly.drivers))}</span></header>\n'
    )


_TOOLS = {"parallel": "parallel rays", "axes": "joint axes", "names": "names of parts", "measure": "measure"}


def _stage(assembly: Assembly) -> str:
    views = "".join(_tool(f'data-view="{view}"', view, f"{view} view") for view in _VIEWS)
    tools = "".join(_tool(f'id="tool-{key}" aria-pressed="false"', key, label) for key, label in _TOOLS.items())
    rest = _tool('id="reset"', "reset", "back to rest")
    axes = "".join(f'<line id="triad-{a}" class="{a}" x1="50" y1="50" x2="50" y2="50"/>' for a in "xyz")
    names = "".join(f'<text id="triad-{a}-name" class="{a}" x="50" y="50">{a}</text>' for a in "xyz")
    cuts = "".join(
        f'<div class="cut"><label><input type="checkbox" id="cut-{a}"> {a}</label>'
        f'<input type="range" id="cut-{a}-at" aria-label="position of the section across {a}" min="0" max="1" step="any" value="0.5">'
        f'<label><input type="checkbox" id="cut-{a}-flip"> other side</label></div>'
        for a in "xyz"
    )
    saved = (
        ("save-png", "picture (PNG)"),
        ("save-gif", "animation (GIF)"),
        ("save-webm", "film (WebM)"),
        ("link", "copy link to this view"),
    )
    saves = "".join(f'<button type="button" id="{key}">{label}</button>' for key, label in saved)
    return (
        f'<div id="stage"><canvas id="canvas" tabindex="0" role="application" aria-label="Model of {escape(assembly.name)}: '
        'arrow keys turn it, plus and minus zoom"></canvas><div id="labels" aria-hidden="true"><svg id="leaders"></svg></div>\n'
        f'<div id="tools"><button type="button" id="play" aria-pressed="false">▶ Play</button>'
        f'<div class="bar">{views}</div><div class="bar">{tools}</div>'
        f'<div class="bar">{rest}</div>'
        '<button type="button" id="unfocus" hidden>show all</button></div>\n'
        '<p id="measured" hidden></p>\n'
        f'<svg id="cube" viewBox="0 0 100 100" aria-hidden="true">{axes}{names}</svg>\n'
        f'<div id="cuts"><label title="pull the parts out of each other">{icon("explode")}<span>explode</span>'
        '<input type="range" id="explode" min="0" max="1.5" step="any" value="0"></label>'
        f'<details class="menu"><summary>{icon("section")}section</summary><div>{cuts}</div></details>'
        f'<details class="menu"><summary>{icon("save")}save</summary><div>{saves}</div></details></div></div>\n'
    )


def _tool(attributes: str, drawing: str, label: str) -> str:
    """Return a button that shows an icon; its name appears under the pointer and is read aloud."""
    return f'<button type="button" {attributes} aria-label="{label}" data-tip="{label}">{icon(drawing)}</button>'


def _motion() -> str:
    return (
        '<details class="section" open><summary><h2>Motion</h2></summary><div id="drivers"></div>\n'
        '<details id="followers" hidden><summary class="quiet">Joints that follow</summary>'
        '<table><tbody id="followers-rows"></tbody></table></details></details>\n'
    )


def _keys() -> str:
    rows: list[tuple[str, str]] = [
        ("1 … 7", "views: iso, front, right, top, back, left, bottom"),
        ("arrows, + −", "turn and zoom, when the model has the focus"),
        ("space", "play, or pause"),
        ("o", "parallel or perspective rays"),
        ("a n m", "joint axes and frames, names of parts, measure"),
        ("h", "hide or show the selected part"),
        ("r", "back to rest"),
        ("f", "show the whole"),
        ("Esc", "deselect, show all parts, or end measuring"),
    ]
    listed = "".join(f"<tr><td><kbd>{escape(key)}</kbd></td><td>{escape(what)}</td></tr>" for key, what in rows)
    return f'<details class="section keys"><summary><h2>Keys</h2></summary><table><tbody>{listed}</tbody></table></details>\n'
