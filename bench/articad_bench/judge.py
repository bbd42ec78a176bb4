"""Judges: models that look at what was made and score it, as in the paper: integers from 1 to 5 for geometry, detail and motion.

Every judge works alone: it describes, compares, goes through the keyframes, then scores and gives a reason for each score. It sees
pictures and the request, not who made the product, nor what was measured. What it said is kept, `judged/<judge>/<task>.json` beside the
models, so that nobody is asked twice.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Self

from pydantic import Field, ValidationError

from articad.agents.inspection import MOTIONS
from articad.agents.llm import LLM, Image, Message, Reply, Request, system, user
from articad.agents.pictures import assembly_picture, motion_picture, part_picture
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of
from articad.errors import ArticadError, OutputError, ReadError, TransportError
from articad.runs.run import digest, write_atomically
from articad_bench.scoring import model_of, subject_of
from articad_bench.subject import Subject
from articad_bench.task import Task, read_image, read_record

SCHEMA: Final = "articad.bench-opinion/1"
DIMENSIONS: Final = ("geometry", "detail", "motion")
PARTS: Final = 8  # that a judge sees one by one
WORST: Final = 1  # what a product scores that was not made
JUDGED: Final = "judged"  # folder beside the models
_FORM: Final = {
    **dict.fromkeys(("task", "kind", "judge", "key"), str),
    **dict.fromkeys(("made", "moves"), bool),
    **dict.fromkeys(("calls", "tokens"), int),
    "opinion": ({}, None),
    "error": (str, None),
    "cost": (float, None),
}
"""What this program relies on of an opinion that somebody else may have written."""
_MEDIA: Final = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".gif": "image/gif", ".webp": "image/webp"}
_MADE: Final = frozenset({"parts", "solids"})

Judges = Mapping[str, Callable[[], LLM]]
"""The judges: by name of the model, a function that returns it; called once for each task."""


class Scored(ReplyForm):
    """A score from 1 to 5, and why."""

    score: int = Field(ge=1, le=5, strict=True)
    reason: str = Field(min_length=1)


class Opinion(ReplyForm):
    """A judge's answer; the order of its fields is the order in which it is thought."""

    parts: str
    comparison: str
    keyframes: str
    geometry: Scored
    detail: Scored
    motion: Scored


@dataclass(frozen=True)
class Judged:
    """A judge's result for one task.

    Attributes:
        task: Its name.
        kind: Of the task.
        judge: Name of the model.
        made: The paper's success: it builds, and has every part that was asked for.
        moves: Whether the task requires that something moves.
        opinion: What the judge said; None if it could not be asked, or there was nothing to be seen.
        error: Why there is no opinion.
        calls: Answers that it took.
        tokens: In and out.
        cost: US dollars; None where the price is unknown.
        key: Digest of what was asked.
    """

    task: str
    kind: str
    judge: str
    made: bool
    moves: bool
    opinion: Opinion | None = None
    error: str | None = None
    calls: int = 0
    tokens: int = 0
    cost: float | None = 0.0
    key: str = ""

    def score(self, dimension: str) -> float | None:
        """Return a score; what was not made scores the worst, and an opinion that is missing is None."""
        if self.opinion is not None:
            return float(getattr(self.opinion, dimension).score)
        return float(WORST) if not self.made else None

    def to_json(self) -> dict[str, Any]:
        """Return the opinion as it is kept."""
        said = None if self.opinion is None else self.opinion.model_dump(mode="json")
        return {"schema": SCHEMA, **vars(self), "opinion": said}

    @classmethod
    def from_json(cls, stored: dict[str, Any]) -> Self:
        """Read an opinion that was kept."""
        said = stored["opinion"]
        rows = {name: stored[name] for name in cls.__dataclass_fields__}
        return cls(**rows | {"opinion": None if said is None else Opinion.model_validate(said)})


def judge_files(
    tasks: Iterable[tuple[Path, Task]], folder: str | Path, judges: Judges, *, progress: Callable[[Judged], object] | None = None
) -> list[Judged]:
    """Have models score what a folder holds: runs of the benchmark, or files of any tool.

    Args:
        tasks: Folders and tasks.
        folder: As for `score_files`; opinions are kept there.
        judges: Who scores.
        progress: Called with each opinion.

    Returns:
        One for each task and judge; opinions that are there are not asked for again.
    """
    found = []
    for place, task in tasks:
        for judged in _of_task(place, task, Path(folder), judges):
            found.append(judged)
            if progress is not None:
                progress(judged)
    return found


def opinions_in(folder: str | Path) -> list[Judged]:
    """Return the opinions that a folder holds, by judge and task.

    Raises:
        ReadError: If one is not what a judging writes.
    """
    files = sorted((Path(folder) / JUDGED).glob("*/*.json"))
    return [_opinion_in(file) for file in files]


def _opinion_in(file: Path) -> Judged:
    try:
        return Judged.from_json(read_record(file, _FORM))
    except ValidationError as error:
        first = error.errors()[0]
        raise ReadError.at(file, f"opinion.{'.'.join(map(str, first['loc']))}: {first['msg']}.", "Remove it, and judge again.") from None


def request_of(place: Path, task: Task, subject: Subject) -> tuple[Message, ...]:
    """Return what a judge is asked."""
    assembly = subject.assembly
    given = [Image(read_image(place, image), _MEDIA.get(Path(image).suffix.lower(), "image/png")) for image in task.images]
    shown: list[str | Image] = [f"The request:\n\n{task.prompt or '(no words; the picture says it)'}"]
    if given:
        shown += ["Pictures that belong to the request:", *given]
    shown += ["The assembly at rest, from four sides:", assembly_picture(assembly)]
    different: dict[str, str] = {}
    for name in subject.shaped:  # one of each shape
        different.setdefault(assembly.parts[name].mesh.digest, name)  # type: ignore[union-attr]
    for shape, name in list(different.items())[:PARTS]:
        shown += [f"Part {name}:", part_picture(assembly.parts[name], shape)]
    joints = assembly.mechanism.driving_joints[:MOTIONS]
    for joint in joints:
        shown += [f"Keyframes of joint {joint}:", motion_picture(assembly, joint)]
    if not joints:
        shown.append("No joint drives: nothing of it moves.")
    return (system(prompt("bench_judge")), user(*shown))


def _of_task(place: Path, task: Task, folder: Path, judges: Judges) -> Iterable[Judged]:
    row = Judged(task.name, task.kind, "", made=False, moves=task.moves)
    try:
        subject = subject_of(model_of(task.name, folder))
        made = all(check.judge(subject).ok for check in task.checks if check.kind in _MADE)
        asked = request_of(place, task, subject)
    except ArticadError as error:
        for judge in judges:
            yield replace(row, judge=judge, error=f"{type(error).__name__}: {error}")
        return
    key = digest([message.to_json() for message in asked])
    for judge, given in judges.items():
        file = folder / JUDGED / _slug(judge) / f"{task.name}.json"
        kept, now = _kept(file, key), replace(row, judge=judge, made=made, key=key)
        if kept is None:
            yield _asked(now, asked, given(), file)
        else:  # the opinion stays; whether every part is there is decided by the task's present checks
            yield replace(kept, kind=now.kind, made=now.made, moves=now.moves)


def _asked(row: Judged, asked: tuple[Message, ...], llm: LLM, file: Path) -> Judged:
    tally = _Tally(llm)
    opinion, problem = None, None
    try:
        opinion = ask(tally, "bench_judge", f"bench_judge/{row.task}", asked, reader(Opinion), schema=schema_of(Opinion))
    except OutputError as error:
        problem = f"{type(error).__name__}: {error}"
    except TransportError as error:  # nothing was said: the next run asks again
        return replace(row, error=f"{type(error).__name__}: {error}")
    costs = [reply.cost for reply in tally.replies]
    judged = replace(
        row,
        opinion=opinion,
        error=problem,
        calls=len(tally.replies),
        tokens=sum(reply.usage.total for reply in tally.replies),
        cost=None if any(cost is None for cost in costs) else sum(cost for cost in costs if cost is not None),
    )
    file.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(file, (json.dumps(judged.to_json(), indent=1, ensure_ascii=False) + "\n").encode())
    return judged


@dataclass
class _Tally:
    """Asks, and keeps what was answered."""

    llm: LLM
    replies: list[Reply] = field(default_factory=list)

    def complete(self, request: Request) -> Reply:
        """Ask."""
        reply = self.llm.complete(request)
        self.replies.append(reply)
        return reply


def _kept(file: Path, key: str) -> Judged | None:
    try:
        judged = _opinion_in(file)
    except ReadError:
        return None
    return judged if judged.key == key else None


def _slug(judge: str) -> str:
    return f"{re.sub(r'[^A-Za-z0-9.-]+', '_', judge)[:48]}_{digest(judge)[:8]}"


def judges_of(rows: Sequence[Judged]) -> tuple[str, ...]:
    """Return the names of the judges, in order of appearance."""
    return tuple(dict.fromkeys(row.judge for row in rows))
