"""Which things hold each other along a direction, found with as few questions as decide it.

Things that block each other along a direction form a directed graph (Wilson and Latombe 1994). What can leave as a whole is a closed set: a
strongly connected component from which no edge leaves. Each edge is a test of two surfaces, and most directions free nothing. So edges are
asked for one at a time, out of the components that may still be closed: mostly one edge for each thing, not one for each pair.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from articad.arrays import IntArray

__all__ = ["Blocking"]


class Blocking:
    """The graph of n things of which some block others.

    Args:
        count: How many things there are.
        blocks: Whether the second thing stops the first one.
        likely: How likely that is, for the order of the questions; the answers do not depend on it.
    """

    def __init__(self, count: int, blocks: Callable[[int, int], bool], likely: Callable[[int, int], float]) -> None:
        self._ask, self._likely = blocks, likely
        self._known = np.eye(count, dtype=bool)
        self._blocks = np.zeros((count, count), dtype=bool)

    def closed(self, things: Iterable[int]) -> list[list[int]]:
        """Return the smallest sets of some things of which none is stopped by another one of these things outside its set."""
        nodes = np.array(sorted(things), dtype=np.int64)
        while True:
            _, label = connected_components(csr_array(self._blocks[np.ix_(nodes, nodes)]), directed=True, connection="strong")
            groups = [nodes[label == group] for group in range(int(label.max()) + 1)]
            before = int(self._blocks.sum())
            closed = [group.tolist() for group in groups if not self._is_stopped(group, np.setdiff1d(nodes, group))]
            if int(self._blocks.sum()) == before:
                return closed

    def _is_stopped(self, group: IntArray, others: IntArray) -> bool:
        """Return whether one of a group is stopped by one of the others; asks until one is."""
        if self._blocks[np.ix_(group, others)].any():
            return True
        pairs: Sequence[tuple[int, int]] = [(int(i), int(j)) for i in group for j in others if not self._known[i, j]]
        for i, j in sorted(pairs, key=lambda pair: -self._likely(*pair)):
            self._known[i, j], self._blocks[i, j] = True, self._ask(i, j)
            if self._blocks[i, j]:
                return True
        return False
