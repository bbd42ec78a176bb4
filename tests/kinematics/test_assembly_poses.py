"""Poses of an assembly: limits of followers, batches with rows that are not reached, other processes."""

from __future__ import annotations

import math
import multiprocessing
import pickle
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.errors import ArticadError, DeadPointError, LimitError, LoopError
from articad.kinematics.joints import Coupling
from tests import moving_bases
from tests.assemblies import all_joint_kinds, block, frame
from tests.moving_bases import Sketch


def four_bar(rocker: tuple[float, float]) -> Assembly:
    a, c = (0.0, 30.0), (75.22, 65.6)
    s = Sketch()
    s.add("revolute", "swivel", "base", "table", (0, 0, 0), limits=(-2.0, 2.0))
    s.add("revolute", "crank", "table", "crank", (0, 0, 20), limits="endless", driver=True)
    s.add("revolute", "pin_b", "crank", "coupler", (*a, 20), limits="endless")
    s.add("revolute", "pin_c", "coupler", "rocker", (*c, 20), limits="endless")
    s.add("revolute", "rocker", "table", "rocker", (100, 0, 20), limits=rocker)
    return s.assembly("four_bar", "base")


def test_a_pose_in_which_a_follower_leaves_its_limits_is_refused_with_the_range_of_its_driver() -> None:
    assembly = four_bar(rocker=(-0.2, 0.2))
    feasible = assembly.feasible_range("crank")
    assert feasible.upper_reason == "limit of rocker"
    assembly.at(crank=feasible.upper - 1e-6)
    with pytest.raises(LimitError) as caught:
        assembly.at(crank=feasible.upper + 0.1, swivel=1.0)
    error = caught.value
    rocker = assembly.mechanism.configuration([1.0, feasible.upper + 0.1])["rocker"]
    assert (error.joint, error.lower, error.upper) == ("rocker", -0.2, 0.2)
    assert error.value == pytest.approx(float(rocker[0]), abs=1e-9)
    assert f"'crank', which may go from {feasible.lower:.6g} to {feasible.upper:.6g} rad" in str(error)
    assert assembly.poses([1.0, feasible.upper + 0.1]).batch_shape == (5,)  # unlimited, as it says


def test_a_follower_beyond_its_limits_is_refused_also_where_its_driver_has_no_range_of_its_own() -> None:
    """Two cranks of a five-bar that reach a pose together only: the second alone would pull the linkage apart."""
    s = Sketch()
    s.add("revolute", "left", "base", "l1", (0, 0, 0), limits="endless", driver=True)
    s.add("revolute", "right", "base", "r1", (100, 0, 0), limits="endless", driver=True)
    s.add("revolute", "elbow", "l1", "l2", (0, 60, 0), limits=(-1.0, 1.0))
    s.add("revolute", "hand", "r1", "r2", (100, 60, 0), limits="endless")
    s.add("revolute", "tip", "l2", "r2", (50, 60 + math.sqrt(60**2 - 50**2), 0), limits="endless")
    assembly = s.assembly("five_bar", "base")
    with pytest.raises(LimitError, match=r"'elbow' is at .* It follows 'left'"):
        assembly.at(left=-math.pi / 2, right=-math.pi / 2)


def test_a_coupled_joint_beyond_its_limits_is_refused() -> None:
    base = block("base", a=frame(), b=frame(at=(60, 0, 0)))
    wheels = [block(name, (20, 20, 5), axis=frame()) for name in ("p", "q")]
    from articad.kinematics import declare

    joints = [
        declare.revolute("a", base["a"], wheels[0]["axis"], limits="endless"),
        declare.revolute("b", base["b"], wheels[1]["axis"], limits=(-0.5, 0.5)),
    ]
    assembly = Assembly.from_parts(
        "pair", parts=[base, *wheels], joints=joints, ground="base", couplings=[Coupling("m", "gear", "a", "b", 2.0)]
    )
    with pytest.raises(LimitError, match=r"'b' is at 3 rad.*'a', which may go from -0.25 to 0.25 rad"):
        assembly.at(a=1.5)


def test_solve_returns_what_is_reached_and_names_what_is_not() -> None:
    s = Sketch()
    s.add("revolute", "swivel", "base", "table", (0, 0, 0), limits=(-2.0, 2.0))
    s.add("revolute", "crank", "table", "crank", (0, 0, 0), limits="endless", driver=True)  # 60, 50, 50, 100: stops at 72.5°
    crank = 0.3
    pin = np.array([60 * math.cos(crank), 60 * math.sin(crank)])
    to = np.array([100.0, 0.0]) - pin
    half = float(np.hypot(*to)) / 2
    top = pin + to / 2 + math.sqrt(2500 - half * half) * np.array([-to[1], to[0]]) / (2 * half)
    s.add("revolute", "b", "crank", "coupler", (*pin, 0.0), limits="endless")
    s.add("revolute", "c", "coupler", "rocker", (*top, 0.0), limits="endless")
    s.add("revolute", "d", "table", "rocker", (100, 0, 0), limits="endless")
    assembly = s.assembly("dead", "base")
    stop = math.radians(72.5423968763) - crank
    q = np.array([[[0.1, 0.2], [0.1, stop + 0.1]], [[-0.4, -0.1], [0.0, stop - 0.01]]])
    found = assembly.solve(q)
    assert found.reached.tolist() == [[True, False], [True, True]]
    assert not found.ok
    assert np.isnan(found.poses.data[0, 1]).all()
    assert np.isnan(found.columns[0, 1]).all()
    assert np.abs(found.poses.data[1] - assembly.poses(q[1]).data).max() < 1e-12
    assert [f.code for f in found.findings] == ["E_DEAD_POINT"]
    assert "row 1" in str(found.findings[0])
    assert assembly.solve(q[1]).ok
    with pytest.raises(DeadPointError, match=r"1 of 4 rows cannot be reached: row 1"):
        assembly.poses(q)


MADE: dict[str, Any] = {**moving_bases.ALL, "all kinds": all_joint_kinds}


@pytest.mark.parametrize("make", MADE.values(), ids=MADE)
def test_an_assembly_and_all_it_is_made_of_can_be_pickled(make: Any) -> None:
    assembly = make()
    q = assembly.mechanism.rest + (0.0 if make is all_joint_kinds else 0.1)
    for one in (assembly, assembly.mechanism):
        copy = pickle.loads(pickle.dumps(one))
        assert np.array_equal(copy.poses(q).data, one.poses(q).data)
    for one in (assembly.poses(q), assembly.joints[0], assembly.mechanism.configuration(q)):
        assert repr(pickle.loads(pickle.dumps(one))) == repr(one)


@pytest.mark.parametrize(
    "error",
    [
        LimitError("a", 1.0, 0.0, 0.5, advice="Turn back."),
        LoopError("open", loop=("a", "b"), gap=2.0),
        DeadPointError("d", driver="a", q=1.0),
    ],
)
def test_errors_cross_processes(error: ArticadError) -> None:
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is type(error)
    assert str(copy) == str(error)
    assert copy.__dict__ == error.__dict__


def placed(given: tuple[Assembly, float]) -> Any:
    assembly, swing = given
    return assembly.poses([swing, 0.1, 0.2]).data


def test_an_assembly_is_used_by_a_process_that_starts_from_nothing() -> None:
    assembly = moving_bases.four_bar_on_turntable()
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        found = pool.map(placed, [(assembly, 0.3)])
    assert np.array_equal(found[0], placed((assembly, 0.3)))
