"""The page of a report: how soon it can be used, how smoothly it plays, and how large it is.

    python benchmarks/report.py [--out report.json] [--sizes]

The table football, 36 parts, in headless Chromium with a software renderer, its picture 1280 × 720 pixels. The goals are for an idle
machine with two processors and no GPU. The first frame is timed by the page's own clock, from the navigation; frames are counted while
the whole product plays, after two seconds in which the page finds the resolution that the machine can draw.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from playwright.sync_api import sync_playwright

from articad.assembly import Assembly
from articad.plan.schema import AssemblyPlan
from articad.report import Documents, report_page
from benchmarks.timing import Table, processor_seconds, report

ROOT = Path(__file__).resolve().parents[1]
EXAMPLE = "table_football"
FRAME_SECONDS, FRAMES_PER_SECOND, PAGE_BYTES = 1.0, 15.0, 1_500_000
FLAGS = ["--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--no-sandbox"]
WHOLE = "const s = document.querySelector('#stage').style; s.position = 'fixed'; s.inset = '0'; s.height = 'auto'; s.zIndex = 9;"
COUNTED = """async () => {
  const { view } = articad, before = view.frames, start = performance.now();
  await new Promise(done => setTimeout(done, 5000));
  const { width, height } = view.canvas;
  return [(view.frames - before) / (performance.now() - start) * 1000, width, height];
}"""
SECONDS = 5.0  # over which frames are counted
ROUNDS = 5


def page_of(name: str) -> tuple[int, str]:
    """Return the number of parts and the page of an example, with its checks and its plan."""
    folder = ROOT / "examples" / name
    plan = AssemblyPlan.load(folder)
    assembly = Assembly.from_plan(plan, folder / "parts")
    return len(assembly.parts), report_page(assembly, Documents(checks=assembly.check().to_json(), plan=plan.dumps()))


def main() -> int:
    """Measure, print, and return 1 if a goal was missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", help="write the tables as JSON")
    parser.add_argument("--sizes", action="store_true", help="make the page of every example, too, and state its size")
    options = parser.parse_args()
    parts, text = page_of(EXAMPLE)
    frames = []
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder, "page.html")
        file.write_text(text, encoding="utf-8")
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        for _ in range(ROUNDS):
            page = browser.new_page(viewport={"width": 1280, "height": 720})
            page.goto(file.as_uri())
            page.wait_for_selector("html[data-ready]", state="attached", timeout=60_000)
            frames.append(page.evaluate("articad.firstFrame") / 1000)
            page.close()
        page = browser.new_page(viewport={"width": 1280, "height": 720})
        page.goto(file.as_uri())
        page.wait_for_selector("html[data-ready]", state="attached", timeout=60_000)
        page.evaluate(f"() => {{ {WHOLE} document.querySelector('#play').click() }}")
        page.wait_for_timeout(2000)
        before = processor_seconds(os.getpid())
        rate, width, height = page.evaluate(COUNTED)
        work = (processor_seconds(os.getpid()) - before) / (rate * SECONDS)
        browser.close()
    pages = sorted(path.parent.name for path in (ROOT / "examples").glob("*/plan.json")) if options.sizes else [EXAMPLE]
    sizes = {name: len((text if name == EXAMPLE else page_of(name)[1]).encode()) for name in pages}
    first, largest = min(frames), max(sizes, key=lambda name: sizes[name])
    notes = (
        _note(first <= FRAME_SECONDS, f"first frame {first:.2f} s, slowest of {ROUNDS} {max(frames):.2f} s (goal <= {FRAME_SECONDS:g} s)"),
        _note(
            rate >= FRAMES_PER_SECOND,
            f"{rate:.1f} frames/s at 1280x720, drawn as {width}x{height} (goal >= {FRAMES_PER_SECOND:g}); {work:.3f} s of processor time a frame",
        ),
        _note(sizes[largest] <= PAGE_BYTES, f"largest of {len(sizes)} pages: {largest}, {sizes[largest]} bytes (goal <= {PAGE_BYTES})"),
    )
    report([Table(f"page of {parts} parts", {"first frame": first, "a frame while playing": 1 / rate}, notes=notes)], options.out)
    return 0 if all(note.startswith("met") for note in notes) else 1


def _note(met: bool, words: str) -> str:
    return f"{'met   ' if met else 'MISSED'} {words}"


if __name__ == "__main__":
    sys.exit(main())
