from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from articad.errors import InvalidSolidError
from articad.export.freecad import write_freecad_alone
from articad.export.freecad_file import mesh_kernel
from articad.geometry.shapes import box, sphere
from articad.importers.freecad import read_freecad
from articad.importers.freecad_mesh import read_mesh_kernel
from tests.assemblies import geared_pair


def test_a_mesh_comes_back_in_single_precision() -> None:
    mesh = sphere(10.0)
    again = read_mesh_kernel(mesh_kernel(mesh))

    assert again.volume == pytest.approx(mesh.volume, rel=1e-6)
    assert again.is_closed
    assert np.allclose(np.sort(again.vertices, axis=0), np.sort(mesh.vertices, axis=0), rtol=0, atol=1e-6)


@pytest.mark.parametrize("keep", [0, 7, 8, 100, 271, 272, 300, -60])
def test_a_mesh_that_ends_early_is_refused(keep: int) -> None:
    with pytest.raises(InvalidSolidError):
        read_mesh_kernel(mesh_kernel(box(1, 2, 3))[:keep])


@pytest.mark.parametrize(("at", "word"), [(0, 7), (4, 9), (264, 2**31), (268, 2**32 - 1), (272 + 8 * 12, 99)])
def test_a_mesh_with_wrong_words_is_refused(at: int, word: int) -> None:
    content = bytearray(mesh_kernel(box(1, 2, 3)))
    content[at : at + 4] = struct.pack("<I", word)
    with pytest.raises(InvalidSolidError):
        read_mesh_kernel(bytes(content))


@pytest.mark.parametrize("metadata", [True, False])
def test_meshes_of_a_document_are_the_parts_shapes(metadata: bool, tmp_path: Path) -> None:
    first = geared_pair()
    bundle = write_freecad_alone(first)
    bundle.write(tmp_path)
    again = read_freecad(tmp_path / bundle.main, metadata=metadata)

    for name, part in first.parts.items():
        assert part.mesh is not None
        found = again.parts[name].mesh
        assert found is not None
        assert found.volume == pytest.approx(part.mesh.volume, rel=1e-6)


def test_a_mesh_that_is_not_one_is_left_out_with_a_finding(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.export.freecad_job.mesh_kernel", lambda _: b"no mesh")
    bundle = write_freecad_alone(geared_pair())
    bundle.write(tmp_path)
    again = read_freecad(tmp_path / bundle.main)

    assert "W_FREECAD_SHAPE" in again.findings.codes
    assert all(part.mesh is None for part in again.parts.values())
    assert again.joints == geared_pair().joints
