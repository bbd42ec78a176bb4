"""Which joints a check means: by type, direction of axis at rest and range, never by name."""

from __future__ import annotations

import math
from typing import Any, Final, Literal

import numpy as np

from articad.arrays import FloatArray
from articad.kinematics.joints import Joint, JointType
from articad.plan.fields import PlanObject
from articad_bench.check import Bounds, Vector, in_words
from articad_bench.subject import Subject

AXIS_RAD: Final = math.radians(5)  # by which an axis may lean from the one asked for
SPAN_SLACK: Final = 1e-6  # deg or mm: what becomes of a range that is converted to radians and back


class JointWanted(PlanObject):
    """Which joints are meant: by type, direction of axis at rest and range; `turn` is the range of the second angle, or of the turn beside a slide."""

    type: JointType
    axis: Vector | None = None
    span: Bounds | Literal["endless"] | None = None
    turn: Bounds | Literal["endless"] | None = None

    def found(self, subject: Subject) -> list[Joint]:
        """Return the joints of a subject that are like this."""
        return [joint for joint in subject.assembly.joints if self._is(subject, joint)]

    def _is(self, subject: Subject, joint: Joint) -> bool:
        if joint.type is not self.type:
            return False
        if self.axis is not None and not parallel(subject.axis(joint), np.array(self.axis)):
            return False
        return _reaches(subject.span(joint), self.span) and (self.turn is None or _reaches(subject.turn(joint), self.turn))

    def __str__(self) -> str:
        axis = "" if self.axis is None else f" about or along {in_numbers(self.axis)}"
        unit = "mm" if self.type in {JointType.SLIDER, JointType.CYLINDRICAL, JointType.PLANAR} else "°"
        span = "" if self.span is None else ", endless" if self.span == "endless" else f", range {in_words(self.span)} {unit}"
        turn = "" if self.turn is None else ", turns without end" if self.turn == "endless" else f", turns by {in_words(self.turn)} °"
        return f"{self.type}{axis}{span}{turn}"


def _reaches(width: float, wanted: Bounds | Literal["endless"] | None) -> bool:
    """Return whether a range is as wide as is wanted [deg or mm]."""
    if wanted == "endless":
        return math.isinf(width)
    return wanted is None or wanted[0] - SPAN_SLACK <= width <= wanted[1] + SPAN_SLACK


def parallel(a: FloatArray, b: FloatArray) -> bool:
    """Return whether two directions are the same, or opposite, within what an axis may lean."""
    return abs(float(a @ b)) >= math.cos(AXIS_RAD) * float(np.linalg.norm(a) * np.linalg.norm(b))


def in_numbers(vector: Any) -> str:
    """Return a vector in words."""
    return "(" + ", ".join(f"{float(x):.3g}" for x in vector) + ")"
