"""Joints: the motion of each type, and the data of one joint between two connectors.

A joint places its child by `T_child = T_parent · C_p · J(q) · F · C_c⁻¹` (`articad.connectors.mate`). J(q) is given here:
revolute Rz(θ) · slider Tz(d) · cylindrical Tz(d) Rz(θ) · ball R(quaternion) · screw Tz(lead·θ/2π) Rz(θ) ·
planar T(x, y, 0) Rz(θ) · universal Rx(a) Ry(b) · free T(x, y, z) R(quaternion) · fixed I. All angles in rad, lengths in mm.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from articad.aliases import Fastening
from articad.arrays import FloatArray
from articad.connectors import SE3, Mate
from articad.errors import KinematicsError
from articad.findings import Finding

Unit = Literal["rad", "mm", "1"]
Signs = tuple[float, ...]
_FindingMaker = Callable[[str, str, str], Finding]  # code, message, hint
_Shower = Callable[[float], str]

LIMIT_SLACK = 1e-9  # rad or mm: a value computed to be at its limit is at its limit
_QUATERNION_TOLERANCE = 1e-3  # | ‖q‖ − 1 | of a ball's coordinates: rounded digits of a file pass, other quantities do not

Motion = Literal["turn", "slide"]


class Step(NamedTuple):
    """One elementary motion of a joint type: about or along an axis of the frame after the steps before it.

    Attributes:
        kind: Rotation about the axis, or translation along it.
        axis: 0, 1, 2 for x, y, z.
        coordinate: Index of the coordinate that is its value; None for the three turns that a quaternion replaces.
        advances: True for the slide of a screw, whose value is the coordinate times lead/2π.
        suffix: Suffix of the step's name in formats that write one joint per step; empty if the joint has one step.
    """

    kind: Motion
    axis: int
    coordinate: int | None
    advances: bool = False
    suffix: str = ""

    @property
    def vector(self) -> tuple[float, float, float]:
        """The axis as a unit vector."""
        return _AXES[self.axis]


_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_NONE = (0.0, 0.0, 0.0)
_X, _Y, _Z = 0, 1, 2


class _Kind:
    """A row of the table of joint types: the names of its coordinates and J(q) as a product of steps. All else follows from these.

    Attributes:
        coordinates: Names of the columns of q; a quaternion (x, y, z, w) comes last.
        steps: J(q) as a product, the first factor first.
        quaternion: Index of the first of a quaternion's four coordinates, None without one.
        units: Units of the coordinates.
        freedom_units: Units of the velocities.
        mirror: q' = mirror ∘ q makes J(q') = K J(q) K with K = diag(1, −1, 1): a slide along y and turns about x and z change sign.
        reverse: q' = reverse ∘ q makes J(q') = J(q)⁻¹; None where no such signs exist, because the steps do not commute.
        reverse_opposed: q' = reverse_opposed ∘ q makes J(q') = F J(q)⁻¹ F, where F = diag(1, −1, −1) reverses y and z.
    """

    def __init__(self, coordinates: tuple[str, ...], *steps: Step) -> None:
        self.coordinates, self.steps = coordinates, steps
        own = {step.coordinate: step for step in steps if step.coordinate is not None and not step.advances}
        turned = [step for step in steps if step.coordinate is None]
        self.quaternion = len(own) if turned else None
        units: list[Unit] = ["rad" if own[i].kind == "turn" else "mm" for i in range(len(own))]
        pure: list[Unit] = ["1"] * 4 if turned else []
        angles: list[Unit] = ["rad"] * len(turned)
        self.units, self.freedom_units = (*units, *pure), (*units, *angles)
        self.mirror = tuple(_mirrored(own[i]) for i in range(len(own))) + ((-1.0, 1.0, -1.0, 1.0) if turned else ())
        self.reverse: Signs | None = None
        self.reverse_opposed: Signs | None = None
        if all(step.axis == _Z for step in steps):
            self.reverse, self.reverse_opposed = (-1.0,) * len(own), (1.0,) * len(own)
        elif not own:
            self.reverse, self.reverse_opposed = (-1.0, -1.0, -1.0, 1.0), (-1.0, 1.0, 1.0, 1.0)
        self.neutral = (0.0,) * len(own) + ((0.0, 0.0, 0.0, 1.0) if turned else ())


def _mirrored(step: Step) -> float:
    """Return the sign of a coordinate in the mirror image across the xz plane."""
    return -1.0 if (step.kind == "slide") == (step.axis == _Y) else 1.0


_TURNS_OF_QUATERNION = tuple(Step("turn", axis, None, suffix=f"r{'xyz'[axis]}") for axis in range(3))
_QUATERNION = ("qx", "qy", "qz", "qw")

_KINDS: dict[str, _Kind] = {
    "fixed": _Kind(()),
    "revolute": _Kind(("angle",), Step("turn", _Z, 0)),
    "slider": _Kind(("travel",), Step("slide", _Z, 0)),
    "cylindrical": _Kind(("travel", "angle"), Step("slide", _Z, 0, suffix="t"), Step("turn", _Z, 1, suffix="r")),
    "ball": _Kind(_QUATERNION, *_TURNS_OF_QUATERNION),
    "screw": _Kind(("angle",), Step("slide", _Z, 0, advances=True, suffix="t"), Step("turn", _Z, 0, suffix="r")),
    "planar": _Kind(
        ("x", "y", "angle"), Step("slide", _X, 0, suffix="x"), Step("slide", _Y, 1, suffix="y"), Step("turn", _Z, 2, suffix="r")
    ),
    "universal": _Kind(("a", "b"), Step("turn", _X, 0, suffix="rx"), Step("turn", _Y, 1, suffix="ry")),
    "free": _Kind(
        ("x", "y", "z", *_QUATERNION), *(Step("slide", axis, axis, suffix="xyz"[axis]) for axis in range(3)), *_TURNS_OF_QUATERNION
    ),
}
"""The joint types. Every other table of them is derived from this one, but the checker of certificates and the report page's solver, which
are independent of it on purpose, and the maps to the joints of engines and file formats."""


class JointType(StrEnum):
    """The nine kinds of joints."""

    FIXED = "fixed"
    REVOLUTE = "revolute"
    SLIDER = "slider"
    CYLINDRICAL = "cylindrical"
    BALL = "ball"
    SCREW = "screw"
    PLANAR = "planar"
    UNIVERSAL = "universal"
    FREE = "free"

    @property
    def steps(self) -> tuple[Step, ...]:
        """J(q) as a product of elementary motions, first factor first; a quaternion replaces three turns without coordinates."""
        return _KINDS[self].steps

    @property
    def quaternion(self) -> int | None:
        """Index of the first of the four coordinates that are a quaternion, None where there is none."""
        return _KINDS[self].quaternion

    @property
    def freedoms(self) -> int:
        """Number of independent velocities of the joint."""
        return len(_KINDS[self].freedom_units)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the joint's columns of q, in order."""
        return _KINDS[self].coordinates

    @property
    def units(self) -> tuple[Unit, ...]:
        """Unit of each coordinate; "1" for the four of a quaternion."""
        return _KINDS[self].units

    @property
    def freedom_units(self) -> tuple[Unit, ...]:
        """Unit of each freedom: as for the coordinates, except that a quaternion has three angles."""
        return _KINDS[self].freedom_units

    @property
    def reversible(self) -> bool:
        """False for planar, universal and free: measured from the child they are not joints of their own type."""
        return _KINDS[self].reverse is not None

    @property
    def neutral(self) -> tuple[float, ...]:
        """Coordinates at which J is the identity."""
        return _KINDS[self].neutral

    def factors(self, lead: float = 0.0) -> list[tuple[tuple[float, float, float], tuple[float, float, float]]]:
        """Return J as a product of motions exp(value · (turn, slide)), one per freedom, as (turn, slide) [1, mm per unit].

        A screw is one of them: it slides by lead/2π per radian. A quaternion gives three turns about x, y and z.
        """
        found: dict[int, tuple[tuple[float, float, float], tuple[float, float, float]]] = {}
        for at, step in enumerate(self.steps):
            key = at - len(self.steps) if step.coordinate is None else step.coordinate
            turn, slide = found.get(key, (_NONE, _NONE))
            if step.kind == "turn":
                turn = step.vector
            else:
                x, y, z = step.vector
                share = lead / (2 * math.pi) if step.advances else 1.0
                slide = (share * x, share * y, share * z)
            found[key] = turn, slide
        return list(found.values())

    def mirror_signs(self) -> FloatArray:
        """Return the signs `(n_coordinates,)` that convert coordinates to those of the mirrored joint."""
        return np.array(_KINDS[self].mirror, dtype=np.float64)

    def reversal_signs(self, mate: Mate) -> FloatArray:
        """Return the signs `(n_coordinates,)` that convert coordinates to those measured from the child.

        Raises:
            KinematicsError: E_REVERSE_UNSUPPORTED for planar, universal and free.
        """
        signs = _KINDS[self].reverse_opposed if mate == Mate.OPPOSED else _KINDS[self].reverse
        if signs is None:
            raise KinematicsError(f"E_REVERSE_UNSUPPORTED: a {self} joint cannot be measured from its child; exchange parent and child.")
        return np.array(signs, dtype=np.float64)

    def motion(self, q: npt.ArrayLike, lead: float = 0.0) -> SE3:
        """Return J(q).

        Args:
            q: Coordinates `(*batch, n_coordinates)` [rad, mm]; a ball's quaternion need not be of exactly unit length.
            lead: Advance per turn of a screw [mm], right-handed when positive.

        Returns:
            Motions `(*batch)` of the child connector in the parent connector, before the mate's flip.

        Raises:
            KinematicsError: If q has another number of coordinates.
            ConnectorError: E_NONFINITE, E_QUAT_NORM.
        """
        values = np.asarray(q, dtype=np.float64)
        if values.ndim == 0 or values.shape[-1] != len(self.coordinates):
            raise KinematicsError(f"A {self} joint has coordinates ({', '.join(self.coordinates)}); q has shape {values.shape}.")
        first, T = self.quaternion, None
        for step in self.steps:
            if step.coordinate is None:
                continue
            value = values[..., step.coordinate]
            if step.advances:
                value = lead / (2 * math.pi) * value
            moved = _turned(step.axis, value) if step.kind == "turn" else SE3.trans(*(value if share else 0.0 for share in step.vector))
            T = moved if T is None else T @ moved
        if first is not None:
            turned = SE3.from_quaternion(values[..., first : first + 4])
            T = turned if T is None else T @ turned
        return SE3.identity(values.shape[:-1]) if T is None else T


def _turned(axis: int, angle: FloatArray) -> SE3:
    """Return the rotations about an axis by angles `(*batch)` [rad]."""
    return (SE3.rot_x, SE3.rot_y, SE3.rot_z)[axis](angle)


@dataclass(frozen=True)
class JointLimits:
    """Bounds of a joint's coordinates [rad, mm].

    Attributes:
        lower: One per coordinate, −inf for an endless one; empty for a ball, a fixed and a free joint.
        upper: Likewise, +inf for an endless one.
        cone: A ball's largest angle between the z axes of its two connectors [rad]; None is free.
        twist: A ball's range of turn about z [rad]; None is free.
    """

    lower: tuple[float, ...] = ()
    upper: tuple[float, ...] = ()
    cone: float | None = None
    twist: tuple[float, float] | None = None

    def signed(self, signs: npt.ArrayLike) -> JointLimits:
        """Return the limits of the coordinates `signs ∘ q`; a ball's third sign is that of its twist."""
        s = np.asarray(signs, dtype=np.float64)
        pairs = [(lo, hi) if sign > 0 else (-hi, -lo) for lo, hi, sign in zip(self.lower, self.upper, s, strict=False)]
        twist = self.twist if self.twist is None or s[2] > 0 else (-self.twist[1], -self.twist[0])
        return replace(self, lower=tuple(lo for lo, _ in pairs), upper=tuple(hi for _, hi in pairs), twist=twist)


def swing(q: npt.ArrayLike) -> FloatArray:
    """Return the angle `(*batch)` [rad] between the z axes of a ball's connectors, from its quaternions `(*batch, 4)`."""
    x, y, z, w = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    angle: FloatArray = 2.0 * np.arctan2(np.hypot(x, y), np.hypot(z, w))
    return angle


def twist(q: npt.ArrayLike) -> FloatArray:
    """Return the rotation `(*batch)` [rad] about z, −π … π, of a ball's quaternions `(*batch, 4)` after removing the swing."""
    _, _, z, w = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    return wrapped(2.0 * np.arctan2(z, w))


def wrapped(angle: npt.ArrayLike) -> FloatArray:
    """Return the same directions with angles in [−π, π) [rad]."""
    turned: FloatArray = np.mod(np.asarray(angle, dtype=np.float64) + math.pi, 2 * math.pi) - math.pi
    return turned


@dataclass(frozen=True, kw_only=True)
class Joint:
    """A joint between two parts.

    Attributes:
        name: Unique in the mechanism.
        type: The joint type.
        parent: Part from whose connector the motion is measured.
        child: The other part.
        parent_connector: Name of the parent's connector.
        child_connector: Name of the child's connector.
        T_parent_connector: C_p in the parent part's frame.
        T_child_connector: C_c in the child part's frame.
        mate: Whether the z axes agree or oppose where J is the identity.
        limits: Bounds of the coordinates.
        rest: Coordinates in the rest pose.
        lead: Advance per turn of a screw [mm].
        driver: Marked as a driver of a loop.
        closing: It closes a loop and carries no part, unless nothing else carries that part.
        effort: Largest force [N] or torque [N·mm] per coordinate, None where it is to be computed; empty: compute all.
        velocity: Largest speed [mm/s, rad/s] per coordinate, likewise.
        damping: Resistance per speed [N·s/mm, N·mm·s/rad] per coordinate, likewise.
        friction: Coulomb friction [N, N·mm] per coordinate; None or empty: none.
        fastening: How its two parts are held together, which matters for the order of assembly; None if that is not stated.
    """

    name: str
    type: JointType
    parent: str
    child: str
    parent_connector: str
    child_connector: str
    T_parent_connector: SE3
    T_child_connector: SE3
    limits: JointLimits
    rest: tuple[float, ...]
    mate: Mate = Mate.ALIGNED
    lead: float = 0.0
    driver: bool = False
    closing: bool = False
    effort: tuple[float | None, ...] = ()
    velocity: tuple[float | None, ...] = ()
    damping: tuple[float | None, ...] = ()
    friction: tuple[float | None, ...] = ()
    fastening: Fastening | None = None

    @property
    def column_names(self) -> tuple[str, ...]:
        """Names of the joint's columns of q: `joint`, or `joint.coordinate` where there are several."""
        names = self.type.coordinates
        return (self.name,) if len(names) == 1 else tuple(f"{self.name}.{coordinate}" for coordinate in names)

    @property
    def columns(self) -> tuple[Coordinate, ...]:
        """The joint's columns of q."""
        lower, upper = self.limits.lower, self.limits.upper
        if self.type.quaternion is not None:
            far = (math.inf,) * self.type.quaternion
            lower, upper = (*(-x for x in far), *(-1.0,) * 4), (*far, *(1.0,) * 4)
        rows = zip(self.column_names, self.type.units, lower, upper, self.rest, strict=True)
        return tuple(Coordinate(name, self.name, unit, lo, hi, rest) for name, unit, lo, hi, rest in rows)

    def motion(self, q: npt.ArrayLike) -> SE3:
        """Return J(q) for coordinates `(*batch, n_coordinates)` [rad, mm]."""
        return self.type.motion(q, self.lead)

    def reversed(self) -> Joint:
        """Return the same joint measured from its child: same relation between the parts, other coordinates.

        The coordinates are `type.reversal_signs(mate) ∘ q`.

        Raises:
            KinematicsError: E_REVERSE_UNSUPPORTED for planar, universal and free.
        """
        signs = self.type.reversal_signs(self.mate)
        return replace(
            self,
            parent=self.child,
            child=self.parent,
            parent_connector=self.child_connector,
            child_connector=self.parent_connector,
            T_parent_connector=self.T_child_connector,
            T_child_connector=self.T_parent_connector,
            limits=self.limits.signed(signs),
            rest=_signed(self.rest, signs),
        )

    def mirrored(
        self,
        *,
        name: str,
        parent: str,
        child: str,
        parent_connector: str,
        child_connector: str,
        T_parent_connector: SE3,
        T_child_connector: SE3,
    ) -> Joint:
        """Return the joint of the mirror image between other connectors: J'(q') = K J(q) K, K = diag(1, −1, 1).

        The coordinates are `type.mirror_signs() ∘ q`; a screw's lead changes sign; the mate stays; the joint is not a driver.
        """
        signs = self.type.mirror_signs()
        return replace(
            self,
            name=name,
            parent=parent,
            child=child,
            parent_connector=parent_connector,
            child_connector=child_connector,
            T_parent_connector=T_parent_connector,
            T_child_connector=T_child_connector,
            limits=self.limits.signed(signs),
            rest=_signed(self.rest, signs),
            lead=-self.lead + 0.0,
            driver=False,
        )

    def findings(self) -> list[Finding]:
        """Return all faults of the joint's own numbers."""
        return _joint_findings(self)


@dataclass(frozen=True)
class Coordinate:
    """A column of q.

    Attributes:
        name: `joint`, or `joint.coordinate`.
        joint: Name of its joint.
        unit: "rad", "mm", or "1" for a component of a quaternion.
        lower: Lower bound in `unit`; −inf when endless.
        upper: Upper bound in `unit`.
        rest: Value in the rest pose.
    """

    name: str
    joint: str
    unit: Unit
    lower: float
    upper: float
    rest: float


@dataclass(frozen=True)
class Coupling:
    """A relation q_b − ratio · q_a − offset = 0 between two coordinates, in rad and mm.

    Attributes:
        name: Unique among couplings.
        kind: gear, belt, rack, screw or linear; only informative.
        a: Column name of the first coordinate.
        b: Column name of the second one.
        ratio: k.
        offset: c.
    """

    name: str
    kind: str
    a: str
    b: str
    ratio: float
    offset: float = 0.0


def _signed(values: Sequence[float], signs: FloatArray) -> tuple[float, ...]:
    return tuple(float(value * sign) + 0.0 for value, sign in zip(values, signs, strict=True))  # + 0.0: no −0 in a plan


def _joint_findings(joint: Joint) -> list[Finding]:
    where, parts = f"joints.{joint.name}", (joint.parent, joint.child)

    def finding(code: str, message: str, hint: str) -> Finding:
        return Finding(code=code, where=where, message=f"Joint {joint.name!r}: {message}", hint=hint, parts=parts)

    found: list[Finding] = []
    if joint.type in {JointType.FIXED, JointType.FREE} and joint.driver:
        found.append(finding("W_DRIVER", f"a {joint.type} joint cannot drive.", "Remove its driver mark."))
    if not all(map(math.isfinite, (*joint.rest, joint.lead))):
        found.append(finding("E_NONFINITE", "rest values and lead must be finite.", "Give finite numbers."))
    if joint.type is JointType.SCREW and joint.lead == 0:
        found.append(finding("E_LEAD_ZERO", "a screw joint needs a lead.", "Give the advance per turn in mm, or use a revolute joint."))
    if joint.type is JointType.BALL:
        return found + _ball_findings(joint, finding)
    if joint.type is JointType.FREE:
        return found + _free_findings(joint, finding)
    n = len(joint.type.coordinates)
    if not len(joint.limits.lower) == len(joint.limits.upper) == n or joint.limits.cone is not None or joint.limits.twist is not None:
        found.append(finding("E_LIMITS_KIND", f"a {joint.type} joint takes {n} pair(s) of limits and no cone.", f"Give {n} pair(s)."))
    elif len(joint.rest) != n:
        found.append(finding("E_LIMITS_KIND", f"a {joint.type} joint takes {n} rest value(s), not {len(joint.rest)}.", f"Give {n}."))
    else:
        found.extend(_range_findings(joint, finding))
    return found


def _range_findings(joint: Joint, finding: _FindingMaker) -> list[Finding]:
    found: list[Finding] = []
    if all(lo <= rest <= hi for lo, rest, hi in zip(joint.limits.lower, joint.rest, joint.limits.upper, strict=True)):
        return found
    for c in joint.columns:
        show = _shown(c.unit)
        given = f"[{show(c.lower)}, {show(c.upper)}]"
        if math.isnan(c.lower) or math.isnan(c.upper):
            found.append(finding("E_NONFINITE", f"limits {given} of {c.name} are not numbers.", "Give numbers, or an endless angle."))
        elif c.lower > c.upper:
            swapped = f"[{show(c.upper)}, {show(c.lower)}]"
            found.append(finding("E_LIMITS_ORDER", f"limits {given} of {c.name} are reversed.", f"Did you mean {swapped}?"))
        elif not c.lower - LIMIT_SLACK <= c.rest <= c.upper + LIMIT_SLACK:
            message = f"{c.name} rests at {show(c.rest)}, outside {given}."
            found.append(finding("E_REST_OUTSIDE_LIMITS", message, "Move the rest value or the limit."))
    return found


def _ball_findings(joint: Joint, finding: _FindingMaker) -> list[Finding]:
    limits = joint.limits
    cone = math.pi if limits.cone is None else limits.cone
    if limits.lower or limits.upper or len(joint.rest) != 4:
        return [finding("E_LIMITS_KIND", "a ball joint takes a cone and a twist; its rest is a quaternion.", "Give cone and twist.")]
    if not 0 < cone <= math.pi:
        return [finding("E_LIMITS_ORDER", f"the cone is {math.degrees(cone):.6g}°.", "Give an angle above 0° up to 180°.")]
    if abs(math.hypot(*joint.rest) - 1) > _QUATERNION_TOLERANCE:
        return [finding("E_QUAT_NORM", f"its rest {joint.rest} is not of unit length.", "Give a unit quaternion (x, y, z, w).")]
    if limits.twist is not None and not limits.twist[0] <= limits.twist[1]:
        lo, hi = (f"{math.degrees(v):.6g}°" for v in limits.twist)
        return [finding("E_LIMITS_ORDER", f"its twist [{lo}, {hi}] is reversed.", f"Did you mean [{hi}, {lo}]?")]
    turned = limits.twist is not None and not limits.twist[0] - LIMIT_SLACK <= twist(joint.rest) <= limits.twist[1] + LIMIT_SLACK
    if turned or swing(joint.rest) > cone + LIMIT_SLACK:
        return [finding("E_REST_OUTSIDE_LIMITS", "it rests outside its cone or twist.", "Move the rest value or the limit.")]
    return []


def _free_findings(joint: Joint, finding: _FindingMaker) -> list[Finding]:
    limits = joint.limits
    if limits.lower or limits.upper or limits.cone is not None or limits.twist is not None or len(joint.rest) != 7:
        return [finding("E_LIMITS_KIND", "a free joint takes no limits; its rest is x, y, z and a quaternion.", "Give no limits.")]
    if abs(math.hypot(*joint.rest[3:]) - 1) > _QUATERNION_TOLERANCE:
        return [
            finding("E_QUAT_NORM", f"its rest quaternion {joint.rest[3:]} is not of unit length.", "Give a unit quaternion (x, y, z, w).")
        ]
    return []


def _shown(unit: Unit) -> _Shower:
    return (lambda v: f"{math.degrees(v):.6g}°") if unit == "rad" else (lambda v: f"{v:.6g} mm")
