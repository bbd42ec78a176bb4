"""ISO 2768-1: general tolerances of linear sizes without a tolerance of their own, by class (f, m, c, v) and nominal size."""

from __future__ import annotations

import bisect
from typing import Final, Literal, get_args

__all__ = ["CLASSES", "LARGEST_MM", "ToleranceClass", "deviation", "finer_class"]

ToleranceClass = Literal["f", "m", "c", "v"]
CLASSES: Final[tuple[ToleranceClass, ...]] = get_args(ToleranceClass)  # the finest first

# ISO 2768-1, table 1: upper ends of the steps of nominal size [mm], "over the one before, up to and including"
_STEPS: Final = (3, 6, 30, 120, 400, 1000, 2000, 4000)
LARGEST_MM: Final = float(_STEPS[-1])
# permissible deviations [mm]; the standard leaves two cells empty: v up to 3 mm and f over 2000 mm
_DEVIATIONS: Final[dict[ToleranceClass, tuple[float | None, ...]]] = {
    "f": (0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, None),
    "m": (0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0),
    "c": (0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0),
    "v": (None, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0),
}


def deviation(letter: ToleranceClass, size: float) -> float | None:
    """Return the permissible deviation t of a size: it may be t larger or smaller than nominal [mm].

    Sizes below 0.5 mm, for which the standard wants a tolerance of their own, get the deviation of its first step.

    Args:
        letter: Of the class: f, m, c or v.
        size: Nominal size [mm].

    Returns:
        None if the standard has no deviation for this size: beyond 4000 mm, f beyond 2000 mm, v up to 3 mm.
    """
    step = bisect.bisect_left(_STEPS, size)
    return _DEVIATIONS[letter][step] if step < len(_STEPS) else None


def finer_class(letter: ToleranceClass, sizes: tuple[float, ...], most: float) -> ToleranceClass | None:
    """Return the coarsest class finer than `letter` whose deviations for these sizes add up to less than `most` [mm]; None if none does."""
    for other in reversed(CLASSES[: CLASSES.index(letter)]):
        found = [deviation(other, size) for size in sizes]
        if sum(share for share in found if share is not None) < most and None not in found:
            return other
    return None
