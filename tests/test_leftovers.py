"""The watch for processes that should have ended: it is not fooled by one that stays, nor by a busy machine."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from tests import leftovers
from tests.leftovers import gone, started_with

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are looked up in Linux's /proc")

SPINS = "while True: pass"


@contextmanager
def process(code: str) -> Iterator[subprocess.Popen[bytes]]:
    with subprocess.Popen([sys.executable, "-I", "-c", code], stdout=subprocess.PIPE) as started:
        try:
            yield started
        finally:
            started.kill()


@pytest.mark.parametrize("code", ["import time\ntime.sleep(600)", SPINS, "import os, time\nos.fork()\ntime.sleep(600)"])
def test_a_process_that_stays_is_seen(code: str) -> None:
    with process(code) as one:
        assert not gone([one.pid], 0.5)


class Machine:
    """A machine with a clock of its own and one process of one thread, which ends after a given time on the processor."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, needs: float, runs: Callable[[float], bool], ready: bool) -> None:
        self.now = self.ran = 0.0
        self._needs, self._runs, self._ready = needs, runs, ready
        monkeypatch.setattr(leftovers, "time", self)
        monkeypatch.setattr(leftovers, "alive", lambda _: self.ran < self._needs)
        monkeypatch.setattr(leftovers, "_threads", lambda _: [("1", (self._ready, self.ran))])

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.ran += seconds if self._runs(self.now) else 0.0
        self.now += seconds


@pytest.mark.parametrize(
    ("needs", "runs", "ready", "ends", "lasts"),
    [
        (0.03, lambda now: now > 30, True, True, (30, 31)),  # another process has the processor for 30 s
        (3.0, lambda now: int(now / 0.05) % 10 == 0, True, True, (28, 31)),  # ten processes share it: 3 s of 5 s are enough
        (9.0, lambda now: int(now / 0.05) % 10 == 0, True, False, (48, 53)),  # the same, but it had 5 s and has not ended
        (0.03, lambda _: False, False, False, (5, 5.2)),  # it sleeps
        (600.0, lambda _: True, True, False, (5, 5.2)),  # it runs
        (0.03, lambda _: False, True, False, (leftovers.MOST_S, leftovers.MOST_S + 1)),  # it never gets a processor
    ],
)
def test_only_time_in_which_a_process_could_run_counts(
    needs: float, runs: Callable[[float], bool], ready: bool, ends: bool, lasts: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = Machine(monkeypatch, needs, runs, ready)
    assert gone([1], 5.0) == ends
    assert lasts[0] <= machine.now <= lasts[1]


def test_a_thread_is_ready_while_it_runs_and_its_time_is_what_it_used() -> None:
    own = f"/proc/{os.getpid()}/task/{threading.get_native_id()}"
    before, began = dict(leftovers._threads(os.getpid()))[own], time.thread_time()
    while time.thread_time() - began < 0.1:
        pass
    after, used = dict(leftovers._threads(os.getpid()))[own], time.thread_time() - began
    assert before[0]
    assert after[0]
    assert 0.09 < after[1] - before[1] < used + 0.05


def test_a_thread_that_is_stopped_is_not_ready() -> None:
    with process(SPINS) as one:
        os.kill(one.pid, signal.SIGSTOP)
        os.waitpid(one.pid, os.WUNTRACED)  # until it is stopped
        assert [ready for _, (ready, _) in leftovers._threads(one.pid)] == [False]


def test_a_process_is_found_by_its_environment_when_its_parent_is_gone() -> None:
    mark = f"mark-{os.getpid()}-{time.monotonic_ns()}"
    code = "import os, time\nif os.fork(): os._exit(0)\ntime.sleep(600)"
    started = subprocess.Popen([sys.executable, "-I", "-c", code], env=os.environ | {"MARK": mark}, start_new_session=True)
    started.wait()
    orphans = started_with(mark)
    assert len(orphans) == 1
    os.kill(orphans[0], 9)
    assert gone(orphans)
