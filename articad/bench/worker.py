"""A worker: reads a call a line, does it, answers with a line.

It ends when there are no more lines, when nobody has called it for long, or when whoever started it is gone.

python -m articad.bench.worker MEMORY_GB PARENT IDLE_SECONDS
"""

from __future__ import annotations

import ctypes
import importlib
import json
import os
import resource
import select
import signal
import sys
from collections.abc import Callable, Mapping
from typing import Any, Final

from articad.errors import ArticadError

Json = dict[str, Any]

CALLS: Final[Mapping[str, str]] = {
    "item": "articad.bench.items:make_stored",
    "task": "articad.bench.remote:run_stored",
    "score": "articad.bench.remote:score_stored",
}
"""Calls that a worker knows, and where each is written."""

_PR_SET_PDEATHSIG: Final = 1


def main() -> int:
    """Serve; return the exit code."""
    memory, parent, idle = float(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever else is printed goes to the terminal, not between the answers
    resource.setrlimit(resource.RLIMIT_DATA, (int(memory * 2**30), resource.RLIM_INFINITY))
    if not _ends_with(parent):
        return 0
    # A call comes when the one before is answered, so that no second line is read ahead.
    while select.select([sys.stdin], [], [], idle)[0] and (line := sys.stdin.readline()):
        answers.write(json.dumps(_answer(json.loads(line))) + "\n")
        answers.flush()
    return 0


def _answer(stored: Json) -> Json:
    """Return the answer to a call; an error is one, so that the next call finds a worker."""
    module, name = CALLS[stored["call"]].split(":")
    function: Callable[..., Json] = getattr(importlib.import_module(module), name)
    try:
        return function(**stored["arguments"])
    except (ArticadError, MemoryError) as error:
        return {"ok": False, "digest": stored["key"], "made": "never", "error": f"{type(error).__name__}: {error}"}


def _ends_with(parent: int) -> bool:
    """Have the system end this process with the one that started it, where it can; False if that one is gone already."""
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
    return os.getppid() == parent


if __name__ == "__main__":
    sys.exit(main())
