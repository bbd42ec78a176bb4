"""Every reader of what others wrote, as a function of bytes that returns, or raises one of articad's own errors.

Anything else that such a function raises is a fault: an exception without a name does not say what is wrong with the
file. Used by the tests of this room, within bounds, and by `scripts/fuzz`, for as long as asked.
"""

from __future__ import annotations

import contextlib
import io
import json
import math
import os
import resource
import signal
import struct
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from numpy.typing import NDArray

from articad.agents.design import judged
from articad.agents.inspection import Judgement, Look, Observations
from articad.agents.llm import Replay, Request
from articad.agents.replies import object_text, parse_script, reader
from articad.agents.requirements import Requirements
from articad.agents.rollback import Decisions
from articad.certificates.verifier import verify_file
from articad.errors import ArticadError, ReadError
from articad.findings import Finding, Findings
from articad.geometry.mesh_files import read_mesh
from articad.importers import mjcf_compiled
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.sdf import read_sdf
from articad.importers.urdf import read_urdf
from articad.kernels import results
from articad.kernels.build123d import Build123dKernel
from articad.kernels.contract import probe_findings, read_connectors, solid_findings
from articad.kernels.failures import script_failure
from articad.kernels.freecad import tree_findings
from articad.kernels.sandbox import ScriptLimits
from articad.kernels.step_assembly import StepReader
from articad.kernels.zygote import JobOutcome
from articad.memory.experience import ExperienceStore
from articad.plan.check import check_plan
from articad.plan.expressions import parse
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run

CORPUS = Path(__file__).parent / "corpus"
NAMES = {"a": 1.5, "width": 40.0, "inset": -2.0, "zero": 0.0}
BRIEF: dict[str, Any] = {
    "name": "part",
    "dimensions": {"width": 40.0, "hole_count": 4},
    "envelope_mm": [40.0, 40.0, 5.0],
    "connectors": {"hinge": {"o": [0.0, 0.0, 0.0], "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0], "label": "", "joints": []}},
}


def plan(content: bytes) -> None:
    """A plan as JSON text: read, checked, resolved, written and read again."""
    read = AssemblyPlan.loads(content)
    findings = check_plan(read)
    again = AssemblyPlan.loads(read.dumps())
    assert again.dumps() == read.dumps(), "a plan changes when it is written and read"
    if findings.ok:
        resolve(read)  # what passes every check can be resolved


def expression(content: bytes) -> None:
    """An expression: a finite number, a named error, never anything of Python's."""
    parsed = parse(content.decode("utf-8", errors="replace"))
    with contextlib.suppress(ArticadError):
        assert math.isfinite(parsed.evaluate(NAMES))
    parsed.to_freecad({name: f"Parameters.p_{name}" for name in parsed.names})


def urdf(content: bytes) -> None:
    """A URDF file beside one mesh."""
    with _file(".urdf", content) as path:
        _used(read_urdf(path))


def compile_in_forks() -> None:
    """Let MuJoCo compile in forks of this process from now on: a hundred times as many inputs as with a new process for each."""
    import mujoco  # noqa: F401 - forks have it then

    mock.patch("articad.importers.mjcf.compiled_mjcf", _compiled_in_fork).start()


def _compiled_in_fork(path: Path, root: Path) -> mjcf_compiled.Compiled:
    """Return what `compiled_mjcf` returns; a crash of MuJoCo is an answer, as it is there."""
    folder = _folder(os.getpid()) / "compiled"
    folder.mkdir(exist_ok=True)
    (folder / "model").unlink(missing_ok=True)
    pid = os.fork()
    if pid == 0:
        try:
            for crash in (signal.SIGSEGV, signal.SIGABRT, signal.SIGFPE, signal.SIGBUS, signal.SIGILL, signal.SIGALRM):
                signal.signal(crash, signal.SIG_DFL)  # not the fuzzer's, which would take them for faults of the reader
            resource.setrlimit(resource.RLIMIT_CPU, (10, 10))
            os.chdir(folder)
            with mock.patch("articad.kernels.sandbox.keep_to"):
                mjcf_compiled.main([str(path.resolve()), str(root.resolve())])
        finally:
            os._exit(0)
    os.waitpid(pid, 0)
    if not (folder / "model").exists():
        raise ReadError("MuJoCo's compiler ended without a model.", path=str(path))
    return mjcf_compiled._read((folder / "model").read_bytes(), path)


def mjcf(content: bytes) -> None:
    """An MJCF file beside one mesh."""
    with _file(".xml", content) as path:
        _used(read_mjcf(path))


def xacro(content: bytes) -> None:
    """A xacro file, which a process of its own expands."""
    with _file(".xacro", content) as path:
        _used(read_urdf(path))


def sdf(content: bytes) -> None:
    """An SDFormat file beside one mesh."""
    with _file(".sdf", content) as path:
        _used(read_sdf(path))


def fcstd(content: bytes) -> None:
    """A FreeCAD file; bytes that are no zip are taken for its Document.xml. Its B-rep goes to the confined worker, which is left out."""
    if not content.startswith(b"PK"):
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as archive:
            archive.writestr("Document.xml", content)
            archive.writestr("Shape.brp", b"\nCASCADE Topology V1, (c) Matra-Datavision\n")
        content = packed.getvalue()
    with mock.patch("articad.importers.freecad.BrepReader", _NoBrep), _file(".FCStd", content) as path:
        _used(read_freecad(path))


def stl(content: bytes) -> None:
    """An STL file."""
    _mesh(".stl", content)


def obj(content: bytes) -> None:
    """An OBJ file."""
    _mesh(".obj", content)


def glb(content: bytes) -> None:
    """A GLB file; bytes that begin with `{` are taken for its JSON, before 256 bytes of numbers."""
    if content.startswith(b"{"):
        text = content + b" " * (-len(content) % 4)
        binary = np.arange(12, dtype="<f4").tobytes() + np.array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3], dtype="<u4").tobytes() + bytes(160)
        header = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
        content = header + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    _mesh(".glb", content)


def ply(content: bytes) -> None:
    """A PLY file."""
    _mesh(".ply", content)


def dae(content: bytes) -> None:
    """A COLLADA file."""
    _mesh(".dae", content)


def srdf(content: bytes) -> None:
    """An SRDF, beside the URDF that it belongs to."""
    folder = _folder(os.getpid()) / "moveit"
    folder.mkdir(exist_ok=True)
    (folder / "robot.srdf").write_bytes(content)
    path = folder / "robot.urdf"
    path.write_bytes((CORPUS / "urdf" / "robot.urdf").read_bytes())
    _used(read_urdf(path))


def reply(content: bytes) -> None:
    """A model's reply, as every role reads it."""
    text = content.decode("utf-8", errors="replace")
    reads: tuple[Callable[[], object], ...] = (
        lambda: object_text(text, step="fuzz"),
        lambda: parse_script(text, step="fuzz"),
        lambda: reader(Requirements, ignore=frozenset({"schema"}))(text, "fuzz"),
        lambda: judged(text, "fuzz"),
        *(partial(reader(form), text, "fuzz") for form in (Judgement, Look, Observations, Decisions)),
    )
    for read in reads:
        with contextlib.suppress(ArticadError):
            read()


def worker(content: bytes) -> None:
    """What a confined process leaves, the script's own process included: a report of lines, and a mesh."""
    if content.startswith((b"PK", b"\x93NUMPY")):
        if not content.startswith(b"PK"):
            packed = io.BytesIO()
            pieces = [b"\x93NUMPY" + piece for piece in content.split(b"\x93NUMPY")[1:]]
            with zipfile.ZipFile(packed, "w") as archive:
                for name, piece in zip(("vertices", "triangles", "face"), pieces, strict=False):
                    archive.writestr(f"{name}.npy", piece)
            content = packed.getvalue()
        with contextlib.suppress(results.PoisonedError):
            results.read_mesh(content)
        return
    with _file(".report", content) as path, contextlib.suppress(results.PoisonedError, ArticadError):
        lines = results.read_lines(path)
        said = lines[0] if lines else {}
        script_failure("part", "x = 1\n", lines, JobOutcome(0, 0, late=False, peak=0), str(said.get("crash")), ScriptLimits())
        findings: list[Finding] = []
        with contextlib.suppress(results.PoisonedError, ArticadError):
            read_connectors(BRIEF, said.get("connectors"), findings)
        with contextlib.suppress(results.PoisonedError, ArticadError):
            list(solid_findings(BRIEF, said))
        list(tree_findings("part", said))
        probes = [line["probe"] for line in lines if isinstance(line.get("probe"), dict)]
        list(probe_findings(BRIEF, probes, ended=True, crashed=""))


def step(content: bytes) -> None:
    """A STEP file; the confined worker reads it, and may crash or be late without harm."""
    _solid("step", content)


def assembly(content: bytes) -> None:
    """The products of a STEP file, with their names and poses."""
    with _file(".step", content) as path:
        reader = step_reader()
        parts = reader.read_assembly(path, deflection=0.5)
    assert len({part.name for part in parts}) == len(parts)


def brep(content: bytes) -> None:
    """The B-rep of a FreeCAD file."""
    _solid("brep", content)


def shape(content: bytes) -> None:
    """The shape that a part script's process leaves for the one that measures it."""
    _solid("bin", content)


def run(content: bytes) -> None:
    """A run directory that somebody else made: JSON of its request, a reply, a report and a line of its trace."""
    lines = [*content.split(b"\n"), b"", b"", b"", b""]
    folder = _folder(os.getpid()) / "run"
    (folder / "llm").mkdir(parents=True, exist_ok=True)
    files = ("request.json", "llm/design.1.json", "checks.json", "trace.jsonl")
    for name, line in zip(files, lines, strict=False):
        (folder / name).write_bytes(line)
    found = Run.view(folder)
    list(found.events())
    with contextlib.suppress(ArticadError):
        found.checks()
    with contextlib.suppress(ArticadError):
        Replay(found).complete(Request("design", "design/1", (), {"type": "object"}))
    assert all(isinstance(part, dict) for part in found.events())


def case(content: bytes) -> None:
    """A line of somebody's memory of earlier runs."""
    text = content.decode("utf-8", errors="replace")
    with tempfile.TemporaryDirectory(dir=_folder(os.getpid())) as folder:
        memory = ExperienceStore(folder, _NoWords())
        memory.import_lines(text.split("\n"))
        for line in memory.export():
            memory.import_lines([line])


def certificate(content: bytes) -> None:
    """A certificate of motion, one of its meshes, or its proof; whatever they say, it is accepted or refuted."""
    folder = _folder(os.getpid()) / "certificate"
    folder.mkdir(exist_ok=True)
    for file in (CORPUS / "certificate").iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
    name = "certificate.json" if not content.startswith(b"PK") else "_proof.npz" if b".codes" in content else "lid.npz"
    (folder / name).write_bytes(content)
    assert all(isinstance(fault, str) for fault in verify_file(folder / "certificate.json", folder))


READERS: Mapping[str, Callable[[bytes], None]] = {
    "plan": plan,
    "expression": expression,
    "urdf": urdf,
    "xacro": xacro,
    "mjcf": mjcf,
    "sdf": sdf,
    "fcstd": fcstd,
    "stl": stl,
    "obj": obj,
    "glb": glb,
    "ply": ply,
    "dae": dae,
    "srdf": srdf,
    "reply": reply,
    "worker": worker,
    "step": step,
    "assembly": assembly,
    "brep": brep,
    "shape": shape,
    "run": run,
    "case": case,
    "certificate": certificate,
}


def attempt(name: str, content: bytes) -> None:
    """Run a reader; whatever it raises that is not one of articad's own errors is a fault."""
    with contextlib.suppress(ArticadError):
        READERS[name](content)


def seeds(name: str) -> list[bytes]:
    """Return the corpus of a reader."""
    return [path.read_bytes() for path in sorted((CORPUS / name).iterdir())]


class _NoWords:
    """Stands for the word vectors, which take a second to load."""

    name = "none"

    def embed(self, texts: Sequence[str]) -> NDArray[np.float32]:
        return np.full((len(texts), 4), 0.5, dtype=np.float32)


@cache
def kernel() -> Build123dKernel:
    """The kernel whose worker reads shapes, with little time and memory; without bubblewrap, which would hide its processor time."""
    return Build123dKernel(timeout=5.0, memory=2 * 2**30, sandbox="weak", layers=("landlock", "seccomp"))


@cache
def step_reader() -> StepReader:
    """The same worker, reading assemblies."""
    return StepReader(timeout=5.0, memory=2 * 2**30, sandbox="weak", layers=("landlock", "seccomp"))


def _solid(form: str, content: bytes) -> None:
    with kernel().job_folder() as job, contextlib.suppress(results.PoisonedError):
        (job / "shape.bin").write_bytes(content)
        said = kernel()._measured(job, form=form, name="part", deflection=0.5)
        if Findings(solid_findings({"name": "part"}, said)).ok:
            kernel()._checked(job, said, 0.5)


class _NoBrep:
    """Stands for the confined worker, which would take most of the time."""

    def read_brep(self, content: bytes, **_: object) -> None:
        raise ReadError(f"{len(content)} bytes of B-rep are not looked at here.", path="")


def _used(assembly: Any) -> None:
    """Do with an assembly that was read what everything begins with."""
    assembly.at()
    for finding in assembly.findings:
        finding.to_json()


def _mesh(suffix: str, content: bytes) -> None:
    with _file(suffix, content) as path:
        mesh = read_mesh(path)
    assert np.isfinite(mesh.vertices).all()
    assert len(mesh.triangles) == 0 or (mesh.triangles.min() >= 0 and mesh.triangles.max() < len(mesh.vertices))


@cache
def _folder(pid: int) -> Path:
    memory = Path("/dev/shm")
    folder = Path(tempfile.mkdtemp(prefix=f"articad-fuzz-{pid}-", dir=memory if os.access(memory, os.W_OK) else None))
    (folder / "cube.stl").write_bytes((CORPUS / "stl" / "triangle.stl").read_bytes())
    return folder


@contextlib.contextmanager
def _file(suffix: str, content: bytes) -> Iterator[Path]:
    path = _folder(os.getpid()) / f"input{suffix}"
    path.write_bytes(content)
    yield path


def dictionary(name: str) -> list[str]:
    """Return the words of a reader's form: those of its corpus."""
    words: set[str] = set()
    for content in seeds(name):
        with contextlib.suppress(UnicodeDecodeError):
            words |= {word for word in content.decode("ascii").replace('"', " ").replace("<", " ").split() if 2 < len(word) < 24}
    return sorted(json.dumps(word) for word in words if word.isascii() and word.isprintable())
