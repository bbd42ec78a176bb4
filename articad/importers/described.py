"""Whether the records in a file describe the file's own elements: a stranger can write any records, with a fingerprint that fits.

The assembly that the records give is written again, and both files are reduced to what other programs see of the mechanism: links with
their masses and inertias, visual shapes with their places and the content of their meshes, joints with their frames, axes and limits.
Numbers may differ by rounding. Collision shapes, which writers choose from settings, must reach as far as those of the records. Left out
is what writers derive: efforts, velocities and damping.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, Final

import numpy as np
from lxml import etree

from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.export.lowering import lower
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part, Solid
from articad.importers.stated import Meshes, collides, inertia, is_primitive, placed, same_extents

__all__ = ["OTHER", "Meshes", "describes", "names_its_meshes"]

Rewritten = Callable[[Assembly], Iterator[tuple[Sequence[Any], Mapping[str, str]]]]
"""Writes an assembly again, in each way that changes what is compared; yields the elements that the records are about, and the digests of
their meshes by name."""

OTHER: Final = TriMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int32))
"""Stands for a mesh that articad's writers do not write: it is like no other."""

_LEFT_OUT: Final = frozenset({"record", "records", "dynamics", "effort", "velocity", "safety_controller"})
_FREE: Final = frozenset({"effort", "velocity", "damping", "frictionloss", "actuatorfrcrange", "material", "rgba"})
_NAMES: Final = frozenset({"mesh", "filename"})  # attributes that name a file; in SDFormat, the text of <uri> does
_SHOWING: Final = frozenset({"mesh", "geom"})  # elements that show the mesh which they name
_RELATIVE, _ABSOLUTE = 1e-6, 1e-9  # m, kg, rad; formats are written with full digits
_COARSE, _COARSE_MM = 0.02, 1.0  # largest deflection of a solid: the larger of the two; the share is of the diagonal
_EXACT = 1e-3  # share by which the numbers of a solid may differ from its mesh in addition to its deflection


def describes(
    own: Assembly, elements: Iterable[Any], meshes: Meshes, rewritten: Rewritten, *, incomplete: Container[str] = frozenset()
) -> bool:
    """Return whether an assembly that records gave is what the elements of its file state.

    Args:
        own: The assembly.
        elements: The elements of the file.
        meshes: Looks up the meshes of the file; visual shapes whose mesh is missing are not compared.
        rewritten: Writes the assembly again.
        incomplete: Parts of the assembly that lack a shape because its mesh is missing.
    """
    elements = list(elements)
    stated = _skeleton(elements, meshes)
    if not all(map(_shows_its_solid, own.parts.values())):
        return False
    unseen = {link.name for link in lower(own).links if link.part.name in incomplete} if incomplete else set()
    known = {shape.mesh.digest: shape.mesh for part in own.parts.values() for shape in (*part.visuals, *part.collisions)}
    with suppress(ArticadError, ValueError):  # it cannot be written, or has another form: then nobody wrote it from these records
        for again, digests in rewritten(own):
            drawn = {name: known[digest] for name, digest in digests.items()}.get
            if _equal(stated, _skeleton(again, drawn)) and _collide_alike(_colliding(elements, meshes), _colliding(again, drawn), unseen):
                return True
    return False


def _shows_its_solid(part: Part) -> bool:
    """Return whether the solid that checks use is one of the shapes that other programs show, and its numbers are those of its mesh."""
    shown = part.visuals or part.collisions
    return part.solid is None or (part.solid.mesh.digest in {shape.mesh.digest for shape in shown} and _is_measured(part.solid))


def _is_measured(solid: Solid) -> bool:
    """Return whether the stated numbers of a solid are those of its mesh, up to its deflection."""
    diagonal = float(np.linalg.norm(np.ptp(solid.bbox, axis=0)))
    volume, com, moments = solid.mesh.solid_integrals()
    if not 0 <= solid.deflection <= max(_COARSE * diagonal, _COARSE_MM) or not volume > 0:
        return False
    share = _EXACT + 2 * solid.deflection * solid.mesh.area / volume
    return (
        abs(solid.volume - volume) <= share * volume
        and abs(solid.area - solid.mesh.area) <= share * solid.mesh.area
        and bool(np.abs(solid.com - com).max() <= share * diagonal)
        and bool(np.abs(solid.inertia_mm5 - moments).max() <= share * volume * diagonal**2)
    )


_Shape = tuple[TriMesh | None, bool]  # None if its file is not there; whether it is a primitive
_Colliding = defaultdict[str, list[_Shape]]

Row = tuple[str, Mapping[str, str | None], str | None]
"""Tag, attributes and text of an element; for the name of a mesh its digest."""


def _skeleton(elements: Iterable[Any], meshes: Meshes) -> list[Row]:
    """Return the elements that are compared one by one, in order."""

    def digest(name: str) -> str | None:
        mesh = meshes(name)
        return None if mesh is None else mesh.digest

    rows: list[Row] = []
    waiting = list(elements)[::-1]
    while waiting:
        element = waiting.pop()
        if not isinstance(element.tag, str):  # a comment
            continue
        tag = etree.QName(element).localname
        if tag in _LEFT_OUT or collides(element) or _is_missing(element, digest):
            continue
        if tag == "inertial":
            with suppress(ValueError, ArticadError):
                rows.append((tag, inertia(element), ""))
                continue
        shown = digest if tag in _SHOWING or (tag == "uri" and element.getparent().tag in _SHOWING) else _any_file
        attributes = {name: shown(value) if name in _NAMES else value for name, value in element.attrib.items() if name not in _FREE}
        if "range" in attributes and attributes.get("limited") == "true":  # earlier versions let this follow from the range
            del attributes["limited"]
        text = (element.text or "").strip()
        rows.append((tag, attributes, shown(text) if tag == "uri" else text))
        waiting += element[::-1]
    return rows


def _is_missing(element: Any, digest: Callable[[str], str | None]) -> bool:
    """Return whether an element is a visual shape whose mesh is not there."""
    if element.tag == "geom":
        name = element.get("mesh")
    elif element.tag == "visual":
        mesh = element.find("geometry/mesh")
        name = None if mesh is None else mesh.get("filename") or (mesh.findtext("uri") or "").strip()
    else:
        return False
    return name is not None and digest(name) is None


def _collide_alike(stated: _Colliding, own: _Colliding, unseen: Container[str]) -> bool:
    """Return whether the collision shapes of each link can stand for those of the link that is written again."""
    return all(link in unseen or _can_stand_for(stated[link], own[link]) for link in {*stated, *own})


def _can_stand_for(stated: list[_Shape], own: list[_Shape]) -> bool:
    shown = [mesh for mesh, _ in stated if mesh is not None]
    whole = [mesh for mesh, _ in own if mesh is not None]
    return len(shown) == len(stated) and same_extents(shown, whole, exact=all(primitive for _, primitive in own))


def _colliding(elements: Iterable[Any], meshes: Meshes) -> _Colliding:
    """Return the placed collision shapes of each link or body.

    Raises:
        ValueError: If one is not in a form that articad writes.
        ArticadError: If a size is not a positive length.
    """
    found: _Colliding = defaultdict(list)
    for top in elements:
        for element in top.iter(etree.Element):
            if collides(element):
                found[element.getparent().get("name", "")].append((placed(element, meshes), is_primitive(element)))
    return found


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
