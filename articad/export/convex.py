"""Collision shapes of a mesh: convex pieces inside it, cached by shape, or its hull."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Final

import manifold3d
import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.export.arrays import load_arrays, save_arrays
from articad.geometry.inscribed import MOST_PIECES, SCHEME, Inscribed, Piece, inscribed
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive
from articad.kernels.cache import BuildCache

_FILE: Final = "pieces.npz"
_FORM: Final = "articad.pieces/2"  # of that file


@dataclass(frozen=True, eq=False)
class Pieces:
    """Convex pieces that replace a shape.

    Attributes:
        pieces: Each in a frame of its own within the shape's [mm].
        missing: Largest distance of the shape's surface from the pieces [mm].
        bound: Intended upper bound of that distance [mm].
        more: Volume of the pieces outside the shape, as a share of its own; 0 for an open shape.
        less: Volume of the shape outside the pieces, likewise.
        inside: False if the pieces are not inside the shape: a hull, or an open mesh that encloses nothing.
    """

    pieces: tuple[Piece, ...]
    missing: float = 0.0
    bound: float = 0.0
    more: float = 0.0
    less: float = 0.0
    inside: bool = True


def hull_mesh(vertices: FloatArray) -> TriMesh:
    """Return the convex hull of points."""
    found = manifold3d.Manifold.hull_points(vertices).to_mesh64()
    return TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))


def pieces_of(mesh: TriMesh, cache: BuildCache, *, deflection: float = 0.0, most: int = MOST_PIECES) -> Pieces:
    """Return convex pieces inside a shape; for a surface that encloses nothing, the mesh itself.

    Args:
        mesh: The shape.
        cache: Where pieces are stored; a failure to write there is ignored.
        deflection: Largest distance between the mesh and the true surface [mm].
        most: Number of pieces.
    """
    faces = hashlib.sha256(b"" if mesh.face is None else np.ascontiguousarray(mesh.face, dtype="<i4").tobytes()).hexdigest()
    digest = hashlib.sha256(f"{SCHEME} {_FORM} {mesh.digest} {faces} {deflection!r} {most}".encode()).hexdigest()
    folder = cache.get(digest)
    if folder is not None:
        found = _loaded((folder / _FILE).read_bytes())
    else:
        found = inscribed(mesh, most=most, deflection=deflection)
        try:
            with cache.writing(digest) as new:
                (new / _FILE).write_bytes(_saved(found))
        except ArticadError:
            pass
    if found is None:
        return Pieces((Piece(mesh, SE3.identity(), None),), inside=False)
    return Pieces(found.pieces, found.missing, found.bound, less=found.less)


def whole_hull(mesh: TriMesh) -> Pieces:
    """Return the convex hull of a shape as its only piece."""
    hull = hull_mesh(mesh.vertices)
    more = max(0.0, hull.volume / mesh.volume - 1) if mesh.is_closed and mesh.volume > 0 else 0.0
    return Pieces((Piece(hull, SE3.identity(), None),), more=more, inside=False)


def as_it_is(mesh: TriMesh, primitive: Primitive | None) -> Pieces:
    """Return a shape as its only piece."""
    return Pieces((Piece(mesh, SE3.identity(), primitive),))


def _saved(found: Inscribed | None) -> bytes:
    if found is None:
        return save_arrays({}, [])
    forms = [None if piece.primitive is None else [piece.primitive.kind, *piece.primitive.size] for piece in found.pieces]
    rows = [{"frame": piece.frame.data.tolist(), "primitive": form} for piece, form in zip(found.pieces, forms, strict=True)]
    head = {"pieces": rows, "missing": found.missing, "bound": found.bound, "less": found.less}
    return save_arrays(head, [piece.mesh for piece in found.pieces])


def _loaded(content: bytes) -> Inscribed | None:
    head, meshes = load_arrays(content)
    if not meshes:
        return None
    pieces = []
    for row, mesh in zip(head["pieces"], meshes, strict=True):
        form = row["primitive"]
        primitive = None if form is None else Primitive(form[0], tuple(form[1:]))
        pieces.append(Piece(mesh, SE3.from_unit_array(np.array(row["frame"])), primitive))
    return Inscribed(tuple(pieces), head["missing"], head["bound"], head["less"])


def manifold(mesh: TriMesh) -> manifold3d.Manifold:
    """Return a mesh as a `manifold3d.Manifold` in double precision; check its status before using it."""
    return manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
