"""Configurations beside rest at which parts may be put in place, such as a door that stands open."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from articad.connectors.se3 import SE3
from articad.interference.sampled_ranges import sampled_ranges
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.solution import Solution

__all__ = ["OtherPose", "end_poses", "poses_at", "reached_at"]

_SAME = 1e-9  # rad or mm


class OtherPose(NamedTuple):
    """A configuration beside rest.

    Attributes:
        at: Values of the drivers that are not at rest [rad, mm].
        poses: `T_ground_part` of all parts.
    """

    at: dict[str, float]
    poses: Mapping[str, SE3]


def end_poses(mechanism: Mechanism, *, middle: bool = True) -> list[OtherPose]:
    """Return the poses at both ends of each driver's range, the other drivers at rest, as far as they are reached.

    Args:
        mechanism: Places the parts.
        middle: Whether to add the middle of each range.
    """
    found = []
    drivers = {driver.name for driver in mechanism.drivers}
    for freedom in sampled_ranges(mechanism):
        values = [freedom.lower, freedom.upper, *([(freedom.lower + freedom.upper) / 2] if middle else [])]
        for value in values if freedom.name in drivers else ():
            at = {freedom.name: value}
            if abs(value - freedom.rest) > _SAME and (poses := reached_at(mechanism, at)) is not None:
                found.append(OtherPose(at, poses))
    return found


def poses_at(mechanism: Mechanism, at: Mapping[str, float]) -> dict[str, SE3]:
    """Return `T_ground_part` of all parts where some drivers have other values than at rest.

    Args:
        mechanism: Places the parts.
        at: By driver [rad, mm].
    """
    return _by_part(mechanism, _solved(mechanism, at))


def reached_at(mechanism: Mechanism, at: Mapping[str, float]) -> dict[str, SE3] | None:
    """Return the same as `poses_at`; None if loops cannot be closed there."""
    solution = _solved(mechanism, at)
    return _by_part(mechanism, solution) if bool(solution.reached[0]) else None


def _solved(mechanism: Mechanism, at: Mapping[str, float]) -> Solution:
    q = [at.get(driver.name, rest) for driver, rest in zip(mechanism.drivers, mechanism.rest, strict=True)]
    return mechanism.solve(np.array(q, dtype=np.float64)[None])


def _by_part(mechanism: Mechanism, solution: Solution) -> dict[str, SE3]:
    return {name: solution.poses[0][index] for index, name in enumerate(mechanism.parts)}
