"""Draws the badges of the README from pyproject.toml, as docs/images/badges.svg. `--check` only compares.

.venv/bin/python scripts/badges.py [--check]
"""

from __future__ import annotations

import sys
import tomllib
from html import escape
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "docs" / "images" / "badges.svg"
LETTER, PADDING, HEIGHT, GAP = 6.7, 8, 20, 6  # pixels; a letter of 11 px DejaVu Sans is 6.7 px wide on average


def facts() -> list[tuple[str, str, str]]:
    """Return the name, the value and the colour of each badge."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    about, mypy = project["project"], project["tool"]["mypy"]
    status = next(line.split("- ")[-1].lower() for line in about["classifiers"] if line.startswith("Development Status"))
    found = [
        ("python", about["requires-python"].replace(">=", "≥ "), "#2b6cb0"),
        ("licence", about["license"], "#2f855a"),
        ("status", status, "#9a5b00"),
        ("platform", "Linux", "#4a5568"),
    ]
    return [*found, ("types", "mypy strict", "#2f855a")] if mypy.get("strict") else found


def drawing() -> str:
    """Return the picture of all badges in a row."""
    pieces, at = [], 0.0
    for name, value, color in facts():
        left, right = (round(len(word) * LETTER + 2 * PADDING) for word in (name, value))
        pieces.append(
            f'<g transform="translate({at:g} 0)"><path fill="#3b424c" d="M4 0h{left - 4}v{HEIGHT}H4a4 4 0 0 1-4-4V4a4 4 0 0 1 4-4z"/>'
            f'<path fill="{color}" d="M{left} 0h{right - 4}a4 4 0 0 1 4 4v{HEIGHT - 8}a4 4 0 0 1-4 4H{left}z"/>'
            f'<text x="{left / 2:g}" y="14">{escape(name)}</text><text x="{left + right / 2:g}" y="14">{escape(value)}</text></g>'
        )
        at += left + right + GAP
    width = at - GAP
    told = ", ".join(f"{name}: {value}" for name, value, _ in facts())
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{HEIGHT}" role="img" aria-label="{escape(told)}" '
        f'fill="#fff" font-family="DejaVu Sans,Verdana,sans-serif" font-size="11" text-anchor="middle"><title>{escape(told)}</title>'
        f"{''.join(pieces)}</svg>\n"
    )


def main(arguments: list[str]) -> int:
    """Write the file, or compare it; return 1 if it differs."""
    text = drawing()
    if "--check" in arguments:
        if FILE.read_text(encoding="utf-8") == text:
            return 0
        print(f"{FILE.relative_to(ROOT)} is not what pyproject.toml gives: run scripts/badges.py", file=sys.stderr)
        return 1
    FILE.write_text(text, encoding="utf-8")
    print(FILE.relative_to(ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
