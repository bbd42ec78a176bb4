"""A check of what a plane cuts: slots, keyways, grooves, ribs and compartments, which no box, hole or volume shows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion, label
from scipy.spatial import KDTree

from articad.arrays import FloatArray
from articad.geometry import TriMesh
from articad_bench.bodies import moved_bodies
from articad_bench.check import Bounds, Check, in_words, within
from articad_bench.shape_checks import placed, standing
from articad_bench.solids import filled_cells
from articad_bench.subject import Subject
from articad_bench.wanted import JointWanted

CELLS: Final = 1000  # along the longer side of the picture of a section
FEWEST: Final = 4  # cells: less is the roughness of meshes
TOLD: Final = 8  # pieces or openings, in words

Side = float | Bounds | None
Sides = tuple[Side, Side]
Cells = NDArray[np.bool_]


class Section(Check):
    """What a plane square to an axis cuts of the whole at rest: so many pieces, so far apart, with so many openings that matter encloses.

    Parts that touch are one piece. Lengths are known to a thousandth of the longer side of the whole across the axis.

    Attributes:
        axis: That the plane is square to, in the frame of the whole.
        at: Where it lies, from the lower end of what is cut, or from its upper end if negative [mm].
        joint: Cuts the bodies alone that such joints move.
        still: Cuts what does not move alone.
        pieces: How many pieces of matter there are.
        openings: How many openings there are with matter all round.
        apart: The distance of each piece from the nearest other one [mm].
        piece: Sides of the box of each piece, in any order: a length, its bounds, or None where any is accepted.
        clear: The same, of each opening.
        area: Of all that is cut [mm²].
    """

    kind: Literal["section"] = "section"
    axis: Literal["x", "y", "z"]
    at: float
    joint: JointWanted | None = None
    still: bool = False
    pieces: Bounds | None = None
    openings: Bounds | None = None
    apart: Bounds | None = None
    piece: Sides | None = None
    clear: Sides | None = None
    area: Bounds | None = None
    tolerance: float = 0.02

    @property
    def wanted(self) -> str:
        told = [f"{in_words(self.pieces)} pieces" if self.pieces else "", f"{in_words(self.apart)} mm apart" if self.apart else ""]
        told += [f"each {_by(self.piece)} mm" if self.piece else "", f"{in_words(self.openings)} openings" if self.openings else ""]
        told += [f"each {_by(self.clear)} mm" if self.clear else ""]
        told += [f"{in_words(self.area)} mm²" if self.area else ""]
        of = f" of what is moved by {self.joint}" if self.joint else " of what does not move" if self.still else ""
        place = f"{abs(self.at):g} mm from its {'lower' if self.at >= 0 else 'upper'} end"
        return f"{', '.join(each for each in told if each)} in the section{of} square to {self.axis}, {place}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        meshes = self._meshes(subject)
        if not meshes:
            return False, "nothing is cut"
        cut = _cut(meshes, "xyz".index(self.axis), self.at)
        pieces, openings = cut.pieces(), cut.openings()
        apart = [] if self.apart is None else cut.distances(pieces)
        ok = all(row is None or row[0] <= len(found) <= row[1] for row, found in ((self.pieces, pieces), (self.openings, openings)))
        ok &= self.apart is None or (bool(apart) and all(within(mm, self.apart) for mm in apart))
        for sides, found in ((self.piece, pieces), (self.clear, openings)):
            ok &= sides is None or (bool(found) and all(self._fits(cut.sides(each), sides, cut.pitch) for each in found))
        ok &= self.area is None or within(cut.area, self.area)
        told = [
            f"{cut.area:.4g} mm² in {len(pieces)} pieces ({_listed(cut, pieces)})",
            f"{len(openings)} openings ({_listed(cut, openings)})",
        ]
        return ok, ", ".join([*told, *([f"{', '.join(f'{mm:.4g}' for mm in apart[:TOLD])} mm apart"] if apart else [])])

    def _meshes(self, subject: Subject) -> list[TriMesh]:
        """Return the meshes that are cut."""
        if self.joint is None:
            return standing(subject) if self.still else placed(subject)
        moved = {body for joint in self.joint.found(subject) for body in moved_bodies(subject, joint)}
        return [mesh for name, mesh in zip(subject.shaped, placed(subject), strict=True) if subject.rigid[name] in moved]

    def _fits(self, found: tuple[float, float], wanted: Sides, pitch: float) -> bool:
        """Return whether sides are those that are wanted, in one order or the other; a cell more or less is no difference."""
        bounds = [self.bounds(side) for side in wanted]
        return any(
            all(low - pitch <= mm <= high + pitch for mm, (low, high) in zip(way, bounds, strict=True)) for way in (found, found[::-1])
        )

    def bounds(self, side: Side) -> Bounds:
        """Return the bounds of a side [mm]."""
        if side is None:
            return 0.0, float("inf")
        return side if isinstance(side, tuple) else ((1 - self.tolerance) * side, (1 + self.tolerance) * side)


@dataclass(frozen=True, eq=False)
class _Cut:
    """A section as a picture.

    Attributes:
        matter: Whether the middle of each cell lies in matter, with a free margin `(n, m)`.
        pitch: Side of a cell [mm].
    """

    matter: Cells
    pitch: float

    @property
    def area(self) -> float:
        """Area of all matter [mm²]."""
        return float(self.matter.sum()) * self.pitch**2

    def pieces(self) -> list[Cells]:
        """Return each piece of matter."""
        return list(_regions(self.matter))

    def openings(self) -> list[Cells]:
        """Return each opening that matter encloses."""
        outside = label(~self.matter)[0]
        return list(_regions(~self.matter & (outside != outside[0, 0])))

    def sides(self, region: Cells) -> tuple[float, float]:
        """Return the sides of a region's box [mm]."""
        a, b = (int(np.ptp(np.flatnonzero(region.any(axis=axis)))) + 1 for axis in (1, 0))
        return a * self.pitch, b * self.pitch

    def distances(self, regions: Sequence[Cells]) -> list[float]:
        """Return how far each region lies from the nearest other one [mm]."""
        edges = [np.argwhere(region & ~binary_erosion(region)) for region in regions]
        found = []
        for own, points in enumerate(edges):
            others = [each for other, each in enumerate(edges) if other != own]
            if others:
                found.append((float(KDTree(np.concatenate(others)).query(points)[0].min()) - 1) * self.pitch)
        return found


def _cut(meshes: Sequence[TriMesh], axis: int, at: float) -> _Cut:
    """Return the section of meshes square to an axis, at a distance from their lower end, or from their upper one if negative [mm]."""
    order = [(axis + 1) % 3, axis, (axis + 2) % 3]
    turned = [TriMesh(mesh.vertices[:, order], mesh.triangles) for mesh in meshes]
    low = np.min([mesh.bounds[0] for mesh in turned], axis=0)
    high = np.max([mesh.bounds[1] for mesh in turned], axis=0)
    sides = high - low
    pitch = float(max(sides[0], sides[2])) / CELLS
    cells = (int(np.ceil(sides[0] / pitch)) + 2, 1, int(np.ceil(sides[2] / pitch)) + 2)
    level = float(low[1] if at >= 0 else high[1]) + at
    middle: FloatArray = np.array([low[0] - pitch, level - pitch / 2, low[2] - pitch])
    matter = np.any([filled_cells(mesh, middle, np.full(3, pitch), cells) for mesh in turned], axis=0)
    return _Cut(np.pad(matter[:, 0, :], 1), pitch)


def _regions(cells: Cells) -> Iterator[Cells]:
    """Yield the connected regions of cells, without crumbs."""
    marks, count = label(cells)
    for mark in range(1, count + 1):
        region = marks == mark
        if region.sum() >= FEWEST:
            yield region


def _listed(cut: _Cut, regions: Sequence[Cells]) -> str:
    return ", ".join(_by(cut.sides(region)) for region in regions[:TOLD]) or "none"


def _by(sides: Sequence[Any]) -> str:
    return " x ".join("any" if side is None else in_words(side) if isinstance(side, tuple) else f"{side:.4g}" for side in sides)
