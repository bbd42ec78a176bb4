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
from articad.kernels.kernel import BuildCache
from articad.runs.record import assembly_of
from articad.runs.run import Run
from articad_bench.check import Judgement
from articad_bench.reference import given
from articad_bench.row import Row
from articad_bench.shape_checks import same_parts
from articad_bench.subject import Subject
from articad_bench.task import Task
from articad_bench.unsaid import asked_for, unsaid

GIVEN: Final = "_given"  # what is appended to a task's name where the product is that it begins with, as a tool reads it
SAME: Final = 1e-3  # share by which volumes and places of parts may differ between a product and the same one as a tool reads it
_SIMULATED: Final = frozenset({".urdf", ".xml", ".mjcf"})


def score_files(tasks: Iterable[tuple[Path, Task]], folder: str | Path) -> list[Row]:
    """Judge files that any tool made: `<folder>/<task>.urdf`, or the one model in `<folder>/<task>/`.

    The model after the task's first edit is at `<task>_edited_1` in place of `<task>`, and so on. The product that a task begins with is built
    from its own plan; a tool that writes its meshes in another way puts it at `<task>_given` as it reads and writes it, without a change.

    Args:
        tasks: Folders and tasks; one without a file is a row with an error.
        folder: Where the files are: URDF, MJCF, FreeCAD documents, plans or runs.
    """
    return [_scored(place, task, Path(folder)) for place, task in tasks]


def _scored(place: Path, task: Task, folder: Path) -> Row:
    row, started = Row.of(task), time.monotonic()
    try:
        judged, product = _judged(task, folder, 0, _given(place, task, folder))
        row = replace(row, judgements=judged)
        try:
            for stage in range(1, len(task.stages)):
                judged, product = _judged(task, folder, stage, product)
                row = replace(row, edited=(*row.edited, judged))
        except ArticadError as error:
            row = replace(row, edit_error=f"{type(error).__name__}: {error}")
    except ArticadError as error:
        row = replace(row, error=f"{type(error).__name__}: {error}")
    return replace(row, seconds=time.monotonic() - started)


def _judged(task: Task, folder: Path, stage: int, before: Assembly | None) -> tuple[tuple[Judgement, ...], Assembly]:
    """Return what is said of a tool's product at a stage, and the product."""
    place = model_of(stage_name(task, stage), folder)
    subject = replace(subject_of(place), before=before)
    return _excused(task.judge(subject, stage), task, place), subject.assembly


def _given(place: Path, task: Task, folder: Path) -> Assembly | None:
    """Return the product that a task begins with: as a tool reads it, if it is the same, else built from its plan.

    Raises:
        ReadError: If what the tool says to have read is another product.
    """
    built = given(place, task, cache=BuildCache())
    if built is None:
        return None
    try:
        found = model_of(f"{task.name}{GIVEN}", folder)
    except ReadError:
        return built
    read = subject_of(found)
    if not same_parts(Subject(built), read, SAME):
        raise ReadError.at(
            found, f"{found} is not the product that {task.name} begins with.", "Put it there as the tool reads it, unchanged."
        )
    return read.assembly


def stage_name(task: Task, stage: int) -> str:
    """Return the name of a task's product at a stage."""
    return f"{task.name}_edited_{stage}" if stage else task.name


def _excused(judgements: tuple[Judgement, ...], task: Task, place: Path) -> tuple[Judgement, ...]:
    """Return judgements that say which checks cannot hold because the format of the file cannot state what they need."""
    form = formats.format_of(place)
    reasons = {} if form is None else unsaid(form.name, asked_for(task))
    return tuple(
        replace(each, measured=f"{each.measured}. {reasons[each.kind]}") if not each.ok and each.kind in reasons else each
        for each in judgements
    )


def model_of(name: str, folder: Path) -> Path:
    """Return the model of a task, or of one of its stages.

    Raises:
        ReadError: If there is none.
    """
    for suffix in formats.readable():
        if (file := folder / f"{name}{suffix}").is_file():
            return file
    place = folder / name
    task, _, stage = name.rpartition("_edited_")
    ours = (folder / task).glob(f"edit_{stage}_*") if task else place.glob("run*")
    for run in (place, *sorted(ours)):
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
