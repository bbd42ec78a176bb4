"""Give up, in this process and for good, what a program inside FreeCAD does not need; then run it.

Read by FreeCAD's own Python before anything else. bubblewrap has hidden the file system by then; what is left to do is
what must come after the last `exec`: resource limits, Landlock and seccomp. The modules for the latter two are articad's
own, shown in /confinement beside this file; whatever goes wrong ends the process before a line of the program is read.
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


def confine(layers: list[str], limits: dict[str, int], more: list[str], writable: list[str], turn: int) -> None:
    """Put the layers on; after this neither a script nor FreeCAD itself can take them off.

    Args:
        layers: Of `landlock` and `seccomp`.
        limits: Of resources, by their names.
        more: What may be read besides libraries.
        writable: Folders that may be written.
        turn: Counts processes, to spread them over processors. Each keeps to one: OCCT starts threads for the others, and
            seccomp allows none.

    Raises:
        OSError: If a layer that was promised cannot be put on.
    """
    for name, value in limits.items():
        what = getattr(resource, f"RLIMIT_{name}")
        hard = resource.getrlimit(what)[1]
        bound = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (bound, bound))
    processors = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {processors[turn % len(processors)]})
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "no_new_privs")
    if libc.unshare(_CLONE_THREAD) != 0:  # succeeds, and changes nothing, in a process of one thread; others would stay free
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
    except BaseException as error:  # noqa: BLE001 - nothing may go on unconfined
        os.write(told["fault"], f"{type(error).__name__}: {error}".encode()[:500])
        os._exit(FAILED)
    os.close(told["fault"])  # what comes now cannot pretend that it was not confined


main(CONFINEMENT)  # type: ignore[name-defined]  # noqa: F821 - given by whoever starts this
