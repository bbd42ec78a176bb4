"""Winding numbers: what a surface encloses, even if it crosses or repeats itself."""

from __future__ import annotations

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.quaternion import cross

__all__ = ["winding_numbers"]


def winding_numbers(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the winding number of a closed mesh about each point: 1 inside, 0 outside (van Oosterom and Strackee 1983).

    Args:
        points: `(P, 3)` [mm].
        corners: Corners of the triangles, `(T, 3, 3)` [mm].

    Returns:
        `(P,)`; 0.5 on the surface.
    """
    total = np.empty(len(points))
    for row, point in enumerate(points):
        a, b, c = np.moveaxis(corners - point, 1, 0)
        la, lb, lc = (np.sqrt(np.einsum("ij,ij->i", v, v)) for v in (a, b, c))
        numerator = np.einsum("ij,ij->i", a, cross(b, c))
        dot = np.einsum("ij,ij->i", a, b) * lc + np.einsum("ij,ij->i", b, c) * la + np.einsum("ij,ij->i", c, a) * lb
        total[row] = np.arctan2(numerator, la * lb * lc + dot).sum() / (2 * np.pi)
    return total
