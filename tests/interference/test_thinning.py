"""Flat faces that a mesh cuts up needlessly: asked in fewer triangles, with the same answers."""

from __future__ import annotations

import manifold3d as m3
import numpy as np
import pytest

from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, sphere
from articad.interference import body as body_module
from articad.interference import overlap as overlap_module
from articad.interference.body import Body
from articad.interference.overlap import Overlap, distance, overlap
from articad.interference.scene import Scene
from tests.interference.mechanisms import at, manifold_mesh, random_rotation


def refined(mesh: TriMesh, pieces: int) -> TriMesh:
    solid = m3.Manifold(m3.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
    return manifold_mesh(solid.refine(pieces))


PLATE, PIN = refined(box(40, 30, 6), 8), refined(cylinder(4.0, 20.0, 24), 4)


def overlaps(a: TriMesh, b: TriMesh, poses: list[SE3]) -> list[Overlap]:
    bodies = Body(a), Body(b)
    return [overlap(*bodies, T) for T in poses]


def some_poses(count: int, reach: float) -> list[SE3]:
    rng = np.random.default_rng(3)
    return [at(*rng.uniform(-reach, reach, 3)) @ random_rotation(rng) for _ in range(count)]


def test_a_refined_solid_is_asked_in_the_triangles_that_its_outlines_need() -> None:
    for mesh, most in ((PLATE, 12), (PIN, 4 * 24)):
        body = Body(mesh)
        assert body.is_thinned
        assert body.manifold_triangles <= most < len(mesh.triangles)
        assert body.manifold.volume() == pytest.approx(mesh.volume, rel=1e-12)


def test_a_round_or_a_plain_solid_is_asked_as_it_is() -> None:
    for mesh in (sphere(5.0, 24), box(1, 2, 3), cylinder(4.0, 10.0, 64)):
        body = Body(mesh)
        assert not body.is_thinned
        assert body.manifold_triangles == len(mesh.triangles)


def test_a_thinned_solid_overlaps_by_the_volume_of_the_whole_one(monkeypatch: pytest.MonkeyPatch) -> None:
    poses = some_poses(24, 12.0)
    thinned = overlaps(PLATE, PIN, poses)
    monkeypatch.setattr(body_module, "_WORTH_THINNING", 0.0)
    whole = overlaps(PLATE, PIN, poses)
    assert sum(found.volume > 1 for found in whole) > 8
    for ours, theirs in zip(thinned, whole, strict=True):
        assert ours.volume == pytest.approx(theirs.volume, rel=1e-9, abs=1e-9)
        assert ours.pieces == theirs.pieces
        assert ours.depth >= 0.9 * theirs.depth  # both are of samples


def test_a_solid_that_thinning_would_change_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    class Eager:
        """Collapses far more than it was asked to."""

        def __init__(self, solid: m3.Manifold) -> None:
            self.solid = solid

        def simplify(self, _: float) -> m3.Manifold:
            return self.solid.simplify(2.0)

        def __getattr__(self, name: str) -> object:
            return getattr(self.solid, name)

    ball = Body(sphere(5.0, 24))
    made = Eager(ball.manifold)
    assert made.simplify(0.0).num_tri() < 0.75 * len(ball.mesh.triangles)
    monkeypatch.setattr(Body, "_new_manifold", lambda _: made)
    assert Body(ball.mesh).manifold_triangles == len(ball.mesh.triangles)


def test_a_depth_is_that_of_the_deepest_sample_though_few_are_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    poses = some_poses(12, 8.0)
    asked = [0, 0]

    def counted(of: int) -> object:
        exact = overlap_module.point_distance

        def count(*arguments: object) -> float:
            asked[of] += 1
            return exact(*arguments)  # type: ignore[arg-type]

        return count

    def all_of_them(body: Body, points: np.ndarray, _: np.ndarray, known: float) -> float:
        return max([known, *(overlap_module.point_distance(body, point) for point in points)])

    with monkeypatch.context() as patched:
        patched.setattr(overlap_module, "point_distance", counted(0))
        few = [found.depth for mesh in (PIN, sphere(6.0, 20)) for found in overlaps(PLATE, mesh, poses)]
    monkeypatch.setattr(overlap_module, "point_distance", counted(1))
    monkeypatch.setattr(overlap_module, "_deepest", all_of_them)
    every = [found.depth for mesh in (PIN, sphere(6.0, 20)) for found in overlaps(PLATE, mesh, poses)]
    assert few == every
    assert asked[0] < 0.5 * asked[1]


def test_distances_of_thinned_solids_are_those_of_the_meshes() -> None:
    a, b = Body(PLATE), Body(PIN)
    plain = Body(box(40, 30, 6)), Body(cylinder(4.0, 20.0, 24))
    for T in some_poses(8, 60.0):
        assert distance(a, b, T) == pytest.approx(distance(*plain, T), abs=1e-6)


def test_boxes_that_meet_are_found_as_by_comparing_all_with_all(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(8)
    names = [f"p{i}" for i in range(40)]
    scene = Scene.of({name: box(*rng.uniform(1, 12, 3)) for name in names}, ())
    placed = scene.at({name: at(*rng.uniform(-12, 12, 3)) @ random_rotation(rng) for name in names})
    low, high = scene.boxes(placed.matrices)
    for margin in (1e-6, 3.0):
        expected = [
            (names[i], names[j])
            for i in range(40)
            for j in range(i + 1, 40)
            if (low[i] <= high[j] + margin).all() and (low[j] <= high[i] + margin).all()
        ]
        assert len(expected) > 40
        assert placed.candidates(margin) == expected
        with monkeypatch.context() as patched:
            patched.setattr("articad.interference.scene._PAIRS_AT_ONCE", 7)
            assert placed.candidates(margin) == expected
    assert Scene.of({}, ()).at({}).candidates() == []
