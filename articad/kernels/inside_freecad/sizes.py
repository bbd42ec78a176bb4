"""Which dimensions of a plan a drawing shows, and on what. Standard library only: programs inside FreeCAD import it, and so does articad."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

SAME = 1e-6  # mm
_TRIED = 8  # circles of one radius, to find one that its view shows
OF_RADIUS = re.compile(r"radius|_r$|^r$")  # names of dimensions that a circle has as its radius, and no straight edge has
OF_DIAMETER = re.compile(r"diameter|_dia$")  # and those that it has as its diameter
OF_HOLE = re.compile(r"bore|hole|drill")  # either
PLACE = re.compile(r"(^|_)([abuvwxyz]|left|right|top|bottom|from|to|inset)$")  # coordinates and distances from an origin
OF_EDGE = re.compile(  # and those that no circle has
    r"length|depth|height|high|width|wide|thick|tall|wall|floor|reach|play|clearance|gap|span|pitch|(^|_)low$"
)


def named_sizes(
    names: Mapping[str, float],
    overall: Sequence[tuple[str, str, Any, float]],
    circles: Sequence[tuple[str, Any, float]],
    edges: Sequence[tuple[str, str, Any, float]],
    most: int,
    shown: Callable[[str, Any], bool] | None = None,
) -> Iterator[tuple[str, str, list[Any], float, str]]:
    """Yield the dimensions of a page: the view, the kind, the elements that it measures, the value and the name in the plan.

    The overall sizes first; then the dimensions of the plan that a circle or an edge has. Equal numbers are not enough: a length is not
    that of a circle, a radius not that of an edge nor a diameter, and a circle or edge has one dimension. A name that may be either's is
    told only if no circle and edge both have its number; coordinates are not told. Where several names claim an element, it is told once,
    without a name, because nobody knows whose it is: the names belong into a table.

    Args:
        names: Dimensions of the plan [mm].
        overall: View, kind, both ends (None if a size has none) and size of the part along each axis.
        circles: View, element and radius of each circle, in order of preference.
        edges: View, kind, element and length of each straight edge along an axis, in order of preference.
        most: Number of dimensions that a page has room for.
        shown: Whether a view shows a circle as a visible line: such a circle is preferred. It is asked about a few circles of each radius.
    """
    left, told, taken = dict(names), 0, set()
    for view, kind, ends, size in overall:
        if ends is not None:
            name = next((key for key, value in left.items() if abs(value - size) < SAME and not _elsewhere(key)), "")
            left.pop(name, None)
            told += 1
            yield view, kind, list(ends), size, name
    wanted = {name: _having(name, value, circles, edges) for name, value in left.items() if value > 0.0}
    claims = Counter(element for having in wanted.values() for element in {row[2] for row in having})
    shared: set[tuple[str, str, float]] = set()
    for name, having in wanted.items():
        value = left[name]
        free = [row for row in having if row[2] not in taken and (*row[:2], value) not in shared]
        if not free:
            continue
        if told >= most:
            return
        view, kind, element = next((row for row in free[:_TRIED] if shown is None or _seen(row, shown)), free[0])
        told += 1
        taken.add(element)
        if claims[element] > 1:
            shared.add((view, kind, value))
        yield view, kind, [element], value, name if claims[element] == 1 else ""


def _elsewhere(name: str) -> bool:
    """Return whether a name says that a dimension is one of a circle, or a coordinate."""
    return any(kind.search(name) for kind in (OF_RADIUS, OF_DIAMETER, PLACE))


def _seen(row: tuple[str, str, Any], shown: Callable[[str, Any], bool]) -> bool:
    return row[1].startswith("Distance") or shown(row[0], row[2])


def _having(
    name: str, value: float, circles: Sequence[tuple[str, Any, float]], edges: Sequence[tuple[str, str, Any, float]]
) -> list[tuple[str, str, Any]]:
    """Return view, kind and element of all that may have a dimension: circles or edges; none where both may."""
    radius, diameter, edge = OF_RADIUS.search(name), OF_DIAMETER.search(name), OF_EDGE.search(name)
    if PLACE.search(name) and not radius:
        return []
    round_ones = [(row[0], "Radius", row[1]) for row in circles if abs(row[2] - value) < SAME and not diameter]
    if not round_ones and (diameter or OF_HOLE.search(name)) and not radius:
        round_ones = [(row[0], "Diameter", row[1]) for row in circles if abs(2 * row[2] - value) < SAME]
    straight = [(row[0], row[1], row[2]) for row in edges if abs(row[3] - value) < SAME]
    if radius or diameter:
        return round_ones
    if edge or not round_ones:
        return straight
    return [] if straight else round_ones
