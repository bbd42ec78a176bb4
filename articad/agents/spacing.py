"""Spacing: how far apart the joints of a rigid piece are, which no bounding box shows."""

from __future__ import annotations

import itertools
from typing import Final

import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.export.hulls import rigid_groups
from articad.kinematics.joints import JointType

_AXES: Final = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW)
_POINTS: Final = (JointType.BALL, JointType.UNIVERSAL)
_PARALLEL: Final = 1e-6  # sine of the angle between two axes
_LEAST_MM: Final = 0.01  # axes that are closer are one
MOST: Final = 6  # distances of one piece; a plate with many pins has more, and nobody reads them


def spacings(assembly: Assembly) -> list[str]:
    """Return a line for each rigid piece that has two joints which turn: the distances of their axes, or of their origins where these are not parallel [mm].

    A piece is a part with all that fixed joints join to it: the throw of a crank lies between its shaft and a pin of its own.
    """
    piece, rest = rigid_groups(tuple(assembly.joints), tuple(assembly.parts)), assembly.at()
    frames: dict[int, dict[str, tuple[JointType, SE3]]] = {piece[name]: {} for name in assembly.parts}
    for joint in assembly.joints:
        if joint.type in _AXES or joint.type in _POINTS:
            for name, frame in ((joint.parent, joint.T_parent_connector), (joint.child, joint.T_child_connector)):
                frames[piece[name]][joint.name] = joint.type, rest[name] @ frame
    lines = []
    for number, own in frames.items():
        found = [(a, b, _apart(own[a], own[b])) for a, b in itertools.combinations(own, 2)]
        told = [f"{a} to {b} {round(distance, 2):g}" for a, b, distance in found if distance > _LEAST_MM]
        if told:
            members = " and ".join(name for name in assembly.parts if piece[name] == number)
            more = f" and {len(told) - MOST} more" if len(told) > MOST else ""
            lines.append(f"- {members}: {', '.join(told[:MOST])}{more}")
    return lines


def _apart(first: tuple[JointType, SE3], second: tuple[JointType, SE3]) -> float:
    """Return the distance of two parallel axes, else of the origins [mm]; a ball or universal joint is a point on any axis."""
    between: FloatArray = np.asarray(second[1].translation) - np.asarray(first[1].translation)
    axes = [np.asarray(frame.rotation)[:, 2] for kind, frame in (first, second) if kind in _AXES]
    if len(axes) == 2 and float(np.linalg.norm(np.cross(axes[0], axes[1]))) > _PARALLEL:
        return float(np.linalg.norm(between))
    if axes:
        between = between - (between @ axes[0]) * axes[0]
    return float(np.linalg.norm(between))
