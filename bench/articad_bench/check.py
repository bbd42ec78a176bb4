"""What every check of a task has in common: what is required, what is measured, and whether it is met."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, Final

from articad.errors import ArticadError
from articad.plan.fields import PlanObject
from articad_bench.subject import Subject

Bounds = tuple[float, float]
Vector = tuple[float, float, float]
ROUNDED: Final = 1e-6  # share of a bound by which a measurement may miss it: kernels, files and poses round


@dataclass(frozen=True)
class Judgement:
    """Whether a check holds, and the numbers that say so.

    Attributes:
        kind: Of the check.
        ok: Whether it holds.
        wanted: In words.
        measured: In words.
    """

    kind: str
    ok: bool
    wanted: str
    measured: str

    def to_json(self) -> dict[str, Any]:
        """Return the row of a report."""
        return {"kind": self.kind, "ok": self.ok, "wanted": self.wanted, "measured": self.measured}


class Check(PlanObject):
    """Base of all checks."""

    kind: str

    def judge(self, subject: Subject) -> Judgement:
        """Measure and judge; what cannot be measured does not hold."""
        try:
            ok, measured = self.measured(subject)
        except ArticadError as error:
            ok, measured = False, str(error)
        return Judgement(self.kind, ok, self.wanted, measured)

    @property
    @abstractmethod
    def wanted(self) -> str:
        """What must hold, in words."""

    @abstractmethod
    def measured(self, subject: Subject) -> tuple[bool, str]:
        """Return whether it holds, and the measured numbers in words."""


def in_words(bounds: Bounds) -> str:
    """Return a range in words."""
    low, high = bounds
    return f"{low:g}" if low == high else f"at least {low:g}" if high == 999 else f"{low:g} to {high:g}"


def within(measured: float, bounds: Bounds) -> bool:
    """Return whether a measurement lies within bounds; who models exactly a bound is not refused for the last digits of a mesh."""
    low, high = widened(bounds)
    return low <= measured <= high


def widened(bounds: Bounds) -> Bounds:
    """Return bounds with the allowance of `within`."""
    low, high = (ROUNDED * max(1.0, abs(bound)) for bound in bounds)
    return bounds[0] - low, bounds[1] + high
