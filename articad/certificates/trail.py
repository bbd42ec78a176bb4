"""Record of a search: what it did with each two pieces in a box, so that a checker can repeat it without searching.

Rows are numbered as they arise; each is settled by a direction or by its radii, cut into two further rows, or left out. They are written
in breadth-first order: oldest row first, halves of cut rows at the end. Rows without a record lie outside the limits of joints.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray, IntArray

SWUNG, LEAN, ROUND, OUTSIDE, CUT_A, CUT_B, CUT_RANGE = -7, -6, -5, -4, -3, -2, -1
OF_A, OF_B = 0, 1  # the frame in which a direction is written


class Written(NamedTuple):
    """A trail in the form that a checker reads.

    Attributes:
        codes: For each row a cut, `SWUNG`, `LEAN`, `ROUND`, `OUTSIDE`, or the number of a direction.
        along: Directions `(n, 3)`, those in the frame of a first.
        of_a: How many of them are in the frame of a.
    """

    codes: IntArray
    along: FloatArray
    of_a: int


class Trail:
    """The record, row by row."""

    def __init__(self) -> None:
        self.count = self.roots = 0
        self._cuts: list[tuple[IntArray, int, int]] = []
        self._settled: list[tuple[IntArray, int, FloatArray]] = []
        self._kept: list[tuple[IntArray, int]] = []

    def begin(self, count: int) -> IntArray:
        """Return numbers of the first rows."""
        self.roots = count
        return self.numbers(count)

    def numbers(self, count: int) -> IntArray:
        """Return numbers of new rows."""
        self.count += count
        return np.arange(self.count - count, self.count)

    def keep(self, rows: IntArray, code: int) -> None:
        """Record that rows are apart in radius or angle, which the joint does not change."""
        self._kept.append((rows, code))

    def settle(self, rows: IntArray, kind: int, along: FloatArray) -> None:
        """Record the directions that settled rows."""
        if len(rows):
            self._settled.append((rows, kind, along))

    def cut(self, rows: IntArray, code: int) -> IntArray:
        """Record that rows were cut; return the numbers of their halves, two by two."""
        found = self.numbers(2 * len(rows))
        if len(rows):
            self._cuts.append((rows, code, int(found[0])))
        return found

    def written(self) -> Written:
        """Return the trail in the form that a checker reads."""
        codes, first = np.full(self.count, OUTSIDE, dtype=np.int64), np.zeros(self.count, dtype=np.int64)
        for rows, code in self._kept:
            codes[rows] = code
        for rows, code, begin in self._cuts:
            codes[rows], first[rows] = code, begin + 2 * np.arange(len(rows))
        settled = np.concatenate([rows for rows, _, _ in self._settled] or [np.empty(0, dtype=np.int64)])
        keys = np.concatenate(
            [np.concatenate([np.full((len(u), 1), float(kind)), u + 0.0], axis=1) for _, kind, u in self._settled] or [np.empty((0, 4))]
        )
        # the different directions in order, as of `numpy.unique` along an axis, which takes ten times as long
        order = np.lexsort(keys.T[::-1])
        is_new = np.ones(len(keys), dtype=bool)
        is_new[1:] = (keys[order[1:]] != keys[order[:-1]]).any(axis=1)
        unique = keys[order[is_new]]
        codes[settled[order]] = np.cumsum(is_new) - 1
        level, out = np.arange(self.roots), []
        while len(level):
            out.append(codes[level])
            parted = level[(out[-1] >= CUT_A) & (out[-1] <= CUT_RANGE)]
            level = np.stack([first[parted], first[parted] + 1], axis=1).ravel()
        return Written(np.concatenate(out), unique[:, 1:], int(np.searchsorted(unique[:, 0], OF_B)))
