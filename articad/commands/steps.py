"""Steps that several commands share: find an assembly, build it, print a finished run."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from articad.agents.llm import Budget
    from articad.aliases import Progress
    from articad.assembly import Assembly
    from articad.commands.terminal import Report, Terminal
    from articad.kernels.kernel import BuildCache
    from articad.memory.experience import ExperienceStore
    from articad.plan.schema import AssemblyPlan
    from articad.runs.run import Run


def assembled(
    plan: AssemblyPlan, scripts: Path, options: argparse.Namespace, terminal: Terminal, *, cache: BuildCache | None = None
) -> Assembly:
    """Build the parts with progress, and assemble them; `cache` instead of `build_cache(options)`."""
    from articad.assembly import Assembly
    from articad.kernels.choice import kernel_named

    with terminal.progress("Building", total=len(plan.parts)) as tell:
        return Assembly.from_plan(
            plan,
            scripts,
            kernel=kernel_named(options.kernel or plan.kernel, sandbox=sandbox_level(options)),
            jobs=options.jobs,
            cache=cache or build_cache(options),
            progress=tell,
            parameters=dict(options.parameters),
        )


def plan_in(target: str) -> AssemblyPlan:
    """Return the plan of a file or folder.

    Raises:
        PlanError: If it does not have the form; with all other faults that can be found.
        ReadError: If it cannot be read.
    """
    from articad.errors import PlanError
    from articad.plan.beyond import further_findings
    from articad.plan.schema import AssemblyPlan

    try:
        return AssemblyPlan.load(target)
    except PlanError as error:
        findings = further_findings(Path(target), error.findings)
        raise PlanError("\n".join(map(str, findings.errors)), findings=findings) from None


@contextmanager
def stage(tell: Progress, name: str) -> Iterator[None]:
    """Report that a step of the program begins, and that it is done."""
    tell(name, "started")
    yield
    tell(name, "done")


def reported(run: Run, terminal: Terminal) -> Report:
    """Print a summary of a finished run, and return its report."""
    from articad.commands.summaries import print_run
    from articad.runs.record import run_report

    report = run_report(run)
    print_run(report, terminal)
    return report


def experience(options: argparse.Namespace, budget: Budget | None = None) -> ExperienceStore:
    """Return the store of earlier runs, with the requested vectors; a provider's vectors count as calls of the budget."""
    from articad.memory.experience import ExperienceStore

    if not options.embeddings:
        return ExperienceStore(options.memory)
    from articad.agents.live import LiteLLMEmbedder

    return ExperienceStore(
        options.memory,
        LiteLLMEmbedder(options.embeddings, api_base=options.api_base, meter=None if budget is None else budget.meter("embeddings")),
    )


def build_cache(options: argparse.Namespace) -> BuildCache:
    """Return the user's cache of parts, or with --force an empty one."""
    from articad.kernels.kernel import BuildCache

    return BuildCache(None) if options.force else BuildCache()


def loaded(target: str, options: argparse.Namespace, terminal: Terminal) -> Assembly:
    """Return the assembly of a run, a file or a plan, and show progress; see `articad.read`."""
    from articad.entry import read

    with terminal.progress("Reading") as tell:
        return read(target, sandbox=sandbox_level(options), progress=tell)


def draw(run: Run, assembly: Assembly, options: argparse.Namespace, terminal: Terminal, cache: BuildCache) -> None:
    """Draw the pictures of a run whose results are on disk, with progress; pictures that cannot be drawn fail nothing."""
    from articad.runs.drawing import record_pictures

    with terminal.progress("Drawing") as tell, stage(tell, "pictures"):
        missing = record_pictures(run, assembly, cache=cache, sandbox=sandbox_level(options))
    if missing is not None:
        terminal.say(f"Pictures: not all were drawn ({missing}); everything else is complete.")


def sandbox_level(options: argparse.Namespace) -> Literal["strict", "weak"]:
    """Return the required isolation: from the flag, else from $ARTICAD_SANDBOX."""
    return "weak" if (options.sandbox or os.environ.get("ARTICAD_SANDBOX")) == "weak" else "strict"
