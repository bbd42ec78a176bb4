"""PartBuilder: builds the parts of a plan in parallel and keeps those whose plan entry did not change."""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import chain
from typing import Any, Final, NamedTuple

from articad.agents.finetuning import absorbed, notes
from articad.agents.llm import LLM, Image, closed_port
from articad.agents.part_group import asked_together, evenly, grouped
from articad.agents.part_writer import Answer, Attempt, Complaint, PartWriter, WrittenPart, failure_text, told_of
from articad.agents.pictures import part_picture
from articad.agents.retrieval import Documentation, Memory, NoDocumentation, NoMemory
from articad.agents.rollback import Fate
from articad.agents.survey import TOGETHER, Ordered, survey
from articad.aliases import Progress
from articad.assembly import DEFLECTION_MM, Assembly
from articad.errors import AgentError, ArticadError, ContractError, KernelError, OutputError
from articad.findings import Finding, Findings
from articad.findings.codes import CODES
from articad.kernels.kernel import BuildCache, PartKernel
from articad.kernels.parts import RealisedPart, build_parts, build_source
from articad.plan.brief import brief_digest
from articad.plan.entry import order
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run

SENT_BACK: Final = frozenset(
    {"W_CONNECTOR_DRIFT", "W_CONNECTOR_FEATURE", "W_PART_SCALE", "W_RADIUS_MISTAKEN"}
)  # warnings about a part that its author must mend
CALLS_AT_ONCE: Final = 8  # parts requested in parallel; a model's answer takes minutes, and providers limit the rate


class PartsError(ContractError):
    """Parts that could not be made; `failures` holds the reason by part."""

    def __init__(self, failures: Mapping[str, ArticadError], total: int) -> None:
        self.failures = dict(failures)
        findings = Findings(finding for error in failures.values() for finding in error.findings)
        lines = [f"{len(failures)} of {total} parts could not be made.", *(f"{name}: {error}" for name, error in failures.items())]
        super().__init__("\n".join(lines), findings=findings, parts=tuple(failures))

    @property
    def for_design(self) -> Findings:
        """Findings for the designer: no script was found for these entries."""
        return Findings(
            replace(finding, code=_as_error(finding.code), route="design", parts=(name,), message=_unbuilt(name, finding))
            for name, error in self.failures.items()
            for finding in error.findings
            if finding.severity != "info"
        )


class Complained(NamedTuple):
    """What is wrong with a part that was built.

    Attributes:
        failure: The text for the script's author.
        picture: Of the part or the place.
        prompt: The prompt that returns the script.
        may_stand: Whether the part stays as it is if its author does not build a better one: no check fails by it.
    """

    failure: str
    picture: Image | None
    prompt: Complaint = "part_again"
    may_stand: bool = False


@dataclass
class _Made:
    """A part that was made or tried: its entry in the plan, the number of answers, and the result."""

    brief: str
    answers: int
    script: bytes | None
    opinions: Findings | None = None  # of an inspector; None if no inspector saw it


@dataclass
class PartBuilder:
    """Makes parts.

    Attributes:
        run: Stores what is made.
        port: The model.
        kernel: Builds scripts.
        cache: Stores built parts.
        jobs: How many parts are built at once.
        progress: Called for each part.
        memory: Source of worked examples.
        documentation: Source of the kernel's API.
        complaints: What the authors of scripts are told when their parts are made again, by part.
        fates: What became of each part in this round.
        begun: Scripts that were written for other entries of these parts, for their authors to change.
        ending: Text that is appended to every script.
        planned: The parts of the last plan.
        made: The parts that were made or tried, by name.
    """

    run: Run
    port: LLM
    kernel: PartKernel
    cache: BuildCache
    jobs: int | None
    progress: Progress | None
    memory: Memory = field(default_factory=NoMemory)
    documentation: Documentation = field(default_factory=NoDocumentation)
    complaints: dict[str, Complained] = field(default_factory=dict)
    fates: dict[str, Fate] = field(default_factory=dict)
    begun: dict[str, bytes] = field(default_factory=dict)
    ending: bytes = b""
    planned: tuple[str, ...] = ()
    made: dict[str, _Made] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._before: dict[str, Fate] = {}
        self._building = threading.Semaphore(self.jobs or os.cpu_count() or 1)
        self._options: Mapping[str, Any] = self.run.request.options

    @property
    def scripts(self) -> dict[str, bytes]:
        """The scripts of this round's parts."""
        return {name: made.script for name, made in self.made.items() if made.script is not None}

    @property
    def opinions(self) -> Findings:
        """Complaints of inspectors about parts as they are."""
        return Findings(finding for made in self.made.values() for finding in made.opinions or ())

    def assembled(self, plan: AssemblyPlan) -> tuple[AssemblyPlan, Assembly]:
        """Return the assembly of a plan, and the plan: a new version of it if connectors were fine-tuned.

        Raises:
            PartsError: If parts could not be made; the others are finished.
            AgentError: If a model cannot be asked.
        """
        resolved = resolve(plan)
        sources = {name: resolved for name, part in resolved.parts.items() if part.derivation is None}
        self.make(sources, tuple(resolved.parts))
        self.survey(sources)
        self.announce("assembly", "started")
        with closed_port("assembly is deterministic"):
            return self.joined(plan, resolved)

    def adopt(self, resolved: Mapping[str, ResolvedPlan], scripts: Mapping[str, bytes], fates: Mapping[str, Fate] | None = None) -> None:
        """Take over scripts for the entries of their parts in these plans; each is kept while its entry is the same and it builds.

        Args:
            resolved: By part, the plan that has its entry.
            scripts: By part.
            fates: What became of them before in this round; by default they count as kept.
        """
        self._before = dict(fates or {})
        for name, script in scripts.items():
            old = self.made.get(name)
            answers, opinions = (0, Findings()) if old is None else (old.answers, old.opinions)  # a finished run's inspectors saw them
            self.made[name] = _Made(brief_digest(resolved[name], name), answers, script, opinions)

    def make(self, resolved: Mapping[str, ResolvedPlan], planned: tuple[str, ...]) -> None:
        """Make parts in parallel, or keep them as they are.

        Args:
            resolved: By part, the plan that has its entry.
            planned: All parts of the product, copies included.

        Raises:
            PartsError, AgentError: As `assembled`.
        """
        sources = list(resolved)
        gone = [name for name in self.planned if name not in planned]
        self.planned = planned
        self.fates = dict.fromkeys(gone, "removed")
        self.made = {name: made for name, made in self.made.items() if name in sources}
        groups = grouped([name for name in sources if self._is_new(resolved[name], name)], self._options.get("together", 1))
        steps = [f"parts/{names[0]}/{self._answers(names[0]) + 1}" for names in groups]  # before any part counts further answers
        with ThreadPoolExecutor(max_workers=min(CALLS_AT_ONCE, len(sources))) as pool:
            asked: dict[str, Future[dict[str, Answer]]] = {}
            for names, step in zip(groups, steps, strict=True):
                ask = partial(asked_together, step=step, memory=self.memory, documentation=self.documentation)
                asked |= dict.fromkeys(names, pool.submit(ask, {name: resolved[name] for name in names}, self.kernel.name, self.port))
            futures = {name: pool.submit(self._make, resolved[name], name, asked.get(name)) for name in sources}
        self.complaints = {}
        self.fates = {name: self.fates[name] for name in (*sources, *gone) if name in self.fates}
        _raise_failures(futures, len(sources))

    def survey(self, resolved: Mapping[str, ResolvedPlan]) -> None:
        """Have parts that no inspector saw held against their orders; have those whose scripts departed made again.

        Args:
            resolved: By part, the plan that has its entry.

        Raises:
            PartsError, AgentError: As `assembled`.
        """
        if self._options.get("look") != "together":
            return
        unseen = {name: plan for name, plan in resolved.items() if self.made[name].opinions is None}
        with ThreadPoolExecutor(max_workers=CALLS_AT_ONCE) as pool:
            found = Findings(chain.from_iterable(pool.map(partial(self._surveyed, unseen), evenly(list(unseen), TOGETHER))))
        for finding in found:
            self.run.trace_finding(finding)
        for name in unseen:
            mine = Findings(finding for finding in found if finding.parts == (name,))
            self.made[name].opinions = mine
            if any(finding.route == "code" for finding in mine):
                part = self._build(resolved[name], name, self.scripts[name])
                self.complaints[name] = Complained(
                    told_of(mine), part_picture(part.part, part.digests["build"]), "look_repair", may_stand=True
                )
        if self.complaints:
            fates = self.fates
            self._before = dict(fates)
            try:
                self.make(resolved, self.planned)
            finally:
                self._before = {}
                self.fates = fates | self.fates | {name: fate for name, fate in fates.items() if fate == "new"}

    def _surveyed(self, resolved: Mapping[str, ResolvedPlan], names: tuple[str, ...]) -> Findings:
        """Return what an inspector says of some finished parts; nothing if its answers do not have the form."""
        parts = {name: Ordered(order(resolved[name], name), self._build(resolved[name], name, self.scripts[name])) for name in names}
        step = f"survey/{names[0]}/{self._answers(names[0])}"
        self.announce(", ".join(names), "surveyed")
        try:
            return survey(parts, self.port, step=step)
        except OutputError as error:
            return error.findings

    def alone(self, resolved: Mapping[str, ResolvedPlan]) -> dict[str, RealisedPart]:
        """Return finished parts as these plans of single parts describe them."""
        return {name: self._build(plan, name, self.scripts[name]) for name, plan in resolved.items()}

    def shown(self, name: str) -> str:
        """Return the script of a finished part, as its author wrote it."""
        return self._shown(self.scripts[name])

    def announce(self, what: str, event: str) -> None:
        """Write an event into the trace, and report it to the caller."""
        self.run.trace("stage", name=what, state=event)
        if self.progress is not None:
            self.progress(what, event)

    def joined(self, plan: AssemblyPlan, resolved: ResolvedPlan) -> tuple[AssemblyPlan, Assembly]:
        """Return the assembly of parts whose scripts exist, and the plan as `assembled` does.

        Raises:
            ContractError: With the findings of every part that could not be built.
        """
        realised = self._built(resolved)
        drifted = {name: part for name, part in realised.items() if part.findings.of("W_CONNECTOR_DRIFT")}
        if drifted and (tuned := absorbed(resolved, drifted)) is not None:
            for note in notes(drifted):
                self.run.trace_finding(note)
            plan, resolved = tuned, resolve(tuned)
            realised = self._built(resolved)
            self.announce("design", "connectors fine-tuned")
        return plan, Assembly.from_realised(resolved, realised, kernel=self.kernel)

    def _built(self, resolved: ResolvedPlan) -> dict[str, RealisedPart]:
        return build_parts(resolved, self.scripts, kernel=self.kernel, cache=self.cache, deflection=DEFLECTION_MM, jobs=self.jobs)

    def _is_new(self, resolved: ResolvedPlan, name: str) -> bool:
        """Return whether a part's entry has no script to begin with, and words alone describe the part."""
        made = self.made.get(name)
        has_script = made is not None and made.script is not None and made.brief == brief_digest(resolved, name)
        return not (has_script or name in self.begun or any(image.part == name for image in self.run.request.images))

    def _answers(self, name: str) -> int:
        """Return how many answers about a part have an address."""
        return self.made[name].answers if name in self.made else 0

    def _make(self, resolved: ResolvedPlan, name: str, asked: Future[dict[str, Answer]] | None) -> None:
        """Make one part, or keep it as it is."""
        digest, old, complaint = brief_digest(resolved, name), self.made.get(name), self.complaints.get(name)
        answers, previous, standing = self._answers(name), None, None
        if old is not None and old.brief == digest and old.script is not None:
            if complaint is not None:
                previous = Attempt(self._shown(old.script), complaint.failure, complaint.picture, complaint=complaint.prompt)
                if complaint.may_stand:
                    standing = WrittenPart(self._build(resolved, name, old.script), answers, old.opinions)
            else:
                try:
                    self._build(resolved, name, old.script)
                except KernelError as error:
                    previous = Attempt(self._shown(old.script), f"The specification has changed since. {failure_text(error)}", error=error)
                else:
                    self.fates[name] = self._before.pop(name, "kept")
                    self.announce(name, "kept")
                    return
        elif name in self.begun:
            previous = Attempt(self._shown((old and old.script) or self.begun[name]), "", complaint="part_edit")
        self.fates[name] = "new" if old is None else "regenerated"
        self.announce(name, "started")
        writer = PartWriter(
            resolved,
            name,
            llm=self.port,
            run=self.run,
            build=lambda part, script: self._build(resolved, part, script + self.ending),
            kernel=self.kernel,
            repairs=self._options["repairs"],
            looks=self._options.get("look", False),
            memory=self.memory,
            documentation=self.documentation,
        )
        self.made[name] = _Made(digest, answers + self._options["repairs"] + 1, None)  # until it is made: the addresses that may be used
        given = None if asked is None else asked.result().get(name)
        written = writer.make(answered=answers, previous=previous, given=given, standing=standing)
        assert written.realised.script is not None
        self.made[name] = _Made(digest, written.answers, written.realised.script, written.opinions)
        self.announce(name, "built")

    def _shown(self, script: bytes) -> str:
        return f"```python\n{script.removesuffix(self.ending).decode()}```"

    def _build(self, resolved: ResolvedPlan, name: str, script: bytes) -> RealisedPart:
        """Build a script; a connector that is off is taken into the plan if that is valid, else the script must be corrected.

        The script must also be corrected where a connector's feature is absent.
        """
        with self._building:
            part = build_source(resolved, name, script, kernel=self.kernel, cache=self.cache, deflection=DEFLECTION_MM)
        wrong = Findings(finding for finding in part.findings if finding.code in SENT_BACK)
        drifted = set(wrong.codes) == {"W_CONNECTOR_DRIFT"} and self._options.get("finetune")
        if not wrong or (drifted and absorbed(resolved, {name: part}) is not None):
            return part
        raise ContractError("\n".join(map(str, wrong)), findings=wrong, parts=(name,))


def _unbuilt(name: str, finding: Finding) -> str:
    if finding.route == "design":
        return finding.message
    return f"Every script for {name} broke its contract; the last one ended with {finding.code}: {finding.message}"


def _as_error(code: str) -> str:
    return code if (worse := f"E_{code[2:]}") not in CODES else worse


def _raise_failures(futures: Mapping[str, Future[None]], total: int) -> None:
    """Raise the failures of all parts at once; an error of the model has priority."""
    errors = {name: error for name, future in futures.items() if (error := future.exception()) is not None}
    for error in errors.values():
        if not isinstance(error, ArticadError) or (isinstance(error, AgentError) and not isinstance(error, OutputError)):
            raise error
    if errors:
        raise PartsError({name: error for name, error in errors.items() if isinstance(error, ArticadError)}, total)
