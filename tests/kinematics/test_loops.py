from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from articad.connectors import SE3, Mate
from articad.errors import DeadPointError, KinematicsError, LoopError
from articad.kinematics import Coupling, JointType, Mechanism
from articad.kinematics.forward import LoopModel
from articad.kinematics.graph import JointGraph
from articad.kinematics.layout import Layout
from articad.kinematics.loops import CLOSED, ClosureSystem
from tests.kinematics.linkages import (
    at,
    bennett,
    four_bar,
    four_bar_angles,
    from_rest,
    gear_train,
    geared_four_bar,
    impossible,
    joint,
    mismatch,
    parallelogram,
    scissor,
    slider_crank,
    stewart,
    stewart_legs,
    watt,
)
from tests.strategies import random_pose

CLOSES_MM = 1e-8  # 1e-10 of the characteristic lengths here
CLOSES_RAD = 1e-10


def system_of(mechanism: Mechanism) -> ClosureSystem:
    return ClosureSystem(mechanism.tree, mechanism.layout, mechanism.loop_joints, mechanism.couplings)


def wrap(angle: np.ndarray | float) -> np.ndarray:
    return np.asarray((np.asarray(angle) + math.pi) % (2 * math.pi) - math.pi)


def world_angle(mechanism: Mechanism, q: list[float] | np.ndarray, part: str) -> float:
    """Return the direction of a link's x axis in the plane [degrees]."""
    x = mechanism.poses(q)[mechanism.part_index(part)].x_axis
    return math.degrees(math.atan2(x[1], x[0]))


# --- reference values (30-digit arithmetic)


@pytest.mark.parametrize(
    ("crank", "branch", "coupler", "rocker"),
    [
        (60, 1, 29.0719076623, 95.1956999317),
        (60, -1, -63.0640837766, -129.1878760461),
        (0, 1, 49.9947991151, 99.9895982303),
        (0, -1, -49.9947991151, -99.9895982303),
        (120, 1, 23.5838707082, 117.6799144663),
    ],
)
def test_four_bar_has_the_reference_angles(crank: float, branch: int, coupler: float, rocker: float) -> None:
    mechanism = four_bar(crank=math.radians(80), branch=branch)  # rests elsewhere: the angles are solved for
    q = [math.radians(crank)]
    assert world_angle(mechanism, q, "coupler") == pytest.approx(coupler, abs=6e-11)
    assert world_angle(mechanism, q, "rocker") == pytest.approx(rocker, abs=6e-11)


@pytest.mark.parametrize(
    ("e", "degrees", "x"),
    [
        (10, 0, 119.4427191000),
        (10, 45, 110.5119384138),
        (10, 90, 87.7496438739),
        (10, 200, 59.4990606590),
        (0, 60, 101.1684396981),
        (0, 90, 84.8528137424),
    ],
)
def test_slider_crank_has_the_reference_travel(e: float, degrees: float, x: float) -> None:
    mechanism = slider_crank(e=e, crank=0.4)
    assert mechanism.configuration([math.radians(degrees)])["piston"][0] == pytest.approx(x, abs=6e-11)


@pytest.mark.parametrize(("degrees", "height"), [(15, 155.2914270615), (45, 424.2640687119), (60, 519.6152422707)])
def test_scissor_has_the_reference_height(degrees: float, height: float) -> None:
    mechanism = scissor(3, phi=math.radians(30))
    q = [math.radians(degrees)]
    assert mechanism.poses(q)[mechanism.part_index("platform")].translation[1] == pytest.approx(height, abs=1e-9)
    assert mechanism.configuration(q)["shoe"][0] == pytest.approx(200 * math.cos(q[0]), abs=1e-9)
    if degrees == 15:
        assert mechanism.configuration(q)["shoe"][0] == pytest.approx(193.1851652578, abs=1e-9)


@pytest.mark.parametrize(("second", "link5", "link6"), [(1, 48.7387979374, 118.9387168410), (-1, -46.3206274238, -116.5205463273)])
def test_watt_six_bar_has_the_reference_angles(second: int, link5: float, link6: float) -> None:
    mechanism = watt(crank=1.0, branch=(1, second))
    q = [math.radians(60)]
    assert world_angle(mechanism, q, "link5") == pytest.approx(link5, abs=1e-9)
    assert world_angle(mechanism, q, "link6") == pytest.approx(link6, abs=1e-9)
    if second == 1:
        pin7 = mechanism.poses(q)[mechanism.part_index("link5")].apply((60, 0, 0))
        assert np.allclose(pin7[:2], (87.5739256902, 135.1982523567), rtol=0, atol=1e-9)


def test_stewart_platform_has_the_reference_pose() -> None:
    T = SE3.trans(10, -5, 120) @ SE3.rot_z(math.radians(12)) @ SE3.rot_y(math.radians(-6)) @ SE3.rot_x(math.radians(8))
    legs = [126.8564240022, 147.0803929379, 145.5609527361, 143.2222071164, 124.2060523712, 142.9714858180]
    assert np.allclose(stewart_legs(T), legs, rtol=0, atol=6e-11)
    mechanism = stewart()
    assert np.allclose(mechanism.rest, 137.1403174948, rtol=0, atol=6e-11)
    top = mechanism.poses(stewart_legs(T))[mechanism.part_index("top")]
    assert top.allclose(T @ SE3.trans(0, 0, -120), mm=1e-10, rad=1e-12)  # the platform's frame is the world's at rest
    batch = mechanism.poses(np.array([legs, mechanism.rest, np.asarray(legs) + 1]))
    assert batch[0, 1].allclose(top, mm=1e-8, rad=1e-9)
    assert batch[1, 1].allclose(SE3.identity(), mm=1e-9, rad=1e-9)


def test_bennett_keeps_the_product_of_half_tangents() -> None:
    mechanism = bennett(1.0)
    for q in np.linspace(0.3, 2.8, 7):
        angles = mechanism.configuration([q])
        for a, b in (("j0", "j1"), ("j1", "j2"), ("j2", "j3")):
            product = abs(math.tan(angles[a][0] / 2) * math.tan(angles[b][0] / 2))
            assert product == pytest.approx(3.1844619824, abs=6e-10)


def test_a_mirrored_door_has_the_reference_handle() -> None:
    hinge = joint("left", "revolute", ("cabinet", at(-400, -300)), ("door", at(0)), limits=[(-math.pi, 0.0)])
    mirror = hinge.mirrored(
        name="right",
        parent="cabinet",
        child="door_right",
        parent_connector="r",
        child_connector="h",
        T_parent_connector=SE3.from_axes((400, -300, 0), (0, 0, 1), (-1, 0, 0)),
        T_child_connector=SE3.from_axes((0, 0, 0), (0, 0, 1), (-1, 0, 0)),
    )
    mechanism = Mechanism(("cabinet", "door", "door_right"), "cabinet", [hinge, mirror])
    poses = mechanism.poses([math.radians(-60), math.radians(60)])
    assert np.allclose(poses[1].apply((380, -30, 550)), (-235.9807621135, -644.0896534381, 550), rtol=0, atol=1e-9)
    assert np.allclose(poses[2].apply((-380, -30, 550)), (235.9807621135, -644.0896534381, 550), rtol=0, atol=1e-9)


# --- the table of mechanisms


@pytest.mark.parametrize(
    ("make", "nv", "loops", "rank", "mobility", "grubler"),
    [
        (four_bar, 4, 1, 3, 1, -2),
        (slider_crank, 4, 1, 3, 1, -2),
        (lambda: scissor(3), 13, 4, 12, 1, -11),
        (lambda: scissor(10), 34, 11, 33, 1, -32),
        (watt, 7, 2, 6, 1, -5),
        (stewart, 36, 5, 30, 6, 6),
        (lambda: stewart("ball"), 42, 5, 30, 12, 12),
        (bennett, 4, 1, 3, 1, -2),
        (lambda: parallelogram(0.0), 4, 1, 3, 1, -2),
        (geared_four_bar, 5, 1, 4, 1, -2),
        (gear_train, 3, 0, 2, 1, 1),
    ],
)
def test_mobility_and_rank_are_those_of_the_table(make: object, nv: int, loops: int, rank: int, mobility: int, grubler: int) -> None:
    mechanism: Mechanism = make()  # type: ignore[operator]
    assert mechanism.layout.n_freedoms == nv
    assert len(mechanism.loop_joints) == loops
    assert mechanism.branch.analysis.rank == rank
    assert mechanism.mobility == mobility
    assert mechanism.grubler == grubler


def test_the_flat_parallelogram_has_two_freedoms_to_first_order_and_one_in_general() -> None:
    flat = parallelogram(0.0)
    assert flat.branch.analysis.first_order == 2
    assert flat.mobility == 1
    assert "W_NEAR_SINGULAR" in flat.findings().codes
    with pytest.raises(KinematicsError, match="E_SINGULAR"):
        flat.poses([0.5])
    assert flat.poses([0.0]).allclose(flat.poses(flat.rest))


def test_a_chain_that_cannot_close_says_its_gap() -> None:
    mechanism = impossible()
    with pytest.raises(LoopError) as caught:
        mechanism.poses([0.3])
    assert f"{caught.value.gap:.3f}" == "110.000"
    assert "best gap 110.000 mm" in str(caught.value)
    assert "(30+30+30 < 200)" in str(caught.value)
    assert caught.value.loop == ("ground", "crank", "coupler", "rocker")
    (found,) = mechanism.findings()
    assert (found.code, found.where) == ("E_LOOP_OPEN", "joints.rocker")


def test_a_chain_that_closes_elsewhere_but_not_near_rest_says_so() -> None:
    plain = four_bar()
    bad = [replace(j, rest=(j.rest[0] + 0.5,)) if j.name == "crank" else j for j in plain.joints]
    near = Mechanism(plain.parts, "frame", bad)  # close enough: the solver closes it
    assert mismatch(near, near.rest)[0] < CLOSES_MM


def test_contradicting_couplings_are_an_open_loop() -> None:
    plain = gear_train()
    again = Coupling("again", "gear", "gear_a", "gear_b", -20 / 30, 0.5)
    mechanism = Mechanism(plain.parts, "frame", plain.joints, [*plain.couplings, again])
    with pytest.raises(LoopError, match="E_COUPLING_REST"):
        mechanism.mobility  # noqa: B018


# --- equations


@pytest.mark.parametrize("make", [four_bar, slider_crank, geared_four_bar, lambda: stewart("ball"), lambda: scissor(2), bennett])
def test_the_closure_jacobian_is_the_derivative_of_the_residual(make: object) -> None:
    system = system_of(make())  # type: ignore[operator]
    rng = np.random.default_rng(0)
    Q = system.move(system.layout.rest, rng.normal(size=system.layout.n_freedoms) * 0.5)
    r, J = system.evaluate(np.array([Q, system.layout.rest]))
    assert np.allclose(r, system.residual(np.array([Q, system.layout.rest])), atol=1e-15)
    h = 1e-6
    for k in range(system.layout.n_freedoms):
        step = np.zeros(system.layout.n_freedoms)
        step[k] = h
        slope = (system.residual(system.move(Q, step)[None]) - system.residual(system.move(Q, -step)[None]))[0] / (2 * h)
        assert np.abs(slope - J[0, :, k]).max() < 1e-8


@pytest.mark.parametrize("factor", [1e-3, 1.0, 1e3])
def test_results_do_not_depend_on_the_unit_of_length(factor: float) -> None:
    scaled = four_bar(30 * factor, 90 * factor, 70 * factor, 100 * factor)
    system = system_of(scaled)
    Q = system.layout.rest.copy()
    Q[0] += 0.5
    free = np.array([False, True, True, True])
    closed = system.close(Q, free)
    assert closed.iterations == system_of(four_bar()).close(Q, free).iterations
    singular = np.linalg.svd(system.evaluate(closed.Q[None])[1][0])[1]
    assert np.allclose(singular, np.linalg.svd(system_of(four_bar()).evaluate(closed.Q[None])[1][0])[1], rtol=1e-11, atol=1e-14)


def test_a_residual_far_from_closing_has_its_logarithm_near_pi() -> None:
    system = system_of(bennett())
    Q = np.array([3.0, -3.0, 3.1, 0.1])
    r, _ = system.evaluate(Q[None])
    one = system.residual(Q[None])
    assert np.allclose(r, one)
    assert np.linalg.norm(r[0, 3:6]) <= math.pi + 1e-12


@pytest.mark.parametrize("gap", [1e-2, 1e-6, 1e-9])
def test_a_mismatch_of_nearly_half_a_turn_keeps_its_axis(gap: float) -> None:
    weld = joint("weld", "fixed", ("a", at(0)), ("b", at(0)))
    loop = Mechanism(("a", "b"), "a", [weld, joint("ball", "ball", ("a", at(0)), ("b", at(0)))])
    turn = (math.pi - gap) * np.array([1.0, 2.0, 3.0]) / math.sqrt(14)
    Q = SE3.exp(np.concatenate([np.zeros(3), turn])).quaternion
    system = system_of(loop)
    assert np.allclose(system.residual(Q[None])[0, 3:], -turn, rtol=0, atol=1e-12)
    assert np.allclose(system.residual_one(Q)[3:], -turn, rtol=0, atol=1e-12)


def test_closing_reports_what_it_cannot_do() -> None:
    system = system_of(impossible())
    closed = system.close(system.layout.rest, system.active)
    assert not closed.ok
    assert closed.residual > CLOSED
    nothing = system.close(system.layout.rest, np.zeros(4, dtype=bool))
    assert nothing.iterations == 0


def test_twenty_stages_of_a_scissor_close_from_loose_joints_and_rise() -> None:
    lift = scissor(20)
    system = system_of(lift)
    loose = system.move(system.layout.rest, 0.005 * np.random.default_rng(1).standard_normal(system.layout.n_freedoms))
    closed = system.close(loose, system.active)
    assert closed.residual < CLOSED
    assert closed.rank == system.layout.n_freedoms - 1
    assert lift.mobility == 1
    phi = math.radians(45)
    assert max(mismatch(lift, np.array([phi]))) < CLOSES_MM
    height = lift.poses([phi])[lift.part_index("platform")].translation[1]
    assert height == pytest.approx(4000 * math.sin(phi), abs=1e-8)


# --- random closable loops


KINDS = ["revolute", "revolute", "cylindrical", "slider", "ball", "universal", "screw", "planar", "fixed"]


@st.composite
def closable_loops(draw: st.DrawFn) -> Mechanism:
    """A ring of parts whose joints meet at rest, with freedoms enough to move, and sometimes a branch that hangs on."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    n = draw(st.integers(3, 6))
    kinds = [draw(st.sampled_from(KINDS)) for _ in range(n)]
    while sum(JointType(k).freedoms for k in kinds) < 7:
        kinds[min(range(n), key=lambda i: JointType(kinds[i]).freedoms)] = draw(st.sampled_from(["ball", "planar", "cylindrical"]))
    while sum(JointType(k).freedoms for k in kinds) > 9:
        kinds[max(range(n), key=lambda i: JointType(kinds[i]).freedoms)] = "revolute"
    parts = [f"p{i}" for i in range(n)]
    joints = []
    for i, kind in enumerate(kinds):
        near, far = parts[i], parts[(i + 1) % n]
        if kind not in {"planar", "universal"} and draw(st.booleans()):
            near, far = far, near
        rest = None if kind in {"ball", "universal", "planar", "fixed"} else rng.uniform(-0.5, 0.5, 2 if kind == "cylindrical" else 1)
        mate = draw(st.sampled_from(Mate))
        lead = 20.0 if kind == "screw" else 0.0
        joints.append(from_rest(f"j{i}", kind, near, far, random_pose(rng, 100.0), rest=rest, mate=mate, lead=lead))
    joints.append(from_rest("extra", "revolute", "p1", "extra", random_pose(rng, 50.0), rest=[0.2]))
    return Mechanism([*parts, "extra"], "p0", joints)


@settings(max_examples=30)
@given(closable_loops(), st.integers(0, 2**16))
def test_random_closable_loops_close_to_rounding_and_keep_their_drivers(mechanism: Mechanism, seed: int) -> None:
    assert mechanism.mobility >= 2  # the loop's and the branch's
    assert max(mismatch(mechanism, mechanism.rest)) < CLOSES_MM
    rng = np.random.default_rng(seed)
    q = mechanism.rest + np.array([0.0 if c.unit == "1" else rng.uniform(-0.1, 0.1) for c in mechanism.drivers])
    try:
        gap, turn = mismatch(mechanism, q)
    except (DeadPointError, KinematicsError):
        return
    assert gap / system_of(mechanism).length < CLOSES_RAD
    assert turn < CLOSES_RAD
    columns = mechanism.configuration(q).columns[list(mechanism.driver_columns)]
    assert np.allclose(columns, q, rtol=0, atol=1e-15)


def both_ways(mechanism: Mechanism) -> ClosureSystem:
    """Return the system of a linkage of any size with Pinocchio's equations for one configuration."""
    system = system_of(mechanism)
    system.__dict__["_one"] = LoopModel(system._closures)
    return system


EVERY_KIND = [
    *(("free", "g", "p1"), ("planar", "p1", "p2"), ("universal", "p2", "p3"), ("ball", "p4", "p3"), ("cylindrical", "p5", "p4")),
    *(("screw", "p5", "p6"), ("revolute", "p6", "g"), ("ball", "p1", "p6"), ("planar", "p2", "p5"), ("slider", "p6", "p2")),
]


@given(st.integers(0, 2**16), st.sampled_from([0.0, 0.1, 1.0]), st.permutations(EVERY_KIND))
def test_every_kind_of_joint_on_a_loop_has_the_equations_of_a_batch(seed: int, size: float, kinds: list[tuple[str, str, str]]) -> None:
    """Joints of all types, some crossed backwards, some closing; the loops are open, so that all terms of the Jacobian count."""
    rng = np.random.default_rng(seed)

    def connector(part: str) -> tuple[str, SE3]:
        return part, SE3.exp(np.concatenate([rng.uniform(-50, 50, 3), rng.uniform(-1, 1, 3)]))

    joints = []
    for i, (kind, a, b) in enumerate(kinds):
        one, other = connector(a), connector(b)
        if kind == "free":
            joints.append(replace(joint(f"j{i}", "fixed", one, other), type=JointType.FREE, rest=JointType.FREE.neutral))
        else:
            joints.append(joint(f"j{i}", kind, one, other, lead=5.0 if kind == "screw" else 0.0))
    tree, loop_joints = JointGraph(("g", "p1", "p2", "p3", "p4", "p5", "p6"), "g", joints).spanning_tree()
    system = ClosureSystem(tree, Layout(joints), loop_joints, [])
    Q = system.move(system.layout.rest, size * rng.standard_normal(system.layout.n_freedoms))
    (many_r,), (many_J,) = system.evaluate(Q[None])
    one_r, one_J = system.evaluate_one(Q)
    assert np.abs(one_r - many_r).max() < 1e-12
    assert np.abs(one_J - many_J).max() < 1e-11


def test_a_loop_in_which_nothing_moves_has_its_residual_and_no_derivatives() -> None:
    """Two fixed joints between the same two parts, which disagree by a millimetre."""
    joints = [joint("a", "fixed", ("g", at(0)), ("p", at(0))), joint("b", "fixed", ("p", at(50)), ("g", at(51)))]
    tree, loop_joints = JointGraph(("g", "p"), "g", joints).spanning_tree()
    system = ClosureSystem(tree, Layout(joints), loop_joints, [])
    r, J = system.evaluate_one(system.layout.rest)
    assert J.shape == (6, 0)
    assert np.abs(r[:3]).max() * system.lengths[0] == pytest.approx(1.0)
    assert not system.close(system.layout.rest, system.active).ok


@settings(max_examples=60)
@given(closable_loops(), st.integers(0, 2**16))
def test_one_configuration_has_the_equations_of_a_batch_to_rounding(mechanism: Mechanism, seed: int) -> None:
    system = both_ways(mechanism)
    rng = np.random.default_rng(seed)
    for size in (0.0, 1e-6, 0.1, 3.0):
        Q = system.move(system.layout.rest, size * rng.standard_normal(system.layout.n_freedoms))
        (many_r,), (many_J,) = system.evaluate(Q[None])
        r, J = system.evaluate_one(Q)
        assert np.abs(r - many_r).max() < 1e-12
        assert np.abs(J - many_J).max() < 1e-12 * max(1.0, np.abs(J).max())
        assert np.array_equal(system.residual_one(Q), r)


@pytest.mark.parametrize("make", [geared_four_bar, gear_train, lambda: scissor(4), lambda: stewart("ball")])
def test_couplings_and_large_linkages_have_the_equations_of_a_batch_too(make: object) -> None:
    system = both_ways(make())  # type: ignore[operator]
    Q = system.move(system.layout.rest, 0.3 * np.random.default_rng(0).standard_normal(system.layout.n_freedoms))
    (many_r,), (many_J,) = system.evaluate(Q[None])
    r, J = system.evaluate_one(Q)
    assert np.abs(r - many_r).max() < 1e-13
    assert np.abs(J - many_J).max() < 1e-13
    assert np.array_equal(system.residual_one(Q), r)


@settings(max_examples=25)
@given(closable_loops(), st.integers(0, 2**16))
def test_one_start_closes_where_it_closes_in_a_batch(mechanism: Mechanism, seed: int) -> None:
    (group,) = mechanism.branch.groups
    system, dependent = group.system, group.dependent
    if group.follower.rank < dependent.sum() or group.follower.linearized(group.Q).s.min() < 0.1:
        return  # with an idle part, or beside a dead point, the place is not determined to rounding
    rng = np.random.default_rng(seed)
    starts = system.move(group.Q, 0.02 * dependent * rng.standard_normal((4, system.layout.n_freedoms)))
    together, norms = system.close_many(starts, dependent)
    assert norms.max() <= CLOSED
    for start, Q in zip(starts, together, strict=True):
        alone = system.close(start, dependent)
        assert alone.ok
        assert np.abs(system.step_between(alone.Q, Q)).max() < 1e-12


@settings(max_examples=25)
@given(closable_loops())
def test_the_jacobian_of_a_loop_is_the_derivative_of_its_poses(mechanism: Mechanism) -> None:
    (group,) = mechanism.branch.groups
    if any(c.unit == "1" for c in mechanism.drivers) or group.follower.linearized(group.Q).s.min() < 0.1:
        return  # beside a dead point differences show the curvature instead
    part, h = mechanism.parts[-1], 1e-5
    J = mechanism.jacobian(mechanism.rest, part, at(5, 6, 7))
    for k in range(mechanism.nq):
        step = np.zeros(mechanism.nq)
        step[k] = h
        try:
            ahead, behind = (mechanism.poses(mechanism.rest + s * step)[-1] @ at(5, 6, 7) for s in (1, -1))
        except KinematicsError:
            return
        slope = (ahead.translation - behind.translation) / (2 * h)
        turn = behind.rotation @ (behind.inverse() @ ahead).log()[3:] / (2 * h)
        assert np.abs(np.concatenate([slope, turn]) - J[:, k]).max() < 1e-3 * max(1.0, np.abs(J[:, k]).max())


# --- drivers


def test_marked_joints_drive_and_are_completed_in_order_of_declaration() -> None:
    plain = four_bar()
    assert [c.name for c in plain.drivers] == ["crank"]
    rocker = Mechanism(plain.parts, "frame", [replace(j, driver=j.name == "rocker") for j in plain.joints])
    assert [c.name for c in rocker.drivers] == ["rocker"]
    none = Mechanism(plain.parts, "frame", [replace(j, driver=False) for j in plain.joints])
    assert [c.name for c in none.drivers] == ["crank"]
    closing = Mechanism(plain.parts, "frame", [replace(j, driver=j.name == "pin_c") for j in plain.joints])
    assert [c.name for c in closing.drivers] == ["pin_c"]
    assert mismatch(closing, closing.rest + 0.2)[0] < CLOSES_MM


def test_a_mark_too_many_is_an_error_and_says_who_drives() -> None:
    plain = four_bar()
    both = Mechanism(plain.parts, "frame", [replace(j, driver=j.name in {"crank", "rocker"}) for j in plain.joints])
    (found,) = both.findings().of("E_DRIVER")
    assert found.where == "joints.rocker"
    assert "crank already drive" in found.message


def test_joints_outside_the_loops_drive_themselves() -> None:
    plain = four_bar()
    lamp = joint("lamp", "ball", ("rocker", at(10)), ("lamp", at(0)))
    arm = joint("arm", "cylindrical", ("frame", at(-10)), ("arm", at(0)))
    mechanism = Mechanism((*plain.parts, "lamp", "arm"), "frame", [lamp, *plain.joints, arm])
    assert [c.name for c in mechanism.drivers] == ["lamp.qx", "lamp.qy", "lamp.qz", "lamp.qw", "crank", "arm.travel", "arm.angle"]
    assert mechanism.mobility == 6
    q = mechanism.rest.copy()
    q[:4] = SE3.rot_x(0.3).quaternion
    q[4] += 0.4
    q[5:] = (7.0, 0.5)
    assert max(mismatch(mechanism, q)) < CLOSES_MM
    J = mechanism.jacobian(q, "lamp")
    assert J.shape == (6, 6)
    assert np.allclose(J[:3, :3], 0)
    many = mechanism.poses(np.tile(q, (50, 1)))
    assert many.batch_shape == (50, 6)
    assert many[7].allclose(mechanism.poses(q), mm=1e-9, rad=1e-12)
    with pytest.raises(KinematicsError, match="one configuration"):
        mechanism.jacobian(np.tile(q, (2, 1)), "lamp")
    with pytest.raises(KinematicsError, match="E_NONFINITE"):
        mechanism.poses(q * math.nan)


def test_a_ball_may_drive_a_loop() -> None:
    rng = np.random.default_rng(3)
    W = [random_pose(rng, 80.0) for _ in range(4)]
    joints = [
        from_rest("ball", "ball", "a", "b", W[0], driver=True),
        from_rest("other", "ball", "b", "c", W[1]),
        from_rest("rod", "cylindrical", "c", "d", W[2], rest=[10.0, 0.1]),
        from_rest("wheel", "universal", "a", "d", W[3]),
    ]
    mechanism = Mechanism(("a", "b", "c", "d"), "a", joints)
    assert mechanism.mobility == 4
    assert [c.name for c in mechanism.drivers][:4] == ["ball.qx", "ball.qy", "ball.qz", "ball.qw"]
    q = mechanism.rest.copy()
    q[:4] = (SE3.rot_x(0.03) @ SE3.rot_y(-0.02)).quaternion
    assert max(mismatch(mechanism, q)) < CLOSES_MM
    with pytest.raises(KinematicsError, match="component of a quaternion"):
        mechanism.feasible_range("ball.qx")
    q[:4] = SE3.rot_z(3.0).quaternion
    with pytest.raises(KinematicsError, match=r"driver 'ball\.q[xyz]' cannot go to"):  # turned further than the rod allows
        mechanism.poses(q)


def test_a_gear_drives_the_crank_by_its_teeth() -> None:
    mechanism = geared_four_bar()
    assert [c.name for c in mechanism.drivers] == ["motor"]
    moved = mechanism.configuration([-1.0])
    assert moved["crank"][0] == pytest.approx(math.radians(60) + 0.5, abs=1e-12)
    coupler, _ = four_bar_angles(30, 90, 70, 100, moved["crank"][0])
    assert moved["crank"][0] + moved["pin_b"][0] == pytest.approx(coupler, abs=1e-12)


def test_gears_and_a_rack_move_together() -> None:
    mechanism = gear_train()
    moved = mechanism.configuration([0.6])
    assert moved["gear_b"][0] == pytest.approx(0.1 - 0.4)
    assert moved["rack"][0] == pytest.approx(30 * -0.3 - 3)


# --- branches


@pytest.mark.parametrize("branch", [1, -1])
def test_poses_stay_on_the_branch_of_the_rest_pose(branch: int) -> None:
    mechanism = four_bar(branch=branch)
    for crank in np.linspace(-6, 6, 13):
        coupler, rocker = four_bar_angles(30, 90, 70, 100, crank, branch)
        assert abs(wrap(math.radians(world_angle(mechanism, [crank], "coupler")) - coupler)) < 1e-10
        assert abs(wrap(math.radians(world_angle(mechanism, [crank], "rocker")) - rocker)) < 1e-10


def test_assembly_modes_are_all_found() -> None:
    modes = four_bar().assembly_modes()
    assert len(modes) == 2
    rockers = sorted(math.degrees(float(wrap(mode["rocker"][0]))) for mode in modes)
    assert rockers == pytest.approx([-129.1878760461, 95.1956999317])
    assert math.degrees(modes[0]["rocker"][0]) == pytest.approx(95.1956999317)  # the rest pose's own first
    assert len(watt().assembly_modes([1.0])) == 4
    tree = Mechanism(("a", "b"), "a", [joint("j", "revolute", ("a", at(0)), ("b", at(0)))])
    assert len(tree.assembly_modes()) == 1
    beyond = four_bar(60, 50, 50, 100, crank=0.3)
    assert beyond.assembly_modes([1.5]) == ()


def test_a_driver_beyond_its_dead_point_is_refused_with_the_place() -> None:
    mechanism = four_bar(60, 50, 50, 100, crank=0.3)
    with pytest.raises(DeadPointError) as caught:
        mechanism.poses([math.radians(90)])
    assert caught.value.driver == "crank"
    assert math.degrees(caught.value.q) == pytest.approx(72.5423968763, abs=1e-9)
    assert "cannot go to 90.000°: the loop reaches only 72.542°" in str(caught.value)
    several = np.array([[0.3], [1.2], [-2.0]])
    with pytest.raises(DeadPointError, match=r"-72\.542°"):
        mechanism.poses(several)


def test_several_drivers_meet_a_dead_point_together() -> None:
    five = [
        from_rest("a", "revolute", "g", "l1", at(0), driver=True),
        from_rest("b", "revolute", "l1", "l2", at(0, 40)),
        from_rest("c", "revolute", "l2", "l3", at(50, 90)),
        from_rest("d", "revolute", "l3", "l4", at(100, 40)),
        from_rest("e", "revolute", "g", "l4", at(100), driver=True),
    ]
    mechanism = Mechanism(("g", "l1", "l2", "l3", "l4"), "g", five)
    assert mechanism.mobility == 2
    assert max(mismatch(mechanism, np.array([0.3, -0.3]))) < CLOSES_MM
    with pytest.raises(DeadPointError) as caught:
        mechanism.poses([1.6, -1.5])
    assert caught.value.driver == "a"
    batch = mechanism.poses(np.array([[0.1, 0.1], [0.3, -0.3], [0.0, 0.0]]))
    assert batch[1].allclose(mechanism.poses([0.3, -0.3]), mm=1e-9, rad=1e-10)


def test_a_ball_that_cannot_drive_is_refused_as_a_driver() -> None:
    plain = four_bar()
    joints = [
        from_rest("crank", "revolute", "g", "a", at(0)),
        from_rest("knee", "ball", "a", "b", at(10, 30)),
        from_rest("rod", "ball", "b", "c", at(90, 40), driver=True),
        from_rest("rocker", "revolute", "g", "c", at(100) @ SE3.rot_x(0.3)),
    ]
    mechanism = Mechanism(("g", "a", "b", "c"), "g", joints)
    assert mechanism.mobility == 2  # the crank's, and the rod's idle spin
    assert [c.name for c in mechanism.drivers] == ["crank"]
    (found,) = mechanism.findings().of("E_DRIVER")
    assert found.where == "joints.rod"
    assert max(mismatch(mechanism, np.array([0.4]))) < CLOSES_MM
    assert plain.findings().of("E_DRIVER") == ()
