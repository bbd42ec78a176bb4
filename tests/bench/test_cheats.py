"""Cheats are refused: by checks that look at bodies, in any frame, and not at what the candidate says of itself."""

from __future__ import annotations

import inspect
import json
import math
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import pytest

from articad.aliases import Json
from articad.assembly import Assembly
from articad.batches.pool import Call
from articad.connectors import SE3
from articad.geometry import Part, TriMesh, box, cylinder
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.plan.resolve import Fit, Waiver
from articad_bench.bindings import bindings, bound
from articad_bench.cheat_run import CheatRow, page, refused_by, run_cheats, sources_of, the_same
from articad_bench.cheats import CHEATS, cheats_of
from articad_bench.subject import Subject
from articad_bench.task import TASKS, Task, tasks_in
from tests.bench.test_checks import form
from tests.kinematics.linkages import at, joint

TURN = SE3.from_axis_angle(np.array([0.3, 0.5, 0.8]), 1.1) @ SE3.trans(7, -3, 11)
HINGED: dict[str, Any] = {
    "name": "hinged",
    "kind": "articulated",
    "product": "flap",
    "prompt": "A plate with a lever that turns by 90 degrees about an upright pin; the lever is 60 mm long.",
    "checks": [
        {"kind": "parts", "number": [2, 2]},
        {"kind": "freedoms", "number": 1},
        {"kind": "joints", "joint": {"type": "revolute", "axis": [0, 0, 1], "span": [89, 91]}, "number": [1, 1]},
        {"kind": "part_size", "mm": [60, None, None]},
        {"kind": "solids"},
        {"kind": "clear_at_rest"},
        {"kind": "joined"},
        {"kind": "clear_in_motion", "steps": 6},
    ],
}


def made(kind: str, *bodies: manifold3d.Manifold) -> TriMesh:
    found = manifold3d.Manifold.batch_boolean(list(bodies), getattr(manifold3d.OpType, kind)).to_mesh64()
    return TriMesh(np.asarray(found.vert_properties)[:, :3].astype(np.float64), np.asarray(found.tri_verts).astype(np.int32))


def solid(mesh: TriMesh) -> manifold3d.Manifold:
    return manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))


def placed(mesh: TriMesh, x: float, y: float, z: float) -> TriMesh:
    return mesh.transformed(SE3.trans(x, y, z))


def hinge() -> Assembly:
    """A plate with a headed pin of 10 mm, and on it a lever of 60 mm with a bore of 10.2 mm."""
    pin = made("Add", solid(box(80, 40, 6)), solid(placed(cylinder(5, 12.3), 0, 0, 8.9)), solid(placed(cylinder(8, 3), 0, 0, 16.5)))
    lever = made("Subtract", solid(placed(box(60, 20, 11.8), 18, 0, 9.0)), solid(placed(cylinder(5.1, 40), 0, 0, 9)))
    parts = [Part.from_mesh("plate", pin, density=1000), Part.from_mesh("lever", lever, density=1000)]
    joints = [joint("turn", "revolute", ("plate", at(0)), ("lever", at(0)), limits=[(0, math.pi / 2)])]
    return Assembly.from_parts("hinge", parts=parts, joints=joints, ground="plate")


def of(*bodies: tuple[str, TriMesh], joints: list[Joint]) -> Subject:
    parts = [Part.from_mesh(name, mesh, density=1000) for name, mesh in bodies]
    return Subject(Assembly.from_parts("made", parts=parts, joints=joints, ground=bodies[0][0]))


def task(**changes: Any) -> Task:
    return Task.model_validate(HINGED | changes)


# ---------------------------------------------------------------------- checks that cannot be talked to


def test_waivers_of_the_candidate_do_not_count() -> None:
    assembly = hinge()
    ghost = made("Add", solid(assembly.parts["lever"].mesh), solid(placed(box(4, 4, 30), 30, 0, 3)))  # type: ignore[arg-type]
    parts = [assembly.parts["plate"], Part.from_mesh("lever", ghost, density=1000)]
    wrong = Assembly.from_parts(
        "waived", parts=parts, joints=assembly.joints, ground="plate", waivers=[Waiver(("plate", "lever"), 1e6, "It is meant.")]
    )

    for kind in ("clear_at_rest", "clear_in_motion"):
        assert form({"kind": kind}).judge(Subject(assembly)).ok
        assert not form({"kind": kind}).judge(Subject(wrong)).ok


def test_a_slide_behind_a_fixed_joint_guides_as_well() -> None:
    """A slider carries a bracket, and the bracket a pin: the pin runs straight because it is guided."""
    slide = joint("slide", "slider", ("base", SE3.rot_y(math.pi / 2)), ("carriage", SE3.rot_y(math.pi / 2)), limits=[(0.0, 100.0)])
    held = joint("held", "fixed", ("carriage", at(0, 0, 10)), ("bracket", at(0)))
    pin = joint("pin", "revolute", ("bracket", at(0, 0, 10)), ("arm", at(0)), limits=[(0.0, 1.0)])
    bodies = [(name, placed(box(5, 5, 5), 0, 0, 20 * i)) for i, name in enumerate(("base", "carriage", "bracket", "arm"))]

    judged = form({"kind": "straight", "mm": [50, 200], "off": 0.1}).judge(of(*bodies, joints=[slide, held, pin]))

    assert not judged.ok, judged


def test_doubled_pins_and_parallel_slides_are_no_loops() -> None:
    """Two hinges on one door are one joint twice; four pins of a parallelogram are a loop."""
    door = [
        joint("low", "revolute", ("frame", at(0)), ("door", at(0)), limits=[(0.0, 1.5)]),
        joint("high", "revolute", ("frame", at(0, 0, 50)), ("door", at(0, 0, 50)), limits=[(0.0, 1.5)]),
    ]
    names = ("frame", "first", "second", "third")
    corners = [(0.0, 0.0), (50.0, 0.0), (50.0, 40.0), (0.0, 40.0)]
    bars = [
        joint(f"pin_{i}", "revolute", (names[i], at(*corners[i])), (names[(i + 1) % 4], at(*corners[i])), limits=[(-1.0, 1.0)])
        for i in range(4)
    ]
    one_loop = form({"kind": "loops", "number": [1, 1]})

    assert one_loop.judge(of(("frame", box(5, 5, 5)), ("door", box(5, 5, 5)), joints=door)).measured == "0 loops"
    assert one_loop.judge(of(*((name, box(5, 5, 5)) for name in names), joints=bars)).ok


@pytest.mark.parametrize("headed", [True, False])
def test_what_leaves_with_all_that_it_carries_is_not_held(headed: bool) -> None:
    """A lever lies on a pin, and a collar slides on the lever: the collar keeps the lever from leaving alone, and only a head keeps both."""
    post = [solid(box(80, 40, 6)), solid(placed(cylinder(5, 12.3), 0, 0, 8.9))]
    pin = made("Add", *post, *([solid(placed(cylinder(8, 3), 0, 0, 16.5))] if headed else []))
    lever = made("Subtract", solid(placed(box(60, 20, 11.8), 18, 0, 9.0)), solid(placed(cylinder(5.1, 40), 0, 0, 9)))
    collar = made("Subtract", solid(placed(box(6, 30, 20), 60, 0, 20)), solid(placed(box(6, 20.4, 12.2), 60, 0, 20)))
    raised = made("Add", solid(lever), solid(placed(box(20, 20, 11.8), 57, 0, 20)), solid(placed(box(4, 20, 22.8), 47, 0, 14.5)))
    along = SE3.rot_y(math.pi / 2)
    joints = [
        joint("turn", "revolute", ("plate", at(0)), ("lever", at(0)), limits=[(0, math.pi / 2)]),
        joint("slide", "slider", ("lever", along), ("collar", along), limits=[(-2.0, 2.0)]),
    ]
    subject = of(("plate", pin), ("lever", raised), ("collar", collar), joints=joints)

    judged = form({"kind": "captive", "number": [1, 1]}).judge(subject)

    assert judged.ok is headed, judged


@pytest.mark.parametrize("sides", [(60, 20, 12), (50, 50, 8)])
def test_the_frame_of_a_part_does_not_change_its_size(sides: tuple[float, float, float]) -> None:
    mesh = made("Subtract", solid(box(*sides)), solid(cylinder(3, 40)))
    check = form({"kind": "part_size", "mm": list(sides)})

    assert check.judge(of(("plate", mesh), joints=[])).ok
    assert check.judge(of(("plate", mesh.transformed(TURN)), joints=[])).ok
    assert not check.judge(of(("plate", mesh.transformed(TURN).scaled(1.05)), joints=[])).ok


def test_a_wire_is_no_solid_part() -> None:
    assert form({"kind": "solids"}).judge(of(("plate", box(60, 20, 0.3)), joints=[])).ok
    judged = form({"kind": "solids"}).judge(of(("wire", box(60, 0.06, 0.06)), joints=[]))
    assert not judged.ok
    assert "0.06 mm thick" in judged.measured


def test_a_thread_has_a_hand() -> None:
    right = joint("screw", "screw", ("nut", at(0)), ("bolt", at(0)), limits=[(0.0, 6.0)], lead=2.0)
    bodies = (("nut", box(20, 20, 10)), ("bolt", placed(cylinder(4, 30), 0, 0, 40)))
    check = form({"kind": "lead", "mm": 2, "hand": "right", "number": [1, 1]})

    assert check.judge(of(*bodies, joints=[right])).ok
    assert not check.judge(of(*bodies, joints=[replace(right, lead=-2.0)])).ok
    assert form({"kind": "lead", "mm": 2, "number": [1, 1]}).judge(of(*bodies, joints=[replace(right, lead=-2.0)])).ok


def test_a_disc_on_a_plate_is_no_joint_and_a_pin_in_its_bore_is_one() -> None:
    turn = joint("turn", "revolute", ("plate", at(0)), ("disc", at(0)), limits=[(0, 1.5)])
    disc = of(("plate", box(80, 40, 6)), ("disc", placed(cylinder(10, 4), 0, 0, 5.05)), joints=[turn])

    assert form({"kind": "made"}).judge(Subject(hinge())).ok
    judged = form({"kind": "made"}).judge(disc)
    assert not judged.ok
    assert judged.measured == "not: turn"


def test_bindings_hold_of_the_reference_and_of_another_construction_and_not_of_a_crumb() -> None:
    checks = bindings(task(), Subject(hinge()))
    slim = hinge()
    lever = made("Subtract", solid(slim.parts["lever"].mesh), solid(placed(box(25, 14, 40), 28, 0, 9)))  # type: ignore[arg-type]
    other = of(("plate", slim.parts["plate"].mesh), ("lever", lever), joints=list(slim.joints))  # type: ignore[arg-type]
    crumb = of(("plate", slim.parts["plate"].mesh), ("lever", placed(box(2, 2, 2), 0, 7, 8)), joints=list(slim.joints))  # type: ignore[arg-type]

    assert [check.kind for check in checks] == ["moves", "made", "matter"]
    assert all(check.judge(Subject(hinge())).ok and check.judge(other).ok for check in checks)
    assert not checks[0].judge(crumb).ok
    assert [check.kind for check in bound(bound(task(), Subject(hinge())), Subject(hinge())).checks][-3:] == ["moves", "made", "matter"]


def pictured(parts: int) -> Task:
    return task(prompt="", images=["drawing.png"], checks=[{"kind": "parts", "number": [parts, parts]}])


def shelves(*heights: float, second: float = 30.0) -> Subject:
    """A board with shelves of 60 x 40 and 60 x `second` mm at two heights."""
    sides = (40.0, second)
    bodies = [(f"shelf_{i}", placed(box(60, sides[i], 4), 0, 0, height)) for i, height in enumerate(heights)]
    joints = [joint(f"held_{i}", "fixed", ("board", at(0)), (name, at(0))) for i, (name, _) in enumerate(bodies)]
    return of(("board", placed(box(4, 60, 120), -32, 0, 0)), *bodies, joints=joints)


def test_parts_lie_where_a_picture_shows_them_whichever_way_the_whole_is_turned() -> None:
    shown = shelves(-40.0, 40.0)
    (check,) = (each for each in bindings(pictured(3), shown) if each.kind == "arranged")

    assert check.judge(shown).ok
    assert check.judge(shelves(-38.0, 42.0, second=32.0)).ok
    assert not check.judge(shelves(-40.0, 5.0)).ok  # a shelf elsewhere
    assert not check.judge(shelves(40.0, -40.0)).ok  # the deeper one above
    quarter = [
        (name, part.mesh.transformed(SE3.rot_z(math.pi / 2))) for name, part in shown.assembly.parts.items() if part.mesh is not None
    ]
    assert check.judge(of(*quarter, joints=list(shown.assembly.joints))).ok


def test_a_picture_does_not_say_whether_a_bar_is_solid_or_a_tube() -> None:
    """A bar of 40 x 20 mm before a plate of 120 x 120 x 4 mm; a plate of the same place that is the smaller one is refused."""

    def stand(*, wall: float | None, plate: float = 4.0, side: float = 120.0) -> Subject:
        bar = solid(box(40, 120, 20))
        if wall is not None:
            bar -= solid(box(40 - 2 * wall, 130, 20 - 2 * wall))
        bodies = (("bar", made("Add", bar)), ("plate", placed(box(side, plate, side), 0, -60 - plate / 2, 0)))
        return of(*bodies, joints=[joint("held", "fixed", ("bar", at(0)), ("plate", at(0)))])

    (check,) = (each for each in bindings(pictured(2), stand(wall=None)) if each.kind == "arranged")

    assert check.judge(stand(wall=2.5)).ok
    assert check.judge(stand(wall=None)).ok
    assert not check.judge(stand(wall=None, plate=12.0)).ok  # the plate is the larger one, whatever is within the bar
    assert not check.judge(stand(wall=2.5, plate=12.0)).ok


def test_a_mirror_image_is_told_from_what_a_picture_shows_and_another_construction_is_not() -> None:
    def with_handle(y: float, width: float) -> Subject:
        body = made("Add", solid(box(100, 60, 20)), solid(placed(box(width, 10, 40), 35, y, 20)))
        held = joint("held", "fixed", ("body", at(0)), ("foot", at(0)))
        return of(("body", body), ("foot", placed(box(20, 20, 10), -30, 0, -15)), joints=[held])

    shown = with_handle(25, 12)
    (check,) = (each for each in bindings(pictured(2), shown) if each.kind == "handed")

    assert check.judge(shown).ok
    assert check.judge(with_handle(22, 16)).ok
    assert not check.judge(with_handle(-25, 12)).ok
    assert [each.kind for each in bindings(pictured(2), with_handle(0, 12))] == [
        "matter",
        "arranged",
        "upright",
    ]  # it is its own mirror image
    assert [each.kind for each in bindings(task(prompt="A block with a handle."), shown)] == ["matter"]  # nothing tells left from right


def test_words_tell_the_hand_of_a_gate_by_the_side_to_which_it_opens() -> None:
    """A gate on the left post that opens to the back; the weight of the posts, which no word states, is no sign of its hand."""
    swing = {"type": "revolute", "axis": [0, 0, 1]}
    sides = [{"kind": "reaches", "joint": swing, "toward": toward, "mm": [50, 500]} for toward in ([-1, 0, 0], [0, 1, 0])]
    asked = task(
        prompt="A gate on pins at the left post, opening to +y.", checks=[{"kind": "joints", "joint": swing, "number": [1, 1]}, *sides]
    )

    def gate(left: float, right: float, *, pins: int = -1) -> Subject:
        posts = [("left", placed(box(20, left, 100), -120, left / 2, 0)), ("right", placed(box(20, right, 100), 120, right / 2, 0))]
        limits = (0.0, math.pi / 2) if pins < 0 else (-math.pi / 2, 0.0)
        hung = joint("swing", "revolute", ("left", at(100 * pins)), ("leaf", at(100 * pins)), limits=[limits])
        sill = joint("sill", "fixed", ("left", at(0)), ("right", at(0)))
        return of(*posts, ("leaf", placed(box(200, 10, 90), 0, 5, 0)), joints=[hung, sill])

    checks = bound(asked, gate(60, 20)).checks

    assert any(check.kind == "handed" for check in checks)
    assert all(check.judge(gate(60, 20)).ok for check in checks if check.kind in ("handed", "reaches"))
    assert all(check.judge(gate(38, 40)).ok for check in checks if check.kind in ("handed", "reaches"))
    for mirrored in (gate(20, 60, pins=1), gate(40, 38, pins=1)):
        assert not all(check.judge(mirrored).ok for check in checks if check.kind in ("handed", "reaches"))


@pytest.mark.parametrize(("images", "base", "fits"), [([], 6, True), ([], 14, True), ([], 60, False), (["drawing.png"], 14, False)])
def test_how_much_of_the_matter_moves_is_known_where_proportions_are_shown(images: list[str], base: float, fits: bool) -> None:
    """An orrery: how thick the base is that carries two arms, of which one is ten times as heavy, no text says."""

    def orrery(thick: float) -> Subject:
        turns = [joint(name, "revolute", ("base", at(0)), (name, at(0)), limits=[(0.0, 1.0)]) for name in ("long", "short")]
        arms = [("long", placed(box(100, 10, 10), 40, 0, 20)), ("short", placed(box(40, 5, 5), 20, 0, 40))]
        return of(("base", placed(box(100, 100, thick), 0, 0, -thick / 2)), *arms, joints=turns)

    two = {"kind": "joints", "joint": {"type": "revolute"}, "number": [2, 2]}
    checks = [check for check in bindings(task(images=images, checks=[two]), orrery(4)) if check.kind == "moves"]

    assert all(check.judge(orrery(base)).ok for check in checks) is fits


def test_bodies_lie_where_a_picture_shows_them_of_however_many_parts_they_are_made() -> None:
    """A carriage may be one part or two; a body that lies elsewhere, or has changed places with a larger one, is refused."""
    slides = [joint(f"s{i}", "slider", ("base", at(0)), (name, at(0)), limits=[(0.0, 9.0)]) for i, name in enumerate("ab")]
    held = joint("held", "fixed", ("a", at(0)), ("cap", at(0)))
    sliders = {"kind": "joints", "joint": {"type": "slider"}, "number": [2, 2]}
    chosen = task(prompt="", images=["drawing.png"], checks=[{"kind": "parts", "number": [3, 9]}, sliders])

    def product(a: float, b: float, *, cap: bool = False) -> Subject:
        bodies = [
            ("base", placed(box(200, 40, 10), 0, 0, -20)),
            ("a", placed(box(30, 20, 20), a, 0, 0)),
            ("b", placed(box(12, 20, 8), b, 0, 0)),
        ]
        return of(*bodies, *([("cap", placed(box(10, 10, 2), a, 0, 11.1))] if cap else []), joints=[*slides, *([held] if cap else [])])

    (check,) = (each for each in bindings(chosen, product(-60, 60)) if each.kind == "arranged")

    assert check.judge(product(-60, 60)).ok
    assert check.judge(product(-60, 60, cap=True)).ok
    assert not check.judge(product(-60, -20)).ok
    odd = task(prompt="", images=["drawing.png"], checks=[{"kind": "parts", "number": [3, 9]}, sliders | {"number": [2, 4]}])
    assert "arranged" not in {each.kind for each in bindings(odd, product(-60, 60))}  # there may be more slides, and more bodies


def test_a_detail_has_a_hand_and_who_leaves_it_out_is_no_mirror_image() -> None:
    def with_knob(y: float | None) -> Subject:
        knob = [] if y is None else [solid(placed(box(10, 8, 8), 40, y, 12))]
        return of(("body", made("Add", solid(box(100, 60, 20)), *knob)), joints=[])

    (check,) = (each for each in bindings(pictured(1), with_knob(20)) if each.kind == "handed")

    assert check.judge(with_knob(20)).ok
    assert check.judge(with_knob(None)).ok
    assert not check.judge(with_knob(-20)).ok


def test_threads_are_right_handed_where_nothing_is_said() -> None:
    bodies = (("nut", box(20, 20, 10)), ("bolt", placed(cylinder(4, 30), 0, 0, 40)))
    screws = {
        lead: of(*bodies, joints=[joint("s", "screw", ("nut", at(0)), ("bolt", at(0)), limits=[(0.0, 6.0)], lead=lead)])
        for lead in (2.0, -2.0)
    }
    (check,) = (each for each in bindings(task(checks=[]), screws[2.0]) if each.kind == "threads")

    assert check.judge(screws[2.0]).ok
    assert not check.judge(screws[-2.0]).ok
    stated = task(checks=[{"kind": "lead", "mm": 2, "hand": "right"}])
    assert "threads" not in {each.kind for each in bindings(stated, screws[2.0])}


def test_a_size_may_be_given_as_from_and_to() -> None:
    longest, height = ({"kind": "extent", "side": side, "mm": [90, 110]} for side in ("longest", "z"))

    assert form(longest).judge(of(("bar", box(20, 100, 10)), joints=[])).ok
    assert not form(longest).judge(of(("bar", box(20, 1000, 10)), joints=[])).ok
    assert not form(height).judge(of(("bar", box(20, 100, 10)), joints=[])).ok


# ---------------------------------------------------------------------- the suite


def test_what_is_left_out_moves_or_stands_in_the_text() -> None:
    """A nut that nobody asks for may be missing; a leg of "four legs" may not; what is fixed to a body goes with it."""
    fixed = [joint(name, "fixed", ("plate", at(0)), (name, at(0))) for name in ("leg_left", "pivot_nut")]
    cap = joint("cap", "fixed", ("lever", at(0)), ("cap", at(0)))
    reference = hinge()
    parts = [*reference.parts.values(), *(Part.from_mesh(n, box(5, 5, 5), density=1000) for n in ("leg_left", "pivot_nut", "cap"))]
    whole = Assembly.from_parts("whole", parts=parts, joints=[*reference.joints, *fixed, cap], ground="plate")

    def left(prompt: str) -> set[str]:
        (cheat,) = cheats_of(task(prompt=prompt), whole, ("omitted",))
        return set(whole.parts) - set(cheat.assembly.parts)

    assert left("It stands on four legs, with a lever on a pivot.") == {"leg_left"}
    assert left("A lever on a pivot, to the left.") == {"lever", "cap"}


def test_a_cheat_declares_the_fits_of_the_reference() -> None:
    """Without them it would be refused for what it does not say, and not for what it is."""
    fit = Fit.named("H7/g6", 10.0)
    fitted = Assembly.from_parts("hinge", parts=hinge().parts.values(), joints=hinge().joints, ground="plate", fits={"turn": fit})

    kinds = ("wires", "misplaced", "waived", "scaled")
    assert [dict(cheat.assembly.fits) for cheat in cheats_of(task(), fitted, kinds)] == [{"turn": fit}] * len(kinds)
    (omitted,) = cheats_of(task(), fitted, ("omitted",))
    assert dict(omitted.assembly.fits) == {}


def test_a_shell_of_a_thick_board_fills_too_little() -> None:
    board = of(("board", box(800, 400, 30)), joints=[])
    (check,) = bindings(task(checks=[]), board)
    (shell,) = cheats_of(task(checks=[]), board.assembly, ("shells",))

    assert check.judge(board).ok
    assert check.judge(of(("board", box(800, 400, 18)), joints=[])).ok
    assert form({"kind": "solids"}).judge(Subject(shell.assembly)).ok  # its walls are 0.3 mm
    assert not check.judge(Subject(shell.assembly)).ok


def test_bodies_of_the_same_shape_may_be_exchanged() -> None:
    """That is the same product; two of different shapes make another."""
    assert the_same("swapped", shelves(-40.0, 40.0, second=40.0).assembly, shelves(40.0, -40.0, second=40.0).assembly)
    assert not the_same("swapped", shelves(-40.0, 40.0).assembly, shelves(40.0, -40.0).assembly)


def test_a_mirror_image_is_the_same_where_the_whole_has_no_hand() -> None:
    def mirrored(*bodies: manifold3d.Manifold) -> bool:
        assembly = of(("body", made("Add", *bodies)), joints=[]).assembly
        (cheat,) = cheats_of(pictured(1), assembly, ("mirrored",))
        return the_same("mirrored", assembly, cheat.assembly)

    assert mirrored(solid(box(100, 60, 20)), solid(placed(box(10, 8, 8), 40, 0, 12)))
    assert not mirrored(solid(box(100, 60, 20)), solid(placed(box(10, 8, 40), 40, 20, 20)))


def tub() -> Assembly:
    """A board, and on it an open tub that slides out by 50 mm toward -y."""
    hollow = made("Subtract", solid(placed(box(80, 60, 40), 0, 0, 25)), solid(placed(box(70, 50, 40), 0, 0, 30)))
    parts = [Part.from_mesh("board", box(100, 160, 10), density=700), Part.from_mesh("tub", hollow, density=700)]
    out = joint("draw", "slider", ("board", at(0) @ SE3.rot_x(math.pi / 2)), ("tub", at(0) @ SE3.rot_x(math.pi / 2)), limits=[(0.0, 50.0)])
    return Assembly.from_parts("tub", parts=parts, joints=[out], ground="board")


@pytest.mark.parametrize(
    ("kind", "row"),
    [
        ("weightless", {"kind": "weighs", "joint": {"type": "slider"}, "kg": [0.04, 0.06]}),
        ("weightless", {"kind": "weighs", "mm": [40, 60, 80], "kg": [0.04, 0.06]}),
        ("brimful", {"kind": "holds", "joint": {"type": "slider"}, "ml": [110, 130], "number": [1, 1]}),
        ("backward", {"kind": "reaches", "joint": {"type": "slider"}, "toward": [0, -1, 0], "mm": [49, 51]}),
    ],
)
def test_a_trick_is_tried_where_a_check_names_what_it_misses_and_is_refused_by_it(kind: str, row: dict[str, Any]) -> None:
    product = tub()
    asked = Task.model_validate({"name": "tub", "kind": "articulated", "product": "tub", "prompt": "A tub on a board.", "checks": [row]})

    assert form(row).judge(Subject(product)).ok
    (cheat,) = cheats_of(asked, product, (kind,))
    assert not form(row).judge(Subject(cheat.assembly)).ok
    assert [*cheats_of(asked.model_copy(update={"checks": ()}), product, (kind,))] == []


@pytest.mark.parametrize("kind", ["notched", "slipped"])
def test_what_sheets_do_not_show_is_refused(kind: str) -> None:
    product = hinge()
    drawn = {"form": "sheets"}
    asked = bound(Task.model_validate(HINGED | {"prompt": "", "images": ["sheet_1.png"], "drawing": drawn}), Subject(product))

    (cheat,) = cheats_of(asked, product, (kind,))
    wrong = {judged.kind for judged in asked.judge(Subject(cheat.assembly)) if not judged.ok}
    assert ("machined" if kind == "notched" else "arranged") in wrong
    assert refused_by(asked, Subject(product)) is None


def test_what_photos_do_not_show_is_refused() -> None:
    product = hinge()
    asked = bound(Task.model_validate(HINGED | {"prompt": "", "images": ["photo_1.jpg"], "drawing": {"form": "photos"}}), Subject(product))

    (cheat,) = cheats_of(asked, product, ("barred",))

    assert "outlined" in {judged.kind for judged in asked.judge(Subject(cheat.assembly)) if not judged.ok}
    assert refused_by(asked, Subject(product)) is None
    assert refused_by(asked, Subject(product).turned(1)) is None


def test_a_comb_is_no_stack_and_a_stack_on_one_side_is_none_on_both() -> None:
    """Three blocks of 10 mm between two jaws, in one piece and in five; beside them, as asked for, once more."""

    def blocks(x: float) -> list[TriMesh]:
        ends = [placed(box(10, 10, 4), x, 0, z) for z in (-2, 32.2)]
        return [*ends, *(placed(box(10, 10, 9.95), x, 0, 5.05 + 10.05 * i) for i in range(3))]

    def judge(*meshes: tuple[str, TriMesh], sides: list[float] | None = None) -> bool:
        fixed = [joint(f"j{i}", "fixed", (meshes[0][0], at(0)), (name, at(0))) for i, (name, _) in enumerate(meshes[1:])]
        row = {"kind": "stack", "pieces": [{"mm": [9.9, 10]}] * 3, "mm": [0.1, 1], "sides": sides}
        return form(row).judge(of(*meshes, joints=fixed)).ok

    several = [(f"b{i}", mesh) for i, mesh in enumerate(blocks(0))]
    comb = made("Add", *(solid(mesh) for mesh in blocks(0)), solid(placed(box(4, 10, 38.2), 6, 0, 15.1)))
    assert judge(*several)
    assert not judge(("comb", comb), ("other", placed(box(1, 1, 1), 50, 0, 0)))
    assert judge(*several, sides=[1, 0, 0])
    halves = [(name, placed(mesh, 0, 0, 0) if name != "b0" else placed(box(4, 10, 4), -3, 0, -2)) for name, mesh in several]
    assert not judge(*halves, sides=[1, 0, 0])


def test_a_sleeve_that_is_stuck_slides_and_does_not_turn() -> None:
    assembly = hinge()
    (turn,) = assembly.joints
    limits = JointLimits((0.0, -1.0), (40.0, 1.0))
    lifted = replace(turn, type=JointType.CYLINDRICAL, rest=(0.0, 0.0), limits=limits)
    sleeve = Assembly.from_parts("sleeve", parts=assembly.parts.values(), joints=[lifted], ground="plate")
    wanted = {"type": "cylindrical", "span": [39, 41]}

    (cheat,) = cheats_of(task(), sleeve, ("stuck",))

    assert list(cheats_of(task(), assembly, ("stuck",))) == []
    assert form({"kind": "joints", "joint": wanted, "number": [1, 1]}).judge(Subject(cheat.assembly)).ok
    turning = form({"kind": "joints", "joint": wanted | {"turn": [110, 120]}, "number": [1, 1]})
    assert [turning.judge(Subject(each)).ok for each in (sleeve, cheat.assembly)] == [True, False]


def test_no_cheat_of_a_bound_task_passes_and_the_reference_does() -> None:
    reference = hinge()
    chosen = bound(task(), Subject(reference))

    assert refused_by(chosen, Subject(reference)) is None
    found = {cheat.kind: refused_by(chosen, Subject(cheat.assembly)) for cheat in cheats_of(chosen, reference, other=reference)}
    other = found.pop("other")

    assert other is None  # it was given the reference itself
    assert set(found) == {"discs", "wires", "shells", "misplaced", "omitted", "swapped", "scaled", "merged", "waived"} - {"swapped"}
    assert [kind for kind, refused in found.items() if refused is None] == []


def test_discs_pass_the_checks_of_joints_alone() -> None:
    """What the suite is for: types, axes, ranges, numbers and sizes are met by discs."""
    (discs,) = cheats_of(task(), hinge(), ("discs",))

    assert refused_by(task(checks=HINGED["checks"][:7]), Subject(discs.assembly)) is None
    refused = refused_by(bound(task(), Subject(hinge())), Subject(discs.assembly))
    assert refused is not None
    assert refused[0] in {"moves", "made"}


def test_a_mirror_image_moves_as_a_mirror_image_and_only_where_a_hand_is_stated() -> None:
    assembly = hinge()
    assert list(cheats_of(task(), assembly, ("mirrored",))) == []

    (mirrored,) = cheats_of(task(prompt="The lever lies to the left of the pin."), assembly, ("mirrored",))

    K = np.diag([1.0, -1.0, 1.0, 1.0])
    for angle in (0.0, 0.4, 1.2):
        pose = mirrored.assembly.at(turn=-angle)["lever"].matrix
        assert pose == pytest.approx(K @ assembly.at(turn=angle)["lever"].matrix @ K, abs=1e-12)


@pytest.mark.slow
def test_a_run_of_the_suite_is_kept_and_made_anew_only_where_something_changed(tmp_path: Path) -> None:
    chosen, every, told = tasks_in(TASKS, names=["bracket_corner"]), tasks_in(TASKS), []

    first = run_cheats(chosen, tmp_path, every=every, tell=lambda case, _: told.append(case))
    tried = len(told)
    again = run_cheats(chosen, tmp_path, every=every, tell=lambda case, _: told.append(case))

    assert (first["ok"], first["tried"], first["tasks"]) == (True, 1, len(every))
    assert tried >= 4
    assert len(told) == tried
    assert again == first
    page = (tmp_path / "cheats.md").read_text()
    assert "| scaled | 1 | 0 | 0 | size 1 |" in page
    changed = chosen[0][1].model_copy(update={"checks": chosen[0][1].checks[:1]})
    stale = run_cheats([], tmp_path, every=[(chosen[0][0], changed)])
    assert {row["earlier"] for row in stale["rows"]} == {True}
    assert f"{len(stale['rows'])} of {len(stale['rows'])} answers are of earlier checks" in (tmp_path / "cheats.md").read_text()
    later = run_cheats([(chosen[0][0], changed)], tmp_path, every=[(chosen[0][0], changed)], tell=lambda case, _: told.append(case))
    assert len(told) > tried
    assert {row["earlier"] for row in later["rows"]} == {False}
    assert not later["ok"]  # one check alone is passed by cheats, and the report says so
    assert ["bracket_corner", "scaled"] in later["passed"]
    assert json.loads((tmp_path / "cheats.json").read_text())["passed"] == later["passed"]


def test_cheats_are_tried_in_other_processes_and_each_answer_is_kept_as_it_comes(tmp_path: Path) -> None:
    chosen, every, kept = tasks_in(TASKS, names=["bracket_corner", "mug_straight", "vase_cone"]), tasks_in(TASKS), []

    def spread(calls: list[Call], keep: Callable[[Json], None]) -> None:
        for call in calls:
            row = CheatRow(Path(str(call.arguments["folder"])).name, "discs", "size", "", same=False, digest=str(call.arguments["digest"]))
            keep({"rows": [asdict(row)]})
            kept.append(json.loads((tmp_path / "cheats.json").read_text())["tried"])

    report = run_cheats(chosen, tmp_path, every=every, some=2, spread=spread)

    assert kept == [1, 2]
    assert report["tried"] == 2
    assert run_cheats(chosen, tmp_path, every=every, spread=spread)["tried"] == 3


def test_a_check_that_changes_makes_rows_of_its_own_tasks_old() -> None:
    """Each file that a kind of check of a task comes from is counted, and one that only holds checks of other tasks is not."""
    every = {task.name: task for _, task in tasks_in(TASKS)}
    homes = {name: {Path(inspect.getfile(type(check))).name for stage in task.stages for check in stage} for name, task in every.items()}

    assert all(homes[name] <= set(sources_of(task)) for name, task in every.items())
    assert {name for name, task in every.items() if "gear_checks.py" in sources_of(task)} == {"gears_18_36", "repair_gears"}
    assert all({"checks.py", "subject.py", "cheats.py"} <= set(sources_of(task)) for task in every.values())


def test_every_kind_of_cheat_is_explained_and_the_page_is_that_of_its_results() -> None:
    folder = Path(__file__).resolve().parents[2] / "docs" / "reference"
    stored = json.loads((folder / "cheats.json").read_text(encoding="utf-8"))
    text = (folder / "cheats.md").read_text(encoding="utf-8")

    assert all(f"| {kind} |" in text for kind in (*CHEATS, "other"))
    rows = [CheatRow(**row) for row in stored["rows"]]
    assert text == page(stored, rows)
    assert stored["ok"] is (not stored["passed"])
    assert stored["passed"] == [[row.task, row.named] for row in rows if row.refused_by is None and not row.same]
