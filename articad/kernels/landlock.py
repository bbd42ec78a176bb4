"""Landlock: a process gives up the file system, TCP, and signals to others, permanently and without privileges.

Linux 5.13 and later, if the kernel was started with it. Standard library only: this runs inside the sandbox. The numbers are from
linux/landlock.h; the three system calls have the same numbers on every architecture.
"""

from __future__ import annotations

import ctypes
import os
import stat
from collections.abc import Iterable

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_VERSION_QUERY = 1
_PATH_BENEATH = 1

_READ_FILE, _READ_DIR, _WRITE_FILE = 1 << 2, 1 << 3, 1 << 1
_REMOVE_DIR, _REMOVE_FILE, _MAKE_DIR, _MAKE_FILE, _TRUNCATE = 1 << 4, 1 << 5, 1 << 7, 1 << 8, 1 << 14
_CHANGE = _WRITE_FILE | _REMOVE_DIR | _REMOVE_FILE | _MAKE_DIR | _MAKE_FILE | _TRUNCATE  # no links, sockets, devices, pipes
_FILE_RIGHTS_OF_ABI = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1, 5: (1 << 16) - 1}
_NETWORK_SINCE, _NETWORK_RIGHTS = 4, 0b11  # bind and connect TCP
_SCOPES_SINCE, _SCOPES = 6, 0b11  # abstract unix sockets, signals to processes outside


class _Ruleset(ctypes.Structure):
    _fields_ = (("handled_fs", ctypes.c_uint64), ("handled_net", ctypes.c_uint64), ("scoped", ctypes.c_uint64))


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _layout_ = "ms"
    _fields_ = (("allowed", ctypes.c_uint64), ("parent", ctypes.c_int32))


def abi() -> int:
    """Return the version of Landlock that this kernel offers; 0 if none."""
    return max(0, int(ctypes.CDLL(None, use_errno=True).syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), _VERSION_QUERY)))


def restrict(readable: Iterable[str], writable: Iterable[str] = ()) -> None:
    """Give up every file except those below `readable`, which may only be read, and below `writable`; open files stay open.

    Every other right that this kernel's Landlock covers is given up without exception: writing, making, removing, executing, TCP,
    abstract unix sockets, signals. `no_new_privs` must be set.

    Raises:
        OSError: If the kernel refuses; nothing is restricted then.
    """
    libc = ctypes.CDLL(None, use_errno=True)

    def call(number: int, *arguments: object) -> int:
        result = int(libc.syscall(number, *arguments))
        if result < 0:
            raise OSError(ctypes.get_errno(), f"landlock: {os.strerror(ctypes.get_errno())}")
        return result

    version = abi()
    rights = max((mask for since, mask in _FILE_RIGHTS_OF_ABI.items() if since <= version), default=0)
    network = _NETWORK_RIGHTS if version >= _NETWORK_SINCE else 0
    scopes = _SCOPES if version >= _SCOPES_SINCE else 0
    handled = _Ruleset(rights, network, scopes)
    size = 24 if scopes else 16 if network else 8  # older kernels refuse fields that they do not know
    ruleset = call(_CREATE_RULESET, ctypes.byref(handled), ctypes.c_size_t(size), 0)
    try:
        for path, more in (*((path, 0) for path in readable), *((path, _CHANGE) for path in writable)):
            try:
                parent = os.open(path, os.O_PATH | os.O_CLOEXEC)
            except FileNotFoundError:
                continue
            allowed = (_READ_FILE | _READ_DIR | more if stat.S_ISDIR(os.fstat(parent).st_mode) else _READ_FILE) & rights
            try:
                call(_ADD_RULE, ruleset, _PATH_BENEATH, ctypes.byref(_PathBeneath(allowed, parent)), 0)
            finally:
                os.close(parent)
        call(_RESTRICT_SELF, ruleset, 0)
    finally:
        os.close(ruleset)
