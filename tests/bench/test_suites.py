"""The record of the long tests names tasks and suites that exist, and a changed task is told from one that is as it was."""

from __future__ import annotations

import importlib
import json
import shutil
from pathlib import Path

import pytest

from articad_bench.task import TASKS, tasks_in
from tests.bench import suites

MODULES = ("test_tasks", "test_invariance", "test_machined", "test_function_tasks", "test_large_tasks")


def test_what_is_recorded_exists() -> None:
    names = {task.name for _, task in tasks_in(TASKS)}
    functions = {name for module in MODULES for name in vars(importlib.import_module(f"tests.bench.{module}"))}

    assert set(suites.SUITES) <= functions
    assert {name.partition(":")[0] for name in suites.recorded()} <= {suite.partition(":")[0] for suite in suites.SUITES.values()}
    assert {name for row in suites.recorded().values() for name in row} <= names


def test_a_task_that_has_changed_since_has_to_pass_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(suites, "FILE", tmp_path / "suites.json")
    monkeypatch.setattr(suites, "TASKS", tmp_path)
    shutil.copytree(TASKS / "bracket_corner", tmp_path / "bracket_corner")
    found = suites.suite_of("test_one_wrong_module_is_refused", {"name": "bracket_corner", "answer": "beside"})
    assert found == ("nearest cheap answers: beside", "bracket_corner")

    suites.record(*found, suites.state(tmp_path / "bracket_corner"))

    assert suites.told().splitlines()[:2] == [
        "nearest cheap answers: beside: 1 of 1 tasks, 0 of 0 separating ones",
        "  changed since: none",
    ]
    file = tmp_path / "bracket_corner" / "task.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {"product": "angle"}))
    assert suites.told().splitlines()[1] == "  changed since: bracket_corner"
    assert suites.suite_of("test_that_is_of_no_suite", {"name": "bracket_corner"}) is None
    assert suites.suite_of("test_one_wrong_module_is_refused", {}) is None
