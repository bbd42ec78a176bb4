"""Mesh files of a bundle: each mesh once, in mm and in its own frame; the format that names it gives scale and place.

Meshes that proofs are made with are finer than pictures need. What is drawn is simplified by manifold3d, which says how far the surface moves.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Literal, NamedTuple

import manifold3d
import numpy as np

from articad.export.convex import manifold
from articad.export.names import Names
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import write_obj, write_stl
from articad.geometry.part import Part

MeshKind = Literal["stl", "obj"]

MM_TO_M = 0.001  # the scale that formats apply to the files
DRAWN_TRIANGLES = 5000  # of a mesh that is drawn, where the next bound allows it
DRAWN_SHARE, MOST_SHARE = 5e-4, 8e-3  # of its diagonal: how far its surface moves to begin with, and at most


class Drawn(NamedTuple):
    """A mesh to draw, and how far its surface is from the mesh that it stands for [mm]."""

    mesh: TriMesh
    deviation: float


@lru_cache(maxsize=64)
def drawn(mesh: TriMesh) -> Drawn:
    """Return a mesh of few triangles for one that is finer than pictures need.

    The surface moves by 1/2000 of the mesh's diagonal, on round faces about 0.1 rad from facet to facet, and by more as long as there are
    more than `DRAWN_TRIANGLES`.
    """
    body = manifold(mesh) if mesh.is_closed else None
    if body is None or body.status() != manifold3d.Error.NoError or body.volume() <= 0:
        return Drawn(mesh, 0.0)
    size = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0]))
    share = DRAWN_SHARE
    while True:
        found = body.simplify(share * size).to_mesh64()
        if len(found.tri_verts) <= DRAWN_TRIANGLES or share >= MOST_SHARE:
            break
        share *= 2
    coarse = TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))
    fewer = coarse.is_closed and coarse.volume > 0 and len(coarse.triangles) < len(mesh.triangles)
    return Drawn(coarse, share * size) if fewer else Drawn(mesh, 0.0)


def built_meshes(parts: Iterable[Part]) -> dict[str, TriMesh]:
    """Return the meshes that a kernel made of a B-rep, by digest; others are what somebody gave, and stay as they are."""
    return {part.solid.mesh.digest: part.solid.mesh for part in parts if part.solid is not None and part.solid.deflection > 0}


class MeshFiles:
    """Collects the meshes that a document names; equal ones share a file. `by_digest` holds the path of each mesh.

    Args:
        kind: Format of the files.
        folder: Their folder.
        prefix: Of their names in the document.
        draws: Whether the meshes of built parts become coarser, to be drawn and no more.
    """

    def __init__(self, kind: MeshKind = "stl", folder: str = "meshes", prefix: str = "", *, draws: bool = False) -> None:
        self.kind, self.folder, self.prefix, self.draws = kind, folder, prefix, draws
        self.files: dict[str, bytes] = {}
        self._names = Names()
        self.by_digest: dict[str, str] = {}
        self._expected: set[str] = set()
        self._built: dict[str, TriMesh] = {}

    def expect(self, parts: Iterable[Part]) -> None:
        """Say which parts the records tell of, whether or not the document names their meshes."""
        parts = tuple(parts)
        self._expected |= {shape.mesh.digest for part in parts for shape in (*part.visuals, *part.collisions)}
        self._built |= built_meshes(parts) if self.draws else {}

    def path(self, mesh: TriMesh, name: str, kind: MeshKind | None = None) -> str:
        """Return the path of the file that holds this mesh, writing it if it is new; `name` is asked for, `kind` overrules."""
        kind = kind or self.kind
        if mesh.digest not in self.by_digest:
            path = f"{self.folder}/{self._names.claim(name)}.{kind}"
            self.by_digest[mesh.digest] = path
            look = self._drawn(mesh).mesh
            self.files[path] = write_stl(look) if kind == "stl" else write_obj(look)
        return self.by_digest[mesh.digest]

    def deviation(self, mesh: TriMesh) -> float:
        """Return how far the surface in the file is from the mesh [mm]."""
        return self._drawn(mesh).deviation

    def _drawn(self, mesh: TriMesh) -> Drawn:
        return drawn(self._built[mesh.digest]) if mesh.digest in self._built else Drawn(mesh, 0.0)

    def keep(self, mesh: TriMesh, name: str) -> None:
        """Write the file of a mesh that the document states in another way, if the records name it."""
        if mesh.digest in self._expected:
            self.path(mesh, name)

    def keep_all(self, part: Part, name: str) -> None:
        """Write the files of a part's own collision shapes, for the records."""
        for shape in part.collisions:
            self.keep(shape.mesh, name)

    def uri(self, mesh: TriMesh, name: str) -> str:
        """Return how the document names the file of this mesh; see `path`."""
        return self.prefix + self.path(mesh, name)
