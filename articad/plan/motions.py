"""Motions: a joint's coordinates in rad and mm, computed from its form, and all faults of that form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from articad.errors import PlanError
from articad.kinematics.joints import JointLimits, JointType
from articad.plan.evaluation import Evaluation
from articad.plan.fit_names import PRINTED_MM, named_gap, nominal_in
from articad.plan.joint_forms import Contact
from articad.plan.schema import BallSpec, FitSpec, JointForm, JointSpec, ScrewSpec

TWO_TURNS = 720.0  # degrees beyond which a limit of a turning joint is hardly intended; screws turn more
_STEP_DEG, _TYPED_DEG = 15.0, 0.05  # people choose angles in such steps; radians are typed with three or four decimals
_EVEN_DEG = 1e-6  # of half degrees
RADIANS_UP_TO = 6.3  # a full turn in radians is 6.283: limits that are all smaller look like radians
_SLACK = 1e-9  # degrees or mm: a rest value computed to be at its limit is at its limit
HALF_TURN = 180.0


class _Axis(NamedTuple):
    """The names of one coordinate in the plan: the field of its range, the field of its rest value, its unit."""

    range: str
    rest: str | None
    unit: str


AXES: dict[JointType, tuple[_Axis, ...]] = {
    JointType.FIXED: (),
    JointType.REVOLUTE: (_Axis("angle_deg", "rest_deg", "deg"),),
    JointType.SLIDER: (_Axis("travel_mm", "rest_mm", "mm"),),
    JointType.CYLINDRICAL: (_Axis("travel_mm", "rest_mm", "mm"), _Axis("angle_deg", "rest_deg", "deg")),
    JointType.BALL: (),
    JointType.SCREW: (_Axis("angle_deg", "rest_deg", "deg"),),
    JointType.PLANAR: (_Axis("x_mm", None, "mm"), _Axis("y_mm", None, "mm"), _Axis("angle_deg", None, "deg")),
    JointType.UNIVERSAL: (_Axis("a_deg", None, "deg"), _Axis("b_deg", None, "deg")),
    JointType.FREE: (),
}
"""The coordinates of each type by their names in the plan, ordered as `JointType.coordinates`; a ball has a cone, a free joint no limits."""


@dataclass(frozen=True)
class JointNumbers:
    """A joint's numbers [rad, mm], not yet between any connectors.

    Attributes:
        type: The joint type.
        limits: Bounds.
        rest: Coordinates at rest.
        lead: Advance per turn of a screw [mm].
        effort: Per coordinate [N, N·mm]; empty when none is stated.
        velocity: Per coordinate [mm/s, rad/s]; empty when none is stated.
    """

    type: JointType
    limits: JointLimits
    rest: tuple[float, ...]
    lead: float
    effort: tuple[float | None, ...]
    velocity: tuple[float | None, ...]

    @property
    def turn_at_rest(self) -> float:
        """Angle [rad] about z by which the rest value turns the child; balls, planar, universal and free joints rest at zero."""
        return sum(value for value, unit in zip(self.rest, self.type.units, strict=True) if unit == "rad")

    def mirrored(self) -> JointNumbers:
        """Return the motion of the mirror image: coordinates change sign by type, and a screw changes hand."""
        signs = self.type.mirror_signs()
        rest = tuple(float(value * sign) + 0.0 for value, sign in zip(self.rest, signs, strict=True))
        limits = self.limits.signed(signs)
        limits = replace(limits, lower=_without_minus_zero(limits.lower), upper=_without_minus_zero(limits.upper))
        return replace(self, limits=limits, rest=rest, lead=-self.lead + 0.0)


def _without_minus_zero(values: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(value + 0.0 for value in values)


def motion(form: JointSpec, evaluation: Evaluation) -> JointNumbers | None:
    """Return a joint's motion, reporting what is wrong with it; None if one of its numbers is missing or invalid."""
    where, joint_type = f"joints.{form.name}", JointType(form.type)
    effort, velocity = _capacity(form, joint_type, where, evaluation)
    lead = evaluation.number(form.lead_mm, where, "lead_mm") if isinstance(form, ScrewSpec) else 0.0
    if isinstance(form, ScrewSpec) and lead == 0.0:
        hint = "Give the advance per turn in mm, such as 2 (right-handed) or -2, or make it a revolute joint."
        evaluation.report("E_LEAD_ZERO", f"{where}.lead_mm", "The screw does not advance.", hint, value=0.0, unit="mm")
    if isinstance(form, BallSpec):
        limits, rest = _ball_limits(form, where, evaluation), JointType.BALL.neutral
    elif joint_type is JointType.FREE:
        limits, rest = JointLimits(), JointType.FREE.neutral
    else:
        limits, rest = _limits(form, joint_type, where, evaluation)
    if limits is None or math.isnan(lead) or any(map(math.isnan, rest)):
        return None
    return JointNumbers(joint_type, limits, rest, lead, effort, velocity)


def _limits(form: JointForm, joint_type: JointType, where: str, evaluation: Evaluation) -> tuple[JointLimits | None, tuple[float, ...]]:
    lower, upper, rests = [], [], []
    coupled = {reference.split(".")[0] for coupling in evaluation.plan.couplings for reference in coupling.joints}
    many_turns = joint_type is JointType.SCREW or form.name in coupled  # a lead screw turns as often as its nut's travel needs
    for axis in AXES[joint_type]:
        given, scale = getattr(form, axis.range), math.radians(1.0) if axis.unit == "deg" else 1.0
        rest = 0.0 if axis.rest is None else evaluation.number(getattr(form, axis.rest), where, axis.rest)
        low, high = -math.inf, math.inf
        if given is None:
            _report_missing(form, axis, where, evaluation)
            low = high = math.nan
        elif given != "endless":
            low, high = (evaluation.number(bound, where, f"{axis.range}[{i}]") for i, bound in enumerate(given))
            if not math.isnan(low) and not math.isnan(high):  # NaN was reported already
                _check_range((low, high), rest, axis, where, evaluation, many_turns=many_turns, only=len(AXES[joint_type]) == 1)
        lower.append(low * scale)
        upper.append(high * scale)
        rests.append(rest * scale)
    if any(map(math.isnan, lower + upper)):
        return None, tuple(rests)
    return JointLimits(lower=tuple(lower), upper=tuple(upper)), tuple(rests)


def _report_missing(form: JointForm, axis: _Axis, where: str, evaluation: Evaluation) -> None:
    example = "[-90, 90]" if axis.unit == "deg" else "[0, 100]"
    endless = axis.range == "angle_deg" or (axis.range == "travel_mm" and form.type == "cylindrical")
    hint = f'Add "{axis.range}": {example}{", or " + chr(34) + "endless" + chr(34) if endless else ""}.'
    evaluation.report("E_LIMITS_MISSING", f"{where}.{axis.range}", f"The {form.type} joint has no {axis.range}.", hint)


def _check_range(
    limits: tuple[float, float],
    rest: float,
    axis: _Axis,
    where: str,
    evaluation: Evaluation,
    *,
    many_turns: bool = False,
    only: bool = False,
) -> None:
    """Report a range that is reversed, empty, of another unit or without the rest value; `only` if the joint has no other."""
    low, high = limits
    path, unit, given = f"{where}.{axis.range}", axis.unit, f"[{low:.6g}, {high:.6g}]"
    if low > high:
        hint = f"Did you mean [{high:.12g}, {low:.12g}]?"
        evaluation.report("E_LIMITS_ORDER", path, f"Limits {given}: the lower is above the upper.", hint, value=low, limit=high, unit=unit)
        return
    if low == high:
        hint = (
            "Make it a fixed joint and declare one freedom less, or open the range."
            if only
            else "Open the range, or use a joint without it."
        )
        evaluation.report("W_LIMITS_EQUAL", path, f"Limits {given}: the joint cannot move.", hint, value=low, limit=high, unit=unit)
    if unit == "deg":
        _check_degrees(limits, path, evaluation, many_turns=many_turns)
    if rest < low - _SLACK or rest > high + _SLACK:
        nearest = low if rest < low else high
        widened = f"[{min(low, rest):.12g}, {max(high, rest):.12g}]"
        if axis.rest is None:
            hint = f"This joint rests at zero: widen {axis.range} to {widened}."
        else:
            hint = f"Set {axis.rest} to {nearest:.12g}, or {axis.range} to {widened}."
        hint = f"{_slip(limits, rest, unit)}{hint}"
        message = f"The joint rests at {rest:.6g} {unit}, outside its limits {given}."
        evaluation.report("E_REST_OUTSIDE_LIMITS", path, message, hint, value=rest, limit=nearest, unit=unit)


def _slip(limits: tuple[float, float], rest: float, unit: str) -> str:
    """Return the advice to give limits in degrees, or with the other sign, that then contain the rest value; empty if neither does."""
    low, high = (round(math.degrees(limit), 3) + 0.0 for limit in limits)
    if unit == "deg" and _look_like_radians(limits) and low <= rest <= high:
        return f"If radians were meant, give {_shown((low, high))}. "
    if -limits[1] - _SLACK <= rest <= -limits[0] + _SLACK:
        return f"If the sign is wrong, give {_shown((0.0 - limits[1], 0.0 - limits[0]))}. "
    return ""


def _shown(limits: tuple[float, float]) -> str:
    return f"[{limits[0]:.12g}, {limits[1]:.12g}]"


def _look_like_radians(limits: Sequence[float]) -> bool:
    """Return whether limits [deg] are all within a turn in radians and uneven, or even angles only if they were given in radians."""
    sizes = [abs(limit) for limit in limits if limit != 0.0]
    largest = max(sizes, default=0.0)
    is_uneven = 0.0 < largest <= RADIANS_UP_TO and any(size != int(size) for size in sizes)
    return is_uneven or (bool(sizes) and all(map(_is_round_in_radians, sizes)))


def _check_degrees(limits: Sequence[float], path: str, evaluation: Evaluation, *, many_turns: bool = False) -> None:
    """Report limits that look like radians, or like more turns than are intended."""
    sizes = [abs(limit) for limit in limits if limit != 0.0]
    largest = max(sizes, default=0.0)
    shown = f"[{', '.join(f'{limit:.6g}' for limit in limits)}]" if len(limits) > 1 else f"{limits[0]:.6g}"
    if largest > TWO_TURNS and not many_turns:
        message = f"Limits {shown} exceed two turns."
        hint = 'Give degrees within [-720, 720], or "endless" if the joint turns freely.'
        evaluation.report("W_LIMITS_UNITS", path, message, hint, value=largest, limit=TWO_TURNS, unit="deg")
    elif _look_like_radians(limits):
        degrees = [round(math.degrees(limit), 3) + 0.0 for limit in limits]
        meant = f"[{', '.join(f'{limit:g}' for limit in degrees)}]" if len(limits) > 1 else f"{degrees[0]:g}"
        message = f"{shown} looks like radians; degrees are expected."
        evaluation.report(
            "W_LIMITS_UNITS", path, message, f"If radians were meant, give {meant}.", value=largest, limit=RADIANS_UP_TO, unit="deg"
        )


def _is_round_in_radians(size: float) -> bool:
    """Return whether an angle is uneven in degrees, but a multiple of 15° if it was given in radians, such as 62.83: ten turns."""
    if not math.isfinite(size):
        return False
    meant = math.degrees(size)
    is_even = abs(size * 2 - round(size * 2)) < _EVEN_DEG
    return not is_even and abs(meant - _STEP_DEG * round(meant / _STEP_DEG)) < _TYPED_DEG


def _ball_limits(form: BallSpec, where: str, evaluation: Evaluation) -> JointLimits | None:
    path = f"{where}.cone_deg"
    if form.cone_deg is None:
        hint = 'Add "cone_deg": the largest angle between the two z axes, such as 45; 180 leaves the swing free.'
        evaluation.report("E_LIMITS_MISSING", path, "The ball joint has no cone_deg.", hint)
        return None
    cone = evaluation.number(form.cone_deg, where, "cone_deg")
    if not math.isnan(cone) and not 0.0 < cone <= HALF_TURN:
        message, hint = f"The cone is {cone:.6g}°.", "Give an angle above 0 up to 180; a ball that only twists is a revolute joint."
        evaluation.report("E_LIMITS_KIND", path, message, hint, value=cone, limit=HALF_TURN, unit="deg")
    elif not math.isnan(cone):
        _check_degrees([cone], path, evaluation)
    twist = None
    if form.twist_deg is not None:
        low, high = (evaluation.number(bound, where, f"twist_deg[{i}]") for i, bound in enumerate(form.twist_deg))
        _check_range((low, high), 0.0, _Axis("twist_deg", None, "deg"), where, evaluation)
        twist = (math.radians(low), math.radians(high))
    if math.isnan(cone) or (twist is not None and any(map(math.isnan, twist))):
        return None
    return JointLimits(cone=math.radians(cone), twist=twist)


def _capacity(
    form: JointForm, joint_type: JointType, where: str, evaluation: Evaluation
) -> tuple[tuple[float | None, ...], tuple[float | None, ...]]:
    """Return the stated effort and velocity per coordinate; check that they are positive and that the joint has the freedom."""
    freedoms = set(joint_type.freedom_units)
    by_unit: dict[str, dict[str, float | None]] = {"effort": {}, "velocity": {}}
    for key, quantity, unit, scale in (
        ("effort_n_mm", "effort", "rad", 1.0),
        ("effort_n", "effort", "mm", 1.0),
        ("velocity_deg_s", "velocity", "rad", math.radians(1.0)),
        ("velocity_mm_s", "velocity", "mm", 1.0),
    ):
        given = getattr(form, key)
        if given is None:
            continue
        value = evaluation.number(given, where, key)
        if unit not in freedoms:
            kind = "turn" if unit == "rad" else "slide"
            others = {
                "effort_n_mm": "effort_n",
                "effort_n": "effort_n_mm",
                "velocity_deg_s": "velocity_mm_s",
                "velocity_mm_s": "velocity_deg_s",
            }
            hint = f"Use {others[key]} instead, or leave it out." if freedoms else "Leave it out."
            evaluation.report("E_EFFORT", f"{where}.{key}", f"A {form.type} joint does not {kind}, so it has no {key}.", hint, value=value)
        elif value <= 0.0:
            hint = "Give a positive number, or leave it out to have it computed."
            evaluation.report("E_EFFORT", f"{where}.{key}", f"{key} is {value:.6g}.", hint, value=value, limit=0.0)
        elif not math.isnan(value):
            by_unit[quantity][unit] = value * scale
    turning = {"1": "rad"}  # the four coordinates of a ball's quaternion share its torque
    efforts, velocities = (
        tuple(found.get(turning.get(unit, unit)) for unit in joint_type.units) if found else () for found in by_unit.values()
    )
    return efforts, velocities


class FitNumbers(NamedTuple):
    """A fit with its numbers; see `articad.plan.resolve.Fit`."""

    gap_min: float | None
    gap_max: float | None
    within: float | None
    contact: Contact | None
    name: str | None
    nominal: float | None


def checked_fit(form: FitSpec, where: str, evaluation: Evaluation, *, moves: bool) -> FitNumbers:
    """Return the numbers of a fit, reporting a range that is impossible.

    Args:
        form: The fit as the plan states it.
        where: Its path.
        evaluation: Evaluates its numbers.
        moves: Whether its joint moves, so that an interference fit would lock it.
    """
    low = high = within = nominal = None
    contact = form.contact
    if form.name is not None:
        low, high, nominal = _named_gap(form, where, evaluation, moves=moves)
        contact = contact or "allowed"
    elif form.nominal_mm is not None:
        hint = "Add a name such as H7/g6, or leave nominal_mm out."
        evaluation.report("E_FIT", f"{where}.nominal_mm", "A nominal diameter without the name of a fit has no meaning.", hint)
    elif form.gap_mm is not None:
        low, high = (evaluation.number(bound, where, f"gap_mm[{i}]") for i, bound in enumerate(form.gap_mm))
        if low > high:
            hint = f"Did you mean [{high:.12g}, {low:.12g}]?"
            message = f"gap_mm [{low:.6g}, {high:.6g}]: the least gap is above the largest."
            evaluation.report("E_FIT", f"{where}.gap_mm", message, hint, value=low, limit=high, unit="mm")
        elif low < 0.0:
            message = f"gap_mm [{low:.6g}, {high:.6g}]: a gap cannot be negative."
            hint = f"Give [0, {max(high, 0.0):.6g}] and contact 'allowed'; an intended overlap belongs in allow."
            evaluation.report("E_FIT", f"{where}.gap_mm", message, hint, value=low, limit=0.0, unit="mm")
        if high == 0.0 and form.contact == "forbidden":
            hint = "Raise the largest gap above 0, or set contact to 'allowed'."
            evaluation.report("E_FIT", where, "gap_mm allows no gap but contact is forbidden.", hint, value=0.0, unit="mm")
        if low > 0.0 and form.contact == "required":
            hint = "Set the least gap to 0, or contact to 'allowed'."
            evaluation.report(
                "E_FIT", where, f"Contact is required but the gap is at least {low:.6g} mm.", hint, value=low, limit=0.0, unit="mm"
            )
    if form.within_mm is not None:
        within = evaluation.number(form.within_mm, where, "within_mm")
        if within <= 0.0:
            hint = "Give the radius about the axis in which surface counts, or leave it out."
            evaluation.report("E_FIT", f"{where}.within_mm", f"within_mm is {within:.6g}.", hint, value=within, limit=0.0, unit="mm")
    return FitNumbers(low, high, within, contact, form.name, nominal)


def _named_gap(form: FitSpec, where: str, evaluation: Evaluation, *, moves: bool) -> tuple[float | None, float | None, float | None]:
    """Return the play that a fit's name stands for and its nominal diameter [mm]; all None where the bore's diameter is to be measured."""
    name = form.name or ""
    if form.gap_mm is not None:
        hint = "Leave one of them out."
        evaluation.report("E_FIT", where, f"The fit states both gap_mm and the name {name!r}.", hint)
    nominal = None if form.nominal_mm is None else evaluation.number(form.nominal_mm, where, "nominal_mm")
    try:
        stated = nominal_in(name)
        if stated is not None and nominal is not None and stated != nominal:
            hint = f"Leave nominal_mm out, or name the fit {name.split()[-1]!r}."
            evaluation.report(
                "E_FIT", f"{where}.nominal_mm", f"{name!r} states a diameter other than {nominal:.6g} mm.", hint, value=nominal
            )
        nominal = stated if nominal is None else nominal
        if name not in PRINTED_MM and (nominal is None or math.isnan(nominal)):
            return None, None, nominal
        gap = named_gap(name, nominal)
    except PlanError as error:
        evaluation.report("E_FIT", where, error.message, "Name another fit, such as H7/g6 at 1 to 500 mm, or give gap_mm.")
        return None, None, nominal
    if moves and gap.holds:
        hint = "Name a clearance fit, such as H7/g6 or sliding."
        evaluation.report("E_FIT", where, f"The fit {name!r} holds the shaft in its bore, but the joint moves.", hint)
    return gap.least, gap.largest, nominal
