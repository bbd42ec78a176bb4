"""Add drawings and an exploded view to a document: `drawings.json` in, `assembly.FCStd` changed, `drawn.json` out, in the working folder.

Runs inside FreeCAD 1.0 or later and never imports articad. FreeCAD projects views in threads of their own and waits for Qt to say that they are
finished, so this program must be allowed threads, and it runs Qt's events itself.
"""

from __future__ import annotations

import builtins
import json
import math
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import FreeCAD as App
import Part
from PySide import QtCore
from sizes import SAME, named_sizes  # type: ignore[import-not-found]

Json = dict[str, Any]

vars(builtins)["QtCore"] = QtCore  # without a window, the module of exploded views does not import it, but needs it

_PATIENCE = 120.0  # seconds for a page
_ROW, _COLUMN, _FIRST = 7.0, 9.0, 9.0  # mm between dimensions, and to the first
_CIRCLES = {"top": (0, 0, 1), "front": (0, 1, 0), "left": (1, 0, 0)}  # view -> axis of the circles that it shows as such
_COARSE = 0.5  # mm
_MOST = 12  # dimensions of a page
_ASIDE = 0.01  # mm beside an edge, where a ray towards the eye starts
_WIDTHS = (45, 130, 60, 110, 80)  # pixels of the columns of a parts list
_CIRCLE = "Part::GeomCircle"


def main() -> None:
    """Read the job, draw, save, report."""
    job = json.loads(Path("drawings.json").read_text())
    application = QtCore.QCoreApplication.instance() or QtCore.QCoreApplication([])
    document = App.openDocument(str(Path("assembly.FCStd").resolve()))
    drawing = _Drawing(document, job, application)
    report = drawing.write()
    document.save()
    Path("drawn.json").write_text(json.dumps(report))


class _Drawing:
    def __init__(self, document: Any, job: Json, application: Any) -> None:
        self.document, self.job, self.application = document, job, application
        self.parts = {item.ArticadPart: item for item in document.Objects if "ArticadPart" in item.PropertiesList}
        (self.assembly,) = [item for item in document.Objects if item.TypeId == "Assembly::AssemblyObject"]
        self.group = document.addObject("App::DocumentObjectGroup", "Drawings")
        self.providers: dict[str, str] = {}  # object -> class of its view provider
        self.hidden: list[str] = []

    def write(self) -> Json:
        self._exploded()
        self._assembly_page()
        for page in self.job["parts"]:
            self._part_page(page)
        self.document.recompute()
        for item in self.document.Objects:
            item.purgeTouched()
        return {"providers": self.providers, "hidden": self.hidden}

    # ------------------------------------------------------------------ pages

    def _page(self, label: str, svg: str) -> Any:
        number = len([item for item in self.document.Objects if item.TypeId == "TechDraw::DrawPage"])
        file = Path(f"page{number}.svg").resolve()
        file.write_text(svg)
        page = self.document.addObject("TechDraw::DrawPage", f"Page{number or ''}")
        template = self.document.addObject("TechDraw::DrawSVGTemplate", f"Sheet{number or ''}")
        template.Template = str(file)
        page.Template = template
        page.Label, template.Label = label, f"Sheet of {label}"
        self.group.addObject(page)
        return page

    def _view(self, page: Any, name: str, source: Any, form: Json) -> Any:
        view = self.document.addObject("TechDraw::DrawViewPart", name)
        page.addView(view)
        view.Source = [source]
        view.Direction, view.XDirection = App.Vector(*form["direction"]), App.Vector(*form["right"])
        view.ScaleType = "Custom"
        view.Scale = form["scale"]
        view.X, view.Y = form["x"], form["y"]
        return view

    def _settle(self, *views: Any) -> None:
        """Recompute, and wait until FreeCAD has projected the views."""
        self.document.recompute()
        end = time.monotonic() + _PATIENCE
        while time.monotonic() < end and not all(view.getVisibleEdges() for view in views):
            self.application.processEvents()
            time.sleep(0.01)

    def _assembly_page(self) -> None:
        form = self.job["assembly"]
        page = self._page(form["label"], form["template"])
        view = self._view(page, "AssemblyView", self.assembly, form["view"])
        self._settle(view)
        bills = [item for item in self.document.Objects if item.TypeId == "Assembly::BomObject"]
        rows: dict[str, str] = {}
        for bill in bills[:1]:
            cells = bill.getUsedCells()
            last = max(int(cell[1:]) for cell in cells)
            rows = {str(bill.get(f"B{row}")): str(bill.get(f"A{row}")) for row in range(2, last + 1) if f"B{row}" in cells}
            sheet = self.document.addObject("TechDraw::DrawViewSpreadsheet", "PartsList")
            sheet.Source, sheet.CellStart, sheet.CellEnd = bill, "A1", f"E{last}"
            for column, width in zip("ABCDE", _WIDTHS, strict=True):
                bill.setColumnWidth(column, width)
            page.addView(sheet)
            sheet.X, sheet.Y = form["list"]["x"], form["list"]["y"]
        placed, middle = [], self._middle(form["view"])
        for name, point in form["balloons"].items():
            if self.parts[name].Label in rows:
                at = _projected(App.Vector(*point), form["view"]) - middle
                placed.append((math.atan2(at.y, at.x), name, at))
        for place, (_, name, at) in enumerate(sorted(placed, key=lambda row: row[:2])):
            balloon = self.document.addObject("TechDraw::DrawViewBalloon", f"Balloon{place}")
            balloon.SourceView = view
            balloon.Text = rows[self.parts[name].Label]
            balloon.OriginX, balloon.OriginY = at.x, at.y
            turn = -math.pi + 2 * math.pi * (place + 0.5) / len(placed)
            across, up = (radius / form["view"]["scale"] for radius in form["radius"])  # FreeCAD scales these places too
            balloon.X, balloon.Y = across * math.cos(turn), up * math.sin(turn)
            page.addView(balloon)
        self._settle(view)

    def _middle(self, view: Json) -> Any:
        """Return the middle of all parts in the frame of a view: FreeCAD puts it at the view's place."""
        ends = []
        for part in self.parts.values():
            shape = Part.getShape(part)
            points = [] if shape.isNull() else shape.tessellate(_COARSE)[0]
            ends += [_projected(point, view) for point in points]
        low, high = (App.Vector(*(end(point[axis] for point in ends) for axis in range(3))) for end in (min, max))
        return (low + high) * 0.5

    def _part_page(self, form: Json) -> None:
        page = self._page(form["label"], form["template"])
        source = self._alone(form["part"])
        views = {row["name"]: self._view(page, f"{row['name']}_{form['part']}", source, row) for row in form["views"]}
        self._settle(*views.values())
        if form["note"]:
            note = self.document.addObject("TechDraw::DrawViewAnnotation", f"Note_{form['part']}")
            note.Text = form["note"]
            note.TextSize = 3.0
            page.addView(note)
            note.X, note.Y = form["note_at"]
        scale = form["views"][0]["scale"]
        half = {row["name"]: self._half(row, form["size"], scale) for row in form["views"] if "up" in row}
        used: dict[tuple[str, str], int] = {}
        shape, ups = source.Shape, {row["name"]: App.Vector(*row["up"]) for row in form["views"] if "up" in row}
        for name, kind, elements, value, text in sorted(self._dimensions(form, shape), key=lambda row: _order(shape, row, ups)):
            if len(elements) == 1 and not _visible(shape, elements[0], views[name].Direction):
                views[name].HardHidden = True  # an edge that is measured is drawn: dashed if it is behind others
            item = self.document.addObject("TechDraw::DrawViewDimension", f"Dimension_{form['part']}")
            item.Type = kind
            item.MeasureType = "Projected" if kind.startswith("Distance") else "True"
            item.References2D = [(views[name], ("",))]
            item.References3D = [(source, element) for element in elements]
            sign = {"Radius": "R", "Diameter": "\u2300"}.get(kind, "")
            item.FormatSpec = f"{sign}%.2w {text}".strip() if sign else f"{text} %.2w".strip()
            half_label = 0.5 * form["letter"] * len(f"{sign}{value:.2f} {text}")
            page.addView(item)
            side = "circle" if not kind.startswith("Distance") else "up" if kind == "DistanceY" else "across"
            place = used[name, side] = used.get((name, side), -1) + 1
            across, up = half[name]
            item.X, item.Y = {
                "across": (0.0, -up - _FIRST - _ROW * place),
                "up": (-across - _FIRST - _COLUMN * place, 0.0),
                "circle": (across + _FIRST + half_label, up - 4.0 - _COLUMN * place),
            }[side]
            item.addProperty("App::PropertyFloat", "ArticadValue", "articad", "Its value when articad wrote the document")
            item.ArticadValue = value
        self._settle(*views.values())

    def _half(self, view: Json, size: list[float], scale: float) -> tuple[float, float]:
        """Return half of the size of a view on the page [mm]."""
        right, up = ([abs(number) for number in view[key]] for key in ("right", "up"))
        return tuple(0.5 * scale * sum(a * b for a, b in zip(axis, size, strict=True)) for axis in (right, up))

    def _alone(self, part: str) -> Any:
        """Return a hidden link that shows a part's shape in the part's own frame, wherever the part is in the assembly."""
        container = self.parts[part]
        (shape,) = [item for item in container.Group if item.TypeId in ("PartDesign::Body", "Part::Feature", "Part::Mirroring")]
        link = self.document.addObject("App::Link", f"Drawn_{part}")
        link.LinkedObject = shape
        link.setExpression("Placement", f"{shape.Name}.Placement")  # with LinkTransform, FreeCAD 1.1 measures in the frame turned twice
        link.Label = f"{part} drawn"
        self.group.addObject(link)
        self.hidden.append(link.Name)
        self.document.recompute()
        return link

    # ------------------------------------------------------------------ dimensions

    def _dimensions(self, form: Json, shape: Any) -> Iterator[tuple[str, str, list[str], float, str]]:
        """Yield the dimensions of a page: the view, FreeCAD's kind, elements of the shape, the value and the name in the plan.

        An overall size has a dimension where vertices are that far apart.
        """
        box = shape.optimalBoundingBox(False)
        low, high = (box.XMin, box.YMin, box.ZMin), (box.XMax, box.YMax, box.ZMax)
        overall = [
            (view, kind, _ends(shape, axis, low[axis], high[axis]), high[axis] - low[axis])
            for axis, view, kind in ((0, "front", "DistanceX"), (2, "front", "DistanceY"), (1, "top", "DistanceY"))
        ]
        eyes = {row["name"]: App.Vector(*row["direction"]) for row in form["views"]}
        circles, edges = list(_circles(shape)), list(_straight(shape))
        yield from named_sizes(
            form["dimensions"], overall, circles, edges, _MOST, shown=lambda view, circle: _visible(shape, circle, eyes[view])
        )

    # ------------------------------------------------------------------ the exploded view

    def _exploded(self) -> None:
        """Add FreeCAD's exploded view, with one move for each joint of the tree."""
        from CommandCreateView import ExplodedView, ExplodedViewStep  # noqa: PLC0415 - needs the name that main gives it

        if not self.job["moves"]:
            return
        group = self.assembly.newObject("Assembly::ViewGroup", "Exploded Views")
        view = group.newObject("App::FeaturePython", "Exploded View")
        ExplodedView(view)
        view.Label = "Exploded view"
        moves = []
        for row in self.job["moves"]:
            move = self.assembly.newObject("App::FeaturePython", "Move")
            ExplodedViewStep(move)
            move.Label = f"Move {row['part']}"
            move.MovementTransform = App.Placement(App.Vector(*row["by"]), App.Rotation())
            paths = [f"{self.parts[name].Name}." for name in row["parts"]]
            move.References = [self.assembly, paths]
            moves.append(move)
            self.providers[move.Name] = "ViewProviderExplodedViewStep"
        if "Moves" in view.PropertiesList:
            view.Moves = moves
        else:  # FreeCAD 1.1
            view.Group = moves
        self.providers[view.Name] = "ViewProviderExplodedView"


def _projected(point: Any, view: Json) -> Any:
    """Return a point in the frame of a view: right, up, and towards the eye, not scaled."""
    out, right = App.Vector(*view["direction"]).normalize(), App.Vector(*view["right"]).normalize()
    return App.Vector(point * right, point * out.cross(right), 0.0)


def _ends(shape: Any, axis: int, low: float, high: float) -> tuple[str, str] | None:
    """Return vertices at both ends of a shape along an axis, those nearest to a corner of its box; None if an end has no vertex."""
    found = []
    for end in (low, high):
        at = [(number, vertex.Point) for number, vertex in enumerate(shape.Vertexes, start=1) if abs(vertex.Point[axis] - end) < SAME]
        if not at:
            return None
        found.append(min(at, key=lambda row: (round(sum(row[1]) - row[1][axis], 6), row[0]))[0])
    return f"Vertex{found[0]}", f"Vertex{found[1]}"


def _order(shape: Any, row: tuple[str, str, list[str], float, str], ups: dict[str, Any]) -> float:
    """Return what dimensions are sorted by: circles from top to bottom, so that their leaders do not cross; lengths, the shortest inside."""
    view, kind, elements, value, _ = row
    if kind.startswith("Distance"):
        return value
    return -float(shape.getElement(elements[0]).Curve.Center * ups[view])


def _visible(shape: Any, element: str, eye: Any) -> bool:
    """Return whether a view shows an edge: at most points along it, a ray towards the eye that starts just beside it meets nothing."""
    edge, away = shape.getElement(element), App.Vector(eye).normalize()
    right = away.cross(App.Vector(0, 0, 1) if abs(away.z) < 0.5 else App.Vector(1, 0, 0)).normalize()
    up, far = away.cross(right), shape.BoundBox.DiagonalLength
    sides = [right * math.cos(turn * math.pi / 4) + up * math.sin(turn * math.pi / 4) for turn in range(8)]
    low, high = edge.ParameterRange
    seen = 0
    for part in (0.2, 0.5, 0.8):
        point = edge.valueAt(low + part * (high - low))
        starts = (point + (side + away) * _ASIDE for side in sides)
        seen += any(shape.distToShape(Part.makeLine(start, start + away * far))[0] > 0.01 * _ASIDE for start in starts)
    return seen >= 2


def _circles(shape: Any) -> Iterator[tuple[str, str, float]]:
    """Yield the circles that a view shows as such: the view, the edge and the radius."""
    for number, edge in enumerate(shape.Edges, start=1):
        if edge.Curve.TypeId != _CIRCLE:
            continue
        for view, axis in _CIRCLES.items():
            if abs(abs(edge.Curve.Axis * App.Vector(*axis)) - 1.0) < SAME:
                yield view, f"Edge{number}", edge.Curve.Radius


def _straight(shape: Any) -> Iterator[tuple[str, str, str, float]]:
    """Yield the straight edges along an axis: the view, FreeCAD's kind of distance, the edge and its length."""
    shown = {0: ("front", "DistanceX"), 1: ("top", "DistanceY"), 2: ("front", "DistanceY")}
    for number, edge in enumerate(shape.Edges, start=1):
        if edge.Curve.TypeId != "Part::GeomLine" or len(edge.Vertexes) != 2:
            continue
        along = edge.Vertexes[1].Point - edge.Vertexes[0].Point
        for axis, (view, kind) in shown.items():
            if abs(abs(along[axis]) - edge.Length) < SAME:
                yield view, kind, f"Edge{number}", edge.Length


main()
