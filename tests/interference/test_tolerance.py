"""Claims within tolerance: known answers, refutations that a variant shows, forgeries, and random variants of certified products."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from articad.certificates.certificate import Certificate, certify
from articad.certificates.verifier_tolerance import GENERAL, SIZES
from articad.geometry import TriMesh, box, cylinder
from articad.interference.relations import FitLike
from articad.kinematics.joints import Joint
from articad.kinematics.mechanism import Mechanism
from articad.plan.iso2768 import CLASSES, deviation
from articad.plan.resolve import Fit
from tests.interference.mechanisms import Waiver, at, block_with_bore, fixed, joint, verified
from tests.interference.test_linkage import four_bar
from tests.interference.variants import hits, met, random_product, varied

Document = dict[str, Any]
SOME, ALL = 12, 200  # random products, and with -m soak
VARIANTS = 10_000  # of all random products together


def mechanism_of(meshes: dict[str, TriMesh], joints: list[Joint]) -> Mechanism:
    return Mechanism(tuple(meshes), next(iter(meshes)), joints)


def proven(meshes: dict[str, TriMesh], joints: list[Joint], letter: str = "m", **options: Any) -> Certificate:
    return certify(meshes, mechanism_of(meshes, joints), tolerance=letter, **options)  # type: ignore[arg-type]


def document_of(certificate: Certificate) -> Document:
    document: Document = json.loads(json.dumps(certificate.to_json()))
    return document


def plates(gap: float) -> tuple[dict[str, TriMesh], list[Joint]]:
    """Two plates of 100 mm, fixed above each other, and what they are fixed to."""
    meshes = {
        "wall": box(20, 20, 20).transformed(at(0, 0, -200)),
        "low": box(100, 100, 10),
        "high": box(100, 100, 10).transformed(at(0, 0, 10 + gap)),
    }
    return meshes, [fixed("left", "wall", "low"), fixed("right", "wall", "high")]


def arm_by_post(gap: float) -> tuple[dict[str, TriMesh], list[Joint]]:
    """An arm of 120 x 10 that turns past a post of 100 mm, whose face is `gap` from the arm's end at rest."""
    meshes = {"post": box(10, 10, 100).transformed(at(65 + gap)), "arm": box(120, 10, 10)}
    return meshes, [joint("hinge", "revolute", "post", "arm", lower=(0.0,), upper=(1.0,))]


def pin_in_bore(pin: float, bore: float, kind: str = "revolute") -> tuple[dict[str, TriMesh], list[Joint]]:
    meshes = {"block": block_with_bore(40, 20, bore / 2, 64), "pin": cylinder(pin / 2, 30, 64)}
    return meshes, [fixed("turn", "block", "pin") if kind == "fixed" else joint("turn", kind, "block", "pin")]


# --- the tolerance of a part


def test_the_deviations_are_those_of_the_standard() -> None:
    # ISO 2768-1:1989, table 1
    printed = {3: "0.05 0.1 0.2 -", 6: "0.05 0.1 0.3 0.5", 30: "0.1 0.2 0.5 1", 120: "0.15 0.3 0.8 1.5", 400: "0.2 0.5 1.2 2.5"}
    printed |= {1000: "0.3 0.8 2 4", 2000: "0.5 1.2 3 6", 4000: "- 2 4 8"}
    for size, row in printed.items():
        for letter, cell in zip("fmcv", row.split(), strict=True):
            assert deviation(letter, size) == (None if cell == "-" else float(cell))  # type: ignore[arg-type]
    assert deviation("m", 120.001) == 0.5
    assert deviation("m", 4000.1) is None


def test_prover_and_checker_know_the_same_deviations() -> None:
    assert set(GENERAL) == set(CLASSES)
    for letter in CLASSES:
        for step, size in enumerate(SIZES):
            assert GENERAL[letter][step] == (deviation(letter, size) or math.inf)


# --- known answers


@pytest.mark.parametrize(
    ("gap", "letter", "ok"), [(0.5, "m", False), (0.59, "m", False), (0.61, "m", True), (0.7, "m", True), (0.5, "f", True)]
)
def test_plates_of_100_mm_are_clear_beyond_the_sum_of_their_deviations(gap: float, letter: str, ok: bool) -> None:
    certificate = proven(*plates(gap), letter=letter)
    assert certificate.ok is ok
    assert certify(plates(gap)[0], mechanism_of(*plates(gap))).ok
    if ok:
        assert verified(document_of(certificate), certificate) == []
        assert "3 of 3 pairs of parts stay clear" in document_of(certificate)["covers"]


def test_a_refutation_names_the_pair_the_pose_the_distance_and_what_decides() -> None:
    certificate = proven(*arm_by_post(0.5))
    (finding,) = certificate.findings.of("E_TOLERANCE")
    # the arm's corner passes the post's face at the pose where it lies on the axis through the hinge
    assert finding.parts == ("post", "arm")
    assert finding.pose is not None
    assert finding.pose["hinge"] == pytest.approx(math.atan2(5, 60), abs=1e-3)
    assert finding.value == pytest.approx(60.5 - math.hypot(60, 5), abs=1e-4)
    assert finding.limit == pytest.approx(0.6)
    assert "0.3 mm (post, 100 mm) and 0.3 mm (arm, 120 mm)" in finding.message
    assert "ISO 2768-m" in finding.message
    assert f"{math.degrees(math.atan2(5, 60)):.3g}"[:3] in finding.message
    assert not certificate.ok
    assert certify(arm_by_post(0.5)[0], mechanism_of(*arm_by_post(0.5))).ok


@pytest.mark.parametrize("make", [plates, arm_by_post])
def test_the_hint_of_a_refutation_heals(make: Callable[[float], tuple[dict[str, TriMesh], list[Joint]]]) -> None:
    (finding,) = proven(*make(0.5)).findings.of("E_TOLERANCE")
    more = float(finding.hint.split(" mm, ")[1].split(" mm more")[0])
    assert proven(*make(0.5 + more)).ok
    assert not proven(*make(0.5 + more - 0.05)).ok


def test_where_a_finer_class_is_enough_the_hint_says_so() -> None:
    (finding,) = proven(*plates(0.5)).findings.of("E_TOLERANCE")
    assert "ISO 2768-f" in finding.hint
    assert proven(*plates(0.5), letter="f").ok
    (finding,) = proven(*plates(0.2)).findings.of("E_TOLERANCE")
    assert "ISO 2768-f" not in finding.hint


def test_a_part_beyond_the_table_is_not_checked() -> None:
    meshes = {"rail": box(4100, 10, 10), "block": box(10, 10, 10).transformed(at(0, 40))}
    certificate = proven(meshes, [fixed("hold", "rail", "block")])
    (finding,) = certificate.findings.of("E_NOT_CHECKED")
    assert finding.parts == ("rail",)
    assert not certificate.ok


def test_followers_of_a_loop_are_proven_within_tolerance_and_refuted_with_the_drivers_pose() -> None:
    meshes, joints = four_bar((0.0, 6.0, 0.0))
    certificate = proven(meshes, joints)
    nominal = certify(meshes, mechanism_of(meshes, joints))
    assert nominal.ok
    refused = certificate.findings.of("E_TOLERANCE")
    if certificate.ok:
        assert verified(document_of(certificate), certificate) == []
    for finding in refused:
        assert finding.pose is None or {*finding.pose} <= {"crank", "pin_b", "pin_c", "rock"}
        assert finding.value is not None
        assert finding.limit is not None
        assert finding.value <= finding.limit


# --- what rules pairs that are not clear


def test_without_a_fit_a_pin_in_its_bore_is_refuted_and_the_joint_named() -> None:
    (finding,) = proven(*pin_in_bore(19.98, 20.02)).findings.of("E_TOLERANCE")
    assert "declare the fit of joint turn" in finding.hint


def test_a_running_fit_rules_its_pin_and_bore() -> None:
    fits: dict[str, FitLike] = {"turn": Fit.named("H7/g6", 20)}
    certificate = proven(*pin_in_bore(19.98, 20.02), fits=fits)
    assert certificate.ok
    (row,) = document_of(certificate)["tolerance"]["rows"]
    # H7 at 20 mm: +0.021/0; g6: -0.007/-0.020; half of 0.007 is the least play
    assert row == {"parts": ["block", "pin"], "by": "fit", "joints": ["turn"], "fits": ["20 H7/g6"], "least_mm": 0.0035}
    assert "0 of 1 pairs of parts stay clear; 1 ruled by their declared fits (least play 0.0035 mm)" in document_of(certificate)["covers"]
    assert verified(document_of(certificate), certificate) == []


def test_a_fit_that_may_interfere_is_refused_where_it_must_move_and_allowed_where_it_holds() -> None:
    fits: dict[str, FitLike] = {"turn": Fit.named("H7/k6", 20)}
    (finding,) = proven(*pin_in_bore(19.99, 20.01), fits=fits).findings.of("E_TOLERANCE")
    # k6 at 20 mm: +0.015/+0.002
    assert finding.value == pytest.approx(-0.0075)
    assert "0.015 mm" in finding.message
    held = proven(*pin_in_bore(19.99, 20.01, "fixed"), fits=fits)
    assert held.ok
    assert document_of(held)["tolerance"]["rows"][0]["least_mm"] == pytest.approx(-0.0075)
    assert verified(document_of(held), held) == []
    assert proven(*pin_in_bore(19.98, 20.02), fits={"turn": Fit.named("H7/g6", 20)}).ok  # as the hint says


def touching() -> tuple[dict[str, TriMesh], list[Joint]]:
    """A carriage that slides on a rail, face on face."""
    along_x = at().from_axes(o=(0, 0, 0), z=(1, 0, 0), x=(0, 1, 0))
    meshes = {"rail": box(200, 20, 10), "carriage": box(40, 20, 10).transformed(at(0, 0, 10))}
    return meshes, [joint("run", "slider", "rail", "carriage", at_parent=along_x, at_child=along_x, lower=(-50.0,), upper=(50.0,))]


def test_faces_that_touch_by_design_are_not_called_clear() -> None:
    certificate = proven(*touching())
    assert certificate.ok
    (row,) = document_of(certificate)["tolerance"]["rows"]
    assert row["by"] == "contact"
    assert row["depth_mm"] == pytest.approx(0.1 + 0.5 + 0.3)  # allowed between joined parts, and the shares of 200 mm and 40 mm
    covers = document_of(certificate)["covers"]
    assert "0 of 1 pairs of parts stay clear; 1 touch by design, proven only no deeper than 0.9 mm" in covers
    assert verified(document_of(certificate), certificate) == []


def test_parts_that_are_glued_together_are_not_claimed() -> None:
    meshes = {"low": box(40, 40, 10), "high": box(40, 40, 10).transformed(at(0, 0, 10))}
    certificate = proven(meshes, [fixed("glue", "low", "high")])
    assert certificate.ok
    assert "1 fixed to each other and said to touch, of which nothing is claimed" in document_of(certificate)["covers"]
    assert verified(document_of(certificate), certificate) == []


def test_pairs_that_no_requested_joint_moves_are_not_called_clear() -> None:
    meshes = {name: box(10, 10, 10).transformed(at(40 * n)) for n, name in enumerate(("a", "b", "c"))}
    joints = [joint("one", "revolute", "a", "b", at_parent=at(40), at_child=at(40), lower=(0.0,), upper=(0.1,))]
    joints += [joint("two", "revolute", "b", "c", at_parent=at(80), at_child=at(80), lower=(0.0,), upper=(0.1,))]
    certificate = certify(meshes, mechanism_of(meshes, joints), joints=["one"], tolerance="m")
    assert certificate.ok
    assert "2 of 3 pairs of parts stay clear; 1 not claimed, as no requested joint moves them" in document_of(certificate)["covers"]


# --- forgeries


def drop_still(document: Document) -> None:
    document["claims"] = [claim for claim in document["claims"] if claim["parts"] != ["low", "high"]]


def smaller_share(document: Document) -> None:
    document["tolerance"]["shares_mm"]["low"] = 0.1


def no_share(document: Document) -> None:
    del document["tolerance"]["shares_mm"]["low"]


def other_class(document: Document) -> None:
    document["tolerance"]["class"] = "c"


def unknown_class(document: Document) -> None:
    document["tolerance"]["class"] = "x"


def more_clear(document: Document) -> None:
    for claim in document["claims"]:
        claim["clear_mm"] += 0.2


def less_clear(document: Document) -> None:
    for claim in document["claims"]:
        claim["clear_mm"] -= 0.01


def fit_without_joint(document: Document) -> None:
    drop_still(document)
    document["tolerance"]["rows"] = [{"parts": ["low", "high"], "by": "fit", "joints": [], "fits": [], "least_mm": 1.0}]


def waiver_without_waiver(document: Document) -> None:
    drop_still(document)
    document["tolerance"]["rows"] = [{"parts": ["low", "high"], "by": "waiver"}]


def two_rows(document: Document) -> None:
    document["tolerance"]["rows"] = [{"parts": pair, "by": "contact"} for pair in (["low", "high"], ["high", "low"])]


FORGERIES = [
    drop_still, smaller_share, no_share, other_class, unknown_class, more_clear, less_clear, fit_without_joint, waiver_without_waiver, two_rows,
]  # fmt: skip


@pytest.fixture(scope="module")
def clear() -> Certificate:
    certificate = proven(*plates(0.7))
    assert verified(document_of(certificate), certificate) == []
    return certificate


@pytest.mark.parametrize("forge", FORGERIES, ids=lambda forge: forge.__name__)
def test_the_checker_refuses_forged_claims_within_tolerance(clear: Certificate, forge: Callable[[Document], None]) -> None:
    document = copy.deepcopy(document_of(clear))
    # the claims numbered in the proof must stay where they are: what is dropped is dropped at the end
    forge(document)
    assert verified(document, clear) != []


def test_a_nominal_certificate_cannot_be_called_one_within_tolerance() -> None:
    meshes, joints = arm_by_post(0.5)
    nominal = certify(meshes, mechanism_of(meshes, joints))
    document = document_of(nominal)
    document["tolerance"] = {"class": "m", "shares_mm": {"post": 0.3, "arm": 0.3}, "rows": []}
    assert any("no claim" in fault for fault in verified(document, nominal))
    for row in ({"by": "contact", "depth_mm": 0.7}, {"by": "waiver"}):
        document["tolerance"]["rows"] = [{"parts": ["post", "arm"], **row}]
        assert verified(document, nominal) != []


def test_a_joint_without_a_fit_cannot_be_ruled_by_another_pairs_fit() -> None:
    meshes, joints = pin_in_bore(19.98, 20.02)
    meshes["far"] = box(10, 10, 10).transformed(at(100))
    joints.append(joint("other", "revolute", "block", "far", at_parent=at(100), at_child=at(100)))
    certificate = proven(meshes, joints, fits={"turn": Fit.named("H7/g6", 20)})
    assert certificate.ok
    document = document_of(certificate)
    document["tolerance"]["rows"].append(
        {"parts": ["block", "far"], "by": "fit", "joints": ["turn"], "fits": ["20 H7/g6"], "least_mm": 0.0035}
    )
    assert any("nothing rules block/far" in fault for fault in verified(document, certificate))
    document = document_of(certificate)
    document["tolerance"]["rows"][0]["least_mm"] = -0.01
    assert any("nothing rules block/pin" in fault for fault in verified(document, certificate))


def test_a_waived_pair_is_said_to_be_waived() -> None:
    meshes, joints = plates(0.5)
    certificate = proven(meshes, joints, waivers=[Waiver(("low", "high"), 1.0, "they may touch")])
    assert certificate.tolerances is not None
    assert [row.by for row in certificate.tolerances.rows.values()] == ["waiver"]


# --- variants


def seeds() -> list[Any]:
    return [seed if seed < SOME else pytest.param(seed, marks=pytest.mark.soak) for seed in range(ALL)]


@pytest.mark.parametrize("seed", seeds())
def test_no_variant_of_a_certified_product_collides_and_a_variant_shows_each_refutation(seed: int) -> None:
    meshes, joints = random_product(seed)
    mechanism = mechanism_of(meshes, joints)
    certificate = certify(meshes, mechanism, tolerance="m", budget=20.0)
    if certificate.ok:
        assert hits(certificate, mechanism, VARIANTS // ALL if seed < SOME else 2 * VARIANTS // ALL, seed) == []
    for finding in certificate.findings.of("E_TOLERANCE"):
        a, b = finding.parts
        assert met(certificate, mechanism, (a, b), finding.pose or {}) > 0, finding


def test_variants_show_what_fails_within_tolerance() -> None:
    meshes, joints = plates(0.5)
    mechanism = mechanism_of(meshes, joints)
    certificate = certify(meshes, mechanism, tolerance="m")
    found = hits(certificate, mechanism, 400, 1)
    assert {hit.parts for hit in found} == {("low", "high")}
    meshes, joints = arm_by_post(0.4)
    mechanism = mechanism_of(meshes, joints)
    certificate = certify(meshes, mechanism, tolerance="m")
    assert hits(certificate, mechanism, 400, 1)


@pytest.mark.soak
@pytest.mark.parametrize("make", [plates, arm_by_post])
def test_ten_thousand_variants_of_a_product_that_is_just_clear_show_nothing(
    make: Callable[[float], tuple[dict[str, TriMesh], list[Joint]]],
) -> None:
    meshes, joints = make(0.82)
    mechanism = mechanism_of(meshes, joints)
    certificate = certify(meshes, mechanism, tolerance="m")
    assert certificate.ok
    assert hits(certificate, mechanism, VARIANTS, 2) == []


def test_a_variant_uses_its_tolerance_and_no_more() -> None:
    mesh, rng = cylinder(20, 30, 24), np.random.default_rng(3)
    off = [np.linalg.norm(varied(mesh, 0.3, np.eye(3)[2], rng).vertices - mesh.vertices, axis=1).max() for _ in range(200)]
    assert max(off) <= 0.3 * (1 + 1e-9)
    assert max(off) > 0.29
