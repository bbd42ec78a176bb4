"""The command line: parse, call, print. One function per command; what a command needs is imported when it runs.

`articad --help` and `--version` load neither numpy nor rich. Exit codes: 0 ok, 1 findings, 2 usage, 3 cannot go on, 130 interrupted.
"""

from __future__ import annotations

import argparse
import contextlib
import difflib
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, NoReturn

from articad import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from articad.assembly import Assembly
    from articad.kernels.kernel import BuildCache
    from articad.plan.schema import AssemblyPlan
    from articad.run import Run
    from articad.terminal import Report, Terminal

OK: Final = 0
FINDINGS: Final = 1
USAGE: Final = 2
CANNOT_GO_ON: Final = 3
INTERRUPTED: Final = 130  # 128 + SIGINT, as shells count
_PATIENCE_S: Final = 1.0  # for other threads to notice that the program ends

_FORMATS: Final = (
    "urdf",
    "mjcf",
    "freecad",
    "step",
    "glb",
    "3mf",
    "sdf",
    "usd",
)  # the keys of `articad.record.WRITERS`, which --help must not load
_USUAL: Final = ("urdf", "mjcf")


class _Command(NamedTuple):
    """A command: what it says of itself, its arguments, and what runs it and returns its report."""

    name: str
    summary: str
    arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace, Terminal], Report]
    needs_libraries: bool


_COMMANDS: dict[str, _Command] = {}

_Body = Callable[[argparse.Namespace, "Terminal"], "Report"]


def _command(
    name: str, summary: str, *arguments: Callable[[argparse.ArgumentParser], None], needs_libraries: bool = True
) -> Callable[[_Body], _Body]:
    """Register a function as a command."""

    def add_all(parser: argparse.ArgumentParser) -> None:
        for add in arguments:
            add(parser)

    def register(run: _Body) -> _Body:
        _COMMANDS[name] = _Command(name, summary, add_all, run, needs_libraries)
        return run

    return register


# ---------------------------------------------------------------------- arguments


def _argument(*names: str, **options: Any) -> Callable[[argparse.ArgumentParser], None]:
    def add(parser: argparse.ArgumentParser) -> None:
        parser.add_argument(*names, **options)

    return add


def _formats(text: str) -> tuple[str, ...]:
    """Read `urdf,mjcf`."""
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    for name in names:
        if name not in _FORMATS:
            raise argparse.ArgumentTypeError(f"unknown format {name!r}{_closest(name, _FORMATS)}; there are {', '.join(_FORMATS)}")
    return names


def _assignment(text: str) -> tuple[str, str]:
    """Read `NAME=VALUE`."""
    name, sign, value = text.partition("=")
    if not (sign and name and value):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form NAME=VALUE")
    return name, value


def _parameter(text: str) -> tuple[str, float]:
    """Read `NAME=NUMBER`."""
    name, value = _assignment(text)
    try:
        return name, float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{value!r} in {text!r} is not a number") from None


def _names(text: str) -> tuple[str, ...]:
    """Read `a,b`."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _amount(text: str) -> float:
    """Read a positive number."""
    try:
        amount = float(text)
    except ValueError:
        amount = 0.0
    if not 0 < amount < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return amount


def _positive(text: str) -> int:
    """Read a whole number of at least 1."""
    if not (text.isdecimal() and int(text) >= 1):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of at least 1")
    return int(text)


_OUT = _argument("--out", metavar="DIR", help="where to write; by default a new folder under runs/")
_SANDBOX = _argument(
    "--sandbox", choices=["strict", "weak"], default=None, help="weak runs part scripts with less isolation than landlock or bwrap"
)
_JOBS = _argument("--jobs", metavar="N", type=_positive, default=None, help="parts built at once (all processors)")
_FORCE = _argument("--force", action="store_true", help="build every part anew, whatever the cache holds")
_EXPORT = _argument("--export", metavar="FORMATS", dest="formats", type=_formats, default=_USUAL, help="formats to write (urdf,mjcf)")
_SANDBOX = _argument(
    "--sandbox", choices=["strict", "weak"], default=None, help="weak runs part scripts with less isolation than landlock or bwrap"
)
_PICTURES = _argument("--no-pictures", dest="pictures", action="store_false", help="draw neither parts nor motion")
_BUILD_ARGUMENTS = (
    _OUT,
    _argument("--kernel", choices=["build123d", "freecad"], default=None, help="what builds part scripts (the plan's own choice)"),
    _argument("--set", metavar="NAME=VALUE", dest="parameters", type=_parameter, action="append", default=[], help="replace a parameter"),
    _argument("--verify", choices=["rest", "sampled", "certified"], default="rest", help="how much motion is checked (rest)"),
    _EXPORT,
    _SANDBOX,
    _JOBS,
    _FORCE,
    _PICTURES,
)
_MODEL_ARGUMENTS = (
    _argument("--image", metavar="FILE", dest="images", action="append", default=[], help="a picture that belongs to the request"),
    _argument("--part-image", metavar="NAME=FILE", dest="part_images", type=_assignment, action="append", default=[], help="of one part"),
    _argument("--model", metavar="NAME", required=True, help="the model that writes plans and scripts, as LiteLLM names it"),
    _argument("--vision-model", metavar="NAME", help="the model that looks at pictures (the same)"),
    _argument("--api-base", metavar="URL", help="an OpenAI-compatible endpoint"),
    _argument("--rounds", metavar="N", type=_positive, default=3, help="designs that are built and checked (3)"),
    _argument("--repairs", metavar="N", type=_positive, default=3, help="attempts to mend one part (3)"),
    _argument("--max-calls", metavar="N", type=_positive, default=60, help="model calls (60)"),
    _argument("--max-cost", metavar="USD", type=_amount, default=None, help="cost of all calls (unlimited)"),
    _argument("--max-minutes", metavar="N", type=_amount, default=60.0, help="wall clock (60)"),
)


# ---------------------------------------------------------------------- commands


@_command("build", "Build a plan's parts, assemble, check and export them.", _argument("plan", metavar="PLAN_DIR"), *_BUILD_ARGUMENTS)
def _build(options: argparse.Namespace, terminal: Terminal) -> Report:
    from pathlib import Path

    from articad.plan.schema import AssemblyPlan
    from articad.record import record_assembly, record_certificate, record_checks, record_export, record_pictures
    from articad.run import RunRequest, open_or_create

    plan = AssemblyPlan.load(options.plan)
    folder = Path(options.plan)
    scripts = (folder if folder.is_dir() else folder.parent) / "parts"
    choices = {"task": "build", "kernel": options.kernel or plan.kernel, "parameters": dict(options.parameters)}
    assembly = _assembled(plan, scripts, options, terminal)
    with open_or_create(RunRequest(prompt=plan.name, options=choices), options.out) as run:
        run.save_plan(plan.dumps(), 0)
        record_assembly(run, assembly)
        record_checks(run, assembly.check() + assembly.sweep() if options.verify == "sampled" else assembly.check())
        if options.verify == "certified":
            record_certificate(run, assembly.certify())
        for name in options.formats:
            record_export(run, assembly, name)
        if options.pictures:
            record_pictures(run, assembly)
    return _reported(run, terminal)


@_command("check", "Check a plan, or the plan and the geometry of a finished run.", _argument("target", metavar="PLAN_DIR|RUN|FILE"))
def _check(options: argparse.Namespace, terminal: Terminal) -> Report:
    from pathlib import Path

    from articad import summaries
    from articad.errors import PlanError
    from articad.plan.check import check_plan
    from articad.plan.schema import AssemblyPlan

    try:
        plan = AssemblyPlan.load(options.target)
    except PlanError as error:  # what is wrong with a plan is what this command is asked for
        if not error.findings:
            raise
        name, findings = str(options.target), error.findings
    else:
        name, findings = plan.name, check_plan(plan)
    terminal.findings(findings)
    terminal.say(f"{name}: {summaries.counted(findings)}.")
    if not findings.ok or not (Path(options.target) / "request.json").is_file():
        return findings.to_json()

    from articad.record import assembly_of
    from articad.run import Run

    with Run.view(options.target) as run, terminal.progress("Reading") as tell:
        checks = assembly_of(run, progress=tell).check()
    terminal.findings(checks.findings)
    report = checks.to_json()
    summaries.print_checks(report, terminal)
    return report


@_command(
    "certify",
    "Prove that a run's parts do not meet while its joints move over their whole ranges.",
    _argument("run", metavar="RUN"),
    _argument("--joints", metavar="A,B", type=_names, default=None, help="those to be proven (all that move)"),
    _argument("--pairs", action=argparse.BooleanOptionalAction, default=True, help="move joints two at a time as well (yes)"),
    _argument(
        "--budget", metavar="SECONDS", type=_amount, default=600.0, help="what is not proven by then is not checked, which is not ok (600)"
    ),
    _argument("--epsilon", metavar="MM", type=_amount, default=0.001, help="distances up to here are contact (0.001)"),
)
def _certify(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad import summaries
    from articad.record import assembly_of, record_certificate
    from articad.run import Run

    with Run.open(options.run) as run:
        with terminal.progress("Reading") as tell:
            assembly = assembly_of(run, progress=tell)
        certificate = assembly.certify(options.joints, pairs=options.pairs, budget=options.budget, epsilon=options.epsilon)
        report = record_certificate(run, certificate)
        summaries.print_certificate(report, terminal)
        terminal.say(f"Certificate: {run.path / 'certificate.json'}, {len(certificate.claims)} claims")
    return report


@_command(
    "verify-certificate",
    "Check a certificate without trusting whoever wrote it.",
    _argument("file", metavar="FILE", help="certificate.json"),
    _argument("--meshes", metavar="DIR", help="the meshes it is about, <part>.npz (the folder certificate/ beside it)"),
)
def _verify_certificate(options: argparse.Namespace, terminal: Terminal) -> Report:
    from pathlib import Path

    from articad.verify_certificate import verify_file

    file = Path(options.file)
    faults = verify_file(file, Path(options.meshes) if options.meshes else file.parent / "certificate")
    for fault in faults:
        terminal.say(f"  {fault}")
    terminal.say(f"{file}: {'refuted' if faults else 'accepted'}.")
    return {"schema": "articad.verification/1", "ok": not faults, "file": str(file), "faults": faults, "findings": []}


@_command(
    "export",
    "Write a finished run in other formats.",
    _argument("run", metavar="RUN"),
    _argument("--to", metavar="FORMATS", dest="formats", type=_formats, required=True, help=f"formats to write, of {', '.join(_FORMATS)}"),
    _argument("--out", metavar="DIR", help="where to write, a folder for each format; by default RUN/export"),
    _argument("--strict", action="store_true", help="refuse what a format cannot hold, instead of reporting it as lost"),
    _argument("--loops", choices=["none", "isaac", "drake", "mimic"], default="none", help="how URDF closes loops (none)"),
)
def _export(options: argparse.Namespace, terminal: Terminal) -> Report:
    from pathlib import Path

    from articad import summaries
    from articad.record import assembly_of, record_export, written
    from articad.run import Run

    with Run.view(options.run) as run, terminal.progress("Reading") as tell:
        assembly = assembly_of(run, progress=tell)
    exports: dict[str, Report] = {}
    if options.out is None:
        with Run.open(options.run) as run:
            exports = {name: record_export(run, assembly, name, strict=options.strict, loops=options.loops) for name in options.formats}
    else:
        for name in options.formats:
            bundle = written(assembly, name, strict=options.strict, loops=options.loops)
            main = bundle.write(Path(options.out) / name)[0]
            exports[name] = bundle.to_json() | {"folder": str(main.parent), "main": str(main)}
    summaries.print_exports(exports, terminal)
    return {"schema": "articad.exports/1", "ok": all(export["ok"] for export in exports.values()), "exports": exports, "findings": []}


@_command(
    "generate",
    "Have a model write the plan and the part scripts of what you describe; then build, check and export it.",
    _argument("text", metavar="TEXT", help="what is wanted"),
    *_MODEL_ARGUMENTS,
    _OUT,
    _EXPORT,
    _SANDBOX,
    _JOBS,
    _FORCE,
    _PICTURES,
)
def _generate(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.agents.live import LiteLLM
    from articad.agents.llm import Budget
    from articad.agents.pipeline import generate

    model = LiteLLM(options.model, api_base=options.api_base, vision_model=options.vision_model)
    budget = Budget(model, calls=options.max_calls, cost=options.max_cost, minutes=options.max_minutes)
    with terminal.progress("Generating") as tell:
        run = generate(
            options.text,
            llm=budget,
            images=options.images,
            part_images=dict(options.part_images),
            out=options.out,
            sandbox=_sandbox(options),
            cache=_cache(options),
            formats=options.formats,
            repairs=options.repairs,
            rounds=options.rounds,
            jobs=options.jobs,
            progress=tell,
        )
    if options.pictures:
        _draw(run)
    report = _reported(run, terminal)
    price = "of unknown price" if budget.cost_unknown_of else f"${budget.cost:.4f}"
    terminal.say(f"Model: {budget.calls} calls, {budget.tokens} tokens, {price}.")
    return report | {"model": {"calls": budget.calls, "tokens": budget.tokens, "cost_usd": None if budget.cost_unknown_of else budget.cost}}


@_command(
    "replay",
    "Make a recorded run again, without model or network, and compare.",
    _argument("run", metavar="RUN"),
    _OUT,
    _argument("--strict", action="store_true", help="refuse a prompt that is not the recorded one, instead of reporting it"),
    _SANDBOX,
    _JOBS,
    _FORCE,
)
def _replay(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.agents.pipeline import replay
    from articad.errors import ReadError
    from articad.run import Run

    if not Run.view(options.run).replies():
        raise ReadError(
            f"{options.run} holds no answers of a model, so there is nothing to replay. Use `articad build` on its plan.", path=options.run
        )
    with terminal.progress("Replaying") as tell:
        replayed = replay(
            options.run,
            out=options.out,
            strict=options.strict,
            sandbox=_sandbox(options),
            cache=_cache(options),
            jobs=options.jobs,
            progress=tell,
        )
    report = _reported(replayed.run, terminal)
    terminal.findings(replayed.findings)
    for name in replayed.differences:
        terminal.say(f"differs: {name}")
    verdict = "every file but the trace is equal" if replayed.ok else f"{len(replayed.differences)} files differ"
    terminal.say(f"Replay of {options.run}: {verdict}.")
    findings = [finding.to_json() for finding in replayed.findings]
    return report | {"ok": report["ok"] and replayed.ok, "differences": list(replayed.differences), "findings": findings}


@_command(
    "render",
    "Draw a run or a plan from several sides, or a joint's motion.",
    _argument("target", metavar="RUN|PLAN_DIR"),
    _argument("--views", metavar="VIEWS", default="iso,front,right,top", help="views, each a picture (iso,front,right,top)"),
    _argument("--motion", metavar="JOINT", help="draw this joint's motion instead, as a filmstrip and an animation"),
    _argument("--parts", metavar="NAMES", help="parts shown in full; the others are faded"),
    _argument("--section", metavar="AXIS[=MM]", help="cut away what lies beyond x, y or z (such as -y=12.5)"),
    _argument(
        "--explode", metavar="SHARE", type=float, default=0.0, help="move parts apart by this share of their distance from the middle"
    ),
    _argument("--overlaps", action="store_true", help="draw what parts have in common in red, over everything"),
    _argument("--size", metavar="PIXELS", type=_positive, default=512, help="width and height of a picture (512)"),
    _argument("--renderer", choices=["embree", "pyvista"], default="embree", help="pyvista is smoother, where OpenGL can be had"),
    _argument("--out", metavar="DIR", default="pictures", help="where to write (pictures)"),
    _SANDBOX,
)
def _render(options: argparse.Namespace, terminal: Terminal) -> Report:
    from pathlib import Path

    from articad.render.files import write_motion, write_views

    assembly = _loaded(options.target, options, terminal)
    out = Path(options.out)
    if options.motion:
        files = write_motion(assembly, options.motion, out, size=options.size)
    else:
        only = options.parts.split(",") if options.parts else None
        files = write_views(
            assembly,
            [view for view in options.views.split(",") if view],
            out,
            size=options.size,
            only=only,
            section=options.section,
            explode=options.explode,
            renderer=options.renderer,
            show_overlaps=options.overlaps,
        )
    for file in files:
        terminal.say(str(file))
    return {"schema": "articad.pictures/1", "ok": True, "files": [str(file) for file in files], "findings": []}


@_command(
    "convert",
    "Convert a URDF or MJCF file into another format.",
    _argument("source", metavar="IN", help="a .urdf or .xml file"),
    _argument("target", metavar="OUT", help="its ending says the format: .urdf .xml .sdf .usda .step .glb .3mf"),
    _argument("--strict", action="store_true", help="refuse what the format cannot hold, instead of reporting it as lost"),
)
def _convert(options: argparse.Namespace, terminal: Terminal) -> Report:
    from dataclasses import replace
    from pathlib import Path

    from articad import summaries
    from articad.convert import FORMAT_OF, convert

    target = Path(options.target)
    assembly, bundle = convert(options.source, target, strict=options.strict)
    bundle = replace(bundle, files={target.name if path == bundle.main else path: content for path, content in bundle.files.items()})
    bundle.write(target.parent)
    report = bundle.to_json() | {"folder": str(target.parent), "main": str(target)}
    terminal.findings(assembly.findings + bundle.findings)
    summaries.print_exports({FORMAT_OF[target.suffix.lower()]: report}, terminal)
    return report | {"findings": [finding.to_json() for finding in assembly.findings + bundle.findings]}


@_command(
    "doctor",
    "Say what this machine has and lacks.",
    _argument("--model", metavar="NAME", help="ask this model one tiny question"),
    _argument("--api-base", metavar="URL", help="an OpenAI-compatible endpoint"),
    needs_libraries=False,
)
def _doctor(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad import doctor

    missing = doctor.missing_libraries()
    items = doctor.examine()
    if options.model and not missing:
        from articad.agents.live import LiteLLM

        items = (*items, doctor.ask_once(LiteLLM(options.model, api_base=options.api_base)))
    terminal.say(f"articad {__version__}")
    terminal.table(["", "what", "found"], [(item.status, item.name, item.detail) for item in items])
    for item in items:
        if item.remedy and item.status == "missing":
            terminal.say(f"{item.name}: {item.remedy}")
    report = doctor.report(items)
    if missing:
        error = doctor.unavailable(missing)
        terminal.say(error.message)
        terminal.findings(error.findings)
        report |= {"error": terminal.described(error), "findings": [finding.to_json() for finding in error.findings]}
    return report


# ---------------------------------------------------------------------- steps that commands share


def _assembled(plan: AssemblyPlan, scripts: Path, options: argparse.Namespace, terminal: Terminal) -> Assembly:
    """Build the parts with progress, and assemble them."""
    from articad.assembly import Assembly
    from articad.record import kernel_named

    with terminal.progress("Building", total=len(plan.parts)) as tell:
        return Assembly.from_plan(
            plan,
            scripts,
            kernel=kernel_named(options.kernel or plan.kernel, sandbox=_sandbox(options)),
            jobs=options.jobs,
            cache=_cache(options),
            progress=tell,
            parameters=dict(options.parameters),
        )


def _reported(run: Run, terminal: Terminal) -> Report:
    """Print what a finished run holds, and return its report."""
    from articad.record import run_report
    from articad.summaries import print_run

    report = run_report(run)
    print_run(report, terminal)
    return report


def _cache(options: argparse.Namespace) -> BuildCache:
    """Return the user's cache of parts, or with --force an empty one."""
    from articad.kernels.kernel import BuildCache

    return BuildCache(None) if options.force else BuildCache()


def _loaded(target: str, options: argparse.Namespace, terminal: Terminal) -> Assembly:
    """Return the assembly of a run or of a plan with its part scripts; what the cache holds is not built again."""
    from pathlib import Path

    from articad.assembly import Assembly
    from articad.plan.schema import AssemblyPlan
    from articad.record import assembly_of, kernel_named
    from articad.run import Run

    if (Path(target) / "request.json").is_file():
        with Run.view(target) as run, terminal.progress("Reading") as tell:
            return assembly_of(run, progress=tell)
    plan = AssemblyPlan.load(target)
    folder = Path(target) if Path(target).is_dir() else Path(target).parent
    with terminal.progress("Building", total=len(plan.parts)) as tell:
        return Assembly.from_plan(plan, folder / "parts", kernel=kernel_named(plan.kernel, sandbox=_sandbox(options)), progress=tell)


def _draw(run: Run) -> None:
    """Draw what a finished run has made; its parts come from the cache."""
    from articad.record import assembly_of, record_pictures
    from articad.run import Run

    with Run.open(run.path) as opened:
        record_pictures(opened, assembly_of(opened))


def _sandbox(options: argparse.Namespace) -> Literal["strict", "weak"]:
    """Return how much isolation is asked for: by the flag, else by $ARTICAD_SANDBOX."""
    return "weak" if (options.sandbox or os.environ.get("ARTICAD_SANDBOX")) == "weak" else "strict"


# ---------------------------------------------------------------------- the frame


class _Parser(argparse.ArgumentParser):
    """A parser that says which word may have been meant."""

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = [str(choice) for choice in action.choices]
            what = "command" if action.dest == "command" else "value"
            raise argparse.ArgumentError(action, f"unknown {what} {value!r}{_closest(str(value), known)}; there are {', '.join(known)}")

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(USAGE, f"articad: {message}\n")


def _parser() -> _Parser:
    """Return the parser of the whole command line; the global flags may stand before or after the command."""
    parser = _Parser(prog="articad", description="Editable, articulated CAD assemblies from text, images or a plan.", allow_abbrev=False)
    parser.add_argument("--version", action="version", version=f"articad {__version__}")
    _add_global_flags(parser, default=False)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", parser_class=_Parser)
    for command in _COMMANDS.values():
        sub = commands.add_parser(command.name, help=command.summary, description=command.summary, allow_abbrev=False)
        command.arguments(sub)
        _add_global_flags(sub, default=argparse.SUPPRESS)  # else the default would undo a flag given before the command
    return parser


def _add_global_flags(parser: argparse.ArgumentParser, *, default: Any) -> None:
    flags = parser.add_argument_group("output")
    flags.add_argument("--json", dest="as_json", action="store_true", default=default, help="one report on stdout, nothing else")
    flags.add_argument("-q", "--quiet", action="store_true", default=default, help="findings and errors only")
    flags.add_argument("-v", "--verbose", action="store_true", default=default, help="details, and tracebacks of defects")
    flags.add_argument("--no-color", dest="colorless", action="store_true", default=default, help="no colour, no moving bars")


def _parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Parse, or end with exit code 2 and a word that may have been meant."""
    parser = _parser()
    options, unknown = parser.parse_known_args(arguments)
    if options.command is None and not unknown:
        parser.print_help(sys.stderr)
        parser.exit(USAGE)
    if unknown:
        flags = _flags_of(parser, options.command)
        word = next((word.partition("=")[0] for word in unknown if word.startswith("-")), unknown[0])
        parser.error(f"unknown argument {word!r}{_closest(word, flags) if word.startswith('-') else ''}")
    return options


def _flags_of(parser: argparse.ArgumentParser, command: str | None) -> list[str]:
    known = parser
    for action in parser._actions:  # noqa: SLF001 - argparse keeps its list of flags nowhere else
        if isinstance(action, argparse._SubParsersAction) and command is not None:  # noqa: SLF001
            known = action.choices[command]
    return [flag for action in known._actions for flag in action.option_strings]  # noqa: SLF001


def _closest(word: str, known: Iterable[str]) -> str:
    """Say which known word is close. (`articad.errors` has the same for names in plans, at the price of its imports)."""
    close = difflib.get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f", did you mean {close[0]!r}?" if close else ""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code.

    Args:
        arguments: Without the program's name; those of the process by default.
    """
    options = _parsed(arguments)

    from articad.terminal import Terminal

    terminal = Terminal(as_json=options.as_json, quiet=options.quiet, verbose=options.verbose, color=not options.colorless)
    try:
        with _prompt_interrupts(terminal):
            return _run(_COMMANDS[options.command], options, terminal)
    except BrokenPipeError:  # the reader of our output went away, as `head` does: nothing is left to be said, at exit neither
        with contextlib.suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return CANNOT_GO_ON


@contextlib.contextmanager
def _prompt_interrupts(terminal: Terminal) -> Iterator[None]:
    """Make the first Ctrl-C end the program soon, even where threads wait for a part script or a model.

    Python raises KeyboardInterrupt in the main thread, which then waits for the others. What was finished is on the disk,
    whole, and the kernel's processes die with this one, so there is nothing to wait for.
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


def _run(command: _Command, options: argparse.Namespace, terminal: Terminal) -> int:
    from articad.doctor import require_libraries
    from articad.errors import ArticadError

    try:
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
        terminal.failure(error, f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}.")
        return CANNOT_GO_ON
    except Exception as error:  # noqa: BLE001 - no traceback reaches a user who did not ask for one
        more = "" if terminal.verbose else " Run it again with -v for the traceback."
        terminal.failure(error, f"this is a defect of articad, please report it: {type(error).__name__}: {error}.{more}")
        return CANNOT_GO_ON
    if "error" in report:
        return CANNOT_GO_ON
    return OK if report["ok"] else FINDINGS


if __name__ == "__main__":
    sys.exit(main())
