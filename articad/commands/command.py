"""The type of a command of the command line, and the register of all commands."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


class Command(NamedTuple):
    """A command: its summary, its arguments, and the function that runs it and returns its report."""

    name: str
    summary: str
    arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace, Terminal], Report]
    needs_libraries: bool


COMMANDS: dict[str, Command] = {}

_Argument = Callable[[argparse.ArgumentParser], None]
_Body = Callable[[argparse.Namespace, "Terminal"], "Report"]


def command(name: str, summary: str, *arguments: _Argument, needs_libraries: bool = True) -> Callable[[_Body], _Body]:
    """Register a function as a command; `needs_libraries=False` lets it run where system libraries are missing."""

    def add_all(parser: argparse.ArgumentParser) -> None:
        for add in arguments:
            add(parser)

    def register(run: _Body) -> _Body:
        COMMANDS[name] = Command(name, summary, add_all, run, needs_libraries)
        return run

    return register


def argument(*names: str, **options: Any) -> _Argument:
    """Return a function that adds this argument to a parser; several commands may share one."""

    def add(parser: argparse.ArgumentParser) -> None:
        parser.add_argument(*names, **options)

    return add


class Unnamed(str):
    """A folder that a command writes to unless the command line names another."""

    __slots__ = ()


def output_folder(flag: str, default: str, purpose: str) -> _Argument:
    """Return a function that adds the argument for the folder that a command writes to.

    Args:
        flag: `--out`.
        default: The folder if none is named. Where it leads out of the working folder, the command line has to name one.
        purpose: The help.
    """
    return argument(flag, metavar="DIR", default=Unnamed(default), help=f"{purpose} ({default})")


def closest(word: str, known: Iterable[str]) -> str:
    """Suggest the closest known word, as `articad.errors` does for names in plans, but with fewer imports."""
    close = difflib.get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f", did you mean {close[0]!r}?" if close else ""
