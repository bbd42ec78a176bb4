"""A solid's surface as one closed mesh; each triangle has the index of its B-rep face. Runs inside the sandbox."""

from __future__ import annotations

import io
import struct
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face

ASKED = 0.45  # share of the deflection given to OCCT: on spheres it exceeds the given value by 2.08, on tori and cylinders it does not
FINER = 0.5  # a mesh that is not closed is computed again with half the deflection …
ATTEMPTS = 3  # … this many times: a thin face that was skipped appears when edges get more points


class Same:
    """A TopoDS_Shape as a key: two are equal if they are the same topology at the same place, whatever their orientation."""

    def __init__(self, shape: Any) -> None:
        self.shape = shape.Oriented(TopAbs_FORWARD)

    def __hash__(self) -> int:
        return hash(self.shape)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and bool(self.shape.IsSame(other.shape))


class Mesh(NamedTuple):
    """Vertices [mm] `(V, 3)`, triangles `(T, 3)` counter-clockwise from outside, face of each triangle `(T,)`."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    face: NDArray[np.int32]


def tessellate(solid: Any, deflection: float, angle: float) -> Mesh:
    """Mesh a TopoDS shape; finer if that is needed to close the mesh.

    Args:
        solid: Any TopoDS_Shape; its own triangulation is replaced.
        deflection: Largest distance between mesh and surface [mm].
        angle: Largest angle between neighbouring facets' edges [rad].
    """
    deflection *= ASKED
    for _ in range(ATTEMPTS):
        BRepTools.Clean_s(solid)
        BRepMesh_IncrementalMesh(solid, deflection, isRelative=False, theAngDeflection=angle, isInParallel=False)
        mesh = _welded(solid)
        if is_closed(mesh.triangles):
            break
        deflection *= FINER
    return mesh


def is_closed(triangles: NDArray[np.int32]) -> bool:
    """Return whether every directed edge has exactly one partner in the other direction."""
    if len(triangles) == 0:
        return False
    start, end = triangles.astype(np.int64).ravel(), np.roll(triangles.astype(np.int64), -1, axis=1).ravel()
    size = int(triangles.max()) + 1
    there, back = np.sort(start * size + end), np.sort(end * size + start)
    return bool((np.diff(there) > 0).all() and np.array_equal(there, back))


def _welded(shape: Any) -> Mesh:
    """Collect the triangulations of all faces; nodes that topology shares are merged.

    Nodes are merged along the edges of the B-rep, and so at its vertices, not where coordinates happen to agree: two sheets that touch
    stay apart, and the mesh stays a manifold.
    """
    nodes, triangles, faces, joints = [np.empty((0, 3))], [np.empty((0, 3), np.int64)], [np.empty(0, np.int32)], _Joints()
    offset, index = 0, 0
    explorer = TopExp_Explorer(shape, TopAbs_FACE)
    while explorer.More():
        face = TopoDS.Face(explorer.Current())
        location = TopLoc_Location()
        triangulation = BRep_Tool.Triangulation_s(face, location)
        if triangulation is not None:
            points, corners = _arrays(triangulation)
            nodes.append(points if location.IsIdentity() else _placed(points, location))
            triangles.append((corners if face.Orientation() != TopAbs_REVERSED else corners[:, ::-1]) + offset)
            faces.append(np.full(len(corners), index, np.int32))
            joints.add_face(face, triangulation, location, offset)
            offset += len(points)
        index += 1
        explorer.Next()
    return _compact(np.concatenate(nodes), joints.roots(offset)[np.concatenate(triangles)], np.concatenate(faces))


class _Joints:
    """Union of nodes of different faces that are the same point."""

    def __init__(self) -> None:
        self.pairs: list[tuple[int, int]] = []
        self.first_of_edge: dict[Same, list[int]] = {}

    def add_face(self, face: Any, triangulation: Any, location: Any, offset: int) -> None:
        explorer = TopExp_Explorer(face, TopAbs_EDGE)
        while explorer.More():
            edge = TopoDS.Edge(explorer.Current())
            polygon = BRep_Tool.PolygonOnTriangulation_s(edge, triangulation, location)
            if polygon is not None:
                self._add_edge(edge, [polygon.Node(i) - 1 + offset for i in range(1, polygon.NbNodes() + 1)])
            explorer.Next()

    def _add_edge(self, edge: Any, own: list[int]) -> None:
        if BRep_Tool.Degenerated_s(edge):  # the pole of a sphere: an edge without length, all one point
            self.pairs += [(own[0], node) for node in own[1:]]
        else:
            first = self.first_of_edge.setdefault(Same(edge), own)
            if len(first) == len(own):
                self.pairs += zip(first, own, strict=True)

    def roots(self, count: int) -> NDArray[np.int64]:
        """Return for each node the smallest node that it is merged with, `(count,)`."""
        root = np.arange(count)
        pairs = np.array(self.pairs, dtype=np.int64).reshape(-1, 2)
        while len(pairs):  # each round merges the trees that a pair still connects; few rounds are needed
            a, b = root[pairs[:, 0]], root[pairs[:, 1]]
            if (a == b).all():
                break
            np.minimum.at(root, np.maximum(a, b), np.minimum(a, b))
            while not np.array_equal(shorter := root[root], root):
                root = shorter
        return root


def _compact(nodes: NDArray[np.float64], triangles: NDArray[np.int64], face: NDArray[np.int32]) -> Mesh:
    """Drop unused nodes and triangles that merging has collapsed."""
    flat = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)
    triangles, face = triangles[~flat], face[~flat]
    used, corners = np.unique(triangles, return_inverse=True)
    return Mesh(np.ascontiguousarray(nodes[used]), corners.reshape(-1, 3).astype(np.int32), face)


def _arrays(triangulation: Any) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return nodes `(N, 3)` and triangles `(T, 3)` from zero.

    They are read from the kernel's binary form: a call for each node takes 50 times as long.
    """
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face, triangulation)
    stream = io.BytesIO()
    BinTools.Write_s(face, stream)
    form = stream.getvalue()
    mark = b"\nTriangulations 1\n"
    at = form.index(mark) + len(mark)
    count, triangle_count, has_uv, _has_normals, _deflection = struct.unpack_from("<ii??d", form, at)
    at += struct.calcsize("<ii??d")
    nodes = np.frombuffer(form, "<f8", 3 * count, at).reshape(-1, 3)
    at += nodes.nbytes + (16 * count if has_uv else 0)
    triangles = np.frombuffer(form, "<i4", 3 * triangle_count, at).reshape(-1, 3)
    return nodes.astype(np.float64), triangles.astype(np.int64) - 1


def _placed(points: NDArray[np.float64], location: Any) -> NDArray[np.float64]:
    motion = location.Transformation()
    matrix = np.array([[motion.Value(row, column) for column in range(1, 5)] for row in range(1, 4)])
    return np.asarray(points @ matrix[:, :3].T + matrix[:, 3])
