"""Have a model design a product or change a design; repeat its run without it."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from articad.commands.command import argument, command
from articad.commands.options import (
    ANSWERING,
    BUDGET,
    EXPORT,
    FORCE,
    GENERATING,
    JOBS,
    MODELS,
    OUT,
    PICTURES,
    SANDBOX,
    SET,
    TEACHING,
    words,
)
from articad.commands.steps import build_cache, draw, experience, reported, sandbox_level

if TYPE_CHECKING:
    from articad.agents.brainstorm import Alternative, Choose
    from articad.agents.llm import Budget
    from articad.agents.settings import RunOptions, Services
    from articad.aliases import Progress
    from articad.commands.terminal import Report, Terminal
    from articad.memory.experience import ExperienceStore
    from articad.runs.run import Run


@command(
    "generate",
    "Let a model write the plan and the part scripts from your description; then build, check and export the product.",
    argument("text", metavar="TEXT", type=words, help="description of the product"),
    *ANSWERING,
    *GENERATING,
    OUT,
    EXPORT,
    SANDBOX,
    JOBS,
    FORCE,
    PICTURES,
)
def _generate(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.agents.pipeline import generate

    budget, sees = asked_model(options, terminal)
    store = experience(options, budget)
    with terminal.progress("Generating", note=lambda: _spent(budget)) as tell:
        run = generate(
            options.text,
            llm=budget,
            images=options.images,
            part_images=dict(options.part_images),
            out=options.out,
            options=_run_options(options, sees=sees),
            services=_services(options, terminal, tell, store),
        )
    return _told(run, options, terminal, budget)


@command(
    "edit",
    "Edit a finished run by a description or by parameter values, and prove that nothing else changed.",
    argument("run", metavar="RUN"),
    argument(
        "text",
        metavar="TEXT",
        type=words,
        nargs="?",
        default="",
        help="the change to make; without it, only --set applies and no model is called",
    ),
    SET,
    *ANSWERING,
    OUT,
    EXPORT,
    SANDBOX,
    JOBS,
    FORCE,
    PICTURES,
)
def _edit(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.agents.edit import edit
    from articad.runs.run import Run

    Run.view(options.run)  # fails before a key is required
    budget, sees = asked_model(options, terminal) if options.text.strip() else (None, False)
    with terminal.progress("Editing", note=None if budget is None else lambda: _spent(budget)) as tell:
        run = edit(
            options.run,
            options.text,
            llm=budget,
            values=dict(options.parameters),
            images=options.images,
            out=options.out,
            options=_run_options(options, sees=sees),
            services=_services(options, terminal, tell, experience(options, budget)),
        )
    return _told(run, options, terminal, budget)


@command(
    "resume",
    "Continue an interrupted run of generate or edit: no call is repeated, no part is built twice.",
    argument("run", metavar="RUN"),
    *MODELS,
    *TEACHING,
    *BUDGET,
    SANDBOX,
    JOBS,
    FORCE,
    PICTURES,
)
def _resume(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.agents.pipeline import resume
    from articad.errors import RunError
    from articad.runs.run import Run

    asked = Run.view(options.run).request.options
    if asked.get("task") == "build":
        message = f"{options.run} is a run of `articad build`, which calls no model: there are no calls to continue."
        raise RunError.at(options.run, message, f"Build it again: articad build PLAN_DIR --out {options.run}; built parts are kept.")
    options.look, options.inspection = bool(asked.get("look")), bool(asked.get("inspection"))
    budget, _ = asked_model(options, terminal)
    with terminal.progress("Resuming", note=lambda: _spent(budget)) as tell:
        run = resume(options.run, llm=budget, services=_services(options, terminal, tell, experience(options, budget)))
    return _told(run, options, terminal, budget)


def _run_options(options: argparse.Namespace, *, sees: bool) -> RunOptions:
    """Return how the run is made; a model that does not see neither looks nor inspects."""
    from articad.agents.settings import RunOptions

    stated = {name: value for name in ("ideas", "pick", "variant") if (value := getattr(options, name, None)) is not None}
    return RunOptions(
        formats=options.formats,
        repairs=options.repairs,
        rounds=options.rounds,
        look=sees and options.look,
        inspection=sees and options.inspection,
        review="none" if not options.review else "model" if sees else "rules",
        **stated,
    )


def _services(options: argparse.Namespace, terminal: Terminal, tell: Progress, store: ExperienceStore) -> Services:
    """Return what the run is given to work with."""
    from articad.agents.recollection import StoredDocumentation, StoredMemory
    from articad.agents.settings import Services
    from articad.kernels.choice import kernel_named

    sandbox, name = sandbox_level(options), getattr(options, "kernel", None)
    return Services(
        kernel=None if name is None else kernel_named(name, sandbox=sandbox),
        sandbox=sandbox,
        cache=build_cache(options),
        choose=_asking(terminal) if _is_asked(options) else None,
        memory=StoredMemory(store),
        documentation=StoredDocumentation() if options.docs else None,
        jobs=options.jobs,
        progress=tell,
    )


def asked_model(options: argparse.Namespace, terminal: Terminal) -> tuple[Budget, bool]:
    """Return the requested model, within its budget, and whether it accepts images."""
    from articad.agents.live import LiteLLM
    from articad.agents.llm import Budget

    name = model_name(options)
    model = LiteLLM(name, api_base=options.api_base, vision_model=options.vision_model, judge_model=options.judge_model)
    sees = bool(getattr(model, "sees", True))
    if not sees and (options.look or options.inspection or getattr(options, "review", False)):
        terminal.say(f"{options.vision_model or name} has no vision: only the exact checks judge parts and assembly.")
    return Budget(model, **limits(options)), sees


def limits(options: argparse.Namespace) -> dict[str, Any]:
    """Return the limits of a budget."""
    return {"calls": options.max_calls, "tokens": options.max_tokens, "cost": options.max_cost, "minutes": options.max_minutes}


def model_name(options: argparse.Namespace) -> str:
    """Return the name of the model: from the flag, else from $ARTICAD_MODEL, else the default."""
    from articad.agents.live import DEFAULT_MODEL

    return options.model or os.environ.get("ARTICAD_MODEL") or DEFAULT_MODEL


def _told(run: Run, options: argparse.Namespace, terminal: Terminal, budget: Budget | None) -> Report:
    """Remember a finished run that a model had a part in, draw it, print it and return its report."""
    from articad.agents.recollection import remember
    from articad.agents.settings import recalls
    from articad.commands.summaries import print_edit, print_review
    from articad.errors import BudgetError

    store = experience(options, budget)
    remembered = budget is not None and recalls(run.request.options.get("variant", "full"))
    try:
        if remembered and (case := remember(run, store)) is not None:
            terminal.detail(f"Stored as case {case.id[:8]}, {case.kind}, in {store.folder}.")
    except BudgetError as error:  # the run is finished; only the vectors of a provider are missing
        terminal.say(f"Not remembered: {error.spent}")
    if options.pictures:
        _draw(run, options, terminal)
    report = reported(run, terminal)
    if "edit" in report:
        print_edit(report["edit"], terminal)
    if "review" in report:
        print_review(report["review"], terminal)
    if budget is None:
        return report
    terminal.say(f"Model: {_spent(budget)}.")
    return report | {"model": {"calls": budget.calls, "tokens": budget.tokens, "cost_usd": None if budget.cost_unknown_of else budget.cost}}


def _draw(run: Run, options: argparse.Namespace, terminal: Terminal) -> None:
    """Write the page and the pictures of a finished run; its parts come from the cache."""
    from articad.kernels.kernel import BuildCache
    from articad.runs.record import assembly_of, record_page
    from articad.runs.run import Run

    cache = BuildCache()
    with Run.open(run.path) as opened:
        assembly = assembly_of(opened, cache=cache, sandbox=sandbox_level(options))
        record_page(opened, assembly)
        draw(opened, assembly, options, terminal, cache)


def _spent(budget: Budget) -> str:
    price = "of unknown price" if budget.cost_unknown_of else f"${budget.cost:.4f}"
    return f"{budget.calls} calls, {budget.tokens} tokens, {price}"


def _is_asked(options: argparse.Namespace) -> bool:
    """Return whether a person can be asked to choose."""
    return sys.stdin.isatty() and not options.as_json and not options.quiet


def _asking(terminal: Terminal) -> Choose:
    """Return a function that shows alternatives and asks which one to make; an empty answer is the first."""

    def choose(alternatives: Sequence[Alternative]) -> int:
        from articad.agents.brainstorm import structure

        terminal.say()
        for number, one in enumerate(alternatives, 1):
            terminal.say(f"{number}. {one.name}: {one.summary} {one.why} ({structure(one)})")
        while True:
            answer = input(f"Which one? [1-{len(alternatives)}, 1] ").strip() or "1"
            if answer.isdecimal() and 1 <= int(answer) <= len(alternatives):
                return int(answer)

    return choose


@command(
    "replay",
    "Repeat a recorded run without model or network, and compare the results.",
    argument("run", metavar="RUN"),
    OUT,
    argument("--strict", action="store_true", help="fail on a prompt that differs from the recorded one, instead of reporting it"),
    SANDBOX,
    JOBS,
    FORCE,
)
def _replay(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.agents.pipeline import replay
    from articad.agents.settings import Services
    from articad.errors import ReadError
    from articad.runs.run import Run

    recorded = Run.view(options.run)
    if not recorded.replies() and recorded.base() is None:
        raise ReadError(
            f"{options.run} holds no replies of a model, so there is nothing to replay. Use `articad build` on its plan.", path=options.run
        )
    with terminal.progress("Replaying") as tell:
        replayed = replay(
            options.run,
            out=options.out,
            strict=options.strict,
            services=Services(sandbox=sandbox_level(options), cache=build_cache(options), jobs=options.jobs, progress=tell),
        )
    report = reported(replayed.run, terminal)
    drifted = replayed.findings.of("I_PROMPT_DRIFT")
    for told in replayed.findings:
        if terminal.verbose or told not in drifted:
            terminal.finding(told.to_json())
    for name in replayed.results_that_differ:
        terminal.say(f"differs: {name}")
    if drifted:
        terminal.say(f"{len(drifted)} prompts differ from the recorded ones; the recorded replies were used (-v lists them).")
    different = len(replayed.results_that_differ)
    verdict = f"{different} files differ" if different else "every result is equal" if drifted else "every file except the trace is equal"
    terminal.say(f"Replay of {options.run}: {verdict}.")
    findings = [finding.to_json() for finding in replayed.findings]
    return report | {"ok": report["ok"] and replayed.ok, "differences": list(replayed.differences), "findings": findings}
