"""Build a plan; check it, or what was built from it."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import BUILD_ARGUMENTS, FORMATS, SANDBOX
from articad.commands.steps import assembled, loaded, reported, stage

if TYPE_CHECKING:
    from collections.abc import Sequence

    from articad.aliases import Progress
    from articad.assembly import Assembly
    from articad.commands.terminal import Report, Terminal
    from articad.runs.exporting import Exports
    from articad.runs.run import Run


@command(
    "build",
    "Build a plan's parts, assemble, check and export them.",
    argument("plan", metavar="PLAN_DIR"),
    argument(
        "--complete",
        action="store_true",
        help="certify the motion, have the proof checked and write every format, unless a check at rest fails; draw nothing, and print at most 15 lines",
    ),
    *BUILD_ARGUMENTS,
)
def _build(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands.steps import build_cache, draw, plan_in, sandbox_level
    from articad.commands.summaries import print_complete
    from articad.runs.exporting import Exports
    from articad.runs.record import (
        record_assembly,
        record_checked,
        record_checks,
        record_page,
        run_report,
    )
    from articad.runs.run import RunRequest, open_or_create, require_place

    terminal.logs = terminal.verbose or not options.complete
    plan = plan_in(options.plan)
    folder = Path(options.plan)
    scripts = (folder if folder.is_dir() else folder.parent) / "parts"
    choices = {"task": "build", "kernel": options.kernel or plan.kernel, "parameters": dict(options.parameters)}
    request = RunRequest(prompt=plan.name, options=choices)
    require_place(request, options.out)
    cache = build_cache(options)
    assembly = assembled(plan, scripts, options, terminal, cache=cache)
    pictures = options.pictures and not options.complete
    proves = options.verify == "certified" or options.complete
    formats = FORMATS if options.complete else options.formats
    verified: Report = {}
    stood: list[str] = []
    with open_or_create(request, options.out) as run:
        with terminal.progress("Finishing") as tell:
            run.save_plan(plan.dumps(), 0)
            record_assembly(run, assembly)
            with Exports(run, assembly, formats, beside=proves, cache=cache, sandbox=sandbox_level(options)) as exports:
                with stage(tell, "checks of rest and motion" if options.verify == "sampled" else "checks at rest"):
                    checks = assembly.check(motion=options.verify == "sampled")
                record_checks(run, checks)
                stops = options.complete and not checks.ok
                if proves and not stops:
                    with stage(tell, "proof of motion"):
                        certificate = assembly.certify(check=False)
                    with stage(tell, "check of the proof"):
                        verified = record_checked(run, certificate)
                if not stops:
                    stood = _exported(run, assembly, exports, formats, tell, tries=checks.ok)
            if pictures:
                with stage(tell, "page"):
                    record_page(run, assembly)
        if options.complete:
            report = run_report(run)
            if not stops:
                report |= {"ok": report["ok"] and verified["ok"], "verification": verified}
            print_complete(report, terminal, stood=stood)
            return report
        report = reported(run, terminal)
        if pictures:
            terminal.out.flush()  # the results can be read while pictures are drawn
            draw(run, assembly, options, terminal, cache)
    return report


def _exported(run: Run, assembly: Assembly, exports: Exports, formats: Sequence[str], tell: Progress, *, tries: bool) -> list[str]:
    """Save exports, and have MuJoCo load and hold those that it can; return the formats against which it says nothing."""
    from concurrent.futures import ThreadPoolExecutor

    from articad.runs.record import record_objections
    from articad.simulation.standing import STANDING, stands

    tried = {}
    with ThreadPoolExecutor() as pool:  # a simulation waits for a process of its own
        for name in formats:
            with stage(tell, f"export {name}"):
                main = Path(exports.record(name)["main"])
            if name in STANDING and tries:
                tried[name] = pool.submit(stands, assembly, main)
        for name, found in tried.items():
            with stage(tell, f"simulation of {name} at rest"):
                record_objections(run, name, found.result())
    return [name for name, found in tried.items() if not found.result()]


@command(
    "check",
    "Check a plan, or the plan and the geometry of a finished run.",
    argument("target", metavar="PLAN_DIR|RUN|FILE"),
    argument(
        "--motion", action="store_true", help="also sample the motion: drivers alone, two at a time, all at once (builds a plan's parts)"
    ),
    argument(
        "--joints",
        action="store_true",
        help="also report which surfaces form each joint, and which motions they leave free (builds a plan's parts)",
    ),
    argument(
        "--support",
        action="store_true",
        help="also report whether the product stands, what carries each part, and what falls out when it is turned over (builds a plan's parts)",
    ),
    SANDBOX,
)
def _check(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import summaries
    from articad.commands.steps import plan_in
    from articad.errors import PlanError
    from articad.plan.remedies import advised

    try:
        plan = plan_in(options.target)
    except PlanError as error:  # the findings about the plan are the result of this command
        if not error.findings:
            raise
        name, findings = str(options.target), error.findings
    else:
        name, findings = plan.name, advised(plan)
    terminal.findings(findings)
    terminal.say(f"{name}: {summaries.counted(findings)}.")
    if not findings.ok or not (options.motion or options.joints or options.support or (Path(options.target) / "request.json").is_file()):
        return findings.to_json()

    assembly = loaded(options.target, options, terminal)
    with terminal.progress("Checking"):
        checks = assembly.check(motion=options.motion)
    report = checks.to_json()
    summaries.print_findings(report["findings"], terminal)
    summaries.print_statements(report, None, terminal, moves=bool(assembly.drivers), certify=f"articad certify {options.target}")
    if options.joints:
        with terminal.progress("Judging joints"):
            report["joints"] = assembly.check_joints().to_json()
        summaries.print_findings(report["joints"]["findings"], terminal)
        summaries.print_joints(report["joints"]["rows"], terminal)
    if options.support:
        with terminal.progress("Weighing"):
            report["support"] = assembly.check_support().to_json()
        summaries.print_findings(report["support"]["findings"], terminal)
        summaries.print_support(report["support"], terminal)
    return report
