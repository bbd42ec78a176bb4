"""The rest check: the two connectors of every joint must coincide at rest. It needs no geometry.

D = (T_p C_p J(q_rest) F)⁻¹ T_c C_c must be the identity within 0.01 mm and 0.05°, with T the poses of the parts, C the frames of the
connectors, J the joint's motion and F the mate's flip. Every finding names the value that would correct it, in the frame in which that
connector is stated.
"""

from __future__ import annotations

import json
import math

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import FLIP, SE3, Mate
from articad.findings import Finding
from articad.kinematics.joints import Joint, JointType
from articad.plan.derive import DraftPart
from articad.plan.draft import Draft
from articad.plan.schema import TURNING_KINDS, DerivedJoint, PartSpec, Pose

OFFSET_MM = 0.01  # covers the rounding of numbers in plans, and is far below any fit
ANGLE_DEG = 0.05  # 0.9 mm at one metre: axes rounded to four digits pass
_TURN_FIELD = {JointType.REVOLUTE: "rest_deg", JointType.CYLINDRICAL: "rest_deg"}
_SLIDE_FIELD = {JointType.SLIDER: "rest_mm", JointType.CYLINDRICAL: "rest_mm"}
_DECIMALS = 4  # of mm and degrees in hints: a hundredth of the tolerances
_AXIS_DECIMALS = 6  # of unit axes in hints: 0.0001°
_IDENTITY = SE3.identity()


def rest_findings(draft: Draft) -> list[Finding]:
    """Return a finding for every joint whose connectors do not meet at rest; joints that place their part are left out."""
    joints = [
        joint
        for joint in draft.joints
        if joint.name not in draft.auto_joints and draft.parts[joint.parent].T is not None and draft.parts[joint.child].T is not None
    ]
    if not joints:
        return []
    moved = [identity_or(joint) for joint in joints]
    expected = (
        SE3.stack([_pose(draft, joint.parent) for joint in joints])
        @ SE3.stack([joint.T_parent_connector for joint in joints])
        @ SE3.stack(moved)
    )
    actual = SE3.stack([_pose(draft, joint.child) for joint in joints]) @ SE3.stack([joint.T_child_connector for joint in joints])
    D = expected.inverse() @ actual
    R = D.rotation
    axis = np.degrees(np.arctan2(np.hypot(R[:, 0, 2], R[:, 1, 2]), R[:, 2, 2]))
    roll = np.degrees(np.arctan2(R[:, 1, 0] - R[:, 0, 1], R[:, 0, 0] + R[:, 1, 1]))
    offset = np.sqrt((D.translation**2).sum(axis=-1))
    wrong = (axis > ANGLE_DEG) | (np.abs(roll) > ANGLE_DEG) | (offset > OFFSET_MM)
    found: list[Finding] = []
    for i in np.flatnonzero(wrong):
        mismatch = _Mismatch(draft, joints[i], expected[int(i)], actual[int(i)])
        found.extend(mismatch.findings(float(axis[i]), float(roll[i]), float(offset[i])))
    return found


def identity_or(joint: Joint) -> SE3:
    """Return J(q_rest) F of a joint."""
    J = _IDENTITY if joint.rest == joint.type.neutral else joint.motion(joint.rest)
    return J @ FLIP if joint.mate is Mate.OPPOSED else J


def _pose(draft: Draft, part: str) -> SE3:
    T = draft.parts[part].T
    assert T is not None
    return T


class _Mismatch:
    """A joint whose connectors do not meet, and the values that would correct it."""

    def __init__(self, draft: Draft, joint: Joint, expected: SE3, actual: SE3) -> None:
        self.draft, self.joint, self.expected, self.actual = draft, joint, expected, actual
        self.parent = f"{joint.parent}.{joint.parent_connector}"
        self.child = f"{joint.child}.{joint.child_connector}"
        parent, child = draft.parts[joint.parent], draft.parts[joint.child]
        on_child = not child.derived or parent.derived
        self.part: DraftPart = child if on_child else parent
        self.target = self.child if on_child else self.parent
        connector = joint.child_connector if on_child else joint.parent_connector
        self.spec = next(spec for spec in self.part.connector_specs if spec.name == connector)
        right = expected if on_child else actual @ identity_or(joint).inverse()
        self.in_assembly = self.spec.frame == "assembly" and not self.part.derived
        self.right = right if self.in_assembly else _pose(draft, self.part.name).inverse() @ right

    def findings(self, axis: float, roll: float, offset: float) -> list[Finding]:
        """Return the faults, given the angle between the axes [deg], the roll [deg] and the distance [mm]."""
        found = []
        if axis > 90.0:
            found.append(self._flip(axis))
        elif axis > ANGLE_DEG:
            found.append(self._tilt(axis))
        elif abs(roll) > ANGLE_DEG:
            found.append(self._roll(roll))
        if offset > OFFSET_MM:
            found.append(self._offset(offset))
        return found

    def _finding(self, code: str, message: str, hint: str, value: float, limit: float, unit: str) -> Finding:
        where, ends = f"joints.{self.joint.name}", (self.joint.parent, self.joint.child)
        placing = {end: carried for end in ends if (carried := self._carried(end))}
        for end, carried in placing.items():
            hint += f" Or correct what places {end} at rest: {' and '.join(f'joint {name}' for name, _ in carried)}."
        others = [part for carried in placing.values() for _, part in carried]
        parts = tuple(dict.fromkeys((*ends, *others)))
        return Finding(code=code, where=where, message=message, hint=hint, parts=parts, value=value, limit=limit, unit=unit)

    def _carried(self, name: str) -> list[tuple[str, str]]:
        """Return the joints that place a part with `rest_pose: "auto"`, each with the part that carries, as far as a stated pose."""
        joints = {joint.name: joint for joint in self.draft.joints}
        placed_by = {part: joints[joint] for joint, part in self.draft.auto_joints.items() if joint in joints}
        found: list[tuple[str, str]] = []
        while name in placed_by and len(found) < len(placed_by):
            joint = placed_by[name]
            name = joint.parent if joint.child == name else joint.child
            found.append((joint.name, name))
        return found

    def _set(self, *keys: str) -> str:
        """Return the sentence that gives the connector the right values."""
        values = {"o": _point(self.right.translation), "z": _direction(self.right.z_axis), "x": _direction(self.right.x_axis)}
        wanted = " and ".join(f"{key} of {self.target} to {values[key]}" for key in keys)
        if self.part.derived:
            return f"set {wanted}, which comes from {self.part.source}: change it there, or what {self.part.name} derives by"
        return f"set {wanted}"

    def _axes(self) -> tuple[str, ...]:
        """Return which axes to state: an x that is left to the rule follows by itself, and a correct one stays."""
        if self.spec.x is None:
            return ("z",)
        frame = self.part.connectors[self.spec.name].frame
        now = _pose(self.draft, self.part.name).rotate(frame.x_axis) if self.in_assembly else frame.x_axis
        off = math.degrees(math.atan2(float(np.linalg.norm(np.cross(now, self.right.x_axis))), float(now @ self.right.x_axis)))
        return ("z",) if off <= ANGLE_DEG else ("z", "x")

    def _flip(self, axis: float) -> Finding:
        mate = self.joint.mate
        other = Mate.ALIGNED if mate is Mate.OPPOSED else Mate.OPPOSED
        between = 180.0 - axis if mate is Mate.OPPOSED else axis
        verb = "agree" if mate is Mate.OPPOSED else "oppose"
        message = f"The z axes of {self.parent} and {self.child} {verb} at rest (angle {between:.1f}°) but mate is {str(mate)!r}."
        if 180.0 - axis <= ANGLE_DEG:
            hint = f"Set mate to {str(other)!r}, or {self._set(*self._axes())}."
        else:
            hint = f"{_capital(self._set(*self._axes()))}."
        return self._finding("E_MATE_FLIP", message, hint, axis, ANGLE_DEG, "deg")

    def _tilt(self, axis: float) -> Finding:
        message = f"The z axes of {self.parent} and {self.child} are tilted by {axis:.4g}° at rest (mate {str(self.joint.mate)!r})."
        hint = f"{_capital(self._set(*self._axes()))}."
        return self._finding("E_MATE_TILT", message, hint, axis, ANGLE_DEG, "deg")

    def _roll(self, roll: float) -> Finding:
        message = f"The x axes of {self.parent} and {self.child} differ by {abs(roll):.1f}° about z: the part would be turned."
        hint = f"{_capital(self._turning_instead(roll) + self._set('x'))}{self._rest_instead(roll)}."
        return self._finding("E_MATE_ROLL", message, hint, abs(roll), ANGLE_DEG, "deg")

    def _rest_instead(self, roll: float) -> str:
        """Return the rest value that would correct a roll, if the joint has one and its limits allow it."""
        field = _TURN_FIELD.get(self.joint.type)
        if field is None:
            return ""
        index = self.joint.type.coordinates.index("angle")
        rest = math.degrees(self.joint.rest[index]) + (-roll if self.joint.mate is Mate.OPPOSED else roll)
        low, high = (math.degrees(bound[index]) for bound in (self.joint.limits.lower, self.joint.limits.upper))
        turns = [rest + turn for turn in (0.0, -360.0, 360.0) if low - ANGLE_DEG <= rest + turn <= high + ANGLE_DEG]
        return f", or {field} of the joint to {_number(min(max(turns[0], low), high))}" if turns else ""

    def _turning_instead(self, roll: float) -> str:
        """Return the joint that rests at a roll, for a fixed one between connectors about which parts turn."""
        ends = ((self.joint.parent, self.joint.parent_connector), (self.joint.child, self.joint.child_connector))
        kinds = {spec.kind for part, name in ends for spec in self.draft.parts[part].connector_specs if spec.name == name}
        stated = any(form.name == self.joint.name and not isinstance(form, DerivedJoint) for form in self.draft.plan.joints)
        if self.joint.type is not JointType.FIXED or kinds.isdisjoint(TURNING_KINDS) or not stated:
            return ""
        where, rest = f"joints.{self.joint.name}", -roll if self.joint.mate is Mate.OPPOSED else roll
        turning = {f"{where}.type": "revolute", f"{where}.angle_deg": "endless", f"{where}.rest_deg": float(_number(rest))}
        return f"let it turn: {json.dumps(turning)}, or "

    def _offset(self, distance: float) -> Finding:
        wrong = self.actual.translation - self.expected.translation
        message = (
            f"{self.parent} and {self.child} are {distance:.4g} mm apart at rest: "
            f"{self.child} is off by {_point(wrong)} mm in the assembly's frame."
        )
        hint = f"{_capital(self._set('o'))}{self._move_instead(wrong)}{self._travel_instead(wrong)}."
        return self._finding("E_MATE_OFFSET", message, hint, distance, OFFSET_MM, "mm")

    def _move_instead(self, wrong: FloatArray) -> str:
        """Return the rest pose that would correct an offset, if the child has one of its own."""
        child = self.draft.parts[self.joint.child]
        if not isinstance(child.form, PartSpec) or not isinstance(child.form.rest_pose, Pose) or child.name == self.draft.plan.ground:
            return ""
        if any(spec.frame == "assembly" and spec.name == self.joint.child_connector for spec in child.connector_specs):
            return ""
        at = np.array(self.draft.evaluation.triple(child.form.rest_pose.at, f"{child.where}.rest_pose", "at"))
        return f", or rest_pose.at of {child.name} to {_point(at - wrong)}"

    def _travel_instead(self, wrong: FloatArray) -> str:
        """Return the rest travel that would correct an offset along the axis, if the limits allow it."""
        field = _SLIDE_FIELD.get(self.joint.type)
        if field is None:
            return ""
        parent_z = (_pose(self.draft, self.joint.parent) @ self.joint.T_parent_connector).z_axis
        along = float(wrong @ parent_z)
        if float(np.linalg.norm(wrong - along * parent_z)) > OFFSET_MM:
            return ""
        rest, low, high = self.joint.rest[0] + along, self.joint.limits.lower[0], self.joint.limits.upper[0]
        if not low - OFFSET_MM <= rest <= high + OFFSET_MM:
            return ""
        return f", or {field} of the joint to {_number(min(max(rest, low), high))}"


def _point(point: FloatArray) -> str:
    return f"({', '.join(_number(float(c)) for c in point)})"


def _direction(axis: FloatArray) -> str:
    return f"({', '.join(_number(float(c), _AXIS_DECIMALS) for c in axis)})"


def _number(value: float, decimals: int = _DECIMALS) -> str:
    """Return a number as a plan would state it: precise enough to correct the fault, without the noise of the last bits."""
    text = f"{round(value, decimals) + 0.0:.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
