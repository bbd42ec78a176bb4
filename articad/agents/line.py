"""The pipeline: the steps of every run, with one edge back from the findings of the checks to whoever must fix them.

The variants of the pipeline and edits of a finished run are subclasses that begin elsewhere or leave steps out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final, Protocol

from articad.agents import brainstorm, ranges
from articad.agents.brainstorm import Alternative
from articad.agents.design import DOUBTS, Designer, listed
from articad.agents.evidence import Evidence, examine
from articad.agents.inspection import Verdict, inspect, verdict_of
from articad.agents.llm import Image, closed_port
from articad.agents.part_builder import Complained, PartBuilder, PartsError
from articad.agents.pictures import offence_picture
from articad.agents.requirements import Requirements, analyse
from articad.agents.retrieval import Memory
from articad.agents.review import review
from articad.agents.rollback import Repair, Router
from articad.assembly import Assembly
from articad.findings import Finding, Findings
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.record import record_assembly, record_checks, record_export

_SHOWN_PLACES: Final = 3  # pictures of places of findings that one agent gets at once

Chooser = Callable[[Sequence[Alternative]], tuple[int, str]]
"""Given alternatives, returns the number of the chosen one, from 1, and who chose: "user" or "articad"."""


class PlanAuthor(Protocol):
    """Whoever makes plans of one product."""

    def first(self) -> AssemblyPlan:
        """Return a plan without errors."""
        ...

    def again(
        self, plan: AssemblyPlan, findings: Iterable[Finding], *, pictures: Sequence[Image] = (), stubborn: Iterable[Finding] = ()
    ) -> AssemblyPlan:
        """Return another plan, after this one was built and findings resulted."""
        ...


class Line:
    """One run in progress: the steps in order, with the edge back.

    Attributes:
        asked: What inspectors are told was requested.
    """

    def __init__(self, builder: PartBuilder, chooser: Chooser, memory: Memory | None) -> None:
        self.builder, self.run, self.port, self.chooser, self.memory = builder, builder.run, builder.port, chooser, memory
        self.options: Mapping[str, Any] = builder.run.request.options
        self.rounds = 1 if self.options.get("variant") == "no-rollback" else int(self.options["rounds"])
        self.router = Router(self.port)
        self.asked = builder.run.request
        self.versions = 0
        self.repaired: tuple[int, Repair] | None = None

    def work(self) -> None:
        """Run all steps.

        Raises:
            ArticadError: The error of whatever step fails.
        """
        requirements = self.requirements()
        planner = self.planner(requirements)
        plan = planner.first()
        for number in range(1, self.rounds + 1):
            last = number == self.rounds
            self._save(plan)
            try:
                plan, assembly = self._assembled(plan)
            except PartsError as failed:
                repair = self._decided(number, failed.for_design, plan, every=True)
                if last or repair.stalled:
                    raise
                plan = self._designed_again(planner, plan, repair, None)
                continue
            evidence, verdict = self._judged(assembly, requirements, number)
            if last or not self.router.due(verdict.findings):
                break
            repair = self._decided(number, verdict.findings, plan)
            if repair.stalled:
                self._give_up(verdict, repair)
                break
            self._complain(assembly, repair)
            if repair.design:
                plan = self._designed_again(planner, plan, repair, assembly)
            else:
                self.builder.announce("parts", f"again, round {number + 1}")
        self.finish(assembly, evidence, requirements)

    # ------------------------------------------------------------------ steps that variants replace

    def requirements(self) -> Requirements:
        """Return the analysis of the request."""
        self.builder.announce("requirements", "started")
        ideas = self.options.get("ideas", "never")
        requirements = None if ideas == "always" else analyse(self.run.request, self.port)
        if requirements is None or (ideas == "auto" and requirements.open_ended):
            requirements = analyse(self.run.request, self.port, concept=self._concept())
        self.run.save_requirements(requirements.to_json())
        self.builder.announce("requirements", "read")
        return requirements

    def planner(self, requirements: Requirements) -> PlanAuthor:
        """Return who makes the plans."""
        tries, tell = self.options["designs"], self.tell_of_plan
        self.builder.announce("design", "started")
        return Designer(self.run.request, requirements, self.port, tries=tries, tell=tell, memory=self.memory)

    def examined(self, assembly: Assembly) -> Evidence:
        """Return the measurements of an assembly."""
        return examine(assembly)

    def to_be_answered(self, assembly: Assembly, evidence: Evidence, requirements: Requirements) -> Findings:
        """Return warnings that someone must answer once, before models look: faults of joints, and motions of the analysis that no joint makes."""
        return evidence.faults_of_joints + ranges.built(assembly, requirements.motions)

    def finish(self, assembly: Assembly, evidence: Evidence, requirements: Requirements | None) -> None:
        """Review the result if requested, and write the exports."""
        if "review" in self.options:
            self.builder.announce("review", "started")
            who = self.port if self.options["review"] == "model" else None
            self.run.save_review(review(self.run, assembly, evidence, self.asked, requirements, who))
            self.builder.announce("review", "written")
        with closed_port("exports are deterministic"):
            for name in self.options["formats"]:
                record_export(self.run, assembly, name)
                self.builder.announce(f"export {name}", "written")

    def tell_of_plan(self, plan: AssemblyPlan | None, findings: Findings) -> None:
        """Note the findings of an answer of the planner."""
        for finding in findings:
            self.run.trace_finding(finding)
        self.router.noted(findings.of("W_MOTION_RANGE"))
        what = "unreadable" if plan is None else f"{len(plan.parts)} parts, {len(plan.joints)} joints"
        self.builder.announce("design", f"{what}, {len(findings.errors)} errors")

    def _concept(self) -> Alternative:
        """Return the product to make for an open request."""
        self.builder.announce("brainstorm", "started")
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
        self.builder.announce("brainstorm", f"{concept.name}, chosen by {by} of {len(alternatives)}")
        return concept

    # ------------------------------------------------------------------ one round

    def _save(self, plan: AssemblyPlan) -> None:
        """Save a plan that differs from the last one as its next version."""
        text = plan.dumps()
        if self.versions == 0 or text != self.run.plan_text():
            self.run.save_plan(text, self.versions)
            self.versions += 1

    def _assembled(self, plan: AssemblyPlan) -> tuple[AssemblyPlan, Assembly]:
        self.builder.announce("parts", "started")
        try:
            plan, assembly = self.builder.assembled(plan)
        finally:
            if self.repaired is not None:
                number, repair = self.repaired
                self.run.save_round(number, repair.to_json(number, self.builder.fates))
        self._save(plan)
        with closed_port("assembly and checks are deterministic"):
            record_assembly(self.run, assembly)
        self.builder.announce("assembly", "made")
        self.builder.announce("parts", "made")
        return plan, assembly

    def _judged(self, assembly: Assembly, requirements: Requirements, number: int) -> tuple[Evidence, Verdict]:
        """Return the measurements and the verdict: what geometry finds, and if that finds nothing, what models see."""
        with closed_port("assembly and checks are deterministic"):
            evidence = self.examined(assembly)
            record_checks(self.run, evidence.checks)
            faults = self.to_be_answered(assembly, evidence, requirements)
            doubts = faults + assembly.findings.of(*DOUBTS)
        self.builder.announce("check", "ok" if evidence.ok else f"{len(evidence.findings.errors)} errors")
        verdict = verdict_of(evidence, number)
        if not self.options.get("inspection", False):
            return evidence, replace(verdict, findings=verdict.findings + self.builder.opinions + doubts)
        if evidence.ok and (number == self.rounds or not self.router.due(faults)):
            self.builder.announce("inspection", "started")
            verdict = inspect(assembly, evidence, self.asked, requirements, self.port, number=number)
            self.builder.announce("inspection", "ok" if verdict.ok else f"{len(verdict.findings.errors)} errors")
        verdict = replace(verdict, findings=verdict.findings + self.builder.opinions + doubts)
        self._save_verdict(verdict)
        return evidence, verdict

    def _save_verdict(self, verdict: Verdict) -> None:
        self.run.save_verdict(verdict.to_json())
        for finding in verdict.findings:
            self.run.trace_finding(finding)

    # ------------------------------------------------------------------ the edge back

    def _decided(self, number: int, findings: Findings, plan: AssemblyPlan, *, every: bool = False) -> Repair:
        repair = self.router.decide(number, findings, resolve(plan), self.builder.scripts, every=every)
        self.repaired = number, repair
        return repair

    def _complain(self, assembly: Assembly, repair: Repair) -> None:
        """Pass on to the authors of scripts the findings about their parts, with pictures."""
        for name, findings in repair.code.items():
            pictures = _places(assembly, findings, most=1)
            self.builder.complaints[name] = Complained(listed(findings), pictures[0] if pictures else None, may_stand=findings.ok)

    def _designed_again(self, planner: PlanAuthor, plan: AssemblyPlan, repair: Repair, assembly: Assembly | None) -> AssemblyPlan:
        self.builder.announce("design", "again")
        pictures = () if assembly is None else _places(assembly, repair.design, most=_SHOWN_PLACES)
        return planner.again(plan, repair.design, pictures=pictures, stubborn=repair.stubborn)

    def _give_up(self, verdict: Verdict, repair: Repair) -> None:
        """Record the findings for which nothing more is tried."""
        stalled = [
            Finding(
                code="W_STALLED",
                where=finding.where,
                parts=finding.parts,
                message=f"{finding.code} came back after every strategy.",
                hint="Correct the plan or the script by hand and use `articad build`.",
            )
            for finding in repair.stalled
        ]
        self.builder.announce("rollback", "stalled")
        verdict = replace(verdict, findings=verdict.findings + stalled)
        if self.options.get("inspection", False):
            self._save_verdict(verdict)


def _places(assembly: Assembly, findings: Iterable[Finding], *, most: int) -> tuple[Image, ...]:
    """Return pictures of the first places of findings, one for each set of parts."""
    first = {frozenset(finding.parts): finding for finding in reversed(list(findings))}
    drawn = (offence_picture(assembly, finding) for finding in reversed(first.values()))
    return tuple(picture for picture in drawn if picture is not None)[:most]
