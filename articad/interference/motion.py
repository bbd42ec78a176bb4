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
from articad.connectors.se3 import SE3
from articad.kinematics.joints import Joint, JointType

_PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71)
_TINY = 1e-9  # rad: for smaller angles the sine equals the angle
ENDLESS_SLIDE_MM = 1e6  # largest travel of a slide without limits: the largest size of an assembly
_ABOUT_Z = frozenset(
    kind for kind in JointType if all(step.kind == "slide" or step.axis == 2 for step in kind.steps)
)  # turn about z at most
FULL_TURN = (-math.pi, math.pi)  # an endless joint is proven over one turn about its rest


class Freedom(NamedTuple):
    """One coordinate along which a joint is proven.

    Attributes:
        name: `joint`, or `joint.coordinate`; for a ball `joint.sx`, `joint.sy`, `joint.twist`: it turns by twist about z, then swings
            about (sx, sy, 0) by the length of that vector.
        lower: [rad or mm].
        upper: [rad or mm].
        rest: Value in the rest pose.
    """

    name: str
    lower: float
    upper: float
    rest: float


def freedoms(joint: Joint) -> tuple[Freedom, ...]:
    """Return the coordinates along which a joint moves.

    Without limits, the range is a whole turn about rest, or from the one limit; it is larger if rest is farther away.
    A free joint has no range to be proven or swept over: it has none of these, and is at rest in every check.
    """
    if joint.type is JointType.FREE:
        return ()
    if joint.type is JointType.BALL:
        cone = math.pi if joint.limits.cone is None else joint.limits.cone
        twist = FULL_TURN if joint.limits.twist is None else joint.limits.twist
        ranges = {"sx": (-cone, cone), "sy": (-cone, cone), "twist": twist}
        rests = swing_and_twist(np.array(joint.rest))
        return tuple(Freedom(f"{joint.name}.{key}", lo, hi, rest) for (key, (lo, hi)), rest in zip(ranges.items(), rests, strict=True))
    found = []
    for column in joint.columns:
        turn = 2 * ENDLESS_SLIDE_MM if column.unit == "mm" else 2 * math.pi
        lower, upper, rest = column.lower, column.upper, column.rest
        if math.isinf(lower) and math.isinf(upper):
            lower, upper = rest - turn / 2, rest + turn / 2
        elif math.isinf(lower):
            lower = upper - turn * max(1, math.ceil((upper - rest) / turn))
        elif math.isinf(upper):
            upper = lower + turn * max(1, math.ceil((rest - lower) / turn))
        found.append(Freedom(column.name, lower, upper, rest))
    return tuple(found)


def travels(joint: Joint) -> tuple[Freedom, ...]:
    """Return the coordinates along which a joint moves; a screw without limits has as much travel as a slide without limits."""
    if joint.type is not JointType.SCREW or not slides_endlessly(joint):
        return freedoms(joint)
    (column,), far = joint.columns, 2 * ENDLESS_SLIDE_MM * radians_per_mm(joint)
    lower, upper = column.rest - far / 2, column.rest + far / 2
    if math.isfinite(column.lower):
        lower, upper = column.lower, column.lower + far
    elif math.isfinite(column.upper):
        lower, upper = column.upper - far, column.upper
    return (Freedom(column.name, lower, upper, column.rest),)


def radians_per_mm(joint: Joint) -> float:
    """Return the angle by which a screw turns per 1 mm of travel [rad/mm]."""
    return 2 * math.pi / abs(joint.lead)


def slides_endlessly(joint: Joint) -> bool:
    """Return whether a joint without limits moves its part ever farther, so that no turn covers all of its poses."""
    endless = any(math.isinf(column.lower) or math.isinf(column.upper) for column in joint.columns if column.unit == "mm")
    screws = joint.type is JointType.SCREW and joint.lead != 0
    return endless or (screws and any(math.isinf(column.lower) or math.isinf(column.upper) for column in joint.columns))


def scattered(ranges: Sequence[Freedom], count: int) -> list[tuple[float, ...]]:
    """Return points of a Halton sequence over ranges; they cover any number of dimensions more evenly than random points.

    Beyond 20 dimensions the primes repeat, shifted.
    """
    columns = []
    for at, freedom in enumerate(ranges):
        shares = np.array([_radical_inverse(index + 1 + 409 * (at // len(_PRIMES)), _PRIMES[at % len(_PRIMES)]) for index in range(count)])
        columns.append(freedom.lower + shares * (freedom.upper - freedom.lower))
    return [tuple(row) for row in np.array(columns).T.tolist()]


def _radical_inverse(index: int, base: int) -> float:
    result, share = 0.0, 1.0
    while index:
        share /= base
        result += share * (index % base)
        index //= base
    return result


def driver_values(joint: Joint, values: Sequence[float]) -> tuple[float, ...]:
    """Return the joint's own coordinates for values of its `freedoms`: only those of a ball and of a free joint differ."""
    if joint.type is JointType.FREE:
        return joint.rest
    if joint.type is not JointType.BALL:
        return tuple(values)
    sx, sy, twist = values
    angle = math.hypot(sx, sy)
    c, s = math.cos(angle / 2), (0.5 if angle < 1e-9 else math.sin(angle / 2) / angle)  # sin(x/2)/x at 0
    x, y = s * sx, s * sy
    cz, sz = math.cos(twist / 2), math.sin(twist / 2)
    return (x * cz + y * sz, y * cz - x * sz, c * sz, c * cz)


def proven_freedoms(joint: Joint) -> tuple[Freedom, ...]:
    """Return the coordinates along which a joint is proven: a ball's are turns about x, y and z, one after the other.

    They cover every swing within its cone and every twist within its limits, and a little more twist: a turn about y after one
    about x twists by at most 2 atan(tan²(a/2)), where a is the corner at which both angles are equal.
    """
    if joint.type is not JointType.BALL:
        return freedoms(joint)
    cone = min(math.pi if joint.limits.cone is None else joint.limits.cone, math.pi)
    least, most = FULL_TURN if joint.limits.twist is None else joint.limits.twist
    more = 2 * math.atan(math.tan(math.acos(math.sqrt(math.cos(cone))) / 2) ** 2) if cone < math.pi / 2 else math.pi
    twist = FULL_TURN if most - least + 2 * more >= 2 * math.pi else (least - more, most + more)
    ranges = {"x": (-cone, cone), "y": (-min(cone, math.pi / 2), min(cone, math.pi / 2)), "z": twist}
    rests = turns(SE3.from_quaternion(joint.rest).rotation)
    return tuple(Freedom(f"{joint.name}.{key}", lo, hi, rest) for (key, (lo, hi)), rest in zip(ranges.items(), rests, strict=True))


def turns(R: FloatArray) -> list[float]:
    """Return the turns about x, y and z of a rotation `(3, 3)`, one after the other: the coordinates along which a ball is proven."""
    return [math.atan2(-R[1, 2], R[2, 2]), math.asin(max(-1.0, min(1.0, R[0, 2]))), math.atan2(-R[0, 1], R[0, 0])]


def turned(values: Sequence[float]) -> FloatArray:
    """Return the motion of a ball for its turns about x, y and z, `(4, 4)`."""
    return np.asarray((SE3.rot_x(values[0]) @ SE3.rot_y(values[1]) @ SE3.rot_z(values[2])).matrix)


def swing_and_twist(quaternion: FloatArray) -> list[float]:
    """Return a ball's swing (sx, sy) and twist [rad] for its quaternion x y z w: the inverse of `driver_values`."""
    x, y, z, w = quaternion.tolist()
    twist = 2 * math.atan2(z, w)
    c, s = math.cos(twist / 2), math.sin(twist / 2)
    sx, sy = x * c - y * s, y * c + x * s  # the quaternion without its twist, whose z is 0
    half = math.atan2(math.hypot(sx, sy), math.hypot(z, w))
    size = 2 * half / (math.sin(half) or 1.0) if half > _TINY else 2.0
    return [sx * size, sy * size, twist]


def motion_matrix(joint: Joint, values: Sequence[float]) -> FloatArray:
    """Return J `(4, 4)` for values of the joint's `freedoms`; the same as `Joint.motion`, without its checks."""
    if joint.type is JointType.FIXED:
        return np.eye(4)
    if joint.type not in _ABOUT_Z:
        return np.asarray(joint.motion(np.array(driver_values(joint, values))).matrix)
    angle, origin = 0.0, [0.0, 0.0, 0.0]
    for step in joint.type.steps:
        value = values[step.coordinate or 0]
        if step.kind == "turn":
            angle = value
        else:
            origin[step.axis] = joint.lead / (2 * math.pi) * value if step.advances else value
    return _turn_z(angle, *origin)


def _turn_z(angle: float, x: float, y: float, z: float) -> FloatArray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]])


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
        proving: Whether balls move along their proven freedoms.
    """

    def __init__(self, route: Route, moving: Sequence[str], values: Mapping[str, float] | None = None, *, proving: bool = False) -> None:
        self.proving = proving
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
            mine = proven_freedoms(joint) if proving else freedoms(joint)
            if joint.name in moving and mine:
                columns = tuple(range(len(found), len(found) + len(mine)))
                self.movers.append(Mover(joint, forward, columns, K))
                found += mine
                K = R
            else:
                self.hold.update({freedom.name: held.get(freedom.name, freedom.rest) for freedom in mine})
                J = self._moved(joint, [self.hold[freedom.name] for freedom in mine])
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
            J = self._moved(mover.joint, [float(values[column]) for column in mover.columns])
            if not mover.forward:
                J = _inverse(J)
            step = mover.before @ J
            T = step if T is None else T @ step
        return self.last if T is None else np.asarray(T @ self.last)

    def _moved(self, joint: Joint, values: Sequence[float]) -> FloatArray:
        return turned(values) if self.proving and joint.type is JointType.BALL else motion_matrix(joint, values)

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
    if joint.type not in _ABOUT_Z:
        return [cloud.from_origin] * len(bounds)
    across = any(step.kind == "slide" and step.axis != 2 for step in joint.type.steps)  # then the axis itself moves
    radius = cloud.from_axis + (_largest_travel(joint, bounds) if across else 0.0)
    return [(radius if any(turn) else 0.0) + math.hypot(*slide) for turn, slide in joint.type.factors(joint.lead)]


def _largest_travel(joint: Joint, bounds: list[tuple[float, float]]) -> float:
    """Return the largest distance by which the joint moves its origin [mm]."""
    if joint.type not in _ABOUT_Z:
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
