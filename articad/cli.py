"""The command line: parse, call, print. The commands themselves are in `articad.commands`.

`articad --help` and `--version` load neither numpy nor rich. Exit codes: 0 ok, 1 findings, 2 usage, 3 cannot go on, 130 interrupted.
"""

from __future__ import annotations

import argparse
import codecs
import contextlib
import io
import json
import os
import signal
import sys
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NoReturn

from articad import __version__
from articad.commands.command import COMMANDS, Command, Unnamed, closest

if TYPE_CHECKING:
    from articad.commands.terminal import Terminal

OK: Final = 0
FINDINGS: Final = 1
USAGE: Final = 2
CANNOT_GO_ON: Final = 3
INTERRUPTED: Final = 130  # 128 + SIGINT, as shells count
_SPELLED: Final = "articad.spelled"
_PATIENCE_S: Final = 1.0  # for other threads to notice that the program ends


class _Parser(argparse.ArgumentParser):
    """A parser that says which word may have been meant."""

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = [str(choice) for choice in action.choices]
            what = "command" if action.dest == "command" else "value"
            raise argparse.ArgumentError(action, f"unknown {what} {value!r}{closest(str(value), known)}; there are {', '.join(known)}")

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(USAGE, f"articad: {message}\n")


def _parser() -> _Parser:
    """Return the parser of the whole command line; the global flags may stand before or after the command."""
    parser = _Parser(prog="articad", description="Editable, articulated CAD assemblies from text, images or a plan.", allow_abbrev=False)
    parser.add_argument("--version", action="version", version=f"articad {__version__}")
    _add_global_flags(parser, default=False)
    subparsers = parser.add_subparsers(title="commands", dest="command", metavar="COMMAND", parser_class=_Parser)
    for command in sorted(COMMANDS.values()):
        sub = subparsers.add_parser(command.name, help=command.summary, description=command.summary, allow_abbrev=False)
        command.arguments(sub)
        _add_global_flags(sub, default=argparse.SUPPRESS)  # else the default would undo a flag given before the command
    return parser


def _add_global_flags(parser: argparse.ArgumentParser, *, default: Any) -> None:
    flags = parser.add_argument_group("output")
    flags.add_argument("--json", dest="as_json", action="store_true", default=default, help="one report on stdout, nothing else")
    flags.add_argument("-q", "--quiet", action="store_true", default=default, help="findings and errors only")
    flags.add_argument("-v", "--verbose", action="store_true", default=default, help="details, and tracebacks of defects")
    flags.add_argument("--no-color", dest="colorless", action="store_true", default=default, help="no colour, no progress bars")


def _parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Parse the command line; on an error, exit with code 2 and suggest the closest known word."""
    parser = _parser()
    options, unknown = parser.parse_known_args(arguments)
    if options.command is None and not unknown:
        parser.print_help(sys.stderr)
        parser.exit(USAGE)
    if unknown:
        flags = _flags_of(parser, options.command)
        word = next((word.partition("=")[0] for word in unknown if word.startswith("-")), unknown[0])
        parser.error(f"unknown argument {word!r}{closest(word, flags) if word.startswith('-') else ''}")
    return options


def _flags_of(parser: argparse.ArgumentParser, command: str | None) -> list[str]:
    known = parser
    for action in parser._actions:  # noqa: SLF001 - argparse keeps its list of flags nowhere else
        if isinstance(action, argparse._SubParsersAction) and command is not None:  # noqa: SLF001
            known = action.choices[command]
    return [flag for action in known._actions for flag in action.option_strings]  # noqa: SLF001


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code.

    Args:
        arguments: Without the program's name; those of the process by default.
    """
    _open_streams()
    try:
        return _main(arguments)
    except KeyboardInterrupt:  # before there was a command to interrupt
        with contextlib.suppress(OSError):
            sys.stderr.write("articad: interrupted.\n")
        return INTERRUPTED


def _main(arguments: Sequence[str] | None) -> int:
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # more BLAS threads busy-wait: on busy processors 100 times as long
    options = _parsed(arguments)

    from articad.commands.terminal import Terminal
    from articad.processes.launcher import safe_path

    terminal = Terminal(as_json=options.as_json, quiet=options.quiet, verbose=options.verbose, color=not options.colorless)
    try:
        with _prompt_interrupts(terminal), safe_path():
            return _run(COMMANDS[options.command], options, terminal)
    except BrokenPipeError:  # the reader of our output went away, as `head` does
        _print_no_more()
    except OSError as error:  # nor could the error be printed: the disk of our output is full, for example
        with contextlib.suppress(OSError):
            terminal.err.write(f"articad: the output cannot be written: {error.strerror or error}.\n")
        _print_no_more()
    return CANNOT_GO_ON


def _open_streams() -> None:
    """Open what is closed of the standard streams, on nothing: else a file that is written gets its number, and what is printed lands in it."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest free number, which is this one
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, "r" if number == 0 else "w", encoding="utf-8", closefd=False))  # noqa: SIM115
    codecs.register_error(_SPELLED, _spelled)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_SPELLED)


def _spelled(error: UnicodeError) -> tuple[str, int]:
    """Return what is printed in place of characters that an output cannot encode, ASCII of a C locale for example: the same in JSON."""
    assert isinstance(error, UnicodeEncodeError)
    return json.dumps(error.object[error.start : error.end])[1:-1], error.end


def _print_no_more() -> None:
    """Let what is still to be printed go nowhere, also at exit."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextlib.contextmanager
def _prompt_interrupts(terminal: Terminal) -> Iterator[None]:
    """Make the first Ctrl-C end the program soon, even where threads wait for a part script or a model.

    Python raises KeyboardInterrupt in the main thread, which then waits for the others. Finished work is on disk and complete, and the
    kernel's processes die with this one, so there is nothing to wait for.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def leave() -> None:
        terminal.interrupted()
        os._exit(INTERRUPTED)

    def interrupt(_signal: int, _frame: object) -> None:
        timer = threading.Timer(_PATIENCE_S, leave)
        timer.daemon = True
        timer.start()
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _run(command: Command, options: argparse.Namespace, terminal: Terminal) -> int:
    from articad.commands.doctor import require_libraries
    from articad.errors import ArticadError
    from articad.processes import scratch

    scratch.sweep()
    try:
        for value in vars(options).values():
            if isinstance(value, Unnamed):
                scratch.require_own(Path(value))
        if command.needs_libraries:
            require_libraries()
        report = command.run(options, terminal)
        terminal.finish(report)
    except ArticadError as error:
        terminal.error(error)
        return CANNOT_GO_ON
    except KeyboardInterrupt:
        terminal.interrupted()
        return INTERRUPTED
    except BrokenPipeError:
        raise
    except OSError as error:
        terminal.failure(error, _refusal(error))
        return CANNOT_GO_ON
    except Exception as error:  # noqa: BLE001 - no traceback reaches a user who did not ask for one
        more = "" if terminal.verbose else " Run it again with -v for the traceback."
        terminal.failure(error, f"this is a defect of articad, please report it: {type(error).__name__}: {error}.{more}")
        return CANNOT_GO_ON
    if "error" in report:
        return CANNOT_GO_ON
    return OK if report["ok"] else FINDINGS


def _refusal(error: OSError) -> str:
    """Return what the system refused, where, and what would help."""
    try:
        Path.cwd()
    except FileNotFoundError:
        return "the current folder was removed. Change to another one."
    return f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}."


if __name__ == "__main__":
    sys.exit(main())
