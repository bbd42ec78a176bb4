"""Kill -9 at any point loses no finished work, leaves nothing half-written, and what is taken up again ends equal."""

from __future__ import annotations

import errno
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from articad.errors import ArticadError, RunError, WriteError
from articad.runs.run import Run, RunRequest
from tests.crash import killing, works
from tests.crash.endpoint import endpoint
from tests.crash.killing import Point, Work

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "crash"
pytestmark = pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")  # of forking; the children use no lock of other threads


@pytest.fixture(autouse=True)
def _one_thread() -> None:
    """A fork takes one thread along; others would leave their locks behind."""
    for _ in range(100):
        if threading.active_count() == 1:
            break
        time.sleep(0.02)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recording")
    assert killing.child(works.generated, folder) == 0
    return folder / "run"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run that was built."""
    folder = tmp_path_factory.mktemp("built")
    assert killing.child(works.build, folder) == 0
    return folder


def work_named(name: str, recording: Path) -> Work:
    if name == "edit":
        return lambda folder: works.edited(folder, recording)
    if name in {"proven", "exported"}:
        return works.proven if name == "proven" else works.exported
    return works.build if name == "build" else lambda folder: works.generated(folder, recording=recording)


@pytest.mark.parametrize("name", ["live", "batch"])
def test_killed_with_processes_of_its_own_it_resumes_and_ends_equal(name: str, recording: Path, tmp_path: Path) -> None:
    """Calls of models, and workers of a batch."""
    with endpoint(recording) as address:
        work = (lambda folder: works.live(folder, address)) if name == "live" else works.batch
        took, calls = killing.undisturbed(work, tmp_path / "whole")
        expected = works.files(tmp_path / "whole")
        killed = list[bool]()
        while not any(killed):  # the first time took longer than the others, if the machine was busy then
            points = killing.points(3, took, calls, seed=3) if name == "live" else killing.timed(2, took, seed=3)
            killed = [killing.resumed(work, point, tmp_path, lambda folder: _same(folder, expected)) for point in points]
            took /= 2


@pytest.mark.parametrize("name", ["build", "generate", "edit", "proven", "exported"])
def test_killed_at_some_stages_and_times_it_resumes_and_ends_equal(name: str, recording: Path, built: Path, tmp_path: Path) -> None:
    work, begun = work_named(name, recording), built if name in {"proven", "exported"} else None
    took, calls = killing.undisturbed(work, tmp_path / "whole", begun)
    expected = works.files(tmp_path / "whole")
    points = random.Random(1).sample(killing.stages(calls), 4) + killing.points(4, took, calls, seed=2)

    killed = [killing.resumed(work, point, tmp_path, lambda folder: _same(folder, expected), begun) for point in points]

    assert sum(killed) >= len(killed) // 2


def _same(folder: Path, expected: object) -> None:
    assert works.files(folder) == expected


def test_no_answer_that_was_kept_is_asked_for_again(recording: Path, tmp_path: Path) -> None:
    work = work_named("generate", recording)
    _, calls = killing.undisturbed(work, tmp_path / "whole")
    steps = len((tmp_path / "whole/calls").read_bytes())
    assert steps == len(Run.view(recording).replies())
    for number in (calls // 3, 2 * calls // 3, calls - 1):
        folder = tmp_path / "work"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        assert killing.child(work, folder, Point(calls=number)) == -signal.SIGKILL
        kept = len(Run.view(folder / "run").replies()) if (folder / "run/request.json").exists() else 0
        (folder / "calls").unlink(missing_ok=True)

        assert killing.child(work, folder) == 0
        assert len((folder / "calls").read_bytes() if (folder / "calls").exists() else b"") == steps - kept


@pytest.mark.parametrize("name", works.STORES)
def test_what_a_store_committed_outlives_its_writers(name: str, tmp_path: Path) -> None:
    """Four writers, killed at random; what they said was committed is there, and nothing is torn."""
    for seed in range(3):
        committed = killing.killed_writers(works.STORES[name], tmp_path, writers=4, seconds=0.15, seed=seed)
        found = works.STORES[name].read(tmp_path)

        writers = {writer for writer, _ in found}
        lost = {(writer if len(writers) > 1 else 0, number) for writer, number in committed} - found
        assert not lost
        assert committed


def test_a_full_disk_is_an_error_of_ours_and_the_run_goes_on_afterwards(recording: Path, tmp_path: Path) -> None:
    """Every file that grows beyond a bound is refused, as by a disk that is full; later there is room again."""
    work = work_named("generate", recording)
    (tmp_path / "whole").mkdir()
    assert killing.child(work, tmp_path / "whole") == 0
    expected = works.files(tmp_path / "whole")
    for bound in (0, 300, 1500, 4000):
        folder = tmp_path / f"work{bound}"
        folder.mkdir()

        def in_little_room(folder: Path, bound: int = bound) -> None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (bound, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
            with pytest.raises(ArticadError) as raised:
                works.generated(folder, recording=recording)
            assert raised.value.findings or "cannot be kept" in raised.value.message

        assert killing.child(in_little_room, folder) == 0
        assert killing.child(work, folder) == 0
        assert works.files(folder) == expected


@pytest.mark.skipif(os.getuid() != 0, reason="mounts a small disk")
def test_a_real_small_disk_that_fills_up(recording: Path, tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(disk)], check=False, capture_output=True).returncode != 0:
        pytest.skip("this machine mounts nothing")
    try:
        (disk / "work").mkdir()

        def until_full(folder: Path) -> None:
            with pytest.raises(ArticadError, match=r"disk is full|No space left"):
                works.generated(folder, recording=recording)

        assert killing.child(until_full, disk / "work") == 0
        subprocess.run(["mount", "-o", "remount,size=64m", str(disk)], check=True)
        assert killing.child(work_named("generate", recording), disk / "work") == 0
        (tmp_path / "whole").mkdir()
        assert killing.child(work_named("generate", recording), tmp_path / "whole") == 0
        assert works.files(disk / "work") == works.files(tmp_path / "whole")
    finally:
        subprocess.run(["umount", "-l", str(disk)], check=False)


def test_a_read_only_file_system_is_an_error_of_ours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not every machine may mount one, so the call of the system that opens files answers as there."""
    with Run.create(RunRequest(prompt="x"), out=tmp_path / "r") as run:
        real = os.open

        def refuses(path: str, flags: int, *rest: int, **more: int) -> int:
            if flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
                raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))
            return real(path, flags, *rest, **more)

        run.save_plan("{}", 0)
        monkeypatch.setattr(os, "open", refuses)
        with pytest.raises(WriteError, match="read-only"):
            run.save_plan('{"other": 1}', 0)
        monkeypatch.undo()
        assert (run.path / "plan.json").read_text() == "{}"


def test_two_processes_in_one_directory_leave_one_run(recording: Path, tmp_path: Path) -> None:
    """The second process gets an error at once and takes nothing."""
    folder = tmp_path / "both"
    folder.mkdir()
    pids = []
    for _ in range(2):
        pid = os.fork()
        if pid == 0:
            status = 9
            try:
                works.generated(folder, recording=recording)
                status = 0
            except RunError as error:
                status = 3 if "Another process" in error.message or "not empty" in error.message else 4
            finally:
                os._exit(status)
        pids.append(pid)
    codes = sorted(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) for pid in pids)

    assert codes in ([0, 3], [0, 0])  # both, if one had ended before the other began
    (tmp_path / "whole").mkdir()
    assert killing.child(work_named("generate", recording), tmp_path / "whole") == 0
    assert works.files(folder) == works.files(tmp_path / "whole")


def test_a_clock_that_goes_backwards_changes_nothing(recording: Path, tmp_path: Path) -> None:
    (tmp_path / "whole").mkdir()
    assert killing.child(work_named("generate", recording), tmp_path / "whole") == 0

    def in_the_past(folder: Path) -> None:
        now = time.time
        began = now()
        time.time = lambda: began - 1e6 * (now() - began) - 1e8  # each call a day or more before the last
        works.generated(folder, recording=recording)

    (tmp_path / "work").mkdir()
    assert killing.child(in_the_past, tmp_path / "work", Point(calls=40)) == -signal.SIGKILL
    assert killing.child(in_the_past, tmp_path / "work") == 0
    assert works.files(tmp_path / "work") == works.files(tmp_path / "whole")
    assert [event["t"] for event in Run.view(tmp_path / "work/run").events()]


@pytest.mark.crash
@pytest.mark.parametrize("arguments", [["--points", "500"], ["--points", "20", "--kernel", "build123d"]], ids=["fixed", "real"])
def test_at_hundreds_of_points(arguments: list[str]) -> None:
    """The command prints what it did; nothing it killed failed to resume."""
    done = subprocess.run([sys.executable, str(SCRIPT), *arguments], capture_output=True, text=True, check=False)

    assert done.returncode == 0, done.stdout + done.stderr[-3000:]
    assert "0 failed" in done.stdout
