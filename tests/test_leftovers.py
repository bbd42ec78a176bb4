"""The watch for processes that should have ended: it is not fooled by one that stays, nor by a busy machine."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from tests.leftovers import gone, started_with

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are looked up in Linux's /proc")

SPINS = "while True: pass"
STARVED = """
import os, time
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
print(flush=True)
until = time.process_time() + 0.03
while time.process_time() < until: pass
os._exit(0)
"""


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


def test_a_process_that_waits_for_a_processor_is_given_time() -> None:
    with process(f"import os\nos.sched_setaffinity(0, {{min(os.sched_getaffinity(0))}})\n{SPINS}"), process(STARVED) as one:
        assert one.stdout is not None
        assert one.stdout.readline()
        began = time.monotonic()
        assert gone([one.pid], 1.0)
        assert time.monotonic() - began > 1.0, "it was not starved, and nothing is shown"


def test_a_process_is_found_by_its_environment_when_its_parent_is_gone() -> None:
    mark = f"mark-{os.getpid()}-{time.monotonic_ns()}"
    code = "import os, time\nif os.fork(): os._exit(0)\ntime.sleep(600)"
    started = subprocess.Popen([sys.executable, "-I", "-c", code], env=os.environ | {"MARK": mark}, start_new_session=True)
    started.wait()
    orphans = started_with(mark)
    assert len(orphans) == 1
    os.kill(orphans[0], 9)
    assert gone(orphans)
