"""Effort, velocity and damping of joints that state none: from mass, gravity and the worst pose.

For a joint that carries the parts i with masses mᵢ, where rᵢ bounds the distance of part i's centre of mass to the axis (or to
the origin of a ball or universal joint) in every pose, R bounds that of their surfaces, and Jᵢ is the largest principal moment:

- turning effort = 2 · max(g Σ mᵢ rᵢ, (g / R) Σ (mᵢ rᵢ² + Jᵢ)): holds the worst pose whatever the orientation of the assembly, and
accelerates the farthest point at g where gravity needs no effort, as at a wheel;
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
from dataclasses import dataclass, replace

from articad.export.carried import LEAST_REACH_M, MM_PER_M, Carried, CarriedParts
from articad.geometry.part import Part
from articad.kinematics.dynamics import GRAVITY
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism

GRAVITY_M_S2 = -GRAVITY[2]
MARGIN = 2.0  # for friction and acceleration, in addition to holding the load
DAMPING_SHARE = 0.05  # of the effort, lost at full velocity
DIGITS = 9  # of computed values: their last bits depend on the processor, and files must not


ALL = frozenset({"effort", "velocity", "damping"})


@dataclass(frozen=True)
class Load:
    """Load and limits of one coordinate of a joint.

    Attributes:
        effort: [N·m] or [N].
        velocity: [rad/s] or [m/s].
        damping: [N·m·s/rad] or [N·s/m].
        carried: Inertia about the axis, or mass, that it moves in the worst pose [kg·m²] or [kg].
        friction: Coulomb friction [N·m] or [N].
        assumed: Which of effort, velocity and damping the joint does not state.
    """

    effort: float
    velocity: float
    damping: float
    carried: float
    friction: float = 0.0
    assumed: frozenset[str] = ALL


def joint_loads(mechanism: Mechanism, parts: Mapping[str, Part]) -> dict[str, tuple[Load, ...]]:
    """Return the loads of every joint, one per motion: turning and sliding motions in the order of `motions_of`.

    Args:
        mechanism: The joints and the parts that each carries.
        parts: Masses and shapes by part name.

    Returns:
        By joint name; a fixed or free joint has none.
    """
    carried = CarriedParts(mechanism, parts)
    return {
        joint.name: () if joint.type in {JointType.FIXED, JointType.FREE} else _loads(joint, carried.of(joint))
        for joint in mechanism.joints
    }


def _loads(joint: Joint, carried: Carried) -> tuple[Load, ...]:
    g = GRAVITY_M_S2
    lead = abs(joint.lead) / MM_PER_M / math.tau  # [m/rad]
    force = _rounded(MARGIN * g * carried.mass)
    torque = _rounded(MARGIN * max(g * carried.moment, g / carried.reach * carried.inertia) + force * lead)
    omega = _rounded(math.sqrt(2 * g / carried.reach))
    turn = _load(torque, omega, carried.inertia)
    if joint.type is JointType.SCREW:
        return _load(force, omega * lead, carried.mass), _stated(joint, 0, turn, MM_PER_M, 1.0)
    if joint.type is JointType.BALL:
        return tuple(_stated(joint, 0, turn, MM_PER_M, 1.0) for _ in range(3))
    loads = []
    for index, (unit, lower, upper) in enumerate(zip(joint.type.units, joint.limits.lower, joint.limits.upper, strict=True)):
        if unit == "rad":
            loads.append(_stated(joint, index, turn, MM_PER_M, 1.0))
        else:
            length = (upper - lower) / MM_PER_M if math.isfinite(upper - lower) else 2 * carried.reach
            slide = _load(force, _rounded(math.sqrt(2 * g * max(length, LEAST_REACH_M))), carried.mass)
            loads.append(_stated(joint, index, slide, 1.0, MM_PER_M))
    return tuple(loads)


def _load(effort: float, velocity: float, carried: float) -> Load:
    return Load(effort, velocity, _rounded(DAMPING_SHARE * effort / velocity) if velocity > 0 else 0.0, _rounded(carried))


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def _stated(joint: Joint, index: int, computed: Load, effort_unit: float, velocity_unit: float) -> Load:
    """Return the load with the joint's own values; a torque is stated in N·mm, a sliding velocity in mm/s."""
    effort, velocity, damping, friction = (
        values[index] if index < len(values) else None for values in (joint.effort, joint.velocity, joint.damping, joint.friction)
    )
    if effort is None and velocity is None and damping is None and friction is None:
        return computed
    load = _load(
        computed.effort if effort is None else effort / effort_unit,
        computed.velocity if velocity is None else velocity / velocity_unit,
        computed.carried,
    )
    stated = {"effort": effort, "velocity": velocity, "damping": damping}
    return replace(
        load,
        damping=load.damping if damping is None else damping / effort_unit * velocity_unit,
        friction=0.0 if friction is None else friction / effort_unit,
        assumed=frozenset(name for name, value in stated.items() if value is None),
    )
