"""Assemblies as files of other tools state them: written, and read again without the records that articad leaves in its own files."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from articad.assembly import Assembly
from articad.export.freecad import write_freecad_alone
from articad.export.mjcf import write_mjcf
from articad.export.step import write_step
from articad.export.urdf import write_urdf
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.step import read_step
from articad.importers.urdf import read_urdf
from articad_bench.cheat_run import COSTLY
from articad_bench.subject import Subject
from articad_bench.task import Task
from articad_bench.unsaid import Asked, Format, asked_for, unsaid

FORMS: Final[tuple[Format, ...]] = ("urdf", "mjcf", "freecad", "step")
_WRITTEN: Final[dict[Format, tuple[Callable[..., Any], dict[str, Any]]]] = {
    "urdf": (write_urdf, {"collision": "solid"}),
    "mjcf": (write_mjcf, {"collision": "solid", "actuators": "position"}),
    "freecad": (write_freecad_alone, {}),
    "step": (write_step, {}),
}
_READ: Final[dict[Format, tuple[Callable[..., Assembly], dict[str, Any]]]] = {
    "urdf": (read_urdf, {"metadata": False, "fuse": True}),
    "mjcf": (read_mjcf, {"metadata": False, "fuse": True}),
    "freecad": (read_freecad, {"metadata": False}),
    "step": (read_step, {}),
}
_SUFFIXES: Final = {".urdf", ".xml", ".FCStd", ".step"}


def refused(task: Task, subject: Subject) -> list[str]:
    """Return what the checks say that do not hold, but for those that take minutes."""
    cheap = tuple(check for check in task.checks if check.kind not in COSTLY)
    return [str(judged) for judged in task.model_copy(update={"checks": cheap}).judge(subject) if not judged.ok]


def as_file(assembly: Assembly, form: Format, folder: Path) -> Assembly:
    """Return what a file of an assembly states. The assembly must rest at zero: URDF states no other pose."""
    (write, options), (read, more) = _WRITTEN[form], _READ[form]
    (file,) = (path for path in write(assembly, **options).write(folder) if path.suffix in _SUFFIXES)
    if form == "freecad":
        switch_on(file)
    return read(file, **more)


def switch_on(file: Path) -> None:
    """Switch the gears, racks and screws of a FreeCAD document on: articad writes them switched off, for FreeCAD solves them otherwise."""
    rewrite(file, rb'(name="Activated"[^>]*>\s*<Bool value=")false', rb"\g<1>true")


def rewrite(file: Path, pattern: bytes, by: bytes) -> None:
    """Replace what a FreeCAD document says, wherever a pattern is found in it."""
    with zipfile.ZipFile(file) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    members["Document.xml"] = re.sub(pattern, by, members["Document.xml"])
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)


def sayable(task: Task, assembly: Assembly, form: Format) -> Task:
    """Return a task without the checks that no file of a form can meet, by the rules of `articad_bench.unsaid` alone."""
    built: set[Asked] = {"loop"} if assembly.mechanism.loop_joints else set()
    if any(coupling.kind == "linear" for coupling in assembly.mechanism.couplings):
        built.add("linear")
    left_out = unsaid(form, asked_for(task) | built)
    return task.model_copy(update={"checks": tuple(check for check in task.checks if check.kind not in left_out)})
