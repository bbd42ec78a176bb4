"""The planted set: 66 joints over all types that surfaces make, each with one fault, in random poses; and the same joints without it.

What is planted: no pin, a short pin, one of two bores missing, a bore that is too wide, beside its pin or half open, a pin or a tongue that
leaves its guide in motion or keeps too little of it, a groove that is open, too wide or somewhere else, a ball that is held by less than
half, loose in its socket or without one, a plate that nothing holds down, a cross that is missing. What falls is planted in
`tests/support/test_planted.py`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from build123d import Box, Cylinder, Pos, Rot, Sphere

from articad.connectors import SE3
from tests.interference.mechanisms import joint
from tests.realisation.test_verdicts import BALL, HINGE_FAULTS, LYING, SLIDE, carriage, hinge, judged, socket

TURN: dict[str, Any] = {"lower": (-1.0,), "upper": (1.0,)}
BOTH: dict[str, Any] = {"lower": (-0.1, -1.0), "upper": (0.1, 1.0)}
PLANE: dict[str, Any] = {"lower": (-5.0, -5.0, -1.0), "upper": (5.0, 5.0, 1.0)}
SWING: dict[str, Any] = {"lower": (-0.3, -0.3), "upper": (0.3, 0.3)}
UNMADE = ("W_JOINT_NOT_MADE", "W_JOINT_PARTLY_MADE")
ACROSS = SE3.from_axes(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]))  # y of the joint is level, as z is


class Planted(NamedTuple):
    """A joint: its name, its type, its shapes in the joint's frame, its limits, the codes of which one must be found, and its frame."""

    name: str
    kind: str
    shapes: Any
    limits: dict[str, Any]
    codes: tuple[str, ...]
    frame: SE3 = LYING
    cross: bool = False


BLOCK, SHAFT = Box(30, 30, 40) - Cylinder(5.1, 60), Cylinder(5, 40)
TABLE = Box(60, 60, 10)
PLATE = Pos(0, 0, 10.1) * Box(30, 30, 10)
COVER = Pos(0, 0, 20.2) * Box(60, 60, 10)
YOKE = Pos(0, 0, -14) * Box(44, 12, 6) + Pos(-19, 0, -2) * Box(6, 12, 24) + Pos(19, 0, -2) * Box(6, 12, 24)
FORK_A = YOKE - Rot(Y=90) * Cylinder(3.1, 60)
FORK_B = Rot(X=180) * (Rot(Z=90) * FORK_A)
CROSS = Rot(Y=90) * Cylinder(3, 44) + Rot(X=90) * Cylinder(3, 44) + Box(31.6, 31.6, 12)  # its hub lies between the arms of both forks


def _carried(kind: str, limits: dict[str, Any]) -> list[Planted]:
    return [Planted(f"{kind}: {fault}", kind, shapes, limits, UNMADE) for fault, shapes in HINGE_FAULTS.items()]


FAULTS = [
    *_carried("revolute", TURN),
    *_carried("cylindrical", BOTH),
    Planted("cylindrical: leaves its bore", "cylindrical", {"a": BLOCK, "b": SHAFT}, {"lower": (0.0, -1.0), "upper": (41.0, 1.0)}, ("W_JOINT_LEAVES",)),
    Planted("cylindrical: keeps too little", "cylindrical", {"a": BLOCK, "b": SHAFT}, {"lower": (0.0, -1.0), "upper": (34.0, 1.0)}, ("W_JOINT_SHORT",)),
    Planted("screw: no spindle", "screw", {"a": BLOCK, "b": Pos(0, 0, 40) * Box(20, 20, 4)}, TURN | {"lead": 2.0}, UNMADE),
    Planted("screw: thread too wide", "screw", {"a": Box(30, 30, 40) - Cylinder(9, 60), "b": SHAFT}, TURN | {"lead": 2.0}, UNMADE),
    Planted("screw: nut beside its spindle", "screw", {"a": Pos(14, 0, 0) * BLOCK, "b": SHAFT}, TURN | {"lead": 2.0}, UNMADE),
    Planted("screw: half a nut", "screw", {"a": BLOCK - Pos(0, -15, 0) * Box(40, 30, 60), "b": SHAFT}, TURN | {"lead": 2.0}, UNMADE),
    Planted("slider: groove open", "slider", carriage(undercut=False), SLIDE, UNMADE, ACROSS),
    Planted("slider: groove too wide", "slider", carriage(gap=4.0), SLIDE, UNMADE),
    Planted("slider: groove somewhere else", "slider", {"a": Pos(60, 0, 0) * carriage()["a"], "b": carriage()["b"]}, SLIDE, UNMADE),
    Planted("slider: drawer that floats", "slider", {"a": Box(60, 4, 60), "b": Pos(0, 20, 0) * Box(30, 20, 40)}, SLIDE, UNMADE),
    Planted("slider: leaves its groove", "slider", carriage(), {"lower": (0.0,), "upper": (46.0,)}, ("W_JOINT_LEAVES",)),
    Planted("slider: keeps a sixth of its groove", "slider", carriage(), {"lower": (0.0,), "upper": (40.0,)}, ("W_JOINT_SHORT",)),
    Planted("ball: held by less than half", "ball", {"a": socket(-1.0), "b": BALL}, {"cone": 0.5}, UNMADE),
    Planted("ball: loose in its socket", "ball", {"a": Box(60, 60, 60) - Sphere(14) - Pos(0, 0, 34) * Box(80, 80, 60), "b": BALL}, {"cone": 0.5}, UNMADE),
    Planted("ball: no ball", "ball", {"a": socket(4.0), "b": Pos(0, 0, 30) * Cylinder(3, 20)}, {"cone": 0.5}, UNMADE),
    Planted("ball: no socket", "ball", {"a": Pos(0, 0, -20) * Box(40, 40, 10), "b": BALL}, {"cone": 0.5}, UNMADE),
    Planted("planar: nothing holds the plate down", "planar", {"a": TABLE, "b": PLATE}, PLANE, UNMADE),
    Planted("planar: plates apart", "planar", {"a": TABLE, "b": Pos(0, 0, 30) * PLATE}, PLANE, UNMADE),
    Planted("planar: a rod on a table", "planar", {"a": TABLE, "b": Pos(0, 0, 10.1) * (Rot(Y=90) * Cylinder(5, 30))}, PLANE, UNMADE),
    Planted("universal: no cross", "universal", {"a": FORK_A, "b": FORK_B}, SWING, UNMADE),
    Planted("universal: cross too thin", "universal", {"a": FORK_A, "b": FORK_B, "c": Rot(Y=90) * Cylinder(1.5, 44) + Rot(X=90) * Cylinder(1.5, 44) + Sphere(6)}, SWING, UNMADE, cross=True),
]  # fmt: skip

GOOD = [
    Planted("revolute", "revolute", hinge(), TURN, ()),
    Planted("cylindrical", "cylindrical", hinge(), BOTH, ()),
    Planted("screw", "screw", {"a": BLOCK, "b": SHAFT}, TURN | {"lead": 2.0}, ()),
    Planted("slider", "slider", carriage(), SLIDE, ()),
    Planted("ball", "ball", {"a": socket(4.0), "b": BALL}, {"cone": 0.5}, ()),
    Planted("planar", "planar", {"a": TABLE + Pos(0, 32, 10.1) * Box(60, 4, 30) + COVER, "b": PLATE}, PLANE, ()),
    Planted("universal", "universal", {"a": FORK_A, "b": FORK_B, "c": CROSS}, SWING, (), cross=True),
]


def codes_of(case: Planted, seed: int) -> list[str]:
    others = (joint("spin", "revolute", "a", "c"),) if case.cross else ()
    _, report = judged(case.shapes, case.kind, seed=seed, others=others, frame=case.frame, **case.limits)
    return [finding.code for finding in report.findings if finding.where == "joints.j"]


def test_the_set_has_sixty_joints_of_seven_types() -> None:
    assert 2 * len(FAULTS) >= 60
    assert {case.kind for case in FAULTS} == {case.kind for case in GOOD}
    assert len({case.name for case in FAULTS}) == len(FAULTS)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("case", FAULTS, ids=lambda case: case.name)
def test_no_planted_fault_is_missed(case: Planted, seed: int) -> None:
    found = codes_of(case, seed)
    assert set(found) & set(case.codes), found


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("case", GOOD, ids=lambda case: case.name)
def test_nothing_is_found_where_nothing_is_planted(case: Planted, seed: int) -> None:
    assert codes_of(case, seed) == []
