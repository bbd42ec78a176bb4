"""Whether two solids have one shape: whether a rotation and a shift map one onto the other."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from articad.arrays import FloatArray
from articad.geometry.faces import faces_of
from articad.geometry.part import Solid

__all__ = ["same_shape"]

_NEAR: Final = 1e-3  # mm between points that count as one, beyond the deflection of the meshes
_SHARE: Final = 1e-6  # relative difference of volumes, areas and moments of inertia
_FACES: Final = 1e-2  # relative difference of the areas of two faces, as their meshes have them
_TRIALS: Final = 200  # motions to try: a body of many equal sides has as many, and the first one fits


def same_shape(a: Solid, b: Solid) -> bool:
    """Return whether a proper rigid motion maps one solid onto the other.

    Volume, area and principal moments must be equal, and the motion must map each face onto one with the same kind, radius, area and
    centre. Solids of one shape whose faces are divided otherwise count as different.
    """
    if not np.allclose(_invariants(a), _invariants(b), rtol=_SHARE):
        return False
    near = _NEAR + a.deflection + b.deflection
    return _mapped(_face_points(a), _face_points(b), near) or _mapped(_vertices(a), _vertices(b), near)


def _invariants(solid: Solid) -> FloatArray:
    """Return volume, area and principal moments of inertia, scaled to lengths."""
    moments = np.linalg.eigvalsh(solid.inertia_mm5)
    return np.concatenate([[np.cbrt(solid.volume), np.sqrt(solid.area)], np.abs(moments) ** 0.2])


def _face_points(solid: Solid) -> tuple[FloatArray, FloatArray]:
    """Return the centres of the faces about the centre of volume `(F, 3)`, and what tells them apart `(F, 4)`: kind, radius, side, area."""
    centres, marks = [], []
    for face in faces_of(solid.mesh):
        areas = 0.5 * np.linalg.norm(face.normals_of_twice_area, axis=1)
        centres.append((areas[:, None] * face.corners.mean(axis=1)).sum(axis=0) / max(float(areas.sum()), 1e-300))
        marks.append([("plane", "cylinder", "sphere", "other").index(face.kind) * 1e3, face.radius, 1e3 * face.hollow, float(areas.sum())])
    return np.array(centres) - solid.com, np.array(marks)


def _vertices(solid: Solid) -> tuple[FloatArray, FloatArray]:
    return solid.mesh.vertices - solid.com, np.zeros((len(solid.mesh.vertices), 4))


def _mapped(a: tuple[FloatArray, FloatArray], b: tuple[FloatArray, FloatArray], near: float) -> bool:
    """Return whether a rotation about the origin maps the marked points `(N, 3)`, `(N, 4)` of one set onto those of the other.

    A rotation is fixed by the images of two points: the farthest one, and the one that spans the largest triangle with it.
    """
    (p, marks), (q, others) = a, b
    if len(p) != len(q):
        return False
    i = int(np.linalg.norm(p, axis=1).argmax())
    j = int(np.linalg.norm(np.cross(p, p[i]), axis=1).argmax())
    frame = _frame(p[i], p[j], near)
    if frame is None:
        return False
    tree, lengths, tried = cKDTree(q), np.linalg.norm(q, axis=1), 0
    firsts, seconds = (np.flatnonzero(np.abs(lengths - np.linalg.norm(p[k])) < near) for k in (i, j))
    apart = np.linalg.norm(p[i] - p[j])
    for first in firsts:
        for second in seconds[np.abs(np.linalg.norm(q[seconds] - q[first], axis=1) - apart) < 2 * near]:
            image = _frame(q[first], q[second], near)
            if image is None:
                continue
            distances, images = tree.query(p @ (image @ frame.T).T)
            agree = np.abs(marks - others[images]) <= near + np.array([0.0, 0.0, 0.0, _FACES]) * marks
            if distances.max() < 2 * near and len(np.unique(images)) == len(images) and agree.all():
                return True
            tried += 1
            if tried == _TRIALS:
                return False
    return False


def _frame(x: FloatArray, y: FloatArray, near: float) -> FloatArray | None:
    """Return the right-handed frame of two vectors as columns `(3, 3)`; None if they are parallel."""
    z = np.cross(x, y)
    if np.linalg.norm(z) < 10 * near * max(float(np.linalg.norm(x)), near):
        return None
    x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z], axis=1)
