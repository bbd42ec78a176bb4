"""The input and the results of contact checks; which causes are reported, and which overlaps of simulators' shapes are by design."""

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
SHORTEST = 1.5  # times the depth: the shortest way out, because overlaps are seldom boxes
_ENDS = re.compile(r"ends ([-+.\de]+) mm inside")


@dataclass
class Contacts:
    """The results of the checks.

    Attributes:
        pairs: Verdicts on every pair, at the rest pose.
        findings: All findings.
        undone: What was not checked, in words.
        strength: "sampled", "certified" or "certified in part", for the motion.
        certificate: Certificate of the motion, if a proof was requested.
    """

    pairs: Checks
    findings: list[Finding] = field(default_factory=list)
    undone: list[str] = field(default_factory=list)
    strength: str = "sampled"
    certificate: Certificate | None = None


@dataclass(frozen=True, eq=False)
class ContactCase:
    """The input of the checks.

    Attributes:
        assembly: The assembly read from the file.
        foreign: True for URDF and MJCF.
        simple: Parts with at least one box, cylinder, sphere or capsule among their collision shapes.
        filtered: Pairs that the file's own engine never lets collide.
        scene: The scene with the collision shapes.
        neighbours: Pairs with one joint between them.
        shared: Overlaps of such pairs, reported in one note.
    """

    assembly: Assembly
    foreign: bool
    simple: frozenset[str]
    filtered: frozenset[frozenset[str]]
    scene: Scene
    neighbours: frozenset[frozenset[str]]
    shared: list[Finding] = field(default_factory=list)

    def by_design(self, parts: Sequence[str]) -> bool:
        """True if these parts may overlap in a simulator's model: neighbours with simple shapes, rigid ones, filtered ones."""
        if not self.foreign or len(parts) != 2:
            return False
        a, b = parts
        pair = frozenset(parts)
        near = pair in self.neighbours and bool(pair & self.simple)
        return near or self.scene.relations.rigid.together(a, b) or pair in self.filtered


def explained(case: ContactCase, findings: Sequence[Finding]) -> list[Finding]:
    """Add causes; remove overlaps of simulators' shapes that are by design."""
    measured_ones = [finding for finding in findings if finding.code != "E_MESH_OPEN"]  # `shapes` reports open meshes
    case.shared.extend(finding for finding in measured_ones if case.by_design(finding.parts))
    kept = [_by_share(case, finding) for finding in measured_ones if not case.by_design(finding.parts)]
    depths = {(finding.code, finding.parts, str(finding.pose)): finding for finding in kept}
    named = []
    for finding in (*diagnose(case.scene, case.assembly.mechanism.tree, kept[:MOST_DIAGNOSED]), *kept[MOST_DIAGNOSED:]):
        depth = depths.get((finding.code, finding.parts, str(finding.pose)))
        if depth is not None and _is_doubtful(case, finding, depth):
            finding = depth  # noqa: PLW2901 - keep the measured finding, drop the cause
        # the cause has its own numbers in the message; the finding's value stays the measured depth
        named.append(finding if depth is None else replace(finding, value=depth.value, limit=depth.limit, unit=depth.unit))
    return [finding for finding in named if finding.code != "E_NOT_ONE_SOLID"]  # `shapes` reports pieces, once for each file


def _is_doubtful(case: ContactCase, finding: Finding, depth: Finding) -> bool:
    """True if a cause that is typical of machines does not explain these parts.

    A pitch explains two parts that turn on one base, each by its own joint, but not limbs and chains. A part that ends in another is too
    long only if its end is the shortest way out.
    """
    if finding.cause == "pitch":
        tree = case.assembly.mechanism.tree
        a, b = (tree.path(case.assembly.ground, name) for name in finding.parts)
        moving = sum(joint.type is not JointType.FIXED for joint in tree.joints_between(*finding.parts))
        return moving > 2 or a[-1] in b or b[-1] in a
    ends = _ENDS.search(finding.message)
    return finding.cause == "envelope" and ends is not None and float(ends[1]) > SHORTEST * (depth.value or 0.0)


def _by_share(case: ContactCase, finding: Finding) -> Finding:
    """In simulators' formats, an overlap of neighbours is an error only if it is a large share of the smaller one."""
    if not case.foreign or finding.code != "E_STATIC_OVERLAP":
        return finding
    a, b = (case.scene.bodies[name] for name in finding.parts)
    poses = case.assembly.mechanism.at_rest
    T = relative(*(poses[case.assembly.mechanism.part_index(name)] for name in finding.parts))
    much = volume(a, b, T.matrix[:3]) > STATIC_SHARE * min(a.volume, b.volume)
    return finding if much else replace(finding, code="W_STATIC_OVERLAP")


def shared_note(shared: Sequence[Finding]) -> Finding:
    """Return one note on all pairs that overlap by design."""
    deepest = max(shared, key=lambda finding: finding.value or 0.0)
    return Finding(
        code="I_AUDIT_SHARED",
        where=deepest.where,
        parts=tuple(dict.fromkeys(name for finding in shared for name in finding.parts)),
        message=f"{counted(len(shared), 'pair')} of parts that engines exclude from collision overlap at rest; the deepest is {listed(deepest.parts)}, "
        f"{deepest.value or 0.0:.4g} mm.",
        hint="Nothing needs to be done if the shapes represent bodies that fit.",
        value=deepest.value,
        limit=deepest.limit,
        unit=deepest.unit,
    )
