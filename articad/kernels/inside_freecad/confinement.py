"""Give up, permanently, all rights that a program inside FreeCAD does not need; then run it.

FreeCAD's own Python reads this before anything else. bubblewrap has already hidden the file system; resource limits, Landlock and
seccomp must come after the last `exec`. The modules for the latter two are articad's own, visible in /confinement beside this file. Any
failure ends the process before a line of the program is read.
"""

from __future__ import annotations

import ctypes
import os
import resource
import sys
from typing import Any

_NO_NEW_PRIVILEGES, _CLONE_THREAD = 38, 0x10000
_READABLE = (
    "/usr",
    "/bin",
    "/sbin",
    "/lib",
    "/lib32",
    "/lib64",
    "/libx32",
    "/etc",
    "/proc/self",
    "/confinement",
    "/dev/null",
    "/dev/urandom",
)
FAILED = 70


def _soft(what: int) -> int:
    """Return the present soft limit: that of processor time sends SIGXCPU, which says why the process ends, before the hard one kills."""
    soft = resource.getrlimit(what)[0]
    return sys.maxsize if soft == resource.RLIM_INFINITY else soft


def confine(layers: list[str], limits: dict[str, int], more: list[str], writable: list[str], turn: int) -> None:
    """Apply the layers; after this neither a script nor FreeCAD itself can remove them.

    Args:
        layers: Of `landlock` and `seccomp`.
        limits: Resource limits by their names.
        more: Paths that may be read besides libraries.
        writable: Folders that may be written.
        turn: Number of the process, to spread processes over processors. Each is bound to one: OCCT would start a thread for each
            further processor, and seccomp allows none.

    Raises:
        OSError: If a promised layer cannot be applied.
    """
    for name, value in limits.items():
        what = getattr(resource, f"RLIMIT_{name}")
        hard = resource.getrlimit(what)[1]
        bound = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (min(bound, _soft(what)), bound))
    processors = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {processors[turn % len(processors)]})
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "no_new_privs")
    if libc.unshare(_CLONE_THREAD) != 0:  # succeeds without effect in a process with one thread; other threads would stay unconfined
        raise OSError(ctypes.get_errno(), "FreeCAD has started threads already")
    sys.path.insert(0, "/confinement")
    import landlock  # type: ignore[import-not-found]  # noqa: PLC0415
    import seccomp  # type: ignore[import-not-found]  # noqa: PLC0415

    sys.path.remove("/confinement")
    if "landlock" in layers:
        landlock.restrict([*_READABLE, *more], writable)
    if "seccomp" in layers:
        seccomp.restrict(writing=True)


def main(told: dict[str, Any]) -> None:
    """Confine this process; end it if that fails."""
    try:
        confine(told["layers"], told["limits"], told["readable"], told["writable"], told["turn"])
    except BaseException as error:  # noqa: BLE001 - nothing may run unconfined
        os.write(told["fault"], f"{type(error).__name__}: {error}".encode()[:500])
        os._exit(FAILED)
    os.close(told["fault"])  # what runs now cannot pretend that it was not confined


main(CONFINEMENT)  # type: ignore[name-defined]  # noqa: F821 - given by whoever starts this
