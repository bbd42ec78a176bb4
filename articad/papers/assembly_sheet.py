"""The sheet of the assembly: an isometric view with balloons, and the parts list (ISO 7573)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from articad.arrays import FloatArray
from articad.kernels.views import DrawnView
from articad.papers.callouts import balloons, spots_of
from articad.papers.hatching import hatched
from articad.papers.items import Item
from articad.papers.part_sheet import ISO, SCALES, on_paper, ratio
from articad.papers.sheet import A3, BLOCK, EDGE, FILING, LARGE, ROW, DrawingSheet, Lettering, SheetLine, sampled
from articad.render.camera import Camera
from articad.render.scene import scene_of

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["assembly_sheet"]

_PIXELS: Final = 700
_WIDTHS: Final = (9.0, 42.0, 9.0, 26.0, 34.0, 18.0)
_NOTE: Final = 5.6  # from one line of the notes to the next
_HEAD: Final = ("item", "name", "qty", "material", "size, mm", "kg, one")


def assembly_sheet(
    assembly: Assembly,
    items: Sequence[Item],
    drawn: DrawnView,
    fields: Mapping[str, str],
    notes: Sequence[str] = (),
    section: DrawnView | None = None,
) -> DrawingSheet:
    """Return the sheet of an assembly on A3.

    Args:
        assembly: The product, at rest.
        items: Its items.
        drawn: Its view `ISO`.
        fields: Of the title block, by label.
        notes: Lines of text to the left of the title block.
        section: A section through it, which is drawn above the parts list.
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
    bottom, top = EDGE + 16.0 + _NOTE * len(notes), A3[1] - EDGE - 12.0
    fits = (s for s in SCALES if (high - low)[0] * s <= right - left and (high - low)[1] * s <= top - bottom)
    scale = next(fits, SCALES[-1])
    origin = 0.5 * (np.array([left + right, bottom + top]) - scale * (low + high))
    sheet = DrawingSheet(assembly.name, A3, scale)
    sheet.strokes += [SheetLine("visible", on_paper(line, (float(origin[0]), float(origin[1])), scale)) for line in drawn.visible]
    seen = _seen(assembly, items)
    balloons(sheet, {number: origin + scale * spot for number, spot in seen.items()}, left - 12.0, right + 12.0)
    for row, line in enumerate(reversed(notes)):
        sheet.texts.append(Lettering(FILING + 6.0, EDGE + 12.0 + _NOTE * row, line))
    if hidden := [str(item.number) for item in items if item.number not in seen]:
        sheet.texts.append(Lettering(FILING + 6.0, EDGE + 6.0, f"Not visible in this view: item {', '.join(hidden)}"))
    rows = [
        (str(i.number), i.name, str(i.quantity), i.material or "-", i.size or "-", "-" if i.mass_kg is None else f"{i.mass_kg:.4g}")
        for i in items
    ]
    room = int((A3[1] - EDGE - 14.0 - (EDGE + BLOCK[1] + 6.0)) / ROW) - 2
    more = f" (items 1 to {room} of {len(rows)}; all are in the bill of materials)" if len(rows) > room else ""
    sheet.table(A3[0] - EDGE - 4.0, EDGE + BLOCK[1] + 6.0, f"Parts list{more}", _HEAD, rows[:room], _WIDTHS)
    if section is not None:
        _draw_section(sheet, section, (right + 22.0, EDGE + BLOCK[1] + 16.0 + ROW * (len(rows[:room]) + 1), A3[0] - EDGE - 8.0, top))
    sheet.frame(_fields(assembly, fields, scale), first_angle=False)
    sheet.told = {"assembly": assembly.name, "scale": scale, "items": [item.number for item in items]}
    return sheet


def _draw_section(sheet: DrawingSheet, drawn: DrawnView, room: tuple[float, float, float, float]) -> None:
    """Draw a section at the largest scale at which it fits into a room (left, bottom, right, top); the hatches of one cut face and the next differ."""
    points = np.concatenate([sampled(line) for line in drawn.visible])
    low, high = points.min(axis=0), points.max(axis=0)
    wide, tall = room[2] - room[0], room[3] - room[1] - 8.0
    scale = next((s for s in SCALES if (high - low)[0] * s <= wide and (high - low)[1] * s <= tall), SCALES[-1])
    origin = np.array([0.5 * (room[0] + room[2]), room[1] + 0.5 * tall]) - 0.5 * scale * (low + high)
    sheet.strokes += [SheetLine("visible", on_paper(line, (float(origin[0]), float(origin[1])), scale)) for line in drawn.visible]
    for index, loops in enumerate(sorted(drawn.cut, key=_corner)):
        turn = np.array([1.0 if index % 2 == 0 else -1.0, 1.0])
        for start, end in hatched([turn * (origin + scale * loop) for loop in loops]):
            sheet.line("hatch", *(turn * start), *(turn * end))
    middle, above = 0.5 * (room[0] + room[2]), float(origin[1] + scale * high[1]) + 3.5
    told = "" if scale == sheet.scale else f" ({ratio(scale)})"
    sheet.texts.append(Lettering(middle, above, f"{drawn.name}{told}", LARGE, "middle", bold=True))


def _corner(loops: Sequence[FloatArray]) -> tuple[float, ...]:
    """Return the least corner of a cut face and its size, rounded: an order that is the same on every machine."""
    points = np.concatenate(loops)
    return tuple(np.round([*points.min(axis=0), *np.ptp(points, axis=0)], 3).tolist())


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
