"""All measurements beside the peers, one after another; reports what has become slower than the stored baseline.

    python -m benchmarks [--only kinematics,loops] [--out FILE] [--keep] [--baseline FILE]

Within a table everything is measured in turn in one process, so a ratio means something on any machine; absolute times are
never compared. `--keep` writes the ratios as the new baseline. Exit code 1 on a missed goal or a regression.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).parent
BASELINE = FOLDER / "baseline.json"
SLACK = 1.3  # by which a ratio may be worse than the baseline's: that of one run to the next on a busy machine
RUNS = {
    "kinematics": ["kinematics.py"],
    "loops": ["loops.py"],
    "interference 10 x 2k": ["interference.py", "--parts", "10", "--triangles", "2000"],
    "interference 10 x 2k curved": ["interference.py", "--parts", "10", "--triangles", "2000", "--curved"],
    "interference 10 x 20k": ["interference.py", "--parts", "10", "--triangles", "20000"],
    "interference 50 x 2k": ["interference.py", "--parts", "50", "--triangles", "2000"],
    "whole": ["whole.py"],
}


def main() -> int:
    """Measure, print, compare, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", help="names of measurements, or their beginnings, with commas between")
    parser.add_argument("--out", help="write everything as JSON")
    parser.add_argument("--keep", action="store_true", help="write the ratios as the baseline")
    parser.add_argument("--baseline", type=Path, default=BASELINE, help="compare with, and keep in, another file")
    options = parser.parse_args()
    wanted = tuple(options.only.split(",")) if options.only else ("",)
    measured = {name: run(words) for name, words in RUNS.items() if name.startswith(wanted)}
    goals = {
        f"{name}: {table['title']}: {goal['method']} / {goal['beside']}": goal
        for name, document in measured.items()
        for table in document["tables"]
        for goal in table["goals"]
    }
    ratios = {name: upright(goal, "ratio") for name, goal in goals.items()}
    missed = sum(not goal["met"] for goal in goals.values())
    slower = compared(ratios, {name: upright(goal, "least_ratio") for name, goal in goals.items()}, options.baseline)
    print(f"\n{len(ratios)} ratios: {missed} goals missed, {len(slower)} slower than the baseline")
    for line in slower:
        print(f"  {line}")
    if options.out:
        Path(options.out).write_text(json.dumps(measured | {"ratios": ratios}, indent=1))
    if options.keep:
        kept = known(options.baseline)
        options.baseline.write_text(
            json.dumps(dict(sorted((kept | {key: round(value, 4) for key, value in ratios.items()}).items())), indent=1) + "\n"
        )
    return 1 if missed or slower else 0


def run(words: list[str]) -> dict:
    """Run one measurement; it prints for itself."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "tables.json"
        subprocess.run([sys.executable, str(FOLDER / words[0]), *words[1:], "--out", str(out)], check=False)
        return json.loads(out.read_text())


def known(baseline: Path) -> dict[str, float]:
    """Return the ratios that were kept."""
    return json.loads(baseline.read_text()) if baseline.exists() else {}


def upright(goal: dict, which: str) -> float:
    """Return a goal's ratio as the method's time over the peer's, whichever way the goal is stated."""
    return goal[which] if goal["at_least"] is None else 1 / goal[which]


def compared(ratios: dict[str, float], least: dict[str, float], baseline: Path) -> list[str]:
    """Return what is slower than the baseline by medians and by least times: other work on the machine spoils one or the other."""
    kept = known(baseline)
    return [
        f"{name}: {ratio:.3g}, was {kept[name]:.3g}"
        for name, ratio in ratios.items()
        if name in kept and min(ratio, least[name]) > SLACK * kept[name]
    ]


if __name__ == "__main__":
    sys.exit(main())
