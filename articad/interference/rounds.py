"""What a joint about one axis or point cannot bring together however it turns: pieces compared by their radius.

A shaft in its bore never comes nearer than its largest radius to the least one of the bore. A direction across the axis shows that a
piece is no nearer to it than that: all of the piece lies ahead of a plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from articad.interference.boxtree import BoxTree
from articad.interference.surface import Core

FloatArray = NDArray[np.float64]


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
