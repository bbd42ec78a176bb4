"""Linkages whose constraints have a multiple root wherever they close, followed and held to closed formulas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from articad.connectors import SE3
from articad.kinematics import Mechanism
from articad.kinematics.deflation import DeflatedSystem
from articad.kinematics.loops import CLOSED
from tests.kinematics.overconstrained import parallel_rods, rods, similar_hexagons

ROD = 120.0  # mm


def uneven_hexagon() -> Mechanism:
    """Equal parallel rods at the corners of a hexagon that lie on no circle, about which the platform could turn as well."""
    turn = np.radians(np.arange(6) * 60.0)
    points = np.column_stack([90 * np.cos(turn), 55 * np.sin(turn), np.zeros(6)])
    points[0, :2] += (15.0, 20.0)
    points[3, :2] += (-5.0, 30.0)
    return rods(points, points + np.array([0, 0, ROD]))


PLATFORMS = {"4": lambda: parallel_rods(4), "5": lambda: parallel_rods(5), "hexagon": uneven_hexagon} | {
    "7": lambda: parallel_rods(7),
    "8": lambda: parallel_rods(8),
}
LARGE = {"7", "8"}


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.soak if name in LARGE else ()) for name in PLATFORMS])
def test_a_platform_on_parallel_rods_translates_over_the_whole_range_of_its_drivers(name: str) -> None:
    mechanism = PLATFORMS[name]()
    assert isinstance(mechanism.branch.groups[0].system, DeflatedSystem)
    assert [c.name for c in mechanism.drivers] == ["foot0.a", "foot0.b"]
    # the rods stand on the hinge of the base in line with themselves at ±90° of b: each may spin there
    swing = mechanism.feasible_range("foot0.b")
    assert abs(swing.lower + math.pi / 2) < 1e-4
    assert abs(swing.upper - math.pi / 2) < 1e-4
    rng = np.random.default_rng(3)
    q = np.concatenate([np.linspace([0, -1.4], [0, 1.4], 8), np.linspace([-1.4, 0], [1.4, 0], 8), rng.uniform(-0.8, 0.8, (8, 2))])
    top = mechanism.poses(q)[:, 1]
    a, b = q.T  # the platform translates as the end of a rod does
    carried = ROD * np.column_stack([np.sin(b), -np.sin(a) * np.cos(b), np.cos(a) * np.cos(b) - 1.0])
    assert np.abs(top.translation - carried).max() < 1e-8
    assert top.angle_to(SE3.identity()).max() < 1e-8
    group = mechanism.branch.groups[0]
    assert all(np.linalg.norm(group.system.residual_one(group.system.to_system(Q))) < CLOSED for Q in mechanism.configuration(q).columns)


def test_a_sweep_of_a_multiple_root_is_sampled_and_says_why() -> None:
    sweep = parallel_rods(4).drive("foot0.a", -0.5, 0.5, 5, certify=True)
    assert len(sweep.values) == 5
    assert sweep.strength == "sampled"
    assert "multiple root" in sweep.reason


class Screw:
    """The platform of `similar_hexagons` by formula: turned by t against the base at height z, with 100² + 60² − 12000 cos t + z² = l²."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.l2 = 100**2 + 60**2 - 12_000 * math.cos(0.3) + 120**2
        self.most = math.acos((13_600 - self.l2) / 12_000)  # t of the flat platform
        (foot,) = (joint for joint in mechanism.joints if joint.name == "foot0")
        self.W = foot.T_parent_connector.matrix[:3, :3]
        self.rest = math.acos(0.3 / self.most)

    def place(self, w: float) -> tuple[float, float]:
        """Return t and z at a place w of the closed curve: above the base for 0 < w < π."""
        t = self.most * math.cos(w)
        z = math.sqrt(max(0.0, self.l2 - 13_600 + 12_000 * math.cos(t)))
        return t, math.copysign(z, math.sin(w))

    def driver(self, w: float) -> float:
        """Return the first angle of the universal joint below the first rod: its direction is (sin b, −sin a cos b, cos a cos b)."""
        t, z = self.place(w)
        _, y, along = self.W.T @ np.array([60 * math.cos(t) - 100, 60 * math.sin(t), z])
        return math.atan2(-y, along)

    def fold(self, sign: int) -> tuple[float, float]:
        """Return where the driver first turns back on the way from rest towards growing (+1) or falling values: w and its value."""
        for side in (1, -1):
            w = self.rest + side * np.linspace(0, 4.0, 4001)
            values = sign * np.unwrap([self.driver(float(x)) for x in w])
            if values[1] > values[0]:
                k = int(np.argmax(np.diff(values) < 0))
                low, high = sorted((float(w[k - 1]), float(w[k + 1])))
                best = minimize_scalar(lambda x: -sign * self.driver(x), bounds=(low, high), method="bounded", options={"xatol": 1e-12})
                return float(best.x), self.driver(float(best.x))
        raise AssertionError("the driver stands at a fold")

    def top(self, value: float, end: float) -> np.ndarray:
        """Return the platform's pose `(4, 4)` relative to rest at a driver's value between rest and the place `end`."""
        w = brentq(lambda x: self.driver(x) - value, self.rest, end, xtol=1e-15)
        t, z = self.place(w)
        return np.array(SE3.from_axes((0, 0, z - 120), (0, 0, 1), (math.cos(t - 0.3), math.sin(t - 0.3), 0)).matrix)


def test_similar_hexagons_screw_as_the_formula_says() -> None:
    mechanism = similar_hexagons()
    screw = Screw(mechanism)
    end, _ = screw.fold(-1)
    values = np.linspace(-0.6, -1e-3, 7)
    tops = mechanism.poses(values[:, None])[:, 1].matrix
    for value, top in zip(values, tops, strict=True):
        assert np.abs(top - screw.top(float(value), end)).max() < 1e-7


@pytest.mark.soak
def test_similar_hexagons_reach_the_dead_points_of_the_formula() -> None:
    mechanism = similar_hexagons()
    screw, reach = Screw(mechanism), mechanism.feasible_range("foot0.a")
    assert (reach.lower_reason, reach.upper_reason) == ("dead point", "dead point")
    assert abs(reach.lower - screw.fold(-1)[1]) < 1e-8
    assert abs(reach.upper - screw.fold(1)[1]) < 1e-8
