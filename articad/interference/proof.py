"""Proof that two parts keep apart while some joints move, or the pose at which they meet.

In order of cost: an invariant separation (the parts stay apart along a common axis, or one stays inside a radius that the
other stays outside of); boxes over the whole surface; the surface cut at a cylinder or sphere about the joint, because the two
parts of a joint nearly touch there and nowhere else. Where they do touch, the inner piece is shrunk by what is allowed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.interference.claims import Claim, Piece, Separation
from articad.interference.cover import Budget, Cover, box_distance, cover_box, cover_line
from articad.interference.motion import Chain, Mover, Values, motion_matrix
from articad.interference.overlap import Overlap, measured, overlap
from articad.interference.scene import Scene
from articad.interference.surface import Core, Surface, split_by_radius, surface_distance, whole_surface
from articad.interference.verdict import UNRELATED_VOLUME_MM3
from articad.kinematics.joints import JointType
from articad.kinematics.tree import KinematicTree

FloatArray = NDArray[np.float64]

PARALLEL = 1e-12  # |sine| of the angle of two axes that are declared parallel, after the arithmetic of a few frames
FEW_BOXES = 24  # along a line: a bound that clears the range in so many is as good as the distance
SEPARATION_SLACK_MM = 1e-9  # rounding in an invariant gap
DIRECT_QUERIES = 500  # a line that needs no more distances is walked with the whole surface
CHEAP_QUERIES = 300  # a cut that needs no more is taken without looking for a better one
LOOK_GROWTH = 1.6  # poses beyond the one where a proof stopped lie ever further apart, so that thin parts are not jumped over
MOST_LINE = 20_000  # queries after which a line is given up
MOST_BOXES = 20_000  # boxes after which several coordinates are given up
RADIUS_SHARES = (0.05, 0.12, 0.25, 0.5)  # of the reach: radii tried for the cut
EDGE_SHARE = 0.25  # of the radius: longest edge of triangles left crossing the cut
_TURNING = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW)


class Cut(NamedTuple):
    """Where a surface is cut.

    Attributes:
        core: The axis or centre, in the first part's frame.
        radius: [mm].
        edge: [mm].
    """

    core: Core
    radius: float
    edge: float


@dataclass(frozen=True)
class Proof:
    """What came out for one pair and one set of joints.

    Attributes:
        parts: The pair.
        joints: What moved.
        claims: Proven statements; together they prove the whole range when `is_complete`.
        lower: Of a single coordinate, the lower end of the proven range about rest.
        upper: Its upper end.
        contacts: Coordinates at which the proof stopped.
        overlap: At the start.
        out_of_budget: True when time or queries ran out.
        epsilon: How deep the solids might overlap nevertheless [mm].
        stopped: The pieces at which it stopped, with the values.
        stopped_at: Along a driver of loops, its value at each of these.
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
    stopped: tuple[tuple[Patch, tuple[float, ...]], ...] = ()
    stopped_at: tuple[float, ...] = ()

    def width(self) -> float:
        """Return how much of a single coordinate is proven [rad or mm]."""
        return 0.0 if self.lower is None or self.upper is None else self.upper - self.lower

    @property
    def is_complete(self) -> bool:
        """True when the whole range is proven."""
        return bool(self.claims) and not self.contacts and not self.out_of_budget


class Prover:
    """Proves one pair of parts over one set of joints.

    Args:
        scene: Bodies and relations.
        tree: Joints between the parts.
        parts: The pair.
        joints: Names of those that move; the others stand at rest.
        epsilon: A distance that is no larger is contact [mm].
        budget: Shared by all proofs.
        tube: Deviation of dependent joints [mm].
    """

    def __init__(
        self,
        scene: Scene,
        tree: KinematicTree,
        parts: tuple[str, str],
        joints: Sequence[str],
        *,
        epsilon: float = 1e-3,
        budget: Budget | None = None,
        tube: float = 0.0,
    ) -> None:
        self.scene, self.tree, self.joints = scene, tree, tuple(joints)
        self.epsilon, self.budget, self.tube = epsilon, budget or Budget(float("inf")), tube
        self.parts = parts
        self.margin = scene.deflection_of(*parts) + tube
        self.allowed = max(scene.tolerated(*parts), getattr(scene.relations.waiver(*parts), "max_depth", 0.0))

    def prove(self, *, most: int | None = None) -> Proof:
        """Try the cheapest proof first; `most` limits the boxes of each piece."""
        a, b = self.parts
        views = [View(self, a, b)]
        first = views[0]
        start = measured(self.scene.bodies[a], self.scene.bodies[b], SE3.from_matrix(first.T_start))
        self.start = start
        if start.depth > self.allowed and start.volume > UNRELATED_VOLUME_MM3:
            return Proof(self.parts, self.joints, contacts=(dict(first.start),), overlap=start)
        whole = first.whole_claim()
        if whole is not None:
            return Proof(self.parts, self.joints, (whole,), *self.range_of(first), overlap=start)
        failed: list[Proof] = []
        for pieces in self._attempts(first, start):
            proof = self._run(pieces, start, most)
            if proof.is_complete:
                return proof
            failed.append(proof)
            hurried = most is not None and proof.out_of_budget and not proof.contacts
            if self.budget.is_spent or hurried or self._collides(proof):
                return proof
        # the last attempt allows contact; to say how far the parts are free, one that does not is better
        return max(failed[:-1] or failed, key=Proof.width)

    def _collides(self, proof: Proof) -> bool:
        """Return whether the two overlap beyond what is allowed soon after a proof stopped, so that no weaker claim can hold."""
        for patch, values in proof.stopped:
            view = patch.view
            for point in beyond(view.chain, view.speeds, values, self.allowed):
                found = overlap(view.body_a, view.body_b, SE3.from_matrix(view.chain.matrix(point)))
                if found.depth > self.allowed and found.volume > UNRELATED_VOLUME_MM3:
                    return True
        return False

    def _attempts(self, view: View, start: Overlap) -> Iterator[list[Patch]]:
        """Yield ways to cut and shrink the surface, the strongest claim first."""
        gap = view.distance_at_start if start.volume == 0 else 0.0
        spare = gap - self.margin
        cuttable = len(view.chain.movers) == 1 and view.chain.movers[0].joint.type is not JointType.SLIDER
        cuttable = cuttable and view.chain.movers[0].joint.type not in (JointType.PLANAR, JointType.UNIVERSAL)
        if spare > self.epsilon and (not cuttable or view.cost(spare) <= DIRECT_QUERIES):
            yield [view.patch("whole")]
            cuttable = False
        if cuttable:
            yield from _cheapest(self._cuts(view, spare))
        yield [view.patch("whole", shrink=self.allowed)]

    def _cuts(self, view: View, spare: float) -> Iterator[tuple[float, list[Patch]]]:
        for shrink in (0.0, self.allowed) if spare > self.epsilon else (self.allowed,):
            for side in (view, View(self, view.b, view.a)):
                yield from side.cuts(spare, shrink=shrink)

    def _run(self, patches: list[Patch], start: Overlap, most: int | None) -> Proof:
        claims: list[Claim] = []
        contacts: list[Mapping[str, float]] = []
        stopped: list[tuple[Patch, tuple[float, ...]]] = []
        stopped_at: list[float] = []
        lower, upper = self.range_of(patches[0].view)
        spent = False
        for patch in patches:
            if patch.surface.is_empty:
                claims.append(patch.claim(None, (), start))
                continue
            separated = patch.separated()
            if separated is not None:
                claims.append(patch.claim(separated, (), start))
                continue
            cover = self.cover_patch(patch, most)
            spent = spent or cover.out_of_budget
            contacts += [patch.view.named(values) for values in cover.contacts]
            stopped += [(patch, values) for values in cover.contacts]
            stopped_at += cover.stopped_at
            claims.append(patch.claim(None, cover, start))
            if lower is not None and upper is not None:
                lower, upper = max(lower, cover.lower), min(upper, cover.upper)
            elif cover.contacts:
                break
        shrink = max(patch.shrink for patch in patches)
        return Proof(
            parts=self.parts,
            joints=self.joints,
            claims=tuple(claims),
            lower=lower,
            upper=upper,
            contacts=tuple(contacts),
            overlap=start,
            out_of_budget=spent,
            epsilon=shrink or self.epsilon,
            stopped=tuple(stopped),
            stopped_at=tuple(stopped_at),
        )

    def range_of(self, view: View) -> tuple[float | None, float | None]:
        """Return the bounds of the coordinate that moves, if there is one only."""
        return view.range

    def cover_patch(self, patch: Patch, most: int | None) -> Cover:
        """Clear the range of motion for one piece of surface."""
        return patch.cover(most)

    def vary(self, view: View, cover: Cover | None) -> dict[str, tuple[float, float]]:
        """Return the range of each coordinate that was cleared, `cover` None for all of it."""
        if cover is not None and len(view.chain.freedoms) == 1:
            return {view.chain.freedoms[0].name: (cover.lower, cover.upper)}
        return {freedom.name: (freedom.lower, freedom.upper) for freedom in view.chain.freedoms}


def _cheapest(options: Iterator[tuple[float, list[Patch]]]) -> list[list[Patch]]:
    """Return the two cheapest ways to cut; one that costs next to nothing ends the search."""
    found = []
    for cost, pieces in options:
        if cost <= CHEAP_QUERIES:
            return [pieces]
        if cost < float("inf"):
            found.append((cost, pieces))
    return [pieces for _, pieces in sorted(found, key=lambda option: option[0])[:2]]


def _travel(chain: Chain, mover: Mover) -> tuple[float, float]:
    """Return how far a joint carries along its axis, from rest to either bound [mm]."""
    first = chain.freedoms[mover.columns[0]]
    ends = (first.lower - first.rest, first.upper - first.rest)
    match mover.joint.type:
        case JointType.SLIDER | JointType.CYLINDRICAL:
            return ends
        case JointType.SCREW:
            per_turn = mover.joint.lead / (2 * np.pi)
            return ends[0] * per_turn, ends[1] * per_turn
        case _:
            return 0.0, 0.0


def beyond(chain: Chain, speeds: FloatArray, start: Sequence[float], depth: float) -> Iterator[tuple[float, ...]]:
    """Yield poses from one on towards the bounds of each coordinate, away from rest: the first within the motion by `depth` [mm]."""
    yield tuple(start)
    for at, freedom in enumerate(chain.freedoms):
        ends = [end for end in (freedom.lower, freedom.upper) if (end - start[at]) * (start[at] - freedom.rest) >= 0]
        for end in ends:
            step = depth / (2 * max(float(speeds[at]), 1e-9))
            while step < abs(end - start[at]):
                yield (*start[:at], start[at] + step * (1 if end > start[at] else -1), *start[at + 1 :])
                step *= LOOK_GROWTH
            yield (*start[:at], end, *start[at + 1 :])


class View:
    """One part as the one whose surface is looked at, the other as what moves past it."""

    def __init__(self, prover: Prover, a: str, b: str) -> None:
        self.prover, self.a, self.b = prover, a, b
        self.chain = Chain(prover.tree, a, b, prover.joints)
        self.T_start = self.chain.matrix(self.chain.rest)
        self.body_a, self.body_b = prover.scene.bodies[a], prover.scene.bodies[b]

    @property
    def start(self) -> dict[str, float]:
        """Rest values of what moves."""
        return self.named(self.chain.rest)

    @property
    def range(self) -> tuple[float | None, float | None]:
        """Bounds of the coordinate, if there is one only."""
        if len(self.chain.freedoms) != 1:
            return None, None
        return self.chain.freedoms[0].lower, self.chain.freedoms[0].upper

    @cached_property
    def other(self) -> Surface:
        """The whole surface of the other part."""
        return whole_surface(self.body_b.mesh)

    @cached_property
    def whole(self) -> Surface:
        """The whole surface of the first part."""
        return whole_surface(self.body_a.mesh)

    @cached_property
    def distance_at_start(self) -> float:
        """Of the whole surfaces [mm]."""
        return surface_distance(self.whole, self.other, self.T_start)

    @cached_property
    def core(self) -> Core:
        """Axis or centre of the first joint that moves, in the first part's frame."""
        mover = self.chain.movers[0]
        return Core(mover.before, 3 if mover.joint.type is JointType.BALL else 2)

    @cached_property
    def core_b(self) -> Core:
        """The same axis as the other part has it: its material is measured from there."""
        frame: FloatArray = np.asarray(np.linalg.inv(self.chain.last), dtype=np.float64)
        return Core(frame, self.core.dimensions)

    def named(self, values: Values) -> dict[str, float]:
        """Return values by name."""
        return {freedom.name: float(value) for freedom, value in zip(self.chain.freedoms, values, strict=True)}

    def patch(self, piece: Piece, shrink: float = 0.0) -> Patch:
        """Return the whole surface as a patch."""
        surface = Surface.of(self.body_a.mesh, shrink) if shrink else self.whole
        return Patch(self, surface, piece, shrink)

    @cached_property
    def speeds(self) -> FloatArray:
        """Reach of the whole parts."""
        return self.chain.reach(self.body_a.mesh.vertices, self.body_b.mesh.vertices)

    def cost(self, spare: float, radius: float | None = None) -> float:
        """Estimate the queries for a line or box at a constant distance."""
        reach = self.speeds
        if radius is not None:
            reach = np.minimum(reach, [1.0 if r == 1.0 else radius for r in reach])
        widths = np.array([freedom.upper - freedom.lower for freedom in self.chain.freedoms])
        if spare <= 0:
            return float("inf")
        return float(np.prod(np.maximum(1.0, widths * reach * len(reach) / (2 * spare))))

    def cuts(self, spare: float, *, shrink: float) -> Iterator[tuple[float, list[Patch]]]:
        """Yield pieces for several radii, each with an estimate of its queries."""
        limit = float(self.core.radii(self.body_a.mesh.vertices).max())
        least_b = float(self.core_b.least_radii(self.body_b.corners).min())
        candidates = [share * limit for share in RADIUS_SHARES]
        clear_of_b = least_b - self.prover.margin - 2 * SEPARATION_SLACK_MM
        if 0 < clear_of_b < limit:
            candidates.insert(0, clear_of_b)
        inner_spare = (0.55 * shrink if shrink else spare + self.prover.margin) - self.prover.margin
        for radius in candidates:
            cut = Cut(self.core, radius, max(EDGE_SHARE * radius, 1e-3 * limit))
            inside, seam, outside = split_by_radius(self.body_a.mesh, *cut, shrink)
            outer_gap = surface_distance(outside, self.other, self.T_start) - self.prover.margin
            if inside.is_empty or outer_gap <= self.prover.epsilon:
                continue
            separated = radius + self.prover.margin + SEPARATION_SLACK_MM <= least_b
            if shrink and separated:
                continue
            patches = [Patch(self, inside, "in", shrink, cut), Patch(self, outside, "out", 0.0, cut)]
            if shrink:
                patches.append(Patch(self, seam, "seam", 0.0, cut, clear=shrink))
            cost = 0.0 if separated else self.cost(inner_spare, radius)
            if shrink and not seam.is_empty:
                cost += self.cost(outer_gap - shrink, radius + cut.edge)
            yield cost + self.cost(outer_gap), patches

    def whole_claim(self) -> Claim | None:
        """Return the claim that an invariant separates the two parts, if one does."""
        patch = self.patch("whole")
        separated = patch.separated()
        return None if separated is None else patch.claim(separated, (), self.prover.start)


class Patch:
    """A piece of surface to be kept clear of the other part."""

    def __init__(self, view: View, surface: Surface, piece: Piece, shrink: float = 0.0, cut: Cut | None = None, clear: float = 0.0) -> None:
        self.view, self.surface, self.piece, self.shrink, self.cut, self.clear = view, surface, piece, shrink, cut, clear
        self.margin = view.prover.margin + clear

    def separated(self) -> tuple[Separation, float] | None:
        """Return an invariant that keeps the two apart, with its gap [mm]."""
        chain, needed = self.view.chain, self.margin + SEPARATION_SLACK_MM
        along = self._gap_along()
        if along > needed:
            return "along", along
        if len(chain.movers) == 1 and chain.movers[0].joint.type in (*_TURNING, JointType.BALL, JointType.SLIDER):
            mine, theirs = self.view.core, self.view.core_b
            inner = float(theirs.least_radii(self.view.other.corners).min()) - float(mine.radii(self.surface.points).max())
            outer = float(mine.least_radii(self.surface.corners).min()) - float(theirs.radii(self.view.other.points).max())
            if max(inner, outer) > needed:
                return "radial", max(inner, outer)
        return None

    def _gap_along(self) -> float:
        """Return the gap of the extents along a direction that no joint turns [mm]; negative when they overlap."""
        chain = self.view.chain
        frame, direction, travel = np.eye(4), None, [0.0, 0.0]
        for mover in chain.movers:
            frame = frame @ mover.before
            axis = frame[:3, 2]
            direction = axis if direction is None else direction
            turned = float(np.linalg.norm(np.cross(axis, direction)))
            sliding = mover.joint.type is JointType.SLIDER
            if mover.joint.type in (JointType.BALL, JointType.UNIVERSAL) or (turned > PARALLEL and not sliding):
                return float("-inf")
            share = float(axis @ direction) * (1.0 if mover.forward else -1.0)
            ends = sorted(share * end for end in _travel(chain, mover))
            travel = [travel[0] + ends[0], travel[1] + ends[1]]
            J = motion_matrix(mover.joint, [chain.freedoms[column].rest for column in mover.columns])
            frame = frame @ (J if mover.forward else np.linalg.inv(J))
        assert direction is not None
        mine = self.surface.points @ direction
        theirs = self.view.other.points @ (self.view.T_start[:3, :3].T @ direction) + self.view.T_start[:3, 3] @ direction
        return float(max(theirs.min() + travel[0] - mine.max(), mine.min() - theirs.max() - travel[1]))

    @cached_property
    def reach(self) -> FloatArray:
        """Of each coordinate."""
        return self.view.chain.reach(self.surface.points, self.view.other.points)

    def distance(self, values: Values) -> float:
        """Return the distance at a configuration [mm]."""
        return surface_distance(self.surface, self.view.other, self.view.chain.matrix(values))

    def bound(self, values: Values) -> float:
        """Return a lower bound of it from the two boxes, and where these meet from the polytopes around the two [mm]."""
        T = self.view.chain.matrix(values)
        boxes = box_distance(T, self.surface.box, self.view.other.box)
        return boxes if boxes > self._near else max(boxes, self.surface.outer.distance(self.view.other.outer, T))

    def distance_or_bound(self, values: Values) -> float:
        """Return a lower bound of the distance where that clears much of the range at once, else the distance [mm]."""
        known = self.bound(values)
        return known if known > self._near else self.distance(values)

    @cached_property
    def _near(self) -> float:
        """Distance above which a few boxes clear the range, so that an exact one is not worth its cost [mm]."""
        widths = np.array([freedom.upper - freedom.lower for freedom in self.view.chain.freedoms])
        return self.margin + float(self.reach @ widths) / FEW_BOXES

    def cover(self, most: int | None) -> Cover:
        """Clear the range of motion."""
        prover, freedoms = self.view.prover, self.view.chain.freedoms
        bounds = [(freedom.lower, freedom.upper) for freedom in freedoms]
        if len(freedoms) == 1:
            start, reach = freedoms[0].rest, float(self.reach[0])
            return cover_line(
                self.distance_or_bound,
                bounds[0],
                start,
                reach=reach,
                margin=self.margin,
                epsilon=prover.epsilon,
                budget=prover.budget,
                most=most or MOST_LINE,
            )
        left_out = self._outside_cone if any(mover.joint.type is JointType.BALL for mover in self.view.chain.movers) else None
        return cover_box(
            self.distance,
            self.bound,
            bounds,
            reach=self.reach,
            margin=self.margin,
            epsilon=prover.epsilon,
            budget=prover.budget,
            most=most or MOST_BOXES,
            left_out=left_out,
        )

    def _outside_cone(self, centre: FloatArray, half: FloatArray) -> bool:
        """Return whether a box lies outside the cone of a ball: its swing is a vector no longer than the cone's angle."""
        for mover in self.view.chain.movers:
            if mover.joint.type is JointType.BALL:
                swing = list(mover.columns[:2])
                nearest = np.maximum(np.abs(centre[swing]) - half[swing], 0.0)
                if np.hypot(*nearest) > self.view.chain.freedoms[swing[0]].upper:
                    return True
        return False

    def claim(self, separated: tuple[Separation, float] | None, cover: Cover | tuple[()], start: Overlap) -> Claim:
        """Return what was proven."""
        chain = self.view.chain
        spans = tuple(cover.spans) if isinstance(cover, Cover) else ()
        boxes = tuple(cover.boxes if spans else dict.fromkeys(cover.boxes)) if isinstance(cover, Cover) else ()
        found = cover if isinstance(cover, Cover) else None
        reach = {} if self.surface.is_empty else {f.name: float(r) for f, r in zip(chain.freedoms, self.reach, strict=True)}
        return Claim(
            parts=(self.view.a, self.view.b),
            vary=self.view.prover.vary(self.view, found),
            hold=chain.hold,
            start=self.view.start,
            overlap=start.volume,
            reach=reach,
            tube=self.view.prover.tube,
            shrink=self.shrink,
            piece=self.piece,
            radius=0.0 if self.cut is None else self.cut.radius,
            edge=0.0 if self.cut is None else self.cut.edge,
            clear=self.clear,
            separation=None if separated is None else separated[0],
            gap=0.0 if separated is None else separated[1],
            boxes=boxes,
            spans=spans,
        )
