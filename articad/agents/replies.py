"""Replies of models: parsed, validated against a form, and asked for again until one is valid."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from articad.agents.llm import LLM, Message, Request, assistant, user
from articad.agents.prompts import prompt
from articad.errors import OutputError
from articad.findings import Finding
from articad.plan.reading import MOST_LEVELS, is_nested_deeper

TRIES: Final = 3  # a model that fails three times does not find the form
_FENCE: Final = re.compile(r"^[ \t]*```[ \t]*([\w+-]*)([^\n]*)$", re.MULTILINE)
_OPEN_FENCE: Final = re.compile(r"\A\s*```[^\n]*\n")
_SHOWN = 60  # characters of a reply that an error quotes
_OBJECTION_CHARACTERS: Final = 1000
_TOO_DEEP: Final = f"it is nested deeper than {MOST_LEVELS} levels"


def object_text(text: str, *, step: str) -> str:
    """Return the text of the JSON object of a reply, without the Markdown fence or the words around it.

    Raises:
        OutputError: `E_REPLY_SCHEMA`, with the line and column at which the text is not JSON.
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
    blocks = [block for language, block in _fenced(text) if language.lower() in {"", "python", "py", "python3"}]
    if not blocks:
        blocks = [_OPEN_FENCE.sub("", text)]  # no fence, or one that was never closed
    defining = [block for block in blocks if re.search(r"^def build\(", block, re.MULTILINE)]
    if not defining:
        raise unusable("it has no ```python block that defines build(part).", text, step=step)
    script: str = defining[-1]
    return (script.strip("\n") + "\n").encode()


def objection(text: str) -> str | None:
    """Return why an author cannot build a part as it is specified, if that is all that a reply says: `{"cannot_be_built": "why"}`."""
    if re.search(r"^def build\(", text, re.MULTILINE):
        return None
    for candidate in _candidates(text):
        try:
            said = json.loads(candidate)
        except (ValueError, RecursionError):
            continue
        if isinstance(said, dict) and isinstance(why := said.get("cannot_be_built"), str) and why.strip():
            return " ".join(why.split())[:_OBJECTION_CHARACTERS]
    return None


def unusable(problem: str, raw: str, *, step: str) -> OutputError:
    """Return the error of a reply that cannot be used."""
    start = " ".join(raw.split())[:_SHOWN]
    finding = Finding(
        code="E_REPLY_SCHEMA",
        where=f"llm.{step}",
        message=f"The reply to {step!r} cannot be used: {problem}",
        hint=f"It begins: {start!r}.",
    )
    return OutputError(problem, raw=raw, findings=[finding])


def _candidates(text: str) -> Iterable[str]:
    yield text
    yield from (block for _, block in _fenced(text))
    start, end = text.find("{"), text.rfind("}")
    if 0 <= start < end:
        yield text[start : end + 1]


def _fenced(text: str) -> Iterable[tuple[str, str]]:
    """Yield the language and the content of each fenced block, in time linear in the length of the text.

    A line that begins with three backticks opens a block, and the next line that holds nothing else closes it. An expression for a whole
    block would look for its end once more at every opening line.
    """
    language, start = "", 0  # of the open block; 0 where none is open
    for fence in _FENCE.finditer(text):
        if not start:
            language, start = fence[1], fence.end() + 1
        elif not fence[1] and not fence[2].strip(" \t"):
            yield language, text[start : fence.start()]
            start = 0


def _kind(value: Any) -> str:
    return {list: "list", str: "string", bool: "truth value", type(None): "null"}.get(type(value), "number")


class ReplyForm(BaseModel):
    """Base of replies with named fields: frozen, and without unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_by_name=True, validate_by_alias=True)


_Value = TypeVar("_Value")
_Form = TypeVar("_Form", bound=BaseModel)


def ask(
    llm: LLM,
    role: str,
    step: str,
    opening: tuple[Message, ...],
    read: Callable[[str, str], _Value],
    *,
    schema: Mapping[str, Any] | None = None,
) -> _Value:
    """Ask until a reply is valid. An invalid reply is sent back together with what is wrong with it.

    The first try is the step itself, later ones `<step>/2`, `<step>/3`.

    Args:
        llm: The model.
        role: Which agent asks.
        step: The address of the first try.
        opening: The question.
        read: Converts a reply's text and its step to a value, or raises `OutputError`.
        schema: JSON schema of the reply.

    Raises:
        OutputError: If none of `TRIES` replies is valid.
    """
    messages = opening
    for number in range(1, TRIES + 1):
        address = step if number == 1 else f"{step}/{number}"
        reply = llm.complete(Request(role, address, messages, schema))
        try:
            return read(reply.text, address)
        except OutputError as error:
            if number == TRIES:
                raise
            messages = (*opening, assistant(reply.text), user(prompt("form_repair", problem=error.message)))
    raise AssertionError("the last try either returns or raises")


def reader(form: type[_Form], *, ignore: frozenset[str] = frozenset()) -> Callable[[str, str], _Form]:
    """Return a function that validates the text of a reply as a form; fields in `ignore` are not validated."""

    def read(text: str, step: str) -> _Form:
        document = parse_object(text, step=step)
        try:
            return form.model_validate({name: value for name, value in document.items() if name not in ignore})
        except ValidationError as error:
            problems = [f"{'.'.join(map(str, detail['loc'])) or 'the object'}: {detail['msg']}" for detail in error.errors()]
            raise unusable("; ".join(problems) + ".", text, step=step) from None

    return read


def schema_of(form: type[BaseModel], *, without: frozenset[str] = frozenset()) -> dict[str, Any]:
    """Return the JSON schema of a form as every provider accepts it: references expanded, titles removed."""
    schema = form.model_json_schema(by_alias=True)
    for name in without:
        schema["properties"].pop(name)
    plain: dict[str, Any] = _plain(schema, schema.get("$defs", {}))
    return plain


def _plain(schema: Any, definitions: Mapping[str, Any]) -> Any:
    if isinstance(schema, list):
        return [_plain(item, definitions) for item in schema]
    if not isinstance(schema, dict):
        return schema
    if "$ref" in schema:
        return _plain(definitions[schema["$ref"].rsplit("/", 1)[-1]], definitions)
    dropped = {"$defs", "title", "description"}
    return {
        name: ({key: _plain(value, definitions) for key, value in item.items()} if name == "properties" else _plain(item, definitions))
        for name, item in schema.items()
        if name not in dropped
    }
