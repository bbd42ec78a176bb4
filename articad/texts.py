"""Which characters a text of a plan, a record or a name may hold."""

from __future__ import annotations

import re
from typing import Any, Final

__all__ = ["SPOILED", "escaped", "spoiled"]

_SPOILED: Final = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
SPOILED: Final = "control characters, halves of surrogate pairs and noncharacters"
"""What `spoiled` looks for, in words: no XML file holds them (XML 1.0, section 2.2), or terminals obey them."""


def spoiled(value: Any) -> str | None:
    """Return the first character in a text, or in the keys and texts of a JSON value, that no file should hold; None if there is none."""
    waiting = [value]
    while waiting:
        one = waiting.pop()
        if isinstance(one, str):
            if found := _SPOILED.search(one):
                return found.group()
        elif isinstance(one, dict):
            waiting += [*one, *one.values()]
        elif isinstance(one, list | tuple):
            waiting += one
    return None


def escaped(text: str) -> str:
    r"""Return a text with the characters that `spoiled` finds as JSON writes them, such as `\u0008`."""
    return _SPOILED.sub(lambda found: f"\\u{ord(found.group()):04x}", text)
