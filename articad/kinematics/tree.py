"""KinematicTree: parts ordered so that every part follows its parent, each carried by one joint."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterable
from functools import cached_property
from typing import NamedTuple

from articad.errors import KinematicsError
from articad.kinematics.joints import Joint


class Edge(NamedTuple):
    """A joint as the tree crosses it.

    Attributes:
        joint: As declared.
        parent: The part nearer to the ground.
        part: The part farther from it, which the joint carries.
    """

    joint: Joint
    parent: str
    part: str

    @property
    def reversed(self) -> bool:
        """True when the tree crosses the joint from its declared child to its declared parent."""
        return self.joint.parent != self.parent


class KinematicTree:
    """A spanning tree; its constructor checks that every part is connected to the ground by exactly one chain of joints.

    Args:
        ground: The root.
        edges: One per other part, in any order: a joint, the part nearer to the ground, the part farther from it.

    Attributes:
        parts: In an order in which every part follows its parent, the ground first.
        joints: The joint that carries each part except the ground, in this order.
        parents: The parents of these parts, in this order.

    Raises:
        KinematicsError: If the edges are not a tree rooted at the ground.
    """

    def __init__(self, ground: str, edges: Iterable[tuple[Joint, str, str]]) -> None:
        self.ground = ground
        joints, parents, parts = zip(*edges, strict=True) if (edges := list(edges)) else ((), (), ())
        carried: defaultdict[str, list[int]] = defaultdict(list)
        for at, parent in enumerate(parents):
            carried[parent].append(at)
        reached, order = {ground}, list[int]()
        stack = carried[ground][::-1]
        while stack:  # depth first: Pinocchio's mass matrix is silently wrong in any other order
            at = stack.pop()
            part = parts[at]
            if part in reached:
                raise KinematicsError(f"The joints are not a tree: {part!r} is reached twice.")
            reached.add(part)
            order.append(at)
            if part in carried:
                stack += carried[part][::-1]
        if len(order) != len(parts):
            lost = sorted({*parts} - reached)
            raise KinematicsError(f"The joints are not a tree: {', '.join(lost)} are not connected to the ground {ground!r}.")
        self.joints = tuple([joints[at] for at in order])
        self.parents = tuple([parents[at] for at in order])
        self.parts = (ground, *[parts[at] for at in order])

    @cached_property
    def edges(self) -> tuple[Edge, ...]:
        """The joints as the tree crosses them, in the order of `parts`."""
        return tuple(map(Edge, self.joints, self.parents, self.parts[1:]))

    @cached_property
    def _edge_of(self) -> dict[str, Edge]:
        return {edge.part: edge for edge in self.edges}

    @cached_property
    def _depths(self) -> dict[str, int]:
        depths = {self.ground: 0}
        for edge in self.edges:
            depths[edge.part] = depths[edge.parent] + 1
        return depths

    def edge(self, part: str) -> Edge | None:
        """Return the edge that carries `part`; None for the ground."""
        self.depth(part)
        return self._edge_of.get(part)

    def depth(self, part: str) -> int:
        """Return how many joints are between the ground and `part`."""
        try:
            return self._depths[part]
        except KeyError:
            raise KinematicsError(f"{part!r} is not a part of the mechanism. Known: {', '.join(self.parts)}.") from None

    def ancestors(self, part: str) -> tuple[Edge, ...]:
        """Return the edges from the ground to `part`, the ground's first."""
        chain: list[Edge] = []
        edge = self.edge(part)
        while edge is not None:
            chain.append(edge)
            edge = self._edge_of.get(edge.parent)
        return tuple(reversed(chain))

    def path(self, a: str, b: str) -> tuple[str, ...]:
        """Return the parts from `a` to `b` along the tree, both included."""
        up, down = [a], [b]
        while up[-1] != down[-1]:
            chain = up if self.depth(up[-1]) >= self.depth(down[-1]) else down
            chain.append(self._edge_of[chain[-1]].parent)
        return (*up, *reversed(down[:-1]))

    def joints_between(self, a: str, b: str) -> tuple[Joint, ...]:
        """Return the joints from `a` to `b` along the tree."""
        parts = self.path(a, b)
        nearer_first = itertools.pairwise(parts)
        return tuple(self._edge_of[q if self.depth(q) > self.depth(p) else p].joint for p, q in nearer_first)

    def subtree(self, part: str) -> tuple[str, ...]:
        """Return `part` and all parts that it carries, in the order of `parts`."""
        self.depth(part)
        carried = {part}
        for edge in self.edges:  # depth first, so a parent is seen before its children
            if edge.parent in carried:
                carried.add(edge.part)
        return tuple(name for name in self.parts if name in carried)
