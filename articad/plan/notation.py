"""The plan's form in a compact notation: the one of the design prompt, written from the JSON Schema and so never out of date.

A line for each object: its fields in backticks, each with its default, its form and a remark. Fields without a default are required.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from articad.aliases import Json
from articad.plan.joint_forms import COUPLING_TYPES, JOINT_TYPES
from articad.plan.json_schema import json_schema

_OBJECTS: Final = {
    "parameter": ("Parameter",),
    "material": ("Material",),
    "pose": ("Pose",),
    "part": ("PartSpec", "DerivedPart"),
    "connector": ("ConnectorSpec",),
    "derive": ("MirrorDerivation", "RigidDerivation", "PatternDerivation", "MirrorPlane"),
    "fit": ("Fit",),
    "allow": ("Allow",),
}
TYPES: Final = ("plan", *_OBJECTS, "joint", *JOINT_TYPES, "coupling", *(name for name in COUPLING_TYPES if name not in JOINT_TYPES))
"""The names that `described` knows."""

_FORMS: Final = {"Number": "", "Name": "", "Vector": "[x, y, z]", "Interval": "[low, high]", "Reference": '"part.connector"'}
_NAMES: Final = {
    "DerivedPart": "derived part",
    "MirrorPlane": "plane",
    "MirrorDerivation": "mirror",
    "RigidDerivation": "rigid",
    "PatternDerivation": "pattern",
}
_INLINE: Final = ("JointDerivation",)  # too small for a line of their own
_SHOWN_OPTIONS: Final = 3
_COMMON: Final = (
    "name",
    "type",
    "parent",
    "child",
    "mate",
    "driver",
    "fit",
    "fastening",
    "effort_n_mm",
    "velocity_deg_s",
    "effort_n",
    "velocity_mm_s",
)


def described(topic: str) -> str | None:
    """Return the fields of the plan's objects of a name such as "joint", "revolute", "part" or "coupling"; None if there are none."""
    topic = topic.lower()
    name = topic if topic in TYPES else topic.removesuffix("spec").removesuffix("s")
    schema = json_schema()
    if name == "plan":
        return f"{_object('plan', schema, schema)}\n{_READING}"
    if name in _OBJECTS:
        lines = [_object(_named(each), schema["$defs"][each], schema) for each in _OBJECTS[name]]
        return "\n".join([*lines, _READING])
    found = _joints(schema, name) + _couplings(schema, name)
    return "\n".join([*found, _READING]) if found else None


_READING: Final = 'Fields with = may be left out. A number is also an expression over parameters, "width / 2". Lengths mm, angles degrees. No other fields exist.'


def _joints(schema: Json, name: str) -> list[str]:
    """Return the lines of one joint type, or of all with those joints that derive from others."""
    types = JOINT_TYPES if name == "joint" else tuple(each for each in JOINT_TYPES if each == name)
    if not types:
        return []
    forms = _by_type(schema, "joints")
    first = forms[types[0]]
    shared = {key: field for key, field in first["properties"].items() if key in _COMMON and key != "type"}
    lines = [f"joint, all types: `type`, {_fields(shared, first['required'], schema)}", "By type:"]
    lines += [_own(each, forms[each], _COMMON, schema) for each in types]
    if name == "joint":
        lines.append(_object("derived joint", schema["$defs"]["DerivedJoint"], schema))
    return lines


def _couplings(schema: Json, name: str) -> list[str]:
    """Return the lines of one coupling type, or of all."""
    types = COUPLING_TYPES if name == "coupling" else tuple(each for each in COUPLING_TYPES if each == name)
    if not types:
        return []
    forms = _by_type(schema, "couplings")
    first = forms[types[0]]
    shared = {key: first["properties"][key] for key in ("name", "joints")}
    lines = [f"coupling, all types: `type`, {_fields(shared, first['required'], schema)}", "By type:"]
    return lines + [_own(each, forms[each], ("name", "type", "joints"), schema) for each in types]


def _by_type(schema: Json, key: str) -> dict[str, Json]:
    """Return the objects of a list of the plan by their `type`."""
    names = [form["$ref"].rpartition("/")[2] for form in schema["properties"][key]["items"]["oneOf"]]
    objects = [schema["$defs"][name] for name in names]
    return {form["properties"]["type"]["const"]: form for form in objects if "type" in form["properties"]}


def _own(name: str, form: Json, common: Sequence[str], schema: Json) -> str:
    """Return the line of a type: what it means, and the fields that only it has."""
    own = {key: field for key, field in form["properties"].items() if key not in common}
    fields = _fields(own, form.get("required", ()), schema)
    return f'"{name}": {form["description"].rstrip(".")}. {fields}'.rstrip()


def _object(name: str, form: Json, schema: Json) -> str:
    return f"{name}: {_fields(form['properties'], form.get('required', ()), schema)}"


def _fields(fields: Json, required: Sequence[str], schema: Json) -> str:
    return ", ".join(_field(name, field, schema, required=name in required) for name, field in fields.items())


def _field(name: str, field: Json, schema: Json, *, required: bool) -> str:
    """Return one field: its name, its default, its form, its remark."""
    remark = field.get("description", "")
    reference = str(field.get("$ref", "")).rpartition("/")[2]
    shared = schema["$defs"].get(reference, {})
    if reference == name:  # a field that several objects share
        remark, field = remark or shared.get("description", ""), shared
    default = "" if required else "=" + _default(field)
    remarks = [text for text in (_form(field, schema), remark[:1].lower() + remark[1:]) if text]
    return f"`{name}`{default}" + (f" ({': '.join(remarks)})" if remarks else "")


def _default(field: Json) -> str:
    empty: dict[Any, Any] = {"array": [], "object": {}, "string": None if "pattern" in field or "enum" in field else ""}
    value = field.get("default", empty.get(field.get("type")))
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "null"}[value]
    return f'"{value}"' if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else str(value)


def _form(field: Json, schema: Json) -> str:
    """Return the form of a value; empty for numbers, names and texts, which need no word."""
    if "const" in field or "enum" in field:
        return "|".join(f'"{value}"' for value in field.get("enum", [field.get("const")]))
    if options := field.get("anyOf") or field.get("oneOf"):
        return _choice(options, schema)
    if "$ref" in field:
        return _referred(str(field["$ref"]).rpartition("/")[2], schema)
    kind = field.get("type")
    if kind == "array":
        items = _form(field["items"], schema)
        return "[a, b]" if field.get("maxItems") == 2 else f"list of {items}" if items else "list"
    return "{name: number}" if kind == "object" else '"#rrggbb"' if field.get("pattern", "").startswith("^#") else ""


def _choice(options: Sequence[Json], schema: Json) -> str:
    """Return the forms that a value may have; all joints and all couplings by one name."""
    if len(options) > _SHOWN_OPTIONS:
        return "coupling" if any("GearSpec" in str(option) for option in options) else "joint or derived joint"
    return " or ".join(filter(None, (_form(option, schema) for option in options)))


def _referred(name: str, schema: Json) -> str:
    """Return the form that a definition of the schema stands for."""
    if name in _INLINE:
        form = schema["$defs"][name]
        return f"{{{_fields(form['properties'], form['required'], schema)}}}"
    return _FORMS.get(name, _named(name))


def _named(definition: str) -> str:
    """Return what the notation calls a definition of the schema."""
    return _NAMES.get(definition, definition.removesuffix("Spec").lower())


__all__ = ["TYPES", "described"]
