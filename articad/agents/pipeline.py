"""The pipeline: turns a request into a run directory with a checked and exported assembly.

The steps are requirements - design - parts - assembly - checks - exports, with one edge back: findings of the checks go to the designer,
and only parts whose entry changed are written anew. Calling it again resumes a killed run; paid replies are read back from disk.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from articad.agents.brainstorm import Alternative, Choose
from articad.agents.drift import drift, note
from articad.agents.edit import EditLine, Nobody
from articad.agents.late import LateLine
from articad.agents.line import Chooser, Line
from articad.agents.llm import LLM, Recorded, Replay
from articad.agents.part_builder import PartBuilder
from articad.agents.recollection import KeptDocumentation, KeptMemory
from articad.agents.retrieval import Memory
from articad.agents.settings import RunOptions, Services, generate_request, recalls
from articad.agents.single import SingleLine
from articad.errors import AgentError, RunError
from articad.findings import Findings
from articad.kernels.kernel import BuildCache, PartKernel
from articad.runs.run import Run, RunRequest, UserImage, differences, open_or_create


def generate(
    prompt: str,
    *,
    llm: LLM,
    images: Iterable[str | Path | bytes] = (),
    part_images: Mapping[str, str | Path | bytes] | None = None,
    out: str | Path | None = None,
    options: RunOptions | None = None,
    services: Services | None = None,
) -> Run:
    """Make an articulated assembly from words, pictures or both.

    Calling it again with the same arguments and the same `out` resumes an interrupted run; no call to the model is repeated.

    Args:
        prompt: The request.
        llm: The model; wrap it in `Budget` to limit calls, tokens, money or time.
        images: Pictures of the product, PNG, JPEG, GIF or WebP.
        part_images: Pictures of single parts, by the part's name; they enter only the requests of that part.
        out: The run directory; by default a new one under `runs/`.
        options: How the run is made; stored in it.
        services: What the run is given to work with.

    Returns:
        The run, closed: `run.path`, `run.checks()`, `articad.runs.record.assembly_of(run)`.

    Raises:
        PlanError: If no answer is a valid plan.
        ContractError: If a part could not be built.
        AgentError: If the model cannot be asked, the budget is used up or answers do not have the required form. Finished work is kept.
    """
    options, services = options or RunOptions(), services or Services()
    pictures = [UserImage.read(image) for image in images]
    pictures += [UserImage.read(image, part) for part, image in sorted((part_images or {}).items())]
    kernel = services.kernel_or("build123d")
    request = RunRequest(prompt=prompt, images=tuple(pictures), options=generate_request(options, kernel.name))
    with open_or_create(request, out) as run:
        taught = _taught(run, options.variant, services)
        _work(run, llm, kernel, services, partial(_chosen_by_user, options.pick, services.choose), taught)
    return run


def resume(path: str | Path, *, llm: LLM | None = None, services: Services | None = None) -> Run:
    """Resume an interrupted run of `generate` or `edit`; no call is repeated, no part is built twice.

    The request and its options are stored in the run; the model and its budget are given anew.

    Args:
        path: The run directory.
        llm: As for `generate`; not needed if all answers are stored.
        services: As for `generate`.

    Returns:
        The run, closed; a finished run is returned unchanged.

    Raises:
        RunError: If it is not a run of a model, its request lacks options, or another process works in it.
        PlanError, ContractError, AgentError: As `generate`.
    """
    services = services or Services()
    with Run.open(path) as run:
        options = _options_of(run)
        chooser = partial(_chosen_by_user, options.get("pick"), services.choose)
        kernel = services.kernel_or(options["kernel"])
        _work(run, llm or Nobody(), kernel, services, chooser, _taught(run, options["variant"], services))
    return run


_NEEDED: Final[Mapping[str, type | tuple[type, ...]]] = {
    "designs": int,
    "repairs": int,
    "rounds": int,
    "formats": (list, tuple),
}
_UNSAID: Final[Mapping[str, str | int]] = {
    "kernel": "build123d",
    "variant": "full",
    "together": 1,
}  # of runs begun when there was no choice


def _options_of(run: Run) -> Mapping[str, Any]:
    """Return the options of a model's run; the file is not trusted.

    Raises:
        RunError: Naming the options that are missing.
    """
    options = {**_UNSAID, **run.request.options}
    needed = {**_NEEDED, **{key: type(usual) for key, usual in _UNSAID.items()}}
    wrong = [key for key, kind in needed.items() if not isinstance(options.get(key), kind)]
    if options.get("task") not in {"generate", "edit"}:
        raise RunError.at(run.path, "This run was built from a plan, without a model.", "Repeat `articad build` with the same --out.")
    if wrong:
        raise RunError.at(run.path, f"Its request lacks options: {', '.join(wrong)}.", "Repeat the command that began it.")
    return options


_Taught = tuple[KeptMemory, KeptDocumentation]


def _taught(run: Run, variant: str, services: Services) -> _Taught:
    """Return the memory that a run of a variant may use."""
    memory = services.memory if recalls(variant) else None
    return KeptMemory(run, memory), KeptDocumentation(run, None if variant == "single-loop" else services.documentation)


def _work(run: Run, llm: LLM, kernel: PartKernel, services: Services, chooser: Chooser, taught: _Taught) -> None:
    """Carry out a run's request."""
    note(run, kernel)
    port, cache = Recorded(llm, run), services.cache or BuildCache()
    builder = PartBuilder(run, port, kernel, cache, services.jobs, services.progress, *taught)
    _line(builder, chooser, taught[0]).work()


def _line(builder: PartBuilder, chooser: Chooser, memory: Memory | None) -> Line:
    """Return the pipeline for a run's request."""
    options = builder.run.request.options
    kind = EditLine if options.get("task") == "edit" else _LINES.get(options.get("variant", "full"), Line)
    return kind(builder, chooser, memory)


_LINES: Final[Mapping[str, type[Line]]] = {"late": LateLine, "single-loop": SingleLine}


def _chosen_by_user(pick: int | None, choose: Choose | None, alternatives: Sequence[Alternative]) -> tuple[int, str]:
    """Return the alternative that the user picked, or the first."""
    if pick is None and choose is None:
        return 1, "articad"
    number = pick if pick is not None else choose(alternatives) if choose is not None else 1
    if not 1 <= number <= len(alternatives):
        names = ", ".join(f"{at} {one.name}" for at, one in enumerate(alternatives, 1))
        raise AgentError(f"There is no alternative {number}; there are {names}.")
    return number, "user"


@dataclass(frozen=True)
class Replayed:
    """The replay of a recording.

    Attributes:
        run: The new run, closed.
        differences: Files, except for the trace, that are not equal to the recording's.
        findings: Prompts that differ from the recorded ones; files that differ, by how much, and why.
    """

    run: Run
    differences: tuple[str, ...]
    findings: Findings

    @property
    def ok(self) -> bool:
        """True if every result is the same, or differs only by the rounding of another kernel or platform; prompts may differ."""
        return not self.results_that_differ or (self.findings.ok and "W_REPLAY_DRIFT" in self.findings.codes)

    @property
    def results_that_differ(self) -> tuple[str, ...]:
        """Files that are not equal, except for requests that `findings` reports as changed prompts."""
        steps = (finding.where.removeprefix("llm.") for finding in self.findings.of("I_PROMPT_DRIFT"))
        drifted = {f"llm/{step.replace('/', '.')}.json" for step in steps}
        return tuple(name for name in self.differences if name not in drifted)


def replay(recording: str | Path, *, out: str | Path | None = None, strict: bool = False, services: Services | None = None) -> Replayed:
    """Repeat a recorded run from its replies and its retrieved texts: no key, no network, no store.

    Args:
        recording: The run to repeat.
        out: Where to; by default a new directory under `runs/`.
        strict: Refuse a prompt that differs from the recorded one, instead of reporting it.
        services: As for `generate`; memory and documentation are the recorded ones.

    Raises:
        ReplayMissError: If a reply is missing, or when strict, a prompt differs.
        ArticadError: As `generate`.
    """
    services = services or Services()
    source = Run.view(recording)
    options = _options_of(source)
    answers = Replay(source, strict=strict)
    with Run.create(source.request, out=out, version=source.version) as run:
        if (base := source.base()) is not None:
            run.save_base(base)
        taught = KeptMemory(run, recorded=source), KeptDocumentation(run, recorded=source)
        _work(run, answers, services.kernel_or(options["kernel"]), services, partial(_chosen_before, source), taught)
        for finding in answers.findings:
            run.trace_finding(finding)
    different = tuple(differences(source, run))
    return Replayed(run, different, Findings((*answers.findings, *drift(source, run, different))))


def _chosen_before(recording: Run, alternatives: Sequence[Alternative]) -> tuple[int, str]:
    """Return the alternative that was chosen when a run was recorded."""
    stored = recording.alternatives() or {"chosen": 1, "by": "articad"}
    return min(int(stored["chosen"]), len(alternatives)), str(stored["by"])
