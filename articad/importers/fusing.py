"""Chains of one-freedom joints over bare links, merged into the joints that they represent.

A bare link has no shape, at most a gram of mass, one joint before it and one after it, and both meet in one point. With X the rotation
between the two joints' frames: a slide and a turn about one axis form a cylindrical joint, or a screw if the slide follows the turn; two
turns about perpendicular axes form a universal joint, three a ball; two slides and a turn about perpendicular axes form a planar joint.
Constraints that close loops are merged after the chains (`fused_loops`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.geometry.mass import MassProperties
from articad.importers.fused_loops import fused_loops, with_loops
from articad.importers.raw import RawJoint, RawLink, RawModel, RawTie
from articad.kinematics.joints import JointType

BARE_MASS_KG = 1e-3  # at most: exporters give carriers a little mass, because engines refuse massless links
SAME_POINT_MM = 1e-6
SAME_AXIS = 1e-9  # rad, and sine of the angle
TWIST_ROUNDING = 1e-12  # rad: rounding of a twist that begins or ends at zero

_SLIDE, _TURN = JointType.SLIDER, JointType.REVOLUTE


def fused(model: RawModel) -> RawModel:
    """Return the model with each chain over bare links, and the constraints of each loop, replaced by the joint that they represent."""
    merged = _replaced(model, _chains(model))
    loops = fused_loops(merged)
    findings = [_merged(loop.joint, loop.represented_by) for loop in loops]
    return replace(with_loops(merged, loops), findings=[*merged.findings, *findings])


def with_chains_named(model: RawModel) -> RawModel:
    """Return the model unchanged, with a note for everything that `fused` would replace by one joint."""
    chains = _chains(model)
    loops = [(loop.joint, loop.represented_by) for loop in fused_loops(_replaced(model, chains))]
    findings = [
        Finding(
            code="I_IMPORT_CHAIN",
            where=f"joints.{joint.name}",
            message=f"{' and '.join(repr(part.name) for part in chain)} together form one {joint.type} joint; they are kept apart.",
            hint="Read with fuse to merge them.",
        )
        for joint, chain in (*chains.values(), *loops)
    ]
    return replace(model, findings=[*model.findings, *findings])


def _chains(model: RawModel) -> dict[str, tuple[RawJoint, tuple[RawJoint, ...]]]:
    """Return the joints that chains represent, and the chains, by the name of the last joint of each."""
    bare = _bare_links(model)
    before: dict[str, RawJoint] = {joint.child: joint for joint in model.joints}
    beyond: dict[str, RawJoint] = {joint.parent: joint for joint in reversed(model.joints)}
    found: dict[str, tuple[RawJoint, tuple[RawJoint, ...]]] = {}  # by the name of the chain's last joint
    used: set[str] = set()
    for last in model.joints:
        chain = [last]
        while len(chain) < 3 and chain[0].parent in bare and chain[0].parent in before:
            chain.insert(0, before[chain[0].parent])
        if last.child in bare and _continue(last, beyond[last.child]):
            continue  # a longer chain ends farther out
        for start in range(len(chain) - 1):
            joints = tuple(chain[start:])
            if used & {joint.name for joint in joints}:
                continue
            joint = _fuse(joints, model.ties)
            if joint is not None:
                found[last.name] = joint, joints
                used |= {part.name for part in joints}
                break
    return found


def _bare_links(model: RawModel) -> set[str]:
    """Return the links that could be carriers: no shape, almost no mass, one tree joint on each side, no constraint."""
    degree: dict[str, list[int]] = {name: [0, 0] for name in model.links}
    for joint in model.joints:
        for link, side in ((joint.child, 0), (joint.parent, 1)):
            if link in degree:
                degree[link][side] += 2 if joint.closing else 1
    return {
        name
        for name, link in model.links.items()
        if degree[name] == [1, 1]
        and not link.visuals
        and not link.collisions
        and (link.mass is None or link.mass.mass <= BARE_MASS_KG)
        and name != model.ground
    }


def _continue(last: RawJoint, beyond: RawJoint) -> bool:
    """True when the joint beyond a bare link belongs to the same chain as the last one before it."""
    return beyond.type in {_SLIDE, _TURN} and last.type in {_SLIDE, _TURN}


def _meet(joints: tuple[RawJoint, ...]) -> bool:
    """True if the two joints of every link between them meet at one point."""
    return all(float(np.linalg.norm(a.frame_c.translation - b.frame_p.translation)) <= SAME_POINT_MM for a, b in pairwise(joints))


def _fuse(joints: tuple[RawJoint, ...], ties: list[RawTie]) -> RawJoint | None:
    kinds = tuple(joint.type for joint in joints)
    rule = _RULES.get(kinds)
    tied = {tie.follower for tie in ties} | {tie.leader for tie in ties}
    inner = _relation(ties, joints) if len(joints) == 2 else []
    if (
        rule is None
        or (rule is not _fuse_cylindrical and not _meet(joints))
        or (tied & {joint.name for joint in joints} and not (len(inner) == 1 and rule is _fuse_cylindrical))
    ):
        return None
    return rule(joints, inner)


def _relation(ties: list[RawTie], joints: tuple[RawJoint, ...]) -> list[RawTie]:
    """Return how the first of two joints follows the second, directly or through others that both follow; nothing if it does not."""
    first, second = (joint.name for joint in joints)
    found = {second: (1.0, 0.0)}  # value = ratio · value(second) + offset
    usable = [tie for tie in ties if tie.ratio]
    for _ in usable:
        for tie in usable:
            if tie.leader in found and tie.follower not in found:
                ratio, offset = found[tie.leader]
                found[tie.follower] = tie.ratio * ratio, tie.ratio * offset + tie.offset
            elif tie.follower in found and tie.leader not in found:
                ratio, offset = found[tie.follower]
                found[tie.leader] = ratio / tie.ratio, (offset - tie.offset) / tie.ratio
        if first in found:
            return [RawTie(first, second, *found[first])]
    return []


def _between(first: RawJoint, second: RawJoint) -> SE3:
    """Return X, the rotation from the first joint's moving frame to the second joint's fixed one."""
    return SE3.from_quaternion((first.frame_c.inverse() @ second.frame_p).quaternion)


def _fuse_cylindrical(joints: tuple[RawJoint, ...], inner: list[RawTie]) -> RawJoint | None:
    """Slide and turn, in either order, along ± one axis: M₁ X M₂(q) = M₁ M₂(± q) X."""
    first, second = joints
    X = first.frame_c.inverse() @ second.frame_p  # may be anywhere on the axis: it commutes with slides along it and turns about it
    if math.hypot(*X.z_axis[:2]) > SAME_AXIS or math.hypot(*X.translation[:2]) > SAME_POINT_MM:
        return None
    sign = 1.0 if X.z_axis[2] > 0 else -1.0
    slide, turn = (first, second) if first.type is _SLIDE else (second, first)
    turned = {second.name: sign, first.name: 1.0}
    whole = replace(
        first,
        name=_common_name(joints),
        type=JointType.CYLINDRICAL,
        child=second.child,
        frame_c=second.frame_c @ X.inverse(),
        ranges=(_signed(slide.ranges[0], turned[slide.name]), _signed(turn.ranges[0], turned[turn.name])),
        rest=tuple(turned[joint.name] * joint.rest[0] for joint in (slide, turn) if joint.rest),
        **_capacities((slide, turn)),
    )
    if not inner:
        return whole
    tie = inner[0]
    ratio, offset = (tie.ratio, tie.offset) if tie.follower == slide.name else (1 / tie.ratio, -tie.offset / tie.ratio)
    along = turned[slide.name] * offset
    return replace(
        whole,
        type=JointType.SCREW,
        frame_p=first.frame_p @ SE3.trans(0.0, 0.0, along),
        ranges=(whole.ranges[1],),
        rest=whole.rest[1:],
        lead=ratio * turned[slide.name] * turned[turn.name] * math.tau,
        **_capacities((turn,)),
    )


def _fuse_universal(joints: tuple[RawJoint, ...], _inner: list[RawTie]) -> RawJoint | None:
    """Two turns about perpendicular axes: M₁ X M₂ = W Rx(a) Ry(b) W⁻¹ X with W x and W y along the two axes."""
    first, second = joints
    X = _between(first, second)
    if abs(X.z_axis[2]) > SAME_AXIS:
        return None
    W = _frame_of(np.array([0.0, 0.0, 1.0]), X.z_axis)
    return replace(
        first,
        name=_common_name(joints),
        type=JointType.UNIVERSAL,
        child=second.child,
        frame_p=first.frame_p @ W,
        frame_c=second.frame_c @ X.inverse() @ W,
        ranges=(*first.ranges, *second.ranges),
        rest=(*first.rest, *second.rest),
        **_capacities((first, second)),
    )


def _fuse_three(joints: tuple[RawJoint, ...], kind: JointType) -> tuple[RawJoint, float] | None:
    """Return a joint of three motions about or along x, y, ±z, and the sign of the last."""
    first, second, third = joints
    X, Y = _between(first, second), _between(second, third)
    axes = np.array([0.0, 0.0, 1.0]), X.z_axis, (X @ Y).z_axis
    W = _frame_of(axes[0], axes[1])
    along = float(axes[2] @ W.z_axis)
    if abs(float(axes[0] @ axes[1])) > SAME_AXIS or abs(abs(along) - 1) > SAME_AXIS:
        return None
    whole = replace(
        first,
        name=_common_name(joints),
        type=kind,
        child=third.child,
        frame_p=first.frame_p @ W,
        frame_c=third.frame_c @ (X @ Y).inverse() @ W,
        **_capacities(joints),
    )
    return whole, math.copysign(1.0, along)


def _fuse_planar(joints: tuple[RawJoint, ...], _inner: list[RawTie]) -> RawJoint | None:
    found = _fuse_three(joints, JointType.PLANAR)
    if found is None:
        return None
    joint, sign = found
    *rest, angle = _rests(joints)
    return replace(joint, ranges=(*joints[0].ranges, *joints[1].ranges, _signed(joints[2].ranges[0], sign)), rest=(*rest, sign * angle))


def _fuse_ball(joints: tuple[RawJoint, ...], _inner: list[RawTie]) -> RawJoint | None:
    """Three turns about x, y, ±z whose limits contain a cone and a twist; None if they do not, or if the three joints differ.

    A swing s of Rx(a)·Ry(b) has cos s = cos a · cos b, so a swing up to c stays in |a|, |b| ≤ c. The third angle is the ball's twist
    minus the twist of Rx(a)·Ry(b), which is at most w(c) (`swing_twist`), so a twist within [l + w, u − w] keeps it in [l, u]. Both
    contain 0. A ball has one effort, one velocity, one damping and one friction, so those of the three must be equal.
    """
    found = _fuse_three(joints, JointType.BALL)
    if found is None:
        return None
    joint, sign = found
    capacities: dict[str, Any] = {name: tuple(dict.fromkeys(values)) for name, values in _capacities(joints).items()}
    if any(len(values) > 1 for values in capacities.values()) or any(not one.ranges[0][0] <= 0 <= one.ranges[0][1] for one in joints[:2]):
        return None
    cone = min(*(abs(bound) for one in joints[:2] for bound in one.ranges[0]), math.pi)
    low, high = _signed(joints[2].ranges[0], sign)
    free = math.isinf(low) or math.isinf(high) or high - low >= math.tau
    own = swing_twist(cone)
    twist = low + own, high - own
    if not cone > 0 or (not free and not twist[0] <= TWIST_ROUNDING >= -twist[1]):
        return None
    x, y, z = _rests(joints)
    rest = tuple(float(v) for v in (SE3.rot_x(x) @ SE3.rot_y(y) @ SE3.rot_z(sign * z)).quaternion)
    return replace(
        joint,
        ranges=(),
        rest=rest,
        cone=cone,
        twist=None if free else (min(twist[0], 0.0), max(twist[1], 0.0)),
        **capacities,
    )


def swing_twist(cone: float) -> float:
    """Return the largest twist of Rx(a)·Ry(b) with a swing up to `cone` [rad]: that for a = b; infinite from a quarter turn on."""
    if cone >= math.pi / 2:
        return math.inf
    return 2 * math.atan(math.tan(math.acos(math.sqrt(math.cos(cone))) / 2) ** 2)


def _capacities(joints: tuple[RawJoint, ...]) -> dict[str, Any]:
    """Return effort, velocity, damping and friction of joints of one freedom, in their order."""
    names = ("effort", "velocity", "damping", "friction")
    return {name: tuple(value for joint in joints for value in getattr(joint, name)[:1]) for name in names}


def _rests(joints: tuple[RawJoint, ...]) -> list[float]:
    """Return the rest value of each joint: the stated one, else the value within its limits nearest to zero."""
    return [joint.rest[0] if joint.rest else min(max(0.0, joint.ranges[0][0]), joint.ranges[0][1]) for joint in joints]


_Rule = Callable[[tuple[RawJoint, ...], list[RawTie]], RawJoint | None]

_RULES: dict[tuple[JointType, ...], _Rule] = {
    (_SLIDE, _TURN): _fuse_cylindrical,
    (_TURN, _SLIDE): _fuse_cylindrical,
    (_TURN, _TURN): _fuse_universal,
    (_SLIDE, _SLIDE, _TURN): _fuse_planar,
    (_TURN, _TURN, _TURN): _fuse_ball,
}


def _frame_of(x: FloatArray, y: FloatArray) -> SE3:
    """Return the rotation that maps x and y to two perpendicular unit vectors."""
    return SE3.from_axes(np.zeros(3), np.cross(x, y), x) if np.linalg.norm(np.cross(x, y)) > 1e-3 else SE3.identity()


def _signed(bounds: tuple[float, float], sign: float) -> tuple[float, float]:
    return bounds if sign > 0 else (-bounds[1], -bounds[0])


def _common_name(joints: tuple[RawJoint, ...]) -> str:
    """Return `elbow` of `elbow__t` and `elbow__r`, else the last joint's name."""
    stems = {joint.name.rpartition("__")[0] for joint in joints}
    stem = stems.pop()
    return stem if stem and not stems else joints[-1].name


def _with_masses(model: RawModel, chain: tuple[RawJoint, ...]) -> RawLink:
    """Return the chain's last link with the masses of its carriers, where all values are zero."""
    link = model.links[chain[-1].child]
    if link.mass is None:
        return link
    bodies, T = [link.mass], SE3.identity()
    for joint, before in zip(chain[:0:-1], chain[-2::-1], strict=True):
        T = T @ joint.frame_c @ joint.frame_p.inverse()
        carrier = model.links[before.child].mass
        if carrier is not None:
            bodies.append(carrier.moved(T))
    return replace(link, mass=MassProperties.combined(bodies))


def _replaced(model: RawModel, found: dict[str, tuple[RawJoint, tuple[RawJoint, ...]]]) -> RawModel:
    gone = {joint.name for _, joints in found.values() for joint in joints}
    carriers = {joint.child for _, joints in found.values() for joint in joints[:-1]}
    joints = [
        found[joint.name][0] if joint.name in found else joint for joint in model.joints if joint.name in found or joint.name not in gone
    ]
    ties = _ties_of_screws(model.ties, [pair for pair in found.values() if pair[0].type is JointType.SCREW])
    findings = [_merged(joint, chain) for joint, chain in found.values()]
    links = {name: link for name, link in model.links.items() if name not in carriers}
    links |= {joint.child: _with_masses(model, chain) for joint, chain in found.values()}
    whole = {part.name: joint.name for joint, chain in found.values() for part in chain}
    driven = frozenset(whole.get(name, name) for name in model.driven)
    return replace(model, links=links, joints=joints, ties=ties, driven=driven, findings=[*model.findings, *findings])


def _ties_of_screws(ties: list[RawTie], screws: Sequence[tuple[RawJoint, tuple[RawJoint, ...]]]) -> list[RawTie]:
    """Return ties of screws in place of those of the slides and turns that they replace, without those within a screw."""
    values: dict[str, tuple[str, float, float]] = {}  # joint: the screw, and ratio and offset of its value by the screw's
    for screw, (first, second) in screws:
        slide, turn = (first, second) if first.type is _SLIDE else (second, first)
        sign = -1.0 if turn is second and _between(first, second).z_axis[2] < 0 else 1.0
        (tie,) = _relation(ties, (slide, turn))
        values[turn.name] = screw.name, sign, 0.0
        values[slide.name] = screw.name, sign * tie.ratio, tie.offset
    found: dict[tuple[str, str], RawTie] = {}
    for tie in ties:
        follower, a, b = values.get(tie.follower, (tie.follower, 1.0, 0.0))
        leader, c, d = values.get(tie.leader, (tie.leader, 1.0, 0.0))
        if follower != leader or tie.follower == tie.leader:
            found.setdefault((follower, leader), RawTie(follower, leader, tie.ratio * c / a, (tie.ratio * d + tie.offset - b) / a))
    return list(found.values())


def _merged(joint: RawJoint, represented_by: Sequence[RawJoint]) -> Finding:
    return Finding(
        code="I_IMPORT_FUSED",
        where=f"joints.{joint.name}",
        message=f"{' and '.join(repr(part.name) for part in represented_by)} were merged into one {joint.type} joint {joint.name!r}.",
        hint="Read without fuse to keep them apart.",
    )
