from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.connectors import SE3, axis_findings, quaternion, world_x
from articad.errors import ConnectorError
from tests.strategies import angles, directions, poses, rotation_vectors, vectors

MM, RAD = 1e-11, 1e-14  # rounding of products of poses of up to 1000 mm


def as_pin(T: SE3) -> pin.SE3:
    return pin.SE3(pin.Quaternion(*np.roll(T.quaternion, 1)), T.translation.copy())


def differs(T: SE3, oracle: pin.SE3) -> float:
    return float(np.abs(T.matrix - oracle.homogeneous).max())


# --- group axioms, with Pinocchio as the oracle


@given(poses(), poses())
def test_composition_agrees_with_pinocchio(T: SE3, U: SE3) -> None:
    assert differs(T @ U, as_pin(T) * as_pin(U)) < MM


@given(poses(), poses(), poses())
def test_composition_is_associative(T: SE3, U: SE3, V: SE3) -> None:
    assert ((T @ U) @ V).allclose(T @ (U @ V), mm=MM, rad=1e-14)


@given(poses())
def test_inverse_undoes_and_agrees_with_pinocchio(T: SE3) -> None:
    assert (T @ T.inverse()).allclose(SE3.identity(), mm=MM, rad=RAD)
    assert (T.inverse() @ T).allclose(SE3.identity(), mm=MM, rad=RAD)
    assert differs(T.inverse(), as_pin(T).inverse()) < MM


@given(poses())
def test_identity_is_neutral(T: SE3) -> None:
    assert T @ SE3.identity() == T
    assert SE3.identity() @ T == T


@given(poses(), vectors)
def test_apply_agrees_with_pinocchio_and_with_the_matrix(T: SE3, p: np.ndarray) -> None:
    assert np.allclose(T.apply(p), as_pin(T).act(p), rtol=0, atol=MM)
    assert np.allclose(T.apply(p), T.matrix[:3] @ np.append(p, 1), rtol=0, atol=MM)
    assert np.allclose(T.rotate(p), T.rotation @ p, rtol=0, atol=MM)


@given(poses())
def test_adjoint_agrees_with_pinocchio(T: SE3) -> None:
    assert np.allclose(T.adjoint(), as_pin(T).action, rtol=0, atol=MM)


@given(poses())
def test_every_pose_has_a_unit_quaternion_with_nonnegative_w(T: SE3) -> None:
    assert abs(np.linalg.norm(T.quaternion) - 1) < 1e-15 * 4
    assert T.quaternion[3] >= 0
    assert not T.data.flags.writeable


# --- exponential and logarithm


@given(vectors, rotation_vectors())
def test_exp_agrees_with_pinocchio(v: np.ndarray, omega: np.ndarray) -> None:
    # Pinocchio's own coefficients lose digits where the angle is small, hence the wider bound on the translation
    assert differs(SE3.exp(np.concatenate([v, omega])), pin.exp6(np.concatenate([v, omega]))) < 1e-9


@given(vectors, rotation_vectors())
def test_log_undoes_exp_up_to_pi(v: np.ndarray, omega: np.ndarray) -> None:
    xi = np.concatenate([v, omega])
    back = SE3.exp(xi).log()
    if np.linalg.norm(omega) > math.pi - 1e-6 and back[3:] @ omega < 0:  # at π both signs are the same rotation
        assert np.linalg.norm(back[3:] + omega * (2 * math.pi / np.linalg.norm(omega) - 1)) < 1e-13
    else:
        assert np.abs(back[3:] - omega).max() < 1e-14
        assert np.abs(back[:3] - v).max() < 1e-11


@given(poses())
def test_exp_undoes_log(T: SE3) -> None:
    assert SE3.exp(T.log()).allclose(T, mm=1e-11, rad=1e-14)


@pytest.mark.parametrize("gap", [0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-7, 1e-4])
@pytest.mark.parametrize("near", [0.0, math.pi])
def test_exp_and_log_keep_all_digits_near_zero_and_pi(gap: float, near: float) -> None:
    axis = np.array([2.0, -3.0, 6.0]) / 7
    angle = abs(near - gap)
    T = SE3.from_axis_angle(axis, angle, about=(100, 20, -30))
    back = SE3.exp(T.log())
    assert back.allclose(T, mm=1e-12, rad=1e-15)
    assert abs(np.linalg.norm(T.log()[3:]) - angle) < 1e-15


def test_log_and_exp_are_continuous_where_series_and_closed_form_meet() -> None:
    for angle in (0.25, 0.5):
        sides = [SE3.exp([1.0, 2.0, 3.0, angle * (1 + s), 0.0, 0.0]) for s in (-1e-15, 1e-15)]
        assert sides[0].distance_to(sides[1]) < 1e-14
        assert np.abs(sides[0].log() - sides[1].log()).max() < 1e-14


def test_exp_is_the_limit_of_small_steps() -> None:
    xi = np.array([30.0, -20.0, 10.0, 0.7, 1.1, -0.4])
    step = np.eye(4)
    step[:3, :3] += np.array([[0, 0.4, 1.1], [-0.4, 0, -0.7], [-1.1, 0.7, 0]]) / 2**20
    step[:3, 3] = xi[:3] / 2**20
    power = np.linalg.matrix_power(step, 2**20)
    assert np.abs(power - SE3.exp(xi).matrix).max() < 1e-4  # first order in the step


@given(poses(), poses())
def test_interpolation_starts_here_ends_there_and_moves_evenly(T: SE3, U: SE3) -> None:
    assert T.interpolate(U, 0.0).allclose(T, mm=MM, rad=1e-14)
    assert T.interpolate(U, 1.0).allclose(U, mm=1e-10, rad=1e-13)
    middle = T.interpolate(U, 0.5)
    assert abs(float(T.angle_to(middle)) - float(T.angle_to(U)) / 2) < 1e-7


# --- constructors


@given(directions(), angles, vectors)
def test_axis_angle_turns_about_its_point(axis: np.ndarray, angle: float, about: np.ndarray) -> None:
    T = SE3.from_axis_angle(3 * axis, angle, about)
    assert np.allclose(T.apply(about), about, rtol=0, atol=MM)
    assert np.allclose(T.rotation, pin.AngleAxis(angle, axis).matrix(), rtol=0, atol=1e-15)


@given(poses())
def test_matrix_rotation_and_quaternion_rebuild_the_pose(T: SE3) -> None:
    for again in (
        SE3.from_matrix(T.matrix),
        SE3.from_rotation(T.rotation, T.translation),
        SE3.from_quaternion(-T.quaternion, T.translation),
    ):
        assert again.allclose(T, mm=1e-12, rad=1e-15 * 4)


@given(st.floats(-7, 7), st.floats(-7, 7), st.floats(-7, 7))
def test_turns_about_the_axes_are_right_handed(a: float, b: float, c: float) -> None:
    for T, R in (
        (SE3.rot_x(a), pin.utils.rotate("x", a)),
        (SE3.rot_y(b), pin.utils.rotate("y", b)),
        (SE3.rot_z(c), pin.utils.rotate("z", c)),
    ):
        assert np.abs(T.rotation - R).max() < 1e-15 * 4


@given(poses())
def test_axes_rebuild_the_frame(T: SE3) -> None:
    assert SE3.from_axes(T.translation, 3 * T.z_axis, 0.1 * T.x_axis).allclose(T, mm=1e-12, rad=1e-14)
    assert np.allclose(T.y_axis, np.cross(T.z_axis, T.x_axis), atol=1e-15)


@given(directions())
def test_missing_x_is_the_least_parallel_world_axis_projected(z: np.ndarray) -> None:
    T = SE3.from_axes((0, 0, 0), z)
    assert T.x_axis.max() >= math.sqrt(1 - np.abs(z).min() ** 2) - 1e-8
    assert abs(T.x_axis @ z) < 1e-15
    assert np.array_equal(world_x((0, 0, 5)), (1, 0, 0))
    assert np.array_equal(world_x((-1, 0, 0)), (0, 1, 0))


def test_batches_broadcast_index_and_stack() -> None:
    T = SE3.exp(np.random.default_rng(1).normal(size=(4, 3, 6)))
    assert T.batch_shape == (4, 3)
    assert len(T) == 4
    assert [len(row) for row in T] == [3] * 4
    assert SE3.stack(list(T)) == T
    assert T[1, 2] == T[1][2] == T[..., 2][1]
    assert T.reshape(12)[5] == T[1, 2]
    assert (T @ T[0, 0]).batch_shape == (4, 3)
    assert (T[:, :1] @ T[0]).batch_shape == (4, 3)
    assert T.apply(np.zeros(3)).shape == (4, 3, 3)
    assert T[0, 0].apply(np.zeros((8, 3))).shape == (8, 3)
    assert T.matrix.shape == (4, 3, 4, 4)
    assert T.adjoint().shape == (4, 3, 6, 6)
    assert SE3.identity((2,)).batch_shape == (2,)
    assert SE3.trans([1, 2], 0, 0)[1] == SE3.from_translation((2, 0, 0))
    assert T[0, 0].interpolate(T[0, 1], [0, 0.5, 1]).batch_shape == (3,)
    for row in range(4):
        for column in range(3):
            assert (T @ T)[row, column].allclose(T[row, column] @ T[row, column], mm=1e-14, rad=1e-15)
    with pytest.raises(IndexError, match="no batch"):
        T[0, 0][0]
    with pytest.raises(IndexError, match="too long"):
        T[0, 0:1, 0]
    with pytest.raises(TypeError, match="no length"):
        len(T[0, 0])


def test_poses_are_values() -> None:
    T, U = SE3.trans(1, 2, 3), SE3.trans(1, 2, 3)
    assert T == U
    assert hash(T) == hash(U)
    assert SE3.trans(-0.0, 0, 0) == SE3.identity()
    assert hash(SE3.trans(-0.0, 0, 0)) == hash(SE3.identity())
    assert SE3.trans(1, 2, 4) != T
    assert T != "pose"
    assert repr(T) == "SE3(t=(1, 2, 3), xyzw=(0, 0, 0, 1))"
    assert repr(SE3.identity((2, 3))) == "SE3(batch=(2, 3))"
    with pytest.raises(TypeError):
        np.eye(4) @ T  # type: ignore[operator]
    with pytest.raises(TypeError):
        T @ np.eye(4)  # type: ignore[operator]
    with pytest.raises(ValueError, match="read-only"):
        T.data[0] = 5


# --- refusals


@pytest.mark.parametrize(
    ("make", "code"),
    [
        (lambda: SE3(np.array([0, 0, np.nan, 0, 0, 0, 1])), "E_NONFINITE"),
        (lambda: SE3.from_quaternion((0, 0, 0, 1.01)), "E_QUAT_NORM"),
        (lambda: SE3.from_matrix(np.diag([1.0, 1.0, -1.0, 1.0])), "E_LEFT_HANDED"),
        (lambda: SE3.from_rotation(np.diag([1.0, 1.0, 1.001])), "E_NOT_ROTATION"),
        (lambda: SE3.from_matrix(np.ones((4, 4))), "E_NOT_ROTATION"),
        (lambda: SE3.from_axis_angle((0, 0, 1e-10), 1.0), "E_AXIS_ZERO"),
        (lambda: SE3.from_axes((0, 0, 0), (0, 0, 0), (1, 0, 0)), "E_AXIS_ZERO"),
        (lambda: SE3.from_axes((0, 0, 0), (0, 0, 1), (0, 0, 0)), "E_AXIS_ZERO"),
        (lambda: SE3.from_axes((0, 0, 0), (0, 0, 1), (0, 0, -2)), "E_AXIS_PARALLEL"),
        (lambda: SE3.from_axes((0, math.inf, 0), (0, 0, 1), (1, 0, 0)), "E_NONFINITE"),
    ],
)
def test_what_is_no_frame_is_refused_with_its_code(make: object, code: str) -> None:
    with pytest.raises(ConnectorError) as caught:
        make()  # type: ignore[operator]
    assert caught.value.findings.codes == (code,)
    assert code in str(caught.value)


def test_shapes_are_refused_by_name() -> None:
    with pytest.raises(ConnectorError, match=r"pose has shape \(6,\)"):
        SE3(np.zeros(6))
    with pytest.raises(ConnectorError, match=r"frame.z has shape \(2,\)"):
        SE3.from_axes((0, 0, 0), (0, 1), (1, 0, 0))


def test_a_skewed_x_is_projected_with_a_warning_and_refused_beyond_one_degree() -> None:
    x = np.array([math.cos(math.radians(30)), 0, math.sin(math.radians(30))])
    (refused,) = axis_findings((0, 0, 0), (0, 0, 1), x, where="parts.door.connectors.hinge")
    assert (refused.code, refused.where) == ("E_AXIS_NOT_ORTHOGONAL", "parts.door.connectors.hinge.x")
    assert "x makes 60° with z" in refused.message
    assert refused.hint == "Did you mean x=(1, 0, 0)?"
    (warned,) = axis_findings((0, 0, 0), (0, 0, 1), (1, 0, 0.01))
    assert warned.code == "W_AXIS_NOT_ORTHOGONAL"
    assert not axis_findings((0, 0, 0), (0, 0, 1), (1, 0, 1e-7))
    assert SE3.from_axes((0, 0, 0), (0, 0, 1), (1, 0, 0.01)) == SE3.identity()


def test_all_findings_of_a_frame_come_at_once() -> None:
    codes = axis_findings((math.nan, 0, 0), (0, 0, 0), (0, math.inf, 0)).codes
    assert sorted(codes) == ["E_AXIS_ZERO", "E_NONFINITE", "E_NONFINITE"]


def test_inverse_coefficient_is_that_of_the_logarithms_jacobian() -> None:
    for theta in (1e-9, 0.1, 0.2499, 0.2501, 2.0, 3.1):
        exact = (1 - theta / 2 / math.tan(theta / 2)) / theta**2
        assert float(quaternion.inverse_coefficient(np.array([0.0, theta, 0.0]))[0]) == pytest.approx(
            exact if theta > 1e-3 else 1 / 12, rel=1e-12
        )
