"""Forward kinematics in NumPy: poses and velocities of all parts for many configurations at once.

Two ways to the same poses. `matrices` multiplies homogeneous matrices: few calls per joint, right for few configurations
and for the loop solver. `poses` with many configurations works on rows of quaternion components, one GEMM per joint,
because 10,000 small matrix products cost more than their arithmetic. Pinocchio is the oracle of both in the tests.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from articad.connectors import SE3, FloatArray, quaternion
from articad.kinematics.crossings import Crossing, Crossings, Transforms
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.tree import KinematicTree
from articad.kinematics.twists import Twists

_FEW = 32  # configurations up to which matrices win over rows (measured: break-even 25 … 50)
_CHUNK = 512  # configurations per pass: the rows of one joint then stay in the first-level cache


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
        near = [index[edge.parent] for edge in edges]
        far = [index[edge.part] for edge in edges]
        self.compiled = Crossings(
            [*(edge.joint for edge in edges), *closing],
            near + [index[joint.parent] for joint in closing],
            [*far, *range(self.n_parts, self.n_parts + len(closing))],
            [edge.joint.parent != edge.parent for edge in edges] + [False] * len(closing),
            layout,
        )
        self._n_edges = len(edges)
        self._steps = tuple(zip(self.compiled.near, self.compiled.far, strict=True))

    @cached_property
    def _transforms(self) -> Transforms:
        return Transforms(self.compiled)

    @cached_property
    def _ground_matrix(self) -> FloatArray:
        return self.T_ground.matrix

    @property
    def crossings(self) -> tuple[Crossing, ...]:
        """The tree's joints one by one, depth first."""
        return self.compiled.rows[: self._n_edges]

    @property
    def closing(self) -> tuple[Crossing, ...]:
        """The joints that close loops."""
        return self.compiled.rows[self._n_edges :]

    @cached_property
    def twists(self) -> Twists:
        """Velocities of the freedoms."""
        return Twists(self.layout, {part: i for i, part in enumerate(self.parts)})

    @cached_property
    def carried(self) -> FloatArray:
        """±1 where a freedom moves a part, −1 where it is crossed backwards: `(N, n_freedoms)`; 11 MB for 1000 parts, so made when asked."""
        c, carried = self.compiled, np.zeros((self.n_parts, self.layout.n_freedoms))
        for k in range(self._n_edges):
            carried[c.far[k]] = carried[c.near[k]]
            carried[c.far[k], self.layout.freedoms[c.joints[k].name]] = c.sign[k]
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
