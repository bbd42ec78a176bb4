"""Mechanisms: joints, trees, loops, poses and velocities. NumPy only; Pinocchio and SciPy are loaded where they are used.

Lengths are millimetres, angles radians. Independent of files, meshes, plans and models.

`joints.py` is the one table of joint types, `declare.py` makes joints in Python. `graph.py` and `tree.py` choose what carries what;
`mechanism.py` is the front. Poses of one configuration: `forward.py` (Pinocchio); of many: `batch.py` and `bulk.py` (NumPy).
`loops.py` closes loops, with the equations in `equations.py` and couplings in `ties.py`; `branch.py` keeps to the branch of rest, along
`continuation.py`, `track.py` and `roadmap.py`. `mobility.py` counts freedoms, `motion.py`, `path.py` and `reach.py` move, `dynamics.py`
computes forces.
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
