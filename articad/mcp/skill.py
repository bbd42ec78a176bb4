"""The instructions for coding agents: a skill of one page, and pages behind it that are read on demand."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from articad.errors import ReadError, did_you_mean
from articad.plan.notation import TYPES, described

_SKILL: Final = Path(__file__).with_name("SKILL.md")
_TOPICS: Final = Path(__file__).with_name("TOPICS.md")


def skill() -> str:
    """Return the whole page."""
    return _SKILL.read_text(encoding="utf-8")


def topics() -> dict[str, str]:
    """Return the pages behind the skill, by name."""
    sections = _TOPICS.read_text(encoding="utf-8").split("\n## ")[1:]
    return {name: text.strip() for name, _, text in (section.partition("\n") for section in sections)}


def page(topic: str) -> str:
    """Return a page of the skill, or the fields of the plan's types that a name stands for.

    Raises:
        ReadError: If there is neither.
    """
    pages = topics()
    if topic in pages:
        return pages[topic]
    fields = described(topic)
    if fields is None:
        known = [*TYPES, *pages]
        raise ReadError.at(topic, f"There is no type or page {topic!r}.{did_you_mean(topic, known)}", f"There are {', '.join(known)}.")
    return fields


def section(title: str) -> str:
    """Return a section of the skill by the beginning of its heading.

    Raises:
        KeyError: If there is none.
    """
    for text in skill().split("\n## ")[1:]:
        if text.startswith(title):
            return f"## {text}"
    raise KeyError(title)
