"""The trial of one faulty product: what the pipeline finds without any model, and whether that names the mistake.

The steps are those of a run, in its order: the plan is read and checked, parts are built and compared with their contracts, the assembly is
examined at rest and over each joint's range. A step with an error ends the trial, as it ends a round of a run; so does a warning that a run
sends back to its author. If nothing was found, not even a warning, the full
sampled check of `articad build --verify sampled` follows.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Final, Literal, Self

import numpy as np

import articad
import articad_bench
from articad.agents.design import DOUBTS
from articad.agents.edit import Nobody
from articad.agents.evidence import examine
from articad.agents.part_builder import SENT_BACK
from articad.agents.rollback import Router
from articad.assembly import Assembly
from articad.errors import ArticadError, KernelError, PlanError
from articad.findings import Finding, Findings
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache, PartKernel
from articad.plan.remedies import advised
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad_bench.fault_repair import healed
from articad_bench.faulty import Fault, Json, Product
from articad_bench.reference import reference_folder
from articad_bench.subject import Subject
from articad_bench.task import tasks_in

__all__ = ["Row", "Tools", "Trial", "examined", "programs", "tried"]

Stage = Literal["plan", "build", "evidence", "sampled", "none"]
_SAME: Final = 1e-6  # relative difference of masses and places that is rounding
_SHOWN: Final = 4  # findings of a row


@dataclass(frozen=True)
class Tools:
    """What a trial builds with.

    Attributes:
        kernel: Builds scripts.
        cache: Stores built parts.
    """

    kernel: PartKernel
    cache: BuildCache

    @classmethod
    def default(cls) -> Tools:
        """Return build123d and the user's cache."""
        return cls(kernel_named("build123d"), BuildCache())


@dataclass(frozen=True)
class Trial:
    """What was found about a product.

    Attributes:
        stage: The step that found it; "none" if nothing above a note was found.
        findings: Errors and warnings.
        assembly: The product, if it could be assembled.
    """

    stage: Stage
    findings: Findings
    assembly: Assembly | None = None


@dataclass(frozen=True)
class Row:
    """The result of one case.

    Attributes:
        case: Product and kind.
        said: The mistake.
        stage: The step that found something.
        findings: The first findings: code, place, route, message.
        digest: Of plan and scripts: a row of another one is not of this case.
        escaped: Nothing above a note was found, although the product is another one.
        equivalent: Nothing was found because the product is the same: parts, places, masses, limits.
        named: A finding names a part or joint of the mistake, with a code that states its cause.
        addressed: Every such finding of the highest severity goes to whoever made the mistake.
        valid: Nothing was found about a faulty plan, and the product holds every check of its task: it is another answer to the same
            request.
        healed: Whether somebody who only does what the hints say ends with a product without errors and warnings; None if that was
            not measured.
        programs: Digest of the programs that judged the case.
    """

    case: str
    product: str
    kind: str
    side: str
    said: str
    stage: str
    findings: tuple[tuple[str, str, str, str], ...]
    digest: str
    escaped: bool = False
    equivalent: bool = False
    named: bool = False
    addressed: bool = False
    valid: bool = False
    healed: bool | None = None
    programs: str = ""

    @property
    def counts(self) -> bool:
        """Whether there is anything to be found."""
        return not (self.equivalent or self.valid)

    @classmethod
    def of(cls, fault: Fault, stage: str, found: Sequence[tuple[str, str, str, str]]) -> Self:
        """Return the row of a case that is not judged yet."""
        return cls(
            fault.name,
            fault.good.name,
            fault.kind.name,
            fault.kind.side,
            fault.said,
            stage,
            tuple(found),
            fault.digest,
            programs=programs(),
        )

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON."""
        return asdict(self)


def tried(fault: Fault, tools: Tools, *, repair: bool = False) -> Row:
    """Try one case. A defect of articad itself is the stage "defect", with its exception as the only finding.

    Args:
        fault: The case.
        tools: What parts are built with.
        repair: Whether to follow the hints, too; the products to which they lead are built.
    """
    try:
        trial = examined(fault.bad, tools)
        row = Row.of(fault, trial.stage, [(one.code, one.where, one.route or "", one.message) for one in trial.findings[:_SHOWN]])
        if trial.stage == "none" and trial.assembly is not None:
            return _unseen(row, fault, _assembled(fault.good, tools), trial.assembly)
    except Exception as error:  # noqa: BLE001 - the other cases are tried all the same
        return Row.of(fault, "defect", [("defect", fault.name, "", repr(error))])
    naming = [finding for finding in trial.findings if _names(finding, fault)]
    worst = [finding for finding in naming if finding.severity == naming[0].severity]
    sides = {fault.kind.side, "script"} if fault.kind.misplaces else {fault.kind.side}
    right = bool(worst) and all(_addressee(finding, fault) in sides for finding in worst)
    row = replace(row, named=bool(naming), addressed=right)
    return replace(row, healed=_healed(fault, row, trial, tools)) if repair else row


def _healed(fault: Fault, row: Row, trial: Trial, tools: Tools) -> bool:
    """Return whether a repair by hints heals; the author of a faulty script who is asked about it writes what was ordered."""
    if fault.kind.side == "script":
        return row.named and row.addressed
    for_design = [finding for finding in trial.findings if finding.stage == "plan" or finding.route == "design"]
    return healed(fault, for_design, lambda plan: _checked(plan).findings, lambda product: examined(product, tools).findings)


@cache
def programs() -> str:
    """Return a digest of the modules of articad and of this benchmark."""
    found = hashlib.sha256()
    for package in (articad, articad_bench):
        folder = Path(str(package.__file__)).parent
        for file in sorted(folder.rglob("*.py")):
            found.update(f"{file.relative_to(folder)}\n".encode() + file.read_bytes())
    return found.hexdigest()[:12]


def examined(product: Product, tools: Tools) -> Trial:
    """Take a product through the steps of a run until one finds an error.

    Warnings of a step are kept, and the next step follows.
    """
    stated = _checked(product.plan)
    found = stated.findings
    if not found.ok or not DOUBTS.isdisjoint(found.codes):
        return stated
    stage: Stage = "plan" if found else "none"
    try:
        assembly = _assembled(product, tools)
    except KernelError as error:
        return Trial("build", found + _serious(error.findings))
    built = _serious(assembly.findings)
    stage = "build" if built and stage == "none" else stage
    is_sent_back = not SENT_BACK.isdisjoint(built.codes)
    evidence = found + built + (Findings() if is_sent_back else _serious(examine(assembly).findings))
    if not evidence.ok:
        return Trial("evidence", evidence, assembly)
    if evidence:
        return Trial("evidence" if stage == "none" else stage, evidence, assembly)
    sampled = _serious(assembly.check(motion=True).findings)
    return Trial("sampled" if sampled else "none", sampled, assembly)


def _checked(plan: Json) -> Trial:
    """Return what the check of a plan finds."""
    try:
        return Trial("plan", _serious(advised(AssemblyPlan.from_json(plan))))
    except PlanError as error:
        return Trial("plan", _serious(error.findings))


def _assembled(product: Product, tools: Tools) -> Assembly:
    plan = AssemblyPlan.from_json(product.plan)
    return Assembly.from_plan(plan, dict(product.scripts), kernel=tools.kernel, cache=tools.cache, jobs=1)


def _serious(findings: Iterable[Finding]) -> Findings:
    return Findings(finding for finding in findings if finding.severity != "info")


def _names(finding: Finding, fault: Fault) -> bool:
    words = {*finding.parts, *finding.where.replace("[", ".").replace("]", "").split(".")}
    return finding.code in fault.kind.causes and not words.isdisjoint(fault.names)


def _addressee(finding: Finding, fault: Fault) -> str:
    """Return who gets a finding: "plan", "script" if it is the author of the faulty script, "other", or "open"."""
    if finding.stage == "plan":
        return "plan"
    if finding.severity != "error":
        return "plan" if finding.route == "design" else "script"
    try:
        resolved = resolve(AssemblyPlan.from_json(fault.bad.plan))
        scripts = {name: text.encode() for name, text in fault.bad.scripts.items()}
        repair = Router(Nobody()).decide(1, [finding], resolved, scripts)
    except ArticadError:
        return "open"
    if repair.design:
        return "plan"
    changed = {name for name, text in fault.bad.scripts.items() if text != fault.good.scripts[name]}
    return "script" if set(repair.code) <= changed or not changed else "other"


# ---------------------------------------------------------------- escapes


def _unseen(row: Row, fault: Fault, good: Assembly, bad: Assembly) -> Row:
    """Return the row of a case in which nothing was found."""
    if _is_same(good, bad):
        return replace(row, equivalent=True)
    return replace(row, valid=True) if fault.kind.side == "plan" and _is_valid(fault.good.name, bad) else replace(row, escaped=True)


def _is_valid(name: str, assembly: Assembly) -> bool:
    """Return whether an assembly holds every check of the task whose reference a product is; False if it is that of none."""
    tasks = [task for folder, task in tasks_in() if task.reference and reference_folder(folder, task) == Product.folder(name)]
    return bool(tasks) and all(judgement.ok for task in tasks for judgement in task.judge(Subject(assembly)))


def _is_same(good: Assembly, bad: Assembly) -> bool:
    """Whether two assemblies are the same product: parts, shapes, masses, places at rest and displaced, limits, couplings and fits.

    Shapes are compared by volume, centre, box and inertia in the assembly's frame.
    """
    if set(good.parts) != set(bad.parts) or good.mechanism.rest.shape != bad.mechanism.rest.shape:
        return False
    stated = [
        [*one.drivers, *((joint.name, joint.type, joint.limits) for joint in one.joints), *one.fits.items(), one.mechanism.couplings]
        for one in (good, bad)
    ]
    if str(stated[0]) != str(stated[1]):
        return False
    return all(np.allclose(_places(good, q), _places(bad, q), rtol=_SAME, atol=_SAME) for q in _configurations(good))


def _configurations(assembly: Assembly) -> list[Any]:
    """Return the rest pose, and one where each driver is moved a little: enough to show every axis."""
    rest = np.asarray(assembly.mechanism.rest, dtype=np.float64)
    moved = [rest]
    for column, driver in enumerate(assembly.drivers):
        q = rest.copy()
        q[column] += 0.05
        if driver.unit == "1":  # a component of a quaternion
            own = [at for at, other in enumerate(assembly.drivers) if other.joint == driver.joint and other.unit == "1"]
            q[own] /= np.linalg.norm(q[own])
        moved.append(q)
    return moved


def _places(assembly: Assembly, q: Any) -> Any:
    """Return centre, box and inertia of each part's surface in the assembly's frame at a configuration."""
    poses: Mapping[str, Any] = dict(zip(assembly.mechanism.parts, assembly.poses(q), strict=True))
    rows = []
    for name in sorted(assembly.parts):
        part = assembly.parts[name]
        if part.mesh is None or part.solid is None:
            continue
        points = poses[name].apply(part.mesh.vertices)
        turned = np.asarray(poses[name].rotation)
        inertia = turned @ part.solid.inertia_mm5 @ turned.T / max(part.solid.volume, 1e-9)
        mass = 0.0 if part.mass is None else part.mass.mass
        rows.append(
            [part.solid.volume, mass, *poses[name].apply(part.solid.com), *points.min(axis=0), *points.max(axis=0), *inertia.ravel()]
        )
    return np.array(rows)
