"""Fits: what a joint declares about the gap between its two parts, held against what is measured.

The gap is the smallest distance of the two surfaces, near the joint's axis only if the fit says so. The upper bound holds at
rest, the lower one over the whole motion of the joint, which is sampled. Meshes may be off by their deflection either way, so a
fit is called broken only beyond that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError
from articad.findings import Finding, Findings
from articad.interference.motion import freedoms, motion_matrix
from articad.interference.overlap import VOLUME_NOISE_MM3, overlap
from articad.interference.relations import FitLike
from articad.interference.report import rounded
from articad.interference.scene import Scene
from articad.interference.surface import Core, Surface, split_by_radius, surface_distance
from articad.kinematics.joints import Joint, JointType

FloatArray = NDArray[np.float64]

STEPS = 24  # poses per coordinate at which the gap is measured in motion
CONTACT_MM = 0.02  # surfaces this close touch, beyond the deflection of their meshes
_EDGE_SHARE = 0.1  # of `within`: longest edge of triangles left crossing it

FitVerdict = Literal["ok", "tight", "loose", "contact", "apart", "not_checked"]


@dataclass(frozen=True)
class FitCheck:
    """One row: declared against measured.

    Attributes:
        joint: Its name.
        parts: Its two parts.
        declared: The fit.
        rest: Gap at rest [mm]; negative is the depth of an overlap. None when it could not be measured.
        least: Smallest gap over the motion [mm].
        at: Where the smallest gap is [rad, mm].
        verdict: "ok"; "tight" or "loose"; "contact" where it is forbidden; "apart" where contact is required; or "not_checked".
    """

    joint: str
    parts: tuple[str, str]
    declared: FitLike
    rest: float | None
    least: float | None
    at: Mapping[str, float] | None
    verdict: FitVerdict

    def to_json(self) -> dict[str, Any]:
        """Return a row of the table."""
        fit = self.declared
        return {
            "joint": self.joint,
            "parts": list(self.parts),
            "declared": {"gap_mm": [fit.gap_min, fit.gap_max], "within_mm": fit.within, "contact": fit.contact},
            "rest_mm": rounded(self.rest),
            "least_mm": rounded(self.least),
            "at": None if self.at is None else {name: rounded(value) for name, value in self.at.items()},
            "verdict": self.verdict,
        }


@dataclass(frozen=True)
class FitReport:
    """All fits of an assembly.

    Attributes:
        findings: One per broken fit.
        rows: One per declared fit, in order.
    """

    findings: Findings
    rows: tuple[FitCheck, ...]

    @property
    def ok(self) -> bool:
        """True when every fit is kept."""
        return self.findings.ok

    def to_json(self) -> dict[str, Any]:
        """Return the table with its findings."""
        return {
            "schema": "articad.fits/1",
            "ok": self.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "rows": [row.to_json() for row in self.rows],
        }


def check_fits(scene: Scene, reached: Mapping[str, tuple[float, float]] | None = None) -> FitReport:
    """Measure every declared fit of a scene.

    Args:
        scene: Bodies and relations.
        reached: How far coordinates go that follow others, by name [rad, mm]: a joint of a linkage need not reach its own limits.
    """
    rows: list[FitCheck] = []
    findings: list[Finding] = []
    for joint in scene.relations.joints:
        fit = scene.fits.get(joint.name)
        if fit is None:
            continue
        row, finding = _check_fit(scene, joint, fit, reached or {})
        rows.append(row)
        findings += finding
    return FitReport(Findings(findings), tuple(rows))


def _check_fit(scene: Scene, joint: Joint, fit: FitLike, reached: Mapping[str, tuple[float, float]]) -> tuple[FitCheck, list[Finding]]:
    parts = (joint.parent, joint.child)
    unable = [name for name in parts if name not in scene.bodies or name in scene.broken]
    if unable:
        return FitCheck(joint.name, parts, fit, None, None, None, "not_checked"), [_unmeasured(joint, unable)]
    gauge = Gauge(scene, joint, fit)
    rest, least, where = gauge.rest(), *gauge.least(reached)
    slack = scene.deflection_of(*parts)
    verdict, value, limit = _verdict(fit, rest, least, slack)
    row = FitCheck(joint.name, parts, fit, rest, least, where, verdict)
    return row, [] if verdict == "ok" else [_finding(joint, verdict, value, limit, where if value == least != rest else None)]


def _verdict(fit: FitLike, rest: float, least: float, slack: float) -> tuple[FitVerdict, float, float]:
    touches = CONTACT_MM + slack
    if fit.contact == "forbidden" and least <= slack:
        return "contact", least, 0.0
    if fit.contact == "required" and rest > touches:
        return "apart", rest, touches
    allowed = fit.contact in ("allowed", "required") and least >= -slack - CONTACT_MM
    if fit.gap_min is not None and least < fit.gap_min - slack and not (allowed and least <= touches):
        return "tight", least, fit.gap_min
    if fit.gap_max is not None and rest > fit.gap_max + slack:
        return "loose", rest, fit.gap_max
    return "ok", least, 0.0


class Gauge:
    """Measures the gap of one joint."""

    def __init__(self, scene: Scene, joint: Joint, fit: FitLike) -> None:
        self.joint, self.fit = joint, fit
        self.bodies = scene.bodies[joint.parent], scene.bodies[joint.child]
        frames = joint.T_parent_connector, joint.T_child_connector
        self.surfaces = [self._near_axis(body.mesh, frame) for body, frame in zip(self.bodies, frames, strict=True)]

    def rest(self) -> float:
        """Return the gap at rest [mm]; negative is a depth."""
        return self.at([freedom.rest for freedom in freedoms(self.joint)])

    def least(self, reached: Mapping[str, tuple[float, float]]) -> tuple[float, dict[str, float] | None]:
        """Return the smallest gap over the motion, one coordinate at a time, and where; `reached` replaces declared ranges."""
        moving = freedoms(self.joint)
        rest = [freedom.rest for freedom in moving]
        least, where = self.at(rest), None
        for column, freedom in enumerate(moving):
            low, high = reached.get(freedom.name, (freedom.lower, freedom.upper))
            for value in np.linspace(low, high, STEPS).tolist():
                gap = self.at([*rest[:column], value, *rest[column + 1 :]])
                if gap < least:
                    least, where = gap, {freedom.name: value}
        return least, where

    def at(self, values: list[float]) -> float:
        """Return the gap at values of the joint's freedoms [mm]."""
        joint = self.joint
        J = motion_matrix(joint, values) if values else np.eye(4)
        flip = np.diag([1.0, -1.0, -1.0, 1.0]) if joint.mate == "opposed" else np.eye(4)
        T = joint.T_parent_connector.matrix @ J @ flip @ joint.T_child_connector.inverse().matrix
        gap = surface_distance(self.surfaces[0], self.surfaces[1], T)
        if gap > 0:
            return gap
        try:
            found = overlap(self.bodies[0], self.bodies[1], SE3.from_matrix(T))
        except InvalidSolidError:
            return 0.0
        return -found.depth if found.volume > VOLUME_NOISE_MM3 else 0.0

    def _near_axis(self, mesh: Any, frame: SE3) -> Surface:
        if self.fit.within is None:
            return Surface.of(mesh)
        from_point = self.joint.type in (JointType.BALL, JointType.FIXED)
        core = Core(frame.matrix, 3 if from_point else 2)
        inside, seam, _ = split_by_radius(mesh, core, self.fit.within, _EDGE_SHARE * self.fit.within)
        return Surface(np.concatenate([inside.corners, seam.corners]))


def _finding(joint: Joint, verdict: FitVerdict, value: float, limit: float, where: Mapping[str, float] | None) -> Finding:
    a, b = joint.parent, joint.child
    measured = f"the gap of {a} and {b} is {value:.4g} mm" if value >= 0 else f"{a} and {b} overlap {-value:.4g} mm deep"
    code, message, hint = {
        "tight": (
            "E_FIT_TIGHT",
            f"{measured}, less than {limit:g} mm",
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
        where=f"joints.{joint.name}.fit",
        parts=(a, b),
        message=f"Joint {joint.name!r}: {message}{place}.",
        hint=hint,
        value=value,
        limit=limit,
        unit="mm",
        pose=where,
    )


def _unmeasured(joint: Joint, unable: list[str]) -> Finding:
    return Finding(
        code="E_NOT_CHECKED",
        where=f"joints.{joint.name}.fit",
        parts=(joint.parent, joint.child),
        message=f"The fit of joint {joint.name!r} is not measured: {' and '.join(unable)} {'have' if len(unable) > 1 else 'has'} no closed mesh.",
        hint="Give the part geometry, or leave the fit out.",
        stage="fit",
    )
