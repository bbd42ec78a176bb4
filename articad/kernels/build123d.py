"""The build123d kernel: part scripts in build123d, installed from PyPI."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import sys
import tempfile
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from articad.aliases import Json
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import BuildError, ContractError, KernelError, ReadError, SandboxError
from articad.files import RECORD_BYTES, read_file
from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Solid
from articad.kernels import sandbox as isolation
from articad.kernels.contract import probe_findings, read_connectors, solid_findings
from articad.kernels.dimensions import failed_attempt, fingerprint, is_out_of_time, probed
from articad.kernels.failures import poisoned, script_failure, unconfined
from articad.kernels.kernel import BuildCache, BuiltPart, Inspect
from articad.kernels.results import PoisonedError, number, numbers, read_bytes, read_lines, read_mesh
from articad.kernels.zygote import JobOutcome, Zygote, ZygoteDiedError, ends_by
from articad.processes import scratch

ANGLE_DEG = 5.0  # angular deflection of the mesh, if the linear deflection allows more
WORKER = 6  # increased when the worker measures or meshes differently, so that cached parts are built again
MESH_VOLUME_SHARE = 1.0  # factor of area and deflection by which a mesh's volume may differ from the solid's
RESULT_FILES = {"npz": "part.npz", "brep": "part.brep", "step": "part.step"}
_MAGIC = {"brep": b"\nCASCADE Topology", "step": b"ISO-10303-21;"}
MEASURE_SPARE_SECONDS = 30.0  # beyond a script's own, for the checks after the files are written
_ATTEMPTS = 2  # a zygote that dies during a job is started again once
_CRASH_BYTES = 65536


@dataclass(frozen=True)
class _Ran:
    """The results of one job: how it ended, its report, and its output if it crashed."""

    outcome: JobOutcome
    report: list[Json]
    crash: str


class Build123dKernel:
    """Builds part scripts with build123d in a sandbox.

    Nothing is started before the first part. Threads may share a kernel, and kernels share the worker's process: it is started once,
    which takes two seconds, and ends with this process unless `close` ends it before.
    """

    name = "build123d"

    def __init__(
        self,
        *,
        sandbox: str | None = None,
        timeout: float = 60.0,
        probe_timeout: float = 120.0,
        memory: int = 3 * 2**30,
        layers: Collection[str] | None = None,
    ) -> None:
        """Choose how scripts are run.

        Args:
            sandbox: `strict` refuses to run scripts if neither Landlock nor bubblewrap works, `weak` does not; by default
                `$ARTICAD_SANDBOX`, else strict.
            timeout: Processor time of a script [s]; the wall clock may be `timers.WAITING` times as long.
            probe_timeout: Likewise of its dimension probe [s].
            memory: Address space of a script [bytes].
            layers: Layers of isolation to apply, if available; all by default. Fewer serve to measure the effect of each.
        """
        self.mode = sandbox or os.environ.get("ARTICAD_SANDBOX") or "strict"
        if self.mode not in ("strict", "weak"):
            raise SandboxError(f"Unknown sandbox {self.mode!r}; there are strict and weak.")
        self.limits = isolation.ScriptLimits(seconds=timeout, probe_seconds=probe_timeout, memory=memory)
        self._chosen = layers

    @cached_property
    def version(self) -> str:
        """build123d, its OCCT, and the version of the worker."""
        return f"{_version('build123d')}+ocp{_version('cadquery-ocp-novtk')}+worker{WORKER}"

    @property
    def level(self) -> str:
        """The isolation under which scripts run."""
        return isolation.level_of(self._layers)

    @property
    def pid(self) -> int | None:
        """The worker's process, or that of bubblewrap around it; None before it is started."""
        zygote = self.__dict__.get("_zygote")
        return None if zygote is None else zygote.pid

    @cached_property
    def _layers(self) -> frozenset[str]:
        available = isolation.available()
        return available if self._chosen is None else available & frozenset(self._chosen)

    @cached_property
    def _zygote(self) -> Zygote:
        zygote = Zygote.shared(self._layers)
        zygote.users.add(self)
        return zygote

    @cached_property
    def _scratch(self) -> tempfile.TemporaryDirectory[str]:
        return scratch.folder("worker")

    def warm_up(self) -> None:
        """Start the worker's process now, so that the first part need not wait for it.

        Raises:
            KernelUnavailableError: If build123d cannot be loaded; the message names the missing library.
        """
        self._zygote.start()

    def close(self) -> None:
        """End the worker's process, unless another kernel of this process uses it; the next part starts it again."""
        zygote = self.__dict__.pop("_zygote", None)
        if zygote is not None:
            zygote.users.discard(self)
            if not zygote.users:
                zygote.close()

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
        limits = replace(self.limits, probe_seconds=0.0)
        request = {"script": source, "part": dict(brief), "deflection_mm": deflection, "angle_deg": ANGLE_DEG}
        with self.job_folder() as job:
            try:
                ran = self._run("script", job, request, {"shape": "shape.bin"}, limits)
                if not ran.report or ran.report[0].get("ok") is not True:
                    error: KernelError = script_failure(part, source, ran.report, ran.outcome, ran.crash, limits)
                    error.partial = self._pieces(job, deflection)
                    raise error
                return self._judged(job, brief, ran, folder or self._new_folder(), deflection, inspect, probe=source if probe else None)
            except PoisonedError as poison:
                raise poisoned(part, source, str(poison)) from poison

    def moved(self, built: BuiltPart, matrix: ArrayLike, folder: Path | None = None) -> BuiltPart:
        """Return the part under a rigid motion or a reflection `(4, 4)`; see `PartKernel.moved`."""
        matrix = np.asarray(matrix, dtype=np.float64)
        assert built.solid.brep is not None
        name, deflection = str(built.brief.get("name", "part")), built.solid.deflection
        with self.job_folder() as job:
            shutil.copyfile(built.solid.brep, job / "shape.bin")
            shape = self._measured(job, form="brep", name=name, deflection=deflection, matrix=matrix.tolist())
            numbers_of_it = self._checked(job, shape, deflection)
            reflects = np.linalg.det(matrix[:3, :3]) < 0
            connectors = {
                name: connector.mirrored(matrix) if reflects else connector.moved(SE3.from_matrix(matrix))
                for name, connector in built.connectors.items()
            }
            target = folder or self._new_folder()
            self._leave(job, target, numbers_of_it, connectors, built.findings, built.brief, deflection, built.sandbox)
        return BuiltPart.load(target)

    def mirror(self, built: BuiltPart, S: ArrayLike) -> BuiltPart:
        """Return the mirror image under `S (4, 4)`."""
        return self.moved(built, S)

    def read_step(self, path: Path, deflection: float = 0.01, *, cache: BuildCache | None = None) -> Solid:
        """Read a STEP file that contains one solid; it is parsed in the sandbox.

        Args:
            path: The file.
            deflection: Largest distance of the mesh from the solid [mm].
            cache: Stores what was read, by the file's content; by default the user's cache.

        Raises:
            ReadError: If it is not STEP or does not contain exactly one valid solid.
        """
        self._require_sandbox()
        cache = cache or BuildCache()
        try:
            content = read_file(path, RECORD_BYTES)
            digest = hashlib.sha256(f"{self.version} {deflection!r} ".encode() + content).hexdigest()
            if (folder := cache.get(digest)) is None:
                with cache.writing(digest) as empty:
                    self._read_step(path, content, deflection, empty)
                folder = cache.root / digest
        except (OSError, PoisonedError, BuildError) as error:
            raise ReadError(f"{path.name} is not a STEP file that can be read: {error}", path=str(path)) from error
        return BuiltPart.load(folder).solid

    def _read_step(self, path: Path, content: bytes, deflection: float, folder: Path) -> None:
        brief = {"name": path.stem}
        with self.job_folder() as job:
            (job / "shape.bin").write_bytes(content)
            shape = self._measured(job, form="step", name="part", deflection=deflection)
            findings = Findings(solid_findings(brief, shape))
            if not findings.ok:
                raise ReadError(f"{path.name}: {findings.errors[0].message}", path=str(path), findings=findings)
            self._leave(job, folder, self._checked(job, shape, deflection), {}, findings, brief, deflection, self.level)

    # ------------------------------------------------------------------ one job

    def run_task(self, task: str, request: Json, limits: isolation.ScriptLimits) -> list[Json]:
        """Run a task that reads and writes no shapes; return its report, which nobody has checked.

        Raises:
            SandboxError: If scripts cannot be confined here.
            PoisonedError: If the report is not JSON.
        """
        self._require_sandbox()
        with self.job_folder() as job:
            return self._run(task, job, request, {}, limits).report

    def _require_sandbox(self) -> None:
        if self.level != isolation.WEAK or (self.mode == "weak" and sys.platform == "linux"):
            return
        reasons = "; ".join(isolation.missing()) or "neither Landlock nor bubblewrap was chosen"
        message = f"Part scripts are untrusted code, and this machine has neither Landlock nor bubblewrap ({reasons})."
        hint = f"{isolation.HOW_TO_GET}; or accept less with --sandbox weak."
        raise SandboxError(f"{message} {hint}", findings=[Finding(code="E_SANDBOX", where="sandbox", message=message, hint=hint)])

    @contextlib.contextmanager
    def job_folder(self) -> Iterator[Path]:
        """Yield an empty folder, and delete it."""
        folder = self._new_folder()
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def _new_folder(self) -> Path:
        return Path(tempfile.mkdtemp(dir=self._scratch.name))

    def _run(self, task: str, job: Path, request: Json, files: Mapping[str, str], limits: isolation.ScriptLimits) -> _Ran:
        """Run one task. If the zygote dies during the task, it is replaced once.

        Args:
            task: Its name.
            job: Folder of the job.
            request: Arguments of the task: `job.json`.
            files: The task's names for files of the folder; existing files are read, the others written.
            limits: Resources that it may use.
        """
        (job / "job.json").write_text(json.dumps({"schema": "articad.job/1", "kernel": self.name, "task": task} | request))
        report, crash = f"{task}.report", f"{task}.crash"
        inputs = {"job": "job.json"} | {name: file for name, file in files.items() if (job / file).exists()}
        outputs = {"report": report, "crash": crash} | {name: file for name, file in files.items() if name not in inputs}
        for attempt in range(_ATTEMPTS):
            opened = {name: os.open(job / file, os.O_RDONLY | os.O_CLOEXEC) for name, file in inputs.items()}
            writing = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC
            opened |= {name: os.open(job / file, writing, 0o600) for name, file in outputs.items()}
            try:
                outcome = self._zygote.run(task, opened, limits)
                break
            except ZygoteDiedError as error:
                if attempt == _ATTEMPTS - 1:
                    raise KernelError(
                        "The worker's process was killed twice while it built a part; is the machine out of memory?"
                    ) from error
            finally:
                for descriptor in opened.values():
                    os.close(descriptor)
        if outcome.refused:
            raise KernelError(f"No process could be started for a part: {outcome.refused}.")
        if outcome.unconfined:
            raise unconfined(outcome.unconfined)
        with (job / crash).open("rb") as file:  # a script may have filled it
            said = file.read(_CRASH_BYTES).decode(errors="replace")
        return _Ran(outcome, read_lines(job / report), said)

    def _measured(
        self, job: Path, *, form: str, name: str, deflection: float, matrix: list[list[float]] | None = None, place: int | None = None
    ) -> Json:
        """Measure, mesh and write a shape, or the solid at one place in it, in a process that ran no script; return its report.

        Raises:
            BuildError: If the kernel fails on it.
        """
        request = {"form": form, "name": name, "matrix": matrix, "deflection_mm": deflection, "angle_deg": ANGLE_DEG, "place": place}
        limits = replace(self.limits, probe_seconds=MEASURE_SPARE_SECONDS)
        ran = self._run("measure", job, request, {"shape": "shape.bin"} | RESULT_FILES, limits)
        shape: Json = {}
        for line in ran.report:
            shape |= line
        if shape.get("ok") is not True:
            why = shape.get("message") or ends_by(ran.outcome) or ran.crash
            finding = Finding(
                code="E_INVALID_SOLID",
                where=f"parts.{name}",
                parts=(name,),
                message=f"The shape cannot be measured: {str(why)[:200]}.",
                hint="Simplify the last operation; the kernel cannot work with its result.",
            )
            raise BuildError(str(finding), findings=[finding], parts=(name,))
        return shape

    def _judged(
        self,
        job: Path,
        brief: Mapping[str, Any],
        ran: _Ran,
        folder: Path,
        deflection: float,
        inspect: Inspect | None,
        *,
        probe: str | None,
    ) -> BuiltPart:
        """Measure what a script left, probe its dimensions, and check it against the contract.

        Args:
            job: Folder of the script's job.
            brief: Brief of the part.
            ran: Results of the script's process.
            folder: Folder for the result.
            deflection: Deflection of the mesh [mm].
            inspect: Further checks of connectors and bounding box.
            probe: The script, to be run with each dimension changed; None omits the probe.

        Raises:
            ContractError: With every breach at once.
        """
        part, said = str(brief["name"]), ran.report[0]
        if ran.report[1:]:
            raise PoisonedError("its process reports more than one result")
        found: list[Finding] = []
        connectors = read_connectors(brief, said.get("connectors"), found)
        shape = self._measured(job, form="bin", name=part, deflection=deflection)
        found += solid_findings(brief, shape)
        if inspect is not None and "bbox_mm" in shape:
            found += inspect(connectors, numbers(shape["bbox_mm"], 2, 3))
        if probe is not None and shape.get("solids") == 1 and shape.get("valid") is True:
            outcomes = self._probed(probe, brief, fingerprint(shape, said["connectors"]), ran.outcome.cpu)
            found += probe_findings(brief, outcomes, ended=True, crashed="", script=probe)
        findings = Findings(found)
        if not findings.ok:
            error = ContractError("\n".join(map(str, findings.errors)), findings=findings, parts=(part,))
            error.partial = self._pieces(job, deflection)
            raise error
        self._leave(job, folder, self._checked(job, shape, deflection), connectors, findings, brief, deflection, self.level)
        return BuiltPart.load(folder)

    def _probed(self, script: str, brief: Mapping[str, Any], before: list[float], own: float) -> list[Json]:
        """Build the part with each dimension changed; return an outcome for each that was done in time."""

        def attempt(dimensions: Json, seconds: float) -> tuple[list[float] | Json | None, float]:
            limits = replace(self.limits, seconds=seconds, probe_seconds=0.0)
            with self.job_folder() as job:
                ran = self._run(
                    "script", job, {"script": script, "part": {**brief, "dimensions": dimensions}}, {"shape": "shape.bin"}, limits
                )
                said = ran.report[0] if ran.report else {}
                if said.get("ok") is not True:
                    return failed_attempt(said, ends_by(ran.outcome), late=ran.outcome.late), ran.outcome.cpu
                judged = self._run("judge", job, {}, {"shape": "shape.bin"}, limits)
                shape, used = judged.report[0] if judged.report else {}, ran.outcome.cpu + judged.outcome.cpu
                if shape.get("ok") is not True:
                    if "solids" not in shape and is_out_of_time(ends_by(judged.outcome), late=judged.outcome.late):
                        return None, used
                    message = f"it gives {shape.get('solids', 'no')} solids, not one that is valid"
                    return {"outcome": "broken", "error": {"message": message}}, used
                return fingerprint(shape, said.get("connectors", {})), used

        return list(probed(brief["dimensions"], before, attempt, seconds=self.limits.probe_seconds, own=own))

    def _pieces(self, job: Path, deflection: float) -> Path | None:
        """Return a folder with the mesh of the solids that a failed script left, if any."""
        try:
            if not (job / "shape.bin").stat().st_size:
                return None
            request = {"form": "bin", "deflection_mm": deflection, "angle_deg": ANGLE_DEG}
            ran = self._run("pieces", job, request, {"shape": "shape.bin", "npz": "pieces.npz"}, self.limits)
            if not ran.report or not ran.report[0].get("solids"):
                return None
            content = read_bytes(job / "pieces.npz")
            read_mesh(content)
        except (OSError, PoisonedError, KernelError):
            return None
        folder = self._new_folder()
        (folder / "part.npz").write_bytes(content)
        return folder

    def _checked(self, job: Path, shape: Json, deflection: float) -> Json:
        """Return the shape's numbers, validated, and consistent with the mesh.

        Raises:
            PoisonedError: If they are not valid.
        """
        mesh = read_mesh(read_bytes(job / RESULT_FILES["npz"]))
        checked = {
            "solids": 1,
            "valid": True,
            "volume_mm3": number(shape.get("volume_mm3")),
            "area_mm2": number(shape.get("area_mm2")),
            "com_mm": numbers(shape.get("com_mm"), 3).tolist(),
            "inertia_mm5": numbers(shape.get("inertia_mm5"), 3, 3).tolist(),
            "bbox_mm": numbers(shape.get("bbox_mm"), 2, 3).tolist(),
            "self_intersection": "checked" if shape.get("intersects_itself") is False else "not checked",
        }
        if not mesh.is_closed:
            raise PoisonedError("the mesh is not closed")
        _require_agreement(mesh, checked, deflection)
        for kind, magic in _MAGIC.items():
            with (job / RESULT_FILES[kind]).open("rb") as file:
                if not file.read(len(magic)) == magic:
                    raise PoisonedError(f"{RESULT_FILES[kind]} has the wrong form")
        return checked

    def _leave(
        self,
        job: Path,
        folder: Path,
        shape: Json,
        connectors: Mapping[str, Connector],
        findings: Findings,
        brief: Mapping[str, Any],
        deflection: float,
        level: str,
    ) -> None:
        """Write the folder of a built part; result.json contains only validated data."""
        hashes = {}
        for file in RESULT_FILES.values():
            content = read_bytes(job / file)
            (folder / file).write_bytes(content)
            hashes[file] = hashlib.sha256(content).hexdigest()
        result = {
            "schema": "articad.result/1",
            "ok": True,
            "error": None,
            "shape": shape,
            "connectors": {name: _frame(connector) for name, connector in connectors.items()},
            "files": hashes,
            "findings": findings.to_json()["findings"],
            "part": dict(brief),
            "kernel": {"name": self.name, "version": self.version},
            "deflection_mm": deflection,
            "sandbox": level,
        }
        (folder / "result.json").write_text(json.dumps(result, sort_keys=True, allow_nan=False))


def _require_agreement(mesh: TriMesh, shape: Json, deflection: float) -> None:
    """Compare the numbers of a solid with its mesh: this detects a process that measures wrongly, or was manipulated.

    The mesh is within the deflection of the surface, so the volume between both is at most about area · deflection.

    Raises:
        PoisonedError: If they differ by more than the mesh allows.
    """
    volume, com, inertia = mesh.solid_integrals()
    shell = MESH_VOLUME_SHARE * shape["area_mm2"] * deflection
    reach = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0])) + deflection
    held = max(min(volume, shape["volume_mm3"]), 1e-9)
    for what, difference, allowed, unit in (
        ("volume", abs(volume - shape["volume_mm3"]), shell, "mm³"),
        ("centre", np.abs(com - shape["com_mm"]).max(), 2 * shell * reach / held + 1e-6, "mm"),
        ("inertia", np.abs(inertia - shape["inertia_mm5"]).max(), 4 * shell * reach**2 + 1e-6 * held * reach**2, "mm⁵"),
        ("box", np.abs(mesh.bounds - shape["bbox_mm"]).max(), 2 * deflection + 1e-6 * reach, "mm"),
    ):
        if not difference <= allowed:
            raise PoisonedError(f"the mesh's {what} is {difference:.3g} {unit} off the solid's")


def _version(distribution: str) -> str:
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return "none"


def _frame(connector: Connector) -> Json:
    frame = connector.frame
    vectors = {"o": frame.translation, "z": frame.z_axis, "x": frame.x_axis}
    return {axis: [float(value) for value in vector] for axis, vector in vectors.items()} | {"label": connector.label}
