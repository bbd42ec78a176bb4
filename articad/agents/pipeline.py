"""The pipeline: a request in, a run directory with a checked and exported assembly out.

One straight line, requirements - design - parts - assembly - checks - exports, with one edge back: what the checks find
goes to the designer, and only parts whose entry changed are written anew. A killed run is gone on with by the same call:
every answer that was paid for is in the run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Final, Literal

from articad.agents import brainstorm
from articad.agents.brainstorm import Alternative, Choose
from articad.agents.design import TRIES, Designer, listed
from articad.agents.evidence import examine
from articad.agents.generation import REPAIRS
from articad.agents.inspection import Verdict, inspect, verdict_of
from articad.agents.llm import LLM, Image, Recorded, Replay, closed_port
from articad.agents.pictures import offence_picture
from articad.agents.recollection import KeptDocumentation, KeptMemory
from articad.agents.requirements import Requirements, analyse
from articad.agents.retrieval import Documentation, Memory
from articad.agents.rollback import Repair, Router
from articad.agents.workshop import PartsError, Progress, Workshop
from articad.assembly import Assembly
from articad.errors import AgentError
from articad.findings import Finding, Findings
from articad.kernels.kernel import BuildCache, PartKernel
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.record import kernel_named, record_assembly, record_checks, record_export
from articad.run import Run, RunRequest, UserImage, differences, open_or_create

ROUNDS: Final = 3
FORMATS: Final = ("urdf", "mjcf")
Variant = Literal["full", "no-rollback", "no-memory"]
Brainstorm = Literal["auto", "always", "never"]
_SHOWN_PLACES = 3  # pictures of offending places that one agent gets at once

Chooser = Callable[[Sequence[Alternative]], tuple[int, str]]
"""Given alternatives, returns the number of the chosen one, from 1, and who chose: "user" or "articad"."""


def generate(
    prompt: str,
    *,
    llm: LLM,
    images: Iterable[str | Path | bytes] = (),
    part_images: Mapping[str, str | Path | bytes] | None = None,
    out: str | Path | None = None,
    kernel: PartKernel | None = None,
    sandbox: Literal["strict", "weak"] = "strict",
    cache: BuildCache | None = None,
    formats: Sequence[str] = FORMATS,
    designs: int = TRIES,
    repairs: int = REPAIRS,
    rounds: int = ROUNDS,
    look: bool = True,
    inspection: bool = True,
    ideas: Brainstorm = "auto",
    pick: int | None = None,
    choose: Choose | None = None,
    variant: Variant = "full",
    memory: Memory | None = None,
    documentation: Documentation | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Run:
    """Make an articulated assembly of words, pictures or both.

    Called again with the same arguments and the same `out`, it goes on where it was interrupted and repeats no call.

    Args:
        prompt: What is wanted.
        llm: Who answers; wrap it in `Budget` to limit calls, tokens, money or time.
        images: Pictures of what is wanted, PNG, JPEG, GIF or WebP.
        part_images: Pictures of single parts, by the part's name; they reach only that part's requests.
        out: The run directory; by default a new one under `runs/`.
        kernel: Builds the part scripts; build123d by default.
        sandbox: "weak" accepts less isolation than landlock or bwrap give.
        cache: Keeps built parts; by default `$ARTICAD_CACHE` or `~/.cache/articad`.
        formats: What to export.
        designs: Answers until a plan must validate.
        repairs: How often a failed part script may be mended.
        rounds: How often parts are assembled and checked; what the last check finds stays in the report.
        look: Whether a model compares each part's pictures with its specification. It must see.
        inspection: Whether a model observes the assembly in pictures, and one judges it. It must see.
        ideas: Whether alternatives are proposed first: "auto" where the request leaves open what is to be built.
        pick: The alternative to make, from 1; asks for alternatives in any case.
        choose: Called with the alternatives, returns the number of the one to make; without it and `pick` the first is made.
        variant: "no-rollback" neither looks nor judges, and sends nothing back that was assembled: the paper's ablation.
        memory: What earlier runs teach; nothing by default.
        documentation: What the kernel's API says; nothing by default.
        jobs: How many parts are built at once; by default the number of processors.
        progress: Told of each stage and part.

    Returns:
        The run, closed: `run.path`, `run.checks()`, `articad.record.assembly_of(run)`.

    Raises:
        PlanError: If no valid plan came of all tries.
        ContractError: If a part could not be built.
        AgentError: If the model cannot be asked, the budget is spent or answers have no form. Finished work is kept.
    """
    pictures = [UserImage.read(image) for image in images]
    pictures += [UserImage.read(image, part) for part, image in sorted((part_images or {}).items())]
    kernel = kernel or kernel_named("build123d", sandbox=sandbox)
    rolls_back = variant != "no-rollback"
    memory = None if variant == "no-memory" else memory
    options: dict[str, Any] = {"task": "generate", "designs": designs, "repairs": repairs, "rounds": rounds, "formats": list(formats)}
    options |= {"kernel": kernel.name, "variant": variant, "look": look and rolls_back, "inspection": inspection and rolls_back}
    options |= {"ideas": "always" if pick is not None else ideas, "pick": pick, "finetune": True}
    request = RunRequest(prompt=prompt, images=tuple(pictures), options=options)
    with open_or_create(request, out) as run:
        known, told = KeptMemory(run, memory), KeptDocumentation(run, documentation)
        shop = Workshop(run, Recorded(llm, run), kernel, cache or BuildCache(), jobs, progress, known, told)
        _Line(shop, partial(_chosen_by_user, pick, choose), known).work()
    return run


def _chosen_by_user(pick: int | None, choose: Choose | None, alternatives: Sequence[Alternative]) -> tuple[int, str]:
    """Return the alternative that was asked for, or the first."""
    if pick is None and choose is None:
        return 1, "articad"
    number = pick if pick is not None else choose(alternatives) if choose is not None else 1
    if not 1 <= number <= len(alternatives):
        names = ", ".join(f"{at} {one.name}" for at, one in enumerate(alternatives, 1))
        raise AgentError(f"There is no alternative {number}; there are {names}.")
    return number, "user"


@dataclass(frozen=True)
class Replayed:
    """A recording, made again.

    Attributes:
        run: The new run, closed.
        differences: Files, the trace apart, that are not equal to the recording's.
        findings: Prompts that differ from the recorded ones.
    """

    run: Run
    differences: tuple[str, ...]
    findings: Findings

    @property
    def ok(self) -> bool:
        """Whether every file but the trace is the same."""
        return not self.differences


def replay(
    recording: str | Path,
    *,
    out: str | Path | None = None,
    strict: bool = False,
    kernel: PartKernel | None = None,
    sandbox: Literal["strict", "weak"] = "strict",
    cache: BuildCache | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Replayed:
    """Make a recorded run again, from its replies and what was retrieved for it: no key, no network, no store.

    Args:
        recording: The run to repeat.
        out: Where to; by default a new directory under `runs/`.
        strict: Refuse a prompt that is not the recorded one, instead of reporting it.
        kernel: As for `generate`.
        sandbox: As for `generate`.
        cache: As for `generate`; `BuildCache(None)` builds every part anew.
        jobs: As for `generate`.
        progress: As for `generate`.

    Raises:
        ReplayMissError: If a reply is missing, or when strict, a prompt differs.
        ArticadError: As `generate`.
    """
    source = Run.view(recording)
    answers = Replay(source, strict=strict)
    with Run.create(source.request, out=out, version=source.version) as run:
        kernel = kernel or kernel_named(str(source.request.options.get("kernel", "build123d")), sandbox=sandbox)
        known, told = KeptMemory(run, recorded=source), KeptDocumentation(run, recorded=source)
        shop = Workshop(run, Recorded(answers, run), kernel, cache or BuildCache(), jobs, progress, known, told)
        _Line(shop, partial(_chosen_before, source), known).work()
        for finding in answers.findings:
            run.trace_finding(finding)
    return Replayed(run, tuple(differences(source, run)), answers.findings)


def _chosen_before(recording: Run, alternatives: Sequence[Alternative]) -> tuple[int, str]:
    """Return the alternative that was chosen when a run was recorded."""
    stored = recording.alternatives() or {"chosen": 1, "by": "articad"}
    return min(int(stored["chosen"]), len(alternatives)), str(stored["by"])


class _Line:
    """One run at work: the straight line with its edge back."""

    def __init__(self, shop: Workshop, chooser: Chooser, memory: Memory | None) -> None:
        self.shop, self.run, self.port, self.chooser, self.memory = shop, shop.run, shop.port, chooser, memory
        self.options: Mapping[str, Any] = shop.run.request.options
        self.rounds = 1 if self.options.get("variant") == "no-rollback" else int(self.options["rounds"])
        self.router = Router(self.port)
        self.versions = 0
        self.repaired: tuple[int, Repair] | None = None

    def work(self) -> None:
        requirements = self._requirements()
        tries, tell = self.options["designs"], self._tell_of_plan
        self.shop.tell("design", "started")
        designer = Designer(self.run.request, requirements, self.port, tries=tries, tell=tell, memory=self.memory)
        plan = designer.first()
        for number in range(1, self.rounds + 1):
            last = number == self.rounds
            self._save(plan)
            try:
                plan, assembly = self._assembled(plan)
            except PartsError as failed:
                repair = self._decided(number, failed.for_design, plan)
                if last or repair.stalled:
                    raise
                plan = self._designed_again(designer, plan, repair, None)
                continue
            verdict = self._judged(assembly, requirements, number)
            if last or not self.router.due(verdict.findings):
                break
            repair = self._decided(number, verdict.findings, plan)
            if repair.stalled:
                self._give_up(verdict, repair)
                break
            self._complain(assembly, repair)
            if repair.design:
                plan = self._designed_again(designer, plan, repair, assembly)
            else:
                self.shop.tell("parts", f"again, round {number + 1}")
        with closed_port("exports are deterministic"):
            for name in self.options["formats"]:
                record_export(self.run, assembly, name)
                self.shop.tell(f"export {name}", "written")

    # ------------------------------------------------------------------ what is wanted

    def _requirements(self) -> Requirements:
        self.shop.tell("requirements", "started")
        ideas = self.options.get("ideas", "never")
        requirements = None if ideas == "always" else analyse(self.run.request, self.port)
        if requirements is None or (ideas == "auto" and requirements.open_ended):
            requirements = analyse(self.run.request, self.port, concept=self._concept())
        self.run.save_requirements(requirements.to_json())
        return requirements

    def _concept(self) -> Alternative:
        """Return what an open request shall become."""
        self.shop.tell("brainstorm", "started")
        alternatives, findings = brainstorm.propose(self.run.request, self.port)
        for finding in findings:
            self.run.trace_finding(finding)
        stored = self.run.alternatives()
        if stored is not None and stored == brainstorm.to_json(alternatives, stored["chosen"], stored["by"]):
            chosen, by = int(stored["chosen"]), str(stored["by"])  # a resumed run does not ask again
        else:
            chosen, by = self.chooser(alternatives)
            self.run.save_alternatives(brainstorm.to_json(alternatives, chosen, by))
        concept = alternatives[chosen - 1]
        self.shop.tell("brainstorm", f"{concept.name}, chosen by {by} of {len(alternatives)}")
        return concept

    # ------------------------------------------------------------------ one round

    def _save(self, plan: AssemblyPlan) -> None:
        """Keep a plan that differs from the last one as its next version."""
        text = plan.dumps()
        if self.versions == 0 or text != self.run.plan_text():
            self.run.save_plan(text, self.versions)
            self.versions += 1

    def _assembled(self, plan: AssemblyPlan) -> tuple[AssemblyPlan, Assembly]:
        self.shop.tell("parts", "started")
        try:
            plan, assembly = self.shop.assembled(plan)
        finally:
            if self.repaired is not None:
                number, repair = self.repaired
                self.run.save_round(number, repair.to_json(number, self.shop.fates))
        self._save(plan)
        with closed_port("assembly and checks are deterministic"):
            record_assembly(self.run, assembly)
        return plan, assembly

    def _judged(self, assembly: Assembly, requirements: Requirements, number: int) -> Verdict:
        """Return what is wrong with an assembly: what geometry finds, and where that finds nothing, what models see."""
        with closed_port("assembly and checks are deterministic"):
            evidence = examine(assembly)
            record_checks(self.run, evidence.checks)
        self.shop.tell("check", "ok" if evidence.ok else f"{len(evidence.findings.errors)} errors")
        if not self.options.get("inspection", False):
            return verdict_of(evidence, number)
        verdict = verdict_of(evidence, number)
        if evidence.ok:
            self.shop.tell("inspection", "started")
            verdict = inspect(assembly, evidence, self.run.request, requirements, self.port, number=number)
            self.shop.tell("inspection", "ok" if verdict.ok else f"{len(verdict.findings.errors)} errors")
        verdict = replace(verdict, findings=verdict.findings + self.shop.opinions)
        self._save_verdict(verdict)
        return verdict

    def _save_verdict(self, verdict: Verdict) -> None:
        self.run.save_verdict(verdict.to_json())
        for finding in verdict.findings:
            self.run.trace_finding(finding)

    # ------------------------------------------------------------------ the edge back

    def _decided(self, number: int, findings: Findings, plan: AssemblyPlan) -> Repair:
        repair = self.router.decide(number, findings, resolve(plan), self.shop.scripts)
        self.repaired = number, repair
        return repair

    def _complain(self, assembly: Assembly, repair: Repair) -> None:
        """Leave for the authors of scripts what was found of their parts, and where."""
        for name, findings in repair.code.items():
            pictures = _places(assembly, findings, most=1)
            self.shop.complaints[name] = listed(findings), pictures[0] if pictures else None

    def _designed_again(self, designer: Designer, plan: AssemblyPlan, repair: Repair, assembly: Assembly | None) -> AssemblyPlan:
        self.shop.tell("design", "again")
        pictures = () if assembly is None else _places(assembly, repair.design, most=_SHOWN_PLACES)
        return designer.again(plan, repair.design, pictures=pictures, stubborn=repair.stubborn)

    def _give_up(self, verdict: Verdict, repair: Repair) -> None:
        """Say that nothing more is tried."""
        stalled = [
            Finding(
                code="W_STALLED",
                where=finding.where,
                parts=finding.parts,
                message=f"{finding.code} came back after every strategy.",
                hint="Mend the plan or the script by hand and use `articad build`.",
            )
            for finding in repair.stalled
        ]
        self.shop.tell("rollback", "stalled")
        verdict = replace(verdict, findings=verdict.findings + stalled)
        if self.options.get("inspection", False):
            self._save_verdict(verdict)

    # ------------------------------------------------------------------ telling

    def _tell_of_plan(self, plan: AssemblyPlan | None, findings: Findings) -> None:
        for finding in findings:
            self.run.trace_finding(finding)
        what = "unreadable" if plan is None else f"{len(plan.parts)} parts, {len(plan.joints)} joints"
        self.shop.tell("design", f"{what}, {len(findings.errors)} errors")


def _places(assembly: Assembly, findings: Iterable[Finding], *, most: int) -> tuple[Image, ...]:
    """Return pictures of the first places of findings, one for each set of parts."""
    first = {frozenset(finding.parts): finding for finding in reversed(list(findings))}
    drawn = (offence_picture(assembly, finding) for finding in reversed(first.values()))
    return tuple(picture for picture in drawn if picture is not None)[:most]
