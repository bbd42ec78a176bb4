"""Meshes in the page's form: single precision, triangles sorted by smooth face, the edges between faces."""

from __future__ import annotations

import base64
import math
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from articad.arrays import IntArray
from articad.geometry.mesh import TriMesh

_CREASE = math.cos(math.radians(30.0))  # a larger bend between two triangles is an edge, if no B-rep gives the faces
_WIDE = 65536  # number of vertices from which indices need four bytes


def drawn_mesh(mesh: TriMesh) -> dict[str, Any]:
    """Return a mesh for the viewer: little-endian arrays in base64.

    Returns:
        `vertices` float32 `(V, 3)` [mm]; `triangles` and `edges` as uint16, or uint32 if `wide`; `faces`, the number of
        triangles of each smooth face, uint32.
    """
    if mesh.face is None:
        mesh = mesh.welded()
    ends, neighbours = _shared_edges(mesh)
    face = _smooth_faces(mesh, neighbours) if mesh.face is None else np.asarray(mesh.face, dtype=np.int64)
    order = np.argsort(face, kind="stable")
    counts = np.unique(face, return_counts=True)[1]
    alone = neighbours[:, 1] < 0
    sharp = alone | (face[neighbours[:, 0]] != face[neighbours[:, 1]])
    wide = len(mesh.vertices) >= _WIDE
    index = "<u4" if wide else "<u2"
    return {
        "vertices": _base64(mesh.vertices, "<f4"),
        "triangles": _base64(mesh.triangles[order], index),
        "faces": _base64(counts, "<u4"),
        "edges": _base64(ends[sharp], index),
        "wide": wide,
    }


def _shared_edges(mesh: TriMesh) -> tuple[IntArray, IntArray]:
    """Return each edge's two vertices and its first two triangles, −1 if there is no second one."""
    triangles = np.asarray(mesh.triangles, dtype=np.int64)
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    owner = np.tile(np.arange(len(triangles)), 3)
    low, high = sides.min(axis=1), sides.max(axis=1)
    key = low * max(len(mesh.vertices), 1) + high
    order = np.argsort(key, kind="stable")
    _, first, count = np.unique(key[order], return_index=True, return_counts=True)
    ends = np.stack([low[order][first], high[order][first]], axis=1)
    owners = owner[order]
    second = np.where(count > 1, owners[np.minimum(first + 1, max(len(owners) - 1, 0))], -1) if len(owners) else first
    return ends, np.stack([owners[first], second], axis=1) if len(owners) else np.zeros((0, 2), dtype=np.int64)


def _smooth_faces(mesh: TriMesh, neighbours: IntArray) -> IntArray:
    """Number the sets of triangles that are connected without a crease."""
    count = len(mesh.triangles)
    if not count:
        return np.zeros(0, dtype=np.int64)
    normals = mesh.normals_of_twice_area
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    pairs = neighbours[neighbours[:, 1] >= 0]
    smooth = pairs[(normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(axis=1) > _CREASE]
    graph = coo_array((np.ones(len(smooth), dtype=np.int8), (smooth[:, 0], smooth[:, 1])), shape=(count, count))
    labels: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
    return labels


def _base64(array: Any, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode("ascii")
