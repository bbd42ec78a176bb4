"""The sheet of one part: three views in first-angle projection, an isometric view, a section through holes, dimensions and tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any, Final

import numpy as np

from articad.arrays import FloatArray
from articad.kernels.inside_freecad.sizes import SAME, named_sizes
from articad.kernels.views import Arc, DrawnView, Features, Line, Path2d, Segment, View
from articad.papers.hatching import hatched
from articad.papers.holes import Hole
from articad.papers.sheet import (
    A3,
    A4,
    ARROW,
    BLOCK,
    EDGE,
    FILING,
    ROW,
    SMALL,
    DimensionLine,
    DrawingSheet,
    Leader,
    Lettering,
    SheetLine,
    sampled,
    text_width,
)

__all__ = ["ISO", "SCALES", "PartFacts", "on_paper", "part_sheet", "ratio", "section_of", "views_of"]

SCALES: Final = (20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)  # ISO 5455
FRONT, TOP, LEFT = (
    View("front", (1, 0, 0), (0, 0, 1), hidden=True),
    View("top", (1, 0, 0), (0, 1, 0), hidden=True),
    View("left", (0, -1, 0), (0, 0, 1), hidden=True),
)
_S2, _S6 = np.sqrt(0.5), np.sqrt(1 / 6)
ISO: Final = View("iso", (_S2, _S2, 0.0), (-_S6, _S6, 2 * _S6))
_SEES: Final = {0: "left", 1: "front", 2: "top"}  # axis -> view in which a hole along it is a circle
_MOST: Final = 16  # dimensions of a sheet
_MEASURED: Final = 2  # digits of a size that the plan does not state
_FIRST, _STEP = 9.0, 7.0  # from a view to its first dimension line, and between dimension lines
_LETTERS: Final = "ABCDEFGHJKLMNPRSTUVWYZ"
_HOLE_WIDTHS: Final = (17.0, 11.0, 15.0, 15.0, 14.0, 16.0, 48.0)
_HOLE_HEAD: Final = ("hole", "view", "x", "y", "Ø", "depth", "fit")
_NAME_WIDTHS: Final = (38.0, 16.0)
_GAP: Final = 14.0  # between views
_LEAST_ISO: Final = 30.0  # width that tables leave for the isometric view
_TINY: Final = 0.2  # scale at which bores and walls are dots and lines: a larger paper is taken for the next scale already


@dataclass(frozen=True)
class PartFacts:
    """What a sheet states about a part.

    Attributes:
        name: Its name, and that of its file.
        box: Smallest and largest coordinates `(2, 3)` [mm].
        dimensions: Of the plan.
        holes: From `holes_of`.
        features: From the kernel.
        views: From the kernel: front, top, left, iso, and the section, if there is one.
        section: The view of the section, or None.
        fields: Of the title block, by label.
    """

    name: str
    box: FloatArray
    dimensions: Mapping[str, float]
    holes: tuple[Hole, ...]
    features: Features
    views: Mapping[str, DrawnView]
    section: View | None
    fields: Mapping[str, str]


@dataclass
class _Placed:
    """A view on the paper: where the image of the part's origin lies, and its edges."""

    view: View
    origin: tuple[float, float]
    scale: float
    low: FloatArray
    high: FloatArray
    columns: dict[str, list[list[tuple[float, float]]]] = field(default_factory=lambda: {"across": [], "up": []})

    def flat(self, point: FloatArray) -> FloatArray:
        """Return the image of a point in the view's frame [mm]."""
        return np.array([point @ np.array(self.view.right), point @ np.array(self.view.up)])

    def at(self, point: FloatArray) -> tuple[float, float]:
        """Return the place of a point on the paper."""
        u, v = self.flat(point)
        return self.origin[0] + self.scale * float(u), self.origin[1] + self.scale * float(v)

    @property
    def edges(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top on the paper."""
        return (
            self.origin[0] + self.scale * self.low[0],
            self.origin[1] + self.scale * self.low[1],
            self.origin[0] + self.scale * self.high[0],
            self.origin[1] + self.scale * self.high[1],
        )


def section_of(holes: Sequence[Hole], box: FloatArray) -> View | None:
    """Return the section that shows most holes along their axes, through a plane parallel to the front or left view; None without holes."""
    best: tuple[float, View] | None = None
    for view, normal in ((FRONT, 1), (LEFT, 0)):
        for hole in holes:
            if not hole.hollow or hole.along is None or hole.along == normal:
                continue
            at = hole.centre[normal]
            cut = [h for h in holes if h.hollow and h.along not in (None, normal) and abs(h.centre[normal] - at) < SAME * 1e3]
            worth = sum(h.depth * h.radius for h in cut) * (1.001 if normal == 1 else 1.0)
            if (best is None or worth > best[0]) and box[0][normal] < at < box[1][normal]:
                best = worth, View("section", view.right, view.up, cut=-float(at))
    return None if best is None else best[1]


def views_of(section: View | None) -> tuple[View, ...]:
    """Return the views of a sheet."""
    return (FRONT, TOP, LEFT, ISO, *(() if section is None else (section,)))


def part_sheet(facts: PartFacts, size: tuple[float, float] | None = None) -> DrawingSheet:
    """Return the sheet of a part at the largest scale that fits on A4, or on A3 if that is much larger or A4 has no room for the tables.

    Args:
        facts: What to draw.
        size: Of the sheet; A4 or A3 by need if None.
    """
    layouts = [layout for paper in ((A4, A3) if size is None else (size,)) if (layout := _layout(facts, paper)) is not None]
    if not layouts:
        layouts = [_layout(facts, size or A3, tables=False) or _Layout(size or A3, SCALES[-1], {}, ())]
    larger = 2 if layouts[0].scale <= _TINY else 4
    best = layouts[-1] if len(layouts) == 2 and layouts[1].scale >= larger * layouts[0].scale else layouts[0]
    return _drawn(facts, best)


@dataclass(frozen=True)
class _Layout:
    size: tuple[float, float]
    scale: float
    views: dict[str, _Placed]
    tables: tuple[tuple[float, float, str, tuple[str, ...], tuple[tuple[str, ...], ...], tuple[float, ...]], ...]


# ---------------------------------------------------------------------- layout


def _layout(facts: PartFacts, paper: tuple[float, float], *, tables: bool = True) -> _Layout | None:
    """Return the places of views and tables at the largest scale at which they fit on a paper; None if they fit at none."""
    wanted = list(_tables(facts)) if tables else []
    # the section stands to the right of the left view, or below it if only that fits
    places = product(SCALES, (False,) if facts.section is None else (False, True))
    lines = [(view, kind) for view, kind, *_ in _planned(facts)]
    layouts = (_layout_at(facts, paper, wanted, lines, scale, below=below) for scale, below in places)
    return next((layout for layout in layouts if layout is not None), None)


def _layout_at(
    facts: PartFacts, paper: tuple[float, float], wanted: Sequence[Any], lines: Sequence[tuple[str, str]], scale: float, *, below: bool
) -> _Layout | None:
    """Return the places of views and tables at a scale; None if they do not fit.

    Args:
        facts: What to draw.
        paper: Size of the sheet.
        wanted: The tables.
        lines: View and kind of each dimension.
        scale: Of the views.
        below: Whether the section stands below the left view.
    """
    w, d, h = (scale * float(value) for value in facts.box[1] - facts.box[0])
    left, bottom, right, top = FILING + 4.0, EDGE + 4.0, paper[0] - EDGE - 4.0, paper[1] - EDGE - 13.0
    beside_block = paper[0] - EDGE - BLOCK[0] - 4.0  # where the title block begins
    leaders = 26.0  # for texts beside circles
    x_front = left + _FIRST + _STEP * max(lines.count((view, "DistanceY")) for view in ("front", "top")) + 4.0
    y_front = top - h
    x_left = x_front + w + leaders
    y_top = y_front - (_FIRST + _STEP * lines.count(("front", "DistanceX")) + 10.0) - d
    s = 0.0 if facts.section is None else (w if facts.section.right == FRONT.right else d)
    x_section, y_section = (x_left, y_top + d - h) if below else (x_left + d + _GAP + 12.0, y_front)
    far = max(x_section + s, x_left + d) if s else x_left + d
    floor = bottom + BLOCK[1] + 4.0 if x_left > beside_block else bottom
    if far > right or min(y_top, y_section) < floor + 2.0:
        return None
    # what is left for tables and the isometric view: to the right of the top view, and above the title block
    y_free, ceiling = EDGE + BLOCK[1] + 5.0, (y_section if below else y_front) - 14.0
    corners = [(x_left, ceiling), (far + leaders - _LEAST_ISO, top)]  # there, or to the right of all views, up to the top
    if below:
        corners.insert(1, (x_left - _LEAST_ISO, ceiling))  # below the section, with the isometric view elsewhere
    corners.append((left, min(y_top, y_section) - 16.0))  # below all views: those of a long, slim part
    tries = [(x, y, apart) for x, y in corners for apart in ((False, True) if x == x_left else (False,))]
    seated = next((found for x, y, apart in tries if (found := _seated(wanted, x, y_free, right, y, apart=apart)) is not None), None)
    if seated is None:
        return None
    placed_tables, x_iso = seated
    low, high = _flat_box(facts, ISO)
    rooms = (  # beside the top view; below it, above the title block or beside that
        (x_left, y_free, x_iso - 6.0, ceiling),
        (left, y_free, x_iso - 6.0, y_top - 16.0),
        (left, bottom, min(x_iso - 6.0, beside_block), y_top - 16.0),
    )
    best = _roomiest(high - low, scale, rooms)
    if best is None and scale > SCALES[-3]:
        return None
    views = {
        view.name: _Placed(view, _origin(facts, view, corner, scale), scale, *_flat_box(facts, view))
        for view, corner in ((FRONT, (x_front, y_front)), (TOP, (x_front, y_top)), (LEFT, (x_left, y_front)))
    }
    if facts.section is not None:
        views["section"] = _Placed(
            facts.section, _origin(facts, facts.section, (x_section, y_section), scale), scale, *_flat_box(facts, facts.section)
        )
    if best is not None:
        small, (x0, y0, x1, y1) = best
        middle = 0.5 * (low + high)
        views["iso"] = _Placed(
            ISO, (0.5 * (x0 + x1) - small * float(middle[0]), 0.5 * (y0 + y1) - small * float(middle[1])), small, low, high
        )
    return _Layout(paper, scale, views, placed_tables)


def _roomiest(
    span: FloatArray, most: float, rooms: Sequence[tuple[float, float, float, float]]
) -> tuple[float, tuple[float, float, float, float]] | None:
    """Return the largest scale at which a view fits into one of some rooms (left, bottom, right, top), and the room; None if into none."""
    for scale in (one for one in SCALES if most / 10 <= one <= most):
        for room in rooms:
            if span[0] * scale <= room[2] - room[0] and span[1] * scale <= room[3] - room[1] - 5.0:
                return scale, room
    return None


def _seated(wanted: Sequence[Any], x_free: float, y_free: float, right: float, ceiling: float, *, apart: bool = False) -> Any:
    """Return the tables with their lower right corners, and where they begin on the left: above each other, or side by side."""
    placed: list[Any] = []
    x, y, widest = right, y_free, 0.0
    for title, head, rows, widths in wanted:
        tall, wide = ROW * (len(rows) + 1) + 6.0, max(sum(widths), 1.08 * text_width(title, SMALL))
        if placed and (apart or y + tall > ceiling):
            x, y, widest = x - widest - 5.0, y_free, 0.0
        if y + tall > ceiling or x - wide < x_free + _LEAST_ISO:
            return None
        placed.append((x, y, title, head, rows, widths))
        y, widest = y + tall + 3.0, max(widest, wide)
    return tuple(placed), x - widest


def _flat_box(facts: PartFacts, view: View) -> tuple[FloatArray, FloatArray]:
    corners = np.array([[facts.box[i][0], facts.box[j][1], facts.box[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    flat = corners @ np.array([view.right, view.up]).T
    return flat.min(axis=0), flat.max(axis=0)


def _origin(facts: PartFacts, view: View, corner: tuple[float, float], scale: float) -> tuple[float, float]:
    low, _ = _flat_box(facts, view)
    return corner[0] - scale * float(low[0]), corner[1] - scale * float(low[1])


def _tables(facts: PartFacts) -> Iterator[tuple[str, tuple[str, ...], tuple[tuple[str, ...], ...], tuple[float, ...]]]:
    """Yield the table of holes and that of dimensions of the plan that no view shows: title, head, rows and widths."""
    told = {name for *_, name in _planned(facts) if name}
    rest = tuple((name, f"{value:.6g}") for name, value in facts.dimensions.items() if name not in told and name not in _hole_names(facts))
    for start in range(0, len(rest), 24):
        yield "Further dimensions of the plan", ("name", "value"), rest[start : start + 24], _NAME_WIDTHS
    labels = _labels(facts.holes)
    rows = []
    for hole, label in zip(facts.holes, labels, strict=True):
        view, x, y = _where(facts, hole)
        depth = f"{hole.depth:.5g}" + (" thru" if hole.through and hole.hollow else "")
        rows.append((label if hole.hollow else f"{label} (shaft)", view, x, y, f"{2 * hole.radius:.5g}", depth, hole.fit))
    if rows:
        fits = any(hole.fit for hole in facts.holes)
        cut = len(_HOLE_HEAD) if fits else -1
        head = _HOLE_HEAD if fits else _HOLE_HEAD[:cut]
        widths = _HOLE_WIDTHS if fits else _HOLE_WIDTHS[:cut]
        yield "Holes and fitted shafts: x, y from the lower left corner of the view", head, tuple(row[: len(head)] for row in rows), widths


def _where(facts: PartFacts, hole: Hole) -> tuple[str, str, str]:
    """Return the view in which a hole is a circle, and its centre from the lower left corner of the view, as texts."""
    if hole.along is None:
        return "oblique", "", ""
    view = {"front": FRONT, "top": TOP, "left": LEFT}[_SEES[hole.along]]
    low, _ = _flat_box(facts, view)
    u, v = np.array([view.right, view.up]) @ hole.centre - low
    return view.name, f"{u:.6g}", f"{v:.6g}"


def _labels(holes: Sequence[Hole]) -> list[str]:
    """Return A1, A2, B1: one letter for equal holes."""
    labels: list[str] = []
    kinds: list[tuple[Any, ...]] = []
    counts: dict[int, int] = {}
    for hole in holes:
        kind = (round(hole.radius, 3), round(hole.depth, 2), hole.hollow, hole.fit)
        if kind not in kinds:
            kinds.append(kind)
        index = kinds.index(kind)
        counts[index] = counts.get(index, 0) + 1
        letter = _LETTERS[index % len(_LETTERS)] * (1 + index // len(_LETTERS))
        labels.append(f"{letter}{counts[index]}")
    return labels


def _hole_names(facts: PartFacts) -> dict[str, Hole]:
    """Return the dimensions of the plan that the table of holes shows: radii and diameters of holes, and depths of holes that are not through."""
    found: dict[str, Hole] = {}
    for name, value in facts.dimensions.items():
        for hole in facts.holes:
            is_width = ("radius" in name and abs(hole.radius - value) < _LOOSE) or (
                "diameter" in name and abs(2 * hole.radius - value) < _LOOSE
            )
            is_depth = "depth" in name and not hole.through and abs(hole.depth - value) < _LOOSE
            if is_width or is_depth:
                found.setdefault(name, hole)
    return found


_LOOSE: Final = 2e-3  # mm: radii of holes are measured on meshes
_NEAR_POLE: Final = 1e-3  # share of a sphere's radius within which points count as at its pole: outlines are drawn by polylines


# ---------------------------------------------------------------------- dimensions


def _planned(facts: PartFacts) -> list[tuple[str, str, list[Any], float, str]]:
    """Return the dimensions of the views: the view, the kind, points or a circle, the value, the name in the plan."""
    low, high = facts.box
    size = high - low
    overall: list[tuple[str, str, Any, float]] = []
    widths: dict[tuple[str, str], float] = {}  # overall sizes that are diameters
    turned: set[tuple[Any, ...]] = set()
    for axis, view, kind in ((0, "front", "DistanceX"), (2, "front", "DistanceY"), (1, "top", "DistanceY")):
        key = _turned(facts, axis, float(size[axis]))
        if key is not None and key in turned:
            continue  # the diameter of a body of revolution, or of a ball, is told once
        if key is not None:
            turned.add(key)
            widths[view, kind] = float(size[axis])
        ends = _ends(facts, axis, view)
        overall.append((view, kind, ends, float(size[axis])))
    holes = {(round(h.radius, 2), *np.round(h.centre - (h.centre @ h.axis) * h.axis, 1)) for h in facts.holes if h.hollow}
    circles = []
    for row in facts.features.circles:
        centre, axis, radius = row[:3], row[3:6], float(row[6])
        along = next((k for k in range(3) if abs(abs(axis[k]) - 1.0) < SAME), None)
        spot = (round(radius, 2), *np.round(centre - (centre @ axis) * axis, 1))
        if along is not None and spot not in holes:
            circles.append((_SEES[along], tuple(np.round(row, 6)), radius))
    edges = sorted(_straight(facts), key=lambda row: row[4])
    named = {
        name: value for name, value in facts.dimensions.items() if not name.endswith(("_deg", "_count")) and name not in _hole_names(facts)
    }
    # a radius or diameter that the overall size of a body of revolution states needs no circle
    stated: dict[tuple[str, str], str] = {}
    for place, width in widths.items():
        name = next(
            (n for n, v in named.items() if ("radius" in n and abs(2 * v - width) < SAME) or ("diameter" in n and abs(v - width) < SAME)),
            "",
        )
        if named.pop(name, None) is not None:
            stated[place] = name
    rows = [_by_diameter(facts, row) for row in named_sizes(named, overall, circles, [row[:4] for row in edges], _MOST)]
    return [(*row[:4], row[4] or stated.pop(row[:2], "")) for row in rows]


def _by_diameter(facts: PartFacts, row: tuple[str, str, list[Any], float, str]) -> tuple[str, str, list[Any], float, str]:
    """Return a dimension of the radius of a whole circle as that of its diameter (ISO 129-1); an arc keeps its radius."""
    view, kind, elements, value, name = row
    if kind != "Radius" or not _is_whole(facts, np.array(elements[0])):
        return row
    return view, "Diameter", elements, 2 * value, name


def _is_whole(facts: PartFacts, circle: FloatArray) -> bool:
    """Return whether the arcs of a part with a circle's radius go all around its axis, at one place along it."""
    every = facts.features.circles
    apart = every[:, :3] - circle[:3]
    along = apart @ circle[3:6]
    coaxial = (np.linalg.norm(apart - along[:, None] * circle[3:6], axis=1) < 1e-4) & (np.abs(every[:, 6] - circle[6]) < 1e-4)
    return any(every[coaxial & (np.abs(along - at) < 1e-4), 7].sum() > 2 * np.pi - SAME for at in along[coaxial])


def _turned(facts: PartFacts, axis: int, size: float) -> tuple[Any, ...] | None:
    """Return what identifies the circle or the sphere that makes the overall size along an axis, its sign of ISO 129-1 first; None if it is none."""
    middle = 0.5 * (facts.box[0] + facts.box[1])
    for row in facts.features.circles:
        if abs(2 * row[6] - size) < 1e-4 and abs(row[3 + axis]) < SAME and abs(row[axis] - middle[axis]) < 1e-4:
            along = int(np.abs(row[3:6]).argmax())
            if abs(abs(row[3 + along]) - 1.0) < SAME and _is_whole(facts, row):
                return "Ø", along, round(float(row[6]), 4)
    for x, y, z, radius in facts.features.spheres:
        centre = np.array([x, y, z])
        if abs(2 * radius - size) < 1e-4 and abs(centre[axis] - middle[axis]) < 1e-4 and _is_at_poles(facts, axis, centre, radius):
            return "SØ", round(float(radius), 4)
    return None


def _is_at_poles(facts: PartFacts, axis: int, centre: FloatArray, radius: float) -> bool:
    """Return whether a part reaches its bounds along an axis at the poles of a sphere only.

    What lies within d of a bound lies within sqrt(2 R d) of the pole, as on every sphere of radius R.
    """
    points, across, right, up = _seen(facts, axis, FRONT if axis != 1 else TOP)
    near = np.abs(points[:, across, None] - facts.box[:, axis]).min(axis=1) < _NEAR_POLE * radius
    aside = points[near, 1 - across] - (centre @ right, centre @ up)[1 - across]
    return bool(near.any() and (np.abs(aside) < 1.01 * np.sqrt(2 * _NEAR_POLE) * radius).all())


def _seen(facts: PartFacts, axis: int, view: View) -> tuple[FloatArray, int, FloatArray, FloatArray]:
    """Return points of the visible lines of a view `(N, 2)` [mm], which of their coordinates is along an axis, and the view's right and up."""
    right, up = np.array(view.right), np.array(view.up)
    points = np.concatenate([sampled(line) for line in facts.views[view.name].visible])
    return points, 0 if abs(right[axis]) > 0.5 else 1, right, up


def _ends(facts: PartFacts, axis: int, view: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return points of the view at both ends of the part along an axis, those nearest to the dimension line."""
    points, across, right, up = _seen(facts, axis, {"front": FRONT, "top": TOP}[view])
    found = []
    for bound in facts.box[:, axis]:
        off = np.abs(points[:, across] - bound)
        at = points[off < off.min() + 1e-3]
        u, v = at[int(at[:, 1 - across].argmin())]
        point = u * right + v * up
        found.append(tuple(bound if k == axis else float(point[k]) for k in range(3)))
    return found[0], found[1]


def _straight(facts: PartFacts) -> Iterator[tuple[str, str, Any, float, float]]:
    """Yield the straight edges along an axis: the view, the kind, both ends, the length, and the distance from the view's dimension lines."""
    shown = {0: ("front", "DistanceX", 2), 1: ("top", "DistanceY", 0), 2: ("front", "DistanceY", 0)}
    for start, end in facts.features.straight:
        along = end - start
        length = float(np.linalg.norm(along))
        for axis, (view, kind, off) in shown.items():
            if length > SAME and abs(abs(along[axis]) - length) < SAME:
                yield view, kind, (tuple(start.tolist()), tuple(end.tolist())), length, float(start[off] - facts.box[0][off])


# ---------------------------------------------------------------------- drawing


def _drawn(facts: PartFacts, layout: _Layout) -> DrawingSheet:
    sheet = DrawingSheet(facts.name, layout.size, layout.scale, facts.name)
    for name, placed in layout.views.items():
        _draw_view(sheet, facts.views[name], placed)
    if "section" in layout.views and "top" in layout.views and facts.section is not None:
        _mark_section(sheet, layout.views["top"], facts.section)
    told = _draw_dimensions(sheet, facts, layout.views) if layout.views else []
    labels = _labels(facts.holes)
    spots: dict[tuple[Any, ...], list[str]] = {}
    for hole, label in zip(facts.holes, labels, strict=True):
        _mark_hole(sheet, hole, layout.views)
        if hole.along is not None and layout.views:
            x, y = layout.views[_SEES[hole.along]].at(hole.centre)
            spots.setdefault((round(x, 1), round(y, 1)), [str(hole.radius * layout.scale)]).append(label)
    for (x, y), (radius, *names) in spots.items():  # holes behind each other have one label
        words = ", ".join(names)
        sheet.texts.append(Lettering(*_free_spot(sheet, x, y, float(radius), words), words, SMALL, bold=True))
    for x, y, title, head, rows, widths in layout.tables:
        sheet.table(x, y, title, head, rows, widths)
    sheet.frame(_fields(facts, layout.scale))
    hole_rows = [
        {
            "label": label,
            "diameter_mm": 2 * hole.radius,
            "depth_mm": hole.depth,
            "through": hole.through,
            "fit": hole.fit,
            "centre_mm": hole.centre.tolist(),
        }
        for hole, label in zip(facts.holes, labels, strict=True)
    ]
    sheet.told = {
        "part": facts.name,
        "scale": layout.scale,
        "dimensions": told,
        "holes": hole_rows,
        "by_holes": {
            name: {"value": facts.dimensions[name], "hole": labels[facts.holes.index(hole)]} for name, hole in _hole_names(facts).items()
        },
        "listed": {row[0]: row[1] for *_, rows, widths in layout.tables if widths == _NAME_WIDTHS for row in rows},
    }
    return sheet


def _draw_view(sheet: DrawingSheet, drawn: DrawnView, placed: _Placed) -> None:
    for style, lines in (("hidden", drawn.hidden), ("visible", drawn.visible)):
        for line in lines:
            sheet.strokes.append(SheetLine("visible" if style == "visible" else "hidden", on_paper(line, placed.origin, placed.scale)))
    for loops in drawn.cut:
        for start, end in hatched([np.array(placed.origin) + placed.scale * loop for loop in loops]):
            sheet.line("hatch", *start, *end)
    left, _, right, _ = placed.edges
    if placed.view.name == "section":
        shown = (*drawn.visible, *drawn.hidden)
        top = max((float(sampled(on_paper(each, placed.origin, placed.scale))[:, 1].max()) for each in shown), default=placed.edges[3])
        sheet.texts.append(Lettering(0.5 * (left + right), top + 3.0, "A–A", 3.5, "middle", bold=True))
    elif placed.view.name == "iso" and placed.scale != sheet.scale:
        sheet.texts.append(Lettering(0.5 * (left + right), placed.edges[1] - 4.0, f"({ratio(placed.scale)})", 2.0, "middle"))


def on_paper(line: Line, origin: tuple[float, float], k: float) -> Line:
    """Return a line of a view at a place on the paper, at a scale."""
    x, y = origin
    if isinstance(line, Segment):
        return Segment(x + k * line.x0, y + k * line.y0, x + k * line.x1, y + k * line.y1)
    if isinstance(line, Arc):
        return Arc(x + k * line.x, y + k * line.y, k * line.radius, line.start, line.end)
    return Path2d(np.array([x, y]) + k * line.points)


def _mark_section(sheet: DrawingSheet, top: _Placed, view: View) -> None:
    """Draw the plane of the section in the top view, with arrows along the view."""
    left, bottom, right, upper = top.edges
    cut = -(view.cut or 0.0)
    if view.right == FRONT.right:
        y = top.origin[1] + top.scale * cut
        sheet.line("cut", left - 5.0, y, right + 5.0, y)
        for x in (left - 5.0, right + 5.0):
            _arrow(sheet, (x, y), (0.0, 6.0))
            sheet.texts.append(Lettering(x, y + 7.0, "A", 3.5, "middle", bold=True))
    else:
        x = top.origin[0] + top.scale * cut
        sheet.line("cut", x, bottom - 5.0, x, upper + 5.0)
        for y in (bottom - 5.0, upper + 5.0):
            _arrow(sheet, (x, y), (6.0, 0.0))
            sheet.texts.append(Lettering(x + 7.0, y - 1.75, "A", 3.5, bold=True))


def _arrow(sheet: DrawingSheet, start: tuple[float, float], by: tuple[float, float]) -> None:
    begin, along = np.array(start), np.array(by)
    tip = begin + along
    unit = along / np.linalg.norm(along)
    aside = np.array([-unit[1], unit[0]])
    sheet.line("visible", *begin, *(tip - ARROW * unit))
    sheet.arrows.append((tip, tip - ARROW * unit + 0.7 * aside, tip - ARROW * unit - 0.7 * aside))


def _mark_hole(sheet: DrawingSheet, hole: Hole, views: Mapping[str, _Placed]) -> None:
    """Draw the centre lines of a hole in the three views and in the section."""
    if hole.along is None:
        return
    for name in ("front", "top", "left", "section"):
        placed = views.get(name)
        if placed is None:
            continue
        right, up = (abs(np.array(axis)[hole.along]) for axis in (placed.view.right, placed.view.up))
        x, y = placed.at(hole.centre)
        if name == "section" and abs(hole.centre @ np.cross(placed.view.right, placed.view.up) - (placed.view.cut or 0.0)) > 1e-3:
            continue
        if right or up:
            half = 0.5 * hole.depth * placed.scale + 2.0
            sheet.line("centre", *((x - half, y, x + half, y) if right else (x, y - half, x, y + half)))
        else:
            r = hole.radius * placed.scale + 2.0
            sheet.line("centre", x - r, y, x + r, y)
            sheet.line("centre", x, y - r, x, y + r)


def _free_spot(sheet: DrawingSheet, x: float, y: float, r: float, label: str) -> tuple[float, float]:
    """Return a place for a label beside a circle where nothing is drawn."""
    width = 1.08 * text_width(label, SMALL)
    spots = []
    for reach in (0.75, 1.0, 1.35, 1.8, 2.5):
        d = reach * r + 0.8
        spots += [(x + d, y + d), (x - d - width, y + d), (x + d, y - d - SMALL), (x - d - width, y - d - SMALL)]
        far = max(reach, 1.0) * r + 2.6
        spots += [(x + far, y + 0.5), (x - far - width, y + 0.5), (x + 0.5, y + far), (x + 0.5, y - far - SMALL)]
    free = (spot for spot in spots if sheet.clear_of(spot[0] - 0.4, spot[1] - 0.4, spot[0] + width + 0.4, spot[1] + SMALL + 0.4))
    return next(free, spots[0])


def _draw_dimensions(sheet: DrawingSheet, facts: PartFacts, views: Mapping[str, _Placed]) -> list[dict[str, object]]:
    """Add the dimensions of the views, shortest nearest to the part, and return what they state."""
    told: list[dict[str, object]] = []
    planned = _planned(facts)
    linear = sorted((row for row in planned if row[1].startswith("Distance")), key=lambda row: row[3])
    marks: dict[tuple[str, str], list[float]] = {}
    for view, kind, elements, *_ in linear:
        for point in elements if len(elements) == 2 else elements[0]:
            marks.setdefault((view, kind), []).append(views[view].at(np.array(point))[kind == "DistanceY"])
    for view, kind, elements, value, name in linear:
        placed = views[view]
        points = elements if len(elements) == 2 else list(elements[0])
        start, end = (placed.at(np.array(point)) for point in points)
        vertical = kind == "DistanceY"
        axis = {"DistanceX": 0, "DistanceY": 2 if view == "front" else 1}[kind]
        round_one = _turned(facts, axis, value) if len(elements) == 2 else None
        words = f"{round_one[0] if round_one else ''}{_number(value if name else round(value, _MEASURED))}"
        a, b = sorted((start[1], end[1]) if vertical else (start[0], end[0]))
        short = b - a < text_width(words, SMALL) + 2.0 or b - a < 2.5 * ARROW
        wide = text_width(words, SMALL)
        outside = None
        taken = (a, b)
        if short:  # on the side where no extension line of another dimension crosses the text
            sides = [side for off in (1.0, 4.0, 8.0, 12.0) for side in (b + ARROW + off, a - ARROW - off - wide)]
            crossed = [sum(1 for mark in marks[view, kind] if side - 0.5 < mark < side + wide + 0.5) for side in sides]
            low, high = (sheet.inside[1], sheet.inside[3]) if vertical else (sheet.inside[0], sheet.inside[2])
            beyond = [side < low + 2.0 or side + wide > high - 2.0 for side in sides]
            outside = sides[min(range(len(sides)), key=lambda n: (beyond[n], crossed[n], n))]
            taken = (min(a - 2 * ARROW, outside) - 1.0, max(b + 2 * ARROW, outside + wide) + 1.0)
        side = placed.columns["up" if vertical else "across"]
        column = next((n for n, used in enumerate(side) if all(taken[1] + 2 < low or high + 2 < taken[0] for low, high in used)), len(side))
        if column == len(side):
            side.append([])
        side[column].append(taken)
        left, bottom, _, _ = placed.edges
        at = (left if vertical else bottom) - _FIRST - _STEP * column
        sheet.dimensions.append(DimensionLine(start, end, at, vertical, words, value, outside))
        told.append({"view": view, "text": words, "value": value, "name": name})
    for view, kind, elements, value, name in planned:
        if kind.startswith("Distance"):
            continue
        placed, circle = views[view], np.array(elements[0])
        words = f"{'R' if kind == 'Radius' else 'Ø'}{_number(value)}"
        sheet.add(_leader(sheet, facts, view, placed, circle, words).drawn())
        told.append({"view": view, "text": words, "value": value, "name": name, "radius": float(circle[6])})
    return told


def _leader(sheet: DrawingSheet, facts: PartFacts, view: str, placed: _Placed, circle: FloatArray, words: str) -> Leader:
    """Return the shortest leader to a circle whose text lies free."""
    wide = text_width(words, SMALL) + 1.0
    points, centre = _rim(facts, view, placed, circle), np.array(placed.at(circle[:3]))
    for reach in (6.0, 9.0, 13.0, 18.0, 25.0, 34.0):
        for angle in (45, 30, 60, -30, -45, -60, 135, 150, 120, -135, -150, -120):
            direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
            tip = points[int(((points - centre) @ direction).argmax())]
            knee = tip + reach * direction
            right = direction[0] > 0
            left = knee[0] if right else knee[0] - wide
            if sheet.clear_of(left - 0.5, knee[1] - 0.5, left + wide + 0.5, knee[1] + SMALL + 1.5):
                return Leader((float(tip[0]), float(tip[1])), (float(knee[0]), float(knee[1])), words, bool(right))
    tip = points[0]
    return Leader((float(tip[0]), float(tip[1])), (float(tip[0]) + 8.0, float(tip[1]) + 8.0), words)


def _rim(facts: PartFacts, view: str, placed: _Placed, circle: FloatArray) -> FloatArray:
    """Return points of a circle on the paper `(N, 2)`: of the arcs that the view has of it."""
    x, y = placed.at(circle[:3])
    found = (*facts.views[view].visible, *facts.views[view].hidden)
    arcs = [on_paper(line, placed.origin, placed.scale) for line in found if isinstance(line, Arc) and abs(line.radius - circle[6]) < 1e-4]
    spans = [(arc.start, arc.end) for arc in arcs if isinstance(arc, Arc) and np.hypot(arc.x - x, arc.y - y) < 1e-3] or [(0.0, 360.0)]
    angles = np.radians(np.concatenate([np.linspace(start, end, 61)[3:-3] for start, end in spans]))
    return np.array([x, y]) + float(circle[6]) * placed.scale * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _number(value: float) -> str:
    return f"{round(value, 4):.8g}"


def ratio(scale: float) -> str:
    """Return a scale as text: 1 : 5."""
    return f"{scale:g} : 1" if scale >= 1 else f"1 : {1 / scale:g}"


def _fields(facts: PartFacts, scale: float) -> list[tuple[str, str, float, float, float]]:
    """Return the fields of the title block, in rows of 10 mm."""
    get = facts.fields.get
    return [
        ("Part", facts.name, 0.0, 0.0, 90.0),
        ("Assembly", get("Assembly", ""), 90.0, 0.0, 60.0),
        ("Sheet", get("Sheet", ""), 150.0, 0.0, 30.0),
        ("Material", get("Material", "-"), 0.0, 10.0, 60.0),
        ("Overall size, mm", get("Overall", ""), 60.0, 10.0, 60.0),
        ("Item", get("Item", ""), 120.0, 10.0, 20.0),
        ("Quantity", get("Quantity", ""), 140.0, 10.0, 40.0),
        ("Mass of one", get("Mass", "-"), 0.0, 20.0, 40.0),
        ("Lengths in mm. Tolerances", get("Tolerances", "as noted"), 40.0, 20.0, 60.0),
        ("Scale", ratio(scale), 100.0, 20.0, 40.0),
        ("Projection", "", 140.0, 20.0, 40.0),
    ]
