"""Expressions: the arithmetic that lets one number of a plan follow from others.

It knows `+ - * / ( )`, decimal literals, names of parameters, `pi`, and the functions of `FUNCTIONS`. Angles of trigonometric functions
are in degrees, as in FreeCAD. Text is parsed with `ast` and translated to closures: nothing is ever evaluated as Python.
"""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

from articad.errors import PlanError, did_you_mean
from articad.findings import Finding

MAX_CHARACTERS = 200  # longer arithmetic belongs in parameters of its own
MAX_DEPTH = 40  # keeps every recursion below shallow
_FULL_TURN = 360.0
_PARSED = 8192  # expressions in the cache: more than any plan has, so that each is parsed once

Environment = Mapping[str, float]
_Evaluator = Callable[[Environment], float]


def _sine(degrees: float) -> float:
    """Return the sine of an angle in degrees, exact at multiples of 90."""
    turn = math.fmod(degrees, _FULL_TURN)
    if turn % 90.0 == 0.0:
        return (0.0, 1.0, 0.0, -1.0)[int(turn // 90.0) % 4]
    return math.sin(math.radians(turn))


def _cosine(degrees: float) -> float:
    turn = math.fmod(degrees, _FULL_TURN)
    if turn % 90.0 == 0.0:
        return (1.0, 0.0, -1.0, 0.0)[int(turn // 90.0) % 4]
    return math.cos(math.radians(turn))


def _tangent(degrees: float) -> float:
    turn = math.fmod(degrees, _FULL_TURN)
    if turn % 90.0 == 0.0:
        if turn % 180.0 != 0.0:
            raise ValueError(f"tan({degrees:g}) has no value")
        return 0.0
    return math.tan(math.radians(turn))


def _arc(function: Callable[[float], float], name: str) -> Callable[[float], float]:
    def inverse(value: float) -> float:
        if not -1.0 <= value <= 1.0:
            raise ValueError(f"{name} needs a value from -1 to 1, not {value:.6g}")
        return math.degrees(function(value))

    return inverse


def _root(value: float) -> float:
    if value < 0.0:
        raise ValueError(f"sqrt of the negative number {value:.6g}")
    return math.sqrt(value)


def _divide(dividend: float, divisor: float) -> float:
    if divisor == 0.0:
        raise ValueError(f"{dividend:.6g} is divided by zero")
    return dividend / divisor


FUNCTIONS: Mapping[str, tuple[int, Callable[..., float]]] = {
    "abs": (1, abs),
    "acos": (1, _arc(math.acos, "acos")),
    "asin": (1, _arc(math.asin, "asin")),
    "atan": (1, lambda value: math.degrees(math.atan(value))),
    "atan2": (2, lambda y, x: math.degrees(math.atan2(y, x))),
    "ceil": (1, lambda value: float(math.ceil(value))),
    "cos": (1, _cosine),
    "floor": (1, lambda value: float(math.floor(value))),
    "hypot": (2, math.hypot),
    "max": (2, max),
    "min": (2, min),
    "sin": (1, _sine),
    "sqrt": (1, _root),
    "tan": (1, _tangent),
}
"""Name -> (number of arguments, function)."""

CONSTANTS: Mapping[str, float] = {"pi": math.pi}
RESERVED = frozenset(FUNCTIONS) | frozenset(CONSTANTS)
_INVERSE_ANGLES = frozenset({"acos", "asin", "atan", "atan2"})  # FreeCAD gives their results a unit, which is divided out

_OPERATORS: Mapping[type[ast.operator], tuple[str, Callable[[float, float], float]]] = {
    ast.Add: ("+", lambda a, b: a + b),
    ast.Sub: ("-", lambda a, b: a - b),
    ast.Mult: ("*", lambda a, b: a * b),
    ast.Div: ("/", _divide),
}
_REFUSED_OPERATORS: Mapping[type[ast.operator], str] = {
    ast.Pow: "'**' is not allowed; multiply, as in a * a",
    ast.FloorDiv: "'//' is not allowed; use floor(a / b)",
}
_INSTEAD_OF = {"^": "Multiply, as in a * a.", "%": "Use a - b * floor(a / b)."}
_CHARACTERS = re.compile(r"[A-Za-z0-9_+\-*/(). ,\t]*")
_LITERAL = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_USABLE = "Use + - * / ( ), decimal literals, parameter names, pi and " + " ".join(FUNCTIONS) + "; angles are in degrees."


class ExpressionError(PlanError):
    """An expression that cannot be read or has no finite value.

    Attributes:
        code: E_EXPRESSION, E_EXPRESSION_CYCLE or E_NONFINITE.
        position: Column of the fault, from 1; 0 when it concerns the whole.
        hint: What would be valid.
    """

    def __init__(self, code: str, message: str, hint: str, *, position: int = 0) -> None:
        self.code, self.hint, self.position = code, hint, position
        super().__init__(message, findings=[Finding(code=code, where="expression", message=message, hint=hint)])


@dataclass(frozen=True)
class Expression:
    """A parsed expression.

    Attributes:
        text: As it was given.
        names: The parameters it uses, in order of appearance.
    """

    text: str
    names: tuple[str, ...]
    _tree: ast.expr
    _evaluator: _Evaluator

    def evaluate(self, values: Environment) -> float:
        """Return the value, with parameters from `values` (mm, degrees or plain numbers).

        Raises:
            ExpressionError: E_EXPRESSION for a name that `values` lacks; E_NONFINITE for a division by zero, a root of
                a negative number, or an overflow.
        """
        for name in self.names:
            if name not in values:
                raise unknown_parameter(self.text, name, values)
        try:
            value = self._evaluator(values)
        except (ValueError, OverflowError) as error:
            raise ExpressionError(
                "E_NONFINITE", f"{self.text!r} has no value: {error}.", "Change the expression or the parameters it uses."
            ) from None
        if not math.isfinite(value):
            raise ExpressionError("E_NONFINITE", f"{self.text!r} is {value}.", "Change the expression or the parameters it uses.")
        return value + 0.0  # −0 becomes 0, so that it does not show in a report or a digest

    def to_freecad(self, names: Mapping[str, str]) -> str:
        """Return the expression in FreeCAD's language, without a unit.

        Args:
            names: FreeCAD's name of each parameter, such as `{"width": "Parameters.p_width"}`.
        """
        return _freecad(self._tree, self.text, names)


@lru_cache(maxsize=_PARSED)
def parse(text: str) -> Expression:
    """Read an expression.

    Raises:
        ExpressionError: E_EXPRESSION with the position of the fault and what may be used instead.
    """
    if len(text) > MAX_CHARACTERS:
        hint = f"Use at most {MAX_CHARACTERS}: move a piece of it into a parameter of its own."
        raise ExpressionError("E_EXPRESSION", f"An expression has {len(text)} characters.", hint, position=MAX_CHARACTERS + 1)
    legal = _CHARACTERS.match(text)
    end = legal.end() if legal else 0
    if end < len(text):
        raise _refused(text, end, f"{text[end]!r} is not allowed", _INSTEAD_OF.get(text[end], _USABLE))
    indent = len(text) - len(text.lstrip())
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # "1if" and the like are refused below; Python's warnings are not for our users
            tree = ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        raise _refused(text, min(indent + (error.offset or 1) - 1, len(text)), _plain(error.msg)) from None
    except (MemoryError, RecursionError, ValueError):  # hundreds of parentheses
        raise _refused(text, 0, f"it is nested deeper than {MAX_DEPTH}") from None
    names: dict[str, None] = {}
    evaluator = _Translation(text, indent, names).closure(tree, 1)
    return Expression(text, tuple(names), tree, evaluator)


def dependency_order(parameters: Mapping[str, float | str]) -> list[str]:
    """Return the names so that each comes after those that it uses.

    Raises:
        ExpressionError: E_EXPRESSION for an unknown parameter; E_EXPRESSION_CYCLE.
    """
    order: dict[str, None] = {}

    def visit(name: str, path: tuple[str, ...]) -> None:
        if name in order:
            return
        if name in path:
            raise cycle_error((*path[path.index(name) :], name))
        number = parameters[name]
        if isinstance(number, str):
            for used in parse(number).names:
                if used not in parameters:
                    raise unknown_parameter(number, used, parameters)
                visit(used, (*path, name))
        order[name] = None

    for name in parameters:
        visit(name, ())
    return list(order)


def cycle_error(circle: Iterable[str]) -> ExpressionError:
    """Return the error for parameters that depend on each other; the first name is repeated at the end."""
    names = tuple(circle)
    return ExpressionError(
        "E_EXPRESSION_CYCLE",
        f"Parameters depend on each other: {' -> '.join(names)}.",
        f"Give one of {', '.join(names[:-1])} a number." if len(names) > 2 else f"Define {names[0]} without itself.",
    )


def unknown_parameter(text: str, name: str, known: Collection[str]) -> ExpressionError:
    """Return the error for an expression that uses an unknown parameter."""
    position = re.search(rf"\b{re.escape(name)}\b", text)
    column = position.start() if position else 0
    listed = ", ".join(sorted(known)) or "none are declared"
    hint = f"{did_you_mean(name, (*known, *RESERVED)).strip()} Parameters: {listed}. {_USABLE}".strip()
    return _refused(text, column, f"there is no parameter {name!r}", hint)


@dataclass(frozen=True)
class _Translation:
    """Translates syntax to closures and refuses everything but arithmetic."""

    text: str
    indent: int
    names: dict[str, None]

    def closure(self, node: ast.expr, depth: int) -> _Evaluator:
        if depth > MAX_DEPTH:
            raise self.refused(node, f"it is nested deeper than {MAX_DEPTH}")
        match node:
            case ast.Constant():
                return self.literal(node)
            case ast.Name(id=name):
                return self.name(node, name)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                inner = self.closure(operand, depth + 1)
                return lambda values: -inner(values)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.closure(operand, depth + 1)
            case ast.BinOp(left=left, op=operator, right=right):
                if type(operator) not in _OPERATORS:
                    raise self.refused(node, _REFUSED_OPERATORS.get(type(operator), "this operator is not allowed"))
                function = _OPERATORS[type(operator)][1]
                a, b = self.closure(left, depth + 1), self.closure(right, depth + 1)
                return lambda values: function(a(values), b(values))
            case ast.Call():
                return self.call(node, depth)
            case _:
                raise self.refused(node, f"{ast.get_source_segment(self.text.strip(), node)!r} is not arithmetic")

    def literal(self, node: ast.Constant) -> _Evaluator:
        source = ast.get_source_segment(self.text.strip(), node) or ""
        if not _LITERAL.fullmatch(source):
            raise self.refused(node, f"{source!r} is not a decimal number")
        number = float(source)
        return lambda _: number

    def name(self, node: ast.expr, name: str) -> _Evaluator:
        if name in CONSTANTS:
            constant = CONSTANTS[name]
            return lambda _: constant
        if name in FUNCTIONS:
            raise self.refused(node, f"{name} is a function; write {_signature(name)}")
        self.names[name] = None
        return lambda values: values[name]

    def call(self, node: ast.Call, depth: int) -> _Evaluator:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in FUNCTIONS:
            source = ast.get_source_segment(self.text.strip(), node.func)
            raise _refused(
                self.text,
                self.indent + node.col_offset,
                f"{source!r} is not a function",
                f"{did_you_mean(name, FUNCTIONS)} {_USABLE}".strip(),
            )
        count, function = FUNCTIONS[name]
        if len(node.args) != count or node.keywords:
            raise self.refused(node, f"{name} takes {count} argument{'s' * (count > 1)}: {_signature(name)}")
        arguments = [self.closure(argument, depth + 1) for argument in node.args]
        if count == 1:
            only = arguments[0]
            return lambda values: function(only(values))
        first, second = arguments
        return lambda values: function(first(values), second(values))

    def refused(self, node: ast.expr, reason: str) -> ExpressionError:
        return _refused(self.text, self.indent + node.col_offset, reason)


def _freecad(node: ast.expr, text: str, names: Mapping[str, str]) -> str:
    """Return FreeCAD's text of a node that `_Translation` has accepted; every operation in parentheses."""
    match node:
        case ast.BinOp(left=left, op=operator, right=right):
            return f"({_freecad(left, text, names)} {_OPERATORS[type(operator)][0]} {_freecad(right, text, names)})"
        case ast.UnaryOp(op=operator, operand=operand):
            return f"(-{_freecad(operand, text, names)})" if isinstance(operator, ast.USub) else _freecad(operand, text, names)
        case ast.Call(func=ast.Name(id=name), args=arguments):
            # FreeCAD separates arguments by ';' and reads min(2,3) as min(2.3)
            call = f"{name}({'; '.join(_freecad(argument, text, names) for argument in arguments)})"
            return f"({call} / 1 deg)" if name in _INVERSE_ANGLES else call
        case ast.Name(id=name):
            return name if name in CONSTANTS else names[name]
        case _:
            return str(ast.get_source_segment(text.strip(), node))


def _refused(text: str, column: int, reason: str, hint: str = _USABLE) -> ExpressionError:
    return ExpressionError(
        "E_EXPRESSION", f"{text!r} cannot be read at position {column + 1}: {reason.rstrip('.')}.", hint, position=column + 1
    )


def _signature(name: str) -> str:
    arguments = {"atan2": "y, x"}.get(name, "a, b" if FUNCTIONS[name][0] == 2 else "a")
    return f"{name}({arguments})"


def _plain(message: str) -> str:
    """Return Python's syntax message in words that suit arithmetic."""
    if message.startswith("invalid syntax"):
        return "it is not arithmetic here; is an operator missing, as in 2 * a?"
    return re.split(r"\. |;", message)[0].rstrip(".")
