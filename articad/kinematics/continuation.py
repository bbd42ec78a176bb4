"""Following a linkage while its drivers move, without changing to another branch.

Predictor and corrector with three guards: the step stays below half the smallest singular value, the orientation of the constraints does
not change, and the corrector is shorter than half the predictor. Where a step would be smaller than 1e-7, the driver has a dead point,
which is then located exactly, or the linkage is singular. Couplings are linear: what they connect needs no steps, and only freedoms that
move loops are followed (see `ties`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from articad.arrays import BoolArray, FloatArray
from articad.kinematics.factors import least_squares, right_singular, svd
from articad.kinematics.loops import CLOSED, RANK_TOLERANCE, ClosureSystem

_STEP_LIMIT = 0.35  # rad, or lengths L: largest change of any freedom in one step
_SIGMA_SHARE = 0.5  # share of σ_min that a step may take: beyond it another branch may be equally near
_CORRECTOR_SHARE = 0.5  # largest length of the corrector, as a share of the predictor's
ROUNDING = 1e-9  # rad, or lengths L: a shorter corrector says nothing about branches
_SMALLEST_STEP = 1e-7  # rad, or lengths L: below it the driver is at its dead point
_SINGULAR = 1e-6  # σ_min below which the branch is not determined
_FOLD_RATE = 100.0  # |dq/ds| that occurs only at a dead point; where branches cross it stays bounded
_MOST_STEPS = 20_000
_CERTIFIED_SHARE = 0.45  # limit of β K η; Kantorovich requires at most ½
_FIRST_ARC = 0.01  # rad, or lengths L: first step of the search for a dead point


class Stop(StrEnum):
    """Why a trace ended. STEPS is not a property of the linkage: the follower reached its largest number of steps.

    Neither is MULTIPLE: at a multiple root no singular value shows where a branch ends, so the linkage may well continue.
    """

    ARRIVED = "arrived"
    DEAD_POINT = "dead point"
    SINGULAR = "singular"
    STEPS = "not followed further"
    MULTIPLE = "not followed: the constraints have a multiple root"


class Node(NamedTuple):
    """A closed configuration on the path.

    Attributes:
        s: Parameter: how far the drivers have moved.
        Q: Coordinates `(columns,)`.
        rate: dy/ds of all freedoms, scaled.
        sigma: Smallest singular value of the constraints with respect to the dependent freedoms.
        bend: Bound of |second-order remainder| / h², as Kantorovich's theorem needs it for a step from here.
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
        stop: Why there are no more nodes.
        end: Parameter that was reached; for a dead point its exact place, a little beyond the last node.
        Q_end: Coordinates there.
        certified: True when each step satisfied the Kantorovich condition.
    """

    nodes: tuple[Node, ...]
    stop: Stop
    end: float
    Q_end: FloatArray
    certified: bool


class _Linear(NamedTuple):
    """The constraints linearised at one configuration, in the dependent freedoms."""

    J: FloatArray
    U: FloatArray
    s: FloatArray
    Vt: FloatArray


class Follower:
    """Follows one branch of a system along directions of its drivers.

    Args:
        system: The equations.
        dependent: Freedoms that follow; the others are drivers.
        simple: Whether the equations have a simple root in general position, so that a singular value shows where a branch ends.

    Attributes:
        basis: Independent motions of the dependent freedoms, without those coupled to a driver.
        rank: Number of these that the loops determine.
    """

    def __init__(self, system: ClosureSystem, dependent: BoolArray, *, simple: bool = True) -> None:
        self.system, self.dependent, self.simple = system, dependent, simple
        self.certifiable = simple and system.smooth_rows  # the bound of second derivatives holds for loops alone
        self.basis = system.ties.basis(dependent)
        self._c = max(
            (math.hypot(reach / length, 1.0) for reach, length in zip(_reaches(system), system.lengths, strict=True)), default=1.0
        )
        self.rank = self.basis.size
        self._looped = np.flatnonzero(system.in_loops)
        self._n_rows = system.n_loop_rows
        # (Σ|y|)² ≤ n |z|² for steps z of drivers and independent motions, y of all freedoms that move loops
        driven = int((self.basis.matrix[self._looped] == 0).all(axis=1).sum())
        self._n = max(1.0, driven + float((np.abs(self.basis.matrix[self._looped]).sum(axis=0) ** 2).sum()))

    def linearized(self, Q: FloatArray) -> _Linear:
        """Return the loops' Jacobian at Q and the singular values of it by the independent motions."""
        J = self.system.evaluate_one(Q)[1][: self._n_rows]
        return _Linear(J, *svd(self.basis.of(J)))

    def start(self, Q: FloatArray) -> None:
        """Set how many of the dependent freedoms the constraints determine; idle ones move as little as possible."""
        s = self.linearized(Q).s
        self.rank = int((s > RANK_TOLERANCE * s[0]).sum()) if s.size else 0

    def node(self, s: float, Q: FloatArray, lin: _Linear, direction: FloatArray) -> Node:
        """Return the node at Q: the rate of the dependent freedoms follows from the linearised constraints."""
        rate = direction.copy()
        k = self.rank
        if k:
            inverse = np.where(lin.s[:k] > 0, 1.0 / np.maximum(lin.s[:k], 1e-300), 0.0)
            rate -= self.basis.step(lin.Vt[:k].T @ (inverse * (lin.U[:, :k].T @ (lin.J @ direction))))
        sigma = float(lin.s[k - 1]) if k else math.inf
        bend = 0.5 * float(np.abs(rate[self._looped]).sum()) ** 2 * self._c
        return Node(s, Q, rate, sigma, bend)

    def trace(self, Q: FloatArray, direction: FloatArray, length: float, *, certify: bool = False) -> Trace:
        """Follow the branch from the closed configuration Q while the drivers move by `direction · s`, s = 0 … length.

        Args:
            Q: Closed coordinates `(columns,)`.
            direction: Scaled velocities of the drivers and of what is coupled to them `(freedoms,)`, zero for all others.
            length: Value of s at which to stop, > 0.
            certify: Take steps for which Kantorovich's theorem proves exactly one solution near the predictor.

        Returns:
            The nodes and why they end.
        """
        certify = certify and self.certifiable
        lin = self.linearized(Q)
        node = self.node(0.0, Q, lin, direction)
        nodes, basis, sign, h = [node], lin.U[:, : self.rank], 0.0, length
        for _ in range(_MOST_STEPS):
            if node.s >= length:
                return Trace(tuple(nodes), Stop.ARRIVED, length, node.Q, certify)
            # step: at most twice the last, and small against the distance to a singular configuration (σ of the constraints)
            fastest = self._fastest(node.rate)
            if node.sigma < _SINGULAR:
                return self._stopped(nodes, direction, certify=certify)
            h = min(2.0 * h, length - node.s, min(_STEP_LIMIT, _SIGMA_SHARE * node.sigma) / fastest)
            if certify:
                h = min(h, self.certified_step(node))
            # predict along the tangent, correct by Newton; halve the step until the corrector stays near the prediction
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
        return Trace(tuple(nodes), Stop.STEPS, node.s, node.Q, certify)

    def _fastest(self, rate: FloatArray) -> float:
        """Return the largest rate of a freedom that moves a loop; without loops nothing limits a step."""
        return max(float(np.abs(rate[self._looped]).max(initial=0.0)), 1e-300)

    def certified_step(self, node: Node) -> float:
        """Return the largest step from the node with β K η ≤ 0.45 (Kantorovich), β = 1/σ, K = n c, η = β bend h²."""
        return math.sqrt(_CERTIFIED_SHARE * node.sigma**2 / (self._n * self._c * max(node.bend, 1e-300)))

    def tube(self, node: Node, h: FloatArray) -> FloatArray:
        """Return the largest distance of the only solution from the predictor of a step h: 2η [rad, lengths L]."""
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
        correction = float(np.abs(self.system.step_between(predicted, closed.Q)[self._looped]).max(initial=0.0))
        if correction > _CORRECTOR_SHARE * h * self._fastest(node.rate) + ROUNDING:
            return None
        lin = self.linearized(closed.Q)
        U, turned = self._orientation(basis, lin)
        if sign * turned < 0:
            return None
        return self.node(node.s + h, closed.Q, lin, direction), U, turned or sign

    def _orientation(self, basis: FloatArray, lin: _Linear) -> tuple[FloatArray, float]:
        """Return the constraints' basis, transported from the last one, and the sign of their determinant in it (0: undefined)."""
        k = self.rank
        U = lin.U[:, :k].copy()
        if not k or k < self.basis.size or not self.system.smooth_rows:
            return U, 0.0
        if np.linalg.det(basis.T @ U) < 0:
            U[:, 0] *= -1.0
        return U, float(np.sign(np.linalg.det(U.T @ self.basis.of(lin.J))))

    # --- dead points

    def _stopped(self, nodes: list[Node], direction: FloatArray, *, certify: bool) -> Trace:
        node = nodes[-1]
        if not self.simple:
            return Trace(tuple(nodes), Stop.MULTIPLE, node.s, node.Q, certify)
        if self._fastest(node.rate) > _FOLD_RATE * self._fastest(direction):
            fold = self._fold(node, direction)
            if fold is not None:
                s, Q = fold
                return Trace(tuple(nodes), Stop.DEAD_POINT, s, Q, certify)
        return Trace(tuple(nodes), Stop.SINGULAR, node.s, node.Q, certify)

    def _fold(self, node: Node, direction: FloatArray) -> tuple[float, FloatArray] | None:
        """Return where the driver turns back: there its component of the curve's tangent is zero (secant method on arc length)."""
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
        """Return the unit null vector of the constraints in (dependents, s), oriented along `orientation` or towards increasing s."""
        J = self.system.evaluate_one(Q)[1][: self._n_rows]
        s, Vt = right_singular(np.column_stack([self.basis.of(J), J @ direction]))
        if self.rank < self.basis.size or not s.size:
            return None
        tangent: FloatArray = Vt[-1]
        towards = tangent[-1] if orientation is None else tangent @ orientation
        return -tangent if towards < 0 else tangent

    def along_arc(self, node: Node, direction: FloatArray, tangent: FloatArray, arc: float) -> tuple[float, FloatArray, FloatArray] | None:
        """Return s, Q and the tangent at an arc length from a node; drivers and dependent freedoms are corrected together."""
        s = node.s + arc * tangent[-1]
        Q = self.system.move(node.Q, direction * (s - node.s) + self.basis.step(arc * tangent[:-1]))
        for _ in range(12):
            r, J = (part[: self._n_rows] for part in self.system.evaluate_one(Q))
            step = -least_squares(np.column_stack([self.basis.of(J), J @ direction]), r, RANK_TOLERANCE)
            Q, s = self.system.move(Q, direction * step[-1] + self.basis.step(step[:-1])), s + float(step[-1])
            if np.abs(step).max() < 1e-13:
                break
        if np.sqrt((self.system.residual_one(Q)[: self._n_rows] ** 2).sum()) > CLOSED:
            return None
        here = self._tangent(Q, direction, tangent)
        return None if here is None else (s, Q, here)

    # --- many at once

    def trace_many(self, Q: FloatArray, displacement: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Follow the branch from closed configurations to many driver values at once, each along its own straight line.

        Args:
            Q: Closed coordinates `(columns,)`, or one start per line `(batch, columns)`.
            displacement: Scaled displacement of the drivers and of what is coupled to them `(batch, freedoms)`.

        Returns:
            Coordinates `(batch, columns)`, and which of them arrived; the rest met a dead point or a singularity.
        """
        batch = len(displacement)
        at = np.array(np.broadcast_to(Q, (batch, self.system.layout.n_columns)))
        s, h = np.zeros(batch), np.full(batch, 0.25)
        failed = np.zeros(batch, dtype=bool)
        for _ in range(400):
            run = np.flatnonzero((s < 1.0) & ~failed)
            if not run.size:
                break
            # rates of the dependent freedoms from J_dep · rate = −J D, and the step that they and σ allow
            D = displacement[run]
            J = self.system.evaluate(at[run])[1][:, : self._n_rows]
            sigma, rate = self._rates(self.basis.of(J), (J @ D[..., None])[..., 0], D)
            fastest = np.maximum(np.abs(rate[:, self._looped]).max(axis=1, initial=0.0), 1e-300)
            limit = np.minimum(_STEP_LIMIT, _SIGMA_SHARE * sigma) / fastest
            step = np.minimum(np.minimum(2.0 * h[run], limit), 1.0 - s[run])
            # predictor and corrector; a row is accepted if it closes and its correction is a small share of its step
            predicted = self.system.move(at[run], step[:, None] * rate)
            closed, norm = self.system.close_many(predicted, self.dependent, iterations=6)
            correction = np.abs(self.system.step_between(predicted, closed)[:, self._looped]).max(axis=1, initial=0.0)
            good = (norm <= CLOSED) & (correction <= _CORRECTOR_SHARE * step * fastest + ROUNDING)
            at[run[good]] = closed[good]
            s[run[good]] = np.where(step[good] >= 1.0 - s[run[good]], 1.0, s[run[good]] + step[good])
            h[run] = np.where(good, step, 0.25 * step)
            failed[run] |= (~good & (step * fastest < _SMALLEST_STEP)) | (sigma < _SINGULAR)
        return at, s >= 1.0

    def _rates(self, J_dep: FloatArray, driven: FloatArray, D: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return σ_min `(batch,)` and dy/ds `(batch, freedoms)`."""
        rate = D.copy()
        if not self.basis.size:
            return np.full(len(D), math.inf), rate
        U, s, Vt = svd(J_dep)
        k = self.rank
        b = (U.swapaxes(-1, -2) @ driven[..., None])[:, :k, 0] / np.maximum(s[:, :k], 1e-300)
        rate -= self.basis.step((Vt[:, :k].swapaxes(-1, -2) @ b[..., None])[..., 0])
        sigma: FloatArray = s[:, k - 1] if k else np.full(len(D), math.inf)
        return sigma, rate


def _reaches(system: ClosureSystem) -> list[float]:
    """Return for each loop an upper bound [mm] of the distance between any two of its points: the sum of its links and travels."""
    reaches = []
    for loop in system.loops:
        ends: dict[str, list[FloatArray]] = {}
        for joint in loop.joints:
            ends.setdefault(joint.parent, []).append(joint.T_parent_connector.translation)
            ends.setdefault(joint.child, []).append(joint.T_child_connector.translation)
        links = sum(float(np.linalg.norm(points[0] - points[-1])) for points in ends.values())
        reaches.append(links + sum(abs(c.rest) for joint in loop.joints for c in joint.columns if c.unit == "mm"))
    return reaches
