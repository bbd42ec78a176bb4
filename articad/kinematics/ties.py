"""Couplings, solved once: coupled coordinates are linear in one of them, so they need no iteration and no steps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from articad.arrays import BoolArray, FloatArray, IndexArray
from articad.kinematics.joints import Coupling
from articad.kinematics.layout import Layout

_SAME_RATIO = 1e-7  # relative: two paths of couplings that agree to this are consistent, like RANK_TOLERANCE for equations
_ROUNDING = 1e-13  # of the largest coordinate: residual of couplings from rounding alone


@dataclass(frozen=True, eq=False)
class LinearTie:
    """Coordinates that couplings make linear in one number m: q = factor · m + offset.

    Attributes:
        columns: Of the coordinates.
        freedoms: Of the same coordinates.
        factor: One per coordinate, in its own unit per unit of the first one.
        offset: Likewise.
        fixed: m, if couplings in a ring leave one value only; None if m is free.
    """

    columns: IndexArray
    freedoms: IndexArray
    factor: FloatArray
    offset: FloatArray
    fixed: float | None


class _Followers(NamedTuple):
    """Coupled coordinates that follow one of their tie: q = (q_leader − leader_offset) / leader_factor · factor + offset.

    Attributes:
        columns: Of the coordinates that follow.
        leaders: Columns of the coordinates that lead them.
        leader_offset, leader_factor, factor, offset: One per coordinate that follows.
    """

    columns: IndexArray
    leaders: IndexArray
    leader_offset: FloatArray
    leader_factor: FloatArray
    factor: FloatArray
    offset: FloatArray


class Basis:
    """Independent motions of freedoms: each uncoupled freedom by itself, the members of a tie together.

    Args:
        matrix: `(freedoms, n)`, scaled.
        alone: The freedoms themselves, in order, if none is coupled.
    """

    def __init__(self, matrix: FloatArray, alone: IndexArray | None) -> None:
        self.matrix, self._alone = matrix, alone

    @property
    def size(self) -> int:
        """How many motions there are."""
        return int(self.matrix.shape[1])

    def of(self, J: FloatArray) -> FloatArray:
        """Return the derivatives `(*batch, rows, n)` by the motions from those by freedoms `(*batch, rows, freedoms)`."""
        derivatives: FloatArray = J @ self.matrix if self._alone is None else J.take(self._alone, axis=-1)
        return derivatives

    def step(self, z: FloatArray) -> FloatArray:
        """Return the step `(*batch, freedoms)` of freedoms for motions `(*batch, n)`."""
        if self._alone is None:
            return z @ self.matrix.T
        y = np.zeros((*z.shape[:-1], len(self.matrix)))
        y[..., self._alone] = z
        return y


class Ties:
    """All couplings of a system: the rows q_b − k q_a − c in rad and L, and the motions that they leave.

    Args:
        couplings: Relations between coordinates.
        layout: Layout of the coordinates.
        scale: Size of one scaled unit of each freedom [rad, mm].
        length: L [mm].
        in_loops: Freedoms that move loops: a tie's number is measured by one of them, so that equations are well scaled.

    Attributes:
        all: The ties.
        J: Jacobian of the rows `(couplings, freedoms)`, scaled; constant, because they are linear.
    """

    def __init__(self, couplings: Sequence[Coupling], layout: Layout, scale: FloatArray, length: float, in_loops: BoolArray) -> None:
        self._scale, self._n = scale, layout.n_freedoms
        n = len(couplings)
        by_column, by_freedom, unit = np.zeros((n, layout.n_columns)), np.zeros((n, layout.n_freedoms)), np.ones(n)
        for i, c in enumerate(couplings):
            a, b = layout.column_of[c.a], layout.column_of[c.b]
            by_column[i, b], by_column[i, a] = 1.0, -c.ratio
            by_freedom[i, layout.freedom_of(b)], by_freedom[i, layout.freedom_of(a)] = 1.0, -c.ratio
            if layout.coordinates[b].unit == "mm":
                unit[i] = length
        self._columns, self._offset, self._unit = by_column.T, np.array([c.offset for c in couplings]), unit
        self.J: FloatArray = by_freedom * scale / unit[:, None]
        self.all = tuple(_ties(couplings, layout, in_loops))
        self._of = {int(freedom): tie for tie in self.all for freedom in tie.freedoms}
        self._tied = np.zeros(layout.n_freedoms, dtype=bool)
        self._tied[list(self._of)] = True
        self._in_loops = in_loops
        self._bases: dict[bytes, Basis] = {}
        self._followers: dict[bytes, _Followers] = {}

    def residual(self, Q: FloatArray) -> FloatArray:
        """Return the residuals `(*batch, couplings)` of the rows at `Q` `(*batch, columns)`."""
        residual: FloatArray = (Q @ self._columns - self._offset) / self._unit
        return residual

    def missed(self, Q: FloatArray) -> FloatArray:
        """Return |r| `(*batch,)` of the rows at `Q` `(*batch, columns)`, minus what rounding of the largest coordinate explains."""
        residual = self.residual(Q)
        allowed = _ROUNDING * (1.0 + np.abs(Q).max(axis=-1, keepdims=True, initial=0.0))
        norm: FloatArray = np.sqrt((np.where(np.abs(residual) > allowed, residual, 0.0) ** 2).sum(axis=-1))
        return norm

    def basis(self, free: BoolArray) -> Basis:
        """Return the independent motions of the free freedoms; a tie moves if all its members are free.

        The largest component of each motion that moves a loop is 1.
        """
        key = free.tobytes()
        if key not in self._bases:
            alone = np.eye(self._n)[:, free & ~self._tied]
            moving = [tie for tie in self.all if tie.fixed is None and free[tie.freedoms].all()]
            matrix = np.column_stack([alone, *(self._motion(tie) for tie in moving)])
            self._bases[key] = Basis(matrix, None if moving else np.flatnonzero(free & ~self._tied))
        return self._bases[key]

    def _motion(self, tie: LinearTie) -> FloatArray:
        motion = np.zeros(self._n)
        motion[tie.freedoms] = tie.factor / self._scale[tie.freedoms]
        largest = float(np.abs(motion[self._in_loops]).max(initial=0.0))
        return motion / (largest or float(np.abs(motion).max()))

    def images(self, freedom: int) -> FloatArray:
        """Return the scaled motion `(freedoms,)` of everything coupled to a freedom when that one moves by 1."""
        motion = np.zeros(self._n)
        motion[freedom] = 1.0
        tie = self._of.get(freedom)
        if tie is not None and tie.fixed is None:
            whole = self._motion(tie)
            motion = whole / whole[freedom]
        return motion

    def fitted(self, Q: FloatArray, held: BoolArray) -> FloatArray:
        """Return coordinates `(*batch, columns)` that obey the couplings; in each tie a held member, else the first, keeps its value."""
        if not self.all:
            return Q
        key = held.tobytes()
        if key not in self._followers:
            self._followers[key] = self._followers_of(held)
        f = self._followers[key]
        Q = Q.copy()
        Q[..., f.columns] = (Q[..., f.leaders] - f.leader_offset) / f.leader_factor * f.factor + f.offset
        return Q

    def _followers_of(self, held: BoolArray) -> _Followers:
        """Return the coordinates that follow others while some freedoms are held; a fixed number m is a leader's factor of infinity."""
        rows: list[tuple[float, ...]] = []
        for tie in self.all:
            first = int(np.argmax(held[tie.freedoms]))
            leads = held[tie.freedoms] if tie.fixed is not None else np.arange(len(tie.columns)) == first
            for at in np.flatnonzero(~leads):
                if tie.fixed is not None:  # (q − q₀) / ∞ · factor = 0
                    leader, value = (tie.columns[first], 0.0, math.inf), tie.factor[at] * tie.fixed + tie.offset[at]
                else:
                    leader, value = (tie.columns[first], tie.offset[first], tie.factor[first]), tie.offset[at]
                rows.append((tie.columns[at], *leader, tie.factor[at], value))
        columns, leaders, *numbers = np.array(rows).reshape(-1, 6).T
        return _Followers(columns.astype(np.intp), leaders.astype(np.intp), *numbers)

    def spread(self, change: FloatArray, known: BoolArray) -> FloatArray:
        """Return changes of coordinates `(columns,)` in which the members of each tie change consistently with a known one."""
        change = change.copy()
        for tie in self.all:
            first = int(np.argmax(known[tie.columns]))
            if known[tie.columns[first]]:
                others = np.arange(len(tie.columns)) != first
                change[tie.columns[others]] = change[tie.columns[first]] / tie.factor[first] * tie.factor[others]
        return change

    def tied_to(self, column: int) -> tuple[tuple[int, float, float], ...]:
        """Return the other coordinates coupled to one as (column, ratio, offset): their value is ratio · q + offset."""
        for tie in self.all:
            at = np.flatnonzero(tie.columns == column)
            if at.size and tie.fixed is None:
                ratio = tie.factor / tie.factor[at[0]]
                offset = tie.offset - ratio * tie.offset[at[0]]
                return tuple((int(c), float(k), float(o)) for c, k, o in zip(tie.columns, ratio, offset, strict=True) if c != column)
        return ()


def _ties(couplings: Sequence[Coupling], layout: Layout, in_loops: BoolArray) -> list[LinearTie]:
    """Walk every connected set of coupled coordinates from its first member: q_b = k q_a + c either way."""
    beside: dict[int, list[tuple[int, float, float]]] = {}
    for coupling in couplings:
        a, b = layout.column_of[coupling.a], layout.column_of[coupling.b]
        beside.setdefault(a, []).append((b, coupling.ratio, coupling.offset))
        beside.setdefault(b, []).append((a, 1.0 / coupling.ratio, -coupling.offset / coupling.ratio))
    # the first member measures the tie: one that moves a loop, or else a marked driver
    order = sorted(beside, key=lambda column: (not in_loops[layout.freedom_of(column)], not _is_marked(layout, column), column))
    found: dict[int, tuple[float, float]] = {}
    ties = []
    for root in order:
        if root in found:
            continue
        members, fixed = [root], None
        found[root] = (1.0, 0.0)
        for at in members:  # grows while it is walked
            k, c = found[at]
            for other, ratio, offset in beside[at]:
                # q_other = ratio · (k m + c) + offset; a second path that disagrees fixes m where both lines meet
                there = (ratio * k, ratio * c + offset)
                if other not in found:
                    found[other] = there
                    members.append(other)
                elif fixed is None and abs(there[0] - found[other][0]) > _SAME_RATIO * abs(there[0]):
                    fixed = (found[other][1] - there[1]) / (there[0] - found[other][0])
        columns = np.array(members, dtype=np.intp)
        freedoms = np.array([layout.freedom_of(column) for column in members], dtype=np.intp)
        factor, shift = (np.array([found[column][i] for column in members]) for i in (0, 1))
        ties.append(LinearTie(columns, freedoms, factor, shift, fixed))
    return ties


def _is_marked(layout: Layout, column: int) -> bool:
    return layout.joint(layout.coordinates[column].joint).driver
