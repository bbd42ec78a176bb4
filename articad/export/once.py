"""Results about an assembly that several formats need are computed once, and live as long as the assembly."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

_Answer = TypeVar("_Answer")
_KNOWN: WeakKeyDictionary[Any, dict[Hashable, Any]] = WeakKeyDictionary()


def once(assembly: Any, question: Hashable, answer: Callable[[], _Answer]) -> _Answer:
    """Return the answer to a question about an assembly, which never changes."""
    known = _KNOWN.setdefault(assembly, {})
    if question not in known:
        known[question] = answer()
    found: _Answer = known[question]
    return found
