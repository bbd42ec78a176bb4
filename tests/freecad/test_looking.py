"""A document is verified by looking at it: a shape that FreeCAD cannot read, or that is another, is an error with the part's name."""

from __future__ import annotations

import importlib.util
import io
import re
import sys
import zipfile
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType

import build123d
import numpy as np
import pytest

import articad as ac
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_look import verify
from articad.kernels import freecad_file, freecad_install
from tests.freecad import opened

ROOT = Path(__file__).resolve().parents[2]


@cache
def assembly(name: str) -> ac.Assembly:
    return ac.build(ac.AssemblyPlan.load(ROOT / "examples" / name / "plan.json"), ROOT / "examples" / name / "parts")


@cache
def content(name: str) -> bytes:
    bundle = write_freecad_alone(assembly(name))
    return bundle.files[bundle.main]


def breps(document: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(document)) as archive:
        return {name: archive.read(name) for name in archive.namelist() if name.endswith(".brp")}


def test_no_shape_of_a_document_has_a_bound_without_end() -> None:
    for name, part in (("four_bar", "knob"), ("stewart_platform", "platform")):
        solid = assembly(name).parts[part].solid
        assert solid is not None
        assert solid.brep is not None
        assert re.search(rb"2e\+100", solid.brep.read_bytes()), f"{part} no longer has the surfaces that this test is about"
        for file, brep in breps(content(name)).items():
            numbers = [float(number) for number in re.findall(rb"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.])", brep)]
            assert max(map(abs, numbers)) < freecad_file.ENDLESS, file


def test_only_a_bound_without_end_is_taken_away() -> None:
    far = b"2" + b"0" * 100
    kept = b"10 0 1.5 -2 4 \n1 0 0 0 0 0 1 1 0 -0 -0 1 0 \n8 0 3\n7 0 0 1 2 2  8 2e+100 0\n"
    assert freecad_file.bounded(kept) == kept
    endless = b"10 2.09 8.37 -2e+100 2e+100\n2 -8 14\n10 0 1 -%s %s \n2 1 1\n8 -2e+100 2e+100\n1 0 0\n" % (far, far)
    assert freecad_file.bounded(endless) == b"2 -8 14\n2 1 1\n1 0 0\n"


@pytest.mark.freecad
@opened.needs_freecad
def test_what_freecad_sees_is_compared_with_the_assembly() -> None:
    made, document = assembly("metronome"), content("metronome")
    freecad = freecad_install.find()
    assert not verify(document, made, freecad)
    solid = made.parts["pendulum"].solid
    assert solid is not None
    for other in (replace(solid, volume=solid.volume * (1 + 1e-5)), replace(solid, com=solid.com + np.array([0.0, 0.01, 0.0]))):
        changed = replace(made, parts=dict(made.parts) | {"pendulum": replace(made.parts["pendulum"], solid=other)})
        (finding,) = verify(document, changed, freecad)
        assert (finding.code, finding.where, finding.parts) == ("E_FREECAD", "parts.pendulum", ("pendulum",))


@pytest.mark.freecad
@opened.needs_freecad
@pytest.mark.parametrize("spoilt", [b"", b"\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 0\nCurve2ds 0\n"])
def test_a_shape_that_freecad_cannot_read_is_an_error_with_the_parts_name(spoilt: bytes) -> None:
    made = assembly("metronome")
    with zipfile.ZipFile(io.BytesIO(content("metronome"))) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    files["pendulum_body.Shape.brp"] = spoilt
    findings = verify(freecad_file.packed(files), made, freecad_install.find())
    assert ("E_FREECAD", ("pendulum",)) in {(finding.code, finding.parts) for finding in findings}
    assert all(finding.parts in ((), ("pendulum",)) for finding in findings)


def shape_file(shape: build123d.Shape, path: Path) -> bytes:
    build123d.export_brep(shape, path)
    return path.read_bytes()


def turned_inside_out() -> build123d.Shape:
    """A solid whose shell lacks a face: OCCT calls it invalid."""
    shell = build123d.Shell(build123d.Box(3, 4, 5).faces()[:-1])
    return build123d.Solid(shell)


CORNER = build123d.Pos(10, 10, 0) * build123d.Box(10, 10, 10)
TANGENT = CORNER + build123d.Box(10, 10, 10) + build123d.Pos(5, 5, -6) * build123d.Box(20, 20, 2)
FAULTY: dict[str, tuple[build123d.Shape, str]] = {
    "two solids that touch along an edge": (
        build123d.Compound([build123d.Box(10, 10, 10).solid(), CORNER.solid()]),
        "has 2 solids, not one; solid 1, of 1000 mm³ about (0, 0, 0), touches solid 2 at (5, 5, ",
    ),
    "a solid that touches itself": (
        build123d.Compound([TANGENT.solid(), (build123d.Pos(50) * CORNER).solid()]),
        "touches itself along an edge at (5, 5, 0)",
    ),
    "an open solid": (turned_inside_out(), "is not a valid solid; solid 1, of "),
}


@pytest.mark.freecad
@opened.needs_freecad
@pytest.mark.parametrize("kind", FAULTY)
def test_the_solids_of_a_faulty_part_are_told(kind: str, tmp_path: Path) -> None:
    shape, words = FAULTY[kind]
    with zipfile.ZipFile(io.BytesIO(content("metronome"))) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    files["pendulum_body.Shape.brp"] = shape_file(shape, tmp_path / "it.brep")
    findings = verify(freecad_file.packed(files), assembly("metronome"), freecad_install.find())
    assert any(words in finding.message for finding in findings), str(findings)


@pytest.mark.freecad
@opened.needs_freecad
def test_a_document_that_nothing_can_open_is_an_error() -> None:
    findings = verify(b"PK\x05\x06" + bytes(18), assembly("metronome"), freecad_install.find())
    assert findings.codes == ("E_FREECAD",)


@pytest.mark.freecad_next
def test_every_example_passes_in_every_version_and_the_table_says_so() -> None:
    assert [freecad.version[:2] for freecad in freecad_install.installed() if freecad.version] == [(1, 0), (1, 1)]
    text, wrong = versions().page()
    assert not wrong
    assert versions().PAGE.read_text() == text


@pytest.mark.freecad_next
def test_the_next_freecad_loses_a_shape_whose_surfaces_have_no_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """The fault that `bounded` mends: written as before, the knob is gone, and the look says so."""
    for module in ("articad.export.freecad_job", "articad.export.freecad_file"):
        monkeypatch.setattr(sys.modules[module], "bounded", lambda brep: brep)
    written = write_freecad(assembly("four_bar"), freecad=freecad_install.find())
    findings = verify(written.files[written.main], assembly("four_bar"), opened.newer())
    assert "E_FREECAD" in findings.codes


def versions() -> ModuleType:
    spec = importlib.util.spec_from_file_location("freecad_versions", ROOT / "scripts" / "freecad_versions.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
