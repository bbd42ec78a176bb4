"""Writes docs/reference/freecad-versions.md: what each FreeCAD here finds in the document of every example. `--check` only compares.

With names of examples as arguments, only their rows are made again; the others stay as they are on the page.

Each document is written by the FreeCAD that articad uses, with feature trees where the example has scripts for FreeCAD, and once without
FreeCAD. The document of a recorded run is opened as it was recorded; recordings of answers with the FreeCAD kernel
are made again and written. Every FreeCAD here then opens the document, recomputes, measures each
shape, solves, saves, and opens what it saved: `articad.export.freecad_look`.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import articad as ac
from articad.agents.pipeline import replay
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_look import SAME, SOLVED_MM, differences, judged, looked
from articad.kernels import freecad_install
from articad.kernels.freecad import FreeCADKernel

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "reference" / "freecad-versions.md"
EXAMPLES = sorted(path.parent for path in (ROOT / "examples").glob("*/plan.json"))
RECORDED = sorted((ROOT / "examples").glob("*/recording/export/freecad/*.FCStd"))
ANSWERED = sorted(  # recorded answers of models that built their parts with the FreeCAD kernel
    path.parent
    for path in (ROOT / "tests" / "recordings").glob("**/request.json")
    if json.loads(path.read_text())["options"].get("kernel") == "freecad"
)
NAMES = tuple(
    dict.fromkeys((*(path.name for path in EXAMPLES), *(path.parents[3].name for path in RECORDED), *(path.name for path in ANSWERED)))
)
HEAD = f"""\
# FreeCAD versions

<!-- Written by scripts/freecad_versions.py, which opens every document; do not edit. -->

Every example, written as a FreeCAD document by FreeCAD and without it, and opened in each version. Parts with scripts for FreeCAD are also
written with their feature trees. The document of a recorded run is opened as it was recorded; runs of which only the answers of the models are
recorded are made again. *Shapes* counts the parts whose
shape is present, valid and one solid, with volume, centre and stated mass equal to articad's within {SAME:g}, when the document is opened, recomputed,
saved and opened again. *Solver* is `agrees` if the assembly's solver returns 0 and moves no part by more than {SOLVED_MM:g} mm.
"""


def page(only: Sequence[str] = ()) -> tuple[str, list[str]]:
    """Return the page, and what is wrong.

    Args:
        only: Examples whose rows are made again, every one by default. Rows of the others are copied from the page.
    """
    versions = freecad_install.installed()
    wrong: list[str] = []
    rows = []
    held = [] if not only else PAGE.read_text().splitlines()
    for name in NAMES:
        if only and name not in only:
            rows += [line for line in held if line.startswith(f"| {name} |")]
            continue
        for by, made, content in _documents(name, versions[0]):
            rows.append(_row(name, by, made, content, versions, wrong))
            print(rows[-1], file=sys.stderr, flush=True)
    names = [f"FreeCAD {freecad.version_text}" for freecad in versions]
    head = [f"| example | written by | {' | '.join(f'{name}: shapes | solver' for name in names)} |", "|---|---|" + "---|---|" * len(names)]
    return "\n".join([HEAD, *head, *rows]) + "\n", wrong


def _documents(name: str, freecad: freecad_install.FreeCAD) -> Iterator[tuple[str, ac.Assembly, bytes]]:
    """Yield each document of an example: who wrote it, what it has to hold, and its content."""
    by, folder = f"FreeCAD {freecad.version_text}", ROOT / "examples" / name
    if folder in EXAMPLES:
        plan = ac.AssemblyPlan.load(folder / "plan.json")
        made = ac.build(plan, folder / "parts")
        for writer, bundle in ((by, write_freecad(made, freecad=freecad)), ("articad alone", write_freecad_alone(made))):
            yield writer, made, bundle.files[bundle.main]
        if any((folder / "parts").glob("*.freecad.py")):
            kernel = FreeCADKernel(timeout=300.0, probe_timeout=600.0)  # a busy machine is no failure
            made = ac.build(plan, folder / "parts", kernel=kernel)
            bundle = write_freecad(made, freecad=freecad)
            yield f"{by}, feature trees", made, bundle.files[bundle.main]
    for path in RECORDED:
        if folder in path.parents:
            yield "its recorded run", ac.read(path.parents[2]), path.read_bytes()
    for recording in ANSWERED:
        if recording.name == name:
            with tempfile.TemporaryDirectory() as out:
                made = ac.read(replay(recording, out=Path(out) / "run").run.path)
                bundle = write_freecad(made, freecad=freecad)
            yield f"{by}, recorded answers", made, bundle.files[bundle.main]


def _row(name: str, by: str, made: ac.Assembly, content: bytes, versions: tuple[freecad_install.FreeCAD, ...], wrong: list[str]) -> str:
    cells = [cell for freecad in versions for cell in _cells(made, content, freecad, wrong)]
    return f"| {name} | {by} | {' | '.join(cells)} |"


def _cells(made: ac.Assembly, content: bytes, freecad: freecad_install.FreeCAD, wrong: list[str]) -> tuple[str, str]:
    seen = looked(content, freecad, parts=len(made.parts))
    findings = judged(seen, made, freecad)
    wrong += map(str, findings)
    stages = [seen[when][stage] for when in ("first", "again") for stage in ("opened", "recomputed")]
    right = sum(not any(list(differences(stage.get(name), part)) for stage in stages) for name, part in made.parts.items())
    return f"{right} of {len(made.parts)}", "agrees" if "W_FREECAD_SOLVER" not in findings.codes else "disagrees"


def main() -> int:
    """Write or compare the page."""
    only = [name for name in sys.argv[1:] if name != "--check"]
    if unknown := set(only) - set(NAMES):
        print(f"no such example: {', '.join(sorted(unknown))}", file=sys.stderr)
        return 2
    text, wrong = page(only)
    print("\n".join(wrong), file=sys.stderr)
    if "--check" not in sys.argv:
        PAGE.write_text(text)
    elif PAGE.read_text() != text:
        print(f"{PAGE.name} is out of date: run scripts/freecad_versions.py", file=sys.stderr)
        return 1
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
