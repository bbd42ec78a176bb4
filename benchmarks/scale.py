"""What long chains cost: every export of 2,000 parts, the audit of 1,000 links. Run: python benchmarks/scale.py [--parts 2000]

Seconds are of the processor, of this process and those that it started, so that a busy machine changes no verdict; wall time is
beside them. Exit code 1 if an export takes more than 60 s, if a part of the long chain costs more than 1.3 of one in a chain a tenth
as long, or if the audit takes more than 60 s.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from articad.auditing.examine import AuditOptions, audit_file
from articad.formats import FORMATS, NAMED
from articad.kernels import freecad_install
from tests.chains import chain
from tests.leftovers import descendants

MOST_S, MOST_RATIO = 60.0, 1.3


def main() -> int:
    """Measure, print, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", type=int, default=2000)
    parser.add_argument("--links", type=int, default=1000, help="of the audit")
    parser.add_argument("--only", default="", help="names of formats, with commas between; `audit` for the audit")
    options = parser.parse_args()
    wanted = options.only.split(",") if options.only else [*(row.name for row in FORMATS), "audit"]
    missed = 0
    few = options.parts // 10
    print(f"| export | {few} parts | {options.parts} parts | wall | per part | |\n|---|---|---|---|---|---|")
    for name in (row.name for row in FORMATS if row.name in wanted):
        if name == "freecad" and not freecad_install.installed():
            print(f"| {name} | | | | | not measured: FreeCAD is not installed |")
            continue
        write = NAMED[name].writer
        write(chain(3))  # imports and caches
        short = min(seconds(lambda: write(chain(few)))[0] for _ in range(3))  # noqa: B023 - called at once
        long, wall = seconds(lambda: write(chain(options.parts)))  # noqa: B023 - called at once
        ratio = long / options.parts / (short / few)
        met = long <= MOST_S and ratio <= MOST_RATIO
        missed += not met
        print(f"| {name} | {short:.2f} s | {long:.2f} s | {wall:.1f} s | {ratio:.2f} | {'' if met else 'MISSED'} |", flush=True)
    if "audit" in wanted:
        with tempfile.TemporaryDirectory() as folder:
            bundle = NAMED["urdf"].writer(chain(options.links))
            bundle.write(Path(folder))
            spent, wall = seconds(lambda: audit_file(Path(folder) / bundle.main, AuditOptions()))
        missed += spent > MOST_S
        print(f"audit of {options.links} links: {spent:.1f} s, {wall:.1f} s of wall time{' MISSED' if spent > MOST_S else ''}")
    print(f"{missed} missed")
    return int(missed > 0)


def seconds(work: Callable[[], object]) -> tuple[float, float]:
    """Return the processor time, with that of all processes that it starts, and the wall time of a piece of work.

    The times of processes are read while they run: FreeCAD's sandbox ends without waiting for FreeCAD, so that the kernel adds its
    time to nobody's.
    """
    began, before, seen, ended = time.monotonic(), os.times(), dict[int, float](), threading.Event()
    watcher = threading.Thread(target=_watch, args=(seen, ended))
    watcher.start()
    try:
        work()
    finally:
        ended.set()
        watcher.join()
    after = os.times()
    own, reaped = sum(after[:2]) - sum(before[:2]), sum(after[2:4]) - sum(before[2:4])
    return own + max(reaped, sum(seen.values())), time.monotonic() - began


def _watch(seen: dict[int, float], ended: threading.Event) -> None:
    """Keep the latest processor time of each process below this one until the work has ended."""
    while not ended.wait(0.3):
        for child in descendants(os.getpid()):
            with contextlib.suppress(OSError):
                fields = Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()
                seen[child] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    sys.exit(main())
