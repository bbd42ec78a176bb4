"""Joints declared in Python, one function per type: `revolute("elbow", upper["tip"], lower["root"], limits=(-2, 2))`.

Angles are in rad and lengths in mm. `parent` and `child` only determine from which side motion is measured: about and along the parent
connector's +z, right-handed.
"""

from __future__ import annotations

import math
from typing import Literal

from articad.connectors.attachment import Attachment
from articad.connectors.mate import Mate
from articad.connectors.se3 import SE3
from articad.kinematics.joints import Joint, JointLimits, JointType

Range = tuple[float, float] | Literal["endless"]
MateName = Literal["aligned", "opposed"]


def fixed(name: str, parent: Attachment, child: Attachment, *, mate: MateName = "aligned") -> Joint:
    """Hold the child rigidly: the two frames coincide, up to the mate."""
    return _joint(name, JointType.FIXED, parent, child, mate, (), ())


def revolute(
    name: str, parent: Attachment, child: Attachment, *, limits: Range, rest: float = 0.0, mate: MateName = "aligned", driver: bool = False
) -> Joint:
    """Turn about the common z by an angle within `limits` [rad], or endlessly."""
    return _joint(name, JointType.REVOLUTE, parent, child, mate, (limits,), (rest,), driver=driver)


def slider(
    name: str,
    parent: Attachment,
    child: Attachment,
    *,
    limits: tuple[float, float],
    rest: float = 0.0,
    mate: MateName = "aligned",
    driver: bool = False,
) -> Joint:
    """Slide along the common z by a travel within `limits` [mm]."""
    return _joint(name, JointType.SLIDER, parent, child, mate, (limits,), (rest,), driver=driver)


def cylindrical(
    name: str,
    parent: Attachment,
    child: Attachment,
    *,
    travel: Range,
    angle: Range,
    rest: tuple[float, float] = (0.0, 0.0),
    mate: MateName = "aligned",
    driver: bool = False,
) -> Joint:
    """Slide along and turn about the common z: `travel` [mm], `angle` [rad], in this order in `q`."""
    return _joint(name, JointType.CYLINDRICAL, parent, child, mate, (travel, angle), rest, driver=driver)


def ball(
    name: str,
    parent: Attachment,
    child: Attachment,
    *,
    cone: float,
    twist: tuple[float, float] | None = None,
    mate: MateName = "aligned",
    driver: bool = False,
) -> Joint:
    """Swing freely about a point, z within `cone` [rad] of the parent's z, twisting within `twist` [rad] about it."""
    limits = JointLimits(lower=(), upper=(), cone=cone, twist=twist)
    return Joint(
        name=name,
        type=JointType.BALL,
        parent=parent.part,
        child=child.part,
        parent_connector=parent.connector.name,
        child_connector=child.connector.name,
        T_parent_connector=parent.connector.frame,
        T_child_connector=child.connector.frame,
        mate=Mate(mate),
        limits=limits,
        rest=(0.0, 0.0, 0.0, 1.0),
        driver=driver,
    )


def screw(
    name: str,
    parent: Attachment,
    child: Attachment,
    *,
    lead: float,
    limits: Range,
    rest: float = 0.0,
    mate: MateName = "aligned",
    driver: bool = False,
) -> Joint:
    """Turn within `limits` [rad] and advance by `lead` [mm] a turn, right-handed when positive."""
    return _joint(name, JointType.SCREW, parent, child, mate, (limits,), (rest,), lead=lead, driver=driver)


def planar(
    name: str, parent: Attachment, child: Attachment, *, x: Range, y: Range, angle: Range, mate: MateName = "aligned", driver: bool = False
) -> Joint:
    """Slide in the parent's xy plane [mm] and turn about its z [rad]; rests at zero."""
    return _joint(name, JointType.PLANAR, parent, child, mate, (x, y, angle), (0.0, 0.0, 0.0), driver=driver)


def universal(
    name: str,
    parent: Attachment,
    child: Attachment,
    *,
    a: tuple[float, float],
    b: tuple[float, float],
    mate: MateName = "aligned",
    driver: bool = False,
) -> Joint:
    """Turn about the parent's x by `a`, then about the turned y by `b` [rad]; rests at zero."""
    return _joint(name, JointType.UNIVERSAL, parent, child, mate, (a, b), (0.0, 0.0), driver=driver)


def free(name: str, parent: Attachment, child: Attachment, *, rest: SE3 | None = None, mate: MateName = "aligned") -> Joint:
    """Move freely in six directions; `rest` is the pose of the child connector in the parent's, by default the identity."""
    x, y, z, qx, qy, qz, qw = (float(value) for value in (SE3.identity() if rest is None else rest).data)
    return _joint(name, JointType.FREE, parent, child, mate, (), (x, y, z, qx, qy, qz, qw))


def _joint(
    name: str,
    joint_type: JointType,
    parent: Attachment,
    child: Attachment,
    mate: MateName,
    ranges: tuple[Range, ...],
    rest: tuple[float, ...],
    *,
    lead: float = 0.0,
    driver: bool = False,
) -> Joint:
    bounds = [(-math.inf, math.inf) if limits == "endless" else (float(limits[0]), float(limits[1])) for limits in ranges]
    return Joint(
        name=name,
        type=joint_type,
        parent=parent.part,
        child=child.part,
        parent_connector=parent.connector.name,
        child_connector=child.connector.name,
        T_parent_connector=parent.connector.frame,
        T_child_connector=child.connector.frame,
        mate=Mate(mate),
        limits=JointLimits(lower=tuple(lo for lo, _ in bounds), upper=tuple(hi for _, hi in bounds)),
        rest=rest,
        lead=lead,
        driver=driver,
    )
