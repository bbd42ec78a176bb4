"""Writes a native, editable FreeCAD assembly document.

Every part is an App::Part with its shape and a coordinate system per connector; joints refer to these, so that no face or edge is named.
If the FreeCAD kernel built a part, its body is copied with all features, and its dimensions follow the plan's parameters by expressions.
The features of a part that build123d built are traced from its script (`articad.kernels.trees`); where that is not exact, the part is
copied as B-rep. Derived parts follow their source. Each placement is computed by articad: FreeCAD's solver only checks
whether it agrees (it does not enforce limits or couplings).
"""

from __future__ import annotations

import json
import os
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

from articad.aliases import Json
from articad.errors import ExportError, KernelError, KernelUnavailableError
from articad.export.bundle import Bundle
from articad.export.freecad_file import Appearance, normalised
from articad.export.freecad_job import Job
from articad.export.freecad_look import WITH_THREADS, verify
from articad.export.freecad_native import document
from articad.export.freecad_pages import drawings as drawings_of
from articad.export.freecad_split import content_of_files
from articad.export.freecad_split import split as divided
from articad.export.losses import refuse
from articad.export.product import of_the_product
from articad.files import RECORD_BYTES, read_left
from articad.findings import Finding, Findings
from articad.kernels import freecad_install
from articad.kernels.build123d import Build123dKernel
from articad.kernels.cache import BuildCache
from articad.kernels.freecad import DOCUMENT
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from articad.kernels.trees import PartTree, part_tree
from articad.processes import scratch

if TYPE_CHECKING:
    from articad.assembly import Assembly

PROGRAM = Path(freecad_install.__file__).parent / "inside_freecad" / "document.py"
MOST_OPENED = 500
"""Parts up to which FreeCAD opens what was written: its time to open, recompute and solve grows with the square of their number."""
_SECONDS, _SECONDS_A_PART, _SECONDS_A_PAGE = 120.0, 5.0, 60.0
_PROGRESS = re.compile(r"\(\d+ %\)|^MbD:|^Time = |^Recompute\.")  # lines that FreeCAD always writes


@of_the_product
def write_freecad(
    assembly: Assembly,
    *,
    strict: bool = False,
    freecad: FreeCAD | None = None,
    split: bool = False,
    trees: bool = False,
    drawings: bool = False,
) -> Bundle:
    """Write an assembly as a FreeCAD 1.0 document; FreeCAD 1.1 opens it as well.

    Args:
        assembly: The assembly, written at rest.
        strict: Refuse what FreeCAD cannot hold.
        split: Write one file for each part, and one for the parameters, in a folder beside the document, which links to them.
        drawings: Add a dimensioned page for each part, one of the assembly with balloons and parts list, and an exploded view.
        freecad: The FreeCAD that writes it; by default the installed one. Without FreeCAD, the document is written as by
            `write_freecad_alone`, and by default so is one of more than `MOST_OPENED` parts, unless only FreeCAD can copy its features.
        trees: Give parts whose scripts are written in build123d their feature trees, which are traced, tried at other dimensions, and
            cached, which takes seconds for each part the first time; without them such parts are frozen.

    Returns:
        One file, `<name>.FCStd`, the same bytes each time on the same FreeCAD, and with `split` the files in `<name>_parts`. Where
        FreeCAD wrote it, FreeCAD opened it again: the findings name each part whose shape is not the assembly's, and say whether FreeCAD's solver agrees with the placements.

    Raises:
        UnrepresentableError: If `strict` and something is lost.
        ExportError: If FreeCAD fails.
        KernelUnavailableError: If there is no FreeCAD, and `drawings` is asked for.
    """
    if freecad is None and len(assembly.parts) > MOST_OPENED and not (drawings or trees or _has_features(assembly)):
        return write_freecad_alone(assembly, strict=strict, split=split)
    try:
        freecad = freecad or freecad_install.find()
    except KernelUnavailableError:
        if drawings:
            raise
        return write_freecad_alone(assembly, strict=strict, split=split)
    with scratch.folder("freecad") as name:
        folder = Path(name)
        job = Job(assembly, folder, trees=_trees(assembly, freecad) if trees else None)
        content_of_job = job.to_json()
        (folder / "job.json").write_text(json.dumps(content_of_job))
        if strict:
            refuse(job.losses)
        seconds = _SECONDS + _SECONDS_A_PART * len(assembly.parts)
        ended = freecad.run(PROGRAM, folder=folder, limits=FreeCADLimits(seconds=seconds))
        if not ended.ok or not (folder / "report.json").is_file():
            raise _failed(ended.said, late=ended.late)
        report = json.loads(read_left(folder / "report.json", RECORD_BYTES))
        drawn = _drawn(assembly, content_of_job, folder, freecad) if drawings else {"hidden": [], "providers": {}}
        content = read_left(folder / "assembly.FCStd", RECORD_BYTES)
    hidden = (*report["hidden"], *drawn["hidden"])
    look = Appearance(report["colors"], hidden, tuple(report["joints"]), report["grounded"], tuple(report["tips"]), drawn["providers"])
    files = _files(job.name, content, look, split=split)
    # FreeCAD 1.1 measures some dimensions of curved parts otherwise than 1.0
    others = [other for other in freecad_install.installed() if drawings and other != freecad]
    findings = [finding for version in (freecad, *others) for finding in verify(files, assembly, version)]
    return Bundle(files, job.losses, Findings(findings))


def _drawn(assembly: Assembly, job: Json, folder: Path, freecad: FreeCAD) -> Json:
    """Let FreeCAD add drawings to the document in a folder; return what it reports of them."""
    (folder / "drawings.json").write_text(json.dumps(drawings_of(assembly, job)))
    limits = FreeCADLimits(seconds=_SECONDS + _SECONDS_A_PAGE * len(assembly.parts))
    ended = freecad.run(PROGRAM.with_name("drawings.py"), folder=folder, limits=limits, layers=WITH_THREADS)
    if not ended.ok or not (folder / "drawn.json").is_file():
        raise _failed(ended.said, late=ended.late)
    report: Json = json.loads(read_left(folder / "drawn.json", RECORD_BYTES))
    return report


def _has_features(assembly: Assembly) -> bool:
    """Return whether FreeCAD built a part, so that the document can have its features."""
    return any((realised.built.folder / DOCUMENT).is_file() for realised in assembly.realised.values())


def _trees(assembly: Assembly, freecad: FreeCAD) -> dict[str, PartTree]:
    """Return the feature trees of all parts that build123d scripts built."""
    resolved, kernel = assembly.resolved, Build123dKernel()
    if resolved is None:
        return {}

    def made(name: str) -> PartTree:
        realised = assembly.realised[name]
        assert realised.script is not None
        cache = BuildCache(realised.built.folder.parent)
        try:
            return part_tree(resolved.parts[name], realised.built, realised.script, kernel=kernel, freecad=freecad, cache=cache)
        except KernelError as error:
            return PartTree(None, str(error))

    names = [
        name
        for name, realised in assembly.realised.items()
        if name in resolved.parts and realised.script is not None and not (realised.built.folder / DOCUMENT).is_file()
    ]
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        return dict(zip(names, pool.map(made, names), strict=True))


@of_the_product
def write_freecad_alone(assembly: Assembly, *, strict: bool = False, split: bool = False) -> Bundle:
    """Write an assembly as a FreeCAD 1.0 document without FreeCAD: every shape as B-rep, the rest as `write_freecad` does.

    Args:
        assembly: The assembly, written at rest.
        strict: Refuse what FreeCAD cannot hold.
        split: As for `write_freecad`.

    Returns:
        The files of `write_freecad`, the same bytes on every machine; a finding says that FreeCAD did not check it.

    Raises:
        UnrepresentableError: If `strict` and something is lost.
    """
    with scratch.folder("freecad") as name:
        job = Job(assembly, Path(name), features=False)
        content, look = document(job.to_json(), Path(name), job.names)
    if strict:
        refuse(job.losses)
    return Bundle(_files(job.name, content, look, split=split), job.losses, Findings([_unseen(len(assembly.parts))]))


def _unseen(parts: int) -> Finding:
    """Return the finding that FreeCAD did not check a document, and how to let it."""
    message = "The document was written without FreeCAD: its shapes are B-rep, and FreeCAD's solver did not check it."
    hint = f"{freecad_install.HOW_TO_GET}."
    if parts > MOST_OPENED:
        message = f"{message} FreeCAD's time grows with the square of the number of parts, {parts} here; up to {MOST_OPENED} are checked."
        hint = "Open it in FreeCAD to check it, or call write_freecad(assembly, freecad=articad.kernels.freecad_install.find())."
    return Finding(code="I_FREECAD_UNSEEN", where="assembly", message=message, hint=hint)


def _files(name: str, content: bytes, look: Appearance, *, split: bool) -> dict[str, bytes]:
    """Return the files of a document as it was written, the main one first."""
    if not split:
        return {f"{name}.FCStd": normalised(content, look)}
    files = divided(content, f"{name}_parts")
    written = content_of_files(files)
    return {path or f"{name}.FCStd": normalised(held, look, written) for path, held in files.items()}


def _failed(said: str, *, late: bool) -> ExportError:
    lines = [line.strip() for line in said.splitlines() if not _PROGRESS.search(line) and line.strip()]
    words = "it ran out of time" if late else (lines or ["it gave no reason"])[-1][:300]
    finding = Finding(
        code="E_FREECAD", where="assembly", message=f"FreeCAD could not write the document: {words}.", hint="Run articad doctor."
    )
    return ExportError(str(finding), findings=[finding])
