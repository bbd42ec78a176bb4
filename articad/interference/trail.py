"""What a search did with each two pieces in a box, kept so that somebody else can follow it without searching.

Rows are numbered as they come; each is settled by a direction, cut into two further rows, or left out. Written down they stand in the
order of a queue: the two halves of what is cut, one after the other, come behind all that waits already. Rows of which nothing is noted lie
outside what the joints allow.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

OUTSIDE, CUT_A, CUT_B, CUT_RANGE = -4, -3, -2, -1
OF_A, OF_B, ROUND_A, ROUND_B, REVOLVED = 0, 1, 2, 3, 4  # how a direction is meant: of a, of b; across the axis, with a or b further out


class Written(NamedTuple):
    """A trail as a checker reads it.

    Attributes:
        codes: Of each row a cut, or the number of a direction.
        along: Directions `(n, 3)`, in the order of their kinds.
        kinds: Where the directions of each kind but the first begin, `(3,)`.
    """

    codes: IntArray
    along: FloatArray
    kinds: IntArray


class Trail:
    """What was done, row by row."""

    def __init__(self) -> None:
        self.count = 0
        self._cuts: list[tuple[IntArray, int, int]] = []
        self._settled: list[tuple[IntArray, int, FloatArray]] = []

    def numbers(self, count: int) -> IntArray:
        """Return numbers of new rows."""
        self.count += count
        return np.arange(self.count - count, self.count)

    def settle(self, rows: IntArray, kind: int, along: FloatArray) -> None:
        """Note the directions that settled rows."""
        if len(rows):
            self._settled.append((rows, kind, along))

    def cut(self, rows: IntArray, code: int) -> IntArray:
        """Note that rows were cut; return the numbers of their halves, two by two."""
        found = self.numbers(2 * len(rows))
        if len(rows):
            self._cuts.append((rows, code, int(found[0])))
        return found

    def written(self) -> Written:
        """Return the trail as a checker reads it."""
        codes, first = np.full(self.count, OUTSIDE, dtype=np.int64), np.zeros(self.count, dtype=np.int64)
        for rows, code, begin in self._cuts:
            codes[rows], first[rows] = code, begin + 2 * np.arange(len(rows))
        settled = np.concatenate([rows for rows, _, _ in self._settled] or [np.empty(0, dtype=np.int64)])
        keys = np.concatenate(
            [np.concatenate([np.full((len(u), 1), float(kind)), u + 0.0], axis=1) for _, kind, u in self._settled] or [np.empty((0, 4))]
        )
        unique, where = np.unique(keys, axis=0, return_inverse=True)
        codes[settled] = where.ravel()
        level, out = np.array([0]), []
        while len(level):
            out.append(codes[level])
            parted = level[(CUT_A <= out[-1]) & (out[-1] <= CUT_RANGE)]
            level = np.stack([first[parted], first[parted] + 1], axis=1).ravel()
        return Written(np.concatenate(out), unique[:, 1:], np.searchsorted(unique[:, 0], [OF_B, ROUND_A, ROUND_B, REVOLVED]))
