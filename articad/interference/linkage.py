"""Proof along a driver of loops or couplings: the joints that follow stay near lines that the checker of certificates can verify.

Over a short piece of the driver's range every coordinate is the only solution near its linear predictor (Brouwer, Banach), so that a
box with one long side holds it, on which the bounds of `spread` hold. Where that does not suffice the piece is halved about a solution
of its own, and its tube shrinks fourfold. The inequalities are the checker's own: what it would not believe is not built upon.
Most pairs need no piece of their own: all pieces in a row lie in one wider tube, which is tried first and then parted.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.interference.clearing import Boxes, CannotCut, Cleared
from articad.interference.motion import Chain, Route, proven_freedoms, turns
from articad.interference.overlap import Overlap, overlap
from articad.interference.proof import Proof, Prover, Shrink
from articad.interference.scene import Scene
from articad.interference.spread import Spread
from articad.interference.verdict import UNRELATED_VOLUME_MM3
from articad.interference.work import PIECE, Budget
from articad.kinematics.joints import Coordinate, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.motion import track_of
from articad.verify_certificate import PROOF, Checker, Refuted, joined

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SMALLEST_STEP = 1e-6  # of the driver's range, below which it is not followed further
FIRST_STEP = 1 / 32  # of the way to a bound
WIDER = 1.2  # than the distance within which there is a solution: that within which there is no other one
ROOM = (2e-4, 2e-6)  # rad or mm: of a tube beside what it must hold; much of it lets pieces be long, where many joints follow little holds
SMALLEST_PIECE = 1e-4  # rad or mm: to which the end of what is free along a driver is found
LOOKS = 24  # poses looked at beyond contact


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of the driver's range, or several in a row.

    Attributes:
        ends: Of the driver [rad or mm].
        numbers: Among all pieces, of those it consists of, in the order of the driver.
        line: Of each coordinate that follows, and of the driver: its value in the middle, its rate, and how far it is from that line.
    """

    ends: tuple[float, float]
    numbers: tuple[int, ...]
    line: Mapping[str, tuple[float, float, float]]


class Way:
    """What follows one driver over its range, in pieces that are halved when asked for; shared by all pairs.

    Args:
        mechanism: With loops or couplings.
        driver: Index among its drivers.
        document: Joints, couplings, linkage and drivers as they stand in a certificate.

    Raises:
        LoopError: If the loops cannot be closed.
        ValueError: If nothing follows the driver.
    """

    def __init__(self, mechanism: Mechanism, driver: int, document: Mapping[str, Any]) -> None:
        self.coordinate: Coordinate = mechanism.drivers[driver]
        found = track_of(mechanism, driver, mechanism.rest, certify=False)
        if found is None:
            raise ValueError(f"{self.coordinate.name} drives no loop or coupling")
        self.track, self.follower = found, found.follower
        feasible = mechanism.feasible_range(self.coordinate.name)
        self.bounds = self._bound(feasible.lower, -1), self._bound(feasible.upper, 1)
        self.reasons = feasible.lower_reason, feasible.upper_reason
        self._checker = Checker(dict(document), {PROOF: {}})
        self.names = self._checker.followers(self.coordinate.name)
        self._found = self._checker.begin(self.names)
        self.others: list[int] = []
        self._balls = {
            freedom.name: (joint.name, at)
            for joint in mechanism.joints
            if joint.type is JointType.BALL
            for at, freedom in enumerate(proven_freedoms(joint))
        }
        self._halves: dict[tuple[int, ...], tuple[Piece, Piece]] = {}
        self._steps: dict[int, list[Piece]] = {}

    @property
    def layout(self) -> Layout:
        """Of the joints that take part."""
        return self.follower.system.layout

    def _bound(self, feasible: float, sign: int) -> float:
        """Return the end of the range: the limit, a dead point, or half a turn from rest."""
        declared = self.coordinate.upper if sign > 0 else self.coordinate.lower
        end = min(declared, feasible) if sign > 0 else max(declared, feasible)
        return end if math.isfinite(end) else self.track.start + sign * math.pi

    def steps(self, sign: int) -> list[Piece]:
        """Return the pieces from rest towards one end, as far as it can be followed."""
        if sign not in self._steps:
            at, end = self.track.start, self.bounds[1 if sign > 0 else 0]
            step, last, found = (end - at) * FIRST_STEP, 0, list[Piece]()
            least = abs(end - at) * SMALLEST_STEP
            while at != end and abs(step) > least:
                there = end if abs(end - at) <= abs(step) * 1.5 else at + step
                piece = self._piece((min(at, there), max(at, there)), last)
                if piece is None:
                    step /= 2
                    continue
                found.append(piece)
                at, last, step = there, piece.numbers[0], step * 1.5
            self._steps[sign] = found
        return self._steps[sign]

    def reached(self, sign: int) -> float:
        """Return how far the pieces go towards one end."""
        steps = self.steps(sign)
        return steps[-1].ends[1 if sign > 0 else 0] if steps else self.track.start

    @cached_property
    def whole(self) -> Piece:
        """All that can be followed, as one."""
        steps = [*self.steps(-1)[::-1], *self.steps(1)]
        return self._joined(tuple(step.numbers[0] for step in steps))

    def halves(self, piece: Piece) -> tuple[Piece, Piece] | None:
        """Return the two halves of a piece, each about a solution of its own; None where that is not to be had. Several are parted."""
        if piece.numbers not in self._halves:
            low, high = piece.ends
            middle, at = (high + low) / 2, (len(piece.numbers) + 1) // 2
            if len(piece.numbers) > 1:
                self._halves[piece.numbers] = self._joined(piece.numbers[:at]), self._joined(piece.numbers[at:])
                return self._halves[piece.numbers]
            halves = self._piece((low, middle), piece.numbers[0]), self._piece((middle, high), piece.numbers[0])
            if halves[0] is None or halves[1] is None:
                return None
            self._halves[piece.numbers] = halves[0], halves[1]
        return self._halves[piece.numbers]

    def _joined(self, numbers: tuple[int, ...]) -> Piece:
        """Return pieces in a row as one."""
        rows = [self._found[number] for number in numbers]
        ends = np.array([*(row[0][0] for row in rows), rows[-1][0][1]])
        line = joined(ends, [row[1:4] for row in rows])
        named = dict(zip(self.names, zip(*(part.tolist() for part in line), strict=True), strict=True))
        return Piece((float(ends[0]), float(ends[-1])), numbers, named)

    def _piece(self, ends: tuple[float, float], beside: int) -> Piece | None:
        """Return a piece on the branch of another one if the checker would believe it."""
        span = np.array(ends)
        guess = self._solution(float(span.mean()))
        if guess is None:
            return None
        for room in ROOM:
            with contextlib.suppress(Refuted):
                self._checker.join(self._found, self.names, span, guess, self._tube(span, guess, room), beside)
                self.others.append(beside)
                return self._joined((len(self._found) - 1,))
        return None

    def _tube(self, ends: FloatArray, guess: FloatArray, room: float) -> FloatArray:
        """Return distances within which there should be no other solution."""
        _, J, share = self._checker.closure(self.names, guess, guess)
        A, wide = np.linalg.pinv(J[:, 1:], rcond=1e-7), np.zeros(len(self.names))
        rate = np.array([1.0, *(-A @ J[:, 0])])
        half = (ends[1] - ends[0]) / 2
        far = np.abs(rate) * half
        off = np.abs(A @ self._checker.closure(self.names, guess + half * rate, guess)[0])
        for _ in range(6):
            wide[1:] = WIDER * (off + room + np.abs(A) @ (np.minimum(share @ (far + wide), 1.0) * (share @ wide)))
        return wide

    def _solution(self, value: float) -> FloatArray | None:
        """Return what the driver and its followers are at a value of it."""
        Q, reached, _ = self.track.evaluate(np.array([value]))
        if not reached[0]:
            return None
        known = self.values(Q[0])
        return np.array([value, *(known.get(name, self._checker.rest[name]) for name in self.names[1:])])

    def values(self, Q: FloatArray) -> dict[str, float]:
        """Return the coordinates of the joints that take part as they are proven: a ball's are turns."""
        found = {name: float(Q[column]) for name, column in self.layout.column_of.items()}
        for name, (joint, at) in self._balls.items():
            if joint in self.layout.columns:
                found[name] = turns(SE3.from_quaternion(Q[self.layout.columns[joint]]).rotation)[at]
        return found

    def arrays(self) -> dict[str, FloatArray | IntArray]:
        """Return all pieces as a checker reads them."""
        rows = self._found[1:]
        return {
            f"{self.coordinate.name}.ends": np.array([row[0] for row in rows]).reshape(-1, 2),
            f"{self.coordinate.name}.values": np.array([row[1] for row in rows]).reshape(-1, len(self.names)),
            f"{self.coordinate.name}.wide": np.array([row[4] for row in rows]).reshape(-1, len(self.names)),
            f"{self.coordinate.name}.other": np.array(self.others, dtype=np.int64),
        }


class Steps:
    """Boxes along a way, and of further coordinates that move by themselves.

    Args:
        way: Of the driver.
        chain: Between two parts.
        others: Bounds of the chain's coordinates that do not follow; NaN for those that do.
        step: To be covered; by default the whole way.
    """

    price = PIECE

    def __init__(self, way: Way, chain: Chain, others: FloatArray, step: Piece | None = None) -> None:
        self.way, self.chain, self.spread = way, chain, Spread(chain)
        self.free = np.flatnonzero(~np.isnan(others[:, 0]))
        self.others = others
        self.step = way.whole if step is None else step
        self.rows: list[tuple[Piece, FloatArray]] = []
        self.outside, self.columns, self.places, self.halves = list[bool](), list[int](), list[float](), list[tuple[int, int]]()

    def root(self) -> IntArray:
        """Add all of it, with the whole range of the other coordinates."""
        return self._add([(self.step, self.others)])

    def _add(self, rows: list[tuple[Piece, FloatArray]]) -> IntArray:
        centres, lines, tubes = (np.array(part) for part in zip(*(self._placed(*row) for row in rows), strict=True))
        generators = np.concatenate([lines[:, None], tubes[:, :, None] * np.eye(tubes.shape[1])], axis=1)
        self.rows += rows
        self.outside += [False] * len(rows)
        self.columns += [-1] * len(rows)
        self.places += [math.nan] * len(rows)
        self.halves += [(-1, -1)] * len(rows)
        return self.spread.add(centres, np.abs(lines) + tubes, generators)

    def _placed(self, step: Piece, ends: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the chain's coordinates, and of each factor how far it goes along the line and aside of it."""
        values = np.where(np.isnan(ends[:, 0]), self.chain.rest, ends.mean(axis=1))  # another driver stands
        line, aside = np.zeros(len(self.spread.factors)), np.zeros(len(self.spread.factors))
        half = (step.ends[1] - step.ends[0]) / 2
        for f, (_, factor) in enumerate(self.spread.factors):
            name = self.chain.freedoms[factor.column].name
            if name in step.line:
                values[factor.column], rate, aside[f] = step.line[name]
                line[f] = rate * half
            elif factor.column in self.free:
                aside[f] = (ends[factor.column, 1] - ends[factor.column, 0]) / 2
        return values, line, aside

    def cut(self, boxes: IntArray, share: FloatArray) -> IntArray:
        """Halve the piece, or the range of a coordinate that moves by itself, whichever has the larger share."""
        pairs = [self._cut(int(box), share[row]) for row, box in enumerate(boxes.tolist())]
        numbers = self._add([half for pair in pairs for half in pair]).reshape(-1, 2)
        for box, halves in zip(boxes.tolist(), numbers.tolist(), strict=True):
            self.halves[box] = halves[0], halves[1]
        return numbers

    def _cut(self, box: int, share: FloatArray) -> list[tuple[Piece, FloatArray]]:
        step, ends = self.rows[box]
        own = np.full(len(ends), -1.0)
        for f, (_, factor) in enumerate(self.spread.factors):
            if factor.column in self.free:
                own[factor.column] = share[1 + f]
        halves = self.way.halves(step) if own.max() <= share.sum() - np.maximum(own, 0.0).sum() or not len(self.free) else None
        if halves is not None or not len(self.free):
            self.columns[box] = 0
            if halves is None:
                raise CannotCut
            self.places[box] = halves[0].ends[1]
            return [(part, ends) for part in halves]
        at = int(np.argmax(own))
        self.columns[box] = 1 + int(np.searchsorted(self.free, at))
        low, high = ends.copy(), ends.copy()
        low[at, 1] = high[at, 0] = self.places[box] = (ends[at, 0] + ends[at, 1]) / 2
        return [(step, low), (step, high)]

    def is_reached(self, box: int) -> bool:
        """Return whether the middle of a box is a pose of the mechanism: of a piece; in that of several the loops need not close."""
        return len(self.rows[box][0].numbers) == 1

    def contact(self, box: int) -> tuple[float, ...] | None:
        """Return the chain's coordinates at the middle of a box; none if the mechanism does not reach it."""
        return tuple(self._placed(*self.rows[box])[0].tolist()) if self.is_reached(box) else None

    def value(self, box: int) -> float:
        """Return the driver's value at the middle of a box."""
        return sum(self.rows[box][0].ends) / 2


class LinkageProver(Prover):
    """Proves one pair of parts while one driver moves the loops and couplings between them.

    Args:
        scene: Bodies and relations.
        route: Joints from the one part to the other.
        joints: Names of those that move: all that follow, and those that move by themselves.
        way: Of the driver.
        epsilon: What is closer by no more is contact [mm].
        budget: Shared by all proofs.
    """

    def __init__(
        self, scene: Scene, route: Route, joints: Sequence[str], way: Way, *, epsilon: float = 1e-3, budget: Budget | None = None
    ) -> None:
        super().__init__(scene, route, joints, epsilon=epsilon, budget=budget)
        self.way, self.coordinate = way, way.coordinate
        followed = set(way.layout.columns)
        mine = [mover.joint.name in followed for mover in self.chain.movers for _ in mover.columns]
        self.others = np.where(np.array(mine)[:, None], np.nan, self.bounds)
        self._last: Steps | None = None

    @property
    def is_line(self) -> bool:
        """False: what is found of a range is found along the driver."""
        return False

    def ends(self, column: int) -> tuple[float, float]:
        """Return between which values a coordinate of the chain stays: those that follow stay near the line over the whole way."""
        name, (low, high) = self.chain.freedoms[column].name, self.way.whole.ends
        if name not in self.way.whole.line:
            return super().ends(column)
        value, rate, near = self.way.whole.line[name]
        far = abs(rate) * (high - low) / 2 + near
        return value - far, value + far

    def boxes(self, bounds: FloatArray) -> Boxes:  # noqa: ARG002  the way knows its range
        """Return the steps along the driver."""
        self._last = Steps(self.way, self.chain, self.others)
        return self._last

    def vary(self, bounds: FloatArray) -> dict[str, tuple[float, float]]:  # noqa: ARG002
        """Return the driver's range that was cleared, and those of the coordinates that move by themselves."""
        own = {
            freedom.name: (freedom.lower, freedom.upper)
            for freedom, (low, _) in zip(self.chain.freedoms, self.others, strict=True)
            if not math.isnan(low)
        }
        return {self.coordinate.name: (self.way.reached(-1), self.way.reached(1)), **own}

    def _proof(self, begun: Proof, shrink: Shrink, most: int) -> Proof:
        outcome: Cleared = self.search(self.bounds, shrink, most)
        found = replace(begun, out_of_budget=outcome.out_of_budget, shrink=shrink, epsilon=shrink.depth or self.epsilon)
        if outcome.is_complete:
            vary = self.vary(self.bounds)
            lower, upper = vary[self.coordinate.name]
            claim = replace(self.claim(begun.overlap, vary, shrink, outcome), start={self.coordinate.name: self.way.track.start})
            return replace(found, claims=(claim,), lower=lower, upper=upper)
        if outcome.contact is None or self._last is None:
            return found
        return replace(found, contacts=(self.named(outcome.contact),), stopped_at=(self._last.value(outcome.box),))

    def seen(self, begun: Proof) -> dict[str, Any]:
        """Return where the two overlap beyond what is allowed at one of a few values of the driver, if they do."""
        own = self.named(self.chain.rest)
        values = np.linspace(*self.way.bounds, 2 * LOOKS)
        Q, reached, _ = self.way.track.evaluate(values)
        places = [(self.depth(self._values(row, own)), value, row) for row, value in zip(Q[reached], values[reached].tolist(), strict=True)]
        depth, value, row = max(places, key=lambda place: place[0], default=(0.0, 0.0, Q[0]))
        if depth <= max(self.allowed, begun.overlap.depth):
            return {}
        return {"contacts": (self.named(self._values(row, own)),), "stopped_at": (value,)}

    def collides(self, proof: Proof) -> bool:
        """Return whether the two overlap beyond what is allowed near where a proof stopped, or further on."""
        worst, _ = self.worst(proof)
        return worst.depth > self.allowed and worst.volume > UNRELATED_VOLUME_MM3

    def free_range(self, shrink: Shrink) -> tuple[float, float]:
        """Return how far from rest the driver may go either way."""
        ends = [self.way.track.start, self.way.track.start]
        for end, sign in enumerate((-1, 1)):
            todo = list(self.way.steps(sign)[::-1])
            while todo:
                step = todo.pop()
                if self.search_over(Steps(self.way, self.chain, self.others, step), shrink).is_complete:
                    ends[end] = step.ends[end]
                    continue
                halves = self.way.halves(step) if step.ends[1] - step.ends[0] > SMALLEST_PIECE else None
                if halves is None:
                    break
                todo += halves[::-sign]
        return ends[0], ends[1]

    def worst(self, proof: Proof) -> tuple[Overlap, float | None]:
        """Return the deepest overlap from where a proof stopped to the end, and the driver's value there."""
        worst, where = proof.overlap, None
        for contact, value in zip(proof.contacts, proof.stopped_at, strict=False):
            end = self.way.bounds[1] if value >= self.way.track.start else self.way.bounds[0]
            values = value + (end - value) * np.linspace(0.0, 1.0, LOOKS) ** 3  # closely at first
            Q, reached, _ = self.way.track.evaluate(values)
            for row, q in zip(Q[reached], values[reached].tolist(), strict=True):
                self.budget.spend(self.look_price)
                found = overlap(self.body_a, self.body_b, SE3.from_matrix(self.chain.matrix(self._values(row, contact))))
                if found.depth > worst.depth:
                    worst, where = found, q
        return worst, where

    def _values(self, Q: FloatArray, known: Mapping[str, float]) -> list[float]:
        """Return the chain's coordinates where the linkage is at Q, those that move by themselves as at a contact."""
        followed = self.way.values(Q)
        return [followed.get(freedom.name, known[freedom.name]) for freedom in self.chain.freedoms]
