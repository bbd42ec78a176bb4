"""Tasks: what is asked for, and the checks that say whether it was made.

A task is a folder with `task.json`, pictures that it is asked by, and a reference solution that passes its checks: `reference/plan.json`
with `reference/parts/*.py`. A task with `edits` continues once the product is finished, one change after the other:

    "edits": [
     {
      "prompt": "Make the drawers 20 % deeper; all else stays.",
      "checks": [
       {"kind": "size", "mm": [600, 480, null]},
       {"kind": "unchanged", "number": [6, 99]}
      ],
      "values": {"depth": 480}
     }
    ]

The product is judged at each stage: as it is first, and after each edit. An edited product must pass the checks of its edit, and again all
checks of the stage before that are of other kinds. So an edit that restates one check of a kind restates all of that kind. `unchanged`
counts the parts whose shape is the same to the last bit as at the stage before. `values` make the change in the reference: parameters of
its plan, in the unit that it gives them; `reference` is another folder with `plan.json`, for changes that numbers alone cannot make. What
it lacks, the plan or some `parts/*.py`, is taken from the reference of the stage before.

A task with `given` begins with a product that is there, a folder like `reference`, and asks for a change of it. Then `given` is the stage
before the first.

A task that is posed by a picture names it, and says how it is drawn from the reference:

    "images": ["drawing.png"],
    "drawing": {"parts": ["shelf"], "notes": ["All boards are 18 mm thick."]}

`articad bench draw --task NAME` draws it: measures of the whole, what each joint does and how far, the sides of the named parts, and
the notes, so that even with an empty prompt nothing that is checked has to be guessed. Two other forms have several pictures:

    "images": ["sheet_1.png", "sheet_2.png"],                                    the assembly with its notes, then each part
    "drawing": {"form": "sheets", "section": ["y", 0], "notes": ["The studs are screwed in."]}

    "images": ["photo_1.jpg", "photo_2.jpg", "photo_3.jpg", "photo_4.jpg"],      from four sides; the last one on its way
    "drawing": {"form": "photos", "moved": 0.7}
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, BeforeValidator, Field, ValidationError

from articad.bounds import TEXT_BYTES, TEXT_VALUES, values_in
from articad.errors import ReadError, did_you_mean
from articad.files import RECORD_BYTES, read_file
from articad.plan.fields import PlanObject
from articad.processes import scratch
from articad.runs.forms import misfit
from articad_bench.checks import AnyCheck, Judgement
from articad_bench.heading import judged, names_direction
from articad_bench.plausible import plausible
from articad_bench.subject import Subject

TASKS: Final = Path(__file__).with_name("tasks")
"""The project's own tasks, a folder each."""

Kind = Literal["articulated", "static", "industrial", "hard", "separating"]

_MOVING: Final = frozenset({"freedoms", "joints", "loops", "ratio", "rise", "travel", "clear_in_motion", "certified"})
"""Kinds of checks that say that something moves."""


class Drawing(PlanObject):
    """How a task's pictures are drawn from its reference solution, by `articad bench draw`.

    Attributes:
        form: `overview`, one picture with the measures of the whole; `sheets`, dimensioned drawings of the assembly and of each part;
            `photos`, four pictures without any numbers.
        views: Keys of `articad.render.VIEWS`; those straight on tell the measures of the whole.
        legend: Whether joints get letters and are told below: what each does, how far, and what it is coupled to.
        parts: Parts of the reference whose sides are told.
        notes: What else is written below, or on the sheet of the assembly.
        section: Of sheets: the axis that a section through the assembly is square to, and where on it the plane lies [mm].
        moved: Of photos: how far the drivers are on the fourth one, from rest to their farther ends.
    """

    form: Literal["overview", "sheets", "photos"] = "overview"
    views: tuple[str, ...] = ("iso", "front", "right", "top")
    legend: bool = True
    parts: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    section: tuple[Literal["x", "y"], float] | None = None
    moved: Annotated[float, Field(ge=0, le=1)] = 0.0


def _is_name(text: str) -> str:
    if not text or set(text) <= {"."} or any(sign in text for sign in "/\\\0"):
        raise ValueError("a name without folders is needed")
    return text


_Name = Annotated[str, AfterValidator(_is_name)]
_Checks = Annotated[tuple[AnyCheck, ...], BeforeValidator(plausible)]


class TaskBudget(PlanObject):
    """What a run of a task may use, all its stages together; tokens differ by provider, so characters are counted.

    Attributes:
        calls: Requests to models.
        characters: Of the texts of requests and answers together.
    """

    calls: int | None = Field(default=None, gt=0)
    characters: int | None = Field(default=None, gt=0)

    def __str__(self) -> str:
        told = [f"{self.calls} calls"] if self.calls else []
        return ", ".join([*told, f"{self.characters} characters"] if self.characters else told)


class Edit(PlanObject):
    """A change that is asked for once the product stands; every check must hold again with its new numbers.

    Attributes:
        prompt: What is to change.
        checks: In place of those of the stage before of the same kinds; its others must hold once more as they are.
        values: Of the reference's parameters, in their own units, that make the change.
        reference: Folder beside `task.json` with another plan that makes the change, where numbers do not.
    """

    prompt: str
    checks: _Checks
    values: dict[str, float] = Field(default_factory=dict)
    reference: _Name | None = None


class Task(PlanObject):
    """One task of the benchmark.

    Attributes:
        name: Unique.
        kind: Which of the five sets it belongs to.
        product: What it is, in a word or two: at most three tasks are of the same product.
        prompt: What is asked for; empty where pictures alone say it.
        images: Files beside the task.
        drawing: How `drawing.png`, which is one of them, is drawn.
        checks: All must hold.
        given: Folder beside `task.json` with the product that the task begins with, and that the prompt asks to change; or "example:NAME".
        edits: Changes afterwards, one after the other.
        budget: What a run may use; unlimited by default.
        reference: Folder beside `task.json` with a plan and part scripts that pass; or "example:NAME".
        unheld: Stretches of the texts with numbers that no check holds, each with the reason; see `articad_bench.sentences`.
        left_open: What the reference has and another product need not have, each with the reason: a part that an edit changes, or
            a side of it, such as "stand along x", or a feature, such as "screw: cut 1". No cheat is made of these; see `articad_bench.feature_cheats`.
    """

    form: Literal["articad.task/1"] = Field(default="articad.task/1", alias="schema")
    name: _Name
    kind: Kind
    product: str
    prompt: str = ""
    images: tuple[_Name, ...] = ()
    drawing: Drawing | None = None
    checks: _Checks
    given: _Name | None = None
    edits: tuple[Edit, ...] = ()
    budget: TaskBudget | None = None
    reference: _Name | None = "reference"
    unheld: dict[str, str] = Field(default_factory=dict)
    left_open: dict[str, str] = Field(default_factory=dict)

    @property
    def modality(self) -> Literal["text", "image", "both"]:
        """What it is asked by."""
        return "both" if self.prompt and self.images else "image" if self.images else "text"

    @property
    def moves(self) -> bool:
        """Whether the task requires that something moves."""
        if self.kind == "static":
            return False
        return any(check.kind in _MOVING and getattr(check, "number", 1) not in (0, (0, 0)) for check in self.checks)

    @property
    def stages(self) -> tuple[tuple[AnyCheck, ...], ...]:
        """What must hold at first, and after each edit: the edit's checks, and those of the stage before of all other kinds."""
        found = [self.checks]
        for edit in self.edits:
            restated = {check.kind for check in edit.checks}
            found.append((*(check for check in found[-1] if check.kind not in restated), *edit.checks))
        return tuple(found)

    @property
    def may_turn(self) -> bool:
        """Whether the product may stand turned by quarters about the upright axis: nothing is there before, and no text names a level axis."""
        notes = () if self.drawing is None else self.drawing.notes
        return self.given is None and not names_direction([self.prompt, *(edit.prompt for edit in self.edits), *notes])

    def judge(self, subject: Subject, stage: int = 0) -> tuple[Judgement, ...]:
        """Return what every check says of the product at a stage, the first by default; the subject holds what it was at the stage before."""
        return judged(self.stages[stage], subject, free=self.may_turn)


def read_json(file: Path) -> Any:
    """Return what a JSON file of somebody's tasks, runs or results holds: a regular file within bounds, and no link.

    Raises:
        OSError: If it is missing or refused.
        ValueError: If it is not JSON, or has more values than any.
    """
    content = read_file(file, TEXT_BYTES, root=file.parent)
    if values_in(content) > TEXT_VALUES:
        raise ValueError(f"it has more than {TEXT_VALUES} values")
    try:
        return json.loads(content)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


def read_record(file: Path, form: Any) -> Any:
    """Return a record of somebody's results that has a form of `articad.runs.forms`.

    Raises:
        ReadError: If it cannot be read, or does not have the form; says where.
    """
    hint = "Remove it, and run or judge the task again: `articad bench run --task NAME`, `articad bench judge`."
    try:
        value = read_json(file)
    except (OSError, ValueError) as error:
        raise ReadError.at(file, f"It cannot be read: {getattr(error, 'strerror', None) or error}.", hint) from None
    if wrong := misfit(value, form):
        raise ReadError.at(file, f"It is no record of the benchmark: {wrong} is missing or is something else.", hint)
    return value


def read_image(folder: Path, name: str) -> bytes:
    """Return a picture of a task. Pictures are sent to models, so it lies in the task's folder, and no link leads to it.

    Raises:
        ReadError: If it is missing or refused.
    """
    try:
        return read_file(folder / name, RECORD_BYTES, root=folder)
    except OSError as error:
        raise ReadError.at(folder / name, f"The picture cannot be read: {error.strerror}.", "Put a file there.") from None


def read_task(folder: str | Path) -> Task:
    """Read `task.json` of a folder.

    Raises:
        ReadError: If it is missing, no JSON, or not of the form; says which field.
    """
    file = Path(folder) / "task.json"
    try:
        return Task.model_validate(read_json(file))
    except OSError as error:
        raise ReadError.at(file, f"There is no task: {error.strerror}.", "Name a folder with a task.json.") from error
    except ValidationError as error:
        first: Any = error.errors()[0]
        where = ".".join(str(step) for step in first["loc"])
        raise ReadError.at(file, f"{where}: {first['msg']}.", "Correct the field.") from error
    except ValueError as error:
        raise ReadError.at(file, f"It is not JSON: {error}.", "Correct it there.") from error


def write_task(task: Task, folder: Path, *, beside: Path) -> tuple[Path, Task]:
    """Write a task that was made of other data, with its pictures; return it with its folder.

    Args:
        task: What to write.
        folder: Where to.
        beside: Where its pictures are.
    """
    for image in task.images:
        scratch.write(folder / image, read_image(beside, image))
    scratch.write(folder / "task.json", as_stored(task))
    return folder, task


def as_stored(task: Task) -> bytes:
    """Return the text of a task's `task.json`: without values that are the default, but each check with its kind."""
    row = {"schema": task.form} | task.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    row["checks"] = checks_as_stored(task.checks)
    for stored, edit in zip(row.get("edits", ()), task.edits, strict=True):
        stored["checks"] = checks_as_stored(edit.checks)
    return f"{json.dumps(row, indent=1, ensure_ascii=False)}\n".encode()


def checks_as_stored(checks: Sequence[AnyCheck]) -> list[dict[str, Any]]:
    """Return checks as a task stores them."""
    return [{"kind": check.kind} | check.model_dump(mode="json", exclude_defaults=True) for check in checks]


def tasks_in(folder: str | Path = TASKS, *, names: Sequence[str] = (), kind: Kind | None = None) -> list[tuple[Path, Task]]:
    """Return the tasks below a folder, by name.

    Raises:
        ReadError: If one cannot be read, or a name is unknown.
    """
    found = {task.name: (path, task) for path, task in _all(Path(folder))}
    for name in names:
        if name not in found:
            raise ReadError.at(
                Path(folder), f"There is no task {name!r}.", did_you_mean(name, list(found)).strip() or f"There are {len(found)} tasks."
            )
    return [found[name] for name in (names or sorted(found)) if kind is None or found[name][1].kind == kind]


def _all(folder: Path) -> Iterator[tuple[Path, Task]]:
    for file in sorted(folder.glob("**/task.json")):
        yield file.parent, read_task(file.parent)
