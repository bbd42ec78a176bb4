"""Parts: made from meshes and files, mirrored, without geometry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from articad.connectors import SE3, Connector, Plane
from articad.errors import ConnectorError, InvalidSolidError
from articad.geometry import Part, Shape, Solid, TriMesh, box, sphere, write_stl

HINGE = Connector("hinge", SE3.from_axes([1.0, 2, 3], [0.0, 0, 1], [1.0, 0, 0]))
S = Plane(np.array([0.0, 0, 0]), np.array([1.0, 0, 0])).matrix


def open_box() -> TriMesh:
    cube = box(1, 1, 1)
    return TriMesh(cube.vertices, cube.triangles[1:])


def test_a_closed_mesh_becomes_the_solid_with_mass_from_density() -> None:
    part = Part.from_mesh("block", box(10, 10, 10), density=1000.0)
    assert part.mass is not None
    assert part.mass.mass == pytest.approx(1e-3)
    assert part.solid is not None
    assert part.mesh is part.solid.mesh
    assert part.deflection == 0


def test_an_open_mesh_is_drawn_but_has_no_solid() -> None:
    part = Part.from_mesh("sheet", open_box())
    assert part.solid is None
    assert part.mass is None
    assert part.mesh is not None
    with pytest.raises(InvalidSolidError, match="3 of its edges"):
        Part.from_mesh("sheet", open_box(), density=1000.0)


def test_an_inside_out_mesh_is_refused_as_a_solid() -> None:
    with pytest.raises(InvalidSolidError, match="inside out"):
        Part.from_mesh("block", box(1, 1, 1).flipped(), density=1000.0)
    assert Part.from_mesh("block", box(1, 1, 1).flipped()).solid is None


def test_a_part_is_read_from_a_file_in_metres(tmp_path: Path) -> None:
    path = tmp_path / "block.stl"
    path.write_bytes(write_stl(box(0.01, 0.01, 0.01)))
    part = Part.from_mesh("block", path, density=1000.0, scale=1000.0)
    assert part.mass is not None
    assert part.mass.mass == pytest.approx(1e-3, rel=1e-6)


def test_a_part_without_geometry_has_no_mesh() -> None:
    part = Part.without_geometry("frame", {"hinge": HINGE})
    assert part.mesh is None
    assert part.deflection == 0
    assert "no geometry" in repr(part)


def test_collision_shapes_are_placed_and_merged_when_there_is_no_solid() -> None:
    shapes = (Shape(box(1, 1, 1)), Shape(box(1, 1, 1), SE3.from_translation([5.0, 0, 0])))
    mesh = Part("pair", collisions=shapes).mesh
    assert mesh is not None
    np.testing.assert_allclose(mesh.bounds, [[-0.5, -0.5, -0.5], [5.5, 0.5, 0.5]])


def test_a_mirrored_part_is_the_image_in_every_respect() -> None:
    mesh = box(10, 20, 30, center=False)
    part = Part.from_mesh("left", mesh, density=1000.0, connectors={"hinge": HINGE})
    image = part.mirrored("right", S)
    assert image.name == "right"
    assert image.mesh is not None
    assert image.solid is not None
    assert image.mass is not None
    np.testing.assert_allclose(image.mesh.bounds, [[-10, 0, 0], [0, 20, 30]])
    assert image.mesh.volume == pytest.approx(6000)
    np.testing.assert_allclose(image.mass.com, [-5, 10, 15])
    np.testing.assert_allclose(image.solid.com, image.mesh.centroid)
    np.testing.assert_allclose(image.connectors["hinge"].frame.translation, [-1, 2, 3])
    np.testing.assert_allclose(image.connectors["hinge"].frame.rotation, np.diag([-1.0, -1, 1]))
    assert image.solid.brep is None


def test_a_mirrored_shape_bakes_its_frame() -> None:
    shape = Shape(box(2, 2, 2), SE3.from_translation([5.0, 0, 0]) @ SE3.rot_z(0.3))
    image = Part("a", visuals=(shape,), collisions=(shape,)).mirrored("b", S)
    np.testing.assert_allclose(image.visuals[0].placed.centroid, [-5, 0, 0], atol=1e-12)
    assert image.visuals[0] is image.collisions[0]


def test_a_moved_solid_carries_its_numbers() -> None:
    T = SE3.from_axis_angle([1.0, 1, 0], 0.4) @ SE3.from_translation([7.0, 8, 9])
    moved = Solid.from_mesh(box(1, 2, 3, center=False)).moved(T)
    volume, com, inertia = moved.mesh.solid_integrals()
    assert moved.volume == pytest.approx(volume)
    np.testing.assert_allclose(moved.com, com, atol=1e-12)
    np.testing.assert_allclose(moved.inertia_mm5, inertia, atol=1e-12)
    np.testing.assert_allclose(moved.bbox, moved.mesh.bounds)


def test_a_step_file_is_read_by_the_reader_handed_in(tmp_path: Path) -> None:
    seen = []

    def read(path: Path, deflection: float) -> Solid:
        seen.append((path.name, deflection))
        return Solid.from_mesh(sphere(5, 16), deflection=deflection)

    part = Part.from_step("ball", tmp_path / "ball.step", read=read, deflection=0.02, density=1000.0)
    assert seen == [("ball.step", 0.02)]
    assert part.deflection == 0.02
    assert part.mass is not None


def test_an_unknown_connector_is_named_with_the_closest() -> None:
    part = Part.without_geometry("frame", {"hinge": HINGE})
    assert part["hinge"].part == "frame"
    with pytest.raises(ConnectorError, match="Did you mean 'hinge'"):
        part["hing"]


def test_a_renamed_part_shares_its_geometry() -> None:
    part = Part.from_mesh("a", box(1, 1, 1))
    assert part.renamed("b").mesh is part.mesh
    assert part.renamed("b").name == "b"


def test_the_digest_of_a_shape_sees_frame_and_colour() -> None:
    digests = {
        Shape(box(1, 1, 1)).digest,
        Shape(box(1, 1, 1), SE3.from_translation([0.0, 0, 1])).digest,
        Shape(box(1, 1, 1), color="#ffffff").digest,
        Shape(box(1, 1, 2)).digest,
    }
    assert len(digests) == 4
    assert Shape(box(1, 1, 1)).digest == Shape(box(1, 1, 1)).digest
