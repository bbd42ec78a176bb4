from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

from articad.errors import ExportError, ReadError, UnrepresentableError
from articad.formats import FORMAT_OF, READERS, WRITERS, convert, read
from tests.assemblies import geared_pair

# FreeCAD writes its documents itself, which tests/freecad holds to more than this
TARGETS = [suffix for suffix in FORMAT_OF if FORMAT_OF[suffix] != "freecad"]


@pytest.mark.parametrize(("source", "target"), list(product(["urdf", "mjcf"], TARGETS)))
def test_any_format_that_is_read_becomes_any_that_is_written(source: str, target: str, tmp_path: Path) -> None:
    bundle = WRITERS[source](geared_pair(), meshes="obj")
    bundle.write(tmp_path)
    assembly, converted = convert(tmp_path / bundle.main, tmp_path / f"out{target}")

    assert list(assembly.parts) == list(geared_pair().parts)
    assert converted.files == WRITERS[FORMAT_OF[target]](assembly).files
    if FORMAT_OF[target] in {"urdf", "mjcf"}:
        assert converted.files == WRITERS[FORMAT_OF[target]](geared_pair()).files


def test_every_format_has_a_writer_and_every_reader_a_format() -> None:
    assert set(FORMAT_OF.values()) == set(WRITERS)
    assert set(READERS) <= set(FORMAT_OF)


def test_losses_are_told_and_strict_refuses(tmp_path: Path) -> None:
    bundle = WRITERS["urdf"](geared_pair())
    bundle.write(tmp_path)

    assert convert(tmp_path / bundle.main, "a.glb")[1].losses
    with pytest.raises(UnrepresentableError):
        convert(tmp_path / bundle.main, "a.glb", strict=True)


def test_unknown_endings_are_named_with_those_that_are_known(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"\.urdf, \.xml"):
        read(tmp_path / "a.blend")
    with pytest.raises(ExportError, match=r"\.urdf, \.xml"):
        convert(tmp_path / "a.urdf", "a.blend")
