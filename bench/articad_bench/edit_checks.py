"""Checks of an edit that compare where parts lie with where they lay before."""

from __future__ import annotations

from itertools import combinations
from typing import Literal

import numpy as np

from articad.arrays import FloatArray
from articad_bench.check import Bounds, Check, Vector, in_words, within
from articad_bench.module_checks import middle_along
from articad_bench.subject import Subject


class Shifted(Check):
    """After an edit, a number of pairs of parts whose shapes are as before lie so much farther apart along an axis than before [mm].

    A part lies where the middle of its box is at rest. Parts of one shape are
    taken in their order along the axis; where they are more or fewer than before, none of them counts.
    """

    kind: Literal["shifted"] = "shifted"
    axis: Vector
    mm: Bounds
    number: Bounds

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} pairs of unchanged parts lie {in_words(self.mm)} mm farther apart along {self.axis}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        if subject.before is None:
            return False, "nothing was there before"
        axis = np.array(self.axis)
        before, after = (_places(each, axis) for each in (Subject(subject.before), subject))
        shapes = [shape for shape, places in before.items() if len(after.get(shape, ())) == len(places)]
        kept = [pair for shape in shapes for pair in zip(before[shape], after[shape], strict=True)]
        farther = [abs(b - d) - abs(a - c) for (a, b), (c, d) in combinations(kept, 2)]
        count = sum(within(mm, self.mm) for mm in farther)
        told = ", ".join(f"{mm:.4g}" for mm in sorted(farther)[-12:])
        return self.number[0] <= count <= self.number[1], f"{count} of {len(farther)} ({told or 'no pair is unchanged'} mm)"


def _places(subject: Subject, axis: FloatArray) -> dict[str, list[float]]:
    """Return where the parts of each shape lie along an axis, ascending."""
    found: dict[str, list[float]] = {}
    for name in subject.shaped:
        found.setdefault(subject.form(name), []).append(middle_along(subject, name, axis))
    return {shape: sorted(places) for shape, places in found.items()}
