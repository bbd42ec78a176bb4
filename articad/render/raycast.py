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
from articad.render.simplify import corner_normals

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

    @property
    def occupied(self) -> tuple[slice, slice]:
        """Rows and columns outside of which there is nothing, with one more on each side for outlines."""
        shown = (self.item != BACKGROUND) | (self.over != BACKGROUND)
        if not shown.any():
            return slice(0, 0), slice(0, 0)
        rows, columns = np.nonzero(shown.any(axis=1))[0], np.nonzero(shown.any(axis=0))[0]
        return slice(max(int(rows[0]) - 1, 0), int(rows[-1]) + 2), slice(max(int(columns[0]) - 1, 0), int(columns[-1]) + 2)

    def cropped(self, rows: slice, columns: slice) -> Buffers:
        """Return a piece of the picture."""
        at = (rows, columns)
        return Buffers(self.item[at], self.depth[at], self.normal[at], self.cut[at], self.over[at])


def cast(scene: DrawnScene, camera: Camera) -> Buffers:
    """Cast one ray through the centre of each pixel.

    Vertices are made relative to the camera's centre before the conversion to float32, so that a scene far from the origin is as sharp
    as one at it.
    """
    plain = [index for index, item in enumerate(scene.items) if item.manner not in {"glass", "highlight"}]
    marked = [index for index, item in enumerate(scene.items) if item.manner == "highlight"]
    size = float(np.linalg.norm(scene.bounds[1] - scene.bounds[0])) + camera.mm_per_pixel * max(camera.width, camera.height)
    rows, columns = _occupied(scene, camera)
    origins = camera.plane_points(rows, columns) + camera.eye * size
    start = np.zeros(len(origins))
    end = np.full(len(origins), 4 * size)
    if scene.section is not None:
        start, end = _kept_interval(scene, camera, origins, end)
    item, distance, normal, cut = _first_hits(scene, plain, camera, origins, start, end, step=_STEP * size)
    over = np.full(len(origins), BACKGROUND, dtype=np.int32)
    if marked:
        over = _first_hits(scene, marked, camera, origins, np.zeros(len(origins)), np.full(len(origins), 4 * size), step=_STEP * size)[0]

    def whole(values: NDArray[Any], empty: Any, kind: type) -> NDArray[Any]:
        picture = np.full((camera.height, camera.width, *values.shape[1:]), empty, dtype=kind)
        inside = picture[rows, columns]
        inside[...] = values.reshape(inside.shape)
        return picture

    return Buffers(
        item=whole(item, BACKGROUND, np.int32),
        depth=whole(distance - size, np.inf, np.float32),
        normal=whole(normal, 0.0, np.float32),
        cut=whole(cut, empty=False, kind=np.bool_),
        over=whole(over, BACKGROUND, np.int32),
    )


def _occupied(scene: DrawnScene, camera: Camera) -> tuple[slice, slice]:
    """Return the rows and columns outside of which every ray misses everything."""
    corners = [camera.project(item.vertices) for item in scene.items if len(item.mesh.vertices)]
    if not corners:
        return slice(0, 0), slice(0, 0)
    lower = np.clip(np.floor(np.min([each.min(axis=0) for each in corners], axis=0)) - 1, 0, (camera.width, camera.height)).astype(int)
    upper = np.clip(np.ceil(np.max([each.max(axis=0) for each in corners], axis=0)) + 1, lower, (camera.width, camera.height)).astype(int)
    return slice(int(lower[1]), int(upper[1])), slice(int(lower[0]), int(upper[0]))


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
    Ng = _surface_normals(scene, indices, hit, found)
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


def occlusion(scene: DrawnScene, camera: Camera, start: FloatArray, direction: FloatArray, reach: float) -> FloatArray:
    """Return 1 for each ray that meets anything but a highlight within a distance, else 0.

    Args:
        scene: The scene.
        camera: The camera whose centre `start` is relative to.
        start: Where the rays begin [mm], `(n, 3)`.
        direction: Unit vectors, `(n, 3)`.
        reach: Length of the rays [mm].
    """
    indices = tuple(index for index, item in enumerate(scene.items) if item.manner == "solid" and len(item.mesh.triangles))
    if not indices or not len(start):
        return np.zeros(len(start))
    embree = _embree_scene(scene, indices, tuple(camera.centre))
    lengths = np.full(len(start), reach, dtype=np.float32)
    hit = embree.run(start.astype(np.float32), direction.astype(np.float32), dists=lengths, query="OCCLUDED")
    return (np.asarray(hit) >= 0).astype(np.float64)


def _surface_normals(scene: DrawnScene, indices: list[int], hit: dict[str, NDArray[Any]], found: NDArray[np.bool_]) -> FloatArray:
    """Return the normal at each hit, `(hits, 3)`: the triangle's, or for smooth items the mean of the corners' by barycentric weights."""
    Ng = hit["Ng"][found].astype(np.float64)
    smooth = [place for place, index in enumerate(indices) if scene.items[index].smooth]
    if not smooth:
        return Ng
    geometry, triangle = hit["geomID"][found], hit["primID"][found]
    u, v = hit["u"][found].astype(np.float64)[:, None], hit["v"][found].astype(np.float64)[:, None]
    for place in smooth:
        mine = np.nonzero(geometry == place)[0]
        if len(mine):
            item = scene.items[indices[place]]
            a, b, c = np.moveaxis(corner_normals(item.mesh)[triangle[mine]], 1, 0)
            local = (1 - u[mine] - v[mine]) * a + u[mine] * b + v[mine] * c
            Ng[mine] = local @ item.T_ground.rotation.T
    return Ng


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
