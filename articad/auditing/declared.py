"""The declarations of a file, before any reader changes them: links with inertias and shapes as stated, joints with their numbers.

Lengths are mm, angles rad, masses kg, as everywhere; what a file omits is None.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.interference.relations import Groups
from articad.kinematics.joints import JointType

Role = Literal["visual", "collision"]

MOVING = ("revolute", "continuous", "prismatic", "planar", "floating", "spherical", "screw")


@dataclass(frozen=True, eq=False)
class DeclaredInertial:
    """Mass properties as declared, even if impossible.

    Attributes:
        mass: [kg]; None if the file gives none.
        com: Centre of mass in the link's frame, `(3,)` [mm].
        inertia: About the centre, along the link's axes, `(3, 3)` [kg·mm²]; None if the file gives none.
    """

    mass: float | None
    com: FloatArray
    inertia: FloatArray | None


@dataclass(frozen=True, eq=False)
class DeclaredShape:
    """A shape of a link.

    Attributes:
        role: "visual", "collision" or another purpose.
        kind: "box", "cylinder", "sphere", "mesh", "geom" (one of MuJoCo's) or another type that the file names.
        where: Place in the file.
        mesh: In the link's frame [mm]; None if it could not be read.
        file: Name of the mesh file in the file.
        scale: Scale of the mesh file, metres per unit.
        problem: Why there is no mesh: "absent", "unreadable", "format", "unsafe" or "".
        reason: The same in words.
    """

    role: Role
    kind: str
    where: str
    mesh: TriMesh | None = None
    file: str | None = None
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    problem: str = ""
    reason: str = ""


@dataclass(frozen=True, eq=False)
class DeclaredLink:
    """A link, body or part."""

    name: str
    where: str
    inertial: DeclaredInertial | None = None
    shapes: tuple[DeclaredShape, ...] = ()

    def of(self, role: Role) -> tuple[DeclaredShape, ...]:
        """Return its shapes of one role."""
        return tuple(shape for shape in self.shapes if shape.role == role)

    @cached_property
    def points(self) -> FloatArray:
        """Vertices of all its shapes in its frame, `(n, 3)` [mm]."""
        found = [shape.mesh.vertices for shape in self.shapes if shape.mesh is not None]
        return np.concatenate(found) if found else np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class DeclaredJoint:
    """A joint; `lower` to `velocity` in rad, mm, N·m and N, None if the file gives none."""

    name: str
    where: str
    type: str
    parent: str
    child: str
    frame: SE3 | None = None
    lower: float | None = None
    upper: float | None = None
    effort: float | None = None
    velocity: float | None = None
    mimics: str | None = None

    @property
    def moves(self) -> bool:
        """True unless it is fixed."""
        return self.type in MOVING

    @property
    def turns(self) -> bool:
        """True if its coordinate is an angle."""
        return self.type in {"revolute", "continuous"}


@dataclass(frozen=True, eq=False)
class Declared:
    """A whole file.

    Attributes:
        format: "urdf", "mjcf", "freecad", "step" or "plan".
        name: Name of the robot.
        links: In the file's order.
        joints: In the file's order.
        states_inertia: False if the format leaves masses to others, as CAD does.
        states_collision: False if a part's solid is its collision shape.
        states_frames: True if the file itself says where its base stands and where each joint rests, as articad's own records do: then
            neither a base above the lowest point nor a range without zero is an oversight. False for files that were only converted.
    """

    format: str
    name: str
    links: tuple[DeclaredLink, ...]
    joints: tuple[DeclaredJoint, ...]
    states_inertia: bool = True
    states_collision: bool = True
    states_frames: bool = False

    @cached_property
    def by_name(self) -> dict[str, DeclaredLink]:
        """Links by name, the first of each."""
        found: dict[str, DeclaredLink] = {}
        for link in self.links:
            found.setdefault(link.name, link)
        return found

    @cached_property
    def roots(self) -> tuple[str, ...]:
        """Links that no joint carries."""
        carried = {joint.child for joint in self.joints}
        return tuple(name for name in self.by_name if name not in carried)

    @cached_property
    def rigid_groups(self) -> dict[str, tuple[str, ...]]:
        """Names of the links that fixed joints connect with each link, itself included."""
        return {name: names for names in self.rigid.sets() for name in names}

    @cached_property
    def rigid(self) -> Groups:
        """Links that fixed joints make one body."""
        groups = Groups(self.by_name)
        for joint in self.joints:
            if joint.type == "fixed":
                groups.join(joint.parent, joint.child)
        return groups

    @cached_property
    def moving_groups(self) -> tuple[tuple[str, ...], ...]:
        """Rigid groups that a joint moves: all but those of the roots."""
        standing = {self.rigid.leader(name) for name in self.roots}
        return tuple(names for names in self.rigid.sets() if self.rigid.leader(names[0]) not in standing)

    @cached_property
    def tied(self) -> frozenset[str]:
        """Names of joints that follow another, or that another follows: a stop of one is a stop of both."""
        return frozenset(name for joint in self.joints if joint.mimics is not None for name in (joint.name, joint.mimics))

    def fixed_poses(self, name: str) -> dict[str, SE3]:
        """Return the poses of the links that are fixed to a link, in its frame, including itself."""
        return self._placed(name, self._fixed_ways)

    def poses(self) -> dict[str, SE3]:
        """Return the pose of each link with every joint at zero, in the frame of the first root; unreachable links are left out."""
        return self._placed(self.roots[0], self._ways) if self.roots else {}

    @cached_property
    def _ways(self) -> dict[str, list[tuple[str, SE3]]]:
        """For each link, the links that its joints carry, and their poses."""
        ways: dict[str, list[tuple[str, SE3]]] = {}
        for joint in self.joints:
            if joint.frame is not None:
                ways.setdefault(joint.parent, []).append((joint.child, joint.frame))
        return ways

    @cached_property
    def _fixed_ways(self) -> dict[str, list[tuple[str, SE3]]]:
        """For each link, the links fixed to it, in both directions, and their poses."""
        ways: dict[str, list[tuple[str, SE3]]] = {}
        for joint in self.joints:
            if joint.type == "fixed" and joint.frame is not None and {joint.parent, joint.child} <= self.by_name.keys():
                ways.setdefault(joint.parent, []).append((joint.child, joint.frame))
                ways.setdefault(joint.child, []).append((joint.parent, joint.frame.inverse()))
        return ways

    @staticmethod
    def _placed(start: str, ways: dict[str, list[tuple[str, SE3]]]) -> dict[str, SE3]:
        found, queue = {start: SE3.identity()}, [start]
        for near in queue:
            for far, T_near_far in ways.get(near, ()):
                if far not in found:
                    found[far] = found[near] @ T_near_far
                    queue.append(far)
        return found


def from_assembly(
    assembly: Assembly, format_name: str, *, states_inertia: bool, states_collision: bool, simple: frozenset[str] = frozenset()
) -> Declared:
    """Return the declarations of an assembly, for formats whose readers keep everything; `simple` parts have shapes that are not meshes."""
    links = tuple(_link(part, "geom" if part.name in simple else "mesh") for part in assembly.parts.values())
    return Declared(format_name, assembly.name, links, tuple(_joints(assembly)), states_inertia, states_collision)


def _link(part: Part, kind: str) -> DeclaredLink:
    where = f"parts.{part.name}"
    inertial = None if part.mass is None else DeclaredInertial(part.mass.mass, part.mass.com, part.mass.inertia)
    visuals = [DeclaredShape("visual", kind, where, shape.placed) for shape in part.visuals]
    collisions = [DeclaredShape("collision", kind, where, shape.placed) for shape in part.collisions]
    return DeclaredLink(part.name, where, inertial, (*visuals, *collisions))


def _joints(assembly: Assembly) -> Iterator[DeclaredJoint]:
    tied = {a: b for coupling in assembly.mechanism.couplings for a, b in ((coupling.a, coupling.b), (coupling.b, coupling.a))}
    for joint in assembly.joints:
        names = joint.column_names if joint.type.quaternion is None else ()
        ends = (joint.parent, joint.child)
        if not names:
            kind = {JointType.BALL: "spherical", JointType.FREE: "floating"}.get(joint.type, "fixed")
            frame = joint.T_parent_connector @ joint.T_child_connector.inverse() if kind == "fixed" else None
            yield DeclaredJoint(joint.name, f"joints.{joint.name}", kind, *ends, frame)
        for index, (name, unit) in enumerate(zip(names, joint.type.units, strict=False)):
            kind = "screw" if joint.type is JointType.SCREW else "revolute" if unit == "rad" else "prismatic"
            lower, upper = joint.limits.lower[index], joint.limits.upper[index]
            if kind == "revolute" and math.isinf(lower) and math.isinf(upper):
                kind = "continuous"
            yield DeclaredJoint(name, f"joints.{name}", kind, *ends, lower=_finite(lower), upper=_finite(upper), mimics=tied.get(name))


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
