"""Numbers that remember how they were computed: a part script that gets them for its dimensions leaves its formulas behind.

A traced number is a float or an int, so everything that takes numbers takes it. Arithmetic, and the functions of `math` that
`traced_math` replaces, give traced numbers again. Everything else gives plain numbers: there the formula ends, and whoever compares the
recorded formulas with the script at other values sees that the result no longer follows.
"""

from __future__ import annotations

import builtins
import math
from collections.abc import Callable, Iterator, Sequence
from types import ModuleType
from typing import Any, Final, Self

__all__ = ["Formula", "TracedFloat", "TracedInt", "formula_of", "plain", "traced", "traced_builtins", "traced_math", "without_dust"]

ZERO: Final = 1e-12  # below it, a component of a rotation is rounding


class Formula:
    """An operation on formulas and plain numbers; `name` and no operands for a dimension."""

    __slots__ = ("name", "operands")

    def __init__(self, name: str, *operands: Formula | float) -> None:
        self.name, self.operands = name, operands


def formula_of(number: Any) -> Formula | float:
    """Return the formula of a traced number, or a plain number as it is."""
    return number.formula if isinstance(number, (TracedFloat, TracedInt)) else float(number)


def plain(value: Any) -> Any:
    """Return a number, or numbers in lists and tuples, without formulas."""
    if isinstance(value, TracedInt):
        return int.__add__(value, 0)
    if isinstance(value, TracedFloat):
        return float.__add__(value, 0.0)
    if type(value) in (list, tuple):
        return type(value)(map(plain, value))
    return value


def traced(name: str, value: float) -> TracedFloat | TracedInt:
    """Return a dimension as a traced number."""
    return TracedInt(value, Formula(f"d {name}")) if isinstance(value, int) else TracedFloat(value, Formula(f"d {name}"))


def without_dust(number: Any) -> Any:
    """Return a component of a rotation without the rounding of its sines: exactly 0, 1 or -1 where it is nearly that."""
    if isinstance(number, (TracedFloat, TracedInt)):
        return number
    return next((exact for exact in (0.0, 1.0, -1.0) if abs(number - exact) < ZERO), float(number))


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _made(value: Any, name: str, *operands: Any) -> Any:
    """Return a value with its formula, simplified where an operand is 0 or 1; plain if every operand is."""
    if not any(isinstance(operand, (TracedFloat, TracedInt)) for operand in operands) or isinstance(value, complex):
        return value
    simple = _simplified(name, *operands) if len(operands) == 2 else None
    if simple is not None:
        return simple
    formula = Formula(name, *map(formula_of, operands))
    return TracedInt(value, formula) if isinstance(value, int) else TracedFloat(value, formula)


def _simplified(name: str, first: Any, second: Any) -> Any:
    """Return the result of an operation with 0, 1 or -1 that leaves the other operand, its opposite, or 0; else None."""
    a, b = (None if isinstance(operand, (TracedFloat, TracedInt)) else float(operand) for operand in (first, second))
    if name == "mul" and 0.0 in (a, b):
        return 0.0
    if (name, b) in (("add", 0.0), ("sub", 0.0), ("mul", 1.0), ("div", 1.0), ("pow", 1.0)):
        return first
    if (name, a) in (("add", 0.0), ("mul", 1.0)):
        return second
    return -second if (name, a) in (("sub", 0.0), ("mul", -1.0)) else None


class _Arithmetic:
    """Operators that compute as the plain numbers of a subclass do, and record the operation."""

    formula: Formula

    def __new__(cls, value: float, formula: Formula) -> Self:
        """Make a number."""
        made = super().__new__(cls, value)  # type: ignore[call-arg]  # of float or int, which a subclass adds
        made.formula = formula
        return made

    def __deepcopy__(self, _: Any) -> Self:
        return self

    def __pos__(self) -> Any:
        return self


def _binary(name: str, operation: Callable[[Any, Any], Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    def forward(self: Any, other: Any) -> Any:
        return _made(operation(plain(self), plain(other)), name, self, other) if _is_number(other) else NotImplemented

    def backward(self: Any, other: Any) -> Any:
        return _made(operation(plain(other), plain(self)), name, other, self) if _is_number(other) else NotImplemented

    return forward, backward


def _unary(name: str, operation: Callable[[Any], Any]) -> Callable[..., Any]:
    return lambda self: _made(operation(plain(self)), name, self)


for _word, _name, _operation in (
    ("add", "add", lambda a, b: a + b),
    ("sub", "sub", lambda a, b: a - b),
    ("mul", "mul", lambda a, b: a * b),
    ("truediv", "div", lambda a, b: a / b),
    ("floordiv", "floordiv", lambda a, b: a // b),
    ("mod", "mod", lambda a, b: a % b),
    ("pow", "pow", lambda a, b: a**b),
):
    _forward, _backward = _binary(_name, _operation)
    setattr(_Arithmetic, f"__{_word}__", _forward)
    setattr(_Arithmetic, f"__r{_word}__", _backward)
for _word, _operation_of_one in (("neg", lambda a: -a), ("abs", builtins.abs), ("floor", math.floor), ("ceil", math.ceil)):
    setattr(_Arithmetic, f"__{_word}__", _unary(_word, _operation_of_one))


class TracedFloat(_Arithmetic, float):  # the operators above come first
    """A float with its formula."""


class TracedInt(_Arithmetic, int):
    """A whole number with its formula; as the length of a range it is plain."""


_FUNCTIONS: Final = {
    "sin": "sin", "cos": "cos", "tan": "tan", "asin": "asin", "acos": "acos", "atan": "atan", "atan2": "atan2", "sqrt": "sqrt",
    "hypot": "hypot", "radians": "radians", "degrees": "degrees", "pow": "pow", "fabs": "abs", "floor": "floor", "ceil": "ceil",
}  # fmt: skip


def _function(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    def call(*numbers: Any) -> Any:
        value = function(*map(plain, numbers))
        return _made(value, name, *numbers) if all(map(_is_number, numbers)) and numbers else value

    return call


def traced_math() -> ModuleType:
    """Return the module `math` with functions that record themselves."""
    module = ModuleType("math")
    module.__dict__.update({name: getattr(math, name) for name in dir(math) if not name.startswith("_")})
    module.__dict__.update({name: _function(recorded, getattr(math, name)) for name, recorded in _FUNCTIONS.items()})
    return module


def _extreme(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """Return `min` or `max`, recorded where it compares numbers."""

    def call(*values: Any, **options: Any) -> Any:
        rows: Sequence[Any] = values if len(values) != 1 else list(values[0])
        if options or not rows or not all(map(_is_number, rows)):
            return function(rows, **options)
        return _made(function(map(plain, rows)), name, *rows) if len(rows) > 1 else rows[0]

    return call


def traced_builtins() -> dict[str, Any]:
    """Return Python's built-in functions, with `min` and `max` that record themselves."""
    return dict(builtins.__dict__) | {"min": _extreme("min", builtins.min), "max": _extreme("max", builtins.max)}


def operands_first(formulas: Sequence[Formula | float]) -> Iterator[Formula]:
    """Yield formulas and all that they are made of, each once and after its operands."""
    seen: set[int] = set()
    waiting: list[tuple[Formula | float, bool]] = [(formula, False) for formula in reversed(formulas)]
    while waiting:
        formula, ready = waiting.pop()
        if not isinstance(formula, Formula) or id(formula) in seen:
            continue
        if ready:
            seen.add(id(formula))
            yield formula
            continue
        waiting.append((formula, True))
        waiting += [(operand, False) for operand in formula.operands]
