"""The first lines of every child process. `articad.processes.launcher` runs this file as `python -I child.py ORDER WORDS...`.

ORDER is a JSON object:
- `parent`: the process that started this one; when it ends, the kernel kills this one (Linux).
- `limits`: soft and hard resource limits by their names in `resource`.
- `module`: the module of articad to run, with WORDS as its arguments; or null: WORDS are a program to run.
- `environment`: the names of the variables that the program keeps. Python adds LC_CTYPE to an empty environment.

`-I` keeps the working folder, PYTHONPATH and the user's own packages off the path. The imported articad is the one that contains this file. Only the standard library is used here.

A program may start processes that the kernel does not kill with their parent. So on Linux this process stays beside it, kills all processes below itself when the
parent ends or SIGTERM comes, and those that the program leaves behind, and ends as the program ends.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from typing import Any, Final

_PR_SET_PDEATHSIG: Final = 1
_PR_SET_CHILD_SUBREAPER: Final = 36
_ROUNDS: Final = 100  # of looking for processes to kill: each may start others until it is killed


def main() -> None:
    """Carry out the order."""
    order: dict[str, Any] = json.loads(sys.argv[1])
    words = sys.argv[2:]
    if order["module"] is not None:
        _end_with(order["parent"])
        _limit(order["limits"])
        _run(order["module"], words)
        return
    if sys.platform == "linux":
        _stay_beside_program(order["parent"])
    _limit(order["limits"])
    kept = {name: os.environ[name] for name in order["environment"]}
    try:
        os.execve(words[0], words, kept)  # noqa: S606 - the words are articad's own, and no shell reads them
    except OSError as error:
        sys.exit(f"{words[0]}: {error.strerror}")


def _end_with(parent: int, number: int = signal.SIGKILL) -> None:
    """Ask the kernel to send this process a signal when its parent ends; exit now if the parent has already ended."""
    if sys.platform == "linux":
        _prctl(_PR_SET_PDEATHSIG, int(number))
        if os.getppid() != parent:
            os._exit(1)


def _stay_beside_program(parent: int) -> None:
    """Fork; return in the new process, which becomes the program, and watch over it in this one, which does not return."""
    watcher = os.getpid()
    signal.signal(signal.SIGTERM, lambda *_: _end_all())
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)  # what a process below leaves behind becomes a child of this process
    _end_with(parent, signal.SIGTERM)
    program = os.fork()
    if program == 0:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        _end_with(watcher)
        return
    for number in map(int, os.listdir("/proc/self/fd")):  # noqa: PTH208 - a start without pathlib is faster
        with contextlib.suppress(OSError):  # the list itself
            os.close(number)  # whoever waits for the end of a pipe of the program waits for the program alone
    while True:
        ended, status = os.wait()
        if ended == program:
            _kill_all_below()
            _end_as(os.waitstatus_to_exitcode(status))


def _end_all() -> None:
    """Kill the processes below this one, then this one and its group."""
    _kill_all_below()
    os.killpg(0, signal.SIGKILL)


def _kill_all_below() -> None:
    """Kill the processes below this one, in whatever group they are, but those of other users."""
    spared: set[int] = set()
    for _ in range(_ROUNDS):
        below = _children() - spared
        for child in below:
            try:
                os.kill(child, signal.SIGKILL)
            except OSError:  # another user's, such as a setuid program: to wait for it would be to wait until it ends by itself
                spared.add(child)
        for child in below - spared:
            with contextlib.suppress(OSError):
                os.waitpid(child, 0)  # its own children are now children of this process
        if not below:
            break


def _children() -> set[int]:
    """Return the children of this process; none where the system does not list them."""
    path = f"/proc/self/task/{os.getpid()}/children"
    with contextlib.suppress(OSError), open(path, "rb") as listed:  # noqa: PTH123 - a start without pathlib is faster
        return set(map(int, listed.read().split()))
    return set()


def _end_as(code: int) -> None:
    """End this process with an exit code, or by a signal if the code is negative."""
    if code < 0:
        with contextlib.suppress(OSError):  # SIGKILL and SIGSTOP cannot be set
            signal.signal(-code, signal.SIG_DFL)
        _limit({"CORE": 0})
        os.kill(os.getpid(), -code)
    os._exit(code if code >= 0 else 128 - code)


def _prctl(what: int, value: int) -> None:
    import ctypes  # noqa: PLC0415 - other systems do not need it

    ctypes.CDLL(None).prctl(what, value, 0, 0, 0)


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
