"""The short form of a plan, `articad.short/1`: what an author who also writes the scripts need not say twice.

`expanded` turns it into a plan of the form `articad.plan/1`, and nothing after that knows of it: checks, proofs and exports see the plan
alone. What it does not understand stays as it is, so that reading the plan reports it at its address.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Final

from articad.aliases import Json
from articad.plan import short_texts
from articad.plan.short_copies import add_mirror_images, alike
from articad.plan.short_joints import Joints
from articad.plan.short_texts import by_name, frame, objects
from articad.plan.signatures import Functions, functions_beside, with_arguments

SHORT: Final = "articad.short/1"
_LONG: Final = "articad.plan/1"

MATERIALS: Final[Mapping[str, tuple[int, str]]] = {
    "steel": (7850, "#8a9299"),
    "stainless_steel": (7900, "#b4b9bd"),
    "aluminium": (2700, "#c3c7cb"),
    "brass": (8500, "#c9a94e"),
    "bronze": (8800, "#a9713d"),
    "oak": (700, "#c29a63"),
    "beech": (720, "#d3a877"),
    "pine": (500, "#dfc08a"),
    "plywood": (680, "#cfae7c"),
    "mdf": (750, "#b08d63"),
    "abs": (1050, "#e6e2d8"),
    "pla": (1240, "#d8d8d8"),
    "petg": (1270, "#bfd3dd"),
    "nylon": (1140, "#ece8dc"),
    "pom": (1410, "#f2f2f0"),
    "acrylic": (1190, "#dfeef2"),
    "glass": (2500, "#cfe3e6"),
    "rubber": (1100, "#2e2e2e"),
}
"""Density [kg/m³] and colour of materials that need not be declared."""


def is_short(document: Any) -> bool:
    """Return whether a document says that it is a plan in the short form."""
    return isinstance(document, Mapping) and document.get("schema") == SHORT


def expanded(document: Any, functions: Functions | None = None) -> Any:
    """Return the plan that a document in the short form stands for; any other document as it is.

    Args:
        document: A JSON document; it is not modified.
        functions: The arguments of the functions that build its parts, by part: they are dimensions.
    """
    if not is_short(document):
        return document
    plan: Json = copy.deepcopy(dict(document)) | {"schema": _LONG}
    plan["parameters"] = _listed(_equations(plan.get("parameters", [])), _parameter)
    plan["parts"] = alike(_listed(plan.get("parts", []), _part))
    plan["joints"] = alike(_listed(plan.get("joints", []), _joint))
    if "couplings" in plan:
        plan["couplings"] = _listed(plan["couplings"], _whole)
    joints = Joints(plan)
    _give_material(plan)
    for part in objects(plan["parts"]):
        _complete(part)
        if "derive" not in part and (arguments := (functions or {}).get(str(part.get("name")))):
            with_arguments(part, arguments)
    joints.add_pins()
    add_mirror_images(plan)
    joints.place()
    _declare_materials(plan)
    return plan


def functions_of(document: Any, plan: Path) -> Functions | None:
    """Return the functions of scripts that build the parts of a document in the short form; None for any other document.

    Args:
        document: A JSON document.
        plan: Its file, beside which the scripts are.
    """
    if not is_short(document):
        return None
    parts = by_name(_listed(document.get("parts"), _part))
    return functions_beside(plan, [name for name, part in parts.items() if "derive" not in part])


def copied_fields(document: Any) -> dict[str, tuple[str, frozenset[str]]]:
    """Return, by the address of each part and joint that is like another, that other's address and the fields that it states itself."""
    found: dict[str, tuple[str, frozenset[str]]] = {}
    if not is_short(document):
        return found
    for kind, form in (("parts", _part), ("joints", _joint)):
        entries = by_name(_listed(document.get(kind), form))
        for name, entry in entries.items():
            if isinstance(source := entry.get("like"), str) and source in entries:
                found[f"{kind}.{name}"] = f"{kind}.{source}", frozenset(entry)
    return found


def joints_with_a_place(document: Any) -> list[str]:
    """Return the names of the joints of a document in the short form that state a place, at which other joints may stand."""
    joints = objects(_listed(document.get("joints"), _joint)) if is_short(document) else []
    return [str(joint.get("name")) for joint in joints if frame(joint.get("at")) is not None]


def _listed(entries: Any, form: Callable[[str, Any], Any]) -> Any:
    """Return the list that an object by name stands for."""
    return [form(name, value) for name, value in entries.items()] if isinstance(entries, dict) else entries


def _equations(stated: Any) -> Any:
    """Return values by name of a text such as "width = 20, depth = 2 * width"; anything else, as it is."""
    return stated if not isinstance(stated, str) or (found := short_texts.equations(stated)) is None else found


def _whole(name: str, value: Any) -> Any:
    return {"name": name} | value if isinstance(value, dict) else value


def _part(name: str, value: Any) -> Any:
    return _whole(name, short_texts.part(value) if isinstance(value, str) else value)


def _joint(name: str, value: Any) -> Any:
    return _whole(name, short_texts.joint(value) if isinstance(value, str) else value)


def _parameter(name: str, value: Any) -> Any:
    """Return a parameter of a number or an expression; a name that ends in _deg is an angle."""
    unit = {"unit": "deg"} if name.endswith("_deg") else {}
    return {"name": name} | unit | (value if isinstance(value, dict) else {"value": value})


def _give_material(plan: Json) -> None:
    """Give the plan's material to each part that states none."""
    if not isinstance(plan.get("material"), str):
        return
    material = plan.pop("material")
    for part in objects(plan["parts"]):
        if "derive" not in part:
            part.setdefault("material", material)


def _complete(part: Json) -> None:
    """Give a part that a script builds what it leaves out."""
    if "derive" in part:
        return
    part.setdefault("description", "")
    if isinstance(part.get("dimensions"), str | list):
        part["dimensions"] = _dimensions(part["dimensions"])
    connectors = part.get("connectors", [])
    part["connectors"] = _listed(connectors, _connector)


def _dimensions(stated: str | list[Any]) -> Any:
    """Return dimensions by name: "width, low = -t" has the parameter width and an expression."""
    found: dict[str, Any] = {}
    entries: Iterable[Any] = [stated] if isinstance(stated, str) else stated
    for entry in entries:
        held = short_texts.equations(entry) if isinstance(entry, str) else None
        if held is None:
            return stated
        found |= held
    return found


def _connector(name: str, stated: Any) -> Any:
    return {"name": name, "label": ""} | held if (held := frame(stated)) is not None else stated


def _declare_materials(plan: Json) -> None:
    """Declare the standard materials that parts name and the plan does not declare."""
    declared = plan.setdefault("materials", [])
    if not isinstance(declared, list):
        return
    known = by_name(declared)
    named = dict.fromkeys(str(part.get("material")) for part in objects(plan["parts"]))
    for name in named:
        if name in MATERIALS and name not in known:
            density, color = MATERIALS[name]
            declared.append({"name": name, "density_kg_m3": density, "color": color})


__all__ = ["MATERIALS", "SHORT", "copied_fields", "expanded", "functions_of", "is_short", "joints_with_a_place"]
