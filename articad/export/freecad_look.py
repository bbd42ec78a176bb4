"""A document is verified by looking at it: FreeCAD opens it, recomputes, measures, solves, saves, and opens it again.

FreeCAD's own word is not enough. It writes a part whose shape it cannot read again, returns 0 from its solver for such a part,
and leaves the last good shape in a feature that failed. Each shape is therefore compared with what articad measured of the
part, and each placement with the plan's.
"""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from articad.aliases import Json
from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.files import RECORD_BYTES, read_left
from articad.findings import Finding, Findings
from articad.geometry.part import Part
from articad.kernels import freecad_install, sandbox
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from articad.processes import scratch

if TYPE_CHECKING:
    from articad.assembly import Assembly

PROGRAM = Path(freecad_install.__file__).parent / "inside_freecad" / "examine.py"
SAME = 1e-6  # of a volume, relative; of a centre, relative to the part's diagonal
SAME_MESH = 1e-4  # likewise of a mesh: FreeCAD keeps points in single precision
SOLVED_MM, SOLVED_RAD = 1e-6, 1e-8  # by which FreeCAD's solver may move a part
_FAULTS = 5  # of a part that are told
_SECONDS, _SECONDS_A_PART, _SECONDS_A_PAGE = 120.0, 5.0, 60.0
WITH_THREADS = frozenset(sandbox.LAYERS) - {"seccomp"}
"""Layers of the sandbox for a document with drawings: FreeCAD projects views in threads, which seccomp refuses."""


def verify(content: bytes | Mapping[str, bytes], assembly: Assembly, freecad: FreeCAD) -> Findings:
    """Open a document in FreeCAD and compare what is there with the assembly.

    Args:
        content: The document, `.FCStd`, or its files by path, the document itself first.
        assembly: What it is to hold, at rest.
        freecad: The FreeCAD that opens it.

    Returns:
        `E_FREECAD` for each part that is missing, empty, invalid, of another volume or centre, or misplaced, and for each
        object that FreeCAD cannot recompute; `W_FREECAD_SOLVER` if its solver disagrees with the placements.
    """
    version = f"FreeCAD {freecad.version_text}"
    try:
        report = looked(content, freecad, parts=len(assembly.parts))
    except OSError as error:
        return Findings([_error("assembly", f"{version} cannot open the document: {error}.")])
    return judged(report, assembly, freecad)


def judged(report: Json, assembly: Assembly, freecad: FreeCAD) -> Findings:
    """Return the findings of `verify` for what `looked` found."""
    version = f"FreeCAD {freecad.version_text}"
    found = [finding for when, seen in report.items() for finding in _compared(seen, assembly, f"{version}, {_WHEN[when]}")]
    return Findings(_once(found))


_WHEN = {"first": "as written", "again": "saved and opened again"}


def looked(content: bytes | Mapping[str, bytes], freecad: FreeCAD, *, parts: int) -> Json:
    """Return what FreeCAD finds in a document, as written and saved by FreeCAD again.

    Args:
        content: As for `verify`.
        freecad: The FreeCAD that opens it.
        parts: Number of parts, for the time that it may take.

    Raises:
        OSError: If FreeCAD ends without a report; the message is the last line of its output.
    """
    with scratch.folder("freecad") as name:
        folder = Path(name)
        main = Bundle({"it.FCStd": content} if isinstance(content, bytes) else content).write(folder)[0].name
        (folder / "job.json").write_text(json.dumps({"file": main, "steps": [{"do": "verify"}]}))
        drawn = b"TechDraw::DrawPage" in _document(folder / main)
        limits = FreeCADLimits(seconds=_SECONDS + (_SECONDS_A_PAGE if drawn else _SECONDS_A_PART) * parts)
        ended = freecad.run(PROGRAM, folder=folder, limits=limits, layers=WITH_THREADS if drawn else sandbox.LAYERS)
        if not (folder / "report.json").is_file():
            raise OSError("it ran out of time" if ended.late else last_words(ended.said))
        report: Json = json.loads(read_left(folder / "report.json", RECORD_BYTES))
    (step,) = report["steps"]
    return dict(step)


def _document(path: Path) -> bytes:
    """Return the Document.xml of a file, or nothing."""
    try:
        with zipfile.ZipFile(path) as archive:
            return archive.read("Document.xml")
    except (zipfile.BadZipFile, KeyError):
        return b""


def last_words(said: str) -> str:
    """Return the last line that a program wrote, for people."""
    return ([line.strip() for line in said.splitlines() if line.strip()] or ["it printed nothing"])[-1][:300]


def differences(row: Mapping[str, Any] | None, part: Part) -> Iterator[tuple[str, float]]:
    """Yield in which way a shape in FreeCAD is not the part's, and by how much: relative, or 1 for what is not a number."""
    if row is None:
        yield "is missing", 1.0
        return
    solid, mesh = part.solid, part.mesh
    if solid is None and mesh is None:
        return
    if row["kind"] not in ("shape", "mesh"):
        yield "has no shape", 1.0
        return
    if part.mass is not None and row["mass"] is not None:
        yield from _off("mass", row["mass"] - part.mass.mass, part.mass.mass, SAME, "kg")
    if row["kind"] == "mesh":
        volume = 0.0 if mesh is None else abs(mesh.volume)
        yield from _off("volume", abs(row["volume"]) - volume, volume, SAME_MESH, "mm³")
        return
    if not row["valid"] or row["solids"] != 1:
        count = row["solids"]
        what = "is not a valid solid" if count == 1 else "has no solid" if not count else f"has {count} solids, not one"
        yield "; ".join([what, *row.get("faults", ())[:_FAULTS]]), 1.0
        return
    if solid is None:
        return
    diagonal = float(np.linalg.norm(solid.bbox[1] - solid.bbox[0]))
    yield from _off("volume", row["volume"] - solid.volume, solid.volume, SAME, "mm³")
    yield from _off("centre", float(np.linalg.norm(np.asarray(row["center"]) - solid.com)), diagonal, SAME, "mm")


def _off(what: str, difference: float, scale: float, limit: float, unit: str) -> Iterator[tuple[str, float]]:
    relative = abs(difference) / max(scale, 1e-9)
    if not relative <= limit:
        yield f"differs in its {what} by {abs(difference):.6g} {unit}", relative


def _compared(seen: Mapping[str, Any], assembly: Assembly, when: str) -> Iterator[Finding]:
    """Yield what is wrong with a document as it was opened."""
    if seen["invalid"]:
        yield _error("assembly", f"Objects are invalid in {when}: {', '.join(seen['invalid'][:10])}.")
    for page, problems in seen["drawings"].items():
        if problems:
            yield _error("assembly", f"{page} is not complete in {when}: {'; '.join(problems[:5])}.")
    for name, part in assembly.parts.items():
        for stage in ("opened", "recomputed"):
            for problem, value in differences(seen[stage].get(name), part):
                yield _error(f"parts.{name}", f"Part {name!r} {problem} in {when}{'' if stage == 'opened' else ', recomputed'}.", value)
                break
    rest = assembly.at()
    moved = {}
    for name, row in seen["solved"]["parts"].items():
        T = SE3.from_quaternion(row[3:], row[:3])
        far, turned = (
            float(np.linalg.norm(T.translation - rest[name].translation)),
            float(np.linalg.norm((rest[name].inverse() @ T).log()[3:])),
        )
        if far > SOLVED_MM or turned > SOLVED_RAD:
            moved[name] = far
    code = seen["solved"]["code"]
    if code != 0 or moved:
        said = f"returns {code}" if code else f"moves {', '.join(sorted(moved)[:10])}"
        yield Finding(
            code="W_FREECAD_SOLVER",
            where="assembly",
            message=f"The solver of {when}, {said}. The document keeps the placements of the plan.",
            hint="The solver gives up on long chains of hinges, and takes redundant loops for conflicts. The placements are exact.",
            value=max(moved.values(), default=0.0),
            limit=SOLVED_MM,
            unit="mm",
        )


def _once(found: list[Finding]) -> list[Finding]:
    """Return the first finding of each code at each place: the same fault is seen at every look."""
    seen: dict[tuple[str, str], Finding] = {}
    for finding in found:
        seen.setdefault((finding.code, finding.where), finding)
    return list(seen.values())


def _error(where: str, message: str, value: float | None = None) -> Finding:
    parts = (where.removeprefix("parts."),) if where.startswith("parts.") else ()
    hint = "Do not use the document. Export the part as STEP, and report this with the plan and the part's script."
    return Finding(
        code="E_FREECAD", where=where, parts=parts, message=message, hint=hint, value=value, limit=None if value is None else SAME
    )
