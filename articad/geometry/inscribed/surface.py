"""The surface of a solid: its triangles, the nearest points of them, and what it encloses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import manifold3d
import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.geometry.mesh import TriMesh
from articad.geometry.winding import winding_numbers

INSIDE_MM: Final = 1e-4  # by which rounding may move a piece outside the mesh
_DECIDE = 9  # digits that decide between alternatives; further ones depend on the processor, and solids are often symmetric


class _Sides(NamedTuple):
    """Sides of triangles in columns.

    Attributes:
        starts: First points of ab, ac and bc, `(3, 3, N)` [mm].
        ways: From these to the other ends, `(3, 3, N)` [mm].
        squares: Squared lengths, `(3, N)` [mm²], positive.
        inner: Points of ab, bc and ca, `(3, 3, N)` [mm].
        inward: Directions from ab, bc and ca inwards, `(3, 3, N)`.
    """

    starts: FloatArray
    ways: FloatArray
    squares: FloatArray
    inner: FloatArray
    inward: FloatArray


@dataclass(frozen=True, eq=False)
class Facets:
    """Triangles of a surface.

    Attributes:
        vertices: `(V, 3)` [mm].
        triangles: Indices of vertices, `(N, 3)`.
        corners: `(N, 3, 3)` [mm].
        normals: Outward unit normals, `(N, 3)`.
        offsets: n·x of each triangle's plane, `(N,)` [mm].
        areas: `(N,)` [mm²].
        inward: Directions in each triangle's plane that point from its edges ab, bc, ca inwards, `(3, N, 3)`.
    """

    vertices: FloatArray
    triangles: NDArray[np.int32]
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
        return cls(mesh.vertices, mesh.triangles, corners, normals, (normals * corners[:, 0]).sum(axis=1), length / 2, inward)

    @cached_property
    def sides(self) -> _Sides:
        """The sides of the triangles, prepared for `nearest`."""
        a, b, c = np.ascontiguousarray(np.moveaxis(self.corners, 0, 2))
        starts, ways = np.stack([a, a, b]), np.stack([b - a, c - a, c - b])
        return _Sides(
            starts, ways, np.maximum(_dot(ways, ways), 1e-300), np.stack([a, b, a]), np.ascontiguousarray(self.inward.swapaxes(1, 2))
        )


def nearest(facets: Facets, seed: FloatArray) -> FloatArray:
    """Return the point of each triangle nearest to the seed, `(N, 3)` (Ericson, Real-Time Collision Detection, 5.1.5)."""
    at, sides = seed[:, None], facets.sides

    shares = np.clip(_dot(at - sides.starts, sides.ways) / sides.squares, 0.0, 1.0)
    on_sides = sides.starts + shares[:, None] * sides.ways  # the nearest points of ab, ac and bc, `(3, 3, N)`
    away = on_sides - at
    best = np.take_along_axis(on_sides, _dot(away, away).argmin(axis=0)[None, None], axis=0)[0]

    inside = seed - (facets.normals @ seed - facets.offsets)[:, None] * facets.normals
    within = (facets.areas > 0) & (_dot(inside.T - sides.inner, sides.inward) >= 0).all(axis=0)
    return np.where(within[:, None], inside, best.T)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a·b of vectors in columns, `(E, 3, N)` to `(E, N)`."""
    products = a * b
    return np.asarray(products[:, 0] + products[:, 1] + products[:, 2])


def steady(lengths: FloatArray) -> FloatArray:
    """Return lengths [mm], or numbers near 1, rounded so that equal ones are equal on every processor."""
    return np.asarray(np.round(lengths, _DECIDE))


def steady_size(size: float) -> float:
    """Return an area or a volume rounded in the same way: to as many significant digits."""
    return float(f"{size:.{_DECIDE}g}")


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
