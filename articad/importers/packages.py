"""ROS packages by name: in a folder above a file, or in the folders that the environment lists.

A package is a folder with a `package.xml`; its `<name>` counts, and so does the name of the folder. `ROS_PACKAGE_PATH` (ROS 1) lists
packages and folders of packages; `AMENT_PREFIX_PATH` (ROS 2) lists prefixes with packages in `share`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from articad.files import read_file

__all__ = ["MANIFEST", "environment_folders", "find_package"]

MANIFEST: Final = "package.xml"
_MOST: Final = 1 << 20  # size limit of a manifest
_NAME: Final = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")


def environment_folders() -> list[Path]:
    """Return the folders of the environment that may be packages or contain packages."""
    ros1, ros2 = (map(Path, os.environ.get(name, "").split(os.pathsep)) for name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"))
    folders = [*ros1, *(entry / "share" for entry in ros2)]
    return [folder.resolve() for folder in folders if folder.is_absolute()]  # a relative one would be the working folder


def find_package(name: str, above: Iterable[Path], folders: Iterable[Path] = ()) -> Path | None:
    """Return the folder of a package.

    Args:
        name: Name of the package.
        above: Folders that may be the package, or contain it, the nearest first: those above a file.
        folders: Further such folders, searched after these.
    """
    if not re.fullmatch(r"[A-Za-z0-9_.-]+", name) or set(name) == {"."}:
        return None
    for folder in (*above, *folders):
        for candidate in (folder, folder / name):
            if _is_package(candidate, name):
                return candidate
    return None


def _is_package(folder: Path, name: str) -> bool:
    try:
        stated = _NAME.search(read_file(folder / MANIFEST, _MOST))
    except OSError:
        return False
    return name in {folder.name, stated[1].decode(errors="replace") if stated else ""}
