"""Needles of a closed mesh are flipped away; the surface stays closed and where it is."""

from __future__ import annotations

import manifold3d
import numpy as np
import pytest
import trimesh

from articad.arrays import FloatArray
from articad.geometry.mesh import TriMesh
from articad.geometry.needles import without_needles
from articad.geometry.shapes import box, cylinder


def with_needles(mesh: TriMesh, count: int, off: float, seed: int) -> TriMesh:
    """Split edges of a mesh beside their middles: a triangle beside an edge becomes two, and the one beyond it a needle and itself."""
    rng = np.random.default_rng(seed)
    vertices, triangles = mesh.vertices, mesh.triangles.copy()
    for _ in range(count):
        at = int(rng.integers(len(triangles)))
        a, b, c = triangles[at].tolist()
        share = rng.uniform(0.2, 0.8)
        inwards = vertices[c] - (vertices[a] + vertices[b]) / 2
        middle = vertices[a] + share * (vertices[b] - vertices[a]) + off * inwards / np.linalg.norm(inwards)
        n = len(vertices)
        vertices = np.vstack([vertices, middle])
        triangles = np.vstack([np.delete(triangles, at, axis=0), [[a, b, n], [b, c, n], [c, a, n]]]).astype(np.int32)
    return TriMesh(vertices, triangles)


def heights(mesh: TriMesh) -> FloatArray:
    """Return the height of each triangle over its longest edge, as trimesh has its area."""
    found = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    return np.asarray(2 * found.area_faces / np.linalg.norm(np.diff(found.triangles[:, [0, 1, 2, 0]], axis=1), axis=2).max(axis=1))


@pytest.mark.parametrize("off", [0.0, 1e-13, 1e-7])
@pytest.mark.parametrize("count", [1, 5])
@pytest.mark.parametrize("seed", range(4))
def test_needles_go_and_the_surface_stays(seed: int, count: int, off: float) -> None:
    solid = box(30, 20, 10) if seed % 2 else cylinder(8, 30, 48)
    mesh = with_needles(solid, count, off, seed)
    assert heights(mesh).min() < 1e-6
    found = without_needles(mesh, 1e-5)

    assert heights(found).min() >= 1e-5
    assert len(found.triangles) == len(mesh.triangles)
    assert found.is_closed
    assert found.volume == pytest.approx(solid.volume, rel=1e-7)
    body = manifold3d.Manifold(manifold3d.Mesh64(found.vertices.copy(), found.triangles.astype(np.uint64)))
    assert body.status() == manifold3d.Error.NoError


@pytest.mark.parametrize("seed", range(4))
def test_of_needles_within_needles_most_go(seed: int) -> None:
    mesh = with_needles(box(30, 20, 10), 40, 0.0, seed)
    found = without_needles(mesh, 1e-5)

    assert (heights(found) < 1e-5).sum() < (heights(mesh) < 1e-5).sum() / 2
    assert found.is_closed
    assert found.volume == pytest.approx(6000.0, rel=1e-9)


def test_a_mesh_without_needles_stays_the_same_object() -> None:
    solid = cylinder(8, 30, 48)
    assert without_needles(solid, 1e-5) is solid
