"""The print pack is read back by lib3mf and trimesh."""

from __future__ import annotations

import io
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from lxml import etree

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import UnrepresentableError
from articad.export.markup import document
from articad.export.threemf import lying, write_3mf
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box, cylinder, sphere
from articad.kinematics import declare
from articad.plan.resolve import Fit
from tests.assemblies import all_joint_kinds, block, frame, geared_pair, of_density


def test_no_part_overwrites_another_where_case_does_not_count_and_none_is_a_device() -> None:
    root = frame()
    base, *others = parts = [block(name, (10, 10, 10), root=root) for name in ("Arm", "arm", "ARM", "con", "a b", "a_b")]
    joints = [declare.fixed(part.name, base["root"], part["root"]) for part in others]
    files = write_3mf(Assembly.from_parts("it", parts=parts, joints=joints, ground="Arm")).files
    assert len({file.casefold() for file in files}) == len(parts)
    assert "con.3mf" not in files


def test_lib3mf_reads_every_part_without_a_warning(tmp_path: Path) -> None:
    import lib3mf  # type: ignore[import-untyped]

    assembly = all_joint_kinds()
    bundle = write_3mf(assembly)
    bundle.write(tmp_path)
    wrapper = lib3mf.get_wrapper()
    assert len(bundle.files) == len(assembly.parts)
    for path in bundle.files:
        model = wrapper.CreateModel()
        reader = model.QueryReader("3mf")
        reader.SetStrictModeActive(True)  # noqa: FBT003 - not our function
        reader.ReadFromFile(str(tmp_path / path))
        objects = model.GetMeshObjects()

        assert reader.GetWarningCount() == 0
        assert objects.MoveNext()
        mesh = objects.GetCurrentMeshObject()
        assert mesh.GetName() == path.removesuffix(".3mf")
        assert mesh.IsManifoldAndOriented()


@pytest.mark.parametrize(
    ("mesh", "height"),
    [
        (box(10, 20, 30), 10),
        (box(30, 10, 20).transformed(SE3.rot_x(0.4) @ SE3.rot_z(1.1)), 10),
        (cylinder(20, 5), 5),
        (cylinder(2, 50), None),
        (sphere(10), None),
    ],
)
def test_a_part_lies_on_its_largest_flat_face(mesh: TriMesh, height: float | None) -> None:
    placed = lying(mesh)
    low, high = placed.bounds

    assert low[2] == pytest.approx(0, abs=1e-9)
    assert (low + high)[:2] == pytest.approx([0, 0], abs=1e-9)
    assert placed.volume == pytest.approx(mesh.volume)
    if height is not None:
        assert high[2] == pytest.approx(height)


def test_files_are_in_millimetres(tmp_path: Path) -> None:
    bundle = write_3mf(geared_pair())
    bundle.write(tmp_path)
    scene = trimesh.load_scene(tmp_path / "base.3mf")

    assert np.sort(scene.extents) == pytest.approx([5, 40, 100])


def test_the_same_part_is_the_same_bytes() -> None:
    assert write_3mf(geared_pair()).files == write_3mf(geared_pair()).files


def test_a_model_is_written_as_lxml_would_write_it() -> None:
    name = "<vertices/> & <triangles/>"
    ball = Part.from_mesh(name, sphere(10).transformed(SE3.trans(1 / 3, 0.1, 0)))
    files = write_3mf(Assembly.from_parts("it", parts=[ball], joints=[], ground=name)).files
    with zipfile.ZipFile(io.BytesIO(*files.values())) as package:
        content = package.read("3D/3dmodel.model")
    root = etree.fromstring(content, etree.XMLParser(remove_blank_text=True))
    assert document(root) == content
    assert [element.get("name") for element in root.iter("{*}object")] == [name]
    assert len(list(root.iter("{*}triangle"))) == len(sphere(10).triangles)


def test_a_gap_that_the_process_cannot_print_is_a_finding() -> None:
    assembly = replace(of_density(geared_pair(), 1240), fits={"a": Fit(0.15, 0.4), "b": Fit(0.5, 1.0), "s": Fit(None, 1.0)})

    assert [finding.where for finding in write_3mf(assembly).findings] == ["joints.a"]
    assert not write_3mf(assembly, process="sla").findings
    assert write_3mf(assembly).findings.codes == ("W_PRINT_CLEARANCE",)


@pytest.mark.parametrize("metal", ["base", "wheel_a"])
def test_the_gap_of_a_part_that_is_not_printed_is_no_finding(metal: str) -> None:
    printed = replace(of_density(geared_pair(), 1240), fits={"a": Fit(0.15, 0.4)})
    mixed = replace(printed, parts={**printed.parts, metal: geared_pair().parts[metal]})
    assert (len(write_3mf(printed).findings), len(write_3mf(mixed).findings)) == (1, 0)


def test_an_open_mesh_is_left_out_and_told() -> None:
    solid = box(10, 10, 10)
    sheet = Part.from_mesh("sheet", TriMesh(solid.vertices, solid.triangles[:-1]))
    bundle = write_3mf(Assembly.from_parts("a", parts=[sheet], joints=[], ground="sheet"))

    assert not bundle.files
    assert bundle.findings.codes == ("E_MESH_OPEN",)


def test_strict_refuses_joints() -> None:
    with pytest.raises(UnrepresentableError):
        write_3mf(geared_pair(), strict=True)
    write_3mf(Assembly.from_parts("one", parts=[block("one")], joints=[], ground="one"), strict=True)
