"""What a command of the command line is, and the register that holds them all."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


class Command(NamedTuple):
    """A command: what it says of itself, its arguments, and what runs it and returns its report."""

    name: str
    summary: str
    arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace, Terminal], Report]
    needs_libraries: bool


COMMANDS: dict[str, Command] = {}

_Argument = Callable[[argparse.ArgumentParser], None]
_Body = Callable[[argparse.Namespace, "Terminal"], "Report"]


def command(name: str, summary: str, *arguments: _Argument, needs_libraries: bool = True) -> Callable[[_Body], _Body]:
    """Register a function as a command; one that does not need the system's libraries runs where they are missing."""

    def add_all(parser: argparse.ArgumentParser) -> None:
        for add in arguments:
            add(parser)

    def register(run: _Body) -> _Body:
        COMMANDS[name] = Command(name, summary, add_all, run, needs_libraries)
        return run

    return register


def argument(*names: str, **options: Any) -> _Argument:
    """Return what adds this argument to a parser; several commands may share one."""

    def add(parser: argparse.ArgumentParser) -> None:
        parser.add_argument(*names, **options)

    return add


def closest(word: str, known: Iterable[str]) -> str:
    """Say which known word is close. (`articad.errors` has the same for names in plans, at the price of its imports)."""
    close = difflib.get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f", did you mean {close[0]!r}?" if close else ""
