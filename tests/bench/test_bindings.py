"""Bindings: which words of a prompt tell a product from its mirror image, and from itself turned over."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import pytest

from articad.connectors import SE3
from articad.geometry import box
from articad_bench.bindings import bindings, shows_hands
from articad_bench.check import Check
from articad_bench.outline_checks import Outlined
from articad_bench.reference import references
from articad_bench.subject import Subject
from articad_bench.task import TASKS, Task, tasks_in
from tests.bench.test_cheats import of, placed, task
from tests.kinematics.linkages import at, joint


def _outlines(checks: Sequence[Check]) -> list[Outlined]:
    return [check for check in checks if isinstance(check, Outlined)]


@pytest.mark.parametrize(
    ("prompt", "shown"),
    [
        ("A gate on pins at the left post.", True),
        ("The right-hand door opens first.", True),
        ("Its hands turn clockwise.", True),
        ("Choose it so that 0.02 to 0.09 mm are left sideways.", False),
        ("The pack has 0.05 to 0.50 mm left in every case.", False),
        ("Wheels may be left out, 100 mm being left out after each.", False),
    ],
)
def test_what_is_left_over_is_on_no_side(prompt: str, shown: bool) -> None:
    assert shows_hands(task(prompt=prompt)) is shown


def funnel(*, up: bool = True, wide: float = 60.0) -> Subject:
    """A wide bowl on a thin spout."""
    bodies = [("spout", placed(box(16, 16, 45), 0, 0, 22.5)), ("bowl", placed(box(wide, wide, 60), 0, 0, 75))]
    subject = of(*bodies, joints=[joint("held", "fixed", ("spout", at(0)), ("bowl", at(0)))])
    mechanism = subject.assembly.mechanism
    return subject if up else Subject(replace(subject.assembly, mechanism=mechanism.changed(T_ground=SE3.rot_x(math.pi))))


@pytest.mark.parametrize(
    ("prompt", "tried"), [("A funnel, its spout on the floor.", True), ("A funnel of steel.", False), ("A funnel along X.", False)]
)
def test_what_is_upside_down_is_refused_where_words_say_what_is_up(prompt: str, tried: bool) -> None:
    found = [check for check in bindings(task(prompt=prompt, checks=[]), funnel()) if check.kind == "upright"]

    assert bool(found) is tried
    for check in found:
        assert [check.judge(each).ok for each in (funnel(), funnel(wide=90), funnel(up=False))] == [True, True, False]


def test_what_faces_the_other_way_is_refused_where_words_say_which_way() -> None:
    def mug(side: float) -> Subject:
        bodies = [("cup", box(80, 80, 90)), ("handle", placed(box(30, 12, 60), 55 * side, 0, 0))]
        return of(*bodies, joints=[joint("held", "fixed", ("cup", at(0)), ("handle", at(0)))])

    (check,) = (check for check in bindings(task(prompt="A mug, its handle to +X.", checks=[]), mug(1)) if check.kind == "upright")

    assert [check.judge(mug(side)).ok for side in (1, 0.95, -1)] == [True, True, False]
    assert [each.kind for each in bindings(task(prompt="A mug with a handle.", checks=[]), mug(1))] == ["matter"]


EDITED: Final = [pytest.param(folder, task, id=task.name) for folder, task in tasks_in(TASKS) if task.edits and _outlines(task.checks)]


@pytest.mark.slow
@pytest.mark.soak  # builds 27 products before and after their edits
@pytest.mark.parametrize(("folder", "task"), EDITED)
def test_outlines_of_an_edited_product_leave_most_of_their_margin(folder: Path, task: Task) -> None:
    for checks, product in zip(task.stages, references(folder, task), strict=True):
        assert all(check.apart(Subject(product)) <= check.beside / 3 for check in _outlines(checks))
