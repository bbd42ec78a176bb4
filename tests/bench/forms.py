"""Assemblies as files of other tools state them: written, and read again without the records that articad leaves in its own files."""

from __future__ import annotations

import re
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from articad.assembly import Assembly
from articad.export.freecad import write_freecad_alone
from articad.formats import NAMED
from articad_bench.cheat_run import COSTLY
from articad_bench.subject import Subject
from articad_bench.task import Task
from articad_bench.unsaid import Asked, Format, asked_for, unsaid

FORMS: Final[tuple[Format, ...]] = ("urdf", "mjcf", "freecad", "step")
_SAID: Final[dict[str, Any]] = {"collision": "solid", "actuators": "position"}
"""Options of writers; a format ignores those that it does not have."""


def refused(task: Task, subject: Subject) -> list[str]:
    """Return what the checks say that do not hold, but for those that take minutes."""
    cheap = tuple(check for check in task.checks if check.kind not in COSTLY)
    return [str(judged) for judged in task.model_copy(update={"checks": cheap}).judge(subject) if not judged.ok]


def as_file(assembly: Assembly, form: Format, folder: Path) -> Assembly:
    """Return what a file of an assembly states. The assembly must rest at zero: URDF states no other pose."""
    known = replace(NAMED[form], writer=write_freecad_alone) if form == "freecad" else NAMED[form]
    bundle = known.write(assembly, **_SAID)
    bundle.write(folder)
    if form == "freecad":
        switch_on(folder / bundle.main)
    return known.read(folder / bundle.main, metadata=False, fuse=True)


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
