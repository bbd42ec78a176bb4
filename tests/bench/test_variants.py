"""Variants of tasks by a seed: the reference of each passes its own checks, and no answer to another seed, nor to the task itself, does."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from articad.assembly import Assembly
from articad.cli import main
from articad.kernels.kernel import BuildCache
from articad.plan.schema import AssemblyPlan
from articad_bench.cheat_run import refused_by
from articad_bench.reference import reference, references
from articad_bench.sentences import sentences
from articad_bench.subject import Subject
from articad_bench.task import TASKS, read_task, tasks_in
from articad_bench.variants import NoVariantError, make_variant
from tests.agents.stories import shared_cache

STARTER = Path(__file__).resolve().parents[2] / "articad" / "starter"
OURS = [task.name for _, task in tasks_in(TASKS)]
TRAY: dict[str, Any] = {
    "name": "tray",
    "kind": "articulated",
    "product": "tray",
    "prompt": "A tray 80 mm wide and 50 mm deep, 30 mm high without its lid, which turns by 100 degrees. Two parts.",
    "checks": [
        {"kind": "parts", "number": [2, 2]},
        {"kind": "joints", "joint": {"type": "revolute", "span": [99, 101]}, "number": [1, 1]},
        {"kind": "part_size", "mm": [80, 50, 30], "tolerance": 0.01},
        {"kind": "clear_at_rest"},
    ],
    "edits": [
        {
            "prompt": "Make it 90 mm wide in place of 80.",
            "checks": [{"kind": "part_size", "mm": [90, 50, 30], "tolerance": 0.01}],
            "values": {"width": 90},
        }
    ],
    "unheld": {"in place of 80": "What it was."},
}


def tray(folder: Path, **changes: Any) -> Path:
    place = folder / "tray"
    (place / "reference" / "parts").mkdir(parents=True)
    for file in ("plan.json", "parts/tray.py", "parts/lid.py"):
        (place / "reference" / file).write_bytes((STARTER / file).read_bytes())
    (place / "task.json").write_text(json.dumps(TRAY | changes))
    return place


def answer(folder: Path) -> Assembly:
    """Return the reference of a task as it is read from its files."""
    return reference(folder, read_task(folder), cache=shared_cache())


def passes(folder: Path) -> None:
    """A variant is a task like any other: its references pass, every number is held, and every check is stated."""
    task = read_task(folder)
    stages = [None, *references(folder, task, cache=shared_cache())]
    for stage, (before, product) in enumerate(pairwise(stages)):
        assert product is not None
        assert [judged for judged in task.judge(Subject(product, before=before), stage) if not judged.ok] == []
    table = sentences(task)
    assert [row.number.value for row in table.numbers if not row.held] == []
    assert [row.check for row in table.checks if row.stated is None] == []
    assert table.stale == ()


@pytest.mark.slow
def test_a_reference_may_have_one_script_for_all_parts(tmp_path: Path) -> None:
    folder = tray(tmp_path)
    scripts = {name: folder / "reference" / "parts" / f"{name}.py" for name in ("tray", "lid")}
    common = "\n\n".join(file.read_text().replace("def build(", f"def {name}(") for name, file in scripts.items())
    (folder / "reference" / "parts.py").write_text(common)
    for file in scripts.values():
        file.unlink()
    scripts["lid"].parent.rmdir()

    passes(make_variant(folder, read_task(folder), 1, tmp_path / "made", cache=shared_cache()).folder)


@pytest.mark.slow
def test_a_seed_gives_a_task_of_its_own_and_no_answer_to_another_seed_passes(tmp_path: Path) -> None:
    folder = tray(tmp_path)
    first, again, second = (
        make_variant(folder, read_task(folder), seed, tmp_path / name, cache=shared_cache())
        for seed, name in ((1, "first"), (1, "again"), (2, "second"))
    )

    for variant in (first, second):
        passes(variant.folder)
        for name, (old, new) in variant.changed.items():
            assert f" {old:g} " not in variant.task.prompt, name
            assert f" {new:g} " in variant.task.prompt, name
    assert first.changed == again.changed != second.changed
    assert (first.folder / "task.json").read_bytes() == (again.folder / "task.json").read_bytes()
    leaked = [answer(place) for place in (folder, first.folder, second.folder)]
    for variant, answers in ((first, (leaked[0], leaked[2])), (second, leaked[:2])):
        assert all(refused_by(variant.task, Subject(other)) is not None for other in answers)


@pytest.mark.slow
def test_an_edit_follows_with_what_it_says_of_the_number_before(tmp_path: Path) -> None:
    """A seed that changes the width changes both numbers of the edit; the plan's own bounds hold."""
    folder = tray(
        tmp_path,
        prompt="A tray 80 mm wide whose lid turns. Two parts.",
        checks=[TRAY["checks"][0], {"kind": "part_size", "mm": [80, None, None]}],
    )
    stored = json.loads((folder / "task.json").read_text())
    stored["edits"][0]["checks"] = [{"kind": "part_size", "mm": [90, None, None]}]
    (folder / "task.json").write_text(json.dumps(stored))

    variant = make_variant(folder, read_task(folder), 3, tmp_path / "made", cache=shared_cache())

    width, plan = variant.changed["width"][1], AssemblyPlan.load(variant.folder / "reference")
    (edit,) = variant.task.edits
    wider = edit.values["width"]
    assert edit.prompt == f"Make it {wider:g} mm wide in place of {width:g}."
    assert list(variant.task.unheld) == [f"in place of {width:g}"]
    assert wider == pytest.approx(90 * width / 80, abs=0.5)
    assert next(each.value for each in plan.parameters if each.name == "width") == width
    passes(variant.folder)


@pytest.mark.slow
def test_a_task_whose_numbers_cannot_change_gives_no_variant_and_says_why(tmp_path: Path) -> None:
    silent = tray(tmp_path / "silent", prompt="A tray with a lid.", edits=[], unheld={}, checks=TRAY["checks"][:1])
    with pytest.raises(NoVariantError, match="states no number"):
        make_variant(silent, read_task(silent), 1, tmp_path / "made", cache=shared_cache())

    wide = {"kind": "part_size", "mm": [80, None, None], "tolerance": 0.5}
    loose = tray(tmp_path / "loose", prompt="A tray 80 mm wide.", edits=[], unheld={}, checks=[wide])
    with pytest.raises(NoVariantError, match="the last one, width"):
        make_variant(loose, read_task(loose), 1, tmp_path / "made", cache=shared_cache())
    assert not (tmp_path / "made" / "tray").exists()


@pytest.mark.slow
def test_the_command_makes_variants_and_tells_which_tasks_have_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tray(tmp_path / "tasks")
    other = tray(tmp_path / "tasks" / "more", name="silent", prompt="A tray.", edits=[], unheld={}, checks=TRAY["checks"][:1])

    assert main(["bench", "make", "--seed", "2", "--tasks", str(tmp_path / "tasks"), "--out", str(tmp_path / "made")]) == 0

    assert "1 variants of 2 tasks with seed 2." in capsys.readouterr().out
    assert other.is_dir()
    assert [task.name for _, task in tasks_in(tmp_path / "made")] == ["tray"]
    assert [path.name for path in (tmp_path / "made").iterdir()] == ["tray"]

    kept = {path: path.read_bytes() for path in (tmp_path / "tasks").rglob("*") if path.is_file()}
    assert main(["bench", "make", "--seed", "2", "--tasks", str(tmp_path / "tasks"), "--out", str(tmp_path / "tasks")]) == 1
    assert f"{tmp_path / 'tasks' / 'tray'} is there already" in capsys.readouterr().out
    assert {path: path.read_bytes() for path in (tmp_path / "tasks").rglob("*") if path.is_file()} == kept


@pytest.mark.slow
@pytest.mark.soak
@pytest.mark.parametrize("name", OURS)
def test_variants_of_our_tasks_are_passed_by_their_own_references_alone(name: str, tmp_path: Path) -> None:
    ((folder, task),) = tasks_in(TASKS, names=[name])
    made = []
    for seed in (1, 2):
        try:
            made.append(make_variant(folder, task, seed, tmp_path / str(seed), cache=BuildCache()))
        except NoVariantError as error:
            pytest.skip(str(error))
    for variant, other in ((made[0], made[1]), (made[1], made[0])):
        passes(variant.folder)
        if variant.changed != other.changed:
            assert refused_by(variant.task, Subject(answer(other.folder))) is not None
