"""How far one surface moves in a straight line before it meets another: a closed formula for triangles.

Seen along the direction of motion, two triangles overlap in a convex polygon, and their heights are linear on it. So the travel between
them, the difference of the heights, has its extremes at the corners of that polygon: a corner of one triangle inside the other, or a
crossing of two edges. The smallest travel over all pairs of triangles is exact up to rounding; nothing is stepped or sampled.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from articad.arrays import BoolArray, FloatArray, IntArray

__all__ = ["Outline", "first_contacts", "material_met", "meets"]

_GROUP: Final = 8  # triangles that share a box
_AT_ONCE: Final = 1 << 12  # pairs of triangles
_GROUPS_AT_ONCE: Final = 1 << 10  # pairs of groups of triangles
_GROUPS_UNTIL_MET: Final = 1 << 6  # the same where the first contact decides
_BOXES_AT_ONCE: Final = 1 << 21  # pairs of boxes
_FEW: Final = 128  # triangles that are examined before all
_FLAT: Final = 1e-12  # of squared lengths: twice the area of a triangle that is seen edge-on
_EDGE: Final = 1e-9  # of coordinates on edges and in triangles
_SLIVER_MM: Final = 1e-9  # width of a triangle that is seen edge-on
_RAYS: Final = 4000  # at which material is counted
_BESIDE: Final = (0.5137, 0.4721)  # place of a ray in its cell: not in the middle, where edges of regular shapes are


@dataclass(frozen=True, eq=False)
class Outline:
    """Triangles seen along a direction.

    Attributes:
        flat: Corners across the direction, `(T, 3, 2)` [mm].
        height: Corners along it, `(T, 3)` [mm].
    """

    flat: FloatArray
    height: FloatArray

    @classmethod
    def of(cls, corners: FloatArray, direction: FloatArray) -> Outline:
        """Return triangles `(T, 3, 3)` [mm] as seen along a unit vector `(3,)`."""
        return cls(corners @ _across(direction), corners @ direction)

    def shifted(self, offset: FloatArray, direction: FloatArray) -> Outline:
        """Return the triangles moved by an offset `(3,)` [mm], seen along the same direction `(3,)`."""
        return Outline(self.flat + offset @ _across(direction), self.height + offset @ direction)

    @property
    def reversed(self) -> Outline:
        """The same triangles as seen along the opposite direction."""
        return Outline(self.flat[:, :, ::-1], -self.height)

    @cached_property
    def low(self) -> FloatArray:
        """Lower corners of the triangles' boxes, `(T, 2)`."""
        return np.asarray(self.flat.min(axis=1))

    @cached_property
    def high(self) -> FloatArray:
        """Upper corners of the triangles' boxes, `(T, 2)`."""
        return np.asarray(self.flat.max(axis=1))

    @cached_property
    def bottom(self) -> FloatArray:
        """Least heights, `(T,)`."""
        return np.asarray(self.height.min(axis=1))

    @cached_property
    def top(self) -> FloatArray:
        """Largest heights, `(T,)`."""
        return np.asarray(self.height.max(axis=1))

    @cached_property
    def box(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper corner of the box about all, `(2,)` each."""
        return self.low.min(axis=0), self.high.max(axis=0)

    @cached_property
    def wide(self) -> BoolArray:
        """Which triangles are not seen edge-on, `(T,)`."""
        sides = np.roll(self.flat, -1, axis=1) - self.flat
        longest = np.sqrt((sides * sides).sum(axis=2).max(axis=1, initial=0.0))
        return np.asarray(np.abs(_cross(sides[:, 0], sides[:, 1])) > _SLIVER_MM * longest)

    @cached_property
    def few(self) -> Outline:
        """The triangles that are seen largest, and some of all others: what mostly meets first, or the outline itself if it has no more."""
        if len(self.flat) <= 2 * _FEW:
            return self
        sides = self.flat[:, 1:] - self.flat[:, :1]
        largest = np.argpartition(np.abs(_cross(sides[:, 0], sides[:, 1])), -_FEW)[-_FEW:]
        chosen = np.union1d(largest, np.arange(0, len(self.flat), len(self.flat) // _FEW))
        return Outline(self.flat[chosen], self.height[chosen])

    def inside(self, low: FloatArray, high: FloatArray, *, wide: bool) -> IntArray:
        """Return the triangles whose boxes meet a box, neighbours after each other, `(k,)`; with `wide` those that are not seen edge-on."""
        meet = ((self.low <= high) & (self.high >= low)).all(axis=1)
        found = np.flatnonzero(meet & self.wide if wide else meet)
        middle = (self.low[found] + self.high[found]) / 2
        cell = np.clip((middle - low) / np.maximum(high - low, 1e-12) * 1023, 0, 1023).astype(np.int64)
        return np.asarray(found[np.argsort(_interleaved(cell[:, 0]) | (_interleaved(cell[:, 1]) << 1), kind="stable")])


def _across(direction: FloatArray) -> FloatArray:
    """Return two unit vectors across a direction as columns, `(3, 2)`."""
    x = np.cross(np.eye(3)[int(np.abs(direction).argmin())], direction)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(direction, x)], axis=1)


def first_contacts(a: Outline, b: Outline) -> tuple[float, float]:
    """Return how far a moves before it meets b: forwards along the direction of both outlines, and backwards [mm].

    Infinity if they never meet; zero both ways if they meet where they are.

    Solids share volume on rays along the direction, and almost no ray meets a triangle that is seen edge-on. So such walls decide nothing
    about a way out. Solids that share volume where they are meet both ways; only then walls are searched for where they cross others.
    """
    forwards, backwards = _nearest(a, b, wide=True)
    if forwards > 0 and np.isfinite(forwards + backwards):
        return _nearest(a, b, (forwards, backwards), wide=False)
    return forwards, backwards


def meets(a: Outline, b: Outline, *, forwards: bool) -> bool:
    """Return whether a meets b anywhere on its way along the direction of both outlines, or on its way back: where `first_contacts` is finite.

    The first contact ends the search, which begins with a few triangles of each.
    """
    known, way = ((np.inf, 0.0), 0) if forwards else ((0.0, np.inf), 1)  # nothing is searched for on the other way
    return any(np.isfinite(_nearest(*both, known, wide=True, any_contact=True)[way]) for both in ((a.few, b.few), (a, b)))


def _nearest(
    a: Outline, b: Outline, known: tuple[float, float] = (np.inf, np.inf), *, wide: bool, any_contact: bool = False
) -> tuple[float, float]:
    """Return the least travels of triangles of a to those of b, forwards and backwards, that are less than those known.

    With `wide` of those that are not seen edge-on. With `any_contact`, zero for each way on which they meet.
    """
    low, high = np.maximum(a.box[0], b.box[0]), np.minimum(a.box[1], b.box[1])
    if (low > high).any():
        return known
    rows, columns = (each.inside(low, high, wide=wide) for each in (a, b))
    forwards, backwards = known
    at_once = _GROUPS_UNTIL_MET if any_contact else _GROUPS_AT_ONCE
    groups, near, far = _meeting(a, b, rows, columns)
    # those that may be next to each other first: most others are then farther than what is known
    order = np.argsort(np.maximum(near, -far), kind="stable")
    for first in range(0, len(order), at_once):
        some = order[first : first + at_once]
        some = some[_decides(near[some], far[some], forwards, backwards)]
        i, j = _expanded(a, b, rows, columns, groups[some])
        decides = _decides(b.bottom[j] - a.top[i], b.top[j] - a.bottom[i], forwards, backwards)
        i, j = i[decides], j[decides]
        for at in range(0, len(i), _AT_ONCE):
            p, q = i[at : at + _AT_ONCE], j[at : at + _AT_ONCE]
            over = _overlapping(a.flat[p], b.flat[q])
            p, q = p[over], q[over]
            travel = _travels(a.flat[p], a.height[p], b.flat[q], b.height[q])
            least, most = np.fmin.reduce(travel, axis=1, initial=np.inf), np.fmax.reduce(travel, axis=1, initial=-np.inf)
            if bool(((least <= 0) & (most >= 0)).any()):
                return 0.0, 0.0
            forwards = min(forwards, float(least[least > 0].min(initial=np.inf)))
            backwards = min(backwards, -float(most[most < 0].max(initial=-np.inf)))
        if any_contact:
            forwards, backwards = (0.0 if np.isfinite(travelled) else np.inf for travelled in (forwards, backwards))
            if forwards == backwards == 0.0:
                break
    return forwards, backwards


def _decides(near: FloatArray, far: FloatArray, forwards: float, backwards: float) -> BoolArray:
    """Return which travels between `near` and `far` may be shorter than those known, or of both signs."""
    return np.asarray(((near <= 0) & (far >= 0)) | ((near > 0) & (near < forwards)) | ((far < 0) & (-far < backwards)))


def _meeting(a: Outline, b: Outline, rows: IntArray, columns: IntArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the pairs of groups of triangles whose boxes meet, `(G, 2)`, and their least and largest travels, `(G,)` each."""
    found: list[IntArray] = [np.zeros((0, 2), dtype=np.int64)]
    if not len(rows) or not len(columns):
        return found[0], np.zeros(0), np.zeros(0)
    starts_a, starts_b = (np.arange(0, len(chosen), _GROUP) for chosen in (rows, columns))
    low_a, high_a = np.minimum.reduceat(a.low[rows], starts_a), np.maximum.reduceat(a.high[rows], starts_a)
    low_b, high_b = np.minimum.reduceat(b.low[columns], starts_b), np.maximum.reduceat(b.high[columns], starts_b)
    step = max(1, _BOXES_AT_ONCE // len(starts_b))
    for first in range(0, len(starts_a), step):
        some = slice(first, first + step)
        near = np.ones((len(low_a[some]), len(low_b)), dtype=bool)
        for k in (0, 1):
            near &= (low_a[some, None, k] <= high_b[None, :, k]) & (low_b[None, :, k] <= high_a[some, None, k])
        found.append(np.argwhere(near) + np.array([first, 0]))
    groups = np.concatenate(found)
    i, j = groups.T
    bottom_a, top_a = np.minimum.reduceat(a.bottom[rows], starts_a)[i], np.maximum.reduceat(a.top[rows], starts_a)[i]
    bottom_b, top_b = np.minimum.reduceat(b.bottom[columns], starts_b)[j], np.maximum.reduceat(b.top[columns], starts_b)[j]
    return groups, bottom_b - top_a, top_b - bottom_a


def _expanded(a: Outline, b: Outline, rows: IntArray, columns: IntArray, groups: IntArray) -> tuple[IntArray, IntArray]:
    """Return the pairs of triangles of pairs of groups whose boxes meet, `(K,)` each."""
    within = np.arange(_GROUP)
    i, j = np.broadcast_arrays(
        (groups[:, 0] * _GROUP)[:, None, None] + within[None, :, None], (groups[:, 1] * _GROUP)[:, None, None] + within[None, None, :]
    )
    kept = (i < len(rows)) & (j < len(columns))
    i, j = rows[i[kept]], columns[j[kept]]
    meet = ((a.low[i] <= b.high[j]) & (b.low[j] <= a.high[i])).all(axis=1)
    return i[meet], j[meet]


def _overlapping(p: FloatArray, q: FloatArray) -> BoolArray:
    """Return which pairs of triangles `(K, 3, 2)` no side of either separates, `(K,)`; a pair that is apart by rounding only may be among them."""
    e, g = np.roll(p, -1, axis=1) - p, np.roll(q, -1, axis=1) - q
    slack = 4 * _EDGE * ((e * e).sum(axis=(1, 2)) + (g * g).sum(axis=(1, 2)))
    apart = q[:, None] - p[:, :, None]
    # twice the areas of a side with each corner of the other triangle: negative where the corner is inside this side
    beyond_p = _cross(apart, e[:, :, None]) * np.sign(_cross(e[:, 0], e[:, 1]))[:, None, None]
    beyond_q = -_cross(apart, g[:, None]) * np.sign(_cross(g[:, 0], g[:, 1]))[:, None, None]
    farthest = np.maximum(beyond_p.min(axis=2).max(axis=1), beyond_q.min(axis=1).max(axis=1))
    return np.asarray(farthest <= slack)


def _travels(p: FloatArray, hp: FloatArray, q: FloatArray, hq: FloatArray) -> FloatArray:
    """Return the differences of the heights of q and p at the corners of their common polygons, `(K, 15)`; NaN where there is no corner.

    Args:
        p: Corners across the direction, `(K, 3, 2)`.
        hp: Their heights, `(K, 3)`.
        q: Those of the other triangles.
        hq: Their heights.
    """
    over_p, within_q = _heights(p, q, hq)
    over_q, within_p = _heights(q, p, hp)
    corners = [np.where(within_q, over_p - hp, np.nan), np.where(within_p, hq - over_q, np.nan)]
    # edges: p_i + s e = q_j + t g, with s = (q_j - p_i) x g / (e x g) and t = (q_j - p_i) x e / (e x g)
    e, g = np.roll(p, -1, axis=1) - p, np.roll(q, -1, axis=1) - q
    de, dg = np.roll(hp, -1, axis=1) - hp, np.roll(hq, -1, axis=1) - hq
    apart = q[:, None, :, :] - p[:, :, None, :]
    det = _cross(e[:, :, None], g[:, None])
    size = np.maximum(np.einsum("kei,kei->ke", e, e)[:, :, None] * np.einsum("kgi,kgi->kg", g, g)[:, None], 1e-300)
    crossing = det * det > _FLAT * size
    det = np.where(crossing, det, 1.0)
    s, t = _cross(apart, g[:, None]) / det, _cross(apart, e[:, :, None]) / det
    crossing &= (s >= -_EDGE) & (s <= 1 + _EDGE) & (t >= -_EDGE) & (t <= 1 + _EDGE)
    between = (hq[:, None] + t * dg[:, None]) - (hp[:, :, None] + s * de[:, :, None])
    return np.concatenate([*corners, np.where(crossing, between, np.nan).reshape(len(p), 9)], axis=1)


def _heights(points: FloatArray, triangle: FloatArray, height: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the heights of triangles over points `(K, 3, 2)`, and which points are inside, `(K, 3)` each."""
    a, u, v = triangle[:, :1], triangle[:, 1:2] - triangle[:, :1], triangle[:, 2:] - triangle[:, :1]
    det = _cross(u, v)
    size = np.maximum((u * u).sum(axis=2) * (v * v).sum(axis=2), 1e-300)
    solid = det * det > _FLAT * size
    det = np.where(solid, det, 1.0)
    away = points - a
    s, t = _cross(away, v) / det, _cross(u, away) / det
    inside = solid & (s >= -_EDGE) & (t >= -_EDGE) & (s + t <= 1 + _EDGE)
    return height[:, :1] + s * (height[:, 1:2] - height[:, :1]) + t * (height[:, 2:] - height[:, :1]), inside


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _interleaved(numbers: IntArray) -> IntArray:
    """Return numbers below 1024 with a zero bit between each two of their bits (Morton order)."""
    spread = (numbers | (numbers << 8)) & 0x00FF00FF
    spread = (spread | (spread << 4)) & 0x0F0F0F0F
    spread = (spread | (spread << 2)) & 0x33333333
    return np.asarray((spread | (spread << 1)) & 0x55555555)


def material_met(moving: Outline, staying: Outline) -> float:
    """Return how much material of a solid meets another solid that it moves through, upwards [mm³].

    On a vertical ray, what lies below the other's highest point h meets it. The material below h is the sum of ±min(z, h) over the
    heights z at which the ray crosses the solid's surface, + where it leaves the solid. Rays stand in a square grid.
    """
    low, high = moving.box
    side = float(np.sqrt(np.prod(np.maximum(high - low, _EDGE)) / _RAYS))
    count = np.ceil((high - low) / side).astype(np.int64) + 1
    top = np.full(int(count.prod()), -np.inf)
    rays, heights, _ = _crossings(staying, low, side, count)
    np.maximum.at(top, rays, heights)
    rays, heights, leaving = _crossings(moving, low, side, count)
    met = np.isfinite(top[rays])
    return max(0.0, float((leaving * np.minimum(heights, top[rays]))[met].sum())) * side**2


def _crossings(outline: Outline, low: FloatArray, side: float, count: IntArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return where the vertical rays of a grid cross triangles: numbers of rays, heights, and +1 where a ray leaves, each `(k,)`."""
    first = np.clip(np.ceil((outline.low - low) / side - _BESIDE).astype(np.int64), 0, count)
    last = np.clip(np.floor((outline.high - low) / side - _BESIDE).astype(np.int64), -1, count - 1)
    sides = np.maximum(last - first + 1, 0)
    number = sides.prod(axis=1)
    triangle = np.repeat(np.arange(len(number)), number)
    within = np.arange(len(triangle)) - np.repeat(np.cumsum(number) - number, number)
    cell = first[triangle] + np.stack([within // sides[triangle, 1], within % sides[triangle, 1]], axis=1)
    points = low + side * (cell + _BESIDE)
    # barycentric coordinates u, v of the points, by Cramer's rule
    a, ab, ac = outline.flat[:, 0], outline.flat[:, 1] - outline.flat[:, 0], outline.flat[:, 2] - outline.flat[:, 0]
    twice = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    steep = np.where(np.abs(twice) > _FLAT, twice, np.inf)[triangle]
    off, ab, ac = points - a[triangle], ab[triangle], ac[triangle]
    u = (off[:, 0] * ac[:, 1] - off[:, 1] * ac[:, 0]) / steep
    v = (ab[:, 0] * off[:, 1] - ab[:, 1] * off[:, 0]) / steep
    hit = np.isfinite(steep) & (u >= 0) & (v >= 0) & (u + v <= 1)
    triangle, u, v = triangle[hit], u[hit], v[hit]
    z = outline.height[triangle]
    heights = z[:, 0] + u * (z[:, 1] - z[:, 0]) + v * (z[:, 2] - z[:, 0])
    return cell[hit, 0] * int(count[1]) + cell[hit, 1], heights, np.sign(twice[triangle])
