"""Planes around a seed, each of which has some triangles of the surface on its far side."""

from __future__ import annotations

import numpy as np

from articad.arrays import FloatArray
from articad.geometry.inscribed.surface import Facets, nearest, steady

_SLACKS = (0.0, 0.04, 0.25, 0.5, 1.0)  # shares of the slack by which a plane moves inwards: the values that are tried
_HALF = 0.5 - 1e-9  # of the gain of the largest slack: a smaller slack that gains so much is preferred, also where it is half exactly
_OWN = 0.3  # a triangle's own plane is used if its distance from the seed is at least this share of the triangle's


def grown_planes(facets: Facets, seed: FloatArray, slack: float, size: float) -> FloatArray | None:
    """Return planes `(K, 4)` around a seed such that each triangle is beyond one of them; None if the seed is on the surface."""
    close = nearest(facets, seed)
    distance = np.linalg.norm(close - seed, axis=1)
    tolerance = 1e-9 * size
    if distance.min() < 1e-6 * size:
        return None
    heights = facets.offsets - facets.normals @ seed  # depth of the seed below each triangle's plane
    left = np.lexsort((-np.round(heights, 6), np.round(distance, 6)))  # triangles in front of all planes so far, nearest first
    relative = np.moveaxis(facets.corners, 1, 0) - seed  # (3, N, 3): the first corners, the second, the third
    planes = []
    while len(left):
        first = left[0]
        if heights[first] >= _OWN * distance[first]:
            n, height = facets.normals[first], float(heights[first])
        else:
            n, height = (close[first] - seed) / distance[first], float(distance[first])
        least = _least(relative[:, left] @ n)  # how far beyond the seed each triangle is
        areas = facets.areas[left]
        bounds = [height - min(share * slack, height / 2) - tolerance for share in _SLACKS]
        most = float(areas[least >= bounds[-1]].sum())
        mask = next(mask for mask in (least >= bound for bound in bounds) if float(areas[mask].sum()) >= _HALF * most)
        mask[0] = True
        reach = float(least[mask].min())  # as far out as its triangles allow
        planes.append([*n, float(n @ seed) + min(height, reach)])
        left = left[~mask]
    return np.array(planes)


def _least(values: FloatArray | tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
    """Return the minimum of three rows, `(3, N)` to `(N,)`."""
    return np.asarray(np.minimum(np.minimum(values[0], values[1]), values[2]))


def held_off(planes: FloatArray, facets: Facets) -> FloatArray:
    """Return the planes moved inwards until each triangle of a finer surface is beyond one of them, by the smallest motion for each."""
    a, b, c = np.ascontiguousarray(facets.triangles.T, dtype=np.intp)
    need = np.full(facets.count, np.inf)  # by which a plane would have to move
    which = np.zeros(facets.count, dtype=int)
    left = np.arange(facets.count)
    for index, plane in enumerate(planes):
        heights = facets.vertices @ plane[:3]
        moves = steady(plane[3] - _least((heights[a], heights[b], heights[c])))
        better = moves < need[left]
        need[left[better]], which[left[better]] = moves[better], index
        among = moves > 0
        left, a, b, c = left[among], a[among], b[among], c[among]
    moves = np.zeros(len(planes))
    np.maximum.at(moves, which, np.maximum(need, 0.0))
    return np.column_stack([planes[:, :3], planes[:, 3] - moves])
