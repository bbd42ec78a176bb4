"""Writes the pages of docs/reference that are tables of the code: findings, losses and the command line, and those of stored orders of assembly and findings on joints.

`--check` only compares.
"""

from __future__ import annotations

import argparse
import ast
import re
import sys
import textwrap
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import get_args

from bench_checks import page as checks
from orders import stored_page as orders
from realised import stored_page as realised

import articad.commands
import articad.kernels
from articad import formats
from articad.commands.command import COMMANDS
from articad.export.losses import TABLE, Format
from articad.findings.codes import CODES
from articad.geometry.mesh_files import MESH_ENDINGS
from articad.importers.mjcf_kept import READ as READ_MJCF
from articad.importers.sdf_kept import READ_SDF
from articad.importers.urdf_kept import READ as READ_URDF

REFERENCE = Path(__file__).resolve().parent.parent / "docs" / "reference"
NOTE = "<!-- Written by scripts/tables.py from the code; edit that. -->\n"
SEVERITIES = {"E": "error", "W": "warning", "I": "info"}


def findings() -> str:
    """Return the page of all findings."""
    lines = [
        "# Findings",
        "",
        NOTE,
        "A check returns all its findings at once, as values: `code`, `severity`, `stage`, `where`, `message`, `hint`, the measured `value` and its",
        "`limit`, the `parts` concerned, and who must act: the plan's author (*design*) or the part script's (*code*). The first letter of a",
        "code is its severity: `E_` error, `W_` warning, `I_` info. A report is `ok` if it has no error and everything that was requested was done.",
        "",
        "As JSON (`articad.findings/1`):",
        "",
        "```json",
        '{"code": "E_MATE_ROLL", "severity": "error", "stage": "plan", "where": "joints.hinge_right",',
        ' "parts": ["cabinet", "door_right"], "value": 180.0, "limit": 0.05, "unit": "deg",',
        ' "message": "x axes of cabinet.hinge_right and door_right.hinge differ by 180.0° about z.",',
        ' "hint": "Set x of cabinet.hinge_right to (-1, 0, 0).", "cause": null, "route": "design", "pose": null}',
        "```",
    ]
    order = list(dict.fromkeys(code.stage for code in CODES.values()))
    entries = sorted(CODES.items(), key=lambda entry: order.index(entry[1].stage))
    for stage, group in groupby(entries, key=lambda entry: entry[1].stage):
        lines += ["", f"## {stage.capitalize()}", "", "| code | severity | who acts | meaning | remedy |", "|---|---|---|---|---|"]
        for name, code in group:
            lines.append(f"| `{name}` | {SEVERITIES[name[0]]} | {code.route or ''} | {code.meaning} | {code.remedy} |")
    return "\n".join(lines) + "\n"


KEPT_URDF = (
    "Everything else is kept verbatim. `convert` writes it back into a URDF at the same place; in any other format it is a row of the losses, "
    "and so are textures, transparency and attributes of shapes, which cannot be written back into a URDF."
)
KEPT_SDF = (
    "Paths begin below `<model>`. Everything else is kept. A written SDF contains the elements of links, joints, shapes and models again, unless they name "
    "frames or are inside elements that articad writes itself (masses, geometries); any other format reports them as losses. Versions 1.4 to 1.12 are read."
)
KEPT_MJCF = (
    "MuJoCo's compiler resolves defaults, classes, frames, includes and copies first. Everything else is a row of the losses of every format, "
    "including MJCF, except for the rotor and the spring of a joint: its names refer to geoms, sites and tendons that an assembly does not have."
)


def losses() -> str:
    """Return the page of what each format holds and loses."""
    lines = [
        "# Formats and their losses",
        "",
        NOTE,
        "This page lists what each feature of an assembly becomes in each format, and what a reader that ignores articad's metadata loses. An export reports the rows",
        "that concern it; with `strict` it refuses the marked rows, because motion, mass or shape would change. A feature without an entry in *lost* is represented exactly.",
    ]
    for format_name in get_args(Format):
        if not any(format_name in rows for rows in TABLE.values()):
            continue
        lines += ["", f"## {format_name.upper()}", "", "| feature | becomes | lost | strict |", "|---|---|---|---|"]
        for key, rows in TABLE.items():
            if format_name in rows:
                row = rows[format_name]
                lines.append(f"| `{key}` | {row.becomes} | {row.lost} | {'refused' if row.refused else ''} |")
    for name, kept, read in (("URDF", KEPT_URDF, READ_URDF), ("MJCF", KEPT_MJCF, READ_MJCF), ("SDF", KEPT_SDF, READ_SDF)):
        lines += ["", f"## What is read from {name}", "", kept, "", "| element | attributes |", "|---|---|"]
        lines += [
            f"| `{key or 'model'}` | {'all' if '*' in names else ', '.join(sorted(names)) or 'none'} |" for key, names in read.items()
        ]
    lines[5:] = [re.sub(r"<\w+>", r"`\g<0>`", line) for line in lines[5:]]  # a tag in a cell is text, not HTML
    return "\n".join(lines) + "\n"


ABOUT_FORMATS = """\
`convert`, `read` and `write` recognise these formats by the ending of the file. What each format keeps of an assembly, feature by feature, is in
[Formats and their losses](losses.md). An export reports what is lost; articad's own files are read back unchanged, because URDF, MJCF and SDF carry
the rest in metadata that other programs ignore."""


def all_formats() -> str:
    """Return the page of all formats."""
    lines = [
        "# Formats",
        "",
        NOTE,
        ABOUT_FORMATS,
        "",
        "| format | endings | read | written | holds | restores from a file of the same format | options |",
    ]
    lines += ["|---|---|---|---|---|---|---|"]
    for row in formats.FORMATS:
        endings = " ".join(f"`{suffix}`" for suffix in (*row.suffixes, *([".xacro"] if row.name == "urdf" else [])))
        options = ", ".join(f"`{name}`" for name in formats.options_of(row.writer) if name not in {"cache", "freecad"})
        read = "yes" if row.reader else "no"
        lines.append(f"| {row.name.upper()} | {endings} | {read} | yes | {row.holds} | {row.keeps} | {options} |")
    lines += [
        "",
        "## Meshes that files may name",
        "",
        f"{', '.join(f'`{ending}`' for ending in MESH_ENDINGS)}.",
        "",
        *ABOUT_MESHES.splitlines(),
    ]
    lines += ["", "## What is not read", "", "| endings | what to do |", "|---|---|"]
    lines += [f"| {' '.join(f'`{ending}`' for ending in endings)} | {text} |" for endings, text in formats.ADVICE.items()]
    return "\n".join(lines) + "\n"


ABOUT_MESHES = """\
A mesh of a URDF or SDF has the coordinates that its file states, in metres, times the `scale` of the element that names it; x, y and z of the file are those of
the link. STL, OBJ and PLY state no unit. The unit of a DAE (`<unit meter=…>`) is applied; Pinocchio ignores it. The up axis of a
DAE, and y up in glTF, are ignored, because readers of URDF (Pinocchio, and yourdfpy through trimesh) use the coordinates as they are, and a robot must look
the same in all of them. The nodes of a DAE or glTF are placed. Meshes of MJCF are those that MuJoCo compiles."""


ABOUT_FREECAD = """\
A script of the FreeCAD kernel, `parts/<part>.freecad.py`, defines `build(part)` and returns `(part.body, connectors)`; see
[Work with FreeCAD](../how-to/freecad.md). These are the members of `part`. A `Value` is a number, or a text over the names of dimensions such as
`"width / 2 - inset"`, which stays an expression in the document; lengths are in mm, angles in degrees. Each feature becomes the tip of the body.

`part.name`, `part.description`, `part.material`, `part.dimensions` (name -> number) and `part.connectors` (name -> object with `o`, `z`, `x`, `label`, `joints`) are
those of the plan; `part.document` and `part.body` are FreeCAD's own, with everything that FreeCAD offers.

The examples are bodies of `build(part)` for the dimensions width 60, depth 40, height 20, radius 5 and turn_deg 90. Each is a whole part.

```text
def build(part):
    part.box(("-width / 2", 0, 0), ("width", "depth", "height"), name="Outside")
    part.cylinder((0, 0, 0), "+Z", "bore_radius", "height", cut=True, name="Bore")
    part.chamfer("+Z", 1, name="Edge")
    return part.body, {"hinge": part.connector("hinge", (0, "depth", "height"), (-1, 0, 0), (0, -1, 0))}
```"""
AUTHORING = Path(articad.kernels.__file__).parent / "inside_freecad" / "part.py"


def freecad_kernel() -> str:
    """Return the page of what a script of the FreeCAD kernel calls, with signatures and docstrings from the code."""
    (offered,) = [node for node in ast.parse(AUTHORING.read_text()).body if isinstance(node, ast.ClassDef) and node.name == "Authoring"]
    lines = ["# The FreeCAD kernel's functions", "", NOTE, ABOUT_FREECAD]
    for node in offered.body:
        if not isinstance(node, ast.FunctionDef) or node.name.startswith("_") or node.decorator_list:
            continue
        given = re.sub(r"\bself(, )?", "", ast.unparse(node.args), count=1)
        returned = "" if node.returns is None or ast.unparse(node.returns) == "None" else f" -> {ast.unparse(node.returns)}"
        lines += ["", f"## part.{node.name}", "", "```text", f"part.{node.name}({given}){returned}", "```", ""]
        told, _, example = (ast.get_docstring(node) or "").partition("\n\nExample:\n")
        lines += [re.sub(r"^    (\w+): ", r"- `\1`: ", line) for line in told.splitlines() if line != "Args:"]
        lines += ["", "```text", textwrap.dedent(example), "```"]
    return "\n".join(lines) + "\n"


ABOUT_COMMANDS = """\
```console
articad [--json] [-q] [-v] [--no-color] COMMAND …
```

| flag of every command | |
|---|---|
| `--json` | one report on stdout, nothing else |
| `-q`, `--quiet` | findings and errors only |
| `-v`, `--verbose` | details, and tracebacks of defects |
| `--no-color` | no colour, no progress bars; `NO_COLOR` does the same |

| exit code | meaning |
|---|---|
| 0 | ok |
| 1 | done, with findings: the report is not `ok` |
| 2 | the command line is wrong |
| 3 | cannot continue: the error states why and what is valid |
| 130 | interrupted; finished work is kept |

| environment variable | meaning |
|---|---|
| `ARTICAD_CACHE` | where built parts are kept (`~/.cache/articad`) |
| `ARTICAD_MODEL` | the model of `generate` if `--model` is not given |
| `ARTICAD_MEMORY` | where the experience of earlier runs is kept |
| `ARTICAD_SANDBOX` | `weak` runs part scripts with less isolation than landlock or bubblewrap give |
| `ARTICAD_FREECAD` | FreeCAD's program, for the FreeCAD kernel |
| the provider's own, such as `GEMINI_API_KEY` | the key; articad reads it from nowhere else and writes it nowhere |"""


def commands() -> str:
    """Return the page of all commands with their arguments."""
    assert articad.commands  # importing it registers them
    index = [f"| [`{name}`](#articad-{name}) | {_cell(COMMANDS[name].summary)} |" for name in sorted(COMMANDS)]
    lines = ["# Command line", "", NOTE, "| command | what it does |", "|---|---|", *index, "", ABOUT_COMMANDS]
    for name in sorted(COMMANDS):
        parser = argparse.ArgumentParser(add_help=False)
        COMMANDS[name].arguments(parser)
        lines += _command(name, COMMANDS[name].summary, parser)
    return "\n".join(lines) + "\n"


def _command(name: str, summary: str, parser: argparse.ArgumentParser) -> list[str]:
    """Return the section of a command, and those of the commands under it."""
    arguments, below = [], []
    for action in parser._actions:  # noqa: SLF001 - argparse keeps its list of arguments nowhere else
        if isinstance(action, argparse._SubParsersAction):  # noqa: SLF001
            told = {choice.dest: choice.help or "" for choice in action._choices_actions}  # noqa: SLF001
            below += [(f"{name} {word}", told.get(word, ""), sub) for word, sub in action.choices.items()]
        elif "--help" not in action.option_strings:
            arguments.append(action)
    lines = ["", f"{'#' * (2 + name.count(' '))} articad {name}", "", summary]
    if arguments:
        lines += ["", "| argument | |", "|---|---|", *(f"| {_form(action)} | {_cell(action.help or '')} |" for action in arguments)]
    for entry in below:
        lines += _command(*entry)
    return lines


def _form(action: argparse.Action) -> str:
    """Return an argument as it is written: `--jobs N`, `PLAN_DIR`."""
    words = action.metavar if isinstance(action.metavar, str) else "\\|".join(map(str, action.choices or ())) or action.dest.upper()
    words = words.replace("|", "\\|").replace("\\\\|", "\\|")
    if not action.option_strings:
        return f"`{words}`"
    return ", ".join(f"`{flag}`" for flag in action.option_strings) if action.nargs == 0 else f"`{action.option_strings[-1]} {words}`"


def _cell(text: str) -> str:
    return re.sub(r"<\w+>", r"`\g<0>`", text % {} if "%%" in text else text).replace("|", "\\|")


PAGES = {
    "findings.md": findings,
    "losses.md": losses,
    "formats.md": all_formats,
    "cli.md": commands,
    "checks.md": partial(checks, NOTE),
    "freecad-kernel.md": freecad_kernel,
    "orders.md": orders,
    "realised.md": realised,
}


def main(arguments: list[str]) -> int:
    """Write the pages, or say which are not up to date."""
    stale = [name for name, page in PAGES.items() if not (REFERENCE / name).is_file() or (REFERENCE / name).read_text() != page()]
    if "--check" in arguments:
        if stale:
            print(f"not up to date: {', '.join(stale)}; run .venv/bin/python scripts/tables.py", file=sys.stderr)
        return 1 if stale else 0
    for name in stale:
        (REFERENCE / name).write_text(PAGES[name]())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
