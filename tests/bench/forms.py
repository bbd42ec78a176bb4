"""Assemblies as files of other tools state them: written, and read again without the records that articad leaves in its own files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final, Literal

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.mjcf import read_mjcf
from articad.importers.urdf import read_urdf
from articad_bench.cheat_run import COSTLY
from articad_bench.subject import Subject
from articad_bench.task import Task
from articad_bench.unsaid import Asked, asked_for, unsaid

Form = Literal["urdf", "mjcf"]
FORMS: Final[tuple[Form, ...]] = ("urdf", "mjcf")


def refused(task: Task, subject: Subject) -> list[str]:
    """Return what the checks say that do not hold, but for those that take minutes."""
    return [str(judged) for check in task.checks if check.kind not in COSTLY and not (judged := check.judge(subject)).ok]


def as_file(assembly: Assembly, form: Form, folder: Path) -> Assembly:
    """Return what a file of an assembly states. The assembly must rest at zero: URDF states no other pose."""
    if form == "urdf":
        files = write_urdf(assembly, collision="solid").write(folder)
    else:
        files = write_mjcf(assembly, collision="solid", actuators="position").write(folder)
    (file,) = (path for path in files if path.suffix in {".urdf", ".xml"})
    read: Callable[..., Assembly] = {"urdf": read_urdf, "mjcf": read_mjcf}[form]
    return read(file, metadata=False, fuse=True)


def sayable(task: Task, assembly: Assembly, form: Form) -> Task:
    """Return a task without the checks that no file of a form can meet, by the rules of `articad_bench.unsaid` alone."""
    loops: set[Asked] = {"loop"} if assembly.mechanism.loop_joints else set()
    left_out = unsaid(form, asked_for(task) | loops)
    return task.model_copy(update={"checks": tuple(check for check in task.checks if check.kind not in left_out)})
