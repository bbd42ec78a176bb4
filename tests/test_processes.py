"""The launcher: no other start of a process, what a child can see and use, and that nothing outlives whoever started it."""

from __future__ import annotations

import ast
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

import articad
from articad.processes import launcher, scratch
from articad.processes.launcher import Limits
from tests.leftovers import alive, gone
from tests.planting import planted

PACKAGE = Path(articad.__file__).parent
ROOT = PACKAGE.parent

STARTERS = {"subprocess", "multiprocessing", "pty", "popen2", "asyncio.subprocess", "concurrent.futures.process"}
CALLS = ("system", "popen", "fork", "posix_spawn", "startfile", "exec", "spawn", "create_subprocess_", "subprocess")  # of these:
MODULES = {"os", "posix", "asyncio"}
CLASSES = {"ProcessPoolExecutor", "LocalCluster"}
ALLOWED = {
    ("processes/launcher.py", "subprocess"): "the launcher",
    ("processes/child.py", "execve"): "the launcher's other end",
    ("processes/child.py", "fork"): "a program, which this process watches",
    ("agents/provider.py", "fork"): "a bounded process for each call of a model",
    ("kernels/worker.py", "fork"): "the zygote, which forks a confined process for each part script",
}
SOURCES = sorted(path for path in PACKAGE.rglob("*.py") if "examples" not in path.parts and path.parent.name != "parts")


def starters_in(source: str) -> Iterator[str]:
    """Yield what a module has to start a process with."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in STARTERS)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield from (node.module for _ in [0] if node.module in STARTERS)
            names = sorted(alias.name for alias in node.names)
            yield from (name for name in names if name in CLASSES or (node.module in MODULES and name.startswith(CALLS)))
        elif isinstance(node, ast.Attribute):
            of_system = isinstance(node.value, ast.Name) and node.value.id in MODULES
            if node.attr in CLASSES or (of_system and node.attr.startswith(CALLS)):
                yield node.attr


@pytest.mark.parametrize(
    "source",
    [
        "import subprocess",
        "from subprocess import run",
        "import os\nos.system('x')",
        "import os\nos.execv('x', [])",
        "from os import spawnl",
        "import asyncio\nasyncio.create_subprocess_exec('x')",
        "from asyncio import subprocess",
        "from concurrent.futures import ProcessPoolExecutor",
        "import concurrent.futures as f\nf.ProcessPoolExecutor()",
        "import multiprocessing",
    ],
)
def test_the_search_below_finds_every_way_to_start_a_process(source: str) -> None:
    assert list(starters_in(source))


def test_only_the_launcher_starts_processes() -> None:
    found = {(path.relative_to(PACKAGE).as_posix(), name) for path in SOURCES for name in starters_in(path.read_text(encoding="utf-8"))}
    assert found == set(ALLOWED)


def modules_run() -> list[str]:
    """Return the modules that the package runs in processes of their own."""
    return sorted(
        {
            str(keyword.value.value)
            for path in SOURCES
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Call)
            for keyword in node.keywords
            if keyword.arg == "module" and isinstance(keyword.value, ast.Constant) and str(keyword.value.value).startswith("articad.")
        }
    )


def test_a_child_imports_nothing_from_where_it_was_started(tmp_path: Path) -> None:
    folder = tmp_path / "stranger"
    folder.mkdir()
    mark = planted(folder)
    code = f"""
from concurrent.futures import ThreadPoolExecutor
from articad.processes import launcher

def ended(module):
    limits = launcher.Limits(seconds=100)
    return launcher.run(["--version"], module=module, limits=limits, environment=launcher.environment(*launcher.OWN)).late

with ThreadPoolExecutor(2) as pool:
    assert not any(pool.map(ended, {modules_run()!r}))
"""
    environment = os.environ | {"HOME": str(folder), "TMPDIR": str(folder), "PYTHONPATH": ""}
    subprocess.run([sys.executable, "-P", "-c", code], cwd=folder, env=environment, check=True, timeout=200 * len(modules_run()))
    assert not mark.exists(), mark.read_text()


def in_child(code: str, **options: object) -> launcher.Ended:
    """Run Python in a child that the launcher starts."""
    return launcher.run([sys.executable, "-I", "-S", "-c", code], limits=Limits(seconds=30), **options)  # type: ignore[arg-type]


def test_a_child_runs_the_articad_of_its_parent(tmp_path: Path) -> None:
    copy = tmp_path / "elsewhere" / "articad"
    (copy / "processes").mkdir(parents=True)
    for name in ("__init__.py", *(f"processes/{module}.py" for module in ("__init__", "child", "launcher", "scratch"))):
        (copy / name).write_bytes((PACKAGE / name).read_bytes())
    (copy / "probe.py").write_text("import articad, sys; print(articad.__file__, *sys.argv[1:])")
    code = "from articad.processes import launcher as p; print(p.run(['word'], module='articad.probe', limits=p.Limits(seconds=60)).out.decode())"

    done = subprocess.run([sys.executable, "-c", code], cwd=copy.parent, capture_output=True, text=True, check=True)

    assert done.stdout.split() == [str(copy / "__init__.py"), "word"]


def test_a_child_works_in_an_empty_folder_of_its_own_that_is_removed() -> None:
    ended = in_child(
        "import os; print(os.getcwd(), os.environ['TMPDIR'], os.environ['HOME'], os.listdir(), oct(os.stat('.').st_mode & 0o777))"
    )
    place, temporary, home, listed, mode = ended.out.decode().split()
    assert place == temporary == home
    assert (listed, mode) == ("[]", "0o700")
    assert not Path(place).exists()


def test_a_child_gets_no_key_and_no_setting_of_python(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("OPENAI_API_KEY", "AWS_SECRET_ACCESS_KEY", "SOME_TOKEN", "PYTHONPATH", "HTTPS_PROXY", "OPENAI_BASE_URL"):
        monkeypatch.setenv(name, "secret")
    monkeypatch.setenv("ARTICAD_CACHE", "/kept")
    for given in (None, launcher.environment(), launcher.environment(*launcher.OWN)):
        seen = json.loads(in_child("import json, os; print(json.dumps(dict(os.environ)))", environment=given).out)
        assert "secret" not in seen.values()
    assert seen["ARTICAD_CACHE"] == "/kept"
    assert in_child("import os; print(dict(os.environ))", environment={"ONE": "1"}).out.split()[:2] == [b"{'ONE':", b"'1',"]
    assert launcher.environment_with_keys()["OPENAI_API_KEY"] == "secret"
    assert "PYTHONPATH" not in launcher.environment_with_keys()


@pytest.mark.parametrize("name", ["ARTICAD_CACHE", "ARTICAD_FREECAD", "ARTICAD_MEMORY", "ARTICAD_ROOT"])
def test_a_path_means_the_same_to_a_child(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A child works in another folder, which is removed afterwards."""
    monkeypatch.chdir(tmp_path)
    for value, meant in (("kept", str(tmp_path / "kept")), ("/kept", "/kept"), ("", "")):
        monkeypatch.setenv(name, value)
        assert launcher.environment(*launcher.OWN)[name] == launcher.environment_with_keys()[name] == meant


SEARCHED = ("PATH", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "OMP_TOOL_LIBRARIES", "LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_DIRS")
BY_KEYS = ("PATH", "LD_LIBRARY_PATH", "LD_PRELOAD", "LD_AUDIT", "DYLD_INSERT_LIBRARIES", "DYLD_FRAMEWORK_PATH", "GCONV_PATH")


@pytest.mark.parametrize("has_keys", [False, True])
def test_a_child_searches_no_folder_but_absolute_ones(has_keys: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An empty or a relative entry means the working folder, which may be that of a job of a stranger's."""
    names, inside = (BY_KEYS, tmp_path / "lib") if has_keys else (SEARCHED, tmp_path / "lib")
    for name in names:
        monkeypatch.setenv(name, f":.:relative:{inside}::../x:")
    given = launcher.environment_with_keys() if has_keys else launcher.environment(*launcher.SCREEN)
    assert {name: given.get(name) for name in names} == dict.fromkeys(names, str(inside))
    raw = {name: os.environ[name] for name in names if name not in ("LD_PRELOAD", "LD_AUDIT")}
    seen = json.loads(in_child("import json, os; print(json.dumps(dict(os.environ)))", environment=raw).out)
    assert {name: seen.get(name) for name in raw} == dict.fromkeys(raw, str(inside)), "whoever states the environment"
    for name in names:
        monkeypatch.setenv(name, ".:")
    given = launcher.environment_with_keys() if has_keys else launcher.environment(*launcher.SCREEN)
    assert not given.keys() & set(names)
    assert launcher.environment_with_keys().get("HOME") == os.environ.get("HOME")


def test_libraries_that_start_programs_by_themselves_find_none_in_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`webbrowser` asks for xdg-settings and starts a browser, from the folders of the PATH."""
    for name in ("PATH", "LD_LIBRARY_PATH"):
        monkeypatch.setenv(name, f":.:{tmp_path}:")
    with launcher.safe_path():
        assert (os.environ["PATH"], os.environ["LD_LIBRARY_PATH"]) == (str(tmp_path), str(tmp_path))
        assert os.environ["PYTHONSAFEPATH"] == "1"
    assert os.environ["PATH"] == f":.:{tmp_path}:"
    monkeypatch.setenv("PATH", "")
    with launcher.safe_path():
        assert os.environ.get("PATH") is None


def test_a_program_gets_the_environment_as_it_was_given() -> None:
    assert launcher.run(["/usr/bin/env"], limits=Limits(seconds=30), environment={}).out == b""


@pytest.mark.skipif(sys.platform != "linux", reason="limits of data are Linux's")
def test_memory_files_and_output_are_bounded() -> None:
    def tried(code: str, limits: Limits) -> launcher.Ended:
        return launcher.run([sys.executable, "-I", "-S", "-c", code], limits=limits)

    assert b"MemoryError" in tried("x = bytearray(2**30)", Limits(seconds=30, memory=2**28)).err
    assert tried("open('file', 'wb').write(bytes(2**22))", Limits(seconds=30, file_size=2**20)).code != 0
    busy = tried("import os\nif not os.fork():\n    while sum(os.times()[:2]) < 0.5: pass\nelse: os.wait()", Limits(seconds=60))
    assert 0.4 < busy.processor < 5.0  # of a process below it, too
    out = tried("import os\nfor _ in range(70): os.write(1, b'x' * 2**20)\nos.write(1, b'end')", Limits(seconds=60)).out
    assert len(out) == launcher.OUTPUT
    assert out.endswith(b"end")


def test_the_whole_group_is_killed_when_time_is_up_and_when_the_leader_ends() -> None:
    late = launcher.run(["/bin/sh", "-c", "sleep 300 & echo $!; sleep 300"], limits=Limits(seconds=1))
    early = launcher.run(["/bin/sh", "-c", "sleep 300 & echo $!"], limits=Limits(seconds=200))
    assert (late.late, early.late, early.code) == (True, False, 0)
    assert gone([int(late.out), int(early.out)])


# An engine that waits forever: the pipe that it reads has no writer.
ENGINE = """
import os, sys
from pathlib import Path
from articad.processes import launcher
from articad.simulation import loading
os.mkfifo("model.urdf")
start = launcher.start
def told(*words, **options):
    child = start(*words, **options)
    print(child.pid, flush=True)
    return child
launcher.start = told
loading.load_in_all(Path("model.urdf").resolve(), ("mujoco", "pinocchio"))
"""
SCRIPT = """
from articad.kernels.build123d import Build123dKernel
kernel = Build123dKernel()
kernel.warm_up()
print(kernel.pid, str(kernel._scratch.name) and kernel.pid, flush=True)
import time
time.sleep(300)
"""


# Programs below a program, one of which leaves the group: the kernel tells none of them that its parent has ended.
PROGRAM = """
import os
from articad.processes import launcher
code = "sleep 300 & echo $$ $!; setsid sh -c 'echo $$; sleep 300 & echo $!; wait' & (sh -c 'echo $$; sleep 300; true'; true)"
with launcher.start(["/bin/sh", "-c", code]) as child:
    words = [child.pid]
    while len(words) < 6:
        words += child.stdout.readline().split()
    print(*map(int, words), flush=True)
    child.finish()
"""


def _heeds_interrupts() -> None:
    """Undo what a shell does to its background jobs: they ignore SIGINT, and so would all that they start."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.skipif(sys.platform != "linux", reason="the kernel's signal for a parent's end is Linux's")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL, signal.SIGINT, signal.SIGHUP])
@pytest.mark.parametrize("work", [ENGINE, SCRIPT, PROGRAM], ids=["engines", "kernel", "programs"])
def test_no_process_outlives_its_parent_and_no_folder_the_next_start(work: str, number: signal.Signals, tmp_path: Path) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    environment = os.environ | {"TMPDIR": str(temporary)}
    with subprocess.Popen(
        [sys.executable, "-c", work],
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=_heeds_interrupts,  # noqa: PLW1509 - this process starts no thread before
    ) as parent:
        assert parent.stdout is not None
        children = [int(word) for _ in range(2 if work is ENGINE else 1) for word in parent.stdout.readline().split()]
        assert all(map(alive, children))
        parent.send_signal(number)
        assert gone([parent.pid, *children])
    subprocess.run([sys.executable, "-c", "from articad.processes import scratch; scratch.folder('x')"], env=environment, check=True)
    assert list(temporary.iterdir()) == []


# A process that kills what is below it, where some of its children are another user's, in every order.
FOREIGN = """
import os, signal, sys, time
from articad.processes import child
pids = []
for foreign in map(int, sys.argv[1]):
    pid = os.fork()
    if pid == 0:
        if not foreign:
            os.setuid(65534)
        os.write(1, b".")
        os.close(1)
        time.sleep(300)
        os._exit(0)
    pids.append(pid)
    os.write(1, f"{pid} ".encode())
while os.read(0, 1) != b"\\n":
    pass
os.setuid(65534)
child._kill_all_below()
print("done", flush=True)
"""


@pytest.mark.skipif(sys.platform != "linux" or os.geteuid() != 0, reason="only root starts processes of two users")
@pytest.mark.parametrize("order", ["10", "01", "101", "0110", "11", "00"])
def test_a_process_that_cannot_be_killed_spares_no_other(order: str) -> None:
    with subprocess.Popen([sys.executable, "-c", FOREIGN, order], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as parent:
        assert parent.stdin is not None
        assert parent.stdout is not None
        said = b""
        while said.count(b".") < len(order) or said.count(b" ") < len(order):
            said += os.read(parent.stdout.fileno(), 4096)
        pids = [int(word) for word in said.replace(b".", b"").split()]
        try:
            parent.stdin.write(b"\n")
            parent.stdin.flush()
            assert parent.stdout.read(5) == b"done\n"
            assert gone([pid for pid, foreign in zip(pids, order, strict=True) if foreign == "0"])
            assert all(alive(pid) for pid, foreign in zip(pids, order, strict=True) if foreign == "1")
        finally:
            for pid, foreign in zip(pids, order, strict=True):
                if foreign == "1":
                    os.kill(pid, signal.SIGKILL)


def test_a_program_ends_as_by_itself_and_is_alone_at_its_pipes() -> None:
    """The process that watches it neither changes its end nor holds its pipes."""
    for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGSEGV):
        assert launcher.run(["/bin/sh", "-c", f"kill -{int(number)} $$"], limits=Limits(seconds=60)).code == -number
    assert launcher.run(["/bin/sh", "-c", "exit 7"], limits=Limits(seconds=60)).code == 7
    with launcher.start(["/bin/sh", "-c", "exec >&- 2>&-; read line; exit 5"], stdin=launcher.PIPE) as child:
        assert child.stdout.read() == b""  # it has closed it, and is alive
        assert not child.ended()
        child.stdin.write(b"\n")
        child.stdin.flush()
        assert child.finish().code == 5


def test_the_sweep_leaves_what_is_in_use_or_not_ours(tmp_path: Path) -> None:
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    code = "from articad.processes import scratch; kept = scratch.folder('x'); print(kept.name, flush=True); input()"
    with subprocess.Popen([sys.executable, "-c", code], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        used = Path(other.stdout.readline().strip())
        (tmp_path / "target").mkdir()
        (tmp_path / "target" / "file").write_text("")
        (tmp_path / f"{scratch.PREFIX}link").symlink_to(tmp_path / "target")
        (tmp_path / f"{scratch.PREFIX}dead").mkdir()
        subprocess.run([sys.executable, "-c", "from articad.processes import scratch; scratch.sweep()"], env=environment, check=True)
        assert used.is_dir()
        other.communicate("\n")
    assert (tmp_path / "target" / "file").exists()
    assert not (tmp_path / f"{scratch.PREFIX}dead").exists()
    assert not used.exists()


WRITER = """
import sys
from pathlib import Path
from articad.processes import scratch
target = Path(sys.argv[1])
if sys.argv[2] == "file":
    Path.replace = lambda *_: (print("ready", flush=True), sys.stdin.read())
    scratch.write(target, b"new")
else:
    with scratch.folder_beside(target) as folder:
        (folder / "part").write_text("new")
        print("ready", flush=True)
        sys.stdin.read()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such locks: nothing is swept there")
@pytest.mark.parametrize("kind", ["file", "folder"])
def test_what_a_killed_writer_left_beside_its_target_goes_with_the_next_writer(kind: str, tmp_path: Path) -> None:
    def writer() -> subprocess.Popen[str]:
        command = [sys.executable, "-c", WRITER, str(tmp_path / "target"), kind]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    with writer() as killed, writer() as alive_one:
        for process in (killed, alive_one):
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
        killed.kill()
        killed.wait()
        assert len(list(tmp_path.iterdir())) == 2
        (tmp_path / ".articad-mine").write_text("not ours")
        code = "import sys; from pathlib import Path; from articad.processes import scratch; scratch.write(Path(sys.argv[1]), b'other')"
        subprocess.run([sys.executable, "-c", code, str(tmp_path / "other")], check=True)
        left = {path.name for path in tmp_path.iterdir()} - {".articad-mine", "other"}
        assert len(left) == 1, "only the one that is being written is there"
        alive_one.communicate()
    assert (tmp_path / ".articad-mine").exists()
    subprocess.run([sys.executable, "-c", code, str(tmp_path / "other")], check=True)
    assert {path.name for path in tmp_path.iterdir()} <= {"target", ".articad-mine", "other"}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such locks: nothing is swept there")
@pytest.mark.parametrize("kind", ["file", "folder"])
def test_what_a_sweep_takes_before_its_maker_has_locked_it_is_made_again(kind: str, tmp_path: Path) -> None:
    """A sweep that comes between the making and the lock holds the lock until it has removed what it found."""
    import fcntl

    made: list[Path] = []
    swept: list[threading.Thread] = []

    def make() -> Path:
        place = Path(tempfile.mkdtemp(dir=tmp_path))
        if kind == "file":
            place.rmdir()
            place.touch()
        made.append(place)
        if len(made) == 1:
            lock = os.open(place, os.O_RDONLY)
            fcntl.flock(lock, fcntl.LOCK_EX)

            def sweep() -> None:
                time.sleep(0.2)
                (place.unlink if kind == "file" else place.rmdir)()
                os.close(lock)

            swept.append(threading.Thread(target=sweep))
            swept[0].start()
        return place

    place, lock = scratch._locked(make)
    swept[0].join()
    assert len(made) == 2
    assert place == made[1]
    assert place.exists()
    assert lock is not None
    os.close(lock)


def test_a_program_is_never_taken_from_the_working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "bwrap").write_text("#!/bin/sh\n")
    (tmp_path / "bwrap").chmod(0o755)
    monkeypatch.chdir(tmp_path)
    assert launcher.which("bwrap", "") is None
    assert launcher.which("bwrap", ":.:relative") is None
    assert launcher.which("bwrap", f":{tmp_path}") == str(tmp_path / "bwrap")


@pytest.mark.parametrize(
    "statement",
    [
        "from articad.importers.mjcf import read_mjcf; read_mjcf('foreign.xml')",
        "from articad.cli import main; main(['convert', 'foreign.xml', 'out.urdf'])",
        "from articad.processes import launcher; launcher.run([], module='articad.simulation.loading', limits=launcher.Limits(seconds=50))",
    ],
)
def test_no_library_starts_python_in_the_working_folder(statement: str, tmp_path: Path) -> None:
    """The import of mujoco does: glfw runs `python -c "import ctypes"` beside it."""
    folder = tmp_path / "stranger"
    folder.mkdir()
    mark = planted(folder)
    (folder / "foreign.xml").write_text(
        '<mujoco><worldbody><geom size="1"/><body pos="9 0 0"><joint/><geom size="1"/></body></worldbody></mujoco>'
    )
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}
    subprocess.run([sys.executable, "-P", "-c", statement], cwd=folder, env=environment, check=True, timeout=200)
    assert not mark.exists(), mark.read_text()


@pytest.mark.parametrize("there", [True, False])
@pytest.mark.parametrize("left", [True, False])
@pytest.mark.parametrize("end", ["replaced", "given up", "cancelled"])
def test_what_was_set_aside_comes_back_unless_it_was_replaced(end: str, left: bool, there: bool, tmp_path: Path) -> None:
    target = tmp_path / "run"
    if there:
        target.mkdir()
        (target / "old").touch()
    with suppress(KeyboardInterrupt), scratch.set_aside(target) as replace:
        assert not target.exists()
        if left:
            target.mkdir()
            (target / "new").touch()
        if end == "replaced":
            replace()
        if end == "cancelled":
            raise KeyboardInterrupt
    expected = left and "new" if end == "replaced" else there and "old"
    assert [str(path.relative_to(tmp_path)) for path in sorted(tmp_path.rglob("*"))] == (["run", f"run/{expected}"] if expected else [])
