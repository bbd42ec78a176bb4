"""The benchmark runs, goes on, scores anyone's files, and shows what experience is worth, to a scripted model."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from articad.agents.llm import LLM, Reply, Request, Scripted
from articad.agents.recollection import StoredMemory, remember
from articad.cli import main
from articad.errors import ReadError, TransportError
from articad.memory.experience import ExperienceStore
from articad_bench.row import Row, rows_in
from articad_bench.runner import run_tasks
from articad_bench.scoring import score_files
from articad_bench.table import table
from articad_bench.task import Task, TaskBudget, read_task, tasks_in
from tests.agents import stories
from tests.agents.openai_stub import Canned, openai_stub

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
    assert report["all"]["checks"]["mean"] == pytest.approx(2 / 3, abs=1e-4)  # none hold of what was not made
    assert report["by_check"]["freedoms"]["n"] == 2
    again = run(tasks, tmp_path / "out", lambda _task: stories.flap(), variant="no-rollback")
    assert [row.ok for row in again] == [True, True, True]  # another way of running is another row
    assert [row.key for row in again] != [row.key for row in rows]


THICKER = {"summary": "A thicker flap.", "touches": ["flap"], "changes": {"parts.flap.dimensions.thickness": 3}}
EDIT = {"prompt": "a thicker flap", "checks": [{"kind": "part_size", "mm": [30, 10, 3]}, {"kind": "unchanged", "number": [1, 1]}]}


def edited(tasks: list[tuple[Path, Task]]) -> list[tuple[Path, Task]]:
    """The first task, with an edit."""
    (folder, task), *_ = tasks
    return [(folder, Task.model_validate(task.model_dump(mode="json") | {"edits": [EDIT]}))]


def test_an_edit_is_asked_for_once_the_product_stands_and_is_judged_with_all_that_must_hold_again(
    tasks: list[tuple[Path, Task]], tmp_path: Path
) -> None:
    asked = edited(tasks)
    good, still = (
        {"summary": "x", "touches": ["flap"], "changes": changes} for changes in (THICKER["changes"], {"parts.flap.color": "#ff0000"})
    )

    (row,) = run(asked, tmp_path / "good", lambda _task: stories.flap(edit__1=json.dumps(good)))
    (poor,) = run(asked, tmp_path / "still", lambda _task: stories.flap(edit__1=json.dumps(still)))
    (none,) = run(asked, tmp_path / "none", lambda _task: stories.flap(edit__1="no"))

    assert [judgement.kind for judgement in row.edited[0]] == ["parts", "freedoms", "solids", "clear_at_rest", "part_size", "unchanged"]
    assert row.ok, row
    assert row.calls == len(list((tmp_path / "good").glob("*/run_*/llm/**/*.json"))) + 1
    assert poor.failed == ("edit_1:part_size", "edit_1:unchanged")
    assert not poor.ok
    assert "edit/2" in str(none.edit_error)
    assert (none.error, none.ok, none.made) == (None, False, True)
    assert table([row, poor, none])["all"]["edited"]["mean"] == pytest.approx(0.3333)


def beginning_with_a_flap(tasks: list[tuple[Path, Task]], **more: Any) -> list[tuple[Path, Task]]:
    """The first task, which begins with a plate and a flap that is too thin, with one edit that lengthens it, and one that makes it thinner."""
    (folder, task), *_ = tasks
    (folder / "thin" / "parts").mkdir(parents=True)
    (folder / "thin" / "plan.json").write_text(json.dumps(stories.FLAP_PLAN))
    for name, script in stories.FLAP_SCRIPTS.items():
        (folder / "thin" / "parts" / f"{name}.py").write_text(script)
    unchanged = {"kind": "unchanged", "number": [1, 1]}
    edits = [{"prompt": text, "checks": [{"kind": "part_size", "mm": mm}, unchanged]} for text, mm in LATER.items()]
    asked = {"prompt": EDIT["prompt"], "checks": [*CHECKS, *EDIT["checks"]], "given": "thin", "edits": edits}
    return [(folder, Task.model_validate(task.model_dump(mode="json") | asked | more))]


LATER = {"a longer flap": [36, 10, 3], "a thinner one": [36, 10, 2.5]}
CHAIN = [json.dumps(THICKER | {"changes": {f"parts.flap.dimensions.{name}": mm}}) for name, mm in (("length", 36), ("thickness", 2.5))]


def test_a_task_begins_with_a_product_and_each_edit_of_its_chain_is_judged_against_the_stage_before(
    tasks: list[tuple[Path, Task]], tmp_path: Path
) -> None:
    asked, first = beginning_with_a_flap(tasks), Scripted({"edit/1": json.dumps(THICKER)})
    (row,) = run(asked, tmp_path / "good", lambda _task: first, ask_edit=lambda _task, n: Scripted({"edit/1": CHAIN[n - 1]}))
    (poor,) = run(asked, tmp_path / "poor", lambda _task: first, ask_edit=lambda _task, _n: Scripted({"edit/1": CHAIN[1]}))
    (none,) = run(asked, tmp_path / "none", lambda _task: first, ask_edit=lambda _task, _n: Scripted({"edit/1": "no"}))
    (scored,) = score_files(asked, tmp_path / "good")

    assert row.ok, row
    assert [len(stage) for stage in row.edited] == [6, 6]
    assert row.calls == 3
    assert Row.from_json(row.to_json()) == row
    assert scored.ok, scored
    assert poor.failed == ("edit_1:part_size", "edit_2:part_size", "edit_2:unchanged")
    assert (poor.ok, none.ok, none.edited, none.error) == (False, False, (), None)
    assert "edit/2" in str(none.edit_error)
    assert table([row, poor, none])["all"]["edited"]["mean"] == pytest.approx(0.3333)
    assert table([poor])["all"]["edit_checks"]["mean"] == pytest.approx((5 / 6 + 4 / 6) / 2, abs=1e-4)


def test_the_product_that_a_task_begins_with_is_scored_as_a_tool_reads_it_and_must_be_the_same(
    tasks: list[tuple[Path, Task]], tmp_path: Path
) -> None:
    asked = beginning_with_a_flap(tasks, edits=[])
    run(asked, tmp_path / "out", lambda _task: Scripted({"edit/1": json.dumps(THICKER)}))
    models, folder = tmp_path / "models", asked[0][0]
    assert main(["build", str(folder / "thin"), "--out", str(tmp_path / "thin"), "--export", "urdf"]) == 0
    models.mkdir()
    shutil.copytree(next((tmp_path / "out" / "flap_0").glob("run_*/export/urdf")), models / "flap_0")

    (strange,) = score_files(asked, models)  # its meshes are rounded, so no shape is the same to the last bit
    shutil.copytree(tmp_path / "thin" / "export" / "urdf", models / "flap_0_given")
    (read,) = score_files(asked, models)
    shutil.rmtree(models / "flap_0_given")
    shutil.copytree(models / "flap_0", models / "flap_0_given")
    (another,) = score_files(asked, models)

    assert strange.failed == ("unchanged",)
    assert read.ok, read
    assert "not the product that flap_0 begins with" in str(another.error)


def test_a_run_uses_no_more_than_the_budget_of_its_task_allows_in_all_its_stages(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    def of(**budget: int) -> Row:
        asked = [(folder, task.model_copy(update={"budget": TaskBudget(**budget)})) for folder, task in chain]
        (row,) = run(asked, tmp_path / str(budget), lambda _task: Scripted({"edit/1": json.dumps(THICKER)}), ask_edit=edits)
        return row

    def edits(_task: Task, number: int) -> LLM:
        return Scripted({"edit/1": CHAIN[number - 1]})

    chain = beginning_with_a_flap(tasks)
    enough, few = of(calls=3, characters=1_000_000), of(calls=2)
    assert enough.ok, enough
    assert (len(few.edited), few.calls) == (1, 2)
    assert "The task allows 2 calls" in str(few.edit_error)
    short = of(characters=1000)
    assert "The task allows 1000 characters; 0 were used" in str(short.error)


def test_what_was_answered_before_a_run_was_killed_counts(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    chain = [(folder, task.model_copy(update={"budget": TaskBudget(calls=2)})) for folder, task in beginning_with_a_flap(tasks)]
    asked: list[int] = []

    def edits(_task: Task, number: int) -> LLM:
        if not asked:
            asked.append(number)
            raise TransportError("no line")
        return Scripted({"edit/1": CHAIN[number - 1]})

    (lost,) = run(chain, tmp_path / "out", lambda _task: Scripted({"edit/1": json.dumps(THICKER)}), ask_edit=edits)
    (again,) = run(chain, tmp_path / "out", lambda _task: Scripted({}), ask_edit=edits)

    assert (len(lost.edited), len(again.edited), again.calls) == (0, 1, 2)
    assert "The task allows 2 calls" in str(again.edit_error)


def test_an_edited_file_of_any_tool_is_scored_against_what_it_was(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    asked = edited(tasks)
    run(asked, tmp_path / "out", lambda _task: stories.flap(edit__1=json.dumps(THICKER)))
    models = tmp_path / "models"
    models.mkdir()
    for kind, name in (("run", "flap_0"), ("edit_1", "flap_0_edited_1")):
        next((tmp_path / "out" / "flap_0").glob(f"{kind}_*/export/urdf")).rename(models / name)

    (row,) = score_files(asked, models)
    (ours,) = score_files(asked, tmp_path / "out")
    (models / "flap_0_edited_1").rename(models / "flap_1_edited_1")
    (missing,) = score_files(asked, models)

    assert row.ok, row
    assert ours.ok, ours
    assert "no model of flap_0_edited_1" in str(missing.edit_error)
    assert not missing.ok


def test_a_task_whose_provider_was_out_of_reach_is_made_again(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    class Down:
        def complete(self, request: Request) -> Reply:
            raise TransportError(f"no line for {request.step}")

    (row,) = run(tasks[:1], tmp_path / "out", lambda _task: Down())
    (again,) = run(tasks[:1], tmp_path / "out", lambda _task: stories.flap())

    assert "TransportError" in str(row.error)
    assert again.ok


def test_a_defect_of_ours_costs_one_task_and_not_the_benchmark(tasks: list[tuple[Path, Task]], tmp_path: Path) -> None:
    class Broken:
        def complete(self, request: Request) -> Reply:
            raise ZeroDivisionError(request.step)

    rows = run(tasks[:2], tmp_path / "out", lambda task: Broken() if task.name == "flap_0" else stories.flap())

    assert [row.ok for row in rows] == [False, True]
    assert "ZeroDivisionError: requirements" in str(rows[0].error)
    assert rows_in(tmp_path / "out") == rows


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
    assert "all: 0 % [0, 0] of 1 passed" in capsys.readouterr().out
    assert main(["bench", "list", "--tasks", folder, "--task", "flap1"]) != 0
    assert "Did you mean 'flap_1'" in capsys.readouterr().err


def test_tasks_run_and_are_scored_in_processes_of_their_own(
    tasks: list[tuple[Path, Task]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(tasks[:1], tmp_path / "out", lambda _task: stories.flap())
    common = ["--tasks", str(tmp_path / "tasks"), "--task", "flap_0", "--task", "flap_1", "--at-once", "2", "--json"]

    assert main(["bench", "score", str(tmp_path / "out"), *common]) == 0
    scored = json.loads(capsys.readouterr().out)["rows"]
    with openai_stub([Canned("no")]) as stub:
        asked = [
            "--out",
            str(tmp_path / "asked"),
            "--model",
            "stub",
            "--api-base",
            stub.address,
            "--no-look",
            "--memory",
            str(tmp_path / "store"),
        ]
        assert main(["bench", "run", *asked, *common]) == 0
    ran = json.loads(capsys.readouterr().out)["rows"]

    assert [(row["task"], row["passed"]) for row in scored] == [("flap_0", True), ("flap_1", False)]
    assert [(row["task"], row["calls"], row["tokens"]) for row in ran] == [("flap_0", 3, 30), ("flap_1", 3, 30)]
    assert all("OutputError" in row["error"] for row in ran)
    assert [row.task for row in rows_in(tmp_path / "asked")] == ["flap_0", "flap_1"]


def test_a_repair_of_ours_is_passed_by_an_edit_that_mends_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = tasks_in(names=["repair_bookcase"])
    right = {"parts.back.dimensions.width": 800, "parts.back.dimensions.height": 900}
    mended, half = (
        json.dumps({"summary": "x", "touches": ["back"], "changes": changes}) for changes in (right, {"parts.back.dimensions.width": 800})
    )

    (row,) = run(asked, tmp_path / "right", lambda _task: Scripted({"edit/1": mended}))
    (poor,) = run(asked, tmp_path / "half", lambda _task: Scripted({"edit/1": half}))

    assert row.ok, row
    assert not poor.ok
    assert main(["bench", "list", "--task", "repair_bookcase"]) == 0
    assert "20 calls, 800000 characters" in " ".join(capsys.readouterr().out.split())


def test_a_task_of_the_wrong_form_is_refused_at_its_field(tmp_path: Path) -> None:
    (tmp_path / "task.json").write_text('{"schema": "articad.task/1", "name": "x", "kind": "soft", "product": "x", "checks": []}')
    with pytest.raises(ReadError, match=r"kind: .*articulated"):
        read_task(tmp_path)
