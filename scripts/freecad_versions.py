"""Writes docs/reference/freecad-versions.md: what each FreeCAD here finds in the document of every example. `--check` only compares.

Each document is written by the FreeCAD that articad uses, and once without FreeCAD. Every FreeCAD here then opens it, recomputes,
measures each shape, solves, saves, and opens what it saved: `articad.export.freecad_look`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import articad as ac
from articad.export.bundle import Bundle
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_look import SAME, SOLVED_MM, differences, looked, verify
from articad.kernels import freecad_install

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "reference" / "freecad-versions.md"
EXAMPLES = sorted(path.parent for path in (ROOT / "examples").glob("*/plan.json"))
HEAD = f"""\
# FreeCAD versions

<!-- Written by scripts/freecad_versions.py, which opens every document; do not edit. -->

Every example, written as a FreeCAD document by FreeCAD and without it, and opened in each version. *Shapes* counts the parts whose
shape is present, valid and one solid, with volume and centre equal to articad's within {SAME:g}, when the document is opened, recomputed,
saved and opened again. *Solver* is `agrees` if the assembly's solver returns 0 and moves no part by more than {SOLVED_MM:g} mm.
"""


def page() -> tuple[str, list[str]]:
    """Return the page, and what is wrong."""
    versions = freecad_install.installed()
    wrong: list[str] = []
    rows = [row for folder in EXAMPLES for row in _rows(folder, versions, wrong)]
    names = [f"FreeCAD {freecad.version_text}" for freecad in versions]
    head = [f"| example | written by | {' | '.join(f'{name}: shapes | solver' for name in names)} |", "|---|---|" + "---|---|" * len(names)]
    return "\n".join([HEAD, *head, *rows]) + "\n", wrong


def _rows(folder: Path, versions: tuple[freecad_install.FreeCAD, ...], wrong: list[str]) -> Iterator[str]:
    made = ac.build(ac.AssemblyPlan.load(folder / "plan.json"), folder / "parts")
    kinds = (
        (f"FreeCAD {versions[0].version_text}", write_freecad(made, freecad=versions[0])),
        ("articad alone", write_freecad_alone(made)),
    )
    for by, bundle in kinds:
        cells = [cell for freecad in versions for cell in _cells(made, bundle, freecad, wrong)]
        yield f"| {folder.name} | {by} | {' | '.join(cells)} |"


def _cells(made: ac.Assembly, bundle: Bundle, freecad: freecad_install.FreeCAD, wrong: list[str]) -> tuple[str, str]:
    content = bundle.files[bundle.main]
    findings = verify(content, made, freecad)
    wrong += map(str, findings)
    seen = looked(content, freecad, parts=len(made.parts))
    stages = [seen[when][stage] for when in ("first", "again") for stage in ("opened", "recomputed")]
    right = sum(not any(list(differences(stage.get(name), part)) for stage in stages) for name, part in made.parts.items())
    return f"{right} of {len(made.parts)}", "agrees" if "W_FREECAD_SOLVER" not in findings.codes else "disagrees"


def main() -> int:
    """Write or compare the page."""
    text, wrong = page()
    print("\n".join(wrong), file=sys.stderr)
    if "--check" not in sys.argv:
        PAGE.write_text(text)
    elif PAGE.read_text() != text:
        print(f"{PAGE.name} is out of date: run scripts/freecad_versions.py", file=sys.stderr)
        return 1
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
