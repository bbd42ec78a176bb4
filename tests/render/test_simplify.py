"""Light meshes stay within their tolerance, look the same, and have smooth normals."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box, cylinder, sphere
from articad.render import Camera, DrawnMesh, DrawnScene, cast, render_part
from articad.render.raycast import BACKGROUND
from articad.render.simplify import corner_normals, simplified


def farthest(points: np.ndarray, mesh: TriMesh) -> float:
    """Return the largest distance of points from a surface, by trimesh."""
    return float(trimesh.proximity.closest_point(trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False), points)[1].max())


def fine_sphere(radius: float) -> TriMesh:
    made = trimesh.creation.icosphere(subdivisions=4, radius=radius)
    return TriMesh(np.array(made.vertices), np.array(made.faces, dtype=np.int32))


@pytest.mark.parametrize("tolerance", [0.1, 0.3, 1.0])
def test_a_light_mesh_lies_within_its_tolerance_and_is_lighter(tolerance: float) -> None:
    mesh = fine_sphere(20)

    light = simplified(mesh, tolerance)

    assert len(light.triangles) < len(mesh.triangles)
    middles = light.vertices[light.triangles].mean(axis=1)
    assert farthest(np.concatenate([light.vertices, middles]), mesh) <= tolerance
    assert farthest(mesh.vertices, light) <= tolerance
    assert simplified(mesh, tolerance) is light


def test_a_mesh_that_is_open_or_small_is_drawn_as_it_is() -> None:
    whole = fine_sphere(20)
    open_mesh = TriMesh(whole.vertices, whole.triangles[:-5])

    assert simplified(open_mesh, 1.0) is open_mesh
    assert simplified(small := box(10, 10, 10), 1.0) is small


def test_normals_are_smooth_over_a_ball_and_sharp_at_the_edges_of_a_box() -> None:
    ball, cube = fine_sphere(20), box(10, 20, 30)

    radial = ball.vertices[ball.triangles] / 20
    assert (corner_normals(ball) * radial).sum(axis=2).min() > 0.999
    flat = cube.normals_of_twice_area / np.linalg.norm(cube.normals_of_twice_area, axis=1, keepdims=True)
    assert corner_normals(cube) == pytest.approx(np.repeat(flat[:, None], 3, axis=1))


def test_normals_of_a_turned_item_turn_with_it() -> None:
    rod = cylinder(10, 40)
    turned = SE3.rot_x(0.7) @ SE3.rot_y(0.4)
    scene = DrawnScene((DrawnMesh("rod", rod, turned, "#808080", smooth=True),))
    shot = Camera.fit("iso", scene.bounds, width=60, height=60)

    buffers = cast(scene, shot)

    seen = buffers.item != BACKGROUND
    points = shot.plane_points().reshape(60, 60, 3)[seen] + shot.centre - buffers.depth[seen][:, None] * shot.eye
    local = turned.inverse().apply(points)
    side = np.hypot(local[:, 0], local[:, 1]) > 9.8
    side &= np.abs(local[:, 2]) < 19.9
    expected = turned.rotate(local[side] * [1, 1, 0] / np.hypot(local[side, 0], local[side, 1])[:, None])
    assert side.sum() > 100
    assert (buffers.normal[seen][side] * expected).sum(axis=1).min() > 0.995


def test_a_picture_of_the_light_mesh_is_the_picture_of_the_mesh() -> None:
    part = Part.from_mesh("ball", fine_sphere(20), color="#c8a46e")

    plain, light = (np.asarray(render_part(part, ["iso"], size=256, coarse=coarse)["iso"]).astype(int) for coarse in (0.0, 0.15))

    different = np.abs(plain - light).max(axis=2) > 40
    assert different.mean() < 0.002
    assert np.abs(plain - light).mean() < 1.0


def test_what_reaches_the_border_of_a_picture_is_drawn_to_it() -> None:
    scene = DrawnScene((DrawnMesh("ball", sphere(20), SE3.identity(), "#808080"),))
    near = Camera.fit("front", [[-5, -5, -5], [5, 5, 5]], width=40, height=30)
    beside = Camera.fit("front", [[100, 100, 100], [105, 105, 105]], width=40, height=30)

    assert (cast(scene, near).item == 0).all()
    assert (cast(scene, beside).item == BACKGROUND).all()
