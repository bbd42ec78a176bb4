"""Check of the outlines that photos and drawings of the whole show: what stands out or is left out is seen against the ground behind it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw
from scipy.ndimage import binary_dilation, binary_opening, distance_transform_edt, label

from articad.arrays import FloatArray
from articad_bench.check import Check
from articad_bench.likeness_checks import TURNS
from articad_bench.shape_checks import placed
from articad_bench.subject import Subject

CELLS: Final = 80  # along the longer side of an outline
FINE: Final = 2  # dots along the side of a cell
BESIDE: Final = 0.045  # of an outline's diagonal: who reads every measure off a photo within 10 % is nearer
THIN: Final = 0.1  # of the diagonal: what is thinner is a bar, a knob or a foot
SIDES: Final = ((1, 2), (0, 2), (0, 1))
"""The axes to the right and upwards of what is seen along x, y and z."""

Outline = NDArray[np.bool_]


class Outlined(Check):
    """Seen along each axis at rest, nothing of the product lies far from what is shown, and each thin thing that stands out has its like there.

    The outlines are stretched to the same box, whose sides are another check's matter. The whole may be turned by quarters about the upright axis.

    Attributes:
        seen: Outlines along x, y and z, each from above: `#` is the product, and `3x` in front of a row stands for three such rows.
        beside: Share of an outline's diagonal by which the two may lie apart.
    """

    kind: Literal["outlined"] = "outlined"
    seen: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
    beside: float = BESIDE

    @property
    def wanted(self) -> str:
        return f"the outlines that are shown along x, y and z, within {100 * self.beside:g} % of their diagonals"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        if not subject.shaped:
            return False, "nothing has a shape"
        best = self.apart(subject, enough=self.beside)
        return best <= self.beside, f"{100 * best:.2g} %"

    def apart(self, subject: Subject, enough: float = 0.0) -> float:
        """Return how far the outlines lie apart, as a share of their diagonals; of the quarters, the first that is near enough, or the best."""
        wanted, best = [_unpacked(rows) for rows in self.seen], 1.0
        for turn in TURNS:
            corners = _corners(subject, turn)
            found = (_outline(corners, side, rows.shape) for side, rows in zip(SIDES, wanted, strict=True))
            best = min(best, max(_difference(a, b) for a, b in zip(wanted, found, strict=True)))
            if best <= enough:
                break
        return best


def outlined(subject: Subject) -> Outlined:
    """Return the check of the outlines of a product at rest."""
    corners = _corners(subject, TURNS[0])
    x, y, z = (_packed(_outline(corners, side, _shape(subject.size[list(side)]))) for side in SIDES)
    return Outlined(seen=(x, y, z))


def _corners(subject: Subject, turn: FloatArray) -> FloatArray:
    """Return the triangles of all parts at rest, turned `(n, 3, 3)` [mm]."""
    return np.concatenate([(mesh.vertices @ turn.T)[mesh.triangles] for mesh in placed(subject)])


def _shape(sides: FloatArray) -> tuple[int, int]:
    """Return how many rows and columns an outline with these sides has."""
    columns, rows = (max(1, round(float(side))) for side in CELLS * sides / sides.max())
    return rows, columns


def _outline(corners: FloatArray, side: tuple[int, int], shape: tuple[int, ...]) -> Outline:
    """Return which cells of the box around triangles they touch, the uppermost row first."""
    flat = corners[..., list(side)]
    low, high = flat.min(axis=(0, 1)), flat.max(axis=(0, 1))
    rows, columns = shape
    dots = (flat - low) / np.maximum(high - low, 1e-9) * (np.array([columns, rows]) * FINE - 1)
    picture = Image.new("1", (columns * FINE, rows * FINE))
    pen = ImageDraw.Draw(picture)
    for triangle in dots:
        pen.polygon(triangle.ravel().tolist(), fill=1, outline=1)
    return np.asarray(np.asarray(picture)[::-1].reshape(rows, FINE, columns, FINE).any(axis=(1, 3)))


def _difference(wanted: Outline, found: Outline) -> float:
    """Return how far the two lie apart, as a share of their diagonal: what is there, what is empty, and what is thin."""
    diagonal = float(np.hypot(*wanted.shape))
    reach = round(THIN * diagonal)
    pair = [np.pad(_without_slits(each, BESIDE * diagonal), 2 * reach + 1) for each in (wanted, found)]
    gap = np.ones((3, 3), dtype=np.bool_)  # a narrower gap may close where its sides fall into one cell
    apart = 0.0
    for here, there in (pair, pair[::-1]):
        thin = here & ~binary_dilation(_opened(here, reach), gap)
        also = there & ~_opened(there, 2 * reach)
        ways = ((here, there), (binary_opening(~here, gap), ~there), (thin, also))
        apart = max(apart, *(_farthest(a, b) / diagonal for a, b in ways))
    return min(apart, 1.0)


def _without_slits(outline: Outline, width: float) -> Outline:
    """Return an outline without openings that are smaller than a square of this width [cells]: slits between eyes that turn on one pin."""
    numbers, _ = label(~outline, np.ones((3, 3)))
    areas = np.bincount(numbers.ravel())
    rim = np.unique(np.concatenate([numbers[0], numbers[-1], numbers[:, 0], numbers[:, -1]]))
    small = areas < width**2
    small[[0, *rim]] = False
    return np.asarray(outline | small[numbers])


def _opened(outline: Outline, width: int) -> Outline:
    """Return what of an outline a square of this width covers without leaving it."""
    return np.asarray(binary_opening(outline, np.ones((width, width), dtype=np.bool_)))


def _farthest(some: Outline, others: Outline) -> float:
    """Return how far the farthest of some cells is from the nearest of others; without others, as far as can be."""
    if not some.any():
        return 0.0
    return float(np.asarray(distance_transform_edt(~others))[some].max()) if others.any() else float(sum(some.shape))


def _packed(outline: Outline) -> tuple[str, ...]:
    """Return the rows of an outline as text, equal neighbours as one."""
    rows: list[tuple[int, str]] = []
    for row in ("".join(".#"[int(cell)] for cell in cells) for cells in outline):
        if rows and rows[-1][1] == row:
            rows[-1] = (rows[-1][0] + 1, row)
        else:
            rows.append((1, row))
    return tuple(row if count == 1 else f"{count}x{row}" for count, row in rows)


def _unpacked(rows: Sequence[str]) -> Outline:
    """Return the outline that rows of text state."""
    split = [row.rpartition("x") for row in rows]
    return np.array([[cell == "#" for cell in row] for count, _, row in split for _ in range(int(count or 1))], dtype=np.bool_)
