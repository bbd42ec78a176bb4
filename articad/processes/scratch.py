"""Scratch folders. Those of one process lie in one folder, which is locked while the process lives.

A process that is killed leaves its folder behind, without the lock. The next process that starts removes it.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Final

PREFIX: Final = "articad-scratch-"
_TRIES: Final = 100

_homes: dict[int, Path] = {}  # by process: a fork makes a folder of its own
_locks: list[int] = []  # descriptors that hold the locks; the system releases them when the process ends


def folder(name: str) -> tempfile.TemporaryDirectory[str]:
    """Return a new empty folder that only this user can enter; it is removed when it is closed or collected.

    Args:
        name: What it is for; the folder's own name begins with it.
    """
    return tempfile.TemporaryDirectory(prefix=f"{name}-", dir=_home())


def sweep() -> None:
    """Remove what killed processes of this user left behind."""
    with contextlib.suppress(OSError):  # there is no folder for temporary files, or it cannot be listed
        for place in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
            if place not in _homes.values():
                _remove_if_abandoned(place)


def _home() -> Path:
    """Return the folder of this process, made when it is first needed."""
    home = _homes.get(os.getpid())
    if home is None or not home.is_dir():
        sweep()
        home = _homes[os.getpid()] = _locked()
        atexit.register(_remove, os.getpid(), home)
    return home


def _locked() -> Path:
    """Make a folder and lock it. A sweep of another process may come between the two; then there is another try."""
    for _ in range(_TRIES):
        place = Path(tempfile.mkdtemp(prefix=PREFIX))
        lock = _lock(place)
        if lock is not None:
            _locks.append(lock)
            return place
        if place.is_dir():
            break  # this file system has no locks: nothing sweeps here
    return place


def _lock(place: Path) -> int | None:
    """Return a descriptor that holds a folder's lock; None if it is not ours, is gone, or cannot be locked."""
    if sys.platform == "win32":
        return None
    import fcntl  # noqa: PLC0415 - Windows has none

    try:
        lock = os.open(place, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        opened, named = os.fstat(lock), place.lstat()
        if opened.st_uid == os.geteuid() and os.path.samestat(opened, named):
            return lock
    except OSError:
        pass
    os.close(lock)
    return None


def _remove_if_abandoned(place: Path) -> None:
    lock = _lock(place)
    if lock is not None:
        shutil.rmtree(place, ignore_errors=True)
        os.close(lock)


def _remove(process: int, home: Path) -> None:
    if process == os.getpid():
        with contextlib.suppress(OSError):
            shutil.rmtree(home, ignore_errors=True)
