"""A sheet of a drawing: lines, texts and dimensions in mm of paper, from its lower left corner. `svg`, `pdf` and `dxf` write it.

The frame follows ISO 5457 (20 mm on the filing side, 10 mm elsewhere, centring marks), the title block ISO 7200, lines ISO 128.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final, Literal, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.kernels.views import Arc, Line, Path2d, Segment

__all__ = [
    "A3",
    "A4",
    "STYLES",
    "DimensionLine",
    "DrawingSheet",
    "Lettering",
    "SheetLine",
    "SheetPicture",
    "Style",
    "sampled",
    "text_width",
]

A4, A3 = (297.0, 210.0), (420.0, 297.0)
FILING, EDGE = 20.0, 10.0  # margins
BLOCK: Final = (180.0, 30.0)  # title block
SMALL, LARGE = 2.5, 3.5  # heights of letters
ARROW = 2.5  # length of an arrow

Style = Literal["visible", "hidden", "centre", "thin", "hatch", "cut", "frame"]
STYLES: Final[Mapping[str, tuple[float, tuple[float, ...]]]] = {  # width, and lengths of dashes and gaps
    "visible": (0.5, ()),
    "hidden": (0.25, (2.5, 1.0)),
    "centre": (0.18, (6.0, 1.0, 1.0, 1.0)),
    "thin": (0.18, ()),
    "hatch": (0.13, ()),
    "cut": (0.5, (6.0, 1.0, 1.0, 1.0)),
    "frame": (0.7, ()),
}

# widths of Helvetica's letters in thousandths of their size, from the space to the tilde
_WIDTHS: Final = tuple(
    int(width)
    for width in [
        "278",
        "278",
        "355",
        "556",
        "556",
        "889",
        "667",
        "191",
        "333",
        "333",
        "389",
        "584",
        "278",
        "333",
        "278",
        "278",
        "556",
        "556",
        "556",
        "556",
        "556",
        "556",
        "556",
        "556",
        "556",
        "556",
        "278",
        "278",
        "584",
        "584",
        "584",
        "556",
        "1015",
        "667",
        "667",
        "722",
        "722",
        "667",
        "611",
        "778",
        "722",
        "278",
        "500",
        "667",
        "556",
        "833",
        "722",
        "778",
        "667",
        "778",
        "722",
        "667",
        "611",
        "722",
        "667",
        "944",
        "667",
        "667",
        "611",
        "278",
        "278",
        "278",
        "469",
        "556",
        "333",
        "556",
        "556",
        "500",
        "556",
        "556",
        "278",
        "556",
        "556",
        "222",
        "222",
        "500",
        "222",
        "833",
        "556",
        "556",
        "556",
        "556",
        "333",
        "500",
        "278",
        "556",
        "500",
        "722",
        "500",
        "500",
        "500",
        "334",
        "260",
        "334",
        "584",
    ]
)
_WIDER: Final = {"Ø": 778, "±": 584, "×": 584, "°": 400, "–": 556, "−": 584}
HEIGHT_OF_CAPITALS: Final = 0.72  # of the size of Helvetica; ISO 3098 states the height of capitals


def text_width(words: str, height: float) -> float:
    """Return the width of a text in Helvetica whose capitals have a height [mm]."""
    return height / HEIGHT_OF_CAPITALS / 1000 * sum(_WIDTHS[ord(c) - 32] if " " <= c <= "~" else _WIDER.get(c, 600) for c in words)


class SheetLine(NamedTuple):
    """A line."""

    style: Style
    line: Line


class Lettering(NamedTuple):
    """A line of text: `anchor` is the end or middle of its foot that lies at (x, y)."""

    x: float
    y: float
    words: str
    height: float = SMALL
    anchor: Literal["start", "middle", "end"] = "start"
    turned: bool = False
    bold: bool = False


@dataclass(frozen=True)
class DimensionLine:
    """A linear dimension between two points of the part.

    Attributes:
        start: On the paper, `(2,)`.
        end: On the paper.
        at: Height of a horizontal dimension line, or place of a vertical one.
        vertical: Its direction.
        words: Its text.
        value: The true length [mm].
        outside: Where the text of a dimension that is too short for it begins, along its line; None if it stands in its middle.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    at: float
    vertical: bool
    words: str
    value: float
    outside: float | None = None

    def drawn(self) -> tuple[list[SheetLine], list[tuple[FloatArray, ...]], list[Lettering]]:
        """Return its lines, its arrows as triangles, and its text."""

        def turn(along: float, across: float) -> tuple[float, float]:
            return (across, along) if self.vertical else (along, across)

        (a, foot_a), (b, foot_b) = sorted(((p[1], p[0]) if self.vertical else p) for p in (self.start, self.end))
        side = -1.0 if self.at < min(foot_a, foot_b) else 1.0
        strokes = [
            SheetLine("thin", Segment(*turn(along, foot + side * 1.0), *turn(along, self.at + side * 1.5)))
            for along, foot in ((a, foot_a), (b, foot_b))
        ]
        inside, middle, wide = self.outside is None, 0.5 * (a + b), text_width(self.words, SMALL)
        foot = middle if self.outside is None else self.outside
        from_, to = (a, b) if inside else (min(a - 2 * ARROW, foot), max(b + 2 * ARROW, foot + wide))
        strokes.append(SheetLine("thin", Segment(*turn(from_, self.at), *turn(to, self.at))))
        arrows = [
            tuple(np.array(turn(tip + sign * back, self.at + across)) for back, across in ((0.0, 0.0), (ARROW, 0.42), (ARROW, -0.42)))
            for tip, sign in ((a, 1.0 if inside else -1.0), (b, -1.0 if inside else 1.0))
        ]
        above = -0.8 if self.vertical else 0.8
        return strokes, arrows, [Lettering(*turn(foot, self.at + above), self.words, SMALL, "middle" if inside else "start", self.vertical)]


class Leader(NamedTuple):
    """An arrow from a text to a circle: the tip, the knee, the text on a shelf that runs right or left from there."""

    tip: tuple[float, float]
    knee: tuple[float, float]
    words: str
    right: bool = True

    def drawn(self) -> tuple[list[SheetLine], list[tuple[FloatArray, ...]], list[Lettering]]:
        """Return its lines, its arrow as a triangle, and its text."""
        tip, knee = np.array(self.tip), np.array(self.knee)
        direction = (knee - tip) / max(float(np.linalg.norm(knee - tip)), 1e-9)
        aside = np.array([-direction[1], direction[0]])
        arrow = (tip, tip + ARROW * direction + 0.42 * aside, tip + ARROW * direction - 0.42 * aside)
        width = text_width(self.words, SMALL) + 1.0
        end = knee[0] + (width if self.right else -width)
        lines = [
            SheetLine("thin", Segment(*tip, *knee)),
            SheetLine("thin", Segment(float(knee[0]), float(knee[1]), float(end), float(knee[1]))),
        ]
        return lines, [arrow], [Lettering(min(knee[0], end) + 0.5, knee[1] + 0.8, self.words)]


class SheetPicture(NamedTuple):
    """A PNG picture whose lower left corner lies at (x, y)."""

    x: float
    y: float
    width: float
    height: float
    png: bytes


@dataclass
class DrawingSheet:
    """One page.

    Attributes:
        name: Of the part or the assembly.
        size: Width and height.
        scale: Of its views: mm of paper per mm of the part.
        part: The part that it shows; None for the assembly.
        strokes: Lines.
        texts: Texts.
        arrows: Filled polygons.
        dimensions: Linear dimensions.
        pictures: Pictures below everything else; DXF has none.
        told: What the page states, as JSON.
    """

    name: str
    size: tuple[float, float]
    scale: float
    part: str | None = None
    strokes: list[SheetLine] = field(default_factory=list)
    texts: list[Lettering] = field(default_factory=list)
    arrows: list[tuple[FloatArray, ...]] = field(default_factory=list)
    dimensions: list[DimensionLine] = field(default_factory=list)
    pictures: list[SheetPicture] = field(default_factory=list)
    told: dict[str, object] = field(default_factory=dict)
    _cloud: list[FloatArray] = field(default_factory=list, repr=False)  # points of the first strokes

    @property
    def inside(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top of the frame."""
        return FILING, EDGE, self.size[0] - EDGE, self.size[1] - EDGE

    def add(self, drawn: tuple[list[SheetLine], list[tuple[FloatArray, ...]], list[Lettering]]) -> None:
        """Add lines, arrows and texts."""
        self.strokes += drawn[0]
        self.arrows += drawn[1]
        self.texts += drawn[2]

    def line(self, style: Style, x0: float, y0: float, x1: float, y1: float) -> None:
        """Add a straight line."""
        self.strokes.append(SheetLine(style, Segment(x0, y0, x1, y1)))

    def box(self, style: Style, left: float, bottom: float, right: float, top: float) -> None:
        """Add a rectangle."""
        self.strokes.append(
            SheetLine(style, Path2d(np.array([[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]])))
        )

    def frame(self, fields: Sequence[tuple[str, str, float, float, float]], *, first_angle: bool = True) -> None:
        """Draw the frame with its centring marks, and the title block.

        Args:
            fields: Label, text, and left, top and width of each field of the title block, in rows of 10 mm.
            first_angle: Whether the symbol of first-angle projection stands in its lower right corner.
        """
        left, bottom, right, top = self.inside
        self.box("frame", left, bottom, right, top)
        width, height = self.size
        for x, y, inwards in ((width / 2, 0.0, 1), (width / 2, height, -1)):
            reach = 0.0 if inwards > 0 and x > right - BLOCK[0] else 5.0  # not into the title block
            self.line("frame", x, y, x, (bottom if inwards > 0 else top) + reach * inwards)
        for x, y, inwards in ((0.0, height / 2, 1), (width, height / 2, -1)):
            self.line("frame", x, y, (left if inwards > 0 else right) + 5.0 * inwards, y)
        x0, y1 = right - BLOCK[0], bottom + BLOCK[1]
        self.box("visible", x0, bottom, right, y1)
        for label, words, x, y, wide in fields:
            self.box("thin", x0 + x, y1 - y - 10.0, x0 + x + wide, y1 - y)
            self.texts.append(Lettering(x0 + x + 1.2, y1 - y - 2.9, label, 1.8))
            self.texts.append(Lettering(x0 + x + 1.2, y1 - y - 8.2, fitted(words, wide - 2.4, LARGE), LARGE))
        if first_angle:
            self._first_angle(x0 + BLOCK[0] - 14.0, y1 - 26.4)

    def _first_angle(self, x: float, y: float) -> None:
        """Draw the symbol of first-angle projection (ISO 5456-2): a cone from the side, and to its right from its thick end's view."""
        cone = np.array([[x - 6.0, y - 1.4], [x, y - 2.6], [x, y + 2.6], [x - 6.0, y + 1.4], [x - 6.0, y - 1.4]])
        self.strokes.append(SheetLine("thin", Path2d(cone)))
        for radius in (1.4, 2.6):
            self.strokes.append(SheetLine("thin", Arc(x + 6.0, y, radius, 0.0, 360.0)))
        self.line("centre", x - 7.5, y, x + 1.5, y)
        self.line("centre", x + 2.4, y, x + 9.6, y)
        self.line("centre", x + 6.0, y - 3.4, x + 6.0, y + 3.4)

    def table(
        self, right: float, bottom: float, title: str, head: Sequence[str], rows: Sequence[Sequence[str]], widths: Sequence[float]
    ) -> None:
        """Draw a table whose lower right corner is at a place, with rows of 4.6 mm."""
        total, row = sum(widths), ROW
        left, top = right - total, bottom + row * (len(rows) + 1)
        self.texts.append(Lettering(min(left, right - 1.08 * text_width(title, SMALL)), top + 1.2, title, SMALL, bold=True))
        self.box("visible", left, bottom, right, top)
        for index in range(1, len(rows) + 1):
            self.line("visible" if index == len(rows) else "thin", left, bottom + row * index, right, bottom + row * index)
        edges = np.cumsum([0.0, *widths])
        for x in edges[1:-1]:
            self.line("thin", left + x, bottom, left + x, top)
        for index, cells in enumerate([head, *rows]):
            for cell, x, width in zip(cells, edges, widths, strict=False):
                at = top - row * (index + 1) + 1.3
                self.texts.append(Lettering(left + x + 0.8, at, fitted(cell, width - 1.6, 2.0), 2.0, bold=index == 0))

    def clear_of(self, left: float, bottom: float, right: float, top: float) -> bool:
        """Return whether no line, text or dimension that is on the sheet yet lies in a rectangle, and it is inside the frame."""
        low = self.inside
        if left < low[0] + 1 or bottom < low[1] + 1 or right > low[2] - 1 or top > low[3] - 1:
            return False
        self._cloud += [sampled(stroke.line) for stroke in self.strokes[len(self._cloud) :]]
        drawn = [one.drawn() for one in self.dimensions]
        clouds = [*self._cloud, *(sampled(stroke.line) for strokes, _, _ in drawn for stroke in strokes)]
        points = np.concatenate([np.zeros((0, 2)), *clouds])
        inside = (points[:, 0] > left) & (points[:, 0] < right) & (points[:, 1] > bottom) & (points[:, 1] < top)
        texts = [*self.texts, *(text for _, _, words in drawn for text in words)]
        return not inside.any() and not any(_crossing(text, left, bottom, right, top) for text in texts)

    def everything(self) -> tuple[list[SheetLine], list[tuple[FloatArray, ...]], list[Lettering]]:
        """Return all lines, filled polygons and texts, with those of dimensions."""
        strokes, arrows, texts = list(self.strokes), list(self.arrows), list(self.texts)
        for dimension in self.dimensions:
            lines, tips, words = dimension.drawn()
            strokes += lines
            arrows += tips
            texts += words
        return strokes, arrows, texts


ROW: Final = 4.6  # height of a row of a table


def sampled(line: Line) -> FloatArray:
    """Return points on a line, half a millimetre apart `(N, 2)`."""
    if isinstance(line, Segment):
        ends = np.array([[line.x0, line.y0], [line.x1, line.y1]])
    elif isinstance(line, Arc):
        angles = np.radians(np.linspace(line.start, line.end, max(int(line.radius * np.radians(line.end - line.start) / 0.5), 8)))
        return np.array([line.x, line.y]) + line.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    else:
        ends = line.points
    pieces = [np.linspace(a, b, max(int(np.linalg.norm(b - a) / 0.5), 1) + 1) for a, b in pairwise(ends)]
    return np.concatenate(pieces)


def _crossing(text: Lettering, left: float, bottom: float, right: float, top: float) -> bool:
    wide = text_width(text.words, text.height)
    back = {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor] * wide
    if text.turned:
        box = (text.x - text.height, text.y - back, text.x, text.y - back + wide)
    else:
        box = (text.x - back, text.y, text.x - back + wide, text.y + text.height)
    return box[0] < right and left < box[2] and box[1] < top and bottom < box[3]


def fitted(words: str, width: float, height: float) -> str:
    """Return a text that fits into a width; if it is shortened, both its ends stay, because names of parts differ at either."""
    if text_width(words, height) <= width:
        return words
    for kept in range(len(words) - 1, 0, -1):
        shorter = f"{words[: (kept + 1) // 2]}...{words[len(words) - kept // 2 :]}"
        if text_width(shorter, height) <= width:
            return shorter
    return "..."
