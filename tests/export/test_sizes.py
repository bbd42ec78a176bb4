"""Exports and reports of the examples are small: meshes for drawing are not the meshes of the proofs."""

from __future__ import annotations

from pathlib import Path

import manifold3d
import pytest

from articad.agents.pipeline import replay
from articad.assembly import Assembly
from articad.entry import read
from articad.export.gltf import write_glb
from articad.export.meshes import drawn
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.geometry.inscribed.surface import manifold_of, mesh_of
from articad.kernels.cache import BuildCache
from articad.report import report_page
from articad.runs.record import assembly_of
from articad.runs.run import Run
from tests.export import judges
from tests.export.test_every_part import ANSWERED

QUICK = ("sewing_things_box", "four_bar")
MOST_MESHES, MOST_REPORT = 3_000_000, 2_000_000  # bytes


@pytest.mark.slow
@pytest.mark.parametrize("name", [n if n in QUICK else pytest.param(n, marks=pytest.mark.soak) for n in judges.example_names()])
def test_an_example_has_small_exports_and_a_small_report(name: str) -> None:
    assert_small(read(judges.folder_of(name)))


@pytest.mark.soak
@pytest.mark.parametrize("recording", ANSWERED, ids=lambda path: path.name)
def test_a_recorded_run_has_small_exports_and_a_small_report(recording: Path, tmp_path: Path) -> None:
    with Run.view(replay(recording, out=tmp_path / "run").run.path) as run:
        assert_small(assembly_of(run))


def assert_small(assembly: Assembly) -> None:
    for write in (write_urdf, write_mjcf):
        assert sum(len(content) for path, content in write(assembly).files.items() if path.endswith((".stl", ".obj"))) < MOST_MESHES
    assert sum(map(len, write_glb(assembly).files.values())) < MOST_MESHES
    assert len(report_page(assembly).encode()) < MOST_REPORT


def test_a_pin_in_a_long_bar_shares_no_volume_with_its_bore_where_both_are_drawn() -> None:
    """Who checks the files measures these meshes: 1/2000 of a long bar is more than the clearance of its bores."""
    bore = manifold3d.Manifold.cylinder(20, 4.15, 4.15, 128, center=True)
    bar = manifold3d.Manifold.cube((700, 30, 10), center=True) - bore.translate((330, 0, 0))
    pin = manifold3d.Manifold.cylinder(20, 4, 4, 128, center=True).translate((330, 0, 0))
    meshes = [drawn(mesh_of(solid), cache=BuildCache(None)).mesh for solid in (bar, pin)]
    assert len(meshes[0].triangles) < len(mesh_of(bar).triangles) / 2
    shared = manifold_of(meshes[0]) ^ manifold_of(meshes[1])
    assert shared.volume() == 0
