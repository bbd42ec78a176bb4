"""An assembly as one file for each part: FreeCAD and articad find the same in it as in one document."""

from __future__ import annotations

import io
import json
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path, PurePosixPath

import pytest

import articad as ac
from articad import cli
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import ExportError, ReadError
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_look import verify
from articad.formats import write
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.importers.freecad import read_document, read_freecad
from articad.kernels import freecad_install
from articad.kernels.freecad_file import packed
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from articad.kinematics.declare import fixed
from articad.runs.pull import pull
from tests.freecad import cupboard, opened

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
VERSIONS = pytest.mark.parametrize(
    "freecad", [freecad_install.find, pytest.param(opened.newer, marks=pytest.mark.freecad_next)], ids=["1.0", "next"]
)
CHANGED = {"width": 480.0, "wall": 18.0, "ajar": 20.0}


@cache
def metronome() -> ac.Assembly:
    return ac.build(ac.AssemblyPlan.load(EXAMPLES / "metronome" / "plan.json"), EXAMPLES / "metronome" / "parts")


@cache
def alone() -> Mapping[str, bytes]:
    return write_freecad_alone(metronome(), split=True).files


@cache
def native() -> Mapping[str, bytes]:
    bundle = write_freecad(cupboard.assembly(), split=True)
    assert not bundle.findings, bundle.findings
    return bundle.files


def steps(files: Mapping[str, bytes], *wanted: opened.Json, freecad: FreeCAD, program: Path = opened.EXAMINE) -> list[opened.Json]:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        main = ac.Bundle(files).write(folder)[0].name
        (folder / "job.json").write_text(json.dumps({"file": main, "steps": wanted}))
        ended = freecad.run(program, folder=folder, limits=FreeCADLimits(seconds=600.0))
        assert (folder / "report.json").is_file(), ended.said
        return list(json.loads((folder / "report.json").read_text())["steps"])


def replaced(content: bytes, before: str, after: str) -> bytes:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    assert before.encode() in files["Document.xml"]
    return packed(files | {"Document.xml": files["Document.xml"].replace(before.encode(), after.encode())})


def same(made: ac.Assembly, read: ac.Assembly) -> None:
    assert not read.findings, read.findings
    assert list(read.parts) == list(made.parts)
    assert [(joint.name, joint.type, joint.parent, joint.child, joint.limits) for joint in read.joints] == [
        (joint.name, joint.type, joint.parent, joint.child, joint.limits) for joint in made.joints
    ]
    mine, theirs = made.at(), read.at()
    for name, part in made.parts.items():
        other = read.parts[name]
        assert part.mass is not None
        assert other.mass is not None
        assert theirs[name].allclose(mine[name], mm=1e-9, rad=1e-12), name
        assert other.mass.mass == pytest.approx(part.mass.mass, rel=1e-9)
        assert other.color == part.color


def test_each_part_is_one_file_and_comes_back(tmp_path: Path) -> None:
    made = metronome()
    derived = {name for name, part in made.resolved.parts.items() if part.derivation is not None} if made.resolved else set()
    assert set(alone()) == {
        "metronome.FCStd",
        *(f"metronome_parts/{name}.FCStd" for name in {*made.parts, "Parameters"} - derived),
    }
    same(made, read_freecad(ac.Bundle(alone()).write(tmp_path)[0]))


def test_the_content_is_that_of_one_document(tmp_path: Path) -> None:
    whole = write_freecad_alone(metronome())
    one, many = (read_document(ac.Bundle(files).write(tmp_path / name)[0]) for name, files in (("one", whole.files), ("many", alone())))
    assert one.edits == many.edits == ()
    assert {name for name in many.now if not name.endswith("__part")} == set(one.now)
    for name, held in one.now.items():
        if held["type"] != "App::Part":
            assert many.now[name]["expressions"] == held["expressions"], name


def test_parts_whose_names_differ_in_case_alone_have_files_of_their_own_on_every_system(tmp_path: Path) -> None:
    """Windows and macOS take two such names for one file, and some names for devices; `Parameters` has a file, too."""
    names = ["Arm", "arm", "ARM", "con", "aux", "parameters", "assembly", "arm_2"]
    connector = Connector("c", SE3.identity())
    parts = [Part.from_mesh(name, box(1 + number, 1, 1), density=1.0, connectors={"c": connector}) for number, name in enumerate(names)]
    joints = [fixed(f"{part.name}_fixed", parts[0]["c"], part["c"]) for part in parts[1:]]
    wanted = ac.Assembly.from_parts("cases", parts=parts, joints=joints, ground="Arm")
    bundle = write_freecad_alone(wanted, split=True)
    stems = [PurePosixPath(path).stem.casefold() for path in list(bundle.files)[1:]]
    assert len({*stems, "parameters"}) == len(stems) + 1 == len(names) + 1
    assert not {"con", "aux"} & set(stems)
    bundle.write(tmp_path)
    found = read_freecad(tmp_path / bundle.main)
    same(wanted, found)


def test_an_edit_of_a_parts_file_is_found_and_pulled(tmp_path: Path) -> None:
    (resolved,) = [metronome().resolved]
    assert resolved is not None
    value = float(resolved.parameters["height"])
    files = dict(alone())
    written = files["metronome_parts/Parameters.FCStd"]
    files["metronome_parts/Parameters.FCStd"] = replaced(written, f'<Float value="{value!r}"/>', '<Float value="222.0"/>')
    main = ac.Bundle(files).write(tmp_path)[0]
    (finding,) = [finding for finding in read_freecad(main).findings if "height" in finding.message]
    assert finding.where == "objects.Parameters"
    assert pull(resolved.plan, main).changes == {"parameters.height.value": 222.0}


def test_an_object_with_the_name_of_another_files_object_is_named(tmp_path: Path) -> None:
    files = dict(alone())
    for part, object_name in (("nut", "nut_body"), ("weight", "weight_body")):
        path = f"metronome_parts/{part}.FCStd"
        files[path] = replaced(files[path], f'name="{object_name}"', 'name="Body"')
    edits = read_document(ac.Bundle(files).write(tmp_path)[0]).edits
    assert edits is not None
    assert {(edit.kind, edit.object) for edit in edits if "Body" in edit.object} == {("added", "Body"), ("added", "weight#Body")}


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    main = ac.Bundle(alone()).write(tmp_path)[0]
    (tmp_path / "metronome_parts" / "nut.FCStd").unlink()
    with pytest.raises(ReadError, match=r"metronome_parts/nut\.FCStd"):
        read_freecad(main)


def two_boxes(size: float = 30.0) -> ac.Assembly:
    end = {"end": Connector("end", SE3.trans(0.0, 0.0, 1.5))}
    one, two = (ac.Part.from_mesh(name, box(size, 5.0, 3.0), density=2700.0, connectors=end) for name in ("one", "two"))
    return ac.Assembly.from_parts("boxes", parts=[one, two], joints=[ac.fixed("weld", one["end"], two["end"])], ground="one")


def test_a_later_export_replaces_its_own_files_and_no_others(tmp_path: Path) -> None:
    write(two_boxes(), tmp_path / "boxes.FCStd", split=True)
    first = (tmp_path / "boxes_parts" / "two.FCStd").read_bytes()
    write(two_boxes(40.0), tmp_path / "boxes.FCStd", split=True)
    assert (tmp_path / "boxes_parts" / "two.FCStd").read_bytes() != first
    foreign = packed({"Document.xml": b"<Document/>"})
    (tmp_path / "boxes_parts" / "two.FCStd").write_bytes(foreign)
    with pytest.raises(ExportError, match="articad did not write"):
        write(two_boxes(), tmp_path / "boxes.FCStd", split=True)
    assert (tmp_path / "boxes_parts" / "two.FCStd").read_bytes() == foreign


def test_the_command_line_divides_a_document(tmp_path: Path) -> None:
    whole = ac.Bundle(write_freecad_alone(two_boxes()).files).write(tmp_path / "whole")[0]
    target = tmp_path / "parts" / "again.FCStd"
    assert cli.main(["convert", str(whole), str(target), "--split"]) == 0
    assert {path.name for path in (target.parent / "boxes_parts").iterdir()} == {"one.FCStd", "two.FCStd"}
    assert list(read_freecad(target).parts) == ["one", "two"]
    assert cli.main(["convert", str(whole), str(tmp_path / "again.urdf"), "--split"]) != 0


@pytest.mark.freecad
@opened.needs_freecad
@VERSIONS
def test_freecad_finds_every_part_of_features_mirrors_links_and_shapes(freecad: Callable[[], FreeCAD]) -> None:
    assert not verify(native(), cupboard.assembly(), freecad())
    assert not verify(alone(), metronome(), freecad())


@pytest.mark.freecad
@opened.needs_freecad
@VERSIONS
def test_values_of_frozen_parts_are_fixed_in_every_file(freecad: Callable[[], FreeCAD]) -> None:
    """The assembly shows the parameters by a link, which has their label and their marks."""
    (seen,) = steps(alone(), freecad=freecad(), program=Path(__file__).with_name("values_by_freecad.py"))
    assert {label for name, (label, _) in seen.items() if name.endswith("#Parameters")} == {"Parameters (all fixed)"}
    assert sum(name.endswith("#Parameters") for name in seen) == 2
    for name, (label, values) in seen.items():
        assert values, name
        assert all(group.startswith("Fixed ") and fixed for group, fixed in values.values()), name
        assert label.endswith(("(all fixed)", "(frozen shape)")), name


@pytest.mark.freecad
@opened.needs_freecad
def test_a_look_at_divided_files_sees_a_spoilt_part() -> None:
    files = dict(alone())
    with zipfile.ZipFile(io.BytesIO(files["metronome_parts/nut.FCStd"])) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    files["metronome_parts/nut.FCStd"] = packed(entries | {"nut_body.Shape.brp": b""})
    findings = verify(files, metronome(), freecad_install.find())
    assert ("E_FREECAD", ("nut",)) in {(finding.code, finding.parts) for finding in findings}


@pytest.mark.freecad
@opened.needs_freecad
@VERSIONS
def test_a_parameter_moves_the_parts_of_all_files(freecad: Callable[[], FreeCAD]) -> None:
    (after,) = steps(native(), {"do": "set", "values": CHANGED}, freecad=freecad())
    expected = cupboard.assembly().with_parameters(**CHANGED)
    assert after["invalid"] == []
    for name, T in opened.frames(after["parts"]).items():
        assert T.allclose(expected.at()[name], mm=1e-6, rad=1e-8), name
    for part in expected.parts.values():
        assert part.solid is not None
        assert after["volumes"][part.name] == pytest.approx(part.solid.volume, rel=1e-6), part.name


@pytest.mark.freecad
@opened.needs_freecad
def test_a_divided_document_with_features_comes_back(tmp_path: Path) -> None:
    same(cupboard.assembly(), read_freecad(ac.Bundle(native()).write(tmp_path)[0]))
    again = write_freecad(cupboard.assembly(), split=True)
    assert again.files == native()
