"""Reference solutions of tasks: our own plans, which prove that a task can be done, and what its pictures are drawn from.

A stage of a task has a folder with what its reference has of its own. What that lacks is in the folder of the stage before.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

from articad import examples
from articad.assembly import Assembly
from articad.errors import ReadError
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache, PartKernel
from articad.kernels.parts import script_file, script_of
from articad.plan.resolve import resolve
from articad.plan.schema import PLAN_FILE, AssemblyPlan
from articad_bench.task import Task

_EXAMPLE: Final = "example:"


def reference_folder(folder: Path, task: Task) -> Path:
    """Return the folder of a task's reference solution.

    Raises:
        ReadError: If it has none, or a link is in its place.
    """
    if task.reference is None:
        raise ReadError.at(folder, f"{task.name} has no reference solution.", "Give it one: reference/plan.json and reference/parts/.")
    return _own(folder, task.reference)


def given_folder(folder: Path, task: Task) -> Path | None:
    """Return the folder of the product that a task begins with; None if it begins with nothing.

    Raises:
        ReadError: If a link is in its place.
    """
    return None if task.given is None else _own(folder, task.given)


def reference_folders(folder: Path, task: Task) -> list[Path]:
    """Return the folders that a task's products are built from: the given one, the reference and its edits, as far as there are any.

    Raises:
        ReadError: If a link is in the place of one.
    """
    if task.reference is None:
        return []
    edits = [_own(folder, edit.reference) for edit in task.edits if edit.reference is not None]
    return list(dict.fromkeys([*reversed(_folders(folder, task)), *edits]))


def _own(folder: Path, name: str) -> Path:
    """Return a folder of a task, which is no link, or that of an example.

    Raises:
        ReadError: If it is one.
    """
    if name.startswith(_EXAMPLE):
        return examples.folder(name.removeprefix(_EXAMPLE))
    place = folder / name
    if place.is_symlink():
        raise ReadError.at(place, f"{place} is a link.", "Copy the folder there.")
    return place


def reference_plan(folder: Path, task: Task) -> AssemblyPlan:
    """Return the plan of a task's reference solution.

    Raises:
        ArticadError: If it has none.
    """
    return _plan(_folders(folder, task))


def reference(
    folder: Path,
    task: Task,
    *,
    scripts: Mapping[str, str] | None = None,
    cache: BuildCache | None = None,
    kernel: PartKernel | None = None,
) -> Assembly:
    """Build a task's reference solution, as it is at first.

    Args:
        folder: Of the task.
        task: The task.
        scripts: Scripts of parts in place of its own.
        cache: Keeps built parts.
        kernel: Builds the scripts; what the plan names by default.

    Raises:
        ArticadError: If it has none, or it does not build.
    """
    return _built(_folders(folder, task), {}, cache, kernel, scripts)


def reference_scripts(folder: Path, task: Task) -> dict[str, str]:
    """Return the script of each part that the reference solution has of its own, by the part's name.

    Raises:
        ArticadError: If it has no reference, or one of its files cannot be read.
    """
    plan, place = reference_plan(folder, task), reference_folder(folder, task) / "parts"
    return {name: script.decode() for name, script in _scripts([place], plan, kernel_named(plan.kernel)).items()}


def given(folder: Path, task: Task, *, cache: BuildCache | None = None, kernel: PartKernel | None = None) -> Assembly | None:
    """Build the product that a task begins with; None if it begins with nothing.

    Raises:
        ArticadError: If it does not build.
    """
    place = given_folder(folder, task)
    return None if place is None else _built([place], {}, cache, kernel)


def references(folder: Path, task: Task, *, cache: BuildCache | None = None, kernel: PartKernel | None = None) -> Iterator[Assembly]:
    """Build a task's reference solution at each stage: as it is at first, and after each edit.

    Args:
        folder: Of the task.
        task: The task.
        cache: Keeps built parts.
        kernel: Builds the scripts; what the plans name by default.

    Raises:
        ArticadError: If an edit says neither `values` nor another folder, or a stage does not build.
    """
    folders = _folders(folder, task)
    built = _built(folders, {}, cache, kernel)
    yield built
    for number, edit in enumerate(task.edits, start=1):
        if not (edit.values or edit.reference):
            raise ReadError.at(folder, f"The reference of {task.name} does not make edit {number}.", "Give its values or its reference.")
        if edit.reference is None:
            built = built.with_parameters(**edit.values)
        else:
            folders = [_own(folder, edit.reference), *folders]
            built = _built(folders, edit.values, cache, kernel)
        yield built


def _folders(folder: Path, task: Task) -> list[Path]:
    """Return the folders of the first stage: the reference's own, and that of the given product."""
    begun = given_folder(folder, task)
    return [reference_folder(folder, task)] if begun is None else [reference_folder(folder, task), begun]


def _plan(folders: Sequence[Path]) -> AssemblyPlan:
    """Return the plan of the first folder that has one."""
    return AssemblyPlan.load(next((folder for folder in folders if (folder / PLAN_FILE).exists()), folders[0]))


def _built(
    folders: Sequence[Path],
    values: Mapping[str, float],
    cache: BuildCache | None,
    kernel: PartKernel | None,
    changed: Mapping[str, str] | None = None,
) -> Assembly:
    plan = _plan(folders)
    kernel = kernel or kernel_named(plan.kernel)
    scripts = _scripts([folder / "parts" for folder in folders], plan, kernel)
    scripts |= {name: text.encode() for name, text in (changed or {}).items()}
    return Assembly.from_plan(plan, scripts, cache=cache, kernel=kernel, parameters=values or None)


def _scripts(folders: Sequence[Path], plan: AssemblyPlan, kernel: PartKernel) -> dict[str, bytes]:
    """Return the script of each part that is not derived, from the first folder that has one."""
    found: dict[str, bytes] = {}
    for name, part in resolve(plan).parts.items():
        if part.derivation is None:
            place = next((folder for folder in folders if script_file(folder, name, kernel.name).exists()), folders[0])
            if (script := script_of(place, part, kernel.name)) is not None:
                found[name] = script
    return found
