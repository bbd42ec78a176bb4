"""Write the checks that bind tasks to bodies, derived from their references, into `task.json`; see `articad_bench.bindings`.

    python scripts/bind_tasks.py press_toggle delta_robot
    python scripts/bind_tasks.py          # all

A task whose checks are bound already gets them anew. Where they do not hold of the edited product, the edit restates those of that kind.
No task is written whose references do not pass all these checks.
"""

import json
import sys
from collections.abc import Sequence
from typing import Any

from articad.kernels.kernel import BuildCache
from articad_bench.bindings import BOUND, bindings
from articad_bench.checks import AnyCheck
from articad_bench.reference import edited_reference, reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in

KINDS = {check.model_fields["kind"].default for check in BOUND}


def rows(checks: Sequence[AnyCheck]) -> list[dict[str, Any]]:
    """Return checks as a task stores them."""
    return [{"kind": check.kind} | check.model_dump(mode="json", exclude_defaults=True) for check in checks]


def failing(checks: Sequence[AnyCheck], subject: Subject) -> dict[str, str]:
    """Return what the checks that do not hold measure, by kind."""
    judged = [check.judge(subject) for check in checks]
    return {each.kind: f"{each.kind} wants {each.wanted}, is {each.measured}" for each in judged if not each.ok}


if __name__ == "__main__":
    for folder, task in tasks_in(TASKS, names=sys.argv[1:]):
        built = reference(folder, task, cache=BuildCache())
        subject, file = Subject(built), folder / "task.json"
        found = bindings(task, subject)
        again: tuple[AnyCheck, ...] = ()
        wrong = failing(found, subject)
        if task.edit is not None and not wrong:
            after = Subject(edited_reference(folder, task, built, cache=BuildCache()), before=built)
            restated = failing(found, after)
            edited = task.model_copy(update={"checks": task.edit_checks})
            again = tuple(check for check in bindings(edited, after) if check.kind in restated)
            wrong = failing(again, after)
        if wrong:
            print(f"{task.name}: not written: {'; '.join(wrong.values())}", flush=True)
            continue
        stored = json.loads(file.read_text(encoding="utf-8"))
        stored["checks"] = [row for row in stored["checks"] if row["kind"] not in KINDS] + rows(found)
        if task.edit is not None:
            stored["edit"]["checks"] = [row for row in stored["edit"]["checks"] if row["kind"] not in KINDS] + rows(again)
        file.write_text(json.dumps(stored, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(f"{task.name}: {len(found)} checks, {len(again)} of the edit", flush=True)
