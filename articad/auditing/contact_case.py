"""What contact checks look at and what they found; which causes are told, and what simulators' shapes share by design."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from articad.assembly import Assembly
from articad.auditing.wording import counted, listed
from articad.certificates.certificate import Certificate
from articad.findings import Finding
from articad.interference.body import relative
from articad.interference.diagnosis import diagnose
from articad.interference.overlap import volume
from articad.interference.report import Checks
from articad.interference.scene import Scene
from articad.interference.verdict import STATIC_SHARE
from articad.kinematics.joints import JointType

MOST_DIAGNOSED = 20
SHORTEST = 1.5  # times the depth, the shortest way out: overlaps are seldom boxes
_ENDS = re.compile(r"ends ([-+.\de]+) mm inside")


@dataclass
class Contacts:
    """What was found about contact.

    Attributes:
        pairs: Of the rest pose, with every pair.
        findings: All of them.
        undone: What was not checked, in words.
        strength: "sampled", "certified" or "certified in part", of the motion.
        certificate: Of the motion, if it was to be proven.
    """

    pairs: Checks
    findings: list[Finding] = field(default_factory=list)
    undone: list[str] = field(default_factory=list)
    strength: str = "sampled"
    certificate: Certificate | None = None


@dataclass(frozen=True, eq=False)
class ContactCase:
    """What is checked.

    Attributes:
        assembly: Of the file.
        foreign: True for URDF and MJCF.
        simple: Parts of whose colliding shapes at least one is a box, cylinder, sphere or capsule.
        filtered: Pairs that the file's own engine never lets collide.
        scene: With the shapes that collide.
        neighbours: Pairs that one joint lies between.
        shared: What such pairs have in common, to be told in one note.
    """

    assembly: Assembly
    foreign: bool
    simple: frozenset[str]
    filtered: frozenset[frozenset[str]]
    scene: Scene
    neighbours: frozenset[frozenset[str]]
    shared: list[Finding] = field(default_factory=list)

    def by_design(self, parts: Sequence[str]) -> bool:
        """True when these parts may share space in a simulator's model: neighbours of simple shapes, rigid ones, filtered ones."""
        if not self.foreign or len(parts) != 2:
            return False
        a, b = parts
        pair = frozenset(parts)
        near = pair in self.neighbours and bool(pair & self.simple)
        return near or self.scene.relations.rigid.together(a, b) or pair in self.filtered


def explained(case: ContactCase, findings: Sequence[Finding]) -> list[Finding]:
    """Add causes; put aside what simulators' shapes share by design."""
    measured_ones = [finding for finding in findings if finding.code != "E_MESH_OPEN"]  # `shapes` tells of open meshes
    case.shared.extend(finding for finding in measured_ones if case.by_design(finding.parts))
    kept = [_by_share(case, finding) for finding in measured_ones if not case.by_design(finding.parts)]
    depths = {(finding.code, finding.parts, str(finding.pose)): finding for finding in kept}
    named = []
    for finding in (*diagnose(case.scene, case.assembly.mechanism.tree, kept[:MOST_DIAGNOSED]), *kept[MOST_DIAGNOSED:]):
        depth = depths.get((finding.code, finding.parts, str(finding.pose)))
        if depth is not None and _is_doubtful(case, finding, depth):
            finding = depth  # noqa: PLW2901 - what was measured stays, the cause goes
        # the cause names its own numbers in the message; the finding's number stays the depth that was measured
        named.append(finding if depth is None else replace(finding, value=depth.value, limit=depth.limit, unit=depth.unit))
    return [finding for finding in named if finding.code != "E_NOT_ONE_SOLID"]  # `shapes` tells of pieces, once for each file


def _is_doubtful(case: ContactCase, finding: Finding, depth: Finding) -> bool:
    """True where a cause that explains many machines does not explain these parts.

    A pitch says something of two parts that turn on one base, each by its own joint, and nothing of limbs and chains. A part that
    ends in another is too long only where its end is the shortest way out.
    """
    if finding.cause == "pitch":
        tree = case.assembly.mechanism.tree
        a, b = (tree.path(case.assembly.ground, name) for name in finding.parts)
        moving = sum(joint.type is not JointType.FIXED for joint in tree.joints_between(*finding.parts))
        return moving > 2 or a[-1] in b or b[-1] in a
    ends = _ENDS.search(finding.message)
    return finding.cause == "envelope" and ends is not None and float(ends[1]) > SHORTEST * (depth.value or 0.0)


def _by_share(case: ContactCase, finding: Finding) -> Finding:
    """In simulators' formats let an overlap of neighbours be an error only when it is much of the smaller one."""
    if not case.foreign or finding.code != "E_STATIC_OVERLAP":
        return finding
    a, b = (case.scene.bodies[name] for name in finding.parts)
    poses = case.assembly.poses(case.assembly.mechanism.rest)
    T = relative(*(poses[case.assembly.mechanism.part_index(name)] for name in finding.parts))
    much = volume(a, b, T.matrix[:3]) > STATIC_SHARE * min(a.volume, b.volume)
    return finding if much else replace(finding, code="W_STATIC_OVERLAP")


def shared_note(shared: Sequence[Finding]) -> Finding:
    """Return one note on all pairs that may share space, and do."""
    deepest = max(shared, key=lambda finding: finding.value or 0.0)
    return Finding(
        code="I_AUDIT_SHARED",
        where=deepest.where,
        parts=tuple(dict.fromkeys(name for finding in shared for name in finding.parts)),
        message=f"{counted(len(shared), 'pair')} of parts that engines do not let collide overlap at rest, the deepest {listed(deepest.parts)}, "
        f"{deepest.value or 0.0:.4g} mm.",
        hint="Nothing, if the shapes represent bodies that fit.",
        value=deepest.value,
        limit=deepest.limit,
        unit=deepest.unit,
    )
