"""The motion of a driver: sweeps, feasible ranges, and how certain they are."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.errors import KinematicsError, UnknownJointError
from articad.findings import Finding, Findings
from articad.kinematics.branch import shown
from articad.kinematics.configuration import Configuration
from articad.kinematics.continuation import Stop, Trace
from articad.kinematics.joints import LIMIT_SLACK, Coordinate, JointType, swing, twist
from articad.kinematics.track import Period, Track

if TYPE_CHECKING:
    from articad.kinematics.mechanism import Mechanism

_LONGEST_TRAVEL = 100.0  # lengths L over which an unlimited slider is followed
_SAMPLES_PER_STEP = 4  # between two nodes, where limits of other joints are checked
_UNREACHED = ""  # in place of a coordinate's name
_END = 1e-6  # of a trace: distance from its end within which a pose may fail to close
_SPLITS, _ROUNDS = 16, 10  # a limit is located to 16⁻¹⁰ of a step


@dataclass(frozen=True)
class FeasibleRange:
    """How far a driver can go from rest, the others standing still.

    Attributes:
        driver: The coordinate.
        lower: Smallest value [rad, mm]; −inf if it turns endlessly.
        upper: Largest value.
        lower_reason: What ends it: "declared limit", "dead point", "singular", "limit of <coordinate>", "endless",
            "not followed further", "not followed: the constraints have a multiple root".
        upper_reason: Likewise.
        findings: E_DEAD_POINT, E_LOOP_LIMIT, E_SINGULAR or E_NOT_FOLLOWED where the declared range is larger.
    """

    driver: Coordinate
    lower: float
    upper: float
    lower_reason: str
    upper_reason: str
    findings: Findings


@dataclass(frozen=True, eq=False)
class DrivenMotion:
    """A driver's motion at even steps.

    Attributes:
        mechanism: The mechanism.
        driver: The coordinate that moves.
        values: `(n,)` [rad, mm]: the requested values that were reached, in order.
        configuration: Coordinates of all joints `(n)`.
        strength: "certified" if every step is proven to stay on the branch, else "sampled".
        reason: Why it is not certified; or what proves it.
        tube: Largest radius around a predictor within which the only solution lies [rad, lengths L]; 0 for a tree.
        findings: Dead points, singularities and limits on the way.
    """

    mechanism: Mechanism
    driver: Coordinate
    values: FloatArray
    configuration: Configuration
    strength: Literal["certified", "sampled"]
    reason: str
    tube: float
    findings: Findings

    @property
    def ok(self) -> bool:
        """True when the whole range was reached without a finding."""
        return self.findings.ok

    def poses(self) -> SE3:
        """Return the poses `(n, N)` of all parts [mm]."""
        return self.mechanism.arrays.poses(self.configuration.columns)


def drive(
    mechanism: Mechanism, driver: str, lo: float, hi: float, steps: int, at: Mapping[str, float] | None, *, certify: bool
) -> DrivenMotion:
    """Move one driver from `lo` to `hi`; see `Mechanism.drive`."""
    if steps < 1 or not math.isfinite(lo) or not math.isfinite(hi):
        raise KinematicsError(f"A motion needs finite ends and at least one step; given [{lo}, {hi}] in {steps} steps.")
    index = driver_index(mechanism, driver)
    coordinate = mechanism.drivers[index]
    values = np.linspace(lo, hi, steps)
    q = start_values(mechanism, at)
    # a tree needs no continuation: its poses are a product of the coordinates
    track = track_of(mechanism, index, q, certify=certify)
    if track is None:
        rows = np.tile(q, (steps, 1))
        rows[:, index] = values
        configuration = mechanism.configuration(rows)
        findings = Findings(_limit_findings(coordinate, configuration, values))
        return DrivenMotion(mechanism, coordinate, values, configuration, "certified", "a tree has one branch", 0.0, findings)
    # a linkage is followed from rest; values beyond a dead point are left out and reported
    Q, reached, proved = track.evaluate(values)
    found = [] if reached.all() else [_stop_finding(track, coordinate, float(v)) for v in (lo, hi)]
    base = mechanism.configuration(q).columns
    configuration = Configuration(mechanism.joints, track.follower.system.into_all(base, Q[reached]))
    if not reached.all() and not any(found):
        found = [_gap_finding(coordinate, values[~reached], steps)]
    found += _limit_findings(coordinate, configuration, values[reached])
    certified = bool(certify and proved[reached].all() and reached.any())
    tube = track.largest_tube() if certified else 0.0
    reason = _reason(track, coordinate, values[reached], certify=certify, certified=certified)
    findings = Findings(f for f in found if f is not None)
    return DrivenMotion(
        mechanism, coordinate, values[reached], configuration, "certified" if certified else "sampled", reason, tube, findings
    )


def _reason(track: Track, coordinate: Coordinate, values: FloatArray, *, certify: bool, certified: bool) -> str:
    if certified:
        return "Kantorovich: each step has one solution near its predictor; implied constraints of a loop are checked at the nodes"
    if not certify:
        return "followed by predictor and corrector with three guards; certify=True proves the branch"
    if not track.follower.certifiable:
        return "the constraints have a multiple root, so the branch cannot be proven"
    if not values.size:
        return "no value was reached"
    ends = [track.value(sign, track.side(float(v)).nodes[-1].s) for sign, v in ((1, values.max()), (-1, values.min()))]
    places = " and ".join(dict.fromkeys(shown(end, coordinate.unit) for end in ends))
    return f"the proof needs steps below 1e-7 next to a dead point: it holds up to {places}"


def feasible_range(mechanism: Mechanism, driver: str, at: Mapping[str, float] | None) -> FeasibleRange:
    """Return how far a driver can go; see `Mechanism.feasible_range`."""
    index = driver_index(mechanism, driver)
    coordinate = mechanism.drivers[index]
    q = start_values(mechanism, at)
    track = track_of(mechanism, index, q)
    if track is None:
        lower, upper = coordinate.lower, coordinate.upper
        reasons = ["endless" if math.isinf(v) else "declared limit" for v in (lower, upper)]
        return FeasibleRange(coordinate, lower, upper, reasons[0], reasons[1], Findings())
    sides: dict[int, tuple[float, str]] = {}
    for sign in (1, -1):
        if -sign in sides and sides[-sign][1] == "endless" and _is_symmetric(track):
            sides[sign] = (sign * math.inf, "endless")
        else:
            sides[sign] = _side_range(track, coordinate, sign)
    (upper, upper_reason), (lower, lower_reason) = sides[1], sides[-1]
    ends = {joint.name: (joint.parent, joint.child) for joint in mechanism.joints}
    found = _range_findings(coordinate, lower, upper, lower_reason, upper_reason, ends)
    return FeasibleRange(coordinate, lower, upper, lower_reason, upper_reason, Findings(found))


def _is_symmetric(track: Track) -> bool:
    """Return whether a motion endless in one direction is so in the other: it is periodic, and endlessly turning joints are unlimited."""
    period = track.repeat(1)
    if period is None:
        return False
    limited = [math.isfinite(c.lower) or math.isfinite(c.upper) for c in track.follower.system.layout.coordinates if c.unit != "1"]
    turning = [bool(a) for a, c in zip(period.advance, track.follower.system.layout.coordinates, strict=True) if c.unit != "1"]
    return not any(has_limit and turns for has_limit, turns in zip(limited, turning, strict=True))


def _side_range(track: Track, coordinate: Coordinate, sign: int) -> tuple[float, str]:
    bound, why = _bound(track, coordinate, sign)
    came_back = False
    if math.isfinite(bound):
        trace = track.side(bound) if sign * (bound - track.start) > 0 else None
    else:
        trace, came_back = _followed(track, coordinate, sign)
    if trace is None:  # at rest on its limit
        return track.start, why
    end, reason = track.value(sign, trace.end), str(trace.stop)
    if trace.stop is Stop.ARRIVED:
        end, reason = (bound, why) if math.isfinite(bound) else (end, str(Stop.STEPS))
    cut = _first_violation(track, trace, sign, coordinate)
    if cut is None and came_back:
        return sign * math.inf, "endless"
    end, reason = cut or (end, reason)
    return (end, reason) if sign * (bound - end) > 0 else (bound, why)  # an earlier call may have followed the driver farther


def _bound(track: Track, coordinate: Coordinate, sign: int) -> tuple[float, str]:
    """Return how far the driver may go by its own limits and by those of coordinates coupled to it, and which of them stops it."""
    system = track.follower.system
    bound, why = (coordinate.upper if sign > 0 else coordinate.lower), "declared limit"
    for column, ratio, offset in system.ties.tied_to(track.column):
        other = system.layout.coordinates[column]
        limit = ((other.upper if ratio * sign > 0 else other.lower) - offset) / ratio
        if sign * bound > sign * limit + LIMIT_SLACK * max(1.0, 1.0 / abs(ratio)):  # both may be infinite
            bound, why = limit, f"limit of {other.name}"
    return bound, why


def _followed(track: Track, coordinate: Coordinate, sign: int) -> tuple[Trace, bool]:
    """Follow an unlimited driver until all loops repeat, or as far as the joints with limits of their own allow."""
    system = track.follower.system
    if not system.loops:
        return track.side(track.start + sign * 2 * math.pi), True
    if track.turn is None:
        far = 2 * math.pi if coordinate.unit == "rad" else _LONGEST_TRAVEL * system.length
        return track.side(track.start + sign * far), False
    period = track.repeat(sign)
    if period is None:
        return track.side(track.start + sign * track.turn), False
    turns = _turns_to_limits(track, period)
    return track.side(track.start + sign * period.length * turns), turns == 1


def _turns_to_limits(track: Track, period: Period) -> float:
    """Return how many periods bring an endlessly turning coordinate to one of its limits; 1 if none has any."""
    layout, most = track.follower.system.layout, 1.0
    for i, c in enumerate(layout.coordinates):
        limit = c.upper if period.advance[i] > 0 else c.lower
        if period.advance[i] and math.isfinite(limit) and c.unit != "1":
            most = max(most, math.ceil(abs((limit - track.Q[i]) / period.advance[i])) + 1.0)
    return most


def _first_violation(track: Track, trace: Trace, sign: int, coordinate: Coordinate) -> tuple[float, str] | None:
    """Return where another joint first leaves its limits, and which one; None if none does."""
    stations = [node.s for node in trace.nodes] + ([trace.end] if trace.end > trace.nodes[-1].s else [])
    if len(stations) == 1:  # it cannot move at all
        return None
    fine = np.unique(np.concatenate([np.linspace(a, b, _SAMPLES_PER_STEP + 1) for a, b in itertools.pairwise(stations)]))
    names, margins = _margins(track, sign, fine, coordinate, trace.end)
    if not names or not (margins < -LIMIT_SLACK).any():
        return None
    for _ in range(_ROUNDS):
        first = int(np.argmax((margins < -LIMIT_SLACK).any(axis=0)))
        if first == 0:
            break
        a, b = fine[first - 1], fine[first]
        fine = np.linspace(a, b, _SPLITS + 1)
        names, margins = _margins(track, sign, fine, coordinate, trace.end)
        if not (margins < -LIMIT_SLACK).any():
            break
    first = int(np.argmax((margins < -LIMIT_SLACK).any(axis=0)))
    worst = int(np.argmin(margins[:, first]))
    reason = str(Stop.STEPS) if names[worst] == _UNREACHED else f"limit of {names[worst]}"
    return track.value(sign, float(fine[max(0, first - 1)])), reason


def _margins(track: Track, sign: int, s: FloatArray, coordinate: Coordinate, end: float) -> tuple[list[str], FloatArray]:
    """Return for every bounded coordinate except the driver's how far it is inside its limits, `(names, len(s))`.

    If the linkage could not be closed somewhere, a last row is minus infinity there.
    """
    # margin of a coordinate: min(q − lower, upper − q); of a ball: cone − swing, and the twist likewise; negative outside
    values = np.array([track.value(sign, float(x)) for x in s])
    Q, reached, _ = track.evaluate(values)
    layout = track.follower.system.layout
    names: list[str] = []
    rows: list[FloatArray] = []
    for joint in layout.joints:
        own = Q[:, layout.columns[joint.name]]
        if joint.type is JointType.BALL:
            if joint.limits.cone is not None:
                names.append(f"{joint.name}.swing")
                rows.append(joint.limits.cone - np.asarray(swing(own)))
            if joint.limits.twist is not None:
                names.append(f"{joint.name}.twist")
                rows.append(np.minimum(twist(own) - joint.limits.twist[0], joint.limits.twist[1] - twist(own)))
            continue
        if joint.type is JointType.FREE:
            continue
        for i, c in enumerate(joint.columns):
            if c.name != coordinate.name and (math.isfinite(c.lower) or math.isfinite(c.upper)):
                names.append(c.name)
                rows.append(np.minimum(own[:, i] - c.lower, c.upper - own[:, i]))
    margins = np.array(rows).reshape(len(names), len(s))
    margins[:, ~reached] = np.inf
    if not reached.all():  # limits are unknown there; at the very end of a trace a dead point may keep it from closing
        names.append(_UNREACHED)
        margins = np.vstack([margins, np.where(reached | (s >= end * (1 - _END)), np.inf, -np.inf)])
    return names, margins


def _range_findings(
    c: Coordinate, lower: float, upper: float, lower_reason: str, upper_reason: str, ends: Mapping[str, tuple[str, str]]
) -> list[Finding]:
    """Return findings where the declared range is larger than the loop allows; `ends` are the two parts of each joint."""
    codes = {"dead point": "E_DEAD_POINT", "singular": "E_SINGULAR"} | {str(s): "E_NOT_FOLLOWED" for s in (Stop.STEPS, Stop.MULTIPLE)}
    found = []
    for reason, value in ((lower_reason, lower), (upper_reason, upper)):
        code = codes.get(reason, "E_LOOP_LIMIT" if reason.startswith("limit of ") else None)
        bounded = math.isfinite(c.lower) or math.isfinite(c.upper)
        if code is None or (not bounded and reason in {"dead point", str(Stop.STEPS)}):  # an endless driver follows as far as it can
            continue
        declared = f"[{shown(c.lower, c.unit)}, {shown(c.upper, c.unit)}]"
        reached = f"[{shown(lower, c.unit)}, {shown(upper, c.unit)}]"
        whys = {
            "E_DEAD_POINT": "a dead point",
            "E_SINGULAR": "a singular configuration",
            "E_NOT_FOLLOWED": "the path beyond takes too many steps,",
        }
        if reason == Stop.MULTIPLE:
            whys["E_NOT_FOLLOWED"] = "the constraints have a multiple root,"
        why = whys.get(code, f"the {reason}")
        how = "was followed over" if code == "E_NOT_FOLLOWED" else "reaches"
        message = f"driver {c.name!r} is declared {declared}, but the loop {how} only {reached}: {why} at {shown(value, c.unit)}."
        finite = math.isfinite(lower) and math.isfinite(upper)
        other = reason.removeprefix("limit of ") if code == "E_LOOP_LIMIT" else ""
        widen = f", or widen those of {other}" if other else ""
        limiting = ends.get(other, ends.get(other.partition(".")[0], ()))
        hint = f"Set its limits to {_inside(lower, upper, c.unit)}{widen}." if finite else _one_limit(lower, upper, c.unit)
        found.append(Finding(code=code, where=f"joints.{c.joint}", message=message, hint=hint, parts=limiting, value=value, unit=c.unit))
    return found


def _inside(lower: float, upper: float, unit: str) -> str:
    """Return a range in degrees or mm, rounded inwards to 3 decimals: a driver that is given it stays within its reach."""
    scale, name = (math.degrees(1.0), "deg") if unit == "rad" else (1.0, unit)
    low, high = math.ceil(1e3 * scale * lower - _ROUNDING) / 1e3, math.floor(1e3 * scale * upper + _ROUNDING) / 1e3
    return f"[{low + 0.0:.15g}, {high + 0.0:.15g}] {name}"


_ROUNDING = 1e-6  # of a thousandth: the noise of the last bits moves no limit


def _one_limit(lower: float, upper: float, unit: str) -> str:
    """Return the advice to limit a driver on the one side where its path ends."""
    side, value = ("upper", upper) if math.isinf(lower) else ("lower", lower)
    return f"Set the {side} limit to {shown(value, unit)}."


def _stop_finding(track: Track, c: Coordinate, asked: float) -> Finding | None:
    trace = track.side(asked)
    sign = 1 if asked >= track.start else -1
    end = track.value(sign, trace.end)
    if trace.stop is Stop.ARRIVED or sign * (end - asked) >= 0:
        return None
    code = {Stop.DEAD_POINT: "E_DEAD_POINT", Stop.STEPS: "E_NOT_FOLLOWED", Stop.MULTIPLE: "E_NOT_FOLLOWED"}.get(trace.stop, "E_SINGULAR")
    how = "was followed to" if code == "E_NOT_FOLLOWED" else "reaches"
    message = f"driver {c.name!r} was asked for {shown(asked, c.unit)}, but the loop {how} only {shown(end, c.unit)}."
    return Finding(code=code, where=f"joints.{c.joint}", message=message, hint="Stay on this side of it.", value=end, unit=c.unit)


def _gap_finding(c: Coordinate, missed: FloatArray, steps: int) -> Finding:
    """Return the finding about values that are not reached although the linkage was followed past them."""
    first = float(missed[0])
    message = f"{len(missed)} of {steps} values of driver {c.name!r} were not solved, the first at {shown(first, c.unit)}."
    hint = "Request values next to it: the linkage is near-singular there."
    return Finding(code="E_NOT_FOLLOWED", where=f"joints.{c.joint}", message=message, hint=hint, value=first, unit=c.unit)


def _limit_findings(c: Coordinate, configuration: Configuration, values: FloatArray) -> list[Finding]:
    """Return one finding per coordinate that leaves its limits, with its worst value."""
    found = []
    for error in configuration.violations():
        if error.joint == c.name:
            continue
        joint = error.joint.split(".")[0]
        column = next((i for i, k in enumerate(k.name for j in configuration.joints for k in j.columns) if k == error.joint), None)
        at = int(np.argmin(np.abs(configuration.columns[:, column] - error.value))) if column is not None else 0
        limits = f"[{shown(error.lower, error.unit)}, {shown(error.upper, error.unit)}]"
        message = (
            f"at {c.name}={shown(float(values[at]), c.unit)} joint {error.joint!r} leaves {limits} ({shown(error.value, error.unit)})."
        )
        hint = "Narrow the driver's limits, or widen the joint's."
        pose = {c.name: float(values[at])}
        found.append(
            Finding(code="E_LOOP_LIMIT", where=f"joints.{joint}", message=message, hint=hint, value=error.value, unit=error.unit, pose=pose)
        )
    return found


# --- shared


def driver_index(mechanism: Mechanism, driver: str) -> int:
    """Return the index of a driver among the columns of q.

    Raises:
        UnknownJointError: If no driver has this name.
        KinematicsError: If it is one component of a ball.
    """
    names = [c.name for c in mechanism.drivers]
    if driver not in names:
        raise UnknownJointError(driver, names)
    index = names.index(driver)
    if mechanism.drivers[index].unit == "1":
        raise KinematicsError(f"{driver!r} is a component of a quaternion; such components have no ranges.")
    return index


def start_values(mechanism: Mechanism, at: Mapping[str, float] | None) -> FloatArray:
    """Return q with some drivers set and the others at rest."""
    q = mechanism.rest.copy()
    names = [c.name for c in mechanism.drivers]
    for name, value in (at or {}).items():
        if name not in names:
            raise UnknownJointError(name, names)
        q[names.index(name)] = value
    return q


def track_of(mechanism: Mechanism, index: int, q: FloatArray, *, certify: bool = False) -> Track | None:
    """Return the track of a driver through q; None if nothing follows it, as in a tree."""
    driven = None if mechanism.is_tree else mechanism.branch.driven_by(mechanism.driver_columns[index])
    if driven is None:
        return None
    group, place = driven
    start = group.system.to_system(mechanism.branch.configurations(q[None])[0])
    if np.array_equal(start, group.Q):
        return group.track(place, certify=certify)
    return group.track(place, certify=certify, Q=start)
