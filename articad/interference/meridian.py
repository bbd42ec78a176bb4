"""What a joint cannot bring together at any angle: surfaces are compared by their radius and height about its axis.

A shaft in its bore and a washer on its shoulder never come closer than their outlines in the plane through the axis, whatever the angle.
Only the triangles whose outlines meet need a proof over the range.
"""

from __future__ import annotations

import numpy as np

from articad.arrays import BoolArray, FloatArray
from articad.interference.boxtree import BoxTree
from articad.interference.surface import Core

Ends = tuple[FloatArray, FloatArray]

_ROUNDING = 1e-9  # rad, of angles
_STEPS = np.radians([0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0])
BESIDE_CONE = np.concatenate([-_STEPS[::-1], [0.0], _STEPS])  # rad: angles of the cones of `swung`, relative to the cone of the ball
CHUNK = 65_536  # rows processed together


def outline(core: Core, corners: FloatArray, travel: tuple[float, float] = (0.0, 0.0), *, turns: bool = True) -> Ends:
    """Return the bounds of each triangle in coordinates that the joint does not change, `(T, k)` each [mm].

    About a point: the radius. About an axis: the radius and the height. For sliding without rotation: both sides as well.

    Args:
        core: The axis or the point, in the frame of the corners.
        corners: `(T, 3, 3)`.
        travel: How far the triangles may slide along the axis, in both directions.
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
    """Return the bounds of each triangle's angle from the axis, `(T, 1)` each [rad], while it swings within a cone about the axis.

    A ball's twist keeps this angle, and its swing changes it by at most the swing's own angle. Points whose angles differ by ψ more than
    that, at radius r, are at least r sin ψ apart.
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
    """Return how far each triangle is outside some cones about the axis: at this pose, and at most while it swings, `(T, k)` each [mm].

    The distance of a point at height z and radius r from a cone of half angle c is r cos c - z sin c = ρ sin(θ - c), with θ its angle
    from the axis. It changes by no more than the point moves. The radius is at least the coordinate along any one direction, so the
    minimum over a triangle is bounded at its corners, or by its least radius and its largest height. A swing by at most `cone` changes θ
    by at most that much, and a twist does not change it: the maximum is ρ sin(θ + cone - c), or ρ where that angle exceeds a right one.
    It is a maximum of functions convex in the point, hence reached at a corner, as long as the whole triangle is on the side to which
    the axis points. So a part that leans out of a ball's centre stays clear of a ring about it whatever its own twist.

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
        if not leaf.all():  # one child at a time: the first one that meets decides the row
            stack += [(mine[~leaf], children[~leaf, k]) for k in (1, 0)]
    return met
