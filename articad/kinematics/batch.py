"""Forward kinematics in NumPy: poses and velocities of all parts for many configurations at once.

Two ways to the same poses. `matrices` multiplies homogeneous matrices: few calls per joint, right for few configurations and for the
loop solver. For many configurations, `poses` uses `bulk`, which works on rows over all of them. The tests compare both with Pinocchio.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3, quaternion
from articad.kinematics.bulk import BulkPoses
from articad.kinematics.crossings import Crossing, Crossings, Transforms
from articad.kinematics.joints import Joint
from articad.kinematics.layout import Layout
from articad.kinematics.tree import KinematicTree
from articad.kinematics.twists import Twists

_FEW = 64  # configurations up to which matrices are faster than rows (measured break-even: 16 for 5 parts, 64 for 10 and 50)


class TreeArrays:
    """A tree compiled for arithmetic.

    Args:
        parts: In the order in which poses are returned.
        tree: The spanning tree of the parts.
        layout: Layout of all coordinates, the tree's joints included.
        T_ground: Pose of the ground part.
        closing: Joints that close loops: for each, `matrices` appends a ghost of its child after the parts.
    """

    def __init__(self, parts: Sequence[str], tree: KinematicTree, layout: Layout, T_ground: SE3, closing: Sequence[Joint] = ()) -> None:
        index = {part: i for i, part in enumerate(parts)}
        self.parts = tuple(parts)
        self.layout = layout
        self.n_parts = len(parts)
        self.ground = index[tree.ground]
        self.T_ground = T_ground
        near = [index[part] for part in tree.parents]
        far = [index[part] for part in tree.parts[1:]]
        self.compiled = Crossings(
            [*tree.joints, *closing],
            near + [index[joint.parent] for joint in closing],
            [*far, *range(self.n_parts, self.n_parts + len(closing))],
            [joint.parent != part for joint, part in zip(tree.joints, tree.parents, strict=True)] + [False] * len(closing),
            layout,
        )
        self._n_edges = len(tree.joints)
        self._steps = tuple(zip(self.compiled.near, self.compiled.far, strict=True))

    @cached_property
    def _transforms(self) -> Transforms:
        return Transforms(self.compiled)

    @cached_property
    def _ground_matrix(self) -> FloatArray:
        return self.T_ground.matrix

    @property
    def crossings(self) -> tuple[Crossing, ...]:
        """The tree's joints one by one, depth first."""
        return self.compiled.rows[: self._n_edges]

    @property
    def closing(self) -> tuple[Crossing, ...]:
        """The joints that close loops."""
        return self.compiled.rows[self._n_edges :]

    @cached_property
    def twists(self) -> Twists:
        """Velocities of the freedoms."""
        return Twists(self.layout, {part: i for i, part in enumerate(self.parts)})

    @cached_property
    def carried(self) -> FloatArray:
        """±1 where a freedom moves a part, −1 where it is crossed backwards: `(N, n_freedoms)`; 11 MB for 1000 parts, so made on demand."""
        c, carried = self.compiled, np.zeros((self.n_parts, self.layout.n_freedoms))
        for k in range(self._n_edges):
            carried[c.far[k]] = carried[c.near[k]]
            carried[c.far[k], self.layout.freedoms.get(c.joints[k].name, slice(0))] = c.sign[k]
        return carried

    @cached_property
    def _bulk(self) -> BulkPoses:
        return BulkPoses(self.compiled, self.n_parts, self.ground, self.T_ground)

    def matrices(self, Q: FloatArray) -> FloatArray:
        """Return the poses of all parts, then of all ghosts, as `(N, batch, 4, 4)` for coordinates `(batch, n_columns)`."""
        T = np.empty((len(self._steps) + 1, len(Q), 4, 4))
        T[self.ground] = self._ground_matrix
        X = self._transforms(Q.T)
        for k, (near, far) in enumerate(self._steps):
            np.matmul(T[near], X[k], out=T[far])
        return T

    def poses(self, Q: FloatArray) -> SE3:
        """Return the poses `(*batch, N)` of all parts for coordinates `(*batch, n_columns)`."""
        flat = Q.reshape(math.prod(Q.shape[:-1]), self.layout.n_columns)
        if len(flat) <= _FEW:
            T = self.matrices(flat)
            out = np.empty((self.n_parts, len(flat), 7))
            out[..., :3] = T[..., :3, 3]
            out[..., 3:] = quaternion.positive(quaternion.from_matrix(T[..., :3, :3]))
            return SE3.from_unit_array(out.swapaxes(0, 1).reshape(*Q.shape[:-1], self.n_parts, 7))
        return SE3.from_unit_array(self._bulk(flat).reshape(*Q.shape[:-1], self.n_parts, 7))
