"""What FreeCAD costs: a process, a part, a document of 20 parts. Run: python benchmarks/freecad.py"""

from __future__ import annotations

import itertools
import statistics
import tempfile
import time
from pathlib import Path

import articad as ac
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.freecad import write_freecad
from articad.geometry.shapes import box
from articad.importers.freecad import read_freecad
from articad.kernels import freecad_install
from articad.kernels.freecad import FreeCADKernel

SCRIPT = b"""
def build(part):
    part.box((0, 0, 0), ("width", "width", "height"))
    part.cylinder(("width / 2", "width / 2", 0), "+Z", "width / 4", "height", cut=True)
    return part.body, {}
"""
PART = {
    "name": "block",
    "description": "",
    "material": "steel",
    "dimensions": {"width": 20.0, "height": 5.0},
    "envelope_mm": None,
    "connectors": {},
}
LINKS = 20


def seconds(times: int, work: object) -> float:
    spent = []
    for _ in range(times):
        start = time.perf_counter()
        work()  # type: ignore[operator]
        spent.append(time.perf_counter() - start)
    return statistics.median(spent)


def chain() -> ac.Assembly:
    """A planar chain of 20 links with parallel axes."""
    ends = {"near": Connector("near", SE3.identity()), "far": Connector("far", SE3.trans(30.0, 0.0, 0.0))}
    parts = [ac.Part.from_mesh(f"link_{number}", box(30.0, 5.0, 3.0), density=2700.0, connectors=ends) for number in range(LINKS)]
    pairs = itertools.pairwise(parts)
    joints = [ac.revolute(f"pin_{number}", a["far"], b["near"], limits=(-1.0, 1.0)) for number, (a, b) in enumerate(pairs)]
    return ac.Assembly.from_parts("chain", parts=parts, joints=joints, ground="link_0")


def main() -> None:
    freecad = freecad_install.find()
    print(f"FreeCAD {freecad.version_text}")
    with tempfile.TemporaryDirectory() as scratch:
        nothing = Path(scratch) / "nothing.py"
        nothing.write_text("import Part, PartDesign, Sketcher\n")
        print(f"a confined process that does nothing   {seconds(8, lambda: freecad.run(nothing)):6.2f} s  (goal 0.6 s)")
        kernel = FreeCADKernel()
        print(f"a part, built, opened again, measured  {seconds(5, lambda: kernel.build(SCRIPT, PART, probe=False)):6.2f} s")
        assembly = chain()
        start = time.perf_counter()
        bundle = write_freecad(assembly)
        (path,) = bundle.write(scratch)
        read_freecad(path)
        print(
            f"{LINKS} parts, written, solved, read back    {time.perf_counter() - start:6.2f} s  (goal 15 s)  {len(bundle.findings)} findings"
        )


if __name__ == "__main__":
    main()
