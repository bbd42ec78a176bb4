"""What can be mended without guessing is mended, and nothing else: masses from meshes, shapes to collide with, names, axes, the base."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from lxml import etree

from articad.auditing.examine import AuditOptions, audit_file
from articad.auditing.mend import Mended, mend
from articad.export.urdf import write_urdf
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import read_mesh, write_glb, write_stl
from articad.geometry.shapes import box
from articad.simulation.loading import load
from articad.simulation.trial import try_out
from articad.simulation.verdict import SimulationVerdict
from tests.assemblies import all_joint_kinds
from tests.audit import defects

QUICK = AuditOptions(engines=False)
DENSITY = 640.0


def mesh_only(folder: Path) -> Any:
    """The stand with nothing but drawings, as it is often published: GLB in mm, names with spaces, a wheel of four turns, legs below zero."""
    root = defects.three_turns(folder)
    for element in [*root.iterfind("link/inertial"), *root.iterfind("link/collision")]:
        element.getparent().remove(element)
    for name in ("plate", "arm"):
        (folder / f"{name}.glb").write_bytes(write_glb(read_mesh(folder / f"{name}.stl")))
        (folder / f"{name}.stl").unlink()
        defects.find(root, f"link[@name='{name}']/visual/geometry/mesh").set("filename", f"{name}.glb")
    root.set("name", "A stand with an arm, a block and two flags, " * 9)
    defects.renaming("wave_0", "Wave 0 Rotate")(root, folder)
    defects.renaming("flag_0", "flag (left)")(root, folder)
    defects.limits("Wave 0 Rotate", lower=-4 * math.pi, upper=4 * math.pi)(root, folder)
    lifted = "-0.05 0 0.0055"  # the plate's top is now where its middle was
    for element in root.iterfind("link[@name='plate']/visual"):
        element.insert(0, etree.fromstring('<origin xyz="0 0 -0.015"/>'))
    defects.setting("joint[@name='turn']/origin", xyz=lifted)(root, folder)
    for joint in root.iterfind("joint"):
        if joint.get("name") != "turn":
            x, y, _ = joint.find("origin").get("xyz").split()
            joint.find("origin").set("xyz", f"{x} {y} 0.0055")
    return root


@pytest.fixture(scope="module")
def mended(tmp_path_factory: pytest.TempPathFactory) -> Mended:
    folder = tmp_path_factory.mktemp("mesh_only")
    path = defects.write(mesh_only(folder), folder)
    before = path.read_bytes()
    result = mend(path, folder / "out", density=DENSITY, choices=QUICK)
    assert path.read_bytes() == before
    return result


def test_masses_are_density_times_volume(mended: Mended) -> None:
    root = etree.parse(str(mended.file)).getroot()
    weighed = 0
    for link in root.iterfind("link"):
        mesh = link.find("visual/geometry/mesh")
        if mesh is None:
            continue
        volume = read_mesh(mended.file.parent / mesh.get("filename")).volume * 1e-9
        mass = float(link.find("inertial/mass").get("value"))
        assert mass == pytest.approx(DENSITY * volume, rel=1e-9)
        weighed += 1
    assert weighed == 5
    boxes = {"plate": 0.2 * 0.2 * 0.02, "arm": 0.08 * 0.02 * 0.01, "block": 0.03 * 0.03 * 0.01}
    for name, volume in boxes.items():
        assert mended.masses[name] == pytest.approx(DENSITY * volume, rel=1e-6)  # the mesh files hold single precision


def test_inertias_are_those_of_the_boxes(mended: Mended) -> None:
    root = etree.parse(str(mended.file)).getroot()
    inertia = root.find("link[@name='arm']/inertial/inertia")
    mass = mended.masses["arm"]
    expected = {"ixx": (0.02**2 + 0.01**2), "iyy": (0.08**2 + 0.01**2), "izz": (0.08**2 + 0.02**2)}
    for axis, squares in expected.items():
        assert float(inertia.get(axis)) == pytest.approx(mass * squares / 12, rel=1e-5)


def test_everything_else_that_needs_no_guess_is_mended(mended: Mended) -> None:
    root = etree.parse(str(mended.file)).getroot()
    names = {element.get("name") for element in [*root.iterfind("link"), *root.iterfind("joint")]}
    assert {"Wave_0_Rotate", "flag_left", "base_floor"} <= names
    assert len(root.get("name")) <= 64
    wave = root.find("joint[@name='Wave_0_Rotate']")
    assert wave.get("type") == "continuous"
    assert wave.find("child").get("link") == "flag_left"
    assert wave.find("limit").get("lower") is None
    assert wave.find("limit").get("effort") == "2.5"
    assert float(root.find("joint[@name='base_floor_joint']/origin").get("xyz").split()[2]) == pytest.approx(0.015, rel=1e-6)
    assert all(link.find("collision") is not None for link in root.iterfind("link") if link.find("visual") is not None)
    assert mended.rest is not None
    assert mended.rest.ok, str(mended.rest.findings)
    assert len(mended.done) >= 5


def test_the_mended_model_loads_and_moves_in_mujoco(mended: Mended) -> None:
    verdict = SimulationVerdict("mended", (try_out("mujoco", mended.file),))

    assert verdict.ok, str(verdict.findings)
    (outcome,) = verdict.outcomes
    assert len(outcome.reaches) == 4
    assert min(reach.share for reach in outcome.reaches) >= 0.95


@pytest.mark.parametrize("engine", ["pinocchio", "pybullet"])
def test_the_mended_model_loads_elsewhere(engine: Any, mended: Mended) -> None:
    loading = load(engine, mended.file)
    if loading.loads is None:
        pytest.skip("not installed")
    assert loading.loads, loading.message


def test_nothing_is_invented(tmp_path: Path) -> None:
    """Without a density no mass; an open mesh, reversed limits and a massless carrier are left and listed."""
    root = defects.stand(tmp_path)
    defects.removing("link[@name='arm']/inertial")(root, tmp_path)
    defects.limits("slide", lower=0.02, upper=-0.02)(root, tmp_path)
    path = defects.write(root, tmp_path)

    result = mend(path, tmp_path / "out", choices=QUICK)

    assert result.masses == {}
    assert result.rest is not None
    assert {"E_AUDIT_NO_INERTIA", "E_AUDIT_LIMITS_ORDER"} <= set(result.rest.findings.codes)
    again = etree.parse(str(result.file)).getroot()
    assert again.find("joint[@name='slide']/limit").get("lower") == "0.02"
    assert again.find("link[@name='arm']/inertial") is None


def test_a_sound_file_is_left_as_it_is(tmp_path: Path) -> None:
    path = defects.write(defects.stand(tmp_path), tmp_path)

    result = mend(path, tmp_path / "out", density=DENSITY, choices=QUICK)

    assert result.masses == {}
    assert result.done == ["set MuJoCo to keep folders in mesh names"]
    assert audit_file(result.file, QUICK).ok


def test_an_impossible_inertia_keeps_its_stated_mass(tmp_path: Path) -> None:
    root = defects.stand(tmp_path)
    defects.setting("link[@name='arm']/inertial/inertia", **defects.INERTIA_OF_ONE)(root, tmp_path)
    defects.setting("link[@name='arm']/inertial/mass", value="0.25")(root, tmp_path)

    result = mend(defects.write(root, tmp_path), tmp_path / "out", density=DENSITY, choices=QUICK)

    again = etree.parse(str(result.file)).getroot()
    assert float(again.find("link[@name='arm']/inertial/mass").get("value")) == pytest.approx(0.25, rel=1e-12)
    assert float(again.find("link[@name='arm']/inertial/inertia").get("izz")) == pytest.approx(0.25 * (0.08**2 + 0.02**2) / 12, rel=1e-5)


def test_a_mended_file_keeps_its_name_and_never_replaces_the_original(tmp_path: Path) -> None:
    path = defects.write(defects.stand(tmp_path), tmp_path)
    before = path.read_bytes()

    assert mend(path, tmp_path / "out", choices=QUICK).file.name == path.name
    assert mend(path, path.parent, choices=QUICK).file != path
    assert path.read_bytes() == before


def test_an_export_of_our_own_stays_where_it_stands(tmp_path: Path) -> None:
    """Its parts reach below its base's origin, where the design puts them."""
    bundle = write_urdf(all_joint_kinds())
    bundle.write(tmp_path)

    result = mend(tmp_path / bundle.main, tmp_path / "out", choices=QUICK)

    assert not [line for line in result.done if "base link" in line]


def test_bodies_of_one_mesh_that_overlap_are_weighed_once(tmp_path: Path) -> None:
    """Two blocks of 40 x 20 x 20 mm share 10 x 20 x 20 mm: together 28,000 mm³."""
    block = box(40, 20, 20)
    twice = merged([block, TriMesh(block.vertices + np.array([30.0, 0, 0]), block.triangles)])
    (tmp_path / "m.stl").write_bytes(write_stl(twice))
    path = tmp_path / "a.urdf"
    path.write_text(
        '<robot name="r"><link name="base"/><link name="a"><visual><geometry><mesh filename="m.stl" scale="0.001 0.001 0.001"/></geometry></visual>'
        '</link><joint name="j" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint></robot>'
    )

    result = mend(path, tmp_path / "out", density=1000.0, choices=QUICK)

    assert result.masses["a"] == pytest.approx(0.028, rel=1e-6)


def test_meshes_beside_a_file_are_not_replaced_by_those_of_its_mended_copy(tmp_path: Path) -> None:
    """The drawing is a DAE, which becomes an STL of the same name; the mesh to collide with has that name already."""
    (tmp_path / "meshes").mkdir()
    trimesh.creation.icosphere().export(tmp_path / "meshes" / "a.dae")
    trimesh.creation.box().export(tmp_path / "meshes" / "a.stl")
    shapes = "".join(
        f'<{tag}><geometry><mesh filename="meshes/a.{ending}"/></geometry></{tag}>'
        for tag, ending in (("visual", "dae"), ("collision", "stl"))
    )
    path = tmp_path / "r.urdf"
    path.write_text(f'<robot name="r"><link name="a">{shapes}</link></robot>')
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}

    copy = mend(path, tmp_path, choices=QUICK).file

    assert {file: file.read_bytes() for file in before} == before
    sizes = [trimesh.load(tmp_path / element.get("filename")).volume for element in etree.parse(copy).getroot().iter("mesh")]
    assert sizes == pytest.approx([trimesh.creation.icosphere().volume, 1.0], rel=1e-5)
