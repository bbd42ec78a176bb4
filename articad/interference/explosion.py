"""Exploded views: each part moves out of the part that carries it, along the axis of the joint between them.

The axis of a joint's connector is the direction in which the part was put there: a shaft leaves its bore, a lid its hinge pin, a leg its
socket. A part takes along all that it carries.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.part import Part
from articad.kinematics.joints import Joint
from articad.kinematics.tree import Edge

__all__ = ["exploded", "explosion"]

_GAP = 0.15  # of the part's extent along the way, left free between the part and its carrier
_FARTHEST = 0.45  # of the assembly's size: a part that must go farther to be free stays nearer


def explosion(parts: Mapping[str, Part], edges: tuple[Edge, ...], poses: Mapping[str, SE3]) -> dict[str, FloatArray]:
    """Return the way of each part that another one carries, `(3,)` [mm], in the frame of the carrier.

    The way leads along the joint's axis, to the side on which the part's middle lies, and just so far that the part's bounding box
    leaves its carrier's. The axis is the carrier's connector z.

    Args:
        parts: By name.
        edges: The spanning tree, carriers first.
        poses: `T_ground_part` at rest.
    """
    points = {name: _points(part) for name, part in parts.items()}
    placed = [poses[name].apply(corners) for name, corners in points.items() if len(corners)]
    size = float(np.linalg.norm(np.ptp(np.concatenate(placed), axis=0))) if placed else 0.0
    ways: dict[str, FloatArray] = {}
    for edge in edges:
        own, carrier = points[edge.part], points[edge.parent]
        if not len(own) or not len(carrier):
            ways[edge.part] = np.zeros(3)
            continue
        seen = (poses[edge.parent].inverse() @ poses[edge.part]).apply(own)
        axis = _axis(edge.joint, edge.parent)
        middle = (seen.min(axis=0) + seen.max(axis=0) - carrier.min(axis=0) - carrier.max(axis=0)) / 2
        way = axis if float(middle @ axis) >= -1e-6 * size else -axis
        along = seen @ way
        free = float((carrier @ way).max() - along.min()) + _GAP * float(np.ptp(along))
        ways[edge.part] = way * min(max(free, 0.0), _FARTHEST * size)
    return ways


def exploded(
    parts: Mapping[str, Part], edges: tuple[Edge, ...], rest: Mapping[str, SE3], poses: Mapping[str, SE3], factor: float
) -> dict[str, SE3]:
    """Return the poses with each part moved by `factor` times its way, and all that it carries with it.

    Args:
        parts: By name.
        edges: The spanning tree, carriers first.
        rest: `T_ground_part` at rest, which determines the ways.
        poses: `T_ground_part` to explode.
        factor: 0 for as assembled, 1 for free of each other.
    """
    ways = explosion(parts, edges, rest)
    offset = {name: np.zeros(3) for name in parts}
    for edge in edges:
        offset[edge.part] = offset[edge.parent] + factor * (poses[edge.parent].matrix[:3, :3] @ ways[edge.part])
    return {name: SE3.from_translation(offset[name]) @ T for name, T in poses.items()}


def _axis(joint: Joint, carrier: str) -> FloatArray:
    frame = joint.T_parent_connector if joint.parent == carrier else joint.T_child_connector
    return np.asarray(frame.matrix[:3, 2], dtype=np.float64)


def _points(part: Part) -> FloatArray:
    found = [shape.placed.vertices for shape in part.visuals or part.collisions if len(shape.mesh.vertices)]
    return np.concatenate(found) if found else np.zeros((0, 3))
