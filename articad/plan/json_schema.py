"""The plan's JSON Schema, for prompting models and for editors: compact, every object named once."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from articad.plan.fields import SHARED, SHARED_DEFINITIONS
from articad.plan.schema import SCHEMA, AssemblyPlan

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_REPEATED = 5  # a field that this many objects have is defined once …
_WORTH_SHARING = 60  # … if its text is longer than a reference to it
_RENAMED = {"FitSpec": "Fit", "MaterialSpec": "Material"}  # class -> definition
_DROPPED = ("title", "default", "discriminator")  # titles repeat keys; null defaults say nothing; the other is not JSON Schema


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of `articad.plan/1`, a new dict each time."""
    schema: dict[str, Any] = _copied(_compact())
    return schema


@lru_cache(maxsize=1)
def _compact() -> dict[str, Any]:
    raw = AssemblyPlan.model_json_schema(by_alias=True, ref_template="#/$defs/{model}")
    definitions = {_RENAMED.get(name, name): definition for name, definition in raw.pop("$defs").items()} | SHARED_DEFINITIONS
    schema = _cleaned(raw)
    schema["description"] = str(schema["description"]).split("\n", maxsplit=1)[0]
    cleaned = {name: _demanding(_cleaned(definition)) for name, definition in sorted(definitions.items())}
    return {"$schema": _DIALECT, "$id": SCHEMA, **schema, "$defs": _shared(cleaned)}


def _demanding(definition: dict[str, Any]) -> dict[str, Any]:
    """Require limits, which a plan may omit only with a finding: a model should always state them."""
    stated = [key for key, field in definition.get("properties", {}).items() if field.get("description", "").startswith("Required")]
    if stated:
        definition["required"] = [*definition["required"], *stated]
        for key in stated:
            text = definition["properties"][key].pop("description").removeprefix("Required").lstrip(": ")
            if text:
                definition["properties"][key]["description"] = text
    return definition


def _shared(definitions: dict[str, Any]) -> dict[str, Any]:
    """Move the definition of fields that several objects share into a definition of its own."""
    fields = [(key, json.dumps(field)) for definition in definitions.values() for key, field in definition.get("properties", {}).items()]
    often = {key: text for (key, text), count in Counter(fields).items() if count >= _REPEATED and len(text) > _WORTH_SHARING}
    for definition in definitions.values():
        for key, field in definition.get("properties", {}).items():
            if often.get(key) == json.dumps(field):
                definition["properties"][key] = {"$ref": f"#/$defs/{key}"}
    return {**definitions, **{key: json.loads(text) for key, text in sorted(often.items())}}


def _cleaned(node: Any) -> Any:
    """Drop what a reader does not need, and write `anyOf: [X, null]` of an optional value as X."""
    if isinstance(node, list):
        return [_cleaned(item) for item in node]
    if not isinstance(node, Mapping):
        return node
    cleaned = {
        key: {name: _cleaned(item) for name, item in value.items()} if key == "properties" else _cleaned(value)
        for key, value in node.items()
        if key not in _DROPPED or _says_something(key, value)
    }
    if SHARED in cleaned:
        cleaned["$ref"] = f"#/$defs/{cleaned.pop(SHARED)}"
    if "$ref" in cleaned:
        path, _, name = str(cleaned["$ref"]).rpartition("/")
        cleaned["$ref"] = f"{path}/{_RENAMED.get(name, name)}"
    options = cleaned.get("anyOf")
    if isinstance(options, list) and {"type": "null"} in options:
        others = [option for option in options if option != {"type": "null"}]
        if len(others) == 1:
            del cleaned["anyOf"]
            cleaned = {**others[0], **cleaned}
        else:
            cleaned["anyOf"] = others
    return cleaned


def _says_something(key: str, value: Any) -> bool:
    return key == "default" and isinstance(value, (str, bool, int, float)) and value != ""


def _copied(node: Any) -> Any:
    if isinstance(node, dict):
        return {key: _copied(value) for key, value in node.items()}
    return [_copied(item) for item in node] if isinstance(node, list) else node
