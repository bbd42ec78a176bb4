"""Terminal: the output of commands. Lines and tables on stdout, progress and errors on stderr; or one JSON report and nothing else.

Rich is imported only for a terminal without --json. Everywhere else the output is plain text with aligned columns, which survives pipes,
logs and CI.
"""

from __future__ import annotations

import json
import os
import re
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TextIO

from articad.aliases import Progress

if TYPE_CHECKING:
    from articad.errors import ArticadError
    from articad.findings import Findings

Report = dict[str, Any]
"""The report of a command: `{"schema": "articad.<kind>/1", "ok": bool, "findings": […], …}`."""


_STARTED = "started"
_DONE = "done"  # a step of the program itself
_UNREMARKABLE = {"cached", "derived", "kept"}  # nothing had to be done
_SMOOTH = {"built", _DONE, "made", "ok", "read", "written"}  # states of success
_WORTH_A_LINE_S = 2.0  # shorter steps are not reported
# Control and format characters of Unicode, line separators, surrogates; but not newline and tab.
_OBEYED = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\xad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u2064\u2066-\u206f\ufeff\ufff9-\ufffb\ud800-\udfff]"
)
_BREAKING = re.compile("[\t\n]")
_SHOWN_AT_ONCE = 3  # names in progress beside the bar: more do not fit into 80 columns


class Terminal:
    """The output of a command.

    Args:
        as_json: Print one JSON report and nothing else on stdout.
        quiet: Print findings and errors only.
        verbose: Print details, and tracebacks of defects.
        color: False forbids colour; by default it is used on a terminal.

    Attributes:
        logs: Whether each item that ends gets a line where no progress can be shown.
    """

    def __init__(
        self,
        *,
        as_json: bool = False,
        quiet: bool = False,
        verbose: bool = False,
        color: bool = True,
        out: TextIO | None = None,
        err: TextIO | None = None,
    ) -> None:
        self.as_json, self.quiet, self.verbose, self.logs = as_json, quiet, verbose, True
        self.out, self.err = out or sys.stdout, err or sys.stderr
        self._color = color and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"

    # ------------------------------------------------------------------ results

    def say(self, text: str = "") -> None:
        """Print a line of the result; no name in it begins another one."""
        self.text(on_one_line(text))

    def text(self, text: str) -> None:
        """Print a result of several lines."""
        if not (self.as_json or self.quiet):
            print(plain(text), file=self.out)

    def detail(self, text: str) -> None:
        """Print a line for -v."""
        if self.verbose:
            print(plain(text), file=self.err)

    def table(self, columns: Sequence[str], rows: Sequence[Sequence[object]], *, right: Sequence[int] = ()) -> None:
        """Print a table.

        Args:
            columns: Headings.
            rows: Cells.
            right: Indices of numeric columns.
        """
        if self.as_json or self.quiet or not rows:
            return
        cells = [[on_one_line(str(cell)) for cell in row] for row in rows]
        if self._is_watched(self.out):
            self._rich_table(columns, cells, right)
            return
        widths = [max(len(row[index]) for row in [list(columns), *cells]) for index in range(len(columns))]
        for row in [list(columns), *cells]:
            aligned = (
                cell.rjust(width) if index in right else cell.ljust(width)
                for index, (cell, width) in enumerate(zip(row, widths, strict=True))
            )
            print("  ".join(aligned).rstrip(), file=self.out)

    def findings(self, findings: Findings) -> None:
        """Print findings, the errors even with -q."""
        for finding in findings:
            self.finding(finding.to_json())

    def finding(self, finding: Report) -> None:
        """Print a finding as a report has it, an error even with -q."""
        if not self.as_json and (finding["severity"] == "error" or not self.quiet):
            print(self._line_of(finding, self.out), file=self.out)

    def finish(self, report: Report) -> None:
        """Print the JSON report, if it was requested."""
        if self.as_json:
            print(plain(json.dumps(report, indent=1, ensure_ascii=False, allow_nan=False)), file=self.out)
        self.out.flush()

    # ------------------------------------------------------------------ errors

    def error(self, error: ArticadError) -> None:
        """Print an error in full: what happened, its findings with their hints, and how to install what is missing."""
        self.finish(
            {
                "schema": "articad.error/1",
                "ok": False,
                "error": self.described(error),
                "findings": [finding.to_json() for finding in error.findings],
            }
        )
        if self.as_json:
            return
        told = "\n".join(f"{finding}\n{finding.message}" for finding in error.findings)
        news = [line for line in error.message.splitlines() if line not in told]  # a message may list its own findings
        headline = "\n".join(news) or f"cannot continue; stage {error.stage}:"
        print(self._painted("articad: ", "31;1", self.err) + plain(headline), file=self.err)
        for finding in error.findings:
            print(self._line_of(finding.to_json(), self.err), file=self.err)
        how_to_get = getattr(error, "how_to_get", "")
        if how_to_get and how_to_get not in told:
            print(f"  {plain(how_to_get)}", file=self.err)
        script_traceback = getattr(error, "traceback", "")
        if script_traceback:
            print(plain(script_traceback.rstrip()), file=self.err)
        if self.verbose:
            print(plain("".join(traceback.format_exception(error))), end="", file=self.err)

    @staticmethod
    def described(error: ArticadError) -> dict[str, Any]:
        """Return an error as an entry of a report."""
        return {"type": type(error).__name__, "stage": error.stage, "message": error.message}

    def failure(self, error: BaseException, explanation: str) -> None:
        """Print one line about an unexpected exception, and how to learn more."""
        name = type(error).__name__
        self.finish(
            {"schema": "articad.error/1", "ok": False, "error": {"type": name, "stage": None, "message": str(error)}, "findings": []}
        )
        if not self.as_json:
            print(self._painted("articad: ", "31;1", self.err) + plain(explanation), file=self.err)
        if self.verbose:
            print(plain("".join(traceback.format_exception(error))), end="", file=self.err)

    def interrupted(self) -> None:
        """Print that the user stopped the program."""
        if self._is_watched(self.err):
            print("\x1b[?25h", end="", file=self.err)  # a bar that was cut off has hidden the cursor
        self.failure(KeyboardInterrupt(), "interrupted; finished work is kept.")
        self.out.flush()
        self.err.flush()

    # ------------------------------------------------------------------ progress

    @contextmanager
    def progress(self, title: str, total: int | None = None, note: Callable[[], str] | None = None) -> Iterator[Progress]:
        """Show progress: live on a terminal, otherwise a line for each item that ends.

        On a terminal, only lines of items that did not succeed remain after the bar.

        Args:
            title: The work in progress.
            total: Number of items, if it is known.
            note: Returns further text, such as the tokens that were used.
        """
        if self.as_json or self.quiet:
            yield _silent
        elif self._is_watched(self.err):
            with self._live(title, total, note) as tell:
                yield tell
        elif not self.logs:
            yield _silent
        else:
            yield self._lines()

    def _lines(self) -> Progress:
        started: dict[str, float] = {}
        lock = threading.Lock()

        def tell(name: str, state: str) -> None:
            now = time.monotonic()
            with lock:
                if state == _STARTED:
                    started[name] = now
                elif self.verbose or (state not in _UNREMARKABLE and not self._too_short(name, state, started, now)):
                    print(_ended(name, state, started, now), file=self.err, flush=True)

        return tell

    @staticmethod
    def _too_short(name: str, state: str, started: dict[str, float], now: float) -> bool:
        return state == _DONE and now - started.get(name, now) < _WORTH_A_LINE_S

    @contextmanager
    def _live(self, title: str, total: int | None, note: Callable[[], str] | None) -> Iterator[Progress]:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, ProgressColumn, SpinnerColumn, Task, TextColumn
        from rich.progress import Progress as Bars
        from rich.text import Text

        class Elapsed(ProgressColumn):
            def render(self, task: Task) -> Text:
                seconds = int(task.elapsed or 0)
                clock = f"{seconds // 60}:{seconds % 60:02d}"
                return Text(f"{clock} · {note()}" if note is not None else clock, style="dim")

        counted = (BarColumn(16), MofNCompleteColumn()) if total is not None else ()
        columns = (SpinnerColumn(), TextColumn("{task.description}", markup=False), *counted, Elapsed())
        console = Console(file=self.err, no_color=not self._color, highlight=False)
        started: dict[str, float] = {}
        lock = threading.Lock()
        with Bars(*columns, console=console, transient=True) as bars:
            task = bars.add_task(title, total=total)

            def tell(name: str, state: str) -> None:
                now = time.monotonic()
                with lock:
                    if state == _STARTED:
                        started[name] = now
                    else:
                        if state not in _UNREMARKABLE | _SMOOTH:
                            bars.console.print(Text(_ended(name, state, started, now)))
                        started.pop(name, None)
                        bars.advance(task)
                    more = f" and {len(started) - _SHOWN_AT_ONCE} more" if len(started) > _SHOWN_AT_ONCE else ""
                    bars.update(task, description=on_one_line(f"{title} {', '.join(list(started)[-_SHOWN_AT_ONCE:])}{more}".rstrip()))

            yield tell

    # ------------------------------------------------------------------ looks

    def _is_watched(self, stream: TextIO) -> bool:
        return self._color and not self.as_json and stream.isatty()

    def _painted(self, text: str, code: str, stream: TextIO) -> str:
        return f"\x1b[{code}m{text}\x1b[0m" if self._is_watched(stream) else text

    def _line_of(self, finding: Report, stream: TextIO) -> str:
        code = self._painted(on_one_line(finding["code"]), {"error": "31", "warning": "33", "info": "36"}[finding["severity"]], stream)
        from articad.findings import measured_against

        numbers = measured_against(finding)
        hint = f"\n{finding['hint']}" if finding["hint"] else ""
        told = plain(f"{on_one_line(finding['where'])}: {finding['message']}{numbers}{hint}")
        return f"  {code} " + told.replace("\n", "\n    ")  # no name in a message begins a line of its own

    def _rich_table(self, columns: Sequence[str], cells: Sequence[Sequence[str]], right: Sequence[int]) -> None:
        from rich.box import SIMPLE_HEAD
        from rich.console import Console
        from rich.table import Table
        from rich.text import Text

        table = Table(box=SIMPLE_HEAD)
        for index, column in enumerate(columns):
            table.add_column(column, justify="right" if index in right else "left", overflow="fold")
        for row in cells:
            table.add_row(*map(Text, row))  # Text: a name with [brackets] is a name, not markup
        Console(file=self.out).print(table)


def _ended(name: str, state: str, started: dict[str, float], now: float) -> str:
    """Return the line about the end of an item, with its duration if that is known."""
    return on_one_line(f"  {name}: {state}") + (f", {now - started[name]:.1f} s" if name in started else "")


def plain(text: str) -> str:
    """Return text that a terminal displays but does not execute: names and messages may come from untrusted files, scripts or models.

    Escape sequences and bidirectional controls are shown by their code points; newlines and tabs stay.
    """
    return _OBEYED.sub(_spelled, text)


def on_one_line(text: str) -> str:
    """Return text as `plain` does, also without newlines and tabs: a name may not look like another line or column."""
    return _BREAKING.sub(_spelled, plain(text))


def _spelled(found: re.Match[str]) -> str:
    return f"\\u{ord(found[0]):04x}"  # in JSON this is the same character


def _silent(_name: str, _state: str) -> None:
    return
