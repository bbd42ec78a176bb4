"""How much text is parsed, and how many values it has before that: a parser makes up to 80 bytes of two characters. Standard library only."""

from __future__ import annotations

from typing import Final

__all__ = ["TEXT_BYTES", "TEXT_VALUES", "values_in"]

TEXT_BYTES: Final = 128 << 20
"""Of a file of cases, which is parsed whole; the checker of certificates has bounds of its own."""
TEXT_VALUES: Final = 6_000_000
"""In such a file."""

_COUNTED: Final = (b",", b"[", b"{", b":")
"""What begins or ends each value, so that there are at least as many as values; those within texts count, too."""


def values_in(content: bytes) -> int:
    """Return a number that no count of values in JSON exceeds by more than one."""
    return sum(map(content.count, _COUNTED))
