"""What a joint about one axis or point cannot bring together however it turns: pieces compared by their radius.

A shaft in its bore never comes nearer than its largest radius to the least one of the bore. A direction across the axis shows that a
piece is no nearer to it than that: all of the piece lies ahead of a plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from articad.interference.boxtree import BoxTree
from articad.interference.surface import Core, Surface

FloatArray = NDArray[np.float64]

WEIGHT = 10.0  # of radius and height against the size of pieces


@dataclass(frozen=True, eq=False)
class Rounds:
    """Radii of the nodes of a tree.

    Attributes:
        direction: In the part's frame, `(nodes, 3)`; across the axis, unit or 0.
        least: No point of a node is nearer to the axis along its direction, `(nodes,)` [mm].
        certain: The smallest `least` of a node's triangles, `(nodes,)` [mm]: what cutting it comes to.
        most: No point of a node is further from the axis, `(nodes,)` [mm].
        core: The axis or point, in the part's frame.
    """

    direction: FloatArray
    least: FloatArray
    certain: FloatArray
    most: FloatArray
    core: Core

    @classmethod
    def of(cls, tree: BoxTree, core: Core) -> Rounds:
        """Return the radii of a tree about the axis or point of a joint."""
        axes = core.frame[:3, : core.dimensions]
        flat = core.local(tree.corners)
        edge = np.roll(flat, -1, axis=1) - flat
        t = np.clip(-(flat * edge).sum(axis=2) / np.maximum((edge * edge).sum(axis=2), 1e-300), 0.0, 1.0)
        ways = [flat + t[..., None] * edge]  # to the nearest point of each edge
        if core.dimensions == 3:
            n = np.cross(edge[:, 0], edge[:, 1])[:, None]
            ways += [n, -n]
        else:
            n = ((np.cross(tree.corners[:, 1] - tree.corners[:, 0], tree.corners[:, 2] - tree.corners[:, 0])) @ axes)[:, None]
            ways += [n, -n]
        u = unit(np.concatenate(ways, axis=1))
        ahead = (u @ flat.transpose(0, 2, 1)).min(axis=2)
        best = np.argmax(ahead, axis=1)
        rows = np.arange(len(flat))
        middle = core.local(tree.centre)
        outwards = unit(middle)
        direction = outwards @ axes.T
        least = (outwards * middle).sum(axis=1) - (np.abs(direction) * tree.half).sum(axis=1)
        leaf = tree.triangle >= 0
        of = tree.triangle[leaf]
        direction[leaf], least[leaf] = (u[rows, best] @ axes.T)[of], ahead[rows, best][of]
        return cls(
            direction,
            least,
            tree.over_each(ahead[rows, best], np.minimum),
            tree.over_each(np.linalg.norm(flat, axis=2).max(axis=1), np.maximum),
            core,
        )


def unit(v: FloatArray) -> FloatArray:
    """Return vectors `(…, k)` made one long; what is none stays 0."""
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300))


def about(surface: Surface, core: Core) -> BoxTree:
    """Return a tree over a surface whose pieces are first told apart by their radius and height about the axis of a joint."""
    corners = surface.corners
    radius = np.linalg.norm(core.local(corners), axis=2)
    keys = [core.least_radii(corners), radius.max(axis=1)]
    spans = [(corners.min(axis=1), corners.max(axis=1)), *((WEIGHT * key[:, None], WEIGHT * key[:, None]) for key in keys)]
    if core.dimensions == 2:
        height = (corners - core.frame[:3, 3]) @ core.frame[:3, 2]
        spans += [(WEIGHT * key[:, None], WEIGHT * key[:, None]) for key in (height.min(axis=1), height.max(axis=1))]
    low, high = (np.concatenate(ends, axis=1) for ends in zip(*spans, strict=True))
    return BoxTree.over(low, high, corners).flat()
