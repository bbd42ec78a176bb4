"""Proof along a driver of loops or couplings: the joints that follow are where Kantorovich's theorem says they are.

Kinematics follows the branch in steps small enough that each has exactly one solution, within a tube about its linear predictor.
So over a step every coordinate stays within the tube of a straight line: a box with one long side, on which the bounds of
`spread` hold. Where that does not suffice the step is halved about a solution of its own, and the tube shrinks fourfold.
Most pairs need no step of their own: a run of many steps lies in one wider tube, which is tried first.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.interference.clearing import Boxes, Cleared
from articad.interference.cover import Budget
from articad.interference.motion import Chain, Route, swing_and_twist
from articad.interference.overlap import Overlap, overlap
from articad.interference.proof import Proof, Prover, Shrink
from articad.interference.scene import Scene
from articad.interference.spread import Spread
from articad.interference.verdict import UNRELATED_VOLUME_MM3
from articad.kinematics.continuation import Node
from articad.kinematics.joints import Coordinate, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.motion import track_of

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SMALLEST_STEP = 1e-4  # of the driver, scaled: to which the end of its free range is found
LOOKS = 24  # poses looked at beyond contact
_LINEAR_ROUNDING = 1e-9  # rad or mm: of what is in proportion to the driver
_REACHED = 1e-9  # of the range: what the steps of kinematics leave uncovered


@dataclass(frozen=True, eq=False)
class Step:
    """A piece of the way: from a solution on, by `length`, scaled.

    Attributes:
        sign: Towards growing or falling values of the driver.
        node: Solution at its beginning.
        length: Scaled.
        middle: Coordinates of the predictor at its middle, `(columns,)`.
        line: How far each freedom goes along the line to either end, with its sign, `(freedoms,)` [rad, mm].
        tube: How far each may be from the line, `(freedoms,)` [rad, mm].
    """

    sign: int
    node: Node
    length: float
    middle: FloatArray
    line: FloatArray
    tube: FloatArray


@dataclass(frozen=True, eq=False)
class Run:
    """Several steps of one side in a row, within one tube.

    Attributes:
        steps: From rest outwards.
        middle: Coordinates in the middle of its line, `(columns,)`; of a ball those of the step in the middle.
        line: As of a step, `(freedoms,)` [rad, mm]; of a ball 0.
        tube: As of a step, `(freedoms,)` [rad, mm]; of a ball the largest turn from its middle.
    """

    steps: tuple[Step, ...]
    middle: FloatArray
    line: FloatArray
    tube: FloatArray


class Way:
    """What follows one driver over its range, in steps that are halved when asked for; shared by all pairs.

    Args:
        mechanism: With loops or couplings.
        driver: Index among its drivers.

    Raises:
        LoopError: If the loops cannot be closed.
        ValueError: If nothing follows the driver.
    """

    def __init__(self, mechanism: Mechanism, driver: int) -> None:
        self.coordinate: Coordinate = mechanism.drivers[driver]
        found = track_of(mechanism, driver, mechanism.rest, certify=True)
        if found is None:
            raise ValueError(f"{self.coordinate.name} drives no loop or coupling")
        self.track, self.follower = found, found.follower
        feasible = mechanism.feasible_range(self.coordinate.name)
        self.bounds = self._bound(feasible.lower, -1), self._bound(feasible.upper, 1)
        self.reasons = feasible.lower_reason, feasible.upper_reason
        self._exact = [self.layout.freedom_of(self.layout.column_of[name]) for name in tied_to(mechanism, self.coordinate.name)]
        self._halves: dict[Step | Run, tuple[Step | Run, Step | Run]] = {}
        self._runs: dict[int, list[Step | Run]] = {}
        self._whole: dict[int, list[Step]] = {}

    @property
    def layout(self) -> Layout:
        """Of the joints that take part."""
        return self.follower.system.layout

    def _bound(self, feasible: float, sign: int) -> float:
        """Return the end of the range: the limit, a dead point, or half a turn from rest."""
        declared = self.coordinate.upper if sign > 0 else self.coordinate.lower
        end = min(declared, feasible) if sign > 0 else max(declared, feasible)
        return end if math.isfinite(end) else self.track.start + sign * math.pi

    def steps(self, sign: int) -> list[Step]:
        """Return the steps that kinematics took towards one end."""
        if sign not in self._whole:
            end = self.bounds[1 if sign > 0 else 0]
            trace = self.track.side(end)
            length = min(abs(end - self.track.start) / self._unit, trace.nodes[-1].s)
            stations = [node for node in trace.nodes if node.s < length]
            stops = [node.s for node in stations[1:]] + [length] * bool(stations)
            self._whole[sign] = [self._step(sign, node, stop - node.s) for node, stop in zip(stations, stops, strict=True)]
        return self._whole[sign]

    def reached(self, sign: int) -> float:
        """Return how far the steps go towards one end: the end, or where no further step is proven."""
        end, steps = self.bounds[1 if sign > 0 else 0], self.steps(sign)
        last = self.values(steps[-1])[1 if sign > 0 else 0] if steps else self.track.start
        return end if abs(last - end) <= _REACHED * max(1.0, abs(end - self.track.start)) else last

    def run(self, sign: int) -> list[Step | Run]:
        """Return all steps towards one end as a single run; none where there are none."""
        if sign not in self._runs:
            steps = self.steps(sign)
            self._runs[sign] = [self._joined(steps)] if steps else []
        return self._runs[sign]

    def _joined(self, steps: Sequence[Step]) -> Step | Run:
        """Return steps in a row as one; between the ends of each what follows lies on its line, within its tube."""
        if len(steps) == 1:
            return steps[0]
        layout, last, at = self.layout, steps[-1], len(steps) // 2
        stops = np.array([[step.node.s, step.node.s + step.length] for step in steps])
        share = 2 * (stops - stops[0, 0]) / (stops[-1, 1] - stops[0, 0]) - 1  # −1 where the run begins, 1 at its end
        middle, line, tube = steps[at].middle.copy(), np.zeros_like(last.line), np.zeros_like(last.tube)
        for joint in layout.joints:
            columns, place = layout.columns[joint.name], layout.freedoms[joint.name]
            if joint.type is JointType.BALL:
                turns = [2 * math.acos(min(abs(float(middle[columns] @ step.middle[columns])), 1.0)) for step in steps]
                own = [float(np.linalg.norm(step.line[place])) + float(np.max(step.tube[place])) for step in steps]
                tube[place] = max(turn + more for turn, more in zip(turns, own, strict=True)) + _LINEAR_ROUNDING
                continue
            centre, half, wide = (
                np.array(rows) for rows in zip(*((p.middle[columns], p.line[place], p.tube[place]) for p in steps), strict=True)
            )
            ends = np.stack([centre - half, centre + half], axis=1)  # (steps, 2, coordinates)
            middle[columns], line[place] = (ends[0, 0] + ends[-1, 1]) / 2, (ends[-1, 1] - ends[0, 0]) / 2
            aside = np.abs(ends - middle[columns] - line[place] * share[..., None]).max(axis=1)
            tube[place] = (aside + wide).max(axis=0) + _LINEAR_ROUNDING
        return Run(tuple(steps), middle, line, tube)

    def values(self, step: Step | Run) -> tuple[float, float]:
        """Return the driver's values at the ends of a step or a run, in order."""
        if isinstance(step, Run):
            ends = [value for part in (step.steps[0], step.steps[-1]) for value in self.values(part)]
            return min(ends), max(ends)
        ends = sorted(self.track.value(step.sign, s) for s in (step.node.s, step.node.s + step.length))
        return ends[0], ends[1]

    def halves(self, step: Step | Run) -> tuple[Step | Run, Step | Run]:
        """Return the two halves of a run, or of a step, the second about a solution of its own."""
        if step not in self._halves and isinstance(step, Run):
            at = len(step.steps) // 2
            self._halves[step] = self._joined(step.steps[:at]), self._joined(step.steps[at:])
        elif step not in self._halves and isinstance(step, Step):
            half, s = step.length / 2, step.node.s + step.length / 2
            Q, _, _ = self.track.evaluate(np.array([self.track.value(step.sign, s)]))
            middle = self.follower.node(s, Q[0], self.follower.linearized(Q[0]), self.track.direction(step.sign))
            self._halves[step] = self._step(step.sign, step.node, half), self._step(step.sign, middle, half)
        return self._halves[step]

    @property
    def _unit(self) -> float:
        return abs(self.track.value(1, 1.0) - self.track.start)

    def _step(self, sign: int, node: Node, length: float) -> Step:
        system, half = self.follower.system, length / 2
        tube = float(self.follower.tube(node, np.asarray(length))) * system.scale
        tube[self._exact] = np.minimum(tube[self._exact], _LINEAR_ROUNDING)  # no loop bends what a coupling ties to the driver
        return Step(sign, node, length, system.move(node.Q, half * node.rate), node.rate * half * system.scale, tube)


def tied_to(mechanism: Mechanism, name: str) -> list[str]:
    """Return the coordinates that couplings alone tie to one, itself included: they follow it in proportion."""
    found = [name]
    for near in found:
        for c in mechanism.couplings:
            found += [far for one, far in ((c.a, c.b), (c.b, c.a)) if one == near and far not in found]
    return found


class Steps:
    """Boxes along a way, and of further coordinates that move by themselves.

    Args:
        way: Of the driver.
        chain: Between two parts.
        others: Bounds of the chain's coordinates that do not follow; NaN for those that do.
        steps: To be covered; by default the whole way.
    """

    def __init__(self, way: Way, chain: Chain, others: FloatArray, steps: Sequence[Step | Run] | None = None) -> None:
        self.way, self.chain, self.spread = way, chain, Spread(chain)
        self.free = ~np.isnan(others[:, 0])
        self.others = others
        self.whole = [*way.run(1), *way.run(-1)] if steps is None else steps
        self.rows: list[tuple[Step | Run, FloatArray, FloatArray]] = []

    def root(self) -> IntArray:
        """Add the steps, each with the whole range of the other coordinates."""
        middle = np.where(self.free, self.others.mean(axis=1), 0.0)
        half = np.where(self.free, np.diff(self.others, axis=1)[:, 0] / 2, 0.0)
        return self._add([(step, middle, half) for step in self.whole])

    def _add(self, rows: list[tuple[Step | Run, FloatArray, FloatArray]]) -> IntArray:
        if not rows:
            return np.empty(0, dtype=np.int64)
        placed = [self._placed(*row) for row in rows]
        centres, lines, tubes = (np.array(part) for part in zip(*placed, strict=True))
        generators = np.concatenate([lines[:, None], tubes[:, :, None] * np.eye(tubes.shape[1])], axis=1)
        for f in self.spread.swings:
            generators[..., f] = 0.0
        self.rows += rows
        return self.spread.add(centres, np.abs(lines) + tubes, generators)

    def _placed(self, step: Step | Run, middle: FloatArray, half: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the chain's coordinates, and of each factor how far it goes along the line and aside of it."""
        values, layout = middle.copy(), self.way.layout
        line, aside = np.zeros(len(self.spread.factors)), np.zeros(len(self.spread.factors))
        for f, (at, factor) in enumerate(self.spread.factors):
            joint = self.chain.movers[at].joint
            if self.free[factor.columns[0]]:
                aside[f] = np.linalg.norm(half[list(factor.columns)])
            elif joint.type is JointType.BALL:
                place = layout.freedoms[joint.name]
                if factor.is_swing:  # its whole turn; then the twist has nothing to add
                    values[list(self.chain.movers[at].columns)] = swing_and_twist(step.middle[layout.columns[joint.name]])
                    aside[f] = float(np.linalg.norm(step.line[place])) + float(np.max(step.tube[place]))
            else:
                column = layout.column_of[self.chain.freedoms[factor.columns[0]].name]
                values[factor.columns[0]] = step.middle[column]
                freedom = layout.freedom_of(column)
                line[f], aside[f] = step.line[freedom], step.tube[freedom]
        return values, line, aside

    def cut(self, boxes: IntArray, share: FloatArray) -> tuple[IntArray, IntArray]:
        """Halve the step, or the range of a coordinate that moves by itself, whichever has the larger share."""
        pairs = [self._cut(self.rows[box], share[row]) for row, box in enumerate(boxes.tolist())]
        numbers = self._add([half for pair in pairs for half in pair])
        return numbers[0::2], numbers[1::2]

    def _cut(self, row: tuple[Step | Run, FloatArray, FloatArray], share: FloatArray) -> list[tuple[Step | Run, FloatArray, FloatArray]]:
        step, middle, half = row
        own = np.zeros(len(half))
        for f, (_, factor) in enumerate(self.spread.factors):
            if self.free[factor.columns[0]]:
                larger = max(factor.columns, key=lambda column: half[column])
                own[larger] += share[len(self.spread.factors) + 1 + self.spread.swings.index(f)] if factor.is_swing else share[1 + f]
        if own.sum() <= share.sum() - own.sum():
            return [(part, middle, half) for part in self.way.halves(step)]
        at = int(np.argmax(own))
        smaller, shift = half.copy(), np.zeros(len(half))
        smaller[at] = shift[at] = half[at] / 2
        return [(step, middle - shift, smaller), (step, middle + shift, smaller)]

    def is_reached(self, box: int) -> bool:
        """Return whether the middle of a box is a pose of the mechanism: of a step; in that of a run the loops need not close."""
        return isinstance(self.rows[box][0], Step)

    def contact(self, box: int) -> tuple[float, ...] | None:
        """Return the chain's coordinates at the middle of a box; none if the mechanism does not reach it."""
        return tuple(self._placed(*self.rows[box])[0].tolist()) if self.is_reached(box) else None

    def value(self, box: int) -> float:
        """Return the driver's value at the middle of a box."""
        return sum(self.way.values(self.rows[box][0])) / 2


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
            claim = replace(self.claim(begun.overlap, vary, shrink), start={self.coordinate.name: self.way.track.start})
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
            todo: list[Step | Run] = [*self.way.steps(sign)[::-1]]
            while todo:
                step = todo.pop()
                if self.search_over(Steps(self.way, self.chain, self.others, [step]), shrink).is_complete:
                    ends[end] = self.way.values(step)[end]
                elif isinstance(step, Step) and step.length > SMALLEST_STEP:
                    todo += self.way.halves(step)[::-1]
                else:
                    break
        return ends[0], ends[1]

    def worst(self, proof: Proof) -> tuple[Overlap, float | None]:
        """Return the deepest overlap from where a proof stopped to the end, and the driver's value there."""
        worst, where = proof.overlap, None
        for contact, value in zip(proof.contacts, proof.stopped_at, strict=False):
            end = self.way.bounds[1] if value >= self.way.track.start else self.way.bounds[0]
            values = value + (end - value) * np.linspace(0.0, 1.0, LOOKS) ** 3  # closely at first
            Q, reached, _ = self.way.track.evaluate(values)
            for row, q in zip(Q[reached], values[reached].tolist(), strict=True):
                found = overlap(self.body_a, self.body_b, SE3.from_matrix(self.chain.matrix(self._values(row, contact))))
                if found.depth > worst.depth:
                    worst, where = found, q
        return worst, where

    def _values(self, Q: FloatArray, known: Mapping[str, float]) -> list[float]:
        """Return the chain's coordinates where the linkage is at Q, those that move by themselves as at a contact."""
        layout = self.way.layout
        values: list[float] = []
        for mover in self.chain.movers:
            names = [self.chain.freedoms[column].name for column in mover.columns]
            if mover.joint.name not in layout.columns:
                values += [known[name] for name in names]
            elif mover.joint.type is JointType.BALL:
                values += swing_and_twist(Q[layout.columns[mover.joint.name]])
            else:
                values += Q[layout.columns[mover.joint.name]].tolist()
        return values
