"""Mesh files: exact round trips, readers that are not ours, and files that are broken or hostile."""

from __future__ import annotations

import json
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from articad.connectors import SE3
from articad.errors import ReadError
from articad.geometry import TriMesh, box, read_mesh, sphere, write_glb, write_obj, write_ply, write_stl

MESH = sphere(3.3, 24).transformed(SE3.from_axis_angle([1.0, 2, 3], 0.7) @ SE3.from_translation([10.0, 20, -7.77]))
WRITERS = {"stl": write_stl, "obj": write_obj, "glb": write_glb, "ply": write_ply}
TEXT_STL = """solid two words
facet normal 0 0 1
 outer loop
  vertex 0 0 0
  vertex 1 0 0
  vertex 0 1e0 0
 endloop
endfacet
endsolid two words
"""


@pytest.mark.parametrize("kind", WRITERS)
def test_what_is_written_reads_back_with_the_same_connectivity(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.{kind}"
    path.write_bytes(WRITERS[kind](MESH))
    again = read_mesh(path)
    assert again.is_closed
    assert len(again.vertices) == len(MESH.vertices)
    assert again.volume == pytest.approx(MESH.volume, rel={"ply": 1e-15, "obj": 1e-8}.get(kind, 1e-6))
    if kind == "ply":
        assert again.digest == MESH.digest


@pytest.mark.parametrize("kind", WRITERS)
def test_a_reader_that_is_not_ours_sees_the_same_body(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.{kind}"
    path.write_bytes(WRITERS[kind](MESH))
    theirs = trimesh.load_mesh(path)
    assert theirs.is_watertight
    assert theirs.volume == pytest.approx(MESH.volume, rel=1e-6)
    np.testing.assert_allclose(theirs.bounds, MESH.bounds, rtol=1e-6)


@pytest.mark.parametrize("kind", WRITERS)
def test_the_same_mesh_gives_the_same_bytes_in_another_process(kind: str) -> None:
    code = (
        "import hashlib; from articad.geometry import sphere, write_stl, write_obj, write_glb, write_ply;"
        f"print(hashlib.sha256(write_{kind}(sphere(2, 8))).hexdigest())"
    )
    hashes = {
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True, env={"PYTHONHASHSEED": seed, "PYTHONPATH": "."}
        ).stdout
        for seed in ("1", "2")
    }
    assert len(hashes) == 1


def test_a_binary_stl_does_not_begin_with_solid_and_has_unit_normals_outwards() -> None:
    content = write_stl(box(2, 2, 2))
    assert not content.startswith(b"solid")
    assert len(content) == 84 + 50 * 12
    first = np.frombuffer(content, "<f4", 12, 84).reshape(4, 3)
    np.testing.assert_allclose(np.linalg.norm(first[0]), 1, rtol=1e-6)
    assert first[0] @ first[1:].mean(axis=0) > 0


def test_a_flat_triangle_gets_a_zero_normal_not_nan() -> None:
    flat = TriMesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]], dtype=np.int32))
    assert np.frombuffer(write_stl(flat), "<f4", 3, 84).tolist() == [0, 0, 0]


def test_a_glb_holds_its_colour_as_linear_factors() -> None:
    content = write_glb(box(1, 1, 1), "#ff8000")
    length = struct.unpack_from("<I", content, 12)[0]
    document = json.loads(content[20 : 20 + length])
    r, g, b, a = document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"]
    assert (r, b, a) == (1.0, 0.0, 1.0)
    assert g == pytest.approx(0.2158605, abs=1e-6)  # sRGB 128/255


def test_text_stl_is_read_in_any_case_and_layout(tmp_path: Path) -> None:
    for text in (TEXT_STL, TEXT_STL.upper(), TEXT_STL.replace("\n", "\r\n"), TEXT_STL.replace(" vertex", "\n\tvertex")):
        path = tmp_path / "a.stl"
        path.write_bytes(text.encode())
        assert read_mesh(path).vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_a_binary_stl_whose_header_says_solid_is_still_read(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    path.write_bytes(b"solid but binary".ljust(80) + write_stl(box(1, 1, 1))[80:])
    assert read_mesh(path).volume == pytest.approx(1)


def test_scale_turns_metres_into_millimetres(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_bytes(write_obj(box(0.001, 0.002, 0.003)))
    assert read_mesh(path, scale=1000.0).volume == pytest.approx(6)


OBJ_HEAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f 1 2 3 4\n",
        "f -4 -3 -2\nf -4 -2 -1\n",
        "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\n",
        "o thing\ns off\nusemtl red\nf 1 2 \\\n3 4\n",
        "f\t1 2 3\nf 1 3 4 # quad's other half\n".replace(" # quad's other half", ""),
    ],
)
def test_obj_dialects_give_the_same_square(faces: str, tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    for newline in ("\n", "\r\n"):
        path.write_text((OBJ_HEAD + faces).replace("\n", newline), newline="")
        mesh = read_mesh(path)
        assert mesh.area == pytest.approx(1)
        assert mesh.normals_of_twice_area.tolist() == [[0, 0, 1], [0, 0, 1]]


def test_negative_obj_indices_count_back_from_where_the_face_stands(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\nv 9 0 9\n")
    assert read_mesh(path).area == pytest.approx(0.5)


def test_glb_nodes_are_placed(tmp_path: Path) -> None:
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((1, 1, 1)), transform=trimesh.transformations.translation_matrix([10, 0, 0]))
    scene.add_geometry(trimesh.creation.box((1, 1, 1)))
    path = tmp_path / "a.glb"
    path.write_bytes(scene.export(file_type="glb"))
    mesh = read_mesh(path)
    np.testing.assert_allclose(mesh.bounds, [[-0.5, -0.5, -0.5], [10.5, 0.5, 0.5]], atol=1e-6)
    assert len(mesh.components()) == 2


STL = write_stl(box(1, 1, 1))
BROKEN = {
    "empty.stl": (b"", "byte 0"),
    "short.stl": (STL[:50], "byte 50"),
    "truncated.stl": (STL[:-20], "byte 664"),
    "longer.stl": (STL + b"xx", "byte 686"),
    "count.stl": (STL[:80] + struct.pack("<I", 2**32 - 1) + STL[84:], "byte 684"),
    "nan.stl": (STL[:96] + struct.pack("<f", np.nan) + STL[100:], "triangle 0"),
    "text_truncated.stl": (TEXT_STL.partition(" endloop")[0].encode(), "after line 6"),
    "text_word.stl": (TEXT_STL.replace("1e0", "one").encode(), "line 6"),
    "text_nan.stl": (TEXT_STL.replace("1e0", "nan").encode(), "triangle 0"),
    "text_four.stl": (TEXT_STL.replace(" vertex 1 0 0\n", " vertex 1 0 0\n vertex 1 0 0\n").encode(), "line 7"),
    "text_nothing.stl": (b"solid nothing\nendsolid nothing\n", "file"),
    "word.obj": (b"v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n", "line 2"),
    "short.obj": (b"v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "line 2"),
    "inf.obj": (b"v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n", "line 3"),
    "index.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4"),
    "zero.obj": (b"v 0 0 0\nf 0 0 0\n", "line 2"),
    "huge.obj": (b"v 0 0 0\nf 1 1 99999999999999999999999\n", "line 2"),
    "back.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", "line 4"),
    "two.obj": (b"v 0 0 0\nv 1 0 0\nf 1 2\n", "line 3"),
    "letters.obj": (b"v 0 0 0\nf a b c\n", "line 2"),
    "nothing.obj": (b"# nothing\n", "file"),
    "magic.glb": (b"glTX" + bytes(40), "byte 0"),
    "truncated.glb": (write_glb(box(1, 1, 1))[:-40], "byte"),
    "json.glb": (b"glTF" + struct.pack("<II", 2, 28) + struct.pack("<I4s", 8, b"JSON") + b"{not js}", "file"),
    "header.ply": (b"ply\nformat binary_little_endian 1.0\n", "header"),
    "truncated.ply": (write_ply(box(1, 1, 1))[:-40], "file"),
    "random.ply": (bytes(range(256)) * 4 + b"end_header", "file"),
    "random.step": (b"ISO-10303-21;", "name"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_file_is_refused_with_the_place(name: str, tmp_path: Path) -> None:
    content, where = BROKEN[name]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(ReadError) as caught:
        read_mesh(path)
    assert where in caught.value.where
    assert caught.value.findings.codes == ("E_READ",)
    assert name in str(caught.value)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="No such file"):
        read_mesh(tmp_path / "none.stl")


@pytest.mark.parametrize("kind", WRITERS)
def test_no_truncation_or_flipped_byte_gets_past_as_another_error(kind: str, tmp_path: Path) -> None:
    content = WRITERS[kind](box(1, 1, 1))
    rng = np.random.default_rng(3)
    path = tmp_path / f"a.{kind}"
    for _ in range(60):
        damaged = bytearray(content[: rng.integers(1, len(content) + 1)])
        for at in rng.integers(0, len(damaged), 3):
            damaged[at] ^= 1 << rng.integers(8)
        path.write_bytes(damaged)
        try:
            read_mesh(path)
        except ReadError as error:
            assert error.where  # noqa: PT017  reading may also succeed: many bits do not matter


def test_reading_stl_and_obj_does_not_load_trimesh() -> None:
    code = "import sys, articad.geometry; sys.exit('trimesh' in sys.modules or 'scipy' in sys.modules or 'pydantic' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False, env={"PYTHONPATH": "."}).returncode == 0


def test_an_obj_writes_every_number_in_as_many_digits_as_it_has() -> None:
    sides = 1 + np.arange(120)
    mesh = TriMesh(np.random.default_rng(0).normal(size=(121, 3)), np.stack([0 * sides[:-1], sides[:-1], sides[1:]], axis=1))
    lines = write_obj(mesh).decode("ascii").splitlines()
    assert [line for line in lines if line.startswith("f")] == [f"f 1 {k} {k + 1}" for k in range(2, 121)]
