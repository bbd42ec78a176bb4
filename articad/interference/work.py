"""Work that may be done for a proof, counted so that it is the same on every machine.

The unit is one comparison of two pieces of surface. Other work has a fixed price in that unit, measured once. So a verdict depends on
the budget alone, not on the machine or on its load. Users give budgets in nominal seconds; each stands for `PIECES_PER_SECOND` units,
about a second of one core of a 2-core machine of 2024. A wall clock stops work that takes far longer than that. It is an emergency
brake: a verdict that it stopped says so, since it may differ on another machine.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

PIECES_PER_SECOND = 100_000  # units of work in a nominal second
STEP = 60  # units: one round of a search, however few pairs it compares
BOX = 3  # units: placing a box of a tree of joints
PIECE = 250  # units: an attempt to follow loops over a piece of drivers' ranges, …
FOLLOWER, FOLLOWED = 8, 6  # … for each coordinate that follows, and for each of those at a fifth of the sampled poses
PLACED = 20  # units: placing a box along drivers
LOOK = 60  # units: measuring an overlap, …
LOOK_TRIANGLES = 50  # … and one more for this many triangles of both meshes
POSE = 5  # units: placing all parts by a tree of joints at one pose, …
CLOSED = 300  # … or by joints whose loops are closed there
PAIRS_PLACED = 2  # pairs of parts tested for proximity for one unit
DISTANCE = 10  # units: the distance of two surfaces at one pose
TREE_TRIANGLES = 20  # triangles in a tree of boxes built for one unit
BRAKE = 20.0  # factor on the nominal seconds that the clock allows, …
BRAKE_SECONDS = 60.0  # … and seconds added to that


class WorkBudget:
    """A limit of work, and a clock that stops it only in an emergency.

    Args:
        seconds: Nominal seconds of work: each is `PIECES_PER_SECOND` units, on every machine.
        clock: Returns seconds; for the emergency brake.

    Attributes:
        seconds: As given.
        pieces: Units that may be spent.
        work: Units spent so far.
        queries: Comparisons of pairs of pieces, or distances, so far.
        stopped_after: Seconds by the clock at which the emergency brake stopped the work; None if it did not.
    """

    def __init__(self, seconds: float, clock: Callable[[], float] = time.monotonic) -> None:
        self.seconds, self.pieces = seconds, seconds * PIECES_PER_SECOND
        self.work, self.queries = 0, 0
        self.stopped_after: float | None = None
        self._clock, self._start = clock, clock()
        self._brake = BRAKE * seconds + BRAKE_SECONDS

    def spend(self, units: float, *, queries: int = 0) -> None:
        """Count work that was done [units], and the queries in it."""
        self.work += math.ceil(units)
        self.queries += queries

    @property
    def elapsed(self) -> float:
        """Seconds by the clock since the beginning; only the emergency brake depends on them."""
        return self._clock() - self._start

    @property
    def left(self) -> float:
        """Units that are left; 0 after the clock has stopped the work."""
        if self.stopped_after is None and self.elapsed > self._brake:
            self.stopped_after = self.elapsed
        return 0.0 if self.stopped_after is not None else self.pieces - self.work

    @property
    def is_spent(self) -> bool:
        """True when no work is left, or the clock has stopped it."""
        return self.left <= 0

    @property
    def reason(self) -> str:
        """Why the work ended, in a few words."""
        return "the budget was spent" if self.stopped_after is None else f"stopped by the clock after {self.stopped_after:.0f} s"

    def ended(self) -> str:
        """Return the sentence that says why the work ended."""
        if self.stopped_after is not None:
            return (
                f"The work was stopped by the clock after {self.stopped_after:.0f} s, at {self.work} of {self.pieces:.0f} units; "
                "the verdict may differ on another machine."
            )
        return f"The budget of {self.seconds:g} s of work ({self.pieces:.0f} units) was spent."


def piece_price(followers: int, drivers: int) -> int:
    """Return the price of following this many coordinates over a piece of this many drivers' ranges [units]: five poses for each."""
    return PIECE + followers * (FOLLOWER + FOLLOWED * int(5 ** max(drivers - 1, 0)))


def look_price(*triangles: int) -> int:
    """Return the price of measuring the overlap of meshes with this many triangles [units]."""
    return LOOK + sum(triangles) // LOOK_TRIANGLES
