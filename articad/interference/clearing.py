"""Keeping two surfaces apart over boxes of motion: pieces of both, and of the range, are cut where that helps.

The search begins with the two whole surfaces over the whole range. What a direction separates, with the motion along it taken
off, is settled; else the larger of two pieces is cut, or the range once the motion is what matters. So material near an axis is
not charged with the speed of what is far out, and what is far apart is settled at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from articad.interference.boxtree import BoxTree
from articad.interference.cover import Budget
from articad.interference.spread import Spread

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

ROUNDING_MM = 1e-9  # what a distance must be above what it needs, for the arithmetic of poses
CHUNK = 4096  # pairs of pieces looked at together
MOTION_SHARE = 1.0  # of the pieces' size: when the motion is larger, the range is cut before the pieces
LEAST_SHARE = 1e-3  # of the motion in any direction: along the normal of faces in one plane there is nothing to cut
MOST_PAIRS = 4_000_000  # of pieces, after which a search is given up
_EYE = np.eye(3)


class Boxes(Protocol):
    """Boxes that can be cut in two."""

    spread: Spread

    def root(self) -> IntArray:
        """Add what covers the whole range, and return its numbers."""

    def cut(self, boxes: IntArray, share: FloatArray) -> tuple[IntArray, IntArray]:
        """Cut boxes `(k,)` where `share (k, G + swings)` of the motion is largest; −1 for halves that need no cover."""

    def is_reached(self, box: int) -> bool:
        """Return whether the centre of a box is a pose of the mechanism."""

    def contact(self, box: int) -> tuple[float, ...] | None:
        """Return the centre of a box as coordinates to report, or None when it lies outside what joints allow."""


@dataclass
class Cleared:
    """What a search came to.

    Attributes:
        contact: Centre of a box at which the surfaces are not apart, if one was met.
        box: Its number, −1 if there is none.
        out_of_budget: True when it was given up.
        pairs: Pairs of pieces that were looked at.
        boxes: Boxes that were looked at.
    """

    contact: tuple[float, ...] | None = None
    box: int = -1
    out_of_budget: bool = False
    pairs: int = 0
    boxes: int = 0

    @property
    def is_complete(self) -> bool:
        """True when the surfaces keep apart over the whole range."""
        return self.contact is None and not self.out_of_budget


@dataclass
class _Pairs:
    """Rows: a node of each tree, and a box."""

    a: IntArray
    b: IntArray
    box: IntArray

    def __len__(self) -> int:
        return len(self.a)

    def of(self, rows: NDArray[np.bool_] | IntArray) -> _Pairs:
        return _Pairs(self.a[rows], self.b[rows], self.box[rows])


def clear(a: BoxTree, b: BoxTree, boxes: Boxes, needed: float, *, epsilon: float, budget: Budget, most: int = MOST_PAIRS) -> Cleared:
    """Prove that two surfaces stay further apart than `needed` [mm] over boxes of motion.

    Args:
        a: Of the part that stands.
        b: Of the part that moves.
        boxes: Of the motion.
        needed: Distance that proves nothing, such as the deflection of both meshes [mm].
        epsilon: What is closer by no more is contact [mm].
        budget: Time.
        most: Pairs of pieces.
    """
    search = _Search(a, b, boxes, needed + ROUNDING_MM, epsilon)
    root = boxes.root()
    stack = [_Pairs(np.zeros(len(root), dtype=np.int64), np.zeros(len(root), dtype=np.int64), root)]
    outcome = search.outcome
    while stack and outcome.contact is None:
        if budget.is_spent or outcome.pairs > most:
            outcome.out_of_budget = True
            break
        rows = stack.pop()
        if len(rows) > CHUNK:
            stack.append(rows.of(np.arange(len(rows)) < len(rows) - CHUNK))
            rows = rows.of(np.arange(len(rows)) >= len(rows) - CHUNK)
        outcome.pairs += len(rows)
        stack += [found for found in search.step(rows) if len(found)]
    outcome.boxes = len(boxes.spread)
    return outcome


class _Search:
    def __init__(self, a: BoxTree, b: BoxTree, boxes: Boxes, needed: float, epsilon: float) -> None:
        self.a, self.b, self.boxes, self.needed, self.epsilon = a, b, boxes, needed, epsilon
        self.spread = boxes.spread
        self.outcome = Cleared()
        self.children = np.full((0, 2), -2)
        self.size_a, self.size_b = np.linalg.norm(a.half, axis=1), np.linalg.norm(b.half, axis=1)

    def step(self, rows: _Pairs) -> list[_Pairs]:
        """Settle what is settled and cut the rest."""
        single = (self.a.triangle[rows.a] >= 0) & (self.b.triangle[rows.b] >= 0)
        out: list[_Pairs] = []
        if not single.all():
            out += self._nodes(rows.of(~single))
        if single.any():
            out += self._triangles(rows.of(single))
        return out

    def _nodes(self, rows: _Pairs) -> list[_Pairs]:
        T, box = self.spread.T[rows.box], rows.box
        R = T[:, :3, :3]
        centre = (R @ self.b.centre[rows.b][..., None])[..., 0] + T[:, :3, 3]
        extent = R.transpose(0, 2, 1) * self.b.half[rows.b][..., None]  # rows: half axes of b's box in a's frame
        apart = centre - self.a.centre[rows.a]
        length = np.linalg.norm(apart, axis=1)
        towards = apart / np.where(length > 0, length, 1.0)[:, None]
        u = np.concatenate([np.broadcast_to(_EYE, (len(rows), 3, 3)), R.transpose(0, 2, 1), towards[:, None]], axis=1)
        thick = (np.abs(u) @ self.a.half[rows.a][..., None])[..., 0] + np.abs(u @ extent.transpose(0, 2, 1)).sum(axis=2)
        still = np.abs((u @ apart[..., None])[..., 0]) - thick
        shares = self.spread.first_order(box, u, centre, extent)
        motion = shares.sum(axis=2) + self.spread.second_order(box, u, centre, self.size_b[rows.b])
        left = ~((still - motion).max(axis=1) > self.needed)
        rows, best = rows.of(left), np.argmax(still[left], axis=1)
        at = np.arange(len(rows))
        along, most = motion[left][at, best], motion[left].max(axis=1)
        moving = (along > MOTION_SHARE * thick[left][at, best]) & (along > LEAST_SHARE * most)
        shares = shares[left]
        return [*self._cut_range(rows.of(moving), shares[at, best][moving]), *self._cut_pieces(rows.of(~moving))]

    def _cut_pieces(self, rows: _Pairs) -> list[_Pairs]:
        """Cut the larger piece of each pair that has any to cut."""
        whole_a, whole_b = self.a.children[rows.a, 0] < 0, self.b.children[rows.b, 0] < 0
        first = ~whole_a & (whole_b | (self.size_a[rows.a] >= self.size_b[rows.b]))
        p, q = rows.of(first), rows.of(~first)
        return [
            _Pairs(
                np.concatenate([self.a.children[p.a].ravel(), np.repeat(q.a, 2)]),
                np.concatenate([np.repeat(p.b, 2), self.b.children[q.b].ravel()]),
                np.concatenate([np.repeat(p.box, 2), np.repeat(q.box, 2)]),
            )
        ]

    def _cut_range(self, rows: _Pairs, shares: FloatArray) -> list[_Pairs]:
        if not len(rows):
            return []
        boxes, where = np.unique(rows.box, return_inverse=True)
        if len(self.children) < len(self.spread):
            self.children = np.concatenate([self.children, np.full((len(self.spread) - len(self.children), 2), -2)])
        new = self.children[boxes, 0] == -2
        if new.any():
            total = np.zeros((len(boxes), shares.shape[1]))
            np.add.at(total, where, shares / np.maximum(shares.sum(axis=1, keepdims=True), 1e-300))
            halves = self.boxes.cut(boxes[new], total[new])
            self.children[boxes[new]] = np.stack(halves, axis=1)
        children = self.children[rows.box]
        found = _Pairs(np.repeat(rows.a, 2), np.repeat(rows.b, 2), children.ravel())
        return [found.of(found.box >= 0)]

    def _triangles(self, rows: _Pairs) -> list[_Pairs]:
        T, box = self.spread.T[rows.box], rows.box
        p = self.a.corners[self.a.triangle[rows.a]]
        q = self.b.corners[self.b.triangle[rows.b]] @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3]
        nearest, towards = shortest_between(p, q)
        u = np.stack([_normals(p), _normals(q), towards], axis=1)
        mine, theirs = u @ p.transpose(0, 2, 1), u @ q.transpose(0, 2, 1)  # (n, D, 3 corners)
        ahead = theirs.min(axis=2) - mine.max(axis=2) > mine.min(axis=2) - theirs.max(axis=2)
        u = np.where(ahead[..., None], u, -u)
        mine, theirs = np.where(ahead[..., None], mine, -mine), np.where(ahead[..., None], theirs, -theirs)
        nothing = np.zeros(len(rows))
        shares = [self.spread.first_order(box, u, q[:, k], None) for k in range(3)]
        motion = np.stack([shares[k].sum(axis=2) + self.spread.second_order(box, u, q[:, k], nothing) for k in range(3)], axis=2)
        gap = (theirs - motion).min(axis=2) - mine.max(axis=2)
        left = np.flatnonzero(gap.max(axis=1) <= self.needed)
        touching = left[nearest[left] <= self.needed + self.epsilon]
        for row in touching:
            contact = self.boxes.contact(int(box[row]))
            if contact is not None:
                self.outcome.contact, self.outcome.box = contact, int(box[row])
                return []
        best = np.argmax((theirs.min(axis=2) - mine.max(axis=2))[left], axis=1)
        share = np.max([found[left, best] for found in shares], axis=0)
        # what does not move and yet is not apart pierces the other: there the distance is none
        stuck = motion[left].max(axis=(1, 2)) < self.epsilon / 4
        stuck[stuck] = [self.boxes.is_reached(box) for box in box[left][stuck].tolist()]
        if stuck.any():
            row = int(left[np.argmax(stuck)])
            self.outcome.box = int(box[row])
            self.outcome.contact = self.boxes.contact(self.outcome.box) or ()
            return []
        return self._cut_range(rows.of(left), share + 1e-300)


def _normals(p: FloatArray) -> FloatArray:
    n = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    length = np.linalg.norm(n, axis=1)
    return np.asarray(n / np.where(length > 0, length, 1.0)[:, None])


def shortest_between(p: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the distance of triangles `(n, 3, 3)` each that do not pierce one another, and the direction in which it is measured.

    It is reached between two edges, or between a corner and the inside of the other triangle (Ericson, Real-time collision
    detection, 5.1). Any direction proves its own gap, so nothing rests on this being exact.
    """
    d, e = np.roll(p, -1, axis=1) - p, np.roll(q, -1, axis=1) - q
    between = p[:, :, None] - q[:, None]  # (n, 3, 3, 3): of edge i of p and edge j of q
    a, f = (d * d).sum(axis=2)[:, :, None], (e * e).sum(axis=2)[:, None]
    b, c, g = d @ e.transpose(0, 2, 1), (d[:, :, None] * between).sum(axis=3), (e[:, None] * between).sum(axis=3)
    below = a * f - b * b
    s = np.clip((b * g - c * f) / np.where(below > 1e-12 * a * f, below, np.inf), 0.0, 1.0)
    t = np.clip((b * s + g) / np.maximum(f, 1e-300), 0.0, 1.0)
    s = np.clip((b * t - c) / np.maximum(a, 1e-300), 0.0, 1.0)
    edges = t[..., None] * e[:, None] - s[..., None] * d[:, :, None] - between
    found = np.concatenate([edges.reshape(-1, 9, 3), _over(p, q), -_over(q, p)], axis=1)
    squares = (found * found).sum(axis=2)
    nearest = np.argmin(squares, axis=1)
    rows = np.arange(len(p))
    length = np.sqrt(squares[rows, nearest])
    finite = np.isfinite(length) & (length > 0)
    return length, np.asarray(found[rows, nearest] / np.where(finite, length, 1.0)[:, None])


def _over(p: FloatArray, q: FloatArray) -> FloatArray:
    """Return the vectors from the inside of p straight up to the corners of q, `(n, 3, 3)`; far where these are not over it."""
    n = _normals(p)
    up = q - p[:, None, 0]
    inside = np.ones(up.shape[:2], dtype=bool)
    for k in range(3):
        edge = p[:, (k + 1) % 3] - p[:, k]
        inside &= ((q - p[:, None, k]) @ np.cross(n, edge)[..., None])[..., 0] >= 0
    return np.asarray(np.where(inside[..., None], (up @ n[..., None]) * n[:, None], 1e150))


class Ranges:
    """Boxes of a chain's own coordinates, from bounds of each.

    Args:
        spread: Empty, of the chain.
        bounds: Of each coordinate.
        left_out: Whether a box (centre, half) lies outside what the joints allow.
    """

    def __init__(self, spread: Spread, bounds: FloatArray, left_out: Callable[[FloatArray, FloatArray], bool] | None = None) -> None:
        self.spread, self.bounds, self.left_out = spread, bounds, left_out
        n = len(bounds)
        self.centre, self.half = np.empty((0, n)), np.empty((0, n))

    def root(self) -> IntArray:
        """Add the whole range."""
        return self._add(self.bounds.mean(axis=1)[None], np.diff(self.bounds, axis=1).T / 2)

    def _add(self, centre: FloatArray, half: FloatArray) -> IntArray:
        self.centre, self.half = np.concatenate([self.centre, centre]), np.concatenate([self.half, half])
        width = [np.linalg.norm(half[:, list(factor.columns)], axis=1) for _, factor in self.spread.factors]
        return self.spread.add(centre, np.stack(width, axis=1))

    def cut(self, boxes: IntArray, share: FloatArray) -> tuple[IntArray, IntArray]:
        """Cut each box across the coordinate that has the largest share."""
        n_factors, half = len(self.spread.factors), self.half[boxes]
        by_column = np.zeros(half.shape)
        for f, (_, factor) in enumerate(self.spread.factors):
            mine = share[:, f]
            if factor.is_swing:
                mine = share[:, n_factors + self.spread.swings.index(f)]
                larger = np.argmax(half[:, list(factor.columns)], axis=1)
                by_column[np.arange(len(boxes)), np.array(factor.columns)[larger]] += mine
            else:
                by_column[:, factor.columns[0]] += mine
        by_column[half <= 0] = -1.0
        at = np.argmax(by_column, axis=1)
        rows = np.arange(len(boxes))
        smaller = half.copy()
        smaller[rows, at] /= 2
        step = np.zeros_like(half)
        step[rows, at] = smaller[rows, at]
        centre = self.centre[boxes]
        numbers = self._add(np.concatenate([centre - step, centre + step]), np.concatenate([smaller, smaller]))
        if self.left_out is not None:
            dropped = [self.left_out(self.centre[k], self.half[k]) for k in numbers]
            numbers = np.where(dropped, -1, numbers)
        return numbers[: len(boxes)], numbers[len(boxes) :]

    def is_reached(self, box: int) -> bool:  # noqa: ARG002 - a chain's coordinates are free
        """Return whether the middle of a box is a pose of the mechanism: always."""
        return True

    def contact(self, box: int) -> tuple[float, ...] | None:
        """Return the centre of a box."""
        centre = self.centre[box]
        if self.left_out is not None and self.left_out(centre, np.zeros_like(centre)):
            return None
        return tuple(centre.tolist())
