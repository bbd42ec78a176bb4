"""Drawings and the exploded view: FreeCAD projects every view, measures every dimension, and moves the parts as planned."""

from __future__ import annotations

import io
import json
import re
import tempfile
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from lxml import etree

import articad as ac
from articad import cli
from articad.errors import ExportError, KernelUnavailableError
from articad.export.bundle import Bundle
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_look import verify
from articad.formats import convert
from articad.importers.freecad import read_freecad
from articad.kernels import freecad_install
from articad.kernels.freecad_file import packed
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from tests.freecad import cupboard, opened
from tests.freecad.test_split import same, two_boxes

VERSIONS = pytest.mark.parametrize(
    "freecad", [freecad_install.find, pytest.param(opened.newer, marks=pytest.mark.freecad_next)], ids=["1.0", "next"]
)


@cache
def content() -> bytes:
    bundle = write_freecad(cupboard.assembly(), drawings=True)
    assert not bundle.findings, bundle.findings
    return bundle.files[bundle.main]


def objects(document: bytes) -> list[tuple[str, dict[str, str]]]:
    """Return the type and the plain values of each object."""
    with zipfile.ZipFile(io.BytesIO(document)) as archive:
        root = etree.fromstring(archive.read("Document.xml"))
    types = {row.get("name"): row.get("type") for row in root.iterfind("Objects/Object")}
    found = []
    for item in root.iterfind("ObjectData/Object"):
        rows = {row.get("name"): row[0].get("value") for row in item.iterfind("Properties/Property") if len(row)}
        found.append((str(types[item.get("name")]), rows))
    return found


@pytest.mark.freecad
@opened.needs_freecad
def test_each_part_has_a_page_with_the_dimensions_of_the_plan() -> None:
    held, made = objects(content()), cupboard.assembly()
    assert made.resolved is not None
    links = {name for name, part in made.resolved.parts.items() if part.derivation is not None and part.derivation.S is None}
    pages = {rows["Label"] for kind, rows in held if kind == "TechDraw::DrawPage"}
    assert pages == {"Drawing of cupboard", *(f"Drawing of {name}" for name in set(made.parts) - links)}
    measured = [(rows["FormatSpec"], float(rows["ArticadValue"])) for kind, rows in held if kind == "TechDraw::DrawViewDimension"]
    for name, part in made.resolved.parts.items():
        for dimension, value in part.dimensions.items() if name not in links else ():
            assert any(dimension in text.split() and measure == pytest.approx(float(value)) for text, measure in measured), (
                f"{name}.{dimension}"
            )
    assert sorted(rows["Text"] for kind, rows in held if kind == "TechDraw::DrawViewBalloon") == [str(n) for n in range(1, len(pages))]
    assert sum(kind == "TechDraw::DrawViewSpreadsheet" for kind, _ in held) == 1


@pytest.mark.freecad
@opened.needs_freecad
def test_a_circle_is_not_named_after_a_length_that_is_equal_to_its_radius() -> None:
    """The crank's spigot is 6 mm long, and its shaft has a radius of 6 mm. The knob's shape is turned in its part."""
    folder = Path(__file__).resolve().parents[2] / "examples" / "four_bar"
    bundle = write_freecad(ac.build(ac.AssemblyPlan.load(folder / "plan.json"), folder / "parts"), drawings=True)
    assert not bundle.findings, bundle.findings  # of each FreeCAD that is installed
    kinds = [(rows["FormatSpec"], kind) for kind, rows in objects(bundle.files[bundle.main]) if kind == "TechDraw::DrawViewDimension"]
    round_ones = [text for text, _ in kinds if text.startswith(("R", "\u2300"))]
    assert any("shaft_radius" in text for text in round_ones)
    assert not [text for text in round_ones if "length" in text or "thickness" in text]
    assert not [text for text, _ in kinds if text not in round_ones and "radius" in text]


@pytest.mark.freecad
@opened.needs_freecad
@VERSIONS
def test_freecad_projects_all_views_and_measures_all_dimensions(freecad: Callable[[], FreeCAD]) -> None:
    assert not verify(content(), cupboard.assembly(), freecad())


@pytest.mark.freecad
@opened.needs_freecad
def test_a_dimension_that_is_not_the_plans_is_an_error_with_its_page() -> None:
    with zipfile.ZipFile(io.BytesIO(content())) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    changed, count = re.subn(rb'(name="ArticadValue"[^>]*>\s*<Float value=")20\.0*"', rb'\g<1>20.5"', files["Document.xml"])
    assert count == 1
    other = packed(files | {"Document.xml": changed})
    findings = [finding for finding in verify(other, cupboard.assembly(), freecad_install.find()) if "Drawing of" in finding.message]
    assert [finding.code for finding in findings] == ["E_FREECAD"]
    assert "Drawing of knob" in findings[0].message


@pytest.mark.freecad
@opened.needs_freecad
@VERSIONS
def test_the_exploded_view_moves_each_part_away(freecad: Callable[[], FreeCAD]) -> None:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "it.FCStd").write_bytes(content())
        program = Path(__file__).with_name("exploded_by_freecad.py")
        ended = freecad().run(program, folder=folder, limits=FreeCADLimits(seconds=300.0))
        assert (folder / "exploded.json").is_file(), ended.said
        report = json.loads((folder / "exploded.json").read_text())
    made = cupboard.assembly()
    before, after = opened.frames(report["before"]), opened.frames(report["after"])
    assert report["assembly"]
    assert opened.small(opened.moved(dict(made.at()), before), 1e-6, 1e-8)
    assert after[made.ground].allclose(before[made.ground], mm=1e-9, rad=1e-12)
    shifts = {name: after[name].translation - before[name].translation for name in made.parts}
    for joint in made.joints:
        apart = shifts[joint.child] - shifts[joint.parent]
        axis = (made.at()[joint.parent] @ joint.T_parent_connector).rotation[:, 2]
        assert np.linalg.norm(np.cross(apart, axis)) < 1e-6, joint.name
        assert np.linalg.norm(apart) > 1.0, joint.name
    assert max(float(np.linalg.norm((before[name].inverse() @ after[name]).log()[3:])) for name in before) < 1e-9


@pytest.mark.freecad
@opened.needs_freecad
def test_a_drawn_document_comes_back_and_comes_out_the_same(tmp_path: Path) -> None:
    again = write_freecad(cupboard.assembly(), drawings=True)
    assert again.files[again.main] == content()
    same(cupboard.assembly(), read_freecad(Bundle(again.files).write(tmp_path)[0]))


@pytest.mark.freecad
@opened.needs_freecad
@VERSIONS
def test_drawings_show_the_files_of_a_divided_document(freecad: Callable[[], FreeCAD]) -> None:
    bundle = write_freecad(cupboard.assembly(), drawings=True, split=True)
    assert not bundle.findings, bundle.findings
    assert not verify(bundle.files, cupboard.assembly(), freecad())


def test_drawings_need_freecad(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def absent() -> FreeCAD:
        raise KernelUnavailableError("none", findings=[], looked_in=(), how_to_get="install it")

    whole = Bundle(write_freecad_alone(two_boxes()).files).write(tmp_path)[0]
    monkeypatch.setattr(freecad_install, "find", absent)
    with pytest.raises(KernelUnavailableError):
        write_freecad(two_boxes(), drawings=True)
    assert cli.main(["convert", str(whole), str(tmp_path / "other.FCStd"), "--drawings"]) != 0
    with pytest.raises(ExportError, match="no option drawings"):
        convert(whole, tmp_path / "other.urdf", drawings=True)
