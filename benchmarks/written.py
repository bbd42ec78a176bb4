"""What a designer writes in the short and in the long form of a plan, for the products of the trial: characters of plans and scripts.

    python benchmarks/written.py

Both are the same product. The long form is the expanded plan, without spaces; its scripts draw each pin and bore in a line of their own, which
`part.made` draws in the short form. A script or a line that several parts share counts once. Exit code 1 if the short form has more than 60 %.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from articad.kernels.parts import find_scripts
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.plan.short import expanded

PRODUCTS: Final = Path(__file__).parent / "products"
NAMES: Final = ("axle", "lamp", "bed")
GOAL: Final = 0.6
_HEAD: Final = "c = part.connectors\n    LOW = (Align.CENTER, Align.CENTER, Align.MIN)\n    "
_FEATURES: Final = {
    "pin": 'shape += Plane(c["{n}"].o, c["{n}"].x, c["{n}"].z) * Cylinder(d["{n}_pin"] / 2, d["{n}_length"], align=LOW)\n    ',
    "bore": 'shape -= Plane(c["{n}"].o, c["{n}"].x, c["{n}"].z) * Cylinder(d["{n}_bore"] / 2, 2 * d["{n}_depth"])\n    ',
}


def written(name: str) -> tuple[int, int]:
    """Return the characters of a product in the short and in the long form."""
    folder = PRODUCTS / name
    short = (folder / "plan.json").read_text(encoding="utf-8")
    plan = expanded(json.loads(short))
    resolved = resolve(AssemblyPlan.loads(short))
    scripts: dict[str, list[Mapping[str, Any]]] = {}
    for part, script in find_scripts(folder / "parts", resolved, "build123d").items():
        scripts.setdefault(script.decode(), []).append(resolved.parts[part].dimensions)
    long = json.dumps(plan, separators=(",", ":"), ensure_ascii=False)
    return len(short) + sum(map(len, scripts)), len(long) + sum(len(drawn(script, sizes)) for script, sizes in scripts.items())


def drawn(script: str, sizes: list[Mapping[str, Any]]) -> str:
    """Return a script that draws the pins and bores of its parts itself."""
    features = sorted({key.rpartition("_")[::2] for held in sizes for key in held if key.rpartition("_")[2] in _FEATURES and "_" in key})
    lines = "".join(_FEATURES[kind].format(n=name) for name, kind in features)
    head, _, shape = script.rpartition("return part.made(")
    return f"{head}{_HEAD if lines else ''}shape = {shape.rstrip().removesuffix(')')}\n    {lines}return shape, part.connectors\n"


def main() -> int:
    """Print a line for each product and return the exit code."""
    worst = 0.0
    for name in NAMES:
        short, long = written(name)
        worst = max(worst, short / long)
        print(f"{name:<6}{short:>8} of {long:>6} characters: {short / long:.0%}")
    print(f"goal {GOAL:.0%}: {'met' if worst <= GOAL else 'missed'}")
    return 0 if worst <= GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
