"""All untrusted files are opened here: regular files only, of a bounded size, reached through no link.

A path that the user names may be a link; a path below a folder that the user names may not lead out of it. With `root`, each component
below the root is opened by itself without following links, so nothing can be exchanged between a check and a read. `ARTICAD_ROOT` in the
environment is such a root for all untrusted files that a process reads: the MCP server sets it. It does not apply to what confined
processes leave in private folders (`read_left`).

Every refusal is an `OSError` with its reason in `strerror`, like those of the operating system. Standard library only.
"""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Final

ROOT_VARIABLE: Final = "ARTICAD_ROOT"
PLAN_BYTES: Final = 16 << 20  # a plan of a thousand parts has 0.4 MB
SCRIPT_BYTES: Final = 4 << 20
RECORD_BYTES: Final = 512 << 20  # largest file in a run: meshes, replies, certificates
_PIECE: Final = 1 << 20
_FOLDER: Final = getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
# O_NONBLOCK: opening a pipe without a writer does not block. O_NOCTTY: a terminal does not become the controlling one.
_FILE: Final = (
    os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
)
_BY_FOLDER: Final = os.open in os.supports_dir_fd


class UnsafeFileError(OSError):
    """A file that is refused: it is not a regular file, is too large, or is reached through a link."""


def read_file(path: str | Path, most: int, *, root: str | Path | None = None) -> bytes:
    """Return the content of a file.

    Args:
        path: The file.
        most: The largest size that is read [bytes].
        root: A folder above the file; no component of the path below it may be a link. None if the user named the path.

    Raises:
        UnsafeFileError: If it is not a regular file, is larger, or a link leads to it.
        OSError: If it is missing or cannot be read.
    """
    return _content(open_file(path, root=root), path, most)


def read_left(path: str | Path, most: int) -> bytes:
    """Return the content of a file that a confined process left in a private folder of this process; `ARTICAD_ROOT` does not apply to it.

    Args:
        path: The file; a link is refused.
        most: The largest size that is read [bytes].

    Raises:
        UnsafeFileError: If it is not a regular file, is larger, or is a link.
        OSError: If it is missing or cannot be read.
    """
    path = Path(path)
    return _content(_regular(_opened_below(path.parent, path), path), path, most)


def _content(file: int, path: str | Path, most: int) -> bytes:
    """Return what an open file holds, and close it."""
    try:
        size = os.fstat(file).st_size
        if size > most:
            raise _refused(path, f"it is larger than {most} bytes: it has {size}")
        pieces, left = [os.read(file, size + 1)], most + 1  # most files come in one piece
        while pieces[-1]:
            left -= len(pieces[-1])
            if left <= 0:  # it grows while it is read
                raise _refused(path, f"it is larger than {most} bytes")
            pieces.append(os.read(file, min(left, _PIECE)))
        return pieces[0] if len(pieces) <= 2 else b"".join(pieces)
    finally:
        os.close(file)


def open_file(path: str | Path, *, root: str | Path | None = None) -> int:
    """Return a descriptor of a regular file, opened for reading; see `read_file`.

    Raises:
        UnsafeFileError: If it is not a regular file, or a link leads to it.
        OSError: If it is missing or cannot be read.
    """
    path = Path(path)
    root = _root_of(path, root)
    if "\0" in str(path):
        raise _refused("", "its name has a zero byte")
    return _regular(os.open(path, _FILE) if root is None else _opened_below(Path(root), path), path)


def _regular(file: int, path: Path) -> int:
    """Return an open file if it is a regular one; else close it and refuse it."""
    try:
        is_regular = stat.S_ISREG(os.fstat(file).st_mode)
    except BaseException:
        os.close(file)
        raise
    if not is_regular:
        os.close(file)
        raise _refused(path, "it is a folder, a pipe, a socket or a device, not a file")
    return file


def is_file(path: str | Path, *, root: str | Path | None = None) -> bool:
    """Return whether `open_file` would open it."""
    try:
        os.close(open_file(path, root=root))
    except OSError:
        return False
    return True


def differs(path: str | Path, content: bytes) -> bool:
    """Return whether there is anything at a path but a regular file with this content; False if nothing is there."""
    try:
        return read_file(path, len(content)) != content
    except FileNotFoundError:
        return False
    except OSError:
        return True


def user_folder(variable: str, default: str) -> Path:
    """Return a folder of the user's own: that of an XDG variable, or the default below the home folder.

    A relative path in the variable is ignored, as the XDG Base Directory Specification requires: it would name a folder of whoever made
    the working folder.
    """
    stated = Path(os.environ.get(variable, ""))
    return stated if stated.is_absolute() else Path.home() / default


def _root_of(path: Path, root: str | Path | None) -> str | Path | None:
    """Return the root that applies to a path: the given one, unless everything that this process reads has to lie below another.

    Raises:
        UnsafeFileError: If the path is not below that other root.
    """
    outermost = os.environ.get(ROOT_VARIABLE)
    if not outermost:
        return root
    if not _plain(path).is_relative_to(_plain(Path(outermost))):
        raise _refused(path, f"it is outside {outermost}")
    return outermost


def _opened_below(root: Path, path: Path) -> int:
    """Open a file below a root, component by component, without following a link."""
    root, path = _plain(root), _plain(path)
    if not path.is_relative_to(root) or path == root:
        raise _refused(path, f"it is outside {root}")
    *folders, name = path.relative_to(root).parts
    if not _BY_FOLDER:  # Windows: check and open are two steps
        if any(part.is_symlink() for part in (path, *path.parents) if part.is_relative_to(root) and part != root):
            raise _linked(path)
        return os.open(path, _FILE)
    here = os.open(root, _FOLDER & ~getattr(os, "O_NOFOLLOW", 0))
    try:
        for folder in folders:
            below = os.open(folder, _FOLDER, dir_fd=here)
            os.close(here)
            here = below
        return os.open(name, _FILE | os.O_NOFOLLOW, dir_fd=here)
    except OSError as error:
        # a link to a folder is "not a directory" or "too many links", a link to a file the latter
        if error.errno == errno.ELOOP or (error.errno == errno.ENOTDIR and _has_link(root, path)):
            raise _linked(path) from None
        raise
    finally:
        os.close(here)


def _plain(path: Path) -> Path:
    """Return an absolute path without `..`; links are left as they are."""
    return Path(os.path.abspath(path))  # noqa: PTH100 - Path.absolute keeps "..", Path.resolve follows links


def _has_link(root: Path, path: Path) -> bool:
    return any(part.is_symlink() for part in (path, *path.parents) if part.is_relative_to(root) and part != root)


def _linked(path: Path) -> UnsafeFileError:
    return _refused(path, "a link leads to it; copy the file here instead")


def _refused(path: str | Path, reason: str) -> UnsafeFileError:
    return UnsafeFileError(errno.EPERM, reason, str(path))
