"""Which meshes stand for a primitive, however finely they are faceted."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from articad.arrays import FloatArray
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive

__all__ = ["facets"]

_ON_SURFACE: Final = 1e-6  # of a primitive's size: files of single precision keep 6e-8
_CUT_OFF: Final = 0.1  # of a primitive's volume: eight segments of a cylinder


def facets(mesh: TriMesh, form: Primitive) -> bool:
    """Return whether a mesh stands for a primitive, however finely it is faceted.

    It is closed and convex, its corners lie on the primitive's surface, and it cuts off little of the volume.
    """
    size = max(form.size)
    if not mesh.is_closed or not len(mesh.triangles) or _off_surface(mesh.vertices, form).max() > _ON_SURFACE * size:
        return False
    try:
        hull = ConvexHull(mesh.vertices)
    except (QhullError, ValueError):
        return False
    convex = abs(mesh.volume - hull.volume) <= _ON_SURFACE * hull.volume and abs(mesh.area - hull.area) <= _ON_SURFACE * hull.area
    return convex and mesh.volume >= (1 - _CUT_OFF) * _volume(form)


def _off_surface(points: FloatArray, form: Primitive) -> FloatArray:
    """Return the distance of points from the surface of a primitive, `(N,)` [mm]; of an ellipsoid, an estimate along the ray."""
    if form.kind == "ellipsoid":
        scaled = np.linalg.norm(points / form.size, axis=1)
        return np.asarray(np.abs(scaled - 1.0) * min(form.size))
    if form.kind == "box":
        inner, r = np.array(form.size) / 2, 0.0
    elif form.kind == "cylinder":
        points, inner, r = _profile(points), np.array([form.size[0], form.size[1] / 2]), 0.0
    elif form.kind == "capsule":
        inner, r = np.array([0.0, 0.0, form.size[1] / 2]), form.size[0]
    else:
        inner, r = np.zeros(3), form.size[0]
    beyond = np.abs(points) - inner  # signed distance of a rounded box (Quilez)
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return np.asarray(np.abs(outside + np.minimum(beyond.max(axis=1), 0.0) - r))


def _profile(points: FloatArray) -> FloatArray:
    """Return the radius and height of points about z, `(N, 2)`."""
    return np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])


def _volume(form: Primitive) -> float:
    if form.kind == "box":
        return math.prod(form.size)
    if form.kind == "cylinder":
        return math.pi * form.size[0] ** 2 * form.size[1]
    if form.kind == "capsule":
        return math.pi * form.size[0] ** 2 * (form.size[1] + 4 / 3 * form.size[0])
    return 4 / 3 * math.pi * (math.prod(form.size) if form.kind == "ellipsoid" else form.size[0] ** 3)
