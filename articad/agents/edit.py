"""Edit: change a finished run by words or numbers, and leave everything else as it is.

A designer who sees the whole plan answers with changes to it, by address. Before anything is built, the parts that these changes reach
are computed and compared with the parts that the designer named. Scripts and solids of all other parts are kept, verdicts of pairs that
cannot have changed are carried over, and the report proves both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NoReturn

from articad.agents import edit_report
from articad.agents.design import listed
from articad.agents.drift import note
from articad.agents.edit_base import Base, document_of, with_values
from articad.agents.evidence import Evidence, Known, examine
from articad.agents.line import Chooser, Line, PlanAuthor
from articad.agents.llm import LLM, Image, Message, Recorded, Reply, Request, assistant, system, user
from articad.agents.part_builder import PartBuilder
from articad.agents.prompts import prompt, prompt_section
from articad.agents.recollection import KeptDocumentation, KeptMemory
from articad.agents.replies import ReplyForm, reader, schema_of
from articad.agents.requirements import Requirements, pictures_of
from articad.agents.retrieval import Memory
from articad.agents.settings import RunOptions, Services, edit_request
from articad.assembly import Assembly
from articad.errors import AgentError, OutputError, PlanError, ReadError, did_you_mean
from articad.findings import Finding, Findings
from articad.kernels.kernel import BuildCache
from articad.plan.amending import amended
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run, RunRequest, UserImage, open_or_create

ROLE: Final = "edit"
_RULES: Final = ("# 1. Units", "# 7. Example")  # first and last heading of those sections of the design prompt that hold for every plan


def edit(
    run: Run | str | Path,
    text: str = "",
    *,
    llm: LLM | None = None,
    values: Mapping[str, float] | None = None,
    images: Iterable[str | Path | bytes] = (),
    out: str | Path | None = None,
    options: RunOptions | None = None,
    services: Services | None = None,
) -> Run:
    """Change a finished run; the original run is not modified.

    Calling it again with the same arguments and the same `out` resumes an interrupted edit; no call to the model is repeated.

    Args:
        run: The finished run, made by a model or by `build`.
        text: The change, in words.
        llm: The model; not needed with `values` alone, as long as all scripts build with them.
        values: New values of the plan's parameters, in mm and degrees.
        images: Pictures that belong to the text.
        out: The directory of the new run; by default a new one under `runs/`.
        options: As for `generate`; only parts that are written anew are looked at, and without a text nobody inspects. Ideas,
            pick and variant have no meaning here.
        services: As for `generate`; the kernel is the run's own by default.

    Returns:
        The new run, closed; `run.edit()` says what has changed and proves that nothing else has.

    Raises:
        ReadError: If the run is not finished, or no change is given.
        PlanError, ContractError, AgentError: As `generate`.
    """
    finished = run if isinstance(run, Run) else Run.view(run)
    if not text.strip() and not values:
        raise ReadError("No change is given: give a text, or values of parameters.", path=str(finished.path))
    options, services = options or RunOptions(), services or Services()
    base = Base.of(finished)
    stored = edit_request(options, base.stored["kernel"], base.mark, values or {}, worded=bool(text.strip()))
    request = RunRequest(prompt=text.strip(), images=tuple(UserImage.read(image) for image in images), options=stored)
    kernel = services.kernel_or(base.stored["kernel"])
    with open_or_create(request, out) as edited:
        edited.save_base(base.stored)
        note(edited, kernel)
        port, cache = Recorded(llm or Nobody(), edited), services.cache or BuildCache()
        memory, documentation = KeptMemory(edited, services.memory), KeptDocumentation(edited, services.documentation)
        builder = PartBuilder(edited, port, kernel, cache, services.jobs, services.progress, memory, documentation)
        EditLine(builder, _nothing_to_choose, memory).work()
    return edited


class EditLine(Line):
    """An edit in progress: the pipeline from a finished run on."""

    def __init__(self, builder: PartBuilder, chooser: Chooser, memory: Memory | None) -> None:
        super().__init__(builder, chooser, memory)
        stored = self.run.base()
        if stored is None:
            raise ReadError(f"{self.run.path} is an edit whose base is missing.", path=str(self.run.path))
        self.base = Base(stored)
        request = builder.run.request
        changed = f"\n\nChanged since: {request.prompt}" if request.prompt else ""
        self.asked = RunRequest(prompt=f"{stored['prompt']}{changed}", images=request.images, options=request.options)
        builder.begun = self.base.scripts
        builder.planned = tuple(self.base.resolved.parts)
        builder.adopt(dict.fromkeys(self.base.scripts, self.base.resolved), self.base.scripts)

    def requirements(self) -> Requirements:
        """Return the requirements of the original run."""
        requirements = self.base.requirements
        self.run.save_requirements(requirements.to_json())
        return requirements

    def planner(self, requirements: Requirements) -> PlanAuthor:  # noqa: ARG002 - the line's
        """Return who changes the plan."""
        self.builder.announce("design", "started")
        return self._editor

    @cached_property
    def _editor(self) -> Editor:
        return Editor(self.base, self.run.request, self.port, tries=self.options["designs"], tell=self.tell_of_plan)

    def examined(self, assembly: Assembly) -> Evidence:
        """Return the measurements of an assembly; pairs that cannot have changed are not checked again."""
        self._known = self.base.known(assembly, self.run.version)
        return examine(assembly, self._known)

    def to_be_answered(self, assembly: Assembly, evidence: Evidence, requirements: Requirements) -> Findings:  # noqa: ARG002 - the line's
        """Return nothing: the finished product has been answered for, and the analysis keeps the numbers from before the edit."""
        return Findings()

    def finish(self, assembly: Assembly, evidence: Evidence, requirements: Requirements | None) -> None:
        """Write the exports, and the report of what has changed."""
        super().finish(assembly, evidence, requirements)
        assert assembly.resolved is not None
        report = edit_report.report(self.base, self.run, assembly.resolved, evidence.checks, self._known, summary=self._editor.summary)
        self.run.save_edit(report)
        self.builder.announce("edit", "proved" if report["ok"] else "NOT proved")

    _known = Known()


class Change(ReplyForm):
    """A designer's answer: what a plan states otherwise."""

    summary: str
    touches: tuple[str, ...]
    changes: dict[str, Any]


class Editor:
    """Changes the plan of a finished product.

    Args:
        base: The finished product.
        request: The change that is requested.
        llm: The model; `Nobody` if only numbers change.
        tries: Answers within which the changed plan must be valid.
        tell: Called with each answer.

    Attributes:
        summary: What was changed, in one sentence.
    """

    def __init__(self, base: Base, request: RunRequest, llm: LLM, *, tries: int, tell: Any) -> None:
        self._base, self._request, self._llm, self._tries, self._tell = base, request, llm, tries, tell
        self._values: Mapping[str, float] = request.options.get("set") or {}
        self._answered = 0
        self._said = ""
        self.summary = ", ".join(f"{name} = {value:g}" for name, value in self._values.items())

    @cached_property
    def _begin(self) -> AssemblyPlan:
        """The plan with the given values."""
        return with_values(self._base.plan, self._values) if self._values else self._base.plan

    @cached_property
    def _opening(self) -> tuple[Message, ...]:
        pictures = pictures_of(self._request)
        shown = f"\n\n{len(pictures)} picture(s) of what is asked for follow." if pictures else ""
        words = (
            f"The product was asked for like this:\n\n{self._base.stored['prompt'].strip() or '(no words)'}\n\n"
            f"Its plan:\n\n```json\n{self._begin.dumps()}```\n\nThe change that the customer asks for:\n\n{self._request.prompt}{shown}"
        )
        return (system(prompt("edit", rules=prompt_section("design.md", *_RULES))), user(words, *pictures))

    def first(self) -> AssemblyPlan:
        """Return the changed plan.

        Raises:
            PlanError: If the last answer still has errors, or the plan is not valid with the given values.
            OutputError: If the last answer does not have the required form.
        """
        if self._request.prompt:
            return self._until_valid(self._opening)
        findings = check_plan(self._begin)
        self._tell(self._begin, findings)
        if not findings.ok:
            raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
        return self._begin

    def again(
        self,
        plan: AssemblyPlan,  # noqa: ARG002 - changes refer to the original plan, not to the last one
        findings: Iterable[Finding],
        *,
        pictures: Sequence[Image] = (),
        stubborn: Iterable[Finding] = (),
    ) -> AssemblyPlan:
        """Return another changed plan, after this one was built and findings resulted; see `Designer.again`."""
        if not self._request.prompt:
            every = Findings(findings)
            raise PlanError("\n".join(map(str, every)), findings=every)
        came_back = listed(stubborn)
        note = (
            f" These came back although you changed something for them; solve them in another way:\n\n{came_back}\n\n" if came_back else ""
        )
        words = prompt("edit_again", findings=listed(findings), note=note)
        if pictures:
            words += "\n\nPictures of the places follow; what parts have in common is red."
        return self._until_valid((*self._opening, assistant(self._said), user(words, *pictures)))

    def _until_valid(self, messages: tuple[Message, ...]) -> AssemblyPlan:
        for number in range(1, self._tries + 1):
            self._answered += 1
            step = f"edit/{self._answered}"
            reply = self._llm.complete(Request(ROLE, step, messages, schema_of(Change)))
            self._said = reply.text
            problem: OutputError | None = None
            plan, findings = None, Findings()
            try:
                change = reader(Change)(reply.text, step)
                plan, findings = self._changed(change)
            except OutputError as error:
                problem = error
                findings = error.findings
            except (PlanError, ReadError) as error:
                findings = error.findings
            self._tell(plan, findings)
            if plan is not None and findings.ok:
                self.summary = change.summary
                return plan
            if number == self._tries:
                raise problem or PlanError(f"No valid change in {number} answers.\n{findings}", findings=findings)
            complaint = prompt("form_repair", problem=problem.message) if problem else prompt("edit_repair", findings=listed(findings))
            messages = (*self._opening, assistant(reply.text), user(complaint))
        raise AssertionError("the last try either returns or raises")

    def _changed(self, change: Change) -> tuple[AssemblyPlan, Findings]:
        """Return the changed plan and its findings: errors in it, and parts that it reaches without naming them.

        Raises:
            ReadError, PlanError: If the plan cannot be made.
        """
        plan = AssemblyPlan.from_json(amended(document_of(self._begin), change.changes))
        findings = check_plan(plan)
        if not findings.ok:
            return plan, findings
        return plan, findings + self._out_of_reach(plan, change.touches)

    def _out_of_reach(self, plan: AssemblyPlan, touches: Sequence[str]) -> Iterable[Finding]:
        """Yield a finding for each part that a plan changes although the change does not name it."""
        before, after = resolve(self._begin), resolve(plan)
        every = list(dict.fromkeys((*before.parts, *after.parts)))
        patterns = {part.name for part in plan.parts} | {part.name for part in self._begin.parts}
        for name in touches:
            if name not in every and name not in patterns:
                message = f'"touches" names {name!r}, which is not a part.{did_you_mean(name, every)}'
                yield Finding(code="E_EDIT_REACH", where="touches", message=message, hint="Name parts of the plan.")
        for name, how in edit_report.reach(before, after).items():
            if (
                name in touches
                or how in {"follows its source", "mirrored anew"}
                or any(name.startswith(f"{one}_") for one in touches if one not in every)
            ):
                continue
            told = edit_report.told_otherwise(before, after, name)
            message = f'The changes also affect {name} ({how}{f": {told}" if told else ""}), which "touches" does not name.'
            hint = "Name it if the customer wants that or if it must follow; otherwise change something that affects fewer parts."
            yield Finding(code="E_EDIT_REACH", where=f"parts.{name}", parts=(name,), message=message, hint=hint)


class Nobody:
    """Stands in where no model was named."""

    def complete(self, request: Request) -> Reply:
        """Refuse.

        Raises:
            AgentError: Always.
        """
        raise AgentError(f"{request.step!r} needs a model: a script does not build with the new numbers, or a text was given. Name one.")


def _nothing_to_choose(_alternatives: Sequence[Any]) -> NoReturn:
    raise AgentError("An edit has no alternatives.")
