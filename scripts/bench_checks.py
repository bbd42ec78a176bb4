"""The page of the benchmark's checks, from their docstrings and the tasks; `scripts/tables.py` writes it."""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Iterator
from itertools import groupby
from typing import Any, Final, get_args

from articad_bench.check import Check
from articad_bench.checks import AnyCheck
from articad_bench.task import TASKS, tasks_in

LONGEST: Final = 400  # characters of an example
TITLES: Final = {
    "checks": "Parts, joints and motion",
    "path_checks": "Paths",
    "gear_checks": "Gears",
    "edit_checks": "Edits",
    "shape_checks": "Shapes",
    "likeness_checks": "Likeness to a picture",
    "outline_checks": "Outlines",
    "whole_checks": "The whole",
    "spacing_checks": "Distances",
    "function_checks": "What it does",
    "strength_checks": "Strength",
    "stack_checks": "Stacks of tolerances",
    "machined_checks": "Machined parts",
    "module_checks": "Repeated parts",
    "room_checks": "Weight and room",
    "section_checks": "Sections",
}
KINDS: Final[tuple[type[Check], ...]] = get_args(get_args(AnyCheck)[0])


def page(note: str) -> str:
    """Return the page.

    Args:
        note: Says who writes it.
    """
    examples = dict(_examples())
    lines = [
        "# Checks of the benchmark",
        "",
        note,
        "A task states in numbers what must hold: each row of its `checks` has a `kind` and the fields of that kind. A pair of numbers is a range; 999 is no limit; `joint` names joints by",
        "type, axis at rest and range, never by a name. [The how-to](../how-to/benchmark.md) says how to write tasks and what all of them have in common.",
    ]
    by_module = sorted(KINDS, key=lambda kind: list(TITLES).index(_module(kind)))
    for module, kinds in groupby(by_module, key=_module):
        lines += ["", f"## {TITLES[module]}"]
        for kind in kinds:
            name = kind.model_fields["kind"].default
            lines += ["", f"### {name}", "", *_about(kind)]
            if name in examples:
                lines += ["", "```json", examples[name], "```"]
    return "\n".join(lines) + "\n"


def _module(kind: type[Check]) -> str:
    return kind.__module__.rpartition(".")[2]


def _about(kind: type[Check]) -> list[str]:
    """Return what the docstrings of a kind and of its own bases say: their text, and a line for each attribute."""
    texts, rows = [], []
    for each in kind.__mro__:
        if issubclass(each, Check) and each is not Check and "__doc__" in vars(each):
            text, _, attributes = inspect.cleandoc(each.__doc__ or "").partition("Attributes:\n")
            before, _, after = attributes.partition("\n\n")
            texts += [paragraph for paragraph in re.split(r"\n\s*\n", f"{text.strip()}\n\n{inspect.cleandoc(after)}") if paragraph.strip()]
            rows += [" ".join(row.split()) for row in re.split(r"\n(?=    \w+: )", f"\n{before}") if row.strip()]
    fields = [f"- `{name}`: {text}" for name, text in (row.split(": ", 1) for row in rows)]
    return ["\n\n".join(texts), *([""] if fields else []), *fields]


def _examples() -> Iterator[tuple[str, str]]:
    """Yield each kind of check with a row of a task that shows what it can say: the shortest of those with the most fields."""
    rows: dict[str, set[str]] = {}
    for folder, _ in tasks_in(TASKS):
        stored: dict[str, Any] = json.loads((folder / "task.json").read_text(encoding="utf-8"))
        for checks in (stored["checks"], *(edit["checks"] for edit in stored.get("edits", ()))):
            for row in checks:
                rows.setdefault(row["kind"], set()).add(json.dumps(row, ensure_ascii=False))
    for kind, texts in rows.items():
        if short := [text for text in texts if len(text) <= LONGEST]:
            yield kind, min(short, key=lambda text: (-len(json.loads(text)), len(text), text))
