"""Interleaved timing: every method of a table is measured in turn in one process, so that ratios mean something on a busy machine."""

from __future__ import annotations

import gc
import json
import math
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

ROUNDS = 15
ROUND_SECONDS = 0.05  # each method runs at least this long in a round


@dataclass(frozen=True)
class Goal:
    """A bound for a method's median: at most, or at least, a multiple of another's."""

    method: str
    beside: str
    at_most: float | None = None
    at_least: float | None = None


class Times(dict[str, float]):
    """Median time of one call of each method [s].

    Attributes:
        least: Smallest time of each: least affected by other work on the machine.
    """

    def __init__(self, rounds: Mapping[str, list[float]]) -> None:
        super().__init__({name: statistics.median(values) for name, values in rounds.items()})
        self.least = {name: min(values) for name, values in rounds.items()}

    def each(self, calls: Mapping[str, int]) -> Times:
        """Return the times divided by how many things each method's call does."""
        return Times({name: [self.least[name] / calls[name], seconds / calls[name], math.inf] for name, seconds in self.items()})


@dataclass(frozen=True)
class Table:
    """Medians of one measurement, and its goals.

    Attributes:
        title: What was measured.
        seconds: Median of one call by method.
        goals: Ratios asked for.
        notes: Further remarks, one line each.
    """

    title: str
    seconds: Mapping[str, float]
    goals: tuple[Goal, ...] = ()
    notes: tuple[str, ...] = ()

    def ratio(self, goal: Goal) -> float:
        """Return how many times the peer's median the method takes (for at_least: the peer takes of the method's)."""
        return _ratio(self.seconds, goal)

    def least_ratio(self, goal: Goal) -> float:
        """Return the same of the least times, where they are known."""
        return _ratio(self.seconds.least if isinstance(self.seconds, Times) else self.seconds, goal)

    def met(self, goal: Goal) -> bool:
        """Whether the goal is met."""
        ratio = self.ratio(goal)
        return (goal.at_most is None or ratio <= goal.at_most) and (goal.at_least is None or ratio >= goal.at_least)

    def print(self) -> None:
        """Print the table and its goals."""
        print(f"\n{self.title}")
        width = max(map(len, self.seconds))
        fastest = min(self.seconds.values())
        for method, seconds in self.seconds.items():
            least = f"  least {_shown(self.seconds.least[method]):>10}" if isinstance(self.seconds, Times) else ""
            print(f"  {method:<{width}}  {_shown(seconds):>10}  {seconds / fastest:8.2f}x{least}")
        for goal in self.goals:
            if goal.at_least is not None:
                asked, said = f">= {goal.at_least:g}x", f"{goal.beside} takes {self.ratio(goal):.2f}x of {goal.method}"
            else:
                asked, said = f"<= {goal.at_most:g}x", f"{goal.method} takes {self.ratio(goal):.2f}x of {goal.beside}"
            by_least = f", by least times {self.least_ratio(goal):.2f}x" if isinstance(self.seconds, Times) else ""
            print(f"  {'met   ' if self.met(goal) else 'MISSED'} {said}{by_least} (goal {asked})")
        for note in self.notes:
            print(f"  {note}")

    def to_json(self) -> dict[str, object]:
        """Return the table for a file."""
        return {
            "title": self.title,
            "seconds": dict(self.seconds),
            "least": self.seconds.least if isinstance(self.seconds, Times) else None,
            "goals": [
                goal.__dict__ | {"ratio": self.ratio(goal), "least_ratio": self.least_ratio(goal), "met": self.met(goal)}
                for goal in self.goals
            ],
            "notes": list(self.notes),
        }


def _ratio(seconds: Mapping[str, float], goal: Goal) -> float:
    if goal.at_least is not None:
        return seconds[goal.beside] / seconds[goal.method]
    return seconds[goal.method] / seconds[goal.beside]


def measure(methods: Mapping[str, Callable[[], object]], *, rounds: int = ROUNDS, clock: Callable[[], float] = time.perf_counter) -> Times:
    """Return the times of one call of each method, all measured in interleaved rounds.

    Methods that use one thread of this process may be measured by its own time (`clock=time.process_time`), which other programs
    on the machine spoil less.
    """
    repeats = {}
    for name, method in methods.items():
        method()  # caches, lazy imports
        start = clock()
        method()
        repeats[name] = max(1, round(ROUND_SECONDS / max(clock() - start, 1e-9)))
    times: dict[str, list[float]] = {name: [] for name in methods}
    gc.disable()
    try:
        for _ in range(rounds):
            for name, method in methods.items():
                start = clock()
                for _ in range(repeats[name]):
                    method()
                times[name].append((clock() - start) / repeats[name])
            gc.collect()
    finally:
        gc.enable()
    return Times(times)


def report(tables: list[Table], out: str | None = None) -> int:
    """Print tables and the machine, write JSON if asked for, and return how many goals were missed."""
    print(machine())
    for table in tables:
        table.print()
    missed = sum(not table.met(goal) for table in tables for goal in table.goals)
    asked = sum(len(table.goals) for table in tables)
    if asked:
        print(f"\n{asked - missed} of {asked} goals met")
    if out is not None:
        Path(out).write_text(json.dumps({"machine": machine(), "tables": [table.to_json() for table in tables]}, indent=1))
    return missed


def machine() -> str:
    """Return what the measurement ran on: processor, Python and the relevant packages."""
    packages = []
    for name in ("numpy", "pin", "mujoco", "numba", "yourdfpy", "python-fcl", "manifold3d", "trimesh", "embreex"):
        try:
            packages.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            packages.append(f"{name} absent")
    return f"{platform.machine()} {platform.system()}, Python {sys.version.split()[0]}, {', '.join(packages)}"


def _shown(seconds: float) -> str:
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def processor_seconds(root: int) -> float:
    """Return the processor time of a process, of what it started and waited for, and of its living descendants [s]."""
    times, parent = {}, {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
        except OSError:  # it has ended
            continue
        parent[int(folder.name)] = int(fields[1])
        times[int(folder.name)] = sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    total, around = 0.0, [root]
    while around:
        each = around.pop()
        total += times.get(each, 0.0)
        around += [child for child, of in parent.items() if of == each]
    return total
