"""Track: where one driver leads, traced once and read at any of its values."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from articad.connectors import FloatArray
from articad.kinematics.continuation import ROUNDING, Follower, Stop, Trace
from articad.kinematics.loops import CLOSED, BoolArray, IndexArray


@dataclass(eq=False)
class Track:
    """One driver's way from a start in both directions, traced as far as it was asked for.

    Attributes:
        follower: Who follows.
        Q: Closed start `(columns,)`.
        column: The driver's column in the system.
        certify: Whether every step is to be proved.
    """

    follower: Follower
    Q: FloatArray
    column: int
    certify: bool = False
    _sides: dict[int, Trace] = field(default_factory=dict)

    @property
    def start(self) -> float:
        """The driver's value at the start [rad, mm]."""
        return float(self.Q[self.column])

    @property
    def _unit(self) -> float:
        system = self.follower.system
        return float(system.scale[system.layout.freedom_of(self.column)])

    def side(self, value: float) -> Trace:
        """Return the trace towards a value, followed at least as far, if that is possible."""
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

    def direction(self, sign: int) -> FloatArray:
        """Return the scaled velocity of the driver towards growing (+1) or falling (−1) values."""
        direction = np.zeros(self.follower.system.layout.n_freedoms)
        direction[self.follower.system.layout.freedom_of(self.column)] = float(sign)
        return direction

    def value(self, sign: int, s: float) -> float:
        """Return the driver's value at the parameter s of a side."""
        return self.start + sign * s * self._unit

    def evaluate(self, values: FloatArray) -> tuple[FloatArray, BoolArray, BoolArray]:
        """Return the configurations at driver values.

        Args:
            values: `(batch,)` [rad, mm].

        Returns:
            Coordinates `(batch, columns)`; which were reached; which of these are proved to lie on the branch.
        """
        Q = np.tile(self.Q, (len(values), 1))
        reached, proved = np.zeros(len(values), dtype=bool), np.zeros(len(values), dtype=bool)
        for sign in (1, -1):
            mine = np.flatnonzero((values >= self.start) if sign > 0 else (values < self.start))
            if mine.size:
                far = values[mine].max() if sign > 0 else values[mine].min()
                trace = self.side(float(far))
                Q[mine], reached[mine], proved[mine] = self._on_side(trace, values[mine])
        return Q, reached, proved

    def _on_side(self, trace: Trace, values: FloatArray) -> tuple[FloatArray, BoolArray, BoolArray]:
        system = self.follower.system
        s = np.abs(values - self.start) / self._unit
        reached = s <= trace.end * (1 + 1e-15)
        guess, left = self._hermite(trace, s)
        beyond = reached & (s > trace.nodes[-1].s)
        for i in np.flatnonzero(beyond):
            guess[i] = self._near_fold(trace, float(s[i]))
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
        """Return cubic guesses at the parameters s, and the index of each one's left node."""
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
        """Tell which configurations lie within the tube of their left node's predictor, where there is one solution only."""
        inside = np.zeros(len(s), dtype=bool)
        for i, k in enumerate(left):
            node = trace.nodes[int(k)]
            h = s[i] - node.s
            predicted = self.follower.system.move(node.Q, h * node.rate)
            distance = np.linalg.norm(self.follower.system.step_between(predicted, Q[i]))
            inside[i] = distance <= self.follower.tube(node, np.asarray(h)) + ROUNDING and h <= self.follower.certified_step(node) * (
                1 + 1e-12
            )
        return inside

    def _near_fold(self, trace: Trace, s: float) -> FloatArray:
        """Return a guess between the last node and the dead point, on the node's side of it: s falls with the square of the arc."""
        node = trace.nodes[-1]
        share = 1.0 - math.sqrt(max(0.0, (trace.end - s) / (trace.end - node.s)))
        to_fold = self.follower.system.step_between(node.Q, trace.Q_end)
        return self.follower.system.move(node.Q, share * to_fold)
