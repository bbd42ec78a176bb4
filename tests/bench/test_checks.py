"""Every kind of check holds of a sound assembly, and refuses one that is wrong in its own way."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest
from pydantic import TypeAdapter

from articad import examples
from articad.assembly import Assembly
from articad.geometry import Part, box
from articad.plan.schema import AssemblyPlan
from articad_bench.checks import AnyCheck, Check
from articad_bench.reference import reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in
from tests.bench.wrong import VARIANTS, wrong_for

pytestmark = pytest.mark.slow

HINGE: dict[str, Any] = {"type": "revolute", "axis": [0, 0, 1]}


def bound(name: str, kind: str) -> dict[str, Any]:
    """Return the check of a kind that binds a task to its reference."""
    ((_, task),) = tasks_in(TASKS, names=[name])
    (row,) = (check.model_dump() for check in task.checks if check.kind == kind)
    return row


CHECKS: list[tuple[str, dict[str, Any]]] = [
    ("wardrobe", {"kind": "parts", "number": [18, 18]}),
    ("desk_lamp", {"kind": "freedoms", "number": 7}),
    ("wardrobe", {"kind": "joints", "joint": HINGE, "number": [2, 2]}),
    ("wardrobe", {"kind": "joints", "joint": {"type": "slider"}, "number": [2, 2]}),
    ("wardrobe", {"kind": "size", "mm": [900, None, 1922]}),
    ("wardrobe", {"kind": "part_size", "mm": [None, None, 1800]}),
    ("wardrobe", {"kind": "mass", "kg": [50, 80]}),
    ("wardrobe", {"kind": "solids"}),
    ("wardrobe", {"kind": "clear_at_rest"}),
    ("wardrobe", {"kind": "joined"}),
    ("wardrobe", {"kind": "clear_in_motion", "steps": 8}),
    ("slider_crank", {"kind": "certified", "seconds": 60}),
    ("four_bar", {"kind": "loops", "number": [1, 1]}),
    ("geared_four_bar", {"kind": "ratio", "driver": {"type": "revolute"}, "follower": {"type": "revolute"}, "ratio": 2}),
    ("scissor_lift", {"kind": "rise", "axis": "z", "mm": [50, 1000]}),
    ("slider_crank", {"kind": "gap", "joint": {"type": "revolute"}, "mm": [0.05, 0.5]}),
    ("wardrobe", {"kind": "captive", "number": [1, 18]}),
    ("slider_crank", {"kind": "made"}),
    ("slider_crank", {"kind": "moves", "joint": {"type": "slider"}, "volume": [0.01, 0.2], "size": [0.1, 0.4]}),
    ("toggle_clamp", {"kind": "simulates"}),
    ("four_bar", {"kind": "unchanged", "number": [8, 8]}),
    ("toggle_clamp", {"kind": "holes", "diameter": 6.6, "number": [4, 4], "axis": [0, 0, 1], "through": True, "length": [6.9, 7.1]}),
    ("toggle_clamp", {"kind": "studs", "diameter": 12, "number": [1, 1]}),
    ("desk_lamp", {"kind": "wall", "mm": [1.8, 2.2], "number": [1, 1]}),
    ("wardrobe", {"kind": "volume", "cm3": [50000, 150000]}),
    ("mug_straight", {"kind": "holds", "ml": [320, 340]}),
    ("wardrobe", {"kind": "stands", "degrees": 10}),
    ("wardrobe", {"kind": "symmetric", "axis": "x"}),
    ("toggle_clamp", {"kind": "lead", "mm": 1.25}),
    ("slider_crank", {"kind": "travel", "joint": {"type": "slider"}, "by": [59.9, 60.1]}),
    ("peaucellier_board", {"kind": "straight", "mm": [90, 125], "off": 0.05}),
    ("wiper_tandem", {"kind": "level", "mm": [56, 68], "number": [1, 999]}),
    ("planetary_hoist", {"kind": "turns", "ratio": 4.5, "number": [1, 3]}),
    *(("hinge_pintle_gate", bound("hinge_pintle_gate", kind)) for kind in ("matter", "arranged", "handed")),
    ("desk_lamp", {"kind": "extent", "side": "z", "mm": [300, 420]}),
    ("toggle_clamp", {"kind": "threads"}),
]


@cache
def product(name: str) -> Assembly:
    """Return an example, or the reference of a task."""
    if name in examples.names():
        return Assembly.from_plan(AssemblyPlan.load(examples.folder(name)), examples.folder(name) / "parts")
    ((folder, task),) = tasks_in(TASKS, names=[name])
    return reference(folder, task)


def form(row: dict[str, Any]) -> Check:
    check: Check = TypeAdapter(AnyCheck).validate_python(row)
    return check


@pytest.mark.parametrize(("name", "row"), CHECKS, ids=[f"{row['kind']}-{name}" for name, row in CHECKS])
def test_a_check_holds_of_a_sound_assembly_and_refuses_a_wrong_one(name: str, row: dict[str, Any]) -> None:
    check, assembly = form(row), product(name)

    sound = check.judge(Subject(assembly, before=assembly))
    wrong = check.judge(wrong_for(check, assembly))

    assert sound.ok, sound
    assert not wrong.ok, wrong


def test_every_kind_of_check_is_shown_red() -> None:
    assert {row["kind"] for _, row in CHECKS} == set(VARIANTS)


@pytest.mark.parametrize(
    ("wanted", "fits"), [((10.1, 10.2, None), True), ((10.2, None, 10.1), True), ((None, 30, 30), False), ((30, 9.95, 10.15), True)]
)
def test_sides_that_are_nearly_alike_are_each_compared_with_their_own(wanted: tuple[float | None, ...], fits: bool) -> None:
    part = Part.from_mesh("block", box(9.95, 10.15, 30))
    check = form({"kind": "part_size", "mm": list(wanted)})

    assert check.judge(Subject(Assembly.from_parts("one", parts=[part], joints=[], ground="block"))).ok is fits
