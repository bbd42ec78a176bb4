"""The content of foreign files in one form: links, and joints between frames on them; converted to an assembly.

Links keep their own frames, so that poses can be compared with other readers. A joint of a file relates its two links by
`T_child = T_parent · frame_p · J(q) · frame_c⁻¹`, where J turns about or slides along z like all our joints.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly, Kept
from articad.connectors.connector import Connector
from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.findings import Finding, Findings
from articad.geometry.mass import MassProperties
from articad.geometry.part import DEFAULT_COLOR, Part, Shape
from articad.importers.driving import driven
from articad.importers.reading import LARGEST_MM, MAX_LINKS, unreadable
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism

IDENTITY = SE3.identity()
ENDLESS = (-math.inf, math.inf)
_CHANGED = frozenset(
    {"W_IMPORT_DROPPED", "W_IMPORT_MESH", "W_IMPORT_LIMITS"}
)  # findings about data that the file has and the assembly has not


@dataclass(frozen=True, eq=False)
class RawLink:
    """A link or body.

    Attributes:
        name: Name in the file.
        mass: In the link's frame; None if the file gives none.
        visuals: Shapes to draw.
        collisions: Shapes for collision.
        color: "#rrggbb".
    """

    name: str
    mass: MassProperties | None = None
    visuals: tuple[Shape, ...] = ()
    collisions: tuple[Shape, ...] = ()
    color: str = DEFAULT_COLOR


@dataclass(frozen=True, eq=False)
class RawJoint:
    """A joint between two links, in mm and rad.

    Attributes:
        name: Name in the file.
        type: The joint type.
        parent: Name of the link that carries `frame_p`.
        child: Name of the other.
        frame_p: In the parent link's frame.
        frame_c: In the child link's frame.
        ranges: Limits of each coordinate; empty for a ball, a fixed and a free joint.
        cone: Cone of a ball.
        twist: Twist range of a ball.
        lead: Lead of a screw.
        rest: Wanted rest values; the nearest ones within the limits are used.
        effort: [N·mm] or [N], None if the file gives none.
        velocity: [rad/s] or [mm/s], likewise.
        damping: [N·mm·s/rad] or [N·s/mm]; zero if the file states none.
        friction: [N·mm] or [N], likewise.
        closing: True if it was a constraint in the file, not a joint of its tree.
    """

    name: str
    type: JointType
    parent: str
    child: str
    frame_p: SE3
    frame_c: SE3
    ranges: tuple[tuple[float, float], ...] = ()
    cone: float | None = None
    twist: tuple[float, float] | None = None
    lead: float = 0.0
    rest: tuple[float, ...] = ()
    effort: tuple[float | None, ...] = ()
    velocity: tuple[float | None, ...] = ()
    damping: tuple[float | None, ...] = ()
    friction: tuple[float | None, ...] = ()
    closing: bool = False


@dataclass(frozen=True)
class RawTie:
    """value(follower) = ratio · value(leader) + offset, in mm and rad."""

    follower: str
    leader: str
    ratio: float
    offset: float

    @property
    def name(self) -> str:
        """Name of the coupling that it becomes."""
        return f"{self.follower}_follows_{self.leader}"


@dataclass
class RawModel:
    """Everything that was read.

    Attributes:
        name: Name of the robot.
        ground: Name of the root link.
        links: By name, in the file's order.
        joints: In the file's order.
        ties: Between joints of one coordinate.
        driven: Names of the joints on which actuators act.
        findings: Findings about what could not be converted.
        kept: Data of the file that no other field holds.
    """

    name: str
    ground: str
    links: dict[str, RawLink] = field(default_factory=dict)
    joints: list[RawJoint] = field(default_factory=list)
    ties: list[RawTie] = field(default_factory=list)
    driven: frozenset[str] = frozenset()
    findings: list[Finding] = field(default_factory=list)
    kept: list[Kept] = field(default_factory=list)

    def bare_link(self, wanted: str) -> str:
        """Add a link without shape; return its name, which is unused before."""
        while wanted in self.links:
            wanted += "_"
        self.links[wanted] = RawLink(wanted)
        return wanted


def aligned(axis: FloatArray) -> SE3:
    """Return a rotation that maps z to `axis`, the identity or half a turn if it is ±z."""
    x, y, z = axis / np.linalg.norm(axis)
    if x == 0 and y == 0:
        return IDENTITY if z > 0 else FLIP
    return SE3.from_axes(np.zeros(3), axis)


def require_links(model: RawModel, path: Path) -> None:
    """Refuse joints of missing links.

    Raises:
        ReadError: If there is one.
    """
    for joint in model.joints:
        for link in (joint.parent, joint.child):
            if link not in model.links:
                raise unreadable(path, f"joint {joint.name!r}", f"Its link {link!r} is not in the file.")


def assemble(model: RawModel, path: Path) -> Assembly:
    """Return the assembly.

    Raises:
        ReadError: If it is too large, or is not a mechanism.
    """
    if len(model.links) > MAX_LINKS:
        raise unreadable(path, "", f"It has {len(model.links)} links; the maximum is {MAX_LINKS}.")
    require_links(model, path)
    connectors: dict[str, dict[str, Connector]] = {name: {} for name in model.links}
    for joint in model.joints:
        for link, frame in ((joint.parent, joint.frame_p), (joint.child, joint.frame_c)):
            if not np.abs(frame.translation).max() <= LARGEST_MM:  # also refuses NaN
                raise unreadable(path, f"joint {joint.name!r}", "Its position is not plausible.")
            connectors[link][joint.name] = Connector(joint.name, frame)
    ties = _consistent_ties(model)
    rests = _rest_values(model.joints, ties)
    joints = [_joint(joint, rests[joint.name], model.findings) for joint in model.joints]
    couplings = [Coupling(tie.name, "linear", tie.leader, tie.follower, tie.ratio, tie.offset) for tie in ties]
    parts = {
        name: Part(name, connectors[name], link.visuals, link.collisions, None, link.mass, link.color) for name, link in model.links.items()
    }
    try:
        mechanism = Mechanism(tuple(parts), model.ground, joints, couplings)
        mechanism.rest  # noqa: B018 - raises if loops do not close
        mechanism = driven(mechanism, model.driven)
    except (ArticadError, np.linalg.LinAlgError) as error:
        raise unreadable(path, "", f"It is not a valid mechanism: {error}") from error
    kept_at = {item.where for item in model.kept if item.format == "mjcf"}  # what MJCF says there is kept, and reported where it is lost
    changed = [
        Kept("file", finding.where, finding.message)
        for finding in model.findings
        if finding.code in _CHANGED and not finding.where.startswith("equality.") and finding.where not in kept_at
    ]
    return Assembly(model.name, mechanism, parts, findings=Findings(model.findings), foreign=True, kept=(*model.kept, *changed))


def _consistent_ties(model: RawModel) -> list[RawTie]:
    """Drop relations of joints that are missing or have several coordinates."""
    single = {joint.name for joint in model.joints if len(joint.ranges) == 1}
    kept = []
    for tie in model.ties:
        if {tie.follower, tie.leader} <= single and tie.ratio != 0 and tie.follower != tie.leader:
            kept.append(tie)
        else:
            message = f"{tie.follower!r} cannot follow {tie.leader!r}: one of them has no coordinate of that name, or the ratio is zero."
            model.findings.append(
                Finding(code="W_IMPORT_DROPPED", where=f"joints.{tie.follower}", message=message, hint="Correct the file.")
            )
    return kept


def _rest_values(joints: list[RawJoint], ties: list[RawTie]) -> dict[str, tuple[float, ...]]:
    """Return rest values: the wanted ones, moved into the limits; followers where their leaders put them."""
    rests: dict[str, tuple[float, ...]] = {}
    for joint in joints:
        if joint.type.quaternion is not None:
            rests[joint.name] = joint.rest or joint.type.neutral
            continue
        wanted = joint.rest or (0.0,) * len(joint.ranges)
        rests[joint.name] = tuple(min(max(value, low), high) for value, (low, high) in zip(wanted, joint.ranges, strict=True))
    for _ in range(len(ties)):  # a chain of followers settles in as many rounds as it has links
        before = dict(rests)
        for tie in ties:
            rests[tie.follower] = (tie.ratio * rests[tie.leader][0] + tie.offset,)
        if rests == before:
            break
    return rests


def _joint(joint: RawJoint, rest: tuple[float, ...], findings: list[Finding]) -> Joint:
    ranges = []
    for (low, high), value, unit in zip(joint.ranges, rest, joint.type.units, strict=False):
        if not low <= value <= high:
            limits = f"[{low:.6g}, {high:.6g}] {unit}"
            message = (
                f"Joint {joint.name!r} follows another joint and rests at {value:.6g} {unit}, outside {limits}; its limits were widened."
            )
            findings.append(
                Finding(
                    code="W_IMPORT_LIMITS",
                    where=f"joints.{joint.name}",
                    message=message,
                    hint="Widen the limits in the file, or correct the ratio and offset.",
                )
            )
        ranges.append((min(low, value), max(high, value)))
    return Joint(
        name=joint.name,
        type=joint.type,
        parent=joint.parent,
        child=joint.child,
        parent_connector=joint.name,
        child_connector=joint.name,
        T_parent_connector=joint.frame_p,
        T_child_connector=joint.frame_c,
        mate=Mate.ALIGNED,
        limits=JointLimits(tuple(low for low, _ in ranges), tuple(high for _, high in ranges), joint.cone, joint.twist),
        rest=rest,
        lead=joint.lead,
        effort=joint.effort,
        velocity=joint.velocity,
        damping=joint.damping
        or ((0.0,) * max(len(ranges), 1) if joint.type not in {JointType.FIXED, JointType.FREE} else ()),  # unstated means none
        friction=joint.friction,
        closing=joint.closing,
    )
