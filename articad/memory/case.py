"""A case: the request of one run, its answer, and its outcome."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any, Final, Literal

from articad.aliases import Json
from articad.errors import ReadError
from articad.findings import Finding

Kind = Literal["good", "issue"]

SCHEMA: Final = "articad.case/1"


@dataclass(frozen=True)
class PartExample:
    """One part of a case: the specification that its author was given, and the script that was built.

    Attributes:
        name: Name of the part.
        specification: The part's entry, as its author reads it.
        kernel: The kernel, which determines the dialect of the script.
        script: The script.
    """

    name: str
    specification: str
    kernel: str
    script: str


@dataclass(frozen=True, kw_only=True)
class Case:
    """A summary of a run.

    Attributes:
        kind: "good" if every deterministic check passed; "issue" with a measured defect.
        prompt: The request.
        requirements: The analysis of the request.
        design: The connector plan in words: parts, joints, ranges.
        parts: Scripts that were built.
        repairs: Faults that were corrected on the way.
        defects: Faults that the checks measured at the end; an issue has at least one.
        scores: Numbers of the review, by name.
        lessons: The review's advice to the next designer.
        articad: Version that made the run.
    """

    kind: Kind
    prompt: str
    requirements: str = ""
    design: str = ""
    parts: tuple[PartExample, ...] = ()
    repairs: tuple[str, ...] = ()
    defects: tuple[str, ...] = ()
    scores: Mapping[str, float] = field(default_factory=dict, hash=False)
    lessons: tuple[str, ...] = ()
    articad: str = ""

    @cached_property
    def id(self) -> str:
        """The first 16 hexadecimal digits of the sha256 of its content: the same case is stored once."""
        text = json.dumps(self.to_json(), sort_keys=True, ensure_ascii=False, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def request(self) -> str:
        """The text by which a similar request is recognised."""
        return f"{self.prompt}\n{self.requirements}".strip()

    def to_json(self) -> Json:
        """Return the form `articad.case/1`."""
        stored = {"schema": SCHEMA} | asdict(self)
        if not self.lessons:
            stored.pop("lessons")  # so that cases without lessons keep their ids from before there were any
        return stored

    @classmethod
    def from_json(cls, stored: Mapping[str, Any]) -> Case:
        """Return the case for a stored form.

        Raises:
            ReadError: If it does not have the form.
        """
        try:
            content = dict(stored)
            _require(content.pop("schema") == SCHEMA, "another schema")
            _require(content["kind"] in {"good", "issue"}, f"kind {content['kind']!r}")
            content["parts"] = tuple(PartExample(**part) for part in content["parts"])
            words = [content["prompt"], *(content.get(name, "") for name in ("requirements", "design", "articad"))]
            words += [word for part in content["parts"] for word in (part.name, part.specification, part.kernel, part.script)]
            _require(all(isinstance(word, str) for word in words), "a text field is not a text")
            _require(all(_is_number(value) for value in dict(content.get("scores", {})).values()), "a score is not a number")
            texts = [name for name in ("repairs", "defects", "lessons") if name in content]
            return cls(**content | {name: tuple(map(str, content[name])) for name in texts})
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            message = f"This is not a case of the form {SCHEMA}: {type(error).__name__}: {error}."
            finding = Finding(code="E_READ", where="case", message=message, hint="Export cases with `articad memory export`.")
            raise ReadError(message, path="case", findings=[finding]) from error


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _require(holds: bool, otherwise: str) -> None:
    if not holds:
        raise ValueError(otherwise)
