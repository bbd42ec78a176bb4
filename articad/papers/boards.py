"""The cut list: parts that are boards, and how they lie on standard sheets."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from articad.aliases import Json
from articad.geometry.faces import faces_of
from articad.papers.items import Item

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["Board", "Cut", "Sheet", "boards_of", "cut_list_json", "nested"]

_THICK_MM: Final = 60.0  # a board is at most this thick,
_SHARE: Final = 0.25  # and at most this share of its width
_LONG_MM: Final = 60.0  # and at least this long: smaller washers, clips and links are punched or turned
_FLAT: Final = 0.5  # share of length × width that each of its two faces covers
_SAME_MM: Final = 1e-3  # differences of places that are rounding


@dataclass(frozen=True)
class Board:
    """A part that is cut from a sheet: its blank.

    Attributes:
        item: Its item.
        length_mm: The longer side: along the grain.
        width_mm: The shorter side.
        thickness_mm: Of the sheet.
    """

    item: Item
    length_mm: float
    width_mm: float
    thickness_mm: float


class Cut(NamedTuple):
    """Place of a blank on a sheet: its lower left corner from that of the sheet, and its extent as it lies [mm]."""

    board: Board
    x: float
    y: float
    along: float
    across: float


@dataclass(frozen=True)
class Sheet:
    """One sheet of a material and a thickness, with the blanks on it.

    Attributes:
        material: Its material.
        thickness_mm: Its thickness.
        size_mm: Length along the grain, and width.
        cuts: The blanks.
    """

    material: str | None
    thickness_mm: float
    size_mm: tuple[float, float]
    cuts: tuple[Cut, ...]

    @property
    def used(self) -> float:
        """Share of its area that the blanks cover."""
        return sum(cut.along * cut.across for cut in self.cuts) / (self.size_mm[0] * self.size_mm[1])


def boards_of(assembly: Assembly, items: Sequence[Item]) -> tuple[Board, ...]:
    """Return the items that are boards: made, thin, and with two plane faces opposite each other that cover most of their box.

    The box is that of the part's own frame. Its longest side counts as the direction of the grain: a plan states none.
    """
    found = []
    for item in items:
        part = assembly.parts[item.name]
        if part.mesh is None or item.size_mm is None or item.supply == "purchased":
            continue
        flat, size = int(np.argmin(item.size_mm)), sorted(item.size_mm)
        if size[0] > min(_THICK_MM, _SHARE * size[1]) or size[2] < _LONG_MM:
            continue
        low, high = part.mesh.bounds
        areas = [0.0, 0.0]
        for face in faces_of(part.mesh):
            if face.kind == "plane" and abs(abs(face.axis[flat]) - 1.0) < _SAME_MM:
                for end, at in enumerate((low[flat], high[flat])):
                    if abs(face.point[flat] - at) < _SAME_MM:
                        areas[end] += 0.5 * float(np.linalg.norm(face.normals_of_twice_area, axis=1).sum())
        if min(areas) >= _FLAT * size[1] * size[2]:
            found.append(Board(item, size[2], size[1], size[0]))
    return tuple(found)


def nested(
    boards: Sequence[Board], size_mm: tuple[float, float], *, kerf_mm: float, turn: bool = False
) -> tuple[tuple[Sheet, ...], tuple[Board, ...]]:
    """Place the blanks of all parts on sheets, one kerf apart, so that straight cuts from edge to edge separate them.

    Args:
        boards: What to cut.
        size_mm: Length along the grain and width of every sheet.
        kerf_mm: Width of a cut.
        turn: Whether blanks may be turned, so that their grain runs across.

    Returns:
        The sheets, and the boards that are larger than a sheet.
    """
    stocks: defaultdict[tuple[str, float], list[Board]] = defaultdict(list)
    large = []
    for board in boards:
        lies = [(board.length_mm, board.width_mm)] + ([(board.width_mm, board.length_mm)] if turn else [])
        if any(along <= size_mm[0] and across <= size_mm[1] for along, across in lies):
            stocks[board.item.material or "", round(board.thickness_mm, 3)].append(board)
        else:
            large.append(board)
    sheets = []
    for (material, thickness), kind in sorted(stocks.items(), key=lambda entry: entry[0]):
        open_ones: list[_Open] = []
        for board in sorted(kind, key=lambda one: (-one.length_mm * one.width_mm, one.item.name)):
            for _ in range(board.item.quantity):
                if not any(sheet.takes(board, kerf_mm, turn=turn) for sheet in open_ones):
                    open_ones.append(_Open.new(size_mm, kerf_mm))
                    open_ones[-1].takes(board, kerf_mm, turn=turn)
        sheets += [
            Sheet(material or None, thickness, size_mm, tuple(sorted(sheet.cuts, key=lambda cut: (cut.x, cut.y)))) for sheet in open_ones
        ]
    return tuple(sheets), tuple(large)


class _Free(NamedTuple):
    """A rectangle of a sheet that is still free, with a kerf at its right and upper edge [mm]."""

    x: float
    y: float
    along: float
    across: float


@dataclass
class _Open:
    """A sheet that is being filled.

    Each blank goes into the corner of the free rectangle that it fits most closely by its shorter rest, and a straight cut divides what remains
    (guillotine algorithm, best short side fit, shorter axis split: J. Jylänki, A Thousand Ways to Pack the Bin, 2010).
    """

    free: list[_Free]
    cuts: list[Cut]

    @classmethod
    def new(cls, size_mm: tuple[float, float], kerf_mm: float) -> _Open:
        return cls([_Free(0.0, 0.0, size_mm[0] + kerf_mm, size_mm[1] + kerf_mm)], [])

    def takes(self, board: Board, kerf_mm: float, *, turn: bool) -> bool:
        """Place a blank if there is room."""
        lies = [(board.length_mm, board.width_mm), *([(board.width_mm, board.length_mm)] if turn else [])]
        rests = [
            (min(room.along - along, room.across - across), at, along, across)
            for at, room in enumerate(self.free)
            for along, across in ((a + kerf_mm, b + kerf_mm) for a, b in lies)
            if along <= room.along + _SAME_MM and across <= room.across + _SAME_MM
        ]
        if not rests:
            return False
        _, at, along, across = min(rests)
        room = self.free.pop(at)
        self.cuts.append(Cut(board, room.x, room.y, along - kerf_mm, across - kerf_mm))
        beside, above = room.along - along, room.across - across
        through = beside < above  # which of the two cuts runs from edge to edge
        self.free += [
            _Free(room.x + along, room.y, beside, across if through else room.across),
            _Free(room.x, room.y + across, room.along if through else along, above),
        ]
        return True


def cut_list_json(boards: Sequence[Board], sheets: Sequence[Sheet], large: Sequence[Board], *, kerf_mm: float) -> Json:
    """Return the report `articad.cuts/1`, lengths in mm."""
    return {
        "schema": "articad.cuts/1",
        "kerf_mm": kerf_mm,
        "boards": [
            {
                "item": board.item.number, "name": board.item.name, "quantity": board.item.quantity, "material": board.item.material,
                "length_mm": board.length_mm, "width_mm": board.width_mm, "thickness_mm": board.thickness_mm,
            }
            for board in boards
        ],
        "sheets": [
            {
                "material": sheet.material, "thickness_mm": sheet.thickness_mm, "size_mm": list(sheet.size_mm), "used": sheet.used,
                "cuts": [
                    {"item": cut.board.item.number, "x_mm": cut.x, "y_mm": cut.y, "along_mm": cut.along, "across_mm": cut.across}
                    for cut in sheet.cuts
                ],
            }
            for sheet in sheets
        ],
        "too_large": [board.item.number for board in large],
    }  # fmt: skip
