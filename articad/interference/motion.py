"""Relative motion of two parts: the chain of joints between them, and how far it can move a point.

A chain is `T_a_b(q) = K0 · J1(q)^±1 · K1 · J2(q)^±1 · K2 …`: joints that do not move are multiplied into the constants K.
`reach` bounds the speed of every point of b in the frame of a, per unit of each coordinate; with it a distance at one pose clears a
whole neighbourhood of that pose.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.mate import flip
from articad.interference.freedoms import ABOUT_Z, Freedom, freedoms, motion_matrix
from articad.kinematics.joints import Joint, JointType


class Route(NamedTuple):
    """A path from one part to another.

    Attributes:
        parts: The parts from the first to the last.
        joints: The joints between them, one fewer.
    """

    parts: tuple[str, ...]
    joints: tuple[Joint, ...]


def routes(joints: Sequence[Joint], start: str) -> dict[str, Route]:
    """Return the path with the fewest freedoms from a part to every other, also across joints that close loops."""
    near: dict[str, list[tuple[Joint, str]]] = {}
    for joint in joints:
        near.setdefault(joint.parent, []).append((joint, joint.child))
        near.setdefault(joint.child, []).append((joint, joint.parent))
    found: dict[str, Route] = {}
    heap: list[tuple[int, int, str, Route]] = [(0, 0, start, Route((start,), ()))]
    count = 0
    while heap:
        cost, _, part, route = heapq.heappop(heap)
        if part in found:
            continue
        found[part] = route
        for joint, far in near.get(part, ()):
            if far not in found:
                count += 1
                step = Route((*route.parts, far), (*route.joints, joint))
                heapq.heappush(heap, (cost + 8 * len(freedoms(joint)) + 1, count, far, step))
    return found


@dataclass(frozen=True, eq=False)
class Mover:
    """A joint of a chain that moves.

    Attributes:
        joint: As declared.
        forward: Whether the chain crosses it from parent to child.
        columns: Indices of its freedoms in the chain's values.
        before: K before it, `(4, 4)`.
    """

    joint: Joint
    forward: bool
    columns: tuple[int, ...]
    before: FloatArray


class Coordinates(NamedTuple):
    """The coordinates along which the joints of a chain move.

    Attributes:
        freedoms: Returns those of a joint, with their ranges.
        matrix: Returns J `(4, 4)` of a joint for values of them.
    """

    freedoms: Callable[[Joint], tuple[Freedom, ...]]
    matrix: Callable[[Joint, Sequence[float]], FloatArray]


SWUNG = Coordinates(freedoms, motion_matrix)  # balls by swing and twist


class Chain:
    """The joints between two parts, some of which move.

    Attributes:
        a: The reference part.
        b: The part that moves.
        via: Names of all joints between them.
        freedoms: The freedoms that move, in the order of the values.
        hold: Values of all other freedoms between them, by name.
        movers: The joints that move, from a to b.
        last: K after the last of them.
        coordinates: The coordinates of its joints.
    """

    def __init__(
        self, route: Route, moving: Sequence[str], values: Mapping[str, float] | None = None, coordinates: Coordinates | None = None
    ) -> None:
        self.coordinates = coordinates or SWUNG
        self.a, self.b = route.parts[0], route.parts[-1]
        self.via = tuple(joint.name for joint in route.joints)
        held = dict(values or {})
        self.hold: dict[str, float] = {}
        self.movers: list[Mover] = []
        found: list[Freedom] = []
        K: FloatArray = np.eye(4)
        # T_a_b = K₀ J₁(q) K₁ J₂(q) … : K collects connectors, mates and held joints between two joints that move
        for joint, near in zip(route.joints, route.parts, strict=False):
            forward = joint.parent == near
            L, R = joint.T_parent_connector.matrix, (flip(joint.mate) @ joint.T_child_connector.inverse()).matrix
            if not forward:
                L, R = _inverse(R), _inverse(L)
            K = K @ L
            mine = self.coordinates.freedoms(joint)
            if joint.name in moving and mine:
                columns = tuple(range(len(found), len(found) + len(mine)))
                self.movers.append(Mover(joint, forward, columns, K))
                found += mine
                K = R
            else:
                self.hold.update({freedom.name: held.get(freedom.name, freedom.rest) for freedom in mine})
                J = self.coordinates.matrix(joint, [self.hold[freedom.name] for freedom in mine])
                K = K @ (J if forward else _inverse(J)) @ R
        self.freedoms = tuple(found)
        self.last = K

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints that move."""
        return tuple(mover.joint.name for mover in self.movers)

    @property
    def rest(self) -> FloatArray:
        """Values at rest, `(n,)`."""
        return np.array([freedom.rest for freedom in self.freedoms])

    def matrix(self, values: Sequence[float] | FloatArray) -> FloatArray:
        """Return `T_a_b (4, 4)`."""
        T = None
        for mover in self.movers:
            J = self.coordinates.matrix(mover.joint, [float(values[column]) for column in mover.columns])
            if not mover.forward:
                J = _inverse(J)
            step = mover.before @ J
            T = step if T is None else T @ step
        return self.last if T is None else np.asarray(T @ self.last)

    def reach(self, points_a: FloatArray, points_b: FloatArray) -> FloatArray:
        """Return upper bounds of the speed of all points of b in the frame of a, per unit of each freedom.

        Moving one joint turns b about its axis relative to a, or a about it relative to b: distances change equally,
        so the smaller of the two radii counts.

        Args:
            points_a: Points of a whose hull holds its surface, in a's frame, `(P, 3)` [mm].
            points_b: The same of b in b's frame.

        Returns:
            `(n,)` [mm/rad or 1].
        """
        from_b = self._reach_from(points_b, towards_a=True)
        from_a = self._reach_from(points_a, towards_a=False)
        return np.minimum(from_a, from_b)

    def _reach_from(self, points: FloatArray, *, towards_a: bool) -> FloatArray:
        reach = np.empty(len(self.freedoms))
        cloud = Cloud(points)
        constants = [*(mover.before for mover in self.movers), self.last]
        order = range(len(self.movers) - 1, -1, -1) if towards_a else range(len(self.movers))
        for at in order:
            mover = self.movers[at]
            cloud = cloud.moved(constants[at + 1]) if towards_a else cloud.moved(_inverse(constants[at]))
            bounds = [(self.freedoms[c].lower, self.freedoms[c].upper) for c in mover.columns]
            speeds = _reach_of_joint(mover.joint, cloud, bounds)
            if mover.joint.type is JointType.BALL and towards_a is mover.forward:
                speeds[2] = cloud.from_axis  # the twist comes before the swing, so its axis does not move here
            reach[list(mover.columns)] = speeds
            cloud = cloud.shaken(_largest_travel(mover.joint, bounds))
        return reach


@dataclass(frozen=True, eq=False)
class Cloud:
    """A set of positions of points: exact, or anywhere within `radius` of `centre`."""

    points: FloatArray | None
    centre: FloatArray | None = None
    radius: float = 0.0

    def moved(self, K: FloatArray) -> Cloud:
        """Return the cloud in another frame."""
        if self.points is not None:
            return Cloud(self.points @ K[:3, :3].T + K[:3, 3])
        assert self.centre is not None
        return Cloud(None, K[:3, :3] @ self.centre + K[:3, 3], self.radius)

    def shaken(self, travel: float) -> Cloud:
        """Return the cloud after any rotation about the origin and any translation up to `travel` [mm]."""
        return Cloud(None, np.zeros(3), self.from_origin + travel)

    @property
    def from_origin(self) -> float:
        """Largest distance from the origin [mm]."""
        return self._largest(3)

    @property
    def from_axis(self) -> float:
        """Largest distance from the z axis [mm]."""
        return self._largest(2)

    def _largest(self, dimensions: int) -> float:
        if self.points is not None:
            return math.sqrt(float((self.points[:, :dimensions] ** 2).sum(axis=1).max(initial=0.0)))
        assert self.centre is not None
        return float(np.linalg.norm(self.centre[:dimensions])) + self.radius


def _reach_of_joint(joint: Joint, cloud: Cloud, bounds: list[tuple[float, float]]) -> list[float]:
    """Return the largest speed that each freedom of a joint gives to points of a cloud [mm/rad or 1]."""
    if joint.type not in ABOUT_Z:
        return [cloud.from_origin] * len(bounds)
    across = any(step.kind == "slide" and step.axis != 2 for step in joint.type.steps)  # then the axis itself moves
    radius = cloud.from_axis + (_largest_travel(joint, bounds) if across else 0.0)
    return [(radius if any(turn) else 0.0) + math.hypot(*slide) for turn, slide in joint.type.factors(joint.lead)]


def _largest_travel(joint: Joint, bounds: list[tuple[float, float]]) -> float:
    """Return the largest distance by which the joint moves its origin [mm]."""
    if joint.type not in ABOUT_Z:
        return 0.0
    factors = zip(joint.type.factors(joint.lead), bounds, strict=True)
    return math.hypot(*(math.hypot(*slide) * max(abs(lo), abs(hi)) for (_, slide), (lo, hi) in factors))


def _inverse(T: FloatArray) -> FloatArray:
    result = np.eye(4)
    result[:3, :3] = T[:3, :3].T
    result[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return result


Values = Sequence[float] | FloatArray
Distance = Callable[[Values], float]
