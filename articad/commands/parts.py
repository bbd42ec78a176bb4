"""Build parts of a plan on their own, as their author does until they keep their contracts."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import FORCE, SANDBOX
from articad.commands.steps import build_cache, sandbox_level

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal
    from articad.errors import KernelError
    from articad.kernels.parts import RealisedPart
    from articad.plan.resolve import ResolvedPlan


@command(
    "part",
    "Build parts of a plan and check them against their contracts.",
    argument("plan", metavar="PLAN_DIR"),
    argument("names", metavar="PART", nargs="*", help="parts to build, side by side (all that have a script)"),
    argument("--kernel", choices=["build123d", "freecad"], default=None, help="the kernel that builds the script (the plan's choice)"),
    SANDBOX,
    FORCE,
)
def _part(options: argparse.Namespace, terminal: Terminal) -> Report:
    from concurrent.futures import ThreadPoolExecutor

    from articad.assembly import DEFLECTION_MM
    from articad.errors import KernelError
    from articad.kernels.choice import kernel_named
    from articad.kernels.parts import build_source
    from articad.plan.resolve import resolve
    from articad.plan.schema import AssemblyPlan

    plan = AssemblyPlan.load(options.plan)
    resolved = resolve(plan)
    names = list(dict.fromkeys(options.names)) or [part.name for part in resolved.parts.values() if part.derivation is None]
    kind = options.kernel or plan.kernel
    folder = Path(options.plan) if Path(options.plan).is_dir() else Path(options.plan).parent
    scripts = {name: _script(resolved, name, folder / "parts", kind) for name in names}
    kernel, cache = kernel_named(kind, sandbox=sandbox_level(options)), build_cache(options)

    with terminal.progress("Building", total=len(names)) as tell, ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:

        def built(name: str) -> RealisedPart | KernelError:
            tell(name, "started")
            try:
                made = build_source(resolved, name, scripts[name], kernel=kernel, cache=cache, deflection=DEFLECTION_MM)
            except KernelError as error:
                tell(name, "failed")
                return error
            tell(name, "cached" if made.cached else "built")
            return made

        outcomes = dict(zip(names, pool.map(built, names), strict=True))
    only = outcomes[names[0]] if len(names) == 1 else None
    if isinstance(only, KernelError):
        raise only
    reports = {name: _reported(name, outcome, terminal) for name, outcome in outcomes.items()}
    if len(names) == 1:
        return {"schema": "articad.solid/1", "part": names[0], **reports[names[0]]}
    return {
        "schema": "articad.solids/1",
        "ok": all(report["ok"] for report in reports.values()),
        "parts": {name: {key: value for key, value in report.items() if key != "findings"} for name, report in reports.items()},
        "findings": [finding for report in reports.values() for finding in report["findings"]],
    }


def _script(resolved: ResolvedPlan, name: str, folder: Path, kernel: str) -> bytes:
    """Return the script of a part.

    Raises:
        ReadError: If there is no such part, it is derived, or the script cannot be read.
    """
    from articad.errors import ReadError, did_you_mean
    from articad.kernels.parts import read_script, script_file, script_of

    file = script_file(folder, name, kernel)
    target = resolved.parts.get(name)
    if target is None:
        message = f"The plan has no part {name!r}.{did_you_mean(name, resolved.parts)} It has {', '.join(resolved.parts)}."
        raise ReadError(message, path=str(file), where=name)
    if target.derivation is not None:
        message = f"{name!r} is derived: it needs no script. Build {target.derivation.source!r}, and it follows."
        raise ReadError(message, path=str(file), where=name)
    script = script_of(folder, target, kernel)
    return read_script(file, folder.parent) if script is None else script


def _reported(name: str, outcome: RealisedPart | KernelError, terminal: Terminal) -> Report:
    """Print what became of a part, and return its report."""
    from articad.errors import KernelError

    if isinstance(outcome, KernelError):
        terminal.findings(outcome.findings)
        terminal.say(f"{name}: not built.")
        return {"ok": False, "findings": [finding.to_json() for finding in outcome.findings]}
    solid, mass = outcome.built.solid, outcome.part.mass
    lower, upper = solid.bbox
    terminal.findings(outcome.findings)
    terminal.say(
        f"{name}: one valid solid, {solid.volume:.6g} mm³"
        f"{'' if mass is None else f', {mass.mass:.4g} kg'}, from {_point(lower)} to {_point(upper)} mm in its own frame."
    )
    return {
        "ok": outcome.findings.ok,
        "volume_mm3": solid.volume,
        "mass_kg": None if mass is None else mass.mass,
        "bbox_mm": solid.bbox.tolist(),
        "com_mm": solid.com.tolist(),
        "findings": [finding.to_json() for finding in outcome.findings],
    }


def _point(values: Iterable[float]) -> str:
    return f"({', '.join(f'{value:.5g}' for value in values)})"
