"""Settings of runs: what a run stores of how it is to be made, and what it is given to work with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

from articad.agents.brainstorm import Choose
from articad.agents.design import TRIES
from articad.agents.part_group import TOGETHER
from articad.agents.part_writer import REPAIRS, Looks
from articad.agents.retrieval import Documentation, Memory
from articad.aliases import Progress
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache, PartKernel

Variant = Literal["full", "late", "no-rollback", "no-memory", "single-loop"]
Brainstorm = Literal["auto", "always", "never"]

ROUNDS: Final = 3


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """How a run is made; stored in the run, so that it is resumed and replayed in the same way.

    Attributes:
        formats: Formats to export.
        designs: Answers within which a plan must be valid.
        repairs: How often a failed part script may be repaired.
        rounds: How often parts are assembled and checked; findings of the last check stay in the report.
        look: Whether a model compares a part's pictures with its specification: True for each part in a request of its own, "together" for
            several parts in one request, and alone for those whose first script failed, about whose solid there is a warning, or of
            which you gave a picture. The model must accept images.
        together: Parts whose first scripts are asked for in one request.
        inspection: Whether one model describes the assembly from pictures and one judges it. It must accept images.
        ideas: Whether alternatives are proposed first; "auto" does so if the request leaves open what to build.
        pick: The alternative to make, from 1; alternatives are then always proposed.
        review: Who scores the finished assembly: "rules" uses measurements, "model" also a model that sees pictures.
        variant: The paper's ablations: "late" plans connectors and joints after the parts exist; "no-rollback" neither inspects nor
            judges, and sends nothing back after assembly; "no-memory" recalls no cases. And its baseline: in "single-loop", one script
            makes and assembles all parts, and goes back only if it fails to run.
    """

    formats: Sequence[str] = ("urdf", "mjcf")
    designs: int = TRIES
    repairs: int = REPAIRS
    rounds: int = ROUNDS
    look: Looks = "together"
    together: int = TOGETHER
    inspection: bool = True
    ideas: Brainstorm = "auto"
    pick: int | None = None
    review: Literal["none", "rules", "model"] = "none"
    variant: Variant = "full"


def generate_request(options: RunOptions, kernel: str) -> dict[str, Any]:
    """Return what the request of a new run stores."""
    judged = options.variant not in {"no-rollback", "single-loop"}
    return {
        "task": "generate",
        **_common(options),
        "kernel": kernel,
        "variant": options.variant,
        "look": judged and options.look,
        "inspection": judged and options.inspection,
        "ideas": "always" if options.pick is not None else options.ideas,
        "pick": options.pick,
        "finetune": True,
    }


def edit_request(options: RunOptions, kernel: str, base: str, values: Mapping[str, float], *, worded: bool) -> dict[str, Any]:
    """Return what the request of an edit stores; without words no model looks, judges or plans."""
    return {
        "task": "edit",
        "base": base,
        "set": dict(sorted(values.items())),
        **_common(options),
        "rounds": options.rounds if worded else 1,
        "kernel": kernel,
        "variant": "full",
        "finetune": worded,
        "look": worded and options.look,
        "inspection": worded and options.inspection,
    }


def _common(options: RunOptions) -> dict[str, Any]:
    common = {
        "designs": options.designs,
        "repairs": options.repairs,
        "rounds": options.rounds,
        "together": options.together,
        "formats": list(options.formats),
    }
    return common if options.review == "none" else common | {"review": options.review}  # as in older recordings, which have no reviews


def recalls(variant: str) -> bool:
    """Return whether runs of a variant read earlier ones from memory, and are remembered."""
    return variant not in {"no-memory", "single-loop"}


@dataclass(frozen=True, kw_only=True)
class Services:
    """What a run is given to work with; none of it changes what is asked for.

    Attributes:
        kernel: Builds the part scripts; the one that the run names by default, build123d for a new one.
        sandbox: "weak" accepts less isolation than Landlock or bubblewrap give.
        cache: Keeps built parts; by default `$ARTICAD_CACHE` or `~/.cache/articad`. `BuildCache(None)` builds every part anew.
        choose: Called with the alternatives, returns the number of the one to make; without it and `RunOptions.pick` the first is made.
        memory: Source of cases from earlier runs; none by default.
        documentation: Source of the kernel's API documentation; none by default.
        jobs: How many parts are built at once; by default the number of processors.
        progress: Called at each stage and part.
    """

    kernel: PartKernel | None = None
    sandbox: Literal["strict", "weak"] = "strict"
    cache: BuildCache | None = None
    choose: Choose | None = None
    memory: Memory | None = None
    documentation: Documentation | None = None
    jobs: int | None = None
    progress: Progress | None = None

    def kernel_or(self, name: str) -> PartKernel:
        """Return the kernel, by default the one of a name."""
        return self.kernel or kernel_named(name, sandbox=self.sandbox)
