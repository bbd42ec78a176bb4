"""Closed loops and couplings as equations, and the solver that closes them.

A loop joint gets a ghost of its child: the loop is closed where the ghost A = T_parent · C_p · J(q) · F meets the real
connector B = T_child · C_c. With M = A⁻¹B the residual is [t(M)/L ; log R(M)] for a characteristic length L, so every joint
type closes by the same code, and loop joints have coordinates, limits and drivers like all others. A coupling is a row
q_b − k q_a − c. Lengths are divided by L throughout: results are the same in mm, m and km (kinematics: closed loops).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from articad.connectors import SE3, FloatArray, quaternion
from articad.kinematics.batch import TreeArrays
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.layout import Layout
from articad.kinematics.tree import Edge, KinematicTree

BoolArray = npt.NDArray[np.bool_]
IndexArray = npt.NDArray[np.intp]

CLOSED = 1e-10  # |t|/L and rad: a loop with a smaller residual is closed
RESIDUAL_TARGET = 1e-12  # where the iteration stops, before one more polishing step
_ROUNDING = 1e-15  # |r| that no step improves
RANK_TOLERANCE = 1e-7  # σ/σ₁ of a constraint that is none: rounding leaves 1e-12, a real constraint 1e-5
_DROPPED = 1e-10  # σ/σ₁ below which a direction is left out of a step
_LARGEST_STEP = 0.5  # rad, or lengths L: the linear model is worth nothing beyond
_DAMPING_FALL, _DAMPING_RISE = 0.2, 8.0  # of a step that helped, and of one that did not
_DAMPING_START = 1e-3
_STRAIGHT = 1e-5  # rad: a mismatch so small that the square term of the logarithm's Jacobian is below rounding
_NEAR_PI = -0.9  # cos θ below which the logarithm is taken by quaternions instead of the sine
_FALLBACK_LENGTH = 100.0  # mm, where no part has two connectors apart


class Closed(NamedTuple):
    """What an iteration ended with.

    Attributes:
        Q: Coordinates `(n_columns,)`.
        residual: |r|.
        iterations: Linear systems solved.
        J: Jacobian of the residuals by the freedoms that could move, scaled, `(rows, free)`.
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
        """Independent constraints on the freedoms that could move."""
        s = np.linalg.svd(self.J, compute_uv=False)
        return int((s > RANK_TOLERANCE * s.max(initial=0.0)).sum())


@dataclass(frozen=True)
class Loop:
    """A loop joint and the way round.

    Attributes:
        joint: Which closes the loop.
        parts: Along the tree from the joint's parent to its child.
        joints: Of the way, and the closing one last.
    """

    joint: Joint
    parts: tuple[str, ...]
    joints: tuple[Joint, ...]

    def __str__(self) -> str:
        return "-".join(self.parts)


class ClosureSystem:
    """Equations of loops and couplings in the coordinates of the joints that take part.

    Only the parts that loops need are placed. Freedoms are scaled: a length counts in units of L.

    Args:
        tree: Which carries all parts.
        layout: Of all joints of the mechanism.
        loop_joints: Joints that close loops.
        couplings: Relations between coordinates.
    """

    def __init__(self, tree: KinematicTree, layout: Layout, loop_joints: Sequence[Joint], couplings: Sequence[Coupling]) -> None:
        self.couplings = tuple(couplings)
        coupled = {layout.coordinates[layout.column_of[name]].joint for c in couplings for name in (c.a, c.b)}
        tied = [joint for joint in layout.joints if joint.name in coupled]
        edges = _edges_below(tree, [part for joint in (*loop_joints, *tied) for part in (joint.parent, joint.child)])
        kept = {edge.joint.name for edge in edges} | {joint.name for joint in loop_joints}
        self.layout = Layout([joint for joint in layout.joints if joint.name in kept])
        self.columns = _places(layout.columns, self.layout.columns)  # of this system's columns among all
        self.freedoms = _places(layout.freedoms, self.layout.freedoms)
        subtree = KinematicTree(tree.ground, edges)
        self.parts = subtree.parts
        self.loops = tuple(_loop(subtree, joint) for joint in loop_joints)
        self.length = _characteristic_length(self.layout.joints)
        self.arrays = TreeArrays(subtree.parts, subtree, self.layout, SE3.identity(), loop_joints)
        self.scale: FloatArray = np.where(self.layout.is_length, self.length, 1.0)
        self._compile_loops(subtree, loop_joints)
        self._compile_couplings()
        self.n_rows = 6 * len(self.loops) + len(self.couplings)
        self.active: BoolArray = (self._sides != 0).any(axis=0) | (self._coupling_rows != 0).any(axis=0)

    def _compile_loops(self, tree: KinematicTree, loop_joints: Sequence[Joint]) -> None:
        index = {part: i for i, part in enumerate(tree.parts)}
        self._far = np.array([index[joint.child] for joint in loop_joints], dtype=np.intp)
        near = np.array([index[joint.parent] for joint in loop_joints], dtype=np.intp)
        self._C_c = np.array([joint.T_child_connector.matrix for joint in (*loop_joints, *loop_joints)]).reshape(-1, 1, 4, 4)
        sides = self.arrays.carried[self._far] - self.arrays.carried[near]
        for row, joint in zip(sides, loop_joints, strict=True):
            row[self.layout.freedoms[joint.name]] = -1.0
        self._sides: FloatArray = sides.reshape(len(loop_joints), self.layout.n_freedoms)
        # what a freedom's axis, and its moment about B, count in the residual: (loops, 1, freedoms, 1)
        weight = (self._sides * self.scale)[:, None, :, None]
        angular, linear = (part[:, 0, 0][:, None] for part in (self.arrays.twists.angular, self.arrays.twists.linear))
        self._spin_weight: FloatArray = weight * angular
        self._turn_weight: FloatArray = self._spin_weight / self.length
        self._slide_weight: FloatArray = weight * linear / self.length

    def _compile_couplings(self) -> None:
        n = len(self.couplings)
        self._coupling_rows = np.zeros((n, self.layout.n_freedoms))  # per unscaled freedom
        self._coupling_columns = np.zeros((n, self.layout.n_columns))
        self._coupling_offset = np.array([c.offset for c in self.couplings])
        self._coupling_unit = np.ones(n)
        for i, c in enumerate(self.couplings):
            a, b = self.layout.column_of[c.a], self.layout.column_of[c.b]
            self._coupling_columns[i, b], self._coupling_columns[i, a] = 1.0, -c.ratio
            self._coupling_rows[i, self.layout.freedom_of(b)], self._coupling_rows[i, self.layout.freedom_of(a)] = 1.0, -c.ratio
            if self.layout.coordinates[b].unit == "mm":
                self._coupling_unit[i] = self.length
        self._coupling_jacobian = self._coupling_rows * self.scale / self._coupling_unit[:, None]

    # --- equations

    def evaluate(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals `(batch, rows)` and their Jacobian `(batch, rows, freedoms)`, scaled, at `Q` `(batch, columns)`."""
        batch, n, loops = len(Q), self.layout.n_freedoms, len(self.loops)
        r, J = np.empty((batch, self.n_rows)), np.empty((batch, self.n_rows, n))
        if loops:
            T = self.arrays.matrices(Q)
            R_A, p_B, t, phi = self._mismatch(T)
            axes, origins = (part.swapaxes(0, 1) for part in self.arrays.twists.axes(T, Q))  # (batch, freedoms, 3)
            moments = quaternion.cross(axes, p_B[:, :, None, :] - origins)
            lin = (moments * self._turn_weight + axes * self._slide_weight) @ R_A
            ang = (axes * self._spin_weight) @ (R_A @ _log_jacobian(phi))
            blocks = J[:, : 6 * loops].reshape(batch, loops, 6, n)
            blocks[:, :, :3], blocks[:, :, 3:] = lin.transpose(1, 0, 3, 2), ang.transpose(1, 0, 3, 2)
            self._fill_mismatch(r, t, phi)
        if self.couplings:
            r[:, 6 * loops :] = self._coupling_residual(Q)
            J[:, 6 * loops :] = self._coupling_jacobian
        return r, J

    def residual(self, Q: FloatArray) -> FloatArray:
        """Return the residuals alone `(batch, rows)`."""
        r = np.empty((len(Q), self.n_rows))
        if self.loops:
            _, _, t, phi = self._mismatch(self.arrays.matrices(Q))
            self._fill_mismatch(r, t, phi)
        if self.couplings:
            r[:, 6 * len(self.loops) :] = self._coupling_residual(Q)
        return r

    def _mismatch(self, T: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return R_A, the point of B, and M = A⁻¹B as translation and rotation vector; all `(loops, batch, …)`."""
        both = np.concatenate([T[self.arrays.n_parts :], T[self._far]]) @ self._C_c
        A, B = both[: len(self.loops)], both[len(self.loops) :]
        R_A, p_B = A[..., :3, :3], B[..., :3, 3]
        t = ((p_B - A[..., :3, 3])[..., None, :] @ R_A)[..., 0, :]
        return R_A, p_B, t, _rotation_log(R_A.swapaxes(-1, -2) @ B[..., :3, :3])

    def _fill_mismatch(self, r: FloatArray, t: FloatArray, phi: FloatArray) -> None:
        blocks = r[:, : 6 * len(self.loops)].reshape(len(r), len(self.loops), 6)
        blocks[..., :3], blocks[..., 3:] = (t / self.length).swapaxes(0, 1), phi.swapaxes(0, 1)

    def _coupling_residual(self, Q: FloatArray) -> FloatArray:
        residual: FloatArray = (Q @ self._coupling_columns.T - self._coupling_offset) / self._coupling_unit
        return residual

    def gaps(self, Q: FloatArray) -> FloatArray:
        """Return the distance `(loops,)` [mm] between each ghost and its connector at `Q` `(columns,)`."""
        r = self.residual(Q[None])[0, : 6 * len(self.loops)].reshape(-1, 6)
        distance: FloatArray = np.linalg.norm(r[:, :3], axis=1) * self.length
        return distance

    def move(self, Q: FloatArray, y: FloatArray) -> FloatArray:
        """Return coordinates after the scaled step `y` `(*batch, freedoms)`."""
        return self.layout.integrate(Q, y * self.scale)

    def step_between(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return the scaled step `(*batch, freedoms)` from `start` to `end`."""
        return self.layout.difference(start, end) / self.scale

    # --- closing

    def close(self, Q: FloatArray, free: BoolArray, *, iterations: int = 60, polish: bool = True) -> Closed:
        """Close all loops from a start, moving only the free freedoms.

        Levenberg–Marquardt on the manifold: y = −V diag(s/(s² + λ²)) Uᵀ r with λ = μ·min(1, |r|), which vanishes at a
        solution, so that convergence is quadratic; directions with σ < 1e-10 σ₁ are left out.

        Args:
            Q: Start `(columns,)`.
            free: Freedoms that may move `(freedoms,)`.
            iterations: Linear systems to solve at most.
            polish: Whether to take one more step after the target, which brings the coordinates to rounding.

        Returns:
            The best coordinates found, and whether they close.
        """
        where = np.flatnonzero(free)
        r, J = (part[0] for part in self.evaluate(Q[None]))
        norm, mu, y = _norm(r), _DAMPING_START, np.zeros(self.layout.n_freedoms)
        done = 0
        while norm > RESIDUAL_TARGET and done < iterations and where.size:
            U, s, Vt = np.linalg.svd(J[:, where], full_matrices=False)
            b = U.T @ r
            while done < iterations:
                done += 1
                y[where] = _damped_step(s, b, Vt, mu * min(1.0, norm))
                trial = self.move(Q, y)
                r_trial, J_trial = (part[0] for part in self.evaluate(trial[None]))
                norm_trial = _norm(r_trial)
                if norm_trial < norm:
                    Q, r, J, norm, mu = trial, r_trial, J_trial, norm_trial, mu * _DAMPING_FALL
                    break
                if norm < CLOSED or mu > 1e12:  # at the rounding floor, or at a minimum that is no solution
                    return Closed(Q, norm, done, J[:, where])
                mu *= _DAMPING_RISE
        if polish and where.size and _ROUNDING < norm <= CLOSED:
            Q, norm = self._polished(Q, r, J, where)
        return Closed(Q, norm, done, J[:, where])

    def _polished(self, Q: FloatArray, r: FloatArray, J: FloatArray, where: IndexArray) -> tuple[FloatArray, float]:
        y = np.zeros(self.layout.n_freedoms)
        U, s, Vt = np.linalg.svd(J[:, where], full_matrices=False)
        y[where] = _damped_step(s, U.T @ r, Vt, 0.0, RANK_TOLERANCE)
        trial = self.move(Q, y)
        norm, norm_trial = _norm(r), _norm(self.residual(trial[None])[0])
        return (trial, norm_trial) if norm_trial <= max(norm, RESIDUAL_TARGET) else (Q, norm)

    def close_many(self, Q: FloatArray, free: BoolArray, *, iterations: int = 40) -> tuple[FloatArray, FloatArray]:
        """Close many starts at once; normal equations, which are cheap in a batch and repaired by iterating.

        Args:
            Q: Starts `(batch, columns)`.
            free: Freedoms that may move.
            iterations: Linear systems per start at most.

        Returns:
            The best coordinates `(batch, columns)` and their |r| `(batch,)`; what is not below `CLOSED` did not close.
        """
        where = np.flatnonzero(free)
        Q = Q.copy()
        r, J = self.evaluate(Q)
        norm = np.sqrt((r * r).sum(axis=1))
        mu = np.full(len(Q), _DAMPING_START)
        floor = np.zeros(len(Q), dtype=bool)
        for _ in range(iterations if where.size else 0):
            at = np.flatnonzero((norm > RESIDUAL_TARGET) & ~floor)
            if not at.size:
                break
            y = np.zeros((at.size, self.layout.n_freedoms))
            y[:, where] = _normal_step(J[at][:, :, where], r[at], mu[at] * np.minimum(1.0, norm[at]))
            trial = self.move(Q[at], y)
            r_trial, J_trial = self.evaluate(trial)
            norm_trial = np.sqrt((r_trial * r_trial).sum(axis=1))
            better = norm_trial < norm[at]
            won, lost = at[better], at[~better]
            Q[won], r[won], J[won], norm[won] = trial[better], r_trial[better], J_trial[better], norm_trial[better]
            mu[won] *= _DAMPING_FALL
            mu[lost] *= _DAMPING_RISE
            floor[lost] |= (norm[lost] < CLOSED) | (mu[lost] > 1e12)
        at = np.flatnonzero((norm <= CLOSED) & (norm > 0))
        if at.size and where.size:  # the last system gives one more step, below the rounding of the residual
            y = np.zeros((at.size, self.layout.n_freedoms))
            y[:, where] = _normal_step(J[at][:, :, where], r[at], np.zeros(at.size))
            Q[at] = self.move(Q[at], y)
        return Q, norm

    def to_system(self, Q_all: FloatArray) -> FloatArray:
        """Return this system's columns of the coordinates of all joints."""
        mine: FloatArray = Q_all[..., self.columns]
        return mine

    def into_all(self, Q_all: FloatArray, Q: FloatArray) -> FloatArray:
        """Return the coordinates of all joints with this system's columns replaced."""
        out = np.array(np.broadcast_to(Q_all, (*Q.shape[:-1], Q_all.shape[-1])))
        out[..., self.columns] = Q
        return out


def _norm(r: FloatArray) -> float:
    return float(np.sqrt(r @ r))


def _damped_step(s: FloatArray, b: FloatArray, Vt: FloatArray, damping: float, dropped: float = _DROPPED) -> FloatArray:
    """Return −V diag(s/(s² + λ²)) b, without the directions that have no singular value, capped in length."""
    inverse = s / (s * s + (damping * damping + 1e-300))
    inverse[s <= dropped * s[0]] = 0.0
    y: FloatArray = -((inverse * b) @ Vt)
    largest = np.abs(y).max(initial=0.0)
    return y * (_LARGEST_STEP / largest) if largest > _LARGEST_STEP else y


def _normal_step(J: FloatArray, r: FloatArray, damping: FloatArray) -> FloatArray:
    """Return steps `(batch, n)` of the damped normal equations, capped in length."""
    Jt = J.swapaxes(-1, -2)
    H = Jt @ J
    k = H.shape[-1]
    # a freedom that moves nothing must not make the system singular: 1e-14 of the trace is below the iteration's own error
    trace = np.trace(H, axis1=-2, axis2=-1)
    H[:, np.arange(k), np.arange(k)] += (damping * damping + 1e-14 * trace + 1e-300)[:, None]
    y = -np.linalg.solve(H, Jt @ r[..., None])[..., 0]
    largest = np.abs(y).max(axis=1, keepdims=True)
    capped: FloatArray = y * np.minimum(1.0, _LARGEST_STEP / np.maximum(largest, 1e-300))
    return capped


def _edges_below(tree: KinematicTree, parts: Sequence[str]) -> list[Edge]:
    """Return the edges between the ground and these parts."""
    needed: dict[str, Edge] = {}
    for part in dict.fromkeys(parts):
        for edge in tree.ancestors(part):
            needed[edge.part] = edge
    return [edge for edge in tree.edges if edge.part in needed]


def _loop(tree: KinematicTree, joint: Joint) -> Loop:
    parts = tree.path(joint.parent, joint.child)
    return Loop(joint, parts, (*tree.joints_between(joint.parent, joint.child), joint))


def _places(all_slices: dict[str, slice], kept: dict[str, slice]) -> IndexArray:
    return np.array([i for name in kept for i in range(all_slices[name].start, all_slices[name].stop)], dtype=np.intp)


def _characteristic_length(joints: Sequence[Joint]) -> float:
    """Return the median distance [mm] between connectors of one part; any length within a factor of 100 does as well."""
    origins: dict[str, list[FloatArray]] = {}
    for joint in joints:
        origins.setdefault(joint.parent, []).append(joint.T_parent_connector.translation)
        origins.setdefault(joint.child, []).append(joint.T_child_connector.translation)
    lengths = [float(np.linalg.norm(p - points[0])) for points in origins.values() for p in points[1:]]
    lengths = [length for length in lengths if length > 1e-6]
    return float(np.median(lengths)) if lengths else _FALLBACK_LENGTH


def _rotation_log(R: FloatArray) -> FloatArray:
    """Return rotation vectors `(*batch, 3)` of matrices: by the sine where that is accurate, which is where loops are closed."""
    parts = R.reshape(*R.shape[:-2], 9) @ _SINE_AND_TRACE
    cosine = 0.5 * parts[..., 3] - 0.5
    if cosine.size and cosine.min() < _NEAR_PI:
        return quaternion.log(quaternion.from_matrix(R))
    axis = parts[..., :3]
    sine = np.sqrt((axis * axis).sum(axis=-1)) + 1e-300  # never zero, and never seen
    phi: FloatArray = axis * (np.arctan2(sine, cosine) / sine)[..., None]
    return phi


def _log_jacobian(phi: FloatArray) -> FloatArray:
    """Return what a row of spin is multiplied with to give the rate of the rotation vector: (I − ½[φ] + c [φ]²)ᵀ."""
    S = _crossing(phi)
    J: FloatArray = _EYE + 0.5 * S
    if np.abs(phi).max(initial=0.0) > _STRAIGHT:
        J += quaternion.inverse_coefficient(phi)[..., None] * (S @ S)
    return J


def _crossing(d: FloatArray) -> FloatArray:
    """Return the matrices with a @ crossing(d) = a × d for rows a."""
    return (d @ _EPSILON).reshape(*d.shape[:-1], 3, 3)


_EYE = np.eye(3)
_EPSILON = np.zeros((3, 9))  # (a × d)ⱼ = εⱼᵢₖ aᵢ dₖ
for _k, _ij, _sign in ((0, 5, 1), (0, 7, -1), (1, 6, 1), (1, 2, -1), (2, 1, 1), (2, 3, -1)):
    _EPSILON[_k, _ij] = -_sign
_SINE_AND_TRACE = np.concatenate([0.5 * _EPSILON.T, np.eye(3).reshape(9, 1)], axis=1)
