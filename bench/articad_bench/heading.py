"""Where a product points: where no text says what lies along x or y, it may stand turned by any quarter about the upright axis."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any, Final

from articad_bench.check import Check, Judgement
from articad_bench.subject import Subject

QUARTERS: Final = (1, 2, 3)
NAMED: Final = re.compile(r"(?<!\w)(?<!\d )[xyXY](?!\w)(?!'s)(?! ?\d)")
"""An axis that a text names: x in "along x", but not in "140 x 100"."""
_WAYS: Final = frozenset({"axis", "along", "toward"})
"""Fields of checks with a direction: a letter or a vector."""


def names_direction(texts: Iterable[str]) -> bool:
    """Return whether one of these texts says what lies along x or y."""
    return any(NAMED.search(text) for text in texts)


def is_directed(check: Check) -> bool:
    """Return whether a check tells x from y."""
    row = check.model_dump()
    return _directs(row) or (row["kind"] in {"size", "room"} and row["mm"][0] != row["mm"][1])


def _directs(value: Any) -> bool:
    if isinstance(value, dict):
        ways = any(_is_level(value.get(name)) for name in _WAYS)
        return ways or value.get("side") in {"x", "y"} or any(_directs(each) for each in value.values())
    return isinstance(value, tuple | list) and any(_directs(each) for each in value)


def _is_level(way: Any) -> bool:
    return way in ("x", "y") if isinstance(way, str) else way is not None and bool(way[0] or way[1])


def judged(checks: Sequence[Check], subject: Subject, *, free: bool) -> tuple[Judgement, ...]:
    """Return what checks say of a product, as it stands or turned by the quarters with which all of them hold.

    Args:
        checks: Of a task.
        subject: The product.
        free: Whether it may be turned.
    """
    found = tuple(check.judge(subject) for check in checks)
    directed = [is_directed(check) for check in checks]
    if not free or not any(directed) or not all(row.ok or way for row, way in zip(found, directed, strict=True)):
        return found
    for quarters in () if all(row.ok for row in found) else QUARTERS:
        turned = subject.turned(quarters)
        again = tuple(check.judge(turned) if way else row for check, row, way in zip(checks, found, directed, strict=True))
        if all(row.ok for row in again):
            return again
    return found
