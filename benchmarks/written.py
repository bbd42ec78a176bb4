"""What a designer writes for the products of the trial: characters of the plan and of the script of its parts.

    python benchmarks/written.py

They are compared with what the same products took in the long form of a plan, with scripts that draw each pin and bore, and with the script that an
agent without a tool wrote for each in the trial. Exit code 1 if one has more than 60 % of the long form, or more than the script alone.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final, NamedTuple

PRODUCTS: Final = Path(__file__).parent / "products"
GOAL: Final = 0.6


class Before(NamedTuple):
    """Characters of a product as it was written before: in the long form, and in one script without a tool."""

    long: int
    alone: int


NAMES: Final = {"axle": Before(15_124, 5_548), "lamp": Before(12_632, 5_010), "bed": Before(12_405, 3_631)}


def written(name: str) -> int:
    """Return the characters of a product's plan and scripts."""
    folder = PRODUCTS / name
    return sum(len(file.read_text(encoding="utf-8")) for file in [folder / "plan.json", *folder.rglob("*.py")])


def main() -> int:
    """Print a line for each product and return the exit code."""
    met = True
    for name, before in NAMES.items():
        now = written(name)
        met &= now <= GOAL * before.long and now <= before.alone
        print(f"{name:<6}{now:>6} characters: {now / before.long:.0%} of the long form, {now / before.alone:.0%} of a script alone")
    print(f"goal {GOAL:.0%} and 100%: {'met' if met else 'missed'}")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
