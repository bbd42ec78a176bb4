"""Files made to exhaust their reader: each command ends within 10 s of processor time and 1 GB, with an answer or an error of its own."""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from tests.hostile_files import ENTRIES
from tests.leftovers import descendants

MOST_S, MOST_MB = 10.0, 1000.0
WAIT_S = 400.0  # of wall time, on a busy machine

pytestmark = [pytest.mark.skipif(sys.platform != "linux", reason="memory of a process is read as on Linux"), pytest.mark.soak]


def test_there_are_a_hundred() -> None:
    assert len(ENTRIES) >= 101


@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
@pytest.mark.parametrize("name", ENTRIES)
def test_a_hostile_file_is_answered_in_bounded_time_and_memory(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "stranger"
    folder.mkdir()
    words = ENTRIES[name](folder).split()
    code, seconds, megabytes = measured(words, folder)
    said = (folder / "said").read_text(errors="replace")
    assert code in {0, 1, 2, 3, 4}, said[-2000:]
    assert "Traceback" not in said
    assert "defect" not in said
    assert seconds <= MOST_S
    assert megabytes <= MOST_MB


def measured(words: list[str], folder: Path) -> tuple[int, float, float]:
    """Run a command in a fork; return its exit code, and processor seconds and the largest memory [MB] of it and all that it started."""
    pid = os.fork()
    if pid == 0:
        code = 99
        try:
            code = _run(words, folder)
        finally:
            os._exit(code)
    until = time.monotonic() + WAIT_S
    while not (ended := os.wait4(pid, os.WNOHANG))[0]:
        if time.monotonic() > until:
            os.kill(pid, signal.SIGKILL)
        time.sleep(0.02)
    _, status, usage = ended
    return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def _run(words: list[str], folder: Path) -> int:
    os.chdir(folder)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    file = os.open("said", os.O_WRONLY | os.O_CREAT, 0o600)
    os.dup2(file, 1)
    os.dup2(file, 2)
    sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
    from articad.cli import main

    try:
        code = main(words)
    except SystemExit as left:
        code = int(left.code or 0)
    sys.stdout.flush()
    for child in descendants(os.getpid()):  # servers of a kernel: their time counts, too
        with suppress(OSError):
            os.kill(child, signal.SIGKILL)
    with suppress(ChildProcessError):
        while True:
            os.wait()
    resource.getrusage(resource.RUSAGE_CHILDREN)
    return code
