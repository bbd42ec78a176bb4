"""Audits of all models below a folder."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from articad.aliases import Progress
from articad.auditing.examine import AUDITED, AuditOptions, audit_file
from articad.auditing.report import Audit, Scoreboard
from articad.errors import ArticadError
from articad.findings import Finding, Findings
from articad.importers.reading import is_file_name, read_xml


def models_below(folder: Path) -> Iterator[Path]:
    """Yield the URDF, MJCF, FreeCAD and STEP files below a folder; XML that is not MJCF, or that another MJCF includes, is skipped.

    Links that lead out of the folder are skipped too.
    """
    inside = folder.resolve()
    found = (path for path in folder.rglob("*") if path.suffix.lower() in AUDITED and path.is_file())
    files = sorted(path for path in found if path.resolve().is_relative_to(inside))
    included: set[Path] = set()
    mjcf: set[Path] = set()
    for path in files:
        if AUDITED[path.suffix.lower()] != "mjcf":
            continue
        try:
            document = read_xml(path)
        except ArticadError:
            continue  # unreadable XML of an .xml may be anything
        if document.tag == "mujoco":
            mjcf.add(path)
            names = (element.get("file", "") for element in document.iter("include"))
            included |= {(path.parent / name).resolve() for name in names if is_file_name(name)}
    for path in files:
        if AUDITED[path.suffix.lower()] != "mjcf" or (path in mjcf and path.resolve() not in included):
            yield path


def audit_folder(folder: str | Path, choices: AuditOptions | None = None, *, progress: Progress | None = None) -> Scoreboard:
    """Audit every model below a folder; if the auditor itself fails on a file, this is reported and the others continue.

    Args:
        folder: The folder.
        choices: As for one file; meshes may be anywhere below the folder unless a root is given.
        progress: Called with the outcome of each file.
    """
    folder, choices = Path(folder), choices or AuditOptions()
    choices = replace(choices, root=choices.root or folder.resolve())
    audits = []
    for path in models_below(folder):
        name = path.relative_to(folder).as_posix()
        try:
            found = replace(audit_file(path, choices), file=name)
        except Exception as error:  # noqa: BLE001 - one file among hundreds must not end the audit of the others
            found = Audit(name, AUDITED[path.suffix.lower()], findings=Findings([_defect(name, error)]))
        audits.append(found)
        if progress is not None:
            progress(name, "ok" if found.ok else f"{found.count('error')} errors, {found.count('warning')} warnings")
    return Scoreboard(str(folder), tuple(audits))


def _defect(name: str, error: Exception) -> Finding:
    message = f"The audit itself failed: {type(error).__name__}: {error}"
    return Finding(
        code="E_NOT_CHECKED", where=name, message=message[:500], hint="This is a defect of articad, please report it.", stage="audit"
    )
