"""How far contacts let a body move, to first order: a linear program for each direction.

The unknowns of each body are a small translation v of a reference point c and a small rotation ω. A contact at p between the bodies i and j, with the
direction n from j to i and the distance g, allows n·(v_j + ω_j x (p - c_j)) - n·(v_i + ω_i x (p - c_i)) ≤ g. The largest value of each component of one
body, within the bounds below, is its play in that direction. A component that reaches its bound is free.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_array

from articad.arrays import BoolArray, FloatArray

__all__ = ["FAR_RAD", "GROUND", "Rise", "Touch", "far_mm", "room", "rows"]

FAR_RAD: Final = 0.35  # a body that may turn by this much is not held
GROUND: Final = -1  # the body that stands still
_OTHERS: Final = 3.0  # by which the bounds of other bodies are wider


class Touch(NamedTuple):
    """Contacts between two bodies.

    Attributes:
        first: Number of the body from whose surface the gaps are measured, or GROUND.
        second: Number of the body that the normals leave.
        points: `(N, 3)` [mm].
        normals: From the second body's surface to the first's, `(N, 3)`.
        gaps: `(N,)` [mm].
        grazing: Contacts of body 0 whose normals have a smaller cosine with a direction do not stop a translation in it.
    """

    first: int
    second: int
    points: FloatArray
    normals: FloatArray
    gaps: FloatArray
    grazing: float


def far_mm(touches: Sequence[Touch]) -> float:
    """Return the translation from which on a body counts as free [mm]: several times the widest gap."""
    return 5.0 + 4.0 * max((float(touch.gaps.max()) for touch in touches), default=0.0)


class Rise(NamedTuple):
    """A bound on how far the centre of mass of body 0 rises.

    Attributes:
        up: Unit vector against the weight, `(3,)`.
        mass: The centre of mass, `(3,)` [mm].
        most: How far it may rise [mm].
    """

    up: FloatArray
    mass: FloatArray
    most: float


def room(touches: Sequence[Touch], held: BoolArray, centre: FloatArray, rise: Rise | None = None) -> FloatArray:
    """Return how far body 0 may move in each direction, `(2, 6)` [mm, rad]: positive, then negative; x, y, z, then about x, y, z.

    Args:
        touches: All contacts; bodies are numbered from 0.
        held: Components of body 0 that are held at zero because the joint itself moves along them, `(6,)`.
        centre: The reference point of body 0, `(3,)` [mm].
        rise: How far its centre of mass may rise; unbounded by default.
    """
    far = far_mm(touches)
    limits = np.where(held, 0.0, np.array([far] * 3 + [FAR_RAD] * 3))
    if not touches:
        return np.stack([limits, limits])
    count = 1 + max(max(touch.first, touch.second) for touch in touches)
    centres = [centre, *(_middle(touches, body) for body in range(1, count))]
    bounds = np.concatenate([limits, np.tile(_OTHERS * np.array([far] * 3 + [FAR_RAD] * 3), count - 1)])
    dense = np.concatenate([rows(touch, centres) for touch in touches])
    gaps = np.concatenate([touch.gaps for touch in touches])
    grazing = np.concatenate([np.full(len(touch.gaps), touch.grazing) for touch in touches])
    if rise is not None:
        row = np.zeros((1, 6 * count))
        row[0, :6] = [*rise.up, *np.cross(rise.mass - centre, rise.up)]
        dense, gaps, grazing = np.concatenate([dense, row]), np.append(gaps, rise.most), np.append(grazing, 0.0)
    found = np.zeros((2, 6))
    for column in np.flatnonzero(~held):
        for place, sign in enumerate((1.0, -1.0)):
            goal = np.zeros(6 * count)
            goal[column] = -sign
            stops = np.ones(len(dense), dtype=bool)
            if column < 3:
                against = sign * dense[:, column]
                stops = (against <= 0) | (against >= grazing)
            left = csr_array(dense[stops])
            result = linprog(goal, A_ub=left, b_ub=gaps[stops], bounds=np.column_stack([-bounds, bounds]), method="highs")
            found[place, column] = -result.fun if result.status == 0 else limits[column]
    return found


def _middle(touches: Sequence[Touch], body: int) -> FloatArray:
    points = [touch.points for touch in touches if body in (touch.first, touch.second)]
    return np.asarray(np.concatenate(points).mean(axis=0)) if points else np.zeros(3)  # nothing depends on a body without contacts


def rows(touch: Touch, centres: Sequence[FloatArray]) -> FloatArray:
    """Return the left sides of the inequalities of contacts, `(N, 6 bodies)`."""
    found = np.zeros((len(touch.points), 6 * len(centres)))
    for body, sign in ((touch.second, 1.0), (touch.first, -1.0)):
        if body != GROUND:
            arms = np.cross(touch.points - centres[body], touch.normals)
            found[:, 6 * body : 6 * body + 6] = sign * np.column_stack([touch.normals, arms])
    return found
