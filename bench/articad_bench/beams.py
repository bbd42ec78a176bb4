"""Beams of measured sections (Euler and Bernoulli), on supports that hold them, clamp them or only push."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from articad.arrays import FloatArray
from articad.geometry import TriMesh

__all__ = ["Bent", "Section", "Support", "beam", "section"]

STATIONS: Final = 60  # along a beam
SAME: Final = 1e-3  # of the length of a beam: nodes so near each other are one
POINTS: Final = 2  # at which something holds a beam that may turn there: with fewer, nothing holds it
ROUNDED: Final = 1e-9  # of the largest force or deflection
Held = NDArray[np.bool_]
"""At which nodes of a beam something holds it."""


class Bent(NamedTuple):
    """Largest bending stress [N/mm²] and sag [mm] of a board."""

    stress: float
    sag: float


class Support(NamedTuple):
    """A stretch along a board where something carries it.

    Attributes:
        low: Its beginning [mm].
        high: Its end [mm].
        both_ways: Whether it holds the board down as well; then it does not let it turn where it is longer than a point.
    """

    low: float
    high: float
    both_ways: bool


class Section(NamedTuple):
    """A section: second moment about its level axis [mm⁴], and distance of its farthest point from that axis [mm]."""

    moment: float
    edge: float


def section(mesh: TriMesh, axis: FloatArray, at: float) -> Section:
    """Return the section of a solid across an axis, `at` from the origin along it [mm].

    Green's theorem over the segments in which triangles cross the plane: the solid lies on the left of each.
    """
    side = mesh.vertices @ axis - at
    sides = side[mesh.triangles]
    crossed = (sides.min(axis=1) < 0) & (sides.max(axis=1) >= 0)
    if not crossed.any():
        return Section(0.0, 0.0)
    corners, sides = mesh.vertices[mesh.triangles[crossed]], sides[crossed]
    across = np.cross([0.0, 0.0, 1.0], axis)
    below = sides < 0
    starts, ends = np.empty((len(corners), 2)), np.empty((len(corners), 2))
    for i in range(3):
        j = (i + 1) % 3
        for crossing, into in ((below[:, i] & ~below[:, j], starts), (~below[:, i] & below[:, j], ends)):
            a, b = corners[crossing, i], corners[crossing, j]
            share = sides[crossing, i] / (sides[crossing, i] - sides[crossing, j])
            points = a + share[:, None] * (b - a)
            into[crossing] = np.stack([points @ across, points[:, 2]], axis=1)
    z0 = float(starts[:, 1].mean())
    (y1, z1), (y2, z2) = starts.T - [[0.0], [z0]], ends.T - [[0.0], [z0]]
    cross = y1 * z2 - y2 * z1
    area = float(cross.sum()) / 2
    if abs(area) < 1e-9:
        return Section(0.0, 0.0)
    first = float((cross * (z1 + z2)).sum()) / 6
    second = float((cross * (z1 * z1 + z1 * z2 + z2 * z2)).sum()) / 12
    centre = first / area
    heights = np.concatenate([z1, z2]) - centre
    return Section(abs(second - area * centre * centre), float(np.abs(heights).max()))


def beam(
    mesh: TriMesh,
    axis: FloatArray,
    supports: Sequence[Support],
    force: float,
    modulus: float,
    loaded: tuple[float, float],
    *,
    anywhere: bool,
) -> Bent | None:
    """Return stress and sag of a beam of measured sections; None if its supports do not hold it.

    Args:
        mesh: Its shape.
        axis: Its direction, level `(3,)`.
        supports: Where something carries it, from its end.
        force: Load [N].
        modulus: Of elasticity [N/mm²].
        loaded: Where the load begins and ends, along the axis from the origin [mm].
        anywhere: Whether the load stands on the worst place of that stretch, in place of evenly on it.
    """
    ends = mesh.vertices @ axis
    start, length = float(ends.min()), float(np.ptp(ends))
    low, high = (end - start for end in loaded)
    nodes = _nodes(length, [low, high, *(end for row in supports for end in (row.low, row.high))])
    lengths = np.diff(nodes)
    sections = [section(mesh, axis, start + float(at)) for at in (nodes[:-1] + nodes[1:]) / 2]
    if any(each.moment <= 0 for each in sections):
        return None
    stiff = modulus * np.array([each.moment for each in sections])
    weights = np.array([each.edge / each.moment for each in sections])
    both, pushes, clamps = (np.zeros(len(nodes), dtype=bool) for _ in range(3))
    for row in supports:
        there = _along(nodes, row.low, row.high)
        both |= there & row.both_ways
        pushes |= there & (not row.both_ways)
        clamps |= there & (row.both_ways and row.high > row.low)
    under = _along(nodes, low, high)
    worst = Bent(0.0, 0.0)
    for density, point in _loads(lengths, under, force, anywhere=anywhere):
        bent = _solved(lengths, stiff, weights, (density, point), both, pushes, clamps)
        if bent is None:
            return None
        worst = Bent(max(worst.stress, bent.stress), max(worst.sag, bent.sag))
    return worst


def _nodes(length: float, wanted: Sequence[float]) -> FloatArray:
    """Return places along a beam, at least a share of its length apart: its ends, those that are wanted, and others evenly between."""
    fixed = [0.0, length]
    for place in np.clip(wanted, 0.0, length):
        if np.abs(np.array(fixed) - place).min() > SAME * length:
            fixed.append(float(place))
    even = np.linspace(0.0, length, STATIONS + 1)
    free = even[np.abs(even[:, None] - np.array(fixed)[None]).min(axis=1) > length / (4 * STATIONS)]
    return np.sort(np.concatenate([fixed, free]))


def _along(nodes: FloatArray, low: float, high: float) -> Held:
    """Return which nodes lie on a stretch: from the one nearest to its beginning to the one nearest to its end."""
    first, last = (int(np.abs(nodes - end).argmin()) for end in (low, high))
    number = np.arange(len(nodes))
    return np.asarray((number >= first) & (number <= last))


def _loads(lengths: FloatArray, under: Held, force: float, *, anywhere: bool) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield the loads of the pieces of a beam [N/mm] and of its nodes [N]."""
    if anywhere or under.sum() == 1:
        for node in np.flatnonzero(under):
            yield np.zeros(len(lengths)), force * (np.arange(len(under)) == node)
    else:
        covered = under[:-1] & under[1:]
        yield np.where(covered, force / float(lengths[covered].sum()), 0.0), np.zeros(len(under))


def _even(h: float, density: float) -> FloatArray:
    """Return the forces and moments at both ends of a piece that an even load [N/mm] stands for."""
    return density * np.array([h / 2, h * h / 12, h / 2, -h * h / 12])


def _stiffness(h: float, stiff: float) -> FloatArray:
    """Return the stiffness of a piece of a beam for deflection and slope of both ends."""
    rows = [
        [12, 6 * h, -12, 6 * h],
        [6 * h, 4 * h * h, -6 * h, 2 * h * h],
        [-12, -6 * h, 12, -6 * h],
        [6 * h, 2 * h * h, -6 * h, 4 * h * h],
    ]
    return np.asarray(stiff / h**3 * np.array(rows))


def _balanced(K: FloatArray, load: FloatArray) -> FloatArray | None:
    """Return the solution of K x = load, symmetric; None where pieces of a beam differ so much that numbers do not say it."""
    if not len(load):
        return load
    try:
        return np.asarray(cho_solve(cho_factor(K), load))
    except LinAlgError:
        return None


def _solved(
    lengths: FloatArray,
    stiff: FloatArray,
    weights: FloatArray,
    loaded: tuple[FloatArray, FloatArray],
    both: Held,
    pushes: Held,
    clamps: Held,
) -> Bent | None:
    """Return stress and sag; supports that only push let go where they would have to pull, and hold again what would sink into them."""
    density, points = loaded
    count = 2 * len(points)
    K, load = np.zeros((count, count)), np.zeros(count)
    load[::2] = points
    pieces = [(float(h), float(k), float(even)) for h, k, even in zip(lengths, stiff, density, strict=True)]
    for i, (h, k, even) in enumerate(pieces):
        K[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += _stiffness(h, k)
        load[2 * i : 2 * i + 4] += _even(h, even)
    holding = both | pushes
    scale = np.where(np.arange(count) % 2 == 0, 1.0, 1 / float(lengths.sum()))  # slopes by length, so that all are of one size
    for _ in range(count):
        free = np.ones(count, dtype=bool)
        free[::2], free[1::2] = ~holding, ~clamps
        held = bool(clamps.any()) or holding.sum() >= POINTS
        found = _balanced((K * np.outer(scale, scale))[np.ix_(free, free)], scale[free] * load[free]) if held else None
        if found is None:
            return None
        moved = np.zeros(count)
        moved[free] = scale[free] * found
        push = (load - K @ moved)[::2]  # of each support, upwards
        pulls = holding & ~both & (push < -ROUNDED * max(1.0, float(np.abs(push).max())))
        sinks = pushes & ~holding & (moved[::2] > ROUNDED * float(np.abs(moved[::2]).max()))
        if not pulls.any() and not sinks.any():
            break
        holding = holding & ~pulls if pulls.any() else holding | sinks
    else:
        return None
    stress = 0.0
    for i, (h, k, even) in enumerate(pieces):
        ends = _stiffness(h, k) @ moved[2 * i : 2 * i + 4] - _even(h, even)
        stress = max(stress, float(weights[i]) * max(abs(float(ends[1])), abs(float(ends[3]))))
    return Bent(stress, float(np.abs(moved[::2]).max()))
