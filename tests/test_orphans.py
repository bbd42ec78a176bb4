"""Commands that are ended by a signal: no process is left after five seconds, and no folder after the next start."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

from tests.agents import hostile_endpoint as ways
from tests.agents.hostile_endpoint import hostile
from tests.test_processes import _heeds_interrupts, gone

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="processes are looked up in Linux's /proc")]

ARTICAD = [sys.executable, "-P", "-c", "import sys; from articad.cli import main; sys.exit(main())"]
STARTER = Path(__file__).resolve().parents[1] / "articad" / "starter"
ENDLESS = "def build(part):\n    while True:\n        pass\n"
START_S = 120.0  # for a command to be in the middle of its work, on a busy machine


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


def product(folder: Path, script: str | None = None) -> Path:
    """Write the starter's plan, with scripts that never end if none is given to each part."""
    place = folder / "product"
    shutil.copytree(STARTER, place)
    for path in (place / "parts").glob("*.py"):
        if script is not None:
            path.write_text(script)
    return place


def built(folder: Path) -> None:
    product(folder)
    words = ["build", "product", "--out", "run", "--no-pictures"]
    subprocess.run([*ARTICAD, *words], cwd=folder, check=True, capture_output=True, timeout=400)


def ended_by(number: signal.Signals, words: list[str], folder: Path, is_busy: Callable[[list[int]], bool], **more: str) -> None:
    """Start a command, wait until it is busy, end it, and look at what is left."""
    temporary = folder / "temporary"
    temporary.mkdir()
    environment = os.environ | {"TMPDIR": str(temporary), "ARTICAD_CACHE": str(folder / "cache")} | more
    process = subprocess.Popen(
        [*ARTICAD, *words],
        cwd=folder,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        preexec_fn=_heeds_interrupts,  # noqa: PLW1509 - this process starts no thread before
    )
    with process:
        until = time.monotonic() + START_S
        while not is_busy(children := descendants(process.pid)):
            assert process.poll() is None, "it ended by itself"
            assert time.monotonic() < until, "it never became busy"
            time.sleep(0.05)
        process.send_signal(number)
        process.wait(30)
    assert gone(children)
    subprocess.run(
        [sys.executable, "-c", "from articad.processes import scratch; scratch.folder('x')"], env=environment, check=True, timeout=100
    )
    assert list(temporary.iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL, signal.SIGINT])
def test_generate_with_an_endpoint_that_hangs(number: signal.Signals, tmp_path: Path) -> None:
    with hostile(ways.hang) as endpoint:
        words = ["generate", "a box with a lid", "--model", "x", "--api-base", endpoint.address, "--out", "run", "--no-pictures"]
        ended_by(number, words, tmp_path, lambda children: endpoint.requests > 0 and len(children) > 1)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL, signal.SIGINT])
def test_batch_with_scripts_that_never_end(number: signal.Signals, tmp_path: Path) -> None:
    product(tmp_path, ENDLESS)
    (tmp_path / "batch.json").write_text(json.dumps({"items": [{"plan": "product", "formats": ["urdf"]}]}))
    ended_by(number, ["batch", "batch.json", "--out", "made", "--jobs", "1"], tmp_path, lambda children: len(children) > 2)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize(
    "words", [["certify", "run", "--budget", "600"], ["export", "run", "--to", "step,freecad"]], ids=["certify", "export"]
)
def test_work_on_a_run(words: list[str], number: signal.Signals, tmp_path: Path) -> None:
    built(tmp_path)
    began = time.monotonic()
    ended_by(number, words, tmp_path, lambda children: bool(children) or time.monotonic() - began > 1.5)
