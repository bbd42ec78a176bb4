"""Who models exactly what a text allows at most, or at least, passes: no check refuses the last digits of a mesh."""

from __future__ import annotations

import math
from typing import Any

import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import Part, box
from articad_bench.check import within
from articad_bench.subject import Subject
from tests.bench.test_checks import form
from tests.kinematics.linkages import at, joint

SIDE, HIGH, TRAVEL = 200.0, 30.0, 70.0
OFF = [0.1 + 0.2, 1 / 3, math.pi, -math.e, 1e3 / 7]
"""Places at which sums of sizes are no longer exact."""


def shuttle(off: float) -> Subject:
    """A plate that slides up by 70 mm on a plate that is the ground, both standing somewhere."""
    plates = [box(SIDE, SIDE, HIGH).transformed(SE3.trans(off, off, z + off)) for z in (0.0, HIGH)]
    parts = [Part.from_mesh(name, mesh, density=1000) for name, mesh in zip(("low", "high"), plates, strict=True)]
    lift = joint("lift", "slider", ("low", at(0)), ("high", at(0)), limits=[(0.0, TRAVEL)])
    return Subject(Assembly.from_parts("made", parts=parts, joints=[lift], ground="low"))


MASS = SIDE * SIDE * HIGH * 1e-6
EXACT: dict[str, tuple[dict[str, Any], str, float]] = {
    "extent": ({"side": "x"}, "mm", SIDE),
    "mass": ({}, "kg", 2 * MASS),
    "volume": ({}, "cm3", 2000 * MASS),
    "matter": ({}, "share", 1.0),
    "wall": ({}, "mm", HIGH),
    "rise": ({}, "mm", TRAVEL),
    "travel": ({"joint": {"type": "slider"}}, "by", TRAVEL),
    "level": ({}, "mm", TRAVEL),
    "reaches": ({"joint": {"type": "slider"}, "toward": [0, 0, 1]}, "mm", TRAVEL),
    "effort": ({"joint": {"type": "slider"}}, "most", MASS * 9.81),
    "carries": ({"kg": 1, "stress": 9, "modulus": 9000, "top": [SIDE, SIDE]}, "level", 2 * HIGH),
}


@pytest.mark.parametrize("off", OFF)
@pytest.mark.parametrize("kind", EXACT)
def test_what_is_exactly_a_bound_is_within_it(kind: str, off: float) -> None:
    also, name, value = EXACT[kind]
    subject = shuttle(off)

    for bounds in ([value, 2 * value], [value / 2, value], [value, value]):
        judged = form({"kind": kind, **also, name: bounds}).judge(subject)
        assert judged.ok, f"{bounds}: {judged.measured}"


@pytest.mark.parametrize("kind", EXACT)
def test_what_is_beyond_a_bound_is_not(kind: str) -> None:
    also, name, value = EXACT[kind]

    for bounds in ([1.0001 * value, 2 * value], [value / 2, 0.9999 * value]):
        assert not form({"kind": kind, **also, name: bounds}).judge(shuttle(0.0)).ok


def test_bounds_of_any_size_have_their_share_of_slack() -> None:
    assert within(700 + 1e-4, (10, 700))
    assert within(-1e-7, (0, 5))
    assert not within(700.01, (10, 700))
    assert not within(-1e-3, (0, 5))
