"""KinematicTree: parts in an order in which every part follows its parent, each hung from one joint."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Sequence
from functools import cached_property
from types import MappingProxyType
from typing import NamedTuple

from articad.errors import KinematicsError
from articad.kinematics.joints import Joint


class Edge(NamedTuple):
    """A joint as the tree crosses it.

    Attributes:
        joint: As declared.
        parent: The part nearer the ground.
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
    """A spanning tree: holding one proves that every part hangs from the ground by exactly one chain of joints.

    Args:
        ground: The root.
        edges: One per other part, in any order.

    Raises:
        KinematicsError: If the edges are not a tree rooted at the ground.
    """

    def __init__(self, ground: str, edges: Sequence[Edge]) -> None:
        self.ground = ground
        children: defaultdict[str, list[Edge]] = defaultdict(list)
        for edge in edges:
            children[edge.parent].append(edge)
        edge_of: dict[str, Edge] = {}
        stack = children[ground][::-1]
        while stack:  # depth first: Pinocchio's mass matrix is silently wrong in any other order
            edge = stack.pop()
            part = edge.part
            if part in edge_of or part == ground:
                raise KinematicsError(f"The joints are not a tree: {part!r} is reached twice.")
            edge_of[part] = edge
            if part in children:
                stack += children[part][::-1]
        if len(edge_of) != len(edges):
            lost = sorted({edge.part for edge in edges} - edge_of.keys())
            raise KinematicsError(f"The joints are not a tree: {', '.join(lost)} do not hang from the ground {ground!r}.")
        self.edges = tuple(edge_of.values())
        self.parts = (ground, *edge_of)
        self._edge_of = MappingProxyType(edge_of)

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
