"""Velocities that freedoms give to joints, in the ground frame."""

from __future__ import annotations

import math

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3, quaternion
from articad.kinematics.joints import Step
from articad.kinematics.layout import Layout


class Twists:
    """Velocities that each freedom gives its joint's child side against its parent side, in the ground frame.

    Args:
        layout: Layout of the joints.
        part_index: Index of each part in the array of poses.
    """

    def __init__(self, layout: Layout, part_index: dict[str, int]) -> None:
        frames: list[int] = []  # joint of each frame
        self._moved: list[tuple[int, Step, int]] = []  # frame that a step moves, in order; the step, the column of its value
        frame_of, axis_of, angular, pitch = [], [], [], []
        for k, joint in enumerate(layout.joints):
            frames.append(k)
            frame, first = len(frames) - 1, layout.columns[joint.name].start
            before: list[Step] = []  # steps that move the axis of the next one
            for step in joint.type.steps:
                if step.advances:  # the slide of a screw belongs to its turn
                    continue
                carried = [one for one in before if _moves_axis(one, step)]
                if carried:
                    frames.append(k)
                    self._moved += [(len(frames) - 1, one, first + one.coordinate) for one in carried if one.coordinate is not None]
                frame_of.append(len(frames) - 1 if carried else frame)
                axis_of.append(step.axis)
                angular.append(float(step.kind == "turn"))
                pitch.append(joint.lead / (2 * math.pi) if any(one.advances for one in joint.type.steps) else 0.0)
                if step.coordinate is not None:  # a quaternion turns by its angular velocity in the frame before it
                    before.append(step)
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
        for frame, step, column in self._moved:
            value, axes = Q[:, column, None], P[frame]
            if step.kind == "slide":
                axes[:, :3, 3] += axes[:, :3, step.axis] * value
            else:
                i, j = (step.axis + 1) % 3, (step.axis + 2) % 3
                cosine, sine, x, y = np.cos(value), np.sin(value), axes[:, :3, i].copy(), axes[:, :3, j].copy()
                axes[:, :3, i], axes[:, :3, j] = x * cosine + y * sine, y * cosine - x * sine
        return P[self._frame, :, :3, self._axis], P[self._frame, :, :3, 3]


def _moves_axis(before: Step, step: Step) -> bool:
    """Return whether a step moves the axis of a later one: if their axes differ and one of the two is a turn."""
    return before.axis != step.axis and (before.kind == "turn" or step.kind == "turn")


def _matrices(poses: list[SE3]) -> FloatArray:
    return SE3.stack(poses).matrix if poses else np.zeros((0, 4, 4))
