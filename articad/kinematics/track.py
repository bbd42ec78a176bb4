"""Track: the path of one driver, traced once and evaluated at any of its values."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from articad.arrays import BoolArray, FloatArray, IndexArray
from articad.kinematics.continuation import ROUNDING, Follower, Stop, Trace
from articad.kinematics.loops import CLOSED

_MOST_TURNS = 12  # turns of a loop's slowest driven angle after which a motion is not expected to repeat
_SAME = 1e-9  # rad, mm: tolerance for a configuration to be the same again


class Period(NamedTuple):
    """How a motion repeats.

    Attributes:
        length: Travel of the driver [rad, mm].
        advance: What one repetition adds to the coordinates `(columns,)`: whole turns for those in loops, and the resulting change of
            those coupled to them.
    """

    length: float
    advance: FloatArray


@dataclass(eq=False)
class Track:
    """One driver's path from a start in both directions, traced as far as needed so far.

    Attributes:
        follower: Object that follows the branch.
        Q: Closed start `(columns,)`.
        column: The driver's column in the system.
        certify: Whether every step is to be proven.
    """

    follower: Follower
    Q: FloatArray
    column: int
    certify: bool = False
    _sides: dict[int, Trace] = field(default_factory=dict)
    _periods: dict[int, Period | None] = field(default_factory=dict)

    @property
    def start(self) -> float:
        """The driver's value at the start [rad, mm]."""
        return float(self.Q[self.column])

    @property
    def _unit(self) -> float:
        system = self.follower.system
        return float(system.scale[system.layout.freedom_of(self.column)])

    def side(self, value: float) -> Trace:
        """Return the trace towards a value, followed at least that far if that is possible."""
        sign = 1 if value >= self.start else -1
        length = abs(value - self.start) / self._unit
        trace = self._sides.get(sign)
        if trace is None or (trace.stop is Stop.ARRIVED and trace.end < length):
            direction = self.direction(sign)
            if trace is None:
                trace = self.follower.trace(self.Q, direction, length, certify=self.certify)
            else:
                more = self.follower.trace(trace.Q_end, direction, length - trace.end, certify=self.certify)
                shifted = tuple(node._replace(s=node.s + trace.end) for node in more.nodes[1:])
                trace = Trace((*trace.nodes, *shifted), more.stop, more.end + trace.end, more.Q_end, trace.certified and more.certified)
            self._sides[sign] = trace
        return trace

    def largest_tube(self) -> float:
        """Return the largest radius [rad, lengths L] around a predictor within which the only solution of a step lies, as far as traced."""
        steps = (step for trace in self._sides.values() for step in itertools.pairwise(trace.nodes))
        return max((float(self.follower.tube(a, np.asarray(b.s - a.s))) for a, b in steps), default=0.0)

    def direction(self, sign: int) -> FloatArray:
        """Return the scaled velocity of the driver, and of all that is coupled to it, towards increasing (+1) or decreasing (−1) values."""
        system = self.follower.system
        return sign * system.ties.images(system.layout.freedom_of(self.column))

    def value(self, sign: int, s: float) -> float:
        """Return the driver's value at the parameter s of a side."""
        return self.start + sign * s * self._unit

    def evaluate(self, values: FloatArray) -> tuple[FloatArray, BoolArray, BoolArray]:
        """Return the configurations at driver values.

        Args:
            values: `(batch,)` [rad, mm].

        Returns:
            Coordinates `(batch, columns)`; which were reached; which of these are proven to lie on the branch.
        """
        Q = np.tile(self.Q, (len(values), 1))
        reached, proved = np.zeros(len(values), dtype=bool), np.zeros(len(values), dtype=bool)
        for sign in (1, -1):
            mine = np.flatnonzero((values >= self.start) if sign > 0 else (values < self.start))
            if not mine.size:
                continue
            within, turns, advance = self._reduced(values[mine], sign)
            far = within.max() if sign > 0 else within.min()
            Q[mine], reached[mine], proved[mine] = self._on_side(self.side(float(far)), within)
            if advance is not None:
                Q[mine] += turns[:, None] * advance
                Q[mine, self.column] = values[mine]
                Q[mine] = self.follower.system.ties.fitted(Q[mine], ~self.follower.dependent)
        return Q, reached, proved

    def period(self, sign: int) -> Period | None:
        """Return the travel of the driver after which everything repeats, up to whole turns; None if it does not.

        That is up to 12 times the period of the loops: what couplings connect to them may take longer, or never repeat.
        """
        once = self.repeat(sign)
        if once is None:
            return None
        angles = np.array([c.unit == "rad" for c in self.follower.system.layout.coordinates])
        for times in range(1, _MOST_TURNS + 1):
            advance = times * once.advance
            whole = np.where(angles, 2 * math.pi * np.round(advance / (2 * math.pi)), 0.0)
            if np.abs(advance - whole).max() < _SAME:
                return Period(times * once.length, whole)
        return None

    def repeat(self, sign: int) -> Period | None:
        """Return the travel of the driver after which all loops repeat; None if they do not within 12 turns of what it drives."""
        if sign not in self._periods:
            self._periods[sign] = self._found_period(sign)
        return self._periods[sign]

    @cached_property
    def turn(self) -> float | None:
        """Travel [rad, mm] of the driver in which the slowest angle that it drives in a loop turns once.

        None if it moves no loop, or moves one by a translation.
        """
        system = self.follower.system
        rates = np.abs(self.direction(1) * system.scale / self._unit) * system.in_loops
        if rates[system.layout.is_length].any() or not rates.any():
            return None
        return 2 * math.pi / float(rates[rates > 0].min())

    def _found_period(self, sign: int) -> Period | None:
        system, turn = self.follower.system, self.turn
        if turn is None:
            return None
        layout = system.layout
        looped = np.array([system.in_loops[layout.freedom_of(i)] for i in range(layout.n_columns)])
        angles = looped & np.array([c.unit == "rad" for c in layout.coordinates])
        for turns in range(1, _MOST_TURNS + 1):
            value = self.start + sign * turn * turns
            trace = self.side(value)
            if trace.stop is not Stop.ARRIVED:
                return None
            Q, reached, _ = self._on_side(trace, np.array([value]))  # a trace that went farther before need not have a node here
            if not reached[0]:
                return None
            change = Q[0] - self.Q
            advance = np.where(angles, 2 * math.pi * np.round(change / (2 * math.pi)), 0.0)
            if np.abs(change - advance)[looped].max() < _SAME:
                advance = np.where(looped, advance, change)
                return Period(turn * turns, system.ties.spread(advance, looped))
        return None

    def _reduced(self, values: FloatArray, sign: int) -> tuple[FloatArray, FloatArray, FloatArray | None]:
        """Return values within the first period, how many periods were removed, and what one adds to the coordinates."""
        away = np.abs(values - self.start)
        period = self.repeat(sign) if self.turn is not None and away.max() > self.turn * (1 + 1e-9) else None
        if period is None:
            return values, np.zeros(len(values)), None
        turns = np.floor(away / period.length)
        return values - sign * turns * period.length, turns, period.advance

    def _on_side(self, trace: Trace, values: FloatArray) -> tuple[FloatArray, BoolArray, BoolArray]:
        system = self.follower.system
        s = np.abs(values - self.start) / self._unit
        reached = s <= trace.end * (1 + 1e-15)
        guess, left = self._hermite(trace, s)
        beyond = reached & (s > trace.nodes[-1].s)
        guess[:, self.column] = values
        at = np.flatnonzero(reached)
        closed, norm = system.close_many(guess[at], self.follower.dependent, iterations=12)
        for i in np.flatnonzero(norm > CLOSED):  # beside a dead point the normal equations are too ill-conditioned
            one = system.close(guess[at[i]], self.follower.dependent)
            closed[i], norm[i] = one.Q, one.residual
        guess[at], good = closed, norm <= CLOSED
        reached[at] = good
        proved = np.zeros(len(values), dtype=bool)
        if trace.certified:
            proved = reached & ~beyond & self._inside_tubes(trace, s, guess, left)
        return guess, reached, proved

    def _hermite(self, trace: Trace, s: FloatArray) -> tuple[FloatArray, IndexArray]:
        """Return cubic guesses at the parameters s, and the index of each one's left node.

        Between the last node and a dead point the guess is the last node, which is on the branch's side of it.
        """
        system, nodes = self.follower.system, trace.nodes
        stations = np.array([node.s for node in nodes])
        Q, rate = np.array([node.Q for node in nodes]), np.array([node.rate for node in nodes])
        left = np.clip(np.searchsorted(stations, s, side="right") - 1, 0, max(0, len(nodes) - 2))
        if len(nodes) == 1:
            return np.tile(Q[0], (len(s), 1)), left
        h = (stations[left + 1] - stations[left])[:, None]
        t = np.clip((s[:, None] - stations[left][:, None]) / h, 0.0, 1.0)
        chord = system.step_between(Q[left], Q[left + 1])
        step = t * (1 - t) ** 2 * h * rate[left] + t * t * (3 - 2 * t) * chord + t * t * (t - 1) * h * rate[left + 1]
        return system.move(Q[left], step), left

    def _inside_tubes(self, trace: Trace, s: FloatArray, Q: FloatArray, left: IndexArray) -> BoolArray:
        """Return which configurations lie within the tube of their left node's predictor, where there is only one solution."""
        inside = np.zeros(len(s), dtype=bool)
        for i, k in enumerate(left):
            node = trace.nodes[int(k)]
            h = s[i] - node.s
            predicted = self.follower.system.move(node.Q, h * node.rate)
            distance = np.linalg.norm(self.follower.system.step_between(predicted, Q[i])[self.follower.system.in_loops])
            inside[i] = distance <= self.follower.tube(node, np.asarray(h)) + ROUNDING and h <= self.follower.certified_step(node) * (
                1 + 1e-12
            )
        return inside
