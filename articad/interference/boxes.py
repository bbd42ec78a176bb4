"""Finds which of many boxes meet, without comparing each with each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray

IntArray = NDArray[np.intp]


def meeting_boxes(low: FloatArray, high: FloatArray) -> IntArray:
    """Return the pairs (i, j), i < j, of boxes that touch or overlap, in order, `(pairs, 2)`.

    The boxes are sorted along the axis on which they are spread farthest; each is compared with those that begin before it ends.

    Args:
        low: Lowest corners `(n, 3)`.
        high: Highest corners `(n, 3)`.
    """
    if len(low) < 2:
        return np.zeros((0, 2), dtype=np.intp)
    size = np.maximum((high - low).mean(axis=0), np.finfo(float).tiny)
    axis = int(np.argmax(np.ptp(low, axis=0) / size))
    order = np.argsort(low[:, axis], kind="stable")
    ends = np.searchsorted(low[order, axis], high[order, axis], side="right")
    found = []
    for position, (i, end) in enumerate(zip(order.tolist(), ends.tolist(), strict=True)):
        later = order[position + 1 : end]
        meet = later[((low[later] <= high[i]) & (low[i] <= high[later])).all(axis=1)]
        found.append(np.column_stack([np.minimum(meet, i), np.maximum(meet, i)]))
    pairs = np.concatenate(found)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
