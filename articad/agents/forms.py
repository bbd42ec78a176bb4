"""Forms: replies that are filled in rather than told, and the asking until one has its form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from articad.agents.llm import LLM, Message, Request, assistant, user
from articad.agents.prompts import prompt
from articad.agents.replies import parse_object, unusable
from articad.errors import OutputError

TRIES: Final = 3  # a model that misses a form three times does not find it


class Form(BaseModel):
    """A reply with named fields: no others, and none that changes later."""

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
    """Ask until the reply has the form asked for; a reply that has not goes back with what is wrong with it.

    The first try is the step itself, later ones `<step>/2`, `<step>/3`.

    Args:
        llm: Who answers.
        role: Which agent asks.
        step: The address of the first try.
        opening: The question.
        read: Makes the value of a reply's text and its step, or raises `OutputError`.
        schema: JSON schema of the reply.

    Raises:
        OutputError: If none of `TRIES` replies has the form.
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
    """Return what reads a reply as a form; fields in `ignore` may be stated and are not looked at."""

    def read(text: str, step: str) -> _Form:
        document = parse_object(text, step=step)
        try:
            return form.model_validate({name: value for name, value in document.items() if name not in ignore})
        except ValidationError as error:
            problems = [f"{'.'.join(map(str, detail['loc'])) or 'the object'}: {detail['msg']}" for detail in error.errors()]
            raise unusable("; ".join(problems) + ".", text, step=step) from None

    return read


def schema_of(form: type[BaseModel], *, without: frozenset[str] = frozenset()) -> dict[str, Any]:
    """Return the JSON schema of a form as every provider takes it: references written out, titles dropped."""
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
