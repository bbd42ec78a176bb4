"""Known answers by part and depth, not by colour."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box, cylinder, sphere
from articad.render import Camera, DrawnMesh, DrawnScene, Section, cast
from articad.render.raycast import BACKGROUND


def item(name: str, mesh: TriMesh, at: tuple[float, float, float] = (0, 0, 0)) -> DrawnMesh:
    return DrawnMesh(name, mesh, SE3.from_translation(at), "#808080")


def camera(view: str, *, width: int = 100, height: int = 80, mm_per_pixel: float = 1.0) -> Camera:
    """A camera at the origin whose pixels are squares of a known size."""
    fitted = Camera.fit(view, [[-1, -1, -1], [1, 1, 1]], width=width, height=height)
    return replace(fitted, centre=np.zeros(3), mm_per_pixel=mm_per_pixel)


def pixel_centres(shot: Camera) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    x = (np.arange(shot.width) + 0.5 - shot.width / 2) * shot.mm_per_pixel
    y = -(np.arange(shot.height) + 0.5 - shot.height / 2) * shot.mm_per_pixel
    return np.meshgrid(x, y)


@pytest.mark.parametrize(
    ("view", "across", "up"),
    [("front", 0, 2), ("back", 0, 2), ("left", 1, 2), ("right", 1, 2), ("top", 0, 1), ("bottom", 0, 1)],
)
def test_a_box_covers_exactly_the_pixels_whose_centres_lie_in_its_face(view: str, across: int, up: int) -> None:
    size = np.array([31.4, 17.8, 23.2])
    shot = camera(view)

    seen = cast(DrawnScene((item("block", box(*size)),)), shot).item != BACKGROUND

    x, y = pixel_centres(shot)
    expected = (np.abs(x) < size[across] / 2) & (np.abs(y) < size[up] / 2)
    assert (seen == expected).all()


def test_a_sphere_covers_exactly_the_pixels_whose_centres_lie_in_its_circle() -> None:
    radius = 30.2
    shot = camera("top")

    seen = cast(DrawnScene((item("ball", sphere(radius, 512)),)), shot).item != BACKGROUND

    x, y = pixel_centres(shot)
    distance = np.hypot(x, y)
    assert not ((distance > 0.999 * radius) & (distance < radius)).any(), "no pixel may lie in the band where facets and circle differ"
    assert (seen == (distance < radius)).all()


def test_x_is_right_and_z_is_up_in_the_front_view() -> None:
    shot = camera("front")
    scene = DrawnScene((item("right", box(4, 4, 4), (20, 0, 0)), item("up", box(4, 4, 4), (0, 0, 20))))

    buffers = cast(scene, shot)

    assert buffers.item[40, 70] == 0
    assert buffers.item[20, 50] == 1
    assert buffers.item[60, 50] == BACKGROUND


def test_the_nearer_of_two_parts_is_seen() -> None:
    front, behind = item("near", box(10, 10, 10), (0, -20, 0)), item("far", box(30, 10, 30), (0, 20, 0))
    shot = camera("front")

    buffers = cast(DrawnScene((behind, front)), shot)

    assert buffers.item[40, 50] == 1
    assert buffers.item[40, 62] == 0


def test_depth_is_the_distance_from_the_plane_through_the_centre() -> None:
    shot = camera("top")

    buffers = cast(DrawnScene((item("slab", box(20, 20, 6), (0, 0, 4)),)), shot)

    assert buffers.depth[40, 50] == pytest.approx(-7.0, abs=1e-4)
    assert buffers.normal[40, 50] == pytest.approx([0, 0, 1], abs=1e-6)
    assert np.isinf(buffers.depth[0, 0])


@pytest.mark.parametrize("far", [0.0, 1e5])
def test_a_scene_far_from_the_origin_is_as_sharp(far: float) -> None:
    here = replace(camera("front"), centre=np.array([far, far, far]))

    seen = cast(DrawnScene((item("block", box(31.4, 17.8, 23.2), (far, far, far)),)), here).item != BACKGROUND

    assert (seen == (cast(DrawnScene((item("block", box(31.4, 17.8, 23.2)),)), camera("front")).item != BACKGROUND)).all()


def test_a_section_shows_the_cut_at_the_planes_depth() -> None:
    scene = DrawnScene((item("tube", cylinder(20, 40, 256)),), section=Section((0, 0, 5), (0, 0, 1)))

    buffers = cast(scene, camera("top"))

    x, y = pixel_centres(camera("top"))
    inside = np.hypot(x, y) < 19.9
    assert buffers.cut[inside].all()
    assert buffers.depth[inside] == pytest.approx(-5.0, abs=1e-4)
    assert not buffers.cut[np.hypot(x, y) > 20].any()


def test_a_section_cuts_each_of_two_touching_parts() -> None:
    lower, upper = item("lower", box(40, 40, 20), (0, 0, -10)), item("upper", cylinder(10, 20, 64), (0, 0, 10))
    scene = DrawnScene((lower, upper), section=Section((0, 0, 0), (0, -1, 0)))

    buffers = cast(scene, camera("front"))

    x, y = pixel_centres(camera("front"))
    assert (buffers.item[(np.abs(x) < 9.5) & (y > 0.2) & (y < 19.5)] == 1).all()
    assert (buffers.item[(np.abs(x) < 19.5) & (y < -0.2) & (y > -19.5)] == 0).all()
    assert buffers.cut[(np.abs(x) < 9.5) & (np.abs(y) < 19)].all()


def test_a_section_seen_edge_on_hides_what_it_takes_away() -> None:
    scene = DrawnScene((item("block", box(40, 40, 40)),), section=Section((0, 0, 0), (1, 0, 0)))

    buffers = cast(scene, camera("front"))

    x, y = pixel_centres(camera("front"))
    assert (buffers.item[(x < -0.1) & (x > -20) & (np.abs(y) < 20)] == 0).all()
    assert (buffers.item[x > 0.1] == BACKGROUND).all()


def test_a_highlight_is_seen_through_what_hides_it() -> None:
    hidden = replace(item("overlap", sphere(5, 64)), manner="highlight")
    scene = DrawnScene((item("shell", box(40, 40, 40)), hidden))

    buffers = cast(scene, camera("front"))

    assert buffers.item[40, 50] == 0
    assert buffers.over[40, 50] == 1
    assert buffers.over[40, 60] == BACKGROUND


def test_an_empty_scene_is_background() -> None:
    assert (cast(DrawnScene(()), camera("iso")).item == BACKGROUND).all()


@pytest.mark.parametrize("text", ["w", "xx", "", "z=deep"])
def test_a_section_that_is_no_axis_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"x, y or z|could not convert"):
        Section.parse(text, np.array([[0, 0, 0], [1, 1, 1]]))


def test_the_short_form_of_a_section_cuts_the_middle_unless_told() -> None:
    bounds = np.array([[0.0, 0, 0], [10, 20, 30]])

    assert Section.parse("z", bounds) == Section((5, 10, 15), (0, 0, 1))
    assert Section.parse("-y=3.5", bounds) == Section((5, 3.5, 15), (0, -1, 0))
