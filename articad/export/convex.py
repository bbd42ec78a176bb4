"""Convex pieces of a shape, by CoACD: what they add to the solid and what they leave out is measured, and they are kept by shape.

CoACD (Wei et al. 2022) cuts a mesh until each piece is nearer to its hull than a threshold, a share of the shape's size. It is
seeded, so a shape always falls into the same pieces; it takes seconds to minutes, so pieces are kept where built parts are.
"""

from __future__ import annotations

import hashlib
import io
from dataclasses import dataclass
from importlib.metadata import version
from typing import Final

import manifold3d
import numpy as np
from numpy.typing import NDArray

from articad.errors import ArticadError
from articad.geometry.mesh import TriMesh
from articad.kernels.cache import BuildCache

FloatArray = NDArray[np.float64]

THRESHOLDS: Final = (0.05, 0.02, 0.01)  # of CoACD, coarse to fine; 0.01 is the least that it takes
CONVEX_SHARE: Final = 1e-3  # of its volume: a shape whose hull adds no more is its own only piece
_FILE: Final = "pieces.npz"
_SCHEME: Final = "articad.pieces/1"  # to be changed with anything that changes pieces


@dataclass(frozen=True, eq=False)
class Pieces:
    """Convex pieces that stand for a shape.

    Attributes:
        meshes: In the shape's own frame [mm].
        more: Volume of the pieces outside the shape, as a share of its own; 0 where the shape is open.
        less: Volume of the shape outside the pieces, likewise.
    """

    meshes: tuple[TriMesh, ...]
    more: float
    less: float


def hull_mesh(vertices: FloatArray) -> TriMesh:
    """Return the convex hull of points."""
    return _mesh(manifold3d.Manifold.hull_points(vertices))


def is_convex(mesh: TriMesh) -> bool:
    """True when the hull of a closed mesh adds next to nothing to it."""
    return mesh.is_closed and mesh.volume > 0 and hull_mesh(mesh.vertices).volume <= mesh.volume * (1 + CONVEX_SHARE)


def pieces_of(mesh: TriMesh, fineness: int, cache: BuildCache) -> Pieces:
    """Return the convex pieces of a shape.

    Args:
        mesh: The shape; an open one is closed by CoACD.
        fineness: Index of `THRESHOLDS`.
        cache: Where pieces are kept; one that cannot be written is done without.
    """
    meshes = (hull_mesh(mesh.vertices),) if is_convex(mesh) else _kept(mesh, THRESHOLDS[fineness], cache)
    return Pieces(meshes, *_errors(mesh, meshes))


def whole_hull(mesh: TriMesh) -> Pieces:
    """Return the convex hull of a shape as its only piece."""
    hull = hull_mesh(mesh.vertices)
    return Pieces((hull,), max(0.0, hull.volume / mesh.volume - 1) if mesh.is_closed and mesh.volume > 0 else 0.0, 0.0)


def _kept(mesh: TriMesh, threshold: float, cache: BuildCache) -> tuple[TriMesh, ...]:
    """Return CoACD's pieces from the cache, or put them there."""
    asked = f"{_SCHEME} coacd {version('coacd')} {threshold} {mesh.digest}"
    digest = hashlib.sha256(asked.encode()).hexdigest()
    folder = cache.get(digest)
    if folder is not None:
        return _loaded((folder / _FILE).read_bytes())
    import coacd  # noqa: PLC0415 - needed by those whose pieces are not kept yet

    coacd.set_log_level("error")
    found = coacd.run_coacd(coacd.Mesh(mesh.vertices.copy(), mesh.triangles.copy()), threshold=threshold, seed=0)
    meshes = tuple(hull_mesh(np.asarray(vertices, dtype=np.float64)) for vertices, _ in found)
    try:
        with cache.writing(digest) as new:
            (new / _FILE).write_bytes(_saved(meshes))
    except ArticadError:
        return meshes
    return meshes


def _saved(meshes: tuple[TriMesh, ...]) -> bytes:
    arrays = {f"{kind}{i}": getattr(mesh, kind) for i, mesh in enumerate(meshes) for kind in ("vertices", "triangles")}
    stream = io.BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **arrays)
    return stream.getvalue()


def _loaded(content: bytes) -> tuple[TriMesh, ...]:
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        return tuple(TriMesh(arrays[f"vertices{i}"], arrays[f"triangles{i}"]) for i in range(len(arrays) // 2))


def _errors(mesh: TriMesh, pieces: tuple[TriMesh, ...]) -> tuple[float, float]:
    """Return what the pieces together add to a closed mesh, and what they leave out, as shares of its volume."""
    solid = manifold(mesh)
    own = solid.volume()
    if solid.status() != manifold3d.Error.NoError or own <= 0:
        return 0.0, 0.0
    together = manifold3d.Manifold.batch_boolean([manifold(piece) for piece in pieces], manifold3d.OpType.Add)
    return float((together - solid).volume() / own), float((solid - together).volume() / own)


def manifold(mesh: TriMesh) -> manifold3d.Manifold:
    """Return a mesh as manifold3d takes it, in double precision; look at its status before trusting it."""
    return manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))


def _mesh(solid: manifold3d.Manifold) -> TriMesh:
    found = solid.to_mesh64()
    return TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))
