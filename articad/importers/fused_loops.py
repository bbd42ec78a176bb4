"""Constraints that close loops, merged into the joints that they represent.

MJCF closes a loop by points that two bodies share, or by a weld. Two points make a hinge about the line through them. A body without
shape that hangs on one joint and is welded to another body is a part of that body: the joint connects the other body itself.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from articad.assembly import Kept
from articad.connectors.se3 import SE3
from articad.geometry.mass import MassProperties
from articad.importers.raw import ENDLESS, RawJoint, RawModel, aligned
from articad.kinematics.joints import JointType

HINGE_MM = 1e-3  # by which the distance of two points may differ between the bodies that share them
LEAST_APART_MM = 1.0  # of two points whose line is an axis


@dataclass(frozen=True, eq=False)
class FusedLoop:
    """A joint that closes a loop.

    Attributes:
        joint: The joint.
        represented_by: The constraints, and the joint of a welded body.
        welded: Name of the welded body without shape, if there is one.
        T_welded: Its pose in the child of the joint.
    """

    joint: RawJoint
    represented_by: tuple[RawJoint, ...]
    welded: str | None = None
    T_welded: SE3 | None = None


def fused_loops(model: RawModel) -> list[FusedLoop]:
    """Return the joints that constraints of a model represent."""
    return [*_hinges(model), *_welded(model)]


def with_loops(model: RawModel, loops: Sequence[FusedLoop]) -> RawModel:
    """Return the model with joints in place of what represents them. The mass of a welded body becomes the other body's."""
    links, joints, kept = dict(model.links), list(model.joints), list(model.kept)
    for loop in loops:
        gone = {joint.name for joint in loop.represented_by}
        joints = [*(joint for joint in joints if joint.name not in gone), loop.joint]
        for index, item in enumerate(kept):  # an equality that is kept verbatim names sites and bodies that are no longer there
            if item.where in {f"joints.{name}" for name in gone} and item.xml.startswith("<equality"):
                kept[index] = Kept(item.format, f"joints.{loop.joint.name}", item.what)
        if loop.welded is not None and loop.T_welded is not None:
            body, link = links.pop(loop.welded), links[loop.joint.child]
            masses = [mass for mass in (link.mass, body.mass and body.mass.moved(loop.T_welded)) if mass is not None]
            links[link.name] = replace(link, mass=MassProperties.combined(masses) if masses else None)
    return replace(model, links=links, joints=joints, kept=kept)


def _hinges(model: RawModel) -> list[FusedLoop]:
    """Two points that the same two bodies share: a hinge about the line through them, at zero where the points are read."""
    points: dict[frozenset[str], list[RawJoint]] = {}
    for joint in model.joints:
        if joint.closing and joint.type is JointType.BALL and joint.cone == math.pi and joint.twist is None:
            points.setdefault(frozenset((joint.parent, joint.child)), []).append(joint)
    found = []
    for pair in points.values():
        if len(pair) != 2:
            continue
        first, second = pair
        if second.parent != first.parent:
            second = replace(second, parent=second.child, child=second.parent, frame_p=second.frame_c, frame_c=second.frame_p)
        lines = [(here.inverse() @ there).translation for here, there in ((first.frame_p, second.frame_p), (first.frame_c, second.frame_c))]
        lengths = [float(np.linalg.norm(line)) for line in lines]
        if min(lengths) < LEAST_APART_MM or abs(lengths[0] - lengths[1]) > HINGE_MM:
            continue
        frame_p, frame_c = (
            frame @ SE3.from_translation(line / 2) @ aligned(line)
            for frame, line in zip((first.frame_p, first.frame_c), lines, strict=True)
        )
        hinge = RawJoint(_free_name(model, pair), JointType.REVOLUTE, first.parent, first.child, frame_p, frame_c, (ENDLESS,), closing=True)
        found.append(FusedLoop(hinge, tuple(pair)))
    return found


def _welded(model: RawModel) -> list[FusedLoop]:
    """A body without shape on one joint of the tree, welded to a body other than the one that carries it."""
    ends = Counter(name for joint in model.joints for name in (joint.parent, joint.child))
    above = {joint.child: joint for joint in model.joints if not joint.closing}
    found: list[FusedLoop] = []
    for weld in model.joints:
        if not weld.closing or weld.type is not JointType.FIXED:
            continue
        T = weld.frame_c @ weld.frame_p.inverse()  # pose of the parent in the child
        for body, other, T_body in ((weld.parent, weld.child, T), (weld.child, weld.parent, T.inverse())):
            link, joint = model.links[body], above.get(body)
            if joint is None or body == model.ground or ends[body] != 2 or link.visuals or link.collisions or other == joint.parent:
                continue
            if joint.type in {JointType.FIXED, JointType.FREE}:
                continue
            found.append(FusedLoop(replace(joint, child=other, frame_c=T_body @ joint.frame_c, closing=True), (weld, joint), body, T_body))
            break
    return [loop for loop in found if loop.joint.child not in {each.welded for each in found}]


def _free_name(model: RawModel, pair: Sequence[RawJoint]) -> str:
    """Return `pin` of `pin__a` and `pin__b`, else the first name; none that another joint has."""
    stems = {joint.name.rpartition("__")[0] for joint in pair}
    name = next(iter(stems)) if len(stems) == 1 else ""
    taken = {joint.name for joint in model.joints}
    return name if name and name not in taken else pair[0].name
