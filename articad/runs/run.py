"""Run: the directory with the request, the replies and the results of one run.

Only this module knows the names of its files. Every file is written beside its destination and renamed, so that a killed process leaves
complete files only; a file that exists is finished work, and a run that is opened again continues from there. Times are in `trace.jsonl`
and nowhere else, so that two runs with the same replies are equal byte for byte. Form: `docs/reference/run.md`.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import io
import itertools
import json
import math
import os
import re
import secrets
import shutil
import stat
import tempfile
import threading
import time
import unicodedata
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal, Self

from articad.aliases import Json
from articad.bounds import values_in
from articad.errors import ReadError, RunError, WriteError
from articad.files import PLAN_BYTES, RECORD_BYTES, SCRIPT_BYTES, read_file
from articad.findings import Finding
from articad.processes import scratch
from articad.runs.forms import misfit_of

try:
    import fcntl
except ImportError:  # pragma: no cover - Windows has no flock: a second process is not refused there
    fcntl = None  # type: ignore[assignment]

Event = Literal["stage", "call", "build", "finding", "artifact", "note"]

REQUEST_SCHEMA: Final = "articad.request/1"
PART_SCHEMA: Final = "articad.part/1"
DEFAULT_ROOT: Final = Path("runs")

REQUEST_FILE: Final = "request.json"
"""The file that makes a folder a run."""

_REQUIREMENTS, _PLAN, _ASSEMBLY, _CHECKS, _TRACE = (
    "requirements.json",
    "plan.json",
    "assembly.json",
    "checks.json",
    "trace.jsonl",
)
_ALTERNATIVES, _VERDICT, _ROUNDS = "alternatives.json", "verdict.json", "rounds"
_IMAGES, _PLANS, _PARTS, _REMOVED, _ATTEMPTS, _REPLIES, _SUPERSEDED, _EXPORT = (
    "images",
    "plans",
    "parts",
    "removed",
    "attempts",
    "llm",
    "llm/superseded",
    "export",
)
_SCRIPT, _BRIEF, _CONNECTORS, _PART, _STL = "script.py", "brief.json", "connectors.json", "part.json", "part.stl"
_OUTCOME, _PICTURE = "outcome.json", "partial.png"
_RECALLED = "recalled"
_BASE, _EDIT, _REVIEW = "base.json", "edit.json", "review.json"
_VIEWS, _MOTION, _PAGE = "views", "motion", "report.html"
_CERTIFICATE, _CERTIFIED = "certificate.json", "certificate"

_IMAGE_FILE = re.compile(rf"{_IMAGES}/[0-9]{{1,6}}\.(png|jpg|gif|webp)")
_SLUG_LENGTH = 40  # characters of the prompt in a run's name: enough to recognise it in a listing
_NAME_TRIES = 20  # random names to try before giving up; two equal ones have a chance of 1 in 65536
_IMAGE_LIMIT = 20 * 2**20  # bytes; no provider accepts larger ones
_IMAGES_LIMIT = 10 * _IMAGE_LIMIT  # of all pictures of a request together
_JSON_BYTES: Final = 64 << 20  # of one record; those of a product of 2,000 parts have a tenth
_JSON_VALUES: Final = 4_000_000  # of all records that one view of a run has read: each takes up to 80 bytes
_LINE_BYTES: Final = 1 << 20  # of one line of the trace
_LINES: Final = 1_000_000  # of the trace
_NAME_A_PICTURE = "Name a picture that is a file of yours, in PNG, JPEG, GIF or WebP."
_IMAGE_KINDS = {b"\x89PNG\r\n\x1a\n": ("image/png", "png"), b"\xff\xd8\xff": ("image/jpeg", "jpg"), b"GIF8": ("image/gif", "gif")}


def canonical_json(value: object) -> bytes:
    """Return the canonical form of a JSON value, from which digests are computed: sorted keys, no spaces, `repr` floats."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()


def digest(value: object) -> str:
    """Return the sha256 of a JSON value's canonical form, in hexadecimal."""
    return hashlib.sha256(canonical_json(value)).hexdigest()


@dataclass(frozen=True)
class UserImage:
    """A picture from the user: its unmodified bytes, and the part it belongs to, if only to one."""

    content: bytes = field(repr=False)
    media_type: str
    suffix: str
    part: str | None = None

    @classmethod
    def read(cls, source: str | Path | bytes, part: str | None = None, root: Path | None = None) -> Self:
        """Read a PNG, JPEG, GIF or WebP picture.

        Raises:
            ReadError: If it cannot be read, is not of these formats, or is larger than 20 MiB.
        """
        name = "an image" if isinstance(source, bytes) else str(source)
        try:
            content = source if isinstance(source, bytes) else read_file(source, _IMAGE_LIMIT, root=root)
        except OSError as error:
            raise _unreadable(name, f"Cannot read {name}: {error.strerror}.", _NAME_A_PICTURE) from error
        if len(content) > _IMAGE_LIMIT:
            message = f"{name} has {len(content) / 2**20:.0f} MiB; at most {_IMAGE_LIMIT // 2**20} are accepted."
            raise _unreadable(name, message, "Make the picture smaller: models see no more than some 2000 pixels across.")
        kinds = [kind for start, kind in _IMAGE_KINDS.items() if content.startswith(start)]
        if content[:4] == b"RIFF" and content[8:12] == b"WEBP":
            kinds = [("image/webp", "webp")]
        if not kinds:
            raise _unreadable(name, f"{name} is not a PNG, JPEG, GIF or WebP picture.", "Convert it to PNG.")
        return cls(content, *kinds[0], part=part)

    @property
    def sha256(self) -> str:
        """Digest of the bytes, in hexadecimal."""
        return hashlib.sha256(self.content).hexdigest()


@dataclass(frozen=True, kw_only=True)
class RunRequest:
    """The request of a run.

    Attributes:
        prompt: The user's words.
        images: The user's pictures, in order.
        options: Choices that determine the result, JSON values by name, without models, addresses or times.
    """

    prompt: str
    images: tuple[UserImage, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if (size := sum(len(image.content) for image in self.images)) > _IMAGES_LIMIT:
            told = f"The pictures have {size / 2**20:.0f} MiB together; at most {_IMAGES_LIMIT // 2**20} are accepted."
            raise _unreadable("images", told, "Send fewer or smaller pictures.")

    def to_json(self, version: str) -> Json:
        """Return `request.json`; `version` is that of articad."""
        images = [
            {"file": f"{_IMAGES}/{number}.{image.suffix}", "sha256": image.sha256} | ({"part": image.part} if image.part else {})
            for number, image in enumerate(self.images, 1)
        ]
        return {"schema": REQUEST_SCHEMA, "prompt": self.prompt, "images": images, "options": dict(self.options), "articad": version}

    def same_as(self, other: RunRequest) -> bool:
        """Whether both requests are equal, whatever the version of articad."""
        return self.to_json("") == other.to_json("")


class Run:
    """A run directory, opened for writing by one process at a time, or for reading by any number.

    Use `create`, `open` or `view`. As a context manager it releases its lock at the end.

    Attributes:
        path: The directory.
        request: The request.
    """

    def __init__(self, path: Path, request: RunRequest, lock: int | None) -> None:
        self.path = path
        self.request = request
        self._lock = lock
        self._tracing = threading.Lock()
        self._weights: dict[str, int] = {}  # values of the records that were read, by name

    # ------------------------------------------------------------------ opening

    @classmethod
    def create(cls, request: RunRequest, *, out: str | Path | None = None, version: str | None = None) -> Self:
        """Make a new run directory.

        Args:
            request: The request.
            out: The directory, new or empty; by default `runs/<date>-<words of the prompt>-<4 hex digits>`.
            version: Version of articad to record; this one's by default.

        Raises:
            RunError: If the directory is not empty.
            WriteError: If it cannot be written.
        """
        path = _new_directory(request.prompt) if out is None else Path(out)
        with _writing(path):
            path.mkdir(parents=True, exist_ok=True)
            strangers = _strangers(path)
        if strangers:
            raise _not_empty(path, strangers)
        _require_plain(path)
        run = cls(path, request, _locked(path))
        run._sweep()
        described = request.to_json(_version() if version is None else version)
        for image, entry in zip(request.images, described["images"], strict=True):
            run._write(entry["file"], image.content)
        run._write_json(REQUEST_FILE, described)  # last: a directory without it is not a run yet
        return run

    @classmethod
    def open(cls, path: str | Path) -> Self:
        """Open a run to continue it; incomplete files of a killed process are removed.

        Raises:
            RunError: If it is not a run, contains anything foreign to runs, or another process works in it.
        """
        path = Path(path)
        _require_plain(path)
        request = _read_request(path)
        run = cls(path, request, _locked(path))
        run._sweep()
        with _writing(path):
            trace = path / _TRACE
            if trace.exists() and (lines := read_file(trace, RECORD_BYTES, root=path)) and not lines.endswith(b"\n"):
                run._append(b"\n")
        return run

    @classmethod
    def view(cls, path: str | Path) -> Self:
        """Open a run for reading only; any number of processes may.

        Raises:
            RunError: If it is not a run, or contains anything foreign to runs.
        """
        _require_plain(Path(path))
        return cls(Path(path), _read_request(Path(path)), None)

    def close(self) -> None:
        """Release the lock; nothing can be written through this object any more."""
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Run {self.path}>"

    # ------------------------------------------------------------------ requests and replies

    @property
    def prompt(self) -> str:
        """The user's words."""
        return self.request.prompt

    @property
    def version(self) -> str:
        """Version of articad that made the run."""
        return str((self._read_json(REQUEST_FILE) or {}).get("articad", ""))

    def requirements(self) -> Json | None:
        """Return the analysis of the request, or None."""
        return self._read_json(_REQUIREMENTS, "requirements")

    def save_requirements(self, requirements: Json) -> None:
        """Save the analysis of the request."""
        self._write_json(_REQUIREMENTS, requirements)

    def alternatives(self) -> Json | None:
        """Return the report `articad.alternatives/1`, or None."""
        return self._read_json(_ALTERNATIVES, "alternatives")

    def save_alternatives(self, report: Json) -> None:
        """Save the alternatives for an open request, and the choice."""
        self._write_json(_ALTERNATIVES, report)

    def recalled(self, label: str) -> Json | None:
        """Return the text that was retrieved for a request from memory or documentation, or None."""
        return self._read_json(f"{_RECALLED}/{label}.json")

    def save_recalled(self, label: str, retrieved: Json) -> None:
        """Save the text that was retrieved for a request: it is part of the prompt."""
        self._write_json(f"{_RECALLED}/{label}.json", retrieved)

    def reply(self, step: str) -> Json | None:
        """Return the recorded request and reply of a step, or None."""
        return self._read_json(_reply_file(step))

    def replies(self) -> tuple[str, ...]:
        """Return the steps that have a reply."""
        return tuple(sorted(file.stem.replace(".", "/") for file in (self.path / _REPLIES).glob("*.json")))

    def talks(self) -> tuple[Json, ...]:
        """Return the recorded requests and replies of all steps, whole enough to be shown."""
        return tuple(record for step in self.replies() if (record := self._read_json(_reply_file(step), "reply")) is not None)

    def save_reply(self, step: str, record: Json) -> None:
        """Save a reply; an earlier one to a different request at the same step is moved aside, not lost."""
        old = self.reply(step)
        if old is not None and old != record:
            self._write_json(f"{_SUPERSEDED}/{Path(_reply_file(step)).stem}.{old['key'][:8]}.json", old)
        self._write_json(_reply_file(step), record)

    def base(self) -> Json | None:
        """Return the base of an edit, `articad.base/1`, or None."""
        return self._read_json(_BASE, "base")

    def save_base(self, base: Json) -> None:
        """Save the base of an edit, so that the run does not depend on another one."""
        self._write_json(_BASE, base)

    # ------------------------------------------------------------------ the plan

    def plan_text(self) -> str | None:
        """Return the current plan as JSON text, or None."""
        content = self._read(_PLAN, PLAN_BYTES)
        try:
            return None if content is None else content.decode()
        except UnicodeDecodeError as error:
            place = self.path / _PLAN
            hint = f"Save it as UTF-8, or copy the last version that is in {self.path / _PLANS} over it."
            raise _unreadable(str(place), f"{place} is not UTF-8: {error.reason}.", hint) from error

    def save_plan(self, text: str, version: int) -> None:
        """Save a version of the plan, counted from 0, and make it the current one."""
        self._write(f"{_PLANS}/{version}.json", text.encode())
        self._write(_PLAN, text.encode())

    # ------------------------------------------------------------------ the parts

    def part(self, name: str) -> Json | None:
        """Return `part.json` of a finished part, or None."""
        return self._read_json(f"{_PARTS}/{name}/{_PART}", "part")

    def script(self, name: str) -> bytes | None:
        """Return the script of a part, or None."""
        return self._read(f"{_PARTS}/{name}/{_SCRIPT}", SCRIPT_BYTES)

    def part_names(self) -> tuple[str, ...]:
        """Return the names of the finished parts."""
        return tuple(sorted(file.parent.name for file in (self.path / _PARTS).glob(f"*/{_PART}")))

    def part_files(self, name: str) -> dict[str, str]:
        """Return the sha256 of each file of a part by its name, except for pictures."""
        return {file.name: self._sha256(file) for file in sorted((self.path / _PARTS / name).iterdir()) if file.is_file()}

    def save_part(
        self,
        name: str,
        *,
        record: Json,
        brief: Json | None = None,
        script: bytes | None = None,
        connectors: Json | None = None,
        stl: bytes | None = None,
        files: Mapping[str, Path] | None = None,
    ) -> None:
        """Save a built part; `part.json` is written last, so that its existence means that the part is complete.

        Args:
            name: Name of the part.
            record: Digests, kernel, measurements, and for a derived part its source.
            brief: The input of the script.
            script: Its source.
            connectors: The connectors, and their distances from the plan's.
            stl: The mesh.
            files: The kernel's own files to copy, by name.
        """
        folder = f"{_PARTS}/{name}"
        record = {"schema": PART_SCHEMA} | record
        if self.part(name) is not None and self.part(name) != record:
            with _writing(self.path / folder):
                (self.path / folder / _PART).unlink()
        told = {file: _json(value) for file, value in ((_BRIEF, brief), (_CONNECTORS, connectors)) if value is not None}
        told |= {file: content for file, content in ((_SCRIPT, script), (_STL, stl)) if content is not None}
        self._write_all(folder, told | {file: source.read_bytes() for file, source in (files or {}).items()})
        self._write_json(f"{folder}/{_PART}", record)

    def remove_part(self, name: str) -> None:
        """Move a part that the plan no longer has aside."""
        source, target = self.path / _PARTS / name, self.path / _REMOVED / name
        self._require_lock()
        with _writing(target):
            target.parent.mkdir(exist_ok=True)
            if target.exists():
                shutil.rmtree(target)
            source.rename(target)

    def attempt(self, name: str, number: int) -> Json | None:
        """Return the outcome of an attempt at a part, or None."""
        return self._read_json(f"{_ATTEMPTS}/{name}-{number}/{_OUTCOME}", "attempt")

    def attempt_picture(self, name: str, number: int) -> bytes | None:
        """Return the picture of an attempt's result, or None."""
        return self._read(f"{_ATTEMPTS}/{name}-{number}/{_PICTURE}")

    def save_attempt(self, name: str, number: int, *, script: bytes, outcome: Json, picture: bytes | None = None) -> None:
        """Save a failed attempt at a part; its outcome is written last."""
        self._write(f"{_ATTEMPTS}/{name}-{number}/{_SCRIPT}", script)
        if picture is not None:
            self._write(f"{_ATTEMPTS}/{name}-{number}/{_PICTURE}", picture)
        self._write_json(f"{_ATTEMPTS}/{name}-{number}/{_OUTCOME}", outcome)

    # ------------------------------------------------------------------ the assembly

    def assembly(self) -> Json | None:
        """Return the assembly's report, or None."""
        return self._read_json(_ASSEMBLY, "assembly")

    def save_assembly(self, report: Json) -> None:
        """Save the assembly's report."""
        self._write_json(_ASSEMBLY, report)

    def checks(self) -> Json | None:
        """Return the report `articad.checks/1`, or None."""
        return self._read_json(_CHECKS, "checks")

    def save_checks(self, report: Json) -> None:
        """Save the report `articad.checks/1`."""
        self._write_json(_CHECKS, report)

    def verdict(self) -> Json | None:
        """Return the report `articad.verdict/1` of the last round, or None."""
        return self._read_json(_VERDICT, "verdict")

    def save_verdict(self, report: Json) -> None:
        """Save the report `articad.verdict/1`."""
        self._write_json(_VERDICT, report)

    def round(self, number: int) -> Json | None:
        """Return the findings of a round and what became of each part, or None."""
        return self._read_json(f"{_ROUNDS}/{number}.json")

    def save_round(self, number: int, report: Json) -> None:
        """Save the findings of a round and what became of each part."""
        self._write_json(f"{_ROUNDS}/{number}.json", report)

    def edit(self) -> Json | None:
        """Return the report of an edit on what has changed, `articad.edit/1`, or None."""
        return self._read_json(_EDIT, "edit")

    def save_edit(self, report: Json) -> None:
        """Save the report of an edit on what has changed."""
        self._write_json(_EDIT, report)

    def review(self) -> Json | None:
        """Return the report `articad.review/1`, or None."""
        return self._read_json(_REVIEW, "review")

    def save_review(self, report: Json) -> None:
        """Save the report `articad.review/1`."""
        self._write_json(_REVIEW, report)

    def certificate(self) -> Json | None:
        """Return the report `articad.certificate/2`, or None."""
        return self._read_json(_CERTIFICATE, "certificate")

    def save_certificate(self, report: Json, meshes: Mapping[str, bytes]) -> Path:
        """Save a certificate with its meshes, which a checker needs; return its file."""
        self._write_all(_CERTIFIED, meshes)
        self._write_json(_CERTIFICATE, report)
        return self.path / _CERTIFICATE

    def save_export(self, kind: str, files: Mapping[str, bytes], report: Json) -> Path:
        """Save an exported format and its losses; return its folder."""
        folder = Path(_EXPORT) / kind
        for name in files:
            if not (self.path / folder / name).resolve().is_relative_to((self.path / folder).resolve()):
                raise RunError.at(self.path, f"{name} is outside {folder}.", "Export into the folder itself.")
        self._write_all(str(folder), files)
        self._write_json(str(folder / "losses.json"), report)
        return self.path / folder

    def exports(self) -> dict[str, Json]:
        """Return the report of each export by its format, with the `folder` and the path of the `main` file."""
        reports = {}
        for file in sorted((self.path / _EXPORT).glob("*/losses.json")):
            report = self._read_json(str(file.relative_to(self.path)), "losses") or {}
            main = next(iter(report.get("files", {})), "")
            if Path(main).is_absolute() or ".." in Path(main).parts:
                message = f"{file} names a file outside its folder: {main[:100]!r}."
                raise _unreadable(str(file), message, f"Do not use {file.parent}: remove it, and export again.")
            reports[file.parent.name] = report | {"folder": str(file.parent), "main": str(file.parent / main)}
        return reports

    def save_views(self, part: str, pictures: Mapping[str, bytes]) -> None:
        """Save pictures of a part, as PNG by view."""
        for view, content in pictures.items():
            self._write(f"{_PARTS}/{part}/{_VIEWS}/{view}.png", content)

    def save_motion(self, joint: str, strip: bytes, animation: bytes) -> None:
        """Save the pictures of a joint's motion: a filmstrip as PNG and an animation as GIF."""
        self._write(f"{_MOTION}/{joint}.png", strip)
        self._write(f"{_MOTION}/{joint}.gif", animation)

    def save_page(self, text: str) -> Path:
        """Save the HTML page of the run; return its file."""
        self._write(_PAGE, text.encode())
        return self.path / _PAGE

    def results(self) -> tuple[str, ...]:
        """Return the paths, in the run, of the results for use elsewhere: plan, exports, and each part's CAD files and script."""
        wanted = [_PLAN, f"{_EXPORT}/*/*", *(f"{_PARTS}/*/{name}" for name in ("part.step", "part.FCStd", _STL, _SCRIPT))]
        found = (file for pattern in wanted for file in sorted(self.path.glob(pattern)) if file.is_file() and file.name != "losses.json")
        return tuple(file.relative_to(self.path).as_posix() for file in found)

    # ------------------------------------------------------------------ the trace

    def trace(self, event: Event, **fields: object) -> None:
        """Add a line to the trace; the only place where times are written."""
        line = json.dumps({"t": round(time.time(), 3), "event": event} | fields, ensure_ascii=False)
        self._append(line.encode() + b"\n")

    def trace_finding(self, finding: Finding) -> None:
        """Add a finding to the trace."""
        self.trace("finding", **finding.to_json())

    def events(self) -> Iterator[Json]:
        """Yield the trace's events; a line that a killed process left incomplete is skipped."""
        for line in itertools.islice(io.BytesIO(self._read(_TRACE) or b""), _LINES):
            with contextlib.suppress(ValueError, RecursionError):
                event = json.loads(line.decode(errors="replace")) if len(line) <= _LINE_BYTES else None
                if isinstance(event, dict):
                    yield event

    def hashes(self) -> dict[str, str]:
        """Return the sha256 of every file by its path in the run, except for the trace, and for pictures and page, which are derived."""
        found = (file for file in sorted(self.path.rglob("*")) if file.is_file() and file.name != _TRACE)
        found = (file for file in found if file.parent.name != _VIEWS and file.parent != self.path / _MOTION and file.name != _PAGE)
        return {file.relative_to(self.path).as_posix(): self._sha256(file) for file in found}

    # ------------------------------------------------------------------ reading and writing

    def _read(self, name: str, most: int = RECORD_BYTES) -> bytes | None:
        try:
            return read_file(self.path / name, most, root=self.path)
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise self._unreadable(name, f"Cannot read {self.path / name}: {error.strerror}.") from error

    def _sha256(self, file: Path) -> str:
        content = self._read(file.relative_to(self.path).as_posix())
        return hashlib.sha256(content or b"").hexdigest()

    def _unreadable(self, name: str, message: str) -> ReadError:
        """Return the error of a record of the run, with the command that writes it again if there is one."""
        folder = Path(name).parts[:2]
        if name == _CERTIFICATE:
            hint = f"Write it again: articad certify {self.path}"
        elif folder[0] == _EXPORT:
            hint = f"Remove {self.path.joinpath(*folder)}, and export again: articad export {self.path} --to {folder[-1]}"
        else:
            hint = f"Take an undamaged copy of {self.path}, or make the run again in a new folder with --out."
        return _unreadable(str(self.path / name), message, hint)

    def _read_json(self, name: str, form: str | None = None) -> Json | None:
        """Return a record, or None if there is none; `form` is its name in `FORMS`."""
        content = self._read(name, _JSON_BYTES)
        if content is None:
            return None
        place = self.path / name
        self._weights[name] = values_in(content)
        if sum(self._weights.values()) > _JSON_VALUES:
            raise self._unreadable(name, f"{place} and the records that were read before have more than {_JSON_VALUES} values.")
        try:
            value = json.loads(content, parse_constant=_no_number, parse_float=_finite)
        except (ValueError, RecursionError) as error:
            raise self._unreadable(name, f"{place} is not JSON: {error}.") from error
        if not isinstance(value, dict):
            raise self._unreadable(name, f"{place} is not a JSON object.")
        if form is not None and (wrong := misfit_of(value, form)):
            raise self._unreadable(name, f"{place} is no record of articad: {wrong} is missing or is something else.")
        return value

    def _write_json(self, name: str, value: Json) -> None:
        self._write(name, _json(value))

    def _write(self, name: str, content: bytes) -> None:
        self._require_lock()
        write_atomically(self.path / name, content)

    def _write_all(self, folder: str, files: Mapping[str, bytes]) -> None:
        """Write files into a folder of the run; faster than one after another."""
        self._require_lock()
        with _writing(self.path / folder):
            scratch.write_durably({self.path / folder / name: content for name, content in sorted(files.items())})

    def _append(self, line: bytes) -> None:
        self._require_lock()
        path = self.path / _TRACE
        with self._tracing, _writing(path):
            flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
            handle = os.open(path, flags, 0o666)  # a link or a pipe may have been put there since the run was opened
            try:
                os.write(handle, line)
            finally:
                os.close(handle)

    def _sweep(self) -> None:
        """Remove incomplete files of a killed process; called with the lock held."""
        with _writing(self.path):
            for leftover in list(self.path.rglob(f"{scratch.BESIDE}*")):
                shutil.rmtree(leftover) if leftover.is_dir() else leftover.unlink()

    def _require_lock(self) -> None:
        if self._lock is None:
            raise RunError.at(self.path, f"{self.path} is open for reading only.", "Open it with Run.open.")


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file so that any reader, also after a crash, finds either the old content or the new one, complete.

    Raises:
        WriteError: If the disk is full, the folder read-only and the like; the old file is intact.
    """
    with _writing(path):
        scratch.write_durably({path: content})


def open_or_create(request: RunRequest, out: str | Path | None) -> Run:
    """Open the run of this request at `out`, or make a new one.

    Raises:
        RunError: If `out` holds another request's run, or something else.
    """
    require_place(request, out)
    if out is None or not (Path(out) / REQUEST_FILE).exists():
        return Run.create(request, out=out)
    return Run.open(out)


def require_place(request: RunRequest, out: str | Path | None) -> None:
    """Refuse a directory in which `open_or_create` would fail, before any work is done; nothing is written.

    Raises:
        RunError: If `out` holds another request's run, or something else.
    """
    if out is None:
        return
    path = Path(out)
    if path.exists() and not path.is_dir():
        raise RunError.at(path, f"{path} is a file; a run is a directory.", "Name a new directory with --out.")
    if not (path / REQUEST_FILE).exists():
        if path.is_dir() and (strangers := _strangers(path)):
            raise _not_empty(path, strangers)
        _require_writable(path)
        return
    there = _read_request(path)
    if not there.same_as(request):
        task, own = there.options.get("task", "generate"), _words(there)
        repeat = f"repeat the command of the run: {own}" if own else f"resume it with `articad resume {path}`"
        message = f"{path} is a run of a different request, `articad {task}`{_difference(there, request)}."
        raise RunError.at(path, message, f"Name another directory with --out, or {repeat}.")


def require_idle(path: Path) -> None:
    """Check that no process works in a run, before it is removed.

    Raises:
        RunError: If one does.
        WriteError: If the folder cannot be opened.
    """
    os.close(_locked(path))


def _require_writable(path: Path) -> None:
    """Check that a directory can be made: make it and remove it again, with any new parents.

    Raises:
        WriteError: If it cannot be made.
    """
    missing = [folder for folder in (path, *path.parents) if not folder.exists()]
    try:
        with _writing(path):
            path.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=path).close()
    finally:
        for folder in missing:
            with contextlib.suppress(OSError):
                folder.rmdir()


def _strangers(path: Path) -> list[str]:
    """Return what is in the directory of a new run."""
    return sorted(entry.name for entry in path.iterdir() if entry.name != _IMAGES and not entry.name.startswith(scratch.BESIDE))


def _not_empty(path: Path, strangers: Sequence[str]) -> RunError:
    return RunError.at(path, f"{path} is not empty: it holds {strangers[0]}.", "Name a new directory with --out, or empty this one.")


def _difference(there: RunRequest, wanted: RunRequest) -> str:
    """Return the words or options in which two requests differ."""
    if there.prompt != wanted.prompt:
        return f" for {there.prompt[:_SLUG_LENGTH]!r}"
    keys = [key for key in dict.fromkeys((*there.options, *wanted.options)) if there.options.get(key) != wanted.options.get(key)]
    return f" with different {', '.join(keys)}" if keys else " with other pictures"


def _words(request: RunRequest) -> str:
    """Return the flags of the same build; empty for runs of models."""
    if request.options.get("task") != "build":
        return ""
    parameters = request.options.get("parameters") or {}
    flags = [f"--set {name}={value!r}" for name, value in parameters.items()]
    return " ".join([f"`articad build` of the plan {request.prompt!r}", *(["with", *flags] if flags else ["without --set"])])


def differences(first: Run, second: Run) -> Sequence[str]:
    """Return the paths of the files, except for the trace, that are not equal in both runs."""
    ours, theirs = first.hashes(), second.hashes()
    return sorted(name for name in ours.keys() | theirs.keys() if ours.get(name) != theirs.get(name))


def _reply_file(step: str) -> str:
    return f"{_REPLIES}/{step.replace('/', '.')}.json"


def _new_directory(prompt: str) -> Path:
    ascii_text = unicodedata.normalize("NFKD", prompt).encode("ascii", "ignore").decode().lower()
    slug = re.sub(r"[^a-z0-9]+", "-", ascii_text)[:_SLUG_LENGTH].strip("-") or "run"
    day = time.strftime("%Y-%m-%d")
    if DEFAULT_ROOT.is_symlink():
        raise RunError.at(
            DEFAULT_ROOT, f"A link is in the place of {DEFAULT_ROOT}, to which runs are written by default.", "Name a directory with --out."
        )
    for _ in range(_NAME_TRIES):
        path = DEFAULT_ROOT / f"{day}-{slug}-{secrets.token_hex(2)}"
        if not path.exists():
            return path
    raise RunError.at(DEFAULT_ROOT, f"No free name for a run in {DEFAULT_ROOT}.", "Name a directory with --out.")


def _require_plain(path: Path) -> None:
    """Refuse anything but files and folders in a run: an untrusted run may have links that lead writes out of it, and pipes that block.

    Raises:
        RunError: If it contains anything else.
    """
    waiting = [path] if path.is_dir() else []
    while waiting:
        folder = waiting.pop()
        try:
            entries = list(folder.iterdir())
        except FileNotFoundError:  # another process works in it, and has just renamed this
            continue
        except OSError as error:
            hint = f"Allow yourself to read it, or copy the run to where you may: chmod -R u+rX {path}"
            raise _unreadable(str(folder), f"Cannot read {folder}: {error.strerror}.", hint) from error
        for entry in entries:
            with contextlib.suppress(FileNotFoundError):  # as above
                mode = entry.lstat().st_mode
                if stat.S_ISDIR(mode):
                    waiting.append(entry)
                elif not stat.S_ISREG(mode):
                    message = f"{entry} is neither a file nor a folder; a run holds nothing else."
                    raise RunError.at(path, message, f"Do not use this run, or remove {entry}.")


def _read_request(path: Path) -> RunRequest:
    run = Run(path, RunRequest(prompt=""), None)
    stored = run._read_json(REQUEST_FILE)  # noqa: SLF001 - the same class, before initialisation
    if stored is None or stored.get("schema") != REQUEST_SCHEMA:
        hint = "Name the folder of a run, which `articad build PLAN_DIR --out RUN` or `articad generate` makes."
        if (path / _PLAN).is_file() and stored is None:
            hint = f"It is a plan: build it first, by `articad build {path} --out RUN`, and name that run."
        raise RunError.at(path, f"{path} is not a run: it has no {REQUEST_FILE} of the form {REQUEST_SCHEMA}.", hint)
    if wrong := misfit_of(stored, "request"):
        raise RunError.at(
            path,
            f"{path / REQUEST_FILE} is incomplete: {wrong} is missing or is something else.",
            f"Take an undamaged copy of {path}, or name another run.",
        )
    counts = Counter(image["file"] for image in stored["images"])
    for name, count in counts.items():  # an untrusted run may name any file, and its pictures are sent to a model
        if not _IMAGE_FILE.fullmatch(name) or count > 1:
            why = "which is not in the run" if count == 1 else f"{count} times"
            raise RunError.at(
                path,
                f"{path / REQUEST_FILE} names the picture {name[:100]!r}, {why}.",
                "Do not use this run: somebody changed it. Make it again in a new folder with --out.",
            )
    images, left = list[UserImage](), _IMAGES_LIMIT
    for image in stored["images"]:
        images.append(UserImage.read(path / image["file"], image.get("part"), path))
        left -= len(images[-1].content)
        if left < 0:
            break  # the request refuses them
    return RunRequest(prompt=stored["prompt"], images=tuple(images), options=stored["options"])


def _locked(path: Path) -> int:
    with _writing(path):
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_DIRECTORY", 0))
    if fcntl is not None:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            os.close(handle)
            raise RunError.at(path, f"Another process uses {path}.", "Wait for it to end, or name another directory.") from error
        except OSError:  # pragma: no cover - a file system without locks: better unguarded than unusable
            pass
    return handle


@contextlib.contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Convert errors of the file system to `WriteError`."""
    try:
        yield
    except OSError as error:
        reason = {errno.ENOSPC: "the disk is full", errno.EDQUOT: "the quota is used up", errno.EROFS: "the file system is read-only"}
        why = reason.get(error.errno or 0, error.strerror or str(error))
        inner = isinstance(error.filename, str) and Path(error.filename).is_relative_to(path)
        place = str(error.filename if inner and not Path(error.filename).name.startswith(scratch.BESIDE) else path)
        message = f"Cannot write {place}: {why}."
        finding = Finding(
            code="E_WRITE", where=place, message=message, hint="Correct this and give the same command again: finished work is kept."
        )
        raise WriteError(message, path=place, findings=[finding]) from error


def _json(value: Json) -> bytes:
    return (json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()


def _no_number(constant: str) -> None:
    raise ValueError(f"{constant} is not a JSON number")


def _finite(digits: str) -> float:
    """Return a number; one beyond the range of 64-bit numbers, such as 1e999, would be read as infinite and could not be written again."""
    value = float(digits)
    if math.isinf(value):
        raise ValueError(f"{digits[:24]} is beyond the range of 64-bit numbers")
    return value


def _unreadable(name: str, message: str, hint: str) -> ReadError:
    finding = Finding(code="E_READ", where=name, message=message, hint=hint)
    return ReadError(message, path=name, findings=[finding])


def _version() -> str:
    from articad import __version__  # noqa: PLC0415 - the package's own version, without a cycle at import

    return __version__
