"""Meshes in one array file: all vertices, all triangles and the counts of each mesh, with a head in JSON."""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from articad.geometry.mesh import TriMesh


def save_arrays(head: dict[str, Any], meshes: Sequence[TriMesh]) -> bytes:
    """Return the bytes of a head and meshes; indices of faces are left out."""
    counts = np.array([[len(mesh.vertices), len(mesh.triangles)] for mesh in meshes], dtype=np.int64).reshape(-1, 2)
    stream = io.BytesIO()
    np.savez_compressed(
        stream,
        allow_pickle=False,
        head=np.frombuffer(json.dumps(head).encode(), dtype=np.uint8),
        counts=counts,
        vertices=np.concatenate([np.empty((0, 3)), *(mesh.vertices for mesh in meshes)]),
        triangles=np.concatenate([np.empty((0, 3), dtype=np.int32), *(mesh.triangles for mesh in meshes)]),
    )
    return stream.getvalue()


def load_arrays(content: bytes) -> tuple[dict[str, Any], list[TriMesh]]:
    """Return the head and the meshes of `save_arrays`."""
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        head = json.loads(arrays["head"].tobytes())
        ends = np.cumsum(arrays["counts"], axis=0)[:-1]
        vertices, triangles = np.split(arrays["vertices"], ends[:, 0]), np.split(arrays["triangles"], ends[:, 1])
    meshes = [TriMesh(*one) for one in zip(vertices, triangles, strict=True)] if len(vertices[0]) else []
    return head, meshes
