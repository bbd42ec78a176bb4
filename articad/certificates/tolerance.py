"""Claims that hold within tolerance: for all parts whose surfaces lie anywhere within their tolerance of where they nominally are.

A part's share t is the deviation that the general tolerance (ISO 2768-1) permits for its largest extent along the axes of its own frame.
Each point of its surface may lie up to t from its nominal place, in any direction; the frames of its joints are the datums, and exact.
So two parts stay clear within tolerance if their nominal surfaces stay farther apart than the sum of their shares, over the whole range:
that is an ordinary claim with a larger distance.

Other pairs cannot be proven so, and are listed with what is claimed instead (`ToleranceRow`): the limits of declared fits rule the pairs whose
surfaces make them; pairs that touch by design stay no deeper in each other than their shares more than nominally; waived pairs.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

import numpy as np

from articad.certificates.proof import Proof, Prover
from articad.errors import PlanError
from articad.findings import Finding
from articad.geometry.mesh import TriMesh
from articad.interference.freedoms import Freedom, freedoms, scattered
from articad.interference.relations import FitLike
from articad.interference.scene import Scene
from articad.interference.surface import surface_distance, whole_surface
from articad.interference.work import DISTANCE
from articad.kinematics.joints import Joint, JointType
from articad.plan.fit_names import PRINTED_MM
from articad.plan.iso286 import fit_limits
from articad.plan.iso2768 import LARGEST_MM, ToleranceClass, deviation, finer_class
from articad.plan.resolve import Fit
from articad.realisation.bores import bore_and_pin

LOOKS = 64  # poses over the range of a refuted pair, from the closest of which a search starts
ROUNDS = 14  # of that search; each halves its step
ROOM = 0.02  # of the shares: added to proposed gaps, because the closest pose is sampled

By = Literal["fit", "contact", "waiver"]


@dataclass(frozen=True)
class ToleranceRow:
    """A pair that is not proven clear within tolerance, and what holds of it instead.

    Attributes:
        parts: The two parts.
        by: "fit": declared fits, whose limits rule it. "contact": it touches by design. "waiver": the plan allows an overlap.
        joints: The joints that declare the fits.
        fits: Their names or gaps, such as "25 H7/g6" or "at least 0.1 mm".
        least: Least play of these fits [mm]: half the least difference of the diameters; negative where the parts may be pressed.
        depth: The depth that the surfaces cannot exceed in each other within tolerance [mm]; None for parts that do not move against
            each other, of which nothing is claimed.
    """

    parts: tuple[str, str]
    by: By
    joints: tuple[str, ...] = ()
    fits: tuple[str, ...] = ()
    least: float | None = None
    depth: float | None = None

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a certificate."""
        fit = {"joints": list(self.joints), "fits": list(self.fits), "least_mm": self.least} if self.by == "fit" else {}
        return {"parts": list(self.parts), "by": self.by, **fit, **({} if self.depth is None else {"depth_mm": self.depth})}


@dataclass(frozen=True)
class Closest:
    """Where two parts come closer than their shares.

    Attributes:
        over: Names of the joints that moved.
        gap: Distance of the nominal surfaces [mm]; infinity if none was measured.
        pose: Values of what moved there [rad, mm].
        out_of_budget: True if the proof ended without a result.
    """

    over: tuple[str, ...]
    gap: float = math.inf
    pose: Mapping[str, float] = field(default_factory=dict)
    out_of_budget: bool = False


class Tolerances:
    """The shares of all parts, and what is known of pairs that are not proven clear within tolerance.

    Args:
        scene: Bodies and relations.
        letter: The class of ISO 2768-1: f, m, c or v.

    Attributes:
        shares: By part [mm]; parts for whose size the class has no deviation are left out.
        rows: Pairs that are not proven clear, and what holds instead.
    """

    def __init__(self, scene: Scene, letter: ToleranceClass) -> None:
        self.scene, self.letter = scene, letter
        self.sizes = {name: nominal_size(mesh) for name, mesh in scene.meshes.items() if len(mesh.vertices)}
        found = {name: deviation(letter, size) for name, size in self.sizes.items()}
        self.shares = {name: share for name, share in found.items() if share is not None}
        self.rows: dict[frozenset[str], ToleranceRow] = {}
        self._faults: dict[frozenset[str], Closest] = {}
        self._locked: list[Finding] = []
        self._ruled: set[frozenset[str]] = set()

    def share_of(self, a: str, b: str) -> float:
        """Return the sum of the shares of two parts [mm]."""
        return self.shares[a] + self.shares[b]

    def is_ruled(self, parts: tuple[str, str]) -> bool:
        """Return whether a waiver, fits of all joints between two parts, or a missing share rule what is claimed of them; note which."""
        pair = frozenset(parts)
        if pair not in self._ruled:
            self._ruled.add(pair)
            if self.scene.relations.waiver(*parts) is not None:
                self.rows[pair] = ToleranceRow(parts, "waiver")
            elif (row := self._by_fits(parts)) is not None:
                self.rows[pair] = row
        row = self.rows.get(pair)
        return (row is not None and row.by != "contact") or not {*parts} <= {*self.shares}

    def touching(self, parts: tuple[str, str], depth: float | None = None) -> None:
        """Note that two parts touch by design, nominally no deeper than `depth` [mm]; None if no claim says how deep."""
        known = self.rows.get(frozenset(parts))
        most = None if depth is None else max(depth + self.share_of(*parts), (known.depth if known else None) or 0.0)
        self.rows[frozenset(parts)] = ToleranceRow(parts, "contact", depth=most)

    def widened(self, prover: Prover, proof: Proof, most: int) -> tuple[Proof, Closest | None]:
        """Return a complete proof that holds within tolerance if there is one, else the given one and where the parts come too close."""
        if self.is_ruled(prover.parts):
            return proof, None
        if proof.shrink.depth:
            self.touching(prover.parts, proof.shrink.depth)
            return proof, None
        wide = prover.keeping(proof, self.share_of(*prover.parts), most)
        return (wide, None) if wide.is_complete else (proof, self.closest(prover, wide))

    def closest(self, prover: Prover, stopped: Proof) -> Closest:
        """Search for the pose at which two parts are closest, from where a proof stopped and from poses over the range."""
        moving = prover.moving
        starts = [tuple(contact[f.name] for f in moving) for contact in stopped.contacts]
        if not starts and stopped.out_of_budget:
            return Closest(stopped.joints, out_of_budget=True)
        starts += [tuple(f.rest for f in moving), *(scattered(moving, LOOKS) if moving else [])]
        gap, point = min(((_gap(prover, moving, start), start) for start in starts), key=lambda one: one[0])
        steps = [(f.upper - f.lower) / LOOKS for f in moving]
        for _ in range(ROUNDS if moving else 0):
            around = [
                (*point[:at], min(max(point[at] + side * step, f.lower), f.upper), *point[at + 1 :])
                for at, (f, step) in enumerate(zip(moving, steps, strict=True))
                for side in (-1, 1)
            ]
            less, near = min(((_gap(prover, moving, each), each) for each in around), key=lambda one: one[0])
            gap, point, steps = (less, near, steps) if less < gap else (gap, point, [step / 2 for step in steps])
        pose = prover.told(point) if math.isfinite(gap) else {}
        return Closest(stopped.joints, gap, pose)

    def note(self, parts: tuple[str, str], fault: Closest) -> None:
        """Keep where two parts come closest, of all proofs of this pair."""
        known = self._faults.get(frozenset(parts))
        if known is None or fault.gap < known.gap:
            self._faults[frozenset(parts)] = fault

    def findings(self, sliding: set[str]) -> list[Finding]:
        """Return a finding for each pair that is not clear within tolerance, and for each part without a tolerance."""
        order = {name: at for at, name in enumerate(self.scene.meshes)}
        pairs = [(sorted(pair, key=order.__getitem__), fault) for pair, fault in self._faults.items()]
        found = [self._refuted((a, b), fault, sliding) for (a, b), fault in pairs]
        return [*self._unknown(), *self._locked, *found]

    def to_json(self) -> dict[str, Any]:
        """Return what a certificate states about tolerances."""
        rows = [row.to_json() for row in self.rows.values()]
        return {"class": self.letter, "shares_mm": dict(self.shares), "rows": rows}

    def _by_fits(self, parts: tuple[str, str]) -> ToleranceRow | None:
        """Return the row of a pair whose surfaces declared fits rule; None if there is no fit, or another joint connects the two."""
        declared = self._declared.get(frozenset(parts), [])
        if not declared or {joint.name for joint in self.scene.relations.between(*parts)} - {joint.name for joint, _ in declared}:
            return None
        self._locked += [_locked(joint, fit, parts) for joint, fit in declared if least_play(fit) < 0 and freedoms(joint)]
        return ToleranceRow(
            parts,
            "fit",
            tuple(joint.name for joint, _ in declared),
            tuple(_named(fit) for _, fit in declared),
            min(least_play(fit) for _, fit in declared),
        )

    @cached_property
    def _declared(self) -> dict[frozenset[str], list[tuple[Joint, FitLike]]]:
        """The fits with a lower limit of their gap, by the pair that has the surfaces: of bore and pin where these are found."""
        found: dict[frozenset[str], list[tuple[Joint, FitLike]]] = {}
        for joint in self.scene.relations.joints:
            fit = self.scene.fits.get(joint.name)
            if fit is None or {joint.parent, joint.child} & {*self.scene.broken} or not {joint.parent, joint.child} <= {*self.scene.bodies}:
                continue
            pair = bore_and_pin(self.scene, joint)
            if isinstance(fit, Fit) and fit.name is not None and fit.gap_max is None:
                if pair is None:
                    continue  # a name without a diameter: reported where fits are checked
                with contextlib.suppress(PlanError):  # likewise
                    fit = fit.sized(round(2 * pair[0].face.radius, 1))
            if fit.gap_min is not None or fit.contact is not None:
                names = (joint.parent, joint.child) if pair is None else (pair[0].part, pair[1].part)
                found.setdefault(frozenset(names), []).append((joint, fit))
        return found

    def _refuted(self, parts: tuple[str, str], fault: Closest, sliding: set[str]) -> Finding:
        a, b = parts
        needed = self.share_of(a, b) + self.scene.deflection_of(a, b)
        shares = " and ".join(f"{self.shares[name]:g} mm ({name}, {self.sizes[name]:.4g} mm)" for name in parts)
        where = self.scene.relations.where(a, b)
        if fault.out_of_budget or fault.gap > needed + 1e-6:
            return Finding(
                code="E_NOT_CHECKED",
                where=where,
                parts=parts,
                message=f"{a} and {b} are not proven clear within tolerance: the search stopped.",
                hint="Raise the budget, or widen the gap between them: the work grows as 1/gap.",
            )
        mesh = f", and the meshes may be off by {self.scene.deflection_of(a, b):.3g} mm" if self.scene.deflection_of(a, b) else ""
        gap = math.ceil((needed + ROOM * self.share_of(a, b)) * 1000) / 1000
        finer = finer_class(self.letter, (self.sizes[a], self.sizes[b]), fault.gap - self.scene.deflection_of(a, b))
        joints = [joint.name for joint in self.scene.relations.between(a, b)]
        hint = [f"Widen the gap between them to {gap:g} mm, {gap - fault.gap:.3g} mm more"]
        hint += [f"make both to ISO 2768-{finer}"] if finer else []
        hint += [f"declare the fit of joint {joints[0]}, if their surfaces are made to one"] if joints else []
        pose = ", ".join(_said(name, value, name in sliding) for name, value in fault.pose.items()) or "rest"
        return Finding(
            code="E_TOLERANCE",
            where=where,
            parts=parts,
            message=f"{a} and {b} are {fault.gap:.4g} mm apart at {pose}; within ISO 2768-{self.letter} they may meet there: their surfaces may "
            f"be off by {shares}, together {self.share_of(a, b):g} mm{mesh}.",
            hint=f"{', or '.join(hint)}.",
            value=fault.gap,
            limit=needed,
            unit="mm",
            pose=fault.pose or None,
        )

    def _unknown(self) -> list[Finding]:
        return [
            Finding(
                code="E_NOT_CHECKED",
                where=f"parts.{name}",
                parts=(name,),
                message=f"ISO 2768-{self.letter} has no deviation for the {size:.4g} mm of {name}, so nothing is proven of it within tolerance.",
                hint=f"Choose another class, or divide the part: class m covers up to {LARGEST_MM:g} mm.",
                value=size,
                unit="mm",
            )
            for name, size in self.sizes.items()
            if name not in self.shares
        ]


def nominal_size(mesh: TriMesh) -> float:
    """Return the size that decides on the general tolerance of a part: its largest extent along the axes of its own frame, to 1e-6 mm."""
    return round(float(np.ptp(mesh.vertices, axis=0).max()), 6)


def least_play(fit: FitLike) -> float:
    """Return the least play that a fit permits [mm]: half the least difference of the diameters, negative where the parts may be pressed."""
    if isinstance(fit, Fit) and fit.name is not None and fit.name not in PRINTED_MM and fit.nominal is not None:
        return fit_limits(fit.name, fit.nominal).lower / 2
    return fit.gap_min or 0.0


def _gap(prover: Prover, moving: Sequence[Freedom], point: Sequence[float]) -> float:
    """Return the distance of two parts at values of what moves [mm]; infinity where the mechanism cannot be."""
    prover.budget.spend(DISTANCE)
    values = prover.placed({f.name: value for f, value in zip(moving, point, strict=True)})
    if values is None:
        return math.inf
    a, b = (whole_surface(body.mesh) for body in (prover.body_a, prover.body_b))
    return surface_distance(a, b, prover.chain.matrix(values))


def _named(fit: FitLike) -> str:
    if isinstance(fit, Fit) and fit.name is not None:
        return fit.name if fit.nominal is None or "/" not in fit.name or fit.name[0].isdigit() else f"{fit.nominal:g} {fit.name}"
    least = "" if fit.gap_min is None else f"at least {fit.gap_min:g} mm"
    most = "" if fit.gap_max is None else f"at most {fit.gap_max:g} mm"
    return " and ".join(part for part in (least, most) if part) or f"contact {fit.contact}"


def _locked(joint: Joint, fit: FitLike, parts: tuple[str, str]) -> Finding:
    least = least_play(fit)
    return Finding(
        code="E_TOLERANCE",
        where=f"joints.{joint.name}.fit",
        parts=parts,
        message=f"{parts[0]} and {parts[1]}: the limits of {_named(fit)} permit an interference of {-2 * least:.4g} mm in diameter, which "
        f"locks joint {joint.name}, at every pose.",
        hint="Declare a fit with clearance, such as H7/g6.",
        value=least,
        limit=0.0,
        unit="mm",
    )


def _said(name: str, value: float, is_slide: bool) -> str:
    return f"{name} = {value:.4g} mm" if is_slide else f"{name} = {math.degrees(value):.4g}°"


def is_still(joints: Sequence[Joint]) -> bool:
    """Return whether no joint of a path moves in a certificate: fixed joints, and free ones, which stay at rest."""
    return all(joint.type is JointType.FREE or not freedoms(joint) for joint in joints)
