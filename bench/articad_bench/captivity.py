"""Captivity and order: which parts can leave in a straight line, in which direction, and in what order the assembly goes together.

A part leaves along a direction if nothing that stays is in its way until it is clear of everything. That is proven like any other
motion, without gaps between samples, with contact up to what is allowed. Removing parts one by one until only the ground is left, and
reading the list backwards, gives an order of insertion. Rotating a part on its way out, or bending it, is not tried.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.findings import Finding, Findings
from articad.interference.cover import cover_line
from articad.interference.motion import Values
from articad.interference.report import rounded
from articad.interference.scene import Scene
from articad.interference.surface import Surface, inwards, surface_distance
from articad.interference.work import WorkBudget

CLEAR_MM = 1.0  # a part this far beyond everything else has left
CONTACT_MM = 1e-4  # of a shrunk surface: anything closer is in the way
MOST_QUERIES = 3000  # for one part and direction; beyond that the result is "unknown"
GLANCES = 12  # poses checked before a proof is tried
_SAME_DIRECTION = 1e-6


@dataclass(frozen=True)
class Escape:
    """One direction of removal, and what blocks it.

    Attributes:
        part: The part to be removed.
        direction: In the ground frame, of unit length.
        free: True if the path is proven free; False if something blocks it; None if this is unknown.
        blocker: The first part in the way.
        travel: How far it can move [mm].
    """

    part: str
    direction: tuple[float, float, float]
    free: bool | None
    blocker: str | None
    travel: float

    def to_json(self) -> dict[str, Any]:
        """Return a row of the report."""
        return {
            "part": self.part,
            "direction": [rounded(x) for x in self.direction],
            "free": self.free,
            "blocker": self.blocker,
            "travel_mm": rounded(self.travel),
        }


@dataclass(frozen=True)
class InsertionOrder:
    """The order in which the parts go together.

    Attributes:
        steps: Parts in the order of insertion, each with the direction in which it would leave again; the first is already in place.
        stuck: Parts that cannot be taken apart, if any.
        blockers: For each of them the parts in its way, whatever the direction.
    """

    steps: tuple[Escape, ...]
    stuck: tuple[str, ...]
    blockers: Mapping[str, tuple[str, ...]]

    @property
    def findings(self) -> Findings:
        """A warning about the parts that cannot be inserted in a straight line."""
        if not self.stuck:
            return Findings()
        ways = "; ".join(f"{name} by {', '.join(self.blockers[name]) or 'what could not be decided'}" for name in self.stuck)
        return Findings(
            [
                Finding(
                    code="W_NOT_INSERTABLE",
                    where=f"parts.{self.stuck[0]}",
                    parts=self.stuck,
                    message=f"{', '.join(self.stuck)} cannot be put in place in a straight line; blocked: {ways}.",
                    hint="Open one side, split a part, or let it snap or rotate into place.",
                )
            ]
        )

    def to_json(self) -> dict[str, Any]:
        """Return the order as JSON."""
        return {
            "steps": [step.to_json() for step in self.steps],
            "stuck": list(self.stuck),
            "blockers": {name: list(parts) for name, parts in self.blockers.items()},
        }


def escapes(
    scene: Scene, poses: Mapping[str, SE3], part: str, *, among: Iterable[str] | None = None, directions: FloatArray | None = None
) -> tuple[Escape, ...]:
    """Try to remove one part in a straight line.

    Args:
        scene: Bodies and relations.
        poses: `T_ground_part` of all parts.
        part: The part to be removed.
        among: Parts that stay; all others by default.
        directions: Unit vectors to try, in the ground frame, `(n, 3)`; by default the axes of the ground, of the part and of its joints.
    """
    others = [name for name in (scene.bodies if among is None else among) if name != part]
    ways = _directions(scene, poses, part) if directions is None else np.asarray(directions, dtype=np.float64)
    leaving = _Leaving(scene, poses, part, others)
    return tuple(leaving.along(way) for way in ways)


def insertion_order(scene: Scene, poses: Mapping[str, SE3], ground: str) -> InsertionOrder:
    """Take everything apart, part by part, and return the reverse: an order of assembly.

    Args:
        scene: Bodies and relations.
        poses: `T_ground_part` of all parts.
        ground: The part that does not move.
    """
    left = [name for name in scene.bodies if name not in scene.broken]
    removed: list[Escape] = []
    blockers: dict[str, tuple[str, ...]] = {}
    movable = [name for name in left if name != ground]
    while movable:
        found = None
        for name in reversed(movable):  # what was declared last was mostly inserted last
            tried = escapes(scene, poses, name, among=left)
            found = next((escape for escape in tried if escape.free), None)
            if found is not None:
                break
            blockers[name] = tuple(dict.fromkeys(escape.blocker for escape in tried if escape.blocker is not None))
        if found is None:
            break
        removed.append(found)
        movable.remove(found.part)
        left.remove(found.part)
    return InsertionOrder(tuple(reversed(removed)), tuple(movable), {name: blockers[name] for name in movable})


class _Leaving:
    """One part being removed past others that stay."""

    def __init__(self, scene: Scene, poses: Mapping[str, SE3], part: str, others: Sequence[str]) -> None:
        self.scene, self.part, self.others = scene, part, others
        body = scene.bodies[part]
        self.start = poses[part].matrix
        # contact is allowed to each neighbour by its own relation; using the smallest allowance is on the safe side
        self.shrink = min((scene.tolerated(part, name) for name in others), default=0.0)
        self.surface = Surface.of(body.mesh, inwards(body.mesh, self.shrink))
        corners = {name: _placed(Surface.of(scene.bodies[name].mesh).corners, poses[name]) for name in others}
        self.obstacles = {name: Surface(placed) for name, placed in corners.items() if len(placed)}
        merged = np.concatenate([np.empty((0, 3, 3)), *corners.values()])
        self.obstacle = Surface(merged)
        self.points = poses[part].apply(body.mesh.vertices)

    def along(self, direction: FloatArray) -> Escape:
        """Try one direction."""
        way = (float(direction[0]), float(direction[1]), float(direction[2]))
        if self.obstacle.is_empty:
            return Escape(self.part, way, free=True, blocker=None, travel=0.0)
        length = float((self.obstacle.points @ direction).max() - (self.points @ direction).min()) + CLEAR_MM
        if length <= 0:
            return Escape(self.part, way, free=True, blocker=None, travel=0.0)

        def distance(values: Values) -> float:
            T = self.start.copy()
            T[:3, 3] += float(values[0]) * direction
            return surface_distance(self.obstacle, self.surface, T)

        for share in (np.arange(GLANCES) + 1) / GLANCES:
            if distance((share**2 * length,)) <= CONTACT_MM:
                return self._blocked(way, direction, share**2 * length)
        cover = cover_line(distance, (0.0, length), 0.0, reach=1.0, epsilon=CONTACT_MM, budget=WorkBudget(60.0), most=MOST_QUERIES)
        if cover.out_of_budget:
            return Escape(self.part, way, free=None, blocker=None, travel=cover.upper)
        if cover.is_complete:
            return Escape(self.part, way, free=True, blocker=None, travel=length)
        return self._blocked(way, direction, cover.upper)

    def _blocked(self, way: tuple[float, float, float], direction: FloatArray, travel: float) -> Escape:
        T = self.start.copy()
        T[:3, 3] += travel * direction
        blocker = min(self.obstacles, key=lambda name: surface_distance(self.obstacles[name], self.surface, T))
        return Escape(self.part, way, free=False, blocker=blocker, travel=travel)


def _directions(scene: Scene, poses: Mapping[str, SE3], part: str) -> FloatArray:
    """Return the axes of the part's joints first, then of the part and of the ground, each in both directions, without duplicates."""
    axes = []
    for joint in scene.relations.joints:
        if part in (joint.parent, joint.child):
            mine = joint.T_parent_connector if part == joint.parent else joint.T_child_connector
            axes += list((poses[part] @ mine).rotation.T[::-1])  # z before y and x: parts slide along their joints' axes
    axes += [*poses[part].rotation.T, *np.eye(3)]
    found: list[FloatArray] = []
    for axis in axes:
        for way in (axis, -axis):
            if not any(np.linalg.norm(way - known) < _SAME_DIRECTION for known in found):
                found.append(way)
    return np.array(found)


def _placed(corners: FloatArray, T: SE3) -> FloatArray:
    return np.asarray(corners @ T.rotation.T + T.translation)
