"""Draws the moving picture of README and documentation: three examples in motion, as docs/images/moving.gif.

.venv/bin/python scripts/moving_picture.py
"""

from __future__ import annotations

import io
import math
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from PIL import Image

from articad.assembly import Assembly
from articad.plan.schema import AssemblyPlan
from articad.render import clean_frames

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "docs" / "images" / "moving.gif"
FRAMES, MILLISECONDS = 16, 110
PANEL = (290, 300)
PAPER = (246, 247, 249)
LARGEST = 3_000_000  # bytes: a README must load at once

# For each driver: amplitude as a share of its distance to the nearer limit, and phase in turns.
MOTIONS: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "desk_lamp": {"swivel": (0.3, 0.0), "shoulder": (0.8, 0.25), "elbow": (0.8, 0.5)},
    "table_football": {
        "red_attack.travel": (0.7, 0.0),
        "red_attack.angle": (0.22, 0.0),
        "red_defence.travel": (0.6, 0.5),
        "red_defence.angle": (0.12, 0.3),
        "blue_attack.travel": (0.7, 0.5),
        "blue_attack.angle": (0.22, 0.5),
        "blue_defence.travel": (0.6, 0.0),
        "blue_keeper.travel": (0.5, 0.25),
        "red_keeper.travel": (0.5, 0.75),
    },
    "stewart_platform": {f"leg_{name}": (0.9, (index // 2) / 3) for index, name in enumerate("abcdef")},
}


def main() -> int:
    """Draw all frames and write the file."""
    panels = [_frames(name, motion) for name, motion in MOTIONS.items()]
    sheets = []
    for row in zip(*panels, strict=True):
        sheet = Image.new("RGB", (PANEL[0] * len(row), PANEL[1]), PAPER)
        for index, picture in enumerate(row):
            sheet.paste(picture, (PANEL[0] * index, 0), picture)
        sheets.append(sheet)
    # One palette for all frames: colours do not flicker, and unchanged pixels cost nothing.
    strip = Image.new("RGB", (sheets[0].width, sheets[0].height * 3))
    for index in range(3):
        strip.paste(sheets[index * FRAMES // 3], (0, index * sheets[0].height))
    palette = strip.quantize(colors=200, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    frames = [sheet.quantize(palette=palette, dither=Image.Dither.NONE) for sheet in sheets]
    stream = io.BytesIO()
    frames[0].save(stream, format="GIF", save_all=True, append_images=frames[1:], duration=MILLISECONDS, loop=0, optimize=False)
    content = stream.getvalue()
    if len(content) > LARGEST:
        print(f"{len(content)} bytes are more than {LARGEST}: draw fewer or smaller frames", file=sys.stderr)
        return 1
    FILE.write_bytes(content)
    print(f"{FILE.relative_to(ROOT)}: {len(content) / 1e6:.2f} MB, {len(frames)} frames")
    return 0


def _frames(name: str, motion: Mapping[str, tuple[float, float]]) -> list[Image.Image]:
    folder = ROOT / "examples" / name
    assembly = Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")
    rows = []
    for frame in range(FRAMES):
        q = np.array(assembly.mechanism.rest, dtype=np.float64)
        for column, driver in enumerate(assembly.drivers):
            if driver.name in motion:
                amplitude, phase = motion[driver.name]
                free = min(driver.upper - driver.rest, driver.rest - driver.lower, math.pi if driver.unit == "rad" else 100.0)
                q[column] = driver.rest + amplitude * free * math.sin(2 * math.pi * (frame / FRAMES + phase))
        rows.append(q)
    return clean_frames(assembly, np.array(rows), size=PANEL, transparent=True)


if __name__ == "__main__":
    sys.exit(main())
