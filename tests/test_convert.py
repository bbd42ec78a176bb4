from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

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
    with pytest.raises(ReadError, match=r"\.urdf, \.xml"):
        read(tmp_path / "a.blend")
    with pytest.raises(ExportError, match=r"\.urdf, \.xml"):
        convert(tmp_path / "a.urdf", "a.blend")
