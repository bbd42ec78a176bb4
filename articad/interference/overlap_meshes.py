"""Overlaps as meshes, to be drawn over everything."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.interference.body import body_of, relative
from articad.interference.overlap import VOLUME_NOISE_MM3, intersection


def overlap_meshes(parts: Mapping[str, Part], poses: Mapping[str, SE3]) -> list[TriMesh]:
    """Return the common solids of all pairs of parts, in the ground frame; parts that are not solids are left out.

    Args:
        parts: By name.
        poses: `T_ground_part` by name.
    """
    bodies = {name: body_of(part.mesh) for name, part in parts.items() if part.mesh is not None}
    sound = {name: body for name, body in bodies.items() if body.fault is None}
    boxes = {name: poses[name].apply(body.mesh.vertices) for name, body in sound.items()}
    found = []
    for a, b in combinations(sound, 2):
        apart = (boxes[a].min(axis=0) > boxes[b].max(axis=0)) | (boxes[b].min(axis=0) > boxes[a].max(axis=0))
        if apart.any():
            continue
        common = intersection(sound[a], sound[b], relative(poses[a], poses[b]))
        if float(common.volume()) > VOLUME_NOISE_MM3:
            mesh = common.to_mesh64()
            vertices = np.asarray(mesh.vert_properties, dtype=np.float64)[:, :3]
            found.append(TriMesh(vertices, np.asarray(mesh.tri_verts, dtype=np.int32)).transformed(poses[a]))
    return found
