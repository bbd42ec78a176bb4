from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from articad.connectors import SE3
from articad.errors import KinematicsError, UnknownJointError
from articad.kinematics import Coupling, Joint, JointLimits, JointType, Mechanism, continuation
from articad.kinematics.continuation import Follower
from articad.kinematics.track import Track
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad_bench.task import TASKS
from tests.kinematics.linkages import (
    at,
    bennett,
    four_bar,
    four_bar_angles,
    from_rest,
    gear_train,
    geared_four_bar,
    joint,
    misaligned,
    mismatch,
    parallelogram,
    scissor,
    slider_crank,
    stewart,
    watt,
)

DEAD_POINT = math.radians(72.5423968763)


def rocker_errors(values: np.ndarray, rocker: np.ndarray, lengths: tuple[float, float, float, float]) -> float:
    exact = np.array([four_bar_angles(*lengths, v)[1] for v in values])
    return float(np.abs((rocker - exact + math.pi) % (2 * math.pi) - math.pi).max())


# --- sweeps


def test_a_full_turn_in_361_steps_stays_closed_and_on_its_branch() -> None:
    mechanism = four_bar()
    sweep = mechanism.drive("crank", 0.0, 2 * math.pi, 361)
    assert sweep.ok
    assert len(sweep.values) == 361
    assert rocker_errors(sweep.values, sweep.configuration["rocker"][:, 0], (30, 90, 70, 100)) < 1e-12
    poses = sweep.poses()
    assert poses.batch_shape == (361, 4)
    assert poses[60].allclose(mechanism.poses([sweep.values[60]]), mm=1e-10, rad=1e-12)
    assert sweep.strength == "sampled"
    assert "certify=True" in sweep.reason


@pytest.mark.parametrize("make", [four_bar, slider_crank, bennett, watt, geared_four_bar])
def test_a_certified_sweep_says_so_and_is_the_same_motion(make: object) -> None:
    mechanism: Mechanism = make()  # type: ignore[operator]
    name, start = mechanism.drivers[0].name, float(mechanism.rest[0])
    proved = mechanism.drive(name, start, start + 0.5, 21, certify=True)
    assert proved.strength == "certified"
    assert "Kantorovich" in proved.reason
    assert 0 < proved.tube < 0.04
    sampled = mechanism.drive(name, start, start + 0.5, 21)
    assert np.allclose(proved.configuration.columns, sampled.configuration.columns, rtol=0, atol=1e-9)


def test_a_certified_full_turn_takes_few_hundred_steps_and_its_tube_holds_the_motion() -> None:
    mechanism = four_bar()
    sweep = mechanism.drive("crank", 1.0, 1.0 + 2 * math.pi, 100, certify=True)
    assert sweep.strength == "certified"
    assert sweep.tube < 0.034
    track = mechanism.branch.groups[0].track(0, certify=True)
    nodes = track.side(1.0 + 2 * math.pi).nodes
    assert 150 < len(nodes) < 400
    for a, b in zip(nodes[:-1:10], nodes[1::10], strict=False):
        predicted = a.Q + (b.s - a.s) * a.rate
        assert np.linalg.norm(predicted - b.Q) <= track.follower.tube(a, np.asarray(b.s - a.s))


@pytest.mark.parametrize("epsilon", [1e-2, 1e-4, 1e-6])
def test_near_a_change_point_no_step_falls_onto_the_other_branch(epsilon: float) -> None:
    lengths = (30.0, 80.0, 50 + epsilon, 100.0)
    sweep = four_bar(*lengths, crank=1.0).drive("crank", 1 - 2 * math.pi, 1 + 2 * math.pi, 361)
    assert sweep.ok
    assert rocker_errors(sweep.values, sweep.configuration["rocker"][:, 0], lengths) < 3e-9


@pytest.mark.parametrize(("sigma", "orientation", "stays"), [(True, False, True), (False, True, True), (False, False, False)])
def test_either_guard_alone_keeps_the_branch_and_none_loses_it(
    monkeypatch: pytest.MonkeyPatch, sigma: bool, orientation: bool, stays: bool
) -> None:
    monkeypatch.setattr(continuation, "_CORRECTOR_SHARE", 1e9)
    if not sigma:
        monkeypatch.setattr(continuation, "_SIGMA_SHARE", 1e9)
    if not orientation:
        monkeypatch.setattr(Follower, "_orientation", lambda self, _, lin: (lin.U[:, : self.rank], 0.0))
    lengths = (30.0, 80.0, 50.0001, 100.0)
    sweep = four_bar(*lengths, crank=1.0).drive("crank", 1 - 2 * math.pi, 1 + 2 * math.pi, 181)
    error = rocker_errors(sweep.values, sweep.configuration["rocker"][:, 0], lengths)
    assert (error < 3e-9) is stays
    if not stays:
        assert error == pytest.approx(2.8548, abs=1e-3)


def test_a_step_whose_corrector_is_as_long_as_its_predictor_is_refused() -> None:
    follower = four_bar(60, 50, 50, 100, crank=0.3).branch.groups[0].track(0).follower
    start = follower.system.layout.rest
    direction = np.array([1.0, 0, 0, 0])
    lin = follower.linearized(start)
    node = follower.node(0.0, start, lin, direction)
    assert follower._step(node, 0.1, direction, lin.U[:, :3], 0.0, last=False) is not None
    assert follower._step(node, 0.9, direction, lin.U[:, :3], 0.0, last=False) is None  # nearly at the dead point
    assert follower._step(node, 3.0, direction, lin.U[:, :3], 0.0, last=False) is None  # beyond it: nothing closes


def test_many_turns_repeat_the_first_and_angles_go_on_counting() -> None:
    mechanism = four_bar()
    far = 1.3 + 2 * math.pi * 100_000
    near, there = mechanism.configuration([1.3]), mechanism.configuration([far])
    assert there["crank"][0] == far
    assert there["rocker"][0] == pytest.approx(near["rocker"][0], abs=1e-9)
    assert there["pin_b"][0] == pytest.approx(near["pin_b"][0] - 2 * math.pi * 100_000, abs=1e-9)
    assert mechanism.poses([-far]).allclose(mechanism.poses([-1.3]), mm=1e-6, rad=1e-9)
    geared = geared_four_bar()
    assert geared.poses([0.4 + 40 * math.pi]).allclose(geared.poses([0.4]), mm=1e-9, rad=1e-11)
    assert geared.branch.groups[0].track(0).period(1).length == pytest.approx(4 * math.pi)  # type: ignore[union-attr]
    assert four_bar(60, 50, 50, 100, crank=0.3).branch.groups[0].track(0).period(1) is None


def test_a_driver_traced_over_many_turns_first_follows_the_same_ratio_as_one_traced_turn_by_turn() -> None:
    limits = [(-10 * math.pi, 10 * math.pi)]
    one = joint("one", "screw", ("frame", at(0)), ("nut", at(0)), limits=limits, driver=True, lead=2)
    other = joint("other", "screw", ("nut", at(0)), ("eye", at(0)), limits=limits, lead=-2)
    mechanism = Mechanism(["frame", "nut", "eye"], "frame", [one, other], [Coupling("still", "linear", "one", "other", -1.0, 0.0)])

    reached = mechanism.feasible_range("one")

    assert (reached.lower, reached.upper) == limits[0]
    assert mechanism.configuration([20.0])["other"][0] == pytest.approx(-20.0, abs=1e-9)


def test_a_sweep_ends_at_a_dead_point_and_says_where() -> None:
    mechanism = four_bar(60, 50, 50, 100, crank=0.3)
    sweep = mechanism.drive("crank", -math.pi / 2, math.pi / 2, 181)
    assert not sweep.ok
    assert sweep.findings.codes == ("E_DEAD_POINT", "E_DEAD_POINT")
    assert sorted(f.value or 0 for f in sweep.findings) == pytest.approx([-DEAD_POINT, DEAD_POINT], abs=1e-11)
    assert np.abs(sweep.values).max() <= DEAD_POINT
    assert len(sweep.values) == 145  # whole degrees up to 72
    proof = mechanism.drive("crank", 0.3, math.pi / 2, 30, certify=True)
    assert proof.findings.codes == ("E_DEAD_POINT",)
    assert proof.strength in {"certified", "sampled"}


def test_values_next_to_a_dead_point_are_on_the_side_of_the_rest_pose() -> None:
    mechanism = four_bar(60, 50, 50, 100, crank=0.3)
    values = DEAD_POINT - np.array([1e-3, 1e-5, 1e-7, 1e-9])
    for value in values:
        rocker = mechanism.configuration([value])["rocker"][0]
        # the angle depends on the square root of the distance, so rounding of 1e-16 shows as 1e-8
        assert rocker == pytest.approx(four_bar_angles(60, 50, 50, 100, value)[1], abs=1e-7)
    end = mechanism.feasible_range("crank").upper
    assert mismatch(mechanism, np.array([end]))[0] < 1e-8


def test_near_the_dead_point_the_proof_ends_and_says_why() -> None:
    mechanism = four_bar(60, 50, 50, 100, crank=0.3)
    trace = mechanism.branch.groups[0].track(0, certify=True).side(2.0)
    sweep = mechanism.drive("crank", 0.3, 0.3 + (trace.nodes[-1].s + trace.end) / 2, 20, certify=True)
    assert sweep.strength == "sampled"
    assert "it holds up to 72.54" in sweep.reason


def test_a_sweep_reports_limits_of_the_joints_that_follow() -> None:
    plain = slider_crank(travel=(80.0, 150.0))
    sweep = plain.drive("crank", 0.0, math.pi, 91)
    (found,) = sweep.findings
    assert found.code == "E_LOOP_LIMIT"
    assert found.where == "joints.piston"
    assert "joint 'piston' leaves [80.000 mm, 150.000 mm]" in found.message
    assert found.pose is not None
    assert found.pose["crank"] == pytest.approx(math.pi)
    assert len(sweep.values) == 91


def test_a_sweep_of_a_tree_is_exact() -> None:
    arm = Mechanism(("a", "b"), "a", [joint("j", "revolute", ("a", at(0)), ("b", at(5)), limits=[(-1.0, 1.0)])])
    sweep = arm.drive("j", -1.0, 1.0, 5)
    assert (sweep.strength, sweep.reason) == ("certified", "a tree has one branch")
    assert sweep.values.tolist() == [-1, -0.5, 0, 0.5, 1]
    assert sweep.poses()[2].allclose(arm.poses(arm.rest))
    reached = arm.feasible_range("j")
    assert (reached.lower, reached.upper, reached.lower_reason) == (-1.0, 1.0, "declared limit")
    assert arm.motion_findings().ok


@pytest.mark.parametrize(("lo", "hi", "steps"), [(0.0, math.inf, 5), (math.nan, 1.0, 5), (0.0, 1.0, 0)])
def test_a_sweep_without_ends_or_steps_is_refused(lo: float, hi: float, steps: int) -> None:
    with pytest.raises(KinematicsError, match="finite ends"):
        four_bar().drive("crank", lo, hi, steps)


def test_a_driver_that_is_none_is_refused_by_name() -> None:
    with pytest.raises(UnknownJointError, match="Did you mean 'crank'"):
        four_bar().drive("crnk", 0, 1)
    with pytest.raises(UnknownJointError):
        four_bar().feasible_range("rocker")
    with pytest.raises(UnknownJointError):
        four_bar().drive("crank", 0, 1, at={"rocker": 1.0})


def test_a_sweep_starts_from_where_the_other_drivers_are() -> None:
    mechanism = stewart()
    sweep = mechanism.drive("leg0", 135.0, 145.0, 5, at={"leg3": 140.0})
    assert np.allclose(sweep.configuration["leg3"], 140.0)
    for i, value in enumerate(sweep.values):
        q = mechanism.rest.copy()
        q[0], q[3] = value, 140.0
        assert sweep.poses()[i].allclose(mechanism.poses(q), mm=1e-8, rad=1e-10)


# --- ranges


def test_a_crank_that_turns_for_ever_has_no_range() -> None:
    for mechanism in (four_bar(), slider_crank(), bennett(), geared_four_bar()):
        reached = mechanism.feasible_range(mechanism.drivers[0].name)
        assert (reached.lower, reached.upper) == (-math.inf, math.inf)
        assert (reached.lower_reason, reached.upper_reason) == ("endless", "endless")
        assert reached.findings.ok


def test_dead_points_end_a_range_to_the_last_digit_and_give_the_limits_to_set() -> None:
    reached = four_bar(60, 50, 50, 100, crank=0.3, limits=(-math.pi / 2, math.pi / 2)).feasible_range("crank")
    assert (reached.lower, reached.upper) == pytest.approx((-DEAD_POINT, DEAD_POINT), abs=1e-11)
    assert reached.upper_reason == "dead point"
    found = reached.findings[0]
    assert found.code == "E_DEAD_POINT"
    assert "is declared [-90.000°, 90.000°], but the loop reaches only [-72.542°, 72.542°]" in found.message
    assert "[-72.542, 72.542] deg" in found.hint


def test_an_endless_crank_with_dead_points_just_follows_the_loop() -> None:
    reached = four_bar(60, 50, 50, 100, crank=0.3).feasible_range("crank")
    assert (reached.lower, reached.upper) == pytest.approx((-DEAD_POINT, DEAD_POINT), abs=1e-11)
    assert reached.findings.ok


def test_a_driver_that_ends_on_one_side_only_is_advised_no_infinite_limit() -> None:
    free, bounded = math.inf, 3.0
    joints = [
        joint("motor", "revolute", ("frame", at(0)), ("wheel", at(0)), driver=True, limits=[(-free, 10.0)]),
        joint("arm", "revolute", ("frame", at(50)), ("lever", at(0)), limits=[(-free, bounded)]),
    ]
    pair = Mechanism(("frame", "wheel", "lever"), "frame", joints, [Coupling("belt", "belt", "motor", "arm", 1.0)])
    (found,) = pair.feasible_range("motor").findings
    assert found.hint == "Set the upper limit to 171.887°."
    assert "inf" not in found.hint


def test_a_limit_of_a_following_joint_ends_the_range_where_it_is_met() -> None:
    mechanism = slider_crank(travel=(80.0, 150.0))
    reached = mechanism.feasible_range("crank")
    assert reached.upper_reason == reached.lower_reason == "limit of piston"
    assert mechanism.configuration([reached.upper])["piston"][0] == pytest.approx(80.0, abs=1e-7)
    assert mechanism.configuration([reached.lower])["piston"][0] == pytest.approx(80.0, abs=1e-7)
    assert set(mechanism.motion_findings().codes) == {"E_LOOP_LIMIT"}


def test_a_limit_below_the_declared_range_and_one_at_rest_are_told_apart() -> None:
    within = four_bar(limits=(math.radians(60), 2.0)).feasible_range("crank")
    assert (within.lower, within.lower_reason) == (math.radians(60), "declared limit")
    assert (within.upper, within.upper_reason) == (2.0, "declared limit")
    already = slider_crank(travel=(119.4427190999, 150.0)).feasible_range("crank")
    assert already.lower == pytest.approx(0.0, abs=1e-9)
    assert already.lower_reason == "limit of piston"
    assert mechanism_x(already.upper) == pytest.approx(119.4427190999, abs=1e-7)


def mechanism_x(crank: float) -> float:
    return 30 * math.cos(crank) + math.sqrt(90**2 - (10 - 30 * math.sin(crank)) ** 2)


def test_a_ball_that_follows_has_its_cone_and_twist_kept() -> None:
    plain = stewart()
    tight = [
        replace(j, limits=JointLimits(cone=math.radians(10), twist=(-0.2, 0.2))) if j.type is JointType.BALL else j for j in plain.joints
    ]
    reached = Mechanism(plain.parts, "base", tight).feasible_range("leg0")
    assert ".swing" in reached.upper_reason or ".twist" in reached.upper_reason


def test_a_singular_configuration_ends_the_range_of_a_scissor_and_of_a_parallelogram() -> None:
    reached = scissor(2).feasible_range("lift")
    assert (reached.lower, reached.upper) == pytest.approx((0, math.pi / 2), abs=1e-4)
    assert (reached.lower_reason, reached.upper_reason) == ("singular", "singular")
    assert set(reached.findings.codes) == {"E_SINGULAR"}
    stopped = parallelogram(1.0).drive("crank", 1.0, 4.0, 10)
    assert stopped.findings.codes == ("E_SINGULAR",)
    assert parallelogram(0.0).feasible_range("crank").upper_reason == "singular"


def test_an_unlimited_slider_is_followed_to_its_dead_point() -> None:
    plain = slider_crank(crank=0.5)
    driven = Mechanism(plain.parts, "frame", [replace(j, driver=j.name == "piston") for j in plain.joints])
    reached = driven.feasible_range("piston")
    assert reached.upper == pytest.approx(math.sqrt(120**2 - 10**2), abs=1e-9)
    assert reached.upper_reason == "dead point"
    assert reached.lower == pytest.approx(math.sqrt(60**2 - 10**2), abs=1e-9)


def test_couplings_alone_are_endless_and_the_limits_of_what_they_tie_are_exact() -> None:
    """They are linear: nothing bars the way but a limit, and that needs no steps, however far it is."""
    plain = gear_train()
    driven = Mechanism(plain.parts, "frame", [replace(j, driver=j.name == "rack") for j in plain.joints], plain.couplings)
    assert driven.feasible_range("rack").upper_reason == "endless"
    assert plain.feasible_range("gear_a").lower == -math.inf
    far = 1e6
    limited = [replace(j, limits=JointLimits((-math.inf,), (far,))) if j.name == "rack" else j for j in plain.joints]
    reached = Mechanism(plain.parts, "frame", limited, plain.couplings).feasible_range("gear_a")
    assert reached.upper == math.inf
    assert reached.lower_reason == "limit of rack"
    assert reached.lower == pytest.approx(((far + 3) / 30 - 0.1) / (-20 / 30), rel=1e-12)  # the rack moves against gear_a


def test_what_comes_back_is_everything_not_the_loop_alone() -> None:
    """The crank turns twice per turn of the motor: the loop is back after half a turn, the motor's own arm is not."""
    plain = geared_four_bar()
    track = Mechanism(plain.parts, "frame", plain.joints, [replace(plain.couplings[0], ratio=2.0)]).branch.groups[0].track(0)
    assert track.repeat(1).length == pytest.approx(math.pi)  # type: ignore[union-attr]
    assert track.period(1).length == pytest.approx(2 * math.pi)  # type: ignore[union-attr]
    never = Mechanism(plain.parts, "frame", plain.joints, [replace(plain.couplings[0], ratio=math.sqrt(2))]).branch.groups[0].track(0)
    assert never.repeat(1).length == pytest.approx(math.sqrt(2) * math.pi)  # type: ignore[union-attr]
    assert never.period(1) is None


def test_a_loop_behind_an_irrational_gear_turns_for_ever() -> None:
    plain = geared_four_bar()
    geared = Mechanism(plain.parts, "frame", plain.joints, [replace(plain.couplings[0], ratio=math.sqrt(2))])
    reached = geared.feasible_range("motor")
    assert (reached.lower, reached.upper, reached.upper_reason) == (-math.inf, math.inf, "endless")
    motor = 2 * math.pi * 2000
    crank = math.sqrt(2) * motor + math.radians(60)
    rocker = four_bar_angles(30, 90, 70, 100, crank)[1]
    turn = geared.poses([motor])[geared.part_index("rocker")]
    assert turn.matrix[0, 0] == pytest.approx(math.cos(rocker), abs=1e-9)
    assert max(mismatch(geared, np.array([motor]))) < 1e-9


@pytest.mark.parametrize("small", [5e-2, 5e-3, 5e-5])
def test_a_small_loop_among_large_ones_turns_for_ever(small: float) -> None:
    """Links of 6 to 20 m, and a latch of millimetres on the same frame: each loop has its own length."""
    large, latch = four_bar(6000, 18000, 14000, 20000), four_bar(30 * small, 90 * small, 70 * small, 100 * small)
    names = {"crank": "latch_crank", "coupler": "latch_coupler", "rocker": "latch_rocker", "frame": "frame"}
    joints = [replace(j, name=f"latch_{j.name}", parent=names[j.parent], child=names[j.child]) for j in latch.joints]
    both = Mechanism((*large.parts, *(names[p] for p in latch.parts[1:])), "frame", [*large.joints, *joints])
    assert both.mobility == 2
    for driver in ("crank", "latch_crank"):
        assert both.feasible_range(driver).upper_reason == "endless"
    assert len(both.branch.groups[1].track(0).side(6.0).nodes) < 100


def test_running_out_of_steps_is_no_singularity(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.kinematics.continuation._MOST_STEPS", 3)
    mechanism = four_bar(limits=(-3.0, 3.0))
    reached = mechanism.feasible_range("crank")
    assert reached.upper_reason == "not followed further"
    assert {f.code for f in reached.findings} == {"E_NOT_FOLLOWED"}
    with pytest.raises(KinematicsError, match=r"E_NOT_FOLLOWED.*not further") as caught:
        mechanism.poses([3.0])
    assert "singular" not in str(caught.value)


# --- findings


def test_redundant_constraints_are_named_and_a_release_is_proposed() -> None:
    mechanism = four_bar()
    (one,) = mechanism.redundancy()
    assert one.count == 3
    assert one.directions == ("sliding along z", "turning about x", "turning about y")
    assert sorted(new for _, new in one.release) == ["ball", "cylindrical"]
    (found,) = mechanism.findings()
    assert found.code == "I_REDUNDANT"
    assert "is held 3 times more than its motion needs: against sliding along z, turning about x, turning about y" in found.message
    assert "to ball and" in found.hint
    released = released_from(mechanism, dict(one.release))
    assert released.mobility == 1
    assert released.redundancy() == ()
    assert released.grubler == 1


def released_from(mechanism: Mechanism, release: dict[str, JointType]) -> Mechanism:
    """Return the mechanism with the proposed joints, which rest where the old ones did."""
    joints = []
    for j in mechanism.joints:
        new = release.get(j.name)
        if new is JointType.BALL:
            joints.append(replace(j, type=new, limits=JointLimits(), rest=tuple(SE3.rot_z(j.rest[0]).quaternion)))
        elif new is JointType.CYLINDRICAL:
            joints.append(replace(j, type=new, limits=JointLimits((-math.inf,) * 2, (math.inf,) * 2), rest=(0.0, j.rest[0])))
        else:
            joints.append(j)
    return Mechanism(mechanism.parts, mechanism.ground, joints)


def test_a_released_loop_closes_in_spite_of_a_tilted_axis() -> None:
    one = four_bar().redundancy()[0]
    tilted = four_bar(tilt=math.radians(1.0))
    released = released_from(tilted, dict(one.release))
    gap, turn = mismatch(released, released.rest + 0.3)
    assert gap < 1e-9
    assert turn < 1e-10


def test_redundancy_of_couplings_larger_mechanisms_and_trees() -> None:
    assert gear_train().redundancy() == ()
    assert len(scissor(10).findings().of("I_REDUNDANT")) == 11
    assert "ball or cylindrical" in scissor(10).findings().of("I_REDUNDANT")[0].hint
    assert Mechanism(("a",), "a", []).redundancy() == ()
    crank = slider_crank().redundancy()[0]
    assert sum({"ball": 2, "cylindrical": 1}[new] for _, new in crank.release) == 3


def test_a_slightly_tilted_axis_locks_the_loop_and_is_named() -> None:
    mechanism = misaligned(math.radians(0.01))
    assert mechanism.mobility == 0
    (found,) = mechanism.findings().of("E_LOOP_LOCKED")
    assert "driver 'crank' cannot move" in found.message
    assert "coupler.pin_c_on_coupler, tilted by 0.010°" in found.message
    assert found.value is not None
    assert 1e-6 < found.value < 1e-3
    assert misaligned(0.0).findings().ok


def test_links_in_line_that_cannot_fold_are_shaky() -> None:
    joints = [
        from_rest("crank", "revolute", "g", "a", at(0), driver=True),
        from_rest("b", "revolute", "a", "b", at(30)),
        from_rest("c", "revolute", "b", "c", at(60)),
        from_rest("d", "revolute", "g", "c", at(100)),
    ]
    mechanism = Mechanism(("g", "a", "b", "c"), "g", joints)
    assert mechanism.branch.analysis.first_order >= 1
    assert mechanism.mobility == 0
    assert "W_SHAKY" in mechanism.findings().codes


def test_a_leg_that_may_spin_is_reported_as_idle() -> None:
    found = stewart("ball").findings().of("W_IDLE_FREEDOM")
    assert [f.parts for f in found] == [(f"lower{i}", f"upper{i}") for i in range(6)]
    assert stewart().findings().of("W_IDLE_FREEDOM") == ()


def test_a_rest_pose_near_a_singularity_is_reported() -> None:
    (found,) = four_bar(30, 80, 50.0001, 100, crank=math.pi).findings().of("W_NEAR_SINGULAR")
    assert "near-singular" in found.message


# --- reaching


def test_an_arm_reaches_a_pose_or_a_point_within_its_limits() -> None:
    shoulder = joint("shoulder", "universal", ("base", at(0)), ("upper", at(0)), limits=[(-1.5, 1.5), (-1.5, 1.5)])
    elbow = joint("elbow", "revolute", ("upper", at(100)), ("lower", at(0)), limits=[(-2.0, 2.0)])
    wrist = joint("wrist", "ball", ("lower", at(80)), ("hand", at(0)))
    arm = Mechanism(("base", "upper", "lower", "hand"), "base", [shoulder, elbow, wrist])
    q = np.array([0.3, -0.4, 0.9, *SE3.rot_x(0.5).quaternion])
    goal = arm.poses(q)[3] @ at(10)
    found = arm.reach("hand", goal, at(10))
    assert found.ok
    assert found.limits == ()
    assert (arm.poses(found.q)[3] @ at(10)).allclose(goal, mm=1e-6, rad=1e-9)
    assert found.configuration.violations() == ()
    point = arm.reach("hand", goal.translation, at(10))
    assert point.ok
    assert point.angle == 0


def test_what_cannot_be_reached_says_how_far_and_which_limit_stops() -> None:
    arm = Mechanism(("a", "b"), "a", [joint("j", "revolute", ("a", at(0)), ("b", at(0)), limits=[(-0.5, 0.5)])])
    found = arm.reach("b", (0, 100, 0), at(100))
    assert not found.ok
    assert found.q[0] == pytest.approx(0.5)
    assert found.limits == ("j",)
    assert found.distance == pytest.approx(2 * 100 * math.sin((math.pi / 2 - 0.5) / 2))
    with pytest.raises(KinematicsError, match="One target"):
        arm.reach("b", SE3.identity((2,)))
    with pytest.raises(KinematicsError, match="Unknown part"):
        arm.reach("c", (0, 0, 0))


def test_a_loop_reaches_only_on_its_own_branch_and_within_limits() -> None:
    mechanism = four_bar()
    goal = mechanism.poses([2.2])[2].apply((45, 20, 0))
    found = mechanism.reach("coupler", goal, at(45, 20))
    assert found.ok
    assert mismatch(mechanism, found.q)[0] < 1e-9
    assert math.cos(found.q[0] - 2.2) == pytest.approx(1, abs=1e-9)
    far = mechanism.reach("coupler", (500, 0, 0), starts=2)
    assert not far.ok
    assert far.distance > 300
    limited = slider_crank(travel=(80.0, 150.0)).reach("piston", (50, 10, 0), starts=3)
    assert limited.limits == ("piston",)
    assert limited.distance == pytest.approx(30, abs=1e-6)


@pytest.mark.parametrize("lead", [4.0, 0.05], ids=["eighteen turns", "sixteen hundred turns"])
def test_a_nut_is_followed_however_often_its_screw_turns(lead: float) -> None:
    """A coupling is linear: no turn of the screw is a singularity, and none is too many."""
    slide = Joint(
        name="slide",
        type=JointType.SLIDER,
        parent="body",
        child="jaw",
        parent_connector="p",
        child_connector="c",
        T_parent_connector=SE3.identity(),
        T_child_connector=SE3.identity(),
        limits=JointLimits((0.0,), (80.0,)),
        rest=(0.0,),
        driver=True,
    )
    turn = replace(
        slide, name="turn", type=JointType.REVOLUTE, parent="jaw", child="screw", limits=JointLimits((0.0,), (1e5,)), driver=False
    )
    mechanism = Mechanism(
        ("body", "jaw", "screw"), "body", (slide, turn), (Coupling("lead", "screw", "turn", "slide", lead / (2 * math.pi)),)
    )

    free = mechanism.feasible_range("slide")

    assert (free.lower, free.upper, free.findings.codes) == (0.0, 80.0, ())
    configuration = mechanism.configuration(np.array([[0.0], [33.0], [80.0]]))
    assert configuration["turn"][:, 0] == pytest.approx(np.array([0.0, 33.0, 80.0]) * 2 * math.pi / lead, rel=1e-12)


def test_a_sweep_that_misses_a_value_is_not_ok(monkeypatch: pytest.MonkeyPatch) -> None:
    def evaluate(track: Track, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        Q, reached, proved = whole(track, values)
        reached[3] = False
        return Q, reached, proved

    whole = Track.evaluate
    monkeypatch.setattr(Track, "evaluate", evaluate)
    mechanism = four_bar()
    driver = mechanism.drivers[0].name
    found = mechanism.drive(driver, float(mechanism.rest[0]), float(mechanism.rest[0]) + 0.3, 8)
    assert len(found.values) == 7
    assert found.findings.codes == ("E_NOT_FOLLOWED",)
    assert not found.ok


def test_a_range_ends_at_the_drivers_own_limit_however_far_it_was_followed_before() -> None:
    plan = AssemblyPlan.load(TASKS / "jack_scissor" / "reference")
    mechanism = resolve(plan).mechanism
    (turn,) = [coordinate for coordinate in mechanism.coordinates if coordinate.name == "turn"]
    reached = [mechanism.feasible_range("turn") for _ in range(3)]

    assert [found.upper for found in reached] == [turn.upper] * 3
    assert [found.lower for found in reached] == [turn.lower] * 3
    assert {found.upper_reason for found in reached} == {"declared limit"}


@pytest.mark.parametrize("number", [float, np.float64])
@pytest.mark.parametrize("ratio", [13 / 8, -2.0])
def test_joints_without_end_that_are_coupled_have_no_end(number: type[float], ratio: float) -> None:
    """Readers of files hand over numbers of numpy, which warn of the difference of two infinities; a limit of the other joint still counts."""
    endless = [(number(-math.inf), number(math.inf))]
    joints = [joint(name, "revolute", ("base", at(x)), (name, at(0)), limits=endless) for name, x in (("year", 0), ("venus", 40))]
    couplings = [Coupling("drive", "linear", "year", "venus", ratio)]

    free = Mechanism(("base", "year", "venus"), "base", joints, couplings)
    held = replace(joints[1], limits=JointLimits((number(-1.0),), (number(math.inf),)))
    one_sided = Mechanism(("base", "year", "venus"), "base", [joints[0], held], couplings).feasible_range("year")

    assert (free.feasible_range("year").lower, free.feasible_range("year").upper) == (-math.inf, math.inf)
    assert (one_sided.lower, one_sided.upper) == pytest.approx((-1 / ratio, math.inf) if ratio > 0 else (-math.inf, -1 / ratio))
