"""The table of a benchmark: the share of tasks that pass everything first, and what each cost; intervals by bootstrap."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from articad.bench.agreement import bootstrap_interval
from articad.bench.row import Row

SCHEMA: Final = "articad.bench/1"


def table(rows: Sequence[Row]) -> dict[str, Any]:
    """Return the report `articad.bench/1` of a benchmark's rows: the whole, by kind of task, and by kind of check."""
    kinds = sorted({row.kind for row in rows})
    checks = sorted({judgement.kind for row in rows for judgement in row.judgements})
    return {
        "schema": SCHEMA,
        "ok": True,
        "findings": [],
        "tasks": len(rows),
        "all": summary(rows),
        "by_kind": {kind: summary([row for row in rows if row.kind == kind]) for kind in kinds},
        "by_check": {kind: _share([j.ok for row in rows for j in row.judgements if j.kind == kind]) for kind in checks},
        "rows": [_line(row) for row in rows],
    }


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Return shares and means over some rows, each with the ends of its 95 % interval."""
    return {
        "tasks": len(rows),
        "passed": _share([row.ok for row in rows]),
        "made": _share([row.made for row in rows]),
        "checks": _share([judgement.ok for row in rows for judgement in row.judgements]),
        "edited": _share([row.edit_ok for row in rows if row.edit_ok is not None]),
        "edit_checks": _share([judgement.ok for row in rows for judgement in row.edited]),
        "iterations": _mean(rows, lambda row: row.iterations),
        "calls": _mean(rows, lambda row: row.calls),
        "tokens": _mean(rows, lambda row: row.tokens),
        "cost_usd": None if any(row.cost is None for row in rows) else _mean(rows, lambda row: row.cost or 0.0),
    }


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


def _share(values: Sequence[bool]) -> dict[str, Any]:
    low, high = bootstrap_interval([float(value) for value in values])
    return {"mean": _rounded(float(np.mean(values)) if values else math.nan), "interval": [_rounded(low), _rounded(high)], "n": len(values)}


def _mean(rows: Sequence[Row], of: Callable[[Row], float]) -> dict[str, Any]:
    values = [of(row) for row in rows]
    low, high = bootstrap_interval(values)
    return {"mean": _rounded(float(np.mean(values)) if values else math.nan), "interval": [_rounded(low), _rounded(high)], "n": len(values)}


def _rounded(value: float) -> float | None:
    return None if math.isnan(value) else round(value, 4)
