"""Branch and bound: prove that two surfaces stay apart over boxes of motion.

A row is a piece of each surface and a box of the motion. The search starts with the whole surfaces over the whole range. A row is
settled when a direction u separates its pieces: the gap along u at the centre of the box, minus a bound of the motion along u
(`Spread.first_order` + `Spread.second_order`), exceeds the required distance. Otherwise the row is cut in two: the range if the motion
exceeds the size of the pieces, else the larger piece. So pieces near an axis get small bounds, and distant pieces are settled early.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.certificates.profile import Forest
from articad.certificates.rows_last import dot, lengths, over_three
from articad.certificates.spread import Spread
from articad.certificates.trail import CUT_A, CUT_B, CUT_RANGE, LEAN, OF_A, OF_B, ROUND, SWUNG, Trail
from articad.connectors.quaternion import cross
from articad.interference.surface import Core
from articad.interference.work import BOX, STEP, WorkBudget

IntArray = NDArray[np.signedinteger[Any]]

ROUNDING_MM = 1e-9  # margin on distances for rounding in the arithmetic of poses
CHUNK = 4096  # pairs of pieces processed together
BLOCK = 1024  # of them whose bounds are computed together
MOTION_SHARE = 1.0  # of the pieces' size: if the motion is larger, the range is cut before the pieces
LEAST_SHARE = 1e-3  # of the motion in any direction: along the normal of faces in one plane there is nothing to cut
MOST_PAIRS = 4_000_000  # of pieces, after which a search ends
NEARLY_STILL = 1e-3  # of the largest motion: smaller motions do not choose directions, though they count in every bound
MOST_WAYS = 2  # lines of sliding perpendicular to which directions are sought
_EYE = np.eye(3)
_COARSE = 64.0  # rounding of directions between boxes: any direction is a valid proof, and few different ones take less space


class CannotCut(Exception):  # noqa: N818 - not an error
    """A box cannot be split further."""


class Boxes(Protocol):
    """Boxes of the motion, stored as a binary tree: each box can be split in two.

    Attributes:
        spread: Pose and velocities of each box.
        outside: For each box, whether it lies outside the limits of the joints.
        columns: For each box, the index of the claim's coordinate across which it was split; −1 if it was not split.
        places: For each box, the value at which it was split [rad or mm].
        halves: For each box, the numbers of its two halves.
    """

    spread: Spread
    outside: list[bool]
    columns: list[int]
    places: list[float]
    halves: list[tuple[int, int]]

    @property
    def work(self) -> int:
        """Units of work that the boxes have cost so far."""

    def root(self) -> IntArray:
        """Add the whole range, and return its number."""

    def cut(self, boxes: IntArray, share: FloatArray) -> IntArray:
        """Split boxes `(k,)` across the coordinate with the largest `share (k, G)` of the motion; return the numbers of the halves `(k, 2)`."""

    def is_reached(self, box: int) -> bool:
        """Return whether the centre of a box is a pose of the mechanism."""

    def contact(self, box: int) -> tuple[float, ...] | None:
        """Return the centre of a box as coordinates to report, or None if it lies outside the limits of joints."""


@dataclass
class Cleared:
    """The result of a search.

    Attributes:
        contact: Centre of a box in which the surfaces are in contact; None if the search found no contact.
        box: Number of that box; −1 if there is none.
        out_of_budget: True if the search ended without a result.
        pairs: Number of rows examined.
        boxes: Number of boxes examined.
        trail: Record of all steps, which a checker can repeat.
        course: The boxes of the search.
        left: The search, if the budget or the number of rows ended it, so that it can go on; None otherwise.
    """

    contact: tuple[float, ...] | None = None
    box: int = -1
    out_of_budget: bool = False
    pairs: int = 0
    boxes: int = 0
    trail: Trail | None = None
    course: Boxes | None = None
    left: _Search | None = None

    @property
    def is_complete(self) -> bool:
        """True if the surfaces stay apart over the whole range."""
        return self.contact is None and not self.out_of_budget

    def continued(self, budget: WorkBudget, most: int) -> Cleared:
        """Return the result of going on where the search ended: that of one search with the larger budget from the beginning.

        Args:
            budget: Work is spent from it.
            most: Largest number of rows, those examined so far included.
        """
        return self if self.left is None else self.left.run(budget, most)


@dataclass
class _Pairs:
    """Rows of the search: a node of each tree, a box, and the row's number in the trail; each array is `(rows,)`."""

    a: IntArray
    b: IntArray
    box: IntArray
    number: IntArray

    def __len__(self) -> int:
        return len(self.a)

    @classmethod
    def of_all(cls, some: Sequence[_Pairs]) -> _Pairs:
        return cls(*(np.concatenate(column) for column in zip(*((p.a, p.b, p.box, p.number) for p in some), strict=True)))

    def of(self, rows: NDArray[np.bool_] | IntArray | slice) -> _Pairs:
        return _Pairs(self.a[rows], self.b[rows], self.box[rows], self.number[rows])


def clear(
    a: Forest,
    b: Forest,
    boxes: Boxes,
    needed: float,
    *,
    axis: Core | None = None,
    epsilon: float,
    budget: WorkBudget,
    most: int = MOST_PAIRS,
) -> Cleared:
    """Prove that two surfaces stay farther apart than `needed` [mm] over boxes of motion.

    Args:
        a: Surface of the fixed part.
        b: Surface of the moving part.
        boxes: Boxes of the motion.
        needed: Distance to exceed, for example the deflection of both meshes [mm].
        axis: Axis or point to which the outlines of the forests refer, in the frame of a; None if there are no outlines.
        epsilon: Triangles that come closer than `needed` + `epsilon` at the centre of a box are in contact [mm].
        budget: Work for rows, rounds and boxes is spent from it.
        most: Largest number of rows.

    Returns:
        The trail if the surfaces stay apart; otherwise the contact, or `out_of_budget`.
    """
    return _Search(a, b, boxes, needed + ROUNDING_MM, epsilon, axis).run(budget, most)


class _Search:
    def __init__(self, a: Forest, b: Forest, boxes: Boxes, needed: float, epsilon: float, axis: Core | None) -> None:
        self.forests, self.a, self.b = (a, b), a.tree, b.tree
        self.boxes, self.needed, self.epsilon, self.axis = boxes, needed, epsilon, axis
        self.spread, self.trail = boxes.spread, Trail()
        self.outcome = Cleared(course=boxes)
        self.size_a, self.size_b = np.linalg.norm(self.a.half, axis=1), np.linalg.norm(self.b.half, axis=1)
        self.slides: Slides | None = None
        self.stack = [self.roots()]

    def run(self, budget: WorkBudget, most: int) -> Cleared:
        """Search on until the end, or until the budget is spent or more than `most` rows are examined in all."""
        # depth-first over (piece of a, piece of b, box of motion): each round settles rows by a direction, or cuts one of the three
        stack, outcome, boxes = self.stack, self.outcome, self.boxes
        outcome.out_of_budget, outcome.left = False, None
        while stack and outcome.contact is None:
            if budget.is_spent or outcome.pairs > most:
                outcome.out_of_budget, outcome.left = True, self
                break
            rows = stack.pop()
            while stack and len(rows) < CHUNK:
                rows = _Pairs.of_all([stack.pop(), rows])
            if len(rows) > CHUNK:
                stack.append(rows.of(np.arange(len(rows)) < len(rows) - CHUNK))
                rows = rows.of(np.arange(len(rows)) >= len(rows) - CHUNK)
            outcome.pairs += len(rows)
            before = boxes.work
            try:
                stack += [found for found in self.step(rows) if len(found)]
            except CannotCut:
                outcome.out_of_budget = True
                break
            finally:
                budget.spend(len(rows) + STEP + boxes.work - before, queries=len(rows))
        outcome.boxes = len(boxes.spread)
        if outcome.is_complete:
            outcome.trail = self.trail
        return outcome

    def roots(self) -> _Pairs:
        """Return one row for each pair of trees over the whole range."""
        both = np.array(list(itertools.product(self.forests[0].roots, self.forests[1].roots)))
        root = int(self.boxes.root()[0])
        self.slides = Slides.of(self.spread, root)
        return _Pairs(both[:, 0], both[:, 1], np.full(len(both), root), self.trail.begin(len(both)))

    def step(self, rows: _Pairs) -> list[_Pairs]:
        """Settle the rows that a bound separates; return the halves of all other rows."""
        outside = np.fromiter((self.boxes.outside[box] for box in rows.box.tolist()), dtype=bool, count=len(rows))
        if outside.any():
            rows = rows.of(~outside)
        out: list[_Pairs] = []
        if self.axis is not None:
            rows = self._outlines(rows, out)
        single = (self.a.triangle[rows.a] >= 0) & (self.b.triangle[rows.b] >= 0)
        if not single.all():
            out += self._nodes(rows.of(~single))
        if single.any():
            out += self._triangles(rows.of(single))
        return out

    def _outlines(self, rows: _Pairs, out: list[_Pairs]) -> _Pairs:
        """Settle rows whose outlines (coordinates the joint does not change) are apart, cut those that can become so; return the rest."""
        assert self.axis is not None
        a, b = self.forests
        # intervals of radius and height (or of the angle from a ball's axis) that do not overlap keep the pieces apart at every pose
        ahead, behind = b.low[rows.b] - a.high[rows.a], a.low[rows.a] - b.high[rows.b]
        gap = np.maximum(ahead, behind)
        ball = self.axis.dimensions == 3
        limit = np.full(gap.shape[1], self.needed)
        if ball:
            limit[1] = 0.0  # angles decide there
        far = gap > limit
        apart, best = np.asarray(far.any(axis=1)), np.argmax(far, axis=1)
        for k, code in enumerate((ROUND, LEAN, SWUNG) if ball else (ROUND,)):
            self.trail.keep(rows.number[apart & (np.minimum(best, 2) == k if ball else best == k)], code)
        axes = self.axis.frame[:3, 3 - gap.shape[1] + 1 : 3].T
        for k in () if ball else range(1, gap.shape[1]):
            for side, sign in ((ahead, 1.0), (behind, -1.0)):
                which = rows.number[apart & (best == k) & (side[:, k] > self.needed)]
                self.trail.settle(which, OF_A, np.tile(sign * axes[k - 1], (len(which), 1)))
        rows = rows.of(~apart)
        # the larger of two pieces whose outlines can still become disjoint is cut
        whole_a, whole_b = self.a.children[rows.a, 0] < 0, self.b.children[rows.b, 0] < 0
        never = ~(a.meets[rows.a] & b.meets[rows.b]) & ~(whole_a & whole_b)
        first = ((a.high - a.low)[rows.a].max(axis=1) >= (b.high - b.low)[rows.b].max(axis=1)) & ~whole_a | whole_b
        out += [self._cut_a(rows.of(never & first)), self._cut_b(rows.of(never & ~first))]
        return rows.of(~never)

    def _nodes(self, rows: _Pairs) -> list[_Pairs]:
        coarse, thick, ahead, shares, motion = _in_blocks(self._bounds_of_nodes, rows)
        # Gap at the centre of the box of motion, minus the bound of the motion: positive for one direction is a proof.
        still = np.abs(ahead) - thick
        clear = still - motion > self.needed
        left = ~clear.any(axis=1)
        self._settle(rows.of(~left), np.argmax(clear[~left], axis=1), np.sign(ahead[~left]), coarse[~left])
        # Cut the range where the motion along the best direction exceeds the size of the pieces, else cut the larger piece.
        rows, best = rows.of(left), np.argmax(still[left], axis=1)
        at = np.arange(len(rows))
        along, most = motion[left][at, best], motion[left].max(axis=1)
        moving = (along > MOTION_SHARE * thick[left][at, best]) & (along > LEAST_SHARE * most)
        if self.slides is not None:  # then a pair of triangles needs no cut of the range of its own: see `Slides`
            moving[:] = False
        shares = shares[left]
        return [*self._cut_range(rows.of(moving), shares[at, best][moving]), *self._cut_pieces(rows.of(~moving))]

    def _bounds_of_nodes(self, rows: _Pairs) -> tuple[FloatArray, ...]:
        """Return what decides on pairs of boxes, of which D directions are tried.

        Returns:
            Directions between their centres `(n, 1 or 2, 3)`; half the sum of their sizes along all directions `(n, D)` and the distance of
            their centres `(n, D)`; and bounds of the motion: shares of first order `(n, D, G)`, and in all `(n, D)` [mm].
        """
        T, box = self.spread.T[rows.box], rows.box
        R = T[:, :3, :3]
        # Candidate directions: axes of both boxes, and the line between their centres (separating axis test without edge products).
        centre = (R @ self.b.centre[rows.b][..., None])[..., 0] + T[:, :3, 3]
        extent = R.transpose(0, 2, 1) * self.b.half[rows.b][..., None]  # rows: half axes of b's box in a's frame
        apart = centre - self.a.centre[rows.a]
        coarse = (_coarse(apart) if self.slides is None else self.slides.across(apart))[:, None]
        if self.axis is not None and self.slides is None:
            coarse = np.concatenate([coarse, self._turning(self.a.centre[rows.a], centre)[:, None]], axis=1)
        u = np.concatenate([np.broadcast_to(_EYE, (len(rows), 3, 3)), R.transpose(0, 2, 1), unit(coarse)], axis=1)
        thick = (np.abs(u) @ self.a.half[rows.a][..., None])[..., 0] + over_three(np.add, np.abs(u @ extent.transpose(0, 2, 1)))
        ahead = (u @ apart[..., None])[..., 0]
        shares = self.spread.first_order(box, u, centre, extent)
        return coarse, thick, ahead, shares, shares.sum(axis=2) + self.spread.second_order(box, u, centre, self.size_b[rows.b], extent)

    def _settle(self, rows: _Pairs, best: IntArray, sign: FloatArray, coarse: FloatArray) -> None:
        """Record the directions that settled pieces: axes of a, of b, or between the two."""
        axis = np.tile(_EYE, (2, 1))
        for which, kind in ((best < 3, OF_A), ((best >= 3) & (best < 6), OF_B)):
            chosen = best[which]
            self.trail.settle(rows.number[which], kind, axis[chosen] * sign[which, chosen][:, None])
        between = best >= 6
        self.trail.settle(rows.number[between], OF_A, coarse[between, best[between] - 6] * sign[between, best[between]][:, None])

    def _turning(self, p: FloatArray | NDArray[np.float32], q: FloatArray) -> FloatArray:
        """Return the directions, `(n, 3)`, in which points of a and b differ in angle about the axis: a turn moves them so."""
        assert self.axis is not None
        core = self.axis
        return _coarse((unit(core.local(q)) - unit(core.local(np.asarray(p, dtype=np.float64)))) @ core.frame[:3, : core.dimensions].T)

    def _cut_pieces(self, rows: _Pairs) -> list[_Pairs]:
        """Cut the larger piece of each pair that has any to cut."""
        whole_a, whole_b = self.a.children[rows.a, 0] < 0, self.b.children[rows.b, 0] < 0
        first = ~whole_a & (whole_b | (self.size_a[rows.a] >= self.size_b[rows.b]))
        return [self._cut_a(rows.of(first)), self._cut_b(rows.of(~first))]

    def _cut_a(self, rows: _Pairs) -> _Pairs:
        numbers = self.trail.cut(rows.number, CUT_A)
        return _Pairs(self.a.children[rows.a].ravel(), np.repeat(rows.b, 2), np.repeat(rows.box, 2), numbers)

    def _cut_b(self, rows: _Pairs) -> _Pairs:
        numbers = self.trail.cut(rows.number, CUT_B)
        return _Pairs(np.repeat(rows.a, 2), self.b.children[rows.b].ravel(), np.repeat(rows.box, 2), numbers)

    def _cut_range(self, rows: _Pairs, shares: FloatArray) -> list[_Pairs]:
        if not len(rows):
            return []
        boxes, where = np.unique(rows.box, return_inverse=True)
        new = np.array([self.boxes.columns[box] < 0 for box in boxes.tolist()])
        if new.any():
            total = np.zeros((len(boxes), shares.shape[1]))
            np.add.at(total, where, shares / np.maximum(shares.sum(axis=1, keepdims=True), 1e-300))
            self.boxes.cut(boxes[new], total[new])
        halves = np.array([self.boxes.halves[box] for box in boxes.tolist()])[where]
        numbers = self.trail.cut(rows.number, CUT_RANGE)
        return [_Pairs(np.repeat(rows.a, 2), np.repeat(rows.b, 2), halves.ravel(), numbers)]

    def _triangles(self, rows: _Pairs) -> list[_Pairs]:
        u, own, nearest, ahead, gap, shares, moved = _in_blocks(self._bounds_of_triangles, rows)
        box, clear = rows.box, gap > self.needed
        first = np.argmax(clear, axis=1)
        done = clear.any(axis=1)
        for which, kind in ((done & (first != 1), OF_A), (done & (first == 1), OF_B)):
            chosen = u[which, first[which]]
            if kind == OF_B:  # in the frame of b, so that a face has the same direction at every pose
                chosen = own[which] * np.where(ahead[which, 1], 1.0, -1.0)[:, None]
            self.trail.settle(rows.number[which], kind, chosen)
        left = np.flatnonzero(~done)
        touching = left[nearest[left] <= self.needed + self.epsilon]
        for row in touching:
            contact = self.boxes.contact(int(box[row]))
            if contact is not None:
                self.outcome.contact, self.outcome.box = contact, int(box[row])
                return []
        # if it does not move and yet is not apart, it pierces the other: then there is no distance
        stuck = moved[left] < self.epsilon / 4
        stuck[stuck] = [self.boxes.is_reached(box) for box in box[left][stuck].tolist()]
        if stuck.any():
            row = int(left[np.argmax(stuck)])
            self.outcome.box = int(box[row])
            self.outcome.contact = self.boxes.contact(self.outcome.box) or ()
            return []
        return self._cut_range(rows.of(left), shares[left] + 1e-300)

    def _bounds_of_triangles(self, rows: _Pairs) -> tuple[NDArray[Any], ...]:
        """Return what decides on pairs of triangles, of which D directions are tried.

        Returns:
            The directions from a to b `(n, D, 3)`; the normals of b in its own frame `(n, 3)`; the distances `(n,)`; whether b is ahead of a
            along a direction as it was found `(n, D)`; the gaps along directions over the boxes `(n, D)`; for the widest gap at the centres
            of the boxes the shares of the motion `(n, G)`; and the largest bound of the motion `(n,)` [mm].
        """
        T, box = self.spread.T[rows.box], rows.box
        p = self.a.corners[self.a.triangle[rows.a]]
        q = self.b.corners[self.b.triangle[rows.b]] @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3]
        # Candidate directions: both normals, the shortest connection, and the directions of `Slides` or of the turn.
        # The normal of b's triangle is computed in its own frame, where it is recorded: that of a needle is decided by rounding.
        nearest, towards = shortest_between(p, q)
        own = _normals(self.b.corners[self.b.triangle[rows.b]])
        u = np.stack([_normals(p), (T[:, :3, :3] @ own[..., None])[..., 0], towards], axis=1)
        if self.slides is not None:
            u = np.concatenate([u, self.slides.directions(box, p, q)], axis=1)
        elif self.axis is not None:
            u = np.concatenate([u, unit(self._turning(p.mean(axis=1), q.mean(axis=1)))[:, None]], axis=1)
        mine, theirs = u @ p.transpose(0, 2, 1), u @ q.transpose(0, 2, 1)  # (n, D, 3 corners)
        before, behind = (over_three(np.minimum, x) - over_three(np.maximum, y) for x, y in ((theirs, mine), (mine, theirs)))
        ahead = before > behind
        u, mine, theirs = (np.where(ahead[..., None], part, -part) for part in (u, mine, theirs))
        # Bound of the motion of each corner; the gap is the least over the corners, since the motion is bounded at each of them.
        shares = self.spread.first_order(box, u, q, None)  # (n, D, 3 corners, G)
        motion = shares.sum(axis=3) + self.spread.second_order(box, u, q, np.zeros(len(rows)))
        gap = over_three(np.minimum, theirs - motion) - over_three(np.maximum, mine)
        best = np.argmax(np.maximum(before, behind), axis=1)
        return u, own, nearest, ahead, gap, shares[np.arange(len(rows)), best].max(axis=1), motion.max(axis=(1, 2))


def _in_blocks(bounds: Callable[[_Pairs], tuple[NDArray[Any], ...]], rows: _Pairs) -> list[NDArray[Any]]:
    """Return what a function finds for rows, called for few rows at a time: their arrays stay in the processor's cache."""
    found = [bounds(rows.of(slice(start, start + BLOCK))) for start in range(0, max(len(rows), 1), BLOCK)]
    return [column[0] if len(column) == 1 else np.concatenate(column) for column in zip(*found, strict=True)]


def unit(v: FloatArray) -> FloatArray:
    """Return vectors `(…, k)` scaled to length 1; zero vectors stay zero."""
    sizes = lengths(v)[..., None] if v.shape[-1] == 3 else np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(v / np.maximum(sizes, 1e-300))


def _coarse(u: FloatArray) -> FloatArray:
    """Return directions rounded so that few different ones remain."""
    return np.asarray(np.round(u / np.maximum(np.abs(u).max(axis=1, keepdims=True), 1e-300) * _COARSE) / _COARSE)


def _normals(p: FloatArray) -> FloatArray:
    n = cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    size = lengths(n)
    return np.asarray(n / np.where(size > 0, size, 1.0)[:, None])


def shortest_between(p: FloatArray, q: FloatArray, *, flat: bool = False) -> tuple[FloatArray, FloatArray]:
    """Return the distance of triangles `(n, 3, 3)` each that do not pierce one another, and the direction in which it is measured.

    For `flat` triangles, all in parallel planes or lines, only edges are compared: their outlines decide.

    It is reached between two edges, or between a corner and the inside of the other triangle (Ericson, Real-time collision detection,
    5.1). Any direction proves its own gap, so nothing depends on this being exact.
    """
    # all in arrays with the rows last; of edge i of p and edge j of q: (3 components, i, j, n)
    P, Q = (np.ascontiguousarray(v.transpose(2, 1, 0)) for v in (p, q))
    D, E = (np.roll(V, -1, axis=1) - V for V in (P, Q))
    d, e, between = D[:, :, None], E[:, None], P[:, :, None] - Q[:, None]
    products = (np.roll(p, -1, axis=1) - p) @ (np.roll(q, -1, axis=1) - q).transpose(0, 2, 1)
    a, f, b = dot(d, d), dot(e, e), np.ascontiguousarray(products.transpose(1, 2, 0))
    c, g = dot(d, between), dot(e, between)
    below = a * f - b * b
    s = np.clip((b * g - c * f) / np.where(below > 1e-12 * a * f, below, np.inf), 0.0, 1.0)
    t = np.clip((b * s + g) / np.maximum(f, 1e-300), 0.0, 1.0)
    s = np.clip((b * t - c) / np.maximum(a, 1e-300), 0.0, 1.0)
    found = (t * e - s * d - between).reshape(3, 9, len(p))
    if not flat:
        found = np.concatenate([found, _over(p, q).T, -_over(q, p).T], axis=1)
    squares = dot(found, found)
    nearest = np.argmin(squares, axis=0)
    rows = np.arange(len(p))
    size = np.sqrt(squares[nearest, rows])
    finite = np.isfinite(size) & (size > 0)
    return size, np.asarray((found[:, nearest, rows] / np.where(finite, size, 1.0)).T.copy())


def _over(p: FloatArray, q: FloatArray) -> FloatArray:
    """Return the vectors from the inside of p perpendicularly to the corners of q, `(n, 3, 3)`; very long if these are not above it."""
    n = _normals(p)
    up = [q - p[:, None, k] for k in range(3)]
    inside = np.ones(q.shape[:2], dtype=bool)
    for k in range(3):
        edge = p[:, (k + 1) % 3] - p[:, k]
        inside &= (up[k] @ cross(n, edge)[..., None])[..., 0] >= 0
    return np.asarray(np.where(inside[..., None], (up[0] @ n[..., None]) * n[:, None], 1e150))


class Slides:
    """Directions that separate two triangles while one of them slides along one line, or in one plane, without turning.

    The displacements of a box are Σ tₖ gₖ with |tₖ| ≤ 1 for one or two vectors g. The distance of two convex bodies is a convex function
    of t, so it is smallest where each tₖ is −1, or 1, or where the direction of the distance is perpendicular to gₖ. So if two triangles
    can be separated, one direction of these cases does it, and the range need not be cut for them: with one g, the direction between
    their projections along g, and those at both ends.

    Args:
        spread: Bounds of the boxes.
        ways: Unit vectors along g, `(k, 3)`.
        groups: Generators of first order along each of them, `(k, G)`: those along the same line add up.
    """

    def __init__(self, spread: Spread, ways: FloatArray, groups: NDArray[np.bool_]) -> None:
        self.spread, self.ways, self.groups = spread, ways, groups
        self._basis = _complement(ways)

    @classmethod
    def of(cls, spread: Spread, root: int) -> Slides | None:
        """Return the object for boxes cut from `root`; None if something turns, or slides along more than two lines."""
        flow = spread.flow[root]
        size = np.linalg.norm(flow, axis=1)
        left = size > NEARLY_STILL * size.max(initial=0.0)
        if spread.turns.any() or not left.any():
            return None
        ways, groups = list[FloatArray](), list[NDArray[np.bool_]]()
        while left.any():
            ways.append(unit(flow[np.argmax(size * left)]))
            groups.append(left & (np.linalg.norm(flow - np.outer(flow @ ways[-1], ways[-1]), axis=1) <= NEARLY_STILL * size))
            left = left & ~groups[-1]
        return cls(spread, np.array(ways), np.array(groups)) if len(ways) <= MOST_WAYS else None

    def across(self, apart: FloatArray) -> FloatArray:
        """Return the directions of vectors `(n, 3)` perpendicular to all slides, rounded so that few different ones remain."""
        return np.asarray(_coarse(apart @ self._basis.T) @ self._basis)

    def directions(self, box: IntArray, p: FloatArray, q: FloatArray) -> FloatArray:
        """Return directions `(n, D, 3)`, one of which separates triangles `(n, 3, 3)` over their boxes if any does."""
        far = np.linalg.norm(self.spread.flow[box], axis=2) @ self.groups.T
        found = []
        for signs in itertools.product((0, -1, 1), repeat=len(self.ways)):
            there = q + ((far * signs) @ self.ways)[:, None]
            basis = _complement(self.ways[np.array(signs) == 0])
            found.append(shortest_between(p @ basis.T @ basis, there @ basis.T @ basis, flat=len(basis) < 3)[1])
        return np.stack(found, axis=1)


def _complement(ways: FloatArray) -> FloatArray:
    """Return unit vectors perpendicular to the given ones, `(3 - k, 3)`, and to each other."""
    return np.asarray(np.linalg.svd(ways)[2][len(ways) :]) if len(ways) else _EYE


class Ranges:
    """Boxes of a chain's own coordinates, from the bounds of each.

    Args:
        spread: Empty, of the chain.
        bounds: Bounds of each coordinate.
        left_out: Function: which boxes (lower ends `(k, n)`, upper ends) lie outside the limits of joints, `(k,)`.
    """

    def __init__(
        self, spread: Spread, bounds: FloatArray, left_out: Callable[[FloatArray, FloatArray], NDArray[np.bool_]] | None = None
    ) -> None:
        self.spread, self.bounds, self.left_out = spread, bounds, left_out
        self.ends = np.empty((0, len(bounds), 2))
        self.outside, self.columns, self.places, self.halves = list[bool](), list[int](), list[float](), list[tuple[int, int]]()

    @property
    def work(self) -> int:
        """Units of work that the boxes have cost so far."""
        return BOX * len(self.spread)

    def root(self) -> IntArray:
        """Add the whole range."""
        return self._add(self.bounds[None])

    def _add(self, ends: FloatArray) -> IntArray:
        self.ends = np.concatenate([self.ends, ends])
        self.outside += [False] * len(ends) if self.left_out is None else self.left_out(ends[..., 0], ends[..., 1]).tolist()
        self.columns += [-1] * len(ends)
        self.places += [math.nan] * len(ends)
        self.halves += [(-1, -1)] * len(ends)
        columns = [factor.column for _, factor in self.spread.factors]
        return self.spread.add((ends[..., 0] + ends[..., 1]) / 2, np.diff(ends, axis=2)[:, columns, 0] / 2)

    def cut(self, boxes: IntArray, share: FloatArray) -> IntArray:
        """Cut each box across the coordinate with the largest share."""
        by_column = np.full((len(boxes), len(self.bounds)), -1.0)
        for f, (_, factor) in enumerate(self.spread.factors):
            by_column[:, factor.column] = share[:, f]
        by_column[self.ends[boxes, :, 0] >= self.ends[boxes, :, 1]] = -1.0
        at = np.argmax(by_column, axis=1)
        rows = np.arange(len(boxes))
        low, high = self.ends[boxes].copy(), self.ends[boxes].copy()
        low[rows, at, 1] = high[rows, at, 0] = (low[rows, at, 0] + low[rows, at, 1]) / 2
        numbers = self._add(np.stack([low, high], axis=1).reshape(-1, *low.shape[1:])).reshape(-1, 2)
        for box, column, place, halves in zip(boxes.tolist(), at.tolist(), low[rows, at, 1].tolist(), numbers.tolist(), strict=True):
            self.columns[box], self.places[box], self.halves[box] = column, place, (halves[0], halves[1])
        return numbers

    def is_reached(self, box: int) -> bool:  # noqa: ARG002 - a chain's coordinates are free
        """Return whether the centre of a box is a pose of the mechanism: always."""
        return True

    def contact(self, box: int) -> tuple[float, ...] | None:
        """Return the centre of a box."""
        centre = self.ends[box].mean(axis=1)
        if self.left_out is not None and self.left_out(centre[None], centre[None]).any():
            return None
        return tuple(centre.tolist())
