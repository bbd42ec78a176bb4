"""Which parts can leave, which way, and in what order the whole goes together."""

from __future__ import annotations

import math

import manifold3d as m3
import numpy as np
import pytest

from articad.connectors import SE3
from articad.disassembly.order import assembly_order
from articad.disassembly.ways import LastOutlines, WayOut, Ways, ways_out
from articad.geometry import TriMesh, box, cylinder
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint
from tests.interference.mechanisms import IDENTITY, at, block_with_bore, joint, manifold_mesh

OUT = SE3.from_axes([0.0, 0, 0], [0.0, -1, 0], [1.0, 0, 0])


def scene_of(meshes: dict[str, TriMesh], joints: list[Joint] | None = None) -> Scene:
    return Scene.of(meshes, joints or [], deflection=0.01)


def rest(meshes: dict[str, TriMesh]) -> dict[str, SE3]:
    return dict.fromkeys(meshes, IDENTITY)


def escapes(scene: Scene, poses: dict[str, SE3], part: str, directions: np.ndarray | None = None) -> tuple[WayOut, ...]:
    return ways_out(Ways(scene, poses), part, directions=directions)


def ways(found: tuple[WayOut, ...]) -> set[tuple[int, int, int]]:
    return {(round(e.direction[0]), round(e.direction[1]), round(e.direction[2])) for e in found if e.free}


def cabinet(*, lid: bool) -> TriMesh:
    shell = m3.Manifold.cube([100, 95, 50], center=True) - m3.Manifold.cube([90, 95, 40], center=True).translate([0, -5, 0])
    if lid:
        shell += m3.Manifold.cube([100, 5, 50], center=True).translate([0, -50, 0])
    return manifold_mesh(shell)


DRAWER = box(88, 80, 38).transformed(at(y=-3))


def test_a_drawer_leaves_by_the_front_only() -> None:
    meshes = {"cabinet": cabinet(lid=False), "drawer": DRAWER}
    slide = joint("slide", "slider", "cabinet", "drawer", at_parent=OUT, at_child=OUT, lower=(0.0,), upper=(40.0,))
    found = escapes(scene_of(meshes, [slide]), rest(meshes), "drawer")
    assert ways(found) == {(0, -1, 0)}
    assert found[0].free  # the joint's axis is tried first
    assert {escape.blocker for escape in found if not escape.free} == {"cabinet"}


def test_a_drawer_behind_a_wall_is_captive_and_the_cabinet_blocks_it() -> None:
    meshes = {"cabinet": cabinet(lid=True), "drawer": DRAWER}
    found = escapes(scene_of(meshes), rest(meshes), "drawer")
    assert ways(found) == set()
    order = assembly_order(scene_of(meshes), rest(meshes), "cabinet")
    (blocked,) = order.blocked
    assert blocked.parts == ("cabinet", "drawer")
    (finding,) = order.findings
    assert finding.code == "W_NOT_INSERTABLE"
    assert "cabinet" in finding.message


def test_a_shaft_leaves_its_bore_along_its_axis_and_a_collar_leaves_one_way() -> None:
    meshes = {"block": block_with_bore(40, 10, 5.1, 48), "shaft": cylinder(5, 30, 48)}
    assert ways(escapes(scene_of(meshes), rest(meshes), "shaft")) == {(0, 0, 1), (0, 0, -1)}
    collar = manifold_mesh(m3.Manifold.cylinder(30, 5, 5, 48, center=True) + m3.Manifold.cylinder(4, 9, 9, 48).translate([0, 0, 6]))
    meshes["shaft"] = collar
    assert ways(escapes(scene_of(meshes), rest(meshes), "shaft")) == {(0, 0, 1)}


def test_a_thin_wire_in_the_way_is_not_jumped_over() -> None:
    meshes = {"part": box(10, 10, 10), "wire": cylinder(0.1, 200, 8).transformed(at(137.3))}
    found = escapes(scene_of(meshes), rest(meshes), "part", directions=np.array([[1.0, 0, 0]]))
    assert found[0].free is False
    assert found[0].blocker == "wire"
    assert found[0].travel == pytest.approx(137.3 - 5 - 0.1, abs=0.1)


def test_the_order_puts_the_lid_on_last() -> None:
    box_open = manifold_mesh(m3.Manifold.cube([60, 60, 40], center=True) - m3.Manifold.cube([50, 50, 40], center=True).translate([0, 0, 5]))
    meshes = {
        "lid": box(60, 60, 4).transformed(at(z=22)),
        "box": box_open,
        "filling": box(48, 48, 20).transformed(at(z=-4)),
        "label": box(20, 20, 1).transformed(at(z=-14.5 + 20.5 + 0.51)),
    }
    order = assembly_order(scene_of(meshes), rest(meshes), "box")
    assert [step.parts for step in order.steps] == [("box",), ("filling",), ("label",), ("lid",)]
    assert order.ok
    assert not order.findings
    assert {step.strength for step in order.steps} == {"proven"}


def test_two_parts_that_hold_each_other_are_both_named() -> None:
    # a ring linked through the eye of another: neither leaves in a straight line
    ring = m3.Manifold.cylinder(4, 20, 20, 32, center=True) - m3.Manifold.cylinder(8, 12, 12, 32, center=True)
    meshes = {
        "base": box(10, 10, 2).transformed(at(z=-60)),
        "one": manifold_mesh(ring),
        "two": manifold_mesh(ring.rotate([90, 0, 0]).translate([16, 0, 0])),
    }
    order = assembly_order(scene_of(meshes), rest(meshes), "base")
    (blocked,) = order.blocked
    assert set(blocked.parts) == {"one", "two"}
    assert {(row.part, row.by) for row in blocked.stops} == {("one", "two"), ("two", "one")}


def test_directions_follow_the_part_where_it_stands() -> None:
    T = SE3.rot_z(0.7)
    meshes = {"block": block_with_bore(40, 10, 5.1, 48), "shaft": cylinder(5, 30, 48)}
    poses = dict.fromkeys(meshes, T @ SE3.rot_x(0.4))
    free = [escape.direction for escape in escapes(scene_of(meshes), poses, "shaft") if escape.free]
    axis = (T @ SE3.rot_x(0.4)).z_axis
    assert sorted(round(math.copysign(1, float(np.dot(way, axis)))) for way in free) == [-1, 1]
    assert all(abs(abs(float(np.dot(way, axis))) - 1) < 1e-9 for way in free)


def test_free_says_what_stop_says_and_measures_no_pair_after_one_that_meets() -> None:
    bars = {name: box(20, 20, 20).transformed(at(x=30.0 * k)) for k, name in enumerate("abcdef")}
    scene, known = scene_of(bars), np.random.default_rng(7).normal(size=(40, 3))
    asked, answered = Ways(scene, rest(bars)), Ways(scene, rest(bars))
    for way in [*np.eye(3), *-np.eye(3), *(known / np.linalg.norm(known, axis=1)[:, None])]:
        for offset in (None, np.array([0.0, 3.0, 1.0])):
            halt = answered.stop(["a", "b"], "cdef", way, offset=offset)
            assert asked.free(["a", "b"], "cdef", way, offset=offset) == math.isinf(halt.travel)
    measured = len(asked._meets)
    assert measured < len(answered._known)  # blocked directions end early
    last = Ways(scene, rest(bars))
    assert not last.free(["a"], "bcdef", np.array([1.0, 0, 0]))
    assert len(last._meets) == 1
    assert not last.free(["a"], "fedcb", np.array([1.0, 0, 0]), offset=np.array([0.0, 1.0, 0]))
    assert len(last._meets) == 2  # the pair that met before is asked first, whatever the order


def test_free_lets_pass_what_is_permitted() -> None:
    bars = {"a": box(20, 20, 20), "b": box(20, 20, 20).transformed(at(x=30.0))}
    east = np.array([1.0, 0, 0])
    assert not Ways(scene_of(bars), rest(bars)).free(["a"], ["b"], east)
    assert Ways(scene_of(bars), rest(bars), [frozenset("ab")]).free(["a"], ["b"], east)


def test_outlines_that_are_kept_have_no_more_triangles_than_stated() -> None:
    meshes = {"block": block_with_bore(40, 10, 5.1, 48), "shaft": cylinder(5, 30, 48)}
    scene, most = scene_of(meshes), 3 * max(len(mesh.triangles) for mesh in meshes.values())
    few, all_of_them = (Ways(scene, rest(meshes), outlines=LastOutlines(scene.bodies, number)) for number in (most, 1 << 20))
    for seed in (3, 4, 3):
        for row in np.random.default_rng(seed).normal(size=(3, 3)):
            way = row / np.linalg.norm(row)
            assert few.travel("block", "shaft", way) == all_of_them.travel("block", "shaft", way)
            assert few.outlines.triangles <= most
    assert most < all_of_them.outlines.triangles == 6 * sum(len(mesh.triangles) for mesh in meshes.values())


def test_ways_at_other_poses_take_outlines_of_parts_that_did_not_move_from_the_first() -> None:
    meshes = {"block": block_with_bore(40, 10, 5.1, 48), "shaft": cylinder(5, 30, 48)}
    scene, up = scene_of(meshes), np.array([0.0, 0, 1])
    first = Ways(scene, rest(meshes))
    first.travel("block", "shaft", up)
    assert first.outlines.triangles == sum(len(mesh.triangles) for mesh in meshes.values())
    Ways(scene, {**rest(meshes), "shaft": at(z=3)}, outlines=first.outlines).travel("block", "shaft", up)
    assert first.outlines.triangles == len(meshes["block"].triangles) + 2 * len(meshes["shaft"].triangles)
