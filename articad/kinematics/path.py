"""Paths of several drivers from one configuration to another, on the branch and within all limits.

A straight line if that is free, else two trees that grow towards each other in the space of the drivers (RRT-Connect: Kuffner, LaValle
2000), with a fixed seed, then shortened. Limits and the conditions of `accept` are checked in steps, not proven between them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from articad.arrays import FloatArray
from articad.errors import KinematicsError
from articad.findings import Finding
from articad.kinematics.branch import driver_freedoms
from articad.kinematics.configuration import Configuration
from articad.kinematics.loops import characteristic_length

if TYPE_CHECKING:
    from articad.kinematics.mechanism import Mechanism

Accept = Callable[[Configuration], bool]

_STEP = 0.1  # rad, or lengths L: between two checks of limits and of `accept`
_EXTENSION = 0.6  # rad, or lengths L: largest growth of a tree at once
_SAMPLES = 400  # random values of the drivers to try
_SHORTCUTS = 40  # pairs of waypoints between which a straight line is tried
_FREE = 2.0  # lengths L beyond start and goal within which a travel without limits is sampled
_SAME = 1e-6  # rad, mm: two configurations this close are the same


@dataclass
class _Tree:
    """Configurations `(columns,)` and the node from which each was reached."""

    Q: list[FloatArray]
    before: list[int] = field(default_factory=lambda: [-1])

    def add(self, Q: FloatArray, before: int) -> int:
        self.Q.append(Q)
        self.before.append(before)
        return len(self.Q) - 1

    def way(self, node: int) -> list[FloatArray]:
        """Return the configurations from the root to a node."""
        found = []
        while node >= 0:
            found.append(self.Q[node])
            node = self.before[node]
        return found[::-1]


class PathPlanner:
    """Searches for paths.

    Args:
        mechanism: The mechanism.
        accept: Decides whether a configuration within limits is accepted; None accepts all.
    """

    def __init__(self, mechanism: Mechanism, accept: Accept | None) -> None:
        self.mechanism, self.accept = mechanism, accept
        self.layout = mechanism.layout
        self._columns = list(mechanism.driver_columns)
        self._freedoms = np.array(driver_freedoms(self.layout, mechanism.driver_columns), dtype=np.intp)
        length = characteristic_length(mechanism.joints)
        self._scale = np.where(self.layout.is_length, length, 1.0)[self._freedoms]
        self._rng = np.random.default_rng(0)

    def find(self, start: FloatArray, goal: FloatArray) -> FloatArray | None:
        """Return waypoints `(n, nq)` from start to goal, or None."""
        ends = [self.mechanism.configuration(q).columns for q in (start, goal)]
        if self._straight(ends[0], ends[1]):
            return np.array([start, goal])
        trees = [_Tree([ends[0]]), _Tree([ends[1]])]
        low, high = self._box(ends[0], ends[1])
        for sample in range(_SAMPLES):
            here, there = trees[sample % 2], trees[1 - sample % 2]
            aim = self._moved(ends[0], self._rng.uniform(low, high))
            new = self._grown(here, aim, reach=_EXTENSION)
            if new is None:
                continue
            met = self._grown(there, here.Q[new], reach=math.inf)
            if met is not None and self._same(there.Q[met], here.Q[new]):
                ways = (here.way(new), there.way(met)[::-1][1:])
                way = [*ways[0], *ways[1]] if here is trees[0] else [*ways[0], *ways[1]][::-1]
                found = np.array([Q[self._columns] for Q in self._shortened(way)])
                found[0], found[-1] = start, goal
                return found
        return None

    def _box(self, a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the bounds of the displacements from `a` within which the drivers are sampled."""
        to = self._between(a, b)
        free = np.where(self.layout.is_length[self._freedoms], _FREE, math.pi)
        low, high = np.minimum(to, 0.0) - free, np.maximum(to, 0.0) + free
        for i, freedom in enumerate(self._freedoms.tolist()):
            column = self.layout.column_of_freedom(freedom)
            c = self.layout.coordinates[column]
            if c.unit != "1":
                low[i] = max(low[i], (c.lower - a[column]) / self._scale[i])
                high[i] = min(high[i], (c.upper - a[column]) / self._scale[i])
        return low, high

    def _between(self, a: FloatArray, b: FloatArray) -> FloatArray:
        displacement: FloatArray = self.layout.difference(a, b)[..., self._freedoms] / self._scale
        return displacement

    def _moved(self, Q: FloatArray, y: FloatArray) -> FloatArray:
        step = np.zeros(self.layout.n_freedoms)
        step[self._freedoms] = y * self._scale
        return self.layout.integrate(Q, step)

    def _same(self, a: FloatArray, b: FloatArray) -> bool:
        return bool(np.abs(self.layout.difference(a, b)).max(initial=0.0) < _SAME)

    def _grown(self, tree: _Tree, aim: FloatArray, *, reach: float) -> int | None:
        """Grow a tree from its nearest node towards a target as far as that is free; return the node reached, or None."""
        away = [float(np.linalg.norm(self._between(Q, aim))) for Q in tree.Q]
        near = int(np.argmin(away))
        Q, moved = self._followed(tree.Q[near], aim, min(reach, away[near]))
        return tree.add(Q, near) if moved else (near if away[near] == 0.0 else None)

    def _followed(self, Q: FloatArray, aim: FloatArray, far: float) -> tuple[FloatArray, bool]:
        """Move from Q towards a target over a distance, step by step; return how far it came, and whether it moved at all."""
        way = self._between(Q, aim)
        distance = float(np.linalg.norm(way))
        if distance == 0.0:
            return Q, False
        arrives = far >= distance
        steps = max(1, math.ceil(far / _STEP))
        start, moved = Q, False
        for k in range(1, steps + 1):
            wanted = aim if arrives and k == steps else self._moved(start, way * (far / distance * k / steps))
            there = self._advanced(Q, wanted)
            if there is None or not self._is_free(there):
                break
            Q, moved = there, True
        return Q, moved

    def _straight(self, a: FloatArray, b: FloatArray) -> bool:
        Q, _ = self._followed(a, b, math.inf if self._same(a, b) else float(np.linalg.norm(self._between(a, b))))
        return self._same(Q, b)

    def _advanced(self, Q: FloatArray, wanted: FloatArray) -> FloatArray | None:
        """Return the configuration on the branch of Q with the drivers of `wanted`; None if it is not reached."""
        found = Q.copy()
        found[self._columns] = wanted[self._columns]
        if self.mechanism.is_tree:
            return found
        for group in self.mechanism.branch.groups:
            mine = group.advance_from(Q, found)
            if mine is None:
                return None
            found = group.system.into_all(found, mine)
        return found

    def _is_free(self, Q: FloatArray) -> bool:
        configuration = Configuration(self.mechanism.joints, Q)
        if configuration.violations():
            return False
        return self.accept is None or self.accept(configuration)  # not `poses(q)`: at q the mechanism may have several configurations

    def _shortened(self, way: list[FloatArray]) -> list[FloatArray]:
        for _ in range(_SHORTCUTS):
            if len(way) < 3:
                break
            i, j = sorted(self._rng.choice(len(way), 2, replace=False).tolist())
            if j - i > 1 and self._straight(way[i], way[j]):
                way = [*way[: i + 1], *way[j:]]
        return way


def path(mechanism: Mechanism, start: npt.ArrayLike, goal: npt.ArrayLike, accept: Accept | None) -> FloatArray:
    """Return waypoints; see `Mechanism.path`."""
    ends = [np.asarray(q, dtype=np.float64) for q in (start, goal)]
    planner = PathPlanner(mechanism, accept)
    for name, q in zip(("start", "goal"), ends, strict=True):
        if q.shape != (mechanism.nq,):
            raise KinematicsError(f"The {name} of a path is one configuration ({mechanism.nq},); it has shape {q.shape}.")
        configuration = mechanism.configuration(q)
        configuration.require_within_limits()
        if accept is not None and not accept(configuration):
            raise KinematicsError(f"The {name} of the path is not collision-free: parts overlap there.")
    found = planner.find(*ends)
    if found is None:
        kinds = "limits, the branch and colliding parts" if accept is not None else "limits and the branch"
        finding = Finding(
            code="E_NO_PATH",
            where="joints",
            message=f"No path from start to goal was found among {_SAMPLES} random values of the drivers: {kinds} block those that were tried.",
            hint="Provide waypoints, or widen limits; a narrow path may exist that was not found.",
        )
        raise KinematicsError(str(finding), findings=[finding])
    return found
