"""Proof that two parts stay apart while some joints move, or the pose at which they meet.

A search cuts pieces of both surfaces, and the range, until each two are apart (`clearing`). If parts touch by design, the first one's
surface is moved inwards by the allowed depth.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.certificates.claims import Claim, Course
from articad.certificates.clearing import MOST_PAIRS, Boxes, Cleared, Ranges, clear
from articad.certificates.profile import SLIDING_WEIGHT, WEIGHT, Forest
from articad.certificates.ranges import PROVEN, turned
from articad.certificates.spread import Spread
from articad.connectors.se3 import SE3
from articad.interference.freedoms import Freedom, freedoms, scattered, swing_and_twist
from articad.interference.meridian import Ends, leaning, outline, swung
from articad.interference.motion import Chain, Mover, Route
from articad.interference.overlap import Overlap, measured, overlap
from articad.interference.scene import Scene
from articad.interference.surface import Core, Surface, inwards, near_by, whole_surface
from articad.interference.verdict import UNRELATED_VOLUME_MM3
from articad.interference.work import TREE_TRIANGLES, WorkBudget, look_price
from articad.kinematics.joints import JointType

LOOK_PAIRS = 300_000  # of pieces, after which a few poses are sampled, so that no proof is sought where there is a collision
LOOKS = 40  # poses
LOOK_GROWTH = 1.6  # growth of the distance of poses beyond the one where a proof stopped; starts small so that thin parts are not skipped
PARALLEL = 1e-12  # sine of the angle between sliders along one line
EVERYWHERE = 1e30  # mm or rad: an interval of this size separates nothing
CONE_ROUNDING = 1e-9  # of the cosine of an angle
CLAIM_SLACK_MM = 1e-6  # margin of proofs over their claims, so that a checker's rounding does not matter
FIRST_STEP = 1 / 16  # of the way to a bound, in the walk to where the parts meet
BESIDE_CONTACT_MM = 1.0  # beyond the largest radius at which two parts touch, within which contact is still intended
_STEADY = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW, JointType.SLIDER, JointType.BALL)  # about one axis or point


class Shrink(NamedTuple):
    """How a surface is moved inwards before it is compared with the other, and how far it must then stay away.

    Attributes:
        depth: [mm]; 0 leaves it unchanged.
        within: Only vertices within this radius about the joint are moved [mm]: intended contact is near its axis.
        keep: Distance to be kept in addition to the margin [mm].
    """

    depth: float = 0.0
    within: float = math.inf
    keep: float = 0.0


NO_SHRINK = Shrink()


@dataclass(frozen=True)
class Proof:
    """The result for one pair and one set of joints.

    Attributes:
        parts: The pair.
        joints: The joints that moved.
        claims: Proven statements; they cover the whole range if `is_complete`.
        lower: For a single coordinate, the lower end of the proven range about rest.
        upper: Its upper end.
        contacts: Coordinates at which the proof stopped, including those of drivers of loops.
        overlap: Overlap at the start.
        out_of_budget: True if the budget or the number of pairs was used up.
        epsilon: Depth by which the solids might still overlap [mm].
        shrink: How the first surface was moved inwards.
    """

    parts: tuple[str, str]
    joints: tuple[str, ...]
    claims: tuple[Claim, ...] = ()
    lower: float | None = None
    upper: float | None = None
    contacts: tuple[Mapping[str, float], ...] = ()
    overlap: Overlap = field(default_factory=Overlap)
    out_of_budget: bool = False
    epsilon: float = 0.0
    shrink: Shrink = NO_SHRINK

    def width(self) -> float:
        """Return the size of the proven range of a single coordinate [rad or mm]."""
        return 0.0 if self.lower is None or self.upper is None else self.upper - self.lower

    @property
    def is_complete(self) -> bool:
        """True if the whole range is proven."""
        return bool(self.claims) and not self.contacts and not self.out_of_budget


class Prover:
    """Proves one pair of parts over one set of joints.

    Args:
        scene: Bodies and relations.
        route: Joints from the first part to the second.
        joints: Names of the joints that move; the others stay at rest.
        epsilon: Distances up to this count as contact [mm].
        budget: Shared by all proofs.
    """

    def __init__(
        self, scene: Scene, route: Route, joints: Sequence[str], *, epsilon: float = 1e-3, budget: WorkBudget | None = None
    ) -> None:
        self.scene, self.joints = scene, tuple(joints)
        self.epsilon, self.budget = epsilon, budget or WorkBudget(float("inf"))
        self.parts = route.parts[0], route.parts[-1]
        self.chain = Chain(route, joints, coordinates=PROVEN)
        self.body_a, self.body_b = (scene.bodies[name] for name in self.parts)
        self.margin = scene.deflection_of(*self.parts)
        self.look_price = look_price(self.body_a.manifold_triangles, self.body_b.manifold_triangles)
        self.allowed = max(scene.tolerated(*self.parts), getattr(scene.relations.waiver(*self.parts), "max_depth", 0.0))
        self.speeds = self.chain.reach(self.body_a.mesh.vertices, self.body_b.mesh.vertices)
        self.bounds = np.array([(freedom.lower, freedom.upper) for freedom in self.chain.freedoms]).reshape(-1, 2)
        self._forests: dict[Shrink, tuple[Forest, Forest]] = {}
        self._kept: dict[Shrink, tuple[Surface, NDArray[np.float32] | None]] = {}
        self._searched: dict[Shrink, Cleared] = {}
        self.axis = self._axis()

    def prove(self, *, most: int = MOST_PAIRS, tentative: bool = False) -> Proof:
        """Prove the whole range, or for a single coordinate as much as possible; a tentative proof ends at the first contact."""
        self.budget.spend(self.look_price)
        start = measured(self.body_a, self.body_b, self.chain.matrix(self.chain.rest)[:3])
        begun = Proof(self.parts, self.joints, overlap=start, epsilon=self.epsilon)
        if start.depth > self.allowed and start.volume > UNRELATED_VOLUME_MM3:
            return replace(begun, contacts=(self.named(self.chain.rest),))
        proof = free = begun
        for shrink in self._shrinks(start):
            proof = self._proof(begun, shrink, min(most, LOOK_PAIRS))
            if proof.out_of_budget and most > LOOK_PAIRS and not self.budget.is_spent:
                seen = self.seen(begun)
                proof = replace(proof, out_of_budget=False, **seen) if seen else self._proof(begun, shrink, most)
            if proof.is_complete or proof.out_of_budget:
                return proof
            collides = self.collides(proof)
            if tentative and collides:
                return proof
            if self.is_line and not tentative:
                found = self._free_range(replace(begun, shrink=shrink))
                free = found if found.width() > free.width() or free is begun else free
            if collides and (not self.is_line or free.width() > 0):
                break
        return free if self.is_line and not tentative else proof

    def _shrinks(self, start: Overlap) -> Iterator[Shrink]:
        """Yield ways to move the first surface: not at all, near the joint's axis up to where they touch, everywhere."""
        if start.volume == 0:
            yield NO_SHRINK
        if self.axis is not None:
            touching = near_by(
                whole_surface(self.body_a.mesh), whole_surface(self.body_b.mesh), self.chain.matrix(self.chain.rest), self.allowed
            )
            radius = float(self.axis.radii(touching.corners).max(initial=0.0)) + BESIDE_CONTACT_MM
            if radius < float(self.axis.radii(self.body_a.mesh.vertices).max()):
                yield Shrink(self.allowed, radius)
        yield Shrink(self.allowed)

    def _axis(self) -> Core | None:
        """Return the axis or point about which the parts turn or slide, in the frame of a; None if several joints have none in common."""
        movers = self.chain.movers
        if len(movers) == 1 and movers[0].joint.type in _STEADY:
            return Core(movers[0].before, 3 if movers[0].joint.type is JointType.BALL else 2)
        if not movers or any(mover.joint.type is not JointType.SLIDER for mover in movers):
            return None
        ways = self._ways()
        return Core(movers[0].before) if np.linalg.norm(np.cross(ways, ways[0]), axis=1).max() <= PARALLEL else None

    def _ways(self) -> FloatArray:
        """Return the directions in which sliders, with no turning joint between them, move b in the frame of a, `(movers, 3)`."""
        turned = itertools.accumulate((mover.before[:3, :3] for mover in self.chain.movers), np.matmul)
        signs = [1.0 if mover.forward else -1.0 for mover in self.chain.movers]
        return np.array([sign * R[:, 2] for R, sign in zip(turned, signs, strict=True)])

    def keeping(self, proof: Proof, distance: float, most: int = MOST_PAIRS) -> Proof:
        """Prove that the surfaces keep a distance in addition to the margin [mm], over the range of another proof of the same pair."""
        return self._proof(replace(proof, claims=(), lower=None, upper=None), Shrink(keep=distance), most)

    @property
    def moving(self) -> tuple[Freedom, ...]:
        """The coordinates that are chosen independently."""
        return self.chain.freedoms

    def placed(self, place: Mapping[str, float]) -> list[float] | None:
        """Return the chain's coordinates at values of what moves; None outside the limits of joints."""
        values = [place[freedom.name] for freedom in self.chain.freedoms]
        one = np.array([values])
        return None if self._outside_cone(one, one).any() else values

    def told(self, point: Sequence[float]) -> dict[str, float]:
        """Return values of what moves by the names used in reports."""
        return self.pose(point)

    @property
    def is_line(self) -> bool:
        """True if a single coordinate moves."""
        return len(self.bounds) == 1

    def named(self, values: Sequence[float] | FloatArray) -> dict[str, float]:
        """Return values by name."""
        return {freedom.name: float(value) for freedom, value in zip(self.chain.freedoms, values, strict=True)}

    def pose(self, values: Sequence[float] | FloatArray) -> dict[str, float]:
        """Return values by the names used in reports: for a ball its swing and twist."""
        found: dict[str, float] = {}
        for mover in self.chain.movers:
            own = [float(values[column]) for column in mover.columns]
            if mover.joint.type is JointType.BALL:
                own = swing_and_twist(SE3.from_matrix(turned(own)).quaternion)
            found.update(zip([freedom.name for freedom in freedoms(mover.joint)], own, strict=True))
        return found

    def boxes(self, bounds: FloatArray) -> Boxes:
        """Return the boxes that cover a range."""
        balls = any(mover.joint.type is JointType.BALL for mover in self.chain.movers)
        return Ranges(Spread(self.chain), bounds, self._outside_cone if balls else None)

    def vary(self, bounds: FloatArray) -> dict[str, tuple[float, float]]:
        """Return the range of each coordinate that was cleared."""
        return {f.name: (float(low), float(high)) for f, (low, high) in zip(self.chain.freedoms, bounds, strict=True)}

    def collides(self, proof: Proof) -> bool:
        """Return whether the two overlap beyond what is allowed soon after a proof stopped, so that no weaker claim can hold."""
        for contact in proof.contacts:
            for point in beyond(self.chain, self.speeds, [contact[f.name] for f in self.chain.freedoms], self.allowed):
                self.budget.spend(self.look_price)
                found = overlap(self.body_a, self.body_b, SE3.from_matrix(self.chain.matrix(point)))
                if found.depth > self.allowed and found.volume > UNRELATED_VOLUME_MM3:
                    return True
        return False

    def _proof(self, begun: Proof, shrink: Shrink, most: int) -> Proof:
        outcome = self._over_all(shrink, most)
        found = replace(begun, out_of_budget=outcome.out_of_budget, shrink=shrink, epsilon=shrink.depth or self.epsilon)
        if not outcome.is_complete:
            contacts = () if outcome.contact is None else (self.named(outcome.contact),)
            return replace(found, contacts=contacts)
        ends = self.bounds[0].tolist() if self.is_line else (None, None)
        claim = self.claim(begun.overlap, self.vary(self.bounds), shrink, outcome)
        return replace(found, claims=(claim,), lower=ends[0], upper=ends[1])

    def _over_all(self, shrink: Shrink, most: int) -> Cleared:
        """Prove that the surfaces stay apart over the whole range, from where an earlier search of it ended."""
        known = self._searched.pop(shrink, None)
        outcome = self.search(self.bounds, shrink, most) if known is None else known.continued(self.budget, most)
        if outcome.left is not None or outcome.contact is not None:
            self._searched[shrink] = outcome
        return outcome

    def search(self, bounds: FloatArray, shrink: Shrink, most: int = MOST_PAIRS) -> Cleared:
        """Prove that the surfaces stay apart over a range."""
        return self.search_over(self.boxes(bounds), shrink, most)

    def search_over(self, boxes: Boxes, shrink: Shrink, most: int = MOST_PAIRS) -> Cleared:
        """Prove that the surfaces stay apart over boxes."""
        a, b = self.forests(shrink)
        needed = self.margin + shrink.keep + CLAIM_SLACK_MM
        return clear(a, b, boxes, needed, axis=self.axis, epsilon=self.epsilon, budget=self.budget, most=most)

    def forests(self, shrink: Shrink) -> tuple[Forest, Forest]:
        """Return trees over both surfaces, with their outlines if a single joint connects the two."""
        if shrink not in self._forests:
            a, b = self._sides(shrink)
            self.budget.spend((len(a.corners) + len(b.corners)) / TREE_TRIANGLES)
            if self.axis is None:
                self._forests[shrink] = Forest.plain(a), Forest.plain(b)
            else:
                weight = SLIDING_WEIGHT if self.chain.movers[0].joint.type is JointType.SLIDER else WEIGHT
                self._forests[shrink] = Forest.pair(a, b, *self._outlines(self.axis, a, b, shrink.keep), weight)
        return self._forests[shrink]

    def _sides(self, shrink: Shrink) -> tuple[Surface, Surface]:
        """Return the two surfaces to compare."""
        return self._surface(shrink)[0], whole_surface(self.body_b.mesh)

    def _outlines(self, axis: Core, a: Surface, b: Surface, keep: float) -> tuple[Ends, Ends, FloatArray]:
        """Return the coordinates of two surfaces that the joint between them does not change, and the distance required in them."""
        mover, needed = self.chain.movers[0], self.margin + keep + 2 * CLAIM_SLACK_MM
        frame_b = np.asarray(np.linalg.solve(self.chain.matrix(np.zeros(len(self.bounds))), axis.frame))  # where all coordinates are 0
        turns, core_b = mover.joint.type is not JointType.SLIDER, Core(frame_b, axis.dimensions)
        travel = self.travel(mover) if turns else self.slid()
        of_a, of_b = outline(axis, a.corners, turns=turns), outline(core_b, b.corners, travel, turns=turns)
        limit = np.full(of_a[0].shape[1], needed)
        if axis.dimensions == 2:
            return of_a, of_b, limit
        # the checker measures angles from the axis at rest, so for a ball that does not rest upright they prove nothing
        if any(self.chain.rest):
            wide = [np.full((len(surface.corners), 1), EVERYWHERE) for surface in (a, b)]
            return _beside(of_a, (-wide[0], wide[0])), _beside(of_b, (-wide[1], wide[1])), np.append(limit, 0.0)
        cone = self.chain.freedoms[mover.columns[0]].upper
        of_a, of_b = _beside(of_a, leaning(axis, a.corners, 0.0, 0.0)), _beside(of_b, leaning(core_b, b.corners, cone, needed))
        if cone > np.pi / 2:
            return of_a, of_b, np.append(limit, 0.0)
        of_a, of_b = _beside(of_a, swung(axis, a.corners, cone)), _beside(of_b, swung(core_b, b.corners, cone))
        return of_a, of_b, np.concatenate([limit, [0.0], np.full(of_a[0].shape[1] - 2, needed)])

    def slid(self) -> tuple[float, float]:
        """Return how far sliders along one line together move b along the axis, in the frame of a [mm]."""
        ways = self._ways()
        ends = [
            sorted(float(way @ ways[0]) * end for end in self.ends(mover.columns[0]))
            for mover, way in zip(self.chain.movers, ways, strict=True)
        ]
        sign = 1.0 if self.chain.movers[0].forward else -1.0
        low, high = sorted(sign * sum(side) for side in zip(*ends, strict=True))
        return low, high

    def travel(self, mover: Mover) -> tuple[float, float]:
        """Return how far a joint about an axis moves b along its axis, in the frame of a [mm]."""
        match mover.joint.type:
            case JointType.CYLINDRICAL:
                pitch = 1.0
            case JointType.SCREW:
                pitch = mover.joint.lead / (2 * np.pi)
            case _:
                pitch = 0.0
        ends = sorted((1.0 if mover.forward else -1.0) * pitch * end for end in self.ends(mover.columns[0]))
        return ends[0], ends[1]

    def ends(self, column: int) -> tuple[float, float]:
        """Return the bounds of a coordinate of the chain."""
        freedom = self.chain.freedoms[column]
        return freedom.lower, freedom.upper

    def _surface(self, shrink: Shrink) -> tuple[Surface, NDArray[np.float32] | None]:
        """Return the first surface, and the displacements of its vertices."""
        shrink = shrink._replace(keep=0.0)
        if shrink not in self._kept:
            mesh, near = self.body_a.mesh, self.axis if math.isfinite(shrink.within) else None
            moved = inwards(mesh, shrink.depth, near, shrink.within) if shrink.depth else None
            self._kept[shrink] = (whole_surface(mesh) if moved is None else Surface.of(mesh, moved)), moved
        return self._kept[shrink]

    def seen(self, begun: Proof) -> dict[str, Any]:
        """Return where the two overlap beyond what is allowed, at one of a few poses over the range, if they do."""
        places = np.concatenate([[self.bounds[:, 0], self.bounds[:, 1]], scattered(self.chain.freedoms, LOOKS)])
        places = places[~self._outside_cone(places, places)]
        deepest = max(places.tolist(), key=self.depth, default=None)
        if deepest is None or self.depth(deepest) <= max(self.allowed, begun.overlap.depth):
            return {}
        return {"contacts": (self.named(deepest),)}

    def depth(self, values: Sequence[float]) -> float:
        """Return how deep the two overlap [mm]."""
        self.budget.spend(self.look_price)
        found = overlap(self.body_a, self.body_b, SE3.from_matrix(self.chain.matrix(values)))
        return found.depth if found.volume > UNRELATED_VOLUME_MM3 else 0.0

    def _free_range(self, begun: Proof) -> Proof:
        """Walk from rest to both bounds as far as the parts stay apart, in steps that shrink where they come close."""
        rest, (lower, upper) = float(self.chain.rest[0]), self.bounds[0].tolist()
        ends = [self._walked(rest, bound, begun.shrink) for bound in (lower, upper)]
        contacts = tuple(self.named((end,)) for end, bound in zip(ends, (lower, upper), strict=True) if end != bound)
        found = replace(begun, lower=ends[0], upper=ends[1], contacts=contacts, epsilon=begun.shrink.depth or self.epsilon)
        if ends[1] <= ends[0]:
            return found
        outcome = self.search(np.array([ends]), begun.shrink)  # once more as a whole, so that a checker can follow it
        if not outcome.is_complete:
            return found
        return replace(found, claims=(self.claim(begun.overlap, self.vary(np.array([ends])), begun.shrink, outcome),))

    def _walked(self, start: float, end: float, shrink: Shrink) -> float:
        at, step = start, (end - start) * FIRST_STEP
        least = self.epsilon / max(float(self.speeds[0]), 1e-9) / 4
        while at != end and abs(step) > least and not self.budget.is_spent:
            there = end if abs(end - at) <= abs(step) else at + step
            if self.search(np.array([[min(at, there), max(at, there)]]), shrink).is_complete:
                at, step = there, step * 1.5
            else:
                step /= 3
        return at

    def _outside_cone(self, low: FloatArray, high: FloatArray) -> NDArray[np.bool_]:
        """Return which boxes `(k, n)` lie outside the cone of a ball: turns x and y swing it by acos(cos x · cos y), `(k,)`."""
        outside = np.zeros(len(low), dtype=bool)
        for mover in self.chain.movers:
            if mover.joint.type is JointType.BALL:
                swing = list(mover.columns[:2])
                least = np.maximum(np.maximum(low[:, swing], -high[:, swing]), 0.0)
                cone = self.chain.freedoms[swing[0]].upper
                outside |= (least.max(axis=1) < np.pi / 2) & (np.cos(least).prod(axis=1) < math.cos(cone) - CONE_ROUNDING)
        return outside

    def claim(self, start: Overlap, vary: Mapping[str, tuple[float, float]], shrink: Shrink, outcome: Cleared) -> Claim:
        """Return what was proven as a claim."""
        chain, (_, moved) = self.chain, self._surface(shrink)
        assert outcome.trail is not None
        assert outcome.course is not None
        boxes, forests = outcome.course, self.forests(shrink)
        about = np.full((2, 3), np.nan)
        if self.axis is not None:
            about = np.stack([self.axis.frame[:3, 3], self.axis.frame[:3, 2] * (self.axis.dimensions == 2)])
        orders, sizes = (forests[0].tree.order, forests[1].tree.order), (forests[0].sizes, forests[1].sizes)
        course = Course(moved, orders, sizes, about, *cuts_of(boxes), outcome.trail.written())
        return Claim(
            parts=self.parts,
            via=chain.via,
            vary=vary,
            start=self.named(chain.rest),
            overlap=start.volume,
            shrink=shrink.depth,
            clear=self.margin + shrink.keep,
            course=course,
        )


def _beside(one: Ends, other: Ends) -> Ends:
    return np.concatenate([one[0], other[0]], axis=1), np.concatenate([one[1], other[1]], axis=1)


def cuts_of(boxes: Boxes) -> tuple[NDArray[np.int64], FloatArray]:
    """Return the coordinate across which each box was cut, and the place; each box after the one that it was cut from."""
    numbers = [0]
    for number in numbers:
        if boxes.columns[number] >= 0:
            numbers += boxes.halves[number]
    return np.array(boxes.columns)[numbers], np.array(boxes.places)[numbers]


def beyond(chain: Chain, speeds: FloatArray, start: Sequence[float], depth: float) -> Iterator[tuple[float, ...]]:
    """Yield poses from a pose towards the bounds of each coordinate, away from rest: the first within a motion of `depth` [mm]."""
    yield tuple(start)
    for at, freedom in enumerate(chain.freedoms):
        ends = [end for end in (freedom.lower, freedom.upper) if (end - start[at]) * (start[at] - freedom.rest) >= 0]
        for end in ends:
            step = depth / (2 * max(float(speeds[at]), 1e-9))
            while step < abs(end - start[at]):
                yield (*start[:at], start[at] + step * (1 if end > start[at] else -1), *start[at + 1 :])
                step *= LOOK_GROWTH
            yield (*start[:at], end, *start[at + 1 :])
