"""Pairs that one turning joint cannot bring together, so that a sweep of it can skip them."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from articad.arrays import BoolArray, FloatArray
from articad.interference.body import Body
from articad.interference.meridian import Ends, meeting, outline
from articad.interference.scene import Scene, box_about, boxes_apart
from articad.interference.surface import Core
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism


class Turning:
    """The bodies that a joint keeps apart at any angle, all other joints at rest.

    Args:
        scene: The bodies.
        joint: A joint of a tree.
        T_ground_axis: Its parent connector at one of the poses, `(4, 4)` [mm].
        matrices: The bodies at that pose, `(N, 3, 4)` [mm].
    """

    def __init__(self, scene: Scene, joint: Joint, T_ground_axis: FloatArray, matrices: FloatArray) -> None:
        self.scene, self.joint, self.matrices = scene, joint, matrices
        self._axis = Core(T_ground_axis)
        self._outlines: dict[int, Ends] = {}

    @classmethod
    def of(cls, scene: Scene, mechanism: Mechanism, name: str, poses: FloatArray, matrices: FloatArray) -> Turning | None:
        """Return the object for the only coordinate that moves; None if that does not turn about a fixed axis.

        Args:
            scene: The bodies.
            mechanism: The mechanism.
            name: Name of the coordinate.
            poses: All parts at one of its values, matrices `(parts, 4, 4)` [mm].
            matrices: The bodies there, `(N, 3, 4)` [mm].
        """
        for joint in mechanism.joints if mechanism.is_tree else ():
            if joint.type in (JointType.REVOLUTE, JointType.CYLINDRICAL) and name == joint.column_names[-1]:
                at = poses[mechanism.part_index(joint.parent)] @ joint.T_parent_connector.matrix
                return cls(scene, joint, at, matrices)
        return None

    def apart(self, i: int, j: int, T_i_j: FloatArray) -> BoolArray:
        """Return at which relative poses `(n, 3, 4)` two bodies, given by their indices, have no common point, `(n,)`.

        Only triangles whose outlines meet can meet, and if the boxes about these are apart they do not. Then no shell of the one is
        inside the other if it reaches out of the other's box.
        """
        mine, theirs = self._outline(i), self._outline(j)
        met_i = meeting(mine, theirs, 0.0)
        found = np.ones(len(T_i_j), dtype=bool)
        if met_i.any():
            met_j = meeting(theirs, (mine[0][met_i], mine[1][met_i]), 0.0)
            found = boxes_apart(box_about(self._bodies[i].corners[met_i]), box_about(self._bodies[j].corners[met_j]), T_i_j)
        back = T_i_j[..., :3].transpose(0, 2, 1)
        T_j_i = np.concatenate([back, -back @ T_i_j[..., 3:]], axis=2)
        return np.asarray(found & ~self._may_hold(i, j, T_i_j) & ~self._may_hold(j, i, T_j_i))

    def _may_hold(self, outer: int, inner: int, T: FloatArray) -> BoolArray:
        """Return at which poses of the inner body one of its shells is within the outer's box, up to rounding, `(n,)`."""
        low, high = self._bodies[outer].mesh.bounds
        found = np.zeros(len(T), dtype=bool)
        for extremes in self._bodies[inner].extremes:
            points = extremes @ T[..., :3].transpose(0, 2, 1) + T[:, None, :, 3]
            found |= ((points >= low) & (points <= high)).all(axis=(1, 2))
        return found

    def _outline(self, i: int) -> Ends:
        if i not in self._outlines:
            T = self.matrices[i]
            self._outlines[i] = outline(self._axis, self._bodies[i].corners @ T[:, :3].T + T[:, 3])
        return self._outlines[i]

    @cached_property
    def _bodies(self) -> list[Body]:
        return list(self.scene.bodies.values())
