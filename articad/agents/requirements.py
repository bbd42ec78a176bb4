"""Requirements: the content of a customer's words and pictures, as a typed form."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, BeforeValidator, Field

from articad.agents.llm import LLM, Image, system, user
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of
from articad.runs.run import RunRequest

SCHEMA: Final = "articad.requirements/1"


def slug(value: Any) -> Any:
    """Turn a title into a name: a plan's name is for files, and no reason to ask again."""
    if not isinstance(value, str):
        return value
    return re.sub(r"[^a-z0-9]+", "_", value.lower()).strip("_")[:40].strip("_") or value


class Component(ReplyForm):
    """A rigid piece, or several that are alike."""

    name: str
    count: int = Field(1, ge=1)
    description: str


class Motion(ReplyForm):
    """What moves against what."""

    component: str
    relative_to: str
    kind: Literal["turns", "slides", "turns and slides", "swivels", "screws", "slides in a plane", "tilts"]
    axis: str
    range: str


class Dimension(ReplyForm):
    """A number that the request states or a picture shows."""

    of: str
    what: str
    value: float = Field(allow_inf_nan=False)
    unit: Literal["mm", "deg", "1"]
    source: Literal["stated", "seen"]


class Requirements(ReplyForm):
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
        open_ended: Whether the request leaves open even what is to be built.
    """

    form: Literal["articad.requirements/1"] = Field(SCHEMA, alias="schema")
    name: Annotated[str, BeforeValidator(slug)]
    summary: str
    components: tuple[Component, ...] = Field(min_length=1)
    relations: tuple[str, ...]
    motions: tuple[Motion, ...]
    constraints: tuple[str, ...]
    dimensions: tuple[Dimension, ...]
    assumptions: tuple[str, ...]
    open_ended: bool = False

    def to_json(self) -> dict[str, Any]:
        """Return the JSON document."""
        document: dict[str, Any] = self.model_dump(mode="json", by_alias=True, exclude=set() if self.open_ended else {"open_ended"})
        return document

    def told(self, fields: Sequence[str] | None = None) -> str:
        """Return the analysis, or some of its fields, as a prompt holds it: a line for each thing, without the name of its form."""
        lines: list[str] = []
        for name in type(self).model_fields if fields is None else fields:
            stated = getattr(self, name)
            if isinstance(stated, tuple):
                lines += [f"{name}:{'' if stated else ' none'}", *(f"- {_one_line(_text(entry))}" for entry in stated)]
            elif name not in {"form", "open_ended"} or stated is True:
                lines.append(f"{name}: {_one_line(str(stated))}")
        return "\n".join(lines)


def _text(stated: Component | Motion | Dimension | str) -> str:
    match stated:
        case Component():
            return f"{stated.name}{f' ({stated.count} of them)' if stated.count > 1 else ''}: {stated.description}"
        case Motion():
            return f"{stated.component} {stated.kind} against {stated.relative_to}; axis: {stated.axis}; range: {stated.range}"
        case Dimension():
            return f"{stated.of}, {stated.what}: {stated.value:.12g}{'' if stated.unit == '1' else f' {stated.unit}'} ({stated.source})"
    return stated


def _one_line(text: str) -> str:
    """Return text in which nothing begins a line of its own, so that no entry looks like another section."""
    return " ".join(text.split())


def response_schema() -> dict[str, Any]:
    """Return the JSON schema of a reply: the form without its version, which a model need not state."""
    return schema_of(Requirements, without=frozenset({"schema"}))


def analyse(request: RunRequest, llm: LLM, *, concept: BaseModel | None = None) -> Requirements:
    """Ask a model what a request, in words, pictures or both, wants built.

    Args:
        request: The words and pictures.
        llm: The model.
        concept: The customer's choice among several proposals, if the request left it open.

    Raises:
        OutputError: If no reply has the required form.
    """
    chosen = (
        ""
        if concept is None
        else f"\n\n{prompt('concept', concept=json.dumps(concept.model_dump(mode='json'), indent=1, ensure_ascii=False))}"
    )
    opening = (system(prompt("requirements")), user(_words(request) + chosen, *pictures_of(request)))
    step = "requirements" if concept is None else "concept"
    return ask(llm, "requirements", step, opening, reader(Requirements, ignore=frozenset({"schema"})), schema=response_schema())


def pictures_of(request: RunRequest) -> tuple[Image, ...]:
    """Return the pictures that belong to the whole product."""
    return tuple(Image(image.content, image.media_type) for image in request.images if image.part is None)


def _words(request: RunRequest) -> str:
    seen = len(pictures_of(request))
    pictures = f"\n\n{seen} picture{'s' if seen > 1 else ''} of what is wanted follow{'' if seen > 1 else 's'}." if seen else ""
    return f"The request:\n\n{request.prompt.strip() or '(no words; see the pictures)'}{pictures}"
