"""The project's own tasks: each reference passes, each check is shown red, and no product or joint graph is asked for too often."""

from __future__ import annotations

from collections import Counter
from functools import cache

import pytest

from articad.assembly import Assembly
from articad.bench.checks import Joints
from articad.bench.reference import edited_reference, reference
from articad.bench.subject import Subject
from articad.bench.task import TASKS, Task, tasks_in
from tests.bench.wrong import wrong_for

ALL = {task.name: (folder, task) for folder, task in tasks_in(TASKS)}
IN_CI = ("wardrobe_double", "lamp_two_arms", "engine_single", "clamp_vertical", "bracket_corner", "hinge_butt_pin")
SOAK = tuple(name for name in ALL if name not in IN_CI)


@cache
def built(name: str) -> Assembly:
    return reference(*ALL[name])


@pytest.mark.slow
@pytest.mark.parametrize("name", [*IN_CI, *(pytest.param(name, marks=pytest.mark.soak) for name in SOAK)])
def test_a_reference_passes_its_own_checks_and_each_is_shown_red(name: str) -> None:
    assembly, (_, task) = built(name), ALL[name]

    wrong = [judgement for judgement in task.judge(Subject(assembly)) if not judgement.ok]
    assert not wrong
    for check in task.checks:
        judgement = check.judge(wrong_for(check, assembly))
        assert not judgement.ok, judgement


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.soak) for name, (_, task) in ALL.items() if task.edit is not None])
def test_a_reference_makes_the_edit_and_who_leaves_all_as_it_was_does_not(name: str) -> None:
    before, (folder, task) = built(name), ALL[name]
    after = edited_reference(folder, task, before)

    wrong = [judgement for judgement in task.judge_edit(Subject(after, before=before)) if not judgement.ok]
    assert not wrong
    assert not all(judgement.ok for judgement in task.judge_edit(Subject(before, before=before)))
    assert any(check.kind == "unchanged" for check in task.edit_checks)
    for check in task.edit.checks if task.edit is not None else ():
        judgement = check.judge(wrong_for(check, after))
        assert not judgement.ok, judgement


def test_no_product_is_asked_for_more_than_three_times() -> None:
    assert max(Counter(task.product for _, task in ALL.values()).values()) <= 3


def test_prompts_are_written_and_not_templated() -> None:
    openings = Counter(" ".join(task.prompt.split()[:6]) for _, task in ALL.values() if task.prompt)
    assert max(openings.values()) == 1


def test_every_task_states_what_it_checks() -> None:
    for _, task in ALL.values():
        assert _stated(task), task.name


def _stated(task: Task) -> bool:
    """A number that a check holds a joint's range to stands in the prompt, unless pictures show it."""
    if task.images:
        return True
    spans = [check.joint.span for check in task.checks if isinstance(check, Joints)]
    ranges = [span for span in spans if span is not None and span != "endless"]
    numbers = [float(word.strip(".,;:")) for word in task.prompt.replace("-", " ").split() if word.strip(".,;:").isdigit()]
    return all(any(low <= number <= high or low <= 2 * number <= high for number in numbers) or high > 720 for low, high in ranges)
