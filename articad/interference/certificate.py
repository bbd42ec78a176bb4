"""Certified motion: for every joint over its whole range, and for joints that move together, a proof without sampling gaps.

Each pair of parts is first tried over all joints between them at once; where that does not succeed, over each joint alone and
over each two. What cannot be proven is looked at where the proof stopped: it is a collision, with its first pose and the
range that is free, or it was not checked, and then the certificate is not ok.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import Any

import numpy as np

from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.errors import KinematicsError
from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh
from articad.interference.claims import Claim
from articad.interference.cover import Budget, cover_line
from articad.interference.linkage import LOOKS, LinkageProver
from articad.interference.motion import Chain, freedoms
from articad.interference.overlap import NOTHING, Overlap, overlap
from articad.interference.proof import Proof, Prover, beyond
from articad.interference.relations import FitLike, WaiverLike, all_pairs
from articad.interference.report import PairCheck, Strength, rounded
from articad.interference.scene import Scene
from articad.interference.verdict import judge
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.tree import KinematicTree

DEFAULT_EPSILON_MM = 1e-3
DEFAULT_BUDGET_S = 600.0
FIRST_BOXES = 64  # spent on each pair along a driver, before those that need more hold up the others
WIDE_BOXES = 256  # boxes spent on all joints at once before they are taken one by one
_ENTRY_MM = 1e-6  # distance at which meshes are said to touch


@dataclass(frozen=True)
class Range:
    """What is known of a joint's range about rest.

    Attributes:
        joint: Name of the coordinate.
        lower: Proven free down to here [rad or mm].
        upper: Proven free up to here.
        declared: Its bounds.
    """

    joint: str
    lower: float
    upper: float
    declared: tuple[float, float]

    @property
    def is_whole(self) -> bool:
        """True when the declared range is free."""
        return self.lower <= self.declared[0] and self.declared[1] <= self.upper


@dataclass(frozen=True)
class Certificate:
    """The outcome: findings for people, claims for a checker.

    Attributes:
        findings: Collisions, and whatever was asked for but not proven.
        pairs: A verdict and its strength for each pair and set of joints.
        claims: What is proven, with all numbers needed to check it.
        ranges: Of each single coordinate, the widest range about rest that is free.
        epsilon: Distances up to here were taken for contact [mm].
        meshes: The exact meshes that were proven with.
        deflections: Of these meshes [mm].
        mechanism: What moved.
        asked: Names of the joints to be proven.
        together: Whether joints were to be moved two at a time, too.
        followed: What is proven along the drivers of loops and couplings; it rests on the tubes of kinematics, which no checker repeats.
        constrained: Names of the joints of loops and couplings.
        queries: Distances asked for.
        seconds: Time spent.
    """

    findings: Findings
    pairs: tuple[PairCheck, ...]
    claims: tuple[Claim, ...]
    ranges: tuple[Range, ...]
    epsilon: float
    meshes: Mapping[str, TriMesh]
    deflections: Mapping[str, float]
    mechanism: Mechanism
    asked: tuple[str, ...] = ()
    together: bool = True
    followed: tuple[Claim, ...] = ()
    constrained: frozenset[str] = frozenset()
    queries: int = 0
    seconds: float = 0.0

    @property
    def ok(self) -> bool:
        """True when everything asked for is proven or waived, and nothing collides."""
        return self.findings.ok and not self.findings.of("W_NOT_CERTIFIED")

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.certificate/1`."""
        return {
            "schema": "articad.certificate/1",
            "ok": self.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "epsilon_mm": self.epsilon,
            "asked": [name for name in self.asked if name not in self.constrained],
            "linkage": sorted(self.constrained),
            "together": self.together,
            "meshes": {name: {"sha256": mesh.digest, "deflection_mm": self.deflections[name]} for name, mesh in self.meshes.items()},
            "mechanism": mechanism_json(self.mechanism),
            "pairs": [pair.to_json() for pair in self.pairs],
            "ranges": [
                {"joint": r.joint, "free": [rounded(r.lower), rounded(r.upper)], "declared": [rounded(bound) for bound in r.declared]}
                for r in self.ranges
            ],
            "claims": [claim.to_json() for claim in self.claims],
            "followed": [claim.to_json() for claim in self.followed],
        }

    def mesh_files(self) -> dict[str, bytes]:
        """Return the meshes that a checker needs, as `<part>.npz`; the same meshes give the same bytes."""
        return {f"{name}.npz": _npz(mesh) for name, mesh in self.meshes.items()}


def certify(
    meshes: Mapping[str, TriMesh],
    mechanism: Mechanism,
    *,
    joints: Sequence[str] | None = None,
    pairs: bool = True,
    epsilon: float = DEFAULT_EPSILON_MM,
    budget: float = DEFAULT_BUDGET_S,
    deflection: Mapping[str, float] | float = 0.0,
    waivers: Sequence[WaiverLike] = (),
    fits: Mapping[str, FitLike] | None = None,
) -> Certificate:
    """Prove that parts do not meet while joints move over their whole ranges; endless ones over a full turn.

    Args:
        meshes: By part, in the part's frame; parts without geometry are left out.
        mechanism: Moves them.
        joints: Names of those to be proven; all that move by default.
        pairs: Whether joints are also moved two at a time.
        epsilon: Distances up to here are contact [mm].
        budget: Seconds.
        deflection: How far meshes are from their solids [mm], by part or the same for all.
        waivers: Overlaps that the plan allows.
        fits: By joint name.
    """
    scene = Scene.of(meshes, mechanism.joints, waivers=waivers, deflection=deflection, fits=fits)
    return _Certifying(scene, mechanism, joints, together=pairs, epsilon=epsilon, budget=Budget(budget)).run()


@dataclass
class _Certifying:
    scene: Scene
    mechanism: Mechanism
    asked: Sequence[str] | None
    together: bool
    epsilon: float
    budget: Budget
    findings: list[Finding] = field(default_factory=list)
    verdicts: list[PairCheck] = field(default_factory=list)
    claims: list[Claim] = field(default_factory=list)
    ranges: dict[str, Range] = field(default_factory=dict)
    followed: list[Claim] = field(default_factory=list)
    later: list[tuple[tuple[str, str], LinkageProver]] = field(default_factory=list)
    left: dict[tuple[str, ...], list[tuple[str, str]]] = field(default_factory=dict)
    _constrained: frozenset[str] = frozenset()

    def __init__(
        self, scene: Scene, mechanism: Mechanism, asked: Sequence[str] | None, *, together: bool, epsilon: float, budget: Budget
    ) -> None:
        self.scene, self.mechanism, self.asked = scene, mechanism, asked
        self.together, self.epsilon, self.budget = together, epsilon, budget
        self.findings, self.verdicts, self.claims, self.followed, self.ranges, self.left = [], [], [], [], {}, {}
        self.later = []
        self._constrained = constrained_joints(mechanism)

    def run(self) -> Certificate:
        for a, b in all_pairs(name for name in self.mechanism.parts if name in self.scene.bodies):
            if not self.scene.relations.rigid.together(a, b):
                self._pair(a, b)
        for parts, prover in self.later:
            if self.budget.is_spent:
                self.left.setdefault((prover.coordinate.joint,), []).append(parts)
            else:
                self._followed(parts, prover, prover.prove())
        self._report_left()
        return Certificate(
            Findings(self.findings),
            tuple(self.verdicts),
            tuple(self.claims),
            tuple(self.ranges.values()),
            self.epsilon,
            self.scene.meshes,
            self.scene.deflections,
            self.mechanism,
            tuple(joint.name for joint in self.mechanism.joints if freedoms(joint) and (self.asked is None or joint.name in self.asked)),
            self.together,
            tuple(self.followed),
            self._constrained,
            self.budget.queries,
            self.budget.spent,
        )

    def _pair(self, a: str, b: str) -> None:
        moving = [joint.name for joint in self.mechanism.tree.joints_between(a, b) if freedoms(joint)]
        wanted = [name for name in moving if self.asked is None or name in self.asked]
        if not wanted:
            return
        if a in self.scene.broken or b in self.scene.broken:
            self._refuse((a, b), tuple(wanted), "; ".join(self.scene.broken[name] for name in (a, b) if name in self.scene.broken))
            return
        tied = [name for name in moving if name in self._constrained]
        if tied:
            self._follow(a, b, tuple(tied))
        wanted = [name for name in wanted if name not in tied]
        if len(wanted) > 1 and self._prove(a, b, tuple(wanted), most=WIDE_BOXES, tentative=True):
            return
        for sets in self._smaller(wanted):
            self._prove(a, b, sets)

    def _smaller(self, wanted: Sequence[str]) -> Iterator[tuple[str, ...]]:
        for name in wanted:
            yield (name,)
        if self.together and len(wanted) > 1:
            yield from combinations(wanted, 2)

    def _prove(self, a: str, b: str, joints: tuple[str, ...], *, most: int | None = None, tentative: bool = False) -> bool:
        """Prove one pair over some joints; a tentative failure is not reported."""
        if self.budget.is_spent:
            if not tentative:
                self.left.setdefault(joints, []).append((a, b))
            return False
        prover = Prover(self.scene, self.mechanism.tree, (a, b), joints, epsilon=self.epsilon, budget=self.budget)
        proof = prover.prove(most=most)
        if proof.is_complete:
            self.claims += proof.claims
            self._note_ranges(joints, proof)
            contact = "contact" if proof.overlap.volume > 0 or any(claim.shrink for claim in proof.claims) else "clear"
            self._verdict((a, b), joints, Strength.certified(proof.epsilon), proof.overlap, contact)
            return True
        if tentative:
            return False
        if proof.out_of_budget and not proof.contacts:
            self.left.setdefault(joints, []).append((a, b))
        else:
            self._stopped((a, b), joints, proof)
        return False

    def _follow(self, a: str, b: str, tied: tuple[str, ...]) -> None:
        """Prove one pair along each driver of the loops and couplings between them, the others at rest."""
        for index, coordinate in enumerate(self.mechanism.drivers):
            if coordinate.joint not in self._constrained or (self.asked is not None and coordinate.joint not in self.asked):
                continue
            if self.budget.is_spent:
                self.left.setdefault((coordinate.joint,), []).append((a, b))
                continue
            try:
                prover = LinkageProver(self.scene, self.mechanism, (a, b), tied, index, epsilon=self.epsilon, budget=self.budget)
                proof = prover.prove(most=FIRST_BOXES)
            except (KinematicsError, KeyError, ValueError) as error:
                self._refuse((a, b), (coordinate.joint,), f"the linkage cannot be followed: {error}")
                continue
            if proof.out_of_budget and not proof.contacts:
                self.later.append(((a, b), prover))
            else:
                self._followed((a, b), prover, proof)

    def _followed(self, parts: tuple[str, str], prover: LinkageProver, proof: Proof) -> None:
        joint, name = prover.coordinate.joint, prover.coordinate.name
        if proof.is_complete:
            # what is invariant rests on no tube, and a checker can tell
            invariant = all(claim.separation is not None or not claim.reach for claim in proof.claims)
            (self.claims if invariant else self.followed).extend(proof.claims)
            contact = "contact" if proof.overlap.volume > 0 or any(claim.shrink for claim in proof.claims) else "clear"
            self._verdict(parts, (joint,), Strength.certified(proof.epsilon), proof.overlap, contact)
        elif proof.out_of_budget and not proof.contacts:
            self.left.setdefault((joint,), []).append(parts)
            return
        else:
            worst, value = prover.worst(proof)
            pose = None if value is None else {name: value}
            check, found = judge(
                self.scene, parts, worst, over=(joint,), pose=pose, baseline=proof.overlap.volume, strength=Strength.sampled(LOOKS)
            )
            self.verdicts.append(check)
            self.findings += found
            if not any(finding.code == "E_MOTION_COLLISION" for finding in found) and check.strength.kind != "waived":
                self.findings.append(_unproven(parts, (joint,), worst, check.allowed, LOOKS))
        if proof.lower is not None and proof.upper is not None:
            known = self.ranges.get(name, Range(name, *prover.bounds, prover.bounds))
            self.ranges[name] = replace(known, lower=max(known.lower, proof.lower), upper=min(known.upper, proof.upper))

    def _stopped(self, parts: tuple[str, str], joints: tuple[str, ...], proof: Proof) -> None:
        """Say what is where a proof stopped: a collision, or contact that only samples can judge."""
        looks = Looks(self.scene, self.mechanism.tree, parts, joints, proof)
        worst, pose = looks.worst()
        check, found = judge(
            self.scene, parts, worst, over=joints, pose=pose, baseline=proof.overlap.volume, strength=Strength.sampled(looks.count)
        )
        collides = [finding for finding in found if finding.code == "E_MOTION_COLLISION"]
        self.verdicts.append(check)
        if collides:
            self.findings.append(self._collision(parts, joints, proof, looks, collides[0]))
            self._note_ranges(joints, proof)
            if proof.width() > 0:  # of a single coordinate the part before the collision is proven
                self.claims += proof.claims
        else:
            self.findings += found
            if check.strength.kind != "waived":
                self.findings.append(_unproven(parts, joints, worst, check.allowed, looks.count))

    def _collision(self, parts: tuple[str, str], joints: tuple[str, ...], proof: Proof, looks: Looks, seen: Finding) -> Finding:
        if len(joints) != 1 or proof.lower is None or proof.upper is None or not proof.contacts:
            return replace(seen, message=f"{seen.message} Seen while {' and '.join(joints)} move.")
        name, first, proven = looks.entry(self.scene.tolerated(*parts), seen.pose)
        unit, scale = (" mm", 1.0) if name in self._sliding() else ("°", 180 / np.pi)
        return replace(
            seen,
            where=f"joints.{joints[0]}",
            message=f"{parts[0]} and {parts[1]} collide from {name} = {first * scale:.7g}{unit}; up to {proven * scale:.7g}{unit} they are proven "
            f"apart (an interval of {abs(first - proven) * scale:.2g}{unit}). Beyond, they overlap up to {seen.value:.3g} mm.",
            hint=f"Set the limits of {joints[0]} to [{_up(proof.lower * scale):g}, {-_up(-proof.upper * scale):g}]{unit}, or make room.",
            value=first,
            limit=proven,
            unit=unit.strip() if unit == " mm" else "rad",
            pose={name: first},
        )

    def _sliding(self) -> set[str]:
        return {c.name for joint in self.mechanism.joints for c in joint.columns if c.unit == "mm"}

    def _note_ranges(self, joints: tuple[str, ...], proof: Proof) -> None:
        if len(joints) != 1 or proof.lower is None or proof.upper is None:
            return
        (freedom,) = freedoms(self._joint(joints[0]))
        known = self.ranges.get(freedom.name, Range(freedom.name, freedom.lower, freedom.upper, (freedom.lower, freedom.upper)))
        self.ranges[freedom.name] = replace(known, lower=max(known.lower, proof.lower), upper=min(known.upper, proof.upper))

    def _joint(self, name: str) -> Joint:
        return next(joint for joint in self.mechanism.joints if joint.name == name)

    def _verdict(self, parts: tuple[str, str], joints: tuple[str, ...], strength: Strength, found: Overlap, verdict: str) -> None:
        relation = self.scene.relations.of(*parts)
        allowed = self.scene.tolerated(*parts)
        waiver = self.scene.relations.waiver(*parts)
        if waiver is not None and strength.kind == "certified" and strength.epsilon is not None and strength.epsilon > allowed:
            strength = Strength.waived(waiver.reason)
            allowed = waiver.max_depth
        check = PairCheck(parts, relation, joints, strength, found.volume, found.depth, allowed, None, verdict)  # type: ignore[arg-type]
        self.verdicts.append(check)

    def _refuse(self, parts: tuple[str, str], joints: tuple[str, ...], reason: str) -> None:
        self.verdicts.append(
            PairCheck(
                parts,
                self.scene.relations.of(*parts),
                joints,
                Strength.not_checked(reason),
                allowed=self.scene.tolerated(*parts),
                verdict="unknown",
            )
        )
        self.findings.append(
            Finding(
                code="E_NOT_CHECKED",
                where=f"joints.{joints[0]}",
                parts=parts,
                message=f"{parts[0]} and {parts[1]} are not proven apart over {', '.join(joints)}: {reason}.",
                hint="Repair what is named; a sampled sweep may still look at them.",
            )
        )

    def _report_left(self) -> None:
        for joints, pairs in self.left.items():
            for parts in pairs:
                self._verdict(parts, joints, Strength.not_checked("the budget ran out"), NOTHING, "unknown")
            names = ", ".join(f"{a}/{b}" for a, b in pairs)
            self.findings.append(
                Finding(
                    code="E_NOT_CHECKED",
                    where=f"joints.{joints[0]}",
                    parts=tuple(dict.fromkeys(name for pair in pairs for name in pair)),
                    message=f"The budget of {self.budget.seconds:g} s ran out before these pairs were proven apart over {', '.join(joints)}: {names}.",
                    hint="Raise the budget, or widen the gap between them: the work grows as 1/gap.",
                    value=self.budget.seconds,
                    unit="s",
                )
            )


class Looks:
    """Looks at the poses beyond the one where a proof stopped, with exact booleans."""

    def __init__(self, scene: Scene, tree: KinematicTree, parts: tuple[str, str], joints: tuple[str, ...], proof: Proof) -> None:
        self.proof = proof
        self.chain = Chain(tree, *parts, joints)
        self.bodies = scene.bodies[parts[0]], scene.bodies[parts[1]]
        self.allowed = scene.tolerated(*parts)
        self.count = 0

    def worst(self) -> tuple[Overlap, dict[str, float] | None]:
        """Return the deepest overlap that was seen, and where."""
        worst, where = self.proof.overlap, None
        for point in self._points():
            self.count += 1
            found = overlap(*self.bodies, SE3.from_matrix(self.chain.matrix(point)))
            if found.depth > worst.depth:
                worst, where = found, dict(zip((freedom.name for freedom in self.chain.freedoms), point, strict=True))
        return worst, where

    def _points(self) -> Iterator[tuple[float, ...]]:
        """Yield poses from where a proof stopped, or from rest where it could not begin."""
        speeds = self.chain.reach(self.bodies[0].mesh.vertices, self.bodies[1].mesh.vertices)
        for contact in self.proof.contacts:
            yield from beyond(self.chain, speeds, [contact[freedom.name] for freedom in self.chain.freedoms], self.allowed)

    def entry(self, allowed: float, pose: Mapping[str, float] | None) -> tuple[str, float, float]:
        """Return the coordinate, where the meshes first meet, and the end of what is proven, towards the pose of the collision.

        Where contact is allowed the meshes meet when they are deeper than that.
        """
        (freedom,) = self.chain.freedoms
        hit = freedom.rest if pose is None else pose[freedom.name]
        stopped = [(patch, values[0]) for patch, values in self.proof.stopped if (values[0] - freedom.rest) * (hit - freedom.rest) >= 0]
        patch, proven = min(stopped, key=lambda found: abs(found[1] - freedom.rest))
        if patch.shrink:
            return freedom.name, self._deeper_than(allowed, proven, hit), proven
        bounds = (proven, max(proven, hit)) if hit >= proven else (hit, proven)
        reach = float(patch.reach[0])
        touch = cover_line(patch.distance, bounds, proven, reach=reach, epsilon=_ENTRY_MM, budget=Budget(60.0), most=2000)
        return freedom.name, touch.upper if hit >= proven else touch.lower, proven

    def _deeper_than(self, allowed: float, free: float, hit: float) -> float:
        for _ in range(30):
            middle = (free + hit) / 2
            deep = overlap(*self.bodies, SE3.from_matrix(self.chain.matrix((middle,)))).depth > allowed
            free, hit = (free, middle) if deep else (middle, hit)
        return hit


def constrained_joints(mechanism: Mechanism) -> frozenset[str]:
    """Return the joints that cannot move by themselves: those of loops, and those that couplings tie."""
    tied: set[str] = set()
    for joint in mechanism.loop_joints:
        tied.update({joint.name, *(other.name for other in mechanism.tree.joints_between(joint.parent, joint.child))})
    for coupling in mechanism.couplings:
        tied.update({coupling.a.split(".")[0], coupling.b.split(".")[0]})
    return frozenset(tied)


def mechanism_json(mechanism: Mechanism) -> dict[str, Any]:
    """Return parts, frames and joints as numbers: all that a checker needs to place two parts.

    A joint is `T_parent_child = parent_frame · Π exp(Σ (slide, turn)·q) · child_frame⁻¹`, the product over its steps in order; the
    mate is in `child_frame`. Freedoms of one step are summed before the exponential: a ball swings about a vector.
    """
    loops = {joint.name for joint in mechanism.loop_joints}
    return {
        "ground": mechanism.ground,
        "parts": list(mechanism.parts),
        "joints": [
            {
                "name": joint.name,
                "type": str(joint.type),
                "parent": joint.parent,
                "child": joint.child,
                "parent_frame": joint.T_parent_connector.matrix.tolist(),
                "child_frame": (joint.T_child_connector @ flip(joint.mate)).matrix.tolist(),
                "cone": freedoms(joint)[0].upper if joint.type is JointType.BALL else None,
                "loop": joint.name in loops,
                "freedoms": _steps_json(joint),
            }
            for joint in mechanism.joints
        ],
    }


def _steps_json(joint: Joint) -> list[dict[str, Any]]:
    X, Y, Z, none = [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]
    rise = [0.0, 0.0, joint.lead / (2 * math.pi)]
    steps: dict[JointType, list[tuple[int, list[float], list[float]]]] = {
        JointType.FIXED: [],
        JointType.REVOLUTE: [(0, none, Z)],
        JointType.SLIDER: [(0, Z, none)],
        JointType.CYLINDRICAL: [(0, Z, none), (1, none, Z)],
        JointType.SCREW: [(0, rise, Z)],
        JointType.PLANAR: [(0, X, none), (0, Y, none), (1, none, Z)],
        JointType.UNIVERSAL: [(0, none, X), (1, none, Y)],
        JointType.BALL: [(0, none, X), (0, none, Y), (1, none, Z)],
    }
    return [
        {"name": freedom.name, "joint": joint.name, "range": [freedom.lower, freedom.upper], "step": step, "slide": slide, "turn": turn}
        for freedom, (step, slide, turn) in zip(freedoms(joint), steps[joint.type], strict=True)
    ]


def _unproven(parts: tuple[str, str], joints: tuple[str, ...], worst: Overlap, allowed: float, count: int) -> Finding:
    return Finding(
        code="W_NOT_CERTIFIED",
        where=f"joints.{joints[0]}",
        parts=parts,
        message=f"{parts[0]} and {parts[1]} are too close over {' and '.join(joints)} to be proven apart: at {count} poses they overlap "
        f"{worst.depth:.3g} mm at most (allowed {allowed:.3g} mm).",
        hint="Give them a clearance if the motion is to be proven.",
        value=worst.depth,
        limit=allowed,
        unit="mm",
    )


def _up(value: float) -> float:
    """Round up to a thousandth, so that proposed limits lie within what is proven."""
    return math.ceil(round(value * 1000, 6)) / 1000 + 0.0


def _npz(mesh: TriMesh) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, vertices=mesh.vertices, triangles=mesh.triangles)
    return buffer.getvalue()
