"""Seccomp: allows the system calls that computing a shape needs, and no others.

An allow-list: any other call fails with EPERM. Reading files is allowed (Landlock or bwrap decide which); opening for writing,
processes, threads, sockets, signals to others, and everything that changes the file system are not. Threads are refused because nothing
else limits their number: root is exempt from RLIMIT_NPROC, and a machine has as few as 32768 thread ids. The caller must set its
libraries to single-threaded before. Standard library only: this runs inside the sandbox.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import struct
from collections.abc import Iterator
from typing import NamedTuple

_PR_SET_SECCOMP, _MODE_FILTER = 22, 2
_LOAD, _MASK, _EQUAL, _GREATER_OR_EQUAL, _SET, _RETURN = 0x20, 0x54, 0x15, 0x35, 0x45, 0x06  # BPF instructions
_ALLOW, _KILL = 0x7FFF0000, 0x80000000
_NUMBER_AT, _ARCHITECTURE_AT, _ARGUMENTS_AT = 0, 4, 16  # offsets in struct seccomp_data
_X32_BIT = 0x40000000  # the second ABI of x86_64, with its own numbers

_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_FCNTL = (0, 1, 2, 3, 4, 5, 6, 7, 1030)  # duplicate, flags, locks; not F_SETOWN, which makes the kernel send signals
_IOCTL = (0x5401, 0x5413, 0x541B, 0x5450, 0x5451)  # is it a terminal, its size, bytes waiting, close-on-exec
_PRCTL = (15, 16, 0x53564D41)  # names of threads and of memory


class _Architecture(NamedTuple):
    token: int
    calls: dict[str, int]


# further calls that FreeCAD needs, whose documents are files: bubblewrap leaves one small writable folder
_FILES: dict[str, tuple[int, int | None]] = {
    "rename": (82, None), "renameat": (264, 38), "renameat2": (316, 276), "unlink": (87, None), "unlinkat": (263, 35),
    "mkdir": (83, None), "mkdirat": (258, 34), "rmdir": (84, None), "ftruncate": (77, 46), "fchmod": (91, 52), "chmod": (90, None),
    "fchmodat": (268, 53), "flock": (73, 32), "utimensat": (280, 88), "chdir": (80, 49),
}  # fmt: skip

# name: number on x86_64, number on aarch64 (None: it has none)
_TABLE: dict[str, tuple[int, int | None]] = {
    # files that are open, and file metadata
    "read": (0, 63), "write": (1, 64), "close": (3, 57), "lseek": (8, 62), "readv": (19, 65), "writev": (20, 66),
    "pread64": (17, 67), "pwrite64": (18, 68), "preadv": (295, 69), "pwritev": (296, 70), "fstat": (5, 80), "stat": (4, None),
    "lstat": (6, None), "newfstatat": (262, 79), "statx": (332, 291), "statfs": (137, 43), "fstatfs": (138, 44), "access": (21, None),
    "faccessat": (269, 48), "faccessat2": (439, 439), "readlink": (89, None), "readlinkat": (267, 78), "getcwd": (79, 17),
    "getdents64": (217, 61), "poll": (7, None), "ppoll": (271, 73), "select": (23, None), "pselect6": (270, 72), "pipe": (22, None),
    "pipe2": (293, 59), "dup": (32, 23), "dup2": (33, None), "dup3": (292, 24), "fsync": (74, 82), "fdatasync": (75, 83),
    "fadvise64": (221, 223), "umask": (95, 166),
    # memory
    "mmap": (9, 222), "munmap": (11, 215), "mprotect": (10, 226), "mremap": (25, 216), "madvise": (28, 233), "brk": (12, 214),
    "mincore": (27, 232), "msync": (26, 227), "membarrier": (324, 283),
    # locks and time
    "futex": (202, 98), "futex_waitv": (449, 449), "set_robust_list": (273, 99), "get_robust_list": (274, 100),
    "set_tid_address": (218, 96), "rseq": (334, 293), "sched_yield": (24, 124), "sched_getaffinity": (204, 123),
    "sched_getscheduler": (145, 120), "sched_getparam": (143, 121), "sched_get_priority_max": (146, 125),
    "sched_get_priority_min": (147, 126), "getcpu": (309, 168), "arch_prctl": (158, None), "clock_gettime": (228, 113),
    "clock_getres": (229, 114), "clock_nanosleep": (230, 115), "nanosleep": (35, 101), "gettimeofday": (96, 169), "time": (201, None),
    "times": (100, 153), "setitimer": (38, 103), "getitimer": (36, 102), "alarm": (37, None), "pause": (34, None),
    # signals to itself
    "rt_sigaction": (13, 134), "rt_sigprocmask": (14, 135), "rt_sigreturn": (15, 139), "rt_sigpending": (127, 136),
    "rt_sigsuspend": (130, 133), "rt_sigtimedwait": (128, 137), "sigaltstack": (131, 132), "restart_syscall": (219, 128),
    "exit": (60, 93), "exit_group": (231, 94),
    # queries
    "getrusage": (98, 165), "getrlimit": (97, 163), "sysinfo": (99, 179), "uname": (63, 160), "getrandom": (318, 278),
    "getpid": (39, 172), "getppid": (110, 173), "gettid": (186, 178), "getuid": (102, 174), "geteuid": (107, 175), "getgid": (104, 176),
    "getegid": (108, 177), "getgroups": (115, 158), "getresuid": (118, 148), "getresgid": (120, 150), "getpgrp": (111, None),
    "getpgid": (121, 155), "getsid": (124, 156),
    # allowed under conditions: see _conditional
    "open": (2, None), "openat": (257, 56), "openat2": (437, 437), "clone": (56, 220), "clone3": (435, 435), "tgkill": (234, 131),
    "fcntl": (72, 25), "ioctl": (16, 29), "prctl": (157, 167), "prlimit64": (302, 261),
}  # fmt: skip
_CONDITIONAL = frozenset(list(_TABLE)[list(_TABLE).index("open") :])

_ARCHITECTURES = {
    "x86_64": _Architecture(0xC000003E, {name: numbers[0] for name, numbers in _TABLE.items()}),
    "aarch64": _Architecture(0xC00000B7, {name: numbers[1] for name, numbers in _TABLE.items() if numbers[1] is not None}),
}


def available() -> bool:
    """Return whether filters are defined for this architecture and accepted by this kernel."""
    seccomp, get_action_available = {"x86_64": 317, "aarch64": 277}.get(platform.machine(), -1), 2
    action = ctypes.c_uint32(_ALLOW)
    return seccomp > 0 and ctypes.CDLL(None).syscall(seccomp, get_action_available, 0, ctypes.byref(action)) == 0


def restrict(*, writing: bool = False) -> None:
    """Deny this process and its threads every system call that is not on the list. `no_new_privs` must be set.

    Args:
        writing: Whether files may be opened for writing, made, renamed and removed; other layers decide where.

    Raises:
        OSError: If the kernel refuses; nothing is restricted then.
    """
    code = program(platform.machine(), os.getpid(), writing=writing)
    instructions = ctypes.create_string_buffer(code, len(code))
    header = ctypes.create_string_buffer(struct.pack("HxxxxxxP", len(code) // 8, ctypes.addressof(instructions)))
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(_PR_SET_SECCOMP, _MODE_FILTER, header, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), f"seccomp: {os.strerror(ctypes.get_errno())}")


def program(machine: str, pid: int, *, writing: bool = False) -> bytes:
    """Return the filter as BPF, 8 bytes per instruction.

    Args:
        machine: `x86_64` or `aarch64`.
        pid: The process's own id, the only one to which its threads may send signals.
        writing: As in `restrict`.
    """
    architecture = _ARCHITECTURES[machine]
    files = {name: numbers[machine != "x86_64"] for name, numbers in _FILES.items() if writing}
    calls = architecture.calls | {name: number for name, number in files.items() if number is not None}
    lines = [_op(_LOAD, _ARCHITECTURE_AT), _op(_EQUAL, architecture.token, 1, 0), _op(_RETURN, _KILL), _op(_LOAD, _NUMBER_AT)]
    if machine == "x86_64":
        lines += [_op(_GREATER_OR_EQUAL, _X32_BIT, 0, 1), _op(_RETURN, _KILL)]
    for name, number in calls.items():
        free = name not in _CONDITIONAL or (writing and name in ("open", "openat"))
        block = [_op(_RETURN, _ALLOW)] if free else list(_conditional(name, pid))
        lines += [_op(_EQUAL, number, 0, len(block)), *block]
    return b"".join([*lines, _refuse(errno.EPERM)])


def _conditional(name: str, pid: int) -> Iterator[bytes]:
    """Yield the block for a call that is allowed under a condition; every block ends in a return."""
    if name in ("clone3", "openat2"):  # their arguments are behind a pointer; libc falls back to the older call
        yield _refuse(errno.ENOSYS)
    elif name == "clone":  # fails as on a machine without free threads: C++'s std::async then does the work itself
        yield _refuse(errno.EAGAIN)
    elif name in ("open", "openat"):
        flags = 1 if name == "open" else 2
        yield from (_argument(flags), _op(_SET, _WRITING, 0, 1), _refuse(errno.EACCES), _op(_RETURN, _ALLOW))
    elif name == "prlimit64":  # reading limits is allowed, setting them is not
        yield from (_argument(2), _op(_EQUAL, 0, 0, 3), _argument(2, high=True), _op(_EQUAL, 0, 0, 1), _op(_RETURN, _ALLOW))
        yield _refuse(errno.EPERM)
    else:
        place, values = {"tgkill": (0, (pid,)), "fcntl": (1, _FCNTL), "ioctl": (1, _IOCTL), "prctl": (0, _PRCTL)}[name]
        yield _argument(place)
        for value in values:
            yield from (_op(_EQUAL, value, 0, 1), _op(_RETURN, _ALLOW))
        yield _refuse(errno.EPERM)


def _op(code: int, value: int, if_true: int = 0, if_false: int = 0) -> bytes:
    return struct.pack("HBBI", code, if_true, if_false, value)


def _argument(place: int, *, high: bool = False) -> bytes:
    return _op(_LOAD, _ARGUMENTS_AT + 8 * place + (4 if high else 0))  # both architectures are little-endian


def _refuse(error: int) -> bytes:
    return _op(_RETURN, 0x00050000 | error)
