"""Which meshes stand for a primitive: trimesh makes them, coarse and fine, and each of them wrong in a way of its own."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
import pytest
import trimesh

from articad.connectors.se3 import SE3
from articad.geometry.faceted import facets
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.part import Primitive
from articad.geometry.shapes import box

FORMS: dict[str, tuple[Primitive, Callable[[], trimesh.Trimesh]]] = {
    "box": (Primitive("box", (30.0, 8.0, 3.0)), lambda: trimesh.creation.box((30, 8, 3)).subdivide()),
    "cylinder": (Primitive("cylinder", (5.0, 40.0)), lambda: trimesh.creation.cylinder(5, 40, sections=9)),
    "fine cylinder": (Primitive("cylinder", (5.0, 0.4)), lambda: trimesh.creation.cylinder(5, 0.4, sections=180)),
    "sphere": (Primitive("sphere", (12.0,)), lambda: trimesh.creation.icosphere(2, 12)),
    "capsule": (Primitive("capsule", (4.0, 20.0)), lambda: hull_of(on_capsule(4, 20))),
    "ellipsoid": (Primitive("ellipsoid", (3.0, 9.0, 20.0)), lambda: trimesh.creation.icosphere(3, 1).apply_scale((3, 9, 20))),
}


def on_capsule(r: float, length: float) -> np.ndarray:
    """Corners on the round ends."""
    ball = trimesh.creation.icosphere(3, r).vertices
    return np.concatenate([ball[ball[:, 2] >= 0] + (0, 0, length / 2), ball[ball[:, 2] <= 0] - (0, 0, length / 2)])


def hull_of(points: np.ndarray) -> trimesh.Trimesh:
    return trimesh.Trimesh(points).convex_hull


def mesh_of(made: trimesh.Trimesh) -> TriMesh:
    return TriMesh(np.array(made.vertices), np.array(made.faces, dtype=np.int32))


def with_void(mesh: TriMesh) -> TriMesh:
    """A void of a twentieth of the volume, whose corners are some of the surface's."""
    return merged([mesh, mesh_of(hull_of(mesh.vertices[:: max(1, len(mesh.vertices) // 5)])).flipped()])


def dented(mesh: TriMesh) -> TriMesh:
    vertices = mesh.vertices.copy()
    vertices[0] *= 0.9
    return TriMesh(vertices, mesh.triangles)


WRONG: dict[str, Callable[[TriMesh], TriMesh]] = {
    "larger": lambda mesh: mesh.scaled(1.0001),
    "longer": lambda mesh: TriMesh(mesh.vertices * (1, 1, 1.001), mesh.triangles),
    "shrunk": lambda mesh: mesh.scaled(0.01),
    "shifted": lambda mesh: mesh.transformed(SE3.from_translation((0.01, 0, 0))),
    "turned": lambda mesh: mesh.transformed(SE3.from_axis_angle((1, 0, 0), 0.1)),
    "another body of its size": lambda mesh: mesh_of(trimesh.creation.icosahedron().apply_scale(np.ptp(mesh.vertices, axis=0) / 1.7)),
    "its halves' hull": lambda mesh: mesh_of(hull_of(mesh.vertices[mesh.vertices[:, 2] >= 0])),
    "open": lambda mesh: TriMesh(mesh.vertices, mesh.triangles[:-1]),
    "inside out": lambda mesh: mesh.flipped(),
    "hollow": with_void,
    "twice": lambda mesh: merged([mesh, mesh]),
    "dented": dented,
    "empty": lambda mesh: TriMesh(mesh.vertices, mesh.triangles[:0]),
}


@pytest.mark.parametrize("name", FORMS)
def test_facets_of_any_fineness_stand_for_a_primitive(name: str) -> None:
    form, made = FORMS[name]
    mesh = mesh_of(made())

    assert facets(mesh, form)
    assert facets(TriMesh(mesh.vertices.astype(np.float32).astype(np.float64), mesh.triangles), form)  # as an STL holds it


@pytest.mark.parametrize(("name", "wrong"), [pair for pair in product(FORMS, WRONG) if pair != ("sphere", "turned")])
def test_what_is_no_facets_of_it_does_not(name: str, wrong: str) -> None:
    form, made = FORMS[name]

    assert not facets(WRONG[wrong](mesh_of(made())), form)


def test_what_cuts_off_much_of_it_does_not() -> None:
    """A prism of four sides has its corners on the cylinder and 64 % of its volume."""
    assert not facets(mesh_of(trimesh.creation.cylinder(5, 40, sections=4)), Primitive("cylinder", (5.0, 40.0)))
    assert not facets(box(10, 10, 10), Primitive("box", (10.0, 10.0, 30.0)))
