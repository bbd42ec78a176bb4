"""The motion of driven joints, independent of the engine: smoothly from rest to the lower bound, to the upper one, and back."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping

STROKE_S = 1.0  # at least, for each stroke: rest to lower, lower to upper, upper to rest
PACE_RAD_S = 3.0  # mean speed of a stroke
PACE_M_S = 1.0
PACE_FOLLOWER = 30.0  # rad/s or m/s: largest mean speed of a joint that follows a driven one
MOST_SPEED = 100.0  # rad/s or m/s: joints that are held do not move so fast
MOST_JOINTS = 80
FREE_SLIDE_M = 0.1  # in both directions, for a slide without limits


def strokes(rest: float, lower: float, upper: float, steps: int) -> Iterator[float]:
    """Yield the target of a joint, step by step, with a short pause at each end.

    Args:
        rest: Its value at the start and the end [rad or m].
        lower: Bound that is reached first.
        upper: Bound that is reached second.
        steps: Number for each of the three strokes.
    """
    pause = max(1, steps // 5)
    for start, end in ((rest, lower), (lower, upper), (upper, rest)):
        for step in range(steps - pause):
            yield start + (end - start) * (1 - math.cos(math.pi * step / max(1, steps - pause - 1))) / 2
        for _ in range(pause):
            yield end


def led(mimics: Mapping[str, tuple[str, float, float]], names: Collection[str]) -> dict[str, tuple[str, float, float]]:
    """Return the joints that follow others, each with the leader that follows none: value = ratio · leader + offset.

    Joints that follow each other in a circle have no leader and are left out.

    Args:
        mimics: The joint that each follower names, its multiplier and its offset [rad or m].
        names: The joints of the model.
    """
    found = {}
    for name in names:
        leader, ratio, offset, seen = name, 1.0, 0.0, {name}
        while leader in mimics and mimics[leader][0] in names and mimics[leader][0] not in seen:
            above, share, shift = mimics[leader]
            leader, ratio, offset = above, ratio * share, offset + ratio * shift
            seen.add(leader)
        if leader != name and mimics.get(leader, ("",))[0] not in seen:
            found[name] = leader, ratio, offset
    return found
