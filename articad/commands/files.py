"""Write a run in other formats; convert files; adopt files from elsewhere."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from articad.commands.command import argument, command
from articad.commands.options import DRAWINGS, FORMATS, SANDBOX, SPLIT, TREES, formats

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


@command(
    "export",
    "Write a finished run in other formats.",
    argument("run", metavar="RUN"),
    argument("--to", metavar="FORMATS", dest="formats", type=formats, required=True, help=f"formats to write, of {', '.join(FORMATS)}"),
    argument("--out", metavar="DIR", help="where to write, a folder for each format; by default RUN/export"),
    argument("--strict", action="store_true", help="fail on what a format cannot represent, instead of reporting it as lost"),
    argument("--loops", choices=["none", "isaac", "drake", "mimic"], default=None, help="how URDF closes loops (none)"),
    argument(
        "--collision",
        choices=["pieces", "solid", "hull"],
        default=None,
        help="what simulators collide with: convex pieces inside the parts, the parts' own fine meshes, which are then drawn, too, or their hulls "
        "(pieces)",
    ),
    argument(
        "--actuators",
        choices=["position", "motor"],
        default=None,
        help="give every driver of an MJCF a position servo, or a motor that takes forces, of the joint's effort",
    ),
    argument(
        "--keep-frames",
        action="store_true",
        help="for URDF: give every link its part's frame, with an empty link and a fixed joint where a joint's axis misses its origin",
    ),
    argument(
        "--flat",
        action="store_true",
        help="for STEP: write all parts side by side, without sub-assemblies of parts that are fixed together",
    ),
    argument("--ros", metavar="PACKAGE", default=None, help="write URDF as a ROS 2 package, with SRDF and ros2_control"),
    argument(
        "--process", choices=["fdm", "sla", "sls"], default=None, help="the printing process for 3MF: gaps are checked against it (fdm)"
    ),
    SPLIT,
    TREES,
    DRAWINGS,
)
def _export(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import summaries
    from articad.commands.steps import stage
    from articad.formats import NAMED, require_options
    from articad.runs.record import assembly_of, record_export
    from articad.runs.run import Run

    ros = options.ros is not None
    choices = {
        "loops": options.loops,
        "collision": options.collision,
        "actuators": options.actuators,
        "package": options.ros,
        "srdf": ros,
        "ros2_control": ros,
        "process": options.process,
        "keep_frames": options.keep_frames,
        "flat": options.flat,
        "split": options.split,
        "trees": options.trees,
        "drawings": options.drawings,
    }
    choices = {name: value for name, value in choices.items() if value}  # each writer has its own defaults
    require_options([NAMED[name] for name in options.formats], set(choices) - {"srdf", "ros2_control"})  # those follow from --ros
    with Run.view(options.run) as run, terminal.progress("Reading") as tell:
        assembly = assembly_of(run, progress=tell)
    exports: dict[str, Report] = {}
    with terminal.progress("Exporting", total=len(options.formats)) as tell:
        if options.out is None:
            with Run.open(options.run) as run:
                for name in options.formats:
                    with stage(tell, name):
                        exports[name] = record_export(run, assembly, name, strict=options.strict, **choices)
        else:
            for name in options.formats:
                with stage(tell, name):
                    bundle = NAMED[name].write(assembly, strict=options.strict, **choices)
                    main = bundle.write(Path(options.out) / name)[0]
                exports[name] = bundle.to_json() | {"folder": str(main.parent), "main": str(main)}
    summaries.print_exports(exports, terminal)
    return {"schema": "articad.exports/1", "ok": all(export["ok"] for export in exports.values()), "exports": exports, "findings": []}


@command(
    "convert",
    "Convert a file into another format.",
    argument("source", metavar="IN", help="a .urdf, .xacro, .xml (MJCF), .sdf, .FCStd or .step file, or a plan.json"),
    argument("target", metavar="OUT", help="its suffix selects the format: .urdf .xml .FCStd .json .sdf .usda .step .glb .3mf"),
    argument("--root", metavar="DIR", default=None, help="folder that meshes and included files may be read from (the file's own)"),
    argument("--srdf", metavar="FILE", default=None, help="for URDF: the SRDF that belongs to it (the one of its name beside it)"),
    argument("--strict", action="store_true", help="fail on what the format cannot represent, instead of reporting it as lost"),
    argument(
        "--fuse",
        action="store_true",
        help="for URDF, MJCF and SDF: replace chains of joints over links without shape, and the constraints that close a loop, by one joint",
    ),
    argument(
        "--keep-frames",
        action="store_true",
        help="for URDF: give every link its part's frame, with an empty link and a fixed joint where a joint's axis misses its origin",
    ),
    SPLIT,
    TREES,
    DRAWINGS,
)
def _convert(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import summaries
    from articad.formats import convert, format_of

    target = Path(options.target)
    given = {"keep_frames": options.keep_frames, "split": options.split, "trees": options.trees, "drawings": options.drawings}
    more: dict[str, Any] = {name: True for name, value in given.items() if value}  # a format without the option refuses it
    read = {"root": options.root, "fuse": options.fuse, "srdf": options.srdf}
    with terminal.progress("Converting"):
        assembly, bundle = convert(options.source, target, strict=options.strict, **read, **more)
    report = bundle.to_json() | {"folder": str(target.parent), "main": str(target)}
    terminal.findings(assembly.findings)
    summaries.print_exports({getattr(format_of(target), "name", ""): report}, terminal)
    return report | {"findings": [finding.to_json() for finding in assembly.findings + bundle.findings]}


@command(
    "adopt",
    "Turn a URDF, MJCF, SDFormat, FreeCAD or STEP file into a plan folder that builds at once.",
    argument("source", metavar="FILE", help="a .urdf, .xml (MJCF), .sdf, .FCStd or .step file"),
    argument("--out", metavar="DIR", required=True, help="the folder: plan.json, parts/*.py, meshes/*.stl; it must be empty or new"),
    argument("--root", metavar="DIR", default=None, help="folder that meshes may be read from (the file's own)"),
    argument("--script", metavar="FILE", default=None, help="the program that made the file; a copy is kept beside the plan"),
    argument(
        "--fuse",
        action="store_true",
        help="for URDF, MJCF and SDF: replace chains of joints over links without shape, and the constraints that close a loop, by one joint",
    ),
    argument(
        "--no-build", dest="build", action="store_false", help="do not build the parts; those that cannot be built are not simplified"
    ),
    argument("--no-audit", dest="audit", action="store_false", help="do not audit the file"),
    SANDBOX,
)
def _adopt(options: argparse.Namespace, terminal: Terminal) -> Report:
    import json

    from articad.commands import summaries
    from articad.commands.steps import sandbox_level
    from articad.errors import WriteError
    from articad.files import SCRIPT_BYTES, read_file
    from articad.kernels.cache import BuildCache
    from articad.kernels.choice import kernel_named
    from articad.processes import scratch
    from articad.runs.adopt import adopt

    source, folder = Path(options.source), Path(options.out)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise WriteError(f"{folder} is not empty.", path=str(folder))
    if options.script is not None and not Path(options.script).is_file():
        raise WriteError(f"There is no file {options.script}.", path=options.script)
    kernel = kernel_named("build123d", sandbox=sandbox_level(options)) if options.build else None
    with terminal.progress("Building") as tell:
        assembly, bundle = adopt(source, root=options.root, fuse=options.fuse, kernel=kernel, cache=BuildCache(), progress=tell)
    files = bundle.write(folder)
    if options.script is not None:
        files.append(folder / "source" / Path(options.script).name)
        scratch.write(files[-1], read_file(options.script, SCRIPT_BYTES))
    summaries.print_exports({"plan": bundle.to_json() | {"main": str(files[0])}}, terminal)
    report = bundle.to_json() | {"schema": "articad.adopt/1", "folder": str(folder), "files": [str(file) for file in files]}
    report |= {"parts": len(assembly.parts), "joints": len(assembly.joints), "freedoms": assembly.mechanism.mobility}
    if options.audit:
        found = _audit_of(source, options.root, terminal)
        scratch.write(folder / "audit.json", json.dumps(found, indent=1).encode())
        report |= {"audit": found}
    terminal.say(f"Next: articad build {folder}")
    return report


def _audit_of(source: Path, root: str | None, terminal: Terminal) -> Report:
    """Audit the file that was adopted; its faults do not prevent the adoption."""
    from articad.auditing.examine import AuditOptions, audit_file

    found = audit_file(source, AuditOptions(root=None if root is None else Path(root)))
    terminal.say(f"Faults of {source.name}: {'none found' if found.ok else ''}")
    terminal.findings(found.findings)
    return found.to_json()


@command(
    "pull",
    "Bring edits of a run's FreeCAD document back: make a new run with a new version of the plan.",
    argument("run", metavar="RUN"),
    argument("document", metavar="DOCUMENT.FCStd"),
    argument("--out", metavar="DIR", help="the new run; by default a folder below runs/"),
    argument("--formats", type=formats, default=("urdf", "step"), metavar="FORMATS", help="formats to write (urdf,step)"),
    SANDBOX,
)
def _pull(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.assembly import Assembly
    from articad.commands import summaries
    from articad.commands.steps import sandbox_level, stage
    from articad.export.freecad_content import UNCOMPARED
    from articad.findings import Findings
    from articad.kernels.choice import kernel_named
    from articad.kernels.kernel import BuildCache
    from articad.plan.schema import AssemblyPlan
    from articad.runs.pull import compared, pull
    from articad.runs.record import assembly_of, record_assembly, record_checks, record_export
    from articad.runs.run import Run, RunRequest, open_or_create, require_place

    with Run.view(options.run) as run:
        base = assembly_of(run)
        kernel = str(run.request.options.get("kernel", "build123d"))
    if base.resolved is None:
        raise AssertionError("a run has a plan")
    plan = base.resolved.plan
    if base.resolved.overrides:
        from articad.agents.edit_base import with_values

        plan = with_values(plan, base.resolved.overrides)
    pulled = pull(plan, options.document)
    scripts = {name: part.script for name, part in base.realised.items() if part.script is not None}
    request = RunRequest(prompt=plan.name, options={"task": "build", "kernel": kernel, "parameters": {}, "changes": dict(pulled.changes)})
    require_place(request, options.out)
    with terminal.progress("Building") as tell:
        made = Assembly.from_plan(
            AssemblyPlan.loads(pulled.plan.dumps()),
            scripts,
            kernel=kernel_named(kernel, sandbox=sandbox_level(options)),
            cache=BuildCache(),
            progress=tell,
        )
    different = compared(made, options.document)
    with open_or_create(request, options.out) as run, terminal.progress("Finishing") as tell:
        run.save_plan(plan.dumps(), 0)
        run.save_plan(pulled.plan.dumps(), 1)
        record_assembly(run, made)
        with stage(tell, "checks at rest"):
            checks = made.check(motion=False)
        record_checks(run, checks)
        for name in options.formats:
            with stage(tell, f"export {name}"):
                record_export(run, made, name)
        place = run.path
    findings = Findings([*pulled.findings, *different])
    terminal.findings(findings)
    left = sum(finding.code == "W_FREECAD_EDIT" for finding in findings)
    terminal.say(f"{place}: {len(pulled.changes)} values of the plan changed, {left} edits not adopted.")
    terminal.say(f"Not compared: {'; '.join(UNCOMPARED)}.")
    report = checks.to_json()
    summaries.print_findings(report["findings"], terminal)
    return {
        "schema": "articad.pull/1",
        "ok": bool(report["ok"]) and left == 0,
        "run": str(place),
        "changes": dict(pulled.changes),
        "not_compared": list(UNCOMPARED),
        "findings": [finding.to_json() for finding in findings],
        "checks": report,
    }
