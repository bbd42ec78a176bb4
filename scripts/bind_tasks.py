"""Write the checks that bind tasks to bodies, derived from their references, into `task.json`; see `articad_bench.bindings`.

    python scripts/bind_tasks.py press_toggle delta_robot
    python scripts/bind_tasks.py          # all

A task whose checks are bound already gets them anew. Where they do not hold of an edited product, the edit restates those of that kind.
No task is written whose references do not pass all these checks.
"""

import json
import sys
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from articad.kernels.kernel import BuildCache
from articad_bench.bindings import BOUND, NotBoundError, bound_task
from articad_bench.checks import AnyCheck
from articad_bench.reference import given, references
from articad_bench.subject import Subject
from articad_bench.task import TASKS, checks_as_stored, tasks_in

KINDS = {check.model_fields["kind"].default for check in BOUND}


def put(stored: dict[str, Any], checks: Sequence[AnyCheck]) -> None:
    """Replace the bindings among stored checks; the other rows stay as they are written."""
    stored["checks"] = [row for row in stored["checks"] if row["kind"] not in KINDS]
    stored["checks"] += checks_as_stored([check for check in checks if isinstance(check, BOUND)])


if __name__ == "__main__":
    for folder, task in tasks_in(TASKS, names=sys.argv[1:]):
        stages = [given(folder, task, cache=BuildCache()), *references(folder, task, cache=BuildCache())]
        first, *after = [Subject(product, before=before) for before, product in pairwise(stages) if product is not None]
        try:
            found = bound_task(task, first, after)
        except NotBoundError as error:
            print(f"{task.name}: not written: {error}", flush=True)
            continue
        file = folder / "task.json"
        stored = json.loads(file.read_text(encoding="utf-8"))
        put(stored, found.checks)
        for row, edit in zip(stored.get("edits", ()), found.edits, strict=True):
            put(row, edit.checks)
        file.write_text(json.dumps(stored, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(f"{task.name}: {len(found.checks)} checks", flush=True)
