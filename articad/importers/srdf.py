"""Reads SRDF: the groups, states, virtual joints and pairs without collisions that MoveIt keeps beside a URDF, verbatim.

An assembly has no fields for them, so each element is kept with it. `write_urdf` writes them into an SRDF again if everything that an
element names is in the URDF; every other format reports them as losses.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from lxml import etree

from articad.assembly import Kept
from articad.importers.reading import Folder, read_xml, unreadable

__all__ = ["COMPUTED", "kept_semantics", "semantics_beside"]

MAX_KEPT: Final = 100_000  # elements that are kept: the pairs of 450 links
COMPUTED: Final = frozenset({"Adjacent", "Never", "Default"})
"""Reasons of `<disable_collisions>` that `write_urdf` gives for the pairs that it finds itself."""


def semantics_beside(path: Path, folder: Folder) -> Path | None:
    """Return the SRDF of a URDF: `NAME.srdf` beside it, or in the folder `srdf` beside its folder, as in a ROS package.

    Args:
        path: The URDF or xacro file.
        folder: Confines the files that may be read.
    """
    stem = path.name.removesuffix(".xacro").removesuffix(".urdf")
    places = (folder.here / f"{stem}.srdf", folder.here.parent / "srdf" / f"{stem}.srdf")
    for place in places:
        target = place.resolve()
        if target.is_file() and target.is_relative_to(folder.root):
            return target
    return None


def kept_semantics(path: Path, *, own: bool = False) -> list[Kept]:
    """Return the elements of an SRDF.

    Args:
        path: The file.
        own: Whether it lies beside a URDF that articad wrote: pairs with one of articad's reasons are then left out, because the writer
            finds them again.

    Raises:
        ReadError: If it is not an SRDF.
    """
    document = read_xml(path)
    if document.tag != "robot":
        raise unreadable(path, f"line {document.sourceline}", f"The root element is <{document.tag}>, not <robot>: this is not SRDF.")
    if document.find("joint/parent") is not None or document.find("link/*") is not None:
        raise unreadable(path, f"line {document.sourceline}", "It has links or joints: this is a URDF, not its SRDF.")
    if len(document) > MAX_KEPT:
        raise unreadable(path, f"line {document.sourceline}", f"It has {len(document)} elements; the maximum is {MAX_KEPT}.")
    return [
        Kept("srdf", "model", _words(element), etree.tostring(element, encoding="unicode", with_tail=False))
        for element in document
        if not (own and element.tag == "disable_collisions" and element.get("reason") in COMPUTED)
    ]


def _words(element: Any) -> str:
    said = " ".join(str(value) for name, value in element.attrib.items() if name in _SAID)
    return f"<{element.tag}{f' {said}' if said else ''}> of the SRDF"


_SAID = frozenset({"name", "link1", "link2", "link", "group", "joint_name"})
