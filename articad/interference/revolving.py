"""Pieces of the moving part as the innermost turn leaves them: whatever its angle, they stay within a stretch of its axis and a radius.

So of a ball, whose twist is as wide as it likes, only the swing is left to be covered; and of a wheel on an arm only the arm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from articad.interference.boxtree import BoxTree
from articad.interference.spread import Spread

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

LEAST_TURN = 0.1  # rad: what turns by less either way is looked at as it is
_EYE = np.eye(3)


@dataclass(frozen=True, eq=False)
class Revolved:
    """The nodes of a tree about an axis.

    Attributes:
        tree: Of the part that moves.
        middle: Of the stretch of the axis beside each node, in the part's frame, `(nodes, 3)` [mm].
        half: How far the stretch goes either way, `(nodes,)` [mm].
        radius: The largest, `(nodes,)` [mm].
        axis: Unit, in the part's frame, `(3,)`.
    """

    tree: BoxTree
    middle: FloatArray
    half: FloatArray
    radius: FloatArray
    axis: FloatArray

    @classmethod
    def of(cls, tree: BoxTree, spread: Spread) -> Revolved | None:
        """Return the nodes about the axis of the innermost freedom; None if that is no turn, or the only freedom."""
        if len(spread.factors) < 2 or not spread.turns[-1] or any(spread.factors[-1][1].slide):
            return None
        back = np.linalg.inv(spread.chain.last)
        axis, origin = back[:3, :3] @ spread.factors[-1][1].turn, back[:3, 3]
        local = tree.corners - origin
        height = local @ axis
        radius = np.linalg.norm(local - height[..., None] * axis, axis=2).max(axis=1)
        low, high = tree.over_each(height.min(axis=1), np.minimum), tree.over_each(height.max(axis=1), np.maximum)
        return cls(tree, origin + (low + high)[:, None] / 2 * axis, (high - low) / 2, tree.over_each(radius, np.maximum), axis)

    def gaps(self, spread: Spread, a: BoxTree, of_a: IntArray, of_b: IntArray, box: IntArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return directions `(n, D, 3)`, how far pieces are apart along them `(n, D)` [mm], and the motion by each generator, `(n, D, G + 1)`.

        The last of these is what the others leave to the second order.
        """
        T, half, radius = spread.T[box], self.half[of_b], self.radius[of_b]
        R = T[:, :3, :3]
        c, axis = (R @ self.middle[of_b][..., None])[..., 0] + T[:, :3, 3], R @ self.axis
        apart = c - a.centre[of_a]
        along = np.clip(-(apart * axis).sum(axis=1), -half, half)
        near, far = apart + along[:, None] * axis, apart + np.where(along > 0, -half, half)[:, None] * axis
        u = np.stack([near, far, _unit(near) + _unit(far), 2 * _unit(near) + _unit(far), apart, axis], axis=1)
        u = _unit(np.concatenate([np.broadcast_to(_EYE, (len(c), 3, 3)), _coarse(u)], axis=1))
        u = np.where((u @ apart[..., None]) < 0, -u, u)
        row = a.triangle[of_a]
        mine = (u @ a.centre[of_a][..., None])[..., 0] + (np.abs(u) @ a.half[of_a][..., None])[..., 0]
        mine = np.where(row[:, None] < 0, mine, (u @ a.corners[row].transpose(0, 2, 1)).max(axis=2))
        straight = np.abs((u @ axis[..., None])[..., 0])
        across = np.linalg.norm(u - (u @ axis[..., None]) * axis[:, None], axis=2)
        theirs = (u @ c[..., None])[..., 0] - straight * half[:, None] - across * radius[:, None]
        extent = np.zeros((len(c), 3, 3))
        extent[:, 0] = half[:, None] * axis
        first = spread.first_order(box, u, c, extent, radius, still=True)
        second = spread.second_order(box, u, c, half + radius, still=True)
        return u, theirs - mine, np.concatenate([first, second[..., None]], axis=2)


def _unit(v: FloatArray) -> FloatArray:
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300))


def _coarse(u: FloatArray) -> FloatArray:
    return np.asarray(np.round(_unit(u) * 64.0) / 64.0)
