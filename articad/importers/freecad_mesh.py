"""FreeCAD's mesh format: points in single precision, and for each facet its points and its neighbours."""

from __future__ import annotations

import struct

import numpy as np

from articad.errors import InvalidSolidError
from articad.geometry.mesh import TriMesh

_MAGIC, _VERSIONS = 0xA0B0C0D0, (0x010000,)
_HEADER = 8 + 256  # magic, version, and a text field
_POINT, _FACET = 12, 24  # bytes: three floats; three points and three neighbours


def read_mesh_kernel(content: bytes) -> TriMesh:
    """Return the mesh of a `.bms` file [mm].

    Raises:
        InvalidSolidError: If it is not such a file, or ends early.
    """
    if len(content) < _HEADER + 8 or struct.unpack_from("<II", content)[0] != _MAGIC:
        raise InvalidSolidError("This is not a FreeCAD mesh.", status="format")
    if struct.unpack_from("<I", content, 4)[0] not in _VERSIONS:
        raise InvalidSolidError("This mesh comes from an unknown version of FreeCAD.", status="format")
    points, facets = struct.unpack_from("<II", content, _HEADER)
    start = _HEADER + 8
    middle, end = start + points * _POINT, start + points * _POINT + facets * _FACET
    if end > len(content):
        raise InvalidSolidError(f"A mesh of {points} points and {facets} facets ends early.", status="format")
    vertices = np.frombuffer(content[start:middle], dtype="<f4").reshape(-1, 3).astype(np.float64)
    indices = np.frombuffer(content[middle:end], dtype="<u4").reshape(-1, 6)[:, :3]
    if len(indices) and indices.max() >= points:
        raise InvalidSolidError("A facet of a mesh names a point that does not exist.", status="index")
    return TriMesh(vertices, indices.astype(np.int32))
