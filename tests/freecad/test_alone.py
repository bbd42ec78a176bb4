"""FreeCAD documents written without FreeCAD: what FreeCAD finds in them, beside what it writes itself."""

from __future__ import annotations

import struct
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import articad as ac
from articad import cli
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import ExportError, UnrepresentableError
from articad.export import freecad as freecad_export
from articad.export import freecad_native
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_file import mesh_kernel
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box
from articad.importers.freecad import read_freecad
from articad.kernels import freecad_install
from tests.chains import chain
from tests.freecad import opened

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SMALL_MM, SMALL_RAD = 1e-6, 1e-8
BREP = b"""
CASCADE Topology V1, (c) Matra-Datavision
Locations 3
1
1 0 0 2
0 1 0 3
0 0 1 4
1
0 -1 0 0
1 0 0 0
0 0 1 0
2 2 1 1 -1 0
Curve2ds 0
TShapes 1

+1 %d
"""


@cache
def assembly(name: str) -> ac.Assembly:
    return ac.build(ac.AssemblyPlan.load(EXAMPLES / name / "plan.json"), EXAMPLES / name / "parts")


@cache
def content(name: str) -> bytes:
    bundle = write_freecad_alone(assembly(name))
    assert [finding.code for finding in bundle.findings] == ["I_FREECAD_UNSEEN"]
    return bundle.files[bundle.main]


@pytest.mark.freecad
@opened.needs_freecad
@pytest.mark.parametrize("name", sorted(path.parent.name for path in EXAMPLES.glob("*/plan.json")))
def test_freecad_opens_it_and_solves_without_moving_a_part(name: str) -> None:
    made = assembly(name)
    leaf = [part for part in made.parts if part != made.ground][-1]
    shake: opened.Json = {"do": "perturb", "part": leaf, "by": [3.0, -5.0, 4.0, *SE3.rot_z(0.3).quaternion], "times": 5}
    look, solved, mended = opened.steps(content(name), {"do": "look"}, {"do": "solve"}, shake)
    rest = dict(made.at())
    assert look["invalid"] == look["touched"] == []
    assert look["visible"] == sorted(made.parts)
    assert solved["code"] == mended["code"] == 0
    assert opened.small(opened.moved(rest, opened.frames(solved["parts"])), SMALL_MM, SMALL_RAD)
    assert opened.small(opened.worst(made, opened.frames(look["parts"]), look["connectors"]), 1e-9, 1e-9)
    assert opened.small(opened.worst(made, opened.frames(mended["parts"])), SMALL_MM, SMALL_RAD)
    for part in made.parts.values():
        assert part.solid is not None
        assert look["volumes"][part.name] == pytest.approx(part.solid.volume, rel=1e-9), part.name
        assert np.asarray(look["boxes"][part.name]) == pytest.approx(part.solid.bbox, abs=2e-3), part.name


@pytest.mark.freecad
@opened.needs_freecad
@pytest.mark.parametrize("name", ["wardrobe", "geared_four_bar"])
def test_freecad_finds_in_it_what_it_writes_itself(name: str) -> None:
    bundle = write_freecad(assembly(name))
    (theirs,) = opened.steps(bundle.files[bundle.main], {"do": "look"})
    (ours,) = opened.steps(content(name), {"do": "look"})
    assert _own(ours["objects"]) == _own(theirs["objects"])
    assert ours["joints"] == theirs["joints"]
    assert ours["limits"] == theirs["limits"]
    assert ours["expressions"] == theirs["expressions"]
    for part, frames in opened.frames(theirs["parts"]).items():
        assert opened.frames(ours["parts"])[part].allclose(frames, mm=1e-12, rad=1e-12)
        for connector, frame in opened.frames(theirs["connectors"][part]).items():
            assert opened.frames(ours["connectors"][part])[connector].allclose(frame, mm=1e-12, rad=1e-12)


def _own(objects: list[str]) -> list[str]:
    """Return the types and names of objects, without the numbers that the lines and planes of origins have in their names."""
    numbered = ("App::Origin", "App::Line", "App::Plane")
    return sorted(name.partition(" ")[0] if name.startswith(numbered) else name for name in objects)


@pytest.mark.freecad
@opened.needs_freecad
def test_connectors_mirror_images_and_limits_follow_its_parameters() -> None:
    before, after = opened.steps(content("wardrobe"), {"do": "look"}, {"do": "set", "values": {"width": 1000.0, "opening": 90.0}})
    wider = assembly("wardrobe").with_parameters(width=1000.0, opening=90.0)
    assert after["invalid"] == []
    for part in ("cabinet", "door_left", "door_right", "drawer_lower"):
        for name, connector in wider.parts[part].connectors.items():
            assert after["connectors"][part][name][:3] == pytest.approx(connector.frame.translation, abs=1e-9)
    assert before["limits"]["hinge_left"]["AngleMin"] == pytest.approx(-105.0)
    assert after["limits"]["hinge_left"]["AngleMin"] == pytest.approx(-90.0)
    assert after["volumes"]["door_right"] == pytest.approx(before["volumes"]["door_right"], rel=1e-9)  # frozen, and mirrored anew


@pytest.mark.freecad
@opened.needs_freecad
def test_a_part_that_is_only_a_mesh_is_a_closed_mesh_in_freecad() -> None:
    (look,) = opened.steps(write_freecad_alone(two_boxes()).files["two_boxes.FCStd"], {"do": "look"})
    assert look["invalid"] == []
    assert look["meshes"] == {
        "one": {"volume": pytest.approx(450.0), "closed": True},
        "two": {"volume": pytest.approx(450.0), "closed": True},
    }


def test_without_freecad_documents_are_written_and_what_is_lost_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made = assembly("wardrobe")  # parts are built with the programs on the path
    for variable in ("ARTICAD_FREECAD", "XDG_DATA_HOME", "PATH"):
        monkeypatch.setenv(variable, str(tmp_path))
    bundle = write_freecad(made)
    assert bundle.findings.ok
    assert "articad install freecad" in next(iter(bundle.findings)).hint
    assert bundle.files[bundle.main] == content("wardrobe")  # each time the same bytes
    assert [loss.lost for loss in bundle.losses if loss.where == "parts.leg"]
    with pytest.raises(UnrepresentableError):
        write_freecad(assembly("geared_four_bar"), strict=True)


@pytest.mark.freecad
@opened.needs_freecad
def test_a_document_of_many_parts_says_that_freecad_did_not_check_it_and_how_to_let_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(freecad_export, "MOST_OPENED", 3)
    assert not write_freecad(chain(3)).findings
    (unseen,) = write_freecad(chain(4)).findings
    assert unseen.code == "I_FREECAD_UNSEEN"
    assert "4 here; up to 3 are checked" in unseen.message
    assert "write_freecad(assembly, freecad=articad.kernels.freecad_install.find())" in unseen.hint
    assert not write_freecad(chain(4), freecad=freecad_install.find()).findings


def test_without_freecad_the_commands_that_need_it_say_so_in_a_sentence(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for variable in ("ARTICAD_FREECAD", "XDG_DATA_HOME"):
        monkeypatch.setenv(variable, str(tmp_path))
    monkeypatch.setattr(freecad_install, "_NAMES", ("no_freecad",))  # a distribution may have one of its own
    plan = EXAMPLES / "metronome"
    assert cli.main(["build", str(plan), "--kernel", "freecad", "--out", str(tmp_path / "run")]) == 3
    refused = capsys.readouterr().err
    assert "FreeCAD 1.0 or later was not found" in refused
    assert "Run articad install freecad as root" in refused
    assert cli.main(["convert", str(plan / "plan.json"), str(tmp_path / "metronome.FCStd")]) == 0
    assert "I_FREECAD_UNSEEN" in capsys.readouterr().out
    assert len(read_freecad(tmp_path / "metronome.FCStd").parts) == len(assembly("metronome").parts)


@pytest.mark.parametrize("name", ["wardrobe", "jansen_leg", "stewart_platform"])
def test_it_is_read_back_as_what_it_was(name: str, tmp_path: Path) -> None:
    made = assembly(name)
    (path,) = write_freecad_alone(made).write(tmp_path)
    read = read_freecad(path)
    assert read.joints == made.joints
    assert list(read.parts) == list(made.parts)
    assert opened.small(opened.moved(dict(made.at()), dict(read.at())), 1e-9, 1e-9)


def two_boxes() -> ac.Assembly:
    end = {"end": Connector("end", SE3.trans(0.0, 0.0, 1.5))}
    one, two = (ac.Part.from_mesh(name, box(30.0, 5.0, 3.0), density=2700.0, connectors=end) for name in ("one", "two"))
    return ac.Assembly.from_parts("two_boxes", parts=[one, two], joints=[ac.fixed("weld", one["end"], two["end"])], ground="one")


def test_a_mesh_in_freecads_form_names_each_facets_neighbours() -> None:
    mesh = box(30.0, 5.0, 3.0)
    doubled = TriMesh(
        mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(36, dtype=np.int32).reshape(12, 3)
    )  # every corner once per triangle
    content = mesh_kernel(doubled)
    points, facets = struct.unpack("<II", content[264:272])
    assert (len(content), points, facets) == (272 + 8 * 12 + 12 * 24 + 24, 8, 12)
    rows = np.frombuffer(content, dtype="<u4", count=72, offset=272 + 96).reshape(12, 6)
    for number, row in enumerate(rows):
        for side in range(3):
            edge = {int(row[side]), int(row[(side + 1) % 3])}
            assert edge <= set(rows[row[3 + side]][:3].tolist())
            assert row[3 + side] != number
    assert struct.unpack("<6f", content[-24:]) == (-15.0, 15.0, -2.5, 2.5, -1.5, 1.5)


def test_an_open_edge_of_a_mesh_has_no_neighbour() -> None:
    content = mesh_kernel(TriMesh(np.eye(3), np.array([[0, 1, 2]], dtype=np.int32)))
    assert struct.unpack("<3I", content[-36:-24]) == (0xFFFFFFFF,) * 3


def test_where_a_b_rep_stands_is_the_product_of_its_locations() -> None:
    moved, turned = SE3.trans(2.0, 3.0, 4.0), SE3.rot_z(np.pi / 2)
    for number, expected in enumerate((SE3.identity(), moved, turned, turned @ moved.inverse())):
        numbers = freecad_native._stands(BREP % number)
        assert SE3.from_quaternion(numbers[3:], numbers[:3]).allclose(expected, mm=1e-12, rad=1e-12)
    with pytest.raises(ExportError):
        freecad_native._stands(b"Open CASCADE Topology V4")
