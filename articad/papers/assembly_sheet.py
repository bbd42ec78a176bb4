"""The sheet of the assembly: an isometric view with balloons, and the parts list (ISO 7573)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from articad.arrays import FloatArray
from articad.kernels.views import DrawnView
from articad.papers.callouts import balloons, spots_of
from articad.papers.items import Item
from articad.papers.part_sheet import ISO, SCALES, on_paper, ratio
from articad.papers.sheet import A3, BLOCK, EDGE, FILING, ROW, DrawingSheet, Lettering, SheetLine
from articad.render.camera import Camera
from articad.render.scene import scene_of

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["assembly_sheet"]

_PIXELS: Final = 700
_WIDTHS: Final = (9.0, 42.0, 9.0, 26.0, 34.0, 18.0)
_HEAD: Final = ("item", "name", "qty", "material", "size, mm", "kg, one")


def assembly_sheet(assembly: Assembly, items: Sequence[Item], drawn: DrawnView, fields: Mapping[str, str]) -> DrawingSheet:
    """Return the sheet of an assembly on A3.

    Args:
        assembly: The product, at rest.
        items: Its items.
        drawn: Its view `ISO`.
        fields: Of the title block, by label.
    """
    points = np.concatenate(
        [
            (T.rotation @ part.mesh.vertices.T).T + T.translation
            for name, T in assembly.at().items()
            if (part := assembly.parts[name]).mesh is not None
        ]
    )
    flat = points @ np.array([ISO.right, ISO.up]).T
    low, high = flat.min(axis=0), flat.max(axis=0)
    table = sum(_WIDTHS)
    left, right = FILING + 22.0, A3[0] - EDGE - 4.0 - table - 22.0
    bottom, top = EDGE + 16.0, A3[1] - EDGE - 12.0
    fits = (s for s in SCALES if (high - low)[0] * s <= right - left and (high - low)[1] * s <= top - bottom)
    scale = next(fits, SCALES[-1])
    origin = 0.5 * (np.array([left + right, bottom + top]) - scale * (low + high))
    sheet = DrawingSheet(assembly.name, A3, scale)
    sheet.strokes += [SheetLine("visible", on_paper(line, (float(origin[0]), float(origin[1])), scale)) for line in drawn.visible]
    seen = _seen(assembly, items)
    balloons(sheet, {number: origin + scale * spot for number, spot in seen.items()}, left - 12.0, right + 12.0)
    if hidden := [str(item.number) for item in items if item.number not in seen]:
        sheet.texts.append(Lettering(FILING + 6.0, EDGE + 6.0, f"Not visible in this view: item {', '.join(hidden)}"))
    rows = [
        (str(i.number), i.name, str(i.quantity), i.material or "-", i.size or "-", "-" if i.mass_kg is None else f"{i.mass_kg:.4g}")
        for i in items
    ]
    room = int((A3[1] - EDGE - 14.0 - (EDGE + BLOCK[1] + 6.0)) / ROW) - 2
    more = f" (items 1 to {room} of {len(rows)}; all are in the bill of materials)" if len(rows) > room else ""
    sheet.table(A3[0] - EDGE - 4.0, EDGE + BLOCK[1] + 6.0, f"Parts list{more}", _HEAD, rows[:room], _WIDTHS)
    sheet.frame(_fields(assembly, fields, scale), first_angle=False)
    sheet.told = {"assembly": assembly.name, "scale": scale, "items": [item.number for item in items]}
    return sheet


def _seen(assembly: Assembly, items: Sequence[Item]) -> dict[int, FloatArray]:
    """Return, for each item of which anything is visible, a point well inside what is seen of one of its parts, in the view's frame [mm]."""
    parts = {name: part for name, part in assembly.parts.items() if part.mesh is not None}
    scene = scene_of(parts, assembly.at())
    lower, upper = scene.bounds
    corners = np.array([[x, y, z] for x in (lower[0], upper[0]) for y in (lower[1], upper[1]) for z in (lower[2], upper[2])])
    centre, right, up = 0.5 * (lower + upper), np.array(ISO.right), np.array(ISO.up)
    step = max(float(np.ptp(corners @ right)), float(np.ptp(corners @ up))) * 1.02 / _PIXELS
    camera = Camera(np.cross(right, up), right, up, centre, step, _PIXELS, _PIXELS)
    middle = np.array([centre @ right, centre @ up])
    return {number: middle + flat for number, flat in spots_of(scene, camera, {item.number: item.parts for item in items}).items()}


def _fields(assembly: Assembly, fields: Mapping[str, str], scale: float) -> list[tuple[str, str, float, float, float]]:
    return [
        ("Assembly", assembly.name, 0.0, 0.0, 150.0),
        ("Sheet", fields.get("Sheet", ""), 150.0, 0.0, 30.0),
        ("Overall size at rest, mm", fields.get("Overall", ""), 0.0, 10.0, 100.0),
        ("Parts", fields.get("Parts", ""), 100.0, 10.0, 40.0),
        ("Items", fields.get("Items", ""), 140.0, 10.0, 40.0),
        ("Mass", fields.get("Mass", "-"), 0.0, 20.0, 100.0),
        ("Scale", ratio(scale), 100.0, 20.0, 40.0),
        ("Projection", "isometric", 140.0, 20.0, 40.0),
    ]
