"""Mesh files that claim or place too much are refused by counting, before anything is built from them."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from articad.errors import ReadError
from articad.geometry import mesh_files
from articad.geometry.mesh_files import read_mesh, states_colors
from tests import hostile_files
from tests.geometry.test_dae import DAE
from tests.hostile_files import POINTS, accessor, dae_doubled, dae_of_entities, glb


def never(*_words: object, **_more: object) -> None:
    raise AssertionError("the work was begun")


def shared(primitives: int, nodes: int) -> bytes:
    """Return a glTF whose primitives and nodes all share one triangle."""
    mesh = {"primitives": [{"attributes": {"POSITION": 0}}] * primitives}
    return glb({"meshes": [mesh], "nodes": [{"mesh": 0}] * nodes, "scenes": [{"nodes": list(range(nodes))}]} | accessor(3), POINTS)


SCENES: dict[str, tuple[str, Callable[[], bytes], str]] = {
    "nodes of a DAE that place each other twice": ("a.dae", dae_doubled, "placed shapes; the maximum is 10000"),
    "a node of a DAE that places itself": (
        "a.dae",
        lambda: dae_doubled().replace(b"<node id='n30'/>", b'<node id="n30"><instance_node url="#n0"/></node>'),
        "a node places itself",
    ),
    "entities of a DAE in UTF-16": (
        "a.dae",
        lambda: (chr(0xFEFF) + dae_of_entities().replace("&e8;", "&e1;")).encode("utf-16-le"),
        "without entities",
    ),
    "nodes of a glTF": ("a.glb", lambda: shared(1, 10_001), "10001 nodes; the maximum is 10000"),
    "one triangle of a glTF in many places": ("a.glb", lambda: shared(1001, 1000), "1001000 triangles; the maximum is 1000000"),
    "empty objects of a glTF": ("a.gltf", lambda: b'{"extras": [' + b"{}," * 1_000_001 + b"{}]}", "values; the maximum is 2000000"),
    "tags of a DAE": ("a.dae", lambda: DAE.format(unit="<a/>" * 2_000_000, up="Z_UP").encode(), "tags; the maximum is 2000000"),
    "a DAE in an encoding that hides tags": ("a.dae", lambda: b'<?xml version="1.0" encoding="UTF-7"?>+ADw-COLLADA/+AD4-', "plain XML"),
    "a DAE in EBCDIC": ("a.dae", lambda: '<?xml version="1.0" encoding="IBM037"?><COLLADA/>'.encode("cp037"), "plain XML"),
    "a DAE in UTF-16": ("a.dae", lambda: '<?xml version="1.0" encoding="UTF-16"?><COLLADA/>'.encode("utf-16"), "plain XML"),
    "a DAE whose encoding stands far behind": (
        "a.dae",
        lambda: b'<?xml version="1.0"' + b" " * 2000 + b'encoding="UTF-7"?>+ADw-COLLADA/+AD4-',
        "plain XML",
    ),
    "looks of a DAE without end": ("a.dae", lambda: DAE.format(unit="<bind_material>" * 20_000, up="Z_UP").encode(), "XMLSyntaxError"),
    "units of a DAE without end": ("a.dae", lambda: DAE.format(unit="<unit " * 50_000, up="Z_UP").encode(), "XMLSyntaxError"),
    "values that a glTF claims and takes back": (
        "a.glb",
        lambda: glb({"meshes": [], "accessors": [{"componentType": 5126, "type": "VEC3", "count": n} for n in (10**9, -(10**9))]}),
        "2000000000 values",
    ),
    "a glTF that claims no number": (
        "a.glb",
        lambda: glb({"meshes": [], "accessors": [{"componentType": 5126, "type": "VEC3", "count": float("nan")}]}),
        "nan values",
    ),
    "values that a glTF claims": ("a.glb", lambda: glb({"meshes": []} | accessor(10**9, view=False)), "1000000000 values"),
}


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_is_counted_before_it_is_built(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import trimesh

    file, content, reason = SCENES[name]
    (tmp_path / file).write_bytes(content())
    monkeypatch.setattr(trimesh, "load_scene", never)
    began = time.process_time()
    with pytest.raises(ReadError, match=reason):
        read_mesh(tmp_path / file)
    assert time.process_time() - began < 5


@pytest.mark.parametrize(
    ("file", "content", "reason"),
    [
        ("a.stl", b"articad".ljust(80) + struct.pack("<I", 11) + bytes(550), "11 triangles; the maximum is 10"),
        ("a.stl", b"solid " + b"xx " * 101, "102 words; the maximum is 100"),
        ("a.obj", b"v 0 0 0\n" * 30, "120 words; the maximum is 100"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nend_header\n" + b"0 " * 100, "words; the maximum is 100"),
    ],
)
def test_triangles_and_words_are_counted(file: str, content: bytes, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_files, "MAX_TRIANGLES", 10)
    monkeypatch.setattr(mesh_files, "MAX_WORDS", 100)
    (tmp_path / file).write_bytes(content)
    with pytest.raises(ReadError, match=reason):
        read_mesh(tmp_path / file)


def test_words_are_counted_as_python_splits_them() -> None:
    chance = np.random.default_rng(1)
    for length in (0, 1, 3, (1 << 20) - 1, 1 << 20, (1 << 20) + 1, 3 << 20):
        text = bytes(chance.choice(np.frombuffer(b"ab \n\t", np.uint8), length))
        assert mesh_files._words(text) == len(text.split())


@pytest.mark.parametrize("seed", range(30))
def test_an_obj_is_read_as_its_lines_say(seed: int, tmp_path: Path) -> None:
    """Against a reader of one line at a time: polygons, corners that count back, textures, colours, other lines between."""
    chance = np.random.default_rng(seed)
    vertices, triangles, lines = [], [], []
    only_triangles = seed % 3 == 0
    for number in range(40):
        for _ in range(4):
            point = chance.integers(-9, 9, 3) + np.array([100 * number, 0, 0])
            vertices.append(point)
            lines.append("v\t" * bool(seed % 2) + "v " * (not seed % 2) + " ".join(map(str, point)) + " 0.5 0.5 0.5" * (seed % 5 == 0))
        corners = chance.choice(len(vertices), 3 if only_triangles else chance.integers(3, 5), replace=False)
        triangles += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
        back = not only_triangles and chance.random() < 0.3
        words = [f"{corner - len(vertices) if back else corner + 1}" + ["", "/1", "//2"][seed % 3] for corner in corners]
        lines += ["", "# words v 1 2 3", "g part", "vn 0 0 1", "f " + " ".join(words)]
    path = tmp_path / "a.obj"
    path.write_text(("\r\n" if seed % 4 == 0 else "\n").join(lines))
    found = read_mesh(path)
    expected = [[tuple(map(float, vertices[corner])) for corner in triangle] for triangle in triangles]
    expected = [corners for corners in expected if len(set(corners)) == 3]
    assert [[tuple(map(float, found.vertices[corner])) for corner in triangle] for triangle in found.triangles] == expected


def test_the_line_of_a_bad_vertex_is_named(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("# words\n\nv 0 0 0\nv 1 0 0\n\nv 0 1\nf 1 2 3\n")
    with pytest.raises(ReadError, match="line 6"):
        read_mesh(tmp_path / "a.obj")


def test_a_library_of_materials_is_looked_for_below_the_root(tmp_path: Path) -> None:
    (tmp_path / "root").mkdir()
    (tmp_path / "paint.mtl").write_text("newmtl a")
    (tmp_path / "root" / "paint.mtl").write_text("newmtl a")
    path = tmp_path / "root" / "a.obj"
    for name, states in (("paint.mtl", True), ("../paint.mtl", False), ("gone.mtl", False)):
        path.write_text(f"mtllib {name}\nusemtl a\nv 0 0 0\n")
        assert states_colors(path) is states
        assert states_colors(path, root=path.parent) is states


def test_a_plain_dae_has_no_document_type() -> None:
    assert "<!DOCTYPE" not in DAE
    assert len(hostile_files.ENTRIES) >= 120
