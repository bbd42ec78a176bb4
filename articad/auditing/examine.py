"""The audit of one file: read its text, read it as a mechanism, check both, and load it in engines."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from articad.assembly import Assembly
from articad.auditing import limits, masses, names, shapes, structure
from articad.auditing.contact import FOREIGN, contacts
from articad.auditing.contact_case import Contacts
from articad.auditing.declared import Declared, from_assembly
from articad.auditing.engines import refusals
from articad.auditing.jams import hull_jams
from articad.auditing.mesh_references import MeshReferences
from articad.auditing.report import Audit
from articad.auditing.step_parts import audit_step
from articad.auditing.urdf_text import UrdfText
from articad.certificates.certificate import Certificate
from articad.errors import ArticadError, ReadError
from articad.files import is_file
from articad.findings import Finding, Findings
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.reading import Folder, read_xml
from articad.importers.referenced_files import package_of, require_closed
from articad.importers.urdf import read_urdf, require_bounded
from articad.runs.run import REQUEST_FILE
from articad.simulation.loading import ENGINES, Loading, load_in_all

BUDGET_S: Final = 12.0  # for sampling the motion
AUDITED: Final = {".urdf": "urdf", ".xml": "mjcf", ".mjcf": "mjcf", ".fcstd": "freecad", ".step": "step", ".stp": "step"}
"""Format by the extension of a file."""

CHECKS: Final[tuple[Callable[[Declared], Iterator[Finding]], ...]] = (
    *structure.CHECKS,
    *names.CHECKS,
    *masses.CHECKS,
    *limits.CHECKS,
    *shapes.CHECKS,
)
_CAD_NAMES: Final = {"freecad", "plan", "run"}  # names of labels are arbitrary there


@dataclass
class AuditOptions:
    """Options of an audit.

    Attributes:
        root: Folder that meshes may be read from; by default the package that contains the file.
        budget: Nominal seconds of work for sampling the motion: the same amount on every machine.
        certified: The same for proving the motion instead of sampling it.
        engines: Whether to load the file in simulators.
        motion: Whether to check the motion at all.
    """

    root: Path | None = None
    budget: float = BUDGET_S
    certified: float | None = None
    engines: bool = True
    motion: bool = True


@dataclass
class _Found:
    """Results collected during an audit."""

    findings: list[Finding] = field(default_factory=list)
    undone: list[str] = field(default_factory=list)
    declared: Declared | None = None
    motion: str = "none"
    engines: tuple[Loading, ...] = ()
    certificate: Certificate | None = None


def audit_file(path: str | Path, choices: AuditOptions | None = None) -> Audit:
    """Audit a URDF, MJCF, FreeCAD or STEP file; whatever is wrong with it becomes a finding.

    Args:
        path: The file.
        choices: Options; everything but proofs by default.

    Raises:
        ReadError: If its extension is none of those, or there is no such file.
    """
    path, choices = Path(path), choices or AuditOptions()
    kind = AUDITED.get(path.suffix.lower())
    if kind is None:
        raise ReadError(f"{path}: extension {path.suffix!r} is not one of {', '.join(AUDITED)}.", path=str(path))
    if not path.is_file():
        raise ReadError(f"{path} is not a file." if path.exists() else f"{path} does not exist.", path=str(path))
    start, found = time.monotonic(), _Found()
    try:
        _AUDITORS[kind](path, choices, found)
    except ArticadError as error:
        found.findings += error.findings or [_unreadable(path, error)]
    return _report(str(path), kind, found, start)


def audit_assembly(assembly: Assembly, file: str, kind: str, choices: AuditOptions | None = None) -> Audit:
    """Audit an assembly that already exists: of a plan or a run."""
    choices, start, found = choices or AuditOptions(), time.monotonic(), _Found()
    found.declared = from_assembly(assembly, kind, states_inertia=False, states_collision=False)
    found.findings += assembly.findings
    _look(found, assembly, choices)
    return _report(file, kind, found, start)


def audit_made(assembly: Assembly, folder: str | Path, choices: AuditOptions | None = None) -> Audit:
    """Audit the assembly of a plan or a run; engines load the exports of the run."""
    is_run = (Path(folder) / REQUEST_FILE).is_file()
    found = audit_assembly(assembly, str(folder), "run" if is_run else "plan", choices)
    exports = sorted(path for path in Path(folder).glob("export/*/*") if path.suffix.lower() in AUDITED) if is_run else []
    exports = [path for path in exports if is_file(path, root=folder)]
    return _with_engines(found, exports) if (choices or AuditOptions()).engines else found


def _with_engines(found: Audit, exports: Sequence[Path]) -> Audit:
    """Return an audit with the verdicts of engines on exports; `audit_file` checks what else concerns readers of them."""
    start, engines, findings = time.monotonic(), [*found.engines], [*found.findings]
    for path in exports:
        names = ENGINES.get(AUDITED.get(path.suffix.lower(), ""), ())
        try:
            require_closed(path)
        except ArticadError as error:
            findings += error.findings
            continue
        loadings = load_in_all(path, names)
        engines += loadings
        findings += [replace(finding, where=f"{path.name}: {finding.where}") for finding in refusals(loadings)]
    return replace(found, engines=tuple(engines), findings=Findings(findings), seconds=found.seconds + time.monotonic() - start)


def _report(file: str, kind: str, found: _Found, start: float) -> Audit:
    declared = found.declared
    moving = sum(joint.moves for joint in declared.joints) if declared else 0
    return Audit(
        file,
        kind,
        declared.name if declared else "",
        len(declared.links) if declared else 0,
        moving,
        Findings(found.findings),
        found.engines,
        tuple(dict.fromkeys(found.undone)),
        found.motion,
        time.monotonic() - start,
        found.certificate,
    )


# ---------------------------------------------------------------------- one function per format


def _urdf(path: Path, choices: AuditOptions, found: _Found) -> None:
    document = read_xml(path)
    if document.tag != "robot":
        raise ReadError(f"{path}: The root element is <{document.tag}>, not <robot>.", path=str(path), findings=[_no_robot(path, document)])
    require_bounded(document, path)
    root = choices.root or package_of(path)
    text = UrdfText(MeshReferences(Folder.of(path, root)))
    found.declared = text.declared(document, path)
    found.findings += text.findings
    if any(shape.problem == "unsafe" for link in found.declared.links for shape in link.shapes):
        found.undone.append("engines, contact and motion: the file names meshes outside the folders that may be read")
        _check_text(found)
        return
    require_closed(path, root)
    found.engines = load_in_all(path, ENGINES["urdf"], root=root) if choices.engines else ()
    found.findings += refusals(found.engines)
    _read_and_look(found, lambda: read_urdf(path, root=root), choices, path)


def _mjcf(path: Path, choices: AuditOptions, found: _Found) -> None:
    root = choices.root or package_of(path)
    require_closed(path, root)
    found.engines = load_in_all(path, ENGINES["mjcf"], root=root) if choices.engines else ()
    assembly = read_mjcf(path, root=root)
    found.findings += [*refusals(found.engines), *assembly.findings.of("W_IMPORT_MUJOCO")]
    simple, _ = _mask(found.engines)
    found.declared = from_assembly(assembly, "mjcf", states_inertia=False, states_collision=True, simple=simple)
    _look(found, assembly, choices)


def _freecad(path: Path, choices: AuditOptions, found: _Found) -> None:
    assembly = read_freecad(path)
    found.declared = from_assembly(assembly, "freecad", states_inertia=False, states_collision=False)
    found.findings += assembly.findings
    _look(found, assembly, choices)


def _step(path: Path, choices: AuditOptions, found: _Found) -> None:
    del choices
    found.declared, findings, undone = audit_step(path)
    found.findings += findings
    found.undone += undone


_AUDITORS: Final[dict[str, Callable[[Path, AuditOptions, _Found], None]]] = {
    "urdf": _urdf,
    "mjcf": _mjcf,
    "freecad": _freecad,
    "step": _step,
}


# ---------------------------------------------------------------------- checks


def _read_and_look(found: _Found, read: Callable[[], Assembly], choices: AuditOptions, path: Path) -> None:
    """Check the text; check the mechanism, if there is one."""
    try:
        assembly = read()
    except ArticadError as error:
        _check_text(found)
        if not any(finding.severity == "error" for finding in found.findings):  # otherwise a finding about the text has said why
            found.findings += error.findings or [_unreadable(path, error)]
        return
    assert found.declared is not None
    found.declared = replace(found.declared, states_frames=not assembly.foreign)
    _look(found, assembly, choices)


def _look(found: _Found, assembly: Assembly, choices: AuditOptions) -> None:
    assert found.declared is not None
    _check_text(found)
    found.findings += _carriers(found.declared, assembly)
    found.undone += [finding.message for finding in assembly.findings if finding.code == "W_IMPORT_DROPPED"]
    simple, excluded = _mask(found.engines)
    if not choices.motion:
        return
    outcome: Contacts = contacts(
        assembly, found.declared, budget=choices.budget, certified=choices.certified, simple=simple, filtered=excluded
    )
    found.findings += outcome.findings
    found.undone += outcome.undone
    if assembly.foreign and found.declared.format in FOREIGN:
        jams, undone = hull_jams(assembly, excluded)
        found.findings += jams
        found.undone += undone
    found.certificate = outcome.certificate
    found.motion = outcome.strength if assembly.drivers else "none"


def _check_text(found: _Found) -> None:
    assert found.declared is not None
    for check in CHECKS:
        if found.declared.format != "urdf" and check in structure.CHECKS:
            continue  # other formats' readers refuse what is not a mechanism
        if found.declared.format in _CAD_NAMES and check is names.awkward_names:
            continue
        found.findings += check(found.declared)


def _carriers(declared: Declared, assembly: Assembly) -> Iterator[Finding]:
    """Return findings about chains over bare links in URDF that represent a joint that URDF does not have."""
    if declared.format != "urdf":
        return
    for finding in assembly.findings.of("I_IMPORT_CHAIN"):
        yield Finding(
            code="I_AUDIT_CARRIERS",
            where=finding.where,
            message=f"{finding.message} Links without shape represent it.",
            hint="Nothing needs to be done for URDF, which has no such joint; for MJCF and CAD, merge them with `articad convert --fuse`.",
            cause="carrier",
        )


def _mask(loadings: tuple[Loading, ...]) -> tuple[frozenset[str], frozenset[frozenset[str]]]:
    """Return MuJoCo's data about an MJCF's bodies: which collide with simple shapes, which pairs never collide."""
    for loading in loadings:
        if loading.engine == "mujoco" and loading.loads:
            return frozenset(loading.simple), frozenset(map(frozenset, loading.excluded))
    return frozenset(), frozenset()


def _no_robot(path: Path, document: Any) -> Finding:
    return Finding(
        code="E_READ",
        where=f"{path} (line {document.sourceline})",
        message=f"The root element is <{document.tag}>, not <robot>.",
        hint="Is this URDF? Expand xacro first.",
    )


def _unreadable(path: Path, error: ArticadError) -> Finding:
    return Finding(code="E_READ", where=str(path), message=error.message, hint="Correct the file at the named place.")
