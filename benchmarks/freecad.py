"""What FreeCAD costs: a process, a part, a document of 20 parts. Run: python benchmarks/freecad.py"""

from __future__ import annotations

import json
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import articad as ac
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.importers.freecad import read_freecad
from articad.kernels import freecad_install
from articad.kernels.freecad import FreeCADKernel

LINKS = 20
SCRIPT = """
def build(part):
    part.box((0, "-width / 2", 0), ("length", "width", "thickness"), name="Bar")
    part.cylinder((0, 0, "-gap"), "+Z", "bore", "thickness + 2 * gap", cut=True, name="Bore")
    return part.body, {
        "near": part.connector("near", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "far": part.connector("far", ("length - width / 2", 0, "thickness + gap"), (0, 0, 1), (1, 0, 0)),
    }
"""
EXAMINE = Path(freecad_install.__file__).parent / "inside_freecad" / "examine.py"


def seconds(times: int, work: Callable[[], object]) -> float:
    spent = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        spent.append(time.perf_counter() - start)
    return statistics.median(spent)


def chain() -> ac.AssemblyPlan:
    """Return the plan of 20 links with parallel axes, each with a script and dimensions of its own that follow two parameters."""
    parts: list[dict[str, Any]] = []
    for number in range(LINKS):
        dimensions = {"length": f"length + {number}", "width": "width", "thickness": 3, "bore": 1.5, "gap": 0.2}
        near = {"name": "near", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "bore"}
        far = near | {"name": "far", "o": [f"length + {number} - width / 2", 0, 3.2], "label": "where the next link turns"}
        parts.append(
            {"name": f"link_{number}", "material": "steel", "description": "a bar", "dimensions": dimensions, "connectors": [near, far]}
        )
    joints = [
        {
            "name": f"pin_{number}",
            "type": "revolute",
            "parent": f"link_{number - 1}.far",
            "child": f"link_{number}.near",
            "angle_deg": [-60, 60],
        }
        for number in range(1, LINKS)
    ]
    plan = {
        "schema": "articad.plan/1",
        "name": "chain",
        "ground": "link_0",
        "freedoms": LINKS - 1,
        "kernel": "freecad",
        "parameters": [{"name": "length", "value": 30, "unit": "mm"}, {"name": "width", "value": 6, "unit": "mm"}],
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": parts,
        "joints": joints,
    }
    return ac.AssemblyPlan.from_json(plan)


def verified(freecad: freecad_install.FreeCAD, document: Path) -> dict[str, Any]:
    """Open a document in a new process, look at it and solve it."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "it.FCStd").write_bytes(document.read_bytes())
        (folder / "job.json").write_text(json.dumps({"file": "it.FCStd", "steps": [{"do": "look"}, {"do": "solve"}]}))
        freecad.run(EXAMINE, folder=folder)
        look, solved = json.loads((folder / "report.json").read_text())["steps"]
    return {"invalid": look["invalid"], "code": solved["code"]}


def main() -> None:
    freecad = freecad_install.find()
    print(f"FreeCAD {freecad.version_text}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        nothing = folder / "nothing.py"
        nothing.write_text("import Part, PartDesign, Sketcher\n")
        print(f"a confined process that does nothing          {seconds(8, lambda: freecad.run(nothing)):6.2f} s  (goal 0.6 s)")
        plan = chain()
        start = time.perf_counter()
        made = ac.build(plan, {f"link_{number}": SCRIPT for number in range(LINKS)}, kernel=FreeCADKernel())
        print(f"{LINKS} parts, built, opened again, probed, measured {time.perf_counter() - start:6.2f} s  (or found in the cache)")
        start = time.perf_counter()
        bundle = write_freecad(made)
        (path,) = bundle.write(folder / "with")
        written = time.perf_counter() - start
        found = verified(freecad, path)
        spent = time.perf_counter() - start
        print(f"{LINKS} feature trees, written and solved             {written:6.2f} s  {len(bundle.findings)} findings")
        print(f"... and opened and solved in a new process    {spent:6.2f} s  (goal 15 s)  {found}")
        start = time.perf_counter()
        (path,) = write_freecad_alone(made).write(folder / "without")
        print(f"{LINKS} parts, written without FreeCAD               {time.perf_counter() - start:6.2f} s  {verified(freecad, path)}")
        start = time.perf_counter()
        read_freecad(path)
        print(f"{LINKS} parts, read                                  {time.perf_counter() - start:6.2f} s")


if __name__ == "__main__":
    main()
