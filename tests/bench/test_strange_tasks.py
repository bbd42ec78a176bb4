"""Tasks, rows and opinions of strangers: nothing outside their folder is read, least of all sent to a model, and nothing blocks."""

from __future__ import annotations

import json
import os
import shutil
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from articad import examples
from articad.errors import ReadError
from articad_bench.check import Judgement
from articad_bench.judge import DIMENSIONS, JUDGED, opinions_in
from articad_bench.judged_table import judged_table
from articad_bench.reference import references
from articad_bench.row import ROW, Row, kept_row, rows_in
from articad_bench.table import table
from articad_bench.task import read_image, read_json, read_task, write_task
from tests.crash.stand_in import FixedKernel
from tests.test_records import WRONG, changed, places, without

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no pipes in folders")
SECRET = "the first words of a secret"
TASK = {"name": "t", "kind": "articulated", "product": "box", "prompt": "a box", "checks": [{"kind": "parts", "number": [1, 9]}]}


@pytest.fixture(autouse=True)
def soon() -> Iterator[None]:
    """Interrupt what blocks."""

    def interrupt(*_: object) -> None:
        raise AssertionError("it blocks")

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.alarm(60)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture
def task(tmp_path: Path) -> Path:
    (tmp_path / "secret.png").write_text(SECRET)
    (tmp_path / "task").mkdir()
    return tmp_path / "task"


@pytest.mark.parametrize("image", ["../secret.png", "/etc/passwd", "..", "", "a/../../secret.png", "a\\b", "a\0b"])
def test_a_task_names_no_picture_outside_its_folder(image: str, task: Path) -> None:
    (task / "task.json").write_text(json.dumps(TASK | {"images": [image]}))
    with pytest.raises(ReadError, match="images") as error:
        read_task(task)
    assert SECRET not in error.value.message


@pytest.mark.parametrize("name", ["../t", "/t", "..", ""])
def test_a_task_has_no_name_that_is_a_place_elsewhere(name: str, task: Path) -> None:
    (task / "task.json").write_text(json.dumps(TASK | {"name": name}))
    with pytest.raises(ReadError, match="name"):
        read_task(task)


@pytest.mark.parametrize(
    ("check", "where"),
    [
        ({"kind": "clear_in_motion", "steps": 10**9}, "steps"),
        ({"kind": "clear_in_motion", "steps": 0}, "steps"),
        ({"kind": "certified", "seconds": float("inf")}, "seconds"),
        ({"kind": "meshes", "teeth": [18, 0]}, "teeth.1"),
        ({"kind": "room", "mm": [100, 1e-9, 100]}, "mm.1"),
        ({"kind": "size", "mm": [None, 1e300, None]}, "mm.1"),
        ({"kind": "size", "mm": [None, float("nan"), None]}, "mm.1"),
        ({"kind": "joints", "joint": {"type": "slider", "span": [0, 10**400]}}, "joint.span.1"),
    ],
)
@pytest.mark.parametrize("edited", [False, True])
def test_numbers_that_let_a_judge_work_without_end_are_refused(check: dict[str, Any], where: str, edited: bool, task: Path) -> None:
    asked = {"edits": [{"prompt": "another", "checks": [check]}]} if edited else {"checks": [check]}
    (task / "task.json").write_text(json.dumps(TASK | asked))
    with pytest.raises(ReadError, match=f"{where} of the check '{check['kind']}' is ") as error:
        read_task(task)
    assert len(error.value.message) < 400


@pytest.mark.parametrize("checks", [None, {}, [None], [[1]], [{"kind": ["size"], "mm": 1}], [{"kind": {}, "mm": 1e99}], [{"1": 1}]])
def test_checks_that_are_no_list_of_objects_are_refused(checks: Any, task: Path) -> None:
    (task / "task.json").write_text(json.dumps(TASK | {"checks": checks}))
    with pytest.raises(ReadError, match="checks"):
        read_task(task)


@pytest.mark.parametrize("kind", ["link", "pipe", "folder", "missing"])
def test_a_picture_that_is_no_file_of_its_folder_is_refused(kind: str, task: Path, tmp_path: Path) -> None:
    (task / "task.json").write_text(json.dumps(TASK | {"images": ["a.png"]}))
    if kind == "link":
        (task / "a.png").symlink_to(tmp_path / "secret.png")
    elif kind == "pipe":
        os.mkfifo(task / "a.png")
    elif kind == "folder":
        (task / "a.png").mkdir()
    for use in (lambda: read_image(task, "a.png"), lambda: write_task(read_task(task), tmp_path / "copy", beside=task)):
        with pytest.raises(ReadError, match="picture"):
            use()
    assert not (tmp_path / "copy" / "a.png").exists()


@pytest.mark.parametrize(
    ("place", "reader"),
    [
        ("task.json", read_task),
        (ROW, lambda folder: rows_in(folder.parent)),
        (f"{JUDGED}/j/t.json", opinions_in),
        ("any.json", lambda folder: read_json(folder / "any.json")),
    ],
)
@pytest.mark.parametrize("kind", ["link", "pipe", "device", "nested"])
def test_what_is_no_regular_file_of_json_is_refused(kind: str, place: str, reader: Callable[[Path], object], task: Path) -> None:
    file = task / place
    file.parent.mkdir(parents=True, exist_ok=True)
    if kind == "link":
        file.symlink_to(task.parent / "secret.png")
    elif kind == "pipe":
        os.mkfifo(file)
    elif kind == "device":
        file.symlink_to("/dev/zero")
    else:
        file.write_text("[" * 100_000)
    assert kept_row(task, "k") is None
    with pytest.raises((ReadError, OSError, ValueError)) as error:
        reader(task)
    assert SECRET not in str(error.value)


_ROW = Row(
    "t",
    "hard",
    "text",
    1,
    (Judgement("parts", ok=True, wanted="w", measured="m"),),
    ((Judgement("parts", ok=False, wanted="w", measured="m"),),),
)
_OPINION = {
    "schema": "s", "task": "t", "kind": "hard", "judge": "j", "made": True, "moves": True, "error": None, "calls": 1, "tokens": 2, "cost": 0.1, "key": "k",
    "opinion": dict.fromkeys(("parts", "comparison", "keyframes"), "x") | {name: {"reason": "r", "score": 5} for name in DIMENSIONS},
}  # fmt: skip


@pytest.mark.parametrize(
    ("place", "record", "reader"),
    [
        (ROW, _ROW.to_json(), lambda folder: json.dumps(table(rows_in(folder.parent)))),
        (f"{JUDGED}/j/t.json", _OPINION, lambda folder: json.dumps(judged_table(opinions_in(folder)))),
    ],
    ids=["row", "opinion"],
)
def test_a_wrong_value_anywhere_in_somebodys_results_is_an_error_that_says_where(
    place: str, record: dict[str, Any], reader: Callable[[Path], object], task: Path
) -> None:
    file = task / place
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(record))
    reader(task)
    refused: list[tuple[str, str]] = []
    whole = json.loads(json.dumps(record))
    for path in places(whole):
        for wrong in [changed(whole, path, value) for value in WRONG] + ([without(whole, path)] if path else []):
            file.write_text(json.dumps(wrong))
            try:
                reader(task)
            except ReadError as error:
                refused.append((str(path[0] if path else file), str(error.findings[0])))
    assert len(refused) > 50
    assert [said for place, said in refused if place not in said or str(file) not in said] == []
    file.write_text("[" + "[]," * 3_200_000 + "1]")
    with pytest.raises(ReadError, match="values"):
        reader(task)


@pytest.fixture
def stranger(task: Path) -> Path:
    """A sound solution outside the task's folder, which no task may lead to."""
    folder = task.parent / "elsewhere"
    shutil.copytree(examples.folder("four_bar"), folder)
    return folder


@pytest.mark.parametrize("name", ["../elsewhere", "ABSOLUTE", "..", "", "a/../../elsewhere", "a\\b", "a\0b"])
@pytest.mark.parametrize("whose", ["reference", "edit"])
def test_a_task_names_no_solution_outside_its_folder(whose: str, name: str, task: Path, stranger: Path) -> None:
    named = str(stranger) if name == "ABSOLUTE" else name
    edit = {"prompt": "wider", "checks": TASK["checks"], "reference": named}
    (task / "task.json").write_text(json.dumps(TASK | ({"edits": [edit]} if whose == "edit" else {"reference": named})))
    with pytest.raises(ReadError, match="reference"):
        read_task(task)


@pytest.mark.parametrize("linked", [".", "plan.json", "parts"])
@pytest.mark.parametrize("whose", ["reference", "edit"])
def test_a_link_to_a_solution_outside_the_tasks_folder_is_not_followed(whose: str, linked: str, task: Path, stranger: Path) -> None:
    """The folder of a solution, its plan, or the folder of its scripts is a link."""
    edit = {"prompt": "wider", "checks": TASK["checks"], "reference": "edited"}
    (task / "task.json").write_text(json.dumps(TASK | {"edits": [edit]}))
    for name in ("reference", "edited"):
        shutil.copytree(stranger, task / name)
    place = task / ("reference" if whose == "reference" else "edited")
    if (place / linked).is_dir():
        shutil.rmtree(place / linked)
    else:
        (place / linked).unlink()
    (place / linked).symlink_to(stranger / linked)
    with pytest.raises(ReadError, match="link"):
        list(references(task, read_task(task), kernel=FixedKernel()))
