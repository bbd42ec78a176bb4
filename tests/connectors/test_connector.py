from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.connectors import FLIP, SE3, Connector, Drift, Mate, Plane, child_pose, drift_of, flip, parent_pose, rest_mismatch
from articad.errors import ConnectorError
from tests.strategies import connectors, directions, mates, poses, vectors


def test_mate_relation_has_the_known_answer() -> None:
    C_p = SE3.from_axes((10, 20, 30), (0, 0, 1), (1, 0, 0))
    C_c = SE3.from_axes((1, 2, 3), (0, 1, 0), (0, 0, 1))
    T = child_pose(SE3.identity(), C_p, SE3.rot_z(math.radians(30)), Mate.ALIGNED, C_c)

    expected: list[list[float]] = [
        [-0.5, 0, 0.8660254038, 7.9019237886],
        [0.8660254038, 0, 0.5, 17.6339745962],
        [0, 1, 0, 28],
        [0, 0, 0, 1],
    ]
    assert np.abs(T.matrix - expected).max() < 5e-11


@given(poses(), poses(), poses(), poses(), mates)
def test_the_relation_can_be_read_from_either_part(T_parent: SE3, C_p: SE3, motion: SE3, C_c: SE3, mate: Mate) -> None:
    T_child = child_pose(T_parent, C_p, motion, mate, C_c)
    assert parent_pose(T_child, C_p, motion, mate, C_c).allclose(T_parent, mm=1e-10, rad=1e-13)
    D = rest_mismatch(T_parent, C_p, motion, mate, C_c, T_child)
    assert D.allclose(SE3.identity(), mm=1e-10, rad=1e-13)


@given(poses(), poses(), mates)
def test_mated_connectors_coincide_up_to_the_flip(C_p: SE3, C_c: SE3, mate: Mate) -> None:
    T = child_pose(SE3.identity(), C_p, SE3.identity(), mate, C_c)
    met = T @ C_c
    assert np.allclose(met.translation, C_p.translation, rtol=0, atol=1e-11)
    assert np.allclose(met.z_axis, C_p.z_axis * (-1 if mate is Mate.OPPOSED else 1), atol=1e-14)
    assert np.allclose(met.x_axis, C_p.x_axis, atol=1e-14)


def test_flip_is_exact_and_its_own_inverse() -> None:
    assert np.array_equal(FLIP.matrix, np.diag([1, -1, -1, 1]))
    assert flip(Mate.OPPOSED) is FLIP
    assert flip(Mate.ALIGNED) == SE3.identity() == FLIP @ FLIP


@given(poses(), st.floats(0, 50), st.floats(-1, 1), st.floats(0, 3.1), st.floats(-3.1, 3.1), st.floats(-3.1, 3.1))
def test_drift_has_the_components_that_were_put_in(T: SE3, radial: float, along: float, tilt: float, direction: float, turn: float) -> None:
    swing = SE3.rot_z(direction) @ SE3.rot_y(tilt) @ SE3.rot_z(-direction)
    D = SE3.from_translation((radial * math.cos(turn), radial * math.sin(turn), along)) @ swing
    drift = Connector("c", T).drift(T @ D)
    assert drift.radial == pytest.approx(radial, abs=1e-9)
    assert drift.along == pytest.approx(abs(along), abs=1e-9)
    assert drift.axis == pytest.approx(tilt, abs=1e-12)
    assert drift.roll == pytest.approx(0, abs=1e-6 if tilt > 3 else 1e-10)
    assert drift_of(SE3.rot_z(turn)).roll == pytest.approx(turn, abs=1e-15)
    assert drift_of(SE3.trans(3, 4, -5)) == Drift(5.0, 5.0, 0.0, 0.0)


@given(connectors(), poses())
def test_a_moved_connector_goes_with_its_part(connector: Connector, T: SE3) -> None:
    moved = connector.moved(T)
    assert np.allclose(moved.frame.translation, T.apply(connector.frame.translation), rtol=0, atol=1e-11)
    assert (moved.name, moved.kind) == (connector.name, connector.kind)


@given(connectors(), vectors, directions())
def test_a_mirrored_connector_reflects_origin_z_and_x_and_stays_right_handed(c: Connector, point: np.ndarray, normal: np.ndarray) -> None:
    S = Plane(point, 5 * normal).matrix
    mirrored = c.mirrored(S).frame
    assert np.allclose(mirrored.translation, (S @ np.append(c.frame.translation, 1))[:3], rtol=0, atol=1e-10)
    assert np.allclose(mirrored.z_axis, S[:3, :3] @ c.frame.z_axis, atol=1e-14)
    assert np.allclose(mirrored.x_axis, S[:3, :3] @ c.frame.x_axis, atol=1e-14)
    assert np.linalg.det(mirrored.rotation) == pytest.approx(1)
    assert c.mirrored(S).mirrored(S).frame.allclose(c.frame, mm=1e-9, rad=1e-13)


@given(vectors, directions())
def test_a_reflection_keeps_its_plane_and_is_its_own_inverse(point: np.ndarray, normal: np.ndarray) -> None:
    S = Plane(point, normal).matrix
    assert np.allclose(S @ np.append(point, 1), np.append(point, 1), rtol=0, atol=1e-10)
    assert np.allclose(S @ S, np.eye(4), atol=1e-10)
    assert np.linalg.det(S) == pytest.approx(-1)


def test_a_plane_without_normal_or_with_nan_is_refused() -> None:
    for point, normal, code in (
        ((0, 0, 0), (0, 0, 0), "E_AXIS_ZERO"),
        ((math.nan, 0, 0), (1, 0, 0), "E_NONFINITE"),
        ((0, 0), (1, 0, 0), "E_NONFINITE"),
    ):
        with pytest.raises(ConnectorError) as caught:
            Plane(point, normal)  # type: ignore[arg-type]
        assert caught.value.findings.codes == (code,)


def test_connectors_are_values() -> None:
    assert Connector("hinge", SE3.trans(1, 0, 0)) == Connector("hinge", SE3.trans(1, 0, 0))
