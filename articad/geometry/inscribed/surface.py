"""The surface of a solid: its triangles, the nearest points of them, and what it encloses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import manifold3d
import numpy as np

from articad.arrays import FloatArray
from articad.geometry.mesh import TriMesh
from articad.geometry.winding import winding_numbers

INSIDE_MM: Final = 1e-4  # by which rounding may move a piece outside the mesh


@dataclass(frozen=True, eq=False)
class Facets:
    """Triangles of a surface.

    Attributes:
        corners: `(N, 3, 3)` [mm].
        normals: Outward unit normals, `(N, 3)`.
        offsets: n·x of each triangle's plane, `(N,)` [mm].
        areas: `(N,)` [mm²].
        inward: Directions in each triangle's plane that point from its edges ab, bc, ca inwards, `(3, N, 3)`.
    """

    corners: FloatArray
    normals: FloatArray
    offsets: FloatArray
    areas: FloatArray
    inward: FloatArray

    @property
    def count(self) -> int:
        """Number of triangles."""
        return len(self.corners)

    @classmethod
    def of(cls, mesh: TriMesh) -> Facets:
        """Return the triangles of a mesh."""
        twice = mesh.normals_of_twice_area
        length = np.linalg.norm(twice, axis=1)
        normals = twice / np.where(length > 0, length, 1.0)[:, None]
        corners = mesh.vertices[mesh.triangles]
        inward = np.array([np.cross(normals, corners[:, (edge + 1) % 3] - corners[:, edge]) for edge in range(3)])
        return cls(corners, normals, (normals * corners[:, 0]).sum(axis=1), length / 2, inward)


def nearest(facets: Facets, seed: FloatArray) -> FloatArray:
    """Return the point of each triangle nearest to the seed, `(N, 3)` (Ericson, Real-Time Collision Detection, 5.1.5)."""
    a, b, c = facets.corners[:, 0], facets.corners[:, 1], facets.corners[:, 2]
    ab, ac, bc = b - a, c - a, c - b
    inside = seed - (facets.normals @ seed - facets.offsets)[:, None] * facets.normals
    best = _on_segment(a, ab, seed)
    for start, way in ((a, ac), (b, bc)):
        other = _on_segment(start, way, seed)
        nearer = ((other - seed) ** 2).sum(axis=1) < ((best - seed) ** 2).sum(axis=1)
        best = np.where(nearer[:, None], other, best)
    within = facets.areas > 0
    for start, inward in zip((a, b, a), facets.inward, strict=True):  # the edges ab, bc, ca
        within &= ((inside - start) * inward).sum(axis=1) >= 0
    return np.asarray(np.where(within[:, None], inside, best))


def _on_segment(start: FloatArray, way: FloatArray, point: FloatArray) -> FloatArray:
    length = np.maximum((way * way).sum(axis=1), 1e-300)
    share = np.clip(((point - start) * way).sum(axis=1) / length, 0.0, 1.0)
    return np.asarray(start + share[:, None] * way)


def encloses(facets: Facets, point: FloatArray) -> bool:
    """Whether a whole surface encloses a point: its winding number is 1, or more where the surface overlaps itself."""
    return bool(winding_numbers(point[None], facets.corners)[0] > 0.5)


def mesh_of(solid: manifold3d.Manifold) -> TriMesh:
    """Return the surface of a `manifold3d` solid."""
    found = solid.to_mesh64()
    return TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))


def manifold_of(mesh: TriMesh) -> manifold3d.Manifold:
    """Return a mesh as a `manifold3d` solid, whatever its status."""
    return manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
