"""Checks of what a product does: it can be put together, moved with little force, folded, and brought through an opening."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise, permutations, product
from typing import Final, Literal, NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors import SE3
from articad.disassembly.steps import AssemblyOrder
from articad.errors import KinematicsError, LimitError
from articad.kinematics.dynamics import GRAVITY
from articad.kinematics.joints import Joint, JointType
from articad_bench.check import Bounds, Check, in_words, within
from articad_bench.strength_checks import level_tops
from articad_bench.subject import Subject
from articad_bench.wanted import JointWanted

G: Final = -GRAVITY[2]  # m/s²
BY_FORCE: Final = frozenset({"snap", "press", "circlip"})  # fastenings whose parts are in each other's way until they are forced
STROKE: Final = 41  # values of a driver at which its effort is measured
STEP: Final = 1e-3  # of a driver's range, over which energies are compared
STILL: Final = 1e-9  # rad or mm: a joint that moves by less does not follow
LIFTED_MM: Final = 0.01  # a part that a driver raises or lowers by less stays on its level
POSES: Final = {1: 13, 2: 7, 3: 5, 4: 4}  # values of each of so many drivers at which a product is measured; of more, both ends and rest
MOST_DRIVERS: Final = 6  # that are combined with each other
MOST_IN_TURN: Final = 3  # drivers that are moved one after the other, in every order
TRIED: Final = 4  # poses of the least boxes that are tried for a way there


class PutTogether(Check):
    """Parts go to their places one after the other, along paths that are free of collisions; a number of steps may need force.

    Straight paths are proven, and the turns of a part into a thread are sampled. A step needs force where two parts are pressed or snapped
    together, or a circlip is sprung into its groove, and the two would otherwise be in each other's way. Pairs that are said to be bought as one
    count as such steps as well: who is judged does not say what is allowed.
    """

    kind: Literal["put_together"] = "put_together"
    force: int = 0

    @property
    def wanted(self) -> str:
        return f"an order in which it is put together, {self.force or 'no'} steps by force at most"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        order = subject.assembly.assembly_order()
        forced = _forced(subject, order)
        pressed = [joint.name for joint in subject.assembly.joints if joint.fastening in BY_FORCE]
        if pressed and not (order.ok and forced <= self.force):  # the order may have used force where another one needs none
            gentle = subject.assembly.assembly_order(dict.fromkeys(pressed, "adhesive"))
            order, forced = (gentle, _forced(subject, gentle)) if gentle.ok else (order, forced)
        blocked = "; ".join(finding.message for finding in order.findings)
        told = f"{len(order.steps)} steps, {forced} by force" if order.ok else blocked or f"not known of {', '.join(order.left_out)}"
        return order.ok and forced <= self.force, told


def _forced(subject: Subject, order: AssemblyOrder) -> int:
    """Return how many steps of an order need force; pairs that are bought as one count as well."""
    forced = sum(any(row[2] in BY_FORCE for row in step.permitted) for step in order.steps)
    return forced + sum(joint.fastening == "purchased" for joint in subject.assembly.joints)


class Effort(Check):
    """A number of joints are held against gravity, at any pose of their range, by a force or torque whose largest value is within bounds [N, N m].

    Virtual work: while a mechanism without friction stands still, the effort at a joint is the change of the potential energy of all parts by
    the change of this joint, whichever joint drives. A part of which no mass is known weighs what water does. Loops and couplings are closed.
    The other drivers are at rest, and once more at either end of their ranges.

    Attributes:
        most: Bounds of the largest effort over all poses.
        load: Mass on the middle of the highest level surface of what moves [kg].
        by_hand: Whether the torque is divided by the distance of the farthest point of the moved body from the axis: the force of a hand there [N].
        number: Of the joints for which this holds.
    """

    kind: Literal["effort"] = "effort"
    joint: JointWanted
    most: Bounds
    load: float = 0.0
    by_hand: bool = False
    number: Bounds = (1, 999)

    @property
    def unit(self) -> str:
        """The unit of the bounds."""
        return "N" if self.by_hand or self.joint.type is JointType.SLIDER else "N m"

    @property
    def wanted(self) -> str:
        load = f" with {self.load:g} kg on it" if self.load else ""
        hand = ", by a hand at its end," if self.by_hand else ""
        return f"{in_words(self.number)} joints ({self.joint}) whose largest effort{hand} is {in_words(self.most)} {self.unit}{load}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [(joint.name, largest_effort(subject, joint, self.load)) for joint in self.joint.found(subject)]
        efforts = [(name, effort / (_reach(subject, name) if self.by_hand else 1.0)) for name, effort in found if effort is not None]
        count = sum(within(effort, self.most) for _, effort in efforts)
        told = ", ".join(f"{name} {effort:.4g} {self.unit}" for name, effort in efforts)
        return self.number[0] <= count <= self.number[1], f"{count} ({told or 'no such joint moves'})"


def largest_effort(subject: Subject, joint: Joint, load: float = 0.0) -> float | None:
    """Return the largest force [N] or torque [N m] that holds a joint against gravity over its range; None if no driver moves it.

    Args:
        subject: The assembly.
        joint: One with a single coordinate.
        load: Mass on the highest level surface of what moves [kg].
    """
    drivers = [driver.name for driver in subject.assembly.drivers]
    ranges = {name: subject.driver_range(name) for name in drivers}
    column = next((i for i, c in enumerate(subject.assembly.mechanism.coordinates) if c.joint == joint.name), None)
    if column is None or len(joint.type.coordinates) != 1:
        return None
    unit = 1e-3 if joint.type is JointType.SLIDER else 1.0  # m per mm
    largest: float | None = None
    for index, name in enumerate(drivers):
        reached = ranges[name]
        if reached is None or reached[0] == reached[1]:
            continue
        others = [(i, end) for i, other in enumerate(drivers) if i != index and (ends := ranges[other]) is not None for end in ends]
        loaded = _loaded(subject, index, reached, load)
        for i, end in [(index, 0.0), *others]:
            points, step = _points(reached)
            q = np.repeat(np.array(subject.assembly.mechanism.rest)[None], len(points), axis=0)
            q[:, i] = end
            q[:, index] = points
            work, moved = _changes(subject, q, index, step, column, loaded)
            follows = np.abs(moved) > max(STILL, 1e-6 * float(np.abs(moved).max(initial=0.0)))
            if follows.any():
                here = float(np.abs(work[follows] / (moved[follows] * unit)).max())
                largest = here if largest is None else max(largest, here)
    return largest


class _Load(NamedTuple):
    """A mass [kg] that lies on a point of a part [mm], given in the part's frame."""

    mass: float
    part: str
    point: FloatArray


def _points(reached: tuple[float, float]) -> tuple[FloatArray, float]:
    """Return values of a driver, and half the step over which energies are compared; the very ends may be dead points."""
    width = reached[1] - reached[0]
    return np.linspace(reached[0] + 2 * STEP * width, reached[1] - 2 * STEP * width, STROKE), STEP * width / 2


def _changes(subject: Subject, q: FloatArray, driver: int, step: float, column: int, load: _Load | None) -> tuple[FloatArray, FloatArray]:
    """Return by how much energy [J] and a coordinate change about each configuration that is reached `(n,)`."""
    ends = []
    for side in (-step, step):
        moved = q.copy()
        moved[:, driver] += side
        ends.append(subject.assembly.solve(moved))
    kept = ends[0].reached & ends[1].reached
    energies = [_energies(subject, solution.poses, load)[kept] for solution in ends]
    values = [solution.columns[kept, column] for solution in ends]
    return energies[1] - energies[0], values[1] - values[0]


def _energies(subject: Subject, poses: SE3, load: _Load | None) -> FloatArray:
    """Return the potential energy at each configuration [J] `(n,)`."""
    mechanism = subject.assembly.mechanism
    total = np.zeros(poses.translation.shape[:-2])
    for index, name in enumerate(mechanism.parts):
        mass = subject.mass(name)
        if mass is not None:
            total = total + G * mass.mass * poses[..., index].apply(np.asarray(mass.com))[..., 2] * 1e-3
        if load is not None and load.part == name:
            total = total + G * load.mass * poses[..., index].apply(load.point)[..., 2] * 1e-3
    return np.asarray(total)


def _loaded(subject: Subject, driver: int, reached: tuple[float, float], load: float) -> _Load | None:
    """Return a load on the middle of the highest level surface of those parts that a driver raises or lowers."""
    if not load:
        return None
    q = np.repeat(np.array(subject.assembly.mechanism.rest)[None], 2, axis=0)
    q[:, driver] = np.add(reached, np.array([0.25, -0.25]) * (reached[1] - reached[0]))
    solution, tops = subject.assembly.solve(q), []
    for index, name in enumerate(subject.assembly.mechanism.parts):
        if name not in subject.shaped:
            continue
        middle = subject.hull(name).mean(axis=0)
        lower, upper = (float(solution.poses[row, index].apply(middle)[2]) for row in range(2))
        if abs(upper - lower) > LIFTED_MM:
            tops += level_tops(subject, name)
    best = max(tops, key=lambda top: (round(top.height, 2), top.area), default=None)
    if best is None:
        return None
    return _Load(load, best.part, np.asarray(subject.rest[best.part].inverse().apply(best.centre)))


def _reach(subject: Subject, name: str) -> float:
    """Return the distance of the farthest point of the body that a joint moves from its axis at rest [m]."""
    joint = next(joint for joint in subject.assembly.joints if joint.name == name)
    frame = subject.rest[joint.parent] @ joint.T_parent_connector
    ground = subject.rigid[subject.assembly.ground]
    moved = next(body for body in (subject.rigid[joint.child], subject.rigid[joint.parent]) if body != ground)
    far = 0.0
    for part in (part for part in subject.shaped if subject.rigid[part] == moved):
        points = subject.rest[part].apply(subject.assembly.parts[part].mesh.vertices)  # type: ignore[union-attr]
        far = max(far, float(np.linalg.norm(np.cross(points - frame.translation, frame.z_axis), axis=1).max()))
    return far * 1e-3


class Folds(Check):
    """At some pose of its range it fits into a box, and comes there from rest without a collision; at another it is at least so large [mm].

    Sides are those of the box along the axes, each list by size: the least with the least, any as 0. The way from rest is sampled, not proven.
    """

    kind: Literal["folds"] = "folds"
    into: tuple[float, float, float]
    opens: tuple[float | None, float | None, float | None] = (None, None, None)

    @property
    def wanted(self) -> str:
        large = " x ".join("any" if side is None else f"{side:g}" for side in self.opens)
        return f"folds into {' x '.join(f'{side:g}' for side in self.into)} mm, and is {large} mm or more at another pose"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        rows = list(poses_of(subject))
        sides = np.array([np.sort(row.sides) for row in rows])
        least = sorted((side or 0.0) for side in self.opens)
        open_ = bool((sides >= np.array(least) - SLACK_MM).all(axis=1).any())
        fits = [row for row, side in zip(rows, sides, strict=True) if (side <= np.sort(self.into) + SLACK_MM).all()]
        smallest = min(rows, key=lambda row: float(np.prod(row.sides)))
        told = f"{_by(smallest.sides)} mm at the least, {_by(sides.max(axis=0))} mm at the most"
        if not fits or not open_:
            return False, told
        fits.sort(key=lambda row: float(np.prod(row.sides)))
        there = next((row for row in fits[:TRIED] if comes_to(subject, row.q)), None)
        return there is not None, told if there is not None else f"{told}, but parts collide on the way there"


class Passes(Check):
    """It passes upright through an opening, at rest, or at some pose of its range if it is folded for that [mm].

    It may be turned about the upright axis: the least distance of two upright planes that hold it decides. `along` says which of its axes points
    through the opening, if that is stated.
    """

    kind: Literal["passes"] = "passes"
    opening: tuple[float, float]
    along: Literal["x", "y"] | None = None
    folded: bool = False

    @property
    def wanted(self) -> str:
        way = f", {self.along} ahead" if self.along else ""
        return f"passes through {self.opening[0]:g} x {self.opening[1]:g} mm{way}{', folded' if self.folded else ''}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        rows = (
            list(poses_of(subject))
            if self.folded
            else [_Posed(np.array(subject.assembly.mechanism.rest), subject.size, _outline(subject, subject.rest.stacked))]
        )
        found = [(self._width(row), float(row.sides[2]), row) for row in rows]
        passing = [row for row in found if row[0] <= self.opening[0] + SLACK_MM and row[1] <= self.opening[1] + SLACK_MM]
        width, height, _ = min(passing or found, key=lambda row: (row[0], row[1]))
        told = f"{width:.4g} mm wide, {height:.4g} mm high"
        passing.sort(key=lambda row: row[0])
        if passing and self.folded and not any(comes_to(subject, row[2].q) for row in passing[:TRIED]):
            return False, f"{told}, but parts collide on the way there"
        return bool(passing), told

    def _width(self, row: _Posed) -> float:
        if self.along is not None:
            return float(row.sides[1 - "xy".index(self.along)])
        return least_width(row.outline)


SLACK_MM: Final = 0.01  # by which a mesh may be larger than its solid


class _Posed(NamedTuple):
    """A pose of the drivers `(nq,)`, the sides of the box there `(3,)` and the outline seen from above `(n, 2)` [mm]."""

    q: FloatArray
    sides: FloatArray
    outline: FloatArray


def poses_of(subject: Subject) -> Iterator[_Posed]:
    """Yield rest, and every combination of values of the drivers that loops allow."""
    assembly = subject.assembly
    rest = np.array(assembly.mechanism.rest)
    yield _Posed(rest, subject.size, _outline(subject, subject.rest.stacked))
    choices: list[list[float]] = []
    moving = [i for i, driver in enumerate(assembly.drivers) if (reached := subject.driver_range(driver.name)) and reached[0] < reached[1]]
    for index, driver in enumerate(assembly.drivers):
        reached = subject.driver_range(driver.name)
        if index not in moving[:MOST_DRIVERS] or reached is None:
            choices.append([rest[index]])
        else:
            choices.append([*np.linspace(*reached, POSES.get(len(moving), 2)), rest[index]])
    if not moving:
        return
    q = np.unique(np.array(list(product(*choices))), axis=0)
    solution = assembly.solve(q)
    for row in np.flatnonzero(solution.reached):
        poses = solution.poses[int(row)]
        low, high = _ends(subject, poses)
        yield _Posed(q[row], high - low, _outline(subject, poses))


def _points_of(subject: Subject, poses: SE3) -> FloatArray:
    """Return the corners of the convex hulls of all parts at a pose `(n, 3)` [mm]."""
    parts = subject.assembly.mechanism.parts
    return np.concatenate([poses[parts.index(name)].apply(subject.hull(name)) for name in subject.shaped])


def _ends(subject: Subject, poses: SE3) -> tuple[FloatArray, FloatArray]:
    points = _points_of(subject, poses)
    return points.min(axis=0), points.max(axis=0)


def _outline(subject: Subject, poses: SE3) -> FloatArray:
    return _points_of(subject, poses)[:, :2]


def least_width(outline: FloatArray) -> float:
    """Return the least distance of two parallel lines that hold points between them [mm]; one of them lies along an edge of the hull."""
    try:
        corners = outline[ConvexHull(outline).vertices]
    except QhullError:
        return 0.0
    edges = np.roll(corners, -1, axis=0) - corners
    edges /= np.linalg.norm(edges, axis=1)[:, None]
    across = corners @ np.stack([-edges[:, 1], edges[:, 0]])
    return float(np.ptp(across, axis=0).min())


def comes_to(subject: Subject, q: FloatArray) -> bool:
    """Return whether drivers bring it from rest to a configuration without a collision, together or one after the other; sampled along the way."""
    bare = replace(subject.assembly, fits={})
    rest = np.array(bare.mechanism.rest)
    if not np.abs(q - rest).any():
        return True
    if not bare.check(q).ok:
        return False
    moved = np.flatnonzero(q != rest)
    orders = permutations(moved.tolist()) if len(moved) <= MOST_IN_TURN else iter([moved.tolist()])
    return _is_way(bare, [rest, q]) or any(_is_way(bare, _in_turn(rest, q, order)) for order in orders)


def _in_turn(rest: FloatArray, q: FloatArray, order: Sequence[int]) -> list[FloatArray]:
    """Return the configurations through which drivers go that move one after the other."""
    return [np.where(np.isin(np.arange(len(q)), order[:done]), q, rest) for done in range(len(order) + 1)]


def _is_way(assembly: Assembly, points: Sequence[FloatArray]) -> bool:
    try:
        for start, goal in pairwise(points):
            assembly.path(start, goal, clear=True)
    except (KinematicsError, LimitError):
        return False
    return True


def _by(sides: FloatArray) -> str:
    return " x ".join(f"{float(side):.4g}" for side in sides)
