"""The page plays the steps of an assembly: what comes later is hidden, what is new moves along its path into its place."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pytest

from articad.disassembly.opened import step_poses
from articad.report import Documents, report_page
from tests.disassembly.test_opened import CASES
from tests.papers.test_manual import boxed
from tests.report.conftest import Opened
from tests.report.test_page import assert_silent

HIDDEN = "articad.view.groups.filter(g => !g.visible).map(g => g.name)"
AT = "name => articad.view.groups.find(g => g.name === name).matrix.elements.slice(12, 15)"


def until(reached: Callable[[], bool]) -> None:
    """Wait for what the page does by itself."""
    end = time.monotonic() + 60.0
    while not reached():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_a_step_moves_what_is_new_into_its_place_and_hides_what_comes_later(open_page: Callable[..., Opened]) -> None:
    order = boxed().assembly_order()
    opened = open_page(report_page(boxed(), Documents(order=order.to_json())))
    number, step = next(
        (at, step) for at, step in enumerate(order.steps) if step.parts == ("thing",) or ("thing" in step.parts and step.moves)
    )
    later = {name for name in boxed().parts if name not in (*step.parts, *step.onto)}
    rest = np.array(opened(f"({AT})('thing')"))
    opened.page.emulate_media(reduced_motion="reduce")  # nothing moves by itself: the step is shown as on paper
    opened.page.click(f'[data-step="{number}"]')
    begins = np.array(opened(f"({AT})('thing')"))
    assert set(opened(HIDDEN)) == later
    way = rest - begins  # along the path, towards the place
    assert way / np.linalg.norm(way) == pytest.approx(step.moves[0].direction, abs=1e-6)
    opened.page.emulate_media(reduced_motion="no-preference")
    opened.page.click(f'[data-step="{number}"]')
    until(lambda: np.allclose(opened(f"({AT})('thing')"), rest, atol=1e-6))
    assert set(opened(HIDDEN)) == later
    opened.page.click("#unfocus")
    assert opened(HIDDEN) == []
    assert_silent(opened)


def test_all_steps_are_played_after_each_other(open_page: Callable[..., Opened]) -> None:
    order = boxed().assembly_order()
    opened = open_page(report_page(boxed(), Documents(order=order.to_json())))
    opened.page.click("#all-steps")
    last = len(order.steps)
    until(lambda: opened("document.getElementById('status').textContent").startswith(f"Step {last}"))
    opened.page.click("#reset")
    assert opened(HIDDEN) == []


def test_a_step_of_an_opened_loop_is_played_where_it_is_proven(open_page: Callable[..., Opened]) -> None:
    """What is left of the linkage is turned over there, beyond the range of the whole; the page is looked at afterwards as before."""
    assembly = CASES["bell crank"][0]().assembly()
    order = assembly.assembly_order()
    (step,) = [step for step in order.steps if step.opened]
    opened = open_page(report_page(assembly, Documents(order=order.to_json())))
    opened.page.emulate_media(reduced_motion="reduce")

    opened.page.click(f'[data-step="{step.number - 1}"]')
    proven = step_poses(assembly.mechanism, step, order.base)
    shown = dict(zip(assembly.mechanism.parts, opened("articad.view.poses"), strict=True))
    for name in (*step.parts, *step.onto):
        assert np.allclose(np.array(shown[name]).reshape(3, 4), proven[name].matrix[:3], atol=1e-9), name
    rest = assembly.at()
    assert not np.allclose(proven["crank"].matrix, rest["crank"].matrix, atol=0.1)

    opened.page.click("#unfocus")
    shown = dict(zip(assembly.mechanism.parts, opened("articad.view.poses"), strict=True))
    assert all(np.allclose(np.array(shown[name]).reshape(3, 4), rest[name].matrix[:3], atol=1e-6) for name in rest)
    assert_silent(opened)
