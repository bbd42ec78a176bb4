"""Scores on public data: shapes as on CADPrompt, articulated objects as on ACD.

Beside what was made stand what the true thing itself scores with other points of its surface, the floor that sampling leaves, and
what a plain box of its size scores. A score says little where it is no better than the box's.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final, TypeVar

from articad.errors import ArticadError
from articad.geometry import TriMesh, read_mesh
from articad_bench.metrics import (
    FAILED,
    FAILED_OBJECT,
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

SCHEMA: Final = "articad.bench-data/1"
_MESHES: Final = (".stl", ".obj", ".ply", ".glb")
_EFFORT: Final = ("iterations", "calls", "tokens")
_SHAPE: Final[Mapping[str, Callable[[ShapeScore], float]]] = {
    "pcd": lambda score: score.pcd,
    "hd": lambda score: score.hd,
    "iogt": lambda score: score.iogt,
}
_OBJECT: Final[Mapping[str, Callable[[ArticulatedScore], float]]] = {
    "rs_cd": lambda score: score.rs_cd,
    "rs_iou": lambda score: score.rs_iou,
    "movable_type_accuracy": lambda score: score.type_accuracy,
    "movable_f1": lambda score: score.f1,
}

_Score = TypeVar("_Score", ShapeScore, ArticulatedScore)


@dataclass(frozen=True)
class Sampled:
    """What came of a sample.

    Attributes:
        name: Of the sample.
        ours: Its score; the worst where nothing was made.
        floor: What the true one scores.
        box: What a plain box scores.
        error: Why nothing was made.
        effort: Iterations, calls, tokens and cost, where a run of the benchmark made it.
    """

    name: str
    ours: Any
    floor: Any
    box: Any
    error: str | None
    effort: Mapping[str, Any]


def score_shapes(samples: Iterable[ShapeSample], folder: str | Path, *, told: Callable[[Sampled], object] | None = None) -> dict[str, Any]:
    """Score what a folder holds for each shape: `<name>.stl` and the like, a model that articad reads, or a run; see `score_files`."""
    rows = []
    for sample in samples:
        truth = sample.truth()
        score, error = _tried(partial(_shape, sample.name, Path(folder), truth), FAILED)
        rows.append(Sampled(sample.name, score, floor_score(truth), box_score(truth), error, _effort(sample.name, Path(folder))))
        if told is not None:
            told(rows[-1])
    return _report(rows, _SHAPE)


def score_objects(
    samples: Iterable[ObjectSample], folder: str | Path, *, told: Callable[[Sampled], object] | None = None
) -> dict[str, Any]:
    """Score what a folder holds for each articulated object: a model that articad reads, or a run; see `score_files`."""
    rows = []
    for sample in samples:
        truth = sample.truth()
        score, error = _tried(partial(_object, sample.name, Path(folder), truth), FAILED_OBJECT)
        plain = TrueObject(box_of(truth.mesh), ())
        row = Sampled(sample.name, score, _against(truth, truth), _against(plain, truth), error, _effort(sample.name, Path(folder)))
        rows.append(row)
        if told is not None:
            told(row)
    return _report(rows, _OBJECT)


def _tried(score: Callable[[], _Score], failed: _Score) -> tuple[_Score, str | None]:
    try:
        return score(), None
    except ArticadError as error:
        return failed, f"{type(error).__name__}: {error}"


def _shape(name: str, folder: Path, truth: TriMesh) -> ShapeScore:
    return shape_score(_mesh_of(name, folder), truth)


def _object(name: str, folder: Path, truth: TrueObject) -> ArticulatedScore:
    return _against(_object_of(name, folder), truth)


def _against(ours: TrueObject, truth: TrueObject) -> ArticulatedScore:
    return articulated_score(ours.mesh, ours.joints, truth.mesh, truth.joints)


def _mesh_of(name: str, folder: Path) -> TriMesh:
    for ending in _MESHES:
        if (file := folder / f"{name}{ending}").is_file():
            return read_mesh(file)
    return _object_of(name, folder).mesh


def _object_of(name: str, folder: Path) -> TrueObject:
    return object_of(subject_of(model_of(name, folder)).assembly)


def _effort(name: str, folder: Path) -> dict[str, Any]:
    try:
        row = json.loads((folder / name / ROW).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return {key: row[key] for key in (*_EFFORT, "cost")}


def _report(rows: Sequence[Sampled], measures: Mapping[str, Callable[[Any], float]]) -> dict[str, Any]:
    def told(which: str) -> dict[str, Any]:
        scores = [getattr(row, which) for row in rows]
        values = {name: [of(score) for score in scores] for name, of in measures.items()}
        return {name: {"mean": mean_of(found), "median": median_of(found)} for name, found in values.items()}

    spent = [row.effort for row in rows if row.effort]
    costs = [row["cost"] for row in spent]
    return {
        "schema": SCHEMA,
        "ok": True,
        "findings": [],
        "samples": len(rows),
        "made": share_of([row.error is None for row in rows]),
        "ours": told("ours"),
        "floor": told("floor"),
        "box": told("box"),
        **{name: mean_of([float(row[name]) for row in spent]) for name in _EFFORT},
        "cost_usd": None if any(cost is None for cost in costs) else mean_of([float(cost) for cost in costs]),
        "rows": [
            {"name": row.name, "error": row.error, **{name: _rounded(of(row.ours)) for name, of in measures.items()}, **row.effort}
            for row in rows
        ],
    }


def _rounded(value: float) -> float | None:
    return None if math.isnan(value) else round(value, 6)
