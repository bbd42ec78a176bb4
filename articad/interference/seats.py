"""Planes in which two surfaces sit on each other, and what of a surface is clear of such planes.

Two parts that sit on each other slide along their seat. Edges that lie in it pass each other at the distance 0, and stop nothing:
the side of a strap passes over the rim of a pocket in the bracket below it. Only what rises out of the seat stops a part.
"""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial import cKDTree

from articad.arrays import FloatArray

_PARALLEL = 1e-4  # rad: planes that are turned by less are the same plane
_ACROSS = 0.02  # cosine: a plane that is almost parallel to a direction is slid along


def seats(a: FloatArray, b: FloatArray, way: FloatArray, near: float) -> FloatArray:
    """Return the planes along a direction in which faces of two surfaces face each other, `(k, 4)`: unit normal, distance from the origin.

    Args:
        a: Triangles `(T, 3, 3)` [mm].
        b: Triangles of the other surface, in the same frame [mm].
        way: The direction `(3,)`.
        near: How far apart two planes are the same [mm].
    """
    of_a, of_b = _planes(a, way), -_planes(b, way)  # faces of b that face those of a have the opposite normal
    if not len(of_a) or not len(of_b):
        return np.empty((0, 4))
    scale = np.array([near / _PARALLEL] * 3 + [1.0])
    distances, _ = cKDTree(of_b * scale).query(of_a * scale, distance_upper_bound=near)
    met = of_a[np.isfinite(distances)]
    _, first = np.unique(np.round(met * scale / near), axis=0, return_index=True)
    return np.asarray(met[first])


def clear_of(corners: FloatArray, planes: FloatArray, margin: float) -> FloatArray:
    """Return what of triangles `(T, 3, 3)` lies farther than a margin [mm] from each of some planes `(k, 4)`."""
    for normal, offset in zip(planes[:, :3], planes[:, 3], strict=True):
        corners = np.concatenate([_beyond(corners, sign * normal, sign * offset + margin) for sign in (1.0, -1.0)])
    return corners


def _planes(corners: FloatArray, way: FloatArray) -> FloatArray:
    """Return the planes of the triangles that are almost parallel to a direction, `(k, 4)`."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    flat = (lengths > 0) & (np.abs(normals @ way) <= _ACROSS * lengths)
    unit = normals[flat] / lengths[flat, None]
    return np.column_stack([unit, (unit * corners[flat, 0]).sum(axis=1)])


def _beyond(corners: FloatArray, normal: FloatArray, offset: float) -> FloatArray:
    """Return what of triangles lies beyond a plane, on the side of its normal; most lie on one side and are not cut."""
    heights = corners @ normal - offset
    above, below = (heights >= 0).all(axis=1), (heights <= 0).all(axis=1)
    crossing = corners[~above & ~below]
    if not len(crossing):
        return corners[above]
    faces = np.arange(3 * len(crossing)).reshape(-1, 3)
    vertices, cut, _ = trimesh.intersections.slice_faces_plane(crossing.reshape(-1, 3), faces, normal, offset * normal)
    return np.concatenate([corners[above], vertices[cut]])
