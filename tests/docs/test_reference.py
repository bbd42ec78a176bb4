"""Every public name stands on a page of the Python reference, and says its units and errors."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import articad

PAGES = "\n".join(page.read_text() for page in sorted((Path(__file__).resolve().parents[2] / "docs" / "reference").glob("python-*.md")))
NAMES = [name for name in articad.__all__ if not name.startswith("__")]
# Words that state the unit of a number, or that it is a ratio, a direction or a transformation.
UNIT = re.compile(r"\[|\bmm\b|\brad\b|\bkg\b|pixels|share|factor|\d\)|direction|seconds|fraction|quaternion|[mM]illimet", re.IGNORECASE)
DEFECTS = {"AttributeError", "AssertionError", "NotImplementedError", "TypeError"}  # raised by misuse, as Python itself does


def documented() -> dict[str, str | None]:
    """Return the modules of the pages with the members that are shown, None for all."""
    sections = re.findall(r"^::: (articad[\w.]*)\n((?:    .*\n)*)", PAGES, re.MULTILINE)
    shown = {module: re.search(r"members: \[(.*)\]", options) for module, options in sections}
    return {module: None if members is None else members[1] for module, members in shown.items()}


def functions(name: str) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Return a public function, or the public methods of a class."""
    target = getattr(articad, name)
    if inspect.isfunction(target):
        yield name, target
    elif inspect.isclass(target):
        for key, member in vars(target).items():
            function = member.fget if isinstance(member, property) else getattr(member, "__func__", getattr(member, "func", member))
            if not key.startswith("_") and inspect.isfunction(function):
                yield f"{name}.{key}", function


@pytest.mark.parametrize("name", NAMES)
def test_a_public_name_stands_in_the_reference(name: str) -> None:
    module = getattr(articad, name).__module__
    members = documented().get(module, "")
    assert members is None or name in members.split(", "), f"add {module}.{name} to a page docs/reference/python-*.md"


@pytest.mark.parametrize("name", NAMES)
def test_a_public_name_says_what_it_is_its_units_and_its_errors(name: str) -> None:
    assert inspect.getdoc(getattr(articad, name))
    for path, function in functions(name):
        text = inspect.getdoc(function) or ""
        assert text, path
        raised = {
            node.exc.func.id
            for node in ast.walk(ast.parse(textwrap.dedent(inspect.getsource(function))))
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call) and isinstance(node.exc.func, ast.Name)
        }
        assert [error for error in raised - DEFECTS if error not in text and not error.startswith("_")] == [], path
        for parameter in inspect.signature(function).parameters.values():
            if re.search(r"\bfloat\b|ArrayLike|FloatArray", str(parameter.annotation)):
                entry = re.search(rf"^ +\**{parameter.name}: .*(?:\n {{8,}}.*)*", text, re.MULTILINE)
                assert UNIT.search(entry[0] if entry else text), f"{path}: {parameter.name} has no unit"
