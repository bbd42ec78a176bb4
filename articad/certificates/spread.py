"""How far points move while joints move within boxes about a pose: bounds by direction, for many boxes at once.

A chain is a product of one-parameter motions. About the centre of a box, a point b·p moves along `u` by at most its speed there times
the half width of each coordinate, plus half the largest second derivative times the square: for i outside j, ∂²p/∂qᵢ∂qⱼ = ωᵢ × (ωⱼ × (p
− oⱼ)), whose component along u is at most |u × ωᵢ| times the speed that j gives the point. So faces that slide along each other, and
shafts that turn in their bores, stay apart in wide boxes: only their normals count. Factors outside i turn its axis: a turn by δ about ωₕ
moves it by 2 sin(|δ| / 2) |ωₕ × ωᵢ|, so a wheel that turns about the axis of another one does not tilt it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray, IntArray
from articad.certificates.rows_last import cross, length, rows_last
from articad.interference.motion import Chain, Mover


class Factor(NamedTuple):
    """A motion exp(q·(turn, slide)).

    Attributes:
        turn: Axis through the origin of the frame before it, or 0.
        slide: Velocity along it [mm per unit].
        column: Index among the chain's values.
        sign: −1 if the chain crosses the joint backwards.
    """

    turn: tuple[float, float, float]
    slide: tuple[float, float, float]
    column: int
    sign: float


def factors_of(mover: Mover) -> list[Factor]:
    """Return the motions of a joint in the order in which the chain passes them."""
    sign, factors = 1.0 if mover.forward else -1.0, mover.joint.type.factors(mover.joint.lead)
    found = [Factor(turn, slide, column, sign) for (turn, slide), column in zip(factors, mover.columns, strict=True)]
    return found if mover.forward else found[::-1]


@dataclass
class Spread:
    """Boxes of a chain's coordinates and the motion in each; `m` boxes, `F` factors, `G` generators.

    Attributes:
        chain: From the fixed part to the moving one.
        T: `T_a_b` at the centres, `(m, 4, 4)`.
        omega: Axes of the factors in the frame of a, 0 for slides, `(m, F, 3)`.
        moment: Their velocities at a's origin, `(m, F, 3)` [mm].
        width: Half width of each factor's coordinate, `(m, F)`.
        tilt: Largest distance by which the factors outside move the end of each unit axis, `(m, F)`.
        spin: Generators of first order, `(m, G, 3)`: coupled motions form one of them.
        flow: Their velocities at a's origin, `(m, G, 3)` [mm].
    """

    chain: Chain
    T: FloatArray = field(default_factory=lambda: np.empty((0, 4, 4)))
    omega: FloatArray = field(init=False)
    moment: FloatArray = field(init=False)
    width: FloatArray = field(init=False)
    tilt: FloatArray = field(init=False)
    spin: FloatArray = field(init=False)
    flow: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self.factors = [(at, factor) for at, mover in enumerate(self.chain.movers) for factor in factors_of(mover)]
        self.turns = np.array([float(any(factor.turn)) for _, factor in self.factors])
        F = len(self.factors)
        self.omega, self.moment = np.empty((0, F, 3)), np.empty((0, F, 3))
        self.width, self.tilt = np.empty((0, F)), np.empty((0, F))
        self.spin, self.flow = np.empty((0, F, 3)), np.empty((0, F, 3))

    def __len__(self) -> int:
        return len(self.T)

    def add(self, centres: FloatArray, width: FloatArray, generators: FloatArray | None = None) -> IntArray:
        """Add boxes and return their numbers.

        Args:
            centres: Values of the chain's coordinates, `(k, n)`.
            width: Half width of each factor's coordinate, `(k, F)`.
            generators: Joint motions of the factors' coordinates, `(k, G, F)`; by default each by itself.
        """
        T, omega, moment = self._placed(centres)
        if generators is None:
            spin, flow = omega * width[..., None], moment * width[..., None]
        else:
            spin, flow = generators @ omega, generators @ moment
        first, tilt = len(self.T), _tilt(omega, width)
        self.T, self.omega = np.concatenate([self.T, T]), np.concatenate([self.omega, omega])
        self.moment, self.width = np.concatenate([self.moment, moment]), np.concatenate([self.width, width])
        self.tilt = np.concatenate([self.tilt, tilt])
        self.spin, self.flow = (np.concatenate([self.spin, spin]), np.concatenate([self.flow, flow])) if first else (spin, flow)
        return np.arange(first, len(self.T))

    def _placed(self, centres: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return `T_a_b`, the factors' axes and moments at values of the coordinates."""
        k, F = len(centres), len(self.factors)
        omega, moment = np.zeros((k, F, 3)), np.zeros((k, F, 3))
        T = np.tile(np.eye(4), (k, 1, 1))
        last = -1
        for f, (at, factor) in enumerate(self.factors):
            if at != last:
                T, last = T @ self.chain.movers[at].before, at
            R, o = T[:, :3, :3], T[:, :3, 3]
            w, v = R @ factor.turn * factor.sign, R @ factor.slide * factor.sign
            omega[:, f], moment[:, f] = w, v + np.cross(o, w)
            T = T @ _moved(factor, centres[:, factor.column])
        return T @ self.chain.last, omega, moment

    # --- bounds, for rows of (box, point or little box)

    def first_order(self, box: IntArray, u: FloatArray, p: FloatArray, extent: FloatArray | None) -> FloatArray:
        """Bound how far points move along directions to first order, `(n, D, ..., G)` [mm].

        Args:
            box: Which box of the spread, `(n,)`.
            u: Unit directions in a's frame, `(n, D, 3)`.
            p: Points of b at the box's centre, in a's frame, `(n, 3)`, or several of them `(n, C, 3)`.
            extent: Half axes of a little box about each point, `(n, 3, 3)`, or None for the points alone.
        """
        n, count = len(p), p[0, ..., 0].size if len(p) else 1
        w, v = rows_last(self.spin[box]), rows_last(self.flow[box])
        sides = [] if extent is None else [rows_last(extent)]
        # one product of matrices for all velocities: those of the points, and u · (w × e) for each half axis e of the little box
        speeds = np.empty((n, count + 3 * len(sides), w.shape[1], 3))
        for arms, first in zip((rows_last(p.reshape(n, count, 3)), *sides), (0, count), strict=False):
            found = cross(w[:, :, None], arms[:, None])
            for k in range(3):
                into = speeds[:, first : first + arms.shape[1], :, k].T  # (G, arms, n)
                into[:] = found[k] if first else found[k] + v[k][:, None]
        vectors = speeds.shape[1]
        moved = np.abs(u @ speeds.reshape(n, vectors * w.shape[1], 3).transpose(0, 2, 1)).reshape(*u.shape[:2], vectors, w.shape[1])
        if extent is not None:
            along = moved[:, :, count:]
            moved = moved[:, :, :count] + (along[:, :, 0] + along[:, :, 1] + along[:, :, 2])[:, :, None]
        return np.asarray(moved.reshape(*u.shape[:2], *p.shape[1:-1], w.shape[1]))

    def second_order(self, box: IntArray, u: FloatArray, p: FloatArray, size: FloatArray, extent: FloatArray | None = None) -> FloatArray:
        """Return bounds of the remaining motion along directions, `(n, D, ...)` [mm].

        Args:
            box: Which box of the spread, `(n,)`.
            u: Unit directions in a's frame, `(n, D, 3)`.
            p: Points of b at the box's centre, in a's frame, `(n, 3)`, or several of them `(n, C, 3)`.
            size: Radius of a ball about each point, `(n,)` [mm].
            extent: Half axes of a little box in that ball, `(n, 3, 3)`: then the length of a rod does not count for a turn about its own
                axis.
        """
        n, count = len(p), p[0, ..., 0].size if len(p) else 1
        w, v = rows_last(self.omega[box]), rows_last(self.moment[box])
        width, tilt = rows_last(self.width[box]), rows_last(self.tilt[box])
        reach = self.turns[:, None] * size  # (F, n): how much faster than the centre a point of the little box moves, by each factor
        if extent is not None:
            sides = length(cross(w[:, :, None], rows_last(extent)[:, None]))
            reach = np.minimum(reach, sides[:, 0] + sides[:, 1] + sides[:, 2])
        moved = cross(w[:, :, None], rows_last(p.reshape(n, count, 3))[:, None])
        speed = length([moved[k] + v[k][:, None] for k in range(3)]) + reach[:, None]  # (F, C, n)
        turned = width * self.turns[:, None]
        share = np.minimum(length(cross(rows_last(u)[:, :, None], w[:, None])) + tilt, 1.0)  # (D, F, n)
        total = np.zeros((u.shape[1], count, n))
        inside = np.zeros((count, n))  # how far the factors inside move the point
        weighted = share * turned
        before = np.cumsum(weighted, axis=1) - weighted
        for f in range(len(self.factors) - 1, -1, -1):
            carried = width[f] * (speed[f] + (inside if self.turns[f] else 0.0))
            total += carried * (weighted[:, f] + 2 * before[:, f])[:, None]
            inside = inside + carried
        return np.ascontiguousarray(np.moveaxis(total / 2, 2, 0)).reshape(n, u.shape[1], *p.shape[1:-1])


def _tilt(omega: FloatArray, width: FloatArray) -> FloatArray:
    """Bound how far the end of each unit axis `(k, F, 3)` moves while the factors before it turn by at most `width` `(k, F)`; `(k, F)`."""
    chord = 2 * np.sin(np.minimum(width, np.pi) / 2)
    sines = _length(_cross(omega[:, :, None], omega[:, None]))  # (k, outer factor, inner factor)
    return np.asarray(np.einsum("kh,khf->kf", chord, np.triu(sines, k=1)))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross products of vectors `(..., 3)`."""
    return np.asarray(a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]])


def _length(v: FloatArray) -> FloatArray:
    """Return the lengths of vectors `(..., 3)`."""
    return np.asarray(np.sqrt(np.einsum("...i,...i", v, v)))


def _moved(factor: Factor, values: FloatArray) -> FloatArray:
    """Return the factor's motion at values of its coordinate `(k,)`, `(k, 4, 4)`."""
    angle = values * factor.sign
    x, y, z = factor.turn
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    T = np.tile(np.eye(4), (len(values), 1, 1))
    T[:, :3, :3] += np.sin(angle)[:, None, None] * K + (1 - np.cos(angle))[:, None, None] * (K @ K)
    T[:, :3, 3] = angle[:, None] * factor.slide
    return T
