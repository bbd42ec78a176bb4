"""View results: open a page with the model, start a new product, watch a folder while it is edited."""

from __future__ import annotations

import argparse
import json
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Final

from articad.commands.command import argument, command
from articad.commands.options import FORCE, JOBS, SANDBOX, parameter
from articad.commands.steps import loaded

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal

_STARTER: Final = Path(__file__).parents[1] / "starter"
_NAME: Final = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_SCRIPTS: Final = {"build123d": ".py", "freecad": ".freecad.py"}
_BROWSER = argument("--no-browser", dest="browser", action="store_false", help="write or serve the page without opening a browser")


@command(
    "show",
    "Open a run, a plan or a URDF, MJCF or FreeCAD file as a page with a slider for each driver.",
    argument("target", metavar="RUN|PLAN_DIR|FILE"),
    argument("--out", metavar="FILE", help="where to write the page (report.html in a run; a temporary folder for anything else)"),
    _BROWSER,
    SANDBOX,
)
def _show(options: argparse.Namespace, terminal: Terminal) -> Report:
    import webbrowser
    from dataclasses import replace

    from articad.export.names import file_name
    from articad.processes import scratch
    from articad.report import Documents, report_page
    from articad.report.sections import provenance
    from articad.runs.record import assembly_of, documents_of, record_page
    from articad.runs.run import Run

    claims = ""
    if (Path(options.target) / "request.json").is_file():
        with Run.view(options.target) as run, terminal.progress("Reading") as tell:
            assembly, documents = assembly_of(run, progress=tell), replace(documents_of(run), repeated=True)
        claims = provenance(documents)
        with terminal.progress("Writing"):
            if options.out is None:
                with Run.open(options.target) as run:
                    page = record_page(run, assembly, repeated=True)
            else:
                page = Path(options.out)
                scratch.write(page, report_page(assembly, documents).encode())
    else:
        assembly = loaded(options.target, options, terminal)
        with terminal.progress("Checking"):
            text = report_page(assembly, Documents(checks=assembly.check().to_json()))
        page = Path(options.out or Path(tempfile.mkdtemp(prefix="articad-")) / f"{file_name(assembly.name)}.html")
        scratch.write(page, text.encode())
    terminal.say(str(page))
    if claims:
        terminal.say(claims.replace("RUN", str(options.target)))
    if options.browser and not webbrowser.open(page.resolve().as_uri()):
        terminal.say("No browser could be started; open the file yourself.")
    return {"schema": "articad.page/1", "ok": True, "file": str(page), "findings": []}


@command(
    "new",
    "Create a product: a folder with a commented plan and part scripts that builds at once.",
    argument("name", metavar="NAME", help="its folder, and the name of the product: small letters, digits and single underscores"),
    argument("--example", metavar="NAME", help="start from a copy of one of the project's examples, such as lamp"),
    argument("--kernel", choices=sorted(_SCRIPTS), default="build123d", help="the kernel that builds the part scripts (build123d)"),
)
def _new(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.errors import WriteError
    from articad.processes import scratch

    folder = Path(options.name)
    if not _NAME.fullmatch(folder.name):
        raise WriteError(
            f"{folder.name!r} cannot name a product: small letters, digits and single underscores, such as table_lamp.", path=str(folder)
        )
    if folder.exists() and any(folder.iterdir()):
        raise WriteError(f"{folder} is not empty.", path=str(folder))
    source = _STARTER if options.example is None else _example(options.example)
    scripts = [file for file in sorted((source / "parts").iterdir()) if _kernel_of(file) == options.kernel]
    if not scripts:
        raise WriteError(f"The example {source.name} has no scripts for {options.kernel}.", path=str(source))
    plan = (source / "plan.json").read_text(encoding="utf-8")
    old = json.loads(plan)["name"]
    plan = re.sub(rf'("name":\s*)"{re.escape(old)}"', rf'\1"{folder.name}"', plan, count=1)
    if options.kernel != "build123d" and '"kernel"' not in plan:
        plan = plan.replace("{", f'{{\n "kernel": "{options.kernel}",', 1)
    scratch.write(folder / "plan.json", plan.encode())
    for script in scripts:
        scratch.write(folder / "parts" / script.name, script.read_bytes())
    if (source / "README.md").is_file():
        text = (source / "README.md").read_text(encoding="utf-8").replace("{name}", folder.name).replace("{folder}", str(folder))
        scratch.write(folder / "README.md", text.replace(f"examples/{source.name}", str(folder)).encode())
    files = sorted(str(file) for file in folder.rglob("*") if file.is_file())
    for file in files:
        terminal.say(file)
    terminal.say(f"Next: articad watch {folder}")
    return {"schema": "articad.new/1", "ok": True, "folder": str(folder), "files": files, "findings": []}


@command(
    "watch",
    "Serve the page of a plan to your browser, and rebuild what changed whenever a file is saved.",
    argument("plan", metavar="PLAN_DIR"),
    argument("--kernel", choices=sorted(_SCRIPTS), default=None, help="the kernel that builds part scripts (the plan's choice)"),
    argument("--set", metavar="NAME=VALUE", dest="parameters", type=parameter, action="append", default=[], help="replace a parameter"),
    argument("--port", metavar="N", type=int, default=0, help="port of the page's address (any free port)"),
    _BROWSER,
    SANDBOX,
    JOBS,
    FORCE,
)
def _watch(options: argparse.Namespace, terminal: Terminal) -> Report:
    import webbrowser

    from articad.commands.watching import PageServer, watch
    from articad.errors import ReadError

    if not Path(options.plan).exists():
        hint = f"Correct the name, or create a product: articad new {options.plan}"
        raise ReadError.at(options.plan, f"There is no folder {options.plan}.", hint)
    with PageServer(options.port) as server:
        terminal.say(f"{server.address}  (Ctrl-C to stop)")
        terminal.out.flush()
        built = watch(options, terminal, server, opened=webbrowser.open if options.browser else None)
    return {"schema": "articad.watch/1", "ok": True, "built": built, "findings": []}


def _kernel_of(script: Path) -> str | None:
    return next((kernel for kernel in ("freecad", "build123d") if script.name.endswith(_SCRIPTS[kernel])), None)


def _example(name: str) -> Path:
    """Return an example's folder, by its name or a word that is only in its name."""
    from articad import examples

    close = [known for known in examples.names() if name in known.split("_")]
    return examples.folder(close[0] if len(close) == 1 else name)
