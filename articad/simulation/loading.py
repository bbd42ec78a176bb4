"""Tests whether an engine loads a file as it is. This runs in a process of its own, because some engines abort on a bad file.

The process runs this module with `ENGINE FILE` and prints one JSON object.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any, Literal

from articad.kernels import sandbox
from articad.processes import launcher

Engine = Literal["mujoco", "pinocchio", "pybullet"]

ENGINES: dict[str, tuple[Engine, ...]] = {"urdf": ("mujoco", "pinocchio", "pybullet"), "mjcf": ("mujoco", "pybullet")}
"""Engines by format of the file."""

SECONDS = 60.0
MEMORY = 4 << 30  # bytes of data of a process
FILE_SIZE = 64 << 20  # bytes of each file that an engine writes: its log
MOST_BODIES = 300  # whose pairs are checked one by one
_MESSAGE = 300  # characters of an engine's message that are kept
_NO_TEXT = "it opens no file whose name or folder has bytes that are not UTF-8"


@dataclass(frozen=True)
class Loading:
    """The result of loading a file in an engine.

    Attributes:
        engine: Its name.
        version: Its version; "" if it is not installed.
        loads: Whether it loaded the file; None if it is not installed or did not finish.
        message: The engine's own message, if it did not.
        simple: MuJoCo: bodies with a colliding box, sphere, capsule, cylinder or ellipsoid.
        excluded: MuJoCo: pairs of bodies that masks or exclusions keep from colliding.
        mass: MuJoCo: mass of everything that moves [kg].
        late: Time after which it was stopped [s].
    """

    engine: Engine
    version: str = ""
    loads: bool | None = None
    message: str = ""
    simple: tuple[str, ...] = ()
    excluded: tuple[tuple[str, str], ...] = ()
    mass: float | None = None
    late: float | None = None

    def to_json(self) -> dict[str, Any]:
        """Return the row of a report."""
        return {"engine": self.engine, "version": self.version, "loads": self.loads, "message": self.message, "mass_kg": self.mass}


def load(engine: Engine, path: Path, *, root: Path | None = None, seconds: float = SECONDS) -> Loading:
    """Load a file in an engine, in a process of its own with limited time and memory.

    Args:
        engine: Its name.
        path: The file.
        root: Folder that the engine may read; the file's own by default. Landlock enforces it if the machine has it.
        seconds: Time after which it is killed.
    """
    with start(engine, path, root=root, seconds=seconds) as child:
        return _answer(engine, child.finish(), seconds)


def load_in_all(path: Path, engines: tuple[Engine, ...], *, root: Path | None = None, seconds: float = SECONDS) -> tuple[Loading, ...]:
    """Load a file in several engines in parallel; see `load`."""
    with contextlib.ExitStack() as stack:
        started = [(engine, stack.enter_context(start(engine, path, root=root, seconds=seconds))) for engine in engines]
        return tuple(_answer(engine, child.finish(), seconds) for engine, child in started)


def start(engine: Engine, path: Path, *, root: Path | None = None, seconds: float = SECONDS) -> launcher.Child:
    """Start the process that loads a file."""
    limits = launcher.Limits(seconds=seconds, memory=MEMORY, file_size=FILE_SIZE)
    return launcher.start([engine, *places(path, root)], module="articad.simulation.loading", limits=limits)


def places(path: Path, root: Path | None) -> tuple[str, str]:
    """Return the absolute paths of a file and of the folder that an engine may read."""
    return str(path.resolve()), str((root or path.resolve().parent).resolve())


def _answer(engine: Engine, ended: launcher.Ended, seconds: float) -> Loading:
    if ended.late:
        return Loading(engine, "?", message=f"it did not finish within {seconds:g} s", late=seconds)
    try:
        answer = answer_in(ended.out)
    except (ValueError, IndexError):
        return Loading(engine, "?", loads=False, message=f"its process ended with {ended.how}")
    pairs = tuple((str(a), str(b)) for a, b in answer.pop("excluded", ()))
    return Loading(**answer | {"engine": engine, "simple": tuple(answer.get("simple", ())), "excluded": pairs})


def answer_in(out: bytes) -> dict[str, Any]:
    """Return the JSON object that a process printed, among other output of its libraries.

    Raises:
        ValueError: If there is none.
        IndexError: The same.
    """
    answer: dict[str, Any] = json.loads([line for line in out.decode(errors="replace").splitlines() if line.startswith("{")][-1])
    return answer


# ---------------------------------------------------------------------- in the process of its own


def main(arguments: list[str]) -> int:
    """Load a file and print the result."""
    engine, path, root = arguments
    sandbox.keep_to([root], [str(Path.cwd())])
    with _captured() as said:
        try:
            # engines take names as UTF-8
            answer = _LOADERS[engine](Path(path), said) if _is_text(path) else {"version": "", "loads": None, "message": _NO_TEXT}
        except ImportError:
            answer = {"version": "", "loads": None, "message": "it is not installed"}
    print(json.dumps(answer))  # noqa: T201 - this is the answer
    return 0


def _is_text(path: str) -> bool:
    """Whether a path has no bytes that are not UTF-8."""
    try:
        path.encode()
    except UnicodeEncodeError:
        return False
    return True


def _mujoco(path: Path, said: io.StringIO) -> dict[str, Any]:
    import mujoco  # noqa: PLC0415

    del said
    version = str(mujoco.__version__)
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except (ValueError, mujoco.FatalError) as error:
        return {"version": version, "loads": False, "message": _plain(str(error))}
    return {"version": version, "loads": True, "mass": float(model.body_mass[1:].sum()), **_filters(mujoco, model)}


def _filters(mujoco: Any, model: Any) -> dict[str, Any]:
    """Return which bodies are simple, and which pairs never collide in any pose."""
    names = [model.body(index).name or f"body_{index}" for index in range(model.nbody)]
    kinds = mujoco.mjtGeom
    simple_kinds = set(
        map(int, (kinds.mjGEOM_BOX, kinds.mjGEOM_SPHERE, kinds.mjGEOM_CYLINDER, kinds.mjGEOM_CAPSULE, kinds.mjGEOM_ELLIPSOID))
    )
    geoms: list[list[int]] = [[] for _ in names]
    for geom in range(model.ngeom):
        if model.geom_contype[geom] or model.geom_conaffinity[geom]:
            geoms[model.geom_bodyid[geom]].append(geom)
    simple = [name for name, own in zip(names, geoms, strict=True) if any(int(model.geom_type[geom]) in simple_kinds for geom in own)]
    if model.nbody > MOST_BODIES:
        return {"simple": simple}
    excluded = {frozenset((int(code) >> 16, int(code) & 0xFFFF)) for code in model.exclude_signature}
    pairs = []
    for a, b in combinations(range(model.nbody), 2):
        meet = any(
            (model.geom_contype[g] & model.geom_conaffinity[h]) or (model.geom_contype[h] & model.geom_conaffinity[g])
            for g in geoms[a]
            for h in geoms[b]
        )
        if frozenset((a, b)) in excluded or not meet:
            pairs.append((names[a], names[b]))
    return {"simple": simple, "excluded": pairs}


def _pinocchio(path: Path, said: io.StringIO) -> dict[str, Any]:
    import pinocchio  # noqa: PLC0415

    version = str(pinocchio.__version__)
    try:
        model = pinocchio.buildModelFromUrdf(str(path))
    except (ValueError, RuntimeError) as error:
        return {"version": version, "loads": False, "message": _plain(f"{error} {said.getvalue()}")}
    return {"version": version, "loads": True, "mass": float(sum(inertia.mass for inertia in model.inertias))}


def _pybullet(path: Path, said: io.StringIO) -> dict[str, Any]:
    pybullet: Any = importlib.import_module("pybullet")  # an extra: it has no wheels for later Pythons
    client = pybullet.connect(pybullet.DIRECT)
    version = str(pybullet.getAPIVersion(client))
    try:
        if path.suffix.lower() == ".urdf":
            pybullet.loadURDF(str(path), physicsClientId=client)
        else:
            pybullet.loadMJCF(str(path), physicsClientId=client)
    except pybullet.error as error:
        lines = [line for line in said.getvalue().splitlines() if "rror" in line or "annot" in line or "Could not" in line]
        return {"version": version, "loads": False, "message": _plain(" ".join([str(error), *lines[:3]]))}
    finally:
        pybullet.disconnect(client)
    return {"version": version, "loads": True}


_LOADERS = {"mujoco": _mujoco, "pinocchio": _pinocchio, "pybullet": _pybullet}


class _Said(io.StringIO):
    """The output of a library below Python."""

    def __init__(self, file: Any) -> None:
        super().__init__()
        self._file = file

    def getvalue(self) -> str:
        """Return everything up to now."""
        self._file.flush()
        self._file.seek(0)
        return str(self._file.read().decode(errors="replace"))


@contextlib.contextmanager
def _captured() -> Iterator[_Said]:
    """Redirect stdout and stderr of this process to a file, including those of C libraries."""
    with tempfile.TemporaryFile() as file:
        kept = os.dup(1)
        sys.stdout.flush()
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        try:
            yield _Said(file)
        finally:
            sys.stdout.flush()
            os.dup2(kept, 1)


def _plain(text: str) -> str:
    """Return an engine's message as one line, without the machine's folders."""
    line = re.sub(r"\x1b\[[0-9;]*m", "", " ".join(text.split()))
    line = re.sub(r"(?<![\w.:/])/(?:[\w.@+-]+/)+", "", line.replace("file:///", "/"))
    return line[:_MESSAGE]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
