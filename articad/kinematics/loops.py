"""Closed loops and couplings as equations, and the solver that closes them.

A loop joint gets a ghost of its child: the loop is closed where the ghost A = T_parent · C_p · J(q) · F meets the real
connector B = T_child · C_c. With M = A⁻¹B the residual is [t(M)/L ; log R(M)] for a characteristic length L, so every joint
type closes by the same code, and loop joints have coordinates, limits and drivers like all others. A coupling is a row
q_b − k q_a − c. Lengths are divided by L throughout: results are the same in mm, m and km.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from articad.arrays import BoolArray, FloatArray, IndexArray
from articad.connectors import SE3
from articad.errors import KinematicsError
from articad.kinematics.batch import TreeArrays
from articad.kinematics.equations import BatchEquations, closures
from articad.kinematics.factors import one_thread, singular_values, svd
from articad.kinematics.forward import MOST_FREEDOMS, LoopModel
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.ties import Basis, Ties
from articad.kinematics.tree import KinematicTree

CLOSED = 1e-10  # |t|/L and rad: a loop with a smaller residual is closed
RESIDUAL_TARGET = 1e-12  # the iteration stops here, before one more polishing step
_ROUNDING = 1e-15  # |r| that no step improves
RANK_TOLERANCE = 1e-7  # σ/σ₁ below which a constraint does not count: rounding gives 1e-12, a real constraint 1e-5
_DROPPED = 1e-10  # σ/σ₁ below which a direction is left out of a step
_LARGEST_STEP = 0.5  # rad, or lengths L: the linear model is not valid beyond
_DAMPING_FALL, _DAMPING_RISE = 0.2, 8.0  # after a step that helped, and after one that did not
_DAMPING_START = 1e-3
_COINCIDENT = 1e-4  # of the longest link
_FALLBACK_LENGTH = 100.0  # mm, if no part has two separate connectors


class Closed(NamedTuple):
    """The result of an iteration.

    Attributes:
        Q: Coordinates `(n_columns,)`.
        residual: |r|.
        iterations: Linear systems solved.
        J: Jacobian of the residuals by the free freedoms, scaled, `(rows, free)`.
    """

    Q: FloatArray
    residual: float
    iterations: int
    J: FloatArray

    @property
    def ok(self) -> bool:
        """True when every loop is closed."""
        return self.residual <= CLOSED

    @property
    def rank(self) -> int:
        """Number of independent constraints on the free freedoms."""
        s = singular_values(self.J)
        return int((s > RANK_TOLERANCE * s.max(initial=0.0)).sum())


@dataclass(frozen=True)
class Loop:
    """A loop joint and the rest of its loop.

    Attributes:
        joint: The joint that closes the loop.
        parts: Along the tree from the joint's parent to its child.
        joints: Joints along these parts, with the closing one last.
    """

    joint: Joint
    parts: tuple[str, ...]
    joints: tuple[Joint, ...]

    def __str__(self) -> str:
        return "-".join(self.parts)


class ClosureSystem:
    """Equations of loops and couplings in the coordinates of the joints that take part.

    Only the parts that loops need are placed, and only joints that a constraint involves have coordinates here: other joints are held at
    rest, which does not affect any equation. Freedoms are scaled: a length counts in units of L. Every loop has its own L.

    Args:
        tree: The tree that carries all parts.
        layout: Layout of all joints of the mechanism.
        loop_joints: Joints that close loops.
        couplings: Relations between coordinates.

    Raises:
        KinematicsError: E_NONFINITE if distances between joints exceed the floating-point range.
    """

    smooth_rows = True  # a row is the same equation everywhere, so the orientation of all rows distinguishes branches

    def __init__(self, tree: KinematicTree, layout: Layout, loop_joints: Sequence[Joint], couplings: Sequence[Coupling]) -> None:
        self.couplings = tuple(couplings)
        coupled = {layout.coordinates[layout.column_of[name]].joint for c in couplings for name in (c.a, c.b)}
        looped = {joint.name for closing in loop_joints for joint in (closing, *tree.joints_between(closing.parent, closing.child))}
        self.layout = Layout([joint for joint in layout.joints if joint.name in coupled or joint.name in looped])
        self.columns = _places(layout.columns, self.layout.columns)  # of this system's columns among all
        self.freedoms = _places(layout.freedoms, self.layout.freedoms)
        placed = [part for joint in (*loop_joints, *self.layout.joints) for part in (joint.parent, joint.child)]
        subtree = _subtree(tree, placed, coupled | looped)
        self.parts = subtree.parts
        self.loops = tuple(_loop(subtree, joint) for joint in loop_joints)
        self.length = characteristic_length(self.layout.joints)
        self.lengths: FloatArray = np.array([characteristic_length(loop.joints) for loop in self.loops])  # L of each loop
        if not np.isfinite([self.length, *self.lengths]).all():
            raise KinematicsError("E_NONFINITE: the distances between joints exceed the floating-point range.")
        self.arrays = TreeArrays(subtree.parts, subtree, self.layout, SE3.identity(), loop_joints)
        self.scale: FloatArray = np.where(self.layout.is_length, self._travels(), 1.0)
        self._closures = closures(self.arrays, loop_joints, self.scale, self.lengths)
        self._many = BatchEquations(self._closures)
        self.in_loops: BoolArray = (np.concatenate([self._closures.spin, self._closures.slide]) != 0).any(axis=0)
        self.ties = Ties(self.couplings, self.layout, self.scale, self.length, self.in_loops)
        self.n_loop_rows = 6 * len(self.loops)
        self._linear = np.concatenate([np.zeros((self.n_loop_rows, self.layout.n_freedoms)), self.ties.J])
        self.n_rows = len(self._linear)
        self.active: BoolArray = self.in_loops | (self.ties.J != 0).any(axis=0)
        columns = range(self.layout.n_columns)
        self._written = np.array([c for c in columns if self.active[self.layout.freedom_of(c)]], dtype=np.intp)

    def _travels(self) -> FloatArray:
        """Return the length of each freedom: L of the smallest loop that it moves, or of the whole system."""
        lengths = np.full(self.layout.n_freedoms, math.inf)
        for loop, length in zip(self.loops, self.lengths, strict=True):
            for joint in loop.joints:
                own = self.layout.freedoms[joint.name]
                lengths[own] = np.minimum(lengths[own], length)
        return np.where(np.isfinite(lengths), lengths, self.length)

    @property
    def written(self) -> IndexArray:
        """Places, among the columns of all joints, of the coordinates that this system determines or is driven by."""
        return self.columns[self._written]

    @cached_property
    def _one(self) -> LoopModel | None:
        """The equations at one configuration by Pinocchio; None where nothing moves in a loop, or where the workspace is too large."""
        return LoopModel(self._closures) if self.loops and 0 < self.layout.n_freedoms <= MOST_FREEDOMS else None

    # --- equations

    @property
    def coupling_rows(self) -> FloatArray:
        """The last rows of the Jacobian, which are constant `(couplings, freedoms)`."""
        return self.ties.J

    def evaluate(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals `(batch, rows)` and their Jacobian `(batch, rows, freedoms)`, scaled, at `Q` `(batch, columns)`."""
        J = np.tile(self._linear, (len(Q), 1, 1))
        return np.concatenate([self._many.fill(Q, J), self.ties.residual(Q)], axis=1), J

    def residual(self, Q: FloatArray) -> FloatArray:
        """Return the residuals alone `(batch, rows)`."""
        return np.concatenate([self._many.residual(Q), self.ties.residual(Q)], axis=1)

    def evaluate_one(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals `(rows,)` and their Jacobian `(rows, freedoms)`, scaled, at one configuration `(columns,)`."""
        if self._one is None:
            r, J = self.evaluate(Q[None])
            return r[0], J[0]
        r, J = self._one.evaluate(Q)
        return (self._with_couplings(r, Q), np.concatenate([J, self.ties.J])) if self.couplings else (r, J)

    def residual_one(self, Q: FloatArray) -> FloatArray:
        """Return the residuals alone `(rows,)`."""
        return self.residual(Q[None])[0] if self._one is None else self._with_couplings(self._one.residual(Q), Q)

    def _with_couplings(self, loops: FloatArray, Q: FloatArray) -> FloatArray:
        return np.concatenate([loops, self.ties.residual(Q)]) if self.couplings else loops

    def gaps(self, Q: FloatArray) -> FloatArray:
        """Return the distance `(loops,)` [mm] between each ghost and its connector at `Q` `(columns,)`."""
        r = self.residual_one(Q)[: 6 * len(self.loops)].reshape(-1, 6)
        distance: FloatArray = np.linalg.norm(r[:, :3], axis=1) * self.lengths
        return distance

    def contradiction(self, Q: FloatArray) -> float:
        """Return the residual of couplings at `Q` `(columns,)` that no values of the coupled coordinates remove: their contradiction."""
        Q = self.ties.fitted(Q, np.zeros(self.layout.n_freedoms, dtype=bool))
        return float(self.ties.missed(Q))

    def move(self, Q: FloatArray, y: FloatArray) -> FloatArray:
        """Return coordinates after the scaled step `y` `(*batch, freedoms)`."""
        return self.layout.integrate(Q, y * self.scale)

    def step_between(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return the scaled step `(*batch, freedoms)` from `start` to `end`."""
        return self.layout.difference(start, end) / self.scale

    # --- closing

    def close(self, Q: FloatArray, free: BoolArray, *, iterations: int = 60, polish: bool = True) -> Closed:
        """Close all loops from a start, moving only the free freedoms; couplings hold exactly from the start.

        Levenberg–Marquardt on the manifold: y = −V diag(s/(s² + λ²)) Uᵀ r with λ = μ·min(1, |r|), which vanishes at a solution, so that
        convergence is quadratic; directions with σ < 1e-10 σ₁ are left out. Steps are taken in the independent motions that couplings
        leave (`Ties.basis`), so only the loops' equations are iterated.

        Args:
            Q: Start `(columns,)`.
            free: Freedoms that may move `(freedoms,)`.
            iterations: Largest number of linear systems to solve.
            polish: Whether to take one more step after the target, which brings the coordinates to rounding precision.

        Returns:
            The best coordinates found, and whether they close the loops.
        """
        with one_thread(self.n_rows * self.layout.n_freedoms):
            return self._closed(Q, free, iterations, polish=polish)

    def _closed(self, Q: FloatArray, free: BoolArray, iterations: int, *, polish: bool) -> Closed:
        Q, B = self.ties.fitted(Q, ~free), self.ties.basis(free)
        missed = float(self.ties.missed(Q))  # constant: every step obeys the couplings
        r, J = self._loops_at(Q)
        norm, mu = _norm(r), _DAMPING_START
        done = 0
        while norm > RESIDUAL_TARGET and done < iterations and B.size:
            U, s, Vt = svd(B.of(J))
            b = U.T @ r
            while done < iterations:
                done += 1
                trial = self.move(Q, B.step(damped_step(s, b, Vt, mu * min(1.0, norm))))
                r_trial, J_trial = self._loops_at(trial)
                norm_trial = _norm(r_trial)
                if norm_trial < norm:
                    Q, r, J, norm, mu = trial, r_trial, J_trial, norm_trial, mu * _DAMPING_FALL
                    break
                if norm < CLOSED or mu > 1e12:  # at the rounding floor, or at a minimum that is not a solution
                    return Closed(Q, norm + missed, done, J[:, free])
                mu *= _DAMPING_RISE
        if polish and B.size and _ROUNDING < norm <= CLOSED:
            Q, norm = self._polished(Q, r, J, B)
        return Closed(self.ties.fitted(Q, ~free), norm + missed, done, J[:, free])

    def _loops_at(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the residuals of the loops alone and their Jacobian."""
        if self._one is not None:
            return self._one.evaluate(Q)
        r, J = self.evaluate_one(Q)
        return r[: self.n_loop_rows], J[: self.n_loop_rows]

    def _polished(self, Q: FloatArray, r: FloatArray, J: FloatArray, B: Basis) -> tuple[FloatArray, float]:
        U, s, Vt = svd(B.of(J))
        trial = self.move(Q, B.step(damped_step(s, U.T @ r, Vt, 0.0, RANK_TOLERANCE)))
        norm, norm_trial = _norm(r), _norm(self.residual_one(trial)[: self.n_loop_rows])
        return (trial, norm_trial) if norm_trial <= max(norm, RESIDUAL_TARGET) else (Q, norm)

    def close_many(self, Q: FloatArray, free: BoolArray, *, iterations: int = 40) -> tuple[FloatArray, FloatArray]:
        """Close many starts at once, by normal equations: these are cheap in a batch, and iteration makes up for their rounding.

        Args:
            Q: Starts `(batch, columns)`.
            free: Freedoms that may move.
            iterations: Largest number of linear systems per start.

        Returns:
            The best coordinates `(batch, columns)` and their |r| `(batch,)`; rows not below `CLOSED` did not close.
        """
        with one_thread(self.n_rows * self.layout.n_freedoms):
            Q = self.ties.fitted(Q, ~free)
            missed = self.ties.missed(Q)
            closed, norm = self._closed_many(Q.copy(), self.ties.basis(free), iterations)
            return self.ties.fitted(closed, ~free), norm + missed

    def _closed_many(self, Q: FloatArray, B: Basis, iterations: int) -> tuple[FloatArray, FloatArray]:
        r, J = self._loops_of(Q)
        norm = np.sqrt((r * r).sum(axis=1))
        mu = np.full(len(Q), _DAMPING_START)
        floor = np.zeros(len(Q), dtype=bool)
        for _ in range(iterations if B.size else 0):
            at = np.flatnonzero((norm > RESIDUAL_TARGET) & ~floor)
            if not at.size:
                break
            y = B.step(_normal_step(B.of(J[at]), r[at], mu[at] * np.minimum(1.0, norm[at])))
            trial = self.move(Q[at], y)
            r_trial, J_trial = self._loops_of(trial)
            norm_trial = np.sqrt((r_trial * r_trial).sum(axis=1))
            better = norm_trial < norm[at]
            won, lost = at[better], at[~better]
            Q[won], r[won], J[won], norm[won] = trial[better], r_trial[better], J_trial[better], norm_trial[better]
            mu[won] *= _DAMPING_FALL
            mu[lost] *= _DAMPING_RISE
            floor[lost] |= (norm[lost] < CLOSED) | (mu[lost] > 1e12)
        at = np.flatnonzero((norm <= CLOSED) & (norm > 0))
        if at.size and B.size:  # the last system gives one more step, below the rounding of the residual
            Q[at] = self.move(Q[at], B.step(_normal_step(B.of(J[at]), r[at], np.zeros(at.size))))
        return Q, norm

    def _loops_of(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        r, J = self.evaluate(Q)
        return r[:, : self.n_loop_rows], J[:, : self.n_loop_rows]

    def to_system(self, Q_all: FloatArray) -> FloatArray:
        """Return this system's columns of the coordinates of all joints."""
        mine: FloatArray = Q_all[..., self.columns]
        return mine

    def into_all(self, Q_all: FloatArray, Q: FloatArray) -> FloatArray:
        """Return the coordinates of all joints with those that a constraint involves replaced; the others stay."""
        out = np.array(np.broadcast_to(Q_all, (*Q.shape[:-1], Q_all.shape[-1])))
        out[..., self.columns[self._written]] = Q[..., self._written]
        return out


def _norm(r: FloatArray) -> float:
    return math.sqrt(r @ r)


def damped_step(s: FloatArray, b: FloatArray, Vt: FloatArray, damping: float, dropped: float = _DROPPED) -> FloatArray:
    """Return −V diag(s/(s² + λ²)) b, without the directions that have no singular value, limited in length."""
    values, square = s.tolist(), damping * damping + 1e-300
    inverse = [-value / (value * value + square) if value > dropped * values[0] else 0.0 for value in values]
    y: FloatArray = (inverse * b) @ Vt
    largest = max(map(abs, y.tolist()), default=0.0)
    return y * (_LARGEST_STEP / largest) if largest > _LARGEST_STEP else y


def _normal_step(J: FloatArray, r: FloatArray, damping: FloatArray) -> FloatArray:
    """Return steps `(batch, n)` of the damped normal equations, limited in length."""
    Jt = J.swapaxes(-1, -2)
    H = Jt @ J
    k = H.shape[-1]
    # a freedom without effect must not make the system singular: 1e-14 of the trace is below the iteration's own error
    trace = np.trace(H, axis1=-2, axis2=-1)
    H[:, np.arange(k), np.arange(k)] += (damping * damping + 1e-14 * trace + 1e-300)[:, None]
    y = -np.linalg.solve(H, Jt @ r[..., None])[..., 0]
    largest = np.abs(y).max(axis=1, keepdims=True)
    capped: FloatArray = y * np.minimum(1.0, _LARGEST_STEP / np.maximum(largest, 1e-300))
    return capped


def _subtree(tree: KinematicTree, parts: Sequence[str], moving: set[str]) -> KinematicTree:
    """Return the tree that carries these parts, rooted at the nearest part that carries them all and is not moved.

    Joints on the way that are not in `moving` are held at rest: the relative pose of two connectors does not depend on them.
    """
    chains = [tree.ancestors(part) for part in dict.fromkeys(parts)]
    still = 0
    for edges in zip(*chains, strict=False):
        if len({edge.part for edge in edges}) > 1 or edges[0].joint.name in moving:
            break
        still += 1
    needed = {edge.part for chain in chains for edge in chain[still:]}
    root = chains[0][still - 1].part if still else tree.ground
    below = [edge for edge in tree.edges if edge.part in needed]
    return KinematicTree(root, [edge if edge.joint.name in moving else edge._replace(joint=_held(edge.joint)) for edge in below])


def _held(joint: Joint) -> Joint:
    """Return a fixed joint equal to a joint at rest."""
    T = joint.T_parent_connector @ joint.motion(joint.rest)
    return replace(joint, type=JointType.FIXED, T_parent_connector=T, limits=JointLimits(), rest=(), lead=0.0)


def _loop(tree: KinematicTree, joint: Joint) -> Loop:
    parts = tree.path(joint.parent, joint.child)
    return Loop(joint, parts, (*tree.joints_between(joint.parent, joint.child), joint))


def _places(all_slices: dict[str, slice], kept: dict[str, slice]) -> IndexArray:
    return np.array([i for name in kept for i in range(all_slices[name].start, all_slices[name].stop)], dtype=np.intp)


def characteristic_length(joints: Sequence[Joint]) -> float:
    """Return the median distance [mm] between connectors of one part; any length within a factor of 100 works as well."""
    origins: dict[str, list[FloatArray]] = {}
    for joint in joints:
        origins.setdefault(joint.parent, []).append(joint.T_parent_connector.translation)
        origins.setdefault(joint.child, []).append(joint.T_child_connector.translation)
    lengths = [float(np.linalg.norm(p - points[0])) for points in origins.values() for p in points[1:]]
    least = _COINCIDENT * max(lengths, default=0.0)  # connectors closer together are one place, up to rounding
    lengths = [length for length in lengths if length >= max(1e-6, least)]
    return float(np.median(lengths)) if lengths else _FALLBACK_LENGTH
