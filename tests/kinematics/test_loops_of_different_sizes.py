"""Four-bars whose sizes differ by up to ten thousand, in one mechanism, against the closed formulas of each of them.

A small loop stands on a link of a large one, follows it by a coupling, or shares a pin with it. How large its neighbours are changes
neither where it goes nor where its crank ends: at a dead point, where a parallelogram is flat, or nowhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.connectors import SE3
from articad.kinematics import Coupling, Joint, Mechanism
from tests.kinematics.linkages import at, four_bar, four_bar_angles, joint
from tests.pose_equations import PoseEquations

FloatArray = NDArray[np.float64]
Angle = Callable[[float], float]

SEEDS = [seed if seed < 4 else pytest.param(seed, marks=pytest.mark.soak) for seed in range(40)]
SIZES = (-4.0, 1.0)  # powers of ten by which a later loop is larger than the first
SHARE = 0.85  # of a range: up to there poses are compared
END = 1e-5  # rad by which the end of a range may be off: a flat parallelogram is singular from there on


@dataclass(frozen=True)
class Bar:
    """A four-bar and its place.

    Attributes:
        lengths: Crank, coupler, rocker, frame [mm].
        carrier: Part on which frame and first pin stand.
        names: Parts: crank, coupler, rocker.
        crank: Angle of the crank against the frame at rest [rad].
        branch: Of the two ways of assembling it.
        follows: Its crank's angle, as a function of that of the first loop.
    """

    lengths: tuple[float, float, float, float]
    carrier: str
    names: tuple[str, str, str]
    crank: float
    branch: int
    follows: Angle

    def angles(self, crank: float) -> tuple[float, float]:
        """Return the angles of coupler and rocker against the frame [rad]."""
        return four_bar_angles(*self.lengths, crank, self.branch)

    def range(self) -> tuple[float, float]:
        """Return where the crank's angle ends on either side of rest [rad]: cosines of the angles at which two links are in line."""
        a, b, c, d = self.lengths
        if math.isclose(a, c) and math.isclose(b, d):  # a parallelogram is flat at every half turn
            low = math.pi * math.floor(self.crank / math.pi)
            return low, low + math.pi
        ends = [math.acos(cosine) for far in (b + c, b - c) if abs(cosine := (a * a + d * d - far * far) / (2 * a * d)) < 1]
        ends = sorted(turn * 2 * math.pi + side * end for end in ends for side in (-1, 1) for turn in (-1, 0, 1))
        return (
            max((end for end in ends if end < self.crank), default=-math.inf),
            min((end for end in ends if end > self.crank), default=math.inf),
        )


def lengths(rng: np.random.Generator, size: float, *, turns: bool = False) -> tuple[float, float, float, float]:
    """Return lengths of links of a crank that goes round, of one that does not, or of a parallelogram."""
    kind = "turns" if turns else rng.choice(["turns", "rocks", "parallelogram"])
    while True:
        a, b, c, d = (float(x) for x in size * rng.uniform(0.3, 1.2, 4))
        if kind == "parallelogram":
            return a, d, a, d
        least, *middle, most = sorted((a, b, c, d))
        slack = sum(middle) - least - most  # Grashof: some link goes round where it is positive
        wanted = least == a and slack > 0.1 * size if kind == "turns" else slack < -0.1 * size
        if wanted and most < 0.9 * (a + b + c + d - most):
            return a, b, c, d


def bar(rng: np.random.Generator, size: float, carrier: str, tag: str, follows: Angle | None = None, *, turns: bool = False) -> Bar:
    """Return a random four-bar that rests well within its range."""
    while True:
        found = Bar(
            lengths(rng, size, turns=turns), carrier, (f"crank{tag}", f"coupler{tag}", f"rocker{tag}"), float(rng.uniform(-math.pi, math.pi)),
            int(rng.choice([-1, 1])), follows or (lambda angle: angle),
        )  # fmt: skip
        a, b, c, d = found.lengths
        far = math.sqrt(a * a + d * d - 2 * a * d * math.cos(found.crank))
        low, high = found.range()
        if abs(b - c) < 0.98 * far < 0.96 * (b + c) and found.crank - low > 0.3 < high - found.crank:
            if math.isclose(a, c) and math.isclose(b, d):  # the way of assembling it in which links stay parallel
                branch = next(k for k in (-1, 1) if abs(math.remainder(four_bar_angles(a, b, c, d, found.crank, k)[0], 2 * math.pi)) < 1e-6)
                return replace(found, branch=branch)
            return found


def standing(one: Bar, place: SE3, tag: str) -> list[Joint]:
    """Return the joints of a four-bar at a place of its carrier."""
    plain = four_bar(*one.lengths, crank=one.crank, branch=one.branch)
    names = {"frame": one.carrier, **dict(zip(("crank", "coupler", "rocker"), one.names, strict=True))}
    return [
        replace(
            j, name=f"{j.name}{tag}", parent=names[j.parent], child=names[j.child],
            T_parent_connector=place @ j.T_parent_connector if j.parent == "frame" else j.T_parent_connector,
        )
        for j in plain.joints
    ]  # fmt: skip


def mechanism_of(seed: int) -> tuple[Mechanism, list[Bar]]:
    """Return a mechanism, and its loops; those whose crank is a function of the first one's come right after it."""
    rng = np.random.default_rng(seed)
    size = float(10 ** rng.uniform(0, 4))
    first = bar(rng, size, "frame", "0", turns=bool(rng.random() < 0.5))
    bars, joints, couplings = [first], standing(first, at(0), "0"), list[Coupling]()
    small = float(size * 10 ** rng.uniform(*SIZES))

    # a loop that follows by a coupling
    ratio = float(rng.choice([-2.0, -1.0, 0.5, 1.0, 3.0]))
    tied = bar(rng, small, str(rng.choice(["frame", *first.names])), "1")
    tied = replace(tied, follows=lambda angle: tied.crank + ratio * (angle - first.crank))
    bars.append(tied)
    joints += [replace(j, driver=False) for j in standing(tied, SE3.trans(*rng.uniform(-size, size, 3)), "1")]
    couplings.append(Coupling("tie", "linear", "crank0", "crank1", ratio, tied.crank - ratio * first.crank))

    # a loop that shares the pin between crank and coupler of the first one: a stub of the coupler is its crank, the crank its frame
    def turn_of_pin(angle: float) -> float:
        return first.angles(angle)[0] - angle

    stub = bar(rng, float(size * 10 ** rng.uniform(-4, -1)), first.names[0], "2", turns=True)
    stub = replace(stub, follows=lambda angle: stub.crank + turn_of_pin(angle) - turn_of_pin(first.crank))
    (a, b, c, d), (coupler, rocker) = stub.lengths, stub.angles(stub.crank)
    pin = at(first.lengths[0])
    on_coupler = SE3.rot_z(stub.crank - turn_of_pin(first.crank))
    joints += [
        joint("pin_b2", "revolute", (first.names[1], on_coupler @ at(a)), ("coupler2", at(0)), rest=[coupler - stub.crank]),
        joint("pin_c2", "revolute", ("coupler2", at(b)), ("rocker2", at(c)), rest=[rocker - coupler]),
        joint("rocker2", "revolute", (first.names[0], pin @ at(d)), ("rocker2", at(0)), rest=[rocker]),
    ]
    bars.append(stub)

    # a loop that is only carried, with a driver of its own
    carried = bar(rng, float(size * 10 ** rng.uniform(*SIZES)), str(rng.choice([*first.names, *tied.names])), "3")
    bars.append(carried)
    joints += standing(carried, SE3.trans(*rng.uniform(-size, size, 3)), "3")
    parts = ["frame", *first.names, *tied.names, "coupler2", "rocker2", *carried.names]
    shuffled = [joints[k] for k in rng.permutation(len(joints))]
    return Mechanism(parts, "frame", shuffled, couplings), bars


def reach(bars: list[Bar]) -> tuple[float, float]:
    """Return where the first crank ends [rad], by its own loop and by those that follow it: bisection of functions of one angle."""
    low, high = bars[0].range()
    ends = []
    for side, end in ((-1, low), (1, high)):
        far = bars[0].crank + side * 40.0 if math.isinf(end) else end
        stops = list(_stops(bars[0], bars[1:], far))
        ends.append(min(stops, key=lambda stop: abs(stop - bars[0].crank)) if stops else end)
    return ends[0], ends[1]


def _stops(first: Bar, others: list[Bar], far: float) -> Iterator[float]:
    for other in others:
        low, high = other.range()
        inside = [low < other.follows(first.crank + share * (far - first.crank)) < high for share in np.linspace(0, 1, 4001)[:-1]]
        if not all(inside):
            k = inside.index(False)
            good, bad = (first.crank + (k - 1 + step) / 4000 * (far - first.crank) for step in (0, 1))
            for _ in range(60):
                middle = 0.5 * (good + bad)
                good, bad = (middle, bad) if low < other.follows(middle) < high else (good, middle)
            yield good


@pytest.mark.parametrize("seed", SEEDS)
def test_ranges_end_where_a_loop_does_whatever_the_size_of_its_neighbours(seed: int) -> None:
    mechanism, (first, tied, stub, carried) = mechanism_of(seed)
    assert mechanism.mobility == 2
    for name, ends in (("crank0", reach([first, tied])), ("crank3", carried.range())):
        found = mechanism.feasible_range(name)
        assert (found.lower, found.upper) == pytest.approx(ends, abs=END), (name, found, first, tied, stub, carried)
        reasons = {"endless"} if math.isinf(ends[0]) else {"dead point", "singular"}
        assert {found.lower_reason, found.upper_reason} <= reasons, (name, found)


@pytest.mark.parametrize("seed", SEEDS)
def test_poses_are_those_of_the_closed_formulas(seed: int) -> None:
    mechanism, bars = mechanism_of(seed)
    rng = np.random.default_rng([seed, 1])
    places = {c.name: k for k, c in enumerate(mechanism.drivers)}
    spans = {"crank0": (bars[0].crank, reach(bars[:2])), "crank3": (bars[3].crank, bars[3].range())}
    q = np.tile(mechanism.rest, (6, 1))
    for name, (rest, ends) in spans.items():
        low, high = (rest + SHARE * (max(-7.0, min(7.0, end - rest))) for end in ends)
        q[:, places[name]] = rng.uniform(low, high, len(q))
    X = mechanism.poses(q).matrix
    for row, T in zip(q, X, strict=True):
        for one in bars:
            own = row[places["crank3"]] if one is bars[3] else one.follows(row[places["crank0"]])
            frame = T[mechanism.part_index(one.carrier)]
            for part, angle in zip(one.names[1:], one.angles(own), strict=True):
                turned = frame[:3, :3].T @ T[mechanism.part_index(part)][:3, :3]
                error = math.remainder(math.atan2(turned[1, 0], turned[0, 0]) - angle, 2 * math.pi)
                assert abs(error) < 1e-8, (part, own, one)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_tests_own_equations_end_before_a_small_parallelogram_is_flat(seed: int) -> None:
    """They look at the product of singular values: a large loop's own small ones hide nothing."""
    rng = np.random.default_rng(seed)
    size = 1000.0
    large = bar(rng, size, "frame", "0", turns=True)
    while True:
        small = bar(rng, float(size * 10 ** rng.uniform(-3, 1)), large.names[1], "1")
        if math.isclose(small.lengths[0], small.lengths[2]) and abs(small.lengths[0] / small.lengths[1] - 1) > 0.05:
            break
    far = 100 * max(size, small.lengths[0])  # away from the origin of its carrier, as a weak equation of its own
    mechanism = Mechanism(
        ["frame", *large.names, *small.names], "frame",
        [*standing(large, at(0), "0"), *standing(small, SE3.trans(far, 0, 0), "1")],
    )  # fmt: skip
    rest = {name: np.asarray(mechanism.poses(mechanism.rest).matrix[mechanism.part_index(name)]) for name in mechanism.parts}
    sizes = {name: small.lengths[1] if name in small.names else size for name in mechanism.parts}
    equations = PoseEquations(mechanism, rest, sizes)
    drivers = [c.name for c in mechanism.drivers]
    for side, end in zip((-1, 1), small.range(), strict=True):
        way = equations.follow(drivers, {"crank1": small.crank + side * 4.0})
        reached = float(way[-1].s[equations.place["crank1"]])
        assert side * reached < side * end
