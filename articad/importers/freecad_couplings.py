"""FreeCAD's joints between joints: gears, belts, racks and screws, as couplings.

FreeCAD states two coordinate systems on two parts and one or two lengths. The joints that move these parts, and the sense of the motion, follow from the
geometry: a gear turns against its partner and the pulleys of a belt turn together, each about the z axis of its coordinate system; a rack
moves with the rim of its pinion.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.interference.relations import Groups
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType

COUPLINGS = {"Gears": "gear", "Belt": "belt", "RackPinion": "rack", "Screw": "screw"}
_PARALLEL = 1e-6  # sine of the angle up to which two axes are parallel
_NEAR_MM = 1e-3  # distance up to which two axes are one

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Stated:
    """The data of a coupling in FreeCAD.

    Attributes:
        name: Name of the joint.
        kind: FreeCAD's word.
        parts: The two parts.
        frames: The two coordinate systems in the assembly.
        distance: The first radius, the pitch radius, or the lead [mm].
        distance_2: The second radius [mm].
    """

    name: str
    kind: str
    parts: tuple[str, str]
    frames: tuple[SE3, SE3]
    distance: float
    distance_2: float


@dataclass(frozen=True)
class _PartMotion:
    """The motion that one coordinate of a joint gives a part.

    Attributes:
        column: Name of the coordinate.
        turns: True for a rotation.
        direction: Unit vector in the assembly; the part moves in its sense as the coordinate grows.
        point: A point on the axis.
        against: The body on the other side of the joint.
    """

    column: str
    turns: bool
    direction: FloatArray
    point: FloatArray
    against: str

    @property
    def joint(self) -> str:
        """Name of the joint."""
        return self.column.partition(".")[0]


class PartMotions:
    """The motions that joints give parts, and what is fixed to these: each joint is looked at once, however many couplings a part has.

    Args:
        joints: The joints.
        poses: Poses of the parts in the assembly.
    """

    def __init__(self, joints: Iterable[Joint], poses: Mapping[str, SE3]) -> None:
        joints = list(joints)
        self._poses, self._bodies = poses, Groups()
        for joint in joints:
            if joint.type is JointType.FIXED:
                self._bodies.join(joint.parent, joint.child)
        self._joints: dict[str, list[Joint]] = {}
        for joint in joints:
            ends = {self._bodies.leader(joint.parent), self._bodies.leader(joint.child)}
            for body in ends if len(ends) == 2 else ():
                self._joints.setdefault(body, []).append(joint)
        self._found: dict[tuple[str, bool], tuple[list[_PartMotion], FloatArray, FloatArray]] = {}

    def of(self, part: str, frame: SE3, *, turns: bool) -> list[_PartMotion]:
        """Return the coordinates that turn or shift a part; of several turns, those about the frame's z axis."""
        body = self._bodies.leader(part)
        if (body, turns) not in self._found:
            made = list(self._of(body, turns=turns))
            rows = [[motion.direction, motion.point] for motion in made]
            directions, points = np.moveaxis(np.array(rows).reshape(-1, 2, 3), 1, 0)
            self._found[body, turns] = made, directions, points
        found, directions, points = self._found[body, turns]
        if turns and len(found) > 1:
            on = np.flatnonzero(_on_line(directions, points, frame.rotation[:, 2], frame.translation))
            return [found[place] for place in on] or found
        return found

    def _of(self, body: str, *, turns: bool) -> Iterator[_PartMotion]:
        """Yield the coordinates of all joints that turn or shift a body."""
        for joint in self._joints.get(body, ()):
            at = self._poses[joint.parent] @ joint.T_parent_connector
            ends = self._bodies.leader(joint.parent), self._bodies.leader(joint.child)
            sense, against = (1.0, ends[0]) if ends[1] == body else (-1.0, ends[1])
            if joint.type in (JointType.REVOLUTE, JointType.SLIDER, JointType.CYLINDRICAL, JointType.SCREW):
                columns = [column for column in joint.columns if (column.unit == "rad") is turns]
                yield from (_PartMotion(column.name, turns, sense * at.rotation[:, 2], at.translation, against) for column in columns)


def _on_line(directions: FloatArray, points: FloatArray, z: FloatArray, point: FloatArray) -> NDArray[np.bool_]:
    """Return which axes `(n, 3)` lie on the line along a direction through a point."""
    across = np.cross(directions, z)
    away = point - points
    off = away - (away @ z)[:, None] * z
    on: NDArray[np.bool_] = (np.linalg.norm(across, axis=-1) < _PARALLEL) & (np.linalg.norm(off, axis=-1) < _NEAR_MM)
    return on


def threaded(joints: Sequence[Joint], stated: Sequence[Stated], poses: Mapping[str, SE3]) -> tuple[list[Joint], list[bool]]:
    """Return the joints, with a screw in place of each cylindrical joint that a thread runs on, and which of the couplings are such threads.

    A thread runs on a joint about its axis between the same two parts, if that is the only cylindrical joint between them.
    """
    made, places = list(joints), dict[frozenset[str], list[int]]()
    for place, joint in enumerate(joints):
        if joint.type is JointType.CYLINDRICAL:
            places.setdefault(frozenset((joint.parent, joint.child)), []).append(place)
    runs = []
    for told in stated:
        near = places.get(frozenset(told.parts), []) if told.kind == "Screw" and _size_of(told) is None else []
        runs.append(len(near) == 1 and made[near[0]].type is JointType.CYLINDRICAL and _runs_on(made[near[0]], told, poses))
        if runs[-1]:
            made[near[0]] = _screw(made[near[0]], told.distance)
    return made, runs


def _runs_on(joint: Joint, stated: Stated, poses: Mapping[str, SE3]) -> bool:
    """Return whether the z axes of a thread's frames are the axis of a joint."""
    at = poses[joint.parent] @ joint.T_parent_connector
    directions = np.array([frame.rotation[:, 2] for frame in stated.frames])
    points = np.array([frame.translation for frame in stated.frames])
    return bool(_on_line(directions, points, at.rotation[:, 2], at.translation).all())


def _screw(joint: Joint, lead: float) -> Joint:
    """Return the screw of a cylindrical joint, at rest where it is: Tz(d) Rz(θ) with d - d_0 = k (θ - θ_0), k = lead / 2π.

    Poses give θ_0 but for whole turns: of those that the limits allow, it has as many as bring k θ_0 nearest to d_0. Both limits hold: those
    of the slide bound the angle by θ = θ_0 + (d - d_0) / k.
    """
    k = lead / math.tau
    (slide, angle), lower, upper = joint.rest, joint.limits.lower, joint.limits.upper
    wound = angle + math.tau * round((slide / k - angle) / math.tau)
    angle = wound if lower[1] <= wound <= upper[1] else angle
    by_slide = sorted(angle + (held[0] - slide) / k for held in (lower, upper))
    low, high = max(lower[1], by_slide[0]), min(upper[1], by_slide[1])
    return replace(
        joint,
        type=JointType.SCREW,
        lead=lead,
        T_parent_connector=joint.T_parent_connector @ SE3.trans(0.0, 0.0, slide - k * angle),
        limits=JointLimits((min(low, angle),), (max(high, angle),)),
        rest=(angle,),
    )


def coupling_of(stated: Stated, motions: PartMotions) -> Coupling | str:
    """Return the coupling, or the reason why there is none: the end of a sentence whose subject is the joint.

    Args:
        stated: The data in FreeCAD.
        motions: Of the parts by the other joints.
    """
    if wrong := _size_of(stated):
        return wrong
    sides = list(zip(stated.parts, stated.frames, strict=True))
    turns = [motions.of(part, frame, turns=True) for part, frame in sides]
    if stated.kind in ("Gears", "Belt"):
        return _wheels(stated, *(found[0] if len(found) == 1 else None for found in turns))
    slides = [motions.of(part, frame, turns=False) for part, frame in sides]
    for one, other in ((0, 1), (1, 0), (0, 0), (1, 1)):
        if pair := _pair(turns[one], slides[other], along=stated.kind == "Screw"):
            return _thread(stated, *pair) if stated.kind == "Screw" else _rack(stated, *pair, stated.frames[1 - one])
    return "needs one part that turns and one that slides, each by a joint of its own"


def _pair(turns: Iterable[_PartMotion], slides: Sequence[_PartMotion], *, along: bool) -> tuple[_PartMotion, _PartMotion] | None:
    """Return the turn and the slide that are coupled; None if there is none, or more than one.

    A thread shifts along the axis about which it turns, and a rack across it. Of stages that slide one on the other in one direction, the
    one is meant that slides on what bears the spindle or the pinion.

    Args:
        turns: Of the one part.
        slides: Of the other part.
        along: Whether the slide is along the axis of the turn, rather than across it.
    """
    pairs = [(turn, slide) for turn in turns for slide in slides if turn.joint != slide.joint]
    if len(pairs) > 1:
        pairs = [pair for pair in pairs if _leads(*pair, along=along)]
    if len(pairs) > 1:
        pairs = [(turn, slide) for turn, slide in pairs if turn.against == slide.against]
    return pairs[0] if len(pairs) == 1 else None


def _leads(turn: _PartMotion, slide: _PartMotion, *, along: bool) -> bool:
    """Return whether a slide is along the axis of a turn, or across it."""
    off = np.linalg.norm(np.cross(turn.direction, slide.direction)) if along else abs(float(np.dot(turn.direction, slide.direction)))
    return bool(off < _PARALLEL)


def _size_of(stated: Stated) -> str | None:
    """Return what is wrong with the radii or the lead of a joint, if anything is: a left-handed lead is negative."""
    if stated.kind == "Screw":
        return None if math.isfinite(stated.distance) and stated.distance != 0 else "has a lead that is zero or no number"
    radii = (stated.distance, stated.distance_2) if stated.kind in ("Gears", "Belt") else (stated.distance,)
    return None if all(radius > 0 for radius in radii) else "has a radius that is not positive"


def _wheels(stated: Stated, a: _PartMotion | None, b: _PartMotion | None) -> Coupling | str:
    """Two wheels: r_1 ω_1 = ∓ r_2 ω_2 about one direction, against each other for gears, together for a belt."""
    if a is None or b is None or a.column == b.column:
        return "needs two parts that turn, each by a joint of its own"
    along = [float(np.dot(axis.direction, frame.rotation[:, 2])) for axis, frame in zip((a, b), stated.frames, strict=True)]
    parallel = float(np.dot(stated.frames[0].rotation[:, 2], stated.frames[1].rotation[:, 2]))
    sense = math.copysign(1.0, along[0] * along[1] * parallel) * (-1.0 if stated.kind == "Gears" else 1.0)
    return _made(stated, a, b, sense * stated.distance / stated.distance_2)


def _thread(stated: Stated, turn: _PartMotion, slide: _PartMotion) -> Coupling:
    """A thread, right-handed if its lead is positive: s = lead · θ / 2π along the axis about which it turns."""
    return _made(stated, turn, slide, stated.distance / math.tau * math.copysign(1.0, float(np.dot(turn.direction, slide.direction))))


def _rack(stated: Stated, turn: _PartMotion, slide: _PartMotion, rack: SE3) -> Coupling | str:
    """A rack that does not slip: at the contact it moves with the rim, v = ω × r."""
    reach = rack.translation - turn.point
    for axis in (turn.direction, slide.direction):
        reach = reach - np.dot(reach, axis) * axis
    if np.linalg.norm(reach) < _NEAR_MM:
        return "does not show on which side of the pinion the rack is"
    rim = np.cross(turn.direction, reach / np.linalg.norm(reach))
    return _made(stated, turn, slide, math.copysign(stated.distance, float(np.dot(rim, slide.direction))))


def _made(stated: Stated, a: _PartMotion, b: _PartMotion, ratio: float) -> Coupling:
    return Coupling(stated.name, COUPLINGS[stated.kind], a.column, b.column, ratio)
