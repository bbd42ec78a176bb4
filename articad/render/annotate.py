"""Annotations of a picture: names, joint axes, directions, a scale bar, a title."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from articad.arrays import FloatArray
from articad.render.camera import Camera
from articad.render.raycast import BACKGROUND, Buffers
from articad.render.scene import AxisMark, DrawnScene

Color = tuple[int, int, int]
Labels = bool | Literal["aside"]
"""Whether parts are labelled in place, or beside the picture with a line to each part."""

_Name = tuple[tuple[float, float], str, Color]  # the point that is named, the name, its colour

INK: Color = (30, 34, 40)
QUIET: Color = (110, 116, 124)
HALO: Color = (250, 250, 248)
AXIS_COLORS: tuple[Color, Color, Color] = ((200, 40, 40), (30, 140, 60), (40, 80, 200))
JOINT: Color = (0, 96, 160)
MARK: Color = (214, 28, 36)
_SMALLEST_LABELLED = 40  # pixels: a part with a smaller visible area gets no name
_MOST_NAMES = 12  # names in one picture; more would hide it
_MOST_AXES = 7
_END_ON = 14.0  # pixels: half of the box around an axis that is seen end on
_SMALLEST_RING = 13.0  # pixels: smallest radius of a ring around a highlight
_LARGEST_RING = 0.16  # of the picture's width: a larger highlight needs no ring
_MOST_RINGS = 12
_LOWERED = 4  # how often a name moves down before it is left out
_MOST_ASIDE = 40  # names beside a picture, including those of joints: more do not fit in the columns
_LINE = 15  # pixels from one name in a column to the next
_WIDEST_NAME = 190  # pixels
_ABOVE, _BELOW = 26, 92  # pixels of a column for the title, and for the arrows of the axes with the last name's own height
_TRIAD_PIXELS = 26
_AXIS_SHARE = 0.13  # of the picture's width, to each side of the joint


def annotate(
    image: Image.Image, scene: DrawnScene, camera: Camera, buffers: Buffers, *, labels: Labels, axes: bool, title: str | None
) -> Image.Image:
    """Return the picture with its annotations; `buffers` may have more pixels than the picture."""
    draw = ImageDraw.Draw(image)
    taken: list[tuple[float, float, float, float]] = []
    names: list[_Name] = []
    _rings(draw, camera, buffers, taken)
    if axes:
        shown = scene.axes if len(scene.axes) <= _MOST_AXES else ()
        marks = [_joint_axis(draw, axis, camera, taken) for axis in shown]
        names += [(mark[labels == "aside"], axis.name, JOINT) for axis, mark in zip(shown, marks, strict=True)]
    if labels:
        names += _part_names(scene, camera, buffers, _MOST_ASIDE if labels == "aside" else _MOST_NAMES)
    if labels == "aside":
        _columns(draw, names[:_MOST_ASIDE], camera)
    else:
        for at, text, color in names:  # all marks first: none covers a name
            _place(draw, at, text, color, camera, taken)
    _triad(draw, camera)
    _scale_bar(draw, camera)
    if title:
        _text(draw, (8, 6), title, INK, size=13)
    return image


def font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """Return the font that comes with Pillow, so that pictures do not depend on the system's fonts."""
    return ImageFont.load_default(size)


def _text(draw: ImageDraw.ImageDraw, at: tuple[float, float], text: str, color: Color, *, size: int = 11) -> None:
    draw.text(at, text, fill=color, font=font(size), stroke_width=2, stroke_fill=HALO)


def _place(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    text: str,
    color: Color,
    camera: Camera,
    taken: list[tuple[float, float, float, float]],
) -> None:
    """Write a name near a point, lower if another name is there, and never outside the picture."""
    x0, y0, x1, y1 = draw.textbbox((0, 0), text, font=font(11))
    width, height = x1 - x0, y1 - y0 + 3
    left = min(max(at[0] - width / 2, 2), camera.width - width - 2)
    top = min(max(at[1] - height / 2, 22), camera.height - height - 2)
    for _ in range(_LOWERED):
        clash = [box for box in taken if left < box[2] and box[0] < left + width and top < box[3] and box[1] < top + height]
        if not clash:
            break
        top = max(box[3] for box in clash) + 1
    else:
        return  # too far from what it names: no name is better than a misleading one
    if top > camera.height - height - 2:
        return
    taken.append((left, top, left + width, top + height))
    _text(draw, (left, top), text, color)


def room_beside(scene: DrawnScene) -> int:
    """Return the width of the columns for names on both sides of a picture [pixels]."""
    names = {item.name for item in scene.items} | {axis.name for axis in scene.axes}
    return min(max((math.ceil(_measured(name)) for name in names), default=0), _WIDEST_NAME) + 10


def _measured(text: str) -> float:
    return float(font(11).getlength(text))


def _columns(draw: ImageDraw.ImageDraw, names: list[_Name], camera: Camera) -> None:
    """Write names beside the picture, left and right, each with a line to what it names."""
    across = sorted(names, key=lambda name: (name[0][0], name[0][1]))
    half = len(across) // 2
    for left, column in ((True, across[:half]), (False, across[half:])):
        tops, lowest = [], _ABOVE - _LINE
        down = sorted(column, key=lambda name: name[0][1])
        for (_, y), _, _ in down:
            lowest = max(lowest + _LINE, round(y) - _LINE // 2)
            tops.append(lowest)
        highest = camera.height - _BELOW + _LINE
        for index in reversed(range(len(tops))):  # names that do not fit below move up, and push those above them
            tops[index] = highest = min(tops[index], highest - _LINE)
        for (at, text, color), top in zip(down, tops, strict=True):
            width = _measured(text)
            x = 4.0 if left else camera.width - 4 - width
            end = x + width + 3 if left else x - 3
            for fill, thick in ((HALO, 3), (color if color == JOINT else QUIET, 1)):
                draw.line([(end, top + _LINE // 2), at], fill=fill, width=thick)
            draw.ellipse((at[0] - 2.5, at[1] - 2.5, at[0] + 2.5, at[1] + 2.5), fill=color, outline=HALO)
            _text(draw, (x, top), text, color)


def _part_names(scene: DrawnScene, camera: Camera, buffers: Buffers, most: int) -> list[_Name]:
    """Return the names of the parts with the largest visible areas, and their places; small parts get none if names would hide much."""
    ratio = buffers.item.shape[1] / camera.width
    by_name: dict[str, list[int]] = {}
    for index, item in enumerate(scene.items):
        if item.manner == "solid":
            by_name.setdefault(item.name, []).append(index)
    seen = {name: np.nonzero(np.isin(buffers.item, indices)) for name, indices in by_name.items()}
    largest = sorted(seen, key=lambda name: -len(seen[name][0]))[:most]
    names: list[_Name] = []
    for name in largest:
        rows, columns = seen[name]
        if len(rows) < _SMALLEST_LABELLED * ratio**2:
            continue
        # The pixel nearest to the mean lies on the part, even if the part has a hole in its middle.
        nearest = np.argmin((rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2)
        names.append(((float(columns[nearest] / ratio), float(rows[nearest] / ratio)), name, INK))
    return names


def _rings(draw: ImageDraw.ImageDraw, camera: Camera, buffers: Buffers, taken: list[tuple[float, float, float, float]]) -> None:
    """Draw a ring around each small highlight, and keep names out of it."""
    ratio = buffers.item.shape[1] / camera.width
    found = []
    for index in np.unique(buffers.over[buffers.over != BACKGROUND]).tolist():
        rows, columns = np.nonzero(buffers.over == index)
        box = np.array([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]) / ratio
        found.append((float(np.hypot(box[2] - box[0], box[3] - box[1])) / 2 + 4, (box[:2] + box[2:]) / 2))
    for reach, at in sorted(found, key=lambda entry: -entry[0])[:_MOST_RINGS]:
        radius = max(reach, _SMALLEST_RING)
        box = (at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius)
        taken.append(box)
        if radius <= _LARGEST_RING * camera.width:
            draw.ellipse((box[0] - 1, box[1] - 1, box[2] + 1, box[3] + 1), outline=HALO, width=5)
            draw.ellipse(box, outline=MARK, width=3)


def _joint_axis(
    draw: ImageDraw.ImageDraw, axis: AxisMark, camera: Camera, taken: list[tuple[float, float, float, float]]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Draw a joint's axis and its positive direction; return the place for its name, and a point of the axis."""
    direction = np.array(axis.direction)
    along = camera.project(camera.centre + direction * camera.mm_per_pixel) - camera.project(camera.centre[None])
    seen = float(np.linalg.norm(along))
    at = camera.project(np.array([axis.point]))[0]
    if axis.hand and axis.turns:
        _hand(draw, at, camera.project(np.array([axis.point]) + axis.hand * np.array(axis.across))[0])
    towards = float(direction @ camera.eye)
    if seen < 0.08:
        _end_on(draw, at, towards=towards > 0, turns=axis.turns)
        taken.append((at[0] - _END_ON, at[1] - _END_ON, at[0] + _END_ON, at[1] + _END_ON))
        return (float(at[0]), float(at[1]) - 24), (float(at[0]), float(at[1]))
    unit = along.reshape(2) / seen
    length = _AXIS_SHARE * camera.width * max(seen, 0.35)
    tail, tip = at - unit * length, at + unit * length
    _dashed(draw, tail, tip)
    _arrow_head(draw, tip, unit)
    if axis.turns:
        _turn_arrow(draw, at + unit * length * 0.72, unit, towards)
    seen_tip = tip if (tip > 0).all() and (tip < (camera.width, camera.height)).all() else at
    return (float(tip[0] + unit[0] * 14), float(tip[1] + unit[1] * 12)), (float(seen_tip[0]), float(seen_tip[1]))


def _hand(draw: ImageDraw.ImageDraw, at: FloatArray, tip: FloatArray) -> None:
    """Draw a hand that turns with a round part."""
    for fill, width in ((HALO, 6), (MARK, 3)):
        draw.line([(at[0], at[1]), (tip[0], tip[1])], fill=fill, width=width)
    draw.ellipse((tip[0] - 4, tip[1] - 4, tip[0] + 4, tip[1] + 4), fill=MARK, outline=HALO)


def _dashed(draw: ImageDraw.ImageDraw, start: FloatArray, end: FloatArray) -> None:
    """Draw a centre line: long dash, gap, dot, gap."""
    total = float(np.linalg.norm(end - start))
    unit = (end - start) / max(total, 1e-9)
    position = 0.0
    for index in range(1000):
        if position >= total:
            return
        stroke = min((9.0, 2.0)[index % 2], total - position)
        a, b = start + unit * position, start + unit * (position + stroke)
        draw.line([(a[0], a[1]), (b[0], b[1])], fill=JOINT, width=2)
        position += stroke + 3.0


def _arrow_head(draw: ImageDraw.ImageDraw, tip: FloatArray, unit: FloatArray, *, size: float = 7.0) -> None:
    across = np.array([-unit[1], unit[0]])
    left, right = tip - unit * size + across * size * 0.45, tip - unit * size - across * size * 0.45
    draw.polygon([(tip[0], tip[1]), (left[0], left[1]), (right[0], right[1])], fill=JOINT)


def _end_on(draw: ImageDraw.ImageDraw, at: FloatArray, *, towards: bool, turns: bool) -> None:
    """Draw an axis that points at the viewer (a dot) or away (a cross), and the positive turn around it."""
    radius = 5.0
    draw.ellipse((at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius), outline=JOINT, width=2)
    if towards:
        draw.ellipse((at[0] - 1.5, at[1] - 1.5, at[0] + 1.5, at[1] + 1.5), fill=JOINT)
    else:
        reach = radius / math.sqrt(2)
        for side in (1, -1):
            draw.line([(at[0] - reach, at[1] - side * reach), (at[0] + reach, at[1] + side * reach)], fill=JOINT, width=2)
    if turns:
        _arc_arrow(draw, at, np.array([13.0, 0.0]), np.array([0.0, -13.0 if towards else 13.0]))


def _turn_arrow(draw: ImageDraw.ImageDraw, at: FloatArray, unit: FloatArray, towards: float) -> None:
    """Draw an arc around an oblique axis whose arrow shows the positive turn, right-handed.

    Args:
        draw: Drawing context.
        at: Middle of the arc [pixels].
        unit: Direction of the axis in the picture, rows downwards.
        towards: Cosine of the angle between the axis and the direction to the viewer, who sees the circle's upper side when it is positive.
    """
    across = np.array([-unit[1], unit[0]])
    open_by = math.copysign(max(3.5, 10.0 * abs(towards)), towards if abs(towards) > 1e-9 else 1.0)
    _arc_arrow(draw, at, across * 10.0, unit * open_by)


def _arc_arrow(draw: ImageDraw.ImageDraw, at: FloatArray, right: FloatArray, back: FloatArray) -> None:
    """Draw most of an ellipse with an arrow head, from `right` through `back`; it is open in front."""
    points = [at + right * math.cos(angle) + back * math.sin(angle) for angle in np.radians(np.linspace(-50, 230, 29))]
    draw.line([(point[0], point[1]) for point in points], fill=HALO, width=5)
    draw.line([(point[0], point[1]) for point in points], fill=JOINT, width=2)
    heading = points[-1] - points[-3]
    heading /= max(float(np.linalg.norm(heading)), 1e-9)
    _arrow_head(draw, points[-1] + heading * 4, heading, size=8.0)


def _triad(draw: ImageDraw.ImageDraw, camera: Camera) -> None:
    origin = np.array([_TRIAD_PIXELS + 12.0, camera.height - _TRIAD_PIXELS - 12.0])
    order = sorted(range(3), key=lambda index: float(camera.eye[index]))  # the axis that points at the viewer last
    for index in order:
        axis = np.eye(3)[index]
        flat = np.array([axis @ camera.right, -(axis @ camera.up)])
        end = origin + flat * _TRIAD_PIXELS
        if np.linalg.norm(flat) < 0.05:
            continue
        draw.line([(origin[0], origin[1]), (end[0], end[1])], fill=AXIS_COLORS[index], width=2)
        _text(draw, (end[0] + flat[0] * 7 - 4, end[1] + flat[1] * 7 - 6), "XYZ"[index], AXIS_COLORS[index])


def _scale_bar(draw: ImageDraw.ImageDraw, camera: Camera) -> None:
    wanted = camera.mm_per_pixel * camera.width * 0.22
    power = 10.0 ** math.floor(math.log10(wanted))
    length = max(step * power for step in (1, 2, 5) if step * power <= wanted)
    pixels = length / camera.mm_per_pixel
    right, bottom = camera.width - 12, camera.height - 14
    left = right - pixels
    draw.line([(left, bottom), (right, bottom)], fill=INK, width=2)
    for end in (left, right):
        draw.line([(end, bottom - 4), (end, bottom + 4)], fill=INK, width=2)
    _text(draw, (left, bottom - 18), f"{length:g} mm", INK)
