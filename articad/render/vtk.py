"""Smoother pictures: VTK through PyVista, if OpenGL is available (extra `render`).

Without OpenGL, VTK does not raise but ends the process, so it is first tried in a process of its own.
"""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.processes import launcher
from articad.render.camera import Camera
from articad.render.scene import DrawnMesh, DrawnScene
from articad.render.shade import INK, PAPER

_PROBE_SECONDS = 60  # the first start of VTK on a slow disk
_CREASE_DEGREES = 30.0


@cache
def available() -> bool:
    """True if PyVista is installed and can draw here; tested once, in a process of its own."""
    if importlib.util.find_spec("pyvista") is None:
        return False
    limits = launcher.Limits(seconds=_PROBE_SECONDS)
    return launcher.run([], module="articad.render.vtk", limits=limits, environment=launcher.environment(*launcher.SCREEN)).code == 0


def _draws() -> bool:
    """Draw a box and return whether the picture shows it."""
    import pyvista  # noqa: PLC0415 - an extra

    plotter: Any = pyvista.Plotter(off_screen=True, window_size=[16, 16])
    plotter.add_mesh(pyvista.Box())
    return bool(plotter.screenshot(return_img=True).min() < 250)


def draw(scene: DrawnScene, camera: Camera) -> NDArray[np.uint8]:
    """Return the picture of a scene, `(height, width, 3)`, with the same camera as `articad.render.raycast`.

    Call it only if `available()` is true.
    """
    import pyvista  # noqa: PLC0415 - an extra, and half a second to load

    plotter: Any = pyvista.Plotter(off_screen=True, window_size=[camera.width, camera.height], lighting="none")
    plotter.set_background(_hex(PAPER))
    _aim(plotter, camera, float(np.linalg.norm(np.ptp(scene.bounds, axis=0))))
    for offset, strength in ((0.5 * camera.up - 0.35 * camera.right, 0.75), (0.9 * camera.right - 0.2 * camera.up, 0.3)):
        direction = camera.eye + offset
        plotter.add_light(pyvista.Light(position=tuple(camera.centre + direction), focal_point=tuple(camera.centre), intensity=strength))
    for item in scene.items:
        if len(item.mesh.triangles) and item.manner != "highlight":
            _add(plotter, pyvista, item, scene)
    plotter.enable_anti_aliasing("ssaa")
    pixels: NDArray[np.uint8] = np.asarray(plotter.screenshot(return_img=True), dtype=np.uint8)[..., :3]
    plotter.close()
    return pixels


def _add(plotter: Any, pyvista: Any, item: DrawnMesh, scene: DrawnScene) -> None:
    faces = np.hstack([np.full((len(item.mesh.triangles), 1), 3), item.mesh.triangles])
    surface = pyvista.PolyData(item.vertices, faces.ravel())
    if scene.section is not None and item.mesh.is_closed:
        surface = surface.clip_closed_surface(normal=[-component for component in scene.section.normal], origin=scene.section.point)
        if surface.n_cells == 0:
            return
    plotter.add_mesh(surface, color=item.color, opacity=0.18 if item.manner == "faded" else 1.0, ambient=0.35, smooth_shading=False)
    edges = surface.extract_feature_edges(_CREASE_DEGREES, boundary_edges=True, non_manifold_edges=False, manifold_edges=False)
    if edges.n_cells and item.manner == "solid":
        plotter.add_mesh(edges, color=_hex(INK), line_width=1.5)


def _aim(plotter: Any, camera: Camera, size: float) -> None:
    plotter.camera.parallel_projection = True
    plotter.camera.focal_point = tuple(camera.centre)
    plotter.camera.position = tuple(camera.centre + camera.eye * 2 * max(size, 1e-6))
    plotter.camera.up = tuple(camera.up)
    plotter.camera.parallel_scale = camera.mm_per_pixel * camera.height / 2
    plotter.camera.clipping_range = (size * 0.01, size * 6)


def _hex(color: NDArray[np.float64]) -> str:
    return "#" + "".join(f"{round(channel):02x}" for channel in color)


if __name__ == "__main__":
    sys.exit(0 if _draws() else 1)
