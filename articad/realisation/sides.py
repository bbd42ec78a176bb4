"""The faces of both sides of a joint in one frame: that of the joint, on the parent, with its z along the axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.geometry.faces import Face, faces_of
from articad.interference.freedoms import freedoms
from articad.interference.gauge import fixed_with, placed
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint

__all__ = ["PartFace", "Sides", "boxes", "sides"]


class PartFace(NamedTuple):
    """A face and the part that it belongs to."""

    part: str
    face: Face


class Sides(NamedTuple):
    """The faces of a joint's parent and child, with those of parts fixed to them, in the joint's frame on the parent."""

    parent: tuple[PartFace, ...]
    child: tuple[PartFace, ...]


def sides(scene: Scene, joint: Joint, values: Sequence[float] | None = None) -> Sides:
    """Return the faces of both sides of a joint.

    Args:
        scene: The scene with the parts.
        joint: The joint.
        values: Of its `freedoms` [rad, mm]; at rest by default.
    """
    at = [freedom.rest for freedom in freedoms(joint)] if values is None else list(values)
    back = np.asarray(np.linalg.inv(joint.T_parent_connector.matrix))
    poses = {joint.parent: back, joint.child: np.asarray(back @ placed(joint, at))}
    return Sides(*(_moved(scene, joint, part, poses[part]) for part in (joint.parent, joint.child)))


def _moved(scene: Scene, joint: Joint, part: str, T: FloatArray) -> tuple[PartFace, ...]:
    return tuple(
        PartFace(name, face.moved(np.asarray(T @ T_name)))
        for name, T_name in fixed_with(scene, joint, part).items()
        for face in faces_of(scene.meshes[name])
    )


def boxes(faces: Sequence[PartFace]) -> tuple[FloatArray, FloatArray]:
    """Return lower and upper corners of the faces' boxes, `(F, 3)` each [mm]."""
    low = np.array([one.face.corners.min(axis=(0, 1)) for one in faces]).reshape(-1, 3)
    high = np.array([one.face.corners.max(axis=(0, 1)) for one in faces]).reshape(-1, 3)
    return low, high
