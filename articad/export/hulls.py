"""Convex hulls of collision shapes: simulators that collide with hulls see contacts that the solids do not have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import manifold3d
import numpy as np
from numpy.typing import NDArray

from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Shape
from articad.kinematics.joints import Joint, JointType

FloatArray = NDArray[np.float64]
Pair = tuple[str, str]

HULL_DEPTH_MM = 0.02  # mean depth of overlap that counts: below it hulls merely touch, as stacked parts do
HULL_VOLUME_MM3 = 1e-3  # rounding of a boolean


@dataclass(frozen=True)
class HullOverlap:
    """Two parts whose hulls overlap.

    Attributes:
        parts: The two, in order of declaration.
        volume: Of the overlap [mm³].
        depth: Its mean thickness, twice the volume over the surface [mm].
    """

    parts: Pair
    volume: float
    depth: float


def mating_pairs(joints: tuple[Joint, ...], order: tuple[str, ...]) -> list[Pair]:
    """Return the pairs of parts that share a joint, each once and in order of declaration."""
    rank = {part: index for index, part in enumerate(order)}
    pairs = {tuple(sorted((joint.parent, joint.child), key=rank.__getitem__)) for joint in joints}
    return sorted(((a, b) for a, b in pairs), key=lambda pair: (rank[pair[0]], rank[pair[1]]))


def rigid_groups(joints: tuple[Joint, ...], order: tuple[str, ...]) -> dict[str, int]:
    """Return for each part the number of its rigid group: parts joined by fixed joints only share one."""
    group = {part: index for index, part in enumerate(order)}
    for joint in joints:
        if joint.type is JointType.FIXED:
            old, new = group[joint.child], group[joint.parent]
            group = {part: new if number == old else number for part, number in group.items()}
    return group


def same_group_pairs(joints: tuple[Joint, ...], order: tuple[str, ...]) -> set[Pair]:
    """Return the pairs of parts that never move against each other."""
    group = rigid_groups(joints, order)
    return {(a, b) for a, b in combinations(order, 2) if group[a] == group[b]}


def hull_of(shape: Shape) -> tuple[Shape, float]:
    """Return a shape's convex hull, and by what share of its own volume the hull is larger; 0 where the mesh is open."""
    solid = manifold3d.Manifold.hull_points(shape.mesh.vertices)
    found = solid.to_mesh64()
    mesh = TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))
    own = shape.mesh.volume if shape.mesh.is_closed else 0.0
    return Shape(mesh, shape.frame, shape.color, shape.name), max(0.0, mesh.volume / own - 1) if own > 0 else 0.0


def hull_overlaps(shapes: Mapping[str, tuple[Shape, ...]], poses: Mapping[str, SE3], *, skip: set[Pair]) -> list[HullOverlap]:
    """Return the pairs of parts whose collision hulls overlap in a pose.

    Args:
        shapes: Collision shapes by part name; each has a hull of its own.
        poses: `T_ground_part` [mm].
        skip: Pairs not to look at.
    """
    hulls = {part: [_hull(shape, poses[part]) for shape in several] for part, several in shapes.items() if several}
    found = []
    for a, b in combinations(hulls, 2):
        if (a, b) in skip or (b, a) in skip:
            continue
        shared = [
            first ^ second for first, low_a, high_a in hulls[a] for second, low_b, high_b in hulls[b] if _near(low_a, high_a, low_b, high_b)
        ]
        volume = sum(solid.volume() for solid in shared)
        area = sum(solid.surface_area() for solid in shared)
        if volume > HULL_VOLUME_MM3 and 2 * volume / area > HULL_DEPTH_MM:
            found.append(HullOverlap((a, b), float(volume), float(2 * volume / area)))
    return found


def _hull(shape: Shape, T: SE3) -> tuple[manifold3d.Manifold, FloatArray, FloatArray]:
    points = (T @ shape.frame).apply(shape.mesh.vertices)
    hull = manifold3d.Manifold.hull_points(points).simplify(HULL_DEPTH_MM / 10)
    return hull, points.min(axis=0), points.max(axis=0)


def _near(low_a: FloatArray, high_a: FloatArray, low_b: FloatArray, high_b: FloatArray) -> bool:
    return bool((low_a < high_b).all() and (low_b < high_a).all())
