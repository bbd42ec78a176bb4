"""How the work of something grows with its size, counted in bytecodes of Python, never in seconds.

Counts at three sizes n, 2n, 3n of work that is linear have no second difference; that of work c·n² is 2·c·n².
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

MOST_A_PAIR = 0.25  # bytecodes for each pair of objects: one comparison of two names is more than ten


class Watched(str):
    """A name whose comparisons are counted: a search in a list, which is one bytecode otherwise, counts each of them."""

    __hash__ = str.__hash__
    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        return str.__eq__(self, other)


def bytecodes_of(work: Callable[[], Any]) -> int:
    """Return how many bytecodes of Python a piece of work runs."""
    count = 0

    def seen(frame: Any, event: str, _argument: object) -> Any:
        nonlocal count
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        count += event == "opcode"
        return seen

    sys.settrace(seen)
    try:
        work()
    finally:
        sys.settrace(None)
    return count


def bytecodes_a_pair(work: Callable[[int], Callable[[], Any]], size: int) -> float:
    """Return how many bytecodes work has for each pair of its objects: 0 for linear work.

    Args:
        work: Prepares the work of a size.
        size: The least of the three sizes; the others are twice and thrice as large.
    """
    work(size)()  # imports and caches
    one, two, three = (bytecodes_of(work(times * size)) for times in (1, 2, 3))
    return (three - 2 * two + one) / (2 * size**2)
