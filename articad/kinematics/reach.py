"""Reaching: a configuration within limits that brings a frame to a target, or what stops it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray
from articad.connectors import SE3, quaternion
from articad.errors import KinematicsError
from articad.findings import Finding
from articad.kinematics.configuration import Configuration
from articad.kinematics.factors import svd
from articad.kinematics.loops import CLOSED, characteristic_length, damped_step

if TYPE_CHECKING:
    from articad.kinematics.mechanism import Mechanism

REACHED_MM = 1e-6  # a target this close is reached …
REACHED_RAD = 1e-9  # … and an orientation this close
_ITERATIONS = 150
_CLOSURE_WEIGHT = 10.0  # closing loops has priority over the target while both are open
_AT_LIMIT = 1e-9  # rad or mm: a coordinate this close to its limit is at it
_SAME = 1e-6  # rad, mm: the drivers alone must lead to the same configuration


@dataclass(frozen=True, eq=False)
class Reach:
    """How close a frame comes to a target.

    Attributes:
        q: Values of the drivers `(nq,)` [rad, mm].
        configuration: Coordinates of all joints.
        distance: Distance of the frame's origin from the target [mm].
        angle: Angle between the frame's axes and the target's [rad]; 0 if the target is a point.
        limits: Coordinates at a limit that stop it from coming closer; empty if the target is reached.
    """

    q: FloatArray
    configuration: Configuration
    distance: float
    angle: float
    limits: tuple[str, ...]

    @property
    def ok(self) -> bool:
        """True when the target is reached."""
        return self.distance <= REACHED_MM and self.angle <= REACHED_RAD


class _Task:
    """Target, loops and couplings as one residual in all freedoms, scaled by a length."""

    def __init__(self, mechanism: Mechanism, part: str, target: SE3, frame: SE3, *, oriented: bool) -> None:
        self.mechanism, self.index, self.target, self.frame, self.oriented = mechanism, mechanism.part_index(part), target, frame, oriented
        self.branch = None if mechanism.is_tree else mechanism.branch
        self.length = characteristic_length(mechanism.joints)  # of links, not of part frames, which may all coincide
        self.scale: FloatArray = np.where(mechanism.layout.is_length, self.length, 1.0)

    def evaluate(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        mechanism = self.mechanism
        T = mechanism.arrays.matrices(Q[None])
        v0, omega = (twist[:, 0] for twist in mechanism.arrays.twists(T, Q[None]))
        R = T[self.index, 0, :3, :3]
        point = R @ self.frame.translation + T[self.index, 0, :3, 3]
        carried = mechanism.arrays.carried[self.index][:, None]
        rows = [((v0 + quaternion.cross(omega, point)) * carried * self.scale[:, None]).T / self.length]
        r = [(point - self.target.translation) / self.length]
        if self.oriented:
            error = self.error(Q)[1]
            r.append(error)
            rows.append((omega * carried * self.scale[:, None]).T)
        if self.branch is not None:
            system = self.branch.system
            closure, J = system.evaluate_one(system.to_system(Q))
            wide = np.zeros((len(closure), mechanism.layout.n_freedoms))
            wide[:, system.freedoms] = J
            r.append(_CLOSURE_WEIGHT * closure)
            rows.append(_CLOSURE_WEIGHT * wide)
        return np.concatenate(r), np.concatenate(rows)

    def error(self, Q: FloatArray) -> tuple[float, FloatArray]:
        """Return the distance [mm] and the rotation vector [rad], in the ground frame, from the target to the frame."""
        placed = self.mechanism.arrays.poses(Q)[self.index] @ self.frame
        turn = quaternion.multiply(placed.quaternion, quaternion.conjugate(self.target.quaternion))
        return float(placed.distance_to(self.target)), quaternion.log(turn) if self.oriented else np.zeros(3)


def reach(
    mechanism: Mechanism,
    part: str,
    target: SE3 | npt.ArrayLike,
    frame: SE3,
    starts: int,
    accept: Callable[[FloatArray], bool] | None = None,
) -> Reach:
    """Bring a frame of a part to a target; see `Mechanism.reach`."""
    goal = target if isinstance(target, SE3) else SE3.from_translation(target)
    if goal.batch_shape:
        raise KinematicsError("One target at a time: a single pose or a point (3,).")
    task = _Task(mechanism, part, goal, frame, oriented=isinstance(target, SE3))
    rng = np.random.default_rng(0)
    best: Reach | None = None
    for start in range(starts + 1):
        if start == 0:
            Q = mechanism.layout.rest if mechanism.is_tree else mechanism.branch.Q_rest
        else:
            Q = Configuration.random(mechanism.joints, rng).columns
        found = _approached(task, Q)
        if found is not None and (best is None or found.distance + task.length * found.angle < best.distance + task.length * best.angle):
            best = found
        if found is not None and found.ok and (accept is None or accept(found.q)):
            return found
    if accept is not None and best is not None and best.ok:
        message = f"{part!r} reaches the target, but only in configurations that are not accepted."
        hint = "Move the target or the obstacle."
        finding = Finding(code="E_REACH_BARRED", where=f"parts.{part}", message=message, hint=hint, parts=(part,))
        raise KinematicsError(str(finding), findings=[finding])
    return best if best is not None else _at_rest(task)  # no start ended on the branch of the drivers


def _at_rest(task: _Task) -> Reach:
    mechanism = task.mechanism
    configuration = mechanism.configuration(mechanism.rest)
    distance, turn = task.error(configuration.columns)
    return Reach(mechanism.rest.copy(), configuration, distance, float(np.linalg.norm(turn)), ())


def _approached(task: _Task, Q: FloatArray) -> Reach | None:
    """Levenberg–Marquardt within the limits; None if the drivers' own branch does not lead to where it ends.

    y = −V diag(s/(s² + λ²)) Uᵀ r with λ = μ·min(1, |r|): defined at singular configurations too, such as a stretched arm.
    """
    mechanism, layout = task.mechanism, task.mechanism.layout
    Q = _clamped(mechanism, Q)
    r, J = task.evaluate(Q)
    norm, mu = float(np.linalg.norm(r)), 0.1
    for _ in range(_ITERATIONS):
        if norm < 1e-13:
            break
        # active set: a coordinate at its limit is held if the descent direction −Jᵀr would push it beyond
        free = ~_held(mechanism, Q, -(J.T @ r))
        if not free.any():
            break
        # damped step of the free coordinates, clamped to the limits; λ falls after a success and rises after a failure
        U, s, Vt = svd(J[:, free])
        y = np.zeros(layout.n_freedoms)
        y[free] = damped_step(s, U.T @ r, Vt, mu * min(1.0, norm))
        trial = _clamped(mechanism, layout.integrate(Q, y * task.scale))
        r_trial, J_trial = task.evaluate(trial)
        norm_trial = float(np.linalg.norm(r_trial))
        if norm_trial < norm:
            settled = norm - norm_trial < 1e-14 * norm
            Q, r, J, norm, mu = trial, r_trial, J_trial, norm_trial, mu * 0.2
            if settled:
                break
        elif mu > 1e10:
            break
        else:
            mu = mu * 8.0
    return _result(task, Q, J, r)


def _result(task: _Task, Q: FloatArray, J: FloatArray, r: FloatArray) -> Reach | None:
    mechanism = task.mechanism
    held = _held(mechanism, Q, -(J.T @ r))
    # close the loops to rounding, then ask the drivers for the same configuration: they must lead to it on their own branch
    if task.branch is not None:
        system = task.branch.system
        closed = system.close(system.to_system(Q), system.active)
        if closed.residual > CLOSED:
            return None
        Q = system.into_all(Q, closed.Q)
    q = Q[list(mechanism.driver_columns)]
    try:
        configuration = mechanism.configuration(q)
    except KinematicsError:
        return None
    # equal up to whole turns
    step = mechanism.layout.difference(configuration.columns, Q)
    angles = ~mechanism.layout.is_length
    step[angles] = np.mod(step[angles] + np.pi, 2 * np.pi) - np.pi
    if np.abs(step).max(initial=0.0) > _SAME or configuration.violations(1e-6):
        return None
    distance, turn = task.error(configuration.columns)
    found = Reach(q, configuration, distance, float(np.linalg.norm(turn)), ())
    if found.ok:
        return found
    names = tuple(_freedom_name(mechanism, int(f)) for f in np.flatnonzero(held))
    return Reach(q, configuration, distance, found.angle, tuple(dict.fromkeys(names)))


def _clamped(mechanism: Mechanism, Q: FloatArray) -> FloatArray:
    return Configuration(mechanism.joints, Q).clamp().columns


def _held(mechanism: Mechanism, Q: FloatArray, pull: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return which freedoms are at a limit and pulled beyond it; a ball's limits are enforced by clamping alone."""
    layout = mechanism.layout
    held = np.zeros(layout.n_freedoms, dtype=bool)
    for joint in mechanism.joints:
        if joint.type.quaternion is not None:
            continue
        columns, freedoms = layout.columns[joint.name], layout.freedoms[joint.name]
        value, force = Q[columns], pull[freedoms]
        low, high = np.array(joint.limits.lower), np.array(joint.limits.upper)
        held[freedoms] = ((value <= low + _AT_LIMIT) & (force < 0)) | ((value >= high - _AT_LIMIT) & (force > 0))
    return held


def _freedom_name(mechanism: Mechanism, freedom: int) -> str:
    layout = mechanism.layout
    return next(c.name for i, c in enumerate(layout.coordinates) if c.unit != "1" and layout.freedom_of(i) == freedom)
