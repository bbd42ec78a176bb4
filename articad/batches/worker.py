"""A worker: reads one call per line, does it, answers with one line.

It ends when there are no more lines, or after a time without a call [s], which is its only argument.
"""

from __future__ import annotations

import importlib
import json
import os
import select
import sys
from collections.abc import Callable
from typing import Any

from articad.errors import ArticadError

Json = dict[str, Any]


def main() -> int:
    """Serve; return the exit code."""
    idle = float(sys.argv[1])
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # other output goes to the terminal, not between the answers
    # A call comes only after the one before is answered, so no second line is buffered.
    while select.select([sys.stdin], [], [], idle)[0] and (line := sys.stdin.readline()):
        answers.write(json.dumps(_answer(json.loads(line))) + "\n")
        answers.flush()
    return 0


def _answer(stored: Json) -> Json:
    """Return the answer to a call; an error is an answer too, so the worker survives for the next call."""
    module, name = stored["function"].split(":")
    function: Callable[..., Json] = getattr(importlib.import_module(module), name)
    try:
        return function(**stored["arguments"])
    except (ArticadError, MemoryError) as error:
        return {"ok": False, "digest": stored["key"], "made": "never", "error": f"{type(error).__name__}: {error}"}


if __name__ == "__main__":
    sys.exit(main())
