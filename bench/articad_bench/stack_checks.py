"""Check of a stack of sizes: what is left between its pieces stays within bounds wherever each size lies in its tolerance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, Literal, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.errors import PlanError
from articad.plan.fields import PlanObject
from articad.plan.iso2768 import ToleranceClass, deviation
from articad_bench.check import Bounds, Check, Vector, in_words
from articad_bench.module_checks import middle_along
from articad_bench.subject import Subject
from articad_bench.wanted import JointWanted, in_numbers

FACING: Final = 0.999  # cosine of the lean of a face across the line
LINES: Final = 200  # that are looked at
SAME_MM: Final = 0.05  # lines so near each other are one
ROUNDED: Final = 2e-4  # mm: what becomes of lengths in a file of single precision
FLAT_MM2: Final = 1e-12  # a triangle that is seen from its edge has no more area
GRAZED: Final = 0.01  # cosine of the lean of a triangle along a line: where the line crosses it, the mesh decides whether it is in the part


class Piece(PlanObject):
    """A piece of a stack.

    Attributes:
        mm: Bounds of its length along the line, by which it is found.
        off: How far its maker may be off, below and above [mm].
        general: Class of ISO 2768-1 in place of `off`, for pieces without a tolerance of their own.
    """

    mm: Bounds
    off: Bounds = (0.0, 0.0)
    general: ToleranceClass | None = None

    def limits(self, length: float) -> Bounds:
        """Return how far a length may be off, below and above [mm].

        Raises:
            PlanError: If the standard states no deviation for it.
        """
        return self.off if self.general is None else _general(self.general, length)


class Play(PlanObject):
    """The play that the declared fit of a joint permits, counted so many times: half the difference of two diameters, once."""

    joint: JointWanted
    times: float = 1.0


class Stack(Check):
    """What is left in a stack is within bounds [mm], in the worst case: every size anywhere in its tolerance, and every fit anywhere in its limits.

    A line in one direction crosses the pieces one after the other, between two faces that hold them; neighbours are different parts. What is left is the distance of these faces
    without the lengths of the pieces, wherever these lie; the line on which least is left counts. The deviations of all lengths are added up. The
    play of joints is added to it, from the limits of the fits that the product declares; it has to keep them as it is modelled.

    Attributes:
        along: Direction of the line.
        pieces: In the order in which the line crosses them, from either end.
        between: How far the distance of the two faces may be off: a class of ISO 2768-1, or below and above [mm].
        sides: Direction along which such stacks lie on both sides of the middle of a piece: a strip on each wall. None where one is enough.
        plays: Joints whose play adds to it.
        mm: Bounds of what is left.
    """

    kind: Literal["stack"] = "stack"
    along: Vector = (0.0, 0.0, 1.0)
    pieces: tuple[Piece, ...] = ()
    between: ToleranceClass | Bounds = (0.0, 0.0)
    sides: Vector | None = None
    plays: tuple[Play, ...] = ()
    mm: Bounds

    @property
    def wanted(self) -> str:
        rows = (
            [f"a stack of {', '.join(in_words(piece.mm) for piece in self.pieces)} mm along {in_numbers(self.along)}"]
            if self.pieces
            else []
        )
        rows += [f"{play.times:g} times the play of {play.joint}" for play in self.plays]
        return f"{in_words(self.mm)} mm left in {' and '.join(rows)}, in the worst case"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        low = high = 0.0
        told = []
        if self.pieces:
            every = stacks_of(subject, self.pieces, np.array(self.along))
            if not every:
                return False, "no line crosses such pieces between two faces"
            if self.sides is not None and not _on_both_sides(subject, every, np.array(self.sides)):
                return False, f"such stacks lie on one side along {in_numbers(self.sides)} alone"
            found = min(every, key=lambda left: left.left)
            between = self.between if isinstance(self.between, tuple) else _general(self.between, found.between)
            limits = [piece.limits(length) for piece, length in zip(self.pieces, found.lengths, strict=True)]
            low = found.left + between[0] - sum(above for _, above in limits)
            high = found.left + between[1] - sum(below for below, _ in limits)
            told.append(f"{found.left:.4g} mm as modelled between {found.faces[0]} and {found.faces[1]}")
        for play in self.plays:
            rows = [_declared(subject, joint.name) for joint in play.joint.found(subject)]
            if not rows or None in rows:
                return False, f"no fit with both limits is declared and kept for {play.joint}"
            kept = [row for row in rows if row is not None]
            low += play.times * min(row[0] for row in kept)
            high += play.times * max(row[1] for row in kept)
            told.append(f"play of {', '.join(f'{a:.4g} to {b:.4g}' for a, b in kept)} mm")
        ok = self.mm[0] - ROUNDED <= low and high <= self.mm[1] + ROUNDED
        return ok, f"{low:.4g} to {high:.4g} mm ({'; '.join(told)})"


def _general(letter: ToleranceClass, length: float) -> Bounds:
    off = deviation(letter, length)
    if off is None:
        raise PlanError(f"ISO 2768-{letter} has no deviation for {length:.4g} mm.")
    return -off, off


def _declared(subject: Subject, joint: str) -> Bounds | None:
    """Return the limits of the play that a joint declares and keeps [mm]; None if it declares no such, or does not keep it."""
    row = next((row for row in subject.declared.rows if row.joint == joint), None)
    if row is None or row.verdict != "ok" or row.declared.gap_min is None or row.declared.gap_max is None:
        return None
    return row.declared.gap_min, row.declared.gap_max


class Left(NamedTuple):
    """What is left of a stack.

    Attributes:
        left: Between all pieces [mm].
        between: Distance of the two faces [mm].
        lengths: Of the pieces [mm].
        faces: The two parts that hold them.
        piece: The part of the first piece.
        place: A point of the line, in the frame of the whole `(3,)` [mm].
    """

    left: float
    between: float
    lengths: tuple[float, ...]
    faces: tuple[str, str]
    piece: str
    place: FloatArray


class _Span(NamedTuple):
    start: float
    end: float
    part: str


def _on_both_sides(subject: Subject, every: Sequence[Left], way: FloatArray) -> bool:
    """Return whether lines lie on both sides of the middle of their first piece."""
    beside = [float(left.place @ way / np.linalg.norm(way)) - middle_along(subject, left.piece, way) for left in every]
    return min(beside) < 0 < max(beside)


def stacks_of(subject: Subject, pieces: Sequence[Piece], along: FloatArray) -> list[Left]:
    """Return what is left on each line that crosses such pieces.

    Args:
        subject: The assembly at rest.
        pieces: In their order, from either end.
        along: Direction of the lines `(3,)`.
    """
    z = along / np.linalg.norm(along)
    u = np.cross(z, [1.0, 0, 0] if abs(z[0]) < 0.9 else [0, 1.0, 0])
    u /= np.linalg.norm(u)
    turn = np.stack([u, np.cross(z, u), z])
    corners = {}
    for name in subject.shaped:
        mesh = subject.assembly.parts[name].mesh
        assert mesh is not None
        corners[name] = (subject.rest[name].apply(mesh.vertices) @ turn.T)[mesh.triangles]
    lines = _lines(corners, pieces)
    rows = zip(*(_spans(name, triangles, lines) for name, triangles in corners.items()), strict=True)
    found: list[Left] = []
    for row, place in zip(rows, lines @ turn[:2], strict=True):
        if None not in row:
            found += _stacks(sorted(span for spans in row if spans is not None for span in spans), pieces, place)
    return found


def _lines(corners: dict[str, FloatArray], pieces: Sequence[Piece]) -> FloatArray:
    """Return where lines cross the faces of parts that may be pieces, seen along the lines, each once `(n, 2)`."""
    points = []
    for triangles in corners.values():
        length = float(np.ptp(triangles[..., 2]))
        if not any(length >= piece.mm[0] - SAME_MM for piece in pieces):
            continue
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        across = triangles[np.abs(normals[:, 2]) > FACING * np.linalg.norm(normals, axis=1)][..., :2]
        middle = across.mean(axis=1)
        points += [middle, *(middle + 0.9 * (across[:, i] - middle) for i in range(3))]
    every = np.concatenate(points) if points else np.zeros((0, 2))
    _, first = np.unique(np.round(every / SAME_MM), axis=0, return_index=True)
    every = every[np.sort(first)]
    return np.asarray(every[:: max(1, -(-len(every) // LINES))])


def _spans(name: str, triangles: FloatArray, lines: FloatArray) -> Iterator[list[_Span] | None]:
    """Yield for each line where it is inside a part; None for a line that runs along the side of it."""
    low, high = triangles[..., :2].min(axis=(0, 1)), triangles[..., :2].max(axis=(0, 1))
    for line in lines:
        if (line < low).any() or (line > high).any():
            yield []
            continue
        flat = triangles[..., :2] - line
        near = ((flat.min(axis=1) <= 0) & (flat.max(axis=1) >= 0)).all(axis=1)
        a, b, c = (flat[near, i] for i in range(3))
        weights = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)], axis=1)
        total = weights.sum(axis=1)
        inside = (np.abs(total) > FLAT_MM2) & ((weights * np.sign(total)[:, None]) >= 0).all(axis=1)
        sides = triangles[near][inside]
        if (np.abs(total[inside]) < GRAZED * np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)).any():
            yield None
            continue
        hits = np.sort((weights[inside] * sides[..., 2]).sum(axis=1) / total[inside])
        hits = hits[np.append(True, np.diff(hits) > ROUNDED)] if len(hits) else hits
        yield [_Span(float(start), float(end), name) for start, end in zip(hits[::2], hits[1::2], strict=False)]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _stacks(spans: Sequence[_Span], pieces: Sequence[Piece], place: FloatArray) -> Iterator[Left]:
    """Yield the stacks of such pieces, in either order, that have a part before and behind them."""
    count = len(pieces)
    for first in range(1, len(spans) - count):
        run = spans[first : first + count]
        before, behind = spans[first - 1], spans[first + count]
        for order in (pieces, pieces[::-1]):
            lengths = [span.end - span.start for span in run]
            if all(piece.mm[0] - ROUNDED <= length <= piece.mm[1] + ROUNDED for piece, length in zip(order, lengths, strict=True)):
                between = behind.start - before.end
                if any(a.part == b.part for a, b in pairwise((before, *run, behind))):
                    continue  # the teeth of a comb are no pieces: what is one part is not stacked
                turned = tuple(lengths if order is pieces else lengths[::-1])
                yield Left(between - sum(lengths), between, turned, (before.part, behind.part), run[0].part, place)
