"""The report of an audit as one HTML page, and as lines for a terminal: most severe first."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from articad.auditing.report import Audit, Scoreboard

if TYPE_CHECKING:
    from articad.assembly import Assembly

_TITLES = {"error": "Errors", "warning": "Warnings", "info": "Notes"}
_STYLE = """\
body{font:15px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:72rem;padding:0 1rem;color:#1d2733;background:#fff}
table{border-collapse:collapse;width:100%;margin:.5rem 0 1.5rem}th,td{text-align:left;vertical-align:top;padding:.35rem .6rem;border-bottom:1px solid #dde3ea}
td.n{text-align:right;white-space:nowrap}code{background:#f2f5f8;padding:0 .25rem;border-radius:3px}.error{color:#b3261e}.warning{color:#8a5a00}.info{color:#35618e}
small{color:#5b6875}
@media(prefers-color-scheme:dark){body{color:#dde3ea;background:#14191f}th,td{border-color:#313b46}code{background:#222b35}.error{color:#ff8a80}.warning{color:#ffc766}.info{color:#8fc1ff}}
"""


def audit_page(audit: Audit, assembly: Assembly | None = None) -> str:
    """Return the page of one file: the findings beside the model, which each of them moves to its pose; without a model, the findings alone."""
    if assembly is not None:
        from articad.report import Documents, report_page  # noqa: PLC0415 - only this page needs the viewer

        return report_page(assembly, Documents(audit=audit.to_json()))
    return _page(f"Audit of {audit.file}", _one(audit))


def scoreboard_page(board: Scoreboard) -> str:
    """Return the page of many files: a table of all, the findings by frequency, then each file."""
    rows = "".join(
        f'<tr><td><a href="#f{index}">{escape(audit.file)}</a></td><td>{audit.format}</td><td class="n">{audit.links}</td><td class="n">{audit.joints}</td>'
        f'<td class="n error">{audit.count("error")}</td><td class="n warning">{audit.count("warning")}</td><td class="n">{audit.count("info")}</td>'
        f"<td>{escape(loaded(audit))}</td></tr>"
        for index, audit in enumerate(board.audits)
    )
    codes = "".join(
        f'<tr><td><code>{code}</code></td><td class="n">{files}</td><td class="n">{count}</td></tr>' for code, count, files in board.codes
    )
    head = "<tr><th>file<th>format<th>links<th>joints<th>errors<th>warnings<th>notes<th>loads in</tr>"
    body = f"<table>{head}{rows}</table><h2>What was found</h2><table><tr><th>code<th>files<th>findings</tr>{codes}</table>"
    body += "".join(f'<h2 id="f{index}">{escape(audit.file)}</h2>{_one(audit)}' for index, audit in enumerate(board.audits))
    return _page(f"Audit of {board.folder}", body)


def loaded(audit: Audit) -> str:
    """Return the engines that load the file, and those that do not."""
    words = {True: "", False: " no", None: " ?"}
    return ", ".join(f"{loading.engine}{words[loading.loads]}" for loading in audit.engines)


def _one(audit: Audit) -> str:
    blocks = [
        f"<p>{audit.links} links, {audit.joints} joints that move; motion {audit.motion}; {escape(loaded(audit)) or 'not loaded in any engine'}.</p>"
    ]
    for severity, title in _TITLES.items():
        found = [finding for finding in audit.findings if finding.severity == severity]
        if not found:
            continue
        rows = "".join(
            f'<tr><td><code class="{severity}">{finding.code}</code><br><small>{escape(finding.where)}</small></td>'
            f'<td>{escape(finding.message)}<br><small>{escape(finding.hint)}</small></td><td class="n">{_numbers(finding.to_json())}</td>'
            f"<td>{escape(finding.cause or '')}</td></tr>"
            for finding in found
        )
        blocks.append(
            f"<h3 class={severity}>{title} ({len(found)})</h3><table><tr><th>what, where<th>found, remedy<th>value, limit<th>cause</tr>{rows}</table>"
        )
    if not audit.findings:
        blocks.append("<p>No findings.</p>")
    if audit.undone:
        blocks.append("<h3>Not checked</h3><ul>" + "".join(f"<li>{escape(line)}</li>" for line in audit.undone) + "</ul>")
    return "".join(blocks)


def _numbers(finding: dict[str, object]) -> str:
    value, limit, unit = finding["value"], finding["limit"], escape(str(finding["unit"] or ""))
    if value is None:
        return ""
    return f"{value:.6g} {unit}" + (f"<br><small>{limit:.6g} {unit}</small>" if limit is not None else "")


def _page(title: str, body: str) -> str:
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
        f"<style>{_STYLE}</style><h1>{escape(title)}</h1>{body}</html>\n"
    )
