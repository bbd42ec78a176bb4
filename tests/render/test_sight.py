"""Keyframes show what moves: in each the moving parts are seen, and each differs from the one before. Judged by the pixels that are drawn."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box, cylinder, sphere
from articad.kinematics import declare
from articad.render import best_view, motion_frames, pictures, render_motion, render_views
from articad.render.scene import AxisMark, scene_of
from articad.render.sight import sights

TITLE = 48  # rows of a picture that the caption and what is looked through may take
UPRIGHT = Connector("axis", SE3.identity())
DIFFERENT = 24  # of 255
LEAST = 40  # pixels of a picture of 320 × 320
HAND = 25  # of these: a hand of 30 pixels that turns by 72 degrees, seen at a slant


def drawn(assembly: Assembly, joint: str, frames: int = 6) -> list[FloatArray]:
    """Return the keyframes without their titles."""
    return [np.asarray(frame, dtype=np.float64)[TITLE:] for frame in render_motion(assembly, joint, frames=frames, supersample=1)]


def differing(first: FloatArray, second: FloatArray) -> int:
    """Return the number of pixels that differ clearly."""
    return int((np.abs(first - second).max(axis=-1) > DIFFERENT).sum())


def recoloured(assembly: Assembly, moving: tuple[str, ...], color: str) -> Assembly:
    """Return an assembly whose moving parts have another colour."""
    parts = [
        replace(part, color=color, visuals=tuple(replace(shape, color=color) for shape in part.visuals)) if name in moving else part
        for name, part in assembly.parts.items()
    ]
    return Assembly.from_parts(assembly.name, parts=parts, joints=assembly.joints, ground=assembly.ground)


def shut_in(mover: Part, limits: tuple[float, float] | Literal["endless"] = (0.0, 1.5)) -> Assembly:
    """Return a part that turns inside four walls, a floor and a ceiling."""
    walls = [
        Part.from_mesh(name, box(*size).transformed(SE3.from_translation(at)), connectors={"axis": UPRIGHT})
        for name, size, at in (
            ("floor", (100, 100, 4), (0, 0, -30)),
            ("ceiling", (100, 100, 4), (0, 0, 30)),
            ("left", (4, 100, 60), (-50, 0, 0)),
            ("right", (4, 100, 60), (50, 0, 0)),
            ("front", (100, 4, 60), (0, -50, 0)),
            ("back", (100, 4, 60), (0, 50, 0)),
        )
    ]
    joints = [declare.fixed(f"{wall.name}_held", walls[0]["axis"], wall["axis"]) for wall in walls[1:]]
    joints.append(declare.revolute("turn", walls[0]["axis"], mover["axis"], limits=limits))
    return Assembly.from_parts("oven", parts=[*walls, mover], joints=joints, ground="floor")


def test_what_hides_a_mover_on_all_sides_is_of_glass() -> None:
    bar = Part.from_mesh("bar", box(70, 10, 10), connectors={"axis": UPRIGHT}, color="#2040c0")
    assembly = shut_in(bar)

    frames = drawn(assembly, "turn")
    other = drawn(recoloured(assembly, ("bar",), "#d03020"), "turn")

    assert min(differing(a, b) for a, b in zip(frames, other, strict=True)) > LEAST, "the mover is in each picture"
    assert min(differing(a, b) for a, b in itertools.pairwise(frames)) > LEAST, "each differs from the one before"


def test_no_more_is_of_glass_than_what_hides_the_mover() -> None:
    assembly = shut_in(Part.from_mesh("bar", box(70, 10, 10), connectors={"axis": UPRIGHT}))
    _, q = motion_frames(assembly, "turn", 3)
    scenes = pictures._motion_scenes(assembly, "turn", q)

    _, through, hand = pictures._shot(scenes, pictures._shown(scenes))

    assert len(through) == 1
    assert not hand


def test_a_mover_that_can_be_seen_from_another_side_needs_no_glass() -> None:
    wall = Part.from_mesh("wall", box(100, 4, 100).transformed(SE3.from_translation((0, 10, 0))), connectors={"axis": UPRIGHT})
    bar = Part.from_mesh("bar", box(40, 4, 4), connectors={"axis": UPRIGHT})
    turn = declare.revolute("turn", wall["axis"], bar["axis"], limits=(0.0, 1.0))
    assembly = Assembly.from_parts("wall", parts=[wall, bar], joints=[turn], ground="wall")
    _, q = motion_frames(assembly, "turn", 3)
    scenes = pictures._motion_scenes(assembly, "turn", q)
    bounds = pictures._shown(scenes)

    view, through, hand = pictures._shot(scenes, bounds)

    assert (through, hand) == ((), False)
    assert sights(scenes, [view], bounds)[view].shows
    assert not sights(scenes, ["back"], bounds)["back"].is_seen


@pytest.mark.parametrize("mover", [cylinder(20, 8), sphere(15)], ids=["disk", "ball"])
@pytest.mark.parametrize("shut", [False, True], ids=["open", "shut"])
def test_a_round_part_that_turns_bears_a_hand(mover: TriMesh, *, shut: bool) -> None:
    disk = Part.from_mesh("disk", mover, connectors={"axis": UPRIGHT})
    base = Part.from_mesh("base", box(60, 60, 4).transformed(SE3.from_translation((0, 0, -20))), connectors={"axis": UPRIGHT})
    open_to_all = Assembly.from_parts(
        "table", parts=[base, disk], joints=[declare.revolute("turn", base["axis"], disk["axis"], limits="endless")], ground="base"
    )
    frames = drawn(shut_in(disk, "endless") if shut else open_to_all, "turn")

    assert min(differing(a, b) for a, b in itertools.pairwise(frames)) > HAND


def test_a_hand_points_where_the_joint_stands() -> None:
    disk = Part.from_mesh("disk", cylinder(20, 8), connectors={"axis": UPRIGHT})
    base = Part.from_mesh("base", box(60, 60, 4), connectors={"axis": UPRIGHT})
    assembly = Assembly.from_parts(
        "table", parts=[base, disk], joints=[declare.revolute("turn", base["axis"], disk["axis"], limits="endless")], ground="base"
    )
    poses = dict(zip(assembly.parts, assembly.poses(np.array([math.pi / 3])), strict=True))

    axis: AxisMark = scene_of(assembly.parts, poses, joints=assembly.joints).axes[0]

    assert axis.across == pytest.approx((math.cos(math.pi / 3), math.sin(math.pi / 3), 0.0))


def test_glass_shows_what_is_behind_it() -> None:
    assembly = shut_in(Part.from_mesh("bar", box(70, 10, 10), connectors={"axis": UPRIGHT}, color="#2040c0"))
    red = recoloured(assembly, ("bar",), "#d03020")

    def shown(which: Assembly, *, glass: bool) -> FloatArray:
        return np.asarray(render_views(which, ["iso"], size=160, only=["bar"], labels=False, glass=glass)["iso"], dtype=np.float64)

    assert differing(shown(assembly, glass=True), shown(red, glass=True)) > LEAST
    assert differing(shown(assembly, glass=False), shown(red, glass=False)) == 0


def test_from_nearby_the_moving_parts_fill_the_picture() -> None:
    assembly = shut_in(Part.from_mesh("bar", box(20, 4, 4), connectors={"axis": UPRIGHT}, color="#2040c0"))
    red = recoloured(assembly, ("bar",), "#d03020")

    def area(*, near: bool) -> int:
        first, second = (np.asarray(render_motion(which, "turn", frames=2, near=near)[0], dtype=np.float64) for which in (assembly, red))
        return differing(first, second)

    assert area(near=True) > area(near=False)


def test_the_best_view_is_the_first_that_is_tried() -> None:
    base = Part.from_mesh("base", box(60, 60, 4).transformed(SE3.from_translation((0, 0, -5))), connectors={"axis": UPRIGHT})
    bar = Part.from_mesh("bar", box(40, 4, 4), connectors={"axis": UPRIGHT})
    turn = declare.revolute("turn", base["axis"], bar["axis"], limits=(0.0, 1.0))
    assembly = Assembly.from_parts("base", parts=[base, bar], joints=[turn], ground="base")
    _, q = motion_frames(assembly, "turn", 3)
    scenes = pictures._motion_scenes(assembly, "turn", q)

    assert pictures._shot(scenes, pictures._shown(scenes)) == (best_view(scenes), (), False)
