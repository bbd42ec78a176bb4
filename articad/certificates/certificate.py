"""Certified motion: a proof without sampling gaps for every joint over its whole range, and for joints that move together.

Each pair of parts is first tried over all joints between them at once; if that fails, over each joint alone and over each two. What
cannot be proven is examined where the proof stopped: either it is a collision, reported with its first pose and the free range, or it
was not checked, and then the certificate is not ok.
"""

from __future__ import annotations

import io
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import combinations
from typing import Any, overload

import numpy as np

from articad.certificates.claims import Claim
from articad.certificates.clearing import MOST_PAIRS
from articad.certificates.covers import covered
from articad.certificates.linkage import DriverTrack, LinkageProver
from articad.certificates.proof import Proof, Prover, beyond
from articad.certificates.ranges import driven_range, proven_freedoms
from articad.certificates.tolerance import Tolerances, is_still
from articad.certificates.verifier import PROOF, Checker
from articad.certificates.verifier_files import Refuted, widened
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.errors import KinematicsError
from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh
from articad.interference.clearance import Clearance, collisions_at, least_clearances
from articad.interference.cover import cover_line
from articad.interference.following import Following, what_follows
from articad.interference.freedoms import freedoms, slides_endlessly
from articad.interference.motion import Route, Values, routes
from articad.interference.overlap import NOTHING, Overlap, overlap
from articad.interference.relations import FitLike, WaiverLike
from articad.interference.report import Checks, FitRow, PairCheck, Strength, rounded
from articad.interference.scene import Scene
from articad.interference.surface import Surface, surface_distance, whole_surface
from articad.interference.sweep import MotionSampler
from articad.interference.verdict import judge
from articad.interference.work import WorkBudget
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.iso2768 import ToleranceClass

DEFAULT_EPSILON_MM = 1e-3
DEFAULT_BUDGET_S = 600.0
FIRST_PAIRS = 40_000  # of pieces, spent on each pair along drivers before the pairs that need more
WIDE_PAIRS = 60_000  # of pieces, spent on all joints at once before they are taken one by one
TIED_PAIRS = 8_000  # of pieces, spent on all motions of a linkage before its drivers are followed: that is cheap
FOLLOWED_PAIRS = 400_000  # of pieces, spent on all motions of a linkage that cannot be followed
MOST_EXPECTED = 1000  # boxes of several drivers of one group, estimated from the pieces of each alone, beyond which they are not followed
MOST_TOGETHER = 3  # drivers of one group followed all at once before they are taken two at a time
IDLE = 1e-7  # singular value of the Jacobian of loops, below which followers can move while their drivers stand still
IDLE_SHARE = 0.3  # share of such a motion above which a twist can serve as its driver
_END_SLACK = 1e-6  # rad or mm: largest distance of a driver's end from its limit
_ENTRY_MM = 1e-6  # distance at which meshes count as touching


@dataclass(frozen=True)
class Range:
    """The proven part of a joint's range about rest.

    Attributes:
        joint: Name of the coordinate.
        lower: Proven free down to here [rad or mm].
        upper: Proven free up to here.
        declared: Its declared bounds.
    """

    joint: str
    lower: float
    upper: float
    declared: tuple[float, float]


@dataclass(frozen=True)
class Certificate:
    """The result: findings for people, claims for a checker.

    Attributes:
        findings: Collisions, and whatever was requested but not proven.
        pairs: A verdict and its strength for each pair and set of joints.
        claims: What is proven, with all numbers needed to check it.
        ranges: For each single coordinate, the widest free range about rest.
        epsilon: Distances up to this counted as contact [mm].
        meshes: The exact meshes that were used.
        deflections: Of these meshes [mm].
        mechanism: The mechanism.
        asked: Names of the joints to be proven.
        together: Whether joints were also to be moved two at a time.
        constrained: Names of the joints of loops and couplings.
        queries: Pairs of pieces of surface that were compared.
        work: Units of work spent on pairs and on fits, the same on every machine; see `articad.interference.work`.
        seconds: Time by the clock.
        followed: Pieces of the drivers' ranges, as arrays that a checker reads.
        fits: Declared fits compared with measurements and proofs, in the order of the joints.
        spans: Proven bounds of each coordinate that follows [rad or mm].
        clearances: Smallest distance found of every two parts over the motion, the nearest first: sampled, not proven.
        follows: Tables of the followers of each driver of loops and couplings.
        tolerances: The share of each part and the pairs that are not proven clear, if the claims were to hold within tolerance.
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
    constrained: frozenset[str] = frozenset()
    queries: int = 0
    work: int = 0
    seconds: float = 0.0
    followed: Mapping[str, Any] = field(default_factory=dict)
    fits: tuple[FitRow, ...] = ()
    spans: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    clearances: tuple[Clearance, ...] = ()
    follows: tuple[Following, ...] = ()
    tolerances: Tolerances | None = None

    @property
    def ok(self) -> bool:
        """True if everything that was requested is proven or waived, and nothing collides."""
        return self.findings.ok and not self.findings.of("W_NOT_CERTIFIED")

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.certificate/2`."""
        report = self._report()
        return {**report, "covers": covered(report) if self.ok else "not everything that was requested is proven; see the findings."}

    def _report(self) -> dict[str, Any]:
        return {
            "schema": "articad.certificate/2",
            "ok": self.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "epsilon_mm": self.epsilon,
            "work": self.work,
            "asked": list(self.asked),
            "linkage": sorted(self.constrained),
            "drivers": driver_names(self.mechanism, self.constrained),
            "together": self.together,
            **({} if self.tolerances is None else {"tolerance": self.tolerances.to_json()}),
            "meshes": {name: {"sha256": mesh.digest, "deflection_mm": self.deflections[name]} for name, mesh in self.meshes.items()},
            "mechanism": mechanism_json(self.mechanism),
            "pairs": [pair.to_json() for pair in self.pairs],
            "ranges": [
                {"joint": r.joint, "free": [rounded(r.lower), rounded(r.upper)], "declared": [rounded(bound) for bound in r.declared]}
                for r in self.ranges
            ],
            "claims": [claim.to_json() for claim in self.claims],
            "clearances": [row.to_json() for row in self.clearances],
            "follows": [row.to_json() for row in self.follows],
            **({"fits": [row.to_json() for row in self.fits]} if self.fits else {}),
        }

    def mesh_files(self) -> dict[str, bytes]:
        """Return the meshes that a checker needs, as `<part>.npz`; the same meshes give the same bytes."""
        meshes = {f"{name}.npz": _npz(vertices=mesh.vertices, triangles=mesh.triangles) for name, mesh in self.meshes.items()}
        return {**meshes, f"{PROOF}.npz": _npz(compress=True, **self.proof)}

    def checked(self) -> Certificate:
        """Return this certificate, with the error `E_CERTIFICATE_REFUTED` if it is marked ok and the checker does not accept it."""
        reason = self.refutation() if self.ok else None
        return self if reason is None else self.refuted(reason)

    def refuted(self, reason: str) -> Certificate:
        """Return this certificate with the error `E_CERTIFICATE_REFUTED`."""
        message = f"The certificate checker refutes the proof: {reason}."
        hint = "Report this with the plan: prover and checker disagree, so nothing is certified."
        finding = Finding(code="E_CERTIFICATE_REFUTED", where="certificate", message=message, hint=hint)
        return replace(self, findings=Findings([*self.findings, finding]))

    def refutation(self) -> str | None:
        """Return why the independent checker refutes this certificate, None if it accepts it."""
        meshes = {name: {"vertices": mesh.vertices, "triangles": mesh.triangles} for name, mesh in self.meshes.items()}
        arrays = {name: {key: widened(array) for key, array in of.items()} for name, of in {**meshes, PROOF: self.proof}.items()}
        try:
            Checker(json.loads(json.dumps(self._report())), arrays).check()
        except Refuted as reason:
            return str(reason)
        except Exception as error:  # noqa: BLE001 - a certificate that breaks the checker in any way proves nothing
            return f"it cannot be read: {error!r}"[:500]
        return None

    @property
    def proof(self) -> dict[str, Any]:
        """How the claims were found, as arrays that a checker reads."""
        found: dict[str, Any] = dict(self.followed)
        known: dict[bytes, str] = {}

        def shared(kind: str, array: Any) -> str:
            key = kind.encode() + array.tobytes()
            if key not in known:
                known[key] = f"{kind}.{len(known)}"
                found[known[key]] = array
            return known[key]

        for at, claim in enumerate(self.claims):
            course = claim.course
            assert course is not None
            moved = "" if course.moved is None else shared("moved", course.moved)
            found[f"{at}.uses"] = np.array([moved, *(shared("order", order.astype(np.int32)) for order in course.orders)])
            found[f"{at}.parts_a"], found[f"{at}.parts_b"] = (np.cumsum([0, *sizes]) for sizes in course.sizes)
            found[f"{at}.about"], found[f"{at}.of_a"] = course.about, np.array(course.rows.of_a)
            found[f"{at}.cuts"], found[f"{at}.at"] = _short(course.cuts), course.places
            found[f"{at}.codes"], found[f"{at}.along"] = _short(course.rows.codes), course.rows.along
        return found


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
    tolerance: ToleranceClass | None = None,
    check: bool = True,
) -> Certificate:
    """Prove that parts do not meet while joints move over their whole ranges, and have the proof checked by the independent checker.

    A joint without limits is proven over a full turn, or over the travel after which all its followers have returned. A certificate is
    ok if there is a proof for each joint and for each two that move together, and the checker accepts it.

    Args:
        meshes: By part, in the part's frame; parts without geometry are omitted.
        mechanism: The mechanism.
        joints: Names of the joints to be proven; all that move by default.
        pairs: Whether joints are also moved two at a time.
        epsilon: Distances up to this count as contact [mm].
        budget: Nominal seconds of work: each stands for a fixed amount of it (`PIECES_PER_SECOND`), so that the verdict is the same on
            every machine, whatever its load.
        deflection: Largest distance of meshes from their solids [mm], by part or the same for all.
        waivers: Overlaps that the plan allows.
        fits: By joint name.
        tolerance: Class of ISO 2768-1 (f, m, c or v) within which the claims are to hold; None for parts as they are modelled. See
            `articad.certificates.tolerance`.
        check: Whether to call the checker; callers that add claims call it afterwards (`Certificate.checked`).
    """
    scene = Scene.of(meshes, mechanism.joints, waivers=waivers, deflection=deflection, fits=fits)
    tolerances = None if tolerance is None else Tolerances(scene, tolerance)
    found = _Certifying(scene, mechanism, joints, pairs, epsilon, WorkBudget(budget), tolerances).run()
    return found.checked() if check else found


@dataclass
class _Certifying:
    scene: Scene
    mechanism: Mechanism
    asked: Sequence[str] | None
    together: bool
    epsilon: float
    budget: WorkBudget
    tolerances: Tolerances | None = None
    findings: list[Finding] = field(default_factory=list)
    verdicts: list[PairCheck] = field(default_factory=list)
    claims: list[Claim] = field(default_factory=list)
    ranges: dict[str, Range] = field(default_factory=dict)
    later: list[LinkageProver] = field(default_factory=list)
    left: dict[tuple[str, ...], list[tuple[str, str]]] = field(default_factory=dict)
    _constrained: frozenset[str] = frozenset()
    _floating: frozenset[str] = frozenset()  # names of free joints, which stay at rest
    _ways: dict[tuple[str, ...], DriverTrack | str] = field(default_factory=dict)
    _reasons: dict[str, tuple[str, str]] = field(default_factory=dict)
    _checker: Checker = field(init=False)
    _groups: list[list[str]] = field(init=False)  # drivers of each group

    def run(self) -> Certificate:
        # what moves: the joints of loops and couplings, their drivers, and the groups that do not affect each other
        self._constrained = constrained_joints(self.mechanism)
        self._floating = frozenset(joint.name for joint in self.mechanism.joints if joint.type is JointType.FREE)
        names = driver_names(self.mechanism, self._constrained)
        document = {"mechanism": mechanism_json(self.mechanism), "linkage": sorted(self._constrained), "drivers": names}
        self._checker = Checker(document, {PROOF: {}})
        self._groups = [[name for name in names if name in group] for group in self._checker.groups]
        self.asked = self._with_drivers()
        # every pair of parts that is not one rigid body, along the joints between the two
        solid = [name for name in self.mechanism.parts if name in self.scene.bodies]
        for at, a in enumerate(solid):
            found = routes(self.mechanism.joints, a)
            for b in solid[at + 1 :]:
                if not self.scene.relations.rigid.together(a, b):
                    self._pair(found[b])
                if self.tolerances is not None and is_still(found[b].joints):
                    self._still(found[b], self.tolerances)
        # proofs that ran out of their first share of the budget get what is left
        for prover in self.later:
            self._followed(prover, self._within(prover, prover.prove()))
        self._report_left()
        self._report_unreached()
        if self.tolerances is not None:
            self.findings += self.tolerances.findings(self._sliding())
        # measured, not proven: least clearances, and collisions of three and more joints that the search finds
        motion = MotionSampler(self.scene, self.mechanism)
        clearances = least_clearances(motion, self.asked, together=self.together, quick=True)
        self._look_at_all_at_once(motion, clearances)
        return Certificate(
            Findings(self.findings),
            tuple(self.verdicts),
            tuple(self.claims),
            tuple(self.ranges.values()),
            self.epsilon,
            {name: body.mesh for name, body in self.scene.bodies.items()},
            self.scene.deflections,
            self.mechanism,
            tuple(self._moving()),
            self.together,
            self._constrained,
            self.budget.queries,
            self.budget.work,
            self.budget.elapsed,
            {key: array for way in self._ways.values() if not isinstance(way, str) for key, array in way.arrays().items()},
            spans=self._spans(),
            clearances=clearances,
            follows=what_follows(motion, self.asked),
            tolerances=self.tolerances,
        )

    def _look_at_all_at_once(self, motion: MotionSampler, clearances: Sequence[Clearance]) -> None:
        """Report what the search for least clearances finds to collide: several joints at once, which no proof by twos excludes."""
        known = Checks(Findings(self.findings), (), self.scene.deflection)
        found = collisions_at(motion, clearances, known)
        colliding = [set(finding.parts) for finding in found.findings]
        self.verdicts += [pair for pair in found.pairs if set(pair.parts) in colliding]
        self.findings += found.findings

    def _with_drivers(self) -> Sequence[str] | None:
        """Return the requested joints, and the drivers of those that only follow."""
        if self.asked is None:
            return None
        asked = list(self.asked)
        for group, drivers in zip(self._checker.groups, self._groups, strict=True):
            driving = {self._checker.freedoms[name]["joint"] for name in drivers}
            if {self._checker.freedoms[name]["joint"] for name in group} & set(asked) - driving:
                asked += sorted(driving - set(asked))
        return asked

    def _spans(self) -> dict[str, tuple[float, float]]:
        """Return the bounds of each coordinate that follows a driver, over everything that could be followed."""
        spans: dict[str, tuple[float, float]] = {}
        for way in self._ways.values():
            for name, (low, high) in ({} if isinstance(way, str) else way.spans()).items():
                known = spans.get(name, (low, high))
                spans[name] = min(low, known[0]), max(high, known[1])
        return spans

    def _moving(self) -> list[str]:
        return [joint.name for joint in self.mechanism.joints if freedoms(joint) and self._is_asked(joint.name)]

    def _is_asked(self, name: str) -> bool:
        return self.asked is None or name in self.asked

    def _pair(self, route: Route) -> None:
        moving = [joint.name for joint in route.joints if freedoms(joint)]
        tied = [name for name in moving if name in self._constrained]
        wanted = [name for name in moving if name not in tied and self._is_asked(name)]
        drivers = [name for at in self._groups_of(tied) for name in self._groups[at] if self._is_asked(self._joint_of(name))]
        a, b = route.parts[0], route.parts[-1]
        if self._floating & self._constrained and tied:
            named = ", ".join(sorted(self._floating & self._constrained))
            self._refuse((a, b), tuple(tied), f"the free joint {named} is part of a loop or coupling, which cannot be followed")
            return
        if not self._is_driven((a, b), tied) or (not wanted and not drivers):
            return
        for name in [name for name in wanted if slides_endlessly(self._joint(name))]:
            self._refuse((a, b), (name,), "it slides without limits")
            wanted.remove(name)
        if a in self.scene.broken or b in self.scene.broken:
            over = (*wanted, *map(self._joint_of, drivers))
            self._refuse((a, b), over, "; ".join(self.scene.broken[name] for name in (a, b) if name in self.scene.broken))
            return
        # a pair that a linkage moves is proven along its drivers; any other over all its joints at once, else each alone and every two
        if drivers:
            self._linked(route, tied, wanted, drivers)
            return
        if len(wanted) > 1 and self._prove(route, tuple(wanted), most=WIDE_PAIRS, tentative=True):
            return
        for sets in self._smaller(wanted):
            self._prove(route, sets)

    def _joint_of(self, coordinate: str) -> str:
        return str(self._checker.freedoms[coordinate]["joint"])

    def _groups_of(self, tied: Sequence[str]) -> list[int]:
        """Return the indices of the groups of joints of loops and couplings."""
        return [at for at, group in enumerate(self._checker.groups) if {self._joint_of(name) for name in group} & set(tied)]

    def _is_driven(self, parts: tuple[str, str], tied: Sequence[str]) -> bool:
        """Return whether each group between two parts has a driver, or cannot move; otherwise refuse the pair."""
        for at in self._groups_of(tied):
            group = self._checker.groups[at]
            is_asked = any(self._is_asked(self._joint_of(name)) for name in group)
            if is_asked and not self._groups[at] and not self._checker.is_rigid(group):
                self._refuse(parts, tuple(tied), f"no driver moves {', '.join(group)}, and it is not proven that they cannot move")
                return False
        return True

    def _linked(self, route: Route, tied: Sequence[str], wanted: Sequence[str], drivers: Sequence[str]) -> None:
        """Prove one pair over loops and couplings between them: for all their motions, or along their drivers."""
        parts = route.parts[0], route.parts[-1]
        ways = {name: self._way((name,)) for name in drivers}
        bad = {name: way for name, way in ways.items() if isinstance(way, str)}
        if not any(slides_endlessly(self._joint(name)) for name in tied):
            also = [
                name
                for name in driver_names(self.mechanism, self._constrained)
                if not slides_endlessly(self._joint(self._joint_of(name)))  # no claim covers all of its travel
            ]
            if self._prove(route, (*tied, *wanted), most=TIED_PAIRS, tentative=True, also=also):
                return  # for all motions of the linkage
            both = (
                [two for two in combinations(drivers, 2) if any(set(two) <= set(group) for group in self._groups)] if self.together else []
            )
            is_blocked = bool(bad) or any(isinstance(self._way(two), str) for two in both)
            if is_blocked and self._prove(route, (*tied, *wanted), most=FOLLOWED_PAIRS, tentative=True, also=also):
                return
        for name, reason in bad.items():
            self._refuse(parts, (self._joint_of(name),), f"the linkage cannot be followed: {reason}")
        followed = [name for name in drivers if name not in bad]
        units = [*followed, *wanted]
        if self.together and len(units) > 1 and self._along(route, followed, wanted, tentative=True):
            return
        for name in followed:
            self._along(route, [name], [])
        for name in wanted:
            self._prove(route, (name,))
        for one, other in combinations(units, 2) if self.together else ():
            driving = [name for name in (one, other) if name in followed]
            if driving:
                self._along(route, driving, [name for name in (one, other) if name not in driving])
            else:
                self._prove(route, (one, other))

    def _smaller(self, wanted: Sequence[str]) -> Iterator[tuple[str, ...]]:
        for name in wanted:
            yield (name,)
        if self.together and len(wanted) > 1:
            yield from combinations(wanted, 2)

    def _prove(
        self, route: Route, joints: tuple[str, ...], *, most: int = MOST_PAIRS, tentative: bool = False, also: Sequence[str] = ()
    ) -> bool:
        """Prove one pair over some joints, for any motion of further coordinates; a tentative failure is not reported."""
        parts = route.parts[0], route.parts[-1]
        if self.budget.is_spent:
            if not tentative:
                self.left.setdefault(joints, []).append(parts)
            return False
        prover = Prover(self.scene, route, joints, epsilon=self.epsilon, budget=self.budget)
        proof = prover.prove(most=most, tentative=tentative)
        wide = self._within(prover, proof, most=most, tentative=tentative)
        if proof.is_complete and wide is not None:
            proof = wide
            if also:
                ranges = {f.name: (f.lower, f.upper) for joint in self.mechanism.joints for f in proven_freedoms(joint)}
                more = {name: ranges[name] for name in also}
                proof = replace(proof, claims=tuple(replace(claim, vary={**claim.vary, **more}) for claim in proof.claims))
            self._proven(prover, proof)
            return True
        if tentative:
            return False
        if proof.out_of_budget and not proof.contacts:
            self.left.setdefault(joints, []).append(parts)
        else:
            self._stopped(prover, proof)
        return False

    @overload
    def _within(self, prover: Prover, proof: Proof) -> Proof: ...
    @overload
    def _within(self, prover: Prover, proof: Proof, *, most: int = ..., tentative: bool) -> Proof | None: ...
    def _within(self, prover: Prover, proof: Proof, *, most: int = MOST_PAIRS, tentative: bool = False) -> Proof | None:
        """Return a proof that holds within tolerance, if that is requested and the given one is complete.

        If there is none, that is noted, and the given proof returned; nothing is noted, and None returned, if it was tentative.
        """
        if self.tolerances is None or not proof.is_complete:
            return proof
        wide, fault = self.tolerances.widened(prover, proof, most)
        if fault is not None:
            if tentative:
                return None
            self.tolerances.note(prover.parts, fault)
        return wide

    def _still(self, route: Route, tolerances: Tolerances) -> None:
        """Prove that two parts which do not move against each other are clear within tolerance, unless they touch."""
        parts = route.parts[0], route.parts[-1]
        broken = [self.scene.broken[name] for name in parts if name in self.scene.broken]
        if tolerances.is_ruled(parts):
            return
        if broken:
            self._refuse(parts, tuple(joint.name for joint in route.joints), "; ".join(broken))
            return
        prover = Prover(self.scene, route, (), epsilon=self.epsilon, budget=self.budget)
        proof = prover.keeping(Proof(parts, ()), tolerances.share_of(*parts))
        if proof.is_complete:
            self.claims += proof.claims
            return
        fault = tolerances.closest(prover, proof)
        if fault.gap <= self.scene.tolerated(*parts):
            tolerances.touching(parts)
        else:
            tolerances.note(parts, fault)

    def _proven(self, prover: Prover, proof: Proof, over: tuple[str, ...] = ()) -> None:
        self.claims += proof.claims
        if not over:
            self._note_ranges(proof.joints, proof)
        contact = "contact" if proof.overlap.volume > 0 or proof.shrink.depth else "clear"
        self._verdict(prover.parts, over or proof.joints, Strength.certified(proof.epsilon), proof.overlap, contact)

    def _along(self, route: Route, drivers: Sequence[str], own: Sequence[str], *, tentative: bool = False) -> bool:
        """Prove one pair along drivers, while some joints move independently; all others stay at rest."""
        parts, over = (route.parts[0], route.parts[-1]), (*map(self._joint_of, drivers), *own)
        sets = [tuple(name for name in group if name in drivers) for group in self._groups]
        if self.budget.is_spent:
            if not tentative:
                self.left.setdefault(over, []).append(parts)
            return False
        if tentative and any(len(some) > MOST_TOGETHER for some in sets):
            return False
        # one track for the requested drivers of each group; tracks of different groups are combined as products
        ways = [self._way(some) for some in sets if some]
        reasons = [way for way in ways if isinstance(way, str)]
        if reasons:
            if not tentative:
                self._refuse(parts, over, f"the linkage cannot be followed: {reasons[0]}")
            return False
        found = [way for way in ways if not isinstance(way, str)]
        names = {name for way in found for name in way.names}
        joints = [joint.name for joint in route.joints if joint.name in own or {f.name for f in proven_freedoms(joint)} & names]
        prover = LinkageProver(self.scene, route, joints, found, epsilon=self.epsilon, budget=self.budget)
        found_nominally = prover.prove(most=FIRST_PAIRS, tentative=tentative)
        proof = self._within(prover, found_nominally, tentative=tentative)
        if proof is None or (tentative and not proof.is_complete):
            return False
        if proof.out_of_budget and not proof.contacts:
            self.later.append(prover)
        else:
            self._followed(prover, proof)
        return proof.is_complete

    def _way(self, drivers: tuple[str, ...]) -> DriverTrack | str:
        if drivers not in self._ways:
            try:
                self._ways[drivers] = self._new_way(drivers)
            except (KinematicsError, ValueError, Refuted) as error:
                self._ways[drivers] = str(error)
        return self._ways[drivers]

    def _new_way(self, drivers: tuple[str, ...]) -> DriverTrack | str:
        if len(drivers) == 1:
            names = [driver.name for driver in self.mechanism.drivers]
            if drivers[0] in names:
                ends, self._reasons[drivers[0]] = driven_range(self.mechanism, self._checker, names.index(drivers[0]))
            else:  # the idle twist of a rod
                low, high = self._checker.freedoms[drivers[0]]["range"]
                ends, self._reasons[drivers[0]] = (low, high), ("limit", "limit")
            way = DriverTrack(self._checker, drivers, (ends,))
            found = way.whole
            self.budget.spend(way.work)
            return way if found else "near rest, no tube encloses the followers of the driver"
        ways = [self._way((name,)) for name in drivers]
        bad = [way for way in ways if isinstance(way, str)]
        if bad:
            return bad[0]
        expected = math.prod(way.count for way in ways if not isinstance(way, str))
        most = MOST_EXPECTED if len(drivers) == 2 else MOST_EXPECTED // 4  # each box of three takes five times as long
        if expected > most:
            return f"{' and '.join(drivers)} together would take about {expected} boxes, more than {most}"
        way = DriverTrack(self._checker, drivers, tuple(way.whole.ends[0] for way in ways if not isinstance(way, str) and way.whole))
        found = way.whole
        self.budget.spend(way.work)
        return way if found else f"{' and '.join(drivers)} do not reach all of their ranges together, or no tube encloses the followers"

    def _followed(self, prover: LinkageProver, proof: Proof) -> None:
        parts = prover.parts
        own = [joint for joint in prover.joints if joint not in self._constrained]
        over = (*map(self._joint_of, prover.drivers), *own)
        if proof.is_complete:
            self._proven(prover, proof, over)
        elif proof.out_of_budget and not proof.contacts:
            self.left.setdefault(over, []).append(parts)
            return
        else:
            # measure the poses where the proof stopped: a collision, or contact that the proof cannot settle
            worst, pose = prover.worst(proof)
            check, found = judge(
                self.scene, parts, worst, over=over, pose=pose, baseline=proof.overlap.volume, strength=Strength.sampled(prover.looked)
            )
            self.verdicts.append(check)
            self.findings += found
            if not any(finding.code == "E_MOTION_COLLISION" for finding in found) and check.strength.kind != "waived":
                self.findings.append(_unproven(parts, over, worst, check.allowed, prover.looked))
        if not prover.is_single:
            return
        # the range of a single driver is what is proven for all pairs so far
        (name,), (way,) = prover.drivers, prover.ways
        known = self.ranges.get(name, Range(name, *way.bounds[0], way.bounds[0]))
        if proof.lower is not None and proof.upper is not None:
            self.ranges[name] = replace(known, lower=max(known.lower, proof.lower), upper=min(known.upper, proof.upper))
        else:
            free = prover.free_range(proof.shrink)
            self.ranges[name] = replace(known, lower=max(known.lower, free[0]), upper=min(known.upper, free[1]))

    def _stopped(self, prover: Prover, proof: Proof) -> None:
        """Report what is at the place where a proof stopped: a collision, or contact that can only be sampled."""
        parts, joints, looks = prover.parts, proof.joints, Looks(prover, proof)
        worst, pose = looks.worst()
        check, found = judge(
            self.scene, parts, worst, over=joints, pose=pose, baseline=proof.overlap.volume, strength=Strength.sampled(looks.count)
        )
        collides = [finding for finding in found if finding.code == "E_MOTION_COLLISION"]
        self.verdicts.append(check)
        if collides:
            self.findings.append(self._collision(parts, joints, proof, looks, collides[0]))
            self._note_ranges(joints, proof)
            if proof.width() > 0:  # for a single coordinate, the part before the collision is proven
                self.claims += proof.claims
        else:
            self.findings += found
            if check.strength.kind != "waived":
                self.findings.append(_unproven(parts, joints, worst, check.allowed, looks.count))

    def _collision(self, parts: tuple[str, str], joints: tuple[str, ...], proof: Proof, looks: Looks, seen: Finding) -> Finding:
        if len(joints) != 1 or proof.lower is None or proof.upper is None or not proof.contacts:
            return replace(seen, message=f"{seen.message} This occurs while {' and '.join(joints)} move.")
        name, first, proven = looks.entry(self.scene.tolerated(*parts), seen.pose)
        unit, scale = (" mm", 1.0) if name in self._sliding() else ("°", 180 / np.pi)
        return replace(
            seen,
            where=f"joints.{joints[0]}",
            message=f"{parts[0]} and {parts[1]} collide from {name} = {first * scale:.7g}{unit}; up to {proven * scale:.7g}{unit} they are proven "
            f"apart (an interval of {abs(first - proven) * scale:.2g}{unit}). Beyond that, they overlap by up to {seen.value:.3g} mm.",
            hint=f"Set the limits of {joints[0]} to [{_up(proof.lower * scale):g}, {-_up(-proof.upper * scale):g}]{unit}, or add clearance.",
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
                hint="Repair the named cause; a sampled sweep can still check them.",
            )
        )

    def _report_unreached(self) -> None:
        """Report where the declared range of a driver is longer than the range over which its linkage can be followed."""
        coordinates = {driver.name: driver for driver in self.mechanism.drivers}
        for drivers, way in self._ways.items():
            if isinstance(way, str) or len(drivers) > 1:
                continue
            name, rest = drivers[0], self._checker.rest[drivers[0]]
            driver = coordinates.get(name)
            limits = way.bounds[0] if driver is None else (driver.lower, driver.upper)
            joint, unit = self._joint_of(name), "rad" if driver is None else driver.unit
            both = zip((-1, 1), limits, way.bounds[0], self._reasons[name], strict=True)
            for sign, declared, bound, reason in both:
                end = way.reached(sign)
                endless = bound if reason in ("endless", "not followed further") else rest + sign * math.pi
                wanted = declared if math.isfinite(declared) else endless
                if abs(end - wanted) > _END_SLACK:
                    mark, scale = (" mm", 1.0) if unit == "mm" else ("°", 180 / math.pi)
                    side, inside = ("upper", -_up(-end * scale)) if sign > 0 else ("lower", _up(end * scale))
                    self.findings.append(
                        Finding(
                            code="E_NOT_CHECKED",
                            where=f"joints.{joint}",
                            message=f"{name} is proven up to {end * scale:.6g}{mark} only, not to {wanted * scale:.6g}{mark}: {reason}.",
                            hint=f"Set the {side} limit of {joint} to {inside:g}{mark}: the linkage can be followed as far.",
                            value=end,
                            limit=wanted,
                            unit=unit,
                        )
                    )

    def _ended(self) -> str:
        """Return the sentence that says why work ended: the search for a pair ends after a number of pieces, before the budget is spent."""
        return self.budget.ended() if self.budget.is_spent else f"The search stopped after {MOST_PAIRS} pieces of a pair."

    def _report_left(self) -> None:
        for joints, pairs in self.left.items():
            for parts in pairs:
                self._verdict(
                    parts,
                    joints,
                    Strength.not_checked(self.budget.reason if self.budget.is_spent else "the search for a pair stopped"),
                    NOTHING,
                    "unknown",
                )
            names = ", ".join(f"{a}/{b}" for a, b in pairs)
            self.findings.append(
                Finding(
                    code="E_NOT_CHECKED",
                    where=f"joints.{joints[0]}",
                    parts=tuple(dict.fromkeys(name for pair in pairs for name in pair)),
                    message=f"{self._ended()} These pairs are not proven apart over {', '.join(joints)}: {names}.",
                    hint="Raise the budget, or widen the gap between them: the work grows as 1/gap.",
                    value=self.budget.seconds,
                    unit="s",
                )
            )


class Looks:
    """Samples poses beyond the one where a proof stopped, with exact booleans."""

    def __init__(self, prover: Prover, proof: Proof) -> None:
        self.prover, self.proof, self.chain = prover, proof, prover.chain
        self.bodies = prover.body_a, prover.body_b
        self.count = 0

    def worst(self) -> tuple[Overlap, dict[str, float] | None]:
        """Return the deepest overlap found, and its pose."""
        worst, where = self.proof.overlap, None
        for point in self._points():
            self.count += 1
            self.prover.budget.spend(self.prover.look_price)
            found = overlap(*self.bodies, SE3.from_matrix(self.chain.matrix(point)))
            if found.depth > worst.depth:
                worst, where = found, self.prover.pose(point)
        return worst, where

    def _points(self) -> Iterator[tuple[float, ...]]:
        """Yield poses from where a proof stopped, or from rest if it could not begin."""
        for contact in self.proof.contacts:
            start = [contact[freedom.name] for freedom in self.chain.freedoms]
            yield from beyond(self.chain, self.prover.speeds, start, self.prover.allowed)

    def entry(self, allowed: float, pose: Mapping[str, float] | None) -> tuple[str, float, float]:
        """Return the coordinate, the value where the meshes first meet, and the end of the proven range before it.

        If contact is allowed, the meshes meet where they are deeper than that.
        """
        (freedom,) = self.chain.freedoms
        hit = freedom.rest if pose is None else pose[freedom.name]
        stopped = [contact[freedom.name] for contact in self.proof.contacts]
        proven = min((v for v in stopped if (v - freedom.rest) * (hit - freedom.rest) >= 0), key=lambda v: abs(v - freedom.rest))
        met = hit
        other = whole_surface(self.bodies[1].mesh)
        for surface in self._strict():
            touch = cover_line(
                partial(self._distance, surface, other),
                (min(proven, hit), max(proven, hit)),
                proven,
                reach=float(self.prover.speeds[0]),
                epsilon=_ENTRY_MM,
                budget=WorkBudget(60.0),
                most=2000,
            )
            met = touch.upper if hit >= proven else touch.lower
        if self.proof.shrink.depth:
            met = min(met, self._deeper_than(allowed, proven, hit), key=lambda value: abs(value - proven))
        return freedom.name, met, proven

    def _distance(self, a: Surface, b: Surface, values: Values) -> float:
        return surface_distance(a, b, self.chain.matrix(values))

    def _strict(self) -> list[Surface]:
        """Return the parts of the first surface that must not even touch, if there are any."""
        whole, within = whole_surface(self.bodies[0].mesh), self.proof.shrink.within
        if not self.proof.shrink.depth:
            return [whole]
        if not math.isfinite(within) or self.prover.axis is None:
            return []
        outside = (self.prover.axis.radii(whole.corners) > within).all(axis=1)
        return [Surface(whole.corners[outside])] if outside.any() else []

    def _deeper_than(self, allowed: float, free: float, hit: float) -> float:
        for _ in range(30):
            middle = (free + hit) / 2
            self.prover.budget.spend(self.prover.look_price)
            deep = overlap(*self.bodies, SE3.from_matrix(self.chain.matrix((middle,)))).depth > allowed
            free, hit = (free, middle) if deep else (middle, hit)
        return hit


def constrained_joints(mechanism: Mechanism) -> frozenset[str]:
    """Return the joints that cannot move independently: those of loops, and those that couplings connect."""
    tied: set[str] = set()
    for joint in mechanism.loop_joints:
        tied.update({joint.name, *(other.name for other in mechanism.tree.joints_between(joint.parent, joint.child))})
    for coupling in mechanism.couplings:
        tied.update({coupling.a.split(".")[0], coupling.b.split(".")[0]})
    return frozenset(tied)


def driver_names(mechanism: Mechanism, constrained: frozenset[str]) -> list[str]:
    """Return the coordinates that drive loops and couplings, and the idle twists of rods between two balls."""
    free = {joint.name for joint in mechanism.joints if joint.type is JointType.FREE}
    names = [driver.name for driver in mechanism.drivers if driver.joint in constrained - free]
    balls = [joint for joint in mechanism.joints if joint.name in constrained and joint.type is JointType.BALL]
    twists = {proven_freedoms(joint)[-1].name for joint in balls}
    while balls:
        checker = Checker({"mechanism": mechanism_json(mechanism), "linkage": sorted(constrained), "drivers": names}, {PROOF: {}})
        idle = [name for group in checker.groups for name in _idle(checker, group) if name in twists]
        if not idle:
            break
        names.append(idle[0])
    return names


def _idle(checker: Checker, group: Sequence[str]) -> list[str]:
    """Return the coordinates of a motion at rest in which the drivers of a group stand still, the one that turns most first."""
    driving = [name for name in group if name in checker.drivers]
    names = [name for name in group if name not in checker.drivers]
    if not driving or not names:
        return []
    rest = np.array([checker.rest[name] for name in names])
    _, J, _ = checker.closure(names, rest, rest)
    _, sizes, ways = np.linalg.svd(J)
    share = np.abs(ways[(sizes > IDLE).sum() :]).max(axis=0, initial=0.0)
    return [names[at] for at in np.argsort(-share, kind="stable") if share[at] > IDLE_SHARE]


def mechanism_json(mechanism: Mechanism) -> dict[str, Any]:
    """Return parts, frames and joints as numbers: all that a checker needs to place two parts.

    A joint is `T_parent_child = parent_frame · Π exp((slide, turn)·q) · child_frame⁻¹`, the product over its freedoms in order; the
    mate is in `child_frame`. A ball turns about x, y and z, within its cone. A free joint stays at rest, which is in `parent_frame`.
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
                "parent_frame": _stand(joint).matrix.tolist(),
                "child_frame": (joint.T_child_connector @ flip(joint.mate)).matrix.tolist(),
                "cone": proven_freedoms(joint)[0].upper if joint.type is JointType.BALL else None,
                "loop": joint.name in loops,
                "freedoms": _freedoms_json(joint),
            }
            for joint in mechanism.joints
        ],
        "couplings": [{"a": c.a, "b": c.b, "ratio": c.ratio, "offset": c.offset} for c in mechanism.couplings],
    }


def _stand(joint: Joint) -> SE3:
    """Return the frame in which a joint's freedoms are measured; for a free joint, which has none to be proven, its rest pose."""
    return joint.T_parent_connector @ joint.motion(joint.rest) if joint.type is JointType.FREE else joint.T_parent_connector


def _freedoms_json(joint: Joint) -> list[dict[str, Any]]:
    if joint.type is JointType.FREE:
        return []
    open_ends = [(None if math.isinf(c.lower) else c.lower, None if math.isinf(c.upper) else c.upper) for c in joint.columns]
    found = proven_freedoms(joint)
    bounds = [[f.lower, f.upper] for f in found] if joint.type is JointType.BALL else [list(ends) for ends in open_ends]
    return [
        {
            "name": freedom.name,
            "joint": joint.name,
            "range": [freedom.lower, freedom.upper],
            "limits": limits,
            "rest": freedom.rest,
            "slide": list(slide),
            "turn": list(turn),
        }
        for freedom, limits, (turn, slide) in zip(found, bounds, joint.type.factors(joint.lead), strict=True)
    ]


def _unproven(parts: tuple[str, str], joints: tuple[str, ...], worst: Overlap, allowed: float, count: int) -> Finding:
    return Finding(
        code="W_NOT_CERTIFIED",
        where=f"joints.{joints[0]}",
        parts=parts,
        message=f"{parts[0]} and {parts[1]} are too close over {' and '.join(joints)} to prove that they stay apart: at {count} poses they overlap "
        f"{worst.depth:.3g} mm at most (allowed {allowed:.3g} mm).",
        hint="Add clearance to allow a proof of the motion.",
        value=worst.depth,
        limit=allowed,
        unit="mm",
    )


def _up(value: float) -> float:
    """Round up to a thousandth, so that proposed limits lie within what is proven."""
    return math.ceil(round(value * 1000, 6)) / 1000 + 0.0


def _npz(*, compress: bool = False, **arrays: Any) -> bytes:
    buffer = io.BytesIO()
    (np.savez_compressed if compress else np.savez)(buffer, **arrays)
    return buffer.getvalue()


def _short(numbers: Any) -> Any:
    """Return whole numbers in the smallest type."""
    return numbers.astype(np.min_scalar_type(min(int(numbers.min()), -int(numbers.max()) - 1)))  # signed, since cuts are negative
