"""Calls of models, each in a process of its own with a deadline and a memory limit; `provider.py` is the other end.

LiteLLM is imported once, in a process that this module starts, and never in the user's process.
"""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import socket
import sys
import threading
import time
from concurrent.futures import Future
from typing import Any, ClassVar, Final

from articad.aliases import Json
from articad.processes import launcher

START_S: Final = 180.0  # the import takes 2 s, on a cold and busy disk 10 s
DESCRIBE_S: Final = 30.0  # to look up LiteLLM's data about some models, without network
_GRACE_S: Final = 0.5  # after a deadline, until the end of a killed process is visible
_LARGEST: Final = (
    64 * 2**20
)  # bytes of an answer between the two processes; JSON escapes and vectors of numbers need more than the body itself
_LOST: Final = {"error": {"kind": "lost", "status": None, "text": "its process ended without an answer", "retry_after": ""}}
_LATE: Final = {"error": {"kind": "late", "status": None, "text": "", "retry_after": ""}}


class Calls:
    """A process that has imported LiteLLM and forks another one for each call. Many threads may call it."""

    _shared: ClassVar[Calls | None] = None
    _shared_lock = threading.Lock()

    @classmethod
    def shared(cls) -> Calls:
        """Return the `Calls` object of this process."""
        with cls._shared_lock:
            if cls._shared is None:
                cls._shared = cls()
            return cls._shared

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: launcher.Child | None = None
        self._control: socket.socket | None = None
        self._owner = 0

    @property
    def pid(self) -> int | None:
        """Id of the process that was started, which leads the process group of all calls; None before the first call."""
        return None if self._process is None else self._process.pid

    def ask(self, do: str, seconds: float, **words: Any) -> Json:
        """Run a task of `provider.py` and return its answer, or `{"error": {...}}`.

        Args:
            do: The task.
            seconds: Time after which the task is killed. The time to start the process that imports LiteLLM is not counted.
            words: Arguments of the task, as JSON.

        Raises:
            OSError: If no process can be started, or LiteLLM cannot be imported there.
        """
        order = {"do": do, "seconds": max(seconds, 0.01), "environment": launcher.environment_with_keys()} | words
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        with ours:
            with theirs:
                self._hand_over(theirs)
            until = time.monotonic() + seconds
            try:
                answer = _exchanged(ours, json.dumps(order).encode(), until)
            except TimeoutError:
                return _LATE
            except OSError:
                answer = b""
        if answer:
            told: Json = json.loads(answer)
            return told
        return _LATE if time.monotonic() >= until - _GRACE_S / 2 else _LOST

    def close(self) -> None:
        """End the process and all calls; the next call starts a new process."""
        with self._lock:
            self._stop()

    def _hand_over(self, line: socket.socket) -> None:
        """Send the far end of a socket to the process; start one if none runs or if this process is a fork of its owner."""
        with self._lock:
            for is_last in (False, True):
                control = self._started()
                try:
                    socket.send_fds(control, [b"call"], [line.fileno()])
                except OSError:
                    self._stop()
                    if is_last:
                        raise
                else:
                    return

    def _started(self) -> socket.socket:
        is_ours = self._owner == os.getpid()
        if is_ours and self._control is not None and self._process is not None and not self._process.ended():
            return self._control
        if is_ours:
            self._stop()
        if not hasattr(os, "fork") or not hasattr(socket, "send_fds"):
            raise OSError(f"models are not called on {sys.platform}; use Linux, WSL 2 or a container")
        self._owner = os.getpid()
        ready: Future[socket.socket] = Future()
        # This thread lives as long as the process: the kernel kills a child when the thread that started it ends.
        threading.Thread(target=self._attend, args=(ready,), name="articad-models", daemon=True).start()
        self._control = ready.result()
        atexit.register(self.close)
        return self._control

    def _attend(self, ready: Future[socket.socket]) -> None:
        """Start the process, and wait until it ends."""
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            with theirs:
                process = launcher.start(
                    [],
                    module="articad.agents.provider",
                    environment=launcher.environment_with_keys(),
                    stdin=theirs.fileno(),
                    stdout=launcher.NOWHERE,
                    stderr=launcher.NOWHERE,
                )
            self._process = process
            ours.settimeout(START_S)
            if ours.recv(16) != b"ready":
                process.close()
                raise OSError("LiteLLM cannot be imported; `articad doctor` says more")  # noqa: TRY301 - as other failures of a start
            ours.settimeout(None)
        except OSError as error:
            ours.close()
            ready.set_exception(error)
            return
        ready.set_result(ours)
        with contextlib.suppress(OSError):
            ours.recv(1)  # returns when the process has ended

    def _stop(self) -> None:
        if self._control is not None:
            with contextlib.suppress(OSError):
                self._control.shutdown(socket.SHUT_RDWR)
            self._control.close()
            self._control = None
        if self._process is not None and self._owner == os.getpid():
            self._process.close()
        self._process = None
        atexit.unregister(self.close)


def _exchanged(line: socket.socket, order: bytes, until: float) -> bytes:
    """Send a request and return the answer, empty if there is none.

    Raises:
        TimeoutError: If the time is over.
    """
    line.settimeout(_left(until))
    line.sendall(order)
    line.shutdown(socket.SHUT_WR)
    answer = bytearray()
    with contextlib.suppress(ConnectionResetError):
        while True:
            line.settimeout(_left(until))
            piece = line.recv(65536)
            answer += piece
            if not piece or len(answer) > _LARGEST:
                break
    return bytes(answer) if len(answer) <= _LARGEST else b""


def _left(until: float) -> float:
    left = until + _GRACE_S - time.monotonic()
    if left <= 0:
        raise TimeoutError
    return left
