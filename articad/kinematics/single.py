"""The equations of loops at one configuration, in Python's own floats.

A four-bar has five hundred products and sums, which fifty NumPy calls of a microsecond each drown. The solver goes from
one configuration to the next, so it takes the equations from here: those that `equations` has for many configurations,
written out. A frame is twelve numbers: its axes x, y, z in the ground frame, then its origin [mm].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from articad.connectors import FloatArray, quaternion
from articad.kinematics.crossings import GENERAL, SLIDING, TURNING, Crossing
from articad.kinematics.equations import NEAR_PI, Closures
from articad.kinematics.joints import JointType, Step
from articad.kinematics.layout import Layout

Numbers = tuple[float, ...]

_IDENTITY: Numbers = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
_BEFORE, _AFTER, _MOVED = 0, 3, 6  # of a step's two frames, where an axis is counted from; before, but through the origin after
_STRAIGHT = 1e-16  # rad²: |φ|² below which the square term of the logarithm's Jacobian is below rounding


class _Step(NamedTuple):
    """A joint that moves, on the way outwards from the ground.

    Attributes:
        near: Index of the frame that carries it.
        P: Its own frame there, before the motion.
        angle: Column of the angle about z.
        turn: Factor of it, 0 where there is none.
        travel: Column of the travel along z; of a screw that of the angle.
        slide: Factor of it, 0 where there is none.
        general: Of joints that do more: type, first column, and the sign of each coordinate.
        axes: Per freedom its axis: 0 … 2 of the frame before the motion, 3 … 5 of the one after it, 6 … 8 of the one before it through
            the origin of the one after it.
    """

    near: int
    P: Numbers
    angle: int
    turn: float
    travel: int
    slide: float
    general: tuple[JointType, int, Numbers] | None
    axes: tuple[int, ...]


class _Carried(NamedTuple):
    """A frame that stands still in another: P in the frame with index `near`."""

    near: int
    P: Numbers


class SingleEquations:
    """Residuals of loops and their Jacobian.

    Args:
        closures: What closes.
    """

    def __init__(self, closures: Closures) -> None:
        arrays = closures.arrays
        self._per_length: list[float] = (1.0 / closures.lengths).tolist()
        self._steps: list[_Step] = []
        carrier: dict[int, tuple[int, FloatArray]] = {arrays.ground: (0, arrays.T_ground.matrix)}  # of a part: a frame, the part in it
        ray_of: dict[int, int] = {}
        for c in (*arrays.crossings, *arrays.closing):
            near, T = carrier[c.near]
            T = T @ c.A.matrix
            if c.joint.type.freedoms:  # a fixed joint is part of the next one's constants
                self._steps.append(_step(c, near, T, arrays.layout))
                freedoms = arrays.layout.freedoms[c.joint.name]
                ray_of |= {freedom: len(ray_of) + i for i, freedom in enumerate(range(freedoms.start, freedoms.stop))}
                near, T = len(self._steps), np.eye(4)
            carrier[c.far] = near, T @ c.B.matrix
        self._ends = [
            tuple(_Carried(carrier[part][0], _numbers(carrier[part][1] @ C_c)) for part in pair)
            for pair, C_c in zip(closures.ends.T.tolist(), closures.connectors, strict=True)
        ]
        self._freedoms = [np.flatnonzero(row) for row in np.abs(closures.spin) + np.abs(closures.slide)]
        self._shares = [
            [(ray_of[f], float(closures.spin[i, f]), float(closures.slide[i, f])) for f in freedoms.tolist()]
            for i, freedoms in enumerate(self._freedoms)
        ]

    def residual(self, Q: FloatArray) -> list[float]:
        """Return the residuals (6 per loop) at `Q` `(columns,)`."""
        frames, _ = self._walk(Q.tolist())
        return [
            value
            for (A, B), per_length in zip(self._closing(frames), self._per_length, strict=True)
            for value in _mismatch(A, B, per_length)
        ]

    def fill(self, Q: FloatArray, J: FloatArray) -> list[float]:
        """Return the residuals, and write their derivatives by the freedoms that change them into `J` `(rows, freedoms)`."""
        frames, rays = self._walk(Q.tolist())
        r: list[float] = []
        for i, (A, B) in enumerate(self._closing(frames)):
            mismatch = _mismatch(A, B, self._per_length[i])
            columns = _columns(A, B, mismatch[3:], rays, self._shares[i], self._per_length[i])
            J[6 * i : 6 * i + 6, self._freedoms[i]] = np.array(columns).reshape(-1, 6).T
            r += mismatch
        return r

    def _walk(self, q: Sequence[float]) -> tuple[list[Numbers], list[Numbers]]:
        """Return the frames that joints carry, the ground's first, and per freedom the direction and a point of its axis."""
        frames, rays = [_IDENTITY], []
        for near, P, angle, turn, travel, slide, general, axes in self._steps:
            before = _times(frames[near], P)
            after = _along_z(before, q[angle] * turn, q[travel] * slide) if general is None else _times(before, _motion(q, *general))
            frames.append(after)
            for axis in axes:
                at, frame = 3 * (axis % 3), after if _AFTER <= axis < _MOVED else before
                rays.append(frame[at : at + 3] + (before if axis < _AFTER else after)[9:])
        return frames, rays

    def _closing(self, frames: Sequence[Numbers]) -> list[tuple[Numbers, Numbers]]:
        """Return of each loop the ghost's connector A and the real one B."""
        return [(_times(frames[ghost.near], ghost.P), _times(frames[real.near], real.P)) for ghost, real in self._ends]


def _mismatch(A: Numbers, B: Numbers, per_length: float) -> list[float]:
    """Return [t(M)/L ; log R(M)] of M = A⁻¹B."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8, ax, ay, az = A
    b0, b1, b2, b3, b4, b5, b6, b7, b8, bx, by, bz = B
    dx, dy, dz = (bx - ax) * per_length, (by - ay) * per_length, (bz - az) * per_length
    cosine = 0.5 * (a0 * b0 + a1 * b1 + a2 * b2 + a3 * b3 + a4 * b4 + a5 * b5 + a6 * b6 + a7 * b7 + a8 * b8) - 0.5
    t = [a0 * dx + a1 * dy + a2 * dz, a3 * dx + a4 * dy + a5 * dz, a6 * dx + a7 * dy + a8 * dz]
    if cosine < NEAR_PI:
        return t + _logarithm(A, B)
    x = 0.5 * (a6 * b3 + a7 * b4 + a8 * b5 - a3 * b6 - a4 * b7 - a5 * b8)
    y = 0.5 * (a0 * b6 + a1 * b7 + a2 * b8 - a6 * b0 - a7 * b1 - a8 * b2)
    z = 0.5 * (a3 * b0 + a4 * b1 + a5 * b2 - a0 * b3 - a1 * b4 - a2 * b5)
    sine = math.sqrt(x * x + y * y + z * z) + 1e-300  # never zero, and never seen
    factor = math.atan2(sine, cosine) / sine
    return [*t, x * factor, y * factor, z * factor]


def _columns(
    A: Numbers, B: Numbers, phi: Sequence[float], rays: Sequence[Numbers], shares: Sequence[tuple[int, float, float]], per_length: float
) -> list[float]:
    """Return six derivatives for each share: of t(M)/L by its slide and its moment about B, of log R(M) by its spin."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8, _, _, _ = A
    bx, by, bz = B[9:]
    w0, w1, w2, w3, w4, w5, w6, w7, w8 = _turned_log_jacobian(A, phi)
    columns: list[float] = []
    for ray, spin, slide in shares:
        ux, uy, uz, ox, oy, oz = rays[ray]
        sx, sy, sz = ux * spin, uy * spin, uz * spin
        dx, dy, dz = (bx - ox) * per_length, (by - oy) * per_length, (bz - oz) * per_length
        vx, vy, vz = sy * dz - sz * dy + ux * slide, sz * dx - sx * dz + uy * slide, sx * dy - sy * dx + uz * slide
        columns += (
            a0 * vx + a1 * vy + a2 * vz,
            a3 * vx + a4 * vy + a5 * vz,
            a6 * vx + a7 * vy + a8 * vz,
            w0 * sx + w1 * sy + w2 * sz,
            w3 * sx + w4 * sy + w5 * sz,
            w6 * sx + w7 * sy + w8 * sz,
        )
    return columns


def _step(c: Crossing, near: int, T: FloatArray, layout: Layout) -> _Step:
    kind, columns = c.joint.type, layout.columns[c.joint.name]
    signs = tuple(map(float, c.signs))
    advances = any(step.advances for step in kind.steps)
    return _Step(
        near,
        _numbers(T),
        angle=columns.stop - 1,
        turn=signs[-1] if kind in TURNING else 0.0,
        travel=columns.start,
        slide=signs[0] * (c.joint.lead / (2 * math.pi) if advances else 1.0) if kind in SLIDING else 0.0,
        general=(kind, columns.start, signs) if kind in GENERAL else None,
        axes=_axes(c),
    )


def _axes(c: Crossing) -> tuple[int, ...]:
    """Return each freedom's axis, which are those of the declared parent connector, as `Twists` has them.

    The last step's axis is the same before and after its own motion; those of a quaternion are before it.
    """
    kind = c.joint.type
    if kind is JointType.BALL and c.backwards:  # crossed from its child, the parent connector is what moves
        return _AFTER, _AFTER + 1, _AFTER + 2
    if kind not in GENERAL:  # z is the same before and after a motion along it
        return (_AFTER + 2,) * kind.freedoms
    return tuple(_axis(step, last=step is kind.steps[-1]) for step in kind.steps)


def _axis(step: Step, *, last: bool) -> int:
    if step.coordinate is None:
        return _MOVED + step.axis
    return step.axis + (_AFTER if last else _BEFORE)


def _numbers(T: FloatArray) -> Numbers:
    """Return the frame of a homogeneous matrix."""
    return tuple(T[:3].T.ravel().tolist())


def _times(G: Numbers, P: Numbers) -> Numbers:
    """Return the frame P of frame G in the ground frame."""
    x0, x1, x2, y0, y1, y2, z0, z1, z2, ox, oy, oz = G
    p0, p1, p2, p3, p4, p5, p6, p7, p8, px, py, pz = P
    return (
        x0 * p0 + y0 * p1 + z0 * p2,
        x1 * p0 + y1 * p1 + z1 * p2,
        x2 * p0 + y2 * p1 + z2 * p2,
        x0 * p3 + y0 * p4 + z0 * p5,
        x1 * p3 + y1 * p4 + z1 * p5,
        x2 * p3 + y2 * p4 + z2 * p5,
        x0 * p6 + y0 * p7 + z0 * p8,
        x1 * p6 + y1 * p7 + z1 * p8,
        x2 * p6 + y2 * p7 + z2 * p8,
        x0 * px + y0 * py + z0 * pz + ox,
        x1 * px + y1 * py + z1 * pz + oy,
        x2 * px + y2 * py + z2 * pz + oz,
    )


def _along_z(G: Numbers, angle: float, travel: float) -> Numbers:
    """Return the frame G turned about and moved along its z axis."""
    x0, x1, x2, y0, y1, y2, z0, z1, z2, ox, oy, oz = G
    c, s = math.cos(angle), math.sin(angle)
    turned = x0 * c + y0 * s, x1 * c + y1 * s, x2 * c + y2 * s, y0 * c - x0 * s, y1 * c - x1 * s, y2 * c - x2 * s
    return (*turned, z0, z1, z2, ox + z0 * travel, oy + z1 * travel, oz + z2 * travel)


def _motion(q: Sequence[float], kind: JointType, column: int, signs: Numbers) -> Numbers:
    """Return J(q) of a joint that does more than turn about and slide along z."""
    J, first = _IDENTITY, kind.quaternion
    for step in kind.steps:
        if step.coordinate is not None:
            value = signs[step.coordinate] * q[column + step.coordinate]
            J = _turned(J, step.axis, value) if step.kind == "turn" else _shifted(J, step.axis, value)
    if first is not None:  # the steps before it are slides, so that the axes are still those of the connector
        return (*_ball(*(sign * value for sign, value in zip(signs[first:], q[column + first :], strict=False))), *J[9:])
    return J


def _turned(G: Numbers, axis: int, angle: float) -> Numbers:
    """Return the frame G turned about one of its axes."""
    c, s, i, j = math.cos(angle), math.sin(angle), 3 * ((axis + 1) % 3), 3 * ((axis + 2) % 3)
    turned = list(G)
    for k in range(3):
        x, y = G[i + k], G[j + k]
        turned[i + k], turned[j + k] = x * c + y * s, y * c - x * s
    return tuple(turned)


def _shifted(G: Numbers, axis: int, travel: float) -> Numbers:
    """Return the frame G moved along one of its axes."""
    x, y, z = G[3 * axis : 3 * axis + 3]
    return (*G[:9], G[9] + x * travel, G[10] + y * travel, G[11] + z * travel)


def _ball(x: float, y: float, z: float, w: float) -> Numbers:
    return (
        *(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)),
        *(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)),
        *(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)),
    )


def _logarithm(A: Numbers, B: Numbers) -> list[float]:
    """Return log(R_Aᵀ R_B) of any rotation."""
    R = np.reshape(A[:9], (3, 3)) @ np.reshape(B[:9], (3, 3)).T  # a frame's axes are the rows here
    phi: list[float] = quaternion.log(quaternion.from_matrix(R)).tolist()
    return phi


def _turned_log_jacobian(A: Numbers, phi: Sequence[float]) -> Numbers:
    """Return what takes a spin in the ground frame to the rate of log R(M): (I − ½[φ] + c [φ]²) R_Aᵀ, row by row."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8, _, _, _ = A
    x, y, z = phi
    square = x * x + y * y + z * z
    c = 0.0
    if square > _STRAIGHT:
        half = 0.5 * math.sqrt(square)
        c = (1.0 - half / math.tan(half)) / square  # its digits are lost where it is small, beside the identity
    d, cx, cy, cz = 1.0 - c * square, c * x, c * y, c * z
    m0, m1, m2 = d + cx * x, cx * y + 0.5 * z, cx * z - 0.5 * y
    m3, m4, m5 = cy * x - 0.5 * z, d + cy * y, cy * z + 0.5 * x
    m6, m7, m8 = cz * x + 0.5 * y, cz * y - 0.5 * x, d + cz * z
    return (
        *(m0 * a0 + m1 * a3 + m2 * a6, m0 * a1 + m1 * a4 + m2 * a7, m0 * a2 + m1 * a5 + m2 * a8),
        *(m3 * a0 + m4 * a3 + m5 * a6, m3 * a1 + m4 * a4 + m5 * a7, m3 * a2 + m4 * a5 + m5 * a8),
        *(m6 * a0 + m7 * a3 + m8 * a6, m6 * a1 + m7 * a4 + m8 * a7, m6 * a2 + m7 * a5 + m8 * a8),
    )
