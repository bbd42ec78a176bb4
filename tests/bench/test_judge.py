"""Judges score what they see, each alone and once; the table states their means, and how far they agree."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad.agents.llm import Image, Reply, Request, Scripted, Usage
from articad.cli import main
from articad.errors import TransportError
from articad_bench.judge import Judged, Opinion, judge_files, opinions_in
from articad_bench.judged_table import judged_table
from articad_bench.runner import run_tasks
from articad_bench.task import Task, tasks_in
from tests.agents import stories

CHECKS: list[dict[str, Any]] = [{"kind": "parts", "number": [2, 2]}, {"kind": "freedoms", "number": 1}, {"kind": "solids"}]


def said(geometry: int, detail: int, motion: int) -> str:
    steps = {"parts": "a plate, a flap", "comparison": "as asked", "keyframes": "it opens"}
    return json.dumps(
        steps
        | {
            name: {"score": score, "reason": f"{name} seen"}
            for name, score in zip(("geometry", "detail", "motion"), (geometry, detail, motion), strict=True)
        }
    )


def opinion(*scores: int) -> Opinion:
    return Opinion.model_validate_json(said(*scores))


@pytest.fixture(scope="module")
def tasks(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Path, Task]]:
    root = tmp_path_factory.mktemp("tasks")
    for name, kind in (("flap", "articulated"), ("slab", "static"), ("none", "articulated")):
        folder = root / name
        folder.mkdir()
        checks = CHECKS if kind == "articulated" else [CHECKS[0], CHECKS[2]]
        task = {"name": name, "kind": kind, "product": name, "prompt": f"a {name} to be scored", "checks": checks}
        (folder / "task.json").write_text(json.dumps(task))
    return tasks_in(root)


@pytest.fixture(scope="module")
def models(tasks: list[tuple[Path, Task]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What was made of the flap and the slab: a flap either way."""
    out = tmp_path_factory.mktemp("models")
    made = [pair for pair in tasks if pair[1].name != "none"]
    run_tasks(made, out, lambda _task: stories.flap(), kernel=stories.kernel(), cache=stories.shared_cache(), look=False)
    return out


@pytest.mark.slow
def test_each_judge_sees_the_product_and_the_request_and_is_asked_once(tasks: list[tuple[Path, Task]], models: Path) -> None:
    first = Scripted({"bench_judge/*": Reply(said(5, 4, 3), "a", Usage(100, 20), 0.01)})
    second = Scripted({"bench_judge/*": said(4, 4, 2)})

    rows = judge_files(tasks, models, {"a": lambda: first, "b": lambda: second})
    again = judge_files(tasks, models, {"a": lambda: Scripted({}), "b": lambda: Scripted({})})

    assert [(row.task, row.judge) for row in rows] == [(task, judge) for task in ("flap", "none", "slab") for judge in "ab"]
    assert [row.score("detail") for row in rows] == [4, 4, 1, 1, 4, 4]
    assert "no model of none" in str(rows[2].error)
    assert (rows[0].calls, rows[0].tokens, rows[0].cost) == (1, 120, 0.01)
    assert [row for row in again if row.made] == [row for row in rows if row.made]
    assert sorted((row.judge, row.task) for row in opinions_in(models)) == [(judge, task) for judge in "ab" for task in ("flap", "slab")]
    request = first.requests[0]
    recipes = [dict(part.recipe or {})["of"] for message in request.messages for part in message.parts if isinstance(part, Image)]
    assert recipes == ["assembly", "part", "part", "motion"]
    assert "a flap to be scored" in json.dumps(request.to_json())
    assert "plate and" not in json.dumps(request.to_json()["messages"][0])  # nothing of who made it, or how


@pytest.mark.slow
def test_an_answer_without_a_form_is_asked_for_again_and_one_that_never_has_it_is_no_score(
    tasks: list[tuple[Path, Task]], models: Path
) -> None:
    one = [pair for pair in tasks if pair[1].name == "flap"]
    half = said(5, 4, 3).replace('"score": 4', '"score": 3.5')

    (mended,) = judge_files(one, models, {"mended": lambda: Scripted({"bench_judge/flap": half, "bench_judge/flap/2": said(2, 2, 2)})})
    (lost,) = judge_files(one, models, {"lost": lambda: Scripted({"bench_judge/*": half})})

    assert (mended.score("detail"), mended.calls) == (2, 2)
    assert (lost.score("detail"), lost.calls) == (None, 3)
    assert "OutputError" in str(lost.error)


@pytest.mark.slow
def test_a_kept_opinion_is_of_what_the_task_checks_today(tasks: list[tuple[Path, Task]], models: Path) -> None:
    ((folder, task),) = [pair for pair in tasks if pair[1].name == "flap"]
    more = Task.model_validate(task.model_dump(mode="json") | {"checks": [{"kind": "parts", "number": [3, 3]}]})

    (before,) = judge_files([(folder, task)], models, {"k": lambda: Scripted({"bench_judge/*": said(3, 3, 3)})})
    (after,) = judge_files([(folder, more)], models, {"k": lambda: Scripted({})})

    assert (before.made, after.made) == (True, False)
    assert after.opinion == before.opinion


@pytest.mark.slow
def test_a_judge_out_of_reach_is_asked_again_another_time(tasks: list[tuple[Path, Task]], models: Path) -> None:
    class Down:
        def complete(self, request: Request) -> Reply:
            raise TransportError(f"no line for {request.step}")

    one = [pair for pair in tasks if pair[1].name == "flap"]
    (row,) = judge_files(one, models, {"c": Down})
    (again,) = judge_files(one, models, {"c": lambda: Scripted({"bench_judge/*": said(3, 3, 3)})})

    assert row.opinion is None
    assert again.score("motion") == 3


@pytest.mark.slow
def test_judges_see_files_of_any_tool_as_they_see_runs(tasks: list[tuple[Path, Task]], models: Path, tmp_path: Path) -> None:
    urdf = next((models / "flap").glob("run_*/export/urdf"))
    (tmp_path / "flap").symlink_to(urdf)
    judge = Scripted({"bench_judge/*": said(5, 5, 5)})

    (row,) = judge_files([pair for pair in tasks if pair[1].name == "flap"], tmp_path, {"a": lambda: judge})

    assert row.made
    recipes = [dict(part.recipe or {})["of"] for message in judge.requests[0].messages for part in message.parts if isinstance(part, Image)]
    assert recipes == ["assembly", "part", "part", "motion"]


def row(task: str, judge: str, *scores: int, made: bool = True, moves: bool = True) -> Judged:
    return Judged(task, "articulated" if moves else "static", judge, made, moves, opinion(*scores) if scores else None, calls=1, tokens=100)


def test_the_table_tells_means_over_judges_agreement_and_motion_both_ways() -> None:
    rows = [
        *(row("one", judge, *scores) for judge, scores in (("a", (5, 4, 4)), ("b", (4, 4, 2)))),
        *(row("two", judge, *scores) for judge, scores in (("a", (2, 1, 2)), ("b", (1, 1, 2)))),
        *(row("still", judge, 3, 3, 1, moves=False) for judge in "ab"),
        *(row("none", judge, made=False) for judge in "ab"),
    ]

    report = judged_table(rows)

    assert report["all"]["geometry"]["mean"] == pytest.approx((4.5 + 1.5 + 3 + 1) / 4)
    assert report["by_judge"]["a"]["geometry"]["mean"] == pytest.approx((5 + 2 + 3 + 1) / 4)
    assert report["all"]["motion"]["mean"] == pytest.approx((3 + 2 + 1) / 3, abs=1e-4)
    assert report["all"]["motion_still_as_5"]["mean"] == pytest.approx((3 + 2 + 5 + 1) / 4)
    assert report["all"]["success"]["mean"] == 0.75
    agreement = report["agreement"]
    assert agreement["detail"]["krippendorff_alpha"]["value"] == 1
    assert agreement["detail"]["tasks"] == 3  # what was not made, nobody saw
    assert agreement["motion"]["tasks"] == 2
    assert 0.5 < agreement["geometry"]["icc_2k"]["value"] < 1
    assert agreement["geometry"]["icc_2k"]["interval"][0] <= agreement["geometry"]["icc_2k"]["value"]
    assert report["spent"]["tokens"] == {"mean": 100.0, "interval": [100.0, 100.0], "n": 8}


def test_the_command_needs_a_folder(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "judge", "--judge", "a/b"]) != 0
    assert "needs the folder" in capsys.readouterr().err
