"""Public data in the layouts of its publishers, made here: read as it is meant, and scored with answers that are known."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.cli import main
from articad.connectors import SE3
from articad.errors import ReadError
from articad.geometry import TriMesh, box, merged, tube, write_stl
from articad.geometry.mesh_files import write_glb, write_obj
from articad_bench import public_scores
from articad_bench.metrics import FAILED, FAILED_OBJECT
from articad_bench.public_data import objects_in, shapes_in
from articad_bench.public_scores import score_objects, score_shapes
from tests.agents.openai_stub import Canned, openai_stub

PROMPT = "Natural_Language_Descriptions_Prompt.txt"


def at(mesh: TriMesh, x: float = 0, y: float = 0, z: float = 0) -> TriMesh:
    return mesh.transformed(SE3.from_translation(np.array([x, y, z], dtype=float)))


@pytest.fixture(autouse=True)
def one_seed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(public_scores, "SEEDS", (0,))


# ---------------------------------------------------------------------- CADPrompt


@pytest.fixture
def cadprompt(tmp_path: Path) -> Path:
    for name, mesh in (("00000007", tube(5, 8, 12)), ("00000123", box(1, 2, 3)), ("00009999", box(4, 4, 1))):
        folder = tmp_path / "CADPrompt" / name
        folder.mkdir(parents=True)
        (folder / "Ground_Truth.stl").write_bytes(write_stl(mesh))
        (folder / PROMPT).write_text(f"Make {name}.\n")
    (tmp_path / "CADPrompt" / "notes").mkdir()
    return tmp_path / "CADPrompt"


def test_shapes_are_read_and_scored_beside_the_floor_and_a_box(cadprompt: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(public_scores, "SEEDS", (0, 1, 2))
    samples = shapes_in(cadprompt)
    models = tmp_path / "models"
    models.mkdir()
    (models / "00000007.stl").write_bytes(write_stl(at(tube(5, 8, 12).scaled(25.4), 900)))
    (models / "00000123.obj").write_bytes(write_obj(box(1, 2, 1.5)))

    report = score_shapes(samples, models)

    assert (samples[0].name, samples[0].prompt) == ("00000007", "Make 00000007.")
    assert samples[0].task().modality == "text"
    rows = {row["name"]: row for row in report["rows"]}
    assert rows["00000007"]["pcd"] < 0.04  # where and how large it was made does not count
    assert rows["00000123"]["iogt"] < 0.95
    assert (rows["00009999"]["pcd"], rows["00009999"]["hd"], rows["00009999"]["iogt"]) == pytest.approx(
        (math.sqrt(3), math.sqrt(3), 0), abs=1e-6
    )
    assert "no model of 00009999" in rows["00009999"]["error"]
    assert report["made"]["mean"] == pytest.approx(2 / 3, abs=1e-4)
    assert report["floor"]["pcd"]["mean"]["mean"] < report["box"]["pcd"]["mean"]["mean"] < FAILED.pcd
    assert report["ours"]["pcd"]["median"]["n"] == 3
    assert 0 < report["floor"]["pcd"]["spread"] < 0.05 * report["floor"]["pcd"]["mean"]["mean"]
    assert report["floor"]["iogt"]["spread"] == 0
    low, high = report["ours"]["pcd"]["median"]["interval"]
    assert low <= report["ours"]["pcd"]["median"]["median"] <= high


def test_a_folder_without_samples_is_told(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="holds no sample of CADPrompt"):
        shapes_in(tmp_path)
    with pytest.raises(ReadError, match="holds no object"):
        objects_in(tmp_path / "nowhere")


# ---------------------------------------------------------------------- articulated objects

# A cabinet: body, a door hinged about z at its right front edge, and a drawer that slides out along -y. Z up, front at -y.
BODY, DOOR, DRAWER = at(box(40, 20, 60), 0, 0, 30), at(box(40, 2, 30), 0, -11, 15), at(box(38, 18, 20), 0, -1, 45)


def urdf(folder: Path, hinge: str = "20 -11 0", kind: str = "prismatic") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name, mesh in (("body", BODY), ("door", at(DOOR, -20, 11)), ("drawer", DRAWER)):
        (folder / f"{name}.obj").write_bytes(write_obj(mesh))

    def link(name: str) -> str:
        return f'<link name="{name}"><visual><geometry><mesh filename="{name}.obj"/></geometry></visual></link>'

    file = folder / "mobility.urdf"
    file.write_text(
        f'<robot name="cabinet">{link("body")}{link("door")}{link("drawer")}'
        f'<joint name="h" type="revolute"><parent link="body"/><child link="door"/><origin xyz="{hinge}"/><axis xyz="0 0 1"/>'
        '<limit lower="0" upper="1.5" effort="1" velocity="1"/></joint>'
        f'<joint name="s" type="{kind}"><parent link="body"/><child link="drawer"/><axis xyz="0 -1 0"/>'
        '<limit lower="0" upper="0.3" effort="1" velocity="1"/></joint></robot>'
    )
    return file


def yup(mesh: TriMesh) -> TriMesh:
    turned = mesh.vertices @ np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]).T
    return TriMesh(turned, mesh.triangles)


def acd(folder: Path) -> None:
    """The same cabinet as ACD has it: one GLB, Y up, parts by triangles, a door of two rows."""
    folder.mkdir(parents=True)
    whole = merged([BODY, DOOR, DRAWER])
    (folder / f"{folder.name}.glb").write_bytes(write_glb(yup(whole)))
    ends = np.cumsum([len(mesh.triangles) for mesh in (BODY, DOOR, DRAWER)]).tolist()

    def part(pid: int, label: str, rows: list[Any]) -> dict[str, Any]:
        return {"name": label, "partInfo": {"partId": pid, "label": label, "meshTri": [{"meshIndex": 0, "triIndex": rows}]}}

    door = [ends[0], [ends[0] + 1, ends[1]]]
    parts = [None, part(1, "base", [[0, ends[0]]]), part(2, "door", door), part(3, "drawer", [[ends[1], ends[2]]])]
    articulations = [
        {"pid": 2, "type": "rotation", "origin": [20, 0, 11], "axis": [0, 1, 0]},
        {"pid": 3, "type": "translation", "origin": [0, 0, 0], "axis": [0, 0, 1]},
    ]
    text = json.dumps({"parts": parts, "annotation": {"articulations": articulations}})
    (folder / f"{folder.name}.art-stk.json").write_text("\ufeff" + text, encoding="utf-8")


def fusion(folder: Path, *, own: bool) -> None:
    """A pin in a plate, in cm; the axis is given in the bodies' own frames, or assembled."""
    folder.mkdir(parents=True)
    pin, plate = at(tube(1, 4, 40), 0, 0, 100), box(60, 60, 10)
    for name, mesh in (("1_pin", pin), ("1_plate", plate)):
        (folder / f"{name}.obj").write_bytes(write_obj(mesh.scaled(0.1)))

    def vector(*numbers: float) -> dict[str, float]:
        return dict(zip("xyz", numbers, strict=True))

    def side(origin: tuple[float, float, float], line: tuple[float, float, float]) -> dict[str, Any]:
        axes = {"x_axis": vector(1, 0, 0), "y_axis": vector(0, 1, 0), "z_axis": vector(0, 0, 1)}
        return {"transform": {"origin": vector(*origin), **axes}, "axis_line": {"origin": vector(*line), "direction": vector(0, 0, 1)}}

    # The pin stands in a hole of the plate, 20 mm right of its middle, and the plate's middle is at (10, 10, 0).
    one = side((3, 1, -10), (0, 0, 10) if own else (3, 1, 0))
    two = side((1, 1, 0), (2, 0, 0) if own else (3, 1, 0))
    joints = [
        {"name": "Rev1", "joint_motion": {"joint_type": "RevoluteJointType"}, "geometry_or_origin_one": one, "geometry_or_origin_two": two}
    ]
    (folder / "joint_set_00001.json").write_text(json.dumps({"body_one": "1_pin", "body_two": "1_plate", "joints": joints}))


@pytest.mark.parametrize("layout", ["partnet", "acd"])
def test_the_same_cabinet_in_either_layout_is_the_same_object(layout: str, tmp_path: Path) -> None:
    if layout == "acd":
        acd(tmp_path / "data" / "cabinet")
    else:
        urdf(tmp_path / "data" / "cabinet")
    (sample,) = objects_in(tmp_path / "data")
    truth = sample.truth()
    unit = 1 if layout == "acd" else 1000  # URDF is in metres
    types = {joint.type: joint for joint in truth.joints}

    assert truth.mesh.bounds / unit == pytest.approx(merged([BODY, DOOR, DRAWER]).bounds, abs=1e-6)
    assert np.abs(types["revolute"].axis) == pytest.approx((0, 0, 1))
    assert np.array(types["revolute"].origin)[:2] / unit == pytest.approx((20, -11))
    assert np.array(types["revolute"].center) / unit == pytest.approx((0, -11, 15))
    assert np.abs(types["slider"].axis) == pytest.approx((0, 1, 0))


@pytest.mark.slow
def test_objects_are_scored_whichever_way_they_face(tmp_path: Path) -> None:
    acd(tmp_path / "data" / "cabinet")
    samples = objects_in(tmp_path / "data")
    urdf(tmp_path / "right" / "cabinet")
    wrong = urdf(tmp_path / "wrong" / "cabinet", hinge="20 -11 0", kind="revolute")
    assert wrong.is_file()

    right, poor, none = (score_objects(samples, tmp_path / folder) for folder in ("right", "wrong", "none"))

    assert right["ours"]["rs_cd"]["mean"]["mean"] < 0.01
    assert right["ours"]["rs_iou"]["mean"]["mean"] > 0.99
    assert right["rows"][0]["movable_f1"] == right["rows"][0]["movable_type_accuracy"] == 1
    assert (poor["rows"][0]["movable_type_accuracy"], poor["rows"][0]["movable_f1"]) == (0.5, 0.5)
    assert (none["rows"][0]["rs_cd"], none["rows"][0]["rs_iou"]) == (FAILED_OBJECT.rs_cd, 0)
    assert right["floor"]["rs_cd"]["mean"]["mean"] < right["box"]["rs_cd"]["mean"]["mean"]
    assert right["box"]["movable_f1"]["mean"]["mean"] == 0


def test_a_cabinet_turned_a_quarter_scores_as_before(tmp_path: Path) -> None:
    acd(tmp_path / "data" / "cabinet")
    file = urdf(tmp_path / "right" / "cabinet")
    turned = file.read_text().replace(
        '<link name="body">',
        '<link name="world"/><joint name="t" type="fixed"><parent link="world"/><child link="body"/><origin rpy="0 0 1.5707963"/></joint><link name="body">',
    )
    file.write_text(turned)

    report = score_objects(objects_in(tmp_path / "data"), tmp_path / "right")

    assert report["rows"][0]["movable_f1"] == 1
    assert report["rows"][0]["rs_cd"] < 0.01


def test_objects_whose_meshes_are_missing_are_told_and_the_others_scored(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("bare", "partial", "whole"):
        urdf(tmp_path / "data" / name)
    for missing in ("bare/body", "bare/door", "bare/drawer", "partial/door"):
        (tmp_path / "data" / f"{missing}.obj").unlink()
    made = urdf(tmp_path / "made" / "whole")
    for name in ("body", "door", "drawer"):
        made.with_name(f"{name}.obj").unlink()

    assert main(["bench", "objects", str(tmp_path / "made"), "--data", str(tmp_path / "data"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)

    assert [row["name"] for row in told["left_out"]] == ["bare", "partial"]
    assert all("meshes that are not there: Mesh '" in row["error"] for row in told["left_out"])
    assert [(row["name"], row["rs_cd"]) for row in told["rows"]] == [("whole", 1)]
    assert "No part of it has a shape" in told["rows"][0]["error"]
    assert told["floor"]["rs_iou"]["mean"]["mean"] == 1
    assert main(["bench", "objects", str(tmp_path / "made"), "--data", str(tmp_path / "data")]) == 0
    assert "partial is left out: ReadError" in capsys.readouterr().out
    with pytest.raises(ReadError, match="No true shape of the data can be read"):
        score_objects(objects_in(tmp_path / "data")[:2], tmp_path / "made")


@pytest.mark.parametrize("own", [False, True])
def test_a_joint_of_the_fusion_gallery_is_read_in_millimetres_whichever_frame_its_axis_is_told_in(own: bool, tmp_path: Path) -> None:
    fusion(tmp_path / "joints", own=own)
    (sample,) = objects_in(tmp_path / "joints")
    truth = sample.truth()
    (joint,) = truth.joints

    assert (sample.name, joint.type) == ("joint_set_00001", "revolute")
    assert joint.origin[:2] == pytest.approx((30, 10))
    assert joint.center == pytest.approx((30, 10, 0), abs=1e-6)
    assert truth.mesh.bounds == pytest.approx(np.array([[-20, -20, -20], [40, 40, 20]]), abs=1e-6)


def test_a_file_that_is_not_of_its_layout_is_told(tmp_path: Path) -> None:
    acd(tmp_path / "data" / "cabinet")
    file = tmp_path / "data" / "cabinet" / "cabinet.art-stk.json"
    file.write_text('{"parts": []}')
    (sample,) = objects_in(tmp_path / "data")
    with pytest.raises(ReadError, match="does not have the layout"):
        sample.truth()
    with pytest.raises(ReadError, match="no picture"):
        sample.task()


def test_the_commands_print_mean_and_median_beside_floor_and_box(
    cadprompt: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    models = tmp_path / "models"
    models.mkdir()
    (models / "00000007.stl").write_bytes(write_stl(tube(5, 8, 12)))
    urdf(tmp_path / "data" / "cabinet")

    assert main(["bench", "shapes", str(models), "--data", str(cadprompt)]) == 0
    said = capsys.readouterr().out
    assert "floor" in said
    assert "box" in said
    assert "compile rate: 33.3 % [0, 100]" in said
    assert main(["bench", "objects", str(tmp_path / "data"), "--data", str(tmp_path / "data"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ours"]["movable_f1"]["mean"]["mean"] == 1


@pytest.mark.slow
def test_public_data_are_asked_for_as_tasks_and_their_effort_stands_beside_the_scores(
    cadprompt: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "out")
    with openai_stub([Canned("no")]) as stub:
        asked = ["--model", "stub", "--api-base", stub.address, "--no-look", "--memory", str(tmp_path / "store"), "--refine", "2"]
        assert main(["bench", "run", "--data", str(cadprompt), "--out", out, "--task", "00000007", *asked]) == 0
    capsys.readouterr()
    request = json.loads(next((tmp_path / "out" / "00000007").glob("run_*/request.json")).read_text())

    assert (request["prompt"], request["options"]["rounds"], request["options"]["repairs"]) == ("Make 00000007.", 3, 2)
    assert main(["bench", "shapes", out, "--data", str(cadprompt), "--task", "00000007"]) == 0
    said = capsys.readouterr().out
    assert "compile rate: 0 % [0, 0]" in said
    assert "3 [3, 3] calls, 30 [30, 30] tokens" in said
