"""Checks of the shapes of parts, measured on their surfaces: holes, studs, walls, volumes, stability, symmetry."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal

import numpy as np
from scipy.optimize import linear_sum_assignment

from articad.arrays import FloatArray
from articad.geometry import TriMesh
from articad_bench.bodies import moved_bodies
from articad_bench.check import Bounds, Check, Vector, in_words, widened, within
from articad_bench.solids import Round, asymmetry, held_volume, occupied, ray_lengths, rounds, tipping_angle, wall_thickness
from articad_bench.subject import Subject
from articad_bench.wanted import JointWanted

SAME_LEVEL_MM: Final = 0.2
NEAR_WALL: Final = 0.9  # of the radius of a hole
SAME_ROUND: Final = 0.005  # of a diameter: a pin and its bore are told apart
PARALLEL: Final = 1e-6  # sine of the angle below which two axes have no crossing
LEAN: Final = 0.996  # cosine of the 5° by which an axis may lean from the one asked for
BROKEN_EDGE: Final = 1.0  # mm of a round's length that a chamfer or a fillet may take at either end
BROKEN_SHARE: Final = 0.1  # of the length, at most


class _Rounds(Check):
    """A number of cylindrical faces of one diameter, in all parts together, at rest.

    `length` is along the axis, with the edges at both ends, which may be broken by 1 mm or a tenth of it; `axis` is in the frame of the
    whole, `pitch` the distance of each axis from the nearest parallel one of them, `circle` the diameter of the circle on which all axes
    lie. `apart` is a direction in the frame of the whole and the distances, one after
    the other, of the levels on which the axes lie along it; `above` the height of the axes above the lowest point of the whole.
    """

    diameter: float
    number: Bounds
    length: Bounds | None = None
    axis: Vector | None = None
    pitch: float | None = None
    circle: float | None = None
    apart: tuple[Vector, tuple[float, ...]] | None = None
    above: Bounds | None = None
    beside: tuple[float, tuple[float, ...]] | None = None
    tolerance: float = 0.02

    @property
    def wanted(self) -> str:
        also = [f"{in_words(self.length)} mm long" if self.length else "", f"along {self.axis}" if self.axis else ""]
        also += [f"{self.pitch:g} mm apart" if self.pitch else "", f"on a circle of {self.circle:g} mm" if self.circle else ""]
        also += [f"on levels {', '.join(f'{mm:g}' for mm in self.apart[1])} mm apart along {self.apart[0]}" if self.apart else ""]
        also += [f"{in_words(self.above)} mm above the ground" if self.above else ""]
        also += [
            f"{', '.join(f'{mm:g}' for mm in self.beside[1])} mm off the axis of a round of {self.beside[0]:g} mm" if self.beside else ""
        ]
        return f"{in_words(self.number)} {self._name} of {self.diameter:g} mm within {100 * self.tolerance:g} %" + "".join(
            f", {a}" for a in also if a
        )

    @property
    def _name(self) -> str:
        raise NotImplementedError

    def _is(self, found: Round) -> bool:
        raise NotImplementedError

    def measured(self, subject: Subject) -> tuple[bool, str]:
        every = [found for mesh in placed(subject) for found in rounds(mesh) if self._is(found)]
        meant = [found for found in every if self._meant(found)]
        ok = self.number[0] <= len(meant) <= self.number[1]
        told = f"{len(meant)} (all: {', '.join(f'{2 * r.radius:.4g} x {r.length:.4g}' for r in every[:16])})"
        if self.pitch is not None:
            apart = [_nearest(found, meant) for found in meant]
            ok &= bool(apart) and all(abs(mm - self.pitch) <= self.tolerance * self.pitch for mm in apart)
            told += f", {', '.join(f'{mm:.4g}' for mm in sorted(set(apart))[:4])} mm apart"
        if self.circle is not None and meant:
            middle = np.mean([found.centre for found in meant], axis=0)
            circles = [2 * _beside(found, middle) for found in meant]
            ok &= all(abs(mm - self.circle) <= self.tolerance * self.circle for mm in circles)
            told += f", on circles of {', '.join(f'{mm:.4g}' for mm in circles[:4])} mm"
        for fits, words in (*self._levels(subject, meant), *self._beside_others(subject, meant)):
            ok &= fits
            told += words
        return ok, told

    def _beside_others(self, subject: Subject, meant: list[Round]) -> Iterator[tuple[bool, str]]:
        """Yield whether the axes lie as far off others as is asked for, with what is measured in words."""
        if self.beside is None:
            return
        diameter, distances = self.beside
        others = [found for mesh in placed(subject) for found in rounds(mesh) if abs(2 * found.radius - diameter) <= SAME_ROUND * diameter]
        found = [min((_between(each, other) for other in others), default=np.inf) for each in meant]
        lacking = [mm for mm in distances if not any(abs(each - mm) <= self.tolerance * mm for each in found)]
        wrong = [each for each in found if not any(abs(each - mm) <= self.tolerance * mm for mm in distances)]
        yield not lacking and not wrong, f", {', '.join(f'{mm:.4g}' for mm in found[:8])} mm off the axis of a round of {diameter:g} mm"

    def _levels(self, subject: Subject, meant: list[Round]) -> Iterator[tuple[bool, str]]:
        """Yield whether the axes lie on the levels that are asked for, and how high, with what is measured in words."""
        if self.apart is not None:
            way = np.array(self.apart[0]) / np.linalg.norm(self.apart[0])
            found = _steps([float(each.centre @ way) for each in meant])
            ok = len(found) == len(self.apart[1])
            ok = ok and all(abs(mm - wanted) <= self.tolerance * wanted for mm, wanted in zip(found, self.apart[1], strict=True))
            yield ok, f", on levels {', '.join(f'{mm:.4g}' for mm in found)} mm apart"
        if self.above is not None:
            ground = float(subject.corners(subject.rest)[0][2])
            heights = [float(each.centre[2]) - ground for each in meant]
            yield all(within(mm, self.above) for mm in heights), f", {', '.join(f'{mm:.4g}' for mm in heights[:4])} mm above the ground"

    def _meant(self, found: Round) -> bool:
        if abs(2 * found.radius - self.diameter) > self.tolerance * self.diameter:
            return False
        if self.axis is not None and abs(float(found.axis @ np.array(self.axis))) < LEAN * float(np.linalg.norm(self.axis)):
            return False
        return self.length is None or within(found.length, (_shortened(self.length[0]), self.length[1]))


def _shortened(mm: float) -> float:
    """Return how short a round may be that is so long with sharp edges: they may be chamfered or rounded at both of its ends [mm]."""
    return mm - 2 * min(BROKEN_EDGE, BROKEN_SHARE * mm)


class Holes(_Rounds):
    """The number of round holes; `through` requires that they have no bottom."""

    kind: Literal["holes"] = "holes"
    through: bool | None = None

    @property
    def _name(self) -> str:
        return "holes" if self.through is None else "through holes" if self.through else "blind holes"

    def _is(self, found: Round) -> bool:
        return found.hollow and self.through in {None, not found.blind}


class Passage(Check):
    """A straight way along the axis of a round hole goes through the whole at rest, nearly as wide as the hole: nothing walls it up.

    `still` leaves out what moves: a valve that is drawn shut has a passage all the same.
    """

    kind: Literal["passage"] = "passage"
    diameter: float
    axis: Vector
    still: bool = False
    tolerance: float = 0.02

    @property
    def wanted(self) -> str:
        return f"a passage of {self.diameter:g} mm along {self.axis}{', whatever moves in it' if self.still else ''}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        meshes = standing(subject) if self.still else placed(subject)
        holes = [found for mesh in meshes for found in rounds(mesh) if self._is(found)]
        free = sum(_goes_through(meshes, hole, 2 * float(np.linalg.norm(subject.size))) for hole in holes)
        return free > 0, f"{free} of {len(holes)} such holes are part of one"

    def _is(self, found: Round) -> bool:
        along = abs(float(found.axis @ np.array(self.axis))) >= LEAN * float(np.linalg.norm(self.axis))
        return found.hollow and along and abs(2 * found.radius - self.diameter) <= self.tolerance * self.diameter


class Studs(_Rounds):
    """The number of faces that are round outside: pegs, legs, shafts, discs."""

    kind: Literal["studs"] = "studs"

    @property
    def _name(self) -> str:
        return "round outsides"

    def _is(self, found: Round) -> bool:
        return not found.hollow


class Wall(Check):
    """A number of parts whose wall has this thickness under at least this share of their surface, measured straight inwards."""

    kind: Literal["wall"] = "wall"
    mm: Bounds
    share: float = 0.5
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} parts {in_words(self.mm)} mm thick under {100 * self.share:g} % of their surface"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        shares, (low, high) = {}, widened(self.mm)
        for name, mesh in zip(subject.shaped, placed(subject), strict=True):
            thick = wall_thickness(mesh)
            shares[name] = float(((thick >= low) & (thick <= high)).mean())
        count = sum(share >= self.share for share in shares.values())
        return self.number[0] <= count <= self.number[1], f"{count} ({', '.join(f'{n} {100 * s:.0f} %' for n, s in shares.items())})"


class Volume(Check):
    """Volume of matter of the whole."""

    kind: Literal["volume"] = "volume"
    cm3: Bounds

    @property
    def wanted(self) -> str:
        return f"{in_words(self.cm3)} cm³ of material"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        volume = sum(abs(mesh.volume) for mesh in placed(subject)) / 1000
        return within(volume, self.cm3), f"{volume:.4g} cm³"


class Holds(Check):
    """What it holds, filled to the brim, standing as it is; with `joint`, what each body that such a joint moves holds by itself.

    Attributes:
        ml: Bounds of what is held.
        joint: Of the bodies that are meant: drawers.
        without: Leaves out what such joints move: a chest is filled while its lid is away.
        number: Of such bodies.
    """

    kind: Literal["holds"] = "holds"
    ml: Bounds
    joint: JointWanted | None = None
    without: JointWanted | None = None
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        each = "" if self.joint is None else f"{in_words(self.number)} bodies that are moved by {self.joint} each "
        away = "" if self.without is None else f" without what is moved by {self.without}"
        return f"{each}holds {in_words(self.ml)} ml{away}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        held = [held_volume(meshes) / 1000 for meshes in self._vessels(subject) if meshes]
        count = sum(within(ml, self.ml) for ml in held)
        return self.number[0] <= count <= self.number[1], ", ".join(f"{ml:.4g} ml" for ml in held[:12]) or "no such body"

    def _vessels(self, subject: Subject) -> Iterator[list[TriMesh]]:
        """Yield the meshes of each vessel."""
        meshes = dict(zip(subject.shaped, placed(subject), strict=True))
        if self.joint is not None:
            for body in dict.fromkeys(body for joint in self.joint.found(subject) for body in moved_bodies(subject, joint)):
                yield [mesh for name, mesh in meshes.items() if subject.rigid[name] == body]
            return
        away = {body for joint in (self.without.found(subject) if self.without else ()) for body in moved_bodies(subject, joint)}
        yield [mesh for name, mesh in meshes.items() if subject.rigid[name] not in away]


class Stands(Check):
    """It stands freely and tips over only when the ground is inclined by more than this, in any direction."""

    kind: Literal["stands"] = "stands"
    degrees: float = 5.0

    @property
    def wanted(self) -> str:
        return f"stands on ground that leans by {self.degrees:g}°"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        meshes = placed(subject)
        weights = [abs(mesh.volume) * subject.density(name) for name, mesh in zip(subject.shaped, meshes, strict=True)]
        com = np.average([mesh.solid_integrals()[1] for mesh in meshes], axis=0, weights=weights)
        tips = tipping_angle(np.concatenate([mesh.vertices for mesh in meshes]), np.asarray(com))
        return tips >= self.degrees, f"tips at {tips:.1f}°"


class Symmetric(Check):
    """The whole at rest is its own mirror image across an axis, up to this share of it."""

    kind: Literal["symmetric"] = "symmetric"
    axis: Literal["x", "y", "z"]
    tolerance: float = 0.02

    @property
    def wanted(self) -> str:
        return f"symmetric across {self.axis} within {100 * self.tolerance:g} %"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        share = asymmetry(occupied(placed(subject))[0], "xyz".index(self.axis))
        return share <= self.tolerance, f"{100 * share:.2g} % has nothing opposite"


def placed(subject: Subject) -> list[TriMesh]:
    """Return the meshes of the parts that have one, as they are at rest."""
    return [mesh.transformed(subject.rest[name]) for name in subject.shaped if (mesh := subject.assembly.parts[name].mesh) is not None]


def standing(subject: Subject) -> list[TriMesh]:
    """Return the meshes of the parts that do not move, at rest, in the frame of the whole."""
    ground = subject.rigid[subject.assembly.ground]
    return [mesh for name, mesh in zip(subject.shaped, placed(subject), strict=True) if subject.rigid[name] == ground]


def same_parts(first: Subject, second: Subject, slack: float) -> bool:
    """Return whether parts of the same volume fill the same boxes at rest, within a share of the longest side of the whole and of each volume."""
    mine, theirs = placed(first), placed(second)
    if len(mine) != len(theirs):
        return False
    boxes, others = (np.array([mesh.bounds.ravel() for mesh in meshes]) for meshes in (mine, theirs))
    volumes, further = (np.array([abs(mesh.volume) for mesh in meshes]) for meshes in (mine, theirs))
    alike = np.abs(boxes[:, None] - others[None]).max(axis=2) <= slack * float(first.size.max())
    alike &= np.abs(volumes[:, None] - further[None]) <= slack * volumes[:, None]
    return bool(alike[linear_sum_assignment(~alike)].all())


def _steps(places: list[float]) -> list[float]:
    """Return the distances of the levels on which places lie, from the lowest on [mm]."""
    levels: list[float] = []
    for place in sorted(places):
        if not levels or place - levels[-1] > SAME_LEVEL_MM:
            levels.append(place)
    return [float(mm) for mm in np.diff(levels)]


def _goes_through(meshes: list[TriMesh], hole: Round, reach: float) -> bool:
    """Return whether lines along a hole, in its middle and all round near its wall, meet nothing."""
    u = np.cross(hole.axis, [1.0, 0, 0] if abs(hole.axis[0]) < 0.9 else [0, 1.0, 0])
    u /= np.linalg.norm(u)
    angles = np.arange(8) * np.pi / 4 + 0.1
    beside = NEAR_WALL * hole.radius * (np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * np.cross(hole.axis, u))
    starts = hole.centre - reach * hole.axis + np.concatenate([np.full((1, 3), 1e-5), beside])
    ways = np.repeat(hole.axis[None], len(starts), axis=0)
    return all(np.isinf(ray_lengths(mesh, starts, ways)).all() for mesh in meshes)


def _beside(found: Round, point: FloatArray) -> float:
    """Return the distance of a point from an axis [mm]."""
    return float(np.linalg.norm(np.cross(point - found.centre, found.axis)))


def _between(found: Round, other: Round) -> float:
    """Return the distance of two axes, which may be skew [mm]."""
    normal = np.cross(found.axis, other.axis)
    sine = float(np.linalg.norm(normal))
    return _beside(found, other.centre) if sine < PARALLEL else abs(float((other.centre - found.centre) @ normal)) / sine


def _nearest(found: Round, others: list[Round]) -> float:
    beside = [_beside(found, other.centre) for other in others if other is not found and abs(float(found.axis @ other.axis)) > LEAN]
    return min((mm for mm in beside if mm > 0.1), default=float("inf"))
