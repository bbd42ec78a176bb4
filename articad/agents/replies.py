"""Reading replies: the JSON object or the script that a model was asked for, out of what it said."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any, Final

from articad.errors import OutputError
from articad.findings import Finding
from articad.plan.reading import MOST_LEVELS, is_nested_deeper

_FENCED: Final = re.compile(r"^[ \t]*```[ \t]*([\w+-]*)[^\n]*\n(.*?)^[ \t]*```[ \t]*$", re.DOTALL | re.MULTILINE)
_OPEN_FENCE: Final = re.compile(r"\A\s*```[ \t]*[\w+-]*[^\n]*\n")
_SHOWN = 60  # characters of a reply that an error quotes
_TOO_DEEP: Final = f"it is nested deeper than {MOST_LEVELS} levels"


def object_text(text: str, *, step: str) -> str:
    """Return the text of the JSON object of a reply, without the Markdown fence or the words around it.

    Raises:
        OutputError: `E_REPLY_SCHEMA`, saying at which line and column the text is not JSON.
    """
    first_problem: ValueError | None = None
    for candidate in _candidates(text):
        try:
            value = json.loads(candidate)
        except (ValueError, RecursionError) as error:
            first_problem = first_problem or (error if isinstance(error, ValueError) else ValueError(_TOO_DEEP))
            continue
        if is_nested_deeper(value, MOST_LEVELS):
            first_problem = first_problem or ValueError(_TOO_DEEP)
        elif isinstance(value, dict):
            return candidate
        else:
            first_problem = first_problem or ValueError(f"it is a JSON {_kind(value)}, not an object")
    raise unusable(f"it is not one JSON object: {first_problem}.", text, step=step)


def parse_object(text: str, *, step: str) -> dict[str, Any]:
    """Return the JSON object of a reply.

    Raises:
        OutputError: As `object_text`.
    """
    document: dict[str, Any] = json.loads(object_text(text, step=step))
    return document


def parse_script(text: str, *, step: str) -> bytes:
    """Return the Python source of a reply: its fenced block that defines `build`, or all of it when there is no fence.

    Raises:
        OutputError: `E_REPLY_SCHEMA`, if there is none.
    """
    blocks = [block for language, block in _FENCED.findall(text) if language.lower() in {"", "python", "py", "python3"}]
    if not blocks:
        blocks = [_OPEN_FENCE.sub("", text)]  # no fence, or one that was never closed
    defining = [block for block in blocks if re.search(r"^def build\(", block, re.MULTILINE)]
    if not defining:
        raise unusable("it has no ```python block that defines build(part).", text, step=step)
    script: str = defining[-1]
    return (script.strip("\n") + "\n").encode()


def unusable(problem: str, raw: str, *, step: str, findings: Iterable[Finding] = ()) -> OutputError:
    """Return the error of a reply that cannot be used."""
    start = " ".join(raw.split())[:_SHOWN]
    finding = Finding(
        code="E_REPLY_SCHEMA",
        where=f"llm.{step}",
        message=f"The reply to {step!r} cannot be used: {problem}",
        hint=f"It begins: {start!r}.",
    )
    return OutputError(problem, raw=raw, findings=[finding, *findings])


def _candidates(text: str) -> Iterable[str]:
    yield text
    yield from (block for _, block in _FENCED.findall(text))
    start, end = text.find("{"), text.rfind("}")
    if 0 <= start < end:
        yield text[start : end + 1]


def _kind(value: Any) -> str:
    return {list: "list", str: "string", bool: "truth value", type(None): "null"}.get(type(value), "number")
