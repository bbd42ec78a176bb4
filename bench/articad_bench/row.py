"""Rows: what came of each task, each in a separate file, so that a killed benchmark can resume."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from articad.runs.run import write_atomically
from articad_bench.checks import Judgement
from articad_bench.task import Task, read_json

SCHEMA: Final = "articad.bench-row/1"
ROW: Final = "row.json"
_MADE: Final = frozenset({"parts", "solids"})
_JUDGED: Final = ("judgements", "edited")


@dataclass(frozen=True)
class Row:
    """The result of one task.

    Attributes:
        task: Its name.
        kind: Of the task.
        modality: What it was asked by.
        edit: Whether the task includes an edit.
        judgements: Of every check; none if nothing was made.
        edited: Of every check of the edited product; none if there is none.
        error: Why nothing was made.
        edit_error: Why nothing was edited.
        iterations: Answers with a plan or a script that were needed, beyond one for each plan and part, plus one; an edit's likewise.
        calls: Answers of models.
        tokens: In and out.
        cost: US dollars; None where a price is unknown.
        seconds: Wall time.
        key: Digest of the task and the way it was run.
    """

    task: str
    kind: str
    modality: str
    edit: bool = False
    judgements: tuple[Judgement, ...] = ()
    edited: tuple[Judgement, ...] = ()
    error: str | None = None
    edit_error: str | None = None
    iterations: int = 0
    calls: int = 0
    tokens: int = 0
    cost: float | None = 0.0
    seconds: float = 0.0
    key: str = ""

    @classmethod
    def of(cls, task: Task, key: str = "") -> Row:
        """Return the row of a task before anything is made."""
        return cls(task.name, task.kind, task.modality, task.edit is not None, key=key)

    @property
    def made(self) -> bool:
        """The paper's success: it was built, with all the parts that were asked for."""
        return self.error is None and all(judgement.ok for judgement in self.judgements if judgement.kind in _MADE)

    @property
    def edit_ok(self) -> bool | None:
        """Whether every check holds of the edited product; None where no edit is asked for."""
        return self.edit_error is None and bool(self.edited) and all(judgement.ok for judgement in self.edited) if self.edit else None

    @property
    def ok(self) -> bool:
        """True when every check holds, and every check of the edit."""
        stands = self.error is None and bool(self.judgements) and all(judgement.ok for judgement in self.judgements)
        return stands and self.edit_ok is not False

    @property
    def failed(self) -> tuple[str, ...]:
        """Kinds of the checks that do not hold, those of the edit as "edit:KIND"."""
        first = (judgement.kind for judgement in self.judgements if not judgement.ok)
        return (*first, *(f"edit:{judgement.kind}" for judgement in self.edited if not judgement.ok))

    def to_json(self) -> dict[str, Any]:
        """Return the row as it is kept."""
        rows = {name: value for name, value in vars(self).items() if name not in _JUDGED}
        return {"schema": SCHEMA, "ok": self.ok} | rows | {name: [each.to_json() for each in getattr(self, name)] for name in _JUDGED}

    @classmethod
    def from_json(cls, stored: dict[str, Any]) -> Row:
        """Read a row that was kept."""
        judged: dict[str, Any] = {name: tuple(Judgement(**judgement) for judgement in stored[name]) for name in _JUDGED}
        return cls(**{name: stored[name] for name in cls.__dataclass_fields__ if name not in _JUDGED}, **judged)


def kept_row(place: Path, key: str) -> Row | None:
    """Return the row of a task's folder, if it was made of the same task in the same way."""
    try:
        row = Row.from_json(read_json(place / ROW))
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return row if row.key == key else None


def keep_row(place: Path, row: Row) -> None:
    """Write a task's row, whole or not at all."""
    place.mkdir(parents=True, exist_ok=True)
    write_atomically(place / ROW, (json.dumps(row.to_json(), indent=1, ensure_ascii=False) + "\n").encode())


def rows_in(out: str | Path, names: Sequence[str] = ()) -> list[Row]:
    """Return the rows that a folder of runs holds, by name."""
    files = sorted(Path(out).glob(f"*/{ROW}"))
    rows = [Row.from_json(read_json(file)) for file in files]
    return [row for row in rows if not names or row.task in names]
