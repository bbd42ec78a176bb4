"""Pictures of assemblies: what moves, how far, and that the same scene gives the same pixels."""

from __future__ import annotations

import io
import math
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import ArticadError, KernelUnavailableError, UnknownJointError
from articad.geometry.part import Part
from articad.geometry.shapes import box, sphere
from articad.interference.explosion import exploded
from articad.kinematics import declare
from articad.render import (
    Camera,
    annotate,
    before_after,
    best_view,
    cast,
    contact_sheet,
    motion_frames,
    motion_gif,
    picture,
    pictures,
    png,
    render_motion,
    render_part,
    render_views,
    vtk,
)
from articad.render.files import write_motion, write_views
from articad.render.raycast import BACKGROUND
from articad.render.scene import scene_of
from tests.assemblies import all_joint_kinds, geared_pair


def frame(at: tuple[float, float, float], z: tuple[float, float, float]) -> SE3:
    x = (0.0, 0.0, 1.0) if z[2] == 0 else (1.0, 0.0, 0.0)
    return SE3.from_axes(at, z, x)


@pytest.fixture(scope="module")
def rail() -> Assembly:
    """A cube that slides 40 mm along X over a long base."""
    base = Part.from_mesh("base", box(120, 10, 10), connectors={"slide": Connector("slide", frame((0, 0, 15), (1, 0, 0)))})
    cube = Part.from_mesh("cube", box(10, 10, 10), connectors={"slide": Connector("slide", frame((0, 0, 0), (1, 0, 0)))})
    joint = declare.slider("drive", base["slide"], cube["slide"], limits=(-40.0, 40.0))
    return Assembly.from_parts("rail", parts=[base, cube], joints=[joint], ground="base")


def columns_of_the_cube(assembly: Assembly, q: np.ndarray) -> tuple[int, int]:
    poses = {name: assembly.poses(q)[index] for index, name in enumerate(assembly.parts)}
    shot = Camera.fit("front", [[-60, -5, -5], [60, 5, 20]], width=240, height=240)
    item = cast(scene_of(assembly.parts, poses), replace(shot, mm_per_pixel=1.0)).item
    columns = np.nonzero((item == 1).any(axis=0))[0]
    return int(columns[0]), int(columns[-1])


def test_a_keyframe_shows_the_pose_that_the_assembly_gives(rail: Assembly) -> None:
    captions, q = motion_frames(rail, "drive", 5)

    assert captions == ["drive = -40.0 mm", "drive = -20.0 mm", "drive = 0.0 mm", "drive = 20.0 mm", "drive = 40.0 mm"]
    for row, travel in zip(q, (-40, -20, 0, 20, 40), strict=True):
        assert rail.poses(row)[1].translation == pytest.approx(rail.at(drive=travel)["cube"].translation)
        assert columns_of_the_cube(rail, row) == (115 + travel, 124 + travel)  # ten pixels, one to the millimetre


def test_each_coordinate_of_a_joint_is_shown_in_turn() -> None:
    assembly = all_joint_kinds()
    columns = [driver.name for driver in assembly.drivers]

    captions, q = motion_frames(assembly, "rod", 4)

    travel, angle = columns.index("rod.travel"), columns.index("rod.angle")
    assert [caption.partition(" = ")[0] for caption in captions] == ["rod.travel"] * 4 + ["rod.angle"] * 4
    assert q[:4, travel].tolist() == pytest.approx([-50, -50 / 3, 50 / 3, 50])
    assert q[4:, angle].tolist() == pytest.approx([0, 2 * math.pi / 3, 4 * math.pi / 3, 2 * math.pi]), "endless: one turn from rest"


def test_a_ball_swings_about_both_axes_and_twists() -> None:
    assembly = all_joint_kinds()
    columns = [index for index, driver in enumerate(assembly.drivers) if driver.joint == "head"]

    captions, q = motion_frames(assembly, "head", 3)

    assert [caption.rpartition(" = ")[0] for caption in captions] == ["head swing x"] * 3 + ["head swing y"] * 3 + ["head twist"] * 3
    quaternions = q[:, columns]
    assert quaternions[0] == pytest.approx([math.sin(-math.pi / 6), 0, 0, math.cos(math.pi / 6)])
    assert quaternions[6] == pytest.approx([0, 0, math.sin(-0.5), math.cos(0.5)])
    assert np.linalg.norm(quaternions, axis=1) == pytest.approx(np.ones(9))


def test_a_mechanism_with_couplings_is_shown_through_its_driver() -> None:
    assembly = geared_pair()

    _, q = motion_frames(assembly, "a", 3)

    assert q.shape == (3, 1)
    assert len(render_motion(assembly, "a", frames=3, size=64, supersample=1)) == 3
    with pytest.raises(UnknownJointError, match=r"Unknown joint 'b'.*Known: a"):
        motion_frames(assembly, "b")


def test_the_view_of_a_motion_is_one_in_which_it_is_seen(rail: Assembly) -> None:
    _, q = motion_frames(rail, "drive", 3)
    scenes = [scene_of(rail.parts, dict(zip(rail.parts, rail.poses(row), strict=True))) for row in q]

    assert best_view(scenes, ("right", "front")) == "front"  # from the right, the cube only comes nearer
    assert best_view(scenes, ("bottom", "top")) == "top"  # from below, the base hides it


def test_the_same_scene_gives_the_same_bytes(rail: Assembly) -> None:
    first, second = (png(rail.render(["iso"], size=96)["iso"]) for _ in range(2))

    assert first == second
    frames = render_motion(rail, "drive", frames=3, size=48, supersample=1)
    assert motion_gif(frames) == motion_gif(frames)


def test_an_animation_runs_forth_and_back(rail: Assembly) -> None:
    animation = Image.open(io.BytesIO(motion_gif(render_motion(rail, "drive", frames=4, size=48, supersample=1))))

    assert getattr(animation, "n_frames", 1) == 6


def test_a_motion_is_seen_along_the_axis_though_it_is_larger_from_above() -> None:
    post = Part.from_mesh("post", box(40, 40, 200), connectors={"pivot": Connector("pivot", frame((0, -22, -60), (0, -1, 0)))})
    hand = Part.from_mesh("hand", box(4, 4, 150), connectors={"pivot": Connector("pivot", frame((0, 0, -60), (0, -1, 0)))})
    assembly = Assembly.from_parts(
        "clock", parts=[post, hand], joints=[declare.revolute("swing", post["pivot"], hand["pivot"], limits=(-0.4, 0.4))], ground="post"
    )
    _, q = motion_frames(assembly, "swing", 3)
    scenes = [scene_of(assembly.parts, dict(zip(assembly.parts, assembly.poses(row), strict=True))) for row in q]

    assert best_view(scenes, ("top", "right", "front")) == "front"


def test_what_stands_still_is_faded_and_small_things_are_shown_from_nearby() -> None:
    desk = Part.from_mesh("desk", box(400, 400, 20), connectors={"knob": Connector("knob", frame((100, 100, 10), (0, 0, 1)))})
    knob = Part.from_mesh("knob", box(20, 10, 10), connectors={"desk": Connector("desk", frame((0, 0, -6), (0, 0, 1)))})
    turn = declare.revolute("turn", desk["knob"], knob["desk"], limits=(0.0, 1.5))
    assembly = Assembly.from_parts("desk", parts=[desk, knob], joints=[turn], ground="desk")
    _, q = motion_frames(assembly, "turn", 2)

    scenes = pictures._motion_scenes(assembly, "turn", q)

    assert [item.manner for item in scenes[0].items] == ["faded", "solid"]
    lower, upper = pictures._shown(scenes)
    assert (upper - lower < 100).all()
    assert (lower < [90, 95, 11]).all()
    assert (upper > [110, 105, 21]).all()


def test_nothing_of_opengl_or_a_display_is_loaded_by_drawing() -> None:
    code = """
import io
from articad.geometry.part import Part
from articad.geometry.shapes import box, sphere
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.kinematics import declare
from articad.assembly import Assembly
from articad.render import render_motion, motion_gif
frame = {"c": Connector("c", SE3.identity())}
base, ball = Part.from_mesh("base", box(9, 9, 9), connectors=frame), Part.from_mesh("ball", sphere(6), connectors=frame)
made = Assembly.from_parts("made", parts=[base, ball], joints=[declare.slider("go", base["c"], ball["c"], limits=(0, 9))], ground="base")
made.render(["iso"], show_overlaps=True, section="x", explode=0.5, size=64)
motion_gif(render_motion(made, "go", frames=2, size=64))
loaded = {line.split("/")[-1].strip() for line in open("/proc/self/maps") if "/" in line}
print(sorted(name for name in loaded if name.startswith(("libGL", "libEGL", "libOSMesa", "libX11", "libvtk", "libwayland", "libvulkan"))))
"""
    if not Path("/proc/self/maps").exists():
        pytest.skip("this system does not tell what a process has loaded")
    environment = {key: value for key, value in os.environ.items() if key not in {"DISPLAY", "WAYLAND_DISPLAY"}}
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert told.stdout.strip() == "[]"


def test_sheets_put_pictures_side_by_side(rail: Assembly) -> None:
    views = list(rail.render(["iso", "front", "top"], size=40).values())

    assert contact_sheet(views, 2).size == (86, 86)
    poses = dict(rail.at(drive=20))
    pair = before_after(scene_of(rail.parts, dict(rail.at())), scene_of(rail.parts, poses), "front", size=60)
    assert pair.size == (126, 60)


def test_parts_out_of_focus_are_faded_and_highlights_are_red(rail: Assembly) -> None:
    plain = np.asarray(render_views(rail, ["front"], size=80, labels=False, axes=False)["front"]).astype(int)
    faded = np.asarray(render_views(rail, ["front"], size=80, labels=False, axes=False, only=["cube"])["front"]).astype(int)
    marked = np.asarray(render_views(rail, ["front"], size=80, labels=False, axes=False, highlights=[sphere(9)])["front"]).astype(int)

    base = (45, 20)  # row, column: on the base, away from the cube
    assert faded[base].sum() > plain[base].sum() + 60, "nearer to paper"
    red_before, red_after = (int(((image[..., 0] > 180) & (image[..., 1] < 100)).sum()) for image in (plain, marked))
    assert red_after > red_before + 20


def test_a_highlight_that_could_be_missed_gets_a_ring_and_a_large_one_none(rail: Assembly) -> None:
    def ringed(radius: float) -> int:
        drawn = render_views(rail, ["front"], size=300, labels=False, axes=False, highlights=[sphere(radius)])["front"]
        return int((np.abs(np.asarray(drawn).astype(int) - annotate.MARK).max(axis=2) < 3).sum())

    assert ringed(0.3) > 100
    assert ringed(30.0) == 0


def test_names_that_stand_aside_leave_what_is_drawn_free_and_none_is_left_out() -> None:
    assembly = all_joint_kinds()
    written: list[tuple[str, tuple[float, float]]] = []
    text = annotate._text

    def noted(draw: object, at: tuple[float, float], words: str, color: object, **options: object) -> None:
        written.append((words, at))
        text(draw, at, words, color, **options)  # type: ignore[arg-type]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(annotate, "_text", noted)
        drawn = render_views(assembly, ["iso"], size=400, labels="aside", axes=False)["iso"]

    scene = scene_of(assembly.parts, dict(assembly.at()))
    room = annotate.room_beside(scene)
    assert drawn.size == (400 + 2 * room, 400)
    item = cast(scene, Camera.fit("iso", scene.bounds, width=400, height=400)).item
    seen = [scene.items[index].name for index in np.unique(item[item != BACKGROUND]) if (item == index).sum() >= 40]
    names = {words: at for words, at in written if words in assembly.parts}
    assert len(seen) > 10
    assert set(names) == set(seen)
    for name, (x, _) in names.items():
        assert x + annotate._measured(name) <= room or x >= 400 + room, name
    for side in (True, False):
        rows = sorted(y for x, y in names.values() if (x < room) == side)
        assert min(np.diff(rows)) >= annotate._LINE
        assert rows[-1] <= 400 - annotate._BELOW


def test_names_that_do_not_fit_below_move_up_and_stay_in_their_order(rail: Assembly) -> None:
    scene = scene_of(rail.parts, dict(rail.at()))
    shot = Camera.fit("front", scene.bounds, width=300, height=200).widened(40)
    names = [((150.0, 190.0 - index), f"n{index}", annotate.INK) for index in range(6)]
    image = Image.new("RGB", (shot.width, shot.height))
    rows: dict[str, float] = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(annotate, "_text", lambda _draw, at, words, _color: rows.update({words: at[1]}))
        annotate._columns(ImageDraw.Draw(image), names, shot)

    for column in (["n2", "n1", "n0"], ["n5", "n4", "n3"]):  # by where they are from top to bottom
        assert [rows[name] for name in column] == [200 - annotate._BELOW - annotate._LINE * step for step in (2, 1, 0)]


def test_a_black_part_is_drawn_so_bright_that_its_edges_are_seen(rail: Assembly) -> None:
    black = replace(rail.parts["base"], color="#101214", visuals=())
    front = np.asarray(render_part(black, ["front"], size=100, supersample=1)["front"]).astype(int)
    pale = np.asarray(render_part(replace(black, color="#c8a46e"), ["front"], size=100, supersample=1)["front"]).astype(int)

    assert front[50, 50].mean() > annotate.INK[1] + 40
    assert pale[50, 50].tolist() == pytest.approx([200 * 0.9, 164 * 0.9, 110 * 0.9], rel=0.15), "others keep their colour"


def test_an_exploded_view_pulls_parts_out_of_each_other_along_their_joints(rail: Assembly) -> None:
    edges, rest = tuple(rail.mechanism.tree.edges), rail.mechanism.rest_poses()
    apart = exploded(rail.parts, edges, rest, rest, 1.0)

    for edge in edges:
        axis = edge.joint.T_parent_connector.matrix[:3, 2]
        way = apart[edge.part].translation - rest[edge.part].translation - apart[edge.parent].translation + rest[edge.parent].translation
        assert np.abs(np.cross(way, rest[edge.parent].matrix[:3, :3] @ axis)).max() < 1e-9, "along the axis"
        assert np.linalg.norm(way) > 1.0
    same = exploded(rail.parts, edges, rest, rest, 0.0)
    assert all(same[name].allclose(rest[name]) for name in rest)


def test_a_part_alone_is_drawn_in_its_own_frame(rail: Assembly) -> None:
    assert render_part(rail.parts["cube"], ["front"], size=32, supersample=1)["front"].size == (32, 32)


def test_files_are_named_for_views_and_joints(rail: Assembly, tmp_path: Path) -> None:
    written = [*write_views(rail, ["iso", "top"], tmp_path, size=32), *write_motion(rail, "drive", tmp_path, size=32)]

    assert [path.name for path in written] == ["iso.png", "top.png", "drive.png", "drive.gif"]
    assert all(path.stat().st_size > 100 for path in written)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"views": ["frnt"]}, r"No view 'frnt'. Did you mean 'front'\?"),
        ({"views": ["front"], "only": ["kube"]}, r"No part 'kube'. Did you mean 'cube'\?"),
        ({"views": ["front"], "section": "q"}, "A section is x, y or z"),
    ],
)
def test_a_wrong_word_is_refused_with_the_right_one(rail: Assembly, tmp_path: Path, options: dict[str, list[str]], message: str) -> None:
    views = options.pop("views")
    with pytest.raises(ArticadError, match=message):
        write_views(rail, views, tmp_path, **options)  # type: ignore[arg-type]


def test_pyvista_shows_the_same_silhouette_or_says_that_it_cannot(rail: Assembly) -> None:
    scene = scene_of(rail.parts, dict(rail.at()))
    shot = Camera.fit("iso", scene.bounds, width=480, height=480)
    if not vtk.available():
        with pytest.raises(KernelUnavailableError, match="embree"):
            picture(scene, shot, renderer="pyvista")
        return
    seen = (np.abs(vtk.draw(scene, shot).astype(int) - [250, 250, 248]).sum(axis=-1)) > 24
    expected = cast(scene, shot).item != BACKGROUND

    assert (seen & expected).sum() / (seen | expected).sum() > 0.95
