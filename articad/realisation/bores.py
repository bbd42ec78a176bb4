"""The pin in the bore of a joint, measured on their cylinders: diameters without the error of a mesh."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.geometry.faces import Face
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint, JointType
from articad.realisation.sides import PartFace, sides

__all__ = ["TILT", "Bore", "along", "at_height", "beside", "bore_and_pin", "bore_of", "offset"]

_Z = np.array([0.0, 0.0, 1.0])
TILT = 1e-3  # rad: axes that differ by less are parallel
_TURNING = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW, JointType.SLIDER)


class Bore(NamedTuple):
    """A cylindrical pin in a cylindrical bore about the axis of a joint.

    Attributes:
        bore: Diameter of the bore [mm].
        pin: Diameter of the pin [mm].
        off: By how much half their difference may be off [mm].
    """

    bore: float
    pin: float
    off: float

    @property
    def play(self) -> float:
        """Half the difference of the diameters [mm]."""
        return (self.bore - self.pin) / 2


def bore_of(scene: Scene, joint: Joint) -> Bore | None:
    """Return the narrowest fit of cylinders about a joint's axis at rest, parts fixed to its parts included; None if there is none.

    Only cylinders of B-reps count: where a mesh is the solid itself, its facets are what meets.
    """
    pair = bore_and_pin(scene, joint)
    if pair is None:
        return None
    bore, pin = (one.face for one in pair)
    return Bore(2 * bore.radius, 2 * pin.radius, bore.off + pin.off)


def bore_and_pin(scene: Scene, joint: Joint) -> tuple[PartFace, PartFace] | None:
    """Return the faces of the bore and the pin that `bore_of` measures, in the joint's frame, with their parts; None if there is none."""
    if joint.type not in _TURNING:
        return None
    found = []
    faces = [[one for one in side if _is_about_axis(one.face) and scene.deflections[one.part] > 0] for side in sides(scene, joint)]
    for first, second in ((faces[0], faces[1]), (faces[1], faces[0])):
        for bore in (one for one in first if one.face.hollow):
            for pin in (one for one in second if not one.face.hollow):
                apart = offset(bore.face, pin.face)
                (low, high), (start, end) = along(bore.face), along(pin.face)
                near = abs(bore.face.radius - pin.face.radius) + bore.face.off + pin.face.off
                if apart <= near and min(high, end) > max(low, start):
                    found.append((bore, pin))
    return min(found, key=lambda pair: abs(pair[0].face.radius - pair[1].face.radius), default=None)


def along(face: Face, axis: FloatArray = _Z) -> tuple[float, float]:
    """Return the extent of a face along an axis, z by default [mm]."""
    heights = face.corners @ axis
    return float(heights.min()), float(heights.max())


def beside(face: Face) -> float:
    """Return the distance of a cylinder's axis from the z axis in its middle [mm]; infinity if they are not parallel."""
    if np.hypot(face.axis[0], face.axis[1]) > TILT:
        return math.inf
    return float(np.linalg.norm(at_height(face, sum(along(face)) / 2)))


def offset(a: Face, b: Face) -> float:
    """Return the distance of the axes of two cylinders about z [mm], in the middle of the second."""
    height = sum(along(b)) / 2
    return float(np.linalg.norm(at_height(a, height) - at_height(b, height)))


def at_height(face: Face, height: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the point of a cylinder's axis at a height above the origin, `(2,)` [mm]."""
    return np.asarray((face.point + (height - face.point[2]) / face.axis[2] * face.axis)[:2])


def _is_about_axis(face: Face) -> bool:
    """Return whether a face is a cylinder parallel to z that the z axis passes through."""
    return face.kind == "cylinder" and beside(face) < face.radius
