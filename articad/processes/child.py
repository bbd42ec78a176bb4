"""The first lines of every child process. `articad.processes.launcher` runs this file as `python -I child.py ORDER WORDS...`.

ORDER is a JSON object:
- `parent`: the process that started this one; when it ends, the kernel kills this one (Linux).
- `limits`: soft and hard resource limits by their names in `resource`.
- `module`: the module of articad to run, with WORDS as its arguments; or null: WORDS are a program to become.
- `environment`: the names of the variables that the program keeps. Python adds LC_CTYPE to an empty environment.

`-I` keeps the working folder, PYTHONPATH and the user's own packages off the path. The imported articad is the one that contains this file. Only the standard library is used here.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from typing import Any, Final

_PR_SET_PDEATHSIG: Final = 1


def main() -> None:
    """Carry out the order."""
    order: dict[str, Any] = json.loads(sys.argv[1])
    words = sys.argv[2:]
    _end_with(order["parent"])
    _limit(order["limits"])
    if order["module"] is None:
        kept = {name: os.environ[name] for name in order["environment"]}
        try:
            os.execve(words[0], words, kept)  # noqa: S606 - the words are articad's own, and no shell reads them
        except OSError as error:
            sys.exit(f"{words[0]}: {error.strerror}")
    _run(order["module"], words)


def _end_with(parent: int) -> None:
    """Ask the kernel to kill this process when its parent ends; exit now if the parent has already ended."""
    if sys.platform == "linux":
        import ctypes  # noqa: PLC0415 - other systems do not need it

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
        if os.getppid() != parent:
            os._exit(1)


def _limit(limits: dict[str, int]) -> None:
    """Set resource limits, within the hard limits in force."""
    if sys.platform == "win32":
        return
    import resource  # noqa: PLC0415 - Windows has none

    for name, value in limits.items():
        what = getattr(resource, f"RLIMIT_{name}")
        hard = resource.getrlimit(what)[1]
        bound = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (bound, bound))


def _run(module: str, words: list[str]) -> None:
    """Run a module of the articad that contains this file."""
    import runpy  # noqa: PLC0415 - a program that is executed does not need it

    root = os.path.abspath(__file__).rsplit(os.sep, 3)[0]  # noqa: PTH100 - a start without pathlib is faster
    sys.path.insert(0, root)
    __import__("articad")
    sys.path.remove(root)
    if root not in sys.path:
        sys.path.append(root)  # packages beside articad, after the standard library
    sys.argv = [module, *words]
    runpy.run_module(module, run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
