"""Exports and reports of the examples are small: meshes for drawing are not the meshes of the proofs."""

from __future__ import annotations

import pytest

from articad.entry import read
from articad.export.gltf import write_glb
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.report import report_page
from tests.export import judges

QUICK = ("sewing_things_box", "four_bar")
MOST_MESHES, MOST_REPORT = 3_000_000, 2_000_000  # bytes


@pytest.mark.slow
@pytest.mark.parametrize("name", [n if n in QUICK else pytest.param(n, marks=pytest.mark.soak) for n in judges.example_names()])
def test_an_example_has_small_exports_and_a_small_report(name: str) -> None:
    assembly = read(judges.folder_of(name))

    for write in (write_urdf, write_mjcf):
        assert sum(len(content) for path, content in write(assembly).files.items() if path.endswith((".stl", ".obj"))) < MOST_MESHES
    assert sum(map(len, write_glb(assembly).files.values())) < MOST_MESHES
    assert len(report_page(assembly).encode()) < MOST_REPORT
