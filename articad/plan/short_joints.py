"""Joints of the short form: places that are stated once, standard joints, and pins that are parts of their own."""

from __future__ import annotations

import copy
import math
from typing import Any

from articad.aliases import Json
from articad.plan.fields import is_name
from articad.plan.short_copies import plane_of
from articad.plan.short_texts import AT_JOINT, by_name, frame, is_vector
from articad.plan.standard_joints import FEATURES, STANDARD, made_of, pin_of


class Joints:
    """Joints that state their place once, and standard joints: they add connectors and dimensions to their parts."""

    def __init__(self, plan: Json) -> None:
        self._plan = plan
        self._mirror = {"op": "mirror", "plane": plane} if (plane := plane_of(plan)) else None
        self._places: dict[str, Json] = {}  # of joints that state one
        self._read()

    def _read(self) -> None:
        self.parts, self.joints = by_name(self._plan["parts"]), by_name(self._plan["joints"])

    def add_pins(self) -> None:
        """Add the pin of each hinge that turns on one, `"by": PIN`, and the joint that fixes it in the parent."""
        fixing: dict[int, Json] = {}  # joints by the id of the hinge that they stand before
        for joint in self.joints.values():
            pin = joint.get("by")
            if joint.get("type") != "hinge" or not isinstance(pin, str) or pin in self.joints or not isinstance(self._plan["parts"], list):
                continue  # stays, and reading the plan reports it
            part = self.parts.get(pin)
            if part is None:
                part = {"name": pin, "material": "steel", "description": "Pin.", "rest_pose": {"at": AT_JOINT}, "connectors": []}
                self._plan["parts"].append(part)
            fixing[id(joint)], dimensions = pin_of(joint, pin)
            if isinstance(held := part.setdefault("dimensions", {}), dict):
                held.update(dimensions)
        if fixing:
            self._plan["joints"] = [
                held for joint in self._plan["joints"] for held in ([fixing[id(joint)], joint] if id(joint) in fixing else [joint])
            ]
        self._read()

    def place(self) -> None:
        """Write out every joint, those that others derive from first, and place the parts that stand at a joint."""
        self._read()
        self._place_joints()
        children: dict[str, str] = {}
        for name, joint in self.joints.items():
            if name in self._places:
                children.setdefault(str(joint.get("child", "")).partition(".")[0], name)
        for name, part in self.parts.items():
            pose = part.get("rest_pose")
            if isinstance(pose, dict) and pose.get("at") == AT_JOINT:
                del pose["at"]
                if name in children and name != self._plan.get("ground"):
                    pose["at"] = self._places[children[name]]["o"]
                if not pose:
                    del part["rest_pose"]

    def _place_joints(self) -> None:
        for joint in sorted(self.joints.values(), key=lambda joint: ("derive" in joint, frame(joint.get("at")) is None)):
            if "derive" in joint:
                self._derived(joint)
                continue
            if isinstance(kind := joint.get("type"), str) and kind in STANDARD:
                self._standard(joint)
            stated = joint.get("at")
            place = self._places.get(stated) if isinstance(stated, str) and stated in self._places else frame(stated)
            if place is not None:
                joint.pop("at")
                self._places[joint["name"]] = place
                for side in ("parent", "child"):
                    self._attach(joint, side, place)

    def _standard(self, joint: Json) -> None:
        """Replace a standard joint by a joint of the plan, and give its two parts the dimensions of its features."""
        features = made_of(joint)
        for side, dimensions in features.items():
            part = self.parts.get(str(joint.get(side, "")).partition(".")[0], {})
            if "derive" not in part and isinstance(held := part.setdefault("dimensions", {}), dict):
                connector = str(joint.get(side, "")).partition(".")[2] or joint["name"]
                held.update({f"{connector}_{key}": value for key, value in dimensions.items()})

    def _attach(self, joint: Json, side: str, place: Json) -> None:
        """Give a part that is named without a connector one at the joint's place; only one of the two states x."""
        name = joint.get(side)
        part = self.parts.get(name) if isinstance(name, str) else None
        if part is None and isinstance(name, str) and is_name(name):
            joint[side] = f"{name}.{joint['name']}"  # the check of the plan says that there is no such part
        if part is None or "derive" in part or not isinstance(part.get("connectors"), list):
            return
        kept = {key: value for key, value in place.items() if key != "x" or side == "parent"}
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
        if not copies and self._mirror and stated.get("op") == "mirror":
            copies = [self._mirror]
        place = _image(self._places.get(str(source["name"])), copies[0]) if copies else None
        for side, part in named.items():
            if not is_name(str(joint.get(side, "."))):  # names its connector
                continue
            if "derive" in part or not part:  # not in the plan by this name: a copy of a pattern
                joint[side] = f"{joint[side]}.{str(source.get(side, '')).rpartition('.')[2]}"
            elif place is not None:
                self._attach(joint, side, place)
                self._places[joint["name"]] = place
                self._repeat(source, side, str(joint["name"]), part)
                if side == "child":  # then it is no image for the plan, and is written in full
                    _write_out(joint, source)

    def _repeat(self, source: Json, side: str, name: str, part: Json) -> None:
        """Give a part the dimensions of a standard joint that the source's part has on the same side, for the image of that joint."""
        first, _, connector = str(source.get(side, "")).partition(".")
        held, own = self.parts.get(first, {}).get("dimensions"), part.setdefault("dimensions", {})
        if isinstance(held, dict) and isinstance(own, dict):
            wanted = {f"{connector}_{word}" for word in FEATURES}
            keys = [key for key in held if key in wanted]
            own.update({key.replace(connector, name, 1): held[key] for key in keys})


def _write_out(joint: Json, source: Json) -> None:
    """Replace a derived joint by one with the source's fields but those that it states; a mirror image turns the other way."""
    turned, kind = joint["derive"].get("op") == "mirror", source.get("type")
    if turned and kind not in ("fixed", "revolute", "slider"):
        return  # stays derived, and the plan's check refuses it
    image = copy.deepcopy(source)
    if turned and kind == "revolute":
        if isinstance(limits := image.get("angle_deg"), list):
            image["angle_deg"] = [_negative(value) for value in reversed(limits)]
        if "rest_deg" in image:
            image["rest_deg"] = _negative(image["rest_deg"])
    own = {key: value for key, value in joint.items() if key != "derive"}
    joint.clear()
    joint.update(image | own)


def _image(place: Json | None, derive: Any) -> Json | None:
    """Return a place moved as a copy is moved: by a plane across an axis of the assembly, or by a shift; None for other motions."""
    if place is None or not isinstance(derive, dict):
        return None
    image = {key: [*vector] for key, vector in place.items() if key in "ozx" and is_vector(vector)}
    if not {"o", "z"} <= image.keys():
        return None
    plane, move = derive.get("plane"), derive.get("move")
    if derive.get("op") == "mirror" and isinstance(plane, dict):
        normal, through = plane.get("normal"), plane.get("point", [0, 0, 0])
        across = [at for at, value in enumerate(normal) if not _is_zero(value)] if isinstance(normal, list) and len(normal) == 3 else []
        if not isinstance(normal, list) or not is_vector(through) or len(across) != 1 or not _is_number(normal[across[0]]):
            return None
        (axis,) = across
        for vector in image.values():
            vector[axis] = _negative(vector[axis])
        if not _is_zero(point := through[axis]):
            image["o"][axis] = f"2*({point})+({image['o'][axis]})"
        return image
    if derive.get("op") == "rigid" and isinstance(move, dict) and set(move) <= {"at"} and is_vector(shift := move.get("at", [0, 0, 0])):
        image["o"] = [a if _is_zero(b) else f"({a})+({b})" for a, b in zip(image["o"], shift, strict=True)]
        return image
    return None


def _is_number(value: Any) -> bool:
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError, OverflowError):
        return False


def _is_zero(value: Any) -> bool:
    return _is_number(value) and float(value) == 0.0


def _negative(value: Any) -> Any:
    return -value if isinstance(value, int | float) and value else value if not value else f"-({value})"


__all__ = ["Joints"]
