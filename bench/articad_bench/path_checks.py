"""Checks of paths: what runs straight, what moves without turning, what turns in proportion, while the drivers move one by one."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final, Literal

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.kinematics.joints import JointType
from articad_bench.check import Bounds, Check, in_words, within
from articad_bench.subject import Subject

PATH: Final = 121  # values of a driver at which a path is measured
SPEEDS: Final = 7  # values of a driver at which speeds are compared
STILL: Final = 1e-6  # rad per rad or mm of the driver: slower does not turn
SUNK_MM: Final = 0.5  # by which what rolls or lies on the floor may come below it
SAME_PLACE: Final = 1e-6  # share of a path's extent by which the ends of a closed one may lie apart
LEVEL_RAD: Final = math.radians(0.1)  # by which what does not turn may turn


class Straight(Check):
    """A joint that nothing guides runs along a straight line, never farther from it than `off`, over this many mm."""

    kind: Literal["straight"] = "straight"
    mm: Bounds
    off: float

    @property
    def wanted(self) -> str:
        return f"a joint's centre runs straight over {in_words(self.mm)} mm, within {self.off:g} mm"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        best = max((_straight(_endless(path), self.off) for path in _paths(subject)), default=0.0)
        return within(best, self.mm), f"{best:.4g} mm"


class Level(Check):
    """A number of parts move by this much without turning, the distance of their two farthest places counting."""

    kind: Literal["level"] = "level"
    mm: Bounds
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} parts move by {in_words(self.mm)} mm without turning"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        moved = dict.fromkeys(subject.shaped, 0.0)
        for poses in _strokes(subject):
            for column, name in enumerate(subject.assembly.mechanism.parts):
                if name in moved and float(np.max(poses[:, column].angle_to(subject.rest[name]))) <= LEVEL_RAD:
                    moved[name] = max(moved[name], _farthest(poses[:, column].translation))
        found = {name: distance for name, distance in moved.items() if within(distance, self.mm)}
        told = ", ".join(f"{name} {distance:.4g}" for name, distance in moved.items() if distance > 1e-6)
        return self.number[0] <= len(found) <= self.number[1], f"{len(found)} ({told or 'none moves without turning'})"


class Floor(Check):
    """While the drivers move one by one, nothing comes lower than what the product stands on at rest."""

    kind: Literal["floor"] = "floor"

    @property
    def wanted(self) -> str:
        return "nothing goes through the floor while it moves"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        ground, lowest = float(subject.corners(subject.rest)[0, 2]), 0.0
        for poses in _strokes(subject):
            for column, name in enumerate(subject.assembly.mechanism.parts):
                if name in subject.shaped:
                    heights = np.tensordot(poses[:, column].rotation[:, 2], subject.hull(name), axes=(1, 1)).min(axis=1)
                    lowest = min(lowest, float((heights + poses[:, column].translation[:, 2]).min()) - ground)
        return lowest >= -SUNK_MM, f"{abs(lowest):.3g} mm below it"


class Turns(Check):
    """A number of parts turn `ratio` times as fast as some other part, in the frame of the whole, about parallel axes, all the way.

    `longer` requires that they are the longer ones of both, or the shorter ones, by the longest side.
    """

    kind: Literal["turns"] = "turns"
    ratio: float
    number: Bounds = (1, 999)
    tolerance: float = 0.005
    longer: bool | None = None

    @property
    def wanted(self) -> str:
        told = "" if self.longer is None else " longer" if self.longer else " shorter"
        return f"{in_words(self.number)}{told} parts turn {self.ratio:g} times as fast as another, within {100 * self.tolerance:g} %"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        best, told = 0, "nothing turns"
        length = np.array([subject.boxes(name).max() for name in _shaped(subject)]) if self.longer is not None else np.empty(0)
        for speeds in _speeds(subject):
            size = np.linalg.norm(speeds, axis=2)
            for column in range(speeds.shape[1]):
                if size[:, column].min() < STILL:
                    continue
                wanted = self.ratio * speeds[:, column, None]
                off = np.linalg.norm(speeds - wanted, axis=2) / np.linalg.norm(wanted, axis=2)
                alike = off.max(axis=0) <= self.tolerance
                if self.longer is not None:
                    alike &= (length > length[column]) == self.longer
                count = int(np.sum(alike))
                if count > best or told == "nothing turns":
                    best, told = count, ", ".join(f"{s:.4g}" for s in size.mean(axis=0) / size[:, column].mean())
        return self.number[0] <= best <= self.number[1], f"{best} ({told})"


def _shaped(subject: Subject) -> list[str]:
    """Return the parts that have a shape, in the order of poses."""
    return [name for name in subject.assembly.mechanism.parts if name in subject.shaped]


def _speeds(subject: Subject) -> Iterator[FloatArray]:
    """Yield how fast the shaped parts turn, per unit of each driver, at places along its range `(SPEEDS, parts, 3)`."""
    assembly = subject.assembly
    rows = [assembly.mechanism.parts.index(name) for name in _shaped(subject)]
    for column, driver in enumerate(assembly.drivers):
        reached = subject.driver_range(driver.name)
        if reached is None:
            continue
        q = np.repeat(np.array(assembly.mechanism.rest)[None], SPEEDS, axis=0)
        q[:, column] = reached[0] + (reached[1] - reached[0]) * np.linspace(0.05, 0.95, SPEEDS)
        step = 1e-5 * (reached[1] - reached[0])
        there = q.copy()
        there[:, column] += step
        turned = assembly.poses(there)[:, rows] @ assembly.poses(q)[:, rows].inverse()
        yield np.asarray(turned.log()[..., 3:] / step)


def _strokes(subject: Subject) -> Iterator[SE3]:
    """Yield the poses of all parts along each driver's range, the other drivers at rest `(PATH, N)`."""
    assembly = subject.assembly
    for column, driver in enumerate(assembly.drivers):
        stroke = subject.stroke(driver.name, PATH)
        if not len(stroke):
            continue
        q = np.repeat(np.array(assembly.mechanism.rest)[None], PATH, axis=0)
        q[:, column] = stroke
        yield assembly.poses(q)


def _paths(subject: Subject) -> Iterator[FloatArray]:
    """Yield where the centres of joints come by whose bodies no slide guides, nor one that is fixed to them `(PATH, 3)` [mm]."""
    assembly = subject.assembly
    slides = {JointType.SLIDER, JointType.CYLINDRICAL, JointType.PLANAR}
    guided = {subject.rigid[part] for joint in assembly.joints if joint.type in slides for part in (joint.parent, joint.child)}
    rows = {name: row for row, name in enumerate(assembly.mechanism.parts)}
    for poses in _strokes(subject):
        for joint in assembly.joints:
            if subject.rigid[joint.parent] not in guided and subject.rigid[joint.child] not in guided:
                yield (poses[:, rows[joint.child]] @ joint.T_child_connector).translation


def _endless(path: FloatArray) -> FloatArray:
    """Return a path twice, one behind the other, if its ends meet: a crank's may begin anywhere, also in the middle of what is straight."""
    meet = float(np.linalg.norm(path[-1] - path[0])) <= SAME_PLACE * _farthest(path)
    return np.concatenate([path, path[1:]]) if meet else path


def _straight(path: FloatArray, off: float) -> float:
    """Return the length of the longest chord that a stretch of a path stays near."""
    longest = 0.0
    for start in range(0, len(path) - 2, 2):
        chords = path[start + 1 :] - path[start]
        lengths = np.linalg.norm(chords, axis=1)
        for end in np.argsort(-lengths):
            if lengths[end] <= longest:
                break
            between, along = path[start : start + end + 2] - path[start], chords[end] / lengths[end]
            if float(np.linalg.norm(between - np.outer(between @ along, along), axis=1).max()) <= off:
                longest = float(lengths[end])
                break
    return longest


def _farthest(points: FloatArray) -> float:
    return float(np.linalg.norm(points[:, None] - points[None], axis=2).max())
