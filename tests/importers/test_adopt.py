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
from articad.export.convex import hull_mesh, manifold
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.formats import read
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import write_stl
from articad.geometry.shapes import box, capsule, cylinder, sphere, tube
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.adopt import adopt, recognised
from articad.runs.facets import LEVELS, MOST_FACETS, one_solid
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
    assert (
        cli.main(["adopt", str(FILES / f"{name}.xml"), "--out", str(tmp_path / "out"), "--script", __file__, "--no-build", "--json"]) == 0
    )
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


def star(open_: bool) -> TriMesh:
    """A flat star of five legs, as chairs stand on; open where a triangle is missing."""
    legs = [manifold(box(200, 10, 8).transformed(SE3.rot_z(at * math.tau / 5) @ SE3.trans(100, 0, 0))) for at in range(5)]
    row = sum(legs[1:], start=legs[0]).to_mesh64()
    triangles = np.asarray(row.tri_verts, dtype=np.int32)
    return TriMesh(np.asarray(row.vert_properties[:, :3]), triangles[:-1] if open_ else triangles)


def test_few_facets_are_few_closed_and_near() -> None:
    fine, hollow = sphere(10.0, 128), tube(5, 10, 20, 256)
    for mesh in (fine, hollow):
        found = one_solid([mesh])
        assert found.mesh is not None
        assert len(found.mesh.triangles) <= MOST_FACETS
        assert found.mesh.is_closed
        assert found.exact == pytest.approx(mesh.volume)
        assert found.mesh.volume == pytest.approx(found.exact, rel=0.1)


def test_an_open_mesh_keeps_its_volume_where_its_hull_would_not() -> None:
    closed, opened = (one_solid([star(open_)]) for open_ in (False, True))
    assert closed.mesh is not None
    assert opened.mesh is not None
    assert (closed.level, opened.level, opened.exact) == ("mesh", "mesh", 0.0)
    assert opened.mesh.volume == pytest.approx(closed.mesh.volume, rel=0.1)
    for level in LEVELS:
        found = one_solid([star(open_=True)], level)
        assert found.mesh is not None
        assert (found.level, len(found.mesh.components()), found.mesh.is_closed) == (level, 1, True)
    assert hull_mesh(star(open_=False).vertices).volume > 3 * closed.mesh.volume


def test_loose_pieces_are_tied_by_bars_and_crumbs_are_left_out() -> None:
    pieces = [box(10, 10, 10), box(10, 10, 10).transformed(SE3.trans(15, 3, 1)), box(0.1, 0.1, 0.1).transformed(SE3.trans(0, 30, 0))]
    found = one_solid(pieces)
    assert found.mesh is not None
    assert (found.bars, found.crumbs, len(found.mesh.components())) == (1, 1, 1)
    assert found.mesh.volume == pytest.approx(2000, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0])
def test_whatever_a_link_looks_like_its_folder_builds(seed: int, tmp_path: Path) -> None:
    """Open meshes, loose ones, ones that cut themselves, primitives that touch along an edge, flat ones: all in one file."""
    rng = np.random.default_rng(seed)
    rough = sphere(20.0, 12)
    rough = TriMesh(rough.vertices * rng.uniform(0.6, 1.4, (len(rough.vertices), 1)), rough.triangles)  # cuts itself here and there
    meshes = {
        "rough": rough,
        "open": TriMesh(rough.vertices, rough.triangles[: -int(rng.integers(1, 40))]),
        "loose": merged([box(5, 5, 5).transformed(SE3.trans(*(rng.uniform(-40, 40, 3)))) for _ in range(6)]),
        "flat": TriMesh(np.array([[0.0, 0, 0], [30, 0, 0], [0, 20, 0]]), np.array([[0, 1, 2]])),
        "star": star(open_=True),
    }
    links = ['<link name="base"><visual><geometry><box size=".1 .1 .1"/></geometry></visual></link>']
    for name, mesh in meshes.items():
        (tmp_path / f"{name}.stl").write_bytes(write_stl(mesh))
        links.append(
            f'<link name="{name}"><visual><geometry><mesh filename="{name}.stl" scale=".001 .001 .001"/></geometry></visual></link>'
        )
    cubes = "".join(f'<visual><origin xyz="{x} {x} 0"/><geometry><box size=".1 .1 .1"/></geometry></visual>' for x in (0, 0.1))
    links.append(f'<link name="edge">{cubes}</link>')
    joint = '<joint name="to_{0}" type="continuous"><parent link="base"/><child link="{0}"/><axis xyz="0 0 1"/></joint>'
    joints = [joint.format(name) for name in [*meshes, "edge"]]
    (tmp_path / "a.urdf").write_text(f'<robot name="a">{"".join(links)}{"".join(joints)}</robot>')
    cache = stories.cache(tmp_path)

    assembly, bundle = adopt(tmp_path / "a.urdf", kernel=stories.kernel(), cache=cache)
    bundle.write(tmp_path / "out")
    built = Assembly.from_plan(AssemblyPlan.load(tmp_path / "out"), tmp_path / "out/parts", kernel=stories.kernel(), cache=cache)

    assert bundle.findings.ok
    assert set(built.parts) == set(assembly.parts)
    for name, part in built.parts.items():
        own = [mesh for mesh in (shape.placed for shape in assembly.parts[name].visuals) if mesh.is_closed and mesh.volume > 0]
        if own and name in {"base", "edge", "star"}:
            assert part.solid is not None
            assert part.solid.volume == pytest.approx(sum(mesh.volume for mesh in own), rel=0.05)
