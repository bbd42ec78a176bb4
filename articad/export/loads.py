"""Effort, velocity and damping of joints that state none: from mass, gravity and the worst pose.

For a joint that carries the parts i with masses mᵢ, where rᵢ bounds the distance of part i's centre of mass to the axis (or to
the origin of a ball or universal joint) in every pose, R bounds that of their surfaces, and Jᵢ is the largest principal moment:

- turning effort = 2 · max(g Σ mᵢ rᵢ, (g / R) Σ (mᵢ rᵢ² + Jᵢ)): holds the worst pose however the assembly stands, and accelerates the
  farthest point at g where gravity asks for nothing, as at a wheel;
- sliding effort = 2 · g Σ mᵢ;
- turning velocity = √(2 g / R), at which the farthest point is as fast as after falling by R;
- sliding velocity = √(2 g L), with L the joint's range, or 2 R where it has none;
- a screw turns with the effort of a turning joint plus lead / 2π times the sliding effort;
- damping = 5 % of effort / velocity.

A joint in a loop carries every part that its loop carries.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.geometry.mass import MassProperties
from articad.geometry.part import Part
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism

FloatArray = NDArray[np.float64]

GRAVITY_M_S2 = 9.81
MARGIN = 2.0  # for friction and acceleration, on top of holding the load
DAMPING_SHARE = 0.05  # of the effort, spent at full velocity
LEAST_REACH_M = 1e-3  # a joint whose parts have no extent still gets a finite velocity
LEAST_MASS_KG = 1e-4  # a joint that carries no mass still gets an effort
MM_PER_M = 1000.0


@dataclass(frozen=True)
class Load:
    """What one coordinate of a joint can do.

    Attributes:
        effort: [N·m] or [N].
        velocity: [rad/s] or [m/s].
        damping: [N·m·s/rad] or [N·s/m].
    """

    effort: float
    velocity: float
    damping: float


@dataclass(frozen=True)
class _Carried:
    """What a joint carries: Σm, Σm·r, Σ(m·r² + J), the reach R; kg and m."""

    mass: float
    moment: float
    inertia: float
    reach: float


@dataclass(frozen=True)
class _Seen:
    """How a part is seen from a joint: exactly placed, or somewhere within `radius` of its point `anchor` [mm]."""

    T: SE3 | None
    radius: float
    anchor: FloatArray


def joint_loads(mechanism: Mechanism, parts: Mapping[str, Part]) -> dict[str, tuple[Load, ...]]:
    """Return the loads of every joint, one per motion: turning and sliding motions in the order of `motions_of`.

    Args:
        mechanism: The joints, and which parts each carries.
        parts: Masses and shapes by part name.

    Returns:
        By joint name; a fixed joint has none.
    """
    neighbours = _neighbours(mechanism)
    carried = _carried_parts(mechanism)
    loads: dict[str, tuple[Load, ...]] = {}
    for joint in mechanism.joints:
        if joint.type is JointType.FIXED:
            loads[joint.name] = ()
            continue
        moved, names = carried[joint.name]
        frame = joint.T_child_connector if moved == joint.child else joint.T_parent_connector
        total = _sum(moved, frame, names, neighbours, parts, about_axis=joint.type not in {JointType.BALL, JointType.UNIVERSAL})
        loads[joint.name] = _loads(joint, total)
    return loads


def _loads(joint: Joint, carried: _Carried) -> tuple[Load, ...]:
    g = GRAVITY_M_S2
    lead = abs(joint.lead) / MM_PER_M / math.tau  # [m/rad]
    force = MARGIN * g * carried.mass
    torque = MARGIN * max(g * carried.moment, g / carried.reach * carried.inertia) + force * lead
    omega = math.sqrt(2 * g / carried.reach)
    turn = _load(torque, omega)
    if joint.type is JointType.SCREW:
        return _load(force, omega * lead), _stated(joint, 0, turn, MM_PER_M, 1.0)
    if joint.type is JointType.BALL:
        return tuple(_stated(joint, 0, turn, MM_PER_M, 1.0) for _ in range(3))
    loads = []
    for index, (unit, lower, upper) in enumerate(zip(joint.type.units, joint.limits.lower, joint.limits.upper, strict=True)):
        if unit == "rad":
            loads.append(_stated(joint, index, turn, MM_PER_M, 1.0))
        else:
            length = (upper - lower) / MM_PER_M if math.isfinite(upper - lower) else 2 * carried.reach
            loads.append(_stated(joint, index, _load(force, math.sqrt(2 * g * max(length, LEAST_REACH_M))), 1.0, MM_PER_M))
    return tuple(loads)


def _load(effort: float, velocity: float) -> Load:
    return Load(effort, velocity, DAMPING_SHARE * effort / velocity)


def _stated(joint: Joint, index: int, computed: Load, effort_unit: float, velocity_unit: float) -> Load:
    """Return the load with what the joint states itself; a torque is stated in N·mm, a sliding velocity in mm/s."""
    effort = joint.effort[index] if index < len(joint.effort) else None
    velocity = joint.velocity[index] if index < len(joint.velocity) else None
    if effort is None and velocity is None:
        return computed
    return _load(
        computed.effort if effort is None else effort / effort_unit, computed.velocity if velocity is None else velocity / velocity_unit
    )


def _carried_parts(mechanism: Mechanism) -> dict[str, tuple[str, frozenset[str]]]:
    """Return for each joint the part next to it that moves, and all parts that it carries."""
    tree = mechanism.tree
    subtrees = {edge.part: frozenset(tree.subtree(edge.part)) for edge in tree.edges}
    carried = {edge.part: subtrees[edge.part] for edge in tree.edges}
    closing = {}
    for joint in mechanism.loop_joints:
        path = tree.path(joint.parent, joint.child)
        top = min(path, key=tree.depth)
        below = [part for part in path if part != top]
        together = frozenset().union(*(subtrees[part] for part in below))
        for part in below:
            carried[part] |= together
        closing[joint.name] = (joint.child if joint.child != top else joint.parent, together)
    return {edge.joint.name: (edge.part, carried[edge.part]) for edge in tree.edges} | closing


def _neighbours(mechanism: Mechanism) -> dict[str, list[tuple[Joint, str]]]:
    """Return the tree's joints at each part, with the part on their other side."""
    neighbours: dict[str, list[tuple[Joint, str]]] = {part: [] for part in mechanism.parts}
    for edge in mechanism.tree.edges:
        neighbours[edge.parent].append((edge.joint, edge.part))
        neighbours[edge.part].append((edge.joint, edge.parent))
    return neighbours


def _sum(
    moved: str,
    frame: SE3,
    names: frozenset[str],
    neighbours: Mapping[str, list[tuple[Joint, str]]],
    parts: Mapping[str, Part],
    *,
    about_axis: bool,
) -> _Carried:
    """Add up what a joint with this frame in part `moved` carries."""
    seen = {moved: _Seen(frame.inverse(), 0.0, np.zeros(3))}
    queue = [moved]
    for name in queue:  # grows while it is walked: the tree, breadth first from the joint
        for joint, other in neighbours[name]:
            if other not in seen:
                seen[other] = _across(seen[name], joint, other)
                queue.append(other)
    mass = moment = inertia = 0.0
    reach = LEAST_REACH_M
    for name in queue:
        if name not in names:
            continue
        part = parts[name]
        body = part.mass or MassProperties.none()
        r = _distance(seen[name], body.com, about_axis=about_axis) / MM_PER_M
        mass += body.mass
        moment += body.mass * r
        inertia += body.mass * r * r + float(body.principal_moments[-1]) / MM_PER_M**2
        reach = max(reach, r, _reach(seen[name], part, about_axis=about_axis) / MM_PER_M)
    if mass < LEAST_MASS_KG:
        mass, moment, inertia = LEAST_MASS_KG, LEAST_MASS_KG * reach, LEAST_MASS_KG * reach * reach
    return _Carried(mass, moment, inertia, reach)


def _across(near: _Seen, joint: Joint, far: str) -> _Seen:
    """Return how the far side of a joint is seen, given how its near side is."""
    here, there = joint.T_parent_connector, joint.T_child_connector
    if far != joint.child:
        here, there = there, here
    if joint.type is JointType.FIXED and near.T is not None:
        across = here @ flip(joint.mate) @ there.inverse()  # F is its own inverse, so this holds in both directions
        return _Seen(near.T @ across, 0.0, np.zeros(3))
    radius = _distance(near, here.translation, about_axis=False) + _travel(joint)
    return _Seen(None, radius, there.translation)


def _travel(joint: Joint) -> float:
    """Return the farthest a joint's two frames move apart [mm]; an endless slide counts as none."""
    ranges = zip(joint.type.units, joint.limits.lower, joint.limits.upper, strict=False)
    far = [max(abs(lower), abs(upper)) for unit, lower, upper in ranges if unit == "mm"]
    if joint.type is JointType.SCREW:
        far = [abs(joint.lead) / math.tau * max(abs(joint.limits.lower[0]), abs(joint.limits.upper[0]))]
    return math.hypot(*(travel if math.isfinite(travel) else 0.0 for travel in far))


def _distance(seen: _Seen, point: FloatArray, *, about_axis: bool) -> float:
    """Bound the distance [mm] of a part's point to the joint's axis or origin."""
    if seen.T is None:
        return seen.radius + float(np.linalg.norm(point - seen.anchor))
    x, y, z = seen.T.apply(point)
    return math.hypot(x, y) if about_axis else math.hypot(x, y, z)


def _reach(seen: _Seen, part: Part, *, about_axis: bool) -> float:
    """Bound the distance [mm] of a part's surface to the joint's axis or origin: by its vertices, or by its box if it moves itself."""
    meshes = [shape.placed for shape in (*part.visuals, *part.collisions)] or ([] if part.mesh is None else [part.mesh])
    if not meshes:
        return 0.0
    if seen.T is None:
        low = np.min([mesh.bounds[0] for mesh in meshes], axis=0)
        high = np.max([mesh.bounds[1] for mesh in meshes], axis=0)
        return max(_distance(seen, np.array(corner), about_axis=False) for corner in product(*zip(low, high, strict=True)))
    points = seen.T.apply(np.concatenate([mesh.vertices for mesh in meshes]))
    return float(np.linalg.norm(points[:, :2] if about_axis else points, axis=1).max())
