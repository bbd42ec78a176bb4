"""Sampled motion: what it finds, what it says of its strength, and that it asks each relative pose once."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from articad.geometry import box, cylinder
from articad.interference.clearance import least_clearances
from articad.interference.freedoms import freedoms, scattered
from articad.interference.scene import Scene
from articad.interference.sweep import MotionSampler, sweep
from articad.kinematics import Coupling, JointLimits
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import Waiver, at, block_with_bore, fixed, joint, without_triangle

BAR = box(100, 6, 6, center=False).transformed(at(4, -3, -3))
POST = cylinder(3, 60, 24).transformed(at(70, 40))
SWING = joint("swing", "revolute", "frame", "bar", lower=(0.0,), upper=(1.2,))
SCENE = {"post": POST, "bar": BAR}
JOINTS = [fixed("held", "frame", "post"), SWING]


def test_a_collision_within_the_range_is_found_with_its_pose_and_called_sampled() -> None:
    report = sweep(SCENE, Mechanism(("frame", "post", "bar"), "frame", JOINTS), steps=60)
    (finding,) = report.findings
    assert finding.code == "E_MOTION_COLLISION"
    assert finding.pose is not None
    assert finding.pose["swing"] == pytest.approx(math.atan2(40, 70), abs=0.05)
    pair = report.pair("post", "bar")
    assert pair is not None
    assert pair.strength.kind == "sampled"
    assert pair.strength.poses == 60
    assert pair.strength.step == pytest.approx(1.2 / 59)
    assert pair.over == ("swing",)


def test_a_range_that_ends_before_is_clean() -> None:
    short = joint("swing", "revolute", "frame", "bar", lower=(0.0,), upper=(0.3,))
    assert sweep(SCENE, Mechanism(("frame", "post", "bar"), "frame", [JOINTS[0], short])).ok


def test_an_oversize_pin_overlaps_statically_and_does_not_collide() -> None:
    meshes = {"block": block_with_bore(40, 10, 5, 48), "pin": cylinder(5.3, 20, 48)}
    report = sweep(meshes, Mechanism(("block", "pin"), "block", [joint("turn", "revolute", "block", "pin")]), steps=12, deflection=0.01)
    assert report.findings.codes == ("E_STATIC_OVERLAP",)


def test_a_pair_that_overlaps_more_and_more_collides() -> None:
    slide = joint("slide", "slider", "a", "b", lower=(0.0,), upper=(20.0,))
    meshes = {"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(z=-20))}
    report = sweep(meshes, Mechanism(("a", "b"), "a", [slide]), steps=21)
    (finding,) = report.findings
    assert finding.code == "E_MOTION_COLLISION"
    assert finding.pose == {"slide": 20.0}


def test_two_joints_on_a_grid_find_what_one_at_a_time_does_not() -> None:
    links = {
        "base": box(5, 200, 30).transformed(at(165)),
        "upper": box(100, 6, 6, center=False).transformed(at(4, -3, -3)),
        "fore": box(100, 6, 6, center=False).transformed(at(104, -3, 4)),
    }
    joints = [
        joint("shoulder", "revolute", "base", "upper", lower=(-1.0,), upper=(1.0,), rest=(1.0,)),
        joint("elbow", "revolute", "upper", "fore", at_parent=at(100), at_child=at(100), lower=(-1.5,), upper=(1.5,), rest=(1.5,)),
    ]
    mechanism = Mechanism(tuple(links), "base", joints)
    assert sweep(links, mechanism, steps=50).ok
    assert not sweep(links, mechanism, steps=100, together=True).ok
    assert not sweep(links, mechanism, steps=5, samples=60).ok


def test_each_relative_pose_is_asked_once() -> None:
    names = [f"p{i}" for i in range(6)]
    joints = [joint(f"j{i}", "revolute", a, b, at_parent=at(9), lower=(-0.1,), upper=(0.1,)) for i, (a, b) in enumerate(pairwise(names))]
    mechanism = Mechanism(tuple(names), "p0", joints)
    scene = Scene.of(dict.fromkeys(names, box(10, 2, 2)), joints)
    sampler = MotionSampler(scene, mechanism)
    sampler.run(["j0"], steps=20, together=False, samples=0)
    # neighbours across the other joints keep their relative pose: one query each; across j0 one per step
    assert sampler.queries <= 20 + 4
    before = sampler.queries
    sampler.run(["j0"], steps=20, together=False, samples=0)
    assert sampler.queries == before


def test_cached_volumes_are_those_of_every_pose_asked_anew() -> None:
    mechanism = Mechanism(("frame", "post", "bar"), "frame", JOINTS)
    worst = max(
        (
            pair.volume
            for q in np.linspace(0, 1.2, 30)
            for pair in MotionSampler(Scene.of(SCENE, JOINTS), mechanism).sampled([{"swing": float(q)}], ("swing",), None).pairs
        ),
    )
    assert sweep(SCENE, mechanism, steps=30).pairs[0].volume == pytest.approx(worst)


def test_relative_poses_that_differ_by_less_than_a_millimetre_are_not_taken_for_one() -> None:
    slide = joint("slide", "slider", "a", "b", lower=(0.0,), upper=(1.4,))
    meshes = {"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(z=-10))}
    report = sweep(meshes, Mechanism(("a", "b"), "a", [slide]), steps=15)
    assert report.pairs[0].volume == pytest.approx(140.0)


def test_large_meshes_are_swept_with_the_same_verdict() -> None:
    fine = cylinder(3, 60, 1500).transformed(at(70, 40))
    assert len(fine.triangles) > 4000
    report = sweep({"post": fine, "bar": BAR}, Mechanism(("frame", "post", "bar"), "frame", JOINTS), steps=60)
    assert report.findings.codes == ("E_MOTION_COLLISION",)


def test_waived_pairs_pass_and_broken_ones_are_unknown() -> None:
    mechanism = Mechanism(("frame", "post", "bar"), "frame", JOINTS)
    assert sweep(SCENE, mechanism, waivers=[Waiver(("bar", "post"), 10.0, "a notch is cut later")]).ok
    broken = sweep({"post": without_triangle(POST), "bar": BAR}, mechanism)
    assert broken.findings.codes == ("E_MESH_OPEN",)
    assert [pair.verdict for pair in broken.pairs] == ["unknown"]


def test_a_ball_is_swept_over_cone_and_twist() -> None:
    joints = [fixed("held", "frame", "post"), joint("knuckle", "ball", "frame", "bar", cone=0.8)]
    mechanism = Mechanism(("frame", "post", "bar"), "frame", joints)
    report = sweep(SCENE, mechanism, steps=40)
    assert {pair.over for pair in report.pairs} <= {("knuckle.sx",), ("knuckle.sy",), ("knuckle.twist",)}
    assert not report.ok  # twist alone reaches the post


def test_scattered_points_fill_a_square_more_evenly_than_chance() -> None:
    ranges = [*freedoms(SWING), *freedoms(SWING)]
    points = np.array(list(scattered(ranges, 256))) / 1.2
    counts, _, _ = np.histogram2d(points[:, 0], points[:, 1], bins=8, range=[[0, 1], [0, 1]])
    assert counts.min() >= 2
    assert counts.max() <= 6


@pytest.mark.parametrize(("limit", "is_cut"), [(1.0, True), (3.0, False)])
def test_a_range_that_a_followers_limit_cuts_short_is_told(limit: float, is_cut: bool) -> None:
    joints = [
        joint("fast", "revolute", "frame", "crank", lower=(-3.0,), upper=(3.0,)),
        joint("slow", "revolute", "frame", "arm", lower=(-limit,), upper=(limit,)),
    ]
    mechanism = Mechanism(("frame", "crank", "arm"), "frame", joints, [Coupling("gear", "linear", "fast", "slow", -1.0, 0.0)])
    report = sweep({"arm": box(70, 6, 6), "crank": box(1, 1, 1).transformed(at(0, 0, 99))}, mechanism, steps=61)
    found = [finding.message for finding in report.findings.of("I_NOT_SAMPLED")]
    assert len(found) == is_cut
    assert all("fast is sampled at -1 to 1, not at -3 to 3" in said for said in found)


def test_a_sweep_names_the_joints_that_move_freely_and_stand() -> None:
    mechanism = Mechanism(
        ("frame", "boat", "mast"),
        "frame",
        [replace(joint("afloat", "free", "frame", "boat"), limits=JointLimits()), joint("step", "revolute", "boat", "mast")],
    )
    report = sweep({"mast": box(2, 2, 2), "frame": box(1, 1, 1).transformed(at(0, 0, 99))}, mechanism, steps=8)
    (said,) = report.findings.of("I_NOT_SAMPLED")
    assert said.where == "joints.afloat"


def coupled(ratio: float, kind: str = "revolute") -> Mechanism:
    """Return a crank that drives an arm (or what the kind says) at a ratio, both without limits, and a post that is fixed to the frame."""
    joints = [
        joint("fast", "revolute", "frame", "crank", lower=(-math.inf,), upper=(math.inf,)),
        joint("slow", kind, "frame", "arm", at_parent=at(200), lower=(-math.inf,), upper=(math.inf,)),
        fixed("foot", "frame", "post"),
    ]
    return Mechanism(("frame", "crank", "arm", "post"), "frame", joints, [Coupling("gear", "linear", "fast", "slow", ratio, 0.0)])


@pytest.mark.parametrize(
    ("ratio", "kind", "reason"),
    [
        (-0.25, "revolute", None),
        (math.sqrt(2), "revolute", "the joints that follow it do not return within 16 turns"),
        (1 / 17, "revolute", "the joints that follow it do not return within 16 turns"),
        (3.0, "slider", "a joint that follows it slides without limits"),
    ],
)
def test_a_sweep_says_which_part_of_an_endless_motion_it_samples(ratio: float, kind: str, reason: str | None) -> None:
    report = sweep({"arm": box(2, 2, 2), "crank": box(1, 1, 1)}, coupled(ratio, kind), steps=8)
    found = [finding.message for finding in report.findings.of("I_NOT_SAMPLED")]
    assert [said.rpartition("only: ")[2] for said in found] == ([] if reason is None else [f"{reason}."])


def test_a_sweep_says_that_a_slide_without_limits_goes_on() -> None:
    mechanism = Mechanism(("frame", "car"), "frame", [joint("way", "slider", "frame", "car", lower=(-math.inf,), upper=(math.inf,))])
    report = sweep({"car": box(2, 2, 2), "frame": box(2, 2, 2).transformed(at(0, 0, 500))}, mechanism, steps=8)
    (said,) = report.findings.of("I_NOT_SAMPLED")
    assert "it slides without limits" in said.message
    assert said.where == "joints.way"


def test_least_clearances_look_into_every_turn_of_a_driver() -> None:
    """A crank returns to the same place after each of sixteen turns, and passes a post between them."""
    meshes = {"crank": box(40, 4, 4).transformed(at(20)), "post": box(4, 4, 4).transformed(at(-45))}
    motion = MotionSampler(Scene.of(meshes, (mechanism := coupled(1 / 16)).joints), mechanism)
    for quick in (False, True):
        (row,) = least_clearances(motion, quick=quick)
        assert row.gap == pytest.approx(43 - math.hypot(40, 2), abs=0.03 if quick else 1e-3)  # the crank is 4 mm wide
