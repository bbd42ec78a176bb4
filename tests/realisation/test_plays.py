"""Plays wider than the faces are searched for: they end where the partner stops the child, by its flat faces or by any other shape."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from build123d import Box, Cone, Cylinder, Pos, Rot, Torus

from articad.connectors import SE3
from articad.realisation.verdicts import JointCheck
from tests.realisation.test_verdicts import LYING, judged

TURN: dict[str, Any] = {"lower": (-1.0,), "upper": (1.0,)}
SLIDE: dict[str, Any] = {"lower": (-10.0,), "upper": (10.0,)}
ACROSS = SE3.from_axes(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]))  # y of the joint is level, as z is


def rooms(row: JointCheck) -> dict[str, float]:
    """How far each way that the joint leaves goes."""
    return {loss.way: loss.room for loss in row.losses}


def wheel(below: float, above: float, *, size: float = 20.0) -> dict[str, Any]:
    """A fork with a pin, and a wheel on it, with plays to both cheeks."""
    inner = size + below + above
    middle = (above - below) / 2
    fork = Cylinder(4, inner + 12) + Pos(0, 30, 0) * Box(60, 12, inner + 12)
    for side in (1, -1):
        fork += Pos(0, 12, middle + side * (inner / 2 + 3)) * Box(40, 48, 6)
    return {"a": fork, "b": Cylinder(20, size) - Cylinder(4.1, size + 2)}


@pytest.mark.parametrize(("below", "above"), [(0.3, 0.3), (2.0, 2.0), (2.0, 0.3), (4.5, 4.5), (9.0, 0.3), (30.0, 1.5)])
def test_a_wheel_between_cheeks_has_the_play_that_they_leave(below: float, above: float) -> None:
    row, report = judged(wheel(below, above), "revolute", **TURN)
    wide = {way: play for way, play in (("+z", above), ("-z", below)) if play > 1.0}
    assert rooms(row) == pytest.approx(wide, abs=0.05)
    assert row.verdict == ("partly" if wide else "made")
    if not wide:
        assert report.findings.codes == ()
    for way, play in wide.items():
        assert f"{play:.2g}" in report.findings[0].message
        assert way in report.findings[0].message
        assert "free" not in report.findings[0].message


@pytest.mark.parametrize("seed", range(4))
def test_plays_of_a_wheel_anywhere(seed: int) -> None:
    rng = np.random.default_rng(seed)
    below, above = (float(x) for x in np.exp(rng.uniform(np.log(1.2), np.log(25), 2)))
    row, _ = judged(wheel(below, above, size=float(rng.uniform(8, 40))), "revolute", seed=seed, **TURN)
    assert rooms(row) == pytest.approx({"+z": above, "-z": below}, abs=0.05)


def test_a_wheel_with_one_cheek_is_free_on_the_other_side() -> None:
    shapes = wheel(2.0, 2.0)
    row, report = judged({"a": shapes["a"] - Pos(0, 0, 45) * Box(200, 200, 66), "b": shapes["b"]}, "revolute", **TURN)
    assert rooms(row)["-z"] == pytest.approx(2.0, abs=0.05)
    assert math.isinf(rooms(row)["+z"])
    assert "free along +z" in report.findings[0].message
    assert "2 mm of play along -z" in report.findings[0].message


STOPS: dict[str, Any] = {
    "cone": Pos(0, 0, 17) * Cone(5, 14, 10),
    "torus": Pos(0, 0, 16) * Torus(8, 4),
    "slanted face": Pos(0, 0, 22) * (Rot(X=30) * Box(30, 30, 10)),
}


@pytest.mark.parametrize("shape", STOPS)
def test_a_stop_of_any_shape_ends_a_play(shape: str) -> None:
    """A pin with a collar below and another shape above: the eye moves until it meets that, which is no plane."""
    pin = Cylinder(4, 60) + Pos(0, 0, -12.1) * Cylinder(12, 4) + STOPS[shape]
    row, _ = judged({"a": pin, "b": Cylinder(14, 20) - Cylinder(4.2, 22)}, "revolute", **TURN)
    assert set(rooms(row)) <= {"+z"}
    assert all(math.isfinite(room) for room in rooms(row).values())


@pytest.mark.parametrize("play", [0.3, 2.0, 6.0, 12.0])
@pytest.mark.parametrize("length", [40.0, 200.0])
def test_a_drawer_in_a_wide_channel_has_the_play_of_its_walls(play: float, length: float) -> None:
    """A box in a square channel: it shifts by the play, and tilts by twice that over its length."""
    channel = Box(60 + 2 * play, 60 + 2 * play, length + 60) + Box(90 + 2 * play, 90 + 2 * play, length + 60)
    shapes = {"a": channel - Box(60 + 2 * play, 60 + 2 * play, length + 80), "b": Box(60, 60, length)}
    row, _ = judged(shapes, "slider", frame=LYING, **SLIDE)
    searched = max(1.0, 0.01 * math.hypot(60, 60, length))  # within which flat faces hold
    wide = {sign + axis: play for sign in "+-" for axis in "xy"} if play > searched else {}
    assert {way: room for way, room in rooms(row).items() if not way.startswith("about")} == pytest.approx(wide, abs=0.05)
    tilts = {way for way in rooms(row) if way.startswith("about")}
    assert ("about x" in tilts) == ("about y" in tilts) == (2 * play / length > 0.15), rooms(row)


def test_a_groove_that_is_open_aslant_is_not_held_by_its_walls() -> None:
    """Along x and y the walls of the groove stop the tongue; between them it leaves."""
    groove = Rot(Z=30) * (Box(60, 60, 60) - Pos(20, 0, 0) * Box(60, 12.4, 80))
    row, report = judged({"a": groove, "b": Rot(Z=30) * Box(20, 12, 30)}, "slider", frame=ACROSS, **SLIDE)
    assert math.isinf(max(rooms(row).values()))
    assert report.findings.codes == ("W_JOINT_PARTLY_MADE",)


def test_a_key_that_falls_in_has_no_tilts_of_its_own() -> None:
    """A barrel in a thin wall with a bit inside: it is free inwards, and the bit stops it outwards and keeps it square."""
    wall = Box(80, 80, 2) - Cylinder(8.1, 4)
    key = Cylinder(8, 20) + Pos(0, 0, -7) * Box(60, 6, 6)
    row, report = judged({"a": wall, "b": key}, "revolute", **TURN)
    assert math.isinf(rooms(row)["-z"])
    assert rooms(row)["+z"] == pytest.approx(3.0, abs=0.05)
    assert "about y" not in rooms(row)
    assert report.findings.codes == ("W_JOINT_PARTLY_MADE",)
