"""Parts on one axis: rotation about it keeps the radius and height of their points, so outlines that are apart stay apart.

Results for one pose, or one pair of shapes, are reused for other poses, and for other pairs of the same shapes.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from articad.arrays import FloatArray
from articad.interference.body import Body
from articad.interference.meridian import Ends, meeting, outline
from articad.interference.overlap import one_contains_the_other
from articad.interference.scene import Scene, box_about, boxes_apart
from articad.interference.surface import Core
from articad.kinematics.joints import JointType

_TURNING = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW)
_WORTH_OUTLINES = 8  # queries of two shapes on one axis from which comparing outlines is cheaper
_OFF_MM = 1e-7  # largest offset of two axes, at the body's ends
_APART_MM = 1e-6  # least distance of outlines: larger than all rounding
_KEY_DIGITS = 9  # of millimetres of height
_MOST_KEYS = 10_000  # heights in the cache: a slide has infinitely many

Box = tuple[FloatArray, FloatArray]
_Key = tuple[tuple[int, bytes, int, bytes], tuple[float, float]]

_known: WeakKeyDictionary[Scene, Coaxial] = WeakKeyDictionary()


class Axis(NamedTuple):
    """A joint's axis in two bodies.

    Attributes:
        a: The axis in the first body's frame, `(4, 4)`: z of a connector.
        b: The same in the second body's.
        reach: How far the second body is from the origin of its axis at most [mm].
        key: Identifies the pair of shapes and axes.
    """

    a: FloatArray
    b: FloatArray
    reach: float
    key: tuple[int, bytes, int, bytes]

    @classmethod
    def of(cls, scene: Scene, a: str, b: str) -> Axis | None:
        """Return the axis about which a joint between two parts turns; None if there is no such joint."""
        for joint in scene.relations.between(a, b):
            if joint.type in _TURNING:
                frames = {joint.parent: joint.T_parent_connector.matrix, joint.child: joint.T_child_connector.matrix}
                A, B = scene.bodies[a], scene.bodies[b]
                reach = 2 * (B.reach + float(np.abs(frames[b][:3, 3]).max()))
                return cls(frames[a], frames[b], reach, (id(A), frames[a].tobytes(), id(B), frames[b].tobytes()))
        return None

    def place(self, T_a_b: FloatArray) -> tuple[float, float] | None:
        """Return the height of b's axis on a's [mm] and 1, or −1 if they oppose; None if they are not one line.

        Args:
            T_a_b: Pose of b in the frame of a, `(3, 4)`.
        """
        back = self.a[:3, :3].T
        z = back @ (T_a_b[:, :3] @ self.b[:3, 2])
        origin = back @ (T_a_b[:, :3] @ self.b[:3, 3] + T_a_b[:, 3] - self.a[:3, 3])
        if math.hypot(origin[0], origin[1]) + math.hypot(z[0], z[1]) * self.reach > _OFF_MM:
            return None
        return round(float(origin[2]), _KEY_DIGITS), math.copysign(1.0, z[2])


class Coaxial:
    """Results of comparing outlines of pairs of shapes on one axis, in one scene."""

    def __init__(self) -> None:
        self._axes: dict[tuple[str, str], Axis | None] = {}
        self._asked: Counter[_Key] = Counter()
        self._met: dict[_Key, tuple[Box, Box] | None] = {}

    @classmethod
    def of(cls, scene: Scene) -> Coaxial:
        """Return the results of a scene; cached."""
        found = _known.get(scene)
        if found is None:
            found = _known[scene] = cls()
        return found

    def apart(self, scene: Scene, a: str, b: str, T_a_b: FloatArray) -> bool:
        """Return True if two parts are known to have no common point; False says nothing.

        Only triangles whose outlines meet can meet, and if the boxes about these are apart they do not.

        Args:
            scene: The scene of this object.
            a: A part.
            b: Another.
            T_a_b: Pose of b in the frame of a, `(3, 4)`.
        """
        if (a, b) not in self._axes:
            self._axes[a, b] = Axis.of(scene, a, b)
        axis = self._axes[a, b]
        place = axis.place(T_a_b) if axis is not None else None
        if axis is None or place is None:
            return False
        bodies, key = (scene.bodies[a], scene.bodies[b]), (axis.key, place)
        if key not in self._met:
            self._asked[key] += 1
            if self._asked[key] < _WORTH_OUTLINES:
                return False
            if len(self._asked) > _MOST_KEYS:
                self._asked.clear()
                self._met.clear()
            self._met[key] = _meeting(axis, *bodies, *place)
        met = self._met[key]
        if met is not None and not boxes_apart(*met, T_a_b[None])[0]:
            return False
        return not one_contains_the_other(*bodies, T_a_b)


def _meeting(axis: Axis, a: Body, b: Body, height: float, sign: float) -> tuple[Box, Box] | None:
    """Return boxes about the triangles of two bodies whose outlines meet, each in its body's frame; None if there are none."""
    mine = outline(Core(axis.a), a.plain_corners)
    theirs = _raised(outline(Core(axis.b), b.plain_corners), height, sign)
    met_a = meeting(mine, theirs, _APART_MM)
    if not met_a.any():
        return None
    met_b = meeting(theirs, (mine[0][met_a], mine[1][met_a]), _APART_MM)
    return box_about(a.plain_corners[met_a]), box_about(b.plain_corners[met_b])


def _raised(ends: Ends, height: float, sign: float) -> Ends:
    """Return outlines (radius, height) measured on an axis on which their own axis is at a height, and opposed if the sign is −1."""
    low, high = ends
    heights = np.sort(np.stack([sign * low[:, 1], sign * high[:, 1]]) + height, axis=0)
    return np.stack([low[:, 0], heights[0]], axis=1), np.stack([high[:, 0], heights[1]], axis=1)
