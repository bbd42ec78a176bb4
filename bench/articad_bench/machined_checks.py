"""Checks of parts as a workshop would inspect them: every round hole and shoulder of a part in its place, and diameters within their tolerances."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final, Literal

import numpy as np
from scipy.optimize import linear_sum_assignment

from articad.arrays import FloatArray
from articad.geometry import TriMesh
from articad.plan.iso286 import limits, parsed_fit
from articad_bench.check import Bounds, Check, in_words
from articad_bench.shape_checks import placed
from articad_bench.solids import Round, rounds
from articad_bench.subject import Subject

PLACE_MM: Final = 0.25  # by which a round may lie beside its place
SIZE_MM: Final = 0.12  # by which diameters and lengths may differ
SIZE_SHARE: Final = 0.004  # of a diameter or length, by which it may differ in addition
VOLUME: Final = 0.005  # of a part's volume: a slot or a flat is seldom more than 2 %
SPREAD: Final = 0.004  # of the radii of gyration of a part
CENTRE: Final = 0.01  # of the diagonal of a part's rounds, by which its centre of mass may lie beside its place
LEAN: Final = 0.9998  # cosine of the angle by which an axis may lean
MEASURED_MM: Final = 0.002  # by which a diameter that is measured on a mesh may be off
_SAME_LINE_MM: Final = 0.05
_MOST_TRIES: Final = 20_000

RoundRow = tuple[float, float, bool, bool, float, float, float, float, float, float]


class Machined(Check):
    """A number of parts have this volume and exactly these round holes and shoulders, each in its place: not one more, one less, or a mirror image.

    How a part's matter is spread about its middle tells a block from another one of the same volume. The frame of a part does not matter: the places are compared after the rigid motion that brings them together best.

    Attributes:
        cm3: Volume.
        spread: Radii of gyration about its principal axes, ascending [mm]; None where any are accepted.
        rounds: Of each cylinder its diameter and length, whether it is a hole, whether the hole is blind, its middle from the part's
            centre of mass, and the direction of its axis.
        number: Of such parts.
    """

    kind: Literal["machined"] = "machined"
    cm3: float
    spread: tuple[float, float, float] | None = None
    rounds: tuple[RoundRow, ...]
    number: Bounds = (1, 1)

    @property
    def wanted(self) -> str:
        holes = ", ".join(f"{row[0]:g} x {row[1]:g}{' blind' if row[3] else ''}" for row in self.rounds if row[2])
        outer = ", ".join(f"{row[0]:g} x {row[1]:g}" for row in self.rounds if not row[2])
        told = "; ".join(each for each in (f"holes {holes}" if holes else "", f"shoulders {outer}" if outer else "") if each)
        spread = "" if self.spread is None else f", radii of gyration {', '.join(f'{mm:.4g}' for mm in self.spread)} mm,"
        return f"{in_words(self.number)} parts of {self.cm3:.4g} cm³{spread} with {told or 'no round hole or shoulder'}, in their places"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        told, count = [], 0
        for name, mesh in zip(subject.shaped, placed(subject), strict=True):
            wrong = self._wrong(mesh)
            count += wrong is None
            told += [] if wrong is None else [f"{name}: {wrong}"]
        return self.number[0] <= count <= self.number[1], f"{count} ({'; '.join(told[:8]) or 'all are'})"

    def _wrong(self, mesh: TriMesh) -> str | None:
        """Return what is wrong with a part; None if it is meant."""
        volume, centre, inertia = mesh.solid_integrals()
        if abs(volume / 1000 - self.cm3) > VOLUME * self.cm3:
            return f"{volume / 1000:.4g} cm³"
        radii = _gyration(volume, inertia)
        if self.spread is not None and (np.abs(radii - self.spread) > SPREAD * np.array(self.spread)).any():
            return f"radii of gyration {', '.join(f'{mm:.4g}' for mm in radii)} mm"
        found = [_Cylinder.of(each, np.asarray(centre)) for each in rounds(mesh)]
        wanted = [_Cylinder.stored(row) for row in self.rounds]
        missing = _unmatched(wanted, found)
        if missing is not None:
            return missing
        if wanted and not any(_agree(wanted, found, *motion) for motion in _motions(wanted, found)):
            return "a hole or shoulder is not in its place"
        return None


def machined(subject: Subject) -> list[Machined]:
    """Return the check that each kind of part passes: what sheets state of it."""
    checks: list[Machined] = []
    for mesh in placed(subject):
        again = next((index for index, check in enumerate(checks) if check._wrong(mesh) is None), None)  # noqa: SLF001
        if again is not None:
            number = checks[again].number[0] + 1
            checks[again] = checks[again].model_copy(update={"number": (number, number)})
            continue
        volume, centre, inertia = mesh.solid_integrals()
        cylinders = [_Cylinder.of(each, np.asarray(centre)) for each in rounds(mesh)]
        a, b, c = (float(f"{mm:.5g}") for mm in _gyration(volume, inertia))
        checks.append(Machined(cm3=float(f"{abs(volume) / 1000:.5g}"), spread=(a, b, c), rounds=tuple(each.row for each in cylinders)))
    return checks


def _gyration(volume: float, inertia: FloatArray) -> FloatArray:
    """Return the radii of gyration of a solid about its principal axes, ascending `(3,)` [mm], from its volume and moments per density."""
    return np.asarray(np.sqrt(np.abs(np.linalg.eigvalsh(inertia) / volume)))


@dataclass(frozen=True, eq=False)
class _Cylinder:
    diameter: float
    length: float
    hollow: bool
    blind: bool
    middle: FloatArray
    axis: FloatArray

    @classmethod
    def of(cls, found: Round, centre: FloatArray) -> _Cylinder:
        return cls(2 * found.radius, found.length, found.hollow, found.blind, found.centre - centre, found.axis)

    @classmethod
    def stored(cls, row: RoundRow) -> _Cylinder:
        return cls(row[0], row[1], row[2], row[3], np.array(row[4:7]), np.array(row[7:10]))

    @property
    def row(self) -> RoundRow:
        places = [round(float(value), 3) + 0.0 for value in self.middle]
        axis = [round(float(value), 5) + 0.0 for value in self.axis]
        return (round(self.diameter, 3), round(self.length, 3), self.hollow, self.blind, *places, *axis)  # type: ignore[return-value]

    def is_like(self, other: _Cylinder) -> bool:
        return (
            self.hollow == other.hollow
            and self.blind == other.blind
            and abs(self.diameter - other.diameter) <= SIZE_MM + SIZE_SHARE * self.diameter
            and abs(self.length - other.length) <= SIZE_MM + SIZE_SHARE * self.length
        )

    def ends(self) -> tuple[FloatArray, FloatArray]:
        half = max(self.length / 2, 1.0) * self.axis
        return self.middle - half, self.middle + half

    def __str__(self) -> str:
        name = ("blind hole" if self.blind else "hole") if self.hollow else "shoulder"
        return f"{name} {self.diameter:.4g} x {self.length:.4g}"


def _unmatched(wanted: Sequence[_Cylinder], found: Sequence[_Cylinder]) -> str | None:
    """Return which cylinders are missing or too many, wherever they lie; None if none."""
    alike = np.array([[each.is_like(other) for other in found] for each in wanted], dtype=np.bool_).reshape(len(wanted), len(found))
    rows, columns = linear_sum_assignment(~alike)
    paired = [(row, column) for row, column in zip(rows, columns, strict=True) if alike[row, column]]
    missing = [str(each) for row, each in enumerate(wanted) if row not in {pair[0] for pair in paired}]
    more = [str(each) for column, each in enumerate(found) if column not in {pair[1] for pair in paired}]
    told = [f"lacks {', '.join(missing[:4])}"] if missing else []
    told += [f"has {', '.join(more[:4])} in addition"] if more else []
    return "; ".join(told) or None


def _motions(wanted: Sequence[_Cylinder], found: Sequence[_Cylinder]) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield rotations and shifts that may bring cylinders to their places: those that bring three points of them there.

    The points are the ends of axes and the centre of mass, which is the origin; the three that are chosen span the largest triangle.
    """
    points = [(index, end) for index, each in enumerate(wanted) for end in each.ends()] + [(-1, np.zeros(3))]
    anchors = max(combinations(points, 3), key=lambda three: _span(*(point for _, point in three)))
    places = {index: [end for each in found if each.is_like(wanted[index]) for end in each.ends()] for index, _ in anchors if index >= 0}
    places[-1] = [np.zeros(3)]
    (i, a), (j, b), (k, c) = anchors
    near = 4 * PLACE_MM
    tries = 0
    for p in places[i]:
        for q in places[j]:
            if abs(float(np.linalg.norm(q - p)) - float(np.linalg.norm(b - a))) > near:
                continue
            for r in places[k]:
                off = abs(float(np.linalg.norm(r - p)) - float(np.linalg.norm(c - a)))
                if max(off, abs(float(np.linalg.norm(r - q)) - float(np.linalg.norm(c - b)))) > near:
                    continue
                tries += 1
                if tries > _MOST_TRIES:  # a field of equal holes: no further motion is tried
                    return
                yield _motion(np.array([a, b, c]), np.array([p, q, r]))


def _span(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    return float(np.linalg.norm(np.cross(b - a, c - a)))


def _motion(here: FloatArray, there: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the proper rotation and the shift that bring three points to three others best (Kabsch); about points on a line, any turn."""
    middle, other = here.mean(axis=0), there.mean(axis=0)
    u, _, v = np.linalg.svd((here - middle).T @ (there - other))
    proper = np.diag([1.0, 1.0, np.sign(np.linalg.det(v.T @ u.T))])
    rotation = v.T @ proper @ u.T
    return rotation, other - rotation @ middle


def _agree(wanted: Sequence[_Cylinder], found: Sequence[_Cylinder], rotation: FloatArray, shift: FloatArray) -> bool:
    """Return whether a rigid motion brings every cylinder, and the centre of mass, to its place."""
    ends = np.concatenate([each.ends() for each in wanted])
    if float(np.linalg.norm(shift)) > max(2 * PLACE_MM, CENTRE * float(np.linalg.norm(np.ptp(ends, axis=0)))):
        return False
    apart = np.full((len(wanted), len(found)), 1e6)
    for row, each in enumerate(wanted):
        place, axis = rotation @ each.middle + shift, rotation @ each.axis
        for column, other in enumerate(found):
            if each.is_like(other) and abs(float(axis @ other.axis)) > LEAN:
                apart[row, column] = float(np.linalg.norm(other.middle - place))
    rows, columns = linear_sum_assignment(apart)
    return bool((apart[rows, columns] <= PLACE_MM).all())


class Toleranced(Check):
    """A number of pins in bores of two parts have diameters within the limits of an ISO 286 fit.

    Attributes:
        nominal: Diameter [mm].
        bore: Class of the bore, such as H7.
        pin: Class of the pin, such as f7.
        number: Of such pairs.
    """

    kind: Literal["toleranced"] = "toleranced"
    nominal: float
    bore: str
    pin: str
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} pins in bores within {self.nominal:g} {self.bore}/{self.pin}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        near = 0.1 * self.nominal
        every = [
            (part, found)
            for part, mesh in zip(subject.shaped, placed(subject), strict=True)
            for found in rounds(mesh)
            if abs(2 * found.radius - self.nominal) < near
        ]
        pairs = [(a, b) for p, a in every for q, b in every if p != q and a.hollow and not b.hollow and _is_pin_in(b, a)]
        count = sum(self._is_within(2 * a.radius, self.bore) and self._is_within(2 * b.radius, self.pin) for a, b in pairs)
        told = ", ".join(f"{2 * b.radius:.4f} in {2 * a.radius:.4f}" for a, b in pairs[:8])
        return self.number[0] <= count <= self.number[1], f"{count} ({told or 'no pin in a bore'})"

    def _is_within(self, diameter: float, name: str) -> bool:
        lower, upper = limits(name, self.nominal)
        return lower - MEASURED_MM <= diameter - self.nominal <= upper + MEASURED_MM


def _is_pin_in(pin: Round, bore: Round) -> bool:
    """Return whether a pin lies on the axis of a bore, and reaches into it."""
    if abs(float(pin.axis @ bore.axis)) < LEAN:
        return False
    between = pin.centre - bore.centre
    along = float(between @ bore.axis)
    beside = float(np.linalg.norm(between - along * bore.axis))
    return beside <= _SAME_LINE_MM and abs(along) < (pin.length + bore.length) / 2


def fits_stated(subject: Subject) -> list[Toleranced]:
    """Return a check of each ISO 286 fit that the joints of a plan declare."""
    found: dict[tuple[float, str, str], int] = {}
    for fit in subject.assembly.fits.values():
        iso = None if fit.name is None else parsed_fit(fit.name)
        if iso is not None and fit.nominal is not None:
            key = (fit.nominal, iso.hole, iso.shaft)
            found[key] = found.get(key, 0) + 1
    return [Toleranced(nominal=nominal, bore=bore, pin=pin, number=(count, 999)) for (nominal, bore, pin), count in found.items()]
