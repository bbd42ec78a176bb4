"""Slips: a script that failed because one number of its plan is in another unit, or has the wrong sign.

The script is run again with each number that may be such a slip corrected. If it then keeps its contract, it follows the number, so the
number is at fault and not the script: the failure goes to the designer of the plan. Nothing is proven about other numbers.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, NamedTuple

from articad.errors import ArticadError, KernelError
from articad.findings import Findings
from articad.kernels.contract import ENVELOPE_TOLERANCE, drift_findings
from articad.kernels.features import FEATURES
from articad.kernels.kernel import PartKernel, realise
from articad.plan.amending import amended
from articad.plan.brief import brief
from articad.plan.expressions import parse
from articad.plan.fields import lengths_in
from articad.plan.remedies import digits, offered
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan
from articad.plan.usage import CLEARANCE, SIZE
from articad.processes import scratch

__all__ = ["LONGEST", "UNITS", "explained", "longest_other", "numbers_of"]

_OF_NUMBERS: Final = frozenset({"E_SCRIPT_ERROR", "E_NOT_ONE_SOLID", "E_EMPTY_SOLID", "E_INVALID_SOLID", "E_CONNECTOR_DRIFT"})
_OF_SCRIPTS: Final = ("KeyError", "NameError", "SyntaxError", "ImportError", "AttributeError", "ModuleNotFoundError", "IndentationError")
UNITS: Final = {1000.0: "metres", 25.4: "inches"}
"""Units that are mistaken for millimetres, by their length [mm]."""
_TRIALS: Final = 24  # builds of one failure
_TOLD: Final = 4  # numbers of a hint
LONGEST: Final = 5.0
"""A corrected length over the longest other one of its part, at most."""
_LONGEST_IF_ROUNDER: Final = 20.0
_ROUNDER: Final = 2  # significant digits fewer: the number was given in the other unit


class _Slip(NamedTuple):
    """A number of the plan that may be a slip.

    Attributes:
        address: Its address in the plan.
        value: As the plan states it.
        meant: Corrected.
        question: What the designer is asked.
        driven: The dimensions that follow from it.
    """

    address: str
    value: float
    meant: float
    question: str
    driven: frozenset[str]


def explained(error: KernelError, resolved: ResolvedPlan, name: str, script: bytes, kernel: PartKernel) -> KernelError:
    """Send a failure to the designer if one number, in another unit or with the other sign, lets the script keep its contract.

    Args:
        error: The failure of a script; its findings are replaced in place.
        resolved: The plan with its numbers.
        name: The part.
        script: Its source.
        kernel: Builds it.

    Returns:
        The same error. Each of its findings then has the route of the designer, and a hint that states the number.
    """
    codes = {finding.code for finding in error.findings.errors}
    if codes == {"E_ENVELOPE"} and (change := _exchanged(error.findings, resolved, name, script, kernel)):
        hint = (
            f"{offered([change], len(error.findings.errors))} With it, the script keeps its contract and has a feature at each connector."
        )
        error.findings = Findings(replace(one, route="design", hint=hint) if one.code == "E_ENVELOPE" else one for one in error.findings)
        return error
    is_code = any(finding.message.startswith(_OF_SCRIPTS) for finding in error.findings)
    if not codes or not codes <= _OF_NUMBERS or is_code:
        return error
    signs_only = "E_CONNECTOR_DRIFT" in codes  # a connector elsewhere in proportion is no slip of this part
    only_odd = "E_SCRIPT_ERROR" not in codes  # a larger number joins bodies, or cuts one away, whatever is wrong
    healing: list[_Slip] = []
    for slip in itertools.islice(_slips(resolved, name, signs_only=signs_only, only_odd=only_odd), _TRIALS):
        is_known = any(slip.driven <= other.driven and slip.question == other.question for other in healing)
        if not is_known and _keeps({slip.address: slip.meant}, resolved, name, script, kernel):
            healing.append(slip)
        if len(healing) == _TOLD:
            break
    if healing:
        numbers = "; or if ".join(f"{slip.address} is {slip.meant:.6g} instead of {slip.value:.6g} ({slip.question})" for slip in healing)
        hint = f"The script of {name} builds if {numbers}."
        error.findings = Findings(
            finding if finding.severity == "info" else replace(finding, route="design", hint=hint) for finding in error.findings
        )
    return error


def _exchanged(findings: Findings, resolved: ResolvedPlan, name: str, script: bytes, kernel: PartKernel) -> dict[str, Any]:
    """Return the envelope of the plan with its sides exchanged, if that is what the script builds, with a feature at each connector.

    A part that was built in another plane has its features elsewhere; without any connector that orders one, the two cannot be told apart.
    """
    target, written = resolved.parts[name], resolved.parts[name].spec.envelope_mm
    if target.envelope is None or written is None or not any(each.kind in FEATURES for each in target.connectors.values()):
        return {}
    wrong = {axis: one.value for one in findings.of("E_ENVELOPE") for axis in "xyz" if f"along {axis} " in one.message}
    built = [wrong.get(axis) or side for axis, side in zip("xyz", target.envelope, strict=True)]
    for order in itertools.permutations(range(3)):
        if all(abs(target.envelope[at] - size) <= ENVELOPE_TOLERANCE * size for at, size in zip(order, built, strict=True)):
            change = {f"parts.{target.spec.name}.envelope_mm": [written[at] for at in order]}
            return change if _keeps(change, resolved, name, script, kernel, with_features=True) else {}
    return {}


def _keeps(
    change: Mapping[str, Any], resolved: ResolvedPlan, name: str, script: bytes, kernel: PartKernel, *, with_features: bool = False
) -> bool:
    """Return whether the script keeps its contract after a change of the plan, and perhaps has a feature at each connector."""
    try:
        plan = AssemblyPlan.from_json(amended(resolved.plan.to_json(), change))
        other = resolve(plan, **{key: value for key, value in resolved.overrides.items() if f"parameters.{key}.value" not in change})
        target, told = other.parts[name], brief(other, name)
        with scratch.folder("slip") as folder:
            built = kernel.build(
                script,
                told,
                folder=Path(folder),
                deflection=1.0,
                probe=False,
                inspect=lambda connectors, bbox: drift_findings(target, told, connectors, bbox),
            )
            return built.findings.ok and not (with_features and realise(target, built)[1])
    except (ArticadError, ValueError):
        return False


def _slips(resolved: ResolvedPlan, name: str, *, signs_only: bool, only_odd: bool) -> Iterator[_Slip]:
    """Yield numbers that shape a part and may be slips: of sign, then of unit, the shortest first, as far as the part's proportions allow.

    With `only_odd`, the shortest one alone may be too short, and the longest too long. Numbers that become much rounder are tried first, and
    may give the part other proportions.
    """
    part = resolved.parts[name]
    lengths = lengths_in(part.dimensions)
    numbers = {address: number for address, number in numbers_of(resolved, name, lengths).items() if not CLEARANCE.search(address)}
    for address, (value, driven) in numbers.items():
        if value < 0.0 or (signs_only and not SIZE.search(address.removesuffix(".value"))):
            yield _Slip(address, value, -value, "is its sign wrong?", driven)
    if signs_only:
        return
    ascending = sorted(numbers.items(), key=lambda item: abs(item[1][0]))
    for address, (value, driven) in sorted(ascending, key=lambda item: not any(_is_rounder(item[1][0], factor) for factor in UNITS)):
        longest = longest_other(lengths, driven)
        is_suspect = not only_odd or abs(value) == abs(ascending[0][1][0])
        for factor, unit in UNITS.items():
            is_rounder = _is_rounder(value, factor)
            most = (_LONGEST_IF_ROUNDER if is_rounder else LONGEST) * longest
            if (is_suspect or is_rounder) and 0.0 < abs(value) * factor <= most:
                yield _Slip(address, value, value * factor, f"were {unit} given?", driven)
            if abs(value) > longest > 0.0 and unit == "metres":
                yield _Slip(address, value, value / factor, "were micrometres given?", driven)


def _is_rounder(value: float, factor: float) -> bool:
    return digits(value) - digits(value * factor) >= _ROUNDER


def longest_other(lengths: Mapping[str, float], driven: Collection[str]) -> float:
    """Return the longest of a part's lengths that do not follow from a number [mm]; 0 if there is none."""
    return max((abs(length) for name, length in lengths.items() if name not in driven), default=0.0)


def numbers_of(resolved: ResolvedPlan, name: str, lengths: Mapping[str, float]) -> dict[str, tuple[float, frozenset[str]]]:
    """Return the numbers that a part's lengths follow from, by address, each with the dimensions that follow from it."""
    found: dict[str, tuple[float, set[str]]] = {}
    spec = resolved.parts[name].spec
    stated = {parameter.name: parameter for parameter in resolved.plan.parameters}
    for dimension in lengths:
        written = spec.dimensions[dimension]
        if not isinstance(written, str):
            continue
        waiting, seen = list(parse(written).names), set[str]()
        while waiting:
            used = waiting.pop()
            if used in seen or used not in stated:
                continue
            seen.add(used)
            value = stated[used].value
            if isinstance(value, str):
                waiting += parse(value).names
            elif math.isfinite(float(value)):
                found.setdefault(f"parameters.{used}.value", (resolved.parameters[used], set()))[1].add(dimension)
    found |= {f"parts.{spec.name}.dimensions.{dimension}": (length, {dimension}) for dimension, length in lengths.items()}
    return {address: (value, frozenset(driven)) for address, (value, driven) in found.items()}
