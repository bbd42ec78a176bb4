"""Draws the sheet of four products in three renderings: docs/images/compared.png. Look at it before you commit it.

.venv/bin/python scripts/comparison.py [--freecad FOLDER] [--unlabelled SHEET.png]

The rows are `articad render` with labels, as pictures were before clean ones; `articad render --clean`; and FreeCAD's own view of the
exported document. FreeCAD's pictures are taken by scripts/freecad-screenshot, which takes minutes: FOLDER keeps them, NAME.png each.
`--unlabelled` also writes the pictures without a word, in an order that differs for each product, for people who rank them.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from articad.assembly import Assembly
from articad.export.freecad import write_freecad
from articad.plan.schema import AssemblyPlan
from articad.render import render_clean, render_views

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "docs" / "images" / "compared.png"
TASKS = ROOT / "bench" / "articad_bench" / "tasks"
PRODUCTS = {
    "lamp": ROOT / "examples" / "desk_lamp",
    "wardrobe": ROOT / "examples" / "wardrobe",
    "engine": TASKS / "engine_inline_three" / "reference",
    "excavator": TASKS / "excavator_arm" / "reference",
}
ROWS = ("with labels", "clean", "FreeCAD's\nown view")
CELL, GAP, LEFT, TOP = 400, 10, 110, 30  # pixels
VIEW = (0.272, 0.10, 0.992, 0.934)  # FreeCAD's view in its window, as shares: left, top, right, bottom
CUBE = 0.87  # share of the window's width where the navigation cube and the axes begin


def main() -> int:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--freecad", help="folder of FreeCAD's pictures, taken where they are missing")
    parser.add_argument("--unlabelled", help="also write a sheet without words")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(options.freecad or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        columns = {name: _column(name, source, folder) for name, source in PRODUCTS.items()}
    sheet = Image.new("RGB", (LEFT + len(columns) * (CELL + GAP), TOP + len(ROWS) * (CELL + GAP)), "white")
    pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(16)
    for row, words in enumerate(ROWS):
        pen.multiline_text((LEFT / 2, TOP + row * (CELL + GAP) + CELL / 2), words, "black", font, "mm", align="center")
    for at, (name, pictures) in enumerate(columns.items()):
        left = LEFT + at * (CELL + GAP)
        pen.text((left + CELL / 2, TOP / 2), name, "black", font, "mm")
        for row, picture in enumerate(pictures):
            sheet.paste(picture, (left, TOP + row * (CELL + GAP)))
    sheet.save(FILE, optimize=True)
    print(f"{FILE.relative_to(ROOT)}: {FILE.stat().st_size / 1e6:.2f} MB")
    if options.unlabelled:
        _unlabelled(columns).save(options.unlabelled)
    return 0


def _column(name: str, source: Path, folder: Path) -> list[Image.Image]:
    assembly = Assembly.from_plan(AssemblyPlan.load(source), source / "parts")
    shot = folder / f"{name}.png"
    if not shot.is_file():
        document = write_freecad(assembly).write(folder)[0]
        subprocess.run([ROOT / "scripts" / "freecad-screenshot", document, shot], check=True)
    print(name, flush=True)
    return [
        render_views(assembly, ("iso",), size=CELL)["iso"].convert("RGB"),
        render_clean(assembly, ("iso",), size=(CELL, CELL))["iso"],
        _cropped(Image.open(shot).convert("RGB")),
    ]


def _cropped(window: Image.Image) -> Image.Image:
    """Return the model in FreeCAD's window: a square about what differs from the background, which changes from top to bottom only."""
    pixels = np.asarray(window).astype(int)
    left, top, right, bottom = (round(share * side) for share, side in zip(VIEW, window.size * 2, strict=True))
    view = pixels[top:bottom, left : round(CUBE * window.width)]
    ink = np.abs(view - np.median(view, axis=1, keepdims=True)).max(axis=2) > 24
    rows, columns = np.flatnonzero(ink.sum(axis=1) > 3), np.flatnonzero(ink.sum(axis=0) > 3)
    half = min(max(np.ptp(rows), np.ptp(columns)) / 2 * 1.12, (bottom - top) / 2)
    across = np.clip(left + (columns[0] + columns[-1]) / 2, left + half, right - half)
    down = np.clip(top + (rows[0] + rows[-1]) / 2, top + half, bottom - half)
    box = (float(across - half), float(down - half), float(across + half), float(down + half))
    return window.crop(box).resize((CELL, CELL), Image.Resampling.LANCZOS)


def _unlabelled(columns: dict[str, list[Image.Image]]) -> Image.Image:
    """Return all pictures of each product side by side, the columns in another order for each product."""
    sheet = Image.new("RGB", (len(ROWS) * (CELL + GAP), len(columns) * (CELL + GAP)), "white")
    for row, pictures in enumerate(columns.values()):
        for at in range(len(ROWS)):
            sheet.paste(pictures[(at + row) % len(ROWS)], (at * (CELL + GAP), row * (CELL + GAP)))
    return sheet


if __name__ == "__main__":
    sys.exit(main())
