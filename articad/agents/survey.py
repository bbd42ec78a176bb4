"""Survey: one request that holds the pictures of several parts against their orders.

Exact checks measure connectors, overlaps and motion. They do not see a counterbore on the wrong face, a drawer that is open below, or a
bore that ends before the other side: the solid is valid, and nothing meets.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, Literal, NamedTuple, Self

from pydantic import model_validator

from articad.agents.llm import LLM, Image, system, user
from articad.agents.pictures import part_picture
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of, unusable
from articad.findings import Finding, Findings
from articad.kernels.parts import RealisedPart

TOGETHER: Final = 6  # sheets in one request; more pictures at once are not looked at closely


class Surveyed(ReplyForm):
    """What was seen of one part, and what of it is not as ordered."""

    part: str
    seen: str
    agrees: bool
    fault: Literal["none", "script", "specification"]
    wrong: str
    remedy: str

    @model_validator(mode="after")
    def _says_what_is_wrong(self) -> Self:
        if self.agrees != (self.fault == "none"):
            raise ValueError(f'{self.part}: "fault" is "none" where it agrees, and only there.')
        if not self.agrees and not self.wrong.strip():
            raise ValueError(f'{self.part}: it does not agree, so "wrong" says what is built and what is ordered.')
        return self


class Survey(ReplyForm):
    """Parts held against their orders, each once."""

    parts: tuple[Surveyed, ...]


class Ordered(NamedTuple):
    """A part as ordered and as built."""

    order: str
    realised: RealisedPart


def survey(parts: Mapping[str, Ordered], llm: LLM, *, step: str) -> Findings:
    """Ask a model to compare the pictures of several parts with their orders.

    Args:
        parts: By name, at most `TOGETHER`.
        llm: The model; it must accept images.
        step: Address of the request.

    Returns:
        A warning for each part that is not as ordered, routed to whom the model blames.

    Raises:
        OutputError: If no reply has the required form.
    """
    shown: list[str | Image] = []
    for name, part in parts.items():
        shown += [f"## {name}\n\n{part.order}\n\nAs built:", part_picture(part.realised.part, part.realised.digests["build"])]
    seen = ask(llm, "look", step, (system(prompt("survey")), user(*shown)), _survey_of(parts), schema=schema_of(Survey))
    return Findings(
        Finding(
            code="W_LOOK_SHAPE",
            where=f"parts.{one.part}",
            parts=(one.part,),
            message=f"{one.wrong.strip().rstrip('.')}. Seen: {one.seen.strip().rstrip('.')}.",
            hint=one.remedy,
            route="code" if one.fault == "script" else "design",
        )
        for one in seen.parts
        if not one.agrees
    )


def _survey_of(parts: Mapping[str, Ordered]) -> Callable[[str, str], Survey]:
    """Return a function that reads an answer and rejects one that does not name each part once."""

    def read(text: str, step: str) -> Survey:
        seen = reader(Survey)(text, step)
        named = [one.part for one in seen.parts]
        if sorted(named) != sorted(parts):
            raise unusable(f'"parts" has one entry each for {", ".join(parts)}; it has {", ".join(named) or "none"}.', text, step=step)
        return seen

    return read
