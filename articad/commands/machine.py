"""List what this machine has and lacks, and install what pip cannot."""

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
        if item.remedy and item.status != "ok":
            terminal.say(f"{item.name}: {item.remedy}")
    report = doctor.report(items)
    if missing:
        error = doctor.unavailable(missing)
        terminal.text(error.message)
        terminal.findings(error.findings)
        report |= {"error": terminal.described(error), "findings": [finding.to_json() for finding in error.findings]}
    return report


@command(
    "install",
    "Install a program that pip cannot install: FreeCAD, on Debian and Ubuntu, as root.",
    argument("program", choices=["freecad"], help="the program"),
    argument("--next", action="store_true", help="also install the newer FreeCAD of Debian's unstable suite (3 GB)"),
    argument("--remove", action="store_true", help="remove what this command installed"),
    needs_libraries=False,
)
def _install(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.kernels import freecad_install
    from articad.processes import launcher

    bash = launcher.which("bash")
    if bash is None:
        raise freecad_install.unavailable("the installer needs bash")
    flags = [flag for flag, wanted in (("--next", options.next), ("--remove", options.remove)) if wanted]
    variables = launcher.environment("HOME", "XDG_DATA_HOME", "ARTICAD_", "http_proxy", "https_proxy", "no_proxy")
    lines: list[str] = []
    with launcher.start([bash, str(freecad_install.INSTALLER), *flags], environment=variables, stderr=launcher.TO_STDOUT) as child:
        for row in child.stdout:
            lines.append(row.decode(errors="replace").rstrip())
            terminal.say(lines[-1])
        code = child.finish().code
    if code != 0:
        raise freecad_install.unavailable(
            f"the installer ended with code {code}: {lines[-1].rstrip('.') if lines else 'it gave no reason'}"
        )
    report: Report = {"schema": "articad.install/1", "ok": True, "program": "freecad", "findings": []}
    if options.remove:
        return report
    found = freecad_install.installed()
    if not found:
        raise freecad_install.unavailable("FreeCAD was installed, but it does not start")
    for freecad in found:
        terminal.say(f"FreeCAD {freecad.version_text} at {freecad.where}")
    return report | {"versions": [freecad.version_text for freecad in found]}
