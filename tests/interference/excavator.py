"""An excavator of thirteen parts: a house that swings, boom, stick and bucket, three cylinders, and the four-bar that turns the bucket.

Everything but the swing moves in the plane xy; parts lie in layers along z. The bucket lies in the layer of the boom, so that a long one
meets the boom only where the stick is folded in and the bucket is curled.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from articad.assembly import Assembly
from articad.connectors import SE3, Connector
from articad.geometry import TriMesh, box
from articad.geometry.part import Part
from articad.kinematics.joints import Joint
from tests.interference.mechanisms import joint

Point = tuple[float, float]

SHOULDER, ELBOW, WRIST = (0.0, 0.0), (300.0, 60.0), (340.0, -120.0)
LIFT, CROWD, CURL = ((40.0, -60.0), (150.0, 20.0)), ((180.0, 70.0), (320.0, 100.0)), ((330.0, 20.0), (385.0, -60.0))
ROCKER_FOOT, BUCKET_PIN = (334.0, -85.0), (365.0, -140.0)
STROKE = 20.0  # mm: of each cylinder, to either side of rest
THICK = 8.0  # mm
DRIVERS = ("swing", "lift", "crowd", "curl")


def excavator(bucket: float) -> Assembly:
    """Return it with a bucket of a length [mm]; drivers are the swing and three cylinders."""
    upright = SE3.from_axes((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    joints = [
        replace(joint("swing", "revolute", "tracks", "house", at_parent=upright, at_child=upright), driver=True),
        _pin("shoulder", "house", "boom", SHOULDER),
        *_cylinder("lift", "house", "boom", *LIFT),
        _pin("elbow", "boom", "stick", ELBOW),
        *_cylinder("crowd", "boom", "stick", *CROWD),
        _pin("wrist", "stick", "bucket", WRIST),
        _pin("knee", "stick", "rocker", ROCKER_FOOT),
        *_cylinder("curl", "stick", "rocker", *CURL),
        _pin("near", "rocker", "link", CURL[1]),
        _pin("far", "link", "bucket", BUCKET_PIN),
    ]
    tip = WRIST[0] - bucket, WRIST[1] - 0.35 * bucket
    meshes: dict[str, TriMesh] = {
        "tracks": box(300, 20, 160).transformed(SE3.from_translation([0.0, -420.0, 0.0])),
        "house": box(60, 30, 60).transformed(SE3.from_translation([-80.0, -95.0, 0.0])),
        "boom": _bar(SHOULDER, ELBOW, 0),
        "stick": _bar((325.0, 130.0), WRIST, 1),
        "bucket": _bar(BUCKET_PIN, tip, 0),
        "rocker": _bar(ROCKER_FOOT, CURL[1], 2),
        "link": _bar(CURL[1], BUCKET_PIN, 3),
    }
    for name, (foot, head), layer in (("lift", LIFT, -1), ("crowd", CROWD, 2), ("curl", CURL, 4)):
        middle = (0.6 * np.array(foot) + 0.4 * np.array(head)).tolist()
        meshes[f"{name}_barrel"] = _bar(foot, middle, layer)
        meshes[f"{name}_rod"] = _bar(middle, head, layer + math.copysign(1, layer))
    connectors: dict[str, dict[str, Connector]] = {name: {} for name in meshes}
    named = []
    for one in joints:
        ends = f"{one.name}_p", f"{one.name}_c"
        connectors[one.parent][ends[0]] = Connector(ends[0], one.T_parent_connector)
        connectors[one.child][ends[1]] = Connector(ends[1], one.T_child_connector)
        named.append(replace(one, parent_connector=ends[0], child_connector=ends[1]))
    parts = [Part.from_mesh(name, mesh, density=7850.0, connectors=connectors[name]) for name, mesh in meshes.items()]
    return Assembly.from_parts("excavator", parts=parts, joints=named, ground="tracks")


def _pin(name: str, parent: str, child: str, place: Sequence[float]) -> Joint:
    at = SE3.from_translation([*place, 0.0])
    return joint(name, "revolute", parent, child, at_parent=at, at_child=at, lower=(-math.inf,), upper=(math.inf,))


def _cylinder(name: str, base: str, arm: str, foot: Point, head: Point) -> list[Joint]:
    """Return a cylinder: its barrel on the base, its rod, which drives, on the arm."""
    way = SE3.from_axes((*foot, 0.0), (head[0] - foot[0], head[1] - foot[1], 0.0))
    barrel, rod = f"{name}_barrel", f"{name}_rod"
    slide = joint(name, "slider", barrel, rod, at_parent=way, at_child=way, lower=(-STROKE,), upper=(STROKE,))
    return [_pin(f"{name}_foot", base, barrel, foot), replace(slide, driver=True), _pin(f"{name}_head", rod, arm, head)]


def _bar(start: Sequence[float], end: Sequence[float], layer: float) -> TriMesh:
    """Return a bar from one place to another in a layer, with air between layers."""
    way = np.subtract(end, start)
    middle = [*((np.array(start) + end) / 2).tolist(), layer * (THICK + 2)]
    turn = SE3.rot_z(math.atan2(way[1], way[0]))
    return box(float(np.linalg.norm(way)), THICK, THICK).transformed(SE3.from_translation(middle) @ turn)
