"""Ranges that sweeps sample: all of what an endless driver and its followers do, and nothing that limits or cones forbid."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from articad.certificates.fits import followed
from articad.connectors import SE3
from articad.export.contacts import poses_in_motion
from articad.geometry import box, cylinder
from articad.interference.clearance import least_clearances
from articad.interference.sampled_ranges import ENDLESS_SAMPLED_MM, MOST_TURNS, sampled_ranges
from articad.interference.scene import Scene
from articad.interference.sweep import MotionSampler, sweep
from articad.kinematics import Coupling
from articad.kinematics.joints import Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, fixed, joint

BELOW, ABOVE = (-math.inf,), (math.inf,)


def geared(ratio: float, *, slow_limits: tuple[float, float] = (-math.inf, math.inf), rest: float = 0.0) -> Mechanism:
    """A fast crank that drives, and an arm that follows at a ratio; the post stands on the frame."""
    joints = [
        joint("fast", "revolute", "frame", "crank", lower=BELOW, upper=ABOVE, rest=(rest,)),
        joint("slow", "revolute", "frame", "arm", lower=slow_limits[:1], upper=slow_limits[1:], rest=(ratio * rest,)),
        fixed("held", "frame", "post"),
    ]
    return Mechanism(("frame", "crank", "arm", "post"), "frame", joints, [Coupling("gear", "linear", "fast", "slow", ratio, 0.0)])


@pytest.mark.parametrize("ratio", [0.25, -0.5, 2.0, 1 / 3, 1.5, -2.5])
def test_an_endless_driver_is_sampled_until_all_that_follows_has_come_back(ratio: float) -> None:
    (fast,) = sampled_ranges(geared(ratio, rest=0.3))
    turns = Fraction(ratio).limit_denominator(100).denominator
    assert fast.upper - fast.lower == pytest.approx(2 * math.pi * turns)
    assert (fast.lower + fast.upper) / 2 == pytest.approx(0.3)


def test_a_driver_whose_follower_never_comes_back_is_sampled_over_many_turns() -> None:
    (fast,) = sampled_ranges(geared(math.sqrt(2)))
    assert fast.upper - fast.lower == pytest.approx(2 * math.pi * MOST_TURNS)


def test_a_slow_arm_that_a_fast_crank_brings_round_is_seen_to_hit_a_post() -> None:
    """The arm, at 1:4, meets the post at half a turn of its own: two turns of the crank away from rest."""
    arm = box(100, 6, 6, center=False).transformed(at(4, -3, -3))
    post = cylinder(3, 60, 24).transformed(at(-70, 0))
    report = sweep({"arm": arm, "post": post}, geared(0.25))
    (finding,) = report.findings
    assert finding.pose is not None
    assert abs(finding.pose["fast"]) == pytest.approx(4 * math.pi, abs=0.7)


@pytest.mark.parametrize("ratio", [0.25, -0.5, 1 / 3])
def test_fits_and_contacts_look_at_all_that_a_slow_follower_does(ratio: float) -> None:
    """The arm needs several turns of the crank for one of its own."""
    mechanism = geared(ratio, rest=0.3)
    low, high = followed(mechanism)["slow"]
    assert (low, high) == pytest.approx((0.3 * ratio - math.pi, 0.3 * ratio + math.pi))
    arm = poses_in_motion(mechanism)[:, mechanism.part_index("arm")]
    angles = np.sort(np.arctan2(arm[:, 1, 0], arm[:, 0, 0]))
    assert np.diff(np.append(angles, angles[0] + 2 * math.pi)).max() < math.radians(31) * abs(ratio)


def test_fits_and_contacts_look_as_far_as_a_followers_limit() -> None:
    mechanism = geared(0.5, slow_limits=(-0.4, math.pi / 3))
    assert followed(mechanism)["slow"] == pytest.approx((-0.4, math.pi / 3), abs=1e-6)
    arm = poses_in_motion(mechanism)[:, mechanism.part_index("arm")]
    angles = np.arctan2(arm[:, 1, 0], arm[:, 0, 0])
    assert (angles.min(), angles.max()) == pytest.approx((-0.4, math.pi / 3), abs=1e-6)


def test_a_followers_limits_end_the_range_of_an_endless_driver() -> None:
    """The arm stops at 60° before the post at 90°."""
    arm = box(100, 6, 6, center=False).transformed(at(4, -3, -3))
    post = cylinder(3, 60, 24).transformed(at(0, 70))
    mechanism = geared(0.5, slow_limits=(-0.4, math.pi / 3))
    (fast,) = sampled_ranges(mechanism)
    assert (fast.lower, fast.upper) == pytest.approx((-0.8, 2 * math.pi / 3), abs=1e-6)
    assert sweep({"arm": arm, "post": post}, mechanism).ok
    assert not sweep({"arm": arm, "post": post}, geared(0.5, slow_limits=(-0.4, 2.0))).ok


@pytest.mark.parametrize(("lower", "upper"), [(-math.inf, math.inf), (-0.5, math.inf), (-math.inf, 0.5)])
def test_an_endless_screw_is_sampled_as_far_as_a_slide_without_limits(lower: float, upper: float) -> None:
    lead, nut = 20.0, box(10, 10, 10)
    screw = joint("feed", "screw", "frame", "nut", lower=(lower,), upper=(upper,), lead=lead)
    (feed,) = sampled_ranges(Mechanism(("frame", "nut"), "frame", [screw]))
    per_mm = 2 * math.pi / lead
    assert feed.lower == pytest.approx(max(lower, -ENDLESS_SAMPLED_MM * per_mm))
    assert feed.upper == pytest.approx(min(upper, ENDLESS_SAMPLED_MM * per_mm))
    # a post 70 mm along the way, three and a half turns from rest, is met on the side that goes on
    for side in (-1, 1):
        mechanism = Mechanism(("frame", "nut", "post"), "frame", [screw, fixed("held", "frame", "post")])
        goes_on = math.isinf(upper if side > 0 else lower)
        report = sweep({"nut": nut, "post": cylinder(8, 6, 24).transformed(at(z=side * 70))}, mechanism)
        assert report.ok != goes_on


def test_what_an_endless_driver_pushes_along_is_sampled_as_far_as_a_slide_without_limits() -> None:
    """Rack and pinion without limits: 5 mm for each radian."""
    joints = [
        joint("pinion", "revolute", "frame", "wheel", lower=BELOW, upper=ABOVE),
        joint("rack", "slider", "frame", "bar", lower=BELOW, upper=ABOVE),
    ]
    mechanism = Mechanism(("frame", "wheel", "bar"), "frame", joints, [Coupling("mesh", "linear", "pinion", "rack", 5.0, 0.0)])
    (pinion,) = sampled_ranges(mechanism)
    assert 5.0 * (pinion.upper - pinion.lower) == pytest.approx(2 * ENDLESS_SAMPLED_MM)


def test_what_is_reached_is_sampled_where_not_all_is_and_that_is_said() -> None:
    """A four-bar whose crank cannot go round: a post within its reach is found, and the rest of its declared turn is reported."""
    lengths = crank, rod, rocker, base = 60.0, 50.0, 70.0, 100.0
    assert min(lengths) + max(lengths) > sum(sorted(lengths)[1:3])  # no link goes round (Grashof)
    tip = np.array([0.0, crank])
    far = np.array([base, 0.0])
    away = float(np.linalg.norm(far - tip))
    along = (rod**2 - rocker**2 + away**2) / (2 * away)
    way = (far - tip) / away
    knee = tip + along * way + math.sqrt(rod**2 - along**2) * np.array([-way[1], way[0]])
    places = [SE3.from_translation([*place, 0.0]) for place in ((0.0, 0.0), tip, knee, far)]
    names = ["crank", "rod", "rocker"]
    ends = [("frame", "crank"), ("crank", "rod"), ("rod", "rocker"), ("frame", "rocker")]
    joints: list[Joint] = [
        joint(f"j{k}", "revolute", a, b, at_parent=place, at_child=place, lower=BELOW, upper=ABOVE)
        for k, ((a, b), place) in enumerate(zip(ends, places, strict=True))
    ]
    mechanism = Mechanism(("frame", *names, "post"), "frame", [*joints, fixed("held", "frame", "post")])
    bar = box(6, crank, 6, center=False).transformed(at(-3, 0, -3))
    for angle, is_reached in ((-0.6, True), (1.5, False)):  # from upright
        post = cylinder(3, 60, 24).transformed(at(-30 * math.sin(angle), 30 * math.cos(angle)))
        report = sweep({"crank": bar, "post": post}, mechanism, joints=["j0"])
        assert report.findings.of("E_NOT_CHECKED")
        assert bool(report.findings.of("E_MOTION_COLLISION")) == is_reached


def test_a_grid_keeps_a_ball_within_its_cone() -> None:
    """The post stands where only both swings at their largest, which the cone forbids, would bring the bar."""
    cone = 0.6
    knuckle = joint("knuckle", "ball", "frame", "bar", cone=cone)
    mechanism = Mechanism(("frame", "bar", "post"), "frame", [knuckle, fixed("held", "frame", "post")])
    bar = cylinder(2, 80, 12).transformed(at(z=60))
    outside = cone * math.sqrt(2)
    direction = np.array([math.sin(outside) / math.sqrt(2), -math.sin(outside) / math.sqrt(2), math.cos(outside)])
    post = box(6, 6, 6).transformed(SE3.from_translation(90 * direction))
    meshes = {"bar": bar, "post": post}
    joints = [knuckle, fixed("held", "frame", "post")]
    assert sweep(meshes, mechanism, steps=100, together=True, samples=200).ok
    (row,) = least_clearances(MotionSampler(Scene.of(meshes, joints), mechanism))
    assert row.gap > 1
    assert math.hypot(row.pose.get("knuckle.sx", 0.0), row.pose.get("knuckle.sy", 0.0)) <= cone * (1 + 1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_the_least_clearance_of_a_ball_over_a_plate_is_the_closed_form(seed: int) -> None:
    """A ball on two hinged links over a plate: its height is a sum of sines, least where both point down."""
    rng = np.random.default_rng(seed)
    upper, fore, height = rng.uniform(40, 80), rng.uniform(20, 40), 300.0
    limits = rng.uniform(0.2, 1.0, 2), rng.uniform(0.2, 0.9, 2)
    joints = [
        joint("shoulder", "revolute", "frame", "upper", lower=(-limits[0][0],), upper=(limits[0][1],)),
        joint("elbow", "revolute", "upper", "fore", at_parent=at(upper), lower=(-limits[1][0],), upper=(limits[1][1],)),
    ]
    mechanism = Mechanism(("frame", "upper", "fore"), "frame", joints)
    meshes = {"frame": box(1000, 10, 1000).transformed(at(0, -height)), "fore": box(0.2, 0.2, 0.2).transformed(at(fore))}
    turns = np.stack(np.meshgrid(*(np.linspace(-lo, hi, 801) for lo, hi in limits), indexing="ij")).reshape(2, -1)
    corners = [np.array([fore + x, y]) for x in (-0.1, 0.1) for y in (-0.1, 0.1)]
    lowest = min(float((upper * np.sin(turns[0]) + c[0] * np.sin(turns.sum(0)) + c[1] * np.cos(turns.sum(0))).min()) for c in corners)
    (row,) = least_clearances(MotionSampler(Scene.of(meshes, joints), mechanism))
    assert row.gap == pytest.approx(height - 5 + lowest, abs=1e-2)
    assert row.to_json()["strength"]["kind"] == "sampled"


@pytest.mark.parametrize("quick", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_a_least_clearance_between_samples_is_the_closed_form(seed: int, quick: bool) -> None:
    """The tip of two hinged links passes a needle beyond its reach: it is nearest where both links point at the needle, between samples."""
    rng = np.random.default_rng([seed, 7])
    upper, fore, room, bearing = rng.uniform(40, 80), rng.uniform(20, 40), rng.uniform(3, 6), rng.uniform(-0.5, 0.5)
    rest = float(rng.uniform(0.2, 0.6))
    joints = [
        joint("shoulder", "revolute", "frame", "upper", lower=(-rng.uniform(1.2, 1.6),), upper=(rng.uniform(1.2, 1.6),)),
        joint(
            "elbow",
            "revolute",
            "upper",
            "fore",
            at_parent=at(upper),
            lower=(-rng.uniform(0.8, 1.6),),
            upper=(rng.uniform(0.8, 1.6),),
            rest=(rest,),
        ),
    ]
    mechanism = Mechanism(("frame", "upper", "fore"), "frame", joints)
    needle = at(*((upper + fore + room) * np.array([math.cos(bearing), math.sin(bearing)])))
    meshes = {"frame": cylinder(0.01, 40).transformed(needle), "fore": cylinder(0.01, 40).transformed(at(fore))}
    (row,) = least_clearances(MotionSampler(Scene.of(meshes, joints), mechanism), quick=quick)
    assert row.gap == pytest.approx(room, abs=0.02 + (0.01 * room if quick else 0.0))
    assert quick or row.pose["shoulder"] == pytest.approx(bearing, abs=0.05)
