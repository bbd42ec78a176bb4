"""For each pixel: the visible part, its distance and its normal. The only user of Embree."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.render.camera import Camera
from articad.render.scene import DrawnScene

FloatImage = NDArray[np.float32]
IndexImage = NDArray[np.int32]

BACKGROUND = -1
_STEP = 1e-4  # of the scene's size: offset behind a surface at which a ray continues; float32 resolves 1e-7


@dataclass(frozen=True, eq=False)
class Buffers:
    """The results of the rays of a picture.

    Attributes:
        item: Index into `DrawnScene.items`, `BACKGROUND` if there is nothing, `(height, width)`.
        depth: Distance behind the plane through the camera's centre (negative: in front) [mm]; inf for background.
        normal: Unit normal towards the viewer, `(height, width, 3)`; zero for background.
        cut: True if the section plane cuts through a solid.
        over: Index of the highlighted item that lies anywhere on the ray, else `BACKGROUND`.
    """

    item: IndexImage
    depth: FloatImage
    normal: FloatImage
    cut: NDArray[np.bool_]
    over: IndexImage


def cast(scene: DrawnScene, camera: Camera) -> Buffers:
    """Cast one ray through the centre of each pixel.

    Vertices are made relative to the camera's centre before the conversion to float32, so that a scene far from the origin is as sharp
    as one at it.
    """
    plain = [index for index, item in enumerate(scene.items) if item.manner != "highlight"]
    marked = [index for index, item in enumerate(scene.items) if item.manner == "highlight"]
    size = float(np.linalg.norm(scene.bounds[1] - scene.bounds[0])) + camera.mm_per_pixel * max(camera.width, camera.height)
    origins = camera.plane_points() + camera.eye * size
    start = np.zeros(len(origins))
    end = np.full(len(origins), 4 * size)
    if scene.section is not None:
        start, end = _kept_interval(scene, camera, origins, end)
    item, distance, normal, cut = _first_hits(scene, plain, camera, origins, start, end, step=_STEP * size)
    over = np.full(len(origins), BACKGROUND, dtype=np.int32)
    if marked:
        over = _first_hits(scene, marked, camera, origins, np.zeros(len(origins)), np.full(len(origins), 4 * size), step=_STEP * size)[0]
    shape = (camera.height, camera.width)
    return Buffers(
        item=item.reshape(shape),
        depth=(distance - size).astype(np.float32).reshape(shape),
        normal=normal.astype(np.float32).reshape(*shape, 3),
        cut=cut.reshape(shape),
        over=over.reshape(shape),
    )


def _kept_interval(scene: DrawnScene, camera: Camera, origins: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the interval of each ray inside the half-space that a section keeps."""
    assert scene.section is not None
    normal = np.array(scene.section.normal) / np.linalg.norm(scene.section.normal)
    toward = -camera.eye
    height = (origins - (np.array(scene.section.point) - camera.centre)) @ normal
    rate = float(toward @ normal)
    start = np.zeros(len(origins))
    if abs(rate) < 1e-9:  # the plane is seen edge-on: whole rays are kept or lost
        return start, np.where(height <= 0, end, 0.0)
    crossing = -height / rate
    if rate < 0:
        return np.maximum(crossing, 0.0), end
    return start, np.clip(crossing, 0.0, end)


def _first_hits(
    scene: DrawnScene, indices: list[int], camera: Camera, origins: FloatArray, start: FloatArray, end: FloatArray, *, step: float
) -> tuple[IndexImage, FloatArray, FloatArray, NDArray[np.bool_]]:
    """Return item, distance, normal and whether the ray began inside the item, for each ray."""
    count = len(origins)
    item = np.full(count, BACKGROUND, dtype=np.int32)
    distance = np.full(count, np.inf)
    normal = np.zeros((count, 3))
    cut = np.zeros(count, dtype=np.bool_)
    indices = [index for index in indices if len(scene.items[index].mesh.triangles)]
    if not indices or not count:
        return item, distance, normal, cut
    embree = _embree_scene(scene, tuple(indices), tuple(camera.centre))
    toward = -camera.eye
    direction = np.broadcast_to(toward.astype(np.float32), (count, 3)).copy()
    begin = (origins + start[:, None] * toward).astype(np.float32)
    dists = np.maximum(end - start, 0).astype(np.float32)
    hit = embree.run(begin, direction, dists=dists.copy(), output=1)  # Embree writes into it
    found = (hit["geomID"] >= 0) & (end > start)
    item[found] = np.asarray(indices, dtype=np.int32)[hit["geomID"][found]]
    distance[found] = start[found] + hit["tfar"][found]
    Ng = hit["Ng"][found].astype(np.float64)
    Ng /= np.maximum(np.linalg.norm(Ng, axis=1, keepdims=True), 1e-30)
    facing = Ng @ camera.eye
    normal[found] = np.where(facing[:, None] < 0, -Ng, Ng)
    if scene.section is not None:
        toward_viewer = np.array(scene.section.normal) / np.linalg.norm(scene.section.normal)
        if toward_viewer @ camera.eye < 0:
            toward_viewer = -toward_viewer
        # Each solid alone: if two touch, the first of all surfaces does not show inside which of them the ray began.
        for index in indices:
            alone = _embree_scene(scene, (index,), tuple(camera.centre)).run(begin, direction, dists=dists.copy(), output=1)
            inside = (alone["geomID"] >= 0) & (alone["Ng"].astype(np.float64) @ camera.eye < 0) & (start > step) & (end > start)
            item[inside], distance[inside], normal[inside] = index, start[inside], toward_viewer
            cut |= inside
    return item, distance, normal, cut


@lru_cache(maxsize=4)  # one scene is drawn from several sides; its tree costs as much as a picture
def _embree_scene(scene: DrawnScene, indices: tuple[int, ...], centre: tuple[float, ...]) -> Any:
    # Embree costs 0.1 s to load and is not on every platform.
    from embreex import rtcore_scene  # noqa: PLC0415
    from embreex.mesh_construction import TriangleMesh  # noqa: PLC0415

    embree = rtcore_scene.EmbreeScene(robust=True)  # no ray slips between two triangles
    for index in indices:
        entry = scene.items[index]
        vertices = np.ascontiguousarray(entry.vertices - np.array(centre), dtype=np.float32)
        TriangleMesh(embree, vertices, np.ascontiguousarray(entry.mesh.triangles, dtype=np.int32))
    return embree
