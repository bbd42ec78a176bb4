"""The result of MuJoCo's compiler for a file, from a process of its own: MuJoCo parses untrusted files there and not in this one.

The process runs this module with `FILE ROOT`. It has limited memory and time, and reads ROOT and no other folder if the machine can
confine it. It leaves the numbers and names of the compiled model in the file `model` of its private folder: one line of JSON that
describes the arrays, then their bytes in the same order.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from articad import files
from articad.errors import ReadError
from articad.importers.reading import unreadable
from articad.kernels import sandbox
from articad.processes import launcher, scratch

__all__ = ["Compiled", "compiled_mjcf"]

SECONDS: Final = 60.0
MEMORY: Final = 4 << 30  # bytes
_FILE: Final = "model"
_MOST: Final = 1 << 30  # bytes of the numbers of a model
_TYPES: Final = frozenset({"float64", "float32", "int64", "int32", "int8", "uint8", "bool"})
_PREFIXES: Final = (
    "body_",
    "jnt_",
    "dof_",
    "geom_",
    "site_",
    "cam_",
    "light_",
    "mat_",
    "eq_",
    "qpos",
    "mesh_vert",
    "mesh_face",
    "mesh_pos",
)
"""Arrays of a model that readers use; textures, normals, bounding volumes and the like are left out."""
_ROWS: Final = {
    "body": "nbody",
    "jnt": "njnt",
    "dof": "nv",
    "geom": "ngeom",
    "site": "nsite",
    "cam": "ncam",
    "light": "nlight",
    "eq": "neq",
}
"""The number of rows of the arrays with these prefixes."""
# fmt: off
_NAMED: Final = (
    "BODY", "JOINT", "GEOM", "SITE", "CAMERA", "LIGHT", "EQUALITY",
    "ACTUATOR", "SENSOR", "TENDON", "KEY", "PAIR", "EXCLUDE", "NUMERIC", "TEXT", "TUPLE",
)
# fmt: on
_ENUMS: Final = ("mjtObj", "mjtJoint", "mjtGeom", "mjtEq")
_USUAL: Final = '<mujoco><worldbody><body><joint/><geom size="1"/><site/><camera/><light/></body></worldbody></mujoco>'


class Compiled:
    """The numbers of a compiled model under MuJoCo's own names (`body_pos`, `njnt`, `mjGEOM_BOX`), as in `MjModel`.

    `qpos`, `xpos` and `xmat` are those of `MjData` at the keyframe "home", else at the file's own pose.

    Attributes:
        usual: A model of empty elements: MuJoCo's values where a file states nothing.
        warnings: MuJoCo's warnings.
    """

    def __init__(
        self, numbers: Mapping[str, Any], names: Mapping[str, Sequence[str]], usual: Compiled | None = None, warnings: Sequence[str] = ()
    ) -> None:
        self._numbers, self._names = numbers, names
        self.usual = self if usual is None else usual
        self.warnings = tuple(warnings)

    def __getattr__(self, field: str) -> Any:
        try:
            return self.__dict__["_numbers"][field]
        except KeyError:
            raise AttributeError(field) from None

    def name(self, kind: str, index: int) -> str:
        """Return the name of an element, "" if it has none; `kind` as in `mjOBJ_KIND`."""
        return self._names[kind][index]

    def word(self, enum: str, value: int) -> str:
        """Return MJCF's keyword for a value of an enumeration; `word("GEOM", 6)` is "box"."""
        prefix = f"mj{enum}_"
        return (
            next(name for name, number in self._numbers.items() if name.startswith(prefix) and number == value).removeprefix(prefix).lower()
        )


def compiled_mjcf(path: Path, root: Path) -> Compiled:
    """Compile an MJCF file.

    Args:
        path: The file.
        root: Folder that MuJoCo may read.

    Raises:
        ReadError: If MuJoCo refuses the file, or does not end within its limits.
    """
    limits = launcher.Limits(seconds=SECONDS, memory=MEMORY, file_size=_MOST)
    with scratch.folder("mjcf") as folder:
        ended = launcher.run([str(path.resolve()), str(root.resolve())], module=__name__, limits=limits, folder=folder)
        if ended.late:
            raise unreadable(path, "", f"MuJoCo's compiler did not end within {SECONDS:g} s.")
        try:
            data = files.read_left(Path(folder) / _FILE, _MOST)
        except OSError:
            raise unreadable(path, "", f"MuJoCo's compiler ended with {ended.how}: {ended.last_line}") from None
    return _read(data, path)


def _read(data: bytes, path: Path) -> Compiled:
    """Return the model in the answer of the process. It read untrusted input, so every field is checked."""
    head, _, rest = data.partition(b"\n")
    try:
        answer = json.loads(head)
        if refused := answer.get("refused"):
            raise unreadable(path, "", f"MuJoCo refuses it: {refused}")
        models, at = [], 0
        for part in (answer["usual"], answer["model"]):
            numbers: dict[str, Any] = {str(name): int(value) for name, value in {**answer["words"], **part["counts"]}.items()}
            for name, kind, shape in part["arrays"]:
                numbers[str(name)], at = _array(rest, at, kind, shape)
            _require_rows(numbers)
            names = {str(kind): [str(name) for name in found] for kind, found in part["names"].items()}
            models.append((numbers, names))
        warnings = [str(text) for text in answer["warnings"]]
    except ReadError:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise unreadable(path, "", f"MuJoCo's compiler gave no model: {type(error).__name__}: {error}") from None
    (usual, no_names), (numbers, names) = models
    return Compiled(numbers, names, Compiled(usual, no_names), warnings)


def _array(data: bytes, at: int, kind: str, shape: list[int]) -> tuple[NDArray[Any], int]:
    """Return an array of the answer, and the position of the next one."""
    if kind not in _TYPES or any(type(length) is not int or length < 0 for length in shape):
        raise ValueError(f"an array of type {kind} and shape {shape}")
    count = int(np.prod(shape, dtype=np.float64))
    array = np.frombuffer(data, dtype=kind, count=count, offset=at) if count else np.empty(0, dtype=kind)
    return array.reshape(shape), at + array.nbytes


def _require_rows(numbers: Mapping[str, Any]) -> None:
    """Check the sizes of arrays against the numbers of their elements, and indices against the numbers of existing elements."""
    for name, value in numbers.items():
        count = _ROWS.get(name.partition("_")[0])
        if count and isinstance(value, np.ndarray) and len(value) != numbers[count]:
            raise ValueError(f"{name} has {len(value)} rows, but {count} is {numbers[count]}")
    of_meshes = numbers["geom_dataid"][numbers["geom_type"] == numbers["mjGEOM_MESH"]]  # of other geoms it leads to height fields
    for name, indices, count in (
        ("body_parentid", numbers["body_parentid"], "nbody"),
        ("jnt_dofadr", numbers["jnt_dofadr"], "nv"),
        ("jnt_qposadr", numbers["jnt_qposadr"], "nq"),
        ("site_bodyid", numbers["site_bodyid"], "nbody"),
        ("geom_dataid", of_meshes, "nmesh"),
    ):
        if np.any(indices >= numbers[count]) or np.any(indices < 0):
            raise ValueError(f"{name} leads beyond {count}")


# ---------------------------------------------------------------------- in the process of its own


def main(arguments: list[str]) -> int:
    """Compile a file and write its model into the working folder."""
    path, root = arguments
    sandbox.keep_to([root], [str(Path.cwd())])
    import mujoco  # noqa: PLC0415

    warnings: list[str] = []
    mujoco.set_mju_user_warning(warnings.append)
    try:
        compiled = mujoco.MjModel.from_xml_path(path)
    except (ValueError, RuntimeError, mujoco.FatalError) as error:  # RuntimeError: its own parser failed
        Path(_FILE).write_bytes(json.dumps({"refused": str(error)}).encode())
        return 0
    words = {word: int(value) for enum in _ENUMS for word, value in getattr(mujoco, enum).__members__.items()}
    usual, usual_arrays = _described(mujoco, mujoco.MjModel.from_xml_string(_USUAL))
    model, arrays = _described(mujoco, compiled)
    head = {"words": words, "usual": usual, "model": model, "warnings": warnings}
    with Path(_FILE).open("wb") as file:
        file.write(json.dumps(head).encode() + b"\n")
        file.writelines(array.tobytes() for array in (*usual_arrays, *arrays))
    return 0


def _described(mujoco: Any, compiled: Any) -> tuple[dict[str, Any], list[NDArray[Any]]]:
    """Return the counts, names and shapes of a model in its home pose, and its arrays."""
    data = mujoco.MjData(compiled)
    home = mujoco.mj_name2id(compiled, mujoco.mjtObj.mjOBJ_KEY, "home")
    if home >= 0:
        mujoco.mj_resetDataKeyframe(compiled, data, home)
    mujoco.mj_kinematics(compiled, data)
    fields = {name: getattr(compiled, name) for name in dir(compiled) if name.startswith((*_PREFIXES, "n"))}
    counts = {name: value for name, value in fields.items() if isinstance(value, int)}
    fields |= {"qpos": data.qpos, "xpos": data.xpos, "xmat": data.xmat}
    arrays = {name: np.ascontiguousarray(value) for name, value in fields.items() if isinstance(value, np.ndarray)}
    described = [(name, str(array.dtype), list(array.shape)) for name, array in arrays.items()]
    return {"counts": counts, "names": _names(mujoco, compiled), "arrays": described}, list(arrays.values())


def _names(mujoco: Any, compiled: Any) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for kind in _NAMED:
        value = getattr(mujoco.mjtObj, f"mjOBJ_{kind}")
        names: list[str] = []
        while (name := mujoco.mj_id2name(compiled, value, len(names))) is not None or len(names) < _count(compiled, kind):
            names.append(name or "")
        found[kind] = names
    return found


def _count(compiled: Any, kind: str) -> int:
    """Return how many elements of a kind there are; before MuJoCo 4 every actuator had one control."""
    field = {"JOINT": "njnt", "CAMERA": "ncam", "EQUALITY": "neq"}.get(kind, f"n{kind.lower()}")
    return int(getattr(compiled, field, compiled.nu if kind == "ACTUATOR" else 0))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
