"""Evaluation: converts parameters and every Number of a plan to floats; a failure is a finding, and its value NaN."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping

import numpy as np

from articad.connectors import SE3
from articad.errors import did_you_mean
from articad.findings import Finding, relocated
from articad.plan.expressions import FUNCTIONS, RESERVED, ExpressionError, cycle_error, parse, unknown_parameter
from articad.plan.schema import AssemblyPlan, Parameter, PartSpec, Pose

NAN = math.nan
LARGEST = 1e12  # mm, or any unit: a million kilometres
_AXIS_ZERO = 1e-9  # length below which an axis has no direction, as in articad.connectors
_DEFAULT_POSE = Pose()
_IDENTITY = SE3.identity()

Triple = tuple[float, float, float]


class Evaluation:
    """The numbers of one plan for one choice of its parameters.

    Args:
        plan: The plan.
        overrides: Values that replace those of parameters, by name.

    Attributes:
        values: Every parameter's value, mm, degrees or plain; NaN where it has none.
        findings: Everything that could not be evaluated, unordered.
    """

    def __init__(self, plan: AssemblyPlan, overrides: Mapping[str, float]) -> None:
        self.plan = plan
        self.findings: list[Finding] = []
        self.values: dict[str, float] = {}
        self._given: dict[str, float | str] = {}
        self._broken: set[str] = set()
        for parameter in plan.parameters:
            self._given.setdefault(parameter.name, parameter.value)
        for name in overrides.keys() - self._given.keys():
            hint = f"{did_you_mean(name, self._given).strip()} Parameters: {', '.join(self._given) or 'none are declared'}.".strip()
            self.report("E_PARAMETER_UNKNOWN", f"parameters.{name}", f"There is no parameter {name!r}.", hint)
        self._given.update({name: value for name, value in overrides.items() if name in self._given})
        for name in self._given:
            self._settle(name, ())
        self.values = {name: self.values[name] for name in self._given}

    def report(self, code: str, where: str, message: str, hint: str, **rest: object) -> None:
        """Add a finding."""
        self.findings.append(Finding(code=code, where=where, message=message, hint=hint, **rest))  # type: ignore[arg-type]

    def check_parameters(self) -> None:
        """Report invalid names and bounds of parameters."""
        for name, count in Counter(parameter.name for parameter in self.plan.parameters).items():
            if count > 1:
                self.report(
                    "E_DUP_NAME", f"parameters.{name}", f"{count} parameters are called {name!r}.", "Rename all but one.", value=count
                )
        for parameter in self.plan.parameters:
            if parameter.name in RESERVED:
                message = (
                    f"{parameter.name!r} is the name of a function or constant of expressions, so no expression can use the parameter."
                )
                hint = f"Rename it, for example to {parameter.name}_value, here and in each expression that uses it."
                self.report("E_NAME", f"parameters.{parameter.name}.name", message, hint)
            self._check_bounds(parameter)

    def bounds(self, parameter: Parameter) -> tuple[float, float]:
        """Return a parameter's bounds, infinite if it states none."""
        where = f"parameters.{parameter.name}"
        low = -math.inf if parameter.min is None else self.number(parameter.min, where, "min")
        high = math.inf if parameter.max is None else self.number(parameter.max, where, "max")
        return low, high

    def _check_bounds(self, parameter: Parameter) -> None:
        low, high = self.bounds(parameter)
        value, unit = self.values[parameter.name], {"1": None}.get(parameter.unit, parameter.unit)
        where = f"parameters.{parameter.name}"
        if low > high:
            message, hint = f"min {low:.6g} is above max {high:.6g}.", f"Did you mean min {high:.12g}, max {low:.12g}?"
            self.report("E_PARAMETER_BOUNDS", where, message, hint, value=low, limit=high, unit=unit)
        elif value < low or value > high:
            bound, name = (low, "min") if value < low else (high, "max")
            message = f"{parameter.name} is {value:.6g}, {'below its min' if name == 'min' else 'above its max'} {bound:.6g}."
            hint = f"Set the value to {bound:.12g}, or {name} to {value:.12g}."
            self.report("E_PARAMETER_BOUNDS", where, message, hint, value=value, limit=bound, unit=unit)

    def _settle(self, name: str, path: tuple[str, ...]) -> None:
        """Evaluate a parameter after those that it uses."""
        if name in self.values:
            return
        if name in path:
            circle = path[path.index(name) :]
            for member in circle:
                self._break(member)
            error = cycle_error((*circle, name))
            self.findings.append(relocated(error.findings[0], f"parameters.{circle[0]}.value"))
            return
        number = self._given[name]
        if isinstance(number, str):
            try:
                used = parse(number).names
            except ExpressionError:
                used = ()
            for other in used:
                if other in self._given:
                    self._settle(other, (*path, name))
        if name not in self.values:
            value = self.number(number, f"parameters.{name}", "value")
            self.values[name] = value
            if math.isnan(value):
                self._break(name)

    def _break(self, name: str) -> None:
        self.values[name] = NAN
        self._broken.add(name)

    def number(self, number: float | str, where: str, *path: str) -> float:
        """Return the value of a Number; NaN after reporting a failure at `where.path`, or silently if a parameter it uses has failed."""
        if not isinstance(number, str):
            return self._sane(number, where, path)
        try:
            expression = parse(number)
            if self._broken and not self._broken.isdisjoint(expression.names):
                return NAN
            for name in expression.names:
                if name not in self._given:
                    raise self._of_a_dimension(number, name, where) or unknown_parameter(number, name, self._given)
            return self._sane(expression.evaluate(self.values), where, path)
        except ExpressionError as error:
            if not self._clashes(number):  # that is reported once, where the parameter is declared
                self.findings.append(relocated(error.findings[0], ".".join((where, *path))))
            return NAN

    def _clashes(self, expression: str) -> bool:
        """Return whether an expression uses a parameter that is called like a function."""
        return any(re.search(rf"\b{name}\b(?!\s*\()", expression) for name in self._given if name in FUNCTIONS)

    def _of_a_dimension(self, expression: str, name: str, where: str) -> ExpressionError | None:
        """Return the error for an expression of a part that uses one of its dimensions; None if it has no such dimension."""
        part = next(
            (part for part in self.plan.parts if isinstance(part, PartSpec) and f"{where}.".startswith(f"parts.{part.name}.")), None
        )
        if part is None or name not in part.dimensions:
            return None
        value = str(part.dimensions[name])
        if re.search(rf"\b{name}\b", value):  # it is made of the missing parameter itself
            return None
        simple = expression == name or re.fullmatch(r"[\w.]+", value)
        meant = value if simple else f"({value})"
        written = re.sub(rf"\b{name}\b", lambda _: meant, expression)
        message = f"{expression!r} cannot be read: {name} is a dimension of {part.name}, and expressions see parameters only."
        return ExpressionError("E_EXPRESSION", message, f"Write it in parameters: {written!r}.")

    def _sane(self, value: float, where: str, path: tuple[str, ...]) -> float:
        """Return the value, or NaN after reporting one that is too large: its square must still be finite."""
        if -LARGEST <= value <= LARGEST:
            return value
        message, hint = (
            f"{value:.6g} is larger than anything that is built.",
            f"Give a number within ±{LARGEST:g}; lengths are millimetres.",
        )
        self.report("E_SCALE", ".".join((where, *path)), message, hint, value=value, limit=math.copysign(LARGEST, value))
        return NAN

    def triple(self, vector: tuple[float | str, float | str, float | str], where: str, key: str) -> Triple:
        """Return the values of a Vector."""
        x, y, z = vector
        return self.number(x, where, f"{key}[0]"), self.number(y, where, f"{key}[1]"), self.number(z, where, f"{key}[2]")

    def pose(self, pose: Pose, where: str) -> SE3 | None:
        """Return p -> R (p - about) + about + at; None if a number fails or the axis has no direction."""
        if pose == _DEFAULT_POSE:
            return _IDENTITY
        at, about = self.triple(pose.at, where, "at"), self.triple(pose.about, where, "about")
        axis, angle = self.triple(pose.axis, where, "axis"), self.number(pose.angle_deg, where, "angle_deg")
        if math.hypot(*axis) < _AXIS_ZERO:
            self.report("E_AXIS_ZERO", f"{where}.axis", "The axis (0, 0, 0) has no direction.", "Give a direction, such as [0, 0, 1].")
            return None
        if not math.isfinite(sum(at) + sum(about) + sum(axis) + angle):
            return None
        if angle == 0.0:
            return SE3.from_translation(at)
        return SE3.from_translation(at) @ SE3.from_axis_angle(axis, np.radians(angle), about)
