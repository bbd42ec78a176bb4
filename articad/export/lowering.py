"""One lowering pass for all formats: joints of all types become frames and one-freedom motions, mm become m.

Each part becomes a link whose frame is that of the joint above it; the ground's link frame is the ground frame itself.
For a tree edge that is crossed from parent to child, `T_link_part = F · C_c⁻¹` and the joint's frame is `B_parent · C_p`; crossed the
other way, the frame is `B_child · C_c · F`, the motion is J(q)⁻¹ (the same motions backwards about turned axes) and `T_link_part = C_p⁻¹`.
So every coordinate of a format equals articad's, in whichever direction the tree crosses a joint and whatever its mate; only a ball that
is crossed backwards has the inverse quaternion.

A link that came from a file keeps its frame if possible: then the joint's frame is placed at the part's, which changes J(q) into K⁻¹
J(q) K with K = `T_link_part` of the rule above. That is the same motion about rotated axes if every turning axis passes through the
part's origin. Otherwise the frame moves, which is a row of the losses.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.export.features import features_of, rigid_with_ground, solid_enough, steps_of_bodies, without_own_mass
from articad.export.inertia import MM_PER_M, Inertial
from articad.export.loads import Load, joint_loads
from articad.export.losses import Feature
from articad.export.names import Names, valid_name
from articad.export.once import once
from articad.geometry.part import Part, Shape
from articad.kinematics.joints import Joint, JointType, Step

if TYPE_CHECKING:
    from articad.assembly import Assembly

Kind = Literal["turn", "slide"]


ON_AXIS_MM = 1e-6  # largest distance of a turning axis from the origin of a link that keeps its frame
FAR_RAD = 1e6  # replaces an open end of a range
FAR_M = 1e3
ROUND = 1e-12  # largest difference of a component of an axis from a whole number that is rounded away


def motions(kind: JointType) -> tuple[Step, ...]:
    """Return J(q) of a joint type as a product of motions that formats can write as joints of their own, the first factor first."""
    return () if kind is JointType.FREE else kind.steps  # formats represent it as a whole, or omit it


@dataclass(frozen=True)
class Follows:
    """A value that is a linear function of another one: value = ratio · leader + offset, in SI units."""

    leader: str
    ratio: float
    offset: float


@dataclass(frozen=True, eq=False)
class AxisMotion:
    """A one-freedom motion, in SI units.

    Attributes:
        name: Name of the joint that a format has for it.
        kind: Rotation about the axis, or translation along it.
        axis: Unit vector in the joint's frame, `(3,)`.
        lower: [rad, m], −inf for none.
        upper: [rad, m], +inf for none.
        rest: Value in the rest pose [rad, m].
        load: Effort, velocity and damping.
        follows: The value that it follows.
        column: Name of articad's coordinate that is its value, if there is one.
    """

    name: str
    kind: Kind
    axis: FloatArray
    lower: float
    upper: float
    rest: float
    load: Load
    follows: Follows | None = None
    column: str | None = None

    @property
    def finite_range(self) -> tuple[float, float]:
        """Lower and upper, with a far limit for an open end; a stated limit stays, however far it is."""
        far = FAR_RAD if self.kind == "turn" else FAR_M
        return (self.lower if math.isfinite(self.lower) else -far), (self.upper if math.isfinite(self.upper) else far)


@dataclass(frozen=True, eq=False)
class LoweredJoint:
    """A joint in SI units, between two links.

    Attributes:
        name: Valid in every format.
        joint: The joint of the mechanism.
        backwards: True if it leads from the joint's child to its parent.
        parent: Name of the link that carries its frame.
        child: Name of the link that it moves.
        T_parent_joint: Its frame in the parent link's [m].
        T_child_joint: The frame of the child link that coincides with it where all values are zero [m]; identity in a tree.
        freedoms: Its motions, from the parent outwards.
        carriers: Names for links between its motions, and one for a link at its end.
        anchor: Point on its axes, in the child link's frame [m], `(3,)`; the origin unless `lower` keeps frames.
        end: Used by `part_frames` only, if the child link's frame is not the one that the joint moves: a name for a fixed joint, and the
            child link's frame in the moved one [m]. The link between the two joints has the last name of `carriers`.
    """

    name: str
    joint: Joint
    backwards: bool
    parent: str
    child: str
    T_parent_joint: SE3
    T_child_joint: SE3
    freedoms: tuple[AxisMotion, ...]
    carriers: tuple[str, ...]
    anchor: FloatArray = field(default_factory=lambda: np.zeros(3))
    end: tuple[str, SE3] | None = None

    @property
    def is_free(self) -> bool:
        """True for a free joint: formats represent it as a whole, so it has no freedoms here."""
        return self.joint.type is JointType.FREE

    @property
    def T_rest(self) -> SE3:
        """Displacement of a free joint at rest [m]."""
        return metres(self.joint.motion(self.joint.rest))


@dataclass(frozen=True, eq=False)
class Placed:
    """A shape of a link.

    Attributes:
        shape: Mesh and colour; the mesh is in mm.
        T_link_shape: Pose of the mesh's frame in the link's [m].
        color: "#rrggbb".
    """

    shape: Shape
    T_link_shape: SE3
    color: str


@dataclass(frozen=True, eq=False)
class Link:
    """A part as formats represent it.

    Attributes:
        name: Valid in every format.
        part: The part of the assembly.
        T_link_part: The part's frame in the link's [m].
        inertial: In the link's frame.
        moves: False if it needs no mass: it is rigidly connected to the ground, or is a frame of a file that is fixed to another link.
        visuals: Shapes to draw.
        collisions: Shapes for collision.
        friction: Friction of its surfaces; None without a material.
    """

    name: str
    part: Part
    T_link_part: SE3
    inertial: Inertial | None
    moves: bool
    visuals: tuple[Placed, ...]
    collisions: tuple[Placed, ...]
    friction: float | None


@dataclass(frozen=True, eq=False)
class LoweredModel:
    """An assembly in SI units.

    Attributes:
        name: Valid in every format.
        links: Depth first, the ground first.
        joints: Joints of the tree, in the order of the links that they move.
        loops: Joints that close loops.
        couplings: `name -> (freedom, Follows)` that hold in addition to the tree.
        features: Its features, for the table of losses.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[LoweredJoint, ...]
    loops: tuple[LoweredJoint, ...]
    couplings: tuple[tuple[str, str, Follows], ...]
    features: tuple[Feature, ...]


def metres(T: SE3) -> SE3:
    """Return the same motion with its translation in m: divided by 1000 exactly, the rotation unchanged."""
    return SE3.from_unit_array(T.data / np.array([MM_PER_M, MM_PER_M, MM_PER_M, 1.0, 1.0, 1.0, 1.0]))


def lower(assembly: Assembly, reserved: Iterable[str] = (), *, as_it_came: bool = False, part_frames: bool = False) -> LoweredModel:
    """Convert an assembly to links, frames and one-freedom motions in SI units.

    Names become valid, limits and rest values are converted, loads are computed, and each feature that a format may not hold is
    recorded.

    Args:
        assembly: The assembly to write.
        reserved: Names that no link may have.
        as_it_came: Keep the frame of every link and all names, for a format whose joint axes may be anywhere and whose names are any
            text.
        part_frames: Give every link the frame of its part; if that cannot be the joint's frame, the joint has an `end`.
    """
    taken = tuple(reserved)
    question = ("lowered", taken, as_it_came, part_frames)
    return once(assembly, question, lambda: _lower(assembly, taken, as_it_came=as_it_came, part_frames=part_frames))


def _lower(assembly: Assembly, reserved: Iterable[str], *, as_it_came: bool, part_frames: bool) -> LoweredModel:
    mechanism = assembly.mechanism
    names = _ValidNames(assembly, reserved, any_text=as_it_came)
    loads = once(assembly, "loads", lambda: joint_loads(mechanism, assembly.parts))
    T_link_part = {mechanism.ground: mechanism.T_ground}
    joints = []
    moved: list[Feature] = []
    if part_frames and not mechanism.T_ground.allclose(SE3.identity(), mm=ON_AXIS_MM, rad=1e-9):
        moved.append(_moved(mechanism.ground, mechanism.T_ground)._replace(key="root.frame"))
    steps = steps_of_bodies(assembly)
    for edge in mechanism.tree.edges:
        head, K = _frames(edge.joint, backwards=edge.reversed)
        T_link_part[edge.part] = K
        keeps = (assembly.foreign or part_frames) and _keeps_frame(edge.joint, K, anywhere=as_it_came)
        apart = not keeps and not K.allclose(SE3.identity(), mm=ON_AXIS_MM, rad=1e-9)
        if keeps or (apart and part_frames):
            T_link_part[edge.part] = SE3.identity()
        elif assembly.foreign and edge.part not in steps and apart:
            moved.append(_moved(edge.part, K))
        T_parent_joint = metres(T_link_part[edge.parent] @ head @ (K if keeps else SE3.identity()))
        row = _lowered(edge.joint, edge.parent, edge.part, T_parent_joint, SE3.identity(), loads, names, backwards=edge.reversed)
        if keeps:
            row = replace(row, freedoms=tuple(replace(one, axis=_rounded(K.rotation.T @ one.axis)) for one in row.freedoms))
            if as_it_came:
                row = replace(row, anchor=K.inverse().translation / MM_PER_M)
        joints.append(replace(row, end=(names.end(edge.joint), metres(K))) if apart and part_frames else row)
    still = rigid_with_ground(assembly)
    loops = []
    for joint in mechanism.loop_joints:
        # starting at the side that stands still, if one does, so that the end of the joint is never fixed to the ground
        backwards = joint.child in still
        near, far = (joint.child, joint.parent) if backwards else (joint.parent, joint.child)
        head, tail = _frames(joint, backwards=backwards)
        T_parent_joint, T_child_joint = metres(T_link_part[near] @ head), metres(T_link_part[far] @ tail.inverse())
        loops.append(_lowered(joint, near, far, T_parent_joint, T_child_joint, loads, names, backwards=backwards))
    massless = still | without_own_mass(assembly)
    links = tuple(_link(names.links[part], assembly, part, T_link_part[part], moves=part not in massless) for part in mechanism.tree.parts)
    return LoweredModel(
        valid_name(assembly.name),
        links,
        tuple(joints),
        tuple(loops),
        _couplings(assembly, [*joints, *loops]),
        (*_with_steps(features_of(assembly), steps), *names.features(assembly), *moved),
    )


def _keeps_frame(joint: Joint, K: SE3, *, anywhere: bool = False) -> bool:
    """True if the joint's frame can be placed at the part's, whose pose in it is K⁻¹, without changing the motion (see the module).

    With `anywhere`, the joint's axes need not pass through the part's origin.
    """
    if joint.type.quaternion is not None:  # its values are about the frame's own axes
        far = anywhere and joint.type is JointType.BALL
        return K.allclose(SE3.identity(), mm=math.inf if far else ON_AXIS_MM, rad=1e-12)
    if anywhere:
        return True
    origin = K.translation  # of the part, in the joint's frame
    turning = [np.array(step.vector) for step in motions(joint.type) if step.kind == "turn"]
    return all(float(np.linalg.norm(np.cross(axis, origin))) <= ON_AXIS_MM for axis in turning)


def _with_steps(features: Iterable[Feature], steps: set[str]) -> list[Feature]:
    """Return the features with what links between the joints of a body are: they lack no mass, because the file has no such bodies."""
    wheres = {f"parts.{name}" for name in steps}
    return [
        feature._replace(key="chain.step") if feature.key == "mass.missing" and feature.where in wheres else feature for feature in features
    ]


def _moved(part: str, K: SE3) -> Feature:
    x, y, z = np.round(K.inverse().translation, 9) + 0.0
    return Feature(
        "link.frame",
        f"parts.{part}",
        f"moved by {x:.6g}, {y:.6g}, {z:.6g} mm in its own axes, turned by {math.degrees(float(K.angle_to(SE3.identity()))):.6g}°",
    )


def _rounded(axis: FloatArray) -> FloatArray:
    """Return a unit vector with components rounded to whole numbers if they are almost whole."""
    whole = np.round(axis)
    return np.asarray(np.where(np.abs(axis - whole) < ROUND, whole, axis)) + 0.0


def ground_is_world(assembly: Assembly) -> bool:
    """Return whether the ground part is the world itself, which SDFormat and MJCF have without a link: bare, and named `world`."""
    ground = assembly.parts[assembly.mechanism.ground]
    bare = not ground.visuals and not ground.collisions and ground.solid is None and ground.mass is None
    still = assembly.mechanism.T_ground.allclose(SE3.identity(), mm=0.0, rad=0.0)
    return bare and still and ground.name == "world" and len(assembly.parts) > 1


class _ValidNames:
    """Valid names of links and joints; declared names are claimed before those of carriers, in the order of declaration."""

    def __init__(self, assembly: Assembly, reserved: Iterable[str], *, any_text: bool) -> None:
        self._any_text = any_text
        valid = str if any_text else valid_name
        self._link_names, self._joint_names = Names(reserved, valid=valid), Names(valid=valid)
        self.links = {part: self._link_names.claim(part) for part in assembly.mechanism.parts}
        self.joints = {joint.name: self._joint_names.claim(joint.name) for joint in assembly.mechanism.joints}
        self._changed = [("parts", *item) for item in self._link_names.changed.items()]
        self._changed += [("joints", *item) for item in self._joint_names.changed.items()]

    def motions(self, joint: Joint) -> tuple[str, ...]:
        """Return the names of a joint's motions: its own name if there is one motion, else `joint__suffix`."""
        base = self.joints[joint.name]
        return tuple(self._joint_names.claim(f"{base}__{step.suffix}") if step.suffix else base for step in motions(joint.type))

    def carriers(self, joint: Joint) -> tuple[str, ...]:
        """Return names of the links that carry a joint's motions except the last, and one for a link at its end."""
        base = self.joints[joint.name]
        count = len(motions(joint.type))
        return tuple(self._link_names.claim(f"{base}__d{number + 1}") for number in range(max(count, 1)))

    def end(self, joint: Joint) -> str:
        """Return the name of a fixed joint at a joint's end."""
        return self._joint_names.claim(f"{self.joints[joint.name]}__fixed")

    def features(self, assembly: Assembly) -> list[Feature]:
        """Return features for names that had to change."""
        features = [Feature("name", f"{kind}.{old}", new) for kind, old, new in self._changed]
        if valid_name(assembly.name) != assembly.name and not self._any_text:
            features.append(Feature("name", "name", valid_name(assembly.name)))
        return features


def _lowered(
    joint: Joint,
    parent: str,
    child: str,
    T_parent_joint: SE3,
    T_child_joint: SE3,
    loads: Mapping[str, tuple[Load, ...]],
    names: _ValidNames,
    *,
    backwards: bool,
) -> LoweredJoint:
    """Return the joint with its motions from the tree's parent outwards; backwards these are in reverse order, about reversed axes."""
    motion_names = names.motions(joint)
    freedoms = [_freedom(joint, motion_names, index, loads[joint.name][index]) for index in range(len(motion_names))]
    if backwards:
        freedoms = [replace(freedom, axis=0.0 - freedom.axis) for freedom in reversed(freedoms)]  # 0 − x, so that no −0 is written
    return LoweredJoint(
        names.joints[joint.name],
        joint,
        backwards,
        names.links[parent],
        names.links[child],
        T_parent_joint,
        T_child_joint,
        tuple(freedoms),
        names.carriers(joint),
    )


def _frames(joint: Joint, *, backwards: bool) -> tuple[SE3, SE3]:
    """Return the joint's frame in the part before it, and the part after it in its link's frame [mm]."""
    if backwards:
        return joint.T_child_connector @ flip(joint.mate), joint.T_parent_connector.inverse()
    return joint.T_parent_connector, flip(joint.mate) @ joint.T_child_connector.inverse()


def _freedom(joint: Joint, names: tuple[str, ...], index: int, load: Load) -> AxisMotion:
    step = motions(joint.type)[index]
    axis = np.array(step.vector)
    if joint.type is JointType.BALL:
        lower, upper = ball_box(joint)[index]
        return AxisMotion(names[index], step.kind, axis, lower, upper, ball_angles(joint.rest)[index], load)
    if step.advances:  # the slide of a screw follows its turn
        ratio = joint.lead / math.tau / MM_PER_M
        ends = sorted((ratio * joint.limits.lower[0], ratio * joint.limits.upper[0]))
        return AxisMotion(names[index], step.kind, axis, ends[0], ends[1], ratio * joint.rest[0], load, Follows(names[1], ratio, 0.0))
    unit = 1.0 if step.kind == "turn" else MM_PER_M
    assert step.coordinate is not None
    at = step.coordinate
    lower, upper, rest = joint.limits.lower[at] / unit, joint.limits.upper[at] / unit, joint.rest[at] / unit
    return AxisMotion(names[index], step.kind, axis, lower, upper, rest, load, column=joint.column_names[at])


def ball_angles(xyzw: tuple[float, ...]) -> tuple[float, float, float]:
    """Return (rx, ry, rz) with R(q) = Rx(rx) · Ry(ry) · Rz(rz) [rad]."""
    R = SE3.from_quaternion(xyzw).rotation
    ry = math.atan2(R[0, 2], math.hypot(R[0, 0], R[0, 1]))
    rx = math.atan2(-R[1, 2], R[2, 2])
    # from R with the first turn removed, which stays exact at ry = ±90°, where rx and rz cannot be separated
    s, c = math.sin(rx), math.cos(rx)
    rz = math.atan2(c * R[1, 0] + s * R[2, 0], c * R[1, 1] + s * R[2, 1])
    return rx, ry, rz


def ball_box(joint: Joint) -> tuple[tuple[float, float], ...]:
    """Return ranges of (rx, ry, rz) that contain everything a ball's cone and twist allow [rad].

    The swing of Rx(a)·Ry(b) has cos(swing) = cos a · cos b, so |a| and |b| are at most the cone; its own twist is
    2·atan(tan(a/2)·tan(b/2)), largest where a = b, and rz is the ball's twist minus this.
    """
    limits = joint.limits
    cone = math.pi if limits.cone is None else limits.cone
    if cone >= math.pi / 2:
        swing, about_y, own_twist = math.inf, math.pi / 2, math.inf
    else:
        swing = about_y = cone
        own_twist = 2 * math.atan(math.tan(math.acos(math.sqrt(math.cos(cone))) / 2) ** 2)
    low, high = (-math.inf, math.inf) if limits.twist is None else (limits.twist[0] - own_twist, limits.twist[1] + own_twist)
    return (-swing, swing), (-about_y, about_y), (low, high)


def ball_total_angle(joint: Joint) -> float:
    """Return the largest total angle of a ball within its cone and twist [rad]; π or more means no limit.

    A swing s and a twist t together rotate by 2·acos(cos(s/2)·cos(t/2)).
    """
    limits = joint.limits
    cone = math.pi if limits.cone is None else limits.cone
    twist = math.pi if limits.twist is None else min(math.pi, max(map(abs, limits.twist)))
    return 2 * math.acos(math.cos(cone / 2) * math.cos(twist / 2))


def _couplings(assembly: Assembly, joints: list[LoweredJoint]) -> tuple[tuple[str, str, Follows], ...]:
    """Return couplings between freedoms: q_b = k q_a + c, in SI units."""
    by_column = {freedom.column: freedom for joint in joints for freedom in joint.freedoms if freedom.column is not None}
    rows = []
    for coupling in assembly.mechanism.couplings:
        a, b = by_column[coupling.a], by_column[coupling.b]
        unit_a, unit_b = (MM_PER_M if freedom.kind == "slide" else 1.0 for freedom in (a, b))
        rows.append((coupling.name, b.name, Follows(a.name, coupling.ratio * unit_a / unit_b, coupling.offset / unit_b)))
    return tuple(rows)


def _link(name: str, assembly: Assembly, part_name: str, T_link_part: SE3, *, moves: bool) -> Link:
    part = assembly.parts[part_name]
    material = assembly.materials.get(part.material) if part.material is not None else None
    known = part.mass is not None and part.mass.mass > 0
    return Link(
        name,
        part,
        metres(T_link_part),
        Inertial.from_part(part.mass, T_link_part).possible() if known and part.mass is not None else None,
        moves,
        tuple(_placed(shape, part, T_link_part) for shape in part.visuals or (() if assembly.foreign else part.collisions)),
        tuple(_placed(shape, part, T_link_part) for shape in (solid_enough(part) if part.collisions or not assembly.foreign else ())),
        None if material is None else material.friction,
    )


def _placed(shape: Shape, part: Part, T_link_part: SE3) -> Placed:
    return Placed(shape, metres(T_link_part @ shape.frame), shape.color or part.color)
