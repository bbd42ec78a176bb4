"""Mechanisms: joints, trees, loops, poses and velocities. NumPy only; Pinocchio and SciPy are loaded where they are used.

Lengths are millimetres, angles radians. Independent of files, meshes, plans and models.
"""

from articad.kinematics.configuration import Configuration
from articad.kinematics.graph import JointGraph
from articad.kinematics.joints import Coordinate, Coupling, Joint, JointLimits, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.solution import Solution
from articad.kinematics.tree import Edge, KinematicTree

__all__ = [
    "Configuration",
    "Coordinate",
    "Coupling",
    "Edge",
    "Joint",
    "JointGraph",
    "JointLimits",
    "JointType",
    "KinematicTree",
    "Layout",
    "Mechanism",
    "Solution",
]
