"""Covering the range of one coordinate with intervals, in each of which the distance at the centre excludes contact.

A distance d at q clears every q' with reach·|q' − q| < d. `cover_line` walks from a start to both ends with intervals that
overlap as little as possible (two-sided conservative advancement). It finds first contacts exactly; `clearing` is what proves whole
ranges.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from articad.interference.motion import Distance
from articad.interference.work import DISTANCE, WorkBudget

STRICT = 1e-7  # share by which a box is smaller than its distance allows, so that the inequality is strict despite rounding
_GUESS = 0.97  # of the width that a linear distance would allow: a miss costs one query, too small a guess costs many
_STEEPEST = 0.75  # a slope is extrapolated up to this share of the reach
_SMALLEST = 1e-12  # of the range: smaller boxes are rounding


@dataclass(frozen=True)
class CoverBox:
    """A part of the range that one distance clears.

    Attributes:
        centre: Where the distance was measured, `(n,)`.
        half: Half sides, `(n,)`.
        distance: Distance at the centre, or a lower bound of it [mm].
    """

    centre: tuple[float, ...]
    half: tuple[float, ...]
    distance: float


@dataclass
class Cover:
    """The result of a covering.

    Attributes:
        boxes: They cover `[lower, upper]` of a line, or all of a box if `is_complete`.
        lower: End of the cleared range below the start; only for a line.
        upper: The same above it.
        contacts: Values at which there is contact, one per end of a line.
        out_of_budget: True if the work stopped early.
    """

    boxes: list[CoverBox] = field(default_factory=list)
    lower: float = 0.0
    upper: float = 0.0
    contacts: list[tuple[float, ...]] = field(default_factory=list)
    out_of_budget: bool = False

    @property
    def is_complete(self) -> bool:
        """True when the whole range is cleared."""
        return not self.contacts and not self.out_of_budget


def cover_line(
    distance: Distance,
    bounds: tuple[float, float],
    start: float,
    *,
    reach: float,
    epsilon: float = 1e-3,
    budget: WorkBudget,
    most: int = 100_000,
) -> Cover:
    """Clear a single coordinate from `start` outwards, up to its bounds or to contact.

    Args:
        distance: Function that returns the distance at a value [mm].
        bounds: Bounds of the coordinate [rad or mm].
        start: Within the bounds.
        reach: Speed of the fastest point [mm/rad or 1].
        epsilon: A distance of no more than this is contact [mm].
        budget: The work budget.
        most: Largest number of queries for this line.
    """
    walk = _Walk(distance, reach, epsilon, budget, most)
    upper = walk.outwards(start, bounds[1])
    lower = walk.outwards(start, bounds[0])
    walk.cover.lower, walk.cover.upper = lower, upper
    walk.cover.boxes.sort(key=lambda box: box.centre)
    return walk.cover


class _Walk:
    def __init__(self, distance: Distance, reach: float, epsilon: float, budget: WorkBudget, most: int) -> None:
        self.distance, self.reach, self.epsilon = distance, max(reach, 1e-12), epsilon
        self.budget, self.left = budget, most
        self.cover = Cover()
        self._seen: dict[float, float] = {}

    def gap(self, q: float) -> float:
        """Return the distance at a value [mm], measured once."""
        if q not in self._seen:
            self.budget.spend(DISTANCE, queries=1)
            self.left -= 1
            self._seen[q] = self.distance((q,))
        return self._seen[q]

    def outwards(self, start: float, end: float) -> float:
        """Clear from start to end; return how far that succeeded."""
        sign = 1.0 if end >= start else -1.0
        length = abs(end - start)
        done, slope = 0.0, 0.0  # measured from the start; slope of the spare distance along the way
        here = self.gap(start)
        if not self._clears(here):
            self.cover.contacts.append((start,))
            return start
        done = self._add(start, here)
        last_at, last = 0.0, here
        while done < length:
            if self.budget.is_spent or self.left <= 0:
                self.cover.out_of_budget = True
                break
            ahead = self._ahead(done, last_at, last, slope)
            at = min(done + ahead, max((done + length) / 2, done + _SMALLEST * length), length)
            spare = self.gap(start + sign * at)
            half = spare / self.reach * (1 - STRICT)
            if half < at - done:  # too far: the box would not reach back, so query at the frontier itself
                beyond_at, beyond = at, spare
                at, spare = done, self.gap(start + sign * done)
                if not self._clears(spare):
                    self.cover.contacts.append((start + sign * done,))
                    break
                slope = self._slope(beyond - spare, beyond_at - at)
                half = spare / self.reach * (1 - STRICT)
            elif not self._clears(spare):
                self.cover.contacts.append((start + sign * at,))
                break
            elif at > last_at:
                slope = self._slope(spare - last, at - last_at)
            self._add(start + sign * at, spare)
            last_at, last = at, spare
            if at + half <= done:  # rounding: no progress is possible at this distance
                self.cover.contacts.append((start + sign * done,))
                break
            done = at + half
        return end if done >= length else start + sign * done

    def _ahead(self, done: float, last_at: float, last: float, slope: float) -> float:
        """Guess how far ahead of the frontier a distance still reaches back to it, by linear extrapolation."""
        expected = last + slope * (done - last_at)
        if expected <= self.epsilon:
            expected = max(last / 4, self.epsilon)
        return _GUESS * expected / (self.reach - slope)

    def _slope(self, rise: float, run: float) -> float:
        return float(np.clip(rise / run, -self.reach, _STEEPEST * self.reach)) if run > 0 else 0.0

    def _clears(self, spare: float) -> bool:
        return spare > self.epsilon

    def _add(self, q: float, spare: float) -> float:
        half = spare / self.reach * (1 - STRICT)
        self.cover.boxes.append(CoverBox((q,), (half,), spare))
        return half
