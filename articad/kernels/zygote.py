"""The parent's end of the worker: starts the zygote, sends it jobs, starts another one if it has died."""

from __future__ import annotations

import atexit
import contextlib
import itertools
import json
import os
import signal
import socket
import sys
import threading
import weakref
from collections.abc import Collection, Mapping
from concurrent.futures import Future
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, ClassVar

from articad.errors import KernelUnavailableError
from articad.findings import Finding
from articad.kernels import sandbox
from articad.kernels.libraries import install_line, missing_libraries
from articad.kernels.timers import WAITING
from articad.processes import launcher

START_SECONDS = 180.0  # the import takes 2 s, on a cold and busy disk 10 s
SILENCE_SECONDS = 30.0  # after this time a zygote that should have killed a job counts as dead
_LEAVE_SECONDS = 2.0  # for a zygote to end after its socket is closed
_ANSWER = 4096
_ROOT = str(Path(__file__).parents[2])
# -P and -s: neither the current folder nor the user's own packages are on the path. -B: nothing is written beside sources.
_BOOT = f"import sys; sys.path.insert(0, {_ROOT!r}); from articad.kernels.worker import main; sys.path.remove({_ROOT!r}); main()"


class ZygoteDiedError(Exception):
    """The zygote ended while a job was running; the job may be sent to the next one."""


@dataclass(frozen=True)
class JobOutcome:
    """How a job's process ended.

    Attributes:
        exit_code: Its exit code, or None if a signal ended it.
        signal: The signal that ended it, or 0.
        late: Whether the zygote killed it at its deadline.
        peak: Its largest memory [bytes].
        cpu: Its processor time [s].
        refused: Why no process could be started; empty if one was.
        unconfined: Why the sandbox could not be set up, so that nothing was done; empty if it was.
    """

    exit_code: int | None
    signal: int
    late: bool
    peak: int
    cpu: float = 0.0
    refused: str = ""
    unconfined: str = ""

    @property
    def ok(self) -> bool:
        """True if it ended regularly."""
        return self.exit_code == 0


class Zygote:
    """A process that has imported the kernel and forks a confined one for each job; many threads may submit jobs."""

    _shared: ClassVar[dict[frozenset[str], Zygote]] = {}
    _shared_lock = threading.Lock()

    @classmethod
    def shared(cls, layers: Collection[str]) -> Zygote:
        """Return the one zygote of this process that applies these layers."""
        with cls._shared_lock:
            return cls._shared.setdefault(frozenset(layers), cls(layers))

    def __init__(self, layers: Collection[str]) -> None:
        self.users: weakref.WeakSet[object] = weakref.WeakSet()  # objects that still need it
        self._layers = tuple(layer for layer in sandbox.LAYERS if layer in layers)
        self._lock = threading.Lock()
        self._numbers = itertools.count(1)
        self._waiting: dict[int, Future[JobOutcome]] = {}
        self._control: socket.socket | None = None
        self._process: launcher.Child | None = None
        self._owner = 0

    def run(self, task: str, files: Mapping[str, int], limits: sandbox.ScriptLimits) -> JobOutcome:
        """Do one job and wait for its end.

        Args:
            task: Name of the task.
            files: Open files by the task's names for them; a dying process writes its last output to `crash`.
            limits: Resources that it may use.

        Raises:
            ZygoteDiedError: If the zygote died meanwhile.
            KernelUnavailableError: If it could not be started.
        """
        answer: Future[JobOutcome] = Future()
        with self._lock:
            control = self._started()
            number = next(self._numbers)
            request = {"id": number, "task": task, "files": list(files), "limits": asdict(limits), "layers": self._layers}
            self._waiting[number] = answer
            try:
                socket.send_fds(control, [json.dumps(request).encode()], list(files.values()))
            except OSError as error:
                del self._waiting[number]
                raise ZygoteDiedError from error
        try:
            return answer.result(WAITING * limits.seconds + limits.probe_seconds + SILENCE_SECONDS)
        except TimeoutError as error:  # stopped or broken by a script, on a machine whose layers cannot prevent it
            self._waiting.pop(number, None)
            self._kill(control)
            raise ZygoteDiedError from error

    @property
    def pid(self) -> int | None:
        """Id of the process that was started, for tests and for people; None before the first job."""
        return None if self._process is None else self._process.pid

    def start(self) -> None:
        """Start the process now, if it does not run.

        Raises:
            KernelUnavailableError: If it could not be started.
        """
        with self._lock:
            self._started()

    def close(self) -> None:
        """End the zygote and everything it runs; the next job starts another one."""
        with self._lock:
            self._stop()

    def _started(self) -> socket.socket:
        """Return the socket to a running zygote; start one if there is none or if this process is a fork of its owner."""
        alive = self._process is not None and not self._process.ended() and self._owner == os.getpid()
        if alive and self._control is not None:
            return self._control
        if self._owner == os.getpid():
            self._stop()
        self._owner, self._waiting = os.getpid(), {}
        ready: Future[socket.socket] = Future()
        # This thread lives as long as the zygote: the kernel kills the zygote when the thread that started it ends.
        threading.Thread(target=self._attend, args=(ready,), name="articad-zygote", daemon=True).start()
        self._control = ready.result()
        atexit.register(self.close)
        return self._control

    def _kill(self, control: socket.socket) -> None:
        with self._lock:
            if self._control is control and self._process is not None:
                self._process.kill()

    def _stop(self) -> None:
        if self._control is not None:
            with contextlib.suppress(OSError):
                self._control.shutdown(socket.SHUT_RDWR)
            self._control = None
        if self._process is not None and self._owner == os.getpid():
            self._process.wait(_LEAVE_SECONDS)
            self._process.close()
        self._process = None
        atexit.unregister(self.close)

    def _attend(self, ready: Future[socket.socket]) -> None:
        """Start the zygote and deliver its answers until it ends."""
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        waiting = self._waiting
        try:
            with theirs:
                process = self._spawn(theirs)
            self._process = process
            _greeted(ours, process)
        except Exception as error:  # noqa: BLE001 - whoever waits for the socket must be told whatever happened
            ready.set_exception(_unavailable(str(error)) if isinstance(error, OSError) else error)
            ours.close()
            return
        ready.set_result(ours)
        with ours, contextlib.suppress(OSError):
            while message := ours.recv(_ANSWER):
                answer = json.loads(message)
                future = waiting.pop(answer["id"], None)
                if future is not None and not future.done():
                    future.set_result(_outcome(answer))
        for future in list(waiting.values()):
            if not future.done():
                future.set_exception(ZygoteDiedError("the worker's process ended"))

    def _spawn(self, control: socket.socket) -> launcher.Child:
        command = [sys.executable, "-P", "-s", "-B", "-c", _BOOT]
        if "bwrap" in self._layers:
            command = sandbox.bubblewrap_command(command)
        nowhere = launcher.NOWHERE
        return launcher.start(command, environment=sandbox.ENVIRONMENT, folder="/", stdin=control.fileno(), stdout=nowhere, stderr=nowhere)


def _greeted(control: socket.socket, process: launcher.Child) -> None:
    """Wait until a worker says that it is ready.

    Raises:
        KernelUnavailableError: If it says why it is not; then it is closed.
    """
    control.settimeout(START_SECONDS)
    hello = json.loads(control.recv(_ANSWER) or b'{"problem": "it ended before it was ready"}')
    if not hello.get("ready"):
        process.close()
        raise _unavailable(str(hello.get("problem")))
    control.settimeout(None)


def _outcome(answer: dict[str, Any]) -> JobOutcome:
    if "refused" in answer:
        return JobOutcome(None, 0, late=False, peak=0, refused=str(answer["refused"]))
    status = int(answer["status"])
    signaled = os.WIFSIGNALED(status)
    return JobOutcome(
        None if signaled else os.WEXITSTATUS(status),
        os.WTERMSIG(status) if signaled else 0,
        late=bool(answer["late"]),
        peak=int(answer["peak"]),
        cpu=float(answer["cpu"]),
        unconfined=str(answer.get("unconfined", "")),
    )


def _unavailable(problem: str) -> KernelUnavailableError:
    missing = missing_libraries()
    how = install_line(missing) if missing else "pip install 'build123d>=0.13,<0.14'"
    what = f"The build123d kernel could not be loaded: {problem}."
    finding = Finding(code="E_KERNEL_UNAVAILABLE", where="kernels.build123d", message=what, hint=f"Run: {how}")
    return KernelUnavailableError(f"{what} Run: {how}", looked_in=(sys.executable,), how_to_get=how, findings=[finding])


def ends_by(outcome: JobOutcome) -> str:
    """Return the name of the signal that ended a job, as `SIGSEGV`; empty if none did."""
    return signal.Signals(outcome.signal).name if outcome.signal else ""
