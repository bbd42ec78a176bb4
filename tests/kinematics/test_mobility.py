"""Mobility of published linkages, and of those whose rank says something else than their motion."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from articad.kinematics import Mechanism
from tests.kinematics.linkages import mismatch, stewart, watt
from tests.kinematics.overconstrained import (
    SINGLE,
    closed_ring,
    closing_angles,
    delta,
    gear_triangle,
    kaleidocycle,
    parallel_rods,
    rods_round_a_circle,
    similar_hexagons,
    slack_bars,
    tetrahedra,
)


def moves_by(mechanism: Mechanism, step: float) -> None:
    """Check that the first driver really moves by a step: the parts meet in their joints there, in the test's own arithmetic."""
    q = mechanism.rest.copy()
    q[0] += step
    assert max(mismatch(mechanism, q)) < 1e-9
    assert mechanism.poses(q).distance_to(mechanism.poses(mechanism.rest)).max() > 0.1 * abs(step)


@pytest.mark.parametrize("name", SINGLE)
def test_a_linkage_of_the_literature_has_mobility_one(name: str) -> None:
    mechanism = SINGLE[name]()
    assert mechanism.mobility == 1
    assert mechanism.correction is None
    assert mechanism.nq == 1
    moves_by(mechanism, 0.05)
    assert mechanism.branch.analysis.first_order == 1


def rings_close(mechanism: Mechanism, n: int, forced: int) -> float:
    """Return by how much a ring of n tetrahedra stays open when its drivers and further joints are forced by 0.05 rad: the oracle."""
    rest = mechanism.configuration(mechanism.rest)
    angles = np.array([rest[f"j{i}"][0] for i in range(n)])
    driving = [int(c.name[1:]) for c in mechanism.drivers]
    chosen = (driving + [i for i in range(n) if i not in driving])[:forced]
    rng, left = np.random.default_rng(n), []
    for _ in range(6):
        size = 0.05 * rng.choice([-1.0, 1.0], forced) * rng.uniform(0.5, 1.0, forced)
        fixed = {i: float(angles[i] + step) for i, step in zip(chosen, size, strict=True)}
        left.append(closing_angles(tetrahedra(n), angles + rng.normal(0, 0.02, n), fixed)[1])
    return min(left)


@pytest.mark.parametrize("n", [6, 8, 10])
def test_a_ring_of_tetrahedra_has_a_freedom_of_first_order_more_than_it_moves_with(n: int) -> None:
    mechanism = kaleidocycle(n)
    analysis = mechanism.branch.analysis
    assert (analysis.first_order, mechanism.mobility) == (n - 5, max(1, n - 6))  # Fowler and Guest 2005
    assert rings_close(mechanism, n, mechanism.mobility) < 1e-9
    assert rings_close(mechanism, n, mechanism.mobility + 1) > 1e-6


def test_eight_tetrahedra_folded_onto_each_other_have_a_freedom_more() -> None:
    """Where a joint stands at 180° its two links are one, and the ring is another mechanism."""
    folded = closed_ring(tetrahedra(8), first=1.1)
    rest = folded.configuration(folded.rest)
    assert min(abs(math.cos(rest[f"j{i}"][0]) + 1.0) for i in range(8)) < 1e-9
    assert folded.mobility == 3
    assert rings_close(folded, 8, 3) < 1e-9
    assert rings_close(folded, 8, 4) > 1e-6


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
        assert "3 freedoms to first order at rest and 2 in fact" in found.message
        platform = mechanism.poses([0.1, 0.0])[1]  # the driver moves the platform, and does not turn it
        assert platform.angle_to(mechanism.poses(mechanism.rest)[1]) < 1e-8


@pytest.mark.parametrize("n", [5, 6, pytest.param(7, marks=pytest.mark.soak), pytest.param(8, marks=pytest.mark.soak)])
def test_a_platform_on_rods_round_a_circle_translates_or_screws(n: int) -> None:
    """|(R − 1)p + t| is the same for all p of a circle where R = 1, or where R turns about the axis and t lies along it."""
    mechanism = rods_round_a_circle(n, seed=n)
    assert (mechanism.branch.analysis.first_order, mechanism.mobility) == (3, 2)
    points = np.array([joint.T_parent_connector.translation for joint in mechanism.joints if joint.name.startswith("foot")])
    assert rods_close(points, {0: 0.3, 1: 0.2}, n) < 1e-9  # two translations
    assert rods_close(points, {0: 0.0, 1: 0.0, 5: 0.3}, n) < 1e-9  # a screw
    assert rods_close(points, {0: 0.3, 1: 0.2, 5: 0.3}, n) > 1e-4  # not both


CIRCLES = [(n, *size, seed) for n in (5, 6, 8) for size in ((40.0, 80.0), (40.0, 200.0), (80.0, 40.0)) for seed in range(8)]
SOME_CIRCLES = [(5, 40.0, 80.0, 0), (6, 40.0, 80.0, 1), (5, 40.0, 200.0, 2), (5, 40.0, 200.0, 4), (6, 40.0, 200.0, 2)]


@pytest.mark.parametrize("circle", [one if one in SOME_CIRCLES else pytest.param(one, marks=pytest.mark.soak) for one in CIRCLES])
def test_sets_that_cross_at_rest_are_told_apart_wherever_the_rods_stand(circle: tuple[int, float, float, int]) -> None:
    """Near rest the translations and the screw are close to each other; a step about a point of one must not end on the other."""
    analysis = rods_round_a_circle(*circle).branch.analysis
    assert (analysis.first_order, analysis.mobility) == (3, 2)


@pytest.mark.parametrize("n", [4, pytest.param(5, marks=pytest.mark.soak)])
def test_balls_at_both_ends_let_every_rod_spin_besides(n: int) -> None:
    assert parallel_rods(n, "ball").mobility == 2 + n


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
    # pin0 turns as far as the two other bars are in line: a triangle of 30 m, 60 m and the span, on either side
    ground = 90_000.0 - slack
    most = math.acos((30_000.0**2 + ground**2 - 60_000.0**2) / (2 * 30_000.0 * ground))
    rest = math.acos((ground - 30_000.0) / 2 / 30_000.0)
    assert (reach.lower_reason, reach.upper_reason) == ("dead point", "dead point")
    assert abs(reach.lower + most + rest) < 1e-4 * most
    assert abs(reach.upper - most + rest) < 1e-4 * most


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
