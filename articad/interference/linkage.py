"""Proof along a driver of loops or couplings: the joints that follow are where Kantorovich's theorem says they are.

Kinematics follows the branch in steps small enough that each has exactly one solution, within a tube about its linear predictor.
So over a step every coordinate stays within half its change plus the tube of the step's middle: a box, which a distance clears
like any other. Where it does not, the step is halved about a solution of its own, and the tube shrinks fourfold.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.interference.cover import STRICT, Budget, Cover, CoverBox
from articad.interference.overlap import Overlap, overlap
from articad.interference.proof import Patch, Proof, Prover, View
from articad.interference.scene import Scene
from articad.interference.verdict import UNRELATED_VOLUME_MM3
from articad.kinematics.continuation import Node
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.motion import track_of
from articad.kinematics.track import Track

FloatArray = NDArray[np.float64]

SMALLEST_STEP = 1e-7  # of the driver, scaled: where a box still does not clear, it is contact
MOST_BOXES = 20_000  # for one piece
LOOKS = 24  # poses looked at beyond contact


@dataclass(frozen=True)
class _Step:
    """A piece of the way: from a solution on, by `length`, scaled."""

    node: Node
    length: float


class LinkageProver(Prover):
    """Proves one pair of parts while one driver moves the loops and couplings between them.

    Args:
        scene: Bodies and relations.
        mechanism: With loops or couplings.
        parts: The pair.
        joints: Names of the joints between them that follow, or drive.
        driver: Index among the mechanism's drivers.
        epsilon: A distance that is no larger is contact [mm].
        budget: Shared by all proofs.

    Raises:
        LoopError: If the loops cannot be closed.
    """

    def __init__(
        self,
        scene: Scene,
        mechanism: Mechanism,
        parts: tuple[str, str],
        joints: Sequence[str],
        driver: int,
        *,
        epsilon: float = 1e-3,
        budget: Budget | None = None,
    ) -> None:
        super().__init__(scene, mechanism.tree, parts, joints, epsilon=epsilon, budget=budget)
        self.coordinate = mechanism.drivers[driver]
        found = track_of(mechanism, driver, mechanism.rest, certify=True)
        if found is None:
            raise ValueError(f"{self.coordinate.name} drives no loop or coupling")
        self.track: Track = found
        feasible = mechanism.feasible_range(self.coordinate.name)
        self.bounds = self._bound(feasible.lower, -1), self._bound(feasible.upper, 1)

    def _bound(self, feasible: float, sign: int) -> float:
        """Return the end of the range: the limit, a dead point, or half a turn from rest."""
        declared = self.coordinate.upper if sign > 0 else self.coordinate.lower
        end = min(declared, feasible) if sign > 0 else max(declared, feasible)
        return end if math.isfinite(end) else self.track.start + sign * math.pi

    def range_of(self, view: View) -> tuple[float | None, float | None]:  # noqa: ARG002  the driver's range, whatever the view
        """Return the driver's range."""
        return self.bounds

    def vary(self, view: View, cover: Cover | None) -> dict[str, tuple[float, float]]:
        """Return the driver's range that was cleared; what keeps apart for good does so wherever any of the joints are."""
        return super().vary(view, None) if cover is None else {self.coordinate.name: (cover.lower, cover.upper)}

    def cover_patch(self, patch: Patch, most: int | None) -> Cover:
        """Clear the driver's range outwards from rest."""
        cover = Cover(lower=self.track.start, upper=self.track.start)
        cover.upper = self._walk(patch, self.bounds[1], cover, most or MOST_BOXES)
        cover.lower = self._walk(patch, self.bounds[0], cover, most or MOST_BOXES)
        return cover

    def _walk(self, patch: Patch, end: float, cover: Cover, most: int) -> float:
        track, follower = self.track, self.track.follower
        sign = 1 if end >= track.start else -1
        unit = abs(track.value(1, 1.0) - track.start)
        trace = track.side(end)
        length = min(abs(end - track.start) / unit, trace.nodes[-1].s)
        direction = track.direction(sign)
        stations = [node for node in trace.nodes if node.s < length]
        ends = [*(node.s for node in stations[1:]), length]
        todo = [_Step(node, stop - node.s) for node, stop in zip(stations, ends, strict=True)][::-1]
        done = 0.0
        while todo:
            if self.budget.is_spent or most <= 0:
                cover.out_of_budget = True
                break
            most -= 1
            step = todo.pop()
            box = self._box(patch, step)
            if box is not None:
                span = sorted((track.value(sign, step.node.s), track.value(sign, step.node.s + step.length)))
                cover.boxes.append(box)
                cover.spans.append((span[0], span[1]))
                done = step.node.s + step.length
                continue
            half = step.length / 2
            value = track.value(sign, step.node.s + half)
            Q, reached, _ = track.evaluate(np.array([value]))
            here = self._values(patch, Q[0])
            if not reached[0] or step.length < SMALLEST_STEP or patch.distance(here) <= patch.margin + self.epsilon:
                cover.contacts.append(here)
                cover.stopped_at.append(value)
                break
            middle = follower.node(step.node.s + half, Q[0], follower.linearized(Q[0]), direction)
            todo += [_Step(middle, half), _Step(step.node, half)]
        return end if done >= length else track.value(sign, done)

    def _box(self, patch: Patch, step: _Step) -> CoverBox | None:
        """Return the box of a step if the distance at its middle clears it."""
        follower = self.track.follower
        system, half = follower.system, step.length / 2
        if step.length > follower.certified_step(step.node) * (1 + 1e-9):
            return None
        tube = float(follower.tube(step.node, np.asarray(step.length)))
        freedom = (np.abs(step.node.rate) * half + tube) * system.scale
        columns = self._columns(patch)
        centre = self._values(patch, system.move(step.node.Q, half * step.node.rate))
        spread = np.array([freedom[system.layout.freedom_of(column)] for column in columns])
        needed = float(patch.reach @ spread) * (1 + STRICT) + patch.margin
        known = patch.bound(centre)
        if known <= needed:
            self.budget.queries += 1
            known = patch.distance(centre)
        return CoverBox(centre, tuple(spread.tolist()), known) if known > needed else None

    def _columns(self, patch: Patch) -> list[int]:
        layout = self.track.follower.system.layout
        return [layout.column_of[freedom.name] for freedom in patch.view.chain.freedoms]

    def _values(self, patch: Patch, Q: FloatArray) -> tuple[float, ...]:
        return tuple(Q[self._columns(patch)].tolist())

    def _collides(self, proof: Proof) -> bool:
        worst, _ = self.worst(proof)
        return worst.depth > self.allowed and worst.volume > UNRELATED_VOLUME_MM3

    def worst(self, proof: Proof) -> tuple[Overlap, float | None]:
        """Return the deepest overlap beyond where a proof stopped, and the driver's value there."""
        worst, where = proof.overlap, None
        for (patch, _), value in zip(proof.stopped, proof.stopped_at, strict=True):
            end = self.bounds[1] if value >= self.track.start else self.bounds[0]
            values = value + (end - value) * np.linspace(0.0, 1.0, LOOKS) ** 3  # closely at first
            Q, reached, _ = self.track.evaluate(values)
            for row, q in zip(Q[reached], values[reached].tolist(), strict=True):
                T = SE3.from_matrix(patch.view.chain.matrix(self._values(patch, row)))
                found = overlap(patch.view.body_a, patch.view.body_b, T)
                if found.depth > worst.depth:
                    worst, where = found, q
        return worst, where
