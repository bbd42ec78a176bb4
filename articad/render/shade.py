"""Converts buffers to colours: light, edges, cut faces, highlights."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.render.camera import Camera
from articad.render.raycast import BACKGROUND, Buffers
from articad.render.scene import DrawnScene

Picture = NDArray[np.uint8]

PAPER = np.array([250.0, 250.0, 248.0])
INK = np.array([38.0, 42.0, 48.0])
_AMBIENT, _KEY, _FILL = 0.42, 0.50, 0.16
_DARKEST = 104.0  # brightness, of 255: edges and hollows of a darker part would not be visible
_FADE = 0.78  # towards the background, for parts that are only context
_CREASE = 0.86  # cosine of 30 degrees: a sharper bend between neighbours is an edge
_STEP_PIXELS = 4.0  # a larger jump in depth, in pixels, is an outline
_HATCH_PIXELS = 7  # distance of hatching lines on cut faces
_OVER_OPACITY = 0.82


def shade(scene: DrawnScene, camera: Camera, buffers: Buffers) -> Picture:
    """Return the picture, `(height, width, 3)`."""
    picture: Picture = np.empty((*buffers.item.shape, 3), dtype=np.uint8)
    picture[...] = np.rint(PAPER)
    rows, columns = buffers.occupied
    picture[rows, columns] = _shaded(scene, camera, buffers.cropped(rows, columns), at=(rows.start, columns.start))
    return picture


def _shaded(scene: DrawnScene, camera: Camera, buffers: Buffers, at: tuple[int, int]) -> Picture:
    """Return a piece of the picture whose first row and column are `at`."""
    colors = _legible(np.array([_rgb(item.color) for item in scene.items] or [[0.0, 0.0, 0.0]]))
    faded = np.array([item.manner == "faded" for item in scene.items] or [False])
    seen = buffers.item != BACKGROUND
    index = np.where(seen, buffers.item, 0)
    base = colors[index]
    light = _light(camera, buffers.normal)
    picture = base * light[..., None]
    if buffers.cut.any():
        picture = np.where(buffers.cut[..., None], _cut_face(base, at), picture)
    if faded.any():
        picture = np.where(faded[index][..., None], picture + _FADE * (PAPER - picture), picture)
    picture = np.where(seen[..., None], picture, PAPER)
    strength = edges(camera, buffers) * np.where(faded[index] & seen, 0.35, 0.85)
    picture += strength[..., None] * (INK - picture)
    return overlaid(picture, scene, buffers)


def overlaid(picture: NDArray[Any], scene: DrawnScene, buffers: Buffers) -> Picture:
    """Return the picture with highlighted items drawn over everything, `(height, width, 3)`."""
    over = buffers.over != BACKGROUND
    if over.any():
        colors = np.array([_rgb(item.color) for item in scene.items])[np.where(over, buffers.over, 0)]
        picture = np.where(over[..., None], picture + _OVER_OPACITY * (colors - picture), picture)
    pixels: Picture = np.clip(np.rint(picture), 0, 255).astype(np.uint8)
    return pixels


def reduced(picture: Picture, factor: int) -> Picture:
    """Return the mean of each square of `factor` pixels: smooth edges from a larger picture."""
    if factor == 1:
        return picture
    height, width = picture.shape[0] // factor, picture.shape[1] // factor
    blocks = picture.reshape(height, factor, width, factor, 3).astype(np.float64)
    means: Picture = np.rint(blocks.mean(axis=(1, 3))).astype(np.uint8)
    return means


def _rgb(color: str) -> list[float]:
    return [float(int(color[start : start + 2], 16)) for start in (1, 3, 5)]


def _legible(colors: FloatArray) -> FloatArray:
    """Return colours `(n, 3)` with the dark ones mixed with white until they are as bright as `_DARKEST`."""
    brightness = colors @ np.array([0.2126, 0.7152, 0.0722])
    share = np.clip((_DARKEST - brightness) / (255.0 - np.minimum(brightness, _DARKEST)), 0.0, 1.0)
    lighter: FloatArray = colors + share[:, None] * (255.0 - colors)
    return lighter


def _light(camera: Camera, normal: NDArray[np.float32]) -> FloatArray:
    """Brightness: a key light over the viewer's left shoulder and a weaker one from the right, both fixed to the camera."""
    key = camera.eye + 0.5 * camera.up - 0.35 * camera.right
    fill = camera.eye - 0.2 * camera.up + 0.9 * camera.right
    key, fill = key / np.linalg.norm(key), fill / np.linalg.norm(fill)
    brightness: FloatArray = _AMBIENT + _KEY * np.maximum(normal @ key, 0) + _FILL * np.maximum(normal @ fill, 0)
    return brightness


def _cut_face(base: FloatArray, at: tuple[int, int]) -> FloatArray:
    """Hatch as on a drawing: the part's colour, lighter, with lines at 45 degrees."""
    rows, columns = np.indices(base.shape[:2])
    line = ((rows + columns + sum(at)) % _HATCH_PIXELS) == 0
    lighter = base + 0.35 * (PAPER - base)
    return np.where(line[..., None], base * 0.45, lighter)


def _dot(a: NDArray[np.float32], b: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the scalar products of vectors; `sum(axis=-1)` takes three times as long."""
    product: NDArray[np.float32] = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]
    return product


def edges(camera: Camera, buffers: Buffers) -> FloatArray:
    """Return 1 where a pixel and its right or lower neighbour show different parts, a crease or a step in depth."""
    edge = np.zeros(buffers.item.shape)
    depth = np.where(np.isfinite(buffers.depth), buffers.depth, 0.0)
    for axis in (0, 1):
        first = [slice(None), slice(None)]
        second = [slice(None), slice(None)]
        first[axis], second[axis] = slice(None, -1), slice(1, None)
        a, b = tuple(first), tuple(second)
        differ = buffers.item[a] != buffers.item[b]
        same = ~differ & (buffers.item[a] != BACKGROUND)
        crease = same & (_dot(buffers.normal[a], buffers.normal[b]) < _CREASE)
        # An oblique face changes depth by its slope; only more than that is a step.
        slope = np.abs(buffers.normal[a] @ camera.eye)
        allowed = camera.mm_per_pixel * _STEP_PIXELS / np.maximum(slope, 0.1)
        step = same & (np.abs(depth[a] - depth[b]) > allowed)
        edge[a] = np.maximum(edge[a], differ | crease | step)
    return edge
