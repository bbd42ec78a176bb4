"""Clean product pictures: declared materials under soft light, on the ground that they stand on.

For each pixel the visible point is shaded in linear light:
- diffuse light from a bright sky, a darker ground and two lamps, dimmed where other surfaces are near (ambient occlusion);
- the lamps and the horizon are near, as in a studio: flat faces are shaded from one end to the other;
- wood has rings along the longest side of its part;
- reflections of the same lights, sharper for smoother materials, with Schlick's Fresnel term (C. Schlick, An Inexpensive BRDF Model
  for Physically-based Rendering, 1994);
- the result compressed so that white stays below the end of the scale, and encoded as sRGB (IEC 61966-2-1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter

from articad.arrays import FloatArray
from articad.geometry.finish import finish_of
from articad.render.camera import Camera
from articad.render.raycast import BACKGROUND, Buffers, cast, occlusion
from articad.render.scene import DrawnScene
from articad.render.shade import edges

_SUPERSAMPLE = 2
_SKY, _GROUND = 0.54, 0.26  # diffuse light from straight above and from below
_KEY, _FILL = 0.74, 0.14  # strength of the lamps on a surface that faces them
_NEAR = 0.28  # of the scene's size: surfaces within this distance shade each other
_RAYS = 7  # per fine pixel, for the light that reaches a point
_GROUND_RAYS = 12  # per fine pixel of the ground, whose shadow is large and smooth
_REACH = 0.32  # of the scene's size: how far the shadow on the ground extends
_TILE = 61  # pixels after which the pattern of random rays repeats
_SHADOW = 0.95  # darkness of the ground where nothing of the sky is seen
_FADE = 0.8  # how far parts that are only context fade into the background
_EDGE = 0.85  # strength of the lines along edges
_LAMPS_AWAY = 1.5  # of the scene's size: from its middle to the lamps
_PARALLAX = 0.9  # how much lower the horizon is seen from a point that is higher by the scene's size
_RINGS = 110  # rings of wood, about, over the scene's size
_LOW = 0.12  # sine of the lowest view from above that shows the ground
_TOP, _BOTTOM = np.array([247.0, 248.0, 249.0]), np.array([222.0, 226.0, 231.0])  # background, sRGB
_RED = np.array([0.75, 0.03, 0.05])  # overlaps, linear


@dataclass(frozen=True, eq=False)
class _Surfaces:
    """Materials of the items as arrays, one row for each item."""

    color: FloatArray
    metal: FloatArray
    rough: FloatArray
    gloss: FloatArray
    opacity: FloatArray
    grain: FloatArray
    faded: NDArray[np.bool_]


def framed(scene: DrawnScene, camera: Camera, *, margin: float = 1.1, also: FloatArray | None = None) -> Camera:
    """Return the camera moved and scaled so that the scene fills the picture, with room for its shadow.

    Args:
        scene: What to show.
        camera: A camera that looks in the right direction, with the picture's width and height.
        margin: Size of the picture relative to the silhouette.
        also: Further points that must be visible, `(n, 3)`.
    """
    points = np.concatenate([*(item.vertices for item in scene.items if len(item.mesh.vertices)), *(() if also is None else (also,))])
    across, upwards = points @ camera.right, points @ camera.up
    middle = camera.right * (across.max() + across.min()) / 2 + camera.up * (upwards.max() + upwards.min()) / 2
    middle = middle + camera.eye * float(camera.centre @ camera.eye)
    scale = max(np.ptp(across) / camera.width, np.ptp(upwards) / camera.height, 1e-9)
    return replace(camera, centre=middle, mm_per_pixel=float(scale) * margin)


def studio(scene: DrawnScene, camera: Camera, *, transparent: bool = False, floor: float | None = None) -> Image.Image:
    """Draw a scene as a product picture, without labels.

    Args:
        scene: What to draw.
        camera: The camera.
        transparent: Leave out the background; the shadow stays, as a translucent dark.
        floor: Height of the ground [mm]; below the lowest item by default.

    Returns:
        An RGB picture, or RGBA if it is transparent.
    """
    items = tuple(replace(item, smooth=True) for item in scene.items)
    scene = replace(scene, items=items, axes=())
    fine = camera.scaled(_SUPERSAMPLE)
    looks = _looks(scene)
    clear = [index for index, item in enumerate(items) if looks.opacity[index] < 1 and item.manner == "solid"]
    # Hidden items keep their index, so that one table of looks serves both passes.
    solid = replace(scene, items=tuple(_without(item) if index in clear else item for index, item in enumerate(items))) if clear else scene
    color, alpha = _pass(solid, fine, looks)
    shadow = _ground(solid, scene, fine, floor, hidden=alpha >= 1)
    over = np.zeros(alpha.shape, dtype=bool)
    if clear:
        color, alpha = _behind_glass(scene, fine, looks, color, alpha, set(clear))
    buffers = cast(scene, fine) if any(item.manner == "highlight" for item in items) else None
    if buffers is not None:
        over = buffers.over != BACKGROUND
        color[over], alpha[over] = _RED, 1.0
    return _composed(color, alpha, shadow, transparent=transparent)


def _without(item: Any) -> Any:
    mesh = type(item.mesh)(item.mesh.vertices, item.mesh.triangles[:0])
    return replace(item, mesh=mesh)


def _looks(scene: DrawnScene) -> _Surfaces:
    looks = [finish_of(item.material) for item in scene.items]
    srgb = np.array([[int(item.color[start : start + 2], 16) / 255 for start in (1, 3, 5)] for item in scene.items] or [[0.0] * 3])
    return _Surfaces(
        color=np.clip(_linear(srgb), 0.012, 0.86),  # the darkest paint and the brightest that exist
        metal=np.array([look.metal for look in looks] or [0.0]),
        rough=np.array([look.roughness for look in looks] or [0.5]),
        gloss=np.array([look.gloss for look in looks] or [1.0]),
        opacity=np.array([look.opacity for look in looks] or [1.0]),
        grain=np.array([look.grain for look in looks] or [0.0]),
        faded=np.array([item.manner == "faded" for item in scene.items] or [False]),
    )


def _pass(scene: DrawnScene, camera: Camera, looks: _Surfaces) -> tuple[FloatArray, FloatArray]:
    """Return linear colours `(h, w, 3)` and coverage `(h, w)` of what the rays meet first."""
    buffers = cast(scene, camera)
    seen = buffers.item != BACKGROUND
    color = np.zeros((*seen.shape, 3))
    if not seen.any():
        return color, seen.astype(np.float64)
    index, normal = buffers.item[seen], buffers.normal[seen].astype(np.float64)
    points = _points(camera, buffers, seen)
    size = float(np.linalg.norm(np.ptp(scene.bounds, axis=0)))
    open_sky = _smoothed(_openness(scene, camera, points, normal, size, seen), buffers, seen)
    place = points + camera.centre - scene.bounds.mean(axis=0)
    base = looks.color[index] * _grain(scene, place + scene.bounds.mean(axis=0), looks, index, size)
    lit = _light(camera, normal, place / max(size, 1e-9), open_sky, looks, index, base)
    cut = buffers.cut[seen]
    if cut.any():
        rows, columns = np.nonzero(seen)
        line = ((rows + columns) % (7 * _SUPERSAMPLE) < _SUPERSAMPLE)[cut]
        lit[cut] = looks.color[index[cut]] * np.where(line, 0.35, 1.0)[:, None]
    color[seen] = lit
    strength = _lines(edges(camera, buffers))[seen] * _EDGE
    color[seen] *= (1 - strength)[:, None]
    alpha = seen.astype(np.float64)
    alpha[seen] = np.where(looks.faded[index], 1 - _FADE, 1.0)
    return color, alpha


def _lines(edge: FloatArray) -> FloatArray:
    """Return edges as lines of one pixel of the picture: the fine pixels on both sides of each border."""
    lines = edge.copy()
    lines[1:] = np.maximum(lines[1:], edge[:-1])
    lines[:, 1:] = np.maximum(lines[:, 1:], edge[:, :-1])
    return lines


def _points(camera: Camera, buffers: Buffers, seen: NDArray[np.bool_]) -> FloatArray:
    """Return the visible points relative to the camera's centre, `(n, 3)`."""
    plane = camera.plane_points().reshape(*seen.shape, 3)[seen]
    points: FloatArray = plane - buffers.depth[seen].astype(np.float64)[:, None] * camera.eye
    return points


def _openness(
    scene: DrawnScene, camera: Camera, points: FloatArray, normal: FloatArray, size: float, seen: NDArray[np.bool_]
) -> FloatArray:
    """Return the share of the hemisphere over each point that nothing near covers, by rays distributed as the cosine to the normal.

    A random point of the unit sphere added to the unit normal has that distribution.
    """
    total = np.zeros(len(points))
    reach = _NEAR * size
    start = points + normal * 2e-4 * size
    for number in range(_RAYS):
        direction = normal + _directions(seen, number) * 0.999
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        total += 1 - occlusion(scene, camera, start, direction, reach)
    return total / _RAYS


def _directions(pixels: NDArray[np.bool_], number: int) -> FloatArray:
    """Return a random point of the unit sphere for each pixel that is set, `(n, 3)`.

    The same pixel always gets the same point, so that the frames of an animation do not flicker.
    """
    rng = np.random.default_rng(number)
    height, turn = rng.uniform(-1, 1, (_TILE, _TILE)), rng.uniform(0, 2 * math.pi, (_TILE, _TILE))
    rows, columns = np.nonzero(pixels)
    place = (rows % _TILE, columns % _TILE)
    around = np.sqrt(1 - height[place] ** 2)
    return np.stack([around * np.cos(turn[place]), around * np.sin(turn[place]), height[place]], axis=1)


def _smoothed(values: FloatArray, buffers: Buffers, seen: NDArray[np.bool_], reach: int = 3) -> FloatArray:
    """Return the mean over the neighbouring pixels of the same item that face the same way."""
    image = np.zeros(seen.shape)
    image[seen] = values
    total, count = np.zeros(seen.shape), np.zeros(seen.shape)
    height, width = seen.shape
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            here = (slice(max(down, 0), height + min(down, 0)), slice(max(right, 0), width + min(right, 0)))
            there = (slice(max(-down, 0), height + min(-down, 0)), slice(max(-right, 0), width + min(-right, 0)))
            a, b = buffers.normal[here], buffers.normal[there]
            facing = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2] > 0.9
            alike = (buffers.item[here] == buffers.item[there]) & facing
            total[here] += np.where(alike, image[there], 0.0)
            count[here] += alike
    return np.asarray(total[seen] / np.maximum(count[seen], 1))


def _lamps(camera: Camera) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the directions to the key lamp, the fill lamp and the rim lamp."""
    key = 0.75 * camera.eye + 0.8 * camera.up - 0.55 * camera.right
    fill = 0.45 * camera.eye + 0.1 * camera.up + 0.9 * camera.right
    rim = -0.55 * camera.eye + 0.7 * camera.up + 0.25 * camera.right
    first, second, third = (lamp / np.linalg.norm(lamp) for lamp in (key, fill, rim))
    return first, second, third


def _grain(scene: DrawnScene, points: FloatArray, looks: _Surfaces, index: NDArray[Any], size: float) -> FloatArray:
    """Return by how much the rings of wood darken the colour of each point, `(n, 3)`; ones for other materials.

    Rings are the level lines of a function that bends slowly along the longest side of the part, cut by the surface wherever it lies.
    """
    tones = np.ones((len(points), 3))
    for number in np.flatnonzero(looks.grain):
        own = index == number
        if not own.any():
            continue
        item = scene.items[number]
        local = (points[own] - item.T_ground.translation) @ item.T_ground.matrix[:3, :3] * (_RINGS / size)
        longest = int(np.ptp(item.mesh.vertices, axis=0).argmax())
        a, b, c = (local[:, (longest + k) % 3] for k in range(3))
        a = 0.06 * a
        level = b + 0.55 * c + 0.9 * np.sin(0.35 * b + 0.8 * a) + 0.6 * np.sin(1.7 * a + 0.23 * c)
        late = (0.5 + 0.5 * np.sin(2.2 * level)) ** 3
        fine = 0.5 + 0.5 * np.sin(7.1 * b + 5.3 * c + 3 * np.sin(0.9 * c + 2.3 * a))
        tone = 1 - looks.grain[number] * (0.20 * late + 0.07 * fine)
        tones[own] = tone[:, None] ** np.array([1.0, 1.15, 1.3])
    return tones


def _light(
    camera: Camera, normal: FloatArray, place: FloatArray, open_sky: FloatArray, looks: _Surfaces, index: NDArray[Any], base: FloatArray
) -> FloatArray:
    """Return the linear colour of each visible point, `(n, 3)`; `place` is relative to the scene's middle and size."""
    metal, rough, gloss = looks.metal[index][:, None], looks.rough[index], looks.gloss[index]
    ways = [_LAMPS_AWAY * lamp - place for lamp in _lamps(camera)]
    key, fill, rim = (way / np.linalg.norm(way, axis=1, keepdims=True) for way in ways)
    shaded = 0.25 + 0.75 * open_sky
    ambient = (_GROUND + _SKY) / 2 + (_SKY - _GROUND) / 2 * normal[:, 2]
    lamps = _KEY * np.maximum(_along(normal, key), 0) * (0.35 + 0.65 * open_sky) + _FILL * np.maximum(_along(normal, fill), 0)
    diffuse = base * (ambient * shaded + lamps)[:, None]
    # Reflections: the sky's gradient over a dark horizon, and lamps as soft boxes whose size grows with the roughness.
    facing = np.clip(normal @ camera.eye, 0.0, 1.0)
    mirrored = 2 * facing[:, None] * normal - camera.eye
    spread = np.clip(rough, 0.05, 1.0)
    horizon = (mirrored[:, 2] + _PARALLAX * place[:, 2]) / (0.25 + spread)
    reflected = 0.34 + (0.34 + 0.22 * metal[:, 0]) * np.tanh(horizon) + 0.12 * (1 - spread)
    for lamp, strength in ((key, 1.9), (fill, 1.0), (rim, 1.0)):
        sharp = 2.0 / (0.02 + spread**1.6 * 0.55)
        reflected = reflected + strength * (1 - 0.62 * spread) * np.exp(sharp * (_along(mirrored, lamp) - 1))
    reflected = np.maximum(reflected, 0.05) * (0.45 + 0.55 * open_sky)
    mirror = 0.04 * gloss[:, None] * (1 - metal) + base * 1.12 * metal
    grazing = (1 - facing) ** 5 * (1 - 0.75 * spread) * np.minimum(gloss, 1.0)
    fresnel = mirror + (np.maximum(mirror, 0.6) - mirror) * grazing[:, None]
    lit: FloatArray = diffuse * (1 - metal * 0.82) * (1 - 0.5 * grazing[:, None]) + fresnel * reflected[:, None] * (1 + 0.25 * metal)
    return lit


def _along(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the scalar products of the rows of two arrays."""
    product: FloatArray = np.einsum("ij,ij->i", a, b)
    return product


def _behind_glass(
    scene: DrawnScene, camera: Camera, looks: _Surfaces, color: FloatArray, alpha: FloatArray, clear: set[int]
) -> tuple[FloatArray, FloatArray]:
    """Return colours and coverage with translucent items over what is behind them; more opaque where they are seen at a grazing angle."""
    buffers = cast(scene, camera)
    front = np.isin(buffers.item, list(clear))
    if not front.any():
        return color, alpha
    glass, _ = _pass(scene, camera, looks)
    facing = np.clip(buffers.normal[front].astype(np.float64) @ camera.eye, 0, 1)
    own = looks.opacity[buffers.item[front]]
    share = own + (1 - own) * 0.85 * (1 - facing) ** 2.5
    behind = alpha[front]
    total = share + behind * (1 - share)
    color[front] = (glass[front] * share[:, None] + color[front] * (behind * (1 - share))[:, None]) / np.maximum(total, 1e-9)[:, None]
    alpha[front] = total
    return color, alpha


def _ground(scene: DrawnScene, whole: DrawnScene, camera: Camera, floor: float | None, *, hidden: NDArray[np.bool_]) -> FloatArray:
    """Return how dark the ground is at each pixel, 0 to 1: the share of the sky that the scene covers there."""
    shape = (camera.height, camera.width)
    shadow = np.zeros(shape)
    if camera.eye[2] < _LOW:
        return shadow
    lower, upper = whole.bounds
    size = float(np.linalg.norm(upper - lower))
    level = (lower[2] if floor is None else floor) - 1e-3 * size
    plane = camera.plane_points()
    points = plane - camera.eye * ((plane[:, 2] - (level - camera.centre[2])) / camera.eye[2])[:, None]
    place = points + camera.centre
    reach = _REACH * size
    beyond = np.maximum(np.maximum(lower[:2] - place[:, :2], place[:, :2] - upper[:2]), 0)
    distance = np.linalg.norm(beyond, axis=1) / reach  # 0 below the scene, 1 where the shadow ends
    ground = (distance < 1) & ~hidden.ravel()
    if not ground.any():
        return shadow
    pixels = ground.reshape(shape)
    covered = np.zeros(int(ground.sum()))
    for number in range(_GROUND_RAYS):
        direction = np.array([0.0, 0.0, 1.0]) + _directions(pixels, _RAYS + number) * 0.999
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        covered += occlusion(scene, camera, points[ground], direction, 2 * reach)
    fading = (1 - distance[ground]) ** 2 * (1 + 2 * distance[ground])  # level at both ends
    shadow[pixels] = covered / _GROUND_RAYS * fading
    # Blurred over visible ground only, so that the shadow does not fade towards the parts that cast it.
    known = (~hidden).astype(np.float64)
    width = max(min(shape) / 110, 2.0)
    blurred: FloatArray = gaussian_filter(shadow * known, width) / np.maximum(gaussian_filter(known, width), 1e-6)
    return np.clip(blurred, 0, 1) ** 1.1 * _SHADOW


def _composed(color: FloatArray, alpha: FloatArray, shadow: FloatArray, *, transparent: bool) -> Image.Image:
    """Return the picture: parts over the shadow over the background, each fine pixel's share averaged."""
    encoded = _encoded(_compressed(color)) * 255
    if transparent:
        # Premultiplied means, so that borders do not take the colour of what is not there.
        total = alpha + shadow * (1 - alpha)
        premultiplied = _mean(encoded * alpha[..., None])
        covered = _mean(total[..., None])
        rgb = premultiplied / np.maximum(covered, 1e-6)
        pixels = np.concatenate([rgb, covered * 255], axis=2)
        return Image.fromarray(np.clip(np.rint(pixels), 0, 255).astype(np.uint8), "RGBA")
    down = np.linspace(0, 1, alpha.shape[0])[:, None, None]
    paper = (_TOP + (_BOTTOM - _TOP) * down) * (1 - 0.85 * shadow)[..., None]
    pixels = _mean(encoded * alpha[..., None] + paper * (1 - alpha)[..., None])
    return Image.fromarray(np.clip(np.rint(pixels), 0, 255).astype(np.uint8), "RGB")


def _mean(fine: FloatArray) -> FloatArray:
    height, width, channels = fine.shape
    blocks = fine.reshape(height // _SUPERSAMPLE, _SUPERSAMPLE, width // _SUPERSAMPLE, _SUPERSAMPLE, channels)
    mean: FloatArray = blocks.mean(axis=(1, 3))
    return mean


def _compressed(light: FloatArray) -> FloatArray:
    """Return light within 0 to 1: unchanged up to 0.7, then bent so that a value of 2 is almost white."""
    knee = 0.45
    above = np.maximum(light - knee, 0)
    bent: FloatArray = np.minimum(light, knee) + (1 - knee) * (1 - np.exp(-above / (1 - knee)))
    return bent


def _linear(srgb: FloatArray) -> FloatArray:
    linear: FloatArray = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return linear


def _encoded(linear: FloatArray) -> FloatArray:
    encoded: FloatArray = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)
    return encoded
