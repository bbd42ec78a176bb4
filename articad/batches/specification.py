"""The form of a batch's file, `articad.batch/1`: items, samples of plans, or both. What the form does not name is refused."""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, Field, FiniteFloat, ValidationError

from articad.errors import did_you_mean
from articad.formats import NAMED
from articad.plan.fields import PlanObject

__all__ = ["MOST_SAMPLES", "BatchFile", "Gate", "ItemRow", "SampleRow", "first_fault"]

Gate = Literal["rest", "motion", "certified"]
MOST_SAMPLES: Final = 100_000


def _is_format(name: str) -> str:
    if name not in NAMED:
        raise ValueError(f"there is no format {name[:40]!r}.{did_you_mean(name, NAMED)} Valid: {', '.join(NAMED)}")
    return name


def _is_range(ends: tuple[float, float]) -> tuple[float, float]:
    if ends[0] > ends[1]:
        raise ValueError(f"the range [{ends[0]:g}, {ends[1]:g}] is reversed")
    return ends


class _Row(PlanObject):
    plan: str
    gates: tuple[Gate, ...] = ("rest",)
    formats: tuple[Annotated[str, AfterValidator(_is_format)], ...] = ("urdf", "mjcf")
    kernel: Literal["build123d", "freecad"] | None = None


class ItemRow(_Row):
    """One item: a plan with values for its parameters."""

    values: dict[str, FiniteFloat] = Field(default_factory=dict)


class SampleRow(_Row):
    """As many items as `count`, with values drawn from ranges; without `parameters` those of the plan's `min` and `max`."""

    count: Annotated[int, Field(gt=0, le=MOST_SAMPLES)]
    seed: Annotated[int, Field(ge=0)] = 0
    parameters: dict[str, Annotated[tuple[FiniteFloat, FiniteFloat], AfterValidator(_is_range)]] = Field(default_factory=dict)


class BatchFile(PlanObject):
    """The whole file."""

    form: Literal["articad.batch/1"] = Field(default="articad.batch/1", alias="schema")
    items: tuple[ItemRow, ...] = ()
    sample: tuple[SampleRow, ...] = ()


def first_fault(error: ValidationError) -> str:
    """Return where the first fault of a form is, and what is wrong, such as `sample.0.count: it is missing`."""
    first: Any = error.errors(include_url=False)[0]
    where = ".".join(str(step)[:40] for step in first["loc"])
    reason = {"missing": "it is missing", "extra_forbidden": "there is no such field"}.get(first["type"], first["msg"])
    return f"{where}: {reason}"
