"""FreeCAD's joints that only restrict other joints: Distance, Parallel, Perpendicular and Angle.

FreeCAD states them between two coordinate systems on two parts, often beside another joint of the same parts: a Cylindrical joint with a
Distance is a hinge, a Ball with a Perpendicular is a universal joint. All joints between two parts are therefore read together: the
relative motions that they leave are the null space of their equations at the pose of the document. If these motions are those of one of
articad's joints, and the equations hold along them at finite distances too, that joint takes the place of all of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.kinematics.joints import Joint, JointLimits, JointType

CONSTRAINTS = ("Distance", "Parallel", "Perpendicular", "Angle")
HOLDS = 1e-4  # by which the document may miss an equation [mm, or 1]: FreeCAD's solver leaves this much
_SAME = 1e-4  # by which an equation may change along a motion that it leaves, relative to the size of the parts
_FREE = 1e-4  # singular value below which a motion is left, relative to the largest
_LEVEL = 1e-3  # by which directions and points of motions may differ, relative to 1 and to the size of the parts
_RIGHT = 1e-9  # cosine below which an angle is a right one
_STEP = 1e-6  # of central differences
_SAMPLES = ((0.7, -0.4, 0.9), (-1.3, 0.8, 0.5), (2.1, 1.1, -1.7))  # coordinates at which equations are tried [rad, or a length]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Constraint:
    """One of FreeCAD's joints that restrict.

    Attributes:
        name: Its name.
        kind: FreeCAD's word.
        parts: The two parts.
        connectors: Names of its coordinate systems.
        frames: The coordinate systems, each in its part.
        value: The distance [mm], signed, or the angle [rad].
        points: True for a distance between two points; otherwise a distance is between two planes.
    """

    name: str
    kind: str
    parts: tuple[str, str]
    connectors: tuple[str, str]
    frames: tuple[SE3, SE3]
    value: float
    points: bool = False


def merged(joints: Sequence[Joint], constraints: Sequence[Constraint], poses: Mapping[str, SE3]) -> list[Joint] | tuple[Constraint, str]:
    """Return the joints with those that the constraints restrict replaced, or the constraint that cannot be read and why.

    Args:
        joints: The other joints.
        constraints: The constraints, of any parts.
        poses: Poses of the parts in the document.
    """
    here, held = dict[tuple[str, ...], list[Constraint]](), dict[tuple[str, ...], list[Joint]]()
    for constraint in constraints:
        here.setdefault(tuple(sorted(constraint.parts)), []).append(constraint)
    for joint in joints:
        if joint.type is not JointType.FREE:
            held.setdefault(tuple(sorted((joint.parent, joint.child))), []).append(joint)
    gone, made = set[str](), []
    for pair, stated in here.items():
        one = _one_joint(held.get(pair, []), stated, poses)
        if isinstance(one, str):
            return stated[0], one
        gone.update(joint.name for joint in held.get(pair, []))
        made.append(one)
    return [*(joint for joint in joints if joint.name not in gone), *made]


def _one_joint(held: list[Joint], here: list[Constraint], poses: Mapping[str, SE3]) -> Joint | str:
    """Return the one joint that all joints between two parts are together, or the reason why there is none."""
    parent, child = (held[0].parent, held[0].child) if held else here[0].parts
    T = poses[parent].inverse() @ poses[child]
    equations = [_turned_round(constraint, parent) for constraint in here]
    for equation in equations:
        miss = float(np.abs(_residual(equation, T)).max())
        if not miss <= HOLDS:
            return f"misses its value by {miss:.3g} where the parts stand: solve the assembly in FreeCAD and save it"
    try:
        known = [joint if joint.parent == parent else joint.reversed() for joint in held]
    except ArticadError:
        return "stands beside a joint that cannot be read from its other side"
    frames = [frame for equation in equations for frame in equation.frames] + [joint.T_child_connector for joint in known]
    size = max(1.0, *(float(np.linalg.norm(frame.translation)) for frame in frames))

    def residual(at: SE3) -> FloatArray:
        """Return the change of all equations from `T` to `at`, relative to the size of the parts."""
        rows = [_scaled(_residual(equation, at) - _residual(equation, T), equation, size) for equation in equations]
        return np.concatenate([*rows, *(_of_joint(joint, T, at, size) for joint in known)])

    motions = _null_space(residual, T, size)
    found = _joint_of(motions, size)
    universal = _universal(known, equations, T) if found is None and len(motions) == 2 else None
    if universal is not None:
        return universal
    if found is None or not _holds_along(found, residual, T):
        words = " and ".join([*(f"{joint.name!r}" for joint in held), *(f"{constraint.name!r}" for constraint in here)])
        return f"leaves motions that no joint of articad has ({words} together leave {len(motions)} of 6)"
    kind, axis = found
    same = next((joint for joint in known if joint.type is kind), None)
    if same is not None:
        return next(joint for joint in held if joint.name == same.name)  # what else is stated here follows from it
    return _restricted(known, kind, axis, T) or _new(here[0], held, kind, axis, T, parent, child)


# ---------------------------------------------------------------------- equations


def _turned_round(constraint: Constraint, parent: str) -> Constraint:
    """Return a constraint seen from a part; equations of planes stay those of the first one's plane."""
    if constraint.parts[0] == parent:
        return constraint
    return replace(constraint, parts=constraint.parts[::-1], connectors=constraint.connectors[::-1], frames=constraint.frames[::-1])


def _residual(constraint: Constraint, T: SE3) -> FloatArray:
    """Return what an equation misses when the child stands at `T` in the parent: lengths in mm, others as sines."""
    D = constraint.frames[0].inverse() @ T @ constraint.frames[1]
    R, p = D.rotation, D.translation
    tilt = R[:2, 2]
    if constraint.kind == "Perpendicular":
        return np.array([R[2, 2]])
    if constraint.kind == "Parallel" or (constraint.kind == "Angle" and abs(math.sin(constraint.value)) < _RIGHT):
        return np.array(tilt)
    if constraint.kind == "Angle":
        cosine = math.cos(constraint.value)
        return np.array([R[2, 2] if abs(cosine) < _RIGHT else abs(R[2, 2]) - abs(cosine)])  # FreeCAD stores no direction of axes
    if constraint.points:
        return np.array(p)
    return np.array([abs(p[2]) - abs(constraint.value) if constraint.value else p[2], *tilt])


def _scaled(rows: FloatArray, constraint: Constraint, size: float) -> FloatArray:
    """Return the rows of a constraint with lengths relative to a size."""
    if constraint.kind != "Distance":
        return rows
    return rows / size if constraint.points else rows / np.array([size, 1.0, 1.0])


def _of_joint(joint: Joint, T: SE3, at: SE3, size: float) -> FloatArray:
    """Return how a joint is violated at a pose of the child in the parent, against `T`; lengths are relative to a size."""
    flip = FLIP if joint.mate is Mate.OPPOSED else SE3.identity()
    before, now = (joint.T_parent_connector.inverse() @ pose @ joint.T_child_connector @ flip.inverse() for pose in (T, at))
    D = before.inverse() @ now
    R, p, R_0 = D.rotation, D.translation / size, before.rotation
    moved = (now.translation - before.translation) / size
    turned = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2.0
    tilt = now.rotation[:2, 2] - R_0[:2, 2]
    return {
        JointType.FIXED: np.concatenate([p, turned]),
        JointType.REVOLUTE: np.concatenate([moved, tilt]),
        JointType.SLIDER: np.concatenate([moved[:2], turned]),
        JointType.CYLINDRICAL: np.concatenate([moved[:2], tilt]),
        JointType.BALL: np.array(moved),
        JointType.PLANAR: np.concatenate([moved[2:], tilt]),
    }.get(joint.type, np.concatenate([p, turned]))


def _null_space(residual: Callable[[SE3], FloatArray], T: SE3, size: float) -> FloatArray:
    """Return the motions of the child in its own frame that change no equation to first order `(k, 6)`.

    A motion is (v / size, ω): the singular values of the equations then do not depend on the unit of length.
    """
    columns = []
    for place in range(6):
        step = np.zeros(6)
        step[place] = _STEP * (size if place < 3 else 1.0)
        columns.append((residual(T @ SE3.exp(step)) - residual(T @ SE3.exp(-step))) / (2.0 * _STEP))
    J = np.stack(columns, axis=1)
    _, singular, rows = np.linalg.svd(J)
    rank = int((singular > _FREE * float(singular.max(initial=0.0))).sum())
    return np.asarray(rows[rank:], dtype=np.float64)


# ---------------------------------------------------------------------- motions


def _joint_of(motions: FloatArray, size: float) -> tuple[JointType, SE3] | None:
    """Return the joint with these motions, and its frame in the child: z along its axis, or normal to its plane."""
    count, turns = len(motions), int(np.linalg.matrix_rank(motions[:, 3:], tol=_LEVEL)) if len(motions) else 0
    if count == 0:
        return JointType.FIXED, SE3.identity()
    if turns == 0:
        return (JointType.SLIDER, _axis(motions[0, :3], np.zeros(3))) if count == 1 else None
    if turns == 3 and count == 3:  # v = c × ω for turns about c
        rows = np.concatenate([-_cross(omega) for omega in motions[:, 3:]])
        center, *_ = np.linalg.lstsq(rows, motions[:, :3].ravel(), rcond=None)
        fits = np.allclose(rows @ center, motions[:, :3].ravel(), atol=_LEVEL)
        return (JointType.BALL, SE3.from_translation(size * center)) if fits else None
    return _about_one_direction(motions, size) if turns == 1 else None


def _about_one_direction(motions: FloatArray, size: float) -> tuple[JointType, SE3] | None:
    """Return the joint whose turns are all about one direction: a hinge, a cylindrical joint or a plane."""
    omega = np.linalg.svd(motions[:, 3:])[2][0]
    turn = np.linalg.lstsq(motions[:, 3:].T, omega, rcond=None)[0] @ motions
    axis, slides = _axis(omega, size * np.cross(omega, turn[:3])), _slides(motions)  # v + ω × p is along ω
    if len(motions) == 1:
        kind, off = JointType.REVOLUTE, abs(float(np.dot(turn[:3], omega)))
    elif len(motions) == 2:
        kind, off = JointType.CYLINDRICAL, float(np.linalg.norm(np.cross(slides[0], omega)))
    else:
        kind, off = JointType.PLANAR, float(np.abs(slides @ omega).max(initial=0.0))
    return (kind, axis) if len(motions) <= 3 and off < _LEVEL else None


def _slides(motions: FloatArray) -> FloatArray:
    """Return the pure translations among motions `(k − 1, 3)`, orthonormal."""
    _, _, rows = np.linalg.svd(motions[:, 3:].T)
    free = rows[1:] @ motions
    return np.asarray(free[:, :3] / np.maximum(np.linalg.norm(free[:, :3], axis=1, keepdims=True), 1e-300))


def _holds_along(found: tuple[JointType, SE3], residual: Callable[[SE3], FloatArray], T: SE3) -> bool:
    """Return whether the equations hold at finite values of the joint, too."""
    kind, axis = found
    count = len(kind.coordinates)
    if kind is JointType.BALL:
        values = [SE3.from_axis_angle(np.array(sample) / np.linalg.norm(sample), 1.0).quaternion for sample in _SAMPLES]
    else:
        values = [np.array(sample[:count]) for sample in _SAMPLES]
    return all(float(np.abs(residual(T @ axis @ kind.motion(value) @ axis.inverse())).max(initial=0.0)) < _SAME for value in values)


def _restricted(known: list[Joint], kind: JointType, axis: SE3, T: SE3) -> Joint | None:
    """Return a Cylindrical joint of which one motion is left, with that motion's limits; None if there is none on this axis."""
    for joint in known:
        if joint.type is not JointType.CYLINDRICAL or kind not in (JointType.REVOLUTE, JointType.SLIDER):
            continue
        flip = FLIP if joint.mate is Mate.OPPOSED else SE3.identity()
        along, turn = joint.rest
        place = 1 if kind is JointType.REVOLUTE else 0
        kept = SE3.trans(0.0, 0.0, along) if kind is JointType.REVOLUTE else SE3.rot_z(turn)
        near = joint.T_parent_connector @ kept
        D = near.inverse() @ T @ joint.T_child_connector @ flip.inverse()
        child_axis = (joint.T_child_connector.inverse() @ axis).rotation[:, 2]
        if 1.0 - abs(float(child_axis[2])) > _SAME or float(np.linalg.norm(D.translation[:2])) > HOLDS:
            continue
        limits = JointLimits((joint.limits.lower[place],), (joint.limits.upper[place],))
        name = f"{joint.parent_connector}_{joint.name}"
        return replace(joint, type=kind, T_parent_connector=near, parent_connector=name, rest=(joint.rest[place],), limits=limits)
    return None


def _new(first: Constraint, held: list[Joint], kind: JointType, axis: SE3, T: SE3, parent: str, child: str) -> Joint:
    """Return a joint of a kind about an axis in the child, at rest where the document stands."""
    name = held[0].name if held else first.name
    rest = (0.0, 0.0, 0.0, 1.0) if kind is JointType.BALL else (0.0,) * len(kind.coordinates)
    endless = () if kind in (JointType.BALL, JointType.FIXED) else (math.inf,) * len(rest)
    return Joint(
        name=name,
        type=kind,
        parent=parent,
        child=child,
        parent_connector=f"{name}_1",
        child_connector=f"{name}_2",
        T_parent_connector=T @ axis,
        T_child_connector=axis,
        limits=JointLimits(tuple(-bound for bound in endless), endless),
        rest=rest,
    )


def _universal(known: list[Joint], equations: list[Constraint], T: SE3) -> Joint | None:
    """Return the universal joint that a Ball and a Perpendicular are: x of the parent's frame stays normal to y of the child's."""
    balls = [joint for joint in known if joint.type is JointType.BALL]
    crossed = [equation for equation in equations if equation.kind == "Perpendicular"]
    if len(balls) != 1 or len(crossed) != 1 or len(known) + len(equations) != 2:
        return None
    ball, cross = balls[0], crossed[0]
    x, y = cross.frames[0].rotation[:, 2], cross.frames[1].rotation[:, 2]
    z = np.cross(x, T.rotation @ y)  # of both frames, where the document stands
    z = z / np.linalg.norm(z)
    x = np.cross(T.rotation @ y, z)  # exactly normal
    near = SE3.from_rotation(np.column_stack([x, np.cross(z, x), z]), ball.T_parent_connector.translation)
    z = T.rotation.T @ z
    far = SE3.from_rotation(np.column_stack([np.cross(y, z), y, z]), ball.T_child_connector.translation)
    endless = (math.inf, math.inf)
    return replace(
        ball,
        type=JointType.UNIVERSAL,
        T_parent_connector=near,
        T_child_connector=far,
        parent_connector=f"{ball.parent_connector}_{ball.name}",
        child_connector=f"{ball.child_connector}_{ball.name}",
        mate=Mate.ALIGNED,
        rest=(0.0, 0.0),
        limits=JointLimits((-math.inf, -math.inf), endless),
    )


def _axis(z: FloatArray, point: FloatArray) -> SE3:
    """Return a frame at a point, its z axis along `z`."""
    z = z / np.linalg.norm(z)
    across = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(across, z)
    x /= np.linalg.norm(x)
    return SE3.from_rotation(np.column_stack([x, np.cross(z, x), z]), point)


def _cross(vector: FloatArray) -> FloatArray:
    """Return the matrix of v ↦ vector × v."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def planar_faces(
    vertices: FloatArray, triangles: NDArray[np.int32], face: NDArray[np.int32]
) -> Iterator[tuple[int, FloatArray, FloatArray]]:
    """Yield the number of each planar face of a mesh, from 1 on, a point on it and its normal."""
    size = float(np.abs(vertices).max(initial=1.0))
    for number in np.unique(face):
        corners = vertices[np.unique(triangles[face == number])]
        middle = corners.mean(axis=0)
        _, spread, rows = np.linalg.svd(corners - middle, full_matrices=False)
        if len(spread) == 3 and spread[1] > 1e-9 * size and spread[2] < 1e-9 * size * math.sqrt(len(corners)):
            yield int(number) + 1, middle, rows[2]
