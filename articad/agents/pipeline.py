"""The pipeline: a request in, a run directory with a checked and exported assembly out.

One straight line, requirements - design - parts - assembly - checks - exports, with one edge back: what the checks find
goes to the designer, and only parts whose entry changed are written anew. A killed run is gone on with by the same call:
every answer that was paid for is in the run.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final, Literal

from articad.agents.brainstorm import Alternative, Choose
from articad.agents.design import TRIES
from articad.agents.drift import drift, note
from articad.agents.edit import EditLine, Nobody
from articad.agents.late import LateLine
from articad.agents.line import FORMATS, ROUNDS, Chooser, Line
from articad.agents.llm import LLM, Recorded, Replay
from articad.agents.part_builder import PartBuilder, Progress
from articad.agents.part_writer import REPAIRS
from articad.agents.recollection import KeptDocumentation, KeptMemory
from articad.agents.retrieval import Documentation, Memory
from articad.agents.single import SingleLine
from articad.errors import AgentError, RunError
from articad.findings import Findings
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache, PartKernel
from articad.runs.run import Run, RunRequest, UserImage, differences, open_or_create

Variant = Literal["full", "late", "no-rollback", "no-memory", "single-loop"]
Brainstorm = Literal["auto", "always", "never"]


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
    review: Literal["none", "rules", "model"] = "none",
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
        review: Who scores the finished assembly: "rules" what was measured, "model" also one that sees.
        variant: The paper's ablations: "late" plans connectors and joints when the parts exist; "no-rollback" neither looks nor
            judges, and sends nothing back that was assembled; "no-memory" recalls no cases; and its baseline: "single-loop" has
            one script make and assemble all parts, and only what fails to run goes back.
        memory: What earlier runs teach; nothing by default.
        documentation: What the kernel's API says; nothing by default.
        jobs: How many parts are built at once; by default the number of processors.
        progress: Told of each stage and part.

    Returns:
        The run, closed: `run.path`, `run.checks()`, `articad.runs.record.assembly_of(run)`.

    Raises:
        PlanError: If no valid plan came of all tries.
        ContractError: If a part could not be built.
        AgentError: If the model cannot be asked, the budget is spent or answers have no form. Finished work is kept.
    """
    pictures = [UserImage.read(image) for image in images]
    pictures += [UserImage.read(image, part) for part, image in sorted((part_images or {}).items())]
    kernel = kernel or kernel_named("build123d", sandbox=sandbox)
    rolls_back = variant not in {"no-rollback", "single-loop"}
    options: dict[str, Any] = {"task": "generate", "designs": designs, "repairs": repairs, "rounds": rounds, "formats": list(formats)}
    options |= {"kernel": kernel.name, "variant": variant, "look": look and rolls_back, "inspection": inspection and rolls_back}
    options |= {"ideas": "always" if pick is not None else ideas, "pick": pick, "finetune": True}
    options |= {} if review == "none" else {"review": review}  # not asked for, it is not mentioned: older recordings stay what they are
    request = RunRequest(prompt=prompt, images=tuple(pictures), options=options)
    with open_or_create(request, out) as run:
        taught = _taught(run, variant, memory, documentation)
        _work(run, llm, kernel, cache, partial(_chosen_by_user, pick, choose), taught, jobs, progress)
    return run


def resume(
    path: str | Path,
    *,
    llm: LLM | None = None,
    sandbox: Literal["strict", "weak"] = "strict",
    kernel: PartKernel | None = None,
    cache: BuildCache | None = None,
    choose: Choose | None = None,
    memory: Memory | None = None,
    documentation: Documentation | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Run:
    """Go on with a run of `generate` or `edit` where it was interrupted; no call is repeated, no part built twice.

    What was asked for, and how, stands in the run; who answers and what may be spent is said anew.

    Args:
        path: The run directory.
        llm: As for `generate`; not needed where all answers are there.
        sandbox: As for `generate`.
        kernel: As for `generate`; the one that the run asked for by default.
        cache: As for `generate`.
        choose: As for `generate`.
        memory: As for `generate`.
        documentation: As for `generate`.
        jobs: As for `generate`.
        progress: As for `generate`.

    Returns:
        The run, closed; a finished one as it was.

    Raises:
        RunError: If there is no run of a model's, its request lacks options, or another process works in it.
        PlanError, ContractError, AgentError: As `generate`.
    """
    with Run.open(path) as run:
        options = _options_of(run)
        kernel = kernel or kernel_named(options["kernel"], sandbox=sandbox)
        chooser = partial(_chosen_by_user, options.get("pick"), choose)
        _work(run, llm or Nobody(), kernel, cache, chooser, _taught(run, options["variant"], memory, documentation), jobs, progress)
    return run


_NEEDED: Final[Mapping[str, type | tuple[type, ...]]] = {
    "designs": int,
    "repairs": int,
    "rounds": int,
    "formats": (list, tuple),
}
_UNSAID: Final[Mapping[str, str]] = {"kernel": "build123d", "variant": "full"}  # of runs that were begun when there was no other


def _options_of(run: Run) -> Mapping[str, Any]:
    """Return the options of a model's run, which somebody else may have written.

    Raises:
        RunError: Naming what is missing.
    """
    options = {**_UNSAID, **run.request.options}
    wrong = [key for key, kind in {**_NEEDED, **dict.fromkeys(_UNSAID, str)}.items() if not isinstance(options.get(key), kind)]
    if options.get("task") not in {"generate", "edit"}:
        raise RunError.at(run.path, "No model was asked for it: it was built.", "Repeat `articad build` with the same --out.")
    if wrong:
        raise RunError.at(run.path, f"Its request lacks options: {', '.join(wrong)}.", "Repeat the command that began it.")
    return options


_Taught = tuple[KeptMemory, KeptDocumentation]


def recalls(variant: str) -> bool:
    """Return whether runs of a variant are told of earlier ones, and remembered."""
    return variant not in {"no-memory", "single-loop"}


def _taught(run: Run, variant: str, memory: Memory | None, documentation: Documentation | None) -> _Taught:
    """Return what a run of a variant may look up."""
    memory = memory if recalls(variant) else None
    return KeptMemory(run, memory), KeptDocumentation(run, None if variant == "single-loop" else documentation)


def _work(
    run: Run,
    llm: LLM,
    kernel: PartKernel,
    cache: BuildCache | None,
    chooser: Chooser,
    taught: _Taught,
    jobs: int | None,
    progress: Progress | None,
) -> None:
    """Do what a run's request asks for."""
    note(run, kernel)
    builder = PartBuilder(run, Recorded(llm, run), kernel, cache or BuildCache(), jobs, progress, *taught)
    _line(builder, chooser, taught[0]).work()


def _line(builder: PartBuilder, chooser: Chooser, memory: Memory | None) -> Line:
    """Return the line that a run's request asks for."""
    options = builder.run.request.options
    kind = EditLine if options.get("task") == "edit" else _LINES.get(options.get("variant", "full"), Line)
    return kind(builder, chooser, memory)


_LINES: Final[Mapping[str, type[Line]]] = {"late": LateLine, "single-loop": SingleLine}


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
        findings: Prompts that differ from the recorded ones; what of the files differs, by how much, and why.
    """

    run: Run
    differences: tuple[str, ...]
    findings: Findings

    @property
    def ok(self) -> bool:
        """Whether every result is the same, or differs by another kernel's or platform's rounding alone; prompts may have changed since."""
        return not self.results_that_differ or (self.findings.ok and "W_REPLAY_DRIFT" in self.findings.codes)

    @property
    def results_that_differ(self) -> tuple[str, ...]:
        """Files that are not equal, without the requests that `findings` tells of as drifted prompts."""
        steps = (finding.where.removeprefix("llm.") for finding in self.findings.of("I_PROMPT_DRIFT"))
        drifted = {f"llm/{step.replace('/', '.')}.json" for step in steps}
        return tuple(name for name in self.differences if name not in drifted)


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
    options = _options_of(source)
    answers = Replay(source, strict=strict)
    with Run.create(source.request, out=out, version=source.version) as run:
        if (base := source.base()) is not None:
            run.save_base(base)
        kernel = kernel or kernel_named(options["kernel"], sandbox=sandbox)
        taught = KeptMemory(run, recorded=source), KeptDocumentation(run, recorded=source)
        _work(run, answers, kernel, cache, partial(_chosen_before, source), taught, jobs, progress)
        for finding in answers.findings:
            run.trace_finding(finding)
    different = tuple(differences(source, run))
    return Replayed(run, different, Findings((*answers.findings, *drift(source, run, different))))


def _chosen_before(recording: Run, alternatives: Sequence[Alternative]) -> tuple[int, str]:
    """Return the alternative that was chosen when a run was recorded."""
    stored = recording.alternatives() or {"chosen": 1, "by": "articad"}
    return min(int(stored["chosen"]), len(alternatives)), str(stored["by"])
