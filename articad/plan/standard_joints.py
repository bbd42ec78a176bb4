"""Standard joints: a joint of the plan with the features that make it, as dimensions of its two parts.

A script adds them with `part.made(shape)`; the checks measure them as they measure everything that a script draws.
"""

from __future__ import annotations

import copy
from collections.abc import Container, Iterable, Mapping
from typing import Any, Final

from articad.aliases import Json

STANDARD: Final[Mapping[str, str]] = {
    "hinge": "revolute",
    "pin_in_clevis": "revolute",
    "dowel": "fixed",
    "snap_ring": "fixed",
    "drawer_slide": "slider",
    "ball_socket": "ball",
}
"""The plan's joint type by standard joint."""

FEATURES: Final[Mapping[str, str]] = {
    "pin": "the diameter of the pin",
    "length": "the length of the pin or bar",
    "head": "the diameter of the pin's head",
    "thick": "the thickness of the pin's head",
    "tail": "the length of the shank behind the pin's head",
    "bore": "the diameter of the bore",
    "depth": "the depth of the hole",
    "span": "the length of the pin across the fork",
    "gap": "the width of the fork's opening",
    "reach": "the radius within which the fork is open",
    "groove": "the diameter of the groove",
    "width": "the width of the groove",
    "shaft": "the diameter of the shaft around the groove",
    "bar_x": "the width of the bar along x",
    "bar_y": "the width of the bar along y",
    "slot_x": "the width of the slot along x",
    "slot_y": "the width of the slot along y",
    "ball": "the diameter of the ball",
    "socket": "the diameter of the socket",
}
"""What a dimension `<connector>_<feature>` of a standard joint is, by its feature."""
_BESIDE: Final[Mapping[str, tuple[str, ...]]] = {
    "length": ("pin", "bar_x"),
    "depth": ("bore", "slot_x"),
    **dict.fromkeys(("head", "thick", "tail", "span"), ("pin",)),
    "gap": ("reach",),
    "reach": ("gap",),
    "width": ("groove",),
    "shaft": ("groove",),
    "groove": ("shaft",),
}
"""Features beside one of which alone a feature is one of a standard joint: `lid_length` may also be the length of a lid."""
CUT: Final = frozenset({"bore", "depth", "gap", "reach", "groove", "width", "slot_x", "slot_y", "socket"})
"""Features that take material away."""
_BLIND: Final = frozenset({"hinge", "dowel", "drawer_slide"})
"""Standard joints whose hole may end where their pin or bar ends."""

CLEARANCE_MM: Final = 0.15
"""Half the difference of diameters where a plan states none: turns and slides freely, also when printed or sawn."""


def made_of(joint: Json) -> dict[str, dict[str, Any]]:
    """Turn a standard joint into a joint of the plan, in place; return the dimensions of its features by side, "parent" and "child".

    The joint may have `pin_mm` (hinge, dowel: diameter), `bar_mm` [x, y] (drawer_slide) or `ball_mm` (ball_socket: diameter), `length_mm`
    of the pin or bar from the joint's origin along its +z (0: the part has it already), `depth_mm` of the hole, or `blind`: the hole ends `clearance_mm` behind the end of the pin
    or bar (without either, it goes through), and `pin_on`: the side that has the pin, bar or ball ("parent").

    A `pin_in_clevis` has a pin of `length_mm` across a fork, centred on the joint, and an eye of `eye_mm` along z between the cheeks; the fork is
    cut out within `reach_mm` of the axis. A `snap_ring` sits in a groove of `groove_mm` [diameter, width] in a shaft of `shaft_mm`.
    """
    kind = joint["type"]
    joint["type"] = STANDARD[kind]
    size = joint.pop({"drawer_slide": "bar_mm", "ball_socket": "ball_mm"}.get(kind, "pin_mm"), None)
    length = joint.pop("length_mm", None)
    clearance = joint.pop("clearance_mm", 0 if kind == "dowel" else CLEARANCE_MM)
    depth = _depth(joint, kind, length, clearance)
    inner = joint.get("pin_on", "parent")
    if inner in ("parent", "child"):
        joint.pop("pin_on", None)
    else:  # stays, and reading the plan reports it
        inner = "parent"
    outer = "child" if inner == "parent" else "parent"
    pin: dict[str, Any]
    hole: dict[str, Any]
    if kind == "drawer_slide" and isinstance(size, list) and len(size) == 2:
        pin = {"bar_x": size[0], "bar_y": size[1]}
        hole = {"slot_x": _wider(size[0], clearance), "slot_y": _wider(size[1], clearance)}
    elif kind == "pin_in_clevis":
        pin = {"pin": size, "span": length, "gap": _wider(joint.pop("eye_mm", None), clearance), "reach": joint.pop("reach_mm", None)}
        hole, length = {"bore": _wider(size, clearance)}, None
    elif kind == "snap_ring":
        groove = joint.pop("groove_mm", None)
        diameter, width = groove if isinstance(groove, list) and len(groove) == 2 else (groove, groove)
        pin, hole, length = {"groove": diameter, "width": width, "shaft": joint.pop("shaft_mm", None)}, {"bore": diameter}, None
    elif kind == "ball_socket":
        pin, hole, length = {"ball": size}, {"socket": _wider(size, clearance)}, None
    else:
        pin, hole = {"pin": size}, {"bore": _wider(size, clearance)}
    if length == 0:  # the part has the pin or bar already
        pin = {}
    elif length is not None:
        pin["length"] = length
    if depth is not None:
        hole["depth"] = depth
    if kind in ("hinge", "pin_in_clevis", "drawer_slide") and clearance:
        joint.setdefault("fit", {"gap_mm": [f"({clearance})/2", f"({clearance})*3/2"], "contact": "allowed"})
    return {inner: pin, outer: hole}


def _depth(joint: Json, kind: str, length: Any, clearance: Any) -> Any:
    """Take the depth of the hole out of a joint; None if it goes through."""
    depth = joint.pop("depth_mm", None)
    if joint.get("blind") is True and kind in _BLIND and length and depth is None:
        del joint["blind"]
        return _sum(length, clearance)
    return depth


def pin_of(joint: Json, name: str) -> tuple[Json, dict[str, Any]]:
    """Let a hinge turn on a pin that is a part of its own, in place; return the joint that fixes the pin, and what the pin adds to its shank.

    The joint stands where the shank leaves the head, its +z along the shank of `length_mm`. `head_mm` [diameter, thickness] lies behind it, and
    `tail_mm` of shank behind the head. The pin is pressed into the parent; the child turns on it. With `blind`, the hole of the parent ends where the
    shank does, too, unless the parent is behind the head.

    Args:
        joint: A hinge.
        name: The pin's name, and that of the joint that fixes it.
    """
    del joint["by"]
    joint.pop("pin_on", None)
    head, tail = joint.pop("head_mm", None), joint.pop("tail_mm", None)
    press = {"name": name, "type": "dowel", "parent": joint.get("parent"), "child": name, "pin_on": "child", "length_mm": 0}
    press |= {key: copy.deepcopy(joint[key]) for key in ("pin_mm", "at") if key in joint}
    if joint.get("blind") is True and tail is None and joint.get("length_mm"):
        press["depth_mm"] = joint["length_mm"]
    joint["parent"] = name
    sizes = {} if head is None else dict(zip(("head", "thick"), head if isinstance(head, list) else [head], strict=False))
    sizes |= {} if tail is None else {"tail": tail}
    return press, {f"{joint['name']}_{key}": size for key, size in sizes.items()}


def is_pin(dimensions: Mapping[str, Any]) -> bool:
    """Return whether the dimensions of a part are those of one pin, and nothing else."""
    found = {name.rpartition("_")[::2] for name in dimensions}
    sizes = {size for _, size in found}
    return len({joint for joint, _ in found}) == 1 and {"pin", "length"} <= sizes <= {"pin", "length", "head", "thick", "tail"}


def feature_of(dimension: str, dimensions: Container[str], connectors: Iterable[str]) -> tuple[str, str] | None:
    """Return the connector and the feature of a standard joint that a dimension of a part is named after; None for other dimensions."""
    for name in connectors:
        feature = dimension.removeprefix(f"{name}_")
        beside = _BESIDE.get(feature, (feature,))
        if f"{name}_{feature}" == dimension and feature in FEATURES and any(f"{name}_{other}" in dimensions for other in beside):
            return name, feature
    return None


def _wider(size: Any, clearance: Any) -> Any:
    if isinstance(size, int | float) and isinstance(clearance, int | float):
        return _sum(size, 2 * clearance)
    return f"({size})+2*({clearance})" if clearance else size


def _sum(size: Any, more: Any) -> Any:
    if not (isinstance(size, int | float) and isinstance(more, int | float)):
        return f"({size})+({more})" if more else size
    try:
        return round(size + more, 9)
    except OverflowError:  # a whole number larger than any float: reading the plan reports it
        return max(size, more, key=abs)


__all__ = ["CLEARANCE_MM", "CUT", "FEATURES", "STANDARD", "feature_of", "is_pin", "made_of", "pin_of"]
