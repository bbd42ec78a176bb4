"""Inspection: models look at what was built. What can be measured has been measured before, and overrules them.

Part: one model compares its pictures with its specification. Assembly: one model describes pictures and keyframes, another judges this
    description beside the measurements.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal, Self

from pydantic import model_validator

from articad.agents.design import ANALYSIS
from articad.agents.evidence import Evidence, told
from articad.agents.llm import LLM, Image, system, user
from articad.agents.numbers import short
from articad.agents.pictures import assembly_picture, motion_picture, part_picture
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of, unusable
from articad.agents.requirements import Requirements, pictures_of
from articad.assembly import Assembly
from articad.findings import Finding, Findings
from articad.kernels.parts import RealisedPart
from articad.kinematics.joints import Coupling
from articad.plan.resolve import ResolvedPart, ResolvedPlan
from articad.runs.run import RunRequest

VERDICT_SCHEMA: Final = "articad.verdict/1"
UNSEEN: Final = "not seen"
MOTIONS: Final = 6  # keyframe sheets for one observer; more pictures at once are not looked at closely
Aspect = Literal["placement", "interference", "motion"]
_SEEN: Final = ("relations", "motions", "assumptions")
"""Fields of the analysis: what pictures can show beyond the parts, which are listed as built."""
_ASPECTS: Final = ("placement", "interference", "motion")
_CODES: Final = {aspect: f"E_VERDICT_{aspect.upper()}" for aspect in _ASPECTS}


# ---------------------------------------------------------------------- one part


class Compared(ReplyForm):
    """What was seen of one aspect of a part, and what the specification says of it; what no picture shows is neither right nor wrong."""

    aspect: Literal["shape", "proportion", "orientation"]
    agrees: bool
    seen: str
    not_visible: str = ""
    specified: str
    fault: Literal["none", "script", "specification"]
    remedy: str


class Look(ReplyForm):
    """A part's pictures held against its specification: one finding for each aspect."""

    findings: tuple[Compared, ...]

    @model_validator(mode="after")
    def _each_once(self) -> Self:
        if sorted(one.aspect for one in self.findings) != ["orientation", "proportion", "shape"]:
            raise ValueError('"findings" has one entry each for "shape", "proportion" and "orientation".')
        for one in self.findings:
            if one.agrees != (one.fault == "none"):
                raise ValueError(f'{one.aspect}: "fault" is "none" where it agrees, and only there.')
        return self


def look(specification: str, name: str, realised: RealisedPart, llm: LLM, *, step: str, pictures: Sequence[Image] = ()) -> Findings:
    """Ask a model to compare a part's pictures with its specification.

    Args:
        specification: The text that the script's author was given.
        name: The part.
        realised: As built.
        llm: The model; it must accept images.
        step: Address of the request.
        pictures: The user's own pictures of this part.

    Returns:
        A warning for each aspect that does not agree, routed to whom the model blames; a note for what could not be seen.

    Raises:
        OutputError: If no reply has the required form.
    """
    given = f"\n\nFirst {len(pictures)} picture(s) of what the customer wants, then" if pictures else ""
    words = f"The specification:\n\n{specification}{given or chr(10) + chr(10) + 'Now'} the sheet of what was built:"
    drawn = part_picture(realised.part, realised.digests["build"])
    opening = (system(prompt("look")), user(words, *pictures, drawn))
    seen = ask(llm, "look", step, opening, reader(Look), schema=schema_of(Look))
    complaints = [
        Finding(
            code=f"W_LOOK_{one.aspect.upper()}",
            where=f"parts.{name}",
            parts=(name,),
            message=f"Seen: {one.seen.strip().rstrip('.')}. Specified: {one.specified.strip().rstrip('.')}.",
            hint=one.remedy,
            route="code" if one.fault == "script" else "design",
        )
        for one in seen.findings
        if not one.agrees
    ]
    unseen = [
        Finding(
            code="I_LOOK_UNSEEN",
            where=f"parts.{name}",
            parts=(name,),
            message=f"No picture shows: {one.not_visible.strip().rstrip('.')}.",
            hint="It was not judged.",
        )
        for one in seen.findings
        if one.not_visible.strip()
    ]
    return Findings([*complaints, *unseen])


# ---------------------------------------------------------------------- the assembly


Expected = bool | Literal["not seen"]
"""Whether something is as the request has it; "not seen" where no picture shows it, which is neither."""


def _as(expected: Expected) -> str:
    if isinstance(expected, bool):
        return "as expected" if expected else "NOT as expected"
    return UNSEEN


class PartSeen(ReplyForm):
    """What was seen of a part."""

    part: str
    seen: str
    expected: Expected


class MotionSeen(ReplyForm):
    """What was seen of a joint's motion."""

    joint: str
    seen: str
    expected: Expected


class Observations(ReplyForm):
    """What the pictures of an assembly show."""

    overall: str
    parts: tuple[PartSeen, ...]
    motions: tuple[MotionSeen, ...]

    @property
    def unseen(self) -> tuple[list[str], list[str]]:
        """The parts and the joints of which the observer saw nothing."""
        parts = [one.part for one in self.parts if one.expected == UNSEEN]
        return parts, [one.joint for one in self.motions if one.expected == UNSEEN]

    def told(self) -> str:
        """Return the observations as a prompt holds them: a line for each part and motion."""
        lines = [self.overall, *(f"part {one.part} ({_as(one.expected)}): {one.seen}" for one in self.parts)]
        lines += [f"motion of joint {one.joint} ({_as(one.expected)}): {one.seen}" for one in self.motions]
        return "\n".join(f"- {' '.join(line.split())}" for line in lines)

    def with_second(self, second: Observations) -> Observations:
        """Return these observations with what another look shows in place of what was not seen."""
        parts, joints = self.unseen
        kept = tuple(one for one in self.parts if one.part not in parts)
        moving = tuple(one for one in self.motions if one.joint not in joints)
        return Observations(
            overall=self.overall,
            parts=(*kept, *(one for one in second.parts if one.part in parts)),
            motions=(*moving, *(one for one in second.motions if one.joint in joints)),
        )


class Ruling(ReplyForm):
    """Whether one aspect is as was asked."""

    ok: bool
    reason: str


class Problem(ReplyForm):
    """What is wrong, and whose fault it is."""

    aspect: Aspect
    parts: tuple[str, ...]
    what: str
    expected: str
    fault: Literal["design", "code"]
    remedy: str


class Judgement(ReplyForm):
    """A judge's answer."""

    placement: Ruling
    interference: Ruling
    motion: Ruling
    problems: tuple[Problem, ...]

    @model_validator(mode="after")
    def _agree(self) -> Self:
        for aspect in _ASPECTS:
            has = any(problem.aspect == aspect for problem in self.problems)
            if has == getattr(self, aspect).ok:
                raise ValueError(f'"{aspect}" is {"ok, but has a problem" if has else "not ok, but no problem says why"}.')
        return self


@dataclass(frozen=True)
class Verdict:
    """The decision about an assembly.

    Attributes:
        findings: Errors for what must be fixed; notes for opinions that measurements overrule.
        by: "geometry" if exact checks decided, else "judge".
        round: The round, from 1.
        observations: The observer's description; None if there was no observer.
        rulings: The judge's rulings, by aspect; empty if there was no judge.
    """

    findings: Findings
    by: Literal["geometry", "judge"]
    round: int
    observations: Observations | None = None
    rulings: tuple[tuple[str, Ruling], ...] = ()

    @property
    def ok(self) -> bool:
        """True when nothing must be fixed."""
        return self.findings.ok

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.verdict/1`."""
        return {
            "schema": VERDICT_SCHEMA,
            "ok": self.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "by": self.by,
            "round": self.round,
            "rulings": {aspect: ruling.model_dump() for aspect, ruling in self.rulings},
            "observations": None if self.observations is None else self.observations.model_dump(mode="json"),
        }


def inspect(assembly: Assembly, evidence: Evidence, request: RunRequest, requirements: Requirements, llm: LLM, *, number: int) -> Verdict:
    """Have an assembly described and judged by models.

    Args:
        assembly: As built.
        evidence: The measurements.
        request: What the user asked for.
        requirements: The analysis of the request.
        llm: The model that describes and judges.
        number: The round, from 1.

    Raises:
        OutputError: If no reply has the required form.
    """
    made = f"{structure(assembly)}{_assumed(assembly)}"
    observations = _observed(assembly, [f"{asked_for(request, requirements, fields=_SEEN)}\n\n{made}", *wanted(request)], llm, number)
    words = f"{asked_for(request, requirements)}\n\n{made}\n\nMeasured:\n\n{told(assembly, evidence)}\n\nThe observer saw:\n\n{observations.told()}"
    judgement = ask(
        llm, "judge", f"judge/{number}/1", (system(prompt("judge")), user(words)), _judgement_of(assembly), schema=schema_of(Judgement)
    )
    rulings = tuple((aspect, getattr(judgement, aspect)) for aspect in _ASPECTS)
    findings = Findings([*_weighed(judgement.problems, evidence), *_unseen(observations)])
    return Verdict(findings, "judge", number, observations, rulings)


def _unseen(observations: Observations) -> Iterable[Finding]:
    """Yield a warning for each part and motion that no look showed: nobody has agreed to it."""
    parts, joints = observations.unseen
    hint = "Look at it yourself with `articad show`; what is measured of it stands in the checks."
    for name in parts:
        message = f"No picture showed {name} to the observer, not even with what hides it drawn as glass."
        yield Finding(code="W_OBSERVER_UNSEEN", where=f"parts.{name}", parts=(name,), message=message, hint=hint)
    for name in joints:
        message = f"No picture showed the observer how {name} moves, not even with what hides it drawn as glass."
        yield Finding(code="W_OBSERVER_UNSEEN", where=f"joints.{name}", message=message, hint=hint)


def _assumed(assembly: Assembly) -> str:
    """Return the designer's assumptions, such as motions that exclude one another."""
    assumptions = () if assembly.plan is None else assembly.plan.assumptions
    return "" if not assumptions else "\n\nThe designer's assumptions:\n" + "\n".join(f"- {assumption}" for assumption in assumptions)


def verdict_of(evidence: Evidence, number: int) -> Verdict:
    """Return the verdict from geometry alone: its errors; no model was asked."""
    return Verdict(Findings(evidence.findings.errors), "geometry", number)


def _observed(assembly: Assembly, product: Sequence[str | Image], llm: LLM, number: int) -> Observations:
    """Return what an observer sees; of what it does not see, it gets other pictures once."""
    joints = assembly.mechanism.driving_joints[:MOTIONS]
    shown: list[str | Image] = [*product, "The assembly at rest, from four sides:", assembly_picture(assembly)]
    for joint in joints:
        shown += [f"Keyframes of joint {joint}:", motion_picture(assembly, joint)]
    first = _asked_to_observe(assembly, shown, llm, f"observe/{number}", joints=joints)
    parts, unseen = first.unseen
    if not parts and not unseen:
        return first
    shown = [*product, f"You saw nothing of {', '.join([*parts, *unseen])}. Other pictures follow. Write of these alone."]
    if parts:
        shown += [f"At rest, all but {', '.join(parts)} of glass:", assembly_picture(assembly, only=parts)]
    for joint in unseen:
        shown += [f"Keyframes of joint {joint}, from nearby, what stands still of glass:", motion_picture(assembly, joint, near=True)]
    second = _asked_to_observe(assembly, shown, llm, f"observe/{number}/unseen", joints=unseen, parts=parts)
    return first.with_second(second)


def _asked_to_observe(
    assembly: Assembly, shown: Sequence[str | Image], llm: LLM, step: str, *, joints: Sequence[str], parts: Sequence[str] = ()
) -> Observations:
    """Return an observer's answer that says something of these joints and parts."""

    def read(text: str, step: str) -> Observations:
        seen = reader(Observations)(text, step)
        missing = [joint for joint in joints if joint not in {motion.joint for motion in seen.motions}]
        untold = [part for part in parts if part not in {one.part for one in seen.parts}]
        strangers = sorted({one.part for one in seen.parts} - set(assembly.parts))
        complaints = [f"motions: nothing is said of {', '.join(missing)}." if missing else ""]
        complaints += [f"parts: nothing is said of {', '.join(untold)}." if untold else ""]
        complaints += [f"parts: there is no {', '.join(strangers)}; there are {', '.join(assembly.parts)}." if strangers else ""]
        if any(complaints):
            raise unusable(" ".join(filter(None, complaints)), text, step=step)
        return seen

    return ask(llm, "observe", step, (system(prompt("observe")), user(*shown)), read, schema=schema_of(Observations))


def _judgement_of(assembly: Assembly) -> Any:
    """Return a function that reads a judge's answer and rejects unknown parts."""

    def read(text: str, step: str) -> Judgement:
        judgement = reader(Judgement)(text, step)
        for problem in judgement.problems:
            strangers = [name for name in problem.parts if name not in assembly.parts]
            if strangers:
                raise unusable(f"there is no part {', '.join(strangers)}; there are {', '.join(assembly.parts)}.", text, step=step)
            if problem.fault == "code" and not problem.parts:
                raise unusable('a problem whose fault is "code" names the part.', text, step=step)
        return judgement

    return read


def _weighed(problems: Iterable[Problem], evidence: Evidence) -> Iterable[Finding]:
    """Yield findings for problems; interference that exact checks looked for and did not find is only a note."""
    for problem in problems:
        overruled = problem.aspect == "interference" and evidence.ok
        yield Finding(
            code="I_OVERRULED" if overruled else _CODES[problem.aspect],
            where=f"parts.{problem.parts[0]}" if problem.parts else "assembly",
            parts=problem.parts,
            message=f"{problem.what.strip().rstrip('.')}. Expected: {problem.expected.strip().rstrip('.')}.",
            hint="The exact checks found no interference." if overruled else problem.remedy,
            route=problem.fault,
        )


def wanted(request: RunRequest) -> tuple[str | Image, ...]:
    """Return the customer's own pictures of the whole with an introduction; empty if there are none."""
    pictures = pictures_of(request)
    return ("The customer's own pictures of what is wanted, not of what was built:", *pictures) if pictures else ()


def asked_for(request: RunRequest, requirements: Requirements, *, fields: Sequence[str] | None = None) -> str:
    """Return a request and its analysis as text; of the analysis all or some fields."""
    words = request.prompt.strip() or "(no words; there were pictures)"
    return f"The customer's request:\n\n{words}\n\n{ANALYSIS}\n\n{requirements.told(fields)}"


def structure(assembly: Assembly) -> str:
    """Return the parts and joints of an assembly as text."""
    resolved: ResolvedPlan | None = assembly.resolved
    lines = ["Parts:"]
    for name in assembly.parts:
        part = None if resolved is None else resolved.parts[name]
        role = "" if part is None else _role(part, resolved)
        copy = f", a copy of {part.derivation.source}" if part is not None and part.derivation is not None else ""
        lines.append(f"- {name}{' (stands still)' if name == assembly.ground else ''}{copy}: {role}")
    lines += ["", "Joints:"]
    lines += [f"- {joint.name}: {joint.type}, {joint.child} against {joint.parent}" for joint in assembly.joints]
    couplings = assembly.mechanism.couplings
    if couplings:
        units = {coordinate.name: coordinate.unit for coordinate in assembly.mechanism.coordinates}
        lines += ["", "Couplings, held exactly:", *(_coupled(coupling, units) for coupling in couplings)]
    return "\n".join(lines)


def _coupled(coupling: Coupling, units: Mapping[str, str]) -> str:
    """Return the effect of a coupling, in degrees and mm."""
    turns = {name: units[name] == "rad" for name in (coupling.a, coupling.b)}
    ratio = coupling.ratio * (math.degrees(1.0) if turns[coupling.b] else 1.0) / (math.degrees(1.0) if turns[coupling.a] else 1.0)
    led, followed = ("degree" if turns[name] else "mm" for name in (coupling.a, coupling.b))
    return f"- {coupling.name}, {coupling.kind}: each {led} of {coupling.a} moves {coupling.b} by {short(ratio)} {followed}{'s' if followed == 'degree' else ''}"


def _role(part: ResolvedPart, resolved: ResolvedPlan | None) -> str:
    """Return the role of a part; for a copy its own description if it has one, not its source's role."""
    source = None if part.derivation is None or resolved is None else resolved.parts.get(part.derivation.source)
    own = source is not None and part.description != source.description
    return (part.description if own else part.role or part.description).split(". ")[0][:160]
