"""Pictures by ray casting: time of a view and of a filmstrip.

    python benchmarks/render.py [--out render.json]

Rays are cast and shaded by one thread, so its own time is measured, which others on the machine spoil less. The table also holds
PyVista where it can draw.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from articad.connectors import SE3
from articad.geometry.shapes import sphere
from articad.render import Camera, DrawnMesh, DrawnScene, cast, picture, vtk
from articad.render.shade import shade
from benchmarks.timing import Table, measure, report

SIZE = 512
PARTS = 10
FRAMES = 60
VIEW_SECONDS, STRIP_SECONDS, LARGE_SECONDS = 0.15, 10.0, 1.0


def scene(segments: int, shift: float = 0.0) -> DrawnScene:
    """Return a row of spheres; 46 segments are about 2k triangles each, 143 about 20k."""
    ball = sphere(10.0, segments)
    return DrawnScene(
        tuple(DrawnMesh(f"ball_{i}", ball, SE3.from_translation([22.0 * i, shift * i, 0.0]), "#8a9299") for i in range(PARTS))
    )


def view(drawn: DrawnScene, supersample: int = 1) -> object:
    """Draw one view, with everything that is written over it."""
    return picture(drawn, Camera.fit("iso", drawn.bounds, width=SIZE, height=SIZE), supersample=supersample)


def main() -> int:
    """Measure, print, and return 1 if a goal was missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", help="write the tables as JSON")
    options = parser.parse_args()
    small, large = scene(46), scene(143)
    frames = [scene(46, 0.1 * i) for i in range(FRAMES)]
    camera = Camera.fit("iso", frames[-1].bounds, width=SIZE // 2, height=SIZE // 2)
    methods = {
        f"view, {_triangles(small)} triangles": lambda: view(small),
        f"view, {_triangles(small)} triangles, 2 x 2 rays": lambda: view(small, 2),
        f"view, {_triangles(large)} triangles": lambda: view(large),
        "rays alone": lambda: cast(small, camera),
        "rays and shading": lambda: shade(small, camera, cast(small, camera)),
    }
    if vtk.available():
        methods["PyVista, the same small scene"] = lambda: vtk.draw(small, Camera.fit("iso", small.bounds, width=SIZE, height=SIZE))
    times = measure(methods, rounds=5, clock=time.process_time)
    strip = measure(
        {f"filmstrip of {FRAMES} frames": lambda: [picture(frame, camera, supersample=1) for frame in frames]},
        rounds=1,
        clock=time.process_time,
    )
    names = list(times)
    held = [(times[names[0]], VIEW_SECONDS), (times[names[2]], LARGE_SECONDS), (next(iter(strip.values())), STRIP_SECONDS)]
    notes = tuple(f"{'met   ' if seconds <= goal else 'MISSED'} {seconds:.3f} s (goal <= {goal:g} s)" for seconds, goal in held)
    report([Table(f"pictures of {PARTS} parts, {SIZE} x {SIZE}", dict(times) | dict(strip), notes=notes)], options.out)
    return 0 if all(seconds <= goal for seconds, goal in held) else 1


def _triangles(drawn: DrawnScene) -> int:
    return sum(len(item.mesh.triangles) for item in drawn.items)


if __name__ == "__main__":
    sys.exit(main())
