"""Which tasks have passed which of the long tests: `suites.json` beside this file.

    ARTICAD_SUITES_WRITE=1 python -m pytest -m soak tests/bench/test_tasks.py -k "red and photo_"     # adds those that pass
    python -m tests.bench.suites                                                                     # says what is missing

A row holds the digest of the task's folder at that time: a task that has changed since has to pass again. Checks that have changed do not show.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from articad_bench.task import TASKS, tasks_in

FILE: Final = Path(__file__).with_name("suites.json")
SUITES: Final = {
    "test_a_reference_passes_its_own_checks_and_each_is_shown_red": "each check is shown red",
    "test_a_reference_makes_the_edits_and_who_leaves_all_as_it_was_does_not": "each check of an edit is shown red",
    "test_a_reference_passes_whatever_its_parts_are_drawn_in_named_or_joined_from": "invariance",
    "test_a_reference_passes_turned_where_no_level_direction_is_asked_for": "invariance: turned",
    "test_a_reference_passes_as_a_file_of_another_tool_but_for_what_the_format_cannot_state": "invariance",
    "test_what_is_nearly_drawn_does_not_pass": "nearest cheap answers",
    "test_the_nearest_cheap_answer_fails_where_it_is_cheap": "nearest cheap answers",
    "test_one_wrong_module_is_refused": "nearest cheap answers",
}
"""Suites by the function of a test; its other parameters are added to the name."""


def state(folder: Path) -> str:
    """Return the digest of what a task states and of its reference."""
    found = hashlib.sha256()
    for file in sorted(path for path in folder.rglob("*") if path.suffix in {".json", ".py"}):
        found.update(file.relative_to(folder).as_posix().encode() + file.read_bytes())
    return found.hexdigest()[:12]


def suite_of(function: str, parameters: Mapping[str, Any]) -> tuple[str, str] | None:
    """Return suite and task of a test; None if it belongs to none."""
    if function not in SUITES or "name" not in parameters:
        return None
    others = [str(value) for key, value in sorted(parameters.items()) if key != "name"]
    return ": ".join([SUITES[function], *others]), str(parameters["name"])


def recorded() -> dict[str, dict[str, str]]:
    """Return the digests of tasks by suite."""
    found: dict[str, dict[str, str]] = json.loads(FILE.read_text(encoding="utf-8")) if FILE.is_file() else {}
    return found


def record(suite: str, task: str, digest: str) -> None:
    """Add a task that has passed, with the digest of its folder when it was read."""
    rows = recorded()
    rows.setdefault(suite, {})[task] = digest
    text = json.dumps({name: dict(sorted(row.items())) for name, row in sorted(rows.items())}, indent=1)
    FILE.write_text(text + "\n", encoding="utf-8")


def told() -> str:
    """Return how many tasks each suite has passed as they are now, and which of the kind `separating` it has not."""
    now = {task.name: state(folder) for folder, task in tasks_in(TASKS)}
    separating = {task.name for _, task in tasks_in(TASKS, kind="separating")}
    lines = []
    for suite, row in recorded().items():
        passed = {name for name, digest in row.items() if now.get(name) == digest}
        lines.append(f"{suite}: {len(passed)} of {len(now)} tasks, {len(passed & separating)} of {len(separating)} separating ones")
        lines.append(f"  changed since: {', '.join(sorted(set(row) - passed)) or 'none'}")
        lines.append(f"  separating, not recorded: {', '.join(sorted(separating - set(row))) or 'none'}")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.stdout.write(told() + "\n")
