"""Have a model design; make its run again without it."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import EXPORT, FORCE, JOBS, MODEL_ARGUMENTS, OUT, PICTURES, SANDBOX
from articad.commands.steps import build_cache, draw, reported, sandbox_level

if TYPE_CHECKING:
    from articad.terminal import Report, Terminal


@command(
    "generate",
    "Have a model write the plan and the part scripts of what you describe; then build, check and export it.",
    argument("text", metavar="TEXT", help="what is wanted"),
    *MODEL_ARGUMENTS,
    OUT,
    EXPORT,
    SANDBOX,
    JOBS,
    FORCE,
    PICTURES,
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
            sandbox=sandbox_level(options),
            cache=build_cache(options),
            formats=options.formats,
            repairs=options.repairs,
            rounds=options.rounds,
            jobs=options.jobs,
            progress=tell,
        )
    if options.pictures:
        draw(run)
    report = reported(run, terminal)
    price = "of unknown price" if budget.cost_unknown_of else f"${budget.cost:.4f}"
    terminal.say(f"Model: {budget.calls} calls, {budget.tokens} tokens, {price}.")
    return report | {"model": {"calls": budget.calls, "tokens": budget.tokens, "cost_usd": None if budget.cost_unknown_of else budget.cost}}


@command(
    "replay",
    "Make a recorded run again, without model or network, and compare.",
    argument("run", metavar="RUN"),
    OUT,
    argument("--strict", action="store_true", help="refuse a prompt that is not the recorded one, instead of reporting it"),
    SANDBOX,
    JOBS,
    FORCE,
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
            sandbox=sandbox_level(options),
            cache=build_cache(options),
            jobs=options.jobs,
            progress=tell,
        )
    report = reported(replayed.run, terminal)
    terminal.findings(replayed.findings)
    for name in replayed.differences:
        terminal.say(f"differs: {name}")
    verdict = "every file but the trace is equal" if replayed.ok else f"{len(replayed.differences)} files differ"
    terminal.say(f"Replay of {options.run}: {verdict}.")
    findings = [finding.to_json() for finding in replayed.findings]
    return report | {"ok": report["ok"] and replayed.ok, "differences": list(replayed.differences), "findings": findings}
