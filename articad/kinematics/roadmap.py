"""Roadmap: configurations of a group that straight lines of its drivers connect to rest, for values that no single line reaches.

A tree grows from rest towards random values of the drivers (RRT: LaValle, Kuffner 2001), with a fixed seed, in stages of fixed size, so
that the result for a value depends on the value alone.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from articad.arrays import FloatArray

if TYPE_CHECKING:
    from articad.kinematics.branch import Group

_STAGES = (48, 160, 480)  # nodes after which a value is tried again
_AT_ONCE = 16  # samples per growth
_NEAREST = 8  # nodes from which a value is tried
_LONGEST = 0.8  # rad, or lengths L: length of one edge
_FREE_LENGTH = 2.0  # lengths L in both directions within which a travel without limits is sampled
_TRIES = 4  # growths per wanted node, before a stage is left incomplete


class Roadmap:
    """Configurations that can be reached from rest.

    Args:
        group: The group whose drivers move.
    """

    def __init__(self, group: Group) -> None:
        self._group, self._rng = group, np.random.default_rng(0)
        system = group.system
        self._motions = np.array([system.ties.images(int(f)) for f in group.driving]).reshape(len(group.driving), -1)
        self._y = np.zeros((1, len(group.driving)))
        self._Q = group.Q[None].copy()
        self._low, self._high = self._box()
        self._stages: list[int] = []

    def _box(self) -> tuple[FloatArray, FloatArray]:
        """Return the bounds of the drivers' scaled displacements for sampling: their limits, or half a turn, or two lengths."""
        layout, system = self._group.system.layout, self._group.system
        low, high = np.empty(len(self._group.driving)), np.empty(len(self._group.driving))
        for i, freedom in enumerate(self._group.driving.tolist()):
            free = _FREE_LENGTH if layout.is_length[freedom] else math.pi
            c = layout.coordinates[layout.column_of_freedom(freedom)]
            at = float(self._group.Q[layout.column_of[c.name]])
            low[i] = max(-free, (c.lower - at) / system.scale[freedom]) if c.unit != "1" else -free
            high[i] = min(free, (c.upper - at) / system.scale[freedom]) if c.unit != "1" else free
        return np.minimum(low, 0.0), np.maximum(high, 0.0)

    def reached(self, y: FloatArray, wanted: FloatArray) -> FloatArray | None:
        """Return the configuration at drivers' scaled displacements `(drivers,)` from rest, or None if no path to it is found.

        Args:
            y: Displacements.
            wanted: Coordinates of the system with the drivers there `(columns,)`.
        """
        for stage in range(len(_STAGES)):
            nodes = slice(0, self._size(stage))
            near = np.argsort(np.linalg.norm(self._y[nodes] - y, axis=1), kind="stable")[:_NEAREST]
            Q, arrived = self._group.advance(self._Q[near], np.tile(wanted, (len(near), 1)))
            if arrived.any():
                found: FloatArray = Q[np.argmax(arrived)]
                return found
        return None

    def _size(self, stage: int) -> int:
        """Return the number of nodes of a stage; grow it first."""
        while len(self._stages) <= stage:
            self._grow(_STAGES[len(self._stages)])
            self._stages.append(len(self._y))
        return self._stages[stage]

    def _grow(self, size: int) -> None:
        for _ in range(_TRIES * size // _AT_ONCE):
            if len(self._y) >= size:
                return
            aim = self._rng.uniform(self._low, self._high, (_AT_ONCE, len(self._low)))
            near = np.linalg.norm(self._y[None] - aim[:, None], axis=2).argmin(axis=1)
            way = aim - self._y[near]
            way *= np.minimum(1.0, _LONGEST / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300))
            step = way @ self._motions
            Q, arrived = self._group.follower.trace_many(self._Q[near], step)
            self._y = np.concatenate([self._y, (self._y[near] + way)[arrived]])
            self._Q = np.concatenate([self._Q, Q[arrived]])
