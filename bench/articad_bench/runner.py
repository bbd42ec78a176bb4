"""Runs of the benchmark: each task generated, judged and written down before the next one; a killed run resumes where it was.

One folder a task: its run directory, `run_` and the key of the way it was run, those of its edits, `edit_1_` and so on and the same, that
of the product that it begins with, `given_` and the same, and `row.json`, its row of the table. A row that is there and was made of the same task in the same way is not made again, so the table of a finished
benchmark costs nothing to print. A task that failed because the provider could not be reached leaves no row: it is made again.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

from articad.agents.edit import edit
from articad.agents.llm import LLM
from articad.agents.part_writer import REPAIRS, Looks
from articad.agents.pipeline import generate
from articad.agents.retrieval import Memory
from articad.agents.review import trajectory
from articad.agents.settings import ROUNDS, RunOptions, Services, Variant
from articad.aliases import Json
from articad.assembly import Assembly
from articad.errors import TransportError
from articad.kernels.kernel import BuildCache, PartKernel
from articad.runs.record import assembly_of, record_assembly, record_checks
from articad.runs.run import Run, RunRequest, digest, open_or_create
from articad_bench.allowance import Allowance
from articad_bench.recorded import as_recorded
from articad_bench.reference import given
from articad_bench.row import Row, keep_row, kept_row
from articad_bench.subject import Subject
from articad_bench.task import Task, read_image

Ask = Callable[[Task], LLM]
"""Who answers a task's requests."""

AskEdit = Callable[[Task, int], LLM]
"""Who answers those of one of its edits, counted from 1."""

Finished = Callable[[Run], object]
"""Called with each finished run, for example to remember it."""


def run_tasks(
    tasks: Iterable[tuple[Path, Task]],
    out: str | Path,
    ask: Ask,
    *,
    ask_edit: AskEdit | None = None,
    variant: Variant = "full",
    kernel: PartKernel | None = None,
    cache: BuildCache | None = None,
    memory: Memory | None = None,
    look: Looks = "together",
    model: str = "",
    repairs: int = REPAIRS,
    rounds: int = ROUNDS,
    jobs: int = 1,
    finished: Finished | None = None,
    progress: Callable[[Row], object] | None = None,
) -> list[Row]:
    """Run tasks and judge what comes of them.

    Args:
        tasks: Folders and tasks.
        out: Where rows and runs are kept; rows that are there are not made again.
        ask: Who answers each task's requests.
        ask_edit: Who answers those of its edits; whoever answers the task's first requests by default.
        variant: As for `generate`.
        kernel: Likewise.
        cache: Likewise.
        memory: Likewise.
        look: As for `generate`; if false, models do not look at the assembly either.
        model: Name of the model that answers: rows of another model are made again.
        repairs: As for `generate`.
        rounds: As for `generate`.
        jobs: How many tasks at once.
        finished: Called with each finished run.
        progress: Called with each row.

    Returns:
        A row for each task, in order.
    """

    def one(pair: tuple[Path, Task]) -> Row:
        folder, task = pair
        place = Path(out) / task.name
        way = {"variant": variant, "look": look, "model": model, "kernel": None if kernel is None else kernel.name}
        key = digest({"task": task.model_dump(mode="json"), **way, "repairs": repairs, "rounds": rounds})
        row = kept_row(place, key)
        if row is None:
            made = _Made(task, folder, place, key, (ask, ask_edit), finished)
            options = RunOptions(variant=variant, look=look, inspection=bool(look), ideas="never", repairs=repairs, rounds=rounds)
            row = made.row(options, Services(kernel=kernel, cache=cache, memory=memory))
            if not made.unreached:
                keep_row(place, row)
        if progress is not None:
            progress(row)
        return row

    with ThreadPoolExecutor(max(jobs, 1)) as pool:
        return list(pool.map(one, tasks))


class _Made:
    """One task at work.

    Attributes:
        unreached: Whether it failed because the provider could not be reached.
    """

    def __init__(
        self, task: Task, folder: Path, place: Path, key: str, asks: tuple[Ask, AskEdit | None], finished: Finished | None
    ) -> None:
        self._task, self._folder, self._finished = task, folder, finished
        self._ask, self._ask_edit = asks
        self._begun = place / f"given_{key[:8]}"
        self._run, *self._edits = (place / f"{name}_{key[:8]}" for name in ("run", *(f"edit_{n + 1}" for n in range(len(task.edits)))))
        self._allowance = Allowance(task.budget, _records(self._run, *self._edits))
        self._key = key
        self.unreached = False

    def row(self, options: RunOptions, services: Services) -> Row:
        """Return what comes of it."""
        task, row, started = self._task, Row.of(self._task, self._key), time.monotonic()
        try:
            llm = self._ask(task)
            run, before = self._first(llm, options, services)
            subject = Subject(assembly_of(run, cache=services.cache), before=before)
            row = replace(row, judgements=task.judge(subject))
            self._tell(run)
            row = self._with_edits(row, run, llm, options, services)
        except Exception as error:  # noqa: BLE001 - a defect of ours costs one task, not the benchmark
            row = replace(row, error=self._told(error))
        return replace(row, seconds=time.monotonic() - started, **_effort(self._run, *self._edits))

    def _first(self, llm: LLM, options: RunOptions, services: Services) -> tuple[Run, Assembly | None]:
        """Return the run of the prompt: of an edit where a product is given. Return that product with it."""
        task, options, allowed = self._task, as_recorded(options, llm), self._allowance.of(llm)
        images = [read_image(self._folder, image) for image in task.images]
        before = given(self._folder, task, cache=services.cache, kernel=services.kernel)
        if before is None:
            return generate(task.prompt, llm=allowed, images=images, out=self._run, options=options, services=services), None
        begun = _as_run(before, self._begun)
        return edit(begun, task.prompt, llm=allowed, images=images, out=self._run, options=options, services=services), before

    def _with_edits(self, row: Row, run: Run, llm: LLM, options: RunOptions, services: Services) -> Row:
        """Return the row with what comes of each edit; after one that is not made, none is asked for."""
        try:
            before = assembly_of(run, cache=services.cache)
            for stage, (change, out) in enumerate(zip(self._task.edits, self._edits, strict=True), start=1):
                asked = llm if self._ask_edit is None else self._ask_edit(self._task, stage)
                chosen = as_recorded(options, asked)
                run = edit(run, change.prompt, llm=self._allowance.of(asked), out=out, options=chosen, services=services)
                after = assembly_of(run, cache=services.cache)
                row = replace(row, edited=(*row.edited, self._task.judge(Subject(after, before=before), stage)))
                self._tell(run)
                before = after
        except Exception as error:  # noqa: BLE001 - as above
            row = replace(row, edit_error=self._told(error))
        return row

    def _tell(self, run: Run) -> None:
        if self._finished is not None:
            self._finished(run)

    def _told(self, error: Exception) -> str:
        self.unreached = self.unreached or isinstance(error, TransportError)
        return f"{type(error).__name__}: {error}"


def _as_run(assembly: Assembly, out: Path) -> Run:
    """Return the finished run of a product that is given, as `articad build` makes it."""
    assert assembly.plan is not None
    options: Json = {"task": "build", "kernel": assembly.plan.kernel, "parameters": {}}
    with open_or_create(RunRequest(prompt=assembly.plan.name, options=options), out) as run:
        run.save_plan(assembly.plan.dumps(), 0)
        record_assembly(run, assembly)
        record_checks(run, assembly.check(motion=False))
    return run


def _records(*paths: Path) -> list[Json]:
    """Return the requests of runs that were answered, with their answers."""
    runs = [Run.view(path) for path in paths if (path / "request.json").is_file()]
    return [reply for run in runs for step in run.replies() if (reply := run.reply(step)) is not None]


def _effort(*paths: Path) -> dict[str, Any]:
    """Return what runs took, finished or not."""
    runs = [Run.view(path) for path in paths if (path / "request.json").is_file()]
    replies = [record["reply"] for record in _records(*paths)]
    costs = [reply["cost"] for reply in replies]
    return {
        "iterations": sum(_iterations(run) for run in runs),
        "calls": len(replies),
        "tokens": sum(sum(reply["usage"].values()) for reply in replies),
        "cost": None if any(cost is None for cost in costs) else sum(costs),
    }


def _iterations(run: Run) -> int:
    way = trajectory(run)
    again: int = max(way["designs"] - 1, 0) + sum(max(answers - 1, 0) for answers in way["scripts"].values())
    return 1 + again
