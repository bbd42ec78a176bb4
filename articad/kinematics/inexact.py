"""The consistent geometry nearest to rounded connectors.

Overconstrained loops need geometry that real data never have: axes of a planar linkage that are parallel to the last bit. A file has 3
to 9 decimals, so the loop stays open by micrometres, or is locked. Here the connector frames of the loops' joints are moved as little as
possible, such that the loops close and move as intended.

The unknowns are a twist δ (6 numbers, lengths over L) for each of the two frames of each joint on a loop, and the coordinates
Q₁ … Q_K of K configurations along the intended motion. They solve

    min |δ|²   such that   r(Q_k, δ) = 0,   k = 1 … K.

The Q_k are found with a rank that ignores singular values below 2e-3 σ₁, so that noise does not lock the motion. With
J_k = ∂r/∂Q = U Σ Vᵀ and D_k = ∂r/∂δ, the columns U₂ of U beyond that rank eliminate Q_k: U₂ᵀ D_k δ = −U₂ᵀ r_k. Stacked over k
these equations are consistent to second order where a mobile geometry is near, and their shortest solution is the correction
(Gauss–Newton, three or four steps).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.kinematics.factors import least_squares
from articad.kinematics.graph import JointGraph
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.layout import Layout
from articad.kinematics.loops import ClosureSystem
from articad.kinematics.mobility import REALISED, Settled, settled

POSITION_TOLERANCE = 1e-3  # mm: coordinates with 3 decimals are off by up to 0.5e-3 each
RELATIVE_TOLERANCE = 3e-5  # of L: coordinates with 6 significant digits, and the error at a distance L of axes with 4 decimals
ANGLE_TOLERANCE = 7e-5  # rad: axes with 4 decimals are off by up to 0.5e-4 in each component; 0.01° between two axes is beyond
NOISE = 2e-3  # σ/σ₁: largest value that noise within the tolerances can give a direction in which the exact linkage is free
_NEARLY = 0.05  # |r| below which the cause of an open loop is looked for
_COARSE = 0.05  # σ/σ₁ that an axis misaligned by some degrees can give, used only to find the cause
_CLEAR = 2.5  # times the noise: least size of the smallest singular value of a sample
_EXPLAINED = 0.1  # share of the error that may remain for one frame to count as its cause
_WALK, _STEPS = 0.25, 4  # rad, or lengths L; steps of each walk from rest along the intended motion
_ITERATIONS = 8
_CUTS = (1e-2, 1e-3, 1e-4, 1e-5)  # σ/σ₁ below which the conditions for mobility count as noise; the first that works is used


@dataclass(frozen=True)
class Moved:
    """The displacement of the frame of one connector.

    Attributes:
        joint: The joint of the frame.
        part: The part that carries the connector.
        connector: Name of the connector.
        distance: [mm].
        angle: [rad].
    """

    joint: str
    part: str
    connector: str
    distance: float
    angle: float


@dataclass(frozen=True)
class Correction:
    """Joints with consistent frames, and the displacements.

    Attributes:
        joints: All joints, in order.
        moved: Each frame of a joint on a loop.
        length: L [mm] of the linkage.
        askew: The two connectors of one part whose axes were turned most relative to each other, and the angle [rad].
        closed: Whether the loops close with these joints; if not, no mobile geometry is near.
    """

    joints: tuple[Joint, ...]
    moved: tuple[Moved, ...]
    length: float
    askew: tuple[Moved, Moved, float] | None
    closed: bool

    @property
    def distance(self) -> float:
        """Largest displacement of a frame [mm]."""
        return max((one.distance for one in self.moved), default=0.0)

    @property
    def angle(self) -> float:
        """Largest rotation of a frame [rad]."""
        return max((one.angle for one in self.moved), default=0.0)

    @property
    def distance_tolerance(self) -> float:
        """Largest permitted displacement of frames [mm]: 1e-3 mm, or 3e-5 L if that is larger."""
        return max(POSITION_TOLERANCE, RELATIVE_TOLERANCE * self.length)

    @property
    def within(self) -> bool:
        """True if the loops close and no frame was moved beyond the tolerances."""
        return self.closed and self.distance <= self.distance_tolerance and self.angle <= ANGLE_TOLERANCE


def nearest(
    parts: Sequence[str], ground: str, joints: Sequence[Joint], couplings: Sequence[Coupling], *, coarse: bool = False
) -> Correction | None:
    """Return the consistent geometry nearest to the given one.

    Args:
        parts: Parts of the mechanism.
        ground: The part that does not move.
        joints: As given.
        couplings: Relations between coordinates.
        coarse: Whether to look for geometry that is off by degrees, to name the cause.

    Returns:
        The correction; None if the geometry is already consistent, or so far from it that rounding cannot explain it.
    """
    problem = _Problem(parts, ground, joints, couplings, _COARSE if coarse else NOISE)
    samples = problem.samples()
    if samples is None or max(one.residual for one in samples) <= REALISED:
        return None
    left, delta = problem.solved(samples, _CUTS[0])
    for cut in _CUTS[1:]:
        if left <= REALISED:
            break
        left, delta = min((left, delta), problem.solved(samples, cut), key=lambda one: one[0])
    alone = problem.alone(samples) if coarse else None
    return problem.correction(delta if alone is None else alone, closed=left <= REALISED)


class _Problem:
    """The least-squares problem of one mechanism."""

    def __init__(
        self, parts: Sequence[str], ground: str, joints: Sequence[Joint], couplings: Sequence[Coupling], noise: float = NOISE
    ) -> None:
        self._noise = noise
        self._parts, self._ground, self._couplings = tuple(parts), ground, tuple(couplings)
        self._joints = tuple(joints)
        self._system = self._made(self._joints)
        on_loops = {joint.name for loop in self._system.loops for joint in loop.joints}
        self._names = [joint.name for joint in joints if joint.name in on_loops]

    def _made(self, joints: tuple[Joint, ...]) -> ClosureSystem:
        tree, loop_joints = JointGraph(self._parts, self._ground, joints).spanning_tree()
        return ClosureSystem(tree, Layout(joints), loop_joints, self._couplings)

    # --- the intended motion

    def samples(self) -> list[Settled] | None:
        """Return configurations along the intended motion, rest first; None if the loops are far from closing."""
        system = self._system
        start = settled(system, system.layout.rest, None, dropped=self._noise)
        if not start.residual < _NEARLY:
            start = settled(system, system.close(system.layout.rest, system.active).Q, None, dropped=self._noise)
        if not start.residual < _NEARLY:
            return None
        found, rng = [start], np.random.default_rng(0)
        free = self._freedoms(start)
        for _ in range(free + 1 if free else 0):
            c = rng.standard_normal(free)
            for sign in (1.0, -1.0):
                found += self._walk(start, sign * (self._null_space(start).T @ (c / np.linalg.norm(c))))
        return found

    def _walk(self, start: Settled, direction: FloatArray) -> list[Settled]:
        """Return the configurations reached by keeping the direction, up to where noise and a singularity cannot be distinguished."""
        system, at, found = self._system, start, list[Settled]()
        where = np.flatnonzero(system.active)
        for _ in range(_STEPS):
            y = np.zeros(system.layout.n_freedoms)
            y[where] = _WALK * direction
            there = settled(system, system.move(at.Q, y), None, dropped=self._noise)
            kept = len(there.Vt) - self._freedoms(there)
            went = system.step_between(at.Q, there.Q)[where]
            if (
                there.residual > max(0.1 * _NEARLY, 2.0 * start.residual)
                or np.linalg.norm(went) < 0.5 * _WALK
                or (kept and there.s[kept - 1] < _CLEAR * self._noise * there.s[0])
            ):
                break
            N = self._null_space(there)
            if not len(N):
                break
            direction = N.T @ (N @ went)
            direction /= np.linalg.norm(direction)
            found.append(there)
            at = there
        return found

    def _freedoms(self, at: Settled) -> int:
        """Return how many directions are free if singular values below the noise count as zero."""
        return len(at.Vt) - int((at.s > self._noise * at.s.max(initial=0.0)).sum())

    def _null_space(self, at: Settled) -> FloatArray:
        """Return these directions as rows, in the active freedoms."""
        null: FloatArray = at.Vt[len(at.Vt) - self._freedoms(at) :]
        return null

    # --- the correction

    def solved(self, samples: Sequence[Settled], cut: float) -> tuple[float, FloatArray]:
        """Return the largest remaining |r| of the samples, and δ `(joints, 2, 6)`, by Gauss-Newton."""
        delta = np.zeros((len(self._names), 2, 6))
        ranks = [len(one.Vt) - self._freedoms(one) for one in samples]
        system, at = self._system, list(samples)
        best = max(one.residual for one in at), delta
        for _ in range(_ITERATIONS):
            delta = least_squares(*self._linear(system, at, ranks, delta), cut).reshape(delta.shape)
            system = self._made(self._with(delta))
            at = [settled(system, one.Q, rank) for one, rank in zip(at, ranks, strict=True)]
            left = max(one.residual for one in at)
            if left >= 0.5 * best[0]:
                break
            best = left, delta
        return best

    def alone(self, samples: Sequence[Settled]) -> FloatArray | None:
        """Return the δ that moves a single frame and explains the error best, the smallest of equals; None if none explains it."""
        A, b = self._linear(
            self._system, samples, [len(one.Vt) - self._freedoms(one) for one in samples], np.zeros((len(self._names), 2, 6))
        )
        found: list[tuple[float, float, int, FloatArray]] = []
        for frame in range(2 * len(self._names)):
            columns = A[:, 6 * frame : 6 * frame + 6]
            twist = least_squares(columns, b, _CUTS[0])
            left = float(np.linalg.norm(columns @ twist - b) / np.linalg.norm(b))
            if left < _EXPLAINED:
                found.append((round(left, 2), round(float(np.linalg.norm(twist)), 6), frame, twist))
        if not found:
            return None
        *_, frame, twist = min(found, key=lambda one: one[:3])
        delta = np.zeros((2 * len(self._names), 6))
        delta[frame] = twist
        return delta.reshape(-1, 2, 6)

    def _linear(
        self, system: ClosureSystem, samples: Sequence[Settled], ranks: Sequence[int], delta: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the equations A δ = b of all samples, linearised about the present δ: U₂ᵀ D (δ' − δ) = −U₂ᵀ r."""
        rows, rights = [], []
        for one, rank in zip(samples, ranks, strict=True):
            across = one.U[:, rank:].T
            D = across @ self._by_frames(system, one.Q)
            rows.append(D)
            rights.append(D @ delta.ravel() - across @ one.r)
        return np.concatenate(rows), np.concatenate(rights)

    def _by_frames(self, system: ClosureSystem, Q: FloatArray) -> FloatArray:
        """Return ∂r/∂δ `(rows, 12 joints)`: a twist of a frame moves what is beyond it as the joint itself would."""
        T = dict(zip(system.parts, system.arrays.matrices(Q[None])[:, 0], strict=False))
        place = {name: i for i, name in enumerate(self._names)}
        D = np.zeros((system.n_rows, len(self._names), 2, 6))
        for i, loop in enumerate(system.loops):
            B = T[loop.joint.child] @ loop.joint.T_child_connector.matrix
            out = D[6 * i : 6 * i + 6]
            for joint, near in zip(loop.joints, (*loop.parts[:-1], None), strict=True):
                side = 1.0 if joint.parent == near else -1.0
                frames = (T[joint.parent] @ joint.T_parent_connector.matrix, T[joint.child] @ joint.T_child_connector.matrix)
                for k, P in enumerate(frames):
                    sign = side if k == 0 else -side
                    arms = np.cross(P[:3, :3].T, B[:3, 3] - P[:3, 3])  # lever arms of a turn about each axis
                    out[:3, place[joint.name], k, :3] = sign * (B[:3, :3].T @ P[:3, :3]) * (self._system.length / system.lengths[i])
                    out[:3, place[joint.name], k, 3:] = sign * (B[:3, :3].T @ arms.T) / system.lengths[i]
                    out[3:, place[joint.name], k, 3:] = sign * (B[:3, :3].T @ P[:3, :3])
        return D.reshape(system.n_rows, -1)

    def _with(self, delta: FloatArray) -> tuple[Joint, ...]:
        """Return the joints with their frames moved by δ."""
        scale = np.array([self._system.length] * 3 + [1.0] * 3)
        twists = dict(zip(self._names, delta * scale, strict=True))
        return tuple(_moved(joint, twists[joint.name]) if joint.name in twists else joint for joint in self._joints)

    def correction(self, delta: FloatArray, *, closed: bool) -> Correction:
        """Return the joints with their frames moved by δ, and the displacement of each."""
        joints = self._with(delta)
        moved, turned = list[Moved](), dict[str, list[tuple[Moved, FloatArray]]]()
        by_name = {joint.name: joint for joint in self._joints}
        for name, two in zip(self._names, delta, strict=True):
            joint = by_name[name]
            ends = (
                (joint.parent, joint.parent_connector, joint.T_parent_connector),
                (joint.child, joint.child_connector, joint.T_child_connector),
            )
            for (part, connector, frame), twist in zip(ends, two, strict=True):
                distance, angle = float(np.linalg.norm(twist[:3])) * self._system.length, float(np.linalg.norm(twist[3:]))
                one = Moved(name, part, connector, distance, angle)
                moved.append(one)
                turned.setdefault(part, []).append((one, frame.rotation @ twist[3:]))
        pairs = [(a, b, float(np.linalg.norm(x - y))) for ends in turned.values() for i, (a, x) in enumerate(ends) for b, y in ends[:i]]
        askew = max(pairs, key=lambda pair: pair[2], default=None)
        return Correction(joints, tuple(moved), self._system.length, askew, closed)


def _moved(joint: Joint, twists: FloatArray) -> Joint:
    parent, child = (
        frame @ SE3.exp(twist) for frame, twist in zip((joint.T_parent_connector, joint.T_child_connector), twists, strict=True)
    )
    return replace(joint, T_parent_connector=parent, T_child_connector=child)


def shown_gap(mm: float) -> str:
    """Return a gap as findings show it, with a power of ten if it is small."""
    return f"{mm:.3f} mm" if mm >= 0.01 else f"{mm:.1e} mm"
