"""Whether a rigid body stands on a level floor, and how far the floor may tilt before it tips over.

Let h be the height of the centre of mass over the floor and r(φ) the distance from the point below it to the edge of the support polygon in
the direction φ. If the floor sinks in that direction by the angle α, the line of gravity moves by h tan α, and the body tips over beyond
tan α = r(φ) / h. The least of these angles belongs to the nearest edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from articad.arrays import FloatArray
from articad.interference.report import rounded

__all__ = ["Stance", "stance"]

FLOOR_MM: Final = 0.1  # points this close to the lowest one touch the floor
_THIN_MM: Final = 1e-3  # polygons narrower than this are an edge


@dataclass(frozen=True)
class Stance:
    """How a product stands at one pose.

    Attributes:
        at: Values of the drivers that are not at rest [rad, mm].
        polygon: Corners of the support polygon, anticlockwise, `(n, 2)` [mm]; fewer than three if it stands on a point or an edge.
        com: Centre of mass over the floor, `(3,)` [mm].
        margin: Distance of the point below it from the nearest edge [mm]; negative outside.
        tip: Least angle by which the floor may tilt before the product tips over [rad]; negative if it tips over on a level floor.
        towards: Direction in which it tips at that angle, `(2,)`.
    """

    at: dict[str, float]
    polygon: FloatArray
    com: FloatArray
    margin: float
    tip: float
    towards: FloatArray

    @property
    def stands(self) -> bool:
        """Whether it stays on a level floor."""
        return self.margin > 0

    def tip_towards(self, direction: FloatArray) -> float:
        """Return the angle by which the floor may sink in a direction `(2,)` before the product tips over [rad].

        Negative if the product does not stand.
        """
        if not self.stands:
            return self.tip
        way = direction / np.linalg.norm(direction)
        normals, distances = _edges(self.polygon, self.com[:2])
        speed = normals @ way
        ahead = speed > 1e-12
        return float(np.arctan2((distances[ahead] / speed[ahead]).min(), self.com[2]))

    def to_json(self) -> dict[str, Any]:
        """Return a row of the report."""
        return {
            "at": {name: rounded(value) for name, value in self.at.items()},
            "stands": self.stands,
            "margin_mm": rounded(self.margin),
            "tip_deg": rounded(math.degrees(self.tip)),
            "towards": [rounded(float(x)) for x in self.towards],
            "com_mm": [rounded(float(x)) for x in self.com],
            "polygon_mm": [[rounded(float(x)) for x in corner] for corner in self.polygon],
        }


def stance(points: FloatArray, com: FloatArray, at: dict[str, float] | None = None) -> Stance:
    """Return how a rigid body stands.

    Args:
        points: Vertices of all its parts in the ground frame with z up, `(n, 3)` [mm].
        com: Its centre of mass, `(3,)` [mm].
        at: Values of the drivers that are not at rest.
    """
    floor = float(points[:, 2].min())
    feet = np.unique(points[points[:, 2] <= floor + FLOOR_MM][:, :2], axis=0)
    over = np.array([com[0], com[1], com[2] - floor])
    try:
        hull = ConvexHull(feet) if len(feet) > 2 else None
    except QhullError:  # all in a line
        hull = None
    polygon = feet if hull is None else feet[hull.vertices]
    if hull is None or _width(polygon) < _THIN_MM:
        away = over[:2] - polygon.mean(axis=0)
        return Stance(dict(at or {}), polygon[:2], over, -float(np.linalg.norm(away)), 0.0, away)
    normals, distances = _edges(polygon, over[:2])
    nearest = int(distances.argmin())
    margin = float(distances[nearest])
    return Stance(dict(at or {}), polygon, over, margin, math.atan2(margin, over[2]), normals[nearest])


def _edges(polygon: FloatArray, point: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the outward normals of a polygon's edges `(n, 2)`, and how far a point is inside of each, `(n,)` [mm]."""
    along = np.roll(polygon, -1, axis=0) - polygon
    normals = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    return normals, ((polygon - point) * normals).sum(axis=1)


def _width(polygon: FloatArray) -> float:
    normals, _ = _edges(polygon, polygon[0])
    return float(min(np.ptp(polygon @ normal) for normal in normals))
