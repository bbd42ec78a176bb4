"""Find FreeCAD 1.0 or later, and run programs inside it: each in a process of its own, confined if bubblewrap works.

FreeCAD may be the system's own, an extracted AppImage, a conda environment, or a whole Debian tree, as `articad install freecad`
makes if the distribution's FreeCAD is older. Programs inside it never import articad; results come back through files, because FreeCAD writes
to its standard output as it likes.
"""

from __future__ import annotations

import contextlib
import itertools
import math
import os
import re
import signal
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from articad.errors import KernelUnavailableError
from articad.files import user_folder
from articad.findings import Finding
from articad.kernels import landlock, sandbox, seccomp
from articad.kernels.timers import WAITING
from articad.processes import launcher

OLDEST = (1, 0)  # the first FreeCAD with an assembly workbench
HOW_TO_GET = "Run articad install freecad as root (2.3 GB, about 3 minutes), or set ARTICAD_FREECAD to FreeCAD 1.0 or later"
INSTALLER = Path(__file__).with_name("install_freecad.sh")
_NAMES = ("freecadcmd", "FreeCADCmd", "freecad.cmd")
_INSIDE = ("usr/bin", "bin", ".")  # where a tree, an AppImage and a conda environment have the program
_SECONDS = 60.0  # for its version; a cold disk needs 5 s
_VERSION = re.compile(r"FreeCAD,?\s+(?:Version:?\s+)?(\d+)\.(\d+)(?:\.(\d+))?")
_ENVIRONMENT = {
    "HOME": "/tmp",  # noqa: S108 - a private one inside; FreeCAD keeps its settings in the home folder
    "LANG": "C.UTF-8",
    "LC_ALL": "C.UTF-8",  # without it FreeCAD crashes at start
    "PYTHONHASHSEED": "0",
    "SOURCE_DATE_EPOCH": "946684800",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "QT_QPA_PLATFORM": "offscreen",
}
_SYSTEM = ("/usr", "/bin", "/lib", "/lib32", "/lib64", "/libx32", "/sbin")
_SETTINGS = (
    "/etc/ld.so.cache",
    "/etc/ld.so.conf",
    "/etc/ld.so.conf.d",
    "/etc/alternatives",
    "/etc/fonts",
)  # the rest of /etc stays hidden
_INSIDE_PROGRAMS = Path(__file__).parent / "inside_freecad"
_OPEN_FILES = 256
_turns = itertools.count(os.getpid())  # counter of processes inside FreeCAD
_DEFYING_SECONDS = 2
BY_SIGNAL = 128  # the exit code of bubblewrap whose process a signal ended is this and the signal's number
_TAIL = 8000  # bytes of its output that are kept


@dataclass(frozen=True)
class FreeCADLimits:
    """Resources that a process inside FreeCAD may use.

    Attributes:
        seconds: Processor time; the wall clock may be `timers.WAITING` times as long.
        memory: Address space [bytes]; FreeCAD itself takes 1 GiB of it.
        file_size: Largest size of each file it writes [bytes].
        scratch: Size of its private /tmp [bytes].
    """

    seconds: float = 120.0
    memory: int = 4 * 2**30
    file_size: int = 256 * 2**20
    scratch: int = 512 * 2**20


@dataclass(frozen=True)
class FreeCADEnded:
    """How a process inside FreeCAD ended.

    Attributes:
        code: Its exit code; negative for a signal.
        late: Whether it was ended because its processor time or the wall clock was over.
        said: The end of its output, for people only.
        unconfined: Why the sandbox could not be set up, so that nothing of the program ran; empty if it was.
        processor: Its processor time [s]; 0 where the system does not tell.
    """

    code: int
    late: bool
    said: str
    unconfined: str = ""
    processor: float = 0.0

    @property
    def ok(self) -> bool:
        """True if it ended regularly; only its result can say whether it did its work."""
        return self.code == 0


@dataclass(frozen=True)
class FreeCAD:
    """An installation of FreeCAD on this machine.

    Attributes:
        program: Its command-line program, as seen from inside `root`.
        root: The tree of a whole system that contains it; None for a program of this system.
        prefix: A folder outside the system's own that it needs; None if it needs none.
    """

    program: str
    root: Path | None = None
    prefix: Path | None = None

    @property
    def version(self) -> tuple[int, int, int] | None:
        """Its version, or None when it does not start."""
        return _version_of(self)

    @property
    def version_text(self) -> str:
        """Its version as text."""
        return "unknown" if self.version is None else ".".join(map(str, self.version))

    @property
    def where(self) -> str:
        """The program's path, for people."""
        return self.program if self.root is None else f"{self.root}{self.program}"

    def run(
        self,
        program: Path,
        *,
        folder: Path | None = None,
        files: Collection[int] = (),
        arguments: Sequence[str] = (),
        limits: FreeCADLimits | None = None,
        layers: Collection[str] = sandbox.LAYERS,
    ) -> FreeCADEnded:
        """Run a Python file inside FreeCAD; it sees its arguments as `ARGUMENTS`, and no network.

        Args:
            program: The Python file; standard library, FreeCAD's modules, `inside_freecad/numbered.py` and `sizes.py` only.
            folder: Its working folder, to read and to write; without it only a private /tmp can be written.
            files: Open files that it inherits under the same numbers.
            arguments: Its arguments.
            limits: Resources that it may use.
            layers: Layers to apply in addition to bubblewrap's, if available.

        Raises:
            KernelUnavailableError: If it must run in a tree of its own and bubblewrap does not work.
        """
        limits = limits or FreeCADLimits()
        confined = sandbox.bubblewrap_problem() is None
        if self.root is not None and not confined:
            raise unavailable(f"FreeCAD in {self.root} needs bubblewrap, which does not work here ({sandbox.bubblewrap_problem()})")
        shown = "/program.py" if confined else str(program.resolve())
        common = "/confinement" if confined else str(_INSIDE_PROGRAMS)
        run = f"import sys;sys.path.append({common!r});import numbered,sizes;sys.path.remove({common!r})"  # what the programs share
        run += f";ARGUMENTS={list(map(str, arguments))!r};exec(compile(open({shown!r}).read(),{program.name!r},'exec'))"
        before = [*_steady(), *_limited(limits)]
        if not confined:
            environment = _ENVIRONMENT | {"PATH": os.environ.get("PATH", os.defpath), "HOME": str(folder or "/nonexistent")}
            return _ran([*before, self.program, "-c", run], environment, folder, files, WAITING * limits.seconds)
        fault, faulty = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
        try:
            inner = [self.program, "-c", f"{self._confinement(folder, limits, layers, faulty)};{run}"]
            command = [*before, *self._confined(inner, program, folder, limits, layers)]
            ended = _ran(command, {}, None, [*files, faulty], WAITING * limits.seconds)
            with contextlib.suppress(BlockingIOError):
                ended = replace(ended, unconfined=os.read(fault, 500).decode(errors="replace"))
        finally:
            os.close(fault)
            os.close(faulty)
        return ended

    def _confinement(self, folder: Path | None, limits: FreeCADLimits, layers: Collection[str], faulty: int) -> str:
        """Return the words of Python that confine the process from inside, once nothing is left to be executed."""
        told = {
            "fault": faulty,
            "layers": sorted({"landlock", "seccomp"} & set(layers) & sandbox.available()),
            "limits": {
                "AS": limits.memory,
                "FSIZE": limits.file_size,
                "CPU": _processor_time(limits)[1],
                "NOFILE": _OPEN_FILES,
                "CORE": 0,
                "MEMLOCK": 0,
            },
            "readable": ["/program.py"] + ([] if self.prefix is None else [str(self.prefix)]),
            "turn": next(_turns),
            "writable": ["/tmp"] + ([] if folder is None else ["/work"]),  # noqa: S108 - a private one
        }
        return f"exec(compile(open('/confinement/confinement.py').read(),'confinement.py','exec'),{{'CONFINEMENT':{told!r}}})"

    def _confined(
        self, inner: Sequence[str], program: Path, folder: Path | None, limits: FreeCADLimits, layers: Collection[str] = sandbox.LAYERS
    ) -> list[str]:
        work = ["--bind", str(folder), "/work", "--chdir", "/work"] if folder is not None else ["--chdir", "/tmp"]  # noqa: S108 - a private one
        variables = [word for name, value in _ENVIRONMENT.items() for word in ("--setenv", name, value)]
        return [
            sandbox.bubblewrap(),
            *self._mounts(),
            *("--size", str(limits.scratch), "--tmpfs", "/tmp", *self._processes(layers), "--dev", "/dev", "--remount-ro", "/dev"),  # noqa: S108 - a private one
            *("--ro-bind", str(program.resolve()), "/program.py"),
            *("--ro-bind", str(_INSIDE_PROGRAMS / "passwd"), "/etc/passwd"),  # one line of ours: without a home in it FreeCAD crashes
            *(word for name, file in _confinement_files().items() for word in ("--ro-bind", str(file), f"/confinement/{name}")),
            *("--unshare-all", "--unshare-user", "--uid", "65534", "--gid", "65534", "--cap-drop", "ALL"),
            *sandbox.disable_user_namespaces(),
            *("--new-session", "--die-with-parent", "--hostname", "sandbox", "--clearenv"),
            *("--setenv", "PATH", "/usr/bin:/bin", *variables),
            *work,
            *("--remount-ro", "/"),  # bubblewrap's own root is in memory, of unlimited size
            *inner,
        ]

    def _processes(self, layers: Collection[str]) -> tuple[str, ...]:
        """Return the mount options for /proc.

        Landlock hides all of it except for a process's own folder. Without Landlock it is not mounted: a process of root could change
        kernel settings there, and any other could write into the memory of bubblewrap's own process, which seccomp does not restrict.
        FreeCAD only needs it to find the path of its program.
        """
        if "landlock" in layers and "landlock" in sandbox.available():
            return ("--proc", "/proc")
        return ("--dir", "/proc/self", "--symlink", self._resolved(), "/proc/self/exe")

    def _resolved(self) -> str:
        """Return the program's own path, as the process inside sees it."""
        path, root = self.program, self.root or Path("/")
        for _ in range(16):
            place = root / path.lstrip("/")
            if not place.is_symlink():
                break
            path = os.path.normpath(Path(path).parent / place.readlink())
        return path

    def _mounts(self) -> Iterator[str]:
        """Yield the mounts: the libraries and settings of a system, never its homes or data."""
        root = self.root or Path("/")
        for path in (*_SYSTEM, *_SETTINGS):
            source = root / path[1:]
            if source.is_symlink():
                yield from ("--symlink", str(source.readlink()), path)
            elif source.exists():
                yield from ("--ro-bind", str(source), path)
        if self.prefix is not None:
            yield from ("--ro-bind", str(self.prefix), str(self.prefix))


def find() -> FreeCAD:
    """Return the FreeCAD to use: `$ARTICAD_FREECAD`, the PATH, the tree that `articad install freecad` makes, conda, an AppImage.

    Raises:
        KernelUnavailableError: If there is none of version 1.0 or later; says where it was looked for and how to install it.
    """
    return _found(os.environ.get("ARTICAD_FREECAD", ""), os.environ.get("PATH", ""), os.environ.get("CONDA_PREFIX", ""), str(tree()))


def installed() -> tuple[FreeCAD, ...]:
    """Return the FreeCAD to use, and the newer one that `articad install freecad --next` leaves beside it, where they are."""
    found: list[FreeCAD] = []
    with contextlib.suppress(KernelUnavailableError):
        found.append(find())
    beside = _at(tree().with_name("freecad-next"))
    if beside is not None and beside not in found and beside.version is not None:
        found.append(beside)
    return tuple(found)


def tree() -> Path:
    """Return the folder that `articad install freecad` fills."""
    return user_folder("XDG_DATA_HOME", ".local/share") / "articad" / "freecad"


def unavailable(why: str, looked_in: Sequence[str] = ()) -> KernelUnavailableError:
    """Return the error that says why there is no FreeCAD to use and what to do."""
    message = f"{why[:1].upper()}{why[1:]}."
    finding = Finding(code="E_KERNEL_UNAVAILABLE", where="kernels.freecad", message=message, hint=f"{HOW_TO_GET}.")
    return KernelUnavailableError(f"{message} {HOW_TO_GET}.", findings=[finding], looked_in=looked_in, how_to_get=HOW_TO_GET)


@cache
def _found(asked: str, path: str, conda: str, data: str) -> FreeCAD:
    looked_in, older = [], []
    for label, candidate in _candidates(asked, path, conda, data):
        looked_in.append(label)
        if candidate is None:
            if label.startswith("$"):
                older.append(f"{asked} contains no FreeCAD")
                break
            continue
        version = candidate.version
        if version is not None and version[:2] >= OLDEST:
            return candidate
        older.append(f"{candidate.where} {'is ' + candidate.version_text if version else 'does not start'}")
        if label.startswith("$"):
            break  # what the user named is not replaced by something else
    why = f"FreeCAD 1.0 or later was not found{': ' + ', '.join(older) if older else ''}"
    raise unavailable(why, looked_in)


def _candidates(asked: str, path: str, conda: str, data: str) -> Iterator[tuple[str, FreeCAD | None]]:
    if asked:
        yield f"$ARTICAD_FREECAD ({asked})", _at(Path(asked).absolute())
    for name in _NAMES:
        found = launcher.which(name, path=path)
        if found:
            yield f"{name} on the PATH", _program(Path(found))
    yield data, _at(Path(data))
    if conda:
        yield f"conda environment {conda}", _at(Path(conda))
    for image in sorted(Path(data).parent.glob("*.AppImage")):
        yield f"{image}: run it with --appimage-extract and set ARTICAD_FREECAD to the folder", None


def _at(place: Path) -> FreeCAD | None:
    """Return the FreeCAD for a program, a system's tree, an extracted AppImage or an environment."""
    if place.is_file():
        return _program(place)
    whole = (place / "etc").is_dir() and (place / "usr" / "lib").is_dir() and not (place / "AppRun").exists()
    for inside in _INSIDE:
        for name in _NAMES:
            program = place / inside / name
            if whole and (program.is_symlink() or program.is_file()):  # a link may only lead somewhere inside the tree
                return FreeCAD(f"/{inside}/{name}", root=place)
            if program.is_file():
                return FreeCAD(str(program.absolute()), prefix=place.absolute())
    return None


def _program(path: Path) -> FreeCAD:
    home = path.resolve().parent.parent
    own = home.is_relative_to("/usr") or home == Path("/")
    return FreeCAD(str(path), prefix=None if own else home)


@cache
def _version_of(freecad: FreeCAD) -> tuple[int, int, int] | None:
    command = [freecad.program, "--version"]
    try:
        if freecad.root is not None:
            command = freecad._confined(command, Path(__file__), None, FreeCADLimits())  # noqa: SLF001 - of this module
        ended = _ran(command, _ENVIRONMENT | {"PATH": "/usr/bin:/bin"}, None, (), _SECONDS)
    except OSError:
        return None
    match = _VERSION.search(ended.said)
    return None if match is None else (int(match[1]), int(match[2]), int(match[3] or 0))


@cache
def _steady() -> list[str]:
    """Return the command that starts a program at the same addresses each time: FreeCAD's sketch solver orders numbers by address.

    Otherwise solved sketches differ in the last bits between processes, and so do all files made from them.
    """
    setarch = launcher.which("setarch")
    if setarch is None or _ran([setarch, "-R", "true"], {"PATH": "/usr/bin:/bin"}, None, (), _SECONDS).code != 0:
        return []
    return [setarch, "-R"]


def _limited(limits: FreeCADLimits) -> list[str]:
    prlimit = launcher.which("prlimit")
    if prlimit is None:
        return []
    bounds = {
        "as": limits.memory,
        "fsize": limits.file_size,
        "cpu": "{}:{}".format(*_processor_time(limits)),
        "nofile": _OPEN_FILES,
        "core": 0,
    }
    return [prlimit, *(f"--{name}={value}" for name, value in bounds.items())]


def _processor_time(limits: FreeCADLimits) -> tuple[int, int]:
    """Return the whole seconds after which a process gets SIGXCPU, and after which it is killed if it defies that."""
    soft = math.ceil(max(limits.seconds, 0.0)) + 1
    return soft, soft + _DEFYING_SECONDS


def _confinement_files() -> dict[str, Path]:
    """Return the files that are visible in /confinement."""
    modules = {f"{module.__name__.rpartition('.')[2]}.py": Path(str(module.__file__)) for module in (landlock, seccomp)}
    return {name: _INSIDE_PROGRAMS / name for name in ("confinement.py", "numbered.py", "sizes.py")} | modules


def _ran(command: Sequence[str], environment: dict[str, str], folder: Path | None, files: Collection[int], seconds: float) -> FreeCADEnded:
    limits, place = launcher.Limits(seconds=seconds), None if folder is None else str(folder)
    ended = launcher.run(command, environment=environment, folder=place, files=files, limits=limits, merged=True)
    late = ended.late or ended.code in (-signal.SIGXCPU, BY_SIGNAL + signal.SIGXCPU)
    return FreeCADEnded(ended.code, late, ended.out[-_TAIL:].decode(errors="replace"), processor=ended.processor)
