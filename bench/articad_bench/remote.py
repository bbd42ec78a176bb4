"""Tasks in other processes: a worker runs or scores one task; requests and answers are JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from articad.agents.live import LiteLLM
from articad.agents.llm import Budget
from articad.agents.recollection import StoredMemory, remember
from articad.aliases import Json
from articad.batches.pool import Call
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache
from articad.memory.experience import ExperienceStore
from articad.runs.run import digest
from articad_bench.row import Row
from articad_bench.runner import run_tasks
from articad_bench.scoring import score_files
from articad_bench.task import Task, read_task


def score_calls(tasks: Iterable[tuple[Path, Task]], models: str | Path) -> list[Call]:
    """Return the calls by which workers score each task's files in a folder."""
    folder = str(Path(models).resolve())
    return [
        Call("articad_bench.remote:score_stored", {"folder": str(place.resolve()), "models": folder}, f"score-{task.name}")
        for place, task in tasks
    ]


def run_calls(tasks: Iterable[tuple[Path, Task]], out: str | Path, options: Mapping[str, Any]) -> list[Call]:
    """Return the calls by which workers run tasks; see `run_stored`."""
    said = dict(options)
    return [
        Call(
            "articad_bench.remote:run_stored",
            {"folder": str(place.resolve()), "out": str(Path(out).resolve()), "options": said},
            digest([task.name, said]),
            needs_keys=True,
        )
        for place, task in tasks
    ]


def score_stored(folder: str, models: str) -> Json:
    """Score one task's file; return its row."""
    place = Path(folder)
    (row,) = score_files([(place, read_task(place))], models)
    return row.to_json()


def run_stored(folder: str, out: str, options: Json) -> Json:
    """Have a model do one task, unless it is done; return its row.

    Args:
        folder: Of the task.
        out: Where rows and runs are kept.
        options: `model`, `vision_model`, `judge_model`, `api_base`, `limits` of a budget; `kernel`, `sandbox`, `memory`; what is left
            goes to `run_tasks`.
    """
    place, asked = Path(folder), dict(options)
    named = {name: asked.pop(name) for name in ("vision_model", "judge_model", "api_base")}
    model, limits, store = asked.pop("model"), asked.pop("limits"), ExperienceStore(asked.pop("memory"))
    kernel = kernel_named(asked.pop("kernel"), sandbox=asked.pop("sandbox"))
    cache = BuildCache(None) if asked.pop("force") else BuildCache()
    (row,) = run_tasks(
        [(place, read_task(place))],
        out,
        lambda _task: Budget(LiteLLM(model, **named), **limits),
        model=",".join(name for name in (model, named["vision_model"], named["judge_model"]) if name),
        kernel=kernel,
        cache=cache,
        memory=StoredMemory(store),
        finished=lambda run: remember(run, store),
        **asked,
    )
    return row.to_json()


def rows_of(tasks: Iterable[tuple[Path, Task]], answers: Iterable[Json]) -> list[Row]:
    """Return the rows that workers answered with; a worker that never came back is an error of its task."""
    return [
        Row.from_json(answer) if "judgements" in answer else _lost(task, answer) for (_, task), answer in zip(tasks, answers, strict=True)
    ]


def _lost(task: Task, answer: Json) -> Row:
    return Row(task.name, task.kind, task.modality, len(task.edits), error=str(answer.get("error", "no answer")))
