"""Batches: nothing twice, nothing half, a dead worker loses its own item alone, here and on Dask."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path
from typing import Any

import mujoco
import pytest

from articad import __version__
from articad.aliases import Json
from articad.batches.batch import calls_of, read_batch, run_dask, run_local, summary
from articad.batches.items import ITEM, BatchItem, make
from articad.batches.pool import Worker
from articad.cli import main
from articad.errors import ReadError
from tests.agents import stories

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A plate with a flap, whose lift may be chosen."""
    folder = tmp_path_factory.mktemp("flap")
    (folder / "parts").mkdir()
    (folder / "plan.json").write_text(json.dumps(stories.FLAP_PLAN))
    for name, script in stories.FLAP_SCRIPTS.items():
        (folder / "parts" / f"{name}.py").write_text(script)
    return folder


def lifts(plan: Path, *values: float, **options: Any) -> list[BatchItem]:
    return [BatchItem(str(plan), {"lift": value}, **options) for value in values]


def test_an_item_is_checked_exported_and_not_made_twice(plan: Path, tmp_path: Path) -> None:
    (item,) = lifts(plan, 1.0, gates=("rest", "motion"))

    first, second = make(item, tmp_path), make(item, tmp_path)

    assert first["ok"], first
    assert (first["made"], second["made"]) == ("now", "before")
    folder = tmp_path / item.digest[:2] / item.digest
    (scene,) = folder.glob("mjcf/*.xml")
    mujoco.MjModel.from_xml_path(str(scene))
    assert {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()} == {*first["files"], ITEM}
    assert first["values"] == {"lift": 1.0}
    assert {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in first["files"]} == first["files"]
    assert (first["kernel"], first["articad"], first["plan"]) == ("build123d", __version__, str(plan))
    assert first["kernel_version"]


@pytest.mark.parametrize(
    "damage", ["a file is gone", "a file is changed", "a file is a link", "no JSON", "another item", "no record", "deep"]
)
def test_an_item_that_is_not_what_was_written_is_made_again(damage: str, plan: Path, tmp_path: Path) -> None:
    (item,) = lifts(plan, 1.0, formats=("urdf",))
    first = make(item, tmp_path)
    folder = tmp_path / item.digest[:2] / item.digest
    file = folder / next(iter(first["files"]))
    if damage == "a file is changed":
        file.write_bytes(file.read_bytes() + b" ")
    elif damage == "a file is gone":
        file.unlink()
    elif damage == "a file is a link":
        file.rename(tmp_path / "elsewhere")
        file.symlink_to(tmp_path / "elsewhere")
    else:
        record = json.loads((folder / ITEM).read_text())
        texts = {"another item": json.dumps(record | {"digest": "0" * 64}), "no record": "{}", "deep": "[" * 100_000}
        (folder / ITEM).write_text(texts.get(damage, "{"))

    again = make(item, tmp_path)

    assert (again["made"], again["files"]) == ("now", first["files"])
    assert make(item, tmp_path)["made"] == "before"
    assert {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in first["files"]} == first["files"]
    assert [path.name for path in folder.parent.iterdir()] == [item.digest]


def test_what_a_gate_refuses_is_kept_without_exports(plan: Path, tmp_path: Path) -> None:
    (item,) = lifts(plan, -1.0)

    record = make(item, tmp_path)

    assert not record["ok"]
    assert [finding["code"] for finding in record["findings"]] == ["E_STATIC_OVERLAP"]
    assert [path.name for path in (tmp_path / item.digest[:2] / item.digest).iterdir()] == [ITEM]


def test_scripts_values_gates_and_formats_make_another_item(plan: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    shutil.copytree(plan, other)
    script = next((other / "parts").iterdir())
    script.write_text(script.read_text() + "# changed\n")

    items = [*lifts(plan, 1, 2), *lifts(plan, 1, gates=("motion",)), *lifts(plan, 1, formats=("urdf",)), *lifts(other, 1)]

    assert len({item.digest for item in items}) == 5


def test_a_dead_worker_loses_its_own_item_alone_and_that_is_tried_again(plan: Path, tmp_path: Path) -> None:
    items = lifts(plan, *(1 + 0.01 * index for index in range(8)), formats=("urdf",))
    killed: list[int] = []

    def kill_once(_record: Json) -> None:
        if not killed:
            killed.append(victim := children_of(os.getpid())[0])
            os.kill(victim, signal.SIGKILL)

    records = run_local(items, tmp_path, workers=2, told=kill_once)

    assert killed
    assert [record["ok"] for record in records] == [True] * 8
    assert len(list(tmp_path.glob("*/*/item.json"))) == 8
    assert Counter(record["made"] for record in run_local(items, tmp_path, workers=2)) == {"before": 8}


def test_an_item_that_kills_its_worker_each_time_is_told(tmp_path: Path, plan: Path) -> None:
    (item,) = lifts(plan, 1.5)
    stop = threading.Event()

    def kill_all() -> None:
        while not stop.is_set():
            for child in children_of(os.getpid()):
                os.kill(child, signal.SIGKILL)
            time.sleep(0.02)

    killer = threading.Thread(target=kill_all)
    killer.start()
    try:
        (record,) = run_local([item], tmp_path, workers=1, retries=1)
    finally:
        stop.set()
        killer.join()

    assert record["made"] == "never"
    assert "died 2 times" in record["error"]
    assert not summary([record])["ok"]


def children_of(process: int) -> list[int]:
    """Return the workers that a process has started."""
    found = subprocess.run(
        ["pgrep", "-P", str(process), "-f", "articad.batches.worker"], capture_output=True, text=True, check=False
    ).stdout
    return [int(line) for line in found.split()]


def test_a_sample_fills_the_ranges_evenly_and_is_the_same_for_a_seed(plan: Path, tmp_path: Path) -> None:
    spec = tmp_path / "batch.json"
    sample = {"plan": os.path.relpath(plan, tmp_path), "count": 20, "seed": 3, "parameters": {"lift": [1, 3]}, "formats": ["urdf"]}
    spec.write_text(json.dumps({"schema": "articad.batch/1", "sample": [sample]}))

    items = read_batch(spec)

    values = sorted(item.values["lift"] for item in items)
    assert [int((value - 1) * 10) for value in values] == list(range(20))  # one in each twentieth
    assert items == read_batch(spec)
    assert all(item.formats == ("urdf",) for item in items)


def test_the_command_makes_a_batch_and_says_what_came_of_it(plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec = tmp_path / "batch.json"
    spec.write_text(json.dumps({"items": [{"plan": str(plan), "values": {"lift": lift}, "formats": ["urdf"]} for lift in (1, -1)]}))

    assert main(["batch", str(spec), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0

    said = capsys.readouterr().out
    assert "1 of 2 passed" in said
    assert "E_STATIC_OVERLAP: 1" in said


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ({}, r"items.0.plan: it is missing"),
        ({"plan": ".", "gates": ["sealed"]}, "items.0.gates.0: .*'rest', 'motion' or 'certified'"),
        ({"plan": ".", "formats": ["urd"]}, "items.0.formats.0: .*Did you mean 'urdf'"),
        ({"plan": ".", "values": {"a": "x"}}, "items.0.values.a: .*number"),
    ],
)
def test_a_wrong_item_is_told(row: Json, words: str, tmp_path: Path) -> None:
    spec = tmp_path / "batch.json"
    spec.write_text(json.dumps({"items": [row]}))
    with pytest.raises(ReadError, match=words):
        read_batch(spec)


def test_a_worker_has_no_more_memory_than_it_was_given(plan: Path, tmp_path: Path) -> None:
    (item,) = lifts(plan, 1.0, formats=("urdf",))

    (small,) = run_local([item], tmp_path / "small", workers=1, memory_gb=0.05, retries=0)
    (large,) = run_local([item], tmp_path / "large", workers=1)

    assert not small["ok"]
    assert large["ok"], large


def test_a_worker_ends_with_whoever_started_it(plan: Path, tmp_path: Path) -> None:
    code = f"""
import os
from articad.batches.batch import run_local
from articad.batches.items import BatchItem

def tell(record):
    children = os.popen(f"pgrep -P {{os.getpid()}} -f articad.batches.worker").read()
    print(children, flush=True)
    os.kill(os.getpid(), 9)

run_local([BatchItem({str(plan)!r}, {{"lift": 1 + i / 10}}) for i in range(9)], {str(tmp_path)!r}, workers=1, told=tell)
"""
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    workers = [int(line) for line in done.stdout.split()]

    assert done.returncode == -signal.SIGKILL
    assert workers
    deadline = time.monotonic() + 60
    while alive := [
        worker
        for worker in workers
        if Path(f"/proc/{worker}/cmdline").exists() and b"bench.worker" in Path(f"/proc/{worker}/cmdline").read_bytes()
    ]:
        assert time.monotonic() < deadline, alive
        time.sleep(0.05)


def test_a_worker_that_nobody_calls_ends_and_the_next_call_starts_another(plan: Path, tmp_path: Path) -> None:
    first, second = calls_of(lifts(plan, 1.0, 1.5, formats=("urdf",)), tmp_path)
    with Worker(4.0, idle=0.2) as worker:
        assert worker.tried(first, 0)["ok"]
        (process,) = children_of(os.getpid())
        os.waitid(os.P_PID, process, os.WEXITED | os.WNOWAIT)

        assert worker.tried(second, 0)["ok"]


def test_dask_makes_all_items_though_a_worker_is_killed(plan: Path, tmp_path: Path) -> None:
    from distributed import Client, LocalCluster

    items = lifts(plan, *(1 + 0.01 * index for index in range(10)), formats=("urdf",))
    killed: list[int] = []
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1") as cluster,
        Client(cluster) as client,
    ):

        def kill_once(_record: Json) -> None:
            if not killed:
                killed.append(next(iter(cluster.workers.values())).process.pid)
                os.kill(killed[0], signal.SIGKILL)

        records = run_dask(items, tmp_path, client=client, told=kill_once)

    assert killed
    assert [record["ok"] for record in records] == [True] * 10
    assert len(list(tmp_path.glob("*/*/item.json"))) == 10
