"""Write a run in other formats; convert files."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import FORMATS, formats

if TYPE_CHECKING:
    from articad.terminal import Report, Terminal


@command(
    "export",
    "Write a finished run in other formats.",
    argument("run", metavar="RUN"),
    argument("--to", metavar="FORMATS", dest="formats", type=formats, required=True, help=f"formats to write, of {', '.join(FORMATS)}"),
    argument("--out", metavar="DIR", help="where to write, a folder for each format; by default RUN/export"),
    argument("--strict", action="store_true", help="refuse what a format cannot hold, instead of reporting it as lost"),
    argument("--loops", choices=["none", "isaac", "drake", "mimic"], default="none", help="how URDF closes loops (none)"),
)
def _export(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad import summaries
    from articad.record import assembly_of, record_export, written
    from articad.run import Run

    with Run.view(options.run) as run, terminal.progress("Reading") as tell:
        assembly = assembly_of(run, progress=tell)
    exports: dict[str, Report] = {}
    if options.out is None:
        with Run.open(options.run) as run:
            exports = {name: record_export(run, assembly, name, strict=options.strict, loops=options.loops) for name in options.formats}
    else:
        for name in options.formats:
            bundle = written(assembly, name, strict=options.strict, loops=options.loops)
            main = bundle.write(Path(options.out) / name)[0]
            exports[name] = bundle.to_json() | {"folder": str(main.parent), "main": str(main)}
    summaries.print_exports(exports, terminal)
    return {"schema": "articad.exports/1", "ok": all(export["ok"] for export in exports.values()), "exports": exports, "findings": []}


@command(
    "convert",
    "Convert a URDF or MJCF file into another format.",
    argument("source", metavar="IN", help="a .urdf or .xml file"),
    argument("target", metavar="OUT", help="its ending says the format: .urdf .xml .sdf .usda .step .glb .3mf"),
    argument("--strict", action="store_true", help="refuse what the format cannot hold, instead of reporting it as lost"),
)
def _convert(options: argparse.Namespace, terminal: Terminal) -> Report:
    from dataclasses import replace

    from articad import summaries
    from articad.convert import FORMAT_OF, convert

    target = Path(options.target)
    assembly, bundle = convert(options.source, target, strict=options.strict)
    bundle = replace(bundle, files={target.name if path == bundle.main else path: content for path, content in bundle.files.items()})
    bundle.write(target.parent)
    report = bundle.to_json() | {"folder": str(target.parent), "main": str(target)}
    terminal.findings(assembly.findings + bundle.findings)
    summaries.print_exports({FORMAT_OF[target.suffix.lower()]: report}, terminal)
    return report | {"findings": [finding.to_json() for finding in assembly.findings + bundle.findings]}
