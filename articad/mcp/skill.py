"""The instructions for coding agents: one page that is installed as a skill, and handed out by sections."""

from __future__ import annotations

from pathlib import Path
from typing import Final

_FILE: Final = Path(__file__).with_name("SKILL.md")


def skill() -> str:
    """Return the whole text."""
    return _FILE.read_text(encoding="utf-8")


def section(title: str) -> str:
    """Return a section by the beginning of its heading.

    Raises:
        KeyError: If there is none.
    """
    for text in skill().split("\n## ")[1:]:
        if text.startswith(title):
            return f"## {text}"
    raise KeyError(title)
