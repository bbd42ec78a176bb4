"""Certified motion: known first contacts, what sampling misses, budgets; and a checker that refutes planted lies."""

from __future__ import annotations

import ast
import copy
import io
import json
import math
import sys
import tokenize
import tracemalloc
import zipfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates import verifier, verifier_files, verifier_tolerance
from articad.certificates.certificate import Certificate, certify
from articad.certificates.clearing import shortest_between
from articad.certificates.ranges import PROVEN
from articad.certificates.spread import Spread
from articad.certificates.verifier import PROOF, verify_file
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged, sphere, tube
from articad.interference.body import body_of
from articad.interference.boxtree import BoxTree
from articad.interference.check import check_pose
from articad.interference.cover import cover_line
from articad.interference.freedoms import motion_matrix, swing_and_twist
from articad.interference.meridian import leaning, meeting, outline
from articad.interference.motion import Chain, Route
from articad.interference.overlap import overlap
from articad.interference.surface import Core, Surface, surface_distance
from articad.interference.work import WorkBudget
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from tests.growth import bytecodes_of
from tests.interference.mechanisms import (
    IDENTITY,
    Waiver,
    at,
    block_with_bore,
    fixed,
    joint,
    manifold_mesh,
    proof_of,
    random_rotation,
    saved,
    verified,
    without_triangle,
)

Z_DOWN_Y = SE3.from_axes([0.0, 0, 0], [0.0, -1, 0], [1.0, 0, 0])


def proven(meshes: Mapping[str, TriMesh], connections: Sequence[Joint], *, bare: tuple[str, ...] = (), **options: Any) -> Certificate:
    parts = (*bare, *meshes)
    return certify(meshes, Mechanism(parts, parts[0], connections), **options)


def refutations(certificate: Certificate, change: Callable[[dict[str, Any]], object] | None = None) -> list[str]:
    document = json.loads(json.dumps(certificate.to_json()))
    if change is not None:
        document = copy.deepcopy(document)
        change(document)
    return verified(document, certificate)


def bar_and_post() -> tuple[dict[str, TriMesh], float]:
    """A bar 200 x 4 from the axis, and a post of diameter 0.2 at 150 mm and 45°; and the exact angle of first contact."""
    n, r, reach, half = 64, 0.1, 150.0, 2.0
    bar = box(200, 2 * half, 4, center=False).transformed(at(0, -half, -2))
    post = cylinder(r, 60, n, phase=0.1).transformed(at(reach * math.cos(math.pi / 4), reach * math.sin(math.pi / 4)))
    # the bar's upper edge y = half turns by q until the lowest vertex of the post, seen from the bar, is on it
    corner = post.vertices[:, :2]

    def clearance(q: float) -> float:
        return float((-math.sin(q) * corner[:, 0] + math.cos(q) * corner[:, 1]).min() - half)

    low, high = 0.0, math.pi / 4
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if clearance(middle) > 0 else (low, middle)
    return {"post": post, "bar": bar}, low


def hinge_with_stop(clearance: float = 0.0) -> dict[str, TriMesh]:
    """An arm on a pin, and a stop that its edge meets."""
    pin = m3.Manifold.cylinder(30, 5, 5, 64, center=True)
    stop = m3.Manifold.cube([10, 10, 40], center=True).translate([-40, 0, 0])
    foot = m3.Manifold.cube([60, 10, 10], center=True).translate([-20, 0, -20])
    arm = m3.Manifold.cube([60, 10, 10]).translate([0, -5, -5]) + m3.Manifold.cylinder(10, 9, 9, 64, center=True)
    bore = m3.Manifold.cylinder(30, 5 + clearance, 5 + clearance, 64, center=True)
    return {"base": manifold_mesh(pin + stop + foot), "arm": manifold_mesh(arm - bore)}


HINGE = joint("hinge", "revolute", "base", "arm")


# --- first contact


def test_the_first_contact_of_a_bar_with_a_post_is_exact_for_the_meshes() -> None:
    meshes, exact = bar_and_post()
    certificate = proven(meshes, [joint("turn", "revolute", "post", "bar", lower=(0.0,), upper=(6.0,))])
    (finding,) = certificate.findings
    assert finding.code == "E_MOTION_COLLISION"
    assert finding.value == pytest.approx(exact, abs=1e-4)
    assert certificate.ranges[0].lower == 0.0
    assert exact - 1e-4 < certificate.ranges[0].upper <= exact
    assert not certificate.ok
    assert refutations(certificate) == []  # what is claimed, up to the contact, still holds


def test_a_bar_of_10_meets_a_post_of_02_at_100_100_at_its_known_angle() -> None:
    meshes = {"post": cylinder(0.1, 60, 64).transformed(at(100, 100)), "bar": box(200, 10, 10, center=False).transformed(at(0, -5, -5))}
    (finding,) = proven(meshes, [joint("turn", "revolute", "post", "bar", lower=(0.0,), upper=(2.0,))]).findings
    assert finding.code == "E_MOTION_COLLISION"
    assert finding.value == pytest.approx(math.radians(42.9333259), abs=1e-4)  # 45° − asin((5 + 0.1) / √2·100)


def test_an_arm_on_its_pin_meets_the_edge_of_a_stop_at_its_known_angle() -> None:
    known, radius = math.radians(127.543748), 40.0
    meshes = hinge_with_stop()
    edge = known + math.asin(5 / radius)  # the arm is 5 to either side, and its side meets the edge of the stop
    stop = (
        m3.Manifold.cube([8, 8, 40], center=True).rotate([0, 0, 45]).translate([0, 4 * math.sqrt(2), 0]).rotate([0, 0, math.degrees(edge)])
    )
    stop = stop.translate([radius * math.cos(edge), radius * math.sin(edge), 0])
    pin, foot = m3.Manifold.cylinder(30, 5, 5, 64, center=True), m3.Manifold.cube([60, 10, 10], center=True).translate([-20, 0, -20])
    meshes["base"] = manifold_mesh(pin + foot + stop + m3.Manifold.cube([80, 80, 4], center=True).translate([0, 0, -22]))
    hinge = joint("hinge", "revolute", "base", "arm", lower=(0.0,), upper=(2.6,))
    certificate = proven(meshes, [hinge])
    (finding,) = certificate.findings
    assert finding.code == "E_MOTION_COLLISION"
    assert finding.value == pytest.approx(known, abs=1e-4)
    assert known - 1e-4 < certificate.ranges[0].upper <= known


def test_with_deflection_the_solids_contact_is_an_interval_whose_width_is_printed() -> None:
    meshes, exact = bar_and_post()
    certificate = proven(meshes, [joint("turn", "revolute", "post", "bar", lower=(0.0,), upper=(6.0,))], deflection=0.05)
    (finding,) = certificate.findings
    assert certificate.ranges[0].upper < exact - 0.09 / 150
    assert finding.value == pytest.approx(exact, abs=1e-4)
    assert "an interval of" in finding.message


def test_a_hinge_in_contact_is_free_up_to_its_stop() -> None:
    certificate = proven(hinge_with_stop(), [HINGE], deflection=0.01)
    (finding,) = certificate.findings
    # the arm's far edge (60, ±5) meets the stop's near face or edge; the exact angle is where the two edges cross
    assert finding.code == "E_MOTION_COLLISION"
    exact = _angle_of_first_overlap(hinge_with_stop())
    assert abs(abs(finding.value or 0.0) - exact) < 1e-4
    (known,) = certificate.ranges
    assert known.upper < exact
    assert known.lower > -exact
    assert known.upper > exact - 0.01
    inside = joint("hinge", "revolute", "base", "arm", lower=(known.lower + 1e-3,), upper=(known.upper - 1e-3,))
    again = proven(hinge_with_stop(), [inside], deflection=0.01)
    assert again.ok
    assert refutations(again) == []


def _angle_of_first_overlap(meshes: Mapping[str, TriMesh]) -> float:
    """Where the solids beyond the pin begin to overlap, by bisection with booleans of bare boxes."""
    stop = m3.Manifold.cube([10, 10, 40], center=True).translate([-40, 0, 0])
    arm = m3.Manifold.cube([60, 10, 10]).translate([0, -5, -5])
    low, high = 2.0, math.pi
    for _ in range(50):
        middle = (low + high) / 2
        hit = (arm.rotate([0, 0, math.degrees(middle)]) ^ stop).volume() > 0
        low, high = (low, middle) if hit else (middle, high)
    return low


@pytest.mark.parametrize("step", [math.radians(5), math.radians(1)])
def test_a_thin_door_meets_a_wire_that_samples_miss(step: float) -> None:
    wire = cylinder(0.05, 100, 12).transformed(at(200 * math.cos(1.234), 200 * math.sin(1.234)))
    door = box(250, 0.2, 50, center=False).transformed(at(0, -0.1, -25))
    joints = [fixed("held", "frame", "wire"), joint("swing", "revolute", "frame", "door", lower=(0.0,), upper=(2.0,))]
    sampled = [
        check_pose({"wire": wire, "door": door}, {"wire": IDENTITY, "door": SE3.rot_z(q)}, joints=[], over="pose").ok
        for q in np.arange(0, 2.0, step)
    ]
    assert all(sampled)
    certificate = proven({"wire": wire, "door": door}, joints, bare=("frame",))
    (finding,) = certificate.findings
    assert finding.code == "E_MOTION_COLLISION"
    assert finding.value == pytest.approx(1.234 - 0.15 / 200, abs=1e-4)


def test_a_part_that_starts_inside_another_is_not_certified() -> None:
    certificate = proven({"case": box(100, 100, 100), "core": box(5, 5, 5)}, [joint("spin", "revolute", "case", "core")])
    assert not certificate.ok
    assert certificate.claims == ()


def test_a_part_that_moves_into_another_and_would_be_inside_at_the_end_collides() -> None:
    slide = joint("slide", "slider", "case", "core", lower=(0.0,), upper=(200.0,))
    core = box(5, 5, 5).transformed(at(z=-200))
    certificate = proven({"case": box(100, 100, 100), "core": core}, [slide])
    (finding,) = certificate.findings
    assert finding.code == "E_MOTION_COLLISION"
    assert finding.value == pytest.approx(200 - 50 - 2.5, abs=1e-3)


def test_touching_at_the_end_of_the_range_is_no_collision() -> None:
    slide = joint("slide", "slider", "a", "b", lower=(-20.0,), upper=(0.0,), rest=(-10.0,))
    certificate = proven({"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(z=-10))}, [slide], deflection=0.01)
    assert certificate.ok
    assert refutations(certificate) == []


# --- contact and clearance


@pytest.mark.parametrize("clearance", [0.0, 0.02, 0.1])
def test_a_shaft_in_its_bore_is_certified_over_a_full_turn(clearance: float) -> None:
    meshes = {"block": block_with_bore(40, 10, 10 + clearance, 64), "shaft": cylinder(10, 20, 64, phase=0.03)}
    certificate = proven(meshes, [joint("turn", "revolute", "block", "shaft")], deflection=0.0125)
    assert certificate.ok
    assert certificate.pairs[0].strength.kind == "certified"
    assert refutations(certificate) == []


def test_a_pin_in_a_blind_bore_is_certified() -> None:
    bore = m3.Manifold.cylinder(8, 5.15, 5.15, 64).translate([0, 0, -8])
    block = manifold_mesh(m3.Manifold.cube([40, 40, 20], center=True).translate([0, 0, -10]) - bore)
    pin = manifold_mesh(m3.Manifold.cylinder(40, 5, 5, 64).translate([0, 0, -7.8]) + m3.Manifold.cube([50, 6, 6]).translate([0, -3, 20]))
    certificate = proven({"block": block, "pin": pin}, [joint("turn", "revolute", "block", "pin")], deflection=0.01)
    assert certificate.ok
    assert refutations(certificate) == []


def test_an_oversize_pin_is_static_overlap_and_no_motion_collision() -> None:
    meshes = {"block": block_with_bore(40, 10, 5, 96), "pin": cylinder(5.3, 20, 96)}
    certificate = proven(meshes, [joint("turn", "revolute", "block", "pin")], deflection=0.003)
    assert certificate.findings.codes == ("E_STATIC_OVERLAP", "W_NOT_CERTIFIED")
    assert not certificate.ok


def test_a_press_fit_is_sampled_and_not_called_certified() -> None:
    meshes = {"block": block_with_bore(40, 10, 5, 48), "pin": cylinder(5.1, 20, 48)}
    certificate = proven(meshes, [joint("turn", "revolute", "block", "pin", lower=(-0.5,), upper=(0.5,))], deflection=0.003)
    assert certificate.findings.codes == ("W_NOT_CERTIFIED",)
    assert certificate.pairs[0].strength.kind == "sampled"
    assert not certificate.ok


def test_a_waiver_covers_a_pair_in_motion_up_to_its_depth() -> None:
    meshes = {"block": block_with_bore(40, 10, 5, 48), "pin": cylinder(5.3, 20, 48)}
    turn = joint("turn", "revolute", "block", "pin", lower=(-0.5,), upper=(0.5,))
    certificate = proven(meshes, [turn], deflection=0.003, waivers=[Waiver(("block", "pin"), 0.4, "shrunk on")])
    assert certificate.ok
    assert certificate.pairs[0].strength.kind == "waived"
    assert refutations(certificate) == []


def test_a_drawer_that_slides_on_its_rails_without_clearance_is_certified() -> None:
    carcass = manifold_mesh(
        m3.Manifold.cube([100, 100, 50], center=True) - m3.Manifold.cube([90, 100, 40], center=True).translate([0, -5, 0])
    )
    drawer = box(90, 90, 40)
    slide = joint("slide", "slider", "carcass", "drawer", at_parent=Z_DOWN_Y, at_child=Z_DOWN_Y, lower=(0.0,), upper=(20.0,))
    certificate = proven({"carcass": carcass, "drawer": drawer}, [slide], deflection=0.01)
    assert certificate.ok
    assert certificate.pairs[0].verdict == "contact"
    assert refutations(certificate) == []
    too_far = joint("slide", "slider", "carcass", "drawer", at_parent=Z_DOWN_Y, at_child=Z_DOWN_Y, lower=(-3.0,), upper=(20.0,))
    (finding,) = proven({"carcass": carcass, "drawer": drawer}, [too_far], deflection=0.01).findings
    assert finding.code == "E_MOTION_COLLISION"
    assert -0.2 < (finding.value or 0.0) < 0.0


def ball_and_socket() -> dict[str, TriMesh]:
    stud = m3.Manifold.sphere(8, 32) + m3.Manifold.cylinder(60, 3, 3, 24).translate([0, 0, 4])
    socket = m3.Manifold.cylinder(16, 14, 14, 48, center=True).translate([0, 0, -4]) - m3.Manifold.sphere(8.4, 32)
    return {"socket": manifold_mesh(socket), "stud": manifold_mesh(stud)}


def test_a_ball_in_its_socket_is_certified_over_its_cone_and_a_full_twist() -> None:
    meshes = ball_and_socket()
    certificate = proven(meshes, [joint("knuckle", "ball", "socket", "stud", cone=0.25)], deflection=0.02)
    assert certificate.ok
    assert certificate.queries < 50_000  # the twist is not cut
    assert refutations(certificate) == []
    wide = joint("knuckle", "ball", "socket", "stud", cone=1.4)
    assert "E_MOTION_COLLISION" in proven(meshes, [wide], deflection=0.02).findings.codes


def test_a_disc_on_the_stud_that_meets_the_socket_as_it_swings_is_refuted() -> None:
    meshes = ball_and_socket()
    certificate = proven(meshes, [joint("knuckle", "ball", "socket", "stud", cone=0.3)], deflection=0.02)
    V = meshes["stud"].vertices
    disc = TriMesh(
        np.where((V[:, 2] > 8.1)[:, None], V * [8, 8, 7.5 / 64], V), meshes["stud"].triangles
    )  # the end of the rod becomes its rim
    bodies = body_of(meshes["socket"]), body_of(disc)
    assert overlap(*bodies, IDENTITY).volume == 0
    assert overlap(*bodies, SE3.rot_x(0.29)).depth > 0.02
    document = certificate.to_json()
    document["meshes"]["stud"]["sha256"] = disc.digest
    assert any("too close" in reason for reason in verified(document, certificate, stud=saved(**arrays_of(disc))))


def test_from_angles_about_a_ball_its_swing_is_taken_off() -> None:
    meshes = ball_and_socket()
    certificate = proven(meshes, [joint("knuckle", "ball", "socket", "stud", cone=0.3)], deflection=0.02)
    V = meshes["stud"].vertices
    funnel = TriMesh(np.where((V[:, 2] > 8.1)[:, None], V * [2.9, 2.9, 1], V), meshes["stud"].triangles)
    widest, opening = math.atan2(3 * 2.9, 7.34), math.atan2(7.39, 4)  # of the rod: its largest radius at its least height
    assert widest < opening < widest + 0.3
    document = certificate.to_json()
    document["meshes"]["stud"]["sha256"] = funnel.digest
    assert any("too close" in reason for reason in verified(document, certificate, stud=saved(**arrays_of(funnel))))


def test_a_rod_slides_and_turns_in_its_bush() -> None:
    bush = tube(8.2, 20, 10, 48)
    rod = manifold_mesh(m3.Manifold.cylinder(200, 8, 8, 48, center=True) + m3.Manifold.cube([6, 60, 12], center=True).translate([0, 0, 40]))
    play = joint("play", "cylindrical", "bush", "rod", lower=(-20.0, -math.pi), upper=(20.0, math.pi))
    certificate = proven({"bush": bush, "rod": rod}, [play], deflection=0.02)
    assert certificate.ok
    assert refutations(certificate) == []
    too_far = joint("play", "cylindrical", "bush", "rod", lower=(-50.0, -math.pi), upper=(20.0, math.pi))
    assert proven({"bush": bush, "rod": rod}, [too_far], deflection=0.02).findings.codes == ("E_MOTION_COLLISION",)


# --- several joints, budgets, broken meshes


def arm(reach: float) -> tuple[dict[str, TriMesh], list[Joint]]:
    """Two links in one plane, and a wall that only both together can reach."""
    links = {"base": box(20, 20, 2).transformed(at(z=-9)), "upper": box(100, 6, 6, center=False).transformed(at(4, -3, -3))}
    links["fore"] = box(100, 6, 6, center=False).transformed(at(104, -3, 4))
    links["base"] = merged([links["base"], box(5, 200, 30).transformed(at(reach, 0, 0))])
    shoulder = joint("shoulder", "revolute", "base", "upper", lower=(-1.0,), upper=(1.0,), rest=(1.0,))
    # both rest folded away from the wall
    elbow = joint("elbow", "revolute", "upper", "fore", at_parent=at(100), at_child=at(100), lower=(-1.5,), upper=(1.5,), rest=(1.5,))
    return links, [shoulder, elbow]


def test_two_joints_that_collide_only_together_are_found() -> None:
    links, joints = arm(165.0)
    alone = proven(links, joints, pairs=False)
    assert alone.ok
    together = proven(links, joints, pairs=True)
    assert "E_MOTION_COLLISION" in together.findings.codes
    assert not together.ok


def test_plates_on_an_axis_askew_to_both_are_certified_and_accepted() -> None:
    askew = SE3.from_axis_angle([1.0, 1.0, 0.0], 0.6)  # boxes about the plates overlap, the plates do not
    hinge = joint("hinge", "revolute", "base", "arm", at_parent=askew, at_child=askew, lower=(-math.pi,), upper=(math.pi,))
    meshes = {"base": box(40, 40, 2).transformed(askew), "arm": box(40, 20, 2).transformed(askew @ at(z=2.5))}
    certificate = proven(meshes, [hinge])
    assert certificate.ok
    assert refutations(certificate) == []


def test_two_slides_in_a_row_are_certified_and_accepted() -> None:
    joints = [
        joint("first", "slider", "base", "table", lower=(0.0,), upper=(20.0,)),
        joint("second", "slider", "table", "tool", at_parent=Z_DOWN_Y, at_child=Z_DOWN_Y, lower=(0.0,), upper=(20.0,)),
    ]
    meshes = {"base": box(10, 10, 10), "table": box(10, 10, 10).transformed(at(z=15)), "tool": box(5, 5, 5).transformed(at(x=30))}
    certificate = proven(meshes, joints)
    assert certificate.ok
    assert refutations(certificate) == []


def test_parts_that_no_joint_can_bring_together_are_certified_over_all_joints_at_once() -> None:
    links, joints = arm(260.0)
    certificate = proven(links, joints)
    assert certificate.ok
    (pair,) = [pair for pair in certificate.pairs if set(pair.parts) == {"base", "fore"}]
    assert pair.over == ("shoulder", "elbow")
    assert refutations(certificate) == []


def test_only_the_joints_asked_for_are_proven() -> None:
    links, joints = arm(260.0)
    certificate = proven(links, joints, joints=["elbow"])
    assert {name for pair in certificate.pairs for name in pair.over} == {"elbow"}
    assert refutations(certificate) == []


def test_a_spent_budget_names_the_pairs_left_and_is_not_ok() -> None:
    links, joints = arm(260.0)
    certificate = proven(links, joints, budget=0.0)
    assert not certificate.ok
    assert set(certificate.findings.codes) == {"E_NOT_CHECKED"}
    left = {name for finding in certificate.findings for name in finding.parts}
    assert left == {"base", "upper", "fore"}
    assert all(pair.strength.kind == "not_checked" and pair.verdict == "unknown" for pair in certificate.pairs)


def test_a_broken_mesh_is_not_checked_and_not_ok() -> None:
    meshes = {"base": without_triangle(box(10, 10, 10)), "arm": box(10, 10, 10).transformed(at(50))}
    certificate = proven(meshes, [HINGE])
    assert certificate.findings.codes == ("E_NOT_CHECKED",)
    assert not certificate.ok


# --- the pieces it rests on


@pytest.mark.parametrize("kind", [kind for kind in JointType if kind is not JointType.FIXED])
def test_no_point_moves_faster_than_its_reach(kind: JointType) -> None:
    rng = np.random.default_rng(list(JointType).index(kind))
    count = 0 if kind is JointType.BALL else len(kind.coordinates)
    first = joint(
        "j",
        kind,
        "a",
        "m",
        at_parent=at(*rng.uniform(-20, 20, 3)) @ random_rotation(rng),
        at_child=at(*rng.uniform(-20, 20, 3)) @ random_rotation(rng),
        lower=(-1.0,) * count,
        upper=(1.5,) * count,
        cone=1.0,
        lead=7.0,
    )
    second = joint("k", "cylindrical", "m", "b", at_parent=at(30) @ random_rotation(rng), lower=(-10.0, -2.0), upper=(5.0, 2.0))
    points_a, points_b = rng.uniform(-30, 30, (20, 3)), rng.uniform(-30, 30, (20, 3))
    for route in (Route(("a", "m", "b"), (first, second)), Route(("b", "m", "a"), (second, first)), Route(("m", "a"), (first,))):
        chain = Chain(route, ["j", "k"])
        reach = chain.reach(points_a, points_b)
        low, high = (np.array([getattr(f, key) for f in chain.freedoms]) for key in ("lower", "upper"))
        for _ in range(60):
            q = rng.uniform(low, high)
            p = np.clip(q + rng.normal(size=len(q)) * rng.choice([1e-4, 0.1, 1.0]), low, high)
            there, here = (chain.matrix(x) for x in (p, q))
            apart = [np.linalg.norm(points_a[:, None] - (points_b @ T[:3, :3].T + T[:3, 3])[None], axis=2) for T in (here, there)]
            assert np.abs(apart[0] - apart[1]).max() <= reach @ np.abs(p - q) + 1e-9


def test_a_point_on_the_axis_of_a_screw_moves_by_its_lead() -> None:
    thread = joint("j", "screw", "a", "b", lower=(-1.0,), upper=(1.0,), lead=-7.0)
    chain = Chain(Route(("a", "b"), (thread,)), ["j"])
    on_axis = np.array([[0.0, 0.0, 3.0]])
    assert chain.reach(on_axis, on_axis) == pytest.approx([7.0 / (2 * math.pi)])


def test_a_chain_places_parts_as_the_mechanism_does() -> None:
    rng = np.random.default_rng(3)
    joints = [
        joint("j", "revolute", "g", "a", at_parent=random_rotation(rng), at_child=at(1, 2, 3)),
        joint("k", "screw", "b", "a", at_parent=at(5, 6, 7) @ random_rotation(rng), at_child=random_rotation(rng), lead=4.0),
        joint("p", "planar", "b", "c", at_child=at(3) @ random_rotation(rng)),
        joint("u", "universal", "g", "d", at_parent=random_rotation(rng)),
        joint("s", "ball", "d", "e", at_child=at(1, 1, 1), cone=1.0),
    ]
    mechanism = Mechanism(("g", "a", "b", "c", "d", "e"), "g", joints)
    values = {name: rng.uniform(-1, 1) for name in ("j", "k", "p.x", "p.y", "p.angle", "u.a", "u.b", "s.sx", "s.sy", "s.twist")}
    tree = mechanism.tree
    chain = Chain(Route(tree.path("c", "e"), tree.joints_between("c", "e")), ["k", "s"], values)
    q = {name: value for name, value in values.items() if not name.startswith("s.")}
    swing = motion_matrix(joints[4], [values[f"s.{key}"] for key in ("sx", "sy", "twist")])
    q.update(zip(("s.qx", "s.qy", "s.qz", "s.qw"), SE3.from_matrix(swing).quaternion.tolist(), strict=True))
    poses = dict(zip(mechanism.parts, mechanism.poses([q[c.name] for c in mechanism.drivers]), strict=True))
    expected = (poses["c"].inverse() @ poses["e"]).matrix
    np.testing.assert_allclose(chain.matrix([values[f.name] for f in chain.freedoms]), expected, atol=1e-12)


@pytest.mark.parametrize("gap", [5.0, 1.0, 0.1, 0.01])
def test_a_line_needs_few_more_distances_than_the_integral_says(gap: float) -> None:
    def distance(q: Sequence[float] | np.ndarray) -> float:
        return gap + 20 * (1 - math.cos(float(q[0])))

    budget = WorkBudget(60)
    cover = cover_line(distance, (-math.pi, math.pi), 0.3, reach=200.0, budget=budget)
    q = np.linspace(-math.pi, math.pi, 100_001)
    least = np.trapezoid(200 / (2 * (gap + 20 * (1 - np.cos(q)))), q)
    assert cover.is_complete
    assert budget.queries <= 1.3 * least


@pytest.mark.parametrize("first", [kind for kind in JointType if kind is not JointType.FIXED])
@pytest.mark.parametrize("second", [JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.BALL])
def test_no_point_strays_further_along_a_direction_than_its_bound(first: JointType, second: JointType) -> None:
    rng = np.random.default_rng(17 * list(JointType).index(first) + list(JointType).index(second))
    one, two = (random_joint(rng, *row) for row in (("j", first, "a", "m"), ("k", second, "b", "m")))
    for route in (Route(("a", "m", "b"), (one, two)), Route(("b", "m", "a"), (two, one))):
        chain = Chain(route, ["j", "k"], coordinates=PROVEN)
        low, high = (np.array([getattr(f, key) for f in chain.freedoms]) for key in ("lower", "upper"))
        for scale in (1e-3, 0.1, 1.0):
            spread, q, half = Spread(chain), rng.uniform(low, high), rng.uniform(0, scale, len(low))
            spread.add(q[None], half[[factor.column for _, factor in spread.factors]][None])
            local, u = rng.uniform(-30, 30, (8, 3)), rng.normal(size=(8, 4, 3))
            u /= np.linalg.norm(u, axis=2, keepdims=True)
            T, box = spread.T[0], np.zeros(8, dtype=np.int64)
            p = local @ T[:3, :3].T + T[:3, 3]
            bound = spread.first_order(box, u, p, None).sum(axis=2) + spread.second_order(box, u, p, np.zeros(8))
            for _ in range(30):
                T = chain.matrix(q + half * (rng.uniform(-1, 1, len(q)) if rng.random() < 0.5 else rng.choice([-1.0, 1.0], len(q))))
                moved = np.einsum("nk,ndk->nd", local @ T[:3, :3].T + T[:3, 3] - p, u)
                assert (np.abs(moved) <= bound + 1e-9).all()


def random_joint(rng: np.random.Generator, name: str, kind: JointType, parent: str, child: str) -> Joint:
    count = 0 if kind is JointType.BALL else len(kind.coordinates)
    frames = [at(*rng.uniform(-20, 20, 3)) @ random_rotation(rng) for _ in range(2)]
    bounds: dict[str, Any] = {"lower": (-1.0,) * count, "upper": (1.5,) * count}
    return joint(name, kind, parent, child, at_parent=frames[0], at_child=frames[1], cone=1.0, lead=7.0, **bounds)


def test_every_triangle_is_in_one_leaf_and_in_all_boxes_above_it() -> None:
    tree = BoxTree.of(Surface.of(sphere(10, 12)))
    leaves = tree.triangle[tree.triangle >= 0]
    assert sorted(leaves.tolist()) == list(range(len(tree.corners)))
    for node, (left, right) in enumerate(tree.children.tolist()):
        for child in (left, right) if left >= 0 else ():
            assert (np.abs(tree.centre[child] - tree.centre[node]) + tree.half[child] <= tree.half[node] + 1e-5).all()  # rounded
        if left < 0:
            corners = tree.corners[tree.triangle[node]]
            assert (np.abs(corners - tree.centre[node]) <= tree.half[node] + 1e-12).all()


def test_the_distance_of_two_triangles_is_that_of_fcl() -> None:
    rng = np.random.default_rng(8)
    p, q = rng.uniform(-1, 1, (300, 3, 3)), rng.uniform(-1, 1, (300, 3, 3)) + rng.uniform(-3, 3, (300, 1, 3))
    found, direction = shortest_between(p, q)
    for one, other, distance, u in zip(p, q, found, direction, strict=True):
        exact = surface_distance(Surface(one[None]), Surface(other[None]), np.eye(4))
        if exact > 0:  # triangles that pierce one another are no business of it
            assert distance == pytest.approx(exact, abs=1e-6)
            assert (other @ u).min() - (one @ u).max() == pytest.approx(exact, abs=1e-6)


@pytest.mark.parametrize("cone", [0.3, 1.0])
def test_what_lean_and_radius_keep_apart_is_apart_wherever_a_ball_swings(cone: float) -> None:
    rng = np.random.default_rng(5)
    knuckle = joint("s", "ball", "a", "b", cone=cone)
    a, b = (rng.normal(size=(150, 1, 3)) * 12 + rng.uniform(-1.5, 1.5, (150, 3, 3)) for _ in range(2))
    core, needed = Core(np.eye(4), 3), 0.4
    of_a = [np.concatenate(ends, axis=1) for ends in zip(outline(core, a), leaning(core, a, 0.0, 0.0), strict=True)]
    of_b = [np.concatenate(ends, axis=1) for ends in zip(outline(core, b), leaning(core, b, cone, needed), strict=True)]
    met = meeting((of_a[0], of_a[1]), (of_b[0], of_b[1]), np.array([needed, 0.0]))
    assert met.any()
    for row in np.flatnonzero(~met):
        for _ in range(6):
            angle, swing = rng.uniform(-math.pi, math.pi), cone * math.sqrt(rng.random())
            T = motion_matrix(knuckle, [swing * math.cos(angle), swing * math.sin(angle), rng.uniform(-3, 3)])
            assert surface_distance(Surface(a[row][None]), Surface(b), T) > needed


def test_swing_and_twist_are_found_again_from_a_quaternion() -> None:
    rng = np.random.default_rng(2)
    knuckle = joint("s", "ball", "a", "b", cone=3.0)
    for swing in (0.0, 1e-10, 0.3, 2.9):
        values = [swing * 0.6, swing * 0.8, rng.uniform(-3, 3)]
        quaternion = SE3.from_matrix(motion_matrix(knuckle, values)).quaternion
        np.testing.assert_allclose(motion_matrix(knuckle, swing_and_twist(quaternion)), motion_matrix(knuckle, values), atol=1e-9)


# --- the checker


@pytest.fixture(scope="module")
def honest() -> Certificate:
    meshes = hinge_with_stop(0.0)
    meshes["lid"] = box(20, 4, 4).transformed(at(40, 0, 30))
    joints = [
        joint("hinge", "revolute", "base", "arm", lower=(-1.0,), upper=(1.0,)),
        joint("lift", "slider", "arm", "lid", lower=(0.0,), upper=(30.0,)),
    ]
    certificate = proven(meshes, joints, deflection=0.01)
    assert certificate.ok
    return certificate


def arrays_of(mesh: TriMesh) -> dict[str, Any]:
    return {"vertices": mesh.vertices, "triangles": mesh.triangles}


def of_hinge(document: dict[str, Any]) -> dict[str, Any]:
    """Return the claim on the arm and its base, which the hinge connects."""
    claim: dict[str, Any] = next(claim for claim in document["claims"] if set(claim["parts"]) == {"base", "arm"})
    return claim


def widen_interval(document: dict[str, Any]) -> None:
    of_hinge(document)["vary"]["hinge"] = [-1.0, 3.1]  # beyond the stop


def enlarge_distance(document: dict[str, Any]) -> None:
    of_hinge(document)["clear_mm"] += 0.2


def drop_pair(document: dict[str, Any]) -> None:
    document["claims"] = [claim for claim in document["claims"] if set(claim["parts"]) != {"base", "lid"}]


def swap_mesh(document: dict[str, Any]) -> None:
    document["meshes"]["lid"]["sha256"] = document["meshes"]["arm"]["sha256"]


def narrow_range(document: dict[str, Any]) -> None:
    for claim in document["claims"]:
        if "hinge" in claim["vary"]:
            claim["vary"]["hinge"] = [-0.9, 1.0]


def claim_less(document: dict[str, Any]) -> None:
    of_hinge(document)["clear_mm"] -= 0.01


def begin_elsewhere(document: dict[str, Any]) -> None:
    document["ok"] = False  # a part of the range may then be claimed, but what is inside another is looked for at rest only
    of_hinge(document)["vary"]["hinge"] = [0.5, 1.0]


def allow_more(document: dict[str, Any]) -> None:
    for claim in document["claims"]:
        claim["shrink_mm"] *= 3


def allow_nothing(document: dict[str, Any]) -> None:
    of_hinge(document)["shrink_mm"] = 0.0


def forget_deflection(document: dict[str, Any]) -> None:
    for entry in document["meshes"].values():
        entry["deflection_mm"] = 5.0


def move_frame(document: dict[str, Any]) -> None:
    document["mechanism"]["joints"][1]["parent_frame"][2][3] = -31.0


def hold_instead(document: dict[str, Any]) -> None:
    for claim in document["claims"]:
        claim["vary"] = {}


def leave_out_a_joint(document: dict[str, Any]) -> None:
    for claim in document["claims"]:
        if len(claim["vary"]) > 1:
            del claim["vary"]["lift"]


def widen_limits(document: dict[str, Any]) -> None:
    document["mechanism"]["joints"][0]["freedoms"][0]["range"] = [-1.2, 1.0]


LIES = [
    widen_interval, enlarge_distance, drop_pair, swap_mesh, narrow_range, begin_elsewhere, claim_less, allow_more, allow_nothing, forget_deflection,
    move_frame, hold_instead, leave_out_a_joint, widen_limits,
]  # fmt: skip


def number_of_hinge(certificate: Certificate) -> int:
    return int(certificate.to_json()["claims"].index(of_hinge(certificate.to_json())))


def end_early(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.codes"] = proof[f"{at}.codes"][:-1]


def settle_at_once(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.codes"] = np.array([0])


def leave_rows_out(proof: dict[str, Any], at: int) -> None:
    codes = proof[f"{at}.codes"]
    codes[codes >= 0] = -4  # said to lie outside a cone


def cut_what_is_whole(proof: dict[str, Any], at: int) -> None:
    codes = proof[f"{at}.codes"]
    codes[np.flatnonzero(codes >= 0)[-1]] = -3


def turn_the_directions(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.along"] = -proof[f"{at}.along"]


def forget_the_directions(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.along"][:] = 0.0


def undefine_the_directions(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.along"][:] = np.nan


def leave_out_a_triangle(proof: dict[str, Any], at: int) -> None:
    order = proof[str(proof[f"{at}.uses"][1])]
    order[0] = order[1]


def forget_a_triangle(proof: dict[str, Any], at: int) -> None:
    name = str(proof[f"{at}.uses"][2])
    proof[name] = proof[name][1:]


def move_vertices_further(proof: dict[str, Any], at: int) -> None:
    proof[str(proof[f"{at}.uses"][0])][0] += 1.0


def say_that_it_only_leans(proof: dict[str, Any], at: int) -> None:
    codes = proof[f"{at}.codes"]
    codes[codes >= 0] = -6


def cut_beyond_the_range(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.at"] = proof[f"{at}.at"] + 10.0


def halve_fewer_boxes(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.cuts"][0] = -1


def measure_from_elsewhere(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.about"][0] += [100.0, 0.0, 0.0]  # radii about an axis that does not stand


def measure_along_the_axis(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.about"][1] = 0.0  # radii about a point on the axis, which a turn keeps: not all are apart by them


def stretch_the_axis(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.about"][1] *= 2.0  # what is across it would count three times


def leave_a_tree_out(proof: dict[str, Any], at: int) -> None:
    proof[f"{at}.parts_a"] = proof[f"{at}.parts_a"][:-1]


def call_everything_round(proof: dict[str, Any], at: int) -> None:
    codes = proof[f"{at}.codes"]
    codes[codes >= 0] = -5


TAMPERED = [
    end_early, settle_at_once, leave_rows_out, cut_what_is_whole, turn_the_directions, forget_the_directions, undefine_the_directions,
    leave_out_a_triangle, forget_a_triangle, move_vertices_further, say_that_it_only_leans, measure_from_elsewhere, measure_along_the_axis,
    stretch_the_axis, leave_a_tree_out, call_everything_round,
]  # fmt: skip


def assert_refuted(certificate: Certificate, tamper: Callable[[dict[str, Any], int], None], at: int) -> None:
    proof = proof_of(certificate)
    assert verified(certificate.to_json(), certificate, **{PROOF: saved(**proof)}) == []
    tamper(proof, at)
    assert verified(certificate.to_json(), certificate, **{PROOF: saved(**proof)})


@pytest.mark.parametrize("tamper", TAMPERED, ids=lambda tamper: tamper.__name__)
def test_a_proof_that_was_tampered_with_is_refuted(honest: Certificate, tamper: Callable[[dict[str, Any], int], None]) -> None:
    assert_refuted(honest, tamper, number_of_hinge(honest))


@pytest.mark.parametrize("tamper", [cut_beyond_the_range, halve_fewer_boxes, end_early, leave_rows_out], ids=lambda tamper: tamper.__name__)
def test_a_proof_in_many_boxes_that_was_tampered_with_is_refuted(tamper: Callable[[dict[str, Any], int], None]) -> None:
    turn = joint("turn", "revolute", "post", "bar", lower=(0.0,), upper=(0.7,))
    assert_refuted(proven(bar_and_post()[0], [turn]), tamper, 0)


@pytest.mark.parametrize("kind", ["uses", "parts_a", "parts_b", "about", "cuts", "at", "codes", "along", "of_a"])
def test_a_proof_that_lacks_something_is_refuted(honest: Certificate, kind: str) -> None:
    proof = {key: array for key, array in proof_of(honest).items() if key != f"{number_of_hinge(honest)}.{kind}"}
    assert verified(honest.to_json(), honest, **{PROOF: saved(**proof)})


def test_an_honest_certificate_is_accepted_and_holds_every_kind_of_claim(honest: Certificate) -> None:
    assert refutations(honest) == []
    assert {bool(claim.shrink) for claim in honest.claims} == {True, False}
    assert {len(claim.vary) for claim in honest.claims} >= {1, 2}


@pytest.mark.parametrize("lie", LIES, ids=lambda lie: lie.__name__)
def test_a_planted_lie_is_refuted(honest: Certificate, lie: Callable[[dict[str, Any]], None]) -> None:
    assert refutations(honest, lie)


def test_a_swapped_mesh_file_is_refuted(honest: Certificate, tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    for name, content in honest.mesh_files().items():
        (tmp_path / "meshes" / name).write_bytes(content)
    file = tmp_path / "certificate.json"
    file.write_text(json.dumps(honest.to_json()))
    assert verify_file(file, tmp_path / "meshes") == []
    (tmp_path / "meshes" / "lid.npz").write_bytes(honest.mesh_files()["arm.npz"])
    assert verify_file(file, tmp_path / "meshes") == ["mesh of lid is missing or different"]


def test_a_part_that_the_certificate_leaves_out_is_noticed(honest: Certificate, tmp_path: Path) -> None:
    for name, content in honest.mesh_files().items():
        (tmp_path / name).write_bytes(content)
    document = json.loads(json.dumps(honest.to_json()))
    del document["meshes"]["lid"]
    document["claims"] = [claim for claim in document["claims"] if "lid" not in claim["parts"]]
    (tmp_path / "certificate.json").write_text(json.dumps(document))
    assert verify_file(tmp_path / "certificate.json", tmp_path) == ["it omits lid"]


def test_a_claim_on_a_part_inside_another_is_refuted() -> None:
    # the surfaces are apart all the way round, so distances alone would prove it
    meshes = {"case": sphere(50, 24), "core": sphere(5, 12)}
    mechanism = Mechanism(("case", "core"), "case", [joint("spin", "revolute", "case", "core")])
    outside = certify({"case": sphere(50, 24), "core": sphere(5, 12).transformed(at(80))}, mechanism)
    assert outside.ok
    document = json.loads(json.dumps(outside.to_json()))
    document["meshes"]["core"]["sha256"] = meshes["core"].digest
    assert any("inside" in reason for reason in verified(document, outside, core=saved(**arrays_of(meshes["core"]))))


def test_the_certificate_is_the_same_bytes_twice(honest: Certificate) -> None:
    again = certify(honest.meshes, honest.mechanism, deflection=honest.deflections)
    assert json.dumps(again.to_json()) == json.dumps(honest.to_json())
    assert again.mesh_files() == honest.mesh_files()


@pytest.mark.parametrize("angle", [np.pi, -np.pi / 2, 2 * np.pi])
@pytest.mark.parametrize("turn", [SE3.rot_x, SE3.rot_y])
def test_a_wall_along_an_axis_is_for_the_checker_as_far_from_it_as_its_edges(turn: Callable[[float], SE3], angle: float) -> None:
    """Seen along the axis each triangle is a line, which rounding of a turned frame may take for a triangle with the axis before it."""
    rng = np.random.default_rng(0)
    away, sides, along = rng.uniform(1, 10, (2000, 1)), rng.uniform(-100, 100, (2000, 3)), rng.uniform(-100, 100, (2000, 3))
    ends = np.sort(sides, axis=1)
    axis = turn(angle).rotation.T @ np.round(turn(angle).rotation)[:, 2]  # z, up to rounding
    walls = np.stack([sides, np.broadcast_to(away, sides.shape), along], axis=2)

    least, most = verifier.radii(walls @ verifier.plane(axis))

    nearest = np.clip(0.0, ends[:, 0], ends[:, 2])
    np.testing.assert_allclose(least, np.hypot(away[:, 0], nearest), rtol=0, atol=1e-9)
    np.testing.assert_allclose(most, np.hypot(away[:, 0], np.abs(ends).max(axis=1)), rtol=0, atol=1e-9)


MOST_LINES = 640  # of code: what a person can read


@pytest.mark.parametrize(
    ("module", "most"), [(verifier, MOST_LINES), (verifier_files, MOST_LINES // 8), (verifier_tolerance, MOST_LINES // 8)]
)
def test_the_checker_is_short_and_knows_only_numpy(module: ModuleType, most: int) -> None:
    assert module.__file__ is not None
    source = Path(module.__file__).read_text()
    tree = ast.parse(source)
    imported = {alias.name.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    imported |= {str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    imported -= {verifier_files.__name__, verifier_tolerance.__name__} if module is verifier else set()
    assert imported <= sys.stdlib_module_names | {"numpy", "collections.abc"}
    documentation: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node) is not None:
            documentation.update(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
    silent = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER)
    lines = {
        line
        for token in tokenize.generate_tokens(io.StringIO(source).readline)
        if token.type not in silent
        for line in range(token.start[0], token.end[0] + 1)
    }
    assert len(lines - documentation) <= most


def test_speeds_through_a_slider_that_does_not_rest_at_zero_are_accepted() -> None:
    # a weight on a pendulum: it slides along the rod, away from the pivot, and rests far out
    along = SE3.from_axes([0.0, 0, 20], [0.0, 0, 1], [1.0, 0, 0])
    joints = [
        joint("swing", "revolute", "case", "rod", at_parent=SE3.from_axes([0.0, 0, 0], [0.0, 1, 0], [1.0, 0, 0]),
              at_child=SE3.from_axes([0.0, 0, 0], [0.0, 1, 0], [1.0, 0, 0]), lower=(-0.4,), upper=(0.4,)),
        joint("tempo", "slider", "rod", "weight", at_parent=along, at_child=SE3.from_axes([0.0, 0, 60], [0.0, 0, 1], [1.0, 0, 0]),
              lower=(-10.0,), upper=(60.0,), rest=(40.0,)),
    ]  # fmt: skip
    meshes = {
        "case": box(4, 40, 160).transformed(at(75, 0, 40)),
        "rod": box(4, 4, 150, center=False).transformed(at(-2, -2, 0)),
        "weight": merged([tube(4, 10, 12, 24).transformed(at(z=60)), box(1, 1, 1).transformed(at(13, 0, 60))]),
    }
    certificate = proven(meshes, joints)
    assert certificate.ok
    assert any(len(claim.vary) == 2 for claim in certificate.claims)
    assert refutations(certificate) == []


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"3",
        b"[" * 100_000,
        b"\xff",
        b"{}",
        b'{"meshes": 3}',
        b'{"meshes": {"../secret": {}}}',
        b'{"meshes": {"lid": {}}}',
        b'{"meshes": {}}',
        b'{"meshes": {}, "mechanism": null}',
    ],
)
def test_a_file_that_is_no_certificate_is_refuted(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "certificate.json").write_bytes(content)
    assert verify_file(tmp_path / "certificate.json", tmp_path)


def zipped(**changed: int) -> bytes:
    """A mesh file with numbers in its table changed: the method of compression, the version that is needed, the flags."""
    stream = io.BytesIO()
    np.savez(stream, vertices=np.zeros((3, 3)), triangles=np.zeros((1, 3), dtype=np.int32))
    content = bytearray(stream.getvalue())
    entry = content.index(b"PK\x01\x02")
    for name, value in changed.items():
        at = entry + {"version": 6, "flags": 8, "method": 10}[name]
        content[at : at + 2] = value.to_bytes(2, "little")
    return bytes(content)


@pytest.mark.parametrize(
    "content",
    [b"", b"PK\x05\x06" + bytes(18), b"\x93NUMPY\x01\x00", b"not a zip", zipped(method=99), zipped(version=123), zipped(flags=1)],
)
def test_a_mesh_that_is_none_refutes_its_certificate(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "lid.npz").write_bytes(content)
    (tmp_path / "certificate.json").write_bytes(b'{"meshes": {"lid": {"sha256": ""}}}')
    (fault,) = verify_file(tmp_path / "certificate.json", tmp_path)
    assert fault.startswith("it cannot be read")


def packed(**members: bytes) -> bytes:
    """A compressed archive with anything as its arrays."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(f"{name}.npy", content)
    return stream.getvalue()


def array(kind: str, count: int, stated: int | None = None) -> bytes:
    """An array of zeros, with the number of elements that its header states."""
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": kind, "fortran_order": False, "shape": (stated or count,)})
    return stream.getvalue() + bytes(count * np.dtype(kind).itemsize)


def understated(content: bytes) -> bytes:
    """The same archive, which states that its first member has 100 bytes."""
    entry = content.index(b"PK\x01\x02") + 24
    return content[:entry] + (100).to_bytes(4, "little") + content[entry + 4 :]


MANY = 20_000_000  # bytes, which the bounds of this test do not admit
LID = b'{"meshes": {"lid": {}}}'
BOMBS: dict[str, tuple[bytes, dict[str, bytes]]] = {
    "long text": (b" " * MANY, {}),
    "values": (b'{"meshes": [' + b"[]," * 1_000_000 + b"1]}", {}),
    "packed": (LID, {"lid": packed(a=array("<f8", MANY // 8))}),
    "short numbers": (LID, {"lid": packed(a=array("|i1", 900_000))}),
    "several arrays": (LID, {"lid": packed(**{f"a{k}": array("<f8", 100_000) for k in range(8)})}),
    "several files": (
        b'{"meshes": {"a": {}, "b": {}, "c": {}, "d": {}}}',
        {name: packed(x=array("<f8", 50_000)) for name in ("a", "b", "c", "d", PROOF)},
    ),
    "names": (LID, {"lid": b"PK\x01\x02" * 10_000}),
}
PACKED_LIES: dict[str, tuple[bytes, dict[str, bytes]]] = {
    "a size that is not so": (LID, {"lid": understated(packed(a=array("<f8", MANY // 8)))}),
    "no array": (LID, {"lid": understated(packed(a=bytes(MANY)))}),
    "a header without end": (LID, {"lid": understated(packed(a=b"\x93NUMPY\x02\x00" + b"\xff\xff\xff\x7f" + bytes(MANY)))}),
    "more elements than there are": (LID, {"lid": packed(a=array("<f8", 10, 10**9))}),
}


@pytest.mark.parametrize(
    ("certificate", "files", "is_told"),
    [(*each, True) for each in BOMBS.values()] + [(*each, False) for each in PACKED_LIES.values()],
    ids=[*BOMBS, *PACKED_LIES],
)
def test_whoever_calls_the_checker_it_takes_bounded_memory(
    certificate: bytes, files: dict[str, bytes], is_told: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, most in {"BYTES": 2_000_000, "TEXT": 4_000_000, "VALUES": 1_000_000, "ARRAYS": 1000, "ROOM": 2_000_000}.items():
        monkeypatch.setattr(verifier_files, name, most)
    (tmp_path / "certificate.json").write_bytes(certificate)
    for name, content in files.items():
        (tmp_path / f"{name}.npz").write_bytes(content)
    tracemalloc.start()
    try:
        (fault,) = verify_file(tmp_path / "certificate.json", tmp_path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert fault.startswith(verifier_files.UNREAD if is_told else ("it cannot be read", "an array is not whole")), fault
    assert peak < 12_000_000


def test_the_work_of_the_checker_grows_as_the_claims_do() -> None:
    """Blocks on rails of their own: n (n + 1) / 2 pairs, each with a claim."""

    def work(number: int) -> float:
        meshes = {f"b{i}": box(1, 1, 1) for i in range(number + 1)}
        rails = [
            joint(f"j{i}", "slider", "b0", f"b{i}", at_parent=at(5.0 * i), lower=(0.0,), upper=(2.0,), rest=(0.0,))
            for i in range(1, number + 1)
        ]
        certificate = proven(meshes, rails, pairs=False)
        return bytecodes_of(lambda: check(certificate.refutation)) / len(certificate.claims)

    def check(refutation: Callable[[], str | None]) -> None:
        assert refutation() is None

    work(2)
    few, many = work(5), work(20)
    assert many <= 1.1 * few
