"""The page of a report: how soon it can be used, and how large it is.

    python benchmarks/report.py [--out report.json]

Twenty parts of ten thousand triangles each, in headless Chromium with a software renderer. The goal is for an idle machine with two
processors; the time is the page's own clock, from the navigation to the end of its first frame.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from playwright.sync_api import sync_playwright

from articad.assembly import Assembly
from articad.connectors import SE3, Connector
from articad.geometry.part import Part
from articad.geometry.shapes import sphere
from articad.kinematics import declare
from articad.report import report_page, viewer_model
from benchmarks.timing import Table, measure, report

PARTS, SEGMENTS = 20, 101  # 101 segments make about 10k triangles
FRAME_SECONDS, PAGE_BYTES = 2.0, 1_000_000
FLAGS = ["--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--no-sandbox"]
ROUNDS = 5


def assembly() -> Assembly:
    """Return a row of balls, each on a hinge on the one before; no two share a mesh."""
    parts = [
        Part.from_mesh(
            f"ball_{i}",
            sphere(9.0 + 0.01 * i, SEGMENTS),
            connectors={
                "near": Connector("near", SE3.from_translation([-10, 0, 0])),
                "far": Connector("far", SE3.from_translation([10, 0, 0])),
            },
        )
        for i in range(PARTS)
    ]
    joints = [declare.revolute(f"joint_{i}", parts[i]["far"], parts[i + 1]["near"], limits=(-1.0, 1.0)) for i in range(PARTS - 1)]
    return Assembly.from_parts("chain", parts=parts, joints=joints, ground="ball_0")


def main() -> int:
    """Measure, print, and return 1 if a goal was missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", help="write the tables as JSON")
    options = parser.parse_args()
    made = assembly()
    triangles = sum(len(part.mesh.triangles) for part in made.parts.values() if part.mesh is not None)
    text = report_page(made)
    meshes = sum(len(value) for mesh in viewer_model(made)["meshes"] for value in mesh.values() if isinstance(value, str))
    times = measure({"making the page": lambda: report_page(made)}, rounds=2)
    frames, drags = [], []
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder, "page.html")
        file.write_text(text, encoding="utf-8")
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        for _ in range(ROUNDS):
            page = browser.new_page(viewport={"width": 1200, "height": 800})
            page.goto(file.as_uri())
            page.wait_for_selector("html[data-ready]", state="attached", timeout=60_000)
            frames.append(page.evaluate("articad.firstFrame") / 1000)
            drags.append(
                page.evaluate(
                    "(() => { const t = performance.now(); articad.set({joint_0: 0.5}); articad.view.draw(); return performance.now() - t })()"
                )
                / 1000
            )
            page.close()
        browser.close()
    first, size = min(frames), len(text.encode()) - meshes
    notes = (
        f"{'met   ' if first <= FRAME_SECONDS else 'MISSED'} first frame {first:.2f} s, slowest {max(frames):.2f} s (goal <= {FRAME_SECONDS:g} s)",
        f"{'met   ' if size <= PAGE_BYTES else 'MISSED'} page without meshes {size} bytes (goal <= {PAGE_BYTES}); meshes {meshes} bytes",
    )
    shown = dict(times) | {"first frame": first, "moving a driver, until the drawing is asked for": min(drags)}
    report([Table(f"page of {PARTS} parts, {triangles} triangles", shown, notes=notes)], options.out)
    return 0 if first <= FRAME_SECONDS and size <= PAGE_BYTES else 1


if __name__ == "__main__":
    sys.exit(main())
