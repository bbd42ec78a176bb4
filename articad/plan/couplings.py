"""Couplings: gears, belts, racks and screws of a plan as rows q_b - k q_a - c = 0 in rad and mm."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from articad.arrays import FloatArray
from articad.errors import did_you_mean
from articad.kinematics.joints import Coupling, JointType, Unit
from articad.plan.evaluation import Evaluation
from articad.plan.joint_forms import CouplingForm
from articad.plan.schema import BeltSpec, GearSpec, LinearSpec, RackSpec, ScrewCouplingSpec

PARALLEL_DEG = 0.05  # two axes up to this angle apart count as parallel: the tolerance of the rest check
REST_MM = 0.01  # a linear offset may miss the rest values by the tolerance of the rest check
REST_DEG = 0.05
_TURNING = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW, JointType.PLANAR)
_FORMS = {"rad": "an angle about a joint's z", "mm": "a travel"}


@dataclass(frozen=True)
class TiedCoordinate:
    """A coordinate that a coupling may connect.

    Attributes:
        column: Its name in q.
        joint: Its joint.
        type: The joint's type.
        coordinate: Its name within the joint.
        unit: "rad" or "mm".
        rest: Its value at rest, in `unit`.
        axis: The parent connector's z in the assembly at rest `(3,)`; None if it is not known.
    """

    column: str
    joint: str
    type: JointType
    coordinate: str
    unit: Unit
    rest: float
    axis: FloatArray | None

    @property
    def about_z(self) -> bool:
        """True for an angle about z."""
        return self.coordinate == "angle" and self.type in _TURNING


def couple(
    form: CouplingForm, coordinates: Mapping[str, TiedCoordinate], joints: Mapping[str, JointType], evaluation: Evaluation
) -> Coupling | None:
    """Return the row of a coupling; report its faults.

    Args:
        form: Its form in the plan.
        coordinates: All coordinates that may be coupled, by column name.
        joints: Type of every declared joint, including those with invalid numbers.
        evaluation: The plan's numbers.
    """
    where = f"couplings.{form.name}"
    a, b = (_coordinate(name, index, where, coordinates, joints, evaluation) for index, name in enumerate(form.joints))
    if a is None or b is None:
        return None
    if a.column == b.column:
        evaluation.report("E_COUPLING", f"{where}.joints", f"The coupling ties {a.column} to itself.", "Name two different joints.")
        return None
    k = _ratio(form, where, a, b, evaluation)
    if k is None:
        return None
    c = b.rest - k * a.rest
    if isinstance(form, LinearSpec):
        _check_offset(form, where, a, b, evaluation)
    return Coupling(name=form.name, kind=form.type, a=a.column, b=b.column, ratio=k, offset=c + 0.0)


def _coordinate(
    name: str,
    index: int,
    where: str,
    coordinates: Mapping[str, TiedCoordinate],
    joints: Mapping[str, JointType],
    evaluation: Evaluation,
) -> TiedCoordinate | None:
    found = coordinates.get(name)
    if found is not None:
        return found
    joint = name.split(".", maxsplit=1)[0]
    path = f"{where}.joints[{index}]"
    own = [column for column, tied in coordinates.items() if tied.joint == joint]
    if joint not in joints:
        known = list(coordinates)
        hint = f"{did_you_mean(name, known).strip()} Joints that can be coupled: {', '.join(known) or 'none'}.".strip()
        evaluation.report("E_JOINT_UNKNOWN", path, f"There is no joint {name!r}.", hint)
    elif own:
        message = f"{name!r} does not name one coordinate of the {joints[joint]} joint {joint!r}."
        evaluation.report("E_COUPLING", path, message, f"Use {' or '.join(own)}.")
    elif joints[joint] in {JointType.FIXED, JointType.BALL, JointType.FREE}:
        evaluation.report("E_COUPLING", path, f"A {joints[joint]} joint has no coordinate to couple.", "Couple an angle or a travel.")
    return None


def _ratio(form: CouplingForm, where: str, a: TiedCoordinate, b: TiedCoordinate, evaluation: Evaluation) -> float | None:
    """Return k of q_b = k q_a + c [rad, mm]; None after reporting a fault."""
    if isinstance(form, GearSpec | BeltSpec):
        return _turning_ratio(form, where, a, b, evaluation)
    if isinstance(form, RackSpec | ScrewCouplingSpec):
        return _sliding_ratio(form, where, a, b, evaluation)
    assert isinstance(form, LinearSpec)
    ratio = _nonzero(form.ratio, where, "ratio", evaluation)
    return None if ratio is None else ratio * _scale(b) / _scale(a)


def _turning_ratio(form: GearSpec | BeltSpec, where: str, a: TiedCoordinate, b: TiedCoordinate, evaluation: Evaluation) -> float | None:
    """Return the ratio of a belt, or of a gear, which is negative for external teeth; antiparallel axes change the sign."""
    if not _suits(form, where, a, b, "rad", "rad", evaluation):
        return None
    if isinstance(form, GearSpec):
        first, second = (_size(teeth, where, f"teeth[{i}]", evaluation, whole=True) for i, teeth in enumerate(form.teeth))
    else:
        first, second = (_size(radius, where, f"radii_mm[{i}]", evaluation) for i, radius in enumerate(form.radii_mm))
    sense = _sense(form, where, a, b, evaluation)
    if first is None or second is None or sense is None:
        return None
    external = isinstance(form, GearSpec) and not form.internal
    return (-1.0 if external else 1.0) * sense * first / second


def _sliding_ratio(
    form: RackSpec | ScrewCouplingSpec, where: str, a: TiedCoordinate, b: TiedCoordinate, evaluation: Evaluation
) -> float | None:
    """Return the travel of b [mm] for one radian of a."""
    if not _suits(form, where, a, b, "rad", "mm", evaluation):
        return None
    if isinstance(form, ScrewCouplingSpec):
        lead = _nonzero(form.lead_mm, where, "lead_mm", evaluation)
        return None if lead is None else lead / (2.0 * math.pi)
    module = _size(form.module_mm, where, "module_mm", evaluation)
    count = _size(form.teeth, where, "teeth", evaluation, whole=True)
    return None if module is None or count is None else module * count / 2.0


def _suits(
    form: CouplingForm, where: str, a: TiedCoordinate, b: TiedCoordinate, unit_a: Unit, unit_b: Unit, evaluation: Evaluation
) -> bool:
    """Return whether the two coordinates are of the kinds that the coupling connects."""
    fits = [tied.unit == unit and (unit == "mm" or tied.about_z) for tied, unit in ((a, unit_a), (b, unit_b))]
    if all(fits):
        return True
    wrong = ", ".join(f"{tied.column} is {_described(tied)}" for tied, good in zip((a, b), fits, strict=True) if not good)
    hint = f"joints[0] must be {_FORMS[unit_a]}, joints[1] {_FORMS[unit_b]}"
    if unit_a != unit_b and a.unit == unit_b and b.unit == unit_a:
        hint += f": exchange them, [{b.column!r}, {a.column!r}]".replace("'", '"')
    evaluation.report(
        "E_COUPLING", f"{where}.joints", f"A {form.type} coupling cannot tie these: {wrong}.", f"{hint}; or use a linear coupling."
    )
    return False


def _described(tied: TiedCoordinate) -> str:
    if tied.unit == "mm":
        return "a travel"
    return "an angle about z" if tied.about_z else f"angle {tied.coordinate} of a {tied.type} joint"


def _sense(form: CouplingForm, where: str, a: TiedCoordinate, b: TiedCoordinate, evaluation: Evaluation) -> float | None:
    """Return 1 for parallel axes, -1 for antiparallel ones; None for others, which are reported, and for unknown ones."""
    if a.axis is None or b.axis is None:
        return None
    cosine = float(a.axis @ b.axis)
    angle = math.degrees(math.atan2(float(np.linalg.norm(np.cross(a.axis, b.axis))), cosine))
    off = min(angle, 180.0 - angle)
    if off > PARALLEL_DEG:
        message = f"The axes of {a.joint} and {b.joint} are {angle:.6g}° apart at rest; a {form.type} needs parallel ones."
        hint = 'Make the axes parallel, or use "type": "linear" with a ratio.'
        evaluation.report("E_COUPLING_AXES", where, message, hint, value=off, limit=PARALLEL_DEG, unit="deg")
        return None
    return 1.0 if cosine > 0.0 else -1.0


def _size(number: float | str, where: str, key: str, evaluation: Evaluation, *, whole: bool = False) -> float | None:
    """Return a positive size, for teeth a whole number; None after reporting an invalid one."""
    value = evaluation.number(number, where, key)
    if math.isnan(value):
        return None
    if value <= 0.0 or (whole and value != int(value)):
        hint = "Give a whole number of teeth, at least 1." if whole else "Give a positive length in mm."
        evaluation.report("E_COUPLING_RATIO", f"{where}.{key}", f"{key} is {value:.6g}.", hint, value=value)
        return None
    return value


def _nonzero(number: float | str, where: str, key: str, evaluation: Evaluation) -> float | None:
    value = evaluation.number(number, where, key)
    if value == 0.0:
        message = f"{key} is 0: the second joint would not move."
        evaluation.report("E_COUPLING_RATIO", f"{where}.{key}", message, "Give a number other than zero.", value=0.0)
    return None if value == 0.0 or math.isnan(value) else value


def _check_offset(form: LinearSpec, where: str, a: TiedCoordinate, b: TiedCoordinate, evaluation: Evaluation) -> None:
    """Compare a linear coupling's offset with the rest values, in the units of the plan."""
    ratio, offset = evaluation.number(form.ratio, where, "ratio"), evaluation.number(form.offset, where, "offset")
    rest_a, rest_b = a.rest / _scale(a), b.rest / _scale(b)
    right = rest_b - ratio * rest_a
    unit, tolerance = ("deg", REST_DEG) if b.unit == "rad" else ("mm", REST_MM)
    if abs(offset - right) > tolerance:
        message = (
            f"At rest {b.column} is {rest_b:.6g} {unit}, but {ratio:.6g} * {rest_a:.6g} + {offset:.6g} is {ratio * rest_a + offset:.6g}."
        )
        evaluation.report(
            "E_COUPLING_REST", f"{where}.offset", message, f"Set offset to {right + 0.0:.12g}.", value=offset, limit=right, unit=unit
        )


def _scale(tied: TiedCoordinate) -> float:
    """Return the size of one unit of the plan's JSON in rad or mm."""
    return math.radians(1.0) if tied.unit == "rad" else 1.0
