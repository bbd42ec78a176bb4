"""Drawings: every dimension is the plan's number, views are projections of the solid, nothing overlaps, and DXF is read by others."""

from __future__ import annotations

import io
import itertools
import json
import math
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from PIL import Image

from articad.agents.pipeline import replay
from articad.assembly import Assembly
from articad.entry import read
from articad.errors import ArticadError
from articad.kernels import freecad_install
from articad.kernels.inside_freecad.sizes import named_sizes
from articad.kernels.kernel import BuildCache
from articad.kernels.views import View, ViewKernel
from articad.papers.drawing import drawings_of
from articad.papers.hatching import hatched
from articad.papers.part_sheet import FRONT
from articad.papers.raster import sheet_png
from articad.papers.sheet import DrawingSheet, Lettering, text_width
from articad.papers.writers import written_dxf, written_pdf, written_svg
from articad.plan.schema import AssemblyPlan
from articad.runs.record import assembly_of
from tests.freecad import opened

ROOT = Path(__file__).parents[2]
PLATE = """
from build123d import Align, Box, Cylinder, Pos, Rot
def build(part):
    d = part.dimensions
    up = (Align.CENTER, Align.CENTER, Align.MIN)
    plate = Box(d["width"], d["depth"], d["thickness"], align=up) + Pos(0, 0, d["thickness"]) * Cylinder(d["boss_radius"], d["boss_height"], align=up)
    plate -= Cylinder(d["bore_diameter"] / 2, 100)
    for x in (-1, 1):
        plate -= Pos(x * d["hole_x"], d["hole_y"], d["thickness"] - d["hole_depth"]) * Cylinder(d["hole_radius"], 100, align=up)
    return plate, {"bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""
PIN = """
from build123d import Align, Cylinder, Pos
def build(part):
    d = part.dimensions
    pin = Cylinder(d["pin_diameter"] / 2, d["length"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    pin = pin + Pos(0, 0, -d["head_height"]) * Cylinder(d["head_radius"], d["head_height"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    return Pos(0, 0, -0.5) * pin, {"axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""
PLAN: dict[str, Any] = {
    "schema": "articad.plan/1", "name": "bearing", "ground": "plate", "freedoms": 1,
    "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
    "parts": [
        {
            "name": "plate", "material": "steel", "description": "A plate with a boss, a bore and two blind holes.",
            "dimensions": {
                "width": 81.5, "depth": 44, "thickness": 12, "boss_radius": 13, "boss_height": 9, "bore_diameter": 10.01, "hole_x": 30.25,
                "hole_y": 7, "hole_radius": 2.6, "hole_depth": 8,
            },
            "connectors": [{"name": "bore", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "kind": "bore_axis", "label": "bore"}],
        },
        {
            "name": "pin", "material": "steel", "description": "A pin with a head.",
            "dimensions": {"pin_diameter": 9.985, "length": 26, "head_radius": 9, "head_height": 4},
            "connectors": [{"name": "axis", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "kind": "shaft_axis", "label": "axis"}],
        },
    ],
    "joints": [{"name": "turn", "type": "revolute", "parent": "plate.bore", "child": "pin.axis", "angle_deg": "endless", "fit": "10 H7/g6"}],
}  # fmt: skip


@cache
def bearing() -> Assembly:
    folder = tempfile.mkdtemp()
    return Assembly.from_plan(AssemblyPlan.from_json(PLAN), {"plate": PLATE, "pin": PIN}, cache=BuildCache(Path(folder)))


@cache
def sheets() -> tuple[DrawingSheet, ...]:
    return tuple(drawings_of(bearing()))


def sheet(name: str) -> DrawingSheet:
    return next(one for one in sheets() if one.part == name)


def dimensions_of(name: str) -> dict[str, float]:
    return next(part["dimensions"] for part in PLAN["parts"] if part["name"] == name)


def assert_as_planned(one: DrawingSheet, planned: dict[str, float], within: float = 1e-9) -> None:
    """Assert that each named dimension has the plan's number and its drawn length, and that each number of the plan is on the sheet."""
    told: Any = one.told
    for row in told["dimensions"]:
        if row["name"]:
            is_width = "Ø" in row["text"] and abs(row["value"] - planned[row["name"]]) > within  # told by its radius in the plan
            assert row["value"] == pytest.approx(planned[row["name"]] * (2 if is_width else 1), abs=within)
        if "radius" in row:  # of the circle that the leader points to
            assert row["value"] == pytest.approx(row["radius"] * (2 if "Ø" in row["text"] else 1), abs=1e-5)
        assert float(row["text"].lstrip("RSØ")) == pytest.approx(row["value"], abs=1e-4 if row["name"] else 5.001e-3)
    for dimension in one.dimensions:
        ends = np.array([dimension.start, dimension.end])
        drawn = abs(np.diff(ends[:, int(dimension.vertical)])[0]) / one.scale
        assert drawn == pytest.approx(dimension.value, abs=1e-3)
    for by_hole, row in told["by_holes"].items():
        assert row["value"] == planned[by_hole]
    shown = {row["name"] for row in told["dimensions"]} | set(told["by_holes"]) | set(told["listed"])
    assert shown - {""} == set(planned)  # each number of the plan is on the sheet
    assert {key: float(value) for key, value in told["listed"].items()} == {
        key: pytest.approx(planned[key], rel=1e-5) for key in told["listed"]
    }


@pytest.mark.parametrize("name", ["plate", "pin"])
def test_every_dimension_of_a_drawing_equals_the_plan_s_number(name: str) -> None:
    assert_as_planned(sheet(name), dimensions_of(name))


@pytest.mark.parametrize(
    "folder",
    [
        "examples/wardrobe",
        "examples/desk_lamp",
        "bench/articad_bench/tasks/press_toggle/reference",
        "bench/articad_bench/tasks/excavator_arm/reference",
    ],
)
def test_every_dimension_of_a_product_s_drawings_equals_the_plan_s_number(folder: str) -> None:
    assembly = read(ROOT / folder)
    assert assembly.resolved is not None
    drawn = [one for one in drawings_of(assembly) if one.part is not None]
    for one in drawn:  # the kernel's box of a round part is 1e-7 mm larger on each side; sheets print 1e-4 mm
        assert one.part is not None
        assert_as_planned(one, {key: float(value) for key, value in assembly.resolved.parts[one.part].dimensions.items()}, 1e-6)
    assert len(drawn) >= 6


def test_every_dimension_of_the_recorded_hand_press_equals_the_plan_s_number(tmp_path: Path) -> None:
    with replay(ROOT / "tests" / "recordings" / "asked" / "hand_press", out=tmp_path / "run").run as made:
        assembly = assembly_of(made).product()
        assert assembly.resolved is not None
        drawn = [one for one in drawings_of(assembly) if one.part is not None]
        for one in drawn:
            assert one.part is not None
            assert_as_planned(one, {key: float(value) for key, value in assembly.resolved.parts[one.part].dimensions.items()}, 1e-6)
    assert len(drawn) >= 4
    # the grip is round all along, but its lever hides a part of its edge at one end
    (lever,) = (one.told for one in drawn if one.part == "hand_lever")
    assert {row["name"]: row["text"] for row in lever["dimensions"] if row["name"] == "grip_radius"} == {"grip_radius": "Ø22"}  # type: ignore[attr-defined]


def test_tables_go_beside_the_views_where_a_larger_scale_fits_then() -> None:
    """The plate with foot of the press, 190 x 120 x 302 mm, fits on A3 at 1 : 2: its three views need 155 x 211 mm of 400 x 277 mm."""
    frame = next(one for one in drawings_of(read(ROOT / "bench/articad_bench/tasks/press_toggle/reference")) if one.part == "frame")
    assert frame.scale == 0.5


def arranged(dimensions: dict[str, float], rotation: str, z: list[int]) -> DrawingSheet:
    """Return the sheet of a plate with two holes and a connector in the middle of its upper face, turned about x."""
    script = f"""
from build123d import Align, Axis, Box, Cylinder, Pos
def build(part):
    d = part.dimensions
    plate = Box(d["width"], d["depth"], d["thickness"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    for x in (-1, 1):
        plate -= Pos(x * d["hole_x"], 0, 0) * Cylinder(d["hole_diameter"] / 2, 20)
    return plate.rotate(Axis.X, {rotation}), {{"bore": {{"o": (0, 0, 0), "z": {tuple(z)}, "x": (1, 0, 0)}}}}
"""
    (connector,) = PLAN["parts"][0]["connectors"]
    part = PLAN["parts"][0] | {"dimensions": dimensions, "connectors": [connector | {"o": [0, 0, 0], "z": z, "x": [1, 0, 0]}]}
    plan = PLAN | {"parts": [part], "joints": [], "freedoms": 0}
    assembly = Assembly.from_plan(AssemblyPlan.from_json(plan), {"plate": script}, cache=BuildCache(Path(tempfile.mkdtemp())))
    return next(one for one in drawings_of(assembly) if one.part == "plate")


@pytest.mark.parametrize(
    ("size", "rotation", "z"), [((200, 120, 15, 70, 25), "0", [0, 0, 1]), ((270, 20, 8, 125, 8), "90", [0, -1, 0])], ids=["plate", "bar"]
)
def test_sections_and_tables_are_placed_so_that_a_larger_scale_fits(size: tuple[float, ...], rotation: str, z: list[int]) -> None:
    """At 1 : 2 on A4, of which 263 mm can be drawn on.

    The plate of 200 x 120 mm needs 330 mm with its section beside the left view, so that goes below it. The bar of 270 mm and its leaders
    end at 200 mm, so that no table fits beside it; they go below all views.
    """
    names = ("width", "depth", "thickness", "hole_x", "hole_diameter")
    one = arranged(dict(zip(names, size, strict=True)) | {f"other_{k}": k + 0.5 for k in range(8)}, rotation, z)
    assert (one.scale, one.size) == (0.5, (297.0, 210.0))
    assert_nothing_overlaps(one)


def test_a_part_that_is_tiny_on_a4_is_drawn_on_a3() -> None:
    """A shade of 140 mm with a wall of 2 mm fits on A4 at 1 : 5 only, where its wall has 0.4 mm."""
    shade = next(one for one in drawings_of(read(ROOT / "examples/desk_lamp")) if one.part == "shade")
    assert (shade.scale, shade.size) == (0.5, (420.0, 297.0))


def test_the_views_show_what_a_workshop_needs() -> None:
    plate: Any = sheet("plate").told
    assert {row["name"] for row in plate["dimensions"]} >= {"width", "depth", "thickness", "boss_radius"}
    assert set(plate["by_holes"]) == {"bore_diameter", "hole_radius", "hole_depth"}
    pin: Any = sheet("pin").told
    # a body of revolution is dimensioned by its diameter, once
    assert [row["name"] for row in pin["dimensions"] if row["text"] in ("Ø18", "R9")] == ["head_radius"]


def test_whole_circles_are_told_by_their_diameter_and_arcs_by_their_radius() -> None:
    """A plate with two rounded corners (R 9) and a boss (radius 13 in the plan)."""
    script = """
from build123d import Align, Axis, Box, Cylinder, Pos, fillet
def build(part):
    d = part.dimensions
    up = (Align.CENTER, Align.CENTER, Align.MIN)
    plate = Box(d["width"], d["depth"], d["thickness"], align=up)
    plate = fillet(plate.edges().filter_by(Axis.Z).group_by(Axis.X)[0], d["corner_radius"])
    return plate + Pos(0, 0, d["thickness"]) * Cylinder(d["boss_radius"], 9, align=up), {"bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""
    part = PLAN["parts"][0] | {"dimensions": {"width": 81.5, "depth": 44, "thickness": 12, "corner_radius": 9, "boss_radius": 13}}
    plan = PLAN | {"parts": [part], "joints": [], "freedoms": 0}
    assembly = Assembly.from_plan(AssemblyPlan.from_json(plan), {"plate": script}, cache=BuildCache(Path(tempfile.mkdtemp())))
    told: Any = next(one.told for one in drawings_of(assembly) if one.part == "plate")
    assert {row["name"]: row["text"] for row in told["dimensions"] if "radius" in row["name"]} == {
        "boss_radius": "Ø26",
        "corner_radius": "R9",
    }


BALL = """
from build123d import Cylinder, Pos, Rot, Sphere
def build(part):
    d = part.dimensions
    ball = Sphere(d["ball_radius"])
    if d["stem"]:
        ball += Pos(0, 0, -d["ball_radius"]) * Cylinder(6, d["stem"])
    return Rot(X=d["turned_deg"]) * ball, {"bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""


@pytest.mark.parametrize(("stem", "turned"), [(0, 0), (0, 35), (40, 0), (40, 90)])
def test_spheres_are_told_by_their_diameter_and_an_s_once(stem: float, turned: float) -> None:
    """ISO 129-1: the letter S stands before the diameter of a sphere."""
    part = PLAN["parts"][0] | {"dimensions": {"ball_radius": 24, "stem": stem, "turned_deg": turned}}
    plan = PLAN | {"parts": [part], "joints": [], "freedoms": 0}
    assembly = Assembly.from_plan(AssemblyPlan.from_json(plan), {"plate": BALL}, cache=BuildCache(Path(tempfile.mkdtemp())))
    told: Any = next(one.told for one in drawings_of(assembly) if one.part == "plate")
    rows = [(row["text"], row["name"]) for row in told["dimensions"]]
    assert rows.count(("SØ48", "ball_radius")) == 1
    assert [text for text, _ in rows if text in ("48", "Ø48", "R24")] == []
    assert any(text.startswith("6") for text, _ in rows) == bool(stem)  # the height: 68 mm less what the ball hides


def test_the_ends_of_a_dome_are_not_those_of_a_sphere() -> None:
    """Half a ball on a box of its width: the width is the box's, and the ball is told by its radius."""
    script = """
from build123d import Align, Box, Cylinder, Sphere
def build(part):
    d = part.dimensions
    dome = Sphere(d["dome_radius"]) - Box(100, 100, 100, align=(Align.CENTER, Align.CENTER, Align.MAX))
    return dome + Box(48, 48, 10, align=(Align.CENTER, Align.CENTER, Align.MAX)), {"bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""
    part = PLAN["parts"][0] | {"dimensions": {"dome_radius": 24}}
    plan = PLAN | {"parts": [part], "joints": [], "freedoms": 0}
    assembly = Assembly.from_plan(AssemblyPlan.from_json(plan), {"plate": script}, cache=BuildCache(Path(tempfile.mkdtemp())))
    told: Any = next(one.told for one in drawings_of(assembly) if one.part == "plate")
    assert not [row for row in told["dimensions"] if row["text"].startswith("SØ")]


def test_the_table_of_holes_has_the_holes_of_the_script() -> None:
    told: Any = sheet("plate").told
    bore, *small = told["holes"]
    assert bore["diameter_mm"] == pytest.approx(10.01, abs=2e-3)
    assert (bore["depth_mm"], bore["through"]) == (pytest.approx(21, abs=1e-3), True)
    assert [hole["centre_mm"] for hole in small] == [pytest.approx([x, 7, 8], abs=2e-3) for x in (-30.25, 30.25)]
    assert [(hole["depth_mm"], hole["through"]) for hole in small] == [(pytest.approx(8, abs=1e-3), False)] * 2


def test_fits_are_told_by_the_classes_of_iso_286_on_both_parts() -> None:
    """H7 at 10 mm: +15/0 µm, g6: -5/-14 µm (ISO 286-2, tables 6 and 21)."""
    plate, pin = (sheet(name).told["holes"] for name in ("plate", "pin"))
    assert [hole["fit"] for hole in plate] == ["Ø10 H7 (+0.015/0)", "", ""]  # type: ignore[attr-defined]
    assert [hole["fit"] for hole in pin] == ["Ø10 g6 (-0.005/-0.014)"]  # type: ignore[attr-defined]


def test_views_are_projections_of_the_solid_and_a_section_cuts_it() -> None:
    brep = bearing().realised["plate"].built.solid.brep
    assert brep is not None
    section = View("section", FRONT.right, FRONT.up, cut=0.0)
    views, features = ViewKernel().project([(brep, bearing().at()["plate"])], [FRONT, section])
    points = np.array([[x, y] for line in views["front"].visible if len(line) == 4 for x, y in (line[:2], line[2:])])
    assert points.min(axis=0) == pytest.approx([-81.5 / 2, 0])
    assert points.max(axis=0) == pytest.approx([81.5 / 2, 21])
    assert views["front"].hidden
    # the plane y = 0 cuts the plate and the boss, not the small holes at y = 7, beside the bore
    loops = [(loop, np.roll(loop, -1, axis=0)) for face in views["section"].cut for loop in face]
    area = sum(0.5 * abs((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) for a, b in loops)  # shoelace formula
    assert area == pytest.approx((81.5 - 10.01) * 12 + (26 - 10.01) * 9)
    assert sorted({round(float(row[6]), 3) for row in features.circles}) == [2.6, 5.005, 13]


def test_hatching_fills_a_face_and_spares_its_holes() -> None:
    square = np.array([[0, 0], [40, 0], [40, 40], [0, 40]], dtype=float)
    hole = np.array([[10, 10], [10, 30], [30, 30], [30, 10]], dtype=float)
    length = sum(math.dist(a, b) for a, b in hatched([square, hole], spacing=0.5))
    assert 0.5 * length == pytest.approx(40 * 40 - 20 * 20, rel=0.01)
    middles = [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) for a, b in hatched([square, hole])]
    assert not [point for point in middles if all(10 < value < 30 for value in point)]


def boxes(one: DrawingSheet) -> list[tuple[str, float, float, float, float]]:
    def box(text: Lettering) -> tuple[str, float, float, float, float]:
        wide = text_width(text.words, text.height)
        back = {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor] * wide
        if text.turned:
            return text.words, text.x - text.height, text.y - back, text.x, text.y - back + wide
        return text.words, text.x - back, text.y, text.x - back + wide, text.y + text.height

    return [box(text) for text in one.everything()[2]]


@pytest.mark.parametrize("index", [0, 1, 2])
def test_no_text_overlaps_another_or_leaves_the_frame(index: int) -> None:
    assert_nothing_overlaps(sheets()[index])


def assert_nothing_overlaps(one: DrawingSheet) -> None:
    """Assert that each text lies in the frame, and no two share room."""
    left, bottom, right, top = one.inside
    found = boxes(one)
    assert [words for words, x0, y0, x1, y1 in found if x0 < left or y0 < bottom or x1 > right or y1 > top] == []
    crossing = [(a[0], b[0]) for a, b in itertools.combinations(found, 2) if a[1] < b[3] and b[1] < a[3] and a[2] < b[4] and b[2] < a[4]]
    assert crossing == []


def test_dxf_is_as_large_as_the_part_and_its_dimensions_measure_it() -> None:
    for name in ("plate", "pin"):
        document = ezdxf.read(io.StringIO(written_dxf(sheet(name)).decode()))
        assert not document.audit().errors
        found = document.modelspace().query("DIMENSION")
        measured = sorted(float(entity.get_measurement()) for entity in found)  # computed from its points
        assert measured == pytest.approx(sorted(one.value for one in sheet(name).dimensions), abs=1e-3)
    assert max(measured) > 20  # millimetres of the part, not of the paper


@pytest.mark.freecad
@opened.needs_freecad
def test_freecad_reads_the_dxf(tmp_path: Path) -> None:
    (tmp_path / "sheet.dxf").write_bytes(written_dxf(sheet("plate")))
    program = tmp_path / "program.py"
    program.write_text(
        "import json, FreeCAD as App\n"
        "App.ParamGet('User parameter:BaseApp/Preferences/Mod/Draft').SetBool('dxfUseDraftVisGroups', False)  # layers need a window\n"
        "import Draft, Import\n"
        "document = App.newDocument('sheet')\n"
        "Import.readDXF('sheet.dxf', 'sheet')\n"
        "edges = [edge for item in document.Objects if hasattr(item, 'Shape') for edge in item.Shape.Edges]\n"
        "radii = [edge.Curve.Radius for edge in edges if edge.Curve.TypeId == 'Part::GeomCircle']\n"
        "open('read.json', 'w').write(json.dumps({'edges': len(edges), 'radii': radii}))\n"
    )
    ended = freecad_install.find().run(program, folder=tmp_path)
    assert (tmp_path / "read.json").exists(), ended.said
    read = json.loads((tmp_path / "read.json").read_text())
    assert read["edges"] > 100
    assert all(any(abs(radius - wanted) < 1e-3 for radius in read["radii"]) for wanted in (2.6, 5.005, 13))


def test_letters_are_as_wide_as_those_of_the_pdf() -> None:
    metrics = pytest.importorskip("reportlab.pdfbase.pdfmetrics")
    words = "".join(chr(code) for code in range(32, 127)) + "Ø±×°–"
    assert text_width(words, 0.72) == pytest.approx(metrics.stringWidth(words, "Helvetica", 1.0), rel=1e-6)


def test_svg_and_pdf_have_the_size_of_the_paper_and_equal_sheets_give_equal_bytes() -> None:
    pytest.importorskip("reportlab")
    plate = sheet("plate")
    assert f'width="{plate.size[0]:g}mm" height="{plate.size[1]:g}mm"'.encode() in written_svg(plate)
    content = written_pdf(sheets(), "bearing")
    assert content.count(b"/Type /Page\n") == len(sheets())
    assert content == written_pdf(sheets(), "bearing")
    assert written_dxf(plate) == written_dxf(plate)


def test_the_sheet_of_the_assembly_has_a_balloon_for_each_item_that_is_seen() -> None:
    words = [text.words for text in sheets()[0].texts]
    assert {"1", "2", "plate", "pin", "bearing"} <= set(words)


def test_the_parts_list_of_the_assembly_has_the_sizes_of_the_items() -> None:
    """As the scripts make them: 12 mm and a boss of 9 mm; a pin of 26 mm in a head of 9 mm radius and 4 mm height."""
    words = [text.words for text in sheets()[0].texts]
    assert {"81.5 × 44 × 21", "18 × 18 × 30"} <= set(words)


def test_the_sheet_of_the_assembly_has_notes_and_a_section_of_every_part() -> None:
    section = View("Section at y = 0", FRONT.right, FRONT.up, cut=0.0)
    one = next(drawings_of(bearing(), notes=("Turn it by hand.", "Lengths in mm."), section=section))
    words = [text.words for text in one.texts]
    assert {"Turn it by hand.", "Lengths in mm."} <= set(words)
    assert any(text.startswith("Section at y = 0") for text in words)
    assert_nothing_overlaps(one)
    slopes = {float(np.sign((s.line.y1 - s.line.y0) * (s.line.x1 - s.line.x0))) for s in one.strokes if s.style == "hatch"}  # type: ignore[union-attr]
    assert slopes == {1.0, -1.0}  # neighbours are hatched differently


def test_a_section_of_solids_that_touch_cuts_each_of_them() -> None:
    """The common part of a box with all at once may lack some of them."""
    shapes = [(one.built.solid.brep, bearing().at()[name]) for name, one in bearing().realised.items() if one.built.solid.brep is not None]
    views, _ = ViewKernel().project(shapes, [View("section", FRONT.right, FRONT.up, cut=0.0)])
    assert len(views["section"].cut) == 3  # the plate to the left and to the right of the bore, and the pin


def test_a_picture_of_a_sheet_shows_its_lines_and_texts_and_not_the_margin() -> None:
    one = sheet("plate")
    first, second = (sheet_png(one, 1200) for _ in range(2))
    assert first == second
    image = np.asarray(Image.open(io.BytesIO(first)).convert("L"))
    left, bottom, right, top = one.inside
    k = 1200 / (right - left + 2)
    assert image.shape == (round(k * (top - bottom + 2)), 1200)
    assert image[round(k), image.shape[1] // 4] < 128  # the frame's upper edge, one millimetre inside

    for words, x0, y0, x1, y1 in (row for row in boxes(one) if row[0]):
        rows = slice(round(k * (top + 1 - y1)), round(k * (top + 1 - y0)))
        ink = (image[rows, round(k * (x0 - left + 1)) : round(k * (x1 - left + 1))] < 128).mean()
        assert 0.03 < ink < 0.8, words


def test_an_unknown_part_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(ArticadError, match="Did you mean 'plate'"):
        next(drawings_of(bearing(), "plat"))


CIRCLES = [("top", "c1", 5.0), ("front", "c2", 2.5)]
EDGES = [("front", "DistanceX", "e1", 5.0), ("front", "DistanceX", "e2", 5.0), ("top", "DistanceY", "e3", 7.0)]


def named(**names: float) -> list[tuple[str, Any, str]]:
    return [(kind, elements[0], name) for _, kind, elements, _, name in named_sizes(names, [], CIRCLES, EDGES, 9)]


def test_a_length_is_not_that_of_a_circle_and_no_edge_is_dimensioned_twice() -> None:
    assert named(left=-5.0, pin_radius=5.0, length=5.0) == [("Radius", "c1", "pin_radius"), ("DistanceX", "e1", "length")]


@pytest.mark.parametrize("name", ["spigot_radius", "pin_r"])
def test_a_radius_is_never_the_diameter_of_a_smaller_circle(name: str) -> None:
    assert named(**{"small_radius": 2.5, name: 5.0}) == [("Radius", "c2", "small_radius"), ("Radius", "c1", name)]
    assert list(named_sizes({name: 5.0}, [], CIRCLES[1:], EDGES, 9)) == []


def test_a_diameter_is_never_the_radius_of_a_larger_circle() -> None:
    assert named(bore_diameter=5.0) == [("Diameter", "c2", "bore_diameter")]
    assert list(named_sizes({"bore_diameter": 5.0}, [], CIRCLES[:1], EDGES, 9)) == []


@pytest.mark.parametrize("name", ["o_high", "neck_height", "low", "stud_reach", "wall"])
def test_a_height_is_never_that_of_a_circle(name: str) -> None:
    assert list(named_sizes({name: 5.0}, [], CIRCLES, [], 9)) == []


def test_a_name_that_may_be_of_a_circle_or_of_an_edge_is_not_guessed() -> None:
    assert named(tongue=5.0) == []
    assert list(named_sizes({"eye": 5.0}, [], CIRCLES, EDGES[2:], 9)) == [("top", "Radius", ["c1"], 5.0, "eye")]
    assert list(named_sizes({"tongue": 7.0}, [], CIRCLES, EDGES, 9)) == [("top", "DistanceY", ["e3"], 7.0, "tongue")]


@pytest.mark.parametrize("name", ["v_b", "handle_x", "top", "ram_to", "inset"])
def test_a_coordinate_is_no_size(name: str) -> None:
    assert named(**{name: 5.0}) == named(**{name: 7.0}) == named(**{name: 10.0}) == []


def test_an_edge_that_several_names_claim_is_told_once_without_a_name() -> None:
    assert named(slot_width=7.0, spigot_length=7.0) == [("DistanceY", "e3", "")]
    assert named(groove_height=5.0, side_thickness=5.0) == [("DistanceX", "e1", "")]  # although two edges have it
    assert named(spigot_radius=5.0, neck_radius=5.0) == [("Radius", "c1", "")]


def test_only_holes_and_diameters_are_told_by_their_diameter() -> None:
    assert [kind for kind, *_ in named(rod_bore=5.0)] == []  # a circle and edges have it
    assert list(named_sizes({"rod_bore": 5.0}, [], CIRCLES[1:], [], 9)) == [("front", "Diameter", ["c2"], 5.0, "rod_bore")]
    assert list(named_sizes({"tongue": 5.0}, [], CIRCLES[1:], [], 9)) == []


BRACKET = """
from build123d import Align, Box, Cylinder, Pos, Rot
def build(part):
    low = (Align.MIN, Align.MIN, Align.MIN)
    body = Box(30, 8, 20, align=low) + Pos(-60, 0, 0) * Box(60, 8, 90, align=low)
    return body - Pos(15, 0, 10) * Rot(90, 0, 0) * Cylinder(4, 100), {"o": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
"""


def test_the_title_of_a_section_stands_over_what_the_section_shows() -> None:
    """The bracket is 90 mm high; its part from the bore to the right, which the section shows, is 20 mm high."""
    connector = {"name": "o", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "kind": "mount_face", "label": "corner"}
    part = {"name": "bracket", "material": "steel", "description": "A bracket.", "dimensions": {}, "connectors": [connector]}
    plan = PLAN | {"name": "one", "ground": "bracket", "freedoms": 0, "parts": [part], "joints": []}
    with tempfile.TemporaryDirectory() as folder:
        one = Assembly.from_plan(AssemblyPlan.from_json(plan), {"bracket": BRACKET}, cache=BuildCache(Path(folder)))
        drawn = next(drawings_of(one, "bracket"))
    title = next(text for text in drawn.texts if text.words == "A–A")
    base = next(dimension for dimension in drawn.dimensions if dimension.value == pytest.approx(90.0))
    foot = min(base.start[1], base.end[1])
    assert title.y == pytest.approx(foot + 20.0 * drawn.scale + 3.0, abs=1e-3)
