"""Operations on a file, a folder or an assembly: read, audit, certify, simulate, find an order of assembly.

Each function takes an assembly, a file in any format that is read, a plan folder, or a run folder.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

from articad import formats
from articad.aliases import Fastening, Progress
from articad.assembly import Assembly
from articad.auditing.examine import AUDITED, AuditOptions, audit_assembly, audit_file, audit_made
from articad.auditing.report import Audit
from articad.certificates.certificate import DEFAULT_BUDGET_S, DEFAULT_EPSILON_MM, Certificate
from articad.disassembly.steps import AssemblyOrder
from articad.plan.iso2768 import ToleranceClass
from articad.plan.schema import AssemblyPlan
from articad.runs.record import assembly_of
from articad.runs.run import REQUEST_FILE, Run
from articad.simulation.examine import ENGINES, SIMULATED, simulate_assembly, simulate_file
from articad.simulation.loading import Engine
from articad.simulation.trial import SECONDS
from articad.simulation.verdict import SimulationVerdict

__all__ = ["assembly_order", "audit", "certify", "read", "simulate"]


def read(
    source: str | Path,
    *,
    root: str | Path | None = None,
    fuse: bool = False,
    sandbox: Literal["strict", "weak"] = "strict",
    progress: Progress | None = None,
) -> Assembly:
    """Read an assembly. Parts that the cache holds are not built again.

    Args:
        source: A URDF, MJCF, FreeCAD or STEP file; a plan, `plan.json` or its folder, with part scripts beside it; or a run folder.
        root: Folder that meshes of a file may be read from; the file's own by default.
        fuse: For URDF and MJCF: replace chains of joints over links without shapes, and the constraints that close a loop, by the one joint that they
            represent, such as a ball or a hinge.
        sandbox: "weak" runs part scripts with less isolation than Landlock or bubblewrap give.
        progress: Called with the outcome of each part that is built.

    Raises:
        ReadError: If the source cannot be read.
        PlanError: If the plan has errors.
        ContractError: If a part cannot be built.
    """
    path = Path(source)
    if (path / REQUEST_FILE).is_file():
        with Run.view(path) as run:
            return assembly_of(run, sandbox=sandbox, progress=progress)
    if path.is_dir() or path.suffix.lower() == ".json":
        plan = AssemblyPlan.load(path)
        folder = path if path.is_dir() else path.parent
        return Assembly.from_plan(plan, folder / "parts", sandbox=sandbox, progress=progress)
    return formats.read(path, root=root, fuse=fuse)


def audit(target: str | Path | Assembly, options: AuditOptions | None = None) -> Audit:
    """Find what is wrong with a model; every fault is a finding.

    Args:
        target: As for `read`, or an assembly.
        options: What to look at; everything but proofs by default.

    Raises:
        ReadError: If it is not a file, plan or run.
    """
    if isinstance(target, Assembly):
        return audit_assembly(target, target.name, "plan", options)
    if Path(target).suffix.lower() in AUDITED:
        return audit_file(target, options)
    return audit_made(read(target), target, options)


def certify(
    target: str | Path | Assembly,
    joints: Sequence[str] | None = None,
    *,
    pairs: bool = True,
    epsilon: float = DEFAULT_EPSILON_MM,
    budget: float = DEFAULT_BUDGET_S,
    tolerance: ToleranceClass | None = None,
) -> Certificate:
    """Prove that no parts meet while joints move over their whole ranges; see `Assembly.certify`.

    Args:
        target: As for `read`, or an assembly.
        joints: Names of the joints to be proven; all that move by default.
        pairs: Whether joints are also moved two at a time.
        epsilon: Distances up to this count as contact [mm].
        budget: Nominal seconds of work, the same work on every machine.
        tolerance: Class of ISO 2768-1, such as "m", within which the claims are to hold; None for parts as they are modelled.
    """
    assembly = target if isinstance(target, Assembly) else read(target)
    return assembly.certify(joints, pairs=pairs, epsilon=epsilon, budget=budget, tolerance=tolerance)


def assembly_order(target: str | Path | Assembly, fastenings: Mapping[str, Fastening] | None = None) -> AssemblyOrder:
    """Find an order in which the parts go together, with a proven path for each; see `Assembly.assembly_order`.

    Args:
        target: As for `read`, or an assembly.
        fastenings: By joint name how it is fastened, such as "snap".
    """
    return (target if isinstance(target, Assembly) else read(target)).assembly_order(fastenings)


def simulate(target: str | Path | Assembly, *, engines: tuple[Engine, ...] = ENGINES, seconds: float = SECONDS) -> SimulationVerdict:
    """Hold, drive and let go a model in simulators.

    Args:
        target: As for `read`, or an assembly. A URDF or MJCF file is simulated as it is; anything else as articad exports it.
        engines: Engines to use; those that are not installed are skipped.
        seconds: Time limit of each engine.
    """
    if isinstance(target, Assembly):
        return simulate_assembly(target, target.name, engines=engines, seconds=seconds)
    if Path(target).suffix.lower() in SIMULATED:
        return simulate_file(target, engines=engines, seconds=seconds)
    return simulate_assembly(read(target), str(target), engines=engines, seconds=seconds)
