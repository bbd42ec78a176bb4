"""Tell in which order a product is put together."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import SANDBOX
from articad.commands.steps import loaded

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


@command(
    "order",
    "Find an order of assembly with a path for each part that is proven free of collisions, or name the parts that block each other.",
    argument("target", metavar="PLAN_DIR|RUN|FILE"),
    argument("--out", metavar="FILE.json", help="write the order, articad.order/1, into a file"),
    SANDBOX,
)
def _order(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import summaries

    assembly = loaded(options.target, options, terminal)
    with terminal.progress("Taking apart"):
        report = assembly.assembly_order().to_json()
    summaries.print_order(report, terminal)
    summaries.print_findings(report["findings"], terminal)
    if options.out:
        Path(options.out).parent.mkdir(parents=True, exist_ok=True)
        Path(options.out).write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
        terminal.say(f"Order: {options.out}")
    return report
