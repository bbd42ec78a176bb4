"""The table of judges: the scores of each and of all, how far they agree, and what it cost.

Motion is reported twice: over the tasks that require motion, and over all tasks with 5 for the others. The means differ.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from articad.arrays import FloatArray
from articad_bench.agreement import bootstrap_items, icc_2k, krippendorff_alpha
from articad_bench.judge import DIMENSIONS, Judged, judges_of
from articad_bench.numbers import mean_of, rounded, share_of

SCHEMA: Final = "articad.bench-judged/1"
STILL: Final = 5.0  # score for the motion of a task that requires none, where such tasks are counted


def judged_table(rows: Sequence[Judged]) -> dict[str, Any]:
    """Return the report `articad.bench-judged/1` of opinions."""
    kinds = sorted({row.kind for row in rows})
    judges = judges_of(rows)
    return {
        "schema": SCHEMA,
        "ok": True,
        "findings": [],
        "tasks": len({row.task for row in rows}),
        "judges": list(judges),
        "all": _scores(rows),
        "by_judge": {judge: _scores([row for row in rows if row.judge == judge]) for judge in judges},
        "by_kind": {kind: _scores([row for row in rows if row.kind == kind]) for kind in kinds},
        "agreement": {dimension: _agreement(rows, judges, dimension) for dimension in DIMENSIONS},
        "spent": _spent(rows),
        "rows": [_line(task, [row for row in rows if row.task == task]) for task in dict.fromkeys(row.task for row in rows)],
    }


def _scores(rows: Sequence[Judged]) -> dict[str, Any]:
    """Return the means over tasks of the judges' means."""
    tasks = [[row for row in rows if row.task == task] for task in dict.fromkeys(row.task for row in rows)]
    geometry, detail, motion = ([_mean(task, dimension) for task in tasks] for dimension in DIMENSIONS)
    still = [STILL if task[0].made and not task[0].moves else value for task, value in zip(tasks, motion, strict=True)]
    return {
        "tasks": len(tasks),
        "success": share_of([task[0].made for task in tasks]),
        "geometry": mean_of(geometry),
        "detail": mean_of(detail),
        "motion": mean_of([value for task, value in zip(tasks, motion, strict=True) if task[0].moves]),
        "motion_still_as_5": mean_of(still),
    }


def _mean(rows: Sequence[Judged], dimension: str) -> float:
    given = [score for row in rows if (score := row.score(dimension)) is not None]
    return float(np.mean(given)) if given else math.nan


def _agreement(rows: Sequence[Judged], judges: Sequence[str], dimension: str) -> dict[str, Any]:
    """Return how far judges agree on what they saw; for motion, only tasks that require motion count."""
    seen = [row for row in rows if row.opinion is not None and (dimension != "motion" or row.moves)]
    tasks = list(dict.fromkeys(row.task for row in seen))
    ratings: FloatArray = np.full((len(judges), len(tasks)), math.nan)
    for row in seen:
        ratings[judges.index(row.judge), tasks.index(row.task)] = row.score(dimension)

    def told(measure: Callable[[FloatArray], float]) -> dict[str, Any]:
        low, high = bootstrap_items(ratings, measure)
        return {"value": rounded(measure(ratings)), "interval": [rounded(low), rounded(high)]}

    return {
        "tasks": len(tasks),
        "judges": len(judges),
        "krippendorff_alpha": told(lambda table: krippendorff_alpha(table, "ordinal")),
        "icc_2k": told(icc_2k),
    }


def _spent(rows: Sequence[Judged]) -> dict[str, Any]:
    return {
        "calls": mean_of([row.calls for row in rows]),
        "tokens": mean_of([row.tokens for row in rows]),
        "cost_usd": None if any(row.cost is None for row in rows) else mean_of([row.cost or 0.0 for row in rows]),
    }


def _line(task: str, rows: Sequence[Judged]) -> dict[str, Any]:
    return {
        "task": task,
        "kind": rows[0].kind,
        "made": rows[0].made,
        "moves": rows[0].moves,
        "scores": {row.judge: {dimension: row.score(dimension) for dimension in DIMENSIONS} for row in rows},
        "error": next((row.error for row in rows if row.error), None),
        "calls": sum(row.calls for row in rows),
        "tokens": sum(row.tokens for row in rows),
        "cost_usd": None if any(row.cost is None for row in rows) else sum(row.cost or 0.0 for row in rows),
    }
