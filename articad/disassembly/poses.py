"""Configurations beside rest at which parts may be put in place, such as a door that stands open."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from articad.connectors.se3 import SE3
from articad.interference.sampled_ranges import sampled_ranges
from articad.kinematics.mechanism import Mechanism

__all__ = ["OtherPose", "end_poses", "poses_at"]

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
    places = {driver.name: at for at, driver in enumerate(mechanism.drivers)}
    for freedom in sampled_ranges(mechanism):
        values = [freedom.lower, freedom.upper, *([(freedom.lower + freedom.upper) / 2] if middle else [])]
        for value in values if freedom.name in places else ():
            q = np.array(mechanism.rest, dtype=np.float64)
            q[places[freedom.name]] = value
            solution = mechanism.solve(q[None])
            if abs(value - freedom.rest) > _SAME and bool(solution.reached[0]):
                placed = solution.poses[0]
                found.append(OtherPose({freedom.name: value}, {name: placed[k] for k, name in enumerate(mechanism.parts)}))
    return found


def poses_at(mechanism: Mechanism, at: Mapping[str, float]) -> dict[str, SE3]:
    """Return `T_ground_part` of all parts where some drivers have other values than at rest.

    Args:
        mechanism: Places the parts.
        at: By driver [rad, mm].
    """
    q = np.array(mechanism.rest, dtype=np.float64)
    for place, driver in enumerate(mechanism.drivers):
        q[place] = at.get(driver.name, q[place])
    placed = mechanism.solve(q[None]).poses[0]
    return {name: placed[index] for index, name in enumerate(mechanism.parts)}
