"""Laws of triangle meshes."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest
import trimesh

from articad.connectors import SE3, Plane
from articad.errors import InvalidSolidError
from articad.geometry import TriMesh, box, cylinder, merged, sphere, tube

TURN = SE3.from_axis_angle([0.3, -0.7, 0.2], 1.1) @ SE3.from_translation([5.0, -40.0, 7.0])
LOPSIDED = merged([box(10, 20, 30, center=False), sphere(4, 16).transformed(SE3.from_translation([40.0, 3.0, -2.0]))])


def soup(mesh: TriMesh) -> TriMesh:
    return TriMesh(mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(3 * len(mesh.triangles), dtype=np.int32).reshape(-1, 3))


@pytest.mark.parametrize(
    ("mesh", "volume", "area"),
    [
        (box(2, 3, 4), 24.0, 52.0),
        (box(2, 3, 4, center=False), 24.0, 52.0),
        # a regular n-gon of circumradius r: area n/2 r² sin(2π/n), side 2 r sin(π/n)
        (cylinder(5, 3, 6), 3 * 25 * np.sin(np.pi / 3) * 3, 2 * 3 * 25 * np.sin(np.pi / 3) + 6 * 5 * 3),
        (tube(3, 5, 2, 4), 2 * (25 - 9) * 2, 2 * 2 * (25 - 9) + 4 * 2 * np.sqrt(2) * (5 + 3)),
    ],
)
def test_simple_shapes_are_closed_and_have_the_volume_and_area_of_the_formula(mesh: TriMesh, volume: float, area: float) -> None:
    assert mesh.is_closed
    assert mesh.volume == pytest.approx(volume, rel=1e-13)
    assert mesh.area == pytest.approx(area, rel=1e-13)


def test_a_fine_sphere_and_cylinder_come_close_to_the_round_ones() -> None:
    assert sphere(2, 200).volume == pytest.approx(4 / 3 * np.pi * 8, rel=1e-3)
    assert cylinder(2, 3, 500).volume == pytest.approx(np.pi * 4 * 3, rel=1e-4)


@pytest.mark.parametrize("mesh", [box(1, 2, 3), cylinder(2, 3, 7), tube(1, 2, 3, 5), sphere(3, 8)])
def test_every_simple_shape_is_outside_out(mesh: TriMesh) -> None:
    ours = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    assert ours.is_watertight
    assert ours.is_winding_consistent
    assert mesh.volume > 0


def test_integrals_of_a_box_are_those_of_the_formula() -> None:
    volume, com, inertia = box(2, 3, 4, center=False).solid_integrals()
    assert volume == pytest.approx(24)
    np.testing.assert_allclose(com, [1, 1.5, 2], rtol=1e-14)
    np.testing.assert_allclose(inertia, np.diag([24 * 25 / 12, 24 * 20 / 12, 24 * 13 / 12]), atol=1e-12)


def test_integrals_of_an_irregular_tetrahedron_are_those_of_the_formula() -> None:
    # second moments of a simplex: ∫xxᵀ = V/20 (Σ p pᵀ + s sᵀ), s = Σ p
    p = np.array([[1.0, 2, 3], [7, 1, 2], [2, 8, 1], [3, 3, 9]])
    mesh = TriMesh(p, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.int32))
    volume = abs(np.linalg.det(p[1:] - p[0])) / 6
    s = p.sum(axis=0)
    second = volume / 20 * (p.T @ p + np.outer(s, s))
    central = second - volume * np.outer(s / 4, s / 4)
    got_volume, com, inertia = mesh.solid_integrals()
    assert got_volume == pytest.approx(volume, rel=1e-13)
    np.testing.assert_allclose(com, s / 4, rtol=1e-13)
    np.testing.assert_allclose(inertia, np.trace(central) * np.eye(3) - central, rtol=1e-12)


def test_integrals_keep_twelve_digits_a_hundred_metres_from_the_origin() -> None:
    # coordinates are whole multiples of 2^-20 mm, so that moving by a whole number of mm is exact and all error is the sum's own
    near = sphere(10, 96)
    near = TriMesh(np.round(near.vertices * 2**20) / 2**20, near.triangles)
    far = TriMesh(near.vertices + np.array([1e5, -1e5, 1e5]), near.triangles)
    volume, com, inertia = near.solid_integrals()
    far_volume, far_com, far_inertia = far.solid_integrals()
    assert abs(far_volume - volume) <= 1e-12 * volume
    assert np.abs(far_com - com - [1e5, -1e5, 1e5]).max() <= 1e-10  # the last bit at 1e5 is 1.5e-11
    assert np.abs(far_inertia - inertia).max() <= 1e-12 * np.abs(inertia).max()


def test_integrals_agree_with_trimesh_on_a_lopsided_body() -> None:
    mesh = LOPSIDED.transformed(TURN)
    reference = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    volume, com, inertia = mesh.solid_integrals()
    assert volume == pytest.approx(reference.volume, rel=1e-9)
    np.testing.assert_allclose(com, reference.center_mass, rtol=1e-9)
    np.testing.assert_allclose(inertia, reference.moment_inertia, rtol=1e-7, atol=1e-6 * np.abs(inertia).max())


def test_moving_keeps_volume_and_carries_the_centre() -> None:
    moved = LOPSIDED.transformed(TURN)
    assert moved.volume == pytest.approx(LOPSIDED.volume, rel=1e-12)
    np.testing.assert_allclose(moved.centroid, TURN.apply(LOPSIDED.centroid), atol=1e-10)


def test_a_reflection_keeps_the_mesh_outside_out() -> None:
    S = Plane(np.array([1.0, 2, 3]), np.array([1.0, -2, 0.5])).matrix
    image = LOPSIDED.reflected(S)
    assert image.volume == pytest.approx(LOPSIDED.volume, rel=1e-12)
    assert image.is_closed
    np.testing.assert_allclose(image.reflected(S).vertices, LOPSIDED.vertices, atol=1e-12)


def test_a_reflection_refuses_a_rotation() -> None:
    with pytest.raises(InvalidSolidError, match="negative determinant"):
        box(1, 1, 1).reflected(np.eye(4))


def test_reversing_the_winding_makes_the_volume_negative() -> None:
    assert box(1, 2, 3).flipped().volume == pytest.approx(-6)


@pytest.mark.parametrize("dropped", [0, 5, 11])
def test_one_missing_triangle_makes_a_mesh_open(dropped: int) -> None:
    cube = box(1, 1, 1)
    holed = TriMesh(cube.vertices, np.delete(cube.triangles, dropped, axis=0))
    assert not holed.is_closed
    assert holed.open_edges == 3


def test_one_reversed_triangle_makes_a_mesh_not_closed() -> None:
    cube = box(1, 1, 1)
    triangles = cube.triangles.copy()
    triangles[3] = triangles[3][::-1]
    assert not TriMesh(cube.vertices, triangles).is_closed


def test_an_empty_mesh_is_not_closed() -> None:
    empty = TriMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int32))
    assert not empty.is_closed
    assert empty.volume == 0
    assert empty.components() == ()


def test_welding_closes_a_soup_and_keeps_the_order_of_first_appearance() -> None:
    loose = soup(box(1, 2, 3))
    assert not loose.is_closed
    welded = loose.welded()
    assert welded.is_closed
    assert len(welded.vertices) == 8
    np.testing.assert_array_equal(welded.vertices[0], loose.vertices[0])


def test_welding_with_a_tolerance_joins_what_is_closer_and_nothing_further() -> None:
    rng = np.random.default_rng(1)
    loose = soup(box(1, 2, 3))
    shaken = TriMesh(loose.vertices + rng.uniform(-1e-4, 1e-4, loose.vertices.shape), loose.triangles)
    assert not shaken.welded().is_closed
    assert len(shaken.welded(1e-3).vertices) == 8
    assert len(shaken.welded(1e-6).vertices) == len(shaken.vertices)


def test_negative_zero_is_the_same_place_as_zero() -> None:
    loose = soup(box(1, 1, 1, center=False))
    signed = loose.vertices.copy()
    signed[::2] = np.where(signed[::2] == 0, -0.0, signed[::2])
    assert len(TriMesh(signed, loose.triangles).welded().vertices) == 8


def test_welding_drops_triangles_that_collapse_and_keeps_faces_in_step() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]])
    mesh = TriMesh(vertices, np.array([[0, 1, 3], [0, 1, 2]], dtype=np.int32), np.array([7, 8], dtype=np.int32)).welded()
    assert mesh.triangles.tolist() == [[0, 1, 2]]
    assert mesh.face is not None
    assert mesh.face.tolist() == [8]


def test_components_are_the_pieces_in_order() -> None:
    pieces = [box(1, 1, 1), sphere(1, 12).transformed(SE3.from_translation([5.0, 0, 0])), tube(1, 2, 1, 40)]
    found = merged(pieces).components()
    assert [len(piece.triangles) for piece in found] == [len(piece.triangles) for piece in pieces]
    assert [piece.volume for piece in found] == pytest.approx([piece.volume for piece in pieces])


def test_a_long_strip_is_one_component() -> None:
    n = 5000
    vertices = np.stack([np.arange(n), np.arange(n) % 2, np.zeros(n)], axis=1).astype(float)
    order = np.random.default_rng(0).permutation(n)
    triangles = np.argsort(order)[np.stack([np.arange(n - 2), np.arange(1, n - 1), np.arange(2, n)], axis=1)]
    assert len(TriMesh(vertices[order], triangles.astype(np.int32)).components()) == 1


def test_bounds_ignore_vertices_that_no_triangle_uses() -> None:
    cube = box(1, 1, 1)
    mesh = TriMesh(np.concatenate([cube.vertices, [[99.0, 0, 0]]]), cube.triangles)
    np.testing.assert_array_equal(mesh.bounds, [[-0.5] * 3, [0.5] * 3])


def test_arrays_cannot_be_written_and_do_not_follow_the_callers() -> None:
    vertices = box(1, 1, 1).vertices.copy()
    mesh = TriMesh(vertices, box(1, 1, 1).triangles)
    vertices[0] = 99
    assert mesh.vertices[0, 0] == -0.5
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 1


def test_the_digest_is_the_documented_hash_and_sees_one_last_bit() -> None:
    mesh = box(1, 2, 3)
    expected = hashlib.sha256(b"articad.mesh/1" + np.array([8, 12], "<i8").tobytes() + mesh.vertices.tobytes() + mesh.triangles.tobytes())
    assert mesh.digest == expected.hexdigest()
    nudged = mesh.vertices.copy()
    nudged[0, 0] = np.nextafter(nudged[0, 0], 1)
    assert TriMesh(nudged, mesh.triangles).digest != mesh.digest


@pytest.mark.parametrize(
    ("vertices", "triangles", "status"),
    [
        (np.zeros((3, 2)), np.zeros((1, 3)), "shape"),
        (np.zeros((3, 3)), np.zeros((1, 4)), "shape"),
        (np.array([[0, 0, np.nan]] * 3), np.array([[0, 1, 2]]), "nonfinite"),
        (np.zeros((3, 3)), np.array([[0, 1, 3]]), "index"),
        (np.zeros((3, 3)), np.array([[0, 1, -1]]), "index"),
    ],
)
def test_impossible_arrays_are_refused(vertices: np.ndarray, triangles: np.ndarray, status: str) -> None:
    with pytest.raises(InvalidSolidError) as caught:
        TriMesh(vertices, triangles)
    assert caught.value.status == status


@pytest.mark.parametrize(
    "make", [lambda: box(0, 1, 1), lambda: cylinder(-1, 1), lambda: tube(2, 1, 1), lambda: sphere(1, 2), lambda: box(1, 1, 1).scaled(0)]
)
def test_impossible_sizes_are_refused(make: object) -> None:
    assert callable(make)
    with pytest.raises(InvalidSolidError):
        make()


def test_scaling_multiplies_the_volume_by_the_cube() -> None:
    assert box(1, 2, 3).scaled(10).volume == pytest.approx(6000)
