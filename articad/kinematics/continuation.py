"""Following a linkage while its drivers move, without ever changing to another branch.

Predictor and corrector with three guards (kinematics: continuation along a sweep): the step stays below half the smallest
singular value, the orientation of the constraints does not change, and the corrector is shorter than half the predictor.
Where a step would be smaller than 1e-7 the driver has a dead point, which is then found exactly, or the linkage is singular.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from articad.connectors import FloatArray
from articad.kinematics.factors import least_squares, right_singular, svd
from articad.kinematics.loops import CLOSED, RANK_TOLERANCE, BoolArray, ClosureSystem

_STEP_LIMIT = 0.35  # rad, or lengths L: of any freedom in one step
_SIGMA_SHARE = 0.5  # of σ_min that a step may take: beyond it another branch may be as near
_CORRECTOR_SHARE = 0.5  # of the predictor's length that the corrector may have
ROUNDING = 1e-9  # rad, or lengths L: a corrector this short says nothing about branches
_SMALLEST_STEP = 1e-7  # rad, or lengths L: below it the driver is at its dead point
_SINGULAR = 1e-6  # σ_min below which the branch is not determined
_FOLD_RATE = 100.0  # |dq/ds| that only a dead point has; where branches cross it stays bounded
_MOST_STEPS = 20_000
_CERTIFIED_SHARE = 0.45  # of β K η; Kantorovich needs at most ½
_FIRST_ARC = 0.01  # rad, or lengths L: first step of the search for a dead point


class Stop(StrEnum):
    """Why a trace ended."""

    ARRIVED = "arrived"
    DEAD_POINT = "dead point"
    SINGULAR = "singular"


class Node(NamedTuple):
    """A closed configuration on the way.

    Attributes:
        s: Parameter: how far the drivers have moved.
        Q: Coordinates `(columns,)`.
        rate: dy/ds of all freedoms, scaled.
        sigma: Smallest singular value of the constraints in the dependent freedoms.
        bend: Bound of |second-order remainder| / h²: what Kantorovich's theorem needs of a step from here.
    """

    s: float
    Q: FloatArray
    rate: FloatArray
    sigma: float
    bend: float


@dataclass(frozen=True)
class Trace:
    """Nodes from the start towards the end, and why they end.

    Attributes:
        nodes: In order of s; the first is the start.
        stop: Why there are no more.
        end: Parameter that was reached; of a dead point its exact place, a little beyond the last node.
        Q_end: Coordinates there.
        certified: True when each step satisfied the Kantorovich condition.
    """

    nodes: tuple[Node, ...]
    stop: Stop
    end: float
    Q_end: FloatArray
    certified: bool


class _Linear(NamedTuple):
    """The constraints at one configuration, in the dependent freedoms."""

    J: FloatArray
    U: FloatArray
    s: FloatArray
    Vt: FloatArray


class Follower:
    """Follows one branch of a system along directions of its drivers.

    Args:
        system: The equations.
        dependent: Freedoms that follow; the others are drivers.
    """

    def __init__(self, system: ClosureSystem, dependent: BoolArray) -> None:
        self.system, self.dependent = system, dependent
        self.where = np.flatnonzero(dependent)
        self.reach = _reach(system)
        self._c = math.hypot(self.reach / system.length, 1.0)
        self.rank = len(self.where)
        self._weight = _row_weights(system, self.where)
        self._longest = _STEP_LIMIT if system.loops else math.inf  # couplings alone are linear: one step arrives
        self._share = _SIGMA_SHARE if system.loops else math.inf

    def linearized(self, Q: FloatArray) -> _Linear:
        """Return the constraints' Jacobian at Q and the singular values of its dependent columns."""
        J = self.system.evaluate_one(Q)[1] * self._weight
        return _Linear(J, *svd(J[:, self.where]))

    def start(self, Q: FloatArray) -> None:
        """Set how many of the dependent freedoms the constraints determine; idle ones move as little as possible."""
        s = self.linearized(Q).s
        self.rank = int((s > RANK_TOLERANCE * s[0]).sum()) if s.size else 0

    def node(self, s: float, Q: FloatArray, lin: _Linear, direction: FloatArray) -> Node:
        """Return the node at Q: the rate of the dependents, from the constraints' linear part."""
        rate = direction.copy()
        k = self.rank
        if k:
            inverse = np.where(lin.s[:k] > 0, 1.0 / np.maximum(lin.s[:k], 1e-300), 0.0)
            rate[self.where] = -(lin.Vt[:k].T @ (inverse * (lin.U[:, :k].T @ (lin.J @ direction))))
        sigma = float(lin.s[k - 1]) if k else math.inf
        bend = 0.5 * float(np.abs(rate).sum()) ** 2 * self._c
        return Node(s, Q, rate, sigma, bend)

    def trace(self, Q: FloatArray, direction: FloatArray, length: float, *, certify: bool = False) -> Trace:
        """Follow the branch from the closed configuration Q while the drivers move by `direction · s`, s = 0 … length.

        Args:
            Q: Closed coordinates `(columns,)`.
            direction: Scaled velocities of the drivers `(freedoms,)`, zero for dependents.
            length: Where to arrive, > 0.
            certify: Take steps for which Kantorovich's theorem proves that there is one solution, near the predictor.

        Returns:
            The nodes and why they end.
        """
        lin = self.linearized(Q)
        node = self.node(0.0, Q, lin, direction)
        nodes, basis, sign, h = [node], lin.U[:, : self.rank], 0.0, length
        for _ in range(_MOST_STEPS):
            if node.s >= length:
                return Trace(tuple(nodes), Stop.ARRIVED, length, node.Q, certify)
            fastest = max(float(np.abs(node.rate).max()), 1e-300)
            if node.sigma < _SINGULAR:
                return self._stopped(nodes, direction, certify=certify)
            h = min(2.0 * h, length - node.s, min(self._longest, self._share * node.sigma) / fastest)
            if certify:
                h = min(h, self.certified_step(node))
            while h * fastest >= _SMALLEST_STEP or h >= length - node.s:
                stepped = self._step(node, h, direction, basis, sign, last=h >= length - node.s)
                if stepped is not None:
                    break
                h *= 0.5
            else:
                return self._stopped(nodes, direction, certify=certify)
            node, basis, sign = stepped
            if node.s + 1e-15 * length >= length:
                node = node._replace(s=length)
            nodes.append(node)
        return Trace(tuple(nodes), Stop.SINGULAR, node.s, node.Q, certify)

    def certified_step(self, node: Node) -> float:
        """Return the largest step from the node with β K η ≤ 0.45 (Kantorovich), β = 1/σ, K = n c, η = β bend h²."""
        n = max(1, self.system.layout.n_freedoms)
        return math.sqrt(_CERTIFIED_SHARE * node.sigma**2 / (n * self._c * max(node.bend, 1e-300)))

    def tube(self, node: Node, h: FloatArray) -> FloatArray:
        """Return how far the only solution may be from the predictor of a step h: 2η [rad, lengths L]."""
        radius: FloatArray = 2.0 * node.bend * h * h / node.sigma
        return radius

    def _step(
        self, node: Node, h: float, direction: FloatArray, basis: FloatArray, sign: float, *, last: bool
    ) -> tuple[Node, FloatArray, float] | None:
        """Return the next node with the transported orientation, or None if a guard refuses the step."""
        predicted = self.system.move(node.Q, h * node.rate)
        closed = self.system.close(predicted, self.dependent, iterations=8, polish=last)
        if not closed.ok:
            return None
        correction = float(np.abs(self.system.step_between(predicted, closed.Q)).max())
        if correction > _CORRECTOR_SHARE * h * float(np.abs(node.rate).max()) + ROUNDING:
            return None
        lin = self.linearized(closed.Q)
        U, turned = self._orientation(basis, lin)
        if sign * turned < 0:
            return None
        return self.node(node.s + h, closed.Q, lin, direction), U, turned or sign

    def _orientation(self, basis: FloatArray, lin: _Linear) -> tuple[FloatArray, float]:
        """Return the constraints' basis, carried along from the last one, and the sign of their determinant in it (0: none)."""
        k = self.rank
        U = lin.U[:, :k].copy()
        if not k or k < len(self.where):
            return U, 0.0
        if np.linalg.det(basis.T @ U) < 0:
            U[:, 0] *= -1.0
        return U, float(np.sign(np.linalg.det(U.T @ lin.J[:, self.where])))

    # --- dead points

    def _stopped(self, nodes: list[Node], direction: FloatArray, *, certify: bool) -> Trace:
        node = nodes[-1]
        if np.abs(node.rate).max() > _FOLD_RATE * max(np.abs(direction).max(), 1e-300):
            fold = self._fold(node, direction)
            if fold is not None:
                s, Q = fold
                return Trace(tuple(nodes), Stop.DEAD_POINT, s, Q, certify)
        return Trace(tuple(nodes), Stop.SINGULAR, node.s, node.Q, certify)

    def _fold(self, node: Node, direction: FloatArray) -> tuple[float, FloatArray] | None:
        """Return where the driver turns back: along the curve its share of the tangent is zero (secant on arc length)."""
        tangent = self._tangent(node.Q, direction, None)
        if tangent is None:
            return None
        a, fa = 0.0, float(tangent[-1])
        arc, best = _FIRST_ARC, None
        for _ in range(40):
            point = self.along_arc(node, direction, tangent, arc)
            if point is None:
                arc = 0.5 * (a + arc)
                continue
            s, Q, here = point
            f = float(here[-1])
            best = (s, Q)
            if abs(f) < 1e-12 or f == fa:
                break
            step = -f * (arc - a) / (f - fa)
            a, fa = arc, f
            arc += max(-0.2, min(0.2, step))
        return best

    def _tangent(self, Q: FloatArray, direction: FloatArray, orientation: FloatArray | None) -> FloatArray | None:
        """Return the unit null vector of the constraints in (dependents, s), oriented along `orientation` or towards growing s."""
        J = self.system.evaluate_one(Q)[1]
        s, Vt = right_singular(np.column_stack([J[:, self.where], J @ direction]))
        if self.rank < len(self.where) or not s.size:
            return None
        tangent: FloatArray = Vt[-1]
        towards = tangent[-1] if orientation is None else tangent @ orientation
        return -tangent if towards < 0 else tangent

    def along_arc(self, node: Node, direction: FloatArray, tangent: FloatArray, arc: float) -> tuple[float, FloatArray, FloatArray] | None:
        """Return s, Q and the tangent at an arc length from a node, drivers and dependents corrected together."""
        y, s = arc * tangent[:-1], node.s + arc * tangent[-1]
        full = direction * (s - node.s)
        full[self.where] = y
        Q = self.system.move(node.Q, full)
        for _ in range(12):
            r, J = self.system.evaluate_one(Q)
            columns = np.column_stack([J[:, self.where], J @ direction])
            step = -least_squares(columns, r, RANK_TOLERANCE)
            full = direction * step[-1]
            full[self.where] = step[:-1]
            Q, s = self.system.move(Q, full), s + float(step[-1])
            if np.abs(step).max() < 1e-13:
                break
        if np.sqrt((self.system.residual_one(Q) ** 2).sum()) > CLOSED:
            return None
        here = self._tangent(Q, direction, tangent)
        return None if here is None else (s, Q, here)

    # --- many at once

    def trace_many(self, Q: FloatArray, displacement: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Follow the branch from one closed configuration to many driver values at once, each along its own straight line.

        Args:
            Q: Closed coordinates `(columns,)`.
            displacement: Scaled displacement of the drivers `(batch, freedoms)`.

        Returns:
            Coordinates `(batch, columns)`, and which of them arrived; the rest met a dead point or a singularity.
        """
        batch = len(displacement)
        at = np.tile(Q, (batch, 1))
        s, h = np.zeros(batch), np.full(batch, 0.25)
        failed = np.zeros(batch, dtype=bool)
        for _ in range(400):
            run = np.flatnonzero((s < 1.0) & ~failed)
            if not run.size:
                break
            D = displacement[run]
            J = self.system.evaluate(at[run])[1] * self._weight
            J_dep = J[:, :, self.where]
            sigma, rate = self._rates(J_dep, (J @ D[..., None])[..., 0], D)
            fastest = np.maximum(np.abs(rate).max(axis=1), 1e-300)
            limit = np.minimum(self._longest, self._share * sigma) / fastest
            step = np.minimum(np.minimum(2.0 * h[run], limit), 1.0 - s[run])
            predicted = self.system.move(at[run], step[:, None] * rate)
            closed, norm = self.system.close_many(predicted, self.dependent, iterations=6)
            correction = np.abs(self.system.step_between(predicted, closed)).max(axis=1)
            good = (norm <= CLOSED) & (correction <= _CORRECTOR_SHARE * step * fastest + ROUNDING)
            at[run[good]] = closed[good]
            s[run[good]] = np.where(step[good] >= 1.0 - s[run[good]], 1.0, s[run[good]] + step[good])
            h[run] = np.where(good, step, 0.25 * step)
            failed[run] |= (~good & (step * fastest < _SMALLEST_STEP)) | (sigma < _SINGULAR)
        return at, s >= 1.0

    def _rates(self, J_dep: FloatArray, driven: FloatArray, D: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return σ_min `(batch,)` and dy/ds `(batch, freedoms)`."""
        rate = D.copy()
        if not len(self.where):
            return np.full(len(D), math.inf), rate
        U, s, Vt = svd(J_dep)
        k = self.rank
        b = (U.swapaxes(-1, -2) @ driven[..., None])[:, :k, 0] / np.maximum(s[:, :k], 1e-300)
        rate[:, self.where] = -(Vt[:, :k].swapaxes(-1, -2) @ b[..., None])[..., 0]
        sigma: FloatArray = s[:, k - 1]
        return sigma, rate


def _row_weights(system: ClosureSystem, where: npt.NDArray[np.intp]) -> FloatArray:
    """Return factors `(rows, 1)` that make the largest coefficient of a dependent freedom 1 in each coupling's row.

    A coupling is linear, so no branch is near however small its coefficient: a screw that turns 150 rad while its nut
    travels one length L would otherwise be followed in steps of a degree, or taken for singular.
    """
    weights = np.ones((system.n_rows, 1))
    largest = np.abs(system.coupling_rows[:, where]).max(axis=1, initial=0.0)
    weights[system.n_rows - len(largest) :, 0] = 1.0 / np.where(largest > 0, largest, 1.0)
    return weights


def _reach(system: ClosureSystem) -> float:
    """Return a bound [mm] of the distance between any two points of a loop: the sum of its links and travels."""
    longest = 0.0
    for loop in system.loops:
        ends: dict[str, list[FloatArray]] = {}
        for joint in loop.joints:
            ends.setdefault(joint.parent, []).append(joint.T_parent_connector.translation)
            ends.setdefault(joint.child, []).append(joint.T_child_connector.translation)
        links = sum(float(np.linalg.norm(points[0] - points[-1])) for points in ends.values())
        travels = sum(abs(c.rest) for joint in loop.joints for c in joint.columns if c.unit == "mm")
        longest = max(longest, links + travels)
    return longest
