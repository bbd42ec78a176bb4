"""Mesh files that a file names: whether they exist and can be read; each is read once."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from articad.errors import ArticadError
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import read_mesh
from articad.importers.reading import Folder

READABLE = (".stl", ".obj", ".glb", ".gltf", ".ply")
Scale = tuple[float, float, float]


@dataclass
class MeshReferences:
    """The meshes that one file names.

    Attributes:
        folder: Confines where they may be.
        paths: Files that were found, by the name in the file.
    """

    folder: Folder
    paths: dict[str, Path] = field(default_factory=dict)
    _raw: dict[Path, TriMesh | tuple[str, str]] = field(default_factory=dict)
    _scaled: dict[tuple[Path, Scale], TriMesh] = field(default_factory=dict)

    def mesh(self, name: str, scale: Scale) -> tuple[TriMesh | None, str, str]:
        """Return a mesh in mm, or what is wrong with it.

        Args:
            name: The name in the file.
            scale: Millimetres per unit of the mesh file, along its axes.

        Returns:
            The mesh or None, the problem in one word ("" if there is none), and in words.
        """
        try:
            path = self.folder.find(name)
        except ArticadError as error:
            unsafe = any(finding.code == "E_UNSAFE_PATH" for finding in error.findings)
            return None, "unsafe" if unsafe else "absent", self._missing(name, unsafe=unsafe)
        self.paths[name] = path
        raw = self._read(path)
        if isinstance(raw, tuple):
            return None, *raw
        if (path, scale) not in self._scaled:
            mesh = TriMesh(raw.vertices * scale, raw.triangles)
            self._scaled[path, scale] = mesh.flipped() if np.prod(scale) < 0 else mesh
        return self._scaled[path, scale], "", ""

    def raw(self, name: str) -> TriMesh | None:
        """Return the mesh of a file in the file's own unit."""
        found = self._raw.get(self.paths[name]) if name in self.paths else None
        return found if isinstance(found, TriMesh) else None

    def _read(self, path: Path) -> TriMesh | tuple[str, str]:
        if path not in self._raw:
            if path.suffix.lower() not in READABLE:
                self._raw[path] = "format", f"{path.suffix or 'no suffix'} is not one of {', '.join(READABLE)}"
            else:
                try:
                    self._raw[path] = read_mesh(path, root=self.folder.root_of(path))
                except ArticadError as error:
                    self._raw[path] = "unreadable", error.message.removeprefix(f"{path}: ")
        return self._raw[path]

    def _missing(self, name: str, *, unsafe: bool) -> str:
        if unsafe:
            return f"it leads out of {self.folder.root.name or self.folder.root}"
        near = self._near.get(Path(name.removeprefix("package://")).name.lower())
        return f"there is no such file, but there is {near}" if near else "there is no such file"

    @cached_property
    def _near(self) -> dict[str, Path]:
        """The files in the file's folder and in the folders in it, by their names in small letters; links are not followed."""
        found: dict[str, Path] = {}
        here = self.folder.here
        for place in (here, *sorted(below for below in here.iterdir() if below.is_dir() and not below.is_symlink())):
            with contextlib.suppress(OSError):
                for file in sorted(place.iterdir()):
                    found.setdefault(file.name.lower(), file.relative_to(here))
        return found
