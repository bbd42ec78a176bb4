"""Judge each joint: which surfaces make it, which freedoms they leave that it should remove, and where they lose it.

A joint is examined at rest and at both ends of each of its freedoms. Nothing is known between these poses. A joint that other parts
hold is examined at rest alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.findings import Finding, Findings
from articad.geometry.faces import faces_of
from articad.interference.freedoms import Freedom, freedoms
from articad.interference.report import rounded
from articad.interference.sampled_ranges import sampled_piece
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint, JointType
from articad.realisation.contacts import FaceReach, Pair, pairs
from articad.realisation.holders import Holders, HoldingChain
from articad.realisation.holes import TOUCH_MM, lost_holes
from articad.realisation.room import FAR_RAD, GROUND, Rise, Touch, far_mm, room
from articad.realisation.sides import PartFace, Sides, sides
from articad.realisation.stops import Stops

__all__ = ["LEAST_SHARE", "LOOSE_MM", "OWN", "FreeWay", "JointCheck", "JointVerdict", "Realisation", "check_joints", "is_loose"]

LEAST_SHARE: Final = 0.25  # of a guide that a slide keeps engaged at the ends of its range
_ROUNDING = 1e-6  # of a share
TILT_RAD: Final = 0.15  # a body that may tilt by less is held
_FLAT_MM, _FLAT_SHARE, _FLAT_MOST = 1.0, 0.01, 5.0  # reach of planes: the larger of the two; the share is of the child's diagonal
_ROUND_MM, _ROUND_SHARE = 0.5, 0.1  # reach of cylinders and spheres; the share is of the radius
_UP = 0.9  # cosine: a direction in which the weight holds a part
_ASIDE = 0.1  # the same of a normal, below which a face is across a way
_OVER = 0.3  # the same for a way aslant, over a flank that stops the straight way
_SHORT_MM = 1.0  # guides shorter than this have no share
_WAYS: Final = "ways"  # unit of a number of ways along or about which nothing ends a motion
LOOSE_MM: Final = 1.0  # play across the axis of a pin in its bore: more is no clearance
_NAMES: Final = ("x", "y", "z", "about x", "about y", "about z")

JointVerdict = Literal["made", "partly", "not made", "held by others", "not assessed"]

# components x, y, z, about x, y, z in the joint's frame that the joint itself moves along
OWN: Final = {
    JointType.FIXED: (0, 0, 0, 0, 0, 0),
    JointType.REVOLUTE: (0, 0, 0, 0, 0, 1),
    JointType.SLIDER: (0, 0, 1, 0, 0, 0),
    JointType.CYLINDRICAL: (0, 0, 1, 0, 0, 1),
    JointType.SCREW: (0, 0, 1, 0, 0, 1),  # the thread is not assessed
    JointType.BALL: (0, 0, 0, 1, 1, 1),
    JointType.PLANAR: (1, 1, 0, 0, 0, 1),
    JointType.UNIVERSAL: (0, 0, 0, 1, 1, 0),
}
_ROUND_AXIS = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW)


class FreeWay(NamedTuple):
    """A freedom that a joint should remove and that no surface removes.

    Attributes:
        way: Such as "+z" or "about x", in the joint's frame on the parent.
        room: How far the child may move [mm or rad]: exact for straight ways, to first order for tilts; infinity if its partner does not stop it.
        by_weight: Whether only the weight of the child acts against it: the motion lifts its centre of mass.
        holding: What ends a straight way at rest instead, if other parts are pushed along between the two; None if nothing does.
    """

    way: str
    room: float
    by_weight: bool
    holding: HoldingChain | None = None


@dataclass(frozen=True)
class JointCheck:
    """One row: how a joint is made.

    Attributes:
        joint: Its name.
        type: Its type.
        parts: Its two parts.
        verdict: "made": all other freedoms are removed at all poses that were examined; "partly": some are not; "not made": no surfaces
            of the two sides make it; "held by others": only with other parts; "not assessed".
        pairs: The surfaces at rest: kind, parts, play [mm] and number of pairs of that kind.
        losses: Freedoms that stay, at the worst pose.
        at: That pose [rad, mm]; None at rest.
        by: What else holds it. For straight ways chains of parts: one that is in the child's way, one that is in the way of that one, up to a part of
            the parent's side; if there are none, each part that touches the child.
        share: Least share of the guide that is engaged at an end of the range; None for joints that do not slide.
        share_at: That end [rad, mm].
        poses: Number of poses examined.
        reason: What is not assessed.
    """

    joint: str
    type: str
    parts: tuple[str, str]
    verdict: JointVerdict
    pairs: tuple[tuple[str, tuple[str, str], float, int], ...] = ()
    losses: tuple[FreeWay, ...] = ()
    at: Mapping[str, float] | None = None
    by: tuple[tuple[str, ...], ...] = ()
    share: float | None = None
    share_at: Mapping[str, float] | None = None
    poses: int = 0
    reason: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return a row of the table."""
        return {
            "joint": self.joint,
            "type": self.type,
            "parts": list(self.parts),
            "verdict": self.verdict,
            "made_by": [
                {"kind": kind, "parts": list(parts), "play_mm": rounded(play), "count": count} for kind, parts, play, count in self.pairs
            ],
            "free": [
                {
                    "way": loss.way,
                    "room": None if math.isinf(loss.room) else rounded(loss.room),
                    "by_weight": loss.by_weight,
                    "held_by": [] if loss.holding is None else list(loss.holding.parts),
                    "held_after": None if loss.holding is None else rounded(loss.holding.travel),
                }
                for loss in self.losses
            ],
            "at": _rounded(self.at),
            "held_by": [list(chain) for chain in self.by],
            "engaged_share": rounded(self.share),
            "engaged_at": _rounded(self.share_at),
            "poses": self.poses,
            "reason": self.reason,
        }


@dataclass(frozen=True)
class Realisation:
    """How the joints of an assembly are made.

    Attributes:
        findings: One for each joint that is not made, or lost in motion, and for each fixed one whose holes do not meet; all are warnings.
        rows: One for each joint, in order.
    """

    findings: Findings
    rows: tuple[JointCheck, ...]

    def to_json(self) -> dict[str, Any]:
        """Return the table with its findings, `articad.realisation/1`."""
        return {
            "schema": "articad.realisation/1",
            "ok": self.findings.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "rows": [row.to_json() for row in self.rows],
        }


def check_joints(
    scene: Scene,
    poses: Mapping[str, SE3],
    *,
    reached: Mapping[str, tuple[float, float]] | None = None,
    joints: Sequence[str] | None = None,
) -> Realisation:
    """Judge how each joint is made.

    Args:
        scene: Bodies, relations and fits.
        poses: Poses of the parts at rest, with z up: to find other parts that hold a joint, and what the weight holds.
        reached: Ranges of coordinates that follow others [rad, mm]; a joint of a linkage need not reach its own limits.
        joints: Names of the joints to judge; all by default.
    """
    holders = Holders(scene, poses)
    judged = [joint for joint in scene.relations.joints if joints is None or joint.name in joints]
    rows = [_Examined(scene, poses, joint).row(reached or {}, holders) for joint in judged]
    lost = (finding for joint in judged for finding in lost_holes(scene, poses, joint))
    return Realisation(Findings([*(finding for row in rows for finding in _findings(row)), *lost]), tuple(rows))


def is_loose(finding: Finding) -> bool:
    """Return whether a finding about a joint says that its pin has more play across its axis than `LOOSE_MM`, or that it leaves its guide in some way."""
    return finding.unit in ("mm", _WAYS) and finding.value is not None and finding.limit is not None and finding.value > finding.limit


class _Examined:
    """One joint and the faces of its two sides."""

    def __init__(self, scene: Scene, poses: Mapping[str, SE3], joint: Joint) -> None:
        self.scene, self.poses, self.joint = scene, poses, joint
        fit = scene.fits.get(joint.name)
        widest = (fit.gap_max or 0.0) if fit is not None else 0.0
        slack = scene.deflections.get(joint.parent, 0.0) + scene.deflections.get(joint.child, 0.0)
        self.size = 0.0
        if joint.child in scene.meshes:
            self.size = float(np.linalg.norm(np.ptp(scene.meshes[joint.child].bounds, axis=0)))
        flat = min(max(_FLAT_MM, _FLAT_SHARE * self.size), _FLAT_MOST)
        self.reach = FaceReach(max(flat, widest + slack), max(_ROUND_MM, widest + slack), _ROUND_SHARE)
        if joint.type is JointType.FIXED:
            self.reach = FaceReach(TOUCH_MM + slack, TOUCH_MM + slack, 0.0)
        self.up = np.asarray((poses[joint.parent] @ joint.T_parent_connector).rotation)[2]  # the world's z in the joint's frame

    def row(self, reached: Mapping[str, tuple[float, float]], holders: Holders) -> JointCheck:
        """Return the joint's row."""
        joint = self.joint
        row = JointCheck(joint.name, str(joint.type), (joint.parent, joint.child), "not assessed")
        missing = [name for name in row.parts if name not in self.scene.meshes]
        if joint.type not in OWN or missing:
            return replace(row, reason=f"{' and '.join(missing)} without geometry" if missing else f"a {joint.type} joint has no surfaces")
        rest = sides(self.scene, joint)
        found = pairs(rest, self.reach)
        row = replace(row, pairs=_summary(found), poses=1)
        if joint.type is JointType.FIXED:
            verdict: JointVerdict = "made" if found else "not assessed"
            reason = "what holds the faces together is not assessed" if found else "no flat or round surfaces touch"
            return replace(row, verdict=verdict, reason=reason)
        if joint.type is JointType.SCREW:
            row = replace(row, reason="the thread is not assessed")
        losses = self._losses(rest, found)
        row = replace(row, verdict="made", losses=tuple(self._held(loss, holders) for loss in losses))
        if losses:
            row = self._otherwise(row, rest, found)
        return self._over(row, found, reached) if row.verdict in ("made", "partly") and not row.by else row

    def _losses(
        self, at: Sides, found: Sequence[Pair], values: Sequence[float] | None = None, more: Sequence[Touch] = ()
    ) -> tuple[FreeWay, ...]:
        """Return the freedoms that contacts leave and the joint should remove.

        Args:
            at: The faces of the joint's two sides.
            found: Their pairs within reach.
            values: Of the joint's freedoms [rad, mm]; at rest by default.
            more: Contacts of both with other bodies, and of those with each other.
        """
        held, touches = np.array(OWN[self.joint.type], dtype=bool), [*_own(found), *more]
        free, far = room(touches, held, self._centre(found)), far_mm(touches)
        stops, losses = Stops(self.scene, self.joint, values), []
        for column in np.flatnonzero(~held[:3]):
            for sign, name, value in zip((1.0, -1.0), "+-", free[:, column], strict=True):
                if value >= far * (1 - 1e-9):
                    end, way = stops.room(int(column), sign, found, held[:3], self.reach.round)
                    if end > self.reach.round:
                        steep = _UP if abs(way[column]) == 1.0 else _OVER
                        losses.append(FreeWay(name + _NAMES[column], end, by_weight=float(way @ self.up) >= steep))
        tilting = [int(column) for column in np.flatnonzero(~held) if column >= 3 and _tilts(free, int(column))]
        return (*losses, *(self._tilts(tilting, at, found, losses, stops, more) if tilting else ()))

    def _held(self, loss: FreeWay, holders: Holders) -> FreeWay:
        """Return a freedom with what other parts do against it: only a straight way, and not one that goes aslant past a stop of the partner."""
        if loss.by_weight or loss.way.startswith("about"):
            return loss
        way = np.eye(3)["xyz".index(loss.way[1])] * (1.0 if loss.way[0] == "+" else -1.0)
        if Stops(self.scene, self.joint).travel(way) < loss.room:
            return loss
        frame = self.poses[self.joint.parent] @ self.joint.T_parent_connector
        holding = holders.along(self.joint, np.asarray(frame.rotation @ way))
        return loss if holding is None or holding.travel >= loss.room else loss._replace(holding=holding)

    def _tilts(
        self, columns: Sequence[int], at: Sides, found: Sequence[Pair], losses: Sequence[FreeWay], stops: Stops, more: Sequence[Touch]
    ) -> Iterator[FreeWay]:
        """Yield the tilts that contacts leave in place: those of faces that are as far apart as the child moves when it tilts.

        A way in which the child leaves is not gone along. The weight holds a tilt that lifts its centre of mass: at the angle θ to first
        order by more than the turn about its foot lowers it, h θ² / 2 with its height h above the lowest contact.
        """
        found = [*found, *self._wide(at)]
        held, centre, touches = np.array(OWN[self.joint.type], dtype=bool), self._centre(found), [*_own(found), *more]
        for loss in losses:
            if math.isinf(loss.room) and not loss.by_weight:
                held[_NAMES.index(loss.way[1:])] = True
        free = room(touches, held, centre)
        columns = [column for column in columns if _tilts(free, column)]
        if columns:
            mass = stops.weight()
            lowest = min((float((pair.points @ self.up).min()) for pair in found), default=math.inf)
            height = max(0.0, float(mass @ self.up) - lowest)
            rising = room(touches, held, centre, Rise(self.up, mass, height * TILT_RAD**2 / 2))
        for column in columns:
            value = float(free[:, column].max())
            yield FreeWay(_NAMES[column], math.inf if value >= FAR_RAD * (1 - 1e-9) else value, by_weight=not _tilts(rising, column))

    def _wide(self, at: Sides) -> list[Pair]:
        """Return the pairs of faces that a tilt may bring together, across the ways that the joint itself moves along: it leaves the others."""
        wide = max(_FLAT_MOST, TILT_RAD * self.size)
        own = np.flatnonzero(OWN[self.joint.type][:3])
        found = pairs(at, FaceReach(max(wide, self.reach.flat), max(wide, self.reach.round), self.reach.share))
        return [pair for pair in found if float(np.abs(pair.normals[:, own]).max(initial=0.0)) < _ASIDE]

    def _centre(self, found: Sequence[Pair]) -> FloatArray:
        """Return the point whose translation is examined: that of a ball or universal joint, else the middle of the contacts."""
        if not found or self.joint.type in (JointType.BALL, JointType.UNIVERSAL):
            return np.zeros(3)
        every = np.concatenate([pair.points for pair in found])
        return np.asarray((every.min(axis=0) + every.max(axis=0)) / 2)

    def _otherwise(self, row: JointCheck, rest: Sides, found: Sequence[Pair]) -> JointCheck:
        """Return the row of a joint that its own two sides do not make: perhaps with other parts, or with surfaces that are not known."""
        more, touching = self._around(rest)
        if touching:
            losses = self._losses(rest, found, more=more)
            if len(losses) < len(row.losses):
                verdict: JointVerdict = "partly" if _unsupported(losses) else "held by others"
                held = {loss.way: loss.holding for loss in row.losses if loss.holding is not None}
                left = tuple(loss._replace(holding=held.pop(loss.way, None)) for loss in losses)
                chains = {holding.parts for holding in held.values()} or {(part,) for part in touching}
                return replace(row, verdict=verdict, losses=left, by=tuple(sorted(chains)))
        if not _unsupported(row.losses):
            return replace(row, verdict="partly")
        if self._unknown_near(rest):
            return replace(row, verdict="not assessed", reason="surfaces that are not plane, cylindrical or spherical meet there")
        return replace(row, verdict="partly" if self._is_begun(found) else "not made")

    def _is_begun(self, found: Sequence[Pair]) -> bool:
        """Return whether surfaces of the kind that the joint needs were found."""
        kinds = {pair.kind for pair in found}
        if self.joint.type in _ROUND_AXIS:
            return bool({"pin in bore", "pin on flat"} & kinds)
        return bool(kinds)

    def _around(self, rest: Sides) -> tuple[list[Touch], set[str]]:
        """Return the contacts at rest of the bodies that the child touches, at once or through others, and the parts that touch it itself."""
        own = {one.part for side in rest for one in side}
        to_joint = (self.poses[self.joint.parent] @ self.joint.T_parent_connector).inverse()
        bodies: dict[str, list[PartFace]] = {}
        for name, mesh in self.scene.meshes.items():
            if name not in own and name in self.poses and name not in self.scene.environment:
                T = np.asarray((to_joint @ self.poses[name]).matrix)
                leader = self.scene.relations.rigid.leader(name)
                bodies.setdefault(leader, []).extend(PartFace(name, face.moved(T)) for face in faces_of(mesh))
        numbered = {GROUND: rest.parent, 0: rest.child} | {k: tuple(faces) for k, faces in enumerate(bodies.values(), start=1)}
        touches, by, done, reached = [], set(), {(GROUND, 0)}, [0]
        for one in reached:  # grows: what touches nothing that touches the child does not hold it
            for other in numbered:
                i, j = min(one, other), max(one, other)
                if i == j or (i, j) in done:
                    continue
                done.add((i, j))
                found = pairs(Sides(numbered[i], numbered[j]), self.reach)
                touches += [Touch(i, j, pair.points, pair.normals, pair.gaps, pair.grazing) for pair in found]
                by |= {pair.parts[1] for pair in found if i == 0}
                if found and other != GROUND and other not in reached:
                    reached.append(other)
        return touches, by

    def _unknown_near(self, rest: Sides) -> bool:
        """Return whether a face of one side that is not recognised is close to any face of the other side."""
        for first, second in ((rest.parent, rest.child), (rest.child, rest.parent)):
            for one in first:
                if one.face.kind != "other":
                    continue
                low, high = one.face.corners.min(axis=(0, 1)) - self.reach.flat, one.face.corners.max(axis=(0, 1)) + self.reach.flat
                for other in second:
                    corners = other.face.corners
                    if (corners.max(axis=(0, 1)) >= low).all() and (corners.min(axis=(0, 1)) <= high).all():
                        return True
        return False

    def _over(self, row: JointCheck, found: Sequence[Pair], reached: Mapping[str, tuple[float, float]]) -> JointCheck:
        """Return the row of a joint that its own two sides make at rest, perhaps in part, examined at the ends of its range.

        The first end that loses what is held at rest ends the examination: its losses replace those at rest.
        """
        length = _guide(found) if self._slides() else 0.0
        for at, values in self._ends(reached):
            moved = sides(self.scene, self.joint, values)
            there = pairs(moved, self.reach)
            row = replace(row, poses=row.poses + 1)
            share = _share(there, length) if length > _SHORT_MM else None
            if share is not None and (row.share is None or share < row.share):
                row = replace(row, share=share, share_at=at)
            losses = self._losses(moved, there, values)
            if _lost_since(self.joint.type, row.losses, losses):
                return replace(row, verdict="partly", losses=losses, at=at)
        return row

    def _slides(self) -> bool:
        return self.joint.type in (JointType.SLIDER, JointType.CYLINDRICAL)

    def _ends(self, reached: Mapping[str, tuple[float, float]]) -> Iterator[tuple[dict[str, float], list[float]]]:
        """Yield the poses at the ends of each freedom, the others at rest."""
        if self.joint.type in (JointType.BALL, JointType.UNIVERSAL):
            ends = [freedom for freedom in freedoms(self.joint) if not freedom.name.endswith("twist")]
            ends = ends if self.joint.type is JointType.BALL else []
        else:
            ends = list(freedoms(self.joint))
        every = freedoms(self.joint)
        for freedom in ends:
            place = [one.name for one in every].index(freedom.name)
            for value in self._values(freedom, reached):
                yield {freedom.name: value}, [value if k == place else one.rest for k, one in enumerate(every)]

    def _values(self, freedom: Freedom, reached: Mapping[str, tuple[float, float]]) -> list[float]:
        lower, upper = freedom.lower, freedom.upper
        if freedom.name in reached:
            lower, upper = max(lower, reached[freedom.name][0]), min(upper, reached[freedom.name][1])
        piece = sampled_piece(self.joint, freedom)
        if piece != freedom:  # a slide without limits ends nowhere
            return []
        return [value for value in (lower, upper) if abs(value - freedom.rest) > 1e-9]


def _own(found: Sequence[Pair]) -> list[Touch]:
    """Return the contacts of the joint's own two sides: the child is body 0."""
    return [Touch(GROUND, 0, pair.points, pair.normals, pair.gaps, pair.grazing) for pair in found]


def _tilts(free: FloatArray, column: int) -> bool:
    return bool(free[:, column].max() >= TILT_RAD * (1 - 1e-9))


def _unsupported(losses: Sequence[FreeWay]) -> bool:
    return any(not loss.by_weight for loss in losses)


def _lost_since(kind: JointType, rest: Sequence[FreeWay], there: Sequence[FreeWay]) -> bool:
    """Return whether a joint loses a way at another pose, but not by weight, that it holds at rest, or ends there after some play.

    The ways across an axis that the child turns about turn with it. A tilt that ends says nothing new of a joint with losses at rest:
    it may be there by a hair less.
    """
    turns = kind is not JointType.SLIDER
    lost = {_family(loss.way, turns) for loss in rest}
    endless = {_family(loss.way, turns) for loss in rest if math.isinf(loss.room)}
    for loss in there:
        family, ends = _family(loss.way, turns), math.isfinite(loss.room)
        tilts = loss.way.startswith("about")
        if loss.by_weight or (rest and tilts and ends):
            continue
        if family not in lost or not (ends or tilts or family in endless):
            return True
    return False


def _family(way: str, turns: bool) -> str:
    """Return the name of the ways that turn into each other as the child turns about z; each straight one of +z and -z is alone."""
    axis = way[-1]
    if not turns or axis == "z":
        return way
    return "about" if way.startswith("about") else "across"


def _rounded(at: Mapping[str, float] | None) -> dict[str, Any] | None:
    return None if at is None else {name: rounded(value) for name, value in at.items()}


def _summary(found: Sequence[Pair]) -> tuple[tuple[str, tuple[str, str], float, int], ...]:
    """Return the pairs by kind and parts: the least play, and how many there are."""
    table: dict[tuple[str, tuple[str, str]], list[float]] = {}
    for pair in found:
        table.setdefault((pair.kind, pair.parts), []).append(pair.play)
    return tuple((kind, parts, min(plays), len(plays)) for (kind, parts), plays in table.items())


def _guide(found: Sequence[Pair]) -> float:
    """Return how much of a guide could be engaged at most: the length along z of the shorter side of its longest pair [mm]."""
    return max((min(float(np.ptp(face.corners[..., 2])) for face in pair.faces) for pair in found), default=0.0)


def _share(found: Sequence[Pair], length: float) -> float:
    """Return the share of a guide that is engaged."""
    if not found:
        return 0.0
    ends = [[(float(face.corners[..., 2].min()), float(face.corners[..., 2].max())) for face in pair.faces] for pair in found]
    engaged = max(min(top_a, top_b) - max(low_a, low_b) for (low_a, top_a), (low_b, top_b) in ends)
    return min(1.0, max(0.0, engaged / length)) if length > 0 else 0.0


def _is_short(share: float) -> bool:
    return share < LEAST_SHARE - _ROUNDING


def _findings(row: JointCheck) -> Iterator[Finding]:
    where, a, b = f"joints.{row.joint}", *row.parts
    at = _at(row.at)
    ways = _left([loss for loss in row.losses if not loss.by_weight])
    pose = None if row.at is None else dict(row.at)
    play = _play_across(row)
    across: dict[str, Any] = {} if play is None else {"value": play, "limit": LOOSE_MM, "unit": "mm"}
    lost = sum(math.isinf(loss.room) and not loss.by_weight for loss in row.losses)
    if row.at is not None and lost:
        across = {"value": float(lost), "limit": 0.0, "unit": _WAYS}
    if row.verdict == "not made":
        yield Finding(
            code="W_JOINT_NOT_MADE",
            where=where,
            parts=row.parts,
            message=f"No surfaces of {a} and {b} form the {row.type} joint {row.joint!r}: they leave the child {ways}.",
            hint=_remedy(row.type),
            stage="fit",
            **across,
        )
    elif row.verdict == "partly" and ways:
        code = "W_JOINT_PARTLY_MADE" if row.at is None else "W_JOINT_LEAVES"
        yield Finding(
            code=code,
            where=where,
            parts=row.parts,
            message=f"The {row.type} joint {row.joint!r} of {a} and {b} leaves the child {ways}{at}.{_holders(row)}",
            hint="Lengthen the guide or the pin, or shorten the range."
            if row.at
            else "Add surfaces that stop these motions, or a part that does.",
            pose=pose,
            stage="fit",
            **across,
        )
    if row.share is not None and _is_short(row.share) and row.at is None:
        yield Finding(
            code="W_JOINT_SHORT",
            where=where,
            parts=row.parts,
            message=f"Joint {row.joint!r} keeps {100 * row.share:.3g} % of its guide engaged{_at(row.share_at)}; at least 25 % is needed.",
            hint="Lengthen the guide, or shorten the travel.",
            value=row.share,
            limit=LEAST_SHARE,
            pose=None if row.share_at is None else dict(row.share_at),
            stage="fit",
        )


def _at(pose: Mapping[str, float] | None) -> str:
    return "" if pose is None else " at " + ", ".join(f"{name} = {value:.4g}" for name, value in pose.items())


def _play_across(row: JointCheck) -> float | None:
    """Return how far a pin moves across its axis in its bore [mm], if it is not held there and cannot leave."""
    if row.type not in _ROUND_AXIS:
        return None
    play = max((loss.room for loss in row.losses if loss.way[1:] in ("x", "y") and not loss.by_weight), default=math.inf)
    return play if math.isfinite(play) else None


def _left(losses: Sequence[FreeWay]) -> str:
    """Return what a joint leaves its child, such as "free along +z, about x, with 2 mm of play along -z"."""
    free = [_along(loss) for loss in losses if math.isinf(loss.room)]
    plays = [
        f"{loss.room:.3g} {'rad' if loss.way.startswith('about') else 'mm'} of play {_along(loss)}"
        for loss in losses
        if math.isfinite(loss.room)
    ]
    return ", with ".join([*([f"free {', '.join(free)}"] if free else []), *([", ".join(plays)] if plays else [])])


def _holders(row: JointCheck) -> str:
    """Return what other parts do against ways that are free, such as " Other parts end this: along +z, lid is held by pin, ..."."""
    told = [
        f"along {loss.way} after {loss.holding.travel:.3g} mm, where {row.parts[1]} is held by {', which is held by '.join(loss.holding.parts)}"
        for loss in row.losses
        if loss.holding is not None
    ]
    return f" Other parts end this, if each moves straight: {'; '.join(told)}." if told else ""


def _along(loss: FreeWay) -> str:
    return loss.way if loss.way.startswith("about") else f"along {loss.way}"


def _remedy(kind: str) -> str:
    if kind == "ball":
        return "Give one part a ball and the other a socket about the joint's centre that holds more than half of it."
    if kind in ("slider", "planar"):
        return "Give one part a guide that encloses the other, such as a groove, a rail or two rods in bores."
    return "Give one part a pin about the joint's axis and the other a bore for it."
