"""Draws the gallery of the documentation: a sheet of each example, and a small picture for the front page.

.venv/bin/python scripts/gallery.py [--small] [NAME ...]
"""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

from articad.assembly import Assembly
from articad.plan.schema import AssemblyPlan
from articad.render import png, product_sheet, render_clean

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images" / "gallery"
SMALL = ROOT / "docs" / "images" / "live"
PAGE = ROOT / "docs" / "gallery.md"
SMALL_SIZE = (360, 270)  # pixels: twice what is shown
COLOURS = 128  # colours of a sheet's palette: half the bytes, with no visible difference


def main(names: list[str]) -> int:
    """Draw the named examples, or all, and write the page; with --small, only the small pictures."""
    small = "--small" in names
    names = [name for name in names if not name.startswith("--")]
    examples = sorted(path.parent for path in (ROOT / "examples").glob("*/plan.json"))
    IMAGES.mkdir(parents=True, exist_ok=True)
    SMALL.mkdir(parents=True, exist_ok=True)
    for folder in examples:
        if not names or folder.name in names:
            assembly = Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")
            picture = render_clean(assembly, ("iso",), size=SMALL_SIZE, transparent=True)["iso"]
            (SMALL / f"{folder.name}.png").write_bytes(png(picture.quantize(COLOURS, method=Image.Quantize.FASTOCTREE)))
            if not small:
                (IMAGES / f"{folder.name}.png").write_bytes(png(product_sheet(assembly).quantize(COLOURS)))
            print(folder.name)
    PAGE.write_text(_page([folder for folder in examples if (IMAGES / f"{folder.name}.png").is_file()]))
    return 0


def _page(folders: list[Path]) -> str:
    lines = [
        "# Gallery",
        "",
        "Every example of the repository, drawn by `scripts/gallery.py` from the plan and the part scripts, with no display or GPU:",
        "two views, then for each driver the two ends of its motion, or the first quarter of a motion of more than half a turn. Parts that do not move are faded.",
        "Axes point along +z of the parent connector, arrows follow the right-hand rule; a dot is an axis towards you, a cross one away from you.",
        "*Move it* opens the example with a slider for each driver, built together with this site.",
        "",
    ]
    for folder in folders:
        plan = AssemblyPlan.load(folder)
        joints = sum(joint.type != "fixed" for joint in plan.joints if hasattr(joint, "type"))
        title = plan.name.replace("_", " ").capitalize()
        lines += [f"## {title}", "", plan.description or title, ""]
        lines += [f"![{title}: views and motions](images/gallery/{folder.name}.png)", ""]
        lines += [
            f"[Move it](live/{folder.name}.html){{ .md-button }} or `articad build examples/{folder.name}` · {len(plan.parts)} entries in the plan, {joints} joints that move.",
            "",
        ]
    return "\n".join(lines).rstrip() + "\n"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
