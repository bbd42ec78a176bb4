"""FreeCAD assemblies from public repositories: what articad reads, beside what FreeCAD finds in them.

ARTICAD_FREECAD_DOCUMENTS=FOLDER .venv/bin/python -m tests.freecad.public_documents [NAME …]

compares each document with each FreeCAD here that can open it, and writes docs/reference/freecad-documents.md. The folder holds a checkout of
each repository below, at its commit, as `OWNER/NAME`. `--list` prints the commands that make them. Nothing of them is kept in this repository, for their licences differ.
"""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.geometry.part import Part
from articad.importers.freecad import read_freecad
from articad.importers.freecad_constraints import CONSTRAINTS
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from articad.kinematics.joints import Joint

Json = dict[str, Any]

ROOT: Final = Path(__file__).resolve().parents[2]
PAGE: Final = ROOT / "docs" / "reference" / "freecad-documents.md"
PROGRAM: Final = Path(__file__).with_name("public_by_freecad.py")
FOLDER: Final = os.environ.get("ARTICAD_FREECAD_DOCUMENTS", "")
SECONDS: Final = 600.0
SAME_MM, SAME_RAD = 1e-5, 1e-8  # poses and frames, for documents whose joints hold: the solver of FreeCAD leaves gaps of 3e-6 mm
SAME: Final = 1e-6  # volume and mass, relative; centres and inertias, relative to the size
SAME_MESH: Final = 2e-2  # likewise of parts of several solids, which articad keeps as meshes of 0.01 mm


@dataclass(frozen=True)
class Document:
    """A public document.

    Attributes:
        name: Name in the table.
        repository: Repository on GitHub.
        commit: Its commit or tag.
        path: The document in it.
        refused: What the message names if articad refuses the document; empty if it is read.
    """

    name: str
    repository: str
    commit: str
    path: str
    refused: str = ""

    @property
    def file(self) -> Path:
        """The document on this machine."""
        return Path(FOLDER) / self.repository / self.path


DOCUMENTS: Final = (
    Document("AssemblyExample", "FreeCAD/FreeCAD", "1.0.0", "data/examples/AssemblyExample.FCStd"),
    Document("GitCAD", "Mikestriken/GitCAD", "f97e79afad972a36eddf4d7115f0838ab4686f41", "FreeCAD_Automation/tests/AssemblyExample.FCStd"),
    Document(
        "universal_joint",
        "AnesBenmerzoug/FreeCAD-Assembly2MuJoCo",
        "406f0d6d4152dfa224166bb492a0d231d27cc783",
        "examples/universal_joint/universal_joint_assembly.FCStd",
    ),
    Document(
        "crank_and_slider",
        "AnesBenmerzoug/FreeCAD-Assembly2MuJoCo",
        "406f0d6d4152dfa224166bb492a0d231d27cc783",
        "examples/crank_and_slider/crank_and_slider_assembly.FCStd",
        "1.206° askew",
    ),
    Document("AstroCameraMount", "zayats1/AstroCameraMountModel", "70ab85c79e45d8714466095a058f98ba860f09b4", "Assembly.FCStd"),
    Document("IntoTheDeepClaws", "drwho495/IntoTheDeepClaws", "1a7603d35a32066befb73656aad72735da90851d", "AssemblyWBAssembly.FCStd"),
    Document("RobotAssembly", "drwho495/TEC_2025_Robot", "4ff57c1f0834f3d10f90ab0d1650c9a74015c15c", "cad/RobotAssembly.FCStd"),
    Document("cyberDeck", "ksergey/cyberDeck_v2", "46abaec8ad76c9e790bd91bd2964f0be95d46454", "Assembly.FCStd"),
    Document(
        "FieldAssembly",
        "drwho495/TEC_2025_Robot",
        "4ff57c1f0834f3d10f90ab0d1650c9a74015c15c",
        "cad/FieldAssembly.FCStd",
        "Motor_Mount_Left",
    ),
    Document("pan-tilt", "markuskjeldsen/pan-tilt-mechanism", "d583facae4b39ecd4e28cc686877f338bcccb1e3", "assembly_2.FCStd", "Gears001"),
    Document("stepper_cad", "hacker-fab/stepper_cad", "e6243f6b86cb3dea422a3c2ddf54162266db6926", "assembly.FCStd", "Fixed001"),
)


class Compared(NamedTuple):
    """What articad reads of a document beside what FreeCAD finds.

    Attributes:
        parts: Number of parts in FreeCAD.
        solids: Number of solids in FreeCAD.
        joints: Number of active joints in FreeCAD.
        masses: Number of parts with a stated mass.
        differences: What differs, in words, each with the part or joint.
        mm: Largest distance of a part, a centre or a joint's frame from where FreeCAD has it [mm].
        named: Codes of the reader's findings, each with its number.
        solver: What FreeCAD's solver does with the document.
    """

    parts: int
    solids: int
    joints: int
    masses: int
    differences: tuple[str, ...]
    mm: float
    named: tuple[str, ...]
    solver: str


def seen(document: Path, freecad: FreeCAD) -> Json:
    """Return what FreeCAD finds in a document and the files that it links to.

    Raises:
        OSError: If FreeCAD ends without a report.
    """
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        shutil.copytree(document.parent, folder / "files", ignore=lambda _, names: {name for name in names if name == ".git"})
        (folder / "job.json").write_text(json.dumps({"file": f"files/{document.name}"}))
        ended = freecad.run(PROGRAM, folder=folder, limits=FreeCADLimits(seconds=SECONDS))
        if not (folder / "report.json").is_file():
            raise OSError("it ran out of time" if ended.late else ended.said[-400:])
        report: Json = json.loads((folder / "report.json").read_text())
    return report


def compared(made: Assembly, report: Json) -> Compared:
    """Compare an assembly with what FreeCAD found in the document.

    Args:
        made: The assembly that articad read.
        report: What `seen` returned.
    """
    off: list[str] = []
    far = 0.0
    poses = made.at()
    named = {where.removeprefix("parts.") for finding in made.findings for where in (finding.where, *finding.parts)}
    apart = any(finding.code == "W_FREECAD_APART" for finding in made.findings)
    if len(report["parts"]) != len(made.parts):
        off.append(f"{len(made.parts)} parts, {len(report['parts'])} in FreeCAD")
    for row, (name, part) in zip(report["parts"], made.parts.items(), strict=False):
        if not name.startswith(_plain(row["label"])):
            off.append(f"{name} is {row['label']} in FreeCAD")
        T = poses[name]
        distance, turn = _between(T, _pose(row["pose"]))
        if (distance > SAME_MM or turn > SAME_RAD) and not apart:
            off.append(f"{name} stands {distance:.3g} mm and {math.degrees(turn):.3g}° off")
        shape_off, centre = _shape(part, T, row["solids"])
        if shape_off and name not in named:
            off.append(f"{name} {shape_off}")
        far = max(far, distance, centre if name not in named else 0.0)
        stated = row["densities"]
        density = stated[0] if len(stated) == 1 else 0.0
        mass = density * 1e-9 * sum(solid["volume"] for solid in row["solids"])
        held = 0.0 if part.mass is None else part.mass.mass
        if len(stated) <= 1 and abs(mass - held) > SAME * max(mass, held) and name not in named:
            off.append(f"{name} has {held:.6g} kg, {mass:.6g} kg in FreeCAD")
    joint_off, joint_far = _joints(made, report["joints"], poses, apart=apart)
    moved = max(
        (_between(_pose(row["pose"]), _pose(solved))[0] for row, solved in zip(report["parts"], report["solved"], strict=True)), default=0.0
    )
    return Compared(
        parts=len(report["parts"]),
        solids=sum(len(row["solids"]) for row in report["parts"]),
        joints=len(report["joints"]),
        masses=sum(part.mass is not None for part in made.parts.values()),
        differences=(*off, *joint_off),
        mm=max(far, joint_far),
        named=tuple(f"{len(made.findings.of(code))} {code}" for code in dict.fromkeys(made.findings.codes)),
        solver=f"{report['code']}, moves {moved:.1g} mm" if moved > SAME_MM else f"{report['code']}",
    )


def _shape(part: Part, T: SE3, solids: list[Json]) -> tuple[str, float]:
    """Return in which way a part's shapes differ from FreeCAD's solids, and how far its centre is off [mm]."""
    shapes = [] if part.solid is not None else list(part.visuals)
    if len(solids) != (1 if part.solid is not None else len(shapes)):
        return f"has {1 if part.solid is not None else len(shapes)} solids, {len(solids)} in FreeCAD", 0.0
    worst = 0.0
    rows = (
        [(part.solid.volume, part.solid.com, part.solid.inertia_mm5, SAME)]
        if part.solid is not None
        else [(volume, com, inertia, SAME_MESH) for volume, com, inertia, *_ in (shape.placed.solid_integrals() for shape in shapes)]
    )
    for (volume, com, inertia, same), solid in zip(rows, solids, strict=True):
        size = max(solid["volume"], 1e-9) ** (1 / 3)
        if abs(volume - solid["volume"]) > same * solid["volume"]:
            return f"has {volume:.9g} mm³, {solid['volume']:.9g} mm³ in FreeCAD", worst
        far = float(np.linalg.norm(T.apply(np.asarray(com, dtype=np.float64)[None])[0] - np.asarray(solid["center"])))
        worst = max(worst, far)
        if far > same * max(size, 1.0) * 10:
            return f"has its centre {far:.3g} mm off", worst
        turned = T.rotation @ np.asarray(inertia, dtype=np.float64) @ T.rotation.T
        if float(np.linalg.norm(turned - np.asarray(solid["inertia"]))) > 10 * same * float(np.linalg.norm(turned)):
            return "has another inertia", worst
    return "", worst


def _joints(made: Assembly, rows: list[Json], poses: Any, *, apart: bool) -> tuple[list[str], float]:
    """Return which joints of FreeCAD have no joint or coupling in the assembly whose parts and frames are theirs, and the largest distance [mm].

    Two joints of FreeCAD between the same two parts are one joint here, if one of them only restricts the other.
    """
    off, worst, names = [], 0.0, list(made.parts)
    held = {joint.name: joint for joint in made.joints}
    couplings = {coupling.name for coupling in made.mechanism.couplings}
    restricted = [set(row["parts"]) for row in rows if row["type"] in CONSTRAINTS]
    for row in rows:
        joint = held.get(_plain(row["label"]))
        if joint is None:
            if _plain(row["label"]) not in couplings and row["type"] not in CONSTRAINTS and set(row["parts"]) not in restricted:
                off.append(f"joint {row['label']} ({row['type']}) is missing")
            continue
        parts = tuple(names[number] for number in row["parts"] if number is not None and number < len(names))
        if not set(parts) <= {joint.parent, joint.child}:
            off.append(f"joint {row['label']} connects {joint.parent} and {joint.child}, in FreeCAD {' and '.join(parts)}")
        for T, frame in zip(_frames(joint, poses), row["frames"], strict=True):
            expected = _pose(frame)
            distance = float(np.linalg.norm(T.translation - expected.translation))
            tilt = float(np.linalg.norm(np.cross(T.rotation[:, 2], expected.rotation[:, 2])))
            if apart or set(row["parts"]) in restricted:
                continue
            worst = max(worst, distance)
            if distance > SAME_MM or tilt > SAME_RAD:
                off.append(f"joint {row['label']} has a frame {distance:.3g} mm and {math.degrees(tilt):.3g}° off")
    return off, worst


def _frames(joint: Joint, poses: Any) -> tuple[SE3, SE3]:
    return poses[joint.parent] @ joint.T_parent_connector, poses[joint.child] @ joint.T_child_connector


def _between(one: SE3, other: SE3) -> tuple[float, float]:
    D = one.inverse() @ other
    return float(np.linalg.norm(D.translation)), float(np.linalg.norm(D.log()[3:]))


def _pose(rows: list[list[float]]) -> SE3:
    return SE3.from_matrix(np.asarray(rows, dtype=np.float64))


def _plain(text: str) -> str:
    name = re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")
    return name if name[:1].isalpha() else f"n{name}"


def version_of(path: Path) -> tuple[int, int]:
    """Return the version of FreeCAD that wrote a document."""
    with zipfile.ZipFile(path) as archive:
        found = re.search(rb'ProgramVersion="(\d+)\.(\d+)', archive.read("Document.xml"))
    assert found is not None, path
    return int(found[1]), int(found[2])


def read(document: Document) -> Assembly | str:
    """Return the assembly of a document with its poses solved, or the message that refuses it."""
    made = None
    try:
        made = read_freecad(document.file)
        made.at()
    except ArticadError as error:
        findings = [*error.findings, *(made.findings.of("W_FREECAD_APART") if made is not None else ())]
        return "; ".join(f"{finding.where}: {finding.message}" for finding in findings) or error.message
    return made


# ---------------------------------------------------------------------- the page

HEAD: Final = """\
# FreeCAD documents from public repositories

<!-- Written by tests/freecad/public_documents.py, which opens every document; do not edit. -->

Assemblies that people made with FreeCAD, read by articad and opened by FreeCAD. *Compared* are the parts; the volume, centre and inertia of each solid; the
pose of each part; both frames of each joint; and the mass of each part whose material FreeCAD's library has with a density. The column *largest distance* is how far
anything stands from where FreeCAD has it; parts of several solids are read as meshes, whose centres are a thousandth of a millimetre off. A document that articad refuses is in the table with the message. The solver's column states what FreeCAD's `solve()`
returns, and how far it then moves a part: articad reads the document as it was saved.
"""


def page(names: list[str]) -> tuple[str, list[str]]:
    """Return the page, and what is wrong. Rows of documents that are not named are kept from the page."""
    wrong: list[str] = []
    held = PAGE.read_text().splitlines() if names and PAGE.is_file() else []
    rows: list[str] = []
    for document in DOCUMENTS:
        if names and document.name not in names:
            rows += [line for line in held if line.startswith(f"| {document.name} |")]
            continue
        made = read(document)
        for freecad in able(document):
            row, off = _row(document, made, freecad)
            rows.append(row)
            wrong += off
            sys.stderr.write("\n".join([row, *off, ""]))
    table = [
        "| document | FreeCAD | parts | solids | joints | masses | largest distance | articad | solver |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    sources = [
        f"- {document.name}: `{document.path}` of [{document.repository}](https://github.com/{document.repository}), at {document.commit[:12]}"
        for document in DOCUMENTS
    ]
    return "\n".join([HEAD, *table, *rows, "", "The documents:", "", *sources]) + "\n", wrong


def able(document: Document) -> list[FreeCAD]:
    """Return the FreeCADs here that can open a document: 1.0 cannot open those of 1.1."""
    least = version_of(document.file)
    return [freecad for freecad in freecad_install.installed() if freecad.version is not None and freecad.version[:2] >= least]


def judge(document: Document, made: Assembly | str, report: Json) -> tuple[Compared | None, list[str]]:
    """Return what was compared, and what is wrong with the outcome: a difference without a name, an empty assembly, or an unexpected refusal."""
    if isinstance(made, str):
        named = document.refused and document.refused in made
        return None, [] if named else [f"{document.name} is refused without the name of {document.refused or 'a reason'}: {made}"]
    if document.refused:
        return None, [f"{document.name} is read, although its {document.refused} ought to be refused"]
    found = compared(made, report)
    empty = [] if found.solids and made.parts and made.joints else [f"{document.name} is an empty robot"]
    return found, [*empty, *(f"{document.name}: {difference}" for difference in found.differences)]


def _row(document: Document, made: Assembly | str, freecad: FreeCAD) -> tuple[str, list[str]]:
    report = seen(document.file, freecad)
    found, wrong = judge(document, made, report)
    solids = sum(len(row["solids"]) for row in report["parts"])
    counts = f"{len(report['parts'])} | {solids} | {len(report['joints'])}"
    if found is None:
        said = str(made).partition(" Use Fixed, Revolute")[0].replace(f"{Path(FOLDER).resolve()}/", "").replace(".; ", "; ")
        return f"| {document.name} | {freecad.version_text} | {counts} | | | refused: {said} | {report['code']} |", wrong
    outcome = "equal" if not found.differences else "; ".join(found.differences)
    also = f"; {', '.join(found.named)}" if found.named else ""
    return (
        f"| {document.name} | {freecad.version_text} | {counts} | {found.masses} | {found.mm:.1g} mm | {outcome}{also} | {found.solver} |",
        wrong,
    )


def main() -> int:
    """Compare the documents, and write the page."""
    if "--list" in sys.argv:
        for repository, commit in dict.fromkeys((document.repository, document.commit) for document in DOCUMENTS):
            sys.stdout.write(f"git clone https://github.com/{repository} {repository} && git -C {repository} checkout {commit}\n")
        return 0
    names = [name for name in sys.argv[1:] if not name.startswith("-")]
    absent = [document.file for document in DOCUMENTS if not document.file.is_file()]
    if not FOLDER or absent:
        sys.stderr.write(
            f"set ARTICAD_FREECAD_DOCUMENTS to a folder with the repositories (--list); missing: {', '.join(map(str, absent))}\\n"
        )
        return 2
    text, wrong = page(names)
    PAGE.write_text(text)
    sys.stderr.write("".join(f"{line}\n" for line in wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
