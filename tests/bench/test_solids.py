"""Measures of solids, against shapes whose numbers are known beforehand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged
from articad.geometry.shapes import capsule, sphere, tube
from articad_bench.solids import Round, asymmetry, boxes_by_faces, held_volume, occupied, rounds, tipping_angle, wall_thickness

TURNS = [SE3.identity(), SE3.from_axis_angle(np.array([0.3, 0.5, 0.8]), 1.1) @ SE3.from_translation(np.array([40.0, -7.0, 3.0]))]


@pytest.mark.parametrize("placing", TURNS)
@pytest.mark.parametrize("segments", [12, 48, 96])
def test_a_tube_has_one_hole_and_one_stud_of_its_radii_and_length(placing: SE3, segments: int) -> None:
    found = rounds(tube(6, 10, 25, segments).transformed(placing))

    assert sorted((round(r.radius, 6), r.hollow, round(r.length, 6)) for r in found) == [(6, True, 25), (10, False, 25)]
    assert all(abs(float(r.axis @ placing.z_axis)) == pytest.approx(1) for r in found)
    assert all(np.allclose(r.centre, placing.translation) for r in found)
    assert not any(r.blind for r in found)


@pytest.mark.parametrize(
    "shape",
    [box(10, 20, 30), sphere(12), sphere(12, 31), cylinder(10, 20, 8)],
    ids=["box", "sphere", "sphere with a belt", "eight-sided prism"],
)
def test_what_is_not_round_has_no_holes_and_no_studs(shape: TriMesh) -> None:
    assert rounds(TriMesh(shape.vertices, shape.triangles)) == []


def test_a_hole_with_a_bottom_is_blind() -> None:
    pipe = tube(6, 10, 20)
    floor = cylinder(10, 2).transformed(SE3.from_translation(np.array([0, 0, -11.0])))

    assert [r.blind for r in rounds(merged([pipe, floor])) if r.hollow] == [True]


@pytest.mark.parametrize("gap", [2.0, 5.0])
def test_a_hole_that_faces_a_wall_has_no_bottom(gap: float) -> None:
    pipe = tube(6, 10, 20)
    wall = box(60, 60, 2).transformed(SE3.from_translation(np.array([0, 0, -11.0 - gap])))

    assert [r.blind for r in rounds(merged([pipe, wall])) if r.hollow] == [False]


def test_holes_in_one_line_count_each() -> None:
    lifted = tube(3, 8, 5).transformed(SE3.from_translation(np.array([0, 0, 30.0])))

    holes = [r for r in rounds(merged([tube(3, 8, 5), lifted])) if r.hollow]

    assert [round(float(r.centre[2])) for r in holes] == [0, 30]


def test_faces_in_halves_are_one_hole() -> None:
    mesh = tube(6, 10, 25, 64)
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    halves = TriMesh(mesh.vertices, mesh.triangles, (2 * _kind(mesh) + (middles[:, 0] > 0)).astype(np.int32))

    found: list[Round] = rounds(halves)

    assert sorted((r.hollow, round(r.radius, 6)) for r in found) == [(False, 10), (True, 6)]


def test_two_holes_of_one_size_whose_halves_alternate_are_two() -> None:
    mesh = tube(6, 10, 25, 64)
    halves = (2 * _kind(mesh) + (mesh.vertices[mesh.triangles].mean(axis=1)[:, 0] > 0)).astype(np.int32)
    both = merged([mesh, mesh.transformed(SE3.from_translation(np.array([32.0, 0, 0])))])
    order = np.argsort(np.tile(halves, 2), kind="stable")  # a half of the first, a half of the second, and again

    found = rounds(TriMesh(both.vertices, both.triangles[order], np.concatenate([halves, halves + 6])[order]))

    assert sorted((r.hollow, round(r.radius, 6)) for r in found) == [(False, 10)] * 2 + [(True, 6)] * 2


@pytest.mark.parametrize("placing", TURNS)
def test_a_pin_with_round_ends_is_a_stud_though_its_surface_bends_nowhere_sharply(placing: SE3) -> None:
    shape = capsule(6, 40).transformed(placing)

    (found,) = rounds(TriMesh(shape.vertices, shape.triangles))

    assert (round(found.radius, 6), round(found.length, 6), found.hollow) == (6, 40, False)
    assert abs(float(found.axis @ placing.z_axis)) == pytest.approx(1)


def test_coordinates_of_single_precision_have_the_same_grid() -> None:
    """The middles of 46 cells over 180 mm would lie in the faces of a board that is as wide, in one and beside the other."""
    exact, rounded = (occupied([box(400 + error, 180 + error, 100)])[0] for error in (0.0, 8e-6))

    assert rounded.shape == exact.shape == (100, 45, 25)


def test_a_plate_is_measured_along_the_line_of_two_eyes() -> None:
    """The least rectangle around three eyes is along the shorter sides of their triangle; what is stated is the longest one, 260 + 2 · 11."""
    turned = SE3.rot_z(0.05)
    eyes = [
        cylinder(11, 5).transformed(SE3.from_translation(turned.apply(np.array([x, y, 0.0])))) for x, y in ((0, 0), (260, 0), (130, 150))
    ]

    found = boxes_by_faces(merged(eyes))

    assert any(np.allclose(sides, [5, 172, 282], rtol=0.002) for sides in found)


def _kind(mesh: TriMesh) -> FloatArray:
    """0 below and above, 1 inside, 2 outside."""
    normals = mesh.normals_of_twice_area
    radial = (normals[:, :2] * mesh.vertices[mesh.triangles].mean(axis=1)[:, :2]).sum(axis=1)
    return np.asarray(np.where(np.abs(normals[:, 2]) > np.abs(radial), 0, np.where(radial < 0, 1, 2)), dtype=np.float64)


def test_the_wall_of_a_tube_is_as_thick_as_the_difference_of_its_radii() -> None:
    thick = wall_thickness(tube(20, 23, 100))

    assert float(((thick > 2.9) & (thick < 3.2)).mean()) > 0.9
    assert wall_thickness(box(10, 10, 10)) == pytest.approx(10, abs=0.01)


def cup() -> TriMesh:
    """Inside 20 mm in radius and 60 mm deep, wall and floor 4 mm; faceted finely."""
    pipe = tube(20, 24, 60, 128)
    floor = cylinder(24, 4, 128).transformed(SE3.from_translation(np.array([0, 0, -32.0])))
    return merged([pipe, floor])


def test_a_cup_holds_what_is_inside_it_and_nothing_upside_down_or_with_a_hole() -> None:
    assert held_volume(_apart(cup())) == pytest.approx(math.pi * 20**2 * 60, rel=0.03)
    over = SE3.from_axis_angle(np.array([1.0, 0, 0]), math.pi)
    assert held_volume([part.transformed(over) for part in _apart(cup())]) == 0
    assert held_volume([tube(20, 24, 60)]) == 0


@pytest.mark.parametrize("placing", [TURNS[0], SE3.from_axis_angle(np.array([1.0, 0.3, 0]), 0.02)])
def test_a_wall_far_thinner_than_a_cell_holds_water(placing: SE3) -> None:
    pipe = tube(20, 20.1, 60, 128)
    floor = cylinder(20.1, 0.1, 128).transformed(SE3.from_translation(np.array([0, 0, -30.05])))
    parts = [part.transformed(placing) for part in (pipe, floor)]

    assert held_volume(parts, 60) == pytest.approx(math.pi * 20**2 * (60 - 20 * 0.02), rel=0.04)
    assert held_volume([pipe], 60) == 0


def test_a_shallow_basin_on_a_high_foot_is_measured_as_well_and_the_hollow_of_its_foot_holds_nothing() -> None:
    up = SE3.from_translation(np.array([0, 0, 280.0]))
    foot = tube(15, 19, 280, 96).transformed(SE3.from_translation(np.array([0, 0, 108.0])))  # from below up to the basin's floor
    parts = [*(part.transformed(up) for part in _apart(cup())), foot]

    assert held_volume(parts) == pytest.approx(math.pi * 20**2 * 60, rel=0.02)


def test_a_sealed_hollow_holds_nothing() -> None:
    hollow = merged([box(40, 40, 40), box(30, 30, 30).flipped()])

    assert held_volume([hollow], 40) == 0


def test_a_cup_with_a_notch_holds_as_much_as_lies_below_it() -> None:
    walls = [box(4, 40, 60), box(4, 40, 60), box(40, 4, 60), box(40, 4, 40)]
    where = [(-18, 0, 0), (18, 0, 0), (0, 18, 0), (0, -18, -10)]  # the last one ends 20 mm lower
    parts = [wall.transformed(SE3.from_translation(np.array(at, dtype=float))) for wall, at in zip(walls, where, strict=True)]
    parts.append(box(40, 40, 4).transformed(SE3.from_translation(np.array([0, 0, -32.0]))))

    assert held_volume(parts) == pytest.approx(32 * 32 * 40, rel=0.03)


def _apart(mesh: TriMesh) -> tuple[TriMesh, ...]:
    return mesh.components()


def test_occupied_volume_is_that_of_the_solid() -> None:
    grid, pitch = occupied([sphere(30, 64)])

    assert float(grid.sum()) * pitch**3 == pytest.approx(4 / 3 * math.pi * 30**3, rel=0.01)


def test_only_what_is_its_own_mirror_image_is_symmetric() -> None:
    plain = box(60, 40, 20)
    lump = box(10, 10, 10).transformed(SE3.from_translation(np.array([25.0, 0, 15.0])))

    assert [asymmetry(occupied([plain])[0], axis) for axis in range(3)] == [0, 0, 0]
    with_lump = occupied([plain, lump])[0]
    assert asymmetry(with_lump, 0) > 0.01
    assert asymmetry(with_lump, 1) == 0
    assert asymmetry(np.zeros((4, 4, 4), dtype=bool), 0) == 1  # wires between the cells are not symmetric


@pytest.mark.parametrize(("com", "angle"), [((0, 0, 10), 45.0), ((5, 0, 10), math.degrees(math.atan2(5, 10))), ((15, 0, 10), -26.565)])
def test_a_block_tips_over_its_nearest_edge(com: tuple[float, float, float], angle: float) -> None:
    block = box(20, 40, 20).transformed(SE3.from_translation(np.array([0, 0, 10.0])))

    assert tipping_angle(block.vertices, np.array(com, dtype=float)) == pytest.approx(angle, abs=0.01)


def test_what_ends_in_a_point_does_not_stand() -> None:
    tip = np.array([[0, 0, 0], [10, 0, 20], [-10, 10, 20], [-10, -10, 20.0]])

    assert tipping_angle(tip, np.array([0, 0, 15.0])) < 0
