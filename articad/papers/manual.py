"""The assembly manual: a cover with all items, and a page for each step, exploded along its path.

What is in place is grey, what is new is orange. New parts stand where their path begins: on a line that is free of collisions,
which the order of assembly has computed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.disassembly.opened import step_poses
from articad.disassembly.steps import ENDED, AssemblyOrder, AssemblyStep, shown_path, words_of
from articad.geometry.mesh import TriMesh
from articad.kernels.views import Segment
from articad.papers.callouts import balloons, spots_of
from articad.papers.items import Item
from articad.papers.sheet import ROW, SMALL, DrawingSheet, Lettering, SheetLine, SheetPicture, fitted, text_width
from articad.render.camera import Camera
from articad.render.pictures import printed
from articad.render.raycast import BACKGROUND, cast
from articad.render.scene import DrawnMesh, DrawnScene, scene_of
from articad.render.studio import framed

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["DOTS", "PAGE", "manual_of"]

PAGE: Final = (210.0, 297.0)  # A4, upright
NEW, PLACED = "#f07d1a", "#c3c9cf"
_MARGIN: Final = 14.0
_TOP: Final = PAGE[1] - 46.0  # upper end of the picture of a step
DOTS: Final = 6.0  # pixels per mm: 150 per inch
_VIEWS: Final = {
    "iso": "front right, above", "iso_left": "front left, above", "iso_back": "back right, above", "iso_back_left": "back left, above",
    "iso_below": "front right, below", "iso_below_left": "front left, below",
}  # fmt: skip
_PROBE: Final = 110  # pixels of the pictures that serve to choose a view
_BETTER: Final = 1.3  # a view that is as much better than that of the assembly's page before replaces it
_FASTENED: Final = {
    "snap": "snaps in", "press": "is pressed in", "circlip": "is held by a circlip", "screw": "is screwed on", "adhesive": "is glued",
    "purchased": "is bought as one piece",
}  # fmt: skip
_MOVES: Final = {
    "fixed": "stays fixed to", "revolute": "turns on", "slider": "slides along", "cylindrical": "slides and turns in", "ball": "swivels in",
    "screw": "turns on the thread of", "planar": "moves on the plane of", "universal": "tilts on",
}  # fmt: skip
_MOST_JOINTS, _MOST_ROWS = 5, 9  # of a step that are printed
_MOST_ARROWS: Final = 4
_SMALL: Final = 16.0  # mm of paper: smaller parts are shown once more in a close-up
_INSET: Final = 52.0  # its sides
_NEAR: Final = 0.9  # of their size: how far they are from their place there
_COVERED: Final = 0.35  # of the close-up: more of the main picture is never hidden
_COLUMNS: Final = 4  # of the pictures of items
_CELL: Final = (45.0, 47.0)


def manual_of(assembly: Assembly, order: AssemblyOrder, items: Sequence[Item], *, dots: float = DOTS) -> Iterator[DrawingSheet]:
    """Yield the pages of a manual.

    Args:
        assembly: The product.
        order: Its order of assembly.
        items: Its items, for the numbers.
        dots: Pixels per mm of paper.
    """
    product = assembly.product()
    manual = _Manual(product, order, items, dots)
    yield from manual.covers()
    for step in order.steps:
        yield manual.page(step)


@dataclass
class _Manual:
    """Draws the pages; keeps the view from page to page."""

    product: Assembly
    order: AssemblyOrder
    items: Sequence[Item]
    dots: float

    def __post_init__(self) -> None:
        self.number = {part: item.number for item in self.items for part in item.parts}
        self.item = {item.number: item for item in self.items}
        self.joints = {joint.name: joint for joint in self.product.joints}
        self.view = "iso"  # of the present page
        self.views: dict[str, str] = {}  # of the last page of each assembly

    # ------------------------------------------------------------------ the cover, and the pictures of items

    def covers(self) -> Iterator[DrawingSheet]:
        """Yield the cover, and pages with a picture of each item."""
        sheet = self._sheet("cover", self.product.name, "Assembly manual")
        scene = self._scene(self.product.parts, self.product.at(), new=())
        camera = framed(scene, Camera.fit("iso", scene.bounds, width=round(182 * self.dots), height=round(150 * self.dots)))
        sheet.pictures.append(SheetPicture(_MARGIN, 92.0, 182.0, 150.0, printed(replace(scene, items=_own(scene, self.product)), camera)))
        parts = sum(item.quantity for item in self.items)
        facts = [f"{parts} parts, {len(self.items)} items, {len(self.order.steps)} steps."]
        permitted = [step for step in self.order.steps if step.strength == "permitted"]
        proven = sum(bool(step.moves) and step.strength == "proven" for step in self.order.steps)
        starts = sum(not step.moves and not step.onto for step in self.order.steps)
        facts.append(f"The paths of {proven} steps are proven free of collisions all along; {starts} steps lay down a first part.")
        if permitted:
            listed = ", ".join(str(step.number) for step in permitted)
            facts.append(f"Not proven, because parts are joined by force or by a thread, or bought as one: step {listed}.")
        facts += [
            f"No order was found that puts these together: {', '.join(blocked.parts)}. They are shown in place.{ENDED if blocked.ended else ''}"
            for blocked in self.order.blocked
        ]
        facts += [f"Not considered, without a valid solid: {', '.join(self.order.left_out)}."] if self.order.left_out else []
        facts.append(self.order.not_checked)
        y = 84.0
        for fact in facts:
            y = _paragraph(sheet, fact, y)
        sheet.told = {"page": "cover", "items": [item.number for item in self.items]}
        yield sheet
        per_page = _COLUMNS * int((PAGE[1] - 60.0) / _CELL[1])
        for first in range(0, len(self.items), per_page):
            sheet = self._sheet("items", "Parts", self.product.name)
            for place, item in enumerate(self.items[first : first + per_page]):
                self._item(sheet, item, _MARGIN + (place % _COLUMNS) * _CELL[0], PAGE[1] - 40.0 - (place // _COLUMNS + 1) * _CELL[1])
            sheet.told = {"page": "items", "items": [item.number for item in self.items[first : first + per_page]]}
            yield sheet

    def _item(self, sheet: DrawingSheet, item: Item, x: float, y: float) -> None:
        part = self.product.parts[item.name]
        if part.visuals or part.collisions:
            scene = self._scene({item.name: part}, {item.name: self.product.at()[item.name]}, new=())
            wide, high = _CELL[0] - 5.0, _CELL[1] - 14.0
            camera = framed(
                scene, Camera.fit("iso", scene.bounds, width=round(wide * self.dots), height=round(high * self.dots)), margin=1.06
            )
            sheet.pictures.append(SheetPicture(x + 2.5, y + 12.0, wide, high, printed(scene, camera)))
        size = f"{item.size} mm" if item.size else ""
        room = _CELL[0] - 11.0
        height = 2.5 if text_width(item.name, 2.5) <= room else 2.0
        sheet.texts += [
            Lettering(x + 2.5, y + 7.0, f"{item.number}", 3.5, bold=True),
            Lettering(x + 9.0, y + 7.2, fitted(item.name, room, height), height),
            Lettering(x + 2.5, y + 3.0, fitted(f"{size}{', bought' if item.supply == 'purchased' else ''}", _CELL[0] - 14.0, 2.0), 2.0),
            Lettering(x + _CELL[0] - 2.5, y + 2.8, f"{item.quantity} ×", 2.5, "end"),
        ]
        sheet.box("thin", x, y, x + _CELL[0], y + _CELL[1])

    # ------------------------------------------------------------------ a step

    def page(self, step: AssemblyStep) -> DrawingSheet:
        """Return the page of a step."""
        whole = "" if step.assembly == self.order.name else f"{step.assembly}, a sub-assembly"
        sheet = self._sheet(f"step_{step.number}", f"Step {step.number} of {len(self.order.steps)}", whole or self.product.name)
        y = _paragraph(sheet, words_of(step), PAGE[1] - 31.0, 3.5)
        if step.at:
            _paragraph(sheet, f"Before: {', '.join(self._value(*at) for at in step.at.items())}.", y, 3.0)
        lines = self._lines(step)
        rows = self._rows(step)
        bottom = 24.0 + ROW * (len(rows) + 2) + 4.0 * len(lines) + 8.0
        shown = self._picture(sheet, step, bottom)
        sheet.table(
            PAGE[0] - _MARGIN,
            22.0 + 4.0 * len(lines),
            "Moved in this step" if step.slides else "New in this step",
            ("item", "name", "qty", "material", "kg"),
            rows,
            (14.0, 74.0, 14.0, 50.0, 30.0),
        )
        for place, line in enumerate(reversed(lines)):
            sheet.texts.append(Lettering(_MARGIN, 18.0 + 4.0 * place, fitted(line, PAGE[0] - 2 * _MARGIN, SMALL)))
        sheet.told = {
            "page": "step",
            "step": step.number,
            "view": self.view,
            "callouts": sorted(shown),
            "items": [] if step.slides else [int(row[0]) for row in rows],
        }
        return sheet

    def _value(self, driver: str, value: float) -> str:
        unit = next(each.unit for each in self.product.mechanism.coordinates if each.name == driver)
        return f"move {driver} to {math.degrees(value):.4g}°" if unit == "rad" else f"move {driver} to {value:.4g} mm"

    def _lines(self, step: AssemblyStep) -> list[str]:
        """Return how the new parts are held, and what is known about the path."""
        lines = []
        for name in step.joints[:_MOST_JOINTS]:
            joint = self.joints[name]
            child, parent = (joint.child, joint.parent) if joint.child in step.parts else (joint.parent, joint.child)
            how = f", and {_FASTENED[step.fastened[name]]}" if name in step.fastened else ""
            lines.append(f"{child} {_MOVES.get(str(joint.type), 'is joined to')} {parent}{how}.")
        if len(step.joints) > _MOST_JOINTS:
            lines.append(f"{len(step.joints) - _MOST_JOINTS} further joints.")
        if step.permitted:
            pairs = "; ".join(f"{a} and {b}: {_FASTENED[how]}" for a, b, how in step.permitted)
            where = f" over the last {step.forced_mm:.4g} mm" if step.forced_mm else ""
            lines.append(f"Not proven{where}, joined by force or by a thread, or bought as one: {pairs}.")
        elif step.moves:
            far = ", then ".join(f"{move.length_mm:.4g} mm" for move in step.moves)
            lines.append(f"Path of {far}: proven free of collisions.")
        elif any(set(step.parts) == set(blocked.parts) for blocked in self.order.blocked):
            lines.append("No order was found that puts these parts together: they block each other.")
        return lines

    def _rows(self, step: AssemblyStep) -> list[tuple[str, ...]]:
        counted: dict[int, int] = {}
        for part in step.parts:
            counted[self.number[part]] = counted.get(self.number[part], 0) + 1
        rows: list[tuple[str, ...]] = []
        for number, count in counted.items():
            item = self.item[number]
            name = item.name if count == item.quantity else ", ".join(part for part in step.parts if self.number[part] == number)
            mass = "-" if item.mass_kg is None else f"{item.mass_kg * count:.4g}"
            rows.append((str(number), name, str(count), item.material or "-", mass))
        return (
            rows
            if len(rows) <= _MOST_ROWS
            else [*rows[: _MOST_ROWS - 1], (rows[_MOST_ROWS - 1][0], f"and {len(rows) - _MOST_ROWS} more", "", "", "")]
        )

    def _picture(self, sheet: DrawingSheet, step: AssemblyStep, bottom: float) -> set[int]:
        """Draw what is in place and what is new, with balloons and the path; return the numbers that are called out."""
        poses = self._poses(step)
        parts = {name: self.product.parts[name] for name in (*step.onto, *step.parts)}
        placed = self._scene(parts, poses, new=step.parts)
        path = shown_path(step, float(np.linalg.norm(np.ptp(placed.bounds, axis=0))))
        away = SE3.from_translation(path[0])
        moved = {name: away @ T if name in step.parts else T for name, T in poses.items()}
        scene = self._scene(parts, moved, new=step.parts)
        self.view = self.views[step.assembly] = _best_view(placed, scene, step, path, self.views.get(step.assembly, "iso"))
        left, right, top = _MARGIN + 12.0, PAGE[0] - _MARGIN - 12.0, _TOP
        width, height = round((right - left) * self.dots), round((top - bottom) * self.dots)
        also = np.concatenate([item.vertices for item in placed.items if len(item.mesh.vertices)])
        camera = framed(scene, Camera.fit(self.view, scene.bounds, width=width, height=height), margin=1.05, also=also)
        sheet.pictures.append(SheetPicture(left, bottom, right - left, top - bottom, printed(scene, camera)))
        middle = np.array([(left + right) / 2, (bottom + top) / 2])
        to_paper = 1.0 / (camera.mm_per_pixel * self.dots)
        sheet.scale = to_paper
        for place in self._places(step, poses, placed) if step.moves else ():
            _arrow(sheet, [middle + to_paper * np.array([p @ camera.right, p @ camera.up]) for p in place + path - camera.centre])
        wanted: dict[int, list[str]] = {}
        for part in step.parts:
            wanted.setdefault(self.number[part], []).append(part)
        spots = spots_of(scene, camera, wanted)
        self._close_up(sheet, step, poses, path, camera, (left, bottom, right, top))
        balloons(sheet, {number: middle + to_paper * spot for number, spot in spots.items()}, left - 6.0, right + 6.0, (bottom, top))
        hidden = [str(number) for number in wanted if number not in spots]
        seen = f"Seen from the {_VIEWS[self.view]}."
        sheet.texts.append(Lettering(_MARGIN, bottom - 5.0, f"{seen} Not visible: item {', '.join(hidden)}." if hidden else seen, 2.0))
        return set(spots)

    def _close_up(
        self,
        sheet: DrawingSheet,
        step: AssemblyStep,
        poses: Mapping[str, SE3],
        path: FloatArray,
        camera: Camera,
        area: tuple[float, float, float, float],
    ) -> None:
        """Draw new parts that are small on the page once more, larger, near their place, in an empty corner of the picture."""
        parts = {name: self.product.parts[name] for name in (*step.onto, *step.parts)}
        new = [item.vertices for item in self._scene({name: parts[name] for name in step.parts}, poses, new=()).items]
        if not step.moves or not any(len(each) for each in new):
            return
        points = np.concatenate([each for each in new if len(each)])
        size = float(np.linalg.norm(np.ptp(points, axis=0)))
        if size / camera.mm_per_pixel / self.dots > _SMALL:
            return
        way = path[-1] - path[-2]
        length = float(np.linalg.norm(way))
        away = -way * min(1.0, _NEAR * size / max(length, 1e-9))
        moved = SE3.from_translation(away)
        scene = self._scene(parts, {name: moved @ T if name in step.parts else T for name, T in poses.items()}, new=step.parts)
        both = np.concatenate([points, points + away])
        dots = round(_INSET * self.dots)
        near = framed(_points_only(both), Camera.fit(self.view, [both.min(axis=0), both.max(axis=0)], width=dots, height=dots), margin=1.25)
        if near.mm_per_pixel > camera.mm_per_pixel / 2:
            return
        left, bottom, right, top = area
        corners = [(x, y) for y in (bottom + 2.0, top - _INSET) for x in (left + 4.0, right - _INSET - 4.0)]
        drawn = cast(scene, camera).item != BACKGROUND

        def covered(corner: tuple[float, float]) -> float:
            column, row = round((corner[0] - left) * self.dots), round((top - corner[1] - _INSET) * self.dots)
            return float(drawn[max(row, 0) : row + dots, max(column, 0) : column + dots].mean())

        x, y = min(corners, key=covered)
        if covered((x, y)) > _COVERED:
            return
        sheet.pictures.append(SheetPicture(x, y, _INSET, _INSET, printed(scene, near)))
        sheet.box("visible", x, y, x + _INSET, y + _INSET)
        middle, to_paper = np.array([x + _INSET / 2, y + _INSET / 2]), 1.0 / (near.mm_per_pixel * self.dots)
        centre = (points.min(axis=0) + points.max(axis=0)) / 2 - near.centre
        _arrow(sheet, [middle + to_paper * np.array([p @ near.right, p @ near.up]) for p in (centre + away, centre)])

    def _places(self, step: AssemblyStep, poses: Mapping[str, SE3], placed: DrawnScene) -> list[FloatArray]:
        """Return points of the new parts to which arrows lead `(3,)`: where their joints are, or else their middle."""
        found: list[FloatArray] = []
        for joint in (self.joints[name] for name in step.joints):
            at = (poses[joint.parent] @ joint.T_parent_connector).translation
            if not any(float(np.linalg.norm(at - known)) < 1.0 for known in found):
                found.append(at)
        if not 0 < len(found) <= _MOST_ARROWS:
            new = np.concatenate([item.vertices for item in placed.items if item.name in step.parts])
            found = [(new.min(axis=0) + new.max(axis=0)) / 2]
        return found

    def _poses(self, step: AssemblyStep) -> Mapping[str, SE3]:
        return step_poses(self.product.mechanism, step, self.order.base)

    def _scene(self, parts: Mapping[str, object], poses: Mapping[str, SE3], *, new: Sequence[str]) -> DrawnScene:
        scene = scene_of({name: self.product.parts[name] for name in parts}, poses)
        items = tuple(replace(item, color=NEW if item.name in new else PLACED) for item in scene.items)
        size = float(np.linalg.norm(np.ptp(scene.bounds, axis=0)))
        return DrawnScene(items).simplified(5e-5 * size)

    def _sheet(self, key: str, title: str, aside: str) -> DrawingSheet:
        sheet = DrawingSheet(key, PAGE, 1.0)
        sheet.texts += [
            Lettering(_MARGIN, PAGE[1] - 21.0, title, 6.0, bold=True),
            Lettering(PAGE[0] - _MARGIN, PAGE[1] - 21.0, fitted(aside, 90.0, 3.0), 3.0, "end"),
        ]
        sheet.line("visible", _MARGIN, PAGE[1] - 24.5, PAGE[0] - _MARGIN, PAGE[1] - 24.5)
        return sheet


class _Score(NamedTuple):
    value: float
    view: str


def _best_view(placed: DrawnScene, apart: DrawnScene, step: AssemblyStep, path: FloatArray, before: str) -> str:
    """Return the view in which most of the new parts is seen, where they are and where they go, and in which their path is long."""
    bounds = np.array([np.minimum(placed.bounds[0], apart.bounds[0]), np.maximum(placed.bounds[1], apart.bounds[1])])
    new = np.array([item.name in step.parts for item in placed.items] + [False])
    scores = []
    for view in _VIEWS:
        camera = Camera.fit(view, bounds, width=_PROBE, height=_PROBE)
        alone = DrawnScene(tuple(item for item in apart.items if item.name in step.parts))
        whole = max(int((cast(alone, camera).item != BACKGROUND).sum()), 1)
        seen, there = (min(int(new[cast(scene, camera).item].sum()) / whole, 1.0) for scene in (apart, placed))
        way = path[-1] - path[0]
        far = float(np.linalg.norm(way))
        across = 1.0 if far == 0.0 else float(np.linalg.norm(np.cross(way / far, camera.eye)))
        scores.append(_Score(seen * (0.3 + there) * (0.2 + across) * (1.0 if "below" not in view else 0.8), view))
    best = max(scores, key=lambda score: score.value)
    now = next(score for score in scores if score.view == before)
    return before if best.value <= _BETTER * now.value else best.view


def _points_only(points: FloatArray) -> DrawnScene:
    """Return a scene of points, to frame a picture by them."""
    mesh = TriMesh(points, np.zeros((0, 3), dtype=np.int64))
    return DrawnScene((DrawnMesh("points", mesh, SE3.identity(), PLACED),))


def _own(scene: DrawnScene, assembly: Assembly) -> tuple[DrawnMesh, ...]:
    """Return the items of a scene in the colours of their parts."""
    colors = [shape.color or part.color for part in assembly.parts.values() for shape in part.visuals or part.collisions]
    return tuple(replace(item, color=color) for item, color in zip(scene.items, colors, strict=True))


def _arrow(sheet: DrawingSheet, points: Sequence[FloatArray]) -> None:
    """Draw a path on the paper, dashed, with an arrow at its end."""
    for a, b in pairwise(points):
        sheet.strokes.append(SheetLine("hidden", Segment(float(a[0]), float(a[1]), float(b[0]), float(b[1]))))
    way = points[-1] - points[-2]
    length = float(np.linalg.norm(way))
    if length > 1.0:
        unit = way / length
        aside = np.array([-unit[1], unit[0]])
        sheet.arrows.append((points[-1], points[-1] - 4.5 * unit + 1.5 * aside, points[-1] - 4.5 * unit - 1.5 * aside))


def _paragraph(sheet: DrawingSheet, words: str, y: float, height: float = 3.0) -> float:
    """Write a text in lines below each other; return the place of the next line."""
    line = ""
    for word in [*words.split(), ""]:
        longer = f"{line} {word}".strip()
        if word and text_width(longer, height) <= PAGE[0] - 2 * _MARGIN:
            line = longer
            continue
        sheet.texts.append(Lettering(_MARGIN, y, line, height))
        y -= 1.7 * height
        line = word
    return y - 0.3 * height
