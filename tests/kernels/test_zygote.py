"""The worker's process: started once, shared by threads, replaced when it dies, gone when its owner goes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from articad.errors import KernelError, KernelUnavailableError
from articad.kernels import libraries, zygote
from articad.kernels.build123d import Build123dKernel
from tests.kernels.attacks import descendants, settles
from tests.kernels.conftest import kernel_of_its_own

CUBE = b"from build123d import Box\ndef build(part):\n    return Box(1, 1, 1), {}\n"


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_a_killed_zygote_is_replaced(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    kernel.warm_up()
    before = kernel.pid
    assert before is not None
    os.kill(before, signal.SIGKILL)

    assert kernel.build(CUBE, brief).solid.volume == pytest.approx(1)
    assert kernel.pid != before


def test_a_zygote_killed_under_a_job_is_replaced_and_the_job_done(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    kernel.warm_up()
    slow = b"import time\nfrom build123d import Box\ndef build(part):\n    time.sleep(1)\n    return Box(1, 1, 1), {}\n"
    first = kernel.pid
    assert first is not None
    threading.Timer(0.4, os.kill, (first, signal.SIGKILL)).start()

    assert kernel.build(slow, brief).solid.volume == pytest.approx(1)
    assert kernel.pid != first


def test_parts_are_built_side_by_side(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    """Each script sleeps; run one after the other they would take longer than all of them together do."""
    script = b"import time\nfrom build123d import Box\ndef build(part):\n    time.sleep(1.0)\n    return Box(len(part.name), 1, 1), {}\n"
    kernel.warm_up()
    running: list[int] = []
    names = ["x" * n for n in range(1, 9)]
    with ThreadPoolExecutor(8) as pool:
        futures = [pool.submit(kernel.build, script, {**brief, "name": name}) for name in names]
        while not all(future.done() for future in futures):
            running.append(len(descendants(kernel)))
            time.sleep(0.02)

    assert [future.result().solid.volume for future in futures] == pytest.approx([1, 2, 3, 4, 5, 6, 7, 8])
    assert max(running) - min(running) >= 4


def test_closing_ends_every_process(brief: dict[str, Any]) -> None:
    kernel = kernel_of_its_own()
    kernel.build(CUBE, brief)
    pids = {kernel.pid or 0, *descendants(kernel)}
    assert all(map(is_running, pids))

    kernel.close()

    assert settles(lambda: not any(map(is_running, pids)))


def test_the_zygote_goes_with_its_owner() -> None:
    code = (
        "import os, signal\n"
        "from articad.kernels.build123d import Build123dKernel\n"
        "kernel = Build123dKernel()\n"
        "kernel.warm_up()\n"
        "print(kernel.pid, flush=True)\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    started = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, cwd=Path(__file__).parents[2])
    assert started.stdout is not None
    pid = int(started.stdout.readline())
    started.wait(30)
    started.stdout.close()

    assert settles(lambda: not is_running(pid), 5.0)


def test_a_fork_of_the_owner_starts_its_own(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    kernel.warm_up()
    owned = kernel.pid
    pid = os.fork()
    if pid == 0:
        try:
            good = abs(kernel.build(CUBE, brief).solid.volume - 1) < 1e-9 and kernel.pid != owned
            kernel.close()
            os._exit(0 if good else 1)
        finally:
            os._exit(2)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0

    assert owned is not None
    assert is_running(owned)
    assert kernel.build(CUBE, brief).solid.volume == pytest.approx(1)
    assert kernel.pid == owned


@pytest.mark.parametrize("error", [ValueError("no"), MemoryError(), OSError("no processes left")])
def test_whoever_waits_for_the_worker_is_told_whatever_kept_it_from_starting(
    error: Exception, brief: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    def spawn(*_: Any) -> Any:
        raise error

    monkeypatch.setattr(zygote.Zygote, "_spawn", spawn)
    told: list[Exception] = []

    def build() -> None:
        try:
            kernel_of_its_own().build(CUBE, brief)
        except Exception as raised:  # noqa: BLE001 - it is looked at below
            told.append(raised)

    waiting = threading.Thread(target=build, daemon=True)
    waiting.start()
    waiting.join(60)
    assert len(told) == 1
    assert isinstance(told[0], KernelUnavailableError if isinstance(error, OSError) else type(error))


def test_kernels_share_a_process_until_the_last_one_closes(brief: dict[str, Any]) -> None:
    layers = ("landlock",)  # which no other test's kernel shares
    first, second = Build123dKernel(layers=layers), Build123dKernel(layers=layers, timeout=9.0)
    first.build(CUBE, brief)
    second.build(CUBE, brief)
    pid = first.pid
    assert pid is not None
    assert second.pid == pid

    first.close()
    assert is_running(pid)
    assert second.build(CUBE, brief).solid.volume == pytest.approx(1)

    second.close()
    assert settles(lambda: not is_running(pid))


def test_a_thread_that_ends_does_not_take_the_zygote_with_it(brief: dict[str, Any]) -> None:
    """The kernel's parent-death signal follows the thread that started a process, not its process."""
    kernel = kernel_of_its_own()
    thread = threading.Thread(target=kernel.warm_up)
    thread.start()
    thread.join()
    pid = kernel.pid
    time.sleep(0.3)
    try:
        assert kernel.build(CUBE, brief).solid.volume == pytest.approx(1)
        assert kernel.pid == pid
    finally:
        kernel.close()


def test_what_a_worker_cannot_load_is_named_with_the_line_that_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zygote, "missing_libraries", lambda: ["libGL.so.1", "libX11.so.6"])

    error = zygote._unavailable("libGL.so.1: cannot open shared object file")

    assert isinstance(error, KernelUnavailableError)
    assert "libGL.so.1" in str(error)
    assert error.how_to_get == "apt-get install --no-install-recommends libgl1 libx11-6"
    assert error.findings.codes == ("E_KERNEL_UNAVAILABLE",)


def test_a_worker_that_cannot_import_its_kernel_says_so(monkeypatch: pytest.MonkeyPatch, brief: dict[str, Any]) -> None:
    broken = zygote._BOOT.replace("main()", "sys.modules['build123d'] = None; main()")
    monkeypatch.setattr(zygote, "_BOOT", broken)

    with pytest.raises(KernelUnavailableError, match="build123d"):
        kernel_of_its_own().build(CUBE, brief)


def test_a_worker_that_ends_at_once_says_so(monkeypatch: pytest.MonkeyPatch, brief: dict[str, Any]) -> None:
    monkeypatch.setattr(zygote, "_BOOT", "raise SystemExit(1)")

    with pytest.raises(KernelError, match="ended before it was ready"):
        kernel_of_its_own().build(CUBE, brief)


def test_missing_libraries_are_found_by_asking_the_loader(monkeypatch: pytest.MonkeyPatch) -> None:
    assert libraries.missing_libraries() == []

    monkeypatch.setitem(libraries.PACKAGES, "libdoes-not-exist.so.9", "libnone")
    assert libraries.missing_libraries() == ["libdoes-not-exist.so.9"]


def test_asking_for_libraries_and_levels_loads_no_kernel() -> None:
    code = (
        "import sys\n"
        "from articad.kernels.libraries import missing_libraries\n"
        "from articad.kernels.sandbox import level\n"
        "missing_libraries(), level()\n"
        "heavy = {'numpy', 'OCP', 'build123d', 'pydantic', 'scipy', 'trimesh', 'pinocchio'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parents[2])


def test_this_process_never_loads_the_kernel(build: Any) -> None:
    code = (
        "import sys\n"
        "import articad.kernels.build123d, articad.kernels.parts\n"
        "heavy = {'OCP', 'build123d'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parents[2])
