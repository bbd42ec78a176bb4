"""Data of an SDFormat file beyond links, joints and shapes: every element and attribute that is not read, by name.

`READ` lists what `articad.importers.sdf` reads, by the path below `<model>`. Everything else becomes a `Kept`: `write_sdf` writes
elements of links, joints, shapes and models again, unless they name frames, and every other format reports them as losses.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

from lxml import etree

from articad.assembly import Kept

__all__ = ["READ_SDF", "kept_of"]

_POSE: Final = frozenset({"relative_to", "frame", "rotation_format", "degrees"})
_NONE: Final[frozenset[str]] = frozenset()
_SHAPE: Final[Mapping[str, frozenset[str]]] = {
    "pose": _POSE,
    "geometry": _NONE,
    "geometry/empty": _NONE,
    "geometry/box": _NONE,
    "geometry/box/size": _NONE,
    "geometry/sphere": _NONE,
    "geometry/sphere/radius": _NONE,
    "geometry/cylinder": _NONE,
    "geometry/cylinder/radius": _NONE,
    "geometry/cylinder/length": _NONE,
    "geometry/capsule": _NONE,
    "geometry/capsule/radius": _NONE,
    "geometry/capsule/length": _NONE,
    "geometry/ellipsoid": _NONE,
    "geometry/ellipsoid/radii": _NONE,
    "geometry/mesh": _NONE,
    "geometry/mesh/uri": _NONE,
    "geometry/mesh/scale": _NONE,
}
_AXIS: Final[Mapping[str, frozenset[str]]] = {
    "": _NONE,
    "/xyz": frozenset({"expressed_in"}),
    "/use_parent_model_frame": _NONE,
    "/limit": _NONE,
    "/limit/lower": _NONE,
    "/limit/upper": _NONE,
    "/limit/effort": _NONE,
    "/limit/velocity": _NONE,
    "/dynamics": _NONE,
    "/dynamics/damping": _NONE,
    "/dynamics/friction": _NONE,
    "/mimic": frozenset({"joint", "axis"}),
    "/mimic/multiplier": _NONE,
    "/mimic/offset": _NONE,
    "/mimic/reference": _NONE,
}

READ_SDF: Final[Mapping[str, frozenset[str]]] = {
    "": frozenset({"name", "canonical_link", "placement_frame"}),
    "static": _NONE,
    "pose": _POSE,
    "frame": frozenset({"name", "attached_to"}),
    "frame/pose": _POSE,
    "include": _NONE,
    "include/uri": _NONE,
    "include/name": _NONE,
    "include/pose": _POSE,
    "include/static": _NONE,
    "include/placement_frame": _NONE,
    "link": frozenset({"name"}),
    "link/pose": _POSE,
    "link/inertial": _NONE,
    "link/inertial/pose": _POSE,
    "link/inertial/mass": _NONE,
    "link/inertial/inertia": _NONE,
    **{f"link/inertial/inertia/{name}": _NONE for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")},
    "link/visual": frozenset({"name"}),
    **{f"link/visual/{key}": value for key, value in _SHAPE.items()},
    "link/visual/material": _NONE,
    "link/visual/material/diffuse": _NONE,
    "link/collision": frozenset({"name"}),
    **{f"link/collision/{key}": value for key, value in _SHAPE.items()},
    "joint": frozenset({"name", "type"}),
    "joint/pose": _POSE,
    "joint/parent": _NONE,
    "joint/child": _NONE,
    "joint/thread_pitch": _NONE,
    "joint/screw_thread_pitch": _NONE,
    **{f"joint/{axis}{key}": value for axis in ("axis", "axis2") for key, value in _AXIS.items()},
}
"""Attributes that are read, by the path of their element below `<model>`; an element without its path here is not read."""

_RECORDS: Final = "records"  # articad's own


def kept_of(element: Any, key: str, where: str, above: tuple[str, ...] = ()) -> Iterator[Kept]:
    """Yield the unread data of an element.

    Args:
        element: A `<model>`, `<link>`, `<joint>`, `<visual>` or `<collision>`, or an element in one.
        key: Its path below `<model>`.
        where: The object that it describes.
        above: The tags between that object and the element.
    """
    for name, value in element.attrib.items():
        if name not in READ_SDF[key]:
            yield Kept("sdf", where, f"{name}={value!r} of <{element.tag}>")
    for below in element:
        path = f"{key}/{below.tag}".removeprefix("/")
        if path in _LISTED or etree.QName(below).localname == _RECORDS or _says_nothing(below, path):
            continue
        if path in READ_SDF:
            yield from kept_of(below, path, where, (*above, below.tag))
            continue
        name = below.get("name") or ""
        inside = f" of <{element.tag}>" if above else ""
        text = _text(below, above) if _can_return(below, key) else ""
        yield Kept("sdf", where, f"<{etree.QName(below).localname}{f' {name}' if name else ''}>{inside}{_value(below)}", text)


_LISTED: Final = frozenset({"link", "joint", "link/visual", "link/collision", "model", "include", "frame"})  # each is read separately
_SHOWN: Final = 40  # characters of a text that is shown
_REPLACED: Final = ("link/inertial", "link/visual/geometry", "link/collision/geometry")  # written anew, in another form


def _says_nothing(element: Any, path: str) -> bool:
    """Return whether an element states a default, such as a spring without stiffness."""
    return path.rpartition("/")[2] in {"spring_reference", "spring_stiffness"} and (element.text or "").strip() in {"0", "0.0", ""}


def _can_return(element: Any, key: str) -> bool:
    """Return whether `write_sdf` can write an element again: its parent is written again, and it does not name frames."""
    return not key.startswith(_REPLACED) and not any(one.get("relative_to") or one.get("attached_to") for one in element.iter())


def _text(element: Any, above: tuple[str, ...]) -> str:
    text = str(etree.tostring(element, encoding="unicode", with_tail=False))
    return "".join(f"<{tag}>" for tag in above) + text + "".join(f"</{tag}>" for tag in reversed(above))


def _value(element: Any) -> str:
    """Return ` 0.5` for an element that contains only a short text."""
    text = " ".join((element.text or "").split(None, _SHOWN))
    return f" {text}" if text and not len(element) and len(text) <= _SHOWN else ""
