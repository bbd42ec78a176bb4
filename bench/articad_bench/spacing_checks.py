"""Checks of how far apart joints and holes lie: the lengths of a linkage, whatever the shapes of its parts, and the squares of fixing holes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Final, Literal

import numpy as np

from articad.arrays import FloatArray
from articad.kinematics.joints import Joint, JointType
from articad_bench.check import Bounds, Check, in_words
from articad_bench.shape_checks import placed
from articad_bench.solids import Round, rounds
from articad_bench.subject import Subject

_LINES: Final = frozenset({JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW})
_POINTS: Final = frozenset({JointType.BALL, JointType.UNIVERSAL})
_PARALLEL: Final = 1e-6  # sine of the angle below which two lines have no crossing
SAME_DIAMETER: Final = 0.02
SAME_DIRECTION: Final = 0.02  # sine of the angle between two axes

_Place = tuple[FloatArray, FloatArray | None]
"""A point, and the direction of the line through it; None where the joint has a centre and no line."""


class Links(Check):
    """A number of bodies have two joints whose axes lie this far apart [mm]: pins of a bar, the throw of a crank, pivots of a base.

    What is fixed together is one body. Axes count as lines, so where along its axis a connector lies does not matter; ball and universal
    joints count by their centres. Slides have no place and do not count.
    """

    kind: Literal["links"] = "links"
    mm: float
    number: Bounds = (1, 999)
    tolerance: float = 0.01

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} bodies with joints {self.mm:g} mm apart, within {100 * self.tolerance:g} %"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = spacings(subject)
        count = sum(any(abs(mm - self.mm) <= self.tolerance * self.mm for mm in apart) for apart in found.values())
        told = "; ".join(f"{name} {', '.join(f'{mm:.4g}' for mm in sorted(set(apart))[:6])}" for name, apart in list(found.items())[:12])
        return self.number[0] <= count <= self.number[1], f"{count} ({told or 'no body has two joints'})"


class Square(Check):
    """Four round holes of one diameter, whichever it is, in one part and direction, lie at the corners of a square with this side [mm]."""

    kind: Literal["square"] = "square"
    mm: float
    tolerance: float = 0.01

    @property
    def wanted(self) -> str:
        return f"four holes on a square of {self.mm:g} mm, within {100 * self.tolerance:g} %"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        holes = [[found for found in rounds(mesh) if found.hollow] for mesh in placed(subject)]
        ok = any(self._at_corners(four) for part in holes for group in _alike(part) for four in combinations(group, 4))
        told = ", ".join(f"{2 * found.radius:.4g}" for found in [found for part in holes for found in part][:12])
        return ok, f"{'a square' if ok else 'no square'} (holes: {told or 'none'})"

    def _at_corners(self, four: tuple[Round, ...]) -> bool:
        """Return whether the six distances of four axes are four sides and two diagonals."""
        apart = sorted(_apart((a.centre, a.axis), (b.centre, b.axis)) for a, b in combinations(four, 2))
        wanted = [self.mm] * 4 + [math.sqrt(2) * self.mm] * 2
        return all(abs(mm - side) <= self.tolerance * side for mm, side in zip(apart, wanted, strict=True))


def _alike(holes: Sequence[Round]) -> list[list[Round]]:
    """Return holes in groups of one diameter and direction."""
    groups: list[list[Round]] = []
    for hole in holes:
        for group in groups:
            same = abs(hole.radius - group[0].radius) <= SAME_DIAMETER * hole.radius
            if same and float(np.linalg.norm(np.cross(hole.axis, group[0].axis))) < SAME_DIRECTION:
                group.append(hole)
                break
        else:
            groups.append([hole])
    return groups


def spacings(subject: Subject) -> dict[str, list[float]]:
    """Return how far apart any two joints of each body lie at rest [mm], for bodies that have two."""
    places: dict[str, list[_Place]] = {}
    for joint in subject.assembly.joints:
        place = _place(subject, joint)
        if place is not None:
            for part in {subject.rigid[joint.parent], subject.rigid[joint.child]}:
                places.setdefault(part, []).append(place)
    return {part: [_apart(a, b) for a, b in combinations(found, 2)] for part, found in places.items() if len(found) > 1}


def _place(subject: Subject, joint: Joint) -> _Place | None:
    frame = subject.rest[joint.parent] @ joint.T_parent_connector
    if joint.type in _POINTS:
        return np.asarray(frame.translation), None
    return (np.asarray(frame.translation), np.asarray(frame.z_axis)) if joint.type in _LINES else None


def _apart(a: _Place, b: _Place) -> float:
    """Return the least distance of two lines, a line and a point, or two points.

    For skew lines it is |(q - p)·(u x v)| / |u x v|; for parallel lines, and for a point and a line, |(q - p) x u|.
    """
    (p, u), (q, v) = a, b
    between = q - p
    if u is not None and v is not None:
        normal = np.cross(u, v)
        sine = float(np.linalg.norm(normal))
        return float(np.linalg.norm(np.cross(between, u))) if sine < _PARALLEL else abs(float(between @ normal)) / sine
    line = v if u is None else u
    return float(np.linalg.norm(between if line is None else np.cross(between, line)))
