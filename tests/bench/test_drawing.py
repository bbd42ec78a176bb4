"""Drawings of tasks: small, the same each time, and with every number that a picture alone must state."""

from __future__ import annotations

import io
from functools import cache

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import maximum_filter, minimum_filter

from articad import examples
from articad.assembly import Assembly
from articad.papers.items import items_of
from articad.plan.schema import AssemblyPlan
from articad_bench import drawing
from articad_bench.checks import PartSize
from articad_bench.drawing import COLORS, PANE, draw_task
from articad_bench.pictures import PHOTO_VIEWS, SHEET_PIXELS, is_drawn, pictures_of
from articad_bench.reference import reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, Drawing, tasks_in

pytestmark = pytest.mark.slow

LARGEST = 40_000  # bytes
LARGEST_SHEET = 60_000


@cache
def example(name: str) -> Assembly:
    folder = examples.folder(name)
    return Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")


def test_a_drawing_is_small_and_the_same_each_time() -> None:
    first, second = (draw_task(example("wardrobe"), Drawing()) for _ in range(2))

    image = Image.open(io.BytesIO(first))
    assert first == second
    assert len(first) < LARGEST
    assert image.width == 2 * PANE
    assert len(image.getcolors() or ()) <= COLORS


def test_the_legend_tells_measures_ranges_couplings_sides_and_notes() -> None:
    def told(name: str, form: Drawing) -> str:
        subject = Subject(example(name))
        return "\n".join(drawing.legend(subject, drawing.kinds_of(subject), form))

    wardrobe = told("wardrobe", Drawing(parts=("cabinet",), notes=("Doors shut flush.",)))
    assert "900 x 535 x 1922 mm (x, y, z), 18 parts." in wardrobe
    assert "A: 2 x turns 105° about z" in wardrobe
    assert "B: 2 x slides 363 mm along y" in wardrobe
    assert "cabinet: 500 x 900 x 1800 mm" in wardrobe
    assert wardrobe.endswith("Doors shut flush.")

    lamp = told("desk_lamp", Drawing())
    assert "ball joint, tilts 26° to every side, twists 300°" in lamp

    gears = told("geared_four_bar", Drawing())
    assert "is coupled" in gears
    assert "0.5 times as far as A" in gears
    assert "slides 125.7 mm for each turn of A" in gears


def test_what_is_drawn_has_its_measures_beside_it() -> None:
    with_lines, plain = (
        np.asarray(Image.open(io.BytesIO(draw_task(example("wardrobe"), Drawing(views=views, legend=False)))).convert("RGB")).astype(int)
        for views in (("front",), ("iso",))
    )

    def blue(picture: np.ndarray) -> int:
        return int((picture[:PANE, :PANE, 2] - picture[:PANE, :PANE, 0] > 40).sum())

    assert blue(with_lines) > 300
    assert blue(plain) == 0


@pytest.mark.soak
@pytest.mark.parametrize("name", [task.name for _, task in tasks_in(TASKS) if task.drawing is not None])
def test_a_kept_drawing_is_that_of_the_reference_and_each_size_it_lists_is_asked_for(name: str) -> None:
    ((folder, task),) = tasks_in(TASKS, names=[name])
    assert task.drawing is not None
    assembly = reference(folder, task)
    subject = Subject(assembly)
    sizes = [check for check in task.checks if isinstance(check, PartSize) and sum(side is not None for side in check.mm) >= 2]
    asked = {part for check in sizes for part in subject.of_size(check.mm, check.tolerance)}
    assert set(task.drawing.parts) <= asked

    drawn = pictures_of(assembly, task.drawing)
    assert sorted(drawn) == sorted(task.images)
    assert [name for name, content in drawn.items() if differing(content, (folder / name).read_bytes()) > 10] == []


def differing(one: bytes, other: bytes) -> int:
    """Return how many pixels of a picture are like none of those within two of the same place of another one, to within 8 of 255.

    Processors round otherwise: an edge may lie beside where it was.
    """
    a, b = (np.asarray(Image.open(io.BytesIO(content)).convert("RGB")).astype(int) for content in (one, other))
    if a.shape != b.shape:
        return max(a.size, b.size)
    low, high = minimum_filter(b, (5, 5, 1)) - 8, maximum_filter(b, (5, 5, 1)) + 8
    return int(((a < low) | (a > high)).any(axis=-1).sum())


def test_every_task_that_is_asked_by_pictures_has_them() -> None:
    for folder, task in tasks_in(TASKS):
        assert task.prompt or task.images, task.name
        assert (task.drawing is None) or is_drawn(task), task.name
        for image in task.images:
            assert 0 < (folder / image).stat().st_size <= (LARGEST if image == drawing.DRAWING else LARGEST_SHEET), task.name


def test_sheets_show_the_assembly_with_what_moves_and_then_each_kind_of_part() -> None:
    pictures = pictures_of(example("slider_crank"), Drawing(form="sheets", section=("y", 0.0), notes=("Oil it.",)))

    assert list(pictures) == [f"sheet_{number}.png" for number in range(1, len(pictures) + 1)]
    assert len(pictures) == 1 + len(items_of(example("slider_crank")))
    images = [Image.open(io.BytesIO(content)) for content in pictures.values()]
    assert {image.width for image in images} == {SHEET_PIXELS}
    assert {image.format for image in images} == {"PNG"}


def test_photos_are_four_and_the_last_one_shows_the_product_on_its_way() -> None:
    at_rest, moved = (pictures_of(example("slider_crank"), Drawing(form="photos", moved=moved)) for moved in (0.0, 0.25))

    assert len(at_rest) == len(PHOTO_VIEWS) == 4
    assert [name for name in at_rest if at_rest[name] != moved[name]] == ["photo_4.jpg"]
    assert all(len(content) < LARGEST_SHEET for content in at_rest.values())
