"""Velocities that freedoms give to joints, in the ground frame."""

from __future__ import annotations

import math

import numpy as np

from articad.connectors import SE3, FloatArray, quaternion
from articad.kinematics.joints import JointType
from articad.kinematics.layout import Layout


class Twists:
    """Velocities that each freedom gives its joint's child side against its parent side, in the ground frame.

    Args:
        layout: Of the joints.
        part_index: Index of each part in the array of poses.
    """

    def __init__(self, layout: Layout, part_index: dict[str, int]) -> None:
        frames: list[int] = []  # joint of each frame
        self.planar: list[tuple[int, int]] = []  # frame to be shifted, first column
        self.universal: list[tuple[int, int]] = []  # frame to be turned, first column
        frame_of, axis_of, angular, pitch = [], [], [], []
        for k, joint in enumerate(layout.joints):
            frames.append(k)
            frame, first = len(frames) - 1, layout.columns[joint.name].start
            for axis, turns, advance, moved in _AXES[joint.type]:
                if moved:
                    frames.append(k)
                    (self.planar if joint.type is JointType.PLANAR else self.universal).append((len(frames) - 1, first))
                frame_of.append(len(frames) - 1 if moved else frame)
                axis_of.append(axis)
                angular.append(turns)
                pitch.append(advance * joint.lead / (2 * math.pi))
        joints = layout.joints
        self._part = np.array([part_index[joints[k].parent] for k in frames], dtype=np.intp)
        self._connector = _matrices([joints[k].T_parent_connector for k in frames])[:, None]
        self._frame = np.array(frame_of, dtype=np.intp)
        self._axis = np.array(axis_of, dtype=np.intp)
        self.angular = np.array(angular, dtype=np.float64)[:, None, None]
        self.linear = 1.0 - self.angular + np.array(pitch, dtype=np.float64)[:, None, None]

    def __call__(self, T: FloatArray, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return v0 [mm/s], the velocity at the ground's origin, and ω [rad/s], both `(n_freedoms, batch, 3)`.

        Args:
            T: Poses of the parts `(N, batch, 4, 4)`.
            Q: Coordinates `(batch, n_columns)`.
        """
        axes, origins = self.axes(T, Q)
        omega = axes * self.angular
        return quaternion.cross(origins, omega) + axes * self.linear, omega

    def axes(self, T: FloatArray, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the direction of each freedom and a point of its axis [mm], both `(n_freedoms, batch, 3)`."""
        P = T[self._part] @ self._connector
        for frame, first in self.planar:
            P[frame, :, :3, 3] += P[frame, :, :3, 0] * Q[:, first, None] + P[frame, :, :3, 1] * Q[:, first + 1, None]
        for frame, first in self.universal:
            a = Q[:, first, None]
            P[frame, :, :3, 1] = P[frame, :, :3, 1] * np.cos(a) + P[frame, :, :3, 2] * np.sin(a)
        return P[self._frame, :, :3, self._axis], P[self._frame, :, :3, 3]


def _matrices(poses: list[SE3]) -> FloatArray:
    return SE3.stack(poses).matrix if poses else np.zeros((0, 4, 4))


# axis of the parent connector, 1 = turns about it and 0 = slides along it, whether the lead advances it, whether other coordinates move it
_AXES: dict[JointType, tuple[tuple[int, int, int, bool], ...]] = {
    JointType.FIXED: (),
    JointType.REVOLUTE: ((2, 1, 0, False),),
    JointType.SLIDER: ((2, 0, 0, False),),
    JointType.CYLINDRICAL: ((2, 0, 0, False), (2, 1, 0, False)),
    JointType.BALL: ((0, 1, 0, False), (1, 1, 0, False), (2, 1, 0, False)),
    JointType.SCREW: ((2, 1, 1, False),),
    JointType.PLANAR: ((0, 0, 0, False), (1, 0, 0, False), (2, 1, 0, True)),
    JointType.UNIVERSAL: ((0, 1, 0, False), (1, 1, 0, True)),
}
