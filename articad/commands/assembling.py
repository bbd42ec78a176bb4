"""Tell in which order a product is put together."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Final, get_args

from articad.aliases import Fastening
from articad.commands.command import argument, closest, command
from articad.commands.options import SANDBOX, names
from articad.commands.steps import loaded
from articad.processes import scratch

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal

FASTENINGS: Final[tuple[Fastening, ...]] = get_args(Fastening)


def fastenings(text: str) -> dict[str, Fastening]:
    """Read `hinge=snap,pin=press`."""
    found: dict[str, Fastening] = {}
    for entry in names(text):
        joint, sign, how = entry.partition("=")
        known = next((each for each in FASTENINGS if each == how), None)
        if not sign or known is None:
            message = f"{entry!r} is not JOINT=FASTENING{closest(how, FASTENINGS)}; there are {', '.join(FASTENINGS)}"
            raise argparse.ArgumentTypeError(message)
        found[joint] = known
    return found


FASTEN = argument(
    "--fasten",
    metavar="JOINT=HOW,...",
    type=fastenings,
    default={},
    help=f"how joints are fastened, beside the plan: {', '.join(FASTENINGS)}",
)


@command(
    "order",
    "Find an order of assembly with a path for each part that is proven free of collisions, or name the parts that block each other.",
    argument("target", metavar="PLAN_DIR|RUN|FILE"),
    FASTEN,
    argument("--out", metavar="FILE.json", help="write the order, articad.order/1, into a file"),
    SANDBOX,
)
def _order(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import summaries

    assembly = loaded(options.target, options, terminal)
    with terminal.progress("Taking apart"):
        report = assembly.assembly_order(options.fasten).to_json()
    summaries.print_order(report, terminal)
    summaries.print_findings(report["findings"], terminal)
    if options.out:
        scratch.write(Path(options.out), (json.dumps(report, indent=1) + "\n").encode())
        terminal.say(f"Order: {options.out}")
    return report
