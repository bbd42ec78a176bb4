"""Batches, runs and models of strangers that hold pipes, devices, links, or numbers and nesting beyond reason."""

from __future__ import annotations

import ast
import json
import os
from dataclasses import replace
from functools import reduce
from pathlib import Path
from typing import Any

import pytest

import articad
from articad.agents import drift
from articad.batches.batch import read_batch
from articad.batches.items import BatchItem
from articad.cli import main
from articad.errors import ReadError, WriteError
from articad.export.names import file_name
from articad.kinematics.mechanism import Mechanism
from articad.render.camera import VIEWS
from articad.render.files import write_motion
from articad.runs.run import Run, RunRequest
from articad.simulation import examine
from tests.chains import chain
from tests.test_records import WRONG, changed, places

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no pipes in folders")
SECRET = "the first words of a secret"


@pytest.mark.parametrize("text", ["[" * 100_000, '{"items": ' * 100_000, "null", '{"items": [{"plan": 1e400}]}', "\xff"])
def test_a_batch_that_is_none_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "batch.json").write_text(text, encoding="latin-1")
    with pytest.raises(ReadError):
        read_batch(tmp_path / "batch.json")


_BATCH: Any = {
    "schema": "articad.batch/1",
    "items": [{"plan": "plan.json", "values": {"width": 70.0}, "gates": ["rest"], "formats": ["urdf"], "kernel": "build123d"}],
    "sample": [{"plan": "plan.json", "count": 2, "seed": 1, "parameters": {"width": [60, 120]}, "gates": ["motion"], "formats": ["mjcf"]}],
}


@pytest.mark.parametrize("wrong", [*WRONG, -1, "x", True, [[]], [None, None], float("nan")], ids=lambda wrong: repr(wrong)[:20])
def test_a_wrong_value_anywhere_in_a_batch_is_refused_with_its_place(wrong: Any, tmp_path: Path) -> None:
    (tmp_path / "plan.json").write_text((Path(articad.__file__).parent / "starter" / "plan.json").read_text())
    file, refused = tmp_path / "batch.json", []
    for place in places(_BATCH):
        file.write_text(json.dumps(changed(_BATCH, place, wrong)))
        try:
            read_batch(file)
        except ReadError as error:
            refused.append((place, str(error)))
    assert refused
    assert [(place, said) for place, said in refused if wrong != "\ud800" and not all(step in said for step in place[:1])] == []


@pytest.mark.parametrize(("where", "key"), [((), "item"), (("items", 0), "value"), (("sample", 0), "parameter")])
def test_what_a_batch_names_wrongly_is_refused(where: tuple[Any, ...], key: str, tmp_path: Path) -> None:
    row = reduce(lambda value, step: value[step], where, _BATCH)
    (tmp_path / "batch.json").write_text(json.dumps(changed(_BATCH, where, {**row, key: 1})))
    with pytest.raises(ReadError, match=rf"{key}: there is no such field"):
        read_batch(tmp_path / "batch.json")


def test_a_sample_of_bounds_that_are_expressions_is_refused(tmp_path: Path) -> None:
    plan = json.loads((Path(articad.__file__).parent / "starter" / "plan.json").read_text())
    plan["parameters"][0] |= {"min": "1 + 1", "max": 900}
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    (tmp_path / "batch.json").write_text('{"sample": [{"plan": "plan.json", "count": 2}]}')
    with pytest.raises(ReadError, match=r"min or max of .width. is an expression"):
        read_batch(tmp_path / "batch.json")


@pytest.mark.parametrize("count", ["1000000000000", "1e308", "-1", "0"])
def test_a_batch_of_more_samples_than_reason_is_refused(count: str, tmp_path: Path) -> None:
    (tmp_path / "plan.json").write_text((Path(articad.__file__).parent / "starter" / "plan.json").read_text())
    (tmp_path / "batch.json").write_text(f'{{"sample": [{{"plan": "plan.json", "count": {count}, "parameters": {{"width": [1, 2]}}}}]}}')
    with pytest.raises(ReadError, match="count"):
        read_batch(tmp_path / "batch.json")


def test_a_batch_that_is_a_pipe_is_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "batch.json")
    with pytest.raises(ReadError, match="not a file"):
        read_batch(tmp_path / "batch.json")


@pytest.mark.parametrize("name", ["plan.json", "parts/a.py"])
@pytest.mark.parametrize("kind", ["pipe", "link", "device"])
def test_an_item_whose_plan_or_script_is_no_file_of_its_folder_is_refused(kind: str, name: str, tmp_path: Path) -> None:
    folder = tmp_path / "product"
    (folder / "parts").mkdir(parents=True)
    (tmp_path / "secret").write_text(SECRET)
    (folder / "plan.json").write_text("{}")
    place = folder / name
    place.unlink(missing_ok=True)
    if kind == "pipe":
        os.mkfifo(place)
    else:
        place.symlink_to(tmp_path / "secret" if kind == "link" else "/dev/zero")
    with pytest.raises(ReadError, match="cannot be read") as error:
        _ = BatchItem(str(folder)).digest
    assert SECRET not in error.value.message


@pytest.mark.parametrize("name", ["../../evil", "OUT/evil", "a/b", "\x1b[2J"])
def test_a_parts_list_stays_in_its_folder_whatever_the_product_is_called(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b"
    folder.mkdir(parents=True)
    name = name.replace("OUT", str(tmp_path)).replace("\x1b", "&#x9;")
    (folder / "it.urdf").write_text(
        f'<robot name="{name}"><link name="a"><visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>'
    )
    assert main(["bom", str(folder / "it.urdf"), "--out", str(folder / "papers"), "--json"]) == 0
    written = [path for path in tmp_path.rglob("*") if path.is_file() and path.name != "it.urdf"]
    assert {path.parent for path in written} == {folder / "papers"}
    assert all(path.name.isprintable() for path in written)


@pytest.mark.parametrize("name", ["../../evil", "OUT/evil", ".hidden"])
def test_a_film_stays_in_its_folder_whatever_the_joint_is_called(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b"
    name = name.replace("OUT", str(tmp_path))
    assembly = chain(2)
    (joint,) = assembly.mechanism.joints
    joints = [replace(joint, name=name)]
    renamed = replace(assembly, mechanism=Mechanism(assembly.mechanism.parts, assembly.ground, joints, []))
    files = write_motion(renamed, name, folder, size=64)
    assert [(file.parent, file.stem, file.is_file()) for file in files] == [(folder, file_name(name), True)] * 2


def test_no_film_has_the_files_of_another_joint_or_of_a_view(tmp_path: Path) -> None:
    """A folder holds the films of all joints and the views; each is drawn by a run of its own."""
    assembly, wanted = chain(6), ["a b", "a_b", "a/b", "front", "Iso"]
    joints = [replace(joint, name=name) for joint, name in zip(assembly.mechanism.joints, wanted, strict=True)]
    renamed = replace(assembly, mechanism=Mechanism(assembly.mechanism.parts, assembly.ground, joints, []))
    files = [file.name.casefold() for name in wanted for file in write_motion(renamed, name, tmp_path, size=32)]
    assert len({*files, *(f"{view}.png" for view in VIEWS)}) == 2 * len(wanted) + len(VIEWS)
    assert {"a_b.png", "a_b.gif"} < set(files)


def test_a_model_to_simulate_is_counted_before_it_is_parsed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    many = " ".join(f'a{number}="1"' for number in range(30_000))
    (tmp_path / "a.urdf").write_text(f"<robot {many}/>")

    def never(*_: object) -> None:
        raise AssertionError("a tree was built")

    monkeypatch.setattr("articad.importers.reading.etree.fromstring", never)
    assert examine._told(tmp_path / "a.urdf").rest == {}


def test_a_trace_that_became_a_link_is_not_written_through(tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    mine.write_text("kept")
    with Run.create(RunRequest(prompt="x"), out=tmp_path / "run") as run:
        (tmp_path / "run" / "trace.jsonl").unlink(missing_ok=True)
        (tmp_path / "run" / "trace.jsonl").symlink_to(mine)
        with pytest.raises(WriteError):
            run.trace("note", said="x")
    assert mine.read_text() == "kept"


def test_a_mesh_that_became_a_link_is_not_compared(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text(SECRET)
    with Run.create(RunRequest(prompt="x"), out=tmp_path / "run") as run:
        (tmp_path / "run" / "part.npz").symlink_to(tmp_path / "secret")
        assert list(drift._meshes(run, run, ["part.npz"])) == [(b"", b"")]


def test_no_module_parses_xml_by_its_path() -> None:
    """`read_xml` counts before it parses; a parser that opens files itself does not."""
    trees = {path.name: ast.parse(path.read_text(encoding="utf-8")) for path in Path(articad.__file__).parent.rglob("*.py")}
    uses = {(name, ast.unparse(node)) for name, tree in trees.items() for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    found = [use for use in sorted(uses) if use[1] in {"etree.parse", "etree.iterparse", "ET.parse", "ET.iterparse"}]
    assert found == []


def test_a_batch_is_read(tmp_path: Path) -> None:
    (tmp_path / "batch.json").write_text(json.dumps({"items": [{"plan": "product", "formats": ["urdf"]}]}))
    assert [Path(item.plan).name for item in read_batch(tmp_path / "batch.json")] == ["product"]
