from __future__ import annotations

import re
from itertools import product
from pathlib import Path

import pytest
import trimesh

from articad.errors import ExportError, ReadError, UnrepresentableError
from articad.formats import FORMATS, NAMED, convert, format_of, read, readable, write
from tests.assemblies import geared_pair

# FreeCAD writes its documents itself, which tests/freecad holds to more than this
TARGETS = [suffix for row in FORMATS for suffix in row.suffixes if row.name != "freecad"]


@pytest.mark.parametrize(("source", "target"), list(product(["urdf", "mjcf"], TARGETS)))
def test_any_format_that_is_read_becomes_any_that_is_written(source: str, target: str, tmp_path: Path) -> None:
    bundle = NAMED[source].write(geared_pair(), meshes="obj")
    bundle.write(tmp_path)
    assembly, converted = convert(tmp_path / bundle.main, tmp_path / f"out{target}")

    assert list(assembly.parts) == list(geared_pair().parts)
    written_as = format_of(f"out{target}")
    assert written_as is not None
    main, *others = written_as.write(assembly).files.items()
    assert dict(converted.files) == dict([(f"out{target}", main[1]), *others])
    if written_as.name in {"urdf", "mjcf"}:
        assert list(converted.files.values()) == list(written_as.write(geared_pair()).files.values())
    assert all((tmp_path / name).read_bytes() == content for name, content in converted.files.items())


def test_each_ending_means_one_format() -> None:
    endings = [suffix for row in FORMATS for suffix in row.suffixes]
    assert len(set(endings)) == len(endings)
    assert set(readable()) <= set(endings)


def test_an_option_goes_to_the_writer_that_has_it_and_an_unknown_one_is_refused_by_name(tmp_path: Path) -> None:
    assert "<actuator>" in write(geared_pair(), tmp_path / "a.xml", actuators="position").files["a.xml"].decode()
    with pytest.raises(ExportError, match=r"urdf has no option actuators; it has .*collision"):
        write(geared_pair(), tmp_path / "a.urdf", actuators="position")
    assert not (tmp_path / "a.urdf").exists()


def test_losses_are_told_and_strict_refuses(tmp_path: Path) -> None:
    bundle = NAMED["urdf"].write(geared_pair())
    bundle.write(tmp_path)

    assert convert(tmp_path / bundle.main, tmp_path / "a.glb")[1].losses
    with pytest.raises(UnrepresentableError):
        convert(tmp_path / bundle.main, tmp_path / "a.glb", strict=True)


def test_unknown_endings_are_named_with_those_that_are_known(tmp_path: Path) -> None:
    (tmp_path / "a.blend").touch()
    with pytest.raises(ReadError, match=r"\.urdf, \.xml"):
        read(tmp_path / "a.blend")
    with pytest.raises(ExportError, match=r"\.urdf, \.xml"):
        convert(tmp_path / "a.urdf", "a.blend")


ROBOT = '<robot name="r"><link name="a"><visual><geometry><mesh filename="meshes/a.stl"/></geometry></visual></link></robot>'


def with_own_mesh(folder: Path) -> Path:
    """Write a robot whose own mesh lies where articad would write one, in metres."""
    (folder / "meshes").mkdir(parents=True)
    trimesh.creation.box().export(folder / "meshes" / "a.stl")
    (folder / "r.urdf").write_text(ROBOT)
    return folder / "r.urdf"


def digests(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("target", ["r.xml", "copy.urdf", "r.sdf"])
def test_a_mesh_of_somebody_else_is_not_replaced_and_the_advice_works(target: str, tmp_path: Path) -> None:
    source = with_own_mesh(tmp_path / "robot")
    before = digests(tmp_path)

    with pytest.raises(ExportError) as refused:
        convert(source, source.parent / target)
    assert digests(tmp_path) == before
    (finding,) = refused.value.findings
    assert finding.code == "E_REPLACES"

    convert(source, re.findall(r"Write (\S+), or", finding.hint)[0])
    assert {path: content for path, content in digests(tmp_path).items() if path in before} == before


def test_a_mesh_that_another_file_names_is_not_replaced_and_ones_own_is(tmp_path: Path) -> None:
    source, out = with_own_mesh(tmp_path / "robot"), tmp_path / "out"
    convert(source, out / "r.xml")
    trimesh.creation.icosphere().export(source.parent / "meshes" / "a.stl")

    convert(source, out / "r.xml")  # written again, from a mesh that was changed
    trimesh.creation.box().export(source.parent / "meshes" / "a.stl")
    with pytest.raises(ExportError, match=r"which r\.xml names"):
        convert(source, out / "r.urdf")
    convert(source, out / "r.xml")
    convert(source, out / "r.urdf")  # the same mesh for both


@pytest.mark.parametrize("name", ["r.urdf", "./r.urdf"])
def test_a_file_is_not_converted_into_itself(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = with_own_mesh(tmp_path / "robot")
    monkeypatch.chdir(source.parent)
    before = digests(tmp_path)

    with pytest.raises(ExportError, match="Name another file"):
        convert("r.urdf", name)
    assert digests(tmp_path) == before


def test_a_folder_in_the_place_of_the_target_is_named(tmp_path: Path) -> None:
    (tmp_path / "a.xml").mkdir()
    with pytest.raises(ExportError, match=r"a\.xml is a folder") as refused:
        convert(with_own_mesh(tmp_path / "robot"), tmp_path / "a.xml")
    assert list((tmp_path / "a.xml").iterdir()) == []

    convert(tmp_path / "robot" / "r.urdf", re.findall(r"such as (\S+)\.$", refused.value.findings[0].hint)[0])


def test_a_urdf_in_the_place_of_its_srdf_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="this is a URDF"):
        read(with_own_mesh(tmp_path / "robot"), srdf=tmp_path / "robot" / "r.urdf")
