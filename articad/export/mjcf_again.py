"""Writes into MJCF again what an MJCF file has beyond an assembly: attributes, sites, cameras, sections and their defaults.

An element is written if everything that it names exists: an actuator with its joint, a sensor with the actuator that it measures. An
element with a missing reference is omitted, and is a row of the losses like everything else that is kept and not written.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Final

from lxml import etree

from articad.assembly import Kept

if TYPE_CHECKING:
    from articad.assembly import Assembly

_FIRST: Final = ("compiler", "option", "size", "visual", "statistic", "extension", "default")
"""Sections that refer to nothing; they are written before the bodies."""

SECTIONS: Final = (*_FIRST, "contact", "tendon", "actuator", "sensor", "keyframe", "custom")
"""Sections in the order in which they are written; equalities are written by the writer of joints."""

_KIND_OF: Final[Mapping[str, str]] = (
    dict.fromkeys(("joint", "jointinparent", "joint1", "joint2"), "joint")
    | dict.fromkeys(("site", "site1", "site2", "cranksite", "slidersite", "refsite", "sidesite"), "site")
    | dict.fromkeys(("body", "body1", "body2", "subtree1", "subtree2"), "body")
    | dict.fromkeys(("geom", "geom1", "geom2"), "geom")
    | dict.fromkeys(("tendon", "tendon1", "tendon2"), "tendon")
    | {
        name: name
        for name in ("actuator", "sensor", "camera", "material", "mesh", "texture", "hfield", "skin", "flex", "class", "instance")
    }
)
"""The kind of object that an attribute names."""

_GROUPS: Final[Mapping[str, str]] = {"xbody": "body", "freejoint": "joint", "spatial": "tendon", "fixed": "tendon"}
_OF_EVERY_MODEL: Final = {("body", "world"), ("class", "main")}


class Again:
    """The data to write again, and what has been written.

    Attributes:
        active: True for an assembly that came from an MJCF file.
        written: Data that has been written.
    """

    def __init__(self, assembly: Assembly) -> None:
        self.active = any(item.format == "mjcf" for item in assembly.kept)
        self.written: set[Kept] = set()
        self._kept: dict[str, list[Kept]] = {}
        self._equalities = [item.xml for item in assembly.kept if item.xml.startswith("<equality")]
        for item in assembly.kept:
            if item.format == "mjcf" and item.xml:
                self._kept.setdefault(item.where, []).append(item)

    def names(self, tag: str) -> list[str]:
        """Return the names of the kept elements of a kind, which new ones must not have."""
        return [element.get("name", "") for where in self._kept for _, element in self._elements(where) if element.tag == tag]

    def attributes(self, where: str, tag: str) -> dict[str, str]:
        """Return the kept attributes of a joint, a body or a geom; they count as written."""
        found: dict[str, str] = {}
        for item, element in self._elements(where):
            if element.tag == tag and (tag != "geom" or ".visuals." in where or ".collisions." in where):
                found |= element.attrib
                self.written.add(item)
        return found

    def below(self, where: str, body: Any) -> None:
        """Add the kept geoms, sites, cameras and lights of a part."""
        for item, element in self._elements(where):
            if element.tag in {"geom", "site", "camera", "light"}:
                body.append(element)
                self.written.add(item)

    def equality(self, where: str) -> Any | None:
        """Return the original equality of a joint or coupling, verbatim."""
        return next((element[0] for _, element in self._elements(where) if element.tag == "equality"), None)

    def drop_unknown_targets(self, root: Any) -> None:
        """Remove cameras and lights that target a missing body."""
        known = _known(root)
        for item in list(self.written):
            element = etree.fromstring(item.xml)
            if element.get("target") and ("body", element.get("target")) not in known:
                self.written.discard(item)
                for there in [one for one in root.iter(element.tag) if one.get("target") == element.get("target")]:
                    there.getparent().remove(there)

    def sections(self, root: Any, *, same_joints: bool) -> None:
        """Add the kept sections whose references all exist.

        Args:
            root: The document, with its bodies and equalities.
            same_joints: Whether its joints are those of the file in their order, so that the values of keys mean the same.
        """
        waiting = [(item, element) for item, element in self._elements("model") if element.tag in (*SECTIONS, "equality")]
        settings = [pair for pair in waiting if not len(pair[1]) or pair[1].tag in _FIRST]
        waiting = [pair for pair in waiting if pair not in settings and (pair[1].tag != "keyframe" or same_joints)]
        kept = {item for item, _ in waiting}
        for item, element in settings:
            self._add(root, item, element)
        while True:  # an element that names an omitted one is omitted, too
            known = _known(root) | _named(element[0] for item, element in waiting if item in kept)
            lost = {item for item, element in waiting if item in kept and not _references(element) <= known}
            if not lost:
                break
            kept -= lost
        complete = len(kept) == len(waiting)
        for item, element in waiting:
            if item in kept and (element.tag != "keyframe" or complete):  # the values of keys count all actuators
                self._add(root, item, element)

        self._in_order(root.find("equality"))

    def _in_order(self, equalities: Any | None) -> None:
        """Sort the equalities as in the file, with articad's last: MuJoCo numbers those without names."""
        if equalities is None:
            return
        places = {etree.tostring(etree.fromstring(xml)[0]): place for place, xml in enumerate(self._equalities)}
        equalities[:] = sorted(equalities, key=lambda element: places.get(etree.tostring(element), len(places)))

    def _add(self, root: Any, item: Kept, element: Any) -> None:
        self.written.add(item)
        there = root.find(element.tag) if len(element) == 1 and element.tag not in _FIRST else None
        if there is not None:
            there.append(element[0])
        elif element.tag in _FIRST:
            root.insert(sum(below.tag in _FIRST for below in root), element)
        else:
            root.append(element)

    def _elements(self, where: str) -> Iterable[tuple[Kept, Any]]:
        return [(item, etree.fromstring(item.xml)) for item in self._kept.get(where, ())]


def _known(root: Any) -> set[tuple[str, str]]:
    """Return the names in a document, with their kinds."""
    return _OF_EVERY_MODEL | _named(root.iterfind("worldbody//*")) | _named(root.iterfind("equality/*")) | _named(root.iterfind("asset/*")) | _named(root.iterfind("extension//instance")) | {
        ("class", default.get("class")) for default in root.iter("default")
    }  # fmt: skip


def _named(elements: Iterable[Any]) -> set[tuple[str, str]]:
    found = set()
    for element in elements:
        section = element.getparent().tag if element.getparent() is not None else ""
        kind = section if section in {"tendon", "actuator", "sensor"} else _GROUPS.get(element.tag, element.tag)
        found.add((kind, element.get("name", "")))
    return found


def _references(section: Any) -> set[tuple[str, str]]:
    """Return the names to which the elements of a section refer, with their kinds."""
    found = set()
    for element in section.iter():
        for name, value in element.attrib.items():
            if name in {"objname", "refname"}:
                kind = element.get(f"{name[:3]}type", "")
                found.add((_GROUPS.get(kind, kind), value))
            elif name in _KIND_OF and element.tag not in {"numeric", "text", "key"}:
                found.add((_KIND_OF[name], value))
    return found
