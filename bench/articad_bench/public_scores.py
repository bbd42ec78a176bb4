"""Scores on public data: shapes as on CADPrompt, articulated objects as on ACD.

Beside what was made stand what the true thing itself scores with other points of its surface, the floor that sampling leaves, and
what a plain box of its size scores. A score says little where it is no better than the box's. Each is the mean over five seeds of the
sampling; the table states the standard deviation of its means over these seeds.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, Final, TypeVar

from articad.errors import ArticadError, ReadError
from articad.geometry import TriMesh, read_mesh
from articad_bench.metrics import (
    FAILED,
    FAILED_OBJECT,
    SEEDS,
    ArticulatedScore,
    ShapeScore,
    articulated_score,
    box_of,
    box_score,
    floor_score,
    shape_score,
)
from articad_bench.numbers import mean_of, median_of, share_of
from articad_bench.public_data import ObjectSample, ShapeSample, TrueObject, object_of
from articad_bench.row import ROW
from articad_bench.scoring import model_of, subject_of
from articad_bench.task import read_json

SCHEMA: Final = "articad.bench-data/1"
_MESHES: Final = (".stl", ".obj", ".ply", ".glb")
_EFFORT: Final = ("iterations", "calls", "tokens")
_SHAPE: Final[Mapping[str, Callable[[ShapeScore], float]]] = {
    "pcd": lambda score: score.pcd,
    "hd": lambda score: score.hd,
    "iogt": lambda score: score.iogt,
    "pcd_dense": lambda score: score.pcd_dense,
    "hd_dense": lambda score: score.hd_dense,
}
_OBJECT: Final[Mapping[str, Callable[[ArticulatedScore], float]]] = {
    "rs_cd": lambda score: score.rs_cd,
    "rs_iou": lambda score: score.rs_iou,
    "movable_type_accuracy": lambda score: score.type_accuracy,
    "movable_f1": lambda score: score.f1,
    "movable_f1_axis": lambda score: score.f1_axis,
}

_Sample = TypeVar("_Sample", ShapeSample, ObjectSample)


Scores = tuple[Any, ...]
"""Those of one sample, one for each seed."""


@dataclass(frozen=True)
class Sampled:
    """What came of a sample.

    Attributes:
        name: Of the sample.
        ours: Its scores; the worst where nothing was made.
        floor: What the true one scores.
        box: What a plain box scores.
        error: Why nothing was made.
        effort: Iterations, calls, tokens and cost, where a run of the benchmark made it.
        left_out: Why the true one cannot be read: then the sample counts in no mean.
    """

    name: str
    ours: Scores = ()
    floor: Scores = ()
    box: Scores = ()
    error: str | None = None
    effort: Mapping[str, Any] = field(default_factory=dict)
    left_out: str | None = None


def score_shapes(samples: Iterable[ShapeSample], folder: str | Path, *, told: Callable[[Sampled], object] | None = None) -> dict[str, Any]:
    """Score what a folder holds for each shape: `<name>.stl` and the like, a model that articad reads, or a run; see `score_files`."""

    def scored(sample: ShapeSample) -> Sampled:
        truth = sample.truth()
        score, error = _tried(partial(_shape, sample.name, Path(folder), truth), FAILED)
        floor, plain = ([of(truth, seed=seed) for seed in SEEDS] for of in (floor_score, box_score))
        return Sampled(sample.name, score, tuple(floor), tuple(plain), error)

    return _report(_rows(samples, scored, Path(folder), told), _SHAPE)


def score_objects(
    samples: Iterable[ObjectSample], folder: str | Path, *, told: Callable[[Sampled], object] | None = None
) -> dict[str, Any]:
    """Score what a folder holds for each articulated object: a model that articad reads, or a run; see `score_files`."""

    def scored(sample: ObjectSample) -> Sampled:
        truth = sample.truth()
        score, error = _tried(partial(_object, sample.name, Path(folder), truth), FAILED_OBJECT)
        plain = TrueObject(box_of(truth.mesh), ())
        return Sampled(sample.name, score, _against(truth, truth), _against(plain, truth), error)

    return _report(_rows(samples, scored, Path(folder), told), _OBJECT)


def _rows(
    samples: Iterable[_Sample], scored: Callable[[_Sample], Sampled], folder: Path, told: Callable[[Sampled], object] | None
) -> list[Sampled]:
    rows = []
    for sample in samples:
        try:
            row = replace(scored(sample), effort=_effort(sample.name, folder))
        except ArticadError as error:
            row = Sampled(sample.name, left_out=f"{type(error).__name__}: {error}")
        rows.append(row)
        if told is not None:
            told(row)
    return rows


def _tried(score: Callable[[], Scores], failed: ShapeScore | ArticulatedScore) -> tuple[Scores, str | None]:
    try:
        return score(), None
    except ArticadError as error:
        return (failed,) * len(SEEDS), f"{type(error).__name__}: {error}"


def _shape(name: str, folder: Path, truth: TriMesh) -> Scores:
    mesh = _mesh_of(name, folder)
    return tuple(shape_score(mesh, truth, seed=seed) for seed in SEEDS)


def _object(name: str, folder: Path, truth: TrueObject) -> Scores:
    return _against(_object_of(name, folder), truth)


def _against(ours: TrueObject, truth: TrueObject) -> Scores:
    return tuple(articulated_score(ours.mesh, ours.joints, truth.mesh, truth.joints, seed=seed) for seed in SEEDS)


def _mesh_of(name: str, folder: Path) -> TriMesh:
    for ending in _MESHES:
        if (file := folder / f"{name}{ending}").is_file():
            return read_mesh(file)
    return _object_of(name, folder).mesh


def _object_of(name: str, folder: Path) -> TrueObject:
    return object_of(subject_of(model_of(name, folder)).assembly)


def _effort(name: str, folder: Path) -> dict[str, Any]:
    try:
        row = read_json(folder / name / ROW)
    except (OSError, ValueError):
        return {}
    return {key: row[key] for key in (*_EFFORT, "cost")}


def _report(every: Sequence[Sampled], measures: Mapping[str, Callable[[Any], float]]) -> dict[str, Any]:
    rows = [row for row in every if row.left_out is None]
    if every and not rows:
        raise ReadError(f"No true shape of the data can be read. {every[0].name}: {every[0].left_out}", path=every[0].name)

    def told(which: str) -> dict[str, Any]:
        values = {name: [_over_seeds(getattr(row, which), of) for row in rows] for name, of in measures.items()}
        return {
            name: {"mean": mean_of(found), "median": median_of(found), "spread": _spread(rows, which, measures[name])}
            for name, found in values.items()
        }

    spent = [row.effort for row in rows if row.effort]
    costs = [row["cost"] for row in spent]
    return {
        "schema": SCHEMA,
        "ok": True,
        "findings": [],
        "samples": len(rows),
        "seeds": list(SEEDS),
        "made": share_of([row.error is None for row in rows]),
        "ours": told("ours"),
        "floor": told("floor"),
        "box": told("box"),
        **{name: mean_of([float(row[name]) for row in spent]) for name in _EFFORT},
        "cost_usd": None if any(cost is None for cost in costs) else mean_of([float(cost) for cost in costs]),
        "rows": [
            {
                "name": row.name,
                "error": row.error,
                **{name: _rounded(_over_seeds(row.ours, of)) for name, of in measures.items()},
                **row.effort,
            }
            for row in rows
        ],
        "left_out": [{"name": row.name, "error": row.left_out} for row in every if row.left_out is not None],
    }


def _over_seeds(scores: Scores, of: Callable[[Any], float]) -> float:
    return statistics.fmean(of(score) for score in scores)


def _spread(rows: Sequence[Sampled], which: str, of: Callable[[Any], float]) -> float | None:
    """Return the standard deviation over the seeds of the mean over the samples; None where there is none."""
    means = []
    for seed in range(len(SEEDS)):
        found = [value for row in rows if not math.isnan(value := of(getattr(row, which)[seed]))]
        means += [statistics.fmean(found)] if found else []
    return _rounded(statistics.stdev(means)) if len(means) > 1 else None


def _rounded(value: float) -> float | None:
    return None if math.isnan(value) else round(value, 6)
