"""Traced numbers: random formulas over dimensions give what Python gives, also at other dimensions."""

from __future__ import annotations

import math
import operator
import random
from collections.abc import Callable
from typing import Any

import pytest

from articad.kernels.traced_numbers import Formula, TracedFloat, TracedInt, formula_of, plain, traced, traced_builtins, traced_math

MATH, BUILTINS = traced_math(), traced_builtins()
BINARY: dict[str, Callable[..., Any]] = {"add": operator.add, "sub": operator.sub, "mul": operator.mul, "div": operator.truediv}
MEANING: dict[str, Callable[..., Any]] = {
    **BINARY,
    **{name: getattr(math, name) for name in ("sin", "cos", "tan", "atan", "atan2", "sqrt", "hypot", "radians", "degrees")},
    "neg": operator.neg,
    "abs": abs,
    "pow": operator.pow,
    "min": min,
    "max": max,
}


def value(formula: Formula | float, dimensions: dict[str, float]) -> float:
    """Return a formula's value, computed here."""
    if not isinstance(formula, Formula):
        return formula
    if formula.name.startswith("d "):
        return dimensions[formula.name[2:]]
    return float(MEANING[formula.name](*(value(operand, dimensions) for operand in formula.operands)))


def grown(rng: random.Random, depth: int, leaves: list[Any], functions: Any, extremes: Any) -> Any:
    """Return a random number made of others; the same with the same seed, whatever the leaves are."""
    if depth == 0:
        return rng.choice([*leaves, 0, 1, -1, 2.5])
    a, b = (grown(rng, depth - 1, leaves, functions, extremes) for _ in range(2))
    kind = rng.choice([*BINARY, "sin", "atan2", "hypot", "sqrt", "neg", "abs", "min", "max", "square", "radians"])
    made: dict[str, Callable[[], Any]] = {
        **{name: lambda: BINARY[kind](a, b if kind != "div" else functions.hypot(b, 1.5)) for name in BINARY},
        **{name: lambda: extremes[kind](a, b) for name in ("min", "max")},
        **{name: lambda: MEANING[kind](a) for name in ("neg", "abs")},
        **{name: lambda: getattr(functions, kind)(a, functions.hypot(b, 1.0)) for name in ("atan2", "hypot")},
        "square": lambda: a**2,
        "sqrt": lambda: functions.sqrt(functions.hypot(a, b)),
    }
    return made[kind]() if kind in made else getattr(functions, kind)(a)


@pytest.mark.parametrize("seed", range(60))
def test_a_formula_gives_what_python_gives_at_every_dimension(seed: int) -> None:
    before, after = {"a": 3.25, "b": -1.5, "n": 4}, {"a": 2.75, "b": 1.25, "n": 5}
    names = list(before)
    made = grown(random.Random(seed), 4, [traced(name, before[name]) for name in names], MATH, BUILTINS)
    for dimensions in (before, after):
        wanted = grown(random.Random(seed), 4, [dimensions[name] for name in names], math, {"min": min, "max": max})
        assert value(formula_of(made), dimensions) == pytest.approx(wanted, rel=1e-9, abs=1e-9)
    assert plain(made) == pytest.approx(grown(random.Random(seed), 4, list(before.values()), math, {"min": min, "max": max}), rel=1e-12)


def test_what_is_not_arithmetic_gives_a_plain_number() -> None:
    width, count = traced("width", 4.0), traced("hole_count", 3)
    assert isinstance(width, TracedFloat)
    assert isinstance(count, TracedInt)
    assert list(range(count)) == [0, 1, 2]
    assert type(int(width)) is int
    assert type(plain(width)) is float
    assert width < 5 <= width + 1


def test_nothing_is_recorded_where_a_dimension_has_no_effect() -> None:
    width = traced("width", 4.0)
    assert width * 0 == 0
    assert not isinstance(width * 0, TracedFloat)
    assert (width + 0) is width
    assert (1 * width) is width
