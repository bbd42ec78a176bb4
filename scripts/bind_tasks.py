"""Write the checks that bind the joints of tasks to bodies, derived from their references, into `task.json`; see `articad_bench.bindings`.

    python scripts/bind_tasks.py press_toggle delta_robot

A task whose checks are bound already gets them anew. No task is written whose reference does not pass all its checks.
"""

import json
import sys

from articad_bench.bindings import bindings
from articad_bench.reference import reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in

BOUND = {"moves", "made"}

if __name__ == "__main__":
    for folder, task in tasks_in(TASKS, names=sys.argv[1:]):
        subject, file = Subject(reference(folder, task)), folder / "task.json"
        found = bindings(task, subject)
        wrong = [judgement for check in found if not (judgement := check.judge(subject)).ok]
        if wrong:
            print(f"{task.name}: not written: {wrong[0]}", flush=True)
            continue
        stored = json.loads(file.read_text(encoding="utf-8"))
        rows = [{"kind": check.kind} | check.model_dump(mode="json", exclude_defaults=True) for check in found]
        stored["checks"] = [row for row in stored["checks"] if row["kind"] not in BOUND] + rows
        file.write_text(json.dumps(stored, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(f"{task.name}: {len(rows)} checks", flush=True)
