"""A table of the coordinates that loops and couplings move with a driver, such as steer 30° -> outer wheel 22.7°."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from articad.errors import KinematicsError
from articad.interference.report import rounded
from articad.interference.sweep import MotionSampler

ROWS = 9  # of a table, evenly over the driver's range, and one at rest
_STILL = 1e-9  # rad or mm: a coordinate that moves by less does not follow


@dataclass(frozen=True)
class Following:
    """How coordinates follow one driver, with the other drivers at rest.

    Attributes:
        driver: Name of the coordinate that drives.
        values: Its values in increasing order, where they are reached [rad or mm].
        followers: Values of each coordinate that follows, by name, one for each of the driver's [rad or mm].
        units: "rad" or "mm" of the driver and of each follower, by name.
    """

    driver: str
    values: tuple[float, ...]
    followers: Mapping[str, tuple[float, ...]]
    units: Mapping[str, str]

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a report."""
        return {
            "driver": self.driver,
            "values": [rounded(value) for value in self.values],
            "followers": {name: [rounded(value) for value in values] for name, values in self.followers.items()},
            "units": dict(self.units),
        }


def what_follows(motion: MotionSampler, joints: Sequence[str] | None = None, *, rows: int = ROWS) -> tuple[Following, ...]:
    """Return a table for each driver that other coordinates follow.

    Args:
        motion: Sampling of the mechanism.
        joints: Names of the joints whose drivers are tabulated; all by default.
        rows: Values of each driver over its range, in addition to the rest value.
    """
    mechanism = motion.mechanism
    if mechanism.is_tree:
        return ()
    driving = {driver.name: driver for driver in mechanism.drivers}
    found = []
    for freedom in motion.ranges(joints):
        if freedom.name not in driving:
            continue  # a swing or twist of a ball
        even = np.linspace(freedom.lower, freedom.upper, rows)
        values = np.sort([*even[np.abs(even - freedom.rest) > _STILL * max(1.0, abs(freedom.rest))], freedom.rest])
        try:
            kept, _, solution = motion.placed([{freedom.name: value} for value in values.tolist()])
        except KinematicsError:
            return ()  # a loop is open at rest
        columns = solution.columns[kept]
        moving = [
            (at, c) for at, c in enumerate(mechanism.coordinates) if c.name not in driving and c.unit != "1" and _moves(columns[:, at])
        ]
        if moving:
            followers = {c.name: tuple(columns[:, at].tolist()) for at, c in moving}
            units = {freedom.name: driving[freedom.name].unit, **{c.name: c.unit for _, c in moving}}
            found.append(Following(freedom.name, tuple(values[kept].tolist()), followers, units))
    return tuple(found)


def _moves(values: np.ndarray[Any, np.dtype[np.float64]]) -> bool:
    return bool(len(values)) and float(np.ptp(values)) > _STILL
