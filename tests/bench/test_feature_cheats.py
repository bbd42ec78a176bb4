"""Products without one feature of the reference are refused, where the task does not leave it open."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad_bench.cheat_run import _judged
from articad_bench.feature_cheats import feature_cheats, features
from articad_bench.reference import reference, reference_plan, reference_scripts
from articad_bench.task import TASKS, Task, tasks_in

TASK = "flange_four_holes"
SOURCE = """\
def build(part):
    shape = Cylinder(20, 5) - Pos(0, 0, 1) * Cylinder(4, 9)
    shape += [Box(2, 2, 9), Box(3, 3, 9)]
    width = part.dimensions["width"] - 3
    shape -= hole
    return shape, {}
"""


def test_each_cut_and_each_body_is_left_out_once_and_no_number_is() -> None:
    found = {name: without() for name, without in features(SOURCE).items()}

    assert list(found) == ["cut 1", "cut 2", "body 1"]
    assert "shape = Cylinder(20, 5)\n" in found["cut 1"]
    assert "hole" not in found["cut 2"]
    assert "Box" not in found["body 1"]
    assert all("- 3" in text for text in found.values())


def flange(**changes: object) -> tuple[Path, Task]:
    ((folder, task),) = tasks_in(TASKS, names=[TASK])
    return folder, task.model_copy(update=changes)


@pytest.mark.slow
def test_a_product_without_a_feature_is_refused_and_passes_where_nothing_asks_for_it() -> None:
    folder, task = flange()
    _, nothing = flange(checks=tuple(check for check in task.checks if check.kind in {"parts", "solids"}))
    cheats = list(feature_cheats(folder, task, reference(folder, task), None))
    rows = [[_judged(each, cheat, "") for cheat in cheats] for each in (task, nothing)]

    assert [row.what for row in rows[0] if row is not None] == ["flange: cut 1", "flange: cut 2", "flange: body 1"]
    assert [[row.passed for row in each if row is not None] for each in rows] == [[False] * 3, [True] * 3]


def test_what_is_left_open_is_not_tried() -> None:
    folder, task = flange(left_open={"flange: cut 1": "It may be solid."})
    assert {cheat.what for cheat in feature_cheats(folder, task, reference(folder, task), None)} == {"flange: cut 2", "flange: body 1"}


def test_what_tasks_leave_open_exists_in_their_references() -> None:
    for folder, task in tasks_in(TASKS):
        if task.left_open:
            scripts = reference_scripts(folder, task)
            known = {f"{part}: {feature}" for part, source in scripts.items() for feature in features(source)} | set(scripts)
            known |= {f"{part} along {axis}" for part in scripts for axis in "xyz"}
            known |= {f"joint {joint.name}" for joint in reference_plan(folder, task).joints}
            assert set(task.left_open) <= known, task.name
            assert all(reason.strip() for reason in task.left_open.values())
