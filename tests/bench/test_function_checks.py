"""Checks of function against other oracles: MuJoCo for efforts, the textbook for beams, known boxes, sums by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.optimize import nnls

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.export.mjcf import write_mjcf
from articad.geometry import Part, TriMesh, box, cylinder, tube
from articad.kinematics.joints import Coupling, Joint
from articad.plan.resolve import Fit
from articad_bench.beams import Support, _solved, beam, section
from articad_bench.function_checks import comes_to, largest_effort, least_width
from articad_bench.strength_checks import bending, level_tops
from articad_bench.subject import Subject
from tests.bench.test_cheats import made, solid
from tests.bench.test_checks import form
from tests.disassembly.test_screwing import HEAD, nut, screwed, thread
from tests.kinematics.linkages import at, joint

STEEL = 7850.0
LEVEL = SE3.rot_x(-math.pi / 2)  # z along +y


def placed(mesh: TriMesh, x: float, y: float, z: float) -> TriMesh:
    return mesh.transformed(SE3.trans(x, y, z))


def of(
    *bodies: tuple[str, TriMesh], joints: list[Joint], couplings: tuple[Coupling, ...] = (), fits: dict[str, Fit] | None = None
) -> Assembly:
    parts = [Part.from_mesh(name, mesh, density=STEEL) for name, mesh in bodies]
    return Assembly.from_parts("made", parts=parts, joints=joints, ground=bodies[0][0], couplings=couplings, fits=fits)


def fixed(a: str, b: str) -> Joint:
    return joint(f"{a}_{b}", "fixed", (a, at(0)), (b, at(0)))


# ---------------------------------------------------------------------- effort


def arm() -> Assembly:
    """A bar of 400 mm on a level pin at its end, turning from level by 80 degrees up, on a post."""
    bodies = ("post", placed(box(40, 40, 200), 0, 60, -100)), ("bar", placed(box(400, 20, 20), 200, 0, 0))
    return of(*bodies, joints=[joint("pin", "revolute", ("post", LEVEL), ("bar", LEVEL), limits=[(-1.4, 0.0)])])


def test_the_effort_of_an_arm_is_weight_times_lever() -> None:
    assembly = arm()
    weight = STEEL * 0.4 * 0.02 * 0.02 * 9.81

    assert largest_effort(Subject(assembly), assembly.joints[0]) == pytest.approx(weight * 0.2, rel=1e-3)
    loaded = largest_effort(Subject(assembly), assembly.joints[0], 3.0)
    assert loaded == pytest.approx(weight * 0.2 + 3 * 9.81 * 0.2, rel=5e-3)


def two_arms() -> Assembly:
    bodies = (
        ("post", placed(box(40, 40, 200), 0, 60, -100)),
        ("lower", placed(box(300, 20, 20), 150, 0, 0)),
        ("upper", placed(box(200, 15, 15), 100, 25, 0)),
    )
    shoulder = joint("shoulder", "revolute", ("post", LEVEL), ("lower", LEVEL), limits=[(-1.2, 0.3)])
    elbow = joint("elbow", "revolute", ("lower", at(300) @ LEVEL), ("upper", LEVEL), limits=[(-0.5, 1.5)])
    return of(*bodies, joints=[shoulder, elbow])


def test_the_efforts_of_a_chain_are_those_of_mujoco(tmp_path: Any) -> None:
    """MuJoCo's inverse dynamics at rest is the effort against gravity; its largest over the same poses, the other joint at rest and at its ends."""
    assembly = two_arms()
    (file,) = (path for path in write_mjcf(assembly).write(tmp_path) if path.suffix == ".xml")
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    columns = {name: int(model.jnt_qposadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)]) for name in ("shoulder", "elbow")}
    limits = {row.name: (row.limits.lower[0], row.limits.upper[0]) for row in assembly.joints}

    def largest(name: str, other: str) -> float:
        found = 0.0
        for beside in (0.0, *limits[other]):
            for value in np.linspace(*limits[name], 200):
                data.qpos[columns[name]], data.qpos[columns[other]] = value, beside
                data.qvel[:], data.qacc[:] = 0, 0
                mujoco.mj_inverse(model, data)
                found = max(found, abs(float(data.qfrc_inverse[columns[name]])))
        return found

    for row, other in zip(assembly.joints, ("elbow", "shoulder"), strict=True):
        assert largest_effort(Subject(assembly), row) == pytest.approx(largest(row.name, other), rel=2e-3)


def screw_table() -> Assembly:
    """A table of 10 kg or so on a spindle of 5 mm lead, turned by a crank of 120 mm."""
    bodies = ("base", box(100, 100, 10)), ("table", placed(box(400, 300, 10), 0, 0, 200)), ("crank", placed(box(120, 10, 10), 60, 0, 40))
    lift = joint("lift", "slider", ("base", at(0)), ("table", at(0)), limits=[(0.0, 100.0)])
    turn = joint("turn", "revolute", ("base", at(0)), ("crank", at(0)), limits=[(0.0, 40 * math.pi)], driver=True)
    return of(*bodies, joints=[lift, turn], couplings=(Coupling("thread", "linear", "turn", "lift", 5 / (2 * math.pi)),))


def test_a_hand_at_a_crank_feels_weight_times_lead_by_the_way_round() -> None:
    assembly = screw_table()
    weight = (STEEL * 0.4 * 0.3 * 0.01 + 50) * 9.81
    torque = weight * 0.005 / (2 * math.pi)
    reach = math.hypot(0.12, 0.005)

    lift, turn = assembly.joints
    assert largest_effort(Subject(assembly), lift, 50.0) == pytest.approx(weight, rel=1e-3)
    assert largest_effort(Subject(assembly), turn, 50.0) == pytest.approx(torque, rel=1e-3)
    row: dict[str, Any] = {"kind": "effort", "joint": {"type": "revolute"}, "load": 50, "by_hand": True}
    hand = torque / reach
    assert form(row | {"most": [0.99 * hand, 1.01 * hand]}).judge(Subject(assembly)).ok
    assert not form(row | {"most": [0, 0.98 * hand]}).judge(Subject(assembly)).ok


# ---------------------------------------------------------------------- carries


KG, E, B, H, L = 60.0, 9000.0, 200.0, 20.0, 800.0
FORCE = KG * 9.81
MOMENT = B * H**3 / 12


def on(*supports: tuple[float, float], both: bool, length: float = L) -> Subject:
    """A board that lies on blocks from one place to another along it, fixed to them or not; a plate below is the ground."""
    ground = placed(box(length + 100, 300, 10), length / 2, 0, -105)
    blocks = [(f"block{i}", placed(box(b - a, B, 90), (a + b) / 2, 0, -55)) for i, (a, b) in enumerate(supports)]
    board = placed(box(length, B, H), length / 2, 0, H / 2 - 10)
    joints = [fixed("ground", name) for name, _ in blocks]
    joints.append(fixed("ground", "board") if both else joint("loose", "slider", ("ground", at(0)), ("board", at(0)), limits=[(0.0, 50.0)]))
    return Subject(of(("ground", ground), *blocks, ("board", board), joints=joints))


def bent(subject: Subject, **options: Any) -> tuple[float, float] | None:
    (top,) = level_tops(subject, "board")
    found = bending(subject, top, KG, E, **options)
    return None if found is None else (found.stress, found.sag)


def stress_of(moment: float) -> float:
    return moment * (H / 2) / MOMENT


def test_a_board_that_lies_on_two_blocks_bends_between_their_inner_edges() -> None:
    """Simply supported with overhangs c beyond a span l: M = w l²/8 − w c²/2, and at the ends of the blocks w c²/2."""
    span, c = 600.0, 100.0
    w = FORCE / L

    found = bent(on((0, 100), (700, 800), both=False))

    assert found is not None
    stress, sag = found
    assert stress == pytest.approx(stress_of(w * span**2 / 8 - w * c**2 / 2), rel=2e-3)
    middle = w * span**2 / (384 * E * MOMENT) * (5 * span**2 - 24 * c**2)
    assert sag == pytest.approx(middle, rel=2e-3)


def test_a_board_that_is_fixed_to_two_blocks_is_a_beam_with_fixed_ends() -> None:
    span, w = 600.0, FORCE / L

    found = bent(on((0, 100), (700, 800), both=True))

    assert found is not None
    assert found[0] == pytest.approx(stress_of(w * span**2 / 12), rel=2e-3)
    assert found[1] == pytest.approx(w * span**4 / (384 * E * MOMENT), rel=2e-3)


def test_a_board_that_is_fixed_along_a_short_way_may_turn_there() -> None:
    span, w = 760.0, FORCE / L  # from 20 to 780, with 20 mm beyond

    found = bent(on((0, 20), (780, 800), both=True))

    assert found is not None
    assert found[0] == pytest.approx(stress_of(w * span**2 / 8 - w * 20**2 / 2), rel=2e-3)


def test_a_board_on_one_bracket_is_a_cantilever_and_one_that_lies_there_falls() -> None:
    """The load anywhere: at the end of the board."""
    found = bent(on((0, 200), both=True), anywhere=True)

    assert found is not None
    assert found[0] == pytest.approx(stress_of(FORCE * 600), rel=1e-2)
    assert found[1] == pytest.approx(FORCE * 600**3 / (3 * E * MOMENT), rel=2e-3)
    assert bent(on((0, 200), both=False), anywhere=True) is None
    assert bent(on((0, 200), both=False)) is None  # the middle of the load is beside the block


def test_a_load_beyond_what_a_board_lies_on_tips_it() -> None:
    assert bent(on((200, 300), (500, 600), both=False)) is not None
    assert bent(on((200, 300), (500, 600), both=False), anywhere=True) is None


def test_a_board_on_a_frame_bends_across_its_middle() -> None:
    """Blocks all round a board of 800 x 200 mm: the middle is a beam across, from block to block; a pin that is upright does not let it turn."""
    ground = placed(box(1000, 400, 10), 400, 0, -105)
    rails = [("front", placed(box(L, 20, 90), 400, -90, -55)), ("back", placed(box(L, 20, 90), 400, 90, -55))]
    ends = [("left", placed(box(20, 160, 90), 10, 0, -55)), ("right", placed(box(20, 160, 90), 790, 0, -55))]
    joints = [fixed("ground", name) for name, _ in (*rails, *ends)]
    joints.append(joint("loose", "slider", ("ground", at(0)), ("board", at(0)), limits=[(0.0, 50.0)]))
    found = bent(Subject(of(("ground", ground), *rails, *ends, ("board", placed(box(L, B, H), 400, 0, 0)), joints=joints)))

    assert found is not None
    w = FORCE / B
    assert found[0] == pytest.approx((w * 160**2 / 8 - w * 20**2 / 2) * (H / 2) / (L * H**3 / 12), rel=5e-3)


@pytest.mark.parametrize(("turn", "held"), [(SE3.identity(), True), (SE3.rot_y(math.pi / 2), False), (SE3.rot_x(math.pi / 2), False)])
def test_a_pin_lets_a_board_turn_about_its_axis_alone(turn: SE3, held: bool) -> None:
    """A board of 800 mm in a block at its end, on a pin that is upright, along it so that it rolls, or across it so that it tips."""
    block, board = placed(box(100, B, 90), 50, 0, -55.2), placed(box(L, B, H), 400, 0, 0)
    pin = joint("pin", "revolute", ("block", at(50) @ turn), ("board", at(50) @ turn), limits=[(0.0, 1.0)])
    subject = Subject(of(("block", block), ("board", board), joints=[pin]))

    assert (bent(subject) is not None) is held


def test_what_hangs_on_a_board_does_not_carry_it() -> None:
    ground, posts = placed(box(900, 300, 10), 400, 0, -105), [("post0", placed(box(100, B, 90), 50, 0, -55))]
    board, hung = placed(box(L, B, H), 400, 0, 0), placed(box(100, B, 50), 750, 0, -35)
    joints = [fixed("ground", "post0"), fixed("post0", "board"), fixed("board", "hung")]
    subject = Subject(of(("ground", ground), *posts, ("board", board), ("hung", hung), joints=joints))

    found = bent(subject)
    assert found is not None
    assert found[0] == pytest.approx(stress_of(FORCE / L * 700**2 / 2), rel=2e-3)


def test_the_section_of_a_board_is_that_of_its_shape() -> None:
    flat = section(box(500, 60, 30), np.array([1.0, 0, 0]), 7.0)
    assert flat == pytest.approx((60 * 30**3 / 12, 15))
    pipe = section(tube(10, 12, 400).transformed(SE3.rot_y(math.pi / 2)), np.array([1.0, 0, 0]), 3.0)
    assert pipe == pytest.approx((math.pi / 4 * (12**4 - 10**4), 12), rel=5e-3)


def test_a_board_is_meant_by_its_height_and_size() -> None:
    subject = on((0, 100), (700, 800), both=True)
    row: dict[str, Any] = {"kind": "carries", "kg": KG, "stress": 10, "modulus": E, "number": [1, 1]}
    assert form(row | {"level": [119, 121], "top": [180, 780]}).judge(subject).ok
    assert not form(row | {"level": [119, 121], "top": [180, 820]}).judge(subject).ok
    assert not form(row | {"level": [100, 118]}).judge(subject).ok
    assert not form(row | {"level": [119, 121], "kg": 40 * KG}).judge(subject).ok
    assert not form(row | {"level": [119, 121], "sag": 0.1}).judge(subject).ok


# ---------------------------------------------------------------------- folds and passes


def flap(*, blocked: bool = False) -> Assembly:
    """Two leaves of 300 x 200 x 10 mm on one pin along y: flat they are 600 mm long, folded 300."""
    a, b = placed(box(299, 200, 10), -149.5, 0, -5), placed(box(299, 200, 10), 149.5, 0, -5)
    bodies = [("a", a), ("b", b), *([("stop", placed(box(10, 200, 60), -60, 0, 30))] if blocked else [])]
    joints = [joint("pin", "revolute", ("a", LEVEL), ("b", LEVEL), limits=[(-math.pi, 0.0)])]
    return of(*bodies, joints=joints + ([fixed("a", "stop")] if blocked else []))


def test_two_leaves_fold_into_the_box_of_one() -> None:
    row: dict[str, Any] = {"kind": "folds", "opens": [10, 200, 590]}
    assert form(row | {"into": [20, 200, 310]}).judge(Subject(flap())).ok
    assert form(row | {"into": [310, 20, 200]}).judge(Subject(flap())).ok
    assert not form(row | {"into": [19, 200, 310]}).judge(Subject(flap())).ok
    assert not form(row | {"into": [20, 200, 310], "opens": [None, None, 600]}).judge(Subject(flap())).ok


def test_leaves_do_not_fold_through_what_is_in_the_way() -> None:
    judged = form({"kind": "folds", "into": [70, 200, 310]}).judge(Subject(flap(blocked=True)))

    assert not judged.ok
    assert "collide" in judged.measured


def test_a_box_passes_an_opening_by_its_narrow_side_however_it_is_turned() -> None:
    turned = box(900, 500, 300).transformed(SE3.rot_z(0.7))
    subject = Subject(of(("block", turned), joints=[]))
    assert form({"kind": "passes", "opening": [500, 300]}).judge(subject).ok
    assert not form({"kind": "passes", "opening": [499, 300]}).judge(subject).ok
    assert not form({"kind": "passes", "opening": [500, 299]}).judge(subject).ok
    straight = Subject(of(("block", box(900, 500, 300)), joints=[]))
    assert form({"kind": "passes", "opening": [500, 300], "along": "x"}).judge(straight).ok
    assert not form({"kind": "passes", "opening": [500, 300], "along": "y"}).judge(straight).ok


def test_folded_leaves_pass_where_open_ones_do_not() -> None:
    tall = of(*[(name, part.mesh) for name, part in flap().parts.items() if part.mesh is not None], joints=list(flap().joints))
    row: dict[str, Any] = {"kind": "passes", "opening": [310, 200], "along": "y"}
    assert not form(row).judge(Subject(tall)).ok
    assert form(row | {"folded": True}).judge(Subject(tall)).ok


def test_the_width_of_a_triangle_is_its_least_height() -> None:
    assert least_width(np.array([[0.0, 0], [3, 0], [0, 4]])) == pytest.approx(12 / 5)


# ---------------------------------------------------------------------- put together


def pinned(head: bool) -> Assembly:
    """A pin in a plate; a head on both sides of the plate keeps it from going in."""
    plate = tube(5.2, 20, 10)
    bodies = [
        ("plate", plate),
        ("pin", cylinder(5, 40)),
        ("cap", placed(tube(5.0, 9, 4), 0, 0, 8)),
        ("foot", placed(tube(5.0, 9, 4), 0, 0, -8)),
    ]
    joints = [joint("turn", "revolute", ("plate", at(0)), ("pin", at(0))), fixed("pin", "cap"), fixed("pin", "foot")]
    if head:
        whole = made(
            "Add", *(solid(placed(mesh, 0, 0, z)) for mesh, z in ((cylinder(5, 40), 0), (cylinder(9, 4), 8), (cylinder(9, 4), -8)))
        )
        bodies, joints = [("plate", plate), ("pin", whole)], joints[:1]
    return of(*bodies, joints=joints)


def test_a_pin_with_heads_at_both_ends_is_put_together_only_if_a_head_is_a_part() -> None:
    row = {"kind": "put_together"}
    assert form(row).judge(Subject(pinned(head=False))).ok
    assert not form(row).judge(Subject(pinned(head=True))).ok


def test_force_and_what_is_bought_as_one_are_counted() -> None:
    snapped = pinned(head=True)
    for fastening in ("snap", "purchased"):
        joints = [replace(row, fastening=fastening) for row in snapped.joints]
        subject = Subject(Assembly.from_parts("made", parts=snapped.parts.values(), joints=joints, ground="plate"))
        assert not form({"kind": "put_together"}).judge(subject).ok
        assert form({"kind": "put_together", "force": 1}).judge(subject).ok


# ---------------------------------------------------------------------- stack


def stacked(*lengths: float, between: float) -> Subject:
    """Rings on a shaft between a shoulder and a cap, each on its own."""
    bodies = [
        ("shaft", cylinder(5, between + 20).transformed(SE3.trans(0, 0, between / 2))),
        ("shoulder", placed(tube(5, 10, 5), 0, 0, -2.5)),
    ]
    z = 0.0
    for i, length in enumerate(lengths):
        bodies.append((f"ring{i}", placed(tube(5.1, 9, length), 0, 0, z + length / 2)))
        z += length
    bodies.append(("cap", placed(tube(5, 10, 2), 0, 0, between + 1)))
    joints = [fixed("shaft", name) for name, _ in bodies[1:]]
    return Subject(of(*bodies, joints=joints))


def test_what_is_left_of_a_stack_is_the_sum_by_hand() -> None:
    """Bearings of 8 −0.12 mm, a spacer of 20 ± 0.1 mm (class f), a seat of 36.2 ± 0.05 mm: 0.2 − 0.1 − 0.05 to 0.2 + 0.24 + 0.1 + 0.05."""
    bearing: dict[str, Any] = {"mm": [8, 8], "off": [-0.12, 0]}
    row: dict[str, Any] = {"kind": "stack", "pieces": [bearing, {"mm": [18, 22], "general": "f"}, bearing], "between": [-0.05, 0.05]}
    subject = stacked(8, 20, 8, between=36.2)

    assert form(row | {"mm": [0.05, 0.59]}).judge(subject).ok
    assert not form(row | {"mm": [0.051, 0.59]}).judge(subject).ok
    assert not form(row | {"mm": [0.05, 0.589]}).judge(subject).ok
    assert not form(row | {"mm": [0.05, 0.59]}).judge(stacked(8, 20, 8, between=36)).ok  # sizes that fit without tolerances
    assert not form(row | {"mm": [0, 9], "pieces": [bearing, {"mm": [30, 40]}, bearing]}).judge(subject).ok


def test_pieces_are_found_from_either_end() -> None:
    row: dict[str, Any] = {"kind": "stack", "mm": [0.1, 0.1]}
    for pieces in ([{"mm": [8, 8]}, {"mm": [20, 20]}], [{"mm": [20, 20]}, {"mm": [8, 8]}]):
        assert form(row | {"pieces": pieces}).judge(stacked(8, 20, between=28.1)).ok


def test_the_play_of_a_fit_is_that_of_its_limits_in_the_table() -> None:
    """10 H7/g6: a hole of 10 to 10.015 mm, a pin of 9.986 to 9.995 mm, so half of 0.005 to 0.029 mm."""
    bodies = ("plate", tube(5.005, 20, 10, 256)), ("pin", cylinder(4.996, 40, 256))
    turn = [joint("turn", "revolute", ("plate", at(0)), ("pin", at(0)))]
    row: dict[str, Any] = {"kind": "stack", "plays": [{"joint": {"type": "revolute"}, "times": 2}]}
    subject = Subject(of(*bodies, joints=turn, fits={"turn": Fit.named("H7/g6", 10)}))

    assert form(row | {"mm": [0.005, 0.029]}).judge(subject).ok
    assert not form(row | {"mm": [0.006, 0.029]}).judge(subject).ok
    assert not form(row | {"mm": [0.005, 0.028]}).judge(subject).ok
    assert not form(row | {"mm": [0, 9]}).judge(Subject(of(*bodies, joints=turn))).ok
    loose = ("plate", tube(5.2, 20, 10)), bodies[1]
    assert not form(row | {"mm": [0, 9]}).judge(Subject(of(*loose, joints=turn, fits={"turn": Fit.named("H7/g6", 10)}))).ok


@pytest.mark.slow
@pytest.mark.soak
def test_what_holds_another_back_goes_first() -> None:
    """A bolt under a flap: the flap drops by 90 degrees only once the bolt is drawn, which random values of both hardly find."""
    frame, flap_, bolt = (
        placed(box(20, 100, 300), -30, 0, -150),
        placed(box(200, 100, 10), 100.2, 0, 0),
        placed(box(180, 20, 180), 100, 0, -95.2),
    )
    drop = joint("drop", "revolute", ("frame", LEVEL), ("flap", LEVEL), limits=[(0.0, math.pi / 2)])
    draw = joint("draw", "slider", ("frame", LEVEL), ("bolt", LEVEL), limits=[(0.0, 61.0)])
    subject = Subject(of(("frame", frame), ("flap", flap_), ("bolt", bolt), joints=[drop, draw]))

    q = np.array([math.pi / 2, 61.0])
    assert comes_to(subject, q)
    assert not comes_to(subject, np.array([math.pi / 2, 50.0]))


def test_turning_a_part_into_its_thread_needs_no_force() -> None:
    assembly = screwed(thread(5, 20) + HEAD.translate([0, 0, 20]), nut())
    (step,) = (step for step in assembly.assembly_order().steps if step.permitted)

    assert step.permitted == (("bolt", "block", "screw"),)
    assert form({"kind": "put_together"}).judge(Subject(assembly)).ok


def test_what_only_pushes_pushes_where_least_energy_says() -> None:
    """Beams of random pieces on random supports, some of which only push: the deflection of least energy that sinks into none, by least squares."""
    rng = np.random.default_rng(3)
    for _ in range(120):
        count = int(rng.integers(6, 30))
        lengths, stiff = rng.uniform(5, 40, count), rng.uniform(0.2, 5, count) * 1e8
        ends, pushing = sorted(rng.choice(count + 1, 2, replace=False)), rng.random(count + 1) < rng.uniform(0.05, 0.5)
        both = np.isin(np.arange(count + 1), ends)
        loads = np.where(rng.random(count) < 0.5, rng.uniform(0, 2, count), 0.0), np.where(rng.random(count + 1) < 0.2, 500.0, 0.0)

        found = _solved(lengths, stiff, np.ones(count), loads, both, pushing, np.zeros(count + 1, dtype=bool))
        assert found is not None
        assert found.sag == pytest.approx(least_energy_sag(lengths, stiff, loads, both, pushing & ~both), rel=1e-4, abs=1e-6)


def least_energy_sag(lengths: Any, stiff: Any, loads: Any, both: Any, pushing: Any) -> float:
    """Return the largest deflection that minimizes u K u / 2 - f u with u = 0 where both ways are held, u <= 0 where something pushes."""
    size = 2 * len(both)
    K, f = np.zeros((size, size)), np.zeros(size)
    f[::2] = loads[1]
    for i, (h, k, even) in enumerate(zip(lengths, stiff, loads[0], strict=True)):
        B = np.array([[1 / h, 1, -1 / h, 0], [1 / h, 0, -1 / h, 1]])  # slopes of both ends against the chord
        K[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += B.T @ np.array([[4, 2], [2, 4]]) @ B * k / h
        f[2 * i : 2 * i + 4] += even * h * np.array([0.5, h / 12, 0.5, -h / 12])
    free = np.flatnonzero(~np.repeat(both, 2) | (np.arange(size) % 2 == 1))
    scale = 1 / np.sqrt(np.diag(K)[free])
    inverse = np.linalg.inv(K[np.ix_(free, free)] * np.outer(scale, scale))
    rows = np.array([np.where(free == 2 * node, scale, 0.0) for node in np.flatnonzero(pushing)]).reshape(-1, len(free))
    alone = inverse @ (scale * f[free])
    factor = np.linalg.cholesky(rows @ inverse @ rows.T)
    push = nnls(factor.T, np.linalg.solve(factor, rows @ alone), maxiter=10_000)[0] if len(rows) else np.zeros(0)
    moved = np.zeros(size)
    moved[free] = scale * (alone - inverse @ rows.T @ push)
    return float(np.abs(moved[::2]).max())


# ---------------------------------------------------------------------- tolerances of the measurements themselves


@pytest.mark.parametrize("height", [9.525, 12.125, 19.05])
def test_a_surface_is_one_whatever_its_height(height: float) -> None:
    """Vertices that a rotation moved by 1e-12 mm, at a height that is midway between two multiples of the step by which levels are told apart."""
    mesh = box(300, 200, 2 * height)
    up = mesh.vertices + np.array([0, 0, 1e-12]) * np.sign(mesh.vertices[:, :1])
    subject = Subject(of(("board", TriMesh(up, mesh.triangles)), joints=[]))

    (top,) = level_tops(subject, "board")
    assert (top.height, top.area) == pytest.approx((2 * height, 300 * 200))


@pytest.mark.parametrize("beside", [1.0, 0.1, 0.01, 0.002])
def test_places_that_nearly_fall_together_do_not_let_a_board_go(beside: float) -> None:
    """The load begins so far from the end of the board, where it is held, and one support ends so far beside the other."""
    board = box(L, B, H)
    ends = [Support(0, 0, both_ways=True), Support(L, L, both_ways=True)]
    across = (-L / 2 + beside, L / 2)

    found = beam(board, np.array([1.0, 0, 0]), ends, FORCE, E, across, anywhere=False)
    assert found is not None
    assert found == pytest.approx((stress_of(FORCE * L / 8), 5 * FORCE * L**3 / (384 * E * MOMENT)), rel=5e-3)

    on_blocks = [Support(0, 100, both_ways=False), Support(0, 100 + beside, both_ways=False), Support(700, L, both_ways=False)]
    two = beam(board, np.array([1.0, 0, 0]), on_blocks[1:], FORCE, E, (-L / 2, L / 2), anywhere=False)
    assert beam(board, np.array([1.0, 0, 0]), on_blocks, FORCE, E, (-L / 2, L / 2), anywhere=False) == pytest.approx(two, rel=5e-3)


def test_a_board_on_one_point_is_not_held() -> None:
    ends = (-L / 2, L / 2)
    assert beam(box(L, B, H), np.array([1.0, 0, 0]), [Support(400, 400, both_ways=True)], FORCE, E, ends, anywhere=False) is None


def test_parts_without_a_stated_mass_weigh_what_water_does() -> None:
    """A file that states no mass is not weightless."""
    heavy = arm()
    parts = [replace(part, mass=None) for part in heavy.parts.values()]
    assembly = Assembly.from_parts("made", parts=parts, joints=heavy.joints, ground="post")

    assert largest_effort(Subject(assembly), assembly.joints[0]) == pytest.approx(0.4 * 0.02 * 0.02 * 1000 * 9.81 * 0.2, rel=1e-3)


def test_a_line_along_the_side_of_a_part_is_no_line_through_a_stack() -> None:
    """The side of a post leans by 1e-5 mm, as a file with few digits leaves it; a line enters the post there, half-way up."""
    row: dict[str, Any] = {"kind": "stack", "mm": [0.1, 0.1], "pieces": [{"mm": [8, 8]}, {"mm": [20, 20]}]}
    plates = [(f"plate{i}", placed(box(60, 60, high), 0, 0, z)) for i, (high, z) in enumerate([(5, -2.5), (8, 4), (20, 18), (5, 30.6)])]
    post = placed(box(200, 60, 45), 128, 0, 17.5)  # its side is at x = 28 mm, where one line is; all others are outside
    leaning = np.where(post.vertices[:, 2:] > 0, 1e-5, -1e-5) * np.array([1.0, 0, 0])
    bodies = [*plates, ("post", TriMesh(post.vertices + leaning, post.triangles))]
    subject = Subject(of(*bodies, joints=[fixed("plate0", name) for name, _ in bodies[1:]]))

    assert form(row).judge(subject).ok


def test_lengths_of_single_precision_are_the_nominal_ones() -> None:
    """12.7 mm at some distance from the origin, as an STL file stores it in metres."""
    bodies = [
        ("left", placed(box(5, 40, 40), 97.5, 0, 0)),
        ("plate", placed(box(12.7, 40, 40), 106.4, 0, 0)),
        ("right", placed(box(5, 40, 40), 115.4, 0, 0)),
    ]
    rough = [(name, TriMesh((mesh.vertices * 1e-3).astype(np.float32).astype(float) * 1e3, mesh.triangles)) for name, mesh in bodies]
    row: dict[str, Any] = {"kind": "stack", "along": [1, 0, 0], "pieces": [{"mm": [12.7, 12.7]}], "mm": [0.2, 0.2]}
    subject = Subject(of(*rough, joints=[fixed("left", "plate"), fixed("left", "right")]))

    assert form(row).judge(subject).ok
    assert not form(row | {"mm": [0.201, 0.21]}).judge(subject).ok
