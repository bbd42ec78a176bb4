"""Planes, cylinders and spheres are recognised from meshes of random bodies in random poses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, sphere, tube
from articad.geometry.faces import Face, faces_of
from tests.interference.mechanisms import at, random_rotation

SEEDS = range(6)


def anywhere(rng: np.random.Generator) -> SE3:
    return at(*rng.uniform(-200, 200, 3)) @ random_rotation(rng)


def of_kind(mesh: TriMesh, kind: str) -> list[Face]:
    return [face for face in faces_of(mesh) if face.kind == kind]


def without_faces(mesh: TriMesh) -> TriMesh:
    return TriMesh(mesh.vertices, mesh.triangles)


@pytest.mark.parametrize("labelled", [True, False])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_tube_has_a_bore_a_shell_and_two_ends(seed: int, labelled: bool) -> None:
    rng = np.random.default_rng(seed)
    inner, wall, height = rng.uniform(1, 30), rng.uniform(0.5, 5), rng.uniform(0.5, 60)
    T = anywhere(rng)
    mesh = tube(inner, inner + wall, height, int(rng.integers(24, 90))).transformed(T)
    found = of_kind(mesh if labelled else without_faces(mesh), "cylinder")

    assert sorted((face.hollow, round(face.radius, 6)) for face in found) == sorted(
        [(True, round(inner, 6)), (False, round(inner + wall, 6))]
    )
    for face in found:
        assert abs(face.axis @ T.rotation[:, 2]) == pytest.approx(1.0, abs=1e-12)
        beside = face.point - T.translation
        assert np.linalg.norm(beside - (beside @ face.axis) * face.axis) < 1e-6
        assert face.off < 1e-6
    ends = of_kind(mesh if labelled else without_faces(mesh), "plane")
    assert sorted(round(float(face.axis @ T.rotation[:, 2])) for face in ends) == [-1, 1]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_piece_of_a_cylinder_with_slanting_edges_is_one(seed: int) -> None:
    """Triangles of a face that another surface cuts have no edge along the axis, so their normals are not perpendicular to it."""
    rng = np.random.default_rng([seed, 1])
    radius, span, T = rng.uniform(2, 40), rng.uniform(0.6, 3.0), anywhere(rng)
    rows, columns = 4, 24
    theta = np.linspace(0, span, columns)[None, :] + np.zeros((rows, 1))
    z = np.linspace(0, 1, rows)[:, None] * rng.uniform(2, 20) + 0.3 * radius * np.sin(theta)
    vertices = np.stack([radius * np.cos(theta), radius * np.sin(theta), z], axis=-1).reshape(-1, 3)
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)
    mesh = TriMesh(vertices, triangles, np.zeros(len(triangles), np.int32)).transformed(T)
    (face,) = faces_of(mesh)

    assert (face.kind, face.hollow) == ("cylinder", False)
    assert face.radius == pytest.approx(radius, abs=1e-4)
    assert faces_of(mesh.flipped())[0].hollow


@pytest.mark.parametrize("seed", SEEDS)
def test_spheres_and_sockets(seed: int) -> None:
    rng = np.random.default_rng([seed, 2])
    radius, T = rng.uniform(2, 40), anywhere(rng)
    mesh = sphere(radius, 32).transformed(T)
    kept = (mesh.vertices[mesh.triangles].mean(axis=1) - T.translation) @ T.rotation[:, 2] < rng.uniform(-0.3, 0.9) * radius
    for body, hollow in ((mesh, False), (mesh.submesh(kept).flipped(), True)):
        (face,) = faces_of(body)
        assert (face.kind, face.hollow) == ("sphere", hollow)
        assert face.radius == pytest.approx(radius, abs=1e-6)
        assert np.allclose(face.point, T.translation, atol=1e-6)


def test_other_surfaces_are_not_taken_for_these() -> None:
    cone = cylinder(5, 10, 48)
    squeezed = TriMesh(np.where(cone.vertices[:, 2:] > 0, cone.vertices * [0.7, 0.7, 1.0], cone.vertices), cone.triangles, cone.face)
    assert {face.kind for face in faces_of(squeezed)} == {"plane", "other"}
    oval = TriMesh(cone.vertices * [1.0, 1.01, 1.0], cone.triangles, cone.face)
    assert {face.kind for face in faces_of(oval)} == {"plane", "other"}
    egg = sphere(5, 24)
    assert {face.kind for face in faces_of(TriMesh(egg.vertices * [1, 1, 1.01], egg.triangles, egg.face))} == {"other"}


def test_a_box_has_six_planes_that_face_outwards() -> None:
    mesh = box(3, 4, 5)
    for face in faces_of(mesh):
        assert face.kind == "plane"
        assert face.axis @ face.point > 1.4
    assert len(faces_of(mesh)) == 6
    moved = faces_of(mesh)[0].moved(at(z=2).matrix)
    assert moved.point[2] == pytest.approx(faces_of(mesh)[0].point[2] + 2)
    assert math.isfinite(moved.off)
