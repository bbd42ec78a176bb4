"""Signatures: the dimensions of a part that its script states as the arguments of a function with the part's name.

`def lid(width, board=12)` in `parts.py` builds the part `lid`: `width` is a parameter of the plan, `board` a dimension of the part alone. The
script is read, not run. A script that defines `build` has no such functions.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

from articad.aliases import Json
from articad.files import SCRIPT_BYTES, read_file

COMMON: Final = "parts.py"
"""The script of all parts that have none of their own."""
GIVEN: Final = "part"
"""The argument that receives the part itself."""


class Argument(NamedTuple):
    """An argument of a part's function.

    Attributes:
        name: Of the argument and of the dimension.
        required: Whether it has no default.
        default: A number, an expression, or something that is no dimension.
    """

    name: str
    required: bool
    default: Any = None


Functions = Mapping[str, tuple[Argument, ...]]


def names_for(part: str) -> tuple[str, ...]:
    """Return the names of functions that build a part, best first: its own, and its own without the last word, `hub` for `hub_l`."""
    stem = part.rpartition("_")[0]
    return (part, stem) if stem else (part,)


def functions_in(script: str | bytes) -> Functions:
    """Return the functions of a script by their names; none if it defines `build`, or is no Python."""
    try:
        tree = ast.parse(script)
    except (SyntaxError, ValueError, RecursionError, MemoryError):  # running it reports that
        return {}
    found: dict[str, tuple[Argument, ...]] = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            found[node.name] = tuple(_arguments(node.args))
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Name) and node.value.id in found:
            found |= {target.id: found[node.value.id] for target in node.targets if isinstance(target, ast.Name)}
    return {} if "build" in found else found


def functions_beside(plan: Path, parts: list[str]) -> Functions:
    """Return the functions that build parts of a plan: of the part's own script, else of `parts.py`.

    Args:
        plan: The plan's file; `parts.py` and the folder `parts` are beside it.
        parts: Names of parts.
    """
    common = functions_in(_read(plan.parent / COMMON, plan.parent))
    found: dict[str, tuple[Argument, ...]] = {}
    for part in parts:
        own = plan.parent / "parts" / f"{part}.py"
        held = functions_in(_read(own, plan.parent)) if own.is_file() else common
        name = next((name for name in names_for(part) if name in held), None)
        if name is not None:
            found[part] = held[name]
    return found


def with_arguments(part: Json, arguments: tuple[Argument, ...]) -> None:
    """Give a part of the plan the dimensions that its function takes and the part does not state."""
    held = part.setdefault("dimensions", {})
    if not isinstance(held, dict):
        return
    for name, required, default in arguments:
        is_number = isinstance(default, int | float | str) and not isinstance(default, bool)
        if name not in held and name != GIVEN and (required or is_number):
            held[name] = name if required else default


def _read(path: Path, root: Path) -> bytes:
    try:
        return read_file(path, SCRIPT_BYTES, root=root)
    except OSError:  # building reports what is wrong with it
        return b""


def _arguments(stated: ast.arguments) -> Iterator[Argument]:
    plain = [*stated.posonlyargs, *stated.args]
    defaults = [*[None] * (len(plain) - len(stated.defaults)), *stated.defaults, *stated.kw_defaults]
    for argument, default in zip([*plain, *stated.kwonlyargs], defaults, strict=True):
        if default is None:
            yield Argument(argument.arg, required=True)
            continue
        try:
            yield Argument(argument.arg, required=False, default=ast.literal_eval(default))
        except (ValueError, TypeError, SyntaxError, RecursionError, MemoryError):
            yield Argument(argument.arg, required=False)


__all__ = ["COMMON", "Argument", "Functions", "functions_beside", "functions_in", "names_for", "with_arguments"]
