"""Whether the records in a file describe the file's own elements: a stranger can write any records, with a fingerprint that fits.

The assembly that the records give is written again, and both files are reduced to what other programs see of the mechanism: links with
their masses, visual shapes with their places and the content of their meshes, joints with their frames, axes and limits. Numbers may
differ by rounding. Left out is what writers choose from settings or derive: collision geometry, efforts, velocities and damping.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from lxml import etree

from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.geometry.part import Part

__all__ = ["describes", "names_its_meshes"]

Digests = Callable[[str], str | None]
"""Returns the digest of a mesh by its name in the elements; None if its file is not there."""

Rewritten = Callable[[Assembly], Iterator[tuple[Sequence[Any], Mapping[str, str]]]]
"""Writes an assembly again, in each way that changes what is compared; yields the elements that the records are about, and the digests of
their meshes by name."""

_LEFT_OUT: Final = frozenset({"collision", "record", "records", "dynamics", "effort", "velocity", "safety_controller"})
_SHAPES: Final = frozenset({"visual", "geom"})
_FREE: Final = frozenset({"effort", "velocity", "damping", "frictionloss", "actuatorfrcrange", "material", "rgba"})
_NAMES: Final = frozenset({"mesh", "filename"})  # attributes that name a file; in SDFormat, the text of <uri> does
_SHOWING: Final = frozenset({"mesh", "geom"})  # elements that show the mesh which they name
_RELATIVE, _ABSOLUTE = 1e-6, 1e-9  # m, kg, rad; formats are written with full digits


def describes(own: Assembly, elements: Iterable[Any], digests: Digests, rewritten: Rewritten, *, shapes: bool = True) -> bool:
    """Return whether an assembly that records gave is what the elements of its file state.

    Args:
        own: The assembly.
        elements: The elements of the file.
        digests: Looks up the meshes of the file.
        rewritten: Writes the assembly again.
        shapes: Whether visual shapes are compared; not if their meshes are missing.
    """
    left_out = _LEFT_OUT if shapes else _LEFT_OUT | _SHAPES
    stated = _skeleton(elements, left_out, digests)
    if shapes and not all(map(_shows_its_solid, own.parts.values())):
        return False
    try:
        return any(_equal(stated, _skeleton(again, left_out, meshes.get)) for again, meshes in rewritten(own))
    except ArticadError:  # it cannot be written: then nobody wrote it from these records
        return False


def _shows_its_solid(part: Part) -> bool:
    """Return whether the solid that checks use is one of the shapes that other programs show."""
    return part.solid is None or not part.visuals or part.solid.mesh.digest in {shape.mesh.digest for shape in part.visuals}


Row = tuple[str, Mapping[str, str | None], str | None]
"""Tag, attributes and text of an element; for the name of a mesh its digest."""


def _skeleton(elements: Iterable[Any], left_out: frozenset[str], digests: Digests) -> list[Row]:
    """Return the elements that are compared, in order."""
    rows: list[Row] = []
    waiting = list(elements)[::-1]
    while waiting:
        element = waiting.pop()
        tag = etree.QName(element).localname if isinstance(element.tag, str) else "collision"  # comments too
        if tag in left_out or (tag == "geom" and element.get("class") == "collision"):
            continue
        shown = digests if tag in _SHOWING or (tag == "uri" and element.getparent().tag in _SHOWING) else _any_file
        attributes = {name: shown(value) if name in _NAMES else value for name, value in element.attrib.items() if name not in _FREE}
        text = (element.text or "").strip()
        rows.append((tag, attributes, shown(text) if tag == "uri" else text))
        waiting += element[::-1]
    return rows


def _any_file(_: str) -> None:
    """Return that a file, such as a texture, is not compared."""


def names_its_meshes(record: Mapping[str, Any], elements: Iterable[Any]) -> bool:
    """Return whether the record of a part names the mesh files that its link shows, in whichever folder; links of URDF and SDFormat.

    Args:
        record: The record; its form has been checked.
        elements: The elements of the file.
    """
    shown: set[str] = set()
    for element in elements:
        if element.tag == "link" and element.get("name") == record.get("link"):
            for below in element.iterfind("visual//*"):
                name = below.get("filename") or (below.text if below.tag == "uri" else None)
                shown |= {_base(name)} if name else set()
    drawn = {_base(row["file"]) for row in record["visuals"] if row["file"] and not row.get("primitive")}
    known = {_base(row["file"]) for row in (*record["visuals"], *record["collisions"], record["solid"] or {"file": None}) if row["file"]}
    return not shown or (drawn <= shown <= known)


def _base(name: str) -> str:
    """Return the name of a file without its folder: meshes may be moved."""
    return name.strip().rpartition("/")[2]


def _equal(stated: Sequence[Row], again: Sequence[Row]) -> bool:
    if len(stated) != len(again):
        return False
    return all(
        tag == tag_again
        and attributes.keys() == attributes_again.keys()
        and _alike(text, text_again)
        and all(_alike(value, attributes_again[name]) for name, value in attributes.items())
        for (tag, attributes, text), (tag_again, attributes_again, text_again) in zip(stated, again, strict=True)
    )


def _alike(one: str | None, other: str | None) -> bool:
    """Return whether two texts are equal, or rows of numbers that differ by rounding; a mesh that is not there is like any other."""
    if one is None or other is None or one == other:
        return True
    words, others = one.split(), other.split()
    if len(words) != len(others):
        return False
    try:
        pairs = [(float(a), float(b)) for a, b in zip(words, others, strict=True)]
    except ValueError:
        return False
    return all(math.isclose(a, b, rel_tol=_RELATIVE, abs_tol=_ABSOLUTE) for a, b in pairs)
