"""The features that a part's joints need, by the names of its dimensions: `part.made(shape)` of a script.

A dimension that is named after a connector makes a feature there: `<connector>_pin`, `_bar_x` and `_bar_y`, `_ball` add material,
`_bore`, `_slot_x` and `_slot_y`, `_socket` cut it. Sizes are diameters and widths [mm]; a pin or bar is `<connector>_length` long from the
connector's origin along its z, a bore or slot `<connector>_depth` deep, or through. A fork is cut out over `_gap` along z within `_reach` of the
axis, and its pin spans it over `_span`, both centred on the connector; a shaft of `_shaft` has a groove of `_width` down to `_groove`. A pin may have a `_head`, `_thick` behind the connector, and a `_tail` behind
that.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any, Final, NamedTuple

THROUGH: Final = 1e4  # mm to both sides of the connector
"""Half the length of a cutter that goes through the whole part."""
BEYOND: Final = 0.5
"""How far the cutter of a groove stands out of its shaft [mm]."""
_NEEDED: Final = (
    ("pin", "length", "span", "tail"),
    ("bar_x", "bar_y"),
    ("bar_x", "length"),
    ("gap", "reach"),
    ("span", "pin"),
    ("head", "thick"),
    ("tail", "pin"),
    ("groove", "shaft"),
    ("groove", "width"),
    ("slot_x", "slot_y"),
)
"""Ends of the names of dimensions, each with those of which one has to be there as well."""


def made(shape: Any, part: SimpleNamespace) -> tuple[Any, Any]:
    """Return a shape with the features of its joints, and the planned connectors: what `build(part)` returns.

    Args:
        shape: build123d's shape, in the part's frame; None for a part that is made of features alone, such as a pin.
        part: What the script was given.

    Raises:
        ValueError: If a feature lacks a dimension.
    """
    import build123d as cad  # noqa: PLC0415 - a traced run replaces the module

    sizes = dict(part.dimensions)
    for name in part.connectors:
        _require_complete(sizes, name)
    places = {name: cad.Plane(frame.o, x_dir=frame.x, z_dir=frame.z) for name, frame in part.connectors.items()}
    for name, place in places.items():  # first, so that no fork loses its pin
        if f"{name}_gap" in sizes and shape is not None:
            shape = shape - place * cad.Cylinder(sizes[f"{name}_reach"], sizes[f"{name}_gap"])
    for name, place in places.items():
        for body in _inner(cad, sizes, name):
            shape = place * body if shape is None else shape + place * body
    for name, place in places.items():  # last, so that no pin fills a bore
        for cutter in _outer(cad, sizes, name):
            shape = shape - place * cutter
    return shape, part.connectors


def _require_complete(sizes: Any, name: str) -> None:
    """Check that what makes a feature at a connector is not a dimension alone that only happens to be named after it.

    Raises:
        ValueError: If another dimension is missing that the feature needs.
    """
    for end, *needed in _NEEDED:
        if f"{name}_{end}" in sizes and not any(f"{name}_{other}" in sizes for other in needed):
            others = " or ".join(f"{name}_{other}" for other in needed)
            raise ValueError(
                f"the dimension {name}_{end} is named after the connector {name}, so it makes a feature there, which needs {others}, too: "
                "state that, or rename the dimension"
            )


class _Ends(NamedTuple):
    """The names of the dimensions that make one side of a joint, each after `<connector>_`."""

    length: str
    rod: str
    bar: str
    ball: str


_INNER: Final = _Ends("length", "pin", "bar", "ball")
_OUTER: Final = _Ends("depth", "bore", "slot", "socket")


def _inner(cad: Any, sizes: Any, name: str) -> Iterator[Any]:
    """Yield what the joint at a connector adds to the part, in the connector's frame."""
    if f"{name}_span" in sizes:  # the pin of a fork
        yield cad.Cylinder(sizes[f"{name}_pin"] / 2, sizes[f"{name}_span"])
        sizes = {key: value for key, value in sizes.items() if key != f"{name}_pin"}
    yield from _bodies(cad, sizes, name, _INNER)
    thick = sizes.get(f"{name}_thick", 0)
    if f"{name}_head" in sizes:
        yield cad.Cylinder(sizes[f"{name}_head"] / 2, thick, align=_high(cad))
    if f"{name}_tail" in sizes:
        yield cad.Pos(0, 0, -thick) * cad.Cylinder(sizes[f"{name}_pin"] / 2, sizes[f"{name}_tail"], align=_high(cad))


def _outer(cad: Any, sizes: Any, name: str) -> Iterator[Any]:
    """Yield what the joint at a connector cuts from the part, in the connector's frame."""
    if f"{name}_groove" in sizes:
        ring = cad.Cylinder(sizes[f"{name}_shaft"] / 2 + BEYOND, sizes[f"{name}_width"])
        yield ring - cad.Cylinder(sizes[f"{name}_groove"] / 2, 2 * sizes[f"{name}_width"])
    yield from _bodies(cad, sizes, name, _OUTER)


def _bodies(cad: Any, sizes: Any, name: str, ends: _Ends) -> Iterator[Any]:
    """Yield the rod, the bar and the ball of one side of a joint."""
    length = sizes.get(f"{name}_{ends.length}")
    if f"{name}_{ends.rod}" in sizes:
        yield _rod(cad, sizes[f"{name}_{ends.rod}"], length)
    if f"{name}_{ends.bar}_x" in sizes:
        yield _bar(cad, sizes[f"{name}_{ends.bar}_x"], sizes[f"{name}_{ends.bar}_y"], length)
    if f"{name}_{ends.ball}" in sizes:
        yield cad.Sphere(sizes[f"{name}_{ends.ball}"] / 2)


def _rod(cad: Any, diameter: Any, length: Any) -> Any:
    if length is None:
        return cad.Cylinder(diameter / 2, 2 * THROUGH)
    return cad.Cylinder(diameter / 2, length, align=_low(cad))


def _bar(cad: Any, x: Any, y: Any, length: Any) -> Any:
    return cad.Box(x, y, 2 * THROUGH) if length is None else cad.Box(x, y, length, align=_low(cad))


def _high(cad: Any) -> Any:
    return (cad.Align.CENTER, cad.Align.CENTER, cad.Align.MAX)


def _low(cad: Any) -> Any:
    return (cad.Align.CENTER, cad.Align.CENTER, cad.Align.MIN)
