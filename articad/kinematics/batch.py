"""Forward kinematics in NumPy: poses and velocities of all parts for many configurations at once.

Two ways to the same poses. `matrices` multiplies homogeneous matrices: few calls per joint, right for few configurations
and for the loop solver. `poses` with many configurations works on rows of quaternion components, one GEMM per joint,
because 10,000 small matrix products cost more than their arithmetic. Pinocchio is the oracle of both in the tests.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple, overload

import numpy as np
import numpy.typing as npt

from articad.connectors import SE3, FloatArray, Mate, flip, quaternion
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.tree import KinematicTree

IndexArray = npt.NDArray[np.intp]

_FEW = 32  # configurations up to which matrices win over rows (measured: break-even 25 … 50)
_CHUNK = 512  # configurations per pass: the rows of one joint then stay in the first-level cache
TURNING = frozenset({JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW})


class Crossing(NamedTuple):
    """A joint as it is crossed from `near` to `far`: T_far = T_near · A · M(signs ∘ q) · B."""

    joint: Joint
    near: int
    far: int
    backwards: bool
    signs: FloatArray
    A: SE3
    B: SE3


class Crossings(Sequence[Crossing]):
    """Joints as a tree crosses them, their constants computed together.

    Args:
        joints: As declared.
        near: Index of the part from which each is crossed.
        far: Index of the part to which it leads.
        backwards: True where it is crossed from its declared child.
    """

    def __init__(self, joints: Sequence[Joint], near: Sequence[int], far: Sequence[int], backwards: Sequence[bool]) -> None:
        C_p = _stack([joint.T_parent_connector for joint in joints])
        flipped = _stack([joint.T_child_connector for joint in joints]) @ _stack(
            [flip(joint.mate) for joint in joints]
        )  # F is its own inverse
        back = np.array(backwards, dtype=bool)[:, None]
        # T_c = T_p · C_p · J · (C_c F)⁻¹, and T_p = T_c · C_c F · J⁻¹ · C_p⁻¹
        self.A = SE3.from_unit_array(np.where(back, flipped.data, C_p.data))
        self.B = SE3.from_unit_array(np.where(back, C_p.data, flipped.data)).inverse()
        signs = [
            joint.type.reversal_signs(Mate.ALIGNED) if b else np.ones(len(joint.rest)) for joint, b in zip(joints, backwards, strict=True)
        ]
        self._rows = tuple(
            Crossing(
                joint, near[k], far[k], backwards[k], signs[k], SE3.from_unit_array(self.A.data[k]), SE3.from_unit_array(self.B.data[k])
            )
            for k, joint in enumerate(joints)
        )

    @overload
    def __getitem__(self, index: int) -> Crossing: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Crossing, ...]: ...
    def __getitem__(self, index: int | slice) -> Crossing | tuple[Crossing, ...]:
        return self._rows[index]

    def __len__(self) -> int:
        return len(self._rows)


def _stack(poses: Sequence[SE3]) -> SE3:
    return SE3.stack(poses) if poses else SE3.identity((0,))


class Transforms:
    """A · J(q) · B of many crossings as matrices.

    A joint that turns and slides about its z axis is affine in (1, cos θ, sin θ, d), so all of these are one product with
    constants; the others are filled one by one.

    Args:
        crossings: The joints.
        layout: Of the coordinates that are given.
    """

    def __init__(self, crossings: Crossings, layout: Layout) -> None:
        n = len(crossings)
        A, B = crossings.A.matrix, crossings.B.matrix
        self._angle, self._travel = np.zeros(n, dtype=np.intp), np.zeros(n, dtype=np.intp)  # columns; the factor is 0 where there is none
        self._turns, self._slides = np.zeros((n, 1)), np.zeros((n, 1))
        self._constants = (A[:, None] @ _AFFINE @ B[:, None]).reshape(n, 4, 16)
        self._others: list[tuple[int, JointType, slice, FloatArray, FloatArray, FloatArray]] = []
        for k, c in enumerate(crossings):
            columns = layout.columns[c.joint.name]
            if c.joint.type in {JointType.BALL, JointType.PLANAR, JointType.UNIVERSAL}:
                self._others.append((k, c.joint.type, columns, c.signs, A[k], B[k]))
                continue
            if c.joint.type in TURNING:
                self._angle[k], self._turns[k] = columns.stop - 1, c.signs[-1]
            if c.joint.type is JointType.SCREW:
                self._travel[k], self._slides[k] = columns.start, c.signs[0] * c.joint.lead / (2 * math.pi)
            elif c.joint.type in {JointType.SLIDER, JointType.CYLINDRICAL}:
                self._travel[k], self._slides[k] = columns.start, c.signs[0]

    def __call__(self, rows: FloatArray) -> FloatArray:
        """Return `(n_joints, batch, 4, 4)` for coordinates as rows `(n_columns, batch)`."""
        n, batch = len(self._angle), rows.shape[1]
        if not rows.shape[0]:
            rows = np.zeros((1, batch))  # fixed joints alone: their factors are zero
        factors = np.empty((n, batch, 4))
        angle = rows[self._angle] * self._turns
        factors[..., 0], factors[..., 1], factors[..., 2] = 1.0, np.cos(angle), np.sin(angle)
        factors[..., 3] = rows[self._travel] * self._slides
        X: FloatArray = (factors @ self._constants).reshape(n, batch, 4, 4)
        for k, joint_type, columns, signs, A, B in self._others:
            X[k] = A @ _motion(joint_type, rows[columns] * signs[:, None]) @ B
        return X


# the motion about and along z is [0] + cos θ [1] + sin θ [2] + d [3]
_AFFINE = np.zeros((4, 4, 4))
_AFFINE[0, (2, 3), (2, 3)] = 1.0
_AFFINE[1, (0, 1), (0, 1)] = 1.0
_AFFINE[2, (1, 0), (0, 1)] = 1.0, -1.0
_AFFINE[3, 2, 3] = 1.0


def _motion(joint_type: JointType, rows: FloatArray) -> FloatArray:
    """Return J(q) `(batch, 4, 4)` of a ball, planar or universal joint for its coordinates as rows."""
    M = np.zeros((rows.shape[1], 4, 4))
    M[:, (0, 1, 2, 3), (0, 1, 2, 3)] = 1.0
    if joint_type is JointType.BALL:
        M[:, :3, :3] = quaternion.to_matrix(rows.T)
    elif joint_type is JointType.UNIVERSAL:
        M[:, :3, :3] = _universal(rows[0], rows[1])
    else:
        cosine, sine = np.cos(rows[2]), np.sin(rows[2])
        M[:, 0, 0], M[:, 1, 1], M[:, 1, 0], M[:, 0, 1] = cosine, cosine, sine, -sine
        M[:, 0, 3], M[:, 1, 3] = rows[0], rows[1]
    return M


def _universal(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return Rx(a) Ry(b) `(batch, 3, 3)`."""
    ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
    zero = np.zeros_like(a)
    return np.stack([cb, zero, sb, sa * sb, ca, -sa * cb, -ca * sb, sa, ca * cb], axis=-1).reshape(-1, 3, 3)


class TreeArrays:
    """A tree compiled for arithmetic.

    Args:
        parts: In the order in which poses are returned.
        tree: How the parts hang together.
        layout: Of all coordinates; the tree's joints are among them.
        T_ground: Pose of the ground part.
        closing: Joints that close loops: each adds a ghost of its child behind the parts in `matrices`.
    """

    def __init__(self, parts: Sequence[str], tree: KinematicTree, layout: Layout, T_ground: SE3, closing: Sequence[Joint] = ()) -> None:
        index = {part: i for i, part in enumerate(parts)}
        self.parts = tuple(parts)
        self.layout = layout
        self.n_parts = len(parts)
        self.ground = index[tree.ground]
        self.T_ground = T_ground
        edges = tree.edges
        near = [*(index[edge.parent] for edge in edges), *(index[joint.parent] for joint in closing)]
        far = [*(index[edge.part] for edge in edges), *(self.n_parts + i for i in range(len(closing)))]
        backwards = [*(edge.reversed for edge in edges), *(False for _ in closing)]
        crossings = Crossings([*(edge.joint for edge in edges), *closing], near, far, backwards)
        self.crossings, self.closing = crossings[: len(edges)], crossings[len(edges) :]
        self._transforms = Transforms(crossings, layout)
        self._steps = tuple(zip(near, far, strict=True))
        self._ground_matrix = T_ground.matrix
        self.twists = Twists(layout, index)
        self._backwards = tuple(backwards[: len(edges)])

    @cached_property
    def carried(self) -> FloatArray:
        """±1 where a freedom moves a part, −1 where it is crossed backwards: `(N, n_freedoms)`; 11 MB for 1000 parts, so made when asked."""
        carried = np.zeros((self.n_parts, self.layout.n_freedoms))
        for c, backwards in zip(self.crossings, self._backwards, strict=True):
            carried[c.far] = carried[c.near]
            carried[c.far, self.layout.freedoms[c.joint.name]] = -1.0 if backwards else 1.0
        return carried

    @cached_property
    def _rows(self) -> list[_RowStep]:
        return [_RowStep(c, self.layout.columns[c.joint.name]) for c in self.crossings]

    def matrices(self, Q: FloatArray) -> FloatArray:
        """Return the poses of all parts, then of all ghosts, as `(N, batch, 4, 4)` for coordinates `(batch, n_columns)`."""
        T = np.empty((len(self._steps) + 1, len(Q), 4, 4))
        T[self.ground] = self._ground_matrix
        X = self._transforms(Q.T)
        for k, (near, far) in enumerate(self._steps):
            np.matmul(T[near], X[k], out=T[far])
        return T

    def poses(self, Q: FloatArray) -> SE3:
        """Return the poses `(*batch, N)` of all parts for coordinates `(*batch, n_columns)`."""
        flat = Q.reshape(math.prod(Q.shape[:-1]), self.layout.n_columns)
        if len(flat) <= _FEW:
            T = self.matrices(flat)
            out = np.empty((self.n_parts, len(flat), 7))
            out[..., :3] = T[..., :3, 3]
            out[..., 3:] = quaternion.positive(quaternion.from_matrix(T[..., :3, :3]))
            return SE3.from_unit_array(out.swapaxes(0, 1).reshape(*Q.shape[:-1], self.n_parts, 7))
        rows = np.empty((self.n_parts, 7, len(flat)))
        for start in range(0, len(flat), _CHUNK):
            self._fill(rows[..., start : start + _CHUNK], np.ascontiguousarray(flat[start : start + _CHUNK].T))
        return SE3.from_unit_array(np.moveaxis(rows, 2, 0).reshape(*Q.shape[:-1], self.n_parts, 7))

    def _fill(self, out: FloatArray, q: FloatArray) -> None:
        """Write the poses of one chunk into `out` `(N, 7, chunk)` for coordinates as rows `(n_columns, chunk)`."""
        out[self.ground] = self.T_ground.data[:, None]
        for step in self._rows:
            step.place(out[step.near], out[step.far], q)
            out[step.far, 3:] *= np.copysign(1.0, out[step.far, 6])  # while it is in the cache


class _RowStep:
    """One joint of the row-wise pass: constants such that only products with rows of coordinates are left.

    With p ⊗ c = right(c) p, the far quaternion of a turning joint is cos(θ/2)·right(a ⊗ b) p + sin(θ/2)·right(a ⊗ k ⊗ b) p.
    """

    def __init__(self, c: Crossing, columns: slice) -> None:
        self.near, self.far, self.type, self.columns, self.signs = c.near, c.far, c.joint.type, columns, c.signs
        self.pitch = c.joint.lead / (2 * math.pi)
        a, b = c.A.quaternion, c.B.quaternion
        k = np.array([0.0, 0.0, 1.0, 0.0])
        self.right_a, self.right_b = _right(a), _right(b)
        ab = quaternion.multiply(a, b)
        self.right_ab = _right(ab)
        self.right_both = np.concatenate([self.right_ab, _right(quaternion.multiply(quaternion.multiply(a, k), b))])
        RA, pA, pB = c.A.rotation, c.A.translation, c.B.translation
        self.RA, self.pA, self.pB = RA, pA[:, None], pB[:, None]
        self.axis = RA[:, 2:]
        # A · Rz(θ) · pB = [still, cos, sin] · (1, cos θ, sin θ)
        self.still = (pA + RA[:, 2] * pB[2])[:, None]
        self.arc = RA @ np.array([[pB[0], -pB[1]], [pB[1], pB[0]], [0.0, 0.0]])
        self.fixed_offset = (pA + RA @ pB)[:, None]

    def place(self, near: FloatArray, far: FloatArray, q: FloatArray) -> None:
        """Write the pose of the far part, `(7, chunk)`, given the near part's."""
        mine = q[self.columns]
        if self.type in {JointType.FIXED, JointType.SLIDER}:
            np.matmul(self.right_ab, near[3:], out=far[3:])
            offset = self.fixed_offset if self.type is JointType.FIXED else self.fixed_offset + self.axis * (mine[0] * self.signs[0])
        elif self.type in {JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW}:
            offset = self._turn(near, far, mine)
        else:
            offset = self._general(near, far, mine)
        u, w = near[3:6], near[6]
        twice = 2.0 * _row_cross(u, offset)
        far[:3] = near[:3] + offset + w * twice + _row_cross(u, twice)

    def _turn(self, near: FloatArray, far: FloatArray, mine: FloatArray) -> FloatArray:
        angle = mine[-1] * self.signs[-1]
        c, s = np.cos(0.5 * angle), np.sin(0.5 * angle)
        both = self.right_both @ near[3:]
        both[:4] *= c
        both[4:] *= s
        np.add(both[:4], both[4:], out=far[3:])
        offset = self.still + self.arc @ np.stack([c * c - s * s, 2.0 * (c * s)])
        if self.type is JointType.CYLINDRICAL:
            offset += self.axis * (mine[0] * self.signs[0])
        elif self.type is JointType.SCREW:
            offset += self.axis * (angle * self.pitch)
        carried: FloatArray = offset
        return carried

    def _general(self, near: FloatArray, far: FloatArray, mine: FloatArray) -> FloatArray:
        shift = np.zeros((3, mine.shape[1]))
        if self.type is JointType.BALL:
            turn = mine * self.signs[:, None]
        elif self.type is JointType.PLANAR:
            shift[:2] = mine[:2]
            turn = np.zeros((4, mine.shape[1]))
            turn[2], turn[3] = np.sin(0.5 * mine[2]), np.cos(0.5 * mine[2])
        else:
            (sa, sb), (ca, cb) = np.sin(0.5 * mine), np.cos(0.5 * mine)
            turn = np.stack([sa * cb, ca * sb, sa * sb, ca * cb])
        middle = quaternion.multiply((self.right_a @ near[3:]).T, turn.T)
        np.matmul(self.right_b, middle.T, out=far[3:])
        carried = np.broadcast_to(self.pB, shift.shape)
        twice = 2.0 * _row_cross(turn[:3], carried)
        offset: FloatArray = self.pA + self.RA @ (shift + carried + turn[3] * twice + _row_cross(turn[:3], twice))
        return offset


def _right(c: FloatArray) -> FloatArray:
    """Return the matrix with right(c) p = p ⊗ c."""
    x, y, z, w = c
    return np.array([[w, z, -y, x], [-z, w, x, y], [y, -x, w, z], [-x, -y, -z, w]])


def _row_cross(a: FloatArray, b: FloatArray) -> FloatArray:
    out = np.empty((3, max(a.shape[1], b.shape[1])))
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return out


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
        self._connector = _stack([joints[k].T_parent_connector for k in frames]).matrix[:, None]
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
