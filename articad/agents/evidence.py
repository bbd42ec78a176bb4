"""Evidence: the measurements of an assembly, made before any model is asked how it looks.

First the rest pose; if it has no fault, the declared fits, each joint through its range with the others at rest, and the surfaces that
make the joints. Every verdict says how strong it is, and every finding names its root cause if geometry shows it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from articad.agents.numbers import placed, short
from articad.agents.orders import HELD, addressed, is_fault_of_joint
from articad.agents.spacing import spacings
from articad.agents.travel import told_travels, travels
from articad.agents.trials import with_trials
from articad.arrays import FloatArray
from articad.assembly import Assembly, Poses
from articad.certificates.fits import FitCheck
from articad.findings import Finding, Findings
from articad.interference.check import check_scene
from articad.interference.diagnosis import diagnose
from articad.interference.freedoms import freedoms
from articad.interference.report import Checks, PairCheck, Strength
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint, JointType
from articad.render.pictures import motion_frames

POSES: Final = 9  # samples of each joint's range: enough for a flap that collides, quick enough for every round


@dataclass(frozen=True)
class Evidence:
    """Measurements of an assembly.

    Attributes:
        checks: The rest pose with the declared fits and, if nothing overlaps there, samples of each joint's range.
        sizes: Least and greatest corner of each part at rest, in the assembly's frame [mm].
        joints: Warnings about joints that surfaces do not make, if nothing overlaps at rest.
    """

    checks: Checks
    sizes: Mapping[str, tuple[FloatArray, FloatArray]] = field(default_factory=dict)
    joints: Findings = field(default_factory=Findings)

    @property
    def ok(self) -> bool:
        """True when nothing is wrong."""
        return self.checks.ok

    @property
    def faults_of_joints(self) -> Findings:
        """Warnings about joints that someone must answer once."""
        return Findings(filter(is_fault_of_joint, self.joints))

    @property
    def findings(self) -> Findings:
        """All findings, with their causes."""
        return self.checks.findings + self.joints


@dataclass(frozen=True)
class Known:
    """Verdicts that need no new check, because neither the two parts nor their relative motion have changed.

    Attributes:
        rest: Verdicts at rest, by pair.
        motion: Verdicts of samples of a joint's range, by joint and pair.
    """

    rest: Mapping[tuple[str, str], PairCheck] = field(default_factory=dict)
    motion: Mapping[str, Mapping[tuple[str, str], PairCheck]] = field(default_factory=dict)


def examine(assembly: Assembly, known: Known | None = None) -> Evidence:
    """Check an assembly at rest and, if it has no fault there, its fits, samples of each joint's range, and which surfaces make its joints.

    Args:
        assembly: As built.
        known: Pairs that need not be checked again.

    Returns:
        The checks of the rest pose, and a sampled verdict for every pair that meets in motion. Findings go to whoever is proven to have made the
        fault (`articad.agents.orders`). The first that goes to the designer states changes that end all of them (`articad.agents.trials`).
    """
    found = _examined(assembly, known)
    checks = replace(found.checks, findings=with_trials(found.checks.findings, assembly, lambda other: _examined(other).findings))
    return replace(found, checks=checks)


def _examined(assembly: Assembly, known: Known | None = None) -> Evidence:
    scene = assembly.scene()
    checks = assembly.check(known=None if known is None else known.rest)
    joints, at_rest = Findings(), checks.pairs
    if all(finding.stage == "fit" for finding in checks.findings.errors):  # what overlaps at rest overlaps in motion too
        for joint in assembly.mechanism.driving_joints:
            checks = _with_motion(checks, assembly, joint, scene, {} if known is None else known.motion.get(joint, {}))
        joints = assembly.check_joints().findings
    found = addressed(diagnose(scene, assembly.mechanism.tree, checks.findings) + joints, assembly, scene, at_rest)
    joints = Findings(finding for finding in found if finding.code in HELD)
    checks = replace(checks, findings=Findings(finding for finding in found if finding.code not in HELD))
    return Evidence(checks, _sizes(assembly), joints)


def told(assembly: Assembly, evidence: Evidence) -> str:
    """Return the measurements as text for a judge: numbers rounded, nothing that depends on the machine."""
    mechanism = assembly.mechanism
    lines = [f"Exact checks: {'passed' if evidence.ok else 'NOT passed'}."]
    lines += [f"- {finding}" for finding in evidence.checks.findings] or ["- no findings"]
    pairs = len({pair.parts for pair in evidence.checks.pairs})
    lines += [f"- {pairs} pairs of parts come near each other: compared at rest and along each joint's range, all other joints at rest."]
    lines += ["- Two joints were not moved together."] if len(assembly.drivers) > 1 else []
    if evidence.joints:
        lines += [
            "",
            "What surfaces leave open of the joints (no check fails by these; that a part is not secured along its axis is no fault):",
        ]
        lines += [f"- {finding}" for finding in evidence.joints]
    whole = assembly.mass()
    lines += ["", f"Mass {short(whole.mass)} kg; centre of mass at rest {placed(whole.com)} mm."]
    lines += [
        "",
        f"Mobility: {mechanism.mobility} freedoms. How far each joint goes, with one driver moved at a time (an endless one by a turn):",
    ]
    lines += told_travels(travels(assembly))
    if apart := spacings(assembly):
        lines += ["", "Distances between the axes of joints of each rigid piece (mm):", *apart]
    lines += ["", "Bounding boxes at rest, in the assembly's frame (mm):"]
    lines += [f"- {name}: from {placed(low)} to {placed(high)}" for name, (low, high) in evidence.sizes.items()]
    fits = [row for row in evidence.checks.fits if isinstance(row, FitCheck)]
    if fits:
        lines += ["", "Declared fits:"]
        for row in fits:
            gaps = (
                "not measured"
                if row.rest is None or row.least is None
                else f"gap {short(row.rest)} mm at rest, {short(row.least)} at least"
            )
            declared = (
                f"declared {short(row.declared.gap_min or 0)} to {short(row.declared.gap_max or 0)}, " if row.declared.gap_max else ""
            )
            lines.append(f"- {row.joint}: {declared}{gaps}: {row.verdict}")
    return "\n".join(lines)


def _with_motion(checks: Checks, assembly: Assembly, joint: str, scene: Scene, carried: Mapping[tuple[str, str], PairCheck]) -> Checks:
    captions, configurations = motion_frames(assembly, joint, POSES)
    worst: dict[tuple[str, str], tuple[PairCheck, str]] = {}
    for caption, q in zip(captions, configurations, strict=True):
        for pair in _pairs_at(assembly, q, scene, carried):
            known = worst.get(pair.parts)
            if known is None or pair.depth > known[0].depth:
                worst[pair.parts] = replace(pair, over=(joint,), strength=_sampled(pair, len(captions)), pose=pose_of(assembly, q)), caption
    collisions = [_collision(pair, joint, caption) for pair, caption in worst.values() if pair.verdict == "overlap" and not _waived(pair)]
    pairs = (*checks.pairs, *(pair for pair, _ in worst.values()), *carried.values())
    return replace(checks, findings=Findings([*checks.findings, *collisions]), pairs=pairs)


def _pairs_at(assembly: Assembly, q: FloatArray, scene: Scene, carried: Mapping[tuple[str, str], PairCheck]) -> Iterable[PairCheck]:
    """Return the verdicts at a configuration `(nq,)`, except for known ones."""
    if not carried:
        return assembly.check(q).pairs
    poses = Poses(assembly.mechanism.parts, assembly.poses(q))
    checks = check_scene(scene, poses, over="pose", ground=assembly.ground, known=carried)
    return (pair for pair in checks.pairs if pair.parts not in carried)


def _sampled(pair: PairCheck, poses: int) -> Strength:
    return pair.strength if _waived(pair) else Strength.sampled(poses)


def _waived(pair: PairCheck) -> bool:
    return pair.strength.kind == "waived"


def _collision(pair: PairCheck, joint: str, caption: str) -> Finding:
    a, b = pair.parts
    return Finding(
        code="E_MOTION_COLLISION",
        where=f"joints.{joint}",
        parts=pair.parts,
        message=f"{a} and {b} collide in motion: at {caption} they overlap by {short(pair.volume)} mm³, {short(pair.depth)} mm deep "
        f"(allowed {short(pair.allowed)} mm).",
        hint="Make room for the motion (a recess, more clearance, an axis farther out), or narrow the limits.",
        value=pair.depth,
        limit=pair.allowed,
        unit="mm",
        pose=pair.pose,
    )


def pose_of(assembly: Assembly, q: FloatArray) -> dict[str, float]:
    """Return the coordinates of all joints at a configuration `(nq,)`, followers included [rad, mm]."""
    columns = assembly.mechanism.configuration(q).columns.tolist()
    pose: dict[str, float] = {}
    for joint in assembly.joints:
        count = len(joint.column_names)
        pose |= _freedom_values(joint, columns[:count])
        columns = columns[count:]
    return pose


def _freedom_values(joint: Joint, values: list[float]) -> dict[str, float]:
    """Return a joint's coordinates by the names of its freedoms; a ball's quaternion is split into a twist, then a swing."""
    names = [freedom.name for freedom in freedoms(joint)]
    if joint.type is JointType.FREE:
        return dict(zip(joint.column_names, map(float, values), strict=True))
    if joint.type is not JointType.BALL:
        return dict(zip(names, map(float, values), strict=True))
    x, y, z, w = values if values[3] >= 0 else [-value for value in values]
    twist = 2 * math.atan2(z, w)
    cz, sz = math.cos(twist / 2), math.sin(twist / 2)
    x, y = x * cz - y * sz, y * cz + x * sz
    half = math.hypot(x, y)
    share = 2.0 if half < 1e-9 else 2 * math.asin(min(half, 1.0)) / half
    return dict(zip(names, (x * share, y * share, twist), strict=True))


def _sizes(assembly: Assembly) -> dict[str, tuple[FloatArray, FloatArray]]:
    rest = assembly.at()
    placed = {name: rest[name].apply(mesh.vertices) for name, part in assembly.parts.items() if (mesh := part.mesh) is not None}
    return {name: (points.min(axis=0), points.max(axis=0)) for name, points in placed.items()}
