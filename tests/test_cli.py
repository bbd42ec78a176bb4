"""The frame of the command line: flags, suggestions, exit codes, and never a traceback."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import articad
from articad import __version__, cli
from articad.commands.command import COMMANDS, Command
from articad.commands.options import FORMATS
from articad.commands.terminal import Report, Terminal
from articad.errors import PlanError
from articad.findings import Finding
from articad.formats import NAMED

FINDING = Finding(code="E_DUP_NAME", where="parts[1]", message="'lid' is used twice.", hint="Rename one.")


@pytest.fixture
def probe(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[], Report]], None]:
    """Put a command `probe` beside the real ones that does what the test says."""

    def install(body: Callable[[], Report]) -> None:
        def run(_options: argparse.Namespace, terminal: Terminal) -> Report:
            terminal.say("probing")
            return body()

        command = Command("probe", "Probe.", lambda _parser: None, run, needs_libraries=False)
        monkeypatch.setitem(COMMANDS, "probe", command)

    return install


def failing(error: BaseException) -> Callable[[], Report]:
    def body() -> Report:
        raise error

    return body


@pytest.mark.parametrize(("ok", "code"), [(True, 0), (False, 1)])
def test_the_exit_code_is_the_report_s_verdict(probe: Callable[[Callable[[], Report]], None], ok: bool, code: int) -> None:
    probe(lambda: {"schema": "articad.findings/1", "ok": ok, "findings": []})
    assert cli.main(["probe"]) == code


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (PlanError("The plan has errors.", findings=[FINDING]), 3, "Rename one."),
        (FileNotFoundError(2, "No such file or directory", "/x"), 3, "No such file or directory: /x"),
        (ZeroDivisionError("division by zero"), 3, "Run it again with -v"),
        (RecursionError("maximum recursion depth exceeded"), 3, "defect"),
        (KeyboardInterrupt(), 130, "interrupted"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, BaseException) else None,
)
def test_no_error_ends_in_a_traceback(
    probe: Callable[[Callable[[], Report]], None], capsys: pytest.CaptureFixture[str], error: BaseException, code: int, words: str
) -> None:
    probe(failing(error))
    assert cli.main(["probe"]) == code
    told = capsys.readouterr()
    assert words in told.err
    assert "Traceback" not in told.err
    assert cli.main(["probe", "--json"]) == code
    assert json.loads(capsys.readouterr().out)["ok"] is False


def test_verbose_shows_the_traceback_of_a_defect(probe: Callable[[Callable[[], Report]], None], capsys: pytest.CaptureFixture[str]) -> None:
    probe(failing(ZeroDivisionError("division by zero")))
    assert cli.main(["-v", "probe"]) == 3
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["--json", "probe"], ["probe", "--json"]])
def test_global_flags_stand_before_or_after_the_command(
    probe: Callable[[Callable[[], Report]], None], capsys: pytest.CaptureFixture[str], arguments: list[str]
) -> None:
    probe(lambda: {"schema": "articad.findings/1", "ok": True, "findings": []})
    assert cli.main(arguments) == 0
    assert json.loads(capsys.readouterr().out) == {"schema": "articad.findings/1", "ok": True, "findings": []}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["biuld", "x"], "did you mean 'build'?"),
        (["build", "x", "--exprot", "urdf"], "did you mean '--export'?"),
        (["build", "x", "--export", "urfd"], "did you mean 'urdf'?"),
        (["build", "x", "--kernel", "bild123d"], "did you mean 'build123d'?"),
        (["build", "x", "--set", "width"], "not of the form NAME=VALUE"),
        (["build", "x", "--set", "width=wide"], "'wide' in 'width=wide' is not a number"),
        (["build", "x", "--jobs", "0"], "at least 1"),
        (["build"], "PLAN_DIR"),
        (["--jsno"], "unknown argument '--jsno', did you mean '--json'?"),
        ([], "COMMAND"),
    ],
)
def test_wrong_usage_ends_with_2_and_says_what_was_meant(capsys: pytest.CaptureFixture[str], arguments: list[str], words: str) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(arguments)
    assert ended.value.code == 2
    assert words in capsys.readouterr().err


def test_the_formats_are_those_that_can_be_written() -> None:
    assert tuple(NAMED) == FORMATS


def test_the_version_is_the_package_s(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"articad {__version__}\n"


@pytest.mark.parametrize("command", ["build", "check"])
def test_a_plan_that_is_not_there_is_an_error_not_a_defect(capsys: pytest.CaptureFixture[str], tmp_path: Path, command: str) -> None:
    assert cli.main([command, str(tmp_path / "nowhere")]) == 3
    assert "defect" not in capsys.readouterr().err


def test_output_whose_reader_went_away_is_no_defect() -> None:
    command = [sys.executable, "-m", "articad.cli", "check", "/nowhere", "--json"]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert running.stdout is not None
    assert running.stderr is not None
    running.stdout.close()
    told = running.stderr.read()
    running.stderr.close()
    assert running.wait(timeout=60) == 3
    assert told == ""


def test_the_command_line_keeps_blas_to_one_thread() -> None:
    code = (
        "from articad.cli import main; main(['check', '/nowhere', '--json']); import os; print(os.environ['OPENBLAS_NUM_THREADS'], end='')"
    )
    kept = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    for environment, threads in ((kept, "1"), (kept | {"OPENBLAS_NUM_THREADS": "3"}, "3")):
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        assert done.stdout.endswith(threads)


STREAMS = ("<&-", ">&-", "2>&-", "<&- >&- 2>&-", ">/dev/full", "2>/dev/full", ">/dev/full 2>/dev/full")


@pytest.mark.skipif(os.name == "nt", reason="a shell of POSIX")
@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
@pytest.mark.parametrize("streams", STREAMS)
def test_a_command_works_whichever_of_its_streams_are_closed_or_full(streams: str, as_json: bool, tmp_path: Path) -> None:
    """Nothing is printed into what it writes, which gets the number of a closed stream; a full disk of the output is an error in words."""
    program = f"{sys.executable} -P -m articad.cli new box{' --json' if as_json else ''} {streams}"
    done = subprocess.run(["sh", "-c", program], check=False, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert "Traceback" not in done.stderr + done.stdout
    is_full = ">/dev/full" in streams.replace("2>/dev/full", "")
    assert done.returncode == (3 if is_full else 0)
    assert ("No space left on device" in done.stderr) is (is_full and "2>" not in streams)
    starter = Path(articad.__file__).parent / "starter"
    script = (tmp_path / "box" / "parts" / "lid.py").read_bytes()
    assert script == (starter / "parts" / "lid.py").read_bytes()


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "utf-8"])
@pytest.mark.parametrize("as_json", [False, True], ids=["words", "json"])
def test_what_an_output_cannot_encode_is_spelled(encoding: str, as_json: bool, tmp_path: Path) -> None:
    """A name of an output's own encoding, of no encoding, and of two UTF-16 units; as JSON it reads back as it was."""
    program = "import sys; from articad import cli; sys.exit(cli.main())"
    words = ["skill", "install", "--dir", "\u00e4\u2192\U0001f600", *(["--json"] if as_json else [])]
    environment = os.environ | {"PYTHONIOENCODING": f"{encoding}:strict"}
    done = subprocess.run(
        [sys.executable, "-P", "-c", program, *words], check=False, cwd=tmp_path, env=environment, capture_output=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (0, b"")
    said = done.stdout.decode(encoding)
    if as_json:
        assert json.loads(said)["file"] == "\u00e4\u2192\U0001f600/SKILL.md"
    else:
        assert ("\\u2192\\ud83d\\ude00" in said) is (encoding != "utf-8")


@pytest.mark.parametrize("command", [["doctor"], ["new", "a_box"]])
def test_a_current_folder_that_was_removed_is_named(command: list[str], tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    script = "import os, sys; from articad import cli; os.chdir(sys.argv[1]); os.rmdir(sys.argv[1]); sys.exit(cli.main(sys.argv[2:]))"

    done = subprocess.run([sys.executable, "-c", script, str(gone), *command], capture_output=True, text=True, check=False, timeout=120)

    assert done.returncode == cli.CANNOT_GO_ON
    assert "the current folder was removed. Change to another one." in done.stderr


@pytest.mark.parametrize("where", ["articad.cli._parsed", "articad.commands.terminal.Terminal", "articad.cli._run"])
def test_an_interrupt_before_the_command_begins_is_no_traceback(where: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(where, interrupted)
    assert cli.main(["doctor", "-q"]) == cli.INTERRUPTED
