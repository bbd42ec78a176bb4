"""The algebra of mass properties against closed formulas."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from articad.connectors import SE3, Plane
from articad.errors import InvalidSolidError
from articad.geometry import MassProperties, box, cylinder, merged, sphere

STEEL = 7850.0
vectors = st.tuples(*[st.floats(-500, 500)] * 3).map(np.array)
poses = st.builds(SE3.exp, st.tuples(*[st.floats(-200, 200)] * 3, *[st.floats(-3, 3)] * 3).map(np.array))


def point_mass(mass: float, at: list[float]) -> MassProperties:
    return MassProperties(mass, np.array(at), np.zeros((3, 3)))


def test_a_steel_box_has_the_mass_and_inertia_of_the_formula() -> None:
    body = MassProperties.from_solid(*box(20, 30, 40, center=False).solid_integrals(), STEEL)
    mass = 20 * 30 * 40 * 1e-9 * STEEL
    assert body.mass == pytest.approx(mass)
    np.testing.assert_allclose(body.com, [10, 15, 20])
    np.testing.assert_allclose(body.inertia, mass / 12 * np.diag([30**2 + 40**2, 20**2 + 40**2, 20**2 + 30**2]), atol=1e-15)
    assert body.is_physical


def test_a_fine_cylinder_has_the_inertia_of_the_formula() -> None:
    body = MassProperties.from_solid(*cylinder(10, 40, 720).solid_integrals(), STEEL)
    mass = np.pi * 100 * 40 * 1e-9 * STEEL
    np.testing.assert_allclose(np.diag(body.inertia), [mass * (300 + 1600) / 12] * 2 + [mass * 100 / 2], rtol=1e-4)


def test_two_points_make_a_dumbbell() -> None:
    both = MassProperties.combined([point_mass(1.0, [0, 0, 0]), point_mass(3.0, [4, 0, 0])])
    assert both.mass == 4
    np.testing.assert_allclose(both.com, [3, 0, 0])
    np.testing.assert_allclose(both.inertia, np.diag([0, 12, 12]))  # reduced mass 3/4 times 4²


def test_the_parallel_axis_theorem() -> None:
    np.testing.assert_allclose(point_mass(2.0, [1, 2, 3]).inertia_about([0, 0, 0]), [[26, -4, -6], [-4, 20, -12], [-6, -12, 10]])


@settings(max_examples=50, deadline=None)
@given(poses, poses)
def test_combining_pieces_equals_measuring_the_whole(T_a: SE3, T_b: SE3) -> None:
    a, b = box(5, 6, 7).transformed(T_a), sphere(4, 12).transformed(T_b)
    whole = MassProperties.from_solid(*merged([a, b]).solid_integrals(), STEEL)
    pieces = MassProperties.combined(MassProperties.from_solid(*mesh.solid_integrals(), STEEL) for mesh in (a, b))
    assert pieces.mass == pytest.approx(whole.mass, rel=1e-10)
    np.testing.assert_allclose(pieces.com, whole.com, atol=1e-8)
    np.testing.assert_allclose(pieces.inertia, whole.inertia, atol=1e-9 * np.abs(whole.inertia).max())


@settings(max_examples=50, deadline=None)
@given(poses)
def test_moving_numbers_equals_measuring_the_moved_mesh(T: SE3) -> None:
    mesh = merged([box(5, 6, 7, center=False), sphere(4, 12)])
    moved = MassProperties.from_solid(*mesh.solid_integrals(), STEEL).moved(T)
    measured = MassProperties.from_solid(*mesh.transformed(T).solid_integrals(), STEEL)
    np.testing.assert_allclose(moved.com, measured.com, atol=1e-9)
    np.testing.assert_allclose(moved.inertia, measured.inertia, atol=1e-9 * np.abs(measured.inertia).max())


@settings(max_examples=50, deadline=None)
@given(vectors, vectors.filter(lambda v: bool(np.linalg.norm(v) > 1)))
def test_mirroring_numbers_equals_measuring_the_mirrored_mesh(point: np.ndarray, normal: np.ndarray) -> None:
    S = Plane(point, normal).matrix
    mesh = merged([box(5, 6, 7, center=False), sphere(4, 12).transformed(SE3.from_translation([9.0, 1, 2]))])
    image = MassProperties.from_solid(*mesh.solid_integrals(), STEEL).mirrored(S)
    measured = MassProperties.from_solid(*mesh.reflected(S).solid_integrals(), STEEL)
    np.testing.assert_allclose(image.com, measured.com, atol=1e-9)
    np.testing.assert_allclose(image.inertia, measured.inertia, atol=1e-9 * np.abs(measured.inertia).max())
    np.testing.assert_allclose(image.mirrored(S).inertia, MassProperties.from_solid(*mesh.solid_integrals(), STEEL).inertia, atol=1e-12)


def test_combining_nothing_is_no_mass_and_massless_parts_add_nothing() -> None:
    assert MassProperties.combined([]).mass == 0
    body = point_mass(2.0, [1, 2, 3])
    both = MassProperties.combined([MassProperties.none(), body])
    assert both.mass == 2
    np.testing.assert_allclose(both.com, [1, 2, 3])


def test_combining_keeps_digits_far_from_the_origin() -> None:
    far = np.array([1e6, 1e6, 1e6])
    both = MassProperties.combined([point_mass(1.0, list(far)), point_mass(1.0, [1e6 + 0.5, 1e6, 1e6])])
    np.testing.assert_allclose(both.inertia, np.diag([0, 0.125, 0.125]), rtol=1e-12)


@pytest.mark.parametrize(
    ("inertia", "physical"),
    [(np.diag([1.0, 1, 2]), True), (np.diag([1.0, 1, 2.01]), False), (np.diag([0.0, 1, 1]), False), (np.diag([-1.0, 2, 2]), False)],
)
def test_the_triangle_inequality_tells_a_possible_inertia(inertia: np.ndarray, physical: bool) -> None:
    assert MassProperties(1.0, np.zeros(3), inertia).is_physical is physical


@pytest.mark.parametrize(
    ("mass", "com", "inertia", "status"),
    [
        (-1.0, np.zeros(3), np.eye(3), "negative"),
        (np.nan, np.zeros(3), np.eye(3), "nonfinite"),
        (1.0, np.zeros(2), np.eye(3), "shape"),
        (1.0, np.zeros(3), np.array([[1.0, 2, 0], [0, 1, 0], [0, 0, 1]]), "asymmetric"),
    ],
)
def test_impossible_numbers_are_refused(mass: float, com: np.ndarray, inertia: np.ndarray, status: str) -> None:
    with pytest.raises(InvalidSolidError) as caught:
        MassProperties(mass, com, inertia)
    assert caught.value.status == status


def test_a_mirror_must_be_a_reflection() -> None:
    with pytest.raises(InvalidSolidError):
        point_mass(1.0, [0, 0, 0]).mirrored(np.eye(4))


def test_scaling_the_mass_keeps_the_shape() -> None:
    body = MassProperties.from_solid(*box(1, 2, 3).solid_integrals(), 1000.0)
    np.testing.assert_allclose(body.scaled(2.5).inertia, MassProperties.from_solid(*box(1, 2, 3).solid_integrals(), 2500.0).inertia)
    assert body.scaled(2.5).mass == pytest.approx(2.5 * body.mass)
