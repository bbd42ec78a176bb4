"""Joints as a tree crosses them, compiled together: the constants of thousands of joints in one pass of NumPy."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from articad.arrays import FloatArray, IndexArray
from articad.connectors import SE3, Mate, flip, quaternion
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.layout import Layout

# types that do more than turn about and slide along their z axis, and the motions of the others
GENERAL = tuple(kind for kind in JointType if any(step.axis != 2 for step in kind.steps))
TURNING = frozenset(kind for kind in JointType if kind not in GENERAL and any(step.kind == "turn" for step in kind.steps))
SLIDING = frozenset(kind for kind in JointType if kind not in GENERAL and any(step.kind == "slide" for step in kind.steps))
_FEW = 500  # quaternions whose squares fit into the cache (measured break-even: 500 … 1000)
_CODE = {joint_type: i for i, joint_type in enumerate(JointType)}
_TURNS = np.array([joint_type in TURNING for joint_type in JointType])
_SLIDES = np.array([joint_type in SLIDING for joint_type in JointType])
_N_COLUMNS = np.array([len(joint_type.coordinates) for joint_type in JointType], dtype=np.intp)


class Crossing(NamedTuple):
    """A joint as it is crossed from `near` to `far`: T_far = T_near · A · M(signs ∘ q) · B."""

    joint: Joint
    near: int
    far: int
    backwards: bool
    signs: FloatArray
    A: SE3
    B: SE3


class Crossings:
    """Joints that are crossed one after the other.

    Args:
        joints: As declared.
        near: Index of the part from which each is crossed.
        far: Index of the part to which it leads.
        backwards: True where it is crossed from its declared child.
        layout: Layout of the coordinates.

    Attributes:
        sign: −1 where a joint is crossed backwards, else 1 `(n,)`.
        A: Frame of the near connector in the near part `(n, 3, 4)`.
        B: The far part in the frame of its connector `(n, 3, 4)`.
        angle: Column of the angle about z; 0 where there is none `(n,)`.
        turn: Factor of that column; 0 where there is none `(n,)`.
        travel: Column of the travel along z; for a screw that of its angle; 0 where there is none `(n,)`.
        slide: Factor of that column; 0 where there is none `(n,)`.
    """

    def __init__(self, joints: Sequence[Joint], near: Sequence[int], far: Sequence[int], backwards: Sequence[bool], layout: Layout) -> None:
        self.joints, self.near, self.far, self.backwards = tuple(joints), tuple(near), tuple(far), np.array(backwards, dtype=bool)
        self.sign: FloatArray = np.where(self.backwards, -1.0, 1.0)
        self._codes = np.array([_CODE[joint.type] for joint in joints], dtype=np.intp)
        self._place_coordinates(layout)
        self.A, self.B = self._frames()

    def __len__(self) -> int:
        return len(self.joints)

    def _place_coordinates(self, layout: Layout) -> None:
        starts = layout.first
        first = np.array([starts.get(joint.name, 0) for joint in self.joints], dtype=np.intp)  # joints that are held fixed have none
        turns, slides = _TURNS[self._codes], _SLIDES[self._codes]
        self.first: IndexArray = first
        self.angle: IndexArray = np.where(turns, first + _N_COLUMNS[self._codes] - 1, 0)
        self.travel: IndexArray = np.where(slides, first, 0)
        self.turn: FloatArray = self.sign * turns
        self.slide: FloatArray = self.sign * slides
        screws = self.of_type(JointType.SCREW)
        if screws.size:
            self.slide[screws] *= [self.joints[k].lead / (2 * math.pi) for k in screws.tolist()]

    def of_type(self, joint_type: JointType) -> IndexArray:
        """Return which joints are of a type."""
        return np.flatnonzero(self._codes == _CODE[joint_type])

    def _frames(self) -> tuple[FloatArray, FloatArray]:
        """Return A and B: T_c = T_p · C_p · J · (C_c F)⁻¹, and backwards T_p = T_c · C_c F · J⁻¹ · C_p⁻¹."""
        n = len(self.joints)
        near, far = np.zeros((2, n, 3, 4))
        if not n:
            return near, far
        C = _stacked([joint.T_parent_connector.data for joint in self.joints] + [joint.T_child_connector.data for joint in self.joints])
        C = C.reshape(2, n, 7)
        R, p = rotations(C[..., 3:]), C[..., :3]
        if Mate.OPPOSED in (mates := [joint.mate for joint in self.joints]):
            R[1, [mate is Mate.OPPOSED for mate in mates], :, 1:] *= -1.0
        if self.backwards.any():
            p = p.copy()
            R[:, self.backwards], p[:, self.backwards] = R[::-1, self.backwards], p[::-1, self.backwards]
        near[..., :3], near[..., 3] = R[0], p[0]
        far[..., :3], far[..., 3] = R[1].swapaxes(-1, -2), -(p[1][:, None] @ R[1])[:, 0]
        return near, far

    @cached_property
    def quaternions(self) -> tuple[FloatArray, FloatArray]:
        """The rotations of A and of B as quaternions `(n, 4)`."""
        if not self.joints:
            return np.zeros((0, 4)), np.zeros((0, 4))
        near = np.array([joint.T_parent_connector.quaternion for joint in self.joints])
        far = np.array([joint.T_child_connector.quaternion for joint in self.joints])
        opposed = [joint.mate is Mate.OPPOSED for joint in self.joints]
        far[opposed] = quaternion.multiply(far[opposed], flip(Mate.OPPOSED).quaternion)
        back = self.backwards[:, None]
        return np.where(back, far, near), quaternion.conjugate(np.where(back, near, far))

    @cached_property
    def rows(self) -> tuple[Crossing, ...]:
        """The joints one by one."""
        return tuple(self._row(k) for k in range(len(self.joints)))

    def _row(self, k: int) -> Crossing:
        joint, backwards = self.joints[k], bool(self.backwards[k])
        near, far = joint.T_parent_connector, joint.T_child_connector @ flip(joint.mate)  # F is its own inverse
        if backwards:
            near, far = far, near
        signs = joint.type.reversal_signs(Mate.ALIGNED) if backwards else np.ones(len(joint.type.coordinates))
        return Crossing(joint, self.near[k], self.far[k], backwards, signs, near, far.inverse())


class Transforms:
    """A · J(q) · B of many crossings as matrices.

    A joint that turns about and slides along its z axis is affine in (1, cos θ, sin θ, d), so all of these are one product with
    constants; the others are computed type by type.

    Args:
        crossings: The joints.
    """

    def __init__(self, crossings: Crossings) -> None:
        self._crossings = crossings
        self._turn, self._slide = crossings.turn[:, None], crossings.slide[:, None]
        self._constants = _affine(crossings.A, crossings.B)
        self._general = [(joint_type, k) for joint_type in GENERAL if (k := crossings.of_type(joint_type)).size]

    def __call__(self, rows: FloatArray) -> FloatArray:
        """Return `(n_joints, batch, 4, 4)` for coordinates as rows `(n_columns, batch)`."""
        c, batch = self._crossings, rows.shape[1]
        if not rows.shape[0]:
            rows = np.zeros((1, batch))  # only fixed joints: their factors are zero
        factors = np.empty((len(c), batch, 4))
        angle = rows[c.angle] * self._turn
        factors[..., 0], factors[..., 1], factors[..., 2] = 1.0, np.cos(angle), np.sin(angle)
        factors[..., 3] = rows[c.travel] * self._slide
        X: FloatArray = (factors @ self._constants).reshape(len(c), batch, 4, 4)
        for joint_type, k in self._general:
            columns = c.first[k, None] + np.arange(len(joint_type.coordinates))
            M = motion(joint_type, np.moveaxis(rows[columns], 1, -1), c.sign[k, None, None])
            X[k, :, :3] = c.A[k, None, :, :3] @ M[..., :3, :] @ _square(c.B[k])[:, None]
            X[k, :, :3, 3] += c.A[k, None, :, 3]
        return X


def motion(joint_type: JointType, q: FloatArray, sign: FloatArray) -> FloatArray:
    """Return J(q) `(*batch, 4, 4)` of joints of a type that does more than turn about and slide along z.

    Args:
        joint_type: The type.
        q: Coordinates `(*batch, n_coordinates)` [rad, mm, unit quaternions].
        sign: −1 for the inverse motion; only for balls, which alone may be crossed backwards.
    """
    M = np.zeros((*q.shape[:-1], 4, 4))
    M[..., (0, 1, 2, 3), (0, 1, 2, 3)] = 1.0
    for step in joint_type.steps:
        if step.coordinate is None:
            continue
        value = q[..., step.coordinate]
        if step.kind == "slide":
            M[..., :3, 3] += M[..., :3, step.axis] * value[..., None]
        else:
            cosine, sine = np.cos(value)[..., None], np.sin(value)[..., None]
            i, j = (step.axis + 1) % 3, (step.axis + 2) % 3
            x, y = M[..., :3, i].copy(), M[..., :3, j].copy()
            M[..., :3, i], M[..., :3, j] = x * cosine + y * sine, y * cosine - x * sine
    first = joint_type.quaternion
    if first is not None:  # the steps before it are slides, so that the axes are still those of the connector
        M[..., :3, :3] = rotations(np.concatenate([q[..., first : first + 3] * sign, q[..., first + 3 :]], axis=-1))
    return M


def _affine(A: FloatArray, B: FloatArray) -> FloatArray:
    """Return K `(n, 4, 16)` with A · Tz(d) Rz(θ) · B = K₀ + cos θ K₁ + sin θ K₂ + d K₃.

    Rotation keeps only z fixed, and d moves only the origin.
    """
    x, y, z = (A[:, :, i, None] for i in range(3))
    row_x, row_y, row_z = (B[:, None, i] for i in range(3))
    K = np.zeros((len(A), 4, 4, 4))
    K[:, 0, :3] = z * row_z
    K[:, 0, :3, 3] += A[:, :, 3]
    K[:, 0, 3, 3] = 1.0
    K[:, 1, :3] = x * row_x + y * row_y
    K[:, 2, :3] = y * row_x - x * row_y
    K[:, 3, :3, 3] = A[:, :, 2]
    return K.reshape(len(A), 4, 16)


def rotations(q: FloatArray) -> FloatArray:
    """Return `quaternion.to_matrix(q)` exactly; for few quaternions as one product, which costs less than its forty calls."""
    if q.size > 4 * _FEW:
        return quaternion.to_matrix(q)
    squares = (q[..., :, None] * q[..., None, :]).reshape(*q.shape[:-1], 16)
    R: FloatArray = (squares @ _QUADRATIC + _EYE).reshape(*q.shape[:-1], 3, 3)
    return R


def _stacked(rows: Sequence[Any]) -> FloatArray:
    """Return `numpy.concatenate(rows)` for rows that are mostly contiguous: joining their bytes costs a third."""
    try:
        return np.frombuffer(b"".join(rows))
    except BufferError:
        return np.asarray(np.concatenate(rows))


def _quadratic() -> FloatArray:
    """Return the factors `(9, 16)` of the products of (x, y, z, w) with each other that give R minus the identity `(9,)`."""
    L = np.zeros((4, 4, 9))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        L[i, i, [4 * j, 4 * k]] = -2.0  # on the diagonal −2 (q² of the other two)
        L[i, j, [3 * i + j, 3 * j + i]] = 2.0  # beside it 2 (qᵢ qⱼ ∓ q_k w)
        L[k, 3, [3 * i + j, 3 * j + i]] = -2.0, 2.0
    return L.reshape(16, 9)


_EYE, _QUADRATIC = np.eye(3).ravel(), _quadratic()


def _square(T: FloatArray) -> FloatArray:
    """Return homogeneous matrices `(*batch, 4, 4)` from their first three rows."""
    M = np.zeros((*T.shape[:-2], 4, 4))
    M[..., :3, :], M[..., 3, 3] = T, 1.0
    return M
