"""The equations of loops at many configurations at once, in NumPy; `forward.LoopModel` evaluates them at one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray, IndexArray
from articad.connectors import quaternion
from articad.kinematics.batch import TreeArrays
from articad.kinematics.joints import Joint

NEAR_PI = -0.9  # cos θ below which the logarithm is computed from quaternions instead of the sine
_STRAIGHT = 1e-8  # rad: for a smaller mismatch the square term of the logarithm's Jacobian is below rounding


class Closures(NamedTuple):
    """The closing conditions of loops, each between a ghost of a part and the part itself.

    Attributes:
        arrays: The tree with the ghosts.
        ends: Indices of the ghosts, and of the parts that they must meet `(2, loops)`.
        connectors: C_c, the same in both `(loops, 4, 4)`.
        spin: Rotation [rad] of each loop about the axis of each freedom, per scaled unit `(loops, freedoms)`.
        slide: Travel [L] along it `(loops, freedoms)`.
        lengths: L of each loop [mm] `(loops,)`.
        scale: Size of one scaled unit of each freedom [rad, mm] `(freedoms,)`.
    """

    arrays: TreeArrays
    ends: IndexArray
    connectors: FloatArray
    spin: FloatArray
    slide: FloatArray
    lengths: FloatArray
    scale: FloatArray


def closures(arrays: TreeArrays, loop_joints: Sequence[Joint], scale: FloatArray, lengths: FloatArray) -> Closures:
    """Return the closing conditions of the loops.

    Args:
        arrays: The tree with ghosts of the loop joints' children.
        loop_joints: Joints that close loops.
        scale: Size of one scaled unit of each freedom [rad, mm].
        lengths: L of each loop [mm].
    """
    index = {part: i for i, part in enumerate(arrays.parts)}
    far = [index[joint.child] for joint in loop_joints]
    sides = arrays.carried[far] - arrays.carried[[index[joint.parent] for joint in loop_joints]]
    for row, joint in zip(sides, loop_joints, strict=True):
        row[arrays.layout.freedoms[joint.name]] = -1.0
    weight = sides.reshape(len(loop_joints), arrays.layout.n_freedoms) * scale
    ghosts = range(arrays.n_parts, arrays.n_parts + len(loop_joints))
    connectors = np.array([joint.T_child_connector.matrix for joint in loop_joints]).reshape(-1, 4, 4)
    angular, linear = arrays.twists.angular[:, 0, 0], arrays.twists.linear[:, 0, 0]
    return Closures(
        arrays, np.array([ghosts, far], dtype=np.intp), connectors, weight * angular, weight * linear / lengths[:, None], lengths, scale
    )


class BatchEquations:
    """Residuals of loops and their Jacobian at many configurations.

    Args:
        closures: The closing conditions.
    """

    def __init__(self, closures: Closures) -> None:
        self._arrays, self._lengths = closures.arrays, closures.lengths[:, None, None]  # (loops, 1, 1)
        self._ends = closures.ends.ravel()
        self._C_c = np.concatenate([closures.connectors, closures.connectors])[:, None]
        # factors of a freedom's axis and of its moment about B in the residual: (loops, 1, freedoms, 1)
        self._spin, self._slide = closures.spin[:, None, :, None], closures.slide[:, None, :, None]
        self._turn = self._spin / self._lengths[..., None]

    def residual(self, Q: FloatArray) -> FloatArray:
        """Return the residuals `(batch, 6 loops)` at `Q` `(batch, columns)`."""
        _, _, t, phi = self._mismatch(self._arrays.matrices(Q))
        return self._residual(t, phi)

    def fill(self, Q: FloatArray, J: FloatArray) -> FloatArray:
        """Return the residuals, and write their derivatives into `J` `(batch, rows, freedoms)`."""
        T = self._arrays.matrices(Q)
        R_A, p_B, t, phi = self._mismatch(T)
        axes, origins = (part.swapaxes(0, 1) for part in self._arrays.twists.axes(T, Q))  # (batch, freedoms, 3)
        moments = quaternion.cross(axes, p_B[:, :, None, :] - origins)
        lin = (moments * self._turn + axes * self._slide) @ R_A
        ang = (axes * self._spin) @ (R_A @ _log_jacobian(phi))
        blocks = J[:, : 6 * len(t)].reshape(len(Q), len(t), 6, J.shape[2])
        blocks[:, :, :3], blocks[:, :, 3:] = lin.transpose(1, 0, 3, 2), ang.transpose(1, 0, 3, 2)
        return self._residual(t, phi)

    def _mismatch(self, T: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return R_A, the point of B, and M = A⁻¹B as translation and rotation vector; all `(loops, batch, …)`."""
        both = T[self._ends] @ self._C_c
        A, B = both[: len(both) // 2], both[len(both) // 2 :]
        R_A, p_B = A[..., :3, :3], B[..., :3, 3]
        t = ((p_B - A[..., :3, 3])[..., None, :] @ R_A)[..., 0, :]
        return R_A, p_B, t, _rotation_log(R_A.swapaxes(-1, -2) @ B[..., :3, :3])

    def _residual(self, t: FloatArray, phi: FloatArray) -> FloatArray:
        r: FloatArray = np.concatenate([t / self._lengths, phi], axis=-1).swapaxes(0, 1).reshape(t.shape[1], 6 * len(t))
        return r


def _rotation_log(R: FloatArray) -> FloatArray:
    """Return rotation vectors `(*batch, 3)` of matrices: from the sine where that is accurate, as it is near closed loops."""
    parts = R.reshape(*R.shape[:-2], 9) @ _SINE_AND_TRACE
    cosine = 0.5 * parts[..., 3] - 0.5
    if cosine.size and cosine.min() < NEAR_PI:
        return quaternion.log(quaternion.from_matrix(R))
    axis = parts[..., :3]
    sine = np.sqrt((axis * axis).sum(axis=-1)) + 1e-300  # never zero, and too small to matter
    phi: FloatArray = axis * (np.arctan2(sine, cosine) / sine)[..., None]
    return phi


def _log_jacobian(phi: FloatArray) -> FloatArray:
    """Return the matrix by which a row of spin is multiplied to give the rate of the rotation vector: (I − ½[φ] + c [φ]²)ᵀ."""
    S = _crossing(phi)
    J: FloatArray = _EYE + 0.5 * S
    if np.abs(phi).max(initial=0.0) > _STRAIGHT:
        J += quaternion.inverse_coefficient(phi)[..., None] * (S @ S)
    return J


def _crossing(d: FloatArray) -> FloatArray:
    """Return the matrices with a @ crossing(d) = a × d for rows a."""
    return (d @ _EPSILON).reshape(*d.shape[:-1], 3, 3)


_EYE = np.eye(3)
_EPSILON = np.zeros((3, 9))  # (a × d)ⱼ = εⱼᵢₖ aᵢ dₖ
for _k, _ij, _sign in ((0, 5, 1), (0, 7, -1), (1, 6, 1), (1, 2, -1), (2, 1, 1), (2, 3, -1)):
    _EPSILON[_k, _ij] = -_sign
_SINE_AND_TRACE = np.concatenate([0.5 * _EPSILON.T, np.eye(3).reshape(9, 1)], axis=1)
