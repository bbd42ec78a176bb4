"""Balloons with the numbers of items, beside a picture, each with a line to what it names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from scipy.ndimage import distance_transform_edt

from articad.arrays import FloatArray
from articad.kernels.views import Arc, Segment
from articad.papers.sheet import SMALL, DrawingSheet, Lettering, SheetLine
from articad.render.camera import Camera
from articad.render.raycast import cast
from articad.render.scene import DrawnScene

__all__ = ["balloons", "spots_of"]

_RADIUS, _PITCH = 4.0, 10.5
_MARGIN: Final = 9.0  # from the ends of a column


def spots_of(scene: DrawnScene, camera: Camera, wanted: Mapping[int, Sequence[str]]) -> dict[int, FloatArray]:
    """Return, for each number of which anything is visible, a point well inside what is seen of one of its parts.

    Args:
        scene: The parts.
        camera: The picture.
        wanted: Names of parts by number.

    Returns:
        Points `(2,)` to the right of and above the middle of the picture [mm].
    """
    seen = cast(scene, camera).item
    owners = np.array([item.name for item in scene.items] + [""])
    found = {}
    for number, parts in wanted.items():
        best = (0.0, np.zeros(2))
        for name in parts:
            depth = distance_transform_edt(np.pad(np.isin(seen, np.flatnonzero(owners[:-1] == name)), 1))[1:-1, 1:-1]
            row, column = np.unravel_index(int(depth.argmax()), depth.shape)
            if depth[row, column] > best[0]:
                flat = np.array([column + 0.5 - camera.width / 2, camera.height / 2 - row - 0.5]) * camera.mm_per_pixel
                best = (float(depth[row, column]), flat)
        if best[0] > 0:
            found[number] = best[1]
    return found


def balloons(
    sheet: DrawingSheet, spots: Mapping[int, FloatArray], left: float, right: float, between: tuple[float, float] | None = None
) -> None:
    """Draw balloons in columns on both sides, in the order of height: so leaders do not cross.

    Args:
        sheet: The sheet.
        spots: Where each number points `(2,)` [mm of paper].
        left: Place of the left column.
        right: Place of the right column.
        between: Lower and upper end of the columns; those of the frame by default.
    """
    middle = 0.5 * (left + right)
    sides: dict[bool, list[int]] = {False: [], True: []}
    for number, spot in spots.items():
        sides[bool(spot[0] > middle)].append(number)
    for side, other in ((False, True), (True, False)):  # both columns about equally long
        while len(sides[side]) > len(sides[other]) + 1:
            nearest = min(sides[side], key=lambda number: abs(spots[number][0] - middle))
            sides[side].remove(nearest)
            sides[other].append(nearest)
    low, high = (sheet.inside[1], sheet.inside[3]) if between is None else between
    for side, numbers in sides.items():
        numbers.sort(key=lambda number: spots[number][1])
        x = right if side else left
        heights = [float(np.clip(spots[number][1], low + _MARGIN, high - _MARGIN)) for number in numbers]
        for index in range(1, len(heights)):  # upwards, so that balloons do not overlap
            heights[index] = max(heights[index], heights[index - 1] + _PITCH)
        over = max(0.0, heights[-1] - (high - _MARGIN)) if heights else 0.0
        for index in reversed(range(len(heights))):
            limit = high - _MARGIN - _PITCH * (len(heights) - 1 - index)
            heights[index] = min(heights[index], limit) if over else heights[index]
        for number, y in zip(numbers, heights, strict=True):
            spot = spots[number]
            towards = (spot - np.array([x, y])) / max(float(np.linalg.norm(spot - np.array([x, y]))), 1e-9)
            start = np.array([x, y]) + _RADIUS * towards
            sheet.strokes.append(SheetLine("thin", Segment(float(start[0]), float(start[1]), float(spot[0]), float(spot[1]))))
            sheet.arrows.append(tuple(spot + 0.5 * np.array([np.cos(a), np.sin(a)]) for a in np.linspace(0, 2 * np.pi, 13)[:-1]))
            sheet.strokes.append(SheetLine("thin", Arc(x, y, _RADIUS, 0.0, 360.0)))
            sheet.texts.append(Lettering(x, y - 0.5 * SMALL, str(number), SMALL, "middle"))
