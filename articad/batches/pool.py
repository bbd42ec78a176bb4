"""Parallel calls: in processes of this machine, or on a Dask cluster; a process that dies loses only its own call.

Every call runs in a worker process, `articad.batches.worker`, with limited memory: a Dask worker has one for each of its threads, so that
a crash in native code ends that process and not the cluster's. A worker ends when the process that started it does, or after minutes
without a call: a finished batch leaves nothing on a cluster.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Self

from articad.aliases import Json
from articad.errors import ReadError
from articad.processes import launcher

Told = Callable[[Json], object]

RETRIES: Final = 2  # of a call whose worker died
_LEAVE_SECONDS: Final = 2.0  # for a worker to end after its pipe is closed
IDLE_SECONDS: Final = 300.0  # after which an idle worker ends
MEMORY_GB: Final = 4.0  # of a worker, without its kernel's processes, which have limits of their own


@dataclass(frozen=True)
class Call:
    """A call for a worker.

    Attributes:
        function: `module:name` of a function that takes the arguments and returns JSON.
        arguments: JSON.
        key: Identifies the call: the same key is the same work.
        needs_keys: Whether it calls models.
    """

    function: str
    arguments: Mapping[str, Any]
    key: str
    needs_keys: bool = False

    def to_json(self) -> Json:
        """Return the line that a worker reads."""
        return {"function": self.function, "arguments": dict(self.arguments), "key": self.key, "needs_keys": self.needs_keys}


def run_local(
    calls: Sequence[Call],
    *,
    workers: int | None = None,
    retries: int = RETRIES,
    memory_gb: float = MEMORY_GB,
    told: Told | None = None,
) -> list[Json]:
    """Make calls in processes of this machine.

    Args:
        calls: What to do.
        workers: Number of parallel processes; the number of processors by default.
        retries: How often a call is tried again whose worker died.
        memory_gb: Data of a worker beyond which its allocations fail.
        told: Called with each answer, from several threads.

    Returns:
        The calls' answers, in order.
    """
    todo: queue.SimpleQueue[int] = queue.SimpleQueue()
    for index in range(len(calls)):
        todo.put(index)
    answers: list[Json] = [{} for _ in calls]

    def serve() -> None:
        with Worker(memory_gb) as worker:
            while True:
                try:
                    index = todo.get_nowait()
                except queue.Empty:
                    return
                answers[index] = worker.tried(calls[index], retries)
                if told is not None:
                    told(answers[index])

    threads = [threading.Thread(target=serve) for _ in range(min(workers or os.cpu_count() or 1, max(len(calls), 1)))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return answers


def run_dask(
    calls: Sequence[Call],
    *,
    scheduler: str | None = None,
    retries: int = RETRIES,
    memory_gb: float = MEMORY_GB,
    told: Told | None = None,
    client: Any = None,
) -> list[Json]:
    """Make calls on a Dask cluster, whose workers must see the folders that the calls name.

    Args:
        calls: What to do.
        scheduler: Its address.
        retries: How often a call is tried again; those of a Dask worker that died go to another one by themselves.
        memory_gb: As for `run_local`, for each thread of a Dask worker.
        told: Called with each answer as it comes.
        client: A client to use instead of a new one.

    Raises:
        ReadError: If Dask is not installed.
    """
    try:
        from distributed import Client, as_completed  # noqa: PLC0415 - an extra
    except ImportError as error:
        message = "Dask is not installed: pip install 'articad[batch]'."
        raise ReadError.at("dask", message, "Install it, or leave --engine out.", said=message) from error
    own = client is None
    client = client or Client(scheduler)
    try:
        futures = [client.submit(_remote, call.to_json(), memory_gb, retries, key=call.key, retries=retries, pure=True) for call in calls]
        for done in as_completed(dict.fromkeys(futures)):
            if told is not None:
                told(_answer(done))
        return [_answer(future) for future in futures]
    finally:
        if own:
            client.close()


_MINE = threading.local()  # the worker of this thread of a Dask worker


def _remote(stored: Json, memory_gb: float, retries: int) -> Json:
    worker = getattr(_MINE, "worker", None)
    if worker is None:
        worker = _MINE.worker = Worker(memory_gb)
    return worker.tried(Call(stored["function"], stored["arguments"], stored["key"], stored["needs_keys"]), retries)


def _answer(future: Any) -> Json:
    """Return a call's answer, or why there is none, for example because a Dask worker died repeatedly."""
    error = future.exception()
    if error is not None:
        return _never(future.key, f"{type(error).__name__}: {error}")
    return dict(future.result())


def _never(key: str, error: str) -> Json:
    return {"ok": False, "digest": key, "made": "never", "error": error}


class Worker:
    """A process that answers one call after another; started at the first call, and again after it ended."""

    def __init__(self, memory_gb: float, *, idle: float = IDLE_SECONDS) -> None:
        self._memory, self._idle, self._has_keys = memory_gb, idle, False
        self._process: launcher.Child | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def tried(self, call: Call, retries: int) -> Json:
        """Return the answer to a call; if the process dies, the call is tried again up to `retries` times."""
        for _ in range(1 + retries):
            answer = self._answer(call)
            if answer is not None:
                return answer
        return _never(call.key, f"Its worker died {1 + retries} times.")

    def _answer(self, call: Call) -> Json | None:
        process = self._running(call)
        try:
            process.stdin.write(json.dumps(call.to_json()).encode() + b"\n")
            process.stdin.flush()
            answer = process.stdout.readline()
        except OSError:
            answer = b""
        if answer.endswith(b"\n"):  # otherwise it died in the middle of its line
            return dict(json.loads(answer))
        self._end()
        return None

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        with contextlib.suppress(OSError):  # a line that a dead worker did not read
            process.stdin.close()
        process.wait(_LEAVE_SECONDS)
        process.close()

    def _running(self, call: Call) -> launcher.Child:
        """Return the process; it gets the user's keys only if calls need them."""
        if self._process is not None and (self._process.ended() or call.needs_keys != self._has_keys):
            self._end()
        if self._process is None:
            self._has_keys = call.needs_keys
            self._process = launcher.start(
                [str(self._idle)],
                module="articad.batches.worker",
                limits=launcher.Limits(memory=int(self._memory * 2**30)),
                environment=launcher.environment_with_keys() if self._has_keys else launcher.environment(*launcher.OWN),
                stdin=launcher.PIPE,
                stderr=None,
            )
        return self._process
