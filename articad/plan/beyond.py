"""Further findings: other faults of a plan whose text does not have the right form, so that one check finds everything.

A plan that does not have the form cannot be checked. So a copy of it is repaired: a misspelt field gets the name that was meant; a field
that does not belong, or an entry of a list that cannot be read, is left out. A fault of the copy is a fault of the plan unless it
follows from what was left out.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from articad.bounds import values_in
from articad.errors import PlanError
from articad.files import PLAN_BYTES, read_file
from articad.findings import Finding, Findings
from articad.plan import reading
from articad.plan.check import check_plan
from articad.plan.schema import PLAN_FILE, AssemblyPlan
from articad.plan.short import expanded, functions_of

__all__ = ["further_findings"]

MOST_ROUNDS: Final = 200  # repairs: each removes at least one field or entry
_VALUES: Final = 300_000  # of a plan whose other faults are looked for; a plan of a thousand parts has a fifth
STAND_IN: Final = "no_name"  # replaces an invalid name
_OWN: Final = frozenset({
    *("E_NAME", "E_DUP_NAME", "E_NONFINITE", "E_PARAMETER_BOUNDS", "E_COUNT", "E_DENSITY", "E_FRICTION", "E_AXIS_ZERO", "E_AXIS_PARALLEL"),
    *("E_LIMITS_MISSING", "E_LIMITS_ORDER", "E_LIMITS_KIND", "W_LIMITS_EQUAL", "W_LIMITS_UNITS", "E_REST_OUTSIDE_LIMITS", "E_LEAD_ZERO"),
    *("E_FIT", "E_ALLOW", "E_JOINT_SELF", "E_EFFORT", "E_ENVELOPE_VALUE", "E_AXIS_NOT_ORTHOGONAL"),
})  # fmt: skip
"""Codes of findings that depend only on the entry that they are about."""
_NAMING: Final = {
    "E_EXPRESSION": "parameters",
    "E_PART_UNKNOWN": "parts",
    "E_CONNECTOR_UNKNOWN": "parts",
    "E_MATERIAL_UNKNOWN": "materials",
    "E_NO_GROUND": "parts",
}
"""Codes of findings that name an entry of a list."""


def further_findings(path: Path, found: Findings) -> Findings:
    """Return the findings about a plan's form together with the other faults of the plan.

    Args:
        path: The plan, or the folder that holds it.
        found: The findings about its form.
    """
    file = path / PLAN_FILE if path.is_dir() else path
    try:
        text = read_file(file, PLAN_BYTES, root=path if path.is_dir() else None)
        if values_in(text) > _VALUES:
            return found
        document = json.loads(text)
    except (OSError, ValueError, RecursionError):  # then only the form can be checked
        return found
    if not isinstance(document, dict) or reading.is_nested_deeper(document, reading.MOST_LEVELS):
        return found
    try:
        mended = _Mended(expanded(document, functions_of(document, file)))
    except PlanError:  # it cannot be written out, which is among the findings
        return found
    plan = mended.plan()
    if plan is None:
        return found
    known = {(finding.code, finding.where) for finding in found}
    return Findings(
        [*found, *(finding for finding in check_plan(plan) if (finding.code, finding.where) not in known and mended.tells(finding))]
    )


class _Mended:
    """A copy of a document, repaired until it has the form of a plan.

    Attributes:
        document: The copy.
        places: Paths of fields that were left out.
        lists: Names of the lists of which an entry was left out.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = copy.deepcopy(document)
        self.places: list[str] = []
        self.lists: set[str] = set()

    def plan(self) -> AssemblyPlan | None:
        """The plan made from the copy; None if it cannot be repaired."""
        for _ in range(MOST_ROUNDS):
            try:
                return AssemblyPlan.model_validate(self.document)
            except ValidationError as error:
                detail = error.errors(include_url=False)[0]
            if not self._mend(detail):
                return None
        return None

    def tells(self, finding: Finding) -> bool:
        """Return whether a finding about the copy is also true of the plan: it does not follow from what was left out."""
        if STAND_IN in finding.message or any(
            finding.where == place or finding.where.startswith((f"{place}.", f"{place}[")) for place in self.places
        ):
            return False
        if not self.lists or finding.code in _OWN:
            return True
        return finding.code in _NAMING and _NAMING[finding.code] not in self.lists

    def _mend(self, detail: Any) -> bool:
        """Repair the place of one of pydantic's errors; return False if nothing can be left out."""
        location, owner, raw = reading._resolved(AssemblyPlan, self.document, detail["loc"], detail["type"])  # noqa: SLF001 - the same room
        if not location:
            return False
        holder, key = reading.value_at(self.document, location[:-1]), location[-1]
        if detail["type"] == "extra_forbidden" and isinstance(raw, dict) and owner is not None and key in raw:
            meant = get_close_matches(str(key), [name for name in reading._keys(owner) if name not in raw], n=1)  # noqa: SLF001
            value = raw.pop(str(key))
            if meant:
                raw[meant[0]] = value
            return True
        field = None if owner is None else reading._field(owner, str(key))  # noqa: SLF001
        if isinstance(holder, dict) and holder is raw and key in holder and field is not None and not field.is_required():
            del holder[key]
            self.places.append(reading._path(self.document, location))  # noqa: SLF001
            return True
        if (
            detail["type"] == "plan_name"
            and isinstance(holder, dict)
            and isinstance(value := holder.get(key), str)
            and STAND_IN not in value
        ):
            holder[key] = f"{STAND_IN}.{STAND_IN}" if "." in value else STAND_IN
            self.places.append(reading._path(self.document, location))  # noqa: SLF001
            self.lists.add(str(location[0]))
            return True
        return self._leave_out(location)

    def _leave_out(self, location: Sequence[str | int]) -> bool:
        """Leave out the entry of a list that contains a place."""
        if len(location) < 2 or not isinstance(location[1], int):
            return False
        entries = self.document.get(str(location[0]))
        if not isinstance(entries, list) or not 0 <= location[1] < len(entries):
            return False
        entry = entries.pop(location[1])
        name = entry.get("name") if isinstance(entry, Mapping) else None
        self.places.append(f"{location[0]}.{name}" if isinstance(name, str) else str(location[0]))
        self.lists.add(str(location[0]))
        return True
