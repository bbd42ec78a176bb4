"""Plates on blocks with screw holes that meet, and the same with one hole moved, mirrored patterns, and holes that need no partner."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from build123d import Box, Cone, Cylinder, Pos, RectangleRounded, Rot, extrude

from articad.findings import Finding
from tests.interference.mechanisms import at, fixed, random_rotation
from tests.realisation.test_verdicts import judged

BLOCK, PLATE = Pos(0, 0, -10) * Box(100, 80, 20), Pos(0, 0, 4) * Box(96, 76, 8)
SCREW, THREAD = 2.25, 1.65  # radii


def pattern(rng: np.random.Generator, moved: float = 0.0) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Return places of 2 to 4 holes, 20 mm apart or more, and the same with the first one moved."""
    places: list[tuple[float, float]] = []
    while len(places) < int(rng.integers(2, 5)):
        place = float(rng.uniform(-34, 34)), float(rng.uniform(-24, 24))
        if all(math.dist(place, other) >= 20 for other in places):
            places.append(place)
    angle = float(rng.uniform(0, 2 * math.pi))
    (x, y), *others = places
    return places, [(x + moved * math.cos(angle), y + moved * math.sin(angle)), *others]


def block(places: list[tuple[float, float]], depth: float = 12.0) -> Any:
    """Return a block with tapped holes from above."""
    shape = BLOCK
    for x, y in places:
        shape -= Pos(x, y, -depth / 2) * Cylinder(THREAD, depth)
    return shape


def plate(places: list[tuple[float, float]], kind: str = "through") -> Any:
    """Return a plate with holes for screws."""
    shape = PLATE
    for x, y in places:
        hole = Pos(0, 0, 4) * Cylinder(SCREW, 8)
        if kind == "counterbored":
            hole += Pos(0, 0, 6) * Cylinder(4, 4)
        if kind == "counterbored below":
            hole += Pos(0, 0, 2) * Cylinder(4, 4)
        if kind == "blind":
            hole = Pos(0, 0, 2.5) * Cylinder(SCREW, 5)
        if kind == "countersunk":
            hole += Pos(0, 0, 6.75) * Cone(SCREW, SCREW + 2.5, 2.5)
        if kind == "chamfered":
            hole += Pos(0, 0, 0.25) * Cone(SCREW + 0.5, SCREW, 0.5)
        shape -= Pos(x, y, 0) * hole
    return shape


KINDS = ["through", "counterbored", "counterbored below", "blind", "countersunk", "chamfered"]


def found(a: Any, b: Any, seed: int = 0, **more: Any) -> tuple[Finding, ...]:
    return judged({"a": a, "b": b, **more.pop("shapes", {})}, "fixed", seed=seed, **more)[1].findings.of("W_HOLES_APART")


@pytest.mark.parametrize("kind", KINDS)
def test_holes_that_meet_are_no_finding(kind: str) -> None:
    places, _ = pattern(np.random.default_rng(KINDS.index(kind)))
    assert found(block(places), plate(places, kind), seed=1) == ()


@pytest.mark.parametrize(
    ("kind", "moved"), [*zip(KINDS, (1.0, 1.5, 2.5, 4.0, 6.0, 8.0), strict=True), ("through", 8.0), ("blind", 1.0), ("chamfered", 1.5)]
)
def test_a_hole_that_is_moved_is_found(kind: str, moved: float) -> None:
    at_block, at_plate = pattern(np.random.default_rng(10 * KINDS.index(kind) + round(moved)), moved)
    (one,) = found(block(at_block), plate(at_plate, kind), seed=2)
    assert (one.where, one.parts, one.severity) == ("joints.j", ("a", "b"), "warning")
    assert one.value == pytest.approx(moved, abs=0.01)
    assert "a's of 3.3 mm at" in one.message
    assert "b's of 4.5 mm at" in one.message
    assert one.message.count("mm apart") == 1  # the other holes meet


def test_the_hint_states_where_each_hole_would_meet_the_other() -> None:
    at_block, at_plate = [(-30.0, 0.0), (30.0, 5.0)], [(-30.0, 0.0), (25.0, 5.0)]
    rng = np.random.default_rng(3)
    inside = {name: at(*rng.uniform(-50, 50, 3)) @ random_rotation(rng) for name in ("a", "b")}
    (one,) = found(block(at_block), plate(at_plate), seed=3)
    told = re.findall(r"\((-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\)", one.message + one.hint)
    places = [np.array(list(map(float, each))) for each in told]
    expected = [("a", 30.0), ("b", 25.0), ("b", 30.0), ("a", 25.0)]
    for place, (name, x) in zip(places, expected, strict=True):
        assert place == pytest.approx(inside[name].apply(np.array([[x, 5.0, 0.0]]))[0], abs=0.01)


def test_a_mirrored_pattern_is_found_hole_by_hole() -> None:
    places = [(-20.0, -12.0), (14.0, -4.0), (0.0, 15.0)]
    (one,) = found(block(places), plate([(-x, y) for x, y in places]))
    assert one.message.count("mm apart") == 2  # the third lies on the mirror


NO_PARTNER = {
    "blind holes of the block alone": (block([(-20, 0), (20, 0)]), PLATE),
    "weight saved in the plate alone": (BLOCK, plate([(-20, 0), (20, 0)])),
    "holes far from each other": (block([(-30, -20)]), plate([(30, 20)])),
    "a large opening and a small hole beside it": (block([(0, 0)]), PLATE - Pos(9, 0, 4) * Cylinder(6, 8)),
    "small holes inside a large opening": (block([(8, 0)]), plate([(17, 0)]) - Cylinder(12, 8) - Cylinder(4, 30)),
    "rounded corners of a pocket": (block([(20, 0)]), PLATE - Pos(0, 0, 4) * extrude(RectangleRounded(30, 20, 3), 4, both=True)),
    "a screw in a slot": (block([(-4, 0), (20, 0)]), plate([(20, 0)]) - Pos(0, 0, 4) * (Box(12, 4.5, 8) + Pos(6, 0, 0) * Cylinder(2.25, 8) + Pos(-6, 0, 0) * Cylinder(2.25, 8))),
    "a hole beyond the contact": (block([(0, 0)]), Pos(-54, 0, 0) * plate([(46, 0)])),
    "play of the screw": (block([(0, 0)]), plate([(0.55, 0)])),
    "cavities inside": (BLOCK - Pos(0, 0, -6) * Cylinder(3, 10), PLATE - Pos(5, 0, 3) * Cylinder(3, 4)),
    "holes across": (BLOCK - Pos(0, 0, -10) * Rot(X=90) * Cylinder(3, 100), PLATE - Pos(4, 0, 4) * Rot(X=90) * Cylinder(3, 100)),
    "plates apart": (block([(0, 0)]), Pos(0, 0, 1) * plate([(5, 0)])),
}  # fmt: skip


@pytest.mark.parametrize("case", NO_PARTNER)
def test_holes_that_need_no_partner_are_no_finding(case: str) -> None:
    assert found(*NO_PARTNER[case]) == ()


def test_a_hole_that_a_pin_fills_needs_no_partner() -> None:
    a, b = block([(0, 0), (20, 0)]), plate([(6, 0), (20, 0)])
    assert found(a, b)
    pin = Pos(0, 0, -6) * Cylinder(THREAD, 12)
    assert found(a, b, shapes={"pin": pin}, others=(fixed("press", "a", "pin"),)) == ()


def test_a_spigot_in_its_bore_needs_no_partner() -> None:
    a, b = BLOCK - Pos(0, 0, -5) * Cylinder(8, 10), PLATE - Pos(0, 14, 4) * Cylinder(5, 8)
    assert found(a, b)
    assert found(a, b + Pos(0, 0, -4) * Cylinder(7.9, 8)) == ()


def test_joints_that_move_are_not_asked_for_holes() -> None:
    a, b = block([(0, 0)]), plate([(5, 0)])
    report = judged({"a": a, "b": b}, "planar", lower=(-1.0, -1.0, -0.1), upper=(1.0, 1.0, 0.1))[1]
    assert not report.findings.of("W_HOLES_APART")
