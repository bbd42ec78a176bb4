"""The benchmark runs, goes on, scores anyone's files, and shows what experience is worth, to a scripted model."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad.agents.llm import LLM, Request, Scripted
from articad.agents.recollection import StoredMemory, remember
from articad.bench.runner import Row, rows_in, run_tasks, score_files
from articad.bench.table import table
from articad.bench.task import Task, read_task, tasks_in
from articad.cli import main
from articad.errors import ReadError
from articad.memory.experience import ExperienceStore
from tests.agents import stories

pytestmark = pytest.mark.slow

PROMPTS = ("a steel plate with a flap that opens upwards", "a plate and its flap, hinged at the back", "a flap on a plate of steel")
CHECKS: list[dict[str, Any]] = [
    {"kind": "parts", "number": [2, 2]},
    {"kind": "freedoms", "number": 1},
    {"kind": "solids"},
    {"kind": "clear_at_rest"},
]


@pytest.fixture
def tasks(tmp_path: Path) -> list[tuple[Path, Task]]:
    for index, prompt in enumerate(PROMPTS):
        folder = tmp_path / "tasks" / f"flap_{index}"
        folder.mkdir(parents=True)
        task = {
            "schema": "articad.task/1",
            "name": folder.name,
            "kind": "articulated",
            "product": "flap",
            "prompt": prompt,
            "checks": CHECKS,
        }
        (folder / "task.json").write_text(json.dumps(task))
    return tasks_in(tmp_path / "tasks")


def learner(_task: Task) -> LLM:
    """A model that gets its script wrong at first, unless it has seen one that was right."""

    def first(request: Request) -> str:
        shown = "Parts of other products that were built well" in json.dumps(request.to_json())
        return stories.fenced(stories.FLAP_SCRIPTS["flap"] if shown else "def build(part):\n    return None")

    return stories.flap(part__flap__1=first, part__flap__2=stories.fenced(stories.FLAP_SCRIPTS["flap"]))


def run(tasks: list[tuple[Path, Task]], out: Path, ask: Any = learner, **options: Any) -> list[Row]:
    return run_tasks(tasks, out, ask, kernel=stories.kernel(), cache=stories.shared_cache(), look=False, **options)


def test_with_a_store_fewer_answers_are_needed_than_without(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    store = ExperienceStore(tmp_path / "memory")

    without = run(tasks, tmp_path / "without")
    with_store = run(tasks, tmp_path / "with", memory=StoredMemory(store), finished=lambda done: remember(done, store))

    assert [row.iterations for row in without] == [2, 2, 2]
    assert [row.iterations for row in with_store] == [2, 1, 1]
    assert all(row.ok for row in (*without, *with_store)), table(without)
    assert table(with_store)["all"]["iterations"]["mean"] < table(without)["all"]["iterations"]["mean"]


def test_a_benchmark_goes_on_where_it_was_and_a_failed_task_is_a_row(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    def fails_first(task: Task) -> LLM:
        return Scripted({"requirements": "no"}) if task.name == "flap_0" else stories.flap()

    rows = run(tasks, tmp_path / "out", fails_first)
    assert [row.ok for row in rows] == [False, True, True]
    assert "Error" in str(rows[0].error)

    def never(_task: Task) -> LLM:
        raise AssertionError("A row that is kept is not made again.")

    assert run(tasks, tmp_path / "out", never) == rows
    assert rows_in(tmp_path / "out") == rows
    report = table(rows)
    assert report["all"]["passed"] == {"mean": 0.6667, "interval": [0.0, 1.0], "n": 3}
    assert report["by_check"]["freedoms"]["n"] == 2
    again = run(tasks, tmp_path / "out", lambda _task: stories.flap(), variant="no-rollback")
    assert [row.ok for row in again] == [True, True, True]  # another way of running is another row
    assert [row.key for row in again] != [row.key for row in rows]


def test_files_of_any_tool_are_scored_and_a_missing_one_is_told(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    run(tasks[:1], tmp_path / "out", lambda _task: stories.flap())
    models = tmp_path / "models"
    next((tmp_path / "out" / "flap_0").glob("run_*/export/urdf")).rename(tmp_path / "urdf")
    models.mkdir()
    (tmp_path / "urdf").rename(models / "flap_0")
    two = '<robot name="x"><link name="a"/></robot>'
    (models / "flap_1.urdf").write_text(two)

    sound, poor, missing = score_files(tasks, models)

    assert sound.ok, sound
    assert not poor.ok
    assert [judgement.ok for judgement in poor.judgements] == [False, False, False, False]
    assert "no model of flap_2" in str(missing.error)


def test_the_command_lists_scores_and_prints_tables(
    tasks: list[tuple[Path, Task]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = str(tmp_path / "tasks")
    assert main(["bench", "list", "--tasks", folder, "--json"]) == 0
    assert [task["name"] for task in json.loads(capsys.readouterr().out)["tasks"]] == [task.name for _, task in tasks]
    assert main(["bench", "score", str(tmp_path), "--tasks", folder, "--task", "flap_1"]) == 0
    assert "0.0 % of 1 passed" in capsys.readouterr().out
    assert main(["bench", "list", "--tasks", folder, "--task", "flap1"]) != 0
    assert "Did you mean 'flap_1'" in capsys.readouterr().err


def test_a_task_of_the_wrong_form_is_refused_at_its_field(tmp_path: Path) -> None:
    (tmp_path / "task.json").write_text('{"schema": "articad.task/1", "name": "x", "kind": "soft", "product": "x", "checks": []}')
    with pytest.raises(ReadError, match=r"kind: .*articulated"):
        read_task(tmp_path)
