"""Check of gears that are drawn with their teeth: wherever one is held, the teeth hold the other."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations, permutations
from typing import Final, Literal

import numpy as np
import trimesh

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.interference.surface import surface_distance, whole_surface
from articad.kinematics.joints import Joint, JointType
from articad_bench.bodies import parts_of
from articad_bench.check import Check
from articad_bench.subject import Subject

PLACES: Final = 73  # of a driver, along a turn of the larger wheel
ALIKE: Final = 0.01  # share by which the ratio of two wheels may differ from that of their teeth
STILL: Final = 1e-6  # rad
MET_MM: Final = 1e-6
LEAN: Final = 0.04  # of the pitch
RIM: Final = 0.98  # of the radius of a wheel's tips


class Meshes(Check):
    """Two wheels have so many teeth, and these mesh all the way round: while one is held, the other cannot turn by half a tooth, and could stand a whole tooth on.

    Both turn about axes that the ground holds, and one drives the other. A wheel whose teeth are missing somewhere, or that has none, turns freely there.
    The two flanks of its teeth are mirror images: a wheel of saw teeth meshes as well, and is none.
    """

    kind: Literal["meshes"] = "meshes"
    teeth: tuple[int, int]

    @property
    def wanted(self) -> str:
        return f"teeth of wheels with {self.teeth[0]} and {self.teeth[1]} of them mesh wherever they are"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [self._wrong(subject, *pair) for pair in self._pairs(subject)]
        told = ", ".join(f"at {wrong} of {2 * PLACES} places" for wrong in found)
        return (
            0 in found,
            f"teeth do not hold a wheel, or are in the way of one that is turned by a tooth, {told}" if found else "no such wheels",
        )

    def _wrong(self, subject: Subject, first: Joint, second: Joint, poses: list[dict[str, SE3]]) -> int:
        """Return at how many places one of two wheels is free where teeth should stop it, or stopped where it should stand as before; all if its teeth lean."""
        sides = ((first, second, self.teeth[0]), (second, first, self.teeth[1]))
        if any(lean(subject, wheel, teeth) > LEAN for wheel, _, teeth in sides):
            return 2 * PLACES
        return sum(not _is_held(subject, wheel, other, math.tau / teeth, place) for wheel, other, teeth in sides for place in poses)

    def _pairs(self, subject: Subject) -> Iterator[tuple[Joint, Joint, list[dict[str, SE3]]]]:
        """Yield the joints of two such wheels, and the poses of all parts over a turn of the larger one."""
        assembly = subject.assembly
        ground = subject.rigid[assembly.ground]
        wheels = [
            joint
            for joint in assembly.joints
            if joint.type is JointType.REVOLUTE and ground in {subject.rigid[joint.parent], subject.rigid[joint.child]}
        ]
        for column, driver in enumerate(assembly.drivers):
            reached = subject.driver_range(driver.name, turns=max(self.teeth) / min(self.teeth))
            if reached is None:
                continue
            points = np.linspace(*reached, PLACES)
            turned = {joint.name: float(np.ptp(subject.values(joint.name, driver.name, points))) for joint in wheels}
            q = np.repeat(np.array(assembly.mechanism.rest)[None], PLACES, axis=0)
            q[:, column] = points
            for first, second in permutations(wheels, 2):
                passed = turned[first.name] * self.teeth[0], turned[second.name] * self.teeth[1]
                if min(passed) > STILL and abs(passed[0] - passed[1]) <= ALIKE * passed[0]:
                    yield first, second, [dict(zip(assembly.mechanism.parts, assembly.poses(row), strict=True)) for row in q]


def lean(subject: Subject, wheel: Joint, teeth: int) -> float:
    """Return by how much the middles of a wheel's teeth lie aside from each other at three heights, as a share of the pitch; 0 where no teeth are found.

    With a module `m = 2 R / (z + 2)`, flanks are met on circles of radius `R - m / 2`, `R - m` and `R - 3 m / 2`, in a section square to the axis.
    """
    axis = wheel.T_parent_connector.inverse() @ subject.rest[wheel.parent].inverse()
    bodies = [
        trimesh.Trimesh(mesh.transformed(axis @ subject.rest[name]).vertices, mesh.triangles, process=False)
        for name, mesh in _shapes(subject, wheel)
    ]
    widest = max(bodies, key=lambda body: float(np.hypot(*body.vertices[:, :2].T).max()))
    radii = np.hypot(*widest.vertices[:, :2].T)
    tips = widest.vertices[radii > RIM * radii.max(), 2]
    lines, faces = trimesh.intersections.mesh_plane(widest, (0, 0, 1), (0, 0, float(tips.min() + tips.max()) / 2), return_faces=True)
    module = 2 * float(radii.max()) / (teeth + 2)
    middles = [
        _middle(lines[:, :, :2], widest.face_normals[faces, :2], float(radii.max()) - depth * module, teeth) for depth in (0.5, 1.0, 1.5)
    ]
    found = [middle for middle in middles if middle is not None]
    return max((abs(np.angle(a / b)) / math.tau for a, b in combinations(found, 2)), default=0.0)


def _middle(lines: FloatArray, normals: FloatArray, radius: float, teeth: int) -> complex | None:
    """Return the direction of the middles of teeth on a circle, turned by the number of teeth; None if there are not so many of both flanks.

    Args:
        lines: Of the section, `(N, 2, 2)` [mm].
        normals: Outwards, `(N, 2)`.
        radius: Of the circle [mm].
        teeth: How many there are.
    """
    inside = np.hypot(lines[..., 0], lines[..., 1]) < radius
    a, b, n = (each[inside[:, 0] != inside[:, 1]] for each in (lines[:, 0], lines[:, 1], normals))
    d = b - a
    # |a + t d| = r on the way from inside to outside: t = (-a·d ± √((a·d)² - d² (a² - r²))) / d²
    half, square = (a * d).sum(axis=1), (d * d).sum(axis=1)
    root = np.sqrt(np.maximum(half**2 - square * ((a * a).sum(axis=1) - radius**2), 0.0))
    t = (-half + np.where(inside[inside[:, 0] != inside[:, 1], 0], root, -root)) / square
    points = a + t[:, None] * d
    ahead = points[:, 0] * n[:, 1] - points[:, 1] * n[:, 0] > 0  # the flank that faces the way of the angle
    turned = np.exp(1j * teeth * np.arctan2(points[:, 1], points[:, 0]))
    if not ahead.sum() == (~ahead).sum() == teeth:
        return None
    behind, before = turned[~ahead].mean(), turned[ahead].mean()
    return complex(behind * np.exp(0.5j * (np.angle(before / behind) % math.tau)) / abs(behind))


def _is_held(subject: Subject, wheel: Joint, other: Joint, tooth: float, place: dict[str, SE3]) -> bool:
    """Return whether a wheel meets another one when it is turned by half a tooth, and does not when turned by a whole one [rad]."""
    axis = place[wheel.parent] @ wheel.T_parent_connector
    for part_of, meets in ((0.5, True), (-0.5, True), (1.0, False), (-1.0, False)):
        turn = axis @ SE3.rot_z(part_of * tooth) @ axis.inverse()
        pairs = ((one, another) for one in _parts(subject, wheel) for another in _parts(subject, other))
        if any(_meet(subject, one, turn @ place[one], another, place[another]) for one, another in pairs) is not meets:
            return False
    return True


def _parts(subject: Subject, joint: Joint) -> list[str]:
    """Return the parts of the body that a joint holds on the ground."""
    ground = subject.rigid[subject.assembly.ground]
    (body,) = {subject.rigid[joint.parent], subject.rigid[joint.child]} - {ground}
    return parts_of(subject, body)


def _shapes(subject: Subject, joint: Joint) -> list[tuple[str, TriMesh]]:
    """Return the parts with a shape of the body that a joint holds on the ground."""
    shapes = ((name, subject.assembly.parts[name].mesh) for name in _parts(subject, joint))
    return [(name, mesh) for name, mesh in shapes if mesh is not None]


def _meet(subject: Subject, a: str, T_a: SE3, b: str, T_b: SE3) -> bool:
    meshes = [subject.assembly.parts[name].mesh for name in (a, b)]
    surfaces = [whole_surface(mesh) for mesh in meshes if mesh is not None]
    return surface_distance(surfaces[0], surfaces[1], (T_a.inverse() @ T_b).matrix) <= MET_MM
