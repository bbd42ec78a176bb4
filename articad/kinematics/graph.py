"""The joint graph: which joints carry the parts, which close loops, and everything that is wrong with it."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Sequence
from functools import cached_property

from articad.errors import PlanError, did_you_mean
from articad.findings import Finding, Findings
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.tree import Edge, KinematicTree

# Light joints carry parts first, so that the joints that are left to close loops are passive hinges and balls.
_DRIVEN_WEIGHT = 1
_WEIGHTS = {
    JointType.FIXED: 0,
    JointType.SLIDER: 2,
    JointType.SCREW: 2,
    JointType.CYLINDRICAL: 3,
    JointType.PLANAR: 3,
    JointType.UNIVERSAL: 3,
    JointType.REVOLUTE: 4,
    JointType.BALL: 5,
}


class JointGraph:
    """Parts and the joints between them.

    Args:
        parts: Names, in order of declaration.
        ground: The part that stands still.
        joints: In order of declaration.
    """

    def __init__(self, parts: Sequence[str], ground: str, joints: Sequence[Joint]) -> None:
        self.parts, self.ground, self.joints = tuple(parts), ground, tuple(joints)

    def components(self) -> tuple[tuple[str, ...], ...]:
        """Return the groups of parts that joints connect, each in order of declaration, the ground's first."""
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
        """Return the tree that carries every part, and the joints that close loops, in order of declaration.

        Prim's algorithm from the ground by (weight of the type, order of declaration): deterministic.

        Raises:
            PlanError: With the findings, if there is no such tree.
        """
        findings = self.findings()
        if not findings.ok:
            raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
        edges, _ = self._prim
        carrying = {edge.joint.name for edge in edges}
        return KinematicTree(self.ground, edges), tuple(joint for joint in self.joints if joint.name not in carrying)

    @cached_property
    def _prim(self) -> tuple[tuple[Edge, ...], set[str]]:
        """The edges of the tree in order of declaration of their joints, and the parts that it reaches."""
        at: dict[str, list[tuple[int, int, str]]] = {}
        for index, joint in enumerate(self.joints):
            weight = min(_WEIGHTS[joint.type], _DRIVEN_WEIGHT) if joint.driver else _WEIGHTS[joint.type]
            at.setdefault(joint.parent, []).append((weight, index, joint.child))
            if joint.type.reversible:
                at.setdefault(joint.child, []).append((weight, index, joint.parent))
        reached, known = {self.ground}, set(self.parts)
        heap = [(weight, index, self.ground, far) for weight, index, far in at.get(self.ground, ())]
        heapq.heapify(heap)
        edges: dict[int, Edge] = {}
        while heap:
            _, index, near, far = heapq.heappop(heap)
            if far in reached or far not in known:
                continue
            reached.add(far)
            edges[index] = Edge(self.joints[index], near, far)
            for weight, next_index, beyond in at.get(far, ()):
                heapq.heappush(heap, (weight, next_index, far, beyond))
        return tuple(edges[index] for index in sorted(edges)), reached

    def findings(self) -> Findings:
        """Return everything that is wrong with the graph."""
        return self._findings

    @cached_property
    def _findings(self) -> Findings:
        found = [*self._name_findings(), *self._joint_findings()]
        if self.ground not in self.parts:
            hint = f"Choose one of {_listed(self.parts)}.{did_you_mean(self.ground, self.parts)}"
            message = f"Ground {self.ground!r} is not a declared part."
            found.append(Finding(code="E_NO_GROUND", where="ground", message=message, hint=hint))
        elif not any(finding.code == "E_PART_UNKNOWN" for finding in found):  # a misspelt part would be reported twice
            found.extend(self._reach_findings())
        return Findings(found)

    def _name_findings(self) -> list[Finding]:
        found = []
        for kind, names in (("parts", self.parts), ("joints", tuple(joint.name for joint in self.joints))):
            for name, count in Counter(names).items():
                if count > 1:
                    message = f"{count} {kind} are called {name!r}."
                    found.append(
                        Finding(code="E_DUP_NAME", where=f"{kind}.{name}", message=message, hint="Rename all but one.", value=count)
                    )
        return found

    def _joint_findings(self) -> list[Finding]:
        found = []
        first_of: dict[frozenset[tuple[str, str]], str] = {}
        known = set(self.parts)
        for joint in self.joints:
            where, parts = f"joints.{joint.name}", (joint.parent, joint.child)
            for part in dict.fromkeys(parts):
                if part not in known:
                    message = f"Joint {joint.name!r} names part {part!r} which is not declared."
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
        connected, *loose = self.components()
        found = []
        if loose:
            groups = [list(group) for group in loose]
            message = f"Parts {groups} are not connected to ground {self.ground!r}."
            hint = f"Add a joint between one part of each group and one of {_listed(connected)}."
            parts = tuple(part for group in loose for part in group)
            found.append(Finding(code="E_DISCONNECTED", where="joints", message=message, hint=hint, parts=parts, value=len(loose)))
        _, reached = self._prim
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
