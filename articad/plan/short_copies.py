"""Copies of the short form: parts and joints that are like others, and the mirror images of all that stands on one side."""

from __future__ import annotations

from typing import Any, Final

from articad.aliases import Json
from articad.plan.short_texts import by_name

SIDES: Final = (("_l", "_r"), ("_left", "_right"))
"""Ends of names of what stands on one side, and of its mirror image."""
_AXES: Final = ("x", "y", "z")
_OWN: Final = frozenset({"name", "rest_pose", "driver", "like"})  # not repeated in what is like it


def alike(entries: Any) -> Any:
    """Give each entry `{"like": NAME}` the fields of the entry of that name, but its place, its name and whether it is driven, unless it states them."""
    known = by_name(entries)
    for name in known:
        _follow(name, known, ())
    return entries


def _follow(name: str, known: dict[str, Json], path: tuple[str, ...]) -> None:
    entry = known[name]
    source = entry.get("like")
    if not isinstance(source, str) or source not in known or source in (*path, name):
        return  # stays, and reading the plan reports it
    _follow(source, known, (*path, name))
    if "like" in known[source]:
        return
    del entry["like"]
    own = dict(entry)
    entry |= {key: value for key, value in known[source].items() if key not in _OWN and key not in own}


def plane_of(plan: Json) -> Json | None:
    """Return the plane in which a plan has mirror images: `"mirror": "x"` is the plane x = 0."""
    stated = plan.get("mirror")
    if isinstance(stated, dict):
        return stated
    return {"point": [0, 0, 0], "normal": [int(axis == stated) for axis in _AXES]} if stated in _AXES else None


def image_name(name: str) -> str | None:
    """Return the name of the mirror image of what stands on the left; None for anything else."""
    return next((name.removesuffix(left) + right for left, right in SIDES if name.endswith(left)), None)


def add_mirror_images(plan: Json) -> None:
    """Add the image of each part and joint on the left that the plan does not state, and remove its `mirror`."""
    plane = plane_of(plan)
    if plane is None:
        return
    del plan["mirror"]
    parts, joints = by_name(plan["parts"]), by_name(plan["joints"])
    for name in parts:
        if (image := image_name(name)) and image not in parts:
            _insert(plan["parts"], parts[name], {"name": image, "derive": {"from": name, "op": "mirror", "plane": plane}})
    for name, joint in joints.items():
        if (image := image_name(name)) and image not in joints and "derive" not in joint:
            ends = {side: _other_side(joint.get(side)) for side in ("parent", "child")}
            _insert(plan["joints"], joint, {"name": image, "derive": {"from": name, "op": "mirror"}, **ends})


def _insert(entries: list[Any], after: Json, image: Json) -> None:
    entries.insert(next(index for index, entry in enumerate(entries) if entry is after) + 1, image)


def _other_side(reference: Any) -> Any:
    """Return a reference to the image of a part, or to the part itself where it has none."""
    name, dot, connector = str(reference).partition(".")
    return f"{image_name(name) or name}{dot}{connector}" if isinstance(reference, str) else reference


__all__ = ["add_mirror_images", "alike", "image_name", "plane_of"]
