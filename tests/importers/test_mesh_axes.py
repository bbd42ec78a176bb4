"""A box of 20 x 30 x 40 mm in a DAE or GLB has these sides along x, y and z of the link; Pinocchio and trimesh take the same axes."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.formats import read, write
from articad.geometry.mesh_files import read_mesh

pytestmark = pytest.mark.engines

SIDES = np.array([20.0, 30.0, 40.0])
CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 0.5
FACES = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{meter}"/><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="24">{numbers}</float_array><technique_common>
<accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{faces}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
FILES = {
    "urdf": '<robot name="r"><link name="l"><visual><geometry><mesh filename="{0}"/></geometry></visual><collision><geometry><mesh filename="{0}"/>'
    "</geometry></collision></link></robot>",
    "sdf": '<sdf version="1.9"><model name="m"><static>1</static><link name="l"><visual name="v"><geometry><mesh><uri>{0}</uri></mesh></geometry></visual></link>'
    "</model></sdf>",
}


def dae(folder: Path, meter: float, up: str) -> Path:
    """Write the box in a unit of so many metres."""
    path = folder / "box.dae"
    numbers = " ".join(f"{x:.9g}" for x in (CORNERS * SIDES / 1000 / meter).ravel())
    path.write_text(DAE.format(meter=meter, up=up, numbers=numbers, faces=" ".join(str(i) for face in FACES for i in face)))
    return path


def glb(folder: Path, scale: list[float]) -> Path:
    """Write the box in metres, by this test itself, below a node that scales it."""
    points = (CORNERS * SIDES / 1000 / scale).astype("<f4")
    faces = np.array(FACES, dtype="<u4")
    document: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "scale": scale}, {"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 8,
                "type": "VEC3",
                "min": points.min(0).tolist(),
                "max": points.max(0).tolist(),
            },
            {"bufferView": 1, "componentType": 5125, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 144}],
        "buffers": [{"byteLength": 240}],
    }
    import json

    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", 240, b"BIN\0") + points.tobytes() + faces.tobytes()
    path = folder / "box.glb"
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path


def sides(mesh: Any) -> Any:
    return mesh.bounds[1] - mesh.bounds[0]


def in_coal(path: Path) -> Any:
    """Return the sides of a mesh where Pinocchio's collision library reads it [m]."""
    import coal

    vertices = np.array(coal.MeshLoader().load(str(path), np.ones(3)).vertices())
    return vertices.max(axis=0) - vertices.min(axis=0)


@pytest.mark.parametrize("up", ["X_UP", "Y_UP", "Z_UP"])
@pytest.mark.parametrize("meter", [0.01, 0.001, 1.0, 0.0254])
def test_the_unit_of_a_dae_counts_and_its_up_axis_does_not(meter: float, up: str, tmp_path: Path) -> None:
    path = dae(tmp_path, meter, up)

    assert sides(read_mesh(path, scale=1000.0)) == pytest.approx(SIDES, rel=1e-6)
    assert in_coal(path) * meter * 1000 == pytest.approx(SIDES, rel=1e-6)  # the same axes; the unit of the format it leaves out


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("mesh", ["box.dae", "box.glb"])
def test_files_that_name_them_have_the_box_along_the_links_axes_and_so_have_their_copies(name: str, mesh: str, tmp_path: Path) -> None:
    if mesh == "box.dae":
        dae(tmp_path, 0.01, "Y_UP")
    else:
        glb(tmp_path, [0.5, 0.5, 0.5])
    source = tmp_path / f"a.{name}"
    source.write_text(FILES[name].format(mesh))

    assembly = read(source)
    (shape,) = assembly.parts["l"].visuals
    assert sides(shape.placed) == pytest.approx(SIDES, rel=1e-6)
    for suffix in ("urdf", "sdf"):
        write(assembly, tmp_path / "out" / f"b.{suffix}")
        again = read(tmp_path / "out" / f"b.{suffix}")
        assert sides(again.parts["l"].visuals[0].placed) == pytest.approx(SIDES, rel=1e-6)


def test_nodes_of_a_glb_are_placed_and_y_stays_y(tmp_path: Path) -> None:
    path = glb(tmp_path, [2.0, 1.0, 0.5])

    assert sides(read_mesh(path, scale=1000.0)) == pytest.approx(SIDES, rel=1e-6)
    import trimesh  # the loader of yourdfpy, and so of many that read URDF

    assert trimesh.load_scene(path).extents * 1000 == pytest.approx(SIDES, rel=1e-6)
    assert in_coal(glb(tmp_path, [1.0, 1.0, 1.0])) * 1000 == pytest.approx(SIDES, rel=1e-6)
