"""Tasks: what is asked for, and the checks that say whether it was made."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, Literal

from pydantic import Field, ValidationError

from articad.bench.checks import AnyCheck, Judgement
from articad.bench.subject import Subject
from articad.errors import ReadError, did_you_mean
from articad.plan.fields import Form

TASKS: Final = Path(__file__).with_name("tasks")
"""The project's own tasks, a folder each."""

Kind = Literal["articulated", "static", "industrial", "hard"]


class Edit(Form):
    """A change that is asked for once the product stands; every check must hold again with its new numbers.

    Attributes:
        prompt: What is to change.
        checks: In place of those before; `unchanged` counts the parts that stayed the same to the last bit.
    """

    prompt: str
    checks: tuple[AnyCheck, ...]


class Task(Form):
    """One task of the benchmark.

    Attributes:
        name: Unique.
        kind: Which of the four sets it belongs to.
        product: What it is, in a word or two: at most three tasks are of the same product.
        prompt: What is asked for; empty where pictures alone say it.
        images: Files beside the task.
        checks: All must hold.
        edit: A change afterwards.
        reference: Folder of a plan with part scripts that passes, relative to the task; or "example:NAME".
    """

    form: Literal["articad.task/1"] = Field(default="articad.task/1", alias="schema")
    name: str
    kind: Kind
    product: str
    prompt: str = ""
    images: tuple[str, ...] = ()
    checks: tuple[AnyCheck, ...]
    edit: Edit | None = None
    reference: str | None = "reference"

    @property
    def modality(self) -> Literal["text", "image", "both"]:
        """What it is asked by."""
        return "both" if self.prompt and self.images else "image" if self.images else "text"

    def judge(self, subject: Subject) -> tuple[Judgement, ...]:
        """Return what every check says."""
        return tuple(check.judge(subject) for check in self.checks)


def read_task(folder: str | Path) -> Task:
    """Read `task.json` of a folder.

    Raises:
        ReadError: If it is missing, no JSON, or not of the form; says which field.
    """
    file = Path(folder) / "task.json"
    try:
        return Task.model_validate(json.loads(file.read_text(encoding="utf-8")))
    except OSError as error:
        raise ReadError.told(file, f"There is no task: {error.strerror}.", "Name a folder with a task.json.") from error
    except ValidationError as error:
        first: Any = error.errors()[0]
        where = ".".join(str(step) for step in first["loc"])
        raise ReadError.told(file, f"{where}: {first['msg']}.", "Correct the field.") from error
    except ValueError as error:
        raise ReadError.told(file, f"It is no JSON: {error}.", "Correct it there.") from error


def tasks_in(folder: str | Path = TASKS, *, names: Sequence[str] = (), kind: Kind | None = None) -> list[tuple[Path, Task]]:
    """Return the tasks below a folder, by name.

    Raises:
        ReadError: If one cannot be read, or a name is unknown.
    """
    found = {task.name: (path, task) for path, task in _all(Path(folder))}
    for name in names:
        if name not in found:
            raise ReadError.told(
                Path(folder), f"There is no task {name!r}.", did_you_mean(name, list(found)).strip() or f"There are {len(found)} tasks."
            )
    return [found[name] for name in (names or sorted(found)) if kind is None or found[name][1].kind == kind]


def _all(folder: Path) -> Iterator[tuple[Path, Task]]:
    for file in sorted(folder.glob("**/task.json")):
        yield file.parent, read_task(file.parent)
