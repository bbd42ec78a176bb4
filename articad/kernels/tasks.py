"""The tasks of the worker in a confined process. The zygote imports this module once; tasks return their results as files."""

from __future__ import annotations

import json
import math
import os
from typing import Any

from articad.kernels import measure, part_script, projection, step_tree, timers, tracing

SELF_INTERSECTION_SECONDS = 5.0  # of processor time: the check is quadratic in faces; a swept thread would need 12 s

Json = dict[str, Any]


def run_script(request: Json, files: dict[str, int]) -> None:
    """Task `script`: run a part script."""
    job, limits = json.loads(_content(files["job"])), request["limits"]
    part_script.run(
        job["script"],
        job["part"],
        seconds=limits["seconds"],
        report=lambda line: _write(files["report"], measure.to_json(line)),
        shape=lambda content: _write(files["shape"], content),
    )


def trace_script(request: Json, files: dict[str, int]) -> None:
    """Task `trace`: the operations of a part script with their formulas, and its solid at other dimensions."""
    job, limits = json.loads(_content(files["job"])), request["limits"]
    tracing.run(
        job["script"],
        job["part"],
        job["variations"],
        seconds=limits["seconds"],
        report=lambda line: _write(files["report"], measure.to_json(line)),
    )


def measure_shape(request: Json, files: dict[str, int]) -> None:
    """Tasks `measure` (the shape of a script, or a STEP or B-rep file, moved or mirrored) and `pieces` (the solids of a failed script)."""
    job = json.loads(_content(files["job"]))
    timers.allow(request["limits"]["seconds"])
    try:
        shape = measure.read_shape(job["form"], _content(files["shape"]))
    except (ValueError, RuntimeError) as error:
        _write(files["report"], measure.to_json({"ok": False, "message": str(error)}))
        return
    accuracy = {"deflection": job["deflection_mm"], "angle": math.radians(job["angle_deg"])}
    if request["task"] == "pieces":
        measured = measure.pieces(shape, **accuracy)
    else:
        measured = measure.measure(shape, **accuracy, name=job["name"], matrix=job["matrix"], place=job.get("place"))
    for name, content in measured.files.items():
        _write(files[name], content)
    _write(files["report"], measure.to_json(measured.report))
    if measured.report.get("valid") and measured.files:
        timers.processor_time(SELF_INTERSECTION_SECONDS)
        _write(files["report"], measure.to_json(measure.self_intersection(measure.solids_of(shape)[job.get("place") or 0])))


def judge_shape(request: Json, files: dict[str, int]) -> None:
    """Task `judge`: whether a script's shape is one valid solid, and its properties; no mesh, no files."""
    timers.allow(request["limits"]["seconds"])
    try:
        shape = measure.read_shape("bin", _content(files["shape"]))
    except (ValueError, RuntimeError) as error:
        _write(files["report"], measure.to_json({"ok": False, "message": str(error)}))
        return
    solids = measure.solids_of(shape)
    is_one = len(solids) == 1 and measure.is_valid(solids[0])
    _write(files["report"], measure.to_json({"ok": is_one, "solids": len(solids)} | (measure.properties(solids[0]) if is_one else {})))


def read_assembly(request: Json, files: dict[str, int]) -> None:
    """Task `assembly`: the products of a STEP file. The report's first line says whether it could be read; each other one is a part."""
    job = json.loads(_content(files["job"]))
    timers.allow(request["limits"]["seconds"])
    try:
        rows, mesh = step_tree.read(_content(files["shape"]), deflection=job["deflection_mm"], angle=math.radians(job["angle_deg"]))
    except (ValueError, RuntimeError) as error:
        _write(files["report"], measure.to_json({"ok": False, "message": str(error)}))
        return
    _write(files["npz"], mesh)
    _write(files["report"], b"".join(measure.to_json(row) for row in ({"ok": True, "parts": len(rows)}, *rows)))


def project_shapes(request: Json, files: dict[str, int]) -> None:
    """Task `project`: views of B-reps, each of which is placed in one frame, as lines on paper."""
    job, content = json.loads(_content(files["job"])), _content(files["shape"])
    timers.allow(request["limits"]["seconds"])
    shapes, start = [], 0
    for length, matrix in zip(job["lengths"], job["matrices"], strict=True):
        shapes.append(measure.placed(measure.read_shape("brep", content[start : start + length]), matrix))
        start += length
    whole = measure.compound(shapes)
    lines = {"views": [projection.projected(whole, view) for view in job["views"]], "features": projection.features(whole)}
    _write(files["lines"], measure.to_json(lines))
    _write(files["report"], measure.to_json({"ok": True}))


TASKS = {
    "script": run_script,
    "trace": trace_script,
    "measure": measure_shape,
    "pieces": measure_shape,
    "judge": judge_shape,
    "assembly": read_assembly,
    "project": project_shapes,
}


def _content(file: int) -> bytes:
    return os.pread(file, os.fstat(file).st_size, 0)


def _write(file: int, content: bytes) -> None:
    view = memoryview(content)
    while view:
        view = view[os.write(file, view) :]
