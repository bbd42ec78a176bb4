"""Data of an MJCF file beyond bodies, joints, shapes and equalities: every element and attribute that is not read, by name.

MuJoCo's compiler resolves defaults, classes, frames, includes and copies; the reader takes their results from the compiled model. `READ`
lists the attributes whose meaning reaches the assembly that way, or is kept with it (`mjcf_carried`). The sections of `WHOLE` refer to
named objects only, so their elements are kept verbatim, with the defaults of their kinds, and `write_mjcf` writes them again if
everything that they name exists. Everything else, known to MuJoCo or not, becomes a `Kept` without XML.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any, Final

from lxml import etree

from articad.assembly import Kept
from articad.importers.mjcf_carried import CARRIED
from articad.importers.reading import read_xml

__all__ = ["READ", "WHOLE", "kept_attributes", "section_elements", "with_includes"]

ALL: Final = frozenset({"*"})
_PLACE = frozenset({"pos", "quat", "axisangle", "xyaxes", "zaxis", "euler"})
_BODY = _PLACE | {"name", "childclass"} | CARRIED["body"]
_JOINT = (
    frozenset(
        {
            "name",
            "class",
            "type",
            "pos",
            "axis",
            "limited",
            "range",
            "ref",
            "damping",
            "frictionloss",
            "actuatorfrclimited",
            "actuatorfrcrange",
        }
    )
    | CARRIED["joint"]
)
_GEOM = (
    _PLACE
    | {"name", "class", "type", "size", "fromto", "mesh", "fitscale", "mass", "density", "shellinertia", "material"}
    | CARRIED["geom"]
)

WHOLE: Final = (
    "option",
    "size",
    "visual",
    "statistic",
    "extension",
    "custom",
    "contact",
    "equality",
    "tendon",
    "actuator",
    "sensor",
    "keyframe",
)
"""Sections whose elements are kept verbatim."""

SETTINGS: Final = frozenset({"option", "size", "visual", "statistic", "extension"})
"""Those of them that apply to the whole model and have no named elements."""

_OWN_DEFAULTS = frozenset(
    {"general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion", "dcmotor", "plugin"}
) | {"tendon", "pair", "equality"}  # kinds of elements in the sections of `WHOLE` that have defaults

READ: Final[Mapping[str, frozenset[str]]] = {
    "mujoco": frozenset({"model"}),
    "compiler": ALL,
    "compiler/lengthrange": ALL,
    "default": frozenset({"class"}),
    "worldbody": ALL,
    "asset": ALL,
    "include": ALL,
    "body": _BODY,
    "frame": ALL,
    "replicate": ALL,
    "attach": ALL,
    "inertial": ALL,
    "joint": _JOINT,
    "freejoint": frozenset({"name", "align"}) | CARRIED["freejoint"],
    "geom": _GEOM,
    "site": CARRIED["site"] | {"material"},
    "camera": CARRIED["camera"],
    "light": CARRIED["light"],
    "asset/mesh": ALL,
    "asset/model": ALL,
    "asset/material": frozenset({"name", "class", "rgba"}),
    "default/mesh": ALL,
    "default/material": frozenset({"rgba"}),
} | {f"default/{tag}": ALL for tag in sorted(_OWN_DEFAULTS)}
"""Attributes that are read or carried, by tag, or by section and tag; `*` for all of them."""

_SECTIONS = frozenset({"default", "asset"})
_NAMES = 6  # largest number of names in a row
_PREFIX = "articad."  # of articad's own records
_USUAL = {"gravity": ("0", "0", "-9.81")}  # the value that every reader uses anyway


def with_includes(document: Any, path: Path) -> Any:
    """Return the document with its includes in their places.

    MuJoCo looks for an included file beside the model, then beside the file that includes it, and reads each file once.

    Args:
        document: The root element; it is not modified.
        path: Path of the model's file.
    """
    whole = deepcopy(document)
    _include(whole, path.parent, path.parent, {path.resolve()})
    return whole


def _include(element: Any, top: Path, here: Path, seen: set[Path]) -> None:
    for include in list(element.iter("include")):
        places = [(folder / include.get("file", "")).resolve() for folder in (top, here)]
        target = next((place for place in places if place.is_file()), None)
        if target is None or target in seen:
            continue
        seen.add(target)
        brought = read_xml(target)
        _include(brought, top, target.parent, seen)
        above = include.getparent()
        at = above.index(include)
        above[at : at + 1] = list(brought)


def kept_attributes(document: Any) -> list[Kept]:
    """Return the unread data of an MJCF document: the elements of `WHOLE`, and a row for each other kind of element or attribute.

    Args:
        document: The root element, with includes in place.
    """
    rows: dict[str, list[str]] = {}
    for what, name in _unread(document, ""):
        rows.setdefault(what, []).append(name)
    return [
        *_compiler(document),
        *_defaults(document),
        *(kept for section in WHOLE for kept in _section(document, section)),
        *(Kept("mjcf", "model", _listed(what, names)) for what, names in rows.items()),
    ]


def section_elements(document: Any, section: str) -> list[Any]:
    """Return the elements of all sections of this name, in the order in which MuJoCo numbers their objects."""
    return [element for part in document.iterfind(section) for element in part if isinstance(element.tag, str) and not _own_record(element)]


def _section(document: Any, section: str) -> Iterator[Kept]:
    if section in SETTINGS:
        for part in document.iterfind(section):
            said = [f"{name} {value}" for name, value in part.attrib.items() if tuple(value.split()) != _USUAL.get(name)]
            said += [f"{below.tag}: {', '.join(f'{name} {value}' for name, value in below.attrib.items())}" for below in part]
            yield Kept("mjcf", "model", f"<{section}> {', '.join(said)}" if said else "", _text(part))
        return
    counts: dict[str, int] = {}
    for element in section_elements(document, section):
        what = element.tag if section in {"contact", "custom", "keyframe"} else section
        counts[what] = counts.get(what, -1) + 1
        wrapped = etree.Element(section)
        wrapped.append(deepcopy(element))
        yield Kept("mjcf", "model", _called(element, what, counts[what]), _text(wrapped))


def _called(element: Any, what: str, number: int) -> str:
    """Return the description of an element: what it is, its name or number, its tag and its references."""
    about = ", ".join(f"{name} {value!r}" for name, value in element.attrib.items() if name in _REFERRING)
    said = " ".join([*([] if element.tag == what else [element.tag]), *([f"of {about}"] if about else [])])
    return f"{what} {element.get('name') or f'{what}_{number}'!r}{f' ({said})' if said else ''}"


_REFERRING = frozenset(
    {
        "joint",
        "jointinparent",
        "joint1",
        "joint2",
        "body",
        "body1",
        "body2",
        "site",
        "site1",
        "site2",
        "geom1",
        "geom2",
        "tendon",
        "objname",
    }
) | {"cranksite", "actuator", "tendon1", "tendon2"}


def _compiler(document: Any) -> Iterator[Kept]:
    """Yield the compiler's settings on which the verbatim elements depend.

    `autolimits` is not among them: without it MuJoCo demands that every range says whether it limits.
    """
    kept = etree.Element("compiler")
    for compiler in document.iterfind("compiler"):
        kept.extend(deepcopy(list(compiler.iterfind("lengthrange"))))
    if len(kept):
        yield Kept("mjcf", "model", "", _text(kept))


def _defaults(document: Any) -> Iterator[Kept]:
    """Yield the defaults of the elements that are kept verbatim; without those they have no effect."""
    for default in document.iterfind("default"):
        kept = deepcopy(default)
        for element in list(kept.iter()):
            if isinstance(element.tag, str) and element.tag not in _OWN_DEFAULTS | {"default"}:
                element.getparent().remove(element)
        if any(element.tag != "default" or element.get("class") for element in kept.iter()):
            yield Kept("mjcf", "model", "", _text(kept))


def _text(element: Any) -> str:
    return str(etree.tostring(element, encoding="unicode", with_tail=False))


def _listed(what: str, names: list[str]) -> str:
    known = [name for name in names if name]
    listed = ", ".join(known[:_NAMES]) + (f" and {len(known) - _NAMES} others" if len(known) > _NAMES else "")
    count = f", {len(names)} times" if len(names) > 1 else ""
    return f"{what}{count}{f': {listed}' if listed else ''}"


def _unread(element: Any, section: str) -> Iterator[tuple[str, str]]:
    """Yield the unread data of an element and below, and the names of their owners."""
    tag, name = element.tag, _name(element)
    key = _key(element, section)
    if key is None:
        yield from _whole(element)
        return
    read = READ[key]
    for attribute in element.attrib:
        if "*" not in read and attribute not in read:
            yield f"{attribute} of <{tag}>", name
    if tag == "material" and len(words := element.get("rgba", "").split()) == 4 and words[3] not in {"1", "1.0"}:
        yield "transparency of <material>", name
    inside = tag if tag in _SECTIONS and not section else section
    for below in element:
        if isinstance(below.tag, str) and not (tag == "mujoco" and below.tag in WHOLE):
            yield from _unread(below, inside)


def _key(element: Any, section: str) -> str | None:
    """Return the key of `READ` for an element; None if it is not read at all."""
    tag = element.tag
    if f"{section}/{tag}" in READ:
        return f"{section}/{tag}"
    if tag == "lengthrange":
        return "compiler/lengthrange"
    # in a section, elements of bodies have another meaning; in defaults they have the same
    return tag if tag in READ and (section in {"", "default"} or tag == "include") else None


def _whole(element: Any) -> Iterator[tuple[str, str]]:
    """Yield an element that is not read: a section by its contents, others by name."""
    if len(element) and not element.attrib:
        yield from ((f"<{below.tag}> of <{element.tag}>", below.get("name") or "") for below in element if not _own_record(below))
    elif not _own_record(element):
        yield f"<{element.tag}>", _name(element)


def _name(element: Any) -> str:
    return str(element.get("name") or element.get("class") or "")


def _own_record(element: Any) -> bool:
    return element.tag == "text" and str(element.get("name", "")).startswith(_PREFIX)
