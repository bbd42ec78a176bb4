"""The short form of a plan, `articad.short/1`: what an author who also writes the scripts need not say twice.

`expanded` turns it into a plan of the form `articad.plan/1`, and nothing after that knows of it: checks, proofs and exports see the plan
alone. What it does not understand stays as it is, so that reading the plan reports it at its address.
"""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Callable, Mapping
from typing import Any, Final

from articad.aliases import Json
from articad.plan.fields import is_name
from articad.plan.standard_joints import STANDARD, made_of

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

_DIMENSION = re.compile(r"\s*(\w+)\s*(?:=\s*(.+))?\Z", re.DOTALL)


def is_short(document: Any) -> bool:
    """Return whether a document says that it is a plan in the short form."""
    return isinstance(document, Mapping) and document.get("schema") == SHORT


def expanded(document: Any) -> Any:
    """Return the plan that a document in the short form stands for; any other document as it is.

    Args:
        document: A JSON document; it is not modified.
    """
    if not is_short(document):
        return document
    plan: Json = copy.deepcopy(dict(document)) | {"schema": _LONG}
    plan["parameters"] = _listed(plan.get("parameters", []), _parameter)
    plan["parts"] = _listed(plan.get("parts", []), _whole)
    plan["joints"] = _listed(plan.get("joints", []), _whole)
    if "couplings" in plan:
        plan["couplings"] = _listed(plan["couplings"], _whole)
    for part in _objects(plan["parts"]):
        _complete(part)
    _Joints(plan).place()
    _declare_materials(plan)
    return plan


def joints_with_a_place(document: Any) -> list[str]:
    """Return the names of the joints of a document in the short form that state a place, at which other joints may stand."""
    joints = _objects(_listed(document.get("joints"), _whole)) if is_short(document) else []
    return [str(joint.get("name")) for joint in joints if _frame(joint.get("at")) is not None]


def _listed(entries: Any, form: Callable[[str, Any], Any]) -> Any:
    """Return the list that an object by name stands for."""
    return [form(name, value) for name, value in entries.items()] if isinstance(entries, dict) else entries


def _objects(entries: Any) -> list[Json]:
    return [entry for entry in entries if isinstance(entry, dict)] if isinstance(entries, list) else []


def _by_name(entries: Any) -> dict[str, Json]:
    return {entry["name"]: entry for entry in _objects(entries) if isinstance(entry.get("name"), str)}


def _is_vector(stated: Any) -> bool:
    return isinstance(stated, list) and len(stated) == 3


def _whole(name: str, value: Any) -> Any:
    return {"name": name} | value if isinstance(value, dict) else value


def _parameter(name: str, value: Any) -> Any:
    """Return a parameter of a number or an expression; a name that ends in _deg is an angle."""
    unit = {"unit": "deg"} if name.endswith("_deg") else {}
    return {"name": name} | unit | (value if isinstance(value, dict) else {"value": value})


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
    found = {}
    for entry in stated.split(",") if isinstance(stated, str) else stated:
        match = _DIMENSION.match(entry) if isinstance(entry, str) else None
        if match is None:
            return stated
        found[match[1]] = match[2].strip() if match[2] else match[1]
    return found


def _connector(name: str, stated: Any) -> Any:
    return {"name": name, "label": ""} | frame if (frame := _frame(stated)) is not None else stated


def _frame(stated: Any) -> Json | None:
    """Return `o`, `z` and perhaps `x` of an object, of a point, or of a list [o, z] or [o, z, x]; None for anything else."""
    if isinstance(stated, dict):
        return {"o": [0, 0, 0], "z": [0, 0, 1]} | stated
    if not isinstance(stated, list) or not 1 <= len(stated) <= 3:
        return None
    if not any(isinstance(entry, list) for entry in stated):
        return {"o": stated, "z": [0, 0, 1]}
    return {"o": [0, 0, 0], "z": [0, 0, 1]} | dict(zip("ozx", stated, strict=False))


class _Joints:
    """Joints that state their place once, and standard joints: they add connectors and dimensions to their parts."""

    def __init__(self, plan: Json) -> None:
        self.parts = _by_name(plan["parts"])
        self.joints = _by_name(plan["joints"])
        self._places: dict[str, Json] = {}  # of joints that state one

    def place(self) -> None:
        """Write out every joint, those that others derive from first."""
        for joint in sorted(self.joints.values(), key=lambda joint: ("derive" in joint, isinstance(joint.get("at"), str))):
            if "derive" in joint:
                self._derived(joint)
                continue
            if isinstance(kind := joint.get("type"), str) and kind in STANDARD:
                self._standard(joint)
            stated = joint.get("at")
            frame = self._places.get(stated) if isinstance(stated, str) else _frame(stated)
            if frame is not None:
                joint.pop("at")
                self._places[joint["name"]] = frame
                for side in ("parent", "child"):
                    self._attach(joint, side, frame)

    def _standard(self, joint: Json) -> None:
        """Replace a standard joint by a joint of the plan, and give its two parts the dimensions of its features."""
        features = made_of(joint)
        for side, dimensions in features.items():
            part = self.parts.get(str(joint.get(side, "")).partition(".")[0], {})
            if "derive" not in part and isinstance(held := part.setdefault("dimensions", {}), dict):
                connector = str(joint.get(side, "")).partition(".")[2] or joint["name"]
                held.update({f"{connector}_{key}": value for key, value in dimensions.items()})

    def _attach(self, joint: Json, side: str, frame: Json) -> None:
        """Give a part that is named without a connector one at the joint's place; only one of the two states x."""
        name = joint.get(side)
        part = self.parts.get(name) if isinstance(name, str) else None
        if part is None or "derive" in part or not isinstance(part.get("connectors"), list):
            return
        kept = {key: value for key, value in frame.items() if key != "x" or side == "parent"}
        part["connectors"].append({"name": joint["name"], "frame": "assembly", "label": ""} | kept)
        joint[side] = f"{name}.{joint['name']}"

    def _derived(self, joint: Json) -> None:
        """Name the connectors of a derived joint: a copy has its source's; a part of its own gets one at the image of the source's place."""
        stated = joint["derive"]
        source = self.joints.get(str(stated.get("from"))) if isinstance(stated, dict) else None
        if source is None:
            return
        named = {side: self.parts.get(str(joint.get(side)).partition(".")[0], {}) for side in ("parent", "child")}
        copies = [part["derive"] for part in (named["child"], named["parent"]) if "derive" in part]
        frame = _image(self._places.get(str(source["name"])), copies[0]) if copies else None
        for side, part in named.items():
            if not is_name(str(joint.get(side, "."))):  # names its connector
                continue
            if "derive" in part or not part:  # not in the plan by this name: a copy of a pattern
                joint[side] = f"{joint[side]}.{str(source.get(side, '')).rpartition('.')[2]}"
            elif frame is not None:
                self._attach(joint, side, frame)
                self._places[joint["name"]] = frame
                self._repeat(source, side, str(joint["name"]), part)
                if side == "child":  # then it is no image for the plan, and is written in full
                    _write_out(joint, source)

    def _repeat(self, source: Json, side: str, name: str, part: Json) -> None:
        """Give a part the dimensions of a standard joint that the source's part has on the same side, for the image of that joint."""
        first, _, connector = str(source.get(side, "")).partition(".")
        held, own = self.parts.get(first, {}).get("dimensions"), part.setdefault("dimensions", {})
        if isinstance(held, dict) and isinstance(own, dict):
            keys = [key for key in held if any(key == f"{connector}_{word}" for word in FEATURES)]
            own.update({key.replace(connector, name, 1): held[key] for key in keys})


def _write_out(joint: Json, source: Json) -> None:
    """Replace a derived joint by one with the source's fields but those that it states; a mirror image turns the other way."""
    turned = joint["derive"].get("op") == "mirror"
    if turned and source["type"] not in ("fixed", "revolute", "slider"):
        return  # stays derived, and the plan's check refuses it
    image = copy.deepcopy(source)
    if turned and source["type"] == "revolute":
        if isinstance(limits := image.get("angle_deg"), list):
            image["angle_deg"] = [_negative(value) for value in reversed(limits)]
        if "rest_deg" in image:
            image["rest_deg"] = _negative(image["rest_deg"])
    own = {key: value for key, value in joint.items() if key != "derive"}
    joint.clear()
    joint.update(image | own)


FEATURES: Final = (
    *("pin", "bore", "length", "depth", "span", "gap", "reach", "groove", "width", "shaft"),
    *("bar_x", "bar_y", "slot_x", "slot_y", "ball", "socket"),
)


def _image(frame: Json | None, derive: Any) -> Json | None:
    """Return a place moved as a copy is moved: by a plane across an axis of the assembly, or by a shift; None for other motions."""
    if frame is None or not isinstance(derive, dict):
        return None
    image = {key: [*vector] for key, vector in frame.items() if key in "ozx" and _is_vector(vector)}
    if not {"o", "z"} <= image.keys():
        return None
    plane, move = derive.get("plane"), derive.get("move")
    if derive.get("op") == "mirror" and isinstance(plane, dict):
        normal, through = plane.get("normal"), plane.get("point", [0, 0, 0])
        across = [at for at, value in enumerate(normal) if not _is_zero(value)] if isinstance(normal, list) and len(normal) == 3 else []
        if not isinstance(normal, list) or not _is_vector(through) or len(across) != 1 or not _is_number(normal[across[0]]):
            return None
        (axis,) = across
        for vector in image.values():
            vector[axis] = _negative(vector[axis])
        if not _is_zero(point := through[axis]):
            image["o"][axis] = f"2*({point})+({image['o'][axis]})"
        return image
    if derive.get("op") == "rigid" and isinstance(move, dict) and set(move) <= {"at"} and _is_vector(shift := move.get("at", [0, 0, 0])):
        image["o"] = [a if _is_zero(b) else f"({a})+({b})" for a, b in zip(image["o"], shift, strict=True)]
        return image
    return None


def _is_number(value: Any) -> bool:
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError):
        return False


def _is_zero(value: Any) -> bool:
    return _is_number(value) and float(value) == 0.0


def _negative(value: Any) -> Any:
    return -value if isinstance(value, int | float) and value else value if not value else f"-({value})"


def _declare_materials(plan: Json) -> None:
    """Declare the standard materials that parts name and the plan does not declare."""
    declared = plan.setdefault("materials", [])
    if not isinstance(declared, list):
        return
    known = _by_name(declared)
    named = dict.fromkeys(str(part.get("material")) for part in _objects(plan["parts"]))
    for name in named:
        if name in MATERIALS and name not in known:
            density, color = MATERIALS[name]
            declared.append({"name": name, "density_kg_m3": density, "color": color})


__all__ = ["MATERIALS", "SHORT", "expanded", "is_short"]
