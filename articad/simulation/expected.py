"""The kinematics of a loop: the ranges of its drivers, and of the joints that follow them."""

from __future__ import annotations

from dataclasses import replace

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.export.lowering import AxisMotion, LoweredModel, lower
from articad.kinematics.configuration import Configuration
from articad.simulation.verdict import SHARE, EngineOutcome, JointReach, covered

STEPS = 181  # of a driver's path: the error between two of them is far less than the share that may be missing
MM_PER_M = 1000.0


def held_to_kinematics(assembly: Assembly, outcome: EngineOutcome) -> EngineOutcome:
    """Return the outcome with expected ranges of followers from kinematics, and of drivers as their loops allow.

    Args:
        assembly: The assembly whose export was tried.
        outcome: Outcome of the engine; values of joints are found by their names in formats.
    """
    if not any(reach.role == "driver" for reach in outcome.reaches):
        return outcome
    model = lower(assembly)
    freedoms = {freedom.name: freedom for joint in (*model.joints, *model.loops) for freedom in joint.freedoms}
    brought: dict[str, tuple[float, float]] = {}
    allowed: dict[str, tuple[float, float]] = {}
    for reach in outcome.reaches:
        if reach.role == "driver" and (column := freedoms[reach.joint].column) is not None:
            own, ways = _ways(assembly, model, column, reach)
            if covered(*own, reach.lower, reach.upper) < SHARE:
                allowed[reach.joint] = own
            for name, (low, high) in ways.items():
                so_far = brought.get(name, (low, high))
                brought[name] = min(low, so_far[0]), max(high, so_far[1])
    return replace(outcome, reaches=[_held(reach, brought, allowed) for reach in outcome.reaches if _known(reach, brought)])


def _known(reach: JointReach, brought: dict[str, tuple[float, float]]) -> bool:
    """False for followers that are not joints of the assembly: bodies that a format needs to close a loop."""
    return reach.role != "follower" or reach.joint in brought


def _held(reach: JointReach, brought: dict[str, tuple[float, float]], allowed: dict[str, tuple[float, float]]) -> JointReach:
    if reach.role == "follower":
        low, high = brought[reach.joint]
        return replace(reach, lower=low, upper=high, share=covered(reach.low, reach.high, low, high))
    return replace(reach, allowed=allowed.get(reach.joint))


def _ways(
    assembly: Assembly, model: LoweredModel, column: str, reach: JointReach
) -> tuple[tuple[float, float], dict[str, tuple[float, float]]]:
    """Return the reachable part of the range over which a driver was driven, and the resulting ranges of all joints [rad or m]."""
    scale = MM_PER_M if reach.unit == "m" else 1.0
    free = assembly.feasible_range(column)
    low, high = max(free.lower, reach.lower * scale), min(free.upper, reach.upper * scale)
    way = assembly.drive(column, low, high, steps=STEPS).configuration
    ways = {name: (float(values.min()), float(values.max())) for name, values in _values(model, way).items()}
    return (low / scale, high / scale), ways


def _values(model: LoweredModel, way: Configuration) -> dict[str, FloatArray]:
    """Return the values of all one-freedom joints along a path [rad or m]."""
    found: dict[str, FloatArray] = {}
    names = [name for joint in way.joints for name in joint.column_names]
    freedoms: list[AxisMotion] = [freedom for joint in (*model.joints, *model.loops) for freedom in joint.freedoms]
    for freedom in freedoms:
        if freedom.column is not None:
            values = way.columns[:, names.index(freedom.column)]
            found[freedom.name] = values if freedom.kind == "turn" else values / MM_PER_M
    for freedom in freedoms:
        if freedom.follows is not None and freedom.follows.leader in found:
            found[freedom.name] = freedom.follows.ratio * found[freedom.follows.leader] + freedom.follows.offset
    return found
