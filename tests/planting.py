"""A stranger's folder: modules with every name that a program may import; each leaves a mark when it runs."""

from __future__ import annotations

import sys
from importlib import metadata
from pathlib import Path


def planted(folder: Path) -> Path:
    """Plant modules in a folder, which is also somebody's home with packages of its own, and return the file of their marks."""
    mark = folder.parent / f"{folder.name}.mark"
    names = {name for name in {*sys.stdlib_module_names, *metadata.packages_distributions()} if name.isidentifier()}
    names |= {"articad", "sitecustomize", "usercustomize", "pyvista", "pybullet", "distributed", "mcp"}
    user = folder / ".local" / "lib" / f"python{sys.version_info.major}.{sys.version_info.minor}" / "site-packages"
    user.mkdir(parents=True, exist_ok=True)
    text = f"with open({str(mark)!r}, 'a') as mark:\n    mark.write(__file__ + chr(10))\nraise ImportError('planted')\n"
    for place in (folder, user):
        for name in sorted(names):
            (place / f"{name}.py").write_text(text)
    return mark


def written_sparse(path: Path, beginning: bytes, size: int = 0) -> None:
    """Write a file that takes no room: what follows its beginning are zeros that are not stored."""
    with path.open("wb") as stream:
        stream.write(beginning)
        if size > len(beginning):
            stream.truncate(size)
