"""How joints are driven, whatever the engine: a smooth way from rest to the lower bound, to the upper one, and back."""

from __future__ import annotations

import math
from collections.abc import Iterator

STROKE_S = 1.0  # at least, for each way: rest to lower, lower to upper, upper to rest
PACE_RAD_S = 3.0  # mean speed of a stroke
PACE_M_S = 1.0
MOST_SPEED = 100.0  # rad/s or m/s: nothing that is held goes so fast
MOST_JOINTS = 80
FREE_SLIDE_M = 0.1  # either way, that a slide without limits is driven


def strokes(rest: float, lower: float, upper: float, steps: int) -> Iterator[float]:
    """Yield where a joint is to be, step by step, with a moment's pause at each end.

    Args:
        rest: Where it starts and ends [rad or m].
        lower: Bound that it goes to first.
        upper: Bound that it goes to then.
        steps: For each of the three ways.
    """
    pause = max(1, steps // 5)
    for start, end in ((rest, lower), (lower, upper), (upper, rest)):
        for step in range(steps - pause):
            yield start + (end - start) * (1 - math.cos(math.pi * step / max(1, steps - pause - 1))) / 2
        for _ in range(pause):
            yield end
