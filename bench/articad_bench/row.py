"""Rows: what came of each task, each in a separate file, so that a killed benchmark can resume."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from articad.errors import ReadError
from articad.runs.run import write_atomically
from articad_bench.checks import Judgement
from articad_bench.task import Task, read_record

SCHEMA: Final = "articad.bench-row/2"
ROW: Final = "row.json"
_JUDGEMENTS: Final = [{"kind": str, "ok": bool, "wanted": str, "measured": str}]
_FORM: Final = {
    **dict.fromkeys(("task", "kind", "modality", "key"), str),
    **dict.fromkeys(("edits", "iterations", "calls", "tokens"), int),
    **dict.fromkeys(("error", "edit_error"), (str, None)),
    "judgements": _JUDGEMENTS,
    "edited": [_JUDGEMENTS],
    "cost": (float, None),
    "seconds": float,
}
"""What this program relies on of a row that somebody else may have written."""
_MADE: Final = frozenset({"parts", "solids"})


@dataclass(frozen=True)
class Row:
    """The result of one task.

    Attributes:
        task: Its name.
        kind: Of the task.
        modality: What it was asked by.
        edits: How many edits the task has.
        judgements: Of every check; none if nothing was made.
        edited: Of every check of the product after each edit that was made.
        error: Why nothing was made.
        edit_error: Why the edit after these was not made, nor those that follow it.
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
    edits: int = 0
    judgements: tuple[Judgement, ...] = ()
    edited: tuple[tuple[Judgement, ...], ...] = ()
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
        return cls(task.name, task.kind, task.modality, len(task.edits), key=key)

    @property
    def made(self) -> bool:
        """The paper's success: it was built, with all the parts that were asked for."""
        return self.error is None and all(judgement.ok for judgement in self.judgements if judgement.kind in _MADE)

    @property
    def edit_ok(self) -> bool | None:
        """Whether every check holds of the product after every edit; None where no edit is asked for."""
        return len(self.edited) == self.edits and all(_all_hold(stage) for stage in self.edited) if self.edits else None

    @property
    def ok(self) -> bool:
        """True when every check holds, and every check of every edit."""
        return self.error is None and _all_hold(self.judgements) and self.edit_ok is not False

    @property
    def failed(self) -> tuple[str, ...]:
        """Kinds of the checks that do not hold, those of the first edit as "edit_1:KIND"."""
        first = [judgement.kind for judgement in self.judgements if not judgement.ok]
        later = [f"edit_{number}:{each.kind}" for number, stage in enumerate(self.edited, start=1) for each in stage if not each.ok]
        return (*first, *later)

    def to_json(self) -> dict[str, Any]:
        """Return the row as it is kept."""
        judged = {"judgements": _stored(self.judgements), "edited": [_stored(stage) for stage in self.edited]}
        return {"schema": SCHEMA, "ok": self.ok} | vars(self) | judged

    @classmethod
    def from_json(cls, stored: dict[str, Any]) -> Row:
        """Read a row that was kept."""
        judged = {"judgements": _read(stored["judgements"]), "edited": tuple(_read(stage) for stage in stored["edited"])}
        return cls(**{name: stored[name] for name in cls.__dataclass_fields__} | judged)


def _all_hold(judgements: Sequence[Judgement]) -> bool:
    return bool(judgements) and all(judgement.ok for judgement in judgements)


def _stored(judgements: Sequence[Judgement]) -> list[dict[str, Any]]:
    return [judgement.to_json() for judgement in judgements]


def _read(stored: Sequence[dict[str, Any]]) -> tuple[Judgement, ...]:
    return tuple(Judgement(*(each[name] for name in ("kind", "ok", "wanted", "measured"))) for each in stored)


def kept_row(place: Path, key: str) -> Row | None:
    """Return the row of a task's folder, if it was made of the same task in the same way."""
    try:
        row = Row.from_json(read_record(place / ROW, _FORM))
    except ReadError:
        return None
    return row if row.key == key else None


def keep_row(place: Path, row: Row) -> None:
    """Write a task's row, whole or not at all."""
    place.mkdir(parents=True, exist_ok=True)
    write_atomically(place / ROW, (json.dumps(row.to_json(), indent=1, ensure_ascii=False) + "\n").encode())


def rows_in(out: str | Path, names: Sequence[str] = ()) -> list[Row]:
    """Return the rows that a folder of runs holds, by name.

    Raises:
        ReadError: If one is not what a run of the benchmark writes.
    """
    files = sorted(Path(out).glob(f"*/{ROW}"))
    rows = [Row.from_json(read_record(file, _FORM)) for file in files]
    return [row for row in rows if not names or row.task in names]
