"""Scratch folders and files, and the one way to write a file that a user, an agent or another process will find.

The scratch folders of one process lie in one folder, which is locked while the process lives.

A process that is killed leaves its folder behind, without the lock. The next process that starts removes it. What is written beside its
target, to be renamed to it, is locked too: the next one that writes there removes what a killed one left.
"""

from __future__ import annotations

import atexit
import contextlib
import errno
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Final

PREFIX: Final = "articad-scratch-"
BESIDE: Final = ".articad-unfinished-"
"""What the names of files and folders begin with that are written beside their targets."""
_TRIES: Final = 100
_GROUP: Final = 64  # files that are brought to the disk together; each has an open lock meanwhile
_WRITING: Final = os.O_WRONLY | os.O_TRUNC | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)

_swept: set[Path] = set()
_homes: dict[int, Path] = {}  # by process: a fork makes a folder of its own
_locks: list[int] = []  # descriptors that hold the locks; the system releases them when the process ends


def folder(name: str) -> tempfile.TemporaryDirectory[str]:
    """Return a new empty folder that only this user can enter; it is removed when it is closed or collected.

    Args:
        name: Prefix of the folder's name.
    """
    return tempfile.TemporaryDirectory(prefix=f"{name}-", dir=_home())


def sweep() -> None:
    """Remove the folders of killed processes of this user."""
    with contextlib.suppress(OSError):  # there is no folder for temporary files, or it cannot be listed
        for place in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
            if place not in _homes.values():
                _remove_if_abandoned(place)


def write(path: Path, content: bytes) -> None:
    """Write a file so that a reader finds the complete old or new one; its folder is made if it does not exist.

    Only a regular file is replaced. Anything else in its place may be somebody else's: a link would lead to another file, a pipe would
    block, a device would be lost.

    Args:
        path: The file.
        content: What it will hold.

    Raises:
        OSError: If it cannot be written, or anything but a regular file is in its place; what was there is intact, and nothing is left.
    """
    with _written(path, content) as temporary:
        temporary.replace(path)


def write_durably(files: Mapping[Path, bytes]) -> None:
    """Write files as `write` does; they are on the disk when this returns, so that they also survive a loss of power.

    Files are brought to the disk in groups, and each folder once: a disk takes about as long for a group as for one file.

    Args:
        files: What each file will hold.

    Raises:
        OSError: As for `write`; each file is the complete old or new one.
    """
    left = list(files.items())
    while left:
        with contextlib.ExitStack() as group:
            temporary = {path: group.enter_context(_written(path, content)) for path, content in left[:_GROUP]}
            for place in temporary.values():
                _sync(place)
            for path, place in temporary.items():
                place.replace(path)
        left = left[_GROUP:]
    for folder in {path.parent for path in files}:
        with contextlib.suppress(OSError):  # not every file system can sync a folder
            _sync(folder)


@contextlib.contextmanager
def _written(path: Path, content: bytes) -> Iterator[Path]:
    """Give a new file with some content beside the one that it may replace; it is removed if it replaces none."""
    _require_replaceable(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    _sweep_beside(path.parent)
    with _about(path):
        temporary, lock = _locked(lambda: _new_file(path.parent))
    try:
        with _about(path):
            _fill(temporary, content)
        yield temporary
    finally:
        temporary.unlink(missing_ok=True)
        _unlock(lock)


@contextlib.contextmanager
def folder_beside(target: Path) -> Iterator[Path]:
    """Give an empty folder; when the block ends without an error it becomes the target, unless another process made that before.

    Raises:
        OSError: If it cannot be written.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    _sweep_beside(target.parent)
    temporary, lock = _locked(lambda: Path(tempfile.mkdtemp(prefix=BESIDE, dir=target.parent)))
    try:
        yield temporary
        temporary.chmod(0o777 & ~_umask())
        with contextlib.suppress(OSError):
            temporary.rename(target)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        _unlock(lock)


@contextlib.contextmanager
def set_aside(target: Path) -> Iterator[Callable[[], None]]:
    """Take a folder out of its place, and put it back when the block ends, instead of what is there then, unless the given function was called.

    Raises:
        OSError: If it cannot be moved.
    """
    _sweep_beside(target.parent)
    temporary, lock = _locked(lambda: Path(tempfile.mkdtemp(prefix=BESIDE, dir=target.parent)))
    kept, replaced = temporary / "kept", False

    def replace() -> None:
        nonlocal replaced
        replaced = True

    try:
        if target.exists():
            target.rename(kept)
        try:
            yield replace
        finally:
            if not replaced and target.exists():
                target.rename(temporary / "unfinished")
            if not replaced and kept.exists():
                kept.rename(target)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        _unlock(lock)


def require_own(folder: Path) -> None:
    """Check that a folder that no user named is no link, and lies in none: a link would lead what is written to somebody else's place.

    Args:
        folder: Relative to the working folder.

    Raises:
        OSError: If it is or does.
    """
    for place in (folder, *folder.parents):
        if place.is_symlink():
            raise FileExistsError(
                errno.EEXIST, "a link is in the place of the folder that is written to by default; name a folder", str(place)
            )


def _require_replaceable(path: Path) -> None:
    """Check that nothing or a regular file is at a path.

    Raises:
        OSError: If anything else is.
    """
    try:
        mode = path.lstat().st_mode
    except FileNotFoundError:
        return
    if stat.S_ISREG(mode):
        return
    kind = "a link" if stat.S_ISLNK(mode) else "a folder" if stat.S_ISDIR(mode) else "a pipe, a socket or a device"
    raise FileExistsError(errno.EEXIST, f"{kind} is in the place of the file; remove it or name another file", str(path))


@contextlib.contextmanager
def _about(path: Path) -> Iterator[None]:
    """Let an error name the file that was to be written: that of a full disk names none, or the one beside it."""
    try:
        yield
    except OSError as error:
        error.filename = str(path)
        raise


def _fill(temporary: Path, content: bytes) -> None:
    """Write the content of a new file, and give it the permissions that the user asks for."""
    mode = 0o666 & ~_umask()
    with os.fdopen(os.open(temporary, _WRITING), "wb") as stream:
        stream.write(content)
        if os.chmod in os.supports_fd:
            os.chmod(stream.fileno(), mode)  # noqa: PTH101 - the open file, whatever its name leads to by now
    if os.chmod not in os.supports_fd:
        temporary.chmod(mode)


def _sweep_beside(folder: Path) -> None:
    """Remove what killed processes left beside targets in a folder, once for each folder."""
    if folder not in _swept:
        _swept.add(folder)
        for place in folder.glob(f"{BESIDE}*"):
            _remove_if_abandoned(place)


def _sync(place: Path) -> None:
    handle = os.open(place, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _new_file(folder: Path) -> Path:
    handle, name = tempfile.mkstemp(prefix=BESIDE, dir=folder)
    os.close(handle)
    return Path(name)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _home() -> Path:
    """Return the folder of this process, made at the first call."""
    home = _homes.get(os.getpid())
    if home is None or not home.is_dir():
        sweep()
        home, lock = _locked(lambda: Path(tempfile.mkdtemp(prefix=PREFIX)))
        if lock is not None:
            _locks.append(lock)
        _homes[os.getpid()] = home
        atexit.register(_remove, os.getpid(), home)
    return home


def _locked(make: Callable[[], Path]) -> tuple[Path, int | None]:
    """Make a file or folder and lock it. A sweep of another process may come between the two; then there is another try.

    The sweep holds the lock while it removes what it took for abandoned, so this one waits for it.
    """
    for _ in range(_TRIES):
        place = make()
        lock = _lock(place, waiting=True)
        if lock is not None or place.exists():
            break  # without a lock: this file system has none, and nothing sweeps here
    return place, lock


def _lock(place: Path, *, waiting: bool = False) -> int | None:
    """Return a descriptor that holds the lock of a file or folder.

    Args:
        place: The file or folder.
        waiting: Whether to wait while another process holds the lock.

    Returns:
        None if it is not ours, is gone, or cannot be locked.
    """
    if sys.platform == "win32":
        return None
    import fcntl  # noqa: PLC0415 - Windows has none

    try:
        lock = os.open(place, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | (0 if waiting else fcntl.LOCK_NB))
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
        if place.is_dir():
            shutil.rmtree(place, ignore_errors=True)
        else:
            place.unlink(missing_ok=True)
        os.close(lock)


def _unlock(lock: int | None) -> None:
    if lock is not None:
        os.close(lock)


def _remove(process: int, home: Path) -> None:
    if process == os.getpid():
        with contextlib.suppress(OSError):
            shutil.rmtree(home, ignore_errors=True)
