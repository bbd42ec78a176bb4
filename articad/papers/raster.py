"""Sheets as pictures, for those who look at pixels: models, and pages without SVG."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Final

import numpy as np
from PIL import Image, ImageDraw

from articad.arrays import FloatArray
from articad.kernels.views import Arc, Line, Path2d, Segment
from articad.papers.sheet import HEIGHT_OF_CAPITALS, STYLES, DrawingSheet, Lettering, text_width
from articad.render.annotate import font

__all__ = ["sheet_png"]

_FINE: Final = 2  # drawn so many times larger, each way, and reduced
_GREYS: Final = 8
_PLAIN: Final = str.maketrans({"×": "x", "–": "-", "−": "-", "Ø": "O"})  # the font of `articad.render` lacks these
_RIM: Final = 1.0  # mm that are shown outside the frame
_LEAST_PEN: Final = 1.0  # pixels: thinner lines would be too pale to see


def sheet_png(sheet: DrawingSheet, pixels: int) -> bytes:
    """Return a sheet as a PNG file in shades of grey.

    Args:
        sheet: The sheet; its pictures, and the margin outside its frame, are left out.
        pixels: Of the longer side.
    """
    left, bottom, right, top = (side + out for side, out in zip(sheet.inside, (-_RIM, -_RIM, _RIM, _RIM), strict=True))
    k = _FINE * pixels / max(right - left, top - bottom)
    size = (_FINE * round(k / _FINE * (right - left)), _FINE * round(k / _FINE * (top - bottom)))
    image = Image.new("L", size, 255)
    draw = ImageDraw.Draw(image)

    def at(points: FloatArray) -> list[tuple[float, float]]:
        return [(k * (float(x) - left), size[1] - k * (float(y) - bottom)) for x, y in points]

    strokes, arrows, texts = sheet.everything()
    for stroke in strokes:
        thick, dashes = STYLES[stroke.style]
        for points in _dashed(_points(stroke.line, k), dashes):
            draw.line(at(points), fill=0, width=round(max(k * thick, _FINE * _LEAST_PEN)), joint="curve")
    for corners in arrows:
        draw.polygon(at(np.array(corners)), fill=0)
    for text in texts:
        _print(image, text, at(np.array([[text.x, text.y]]))[0], k)
    small = image.resize((size[0] // _FINE, size[1] // _FINE), Image.Resampling.BOX)
    stream = io.BytesIO()
    small.convert("RGB").quantize(palette=_greys(), dither=Image.Dither.NONE).save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def _greys() -> Image.Image:
    palette = Image.new("P", (1, 1))
    palette.putpalette([level for grey in np.linspace(0, 255, _GREYS).round().astype(int).tolist() for level in (grey,) * 3])
    return palette


def _points(line: Line, k: float) -> FloatArray:
    """Return points on a line `(N, 2)` [mm], an arc by chords that miss it by less than a pixel."""
    if isinstance(line, Segment):
        return np.array([[line.x0, line.y0], [line.x1, line.y1]])
    if isinstance(line, Path2d):
        return np.asarray(line.points)
    assert isinstance(line, Arc)
    steps = max(int(np.sqrt(k * line.radius) * np.radians(line.end - line.start)) + 1, 12)
    angles = np.radians(np.linspace(line.start, line.end, steps + 1))
    return np.array([line.x, line.y]) + line.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _dashed(points: FloatArray, dashes: tuple[float, ...]) -> Iterator[FloatArray]:
    """Yield the dashes of a line [mm]; the whole line where it has no gaps."""
    if not dashes:
        yield points
        return
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    at, index = 0.0, 0
    while at < along[-1]:
        end = min(at + dashes[index % len(dashes)], float(along[-1]))
        if index % 2 == 0:
            within = along[(along > at) & (along < end)]
            places = np.concatenate([[at], within, [end]])
            yield np.stack([np.interp(places, along, points[:, column]) for column in (0, 1)], axis=1)
        at, index = end, index + 1


def _print(image: Image.Image, text: Lettering, at: tuple[float, float], k: float) -> None:
    """Write a text at a pixel, as wide as every other writer of sheets makes it."""
    words = text.words.translate(_PLAIN)
    if not words:
        return
    high, wide = k * text.height, k * text_width(text.words, text.height)
    letters = font(round(high / HEIGHT_OF_CAPITALS))
    left, top, right, bottom = letters.getbbox(words, anchor="ls")
    room = 2 * _FINE
    mask = Image.new("L", (round(right - left) + 2 * room, round(bottom - top) + 2 * room), 0)
    ink = ImageDraw.Draw(mask)
    ink.text((room - left, room - top), words, fill=255, font=letters, anchor="ls", stroke_width=int(text.bold))
    for index in (index for index, letter in enumerate(text.words) if letter == "Ø"):
        start, end = (letters.getlength(words[:stop]) + room - left for stop in (index, index + 1))
        ink.line([start, room - top + 0.1 * high, end, room - top - 1.1 * high], fill=255, width=max(round(0.09 * high), 2))
    wider = mask.resize((max(round(mask.width * wide / max(right - left, 1)), 1), mask.height), Image.Resampling.BICUBIC)
    back = {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor] * wide
    across = room * wide / max(right - left, 1)
    x, y = at
    if text.turned:  # reads upwards
        turned = wider.transpose(Image.Transpose.ROTATE_90)
        place = (round(x - (room - top)), round(y + back - (wider.width - across)))
        image.paste(0, (*place, place[0] + turned.width, place[1] + turned.height), turned)
    else:
        place = (round(x - back - across), round(y - (room - top)))
        image.paste(0, (*place, place[0] + wider.width, place[1] + wider.height), wider)
