"""Runs of the benchmark: each task generated, judged and written down before the next one; a killed run goes on where it was.

One folder a task: its run directory, `run_` and the key of the way it was run, and `row.json`, its row of the table. A row that is there and was made
of the same task in the same way is not made again, so the table of a finished benchmark costs nothing to print.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from articad import convert
from articad.agents.llm import LLM
from articad.agents.pipeline import Variant, generate
from articad.agents.retrieval import Memory
from articad.agents.review import trajectory
from articad.bench.checks import Judgement
from articad.bench.subject import Subject
from articad.bench.task import Task
from articad.errors import ArticadError
from articad.kernels.kernel import BuildCache, PartKernel
from articad.record import assembly_of
from articad.run import Run, digest, write_atomically

SCHEMA: Final = "articad.bench-row/1"
_ROW = "row.json"
_SIMULATED: Final = frozenset({".urdf", ".xml", ".mjcf"})

Ask = Callable[[Task], LLM]
"""Who answers a task's requests."""

Finished = Callable[[Run], object]
"""Told of each finished run: to remember it, for instance."""


@dataclass(frozen=True)
class Row:
    """What came of one task.

    Attributes:
        task: Its name.
        kind: Of the task.
        modality: What it was asked by.
        judgements: Of every check; none if nothing was made.
        error: Why nothing was made.
        iterations: Answers with a plan or a script that were needed, beyond one for each plan and part, plus one.
        calls: Answers of models.
        tokens: In and out.
        cost: US dollars; None where a price is unknown.
        seconds: Wall time.
        key: Digest of the task and the way it was run.
    """

    task: str
    kind: str
    modality: str
    judgements: tuple[Judgement, ...] = ()
    error: str | None = None
    iterations: int = 0
    calls: int = 0
    tokens: int = 0
    cost: float | None = 0.0
    seconds: float = 0.0
    key: str = ""

    @property
    def made(self) -> bool:
        """The paper's success: it was built, with all the parts that were asked for."""
        return self.error is None and all(judgement.ok for judgement in self.judgements if judgement.kind in {"parts", "solids"})

    @property
    def ok(self) -> bool:
        """True when every check holds."""
        return self.error is None and bool(self.judgements) and all(judgement.ok for judgement in self.judgements)

    def to_json(self) -> dict[str, Any]:
        """Return the row as it is kept."""
        rows = {name: value for name, value in vars(self).items() if name != "judgements"}
        return {"schema": SCHEMA, "ok": self.ok} | rows | {"judgements": [judgement.to_json() for judgement in self.judgements]}

    @classmethod
    def from_json(cls, stored: dict[str, Any]) -> Row:
        """Read a row that was kept."""
        judgements = tuple(Judgement(**judgement) for judgement in stored["judgements"])
        return cls(**{name: stored[name] for name in cls.__dataclass_fields__ if name != "judgements"}, judgements=judgements)


def run_tasks(
    tasks: Iterable[tuple[Path, Task]],
    out: str | Path,
    ask: Ask,
    *,
    variant: Variant = "full",
    kernel: PartKernel | None = None,
    cache: BuildCache | None = None,
    memory: Memory | None = None,
    look: bool = True,
    jobs: int = 1,
    finished: Finished | None = None,
    progress: Callable[[Row], object] | None = None,
) -> list[Row]:
    """Run tasks and judge what comes of them.

    Args:
        tasks: Folders and tasks.
        out: Where rows and runs are kept; rows that are there are not made again.
        ask: Who answers each task's requests.
        variant: As for `generate`.
        kernel: Likewise.
        cache: Likewise.
        memory: Likewise.
        look: Whether models look at parts and assembly.
        jobs: How many tasks at once.
        finished: Told of each finished run.
        progress: Told of each row.

    Returns:
        A row for each task, in order.
    """

    def one(pair: tuple[Path, Task]) -> Row:
        folder, task = pair
        place = Path(out) / task.name
        key = digest({"task": task.model_dump(mode="json"), "variant": variant, "look": look})
        row = _kept(place, key)
        if row is None:
            row = _made(task, folder, place, key, ask, finished, variant=variant, kernel=kernel, cache=cache, memory=memory, look=look)
            _keep(place, row)
        if progress is not None:
            progress(row)
        return row

    with ThreadPoolExecutor(max(jobs, 1)) as pool:
        return list(pool.map(one, tasks))


def score_files(tasks: Iterable[tuple[Path, Task]], folder: str | Path) -> list[Row]:
    """Judge files that any tool made: `<folder>/<task>.urdf`, or the one model in `<folder>/<task>/`.

    Args:
        tasks: Folders and tasks; one without a file is a row with an error.
        folder: Where the files are: URDF, MJCF, FreeCAD documents, plans or runs.
    """
    return [_scored(task, Path(folder)) for _, task in tasks]


def _made(task: Task, folder: Path, place: Path, key: str, ask: Ask, finished: Finished | None, **options: Any) -> Row:
    row = Row(task.name, task.kind, task.modality, key=key)
    look = options.pop("look")
    started = time.monotonic()
    try:
        run = generate(
            task.prompt,
            llm=ask(task),
            images=[folder / image for image in task.images],
            out=place / f"run_{key[:8]}",
            ideas="never",
            look=look,
            inspection=look,
            **options,
        )
        judgements = task.judge(Subject(assembly_of(run, cache=options["cache"])))
        row = replace(row, judgements=judgements)
        if finished is not None:
            finished(run)
    except ArticadError as error:
        row = replace(row, error=f"{type(error).__name__}: {error}")
    return replace(row, seconds=time.monotonic() - started, **_effort(place / f"run_{key[:8]}"))


def _effort(path: Path) -> dict[str, Any]:
    """Return what a run took, finished or not."""
    if not (path / "request.json").is_file():
        return {}
    run = Run.view(path)
    replies = [reply["reply"] for step in run.replies() if (reply := run.reply(step)) is not None]
    costs = [reply["cost"] for reply in replies]
    way = trajectory(run)
    again = max(way["designs"] - 1, 0) + sum(max(answers - 1, 0) for answers in way["scripts"].values())
    return {
        "iterations": 1 + again,
        "calls": len(replies),
        "tokens": sum(sum(reply["usage"].values()) for reply in replies),
        "cost": None if any(cost is None for cost in costs) else sum(costs),
    }


def _scored(task: Task, folder: Path) -> Row:
    row = Row(task.name, task.kind, task.modality)
    found = _model_of(task.name, folder)
    if found is None:
        return replace(row, error=f"There is no model of {task.name} in {folder}.")
    started = time.monotonic()
    try:
        judgements = task.judge(_subject(found))
        return replace(row, judgements=judgements, seconds=time.monotonic() - started)
    except ArticadError as error:
        return replace(row, error=f"{type(error).__name__}: {error}", seconds=time.monotonic() - started)


def _model_of(name: str, folder: Path) -> Path | None:
    for suffix in convert.READERS:
        if (file := folder / f"{name}{suffix}").is_file():
            return file
    place = folder / name
    for run in (place, *sorted(place.glob("run*"))):
        if (run / "request.json").is_file():
            return run
    files = [file for suffix in convert.READERS for file in sorted(place.rglob(f"*{suffix}"))]
    return files[0] if files else None


def _subject(found: Path) -> Subject:
    if found.is_dir():
        return Subject(assembly_of(Run.view(found)))
    return Subject(convert.read(found), file=found if found.suffix.lower() in _SIMULATED else None)


def _kept(place: Path, key: str) -> Row | None:
    try:
        row = Row.from_json(json.loads((place / _ROW).read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return row if row.key == key else None


def _keep(place: Path, row: Row) -> None:
    place.mkdir(parents=True, exist_ok=True)
    write_atomically(place / _ROW, (json.dumps(row.to_json(), indent=1, ensure_ascii=False) + "\n").encode())


def rows_in(out: str | Path, names: Sequence[str] = ()) -> list[Row]:
    """Return the rows that a folder of runs holds, by name."""
    files = sorted(Path(out).glob(f"*/{_ROW}"))
    rows = [Row.from_json(json.loads(file.read_text(encoding="utf-8"))) for file in files]
    return [row for row in rows if not names or row.task in names]
