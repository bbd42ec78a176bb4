"""What a joint cannot bring together however it turns: surfaces compared by their radius and height about its axis.

A shaft in its bore and a washer on its shoulder never come nearer than their outlines in the plane through the axis, whatever the
angle. Only the triangles whose outlines do meet are left for a proof over the range.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from articad.interference.boxtree import BoxTree
from articad.interference.surface import Core

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
Ends = tuple[FloatArray, FloatArray]

_ROUNDING = 1e-9  # rad: of angles
CHUNK = 65_536  # rows looked at together


def outline(core: Core, corners: FloatArray, travel: tuple[float, float] = (0.0, 0.0), *, turns: bool = True) -> Ends:
    """Return between which ends each triangle is in coordinates that the joint does not change, `(T, k)` each [mm].

    About a point the radius; about an axis the radius and the height; of what slides without turning both sides, too.

    Args:
        core: The axis or the point, in the frame of the corners.
        corners: `(T, 3, 3)`.
        travel: How far the triangles may slide along the axis, either way.
        turns: Whether the joint turns.
    """
    low, high = [core.least_radii(corners)], [core.radii(corners).max(axis=1)]
    if core.dimensions == 2:
        local = (corners - core.frame[:3, 3]) @ core.frame[:3, :3]
        for axis in (2,) if turns else (0, 1, 2):
            way = travel if axis == 2 else (0.0, 0.0)
            low.append(local[..., axis].min(axis=1) + way[0])
            high.append(local[..., axis].max(axis=1) + way[1])
    return np.stack(low, axis=1), np.stack(high, axis=1)


def leaning(core: Core, corners: FloatArray, cone: float, needed: float) -> Ends:
    """Return between which angles from the axis each triangle is while it swings within a cone about it, `(T, 1)` each [rad].

    The twist of a ball keeps this angle, and the swing changes it by no more than its own. What is apart by ψ more at radius r is
    r sin ψ away.
    """
    height = (corners - core.frame[:3, 3]) @ core.frame[:3, 2]
    axis = Core(core.frame)
    wide = np.stack([axis.least_radii(corners), axis.radii(corners).max(axis=1)])
    low, high = np.arctan2(wide, height.max(axis=1)).min(axis=0), np.arctan2(wide, height.min(axis=1)).max(axis=0)
    least = core.least_radii(corners)
    more = cone + np.arcsin(np.clip(needed / np.maximum(least, 1e-300), 0.0, 1.0)) + _ROUNDING
    more = np.where(least > needed, more, np.pi)
    return (low - more)[:, None], (high + more)[:, None]


def meeting(a: Ends, b: Ends, needed: float | FloatArray) -> BoolArray:
    """Return which outlines of a are within `needed` of any of b in all coordinates, `(T,)`."""
    met = np.zeros(len(a[0]), dtype=bool)
    if not len(a[0]) or not len(b[0]):
        return met
    tree = BoxTree.over(*b, np.empty((0, 3, 3)))
    middle, half = (a[0] + a[1]) / 2, (a[1] - a[0]) / 2
    stack = [(np.arange(len(met)), np.zeros(len(met), dtype=np.int64))]
    while stack:
        mine, theirs = stack.pop()
        if len(mine) > CHUNK:
            stack.append((mine[:-CHUNK], theirs[:-CHUNK]))
            mine, theirs = mine[-CHUNK:], theirs[-CHUNK:]
        asked = ~met[mine]
        mine, theirs = mine[asked], theirs[asked]
        near = (np.abs(middle[mine] - tree.centre[theirs]) - half[mine] - tree.half[theirs] <= needed).all(axis=1)
        mine, theirs = mine[near], theirs[near]
        children = tree.children[theirs]
        leaf = children[:, 0] < 0
        met[mine[leaf]] = True
        if not leaf.all():  # one child at a time: the first one that is met settles the row
            stack += [(mine[~leaf], children[~leaf, k]) for k in (1, 0)]
    return met
