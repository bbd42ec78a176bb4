"""Layout: the places of each joint's coordinates and velocities in the arrays of all joints."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import accumulate

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray, IndexArray
from articad.connectors import quaternion
from articad.errors import KinematicsError, UnknownJointError
from articad.kinematics.joints import Coordinate, Joint, JointType

QUATERNION_TOLERANCE = 1e-3  # | ‖q‖ − 1 | of given coordinates: rounding passes, other quantities do not
_N_COLUMNS = {joint_type: len(joint_type.coordinates) for joint_type in JointType}
_N_FREEDOMS = {joint_type: joint_type.freedoms for joint_type in JointType}


class Layout:
    """Columns of coordinates and of freedoms of joints, in the order in which they are declared.

    A freedom is a velocity: the derivative of a coordinate, or for a quaternion the angular velocity (x, y, z) of its joint's child side
    relative to its parent side, in the parent connector's frame [rad/s].

    Args:
        joints: In the order in which they are declared.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self.joints = tuple(joints)
        self._types = [joint.type for joint in joints]
        self._starts = list(accumulate(map(_N_COLUMNS.__getitem__, self._types), initial=0))
        self._own = list(accumulate(map(_N_FREEDOMS.__getitem__, self._types), initial=0))
        self.n_columns, self.n_freedoms = self._starts[-1], self._own[-1]

    @cached_property
    def first(self) -> dict[str, int]:
        """First column of each joint, by name."""
        return dict(zip(self._names, self._starts, strict=False))

    @cached_property
    def columns(self) -> dict[str, slice]:
        """Columns of each joint, by name."""
        return dict(zip(self._names, map(slice, self._starts, self._starts[1:]), strict=False))

    @cached_property
    def freedoms(self) -> dict[str, slice]:
        """Freedoms of each joint, by name."""
        return dict(zip(self._names, map(slice, self._own, self._own[1:]), strict=False))

    @cached_property
    def _names(self) -> list[str]:
        return [joint.name for joint in self.joints]

    @cached_property
    def _ball_columns(self) -> IndexArray:
        return _runs(_quaternions(self._starts, self._types), 4)

    @cached_property
    def _ball_freedoms(self) -> IndexArray:
        return _runs(_quaternions(self._own, self._types), 3)

    @cached_property
    def rest(self) -> FloatArray:
        """Coordinates at rest `(n_columns,)`."""
        return self.normalized(np.array([value for joint in self.joints for value in joint.rest], dtype=np.float64))

    @cached_property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The columns."""
        return tuple(c for joint in self.joints for c in joint.columns)

    @cached_property
    def column_of(self) -> dict[str, int]:
        """Place of each column by name."""
        return {c.name: i for i, c in enumerate(self.coordinates)}

    @cached_property
    def is_length(self) -> npt.NDArray[np.bool_]:
        """True for freedoms in mm `(n_freedoms,)`."""
        return np.array([unit == "mm" for joint in self.joints for unit in joint.type.freedom_units], dtype=bool)

    @cached_property
    def ball_freedoms(self) -> frozenset[int]:
        """Rotational freedoms of balls and free joints."""
        return frozenset(self._ball_freedoms.ravel().tolist())

    @cached_property
    def _plain(self) -> tuple[IndexArray, IndexArray]:
        """Columns and freedoms that are not part of a quaternion or its rotation."""
        all_columns, all_freedoms = np.arange(self.n_columns), np.arange(self.n_freedoms)
        return np.setdiff1d(all_columns, self._ball_columns), np.setdiff1d(all_freedoms, self._ball_freedoms)

    def joint(self, name: str) -> Joint:
        """Return a joint by name.

        Raises:
            UnknownJointError: If there is no such joint.
        """
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise UnknownJointError(name, self.columns)

    def freedom_of(self, column: int) -> int:
        """Return the freedom whose integral a column is; a quaternion's column gives the first of its three turns."""
        joint = self.coordinates[column].joint
        first = self.columns[joint].start
        start: int = self.freedoms[joint].start
        at, turns_at = column - first, self.joint(joint).type.quaternion
        freedom: int = start + (at if turns_at is None else min(at, turns_at))
        return freedom

    def column_of_freedom(self, freedom: int) -> int:
        """Return a column that a freedom moves; for a quaternion's turns these are its first three."""
        joint = next(joint for joint in self.joints if self.freedoms[joint.name].start <= freedom < self.freedoms[joint.name].stop)
        column: int = self.columns[joint.name].start + freedom - self.freedoms[joint.name].start
        return column

    def normalized(self, Q: FloatArray) -> FloatArray:
        """Return coordinates `(*batch, n_columns)` with their quaternions normalised to unit length.

        Raises:
            KinematicsError: E_NONFINITE; E_QUAT_NORM if a quaternion is off by more than 1e-3.
        """
        if not np.isfinite(Q).all():
            raise KinematicsError("E_NONFINITE: a coordinate is NaN or infinite.")
        if self._ball_columns.size:
            q = Q[..., self._ball_columns]
            norm = np.sqrt((q * q).sum(axis=-1, keepdims=True))
            off = np.abs(norm - 1)
            if off.max(initial=0.0) > QUATERNION_TOLERANCE:
                worst = np.unravel_index(np.argmax(off), off.shape)
                name, length = self.coordinates[self._ball_columns[worst[-2], 0]].joint, float(norm[worst])
                raise KinematicsError(f"E_QUAT_NORM: joint {name!r} was given a quaternion of length {length:.6g}; its length must be 1.")
            Q = Q.copy()
            Q[..., self._ball_columns] = q / norm
        return Q

    def integrate(self, Q: FloatArray, step: FloatArray) -> FloatArray:
        """Return the coordinates `(*batch, n_columns)` after moving by `step` `(*batch, n_freedoms)`; quaternions by exp(step)."""
        if not self._ball_columns.size:
            return Q + step
        columns, freedoms = self._plain
        plain = Q[..., columns] + step[..., freedoms]
        moved = np.empty((*plain.shape[:-1], self.n_columns))
        moved[..., columns] = plain
        turned = quaternion.multiply(quaternion.exp(step[..., self._ball_freedoms]), Q[..., self._ball_columns])
        moved[..., self._ball_columns] = quaternion.normalized(turned)
        return moved

    def difference(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return the step `(*batch, n_freedoms)` that leads from `start` to `end`; quaternions by the smaller angle."""
        if not self._ball_columns.size:
            return end - start
        columns, freedoms = self._plain
        step = np.empty((*np.broadcast_shapes(start.shape[:-1], end.shape[:-1]), self.n_freedoms))
        step[..., freedoms] = end[..., columns] - start[..., columns]
        turn = quaternion.multiply(end[..., self._ball_columns], quaternion.conjugate(start[..., self._ball_columns]))
        step[..., self._ball_freedoms] = quaternion.log(turn)
        return step


def _quaternions(starts: Sequence[int], types: Sequence[JointType]) -> list[int]:
    """Return the first indices of the quaternions, or of their turns, of joints that start at these places."""
    return [start + kind.quaternion for start, kind in zip(starts, types, strict=False) if kind.quaternion is not None]


def _runs(starts: Sequence[int], length: int) -> IndexArray:
    """Return `length` indices from each start `(starts, length)`."""
    runs: IndexArray = np.array(starts, dtype=np.intp)[:, None] + np.arange(length)
    return runs
