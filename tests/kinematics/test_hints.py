"""Hints about loops, followed literally: the linkage is made as the hint says and nothing else; its finding is gone, and no error has come."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import pytest

from articad.connectors import SE3
from articad.errors import KinematicsError
from articad.findings import Findings
from articad.kinematics import Mechanism
from articad.kinematics.configuration import Configuration
from tests.kinematics.linkages import at, four_bar, from_rest, impossible, joint, misaligned, parallelogram, scissor
from tests.kinematics.overconstrained import parallel_rods, slack_bars
from tests.kinematics.test_inexact import reframed, with_digits
from tests.obedience import assert_heals

Match = re.Match[str]
Change = Callable[[Mechanism, Match], Mechanism]


class Case(NamedTuple):
    """A linkage with a fault, the words of the hint, and the linkage as a reader of them makes it."""

    code: str
    fault: Mechanism
    words: str
    change: Change


def rejoined(mechanism: Mechanism, name: str, **changes: object) -> Mechanism:
    joints = [replace(one, **changes) if one.name == name else one for one in mechanism.joints]  # type: ignore[arg-type]
    return Mechanism(mechanism.parts, mechanism.ground, joints)


def longer_coupler(mechanism: Mechanism, _match: Match) -> Mechanism:
    """Lengthen the coupler by the gap that the message states, and 20 mm more."""
    (gap,) = re.findall(r"best gap ([\d.]+) mm", mechanism.findings()[0].message)
    return rejoined(mechanism, "pin_c", T_parent_connector=at(30 + float(gap) + 20))


def nearer_pivot(mechanism: Mechanism, _match: Match) -> Mechanism:
    (gap,) = re.findall(r"best gap ([\d.]+) mm", mechanism.findings()[0].message)
    return rejoined(mechanism, "rocker", T_parent_connector=at(200 - float(gap) - 20))


def axis_turned(mechanism: Mechanism, match: Match) -> Mechanism:
    """Turn the tilted axis back by the stated angle."""
    (pin,) = [one for one in mechanism.joints if one.name == "pin_c"]
    return rejoined(mechanism, "pin_c", T_parent_connector=pin.T_parent_connector @ SE3.rot_x(-math.radians(float(match[1]))))


def released(name: str) -> Change:
    """Let a ball take the place of a hinge, on the same axis."""

    def change(mechanism: Mechanism, _match: Match) -> Mechanism:
        (old,) = [one for one in mechanism.joints if one.name == name]
        ends = (old.parent, old.T_parent_connector @ SE3.rot_z(old.rest[0])), (old.child, old.T_child_connector)
        return Mechanism(mechanism.parts, mechanism.ground, [joint(name, "ball", *ends) if one is old else one for one in mechanism.joints])

    return change


def parallel(_mechanism: Mechanism, _match: Match) -> Mechanism:
    return misaligned(0.0)


def door(off: float, *, high: bool = True) -> Mechanism:
    """A door on two hinges whose axes are apart."""
    hinges = [from_rest("low", "revolute", "frame", "door", at(0), driver=True)]
    hinges += [from_rest("high", "revolute", "frame", "door", at(0, off, 50))] if high else []
    return Mechanism(("frame", "door"), "frame", hinges)


def triangle(*, fourth: bool = False, opened: bool = False) -> Mechanism:
    """Three bars with parallel axes cannot move; four can."""
    corners = [(0.0, 0.0), (60.0, 0.0), (50.0, 45.0), *([(10.0, 40.0)] if fourth else [])]
    names = [f"bar_{i}" for i in range(len(corners))]
    ends = [*names, names[0]]
    joints = [from_rest(f"pin_{i}", "revolute", ends[i], ends[i + 1], at(*corner), driver=i == 0) for i, corner in enumerate(corners)]
    return Mechanism(tuple(names), names[0], joints[: len(joints) - opened])


FOUR = four_bar()
LOCKED = "Its axes are parallel: change a length, add a link"

CASES = [
    Case("E_LOOP_OPEN", impossible(), "Lengthen a link", longer_coupler),
    Case("E_LOOP_OPEN", impossible(), "or move a pivot", nearer_pivot),
    Case("E_LOOP_OPEN", four_bar(tilt=math.radians(1.2)), r"Turn one of the two axes by ([\d.]+)°", axis_turned),
    Case("E_LOOP_OPEN", four_bar(tilt=math.radians(1.2)), "or release a joint of the loop", released("pin_c")),
    Case("E_LOOP_LOCKED", misaligned(math.radians(0.01)), "Make the hinge axes parallel", parallel),
    Case("E_LOOP_LOCKED", misaligned(math.radians(0.01)), "or release a joint of the loop", released("pin_c")),
    Case("E_LOOP_LOCKED", door(0.1), r"Move \w+\.high_on_\w+", lambda _mechanism, _match: door(0.0)),
    Case("E_LOOP_LOCKED", door(0.1), "or release a joint of the loop", lambda _mechanism, _match: door(0.1, high=False)),
    Case("E_LOOP_LOCKED", triangle(), "Its axes are parallel: .*or release a joint of the loop", lambda _mechanism, _match: triangle(opened=True)),
    Case("E_LOOP_LOCKED", slack_bars(0.0), LOCKED, lambda _mechanism, _match: slack_bars(10.0)),
    Case("E_LOOP_LOCKED", triangle(), LOCKED, lambda _mechanism, _match: triangle(fourth=True)),
    Case("W_LOOP_INEXACT", with_digits(reframed(FOUR, 7), 4, 16), "Give connectors with more digits", lambda _mechanism, _match: with_digits(reframed(FOUR, 7), 16, 16)),
    Case("W_SHAKY", slack_bars(0.0), "Change a length, so that the linkage moves", lambda _mechanism, _match: slack_bars(10.0)),
    Case("W_NEAR_SINGULAR", parallel_rods(4), "Use fewer links", lambda _mechanism, _match: parallel_rods(3)),
    Case("W_NEAR_SINGULAR", four_bar(30, 80, 50, 100, crank=math.pi), "Choose a rest pose in which the links are not in line", lambda _mechanism, _match: four_bar(30, 80, 50, 100, crank=2.0)),
    Case("W_NEAR_SINGULAR", four_bar(30, 80, 50.0001, 100, crank=math.pi), "Check for .* a dead point nearby", lambda _mechanism, _match: four_bar(30, 80, 50.0001, 100, crank=2.0)),
    Case("W_NEAR_SINGULAR", misaligned(math.radians(0.01)), "Check for a misaligned axis", parallel),
]  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.code}-{case.words[:40]}")
def test_a_linkage_made_as_the_hint_says_has_the_finding_no_more(case: Case) -> None:
    before = case.fault.findings()
    finding = next(one for one in before.of(case.code) if re.search(case.words, one.hint))
    match = re.search(case.words, finding.hint)
    assert match
    assert_heals(finding, before, case.change(case.fault, match).findings())


def test_no_two_findings_of_a_linkage_whose_axes_are_parallel_contradict_each_other() -> None:
    """Bars in line are rigid because of a length, so no hint asks for axes that are parallel already."""
    assert not [finding for finding in slack_bars(0.0).findings() if "hinge axes parallel" in finding.hint]


# ---------------------------------------------------------------------- questions that a caller asks

QUESTIONS = {"E_SINGULAR", "E_REACH_BARRED", "E_NO_PATH"}


def said(ask: Callable[[], object]) -> Findings:
    try:
        answer = ask()
    except KinematicsError as error:
        return error.findings
    return Findings(getattr(answer, "findings", ()))


def test_limits_that_keep_away_from_a_singular_configuration_are_reached() -> None:
    before = scissor(2).feasible_range("lift").findings
    finding = before.of("E_SINGULAR")[0]
    match = re.search(r"Set its limits to \[([\d.e-]+), ([\d.e-]+)\] deg", finding.hint)
    assert match
    low, high = (math.radians(float(bound)) for bound in match.groups())
    (lift,) = [one for one in scissor(2).joints if one.name == "lift"]
    limits = replace(lift.limits, lower=(low,), upper=(high,))
    assert_heals(finding, before, rejoined(scissor(2), "lift", limits=limits).feasible_range("lift").findings)


def test_a_driver_that_keeps_away_from_a_singular_value_is_followed() -> None:
    before = said(lambda: parallelogram(1.0).poses([[-0.5]]))
    finding = before.of("E_SINGULAR")[0]
    assert "Keep the driver away from there" in finding.hint
    assert_heals(finding, before, said(lambda: parallelogram(1.0).poses([[0.3]])))


def gantry() -> Mechanism:
    """Two slides at right angles: the drivers are the place of the last part."""
    across = SE3.from_axes((0, 0, 0), (1, 0, 0)), SE3.from_axes((0, 0, 0), (0, 1, 0))
    span = [(0.0, 100.0)]
    joints = [
        joint("x", "slider", ("frame", across[0]), ("bridge", across[0]), limits=span),
        joint("y", "slider", ("bridge", across[1]), ("tool", across[1]), limits=span),
    ]
    return Mechanism(("frame", "bridge", "tool"), "frame", joints)


def through_a_slit(configuration: Configuration) -> bool:
    """A wall from x = 20 to 80 with a slit of 0.02 mm at y = 50."""
    x, y = configuration["x"].item(), configuration["y"].item()
    return bool(abs(x - 50.0) > 30.0 or abs(y - 50.0) < 0.01)


def test_a_path_with_waypoints_is_found_through_a_slit() -> None:
    def path(*waypoints: tuple[float, float]) -> Findings:
        return said(lambda: [gantry().path(a, b, accept=through_a_slit) for a, b in pairwise(waypoints)])

    start, goal = (10.0, 10.0), (90.0, 10.0)
    before = path(start, goal)
    finding = before.of("E_NO_PATH")[0]
    assert "Provide waypoints" in finding.hint
    assert_heals(finding, before, path(start, (10.0, 50.0), (90.0, 50.0), goal))


@pytest.mark.parametrize("way", ["Move the target", "or the obstacle"])
def test_a_target_or_an_obstacle_that_is_moved_is_out_of_each_others_way(way: str) -> None:
    """A wall between x = 40 and 60: the target is behind it, or it is taken away."""

    def reach(x: float, *, wall: bool = True) -> Findings:
        free = (lambda q: not 40.0 < q[0] < 60.0) if wall else None
        return said(lambda: gantry().reach("tool", (x, 30.0, 0.0), starts=4, accept=free))

    before = reach(50.0)
    (finding,) = before.of("E_REACH_BARRED")
    assert way in finding.hint
    assert_heals(finding, before, reach(30.0) if way == "Move the target" else reach(50.0, wall=False))
