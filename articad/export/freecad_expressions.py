"""Numbers, frames and poses of a plan as FreeCAD expressions, so that a document follows its parameters."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from articad.plan.expressions import ExpressionError, parse
from articad.plan.resolve import ResolvedPlan
from articad.plan.schema import DerivedPart, MirrorDerivation, Pose, RigidDerivation

Number = float | str
UNITS = {"mm": "mm", "deg": "deg", "1": ""}
"""FreeCAD's word for each unit of a parameter."""


class Followed:
    """The expressions that follow the parameters of a plan, which are in a document's VarSet `Parameters`.

    Args:
        resolved: The plan; without one nothing follows.
    """

    def __init__(self, resolved: ResolvedPlan | None) -> None:
        self._resolved = resolved
        self._units = {} if resolved is None else {row.name: UNITS[row.unit] for row in resolved.plan.parameters}
        self._names = {name: f"(Parameters.p_{name} / 1 {unit})" if unit else f"Parameters.p_{name}" for name, unit in self._units.items()}
        self._forms = {} if resolved is None else {form.name: form for form in resolved.plan.parts}

    def number(self, number: Number, unit: str = "") -> str | None:
        """Return the expression of a number of the plan, or None if it is a plain number.

        Without a unit, the expression is a plain number too: lengths in mm, angles in degrees.
        """
        if not isinstance(number, str):
            return None
        if unit and self._units.get(number.strip()) == unit:
            return f"Parameters.p_{number.strip()}"
        try:
            expression = parse(number)
            if not expression.names:
                return None
            text = expression.to_freecad(self._names)
        except ExpressionError:  # a resolved plan has no such error
            return None
        return f"({text}) * 1 {unit}" if unit else text

    def placing(self, parts: Collection[str]) -> dict[str, set[str]]:
        """Return the parts that each parameter places at rest, directly or through other parameters, of those given."""
        if self._resolved is None:
            return {}
        rests = {
            form.name: [value for key in ("rest_mm", "rest_deg") if (value := getattr(form, key, None)) is not None]
            for form in self._resolved.plan.joints
        }
        numbers: dict[str, list[Number]] = {}
        for part in parts:
            poses = self._poses(part)
            joint = self._resolved.parts[part].parent_joint
            numbers[part] = (
                list(rests.get(str(joint), []))
                if poses is None
                else [n for pose in poses for n in (*pose.at, *pose.axis, pose.angle_deg, *pose.about)]
            )
        return self.needed(numbers)

    def needed(self, numbers: Mapping[str, Sequence[Number]]) -> dict[str, set[str]]:
        """Return the parts for whose numbers each parameter is needed, directly or through other parameters."""
        needs = (
            {} if self._resolved is None else {parameter.name: names_in(parameter.value) for parameter in self._resolved.plan.parameters}
        )
        found: dict[str, set[str]] = {}
        for part, held in numbers.items():
            waiting, seen = [name for number in held for name in names_in(number)], set[str]()
            while waiting:
                name = waiting.pop()
                if name not in seen:
                    seen.add(name)
                    found.setdefault(name, set()).add(part)
                    waiting += needs.get(name, ())
        return found

    def follows(self, *numbers: Number) -> bool:
        """Return whether one of these follows a parameter."""
        return any(self.number(number) is not None for number in numbers)

    def vector(self, numbers: Sequence[Number]) -> str:
        """Return the expression of a point or direction."""
        return f"vector({'; '.join(map(self.always, numbers))})"

    def frame(self, o: Sequence[Number], z: Sequence[Number], x: Sequence[Number]) -> str:
        """Return the expression of a connector's frame."""
        turn = f"create(<<rotation>>; {self.vector(x)}; vector(0; 0; 0); {self.vector(z)}; <<ZXY>>)"
        return f"placement({self.vector(o)}; {turn})"

    def local(self, part: str, text: str) -> str | None:
        """Return the expression in a part's frame of `text`, given in the assembly's frame; None if a joint places the part."""
        poses = self._poses(part)
        return None if poses is None else f"minvert({' * '.join(map(self._pose, poses))}) * {text}"

    def mirror(self, part: str) -> dict[str, str]:
        """Return the expressions of a mirror plane in its own frame, `Base` and `Normal`, for those of the two that move."""
        form, poses = self._forms.get(part), self._poses(part)
        if poses is None or not isinstance(form, DerivedPart) or not isinstance(form.derive, MirrorDerivation):
            return {}
        plane, found = form.derive.plane, {}
        turns = self.follows(*plane.normal, *(number for pose in poses for number in (*pose.axis, pose.angle_deg)))
        if turns or self.follows(*plane.point, *(number for pose in poses for number in (*pose.at, *pose.about))):
            found["Base"] = self.local(part, self.vector(plane.point)) or ""
        if turns:
            found["Normal"] = f"{self.local(part, self.vector(plane.normal))} - {self.local(part, 'vector(0; 0; 0)')}"
        return found

    def motions(self, part: str) -> tuple[list[str], str | None]:
        """Return the motions that place a part at rest as expressions, the last one first, and the part that a joint places before them.

        The second value is None if a pose of the plan places the part, and the part itself or its source if a joint does.
        """
        poses = self._poses(part)
        if poses is not None:
            return list(map(self._pose, poses)), None
        form, step = self._forms.get(part), 0
        if form is None:
            source, _, number = part.rpartition("_")
            form, step = self._forms.get(source), int(number)
        if not isinstance(form, DerivedPart):
            return [], part
        before, root = self.motions(form.derive.source)
        if isinstance(form.derive, MirrorDerivation):
            return before, root
        moves = [form.derive.move] if isinstance(form.derive, RigidDerivation) else [form.derive.step] * step
        return [*map(self._pose, moves), *before], root

    def _poses(self, part: str) -> list[Pose] | None:
        """Return the motions that place a part at rest, the last one first."""
        form, step = self._forms.get(part), 0
        if form is None:  # patterns are expanded: NAME_3 is the third of NAME
            source, _, number = part.rpartition("_")
            form = self._forms.get(source)
            if not number.isdigit() or form is None:
                return None
            step = int(number)
        if not isinstance(form, DerivedPart):
            return [form.rest_pose] if isinstance(form.rest_pose, Pose) else None
        before = self._poses(form.derive.source)
        if before is None or isinstance(form.derive, MirrorDerivation):
            return before  # a mirror image has its source's frame
        if isinstance(form.derive, RigidDerivation):
            return [form.derive.move, *before]
        return [*[form.derive.step] * step, *before]

    def _pose(self, pose: Pose) -> str:
        turn = f"create(<<rotation>>; {self.vector(pose.axis)}; {self.always(pose.angle_deg)})"
        return f"create(<<placement>>; {self.vector(pose.at)}; {turn}; {self.vector(pose.about)})"

    def always(self, number: Number) -> str:
        """Return the expression of a number of the plan, or the plain number."""
        text = self.number(number)
        if text is not None:
            return text
        known = {} if self._resolved is None else self._resolved.parameters
        return repr(float(parse(number).evaluate(known) if isinstance(number, str) else number))


def names_in(number: Number) -> tuple[str, ...]:
    """Return the parameters that a number of the plan names."""
    try:
        return tuple(parse(number).names) if isinstance(number, str) else ()
    except ExpressionError:  # a plan that was resolved has none such
        return ()
