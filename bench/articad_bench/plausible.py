"""Bounds of the numbers in checks: whoever wrote a task, judging it ends, and within memory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

LARGEST: Final = 1e7  # of any number [mm, ml, N, N/mm², degrees]: 10 km, 10 m³
_WORK: Final[Mapping[tuple[str, Any], tuple[float, float]]] = {  # numbers that decide how long a check works, or what it divides by
    ("clear_in_motion", "steps"): (1, 1000),
    ("certified", "seconds"): (1, 3600),
    ("meshes", "teeth"): (3, 1000),
    ("room", "mm"): (1, 100_000),
}


def plausible(checks: Any) -> Any:
    """Return stored checks as they are; what is no list of objects is left to the form.

    Raises:
        ValueError: If a number is not within its bounds; says where.
    """
    for row, place, number in _numbers(checks):
        kind = str(row.get("kind"))
        low, high = _WORK.get((kind, place[0]), (-LARGEST, LARGEST))
        if not low <= number <= high:  # also refuses NaN
            where = f"{'.'.join(map(str, place))} of the check {kind[:40]!r}"
            raise ValueError(f"{where} is {str(number)[:40]}, not between {low:,} and {high:,}")
    return checks


def _numbers(checks: Any) -> Iterator[tuple[dict[str, Any], tuple[Any, ...], float]]:
    """Yield each number of each row, and where it stands there."""
    rows = [row for row in checks if isinstance(row, dict)] if isinstance(checks, list) else []
    waiting: list[tuple[dict[str, Any], tuple[Any, ...], Any]] = [(row, (), row) for row in rows]
    while waiting:
        row, place, value = waiting.pop()
        if isinstance(value, (int, float)):
            yield row, place, value
        elif isinstance(value, (dict, list)):
            below = value.items() if isinstance(value, dict) else enumerate(value)
            waiting += [(row, (*place, name), one) for name, one in below]
