"""Outlines of the pieces of a surface in coordinates that a joint about one axis or point does not change.

A shaft in its bore and a washer on its shoulder never come closer than their outlines in the plane through the axis, whatever the angle.
Triangles whose outlines meet none of the other's are in a separate tree: no range needs to be cut for them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from articad.arrays import BoolArray, FloatArray
from articad.interference.boxtree import BoxTree
from articad.interference.meridian import Ends, meeting
from articad.interference.surface import Surface

WEIGHT = 10.0  # of outlines relative to the size of pieces: pieces that outlines can separate are cut by them first
SLIDING_WEIGHT = np.array([100.0, 100.0, 100.0, 1.0])  # the same for sliding joints: cut lengthwise first, since pieces at all heights meet
MOST_KEPT = 4  # forests of a surface: a part meets all parts beyond one joint with the same outlines

_kept: WeakKeyDictionary[Surface, list[tuple[tuple[NDArray[Any], ...], Forest]]] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Forest:
    """A surface as trees over its parts, with the bounds of each node in coordinates that the joint does not change.

    Attributes:
        tree: The nodes of all trees.
        roots: The root of each tree.
        low: Lower ends of the nodes' outlines, `(nodes, k)` [mm], k = 0 if there are none; the first is the radius.
        high: Upper ends.
        meets: Whether a node has triangles whose outlines meet some of the other surface's, `(nodes,)`.
    """

    tree: BoxTree
    roots: tuple[int, ...]
    low: FloatArray
    high: FloatArray
    meets: BoolArray

    @classmethod
    def plain(cls, surface: Surface) -> Forest:
        """Return a surface without an axis."""
        tree = BoxTree.of(surface)
        none = np.empty((len(tree.centre), 0))
        return cls(tree, (0,), none, none, np.ones(len(none), dtype=bool))

    @classmethod
    def pair(
        cls, a: Surface, b: Surface, of_a: Ends, of_b: Ends, limit: float | FloatArray, weight: float | FloatArray = WEIGHT
    ) -> tuple[Forest, Forest]:
        """Return two surfaces with their outlines; outlines meet if they are within `limit` of each other [mm]."""
        met_a = meeting(of_a, of_b, limit)
        met_b = meeting(of_b, (of_a[0][met_a], of_a[1][met_a]), limit)
        return cls._known(a, of_a, met_a, weight), cls._known(b, of_b, met_b, weight)

    @classmethod
    def _known(cls, surface: Surface, ends: Ends, met: BoolArray, weight: float | FloatArray) -> Forest:
        """Return the forest of a surface; the last few are cached."""
        key, kept = (*ends, met, np.asarray(weight)), _kept.setdefault(surface, [])
        for known, forest in kept:
            if all(np.array_equal(one, other) for one, other in zip(known, key, strict=True)):
                return forest
        kept.append((key, cls._of(surface, ends, met, weight)))
        del kept[:-MOST_KEPT]
        return kept[-1][1]

    @classmethod
    def _of(cls, surface: Surface, ends: Ends, met: BoolArray, weight: float | FloatArray) -> Forest:
        trees, rows, corners = list[BoxTree](), list[NDArray[np.intp]](), surface.corners
        for which in (~met, met):
            if not which.any():
                continue
            own = corners[which]
            spans = [(own.min(axis=1), own.max(axis=1)), (weight * ends[0][which], weight * ends[1][which])]
            low, high = (np.concatenate(side, axis=1) for side in zip(*spans, strict=True))
            trees.append(BoxTree.over(low, high, own).flat())
            rows.append(np.flatnonzero(which))
        tree, roots = BoxTree.joined(trees, rows, corners)
        low = np.stack([tree.over_each(column, np.minimum) for column in ends[0].T], axis=1)
        high = np.stack([tree.over_each(column, np.maximum) for column in ends[1].T], axis=1)
        return cls(tree, roots, low, high, tree.over_each(met, np.logical_or))

    @property
    def sizes(self) -> tuple[int, ...]:
        """Number of triangles in each tree."""
        return tuple(int(self.tree.size[root]) for root in self.roots)
