"""Build one part of a plan on its own, as its author does until it keeps its contract."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import FORCE, SANDBOX
from articad.commands.steps import build_cache, sandbox_level
from articad.files import SCRIPT_BYTES, read_file

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


@command(
    "part",
    "Build one part of a plan and check it against its contract.",
    argument("plan", metavar="PLAN_DIR"),
    argument("name", metavar="PART"),
    argument("--kernel", choices=["build123d", "freecad"], default=None, help="the kernel that builds the script (the plan's choice)"),
    SANDBOX,
    FORCE,
)
def _part(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.assembly import DEFLECTION_MM
    from articad.errors import ReadError, did_you_mean
    from articad.kernels.choice import kernel_named
    from articad.kernels.parts import SCRIPT_SUFFIX, build_source
    from articad.plan.resolve import resolve
    from articad.plan.schema import AssemblyPlan

    plan = AssemblyPlan.load(options.plan)
    resolved = resolve(plan)
    target = resolved.parts.get(options.name)
    if target is None:
        message = f"The plan has no part {options.name!r}.{did_you_mean(options.name, resolved.parts)} It has {', '.join(resolved.parts)}."
        raise ReadError(message, path=str(options.plan), where=options.name)
    if target.derivation is not None:
        message = f"{options.name!r} is derived: it needs no script. Build {target.derivation.source!r}, and it follows."
        raise ReadError(message, path=str(options.plan), where=options.name)
    folder = Path(options.plan)
    name = options.kernel or plan.kernel
    file = (folder if folder.is_dir() else folder.parent) / "parts" / f"{options.name}{SCRIPT_SUFFIX[name]}"
    try:
        script = read_file(file, SCRIPT_BYTES, root=file.parent.parent)
    except OSError as error:
        raise ReadError.at(file, f"{file} cannot be read: {error.strerror}.", "Write the script there.") from None
    kernel = kernel_named(name, sandbox=sandbox_level(options))
    with terminal.progress("Building", total=1) as tell:
        made = build_source(resolved, options.name, script, kernel=kernel, cache=build_cache(options), deflection=DEFLECTION_MM)
        tell(options.name, "cached" if made.cached else "built")
    solid, mass = made.built.solid, made.part.mass
    lower, upper = solid.bbox
    terminal.findings(made.findings)
    terminal.say(
        f"{options.name}: one valid solid, {solid.volume:.6g} mm³"
        f"{'' if mass is None else f', {mass.mass:.4g} kg'}, from {_point(lower)} to {_point(upper)} mm in its own frame."
    )
    return {
        "schema": "articad.solid/1",
        "ok": made.findings.ok,
        "part": options.name,
        "volume_mm3": solid.volume,
        "mass_kg": None if mass is None else mass.mass,
        "bbox_mm": solid.bbox.tolist(),
        "com_mm": solid.com.tolist(),
        "findings": [finding.to_json() for finding in made.findings],
    }


def _point(values: Iterable[float]) -> str:
    return f"({', '.join(f'{value:.5g}' for value in values)})"
