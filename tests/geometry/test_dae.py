"""COLLADA meshes: the unit that they state counts, their place in the scene too; what they say of looks does not matter."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from articad.errors import ReadError
from articad.geometry.mesh_files import read_mesh
from articad.importers.urdf import read_urdf

DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>{unit}<up_axis>{up}</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">
0 0 0 1 0 0 0 2 0 0 0 3</float_array><technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="4" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<translate>0 0 1</translate><instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="m" target="#gone"/>
</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


@pytest.mark.parametrize(
    ("unit", "metres"), [("", 1.0), ('<unit name="inch" meter="0.0254"/>', 0.0254), ("<unit meter='1.00' name='m'/>", 1.0)]
)
@pytest.mark.parametrize("up", ["Y_UP", "Z_UP"])
def test_a_dae_is_read_in_metres(unit: str, metres: float, up: str, tmp_path: Path) -> None:
    path = tmp_path / "a.dae"
    path.write_text(DAE.format(unit=unit, up=up))

    assert np.allclose(read_mesh(path).bounds, np.array([[0, 0, 1], [1, 2, 4]]) * metres)
    assert read_mesh(path).volume == pytest.approx(metres**3)


def test_a_dae_of_a_urdf_has_its_place_and_pinocchio_reads_the_same(tmp_path: Path) -> None:
    import coal

    (tmp_path / "a.dae").write_text(DAE.format(unit="", up="Z_UP"))
    (tmp_path / "a.urdf").write_text(
        '<robot name="r"><link name="l"><visual><geometry><mesh filename="a.dae" scale="2 2 2"/></geometry></visual></link></robot>'
    )
    (shape,) = read_urdf(tmp_path / "a.urdf").parts["l"].visuals
    theirs = np.array(coal.MeshLoader().load(str(tmp_path / "a.dae"), np.full(3, 2.0)).vertices())

    assert np.allclose(shape.mesh.bounds / 1000, [theirs.min(axis=0), theirs.max(axis=0)])


@pytest.mark.parametrize("content", [b"PK\x03\x04 packed", b'<!DOCTYPE x [<!ENTITY a "b">]><COLLADA/>', b"<COLLADA/>"])
def test_a_dae_that_is_packed_or_declares_entities_is_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.dae").write_bytes(content)

    with pytest.raises(ReadError):
        read_mesh(tmp_path / "a.dae")


def test_a_missing_unit_of_length_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.dae").write_text(DAE.format(unit='<unit meter="0"/>', up="Z_UP"))

    with pytest.raises(ReadError, match="not a valid length"):
        read_mesh(tmp_path / "a.dae")


def test_every_link_that_wants_a_mesh_is_told_that_it_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(b"nothing")
    link = '<link name="{}"><visual><geometry><mesh filename="a.stl"/></geometry></visual></link>'
    (tmp_path / "a.urdf").write_text(
        f'<robot name="r">{link.format("a")}{link.format("b")}<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>'
    )

    assert [finding.where for finding in read_urdf(tmp_path / "a.urdf").findings.of("W_IMPORT_MESH")] == ["parts.a", "parts.b"]
