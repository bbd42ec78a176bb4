"""One pose: the known answers of the definition, and every trap of the libraries underneath."""

from __future__ import annotations

import gc
import json
import math
import pickle
import weakref

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates.certificate import certify
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged, sphere
from articad.interference.body import Body
from articad.interference.check import Checks, check_pose
from articad.interference.overlap import overlap
from articad.kinematics import Mechanism
from articad.kinematics.joints import Joint
from tests.interference.mechanisms import (
    IDENTITY,
    Fit,
    Waiver,
    at,
    block_with_bore,
    fixed,
    joint,
    manifold_mesh,
    random_rotation,
    soup,
    without_triangle,
)

CUBE = box(10, 10, 10)
HINGE = joint("hinge", "revolute", "a", "b")


def check(a: TriMesh, b: TriMesh, T_a_b: SE3, joints: tuple[Joint, ...] = (), *, T_a: SE3 = IDENTITY, **options: object) -> Checks:
    return check_pose({"a": a, "b": b}, {"a": T_a, "b": T_a @ T_a_b}, joints=joints, **options)  # type: ignore[arg-type]


# --- overlap and its tolerance


@pytest.mark.parametrize("deep", [0.05, 0.1, 1.0])
def test_overlapping_faces_are_found_with_their_volume_and_depth(deep: float) -> None:
    report = check(CUBE, CUBE, at(10 - deep))
    (pair,) = report.pairs
    assert report.findings.codes == ("E_OVERLAP",)
    assert not report.ok
    assert pair.volume == pytest.approx(100 * deep)
    assert pair.depth == pytest.approx(deep, rel=1e-6)
    assert pair.verdict == "overlap"


def test_unrelated_parts_may_overlap_by_less_than_a_fiftieth() -> None:
    report = check(CUBE, CUBE, at(10 - 0.019))
    assert report.ok
    assert report.pairs[0].verdict == "contact"
    assert not check(CUBE, CUBE, at(10 - 0.021)).ok


def test_the_deflection_of_both_meshes_is_added_to_what_is_allowed() -> None:
    assert check(CUBE, CUBE, at(10 - 0.039), deflection=0.01).ok
    assert not check(CUBE, CUBE, at(10 - 0.041), deflection=0.01).ok
    assert check(CUBE, CUBE, at(10 - 0.029), deflection={"a": 0.01}).ok
    assert not check(CUBE, CUBE, at(10 - 0.031), deflection={"a": 0.01}).ok


def test_an_overlap_below_a_thousandth_of_a_cubic_millimetre_is_rounding() -> None:
    needle = box(0.1, 0.1, 20)
    assert check(CUBE, needle, at(4.99 + 0.05, 4.99 + 0.05)).ok  # 0.01 x 0.01 x 10 = 1e-3 mm³
    assert not check(CUBE, needle, at(4.95 + 0.05, 4.95 + 0.05)).ok


def test_a_poking_corner_is_as_deep_as_its_tip_not_as_its_mean_thickness() -> None:
    tip_down = SE3.from_axis_angle([1.0, -1, 0], math.acos(1 / math.sqrt(3)))
    lowest = tip_down.apply(CUBE.vertices)[:, 2].min()
    report = check(box(100, 100, 100), CUBE, at(0.3, 0.2, 50 - lowest - 1.0) @ tip_down)
    assert report.pairs[0].depth == pytest.approx(1.0, abs=1e-6)


def test_every_piece_of_an_overlap_is_judged_by_itself() -> None:
    # a wide shallow piece must not thin out a small deep one
    comb = merged([box(100, 100, 10).transformed(at(z=5 - 0.01)), box(2, 2, 10).transformed(at(x=80, z=5 - 1.0))])
    report = check(box(300, 300, 10).transformed(at(z=-5)), comb, IDENTITY)
    assert report.pairs[0].depth == pytest.approx(1.0, rel=1e-6)


def test_a_wire_through_a_plate_is_found_though_no_vertex_is_inside() -> None:
    assert not check(box(100, 100, 1), box(0.2, 0.2, 50), at(3.3, 7.7)).ok


def test_a_thin_blade_inside_a_block_is_found() -> None:
    assert not check(box(100, 100, 100), box(60, 0.05, 60), IDENTITY).ok


# --- traps of the libraries


def test_a_part_inside_another_is_found_though_their_surfaces_are_apart() -> None:
    report = check(CUBE, box(2, 2, 2), at(0.3, 0.2, 0.1))
    assert report.findings.codes == ("E_OVERLAP",)
    assert report.pairs[0].volume == pytest.approx(8.0)


def test_a_part_inside_another_is_found_with_large_meshes_too() -> None:
    fine = sphere(40, 96)  # 9000 triangles: FCL is asked first, and sees nothing
    report = check(fine, sphere(5, 80), at(1, 2, 3))
    assert report.findings.codes == ("E_OVERLAP",)
    assert report.pairs[0].volume == pytest.approx(sphere(5, 80).volume)
    assert check(fine, sphere(5, 80), at(30, 30, 30), over="pose").ok  # in the corner of the box, outside the ball


def test_a_loose_piece_inside_a_solid_is_found_though_another_piece_is_outside() -> None:
    pieces = merged([box(1, 1, 1).transformed(at(100)), sphere(2, 96)])
    assert not check(sphere(40, 96), pieces, IDENTITY).ok


def test_a_ball_in_the_cavity_of_a_hollow_solid_is_free() -> None:
    hollow = merged([sphere(40, 96), sphere(20, 96).flipped()])
    assert check(hollow, sphere(5, 80), at(1, 2, 3), over="pose").ok
    assert not check(hollow, sphere(5, 80), at(30, 2, 3), over="pose").ok


def test_touching_faces_are_clean_in_200_random_orientations() -> None:
    rng = np.random.default_rng(0)
    for _ in range(200):
        T_a = at(*rng.uniform(-100, 100, 3)) @ random_rotation(rng)
        report = check(CUBE, CUBE, at(10, *rng.uniform(-4, 4, 2)), T_a=T_a)
        assert report.ok
        assert report.deepest < 1e-9


@pytest.mark.parametrize("offset", [(10.0, 5.0, 3.0), (10.0, 10.0, 0.0), (10.0, 10.0, 10.0)], ids=["half a face", "edge", "corner"])
def test_touching_in_part_of_a_face_an_edge_or_a_corner_is_clean(offset: tuple[float, float, float]) -> None:
    for T_a in (IDENTITY, SE3.rot_z(0.3) @ SE3.rot_x(0.2)):
        assert check(CUBE, CUBE, at(*offset), T_a=T_a).ok


@pytest.mark.parametrize("far", [1e3, 1e5, 1e7])
def test_verdicts_hold_far_from_the_origin_in_any_orientation(far: float) -> None:
    rng = np.random.default_rng(1)
    for _ in range(5):
        T_a = at(far, -far, far) @ random_rotation(rng)
        assert check(CUBE, CUBE, at(10), T_a=T_a).ok
        assert not check(CUBE, CUBE, at(9.9), T_a=T_a).ok


def test_meshes_far_from_their_own_origin_keep_their_verdicts() -> None:
    far = at(123456.789, 123456.789, 123456.789)
    a, b = CUBE.transformed(far), CUBE.transformed(far @ at(10))
    assert check(a, b, IDENTITY).ok
    assert check(a, CUBE.transformed(far @ at(9.97)), IDENTITY).pairs[0].depth == pytest.approx(0.03, rel=1e-4)


@pytest.mark.parametrize("phase", np.linspace(0, 1, 9).tolist())
@pytest.mark.parametrize("clearance", [0.0, 0.005, 0.02])
def test_a_shaft_in_a_bore_with_clearance_is_clean_at_every_phase_of_its_facets(clearance: float, phase: float) -> None:
    shaft, block = cylinder(10, 20, 64), block_with_bore(40, 10, 10 + clearance, 64)
    sagitta = 10 * (1 - math.cos(math.pi / 64))
    report = check(block, shaft, SE3.rot_z(phase * 2 * math.pi / 64), (HINGE,), deflection=sagitta)
    assert report.ok
    assert not report.findings
    assert report.deepest <= sagitta + 1e-6


def test_facets_out_of_phase_overlap_by_no_more_than_the_sagitta() -> None:
    shaft, block = cylinder(10, 20, 64), block_with_bore(40, 10, 10, 64)
    sagitta = 10 * (1 - math.cos(math.pi / 64))
    pair = check(block, shaft, SE3.rot_z(math.pi / 64), (HINGE,)).pairs[0]
    assert 0.4 * sagitta < pair.depth <= sagitta + 1e-9


def test_a_press_fit_of_a_tenth_is_a_fit_and_one_of_two_tenths_is_reported() -> None:
    block = block_with_bore(40, 10, 5, 96)
    press = check(block, cylinder(5.1, 20, 96), IDENTITY, (HINGE,), deflection=0.003)
    assert press.ok
    assert not press.findings
    assert press.pairs[0].depth == pytest.approx(0.1, rel=0.05)
    forced = check(block, cylinder(5.13, 100, 96), IDENTITY, (HINGE,), deflection=0.003)
    assert forced.ok
    assert forced.findings.codes == ("W_STATIC_OVERLAP",)


def test_a_shaft_through_a_solid_block_is_an_error_of_the_script() -> None:
    report = check(box(40, 40, 10), cylinder(5, 20, 64), IDENTITY, (HINGE,))
    (finding,) = report.findings
    assert (finding.code, finding.route, finding.where) == ("E_STATIC_OVERLAP", "code", "joints.hinge")


def test_static_overlap_has_caps_in_mm_besides_the_relative_one() -> None:
    # 0.9 % of a large part, but a millimetre deep
    plate = box(300, 300, 10)
    report = check(plate, plate, at(z=10 - 1.1), (HINGE,))
    assert "E_STATIC_OVERLAP" in report.findings.codes
    # shallow and below 1 %, but ten cubic centimetres
    slab = box(300, 300, 100)
    report = check(slab, slab, at(z=100 - 0.12), (HINGE,))
    assert "E_STATIC_OVERLAP" in report.findings.codes


def test_a_soup_of_triangles_is_welded_and_judged() -> None:
    assert not check(soup(CUBE), CUBE, at(9)).ok
    assert check(soup(CUBE), CUBE, at(10)).ok


@pytest.mark.parametrize(
    ("broken", "why"),
    [
        (without_triangle(CUBE), "open: 3 edges"),
        (soup(without_triangle(CUBE)), "open"),
        (CUBE.flipped(), "inside out"),
        (TriMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int32)), "no triangles"),
        (merged([CUBE, box(1, 1, 1).transformed(at(20)).flipped()]), "inside out"),
    ],
    ids=["hole", "soup with hole", "inside out", "empty", "one shell inside out"],
)
@pytest.mark.parametrize("apart", [5.0, 500.0])
def test_a_broken_mesh_is_refused_and_its_pairs_are_unknown_even_when_far(broken: TriMesh, why: str, apart: float) -> None:
    report = check(broken, CUBE, at(apart))
    (finding,) = report.findings.of("E_MESH_OPEN")
    assert why in finding.message
    assert not report.ok
    (pair,) = report.pairs
    assert pair.verdict == "unknown"
    assert pair.strength.kind == "not_checked"
    assert why in pair.strength.reason


def test_parts_without_geometry_overlap_nothing_and_are_named() -> None:
    report = check_pose({"a": CUBE}, {"a": IDENTITY, "frame": IDENTITY}, joints=[joint("j", "revolute", "a", "frame")])
    assert report.ok
    assert report.without_geometry == ("frame",)


# --- relations, rigid groups, waivers


def test_relations_follow_the_joints() -> None:
    cubes = dict.fromkeys("abcd", CUBE)
    poses = {name: at(10.0 * i) for i, name in enumerate("abcd")}
    joints = [fixed("ab", "a", "b"), fixed("bc", "b", "c"), joint("cd", "revolute", "c", "d")]
    report = check_pose(cubes, poses, joints=joints)
    relations = {pair.parts: pair.relation for pair in report.pairs}
    assert relations == {("a", "b"): "rigid", ("b", "c"): "rigid", ("c", "d"): "mating"}


def test_parts_of_one_rigid_group_are_judged_at_rest_only() -> None:
    assert not check(CUBE, CUBE, at(5), (fixed("f", "a", "b"),)).ok
    assert check(CUBE, CUBE, at(5), (fixed("f", "a", "b"),), over="pose").pairs == ()


def test_a_rigid_group_without_a_direct_joint_has_the_tolerance_of_unrelated_parts() -> None:
    meshes = {"a": CUBE, "m": box(40, 40, 1), "b": CUBE}
    poses = {"a": at(z=5.5), "m": IDENTITY, "b": at(10 - 0.05, z=5.5)}
    report = check_pose(meshes, poses, joints=[fixed("am", "m", "a"), fixed("bm", "m", "b")])
    assert report.findings.codes == ("E_OVERLAP",)


def test_a_waiver_covers_its_pair_up_to_its_depth_and_is_reported_with_its_reason() -> None:
    waiver = Waiver(("b", "a"), 0.5, "faceted flanks")
    report = check(CUBE, CUBE, at(9.6), waivers=[waiver])
    assert report.ok
    (finding,) = report.findings
    assert finding.code == "I_WAIVED"
    assert "faceted flanks" in finding.message
    assert report.pairs[0].strength.to_json() == {"kind": "waived", "reason": "faceted flanks"}
    assert report.pairs[0].allowed == 0.5


def test_a_waiver_does_not_cover_more_than_its_cap_or_another_pair() -> None:
    deeper = check(CUBE, CUBE, at(9.4), waivers=[Waiver(("a", "b"), 0.5, "faceted flanks")])
    assert deeper.findings.codes == ("E_OVERLAP",)
    assert "covers only 0.5 mm" in deeper.findings[0].message
    assert not check(CUBE, CUBE, at(9.6), waivers=[Waiver(("a", "c"), 0.5, "another")]).ok


# --- holding


def test_parts_that_are_fixed_must_touch() -> None:
    joints = (fixed("glue", "a", "b"),)
    assert check(CUBE, CUBE, at(10.05), joints).ok
    report = check(CUBE, CUBE, at(12), joints)
    (finding,) = report.findings
    assert (finding.code, finding.cause, finding.route, finding.where) == ("E_NOT_TOUCHING", "not_touching", "code", "joints.glue")
    assert finding.value == pytest.approx(2.0)
    assert report.pairs == () or report.pairs[0].gap == pytest.approx(2.0)


def test_a_third_part_of_the_rigid_group_may_connect_two_that_are_apart() -> None:
    meshes = {"a": CUBE, "b": CUBE, "bridge": box(40, 10, 2)}
    poses = {"a": IDENTITY, "b": at(14), "bridge": at(7, 0, 6)}
    joints = [fixed("ab", "a", "b"), fixed("bridge", "a", "bridge")]
    assert check_pose(meshes, poses, joints=joints).ok
    assert not check_pose(meshes, {**poses, "bridge": at(7, 0, 26)}, joints=joints).ok


def test_a_fit_of_a_fixed_joint_says_how_far_apart_its_parts_may_be() -> None:
    joints = (fixed("glue", "a", "b"),)
    assert check(CUBE, CUBE, at(10.3), joints, fits={"glue": Fit(gap_max=0.5)}).ok
    assert not check(CUBE, CUBE, at(10.7), joints, fits={"glue": Fit(gap_max=0.5)}).ok


def test_a_group_that_leads_to_no_ground_floats_and_is_reported_once() -> None:
    meshes = {"base": box(50, 50, 10), "b": CUBE, "c": CUBE}
    poses = {"base": IDENTITY, "b": at(z=60), "c": at(10.2, z=60)}
    joints = [joint("lift", "slider", "base", "b"), joint("turn", "revolute", "b", "c")]
    (finding,) = check_pose(meshes, poses, joints=joints).findings
    assert (finding.code, finding.cause, finding.parts, finding.where) == ("E_FLOATING", "floating", ("b", "c"), "joints.lift")
    assert finding.value == pytest.approx(50.0)
    assert check_pose(meshes, {"base": IDENTITY, "b": at(z=13), "c": at(10.2, z=13)}, joints=joints).ok is False  # 3 mm > a tenth of 17 mm
    assert check_pose(meshes, {"base": IDENTITY, "b": at(z=11), "c": at(10.2, z=11)}, joints=joints).ok


def test_a_declared_gap_keeps_a_part_from_floating() -> None:
    joints = (joint("run", "slider", "a", "b"),)
    assert not check(CUBE, CUBE, at(14), joints).ok
    assert check(CUBE, CUBE, at(14), joints, fits={"run": Fit(gap_max=4.5)}).ok


def test_a_part_without_geometry_may_hold_others() -> None:
    joints = [joint("j", "revolute", "frame", "a"), joint("k", "revolute", "frame", "b")]
    report = check_pose({"a": CUBE, "b": CUBE}, {"frame": IDENTITY, "a": IDENTITY, "b": at(90)}, joints=joints, ground="frame")
    assert report.ok


def test_at_another_pose_nothing_is_said_of_floating() -> None:
    assert check(CUBE, CUBE, at(90), over="pose").ok


# --- the report


def test_the_report_has_the_form_of_the_contract() -> None:
    report = json.loads(json.dumps(check(CUBE, CUBE, at(9.6), (HINGE,), deflection=0.01).to_json()))
    assert report["schema"] == "articad.checks/1"
    assert report["ok"] is False
    assert report["deflection_mm"] == 0.01
    assert report["pairs"] == [
        {
            "parts": ["a", "b"],
            "relation": "mating",
            "over": "rest",
            "strength": {"kind": "sampled", "poses": 1, "step": None},
            "volume_mm3": 40.0,
            "depth_mm": 0.4,
            "allowed_mm": 0.12,
            "gap_mm": None,
            "verdict": "overlap",
        }
    ]


def test_gaps_are_measured_on_request() -> None:
    joints = (joint("j", "revolute", "a", "b"),)
    ring, pin = block_with_bore(40, 10, 5.2, 64), cylinder(5.0 / math.cos(math.pi / 64), 20, 64)
    pair = check(ring, pin, SE3.rot_z(math.pi / 64), joints, gaps=True).pairs[0]
    assert pair.gap == pytest.approx(5.2 * math.cos(math.pi / 64) - 5.0 / math.cos(math.pi / 64), abs=0.02)


def test_many_parts_are_checked_pair_by_pair_as_if_all_pairs_were_asked() -> None:
    rng = np.random.default_rng(5)
    names = [f"p{i}" for i in range(30)]
    poses = {name: at(*rng.uniform(-30, 30, 3)) @ random_rotation(rng) for name in names}
    report = check_pose(dict.fromkeys(names, CUBE), poses, joints=[])
    cube = m3.Manifold.cube([10, 10, 10], center=True)
    expected = set()
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            common = cube.transform(poses[a].matrix[:3]) ^ cube.transform(poses[b].matrix[:3])
            if common.volume() > 1e-3 and 2 * common.volume() / common.surface_area() > 0.02:
                expected.add((a, b))
    assert expected
    assert {pair.parts for pair in report.pairs if pair.verdict == "overlap"} >= expected


def test_a_refined_mesh_gives_the_verdict_of_the_coarse_one() -> None:
    fine = manifold_mesh(m3.Manifold.cube([10, 10, 10], center=True).refine(24))
    assert len(fine.triangles) > 4000
    for T, ok in ((at(9.9), False), (at(10.0), True), (at(9.0, 9.0, 9.0), False), (at(10.5), True)):
        assert check(fine, CUBE, T).ok is ok
        assert check(fine, fine, T).ok is ok


@pytest.mark.parametrize(
    ("mesh", "deepest"),
    [(box(20, 20, 20), 10.0), (box(4, 30, 12), 2.0), (cylinder(5, 40, segments=64), 5 * math.cos(math.pi / 64)), (cylinder(30, 8), 4.0)],
    ids=["cube", "plate", "rod", "disc"],
)
def test_two_equal_solids_in_one_place_are_as_deep_as_the_largest_ball_inside(mesh: TriMesh, deepest: float) -> None:
    rng = np.random.default_rng(5)
    for _ in range(3):
        T = SE3.from_axes(tuple(rng.uniform(-50, 50, 3)), tuple(rng.normal(size=3)))
        moved = mesh.transformed(T)
        assert overlap(Body(moved), Body(moved), IDENTITY).depth == pytest.approx(deepest, rel=1e-6)


# --- what is kept with a mesh


def test_checks_keep_nothing_of_a_mesh_that_is_gone() -> None:
    meshes = {"a": box(10, 10, 10), "b": cylinder(4, 12)}
    check_pose(meshes, {"a": IDENTITY, "b": at(5, 0, 0)}, joints=())
    certify(meshes, Mechanism(["a", "b"], "a", [joint("hinge", "revolute", "a", "b", at_parent=at(30, 0, 0))]))
    kept = [weakref.ref(mesh) for mesh in meshes.values()]
    meshes.clear()
    gc.collect()
    assert [mesh() for mesh in kept] == [None, None]


def test_a_mesh_can_be_pickled_after_a_check() -> None:
    mesh = box(10, 10, 10)
    check(mesh, CUBE, at(5, 0, 0))
    copy = pickle.loads(pickle.dumps(mesh))
    assert np.array_equal(copy.vertices, mesh.vertices)
    assert np.array_equal(copy.triangles, mesh.triangles)
    assert copy.digest == mesh.digest
