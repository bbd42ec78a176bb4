"""The zygote: imports the B-rep kernel once, then forks a confined process for each job. Started by `zygote.py`.

It listens on the socket that is its stdin. A request is one JSON object with open files attached; its answer is one JSON object when the
job's process has ended. It holds no secret, starts with an empty environment, and never runs a script itself. When its parent ends, it
ends, and kills every job.
"""

from __future__ import annotations

import ctypes
import faulthandler
import gc
import json
import math
import os
import selectors
import signal
import socket
import sys
import time
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

from articad.kernels import sandbox
from articad.kernels.timers import OUT_OF_TIME, WAITING

MESSAGE = 65536  # bytes of a request; a job itself travels in a file
FILES = 8  # open files attached to a request, at most
_PR_SET_DUMPABLE, _PR_SET_CHILD_SUBREAPER = 4, 36
FENCE_SECONDS = 2.0  # a job that survives its own timers is killed this much later

Json = dict[str, Any]


@dataclass
class _Job:
    number: int
    deadline: float  # for its first report; its own timers come before it
    last: float  # for everything after the report, such as the dimension probe
    report: int
    fault: int  # a pipe that says why the sandbox could not be set up; a script has no access to it
    late: bool = False


class ZygoteServer:
    """Serves requests until its socket closes."""

    def __init__(self, control: socket.socket, tasks: Mapping[str, Callable[[Json, dict[str, int]], None]]) -> None:
        self._control, self._tasks = control, tasks
        self._jobs: dict[int, _Job] = {}
        self._readable = sandbox.readable_paths()
        self._wake, wakened = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
        signal.set_wakeup_fd(wakened)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        self._selector = selectors.DefaultSelector()
        self._selector.register(control, selectors.EVENT_READ)
        self._selector.register(self._wake, selectors.EVENT_READ)

    def serve(self) -> None:
        """Fork for each request, answer for each child that ended, kill what is late."""
        while True:
            pause = min((job.deadline for job in self._jobs.values()), default=math.inf) - time.monotonic()
            for key, _ in self._selector.select(None if math.isinf(pause) else max(pause, 0.0)):
                if key.fileobj is self._control and not self._accept():
                    return
                if key.fd == self._wake:
                    os.read(self._wake, 4096)
            for pid, job in self._jobs.items():
                if time.monotonic() > job.deadline:
                    self._fence(pid, job)
            self._reap()

    def _fence(self, pid: int, job: _Job) -> None:
        """Kill a job that survived its own alarm; if it has reported by now, it has the time for what follows the report."""
        if job.deadline < job.last and os.fstat(job.report).st_size:
            job.deadline = job.last
            return
        job.late, job.deadline = True, math.inf
        os.kill(pid, signal.SIGKILL)

    def kill_all(self) -> None:
        """Kill every job, and every process that a job left behind."""
        for pid in (*self._jobs, *_children()):
            os.kill(pid, signal.SIGKILL)

    def _accept(self) -> bool:
        """Start the job of one request; False when the parent has closed the socket."""
        message, files, _, _ = socket.recv_fds(self._control, MESSAGE, FILES)
        if not message:
            return False
        request = json.loads(message)
        parent = os.getpid()
        fault, faulty = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
        try:
            pid = os.fork()
        except OSError as error:
            os.close(fault)
            os.close(faulty)
            self._control.send(json.dumps({"id": request["id"], "refused": str(error)}).encode())
            return True
        if pid == 0:
            self._become(request, dict(zip(request["files"], files, strict=True)), parent, faulty)
        report = os.dup(files[request["files"].index("report")])
        for file in (*files, faulty):
            os.close(file)
        limits = request["limits"]
        deadline = time.monotonic() + WAITING * limits["seconds"] + FENCE_SECONDS
        self._jobs[pid] = _Job(request["id"], deadline, deadline + limits["probe_seconds"], report, fault)
        return True

    def _become(self, request: Json, files: dict[str, int], parent: int, faulty: int) -> NoReturn:
        """Confine this child process, do the job, exit."""
        status, confined = 70, False
        try:
            os.setsid()
            sandbox.die_with_parent(signal.SIGKILL, parent)
            signal.set_wakeup_fd(-1)
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            _keep_only((*files.values(), faulty))
            _trace_crashes(files["crash"])
            sandbox.confine(sandbox.ScriptLimits(**request["limits"]), request["layers"], self._readable)
            os.close(faulty)
            confined = True
            self._tasks[request["task"]](request, files)
            status = 0
        except BaseException as error:  # noqa: BLE001 - nothing may return into the zygote's loop
            os.write(files["crash"] if confined else faulty, f"worker: {type(error).__name__}: {error}".encode()[:500])
        finally:
            os._exit(status)

    def _reap(self) -> None:
        while True:
            try:
                pid, status, usage = os.wait4(-1, os.WNOHANG)
            except ChildProcessError:
                return
            if pid == 0:
                return
            for orphan in _children() - set(self._jobs):  # left by a script that could fork, on a machine without seccomp
                os.kill(orphan, signal.SIGKILL)
            job = self._jobs.pop(pid, None)
            if job is not None:
                os.close(job.report)
                answer: Json = {"id": job.number, "status": status, "late": job.late, "peak": usage.ru_maxrss * 1024}
                answer["cpu"] = usage.ru_utime + usage.ru_stime
                answer["unconfined"] = _last_words(job.fault)
                self._control.send(json.dumps(answer).encode())


def main() -> None:
    """Import the kernel, report that it is ready, serve."""
    control = socket.socket(fileno=0)
    sandbox.die_with_parent(signal.SIGKILL, os.getppid())
    _prepare_process()
    try:
        from articad.kernels.tasks import TASKS  # noqa: PLC0415 - the import that each fork is spared; it may fail

        _keep_to_one_thread()
    except ImportError as error:
        control.send(json.dumps({"ready": False, "problem": str(error)[:500]}).encode())
        return
    _hide_articad()
    gc.collect()
    gc.freeze()  # a collection in a child would copy every shared page
    control.send(json.dumps({"ready": True}).encode())
    zygote = ZygoteServer(control, TASKS)
    try:
        zygote.serve()
    finally:
        zygote.kill_all()


def _keep_to_one_thread() -> None:
    """Make OCCT work in the calling thread: the sandbox allows no others, and OCCT waits forever for one that cannot start."""
    from OCP.OSD import OSD_ThreadPool  # noqa: PLC0415 - as above

    OSD_ThreadPool.DefaultPool_s(1)


def _hide_articad() -> None:
    """Make `import articad` fail in every fork: the contract forbids it to part scripts, and this enforces it."""
    for name in [name for name in sys.modules if name.partition(".")[0] == "articad"]:
        del sys.modules[name]
    sys.modules["articad"] = None  # type: ignore[assignment]


def _keep_only(files: Collection[int]) -> None:
    """Close everything but a job's files; stdin, stdout and stderr lead nowhere."""
    null = os.open("/dev/null", os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(null, stream)
    kept = {0, 1, 2, *files}
    for number in range(3, max(kept) + 1):
        if number not in kept:
            try:
                os.close(number)
            except OSError:
                continue
    os.closerange(max(kept) + 1, 1024)


def _trace_crashes(file: int) -> None:
    """Write Python's frames when a signal ends the process, including the alarm: they show where a loop was."""
    faulthandler.enable(file, all_threads=False)
    for name in OUT_OF_TIME:
        faulthandler.register(signal.Signals[name], file, all_threads=True, chain=True)


def _last_words(pipe: int) -> str:
    """Return the content of a pipe, and close it."""
    try:
        return os.read(pipe, 500).decode(errors="replace")
    except BlockingIOError:
        return ""
    finally:
        os.close(pipe)


def _children() -> set[int]:
    """Return the ids of the child processes, adopted ones included; empty if /proc does not list them."""
    try:
        with open(f"/proc/self/task/{os.getpid()}/children", encoding="ascii") as listed:  # noqa: PTH123 - no pathlib in the loop
            return set(map(int, listed.read().split()))
    except OSError:
        return set()


def _prepare_process() -> None:
    libc = ctypes.CDLL(None)
    libc.prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)  # orphans of a job become children of this process, which kills them
    libc.prctl(_PR_SET_DUMPABLE, 0, 0, 0, 0)  # no job may trace this process or read its memory, whatever layers there are
