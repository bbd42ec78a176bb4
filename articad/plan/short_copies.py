"""Copies of the short form: parts and joints that are like others, and the mirror images of all that stands on one side."""

from __future__ import annotations

import copy
import json
from collections.abc import Mapping
from typing import Any, Final

from articad.aliases import Json
from articad.errors import PlanError
from articad.findings import Finding
from articad.plan.short_texts import by_name

SIDES: Final = (("_l", "_r"), ("_left", "_right"))
"""Ends of names of what stands on one side, and of its mirror image."""
MOST_COPIED: Final = 2_000_000
"""Characters of JSON that likenesses may repeat in a plan; a thousand parts repeat 0.2 million."""
_AXES: Final = ("x", "y", "z")
_OWN: Final = frozenset({"name", "rest_pose", "driver", "like"})  # not repeated in what is like it


def alike(entries: Any) -> Any:
    """Give each entry `{"like": NAME}` the fields of the entry of that name, but its place, its name and whether it is driven, unless it states them.

    Raises:
        PlanError: If more than `MOST_COPIED` characters are repeated.
    """
    known, room = by_name(entries), MOST_COPIED
    for name in known:
        chain = dict.fromkeys([name])  # each is like the next
        while (source := _source(known[next(reversed(chain))], known)) is not None and source not in chain:
            chain[source] = None
        for follower in reversed(chain):
            source = _source(known[follower], known)
            if source is None or "like" in known[source]:
                continue  # stays, and reading the plan reports it
            entry = known[follower]
            del entry["like"]
            copied = {key: value for key, value in known[source].items() if key not in _OWN and key not in entry}
            room -= len(json.dumps(copied))
            if room < 0:
                message = f"What is like other parts or joints would repeat more than {MOST_COPIED} characters of them."
                finding = Finding(
                    code="E_SCHEMA", where=follower, message=message, hint="Let fewer be like others, or state less of those."
                )
                raise PlanError(message, findings=[finding])
            entry |= copy.deepcopy(copied)
    return entries


def _source(entry: Json, known: Mapping[str, Json]) -> str | None:
    """Return the name of what an entry is like; None if it is like nothing that is known."""
    source = entry.get("like")
    return source if isinstance(source, str) and source in known else None


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
    images: dict[int, Json] = {}  # by the id of what they stand behind
    for name, part in parts.items():
        if (image := image_name(name)) and image not in parts:
            images[id(part)] = {"name": image, "derive": {"from": name, "op": "mirror", "plane": plane}}
    for name, joint in joints.items():
        if (image := image_name(name)) and image not in joints and "derive" not in joint:
            ends = {side: _other_side(joint.get(side)) for side in ("parent", "child")}
            images[id(joint)] = {"name": image, "derive": {"from": name, "op": "mirror"}, **ends}
    for entries in (plan["parts"], plan["joints"]):
        if isinstance(entries, list):
            entries[:] = [held for entry in entries for held in ([entry, images[id(entry)]] if id(entry) in images else [entry])]


def _other_side(reference: Any) -> Any:
    """Return a reference to the image of a part, or to the part itself where it has none."""
    name, dot, connector = str(reference).partition(".")
    return f"{image_name(name) or name}{dot}{connector}" if isinstance(reference, str) else reference


__all__ = ["add_mirror_images", "alike", "image_name", "plane_of"]
