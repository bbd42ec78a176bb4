"""What many assemblies cost. Run: python benchmarks/batch.py variants|killed|scaling [--count N] [--plan DIR] …

variants   parametric variants of one plan: where the time goes, and that no unchanged part is built twice
killed     builds on two Dask workers, one of which is killed in the middle: all results are there, none twice; memory of each worker
scaling    items by number of workers, here and on Dask, and what a million would cost

Parts are built into an empty cache, results into an empty folder. Processor seconds are those of workers and all that they start, so that
they mean something on a busy machine; wall clock does not. Exit code 1 on a missed goal.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil
from distributed import Client, LocalCluster

from articad.batches.batch import read_batch, run_dask, run_local, summary
from articad.plan.brief import brief
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan

ROOT = Path(__file__).resolve().parents[1]
STARTER = ROOT / "articad" / "starter"
FORMATS = ["urdf", "mjcf", "usd"]
SHARE = 0.95  # of the time that kernel and checks are to take
MILLION = 1_000_000
SAMPLE_SECONDS = 0.25  # between two looks at memory and processor time


def main() -> int:
    """Measure, print, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["variants", "killed", "scaling"])
    parser.add_argument("--count", type=int, default=None)
    parser.add_argument("--plan", type=Path, default=STARTER)
    parser.add_argument("--parameter", action="append", default=[], metavar="NAME=LOW:HIGH", help="sampled (height and gap of the starter)")
    parser.add_argument("--gates", default="rest,motion,certified")
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="articad-batch-") as folder:
        os.environ["ARTICAD_CACHE"] = str(Path(folder) / "cache")
        return {"variants": variants, "killed": killed, "scaling": scaling}[options.what](options, Path(folder))


def sampled(options: argparse.Namespace, folder: Path, count: int, *, seed: int = 0) -> list[Any]:
    """Return so many items, drawn from the plan's parameters as `articad batch` draws them."""
    ranges = dict(word.split("=") for word in options.parameter or ["height=15:90", "gap=0.1:1"])
    sample = {
        "plan": str(options.plan.resolve()),
        "count": count,
        "seed": seed,
        "parameters": {name: [float(end) for end in span.split(":")] for name, span in ranges.items()},
        "gates": options.gates.split(","),
        "formats": FORMATS,
    }
    spec = folder / f"batch_{seed}.json"
    spec.write_text(json.dumps({"schema": "articad.batch/1", "sample": [sample]}))
    return read_batch(spec)


def variants(options: argparse.Namespace, folder: Path) -> int:
    """A thousand variants of one plan."""
    items = sampled(options, folder, options.count or 1000)
    run_local(items[:1], folder / "first", workers=1)  # the parts that never change are kept before two workers could both want them
    with watched(os.getpid()) as used:
        start = time.perf_counter()
        records = run_local(items, folder / "out", workers=options.workers)
        elapsed = time.perf_counter() - start
    report = summary(records)
    spent, wanted = report["seconds"], distinct_parts(items)
    useful = spent["kernel"] + spent["checks"]
    share = useful / sum(spent.values())
    built = report["parts_built"] + records_of(folder / "first")["parts_built"]
    print(f"{len(items)} variants of {options.plan.name}, gates {options.gates}, {options.workers} workers, {elapsed:.0f} s, {load()}")
    print(f"passed {report['passed']}, refused by {report['refused_by'] or 'nothing'}, written {', '.join(FORMATS)} with provenance")
    for stage, seconds in spent.items():
        print(f"  {stage:<8} {seconds:9.1f} s  {100 * seconds / sum(spent.values()):5.1f} %")
    whole = options.workers * elapsed
    print(f"kernel and checks: {100 * share:.1f} % of the stages, {100 * useful / whole:.1f} % of {options.workers} workers' wall clock")
    print(
        f"parts: {report['parts_built']} built, {report['parts_kept']} kept; there are {wanted} different ones, and {built} were built in all"
    )
    print(
        f"processor: {used.cpu:.0f} s; disk: {size(folder / 'out') / 1e6:.1f} MB of results, {size(folder / 'cache') / 1e6:.1f} MB of parts"
    )
    ok = share >= SHARE and built == wanted and report["ok"]
    print("goal met" if ok else "goal MISSED", f"(at least {100 * SHARE:.0f} %, each part built once)")
    return 0 if ok else 1


def killed(options: argparse.Namespace, folder: Path) -> int:
    """Two hundred builds on two Dask workers, one killed in the middle."""
    items = sampled(options, folder, options.count or 200)
    out = folder / "out"
    victims: list[int] = []
    seen = 0
    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1", memory_limit="2GiB"
        ) as cluster,
        Client(cluster) as client,
        watched(os.getpid()) as used,
    ):

        def told(_record: dict[str, Any]) -> None:
            nonlocal seen
            seen += 1
            if seen == len(items) // 3:
                victims.append(next(iter(cluster.workers.values())).process.pid)
                os.kill(victims[0], signal.SIGKILL)

        start = time.perf_counter()
        records = run_dask(items, out, client=client, told=told)
        elapsed = time.perf_counter() - start
    folders = [path.parent.name for path in out.glob("*/*/item.json")]
    made = Counter(record["made"] for record in records)
    again = sum(record["made"] == "now" for record in run_dask_again(items, out))
    ok = (
        len(folders) == len(set(folders)) == len(items)
        and all(record["ok"] for record in records)
        and {record["digest"] for record in records} == set(folders) == {item.digest for item in items}
        and not again
    )
    print(
        f"{len(items)} builds of {options.plan.name} on two Dask workers, {elapsed:.0f} s, {load()}; worker {victims} killed after {seen and len(items) // 3}"
    )
    print(
        f"results: {len(folders)} folders, {len(set(folders))} different; answers: {dict(made)}; made by a second run of the same batch: {again}"
    )
    print(
        f"largest resident memory of a Dask worker with its processes: {used.largest / 1e6:.0f} MB; limit of a worker process's data: 4 GiB,"
    )
    print("of each kernel process 3 GiB, of the Dask worker itself 2 GiB here")
    print("goal met" if ok else "goal MISSED", "(all present, none twice)")
    return 0 if ok else 1


def run_dask_again(items: list[Any], out: Path) -> list[dict[str, Any]]:
    """Ask for the same items once more."""
    return run_local(items, out, workers=2)


def scaling(options: argparse.Namespace, folder: Path) -> int:
    """Items by number of workers."""
    count = options.count or 60
    run_local(sampled(options, folder, 1, seed=99), folder / "first", workers=1)
    rows = []
    for seed, (engine, workers) in enumerate((engine, workers) for engine in ("local", "dask") for workers in (1, 2, 4)):
        items, out = sampled(options, folder, count, seed=seed), folder / f"out_{seed}"
        with watched(os.getpid()) as used:
            if engine == "local":
                start = time.perf_counter()
                run_local(items, out, workers=workers)
                elapsed = time.perf_counter() - start
            else:
                with (
                    LocalCluster(
                        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
                    ) as cluster,
                    Client(cluster) as client,
                ):
                    start = time.perf_counter()
                    run_dask(items, out, client=client)
                    elapsed = time.perf_counter() - start
        rows.append((engine, workers, elapsed, count / elapsed, used.cpu / count, used.largest / 1e6, size(out) / count / 1e3))
    print(f"{count} items of {options.plan.name} each, gates {options.gates}, {', '.join(FORMATS)}; {os.cpu_count()} processors, {load()}")
    print(
        "| engine | workers | wall s | items/s | processor s an item | MB of a worker at most | kB an item |\n|---|---|---|---|---|---|---|"
    )
    for row in rows:
        print("| {} | {} | {:.1f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} |".format(*row))
    cpu, disk = min(row[4] for row in rows), rows[0][6] * 1e3
    print(f"a million on paper: {cpu * MILLION / 3600:.0f} core-hours, {disk * MILLION / 1e9:.0f} GB of results")
    return 0


# ---------------------------------------------------------------------- what is counted


class Used:
    """Processor seconds of all that a process has started, and the largest resident memory of one worker with its processes [B]."""

    def __init__(self) -> None:
        self.seconds: dict[tuple[int, float], float] = {}
        self.largest = 0

    @property
    def cpu(self) -> float:
        return sum(self.seconds.values())

    def look(self, root: int) -> None:
        try:
            children = psutil.Process(root).children(recursive=True)
        except psutil.Error:
            return
        for child in children:
            try:
                times = child.cpu_times()
                self.seconds[child.pid, child.create_time()] = times.user + times.system
            except psutil.Error:
                continue
        for child in psutil.Process(root).children():
            try:
                self.largest = max(self.largest, sum(each.memory_info().rss for each in (child, *child.children(recursive=True))))
            except psutil.Error:
                continue


@contextmanager
def watched(root: int) -> Iterator[Used]:
    """Count while the block runs; what lives shorter than a look is missed, and so nothing is counted twice."""
    used, stop = Used(), threading.Event()
    used.look(root)
    before = dict(used.seconds)

    def look() -> None:
        while not stop.wait(SAMPLE_SECONDS):
            used.look(root)

    thread = threading.Thread(target=look)
    thread.start()
    try:
        yield used
    finally:
        stop.set()
        thread.join()
        for key, seconds in before.items():
            used.seconds[key] -= seconds


def distinct_parts(items: list[Any]) -> int:
    """Return how many different parts items have that scripts make: by what each script is told, whatever was built."""
    plan = AssemblyPlan.load(items[0].plan)
    found = set()
    for item in items:
        resolved = resolve(plan, **dict(item.values))
        found |= {json.dumps(brief(resolved, name), sort_keys=True) for name, part in resolved.parts.items() if part.derivation is None}
    return len(found)


def records_of(out: Path) -> dict[str, Any]:
    """Return the only record in a folder."""
    (file,) = out.glob("*/*/item.json")
    return dict(json.loads(file.read_text()))


def size(folder: Path) -> int:
    """Return what a folder takes [B]."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def load() -> str:
    """Return how busy the machine is."""
    return f"load {os.getloadavg()[0]:.1f}"


if __name__ == "__main__":
    sys.exit(main())
