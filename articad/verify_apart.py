"""Whether two surfaces keep apart over boxes of motion, for the checker of certificates.

Written apart from the prover, with NumPy and python-fcl only. Pieces of both surfaces, and of the range, are cut until a direction
separates them by more than they can move along it; what FCL finds too close in the middle of a box is refuted.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import fcl
import numpy as np

from articad.verify_motion import ROUNDING, Mechanism

STILL_MM = 1e-7  # motion within a box so small that what is not apart touches
CHUNK = 4096  # pairs of pieces looked at together
LOOKS = 8  # at pieces of a driver's range either way, before anything is proven
MOST_PAIRS = 40_000_000  # of pieces looked at for one claim


class Tree:
    """Boxes over things with lower and upper ends `(T, k)`, halved along their longest side; node n has children 2n + 1 and 2n + 2."""

    def __init__(self, low: Any, high: Any) -> None:
        levels = max(len(low) - 1, 0).bit_length()
        order, middle, rows = np.minimum(np.arange(2**levels), len(low) - 1)[None], (low + high) / 2, []
        for level in range(levels + 1):
            rows.append((low[order].min(1), high[order].max(1)))
            if level < levels:
                along = np.take_along_axis(middle[order], np.argmax(np.ptp(middle[order], axis=1), axis=1)[:, None, None], axis=2)[..., 0]
                order = np.take_along_axis(order, np.argsort(along, axis=1), axis=1).reshape(2 * len(order), -1)
        (self.low, self.high), self.order = (np.concatenate(ends) for ends in zip(*rows, strict=True)), order[:, 0]
        self.first, self.size = len(self.low) - len(self.order), np.linalg.norm(self.high - self.low, axis=1)  # of the leaves; of all


class Surface(Tree):
    """Triangles `(T, 3, 3)` with boxes over them."""

    def __init__(self, corners: Any) -> None:
        super().__init__(corners.min(1), corners.max(1))
        self.corners, self.sides = corners, np.array(list(itertools.product((0, 1), repeat=3)))

    def points(self, nodes: Any, *, leaf: bool) -> Any:
        """Return the corners of the triangles, or of the boxes, `(n, 3 or 8, 3)`."""
        if leaf:
            return self.corners[self.order[nodes - self.first]]
        return np.where(self.sides, self.high[nodes][:, None], self.low[nodes][:, None])


def normal(t: Any) -> Any:
    """Return unit normals of triangles `(n, 3, 3)`."""
    n = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    return n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)


def across(p: Any, q: Any) -> Any:
    """Return the unit direction between the nearest edges of triangles `(n, 3, 3)` each."""
    d, e, between = (np.roll(p, -1, 1) - p)[:, :, None], (np.roll(q, -1, 1) - q)[:, None], p[:, :, None] - q[:, None]
    a, f, b, c, g = ((x * y).sum(3) for x, y in ((d, d), (e, e), (d, e), (d, between), (e, between)))
    below = a * f - b * b
    s = np.clip((b * g - c * f) / np.where(below > 1e-12 * a * f, below, np.inf), 0, 1)
    t = np.clip((b * s + g) / np.maximum(f, 1e-300), 0, 1)
    s = np.clip((b * t - c) / np.maximum(a, 1e-300), 0, 1)
    v = (t[..., None] * e - s[..., None] * d - between).reshape(-1, 9, 3)
    v = v[np.arange(len(v)), np.argmin((v * v).sum(2), axis=1)]
    return v / np.maximum(np.linalg.norm(v, axis=1, keepdims=True), 1e-300)


class Search:
    """Boxes of the motion of two parts, and what moves in each.

    Args:
        mechanism: Places the parts.
        way: Joints between them.
        claim: What is said of them.
        driver: The coordinate that others on the way follow, or None.
        models: The whole surfaces, `(T, 3, 3)` each: the first as it was moved inwards.
    """

    def __init__(self, mechanism: Mechanism, way: list[Any], claim: dict[str, Any], driver: Any, models: tuple[Any, Any]) -> None:
        self.mechanism, self.way, self.claim, self.driver = mechanism, way, claim, driver
        self.own = {n: ends for n, ends in claim["vary"].items() if n != driver}
        self.boxes, self.rows, self.models = list[Any](), list[Any](), [model(corners) for corners in models]

    def add(self, boxes: list[Any]) -> Any:
        """Add boxes: values of all coordinates, half ranges of those that move, and a piece of the driver's range or None."""
        first = len(self.boxes)
        for values, half, piece in boxes:
            line = piece[3] if piece else {}
            T, steps = self.mechanism.place(self.way, values, single=self.driver is not None)
            steps = [step for step in steps if step[0][0]["name"] in {**half, **line}]
            self.groups = [group for group, *_ in steps]
            w, m = (np.array([step[k] for step in steps]) for k in (1, 2))
            speed = np.array([line[g[0]["name"]][0] * piece[1] if g[0]["name"] in line else 0.0 for g in self.groups])
            aside = np.array([math.hypot(*(half[f["name"]] if f["name"] in half else line[f["name"]][1] for f in g)) for g in self.groups])
            own = aside * [len(g) == 1 for g in self.groups]
            spin, flow = (np.concatenate([(speed @ x)[None], x * own[:, None]]) for x in (w, m))
            self.boxes.append((values, half, piece))
            self.rows.append((T, w, m, np.abs(speed) + aside, spin, flow))
        self.arrays = tuple(np.array(x) for x in zip(*self.rows, strict=True))
        return np.arange(first, len(self.boxes))

    def motion(self, box: Any, u: Any, p: Any) -> tuple[Any, Any]:
        """Bound how far points `(n, k, 3)` go along directions `(n, D, 3)` in boxes: what each coordinate adds, and all together.

        To first order their speed, to second order |u x axis| times the speed that each factor inside gives (see `Certificate`).
        """
        _, w, m, width, spin, flow = (array[box][:, None] for array in self.arrays)
        turns = np.array([float(any(f["turn"][k] for f in g for k in range(3))) for g in self.groups])
        swing = np.array([len(g) > 1 for g in self.groups])
        first = np.abs(np.einsum("ndc,nkgc->ndkg", u, np.cross(spin, p[:, :, None]) + flow))
        arm = p[:, :, None] - m
        first[..., 1:] += np.linalg.norm(np.cross(arm[:, None], u[:, :, None, None]), axis=-1) * width[:, None] * swing
        speed = np.where(swing, np.linalg.norm(arm, axis=-1), np.linalg.norm(np.cross(w, p[:, :, None]) + m, axis=-1))
        turned = (width * turns)[:, 0]
        tilt = np.minimum(np.linalg.norm(np.cross(u[:, :, None], w), axis=-1) + swing, 1.0)
        if not self.parallel:  # an axis is turned by the factors outside it
            tilt = np.minimum(tilt + (np.cumsum(turned, axis=1) - turned)[:, None], 1.0)
        tilt *= turned[:, None]
        outside, inside, second = np.cumsum(tilt, axis=2) - tilt, 0.0, 0.0
        for f in range(len(self.groups) - 1, -1, -1):
            carried = width[..., f] * (speed[..., f] + inside * turns[f])
            second = second + carried[:, None] * (tilt[..., f] + 2 * outside[..., f])[..., None] / 2
            inside = inside + carried
        return first, first.sum(-1) + second

    def apart(self, corners_a: Any, corners_b: Any) -> str:
        """Return why two surfaces do not keep apart over the whole range, or nothing."""
        (roots, probes), looked = self.roots(), 0
        reasons = [self.refuted(box) for box in probes.tolist()]  # what is wrong by much is found at once
        if any(reasons) or not len(corners_a) or not len(corners_b):
            return next(filter(None, reasons), "")
        self.a, self.b, self.halves = Surface(corners_a), Surface(corners_b), dict[int, Any]()
        stack = list[Any]([(0 * roots, 0 * roots, roots)])
        while stack:
            rows = stack.pop()
            if len(rows[0]) > CHUNK:
                stack.append(tuple(row[:-CHUNK] for row in rows))
                rows = tuple(row[-CHUNK:] for row in rows)
            if (looked := looked + len(rows[0])) > MOST_PAIRS:
                return "it takes too long to be proven"
            single = (rows[0] >= self.a.first) & (rows[1] >= self.b.first)
            for leaf in (False, True):
                found, stuck = self.step(*(row[single == leaf] for row in rows), leaf=leaf)
                if stuck is not None:
                    return self.refuted(stuck) or f"the surfaces are not proven apart at {self.boxes[stuck][0]}"
                stack += found
        return ""

    def step(self, x: Any, y: Any, box: Any, *, leaf: bool) -> tuple[list[Any], Any]:
        """Look at pairs of pieces: return those into which they are cut where nothing separates them, or a box that settles it."""
        T = self.arrays[0][box]
        R = T[:, :3, :3]
        p, q = self.a.points(x, leaf=leaf), self.b.points(y, leaf=leaf) @ R.transpose(0, 2, 1) + T[:, None, :3, 3]
        toward = across(p, q) if leaf else q.mean(1) - p.mean(1)
        toward /= np.maximum(np.linalg.norm(toward, axis=1, keepdims=True), 1e-300)
        base = [normal(p)[:, None], normal(q)[:, None]] if leaf else [np.broadcast_to(np.eye(3), R.shape), R.transpose(0, 2, 1)]
        u = np.concatenate([*base, toward[:, None]], axis=1)
        mine, theirs = u @ p.transpose(0, 2, 1), u @ q.transpose(0, 2, 1)
        sign = np.where(theirs.min(2) - mine.max(2) >= mine.min(2) - theirs.max(2), 1.0, -1.0)[..., None]
        shares, moved = self.motion(box, u, q)
        left = ((sign * theirs - moved).min(2) - (sign * mine).max(2)).max(1) <= self.claim["clear_mm"]
        best = np.argmax(((sign * theirs).min(2) - (sign * mine).max(2))[left], axis=1)
        x, y, box, at, most = x[left], y[left], box[left], np.arange(len(best)), moved[left].max(2)
        if leaf and (most.max(1, initial=0.0) < STILL_MM).any():
            return [], int(box[np.argmax(most.max(1) < STILL_MM)])
        thick = (np.ptp(mine, axis=2) + np.ptp(theirs, axis=2))[left][at, best] / 2
        split = np.full(len(x), leaf) | ((most[at, best] > thick) & (most[at, best] > 1e-3 * most.max(1, initial=0.0)))
        share = shares[left].max(2)[at, best]
        for number in set(box[split].tolist()) - set(self.halves):
            self.halves[number] = [*self.cut(number, share[box == number].sum(0)), -1, -1][:2]
        halves = np.array([self.halves[n] for n in box[split].tolist()], dtype=int).reshape(-1, 2)
        found = [(x[split][ok], y[split][ok], n[ok]) for n in halves.T for ok in [n >= 0]]
        x, y, box = x[~split], y[~split], box[~split]
        wide = (x < self.a.first) & ((y >= self.b.first) | (self.a.size[x] >= self.b.size[y]))
        i, j = x[wide], y[~wide]
        found.append((np.concatenate([2 * i + 1, 2 * i + 2]), np.tile(y[wide], 2), np.tile(box[wide], 2)))
        found.append((np.tile(x[~wide], 2), np.concatenate([2 * j + 1, 2 * j + 2]), np.tile(box[~wide], 2)))
        return [rows for rows in found if len(rows[0])], None

    def roots(self) -> Any:
        """Add boxes that cover the whole range, and some of which the middle is looked at."""
        rest = self.mechanism.rest
        middle, half = {n: sum(ends) / 2 for n, ends in self.own.items()}, {n: (hi - lo) / 2 for n, (lo, hi) in self.own.items()}
        ends = [] if self.driver is None else self.claim["vary"][self.driver]
        ways = [way for end in ends if (way := self.mechanism.pieces(self.driver, end))]
        pieces = [[self.mechanism.joined(way) for way in ways], [p for way in ways for p in way[:: 1 + len(way) // LOOKS]]]
        found, probes = (
            self.add([({**(piece[2] if piece else rest), **self.claim["hold"], **middle}, half, piece) for piece in some or [None]])
            for some in pieces
        )
        axes = [w for group, w in zip(self.groups, self.rows[0][1], strict=True) if any(any(f["turn"]) for f in group)]
        self.parallel = all(len(g) == 1 for g in self.groups) and all(np.linalg.norm(np.cross(w, axes[0])) < 1e-12 for w in axes)
        return found, probes

    def cut(self, number: int, shares: Any) -> list[int]:
        """Halve a box across the coordinate that has the largest share of the motion."""
        values, half, piece = self.boxes[number]
        own = {n: sum(shares[1 + k] for k, g in enumerate(self.groups) if n in [f["name"] for f in g]) for n in half}
        name = max(own, key=lambda n: (own[n], half[n]), default=None)
        if name is None or own[name] < shares.sum() - sum(own.values()):
            kept = {n: values[n] for n in [*half, *self.claim["hold"]]}
            found = [({**values, **part[2], **kept}, half, part) for part in self.mechanism.halves(self.driver, piece)]
        else:
            name = max([f["name"] for g in self.groups if name in [f["name"] for f in g] for f in g], key=lambda n: half[n])
            smaller = {**half, name: half[name] / 2}
            found = [({**values, name: values[name] + sign * half[name] / 2}, smaller, piece) for sign in (-1, 1)]
        return list(self.add([box for box in found if not self.outside(*box[:2])]))

    def outside(self, values: dict[str, float], half: dict[str, float]) -> bool:
        """Return whether a box lies outside the cone of a ball."""
        for joint in (joint for joint, _ in self.way if joint["cone"] is not None and joint["freedoms"][0]["name"] in half):
            sx, sy = (max(abs(values[f["name"]]) - half[f["name"]], 0.0) for f in joint["freedoms"][:2])
            if math.hypot(sx, sy) > joint["cone"] + ROUNDING:
                return True
        return False

    def refuted(self, number: int) -> str:
        """Return what FCL says of the distance in the middle of a box if it is too small."""
        T, values = self.rows[number][0], self.boxes[number][0]
        self.models[1].setTransform(fcl.Transform(T[:3, :3], T[:3, 3]))
        if (distance := fcl.distance(*self.models)) > self.claim["clear_mm"]:
            return ""
        where = ", ".join(f"{name} = {values[name]:.6g}" for name in self.claim["vary"])
        return f"at {where} the distance is {distance:.6g} mm, not more than {self.claim['clear_mm']:.6g}"


def model(corners: Any) -> Any:
    """Return triangles `(T, 3, 3)` as an object that FCL can place."""
    bvh = fcl.BVHModel()
    bvh.beginModel(3 * len(corners), len(corners))
    bvh.addSubModel(np.ascontiguousarray(corners.reshape(-1, 3)), np.arange(3 * len(corners)).reshape(-1, 3))
    bvh.endModel()
    return fcl.CollisionObject(bvh)
