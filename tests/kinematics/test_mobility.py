"""Mobility of published linkages, and of those whose rank says something else than their motion."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from articad.kinematics import Mechanism
from tests.kinematics.linkages import mismatch, stewart, watt
from tests.kinematics.overconstrained import SINGLE, delta, gear_triangle, parallel_rods, similar_hexagons, slack_bars


def moves_by(mechanism: Mechanism, step: float) -> None:
    """Check that the first driver really moves by a step: the parts meet in their joints there, in the test's own arithmetic."""
    q = mechanism.rest.copy()
    q[0] += step
    assert max(mismatch(mechanism, q)) < 1e-7
    assert mechanism.poses(q).distance_to(mechanism.poses(mechanism.rest)).max() > 0.1 * abs(step)


@pytest.mark.parametrize("name", SINGLE)
def test_a_linkage_of_the_literature_has_mobility_one(name: str) -> None:
    mechanism = SINGLE[name]()
    assert mechanism.mobility == 1
    assert mechanism.correction is None
    assert mechanism.nq == 1
    moves_by(mechanism, 0.05)
    assert mechanism.branch.analysis.first_order == 1


def test_platforms_robots_and_six_bars_have_their_mobility() -> None:
    assert stewart().mobility == 6
    assert watt().mobility == 1
    robot = delta()
    assert robot.mobility == 3 + 6  # three translations, and six rods that spin
    assert [c.name for c in robot.drivers][:3] == ["motor0", "motor1", "motor2"]


def rods_close(points: np.ndarray, forced: dict[int, float], seed: int) -> float:
    """Return by how much six numbers of the platform's pose, some of them forced, miss equal lengths of all rods: the oracle."""
    top, start = points + np.array([0, 0, 120.0]), np.zeros(6)
    for k, value in forced.items():
        start[k] = value

    def residual(x: np.ndarray) -> np.ndarray:
        moved = Rotation.from_rotvec(x[3:]).apply(points) + x[:3] * 100
        lengths = (np.linalg.norm(moved - top, axis=1) - 120.0) / 100.0
        return np.concatenate([lengths, [x[k] - value for k, value in forced.items()]])

    rng = np.random.default_rng(seed)
    costs = [least_squares(residual, start + rng.normal(0, 0.02, 6), xtol=1e-15, ftol=1e-15, gtol=1e-15).cost for _ in range(4)]
    return math.sqrt(2 * min(costs))


@pytest.mark.parametrize(
    ("n", "mobility"), [(3, 3), (4, 2), (5, 2), pytest.param(6, 2, marks=pytest.mark.soak), pytest.param(8, 2, marks=pytest.mark.soak)]
)
def test_a_platform_on_parallel_rods_translates_and_turns_only_on_three(n: int, mobility: int) -> None:
    mechanism = parallel_rods(n)
    analysis = mechanism.branch.analysis
    assert analysis.first_order == 3
    assert mechanism.mobility == mobility
    assert analysis.multiple == 3 - mobility
    points = np.column_stack([np.random.default_rng(n).uniform(-100, 100, (n, 2)), np.zeros(n)])
    assert rods_close(points, {0: 0.3, 1: 0.2}, n) < 1e-9  # two translations
    turned = rods_close(points, {0: 0.1, 1: 0.1, 5: 0.05}, n)  # and a turn besides
    assert (turned < 1e-9) == (mobility == 3)
    if mobility == 2:
        (found,) = mechanism.findings().of("W_NEAR_SINGULAR")
        assert "3 freedoms to first order at rest and 2 in truth" in found.message
        platform = mechanism.poses([0.1, 0.0])[1]  # the driver moves the platform, and does not turn it
        assert platform.angle_to(mechanism.poses(mechanism.rest)[1]) < 1e-4


def test_balls_at_both_ends_let_every_rod_spin_besides() -> None:
    assert parallel_rods(4, "ball").mobility == 2 + 4


def test_rods_between_similar_hexagons_screw_the_platform() -> None:
    analysis = similar_hexagons().branch.analysis
    assert (analysis.first_order, analysis.mobility, analysis.multiple) == (3, 1, 2)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e3])
@pytest.mark.parametrize("slack", [0.01, 0.1, 10.0])
def test_long_bars_with_little_slack_move(slack: float, scale: float) -> None:
    mechanism = slack_bars(slack, scale)
    assert mechanism.mobility == 1
    assert "W_SHAKY" not in mechanism.findings().codes
    reach = mechanism.feasible_range("pin0")
    # pin0 turns from the bow upwards to the bow downwards, past both: bars a, b at angles with cos a + cos(b) + cos(c) = 3 − slack/bar
    swing = math.sqrt(slack / 30_000.0)
    assert swing < reach.upper - reach.lower < 4 * swing


def test_bars_exactly_in_line_are_shaky() -> None:
    straight = slack_bars(0.0)
    assert straight.mobility == 0
    assert "W_SHAKY" in straight.findings().codes


def test_three_gears_in_a_triangle_are_locked_and_named() -> None:
    locked = gear_triangle()
    assert locked.mobility == 0
    (found,) = locked.findings().of("E_COUPLING_LOCKED")
    assert "'mesh01', 'mesh12', 'mesh20'" in found.message
    assert set(found.parts) == {"frame", "w0", "w1", "w2"}
    free = gear_triangle(belt=True)
    assert free.mobility == 1
    assert "E_COUPLING_LOCKED" not in free.findings().codes


def test_a_mobility_is_the_same_every_time() -> None:
    first, second = (parallel_rods(4).branch.analysis for _ in range(2))
    assert np.array_equal(first.freedoms, second.freedoms)
    assert np.array_equal(first.Q, second.Q)
