"""The joints of a mechanism as equations between poses of parts: an oracle that shares nothing with the solver.

Unknown are the poses of all parts and the values of all joints at once. No joint closes a loop and none carries a tree: each one says
`X_child C_c F = X_parent C_p J(s)`, six equations; each coupling is one more. Newton's method solves them from the rest pose on, in small
steps of the drivers. Every joint is `J = T(x, y, z) Rx(a) Ry(b) Rz(c) R` with some of these six values in use, and a rotation R of a ball or a free joint.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from articad.connectors import Mate
from articad.kinematics import JointType, Mechanism

FloatArray = NDArray[np.float64]

FLIP = np.diag([1.0, -1.0, -1.0, 1.0])
SLOTS = {
    "revolute": (5,),
    "slider": (2,),
    "cylindrical": (2, 5),
    "planar": (0, 1, 5),
    "universal": (3, 4),
    "screw": (5,),
    "fixed": (),
    "ball": (6, 7, 8),
    "free": (0, 1, 2, 6, 7, 8),
}
STEP = 0.06  # rad, or sizes: of the driver that moves most, from one solution to the next
CONVERGED = 3e-14
WELL_POSED = 0.15  # of the smallest singular value at rest: below it a way is not followed
FALLS = 1.5  # times its fall in one step, below which a singular pose may be stepped over
LONGEST = 0.5  # rad, or sizes: by which anything may follow in one step
_IDLE = 1e-7  # singular values below it belong to freedoms that no driver holds


@dataclass(frozen=True)
class Solution:
    """Where everything is.

    Attributes:
        X: Poses `(parts, 4, 4)` [mm].
        s: Values `(freedoms,)` of the joints [rad, mm]; those of balls are not used.
        R: Rotations `(joints, 3, 3)` of the balls.
        sigma: Smallest singular value of the equations for what follows.
        volume: Logarithm of the product of their singular values. The equations of one loop near its singular pose take the product
            along, even where another loop has smaller values all the way.
    """

    X: FloatArray
    s: FloatArray
    R: FloatArray
    sigma: float = math.inf
    volume: float = 0.0


class PoseEquations:
    """Equations of one mechanism.

    Args:
        mechanism: Only what was declared is read: joints, couplings, and which coordinates drive.
        rest: Poses of the parts at rest `(4, 4)` [mm].
        size: Length [mm] of each part's surroundings, by which lengths are divided.
    """

    def __init__(self, mechanism: Mechanism, rest: Mapping[str, FloatArray], size: Mapping[str, float]) -> None:
        joints = mechanism.joints
        self.parts, self.joints = list(mechanism.parts), joints
        self.ground = self.parts.index(mechanism.ground)
        self.near, self.far = (np.array([self.parts.index(getattr(j, end)) for j in joints], dtype=int) for end in ("parent", "child"))
        flips = [FLIP if j.mate == Mate.OPPOSED else np.eye(4) for j in joints]
        self.A = np.array([j.T_parent_connector.matrix for j in joints]).reshape(-1, 4, 4)
        self.B = np.array([j.T_child_connector.matrix @ F for j, F in zip(joints, flips, strict=True)]).reshape(-1, 4, 4)
        self.L_part = np.array([size[name] for name in self.parts])
        self.L_joint = np.minimum(self.L_part[self.near], self.L_part[self.far])
        # freedoms: of which joint, in which units, and what they are among the six values of J
        self.owner = np.array([k for k, j in enumerate(joints) for _ in range(j.type.freedoms)], dtype=int)
        self.place = {name: at for at, name in enumerate(name for j in joints for name in _freedom_names(j))}
        self.is_length = np.array([unit == "mm" for j in joints for unit in j.type.freedom_units], dtype=bool)
        self.L = np.where(self.is_length, self.L_joint[self.owner] if len(self.owner) else 1.0, 1.0)
        self.M = np.zeros((len(joints), 9, len(self.owner)))  # values of J, and turns of a ball, per freedom
        for k, j in enumerate(joints):
            own = np.flatnonzero(self.owner == k)
            for slot, at in zip(SLOTS[j.type], own, strict=True):
                self.M[k, slot, at] = 1.0
            if j.type is JointType.SCREW:
                self.M[k, 2, own[0]] = j.lead / (2 * math.pi)
        self.is_turn = self.M[:, 6:].any(axis=(0, 1))  # turns of a quaternion, which have no value of their own
        self.C = np.zeros((len(mechanism.couplings), len(self.owner)))
        self.c = np.array([c.offset for c in mechanism.couplings])
        for row, c in zip(self.C, mechanism.couplings, strict=True):
            row[self.place[c.b]], row[self.place[c.a]] = 1.0, -c.ratio
        self.L_coupling = np.array([self.L[self.place[c.b]] for c in mechanism.couplings])
        self.rest = self._solution(np.array([rest[name] for name in self.parts]), [j.rest for j in joints])

    # --- equations

    def read(self, X: FloatArray, values: Mapping[str, Sequence[float]]) -> Solution:
        """Return poses and joint values that somebody else says hold."""
        return self._solution(X, [values[j.name] for j in self.joints])

    def _solution(self, X: FloatArray, values: Sequence[Sequence[float]]) -> Solution:
        s, R = np.zeros(len(self.owner)), np.tile(np.eye(3), (len(self.joints), 1, 1))
        for k, (joint, own) in enumerate(zip(self.joints, values, strict=True)):
            first = len(own) if joint.type.quaternion is None else joint.type.quaternion
            s[np.flatnonzero(self.owner == k)[:first]] = own[:first]
            if first < len(own):
                R[k] = Rotation.from_quat(own[first:]).as_matrix()
        return Solution(X, s, R)

    def residual(self, at: Solution) -> FloatArray:
        """Return by how much each equation does not hold `(6 joints + couplings,)`: rad, and lengths per size."""
        e, _, _ = self._mismatch(at)
        return np.concatenate([e.ravel(), (self.C @ at.s - self.c) / self.L_coupling])

    def _mismatch(self, at: Solution) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return e = log(J⁻¹D) `(joints, 6)`, D = (X_p A)⁻¹ X_c B `(joints, 4, 4)`, and dJ per freedom as seen from the child's side."""
        D = inverse(at.X[self.near] @ self.A) @ at.X[self.far] @ self.B
        J, S = motions(self.M[:, :6] @ at.s, at.R)
        E = inverse(J) @ D
        e = np.concatenate([E[:, :3, 3] / self.L_joint[:, None], Rotation.from_matrix(E[:, :3, :3]).as_rotvec()], axis=1)
        return e, D, S

    def linearized(self, at: Solution) -> tuple[FloatArray, FloatArray]:
        """Return the residual and its derivative by all poses and freedoms, scaled `(rows, 6 parts + freedoms)`."""
        e, D, S = self._mismatch(at)
        n, m = len(self.joints), len(self.parts)
        K = np.zeros((n, 6, m, 6))
        rows = np.arange(n)
        K[rows, :, self.far] = adjoint(inverse(self.B))
        K[rows, :, self.near] -= adjoint(inverse(self.A @ D))
        K[..., :3] *= self.L_part[:, None]
        F = -S @ self.M * self.L
        both = np.concatenate([K.reshape(n, 6, 6 * m), F], axis=2)
        both[:, :3] /= self.L_joint[:, None, None]
        tied = np.concatenate([np.zeros((len(self.C), 6 * m)), self.C * self.L / self.L_coupling[:, None]], axis=1)
        r = np.concatenate([e.ravel(), (self.C @ at.s - self.c) / self.L_coupling])
        return r, np.concatenate([both.reshape(6 * n, -1), tied])

    def moved(self, at: Solution, step: FloatArray) -> Solution:
        """Return the solution after a scaled step of all poses and freedoms."""
        m = len(self.parts)
        xi, ds = step[: 6 * m].reshape(m, 6), step[6 * m :] * self.L
        T = np.tile(np.eye(4), (m, 1, 1))
        T[:, :3, :3], T[:, :3, 3] = Rotation.from_rotvec(xi[:, 3:]).as_matrix(), xi[:, :3] * self.L_part[:, None]
        R = at.R @ Rotation.from_rotvec(self.M[:, 6:] @ ds).as_matrix() if len(self.joints) else at.R
        return Solution(at.X @ T, at.s + ds * ~self.is_turn, R)

    # --- following drivers

    def follow(self, drivers: Sequence[str], targets: Mapping[str, float], balls: Mapping[str, FloatArray] | None = None) -> list[Solution]:
        """Move drivers evenly from rest to their targets, the others standing still; what follows is found in small steps.

        Args:
            drivers: Names of all freedoms that are given.
            targets: Of the drivers that move [rad, mm].
            balls: Rotations of the balls that are moved, by joint.

        Returns:
            The solutions, from rest on; fewer where the equations do not determine the next one.
        """
        _, free = self._parted(drivers)
        goal = self.rest.s.copy()
        for name, value in targets.items():
            goal[self.place[name]] = value
        turns = {self._joint(name): Rotation.from_matrix(R) for name, R in (balls or {}).items()}
        far = float(np.abs((goal - self.rest.s) / self.L).max(initial=0.0))
        steps = max(4, math.ceil(far / STEP))
        found, (at_rest, volume) = [self.rest], self._conditioned(self.rest, free)
        last = at_rest
        for share in np.linspace(0, 1, steps + 1)[1:]:
            at = self._at_drivers(found[-1], self._places(targets), self.rest.s + share * (goal - self.rest.s), turns, share)
            solved = self._solved(at, free)
            if solved is None or solved.sigma < max(WELL_POSED * at_rest, FALLS * (last - solved.sigma)):
                break
            if solved.volume < volume + math.log(FALLS / (1 + FALLS)):  # exp(now) < FALLS (exp(last) - exp(now)), of the product
                break
            last, volume = solved.sigma, solved.volume
            if np.abs((solved.s - found[-1].s) / self.L).max(initial=0.0) > LONGEST:
                break
            found.append(solved)
        return found

    def velocities(self, at: Solution, drivers: Sequence[str]) -> tuple[FloatArray, FloatArray]:
        """Return how fast parts move per unit of each driver freedom, in the world: v of their origins and ω, `(parts, 3, drivers)` [mm, rad]."""
        held, free = self._parted(drivers)
        K = self.linearized(at)[1]
        given = 6 * len(self.parts) + self._places(drivers)
        y = np.zeros((K.shape[1], len(drivers)))
        y[given, np.arange(len(drivers))] = 1 / self.L[self._places(drivers)]
        y[free] = -np.linalg.pinv(K[:, free], rcond=1e-11) @ K[:, held] @ y[held]
        xi = y[: 6 * len(self.parts)].reshape(len(self.parts), 6, -1)
        turn = at.X[:, :3, :3]
        return turn @ xi[:, :3] * self.L_part[:, None, None], turn @ xi[:, 3:]

    def _parted(self, drivers: Sequence[str]) -> tuple[FloatArray, FloatArray]:
        """Return which unknowns are given, the ground's pose and the drivers, and which are free."""
        first = 6 * len(self.parts)
        held = np.concatenate([np.arange(6 * self.ground, 6 * self.ground + 6), first + self._places(drivers)]).astype(int)
        return held, np.setdiff1d(np.arange(first + len(self.owner)), held)

    def _at_drivers(self, at: Solution, places: FloatArray, s: FloatArray, turns: Mapping[int, Rotation], share: float) -> Solution:
        values, R = at.s.copy(), at.R.copy()
        values[places] = s[places]
        for k, turn in turns.items():
            start = Rotation.from_matrix(self.rest.R[k])
            R[k] = (start * Rotation.from_rotvec(share * (start.inv() * turn).as_rotvec())).as_matrix()
        return Solution(at.X, values, R)

    def _solved(self, at: Solution, free: FloatArray) -> Solution | None:
        """Newton's method for the free unknowns; None where it does not converge."""
        for _ in range(12):
            r, K = self.linearized(at)
            K = K[:, free]
            if np.abs(r).max(initial=0.0) < CONVERGED:
                break
            N = K.T @ K
            step = np.zeros(6 * len(self.parts) + len(self.owner))
            step[free] = -np.linalg.solve(N + 1e-14 * np.eye(len(N)), K.T @ r)
            at = self.moved(at, step)
        else:
            if np.abs(self.residual(at)).max() > 1e-11:
                return None
        return Solution(at.X, at.s, at.R, *self._conditioned(at, free))

    def _conditioned(self, at: Solution, free: FloatArray) -> tuple[float, float]:
        """Return the smallest singular value of the equations for what is free, and the logarithm of the product of all of them.

        Singular values of what moves nothing are left out.
        """
        K = self.linearized(at)[1][:, free]
        sigma = np.sqrt(np.maximum(np.linalg.eigvalsh(K.T @ K), 0.0))
        sigma = sigma[sigma > _IDLE]
        return float(sigma.min(initial=math.inf)), float(np.log(sigma).sum())

    def _places(self, names: Sequence[str] | Mapping[str, float]) -> FloatArray:
        return np.array([self.place[name] for name in names], dtype=int)

    def _joint(self, name: str) -> int:
        return next(k for k, joint in enumerate(self.joints) if joint.name == name)


def _freedom_names(joint: object) -> tuple[str, ...]:
    """Return the names of a joint's freedoms: as its coordinates', but a quaternion stands for three turns."""
    names: tuple[str, ...] = joint.column_names  # type: ignore[attr-defined]
    first = joint.type.quaternion  # type: ignore[attr-defined]
    turns = tuple(f"{joint.name}.{axis}" for axis in ("rx", "ry", "rz"))  # type: ignore[attr-defined]
    return names if first is None else (*names[:first], *turns)


def motions(s: FloatArray, R: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return J = T(x, y, z) Rx(a) Ry(b) Rz(c) R `(n, 4, 4)` and J⁻¹dJ `(n, 6, 9)` by the six values and the turns of a ball."""
    Rx, Ry, Rz = (Rotation.from_rotvec(np.outer(s[:, 3 + k], np.eye(3)[k])).as_matrix() for k in range(3))
    zR = Rz @ R
    yR = Ry @ zR
    J, S = np.tile(np.eye(4), (len(s), 1, 1)), np.zeros((len(s), 6, 9))
    J[:, :3, :3], J[:, :3, 3] = Rx @ yR, s[:, :3]
    S[:, :3, :3] = np.swapaxes(J[:, :3, :3], 1, 2)
    S[:, 3:, 3], S[:, 3:, 4], S[:, 3:, 5], S[:, 3:, 6:] = yR[:, 0], zR[:, 1], R[:, 2], np.eye(3)
    return J, S


def adjoint(T: FloatArray) -> FloatArray:
    """Return the adjoint `(n, 6, 6)` of poses: it takes a twist (v, ω) of the body's frame to the frame that T is seen from."""
    R, t = T[:, :3, :3], T[:, :3, 3]
    out = np.zeros((len(T), 6, 6))
    cross = np.zeros((len(T), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -t[:, 2], t[:, 1], -t[:, 0]
    out[:, :3, :3] = out[:, 3:, 3:] = R
    out[:, :3, 3:] = (cross - np.swapaxes(cross, 1, 2)) @ R
    return out


def inverse(T: FloatArray) -> FloatArray:
    """Return the inverses `(n, 4, 4)` of poses."""
    out = T.copy()
    out[:, :3, :3] = np.swapaxes(T[:, :3, :3], 1, 2)
    out[:, :3, 3:] = -out[:, :3, :3] @ T[:, :3, 3:]
    return out


def joint_motion(kind: JointType, values: Sequence[float], lead: float = 0.0) -> FloatArray:
    """Return J(q) `(4, 4)` of one joint."""
    s, R = np.zeros((1, 6)), np.eye(3)[None]
    first = len(values) if kind.quaternion is None else kind.quaternion
    s[0, list(SLOTS[kind][:first])] = values[:first]
    if first < len(values):
        R = Rotation.from_quat(values[first:]).as_matrix()[None]
    if kind is JointType.SCREW:
        s[0, 2] = lead / (2 * math.pi) * values[0]
    J: FloatArray = motions(s, R)[0][0]
    return J
