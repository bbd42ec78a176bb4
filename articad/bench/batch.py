"""Batches: many items side by side, on this machine or on a Dask cluster; a worker that dies loses its own item alone."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, Final, Self

import numpy as np
from scipy.stats import qmc

from articad.bench.items import Item, Json, make
from articad.errors import ReadError
from articad.plan.schema import AssemblyPlan

RETRIES: Final = 2  # of an item whose worker died
MEMORY_GB: Final = 4.0  # of a worker, its kernel's processes apart, which have bounds of their own
Told = Callable[[Json], object]


def read_batch(path: str | Path) -> list[Item]:
    """Read a specification `articad.batch/1`: `items`, `sample`, or both.

    A sample names a `plan`, a `count` and a `seed`, and for each of its `parameters` the range to draw from; where there are
    none, every parameter that the plan gives `min` and `max`. Values fill the ranges evenly (Latin hypercube). Paths are
    relative to the file.

    Raises:
        ReadError: If it is not of the form.
    """
    file = Path(path)
    try:
        stored = json.loads(file.read_text(encoding="utf-8"))
        rows = [
            *stored.get("items", []),
            *itertools.chain.from_iterable(_sampled(sample, file.parent) for sample in stored.get("sample", [])),
        ]
        return [Item.from_json(row | {"plan": str((file.parent / row["plan"]).resolve())}) for row in rows]
    except OSError as error:
        raise _refused(file, f"It cannot be read: {error.strerror}.") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise _refused(file, f"It is no batch: {error!r}.") from error


def _sampled(sample: Mapping[str, Any], folder: Path) -> Iterator[Json]:
    plan = AssemblyPlan.load(folder / sample["plan"])
    ranges = sample.get("parameters") or {
        parameter.name: (parameter.min, parameter.max)
        for parameter in plan.parameters
        if parameter.min is not None and parameter.max is not None
    }
    if not ranges:
        raise ValueError("the plan gives no parameter a min and a max, so `parameters` must name ranges")
    low, high = (np.array([float(bounds[end]) for bounds in ranges.values()]) for end in (0, 1))
    points = low + qmc.LatinHypercube(len(ranges), rng=np.random.default_rng(int(sample.get("seed", 0)))).random(int(sample["count"])) * (
        high - low
    )
    common = {name: sample[name] for name in ("gates", "formats", "kernel") if name in sample}
    for point in points:
        yield {"plan": sample["plan"], "values": {name: round(float(x), 4) for name, x in zip(ranges, point, strict=True)}} | common


def run_local(
    items: Sequence[Item],
    out: str | Path,
    *,
    workers: int | None = None,
    retries: int = RETRIES,
    memory_gb: float = MEMORY_GB,
    told: Told | None = None,
) -> list[Json]:
    """Make items in processes of this machine.

    Args:
        items: What to make.
        out: Folder of the batch.
        workers: How many at once; as many as there are processors by default.
        retries: How often an item is tried again whose worker died.
        memory_gb: Address space of a worker beyond which its allocations fail.
        told: Called with each record, from several threads.

    Returns:
        The items' records, in order.
    """
    todo: queue.SimpleQueue[int] = queue.SimpleQueue()
    for index in range(len(items)):
        todo.put(index)
    records: list[Json] = [{} for _ in items]

    def serve() -> None:
        with _Worker(Path(out), memory_gb) as worker:
            while True:
                try:
                    index = todo.get_nowait()
                except queue.Empty:
                    return
                records[index] = _tried(worker, items[index], retries)
                if told is not None:
                    told(records[index])

    threads = [threading.Thread(target=serve) for _ in range(min(workers or os.cpu_count() or 1, max(len(items), 1)))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return records


def run_dask(
    items: Sequence[Item],
    out: str | Path,
    *,
    scheduler: str | None = None,
    retries: int = RETRIES,
    told: Told | None = None,
    client: Any = None,
) -> list[Json]:
    """Make items on a Dask cluster; `out` must be a folder that all of its workers see.

    Args:
        items: What to make.
        out: Folder of the batch.
        scheduler: Its address.
        retries: How often an item is tried again; items of a worker that died go to another one by themselves.
        told: Called with each record as it comes.
        client: A client to use instead of a new one.

    Raises:
        ReadError: If Dask is not installed.
    """
    try:
        from distributed import Client, as_completed  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise _refused(Path("batch"), "Dask is not installed: pip install 'articad[batch]'.") from error
    own = client is None
    client = client or Client(scheduler)
    try:
        futures = [client.submit(_remote, item.to_json(), str(out), key=item.digest, retries=retries, pure=True) for item in items]
        for done in as_completed(dict.fromkeys(futures)):
            if told is not None:
                told(_result(done))
        return [_result(future) for future in futures]
    finally:
        if own:
            client.close()


def _remote(stored: Json, out: str) -> Json:
    return make(Item.from_json(stored), out)


def _result(future: Any) -> Json:
    """Return an item's record, or why there is none: a worker that dies again and again, for instance."""
    error = future.exception()
    if error is not None:
        return {"ok": False, "digest": future.key, "made": "never", "error": f"{type(error).__name__}: {error}"}
    return dict(future.result())


class _Worker:
    """A process that makes one item after another; started when first needed, and again after it died."""

    def __init__(self, out: Path, memory_gb: float) -> None:
        self._out, self._memory = out, memory_gb
        self._process: subprocess.Popen[str] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def make(self, item: Item) -> Json | None:
        """Return the item's record; None if the process died over it."""
        process = self._running()
        try:
            _pipe(process.stdin).write(json.dumps(item.to_json()) + "\n")
            _pipe(process.stdin).flush()
            answer = _pipe(process.stdout).readline()
        except OSError:
            answer = ""
        if answer:
            return dict(json.loads(answer))
        self._end()
        return None

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):  # a line that a dead worker never read
                _pipe(pipe).close()
        process.wait()

    def _running(self) -> subprocess.Popen[str]:
        if self._process is None:
            words = [sys.executable, "-m", "articad.bench.worker", str(self._out), str(self._memory)]
            self._process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)  # noqa: S603 - this very program
        return self._process


def _pipe(stream: IO[str] | None) -> IO[str]:
    if stream is None:
        raise OSError("The worker has no pipe.")
    return stream


def _tried(worker: _Worker, item: Item, retries: int) -> Json:
    for _ in range(1 + retries):
        record = worker.make(item)
        if record is not None:
            return record
    return {"ok": False, "digest": item.digest, "made": "never", "error": f"Its worker died {1 + retries} times.", **item.to_json()}


def summary(records: Iterable[Json]) -> Json:
    """Return the report `articad.batch-report/1`: how many passed, what was built and kept, and where the time went."""
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
        "ok": all(row.get("made") != "never" for row in rows),
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
    return ReadError.told(path, message, "See `articad batch --help`.", said=message)
