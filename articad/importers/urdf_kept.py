"""Data of a URDF file beyond links, joints and shapes: kept verbatim, so that nothing is lost without notice.

`READ` lists the elements and attributes that `articad.importers.urdf` converts to fields of the assembly. Everything else, known to URDF
or not, becomes a `Kept`: `write_urdf` writes it again at its place, and other writers report it as a loss. Attributes without a place of
their own in the written file (a texture, transparency) are kept without XML, so that `write_urdf` reports them too.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, Final

from lxml import etree

from articad.assembly import Kept
from articad.export.follow import STATES_MIMIC
from articad.export.names import called

__all__ = ["READ", "kept_elements"]

MOVING: Final = ("revolute", "continuous", "prismatic")  # types whose limit, dynamics and mimic are read
_PLACE = frozenset({"xyz", "rpy", "quat_xyzw"})

READ: Final[Mapping[str, frozenset[str]]] = {
    "robot": frozenset({"name"}),
    "link": frozenset({"name"}),
    "inertial": frozenset(),
    "inertial/origin": _PLACE,
    "inertial/mass": frozenset({"value"}),
    "inertial/inertia": frozenset({"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}),
    "visual": frozenset({"name"}),
    "visual/origin": _PLACE,
    "visual/geometry": frozenset(),
    "visual/material": frozenset({"name"}),
    "collision": frozenset({"name"}),
    "collision/origin": _PLACE,
    "collision/geometry": frozenset(),
    "geometry/box": frozenset({"size"}),
    "geometry/cylinder": frozenset({"radius", "length"}),
    "geometry/sphere": frozenset({"radius"}),
    "geometry/capsule": frozenset({"radius", "length"}),
    "geometry/mesh": frozenset({"filename", "scale"}),
    "material": frozenset({"name"}),
    "material/color": frozenset({"rgba"}),
    "joint": frozenset({"name", "type"}),
    "joint/origin": _PLACE,
    "joint/parent": frozenset({"link"}),
    "joint/child": frozenset({"link"}),
    "joint/axis": frozenset({"xyz"}),
    "joint/limit": frozenset({"lower", "upper", "effort", "velocity"}),
    "joint/dynamics": frozenset({"damping", "friction"}),
    "joint/mimic": frozenset({"joint", "multiplier", "offset"}),
}
"""Attributes that are read, by parent and tag; for children of `link` and `joint` of `<robot>` the parent is omitted."""

_VERSIONS = ("", "1.0", "1")
_OF_MOTION = ("axis", "limit", "dynamics", "mimic", "safety_controller", "calibration")  # say nothing of a joint that does not move
_WITHOUT_CAPSULES = (*_VERSIONS, "1.1")


def kept_elements(document: Any) -> list[Kept]:
    """Return the unread data of a URDF document.

    Args:
        document: The original root element; elements that are there once too often are removed from it.
    """
    found: list[Kept] = list(_repeated(document))
    if document.get("version", "") not in _VERSIONS:
        found.append(Kept("urdf", "model", f"version {document.get('version')}", f'<robot version="{document.get("version")}"/>'))
    for name, value in document.attrib.items():
        if name not in READ["robot"] | {"version"}:
            found.append(Kept("urdf", "model", f"{name}={value!r} of <robot>"))
    found.extend(_early_capsules(document))
    for element in document:
        if not isinstance(element.tag, str) or element.tag == "articad":
            continue
        if element.tag == "mujoco":
            found.append(Kept("urdf", "model", "<mujoco>: MuJoCo's settings for the original's files; ours are written"))
        elif element.tag == "link":
            found.extend(_of_link(element))
        elif element.tag == "joint":
            found.extend(_of_joint(element))
        elif element.tag == "material":
            found.extend(_of_material(element, "model"))
        else:
            found.append(_kept(element, "model"))
    return list(dict.fromkeys(found))


def _repeated(document: Any) -> Iterator[Kept]:
    """Remove and yield the elements of which URDF has one and the file has several: every reader takes the first."""
    for path, kind in (("link", "parts"), ("joint", "joints")):
        for owner in document.iterfind(path):
            for element in (
                owner,
                *owner.iterfind("inertial"),
                *owner.iterfind("visual"),
                *owner.iterfind("collision"),
                *owner.iter("geometry"),
            ):
                seen: set[str] = set()
                for below in list(element):
                    name = "shape" if element.tag == "geometry" else str(below.tag)
                    if name in seen and name in _SINGLE:
                        yield Kept("urdf", f"{kind}.{owner.get('name')}", f"a second <{below.tag}> of <{element.tag}>")
                        element.remove(below)
                    seen.add(name)


_SINGLE: Final = frozenset({"inertial", "origin", "mass", "inertia", "geometry", "material", "shape", *("parent", "child"), *_OF_MOTION})


def _early_capsules(document: Any) -> Iterator[Kept]:
    """Yield the links with capsules in a file of a version that has none: we read them, other readers leave them out."""
    if document.get("version", "") not in _WITHOUT_CAPSULES:
        return
    for link in document.iterfind("link"):
        if link.find("*/geometry/capsule") is not None:
            said = "the fact that readers leave <capsule> out: URDF has it from version 1.2 on"
            yield Kept("urdf", f"parts.{link.get('name')}", said)


def _of_link(link: Any) -> Iterator[Kept]:
    where = f"parts.{link.get('name')}"
    yield from _attributes(link, "link", where)
    for tag in ("visual", "collision"):
        names = [name for element in link.iterfind(tag) if (name := element.get("name"))]
        if names:
            yield Kept("urdf", where, called(tag, names))
    for element in link:
        if element.tag not in {"inertial", "visual", "collision"}:
            yield _kept(element, where)
            continue
        yield from _attributes(element, element.tag, where)
        for below in element:
            key = f"{element.tag}/{below.tag}"
            if key not in READ:
                yield Kept("urdf", where, f"<{below.tag}> of <{element.tag}>")
                continue
            yield from _attributes(below, key, where)
            if below.tag == "geometry":
                for shape in below:
                    yield from _attributes(shape, f"geometry/{shape.tag}", where)
            elif below.tag == "material":
                yield from _of_material(below, where)


def _of_material(material: Any, where: str) -> Iterator[Kept]:
    name = material.get("name")
    for element in material:
        if element.tag == "texture" and not element.get("filename"):
            continue  # it names no picture
        if element.tag != "color":
            what = f"texture {element.get('filename')!r}" if element.tag == "texture" else f"<{element.tag}>"
            yield Kept("urdf", where, f"{what} of material {name!r}")
            continue
        yield from _attributes(element, "material/color", where)
        words = element.get("rgba", "").split()
        if len(words) == 4 and _number(words[3]) != 1.0:
            yield Kept("urdf", where, f"transparency: alpha {words[3]} of material {name!r}")


def _of_joint(joint: Any) -> Iterator[Kept]:
    where, kind = f"joints.{joint.get('name')}", joint.get("type")
    yield from _attributes(joint, "joint", where)
    for element in joint:
        key = f"joint/{element.tag}"
        acts = element.tag not in {"limit", "dynamics", "mimic", "axis"} or kind in MOVING or (element.tag == "axis" and kind == "planar")
        if key not in READ or not acts:
            kept = _kept(element, where)
            yield replace(kept, what="") if kind == "fixed" and element.tag in _OF_MOTION else kept
            continue
        if element.tag == "mimic":
            yield Kept("urdf", where, "", STATES_MIMIC)
        read = READ[key] - ({"lower", "upper"} if kind == "continuous" else set())
        more = {name: value for name, value in element.attrib.items() if name not in read}
        if more and element.tag in {"limit", "dynamics", "mimic"}:
            said = ", ".join(f"{name} {value}" for name, value in more.items())
            yield Kept("urdf", where, f"{said} of <{element.tag}>", etree.tostring(etree.Element(element.tag, more), encoding="unicode"))
        elif more:
            yield from _attributes(element, key, where)


def _attributes(element: Any, key: str, where: str) -> Iterator[Kept]:
    """Yield the attributes that are not read; they are not written again, because their elements are written anew."""
    for name, value in element.attrib.items():
        if name not in READ.get(key, frozenset()):
            yield Kept("urdf", where, f"{name}={value!r} of <{element.tag}>")


def _kept(element: Any, where: str) -> Kept:
    """Return an element verbatim, without the white space after it."""
    name = element.get("name") or element.get("reference")
    text = etree.tostring(element, encoding="unicode", with_tail=False)
    return Kept("urdf", where, f"<{str(element.tag).rpartition('}')[2]}{f' {name}' if name else ''}>", text)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
