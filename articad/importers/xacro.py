"""Reads xacro: a program that writes a URDF is run in a process of its own, which can read robot packages and nothing else.

xacro's expressions are Python, whose restrictions can be evaded. So the process has no network, starts no program, opens no file for
writing, and none for reading except libraries and the packages (Landlock and seccomp, as for part scripts). If the kernel offers no
Landlock, xacro is not run. The process runs this module with a JSON object and prints the URDF.
"""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import sys
from pathlib import Path
from typing import Any, Final

from articad.errors import ReadError
from articad.files import ROOT_VARIABLE, is_file
from articad.findings import Finding
from articad.importers.packages import environment_folders, find_package
from articad.importers.referenced_files import package_of
from articad.kernels import sandbox
from articad.processes import launcher

__all__ = ["expanded"]

INSTALL: Final = "pip install 'articad[xacro]'"
BY_HAND: Final = "or run `xacro FILE.urdf.xacro > FILE.urdf` and read what it writes"
SECONDS: Final = 30.0  # of wall time: a busy machine may need them for what takes a second of its processor
PROCESSOR: Final = 7  # seconds of processor time; the largest robots of ROS packages take 2
MEMORY: Final = 1 << 30  # bytes


def expanded(path: Path, root: Path | None = None) -> bytes:
    """Return the URDF that a xacro file writes.

    Args:
        path: The file.
        root: Folder that it may read; by default its ROS package, else its own folder. Folders of
            `$ROS_PACKAGE_PATH` and `$AMENT_PREFIX_PATH` are readable, too.

    Raises:
        ReadError: If xacro is not installed, cannot be confined, or fails.
    """
    if not is_file(path):
        raise _error(path, f"There is no file {path}.", "Correct the name.")
    if importlib.util.find_spec("xacro") is None:
        raise _error(path, f"{path} is a xacro file, and xacro is not installed.", f"{INSTALL}, {BY_HAND}.")
    layers = sorted(sandbox.available() & {"landlock", "seccomp"})
    if "landlock" not in layers:
        raise _error(
            path, f"{path} is a program, and this machine cannot confine it: it has no Landlock.", f"Use Linux 5.13 or later, {BY_HAND}."
        )
    readable = _within_root([(root or package_of(path)).resolve(), *environment_folders()])
    order = {"file": str(path.resolve()), "layers": layers, "readable": [str(folder) for folder in readable]}
    limits = launcher.Limits(seconds=SECONDS, memory=MEMORY, processor=PROCESSOR)
    ended = launcher.run([json.dumps(order)], module="articad.importers.xacro", limits=limits)
    if ended.late or ended.code != 0:
        why = f"it did not end within {SECONDS:g} s" if ended.late else ended.last_line
        if ended.code == -signal.SIGKILL and not ended.late:
            why = f"it did not end within {PROCESSOR} s of processor time"
        raise _error(
            path,
            f"{path}: xacro fails: {why}",
            "Correct the file; name folders of other packages in ROS_PACKAGE_PATH or AMENT_PREFIX_PATH.",
        )
    return ended.out


def _within_root(folders: list[Path]) -> list[Path]:
    """Return what may be read of folders, where everything that this process reads has to lie below a root."""
    outermost = os.environ.get(ROOT_VARIABLE)
    if not outermost:
        return folders
    root = Path(outermost).resolve()
    within = [
        folder if folder.is_relative_to(root) else root for folder in folders if root.is_relative_to(folder) or folder.is_relative_to(root)
    ]
    return list(dict.fromkeys(within))


def _error(path: Path, message: str, hint: str) -> ReadError:
    return ReadError(f"{message} {hint}", path=str(path), findings=[Finding(code="E_READ", where=str(path), message=message, hint=hint)])


# ---------------------------------------------------------------------- in the process of its own


def _find(name: str, readable: list[str], file: str) -> str:
    """Return the folder of a ROS package: above the file, or in a folder that may be read."""
    above = [folder for folder in Path(file).parents if any(folder.is_relative_to(one) for one in readable)]
    found = find_package(name, above, map(Path, readable))
    if found is None:
        raise ValueError(f"there is no package {name!r} above {file}, in ROS_PACKAGE_PATH or in AMENT_PREFIX_PATH")
    return str(found)


def main(arguments: list[str]) -> int:
    """Expand a file and print the URDF."""
    import xacro  # noqa: PLC0415 - optional
    from xacro import substitution_args  # noqa: PLC0415

    order: dict[str, Any] = json.loads(arguments[0])
    places = [*sandbox.readable_paths(), str(Path(xacro.__file__).parent), *order["readable"]]
    sandbox.confine(sandbox.ScriptLimits(seconds=SECONDS, memory=2 * MEMORY), order["layers"], places)
    substitution_args._eval_find = lambda name: _find(name, order["readable"], order["file"])  # noqa: SLF001 - xacro's own looks for ROS 2
    try:
        document = xacro.process_file(order["file"])
    except Exception as error:  # noqa: BLE001 - any error is due to the file, and one line reports it
        print(f"{type(error).__name__}: {error}".replace("\n", " "), file=sys.stderr)  # noqa: T201
        return 1
    sys.stdout.write(document.toxml())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
