"""Proofs of motion: what touches is contact where a joint connects two bodies, whichever of their parts it names."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from articad.assembly import Assembly
from articad.findings import Findings
from articad.kinematics.joints import Joint, JointType
from articad_bench.subject import Subject

MOST: Final = 8  # pairs of parts for which the motion is proven once more
_UNPROVEN: Final = "W_NOT_CERTIFIED"
_Pair = tuple[str, ...]


def proven(subject: Subject, assembly: Assembly, *, pairs: bool, seconds: float) -> tuple[bool, str]:
    """Return whether it is proven that nothing collides, and what is not proven, in words.

    Two parts that a joint names may touch, and others hardly: a lid that lies on its frame is proven only if its hinge names the two, and not an
    arm on the lid. So each pair of two jointed bodies that is not proven is looked at once more, with the joint between these two parts.

    Args:
        subject: The product.
        assembly: Its assembly, as it is to be proven.
        pairs: Whether joints are also moved two at a time.
        seconds: Budget of each proof.
    """
    found = assembly.certify(pairs=pairs, budget=seconds)
    told = "; ".join(finding.message for finding in found.findings if finding.severity != "info")
    touching = _only_unproven(found.findings)
    if found.ok or not 0 < len(touching) <= MOST:
        return found.ok, told or "proven"
    for pair in touching:
        other = _joined(subject, assembly, pair)
        checks = () if other is None else other.certify(pairs=pairs, budget=seconds).pairs
        kinds = {check.strength.kind for check in checks if set(check.parts) == set(pair)}
        if kinds != {"certified"}:
            return False, told
    return True, "proven"


def _only_unproven(findings: Findings) -> list[_Pair]:
    """Return the pairs that are not proven, each once; none if anything else is wrong."""
    serious = [finding for finding in findings if finding.severity != "info"]
    return list(dict.fromkeys(finding.parts for finding in serious)) if all(f.code == _UNPROVEN for f in serious) else []


def _joined(subject: Subject, assembly: Assembly, pair: _Pair) -> Assembly | None:
    """Return the same product with a joint between the two bodies naming these two parts of them; None if no joint moves one on the other."""
    bodies = {subject.rigid[name]: name for name in pair}
    for joint in assembly.mechanism.given_joints:
        ends = subject.rigid[joint.parent], subject.rigid[joint.child]
        if joint.type not in {JointType.FIXED, JointType.FREE} and {*ends} == {*bodies} and len(bodies) == len(pair):
            return _with(assembly, joint, _between(subject, joint, bodies[ends[0]], bodies[ends[1]]))
    return None


def _between(subject: Subject, joint: Joint, parent: str, child: str) -> Joint:
    """Return a joint in the same place between other parts of the same bodies."""
    rest = subject.rest
    return replace(
        joint,
        parent=parent,
        child=child,
        T_parent_connector=rest[parent].inverse() @ rest[joint.parent] @ joint.T_parent_connector,
        T_child_connector=rest[child].inverse() @ rest[joint.child] @ joint.T_child_connector,
    )


def _with(assembly: Assembly, joint: Joint, other: Joint) -> Assembly:
    known = assembly.mechanism
    return replace(assembly, mechanism=known.changed(joints=[other if each is joint else each for each in known.given_joints]))
