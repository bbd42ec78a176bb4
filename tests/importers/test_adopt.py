"""Files that somebody else wrote, in the usual style, become plan folders that build: a loop, a coupling, a tree of ten bodies."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad import cli
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import ReadError
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.formats import read
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box, capsule, cylinder, sphere, tube
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.adopt import MOST_FACETS, adopt, few_facets, recognised
from tests.agents import stories
from tests.assemblies import all_joint_kinds, geared_pair
from tests.foreign import TOLERANCE, configurations, difference, mujoco_poses

FILES = Path(__file__).parents[1] / "fixtures/adopt"
PLANTED = {"four_bar": "I_AUDIT_SHARED", "gripper": "E_MOTION_COLLISION", "tree": "W_AUDIT_ENDLESS"}


def adopted(path: Path, folder: Path) -> tuple[Assembly, AssemblyPlan, set[str]]:
    assembly, bundle = adopt(path)
    bundle.write(folder)
    return assembly, AssemblyPlan.load(folder), set(bundle.findings.codes)


def assert_plan_poses(assembly: Assembly, plan: AssemblyPlan, q: Any) -> None:
    told = resolve(plan).mechanism.poses(q).matrix
    assert np.abs(told - assembly.poses(q).matrix).max() < 1e3 * TOLERANCE


@pytest.mark.engines
@pytest.mark.parametrize("name", PLANTED)
def test_what_is_adopted_stands_and_moves_as_in_mujoco(name: str, tmp_path: Path) -> None:
    path = FILES / f"{name}.xml"
    assembly, plan, codes = adopted(path, tmp_path)

    assert check_plan(plan).ok
    assert {"I_ADOPT_MERGED", "I_ADOPT_FITS"} <= codes
    assert "world" not in assembly.parts
    for q in configurations(assembly, 10):
        assert difference(assembly, q, mujoco_poses(assembly, path, q)) < TOLERANCE
        assert_plan_poses(assembly, plan, q)


@pytest.mark.engines
@pytest.mark.parametrize("name", PLANTED)
def test_the_planted_defect_is_named(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["adopt", str(FILES / f"{name}.xml"), "--out", str(tmp_path / "out"), "--script", __file__, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)

    assert report["schema"] == "articad.adopt/1"
    assert PLANTED[name] in {finding["code"] for finding in report["audit"]["findings"]}
    assert json.loads((tmp_path / "out/audit.json").read_text()) == report["audit"]
    assert (tmp_path / "out/source/test_adopt.py").is_file()


def test_loops_and_couplings_are_among_them(tmp_path: Path) -> None:
    loop, coupled, tree = (adopt(FILES / f"{name}.xml")[0] for name in PLANTED)

    assert [joint.name for joint in loop.mechanism.loop_joints] == ["pin_c"]
    assert len(coupled.mechanism.couplings) == 1
    assert len(tree.parts) == 10


@pytest.mark.slow
def test_an_adopted_folder_builds_at_once_with_the_volumes_of_its_shapes(tmp_path: Path) -> None:
    _, plan, _ = adopted(FILES / "four_bar.xml", tmp_path)
    built = Assembly.from_plan(plan, tmp_path / "parts", kernel=stories.kernel(), cache=stories.cache(tmp_path))
    wider = Assembly.from_plan(_with_dimension(plan, "base", "box_x", 300.0), tmp_path / "parts", kernel=stories.kernel())
    r, length = 8.0, 60.0

    assert built.parts["base"].solid.volume == pytest.approx(240 * 30 * 40)  # type: ignore[union-attr]
    assert wider.parts["base"].solid.volume == pytest.approx(300 * 30 * 40)  # type: ignore[union-attr]
    assert built.parts["crank"].solid.volume == pytest.approx(math.pi * r**2 * length + 4 / 3 * math.pi * r**3, rel=1e-3)  # type: ignore[union-attr]


def _with_dimension(plan: AssemblyPlan, part: str, dimension: str, value: float) -> AssemblyPlan:
    document = json.loads(plan.dumps())
    (form,) = [form for form in document["parts"] if form["name"] == part]
    form["dimensions"][dimension], form["envelope_mm"] = value, None
    return AssemblyPlan.from_json(document)


@pytest.mark.slow
def test_meshes_and_solids_of_step_become_scripts_that_build(tmp_path: Path) -> None:
    import build123d as bd

    shapes = [bd.Box(40, 30, 20) - bd.Cylinder(5, 20), bd.Pos(0, 0, 30) * bd.Cylinder(5, 40)]
    for shape, name in zip(shapes, ("block", "pin"), strict=True):
        shape.label = name
    bd.export_step(bd.Compound(children=shapes, label="thing"), str(tmp_path / "thing.step"))
    assembly, plan, codes = adopted(tmp_path / "thing.step", tmp_path / "out")
    built = Assembly.from_plan(plan, tmp_path / "out/parts", kernel=stories.kernel(), cache=stories.cache(tmp_path))

    assert list(assembly.parts) == ["block", "pin"]
    assert [joint.type for joint in assembly.joints] == ["fixed"]
    assert "I_ADOPT_FITS" not in codes
    for name, part in built.parts.items():
        assert part.solid is not None
        assert part.solid.volume == pytest.approx(assembly.parts[name].solid.volume, rel=0.02)  # type: ignore[union-attr]
        assert part.solid.com == pytest.approx(assembly.parts[name].solid.com, abs=0.1)  # type: ignore[union-attr]


@pytest.mark.parametrize("make", [all_joint_kinds, geared_pair])
@pytest.mark.parametrize("write", [write_urdf, write_mjcf])
def test_our_own_files_are_adopted_too(make: Any, write: Any, tmp_path: Path) -> None:
    bundle = write(make())
    bundle.write(tmp_path)
    assembly, plan, _ = adopted(tmp_path / bundle.main, tmp_path / "out")

    assert [joint.name for joint in plan.joints] == [joint.name for joint in make().joints]
    assert_plan_poses(assembly, plan, assembly.mechanism.rest)
    assert len(list((tmp_path / "out/meshes").iterdir())) == len(assembly.parts)


def test_frames_and_missing_shapes_are_told(tmp_path: Path) -> None:
    (tmp_path / "a.urdf").write_text(
        '<robot name="a"><link name="footprint"/><link name="body"><visual><geometry><box size="1 2 3"/></geometry></visual></link>'
        '<link name="hand"/><link name="tip"/><joint name="f" type="fixed"><origin xyz="0 0 1"/><parent link="footprint"/>'
        '<child link="body"/></joint><joint name="j" type="continuous"><parent link="body"/><child link="hand"/></joint>'
        '<joint name="g" type="fixed"><origin xyz="0 1 0"/><parent link="body"/><child link="tip"/></joint></robot>'
    )
    assembly, plan, codes = adopted(tmp_path / "a.urdf", tmp_path / "out")

    assert list(assembly.parts) == ["body", "hand"]
    assert assembly.at()["body"].translation.tolist() == [0, 0, 1000]
    assert json.loads(plan.dumps())["parts"][0]["dimensions"] == {"box_x": 1000, "box_y": 2000, "box_z": 3000}
    assert codes >= {"I_ADOPT_MERGED", "W_ADOPT_PLACEHOLDER"}


def test_a_files_name_is_no_code(tmp_path: Path) -> None:
    path = tmp_path / 'a"""\nimport os\n"""\\.urdf'
    path.write_text('<robot name="a"><link name="b"><visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>')
    adopted(path, tmp_path / "out")
    script = (tmp_path / "out/parts/b.py").read_text()

    assert script.startswith('"""b, adopted from a____import os_____.urdf."""\n\nfrom build123d import')
    compile(script, "b.py", "exec")


def test_a_folder_with_something_in_it_and_a_plan_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine").write_text("")

    assert cli.main(["adopt", str(FILES / "tree.xml"), "--out", str(tmp_path)]) == 3
    assert "is not empty" in capsys.readouterr().err
    assert (tmp_path / "mine").is_file()
    with pytest.raises(ReadError, match="a plan already"):
        adopt(FILES.parent / "five_joints/plan.json")


def test_primitives_are_recognised_and_nothing_else_is() -> None:
    ball = sphere(3.0)

    assert recognised(box(1, 2, 3)) == ("box", {"x": 1, "y": 2, "z": 3})
    assert recognised(cylinder(3.3, 7)) == ("cylinder", {"radius": 3.3, "height": 7})
    assert recognised(ball) == ("sphere", {"radius": 3.0})
    assert recognised(capsule(3.0, 10.0)) == ("capsule", {"radius": 3.0, "length": 10.0})
    assert recognised(tube(1, 2, 3)) == ("", {})
    assert recognised(read(FILES / "tree.xml").parts["b9"].collisions[0].mesh) == ("", {})


def test_few_facets_are_few_closed_and_near() -> None:
    fine, hollow = sphere(10.0, 128), tube(5, 10, 20, 256)
    for mesh in (fine, hollow):
        (body,), exact = few_facets([mesh])
        assert len(body.triangles) <= MOST_FACETS
        assert body.is_closed
        assert exact == pytest.approx(mesh.volume)
        assert body.volume == pytest.approx(exact, rel=0.1)
    (hull,), exact = few_facets([TriMesh(fine.vertices, fine.triangles[:-50])])
    assert (exact, hull.is_closed) == (0.0, True)
    assert len(few_facets([box(1, 1, 1), box(1, 1, 1).transformed(SE3.trans(5, 0, 0))])[0]) == 2
