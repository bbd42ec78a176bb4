"""Connectors and the algebra of rigid motions: NumPy only.

Lengths are millimetres, angles radians. Names of frames: `T_a_b` maps coordinates of frame b into frame a.
"""

from articad.connectors.attachment import Attachment
from articad.connectors.connector import Connector, Drift, Plane
from articad.connectors.mate import FLIP, Mate, child_pose, drift_of, flip, parent_pose, rest_mismatch
from articad.connectors.se3 import SE3, axis_findings, world_x

__all__ = [
    "FLIP",
    "SE3",
    "Attachment",
    "Connector",
    "Drift",
    "Mate",
    "Plane",
    "axis_findings",
    "child_pose",
    "drift_of",
    "flip",
    "parent_pose",
    "rest_mismatch",
    "world_x",
]
