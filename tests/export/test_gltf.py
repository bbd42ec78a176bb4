"""GLB is read back by trimesh and by hand: places, colours and animations."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from articad.assembly import Assembly
from articad.errors import UnrepresentableError
from articad.export.gltf import FRAMES, write_glb
from articad.geometry.part import Part, Solid
from articad.geometry.shapes import sphere
from articad.report import viewer_model
from tests.assemblies import all_joint_kinds, block, four_bar, geared_pair
from tests.chains import chain

Y_UP = Rotation.from_euler("x", -90, degrees=True).as_matrix()


def parts_of(content: bytes) -> tuple[dict[str, Any], bytes]:
    magic, version, total = struct.unpack_from("<4sII", content)
    length, kind = struct.unpack_from("<I4s", content, 12)
    assert (magic, version, total, kind) == (b"glTF", 2, len(content), b"JSON")
    return json.loads(content[20 : 20 + length]), content[20 + length + 8 :]


def values(document: dict[str, Any], binary: bytes, accessor: int) -> Any:
    entry = document["accessors"][accessor]
    view = document["bufferViews"][entry["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[entry["type"]]
    dtype = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[entry["componentType"]]
    return np.frombuffer(binary, dtype, entry["count"] * width, view["byteOffset"]).reshape(-1, width)


def test_parts_stand_where_they_rest_in_metres_and_y_up(tmp_path: Path) -> None:
    assembly = all_joint_kinds()
    bundle = write_glb(assembly)
    bundle.write(tmp_path)
    scene = trimesh.load_scene(tmp_path / bundle.main)

    for name, pose in assembly.mechanism.rest_poses().items():
        T, _ = scene.graph[name]
        assert np.allclose(T[:3, 3], Y_UP @ pose.translation / 1000, atol=1e-7)
        assert np.allclose(T[:3, :3], Y_UP @ pose.rotation, atol=1e-6)
    assert np.allclose(scene.geometry["base"].extents, [0.1, 0.1, 0.01])


def test_every_joint_that_drives_has_an_animation_that_begins_at_rest() -> None:
    assembly = all_joint_kinds()
    document, binary = parts_of(write_glb(assembly).files["all_kinds.glb"])
    rest = assembly.mechanism.rest_poses()
    carrier = {child: index for index, node in enumerate(document["nodes"]) for child in node.get("children", ()) if index}

    assert {animation["name"] for animation in document["animations"]} == {driver.joint for driver in assembly.drivers}
    for animation in document["animations"]:
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["target"]["node"] and channel["sampler"]]
            path = channel["target"]["path"]
            output = values(document, binary, sampler["output"])
            node = channel["target"]["node"]
            pose = rest[document["nodes"][node]["name"]]
            if node in carrier:
                pose = rest[document["nodes"][carrier[node]]["name"]].inverse() @ pose
            expected = pose.translation / 1000 if path == "translation" else pose.quaternion
            assert len(output) == FRAMES
            assert np.allclose(output[0], expected, atol=1e-6) or np.allclose(output[0], -expected, atol=1e-6)
            assert np.allclose(output[0], output[-1], atol=1e-6) or np.allclose(output[0], -output[-1], atol=1e-6)
            assert (np.abs(np.diff(output, axis=0)).max(axis=0) < 0.5).all()  # no jumps


def world(document: dict[str, Any], binary: bytes, animation: dict[str, Any], frame: int) -> dict[str, Any]:
    """Return where each node is at a frame of an animation, in metres and before the root's turn."""
    own = {index: (node.get("translation"), node.get("rotation")) for index, node in enumerate(document["nodes"])}
    for channel in animation["channels"]:
        node, path = channel["target"]["node"], channel["target"]["path"]
        value = values(document, binary, animation["samplers"][channel["sampler"]]["output"])[frame]
        own[node] = (value, own[node][1]) if path == "translation" else (own[node][0], value)
    places: dict[str, Any] = {}

    def walk(index: int, above: Any) -> None:
        T = np.eye(4)
        T[:3, 3], T[:3, :3] = own[index][0], Rotation.from_quat(own[index][1]).as_matrix()
        places[document["nodes"][index]["name"]] = above @ T
        for child in document["nodes"][index].get("children", ()):
            walk(child, above @ T)

    for child in document["nodes"][0]["children"]:
        walk(child, np.eye(4))
    return places


@pytest.mark.parametrize("make", [all_joint_kinds, geared_pair, lambda: chain(5)])
def test_every_part_is_where_the_mechanism_has_it_at_the_far_end_of_each_joint(make: Callable[[], Assembly]) -> None:
    assembly = make()
    document, binary = parts_of(next(iter(write_glb(assembly).files.values())))
    checked = 0
    for animation in document.get("animations", ()):
        columns = [index for index, driver in enumerate(assembly.drivers) if driver.joint == animation["name"]]
        driver = assembly.drivers[columns[0]]
        if len(columns) > 1 or driver.unit == "1":
            continue
        q = assembly.mechanism.rest.copy()
        q[columns] = min(driver.upper, driver.rest + (np.pi if driver.unit == "rad" else 100.0))
        places = world(document, binary, animation, 12)  # a quarter of the way: the upper end
        for name, T in zip(assembly.parts, assembly.poses(q).matrix, strict=True):
            assert np.allclose(places[name][:3, 3], T[:3, 3] / 1000, atol=1e-6)
            assert np.allclose(places[name][:3, :3], T[:3, :3], atol=1e-5)
        checked += 1
    assert checked


def test_a_joint_that_moves_by_itself_animates_one_node_however_much_it_carries() -> None:
    document, _ = parts_of(write_glb(chain(30)).files["chain.glb"])
    assert [len({channel["target"]["node"] for channel in one["channels"]}) for one in document["animations"]] == [1] * 29


def test_a_hinge_swings_through_its_whole_range() -> None:
    assembly = all_joint_kinds()
    document, binary = parts_of(write_glb(assembly).files["all_kinds.glb"])
    animation = next(one for one in document["animations"] if one["name"] == "hinge")
    node = next(index for index, node in enumerate(document["nodes"]) if node["name"] == "hinge")
    sampler = next(c["sampler"] for c in animation["channels"] if c["target"] == {"node": node, "path": "rotation"})
    turned = Rotation.from_quat(values(document, binary, animation["samplers"][sampler]["output"]))
    angles = (turned[0].inv() * turned).magnitude()

    assert angles.max() == pytest.approx(1.5, abs=1e-3)  # from 0.5 to 2 one way, to −1 the other


def test_equal_meshes_share_their_data_and_colours_are_linear() -> None:
    document, _ = parts_of(write_glb(geared_pair()).files["geared.glb"])
    meshes = {mesh["name"]: mesh["primitives"][0]["attributes"] for mesh in document["meshes"]}

    assert meshes["wheel_a"] == meshes["wheel_b"]
    assert meshes["wheel_a"] != meshes["rack"]
    assert document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][0] == pytest.approx(0.2541, abs=1e-4)


def test_a_loop_that_cannot_go_its_range_has_no_animation() -> None:
    document, _ = parts_of(write_glb(four_bar()).files["loop.glb"])

    assert "animations" not in document


def test_motion_and_mass_are_lost_and_strict_refuses_motion() -> None:
    bundle = write_glb(geared_pair())

    assert {loss.where for loss in bundle.losses if loss.refused} == {"joints.a", "joints.b", "joints.s"}
    with pytest.raises(UnrepresentableError):
        write_glb(geared_pair(), strict=True)
    write_glb(Assembly.from_parts("one", parts=[block("one")], joints=[], ground="one"), strict=True)


def test_a_part_without_shape_is_a_bare_node() -> None:
    document, binary = parts_of(
        write_glb(Assembly.from_parts("e", parts=[Part.without_geometry("a")], joints=[], ground="a")).files["e.glb"]
    )

    assert document["nodes"][1] == {"name": "a", "translation": [0, 0, 0], "rotation": [0, 0, 0, 1]}
    assert not binary


def test_built_parts_are_drawn_with_few_triangles_in_glb_and_in_the_report() -> None:
    """A ball of 100,000 triangles has at most 5,000, whose corners and middles are within 1 % of its surface."""
    fine = Solid.from_mesh(sphere(20, 320), deflection=0.001)
    assembly = Assembly.from_parts("alone", parts=[Part.from_solid("ball", fine, density=1000)], joints=[], ground="ball")
    document, binary = parts_of(write_glb(assembly).files["alone.glb"])
    (primitive,) = document["meshes"][0]["primitives"]
    points = 1000 * values(document, binary, primitive["attributes"]["POSITION"])
    triangles = values(document, binary, primitive["indices"]).reshape(-1, 3).astype(int)
    (shown,) = viewer_model(assembly)["meshes"]

    assert len(fine.mesh.triangles) > 90_000
    assert len(triangles) <= 5000
    assert document["accessors"][primitive["indices"]]["componentType"] == 5123
    for found in (points, points[triangles].mean(axis=1)):
        assert np.allclose(np.linalg.norm(found, axis=1), 20, atol=0.2)
    assert sum(np.frombuffer(base64.b64decode(shown["faces"]), "<u4")) <= 5000
