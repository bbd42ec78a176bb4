"""Triangle meshes as frozen arrays: the form in which all packages exchange geometry."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError

IntArray = NDArray[np.int32]

DIGEST_TAG = b"articad.mesh/1"  # first bytes of the hashed data; independent checkers hash the same


@dataclass(frozen=True, eq=False)
class TriMesh:
    """A triangle mesh; counter-clockwise seen from outside.

    Attributes:
        vertices: Positions [mm], `(V, 3)` float64, read-only.
        triangles: Indices of vertices, `(T, 3)` int32, read-only.
        face: Index of the B-rep face that each triangle comes from, `(T,)` int32, or None.

    Raises:
        InvalidSolidError: If an array has the wrong shape, a vertex is not finite or an index is out of range.
    """

    vertices: FloatArray
    triangles: IntArray
    face: IntArray | None = None

    def __post_init__(self) -> None:
        vertices = _frozen(self.vertices, np.float64)
        triangles = _frozen(self.triangles, np.int32)
        face = None if self.face is None else _frozen(self.face, np.int32)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or triangles.ndim != 2 or triangles.shape[1] != 3:
            raise InvalidSolidError(
                f"A mesh needs vertices (V, 3) and triangles (T, 3), not {vertices.shape} and {triangles.shape}.", status="shape"
            )
        if face is not None and face.shape != (len(triangles),):
            raise InvalidSolidError(f"A mesh of {len(triangles)} triangles has face indices of shape {face.shape}.", status="shape")
        if not np.isfinite(vertices).all():
            row = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
            raise InvalidSolidError(f"Vertex {row} of a mesh is not finite: {vertices[row].tolist()}.", status="nonfinite")
        if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(vertices)):
            row = int(np.flatnonzero(((triangles < 0) | (triangles >= len(vertices))).any(axis=1))[0])
            raise InvalidSolidError(
                f"Triangle {row} of a mesh names vertices {triangles[row].tolist()}, but there are {len(vertices)}.", status="index"
            )
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "triangles", triangles)
        object.__setattr__(self, "face", face)

    def __repr__(self) -> str:
        return f"TriMesh({len(self.vertices)} vertices, {len(self.triangles)} triangles)"

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields: what was derived from them is made again, and need not be picklable."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def derived(self) -> dict[str, Any]:
        """What other modules derive from the mesh and keep as long as it lives, by name; it may refer to the mesh."""
        return {}

    @cached_property
    def bounds(self) -> FloatArray:
        """Smallest and largest coordinates [mm], `(2, 3)`; for an empty mesh +inf and -inf."""
        if not len(self.vertices):
            return _frozen(np.array([[np.inf] * 3, [-np.inf] * 3]), np.float64)
        used = self.vertices if self._all_used else self.vertices[np.unique(self.triangles)]
        return _frozen(np.stack([used.min(axis=0), used.max(axis=0)]), np.float64)

    @cached_property
    def volume(self) -> float:
        """Enclosed volume [mm³]; negative if the mesh is inside out, meaningless if it is open."""
        return float(_tetrahedra(self.vertices, self.triangles).d.sum()) / 6 if len(self.triangles) else 0.0

    @cached_property
    def area(self) -> float:
        """Surface [mm²]."""
        return float(np.linalg.norm(self.normals_of_twice_area, axis=1).sum() / 2)

    @property
    def centroid(self) -> FloatArray:
        """Centre of the enclosed volume [mm], `(3,)`."""
        return self._integrals[1]

    @cached_property
    def normals_of_twice_area(self) -> FloatArray:
        """Outward normal of each triangle, with twice its area as length [mm²], `(T, 3)`."""
        a, b, c = (self.vertices[self.triangles[:, i]] for i in range(3))
        return _frozen(np.cross(b - a, c - a), np.float64)

    @cached_property
    def is_closed(self) -> bool:
        """True when every edge is used as often in one direction as in the other, and there is at least one."""
        if not len(self.triangles):
            return False
        forth, back = self._edge_keys
        return bool(np.array_equal(np.sort(forth), np.sort(back)))

    @property
    def open_edges(self) -> int:
        """Number of directed edges without a partner in the other direction."""
        forth, back = self._edge_keys
        keys, counts = np.unique(forth, return_counts=True)
        back_keys, back_counts = np.unique(back, return_counts=True)
        balance = dict(zip(keys.tolist(), counts.tolist(), strict=True))
        for key, count in zip(back_keys.tolist(), back_counts.tolist(), strict=True):
            balance[key] = balance.get(key, 0) - count
        return sum(count for count in balance.values() if count > 0)

    @cached_property
    def digest(self) -> str:
        """SHA-256 over the counts, the vertices (little-endian float64) and the triangles (little-endian int32)."""
        counts = np.array([len(self.vertices), len(self.triangles)], dtype="<i8")
        total = hashlib.sha256(DIGEST_TAG)
        for array in (counts, self.vertices.astype("<f8", copy=False), self.triangles.astype("<i4", copy=False)):
            total.update(array.tobytes())
        return total.hexdigest()

    def solid_integrals(self) -> tuple[float, FloatArray, FloatArray]:
        """Integrate over the enclosed volume.

        Returns:
            Volume [mm³], centre `(3,)` [mm], inertia about the centre at density one `(3, 3)` [mm⁵].
        """
        return self._integrals

    def transformed(self, T: SE3) -> TriMesh:
        """Return the mesh moved by one rigid motion: coordinates in the frame into which `T` maps."""
        return TriMesh(self.vertices @ T.rotation.T + T.translation, self.triangles, self.face)

    def reflected(self, S: FloatArray) -> TriMesh:
        """Return the mesh mapped by an orientation-reversing `(4, 4)` matrix, with reversed winding so that normals stay outward.

        Raises:
            InvalidSolidError: If the linear part of `S` does not reverse orientation.
        """
        S = np.asarray(S, dtype=np.float64)
        if S.shape != (4, 4) or not np.linalg.det(S[:3, :3]) < 0:
            raise InvalidSolidError(
                "A reflection needs a (4, 4) matrix with negative determinant; move a mesh with transformed().", status="matrix"
            )
        return TriMesh(self.vertices @ S[:3, :3].T + S[:3, 3], self.triangles[:, ::-1], self.face)

    def scaled(self, factor: float) -> TriMesh:
        """Return the mesh with all coordinates multiplied by a positive factor.

        Raises:
            InvalidSolidError: If the factor is not positive and finite.
        """
        if not (math.isfinite(factor) and factor > 0):
            raise InvalidSolidError(f"The scale of a mesh must be a positive number, not {factor}.", status="scale")
        return TriMesh(self.vertices * factor, self.triangles, self.face)

    def flipped(self) -> TriMesh:
        """Return the mesh with its winding reversed: inside out."""
        return TriMesh(self.vertices, self.triangles[:, ::-1], self.face)

    def welded(self, tol: float = 0.0) -> TriMesh:
        """Return the mesh with coinciding vertices merged and collapsed triangles dropped.

        Args:
            tol: Vertices closer than this are merged [mm]; 0 merges exactly equal ones. Pairs up to 2√3 tol apart may be merged too.
        """
        group = groups_of_equal(self.vertices) if tol <= 0 else _groups_within(self.vertices, tol)
        first = np.full(int(group.max(initial=-1)) + 1, len(self.vertices), dtype=np.int64)
        np.minimum.at(first, group, np.arange(len(group)))
        order = np.argsort(first)  # keep the order of first appearance, so that the result does not depend on sorting by value
        rank = np.empty_like(order)
        rank[order] = np.arange(len(order))
        triangles = rank[group][self.triangles].astype(np.int32)
        keep = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2]) & (triangles[:, 2] != triangles[:, 0])
        return TriMesh(self.vertices[first[order]], triangles[keep], None if self.face is None else self.face[keep])

    def components(self) -> tuple[TriMesh, ...]:
        """Return the pieces that share no vertex, ordered by their first triangle."""
        if not len(self.triangles):
            return ()
        label = _connected_labels(len(self.vertices), self.triangles)[self.triangles[:, 0]]
        _, first, inverse = np.unique(label, return_index=True, return_inverse=True)
        if len(first) == 1:
            return (self,)
        return tuple(self.submesh(inverse == which) for which in np.argsort(first))

    def submesh(self, chosen: NDArray[np.bool_]) -> TriMesh:
        """Return the chosen triangles as a mesh of their own, without unused vertices.

        Args:
            chosen: Mask of triangles, `(T,)`.
        """
        triangles = self.triangles[chosen]
        used, inverse = np.unique(triangles, return_inverse=True)
        return TriMesh(self.vertices[used], inverse.reshape(-1, 3).astype(np.int32), None if self.face is None else self.face[chosen])

    @cached_property
    def _all_used(self) -> bool:
        return bool(np.bincount(self.triangles.ravel(), minlength=len(self.vertices)).all())

    @property
    def _edge_keys(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        start = self.triangles.astype(np.int64).ravel()
        end = self.triangles[:, [1, 2, 0]].astype(np.int64).ravel()
        proper = start != end
        start, end = start[proper], end[proper]
        return start * len(self.vertices) + end, end * len(self.vertices) + start

    @cached_property
    def _integrals(self) -> tuple[float, FloatArray, FloatArray]:
        volume, com, inertia = _solid_integrals(self.vertices, self.triangles)
        return volume, _frozen(com, np.float64), _frozen(inertia, np.float64)


def merged(meshes: list[TriMesh]) -> TriMesh:
    """Return one mesh with all of them, not united; face indices are dropped."""
    if len(meshes) == 1:
        return meshes[0]
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    vertices = np.concatenate([np.empty((0, 3)), *(mesh.vertices for mesh in meshes)])
    triangles = [mesh.triangles + start for mesh, start in zip(meshes, starts[:-1], strict=True)]
    return TriMesh(vertices, np.concatenate([np.empty((0, 3), dtype=np.int64), *triangles]).astype(np.int32))


def _frozen(array: Any, dtype: type) -> NDArray[Any]:
    """Return a read-only C-ordered array; a copy unless it already is one that nobody can write."""
    result: NDArray[Any] = np.ascontiguousarray(array, dtype=dtype)
    if result.flags.writeable:
        result = result.copy() if result is array or result.base is not None else result
        result.flags.writeable = False
    return result


class _Tetrahedra(NamedTuple):
    """Tetrahedra from a mesh's centre to its triangles.

    Attributes:
        origin: Centre of the bounding box [mm], `(3,)`.
        local: The vertices about it, `(3, V)`.
        corners: Those of the triangles, a, b and c, each as rows of x, y and z, `(T,)` each.
        d: Six times the volume of each, a·(b x c) [mm³], `(T,)`.
    """

    origin: FloatArray
    local: FloatArray
    corners: tuple[list[FloatArray], ...]
    d: FloatArray


def _tetrahedra(vertices: FloatArray, triangles: IntArray) -> _Tetrahedra:
    """Return the signed tetrahedra of a mesh that has triangles."""
    origin = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    local = np.ascontiguousarray((vertices - origin).T)
    corners = tuple([row[corner] for row in local] for corner in np.ascontiguousarray(triangles.T))
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
    d = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return _Tetrahedra(origin, local, corners, d)


def _solid_integrals(vertices: FloatArray, triangles: IntArray) -> tuple[float, FloatArray, FloatArray]:
    """Sum signed tetrahedra from a point inside the bounding box.

    About the box's centre and not the origin: at 1e5 mm from it the plain sum has a relative error of 100 in the inertia, this one
    1e-13.
    With d = a·(b x c), s = a + b + c:  6V = Σd,  24 V com = Σ d s,  120 ∫x xᵀ = Σ d (s sᵀ + a aᵀ + b bᵀ + c cᵀ)  (Tonon 2004).
    The last three terms are summed per vertex, so that one small product remains.
    """
    if not len(triangles):
        return 0.0, np.zeros(3), np.zeros((3, 3))
    origin, local, (a, b, c), d = _tetrahedra(vertices, triangles)
    s = np.stack([a[axis] + b[axis] + c[axis] for axis in range(3)])
    volume = float(d.sum()) / 6
    weight = sum(np.bincount(corner, weights=d, minlength=len(vertices)) for corner in triangles.T)
    second = ((s * d) @ s.T + (local * weight) @ local.T) / 120
    if volume == 0.0:
        return 0.0, origin, np.zeros((3, 3))
    com = (s @ d) / (24 * volume)
    central = second - volume * np.outer(com, com)
    inertia = np.trace(central) * np.eye(3) - central
    return volume, origin + com, (inertia + inertia.T) / 2


def groups_of_equal(points: FloatArray) -> NDArray[np.int64]:
    """Number the points so that equal ones have the same number, `(V,)`."""
    rows = np.ascontiguousarray(points + 0.0)  # -0.0 becomes 0.0
    order = np.lexsort(rows.T)
    ordered = rows[order]
    new = np.empty(len(rows), dtype=bool)
    new[:1] = True
    np.any(ordered[1:] != ordered[:-1], axis=1, out=new[1:])
    group = np.empty(len(rows), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    return group


def _groups_within(points: FloatArray, tol: float) -> NDArray[np.int64]:
    """Number the points so that those closer than `tol` have the same number.

    Eight grids of cell size 2 tol, shifted by half a cell along each set of axes: any two points closer than tol share a cell in one of
    them.
    """
    label = np.arange(len(points))
    for shift in np.ndindex(2, 2, 2):
        cell = np.floor(points / (2 * tol) + np.array(shift) / 2)
        label = _joined(label, groups_of_equal(cell))
    return np.unique(label, return_inverse=True)[1].astype(np.int64)


def _joined(label: NDArray[Any], group: NDArray[np.int64]) -> NDArray[Any]:
    """Give all points that share a label or a group the smallest label among them."""
    while True:
        lowest = np.full(int(group.max(initial=-1)) + 1, len(label))
        np.minimum.at(lowest, group, label)
        joined = np.minimum(label, lowest[group])
        lowest_of_label = np.full(len(label), len(label))
        np.minimum.at(lowest_of_label, label, joined)
        joined = lowest_of_label[label]
        if np.array_equal(joined, label):
            return label
        label = joined


def _connected_labels(count: int, triangles: IntArray) -> NDArray[Any]:
    """Label vertices so that those connected by triangles have the same label, `(count,)`."""
    from scipy.sparse import coo_array  # noqa: PLC0415 - 0.2 s to load, only needed for pieces
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415 - the same

    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]]])
    graph = coo_array((np.ones(len(ends), dtype=np.int8), (ends[:, 0], ends[:, 1])), shape=(count, count))
    label: NDArray[Any] = connected_components(graph, directed=False)[1]
    return label
