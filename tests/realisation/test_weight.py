"""Bodies that stand by their weight: a tilt that lifts them is held by it, one that they fall over by is not. The potential energy decides."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from build123d import Box, Cylinder, Plane, Polygon, Pos, extrude

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.interference.scene import Scene
from articad.realisation.verdicts import TILT_RAD, JointCheck
from articad.support.carried import Bodies
from tests.interference.mechanisms import joint
from tests.realisation.test_verdicts import judged, mesh

PLANE: dict[str, Any] = {"lower": (-5.0, -5.0, -1.0), "upper": (5.0, 5.0, 1.0)}
TABLE = Pos(0, 0, -5) * Box(400, 400, 10)
UPRIGHT = SE3.identity()


def leaning(angle: float) -> SE3:
    """A frame that is turned about its x axis."""
    return SE3.from_axis_angle(np.array([1.0, 0.0, 0.0]), angle)


def risen(frame: SE3, centre: FloatArray, foot: FloatArray, axis: int, angle: float) -> float:
    """How far the centre of mass rises when a body turns about an axis through a point of its foot [mm]."""
    arm = centre - foot
    turned = SE3.from_axis_angle(np.eye(3)[axis], angle).rotation @ arm
    return float((frame.rotation @ (turned - arm))[2])


def weight_holds(frame: SE3, half: tuple[float, float], height: float, axis: int) -> bool:
    """Whether a body with a foot of these half widths needs work to be turned by TILT_RAD about x or y, over either edge."""
    centre, across = np.array([0.0, 0.0, height / 2]), 1 - axis
    feet = [(sign, sign * half[across] * np.eye(3)[across]) for sign in (1.0, -1.0)]
    return all(
        risen(frame, centre, foot, axis, turn * sign * TILT_RAD) > 0 for sign, foot in feet for turn in ((-1.0,) if axis == 0 else (1.0,))
    )


def tilts(row: JointCheck) -> dict[str, bool]:
    """Which tilts are left to the weight."""
    return {loss.way: loss.by_weight for loss in row.losses if loss.way.startswith("about")}


@pytest.mark.parametrize("seed", range(8))
def test_a_block_on_a_table_tilts_only_if_that_lets_it_sink(seed: int) -> None:
    rng = np.random.default_rng(seed)
    half = tuple(float(x) for x in np.exp(rng.uniform(np.log(1.5), np.log(40), 2)))
    height, frame = float(np.exp(rng.uniform(np.log(4), np.log(200)))), leaning(float(rng.uniform(0, 0.2)))
    block = Pos(0, 0, height / 2) * Box(2 * half[0], 2 * half[1], height)
    row, report = judged({"a": TABLE, "b": block}, "planar", seed=seed, frame=frame, **PLANE)
    expected = {name: weight_holds(frame, (half[0], half[1]), height, axis) for axis, name in enumerate(("about x", "about y"))}
    assert tilts(row) == {name: expected[name] for name in tilts(row)}
    assert all(
        expected[name] for name in set(expected) - set(tilts(row))
    )  # to lift a broad block by a tilt takes more than what is searched
    assert report.findings.codes == (() if all(expected.values()) else ("W_JOINT_PARTLY_MADE",))


@pytest.mark.parametrize(("radius", "height"), [(20.0, 6.0), (5.0, 60.0), (5.0, 120.0), (2.0, 40.0), (2.0, 80.0), (1.5, 90.0)])
def test_a_puck_is_held_by_its_weight_and_a_needle_is_not(radius: float, height: float) -> None:
    row, _ = judged({"a": TABLE, "b": Pos(0, 0, height / 2) * Cylinder(radius, height)}, "planar", frame=UPRIGHT, **PLANE)
    stays = radius * math.sin(TILT_RAD) > height / 2 * (1 - math.cos(TILT_RAD))
    assert tilts(row) == {"about x": stays, "about y": stays}


@pytest.mark.parametrize("gap", [0.1, 0.4])
@pytest.mark.parametrize("kind", ["revolute", "cylindrical"])
def test_a_lid_in_a_rebate_is_held_by_its_weight(kind: str, gap: float) -> None:
    shapes = {"a": Pos(0, 0, -8) * Cylinder(50, 24) - Pos(0, 0, 2) * Cylinder(40 + gap, 4), "b": Pos(0, 0, 3) * Cylinder(40, 6)}
    limits = {"lower": (0.0, -1.0), "upper": (0.1, 1.0)} if kind == "cylindrical" else {"lower": (-1.0,), "upper": (1.0,)}
    row, report = judged(shapes, kind, frame=UPRIGHT, **limits)
    assert report.findings.codes == ()
    assert all(loss.by_weight for loss in row.losses), row.losses


def test_the_same_lid_on_a_wall_is_not_held() -> None:
    shapes = {"a": Pos(0, 0, -8) * Cylinder(50, 24) - Pos(0, 0, 2) * Cylinder(40.1, 4), "b": Pos(0, 0, 3) * Cylinder(40, 6)}
    _, report = judged(shapes, "revolute", frame=leaning(math.pi / 2), lower=(-1.0,), upper=(1.0,))
    assert report.findings.codes == ("W_JOINT_PARTLY_MADE",)


@pytest.mark.parametrize("overhang", [0.4, 0.6])
def test_a_block_that_hangs_over_the_edge_is_not_held(overhang: float) -> None:
    """Over half of it beyond the edge: it falls over by itself, and the support says that nothing carries it."""
    block = Pos(200 + 40 * (2 * overhang - 1), 0, 5) * Box(80, 40, 10)
    row, _ = judged({"a": TABLE, "b": block}, "planar", frame=UPRIGHT, **PLANE)
    assert tilts(row).get("about y") is (overhang < 0.5)
    scene = Scene.of({"a": mesh(TABLE), "b": mesh(block)}, [joint("j", "planar", "a", "b")], deflection=0.01)
    sinking = Bodies(scene, dict.fromkeys("ab", SE3.identity()), "a", ()).moved_by(np.array([0.0, 0.0, -1.0]))
    assert bool(sinking) is (overhang > 0.5)


@pytest.mark.parametrize("seed", range(4))
def test_the_weight_holds_nothing_of_what_hangs(seed: int) -> None:
    """A plate under a table, which nothing carries."""
    row, report = judged({"a": TABLE, "b": Pos(0, 0, -15.1) * Box(60, 60, 10)}, "planar", seed=seed, frame=UPRIGHT, **PLANE)
    assert [loss.way for loss in row.losses if not loss.by_weight][:1] == ["-z"]
    assert not any(tilts(row).values())
    assert report.findings.codes == ("W_JOINT_PARTLY_MADE",)


@pytest.mark.parametrize(("flank", "holds"), [(45.0, True), (25.0, True), (10.0, False)])
def test_a_rider_on_a_roof_is_held_sideways_by_its_weight(flank: float, holds: bool) -> None:
    """It leaves a roof sideways only upwards along a flank: on a steep one its weight holds it, on a flat one nothing does."""
    rise = 40 * math.tan(math.radians(flank))
    roof = Pos(0, -20, 0) * Box(100, 40, 200) + extrude(
        Plane.XY * Polygon((-50, 0), (50, 0), (0, 50 * rise / 40), align=None), 100, both=True
    )
    rider = Pos(0, 30, 0) * Box(60, 60, 60) - extrude(
        Plane.XY * Polygon((-50, 0.1), (50, 0.1), (0, 50 * rise / 40 + 0.1), align=None), 100, both=True
    )
    frame = SE3.from_axes(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))  # y up
    row, _ = judged({"a": roof, "b": rider}, "slider", frame=frame, lower=(-10.0,), upper=(10.0,))
    assert {loss.way: loss.by_weight for loss in row.losses if loss.way.endswith("x") and loss.way[0] in "+-"} == {"+x": holds, "-x": holds}
