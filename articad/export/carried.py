"""The load on a joint: masses, levers and reach in the worst pose, for all joints of a mechanism in one pass over its tree.

Parts joined by fixed joints form a group, in which every distance is known. Beyond a moving joint only a bound is known: the distance to
that joint's origin, its travel, and the distance from there. Such bounds add up along the tree, and so do Σm, Σm·r and Σ(m·r² + J) when
every r grows by the same c:

    Σm(r + c) = Σm·r + c·Σm,    Σm(r + c)² = Σm·r² + 2c·Σm·r + c²·Σm

so the parts below a joint are summed once and shifted to each place where the sum is needed. A joint in a loop carries every part that
its loop carries; the sum then includes parts up the tree, as far as its loops reach.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.geometry.mass import MassProperties
from articad.geometry.part import Part
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.tree import Edge

Span = tuple[int, int]  # consecutive parts in the tree's order: a part with everything below it

LEAST_REACH_M = 1e-3  # a joint whose parts have no extent still gets a finite velocity
LEAST_MASS_KG = 1e-4  # a joint that carries no mass still gets an effort
MM_PER_M = 1000.0


@dataclass(frozen=True)
class Carried:
    """The load on a joint, with r the distance of a part's centre of mass from the joint's axis or origin; kg and m.

    Attributes:
        mass: Σm.
        moment: Σm·r.
        inertia: Σ(m·r² + J), where J is a part's largest principal moment.
        reach: Distance of the farthest surface.
    """

    mass: float = 0.0
    moment: float = 0.0
    inertia: float = 0.0
    reach: float = 0.0

    def __add__(self, other: Carried) -> Carried:
        """Return the sum of both."""
        return Carried(self.mass + other.mass, self.moment + other.moment, self.inertia + other.inertia, max(self.reach, other.reach))

    def farther(self, distance: float) -> Carried:
        """Return the same load with every distance increased by this [m]."""
        inertia = self.inertia + distance * (2 * self.moment + distance * self.mass)
        return Carried(self.mass, self.moment + distance * self.mass, inertia, self.reach + distance)

    def at_least(self) -> Carried:
        """Return the same load, with at least the mass and the reach that an empty joint is given."""
        reach = max(self.reach, LEAST_REACH_M)
        if self.mass < LEAST_MASS_KG:
            return Carried(LEAST_MASS_KG, LEAST_MASS_KG * reach, LEAST_MASS_KG * reach * reach, reach)
        return Carried(self.mass, self.moment, self.inertia, reach)


@dataclass
class _Group:
    """Parts joined by fixed joints of the tree.

    Attributes:
        above: The moving joint that carries the group; None for the ground's group.
        members: `T_group_part` by part [mm]; the group's frame is its first part's.
        below: The moving joints that the group carries.
    """

    above: Edge | None
    members: dict[str, SE3] = field(default_factory=dict)
    below: list[Edge] = field(default_factory=list)


class CarriedParts:
    """Sums over the parts that each joint of a mechanism carries."""

    def __init__(self, mechanism: Mechanism, parts: Mapping[str, Part]) -> None:
        self._parts = parts
        self._tree = mechanism.tree
        self._spans = _spans(mechanism)
        self._at = {part: index for index, part in enumerate(self._tree.parts)}
        self._groups: dict[str, _Group] = {}
        first = _Group(None, {mechanism.ground: SE3.identity()})
        groups = [first]
        self._groups[mechanism.ground] = first
        for edge in self._tree.edges:
            near = self._groups[edge.parent]
            if edge.joint.type is JointType.FIXED:
                here, there = _sides(edge)
                near.members[edge.part] = near.members[edge.parent] @ here @ flip(edge.joint.mate) @ there.inverse()
                self._groups[edge.part] = near
            else:
                near.below.append(edge)
                self._groups[edge.part] = _Group(edge, {edge.part: SE3.identity()})
                groups.append(self._groups[edge.part])
        self._hanging: dict[str, Carried] = {}  # about the origin of the moving joint above each group
        for group in reversed(groups):
            if group.above is not None:
                origin = _sides(group.above)[1].translation
                self._hanging[group.above.part] = self._around(group, origin, 0.0, None, None)
        self._loops, self._closing = self._loop_spans(mechanism)

    def of(self, joint: Joint) -> Carried:
        """Return the load on a joint, about its axis, or about its origin if it is a ball or a universal joint."""
        if joint.name in self._closing:
            moved, spans = self._closing[joint.name]
        else:
            edge = self._tree.edge(joint.child)
            moved = joint.child if edge is not None and edge.joint.name == joint.name else joint.parent
            spans = [self._spans[moved], *self._loops.get(moved, ())]
        frame = joint.T_child_connector if moved == joint.child else joint.T_parent_connector
        return self._seen_from(moved, frame, spans, about_axis=joint.type not in {JointType.BALL, JointType.UNIVERSAL}).at_least()

    def _seen_from(self, moved: str, frame: SE3, spans: list[Span], *, about_axis: bool) -> Carried:
        """Sum the parts of these spans relative to a frame of a part: its own group exactly, the others by bounds."""
        group = self._groups[moved]
        T = (group.members[moved] @ frame).inverse()
        total = Carried()
        for name, T_part in group.members.items():
            if self._within(name, spans):
                total += self._exact(name, T @ T_part, about_axis=about_axis)
        for edge in group.below:
            if self._within(edge.part, spans):
                total += self._hanging[edge.part].farther(self._length(T.apply(self._hook(group, edge))) + _travel(edge.joint))
        radius, point = 0.0, (group.members[moved] @ frame).translation
        while group.above is not None and not self._covers(group, spans):
            edge = group.above
            here, there = _sides(edge)
            radius += self._length(there.translation - point) + _travel(edge.joint)
            group = self._groups[edge.parent]
            point = group.members[edge.parent].apply(here.translation)
            total += self._around(group, point, radius, spans, edge)
        return total

    def _around(self, group: _Group, point: FloatArray, radius: float, spans: list[Span] | None, without: Edge | None) -> Carried:
        """Sum a group and everything below it, about a point of it [mm] that is itself up to `radius` [m] away."""
        total = Carried()
        for name, T_part in group.members.items():
            if spans is None or self._within(name, spans):
                total += self._bounded(name, T_part, point)
        for edge in group.below:
            if edge is not without and (spans is None or self._within(edge.part, spans)):
                total += self._hanging[edge.part].farther(self._length(self._hook(group, edge) - point) + _travel(edge.joint))
        return total.farther(radius)

    def _hook(self, group: _Group, edge: Edge) -> FloatArray:
        return np.asarray(group.members[edge.parent].apply(_sides(edge)[0].translation))

    def _exact(self, name: str, T: SE3, *, about_axis: bool) -> Carried:
        """Return one part, placed in the joint's frame [mm]."""
        points = _points(self._parts[name])
        reach = 0.0
        if points is not None:
            placed = T.apply(points)
            reach = float(np.linalg.norm(placed[:, :2] if about_axis else placed, axis=1).max()) / MM_PER_M
        body = self._parts[name].mass or MassProperties.none()
        com = T.apply(body.com)
        return _one(body, self._length(com[:2] if about_axis else com), reach)

    def _bounded(self, name: str, T: SE3, point: FloatArray) -> Carried:
        """Return one part of a group about a point of it [mm]."""
        box = _box(self._parts[name])
        corners = [] if box is None else [self._length(T.apply(np.array(corner)) - point) for corner in product(*zip(*box, strict=True))]
        body = self._parts[name].mass or MassProperties.none()
        return _one(body, self._length(T.apply(body.com) - point), max(corners, default=0.0))

    @staticmethod
    def _length(vector: FloatArray) -> float:
        return math.hypot(*(float(x) for x in vector)) / MM_PER_M

    def _within(self, part: str, spans: Iterable[Span]) -> bool:
        return any(first <= self._at[part] < end for first, end in spans)

    def _covers(self, group: _Group, spans: list[Span]) -> bool:
        """True if everything within these spans is below the group."""
        assert group.above is not None
        first, end = self._spans[group.above.part]
        return all(first <= start and stop <= end for start, stop in spans)

    def _loop_spans(self, mechanism: Mechanism) -> tuple[dict[str, list[Span]], dict[str, tuple[str, list[Span]]]]:
        """Return the spans that loops add to their parts, and the load of each closing joint with the part that it moves."""
        loops: dict[str, list[Span]] = {}
        closing = {}
        for joint in mechanism.loop_joints:
            path = self._tree.path(joint.parent, joint.child)
            top = min(path, key=self._tree.depth)
            below = [part for part in path if part != top]
            tops = [part for part in below if self._tree.depth(part) == self._tree.depth(top) + 1]
            together = [self._spans[part] for part in tops]
            for part in below:
                loops.setdefault(part, []).extend(together)
            closing[joint.name] = (joint.child if joint.child != top else joint.parent, together)
        return loops, closing


def _one(body: MassProperties, r: float, reach: float) -> Carried:
    inertia = body.mass * r * r + float(body.principal_moments[-1]) / MM_PER_M**2
    return Carried(body.mass, body.mass * r, inertia, max(r, reach))


def _sides(edge: Edge) -> tuple[SE3, SE3]:
    """Return the joint's frames on the part before it and on the part after it."""
    near, far = edge.joint.T_parent_connector, edge.joint.T_child_connector
    return (far, near) if edge.reversed else (near, far)


def _spans(mechanism: Mechanism) -> dict[str, Span]:
    """Return for each part the span of it and everything below it in the tree's order, which is depth first."""
    parts = mechanism.tree.parts
    sizes = dict.fromkeys(parts, 1)
    for edge in reversed(mechanism.tree.edges):
        sizes[edge.parent] += sizes[edge.part]
    return {part: (index, index + sizes[part]) for index, part in enumerate(parts)}


def _travel(joint: Joint) -> float:
    """Return the largest distance between a joint's two frames [m]; 0 for an endless slide."""
    ranges = zip(joint.type.units, joint.limits.lower, joint.limits.upper, strict=False)
    far = [max(abs(lower), abs(upper)) for unit, lower, upper in ranges if unit == "mm"]
    if joint.type is JointType.SCREW:
        far = [abs(joint.lead) / math.tau * max(abs(joint.limits.lower[0]), abs(joint.limits.upper[0]))]
    return math.hypot(*(travel if math.isfinite(travel) else 0.0 for travel in far)) / MM_PER_M


def _points(part: Part) -> FloatArray | None:
    """Return the vertices of a part's shapes, or of its solid where it has none, in its frame [mm]."""
    meshes = [shape.placed for shape in (*part.visuals, *part.collisions)] or ([] if part.mesh is None else [part.mesh])
    return np.concatenate([mesh.vertices for mesh in meshes]) if meshes else None


def _box(part: Part) -> FloatArray | None:
    points = _points(part)
    return None if points is None or not len(points) else np.array([points.min(axis=0), points.max(axis=0)])
