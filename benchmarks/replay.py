"""What articad itself costs in a run: the share of a replay's wall time in which no kernel process is at work.

    python benchmarks/replay.py [RECORDING]

By default the recorded metronome, 16 parts, is made again with an empty cache. The goal is at most 25 %: a run's time belongs
to its models and its kernel. Exit code 1 if it is missed.
"""

from __future__ import annotations

import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from articad.agents.pipeline import replay
from articad.agents.settings import Services
from articad.examples import folder
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache
from articad.runs.run import Run

GOAL = 0.25


class Watched:
    """A kernel that notes when any of its processes is at work."""

    def __init__(self, kernel: Any) -> None:
        self._kernel, self._guard = kernel, threading.Lock()
        self._running, self._since, self.seconds, self.tasks = 0, 0.0, 0.0, 0

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._kernel, name)
        return self._timed(value) if name in {"build", "moved", "warm_up"} else value

    def _timed(self, method: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*arguments: Any, **options: Any) -> Any:
            with self._guard:
                self._since = self._since if self._running else time.perf_counter()
                self._running += 1
                self.tasks += 1
            try:
                return method(*arguments, **options)
            finally:
                with self._guard:
                    self._running -= 1
                    self.seconds += 0.0 if self._running else time.perf_counter() - self._since

        return timed


def main() -> int:
    """Replay and print; return the exit code."""
    recording = Path(sys.argv[1]) if len(sys.argv) > 1 else folder("metronome") / "recording"
    kernel: Any = Watched(kernel_named(str(Run.view(recording).request.options.get("kernel", "build123d"))))
    with tempfile.TemporaryDirectory() as scratch:
        began = time.perf_counter()
        replayed = replay(recording, out=Path(scratch) / "run", services=Services(kernel=kernel, cache=BuildCache(None)))
        whole = time.perf_counter() - began
        parts = len(replayed.run.part_names())
    share = (whole - kernel.seconds) / whole
    print(f"{recording}: {parts} parts, {kernel.tasks} kernel tasks on {os.cpu_count()} processors")
    print(f"whole {whole:.1f} s, kernel at work {kernel.seconds:.1f} s, outside {whole - kernel.seconds:.1f} s")
    print(f"share outside kernel processes {share:.1%} (goal: at most {GOAL:.0%})")
    return int(share > GOAL)


if __name__ == "__main__":
    sys.exit(main())
