"""The table of a benchmark: the share of tasks that pass everything first, and what each cost; intervals by bootstrap."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from articad_bench.check import Judgement
from articad_bench.numbers import mean_of, share_of
from articad_bench.row import Row

SCHEMA: Final = "articad.bench/1"


def table(rows: Sequence[Row]) -> dict[str, Any]:
    """Return the report `articad.bench/1` of a benchmark's rows: the whole, by kind of task, by what they were asked, by kind of check."""
    kinds = sorted({row.kind for row in rows})
    checks = sorted({judgement.kind for row in rows for judgement in row.judgements})
    return {
        "schema": SCHEMA,
        "ok": True,
        "findings": [],
        "tasks": len(rows),
        "all": summary(rows),
        "by_kind": {kind: summary([row for row in rows if row.kind == kind]) for kind in kinds},
        "by_modality": {way: summary([row for row in rows if row.modality == way]) for way in sorted({row.modality for row in rows})},
        "by_check": {kind: share_of([j.ok for row in rows for j in row.judgements if j.kind == kind]) for kind in checks},
        "rows": [_line(row) for row in rows],
    }


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Return shares and means over some rows, each with the ends of its 95 % interval."""
    return {
        "tasks": len(rows),
        "passed": share_of([row.ok for row in rows]),
        "made": share_of([row.made for row in rows]),
        "checks": mean_of([_held(row.judgements) for row in rows]),
        "edited": share_of([row.edit_ok for row in rows if row.edit_ok is not None]),
        "edit_checks": mean_of([sum(map(_held, row.edited)) / row.edits for row in rows if row.edits]),
        "iterations": mean_of([row.iterations for row in rows]),
        "calls": mean_of([row.calls for row in rows]),
        "tokens": mean_of([row.tokens for row in rows]),
        "cost_usd": None if any(row.cost is None for row in rows) else mean_of([row.cost or 0.0 for row in rows]),
    }


def _held(judgements: Sequence[Judgement]) -> float:
    """Return the share of a task's checks that hold; none where nothing was made."""
    return sum(judgement.ok for judgement in judgements) / len(judgements) if judgements else 0.0


def _line(row: Row) -> dict[str, Any]:
    return {
        "task": row.task,
        "kind": row.kind,
        "modality": row.modality,
        "passed": row.ok,
        "made": row.made,
        "failed": list(row.failed),
        "error": row.error,
        "edited": row.edit_ok,
        "edit_error": row.edit_error,
        "iterations": row.iterations,
        "calls": row.calls,
        "tokens": row.tokens,
        "cost_usd": row.cost,
    }
