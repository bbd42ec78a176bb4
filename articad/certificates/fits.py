"""Fits: what a joint declares about the gap between its two parts, compared with measurements.

The lower bound applies to the whole motion of the joint. It is proven if possible, and sampled otherwise; each row says which. The upper
bound is compared with the play at rest (`articad.interference.gauge`). Meshes may deviate by their deflection in both directions, so a
fit counts as broken only beyond that. Definitions: `docs/reference/plan.md`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal

import numpy as np

from articad.certificates.claims import Claim
from articad.certificates.proof import NO_SHRINK, Prover, Shrink
from articad.errors import PlanError
from articad.findings import Finding, Findings
from articad.interference.freedoms import Freedom, freedoms, scattered, travels
from articad.interference.gauge import STOP_MM, Gauge
from articad.interference.motion import Route
from articad.interference.overlap import NOTHING
from articad.interference.relations import FitLike
from articad.interference.report import Strength, rounded
from articad.interference.sampled_ranges import sampled_piece
from articad.interference.scene import Scene
from articad.interference.surface import Surface
from articad.interference.sweep import MotionSampler
from articad.interference.work import WorkBudget
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.resolve import Fit
from articad.realisation.bores import Bore, bore_of

__all__ = [
    "CONTACT_MM",
    "PROOF_SECONDS",
    "FitCheck",
    "FitReport",
    "FitVerdict",
    "Gauge",
    "certified_fits",
    "check_fits",
    "followed",
]

STEPS = 24  # poses per coordinate at which the gap is measured in motion
CONTACT_MM = 0.02  # surfaces this close touch, in addition to the deflection of their meshes
DIAMETER_MM = 1e-4  # rounding of diameters that scripts compute
NOMINAL_MM, NOMINAL_SHARE = 0.5, 0.02  # by how much a bore may differ from the nominal diameter of its fit: c11 at 6 mm, a11 at 500 mm
EPSILON_MM = 1e-4  # a gap that exceeds the value to prove by no more than this counts as contact in the search
PROOF_SECONDS = 1.2  # nominal, for the proof of each fit
_FOLLOWED = 61  # poses of each driver's range, or of each of its turns: steps of 6°, its half included

FitVerdict = Literal["ok", "tight", "loose", "contact", "apart", "not_checked"]
Span = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class FitCheck:
    """One row: a declared fit and its measurements.

    Attributes:
        joint: Its name.
        parts: Its two parts.
        declared: The fit.
        rest: Gap at rest [mm]; negative is the depth of an overlap. None if it could not be measured.
        least: Smallest gap that was measured over the motion [mm].
        at: Pose of the smallest gap [rad, mm]; None at rest.
        verdict: "ok"; "tight" or "loose"; "contact" where it is forbidden; "apart" where contact is required; or "not_checked".
        play: Play at rest, wherever the pin is in its hole [mm]; None if nothing stops the child, or if it was not requested.
        tolerance: Largest deviation of both meshes together from their solids [mm].
        strength: How strong the verdict on the lower bound is over the motion.
        bore: The diameters of bore and pin, where the play was measured on them: for named fits, and where meshes are too coarse.
    """

    joint: str
    parts: tuple[str, str]
    declared: FitLike
    rest: float | None
    least: float | None
    at: Mapping[str, float] | None
    verdict: FitVerdict
    play: float | None = None
    tolerance: float = 0.0
    strength: Strength = field(default_factory=partial(Strength.sampled, 1))
    bore: Bore | None = None

    def to_json(self) -> dict[str, Any]:
        """Return a row of the table."""
        fit = self.declared
        return {
            "joint": self.joint,
            "parts": list(self.parts),
            "declared": {"gap_mm": [fit.gap_min, fit.gap_max], "within_mm": fit.within, "contact": fit.contact, **_name_of(fit)},
            "rest_mm": rounded(self.rest),
            "least_mm": rounded(self.least),
            "at": None if self.at is None else {name: rounded(value) for name, value in self.at.items()},
            "play_mm": rounded(self.play),
            "tolerance_mm": rounded(self.tolerance),
            "strength": self.strength.to_json(),
            "verdict": self.verdict,
            **({} if self.bore is None else {"bore_mm": rounded(self.bore.bore), "pin_mm": rounded(self.bore.pin)}),
        }


@dataclass(frozen=True)
class FitReport:
    """All fits of an assembly.

    Attributes:
        findings: One per broken fit.
        rows: One per declared fit, in order.
        claims: Proven claims about them, for a certificate.
        queries: Pairs of pieces of surface that were compared.
        work: Units of work spent; see `articad.interference.work`.
    """

    findings: Findings
    rows: tuple[FitCheck, ...]
    claims: tuple[Claim, ...] = ()
    queries: int = 0
    work: int = 0

    @property
    def ok(self) -> bool:
        """True if every fit is kept."""
        return self.findings.ok

    def to_json(self) -> dict[str, Any]:
        """Return the table with its findings."""
        return {
            "schema": "articad.fits/1",
            "ok": self.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "rows": [row.to_json() for row in self.rows],
        }


def check_fits(
    scene: Scene,
    reached: Span | Callable[[], Span] | None = None,
    *,
    proven: Span | None = None,
    joints: Sequence[str] | None = None,
    seconds: float = PROOF_SECONDS,
) -> FitReport:
    """Check every declared fit of a scene, at rest and over the motion of its joint.

    Args:
        scene: Bodies and relations.
        reached: Ranges of coordinates that follow others, by name [rad, mm], or a function that finds them: a joint of a linkage need
            not reach its own limits.
        proven: The same, if it is proven that they go no farther; used before `reached`.
        joints: Names of the joints to check; all by default.
        seconds: Nominal seconds of work for each fit; see `articad.interference.work`.
    """
    rows: list[FitCheck] = []
    findings: list[Finding] = []
    claims: list[Claim] = []
    budgets: list[WorkBudget] = []
    for joint in scene.relations.joints:
        fit = scene.fits.get(joint.name)
        if fit is None or (joints is not None and joint.name not in joints):
            continue
        unable = [name for name in (joint.parent, joint.child) if name not in scene.bodies or name in scene.broken]
        if unable:
            reason = f"{' and '.join(unable)} {'have' if len(unable) > 1 else 'has'} no closed mesh"
            strength = Strength.not_checked(reason)
            rows.append(FitCheck(joint.name, (joint.parent, joint.child), fit, None, None, None, "not_checked", strength=strength))
            findings.append(_unmeasured(joint, reason))
            continue
        bore = bore_of(scene, joint) if _needs_diameters(scene, joint, fit) else None
        try:
            fit = _sized(fit, bore)
        except PlanError as error:
            strength = Strength.not_checked(error.message)
            rows.append(FitCheck(joint.name, (joint.parent, joint.child), fit, None, None, None, "not_checked", strength=strength))
            findings.append(_unmeasured(joint, error.message, "State nominal_mm beside the name of the fit, or give gap_mm."))
            continue
        findings += _misnamed(joint, fit, bore)
        budgets.append(WorkBudget(seconds))
        held = _Held(scene, joint, fit, budgets[-1], bore)
        row, finding = held.check(reached, proven or {})
        rows.append(row)
        findings += finding or _unresolved(row)
        claims += held.claims
    queries, work = sum(budget.queries for budget in budgets), sum(budget.work for budget in budgets)
    return FitReport(Findings(findings), tuple(rows), tuple(claims), queries, work)


def certified_fits(report: FitReport) -> FitReport:
    """Return a report with additional findings for fits whose motion was only sampled."""
    open_rows = [row for row in report.rows if row.verdict == "ok" and row.strength.kind == "sampled" and (row.strength.poses or 0) > 1]
    return replace(report, findings=report.findings + Findings(_unproven(row) for row in open_rows))


def followed(mechanism: Mechanism) -> dict[str, tuple[float, float]]:
    """Return the range of each coordinate of a linkage while its drivers move one at a time [rad, mm]; empty for a tree.

    These are samples of each driver's range.
    """
    if mechanism.is_tree:
        return {}
    sweep = MotionSampler(Scene.of({}, mechanism.joints), mechanism)
    numbers = {driver.name for driver in mechanism.drivers if driver.unit != "1"}
    rows = [mechanism.configuration(mechanism.rest).columns[None]]
    for freedom in sweep.ranges():
        moved = freedom
        if freedom.name in numbers:  # the ends of the driver's range are the ends of the followers' ranges
            ends = mechanism.feasible_range(freedom.name)
            moved = freedom._replace(lower=max(freedom.lower, ends.lower), upper=min(freedom.upper, ends.upper))
        kept, _, solution = sweep.placed([{moved.name: value} for value in sweep.values(moved, _FOLLOWED).tolist()])
        rows.append(solution.columns[kept])
    every = np.concatenate(rows)
    return {
        c.name: (float(low), float(high)) for c, low, high in zip(mechanism.coordinates, every.min(axis=0), every.max(axis=0), strict=True)
    }


class _Held:
    """One fit, checked against its two parts."""

    def __init__(self, scene: Scene, joint: Joint, fit: FitLike, budget: WorkBudget, bore: Bore | None) -> None:
        self.scene, self.joint, self.fit, self.budget, self.bore = scene, joint, fit, budget, bore
        self.gauge = Gauge(scene, joint, fit)
        self.slack = self.gauge.slack
        self.moving = travels(joint)
        self.claims: tuple[Claim, ...] = ()

    @property
    def touches(self) -> float:
        """The gap up to which two parts count as touching [mm]."""
        return CONTACT_MM + self.slack

    @property
    def may_touch(self) -> bool:
        """True if the fit lets the parts touch, so that the only lower bound of the gap is that of an overlap."""
        return self.fit.contact in ("allowed", "required")

    @property
    def least_allowed(self) -> float | None:
        """The gap below which the fit is broken over the motion [mm]; None if there is no bound. Negative is a depth."""
        if self.may_touch:
            return None if self.fit.gap_min is None else -self.touches
        bounds = [] if self.fit.gap_min is None else [self.fit.gap_min - self.slack]
        bounds += [self.slack] if self.fit.contact == "forbidden" else []
        return max(bounds, default=None)

    def check(self, reached: Span | Callable[[], Span] | None, proven: Span) -> tuple[FitCheck, list[Finding]]:
        """Return the row, and the finding if the fit is broken."""
        rest = self.gauge.rest()
        asked = self.fit.gap_max is not None or (self.fit.gap_min is not None and self.may_touch)
        play = self.gauge.play() if asked and rest > -self.touches else None
        if self.bore is not None and (play is None or abs(self.bore.play - play) > self.slack + 2 * STOP_MM):
            self.bore = None  # something else stops the child first, or nothing was to be measured
        play = play if self.bore is None else self.bore.play
        parts = (self.joint.parent, self.joint.child)
        row = FitCheck(self.joint.name, parts, self.fit, rest, rest, None, "ok", play, self.slack, bore=self.bore)
        verdict, value, limit = self._at_rest(rest, play)
        if verdict != "ok":
            return replace(row, verdict=verdict), [self._finding(verdict, value, limit, None, is_play=value == play)]
        if self.least_allowed is None or not self.moving:
            return row, []
        seen = self._over(row, self.moving)
        if not _is_proven(seen) and (inside := _within(self.moving, proven)) != self.moving:
            seen, self.claims = self._over(row, inside), ()  # a claim covers all of a joint's range
        if seen.verdict != "ok" and reached is not None:  # the gap may be where the linkage never brings the joint
            inside = _within(self.moving, reached() if callable(reached) else reached)
            if inside != self.moving:
                seen, self.claims = self._over(row, inside), ()
                if _is_proven(seen):  # over a range that samples have shown
                    seen = replace(seen, strength=Strength.sampled(_FOLLOWED))
        if seen.verdict == "ok":
            return seen, []
        verdict, value, limit = self._in_motion(seen.least)
        return seen, [self._finding(verdict, value, limit, seen.at)]

    def _at_rest(self, rest: float, play: float | None) -> tuple[FitVerdict, float, float]:
        """Return the verdict on the rest pose, with the number and the bound that decide."""
        fit = self.fit
        if fit.contact == "required" and rest > self.touches:
            return "apart", rest, self.touches
        verdict, value, limit = self._in_motion(rest)
        if verdict != "ok":
            return verdict, value, limit
        slack = self.slack if self.bore is None else self.bore.off + DIAMETER_MM
        if self.may_touch and fit.gap_min is not None and play is not None and play < fit.gap_min - slack:
            return "tight", play, fit.gap_min
        wide = rest if play is None else play
        if fit.gap_max is not None and wide > fit.gap_max + slack:
            return "loose", wide, fit.gap_max
        return "ok", rest, 0.0

    def _in_motion(self, gap: float | None) -> tuple[FitVerdict, float, float]:
        assert gap is not None
        fit = self.fit
        if fit.contact == "forbidden" and gap <= self.slack:
            return "contact", gap, 0.0
        if fit.gap_min is not None and gap < (-self.touches if self.may_touch else fit.gap_min - self.slack):
            return "tight", gap, 0.0 if self.may_touch else fit.gap_min
        return "ok", gap, 0.0

    def _over(self, row: FitCheck, moving: tuple[Freedom, ...]) -> FitCheck:
        """Check the lower bound over a range: by samples, which find clear violations, then by a proof."""
        poses = 0
        ranges = [sampled_piece(self.joint, freedom) for freedom in moving]
        endless = ranges != list(moving)
        near = freedoms(self.joint) if endless and self.joint.type is JointType.SCREW else ()  # one turn, in finer steps
        for values in itertools.chain(_samples(near), _samples(ranges)):
            poses += 1
            row = self._nearer(row, values, moving)
            if self._in_motion(row.least)[0] != "ok":
                return replace(row, verdict=self._in_motion(row.least)[0], strength=Strength.sampled(poses))
        if endless:
            return replace(row, strength=Strength.sampled(poses))
        found = self._proven(row, moving)
        return replace(row, strength=Strength.sampled(poses)) if found is None else found

    def _nearer(self, row: FitCheck, values: Sequence[float], moving: tuple[Freedom, ...]) -> FitCheck:
        assert row.rest is not None
        assert row.least is not None
        gap = self.gauge.nearer_than(max(row.rest - self.slack, self.least_allowed or 0.0, 0.0), list(values))
        return replace(row, least=gap, at=_named(moving, values)) if gap < row.least else row

    def _proven(self, row: FitCheck, moving: tuple[Freedom, ...]) -> FitCheck | None:
        """Return the row with a proof, or with a pose where the fit is broken; None if neither was found."""
        least = self.least_allowed
        assert least is not None
        # prove the least gap plus the deflection of both meshes; if that fails, the gap of the meshes alone, with twice the uncertainty
        for needed, off in ((least + 2 * self.slack, self.slack), (least, 2 * self.slack)) if self.slack else ((least, 0.0),):
            prover = _FitProver(self, moving, max(needed, 0.0))
            shrink = NO_SHRINK if needed > 0 else Shrink(max(-needed, EPSILON_MM))
            if shrink.depth and self.fit.within is not None:
                return None  # a cut surface has no inside towards which to move it
            outcome = prover.search(prover.bounds, shrink)
            if outcome.is_complete:
                if self.fit.within is None and needed >= self.slack:
                    self.claims = (prover.claim(NOTHING, prover.vary(prover.bounds), shrink, outcome),)
                return replace(row, strength=Strength.certified(off))
            if outcome.out_of_budget:
                return None
            # the pose where the search met contact may break the fit: measure it
            if outcome.contact is not None and self._is_within(prover, outcome.contact):
                gap = self.gauge.between(prover.chain.matrix(outcome.contact))
                pose = prover.pose(outcome.contact)
                if gap < (math.inf if row.least is None else row.least):
                    row = replace(row, least=gap, at=pose)
                verdict = self._in_motion(gap)[0]
                if verdict != "ok":
                    return replace(row, verdict=verdict, strength=Strength.sampled(1))
        return None

    def _is_within(self, prover: _FitProver, values: Sequence[float]) -> bool:
        """Return whether a pose of the search is within the joint's limits: a ball is proven over slightly more."""
        if self.joint.type is not JointType.BALL:
            return True
        sx, sy, twist = prover.pose(values).values()
        cone, last = self.moving[0].upper, self.moving[2]
        return math.hypot(sx, sy) <= cone and last.lower <= twist <= last.upper

    def _finding(
        self, verdict: FitVerdict, value: float, limit: float, where: Mapping[str, float] | None, *, is_play: bool = False
    ) -> Finding:
        a, b = self.joint.parent, self.joint.child
        kind = "play" if is_play else "gap"
        measured = f"the {kind} of {a} and {b} is {value:.4g} mm" if value >= 0 else f"{a} and {b} overlap {-value:.4g} mm deep"
        code, message, hint = {
            "tight": (
                "E_FIT_TIGHT",
                f"{measured}, less than {limit:g} mm" if value >= 0 else f"{measured}, but the least gap is {limit:g} mm",
                f"Widen the gap by {limit - value:.4g} mm: enlarge the bore or thin the pin.",
            ),
            "loose": (
                "E_FIT_LOOSE",
                f"{measured} at rest, more than {limit:g} mm",
                f"Narrow the gap by {value - limit:.4g} mm: narrow the bore or thicken the pin.",
            ),
            "contact": ("E_FIT_CONTACT", f"{measured}, but contact is forbidden", "Move the two surfaces apart."),
            "apart": ("E_FIT_CONTACT", f"{measured}, but contact is required", f"Bring the two surfaces {value:.4g} mm closer."),
        }[verdict]
        place = "" if not where else " at " + ", ".join(f"{name} = {q:.4g}" for name, q in where.items())
        return Finding(
            code=code,
            where=f"joints.{self.joint.name}.fit",
            parts=(a, b),
            message=f"Joint {self.joint.name!r}: {message}{place}.",
            hint=hint,
            value=value,
            limit=limit,
            unit="mm",
            route="design" if where else None,  # a fit that holds at rest and not in motion has a wrong range
            pose=where,
        )


class _FitProver(Prover):
    """Proves that the two parts of a joint keep a gap while that joint moves."""

    def __init__(self, held: _Held, moving: tuple[Freedom, ...], gap: float) -> None:
        joint = held.joint
        super().__init__(held.scene, Route((joint.parent, joint.child), (joint,)), (joint.name,), epsilon=EPSILON_MM, budget=held.budget)
        self.margin = gap
        if joint.type is not JointType.BALL:
            self.bounds = np.array([(freedom.lower, freedom.upper) for freedom in moving]).reshape(-1, 2)
        self.within = None if held.fit.within is None else held.gauge.surfaces

    def _sides(self, shrink: Shrink) -> tuple[Surface, Surface]:
        return super()._sides(shrink) if self.within is None else self.within


def _is_proven(row: FitCheck) -> bool:
    return row.verdict == "ok" and row.strength.kind == "certified"


def _within(moving: tuple[Freedom, ...], spans: Span) -> tuple[Freedom, ...]:
    """Return freedoms with their ranges restricted to spans."""
    return tuple(
        f._replace(lower=max(f.lower, spans[f.name][0]), upper=min(f.upper, spans[f.name][1])) if f.name in spans else f for f in moving
    )


def _samples(ranges: Sequence[Freedom]) -> Iterator[list[float]]:
    """Yield poses of a joint: each coordinate through its range, the others at rest, then all together."""
    rest = [freedom.rest for freedom in ranges]
    for column, freedom in enumerate(ranges):
        for value in np.linspace(freedom.lower, freedom.upper, STEPS).tolist():
            yield [*rest[:column], value, *rest[column + 1 :]]
    if len(ranges) > 1:
        swings = ranges[0].name.endswith(".sx")
        for point in scattered(ranges, STEPS):
            if not swings or math.hypot(point[0], point[1]) <= ranges[0].upper:
                yield list(point)


def _named(moving: Sequence[Freedom], values: Sequence[float]) -> dict[str, float] | None:
    """Return the coordinates that are not at rest, by name."""
    return {freedom.name: value for freedom, value in zip(moving, values, strict=True) if value != freedom.rest} or None


def _unproven(row: FitCheck) -> Finding:
    where = "" if row.at is None else " at " + ", ".join(f"{name} = {value:.4g}" for name, value in row.at.items())
    return Finding(
        code="W_NOT_CERTIFIED",
        where=f"joints.{row.joint}.fit",
        parts=row.parts,
        message=f"The fit of joint {row.joint!r} is not proven over its motion: at {row.strength.poses} poses the gap is {row.least:.4g} mm "
        f"or more{where}.",
        hint="Give limits to a slide that has none, raise the budget, declare a smaller least gap, or widen the gap.",
        value=row.least,
        limit=row.declared.gap_min,
        unit="mm",
        stage="fit",
    )


def _unresolved(row: FitCheck) -> list[Finding]:
    """Return a finding if the meshes may deviate by more than half the range of a fit that seems kept: then the verdict is not certain."""
    fit, off = row.declared, row.tolerance
    if fit.gap_max is None or fit.gap_max - (fit.gap_min or 0.0) >= 2 * off or row.bore is not None:
        return []
    measured = row.rest if row.play is None else row.play
    return [
        Finding(
            code="W_FIT_UNRESOLVED",
            where=f"joints.{row.joint}.fit",
            parts=row.parts,
            message=f"Joint {row.joint!r}: {measured:.4g} mm were measured on meshes that may be off by {off:.4g} mm together; this does not "
            f"show whether the gap is between {fit.gap_min or 0:g} and {fit.gap_max:g} mm.",
            hint=f"Mesh the two parts with a deflection of {(fit.gap_max - (fit.gap_min or 0.0)) / 8:.2g} mm or less.",
            value=off,
            limit=(fit.gap_max - (fit.gap_min or 0.0)) / 2,
            unit="mm",
            stage="fit",
        )
    ]


def _needs_diameters(scene: Scene, joint: Joint, fit: FitLike) -> bool:
    """Return whether a fit is to be measured on cylinders: it is named, or its range is narrower than the meshes can resolve."""
    if isinstance(fit, Fit) and fit.name is not None:
        return True
    return fit.gap_max is not None and fit.gap_max - (fit.gap_min or 0.0) < 2 * scene.deflection_of(joint.parent, joint.child)


def _sized(fit: FitLike, bore: Bore | None) -> FitLike:
    """Return a named fit without a diameter with that of its bore, in tenths of a millimetre.

    Raises:
        PlanError: If there is no bore, or no such fit at its diameter.
    """
    if not isinstance(fit, Fit) or fit.name is None or fit.gap_max is not None:
        return fit
    if bore is None:
        raise PlanError(f"the fit {fit.name} needs a diameter, and no pin in a bore is found about the joint's axis")
    return fit.sized(round(bore.bore, 1))


def _misnamed(joint: Joint, fit: FitLike, bore: Bore | None) -> list[Finding]:
    """Return a finding if the bore has another diameter than the one for which its fit is stated."""
    if not isinstance(fit, Fit) or fit.nominal is None or bore is None:
        return []
    limit = NOMINAL_MM + NOMINAL_SHARE * fit.nominal
    if abs(bore.bore - fit.nominal) <= limit:
        return []
    return [
        Finding(
            code="W_FIT_NOMINAL",
            where=f"joints.{joint.name}.fit",
            parts=(joint.parent, joint.child),
            message=f"Joint {joint.name!r} states {fit.name} for {fit.nominal:g} mm, but its bore measures {bore.bore:.6g} mm.",
            hint=f"State the fit for {bore.bore:.4g} mm, or change the bore.",
            value=bore.bore,
            limit=fit.nominal,
            unit="mm",
            stage="fit",
        )
    ]


def _name_of(fit: FitLike) -> dict[str, Any]:
    return {"name": fit.name, "nominal_mm": fit.nominal} if isinstance(fit, Fit) and fit.name is not None else {}


def _unmeasured(joint: Joint, reason: str, hint: str = "Give the part geometry, or leave the fit out.") -> Finding:
    return Finding(
        code="E_NOT_CHECKED",
        where=f"joints.{joint.name}.fit",
        parts=(joint.parent, joint.child),
        message=f"The fit of joint {joint.name!r} is not measured: {reason}.",
        hint=hint,
        stage="fit",
    )
