"""Parts that wait beside their places until others are in: a hub on the pin of an upper plate, over a slide that it locks into a lower plate."""

from __future__ import annotations

from functools import cache

import manifold3d as m3
import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.disassembly.opened import step_poses
from articad.disassembly.steps import AssemblyOrder, beside_words, words_of
from articad.disassembly.ways import Ways
from articad.geometry.part import Part
from articad.interference.body import body_of
from articad.interference.overlap import overlap
from articad.interference.scene import Scene
from articad.papers.items import items_of
from articad.papers.manual import manual_of
from articad.report.model import drawn_steps
from tests.disassembly.test_order import block
from tests.interference.mechanisms import IDENTITY, joint, manifold_mesh

ALONG_Y = SE3.from_axes([0.0, 0, 0], [0.0, 1, 0], [1.0, 0, 0])
SIDE = 10.0


def pin(radius: float, low: float, high: float) -> m3.Manifold:
    return m3.Manifold.cylinder(high - low, radius, radius, 32).translate([0, 0, low])


@cache
def locked(room: float = 16.0) -> Assembly:
    """The hub turns on the pin, and its tongue is in the slide, whose own tongue is in a groove: only once the hub is higher the slide leaves.

    Args:
        room: Between the hub and the upper plate [mm].
    """
    top = 24.0 + room
    plates = block((-30, 30), (-20, 20), (0, 4)) + block((-30, 30), (-20, 20), (top, top + 4)) + block((-30, -26), (-20, 20), (0, top + 4))
    solids = {
        "frame": plates - block((-2.1, 2.1), (-21, 21), (1.9, 5)) + pin(3.0, 20.0, top + 1),
        "hub": block((-SIDE, SIDE), (-SIDE, SIDE), (14, 24)) + block((-SIDE, SIDE), (-2, 2), (10, 14)) - pin(3.1, 9, 25),
        "slide": block((-SIDE, SIDE), (-SIDE, SIDE), (4.1, 13.9))
        - block((-11, 11), (-2.1, 2.1), (9.9, 14))
        + block((-2, 2), (-SIDE, SIDE), (2, 4.2)),
    }
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in solids.items()]
    joints = [
        joint("turn", "revolute", "frame", "hub", lower=(-0.001,), upper=(0.001,)),
        joint("along", "slider", "frame", "slide", at_parent=ALONG_Y, at_child=ALONG_Y, lower=(-0.02,), upper=(0.02,)),
    ]
    return Assembly.from_parts("locked", parts=parts, joints=joints, ground="frame")


@cache
def order() -> AssemblyOrder:
    return locked().assembly_order()


def test_a_part_waits_beside_its_place_until_another_one_is_in() -> None:
    assert order().ok
    assert [(step.parts, step.slides) for step in order().steps] == [
        (("frame",), False),
        (("hub",), False),
        (("slide",), False),
        (("hub",), True),
    ]
    _, hub, slide, back = order().steps
    (offset,) = {hub.beside["hub"], slide.beside["hub"]}
    assert offset[:2] == (0, 0)
    assert 15.0 < offset[2] < 16.0
    assert back.beside == {}
    (down,) = back.moves
    assert down.direction == (0, 0, -1)
    assert down.length_mm == offset[2]
    assert {step.strength for step in order().steps} == {"proven"}
    assert [step.joints for step in order().steps] == [(), (), ("along",), ("turn",)]  # a joint is made where both parts are in place
    assert AssemblyOrder.from_json(order().to_json()) == order()


def test_each_path_to_a_place_beside_and_from_there_is_free_where_it_is_sampled() -> None:
    """Booleans of the solids at 40 places of each move."""
    assembly = locked()
    scene, worst, places = assembly.scene(), -np.inf, 0
    for step in order().steps:
        poses, beyond = step_poses(assembly.mechanism, step, order().base), np.zeros(3)
        for move in reversed(step.moves):
            for share in np.linspace(0, 1, 40):
                T = SE3.from_translation(beyond - share * move.length_mm * np.array(move.direction))
                for part in step.parts:
                    for other in step.onto:
                        found = overlap(body_of(scene.meshes[other]), body_of(scene.meshes[part]), poses[other].inverse() @ T @ poses[part])
                        worst, places = max(worst, found.depth - scene.passable(part, other)), places + 1
            beyond = beyond - move.length_mm * np.array(move.direction)
    assert places > 100
    assert worst <= 0


def test_without_room_to_wait_the_parts_are_blocked() -> None:
    assert not locked(room=1.5).assembly_order().ok


def test_a_search_that_ends_at_its_limit_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = locked(room=1.5).assembly_order().blocked
    assert [each.ended for each in blocked] == [False]
    monkeypatch.setattr("articad.disassembly.order._MOST_COMPARED", 0)
    limited = locked().assembly_order()
    assert [each.ended for each in limited.blocked] == [True]
    (finding,) = limited.findings
    assert finding.message.endswith("The search ended at its limit of work: not every other pose and not every pair of moves was tried.")
    assert AssemblyOrder.from_json(limited.to_json()) == limited


def test_the_words_say_that_a_part_waits_and_when_it_goes_to_its_place() -> None:
    _, hub, slide, back = map(words_of, order().steps)
    assert hub.startswith(f"Put hub {beside_words(order().steps[1].beside['hub'])}: ")
    assert slide.endswith("with hub still beside its place.")
    assert back == "Move hub to its place: from above."


def test_the_manual_and_the_page_show_a_part_that_waits_where_it_waits() -> None:
    assembly = locked()
    pages = [page for page in manual_of(assembly, order(), items_of(assembly), dots=0.5) if page.told["page"] == "step"]
    texts = [{text.words for text in page.texts} for page in pages]
    assert ["Moved in this step" in words for words in texts] == [False, False, False, True]
    assert [page.told["items"] == [] for page in pages] == [False, False, False, True]  # what is moved only was counted before
    at = list(assembly.mechanism.parts).index("hub")
    drawn = drawn_steps(assembly, order().to_json())["steps"]
    waits = order().steps[2].beside["hub"][2]
    assert [step["poses"][str(at)][11] if step["poses"] else None for step in drawn] == [
        None,
        pytest.approx(waits),
        pytest.approx(waits),
        None,
    ]
    assert drawn[3]["path"] == [pytest.approx([0, 0, waits]), [0, 0, 0]]


def test_ways_beside_share_what_is_known_and_say_what_ways_at_these_poses_say() -> None:
    meshes = {name: part.mesh for name, part in locked().parts.items() if part.mesh is not None}
    scene, poses = Scene.of(meshes, locked().joints, deflection=0.01), dict.fromkeys(meshes, IDENTITY)
    offsets = {"hub": np.array([0.0, 0, 9]), "slide": np.array([0.0, 30, 0])}
    moved = {name: SE3.from_translation(offsets[name]) if name in offsets else T for name, T in poses.items()}
    first, afresh = Ways(scene, poses), Ways(scene, moved)
    beside = first.beside(offsets)
    assert afresh.clear_length(["hub"], ["frame"], np.eye(3)[0]) == beside.clear_length(["hub"], ["frame"], np.eye(3)[0])
    for way in (*np.eye(3), *-np.eye(3)):
        for a, b in (("hub", "frame"), ("slide", "hub"), ("frame", "slide")):
            assert beside.travel(a, b, way) == pytest.approx(afresh.travel(a, b, way), abs=1e-9)
            assert beside.met(a, b, way) == pytest.approx(afresh.met(a, b, way), abs=1e-6)
    assert first.offsets == {}
    assert first.travel("hub", "frame", np.eye(3)[2]) == pytest.approx(9 + beside.travel("hub", "frame", np.eye(3)[2]), abs=1e-9)
