"""Serve one page to this machine's browser, and rebuild it when files change."""

from __future__ import annotations

import argparse
import hashlib
import json
import threading
import time
from collections.abc import Callable, Sequence
from html import escape
from http import HTTPStatus
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self

from articad.commands.checked import Check
from articad.commands.page_server import BoundedHandler, BoundedServer
from articad.files import PLAN_BYTES, read_file

if TYPE_CHECKING:
    from articad.assembly import Assembly
    from articad.commands.terminal import Terminal
    from articad.errors import ArticadError
    from articad.plan.schema import AssemblyPlan

_LOOK_S: Final = 0.3  # between two checks of the files
_LINES: Final = 8  # findings of a failed build that the page shows


class PageServer:
    """Serves a page and its version, on this machine only.

    Requests that name another host are refused, so that a foreign site whose name resolves to this machine cannot read the page. Neither
    can it show it in a frame. What sends nothing, or too slowly, keeps nobody out: `articad.commands.page_server`.

    Args:
        port: 0 for any that is free.
    """

    def __init__(self, port: int = 0) -> None:
        self.page = ""
        self.version = ""
        self.message = ""
        self.error: tuple[str, ...] = ()
        self.shown: tuple[Assembly, AssemblyPlan] | None = None
        self._encoded = ("", b"")  # the page and its bytes: who asks for it many times at once gets the same ones
        self._server = BoundedServer(port, _handler(self))
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)

    @property
    def port(self) -> int:
        """The port on which it listens."""
        return int(self._server.server_address[1])

    @property
    def address(self) -> str:
        """Address of the page."""
        return f"http://127.0.0.1:{self.port}/"

    def show(self, version: str, *, checks: dict[str, Any] | None = None) -> None:
        """Serve the page of the product that is shown, with its checks if they have ended."""
        from articad.report import Documents, report_page

        assert self.shown is not None
        assembly, plan = self.shown
        self.page = report_page(assembly, Documents(checks=checks, plan=plan.dumps()), watch=version)
        self.version = version

    def content(self) -> bytes:
        """Return the page as it is sent, or the one before the first build has succeeded."""
        page, content = self._encoded
        if page is not self.page:
            page = self.page
            content = _bytes(page)
            self._encoded = page, content
        return content or _bytes(_waiting(self.error))

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, _kind: type[BaseException] | None, _error: BaseException | None, _traceback: TracebackType | None) -> None:
        self._server.shutdown()
        self._server.server_close()


def _bytes(text: str) -> bytes:
    """Encode a text; what a script says may hold half of a surrogate pair."""
    return text.encode(errors="backslashreplace")


def _waiting(error: Sequence[str]) -> str:
    """Return the page before the first build has succeeded."""
    told = "".join(f"<p>{escape(line)}" for line in error) or "<p>Building …"
    style = "body{font:16px/1.5 system-ui,sans-serif;margin:2rem;white-space:pre-wrap}" + (
        "body{background:#a31515;color:#fff}" if error else ""
    )
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8"><meta http-equiv="refresh" content="1">'
        f"<title>articad</title><style>{style}</style>{told}</html>"
    )


def lines_of(error: ArticadError, folder: Path) -> tuple[str, ...]:
    """Return what a person needs to mend a failed build: what failed, then file, line, cause and hint of each finding."""
    from articad.kernels.parts import script_file

    lines = []
    for finding in error.findings[:_LINES]:
        script = script_file(folder / "parts", finding.where.removeprefix("parts."), "build123d")
        where = str(script.relative_to(folder)) if script.is_file() else f"plan.json, {finding.where}"
        hint = "" if finding.hint in finding.message else f" {finding.hint}"
        lines.append(f"{where}: {finding.message}{hint}")
    if len(error.findings) > _LINES:
        lines.append(f"{len(error.findings) - _LINES} more: see the terminal.")
    said = error.message.splitlines() or ["The plan has errors."]
    head = said[0] if not any(finding.message in said[0] for finding in error.findings) else "The plan has errors."
    return (head, *(lines or said[1:_LINES]))


def _handler(served: PageServer) -> type[BoundedHandler]:
    class Handler(BoundedHandler):
        def do_GET(self) -> None:
            served._server.answer_begins(self.connection)  # noqa: SLF001 - of this module
            if self.headers.get("Host") not in {f"127.0.0.1:{served.port}", f"localhost:{served.port}"}:
                self.send_error(HTTPStatus.FORBIDDEN)
            elif self.path == "/version":
                told = {"version": served.version, "message": served.message, "error": served.error}
                self._answer("application/json", json.dumps(told).encode())
            elif self.path == "/":
                self._answer("text/html; charset=utf-8", served.content())
            else:
                self.send_error(HTTPStatus.NOT_FOUND)

        def _answer(self, kind: str, content: bytes) -> None:
            self.send_response(HTTPStatus.OK)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

    return Handler


def watch(
    options: argparse.Namespace,
    terminal: Terminal,
    server: PageServer,
    *,
    opened: Callable[[str], object] | None = None,
    wait: Callable[[float], object] = time.sleep,
) -> int:
    """Build and serve until interrupted; return the number of builds.

    Args:
        options: Options of the command.
        terminal: Gets a line for each build and for each error.
        server: Serves the page.
        opened: Opens an address in a browser.
        wait: Waits between two checks; a KeyboardInterrupt from it ends the watch.
    """
    folder = Path(options.plan) if Path(options.plan).is_dir() else Path(options.plan).parent
    before, built = "", 0
    check: Check | None = None
    try:
        while True:
            now = fingerprint(folder)
            if now != before:
                before = now
                if check is not None:
                    check.stop()
                check = Check(folder, options) if _rebuild(folder, options, terminal, server, version=now) else None
                built += 1
                if built == 1 and opened is not None:
                    opened(server.address)
            elif check is not None and check.has_ended:
                _checked(check, terminal, server, version=now)
                check = None
            wait(_LOOK_S)
    except KeyboardInterrupt:
        return built
    finally:
        if check is not None:
            check.stop()


def fingerprint(folder: Path) -> str:
    """Return a value that changes whenever the plan or a part script does."""
    total = hashlib.sha256()
    for file in [folder / "plan.json", *sorted(folder.glob("parts*.py")), *sorted((folder / "parts").glob("*.py"))]:
        try:
            content = read_file(file, PLAN_BYTES)
        except OSError:  # deleted, or just being replaced: the next check will see
            continue
        total.update(f"{file.name}\0{len(content)}\0".encode() + content)
    return total.hexdigest()[:16]


def _rebuild(folder: Path, options: argparse.Namespace, terminal: Terminal, server: PageServer, *, version: str) -> bool:
    """Rebuild what has changed and show it, under a version of its own: checks take several times as long. Return whether it succeeded.

    Errors are printed and shown on the page, which otherwise stays as it was.
    """
    from articad.commands.steps import assembled
    from articad.errors import ArticadError
    from articad.plan.schema import AssemblyPlan

    started = time.monotonic()
    server.message = "Building …"
    try:
        plan = AssemblyPlan.load(folder)
        server.shown = assembled(plan, folder / "parts", options, terminal), plan
        server.show(f"{version} before checks")
    except ArticadError as error:
        terminal.error(error)
        server.message, server.error = "", lines_of(error, folder)
        return False
    server.message, server.error = "Checking …", ()
    terminal.say(f"{plan.name}: built in {time.monotonic() - started:.1f} s.")
    terminal.out.flush()
    return True


def _checked(check: Check, terminal: Terminal, server: PageServer, *, version: str) -> None:
    """Show what a check found, or why it found nothing."""
    from articad.interference.statements import about_rest

    report = check.report()
    if report is None:
        terminal.say(f"Not checked: {check.failure}")
        server.message, server.error = "", (f"The product was not checked: {check.failure}",)
        return
    server.show(version, checks=report)
    server.message = ""
    for finding in report["findings"]:
        terminal.finding(finding)
    terminal.say(about_rest(report).sentence)
    terminal.out.flush()
