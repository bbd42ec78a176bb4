"""Travel: how far each joint goes while the drivers move one at a time, followers in loops and couplings included."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.kinematics.joints import Joint, JointType, Unit, swing, twist
from articad.render.pictures import driver_range, motion_frames

FOLLOWED: Final = 61  # poses of each driver's range: a turn in steps of 6°, its half included
_STILL: Final = 1e-6  # rad, mm: what moves less stands still
_BACK: Final = 1e-3  # rad, mm: what is nearer to where it began, after a turn of its driver, has come back


class CoordinateTravel(NamedTuple):
    """How far one coordinate of a joint goes.

    Attributes:
        name: Of the coordinate; `tilt` and `twist` for a ball.
        unit: Of both ends: rad or mm.
        lower: The smallest value, or -inf.
        upper: The largest value, or inf.
        endless: Whether it goes on for ever; `lower` and `upper` of what follows a driver are those of one turn of the driver.
        shared: Whether several drivers move or bound it, so that it may go farther while they move together.
    """

    name: str
    unit: Unit
    lower: float
    upper: float
    endless: bool
    shared: bool = False

    @property
    def extent(self) -> float:
        """How far it goes in all [rad, mm], or inf."""
        return math.inf if self.endless else self.upper - self.lower


class JointTravel(NamedTuple):
    """How far a joint goes.

    Attributes:
        joint: The joint.
        drives: Whether it is a driver; otherwise it follows, or does not move.
        coordinates: Those that drive, or all that follow; of a ball its tilt and its twist; none for a free joint and where nothing moves it.
    """

    joint: Joint
    drives: bool
    coordinates: tuple[CoordinateTravel, ...]


class DriverSweep(NamedTuple):
    """Coordinates `(FOLLOWED, columns)` [rad, mm] along the range of a driving coordinate, and whether that range has no end."""

    rows: FloatArray
    endless: bool


def travels(assembly: Assembly) -> list[JointTravel]:
    """Return how far each joint goes that is not fixed, driven or following, while the drivers move one at a time."""
    driving = set(assembly.mechanism.driving_joints)
    sweeps = _sweeps(assembly) if driving and not assembly.mechanism.is_tree else []
    found, start = [], 0
    for joint in assembly.joints:
        own = slice(start, start + len(joint.column_names))
        start = own.stop
        if joint.type is JointType.FIXED:
            continue
        coordinates: list[CoordinateTravel] = []
        if joint.type is not JointType.FREE and joint.name in driving:
            coordinates = _driven(assembly, joint)
        elif joint.type is not JointType.FREE and sweeps:
            coordinates = _following(joint, [sweep._replace(rows=sweep.rows[:, own]) for sweep in sweeps])
        found.append(JointTravel(joint, joint.name in driving, tuple(coordinates)))
    return found


def told_travels(travelled: Iterable[JointTravel]) -> list[str]:
    """Return a line for each coordinate that moves: its range, in degrees and mm."""
    return [line for travel in travelled for line in _told(travel)]


def _told(travel: JointTravel) -> list[str]:
    joint, how = travel.joint, "drives" if travel.drives else "follows"
    if joint.type is JointType.FREE:
        return [f"- {joint.name}: moves freely in all directions"]
    if not travel.coordinates:
        return [f"- {joint.name}: does not move"]
    if joint.type is JointType.BALL:
        tilt, turn = travel.coordinates
        every_way = ", every way" if travel.drives else ""
        tilted = "to every side" if tilt.endless else f"to {_figure(math.degrees(tilt.upper))} degrees from its axis{every_way}"
        turned = "turns freely" if turn.endless else f"turns {_span(turn.lower, turn.upper, 'rad')}"
        return [f"- {joint.name}: swivels {tilted}, {turned} about it, {how}"]
    return [f"- {coordinate.name}: {_gone(coordinate, joint, drives=travel.drives)}, {how}" for coordinate in travel.coordinates]


def _gone(travel: CoordinateTravel, joint: Joint, *, drives: bool) -> str:
    extent = travel.upper - travel.lower
    limits = dict(zip(joint.column_names, joint.limits.upper, strict=True))
    if not drives and travel.unit == "rad" and math.isinf(limits[travel.name]) and extent > 2 * math.pi - _STILL:
        return f"turns {_figure(math.degrees(extent))} degrees in all"
    return _span(travel.lower, travel.upper, travel.unit)


def _sweeps(assembly: Assembly) -> list[DriverSweep]:
    """Return all joints' coordinates along the range of each driving coordinate."""
    mechanism = assembly.mechanism
    sweeps: list[DriverSweep] = []
    for joint in mechanism.driving_joints:
        columns = mechanism.configuration(motion_frames(assembly, joint, FOLLOWED)[1]).columns
        rows = columns.reshape(-1, FOLLOWED, columns.shape[-1])
        own = [driver for driver in assembly.drivers if driver.joint == joint and driver.unit != "1"]
        endless = [not all(map(math.isfinite, driver_range(assembly, driver))) for driver in own] or [False] * len(
            rows
        )  # a ball stays in its cone
        sweeps += map(DriverSweep, rows, endless)
    return sweeps


def _driven(assembly: Assembly, joint: Joint) -> list[CoordinateTravel]:
    shared = not assembly.mechanism.is_tree and len(assembly.drivers) > 1
    if joint.type is JointType.BALL:
        cone, turn = joint.limits.cone, joint.limits.twist
        return [
            CoordinateTravel("tilt", "rad", 0.0, math.inf if cone is None else cone, cone is None, shared),
            CoordinateTravel("twist", "rad", *(turn or (-math.inf, math.inf)), turn is None, shared),
        ]
    found = []
    for driver in assembly.drivers:
        if driver.joint == joint.name:
            lower, upper = driver_range(assembly, driver)
            found.append(CoordinateTravel(driver.name, driver.unit, lower, upper, math.isinf(upper - lower), shared))
    return found


def _following(joint: Joint, sweeps: list[DriverSweep]) -> list[CoordinateTravel]:
    """Return the motion of a joint that follows; `sweeps` hold its own coordinates, `(poses, columns)` for each driver."""
    if joint.type is JointType.BALL:
        (_, tilt), (low, high) = _extremes([swing(rows) for rows, _ in sweeps]), _extremes([twist(rows) for rows, _ in sweeps])
        return [
            CoordinateTravel("tilt", "rad", 0.0, tilt, endless=False, shared=len(sweeps) > 1),
            CoordinateTravel("twist", "rad", low, high, endless=False, shared=len(sweeps) > 1),
        ]
    found = []
    for index, (name, unit) in enumerate(zip(joint.column_names, joint.type.units, strict=True)):
        swept = [rows[:, index] for rows, _ in sweeps]
        moved = sum(float(np.ptp(values)) > _STILL for values in swept)
        goes_on = any(endless and abs(rows[-1, index] - rows[0, index]) > _BACK for rows, endless in sweeps)
        found.append(CoordinateTravel(name, unit, *_extremes(swept), endless=goes_on, shared=moved > 1))
    return found


def _extremes(sweeps: list[FloatArray]) -> tuple[float, float]:
    """Return the smallest and largest value of a coordinate; a turning point between two poses is interpolated."""
    high = max(_summit(values) for values in sweeps)
    low = min(-_summit(-values) for values in sweeps)
    return low, high


def _summit(values: FloatArray) -> float:
    """Return the top of the parabola through the largest value and its neighbours."""
    top = int(values.argmax())
    if not 0 < top < len(values) - 1:
        return float(values[top])
    before, summit, after = map(float, values[top - 1 : top + 2])
    bend = before - 2 * summit + after
    return summit if bend >= -_STILL else summit - (after - before) ** 2 / (8 * bend)


def _span(lower: float, upper: float, unit: str) -> str:
    if math.isinf(lower) and math.isinf(upper):
        return "endless"
    if upper - lower < _STILL:
        return "does not move"
    name = "degrees" if unit == "rad" else "mm"
    figures = [_figure(math.degrees(value) if unit == "rad" else value) for value in (lower, upper)]
    return f"{figures[0] if math.isfinite(lower) else 'no end'} to {figures[1] if math.isfinite(upper) else 'no end'} {name}"


def _figure(value: float) -> str:
    """Return an angle in degrees or a length in mm to a hundredth: three digits would hide a missing millimetre of a long travel."""
    return f"{round(value, 2) + 0.0:.10g}"
