"""The repair of a planted fault by somebody who only does what the hints of findings say.

Plans: the repairer follows one hint after another, in the order of the findings and of the alternatives of a hint, until the plan has no
error and no warning. What results is built and examined. If it is not green, the repairer takes the last step back and tries the next
alternative, then goes on with the hints of what was found there. A run has three rounds, so three products may be built.

Scripts: an author who is asked about the part with the mistake writes what was ordered. So a finding that goes to this author heals.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

import numpy as np

from articad.errors import ArticadError
from articad.findings import Finding
from articad.plan.brief import brief
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad_bench.faulty import Fault, Json, Product, obedient
from articad_bench.obeying import followed

__all__ = ["healed"]

Examine = Callable[[Product], Sequence[Finding]]
"""Returns the errors and warnings about a product."""
PRODUCTS: Final = 3  # that are built
_STEPS: Final = 10  # changes one after another
_PLANS: Final = 15  # that are checked
_ALIKE: Final = 1e-3  # relative difference, and mm, that is rounding of the numbers in hints


def healed(fault: Fault, findings: Sequence[Finding], check: Callable[[Json], Sequence[Finding]], examine: Examine) -> bool:
    """Return whether the repair of a faulty plan ends with a product without errors and warnings.

    Args:
        fault: The case.
        findings: The errors and warnings about it.
        check: Returns the errors and warnings of a plan alone.
        examine: Builds and examines a product. The good product is known to be green: where the first hints lead to it among others,
            the repair ends there at the latest, and nothing is built.
    """
    good = _numbers(fault.good.plan)
    plans = list(itertools.islice(_proposed(fault.bad.plan, findings, check), PRODUCTS))
    if any(_alike(_numbers(plan), good) for plan in plans):
        return True
    for built in itertools.count():
        if built in (PRODUCTS, len(plans)):
            return False
        found = examine(Product(fault.good.name, plans[built], obedient(fault.good, plans[built])))
        if not found:
            return True
        further = itertools.islice(_proposed(plans[built], found, check), PRODUCTS - len(plans))
        plans += [plan for plan in further if plan not in plans]
        if any(_alike(_numbers(plan), good) for plan in plans):
            return True
    raise AssertionError("the loop returns")


def _proposed(plan: Json, findings: Sequence[Finding], check: Callable[[Json], Sequence[Finding]]) -> Iterator[Json]:
    """Yield plans without findings to which the hints lead, depth first."""
    start: Json = json.loads(json.dumps(plan))
    known = {_mark(start): list(findings)}
    ways, seen = [[start]], {_mark(start)}
    for _ in range(_PLANS):
        if not ways:
            return
        way = ways.pop()
        here = known.get(_mark(way[-1]))
        here = list(check(way[-1])) if here is None else here
        known[_mark(way[-1])] = here
        if not here:
            yield way[-1]
            continue
        after = next((plan for finding in here for plan in _followed(finding, way[-1]) if _mark(plan) not in seen), None)
        if after is not None and len(way) <= _STEPS:
            seen.add(_mark(after))
            ways += [way, [*way, after]]


def _followed(finding: Finding, plan: Json) -> list[Json]:
    try:
        return followed(finding, plan)
    except (ArticadError, LookupError, ValueError, StopIteration, AssertionError):
        return []  # a hint that cannot be followed


def _mark(plan: Json) -> str:
    return json.dumps(plan, sort_keys=True)


def _numbers(plan: Json) -> Any:
    """Return all that a plan states, with its numbers: what authors get, poses, motions and materials."""
    try:
        resolved = resolve(AssemblyPlan.from_json(plan))
    except ArticadError:
        return None
    parts = {
        name: [np.asarray(part.T_rest.matrix).tolist(), None if part.derivation is not None else brief(resolved, name)]
        for name, part in resolved.parts.items()
    }
    joints: dict[str, Any] = {}  # by ends: a joint that was added may be called otherwise
    for joint in resolved.joints:
        ends = f"{joint.parent}.{joint.parent_connector} {joint.child}.{joint.child_connector}"
        joints[ends] = [str(joint.type), str(joint.mate), joint.rest, vars(joint.limits)]
    couplings = [[each.a, each.b, float(each.ratio)] for each in resolved.couplings]
    materials = {name: vars(material) for name, material in resolved.materials.items()}
    return [parts, joints, couplings, materials, {name: vars(fit) for name, fit in resolved.fits.items()}, resolved.plan.freedoms]


def _alike(one: Any, other: Any) -> bool:
    """Return whether two results of `_numbers` are the same within rounding."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_alike(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(_alike, one, other))
    if isinstance(one, int | float) and isinstance(other, int | float):
        return one == other or abs(one - other) <= _ALIKE * max(1.0, abs(one), abs(other))
    return bool(one == other)
