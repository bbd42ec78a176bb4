"""Forged certificates: mechanisms whose parts collide, or that are not valid, with every word and number chosen to deceive the checker."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from articad.certificates.certificate import Certificate, certify, mechanism_json
from articad.certificates.verifier import PROOF, Checker
from articad.certificates.verifier_files import Refuted
from articad.geometry import TriMesh, box, cylinder, sphere
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import Waiver, at, block_with_bore, joint, proof_of, saved, verified, without_triangle
from tests.interference.test_certificate import ball_and_socket
from tests.interference.test_linkage import ALONG_X, four_bar

Document = dict[str, Any]


def proven(meshes: dict[str, TriMesh], joints: list[Joint], couplings: tuple[Coupling, ...] = (), **options: Any) -> Certificate:
    certificate = certify(meshes, Mechanism(tuple(meshes), next(iter(meshes)), joints, couplings), **options)
    assert certificate.ok
    assert verified(document_of(certificate), certificate) == []
    return certificate


def document_of(certificate: Certificate) -> Document:
    document: Document = json.loads(json.dumps(certificate.to_json()))
    return document


def run(limit: float) -> Joint:
    return joint("run", "slider", "post", "cart", at_parent=ALONG_X, at_child=ALONG_X, lower=(-limit,), upper=(limit,))


@pytest.fixture(scope="module")
def short() -> Certificate:
    """A cart 30 mm from a post that goes 10 mm to either side: 60 mm would carry it through the post."""
    return proven({"post": box(10, 10, 10), "cart": box(10, 10, 10).transformed(at(-30))}, [run(10.0)], deflection=0.01)


def far(document: Document) -> Document:
    """Return its joint as it is: it goes right through the post."""
    (own,) = document["mechanism"]["joints"]
    own["freedoms"][0]["range"] = [-60.0, 60.0]
    return copy.deepcopy(own)


def name_a_freedom_twice(document: Document) -> None:
    other = far(document)
    document["mechanism"]["parts"].append("tail")
    other.update(name="tow", parent="cart", child="tail", loop=False)
    other["freedoms"][0]["range"] = [-10.0, 10.0]
    document["mechanism"]["joints"].append(other)


def name_a_joint_twice(document: Document) -> None:
    other = far(document)
    other["freedoms"][0]["range"] = [-10.0, 10.0]
    document["mechanism"]["joints"].append(other)


def turn_the_range_round(document: Document) -> None:
    far(document)
    document["mechanism"]["joints"][0]["freedoms"][0]["range"] = [60.0, -60.0]


def keep_less_than_nothing(document: Document) -> None:
    far(document)
    (claim,) = document["claims"]
    claim["vary"]["run"], claim["clear_mm"] = [-60.0, 60.0], -1000.0
    for entry in document["meshes"].values():
        entry["deflection_mm"] = -500.0


def shorten_the_slide(document: Document) -> None:
    far(document)
    document["mechanism"]["joints"][0]["freedoms"][0]["slide"] = [0.0, 0.0, 0.1]
    document["claims"][0]["vary"]["run"] = [-60.0, 60.0]


def shrink_a_frame(document: Document) -> None:
    far(document)
    own = document["mechanism"]["joints"][0]
    for side in ("parent_frame", "child_frame"):
        own[side] = (np.array(own[side]) @ np.diag([1, 1, 0.1, 1])).tolist()
    document["claims"][0]["vary"]["run"] = [-60.0, 60.0]


def mirror_a_part(document: Document) -> None:
    own = document["mechanism"]["joints"][0]
    own["child_frame"] = (np.array(own["child_frame"]) @ np.diag([1, -1, 1, 1])).tolist()


def screw_askew(document: Document) -> None:
    document["mechanism"]["joints"][0]["freedoms"][0]["turn"] = [1.0, 0.0, 0.0]


def rest_nowhere(document: Document) -> None:
    document["mechanism"]["joints"][0]["freedoms"][0]["rest"] = math.nan


def stand_far_away(document: Document) -> None:
    own = document["mechanism"]["joints"][0]
    own["parent_frame"][1][3] = own["child_frame"][1][3] = 1e15


DECEITS = [
    name_a_freedom_twice, name_a_joint_twice, turn_the_range_round, keep_less_than_nothing, shorten_the_slide, shrink_a_frame,
    mirror_a_part, screw_askew, rest_nowhere, stand_far_away,
]  # fmt: skip


@pytest.mark.parametrize("deceit", DECEITS, ids=lambda deceit: deceit.__name__)
def test_a_cart_that_runs_through_a_post_is_not_called_clear(short: Certificate, deceit: Callable[[Document], None]) -> None:
    document = document_of(short)
    deceit(document)
    assert verified(document, short)


def test_overlap_that_only_samples_allow_is_none_that_is_proven(short: Certificate) -> None:
    document, proof = document_of(short), proof_of(short)
    proof["away"] = np.full((8, 3), [-0.5, 0.0, 0.0])
    proof["0.uses"] = np.array(["away", *proof["0.uses"][1:]])
    document["claims"][0]["shrink_mm"] = 0.5
    document["pairs"].append({**document["pairs"][0], "strength": {"kind": "sampled", "poses": 3, "epsilon_mm": 0.5}})
    assert verified(document, short, **{PROOF: saved(**proof)})
    document["pairs"][-1]["strength"]["kind"] = "certified"  # then it is said
    assert verified(document, short, **{PROOF: saved(**proof)}) == []


def test_a_waived_overlap_deeper_than_what_needs_no_waiver_is_accepted() -> None:
    meshes = {"block": block_with_bore(40, 10, 5, 48), "pin": cylinder(5.15, 20, 48)}
    turn = joint("turn", "revolute", "block", "pin", lower=(-0.5,), upper=(0.5,))
    certificate = proven(meshes, [turn], deflection=0.003, waivers=[Waiver(("block", "pin"), 0.4, "shrunk on")])
    assert [pair.strength.kind for pair in certificate.pairs] == ["waived"]
    assert [claim.shrink for claim in certificate.claims] == [0.4]


# --- meshes


@pytest.mark.parametrize("shape", [(-1, 1, 3), (-1, 3)], ids=["of another shape", "as it is"])
def test_a_core_in_its_case_is_found_whatever_the_shape_of_its_array(shape: tuple[int, ...]) -> None:
    meshes = {"case": sphere(50, 24), "core": sphere(5, 12).transformed(at(80))}
    outside = proven(meshes, [joint("spin", "revolute", "case", "core")])
    document, core = document_of(outside), sphere(5, 12)
    document["meshes"]["core"]["sha256"] = core.digest
    arrays = {"vertices": core.vertices.reshape(shape), "triangles": core.triangles}  # the same bytes, so the same hash
    assert verified(document, outside, core=saved(**arrays))


def inside_out(mesh: TriMesh) -> TriMesh:
    return TriMesh(mesh.vertices, mesh.triangles[:, ::-1])


@pytest.mark.parametrize("change", [inside_out, without_triangle])
def test_a_case_that_is_inside_out_or_open_does_not_hide_its_core(change: Callable[[TriMesh], TriMesh]) -> None:
    case, core = box(100, 100, 100), box(5, 5, 5)
    outside = proven({"case": case, "core": core.transformed(at(80, 80, 80))}, [joint("spin", "revolute", "case", "core")])
    mesh, document = change(case), document_of(outside)
    document["meshes"] |= {
        "case": {**document["meshes"]["case"], "sha256": mesh.digest},
        "core": {"sha256": core.digest, "deflection_mm": 0.0},
    }
    files = {name: saved(vertices=m.vertices, triangles=m.triangles) for name, m in (("case", mesh), ("core", core))}
    assert any("inside" in reason or "open" in reason for reason in verified(document, outside, **files))


@pytest.mark.parametrize("kind", [np.complex128, object, np.bool_])
def test_arrays_of_no_plain_numbers_are_refused(short: Certificate, kind: type) -> None:
    proof = proof_of(short)
    proof["0.about"] = proof["0.about"].astype(kind)
    assert verified(document_of(short), short, **{PROOF: saved(**proof)})


# --- balls


@pytest.mark.parametrize("cone", [-0.25, 2 * math.pi, math.nan])
def test_a_cone_that_is_none_is_refused(cone: float) -> None:
    certificate = proven(ball_and_socket(), [joint("knuckle", "ball", "socket", "stud", cone=0.25)], deflection=0.02)
    document = document_of(certificate)
    document["mechanism"]["joints"][0]["cone"] = cone
    assert verified(document, certificate)


def test_only_a_ball_has_a_cone() -> None:
    meshes = {"post": box(10, 10, 10), "plate": box(10, 10, 10).transformed(at(30))}
    certificate = proven(meshes, [joint("cross", "universal", "post", "plate", lower=(-0.1, -0.1), upper=(0.1, 0.1))])
    document = document_of(certificate)
    document["mechanism"]["joints"][0]["cone"] = 0.05
    assert verified(document, certificate)


# --- loops and couplings


def test_wheels_that_meet_only_as_they_turn_together_are_not_called_free() -> None:
    joints = [
        joint("one", "revolute", "frame", "left", lower=(-2.0,), upper=(2.0,)),
        joint("two", "revolute", "frame", "right", at_parent=at(50), at_child=at(50), lower=(-2.0,), upper=(2.0,)),
    ]
    meshes = {"frame": box(80, 8, 4).transformed(at(25, 0, -10)), "left": box(4, 56, 4), "right": box(4, 56, 4).transformed(at(50))}
    certificate = proven(meshes, joints, pairs=False)
    tied = Mechanism(tuple(meshes), "frame", joints, (Coupling(name="gear", kind="gear", a="one", b="two", ratio=-1.0, offset=0.0),))
    assert "E_MOTION_COLLISION" in certify(meshes, tied).findings.codes  # both lie flat at a quarter turn
    document = document_of(certificate)
    document["mechanism"] = mechanism_json(tied)
    assert verified(document, certificate)


@pytest.mark.parametrize("is_said", [True, False], ids=["a loop", "no loop"])
def test_links_of_a_loop_are_not_called_free(is_said: bool) -> None:
    meshes, joints = four_bar((0.0, 5.0, 10.0))
    certificate = proven(meshes, joints[:3], pairs=False)
    document = document_of(certificate)
    document["mechanism"] = mechanism_json(Mechanism(tuple(meshes), "frame", joints))
    for own in document["mechanism"]["joints"]:
        own["loop"] = own["loop"] and is_said
    assert verified(document, certificate)


@pytest.fixture(scope="module")
def loop() -> Certificate:
    meshes, joints = four_bar((0.0, 5.0, 0.0))
    return proven(meshes, joints, deflection=0.01)


def checker_of(certificate: Certificate, proof: dict[str, Any] | None = None) -> Checker:
    return Checker(document_of(certificate), {PROOF: proof_of(certificate) if proof is None else proof})


def test_a_driver_that_stays_near_rest_is_not_taken_round(loop: Certificate) -> None:
    """Every piece says where it is to be, and is where the first one is."""
    proof, step, count = proof_of(loop), 0.002, 200
    names, stops = checker_of(loop).followers(("crank",)), np.arange(count + 1) * step
    proof["crank.ends"] = np.stack([stops[:-1], stops[1:]], axis=1)
    proof["crank.values"] = np.zeros((count, len(names)))
    proof["crank.wide"] = np.tile([1.25 * step, *[0.005] * (len(names) - 1)], (count, 1))  # room for the driver, too
    proof["crank.other"] = np.arange(count)
    with pytest.raises(Refuted, match="cannot be at"):
        checker_of(loop, proof).stretch(("crank",), ((0.0, stops[-1]),))


def test_what_follows_is_not_held_still_as_a_driver(loop: Certificate) -> None:
    document = document_of(loop)
    document["drivers"] = list(checker_of(loop).linked)  # each would move alone, the loop open
    proof = {"crank.ends": [[-0.2, 0.2]], "crank.values": [[0.0]], "crank.wide": [[0.0]], "crank.other": [0]}
    checker = Checker(document, {PROOF: {key: np.array(value) for key, value in proof.items()}})
    with pytest.raises(Refuted, match="or not only there"):
        checker.stretch(("crank",), ((-0.2, 0.2),))


def test_no_piece_reaches_over_rest(loop: Certificate) -> None:
    """At a dead point more seems to drive than does, so that a piece about rest alone says too little."""
    names = checker_of(loop).followers(("crank",))
    wide = [0.0, *[0.005] * (len(names) - 1)]
    proof = {"crank.ends": [[-0.001, 0.001]], "crank.values": [[0.0] * len(names)], "crank.wide": [wide], "crank.other": [0]}
    checker = checker_of(loop, {key: np.array(value) for key, value in proof.items()})
    with pytest.raises(Refuted, match="on both sides of rest"):
        checker.stretch(("crank",), ((-0.001, 0.001),))


def test_a_loop_that_is_open_at_rest_is_refused(loop: Certificate) -> None:
    document = document_of(loop)
    pin = next(j for j in document["mechanism"]["joints"] if j["name"] == "pin_b")
    pin["freedoms"][0]["rest"] += 0.004  # within the room that a piece has about its line
    assert any("open at rest" in reason for reason in verified(document, loop))


def test_a_piece_of_no_length_does_not_hold_the_checker(loop: Certificate) -> None:
    proof = proof_of(loop)
    names = checker_of(loop).followers(("crank",))
    proof |= {"crank.ends": [[0.0, 0.0]], "crank.values": [[0.0] * len(names)], "crank.wide": [[0.0, 0.01, 0.01, 0.01]], "crank.other": [0]}
    checker = checker_of(loop, {key: np.array(value) for key, value in proof.items()})
    with pytest.raises(Refuted, match="not followed"):
        checker.stretch(("crank",), ((0.0, 1.0),))


def test_ways_are_searched_once_from_each_part_and_not_for_every_two(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twelve carts on one rail are 78 pairs of parts, and 13 parts from which ways over the tree begin."""
    names = [f"cart_{number}" for number in range(12)]
    meshes = {"rail": box(10, 10, 10)} | {name: box(10, 10, 10).transformed(at(0, 30 * (i + 1))) for i, name in enumerate(names)}
    joints = [
        joint(f"run_{name}", "slider", "rail", name, at_parent=ALONG_X, at_child=ALONG_X, lower=(-5.0,), upper=(5.0,)) for name in names
    ]
    searched: list[tuple[Checker, str]] = []
    reach = Checker.reached

    def counted(self: Checker, a: str, names: Any) -> Any:
        if names is None:
            searched.append((self, a))
        return reach(self, a, names)

    monkeypatch.setattr(Checker, "reached", counted)
    certificate = proven(meshes, joints, deflection=0.01, pairs=False)

    assert len(certificate.pairs) == 78
    assert len(searched) == len(set(searched)) >= len(meshes)
