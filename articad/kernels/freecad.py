"""The FreeCAD kernel: part scripts that leave native, editable feature trees.

Each part takes two confined FreeCAD processes: one runs the script and saves its document; a second opens that document, as a person
would, checks its tree and changes each of its dimensions. The solid is then measured and meshed, as with every other kernel, by a
process that ran no script. FreeCAD's standard output is not read, and an exit code alone proves nothing: a script has succeeded when its
document contains one valid body without invalid features.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import signal
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from lxml import etree
from numpy.typing import ArrayLike

from articad.aliases import Json
from articad.connectors.se3 import SE3
from articad.errors import BuildError, ContractError, ReadError
from articad.findings import Finding, Findings
from articad.geometry.part import Solid
from articad.kernels import freecad_install
from articad.kernels import sandbox as isolation
from articad.kernels.archive import Archive, BadArchiveError, packed
from articad.kernels.build123d import Build123dKernel
from articad.kernels.contract import probe_findings, read_connectors, solid_findings
from articad.kernels.failures import poisoned, script_failure, scrubbed, unconfined
from articad.kernels.freecad_file import rounded, settled, shortened
from articad.kernels.freecad_install import BY_SIGNAL, FreeCAD, FreeCADEnded, FreeCADLimits
from articad.kernels.kernel import BuiltPart, Inspect
from articad.kernels.results import PoisonedError, numbers, read_bytes, read_lines
from articad.kernels.zygote import JobOutcome

DOCUMENT = "part.FCStd"
SEAT = "seat.json"  # pose of the document's body in the part's frame: seven numbers
RECIPE = 2  # increased when documents are written differently, so that cached parts are built again
MAX_DOCUMENT_BYTES, MAX_UNPACKED_BYTES, MAX_ENTRIES = 64 * 2**20, 512 * 2**20, 10_000
MAX_SOLIDS = 100  # that one B-rep is divided into
_PROGRAMS = Path(__file__).parent / "inside_freecad"
_FAMILIES = ("PartDesign::", "Sketcher::", "Part::", "Spreadsheet::")  # prefixes of the types that a part may consist of
_READING = re.compile(r"Python|Part::(Import|CurveNet)")  # types that run Python, or read files by their names
_MODULE = r"(App|Materials|Part|PartDesign|Sketcher|Spreadsheet)"
# Tags beside objects that state a type: FreeCAD imports the module with which the type's name begins, and treats whatever it creates as
# what the tag says.
_TYPES = {
    "Property": re.compile(rf"{_MODULE}::Property\w*"),
    "_Property": re.compile(rf"{_MODULE}::Property\w*"),
    "Extension": re.compile(rf"{_MODULE}::\w+Extension"),
    "Geometry": re.compile(r"Part::Geom\w+"),
    "GeoExtension": re.compile(rf"{_MODULE}::\w+Extension"),
}
_SHAPE_FILE = re.compile(r"[\w][\w.+-]{0,199}\.(brp|bin|txt)")  # entries beside Document.xml: shapes and their names
_PSEUDO = re.compile(
    r"(?<![A-Za-z0-9])_+(app|builtins|coll|cq|gui|math|part|py|re|self)\b|#|href"
)  # of expressions: modules, other documents
_DOCUMENT_XML = "Document.xml"
_KINDS = {"App::VarSet", "App::Origin", "App::Line", "App::Plane", "App::Point", "App::LocalCoordinateSystem"}
_START_SECONDS = 20.0  # for FreeCAD to start, on a cold and busy disk


class _Left(NamedTuple):
    """The result of one process: how it ended, and its report."""

    ended: FreeCADEnded
    report: list[Json]


class FreeCADKernel(Build123dKernel):
    """Builds part scripts with FreeCAD in a sandbox; in addition to the usual files it leaves `part.FCStd`."""

    name = "freecad"

    @cached_property
    def freecad(self) -> FreeCAD:
        """The FreeCAD in use.

        Raises:
            KernelUnavailableError: If there is none of version 1.0 or later.
        """
        return freecad_install.find()

    @cached_property
    def version(self) -> str:
        """FreeCAD, the version of its documents, and that of the process that measures and meshes their solids."""
        return f"freecad{self.freecad.version_text}.{RECIPE}+{super().version}"

    @property
    def level(self) -> str:
        """The isolation under which scripts run; without bubblewrap there is none."""
        return isolation.level_of(self._layers) if "bwrap" in isolation.available() else isolation.WEAK

    def warm_up(self) -> None:
        """Find FreeCAD, so that its absence is reported before anything is built.

        Raises:
            KernelUnavailableError: If there is none of version 1.0 or later.
        """
        _ = self.freecad

    def build(
        self,
        script: bytes,
        brief: Mapping[str, Any],
        *,
        folder: Path | None = None,
        deflection: float = 0.01,
        probe: bool = True,
        inspect: Inspect | None = None,
    ) -> BuiltPart:
        """Run a script and check its part against the contract; see `PartKernel.build`."""
        self._require_sandbox()
        part, source = str(brief["name"]), script.decode("utf-8", errors="replace")
        with self.job_folder() as job:
            try:
                ran = self._inside("part", job, {"script": source, "part": dict(brief)}, (), (DOCUMENT,), self.limits.seconds)
                said = ran.report[0] if ran.report else {}
                if said.get("ok") is not True:
                    raise script_failure(part, source, ran.report, _outcome(ran.ended), _crash(ran.ended), self.limits)
                # written anew: the next process reads it from its front, this one from its end, and both must see the same
                (job / DOCUMENT).write_bytes(harmless(read_bytes(job / DOCUMENT, MAX_DOCUMENT_BYTES)))
                return self._judged_document(
                    job, brief, said, folder or self._new_folder(), deflection, inspect, probe=source if probe else None
                )
            except PoisonedError as poison:
                raise poisoned(part, source, str(poison)) from poison

    def moved(self, built: BuiltPart, matrix: ArrayLike, folder: Path | None = None) -> BuiltPart:
        """Return the part under a rigid motion or a reflection `(4, 4)`; a mirror image has no document of its own."""
        target = folder or self._new_folder()
        matrix = np.asarray(matrix, dtype=np.float64)
        result = super().moved(built, matrix, target)
        document = built.folder / DOCUMENT
        if np.linalg.det(matrix[:3, :3]) > 0 and document.is_file():
            shutil.copyfile(document, target / DOCUMENT)
            seat = SE3.from_matrix(matrix)
            if (built.folder / SEAT).is_file():
                before = json.loads((built.folder / SEAT).read_text())
                seat = seat @ SE3.from_quaternion(before[3:], before[:3])
            (target / SEAT).write_text(json.dumps([float(number) for number in seat.data]))
        return result

    def _inside(self, program: str, job: Path, told: Json, reads: tuple[str, ...], writes: tuple[str, ...], seconds: float) -> _Left:
        """Run one of articad's programs inside FreeCAD on files of the job's folder."""
        (job / f"{program}.json").write_text(json.dumps(told))
        names = (f"{program}.json", *reads, f"{program}.report", *writes)
        with _opened(job, names, len(reads) + 1) as files:
            limits = FreeCADLimits(seconds=seconds + _START_SECONDS, memory=self.limits.memory + 2**30, file_size=self.limits.file_size)
            ended = self.freecad.run(
                _PROGRAMS / f"{program}.py", files=files, arguments=[str(file) for file in files], limits=limits, layers=self._layers
            )
        if ended.unconfined:
            raise unconfined(ended.unconfined)
        return _Left(ended, read_lines(job / f"{program}.report"))

    def _judged_document(
        self,
        job: Path,
        brief: Mapping[str, Any],
        said: Json,
        folder: Path,
        deflection: float,
        inspect: Inspect | None,
        *,
        probe: str | None,
    ) -> BuiltPart:
        """Open the document in a second process, measure its solid, and check both against the contract.

        Raises:
            ContractError: With every breach at once.
        """
        part, entries = str(brief["name"]), said.get("connectors")
        if not isinstance(entries, dict):
            raise PoisonedError("connectors are missing")
        seconds = self.limits.probe_seconds if probe is not None else 0.0
        told = {"connectors": entries, "dimensions": brief["dimensions"], "seconds": seconds}
        looked = self._inside("probe", job, told, (DOCUMENT,), ("shape.bin",), seconds + self.limits.seconds)
        tree = looked.report[0] if looked.report else {}
        found = list(tree_findings(part, tree))
        if tree.get("ok") is not True:
            raise _breach(found or [_not_editable(part, "FreeCAD cannot open the saved document again.")], part)
        framed = tree.get("connectors")
        frames = framed if isinstance(framed, dict) else {}
        connectors = read_connectors(brief, {name: frames.get(name, entry) for name, entry in entries.items()}, found)
        (job / "shape.bin").write_bytes(rounded(read_bytes(job / "shape.bin", MAX_DOCUMENT_BYTES)))
        shape = self._measured(job, form="brep", name=part, deflection=deflection)
        found += solid_findings(brief, shape)
        if inspect is not None and "bbox_mm" in shape:
            found += inspect(connectors, numbers(shape["bbox_mm"], 2, 3))
        if probe is not None and not found:
            outcomes = [line["probe"] for line in looked.report[1:] if isinstance(line.get("probe"), dict)]
            ended = any("probed" in line for line in looked.report)
            crashed = "" if ended else "SIGKILL" if looked.ended.late else "SIGSEGV"
            found += probe_findings(brief, outcomes, ended=ended, crashed=crashed, script=probe)
        findings = Findings(found)
        if not findings.ok:
            raise _breach(list(findings.errors), part)
        self._leave(job, folder, self._checked(job, shape, deflection), connectors, findings, brief, deflection, self.level)
        (folder / DOCUMENT).write_bytes(settled(read_bytes(job / DOCUMENT, MAX_DOCUMENT_BYTES)))
        return BuiltPart.load(folder)


class BrepReader(Build123dKernel):
    """Reads B-rep of unknown origin in the confined worker."""

    def read_brep(self, content: bytes, *, name: str, T: SE3, deflection: float, folder: Path | None = None) -> Solid:
        """Return the one solid of a B-rep, moved by `T`.

        Args:
            content: The B-rep, as text.
            name: Name of the part, for messages.
            T: Its pose.
            deflection: Largest distance of the mesh from it [mm].
            folder: Folder for the solid's B-rep file; without one the solid has no file.

        Raises:
            ReadError: If it is not B-rep or does not contain exactly one valid solid.
        """
        return self._read(content, None, name=name, T=T, deflection=deflection, folder=folder)

    def read_breps(self, content: bytes, *, name: str, T: SE3, deflection: float, folder: Path) -> tuple[list[Solid], int]:
        """Return all solids of a B-rep, moved by `T`, and the number of faces and edges beside them.

        Args:
            content: The B-rep, as text.
            name: Name of the part, for messages.
            T: Its pose.
            deflection: Largest distance of a mesh from its solid [mm].
            folder: Folder for the B-rep files of the solids.

        Raises:
            ReadError: If it is not B-rep, contains no solid or more than `MAX_SOLIDS`, or one of them is not valid.
        """
        try:
            return [self.read_brep(content, name=name, T=T, deflection=deflection, folder=folder)], 0
        except ReadError as error:
            counts = [finding for finding in error.findings if finding.code == "E_NOT_ONE_SOLID"]
            count = int(counts[0].value or 0) if counts else 0
            if not 0 < count <= MAX_SOLIDS:
                raise
            loose = re.search(r"and (\d+) loose", counts[0].message)
        solids = []
        for place in range(count):
            target = folder / str(place)
            target.mkdir()
            solids.append(self._read(content, place, name=name, T=T, deflection=deflection, folder=target))
        return solids, int(loose[1]) if loose else 0

    def _read(self, content: bytes, place: int | None, *, name: str, T: SE3, deflection: float, folder: Path | None) -> Solid:
        self._require_sandbox()
        kept, folder = folder is not None, folder or self._new_folder()
        try:
            with self.job_folder() as job:
                (job / "shape.bin").write_bytes(shortened(content))
                matrix = None if T.allclose(SE3.identity(), mm=0.0, rad=0.0) else T.matrix.tolist()
                shape = self._measured(job, form="brep", name=name, deflection=deflection, matrix=matrix, place=place)
                findings = Findings(solid_findings({"name": name}, shape))
                if not findings.ok:
                    raise ReadError(findings.errors[0].message, path=name, findings=findings)
                self._leave(job, folder, self._checked(job, shape, deflection), {}, findings, {"name": name}, deflection, self.level)
        except (PoisonedError, BuildError) as error:
            raise ReadError(f"The B-rep cannot be read: {error}", path=name) from error
        solid = BuiltPart.load(folder).solid
        for file in (file for file in folder.iterdir() if kept and file != solid.brep):
            file.unlink()
        return replace(solid, brep=solid.brep if kept else None, step=None)  # the worker's own folder is deleted


def tree_findings(part: str, tree: Mapping[str, Any]) -> Iterator[Finding]:
    """Yield what is wrong with the tree of features that the second process found."""
    if "bodies" in tree:
        yield _not_editable(part, f"The document has {scrubbed(tree['bodies'], 20)} bodies, not one.")
        return
    if tree.get("ok") is not True:
        if tree.get("problem"):
            yield _not_editable(part, f"FreeCAD cannot interpret the saved document: {scrubbed(tree['problem'], 300)}.")
        return
    for name in _names(tree.get("off_tip")):
        yield Finding(
            code="E_FEATURE_OFF_TIP",
            where=f"parts.{part}",
            parts=(part,),
            message=f"Feature {name!r} is in the body but not in its solid: it is not an ancestor of the tip.",
            hint="After each pattern, set body.Tip to it before the next feature is added, or use the functions of `part`, which do.",
        )
    if invalid := _names(tree.get("invalid"), 200):
        yield _not_editable(part, f"{', '.join(invalid)} cannot be recomputed.")
    if tree.get("sketched") is not True or tree.get("frozen"):
        yield _not_editable(part, "The body is a frozen shape: no sketch drives it.")
    if untied := _names(tree.get("untied")):
        yield _not_editable(part, f"Dimension {', '.join(map(repr, untied))} drives nothing: no expression names it.")


def _names(value: object, characters: int = 60) -> list[str]:
    """Return the names that a process reported, if they are a list; a script chose them."""
    return [scrubbed(name, characters) for name in value[:20]] if isinstance(value, list) else []


def _not_editable(part: str, message: str) -> Finding:
    hint = "Build part.body from sketches: part.sketch, part.rectangle, part.pad and the like, with texts over dimensions for numbers."
    return Finding(code="E_NOT_EDITABLE", where=f"parts.{part}", parts=(part,), message=message, hint=hint)


def _breach(found: list[Finding], part: str) -> ContractError:
    return ContractError("\n".join(map(str, found)), findings=found, parts=(part,))


def harmless(content: bytes) -> bytes:
    """Return a document with nothing in it but features, written anew; people will open it without a sandbox.

    Opening a document imports modules by the names in it, and may read files that it names.

    Raises:
        PoisonedError: If it contains more than features.
    """
    try:
        archive = Archive(content, entries=MAX_ENTRIES, unpacked=MAX_UNPACKED_BYTES)
        document = archive.read(_DOCUMENT_XML)
        parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
        root = etree.fromstring(document, parser)
    except (BadArchiveError, ValueError, etree.XMLSyntaxError) as error:
        raise PoisonedError("this is not a FreeCAD document") from error
    for problem in _harms(root):
        raise PoisonedError(f"the document holds {problem}")
    named = {element.get("file") for element in root.iter() if element.get("file")}
    try:
        shapes = {name: archive.read(name) for name in archive.names if name in named and _SHAPE_FILE.fullmatch(name)}
    except BadArchiveError as error:
        raise PoisonedError("the document is damaged") from error
    return packed({_DOCUMENT_XML: document} | shapes)


def _harms(root: Any) -> Iterator[str]:
    """Yield what a document contains beyond features."""
    about = root.getroottree().docinfo
    if about.doctype:
        yield "definitions of its own"
    if about.xml_version != "1.0" or (about.encoding or "utf-8").lower() != "utf-8":
        yield "another spelling of XML than FreeCAD's own"
    for item in root.iter("Object"):
        kind = item.get("type")
        if kind is not None and not (kind in _KINDS or (kind.startswith(_FAMILIES) and not _READING.search(kind))):
            yield f"an object of type {scrubbed(kind, 60)}"
    for element in root.iter():
        yield from _harms_of_type(element)
        yield from _harms_of_content(element)


def _harms_of_type(element: Any) -> Iterator[str]:
    """Yield what an element makes FreeCAD import, or interpret as another type."""
    if element.prefix or element.nsmap:  # FreeCAD takes <a:Object> for <Object>
        yield "names of another vocabulary"
    wanted, found = _TYPES.get(str(element.tag)), element.get("type") or ""
    if "Python" in str(element.tag) or element.get("module") or "Python" in found:
        yield "Python objects"
    elif element.tag != "Object" and not (wanted.fullmatch(found) if wanted else "::" not in found):
        yield f"something of type {scrubbed(found, 60)}"
    if element.get("ViewType"):  # of an object: its view provider, imported likewise
        yield "a view of its own"


def _harms_of_content(element: Any) -> Iterator[str]:
    """Yield what an element makes FreeCAD read or evaluate."""
    if element.tag in ("XLink", "XLinkSub", "XLinkList", "XLinkSubList", "FileIncluded") and (element.get("file") or element.get("data")):
        yield "links to other files"
    file = element.get("file")
    if file and not _SHAPE_FILE.fullmatch(file):
        yield f"a file named {scrubbed(file, 60)}"
    cell = element.get("content") or ""  # of a spreadsheet: FreeCAD gives =_py the module of Python's built-in functions
    if _PSEUDO.search(element.get("expression") or "") or (cell.lstrip().startswith("=") and _PSEUDO.search(cell)):
        yield "an expression that reaches out of it"


@contextlib.contextmanager
def _opened(job: Path, names: tuple[str, ...], reads: int) -> Iterator[list[int]]:
    files: list[int] = []
    try:
        for place, name in enumerate(names):
            mode = os.O_RDONLY if place < reads else os.O_WRONLY | os.O_CREAT | os.O_TRUNC
            files.append(os.open(job / name, mode | os.O_CLOEXEC, 0o600))
        yield files
    finally:
        for file in files:
            os.close(file)


def _outcome(ended: FreeCADEnded) -> JobOutcome:
    """Return how a process ended, as the worker reports it; FreeCAD itself turns a crash into exit code 1."""
    killed = ended.code - BY_SIGNAL if ended.code > BY_SIGNAL else -min(ended.code, 0)
    crashed = signal.SIGSEGV if "SIGSEGV" in ended.said or "Segmentation" in ended.said else 0
    return JobOutcome(None if killed or crashed else ended.code, int(killed or crashed), ended.late, 0, ended.processor)


def _crash(ended: FreeCADEnded) -> str:
    return "worker: MemoryError" if "MemoryError" in ended.said or "bad_alloc" in ended.said else ""
