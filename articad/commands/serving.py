"""Serve coding agents: the tools over standard input and output, and the skill with instructions for them."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command, output_folder

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal

_SKILLS = Path(".claude") / "skills" / "articad"


@command(
    "mcp",
    "Offer articad's tools to a coding agent over standard input and output.",
    argument("--root", metavar="DIR", default=".", help="the folder of designs; nothing outside it is read or written (.)"),
)
def _mcp(options: argparse.Namespace, _terminal: Terminal) -> Report:
    from articad.errors import ReadError

    try:
        from articad.mcp.server import make_server
    except ImportError as error:
        raise ReadError(f"The server needs the package mcp ({error.name} is missing): pip install 'articad[mcp]'.", path="mcp") from error
    try:
        make_server(options.root).run("stdio")
    except* BrokenPipeError:  # the client went away while a tool worked: nobody is left to answer
        pass
    return {"schema": "articad.served/1", "ok": True, "findings": []}


@command(
    "skill",
    "Print or install the instructions that teach a coding agent to use articad.",
    argument(
        "topic",
        metavar="TOPIC",
        nargs="?",
        default="print",
        help="print (the page), install, or a topic: a page behind it, or a type of the plan",
    ),
    output_folder("--dir", str(_SKILLS), "for install: folder of the skill"),
)
def _skill(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.mcp.skill import page, skill
    from articad.runs.run import write_atomically

    if options.topic != "install":
        text = skill() if options.topic == "print" else page(options.topic)
        terminal.text(text)
        return {"schema": "articad.skill/1", "ok": True, "text": text, "findings": []}
    file = Path(options.dir) / "SKILL.md"
    write_atomically(file, skill().encode())
    terminal.say(f"Written: {file}")
    return {"schema": "articad.skill/1", "ok": True, "file": str(file), "findings": []}
