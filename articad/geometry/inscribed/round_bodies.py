"""Balls and cylinders of which smooth faces of a solid are part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.faces import smooth_patches
from articad.geometry.inscribed.piece import DIGITS, Grown, Piece, whole
from articad.geometry.inscribed.surface import INSIDE_MM, Facets, encloses, nearest, steady, steady_size
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Primitive
from articad.geometry.shapes import cylinder, sphere

_SEGMENTS = 48  # in the meshes of recognised cylinders


def round_bodies(mesh: TriMesh, facets: Facets, deflection: float) -> list[Grown]:
    """Return the balls and cylinders of which smooth faces of the solid are part and that lie inside it."""
    found = []
    for chosen in _smooth_faces(mesh, facets):
        corners, normals = facets.corners[chosen].reshape(-1, 3), facets.normals[chosen]
        weights = facets.areas[chosen]
        moments = (normals * weights[:, None]).T @ normals / weights.sum()
        spread, axes = np.linalg.eigh(moments)
        slack = max(deflection, _rounding(float(np.ptp(corners, axis=0).max())))
        one = None
        if spread[0] < 1e-3 < spread[1]:
            one = _cylinder(facets, corners, normals, axes[:, 0], slack)
        elif spread[0] > 0.05:
            one = _ball(facets, corners, normals, slack)
        if one is not None:
            found.append(one)
    return found


def _rounding(size: float) -> float:
    """Return the distance by which rounding may move corners of a body of some size [mm]; two of them stay within `INSIDE_MM`."""
    return min(1e-6 * size, INSIDE_MM / 2)


def _smooth_faces(mesh: TriMesh, facets: Facets) -> list[NDArray[np.intp]]:
    """Return the triangles of each face of the B-rep, or of each smooth patch if the mesh has no faces; without flat ones."""
    label = smooth_patches(mesh) if mesh.face is None else np.asarray(mesh.face)
    order = np.argsort(label, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(label[order])) + 1)
    groups.sort(key=lambda group: -steady_size(float(facets.areas[group].sum())))
    return [group for group in groups[:200] if len(group) >= 8 and float((facets.normals[group] @ facets.normals[group[0]]).min()) < 0.99]


def _ball(facets: Facets, corners: FloatArray, normals: FloatArray, slack: float) -> Grown | None:
    """Return the ball through all these corners, if the solid contains it."""
    system = np.column_stack([2 * corners, np.ones(len(corners))])
    solution, *_ = np.linalg.lstsq(system, (corners**2).sum(axis=1), rcond=None)
    center = solution[:3]
    r = float(np.sqrt(max(solution[3] + center @ center, 0.0)))
    if r <= 0 or float(np.abs(np.linalg.norm(corners - center, axis=1) - r).max()) > slack or not encloses(facets, center):
        return None
    middles = corners.reshape(-1, 3, 3).mean(axis=1)
    if float(((middles - center) * normals).sum(axis=1).min()) <= 0:  # concave
        return None
    if float(np.linalg.norm(nearest(facets, center) - center, axis=1).min()) < r - slack - _rounding(r):
        return None
    center = np.round(center, DIGITS) + 0.0
    r = round(r, DIGITS)
    directions = sphere(1.0, 24).vertices
    planes = np.column_stack([directions, directions @ center + r])
    piece = Piece(sphere(r, 32), SE3.from_translation(center), Primitive("sphere", (r,)))
    return Grown(planes, piece, 4 / 3 * np.pi * r**3, np.zeros((0, 4)), center)


def _cylinder(facets: Facets, corners: FloatArray, normals: FloatArray, axis: FloatArray, slack: float) -> Grown | None:
    """Return the cylinder through all these corners, if the solid contains it between the ends of the face."""
    axis = whole(axis if axis[int(steady(np.abs(axis)).argmax())] > 0 else -axis)
    side = np.eye(3)[int(steady(np.abs(axis)).argmin())]
    x = side - (side @ axis) * axis
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    flat = np.column_stack([corners @ x, corners @ y])
    solution, *_ = np.linalg.lstsq(np.column_stack([2 * flat, np.ones(len(flat))]), (flat**2).sum(axis=1), rcond=None)
    middle = solution[:2]
    r = float(np.sqrt(max(solution[2] + middle @ middle, 0.0)))
    if r <= 0 or float(np.abs(np.linalg.norm(flat - middle, axis=1) - r).max()) > slack:
        return None
    outward = (flat.reshape(-1, 3, 2).mean(axis=1) - middle) @ np.array([x, y])
    if float((outward * normals).sum(axis=1).min()) <= 0:  # a bore
        return None
    along = corners @ axis
    low, high = float(along.min()), float(along.max())
    planar = np.stack([facets.corners @ x - middle[0], facets.corners @ y - middle[1]], axis=-1)  # (N, 3, 2)
    heights = facets.corners @ axis
    tolerance = _rounding(r + high - low)
    near = (heights.min(axis=1) < high - tolerance) & (heights.max(axis=1) > low + tolerance)
    if float(_to_origin(planar[near]).min(initial=np.inf)) < r - slack - tolerance:
        return None
    center = np.round(middle[0] * x + middle[1] * y + axis * (low + high) / 2, DIGITS) + 0.0
    if not encloses(facets, center):
        return None
    r, length = round(r, DIGITS), round(high - low, DIGITS)
    angles = 2 * np.pi * np.arange(_SEGMENTS) / _SEGMENTS
    around = np.cos(angles)[:, None] * x + np.sin(angles)[:, None] * y
    n = np.concatenate([around, [axis, -axis]])
    reach = np.concatenate([np.full(_SEGMENTS, r), [length / 2, length / 2]])
    planes = np.column_stack([n, n @ center + reach])
    piece = Piece(cylinder(r, length, _SEGMENTS), SE3.from_axes(center, axis, whole(x)), Primitive("cylinder", (r, length)))
    return Grown(planes, piece, np.pi * r * r * length, np.zeros((0, 4)), center)


def _to_origin(triangles: FloatArray) -> FloatArray:
    """Return the distance of plane triangles `(N, 3, 2)` from the origin, 0 for those that contain it."""
    best = np.full(len(triangles), np.inf)
    signs = []
    for i in range(3):
        a, b = triangles[:, i], triangles[:, (i + 1) % 3]
        way = b - a
        length = np.maximum((way * way).sum(axis=1), 1e-300)
        share = np.clip(-(a * way).sum(axis=1) / length, 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(a + share[:, None] * way, axis=1))
        signs.append(way[:, 0] * -a[:, 1] + way[:, 1] * a[:, 0])
    turns = np.array(signs)
    inside = (turns > 0).all(axis=0) | (turns < 0).all(axis=0)
    return np.asarray(np.where(inside, 0.0, best))
