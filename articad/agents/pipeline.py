"""The pipeline: a request in, a run directory with a checked and exported assembly out.

One straight line, requirements - design - parts - assembly - checks - exports, with one edge back: what the checks find
goes to the designer, and only parts whose entry changed are written anew. A killed run is gone on with by the same call:
every answer that was paid for is in the run.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

from articad.agents.design import TRIES, Designer
from articad.agents.evidence import examine
from articad.agents.generation import REPAIRS, Attempt, Modeller, failure_text
from articad.agents.llm import LLM, Recorded, Replay, closed_port
from articad.agents.requirements import Requirements, analyse
from articad.assembly import DEFLECTION_MM, Assembly
from articad.errors import AgentError, ArticadError, ContractError, KernelError
from articad.findings import Findings
from articad.kernels.kernel import BuildCache, PartKernel
from articad.kernels.parts import RealisedPart, build_parts, build_source
from articad.plan.brief import brief_digest
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan
from articad.record import kernel_named, record_assembly, record_checks, record_export
from articad.run import Run, RunRequest, UserImage, differences, open_or_create

ROUNDS: Final = 3
FORMATS: Final = ("urdf", "mjcf")
_CALLS_AT_ONCE = 8  # parts that are asked for side by side; a model's answer takes minutes, and providers limit the rate

Progress = Callable[[str, str], None]
"""Called with a stage or a part and what became of it; from several threads."""


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
    options = {"task": "generate", "designs": designs, "repairs": repairs, "rounds": rounds, "formats": list(formats)}
    request = RunRequest(prompt=prompt, images=tuple(pictures), options=options)
    with open_or_create(request, out) as run:
        workshop = _Workshop(run, llm, kernel or kernel_named("build123d", sandbox=sandbox), cache or BuildCache(), jobs, progress)
        workshop.work()
    return run


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
    """Make a recorded run again, from its replies alone: no key, no network.

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
        kernel = kernel or kernel_named("build123d", sandbox=sandbox)
        _Workshop(run, answers, kernel, cache or BuildCache(), jobs, progress).work()
        for finding in answers.findings:
            run.trace_finding(finding)
    return Replayed(run, tuple(differences(source, run)), answers.findings)


@dataclass
class _Made:
    """A part that was made: with which entry of the plan, by which answer, and as what."""

    brief: str
    script: bytes
    answers: int


@dataclass
class _Workshop:
    """One run at work."""

    run: Run
    llm: LLM
    kernel: PartKernel
    cache: BuildCache
    jobs: int | None
    progress: Progress | None
    made: dict[str, _Made] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.port = Recorded(self.llm, self.run)
        self.building = threading.Semaphore(self.jobs or os.cpu_count() or 1)
        self.options: Mapping[str, Any] = self.run.request.options

    def work(self) -> None:
        requirements = self._requirements()
        designer = Designer(self.run.request, requirements, self.port, tries=self.options["designs"], tell=self._tell_of_plan)
        self._tell("design", "started")
        plan = designer.first()
        for number in range(self.options["rounds"]):
            self.run.save_plan(plan.dumps(), number)
            assembly = self._assembled(plan)
            with closed_port("assembly and checks are deterministic"):
                record_assembly(self.run, assembly)
                checks = examine(assembly)
                record_checks(self.run, checks)
            self._tell("check", "ok" if checks.ok else f"{len(checks.findings.errors)} errors")
            if checks.ok or number + 1 == self.options["rounds"]:
                break
            self._tell("design", f"again, round {number + 2}")
            plan = designer.again(plan, checks.findings)
        with closed_port("exports are deterministic"):
            for name in self.options["formats"]:
                record_export(self.run, assembly, name)
                self._tell(f"export {name}", "written")

    # ------------------------------------------------------------------ stages

    def _requirements(self) -> Requirements:
        self._tell("requirements", "started")
        requirements = analyse(self.run.request, self.port)
        self.run.save_requirements(requirements.to_json())
        return requirements

    def _assembled(self, plan: AssemblyPlan) -> Assembly:
        """Return the assembly of a plan: parts kept whose entry did not change, the others written, side by side."""
        resolved = resolve(plan)
        self._tell("parts", "started")
        sources = [name for name, part in resolved.parts.items() if part.derivation is None]
        with ThreadPoolExecutor(max_workers=min(_CALLS_AT_ONCE, len(sources))) as pool:
            futures = {name: pool.submit(self._make, resolved, name) for name in sources}
        _raise_failures(futures, len(sources))
        self._tell("assembly", "started")
        scripts = {name: self.made[name].script for name in sources}
        with closed_port("assembly is deterministic"):
            realised = build_parts(resolved, scripts, kernel=self.kernel, cache=self.cache, deflection=DEFLECTION_MM, jobs=self.jobs)
            return Assembly.from_realised(resolved, realised, kernel=self.kernel)

    def _make(self, resolved: ResolvedPlan, name: str) -> None:
        """Make one part, or keep it as it is."""
        digest, old = brief_digest(resolved, name), self.made.get(name)
        answers, previous = 0, None
        if old is not None:
            answers = old.answers
            if old.brief == digest:
                try:
                    self._build(resolved, name, old.script)
                except KernelError as error:
                    previous = _attempt(old.script, error)
                else:
                    self._tell(name, "kept")
                    return
        self._tell(name, "started")
        modeller = Modeller(
            resolved,
            name,
            llm=self.port,
            run=self.run,
            build=lambda part, script: self._build(resolved, part, script),
            kernel=self.kernel,
            repairs=self.options["repairs"],
        )
        realised, answers = modeller.make(answered=answers, previous=previous)
        assert realised.script is not None
        self.made[name] = _Made(digest, realised.script, answers)
        self._tell(name, "built")

    def _build(self, resolved: ResolvedPlan, name: str, script: bytes) -> RealisedPart:
        """Build a script; where a person is warned of connectors that are off, a model is asked to build them in place."""
        with self.building:
            part = build_source(resolved, name, script, kernel=self.kernel, cache=self.cache, deflection=DEFLECTION_MM)
        if drift := part.findings.of("W_CONNECTOR_DRIFT"):
            raise ContractError("\n".join(map(str, drift)), findings=drift, parts=(name,))
        return part

    # ------------------------------------------------------------------ telling

    def _tell(self, what: str, event: str) -> None:
        self.run.trace("stage", name=what, state=event)
        if self.progress is not None:
            self.progress(what, event)

    def _tell_of_plan(self, plan: AssemblyPlan | None, findings: Findings) -> None:
        for finding in findings:
            self.run.trace_finding(finding)
        what = "unreadable" if plan is None else f"{len(plan.parts)} parts, {len(plan.joints)} joints"
        self._tell("design", f"{what}, {len(findings.errors)} errors")


def _attempt(script: bytes, error: KernelError) -> Attempt:
    """Return a kept script that no longer builds as an answer that did not do."""
    return Attempt(f"```python\n{script.decode()}```", f"The specification has changed since. {failure_text(error)}", error=error)


def _raise_failures(futures: Mapping[str, Future[None]], total: int) -> None:
    """Raise what went wrong with the parts, all of it at once; a model that cannot be asked goes first."""
    errors = {name: error for name, future in futures.items() if (error := future.exception()) is not None}
    for error in errors.values():
        if not isinstance(error, ArticadError) or (isinstance(error, AgentError) and not error.findings.of("E_REPLY_SCHEMA")):
            raise error
    if errors:
        findings = Findings(finding for error in errors.values() if isinstance(error, ArticadError) for finding in error.findings)
        lines = [f"{len(errors)} of {total} parts could not be made.", *(f"{name}: {error}" for name, error in errors.items())]
        raise ContractError("\n".join(lines), findings=findings, parts=tuple(errors))
