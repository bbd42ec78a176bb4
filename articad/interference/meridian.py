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
_STEPS = np.radians([0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0])
BESIDE_CONE = np.concatenate([-_STEPS[::-1], [0.0], _STEPS])  # rad: angles of the cones of `swung`, beside the cone of the ball
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


def swung(core: Core, corners: FloatArray, cone: float) -> Ends:
    """Return how far each triangle is outside some cones about the axis: as it stands, and at most while it swings, `(T, k)` each [mm].

    Outside a cone of half angle c a point at height z and radius r is by r cos c - z sin c = ρ sin(θ - c), θ its angle from the
    axis. That changes by no more than the point moves. The radius is at least what is measured along one direction, so the least of
    a triangle is bounded at its corners, or by its least radius and its largest height. A swing by at most `cone` changes θ by as much, and a twist does not: the largest is
    ρ sin(θ + cone - c), or ρ where that angle is beyond a right one. It is the largest of functions convex in the point, hence
    reached at a corner, while the whole triangle is on the side to which the axis points. A part that leans out of a ball's centre
    thus keeps clear of a ring about it whatever its own twist is.

    Args:
        core: The centre, with its axis.
        corners: `(T, 3, 3)`.
        cone: At most a right angle [rad].
    """
    local = corners - core.frame[:3, 3]
    z, rho = local @ core.frame[:3, 2], np.linalg.norm(local, axis=2)
    flat = local - z[..., None] * core.frame[:3, 2]
    r, mean = np.linalg.norm(flat, axis=2), flat.mean(axis=1, keepdims=True)
    along = (flat * (mean / np.maximum(np.linalg.norm(mean, axis=2, keepdims=True), 1e-300))).sum(axis=2)
    least, low, high = Core(core.frame).least_radii(corners), [], []
    for side in (z, -z):
        is_ahead = (side >= 0).all(axis=1)
        for c in np.clip(cone + BESIDE_CONE, 0.0, np.pi / 2):
            flat_end = least * np.cos(c) - side.max(axis=1) * np.sin(c)
            low.append(np.maximum((along * np.cos(c) - side * np.sin(c)).min(axis=1), flat_end))
            leant = np.where(side * np.cos(c - cone) + r * np.sin(c - cone) >= 0, r * np.cos(c - cone) - side * np.sin(c - cone), rho)
            high.append(np.where(is_ahead, leant.max(axis=1), rho.max(axis=1)))
    return np.stack(low, axis=1), np.stack(high, axis=1)


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
