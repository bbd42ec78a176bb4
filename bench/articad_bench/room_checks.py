"""Checks of what a product is made of and what it has room for: weights of parts and bodies, and empty places where something is to lie."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad_bench.bodies import moved_bodies
from articad_bench.check import Bounds, Check, in_words, within
from articad_bench.shape_checks import placed
from articad_bench.solids import filled_cells
from articad_bench.subject import Subject
from articad_bench.wanted import JointWanted

CELLS: Final = 24  # along each side of a room: what is empty is known to so much of it

_Grid = NDArray[np.bool_]
_Window = tuple[int, int, int]


class Weighs(Check):
    """A number of parts with these sides, or of bodies that such a joint moves, weigh so much [kg]: foam in place of oak does not.

    A part of which no mass is known weighs what water does. A body is all that is fixed together.

    Attributes:
        kg: Bounds of the weight of each.
        mm: Sides of the parts, in any order; None where any length is meant.
        joint: In place of sides, what moves the bodies that are meant.
        number: Of such parts or bodies.
    """

    kind: Literal["weighs"] = "weighs"
    kg: Bounds
    mm: tuple[float | None, float | None, float | None] | None = None
    joint: JointWanted | None = None
    number: Bounds = (1, 999)
    tolerance: float = 0.02

    @property
    def wanted(self) -> str:
        sides = "" if self.mm is None else f"parts of {' x '.join('any' if side is None else f'{side:g}' for side in self.mm)} mm"
        return f"{in_words(self.number)} {sides or f'bodies that are moved by {self.joint}'} that weigh {in_words(self.kg)} kg"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [self._weight(subject, parts) for parts in self._meant(subject)]
        count = sum(within(kg, self.kg) for kg in found)
        return self.number[0] <= count <= self.number[1], f"{count} ({', '.join(f'{kg:.4g}' for kg in found[:12]) or 'none'} kg)"

    def _meant(self, subject: Subject) -> list[list[str]]:
        """Return the parts of each body that is meant."""
        if self.joint is None:
            return [[name] for name in subject.of_size(self.mm or (None, None, None), self.tolerance)]
        bodies = dict.fromkeys(body for joint in self.joint.found(subject) for body in moved_bodies(subject, joint))
        return [[name for name in subject.assembly.mechanism.parts if subject.rigid[name] == body] for body in bodies]

    def _weight(self, subject: Subject, parts: list[str]) -> float:
        return sum(mass.mass for name in parts if (mass := subject.mass(name)) is not None)


class Room(Check):
    """A number of empty boxes of these sides, upright and beside or above each other, lie in the product at rest [mm].

    Each stands on matter, or lies below it, on both sides of its middle, both ways: a crate on two rails. It may reach above the product.

    Attributes:
        mm: Sides along x, y and z.
        at: Whether it stands on what is below it, or lies under what is above it.
        number: Of such boxes, no two of which overlap.
    """

    kind: Literal["room"] = "room"
    mm: tuple[float, float, float]
    at: Literal["on", "under"] = "on"
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        return f"room for {in_words(self.number)} boxes of {' x '.join(f'{side:g}' for side in self.mm)} mm, each {self.at} something"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        cell = np.array(self.mm) / CELLS
        empty = ~_matter(subject, cell)
        window = (CELLS - 1,) * 3  # what is as large as asked for, and begins within a cell, holds so many whole ones
        fits = _count(empty, window) == (CELLS - 1) ** 3
        fits &= self._borne(~empty)
        chosen = _apart(np.argwhere(fits))
        return self.number[0] <= chosen <= self.number[1], f"room for {chosen}"

    def _borne(self, matter: _Grid) -> _Grid:
        """Return the windows that have matter right below or above them, on both sides of their middle along x and along y."""
        size, half = CELLS - 1, CELLS // 2
        layer = _count(matter, (1, 1, 2)) > 0  # within two cells
        shape = tuple(n - size + 1 for n in matter.shape)
        below = np.zeros((*matter.shape[:2], shape[2]), dtype=np.bool_)
        if self.at == "on":
            below[:, :, 2:] = layer[:, :, : shape[2] - 2]
        else:
            above = layer[:, :, size:]
            below[:, :, : above.shape[2]] = above[:, :, : shape[2]]
        near_x, near_y = (_count(below, (half, size, 1)) > 0, _count(below, (size, half, 1)) > 0)
        far = size - half
        both_x = near_x[: shape[0]] & near_x[far : far + shape[0]]
        both_y = near_y[:, : shape[1]] & near_y[:, far : far + shape[1]]
        return np.asarray(both_x & both_y)


def _matter(subject: Subject, cell: FloatArray) -> _Grid:
    """Return which cells hold matter, over the box of the whole and one room above it, and two empty layers below."""
    low, high = subject.corners(subject.rest)
    shape = np.ceil((high - low) / cell - 1e-6).astype(int) + np.array([0, 0, CELLS + 2])
    start = low - np.array([0.0, 0.0, 2 * cell[2]])
    (nx, ny, nz) = (max(int(n), CELLS) for n in shape)
    found = np.zeros((nx, ny, nz), dtype=np.bool_)
    for mesh in placed(subject):
        found |= filled_cells(mesh, start, cell, (nx, ny, nz))
    return found


def _count(grid: _Grid, window: _Window) -> NDArray[np.int64]:
    """Return how many cells of each window are set, by the window's first cell."""
    total = np.pad(grid.astype(np.int64), [(1, 0)] * 3).cumsum(axis=0).cumsum(axis=1).cumsum(axis=2)
    for axis, size in enumerate(window):
        count = total.shape[axis] - size
        total = np.take(total, range(size, size + count), axis=axis) - np.take(total, range(count), axis=axis)
    return np.asarray(total)


def _apart(places: NDArray[np.int64]) -> int:
    """Return how many windows can be chosen from below so that no two overlap."""
    left = places[np.lexsort(places.T)]
    count = 0
    while len(left):
        count += 1
        left = left[(np.abs(left - left[0]) >= CELLS - 1).any(axis=1)]
    return count
