"""Triangles whose corners lie on a line: simplification leaves some, and readers of single precision see no area in them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.geometry.mesh import TriMesh

__all__ = ["without_needles"]


def without_needles(mesh: TriMesh, thinnest: float) -> TriMesh:
    """Return a closed mesh without triangles that are thinner than stated: the longest edge of each is flipped.

    A needle abc with its corner b beside the edge ca, and the triangle acd beyond that edge, become abd and bcd. So the surface moves by
    the needle's height at most. A needle that no flip removes stays.

    Args:
        mesh: The mesh; each edge belongs to two triangles.
        thinnest: Height over the longest edge [mm].
    """
    triangles = mesh.triangles.copy()
    for _ in range(len(triangles)):  # each flip removes a needle and makes none
        heights = _heights(mesh.vertices, triangles)
        for needle in np.flatnonzero(heights < thinnest)[np.argsort(heights[heights < thinnest], kind="stable")].tolist():
            flipped = _flipped(mesh.vertices, triangles, needle, thinnest)
            if flipped is not None:
                triangles = flipped
                break
        else:
            break
    return mesh if np.array_equal(triangles, mesh.triangles) else TriMesh(mesh.vertices, triangles)


def _heights(vertices: FloatArray, triangles: NDArray[np.int32]) -> FloatArray:
    """Return the height of each triangle over its longest edge, `(N,)` [mm]."""
    corners = vertices[triangles]
    edges = np.roll(corners, -1, axis=1) - corners
    longest = np.linalg.norm(edges, axis=2).max(axis=1)
    twice = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    found: FloatArray = np.divide(twice, longest, out=np.zeros(len(twice)), where=longest > 0)
    return found


def _flipped(vertices: FloatArray, triangles: NDArray[np.int32], needle: int, thinnest: float) -> NDArray[np.int32] | None:
    """Return the triangles with a needle's longest edge flipped; None if that leaves a triangle as thin, or an edge twice."""
    corners = triangles[needle]
    ways = vertices[np.roll(corners, -1)] - vertices[corners]
    at = int(np.linalg.norm(ways, axis=1).argmax())
    c, a, b = (int(corners[(at + step) % 3]) for step in range(3))  # the longest edge leads from c to a
    starts, ends = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    beyond = np.flatnonzero((starts == a) & (ends == c))
    if len(beyond) != 1:
        return None
    other = int(beyond[0]) // 3
    d = int(next(corner for corner in triangles[other] if corner not in (a, c)))
    is_edge = ((starts == b) & (ends == d)) | ((starts == d) & (ends == b))
    made = np.array([[a, b, d], [b, c, d]], dtype=triangles.dtype)
    if is_edge.any() or _heights(vertices, made).min() < thinnest:
        return None
    changed = triangles.copy()
    changed[[needle, other]] = made
    return changed
