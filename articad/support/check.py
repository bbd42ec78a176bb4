"""Whether a product stands, whether each part is carried, what falls out when it is turned over, and which ways parts have out.

Bodies are examined at rest and at the ends of each driver's range, with the weight along -z and drivers that hold their values. Contacts are
those of plane, cylindrical and spherical surfaces, to first order; a body that seems to fall is moved down along its exact way before anything is said.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.disassembly.poses import OtherPose
from articad.disassembly.ways import Halt, Ways, distinct
from articad.findings import Finding, Findings
from articad.interference.report import rounded
from articad.interference.scene import Scene
from articad.support.carried import Bodies
from articad.support.stance import Stance, stance

__all__ = ["BodySupport", "Support", "check_support"]

FALLS_MM: Final = 5.0  # a body that goes down by less rests on something
_UP: Final = np.array([0.0, 0.0, 1.0])

CentreOfMass = Callable[[Mapping[str, SE3]], FloatArray | None]


@dataclass(frozen=True)
class BodySupport:
    """What holds a body, a set of parts that are fixed to each other.

    Attributes:
        parts: Its parts.
        rests_on: Parts under a surface of it.
        joints: Joints that surfaces make, and that hold it.
        falls: How far it falls at rest [mm]; 0 if it is carried; infinity if nothing stops it.
        at: Values of the drivers where it falls; empty at rest.
        turned_over: How far it falls when the product is turned over [mm]; infinity if it falls out.
        kept_by: The part that stops it then, or the joint that holds it; None if it falls out.
        ways_out: Directions in which nothing stops it, whatever its joints, `(3,)` each.
    """

    parts: tuple[str, ...]
    rests_on: tuple[str, ...]
    joints: tuple[str, ...]
    falls: float
    at: dict[str, float]
    turned_over: float
    kept_by: str | None
    ways_out: tuple[tuple[float, float, float], ...]

    def to_json(self) -> dict[str, Any]:
        """Return a row of the report; null for a fall that nothing stops."""
        return {
            "parts": list(self.parts),
            "carried": self.falls == 0,
            "rests_on": list(self.rests_on),
            "joints": list(self.joints),
            "falls_mm": _finite(self.falls),
            "at": {name: rounded(value) for name, value in self.at.items()},
            "falls_out_turned_over": math.isinf(self.turned_over),
            "turned_over_mm": _finite(self.turned_over),
            "kept_by": self.kept_by,
            "captive": not self.ways_out,
            "ways_out": [[rounded(x) for x in way] for way in self.ways_out],
        }


@dataclass(frozen=True)
class Support:
    """How a product stands, and what holds its parts.

    Attributes:
        findings: Warnings.
        stances: At rest, then at the ends of each driver's range; empty if the product has no mass.
        bodies: All but the one that stands still.
    """

    findings: Findings
    stances: tuple[Stance, ...]
    bodies: tuple[BodySupport, ...]

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.support/1`."""
        return {
            "schema": "articad.support/1",
            "ok": self.findings.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "stances": [row.to_json() for row in self.stances],
            "bodies": [row.to_json() for row in self.bodies],
        }


def check_support(
    scene: Scene,
    rest: Mapping[str, SE3],
    ground: str,
    *,
    others: Sequence[OtherPose] = (),
    made: Collection[str],
    centre_of_mass: CentreOfMass,
) -> Support:
    """Examine what holds the parts of a product.

    Args:
        scene: Its parts and relations.
        rest: `T_ground_part` at rest, with z up.
        ground: The part that stands still.
        others: The ends of the drivers' ranges.
        made: Joints that surfaces make, or of which that is not known.
        centre_of_mass: Returns the centre of mass for poses of the parts, `(3,)` [mm]; None without mass.
    """
    stances = []
    fallen: dict[tuple[str, ...], tuple[float, dict[str, float]]] = {}
    for place in (OtherPose({}, rest), *others):
        com = centre_of_mass(place.poses)
        parts = [name for name in scene.bodies if name not in scene.environment]
        if com is not None and parts:
            points = np.concatenate([place.poses[name].apply(scene.bodies[name].mesh.vertices) for name in parts])
            stances.append(stance(points, com, place.at))
        bodies = Bodies(scene, place.poses, ground, made)
        movers = [mover for mover in bodies.moved_by(-_UP) if mover.parts not in fallen]
        if movers:
            ways = Ways(scene, place.poses)
            for mover in movers:
                stop = _stop(ways, mover.parts, -_UP, scene)
                if stop.travel >= FALLS_MM:
                    fallen[mover.parts] = (stop.travel, place.at)
    at_rest, ways = Bodies(scene, rest, ground, made), Ways(scene, rest)
    loose = {mover.parts for mover in at_rest.moved_by(_UP)}
    rows = tuple(_row(at_rest, ways, at, made, fallen, loose) for at in range(len(at_rest.bodies)))
    return Support(Findings([*_falling(rows), *_tipping(stances, ground)]), tuple(stances), rows)


def _row(
    bodies: Bodies,
    ways: Ways,
    at: int,
    made: Collection[str],
    fallen: Mapping[tuple[str, ...], tuple[float, dict[str, float]]],
    loose: Collection[tuple[str, ...]],
) -> BodySupport:
    parts = bodies.bodies[at]
    joints = [j for j in bodies.scene.relations.joints if (j.parent in parts) != (j.child in parts)]
    holding = tuple(joint.name for joint in joints if joint.name in made)
    falls, pose = fallen.get(parts, (0.0, {}))
    stop = _stop(ways, parts, _UP, bodies.scene) if parts in loose else Halt(0.0)
    kept = stop.by if parts in loose else (holding[0] if holding else None)
    axes = [ways.poses[j.parent].rotation @ j.T_parent_connector.z_axis for j in joints]
    out = [way for way in distinct([*np.eye(3), *axes]) if math.isinf(_stop(ways, parts, way, bodies.scene).travel)]
    free = tuple((float(way[0]) + 0.0, float(way[1]) + 0.0, float(way[2]) + 0.0) for way in out)
    return BodySupport(parts, bodies.below(at, _UP), holding, falls, dict(pose), stop.travel, kept, free)


def _stop(ways: Ways, parts: tuple[str, ...], way: FloatArray, scene: Scene) -> Halt:
    staying = [name for name in ways.parts if name not in parts and name not in scene.environment]
    return ways.stop([name for name in parts if name in ways.parts], staying, way)


def _falling(rows: Sequence[BodySupport]) -> list[Finding]:
    found = []
    for row in rows:
        if row.falls > 0:
            names = " and ".join(row.parts)
            far = "nothing stops it" if math.isinf(row.falls) else f"it falls by {row.falls:.3g} mm"
            found.append(
                Finding(
                    code="W_NOT_CARRIED",
                    where=f"parts.{row.parts[0]}",
                    parts=row.parts,
                    message=f"Nothing carries {names}{_at(row.at)}: {far}.",
                    hint=f"Put a surface under {row.parts[0]}, or give it a joint whose surfaces hold it.",
                    value=None if math.isinf(row.falls) else row.falls,
                    unit="mm",
                    pose=row.at or None,
                )
            )
    return found


def _tipping(stances: Sequence[Stance], ground: str) -> list[Finding]:
    over = [one for one in stances if not one.stands]
    if not over:
        return []
    worst = min(over, key=lambda one: one.margin)
    return [
        Finding(
            code="W_TIPS_OVER",
            where=f"parts.{ground}",
            parts=(ground,),
            message=f"The product tips over{_at(worst.at)}: its centre of mass is {-worst.margin:.3g} mm outside the points on which it stands.",
            hint="Widen the base, move mass over it, or shorten the travel. A product that is fastened where it stands needs nothing.",
            value=worst.margin,
            limit=0.0,
            unit="mm",
            pose=worst.at or None,
        )
    ]


def _at(pose: Mapping[str, float]) -> str:
    return "" if not pose else " at " + ", ".join(f"{name} = {value:.4g}" for name, value in pose.items())


def _finite(value: float) -> float | None:
    return None if math.isinf(value) else rounded(value)
