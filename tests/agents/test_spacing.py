"""Distances between the joints of a part, as a judge reads them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.agents.spacing import _apart
from articad.connectors.se3 import SE3
from articad.kinematics.joints import JointType
from tests.strategies import poses


@given(poses(), st.floats(0, 500), st.floats(-3, 3), st.floats(-200, 200))
def test_axes_that_are_parallel_are_as_far_apart_as_lines_wherever_their_origins_lie(T: SE3, far: float, turn: float, along: float) -> None:
    other = T @ SE3.trans(far * np.cos(turn), far * np.sin(turn), along) @ SE3.rot_z(turn)
    for kinds in (
        (JointType.REVOLUTE, JointType.SCREW),
        (JointType.BALL, JointType.REVOLUTE),
        (JointType.CYLINDRICAL, JointType.UNIVERSAL),
    ):
        assert _apart((kinds[0], T), (kinds[1], other)) == pytest.approx(far, abs=1e-6)
    assert _apart((JointType.BALL, T), (JointType.BALL, other)) == pytest.approx(float(np.hypot(far, along)), abs=1e-6)


def test_axes_that_cross_are_as_far_apart_as_their_origins() -> None:
    level = SE3.from_axes(np.array([3.0, 4.0, 0.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    assert _apart((JointType.REVOLUTE, SE3.identity()), (JointType.REVOLUTE, level)) == pytest.approx(5.0)
