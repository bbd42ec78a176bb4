"""Processes that should have ended: which there are, and how long they had the chance to end.

A process that waits for a processor cannot end. The time in which a thread is ready to run (state R) and does not run (the first number
of its schedstat [ns] stands still) does not count here. So five seconds are five seconds on an idle machine, and a busy one changes no
verdict.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import suppress
from pathlib import Path

MOST_S = 300.0  # of wall time, whatever the load
_ROUND_S = 0.05


def alive(pid: int) -> bool:
    """Return whether a process runs; one that is only not yet waited for does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def descendants(pid: int) -> list[int]:
    """Return the processes below one, however deep."""
    parents: dict[int, list[int]] = {}
    for folder in Path("/proc").iterdir():
        with suppress(OSError, ValueError):
            if folder.name.isdigit():
                parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
                parents.setdefault(parent, []).append(int(folder.name))
    found, waiting = [], [pid]
    while waiting:
        below = parents.get(waiting.pop(), [])
        found += below
        waiting += below
    return found


def started_with(text: str) -> list[int]:
    """Return the processes with a text in their environment or their words, whoever their parent is now; not this one."""
    found = []
    for folder in Path("/proc").iterdir():
        with suppress(OSError):
            if folder.name.isdigit() and int(folder.name) != os.getpid():
                told = (folder / "environ").read_bytes() + (folder / "cmdline").read_bytes()
                found += [int(folder.name)] * (text.encode() in told)
    return found


def gone(pids: Collection[int], seconds: float = 5.0, more: Callable[[], Collection[int]] = list) -> bool:
    """Return whether processes end within a time in which none of them waits for a processor.

    Args:
        pids: The processes.
        seconds: The time.
        more: Returns further processes that have to end, if there are any.
    """
    began = last = time.monotonic()
    chances, ran = 0.0, dict[str, float]()
    while left := [pid for pid in {*pids, *more()} if alive(pid)]:
        now = time.monotonic()
        seen = {thread: counts for pid in left for thread, counts in _threads(pid)}
        hindered = sum(max(0.0, now - last - (run - ran[thread])) for thread, (ready, run) in seen.items() if ready and thread in ran)
        # this process may have waited itself: a round counts as two at most
        chances += max(0.0, min(now - last, 2 * _ROUND_S) - hindered)
        last, ran = now, {thread: run for thread, (_, run) in seen.items()}
        if chances > seconds or now - began > MOST_S:
            return False
        time.sleep(_ROUND_S)
    return True


def _threads(pid: int) -> Iterator[tuple[str, tuple[bool, float]]]:
    """Yield each thread of a process, with whether it is ready to run and how long it has run [s]."""
    with suppress(OSError):
        for thread in Path(f"/proc/{pid}/task").iterdir():
            with suppress(OSError):
                ready = (thread / "stat").read_text().rpartition(")")[2].split()[0] == "R"
                yield str(thread), (ready, int((thread / "schedstat").read_text().split()[0]) / 1e9)
