"""Audit files from any source; simulate them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import SANDBOX, amount
from articad.commands.steps import loaded
from articad.processes import scratch

if TYPE_CHECKING:
    from articad.assembly import Assembly
    from articad.auditing.examine import AuditOptions
    from articad.auditing.mend import Mended
    from articad.auditing.report import Audit, Scoreboard
    from articad.commands.terminal import Report, Terminal
    from articad.simulation.verdict import EngineOutcome


@command(
    "audit",
    "Find the faults of a URDF, MJCF, FreeCAD or STEP file, a plan, a run, or a folder of models.",
    argument("target", metavar="FILE|DIR"),
    argument("--table", action="store_true", help="one line per file, for a folder of many"),
    argument("--root", metavar="DIR", help="folder that meshes may be read from (the file's ROS package, or its own folder)"),
    argument(
        "--budget",
        metavar="SECONDS",
        type=amount,
        default=12.0,
        help="nominal seconds of work for checking the motion of a file, the same work on every machine (12)",
    ),
    argument(
        "--certify",
        metavar="SECONDS",
        type=amount,
        default=None,
        help="prove the motion collision-free instead of sampling it, within this many nominal seconds of work",
    ),
    argument("--no-engines", dest="engines", action="store_false", help="do not ask simulators to load the file"),
    argument("--fix", metavar="OUT", help="write a copy that repairs every fault with a certain repair (URDF)"),
    argument("--density", metavar="KG_M3", type=amount, default=None, help="with --fix: density of bodies without mass"),
    argument(
        "--collision",
        choices=["pieces"],
        default=None,
        help="with --fix: divide collision meshes into convex pieces inside them, where simulators would use the hull",
    ),
    argument("--report", metavar="PAGE.html", help="write the report as a page"),
    SANDBOX,
)
def _audit(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.auditing.examine import AuditOptions
    from articad.errors import ReadError

    root = None if options.root is None else Path(options.root)
    choices = AuditOptions(root=root, budget=options.budget, certified=options.certify, engines=options.engines)
    target = Path(options.target)
    if not target.exists():
        raise ReadError(f"There is no {target}.", path=str(target))
    if target.is_dir() and not any((target / name).is_file() for name in ("request.json", "plan.json")):
        return _audit_folder(options, terminal, choices)
    audit = _audit_one(options, terminal, choices)
    if options.report:
        from articad.auditing.page import audit_page

        scratch.write(Path(options.report), audit_page(audit, _model(options, terminal)).encode())
    _print_audit(audit, terminal, findings=not options.table)
    report = audit.to_json()
    if options.fix:
        mended = _mend(options, terminal, choices)
        _print_mended(mended, terminal)
        report |= {"fix": mended.to_json()}
    return report


@command(
    "sim",
    "Test a model in MuJoCo and PyBullet: load it, hold it, drive every joint, and release it.",
    argument("target", metavar="FILE|RUN|PLAN_DIR"),
    argument("--film", metavar="FILE.png", help="write a filmstrip of the joints' motion"),
    argument("--engine", choices=["mujoco", "pybullet"], action="append", default=None, help="only this engine (both, if installed)"),
    argument("--seconds", metavar="SECONDS", type=amount, default=300.0, help="time limit for each engine (300)"),
    SANDBOX,
)
def _sim(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.simulation.examine import ENGINES, SIMULATED, readable, simulate_assembly, simulate_file

    engines = tuple(options.engine or ENGINES)
    target = Path(options.target)
    if target.suffix.lower() in SIMULATED:
        with terminal.progress("Simulating"):
            verdict = simulate_file(target, engines=engines, seconds=options.seconds)
            assembly = readable(target) if options.film else None
    else:
        assembly = loaded(options.target, options, terminal)
        with terminal.progress("Simulating"):
            verdict = simulate_assembly(assembly, options.target, engines=engines, seconds=options.seconds)
    report = verdict.to_json()
    rows = [
        (
            outcome.engine,
            "not finished" if outcome.late is not None else {True: "yes", False: "no", None: "not installed"}[outcome.loads],
            f"{outcome.speed_at_rest:.3g}",
            f"{100 * min((reach.share for reach in outcome.judged), default=1.0):.3g} % of {len(outcome.judged)}",
            f"{1000 * outcome.residual:.3g}",
            "" if outcome.energy_growth is None else f"{100 * outcome.energy_growth:.3g} %",
        )
        for outcome in verdict.outcomes
    ]
    terminal.table(["engine", "loads", "speed at rest", "joints reach", "residual mm", "energy gain"], rows)
    terminal.findings(verdict.findings)
    if options.film and assembly is not None and (strip := _film(assembly, verdict.outcomes)):
        scratch.write(Path(options.film), strip)
        report |= {"film": options.film}
        terminal.say(f"Film: {options.film}")
    terminal.say(f"{options.target}: {'stands and moves' if verdict.ok else 'NOT ok'}.")
    return report


def _film(assembly: Assembly, outcomes: Sequence[EngineOutcome]) -> bytes | None:
    """Return the filmstrip of the engine that kept frames."""
    from articad.simulation.film import film

    shown = next((outcome for outcome in outcomes if outcome.frames), None)
    return None if shown is None else film(assembly, shown)


def _audit_one(options: argparse.Namespace, terminal: Terminal, choices: AuditOptions) -> Audit:
    """Audit a file, or the assembly of a plan or a run with its exports."""
    from articad.auditing.examine import AUDITED, audit_file, audit_made

    if Path(options.target).suffix.lower() in AUDITED:
        with terminal.progress("Auditing"):
            return audit_file(options.target, choices)
    made = loaded(options.target, options, terminal)
    with terminal.progress("Auditing"):
        return audit_made(made, options.target, choices)


def _model(options: argparse.Namespace, terminal: Terminal) -> Assembly | None:
    """Return the model to show beside the findings, or None if the file has so severe faults that it cannot be read."""
    from articad.errors import ArticadError

    try:
        return loaded(options.target, options, terminal)
    except ArticadError:
        return None


def _audit_folder(options: argparse.Namespace, terminal: Terminal, choices: AuditOptions) -> Report:
    from articad.auditing.many import audit_folder, models_below
    from articad.errors import ReadError

    folder = Path(options.target)
    count = sum(1 for _ in models_below(folder))
    if not count:
        raise ReadError(f"There is no model below {folder}: no URDF, MJCF, FreeCAD or STEP file.", path=str(folder))
    with terminal.progress("Auditing", total=count) as tell:
        board = audit_folder(folder, choices, progress=tell)
    if options.report:
        from articad.auditing.page import scoreboard_page

        scratch.write(Path(options.report), scoreboard_page(board).encode())
    if not options.table:
        for audit in board.audits:
            _print_audit(audit, terminal, findings=True)
    _print_board(board, terminal)
    return board.to_json()


def _mend(options: argparse.Namespace, terminal: Terminal, choices: AuditOptions) -> Mended:
    from articad.auditing.mend import mend, mend_assembly

    if Path(options.target).suffix.lower() == ".urdf":
        return mend(options.target, options.fix, density=options.density, collision=options.collision, choices=choices)
    assembly = loaded(options.target, options, terminal)
    return mend_assembly(assembly, options.fix, density=options.density, collision=options.collision, choices=choices)


def _print_audit(audit: Audit, terminal: Terminal, *, findings: bool) -> None:
    from articad.auditing.page import loaded as loaded_in
    from articad.commands import summaries

    if findings:
        terminal.findings(audit.findings)
        for line in audit.undone:
            terminal.detail(f"  not checked: {line}")
    engines = loaded_in(audit)
    terminal.say(
        f"{audit.file}: {audit.links} links, {audit.joints} joints that move; {summaries.counted(audit.findings)}; motion {audit.motion}"
        f"{f'; loads in {engines}' if engines else ''}; {audit.seconds:.1f} s."
    )


def _print_board(board: Scoreboard, terminal: Terminal) -> None:
    from articad.auditing.page import loaded as loaded_in

    rows = [
        (a.file, a.format, a.links, a.joints, a.count("error"), a.count("warning"), a.count("info"), loaded_in(a), f"{a.seconds:.1f}")
        for a in board.audits
    ]
    terminal.table(["file", "format", "links", "joints", "errors", "warnings", "notes", "loads in", "s"], rows, right=(2, 3, 4, 5, 6, 8))
    terminal.say()
    terminal.table(["code", "files", "findings"], [(code, files, count) for code, count, files in board.codes], right=(1, 2))
    clean = sum(audit.ok for audit in board.audits)
    terminal.say(f"{board.folder}: {len(board.audits)} files, {clean} without a finding.")


def _print_mended(mended: Mended, terminal: Terminal) -> None:
    for line in mended.done:
        terminal.say(f"  repaired: {line}")
    if mended.rest is not None:
        terminal.say(f"Left in {mended.file}:")
        _print_audit(mended.rest, terminal, findings=True)
