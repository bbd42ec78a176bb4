"""Mesh files of a bundle: each mesh once, in mm and in its own frame; the format that names it gives scale and pose.

Meshes for proofs are finer than drawings need. Visual meshes are simplified by manifold3d, and the deviation of the surface is measured.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Final, Literal, NamedTuple

import manifold3d
import numpy as np

from articad.errors import ArticadError
from articad.export.arrays import load_arrays, save_arrays
from articad.export.convex import manifold
from articad.export.names import FileNames
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import write_obj, write_stl
from articad.geometry.needles import without_needles
from articad.geometry.part import Part, Shape
from articad.kernels.cache import BuildCache

MeshKind = Literal["stl", "obj"]

MM_TO_M = 0.001  # the scale that formats apply to the files
DRAWN_TRIANGLES = 5000  # target size of a visual mesh, within the next bound
DRAWN_SHARE, MOST_SHARE = 5e-4, 8e-3  # of its diagonal: deviation of its surface at first, and at most
DRAWN_MM = 0.05  # deviation at first of a mesh in a file: a pin and its bore, 0.1 mm apart, share no volume there either
THINNEST_MM: Final = 1e-5  # of a visual triangle: points in m have 8 digits after the point, where files keep them in single precision
SCHEME: Final = "articad.drawn/3"  # must change with anything that changes visual meshes
_FILE: Final = "drawn.npz"


class Drawn(NamedTuple):
    """A visual mesh, and its deviation from the original mesh [mm]."""

    mesh: TriMesh
    deviation: float


def drawn(mesh: TriMesh, least: float = 0.0, cache: BuildCache | None = None) -> Drawn:
    """Return a mesh with few triangles in place of one that is finer than drawings need.

    The surface moves by 1/2000 of the mesh's diagonal, on round faces about 0.1 rad between facets, by no more than `DRAWN_MM` unless
    `least` permits it, and by more as long as there are more than `DRAWN_TRIANGLES`.

    Args:
        mesh: The mesh.
        least: Deviation that cannot be seen [mm]; the surface may move by that much in any case.
        cache: Stores results by mesh; the cache of built parts by default. A failure to write there is ignored.
    """
    found = _drawn(_Wanted(mesh.digest, least, mesh, cache))
    return Drawn(mesh, 0.0) if found is None else found


@dataclass(frozen=True)
class _Wanted:
    """A mesh to simplify. Equal meshes with equal deviations are equal, whichever object holds them."""

    digest: str
    least: float
    mesh: TriMesh = field(compare=False)
    cache: BuildCache | None = field(compare=False)


@lru_cache(maxsize=64)
def _drawn(wanted: _Wanted) -> Drawn | None:
    """Return the simplified mesh, from the cache if it is there; None if the mesh stays as it is."""
    cache = wanted.cache or BuildCache()
    digest = hashlib.sha256(f"{SCHEME} {wanted.digest} {wanted.least!r}".encode()).hexdigest()
    folder = cache.get(digest)
    if folder is not None:
        head, meshes = load_arrays((folder / _FILE).read_bytes())
        return Drawn(meshes[0], head["deviation"]) if meshes else None
    found = _simplified(wanted.mesh, wanted.least)
    try:
        with cache.writing(digest) as new:
            head = {} if found is None else {"deviation": found.deviation}
            (new / _FILE).write_bytes(save_arrays(head, [] if found is None else [found.mesh]))
    except ArticadError:
        pass
    return found


def _simplified(mesh: TriMesh, least: float) -> Drawn | None:
    body = manifold(mesh) if mesh.is_closed else None
    if body is None or body.status() != manifold3d.Error.NoError or body.volume() <= 0:
        return None
    size = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0]))
    share = min(max(DRAWN_SHARE, least / size), MOST_SHARE) if least else min(DRAWN_SHARE, DRAWN_MM / size)
    while True:
        found = body.simplify(share * size).to_mesh64()
        if len(found.tri_verts) <= DRAWN_TRIANGLES or share >= MOST_SHARE:
            break
        share *= 2
    coarse = TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))
    fewer = coarse.is_closed and coarse.volume > 0 and len(coarse.triangles) < len(mesh.triangles)
    return Drawn(without_needles(coarse, THINNEST_MM), share * size) if fewer else None


def built_meshes(parts: Iterable[Part]) -> dict[str, TriMesh]:
    """Return the meshes that a kernel made from a B-rep, by digest; other meshes were given by users, and stay as they are."""
    return {part.solid.mesh.digest: part.solid.mesh for part in parts if part.solid is not None and part.solid.deflection > 0}


def drawn_shapes(part: Part, least: float = 0.0, cache: BuildCache | None = None) -> tuple[Shape, ...]:
    """Return the visual shapes of a part, or its collision shapes if it has none; meshes of a built part are simplified.

    Args:
        part: The part.
        least: Deviation that cannot be seen where the part is drawn [mm].
        cache: As for `drawn`.
    """
    built = built_meshes([part])
    shapes = part.visuals or part.collisions
    return tuple(replace(one, mesh=drawn(built[one.mesh.digest], least, cache).mesh) if one.mesh.digest in built else one for one in shapes)


class MeshFiles:
    """Collects the meshes that a document names; equal ones share a file. `by_digest` has the path of each mesh.

    Args:
        kind: Format of the files.
        folder: Their folder.
        prefix: Prefix of their names in the document.
        draws: Whether visual meshes of built parts are simplified.
        cache: As for `drawn`.
    """

    def __init__(
        self, kind: MeshKind = "stl", folder: str = "meshes", prefix: str = "", *, draws: bool = False, cache: BuildCache | None = None
    ) -> None:
        self.kind, self.folder, self.prefix, self.draws, self.cache = kind, folder, prefix, draws, cache
        self.files: dict[str, bytes] = {}
        self._names = FileNames()
        self.by_digest: dict[str, str] = {}
        self._expected: set[str] = set()
        self._built: dict[str, TriMesh] = {}

    def expect(self, parts: Iterable[Part]) -> None:
        """State which parts the records describe, whether or not the document names their meshes."""
        parts = tuple(parts)
        self._expected |= {shape.mesh.digest for part in parts for shape in (*part.visuals, *part.collisions)}
        self._built |= built_meshes(parts) if self.draws else {}

    def path(self, mesh: TriMesh, name: str, kind: MeshKind | None = None) -> str:
        """Return the path of the file of this mesh, and write it if it is new; `name` is the wanted name, `kind` overrides the format."""
        kind = kind or self.kind
        if mesh.digest not in self.by_digest:
            path = f"{self.folder}/{self._names.claim(name)}.{kind}"
            self.by_digest[mesh.digest] = path
            look = self._drawn(mesh).mesh
            self.files[path] = _content(look, kind)
        return self.by_digest[mesh.digest]

    def names(self) -> dict[str, str]:
        """Return the digest of each mesh by the name of its file in the document."""
        return {self.prefix + path: digest for digest, path in self.by_digest.items()}

    def deviation(self, mesh: TriMesh) -> float:
        """Return the deviation of the surface in the file from the mesh [mm]."""
        return self._drawn(mesh).deviation

    def _drawn(self, mesh: TriMesh) -> Drawn:
        return drawn(self._built[mesh.digest], cache=self.cache) if mesh.digest in self._built else Drawn(mesh, 0.0)

    def keep(self, mesh: TriMesh, name: str) -> None:
        """Write the file of a mesh that the document states in another form, if the records name it."""
        if mesh.digest in self._expected:
            self.path(mesh, name)

    def keep_all(self, part: Part, name: str) -> None:
        """Write the files of a part's own collision shapes, for the records."""
        for shape in part.collisions:
            self.keep(shape.mesh, name)

    def uri(self, mesh: TriMesh, name: str) -> str:
        """Return how the document names the file of this mesh; see `path`."""
        return self.prefix + self.path(mesh, name)


def _content(mesh: TriMesh, kind: MeshKind) -> bytes:
    """Return the file of a mesh; its content lives as long as the mesh, because several formats write it."""
    known = mesh.derived
    if kind not in known:
        known[kind] = write_stl(mesh) if kind == "stl" else write_obj(mesh)
    content: bytes = known[kind]
    return content
