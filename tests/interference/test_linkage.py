"""Motion of loops and couplings, proven along their drivers."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from articad.certificates import linkage, verifier
from articad.certificates.certificate import Certificate, certify, constrained_joints, driver_names, mechanism_json
from articad.certificates.linkage import DriverTrack, FollowedBox
from articad.certificates.ranges import driven_range
from articad.certificates.verifier import PROOF, Checker
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged
from articad.interference.overlap import overlap
from articad.interference.scene import Scene
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, joint, proof_of, saved, verified

CRANK, COUPLER, ROCKER, SPAN = 30.0, 90.0, 70.0, 100.0
REST = math.radians(60)
ALONG_X = SE3.from_axes([120.0, 0, 0], [1.0, 0, 0], [0.0, 1, 0])


def link(p: np.ndarray, q: np.ndarray, z: float) -> TriMesh:
    angle = math.atan2(q[1] - p[1], q[0] - p[0])
    middle = (p + q) / 2
    return box(float(np.linalg.norm(q - p)) + 8, 8, 4).transformed(at(middle[0], middle[1], z) @ SE3.rot_z(angle))


def four_bar(layers: tuple[float, float, float], extra: TriMesh | None = None) -> tuple[dict[str, TriMesh], list[Joint]]:
    """Crank, coupler and rocker in their layers; `extra` is added to the crank."""
    O, D = np.zeros(2), np.array([SPAN, 0.0])
    B = CRANK * np.array([math.cos(REST), math.sin(REST)])
    e = float(np.linalg.norm(D - B))
    u = (COUPLER**2 - ROCKER**2 + e * e) / (2 * e)
    along = (D - B) / e
    C = B + u * along + math.sqrt(COUPLER**2 - u * u) * np.array([-along[1], along[0]])
    crank = link(O, B, layers[0])
    meshes = {
        "frame": link(O, D, -10.0),
        "crank": crank if extra is None else merged([crank, extra]),
        "coupler": link(B, C, layers[1]),
        "rocker": link(C, D, layers[2]),
    }
    pins = [
        ("crank", "frame", "crank", O),
        ("pin_b", "crank", "coupler", B),
        ("pin_c", "coupler", "rocker", C),
        ("rock", "frame", "rocker", D),
    ]
    joints = [
        joint(name, "revolute", parent, child, at_parent=at(*place), at_child=at(*place), lower=(-math.inf,), upper=(math.inf,))
        for name, parent, child, place in pins
    ]
    return meshes, joints


def proven(meshes: dict[str, TriMesh], joints: list[Joint], couplings: tuple[Coupling, ...] = ()) -> Certificate:
    return certify(meshes, Mechanism(tuple(meshes), next(iter(meshes)), joints, couplings), deflection=0.01)


def refutations(certificate: Certificate, change: Callable[[dict[str, Any]], object] | None = None) -> list[str]:
    document = json.loads(json.dumps(certificate.to_json()))
    if change is not None:
        change(document)
    return verified(document, certificate)


def checker_of(mechanism: Mechanism) -> Checker:
    linkage = constrained_joints(mechanism)
    document = {"mechanism": mechanism_json(mechanism), "linkage": sorted(linkage), "drivers": driver_names(mechanism, linkage)}
    return Checker(document, {PROOF: {}})


def way_of(mechanism: Mechanism, driver: int = 0) -> DriverTrack:
    checker = checker_of(mechanism)
    ends, _ = driven_range(mechanism, checker, driver)
    return DriverTrack(checker, (mechanism.drivers[driver].name,), (ends,))


def halves_of(way: DriverTrack, piece: FollowedBox) -> Sequence[FollowedBox]:
    found = way.halves(piece, np.ones(len(way.drivers)))
    return () if found is None else found[2:]


def slider_crank() -> Mechanism:
    joints = [
        joint("crank", "revolute", "frame", "arm", lower=(-math.inf,), upper=(math.inf,)),
        joint("pin", "revolute", "arm", "rod", at_parent=at(30), at_child=at(30), lower=(-math.inf,), upper=(math.inf,)),
        joint("wrist", "revolute", "rod", "piston", at_parent=at(120), at_child=at(120), lower=(-math.inf,), upper=(math.inf,)),
        joint("slide", "slider", "frame", "piston", at_parent=ALONG_X, at_child=ALONG_X, lower=(-80.0,), upper=(20.0,)),
    ]
    return Mechanism(("frame", "arm", "rod", "piston"), "frame", joints)


@pytest.mark.parametrize("half", [0.01, 0.1, 0.5])
def test_no_loop_bends_more_than_the_lever_that_the_checker_takes(half: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verifier, "HALF", math.inf)  # by which a loop may be open
    mechanism = slider_crank()
    checker = checker_of(mechanism)
    names = checker.followers(("crank",))
    rest = np.array([checker.rest[name] for name in names])
    r, J, share = checker.closure(names, rest, rest)
    turns = np.array([any(checker.freedoms[name]["turn"]) for name in names])
    rng = np.random.default_rng(4)
    for _ in range(200):
        change = rng.uniform(-1, 1, len(names)) * np.where(turns, half, (1 + np.abs(rest)) * 2 * half)  # as far as slides may go
        bent = checker.closure(names, rest + change, rest)[0] - r - J @ change
        assert (np.abs(bent) <= (share @ np.abs(change)) ** 2 / 2 + 1e-9).all()


def test_the_jacobian_is_the_derivative_of_the_residuals_where_a_loop_is_open(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verifier, "HALF", math.inf)  # by which a loop may be open
    checker, rng = checker_of(slider_crank()), np.random.default_rng(5)
    names = checker.followers(("crank",))
    x = rng.uniform(-0.4, 0.4, (20, len(names)))
    about, J = np.zeros_like(x), checker.closure(names, x, np.zeros_like(x))[1]
    for k, step in enumerate(np.eye(len(names)) * 1e-6):
        slope = (checker.closure(names, x + step, about)[0] - checker.closure(names, x - step, about)[0]) / 2e-6
        assert slope == pytest.approx(J[..., k], abs=1e-8)


def test_the_grid_of_a_tube_bounds_functions_between_its_points() -> None:
    t, powers = np.linspace(-1, 1, 4001), np.arange(5)
    weights = np.linalg.inv(verifier.NODES[:, None] ** powers).T @ t ** powers[:, None]  # Lagrange's polynomials
    assert np.abs(weights).sum(axis=0).max() <= verifier.LEBESGUE
    assert np.abs(np.prod(t[:, None] - verifier.NODES, axis=1)).max() / math.factorial(5) <= verifier.QUINTIC * (1 + 1e-12)
    values = np.random.default_rng(6).normal(size=(100, 5))
    assert (np.abs(values @ weights).max(axis=1) <= np.abs(values @ verifier.BERNSTEIN.T).max(axis=1) * (1 + 1e-9)).all()


def test_every_solution_lies_within_the_tube_of_its_box_of_two_drivers() -> None:
    # a five-bar: the closure is by the circles about its two elbows, apart from every solver of the project
    elbows, rod, turn = np.array([[0.0, 60], [100.0, 60]]), 90.0, 0.6
    apex = np.array([50.0, 60 + math.sqrt(rod**2 - 50**2)])
    pins = (
        ("a1", "base", "l1", (0, 0)),
        ("b", "l1", "l2", elbows[0]),
        ("a2", "base", "r1", (100, 0)),
        ("d", "r1", "r2", elbows[1]),
        ("c", "l2", "r2", apex),
    )
    joints = [
        replace(joint(n, "revolute", p, c, at_parent=at(*xy), at_child=at(*xy), lower=(-turn,), upper=(turn,)), driver=True) if n in ("a1", "a2")
        else joint(n, "revolute", p, c, at_parent=at(*xy), at_child=at(*xy), lower=(-math.inf,), upper=(math.inf,))
        for n, p, c, xy in pins
    ]  # fmt: skip
    way = DriverTrack(checker_of(Mechanism(("base", "l1", "l2", "r1", "r2"), "base", joints)), ("a1", "a2"), ((-turn, turn), (-turn, turn)))
    assert way.whole is not None
    assert way.count <= 60
    rng = np.random.default_rng(7)
    for ends, _, _, _, (guess, curve, near, _) in way._found[1:]:
        middle, half = ends.mean(axis=1), np.ptp(ends, axis=1) / 2
        rates = next(row for row in way._found if row[0] is ends)[2]
        for step in rng.uniform(-1, 1, (20, 2)) * half:
            values = middle + step
            pins_at = [np.array([x, 0]) + rotated(value) @ [0.0, 60] for x, value in zip((0, 100), values, strict=True)]
            between = pins_at[1] - pins_at[0]
            height = math.sqrt(rod**2 - between @ between / 4)
            tip = (pins_at[0] + pins_at[1]) / 2 + height * np.array([-between[1], between[0]]) / np.linalg.norm(between)
            turned = [
                math.remainder(math.atan2(*(tip - pin)[::-1]) - math.atan2(*(apex - elbow)[::-1]), 2 * math.pi)
                for pin, elbow in zip(pins_at, elbows, strict=True)
            ]
            true = {"a1": values[0], "a2": values[1], "b": turned[0] - values[0], "d": turned[1] - values[1], "c": turned[1] - turned[0]}
            there = guess + step @ rates + step @ np.tensordot(step, curve, 1) / 2
            assert (np.abs([true[name] for name in way.names] - there) <= near + 1e-9).all()


def rotated(angle: float) -> np.ndarray:
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


def test_a_four_bar_in_layers_is_certified_over_a_full_turn() -> None:
    meshes, joints = four_bar((0.0, 5.0, 10.0))
    certificate = proven(meshes, joints)
    assert certificate.ok
    assert all(pair.strength.kind == "certified" for pair in certificate.pairs)
    assert len(certificate.pairs) == 6
    assert len(certificate.claims) == 6
    assert certificate.ranges[0].upper - certificate.ranges[0].lower == pytest.approx(2 * math.pi)
    assert refutations(certificate) == []


def test_links_of_one_layer_that_pass_each_other_are_certified_by_tubes() -> None:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    certificate = proven(meshes, joints)
    assert certificate.ok
    (claim,) = [claim for claim in certificate.claims if set(claim.parts) == {"crank", "rocker"}]
    assert list(claim.vary) == ["crank"]  # whatever follows it


def assert_on_its_line(mechanism: Mechanism, piece: FollowedBox, value: float) -> None:
    found = mechanism.configuration(np.array([value])).values
    for name, (middle, (rate,), near) in piece.line.items():
        assert abs(found[name][0] - middle - rate * (value - piece.middle[0])) <= near + 1e-9


def test_every_solution_lies_near_the_line_of_its_piece() -> None:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    mechanism = Mechanism(tuple(meshes), "frame", joints)
    way = way_of(mechanism)
    rng = np.random.default_rng(0)
    pieces = [piece for sign in (1, -1) for piece in way.steps(sign)]
    spans = sorted(piece.ends[0] for piece in pieces)
    for each in [*pieces, *(half for piece in pieces[::5] for half in halves_of(way, piece))]:
        for value in rng.uniform(*each.ends[0], 3):
            assert_on_its_line(mechanism, each, value)
    assert all(after[0] == before[1] for before, after in pairwise(spans))
    assert (spans[0][0], spans[-1][1]) == pytest.approx(way.bounds[0])


def test_every_solution_lies_near_the_line_of_pieces_in_a_row() -> None:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    mechanism = Mechanism(tuple(meshes), "frame", joints)
    way = way_of(mechanism)
    rng = np.random.default_rng(1)
    assert way.whole is not None
    found = [way.whole]
    assert found[0].ends[0] == pytest.approx(way.bounds[0])
    for piece in found:
        if len(piece.numbers) > 1:
            found += halves_of(way, piece)
        for value in rng.uniform(*piece.ends[0], 2):
            assert_on_its_line(mechanism, piece, value)
    assert sum(len(piece.numbers) == 1 for piece in found) == len(way.steps(1)) + len(way.steps(-1))


def test_a_collision_within_a_loop_is_found_with_the_drivers_value() -> None:
    # a knob on the crank's pin reaches into the rocker's layer, where the rocker has a finger
    knob = cylinder(3, 8, 24).transformed(at(CRANK * math.cos(REST), CRANK * math.sin(REST), 1.0))
    meshes, joints = four_bar((5.0, 10.0, 0.0), knob)
    meshes["rocker"] = merged([meshes["rocker"], box(73, 4, 4, center=False).transformed(at(20.0, 16.0, -2.0))])
    certificate = proven(meshes, joints)
    collisions = certificate.findings.of("E_MOTION_COLLISION")
    assert collisions
    assert set(collisions[0].parts) == {"crank", "rocker"}
    mechanism = Mechanism(tuple(meshes), "frame", joints)
    scene = Scene.of(meshes, joints)
    free = certificate.ranges[0]
    for value in np.linspace(free.lower, free.upper, 60):
        poses = dict(zip(mechanism.parts, mechanism.poses(np.array([value])), strict=True))
        assert overlap(scene.bodies["crank"], scene.bodies["rocker"], poses["crank"].inverse() @ poses["rocker"]).volume < 1e-6
    assert not certificate.ok


def test_wheels_tied_by_a_gear_are_followed() -> None:
    joints = [
        joint("one", "revolute", "frame", "left", lower=(-math.inf,), upper=(math.inf,)),
        joint("two", "revolute", "frame", "right", at_parent=at(50), at_child=at(50), lower=(-math.inf,), upper=(math.inf,)),
    ]
    # two paddles in one plane that miss each other only because they turn together
    left = box(56, 4, 4)
    right = box(4, 56, 4).transformed(at(50))
    meshes = {"frame": box(80, 8, 4).transformed(at(25, 0, -10)), "left": left, "right": right}
    tied = proven(meshes, joints, (Coupling(name="mesh", kind="gear", a="one", b="two", ratio=-1.0, offset=0.0),))
    assert tied.ok
    assert {pair.strength.kind for pair in tied.pairs} == {"certified"}
    assert refutations(tied) == []
    loose = proven(meshes, joints)
    assert "E_MOTION_COLLISION" in loose.findings.codes


def test_a_spent_budget_leaves_loops_unchecked_and_says_so() -> None:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    certificate = certify(meshes, Mechanism(tuple(meshes), "frame", joints), budget=0.0)
    assert not certificate.ok
    assert set(certificate.findings.codes) == {"E_NOT_CHECKED"}


def test_a_driver_that_cannot_be_followed_at_all_leaves_loops_unchecked_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linkage, "SMALLEST_STEP", 1.0)
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    certificate = certify(meshes, Mechanism(tuple(meshes), "frame", joints))
    assert not certificate.ok
    assert "no tube encloses the followers" in str(certificate.findings.of("E_NOT_CHECKED"))


def test_a_joint_beside_the_loop_is_proven_together_with_its_driver() -> None:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    meshes["slide"] = box(4, 4, 4).transformed(at(50, 80, 0))
    joints.append(joint("lift", "slider", "frame", "slide", lower=(0.0,), upper=(10.0,)))
    certificate = proven(meshes, joints)
    assert certificate.ok
    assert any({"crank", "lift"} <= set(claim.vary) for claim in certificate.claims)
    assert refutations(certificate) == []


# --- planted lies on a loop


@pytest.fixture(scope="module")
def honest() -> Certificate:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    return proven(meshes, joints)


def followed(document: dict[str, Any]) -> dict[str, Any]:
    claim: dict[str, Any] = next(claim for claim in document["claims"] if set(claim["parts"]) == {"crank", "rocker"})
    return claim


def narrow(document: dict[str, Any]) -> None:
    followed(document)["vary"]["crank"][1] -= 0.5


def enlarge(document: dict[str, Any]) -> None:
    followed(document)["clear_mm"] = 70.0


def drop(document: dict[str, Any]) -> None:
    document["claims"].remove(followed(document))


def shift_a_pin(document: dict[str, Any]) -> None:
    frame = next(j for j in document["mechanism"]["joints"] if j["name"] == "rock")["parent_frame"]
    frame[0][3] -= 40.0  # the linkage does not close there, nor at rest


def turn_the_branch(document: dict[str, Any]) -> None:
    next(j for j in document["mechanism"]["joints"] if j["name"] == "pin_b")["freedoms"][0]["rest"] += 0.5


def free_the_loop(document: dict[str, Any]) -> None:
    document["mechanism"]["joints"] = [{**j, "loop": False} for j in document["mechanism"]["joints"] if not j["loop"]]


def hold_what_follows(document: dict[str, Any]) -> None:
    claim = followed(document)
    rest = {f["name"]: f["rest"] for j in document["mechanism"]["joints"] for f in j["freedoms"]}
    claim["vary"].update({name: [rest[name], rest[name]] for name in claim["via"] if name not in claim["vary"]})


def forget_the_driver(document: dict[str, Any]) -> None:
    document["drivers"], document["claims"] = [], []


def call_a_follower_a_driver(document: dict[str, Any]) -> None:
    document["drivers"].append("pin_c")


def move_two_drivers(document: dict[str, Any]) -> None:
    document["drivers"].append("pin_c")  # the rocker would be followed along one of them
    followed(document)["vary"]["pin_c"] = [-math.pi, math.pi]


def swap_mesh(document: dict[str, Any]) -> None:
    document["meshes"]["crank"]["sha256"] = document["meshes"]["rocker"]["sha256"]


LIES = [
    narrow, enlarge, drop, shift_a_pin, turn_the_branch, hold_what_follows, forget_the_driver, call_a_follower_a_driver, move_two_drivers, swap_mesh
]  # fmt: skip


@pytest.mark.parametrize("lie", LIES, ids=lambda lie: lie.__name__)
def test_a_planted_lie_on_a_loop_is_refuted(honest: Certificate, lie: Callable[[dict[str, Any]], None]) -> None:
    assert refutations(honest, lie)


def turn_half_round(document: dict[str, Any]) -> None:
    loop = next(j for j in document["mechanism"]["joints"] if j["loop"])
    loop["child_frame"] = (np.array(loop["child_frame"]) @ np.diag([-1.0, -1.0, 1.0, 1.0])).tolist()


def test_a_loop_that_closes_but_for_half_a_turn_is_refuted(honest: Certificate) -> None:
    # no residual distinguishes it from a closed one: the antisymmetric part of half a turn is zero
    (reason,) = refutations(honest, turn_half_round)
    assert reason.endswith("a loop is not closed")


def tampered(certificate: Certificate, change: Callable[[dict[str, Any]], object]) -> list[str]:
    proof = proof_of(certificate)
    change(proof)
    return verified(certificate.to_json(), certificate, **{PROOF: saved(**proof)})


def follow_another_branch(proof: dict[str, Any]) -> None:
    ends, values = proof["crank.ends"], proof["crank.values"]
    mechanism = Mechanism(tuple(four_bar((0.0, 5.0, 0.0))[0]), "frame", four_bar((0.0, 5.0, 0.0))[1])
    low, high = ends[0][0] = ends[0][0] / 4  # from rest on: the other branch bends more
    found = mechanism.configuration(np.array([(low + high) / 2])).values
    across, opened = crossing((low + high) / 2)  # coupler and rocker mirrored about the line from the crank's pin to the rocker's pivot
    values[0] = [(low + high) / 2, found["pin_b"][0] + across, found["pin_c"][0] + opened, found["rock"][0] + across + opened]


def crossing(crank: float) -> tuple[float, float]:
    """Return by how much the coupler's and the rocker's turns differ on the other branch of the four-bar."""
    pin = CRANK * np.array([math.cos(REST + crank), math.sin(REST + crank)])
    e = float(np.linalg.norm(np.array([SPAN, 0.0]) - pin))
    at_pin = math.acos((COUPLER**2 + e * e - ROCKER**2) / (2 * COUPLER * e))
    at_joint = math.acos((COUPLER**2 + ROCKER**2 - e * e) / (2 * COUPLER * ROCKER))
    return -2 * at_pin, 2 * (math.pi - at_joint)


def leave_out_a_piece(proof: dict[str, Any]) -> None:
    for key in ("ends", "values", "wide", "other"):
        proof[f"crank.{key}"] = np.delete(proof[f"crank.{key}"], 3, axis=0)


def narrow_the_tube(proof: dict[str, Any]) -> None:
    proof["crank.wide"] *= 1e-3


def widen_the_tube(proof: dict[str, Any]) -> None:
    proof["crank.wide"] *= 1e3


def lengthen_a_piece(proof: dict[str, Any]) -> None:
    proof["crank.ends"][3] += [-0.3, 0.3]


def move_a_piece(proof: dict[str, Any]) -> None:
    proof["crank.values"][3, 1] += 0.05


@pytest.mark.parametrize(
    "change",
    [follow_another_branch, leave_out_a_piece, narrow_the_tube, widen_the_tube, lengthen_a_piece, move_a_piece],
    ids=lambda change: change.__name__,
)
def test_a_tampered_tube_is_refuted(honest: Certificate, change: Callable[[dict[str, Any]], object]) -> None:
    assert tampered(honest, dict) == []  # that changes nothing
    assert tampered(honest, change)


def test_another_branch_is_refuted_for_that_reason(honest: Certificate) -> None:
    # it closes as well as the one of the rest pose, and keeps to itself
    assert any("leaves its branch" in reason for reason in tampered(honest, follow_another_branch))


def test_an_honest_certificate_of_a_loop_is_accepted(honest: Certificate) -> None:
    assert refutations(honest) == []


def test_links_that_are_said_to_follow_although_nothing_closes_the_loop_are_refuted(honest: Certificate) -> None:
    assert refutations(honest, free_the_loop)


def test_a_joint_that_only_follows_is_proven_with_its_driver() -> None:
    meshes, joints = four_bar((0.0, 5.0, 10.0))
    certificate = certify(meshes, Mechanism(tuple(meshes), "frame", joints), joints=["rock"])
    assert certificate.ok
    assert "crank" in certificate.asked
    assert len(certificate.claims) == 6


def test_what_slides_without_limits_is_not_checked() -> None:
    meshes = {"base": box(4, 4, 4), "cart": box(4, 4, 4).transformed(at(20))}
    endless = joint("run", "slider", "base", "cart", lower=(-math.inf,), upper=(math.inf,))
    certificate = certify(meshes, Mechanism(("base", "cart"), "base", [endless]))
    assert certificate.findings.codes == ("E_NOT_CHECKED",)
    assert not certificate.ok
