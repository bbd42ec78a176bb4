"""The prompts, one Markdown file per role: code that a model runs, versioned and tested like code."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from typing import Final

_BLANK: Final = re.compile(r"\{\{(\w+)\}\}")


@cache
def prompt_file(name: str) -> str:
    """Return the text of a file in this folder."""
    return (files(__name__) / name).read_text("utf-8").strip()


def prompt_section(name: str, first: str, after: str) -> str:
    """Return the text of a file from one heading up to another: rules that several roles share are written once."""
    text = prompt_file(name)
    start = text.index(first)
    return text[start : text.index(after, start)].strip()


def prompt(name: str, **values: str) -> str:
    """Return the prompt `<name>.md` with its blanks `{{…}}` filled; what is filled in is never read for blanks.

    Raises:
        KeyError: If a blank has no value.
    """
    return _BLANK.sub(lambda blank: values[blank[1]], prompt_file(f"{name}.md"))
