"""The ways that parts have past each other in straight lines, each proven for the whole way.

One of two surfaces is moved inwards by the depth τ that the pair may overlap (`articad.interference.surface`). If it meets the other
nowhere on its way, no point of one part is ever deeper than τ in the other, provided that the parts do not overlap by more at the start.
The travel of a pair depends on no third part, so each is computed once, whatever the order of removal.
"""

from __future__ import annotations

import math
from collections import Counter, OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.interference.body import Body
from articad.interference.report import rounded
from articad.interference.scene import Scene
from articad.interference.surface import inset_vertices
from articad.interference.travel import Outline, first_contacts, material_met, meets

__all__ = ["CLEAR_MM", "Halt", "LastOutlines", "WayOut", "Ways", "ways_of", "ways_out"]

CLEAR_MM: Final = 1.0  # a part this far beyond everything else has left
SAME_DIRECTION: Final = 1e-6  # length of the difference of unit vectors
_EACH_PAIR: Final = 2000  # triangles that take as long to compare as all else that a pair takes
_KEPT_TRIANGLES: Final = 1 << 20  # of all outlines that are kept, of 121 bytes each: 127 MB


class Halt(NamedTuple):
    """What stops parts that move in a straight line.

    Attributes:
        travel: How far they move before [mm]; infinity if nothing stops them.
        part: The moving part that is stopped; None if nothing stops them.
        by: The part in its way.
    """

    travel: float
    part: str | None = None
    by: str | None = None


@dataclass(frozen=True)
class WayOut:
    """One direction in which a part may leave, and what stops it.

    Attributes:
        part: The part.
        direction: In the ground frame, of unit length.
        travel: How far it moves [mm]; infinity if it leaves.
        blocker: The first part in its way.
    """

    part: str
    direction: tuple[float, float, float]
    travel: float
    blocker: str | None

    @property
    def free(self) -> bool:
        """Whether the part leaves in this direction."""
        return math.isinf(self.travel)

    def to_json(self) -> dict[str, Any]:
        """Return a row of a report; the travel of a part that leaves is null."""
        return {
            "part": self.part,
            "direction": [rounded(x) for x in self.direction],
            "free": self.free,
            "blocker": self.blocker,
            "travel_mm": None if self.free else rounded(self.travel),
        }


_Key = tuple[str, str, int, tuple[float, ...]]
"""Two parts, the number of a direction, and the offset of the first one [mm], empty where it is at its place."""


class LastOutlines:
    """Parts as seen along directions, at any poses; only the outlines that were used last are kept.

    One direction takes 29 MB for the 240 000 triangles of a Stewart platform, and a search asks for a hundred at each of 19 poses.

    Args:
        bodies: The parts by name.
        most: How many triangles all outlines that are kept may have.
    """

    def __init__(self, bodies: Mapping[str, Body], most: int = _KEPT_TRIANGLES) -> None:
        self._bodies, self._most = bodies, most
        self._vertices: dict[tuple[str, float], FloatArray] = {}
        self._kept: OrderedDict[tuple[str, float, bytes, bytes], Outline] = OrderedDict()
        self.triangles = 0  # of all that are kept
        self.compared = 0  # triangles of all pairs that were compared: a measure of work that no machine's load changes

    def of(self, part: str, depth: float, pose: SE3, direction: FloatArray) -> Outline:
        """Return a part, its surface moved inwards by a depth [mm], at `T_ground_part` as seen along a unit vector `(3,)`."""
        key = (part, depth, pose.matrix.tobytes(), direction.tobytes())
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        mesh = self._bodies[part].mesh
        if (part, depth) not in self._vertices:
            self._vertices[part, depth] = inset_vertices(mesh, depth)
        found = Outline.of(np.asarray(pose.apply(self._vertices[part, depth]))[mesh.triangles], direction)
        self._kept[key] = found
        self.triangles += len(found.height)
        while self.triangles > self._most:
            self.triangles -= len(self._kept.popitem(last=False)[1].height)
        return found


class Ways:
    """The straight ways of the parts of a scene at one pose.

    Args:
        scene: Bodies and relations.
        poses: `T_ground_part` of all parts.
        permitted: Pairs of parts that do not stop each other: they snap, are pressed or screwed together.
        outlines: Of the same scene, shared with its ways at other poses.
    """

    def __init__(
        self,
        scene: Scene,
        poses: Mapping[str, SE3],
        permitted: Iterable[frozenset[str]] = (),
        outlines: LastOutlines | None = None,
    ) -> None:
        self.scene, self.poses, self.permitted = scene, poses, frozenset(permitted)
        self.parts = tuple(name for name in scene.bodies if name not in scene.broken and name in poses)
        self.outlines = outlines or LastOutlines(scene.bodies)
        self.offsets: Mapping[str, FloatArray] = {}
        self._in_place = poses
        self._directions: list[FloatArray] = []
        self._numbers: dict[bytes, tuple[int, int]] = {}
        self._known: dict[_Key, tuple[float, float]] = {}
        self._meets: dict[tuple[_Key, int], bool] = {}
        self._met: dict[tuple[str, str, int, int, tuple[float, ...]], float] = {}
        self._stops: Counter[tuple[str, str]] = Counter()

    def beside(self, offsets: Mapping[str, FloatArray]) -> Ways:
        """Return the ways where some parts are beside their places; both share what they know of pairs.

        Args:
            offsets: By part, from its place, in the ground frame `(3,)` [mm].
        """
        found = copy(self)
        found.offsets = dict(offsets)
        moved = {name: SE3.from_translation(offset) @ self._in_place[name] for name, offset in offsets.items()}
        found.poses = {**self._in_place, **moved}
        return found

    def apart(self, part: str, other: str) -> FloatArray:
        """Return how far a part is from its place as another part sees it, `(3,)` [mm]: the difference of their offsets."""
        none = np.zeros(3)
        return np.asarray(self.offsets.get(part, none) - self.offsets.get(other, none))

    def travel(self, part: str, other: str, direction: FloatArray, offset: FloatArray | None = None) -> float:
        """Return how far a part moves along a unit vector `(3,)` before it meets another part [mm]; infinity if it never does.

        Args:
            part: The part that moves.
            other: The part that stays.
            direction: Unit vector `(3,)`.
            offset: By which the part has moved before `(3,)` [mm].
        """
        key, side = self._key(part, other, direction, offset)
        if key not in self._known:
            self._known[key] = first_contacts(*self._seen(key))
        return self._known[key][side]

    def meets(self, part: str, other: str, direction: FloatArray, offset: FloatArray | None = None) -> bool:
        """Return whether a part meets another one on its way to infinity: whether `travel` is finite."""
        key, side = self._key(part, other, direction, offset)
        if key in self._known:
            return math.isfinite(self._known[key][side])
        if (key, side) not in self._meets:
            self._meets[key, side] = meets(*self._seen(key), forwards=side == 0)
        return self._meets[key, side]

    def stop(
        self,
        moving: Iterable[str],
        staying: Iterable[str],
        direction: FloatArray,
        *,
        offset: FloatArray | None = None,
        strict: bool = False,
        least: float = -math.inf,
    ) -> Halt:
        """Return what first stops parts that move together.

        Args:
            moving: Names of the parts.
            staying: Names of the parts that do not move.
            direction: Unit vector `(3,)`.
            offset: By which they have moved before `(3,)` [mm].
            strict: Whether permitted pairs stop each other, too.
            least: A travel that is not more is not looked into any further [mm]: others may stop the parts even earlier.
        """
        staying = tuple(staying)
        first = Halt(math.inf)
        pairs = [(part, other) for part in moving for other in staying if strict or frozenset((part, other)) not in self.permitted]
        for pair in sorted(pairs, key=lambda pair: -self._stops[pair]) if math.isfinite(least) else pairs:
            travel = self.travel(*pair, direction, offset)
            if travel < first.travel:
                first = Halt(travel, *pair)
                if travel <= least:
                    self._stops[pair] += 1
                    break
        return first

    def free(self, moving: Iterable[str], staying: Iterable[str], direction: FloatArray, *, offset: FloatArray | None = None) -> bool:
        """Return whether nothing stops parts that move together, as `stop` says; ends at the first pair that meets.

        Pairs that were in the way most often are examined first: they mostly are in the way of the next direction, too.

        Args:
            moving: Names of the parts.
            staying: Names of the parts that do not move.
            direction: Unit vector `(3,)`.
            offset: By which they have moved before `(3,)` [mm].
        """
        staying = tuple(staying)
        pairs = [(part, other) for part in moving for other in staying if frozenset((part, other)) not in self.permitted]
        for pair in sorted(pairs, key=lambda pair: -self._stops[pair]):
            if self.meets(*pair, direction, offset):
                self._stops[pair] += 1
                return False
        return True

    def met(self, part: str, other: str, direction: FloatArray) -> float:
        """Return how much material of a part another part is in the way of, when the part leaves along a unit vector `(3,)` [mm³]."""
        at, sign = self._index(direction)
        before = self.apart(part, other)
        key = (part, other, at, sign, tuple(before.tolist()))
        if key not in self._met:
            moved = self._outline(part, self.depth(part, other), at).shifted(before, self._directions[at])
            both = (moved, self._outline(other, 0.0, at))
            self._met[key] = material_met(*(each if sign > 0 else each.reversed for each in both))
        return self._met[key]

    def blocks(self, part: str, other: str, direction: FloatArray) -> bool:
        """Return whether another part stops a part on its way to infinity."""
        if frozenset((part, other)) in self.permitted or not self.meets(part, other, direction):
            return False
        self._stops[part, other] += 1
        return True

    def often(self, part: str, other: str) -> int:
        """Return in how many directions another part was found in the way of a part."""
        return self._stops[part, other]

    def points(self, part: str) -> FloatArray:
        """Return the vertices of a part in the ground frame, `(V, 3)` [mm]."""
        return np.asarray(self.poses[part].apply(self.scene.bodies[part].mesh.vertices))

    def clear_length(self, moving: Iterable[str], staying: Iterable[str], direction: FloatArray) -> float:
        """Return how far parts must move along a direction until they are wholly beyond those that stay [mm]."""
        last = max((float((self.points(name) @ direction).max()) for name in staying), default=-math.inf)
        first = min((float((self.points(name) @ direction).min()) for name in moving), default=math.inf)
        return max(0.0, last - first + CLEAR_MM) if math.isfinite(last - first) else 0.0

    def depth(self, a: str, b: str) -> float:
        """Return the depth of overlap that is allowed for a pair [mm]."""
        return self.scene.passable(a, b)

    def _key(self, part: str, other: str, direction: FloatArray, offset: FloatArray | None) -> tuple[_Key, int]:
        """Return the key of what is known of a pair's way, which is the same for both parts, and which of its two ways is meant."""
        at, sign = self._index(direction)
        a, b = sorted((part, other))
        before = self.apart(part, other) + (0.0 if offset is None else offset)
        if part != a:
            sign, before = -sign, -before  # the other way round, the other part moves backwards
        return (a, b, at, tuple(before.tolist()) if before.any() else ()), 0 if sign > 0 else 1

    def _seen(self, key: _Key) -> tuple[Outline, Outline]:
        """Return both parts as seen along the direction of a key, the first one less what the pair may overlap."""
        a, b, at, before = key
        moved = self._outline(a, self.depth(a, b), at)
        if before:
            moved = moved.shifted(np.array(before), self._directions[at])
        stays = self._outline(b, 0.0, at)
        self.outlines.compared += _EACH_PAIR + len(moved.height) + len(stays.height)
        return moved, stays

    def _outline(self, part: str, depth: float, at: int) -> Outline:
        return self.outlines.of(part, depth, self._in_place[part], self._directions[at])

    def _index(self, direction: FloatArray) -> tuple[int, int]:
        """Return the number of a direction or of its opposite, and the sign."""
        exactly = direction.tobytes()
        if exactly not in self._numbers:
            self._numbers[exactly] = self._numbered(direction)
        return self._numbers[exactly]

    def _numbered(self, direction: FloatArray) -> tuple[int, int]:
        for at, known in enumerate(self._directions):
            for sign in (1, -1):
                if float(np.linalg.norm(direction - sign * known)) < SAME_DIRECTION:
                    return at, sign
        self._directions.append(np.asarray(direction, dtype=np.float64))
        return len(self._directions) - 1, 1


def ways_of(scene: Scene, poses: Mapping[str, SE3], part: str) -> FloatArray:
    """Return directions in which a part may leave, in the ground frame, `(n, 3)`: axes of its joints, of the part and of the ground.

    Each comes with its opposite, and none twice.
    """
    axes: list[FloatArray] = []
    for joint in scene.relations.joints:
        if part in (joint.parent, joint.child):
            mine = joint.T_parent_connector if part == joint.parent else joint.T_child_connector
            axes += list((poses[part] @ mine).rotation.T[::-1])  # z before y and x: parts slide along their joints' axes
    return distinct([*axes, *poses[part].rotation.T, *np.eye(3)])


def distinct(axes: Sequence[FloatArray]) -> FloatArray:
    """Return each of some unit vectors and its opposite once, `(n, 3)`."""
    found: list[FloatArray] = []
    for axis in axes:
        for way in (axis, -axis):
            if not any(np.linalg.norm(way - known) < SAME_DIRECTION for known in found):
                found.append(np.asarray(way))
    return np.array(found).reshape(-1, 3)


def ways_out(ways: Ways, part: str, *, among: Iterable[str] | None = None, directions: FloatArray | None = None) -> tuple[WayOut, ...]:
    """Return for each direction how far a part can leave.

    Args:
        ways: The parts.
        part: The part that leaves.
        among: Parts that stay; all others by default.
        directions: Unit vectors, `(n, 3)`; by default those of `ways_of`.
    """
    others = [name for name in (ways.parts if among is None else among) if name != part]
    rows = ways_of(ways.scene, ways.poses, part) if directions is None else np.asarray(directions, dtype=np.float64)
    found = []
    for row in rows:
        stop = ways.stop([part], others, row)
        found.append(WayOut(part, (float(row[0]), float(row[1]), float(row[2])), stop.travel, stop.by))
    return tuple(found)
