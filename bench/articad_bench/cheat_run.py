"""A run of the cheat suite: every cheat of the chosen tasks, the check that refuses it, and the files of the results."""

from __future__ import annotations

import hashlib
import inspect
import json
import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Final

from articad.aliases import Json
from articad.assembly import Assembly
from articad.batches.pool import Call
from articad.errors import ArticadError
from articad.kernels.kernel import BuildCache, PartKernel
from articad.processes import scratch
from articad_bench.bindings import DETAIL
from articad_bench.cheats import CHEATS
from articad_bench.check import Check
from articad_bench.feature_cheats import FEATURELESS, feature_cheats
from articad_bench.heading import QUARTERS, is_directed
from articad_bench.likeness_checks import handedness
from articad_bench.reference import given, reference, reference_folders, references
from articad_bench.shape_checks import placed, same_parts
from articad_bench.solids import occupied
from articad_bench.staged_cheats import STAGED, StagedCheat, alike, staged_cheats
from articad_bench.subject import Subject
from articad_bench.task import Task, read_json, read_task

__all__ = ["COSTLY", "SCHEMA", "CheatRow", "page", "refused_by", "run_cheats", "sources_of"]

SCHEMA: Final = "articad.bench-cheats/1"
SAME: Final = 0.01  # share of the matter by which a mirror image may differ from what it mirrors
_RESULTS, _PAGE = "cheats.json", "cheats.md"
_SOURCES: Final = (
    "check.py",
    "checks.py",
    "shape_checks.py",
    "path_checks.py",
    "gear_checks.py",
    "bindings.py",
    "likeness_checks.py",
    "outline_checks.py",
    "whole_checks.py",
    "spacing_checks.py",
    "function_checks.py",
    "strength_checks.py",
    "beams.py",
    "stack_checks.py",
    "machined_checks.py",
    "module_checks.py",
    "edit_checks.py",
    "wanted.py",
    "solids.py",
    "subject.py",
    "heading.py",
    "cheats.py",
    "staged_cheats.py",
    "feature_cheats.py",
    "script_faults.py",
    "trick_cheats.py",
    "room_checks.py",
    "section_checks.py",
    "around.py",
    "bodies.py",
)
_OF_KINDS: Final = frozenset(  # of these, what no check of a task comes from decides nothing of it
    f"{name}_checks.py"
    for name in (
        "edit",
        "function",
        "gear",
        "machined",
        "module",
        "outline",
        "path",
        "room",
        "section",
        "spacing",
        "stack",
        "strength",
        "whole",
    )
)
COSTLY: Final = (
    "effort",
    "folds",
    "made",
    "captive",
    "clear_in_motion",
    "certified",
    "put_together",
    "simulates",
)  # the least costly first

_ABOUT: Final = """\
# Cheats

<!-- Written by `articad bench cheats --out docs/reference` from its results, cheats.json. -->

Products that look right to the checks of a task and are not what was asked for. None may pass. [The how-to](../how-to/benchmark.md#try-to-cheat) says how to run
the suite and how to submit a cheat of your own.

| cheat | what it is |
|---|---|
| discs | a disc or a sphere on a plate for each joint that the checks ask for, made of the checks alone |
| wires | the reference with each body a skeleton of 0.06 mm wire |
| shells | the reference with each body hollow, its walls 1 % of its size |
| mirrored | its mirror image; not counted where that is the same product, but for the hand of a detail such as the twist of a rotor |
| misplaced | a moving body beside its joint |
| omitted | without one body that moves or that the text names, and what is fixed to it |
| swapped | two bodies have each other's shapes |
| scaled | ten times as large |
| merged | a moving body united with what carries it, with a crumb in its place |
| waived | a body that runs through its neighbours, with waivers of its own for all of it |
| coaxial | loops left open, and as many pins doubled |
| weightless | of foam, where a weight is asked for |
| brimful | drawers, or what a lid covers, solid, where it is asked how much they hold |
| backward | its joints go to the other side of rest, where a side is asked for |
| notched | a corner of its largest part cut off, 1 to 2 % of it, where sheets are given |
| slipped | its last part beside its place, along its longest side, where sheets are given |
| barred | a bar on the back of its largest part, where photos or a drawing of the whole are given |
| stuck | sleeves slide and do not turn, universal joints lean one way alone, what lies on a plane slides one way alone |
| overturned | upside down, or facing the other way, where the text or a picture says how it stands |
| other | the reference of another task |
| given | the product that the task begins with, as it is |
| short | of a task that begins with a product: joints go half as far from rest |
| stage | what is given, or the product of another stage, as the answer of a stage of a task with edits |
| partly | one of several changes of a stage not made: of a part's shape, of a joint, of the couplings |
| side | one of several sides of a part that an edit changes is as long as before |
| crumbs | after an edit, every part is new by a hair, and as many crumbs on the ground stay as parts were to |
| featureless | the reference without one of the cuts or bodies that its scripts make, where the task does not leave it open |
"""


@dataclass(frozen=True)
class CheatRow:
    """What came of a cheat.

    Attributes:
        task: Name of the task.
        cheat: Its kind.
        refused_by: Kind of the first check that does not hold; "format" if no assembly can be made of it; None if it passes.
        measured: What that check measured.
        same: Whether it is the same product as the reference, so that it is no cheat.
        digest: Of the task, its reference, the checks and the cheats.
        earlier: Whether one of these has changed since.
        what: Which of several of its kind it is.
    """

    task: str
    cheat: str
    refused_by: str | None
    measured: str
    same: bool
    digest: str
    earlier: bool = False
    what: str = ""

    @property
    def named(self) -> str:
        """Its kind, and which of several it is."""
        return f"{self.cheat} ({self.what})" if self.what else self.cheat

    @property
    def passed(self) -> bool:
        """Whether it is a cheat and every check holds."""
        return self.refused_by is None and not self.same


def run_cheats(
    tasks: Sequence[tuple[Path, Task]],
    out: Path,
    *,
    every: Sequence[tuple[Path, Task]],
    cache: BuildCache | None = None,
    kernel: PartKernel | None = None,
    again: bool = False,
    seconds: float | None = None,
    some: int | None = None,
    spread: Callable[[list[Call], Callable[[Json], None]], object] | None = None,
    tell: Callable[[str, str], object] = lambda _case, _outcome: None,
) -> dict[str, Any]:
    """Try all cheats of tasks, write `cheats.json` and the page `cheats.md`, and return the report.

    Results are written after every task. A task is tried again if it, its reference, the checks or the cheats have changed. Until then its
    rows stay, and the page counts them as answers of earlier checks.

    Args:
        tasks: Folders and tasks to try.
        out: Folder of both files.
        every: All tasks of the benchmark: the page says how many were tried.
        cache: Keeps built parts.
        kernel: Builds the references.
        again: Whether to try cheats again that have results.
        seconds: No task is begun after this time; all by default.
        some: No more tasks than these are tried, of those without results; all by default.
        spread: Makes calls in other processes and gives each answer as it comes to a function; tasks are tried one by one by default.
        tell: Called with each cheat and its outcome.
    """
    out.mkdir(parents=True, exist_ok=True)
    digests = {task.name: _digest(folder, task) for folder, task in every}
    known = [row for row in _known(out / _RESULTS) if row.task in digests]
    rows = [replace(row, earlier=row.digest != digests[row.task]) for row in known]
    chosen, end = {task.name for _, task in tasks}, None if seconds is None else time.monotonic() + seconds
    if again:
        rows = [row for row in rows if row.task not in chosen]
    done = {row.task for row in rows} - {row.task for row in rows if row.earlier}
    waiting = [(folder, task) for folder, task in tasks if task.name not in done and task.reference is not None][:some]

    def put(fresh: Iterable[CheatRow]) -> None:
        fresh = list(fresh)
        tried = {row.task for row in fresh}
        rows[:] = [*(row for row in rows if row.task not in tried), *fresh]

    if spread is not None:

        def keep(answer: Json) -> None:
            put(CheatRow(**row) for row in answer.get("rows", ()))
            _save(out, rows, len(every))

        spread([_call(folder, task, _other(every, task), digests[task.name]) for folder, task in waiting], keep)
        return _save(out, rows, len(every))
    for folder, task in waiting:
        if end is not None and time.monotonic() > end:
            break
        put(_tried(folder, task, _other(every, task), digests[task.name], cache, kernel, tell))
        _save(out, rows, len(every))
    return _save(out, rows, len(every))


def _call(folder: Path, task: Task, other: tuple[Path, Task] | None, digest: str) -> Call:
    given = {"folder": str(folder.resolve()), "other": None if other is None else str(other[0].resolve()), "digest": digest}
    return Call("articad_bench.cheat_run:try_stored", given, f"cheats-{task.name}")


def try_stored(folder: str, other: str | None, digest: str) -> Json:
    """Try all cheats of one task; return their rows.

    Args:
        folder: Of the task.
        other: Folder of the task whose reference is a cheat.
        digest: What the rows are kept by.
    """
    place, task = Path(folder), read_task(folder)
    elsewhere = None if other is None else (Path(other), read_task(other))
    rows = _tried(place, task, elsewhere, digest, BuildCache(), None, lambda _case, _outcome: None)
    return {"task": task.name, "ok": not any(row.passed for row in rows), "rows": [asdict(row) for row in rows]}


def _tried(
    folder: Path,
    task: Task,
    other: tuple[Path, Task] | None,
    digest: str,
    cache: BuildCache | None,
    kernel: PartKernel | None,
    tell: Callable[[str, str], object],
) -> list[CheatRow]:
    stages, begun = list(references(folder, task, cache=cache, kernel=kernel)), given(folder, task, cache=cache, kernel=kernel)
    put, rows = partial(StagedCheat, what="", stage=0, before=begun, right=stages[0]), []
    cheats = [put(kind, make=partial(make, task, stages[0])) for kind, make in CHEATS.items()]
    if other is not None:
        cheats.append(put("other", make=partial(reference, *other, cache=cache, kernel=kernel)))
    cheats += [*staged_cheats(begun, stages, task.left_open), *feature_cheats(folder, task, stages[0], begun, cache, kernel)]
    for cheat in cheats:
        row = _judged(task, cheat, digest)
        if row is not None:
            rows.append(row)
            tell(f"{task.name}: {row.named}", "same" if row.same else "passed" if row.passed else f"refused by {row.refused_by}")
    return rows


def _judged(task: Task, cheat: StagedCheat, digest: str) -> CheatRow | None:
    """Return what comes of a cheat; None if the task cannot be tried with it."""
    row = partial(CheatRow, task.name, cheat.kind, digest=digest, what=cheat.what)
    try:
        assembly = cheat.make()
    except ArticadError as error:
        return row("format", str(error).splitlines()[0][:200], same=False)
    if assembly is None:
        return None
    if the_same(cheat.kind, cheat.right, assembly):
        return row(None, "", same=True)
    failed = refused_by(task, Subject(assembly, before=cheat.before), cheat.stage)
    return row(None, "", same=False) if failed is None else row(failed[0], failed[1][:200], same=False)


def refused_by(task: Task, subject: Subject, stage: int = 0) -> tuple[str, str] | None:
    """Return kind and measurement of a check of a stage that does not hold, cheap ones first; None if all hold, as it may be turned."""
    order = {kind: place for place, kind in enumerate(COSTLY, start=1)}
    checks = sorted(task.stages[stage], key=lambda check: order.get(check.kind, 0))
    first = _refusing(checks, subject)
    if first is None or not task.may_turn or not is_directed(first[0]):
        return first and (first[0].kind, first[1])
    if any(_refusing(checks, subject.turned(quarters)) is None for quarters in QUARTERS):
        return None
    return first[0].kind, first[1]


def _refusing(checks: Sequence[Check], subject: Subject) -> tuple[Check, str] | None:
    """Return the first check that does not hold, and what it measured; None if all hold."""
    for check in checks:
        judgement = check.judge(subject)
        if not judgement.ok:
            return check, judgement.measured
    return None


def the_same(kind: str, reference: Assembly, cheat: Assembly) -> bool:
    """Return whether a cheat is the product itself: the mirror image of a symmetric one, or one whose exchanged bodies are alike."""
    if kind in STAGED:
        return alike(reference, cheat)
    if kind == "mirrored":
        return _same_mirrored(reference, cheat)
    return kind == "swapped" and same_parts(Subject(reference), Subject(cheat), SAME)


def _same_mirrored(reference: Assembly, mirrored: Assembly) -> bool:
    """Return whether a mirror image fills the same place, about the middle, and threads have the same hands.

    It is the same as well where no moment of its matter up to the third degree tells it from what it mirrors: then the whole has no hand,
    and that of a detail, such as the twist of a rotor's blades, is not asked for.
    """
    leads = sorted(joint.lead for joint in reference.joints if joint.lead)
    if leads != sorted(-lead for lead in leads):
        return False
    if handedness(Subject(reference)) <= DETAIL:
        return True
    first, second = (occupied(placed(Subject(assembly)))[0] for assembly in (reference, mirrored))
    turned = [second, second[::-1, ::-1]]  # standing as it does, or turned half round
    return any(first.shape == each.shape and float((first ^ each).sum()) <= SAME * float(2 * first.sum()) for each in turned)


def _other(every: Sequence[tuple[Path, Task]], task: Task) -> tuple[Path, Task] | None:
    """Return a task of the same kind with a reference that looks most like this one to its checks."""
    kinds = {check.kind for check in task.checks}
    others = [(folder, each) for folder, each in every if each.name != task.name and each.kind == task.kind and each.reference is not None]
    return max(others, key=lambda pair: (len(kinds & {check.kind for check in pair[1].checks}), pair[1].name), default=None)


def _digest(folder: Path, task: Task) -> str:
    found = hashlib.sha256(task.model_dump_json(exclude={"unheld"}).encode())  # which says nothing of what must hold
    for place in reference_folders(folder, task):
        for file in sorted(path for path in place.rglob("*") if path.suffix in {".json", ".py"}):
            found.update(file.relative_to(place).as_posix().encode() + file.read_bytes())
    for name in sources_of(task):
        found.update(Path(__file__).with_name(name).read_bytes())
    return found.hexdigest()[:16]


def sources_of(task: Task) -> list[str]:
    """Return the files that decide what comes of a task's cheats: those of checks that it has, and what all share."""
    used = {Path(inspect.getfile(type(check))).name for stage in task.stages for check in stage}
    return [name for name in _SOURCES if name in used or name not in _OF_KINDS]


def _known(file: Path) -> list[CheatRow]:
    return [CheatRow(**row) for row in read_json(file)["rows"]] if file.is_file() else []


def _save(out: Path, rows: Sequence[CheatRow], tasks: int) -> dict[str, Any]:
    rows = sorted(rows, key=lambda row: (row.task, row.cheat, row.what))
    passed = [row for row in rows if row.passed]
    report = {
        "schema": SCHEMA,
        "ok": not passed,
        "findings": [],
        "tasks": tasks,
        "tried": len({row.task for row in rows}),
        "cheats": sum(not row.same for row in rows),
        "passed": [[row.task, row.named] for row in passed],
        "rows": [asdict(row) for row in rows],
    }
    for name, text in ((_RESULTS, json.dumps(report, indent=1, ensure_ascii=False) + "\n"), (_PAGE, page(report, rows))):
        scratch.write(out / name, text.encode())  # a run that is killed leaves whole files
    return report


def page(report: Mapping[str, Any], rows: Sequence[CheatRow]) -> str:
    """Return the page of a report."""
    lines = [
        _ABOUT,
        f"{report['cheats']} cheats of {report['tried']} of {report['tasks']} tasks were tried; {len(report['passed'])} pass.\n",
    ]
    if earlier := sum(row.earlier for row in rows):
        lines.append(
            f"{earlier} of {len(rows)} answers are of earlier checks, cheats or tasks: `articad bench cheats` tries these again.\n"
        )
    lines.append("| cheat | tried | same | pass | refused by |")
    lines.append("|---|---|---|---|---|")
    for kind in (*CHEATS, "other", *STAGED, FEATURELESS):
        mine = [row for row in rows if row.cheat == kind]
        by = Counter(row.refused_by for row in mine if row.refused_by)
        told = ", ".join(f"{check} {count}" for check, count in by.most_common())
        lines.append(f"| {kind} | {len(mine)} | {sum(r.same for r in mine)} | {sum(r.passed for r in mine)} | {told} |")
    if report["passed"]:
        lines += ["\n## What passes\n", *(f"- `{task}`: {cheat}" for task, cheat in report["passed"])]
    tried = sorted({row.task for row in rows})
    lines += ["\n## Tasks tried\n", ", ".join(f"`{name}`" for name in tried) + "."]
    return "\n".join(lines) + "\n"
