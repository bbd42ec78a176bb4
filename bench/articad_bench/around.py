"""How far round its axis the two bodies of a joint keep a distance: a bearing that is open to one side does not hold its shaft all round."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.kinematics.joints import Joint
from articad_bench.bodies import parts_of
from articad_bench.check import Bounds, widened
from articad_bench.solids import ray_lengths
from articad_bench.subject import Subject

LEVELS: Final = 9  # places along the axis at which the distance is measured
ANGLES: Final = 72  # directions there
_STEP_MM: Final = 1e-4  # off a surface, where a ray begins


def share_around(subject: Subject, joint: Joint, mm: Bounds) -> float:
    """Return the share of a turn about a joint's axis in which its two bodies keep a distance within bounds, where along the axis it is largest."""
    low, high = widened(mm)
    into = (subject.rest[joint.parent] @ joint.T_parent_connector).inverse()
    bodies = [_meshes(subject, end, into) for end in (joint.parent, joint.child)]
    start = max(min(float(mesh.bounds[0][2]) for mesh in body) for body in bodies)
    end = min(max(float(mesh.bounds[1][2]) for mesh in body) for body in bodies)
    gaps = [_gaps(bodies, start + (end - start) * (place + 0.5) / LEVELS) for place in range(LEVELS if end > start else 0)]
    return max((float(((gap >= low) & (gap <= high)).mean()) for gap in gaps), default=0.0)


def _meshes(subject: Subject, part: str, into: SE3) -> list[TriMesh]:
    """Return the meshes of the body of a part in another frame, at rest."""
    body = parts_of(subject, subject.rigid[part])
    return [mesh.transformed(into @ subject.rest[name]) for name in body if (mesh := subject.assembly.parts[name].mesh) is not None]


def _gaps(bodies: Sequence[Sequence[TriMesh]], level: float) -> FloatArray:
    """Return the distance of two bodies about the z axis at a height, in each direction; inf where one of them is not there `(ANGLES,)` [mm]."""
    angles = 2 * np.pi * (np.arange(ANGLES) + 0.25) / ANGLES
    ways = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(ANGLES)])
    axis = np.array([0.0, 0.0, level])
    inner, outer = sorted(((_first(body, axis + 0 * ways, ways), body) for body in bodies), key=lambda each: float(np.median(each[0])))
    met = np.isfinite(outer[0])
    gaps = np.full(ANGLES, np.inf)
    if met.any():
        gaps[met] = _first(inner[1], axis + (outer[0][met, None] - _STEP_MM) * ways[met], -ways[met]) + _STEP_MM
    return gaps


def _first(body: Sequence[TriMesh], origins: FloatArray, ways: FloatArray) -> FloatArray:
    """Return how far each ray goes to a body [mm]."""
    return np.asarray(np.min([ray_lengths(mesh, origins, ways) for mesh in body], axis=0))
