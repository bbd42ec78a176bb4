"""The mate relation: how a joint places one part on another.

    T_child = T_parent · C_p · M · F · C_c⁻¹

M is the joint's motion, measured about and along the parent connector's +z; F is the identity for `aligned` and half a turn about x for
`opposed`. Two mated connectors coincide, up to F, where M is the identity.
"""

from __future__ import annotations

from enum import StrEnum

from articad.connectors.connector import Drift
from articad.connectors.se3 import SE3


class Mate(StrEnum):
    """The orientation of two mated connectors: z axes aligned or opposed."""

    ALIGNED = "aligned"
    OPPOSED = "opposed"


FLIP: SE3 = SE3.from_quaternion([1.0, 0.0, 0.0, 0.0])  # half a turn about x, without the rounding of sin π

_IDENTITY = SE3.identity()


def flip(mate: Mate) -> SE3:
    """Return F of the mate."""
    return FLIP if mate == Mate.OPPOSED else _IDENTITY


def child_pose(T_parent: SE3, C_p: SE3, motion: SE3, mate: Mate, C_c: SE3) -> SE3:
    """Return the pose of the child part, given the parent's and the joint's motion; batches broadcast."""
    return T_parent @ C_p @ motion @ flip(mate) @ C_c.inverse()


def parent_pose(T_child: SE3, C_p: SE3, motion: SE3, mate: Mate, C_c: SE3) -> SE3:
    """Return the pose of the parent part, given the child's and the joint's motion; batches broadcast."""
    return T_child @ (C_p @ motion @ flip(mate) @ C_c.inverse()).inverse()


def rest_mismatch(T_parent: SE3, C_p: SE3, motion: SE3, mate: Mate, C_c: SE3, T_child: SE3) -> SE3:
    """Return D = (T_parent C_p M F)⁻¹ T_child C_c: the identity when the two connectors meet at rest."""
    return (T_parent @ C_p @ motion @ flip(mate)).inverse() @ T_child @ C_c


def drift_of(D: SE3) -> Drift:
    """Return the components of a mismatch: radial and along [mm], axis and roll [rad]."""
    return Drift.of(D)
