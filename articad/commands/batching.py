"""Make assemblies by the thousand."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from articad.commands.command import argument, command, output_folder
from articad.commands.options import ENGINE, amount, positive

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


@command(
    "batch",
    "Make many assemblies from plans with parameter values; check, export and store them with their provenance.",
    argument("spec", metavar="BATCH.json", help="items, or samples of plans' parameters"),
    output_folder("--out", "batch", "a folder for each item; existing items are not made again"),
    *ENGINE,
    argument("--jobs", metavar="N", type=positive, default=None, help="workers of this machine (one per processor)"),
    argument("--memory", metavar="GB", type=amount, default=4.0, help="data of each worker process (4)"),
)
def _batch(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.batches.batch import read_batch, run_dask, run_local, summary

    items = read_batch(options.spec)
    with terminal.progress("Items", total=len(items)) as tell:

        def told(record: Report) -> None:
            tell(record["digest"][:12], "built" if record["ok"] else "failed")

        if options.engine == "dask":
            records = run_dask(items, options.out, scheduler=options.scheduler, memory_gb=options.memory, told=told)
        else:
            records = run_local(items, options.out, workers=options.jobs, memory_gb=options.memory, told=told)
    report = summary(records)
    terminal.say(f"{report['passed']} of {report['items']} passed; {report['made_before']} existed already.")
    for code, count in report["refused_by"].items():
        terminal.say(f"  {code}: {count}")
    spent = ", ".join(f"{stage} {seconds:.1f} s" for stage, seconds in report["seconds"].items())
    terminal.say(f"Parts: {report['parts_built']} built, {report['parts_kept']} kept. Time: {spent or 'none'}.")
    terminal.say(f"Items: {options.out}")
    return report
