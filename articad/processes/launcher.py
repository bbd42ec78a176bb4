"""Every process that this program starts is started here.

A child starts with `articad/processes/child.py` under `python -I`. It
- imports nothing from the working folder, PYTHONPATH or the user's own packages;
- works in a private, empty folder, which is removed afterwards and is its TMPDIR;
- gets the environment variables that it needs, and keys only where it calls a model;
- leads a process group of its own, which is killed as one, with all processes below a program (Linux);
- is killed by the kernel when the thread that started it ends (Linux);
- has bounded memory, processor time, wall time, output and file sizes.

Standard library only: the sandbox of part scripts uses this module too.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Final, Self

from articad.processes import scratch

PIPE: Final = subprocess.PIPE
NOWHERE: Final = subprocess.DEVNULL
TO_STDOUT: Final = subprocess.STDOUT
OUTPUT: Final = 64 * 2**20  # bytes of a child's output that are kept, the last ones
OWN: Final = ("HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME", "CONDA_PREFIX", "ARTICAD_")
"""Variables that articad's own commands need to find caches, memories and FreeCAD."""
_PATHS: Final = ("ARTICAD_CACHE", "ARTICAD_FREECAD", "ARTICAD_MEMORY", "ARTICAD_ROOT")
"""Those that may be relative to the working folder, which a child does not share."""
SCREEN: Final = (
    "DISPLAY",
    "WAYLAND_DISPLAY",
    "XAUTHORITY",
    "XDG_RUNTIME_DIR",
    "LIBGL_",
    "MESA_",
    "GALLIUM_",
    "EGL_",
    "__EGL_",
    "__GLX_",
    "VTK_",
)
"""Variables that drawing with OpenGL needs."""
_BASIC: Final = ("PATH", "LANG", "LC_", "TZ", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "OMP_", "OPENBLAS_", "SYSTEMROOT")
_SEARCHED: Final = ("PATH", "GCONV_PATH", "OMP_TOOL_LIBRARIES")
_OF_LIBRARIES: Final = ("LD_", "DYLD_", "LIBGL_", "GALLIUM_", "EGL_", "__EGL_")  # of the loader and of OpenGL
_PLACES: Final = ("PATH", "DIR", "DIRS", "FILENAMES", "LIBRARIES", "PRELOAD", "AUDIT")
_SAFE_PATH: Final = "PYTHONSAFEPATH"  # `-P` for all Python processes that inherit it
_CHILD: Final = str(Path(__file__).with_name("child.py"))
_LOOK_S: Final = 0.2  # between two checks whether a child that closed no pipe has ended
_END_S: Final = 5.0  # for the watcher of a program to kill it, and for pipes to close after all processes of a group are killed


@dataclass(frozen=True)
class Limits:
    """Resource limits of a child; None means no limit.

    Attributes:
        seconds: Wall time until it is killed with its group; its processor time is limited to twice that on each processor, in case nothing enforces the wall time.
        processor: Processor time of each of its processes, in whole seconds, if it has a limit of its own; the kernel then ends the process with SIGKILL.
        memory: Private data of each of its processes [bytes].
        file_size: Largest size of each file that it writes [bytes].
    """

    seconds: float | None = None
    memory: int | None = None
    file_size: int | None = None
    processor: int | None = None

    def resources(self) -> dict[str, int]:
        """Return the limits that the kernel enforces, by their names in `resource`."""
        cpu = self.processor
        if cpu is None and self.seconds is not None:
            cpu = int(2 * self.seconds * (os.cpu_count() or 1)) + 1
        limits = {"CPU": cpu, "DATA": self.memory, "FSIZE": self.file_size, "CORE": 0}
        return {name: value for name, value in limits.items() if value is not None}


@dataclass(frozen=True)
class Ended:
    """How a child ended.

    Attributes:
        code: Its exit code; negative for a signal.
        late: Whether it was killed because its time was over.
        out: The end of what it wrote to stdout.
        err: The end of what it wrote to stderr.
        processor: Processor time of it and of all that had ended below it [s]; 0 where the system does not tell.
    """

    code: int
    late: bool
    out: bytes
    err: bytes
    processor: float = 0.0

    @property
    def last_line(self) -> str:
        """The last line of its stderr, or how it ended if that is empty."""
        lines = self.err.decode(errors="replace").strip().splitlines()
        return lines[-1] if lines else self.how

    @property
    def how(self) -> str:
        """Its signal or exit code, in words."""
        return f"signal {-self.code}" if self.code < 0 else f"exit code {self.code}"


class Child:
    """A process that was started here; leaving its context kills its group and removes its folder."""

    def __init__(self, process: subprocess.Popen[bytes], folder: Any, limits: Limits, *, watched: bool = False) -> None:
        self._process, self._folder, self._limits = process, folder, limits
        self._watched = watched  # by a process of child.py, which kills what has left the group too
        self._started = time.monotonic()
        self._lock = threading.Lock()
        self._held: list[IO[bytes]] = []  # pipes that a process outside of its group keeps open, and a thread reads

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    @property
    def pid(self) -> int:
        """Its process id, which is also that of its group."""
        return self._process.pid

    @property
    def stdin(self) -> IO[bytes]:
        """The end of its input at which this process writes, if a pipe was requested."""
        assert self._process.stdin is not None
        return self._process.stdin

    @property
    def stdout(self) -> IO[bytes]:
        """The end of its output at which this process reads, if a pipe was requested."""
        assert self._process.stdout is not None
        return self._process.stdout

    def ended(self) -> bool:
        """Return whether it has ended by itself."""
        if self._process.returncode is None and hasattr(os, "waitid"):  # it is not reaped, so that its id stays that of its group
            with contextlib.suppress(ChildProcessError):
                return os.waitid(os.P_PID, self.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
        return self._process.poll() is not None

    def wait(self, seconds: float) -> bool:
        """Wait for it to end by itself; return whether it did within this time."""
        until = time.monotonic() + seconds
        while not self.ended():
            if time.monotonic() > until:
                return False
            time.sleep(0.01)
        return True

    def kill(self) -> None:
        """Kill every process of its group, and of a program all processes below it."""
        with self._lock:
            if self._process.returncode is not None:
                return
            if self._watched and not self.ended():
                self._process.terminate()
                self.wait(_END_S)
            if hasattr(os, "killpg"):
                with contextlib.suppress(ProcessLookupError, PermissionError):  # macOS refuses for a group of zombies
                    os.killpg(self.pid, signal.SIGKILL)
            self._process.kill()

    def close(self) -> int:
        """Kill the rest of its group, remove its folder, return its exit code."""
        self.kill()
        with self._lock:
            code = self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            if pipe is not None and pipe not in self._held:
                with contextlib.suppress(OSError):  # input that it did not read
                    pipe.close()
        if self._folder is not None:
            self._folder.cleanup()
        return code

    def finish(self) -> Ended:
        """Read its output until it ends or its time is over, and close it."""
        pipes = [pipe for pipe in (self._process.stdout, self._process.stderr) if pipe is not None]
        texts = [bytearray() for _ in pipes]
        readers = [threading.Thread(target=_drain, args=pair, daemon=True) for pair in zip(pipes, texts, strict=True)]
        until = None if self._limits.seconds is None else self._started + self._limits.seconds
        try:
            for reader in readers:
                reader.start()
            while not self.ended() and (until is None or time.monotonic() < until):
                pause = _LOOK_S if until is None else max(0.0, min(_LOOK_S, until - time.monotonic()))
                reading = next((reader for reader in readers if reader.is_alive()), None)
                if reading is None:
                    self.wait(pause)
                else:
                    reading.join(pause)
            late = not self.ended()
            processor = self._processor_time()
            self.kill()  # its own children may hold its pipes open
            for reader in readers:
                reader.join(_END_S)
            self._held = [pipe for pipe, reader in zip(pipes, readers, strict=True) if reader.is_alive()]
        finally:
            code = self.close()
        out, err = (bytes(text) for text in (*texts, bytearray(), bytearray())[:2])
        return Ended(code, late, out, err, processor)

    def _processor_time(self) -> float:
        """Return the processor time of the process, which may have ended but is not reaped, and of all that it has reaped [s]."""
        with contextlib.suppress(OSError):
            fields = Path(f"/proc/{self.pid}/stat").read_bytes().rpartition(b")")[2].split()
            return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")  # proc(5): utime, stime, cutime, cstime
        return 0.0


def start(
    words: Sequence[str],
    *,
    module: str | None = None,
    limits: Limits = Limits(),
    environment: Mapping[str, str] | None = None,
    folder: str | None = None,
    stdin: int = NOWHERE,
    stderr: int | None = PIPE,
    stdout: int = PIPE,
    files: Collection[int] = (),
) -> Child:
    """Start a process.

    Args:
        words: A program's absolute path and its arguments; with `module` the arguments alone.
        module: A module of articad to run instead of a program.
        limits: Its resource limits.
        environment: All variables that it gets, as given; by default `environment()`, with HOME and TMPDIR in its private folder.
        folder: Its working folder, instead of a private one.
        stdin: An open file, `PIPE`, `NOWHERE`, or None for that of this process.
        stdout: The same.
        stderr: The same.
        files: Open files that it inherits under the same numbers.

    Raises:
        OSError: If the system starts no process.
    """
    own = scratch.folder("child") if folder is None else None
    place = own.name if own is not None else folder
    variables = _variables(environment, own.name if own is not None else None, module is not None)
    order = {"parent": os.getpid(), "limits": limits.resources(), "module": module, "environment": sorted(variables)}
    lean = [] if module else ["-S"]  # a program needs none of Python's packages
    command = [sys.executable, "-I", *lean, _CHILD, json.dumps(order), *words]
    try:
        process = subprocess.Popen(  # noqa: S603 - this interpreter, our module
            command,
            cwd=place,
            env=variables,
            stdin=stdin,
            stdout=stdout,
            stderr=stderr,
            pass_fds=tuple(files),
            start_new_session=True,
        )
    except OSError:
        if own is not None:
            own.cleanup()
        raise
    return Child(process, own, limits, watched=module is None and sys.platform == "linux")


def run(
    words: Sequence[str],
    *,
    module: str | None = None,
    limits: Limits,
    environment: Mapping[str, str] | None = None,
    folder: str | None = None,
    merged: bool = False,
    files: Collection[int] = (),
) -> Ended:
    """Run a process to its end or to the end of its time.

    Args:
        words: See `start`.
        module: See `start`.
        limits: See `start`.
        environment: See `start`.
        folder: See `start`.
        merged: Whether stderr is merged into `out`, in the order of writing.
        files: See `start`.

    Raises:
        OSError: If the system starts no process.
    """
    stderr = subprocess.STDOUT if merged else PIPE
    return start(words, module=module, limits=limits, environment=environment, folder=folder, stderr=stderr, files=files).finish()


def environment(*more: str) -> dict[str, str]:
    """Return the variables of this process that a child needs: language, libraries, threads, and the named ones; paths are absolute.

    Args:
        more: Further variables; a name that ends with `_` stands for all that begin with it.
    """
    names = (*_BASIC, *more)
    prefixes = tuple(name for name in names if name.endswith("_"))
    return _for_child({name: value for name, value in os.environ.items() if name in names or name.startswith(prefixes)})


def environment_with_keys() -> dict[str, str]:
    """Return all variables of this process except Python's own, for a child that calls a model: providers choose the names of keys."""
    return _for_child({name: value for name, value in os.environ.items() if not name.startswith("PYTHON")})


@contextlib.contextmanager
def safe_path() -> Iterator[None]:
    """Keep processes that a library starts by itself from taking programs, libraries and modules from the working folder.

    The import of mujoco imports glfw, which runs `python -c` to ask a library for its version; `webbrowser` runs what the PATH offers.
    """
    before = {name: value for name, value in os.environ.items() if name == _SAFE_PATH or _is_searched(name)}
    kept = _without_working_folder(before) | {_SAFE_PATH: "1"}
    _exchange(before, kept)
    try:
        yield
    finally:
        _exchange(kept, before)


def which(name: str, path: str | None = None) -> str | None:
    """Return the path of a program, searched in the absolute folders of the PATH: an empty entry would mean the working folder.

    Args:
        name: Name of the program.
        path: Search path instead of this process's PATH.
    """
    folders = (os.environ.get("PATH", os.defpath) if path is None else path).split(os.pathsep)
    return shutil.which(name, path=os.pathsep.join(filter(os.path.isabs, folders)) or "/nonexistent")


def _variables(given: Mapping[str, str] | None, private: str | None, is_ours: bool) -> dict[str, str]:
    """Return the environment of a child: scratch files of ours go to its private folder, and so does its HOME if it needs none."""
    variables = _without_working_folder(environment() if given is None else given)
    if private is not None and (is_ours or given is None):
        variables |= {"TMPDIR": private, "HOME": variables.get("HOME", private)}
    if is_ours:
        variables |= {_SAFE_PATH: "1", "MUJOCO_GL": "disable"}  # for processes that its libraries start; MuJoCo draws nothing here
    return variables


def _for_child(variables: Mapping[str, str]) -> dict[str, str]:
    """Return variables that mean the same in the working folder of a child."""
    absolute = {name: os.path.abspath(variables[name]) for name in _PATHS if variables.get(name)}  # noqa: PTH100 - texts, as they are
    return _without_working_folder({**variables, **absolute})


def _without_working_folder(variables: Mapping[str, str]) -> dict[str, str]:
    """Leave out the entries of search paths that are not absolute: an empty or relative one means the working folder."""
    kept = {}
    for name, value in variables.items():
        if not _is_searched(name):
            kept[name] = value
            continue
        entries = value.replace(" ", os.pathsep) if name == "LD_PRELOAD" else value
        if absolute := [entry for entry in entries.split(os.pathsep) if os.path.isabs(entry)]:  # noqa: PTH117 - texts, as they are
            kept[name] = os.pathsep.join(absolute)
    return kept


def _is_searched(name: str) -> bool:
    """Return whether a variable lists places from which programs or libraries are taken."""
    return name in _SEARCHED or (name.startswith(_OF_LIBRARIES) and name.endswith(_PLACES))


def _exchange(old: Mapping[str, str], new: Mapping[str, str]) -> None:
    """Replace variables of this process by others."""
    for name in old.keys() - new.keys():
        os.environ.pop(name, None)
    os.environ.update(new)


def _drain(stream: IO[bytes], tail: bytearray) -> None:
    """Read a stream to its end and keep its tail: a program may write any amount."""
    with contextlib.suppress(OSError, ValueError):  # closed meanwhile
        while piece := os.read(stream.fileno(), 65536):
            tail += piece
            if len(tail) > OUTPUT:
                del tail[: len(tail) - OUTPUT]
