"""Planes, cylinders and spheres among the faces of a solid.

A mesh of a B-rep keeps the index of the face that each triangle comes from, and its vertices lie on that face. So the surface is known as
well as its vertices: `Face.off` states by how much they miss it. A mesh without faces is divided where it bends.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from articad.arrays import FloatArray
from articad.geometry.mesh import TriMesh

__all__ = ["Face", "faces_of", "smooth_patches"]

FaceKind = Literal["plane", "cylinder", "sphere", "other"]

OFF_MM: Final = 2e-3  # largest distance of a face's vertices from the surface that they are taken for
_SMOOTH: Final = np.cos(np.radians(25.0))  # facets of one smooth surface turn by less
_FLAT_SPREAD, _LINE_SPREAD = 1e-9, 0.02  # of the normals' second moments: below, the normals lie in a line, or in a plane
_STEPS: Final = 8  # of the fit of a cylinder
_NEAR_SPHERE: Final = 0.97  # of the radius: least distance of a facet's middle from the centre
_LEAST_CURVED: Final = 4  # triangles of a face that is not plane

_known: WeakKeyDictionary[TriMesh, tuple[Face, ...]] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Face:
    """A face of a solid.

    Attributes:
        kind: Type of the surface; "other" for any other surface.
        point: A point of a plane, a point on the axis of a cylinder, the centre of a sphere, `(3,)` [mm].
        axis: Outward normal of a plane, direction of a cylinder's axis, `(3,)`; zero for the others.
        radius: Of a cylinder or sphere [mm], else 0.
        hollow: Whether the material is outside: a bore or a socket.
        off: Largest distance of the vertices from the surface [mm].
        corners: Its triangles, `(T, 3, 3)` [mm].
    """

    kind: FaceKind
    point: FloatArray
    axis: FloatArray
    radius: float
    hollow: bool
    off: float
    corners: FloatArray

    @property
    def normals_of_twice_area(self) -> FloatArray:
        """Outward normals of its triangles, as long as twice their areas, `(T, 3)` [mm²]."""
        return _summed(self.corners)

    def moved(self, T: FloatArray) -> Face:
        """Return the face moved by a rigid motion `T (4, 4)`."""
        R, t = T[:3, :3], T[:3, 3]
        return replace(self, point=R @ self.point + t, axis=R @ self.axis, corners=self.corners @ R.T + t)


def faces_of(mesh: TriMesh) -> tuple[Face, ...]:
    """Return the faces of a closed mesh with outward normals, in the order of their indices; cached."""
    if mesh not in _known:
        label = smooth_patches(mesh) if mesh.face is None else np.asarray(mesh.face, dtype=np.int64)
        order = np.argsort(label, kind="stable")
        groups = np.split(order, np.flatnonzero(np.diff(label[order])) + 1) if len(order) else []
        corners, normals = mesh.vertices[mesh.triangles], mesh.normals_of_twice_area
        _known[mesh] = tuple(_recognised(corners[group], normals[group]) for group in groups)
    return _known[mesh]


def smooth_patches(mesh: TriMesh) -> NDArray[np.int64]:
    """Return the number of the patch of each triangle, `(T,)`: neighbours across an edge with a small bend have the same one."""
    twice = mesh.normals_of_twice_area
    length = np.linalg.norm(twice, axis=1)
    normals = twice / np.where(length > 0, length, 1.0)[:, None]
    start, end = mesh.triangles.astype(np.int64), np.roll(mesh.triangles.astype(np.int64), -1, axis=1)
    keys = np.minimum(start, end) * len(mesh.vertices) + np.maximum(start, end)
    owners = np.repeat(np.arange(len(normals)), 3)
    order = np.argsort(keys.ravel(), kind="stable")
    same = keys.ravel()[order][1:] == keys.ravel()[order][:-1]
    a, b = owners[order][:-1][same], owners[order][1:][same]
    smooth = (normals[a] * normals[b]).sum(axis=1) >= _SMOOTH
    a, b = a[smooth], b[smooth]
    graph = coo_array((np.ones(len(a)), (a, b)), shape=(len(normals), len(normals)))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _recognised(corners: FloatArray, twice: FloatArray) -> Face:
    """Return a face with its surface; `twice` are normals with twice the triangles' areas as lengths, `(T, 3)`."""
    weights = np.linalg.norm(twice, axis=1)
    kept = weights > 0
    total = float(weights.sum())
    other = Face("other", corners.reshape(-1, 3).mean(axis=0), np.zeros(3), 0.0, hollow=False, off=np.inf, corners=corners)
    if total == 0:
        return other
    normals = twice[kept] / weights[kept, None]
    spread, axes = np.linalg.eigh((normals * weights[kept, None]).T @ normals / total)
    points = np.unique(corners.reshape(-1, 3), axis=0)
    if spread[1] < _FLAT_SPREAD:
        return _plane(other, points, twice.sum(axis=0))
    if len(corners) < _LEAST_CURVED:
        return other
    found = _cylinder(other, points, normals, axes[:, 0]) if spread[0] < _LINE_SPREAD else None
    return found or _sphere(other, points, corners[kept], normals) or other


def _plane(face: Face, points: FloatArray, twice: FloatArray) -> Face:
    normal = twice / np.linalg.norm(twice)
    heights = points @ normal
    middle = (heights.min() + heights.max()) / 2
    off = float(np.abs(heights - middle).max())
    if off > OFF_MM:
        return face
    return replace(face, kind="plane", point=points.mean(axis=0) + (middle - heights.mean()) * normal, axis=normal, off=off)


def _cylinder(face: Face, points: FloatArray, normals: FloatArray, axis: FloatArray) -> Face | None:
    """Return the cylinder through points, by Gauss-Newton steps from the direction to which the normals are perpendicular.

    Unknown are the axis's shift (2), its tilt (2) and the radius. With (x, y, z) a point in the axis's frame and ρ = |(x, y)|, the
    residual is ρ - r; its derivatives are -x/ρ, -y/ρ for the shift, -z x/ρ, -z y/ρ for the tilt, -1 for the radius.
    """
    centre = points.mean(axis=0)
    side = np.eye(3)[int(np.abs(axis).argmin())]
    for step in range(_STEPS):
        x = np.cross(side, axis)
        x /= np.linalg.norm(x)
        y = np.cross(axis, x)
        local = (points - centre) @ np.stack([x, y, axis], axis=1)
        if step == 0:  # circle through the points seen along the axis: |p|² = 2 p·m + c
            system = np.column_stack([2 * local[:, :2], np.ones(len(local))])
            middle, *_ = np.linalg.lstsq(system, (local[:, :2] ** 2).sum(axis=1), rcond=None)
            centre = centre + middle[0] * x + middle[1] * y
            radius = float(np.sqrt(max(middle[2] + middle[:2] @ middle[:2], 0.0)))
            continue
        rho = np.maximum(np.linalg.norm(local[:, :2], axis=1), 1e-12)
        ux, uy, z = local[:, 0] / rho, local[:, 1] / rho, local[:, 2]
        jacobian = np.column_stack([-ux, -uy, -z * ux, -z * uy, -np.ones(len(z))])
        change, *_ = np.linalg.lstsq(jacobian, -(rho - radius), rcond=1e-10)
        centre = centre + change[0] * x + change[1] * y
        tilted = axis + change[2] * x + change[3] * y
        axis = tilted / np.linalg.norm(tilted)
        radius += float(change[4])
    flat = (points - centre) - np.outer((points - centre) @ axis, axis)
    off = float(np.abs(np.linalg.norm(flat, axis=1) - radius).max())
    if not (off <= OFF_MM and radius > 0) or float(np.abs(normals @ axis).max()) > _LINE_SPREAD * 10:
        return None
    middles = face.corners.mean(axis=1) - centre
    outward = float(((middles - np.outer(middles @ axis, axis)) * _summed(face.corners)).sum())
    return replace(face, kind="cylinder", point=centre, axis=axis, radius=radius, hollow=outward < 0, off=off)


def _sphere(face: Face, points: FloatArray, corners: FloatArray, normals: FloatArray) -> Face | None:
    """Return the sphere through points: |p|² = 2 p·m + c is linear in its centre m."""
    shift = points.mean(axis=0)
    local = points - shift
    system = np.column_stack([2 * local, np.ones(len(local))])
    solution, _, rank, _ = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)
    radius = float(np.sqrt(max(solution[3] + solution[:3] @ solution[:3], 0.0)))
    off = float(np.abs(np.linalg.norm(local - solution[:3], axis=1) - radius).max())
    if rank < 4 or off > OFF_MM or radius <= 0:
        return None
    centre = shift + solution[:3]
    outward = ((corners.mean(axis=1) - centre) * normals).sum(axis=1) / radius
    if float(np.abs(outward).min()) < _NEAR_SPHERE:  # the two rims of a cone lie on a sphere, but the facets between them do not
        return None
    return replace(face, kind="sphere", point=centre, radius=radius, hollow=float(outward.sum()) < 0, off=off)


def _summed(corners: FloatArray) -> FloatArray:
    return np.asarray(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
