"""The sheet of the assembly: an isometric view with balloons, and the parts list (ISO 7573)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from scipy.ndimage import distance_transform_edt

from articad.arrays import FloatArray
from articad.kernels.views import Arc, DrawnView, Segment
from articad.papers.items import Item
from articad.papers.part_sheet import ISO, SCALES, on_paper, ratio
from articad.papers.sheet import A3, BLOCK, EDGE, FILING, ROW, SMALL, DrawingSheet, Lettering, SheetLine
from articad.render.camera import Camera
from articad.render.raycast import cast
from articad.render.scene import scene_of

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["assembly_sheet"]

_PIXELS: Final = 700
_RADIUS, _PITCH = 4.0, 10.5  # of balloons
_WIDTHS: Final = (10.0, 48.0, 12.0, 34.0, 22.0)
_HEAD: Final = ("item", "name", "qty", "material", "kg, one")


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
    seen = _balloons(sheet, assembly, items, origin, left - 12.0, right + 12.0)
    if hidden := [str(item.number) for item in items if item.number not in seen]:
        sheet.texts.append(Lettering(FILING + 6.0, EDGE + 6.0, f"Not visible in this view: item {', '.join(hidden)}"))
    rows = [(str(i.number), i.name, str(i.quantity), i.material or "-", "-" if i.mass_kg is None else f"{i.mass_kg:.4g}") for i in items]
    room = int((A3[1] - EDGE - 14.0 - (EDGE + BLOCK[1] + 6.0)) / ROW) - 2
    more = f" (items 1 to {room} of {len(rows)}; all are in the bill of materials)" if len(rows) > room else ""
    sheet.table(A3[0] - EDGE - 4.0, EDGE + BLOCK[1] + 6.0, f"Parts list{more}", _HEAD, rows[:room], _WIDTHS)
    sheet.frame(_fields(assembly, fields, scale), first_angle=False)
    sheet.told = {"assembly": assembly.name, "scale": scale, "items": [item.number for item in items]}
    return sheet


def _balloons(sheet: DrawingSheet, assembly: Assembly, items: Sequence[Item], origin: FloatArray, left: float, right: float) -> set[int]:
    """Draw a balloon for each item that can be seen, in columns on both sides, in the order of height: so leaders do not cross.

    Returns:
        The numbers of these items.
    """
    spots = {number: origin + sheet.scale * spot for number, spot in _visible_spots(assembly, items).items()}
    middle = 0.5 * (left + right)
    sides: dict[bool, list[int]] = {False: [], True: []}
    for number, spot in spots.items():
        sides[bool(spot[0] > middle)].append(number)
    for side, other in ((False, True), (True, False)):  # both columns about equally long
        while len(sides[side]) > len(sides[other]) + 1:
            nearest = min(sides[side], key=lambda number: abs(spots[number][0] - middle))
            sides[side].remove(nearest)
            sides[other].append(nearest)
    _, low, _, high = sheet.inside
    for side, numbers in sides.items():
        numbers.sort(key=lambda number: spots[number][1])
        x = right if side else left
        heights = [float(np.clip(spots[number][1], low + 9.0, high - 9.0)) for number in numbers]
        for index in range(1, len(heights)):  # upwards, so that balloons do not overlap
            heights[index] = max(heights[index], heights[index - 1] + _PITCH)
        over = max(0.0, heights[-1] - (high - 9.0)) if heights else 0.0
        for index in reversed(range(len(heights))):
            limit = high - 9.0 - _PITCH * (len(heights) - 1 - index)
            heights[index] = min(heights[index], limit) if over else heights[index]
        for number, y in zip(numbers, heights, strict=True):
            spot = spots[number]
            towards = (spot - np.array([x, y])) / max(float(np.linalg.norm(spot - np.array([x, y]))), 1e-9)
            start = np.array([x, y]) + _RADIUS * towards
            sheet.strokes.append(SheetLine("thin", Segment(float(start[0]), float(start[1]), float(spot[0]), float(spot[1]))))
            sheet.arrows.append(tuple(spot + 0.5 * np.array([np.cos(a), np.sin(a)]) for a in np.linspace(0, 2 * np.pi, 13)[:-1]))
            sheet.strokes.append(SheetLine("thin", Arc(x, y, _RADIUS, 0.0, 360.0)))
            sheet.texts.append(Lettering(x, y - 0.5 * SMALL, str(number), SMALL, "middle"))
    return set(spots)


def _visible_spots(assembly: Assembly, items: Sequence[Item]) -> dict[int, FloatArray]:
    """Return, for each item of which anything is visible, a point well inside what is seen of one of its parts, in the view's frame [mm]."""
    parts = {name: part for name, part in assembly.parts.items() if part.mesh is not None}
    scene = scene_of(parts, assembly.at())
    lower, upper = scene.bounds
    corners = np.array([[x, y, z] for x in (lower[0], upper[0]) for y in (lower[1], upper[1]) for z in (lower[2], upper[2])])
    centre, right, up = 0.5 * (lower + upper), np.array(ISO.right), np.array(ISO.up)
    step = max(float(np.ptp(corners @ right)), float(np.ptp(corners @ up))) * 1.02 / _PIXELS
    camera = Camera(np.cross(right, up), right, up, centre, step, _PIXELS, _PIXELS)
    seen = cast(scene, camera).item
    owners = np.array([item.name for item in scene.items] + [""])
    found = {}
    for item in items:
        best = (0.0, np.zeros(2))
        for name in item.parts:
            depth = distance_transform_edt(np.pad(np.isin(seen, np.flatnonzero(owners[:-1] == name)), 1))[1:-1, 1:-1]
            row, column = np.unravel_index(int(depth.argmax()), depth.shape)
            if depth[row, column] > best[0]:
                flat = np.array([(column + 0.5 - _PIXELS / 2) * step, (_PIXELS / 2 - row - 0.5) * step])
                best = (float(depth[row, column]), flat + np.array([centre @ right, centre @ up]))
        if best[0] > 0:
            found[item.number] = best[1]
    return found


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
