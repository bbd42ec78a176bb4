"""Phrases that several checks use."""

from __future__ import annotations

from collections.abc import Sequence

_SHOWN = 4  # names in a message; all of them are in the finding's parts


def listed(names: Sequence[str]) -> str:
    """Return `a, b and 3 more`."""
    shown = [name if len(name) <= 60 else f"{name[:57]}…" for name in names[:_SHOWN]]
    if len(names) > _SHOWN:
        return f"{', '.join(shown)} and {len(names) - _SHOWN} more"
    return " and ".join([", ".join(shown[:-1]), shown[-1]]) if len(shown) > 1 else "".join(shown)


def counted(count: int, one: str, many: str = "") -> str:
    """Return `1 link`, `2 links`."""
    return f"{count} {one if count == 1 else many or f'{one}s'}"
