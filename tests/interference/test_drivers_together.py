"""Several drivers: periods of endless ones, each two at once, joints above a linkage; random linkages with planted posts."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates import certificate as certificates
from articad.certificates.certificate import Certificate, certify
from articad.certificates.verifier import PROOF
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, joint, proof_of, saved, verified

HEIGHT = 6.0
FINGER = 0.5  # rad: to either side
ENDLESS: dict[str, Any] = {"lower": (-math.inf,), "upper": (math.inf,)}
Meshes = dict[str, TriMesh]


def pinned(name: str, parent: str, child: str, place: Sequence[float] | np.ndarray, *, driver: bool = False, **options: Any) -> Joint:
    """Return a hinge about z; all parts' frames are the ground's at rest."""
    hinge = joint(name, "revolute", parent, child, at_parent=at(*place), at_child=at(*place), **options)
    return replace(hinge, driver=driver)


def mechanism_of(meshes: Mapping[str, TriMesh], joints: list[Joint], couplings: tuple[Coupling, ...] = ()) -> Mechanism:
    parts = dict.fromkeys(part for one in joints for part in (one.parent, one.child))
    return Mechanism(tuple(parts), "base", joints, couplings)


def volume(mechanism: Mechanism, meshes: Mapping[str, TriMesh], pair: tuple[str, str], q: Sequence[float]) -> float:
    """Return what two parts share, as manifold3d measures it [mm³]."""
    poses = dict(zip(mechanism.parts, mechanism.poses(np.array(q)), strict=True))
    solids = []
    for name in pair:
        mesh = m3.Mesh64(np.array(meshes[name].vertices, dtype=np.float64), np.array(meshes[name].triangles, dtype=np.uint64))
        solids.append(m3.Manifold(mesh).transform(poses[name].matrix[:3]))
    return float((solids[0] ^ solids[1]).volume())


def stated(certificate: Certificate) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(json.dumps(certificate.to_json()))
    return document


# --- ranges of endless drivers


def geared(ratio: float, **fast: Any) -> tuple[Meshes, Mechanism]:
    """An arm of 70 mm that a gear drives, and a post 60 mm from its axis, opposite to it."""
    joints = [pinned("fast", "base", "wheel", (0, 100, 0), **(fast or ENDLESS)), pinned("slow", "base", "arm", (0, 0, 0), **ENDLESS)]
    meshes = {
        "base": box(4, 4, 60).transformed(at(-60)),
        "wheel": cylinder(5, 10).transformed(at(0, 100)),
        "arm": box(70, 6, 6).transformed(at(35)),
    }
    return meshes, mechanism_of(meshes, joints, (Coupling(name="gear", kind="gear", a="fast", b="slow", ratio=ratio, offset=0.0),))


@pytest.mark.parametrize("ratio", [-0.25, 1 / 3, 0.4, math.sqrt(2) / 5])
def test_a_slow_arm_that_an_endless_wheel_drives_meets_a_post_behind_it(ratio: float) -> None:
    meshes, mechanism = geared(ratio)
    certificate = certify(meshes, mechanism)
    assert not certificate.ok
    assert any(set(finding.parts) == {"base", "arm"} for finding in certificate.findings.errors)


@pytest.mark.parametrize("ratio", [-0.25, 0.4, math.sqrt(2) / 5])
def test_a_slow_arm_that_keeps_clear_is_certified_over_all_its_turns(ratio: float) -> None:
    meshes, mechanism = geared(ratio)
    meshes["base"] = box(4, 4, 60).transformed(at(-80))
    certificate = certify(meshes, mechanism)
    assert certificate.ok, str(certificate.findings)
    assert verified(stated(certificate), certificate) == []


def paddles(ratio: float) -> Certificate:
    """Two paddles in one plane that miss each other only because a gear turns them together."""
    joints = [pinned("one", "base", "left", (0, 0, 0), **ENDLESS), pinned("two", "base", "right", (50, 0, 0), **ENDLESS)]
    meshes = {"base": box(80, 8, 4).transformed(at(25, 0, -10)), "left": box(56, 4, 4), "right": box(4, 56, 4).transformed(at(50))}
    tie = Coupling(name="mesh", kind="gear", a="one", b="two", ratio=ratio, offset=0.0)
    return certify(meshes, mechanism_of(meshes, joints, (tie,)))


def test_a_range_that_does_not_bring_back_what_follows_is_refuted() -> None:
    certificate = paddles(-1.0)
    assert certificate.ok
    document = stated(certificate)
    document["mechanism"]["couplings"][0]["ratio"] = -1 / 3
    assert any("do not return" in reason or "cannot be" in reason for reason in verified(document, certificate))


def test_paddles_geared_by_an_irrational_ratio_meet_some_day() -> None:
    assert not paddles(-math.sqrt(2)).ok


def test_a_joint_with_one_limit_is_proven_over_a_whole_turn_from_it() -> None:
    arm = box(70, 6, 6).transformed(at(35))
    post = box(4, 4, 60).transformed(at(60 * math.cos(1.5), 60 * math.sin(1.5)))
    turn = pinned("turn", "base", "arm", (0, 0, 0), lower=(-math.inf,), upper=(1.0,))
    assert not certify({"base": post, "arm": arm}, mechanism_of({}, [turn])).ok
    free = {"base": post.transformed(at(30, 30)), "arm": arm}
    certificate = certify(free, mechanism_of({}, [turn]))
    assert certificate.ok
    (claim,) = certificate.claims
    assert claim.vary["turn"] == pytest.approx((1.0 - 2 * math.pi, 1.0))
    document = stated(certificate)
    document["claims"][0]["vary"]["turn"][0] += 0.5
    document["mechanism"]["joints"][0]["freedoms"][0]["range"][0] += 0.5
    assert any("whole turn" in reason for reason in verified(document, certificate))


def test_a_screw_without_limits_is_not_covered_by_a_turn() -> None:
    meshes = {"base": box(10, 10, 10).transformed(at(0, 0, 60)), "nut": box(10, 10, 10)}
    certificate = certify(meshes, mechanism_of({}, [joint("screw", "screw", "base", "nut", lead=5.0, **ENDLESS)]))
    assert certificate.findings.codes == ("E_NOT_CHECKED",)


# --- two linkages


def finger(name: str, base: str, foot: Sequence[float], side: float) -> list[Joint]:
    """Return the joints of a parallelogram on a base: two bars of 40 mm upwards, and a tip that stays level."""
    near, far, up = np.array([*foot, 0.0]), np.array([foot[0] - 10 * side, foot[1], 0.0]), np.array([0.0, 40.0, 0.0])
    return [
        pinned(f"{name}a", base, f"{name}1", near, lower=(-FINGER,), upper=(FINGER,)),
        pinned(f"{name}b", f"{name}1", f"{name}t", near + up, **ENDLESS),
        pinned(f"{name}c", f"{name}t", f"{name}2", far + up, **ENDLESS),
        pinned(f"{name}d", base, f"{name}2", far, **ENDLESS),
    ]


def gripper(reach: float, *, swings: bool = False) -> tuple[Meshes, Mechanism]:
    """Two fingers whose tips reach so far towards each other; on a base that swings, if that is wished."""
    base = "table" if swings else "base"
    joints = [*finger("L", base, (-40, 0), 1.0), *finger("R", base, (40, 0), -1.0)]
    if swings:
        joints.insert(0, pinned("swing", "base", "table", (0, 0, 0), lower=(-1.0,), upper=(1.0,)))
    meshes = {"Lt": box(reach, 10, HEIGHT).transformed(at(-30, 45)), "Rt": box(reach, 10, HEIGHT).transformed(at(30, 45))}
    return meshes, mechanism_of(meshes, joints)


def coordinates(mechanism: Mechanism, **values: float) -> list[float]:
    return [values.get(driver.name, 0.0) for driver in mechanism.drivers]


@pytest.mark.parametrize("swings", [False, True], ids=["on the ground", "on a table that swings"])
def test_fingers_that_meet_only_when_both_close_are_refused(swings: bool) -> None:
    meshes, mechanism = gripper(30.0, swings=swings)
    closed = 40 * math.sin(FINGER)
    assert 30 - closed < 2 * closed
    for one in ({"La": -FINGER}, {"Ra": FINGER}):
        assert volume(mechanism, meshes, ("Lt", "Rt"), coordinates(mechanism, **one)) == 0
    assert volume(mechanism, meshes, ("Lt", "Rt"), coordinates(mechanism, La=-FINGER, Ra=FINGER)) > 10
    certificate = certify(meshes, mechanism)
    (finding,) = certificate.findings.of("E_MOTION_COLLISION")
    assert not certificate.ok
    assert finding.pose is not None
    assert {"La", "Ra"} <= set(finding.pose)


@pytest.fixture(scope="module")
def apart() -> Certificate:
    """Fingers that keep 4 mm apart when both are closed: proven along both drivers, for the bars could turn freely."""
    meshes, mechanism = gripper(18.0)
    certificate = certify(meshes, mechanism)
    assert certificate.ok, str(certificate.findings)
    return certificate


def test_fingers_that_keep_apart_are_certified_over_both_drivers_at_once(apart: Certificate) -> None:
    assert any({"La", "Ra"} <= set(claim.vary) for claim in apart.claims)
    assert "all of these joints move at once" in apart.to_json()["covers"]
    assert verified(stated(apart), apart) == []


def drop_the_claim_of_both(document: dict[str, Any]) -> None:
    document["claims"] = [claim for claim in document["claims"] if not {"La", "Ra"} <= set(claim["vary"])]


def hold_one_driver(document: dict[str, Any]) -> None:
    for claim in document["claims"]:
        claim["vary"].pop("Ra", None)


def call_the_other_a_follower(document: dict[str, Any]) -> None:
    document["drivers"].remove("Ra")
    document["asked"] = [name for name in document["asked"] if not name.startswith("R")]
    drop_the_claim_of_both(document)


@pytest.mark.parametrize("lie", [drop_the_claim_of_both, hold_one_driver], ids=lambda lie: lie.__name__)
def test_a_certificate_without_both_drivers_at_once_is_refuted(apart: Certificate, lie: Callable[[dict[str, Any]], None]) -> None:
    document = stated(apart)
    lie(document)
    assert verified(document, apart)


def test_a_group_that_nothing_drives_is_no_rigid_one(apart: Certificate) -> None:
    document = stated(apart)
    document["drivers"] = []
    document["claims"] = []
    assert any("nothing drives" in reason for reason in verified(document, apart))


# --- two drivers of one group


APEX = (50.0, 60 + math.sqrt(90**2 - 50**2), 0.0)
TURN, WIDE = 0.2, 0.5  # rad: one box holds what follows over a quarter of the former, several are needed over one of the latter


def five_bar(post: TriMesh, turn: float = TURN) -> tuple[Meshes, Mechanism]:
    joints = [
        pinned("a1", "base", "l1", (0, 0, 0), lower=(-turn,), upper=(turn,), driver=True),
        pinned("b", "l1", "l2", (0, 60, 0), **ENDLESS),
        pinned("a2", "base", "r1", (100, 0, 0), lower=(-turn,), upper=(turn,), driver=True),
        pinned("d", "r1", "r2", (100, 60, 0), **ENDLESS),
        pinned("c", "l2", "r2", APEX, **ENDLESS),
    ]
    meshes = {"base": post, "l2": cylinder(2, 10, 12).transformed(at(*APEX))}
    return meshes, mechanism_of(meshes, joints)


@pytest.fixture(scope="module")
def beside() -> Certificate:
    """A post below the region in which the tip of a five-bar moves."""
    meshes, mechanism = five_bar(box(60, 6, 10).transformed(at(50, 70)), WIDE)
    certificate = certify(meshes, mechanism)
    assert certificate.ok, str(certificate.findings)
    return certificate


def test_a_five_bar_is_certified_over_both_of_its_drivers(beside: Certificate) -> None:
    assert verified(stated(beside), beside) == []


def test_a_post_in_a_corner_of_a_five_bar_is_found() -> None:
    meshes, mechanism = five_bar(box(1, 1, 1))
    corner = [TURN, -TURN]
    there = dict(zip(mechanism.parts, mechanism.poses(np.array(corner)), strict=True))["l2"].apply(np.array(APEX))
    meshes, mechanism = five_bar(box(3, 3, 10).transformed(SE3.from_translation(there)))
    for single in ([TURN, 0.0], [0.0, -TURN]):
        assert volume(mechanism, meshes, ("base", "l2"), single) == 0
    certificate = certify(meshes, mechanism)
    assert not certificate.ok
    assert certificate.findings.of("E_MOTION_COLLISION")


def six_bar(turn: float) -> tuple[Meshes, Mechanism]:
    """A hexagon of six pins with three drivers, and a wheel on its far side that stays above a post."""
    corners = [(60 * math.cos(a), 60 * math.sin(a), 0.0) for a in np.radians([240, 180, 120, 60, 0, 300])]
    links = [("base", "l1"), ("l1", "l2"), ("l2", "l3"), ("l3", "l4"), ("l4", "l5"), ("base", "l5")]
    limits: dict[str, Any] = {"lower": (-turn,), "upper": (turn,), "driver": True}
    joints = [
        pinned(f"p{k}", parent, child, corner, **(limits if k in (0, 1, 5) else ENDLESS))
        for k, ((parent, child), corner) in enumerate(zip(links, corners, strict=True))
    ]
    meshes = {"base": box(10, 10, 10).transformed(at(0, 28)), "l3": cylinder(2, 10, 12).transformed(at(0, 52, 0))}
    return meshes, mechanism_of(meshes, joints)


def test_three_drivers_of_one_group_move_at_once_where_few_boxes_hold_them() -> None:
    meshes, mechanism = six_bar(0.04)
    certificate = certify(meshes, mechanism)
    assert certificate.ok, str(certificate.findings)
    (claim,) = (claim for claim in certificate.claims if set(claim.parts) == {"base", "l3"})
    assert set(claim.vary) == {"p0", "p1", "p5"}
    assert "all of these joints move at once" in certificate.to_json()["covers"]
    assert verified(stated(certificate), certificate) == []


def test_a_certificate_names_the_pairs_that_three_drivers_at_once_are_not_proven_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(certificates, "MOST_TOGETHER", 2)
    certificate = certify(*six_bar(0.04))
    assert certificate.ok, str(certificate.findings)
    assert all(len(claim.vary) < 3 for claim in certificate.claims)
    assert "three or more at once: not covered for base/l3" in certificate.to_json()["covers"]


def tampered(certificate: Certificate, change: Callable[[dict[str, Any]], object]) -> list[str]:
    proof = proof_of(certificate)
    change(proof)
    return verified(stated(certificate), certificate, **{PROOF: saved(**proof)})


def along(proof: dict[str, Any], what: str) -> str:
    """Return the key of an array of the two drivers' pieces."""
    (key,) = (key for key in proof if "+" in key and key.endswith(f".{what}"))
    return key


def leave_out_a_box(proof: dict[str, Any]) -> None:
    for what in ("ends", "values", "wide", "other"):
        proof[along(proof, what)] = np.delete(proof[along(proof, what)], 1, axis=0)


def part_outside(proof: dict[str, Any]) -> None:
    proof[along(proof, "at")] += 10.0


def narrow_the_tubes(proof: dict[str, Any]) -> None:
    proof[along(proof, "wide")] *= 1e-3


def move_a_box(proof: dict[str, Any]) -> None:
    proof[along(proof, "values")][0, 2] += 0.05


def begin_elsewhere(proof: dict[str, Any]) -> None:
    proof[along(proof, "other")][:] = 0


def reach_over_rest(proof: dict[str, Any]) -> None:
    proof[along(proof, "ends")][0, 0] = [-0.01, 0.01]


@pytest.mark.parametrize(
    "change",
    [leave_out_a_box, part_outside, narrow_the_tubes, move_a_box, begin_elsewhere, reach_over_rest],
    ids=lambda change: change.__name__,
)
def test_a_tampered_box_of_two_drivers_is_refuted(beside: Certificate, change: Callable[[dict[str, Any]], object]) -> None:
    assert any("+" in key for key in proof_of(beside))
    assert tampered(beside, change)


def test_a_pair_that_another_driver_of_its_group_does_not_move_is_accepted(beside: Certificate) -> None:
    """A hub and its crank: the crank is a driver, and stands while the other driver moves."""
    meshes, mechanism = five_bar(cylinder(4, 10, 12))
    meshes["l1"] = box(6, 40, 4).transformed(at(0, 30, 20))
    meshes["base"] = box(40, 6, 4).transformed(at(-40, 0, 20))
    certificate = certify(meshes, mechanism, pairs=False)
    assert certificate.ok, str(certificate.findings)
    assert verified(stated(certificate), certificate) == []


# --- a joint above a linkage


def test_a_linkage_on_a_swinging_base_is_proven_with_the_swing() -> None:
    meshes, mechanism = gripper(18.0, swings=True)
    meshes["base"] = box(10, 10, HEIGHT).transformed(at(0, -80))
    certificate = certify(meshes, mechanism)
    assert certificate.ok, str(certificate.findings)
    assert any({"swing", "La"} <= set(claim.vary) for claim in certificate.claims)
    assert verified(stated(certificate), certificate) == []


# --- what nothing drives


def truss(last: float) -> tuple[Meshes, Mechanism]:
    joints = [
        pinned("a", "base", "one", (0, 0, 0), **ENDLESS),
        pinned("b", "base", "two", (60, 0, 0), **ENDLESS),
        pinned("c", "one", "two", (30, last, 0), **ENDLESS),
    ]
    meshes = {
        "one": box(4, 4, 4).transformed(at(0, 20)),
        "two": box(4, 4, 4).transformed(at(60, 20)),
        "base": box(4, 4, 4).transformed(at(30, -20)),
    }
    return meshes, mechanism_of(meshes, joints)


def test_a_triangle_that_cannot_move_is_rigid() -> None:
    meshes, mechanism = truss(40.0)
    assert certify(meshes, mechanism).ok


def test_a_flat_triangle_is_not_called_rigid() -> None:
    meshes, mechanism = truss(0.0)
    assert not certify(meshes, mechanism).ok  # its joints are in one line: nearby it gives way


# --- random linkages


def linkages(seed: int) -> tuple[Meshes, Mechanism, list[float], float]:
    """Return two parallelograms of random size on one base, and a corner of their drivers."""
    rng = np.random.default_rng(seed)
    lengths, widths = rng.uniform(30, 50, 2), rng.uniform(8, 15, 2)
    turned = SE3.rot_z(float(rng.uniform(0, 2 * math.pi)))
    joints: list[Joint] = []
    for name, foot, length, width in zip("LR", (-60.0, 60.0), lengths, widths, strict=True):
        places = np.array([[foot, 0, 0], [foot, length, 0], [foot + width, length, 0], [foot + width, 0, 0]])
        a, b, c, d = turned.apply(places)
        joints += [
            pinned(f"{name}a", "base", f"{name}1", a, lower=(-FINGER,), upper=(FINGER,)),
            pinned(f"{name}b", f"{name}1", f"{name}t", b, **ENDLESS),
            pinned(f"{name}c", f"{name}t", f"{name}2", c, **ENDLESS),
            pinned(f"{name}d", "base", f"{name}2", d, **ENDLESS),
        ]
    corner = [FINGER * float(sign) for sign in rng.choice([-1, 1], 2)]
    L, R = (
        turned.apply(np.array([foot + width / 2, length, 0.0])) for foot, length, width in zip((-60.0, 60.0), lengths, widths, strict=True)
    )
    meshes = {
        "Lt": cylinder(3, HEIGHT, 12).transformed(SE3.from_translation(L)),
        "Rt": cylinder(3, HEIGHT, 12).transformed(SE3.from_translation(R)),
    }
    return meshes, mechanism_of(meshes, joints), corner, float(np.linalg.norm(R - L))


def tip(mechanism: Mechanism, meshes: Meshes, part: str, q: Sequence[float]) -> np.ndarray:
    pose = dict(zip(mechanism.parts, mechanism.poses(np.array(q)), strict=True))[part]
    return np.asarray(pose.apply(meshes[part].vertices.mean(axis=0)))


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.soak) for seed in range(2, 20))])
def test_random_linkages_agree_with_dense_sampling(seed: int) -> None:
    meshes, mechanism, corner, _ = linkages(seed)
    # an arm on one tip ends where the other tip comes only in the corner of both drivers
    there = tip(mechanism, meshes, "Rt", corner) - tip(mechanism, meshes, "Lt", corner)
    rest = tip(mechanism, meshes, "Lt", [0.0, 0.0])
    for is_hit in (True, False):
        gap = there * (1.0 if is_hit else 0.5)
        knob = cylinder(2, HEIGHT, 12).transformed(SE3.from_translation(rest + gap))
        solid = {"Lt": knob, "Rt": meshes["Rt"]}
        grid = np.linspace(-FINGER, FINGER, 21)
        seen = max(volume(mechanism, solid, ("Lt", "Rt"), (one, other)) for one in grid for other in grid)
        certificate = certify(solid, mechanism)
        if seen > 0:
            assert not certificate.ok
        else:
            assert not is_hit
            assert certificate.ok, str(certificate.findings)
            assert verified(stated(certificate), certificate) == []


def test_three_joints_that_collide_only_together_are_seen_beside_the_proof_of_every_two() -> None:
    """A chain of three hinges whose tip meets a post only where all three are at their ends."""
    reach, end = 50.0, 0.5
    joints = [
        joint(f"a{k}", "revolute", parent, f"l{k}", at_parent=at(reach if k > 1 else 0.0), lower=(-end,), upper=(end,))
        for k, parent in ((1, "frame"), (2, "l1"), (3, "l2"))
    ]
    mechanism = Mechanism(("frame", "l1", "l2", "l3"), "frame", joints)
    angles = end * np.arange(1, 4)
    tip = reach * np.cos(angles).sum(), reach * np.sin(angles).sum()
    post = cylinder(1.0, 10).transformed(at(*tip))
    meshes = {"frame": post, "l3": cylinder(2.0, 10).transformed(at(reach))}
    certificate = certify(meshes, mechanism, budget=60.0)
    (found,) = certificate.findings.of("E_MOTION_COLLISION")
    assert not certificate.ok
    assert found.pose is not None
    assert all(found.pose[name] > end - 0.05 for name in ("a1", "a2", "a3"))
    assert verified(json.loads(json.dumps(certificate.to_json())), certificate) == []
