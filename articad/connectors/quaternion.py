"""Unit quaternions as arrays `(*batch, 4)`, order x y z w: the arithmetic under `SE3`.

Nothing here validates; the constructors of `SE3` do, once. Products and sums are written out:
a library of linear algebra rounds the last digit by the processor's instructions, and frames go into files digit by digit.
"""

from __future__ import annotations

import numpy as np

from articad.arrays import FloatArray

_SMALL_SINE = 1e-8  # below it θ/sin(θ/2) equals 2/cos(θ/2) to the last bit
_SERIES_BELOW = 0.25  # rad; below it closed forms lose digits by cancellation, while the series is accurate to 1e-17


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a × b over the last axis; several times faster than `numpy.cross` on small arrays."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    x = ay * bz - az * by
    product = np.empty((*x.shape, 3))
    product[..., 0], product[..., 1], product[..., 2] = x, az * bx - ax * bz, ax * by - ay * bx
    return product


def length(v: FloatArray) -> FloatArray:
    """Return ‖v‖ over the last axis."""
    norm: FloatArray = np.sqrt((v * v).sum(axis=-1))
    return norm


def product(A: FloatArray, B: FloatArray) -> FloatArray:
    """Return the matrix A B."""
    summed: FloatArray = (A[..., :, :, None] * B[..., None, :, :]).sum(axis=-2)
    return summed


def multiply(p: FloatArray, q: FloatArray) -> FloatArray:
    """Return the Hamilton product p ⊗ q (first q, then p)."""
    px, py, pz, pw = p[..., 0], p[..., 1], p[..., 2], p[..., 3]
    qx, qy, qz, qw = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    x = pw * qx + px * qw + py * qz - pz * qy
    product = np.empty((*x.shape, 4))
    product[..., 0] = x
    product[..., 1] = pw * qy - px * qz + py * qw + pz * qx
    product[..., 2] = pw * qz + px * qy - py * qx + pz * qw
    product[..., 3] = pw * qw - px * qx - py * qy - pz * qz
    return product


def conjugate(q: FloatArray) -> FloatArray:
    """Return the inverse rotation."""
    inverse: FloatArray = q * np.array([-1.0, -1.0, -1.0, 1.0])
    return inverse


def rotate(q: FloatArray, v: FloatArray) -> FloatArray:
    """Rotate the vectors v `(*batch, 3)` by q."""
    u, w = q[..., :3], q[..., 3:]
    twice = 2.0 * cross(u, v)
    rotated: FloatArray = v + w * twice + cross(u, twice)
    return rotated


def to_matrix(q: FloatArray) -> FloatArray:
    """Return rotation matrices `(*batch, 3, 3)`."""
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    R = np.empty((*q.shape[:-1], 3, 3))
    R[..., 0, 0] = 1 - 2 * (y * y + z * z)
    R[..., 0, 1] = 2 * (x * y - z * w)
    R[..., 0, 2] = 2 * (x * z + y * w)
    R[..., 1, 0] = 2 * (x * y + z * w)
    R[..., 1, 1] = 1 - 2 * (x * x + z * z)
    R[..., 1, 2] = 2 * (y * z - x * w)
    R[..., 2, 0] = 2 * (x * z - y * w)
    R[..., 2, 1] = 2 * (y * z + x * w)
    R[..., 2, 2] = 1 - 2 * (x * x + y * y)
    return R


def from_matrix(R: FloatArray) -> FloatArray:
    """Return unit quaternions of rotation matrices `(*batch, 3, 3)`.

    The one of four equivalent formulas with the largest divisor is used (Shepperd, J. Guidance and Control 1, 1978).
    """
    xx, yy, zz = R[..., 0, 0], R[..., 1, 1], R[..., 2, 2]
    # the matrix 4 q qᵀ: each of its columns is a multiple of q
    K = np.empty((*R.shape[:-2], 4, 4))
    K[..., 0, 0] = 1 + xx - yy - zz
    K[..., 1, 1] = 1 - xx + yy - zz
    K[..., 2, 2] = 1 - xx - yy + zz
    K[..., 3, 3] = 1 + xx + yy + zz
    K[..., 0, 1] = K[..., 1, 0] = R[..., 0, 1] + R[..., 1, 0]
    K[..., 0, 2] = K[..., 2, 0] = R[..., 0, 2] + R[..., 2, 0]
    K[..., 1, 2] = K[..., 2, 1] = R[..., 1, 2] + R[..., 2, 1]
    K[..., 0, 3] = K[..., 3, 0] = R[..., 2, 1] - R[..., 1, 2]
    K[..., 1, 3] = K[..., 3, 1] = R[..., 0, 2] - R[..., 2, 0]
    K[..., 2, 3] = K[..., 3, 2] = R[..., 1, 0] - R[..., 0, 1]
    largest = np.argmax(np.diagonal(K, axis1=-2, axis2=-1), axis=-1)
    q = np.take_along_axis(K, largest[..., None, None], axis=-2)[..., 0, :]
    return normalized(q)


def normalized(q: FloatArray) -> FloatArray:
    """Return q / |q|."""
    unit: FloatArray = q / np.sqrt((q * q).sum(axis=-1, keepdims=True))
    return unit


def positive(q: FloatArray) -> FloatArray:
    """Return the one of ±q, which are the same rotation, with w ≥ 0."""
    return np.where(q[..., 3:] < 0, -q, q)


def exp(omega: FloatArray) -> FloatArray:
    """Return the rotation by the vector omega `(*batch, 3)` [rad]."""
    theta = np.sqrt((omega * omega).sum(axis=-1, keepdims=True))
    q = np.empty((*omega.shape[:-1], 4))
    q[..., :3] = np.sin(0.5 * theta) / (theta + 1e-300) * omega  # never 0/0; at θ = 0 the factor does not matter, for omega is zero
    q[..., 3:] = np.cos(0.5 * theta)
    return q


def log(q: FloatArray) -> FloatArray:
    """Return the rotation vector `(*batch, 3)` [rad], of length at most π."""
    q = positive(q)
    u, w = q[..., :3], q[..., 3:]
    sine = np.sqrt((u * u).sum(axis=-1, keepdims=True))
    tiny = sine < _SMALL_SINE
    factor = np.where(tiny, 2.0 / np.where(tiny, w, 1.0), 2.0 * np.arctan2(sine, w) / np.where(tiny, 1.0, sine))
    vector: FloatArray = u * factor
    return vector


def exp_translation(omega: FloatArray, v: FloatArray) -> FloatArray:
    """Return V(ω) v, the translation of exp([v; ω]).

    V = I + (1 − cos θ)/θ² [ω] + (θ − sin θ)/θ³ [ω]² (Murray, Li, Sastry, eq. 2.36).
    """
    square = (omega * omega).sum(axis=-1, keepdims=True)
    theta = np.sqrt(square)
    a = 0.5 * np.sinc(0.5 * theta / np.pi) ** 2
    near = theta < _SERIES_BELOW
    safe = np.where(near, 1.0, theta)
    series = 1 / 6 - square * (1 / 120 - square * (1 / 5040 - square * (1 / 362880 - square / 39916800)))
    b = np.where(near, series, (safe - np.sin(safe)) / safe**3)
    once = cross(omega, v)
    translation: FloatArray = v + a * once + b * cross(omega, once)
    return translation


def log_translation(omega: FloatArray, t: FloatArray) -> FloatArray:
    """Return V(ω)⁻¹ t, the first half of the logarithm of (t, exp ω)."""
    once = cross(omega, t)
    translation: FloatArray = t - 0.5 * once + inverse_coefficient(omega) * cross(omega, once)
    return translation


def inverse_coefficient(omega: FloatArray) -> FloatArray:
    """Return c(θ) = (1 − (θ/2) cot(θ/2))/θ² `(*batch, 1)`: V⁻¹ and the logarithm's Jacobian are I ∓ ½[ω] + c [ω]²."""
    square = (omega * omega).sum(axis=-1, keepdims=True)
    half = 0.5 * np.sqrt(square)
    near = half < 0.5 * _SERIES_BELOW
    safe = np.where(near, 1.0, half)
    series = 1 / 12 + square * (1 / 720 + square * (1 / 30240 + square * (1 / 1209600 + square / 47900160)))
    coefficient: FloatArray = np.where(near, series, (1 - safe * np.cos(safe) / np.sin(safe)) / (4 * safe * safe))
    return coefficient
