"""Hatching of cut faces: parallel lines at 45°."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from articad.arrays import FloatArray

__all__ = ["hatched"]

SPACING = 1.6  # mm of paper


def hatched(loops: Sequence[FloatArray], spacing: float = SPACING) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
    """Yield the ends of the lines at 45° inside closed outlines, by the even-odd rule.

    Args:
        loops: Outer and inner outlines, `(N, 2)` each.
        spacing: Distance of the lines.
    """
    turn = np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2.0)  # the lines are horizontal in the turned frame
    starts = np.concatenate([np.asarray(loop) @ turn.T for loop in loops])
    ends = np.concatenate([np.roll(np.asarray(loop) @ turn.T, -1, axis=0) for loop in loops])
    low, high = starts[:, 1].min(), starts[:, 1].max()
    for number in range(int(np.ceil(low / spacing)), int(np.floor(high / spacing)) + 1):
        height = number * spacing + 1e-7
        crosses = (starts[:, 1] <= height) != (ends[:, 1] <= height)
        a, b = starts[crosses], ends[crosses]
        across = np.sort(a[:, 0] + (height - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0]))
        for x0, x1 in zip(across[::2], across[1::2], strict=False):
            first, second = np.array([x0, height]) @ turn, np.array([x1, height]) @ turn
            yield (float(first[0]), float(first[1])), (float(second[0]), float(second[1]))
