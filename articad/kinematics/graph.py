"""The joint graph: which joints carry the parts, which close loops, and its faults."""

from __future__ import annotations

import heapq
import operator
from collections import Counter
from collections.abc import Sequence
from functools import cached_property

from articad.errors import KinematicsError, PlanError, did_you_mean
from articad.findings import Finding, Findings
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.tree import KinematicTree

# Types with low weight carry parts first, so that passive hinges and balls remain to close the loops.
# A free joint constrains nothing, so it closes no loop if it can carry a part.
_WEIGHTS = {
    JointType.FREE: -1,
    JointType.FIXED: 0,
    JointType.SLIDER: 2,
    JointType.SCREW: 2,
    JointType.CYLINDRICAL: 3,
    JointType.PLANAR: 3,
    JointType.UNIVERSAL: 3,
    JointType.REVOLUTE: 4,
    JointType.BALL: 5,
}
_CLOSING = 1 + max(_WEIGHTS.values())
_DRIVEN = {joint_type: min(weight, 1) for joint_type, weight in _WEIGHTS.items()}
_REVERSIBLE = frozenset(joint_type for joint_type in JointType if joint_type.reversible)


class JointGraph:
    """Parts and the joints between them.

    Args:
        parts: Names, in the order in which they are declared.
        ground: The part that does not move.
        joints: In the order in which they are declared.
    """

    def __init__(self, parts: Sequence[str], ground: str, joints: Sequence[Joint]) -> None:
        self.parts, self.ground, self.joints = tuple(parts), ground, tuple(joints)

    def components(self) -> tuple[tuple[str, ...], ...]:
        """Return the groups of parts that joints connect, each in the order in which they are declared, the ground's first."""
        leader = {part: part for part in self.parts}

        def find(part: str) -> str:
            while leader[part] != part:
                leader[part] = leader[leader[part]]
                part = leader[part]
            return part

        for joint in self.joints:
            if joint.parent in leader and joint.child in leader:
                leader[find(joint.child)] = find(joint.parent)
        groups: dict[str, list[str]] = {}
        for part in self.parts:
            groups.setdefault(find(part), []).append(part)
        return tuple(sorted((tuple(group) for group in groups.values()), key=lambda group: self.ground not in group))

    def spanning_tree(self) -> tuple[KinematicTree, tuple[Joint, ...]]:
        """Return the tree that carries every part, and the joints that close loops, in the order in which they are declared.

        Prim's algorithm from the ground by (weight of the type, order in the plan): deterministic.

        Raises:
            PlanError: With the findings, if there is no such tree.
        """
        findings = self.findings()
        if not findings.ok:
            raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
        if self._outward is not None:
            return self._outward, ()
        crossed, _ = self._prim
        carrying = {index for index, _, _ in crossed}
        edges = [(self.joints[index], self.parts[near], self.parts[far]) for index, near, far in sorted(crossed)]
        return KinematicTree(self.ground, edges), tuple(joint for i, joint in enumerate(self.joints) if i not in carrying)

    @cached_property
    def _parents(self) -> list[str]:
        return [joint.parent for joint in self.joints]

    @cached_property
    def _children(self) -> list[str]:
        return [joint.child for joint in self.joints]

    @cached_property
    def _place(self) -> dict[str, int]:
        return {part: i for i, part in enumerate(self.parts)}

    @cached_property
    def _outward(self) -> KinematicTree | None:
        """The tree if every joint is declared from the ground outwards, each to a part of its own: then it is the only one."""
        children = set(self._children)
        if len(children) != len(self.joints) or len(self.parts) != len(children) + 1 or self.ground in children:
            return None
        if self._place.keys() != children | {self.ground}:
            return None
        try:
            return KinematicTree(self.ground, zip(self.joints, self._parents, self._children, strict=True))
        except KinematicsError:  # some joints form a ring
            return None

    @cached_property
    def _prim(self) -> tuple[list[tuple[int, int, int]], list[bool]]:
        """The joints that carry parts, as (joint, near part, far part) by index, and for each part whether they reach it."""
        n, place = len(self.joints), self._place
        parents, children = [place[name] for name in self._parents], [place[name] for name in self._children]
        # Prim's algorithm (1957) with a heap; a key orders joints by weight, then as declared, so that the tree is deterministic
        weights = [_CLOSING if joint.closing else _DRIVEN[joint.type] if joint.driver else _WEIGHTS[joint.type] for joint in self.joints]
        keys = [weight * n + index for index, weight in enumerate(weights)]  # joints are taken in the order of these numbers
        at: list[list[int]] = [[] for _ in self.parts]
        for joint, key, parent, child in zip(self.joints, keys, parents, children, strict=True):
            at[parent].append(key)
            if joint.type in _REVERSIBLE:
                at[child].append(key)
        reached = [False] * len(self.parts)
        reached[place[self.ground]] = True
        heap = at[place[self.ground]]
        heapq.heapify(heap)
        crossed: list[tuple[int, int, int]] = []
        while heap:
            taken = heapq.heappop(heap)
            index = taken % n
            near, far = parents[index], children[index]
            if reached[far]:
                near, far = far, near
                if reached[far]:
                    continue
            reached[far] = True
            crossed.append((index, near, far))
            for key in at[far]:
                if key != taken:
                    heapq.heappush(heap, key)
        return crossed, reached

    def findings(self) -> Findings:
        """Return all faults of the graph."""
        return self._findings

    @cached_property
    def _findings(self) -> Findings:
        found = [*self._name_findings(), *self._joint_findings()]
        if self.ground not in self._place:
            hint = (
                f"Choose one of {_listed(self.parts)}.{did_you_mean(self.ground, self.parts)}"
                if self.parts
                else "Declare it: there are no parts."
            )
            message = f"Ground {self.ground!r} is not a declared part."
            found.append(Finding(code="E_NO_GROUND", where="ground", message=message, hint=hint))
        elif not any(finding.code == "E_PART_UNKNOWN" for finding in found):  # a misspelt part would be reported twice
            found.extend(self._reach_findings())
        return Findings(found)

    def _name_findings(self) -> list[Finding]:
        found = []
        for kind, names in (("parts", self.parts), ("joints", tuple(joint.name for joint in self.joints))):
            if len(set(names)) == len(names):
                continue
            for name, count in Counter(names).items():
                if count > 1:
                    message = f"{count} {kind} are called {name!r}."
                    found.append(
                        Finding(code="E_DUP_NAME", where=f"{kind}.{name}", message=message, hint="Rename all but one.", value=count)
                    )
        return found

    def _clear(self) -> bool:
        """Return, by a quick check, whether every joint has two declared parts that no other joint connects."""
        if not self._place.keys() >= {*self._parents, *self._children} or any(map(operator.eq, self._parents, self._children)):
            return False
        pairs = set(zip(self._parents, self._children, strict=True))
        return len(pairs) == len(self.joints) and pairs.isdisjoint(zip(self._children, self._parents, strict=True))

    def _joint_findings(self) -> list[Finding]:
        if self._outward is not None or self._clear():
            return []
        found = []
        first_of: dict[frozenset[tuple[str, str]], str] = {}
        known = set(self.parts)
        for joint in self.joints:
            where, parts = f"joints.{joint.name}", (joint.parent, joint.child)
            for part in dict.fromkeys(parts):
                if part not in known:
                    message = f"Joint {joint.name!r} names part {part!r}, which is not declared."
                    hint = f"Declare it, or use one of {_listed(self.parts)}.{did_you_mean(part, self.parts)}"
                    found.append(Finding(code="E_PART_UNKNOWN", where=where, message=message, hint=hint))
            if joint.parent == joint.child:
                message = f"Joint {joint.name!r} connects {joint.parent!r} with itself."
                found.append(Finding(code="E_JOINT_SELF", where=where, message=message, hint="Name two different parts.", parts=parts[:1]))
                continue
            ends = frozenset({(joint.parent, joint.parent_connector), (joint.child, joint.child_connector)})
            if ends in first_of:
                message = f"Joints {first_of[ends]!r} and {joint.name!r} connect the same two connectors."
                found.append(Finding(code="E_JOINT_DUP", where=where, message=message, hint="Remove one of them.", parts=parts))
            first_of.setdefault(ends, joint.name)
        return found

    def _reach_findings(self) -> list[Finding]:
        if self._outward is not None:
            return []
        _, is_reached = self._prim
        if all(is_reached):
            return []
        reached = {part for part, there in zip(self.parts, is_reached, strict=True) if there}
        connected, *loose = self.components()
        found = []
        if loose:
            groups = [list(group) for group in loose]
            message = f"Parts {groups} are not connected to ground {self.ground!r}."
            hint = f"Add a joint between one part of each group and one of {_listed(connected)}."
            parts = tuple(part for group in loose for part in group)
            found.append(Finding(code="E_DISCONNECTED", where="joints", message=message, hint=hint, parts=parts, value=len(loose)))
        for joint in self.joints:
            if joint.child in reached and joint.parent in connected and joint.parent not in reached and not joint.type.reversible:
                message = f"The tree would have to cross {joint.type} joint {joint.name!r} from {joint.child!r} to {joint.parent!r}."
                hint = f"Exchange its parent and child, so that {joint.child!r} is the parent."
                found.append(
                    Finding(
                        code="E_REVERSE_UNSUPPORTED",
                        where=f"joints.{joint.name}",
                        message=message,
                        hint=hint,
                        parts=(joint.parent, joint.child),
                    )
                )
        return found


def _listed(names: Sequence[str]) -> str:
    return f"[{', '.join(map(repr, names))}]"
