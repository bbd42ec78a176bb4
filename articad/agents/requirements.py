"""Requirements: what a customer's words and pictures ask for, as a typed form."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Final, Literal, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from articad.agents.llm import LLM, Image, Message, Request, assistant, system, user
from articad.agents.prompts import prompt
from articad.agents.replies import parse_object, unusable
from articad.errors import OutputError
from articad.run import RunRequest

SCHEMA: Final = "articad.requirements/1"
_Value = TypeVar("_Value")
TRIES: Final = 3  # a model that misses the form three times does not find it


class _Form(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", validate_by_name=True, validate_by_alias=True)


def _slug(value: Any) -> Any:
    """Turn a title into a name: a plan's name is for files, and no reason to ask again."""
    if not isinstance(value, str):
        return value
    return re.sub(r"[^a-z0-9]+", "_", value.lower()).strip("_")[:40].strip("_") or value


class Component(_Form):
    """A rigid piece, or several that are alike."""

    name: str
    count: int = Field(1, ge=1)
    description: str


class Motion(_Form):
    """What moves against what."""

    component: str
    relative_to: str
    kind: Literal["turns", "slides", "turns and slides", "swivels", "screws"]
    axis: str
    range: str


class Dimension(_Form):
    """A number that the request states or a picture shows."""

    of: str
    what: str
    value: float = Field(allow_inf_nan=False)
    unit: Literal["mm", "deg", "1"]
    source: Literal["stated", "seen"]


class Requirements(_Form):
    """What is to be built.

    Attributes:
        form: The form's version, `schema` in JSON.
        name: Name of the product.
        summary: What it is and what moves.
        components: The rigid pieces.
        relations: What stands on, lies in or is held by what.
        motions: What moves against what.
        constraints: What must hold.
        dimensions: Numbers that were given.
        assumptions: What was left open, and how it was decided.
    """

    form: Literal["articad.requirements/1"] = Field(SCHEMA, alias="schema")
    name: Annotated[str, BeforeValidator(_slug)]
    summary: str
    components: tuple[Component, ...] = Field(min_length=1)
    relations: tuple[str, ...]
    motions: tuple[Motion, ...]
    constraints: tuple[str, ...]
    dimensions: tuple[Dimension, ...]
    assumptions: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Return the JSON document."""
        document: dict[str, Any] = self.model_dump(mode="json", by_alias=True)
        return document


def response_schema() -> dict[str, Any]:
    """Return the JSON schema of a reply: the form without its version, which a model need not state."""
    schema = Requirements.model_json_schema(by_alias=True)
    schema["properties"].pop("schema")
    plain: dict[str, Any] = _plain(schema, schema.get("$defs", {}))
    return plain


def analyse(request: RunRequest, llm: LLM) -> Requirements:
    """Ask what a request, in words, pictures or both, wants built.

    Raises:
        OutputError: If the model does not find the form in `TRIES` tries.
    """
    opening = (system(prompt("requirements")), user(_words(request), *pictures_of(request)))
    return ask(llm, "requirements", "requirements", opening, _read, schema=response_schema())


def pictures_of(request: RunRequest) -> tuple[Image, ...]:
    """Return the pictures that belong to the whole product."""
    return tuple(Image(image.content, image.media_type) for image in request.images if image.part is None)


def ask(  # placeholder
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


def _read(text: str, step: str) -> Requirements:
    document = parse_object(text, step=step)
    try:
        return Requirements.model_validate({name: value for name, value in document.items() if name != "schema"})
    except ValidationError as error:
        problems = [f"{'.'.join(map(str, detail['loc'])) or 'the object'}: {detail['msg']}" for detail in error.errors()]
        raise unusable("; ".join(problems) + ".", text, step=step) from None


def _words(request: RunRequest) -> str:
    seen = len(pictures_of(request))
    pictures = f"\n\n{seen} picture{'s' if seen > 1 else ''} of what is wanted follow{'' if seen > 1 else 's'}." if seen else ""
    return f"The request:\n\n{request.prompt.strip() or '(no words; see the pictures)'}{pictures}"


def _plain(schema: Any, definitions: Mapping[str, Any]) -> Any:
    """Return a schema with its references written out and its titles dropped: what every provider takes."""
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
