"""Fields: the types of values in a plan, each with one clear sentence for an invalid one.

Every type has its own validator instead of a union of pydantic types: a union gives one error for each branch, but one sentence should
say what would be valid.
"""

from __future__ import annotations

import keyword
import math
import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from articad.plan.expressions import MAX_CHARACTERS
from articad.texts import SPOILED, spoiled

NAME_PATTERN = r"^[a-z][a-z0-9]*(_[a-z0-9]+)*$"
MAX_NAME = 40  # names become URDF links, MJCF bodies, file names and keyword arguments
_NAME = re.compile(NAME_PATTERN)
_COLOR = re.compile(r"#[0-9a-fA-F]{6}")

NAME_RULE = (
    f"Use lower_snake_case such as 'door_left': letters, digits and single underscores, at most {MAX_NAME} characters, no Python keyword."
)
NUMBER_FORM = 'a finite number or an expression in quotes, such as 12.5 or "width / 2 - gap"'


class PlanObject(BaseModel):
    """Base of every object in a plan: frozen, and without unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_by_name=True, validate_by_alias=True)


def lengths_in(dimensions: Mapping[str, float]) -> dict[str, float]:
    """Return the dimensions that are lengths [mm]: all but angles, `_deg`, and counts, `_count`."""
    return {name: float(value) for name, value in dimensions.items() if not name.endswith(("_deg", "_count"))}


def is_name(text: str) -> bool:
    """Return whether `text` has the form of a name."""
    return len(text) <= MAX_NAME and bool(_NAME.fullmatch(text)) and not keyword.iskeyword(text)


def _name(value: Any) -> str:
    if not isinstance(value, str):
        raise _wrong("a name in quotes")
    if not is_name(value):
        raise PydanticCustomError("plan_name", "not a name")
    return value


def _reference(parts: tuple[int, ...], form: str) -> Any:
    def check(value: Any) -> str:
        if not isinstance(value, str):
            raise _wrong(form)
        pieces = value.split(".")
        if len(pieces) not in parts:
            raise _wrong(form)
        if not all(is_name(piece) for piece in pieces):
            raise PydanticCustomError("plan_name", "not a name")
        return value

    return check


def _number(value: Any) -> float | str:
    if isinstance(value, str):
        if len(value) <= MAX_CHARACTERS:
            return _text(value)
        raise PydanticCustomError("plan_expression_length", "too long")
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise _wrong(NUMBER_FORM)
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise PydanticCustomError("plan_nonfinite", "not finite")
    return number + 0.0  # −0 is 0


def _listed(length: int, form: str) -> BeforeValidator:
    def check(value: Any) -> Any:
        if not isinstance(value, (list, tuple)) or len(value) != length:
            raise _wrong(form)
        return tuple(value)

    return BeforeValidator(check)


def _range_or_endless(value: Any) -> Any:
    if value == "endless":
        return value
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise _wrong('[lower, upper] or "endless"')
    return tuple(_element(number, index) for index, number in enumerate(value))


def _element(value: Any, index: int) -> float | str:
    try:
        return _number(value)
    except PydanticCustomError as error:
        raise PydanticCustomError(error.type, error.message_template, {**(error.context or {}), "element": index}) from None


def _color(value: Any) -> str:
    if not isinstance(value, str) or not _COLOR.fullmatch(value):
        raise _wrong('a colour as "#rrggbb", such as "#c8a46e"')
    return value


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise _wrong("text in quotes")
    if spoiled(value) is not None:
        raise _wrong(f"text without {SPOILED}")
    return value


def _truth(value: Any) -> bool:
    if not isinstance(value, bool):
        raise _wrong("true or false")
    return value


_LARGEST_COUNT = 2**31  # JSON allows integers of any length; floats and indices do not


def _whole(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value <= _LARGEST_COUNT or value != int(value):
        raise _wrong("a whole number of at least 0")
    return int(value)


def _wrong(form: str) -> PydanticCustomError:
    return PydanticCustomError("plan_form", "expected {form}", {"form": form})


SHARED = "x-articad-shared"  # stands for "$ref" until the schema is complete, because pydantic would resolve "$ref" itself
_NUMBER_SCHEMA = {SHARED: "Number"}
_PAIR_SCHEMA = {"type": "array", "items": _NUMBER_SCHEMA, "minItems": 2, "maxItems": 2}

Name = Annotated[str, PlainValidator(_name), WithJsonSchema({SHARED: "Name"})]
Number = Annotated[float | str, PlainValidator(_number), WithJsonSchema(_NUMBER_SCHEMA)]
Text = Annotated[str, PlainValidator(_text), WithJsonSchema({"type": "string"})]
Truth = Annotated[bool, PlainValidator(_truth), WithJsonSchema({"type": "boolean"})]
Whole = Annotated[int, PlainValidator(_whole), WithJsonSchema({"type": "integer", "minimum": 0})]
Color = Annotated[str, PlainValidator(_color), WithJsonSchema({"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"})]
Reference = Annotated[str, PlainValidator(_reference((2,), "part.connector in quotes")), WithJsonSchema({SHARED: "Reference"})]
CoordinateName = Annotated[
    str,
    PlainValidator(_reference((1, 2), "the name of a joint, or joint.travel or joint.angle of a cylindrical one")),
    WithJsonSchema({"type": "string"}),
]
Vector = Annotated[tuple[Number, Number, Number], _listed(3, "three numbers [x, y, z]"), WithJsonSchema({SHARED: "Vector"})]
Interval = Annotated[tuple[Number, Number], _listed(2, "[lower, upper]"), WithJsonSchema({SHARED: "Interval"})]
NumberPair = Annotated[tuple[Number, Number], _listed(2, "two numbers [a, b]"), WithJsonSchema(_PAIR_SCHEMA)]
Range = Annotated[
    tuple[Number, Number] | Literal["endless"],
    PlainValidator(_range_or_endless),
    WithJsonSchema({"anyOf": [{SHARED: "Interval"}, {"const": "endless"}]}),
]
NamePair = Annotated[
    tuple[Name, Name],
    _listed(2, "the names of two parts [a, b]"),
    WithJsonSchema({"type": "array", "items": {SHARED: "Name"}, "minItems": 2, "maxItems": 2}),
]
CoordinatePair = Annotated[
    tuple[CoordinateName, CoordinateName],
    _listed(2, "the names of two joints [a, b]"),
    WithJsonSchema({"type": "array", "items": {"type": "string"}, "minItems": 2, "maxItems": 2}),
]

SHARED_DEFINITIONS: dict[str, Any] = {
    "Name": {"type": "string", "pattern": NAME_PATTERN, "maxLength": MAX_NAME, "description": "lower_snake_case, no Python keyword"},
    "Reference": {"type": "string", "description": "part.connector"},
    "Number": {
        "anyOf": [{"type": "number"}, {"type": "string", "maxLength": MAX_CHARACTERS}],
        "description": "A number, or an expression of parameters: + - * / ( ) pi abs acos asin atan atan2 ceil cos floor hypot max min "
        "sin sqrt tan; angles in degrees.",
    },
    "Vector": {"type": "array", "items": _NUMBER_SCHEMA, "minItems": 3, "maxItems": 3, "description": "[x, y, z]"},
    "Interval": {**_PAIR_SCHEMA, "description": "[lower, upper]"},
}
"""Definitions that every field's JSON schema refers to."""
