"""Generation: one part, from its entry in the plan to a solid that keeps its contract and looks as specified.

A request to repair depends on the part's own entry, its own connectors, the kernel and what was retrieved: never on another part.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, Literal

from articad.agents.inspection import look
from articad.agents.llm import LLM, Image, Message, Request, assistant, system, user
from articad.agents.pictures import part_picture, partial_picture
from articad.agents.prompts import prompt, prompt_file
from articad.agents.replies import objection, parse_script
from articad.agents.retrieval import Documentation, Memory, NoDocumentation, NoMemory, listed_cases
from articad.assembly import DEFLECTION_MM
from articad.errors import ArticadError, BuildError, ContractError, KernelError, OutputError
from articad.findings import Finding, Findings
from articad.findings.codes import CODES
from articad.kernels.kernel import PartKernel
from articad.kernels.parts import RealisedPart
from articad.plan.brief import build_digest
from articad.plan.entry import specification
from articad.plan.resolve import ResolvedPlan
from articad.runs.run import Run

ROLE: Final = "part"
REPAIRS: Final = 3
ATTEMPT_SCHEMA: Final = "articad.attempt/1"
_SHOWN_CHARACTERS = 6000  # of a failure; tracebacks contain only the script's own frames, so this limit is rarely reached
_EXAMPLES: Final = {"build123d": "lid_left.txt", "freecad": "door_left_freecad.txt"}

Build = Callable[[str, bytes], RealisedPart]
"""Builds the script of a part, or raises `KernelError`."""

Looks = bool | Literal["together"]
"""Which parts' pictures are compared with their specification, each in a request of its own: none, all, or with "together" the doubtful
ones: those whose first script failed, about whose solid there is a warning, or of which the user gave a picture. With "together" the
others are surveyed, several in one request (`articad.agents.survey`).
"""

Complaint = Literal["part_repair", "part_again", "part_edit", "look_repair"]
"""The prompt that returns an answer to its author: the script failed, the assembly failed, the entry has changed, or an inspector
complains.
"""


@dataclass(frozen=True)
class Answer:
    """What a model answered for a part: the address of the request, and the text."""

    step: str
    text: str


@dataclass(frozen=True)
class Attempt:
    """An answer that was rejected.

    Attributes:
        said: The answer.
        failure: What was wrong with it, as its author is told.
        picture: What its script built.
        error: The same as an exception.
        complaint: The prompt that returns it.
    """

    said: str
    failure: str
    picture: Image | None = None
    error: ArticadError | None = None
    complaint: Complaint = "part_repair"

    @classmethod
    def of(cls, said: str, error: KernelError | OutputError, picture: Image | None = None) -> Attempt:
        """Return the attempt that ended with an error."""
        return cls(said, failure_text(error), picture, error)

    @property
    def is_of_design(self) -> bool:
        """Whether the specification is at fault, so that its author cannot mend it."""
        found = () if self.error is None else self.error.findings.errors or self.error.findings
        return bool(found) and all(finding.route == "design" for finding in found)

    @property
    def signature(self) -> object:
        """Return what two failures of the same cause have in common: their places, and for a crash its message."""
        if self.error is None or isinstance(self.error, OutputError):
            return self.complaint, None if self.error is None else "unreadable"
        return tuple((f.code, f.where, f.message if f.code == "E_SCRIPT_ERROR" else "") for f in self.error.findings.errors)


@dataclass(frozen=True)
class WrittenPart:
    """A part that keeps its contract.

    Attributes:
        realised: The part.
        answers: Number of answers in all; the address of the next one follows from it.
        opinions: Complaints of an inspector; exact checks neither confirm nor refute them. None if no inspector saw it.
    """

    realised: RealisedPart
    answers: int
    opinions: Findings | None = None


class PartWriter:
    """Writes the script of one part.

    Args:
        resolved: The plan with its numbers; only the part's own entry is read.
        name: The part.
        llm: The model that writes and inspects.
        run: Stores failed attempts, and holds those of an interrupted run.
        build: Builds a script and checks its contract.
        kernel: The kernel; its name is the dialect of the script.
        repairs: How often a failed script may be repaired.
        looks: Whether pictures of the built part are compared with the specification.
        memory: Source of worked examples.
        documentation: Source of the kernel's API.
    """

    def __init__(
        self,
        resolved: ResolvedPlan,
        name: str,
        *,
        llm: LLM,
        run: Run,
        build: Build,
        kernel: PartKernel,
        repairs: int = REPAIRS,
        looks: Looks = False,
        memory: Memory | None = None,
        documentation: Documentation | None = None,
    ) -> None:
        self._resolved, self._name, self._llm, self._run, self._build, self._kernel = resolved, name, llm, run, build, kernel
        self._repairs, self._looks = repairs, looks
        self._memory, self._documentation = memory or NoMemory(), documentation or NoDocumentation()
        self._pictures = tuple(Image(image.content, image.media_type) for image in run.request.images if image.part == name)
        self._specification = specification(resolved, name)

    def make(
        self, *, answered: int = 0, previous: Attempt | None = None, given: Answer | None = None, standing: WrittenPart | None = None
    ) -> WrittenPart:
        """Return the part as built.

        After the same failure twice in a row, another approach is requested; the third time ends the attempts. So does a failure of the
        specification: an author's objection, or a script that builds with a number in another unit (`articad.kernels.slips`).

        Args:
            answered: Answers that were given before; the address of the next one follows from it.
            previous: The last of these, and what is wrong with it.
            given: The first answer, if it was asked for together with those of other parts.
            standing: The part as it is, which stays if no better one is built.

        Raises:
            BuildError, ContractError, OutputError: The failure of the last answer, when all repairs are used up or the specification is at fault.
        """
        alike, best = 0, standing
        for number in range(answered + 1, answered + self._repairs + 2):
            answer = given or self._answer(number, messages_after(self._opening, previous, anew=alike == 1))
            given = None
            outcome = self._tried(answer, number)
            if isinstance(outcome, RealisedPart):
                if best is not None and best.realised.script == outcome.script:  # its author stands by it
                    return WrittenPart(outcome, number, best.opinions)
                doubtful = (
                    previous is not None or any(finding.severity == "warning" for finding in outcome.findings) or bool(self._pictures)
                )
                best = WrittenPart(outcome, number, self._opinions(outcome, number, doubtful=doubtful))
                of_script = Findings(finding for finding in best.opinions or () if finding.route == "code")
                if not of_script:
                    return best
                outcome = Attempt(answer.text, told_of(of_script), self._picture(outcome), complaint="look_repair")
            if outcome.is_of_design:
                previous = outcome
                break
            alike = alike + 1 if previous is not None and outcome.signature == previous.signature else 0
            previous = outcome
            if alike > 1:
                break
        if best is not None:
            return WrittenPart(best.realised, number, best.opinions)
        assert previous is not None
        assert previous.error is not None
        raise previous.error

    def _answer(self, number: int, messages: tuple[Message, ...]) -> Answer:
        step = f"part/{self._name}/{number}"
        return Answer(step, self._llm.complete(Request(ROLE, step, messages)).text)

    @cached_property
    def _opening(self) -> tuple[Message, ...]:
        kernel = self._kernel.name
        examples = self._memory.for_part(self._specification, kernel)
        snippets = self._documentation.for_part(self._name, self._specification, kernel, self._llm)
        return opening(self._resolved, self._name, kernel, self._pictures, examples=examples, snippets=snippets)

    def _opinions(self, realised: RealisedPart, number: int, *, doubtful: bool) -> Findings | None:
        """Return an inspector's complaints about a part; None if nobody looks at it, or its answers do not have the form."""
        if not (self._looks if isinstance(self._looks, bool) else doubtful):
            return None
        step = f"look/{self._name}/{number}"
        try:
            opinions = look(self._specification, self._name, realised, self._llm, step=step, pictures=self._pictures)
        except OutputError as error:
            for finding in error.findings:
                self._run.trace_finding(finding)
            return None
        for finding in opinions:
            self._run.trace_finding(finding)
        return Findings(finding for finding in opinions if finding.severity == "warning")  # what no picture shows is not a complaint

    def _picture(self, realised: RealisedPart) -> Image:
        return part_picture(realised.part, realised.digests["build"])

    def _tried(self, answer: Answer, number: int) -> RealisedPart | Attempt:
        """Return the part that an answer made, or why it made none."""
        said = answer.text
        why = objection(said)
        if why is not None:
            refused = Finding(
                code="E_ORDER_REFUSED",
                where=f"parts.{self._name}",
                message=f"{self._name} cannot be built: {why}",
                hint=CODES["E_ORDER_REFUSED"].remedy,
                parts=(self._name,),
            )
            return Attempt.of(said, ContractError(str(refused), findings=(refused,), parts=(self._name,)))
        try:
            script = parse_script(said, step=answer.step)
        except OutputError as error:
            return Attempt.of(said, error)
        mark = build_digest(self._resolved, self._name, script, self._kernel.name, self._kernel.version, DEFLECTION_MM)
        known = self._run.attempt(self._name, number)
        if known is not None and known["build"] == mark:  # an interrupted run has already built it and failed
            return _remembered(known, self._run.attempt_picture(self._name, number), said, self._name)
        try:
            return self._build(self._name, script)
        except (BuildError, ContractError) as error:
            picture = partial_picture(error.partial, self._name, mark)
            self._run.save_attempt(
                self._name,
                number,
                script=script,
                picture=None if picture is None else picture.content,
                outcome=_outcome(error, mark, picture),
            )
            self._run.trace("build", part=self._name, attempt=number, ok=False, codes=list(error.findings.codes))
            return Attempt.of(said, error, picture)


def opening(
    resolved: ResolvedPlan,
    name: str,
    kernel: str,
    pictures: tuple[Image, ...] = (),
    *,
    examples: Sequence[str] = (),
    snippets: Sequence[str] = (),
) -> tuple[Message, ...]:
    """Return the first messages to a part's author: the contract of a script, what was retrieved, and the part's own entry."""
    told = instructions(kernel, examples=examples, snippets=snippets)
    shown = f"\n\n{len(pictures)} picture(s) of the part follow." if pictures else ""
    return (system(told), user(f"The specification:\n\n{specification(resolved, name)}{shown}", *pictures))


def instructions(kernel: str, *, examples: Sequence[str] = (), snippets: Sequence[str] = ()) -> str:
    """Return what an author of scripts is told of every part: the contract of a script, and what was retrieved."""
    told = prompt(f"part_{kernel}", example=prompt_file(_EXAMPLES[kernel]))
    told += listed_cases("# Parts of other products that were built well", examples)
    return told + listed_cases("# From the documentation", snippets)


def messages_after(first: tuple[Message, ...], previous: Attempt | None, *, anew: bool = False) -> tuple[Message, ...]:
    """Return the conversation that asks for a script, for a better one than the previous, or for one by another approach."""
    if previous is None:
        return first
    complaint = prompt("part_anew" if anew else previous.complaint, failure=previous.failure)
    if previous.picture is None:
        return (*first, assistant(previous.said), user(complaint))
    return (*first, assistant(previous.said), user(f"{complaint}\n\nA picture of what the script had made:", previous.picture))


def failure_text(error: KernelError | OutputError) -> str:
    """Return a failure as its author is told it: no path, no address, no time."""
    if isinstance(error, OutputError):
        return f"It could not be read: {error.message}"
    lines = [f"- {finding}" for finding in error.findings if finding.severity != "info"] or [error.message]
    if isinstance(error, BuildError) and error.traceback:
        lines += ["", error.traceback.strip()]
    return "\n".join(lines)[:_SHOWN_CHARACTERS]


def told_of(findings: Findings) -> str:
    """Return an inspector's complaints as the author of the script is told them."""
    return "\n".join(f"- {finding.message} {finding.hint}".rstrip() for finding in findings)


def _outcome(error: KernelError, mark: str, picture: Image | None) -> dict[str, Any]:
    """Return the record of a failed attempt: all that is needed to ask for a better one."""
    trace = {"line": error.line, "traceback": error.traceback} if isinstance(error, BuildError) else {}
    recipe = None if picture is None or picture.recipe is None else dict(picture.recipe)
    findings = error.findings.to_json()["findings"]
    return {"schema": ATTEMPT_SCHEMA, "build": mark, "message": error.message, "findings": findings, "picture": recipe} | trace


def _remembered(known: Mapping[str, Any], content: bytes | None, said: str, name: str) -> Attempt:
    """Return the attempt that an earlier process made."""
    entries = ({key: value for key, value in stored.items() if key != "severity"} for stored in known["findings"])
    findings = Findings(Finding(**entry | {"parts": tuple(entry["parts"])}) for entry in entries)
    picture = None if content is None else Image(content, recipe=known["picture"])
    if "traceback" in known:
        error: KernelError = BuildError(
            known["message"], line=known["line"], traceback=known["traceback"], findings=findings, parts=(name,)
        )
    else:
        error = ContractError(known["message"], findings=findings, parts=(name,))
    return Attempt.of(said, error, picture)
