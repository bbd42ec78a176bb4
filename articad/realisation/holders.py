"""Which other parts end a straight motion of a joint's child: those in its way, each pushed along until it meets the next, up to the joint's parent.

Every part is taken to move straight. The travel of a chain is the sum of the gaps between its parts, and the chain of least travel counts.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.interference.gauge import fixed_with
from articad.interference.scene import Scene
from articad.interference.surface import PlacedTriangles
from articad.kinematics.joints import Joint
from articad.realisation.stops import travel_past

__all__ = ["FAR_MM", "Holders", "HoldingChain"]

FAR_MM: Final = 5.0  # a part that is met later holds nothing


class HoldingChain(NamedTuple):
    """What ends a motion.

    Attributes:
        travel: How far the child moves [mm].
        parts: The part that the child meets, the one that this one meets, and so on; the last one is the parent or fixed to it.
    """

    travel: float
    parts: tuple[str, ...]


class Holders:
    """The parts of a scene at one pose, as what is in each other's way.

    Args:
        scene: Bodies and relations. Its environment holds nothing.
        poses: `T_ground_part` of the parts.
    """

    def __init__(self, scene: Scene, poses: Mapping[str, SE3]) -> None:
        self.scene, self.poses = scene, poses
        self.parts = [name for name in scene.bodies if name in poses and name not in scene.broken and name not in scene.environment]
        self._placed = PlacedTriangles(scene.bodies, poses)
        self._travels: dict[tuple[str, str, tuple[float, ...]], float] = {}
        self._boxes = {
            name: (corners.min(axis=(0, 1)), corners.max(axis=(0, 1))) for name in self.parts for corners in [self._placed.triangles(name)]
        }

    def along(self, joint: Joint, way: FloatArray) -> HoldingChain | None:
        """Return what holds a joint's child against its parent in a direction, other parts between them; None if nothing does within FAR_MM.

        Args:
            joint: The joint. Parts that are fixed to its child move with it, and parts that are fixed to its parent stand still.
            way: Unit vector in the ground frame, `(3,)`.
        """
        movers, still = set(fixed_with(self.scene, joint, joint.child)), set(fixed_with(self.scene, joint, joint.parent))
        body = {name: self.scene.relations.rigid.leader(name) for name in self.parts}
        body |= dict.fromkeys(movers, "child of the joint") | dict.fromkeys(still, "parent of the joint")
        members: dict[str, list[str]] = {}
        for name in self.parts:
            members.setdefault(body[name], []).append(name)
        reached: dict[str, HoldingChain] = {}
        todo: list[tuple[float, tuple[str, ...], str]] = [(0.0, (), "child of the joint")]
        while todo:
            travel, chain, at = heapq.heappop(todo)
            if at in reached:
                continue
            reached[at] = HoldingChain(travel, chain)
            if at == "parent of the joint":
                return reached[at]
            for part in members.get(at, ()):
                for other in self.parts:
                    passed = body[other] in reached or (not chain and other in still)  # what the partner stops is known
                    if not passed and (gap := self._travel(part, other, way)) + travel <= FAR_MM:
                        heapq.heappush(todo, (travel + gap, (*chain, other), body[other]))
        return None

    def _travel(self, part: str, other: str, way: FloatArray) -> float:
        key = (part, other, tuple(np.round(way, 9).tolist()))
        if key not in self._travels:
            (low, high), (low_b, high_b) = self._boxes[part], self._boxes[other]
            depth = self.scene.passable(part, other)
            sweep = (FAR_MM + 4 * depth) * way
            near = (low + np.minimum(sweep, 0.0) <= high_b).all() and (high + np.maximum(sweep, 0.0) >= low_b).all()
            self._travels[key] = math.inf
            if near:
                surfaces = (self._placed.triangles(part), self._placed.triangles(part, depth), self._placed.triangles(other))
                self._travels[key] = travel_past(*surfaces, way, depth)
        return self._travels[key]
