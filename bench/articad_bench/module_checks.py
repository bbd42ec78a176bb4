"""Checks of modules that a product repeats: how far apart they lie, which way round they lie, and whether bought parts fit where they sit."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, Literal

import numpy as np

from articad.arrays import FloatArray
from articad_bench.check import Bounds, Check, Vector, in_words
from articad_bench.likeness_checks import moments
from articad_bench.shape_checks import LEAN
from articad_bench.solids import Round, rounds
from articad_bench.subject import Subject
from articad_bench.wanted import in_numbers

Sides = tuple[float | None, float | None, float | None]

SAME_LEVEL_MM: Final = 0.2
SAME_WAY: Final = 0.02  # of the moments of two copies, by which meshes alone may make them differ
OFF_AXIS_MM: Final = 0.05


class _Sized(Check):
    """The parts that have these sides, in any order; None where any length is meant."""

    mm: Sides
    tolerance: float = 0.02

    @property
    def _parts(self) -> str:
        return f"parts of {_by(self.mm)} mm"


class Spaced(_Sized):
    """All parts with these sides lie on levels along an axis, each level `pitch` above the one before [mm], with so many parts on each.

    A part lies where the middle of its box is at rest, along the axis. Where it lies across the axis is another check's matter.

    Attributes:
        axis: Along which the levels ascend, in the frame of the whole.
        pitch: One distance for all, or each in its order; none where all lie on one level.
        levels: How many there are.
        each: How many parts lie on each: one number for all, or each in its order.
    """

    kind: Literal["spaced"] = "spaced"
    axis: Vector
    pitch: tuple[float, ...] = ()
    levels: int
    each: tuple[int, ...] = (1,)

    @property
    def wanted(self) -> str:
        apart, each = (", ".join(f"{number:g}" for number in row) for row in (self.pitch, self.each))
        levels = (
            f"{self.levels} levels along {in_numbers(self.axis)}, {apart} mm apart" if apart else f"one level along {in_numbers(self.axis)}"
        )
        return f"{self._parts} lie on {levels}, {each} on each"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        names = subject.of_size(self.mm, self.tolerance)
        levels = _levels([middle_along(subject, name, np.array(self.axis)) for name in names])
        apart = np.diff([float(np.mean(level)) for level in levels])
        counts = [len(level) for level in levels]
        told = (
            f"{len(names)} parts on {len(levels)} levels of {sorted(set(counts))}, {', '.join(f'{mm:.4g}' for mm in apart[:12])} mm apart"
        )
        if len(levels) != self.levels or counts != _spread(self.each, self.levels):
            return False, told
        pitch = np.array(_spread(self.pitch, self.levels - 1))
        return len(pitch) == len(apart) and bool(np.all(np.abs(apart - pitch) <= self.tolerance * pitch)), told


class Ordered(Check):
    """Parts of several sizes lie one after the other along an axis, by the middles of their boxes: all of one size before all of the next.

    Attributes:
        sizes: Sides of the parts, in any order; None where any length is meant. Each size must be there.
        axis: Along which they follow each other, in the frame of the whole.
    """

    kind: Literal["ordered"] = "ordered"
    sizes: tuple[Sides, ...]
    axis: Vector
    tolerance: float = 0.02

    @property
    def wanted(self) -> str:
        return f"parts of {', '.join(_by(sides) for sides in self.sizes)} mm follow each other along {in_numbers(self.axis)}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [
            [middle_along(subject, name, np.array(self.axis)) for name in subject.of_size(sides, self.tolerance)] for sides in self.sizes
        ]
        ok = all(found) and all(max(a) < min(b) for a, b in pairwise(found))
        return ok, "; ".join(", ".join(f"{place:.4g}" for place in places[:4]) or "none" for places in found)


class Turned(_Sized):
    """So many of the parts with these sides lie the same way round at rest, and so many another way: counts, the largest first.

    Two parts lie the same way round if their matter lies in the same way about the middles of their boxes, by its moments up to the third
    degree, in the frame of the whole.
    """

    kind: Literal["turned"] = "turned"
    alike: tuple[int, ...]

    @property
    def wanted(self) -> str:
        return f"{self._parts}: {' and '.join(str(count) for count in self.alike)} lie the same way round"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        groups: list[tuple[FloatArray, list[str]]] = []
        for name in subject.of_size(self.mm, self.tolerance):
            found = _matter(subject, name)
            group = next((members for first, members in groups if float(np.linalg.norm(found - first)) <= SAME_WAY), None)
            if group is None:
                groups.append((found, [name]))
            else:
                group.append(name)
        counts = sorted((len(members) for _, members in groups), reverse=True)
        fewest = min((members for _, members in groups), key=len, default=[])
        return counts == sorted(self.alike, reverse=True), f"{counts}" + (f" (others: {', '.join(fewest[:4])})" if len(groups) > 1 else "")


class Fitted(Check):
    """A number of round outsides of this diameter sit in round holes of other parts, about the same axis, with this play on the diameter [mm].

    `axis` is in the frame of the whole. A shaft through several holes counts once for each face that is round.
    """

    kind: Literal["fitted"] = "fitted"
    diameter: float
    play: Bounds
    number: Bounds
    axis: Vector | None = None
    tolerance: float = 0.002

    @property
    def wanted(self) -> str:
        along = f" along {in_numbers(self.axis)}" if self.axis else ""
        return f"{in_words(self.number)} round outsides of {self.diameter:g} mm{along} sit in holes with {in_words(self.play)} mm of play"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [(name, each) for name in subject.shaped for each in placed_rounds(subject, name)]
        holes = [(name, each) for name, each in found if each.hollow]
        plays: list[list[float]] = []
        for name, stud in found:
            if not stud.hollow and abs(2 * stud.radius - self.diameter) <= self.tolerance * self.diameter and self._along(stud):
                plays.append([2 * (hole.radius - stud.radius) for other, hole in holes if other != name and _around(hole, stud)])
        low, high = self.play[0] - 1e-4, self.play[1] + 1e-4
        count = sum(any(low <= play <= high for play in around) for around in plays)
        told = ", ".join(sorted({f"{play:.3g}" for around in plays for play in around})[:8])
        return self.number[0] <= count <= self.number[1], f"{count} of {len(plays)} (play {told or 'none: no hole'} mm)"

    def _along(self, found: Round) -> bool:
        return self.axis is None or abs(float(found.axis @ np.array(self.axis))) >= LEAN * float(np.linalg.norm(self.axis))


def placed_rounds(subject: Subject, name: str) -> list[Round]:
    """Return the round holes and studs of a part as it lies at rest."""
    mesh = subject.assembly.parts[name].mesh
    return [] if mesh is None else rounds(mesh.transformed(subject.rest[name]))


def _around(hole: Round, stud: Round) -> bool:
    """Return whether a hole is about a stud: of the same axis, and beside it along the axis."""
    if abs(float(hole.axis @ stud.axis)) < LEAN or hole.radius < stud.radius - OFF_AXIS_MM:
        return False
    between = stud.centre - hole.centre
    along = abs(float(between @ hole.axis))
    aside = float(np.linalg.norm(np.cross(between, hole.axis)))
    return along < (hole.length + stud.length) / 2 and aside <= max(hole.radius - stud.radius, 0.0) + OFF_AXIS_MM


def _spread(numbers: Sequence[float], count: int) -> list[float]:
    """Return numbers in a list, one for all as often as there are places for it."""
    return [*numbers] * count if len(numbers) == 1 else [*numbers]


def _by(sides: Sides) -> str:
    return " x ".join("any" if side is None else f"{side:g}" for side in sides)


def middle_along(subject: Subject, name: str, axis: FloatArray) -> float:
    """Return where the middle of a part's box lies along an axis of the whole at rest [mm]."""
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    along = subject.rest[name].apply(mesh.vertices) @ (axis / np.linalg.norm(axis))
    return float(along.min() + along.max()) / 2


def _levels(places: Sequence[float]) -> list[list[float]]:
    """Return places in groups of one level, in ascending order."""
    levels: list[list[float]] = []
    for place in sorted(places):
        if levels and place - levels[-1][0] <= SAME_LEVEL_MM:
            levels[-1].append(place)
        else:
            levels.append([place])
    return levels


def _matter(subject: Subject, name: str) -> FloatArray:
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    points = subject.rest[name].apply(mesh.vertices)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    return moments([(points - middle)[mesh.triangles]])
