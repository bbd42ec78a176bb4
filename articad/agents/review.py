"""Review: how good a finished assembly is, by rules over the measurements and by a model that looks at all of it.

The scores are for people and for the store of experience; they decide nothing. Whether a run is a good case or a bad one depends on its
measured defects alone.
"""

from __future__ import annotations

import json
from typing import Any, Final

from pydantic import Field

from articad.agents.evidence import Evidence, told
from articad.agents.inspection import MOTIONS, asked_for, structure, wanted
from articad.agents.llm import LLM, Image, Reply, system, user
from articad.agents.part_group import sections
from articad.agents.pictures import assembly_picture, motion_picture, part_picture
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of
from articad.agents.requirements import Requirements
from articad.assembly import Assembly
from articad.errors import OutputError
from articad.runs.run import Run, RunRequest

SCHEMA: Final = "articad.review/1"
PARTS: Final = 8  # parts that a reviewer sees one by one; more pictures at once are not looked at closely
_STILL: Final = 5  # score for the motion of a product that has none


class Scored(ReplyForm):
    """A score from 1 to 5, and why."""

    score: int = Field(ge=1, le=5)
    reason: str


class Opinion(ReplyForm):
    """A reviewer's answer."""

    geometry: Scored
    detail: Scored
    motion: Scored
    lessons: tuple[str, ...]


def review(
    run: Run, assembly: Assembly, evidence: Evidence, request: RunRequest, requirements: Requirements | None, llm: LLM | None
) -> dict[str, Any]:
    """Return the report `articad.review/1` of a run whose assembly and checks are recorded.

    Args:
        run: The run.
        assembly: As built.
        evidence: The measurements.
        request: What the user asked for.
        requirements: The analysis of the request; None if there was none.
        llm: The model; None for rules alone. If its answers do not have the form, the rules alone count as well.
    """
    opinion = None if llm is None else _opinion(run, assembly, evidence, request, requirements, llm)
    scored = None if opinion is None else {name: getattr(opinion, name).model_dump() for name in ("geometry", "detail", "motion")}
    if scored is not None and not assembly.drivers:
        scored["motion"] = {"score": _STILL, "reason": "Nothing moves, and nothing is to move."}
    defects = [*evidence.findings.errors]
    return {
        "schema": SCHEMA,
        "ok": True,  # a review decides nothing; faults are in the checks and the verdict
        "findings": [],
        "kind": "issue" if defects or not (run.verdict() or {"ok": True})["ok"] else "good",
        "rules": scores(run),
        "model": scored,
        "lessons": [] if opinion is None else list(opinion.lessons),
        "defects": [str(finding) for finding in defects],
        "trajectory": trajectory(run),
    }


def trajectory(run: Run) -> dict[str, Any]:
    """Return how a run came to its end: answers of designers, rounds, and the answers about each part that has a script."""
    steps = run.replies()
    scripted = [name for name in run.part_names() if run.script(name) is not None]
    together = [sections(_said(run, step), scripted) for step in steps if step.startswith("parts/")]
    designs = [step for step in steps if step.split("/")[0] in {"design", "edit", "connect", "script"}]
    rounds = 1
    while run.round(rounds) is not None:
        rounds += 1
    alone = {name: sum(step.startswith(f"part/{name}/") for step in steps) for name in scripted}
    scripts = {name: count + sum(name in answers for answers in together) for name, count in alone.items()}
    return {"designs": len(designs), "rounds": rounds, "scripts": scripts}


def _said(run: Run, step: str) -> str:
    stored = run.reply(step)
    return "" if stored is None else Reply.from_json(stored.get("reply") or {}).text


def scores(run: Run) -> dict[str, float]:
    """Return the scores of a finished run by rules, each between 0 and 1.

    `geometric_fidelity` is the share of parts without a complaint by a check or an inspector; `kinematic_health` the share of checked
    pairs of parts that were found clear, at rest and in motion; `first_shot` the share of scripts whose first version kept their
    contract.
    """
    names = run.part_names()
    checks, verdict = run.checks() or {}, run.verdict() or {}
    findings = (*checks.get("findings", ()), *verdict.get("findings", ()))
    blamed = {part for finding in findings if finding["severity"] != "info" for part in finding.get("parts", ())}
    pairs = [pair["verdict"] for pair in checks.get("pairs", ())]
    scripts = [name for name in names if run.script(name) is not None]
    again = [name for name in scripts if run.attempt(name, 1) is not None]
    return {
        "geometric_fidelity": _share(len(set(names) - blamed), len(names)),
        "kinematic_health": _share(sum(verdict in {"clear", "contact"} for verdict in pairs), len(pairs)),
        "first_shot": _share(len(scripts) - len(again), len(scripts)),
    }


def _share(count: int, total: int) -> float:
    return round(count / total, 4) if total else 1.0


def _opinion(
    run: Run, assembly: Assembly, evidence: Evidence, request: RunRequest, requirements: Requirements | None, llm: LLM
) -> Opinion | None:
    asked = asked_for(request, requirements) if requirements is not None else f"The customer's request:\n\n{request.prompt}"
    way = json.dumps(trajectory(run))
    words = f"{asked}\n\n{structure(assembly)}\n\nMeasured:\n\n{told(assembly, evidence)}\n\nHow it was made: {way}"
    shown: list[str | Image] = [words, *wanted(request), "The assembly at rest, from four sides:", assembly_picture(assembly)]
    for name, realised in list(assembly.realised.items())[:PARTS]:
        if realised.derived_from is None:
            shown += [f"Part {name}:", part_picture(realised.part, realised.digests["build"])]
    for joint in assembly.mechanism.driving_joints[:MOTIONS]:
        shown += [f"Keyframes of joint {joint}:", motion_picture(assembly, joint)]
    try:
        return ask(llm, "review", "review", (system(prompt("review")), user(*shown)), reader(Opinion), schema=schema_of(Opinion))
    except OutputError as error:
        for finding in error.findings:
            run.trace_finding(finding)
        return None
