"""Reference solutions of tasks: our own plans, which prove that a task can be done, and what its pictures are drawn from."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from articad import examples
from articad.assembly import Assembly
from articad.errors import ReadError
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache, PartKernel
from articad.kernels.parts import SCRIPT_SUFFIX, read_script
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad_bench.task import Task

_EXAMPLE: Final = "example:"


def reference_folder(folder: Path, task: Task) -> Path:
    """Return the folder of a task's reference solution.

    Raises:
        ReadError: If it has none, or a link is in its place.
    """
    if task.reference is None:
        raise ReadError.at(folder, f"{task.name} has no reference solution.", "Give it one: reference/plan.json and reference/parts/.")
    if task.reference.startswith(_EXAMPLE):
        return examples.folder(task.reference.removeprefix(_EXAMPLE))
    return _own(folder / task.reference)


def _own(place: Path) -> Path:
    """Return a folder of a task, which is no link.

    Raises:
        ReadError: If it is one.
    """
    if place.is_symlink():
        raise ReadError.at(place, f"{place} is a link.", "Copy the folder there.")
    return place


def reference(folder: Path, task: Task, *, cache: BuildCache | None = None, kernel: PartKernel | None = None) -> Assembly:
    """Build a task's reference solution.

    Raises:
        ArticadError: If it has none, or it does not build.
    """
    place = reference_folder(folder, task)
    plan = AssemblyPlan.load(place)
    return Assembly.from_plan(plan, place / "parts", cache=cache, kernel=kernel or kernel_named(plan.kernel))


def edited_reference(
    folder: Path, task: Task, before: Assembly, *, cache: BuildCache | None = None, kernel: PartKernel | None = None
) -> Assembly:
    """Build the reference solution after the task's edit.

    Args:
        folder: Of the task.
        task: One with an edit.
        before: Its reference as it is.
        cache: Keeps built parts.
        kernel: Builds the scripts of a second plan; what it names by default.

    Raises:
        ArticadError: If the task says neither `values` nor a second plan, or it does not build.
    """
    edit = task.edit
    if edit is None or not (edit.values or edit.reference):
        raise ReadError.at(folder, f"{task.name} has no edit that its reference makes.", "Give edit.values or edit.reference.")
    if edit.reference is None:
        return before.with_parameters(**edit.values)
    place = _own(folder / edit.reference)
    plan = AssemblyPlan.load(place)
    kernel = kernel or kernel_named(plan.kernel)
    scripts = _scripts((place / "parts", reference_folder(folder, task) / "parts"), plan, kernel)
    return Assembly.from_plan(plan, scripts, cache=cache, kernel=kernel, parameters=edit.values)


def _scripts(folders: Sequence[Path], plan: AssemblyPlan, kernel: PartKernel) -> dict[str, bytes]:
    """Return the script of each part that is not derived, from the first folder that has one."""
    suffix = SCRIPT_SUFFIX[kernel.name]
    names = [name for name, part in resolve(plan).parts.items() if part.derivation is None]
    files = {name: next((file for folder in folders if (file := folder / f"{name}{suffix}").is_file()), None) for name in names}
    return {name: read_script(file, file.parents[1]) for name, file in files.items() if file is not None}
