"""Texts of the short form: a part, a joint, a place or a list of numbers in one line, and the object that each stands for.

Clauses end with `;`. A clause is a key and its value; the first of a joint is `TYPE PARENT CHILD [PIN]`, the first of a part its dimensions.
Nothing is refused here: what is wrong becomes a wrong field of the object, and reading the plan reports it at its address.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

from articad.aliases import Json

AXES: Final[Mapping[str, list[int]]] = {
    f"{sign}{axis}": [(-1 if sign == "-" else 1) * (axis == each) for each in "xyz"] for axis in "xyz" for sign in ("", "+", "-")
}
"""Directions by name."""

_JOINT_KEYS: Final[Mapping[str, str]] = {
    **{
        key: f"{key}_mm"
        for key in ("pin", "head", "tail", "length", "depth", "clearance", "bar", "ball", "eye", "reach", "shaft", "groove")
    },
    **{key: f"{key}_mm" for key in ("travel", "lead")},
    **{key: f"{key}_deg" for key in ("angle", "cone", "twist")},
    "on": "pin_on",
}
"""Fields of a joint by their short keys."""
CLAUSES: Final = (*_JOINT_KEYS, *_JOINT_KEYS.values(), "at", "rest", "fit", "mate", "driver", "blind")
"""What the clauses of a joint begin with, and the fields that they stand for."""
_WORDS: Final = frozenset({"endless", "auto", "child", "parent", "opposed", "aligned"})
_PART_KEYS: Final = frozenset({"material", "at", "turn", "like", "color", "envelope"})
AT_JOINT: Final = "joint"
"""As the place of a part: the origin of its frame is where the first joint is that has it as its child."""
_NUMBER: Final = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?")
_SIMPLE: Final = re.compile(r"\w+")


def split(text: str, mark: str = ",") -> list[str]:
    """Return the pieces of a text between marks that stand outside of parentheses, without spaces around them."""
    pieces, depth, start = [], 0, 0
    for place, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if letter == mark and depth == 0:
            pieces.append(text[start:place])
            start = place + 1
    return [piece.strip() for piece in (*pieces, text[start:])]


def number(text: str) -> Any:
    """Return the number that a text states, or the text, an expression."""
    if not _NUMBER.fullmatch(text):
        return text
    value = float(text)
    return int(value) if value.is_integer() else value


def value(text: str) -> Any:
    """Return a number, an expression, or a list of them."""
    pieces = split(text)
    return number(pieces[0]) if len(pieces) == 1 else [number(piece) for piece in pieces]


def equations(text: str) -> dict[str, Any] | None:
    """Return values by name: "width = 20, low = -t, gap" has the number 20, an expression, and a name for itself; None for anything else."""
    found: dict[str, Any] = {}
    for piece in split(text):
        name, equal, stated = (part.strip() for part in piece.partition("="))
        if not _SIMPLE.fullmatch(name) or (equal and not stated):
            return None
        found[name] = number(stated) if equal else name
    return found


def direction(text: str) -> Any:
    """Return the vector of an axis by its name, such as "-x", or of three numbers."""
    return [*AXES[text]] if text in AXES else value(text)


def place(text: str) -> list[Any] | None:
    """Return [o], [o, z] or [o, z, x] of "O along Z x X"; None if the text names no point, such as the name of a joint."""
    point, _, axes = text.partition(" along ")
    z, _, x = axes.strip().partition(" x ")
    stated = [value(point)]
    if not isinstance(stated[0], list):
        return None
    return [*stated, *(direction(axis.strip()) for axis in (z, x) if axis.strip())]


def joint(text: str) -> Json:
    """Return the object that a joint's text stands for."""
    first, *clauses = split(text, ";")
    kind, *names = first.split() or [""]
    ends = zip(("parent", "child", "by"), [*names[:2], " ".join(names[2:])], strict=False)
    stated: Json = {"type": kind} | {key: name for key, name in ends if name}
    if stated["type"] == "like" and names:
        stated = {"like": names[0]} | dict(zip(("parent", "child", "by"), names[1:], strict=False))
    for key, told in _clauses(clauses):
        stated |= _joint_field(key, told, stated)
    return stated


def _joint_field(key: str, told: str, stated: Json) -> Json:
    if key == "pin" and len(sizes := split(told)) == 2:
        return {"pin_mm": number(sizes[0]), "length_mm": number(sizes[1])}
    if key == "rest":
        return {"rest_mm" if stated.get("type") in ("slider", "drawer_slide") else "rest_deg": value(told)}
    if key == "fit" and "," in told:
        return {"fit": {"gap_mm": value(told)}}
    if key in ("at", "fit") or told in _WORDS:
        return {_JOINT_KEYS.get(key, key): told}
    return {_JOINT_KEYS.get(key, key): value(told) if told else True}


def part(text: str) -> Json:
    """Return the object that a part's text stands for; it stands at the joint that carries it, unless it states a place."""
    stated: Json = {"rest_pose": {"at": AT_JOINT}}
    for key, told in _clauses(split(text, ";")):
        if key not in _PART_KEYS:
            stated["dimensions"] = f"{key} {told}".strip()
        elif key == "at":
            stated["rest_pose"] |= {"at": value(told)}
        elif key == "turn":
            axis, _, angle = told.partition(" ")
            stated["rest_pose"] |= {"axis": direction(axis), "angle_deg": number(angle.strip())}
        else:
            stated[{"envelope": "envelope_mm"}.get(key, key)] = value(told) if key == "envelope" else told
    return stated


def _clauses(clauses: list[str]) -> Iterator[tuple[str, str]]:
    """Yield key and value of each clause that is not empty."""
    for clause in clauses:
        key, _, told = clause.partition(" ")
        if key:
            yield key, told.strip()


def frame(stated: Any) -> Json | None:
    """Return `o`, `z` and perhaps `x` of an object, a point, a list [o, z] or [o, z, x], or a text of a place; None for anything else."""
    if isinstance(stated, str):
        stated = place(stated)
    if isinstance(stated, dict):
        return {"o": [0, 0, 0], "z": [0, 0, 1]} | stated
    if not isinstance(stated, list) or not 1 <= len(stated) <= 3:
        return None
    if not any(isinstance(entry, list) for entry in stated):
        return {"o": stated, "z": [0, 0, 1]}
    return {"o": [0, 0, 0], "z": [0, 0, 1]} | dict(zip("ozx", stated, strict=False))


def objects(entries: Any) -> list[Json]:
    """Return the objects of a list; none of anything else."""
    return [entry for entry in entries if isinstance(entry, dict)] if isinstance(entries, list) else []


def by_name(entries: Any) -> dict[str, Json]:
    """Return the objects of a list that have a name, by it."""
    return {entry["name"]: entry for entry in objects(entries) if isinstance(entry.get("name"), str)}


def is_vector(stated: Any) -> bool:
    """Return whether a value is a list of three."""
    return isinstance(stated, list) and len(stated) == 3


def opened(document: Json, addresses: Mapping[str, Any]) -> Json:
    """Return a document of the short form in which parts, joints and lists that addresses lead into are objects in place of texts."""
    document = copy.deepcopy(document)
    if any(address.startswith("parameters.") for address in addresses) and isinstance(listed := document.get("parameters"), str):
        document["parameters"] = equations(listed) or listed
    for address in addresses:
        kind, _, rest = address.partition(".")
        name, inner, field = rest.partition(".")
        held = document.get(kind)
        form = {"parts": part, "joints": joint}.get(kind)
        if form is None or not inner or not isinstance(held, dict):
            continue
        if isinstance(held.get(name), str):
            held[name] = form(held[name])
        if isinstance(entry := held.get(name), dict) and field.startswith("dimensions.") and isinstance(entry.get("dimensions"), str):
            entry["dimensions"] = equations(entry["dimensions"]) or entry["dimensions"]
    return document


__all__ = ["AT_JOINT", "CLAUSES", "by_name", "equations", "frame", "is_vector", "joint", "objects", "opened", "part"]
