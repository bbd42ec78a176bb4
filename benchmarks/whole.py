"""The whole at its ends: how soon a command answers, and what very large assemblies cost.

    python benchmarks/whole.py [--out FILE]

`articad --help` beside bare Python; a chain of 200 and of 1000 links, made, placed and fully checked in a process of its own;
and the memory of 200 parts of 20,000 triangles each.
"""

from __future__ import annotations

import argparse
import itertools
import json
import resource
import statistics
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from articad.interference.check import check_scene
from articad.kinematics.mechanism import Mechanism
from benchmarks.interference import chain
from benchmarks.timing import Goal, Table, Times, report

ROUNDS = 15
START_S = 0.060  # over bare Python
MOST_GB = 1.0
GROWTH = 1.3  # of the time per part from 200 to 1000
COMMANDS = {
    "python -c pass": ["-c", "pass"],
    "articad --version": ["-m", "articad.cli", "--version"],
    "articad --help": ["-m", "articad.cli", "--help"],
}
STAGES = ("make", "place", "check")


def start_table() -> Table:
    """Return the time of a process that answers."""
    rounds: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(ROUNDS):
        for name, words in COMMANDS.items():
            start = time.perf_counter()
            subprocess.run([sys.executable, *words], check=True, stdout=subprocess.DEVNULL)
            rounds[name].append(time.perf_counter() - start)
    bare = statistics.median(rounds["python -c pass"])
    over = {name: statistics.median(seconds) - bare for name, seconds in rounds.items() if name != "python -c pass"}
    notes = [
        f"{'met   ' if seconds <= START_S else 'MISSED'} {name}: {1e3 * seconds:.0f} ms over bare Python (goal <= 60 ms)"
        for name, seconds in over.items()
    ]
    return Table("a process that answers", Times(rounds), (), tuple(notes))


def large_table() -> Table:
    """Return times per part of 200 and 1000 links, each in a process of its own, so that memory is theirs."""
    seconds: dict[str, float] = {}
    notes = []
    for parts, triangles in ((200, 500), (1000, 500), (200, 20_000)):
        out = subprocess.run(
            [sys.executable, __file__, "--inner", str(parts), str(triangles)], check=True, capture_output=True, text=True
        ).stdout
        measured = json.loads(out)
        if triangles == 500:
            seconds |= {f"{stage} {parts}": measured[stage] / parts for stage in STAGES}
        gigabytes = measured["peak_gb"]
        held = "met   " if gigabytes < MOST_GB or triangles == 20_000 else "MISSED"
        notes.append(
            f"{held} {parts} parts of {measured['triangles']} triangles: "
            + ", ".join(f"{stage} {measured[stage]:.3f} s" for stage in STAGES)
            + f"; {gigabytes:.2f} GB at most, {measured['scene_gb']:.2f} GB of it imports"
        )
    goals = tuple(Goal(f"{stage} 1000", f"{stage} 200", at_most=GROWTH) for stage in STAGES)
    return Table("one assembly, made, placed and checked: time per part", seconds, goals, tuple(notes))


def inner(parts: int, triangles: int) -> dict[str, float]:
    """Measure one size in this process."""
    before = peak_gb()
    scene, first = chain(parts, triangles)
    clock = [time.process_time()]
    mechanism = Mechanism(first.parts, first.ground, first.joints)
    clock.append(time.process_time())
    placed = mechanism.poses(mechanism.rest)
    clock.append(time.process_time())
    checks = check_scene(scene, dict(zip(mechanism.parts, placed, strict=True)))
    clock.append(time.process_time())
    assert len(checks.pairs) >= parts - 1
    times = dict(zip(STAGES, (b - a for a, b in itertools.pairwise(clock)), strict=True))
    return times | {"peak_gb": peak_gb(), "scene_gb": before, "triangles": max(len(mesh.triangles) for mesh in scene.meshes.values())}


def peak_gb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20


def main() -> int:
    """Measure, print, and return the number of goals missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", help="write the tables as JSON")
    parser.add_argument("--inner", nargs=2, type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.inner:
        print(json.dumps(inner(*options.inner)))
        return 0
    return min(report([start_table(), large_table()], options.out), 1)


if __name__ == "__main__":
    sys.exit(main())
