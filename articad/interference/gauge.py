"""Measures the gap of one joint: the distance of its two parts at a pose, and the play between them.

The gap at a pose is the smallest distance of the two surfaces. The play does not depend on where a pin happens to be in its hole: the
child is moved perpendicular to the joint until it touches the parent, then in the opposite direction. Half the sum of both travels,
measured along the normal of the surfaces that touch, is the play in that direction. It is measured about the middle of the free space,
and the largest of all directions counts. For a pin in a hole it is half the difference of the diameters, for a ball in a socket the
difference of the radii, for a carriage in a guide half the larger of its two clearances.
"""

from __future__ import annotations

import math
from typing import Any
from weakref import WeakKeyDictionary

import fcl
import numpy as np

from articad.arrays import FloatArray
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError
from articad.geometry.mesh import TriMesh
from articad.interference.freedoms import freedoms, motion_matrix, travels
from articad.interference.meridian import meeting, outline
from articad.interference.overlap import VOLUME_NOISE_MM3, overlap
from articad.interference.relations import FitLike
from articad.interference.scene import Scene
from articad.interference.seats import clear_of, seats
from articad.interference.surface import Core, Surface, split_by_radius, surface_distance, whole_surface
from articad.kinematics.joints import Joint, JointType

STOP_MM = 1e-3  # surfaces this close have met
_MOST_STEPS = 200  # towards a stop
_STEPS_OF_ALL = 6  # steps towards a stop with whole surfaces, before only those that face the direction are used
_ROUNDS = 4  # to find the middle of the free space
_SEAT_MM = 0.01  # what lies this close to a seat passes over it
_SLOPE_MM = 1e-4  # shortest travel over which the slope of a distance is computed
_GRAZING = 0.02  # cosine: a face almost parallel to the direction stops nothing
_EDGE_SHARE = 0.1  # of `within`: longest edge of triangles that cross it
_POINT = (JointType.BALL, JointType.FIXED, JointType.UNIVERSAL)  # these hold their child in all directions
_TURNING = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW, JointType.BALL)  # rotation about these keeps the radius of a point
_SQUARE = math.sqrt(0.5)
# directions in the connector's frame; the first ones are perpendicular to each other and find the middle of the free space
_ACROSS = np.array([[1, 0, 0], [0, 1, 0], [_SQUARE, _SQUARE, 0], [_SQUARE, -_SQUARE, 0]])
_ALL_WAYS = np.concatenate([np.eye(3), np.array([[1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]]) / math.sqrt(3)])

_groups: WeakKeyDictionary[Scene, dict[tuple[int, ...], tuple[Surface, Surface]]] = WeakKeyDictionary()
_known: WeakKeyDictionary[TriMesh, dict[bytes, float | None]] = WeakKeyDictionary()


class Gauge:
    """Measures the gap of one joint.

    Args:
        scene: The scene with both parts.
        joint: The joint between them.
        fit: The declared fit, which says which surface counts.
    """

    def __init__(self, scene: Scene, joint: Joint, fit: FitLike) -> None:
        self.scene, self.joint, self.fit = scene, joint, fit
        self.bodies = scene.bodies[joint.parent], scene.bodies[joint.child]
        self.slack = scene.deflection_of(joint.parent, joint.child)
        frames = joint.T_parent_connector, joint.T_child_connector
        self.surfaces = self._near_axis(self.bodies[0].mesh, frames[0]), self._near_axis(self.bodies[1].mesh, frames[1])
        self._moving: dict[float, tuple[Surface, Surface]] = {}

    def rest(self) -> float:
        """Return the gap at rest [mm]; negative is a depth."""
        return self.at([freedom.rest for freedom in freedoms(self.joint)])

    def at(self, values: list[float]) -> float:
        """Return the gap at values of the joint's freedoms [mm]; negative is a depth."""
        return self.between(self.place(values))

    def between(self, T: FloatArray) -> float:
        """Return the gap for the child's pose `T (4, 4)` in the parent's frame [mm]; negative is a depth."""
        return self._or_depth(surface_distance(*self.surfaces, T), T)

    def nearer_than(self, limit: float, values: list[float]) -> float:
        """Return the gap at values of the joint's freedoms [mm], or infinity if it is not below the limit.

        Rotation about the joint keeps the radius and height of points, so triangles whose outlines are farther apart than the limit are
        not queried at any pose.
        """
        T = self.place(values)
        gap = surface_distance(*self._within_reach(limit), T)
        return self._or_depth(gap, T) if gap < limit else math.inf

    def _joined(self, own: Surface, group: list[tuple[TriMesh, FloatArray]]) -> Surface:
        """Return a surface with the meshes that are fixed to it; made once for all joints of a part."""
        if len(group) == 1:
            return own
        made = _groups.setdefault(self.scene, {})
        key = id(own), *(id(mesh) for mesh, _ in group)
        if key not in made:
            more = [mesh.vertices[mesh.triangles] @ T[:3, :3].T + T[:3, 3] for mesh, T in group[1:]]
            made[key] = own, Surface(np.concatenate([own.corners, *more]))
        return made[key][1]

    def place(self, values: list[float]) -> FloatArray:
        """Return the child's pose in the parent's frame, `(4, 4)`."""
        return placed(self.joint, values)

    def play(self) -> float | None:
        """Return the play at rest [mm]; None if nothing stops the child.

        Parts fixed to a part belong to it: a pin that is pressed into one leaf of a hinge holds the other.
        """
        if any(surface.is_empty for surface in self.surfaces):
            return None
        T = self.place([freedom.rest for freedom in freedoms(self.joint)])
        frame = np.asarray(self.joint.T_parent_connector.matrix[:3, :3])
        groups = [
            [(self.scene.meshes[name], T_part) for name, T_part in fixed_with(self.scene, self.joint, part).items()]
            for part in (self.joint.parent, self.joint.child)
        ]
        key = b"".join(mesh.digest.encode() + T_part.tobytes() for group in groups for mesh, T_part in group)
        key += np.append(np.concatenate([T, self.joint.T_parent_connector.matrix]), self.fit.within or 0.0).tobytes()
        key += self.joint.type.encode()
        known = _known.setdefault(self.bodies[0].mesh, {})
        if key not in known:
            a, b = (self._joined(own, group) for own, group in zip(self.surfaces, groups, strict=True))
            known[key] = _Room(a, b, T).play(self._ways() @ frame.T)
        return known[key]

    def _ways(self) -> FloatArray:
        if self.joint.type is JointType.PLANAR:
            return np.eye(3)[2:]
        return _ALL_WAYS if self.joint.type in _POINT else _ACROSS

    def _or_depth(self, gap: float, T: FloatArray) -> float:
        if gap > 0:
            return gap
        try:
            found = overlap(*self.bodies, SE3.from_matrix(T))
        except InvalidSolidError:
            return 0.0
        return -found.depth if found.volume > VOLUME_NOISE_MM3 else 0.0

    def _near_axis(self, mesh: Any, frame: SE3) -> Surface:
        if self.fit.within is None:
            return whole_surface(mesh)
        core = Core(frame.matrix, 3 if self.joint.type in (JointType.BALL, JointType.FIXED) else 2)
        inside, seam, _ = split_by_radius(mesh, core, self.fit.within, _EDGE_SHARE * self.fit.within)
        return Surface(np.concatenate([inside.corners, seam.corners]))

    def _within_reach(self, limit: float) -> tuple[Surface, Surface]:
        """Return the triangles of both surfaces that may come closer to each other than the limit."""
        if self.joint.type not in _TURNING or any(surface.is_empty for surface in self.surfaces):
            return self.surfaces[0], self.surfaces[1]
        if limit not in self._moving:
            dimensions = 3 if self.joint.type is JointType.BALL else 2
            core_a = Core(self.joint.T_parent_connector.matrix, dimensions)
            core_b = Core((self.joint.T_child_connector @ flip(self.joint.mate)).matrix, dimensions)
            a, b = self.surfaces
            of_a, of_b = outline(core_a, a.corners), outline(core_b, b.corners, self._travel())
            met_a = meeting(of_a, of_b, limit)
            met_b = meeting(of_b, (of_a[0][met_a], of_a[1][met_a]), limit)
            self._moving[limit] = Surface(a.corners[met_a]), Surface(b.corners[met_b])
        return self._moving[limit]

    def _travel(self) -> tuple[float, float]:
        """Return how far the joint moves its child along its axis [mm]."""
        moving = travels(self.joint)
        match self.joint.type:
            case JointType.CYLINDRICAL:
                return moving[0].lower, moving[0].upper
            case JointType.SCREW:
                ends = sorted(self.joint.lead / (2 * math.pi) * end for end in (moving[0].lower, moving[0].upper))
                return ends[0], ends[1]
            case _:
                return 0.0, 0.0


def placed(joint: Joint, values: list[float]) -> FloatArray:
    """Return the pose of a joint's child in its parent's frame for values of the joint's freedoms, `(4, 4)`."""
    J = motion_matrix(joint, values) if values or joint.type is JointType.FREE else np.eye(4)
    return np.asarray(joint.T_parent_connector.matrix @ J @ (flip(joint.mate) @ joint.T_child_connector.inverse()).matrix)


def fixed_with(scene: Scene, joint: Joint, part: str) -> dict[str, FloatArray]:
    """Return the poses of a joint's part and of those fixed to it that have geometry, `(4, 4)` in its frame, that part first.

    A part alone where fixed joints connect both sides of the joint.
    """
    other = joint.child if part == joint.parent else joint.parent
    places: dict[str, FloatArray] = {part: np.eye(4)}
    todo = [] if scene.relations.rigid.together(part, other) else [part]
    for name in todo:
        for link in scene.relations.joints:
            if link.type is JointType.FIXED and name in (link.parent, link.child):
                step = placed(link, [])
                far, step = (link.child, step) if name == link.parent else (link.parent, np.asarray(np.linalg.inv(step)))
                if far not in places:
                    places[far] = places[name] @ step
                    todo.append(far)
    return {name: T for name, T in places.items() if name in scene.meshes}


class _Room:
    """The free space of one surface beside another, explored by straight moves.

    Args:
        a: The surface that stands still.
        b: The surface that moves.
        T: Pose of the second in the frame of the first, `(4, 4)`.
    """

    def __init__(self, a: Surface, b: Surface, T: FloatArray) -> None:
        self.whole, self.T = (a, b), T
        self.far = 2 * float(np.linalg.norm(a.box[1]) + np.linalg.norm(b.box[1]))
        self.far += float(np.linalg.norm(T[:3, :3] @ b.box[0] + T[:3, 3] - a.box[0]))
        self._facing: dict[bytes, tuple[Surface, Surface]] = {}
        self._stops: dict[bytes, tuple[float, float] | None] = {}
        self._gaps: dict[bytes, float] = {}

    def play(self, ways: FloatArray) -> float | None:
        """Return the largest play over directions `(k, 3)` [mm], None if no direction is stopped both ways.

        Args:
            ways: Unit vectors; those that are perpendicular to each other come first.
        """
        square = ways[: 3 if len(ways) > len(_ACROSS) else 2]
        middle = np.zeros(3)
        for _ in range(_ROUNDS):
            moved = 0.0
            for way in square:
                both = self._both(middle, way)
                shift = 0.0 if both is None else (both[0][0] * both[0][1] - both[1][0] * both[1][1]) / 2
                middle, moved = middle + shift * way, max(moved, abs(shift))
            if moved <= STOP_MM:
                break
        most: float | None = None
        for way in ways:
            if most is not None and all(self._is_stopped(middle, sign * way, most + 2 * STOP_MM) for sign in (1, -1)):
                continue  # no more play in this direction
            both = self._both(middle, way)
            if both is not None:
                (forth, square_to), (back, square_back) = both
                most = max(most or 0.0, (forth * square_to + back * square_back) / 2)
        return most

    def _is_stopped(self, start: FloatArray, way: FloatArray, before: float) -> bool:
        """Return whether the surfaces certainly meet within this travel; faster than finding where. False if they touch before."""
        if self._gap(start) < STOP_MM:
            return False
        a, b = self.whole
        T = self.T.copy()
        T[:3, 3] += start + before * way
        b.moving.setTransform(fcl.Transform(T[:3, :3], T[:3, 3]))
        return bool(fcl.collide(a.standing, b.moving, fcl.CollisionRequest(), fcl.CollisionResult()) > 0)

    def _both(self, start: FloatArray, way: FloatArray) -> tuple[tuple[float, float], tuple[float, float]] | None:
        forth = self._known_stop(start, way)
        back = None if forth is None else self._known_stop(start, -way)
        return None if forth is None or back is None else (forth, back)

    def _known_stop(self, start: FloatArray, way: FloatArray) -> tuple[float, float] | None:
        key = (np.round(start / STOP_MM).astype(np.int64) + 0).tobytes() + way.tobytes()
        if key not in self._stops:
            self._stops[key] = self._stop(start, way)
        return self._stops[key]

    def _stop(self, start: FloatArray, way: FloatArray) -> tuple[float, float] | None:
        """Return the travel of the second surface until it meets the first, and the cosine at which they meet; None if nothing stops it.

        No point moves faster than the whole, so a step as long as the distance is free. Surfaces beside the path keep the steps short,
        or touch from the beginning; then only faces that face each other along the direction are used.
        """
        surfaces, start_gap = self.whole, self._gap(start)
        if start_gap < STOP_MM:
            surfaces = self._front(way)
        at, gap, cosine = 0.0, start_gap if surfaces is self.whole else self._gap(start, surfaces), 1.0
        for count in range(_MOST_STEPS):
            if gap < STOP_MM:
                return at + gap, cosine
            if at > self.far:
                return None
            if count == _STEPS_OF_ALL and surfaces is self.whole:
                surfaces = self._front(way)
                gap = self._gap(start + at * way, surfaces)
                continue
            step, before = gap, gap
            at += step
            gap = self._gap(start + at * way, surfaces)
            if step > _SLOPE_MM:
                cosine = min(max((before - gap) / step, 0.0), 1.0)
        return None

    def _gap(self, shift: FloatArray, surfaces: tuple[Surface, Surface] | None = None) -> float:
        T = self.T.copy()
        T[:3, 3] += shift
        if surfaces is not None and surfaces is not self.whole:
            return surface_distance(*surfaces, T)
        key = shift.tobytes()
        if key not in self._gaps:
            self._gaps[key] = surface_distance(*self.whole, T)
        return self._gaps[key]

    def _front(self, way: FloatArray) -> tuple[Surface, Surface]:
        """Return the triangles of both surfaces that face each other along a direction, clear of the planes in which both sit on each other."""
        key = way.tobytes()
        if key not in self._facing:
            a, b = self.whole
            R, t = self.T[:3, :3], self.T[:3, 3]
            mine, theirs = _normals(a.corners) @ way < -_GRAZING, _normals(b.corners) @ (R.T @ way) > _GRAZING
            planes = seats(a.corners, b.corners @ R.T + t, way, STOP_MM)
            planes = np.column_stack([planes[:, :3] @ R, planes[:, 3] - planes[:, :3] @ t])  # in the frame of b
            self._facing[key] = Surface(a.corners[mine]), Surface(clear_of(b.corners[theirs], planes, _SEAT_MM))
        return self._facing[key]


def _normals(corners: FloatArray) -> FloatArray:
    """Return the unit normal of each triangle, `(T, 3)`; 0 for one without area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.where(lengths > 0, lengths, 1.0))
