"""Random mechanisms against equations of the test's own: every driver alone and all at once, single and in batches.

50 mechanisms run with the other tests, `-m soak` takes the rest.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.connectors import SE3
from tests.pose_equations import Solution
from tests.random_ways import Case, case_of, seeds

FloatArray = NDArray[np.float64]

CLOSED = 1e-9  # rad, and lengths per size of the motif: by which a joint may be open
ROUNDING = 1e-10  # likewise: two solutions that are this close, times the condition of the equations, are one


@pytest.mark.parametrize("seed", seeds())
def test_mobility_and_drivers_are_what_was_planted(seed: int) -> None:
    case = case_of(seed)
    assert case.mechanism.mobility == case.specimen.freedoms, case.specimen.story
    assert len(case.freedoms) == case.specimen.freedoms, case.specimen.story


@pytest.mark.parametrize("seed", seeds())
def test_poses_are_those_of_the_joints_own_equations(seed: int) -> None:
    case = case_of(seed)
    mechanism, equations = case.mechanism, case.equations
    everything = [at for way in case.ways for at in way.solutions]
    if not everything:
        return  # nothing moves
    assert_true(case, mechanism.rest[None], [equations.rest], ("rest",))
    for way in case.ways:
        if way.solutions:
            q = np.array([case.q(at) for at in way.solutions])
            assert_true(case, q, way.solutions, way.drivers)
            assert np.abs(mechanism.poses(q[-1]).matrix - mechanism.poses(q)[-1].matrix).max() <= CLOSED * mechanism_size(case), way.drivers
    assert_true(case, np.array([case.q(at) for at in everything]), everything, ("all in one batch",))


def assert_true(case: Case, q: FloatArray, expected: list[Solution], drivers: tuple[str, ...]) -> None:
    """Poses and joint values satisfy every joint and coupling, the drivers are where they were asked to be, and the branch is the same."""
    mechanism, equations = case.mechanism, case.equations
    configuration, poses = mechanism.configuration(q), mechanism.poses(q).matrix
    assert np.abs(configuration.columns[:, list(mechanism.driver_columns)] - q).max(initial=0.0) < 1e-14 + 1e-15 * np.abs(q).max(
        initial=0.0
    )
    for k, truth in enumerate(expected):
        ours = equations.read(poses[k], {joint.name: configuration[joint.name][k] for joint in mechanism.joints})
        assert np.abs(equations.residual(ours)).max(initial=0.0) < CLOSED, (drivers, case.specimen.story)
        assert_close(case, poses[k], truth, drivers)
        assert np.abs((ours.s - truth.s) / equations.L).max(initial=0.0) < ROUNDING / min(1.0, truth.sigma) * reach(case), drivers


def assert_close(case: Case, poses: FloatArray, truth: Solution, drivers: tuple[str, ...]) -> None:
    apart = poses - truth.X
    apart[:, :3, 3] /= case.equations.L_part[:, None]
    assert np.abs(apart).max() < ROUNDING / min(1.0, truth.sigma) * reach(case), (drivers, case.specimen.story)


@pytest.mark.parametrize("seed", seeds())
def test_a_sweep_ends_where_the_equations_do(seed: int) -> None:
    case = case_of(seed)
    mechanism, rest = case.mechanism, dict(zip((c.name for c in case.mechanism.drivers), case.mechanism.rest, strict=True))
    for way in case.ways:
        (name, *others), end = way.drivers, way.solutions[-1:]
        if others or not end or name not in rest:
            continue  # a ball has neither
        value = end[0].s[case.equations.place[name]]
        sweep = mechanism.drive(name, rest[name], value, steps=5)
        assert len(sweep.values) == 5, (name, sweep.findings, case.specimen.story)
        assert_close(case, sweep.poses().matrix[-1], end[0], way.drivers)


@pytest.mark.parametrize("seed", seeds())
def test_jacobians_are_the_velocities_that_the_equations_give(seed: int) -> None:
    case = case_of(seed)
    for way in case.ways[-1:]:
        for at in way.solutions[-1:]:
            v, omega = case.velocities(at)
            units = case.equations.L[[case.equations.place[name] for name in case.freedoms]]
            point = case.rng.uniform(-1, 1, 3) * mechanism_size(case)
            for k in case.rng.choice(len(case.mechanism.parts), 2):
                part = case.mechanism.parts[k]
                J = case.mechanism.jacobian(case.q(at), part, SE3.from_translation(point))
                arm = at.X[k, :3, :3] @ point
                v_point, turning = v[k] + np.cross(omega[k], arm, axis=0), omega[k]
                tolerance = ROUNDING * reach(case) / min(1.0, at.sigma) ** 2
                apart = np.abs(J - np.concatenate([v_point, turning])) * units
                assert apart[:3].max(initial=0.0) < tolerance * mechanism_size(case), (part, case.specimen.story)
                assert apart[3:].max(initial=0.0) < tolerance, (part, case.specimen.story)


def reach(case: Case) -> float:
    """Return how far apart things are, in units of the smallest motif."""
    return mechanism_size(case) / float(case.equations.L_part.min())


def mechanism_size(case: Case) -> float:
    """Return how far the parts are from the origin [mm]."""
    return max(1.0, float(np.abs(case.equations.rest.X[:, :3, 3]).max()), float(case.equations.L_part.max()))


@pytest.mark.parametrize("seed", seeds(some=10))
def test_a_range_holds_what_a_driver_reaches(seed: int) -> None:
    case = case_of(seed)
    for way in case.ways:
        for at in way.solutions[-1:]:
            if len(way.drivers) == 1 and way.drivers[0] in case.freedoms:
                value = at.s[case.equations.place[way.drivers[0]]]
                feasible = case.mechanism.feasible_range(way.drivers[0])
                assert feasible.lower - 1e-9 <= value <= feasible.upper + 1e-9, (feasible, case.specimen.story)
