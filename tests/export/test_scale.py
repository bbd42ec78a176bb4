"""Exports and sweeps of long chains: the work grows as the number of parts, counted in calls, never in seconds."""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import combinations, pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.export.collisions import _names_of_joints
from articad.export.contacts import ContactSearch
from articad.export.freecad import write_freecad_alone
from articad.export.hulls import rigid_groups, same_group_pairs
from articad.export.names import Names
from articad.export.plan import _Names
from articad.formats import NAMED
from articad.interference.boxes import meeting_boxes
from articad.kinematics.joints import JointType
from tests.chains import chain
from tests.growth import MOST_A_PAIR, Watched, bytecodes_a_pair

FEW, MANY = 40, 160
MOST_PER_PART = 1.3  # calls per part of the long chain to those of the short one
WRITERS = {name: NAMED[name].writer for name in ("urdf", "mjcf", "sdf", "usd", "glb", "3mf", "plan")} | {"freecad": write_freecad_alone}
"""FreeCAD writes and opens documents of at most `MOST_OPENED` parts; larger ones are written without it."""


def calls_of(work: Callable[[], Any]) -> int:
    """Return how many functions, Python's and C's, a piece of work calls."""
    count = 0

    def seen(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event in {"call", "c_call"}

    sys.setprofile(seen)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


def resting(count: int) -> Assembly:
    assembly = chain(count)
    assembly.mechanism.rest_poses()
    return assembly


@pytest.mark.parametrize("name", WRITERS)
def test_an_export_calls_as_much_per_part_of_a_long_chain_as_of_a_short_one(name: str) -> None:
    write = WRITERS[name]
    write(resting(3))  # imports and caches
    few, many = (calls_of(lambda count=count: write(resting(count))) for count in (FEW, MANY))  # type: ignore[misc]
    assert many / MANY <= MOST_PER_PART * few / FEW


def test_names_are_sought_in_no_list_of_all_parts_when_freecad_is_not_there(monkeypatch: pytest.MonkeyPatch) -> None:
    claim = Names.claim
    monkeypatch.setattr(Names, "claim", lambda *given: Watched(claim(*given)))

    def writing(size: int) -> Callable[[], Any]:
        assembly = resting(size)
        return lambda: write_freecad_alone(assembly)

    assert bytecodes_a_pair(writing, 6) < MOST_A_PAIR


@pytest.mark.parametrize("name", WRITERS)
def test_an_export_is_as_large_per_part(name: str) -> None:
    few, many = (sum(map(len, WRITERS[name](chain(count)).files.values())) for count in (FEW, MANY))
    assert many / MANY <= MOST_PER_PART * few / FEW


def test_the_search_for_contacts_asks_in_proportion_to_the_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    look = ContactSearch._first_contact

    def counted(self: ContactSearch, a: str, b: str, near: Any) -> Any:
        asked.append(a)
        return look(self, a, b, near)

    monkeypatch.setattr(ContactSearch, "_first_contact", counted)
    counts = []
    for count in (FEW, MANY):
        asked.clear()
        NAMED["urdf"].writer(chain(count))
        counts.append(len(asked) / count)
    assert counts[1] <= MOST_PER_PART * max(counts[0], 0.1)


@pytest.mark.parametrize("seed", range(20))
def test_boxes_that_meet_are_those_that_a_comparison_of_all_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(0, 40))
    low = rng.integers(-5, 5, (count, 3)).astype(float) * rng.choice([0.1, 1.0, 10.0], 3)
    high = low + rng.integers(0, 4, (count, 3))
    expected = [(i, j) for i, j in combinations(range(count), 2) if ((low[i] <= high[j]) & (low[j] <= high[i])).all()]
    assert list(map(tuple, meeting_boxes(low, high).tolist())) == expected


@pytest.mark.soak
@pytest.mark.parametrize("name", [*WRITERS, "step"])
def test_two_thousand_parts_are_written(name: str) -> None:
    assert NAMED[name].writer(chain(2000)).files


@pytest.mark.parametrize("seed", range(40))
def test_rigid_groups_are_what_walks_over_fixed_joints_reach(seed: int) -> None:
    """Random trees and circles of joints, against a search from each part."""
    chance = np.random.default_rng(seed)
    order = tuple(f"part{number}" for number in range(int(chance.integers(1, 30))))
    kinds = (JointType.FIXED, JointType.REVOLUTE)
    chosen = [(*chance.choice(order, 2), kinds[int(chance.random() < 0.5)]) for _ in range(int(chance.integers(0, 40)))]
    joints: Any = tuple(SimpleNamespace(parent=parent, child=child, type=kind) for parent, child, kind in chosen)

    def reached(start: str) -> set[str]:
        found, left = {start}, [start]
        while left:
            here = left.pop()
            for joint in joints:
                ends = {joint.parent, joint.child}
                if joint.type is JointType.FIXED and here in ends:
                    left += sorted(ends - found)
                    found |= ends
        return found

    group = rigid_groups(joints, order)
    for part in order:
        assert {other for other in order if group[other] == group[part]} == reached(part)
    expected = {(a, b) for a, b in combinations(order, 2) if b in reached(a)}
    assert same_group_pairs(joints, order) == expected


def test_grouping_costs_as_much_per_part_of_a_long_chain() -> None:
    def joined(count: int) -> int:
        order = tuple(f"p{number}" for number in range(count))
        ends = list(pairwise(order))
        joints: Any = tuple(SimpleNamespace(parent=a, child=b, type=JointType.FIXED) for a, b in reversed(ends))
        lines = 0

        def counted(_frame: object, event: str, _argument: object) -> Any:
            nonlocal lines
            lines += event == "line"
            return counted

        sys.settrace(counted)
        try:
            rigid_groups(joints, order)
        finally:
            sys.settrace(None)
        return lines

    assert joined(800) / 800 <= MOST_PER_PART * joined(80) / 80


def test_names_of_a_plan_that_are_equal_are_numbered_in_turn() -> None:
    wanted = [f"Part {'!' * number}" for number in range(2000)]
    names = _Names(wanted)
    assert [names[name] for name in wanted] == ["part", *(f"part_{number}" for number in range(2, 2001))]


def test_names_of_joints_are_those_between_the_two_parts() -> None:
    assembly = chain(5)
    names = _names_of_joints(assembly)
    for a, b in combinations(assembly.parts, 2):
        expected = [joint.name for joint in assembly.mechanism.joints if {joint.parent, joint.child} == {a, b}]
        assert names[frozenset((a, b))] == expected
