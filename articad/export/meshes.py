"""Mesh files of a bundle: each mesh once, in mm and in its own frame; the format that names it gives scale and place."""

from __future__ import annotations

from typing import Literal

from articad.export.names import Names
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import write_obj, write_stl

MeshKind = Literal["stl", "obj"]

MM_TO_M = 0.001  # the scale that formats apply to the files


class MeshFiles:
    """Collects the meshes that a document names; equal ones share a file. `by_digest` holds the path of each mesh."""

    def __init__(self, kind: MeshKind = "stl", folder: str = "meshes", prefix: str = "") -> None:
        self.kind, self.folder, self.prefix = kind, folder, prefix
        self.files: dict[str, bytes] = {}
        self._names = Names()
        self.by_digest: dict[str, str] = {}

    def path(self, mesh: TriMesh, name: str, kind: MeshKind | None = None) -> str:
        """Return the path of the file that holds this mesh, writing it if it is new; `name` is asked for, `kind` overrules."""
        kind = kind or self.kind
        if mesh.digest not in self.by_digest:
            path = f"{self.folder}/{self._names.claim(name)}.{kind}"
            self.by_digest[mesh.digest] = path
            self.files[path] = write_stl(mesh) if kind == "stl" else write_obj(mesh)
        return self.by_digest[mesh.digest]

    def uri(self, mesh: TriMesh, name: str) -> str:
        """Return how the document names the file of this mesh; see `path`."""
        return self.prefix + self.path(mesh, name)
