"""A tree of boxes over a surface: every node bounds the triangles below it; leaves are single triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.interference.surface import Surface

IntArray = NDArray[np.signedinteger[Any]]
Bounds = NDArray[np.float32]

_trees: WeakKeyDictionary[Surface, BoxTree] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class BoxTree:
    """Boxes aligned with the part's frame, halved at the median of their longest side.

    Attributes:
        centre: `(nodes, k)` [mm], in space k = 3; the root is node 0, children follow their parents.
        half: Half sides, `(nodes, k)` [mm].
        children: `(nodes, 2)`; −1 for a single triangle.
        triangle: For a leaf, the index of its triangle in `corners`; −1 for other nodes.
        corners: `(T, 3, 3)` [mm].
        order: Indices into `corners` such that each node has a contiguous range of them, `(T,)`; its children have the two halves.
        start: Start of the range of each node, `(nodes,)`.
        size: Length of the range, `(nodes,)`.
    """

    centre: Bounds
    half: Bounds
    children: IntArray
    triangle: IntArray
    corners: FloatArray
    order: IntArray
    start: IntArray
    size: IntArray

    @classmethod
    def of(cls, surface: Surface) -> BoxTree:
        """Return the tree of a surface; cached."""
        tree = _trees.get(surface)
        if tree is None:
            tree = _trees[surface] = cls.over(surface.corners.min(axis=1), surface.corners.max(axis=1), surface.corners)
        return tree

    @classmethod
    def over(cls, low: FloatArray, high: FloatArray, corners: FloatArray) -> BoxTree:
        """Return the tree over boxes `(T, k)` of the triangles: in space, or in other coordinates.

        Args:
            low: Lower ends.
            high: Upper ends.
            corners: Corners of the triangles, `(T, 3, 3)`.
        """
        rank = np.empty(low.shape, dtype=np.int64)  # of the triangles' middles along each axis: one sort, instead of one for each level
        np.put_along_axis(rank, np.argsort((low + high) / 2, axis=0, kind="stable"), np.arange(len(low))[:, None], axis=0)
        order, starts, size = np.arange(len(low)), np.array([0]), np.array([len(low)])
        lows, highs, children, triangle, first = [], [], [], [], 0
        stretches, begin = [], np.array([0])
        while len(starts):
            bottom, top = np.minimum.reduceat(low[order], starts), np.maximum.reduceat(high[order], starts)
            lows.append(bottom)
            highs.append(top)
            single = size == 1
            triangle.append(np.where(single, order[starts], -1))
            below = np.full((len(starts), 2), -1)
            parents = np.flatnonzero(~single)
            below[parents] = first + len(starts) + np.arange(2 * len(parents)).reshape(-1, 2)
            children.append(below)
            first += len(starts)
            stretches.append((begin, size))
            # the triangles of all nodes to be split, sorted by the longest side of each; leaves are removed
            block = np.repeat(np.arange(len(starts)), size)
            axis = np.argmax(top - bottom, axis=1)[block]
            keep = ~single[block]
            order, block, axis = order[keep], block[keep], axis[keep]
            order = order[np.argsort(block * len(low) + rank[order, axis])]
            left = size[parents] // 2
            begin = np.stack([begin[parents], begin[parents] + left], axis=1).ravel()
            size = np.stack([left, size[parents] - left], axis=1).ravel()
            starts = np.concatenate([[0], np.cumsum(size)[:-1]]) if len(size) else np.empty(0, dtype=np.int64)
        bottom, top = np.concatenate(lows), np.concatenate(highs)
        start, count, leaf = (np.concatenate(column) for column in (*zip(*stretches, strict=True), triangle))
        final = np.empty(len(low), dtype=np.int32)
        final[start[leaf >= 0]] = leaf[leaf >= 0]
        # single precision, since many trees exist at once; a box rounded outwards still bounds its triangles
        centre = ((bottom + top) / 2).astype(np.float32)
        half = np.nextafter(np.maximum(top - centre, centre - bottom).astype(np.float32), np.float32(np.inf))
        return cls(centre, half, np.concatenate(children).astype(np.int32), leaf.astype(np.int32), corners, final, start, count)

    @classmethod
    def joined(cls, trees: Sequence[BoxTree], rows: Sequence[IntArray], corners: FloatArray) -> tuple[BoxTree, tuple[int, ...]]:
        """Return trees over parts of a surface joined into one, and the root of each.

        Args:
            trees: Trees of the parts.
            rows: Indices of their triangles among all, `(t,)` each.
            corners: Corners of all triangles, `(T, 3, 3)`.
        """
        nodes = np.cumsum([0, *(len(tree.centre) for tree in trees)])
        begins = np.cumsum([0, *(len(tree.order) for tree in trees)])
        parts = list(zip(trees, rows, nodes, begins, strict=False))
        tree = cls(
            np.concatenate([tree.centre for tree in trees]),
            np.concatenate([tree.half for tree in trees]),
            np.concatenate([np.where(tree.children < 0, -1, tree.children + first) for tree, _, first, _ in parts]),
            np.concatenate([np.where(tree.triangle < 0, -1, which[tree.triangle]) for tree, which, _, _ in parts]),
            corners,
            np.concatenate([which[tree.order] for tree, which, _, _ in parts]),
            np.concatenate([tree.start + begin for tree, _, _, begin in parts]),
            np.concatenate([tree.size for tree in trees]),
        )
        return tree, tuple(int(first) for first in nodes[:-1])

    def flat(self) -> BoxTree:
        """Return the tree without the non-spatial coordinates by which it was made."""
        return replace(self, centre=self.centre[:, :3].copy(), half=self.half[:, :3].copy())

    def over_each(self, values: NDArray[Any], ufunc: np.ufunc) -> NDArray[Any]:
        """Return a minimum or maximum, over the triangles of each node, of values `(T,)`: `(nodes,)`."""
        ends = np.stack([self.start, np.minimum(self.start + self.size, len(values) - 1)], axis=1)
        ordered = values[self.order]
        found = ufunc.reduceat(ordered, ends.ravel())[::2]
        last = self.start + self.size == len(values)  # such a range ended one too early
        return np.asarray(np.where(last, ufunc(found, ordered[-1]), found))
