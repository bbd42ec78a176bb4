"""Solids are measured exactly, meshed closed within the deflection, and written the same each time."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import manifold3d
import numpy as np
import pytest

from articad.connectors import Plane
from articad.errors import ReadError
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Solid
from articad.kernels.build123d import Build123dKernel
from articad.kernels.kernel import BuildCache, BuiltPart
from tests.kernels.conftest import Build, kernel_of_its_own

A, B, C = 30.0, 20.0, 10.0
R, H = 7.0, 24.0
RING, TUBE = 12.0, 3.0
BOX_MASS = A * B * C
CYLINDER_MASS = math.pi * R**2 * H
BALL_MASS = 4 / 3 * math.pi * R**3
TORUS_MASS = 2 * math.pi**2 * RING * TUBE**2
CONE_MASS = math.pi * R**2 * H / 3

# volume, area, inertia about the centre at density one, by the textbook
KNOWN = {
    "box": (
        f"Box({A}, {B}, {C})",
        BOX_MASS,
        2 * (A * B + B * C + C * A),
        [BOX_MASS / 12 * (B**2 + C**2), BOX_MASS / 12 * (A**2 + C**2), BOX_MASS / 12 * (A**2 + B**2)],
    ),
    "cylinder": (
        f"Cylinder({R}, {H})",
        CYLINDER_MASS,
        2 * math.pi * R * (R + H),
        [CYLINDER_MASS * (3 * R**2 + H**2) / 12, CYLINDER_MASS * (3 * R**2 + H**2) / 12, CYLINDER_MASS * R**2 / 2],
    ),
    "sphere": (f"Sphere({R})", BALL_MASS, 4 * math.pi * R**2, [BALL_MASS * 0.4 * R**2] * 3),
    "torus": (
        f"Torus({RING}, {TUBE})",
        TORUS_MASS,
        4 * math.pi**2 * RING * TUBE,
        [TORUS_MASS * (4 * RING**2 + 5 * TUBE**2) / 8] * 2 + [TORUS_MASS * (4 * RING**2 + 3 * TUBE**2) / 4],
    ),
    "cone": (
        f"Cone({R}, 0, {H})",
        CONE_MASS,
        math.pi * R * (R + math.hypot(R, H)),
        [CONE_MASS * 3 / 80 * (4 * R**2 + H**2)] * 2 + [CONE_MASS * 0.3 * R**2],
    ),
}


@pytest.mark.parametrize("shape", KNOWN)
def test_volume_area_and_inertia_are_those_of_the_closed_formula(build: Build, shape: str) -> None:
    script, volume, area, moments = KNOWN[shape]

    solid = build(f"return Pos(100, -50, 3) * {script}, {{}}").solid

    assert solid.volume == pytest.approx(volume, rel=1e-9)
    assert solid.area == pytest.approx(area, rel=1e-9)
    assert np.diag(solid.inertia_mm5) == pytest.approx(moments, rel=1e-7)
    off = solid.inertia_mm5 - np.diag(np.diag(solid.inertia_mm5))
    assert np.abs(off).max() < 1e-7 * max(moments)


def test_inertia_follows_a_rotation(build: Build) -> None:
    turned = build(f"return Rot(0, 30, 0) * Box({A}, {B}, {C}), {{}}").solid

    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    rotation = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    assert turned.inertia_mm5 == pytest.approx(rotation @ np.diag(KNOWN["box"][3]) @ rotation.T, rel=1e-9, abs=1e-6)


SHAPES = {
    **{name: f"return {script}, {{}}" for name, (script, *_) in KNOWN.items()},
    "bored": "return Box(40, 40, 10) - Cylinder(5, 40) - Rot(90, 0, 0) * Cylinder(2, 100), {}",
    "hollow": "return Box(20, 20, 20) - Sphere(6), {}",
    "rounded": "s = Box(30, 20, 10)\nreturn fillet(s.edges(), 2), {}",
    "lofted": "return loft([Rectangle(20, 20).face(), Pos(0, 0, 30) * Circle(6).face()]), {}",
    "turned": "return revolve(Pos(10, 0) * Rectangle(4, 9).face(), axis=Axis.Y), {}",
    "half_ball": "return Sphere(9) & Pos(0, 0, 20) * Box(40, 40, 40), {}",
    "lettered": "return Box(60, 20, 4) + Pos(0, 0, 2) * extrude(Text('articad', 10), 1), {}",
}


@pytest.mark.parametrize("shape", SHAPES)
def test_mesh_is_a_manifold_of_the_same_volume(build: Build, shape: str) -> None:
    solid = build(SHAPES[shape]).solid
    mesh = solid.mesh

    manifold = manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
    assert manifold.status() == manifold3d.Error.NoError
    assert manifold.num_tri() == len(mesh.triangles)
    assert mesh.is_closed
    assert mesh.volume == pytest.approx(solid.volume, abs=solid.area * 0.01)
    assert mesh.bounds == pytest.approx(solid.bbox, abs=0.01)


def test_triangles_know_their_faces(build: Build) -> None:
    mesh = build("return Box(30, 20, 10), {}").solid.mesh

    assert mesh.face is not None
    assert sorted(set(mesh.face.tolist())) == list(range(6))
    for face in range(6):
        normals = mesh.normals_of_twice_area[mesh.face == face]
        assert np.linalg.matrix_rank(normals, tol=1e-9) == 1


@pytest.mark.parametrize("deflection", [0.5, 0.05, 0.01])
def test_mesh_stays_within_the_deflection(build: Build, deflection: float) -> None:
    mesh = build("return Sphere(25), {}", deflection=deflection).solid.mesh

    corners = mesh.vertices[mesh.triangles]
    for points in (corners.mean(axis=1), (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3) / 2):
        assert np.abs(25 - np.linalg.norm(points, axis=1)).max() <= deflection
    assert np.linalg.norm(mesh.vertices, axis=1) == pytest.approx(25, abs=1e-6)


def test_two_sheets_that_touch_stay_apart(build: Build) -> None:
    """A void whose corner touches the outer face: vertices that coincide are not joined where topology does not join them."""
    solid = build("return Box(20, 20, 20) - Pos(0, 0, 4.99) * Box(5, 5, 10), {}").solid

    manifold = manifold3d.Manifold(manifold3d.Mesh64(solid.mesh.vertices.copy(), solid.mesh.triangles.astype(np.uint64)))
    assert manifold.status() == manifold3d.Error.NoError


def test_files_are_those_that_the_contract_names(build: Build) -> None:
    built = build("return Box(1, 2, 3), {}")

    assert {path.name for path in built.folder.iterdir()} == {"result.json", "part.npz", "part.brep", "part.step"}
    result = json.loads((built.folder / "result.json").read_text())
    assert result["ok"] is True
    assert result["error"] is None
    assert set(result["shape"]) >= {"solids", "valid", "volume_mm3", "area_mm2", "bbox_mm", "com_mm", "inertia_mm5"}
    with np.load(built.folder / "part.npz", allow_pickle=False) as arrays:
        assert arrays["vertices"].dtype == np.float64
        assert arrays["triangles"].dtype == np.int32
        assert arrays["face"].dtype == np.int32
    step = (built.folder / "part.step").read_text()
    assert re.search(r"FILE_NAME\('[^']*',\s*'2000-01-01T00:00:00'", step)
    assert "PRODUCT('lug','lug'" in step


def test_another_zygote_writes_the_same_bytes(build: Build) -> None:
    body = "s = Box(30, 20, 10) - Cylinder(4, 30)\nreturn fillet(s.edges().filter_by(Axis.Z), 2), {}"
    other = kernel_of_its_own()
    try:
        first, second = build(body), build(body, with_kernel=other)
    finally:
        other.close()

    for name in ("result.json", "part.npz", "part.brep", "part.step"):
        assert (first.folder / name).read_bytes() == (second.folder / name).read_bytes(), name


def test_mirror_is_the_mirror_image(kernel: Build123dKernel, build: Build) -> None:
    wedge = "return Pos(5, 0, 0) * Box(10, 4, 4) + Pos(9, 0, 4) * Box(2, 4, 6), {'a': {'o': (1, 2, 3), 'z': (0, 1, 0), 'x': (1, 0, 0)}}"
    connectors = {"a": {"o": [1, 2, 3], "z": [0, 1, 0], "x": [1, 0, 0], "label": "", "joints": []}}
    built = build(wedge, connectors=connectors)
    S = Plane(np.array([1.0, 0, 0]), np.array([1.0, 1.0, 0])).matrix

    image = kernel.mirror(built, S)

    expected = built.solid.mirrored(S)
    assert image.solid.volume == pytest.approx(built.solid.volume, rel=1e-12)
    assert image.solid.com == pytest.approx(expected.com, abs=1e-9)
    assert image.solid.inertia_mm5 == pytest.approx(expected.inertia_mm5, rel=1e-9, abs=1e-6)
    assert image.solid.mesh.volume > 0
    assert image.connectors["a"].frame.allclose(built.connectors["a"].mirrored(S).frame)
    assert read_step(kernel, _step(image)).volume == pytest.approx(built.solid.volume, rel=1e-9)


def read_step(kernel: Build123dKernel, path: Path) -> Solid:
    return kernel.read_step(path, cache=BuildCache(path.parent.parent / "read"))


def _step(built: BuiltPart) -> Path:
    assert built.solid.step is not None
    return built.solid.step


def test_step_comes_back(kernel: Build123dKernel, build: Build) -> None:
    built = build(SHAPES["bored"])

    read = read_step(kernel, _step(built))

    assert read.volume == pytest.approx(built.solid.volume, rel=1e-9)
    assert read.com == pytest.approx(built.solid.com, abs=1e-7)
    assert read.mesh.is_closed


def test_a_file_that_is_no_step_is_refused(kernel: Build123dKernel, tmp_path: Path) -> None:
    path = tmp_path / "wrong.step"
    path.write_bytes(b"solid not a step file\n" * 100)

    with pytest.raises(ReadError, match=r"wrong\.step"):
        read_step(kernel, path)


def test_step_of_several_solids_is_refused(kernel: Build123dKernel, build: Build, tmp_path: Path) -> None:
    """Two products in one file: their entities are joined by hand, so that no exporter of ours is trusted."""
    lines = _step(build("return Box(1, 2, 3), {}")).read_text()
    head, data = lines.split("DATA;\n")
    body = data.split("ENDSEC;")[0]
    shifted = re.sub(r"#(\d+)", lambda match: f"#{int(match[1]) + 10000}", body)
    path = tmp_path / "two.step"
    path.write_text(f"{head}DATA;\n{body}{shifted}ENDSEC;\nEND-ISO-10303-21;\n")

    with pytest.raises(ReadError, match="2 solids"):
        read_step(kernel, path)


def test_mesh_is_read_only(build: Build) -> None:
    mesh: TriMesh = build("return Box(1, 2, 3), {}").solid.mesh

    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 1.0
