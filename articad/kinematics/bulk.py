"""Poses of thousands of configurations: one joint after the other, each for all configurations at once.

Multiplying small matrices one by one costs more in calls than in arithmetic. Here every entry of a frame is a row over the
configurations, so a joint is a few products of its constants with rows, and of rows with each other. A frame is kept twice: as a matrix
`(3, 4, w)`, in which a motion mixes columns, and as a quaternion `(4, w)`, the form of a pose.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.kinematics.crossings import Crossings

_CHUNK = 4096  # configurations at a time: with fewer the calls dominate, with more the rows do not fit into the cache


class BulkPoses:
    """Computes the poses of the parts of a tree.

    Args:
        crossings: Its joints from the ground outwards.
        n_parts: Number of parts; each except the ground has one of the first crossings.
        ground: Index of the part that does not move.
        T_ground: Its pose.
    """

    def __init__(self, crossings: Crossings, n_parts: int, ground: int, T_ground: SE3) -> None:
        self._n_parts, self._ground, self._T_ground = n_parts, ground, T_ground
        self._steps = [_Step(crossings, k) for k in range(n_parts - 1)]
        self._slots = _slots([(step.near, step.far) for step in self._steps], ground)

    def __call__(self, Q: FloatArray) -> FloatArray:
        """Return poses `(batch, N, 7)` for coordinates `(batch, n_columns)`: a strided view, stored row by row."""
        out = np.empty((self._n_parts, 7, len(Q)))
        out[self._ground] = self._T_ground.data[:, None]
        for start in range(0, len(Q), _CHUNK):
            chunk = slice(start, start + _CHUNK)
            self._place(out[..., chunk], np.ascontiguousarray(Q[chunk].T))
        return np.moveaxis(out, 2, 0)

    def _place(self, out: FloatArray, q: FloatArray) -> None:
        """Write poses into `out` `(N, 7, w)` for coordinates as rows `(n_columns, w)`."""
        w = q.shape[1]
        scratch = _Scratch(w)
        frames = np.empty((max(self._slots, default=0) + 1, 3, 4, w))
        frames[self._slots[self._ground]] = self._T_ground.matrix[:3, :, None]
        for step in self._steps:
            T = frames[self._slots[step.far]]
            step.place(frames[self._slots[step.near]], out[step.near, 3:], T, out[step.far, 3:], q, scratch)
            out[step.far, :3] = T[:, 3]


def _slots(steps: Sequence[tuple[int, int]], ground: int) -> list[int]:
    """Return the buffer of each part's matrix; buffers of parts that carry no further part are reused, so that few are needed."""
    last = {near: k for k, (near, _) in enumerate(steps)}
    slots, free, n = {ground: 0}, list[int](), 1
    for k, (near, far) in enumerate(steps):
        if not free:
            free.append(n)
            n += 1
        slots[far] = free.pop()
        free += [slots[part] for part in {near, far} if last.get(part, -1) <= k]
    return [slots[part] for part in range(len(steps) + 1)]


class _Scratch:
    """Rows that every joint overwrites, of `w` configurations."""

    def __init__(self, w: int) -> None:
        self.frame, self.quaternion = np.empty((3, 4, w)), np.empty((4, w))
        self.a, self.b = np.empty((3, w)), np.empty((3, w))


class _Step:
    """One joint: T_far = T_near · A · J · B."""

    def __init__(self, crossings: Crossings, k: int) -> None:
        joint = crossings.joints[k]
        self.near, self.far, self._sign = crossings.near[k], crossings.far[k], float(crossings.sign[k])
        self._pitch = joint.lead / (2 * math.pi)
        self._first = int(crossings.first[k])
        self._moves = [(step, self._first + step.coordinate) for step in joint.type.steps if step.coordinate is not None]
        self._quaternion = None if joint.type.quaternion is None else self._first + joint.type.quaternion
        # a frame's rows times A are Aᵀ times its columns, and p ⊗ a is right(a) p
        self._A, self._B = _columns(crossings.A[k]), _columns(crossings.B[k])
        a, b = crossings.quaternions
        self._a, self._b = _right(a[k]), _right(b[k])

    def place(
        self, near: FloatArray, near_quaternion: FloatArray, far: FloatArray, far_quaternion: FloatArray, q: FloatArray, scratch: _Scratch
    ) -> None:
        """Write the far part's frame, given the near part's, for coordinates as rows `(n_columns, w)`."""
        frame, turned = scratch.frame, scratch.quaternion
        np.matmul(self._A, near, out=frame)
        np.matmul(self._a, near_quaternion, out=turned)
        for step, column in self._moves:
            value = q[column]
            if step.kind == "turn":
                _turn(frame, turned, step.axis, value * (0.25 * self._sign), scratch)
            else:
                share = self._sign * (self._pitch if step.advances else 1.0)
                frame[:, 3] += np.multiply(frame[:, step.axis], value * share, out=scratch.a)
        if self._quaternion is not None:
            turn = q[self._quaternion : self._quaternion + 4] * np.array([self._sign, self._sign, self._sign, 1.0])[:, None]
            _turn_freely(frame, turned, turn, scratch)
        np.matmul(self._B, frame, out=far)
        np.matmul(self._b, turned, out=far_quaternion)
        far_quaternion *= np.copysign(1.0, far_quaternion[3])


def _turn(frame: FloatArray, q: FloatArray, axis: int, quarter: FloatArray, scratch: _Scratch) -> None:
    """Turn frames `(3, 4, w)` and their quaternions `(4, w)` about one of their axes by four times the angle `quarter`, in place."""
    t = np.tan(quarter)  # vectorised in NumPy, while sine and cosine are several times slower
    k = 2.0 / (t * t + 1.0)
    c, s = k - 1.0, k * t  # c, s of the half angle
    twice = s + s
    cosine, sine = 1.0 - twice * s, twice * c
    i, j = (axis + 1) % 3, (axis + 2) % 3
    _mix(frame[:, i], frame[:, j], cosine, sine, scratch.a, scratch.b)
    _mix(q[i], q[j], c, s, scratch.a[0], scratch.b[0])
    _mix(q[axis], q[3], c, s, scratch.a[0], scratch.b[0])


def _mix(x: FloatArray, y: FloatArray, c: FloatArray, s: FloatArray, xs: FloatArray, ys: FloatArray) -> None:
    """Replace x by x c + y s and y by y c − x s."""
    np.multiply(x, s, out=xs)
    np.multiply(y, s, out=ys)
    x *= c
    x += ys
    y *= c
    y -= xs


def _turn_freely(frame: FloatArray, q: FloatArray, turn: FloatArray, scratch: _Scratch) -> None:
    """Turn frames `(3, 4, w)` and their quaternions `(4, w)` by the quaternions `turn` `(4, w)`, in place."""
    R = _rotation_rows(turn)
    axes = [frame[:, i].copy() for i in range(3)]
    for j in range(3):
        column = np.multiply(axes[0], R[j], out=frame[:, j])
        for i in (1, 2):
            column += np.multiply(axes[i], R[3 * i + j], out=scratch.a)
    (px, py, pz, pw), (x, y, z, w) = q.copy(), turn
    q[0] = pw * x + px * w + py * z - pz * y
    q[1] = pw * y - px * z + py * w + pz * x
    q[2] = pw * z + px * y - py * x + pz * w
    q[3] = pw * w - px * x - py * y - pz * z


def _rotation_rows(q: FloatArray) -> list[FloatArray]:
    """Return the nine numbers `(w,)` of the rotations of quaternions `(4, w)`, row by row."""
    x, y, z, w = q
    x2, y2, z2 = 2.0 * x, 2.0 * y, 2.0 * z
    xx, yy, zz = x * x2, y * y2, z * z2
    xy, xz, yz, wx, wy, wz = x * y2, x * z2, y * z2, w * x2, w * y2, w * z2
    return [1.0 - yy - zz, xy - wz, xz + wy, xy + wz, 1.0 - xx - zz, yz - wx, xz - wy, yz + wx, 1.0 - xx - yy]


def _columns(T: FloatArray) -> FloatArray:
    """Return the transpose of the first three rows of a homogeneous matrix."""
    M = np.eye(4)
    M[:, :3] = T.T
    return M


def _right(c: FloatArray) -> FloatArray:
    """Return the matrix with right(c) p = p ⊗ c."""
    x, y, z, w = c.tolist()
    return np.array([[w, z, -y, x], [-z, w, x, y], [y, -x, w, z], [-x, -y, -z, w]])
