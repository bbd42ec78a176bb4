"""What checks look at: an assembly made by anyone, in any format that articad reads; measurements are cached."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from pathlib import Path
from typing import Final

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from articad.arrays import FloatArray
from articad.assembly import Assembly, Poses
from articad.certificates.fits import FitReport, check_fits, followed
from articad.connectors import SE3
from articad.errors import ArticadError
from articad.geometry.mass import MassProperties
from articad.interference.check import check_scene
from articad.interference.report import Checks
from articad.interference.scene import Scene
from articad.interference.surface import surface_distance, whole_surface
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.motion import FeasibleRange
from articad_bench.solids import boxes_by_faces

WATER: Final = 1000.0  # kg/m³
_TURNING_TOO: Final = frozenset({JointType.CYLINDRICAL, JointType.UNIVERSAL, JointType.PLANAR})
_SLIDING = frozenset({JointType.SLIDER, JointType.CYLINDRICAL, JointType.PLANAR})
_SAME_DIGITS: Final = 6  # of mm
_ASIDE: Final = {str(kind): {"x", "y"} for kind in JointType} | {
    str(JointType.BALL): {"x", "y", "z"},
    str(JointType.UNIVERSAL): {"x", "y", "z"},
    str(JointType.PLANAR): {"z"},
    str(JointType.SLIDER): {"x", "y"},
}  # directions in which a body must not be free to leave its joint

_SOUND: Final = ("declared limit", "limit of", "endless")  # what may end the range of a driver without a dead point
DEAD: Final = 1e-3  # of a driver's range, by which its values keep away from a dead point


@dataclass(frozen=True)
class Subject:
    """An assembly under check.

    Attributes:
        assembly: Made by articad, or read from a file of any tool; its own waivers of overlaps do not count.
        before: The same product before an edit, if there was one.
        file: URDF or MJCF that it was read from: what a simulator is given, as it is.
    """

    assembly: Assembly
    before: Assembly | None = None
    file: Path | None = None

    def __post_init__(self) -> None:
        if self.assembly.waivers:  # whoever is judged does not say what is allowed
            object.__setattr__(self, "assembly", replace(self.assembly, waivers=()))
        object.__setattr__(self, "assembly", _cranked(self.assembly))

    def turned(self, quarters: int) -> Subject:
        """Return the product, and what was there before, turned by quarters about the upright axis; its file stays as it is."""
        turn = SE3.rot_z(quarters * math.pi / 2)

        def other(assembly: Assembly) -> Assembly:
            known = assembly.mechanism
            return replace(assembly, mechanism=known.changed(T_ground=turn @ known.T_ground))

        return replace(self, assembly=other(self.assembly), before=None if self.before is None else other(self.before))

    @cached_property
    def rest(self) -> Poses:
        """Where the parts are at rest."""
        mechanism = self.assembly.mechanism
        return Poses(mechanism.parts, self.assembly.poses(mechanism.rest))

    @cached_property
    def at_rest(self) -> Checks:
        """Interference at rest; declared fits are not checked."""
        return check_scene(self.scene, self.assembly.at(), ground=self.assembly.ground)

    @cached_property
    def declared(self) -> FitReport:
        """Declared fits, compared with measurements at rest and over the motion of their joints."""
        return check_fits(self.scene, followed(self.assembly.mechanism))

    @cached_property
    def scene(self) -> Scene:
        """Bodies and relations, for measurements of interference."""
        return self.assembly.scene()

    @cached_property
    def shaped(self) -> tuple[str, ...]:
        """Names of the parts that have a shape: links without a shape have no material."""
        return tuple(name for name, part in self.assembly.parts.items() if part.mesh is not None)

    @cached_property
    def size(self) -> FloatArray:
        """Sides of the box around the whole at rest, along the axes `(3,)` [mm]."""
        return np.asarray(np.ptp(self.corners(self.rest), axis=0))

    def corners(self, poses: Mapping[str, SE3], parts: Sequence[str] | None = None) -> FloatArray:
        """Return the ends of the whole, or of some of its parts, `(2, 3)` [mm]."""
        chosen = self.shaped if parts is None else parts
        points = [poses[name].apply(self.assembly.parts[name].mesh.vertices) for name in chosen]  # type: ignore[union-attr]
        return np.array([np.min([p.min(axis=0) for p in points], axis=0), np.max([p.max(axis=0) for p in points], axis=0)])

    def axis(self, joint: Joint) -> FloatArray:
        """Return the direction of a joint's z axis at rest, in the frame of the whole."""
        return np.asarray((self.rest[joint.parent] @ joint.T_parent_connector).z_axis)

    def extents(self, part: str) -> FloatArray:
        """Return a part's sides in its own frame, ascending `(3,)` [mm]."""
        mesh = self.assembly.parts[part].mesh
        return np.sort(np.ptp(mesh.vertices, axis=0)) if mesh is not None else np.zeros(3)

    def apart(self, a: str, b: str) -> float:
        """Return the distance of the surfaces of two parts at rest [mm]."""
        key = (a, b) if a < b else (b, a)
        if key not in self._apart:
            meshes = [self.assembly.parts[name].mesh for name in key]
            surfaces = [whole_surface(mesh) for mesh in meshes if mesh is not None]
            T = (self.rest[key[0]].inverse() @ self.rest[key[1]]).matrix
            self._apart[key] = surface_distance(surfaces[0], surfaces[1], T) if len(surfaces) == len(key) else math.inf
        return self._apart[key]

    @cached_property
    def _apart(self) -> dict[tuple[str, str], float]:
        return {}

    def hull(self, part: str) -> FloatArray:
        """Return the corners of a part's convex hull in its own frame `(n, 3)` [mm]; all of its corners if it is flat."""
        if part not in self._hulls:
            mesh = self.assembly.parts[part].mesh
            points = np.zeros((0, 3)) if mesh is None else mesh.vertices
            try:
                self._hulls[part] = points[ConvexHull(points).vertices] if len(points) else points
            except QhullError:
                self._hulls[part] = points
        return self._hulls[part]

    @cached_property
    def _hulls(self) -> dict[str, FloatArray]:
        return {}

    def boxes(self, part: str) -> FloatArray:
        """Return a part's sides at rest, and in the frames that its faces suggest; each row ascends `(n, 3)` [mm].

        A tool may choose any frame for a part, so the sides in its own frame say nothing.
        """
        if part not in self._boxes:
            mesh = self.assembly.parts[part].mesh
            assert mesh is not None
            turned = mesh.vertices @ self.rest[part].rotation.T
            rows = [np.sort(np.ptp(turned, axis=0)), *boxes_by_faces(mesh)]
            self._boxes[part] = np.array(rows)
        return self._boxes[part]

    def form(self, part: str) -> str:
        """Return a digest of a part's mesh, wherever it lies in the part's frame: STEP files may hold a part where it stands in the whole."""
        mesh = self.assembly.parts[part].mesh
        assert mesh is not None
        if part not in self._forms:
            about = mesh.vertices - (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
            rounded = np.round(about, _SAME_DIGITS) + 0.0  # no minus zeros
            self._forms[part] = hashlib.sha256(rounded.tobytes() + mesh.triangles.tobytes()).hexdigest()
        return self._forms[part]

    @cached_property
    def _forms(self) -> dict[str, str]:
        return {}

    def of_size(self, mm: Sequence[float | None], tolerance: float) -> list[str]:
        """Return the parts that have these sides within a share of them, in any order; None stands for any length [mm]."""
        sides = sorted(side for side in mm if side is not None)

        def fits(extents: FloatArray) -> bool:
            """Return whether some of the extents are these sides; both ascend, so that each is compared with its own."""
            return any(
                all(abs(extent - side) <= tolerance * side for side, extent in zip(sides, chosen, strict=True))
                for chosen in combinations(extents.tolist(), len(sides))
            )

        return [name for name in self.shaped if any(fits(extents) for extents in self.boxes(name))]

    @cached_property
    def _boxes(self) -> dict[str, FloatArray]:
        return {}

    @cached_property
    def rigid(self) -> Mapping[str, str]:
        """For each part the name of one that it is fixed to; the same for all that are fixed together."""
        return {name: self.scene.relations.rigid.leader(name) for name in self.assembly.mechanism.parts}

    @cached_property
    def unmade(self) -> tuple[str, ...]:
        """Names of the joints that no surfaces make, or whose bodies can leave them sideways.

        Where surfaces that are not known lie near, those that are known may still hold the joint sideways: then it is free along its axis alone.
        """
        moving = [joint.name for joint in self.assembly.joints if joint.type is not JointType.FIXED]
        return tuple(
            row.joint
            for row in self.assembly.check_joints(moving).rows
            if row.verdict == "not made"
            or (row.verdict == "not assessed" and not row.losses)
            or any(loss.way[1:] in _ASIDE[row.type] for loss in row.losses)
        )

    def mass(self, part: str) -> MassProperties | None:
        """Return the mass of a part; of water where none is known; None if it has neither a mass nor a shape."""
        mesh, mass = self.assembly.parts[part].mesh, self.assembly.parts[part].mass
        return mass if mass is not None or mesh is None else MassProperties.from_solid(*mesh.solid_integrals(), WATER)

    def density(self, part: str) -> float:
        """Return a part's mass by its volume [kg/mm³]; that of water where no mass is known."""
        mesh, mass = self.assembly.parts[part].mesh, self.assembly.parts[part].mass
        return WATER * 1e-9 if mesh is None or mass is None or not mesh.volume else mass.mass / abs(mesh.volume)

    def per_unit(self, joint: Joint) -> float:
        """Return what turns a joint's main coordinate into degrees or mm."""
        return 1.0 if joint.type in _SLIDING else math.degrees(1.0)

    def span(self, joint: Joint) -> float:
        """Return how far a joint is allowed to go by its main coordinate [deg or mm], inf for an endless one.

        A ball goes from side to side, and a planar joint as far as the longer of its two ways.
        """
        if joint.type is JointType.BALL:
            return 2 * math.degrees(math.pi if joint.limits.cone is None else joint.limits.cone)
        widths = _widths(joint) or [0.0]
        return (max(widths[:2]) if joint.type is JointType.PLANAR else widths[0]) * self.per_unit(joint)

    def turn(self, joint: Joint) -> float:
        """Return how far a joint is allowed to turn by its last coordinate [deg]: a sleeve about its axis, a universal joint the second way; 0 for others."""
        return math.degrees(_widths(joint)[-1]) if joint.type in _TURNING_TOO else 0.0

    def values(self, joint: str, driver: str, points: FloatArray) -> FloatArray:
        """Return the main coordinate of a joint while a driver takes other values, the others at rest [rad or mm]."""
        mechanism = self.assembly.mechanism
        q = np.repeat(np.array(mechanism.rest)[None], len(points), axis=0)
        q[:, [coordinate.name for coordinate in self.assembly.drivers].index(driver)] = points
        configuration = mechanism.configuration(q)
        column = next(i for i, coordinate in enumerate(mechanism.coordinates) if coordinate.joint == joint)
        return np.asarray(configuration.columns[..., column])

    @cached_property
    def _feasible(self) -> dict[str, FeasibleRange | None]:
        """How far drivers go, found when first asked for: checks of many pairs of joints ask again and again."""
        return {}

    def driver_range(self, driver: str, turns: float = 1.0) -> tuple[float, float] | None:
        """Return how far a driver can go, by limits and loops [rad or mm]; for an endless one, so many turns from zero."""
        if driver not in self._feasible:
            try:
                self._feasible[driver] = self.assembly.feasible_range(driver)
            except ArticadError:
                self._feasible[driver] = None
        reached = self._feasible[driver]
        if reached is None:
            return None
        if {"endless", "not followed further"} & {reached.lower_reason, reached.upper_reason}:
            return 0.0, turns * 2 * math.pi
        return reached.lower, reached.upper

    def stroke(self, driver: str, steps: int) -> FloatArray:
        """Return values of a driver from one end of its range to the other, both included, except for ends that are dead points of a loop."""
        reached = self.driver_range(driver)
        if reached is None:
            return np.empty(0)
        inset = DEAD * (reached[1] - reached[0])
        low, high = (0.0 if sound else inset for sound in self._sound_ends(driver, reached))
        return np.linspace(reached[0] + low, reached[1] - high, steps)

    def _sound_ends(self, driver: str, reached: tuple[float, float]) -> list[bool]:
        """Return whether loops can be closed at either end of a driver's range, without a dead point there."""
        feasible = self._feasible[driver]
        assert feasible is not None
        q = np.repeat(np.array(self.assembly.mechanism.rest)[None], 2, axis=0)
        q[:, [coordinate.name for coordinate in self.assembly.drivers].index(driver)] = reached
        closed = self.assembly.solve(q).reached
        reasons = feasible.lower_reason, feasible.upper_reason
        return [bool(ok) and reason.startswith(_SOUND) for ok, reason in zip(closed, reasons, strict=True)]


def _cranked(assembly: Assembly) -> Assembly:
    """Return an assembly that states no driver with the crank as its driver that turns without end beside the ground.

    Which joint of a loop drives is else decided by the order of the joints in a file; one that goes to and fro does not pass its dead points.
    """
    known = assembly.mechanism
    if any(joint.driver for joint in known.given_joints) or any(_is_endless(drive.lower, drive.upper) for drive in assembly.drivers):
        return assembly
    driven = {drive.joint for drive in assembly.drivers}
    for crank in known.given_joints:
        if crank.type is not JointType.REVOLUTE or crank.name in driven or known.ground not in (crank.parent, crank.child):
            continue
        if not _is_endless(*crank.limits.lower, *crank.limits.upper):
            continue
        mechanism = known.changed(joints=[replace(joint, driver=joint is crank) for joint in known.given_joints])
        if any(drive.joint == crank.name for drive in mechanism.drivers):
            return replace(assembly, mechanism=mechanism)
    return assembly


def _widths(joint: Joint) -> list[float]:
    """Return how wide the range of each coordinate of a joint is [rad or mm]."""
    return [upper - lower for lower, upper in zip(joint.limits.lower, joint.limits.upper, strict=True)]


def _is_endless(lower: float, upper: float) -> bool:
    return math.isinf(lower) and math.isinf(upper)
