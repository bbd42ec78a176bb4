"""The workbench: the folder with a coding agent's designs, and the commands that work on them.

A design is a folder with `plan.json` and `parts/`; building it leaves a run directory `run/` in it, so that everything can
be built, checked and shown again without this server. Each piece of work is a process of its own, which can be cancelled, cannot
take the server down with it, and obeys the same sandbox and exit codes as the command line.
"""

from __future__ import annotations

import asyncio
import json
import re
from collections.abc import Awaitable, Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from articad.aliases import Json
from articad.errors import ReadError
from articad.files import RECORD_BYTES, ROOT_VARIABLE, is_file, read_file
from articad.plan.amending import amended
from articad.plan.reading import MOST_LEVELS, is_nested_deeper
from articad.plan.short import expanded, functions_of, is_short
from articad.plan.short_texts import opened
from articad.plan.signatures import COMMON
from articad.processes import launcher, scratch
from articad.runs.run import write_atomically
from articad.texts import SPOILED, spoiled

Tell = Callable[[float, str], Awaitable[None]]
"""Called with the elapsed seconds and the current step."""

PLAN_BYTES: Final = 2_000_000  # ten times the largest example
SCRIPT_BYTES: Final = 200_000
BRIEF_BYTES: Final = 6_000  # of an answer without details: a page of text
FULL_BYTES: Final = 60_000
SHOWN_FINDINGS: Final = 12
_FILE_BYTES: Final = 2**32  # of each file that a command writes
_PAGE_BYTES: Final = 64_000_000
_PAGE_S: Final = 300.0
_TOLD_EVERY_S: Final = 2.0
_END_S: Final = 5.0  # for a command that was killed to end; it takes milliseconds
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,59}\Z")
_FINDING_KEYS: Final = ("code", "where", "message", "hint", "route", "cause")


class Workbench:
    """Designs under one root, and nothing outside it.

    Args:
        root: The folder; made if it is not there.
    """

    def __init__(self, root: str | Path) -> None:
        self.root = Path(root).resolve()
        self.root.mkdir(parents=True, exist_ok=True)

    # ------------------------------------------------------------------ files

    def path(self, name: str) -> Path:
        """Return a file or folder under the root.

        Raises:
            ReadError: If the name leads out of it, also by links.
        """
        path = self.root if "\0" in name else (self.root / name).resolve()  # resolve raises ValueError for a zero byte
        if "\0" in name or not path.is_relative_to(self.root):
            raise ReadError.at(name, f"{name} is outside the root.", "Name a file under it, relative to it.")
        return path

    def read(self, name: str) -> bytes:
        """Return the content of a file under the root.

        Raises:
            ReadError: If it is missing, is not a regular file, is too large, or a link leads to it.
        """
        try:
            return read_file(self.root / name, RECORD_BYTES, root=self.root)
        except OSError as error:
            raise ReadError.at(
                name, f"{name} cannot be read: {error.strerror}.", "Name a file under the root that is not a link."
            ) from None

    def design(self, name: str, *, new: bool = False) -> Path:
        """Return the folder of a design.

        Raises:
            ReadError: If the name is not valid, or there is no such design and it is not `new`.
        """
        if not _NAME.match(name):
            raise ReadError.at(name, f"{name!r} is not a valid name of a design.", "Use letters, digits, - and _, at most 60.")
        folder = self.path(name)
        if folder != self.root / name:
            raise ReadError.at(name, f"The design {name!r} is a link.", "Copy the folder to the root.")
        if not new and not is_file(folder / "plan.json", root=self.root):
            known = sorted(file.parent.name for file in self.root.glob("*/plan.json") if is_file(file, root=self.root))
            raise ReadError.at(name, f"There is no design {name!r}; there are {', '.join(known) or 'none'}.", "Start one with check_plan.")
        return folder

    def write_plan(self, name: str, plan: Mapping[str, Any]) -> Path:
        """Save a plan as the current one of a design.

        Raises:
            ReadError: If it is too large or too deep, or holds characters or numbers that no file should.
        """
        if is_nested_deeper(plan, MOST_LEVELS):
            raise ReadError.at(name, f"The plan would be nested deeper than {MOST_LEVELS} levels.", "A plan has about ten.")
        if spoiled(plan) is not None:
            raise ReadError.at(name, f"The plan holds {SPOILED}.", "Write it without them.")
        try:
            content = (json.dumps(plan, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()
        except ValueError:  # also a whole number of thousands of digits
            raise ReadError.at(name, "The plan holds a number that is not finite or has thousands of digits.", "Give numbers.") from None
        if len(content) > PLAN_BYTES:
            raise ReadError.at(name, f"The plan has {len(content)} bytes; at most {PLAN_BYTES} are accepted.", "Use derived parts.")
        file = self.design(name, new=True) / "plan.json"
        write_atomically(file, content)
        return file

    def plan(self, name: str) -> dict[str, Any]:
        """Return the plan of a design in its long form, which need not be valid.

        Raises:
            ReadError: If it is not a JSON object with lists of objects.
        """
        return self._expanded(name, self.document(name))

    def document(self, name: str) -> dict[str, Any]:
        """Return the JSON object in a design's plan; nobody has checked it.

        Raises:
            ReadError: If it is not one.
        """
        self.design(name)
        try:
            document = json.loads(self.read(f"{name}/plan.json"))
        except (ValueError, RecursionError) as error:  # ValueError: neither JSON nor UTF-8
            reason = "it is nested too deeply" if isinstance(error, RecursionError) else str(error)
            raise ReadError.at(name, f"The plan of {name!r} cannot be read: {reason}.", "Give the whole plan.") from error
        if not isinstance(document, dict) or is_nested_deeper(document, MOST_LEVELS):
            raise ReadError.at(name, f"The plan of {name!r} is not a JSON object.", "Give the whole plan.")
        return document

    def _expanded(self, name: str, document: dict[str, Any]) -> dict[str, Any]:
        plan: dict[str, Any] = expanded(document, functions_of(document, self.design(name) / "plan.json"))
        for key in ("parameters", "parts", "joints"):
            rows = plan.get(key, [])
            if not isinstance(rows, list) or not all(isinstance(row, dict) and isinstance(row.get("name"), str) for row in rows):
                raise ReadError.at(name, f"{key} of the plan of {name!r} is not a list of objects with names.", "Run check_plan.")
        return plan

    def amend_plan(self, name: str, changes: Mapping[str, Any]) -> Path:
        """Replace values of a design's plan, by address.

        Raises:
            ReadError: If there is nothing at an address, or the plan is not JSON; it is not changed then.
        """
        plan = self.document(name)
        try:
            return self.write_plan(name, amended(opened(plan, changes) if is_short(plan) else plan, changes))
        except ReadError:
            if not is_short(plan):
                raise
        return self.write_plan(name, amended(self._expanded(name, plan), changes))  # at an address that only the long form has

    def write_common_script(self, design: str, script: str) -> Path:
        """Save the script of all parts of a design that have none of their own.

        Raises:
            ReadError: If it is too large, or the design has a link in its place.
        """
        return self._write_script(self.design(design) / COMMON, script)

    def write_script(self, design: str, part: str, script: str, kernel: str | None = None) -> Path:
        """Save a part's script for a kernel, by default the plan's.

        Raises:
            ReadError: If it is too large, or the part's name is not valid.
        """
        kernel = kernel or self.document(design).get("kernel")
        return self._write_script(
            self.design(design) / "parts" / f"{self.part(part)}{'.freecad.py' if kernel == 'freecad' else '.py'}", script
        )

    def _write_script(self, file: Path, script: str) -> Path:
        content = script.encode()
        if len(content) > SCRIPT_BYTES:
            raise ReadError.at(file.name, f"The script has {len(content)} bytes; at most {SCRIPT_BYTES} are accepted.", "Write it shorter.")
        if file.parent.is_symlink() or file.is_symlink():
            raise ReadError.at(file.name, f"{file} is a link, or lies in a linked folder.", "Remove the link.")
        write_atomically(file, content)
        return file

    def part(self, name: str) -> str:
        """Return the name of a part.

        Raises:
            ReadError: If it is not valid.
        """
        if not _NAME.match(name):
            raise ReadError.at(name, f"{name!r} is not a valid name of a part.", "Use the name that the plan gives it.")
        return name

    def parts(self, design: str) -> list[str]:
        """Return the names of a design's parts that need a script, as far as the plan can be read."""
        try:
            return [part["name"] for part in self.plan(design).get("parts", ()) if "derive" not in part]
        except ReadError:
            return []

    def target(self, name: str) -> Path:
        """Return the path for a name: the run of a design if it was built, else the design, else a file under the root."""
        path = self.path(name)
        if is_file(path / "run" / "request.json", root=self.root):
            return path / "run"
        if not path.exists():
            raise ReadError.at(name, f"There is no {name} under the root.", "Name a design, or a file relative to the root.")
        return path

    # ------------------------------------------------------------------ work

    async def page(self, design: str) -> str:
        """Return the page of a built design: its model with a slider for each driver, checks and files.

        Raises:
            ReadError: If there is no such design.
        """
        self.design(design)
        with scratch.folder("page") as folder:
            file = Path(folder) / "page.html"
            await self.run("show", "--no-browser", f"--out={file}", on=[str(self.target(design))], seconds=_PAGE_S)
            return read_file(file, _PAGE_BYTES).decode()

    async def run(self, command: str, *arguments: str, on: Sequence[str] = (), seconds: float, tell: Tell | None = None) -> Json:
        """Run a command of `articad` and return its report.

        Args:
            command: Its name.
            arguments: Its options, each with its value in one word: `--joints=lid`.
            on: What it works on: files, folders and names, none of which it takes for an option.
            seconds: Time after which it is killed.
            tell: Called from time to time while it runs.

        Raises:
            ReadError: If it takes too long or leaves no report.
        """
        child = launcher.start(
            [command, *arguments, "--json", *(["--", *on] if on else [])],
            module="articad.cli",
            limits=launcher.Limits(seconds=seconds, file_size=_FILE_BYTES),
            environment=launcher.environment(*launcher.OWN) | {ROOT_VARIABLE: str(self.root)},
        )
        try:
            ended = await self._finished(child, command, tell)
        finally:  # if cancelled, kill the command and all that it started; the thread that waits for it does the rest
            child.kill()
            child.wait(_END_S)  # then it writes nothing any more, and has left the run
        if ended.late:
            message = f"`articad {command}` was ended after {seconds:.0f} s."
            raise ReadError.at(command, message, "Ask for less at once, or for more seconds.")
        try:
            return dict(json.loads(ended.out))
        except ValueError as error:
            last = ended.err.decode(errors="replace").strip()[-400:]
            raise ReadError.at(command, f"`articad {command}` left no report: {last}", "Try it with fewer parts.") from error

    async def _finished(self, child: launcher.Child, command: str, tell: Tell | None) -> launcher.Ended:
        """Wait in a thread for the end of a command, and report from time to time that it is running."""
        work = asyncio.ensure_future(asyncio.to_thread(child.finish))
        waited = 0.0
        if tell is not None:
            await tell(waited, f"{command}: started")
        while True:
            done, _ = await asyncio.wait([work], timeout=_TOLD_EVERY_S)
            if done:
                return work.result()
            waited += _TOLD_EVERY_S
            if tell is not None:
                await tell(waited, f"{command}: {waited:.0f} s")


def condensed(report: Json, *, detail: bool, keep: Sequence[str] = ()) -> Json:
    """Return a report for an agent: the verdict, the most important findings, then what was requested.

    Args:
        report: Report of a command.
        detail: Everything, up to 60 kB.
        keep: Keys of the report to return also without detail.
    """
    findings = gathered(report)
    shown = [{key: finding[key] for key in _FINDING_KEYS if finding.get(key) is not None} for finding in findings]
    answer: Json = {"ok": bool(report.get("ok"))}
    if error := report.get("error"):
        answer["error"] = error.get("message", error) if isinstance(error, dict) else error
    limit = len(shown) if detail else SHOWN_FINDINGS
    if shown or not answer["ok"]:
        answer["findings"] = shown[:limit]
    if len(shown) > limit:
        answer["more_findings"] = f"{len(shown) - limit} more; ask with detail"
    rest = {key: value for key, value in report.items() if key not in {"ok", "findings", "error", "schema"}}
    answer |= rest if detail else {key: rest[key] for key in keep if key in rest}
    return _fitted(answer, FULL_BYTES if detail else BRIEF_BYTES)


def gathered(report: Json) -> list[Json]:
    """Return all findings of a report and of the reports within it, errors first, each once."""
    found: dict[str, Json] = {}
    for holder in (report, *(value for value in report.values() if isinstance(value, dict))):
        for finding in holder.get("findings") or ():
            if isinstance(finding, dict):
                found.setdefault(json.dumps(finding, sort_keys=True), finding)
    rank = {"error": 0, "warning": 1}
    return sorted(found.values(), key=lambda finding: rank.get(str(finding.get("severity")), 2))


def _fitted(answer: Json, limit: int) -> Json:
    """Shorten an answer to a number of bytes, and say so: whole findings and entries are dropped, the last ones first, then texts are cut."""
    while len(json.dumps(answer, ensure_ascii=False).encode()) > limit:
        lists = [key for key, value in answer.items() if isinstance(value, list) and len(value) > 1]
        if lists:
            longest = max(lists, key=lambda key: len(json.dumps(answer[key])))
            answer[longest] = answer[longest][: len(answer[longest]) // 2]
        else:
            largest = max((key for key in answer if key not in {"ok", "truncated"}), key=lambda key: len(json.dumps(answer[key])))
            shorter = _shortened(answer[largest])
            if shorter == answer[largest]:
                break
            answer[largest] = shorter
        answer["truncated"] = f"cut to {limit} bytes; the whole report is in the design's run"
    return answer


def _shortened(value: Any) -> Any:
    """Return an only finding with half of its longest text, of other values half of their JSON; unchanged if that is short."""
    if isinstance(value, list) and len(value) == 1 and isinstance(value[0], dict):
        texts = {key: text for key, text in value[0].items() if isinstance(text, str) and len(text) > _LEAST}
        if texts:
            longest = max(texts, key=lambda key: len(texts[key]))
            return [value[0] | {longest: _shortened(texts[longest])}]
    text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
    return text[: max(len(text) // 2, _LEAST)] if len(text) > _LEAST else value


_LEAST: Final = 200  # characters of a shortened entry
