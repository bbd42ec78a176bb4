"""The features that a part's joints need, by the names of its dimensions: `part.made(shape)` of a script.

A dimension that is named after a connector makes a feature there: `<connector>_pin`, `_bar_x` and `_bar_y`, `_ball` add material,
`_bore`, `_slot_x` and `_slot_y`, `_socket` cut it. Sizes are diameters and widths [mm]; a pin or bar is `<connector>_length` long from the
connector's origin along its z, a bore or slot `<connector>_depth` deep, or through.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, Final

THROUGH: Final = 1e4  # mm to both sides of the connector
"""Half the length of a cutter that goes through the whole part."""


def made(shape: Any, part: SimpleNamespace) -> tuple[Any, Any]:
    """Return a shape with the features of its joints, and the planned connectors: what `build(part)` returns.

    Args:
        shape: build123d's shape, in the part's frame.
        part: What the script was given.
    """
    import build123d as cad  # noqa: PLC0415 - a traced run replaces the module

    sizes, cutters = part.dimensions, []
    for name, frame in part.connectors.items():
        place = cad.Plane(frame.o, x_dir=frame.x, z_dir=frame.z)
        length, depth = sizes.get(f"{name}_length"), sizes.get(f"{name}_depth")
        if f"{name}_pin" in sizes:
            shape = shape + place * _rod(cad, sizes[f"{name}_pin"], length)
        if f"{name}_bar_x" in sizes:
            shape = shape + place * _bar(cad, sizes[f"{name}_bar_x"], sizes[f"{name}_bar_y"], length)
        if f"{name}_ball" in sizes:
            shape = shape + place * cad.Sphere(sizes[f"{name}_ball"] / 2)
        if f"{name}_bore" in sizes:
            cutters.append(place * _rod(cad, sizes[f"{name}_bore"], depth))
        if f"{name}_slot_x" in sizes:
            cutters.append(place * _bar(cad, sizes[f"{name}_slot_x"], sizes[f"{name}_slot_y"], depth))
        if f"{name}_socket" in sizes:
            cutters.append(place * cad.Sphere(sizes[f"{name}_socket"] / 2))
    for cutter in cutters:  # last, so that no pin fills a bore
        shape = shape - cutter
    return shape, part.connectors


def _rod(cad: Any, diameter: Any, length: Any) -> Any:
    if length is None:
        return cad.Cylinder(diameter / 2, 2 * THROUGH)
    return cad.Cylinder(diameter / 2, length, align=_low(cad))


def _bar(cad: Any, x: Any, y: Any, length: Any) -> Any:
    return cad.Box(x, y, 2 * THROUGH) if length is None else cad.Box(x, y, length, align=_low(cad))


def _low(cad: Any) -> Any:
    return (cad.Align.CENTER, cad.Align.CENTER, cad.Align.MIN)
