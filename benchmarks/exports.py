"""What exports cost: an assembly of 50 parts in every format, and read back; the examples for simulators. Run: python -m benchmarks.exports"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from articad import entry, examples
from articad.assembly import Assembly
from articad.connectors.attachment import Attachment
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.freecad import write_freecad_alone
from articad.export.gltf import write_glb
from articad.export.mjcf import write_mjcf
from articad.export.plan import write_plan
from articad.export.sdf import write_sdf
from articad.export.threemf import write_3mf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.formats import read
from articad.geometry.part import Part
from articad.geometry.shapes import box, tube
from articad.kinematics import declare
from articad.kinematics.joints import Joint

PARTS, SEGMENTS, ROUNDS = 50, 256, 3
GOAL_SECONDS = 3.0
EXAMPLES_SECONDS, CACHED_SECONDS = 60.0, 5.0  # of all examples in the formats of SIMULATORS
RECORDED = Path(__file__).resolve().parents[1] / "examples" / "sewing_things_box" / "recording"
SIMULATORS = ("urdf", "mjcf", "sdf", "usd")
WRITERS: dict[str, Callable[[Assembly], Bundle]] = {
    "urdf": write_urdf,
    "mjcf": write_mjcf,
    "mjcf, hulls, servos": lambda assembly: write_mjcf(assembly, collision="hull", actuators="position"),
    "sdf": write_sdf,
    "usd": write_usd,
    "glb": write_glb,
    "3mf": write_3mf,
    "plan": write_plan,
    "freecad (written alone)": write_freecad_alone,
}


def machine_of(count: int) -> Assembly:
    """A bed with columns of four tubes each, every tube of its own size, with joints of four kinds in turn; no column reaches another."""
    bed = {f"seat_{index}": Connector(f"seat_{index}", SE3.trans(200.0 * (index % 4), 200.0 * (index // 4), 20)) for index in range(13)}
    parts = [Part.from_mesh("bed", box(900, 900, 20), density=2700.0, connectors=bed)]
    joints: list[Joint] = []
    for index in range(count - 1):
        size = 20.0 - 0.2 * index
        frames = {"root": SE3.trans(0, 0, -22), "tip": SE3.trans(0, 0, 22)}
        connectors = {name: Connector(name, frame) for name, frame in frames.items()}
        parts.append(Part.from_mesh(f"part_{index}", tube(size / 2, size, 40, SEGMENTS), density=2700.0, connectors=connectors))
        below = parts[0][f"seat_{index // 4}"] if index % 4 == 0 else parts[-2]["tip"]
        joints.append(joint_of(index, below, parts[-1]["root"]))
    return Assembly.from_parts("machine", parts=parts, joints=joints, ground="bed")


def joint_of(index: int, below: Attachment, above: Attachment) -> Joint:
    name = f"joint_{index}"
    if index % 4 == 0:
        return declare.revolute(name, below, above, limits="endless")
    if index % 4 == 1:
        return declare.slider(name, below, above, limits=(0, 30))
    if index % 4 == 2:
        return declare.cylindrical(name, below, above, travel=(0, 20), angle=(-1, 1))
    return declare.ball(name, below, above, cone=0.5)


def fresh(assembly: Assembly) -> Assembly:
    """The same assembly with nothing computed yet."""
    mechanism = type(assembly.mechanism)(assembly.mechanism.parts, assembly.ground, assembly.joints, assembly.mechanism.couplings)
    return replace(assembly, mechanism=mechanism)


def seconds(work: Callable[[], object]) -> float:
    spent = []
    for _ in range(ROUNDS):
        start = time.process_time()
        work()
        spent.append(time.process_time() - start)
    return statistics.median(spent)


def main() -> int:
    assembly = machine_of(PARTS)
    triangles = sum(len(part.mesh.triangles) for part in assembly.parts.values() if part.mesh is not None)
    print(f"{PARTS} parts, {len(assembly.drivers)} columns, {triangles} triangles; processor seconds, median of {ROUNDS}", flush=True)
    slow = []
    with tempfile.TemporaryDirectory() as scratch:
        for name, write in WRITERS.items():
            spent = seconds(lambda write=write: write(fresh(assembly)))
            bundle = write(assembly)
            size = sum(len(content) for content in bundle.files.values()) / 1e6
            folder = Path(scratch) / name.replace(",", "").replace(" ", "_")
            bundle.write(folder)
            back = ""
            if Path(bundle.main).suffix.lower() in {".urdf", ".xml", ".fcstd"}:
                path = folder / bundle.main
                back = f"{seconds(lambda path=path: read(path)):8.2f} s to read"
            print(f"{name:26} {spent:8.2f} s  {size:8.2f} MB  {len(bundle.losses):4} losses {back}", flush=True)
            if spent > GOAL_SECONDS:
                slow.append(name)
    print(f"goal: each below {GOAL_SECONDS} s: {'missed by ' + ', '.join(slow) if slow else 'met'}")
    with tempfile.TemporaryDirectory() as scratch:
        first, again = (_in_a_process_of_its_own(scratch) for _ in range(2))
    met = first <= EXAMPLES_SECONDS and again <= CACHED_SECONDS
    print(f"examples as {', '.join(SIMULATORS)}: {first:.1f} s, and {again:.1f} s with collision shapes from the cache")
    print(f"goal: at most {EXAMPLES_SECONDS:g} s and {CACHED_SECONDS:g} s: {'met' if met else 'missed'}")
    return 1 if slow or not met else 0


def _in_a_process_of_its_own(cache: str) -> float:
    command = [sys.executable, "-m", "benchmarks.exports", "examples"]
    return float(subprocess.run(command, env=os.environ | {"ARTICAD_CACHE": cache}, check=True, capture_output=True, text=True).stdout)


def examples_exported() -> float:
    """Return the processor time of the exports of all examples [s], processes of their own included; parts are read and built before.

    All formats are written from one assembly, as `articad build` and `articad export` do.
    """
    total = 0.0
    for folder in [*map(examples.folder, examples.names()), RECORDED]:
        assembly = fresh(entry.read(folder))
        start = os.times()
        for form in SIMULATORS:
            WRITERS[form](assembly)
        total += sum(os.times()[:4]) - sum(start[:4])
    return total


if __name__ == "__main__":
    if sys.argv[1:] == ["examples"]:
        print(examples_exported())
    else:
        sys.exit(main())
