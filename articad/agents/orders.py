"""Who made a fault between parts: a script that departs from its order, or the plan that ordered it.

Decided by proof, from the round surfaces about the axes of joints and from the probe of dimensions. A script departs if a dimension of its
part has no effect, or if a bore or pin about a joint's axis has a diameter that none of its dimensions states. What else is wrong about
such a part may follow from that, so it waits for the script. A hole or slot that is absent from a script that follows its order was not
ordered: the plan is wrong. It is wrong as well if a fit is off by just what both surfaces differ, and both have the diameters that were
ordered. Everything else stays open.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from articad.assembly import Assembly
from articad.findings import Finding, Findings
from articad.geometry.faces import Face
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint, JointType
from articad.plan.resolve import ResolvedPlan
from articad.realisation.bores import TILT, along, at_height
from articad.realisation.sides import sides

__all__ = ["addressed", "source_of"]

_FITS: Final = frozenset({"E_FIT_TIGHT", "E_FIT_LOOSE", "E_FIT_CONTACT"})
_CODES: Final = _FITS | {"E_OVERLAP", "E_STATIC_OVERLAP", "E_MOTION_COLLISION", "E_FLOATING", "E_NOT_TOUCHING"}
_CUT: Final = frozenset({"unbored_hole", "missing_slot"})  # causes that a cut mends: one that was ordered, or one that must be
_ROUND: Final = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW)
_ON_AXIS_MM: Final = 0.2  # a surface whose axis is farther away is not about the joint's axis
_ALIKE: Final = 0.3  # difference of radii, as a share of the larger
_ROUNDING_MM: Final = 0.005  # of a diameter
_PLAY_MM: Final = 0.02  # difference of a measured gap and that of the surfaces
_CLEARANCE: Final = re.compile(r"clearance|play|gap|slack|tolerance|allowance")


class _Round(NamedTuple):
    """A cylinder about a joint's axis: its part, diameter and error [mm], and whether it is a bore."""

    part: str
    diameter: float
    off: float
    hollow: bool


def addressed(findings: Iterable[Finding], assembly: Assembly, scene: Scene) -> Findings:
    """Send each error about two parts to whoever made it, where the parts prove it; others keep their route.

    Args:
        findings: Of an examination of the assembly.
        assembly: A product that was built from a plan.
        scene: The assembly's scene.
    """
    several = tuple(findings)
    pairs = {frozenset(finding.parts) for finding in several if finding.code in _CODES and len(finding.parts) == 2}
    if assembly.resolved is None or not pairs:
        return Findings(several)
    joints = [joint for joint in assembly.joints if frozenset({joint.parent, joint.child}) in pairs and joint.type in _ROUND]
    surfaces = {joint.name: _mating(scene, joint) for joint in joints}
    departed = _departed(assembly, assembly.resolved, set().union(*pairs), surfaces)
    return Findings(_addressed(finding, assembly.resolved, departed, joints, surfaces) for finding in several)


def source_of(name: str, resolved: ResolvedPlan) -> str:
    """Return the part that has the script: a derived part's faults belong to its source."""
    while (derivation := resolved.parts[name].derivation) is not None:
        name = derivation.source
    return name


def _departed(assembly: Assembly, resolved: ResolvedPlan, parts: Iterable[str], surfaces: Mapping[str, Sequence[_Round]]) -> dict[str, str]:
    """Return why scripts depart from their orders, by the part that has the script."""
    found: dict[str, str] = {}
    for source in sorted({source_of(name, resolved) for name in parts}):
        unused = assembly.realised[source].findings.of("W_DIMENSION_UNUSED")
        if unused:
            found[source] = f"{source} does not follow its dimension {unused[0].where.rsplit('.', 1)[-1]!r}."
    for joint, round_ones in surfaces.items():
        for one in round_ones:
            source = source_of(one.part, resolved)
            if not _is_stated(one, resolved.parts[source].dimensions):
                what = "bore" if one.hollow else "pin"
                found.setdefault(
                    source,
                    f"The {what} of {source} about the axis of {joint!r} has a diameter of {one.diameter:.4g} mm, "
                    "which none of its dimensions states.",
                )
    return found


def _addressed(
    finding: Finding,
    resolved: ResolvedPlan,
    departed: Mapping[str, str],
    joints: Iterable[Joint],
    surfaces: Mapping[str, Sequence[_Round]],
) -> Finding:
    if finding.code not in _CODES:
        return finding
    guilty = [source for name in finding.parts if (source := source_of(name, resolved)) in departed]
    if guilty:
        is_named = finding.route == "code" and finding.where == f"parts.{guilty[0]}"
        more = finding.hint if is_named else f"Build {guilty[0]} as its specification states."
        return replace(finding, route="code", where=f"parts.{guilty[0]}", hint=f"{departed[guilty[0]]} {more}")
    if finding.cause in _CUT:
        culprit = finding.where.removeprefix("parts.")
        follows = f"As far as it can be measured, the script of {culprit} follows its order, so the order is at fault"
        return replace(finding, route="design", hint=f"{follows}: {finding.hint[0].lower()}{finding.hint[1:]}")
    between = [joint.name for joint in joints if {joint.parent, joint.child} == set(finding.parts)]
    if finding.code in _FITS and any(_explains(surfaces[name], finding) for name in between):
        return replace(finding, route="design")
    return finding


def _explains(surfaces: Sequence[_Round], finding: Finding) -> bool:
    """Return whether a gap is what a bore and its pin differ by."""
    plays = [(bore.diameter - pin.diameter) / 2 for bore, pin in itertools.product(surfaces, surfaces) if bore.hollow and not pin.hollow]
    return finding.value is not None and any(abs(finding.value - play) < _PLAY_MM for play in plays)


def _mating(scene: Scene, joint: Joint) -> list[_Round]:
    """Return the bores and pins about a joint's axis, one on each side of it, that meet along it and are nearly equal in size."""
    both = [[(one.part, one.face) for one in side if _is_about(one.face)] for side in sides(scene, joint)]
    found = []
    for one, other in ((both[0], both[1]), (both[1], both[0])):
        for part, bore in one:
            for against, pin in other:
                (low, high), (start, end) = along(bore), along(pin)
                alike = abs(bore.radius - pin.radius) <= _ALIKE * max(bore.radius, pin.radius)
                if bore.hollow and not pin.hollow and alike and min(high, end) > max(low, start):
                    found += [_Round(part, 2 * bore.radius, bore.off, hollow=True), _Round(against, 2 * pin.radius, pin.off, hollow=False)]
    return found


def _is_about(face: Face) -> bool:
    """Return whether a face is a cylinder about the z axis."""
    if face.kind != "cylinder" or np.hypot(face.axis[0], face.axis[1]) > TILT:
        return False
    return float(np.linalg.norm(at_height(face, sum(along(face)) / 2))) < _ON_AXIS_MM


def _is_stated(surface: _Round, dimensions: Mapping[str, float]) -> bool:
    """Return whether a diameter is that of a dimension, taken as diameter or radius, with or without a clearance."""
    allowed = 2 * surface.off + _ROUNDING_MM
    return any(abs(surface.diameter - stated) <= allowed for stated in _diameters(dimensions))


def _diameters(dimensions: Mapping[str, float]) -> Iterator[float]:
    lengths = {name: float(value) for name, value in dimensions.items() if not name.endswith(("_deg", "_count"))}
    clearances = [0.0, *(value for name, value in lengths.items() if _CLEARANCE.search(name))]
    for value in lengths.values():
        for clearance in clearances:
            for sign in (1, -1):
                yield from (
                    value + sign * clearance,
                    value + 2 * sign * clearance,
                    2 * value + sign * clearance,
                    2 * value + 2 * sign * clearance,
                )
