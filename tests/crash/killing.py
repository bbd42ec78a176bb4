"""Kill a work at a point, take it up again, hold what comes of it against an undisturbed one.

The work runs in a fork of this process, which has everything imported and one thread, so that a point costs what the work
costs. A point is either a time, or a number of calls that change the file system; the child then kills itself just before.
"""

from __future__ import annotations

import contextlib
import io
import os
import random
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Work = Callable[[Path], object]
_CHANGING = ("replace", "rename", "fsync", "mkdir", "unlink", "rmdir", "chmod")
PATIENCE_S = 120.0  # of a work that is not killed


@dataclass(frozen=True)
class Point:
    """Where a work is killed: after so many seconds, or at so many calls that change the file system."""

    seconds: float | None = None
    calls: int | None = None

    def __str__(self) -> str:
        return f"{self.seconds:.3f} s" if self.seconds is not None else f"call {self.calls}"


def child(work: Work, folder: Path, point: Point | None = None, tally: Path | None = None) -> int:
    """Run a work in a fork and return how it ended: 0, its exit code, or minus the signal that ended it."""
    pid = os.fork()
    if pid == 0:
        status = 1
        try:
            os.setsid()
            if point is not None and point.calls is not None:
                _watch(point.calls, None)
            if tally is not None:
                _watch(None, tally)
            with contextlib.redirect_stdout(io.StringIO()):
                work(folder)
            status = 0
        except BaseException:  # noqa: BLE001 - nothing may return into the parent's loop
            traceback.print_exc()
            sys.stderr.flush()
        finally:
            os._exit(status)
    if point is not None and point.seconds is not None:
        time.sleep(point.seconds)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(pid, signal.SIGKILL)
            os.kill(pid, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def _watch(last: int | None, tally: Path | None) -> None:
    """Count the calls that change the file system; kill this process before the last."""
    seen = 0

    def counted(original: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> Any:
            nonlocal seen
            seen += 1
            if tally is not None:
                tally.write_text(str(seen))
            if seen == last:
                os.kill(os.getpid(), signal.SIGKILL)
            return original(*arguments, **named)

        return call

    for name in _CHANGING:
        setattr(os, name, counted(getattr(os, name)))


def undisturbed(work: Work, folder: Path, begun: Path | None = None) -> tuple[float, int]:
    """Run a work to its end; return how long it took [s] and how many calls changed the file system.

    Args:
        work: The work.
        folder: Where it works; what is there is removed.
        begun: What it works on, which is copied there; nothing by default.
    """
    _fresh(folder, begun)
    began = time.monotonic()
    assert child(work, folder) == 0
    took = time.monotonic() - began
    with tempfile.TemporaryDirectory(dir=folder.parent) as other:
        tally = Path(other) / "tally"
        counted = Path(other) / "work"
        _fresh(counted, begun)
        assert child(work, counted, tally=tally) == 0
        return took, int(tally.read_text())


def points(count: int, took: float, calls: int, seed: int) -> list[Point]:
    """Return random points, half of them times and half of them calls."""
    chance = random.Random(seed)
    return [Point(seconds=chance.uniform(0, took)) if n % 2 else Point(calls=chance.randint(1, calls)) for n in range(count)]


def timed(count: int, took: float, seed: int) -> list[Point]:
    """Return random times: for work that other processes do."""
    chance = random.Random(seed)
    return [Point(seconds=chance.uniform(0, took)) for _ in range(count)]


def stages(calls: int) -> list[Point]:
    """Return every call once."""
    return [Point(calls=number) for number in range(1, calls + 1)]


def resumed(work: Work, point: Point, root: Path, check: Callable[[Path], None], begun: Path | None = None) -> bool:
    """Kill a work at a point, run it again, hold the result; return whether it was killed at all."""
    folder = root / "work"
    _fresh(folder, begun)
    killed = child(work, folder, point) == -signal.SIGKILL
    assert child(work, folder) == 0, f"killed at {point}, it does not resume"
    check(folder)
    return killed


def harried(work: Work, points: Sequence[Point], root: Path, check: Callable[[Path], None]) -> tuple[int, int]:
    """Kill a work at each point in turn, each time after it was taken up; begin again whenever it ends, and hold its result.

    Returns:
        How often it was killed, and how many results were wrong or did not come.
    """
    folder = root / "work"
    killed = failed = since = 0
    for number, point in enumerate([*points, None], start=1):
        if not since:
            _fresh(folder, None)
        since += 1
        code = child(work, folder, point)
        if code == -signal.SIGKILL and point is not None:
            killed += 1
        else:
            try:
                assert code == 0, "it does not resume"
                check(folder)
            except AssertionError as error:
                failed += 1
                sys.stderr.write(f"after {since} starts, up to point {number}, {point}: {error}\n")
            since = 0
        if number % 50 == 0:
            sys.stderr.write(f"{number} points, {killed} kills, {failed} failed\n")
    return killed, failed


def _fresh(folder: Path, begun: Path | None) -> None:
    """Make a folder anew: a copy of what was begun, or empty."""
    shutil.rmtree(folder, ignore_errors=True)
    if begun is None:
        folder.mkdir(parents=True)
    else:
        shutil.copytree(begun, folder)


def killed_writers(store: Any, folder: Path, *, writers: int, seconds: float, seed: int) -> set[tuple[int, int]]:
    """Let several processes write to one store, kill each at a time of its own; return what they said was committed."""
    chance = random.Random(seed)
    from tests.crash.works import write_for_ever

    running = []
    for writer in range(writers):
        reading, writing = os.pipe()
        pid = os.fork()
        if pid == 0:
            try:
                os.close(reading)
                write_for_ever(store, folder, writer, writing)
            finally:
                os._exit(1)
        os.close(writing)
        running.append((writer, pid, reading))
    committed: set[tuple[int, int]] = set()
    for writer, pid, reading in running:
        time.sleep(chance.uniform(seconds / 4, seconds))
        os.kill(pid, signal.SIGKILL)
        assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == -signal.SIGKILL, f"writer {writer} ended by itself"
        with os.fdopen(reading, "rb") as said:
            committed |= {(writer, int(line)) for line in said.read().split(b"\n")[:-1]}
    return committed
