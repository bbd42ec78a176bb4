"""Why a script left no shape: the code, the line, and the script's own frames, so that its author can correct it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, TypeGuard

from articad.errors import BuildError, SandboxError
from articad.findings import Finding
from articad.kernels.sandbox import HOW_TO_GET, ScriptLimits
from articad.kernels.timers import OUT_OF_TIME
from articad.kernels.zygote import JobOutcome, ends_by

MEMORY_SHARE = 0.5  # a crash of a process that used this share of its limit is ascribed to lack of memory
_PATH = re.compile(r"(?:/[\w.+@~-]+)+/([\w.+@~-]+)")
_ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+|0x[0-9a-fA-F]{6,}")
_CRASH_FRAME = re.compile(r'File "part\.py", line (\d{1,6}) in (\w{1,80}|<module>)')
_END_OF_LINE = re.compile(r"\r\n?|\n")  # as Python counts lines; str.splitlines splits at more characters
_LINE = 500  # characters of a script's line that are shown
_MEMORY_TYPES = ("MemoryError", "Standard_OutOfMemory")

Json = Mapping[str, Any]
Frames = list[tuple[int, str]]


def script_failure(part: str, script: str, report: Sequence[Json], outcome: JobOutcome, crash: str, limits: ScriptLimits) -> BuildError:
    """Return the error of a script that left no shape.

    Args:
        part: Name of the part.
        script: Its source, for the lines of the traceback.
        report: Report of the script's process; untrusted.
        outcome: How that process ended.
        crash: Its output when a signal ended it.
        limits: The limits of its resources.
    """
    said = report[0] if report else {}
    if isinstance(said.get("problems"), list):
        return _no_build(part, script, [scrubbed(problem) for problem in said["problems"][:20]])
    if isinstance(said.get("error"), dict):
        return _raised(part, script, said["error"])
    return _died(part, script, outcome, crash, limits)


def unconfined(why: str) -> SandboxError:
    """Return the error for a process that ended because the sandbox could not be set up; no line of a script ran."""
    finding = Finding(code="E_SANDBOX", where="sandbox", message=f"The sandbox could not be set up: {scrubbed(why)}.", hint=HOW_TO_GET)
    return SandboxError(f"{finding.message} {HOW_TO_GET}.", findings=[finding])


def poisoned(part: str, script: str, what: str) -> BuildError:
    """Return the error for a script whose process left results that no honest run leaves."""
    return _error("E_SCRIPT_FORBIDDEN", part, script, f"The script tampered with its results: {scrubbed(what)}", _ALONE, [])


def scrubbed(text: object, limit: int = 500) -> str:
    """Return untrusted text without paths, addresses and control characters, and shortened."""
    return _ADDRESS.sub("", _PATH.sub(r"\1", _printable(str(text)[: 4 * limit])))[:limit].strip()


def _printable(text: str) -> str:
    return "".join(character if character.isprintable() else " " for character in text)


_ALONE = "A script may only compute a shape: no files, network, processes, or articad itself."


def _died(part: str, script: str, outcome: JobOutcome, crash: str, limits: ScriptLimits) -> BuildError:
    """Return the error of a script whose process ended before it could report anything."""
    frames: Frames = [(int(line), function) for line, function in reversed(_CRASH_FRAME.findall(crash)[:20])]
    name = ends_by(outcome)
    if outcome.late or name in OUT_OF_TIME or (name == "SIGKILL" and outcome.cpu > limits.seconds):  # the last if it defies its timers
        message = f"The script ran longer than {limits.seconds:.6g} s"
        hint = "Look for an endless loop, or for a boolean operation with very many faces."
        return _error("E_SCRIPT_TIMEOUT", part, script, message, hint, frames, limit=limits.seconds, unit="s")
    starved = crash.startswith("worker: MemoryError") or name == "SIGKILL" or (name and outcome.peak > MEMORY_SHARE * limits.memory)
    if starved:
        return _memory(part, script, frames, limits)
    if name == "SIGSYS":
        return _error("E_SCRIPT_FORBIDDEN", part, script, "The script made a system call that the sandbox forbids", _ALONE, frames)
    if name:
        hint = "Replace the operation at this line; fillets and offsets larger than the geometry allows are the usual cause."
        return _error("E_SCRIPT_ERROR", part, script, f"The kernel crashed ({name})", hint, frames)
    return _error("E_SCRIPT_ERROR", part, script, "The script ended its process itself", "Return from build(part).", frames)


def _raised(part: str, script: str, error: Json) -> BuildError:
    kind, message = scrubbed(error.get("type"), 80), scrubbed(error.get("message"))
    frames = _frames(error.get("frames"))
    line = error.get("line")
    if _is_line(line) and (not frames or frames[-1][0] != line):
        frames.append((line, "<module>"))
    what = f"{kind}: {message}" if message else kind
    module = str(error.get("module") or "")
    if kind in _MEMORY_TYPES or "bad_alloc" in message:
        return _memory(part, script, frames, None)
    if error.get("denied") is True or module.partition(".")[0] == "articad":
        return _error(
            "E_SCRIPT_FORBIDDEN", part, script, f"The script did something that a part script must not do: {what}", _ALONE, frames
        )
    return _error("E_SCRIPT_ERROR", part, script, what, "Correct this line." if frames else "Correct the script or its dimensions.", frames)


def _no_build(part: str, script: str, problems: list[str]) -> BuildError:
    hint = "Define build(part) and return (shape, {name: {'o': …, 'z': …, 'x': …}})."
    findings = [Finding(code="E_NO_BUILD", where=f"parts.{part}", parts=(part,), message=_sentence(text), hint=hint) for text in problems]
    return BuildError("\n".join(map(str, findings)), script=script, findings=findings, parts=(part,))


def _memory(part: str, script: str, frames: Frames, limits: ScriptLimits | None) -> BuildError:
    bound = "" if limits is None else f" of {limits.memory / 2**30:.3g} GiB"
    hint = "Use fewer copies and coarser features; fuse as you go instead of collecting."
    return _error("E_SCRIPT_MEMORY", part, script, f"The script needed more than its memory{bound}", hint, frames)


def _error(code: str, part: str, script: str, message: str, hint: str, frames: Frames, **measured: Any) -> BuildError:
    lines = [_printable(text[:_LINE]).strip() for text in _END_OF_LINE.split(script)]
    line = frames[-1][0] if frames else None
    source = lines[line - 1] if line is not None and 0 < line <= len(lines) else ""
    at = f" At line {line}{f': `{source[:120]}`' if source else ''}." if line is not None else ""
    finding = Finding(code=code, where=f"parts.{part}", parts=(part,), message=_sentence(message) + at, hint=hint, **measured)
    shown = [f"line {number}, in {function}: {lines[number - 1]}" for number, function in frames if 0 < number <= len(lines)]
    return BuildError(str(finding), script=script, line=line, traceback="\n".join(shown), findings=[finding], parts=(part,))


def _frames(value: object) -> Frames:
    """Return the frames that a script's process reported, without anything that is not a frame."""
    frames: Frames = []
    for entry in value if isinstance(value, list) else ():
        if isinstance(entry, list) and len(entry) == 2 and _is_line(entry[0]):
            frames.append((entry[0], scrubbed(entry[1], 80)))
    return frames[-20:]


def _is_line(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool) and 0 < value < 10**6


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}".rstrip(".") + "."
