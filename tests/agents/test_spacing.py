"""Distances between the joints of a part, as a judge reads them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.agents.spacing import _apart, spacings
from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.geometry.part import Part
from articad.kinematics.joints import JointType
from tests.kinematics.linkages import joint
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


def test_the_throw_of_a_crank_is_told_though_its_pin_is_a_part_of_its_own() -> None:
    none = SE3.identity()
    joints = [
        joint("shaft", "revolute", ("frame", none), ("crank", none)),
        joint("pin", "fixed", ("crank", SE3.trans(30.0, 0.0, 5.0)), ("crank_pin", none)),
        joint("big_end", "revolute", ("crank_pin", none), ("rod", none)),
    ]
    parts = []
    for name in ("frame", "crank", "crank_pin", "rod"):
        sides = [(one.parent_connector, one.T_parent_connector) for one in joints if one.parent == name]
        sides += [(one.child_connector, one.T_child_connector) for one in joints if one.child == name]
        parts.append(Part(name, {key: Connector(key, frame) for key, frame in sides}))
    told = spacings(Assembly.from_parts("throw", parts=parts, joints=joints, ground="frame"))

    assert told == ["- crank and crank_pin: shaft to big_end 30"]
