"""Whether a part has the feature that a connector's kind orders, and whether its bores can be made."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.findings import Finding, Findings
from articad.geometry.faces import Face, faces_of
from articad.geometry.mesh import TriMesh
from articad.geometry.winding import winding_numbers
from articad.kernels.contract import DRIFT_ANGLE, DRIFT_RADIAL_MM
from articad.realisation.bores import at_height

__all__ = ["FEATURES", "Order", "bore_findings", "feature_findings"]

NARROW_MM: Final = 0.5  # printers and common drills make no bore narrower than this
DEEPEST: Final = 10.0  # its depth over its width
_CLOSED: Final = 0.05  # sum of normals over the area: 0 for a whole cylinder, 0.64 for a half
_HALF: Final = 0.6  # as above: more than half a cylinder
_ROUNDING: Final = 0.02  # of a width that is measured on a mesh
_ROUNDING_MM: Final = 0.005  # of a coordinate
_AXES: Final = frozenset({"bore_axis", "shaft_axis"})
_NAMES: Final = {"bore_axis": "a bore", "shaft_axis": "a shaft or bore", "mount_face": "a face"}
FEATURES: Final = frozenset(_NAMES)
"""Kinds of connectors that order a feature."""


class Order(NamedTuple):
    """What tells whether a connector or the feature beside it departs from what a part is ordered to be.

    Attributes:
        lengths: Dimensions of the part [mm].
        stated: For each connector, the frame of the part in the frame in which the plan states it.
    """

    lengths: Mapping[str, float]
    stated: Mapping[str, SE3]


class _Beside(NamedTuple):
    """A cylinder parallel to a connector's axis: its width, its distance from the axis, and the origin on its own axis `(3,)`, all in mm."""

    width: float
    distance: float
    origin: FloatArray


def feature_findings(part: str, connectors: Mapping[str, Connector], mesh: TriMesh, order: Order | None = None) -> Findings:
    """Return W_CONNECTOR_FEATURE for each connector whose kind orders a feature that the part does not have there.

    An axis needs a cylinder about it, anywhere along it. A face to mount on needs a plane through the connector across its z, or material
    at the connector, or a cylinder about its z. Surfaces other than planes, cylinders and spheres are not recognised: an axis that passes
    through the box of one counts as realised.

    If the nearest cylinder parallel to an axis lies where dimensions of the part put it, and the connector where fewer or none do, the connector
    is at fault: the finding goes to the designer. Otherwise it goes to the author of the script.

    Args:
        part: Its name.
        connectors: Of the plan, in the part's frame.
        mesh: Its surface in the same frame [mm].
        order: What decides who is asked; without it, the author of the script is.
    """
    return Findings(_findings(part, connectors, mesh, order))


def bore_findings(part: str, mesh: TriMesh, lengths: Mapping[str, float] | None = None) -> Findings:
    """Return W_BORE_NARROW for a bore that can neither be drilled nor printed: less than half a millimetre wide, and deep.

    Args:
        part: Its name.
        mesh: Its surface, in any frame [mm].
        lengths: Its dimensions by address in the plan [mm].
    """
    found: dict[tuple[float, float], Finding] = {}
    for face in faces_of(mesh):
        if face.kind != "cylinder" or not face.hollow or 2 * face.radius >= NARROW_MM:
            continue
        depth, width = float(np.ptp(face.corners @ face.axis)), 2 * face.radius
        if depth > DEEPEST * width and _goes_round(face):
            found[round(width, 3), round(depth, 1)] = Finding(
                code="W_BORE_NARROW",
                where=f"parts.{part}",
                parts=(part,),
                message=f"{part} has a bore {width:.3g} mm wide and {depth:.3g} mm deep: it can neither be drilled nor printed.",
                hint=f"Widen it to at least {NARROW_MM:g} mm, or leave it out. Were inches given? Then it is {25.4 * width:.4g} mm wide."
                f"{_stated(width, lengths or {})}",
                value=width,
                limit=NARROW_MM,
                unit="mm",
            )
    return Findings(found.values())


def _stated(width: float, lengths: Mapping[str, float]) -> str:
    """Return the advice to change the number that states a width, as a radius or a diameter; empty if none does."""
    stating = [address for address, value in lengths.items() for times in (1, 2) if abs(times * value - width) < _ROUNDING * width]
    return f" Set {stating[0]} to {25.4 * lengths[stating[0]]:.6g}, which states it." if stating else ""


def _findings(part: str, connectors: Mapping[str, Connector], mesh: TriMesh, order: Order | None) -> Iterator[Finding]:
    for name, connector in connectors.items():
        if connector.kind not in _NAMES:
            continue
        faces = [face.moved(connector.frame.inverse().matrix) for face in faces_of(mesh)]
        if any(_is_round(face) for face in faces):
            continue
        if connector.kind not in _AXES and (any(_is_seat(face) for face in faces) or _is_in_material(connector, mesh)):
            continue
        place = "about its axis" if connector.kind in _AXES else "at its place"
        finding = Finding(
            code="W_CONNECTOR_FEATURE",
            where=f"parts.{part}.connectors.{name}",
            parts=(part,),
            message=f"Connector {name!r} of {part} is {'an' if connector.kind[0] in 'aeiou' else 'a'} {connector.kind}, "
            f"but the part has nothing {place} that could be {_NAMES[connector.kind]}.",
            hint=f"Build {_NAMES[connector.kind]} of the part there; is a shape on the other side of a plane, or in another unit?",
        )
        near = _nearest(connector, faces) if connector.kind in _AXES else None
        yield finding if near is None else _with_nearest(finding, name, connector, near, order)


def _nearest(connector: Connector, faces: Sequence[Face]) -> _Beside | None:
    """Return the cylinder parallel to a connector's axis that is nearest to it, of those that go round by more than half; None if there is none.

    For a bore, it is hollow.
    """
    found = []
    for face in faces:
        suits = face.kind == "cylinder" and (face.hollow or connector.kind != "bore_axis")
        if suits and _is_upright(face) and _goes_round(face, _HALF):
            x, y = at_height(face, 0.0)
            found.append(_Beside(2 * face.radius, math.hypot(x, y), np.asarray(connector.frame.apply([x, y, 0.0]))))
    return min(found, key=lambda one: one.distance, default=None)


def _with_nearest(finding: Finding, name: str, connector: Connector, near: _Beside, order: Order | None) -> Finding:
    """Return a finding that states the nearest cylinder, sent to the designer if the part's dimensions put it there, and not the connector."""
    (part,) = finding.parts
    message = f"{finding.message} The nearest, {near.width:.4g} mm wide, is {near.distance:.4g} mm beside it."
    if order is None or name not in order.stated:
        return replace(finding, message=message)
    ordered = np.asarray(connector.frame.translation)
    differing = np.flatnonzero(np.abs(near.origin - ordered) > _ROUNDING_MM)
    built, stated = (sum(_remoteness(float(place[axis]), order.lengths) for axis in differing) for place in (near.origin, ordered))
    if built >= stated:
        return replace(finding, message=message)
    there = ", ".join(f"{value:.10g}" for value in order.stated[name].apply(near.origin).round(4) + 0.0)
    hint = (
        f"The dimensions of {part} put it there: set o of {part}.{name} to ({there}). If the connector is right, change these dimensions."
    )
    return replace(finding, message=message, route="design", hint=hint)


def _remoteness(value: float, lengths: Mapping[str, float]) -> int:
    """Return how far a coordinate is from the dimensions: 0 for zero, 1 for a dimension or half of one, 2 for a sum or difference, else 3."""
    if abs(value) < _ROUNDING_MM:
        return 0
    terms = np.array(
        [sign * share * length for length in lengths.values() for sign in (1.0, -1.0) for share in (1.0, 0.5)], dtype=np.float64
    )
    if (np.abs(terms - value) < _ROUNDING_MM).any():
        return 1
    return 2 if (np.abs(terms[:, None] + terms - value) < _ROUNDING_MM).any() else 3


def _is_round(face: Face) -> bool:
    """Return whether a face goes round the z axis, or may do so."""
    if face.kind == "cylinder":
        return _is_upright(face) and float(np.linalg.norm(at_height(face, 0.0))) < DRIFT_RADIAL_MM
    points = face.corners.reshape(-1, 3)[:, :2]
    return face.kind == "other" and bool((points.min(axis=0) <= 0.0).all() and (points.max(axis=0) >= 0.0).all())


def _goes_round(face: Face, most: float = _CLOSED) -> bool:
    """Return whether a cylinder is closed: its normals cancel, those of a fillet do not."""
    normals = face.normals_of_twice_area
    return float(np.linalg.norm(normals.sum(axis=0))) < most * float(np.linalg.norm(normals, axis=1).sum())


def _is_upright(face: Face) -> bool:
    return float(np.hypot(face.axis[0], face.axis[1])) < DRIFT_ANGLE


def _is_seat(face: Face) -> bool:
    """Return whether a face lies in the plane z = 0."""
    return face.kind == "plane" and _is_upright(face) and abs(float(face.point[2])) < DRIFT_RADIAL_MM


def _is_in_material(connector: Connector, mesh: TriMesh) -> bool:
    """Return whether a connector's origin is on the surface of the part, or inside it."""
    corners = mesh.vertices[mesh.triangles]
    around = connector.frame.translation + DRIFT_RADIAL_MM * np.vstack([np.eye(3), -np.eye(3)])
    return bool((winding_numbers(around, corners) > 0.5).any())
