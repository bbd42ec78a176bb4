"""Scores of files: what any tool has made, judged as our own runs are; and where such files are looked for."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Final

from articad import formats
from articad.assembly import Assembly
from articad.errors import ArticadError, ReadError
from articad.runs.record import assembly_of
from articad.runs.run import Run
from articad_bench.check import Judgement
from articad_bench.row import Row
from articad_bench.subject import Subject
from articad_bench.task import Task
from articad_bench.unsaid import asked_for, format_of, unsaid

EDITED: Final = "_edited"  # what is appended to a task's name where a tool's edited model is
_SIMULATED: Final = frozenset({".urdf", ".xml", ".mjcf"})


def score_files(tasks: Iterable[tuple[Path, Task]], folder: str | Path) -> list[Row]:
    """Judge files that any tool made: `<folder>/<task>.urdf`, or the one model in `<folder>/<task>/`.

    The model after the task's edit is at `<task>_edited` in place of `<task>`.

    Args:
        tasks: Folders and tasks; one without a file is a row with an error.
        folder: Where the files are: URDF, MJCF, FreeCAD documents, plans or runs.
    """
    return [_scored(task, Path(folder)) for _, task in tasks]


def _scored(task: Task, folder: Path) -> Row:
    row, started = Row.of(task), time.monotonic()
    try:
        place = model_of(task.name, folder)
        before = subject_of(place)
        row = replace(row, judgements=_excused(task.judge(before), task, place))
        if task.edit is not None:
            row = _scored_edit(row, task, folder, before)
    except ArticadError as error:
        row = replace(row, error=f"{type(error).__name__}: {error}")
    return replace(row, seconds=time.monotonic() - started)


def _excused(judgements: tuple[Judgement, ...], task: Task, place: Path) -> tuple[Judgement, ...]:
    """Return judgements that say which checks cannot hold because the format of the file cannot state what they need."""
    reasons = unsaid(format_of(place.suffix), asked_for(task))
    return tuple(
        replace(each, measured=f"{each.measured}. {reasons[each.kind]}") if not each.ok and each.kind in reasons else each
        for each in judgements
    )


def _scored_edit(row: Row, task: Task, folder: Path, before: Subject) -> Row:
    try:
        place = model_of(f"{task.name}{EDITED}", folder)
        edited = replace(subject_of(place), before=before.assembly)
        return replace(row, edited=_excused(task.judge_edit(edited), task, place))
    except ArticadError as error:
        return replace(row, edit_error=f"{type(error).__name__}: {error}")


def model_of(name: str, folder: Path) -> Path:
    """Return the model of a task, or of an edited task.

    Raises:
        ReadError: If there is none.
    """
    for suffix in formats.readable():
        if (file := folder / f"{name}{suffix}").is_file():
            return file
    place = folder / name
    ours, kind = (folder / name.removesuffix(EDITED), "edit*") if name.endswith(EDITED) else (place, "run*")
    for run in (place, *sorted(ours.glob(kind))):
        if (run / "request.json").is_file():
            return run
    files = [file for suffix in formats.readable() for file in sorted(place.rglob(f"*{suffix}"))]
    if not files:
        message = f"There is no model of {name} in {folder}."
        raise ReadError.at(folder, message, f"Write {name}.urdf there, for instance.", said=message)
    return files[0]


def subject_of(found: Path) -> Subject:
    """Return what is to be judged: a run's assembly, or what a file holds.

    A link without collision shapes is judged by its visual shapes; simulators get the file as it is.

    Raises:
        ArticadError: If it cannot be read.
    """
    if found.is_dir():
        return Subject(assembly_of(Run.view(found)))
    return Subject(_solid(formats.read(found, fuse=True)), file=found if found.suffix.lower() in _SIMULATED else None)


def _solid(assembly: Assembly) -> Assembly:
    """Return an assembly whose parts have the shapes that are drawn of them, where they have no others."""
    parts = [replace(part, collisions=part.visuals) if part.mesh is None and part.visuals else part for part in assembly.parts.values()]
    if all(part is assembly.parts[part.name] for part in parts):
        return assembly
    mechanism = assembly.mechanism
    solid = Assembly.from_parts(
        assembly.name,
        parts=parts,
        joints=assembly.joints,
        ground=assembly.ground,
        couplings=mechanism.couplings,
        fits=assembly.fits,
        waivers=assembly.waivers,
        T_ground=mechanism.T_ground,
    )
    return replace(solid, findings=assembly.findings)
