"""Product pictures: white is white, black is not a hole, glass lets through, the ground carries a shadow."""

from __future__ import annotations

import argparse

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.commands.options import extent
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.geometry.finish import finish_of
from articad.geometry.part import Part
from articad.geometry.shapes import box, sphere
from articad.kinematics import declare
from articad.render import Camera, DrawnMesh, DrawnScene, cast, clean_motion, png, render_clean
from articad.render.raycast import BACKGROUND
from articad.render.studio import framed, studio


def scene_of_ball(color: str, material: str = "plastic") -> DrawnScene:
    return DrawnScene((DrawnMesh("ball", sphere(20), SE3.identity(), color, material=material),))


def drawn(scene: DrawnScene, view: str = "iso", *, size: int = 96) -> tuple[np.ndarray, np.ndarray]:
    """Return the picture and the pixels well inside the parts."""
    camera = framed(scene, Camera.fit(view, scene.bounds, width=size, height=size), margin=1.4)
    seen = cast(scene, camera).item != BACKGROUND
    inside = seen.copy()
    for axis in (0, 1):
        for step in (-2, 2):
            inside &= np.roll(seen, step, axis=axis)
    return np.asarray(studio(scene, camera)).astype(int), inside


@pytest.mark.parametrize("material", ["plastic", "painted_steel", "oak", "rubber"])
def test_white_is_white_and_black_is_not_a_hole(material: str) -> None:
    white, inside = drawn(scene_of_ball("#ffffff", material))
    black, _ = drawn(scene_of_ball("#000000", material))

    assert np.percentile(white[inside].mean(axis=1), 90) > 225
    assert white[inside].max() <= 255
    assert np.ptp(white[inside], axis=1).max() <= 3 or finish_of(material).grain, "no tint, but for the rings of wood"
    assert black[inside].min() > 10
    assert np.percentile(black[inside].mean(axis=1), 90) < 110, "and yet it is black"
    assert np.ptp(np.percentile(black[inside].mean(axis=1), [2, 98])) > 6, "its shape is seen"


def test_the_hue_of_a_part_is_kept() -> None:
    picture, inside = drawn(scene_of_ball("#c22f2a"))

    red, green, blue = np.median(picture[inside], axis=0)
    assert red > 1.8 * green
    assert abs(green - blue) < 25


def test_a_material_is_found_by_the_words_of_its_name() -> None:
    assert finish_of("zinc_plated_steel").metal > 0.5
    assert finish_of("painted_steel").metal == 0
    assert finish_of("Cast Iron").roughness > finish_of("stainless steel").roughness
    assert finish_of("borosilicate-glass").opacity < 1
    assert finish_of("unobtainium") == finish_of("")


def test_wood_has_rings_along_its_longest_side_and_other_materials_have_none() -> None:
    """On the front of an upright board, neighbours across the fibres differ more than neighbours along them."""
    for material, grain in (("oak", True), ("plastic", False)):
        board = DrawnMesh("board", box(40, 8, 160), SE3.identity(), "#b08050", material=material)
        picture, inside = drawn(DrawnScene((board,)), "front", size=160)
        light = picture.sum(axis=2).astype(float)
        across = np.abs(np.diff(light, axis=1))[inside[:, 1:]].mean()
        along = np.abs(np.diff(light, axis=0))[inside[1:]].mean()
        assert (across > 2 * along) == grain, (material, across, along)


def test_a_flat_face_of_metal_is_lighter_towards_the_lamps() -> None:
    plate = DrawnMesh("plate", box(100, 10, 100), SE3.identity(), "#c0c4c8", material="steel")
    picture, inside = drawn(DrawnScene((plate,)), "front", size=96)
    rows = [picture[row][inside[row]].mean() for row in range(96) if inside[row].any()]
    assert rows[2] > rows[-3] + 15, "the upper edge reflects the sky, the lower one the ground"


def test_what_is_inside_glass_is_seen_through_it() -> None:
    inner = DrawnMesh("core", box(14, 14, 14), SE3.identity(), "#c01010", material="plastic")
    glass = DrawnMesh("shell", sphere(20), SE3.identity(), "#e8f0f0", material="glass")
    solid = DrawnMesh("shell", sphere(20), SE3.identity(), "#e8f0f0", material="plastic")

    through, _ = drawn(DrawnScene((inner, glass)))
    hidden, _ = drawn(DrawnScene((inner, solid)))

    middle = (48, 48)
    assert through[middle][0] > through[middle][1] + 25
    assert abs(hidden[middle][0] - hidden[middle][1]) < 20


def test_the_ground_carries_a_soft_shadow_that_a_transparent_picture_keeps() -> None:
    scene = DrawnScene((DrawnMesh("cube", box(30, 30, 30), SE3.identity(), "#808080"),))
    camera = framed(scene, Camera.fit("iso", scene.bounds, width=96, height=96), margin=1.8)

    picture = studio(scene, camera, transparent=True)

    alpha = np.asarray(picture)[..., 3]
    seen = cast(scene, camera).item != BACKGROUND
    assert picture.mode == "RGBA"
    assert alpha[0].max() == 0
    assert alpha[48, 48] == 255
    ground = alpha[~seen]
    assert 60 < ground.max() < 255
    assert len(np.unique(ground)) > 20, "soft"
    front = framed(scene, Camera.fit("front", scene.bounds, width=96, height=96), margin=1.8)
    assert set(np.unique(np.asarray(studio(scene, front, transparent=True))[..., 3][:20])) == {0}, "no ground is seen edge-on"


def test_the_picture_is_framed_by_what_is_seen() -> None:
    scene = DrawnScene((DrawnMesh("ball", sphere(20), SE3.from_translation([500, 30, -80]), "#808080"),))

    camera = framed(scene, Camera.fit("iso", scene.bounds, width=200, height=100), margin=1.1)

    rows, columns = np.nonzero(cast(scene, camera).item != BACKGROUND)
    assert np.ptp(rows) + 1 == pytest.approx(100 / 1.1, abs=2)
    assert rows.mean() == pytest.approx(49.5, abs=1)
    assert columns.mean() == pytest.approx(99.5, abs=1)


def test_sizes_views_and_motion_of_an_assembly() -> None:
    pivot = {"c": Connector("c", SE3.from_axes((0, 0, 12), (0, 0, 1), (1, 0, 0)))}
    base, hand = Part.from_mesh("base", box(30, 30, 20), connectors=pivot), Part.from_mesh("hand", box(40, 6, 4), connectors=pivot)
    made = Assembly.from_parts(
        "made", parts=[base, hand], joints=[declare.revolute("turn", base["c"], hand["c"], limits=(-1.0, 1.0))], ground="base"
    )

    pictures = render_clean(made, ["iso", "top"], size=(64, 40), section="x", show_overlaps=True)

    assert {view: picture.size for view, picture in pictures.items()} == {"iso": (64, 40), "top": (64, 40)}
    assert png(render_clean(made, ["iso"], size=(48, 48))["iso"]) == png(render_clean(made, ["iso"], size=(48, 48))["iso"])
    frames = clean_motion(made, "turn", frames=3, size=(48, 32))
    assert [frame.size for frame in frames] == [(48, 32)] * 3
    assert frames[0].tobytes() != frames[2].tobytes()


@pytest.mark.parametrize(("text", "size"), [("512", (512, 512)), ("1280x720", (1280, 720)), ("64X48", (64, 48))])
def test_a_size_is_one_number_or_two(text: str, size: tuple[int, int]) -> None:
    assert extent(text) == size


@pytest.mark.parametrize("text", ["", "x", "0", "5x", "15", "100x", "9000", "-64", "64x48x2", "1e3"])
def test_another_size_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="1280x720"):
        extent(text)
