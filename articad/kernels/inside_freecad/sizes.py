"""Which dimensions of a plan a drawing shows, and on what. Standard library only: programs inside FreeCAD import it, and so does articad."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

SAME = 1e-6  # mm
_TRIED = 8  # circles of one radius, to find one that its view shows
OF_CIRCLE = re.compile(r"radius|diameter")  # names of dimensions that no straight edge has
OF_EDGE = re.compile(r"length|depth|height|width|thick|play|clearance|gap|span|pitch|_[xyz]$")  # and those that no circle has


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
    that of a circle, a radius not that of an edge, and a circle or edge has one dimension.

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
            name = next((key for key, value in left.items() if abs(value - size) < SAME and not OF_CIRCLE.search(key)), "")
            left.pop(name, None)
            told += 1
            yield view, kind, list(ends), size, name
    for name, value in left.items():
        round_ones = (row for row in circles if abs(row[2] - value) < SAME or abs(2 * row[2] - value) < SAME)
        if told >= most:
            return
        if value <= 0.0:
            continue
        free = [] if OF_EDGE.search(name) else [row for row in round_ones if row[1] not in taken]
        found = next((row for row in free[:_TRIED] if shown is None or shown(row[0], row[1])), free[0] if free else None)
        if found is not None:
            view, element, radius = found
            told += 1
            taken.add(element)
            yield view, "Radius" if abs(radius - value) < SAME else "Diameter", [element], value, name
            continue
        straight = (row for row in edges if abs(row[3] - value) < SAME and row[2] not in taken)
        edge = None if OF_CIRCLE.search(name) else next(straight, None)
        if edge is not None:
            told += 1
            taken.add(edge[2])
            yield edge[0], edge[1], [edge[2]], value, name
