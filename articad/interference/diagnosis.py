"""Root causes: what is wrong with the geometry, derived from the geometry before any model is asked.

Each finding of an overlap or collision is examined at its place: a hole that was not bored, a slot that was not cut, a pivot on the face
of a part that turns, a part too long for its place, axes too close together, a part in several pieces. The cause says who must act, the
plan's author (design) or the script's (code), which number to change, and by how much.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.findings import Finding, Findings
from articad.geometry.winding import winding_numbers
from articad.interference.body import Body
from articad.interference.freedoms import freedoms
from articad.interference.motion import Chain, Route
from articad.interference.overlap import VOLUME_NOISE_MM3, distance, intersection
from articad.interference.scene import Scene
from articad.interference.surface import Core
from articad.interference.verdict import UNRELATED_VOLUME_MM3
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.tree import KinematicTree

CLEARANCE_MM = 0.2  # proposed for the radius of a bore and for both sides of a slot
ROUND_SHARE = 0.9  # of the cylinder about the axis: an overlap that fills this share of it is a pin
PROBE_SHARE = 0.05  # of the size of an overlap: distance at which material beside it is looked for
END_MM = 0.05  # an overlap that ends this close to a part's own end is at that end
LONG_SHARE = 0.5  # of a part's length: a part that penetrates another by more is not merely too long
NEAR_REST = np.deg2rad(20)  # a part that turns on its own face collides with its neighbour early
FACE_SHARE = 0.1  # of a part's size: an axis closer to its surface is on its face
EDGE_SHARE = 0.5  # of a part's reach from the axis: its edge beside the axis is nearer
SHIFT_SHARE = 1.05  # of the length by which an axis must move: surfaces that only touch do not clear each other
FACES_WITHIN = 6.0  # of that length: a face of one of the parts that is as near is a place for the axis
FUSED_MM = 0.01  # bodies that overlap by this much fuse to one
TRIED_POSES = 13  # at which a proposed axis is tried
PARALLEL = 1e-3  # |sine| of the angle between axes whose distance is called a pitch
_EXPLAINED = ("E_OVERLAP", "E_STATIC_OVERLAP", "W_STATIC_OVERLAP", "E_MOTION_COLLISION")
_TURNING = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW)


def diagnose(scene: Scene, tree: KinematicTree, findings: Sequence[Finding]) -> Findings:
    """Assign a cause, an actor and a number to each finding whose geometry shows them, and add findings for parts in several pieces.

    Args:
        scene: The scene that was checked.
        tree: Joints between the parts; used at rest where a finding gives no pose.
        findings: Findings of a check, a sweep or a certificate.
    """
    explained = [_explained(scene, tree, finding) for finding in findings]
    pieces = [finding for name, body in scene.bodies.items() if (finding := _in_pieces(name, body)) is not None]
    return Findings([*explained, *pieces])


def _explained(scene: Scene, tree: KinematicTree, finding: Finding) -> Finding:
    known = all(name in scene.bodies and name not in scene.broken for name in finding.parts)
    if finding.code not in _EXPLAINED or len(finding.parts) != 2 or finding.cause is not None or not known:
        return finding
    case = PairCase(scene, tree, finding)
    moving: tuple[Callable[[], Finding | None], ...] = (case.pitch, case.pivot_on_face, case.overrun)
    standing: tuple[Callable[[], Finding | None], ...] = (case.unbored_hole, case.missing_slot, case.envelope)
    for cause in (*moving, *standing) if finding.code == "E_MOTION_COLLISION" else standing:
        explanation = cause()
        if explanation is not None:
            return explanation
    return finding


@dataclass(frozen=True)
class _Region:
    """The place where two parts overlap, in the first part's frame.

    Attributes:
        vertices: Vertices of the largest piece, `(V, 3)` [mm].
        volume: Its volume [mm³].
        piece: The piece itself, a manifold.
    """

    vertices: FloatArray
    volume: float
    piece: Any

    @property
    def centre(self) -> FloatArray:
        """Middle of its box."""
        return np.asarray((self.vertices.min(axis=0) + self.vertices.max(axis=0)) / 2)

    def radius(self, axis: Core, height: float) -> float:
        """Return its radius about an axis at a height; faces that merely touch add flat rims at other heights."""
        upright = np.linalg.inv(axis.frame)[:3, :]
        outline = self.piece.transform(upright).slice(height).to_polygons()
        return max((float(np.linalg.norm(points, axis=1).max()) for points in outline), default=0.0)


class PairCase:
    """One finding with the geometry at its place."""

    def __init__(self, scene: Scene, tree: KinematicTree, finding: Finding) -> None:
        self.scene, self.tree, self.finding = scene, tree, finding
        self.a, self.b = finding.parts
        self.body_a, self.body_b = scene.bodies[self.a], scene.bodies[self.b]
        pose = dict(finding.pose or {})
        joints = tree.joints_between(self.a, self.b)
        self.moving = [joint for joint in joints if any(freedom.name in pose for freedom in freedoms(joint))]
        self.chain = Chain(Route(tree.path(self.a, self.b), joints), [joint.name for joint in self.moving])
        rest = {freedom.name: freedom.rest for freedom in self.chain.freedoms}
        self.values = [pose.get(name, value) for name, value in rest.items()]
        self.T = self.chain.matrix(self.values)
        self.direct: Joint | None = next(iter(scene.relations.between(self.a, self.b)), None)

    # ------------------------------------------------------------------ causes of a permanent overlap

    def unbored_hole(self) -> Finding | None:
        """A pin is in solid material: the overlap is a cylinder about the joint's axis."""
        axis = self._axis()
        if axis is None or self.region is None:
            return None
        low, high = axis.heights(self.region.vertices)
        radius = self.region.radius(axis, (low + high) / 2)
        if self.region.volume < ROUND_SHARE * np.pi * radius**2 * (high - low):
            return None
        middle = axis.frame[:3, 3] + axis.frame[:3, 2] * (low + high) / 2
        beside = [
            middle + radius * 1.15 * (np.cos(t) * axis.frame[:3, 0] + np.sin(t) * axis.frame[:3, 1]) for t in np.arange(6) * np.pi / 3
        ]
        solid = self._with_most_material(np.array(beside))
        bore = 2 * (radius + CLEARANCE_MM)
        return self._because(
            "unbored_hole",
            "code",
            f"{self._other(solid)} is {high - low:.4g} mm deep in solid material of {solid}, which has no hole there.",
            f"Bore {solid} along the axis with a diameter of {bore:.4g} mm, {high - low:.4g} mm deep (the pin's is {2 * radius:.4g} mm).",
            value=2 * radius,
            limit=bore,
            culprit=solid,
        )

    def missing_slot(self) -> Finding | None:
        """A tongue is in solid material: along the axis about which it turns there is material on both sides of it."""
        if self.region is None or self.direct is None or self.direct.type not in _TURNING:
            return None
        # extent of the shared volume along the joint's axis, and a probe just beyond each of its ends
        direction = self._frame_of(self.direct)[:3, 2]
        along = self.region.vertices @ direction
        low, high, centre = float(along.min()), float(along.max()), self.region.centre
        thickness = high - low
        step = max(PROBE_SHARE * thickness, 1e-3)
        both = np.array([centre + direction * (place - centre @ direction) for place in (low - step, high + step)])
        if min(self._material(name, centre[None])[0] for name in (self.a, self.b)) < 0.5:
            return None  # a ring around its own middle: a bore that is too small, not a tongue
        for name in (self.a, self.b):
            if (self._material(name, both) > 0.5).all() and (self._material(self._other(name), both) < 0.5).all():
                width = thickness + 2 * CLEARANCE_MM
                return self._because(
                    "missing_slot",
                    "code",
                    f"{self._other(name)}, {thickness:.4g} mm thick, is inside solid material of {name}.",
                    f"Cut a slot {width:.4g} mm wide into {name} where {self._other(name)} rotates; remove at least {self._extent(name)}.",
                    value=thickness,
                    limit=width,
                    culprit=name,
                )
        return None

    def envelope(self) -> Finding | None:
        """A part is too long: the overlap ends where the part itself ends, and is thin compared with its length."""
        if self.region is None:
            return None
        best: tuple[float, str, int, float, float] | None = None
        for name, to_part in ((self.a, np.eye(4)), (self.b, np.linalg.inv(self.T))):
            points = self.region.vertices @ to_part[:3, :3].T + to_part[:3, 3]
            low, high = self.scene.bodies[name].mesh.bounds
            for k in range(3):
                depth, length = float(np.ptp(points[:, k])), float(high[k] - low[k])
                ends = points[:, k].min() - low[k] < END_MM or high[k] - points[:, k].max() < END_MM
                if ends and depth < LONG_SHARE * length and (best is None or depth < best[0]):
                    best = depth, name, k, length, length - depth
        if best is None:
            return None
        depth, name, k, length, room = best
        return self._because(
            "envelope",
            "design",
            f"{name} is {length:.6g} mm long along its {'xyz'[k]} and ends {depth:.4g} mm inside {self._other(name)}.",
            f"Shorten {name} by {depth:.4g} mm along its {'xyz'[k]}, to {room:.6g} mm minus a gap; or move it by the same amount.",
            value=length,
            limit=room,
        )

    # ------------------------------------------------------------------ causes of a collision in motion

    def pitch(self) -> Finding | None:
        """Two parts turn about parallel axes that are closer than their radii together."""
        turning = [joint for joint in self.tree.joints_between(self.a, self.b) if joint.type in _TURNING]
        if self.direct is not None or len(turning) < 2:
            return None
        first, last = Core(self._frame_of(turning[0])), Core(self._frame_of(turning[-1]))
        direction = first.frame[:3, 2]
        offset = last.frame[:3, 3] - first.frame[:3, 3]
        if np.linalg.norm(np.cross(direction, last.frame[:3, 2])) > PARALLEL:
            return None
        between = float(np.linalg.norm(offset - (offset @ direction) * direction))
        placed_b = self.body_b.mesh.vertices @ self.T[:3, :3].T + self.T[:3, 3]
        reach = float(first.radii(self.body_a.mesh.vertices).max()) + float(last.radii(placed_b).max())
        if between >= reach or between == 0.0:
            return None
        return self._because(
            "pitch",
            "design",
            f"The axes of {turning[0].name} and {turning[-1].name} are {between:.4g} mm apart, but {self.a} and {self.b} reach "
            f"{reach:.4g} mm together.",
            f"Move the axes {reach - between:.4g} mm further apart, to more than {reach:.4g} mm, or shorten the rotating part.",
            value=between,
            limit=reach,
        )

    def pivot_on_face(self) -> Finding | None:
        """A part turns about an axis on its own face, so that its corner enters the neighbour at once."""
        joint = self.direct
        if joint is None or joint.type not in _TURNING or len(self.moving) != 1:
            return None
        entry = self._entry()
        if abs(entry - self.chain.freedoms[-1].rest) > NEAR_REST:
            return None
        axis_a, axis_b = Core(self._frame_of(joint)), Core(joint.T_child_connector.matrix)
        if joint.parent != self.a:
            axis_b = Core(joint.T_parent_connector.matrix)
        inset, name, axis = min(
            (_face_distance(axis, body), name, axis) for name, axis, body in ((self.a, axis_a, self.body_a), (self.b, axis_b, self.body_b))
        )
        body = self.scene.bodies[name]
        if inset > FACE_SHARE * body.diagonal:
            return None
        reach = float(axis.radii(body.mesh.vertices).max())
        if self._first_contact(axis_a, entry) > EDGE_SHARE * reach:
            return None  # an end far from the axis enters first: the neighbour is in its way, not the edge beside the axis
        deepest = self._deepest_along()
        return self._because(
            "pivot_on_face",
            "design",
            f"The axis of {joint.name} lies {inset:.4g} mm from a face of {name}, so its edge rotates into {self._other(name)} "
            f"up to {deepest:.4g} mm deep.",
            self._shift_of_axis(joint, inset, deepest)
            or f"Move the axis {deepest:.4g} mm out of the face, towards the side to which it opens, or round the edge by the same amount.",
            value=inset,
            limit=inset + deepest,
        )

    def overrun(self) -> Finding | None:
        """A slider moves farther than there is space."""
        joint = self.direct
        if joint is None or joint.type not in (JointType.SLIDER, JointType.CYLINDRICAL) or len(self.moving) != 1:
            return None
        (travel, *_), value = self.chain.freedoms, self.values[0]
        if value == travel.rest:
            return None
        bound = travel.upper if value > travel.rest else travel.lower
        excess = abs(bound - value)
        if excess == 0.0:
            excess, value = abs(self.finding.value or 0.0), bound
        return self._because(
            "envelope",
            "design",
            f"{joint.name} runs to {bound:.6g} mm, but there is space only up to {value:.6g} mm.",
            f"Shorten the travel by {excess:.4g} mm, or shorten {self.b} by the same amount.",
            value=bound,
            limit=value,
        )

    # ------------------------------------------------------------------ geometry

    @cached_property
    def region(self) -> _Region | None:
        """The largest piece of the overlap."""
        pieces = intersection(self.body_a, self.body_b, SE3.from_matrix(self.T)).decompose()
        if not pieces:
            return None
        largest: Any = max(pieces, key=lambda piece: float(piece.volume()))
        if float(largest.volume()) <= VOLUME_NOISE_MM3:
            return None
        return _Region(np.asarray(largest.to_mesh64().vert_properties)[:, :3], float(largest.volume()), largest)

    def _extent(self, name: str) -> str:
        """Return the extent of the overlap in a part's own frame, as text."""
        assert self.region is not None
        points = self.region.vertices
        if name == self.b:
            inverse = np.linalg.inv(self.T)
            points = points @ inverse[:3, :3].T + inverse[:3, 3]
        ranges = zip("xyz", points.min(axis=0), points.max(axis=0), strict=True)
        return ", ".join(f"{axis} {low + 0.0:.4g} to {high + 0.0:.4g}" for axis, low, high in ranges) + f" mm (in the frame of {name})"

    def _axis(self) -> Core | None:
        """Return the axis of the joint between the two, in the first part's frame."""
        if self.direct is None or self.direct.type in (JointType.BALL, JointType.PLANAR, JointType.UNIVERSAL):
            return None
        return Core(self._frame_of(self.direct))

    def _frame_of(self, joint: Joint) -> FloatArray:
        """Return a joint's parent connector in the first part's frame, at the finding's pose."""
        values = {freedom.name: value for freedom, value in zip(self.chain.freedoms, self.values, strict=True)}
        chain = Chain(Route(self.tree.path(self.a, joint.parent), self.tree.joints_between(self.a, joint.parent)), (), values)
        return np.asarray(chain.matrix(()) @ joint.T_parent_connector.matrix)

    def _material(self, name: str, points: FloatArray) -> FloatArray:
        """Return 1 where points of the first part's frame are inside a part."""
        if name == self.b:
            inverse = np.linalg.inv(self.T)
            points = points @ inverse[:3, :3].T + inverse[:3, 3]
        return winding_numbers(points, self.scene.bodies[name].corners)

    def _with_most_material(self, points: FloatArray) -> str:
        return max((self.a, self.b), key=lambda name: float(self._material(name, points).sum()))

    def _other(self, name: str) -> str:
        return self.b if name == self.a else self.a

    def _entry(self) -> float:
        """Return the value of the last coordinate from which the two overlap, between rest and this pose."""
        free, hit = self.chain.freedoms[-1].rest, self.values[-1]
        for _ in range(20):
            middle = (free + hit) / 2
            T = SE3.from_matrix(self.chain.matrix([*self.values[:-1], middle]))
            overlaps = float(intersection(self.body_a, self.body_b, T).volume()) > UNRELATED_VOLUME_MM3
            free, hit = (free, middle) if overlaps else (middle, hit)
        return hit

    def _shift_of_axis(self, joint: Joint, inset: float, depth: float) -> str:
        """Return advice on where the axis should be so that the two clear each other over its range; empty if no trial does.

        Tried are shifts d along x and y of the joint's connector, by the lengths that the fault suggests and to the outermost faces of the two
        parts, if these are near. With both connectors shifted, the child at q is Trans(d) · T(q) · T(rest)⁻¹ · Trans(−d) · T(rest), in the parent's frame: it turns about the new axis, and rests as before.
        """
        freedom = self.chain.freedoms[-1]
        lower, upper = max(freedom.lower, freedom.rest - np.pi), min(freedom.upper, freedom.rest + np.pi)
        at = [self.chain.matrix([*self.values[:-1], q]) for q in (freedom.rest, *np.linspace(lower, upper, TRIED_POSES))]
        rest, *moved = at if joint.parent == self.a else [np.linalg.inv(T) for T in at]
        parent, child = self.scene.bodies[joint.parent], self.scene.bodies[joint.child]
        frame = joint.T_parent_connector.matrix
        near = (inset, depth, inset + depth, 2.0 * (inset + depth))
        extents = [
            ((body.mesh.vertices - at[:3, 3]) @ at[:3, :2]) for body, at in ((parent, frame), (child, joint.T_child_connector.matrix))
        ]
        trials = set[tuple[float, int]]()
        for side, (axis, sign) in enumerate(itertools.product((0, 1), (-1.0, 1.0))):
            faces = (float((sign * extent[:, axis]).max()) for extent in extents)
            lengths = (*near, *(face for face in faces if face < FACES_WITHIN * (inset + depth)))
            trials |= {(SHIFT_SHARE * length, side) for length in lengths if length > END_MM}
        directions = (-frame[:3, 0], frame[:3, 0], -frame[:3, 1], frame[:3, 1])
        for length, side in sorted(trials):
            direction = directions[side]
            there, back = np.eye(4), np.eye(4)
            there[:3, 3], back[:3, 3] = length * direction, -length * direction
            turns = (there @ T @ np.linalg.inv(rest) @ back @ rest for T in moved)
            if all(float(intersection(parent, child, SE3.from_matrix(T)).volume()) <= UNRELATED_VOLUME_MM3 for T in turns):
                x, y, z = (f"{value + 0.0:.4g}" for value in np.round(length * direction, 6))
                return (
                    f"Move the axis by ({x}, {y}, {z}) mm in the frame of {joint.parent}, at both connectors: then {self.a} and {self.b} "
                    f"clear each other at {TRIED_POSES} poses of its range."
                )
        return ""

    def _first_contact(self, axis: Core, entry: float) -> float:
        """Return the distance from an axis at which the two overlap just after `entry` [mm]."""
        hit = self.values[-1]
        T = SE3.from_matrix(self.chain.matrix([*self.values[:-1], entry + 0.05 * (hit - entry)]))
        points = np.asarray(intersection(self.body_a, self.body_b, T).to_mesh64().vert_properties)[:, :3]
        return float(axis.radii(points).min()) if len(points) else 0.0

    def _deepest_along(self) -> float:
        """Return the largest depth between this pose and the bound, sampled at a few poses [mm]."""
        freedom = self.chain.freedoms[-1]
        value = self.values[-1]
        end = freedom.upper if value >= freedom.rest else freedom.lower
        end = freedom.rest + np.clip(end - freedom.rest, -np.pi / 2, np.pi / 2)
        deepest = 0.0
        for q in np.linspace(value, end, 9).tolist():
            T = SE3.from_matrix(self.chain.matrix([*self.values[:-1], q]))
            for piece in intersection(self.body_a, self.body_b, T).decompose():
                deepest = max(deepest, 2 * float(piece.volume()) / max(float(piece.surface_area()), 1e-12))
        return deepest

    def _because(
        self, cause: str, route: Any, message: str, hint: str, *, value: float, limit: float, culprit: str | None = None
    ) -> Finding:
        """Return the finding with its cause; if one part's script must be corrected, that part is the place."""
        return replace(
            self.finding,
            where=self.finding.where if culprit is None else f"parts.{culprit}",
            cause=cause,
            route=route,
            message=f"{self.finding.message} {message}",
            hint=hint,
            value=value,
            limit=limit,
            unit="mm",
        )


def _face_distance(core: Core, body: Body) -> float:
    """Return the distance of an axis from the nearest side of a body that is parallel to it [mm]."""
    flat = body.corners @ core.frame[:3, 2]
    spans = np.ptp(flat, axis=1) > 1e-9 * max(body.diagonal, 1.0)  # every axis meets the caps
    return float(core.least_radii(body.corners[spans]).min(initial=np.inf))


def _in_pieces(name: str, body: Body) -> Finding | None:
    """Return the finding that a part is several solids."""
    solids = [shell for shell in body.components if shell.volume > 0]
    if len(solids) < 2:
        return None
    first, second = Body(solids[0]), Body(solids[1])
    gap = distance(first, second, SE3.identity())
    apart = f"{gap:.4g} mm apart" if gap > 0 else "not fused where they meet"
    closer = math.ceil(1e3 * (gap + FUSED_MM)) / 1e3
    return Finding(
        code="E_NOT_ONE_SOLID",
        where=f"parts.{name}",
        parts=(name,),
        message=f"{name} consists of {len(solids)} solids; the first two are {apart}.",
        hint=f"Fuse the bodies so that they overlap by at least {FUSED_MM:g} mm"
        + (f": bring them {closer:.6g} mm closer, or build what is between them." if gap > 0 else "."),
        value=gap,
        limit=0.0,
        unit="mm",
        cause="multi_solid",
        route="code",
        stage="interference",
    )
