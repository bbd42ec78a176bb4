"""Batches: many items in parallel, on this machine or on a Dask cluster; a worker that dies loses only its own item."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from pydantic import ValidationError
from scipy.stats import qmc

from articad.aliases import Json
from articad.batches import pool
from articad.batches.items import BatchItem
from articad.batches.pool import MEMORY_GB, RETRIES, Told
from articad.batches.specification import BatchFile, ItemRow, SampleRow, first_fault
from articad.errors import ReadError
from articad.files import PLAN_BYTES, read_file
from articad.plan.schema import AssemblyPlan
from articad.texts import SPOILED, spoiled

MAKE_ITEM: Final = "articad.batches.items:make_stored"
"""The function that a worker calls for an item."""


def read_batch(path: str | Path) -> list[BatchItem]:
    """Read a specification `articad.batch/1`: `items`, `sample`, or both.

    A sample names a `plan`, a `count` and a `seed`, and for each of its `parameters` the range to draw from; where there are
    none, every parameter that the plan gives `min` and `max`. Values fill the ranges evenly (Latin hypercube). Paths are
    relative to the file.

    Raises:
        ReadError: If it does not have the form.
    """
    file = Path(path)
    try:
        stored = _stored(read_file(file, PLAN_BYTES))
    except OSError as error:
        raise _refused(file, f"It cannot be read: {error.strerror}.") from error
    except ValidationError as error:
        raise _refused(file, f"It is not a valid batch: {first_fault(error)}.") from error
    except (ValueError, RecursionError) as error:
        raise _refused(file, f"It is not a valid batch: {str(error)[:200]}.") from error
    rows = [*stored.items, *itertools.chain.from_iterable(_sampled(sample, file) for sample in stored.sample)]
    return [BatchItem.of(row.model_copy(update={"plan": str((file.parent / row.plan).resolve())})) for row in rows]


def _stored(content: bytes) -> BatchFile:
    document = json.loads(content)
    if spoiled(document) is not None:
        raise ValueError(f"it holds {SPOILED}")
    return BatchFile.model_validate(document)


def _sampled(sample: SampleRow, file: Path) -> Iterator[ItemRow]:
    ranges = sample.parameters or _ranges_of(AssemblyPlan.load(file.parent / sample.plan), file)
    if not ranges:
        raise _refused(file, f"The plan {sample.plan} gives no parameter a min and a max, so `parameters` must name ranges.")
    low, high = np.array(list(ranges.values())).T
    points = low + qmc.LatinHypercube(len(ranges), rng=np.random.default_rng(sample.seed)).random(sample.count) * (high - low)
    common = {name: getattr(sample, name) for name in ("plan", "gates", "formats", "kernel")}
    for point in points:
        yield ItemRow(**common, values={name: round(float(x), 4) for name, x in zip(ranges, point, strict=True)})


def _ranges_of(plan: AssemblyPlan, file: Path) -> dict[str, tuple[float, float]]:
    ranges: dict[str, tuple[float, float]] = {}
    for parameter in plan.parameters:
        low, high = parameter.min, parameter.max
        if isinstance(low, str) or isinstance(high, str):
            raise _refused(file, f"The min or max of {parameter.name!r} is an expression, so `parameters` must name ranges.")
        if low is not None and high is not None:
            ranges[parameter.name] = (low, high)
    return ranges


def run_local(
    items: Sequence[BatchItem],
    out: str | Path,
    *,
    workers: int | None = None,
    retries: int = RETRIES,
    memory_gb: float = MEMORY_GB,
    told: Told | None = None,
) -> list[Json]:
    """Make items in processes of this machine; see `articad.batches.pool.run_local`.

    Args:
        items: What to make.
        out: Folder of the batch.
        workers: Number of parallel processes.
        retries: How often an item is tried again whose worker died.
        memory_gb: Data of a worker beyond which its allocations fail.
        told: Called with each record, from several threads.

    Returns:
        The items' records, in order.
    """
    calls = calls_of(items, out)
    return _with_items(items, pool.run_local(calls, workers=workers, retries=retries, memory_gb=memory_gb, told=told))


def run_dask(
    items: Sequence[BatchItem],
    out: str | Path,
    *,
    scheduler: str | None = None,
    retries: int = RETRIES,
    memory_gb: float = MEMORY_GB,
    told: Told | None = None,
    client: Any = None,
) -> list[Json]:
    """Make items on a Dask cluster; `out` must be a folder that all of its workers see.

    Args:
        items: What to make.
        out: Folder of the batch.
        scheduler: Its address.
        retries: How often an item is tried again; items of a Dask worker that died go to another one by themselves.
        memory_gb: Data of a worker process beyond which its allocations fail.
        told: Called with each record as it comes.
        client: A client to use instead of a new one.

    Raises:
        ReadError: If Dask is not installed.
    """
    calls = calls_of(items, out)
    found = pool.run_dask(calls, scheduler=scheduler, retries=retries, memory_gb=memory_gb, told=told, client=client)
    return _with_items(items, found)


def calls_of(items: Sequence[BatchItem], out: str | Path) -> list[pool.Call]:
    """Return the calls for items."""
    rows = [item.to_json() | {"plan": str(Path(item.plan).resolve())} for item in items]
    return [
        pool.Call(MAKE_ITEM, {"item": row, "out": str(Path(out).resolve())}, item.digest) for row, item in zip(rows, items, strict=True)
    ]


def _with_items(items: Sequence[BatchItem], records: Sequence[Json]) -> list[Json]:
    """Return the records, each with its item, also for items that were not made."""
    return [item.to_json() | record for item, record in zip(items, records, strict=True)]


def summary(records: Iterable[Json]) -> Json:
    """Return the report `articad.batch-report/1`: how many passed, what was built or reused, and the time of each stage.

    An item that a check refuses is a result. The batch is `ok` if every item was made and at least one passed.
    """
    rows = list(records)
    spent: dict[str, float] = {}
    for row in rows:
        for stage, seconds in row.get("seconds", {}).items() if row.get("made") == "now" else ():
            spent[stage] = spent.get(stage, 0.0) + seconds
    codes: dict[str, int] = {}
    for row in rows:
        for code in {finding["code"] for finding in row.get("findings", []) if finding.get("severity") == "error"}:
            codes[code] = codes.get(code, 0) + 1
    return {
        "schema": "articad.batch-report/1",
        "ok": all(row.get("made") != "never" for row in rows) and any(row.get("ok") for row in rows),
        "findings": [],
        "items": len(rows),
        "passed": sum(bool(row.get("ok")) for row in rows),
        "made_before": sum(row.get("made") == "before" for row in rows),
        "never_made": [row["digest"] for row in rows if row.get("made") == "never"],
        "refused_by": dict(sorted(codes.items(), key=lambda pair: -pair[1])),
        "parts_built": sum(row.get("parts_built", 0) for row in rows if row.get("made") == "now"),
        "parts_kept": sum(row.get("parts_kept", 0) for row in rows if row.get("made") == "now"),
        "seconds": {stage: round(seconds, 2) for stage, seconds in spent.items()},
    }


def _refused(path: Path, message: str) -> ReadError:
    return ReadError.at(path, message, "See `articad batch --help`.", said=message)
