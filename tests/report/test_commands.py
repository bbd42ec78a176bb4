"""show, new, watch and completion do what they say."""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from articad import cli, examples
from articad.assembly import Assembly
from articad.commands import watching
from articad.commands.checked import Check
from articad.commands.command import COMMANDS
from articad.commands.terminal import Terminal
from articad.commands.watching import PageServer, fingerprint, watch
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan
from articad.runs.record import record_assembly, record_checks, record_page
from articad.runs.run import Run, RunRequest

URDF = """<robot name="arm"><link name="base"><visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>
<link name="hand"><visual><geometry><box size="0.2 0.03 0.03"/></geometry></visual></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="hand"/><origin xyz="0 0 0.08"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
MJCF = """<mujoco model="arm"><worldbody><body name="base"><geom type="box" size="0.05 0.05 0.05"/><body name="hand" pos="0 0 0.08">
<joint name="turn" type="hinge" axis="0 0 1" range="-60 60" limited="true"/><geom type="box" size="0.1 0.01 0.01"/></body></body></worldbody></mujoco>"""


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Any:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ARTICAD_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="module")
def starter(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("work") / "my_box"
    assert cli.main(["new", str(folder), "-q"]) == 0
    return folder


def test_a_new_product_is_a_valid_plan_that_builds_without_findings(starter: Path) -> None:
    plan = AssemblyPlan.load(starter)
    assembly = Assembly.from_plan(plan, starter / "parts")

    assert plan.name == "my_box"
    assert len(check_plan(plan)) == 0
    assert assembly.check().ok
    assert assembly.check_motion(steps=13).ok
    assert "{name}" not in (starter / "README.md").read_text()
    assert all("#" in script.read_text() or '"""' in script.read_text() for script in (starter / "parts").iterdir())


@pytest.mark.parametrize(("given", "found"), [("lamp", "desk_lamp"), ("metronome", "metronome")])
def test_a_new_product_may_begin_as_an_example(tmp_path: Path, given: str, found: str) -> None:
    assert cli.main(["new", str(tmp_path / "mine"), "--example", given, "-q"]) == 0

    made, source = AssemblyPlan.load(tmp_path / "mine"), AssemblyPlan.load(examples.folder(found))
    assert made.name == "mine"
    assert made.parts == source.parts
    assert not list((tmp_path / "mine" / "parts").glob("*.freecad.py"))


def test_a_new_product_for_freecad_has_its_scripts(tmp_path: Path) -> None:
    assert cli.main(["new", str(tmp_path / "mine"), "--kernel", "freecad", "-q"]) == 0

    assert AssemblyPlan.load(tmp_path / "mine").kernel == "freecad"
    assert sorted(file.name for file in (tmp_path / "mine" / "parts").iterdir()) == ["lid.freecad.py", "tray.freecad.py"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["My Box"], "table_lamp"), (["taken"], "not empty"), (["mine", "--example", "lmap"], "There is no example 'lmap'")],
)
def test_what_cannot_be_begun_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken" / "file").touch()
    assert cli.main(["new", *arguments]) == 3
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(("name", "text"), [("arm.urdf", URDF), ("arm.xml", MJCF)])
def test_foreign_files_are_shown_and_drawn(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)

    assert cli.main(["show", str(tmp_path / name), "--out", str(tmp_path / "page.html"), "--no-browser", "-q"]) == 0
    assert '"name":"turn"' in (tmp_path / "page.html").read_text()
    assert cli.main(["render", str(tmp_path / name), "--views", "iso", "--size", "64", "--out", str(tmp_path / "views"), "-q"]) == 0
    assert cli.main(["render", str(tmp_path / name), "--motion", "turn", "--size", "48", "--out", str(tmp_path / "views"), "-q"]) == 0
    assert {file.name for file in (tmp_path / "views").iterdir()} == {"iso.png", "turn.png", "turn.gif"}


def test_a_clean_picture_has_its_own_size_and_no_background(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "arm.urdf").write_text(URDF)
    words = ["render", str(tmp_path / "arm.urdf"), "--views", "iso", "--size", "64x48", "--out", str(tmp_path / "views"), "-q"]

    assert cli.main([*words, "--transparent"]) == 0
    with Image.open(tmp_path / "views" / "iso.png") as picture:
        assert (picture.size, picture.mode) == ((64, 48), "RGBA")
    assert cli.main([*words, "--clean", "--motion", "turn"]) == 0
    with Image.open(tmp_path / "views" / "turn.gif") as picture:
        assert picture.size == (64, 48)
    assert cli.main(words) == 3
    assert "add --clean" in capsys.readouterr().err
    assert cli.main([*words, "--transparent", "--motion", "turn"]) == 3
    assert "An animation has a background" in capsys.readouterr().err


REPEATED = "none was checked for this page"


@pytest.mark.parametrize(("how", "is_certified"), [("rest", False), ("certified", True)])
def test_who_opens_a_run_reads_that_its_reports_are_repeated_and_how_to_check_them(
    how: str, is_certified: bool, starter: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Whoever wrote them: on the terminal and on the page, in the run or elsewhere, and not on the page that the run makes of itself."""
    run = tmp_path / how
    assert cli.main(["build", str(starter), "--out", str(run), f"--verify={how}", "-q"]) == 0
    assert REPEATED not in (run / "report.html").read_text()
    forged = json.loads((run / "checks.json").read_bytes()) | {"pairs": []}
    (run / "checks.json").write_text(json.dumps(forged))
    capsys.readouterr()
    for out in (["--out", str(tmp_path / "page.html")], []):
        assert cli.main(["show", str(run), "--no-browser", *out]) == 0
        said = capsys.readouterr().out
        assert f"articad check {run}" in said
        assert (f"articad verify-certificate {run}" in said) is is_certified
        page = Path(out[-1] if out else run / "report.html").read_text()
        assert page.index("repeated, not checked now") < page.index("clear at rest")
        assert REPEATED in re.sub(r'<span class="badge.*?</span>|<p class="unseen">.*?</p>', "", page), "it can be seen"
        assert "articad check RUN" in page
        assert ("articad verify-certificate RUN" in page) is is_certified
    assert cli.main(["check", str(run)]) == 0
    assert cli.main(["verify-certificate", str(run)]) == (0 if is_certified else 3)


def test_the_command_that_an_error_of_a_record_names_writes_it_again(
    starter: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "run"
    assert cli.main(["build", str(starter), "--out", str(run), "--verify=certified", "--export", "urdf", "-q"]) == 0
    for record in ("certificate.json", "export/urdf/losses.json"):
        (run / record).write_text('{"ok": 3}')
        capsys.readouterr()
        assert cli.main(["show", str(run), "--no-browser", "--out", str(tmp_path / "page.html")]) == 3
        said = capsys.readouterr().err
        command = re.search(r"articad ((?:certify|export) .*)", said)
        assert command, said
        if removed := re.search("Remove (.*), and export", said):
            shutil.rmtree(removed[1])
        assert cli.main([*command[1].split(), "-q"]) == 0
        assert cli.main(["show", str(run), "--no-browser", "--out", str(tmp_path / "page.html")]) == 0


def opened_page(file: Path) -> str:
    """Return the page of a run without what says that it repeats the run's reports."""
    page = re.sub(r'<span class="badge quiet" title="[^"]*">repeated, not checked now</span>', "", file.read_text())
    return re.sub(rf'<p class="quiet">[^<]*{REPEATED}[^<]*</p>|(?<=[.] )Checks, proofs[^<]*?{REPEATED}[^<]*?RUN[.] ', "", page)


def test_a_run_keeps_its_page_which_show_makes_again(starter: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = AssemblyPlan.load(starter)
    with Run.create(RunRequest(prompt="my_box", options={"task": "build"}), out=tmp_path / "run") as run:
        run.save_plan(plan.dumps(), 0)
        assembly = Assembly.from_plan(plan, starter / "parts")
        record_assembly(run, assembly)
        record_checks(run, assembly.check())
        hashes = run.hashes()
        page = record_page(run, assembly).read_bytes()
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)

    assert cli.main(["show", str(tmp_path / "run"), "-q"]) == 0
    assert opened == [(tmp_path / "run" / "report.html").as_uri()]
    assert opened_page(tmp_path / "run" / "report.html") == page.decode()
    assert Run.view(tmp_path / "run").hashes() == hashes, "a page is drawn from the rest, and no result"
    assert b'href="./parts/lid/part.step"' in page


def test_a_saved_file_is_built_and_served_and_an_error_keeps_the_old_page(starter: Path, tmp_path: Path) -> None:
    folder = tmp_path / "watched"
    shutil.copytree(starter, folder)
    plan, script = folder / "plan.json", folder / "parts" / "lid.py"
    good = plan.read_text()
    seen: list[tuple[str, str, str]] = []

    def ask(server: PageServer, path: str, host: str | None = None) -> str:
        request = urllib.request.Request(server.address + path, headers={"Host": host} if host else {})
        with urllib.request.urlopen(request, timeout=20) as answer:
            return str(answer.read().decode())

    with PageServer() as server:
        steps: Iterator[Callable[[], object]] = iter(
            [
                lambda: plan.write_text(good.replace('"value": 80', '"value": 90')),
                lambda: script.write_text("def build(part):\n    raise ValueError('not today')\n"),
                lambda: None,
            ]
        )

        def wait(_seconds: float) -> None:
            seen.append(
                (json.loads(ask(server, "version"))["version"], ask(server, ""), "\n".join(json.loads(ask(server, "version"))["error"]))
            )
            try:
                next(steps)()
            except StopIteration:
                raise KeyboardInterrupt from None

        built = watch(options_for(folder), Terminal(quiet=True), server, wait=wait)
        with pytest.raises(urllib.error.HTTPError, match="403"):
            ask(server, "", host="elsewhere.example")

    assert built == 3
    versions, pages, messages = zip(*seen, strict=True)
    assert versions[0] != versions[1] == versions[2]
    assert f'"watch":"{versions[1]}"' in pages[1]
    assert pages[2] == pages[1]
    assert messages[:2] == ("", "")
    assert "lid" in messages[2]
    assert "line 2" in messages[2]
    assert "not today" in messages[2], "file, line and cause"
    assert fingerprint(folder) != versions[1]


def options_for(folder: Path) -> argparse.Namespace:
    return argparse.Namespace(plan=str(folder), kernel=None, sandbox=None, jobs=1, force=False, parameters=[])


def test_an_edit_is_shown_before_its_checks_have_ended(starter: Path, tmp_path: Path) -> None:
    folder = tmp_path / "watched"
    shutil.copytree(starter, folder)
    seen: list[tuple[str, str, str]] = []

    with PageServer() as server:

        def wait(seconds: float) -> None:
            seen.append((server.version, server.page, server.message))
            if server.version == fingerprint(folder):
                raise KeyboardInterrupt
            time.sleep(seconds)

        watch(options_for(folder), Terminal(quiet=True), server, wait=wait)

    version, page, message = seen[0]
    assert message == "Checking …"
    assert f'"watch":"{version}"' in page
    assert "not checked yet" in page
    assert "clear at rest" not in page
    assert seen[-1][0] != version
    assert "clear at rest" in seen[-1][1]
    assert (server.message, server.error) == ("", ())


def test_an_edit_ends_the_checks_of_the_edit_before(starter: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "watched"
    shutil.copytree(starter, folder)
    plan = folder / "plan.json"
    started: list[Check] = []

    class Endless(Check):
        def __init__(self, folder: Path, options: argparse.Namespace) -> None:
            super().__init__(folder, options)
            os.kill(self._child.pid, signal.SIGSTOP)  # a check that takes long
            started.append(self)

    monkeypatch.setattr(watching, "Check", Endless)
    with PageServer() as server:

        def wait(_seconds: float) -> None:
            if len(started) == 2:
                raise KeyboardInterrupt
            plan.write_text(plan.read_text() + " ")

        watch(options_for(folder), Terminal(quiet=True), server, wait=wait)

    first, second = started
    assert first.has_ended
    assert second.has_ended
    assert first.report() is None
    assert server.version == f"{fingerprint(folder)} before checks"


def test_a_check_that_fails_is_said_on_the_page(starter: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "watched"
    shutil.copytree(starter, folder)

    class Killed(Check):
        def __init__(self, folder: Path, options: argparse.Namespace) -> None:
            super().__init__(folder, options)
            self.stop()

    monkeypatch.setattr(watching, "Check", Killed)
    with PageServer() as server:

        def wait(_seconds: float) -> None:
            if server.error:
                raise KeyboardInterrupt

        watch(options_for(folder), Terminal(quiet=True), server, wait=wait)

    assert server.error == ("The product was not checked: signal 9",)
    assert "not checked yet" in server.page


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_knows_every_command_and_its_flags(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["completion", shell]) == 0
    script = capsys.readouterr().out

    for name in COMMANDS:
        assert name in script
    assert ("-l verify" if shell == "fish" else "--verify") in script
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=script, text=True, check=True)


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
@pytest.mark.parametrize(
    ("words", "expected"), [("articad ren", "render"), ("articad build --verify ce", "certified"), ("articad show --no-b", "--no-browser")]
)
def test_bash_completes(words: str, expected: str, capsys: pytest.CaptureFixture[str]) -> None:
    cli.main(["completion", "bash"])
    script = capsys.readouterr().out
    asked = f"COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _articad; echo ${{COMPREPLY[@]}}"

    told = subprocess.run(["bash", "-c", f"{script}\n{asked}"], capture_output=True, text=True, check=True)
    assert told.stdout.split() == [expected]


def test_a_page_is_answered_whatever_a_script_said() -> None:
    """Half of a surrogate pair is no UTF-8."""
    with PageServer() as server:
        server.error = ("bad \ud800 <script>",)
        assert "bad \\ud800 &lt;script&gt;" in urllib.request.urlopen(server.address, timeout=100).read().decode()
        server.page = "whole \udfff"
        assert urllib.request.urlopen(server.address, timeout=100).read() == b"whole \\udfff"
