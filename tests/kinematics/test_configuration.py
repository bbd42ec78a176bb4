from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.connectors import SE3, Mate
from articad.errors import KinematicsError, LimitError, UnknownJointError
from articad.kinematics import Configuration, Joint, JointLimits, JointType, Layout
from articad.kinematics.joints import swing, twist
from tests.strategies import random_joint

seeds = st.integers(0, 2**32 - 1)
ALL = tuple(random_joint(np.random.default_rng(i), f"j{i}", t, "a", "b", Mate.ALIGNED) for i, t in enumerate(JointType))
BALL = next(j for j in ALL if j.type is JointType.BALL)


@given(seeds)
def test_random_configurations_keep_the_limits(seed: int) -> None:
    drawn = Configuration.random(ALL, np.random.default_rng(seed), (5,))
    assert drawn.batch_shape == (5,)
    assert drawn.violations() == ()
    assert drawn.require_within_limits() is drawn


def test_endless_joints_are_drawn_within_a_half_turn_of_rest() -> None:
    endless = Joint(**{**ALL[3].__dict__, "limits": JointLimits((-math.inf, -math.inf), (math.inf, math.inf))})
    drawn = Configuration.random([endless], np.random.default_rng(0), (1000,))[endless.name]
    assert np.abs(drawn).max(axis=0) == pytest.approx([100, math.pi], rel=0.02)


@given(seeds)
def test_clamping_meets_the_limits_and_leaves_what_meets_them(seed: int) -> None:
    rng = np.random.default_rng(seed)
    inside = Configuration.random(ALL, rng)
    assert np.allclose(inside.clamp().columns, inside.columns, atol=1e-12) or np.allclose(
        np.abs((inside.clamp()[BALL.name] * inside[BALL.name]).sum()), 1
    )
    anywhere = Layout(ALL).integrate(inside.columns, rng.normal(size=Layout(ALL).n_freedoms) * 100)
    clamped = Configuration(ALL, anywhere).clamp()
    assert clamped.violations(1e-9) == ()


@given(st.floats(-3, 3), st.floats(0, 3), st.floats(-3, 3))
def test_clamping_a_ball_keeps_the_direction_of_its_swing(direction: float, tilt: float, turn: float) -> None:
    ball = Joint(**{**BALL.__dict__, "limits": JointLimits(cone=0.5, twist=(-0.2, 0.2))})
    T = SE3.rot_z(direction) @ SE3.rot_y(tilt) @ SE3.rot_z(turn - direction)
    q = Configuration([ball], T.quaternion).clamp().columns  # type: ignore[arg-type]
    expected = SE3.rot_z(direction) @ SE3.rot_y(min(tilt, 0.5)) @ SE3.rot_z(min(0.2, max(-0.2, turn)) - direction)
    assert SE3.from_quaternion(q).allclose(expected, rad=1e-9)
    assert swing(q) <= 0.5 + 1e-12
    assert abs(twist(q)) <= 0.2 + 1e-12


def test_a_violation_says_joint_value_and_limits() -> None:
    slider = ALL[2]
    with pytest.raises(LimitError) as caught:
        Configuration([slider], np.array([200.0])).require_within_limits()  # type: ignore[arg-type]
    error = caught.value
    assert (error.joint, error.value, error.lower, error.upper, error.unit) == ("j2", 200.0, -80.0, 120.0, "mm")
    ball = Joint(**{**BALL.__dict__, "limits": JointLimits(cone=0.5, twist=(-0.2, 0.2))})
    leaning = (SE3.rot_x(1.0) @ SE3.rot_z(0.5)).quaternion
    assert [e.joint for e in Configuration((ball,), leaning).violations()] == [f"{ball.name}.swing", f"{ball.name}.twist"]


def test_values_are_read_and_set_by_joint() -> None:
    q = Configuration.of(ALL, {"j1": 0.5, "j3": (10.0, 0.2)})
    assert q.values["j1"] == (0.5,)
    assert q.values["j3"] == (10.0, 0.2)
    assert q.values[BALL.name] == (0, 0, 0, 1)
    assert q.motion("j1") == SE3.rot_z(0.5)
    assert "j3=(10.0, 0.2)" in repr(q)
    assert Configuration.neutral(ALL).values == Configuration.rest(ALL).values
    with pytest.raises(UnknownJointError, match="Did you mean"):
        q["j"]
    with pytest.raises(KinematicsError, match="2 coordinate"):
        Configuration.of(ALL, {"j3": 1.0})
    with pytest.raises(KinematicsError, match="the array has shape"):
        Configuration(ALL, np.zeros(3))
    with pytest.raises(KinematicsError, match="E_NONFINITE"):
        Configuration.of(ALL, {"j1": math.nan})
    batch = Configuration.random(ALL, np.random.default_rng(0), (2,))
    assert "batch=(2,)" in repr(batch)
    with pytest.raises(KinematicsError, match="batch"):
        batch.values  # noqa: B018
    assert batch.motion("j3").batch_shape == (2,)


@given(seeds)
def test_interpolation_starts_here_and_ends_there(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = Configuration.random(ALL, rng), Configuration.random(ALL, rng)
    layout = Layout(ALL)
    assert np.abs(layout.difference(a.interpolate(b, 0.0).columns, a.columns)).max() < 1e-12
    assert np.abs(layout.difference(a.interpolate(b, 1.0).columns, b.columns)).max() < 1e-12
    middle = a.interpolate(b, 0.5)
    assert np.allclose(middle["j3"], (a["j3"] + b["j3"]) / 2)
    assert a.interpolate(b, [0.0, 0.5]).batch_shape == (2,)


@given(seeds)
def test_a_difference_is_what_integration_needs(seed: int) -> None:
    rng, layout = np.random.default_rng(seed), Layout(ALL)
    a, b = (Configuration.random(ALL, rng, (4,)).columns for _ in range(2))
    step = layout.difference(a, b)
    again = layout.integrate(a, step)
    assert np.abs(layout.difference(again, b)).max() < 1e-12
    assert layout.integrate(a[0], step).shape == a.shape


def test_freedoms_and_columns_differ_only_for_quaternions() -> None:
    layout = Layout(ALL)
    assert layout.n_columns == layout.n_freedoms + 2
    ball = layout.columns[BALL.name]
    assert layout.freedom_of(ball.start + 3) == layout.freedoms[BALL.name].start
    after = layout.columns["j7"].start
    assert layout.freedom_of(after + 1) == layout.freedoms["j7"].start + 1
    assert layout.joint("j7").type is JointType.UNIVERSAL
    free = layout.columns["j8"].start
    assert [layout.freedom_of(free + at) - layout.freedoms["j8"].start for at in range(7)] == [0, 1, 2, 3, 3, 3, 3]
    with pytest.raises(UnknownJointError):
        layout.joint("none")
