"""Ranges: whether joints go as far as the analysis of the request says that things move.

A designer who writes a travel in another unit makes a plan without a fault: only the analysis says that a drawer opens 380 mm and not 38. So
spans are read from the text of each motion's range, and a motion is met if any coordinate of the same unit goes about as far as one of them.
Which joint makes which motion is not decided, so a joint that goes as far as another was meant to go hides that fault.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final, Literal, NamedTuple

from articad.agents.requirements import Motion
from articad.agents.travel import travels
from articad.assembly import Assembly
from articad.findings import Finding, Findings
from articad.kinematics.joints import Joint, JointType, Unit
from articad.plan.resolve import ResolvedPlan
from articad.texts import escaped

__all__ = ["MotionSpan", "built", "planned", "spans_of"]

MotionUnit = Literal["mm", "degrees"]

FACTOR: Final = 1.25  # between two extents that count as alike: designers round, and deviate a little
_TURN: Final = 360.0  # degrees
_SHOWN: Final = 6  # joints that a message names
_UNITS: Final[Mapping[str, frozenset[MotionUnit]]] = {
    **dict.fromkeys(("turns", "swivels", "tilts"), frozenset({"degrees"})),
    "slides": frozenset({"mm"}),
}
"""By kind of a motion, the units of its coordinates; those of other kinds have both."""
_NOTE: Final = r"(?:\s*\([^()]*\))?"
_NUMBER: Final = r"[-+−]?\d+(?:\.\d+)?(?![.,]?\d)"
_UNIT: Final = r"mm\b|degrees?\b|deg\b|°"
_SPAN: Final = re.compile(
    rf"(?<![\w.,])(?P<low>{_NUMBER}){_NOTE}(?:\s*(?P<first>{_UNIT}))?{_NOTE}"
    r"\s*(?P<word>(?:up )?to\b|\.\.\.?|…|[-–—])\s*(?:about |approx\. )?"
    rf"(?P<high>{_NUMBER}){_NOTE}\s*(?P<unit>{_UNIT})",
    re.IGNORECASE,
)


class MotionSpan(NamedTuple):
    """The ends of a motion as a text states them.

    Attributes:
        low: The lesser end.
        high: The greater end.
        unit: Of both.
    """

    low: float
    high: float
    unit: MotionUnit

    @property
    def extents(self) -> tuple[float, float]:
        """The least and the largest extent that is meant: the difference; more where an angle goes all round or the text may state two extents."""
        extent = self.high - self.low
        if self.unit == "degrees" and extent == _TURN:
            return extent, math.inf
        return extent, max(extent, -self.low, self.high)


class Extents(NamedTuple):
    """How far a joint goes in one coordinate: something between two extents, which are equal where it is known.

    Attributes:
        joint: The joint.
        unit: Of both extents.
        least: It goes at least so far.
        most: It goes so far at most; inf where it has no end.
    """

    joint: Joint
    unit: MotionUnit
    least: float
    most: float

    def meets(self, span: MotionSpan) -> bool:
        """Return whether it may go about as far as a span."""
        least, most = span.extents
        return self.unit == span.unit and self.least <= FACTOR * most and least <= FACTOR * self.most

    def __str__(self) -> str:
        if math.isinf(self.most):
            return f"{self.joint.name} has no end"
        at_most = " at most" if self.least < self.most else ""
        return f"{self.joint.name} goes {round(self.most, 2) + 0.0:.10g} {self.unit}{at_most}"


def spans_of(motion: Motion) -> tuple[MotionSpan, ...]:
    """Return the spans that the text of a motion's range states, such as "0 (closed) to 380 mm out", in units that its kind has."""
    found = []
    for stated in _SPAN.finditer(motion.range):
        unit = _unit(stated["unit"])
        low, high = (float(stated[end].replace("−", "-")) for end in ("low", "high"))
        several = stated["first"] is not None and _unit(stated["first"]) != unit
        ways = stated["word"].lower().startswith("up") and low != 0  # "25 up to 35 mm down" is 60 mm
        if unit in _UNITS.get(motion.kind, frozenset({"mm", "degrees"})) and low != high and not several and not ways:
            found.append(MotionSpan(min(low, high), max(low, high), unit))
    return tuple(found)


def planned(plan: ResolvedPlan, motions: Iterable[Motion]) -> Findings:
    """Return W_MOTION_RANGE for motions that no joint makes within the limits that a plan states.

    A joint in a loop, or that a coupling ties to another, goes so far at most: how far is known when it was moved (`built`).

    Args:
        plan: A plan without errors.
        motions: Of the analysis.
    """
    stated = [motion for motion in motions if spans_of(motion)]
    return _found(stated, list(_within_limits(plan)) if stated else [])


def built(assembly: Assembly, motions: Iterable[Motion]) -> Findings:
    """Return W_MOTION_RANGE for motions that no joint of an assembly makes, followers in loops and couplings included."""
    stated = [motion for motion in motions if spans_of(motion)]
    return _found(stated, list(_moved(assembly)) if stated else [])


def _unit(text: str) -> MotionUnit:
    return "mm" if text.lower() == "mm" else "degrees"


def _tied(plan: ResolvedPlan) -> set[str]:
    """Return the joints of loops and of couplings."""
    joints = {joint.name: joint for joint in plan.joints}

    def above(part: str) -> Iterator[str]:
        while (name := plan.parts[part].parent_joint) is not None:
            yield name
            part = joints[name].parent if joints[name].child == part else joints[name].child

    tied = {column.partition(".")[0] for coupling in plan.couplings for column in (coupling.a, coupling.b)}
    for name in joints.keys() - {part.parent_joint for part in plan.parts.values()}:
        tied |= {name} | (set(above(joints[name].parent)) ^ set(above(joints[name].child)))
    return tied


def _limits(joint: Joint) -> list[tuple[str, Unit, float]]:
    """Return the name, the unit and the extent of each coordinate within the joint's limits [rad, mm]; of a ball its tilt and its twist."""
    if joint.type is JointType.FREE:
        return [("travel", "mm", math.inf), ("angle", "rad", math.inf)]
    if joint.type is JointType.BALL:
        lower, upper = joint.limits.twist or (-math.inf, math.inf)
        return [("tilt", "rad", math.inf if joint.limits.cone is None else joint.limits.cone), ("twist", "rad", upper - lower)]
    rows = zip(joint.column_names, joint.type.units, joint.limits.lower, joint.limits.upper, strict=True)
    return [(name, unit, upper - lower) for name, unit, lower, upper in rows]


def _within_limits(plan: ResolvedPlan) -> Iterator[Extents]:
    tied = _tied(plan)
    for joint in plan.joints:
        for name, unit, extent in _limits(joint):
            known = joint.name not in tied and joint.type is not JointType.FREE
            yield from _extents(joint, name, unit, extent if known else 0.0, extent)


def _moved(assembly: Assembly) -> Iterator[Extents]:
    for joint, drives, coordinates in travels(assembly):
        gone = {coordinate.name: coordinate for coordinate in coordinates}
        for name, unit, limit in _limits(joint):
            if name in gone:
                extent = gone[name].extent
                yield from _extents(joint, name, unit, extent, limit if gone[name].shared else extent)
            else:  # a free joint, or a coordinate that follows another of its own joint; what has neither does not move
                yield from _extents(joint, name, unit, 0.0, limit if drives or joint.type is JointType.FREE else 0.0)


def _extents(joint: Joint, name: str, unit: Unit, least: float, most: float) -> Iterator[Extents]:
    """Yield the extents of a coordinate that goes between two extents [rad, mm]: of a screw those of its turn and of its advance."""
    if unit == "mm":
        yield Extents(joint, "mm", least if math.isfinite(least) else 0.0, most)  # how far what has no end was meant to go is open
        return
    if joint.type is JointType.BALL and name == "tilt":
        most = 2 * most  # from one side to the other, not only from the axis
    yield Extents(joint, "degrees", math.degrees(least) if math.isfinite(least) else _TURN, math.degrees(most))
    if joint.type is JointType.SCREW:
        advance = abs(joint.lead) / (2 * math.pi)
        yield Extents(joint, "mm", least * advance if math.isfinite(least) else 0.0, most * advance)


def _found(motions: Iterable[Motion], extents: Sequence[Extents]) -> Findings:
    """Return one finding for each joint that is probably meant by motions that no joint makes."""
    unmet: defaultdict[str, list[str]] = defaultdict(list)
    able: dict[str, list[Extents]] = {}
    for motion in motions:
        spans = spans_of(motion)
        alike = [one for one in extents if any(one.unit == span.unit for span in spans)]
        if not alike or any(one.meets(span) for one in alike for span in spans):
            continue
        alike.sort(key=lambda one: _likeness(motion, one.joint), reverse=True)
        name = alike[0].joint.name
        unmet[name].append(escaped(" ".join(f"{motion.component} {motion.kind}, {motion.range}".split())))
        able.setdefault(name, alike)
    return Findings(_finding(told, able[name]) for name, told in unmet.items())


def _likeness(motion: Motion, joint: Joint) -> tuple[int, int]:
    """Return how many words a joint shares with what moves, and with what that moves against."""
    own, other = _words(motion.component), _words(motion.relative_to)
    return len(own & _words(f"{joint.name} {joint.child}")), len(other & _words(f"{joint.name} {joint.parent}"))


def _words(text: str) -> set[str]:
    return set(re.findall(r"[a-z0-9]+", text.lower()))


def _finding(motions: Sequence[str], able: Sequence[Extents]) -> Finding:
    joint = able[0].joint
    gone = list(dict.fromkeys(map(str, able)))
    more = [f"and {len(gone) - _SHOWN} more"] if len(gone) > _SHOWN else []
    return Finding(
        code="W_MOTION_RANGE",
        where=f"joints.{joint.name}",
        parts=(joint.child,),
        message=f"The analysis says: {'; '.join(motions)}. No joint has such a travel: {', '.join([*gone[:_SHOWN], *more])}.",
        hint=f"Correct the limits of {joint.name}, the parameter that they are made of, or what moves it; keep them if the analysis is wrong.",
    )
