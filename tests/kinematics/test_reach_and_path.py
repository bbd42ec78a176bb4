"""Targets are reached wherever part frames stand; several drivers find a way round what bars the straight line."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from articad.connectors import SE3
from articad.errors import KinematicsError, LimitError
from articad.kinematics import Joint, JointLimits, Mechanism
from articad.kinematics.configuration import Configuration
from articad.kinematics.track import Track
from tests.kinematics.linkages import at, from_rest, joint, mismatch

AXES = [(0, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0)]
ORIGINS = np.array([(0, 0, 0), (0, 0, 100), (0, 0, 300), (50, 0, 320), (250, 0, 320), (300, 0, 320)], dtype=float)


def arm(seed: int | None) -> Mechanism:
    """A 6R arm; part frames all at the ground's, as a drawing has them, or anywhere."""
    rng = np.random.default_rng(seed)
    frames = [SE3.identity()]
    for _ in range(6):
        q = rng.normal(size=4)
        frames.append(SE3.identity() if seed is None else SE3.from_quaternion(q / np.linalg.norm(q), rng.uniform(-300, 300, 3)))
    joints: list[Joint] = []
    for i, (axis, origin) in enumerate(zip(AXES, ORIGINS, strict=True)):
        W = SE3.from_axes(origin, axis)
        ends = (f"l{i}", frames[i].inverse() @ W), (f"l{i + 1}", frames[i + 1].inverse() @ W)
        joints.append(joint(f"q{i}", "revolute", *ends, limits=[(-2.8, 2.8)]))
    return Mechanism([f"l{i}" for i in range(7)], "l0", joints)


@pytest.mark.parametrize("seed", [None, 1])
def test_every_pose_of_an_arm_is_reached_whatever_its_part_frames(seed: int | None) -> None:
    mechanism = arm(seed)
    rng = np.random.default_rng(0)
    for q in rng.uniform(-2.5, 2.5, (8, 6)):
        target = mechanism.poses(q)[-1]
        found = mechanism.reach("l6", target)
        assert found.ok
        assert not found.configuration.violations()
        assert np.abs(mechanism.poses(found.q)[-1].matrix - target.matrix).max() < 1e-5


def test_a_target_that_is_not_accepted_is_reached_otherwise_or_refused() -> None:
    mechanism = arm(None)
    target = mechanism.poses([0.3, 0.4, -0.5, 0.6, 0.7, 0.8])[-1]
    first = mechanism.reach("l6", target)
    other = mechanism.reach("l6", target, accept=lambda q: bool(np.abs(q - first.q).max() > 0.1))
    assert other.ok
    assert np.abs(other.q - first.q).max() > 0.1
    with pytest.raises(KinematicsError, match="E_REACH_BARRED"):
        mechanism.reach("l6", target, starts=4, accept=lambda _: False)


def five_bar(limit: float = math.inf) -> Mechanism:
    """Two cranks of 60 at 100 apart, both rods 60, both drive; straight up at rest."""
    pins = [(0, 0), (100, 0), (0, 60), (100, 60), (50, 60 + math.sqrt(60**2 - 50**2))]
    joints = [
        from_rest("a", "revolute", "frame", "l1", at(*pins[0]), driver=True),
        from_rest("d", "revolute", "frame", "r1", at(*pins[1]), driver=True),
        from_rest("b", "revolute", "l1", "l2", at(*pins[2])),
        from_rest("e", "revolute", "r1", "r2", at(*pins[3])),
        from_rest("c", "revolute", "l2", "r2", at(*pins[4])),
    ]
    bounds = JointLimits((-limit,), (limit,))
    joints = [Joint(**{**j.__dict__, "limits": bounds}) if j.name == "c" else j for j in joints]
    return Mechanism(("frame", "l1", "r1", "l2", "r2"), "frame", joints)


def apart(q: np.ndarray) -> float:
    """Return the distance of the two crank pins: the five-bar closes below 120 and is singular at 0 and 120."""
    a, d = (np.array([x - 60 * math.sin(v), 60 * math.cos(v)]) for x, v in ((0.0, q[0]), (100.0, q[1])))
    return float(np.linalg.norm(d - a))


def test_every_closable_place_of_a_five_bar_is_reached_and_depends_on_nothing_else() -> None:
    mechanism = five_bar()
    rng = np.random.default_rng(0)
    targets = np.array([q for q in rng.uniform(-3, 3, (40, 2)) if 2 < apart(q) < 118])
    poses = mechanism.poses(targets)
    for i, q in enumerate(targets):
        assert max(mismatch(mechanism, q)) < 1e-9
        assert np.abs(mechanism.poses(q).matrix - poses[i].matrix).max() < 1e-12


def test_a_batch_names_the_rows_it_cannot_reach() -> None:
    mechanism = five_bar()
    q = np.array([[0.1, 0.1], [1.5, -1.5], [0.2, 0.1]])
    assert apart(q[1]) > 120
    with pytest.raises(KinematicsError, match=r"1 of 3 rows cannot be reached: row 1 \(a = 85\.944°, d = -85\.944°\)"):
        mechanism.poses(q)


def test_a_path_keeps_to_branch_and_limits_where_the_straight_line_does_not() -> None:
    mechanism = five_bar()
    rng = np.random.default_rng(3)
    barred = 0
    for goal in rng.uniform(-3, 3, (200, 2)):
        line = goal * np.linspace(0, 1, 200)[:, None]
        if not 4 < apart(goal) < 116 or all(1 < apart(q) < 119 for q in line):
            continue
        barred += 1
        way = mechanism.path([0.0, 0.0], goal)
        assert len(way) > 2
        assert np.array_equal(way[[0, -1]], [[0.0, 0.0], goal])
        for a, b in itertools.pairwise(way):
            assert all(0 < apart(a + s * (b - a)) < 120 for s in np.linspace(0, 1, 100))
        if barred == 1:
            break
    assert barred == 1


def test_a_path_beyond_a_followers_limit_is_refused_and_one_within_found() -> None:
    mechanism = five_bar(limit=0.8)
    with pytest.raises(LimitError, match="'c'"):
        mechanism.path([0.0, 0.0], [-0.5, 0.5])
    way = mechanism.path([0.0, 0.0], [1.2, 1.0])
    for a, b in itertools.pairwise(way):
        assert not mechanism.configuration(a + np.linspace(0, 1, 30)[:, None] * (b - a)).violations(1e-3)


def test_a_path_asks_about_the_configurations_on_the_way_each_next_to_one_before() -> None:
    """At one q a linkage may have several configurations: what is asked about is the one that the way goes through."""
    mechanism = five_bar()
    asked: list[np.ndarray] = []

    def accept(configuration: Configuration) -> bool:
        asked.append(configuration.columns)
        return True

    mechanism.path([0.0, 0.0], [1.2, 1.0], accept=accept)
    assert len(asked) > 10
    closure = mechanism.branch.system
    for k, Q in enumerate(asked[2:], start=2):
        assert np.abs(closure.evaluate_one(closure.to_system(Q))[0]).max() < 1e-9
        assert min(np.abs(Q - before).max() for before in asked[:k]) < 0.3  # a step is 0.1 rad of the drivers


def test_a_path_is_refused_where_what_follows_is_barred() -> None:
    mechanism = five_bar()
    free = mechanism.configuration([0.6, 0.5])["c"].item()
    with pytest.raises(KinematicsError, match=r"E_NO_PATH|not collision-free"):
        mechanism.path([0.0, 0.0], [1.2, 1.0], accept=lambda configuration: abs(configuration["c"].item()) < abs(free) / 4)


def test_where_no_start_ends_on_the_branch_the_rest_pose_is_as_near_as_it_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism = five_bar()
    monkeypatch.setattr("articad.kinematics.reach._approached", lambda *_: None)
    found = mechanism.reach("l2", [20.0, 500.0, 0.0], starts=3)
    assert not found.ok
    assert np.array_equal(found.q, mechanism.rest)
    placed = mechanism.poses(mechanism.rest)[mechanism.part_index("l2")].translation
    assert found.distance == pytest.approx(float(np.linalg.norm(placed - [20.0, 500.0, 0.0])))


def test_a_range_ends_where_the_linkage_is_not_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limits of joints that follow are not known to hold where a pose was not closed."""
    evaluate = Track.evaluate

    def with_a_gap(track: Track, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        Q, reached, proved = evaluate(track, values)
        return Q, reached & ~((values > 0.1) & (values < 0.2)), proved

    mechanism = five_bar(limit=0.8)
    before = mechanism.feasible_range("a")
    assert before.upper > 0.25
    monkeypatch.setattr(Track, "evaluate", with_a_gap)
    found = five_bar(limit=0.8).feasible_range("a")
    assert found.upper == pytest.approx(0.1, abs=1e-6)
    assert found.upper_reason == "not followed further"
    assert found.lower == pytest.approx(before.lower)
    assert found.findings.of("E_NOT_FOLLOWED") or not math.isfinite(found.driver.upper)
