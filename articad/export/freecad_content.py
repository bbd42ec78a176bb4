"""The editable content of a FreeCAD document as values that can be compared.

A document that articad writes carries its own content. The reader compares it with the content that the document has now: each difference is an
edit. Shapes, values that follow from expressions, and what FreeCAD adds by itself are not edits. `UNCOMPARED` names what is left out.
"""

from __future__ import annotations

import base64
import json
import math
import zlib
from collections.abc import Iterator
from typing import Any

PROPERTY = "ArticadWritten"
"""The property of the assembly that holds the content of the document as it was written."""

MAX_BYTES = 64 * 2**20  # of unpacked content
MAX_VALUES = 4_000_000  # in it; an empty list takes twenty times its place in the text
UNCOMPARED = (
    "properties of the document (comment, author, license)",
    "cameras and line styles",
    "pages of drawings",
    "cells of the bill of materials",
    "coordinates of points that no constraint of a sketch fixes",
    "objects of other workbenches beyond their numbers, texts and links",
)
"""What a user may change in a document without a finding, unless the shape, the mass or the place of a part changes with it."""

_DEFAULT_MATERIAL = "7f9fd73b-50c9-41d8-b7b2-575a030c1eeb"  # FreeCAD's own, of an object to which none was given
_DERIVED = (
    "App::Origin",
    "App::Line",
    "App::Plane",
    "App::Point",
    "App::LocalCoordinateSystem",
    "TechDraw::",
)
_GROUPS = (
    "Assembly::AssemblyObject",
    "Assembly::JointGroup",
    "Assembly::BomGroup",
    "App::Part",
    "PartDesign::Body",
    "App::DocumentObjectGroup",
)
_PLACED = (
    "App::Part",
    "App::Link",
    "PartDesign::CoordinateSystem",
    "PartDesign::Body",
    "Mesh::Feature",
)  # others are placed by what they are made of
_JOINT = (
    "JointType",
    "Distance",
    "Distance2",
    "ObjectToGround",
    *(f"{kind}{end}" for kind in ("Angle", "Length") for end in ("Min", "Max")),
)
_NOT_COMPARED = {  # compared elsewhere, derived by FreeCAD, or articad's own
    "Label", "Visibility", "Proxy", "ExpressionEngine", "Shape", "AddSubShape", "SuppressedShape", "_Body", "MapPathParameter",
    "AttacherType", "AttacherEngine", "Uid", "Id", "_ElementMapVersion", "Density", "Mass", "Volume", "FullyConstrained",
    "Origin", "Group", "ArticadRecords", PROPERTY, "Material", "License", "LicenseURL", "Color", "Type", "ShapeMaterial",
}  # fmt: skip
_BILL = "Assembly::BomObject"  # a sheet that FreeCAD fills in
_NUMBERS = ("Float", "Integer")  # tags of XML that hold one
_DEEPEST = 4  # lists in lists of a value

Json = dict[str, Any]
Content = dict[str, Json]
"""Object -> its `type`, `label`, `expressions` (path -> text) and `values` (path -> number, text, truth value or list)."""


def content_of(root: Any) -> Content:
    """Return the content of a document.

    Args:
        root: The root element of Document.xml.
    """
    types = {item.get("name", ""): item.get("type", "") for item in root.iterfind("Objects/Object")}
    found: Content = {}
    for item in root.iterfind("ObjectData/Object"):
        name = item.get("name", "")
        kind = types.get(name, "")
        if kind.startswith(_DERIVED):
            continue
        rows = {row.get("name", ""): row for row in item.iterfind("Properties/Property")}
        label = rows["Label"].find("String") if "Label" in rows else None
        found[name] = {
            "type": kind,
            "label": "" if label is None else label.get("value", ""),
            "expressions": _expressions(rows.get("ExpressionEngine")),
            "values": dict(_values(kind, rows)) | dict(_everywhere(kind, rows)),
        }
    return found


def packed_content(content: Content) -> str:
    """Return content as one line of text for a property."""
    return base64.b64encode(zlib.compress(json.dumps(content, separators=(",", ":")).encode(), 9)).decode()


def unpacked_content(text: str) -> Content | None:
    """Return the content that a property holds, or None where it is not content."""
    try:
        unpacker = zlib.decompressobj()
        raw = unpacker.decompress(base64.b64decode(text, validate=True), MAX_BYTES)
        if sum(raw.count(mark) for mark in (b"[", b"{", b",")) > MAX_VALUES:
            return None
        content = json.loads(raw)
    except (ValueError, zlib.error, RecursionError):
        return None
    return content if isinstance(content, dict) and all(map(_is_object, content.values())) else None


def _is_object(held: Any) -> bool:
    if not isinstance(held, dict) or not all(
        isinstance(held.get(key), kind) for key, kind in (("type", str), ("label", str), ("expressions", dict), ("values", dict))
    ):
        return False
    members = held["values"].get("Group", [])
    return (
        isinstance(members, list)
        and all(isinstance(member, str) for member in members)
        and all(isinstance(text, str) for text in held["expressions"].values())
        and all(map(_is_value, held["values"].values()))
    )


def _is_value(value: Any, depth: int = _DEEPEST) -> bool:
    if isinstance(value, list):
        return depth > 0 and all(_is_value(entry, depth - 1) for entry in value)
    return value is None or isinstance(value, (str, float)) or (isinstance(value, int) and abs(value) < 2**63)


def _expressions(row: Any) -> dict[str, str]:
    if row is None:
        return {}
    return {entry.get("path", "").lstrip("."): entry.get("expression", "") for entry in row.iter("Expression")}


def _everywhere(kind: str, rows: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield what every kind of object may have: a description, a material, members."""
    described = rows["Label2"].find("String") if "Label2" in rows else None
    yield "Label2", "" if described is None else described.get("value", "")
    material = rows["ShapeMaterial"].find(".//PropertyMaterial") if "ShapeMaterial" in rows else None
    yield "ShapeMaterial", _DEFAULT_MATERIAL if material is None else material.get("uuid") or _DEFAULT_MATERIAL
    if kind in _GROUPS and "Group" in rows:
        yield "Group", sorted(link.get("value", "") for link in rows["Group"].iter("Link"))


def _values(kind: str, rows: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    if "JointType" in rows or "ObjectToGround" in rows:
        yield from _joint_values(rows)
        return
    for name, row in rows.items():
        family = row.get("type", "")
        if name in _NOT_COMPARED or (kind == "App::VarSet" and not row.get("group")):
            continue
        if family == "App::PropertyPlacement":
            if name != "Placement" or kind in _PLACED:
                yield from _placement(name, row.find("PropertyPlacement"))
        elif family == "Sketcher::PropertyConstraintList":
            yield from _constraints(row)
        elif family == "Part::PropertyGeometryList":
            yield name, [entry.get("type", "") for entry in row.iter("Geometry")]
        elif family == "Spreadsheet::PropertySheet" and kind != _BILL:
            yield from ((f"cells.{cell.get('address', '')}", cell.get("content", "")) for cell in row.iter("Cell"))
        elif family.startswith("App::Property") and (value := _value(row)) is not None:
            yield name, value


def _joint_values(rows: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the values of a joint, under the same names for FreeCAD 1.0 and 1.1."""
    for name in _JOINT:
        if name in rows and (value := _value(rows[name])) is not None:
            yield name, value
    for name in ("AngleMin", "AngleMax", "LengthMin", "LengthMax"):
        if f"Enable{name}" in rows:
            yield f"Enable{name}", _value(rows[f"Enable{name}"]) is True
    off = [_value(rows[name]) is wanted for name, wanted in (("Activated", False), ("Suppressed", True)) if name in rows]
    yield "active", not any(off)
    for name in ("Offset1", "Offset2"):
        if name in rows:
            yield from _placement(name, rows[name].find("PropertyPlacement"))
    for name in ("Reference1", "Reference2"):
        link = rows[name].find(".//XLink") if name in rows else None
        if link is not None:
            sub = link.find("Sub")
            path = (sub.get("value", "") if sub is not None else link.get("sub") or "").split(".")[:-1]
            yield name, ".".join([*([link.get("name", "")] if link.get("name") != "Assembly" else []), *path])


def _value(row: Any) -> Any:
    """Return the value of a property with one value or with links; None if it is not compared."""
    family = row.get("type", "").removeprefix("App::Property")
    if family.startswith(("Link", "XLink")):
        links = [found for found in row.iter() if found.tag in ("Link", "XLink", "LinkSub", "XLinkSub")]
        named = [f"{found.get('value') or found.get('name') or found.get('obj') or ''}" for found in links]
        return [*named, *(found.get("value", "") for found in row.iter("Sub") if found.get("value"))]
    if family.startswith("Vector"):
        found = row.find("PropertyVector")
        return None if found is None else [_number(found.get(f"value{axis}")) for axis in "XYZ"]
    if family == "Enumeration":
        found, options = row.find("Integer"), [option.get("value") for option in row.iter("Enum")]
        index = -1 if found is None else int(_number(found.get("value")))
        return options[index] if 0 <= index < len(options) else index
    for tag in _NUMBERS:
        if (found := row.find(tag)) is not None:
            return _number(found.get("value"))
    if (found := row.find("Bool")) is not None:
        return found.get("value") == "true"
    found = row.find("String")
    return None if found is None else found.get("value", "")


def _placement(name: str, row: Any) -> Iterator[tuple[str, Any]]:
    if row is None:
        return
    for axis in "xyz":
        yield f"{name}.Base.{axis}", _number(row.get(f"P{axis}"))
    turn = [_number(row.get(f"Q{place}")) for place in range(4)]
    first = next((number for number in reversed(turn) if abs(number) > 1e-12), 1.0)
    yield f"{name}.Rotation", [number * math.copysign(1.0, first) + 0.0 for number in turn]  # q and -q are the same rotation


def _constraints(row: Any) -> Iterator[tuple[str, Any]]:
    keys = ("Type", "First", "FirstPos", "Second", "SecondPos", "Third", "ThirdPos", "IsDriving", "IsActive")
    for number, entry in enumerate(row.iter("Constrain")):
        name = entry.get("Name") or str(number)
        yield f"Constraints.{name}.between", [entry.get(key) for key in keys]
        yield f"Constraints.{name}", _number(entry.get("Value"))


def _number(text: str | None) -> float:
    try:
        number = float(text or 0.0)
    except ValueError:
        return 0.0
    return number if math.isfinite(number) else 0.0
