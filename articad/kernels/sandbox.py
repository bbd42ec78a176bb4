"""The sandbox of part scripts: which layers this machine has, and how a process applies them.

From the outside in: an empty environment and a session of its own (zygote.py); bubblewrap's namespaces around the zygote; and in the
process forked for one script: no capabilities, resource limits, Landlock, seccomp. A script gets open files for its input and output and
can open no others but libraries, so no layer needs a writable path. The level names the layers in effect, such as
`bwrap+landlock+seccomp`. With neither Landlock nor bubblewrap it is `weak`, and scripts are refused unless the user accepts that.
Standard library only: this module also runs inside the sandbox.
"""

from __future__ import annotations

import contextlib
import ctypes
import math
import os
import site
import sys
import sysconfig
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from articad.kernels import landlock, seccomp
from articad.processes import launcher

LAYERS = ("bwrap", "landlock", "seccomp")
WEAK = "weak"
HOW_TO_GET = (
    "Install bubblewrap (apt-get install bubblewrap), allow user namespaces (sysctl kernel.unprivileged_userns_clone=1), "
    "or use a kernel with Landlock (Linux 5.13 or later, 'landlock' in /sys/kernel/security/lsm)"
)

# Empty except for what makes two runs equal: hash seed, locale, and one thread where BLAS would start several before the fork.
ENVIRONMENT = {
    "HOME": "/nonexistent",
    "LANG": "C.UTF-8",
    "LC_ALL": "C.UTF-8",
    "PYTHONHASHSEED": "0",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MPLBACKEND": "agg",
}
_SYSTEM_LIBRARIES = ("/usr/lib", "/usr/lib64", "/usr/local/lib", "/lib", "/lib64", "/lib32", "/libx32")
_FONTS = ("/usr/share/fonts", "/usr/local/share/fonts", "/etc/fonts")
_LOADER = ("/etc/ld.so.cache", "/etc/ld.so.conf", "/etc/ld.so.conf.d", "/etc/alternatives")
_PR_SET_PDEATHSIG, _PR_CAPBSET_DROP, _PR_SET_NO_NEW_PRIVS = 1, 24, 38
_CAPABILITY_VERSION = 0x20080522
_CAPSET = {"x86_64": 126, "aarch64": 91}
_PROBE = launcher.Limits(seconds=20.0)  # bubblewrap answers in 0.02 s; a machine that swaps may need longer


@dataclass(frozen=True)
class ScriptLimits:
    """Resources that one script may use.

    Attributes:
        seconds: Processor time until its shape must be there; the wall clock may be `timers.WAITING` times as long.
        probe_seconds: Wall clock for what follows, such as further checks of a shape that was measured; of the dimension probe, whose
            processes are limited one by one, the processor time.
        memory: Address space [bytes], libraries (1 GiB) included.
        file_size: Largest size of each result [bytes].
    """

    seconds: float = 60.0
    probe_seconds: float = 30.0
    memory: int = 3 * 2**30
    file_size: int = 256 * 2**20


def level() -> str:
    """Return the level of isolation on this machine, `weak` if it has neither Landlock nor bubblewrap."""
    return level_of(available())


def level_of(layers: Collection[str]) -> str:
    """Return the name of a set of layers."""
    if not {"bwrap", "landlock"} & set(layers):
        return WEAK
    return "+".join(layer for layer in LAYERS if layer in layers)


@cache
def available() -> frozenset[str]:
    """Return the layers that work here; each one is tried."""
    if sys.platform != "linux":
        return frozenset()
    works = {"bwrap": bubblewrap_problem() is None, "landlock": landlock.abi() > 0, "seccomp": seccomp.available()}
    return frozenset(layer for layer, there in works.items() if there)


def missing() -> tuple[str, ...]:
    """Return, for each layer that does not work here, the reason."""
    if sys.platform != "linux":
        return (f"part scripts run on Linux only, not on {sys.platform}: use a Linux container or WSL 2",)
    reasons = []
    if (problem := bubblewrap_problem()) is not None:
        reasons.append(f"bubblewrap: {problem}")
    if landlock.abi() == 0:
        reasons.append("Landlock: this kernel does not offer it")
    if not seccomp.available():
        reasons.append("seccomp: not offered by this kernel or not known for this processor")
    return tuple(reasons)


@cache
def bubblewrap_problem() -> str | None:
    """Return why bubblewrap does not work here, or None if it does."""
    if launcher.which("bwrap") is None:
        return "not installed"
    try:
        tried = launcher.run(bubblewrap_command([sys.executable, "-I", "-S", "-c", "pass"]), environment={}, limits=_PROBE)
    except OSError as error:
        return type(error).__name__
    if tried.late:
        return f"no answer in {_PROBE.seconds} s"
    return None if tried.code == 0 else tried.last_line[:200]


def bubblewrap_command(command: list[str]) -> list[str]:
    """Return the command that runs another one in namespaces of its own: no network, only libraries to read, nowhere to write.

    It must itself be started with an empty environment, because /proc/1/environ inside shows its environment.
    """
    mounts: list[str] = []
    for path in _visible_paths():
        mounts += ["--symlink", str(Path(path).readlink()), path] if Path(path).is_symlink() else ["--ro-bind-try", path, path]
    return [
        bubblewrap(),
        *("--unshare-all", "--unshare-user", "--uid", "65534", "--gid", "65534", "--cap-drop", "ALL"),
        *disable_user_namespaces(),
        *("--new-session", "--die-with-parent", "--hostname", "sandbox"),
        *mounts,
        *("--dev", "/dev", "--remount-ro", "/dev", "--chdir", "/", "--remount-ro", "/"),
        *command,
    ]


def bubblewrap() -> str:
    """Return the path of bubblewrap; if there is none, a path that cannot be started."""
    return launcher.which("bwrap") or "/nonexistent/bwrap"


@cache
def disable_user_namespaces() -> tuple[str, ...]:
    """Return bubblewrap's flag against user namespaces inside, which 0.8.0 and later have."""
    shown = launcher.run([bubblewrap(), "--help"], environment={}, limits=_PROBE, merged=True)
    return ("--disable-userns",) if b"--disable-userns" in shown.out else ()


def _visible_paths() -> list[str]:
    """Return the paths visible in bubblewrap, parents first: system libraries, this Python with its packages, fonts, this package."""
    python = [sys.base_prefix, sys.base_exec_prefix, sys.prefix, sys.exec_prefix, *_executable_homes(), *site.getsitepackages()]
    package = str(Path(__file__).parents[1])
    wanted = ["/usr", *_SYSTEM_LIBRARIES[3:], *_LOADER, "/etc/fonts", *python, package]
    kept: list[str] = []
    for path in sorted({path for path in wanted if os.path.lexists(path) and path != "/"}, key=len):
        if not any(path == parent or path.startswith(f"{parent}/") for parent in kept):
            kept.append(path)
    return sorted(kept)


def _executable_homes() -> Iterator[str]:
    """Yield the folders that the interpreter's links pass through: an environment links to a Python that may itself be a link."""
    path = Path(sys.executable)
    with contextlib.suppress(OSError):  # a link into a folder without read permission
        for _ in range(8):
            if not path.is_symlink():
                return
            path = Path(os.path.normpath(path.parent / path.readlink()))
            if path.parent.name == "bin":
                yield str(path.parent.parent)


def readable_paths() -> tuple[str, ...]:
    """Return the paths that a confined process may still read: libraries that Python and the kernel load lazily, and fonts.

    Packages installed as links to a folder of sources are left out, because such a folder may contain anything.
    """
    python = (sysconfig.get_path("stdlib"), sysconfig.get_path("platstdlib"), *site.getsitepackages())
    return (*python, *_SYSTEM_LIBRARIES, *_FONTS, *_LOADER, "/dev/null", "/dev/urandom")


def confine(limits: ScriptLimits, layers: Collection[str], readable: Collection[str]) -> None:
    """Give up, in this process and for good, what computing a shape does not need.

    Called right after the fork, while there is one thread and before any code of a script is read.

    Args:
        limits: Limits that the kernel enforces from now on.
        layers: Layers to apply, of `landlock` and `seccomp`.
        readable: Paths that stay readable under Landlock.

    Raises:
        OSError: If a promised layer cannot be applied.
    """
    _limit_resources(limits)
    _drop_capabilities()
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "no_new_privs")
    if "landlock" in layers:
        landlock.restrict(readable)
    if "seccomp" in layers:
        seccomp.restrict()


def keep_to(readable: Collection[str], writable: Collection[str]) -> None:
    """Deny this process, permanently, every file except libraries, this package and the named folders; and TCP, if Landlock supports it.

    For processes that run engines on files of unknown origin. Without Landlock in the kernel, nothing is restricted.

    Args:
        readable: Folders to read.
        writable: Folders to read and to write.
    """
    if sys.platform != "linux" or landlock.abi() == 0:
        return
    ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    landlock.restrict([*readable_paths(), str(Path(__file__).parents[1]), *readable], writable)


def die_with_parent(signal_number: int, parent: int) -> None:
    """Ask the kernel to send this process a signal when its parent ends; exit now if it has already ended."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal_number, 0, 0, 0)
    if os.getppid() != parent:
        os._exit(1)


def _limit_resources(limits: ScriptLimits) -> None:
    import resource  # noqa: PLC0415 - Windows has none, and this module is imported there

    cpu = math.ceil(limits.seconds + limits.probe_seconds) + 1  # only a process that defies its timers gets there
    for what, value in (
        (resource.RLIMIT_AS, limits.memory),
        (resource.RLIMIT_FSIZE, limits.file_size),
        (resource.RLIMIT_CPU, cpu),
        (resource.RLIMIT_NOFILE, 64),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_MEMLOCK, 0),
        (resource.RLIMIT_MSGQUEUE, 0),
    ):
        hard = resource.getrlimit(what)[1]
        bound = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (bound, bound))


def _drop_capabilities() -> None:
    """Drop root's capabilities: without them it may not raise limits, mount, or read what belongs to others."""
    libc = ctypes.CDLL(None)
    capability = 0
    while libc.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0) == 0:
        capability += 1
    header = (ctypes.c_uint32 * 2)(_CAPABILITY_VERSION, 0)
    nothing = (ctypes.c_uint32 * 6)()
    number = _CAPSET.get(os.uname().machine)
    if number is not None:
        libc.syscall(number, ctypes.byref(header), ctypes.byref(nothing))
