"""Rigid-body dynamics at closed configurations: mass matrix, bias, inverse and forward dynamics, loops and couplings included.

Pinocchio computes the tree: M (CRBA), h = C v + g (RNEA). Loops and couplings constrain the velocities v of all freedoms by
J(Q) v = 0. With Z a basis of the null space of J, every admissible velocity is v = Z z, every admissible acceleration
v̇ = Z ż + c with J c = −J̇ v, and the equation of motion is (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 8)

    Zᵀ M Z ż + Zᵀ (M c + h) = (E Z)ᵀ τ,

where E selects the freedoms of the drivers, on which the efforts τ act. Idle freedoms, such as the spin of a rod between two balls, are
part of Z, and no effort acts on them.

Units: configurations q in mm and rad, as everywhere in articad; everything else in SI: m, kg, s, N, N·m, rad/s, J.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Final, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray, IndexArray
from articad.errors import KinematicsError
from articad.kinematics.factors import svd
from articad.kinematics.forward import CompiledModel, compile  # noqa: A004 - of a model
from articad.kinematics.loops import RANK_TOLERANCE
from articad.kinematics.mechanism import Mechanism

GRAVITY: Final = (0.0, 0.0, -9.81)
"""Gravity along −z [m/s²], as exported models have it."""

_STEP: Final = 1e-3  # rad, or lengths L: step of the differences that give J̇ v, with an error of fourth order
_MM_PER_M: Final = 1e3


class Massive(Protocol):
    """Mass properties of a part in its own frame."""

    @property
    def mass(self) -> float:
        """[kg]."""

    @property
    def com(self) -> FloatArray:
        """Centre of mass [mm] `(3,)`."""

    @property
    def inertia(self) -> FloatArray:
        """About the centre of mass [kg·mm²] `(3, 3)`."""


class Acceleration(NamedTuple):
    """The effect of efforts on a mechanism.

    Attributes:
        drivers: Accelerations of the drivers' freedoms [m/s², rad/s²] `(nv,)`.
        freedoms: Accelerations of the freedoms of all joints, in the order in which they are declared `(n_freedoms,)`.
        efforts: Efforts of the drivers [N, N·m] `(nv,)`.
        constraints: By loop joint: force [N] and torque [N·m] at its connector that the parent exerts on the child, in the frame of
            the parent's connector after the joint's motion `(6,)`. By coupling: the effort [N, N·m] `(1,)` on its second coordinate.
            Where constraints are redundant, the smallest set of forces is returned.
    """

    drivers: FloatArray
    freedoms: FloatArray
    efforts: FloatArray
    constraints: dict[str, FloatArray]


class _State(NamedTuple):
    """A configuration and velocity, and the terms of the equation of motion there; lengths are in mm.

    Attributes:
        M: Mass matrix of all freedoms `(n, n)`.
        h: Coriolis, centrifugal and gravity forces `(n,)`.
        Z: Basis of the admissible velocities `(n, k)`.
        c: Acceleration of all freedoms where ż is 0 `(n,)`.
        J: Scaled constraints `(rows, n)`.
        scale: Size of one scaled unit of each freedom `(n,)`.
    """

    M: FloatArray
    h: FloatArray
    Z: FloatArray
    c: FloatArray
    J: FloatArray
    scale: FloatArray


class Dynamics:
    """The dynamics of a mechanism whose parts have mass.

    Args:
        mechanism: The mechanism.
        masses: Mass properties of parts, each in the part's frame; parts that are not named are massless.
        gravity: Acceleration [m/s²] in the ground frame.

    Raises:
        KinematicsError: If a name is not that of a part.
        LoopError: E_LOOP_OPEN if the loops cannot be closed at rest.
    """

    def __init__(self, mechanism: Mechanism, masses: Mapping[str, Massive], *, gravity: Sequence[float] = GRAVITY) -> None:
        for name in masses:
            mechanism.part_index(name)
        self.mechanism, self.masses = mechanism, dict(masses)
        self.gravity: FloatArray = np.array(gravity, dtype=np.float64)
        layout = mechanism.layout
        self._driving: IndexArray = (
            np.arange(layout.n_freedoms) if mechanism.is_tree else np.asarray(mechanism.branch.driver_freedoms, dtype=np.intp)
        )
        # v[SI] = v[mm] · _si; in kg, mm and s an effort is 1e-6 N·m or 1e-3 N
        self._si: FloatArray = np.where(layout.is_length, 1 / _MM_PER_M, 1.0)
        self._effort: FloatArray = np.where(layout.is_length, 1e-3, 1e-6)

    # --- drivers' coordinates

    def mass_matrix(self, q: npt.ArrayLike) -> FloatArray:
        """Return the inertia that acts on the drivers [kg, kg·m, kg·m²] `(nv, nv)`; freedoms without a driver move freely.

        Args:
            q: Coordinates of the drivers [rad, mm] `(nq,)`.

        Raises:
            KinematicsError: If the drivers cannot move independently here, as at a dead point.
        """
        state = self._state(q, np.zeros(self.nv))
        EZ = self._driven(state)
        inverse = EZ @ np.linalg.solve(state.Z.T @ state.M @ state.Z, EZ.T)  # E (Zᵀ M Z)⁻¹ Eᵀ in mm
        scale = self._si[self._driving]
        M: FloatArray = np.linalg.inv(inverse) * 1e-6 / np.outer(scale, scale)
        return M

    def gravity_efforts(self, q: npt.ArrayLike) -> FloatArray:
        """Return the efforts of the drivers [N, N·m] `(nv,)` that hold the mechanism still against gravity.

        Args:
            q: Coordinates of the drivers [rad, mm] `(nq,)`.
        """
        return self.inverse(q, np.zeros(self.nv), np.zeros(self.nv)).efforts

    def bias(self, q: npt.ArrayLike, v: npt.ArrayLike) -> FloatArray:
        """Return the efforts [N, N·m] `(nv,)` at which the drivers do not accelerate: Coriolis, centrifugal and gravity terms.

        Args:
            q: Coordinates of the drivers [rad, mm] `(nq,)`.
            v: Velocities of the drivers' freedoms [m/s, rad/s] `(nv,)`.
        """
        return self.inverse(q, v, np.zeros(self.nv)).efforts

    def inverse(self, q: npt.ArrayLike, v: npt.ArrayLike, a: npt.ArrayLike) -> Acceleration:
        """Return the efforts that give the drivers the requested accelerations.

        Args:
            q: Coordinates of the drivers [rad, mm] `(nq,)`.
            v: Velocities of the drivers' freedoms [m/s, rad/s] `(nv,)`.
            a: Accelerations of the drivers' freedoms [m/s², rad/s²] `(nv,)`.

        Raises:
            KinematicsError: If a shape is wrong, or the drivers cannot move independently here.
        """
        state, wanted = self._state(q, self._velocity(v)), self._velocity(a)
        EZ, k = self._driven(state), state.Z.shape[1]
        # [Zᵀ M Z  −(EZ)ᵀ; EZ  0] [ż; τ] = [−Zᵀ(M c + h); a − E c]
        A = np.block([[state.Z.T @ state.M @ state.Z, -EZ.T], [EZ, np.zeros((self.nv, self.nv))]])
        solved = np.linalg.solve(A, np.concatenate([-state.Z.T @ (state.M @ state.c + state.h), wanted - state.c[self._driving]]))
        return self._result(state, solved[:k], solved[k:])

    def forward(self, q: npt.ArrayLike, v: npt.ArrayLike, efforts: npt.ArrayLike) -> Acceleration:
        """Return the accelerations of the mechanism under efforts.

        Args:
            q: Coordinates of the drivers [rad, mm] `(nq,)`.
            v: Velocities of the drivers' freedoms [m/s, rad/s] `(nv,)`; freedoms without a driver are at rest.
            efforts: Efforts of the drivers [N, N·m] `(nv,)`.

        Raises:
            KinematicsError: If a shape is wrong.
        """
        state = self._state(q, self._velocity(v))
        tau: FloatArray = self._array(efforts, "efforts") / self._effort[self._driving]
        EZ = self._driven(state)
        pull: FloatArray = np.asarray(EZ.T @ tau, dtype=np.float64) - state.Z.T @ (state.M @ state.c + state.h)
        z: FloatArray = np.asarray(np.linalg.solve(state.Z.T @ state.M @ state.Z, pull), dtype=np.float64)
        return self._result(state, z, tau)

    def centre_of_mass(self, q: npt.ArrayLike) -> FloatArray:
        """Return the centre of mass [m] `(3,)` in the ground frame, the ground part's mass included.

        Args:
            q: Coordinates of the drivers [rad, mm] `(nq,)`.

        Raises:
            KinematicsError: If no part has mass.
        """
        poses = self.mechanism.poses(q)
        total = sum(body.mass for body in self.masses.values())
        if total == 0:
            raise KinematicsError("The mechanism has no mass: give its parts materials, densities or masses.")
        weighed = [poses[self.mechanism.part_index(name)].apply(body.com) * body.mass for name, body in self.masses.items()]
        centre: FloatArray = np.sum(weighed, axis=0) / total / _MM_PER_M
        return centre

    def energy(self, q: npt.ArrayLike, v: npt.ArrayLike | None = None) -> tuple[float, float]:
        """Return kinetic and potential energy [J]; the potential of the ground frame's origin is zero.

        Args:
            q: Coordinates of the drivers [rad, mm] `(nq,)`.
            v: Velocities of the drivers' freedoms [m/s, rad/s] `(nv,)`; at rest by default.
        """
        given = self._velocity(np.zeros(self.nv) if v is None else v)
        Q = self.mechanism.configuration(q).columns
        all_v = self._all_velocities(Q, given)
        kinetic = 0.5 * float(all_v @ self._tree(Q, all_v)[0] @ all_v) * 1e-6
        total = sum(body.mass for body in self.masses.values())
        return kinetic, -total * float(self.gravity @ self.centre_of_mass(q)) if total else 0.0

    @property
    def nv(self) -> int:
        """Number of the drivers' freedoms."""
        return len(self._driving)

    # --- the equation of motion in mm

    def _array(self, values: npt.ArrayLike, what: str) -> FloatArray:
        array = np.asarray(values, dtype=np.float64)
        if array.shape != (self.nv,) or not np.isfinite(array).all():
            raise KinematicsError(
                f"The {what} must be {self.nv} finite numbers, one for each driver's freedom; their shape is {array.shape}."
            )
        return array

    def _velocity(self, values: npt.ArrayLike) -> FloatArray:
        """Return velocities or accelerations of the drivers in mm."""
        converted: FloatArray = self._array(values, "velocities and accelerations") / self._si[self._driving]
        return converted

    def _driven(self, state: _State) -> FloatArray:
        EZ: FloatArray = state.Z[self._driving]
        s = np.linalg.svd(EZ, compute_uv=False)
        if len(s) < self.nv or (self.nv and s[-1] < RANK_TOLERANCE * max(1.0, s[0])):
            raise KinematicsError("The drivers cannot move independently in this configuration: it is a dead point.")
        return EZ

    def _state(self, q: npt.ArrayLike, given: FloatArray) -> _State:
        Q = self.mechanism.configuration(q).columns
        if Q.ndim != 1:
            raise KinematicsError(f"Dynamics are computed at one configuration; q has shape {np.shape(q)}.")
        v = self._all_velocities(Q, given)
        M, h = self._tree(Q, v)
        J, scale = self._constraints(Q)
        if not len(J):
            return _State(M, h, np.eye(len(M)), np.zeros(len(M)), J, scale)
        # in scaled freedoms y = v / scale: null space Z, and the shortest c with J c = −J̇ v
        U, s, Vt = np.linalg.svd(J)
        rank = int((s > RANK_TOLERANCE * s.max(initial=0.0)).sum())
        turned = U[:, :rank].T @ self._rate(lambda at: self._constraints(at)[0], Q, v, scale)
        c = -Vt[:rank].T @ (turned / s[:rank])
        return _State(M, h, scale[:, None] * Vt[rank:].T, scale * c, J, scale)

    def _all_velocities(self, Q: FloatArray, given: FloatArray) -> FloatArray:
        if self.mechanism.is_tree:
            return given
        v: FloatArray = self.mechanism.branch.velocities(Q) @ given
        return v

    def _constraints(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the Jacobian `(rows, n_freedoms)` of loops and couplings by scaled freedoms, and the scale of each freedom."""
        n = self.mechanism.layout.n_freedoms
        scale, blocks = np.ones(n), [np.zeros((0, n))]
        for group in () if self.mechanism.is_tree else self.mechanism.branch.groups:
            system = group.system
            block = np.zeros((system.n_rows, n))
            block[:, system.freedoms] = system.evaluate_one(system.to_system(Q))[1]
            scale[system.freedoms[system.active]] = system.scale[system.active]
            blocks.append(block)
        return np.concatenate(blocks), scale

    def _rate(self, of: Callable[[FloatArray], FloatArray], Q: FloatArray, v: FloatArray, scale: FloatArray) -> FloatArray:
        """Return Ȧ w of a matrix A(Q) that acts on w = v / scale.

        Central differences along v, Richardson-extrapolated: the error is of fourth order in the step.
        """
        y = v / scale
        speed = float(np.abs(y).max(initial=0.0))
        if speed == 0:
            return np.zeros(len(of(Q)))
        layout = self.mechanism.layout

        def difference(h: float) -> FloatArray:
            ahead, behind = (of(layout.integrate(Q, sign * h / speed * v)) for sign in (1.0, -1.0))
            slope: FloatArray = (ahead - behind) @ y * (speed / (2 * h))
            return slope

        rate: FloatArray = (4 * difference(_STEP / 2) - difference(_STEP)) / 3
        return rate

    def _result(self, state: _State, z: FloatArray, tau: FloatArray) -> Acceleration:
        a = state.Z @ z + state.c
        free = state.M @ a + state.h
        free[self._driving] -= tau
        return Acceleration((a * self._si)[self._driving], a * self._si, tau * self._effort[self._driving], self._forces(state, free))

    def _forces(self, state: _State, free: FloatArray) -> dict[str, FloatArray]:
        """Return the smallest constraint forces λ with Jᵀ λ = M v̇ + h − Eᵀ τ, by loop joint and by coupling."""
        if self.mechanism.is_tree:
            return {}
        U, s, Vt = svd(state.J)
        kept = s > RANK_TOLERANCE * s.max(initial=0.0)
        multipliers = (U[:, kept] / s[kept]) @ (Vt[kept] @ (free * state.scale))
        forces: dict[str, FloatArray] = {}
        at = 0
        for group in self.mechanism.branch.groups:
            system = group.system
            for loop, length in zip(system.loops, system.lengths, strict=True):
                force, torque = multipliers[at : at + 3] / length, multipliers[at + 3 : at + 6]
                forces[loop.joint.name] = np.concatenate([force * 1e-3, torque * 1e-6])
                at += 6
            for row, coupling in enumerate(system.couplings):
                column = self.mechanism.layout.freedom_of(self.mechanism.layout.column_of[coupling.b])
                slope = state.J[at + row, column] / state.scale[column]
                forces[coupling.name] = np.array([multipliers[at + row] * slope * self._effort[column]])
            at += len(system.couplings)
        return forces

    # --- the tree, by Pinocchio

    @cached_property
    def _compiled(self) -> CompiledModel:
        """The tree with the parts' inertias; lengths are mm."""
        import pinocchio as pin  # noqa: PLC0415 - imported only where dynamics are requested

        compiled = compile(self.mechanism)
        for name, body in self.masses.items():
            frame = compiled.model.frames[compiled.frame_ids[name]]
            compiled.model.appendBodyToJoint(frame.parentJoint, pin.Inertia(body.mass, body.com, body.inertia), frame.placement)
        compiled.model.gravity = pin.Motion(self.gravity * _MM_PER_M, np.zeros(3))
        return compiled

    def _tree(self, Q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mass matrix and bias of all freedoms; loop joints have no inertia.

        Pinocchio's velocities are v_p = B v, so M = Bᵀ M_p B and h = Bᵀ (M_p Ḃ v + h_p).
        """
        import pinocchio as pin  # noqa: PLC0415

        model, data = self._compiled.model, self._compiled.data
        B = self._velocity_map(Q)
        lengths = np.where(self.mechanism.layout.is_length, _MM_PER_M, 1.0)  # a step of 1 rad is as long as one of 1 m
        B_v = self._rate(lambda at: self._velocity_map(at) * lengths, Q, v, lengths)
        q, v_p = self._compiled.q(Q), B @ v
        M_p = np.array(pin.crba(model, data, q)).reshape(model.nv, model.nv)
        M_p = np.triu(M_p) + np.triu(M_p, 1).T
        h_p = np.array(pin.rnea(model, data, q, v_p, B_v))
        return B.T @ M_p @ B, B.T @ h_p

    def _velocity_map(self, Q: FloatArray) -> FloatArray:
        """Return B `(nv_p, n_freedoms)`: Pinocchio's velocities per freedom.

        Both describe the same relative motion of a joint's two parts, each by its own twists: B solves S_p B = S, joint by joint.
        """
        import pinocchio as pin  # noqa: PLC0415

        compiled, layout, arrays = self._compiled, self.mechanism.layout, self.mechanism.arrays
        S_p = np.array(pin.computeJointJacobians(compiled.model, compiled.data, compiled.q(Q))).reshape(6, -1)
        T = arrays.matrices(Q[None])
        v0, omega = (twist[:, 0] for twist in arrays.twists(T, Q[None]))
        S: FloatArray = np.concatenate([v0, omega], axis=1).T
        B = np.zeros((compiled.model.nv, layout.n_freedoms))
        for crossing, joint_id in zip(compiled.crossings, compiled.joint_ids, strict=True):
            n = crossing.joint.type.freedoms
            if n:
                own, at = layout.freedoms[crossing.joint.name], compiled.model.joints[joint_id].idx_v
                sign = arrays.carried[crossing.far][own]
                B[at : at + n, own] = np.linalg.lstsq(S_p[:, at : at + n], S[:, own] * sign, rcond=None)[0]
        return B
