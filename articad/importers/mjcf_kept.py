"""What an MJCF file says beyond bodies, joints, shapes and equalities: every element and attribute that is not read, by name.

MuJoCo's compiler resolves defaults, classes, frames, includes and copies; the reader takes what is left of these from the compiled model.
`READ` lists the attributes whose meaning arrives in the assembly that way. Everything else, known to MuJoCo or not, becomes a `Kept`
without XML: its names refer to geoms, sites and tendons that an assembly does not have, so no writer can put it back.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from articad.assembly import Kept
from articad.importers.reading import read_xml

__all__ = ["READ", "kept_attributes"]

ALL: Final = frozenset({"*"})
_PLACE = frozenset({"pos", "quat", "axisangle", "xyaxes", "zaxis", "euler"})
_BODY = _PLACE | {"name", "childclass"}
_JOINT = frozenset(
    {"name", "class", "type", "pos", "axis", "limited", "range", "ref", "damping", "frictionloss", "actuatorfrclimited", "actuatorfrcrange"}
) | {"armature", "stiffness", "springref"}  # these three are kept joint by joint
_GEOM = _PLACE | {"name", "class", "type", "size", "fromto", "mesh", "fitscale", "mass", "density", "shellinertia", "rgba", "material"}
_TIE = frozenset({"name", "class", "active"})

READ: Final[Mapping[str, frozenset[str]]] = {
    "mujoco": frozenset({"model"}),
    "compiler": ALL,
    "default": frozenset({"class"}),
    "worldbody": ALL,
    "asset": ALL,
    "equality": ALL,
    "keyframe": ALL,
    "include": ALL,
    "body": _BODY,
    "frame": ALL,
    "replicate": ALL,
    "attach": ALL,
    "inertial": ALL,
    "joint": _JOINT,
    "freejoint": frozenset({"name"}),
    "geom": _GEOM,
    "asset/mesh": ALL,
    "asset/model": ALL,
    "asset/material": frozenset({"name", "class", "rgba"}),
    "default/mesh": ALL,
    "default/material": frozenset({"rgba"}),
    "default/equality": frozenset({"active"}),
    "equality/connect": _TIE | {"anchor", "body1", "body2", "site1", "site2"},
    "equality/weld": _TIE | {"anchor", "relpose", "body1", "body2", "site1", "site2"},
    "equality/joint": _TIE | {"joint1", "joint2", "polycoef"},
    "keyframe/key": frozenset({"name", "qpos"}),
}
"""Attributes that are read, by tag, or by section and tag; `*` for all of them."""

_SECTIONS = frozenset({"default", "asset", "equality", "keyframe"})
_COLLIDES = frozenset({"contype", "conaffinity"})  # 0 and 1 say whether it collides, which is read
_NAMES = 6  # that a row lists
_PREFIX = "articad."  # of our own records
_WRITTEN = {"gravity": ("0", "0", "-9.81"), "timestep": ("0.002",), "integrator": ("implicitfast",)}


def kept_attributes(document: Any, path: Path) -> list[Kept]:
    """Return what an MJCF document and its includes say that is not read, one row for each kind of element or attribute.

    Args:
        document: The root element.
        path: Of the file; includes are found beside it.
    """
    rows: dict[str, list[str]] = {}
    for what, name in _unread(document, "", path, {path.resolve()}):
        rows.setdefault(what, []).append(name)
    return [Kept("mjcf", "model", _listed(what, names)) for what, names in rows.items()]


def _listed(what: str, names: list[str]) -> str:
    known = [name for name in names if name]
    listed = ", ".join(known[:_NAMES]) + (f" and {len(known) - _NAMES} others" if len(known) > _NAMES else "")
    count = f", {len(names)} times" if len(names) > 1 else ""
    return f"{what}{count}{f': {listed}' if listed else ''}"


def _unread(element: Any, section: str, path: Path, seen: set[Path]) -> Iterator[tuple[str, str]]:
    """Yield what is not read of an element and below, and the name of what has it."""
    tag, name = element.tag, _name(element)
    key = _key(element, section)
    if key is None:
        yield from _whole(element)
        return
    read = READ[key]
    for attribute, value in element.attrib.items():
        if "*" not in read and attribute not in read and not (attribute in _COLLIDES and tag == "geom" and value in {"0", "1"}):
            yield f"{attribute} of <{tag}>", name
    if tag in {"geom", "material"} and len(words := element.get("rgba", "").split()) == 4 and words[3] not in {"1", "1.0"}:
        yield f"transparency of <{tag}>", name
    inside = tag if tag in _SECTIONS and not section else section
    for below in (*_included(element, path, seen), *element):
        yield from _unread(below, inside, path, seen)


def _key(element: Any, section: str) -> str | None:
    """Return the key of `READ` that speaks of an element; None where it is not read at all."""
    tag = element.tag
    if f"{section}/{tag}" in READ:
        return f"{section}/{tag}" if tag != "key" or element.get("name") == "home" else None
    # in a section, what stands in bodies has another meaning; in defaults it has the same
    return tag if tag in READ and (section in {"", "default"} or tag == "include") else None


def _whole(element: Any) -> Iterator[tuple[str, str]]:
    """Yield an element that is not read: a section by what it holds, settings one by one, others by name."""
    tag = element.tag
    if tag == "option":
        yield from ((f"{attribute} {value} of <option>", "") for attribute, value in element.attrib.items() if not _ours(attribute, value))
        yield from ((f"<{below.tag}> of <option>", "") for below in element)
    elif len(element) and not element.attrib:
        yield from ((f"<{below.tag}> of <{tag}>", below.get("name") or "") for below in element if not _own_record(below))
    elif not _own_record(element):
        yield f"<{tag}>", _name(element)


def _included(element: Any, path: Path, seen: set[Path]) -> list[Any]:
    """Return what an include brings; each file once."""
    if element.tag != "include":
        return []
    target = (path.parent / element.get("file", "")).resolve()
    if target in seen or not target.is_file():
        return []
    seen.add(target)
    return list(read_xml(target))


def _name(element: Any) -> str:
    return str(element.get("name") or element.get("class") or "")


def _own_record(element: Any) -> bool:
    return element.tag == "text" and str(element.get("name", "")).startswith(_PREFIX)


def _ours(attribute: str, value: str) -> bool:
    """True for a setting that `write_mjcf` writes as well."""
    return tuple(value.split()) == _WRITTEN.get(attribute)
