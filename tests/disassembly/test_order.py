"""Orders of assembly of small products whose order is known, and parts that no order can take."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import manifold3d as m3
import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.disassembly.order import assembly_order
from articad.disassembly.poses import OtherPose
from articad.disassembly.steps import AssemblyOrder, AssemblyStep, Move, words_of
from articad.disassembly.ways import Ways
from articad.errors import UnknownJointError
from articad.geometry.part import Part
from articad.interference.body import body_of
from articad.interference.overlap import overlap
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint
from tests.interference.mechanisms import fixed, joint, manifold_mesh

IDENTITY = SE3.identity()


def block(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> m3.Manifold:
    return m3.Manifold.cube([x[1] - x[0], y[1] - y[0], z[1] - z[0]]).translate([x[0], y[0], z[0]])


def ordered(solids: Mapping[str, m3.Manifold], joints: list[Joint], ground: str, *others: OtherPose, **options: object) -> AssemblyOrder:
    scene = scene_of(solids, joints)
    return assembly_order(scene, dict.fromkeys(solids, IDENTITY), ground, others=others, **options)  # type: ignore[arg-type]


def scene_of(solids: Mapping[str, m3.Manifold], joints: list[Joint]) -> Scene:
    return Scene.of({name: manifold_mesh(solid) for name, solid in solids.items()}, joints)


def names(order: AssemblyOrder) -> list[tuple[str, ...]]:
    return [step.parts for step in order.steps]


def deepest(scene: Scene, step: AssemblyStep) -> float:
    """Return how much deeper than allowed parts overlap at 60 places of each move of a step, measured by Booleans of the solids."""
    worst, beyond = -np.inf, np.zeros(3)
    ways = Ways(scene, dict.fromkeys(scene.bodies, IDENTITY))
    for move in reversed(step.moves):  # out again
        out = -np.array(move.direction)
        for share in np.linspace(0, 1, 60):
            T = SE3.from_translation(beyond + share * move.length_mm * out)
            for part in step.parts:
                for other in step.onto:
                    found = overlap(body_of(scene.meshes[other]), body_of(scene.meshes[part]), T)
                    worst = max(worst, found.depth - ways.depth(part, other))
        beyond = beyond + move.length_mm * out
    return worst


BOX = block((0, 40), (0, 40), (0, 30)) - block((4, 36), (4, 36), (4, 31))
INSIDE = block((10, 20), (10, 20), (4, 20))
LID = block((0, 40), (0, 40), (30, 34))


def test_what_is_under_a_lid_comes_before_the_lid_and_from_above() -> None:
    solids = {"lid": LID, "thing": INSIDE, "box": BOX}
    order = ordered(solids, [fixed("a", "box", "lid"), fixed("b", "box", "thing")], "box")
    assert order.ok
    assert names(order) == [("box",), ("thing",), ("lid",)]
    assert [move.direction for step in order.steps for move in step.moves] == [(0, 0, -1)] * 2
    assert order.steps[1].moves[0].length_mm == pytest.approx(27.0)  # 30 - 4 + 1
    assert [step.joints for step in order.steps] == [(), ("b",), ("a",)]


def test_every_path_is_free_where_it_is_sampled() -> None:
    joints = [fixed("a", "box", "lid"), fixed("b", "box", "thing")]
    solids = {"lid": LID, "thing": INSIDE, "box": BOX}
    scene = scene_of(solids, joints)
    assert max(deepest(scene, step) for step in ordered(solids, joints, "box").steps if step.moves) <= 0


def test_a_thing_in_a_closed_box_is_blocked_by_the_box_and_named() -> None:
    order = ordered({"box": BOX + LID, "thing": INSIDE}, [fixed("b", "box", "thing")], "box")
    assert not order.ok
    (blocked,) = order.blocked
    assert blocked.parts == ("box", "thing")
    (far,) = (row for row in blocked.stops if row.part == "thing")
    assert far.by == "box"
    assert far.travel_mm == pytest.approx(16.0, abs=0.1)  # sideways, from 20 to 36, and the depth that may overlap
    assert order.findings[0].code == "W_NOT_INSERTABLE"
    assert AssemblyOrder.from_json(order.to_json()) == order


def test_a_part_that_snaps_into_place_is_a_permitted_step() -> None:
    order = ordered({"box": BOX + LID, "thing": INSIDE}, [fixed("b", "box", "thing")], "box", fastenings={"b": "snap"})
    assert order.ok
    assert order.steps[1].strength == "permitted"
    assert order.steps[1].permitted == (("thing", "box", "snap"),)


def test_what_is_joined_by_force_comes_from_where_it_meets_least() -> None:
    """A peg behind a lip 2 mm from its place, under a roof: it snaps over the lip, and does not come through the roof."""
    case = block((0, 60), (0, 60), (0, 10)) + block((0, 60), (0, 4), (10, 14)) + block((0, 60), (0, 60), (40, 50))
    case += block((0, 60), (56, 60), (10, 40)) + block((0, 4), (0, 60), (10, 40)) + block((56, 60), (0, 60), (10, 40))
    peg = block((20, 30), (6, 20), (10, 20))
    order = ordered({"case": case, "peg": peg}, [fixed("f", "case", "peg")], "case", fastenings={"f": "snap"})
    (step,) = order.steps[1:]
    assert step.strength == "permitted"
    assert step.moves[0].direction == (0, 1, 0)
    assert step.forced_mm == pytest.approx(20.0, abs=0.1)  # from the front edge of the lip to the back of the peg


def test_a_rail_that_snaps_between_two_sides_comes_from_the_open_front_before_the_door() -> None:
    """The way through the back is a quarter as long, but the whole rail would go through it."""
    case = block((0, 200), (0, 60), (0, 100)) - block((5, 195), (-1, 56), (5, 95))
    solids = {"case": case - block((2, 198), (46, 54), (60, 68)), "rail": block((2, 198), (46, 54), (60, 68))}
    solids["door"] = block((0, 200), (-6, 0), (0, 100))
    order = ordered(solids, [replace(fixed("r", "case", "rail"), fastening="snap"), fixed("d", "case", "door")], "case")
    assert names(order) == [("case",), ("rail",), ("door",)]
    assert order.steps[1].moves[0].direction == (0, 1, 0)
    assert order.steps[1].forced_mm == pytest.approx(54.0, abs=0.1)


def test_screws_and_adhesive_do_not_let_shapes_through_each_other() -> None:
    for how in ("screw", "adhesive"):
        order = ordered({"box": BOX + LID, "thing": INSIDE}, [fixed("b", "box", "thing")], "box", fastenings={"b": how})
        assert not order.ok


def test_how_parts_are_fastened_is_stated_at_the_step_that_joins_them() -> None:
    glued = replace(fixed("b", "box", "thing"), fastening="adhesive")
    order = ordered({"lid": LID, "thing": INSIDE, "box": BOX}, [fixed("a", "box", "lid"), glued], "box", fastenings={"a": "snap"})
    assert [step.fastened for step in order.steps] == [{}, {"b": "adhesive"}, {"a": "snap"}]
    assert [step.strength for step in order.steps] == ["proven"] * 3  # the lid has a free way, too


def test_a_pair_that_is_bought_as_one_is_never_taken_apart() -> None:
    bearing = {"ring": BOX + LID, "inner": INSIDE, "seat": block((-5, 45), (-5, 45), (-10, 0))}
    joints = [replace(fixed("b", "ring", "inner"), fastening="purchased"), fixed("s", "seat", "ring")]
    order = ordered(bearing, joints, "seat")
    assert order.ok
    assert names(order) == [("seat",), ("inner", "ring"), ("inner", "ring")] or names(order) == [
        ("seat",),
        ("ring", "inner"),
        ("ring", "inner"),
    ]
    assert order.steps[1].subassembly == "ring_as_bought"
    assert order.steps[1].permitted == (("ring", "inner", "purchased"),)
    on_ground = ordered(bearing, joints, "ring")  # the base, too
    assert on_ground.ok
    assert set(on_ground.steps[0].parts) == {"ring", "inner"}


def test_a_part_that_no_order_takes_is_taken_when_its_hint_is_followed() -> None:
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in {"box": BOX + LID, "thing": INSIDE}.items()]
    product = Assembly.from_parts(
        "boxed", parts=parts, joints=[joint("b", "revolute", "box", "thing", lower=(-1.0,), upper=(1.0,))], ground="box"
    )
    (finding,) = product.assembly_order().findings
    (call,) = re.findall(r"assembly_order\(fastenings=({.*?})\)", finding.hint)
    assert product.assembly_order(ast.literal_eval(call)).ok
    with pytest.raises(UnknownJointError, match="Known: b"):
        product.assembly_order({"lid": "snap"})


def test_a_t_foot_goes_through_the_wide_end_of_its_keyhole_in_two_moves() -> None:
    slot = block((6, 34), (17, 23), (-1, 11)) + block((24, 35), (12, 28), (-1, 11)) + block((4, 36), (11, 29), (4, 8))
    plate = block((0, 40), (0, 40), (0, 10)) - slot + block((3, 37), (10, 30), (-2, 0))
    foot = block((8, 14), (17.5, 22.5), (4, 20)) + block((7, 15), (13, 27), (4.5, 7.5))
    solids, joints = {"plate": plate, "foot": foot}, [fixed("f", "plate", "foot")]
    order = ordered(solids, joints, "plate")
    assert order.ok
    down, along = order.steps[1].moves
    assert down.direction == (0, 0, -1)
    assert along.direction == (-1, 0, 0)
    assert deepest(scene_of(solids, joints), order.steps[1]) <= 0


def test_a_first_move_is_no_longer_than_twice_what_is_needed() -> None:
    """A pin in a blind hole under a high ceiling leaves sideways as soon as it is out of its hole."""
    case = block((0, 60), (0, 60), (0, 10)) + block((0, 60), (50, 60), (0, 300)) + block((0, 60), (0, 60), (290, 300))
    pin = block((28, 32), (28, 32), (4, 20))
    order = ordered({"case": case - block((27.9, 32.1), (27.9, 32.1), (4, 11)), "pin": pin}, [fixed("f", "case", "pin")], "case")
    assert order.ok
    *_, down = order.steps[1].moves
    assert down.direction == (0, 0, -1)
    assert 6.0 - 0.1 <= down.length_mm <= 12.0


def test_parts_that_lock_each_other_into_a_base_go_in_as_a_sub_assembly() -> None:
    # a dovetailed pair that separates along y only, in a pit that is as long as the pair
    pit = block((0, 40), (0, 40), (0, 30)) - block((5, 35), (5, 35), (5, 31))
    key = block((15, 25), (5, 35), (10, 20))
    left = block((5, 25), (5, 35), (5, 28)) - key
    solids = {"pit": pit, "holder": left, "key": key}
    order = ordered(solids, [fixed("h", "pit", "holder"), joint("k", "slider", "holder", "key")], "pit")
    assert order.ok
    assert names(order)[0] == ("pit",)
    assert set(names(order)[-1]) <= {"holder", "key"}


def test_a_drawer_that_a_door_bars_goes_in_while_the_door_is_open() -> None:
    case = block((0, 40), (0, 60), (0, 30)) - block((4, 36), (4, 61), (4, 26))
    thing = block((6, 34), (6, 50), (4, 24))
    ears = block((40, 44), (50, 64), (0, 30)) - block((41, 44.1), (61, 65), (8, 22))
    door = block((2, 43), (61.5, 63.5), (8.5, 21.5))
    solids = {"case": case + ears, "door": door, "thing": thing}
    joints = [joint("hinge", "revolute", "case", "door"), fixed("t", "case", "thing")]
    opened = dict.fromkeys(solids, IDENTITY) | {"door": SE3.from_translation(np.array([42.0, 0.0, 0.0]))}
    order = ordered(solids, joints, "case", OtherPose({"hinge": 1.5}, opened))
    assert order.ok
    assert names(order) in ([("case",), ("thing",), ("door",)], [("case",), ("door",), ("thing",)])


def test_a_search_keeps_the_outlines_of_all_its_poses_in_one_place(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Ways] = []
    first = Ways.__init__

    def noted(self: Ways, *args: Any, **options: Any) -> None:
        first(self, *args, **options)
        made.append(self)

    monkeypatch.setattr(Ways, "__init__", noted)
    solids = {"box": BOX + LID, "thing": INSIDE}
    poses = dict.fromkeys(solids, IDENTITY)
    others = [OtherPose({"slide": z}, {**poses, "thing": SE3.from_translation((0, 0, z))}) for z in (1.0, 2.0)]
    assert not ordered(solids, [fixed("b", "box", "thing")], "box", *others).ok
    assert len(made) == 3
    assert len({id(ways.outlines) for ways in made}) == 1


def test_a_part_that_only_comes_from_below_is_put_in_place_with_the_assembly_turned_over() -> None:
    # a plug in a pocket that opens downwards, and a lid on top: the lid is lowered, the plug comes from below
    body = block((0, 40), (0, 40), (0, 30)) - block((15, 25), (15, 25), (-1, 12))
    solids = {"body": body, "plug": block((15, 25), (15, 25), (0, 12)), "lid": block((5, 35), (5, 35), (30, 34))}
    order = ordered(solids, [fixed("in", "body", "plug"), fixed("on", "body", "lid")], "body")
    words = {step.parts[0]: words_of(step) for step in order.steps}
    assert words["plug"] == "Put plug in place: from below, with the assembly turned over or held up."
    assert words["lid"] == "Put lid in place: from above."


SIDES = {"the left": (0, -1), "the right": (0, 1), "the front": (1, -1), "the back": (1, 1), "the bottom": (2, -1), "the top": (2, 1)}
FROM = {"left": "the left", "right": "the right", "front": "the front", "behind": "the back", "below": "the bottom", "above": "the top"}


@pytest.mark.parametrize("seed", range(30))
def test_the_words_of_an_oblique_way_say_its_direction(seed: int) -> None:
    """The side that is named first, turned by the angle towards the others, is where the part comes from, within the digits that are shown."""
    rng = np.random.default_rng(seed)
    back = rng.normal(size=3) * (rng.random(3) < (1.0 if seed % 3 else 0.7))
    back = back / np.linalg.norm(back) if back.any() else np.array([0.0, 0.0, 1.0])
    move = Move(direction=tuple((-back).tolist()), length_mm=10.0, apart_mm=10.0)
    words = words_of(AssemblyStep(number=2, assembly="whole", parts=("pin",), onto=("base",), moves=(move,))).removesuffix(".")
    words = words.removesuffix(", with the assembly turned over or held up").removeprefix("Put pin in place: from ")
    main, _, rest = words.partition(", ")
    axis, sign = SIDES[FROM[main.removeprefix("the ")]]
    angle = math.radians(float(rest.partition("°")[0])) if rest else 0.0
    towards = [SIDES[side] for side in rest.partition(" towards ")[2].split(" and ")] if rest else []

    assert axis == int(np.abs(back).argmax())
    assert sign * back[axis] == pytest.approx(math.cos(angle), abs=5e-3)
    assert {(place, float(np.sign(back[place]))) for place, _ in towards} == set(towards)
    assert {place for place, _ in towards} == {place for place in range(3) if abs(back[place]) > 1e-6} - {axis}
