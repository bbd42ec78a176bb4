"""List what this machine has and lacks."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from articad import __version__
from articad.commands.command import argument, command

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


@command(
    "doctor",
    "List what this machine has and lacks.",
    argument("--model", metavar="NAME", help="ask this model one tiny question: tests key, schemas, vision and price"),
    argument("--api-base", metavar="URL", help="an OpenAI-compatible endpoint"),
    needs_libraries=False,
)
def _doctor(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import doctor

    missing = doctor.missing_libraries()
    items = doctor.examine()
    if options.model and not missing:
        items = (*items, *doctor.examine_model(options.model, api_base=options.api_base))
    terminal.say(f"articad {__version__}")
    terminal.table(["", "what", "found"], [(item.status, item.name, item.detail) for item in items])
    for item in items:
        if item.remedy and item.status == "missing":
            terminal.say(f"{item.name}: {item.remedy}")
    report = doctor.report(items)
    if missing:
        error = doctor.unavailable(missing)
        terminal.say(error.message)
        terminal.findings(error.findings)
        report |= {"error": terminal.described(error), "findings": [finding.to_json() for finding in error.findings]}
    return report
