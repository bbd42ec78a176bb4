"""Layout: where each joint's coordinates and velocities stand in the arrays of all joints."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from articad.connectors import FloatArray, quaternion
from articad.errors import KinematicsError, UnknownJointError
from articad.kinematics.joints import Coordinate, Joint, JointType

_QUATERNION_TOLERANCE = 1e-3  # | ‖q‖ − 1 | of given coordinates: rounding passes, other quantities do not


class Layout:
    """Columns of coordinates and of freedoms of joints, in order of declaration.

    A freedom is a velocity: the derivative of a coordinate, but of a ball the angular velocity (x, y, z) of its child
    side against its parent side, in the parent connector's frame [rad/s].

    Args:
        joints: In order of declaration.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self.joints = tuple(joints)
        self.coordinates: tuple[Coordinate, ...] = tuple(c for joint in self.joints for c in joint.columns)
        self.columns: dict[str, slice] = {}
        self.freedoms: dict[str, slice] = {}
        column = freedom = 0
        for joint in joints:
            self.columns[joint.name] = slice(column, column + len(joint.type.coordinates))
            self.freedoms[joint.name] = slice(freedom, freedom + joint.type.freedoms)
            column, freedom = self.columns[joint.name].stop, self.freedoms[joint.name].stop
        self.n_columns, self.n_freedoms = column, freedom
        self.column_of = {c.name: i for i, c in enumerate(self.coordinates)}
        self.is_length = np.array([unit == "mm" for joint in joints for unit in joint.type.freedom_units], dtype=bool)
        self.balls = tuple((self.columns[j.name], self.freedoms[j.name]) for j in joints if j.type is JointType.BALL)
        plain = [j for j in joints if j.type is not JointType.BALL]
        self._plain_columns = _indices([self.columns[j.name] for j in plain])
        self._plain_freedoms = _indices([self.freedoms[j.name] for j in plain])
        self.rest: FloatArray = self.normalized(np.array([c.rest for c in self.coordinates], dtype=np.float64))

    def joint(self, name: str) -> Joint:
        """Return a joint by name.

        Raises:
            UnknownJointError: If there is none.
        """
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise UnknownJointError(name, self.columns)

    def freedom_of(self, column: int) -> int:
        """Return the freedom whose integral a column is; a ball's column gives the ball's first freedom."""
        joint = self.coordinates[column].joint
        first = self.columns[joint].start
        start: int = self.freedoms[joint].start
        return start + (0 if self.joint(joint).type is JointType.BALL else column - first)

    def column_of_freedom(self, freedom: int) -> int:
        """Return a column that a freedom moves; a ball's freedoms give its first three."""
        joint = next(joint for joint in self.joints if self.freedoms[joint.name].start <= freedom < self.freedoms[joint.name].stop)
        column: int = self.columns[joint.name].start + freedom - self.freedoms[joint.name].start
        return column

    def normalized(self, Q: FloatArray) -> FloatArray:
        """Return coordinates `(*batch, n_columns)` whose quaternions are of unit length.

        Raises:
            KinematicsError: E_NONFINITE; E_QUAT_NORM if a quaternion is off by more than 1e-3.
        """
        if not np.isfinite(Q).all():
            raise KinematicsError("E_NONFINITE: a coordinate is NaN or infinite.")
        for columns, _ in self.balls:
            q = Q[..., columns]
            norm = np.sqrt((q * q).sum(axis=-1, keepdims=True))
            if q.size and np.abs(norm - 1).max() > _QUATERNION_TOLERANCE:
                name = self.coordinates[columns.start].joint
                worst = float(norm.flat[np.argmax(np.abs(norm - 1))])
                raise KinematicsError(f"E_QUAT_NORM: ball {name!r} was given a quaternion of length {worst:.6g}; its length must be 1.")
            Q = Q.copy()
            Q[..., columns] = q / norm
        return Q

    def integrate(self, Q: FloatArray, step: FloatArray) -> FloatArray:
        """Return the coordinates `(*batch, n_columns)` after moving by `step` `(*batch, n_freedoms)`; balls by exp(step)."""
        if not self.balls:
            return Q + step
        moved = np.empty_like(np.broadcast_to(Q, (*np.broadcast_shapes(Q.shape[:-1], step.shape[:-1]), self.n_columns)))
        moved[..., self._plain_columns] = Q[..., self._plain_columns] + step[..., self._plain_freedoms]
        for columns, freedoms in self.balls:
            turned = quaternion.multiply(quaternion.exp(step[..., freedoms]), Q[..., columns])
            moved[..., columns] = quaternion.normalized(turned)
        return moved

    def difference(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return the step `(*batch, n_freedoms)` that leads from `start` to `end`; balls the short way."""
        if not self.balls:
            return end - start
        batch = np.broadcast_shapes(start.shape[:-1], end.shape[:-1])
        step = np.empty((*batch, self.n_freedoms))
        step[..., self._plain_freedoms] = end[..., self._plain_columns] - start[..., self._plain_columns]
        for columns, freedoms in self.balls:
            turn = quaternion.multiply(end[..., columns], quaternion.conjugate(start[..., columns]))
            step[..., freedoms] = quaternion.log(turn)
        return step


def _indices(slices: Sequence[slice]) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    return np.array([i for part in slices for i in range(part.start, part.stop)], dtype=np.intp)
