"""Commands that are ended by a signal: no process is left after five seconds, and no folder after the next start."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import traceback
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Final, NamedTuple

import pytest

from articad.commands.command import COMMANDS
from tests.agents import hostile_endpoint as ways
from tests.agents.hostile_endpoint import hostile
from tests.leftovers import descendants, gone, started_with

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="processes are looked up in Linux's /proc")]

HEEDED = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"  # a shell's background jobs ignore it
ARTICAD = [sys.executable, "-P", "-c", f"{HEEDED}; import sys; from articad.cli import main; sys.exit(main())"]
RECORDED = Path(__file__).parent / "recordings" / "toy"
ENDLESS = "def build(part):\n    while True:\n        pass\n"
HANGS = "#!/bin/sh\nsleep 600 &\nsleep 600\n"
START_S = 200.0  # for a command to be in the middle of its work, on a busy machine
ALONE_S = 1.5  # of a command that starts no process, to be in the middle of its work on an idle machine
AT_ONCE = 4  # commands: most of the time each of them waits for something
SIGNALS: Final = (signal.SIGTERM, signal.SIGKILL, signal.SIGINT, signal.SIGHUP)


class Line(NamedTuple):
    """A command line, and whether it starts processes, which hang."""

    words: str
    alone: bool = False
    endless: bool = False


LINES: Final = (
    Line("part endless tray", endless=True),
    Line("build endless --out made --no-pictures", endless=True),
    Line("bom endless --out made", endless=True),
    Line("batch batch.json --out made --jobs 1", endless=True),
    Line("watch endless --no-browser", endless=True),
    Line("mcp --root .", endless=True),
    Line("generate box --model x --api-base ADDRESS --out made --no-pictures", endless=True),
    Line("resume live --api-base ADDRESS", endless=True),
    Line("install freecad", endless=True),
    Line("audit run/export/urdf/product.urdf"),
    Line("sim run/export/mjcf/product.xml"),
    Line("convert run/export/step/product.step made.urdf"),
    Line("adopt run/export/mjcf/product.xml --out made --no-audit"),
    Line("pull run run/export/freecad/product.FCStd --out made"),
    Line("edit run --set width=50 --out made --no-pictures"),
    Line("replay RECORDED --out made"),
    Line("doctor"),
    Line("bench score nothing --task arch_stone_seven", alone=True),
    Line("export run --to step,usd,urdf", alone=True),
    Line("certify run --budget 600", alone=True),
    Line("check run", alone=True),
    Line("order run", alone=True),
    Line("manual run --out made", alone=True),
    Line("drawing run --out made", alone=True),
    Line("render run --out made", alone=True),
    Line("show run --no-browser --out made.html", alone=True),
)
BRIEF: Final = {"new", "verify-certificate", "memory", "completion", "skill"}
"""Commands that start no process and end within a second."""


def test_each_command_has_a_line() -> None:
    assert {line.words.split()[0] for line in LINES} | BRIEF == set(COMMANDS)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a product, one whose scripts never end, a batch of it, and a run with exports."""
    folder = tmp_path_factory.mktemp("made")
    for name in ("product", "endless"):
        subprocess.run([*ARTICAD, "new", name], cwd=folder, check=True, capture_output=True, timeout=400)
    for path in (folder / "endless" / "parts").glob("*.py"):
        path.write_text(ENDLESS)
    (folder / "batch.json").write_text(json.dumps({"items": [{"plan": "endless", "formats": ["urdf"]}]}))
    words = ["build", "product", "--out", "run", "--no-pictures", "--export", "urdf,mjcf,step,freecad"]
    subprocess.run([*ARTICAD, *words], cwd=folder, check=True, capture_output=True, timeout=400)
    return folder


def ended_by(number: signal.Signals, words: list[str], folder: Path, is_busy: Callable[[int], bool], say: bytes = b"") -> None:
    """Start a command, wait until it is busy, end it, and look at what is left."""
    temporary = folder / "temporary"
    temporary.mkdir()
    (folder / "bin").mkdir()
    (folder / "bin" / "freecadcmd").write_text(HANGS)  # what the installer asks for its version
    (folder / "bin" / "freecadcmd").chmod(0o755)
    environment = os.environ | {"TMPDIR": str(temporary), "ARTICAD_CACHE": str(folder / "cache"), "XDG_DATA_HOME": str(folder / "data")}
    if words[0] == "install":
        environment["PATH"] = f"{folder / 'bin'}:{environment['PATH']}"

    def leftovers() -> list[int]:
        return started_with(str(temporary))  # a process of ours has it in its environment, whoever started it

    with subprocess.Popen(
        [*ARTICAD, *words],
        cwd=folder,
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        try:
            assert process.stdin is not None
            process.stdin.write(say)
            process.stdin.flush()
            until = time.monotonic() + START_S
            while not is_busy(process.pid):
                assert process.poll() is None, "it ended by itself"
                assert time.monotonic() < until, "it never became busy"
                time.sleep(0.02)
            children = descendants(process.pid)
            process.send_signal(number)
            assert gone([process.pid, *children], more=leftovers), leftovers()
        finally:
            process.kill()
    subprocess.run(
        [sys.executable, "-c", "from articad.processes import scratch; scratch.folder('x')"], env=environment, check=True, timeout=100
    )
    assert list(temporary.iterdir()) == []


def said_to(words: list[str]) -> bytes:
    """Return what a client says to the server of tools so that it builds a part that never ends; nothing to other commands."""
    if words[0] != "mcp":
        return b""
    client = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "x", "version": "1"}}
    call = {"name": "build_part", "arguments": {"design": "endless", "part": "tray"}}
    messages = (
        {"id": 1, "method": "initialize", "params": client},
        {"method": "notifications/initialized"},
        {"id": 2, "method": "tools/call", "params": call},
    )
    return b"".join(json.dumps({"jsonrpc": "2.0"} | message).encode() + b"\n" for message in messages)


def end(line: Line, number: signal.Signals, made: Path, folder: Path) -> None:
    place = folder / "made"
    shutil.copytree(made, place)
    with hostile(ways.hang) as endpoint:
        words = line.words.replace("ADDRESS", endpoint.address).replace("RECORDED", str(RECORDED)).split()
        if words[0] == "resume":
            begun = ["generate", "box", "--model", "x", "--api-base", "http://127.0.0.1:9/v1", "--out", "live", "--no-pictures"]
            subprocess.run([*ARTICAD, *begun], cwd=place, check=False, capture_output=True, timeout=400)
        began = time.monotonic()

        def is_busy(pid: int) -> bool:
            if words[0] in {"generate", "resume"}:
                return endpoint.requests > 0
            return bool(descendants(pid)) or (line.alone and time.monotonic() - began > ALONE_S)

        ended_by(number, words, place, is_busy, said_to(words))


def test_a_command_that_is_ended_leaves_nothing(made: Path, tmp_path: Path) -> None:
    """Each command by one signal, in turn; several at once."""

    def problem(turn: int) -> str:
        folder = tmp_path / str(turn)
        folder.mkdir()
        line, number = LINES[turn], SIGNALS[turn % len(SIGNALS)]
        try:
            end(line, number, made, folder)
        except Exception:  # noqa: BLE001 - all are told at the end
            return f"{line.words}, {number.name}:\n{traceback.format_exc()}"
        return ""

    with ThreadPoolExecutor(AT_ONCE) as pool:
        problems = [problem for problem in pool.map(problem, range(len(LINES))) if problem]
    assert not problems, "\n".join(problems)


@pytest.mark.crash
@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize("line", LINES, ids=[line.words.split()[0] for line in LINES])
def test_every_command_by_every_signal(number: signal.Signals, line: Line, made: Path, tmp_path: Path) -> None:
    end(line, number, made, tmp_path)
