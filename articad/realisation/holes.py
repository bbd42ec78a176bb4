"""Holes of two parts that are fixed to each other: those that open where their faces touch must meet, or one of them faces solid material.

A hole is a cylindrical face all round, normal to the plane of contact, with those that continue it about the same axis. One that faces
solid material is no fault by itself: it may be blind or save weight. It is one if a hole of the other part faces solid material beside it.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np

from articad.arrays import BoolArray, FloatArray
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.geometry.faces import Face, faces_of
from articad.interference.gauge import placed
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint, JointType
from articad.realisation.bores import TILT, along

__all__ = ["TOUCH_MM", "HolesApart", "OpenHole", "holes_apart", "lost_holes", "point_text"]

TOUCH_MM: Final = 0.05  # surfaces of a fixed joint this close are one
COAXIAL_MM: Final = 0.2  # beyond half the difference of two diameters
_ALIKE: Final = 2.0  # ratio of the diameters of two holes for one screw or pin
_REACH_MM: Final = 6.0  # beyond the larger diameter: axes of two holes that should meet are apart by no more
_EDGE: Final = 1e-6  # of barycentric coordinates
_AROUND: Final = 32  # points of a rim
_OPEN_RAD: Final = 1.2  # largest angle that a face may leave out of a full circle
_FLARE: Final = 1.8  # by which a chamfer widens a hole at most, over its depth: a cone of 120°
_SAME_MM: Final = 0.02  # axes this close are one
_THREAD: Final = 0.7  # of a hole's radius: least radius of what fills it


class OpenHole(NamedTuple):
    """A round hole of a part that opens in a plane.

    Attributes:
        part: Its part.
        place: Where its axis meets the plane, `(3,)` in the part's frame [mm].
        partner: The point of this part that lies where the other part's hole opens, `(3,)` in the part's frame [mm].
        diameter: Least diameter along it [mm].
    """

    part: str
    place: FloatArray
    partner: FloatArray
    diameter: float


class HolesApart(NamedTuple):
    """A hole of a joint's parent and one of its child that should meet.

    Attributes:
        parent: The parent's.
        child: The child's.
        distance: Of their axes [mm].
        allowed: Largest distance at which they meet [mm].
    """

    parent: OpenHole
    child: OpenHole
    distance: float
    allowed: float


class _Opening(NamedTuple):
    """A hole in the frame of the parent: where its axis meets the plane `(3,)`, its first radius, its least one, its depth, and how deep its chamfer is [mm]."""

    point: FloatArray
    radius: float
    least: float
    depth: float
    chamfer: float

    def allows(self, other: _Opening) -> float:
        """Return the largest distance of the axes at which two holes meet [mm]."""
        return abs(self.least - other.least) + COAXIAL_MM

    def is_met_by(self, other: _Opening) -> bool:
        """Return whether two holes meet: they have one axis, or this one opens inside one of another kind."""
        apart = float(np.linalg.norm(self.point - other.point))
        return apart <= self.allows(other) or (not self.is_like(other) and apart + self.radius <= other.radius)

    def is_like(self, other: _Opening) -> bool:
        return max(self.least, other.least) <= _ALIKE * min(self.least, other.least)


def lost_holes(scene: Scene, poses: Mapping[str, SE3], joint: Joint) -> Iterator[Finding]:
    """Yield a finding if holes of the parts of a fixed joint should meet and do not; arguments as for `holes_apart`."""
    found = holes_apart(scene, poses, joint)
    if not found:
        return
    several = [
        f"{one.parent.part}'s of {one.parent.diameter:.4g} mm at {point_text(one.parent.place)} and {one.child.part}'s of {one.child.diameter:.4g} mm "
        f"at {point_text(one.child.place)}, {one.distance:.3g} mm apart"
        for one in found
    ]
    worst = max(found, key=lambda one: one.distance)
    yield Finding(
        code="W_HOLES_APART",
        where=f"joints.{joint.name}",
        parts=(joint.parent, joint.child),
        message=f"Holes where {joint.parent} and {joint.child} touch do not meet, and both face solid material: {'; '.join(several)} "
        "(points in each part's own frame).",
        hint=f"Move the hole of {worst.child.part} to {point_text(worst.child.partner)}, or that of {worst.parent.part} to "
        f"{point_text(worst.parent.partner)}. Leave both if they are not meant for each other.",
        value=worst.distance,
        limit=worst.allowed,
        unit="mm",
    )


def holes_apart(scene: Scene, poses: Mapping[str, SE3], joint: Joint) -> list[HolesApart]:
    """Return pairs of holes of a fixed joint's two parts that do not meet where their faces touch, each facing solid material.

    Args:
        scene: Bodies and relations.
        poses: Poses of the parts at rest. A hole that a pin or screw of any part fills needs no other hole.
        joint: The joint. Other than fixed ones have no such holes.
    """
    names = (joint.parent, joint.child)
    if joint.type is not JointType.FIXED or any(name not in scene.meshes for name in names):
        return []
    T = placed(joint, [])  # of the child, in the parent's frame
    faces = faces_of(scene.meshes[joint.parent]), [face.moved(T) for face in faces_of(scene.meshes[joint.child])]
    if not all(any(face.kind == "cylinder" and face.hollow for face in side) for side in faces):
        return []
    touch = TOUCH_MM + sum(scene.deflections.get(name, 0.0) for name in names)
    found: list[HolesApart] = []
    for contact in _contacts(*faces, touch):
        ways = contact.normal, -contact.normal
        openings = [list(_openings(side, *each, touch)) for side, each in zip(faces, zip(contact.planes, ways, strict=True), strict=True)]
        unmet = [
            [hole for hole in openings[k] if _faces_solid(hole, contact.planes[1 - k], openings[1 - k], contact.normal)] for k in (0, 1)
        ]
        if all(unmet):
            unmet = [[hole for hole in unmet[k] if not _is_filled(hole, ways[k], scene, poses, joint.parent)] for k in (0, 1)]
        found += [_apart(joint, a, b, contact.normal, T) for a, b in _nearest(*unmet)]
    return found


class _Contact(NamedTuple):
    """Where plane faces of two parts touch: the outward normal of the first part, and the faces of both in that plane."""

    normal: FloatArray
    planes: tuple[list[Face], list[Face]]


def _contacts(first: Sequence[Face], second: Sequence[Face], touch: float) -> list[_Contact]:
    found: list[_Contact] = []
    flat = [face for face in second if face.kind == "plane"]
    for face in first:
        if face.kind != "plane":
            continue
        against = [
            other for other in flat if face.axis @ other.axis <= -1 + TILT**2 / 2 and abs(face.axis @ (other.point - face.point)) <= touch
        ]
        for contact in found if against else ():
            if face.axis @ contact.normal >= 1 - TILT**2 / 2 and abs(face.axis @ (contact.planes[0][0].point - face.point)) <= touch:
                contact.planes[0].append(face)
                contact.planes[1].extend(other for other in against if other not in contact.planes[1])
                break
        else:
            if against:
                found.append(_Contact(face.axis, ([face], against)))
    return found


def _openings(faces: Sequence[Face], planes: Sequence[Face], way: FloatArray, touch: float) -> Iterator[_Opening]:
    """Yield the holes of a part that open in one of its planes, whose outward normal is `way`."""
    height = float(planes[0].point @ way)
    walls: list[tuple[FloatArray, list[Face]]] = []  # of one axis, by the point where it meets the plane
    for face in faces:
        if face.kind == "cylinder" and face.hollow and np.linalg.norm(np.cross(face.axis, way)) < TILT:
            point = face.point + (height - face.point @ way) / (face.axis @ way) * face.axis
            known = [group for at, group in walls if np.linalg.norm(at - point) <= _SAME_MM]
            known[0].append(face) if known else walls.append((point, [face]))
    for point, group in walls:
        bottom, radius, least, chamfer = height, 0.0, np.inf, 0.0
        for face in sorted(group, key=lambda one: -along(one, way)[1]):
            low, high = along(face, way)
            same = [one for one in group if abs(one.radius - face.radius) < _SAME_MM]
            if high > height + touch or bottom - high > max(touch, face.radius) or not _is_full(same):
                continue
            chamfer = chamfer if radius else height - high
            bottom, radius, least = min(bottom, low), radius or face.radius, min(least, face.radius)
        if radius and not _covers(planes, point[None], way).any():
            yield _Opening(point, radius, float(least), height - bottom, chamfer)


def _is_full(walls: Sequence[Face]) -> bool:
    """Return whether faces of one cylinder go all round."""
    axis, points = walls[0].axis, np.concatenate([one.corners.reshape(-1, 3) for one in walls]) - walls[0].point
    x = np.cross(np.eye(3)[int(np.abs(axis).argmin())], axis)
    angles = np.sort(np.arctan2(points @ np.cross(axis, x), points @ x))
    return bool(np.diff(angles, append=angles[0] + 2 * np.pi).max() <= _OPEN_RAD)


def _faces_solid(hole: _Opening, planes: Sequence[Face], others: Sequence[_Opening], normal: FloatArray) -> bool:
    """Return whether a hole opens inside the faces of the other part, holes there included, and meets none of these."""
    if any(hole.is_met_by(other) for other in others):
        return False
    angles = 2 * np.pi * np.arange(_AROUND) / _AROUND
    x = np.cross(np.eye(3)[int(np.abs(normal).argmin())], normal)
    x /= np.linalg.norm(x)
    rim = hole.point + hole.radius * (np.cos(angles)[:, None] * x + np.sin(angles)[:, None] * np.cross(normal, x))
    covered = _covers(planes, rim, normal)
    for other in others:
        covered |= np.linalg.norm(rim - other.point, axis=1) <= other.radius + _FLARE * max(other.chamfer, 0.0) + COAXIAL_MM
    return bool(covered.all())


def _covers(planes: Sequence[Face], points: FloatArray, normal: FloatArray) -> BoolArray:
    """Return which points lie in faces that are normal to a direction, seen along it, `(N,)`."""
    corners = np.concatenate([face.corners for face in planes])
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.cross(e1, e2) @ normal
    area = np.where(np.abs(area) > 1e-12, area, np.inf)
    s = points[:, None] - a
    u, v = (np.cross(s, e2) @ normal) / area, (np.cross(e1, s) @ normal) / area
    return np.asarray(((u >= -_EDGE) & (v >= -_EDGE) & (u + v <= 1 + _EDGE) & np.isfinite(area)).any(axis=1))


def _is_filled(hole: _Opening, way: FloatArray, scene: Scene, poses: Mapping[str, SE3], parent: str) -> bool:
    """Return whether a pin, screw or shaft of any part lies in a hole; `way` points out of it."""
    for name in (name for name in scene.meshes if name in poses):
        T = np.asarray((poses[parent].inverse() @ poses[name]).matrix)
        for face in faces_of(scene.meshes[name]):
            if face.kind != "cylinder" or face.hollow or not _THREAD * hole.least <= face.radius <= hole.radius + COAXIAL_MM:
                continue
            pin = face.moved(T)
            (low, high), top = along(pin, way), float(hole.point @ way)
            aside = np.linalg.norm(np.cross(pin.axis, hole.point - pin.point))
            parallel = np.linalg.norm(np.cross(pin.axis, way)) < TILT
            if parallel and aside <= hole.radius - face.radius + 2 * COAXIAL_MM and low < top and high > top - hole.depth:
                return True
    return False


def _nearest(first: Sequence[_Opening], second: Sequence[_Opening]) -> Iterator[tuple[_Opening, _Opening]]:
    """Yield pairs of holes of two parts that were meant for each other: alike and near, the nearest first, each hole once."""
    near = []
    for (i, a), (j, b) in itertools.product(enumerate(first), enumerate(second)):
        distance = float(np.linalg.norm(a.point - b.point))
        if a.is_like(b) and distance <= _REACH_MM + 2 * max(a.least, b.least):
            near.append((distance, i, j))
    used: set[tuple[int, int]] = set()
    for _, i, j in sorted(near):
        if not {(0, i), (1, j)} & used:
            used |= {(0, i), (1, j)}
            yield first[i], second[j]


def _apart(joint: Joint, a: _Opening, b: _Opening, normal: FloatArray, T: FloatArray) -> HolesApart:
    across = b.point - a.point
    across = across - (across @ normal) * normal
    back = np.linalg.inv(T)
    at_b, to_b = (back[:3, :3] @ point + back[:3, 3] for point in (b.point, b.point - across))
    parent = OpenHole(joint.parent, a.point, a.point + across, 2 * a.least)
    return HolesApart(parent, OpenHole(joint.child, at_b, to_b, 2 * b.least), float(np.linalg.norm(across)), a.allows(b))


def point_text(place: FloatArray) -> str:
    """Return a point such as `(-14.5, 0, 22)`, `(3,)` [mm]."""
    return f"({', '.join(f'{round(float(value), 2) + 0.0:g}' for value in place)})"
