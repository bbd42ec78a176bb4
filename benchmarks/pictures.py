"""What pictures and the page add to a cached build of each example.

    python benchmarks/pictures.py [EXAMPLE …]

Each example is built once so that everything is cached, then once with and once without pictures and page. Times are processor time of
the command and all its children, which other work on the machine does not change.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
GOAL = 1.5  # times the build without pictures


def seconds(example: str, out: Path, *options: str) -> float:
    """Return the processor time of a build [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = [str(Path(sys.executable).with_name("articad")), "build", str(ROOT / "examples" / example), "--out", str(out), "-q", *options]
    subprocess.run(words, check=True, cwd=ROOT, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"}, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> int:
    """Measure, print, and return 1 if a build misses the goal."""
    examples = sys.argv[1:] or sorted(plan.parent.name for plan in (ROOT / "examples").glob("*/plan.json"))
    missed = 0
    for example in examples:
        with tempfile.TemporaryDirectory() as folder:
            seconds(example, Path(folder, "first"))
            without = seconds(example, Path(folder, "without"), "--no-pictures")
            whole = seconds(example, Path(folder, "with"))
        met = whole <= GOAL * without
        missed += not met
        print(
            f"{'met   ' if met else 'MISSED'} {example}: {whole:.1f} s with, {without:.1f} s without: {whole / without:.2f} times",
            flush=True,
        )
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
