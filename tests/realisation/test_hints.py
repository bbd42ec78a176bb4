"""Hints about joints that are not made, and fits for another diameter: the shapes changed as a hint says are found no more."""

from __future__ import annotations

import re
from typing import Any

import pytest
from build123d import Box, Cylinder, Pos, Sphere

from articad.certificates.fits import check_fits
from articad.plan.resolve import Fit
from tests.obedience import worse
from tests.realisation.test_bores import scene
from tests.realisation.test_verdicts import BALL, carriage, hinge, judged, socket

TURN: dict[str, Any] = {"lower": (-1.0,), "upper": (1.0,)}


def screwed(z: float, x: float) -> Any:
    """A plate with a hole for a screw."""
    return Pos(0, 0, z) * (Box(40, 40, 10) - Pos(x, 0, 0) * Cylinder(2, 10))


BLOCKS = {"a": Pos(0, 0, -25) * Box(20, 20, 4), "b": Pos(0, 24, 0) * Box(4, 30, 40)}

# code, joint, shapes and limits with the fault; for each wording of the hint, shapes and limits as its reader makes them
CASES: list[tuple[str, str, dict[str, Any], dict[str, Any], dict[str, tuple[dict[str, Any], dict[str, Any]]]]] = [
    ("W_JOINT_NOT_MADE", "revolute", BLOCKS, TURN, {"a pin about the joint's axis and the other a bore": (hinge(), TURN)}),
    (
        "W_JOINT_NOT_MADE",
        "slider",
        {"a": Pos(0, -60, 0) * Box(40, 30, 60), "b": Pos(0, 60, 0) * Box(10, 20, 30)},
        {"lower": (-10.0,), "upper": (10.0,)},
        {"a guide that encloses the other, such as a groove": (carriage(), {"lower": (-10.0,), "upper": (10.0,)})},
    ),
    (
        "W_JOINT_NOT_MADE",
        "ball",
        {"a": Pos(0, 0, -60) * Box(40, 40, 40), "b": Pos(0, 0, 20) * Cylinder(3, 30)},
        {"cone": 0.5},
        {
            "a ball and the other a socket about the joint's centre that holds more than half": (
                {"a": socket(4.0), "b": BALL},
                {"cone": 0.5},
            )
        },
    ),
    (
        "W_JOINT_PARTLY_MADE",
        "ball",
        {"a": socket(-1.0), "b": BALL},
        {"cone": 0.5},
        {"Add surfaces that stop": ({"a": socket(4.0), "b": BALL}, {"cone": 0.5})},
    ),
    (
        "W_JOINT_LEAVES",
        "slider",
        carriage(),
        {"lower": (0.0,), "upper": (46.0,)},
        {
            "Lengthen the guide": (carriage(length=120.0), {"lower": (0.0,), "upper": (46.0,)}),
            "or shorten the range": (carriage(), {"lower": (0.0,), "upper": (30.0,)}),
        },
    ),
    (
        "W_JOINT_SHORT",
        "slider",
        carriage(),
        {"lower": (0.0,), "upper": (40.0,)},
        {
            "Lengthen the guide": (carriage(length=120.0), {"lower": (0.0,), "upper": (40.0,)}),
            "or shorten the travel": (carriage(), {"lower": (0.0,), "upper": (30.0,)}),
        },
    ),
    (
        "W_HOLES_APART",
        "fixed",
        {"a": screwed(-5, 0), "b": screwed(5, 4)},
        {},
        {
            "Move the hole of b to": ({"a": screwed(-5, 0), "b": screwed(5, 0)}, {}),
            "or that of a to": ({"a": screwed(-5, 4), "b": screwed(5, 4)}, {}),
        },
    ),
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}-{case[1]}")
def test_a_joint_made_as_the_hint_says_is_found_no_more(case: Any) -> None:
    code, kind, shapes, limits, ways = case
    found = judged(shapes, kind, **limits)[1].findings.of(code)
    assert found
    for words, (mended, span) in ways.items():
        assert words in found[0].hint
        after = judged(mended, kind, **span)[1].findings
        assert not after.of(code)
        assert not worse(judged(shapes, kind, **limits)[1].findings, after)


@pytest.mark.parametrize("bore", [10.005, 16.01])
def test_a_fit_stated_for_the_diameter_of_the_hint_is_for_that_bore(bore: float) -> None:
    (finding,) = check_fits(scene(bore, bore - 0.02, Fit.named("25 H7/g6"))).findings.of("W_FIT_NOMINAL")
    told = re.search(r"State the fit for ([\d.]+) mm", finding.hint)
    assert told
    assert not check_fits(scene(bore, bore - 0.02, Fit.named(f"{float(told[1]):.1f} H7/g6"))).findings.of("W_FIT_NOMINAL")


def test_a_ball_is_no_shape_of_a_hinge() -> None:
    """The repairer's shapes are no answer to every fault: a ball makes no hinge."""
    assert judged({"a": Sphere(10), "b": Box(5, 5, 5)}, "revolute", **TURN)[1].findings.of("W_JOINT_NOT_MADE")
