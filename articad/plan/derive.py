"""Derived parts and joints: which part is an image of which, and by which operation.

A mirror is not a rigid motion: it keeps the source's rest pose and reflects the geometry inside it, so that connectors stay
right-handed. Rigid copies and patterns keep the geometry and move the rest pose.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3, Connector, Plane
from articad.errors import did_you_mean
from articad.plan.evaluation import Evaluation
from articad.plan.fields import MAX_NAME, is_name
from articad.plan.schema import (
    AssemblyPlan,
    ConnectorSpec,
    DerivedJoint,
    DerivedPart,
    JointSpec,
    MirrorDerivation,
    PartSpec,
    PatternDerivation,
    RigidDerivation,
)

Operation = Literal["mirror", "rigid", "pattern"]
End = tuple[str, str]  # names of a part and of its connector

MAX_COUNT = 1000  # a pattern of more is a typing error, and would use up the memory for reading a plan
_NORMAL_ZERO = 1e-9  # length below which a normal has no direction, as in articad.connectors


@dataclass
class DraftConnector:
    """A connector while its plan is being resolved.

    Attributes:
        spec: As stated.
        where: Its path in the plan.
        o: Origin `(3,)` in the part's frame [mm].
        z: Unit axis `(3,)` in the part's frame.
        x: Unit axis `(3,)` in the part's frame, None until a rule has chosen it.
        connector: The finished connector.
    """

    spec: ConnectorSpec
    where: str
    o: FloatArray
    z: FloatArray
    x: FloatArray | None
    connector: Connector | None = None


@dataclass
class DraftPart:
    """A part while its plan is being resolved.

    Attributes:
        name: Its name; a pattern's copies are numbered.
        where: Its path in the plan.
        spec: The part that a script builds, at the root of the derivation; None if there is none.
        form: The entry of this part in the plan: `spec` itself, or how it is derived.
        source: The part it derives from.
        op: The operation.
        copy: Number of the copy in its pattern, from 1.
        mirrored: Whether an odd number of mirrors lies between `spec` and this part.
        auto: Whether a joint places it.
        T: Rest pose, T_assembly_part; None if it is unknown.
        S: Reflection `(4, 4)` in the part's frame that turns its source into the mirrored part.
        frames: Connectors of a part that is not derived.
        connectors: Finished connectors.
    """

    name: str
    where: str
    form: PartSpec | DerivedPart
    spec: PartSpec | None = None
    source: str | None = None
    op: Operation | None = None
    copy: int = 0
    mirrored: bool = False
    auto: bool = False
    T: SE3 | None = None
    S: FloatArray | None = None
    frames: dict[str, DraftConnector] = field(default_factory=dict)
    connectors: dict[str, Connector] = field(default_factory=dict)

    @property
    def derived(self) -> bool:
        """True when no script builds it."""
        return self.source is not None

    @property
    def connector_specs(self) -> tuple[ConnectorSpec, ...]:
        """The connectors that the part has by name, its own or its source's."""
        return self.spec.connectors if self.spec else ()


def expand(plan: AssemblyPlan, evaluation: Evaluation) -> list[DraftPart]:
    """Return the parts in the order in which they are declared, each pattern as its copies; names may still repeat."""
    drafts: list[DraftPart] = []
    for form in plan.parts:
        where = f"parts.{form.name}"
        if isinstance(form, PartSpec):
            drafts.append(DraftPart(form.name, where, form, spec=form, auto=form.rest_pose == "auto"))
        elif isinstance(form.derive, PatternDerivation):
            for copy in range(1, _count(form.derive, where, evaluation) + 1):
                name = f"{form.name}_{copy}"
                if not is_name(name):
                    hint = f"Shorten {form.name!r}: with its number it may have {MAX_NAME} characters."
                    evaluation.report("E_NAME", where, f"The pattern's copy {name!r} has no valid name.", hint)
                drafts.append(DraftPart(name, where, form, source=form.derive.source, op="pattern", copy=copy))
        else:
            drafts.append(DraftPart(form.name, where, form, source=form.derive.source, op=form.derive.op))
    return drafts


def _count(derivation: PatternDerivation, where: str, evaluation: Evaluation) -> int:
    count = evaluation.number(derivation.count, where, "derive.count")
    if math.isnan(count):
        return 0
    if count != int(count) or not 1 <= count <= MAX_COUNT:
        hint = f"Give a whole number from 1 to {MAX_COUNT}."
        nearest = min(max(round(count), 1), MAX_COUNT)
        message = f"A pattern cannot have {count:.6g} parts."
        evaluation.report("E_DERIVE_COUNT", f"{where}.derive.count", message, f"{hint} The nearest is {nearest}.", value=count)
        return 0
    return int(count)


def trace(parts: Mapping[str, DraftPart], evaluation: Evaluation) -> list[DraftPart]:
    """Find the root of every derivation, and return the parts sorted so that each follows its source.

    Sets `spec` and `mirrored` of derived parts; those without a root keep `spec` None and are reported.
    """
    ordered: dict[str, DraftPart] = {}
    lost: set[str] = set()

    def visit(part: DraftPart, path: tuple[str, ...]) -> None:
        if part.name in ordered or part.name in lost:
            return
        if part.source is not None:
            source = parts.get(part.source)
            if source is None:
                _report_unknown(part.where, part.source, parts, "part", evaluation)
            elif source.name in (*path, part.name):
                circle = (*path, part.name)[(*path, part.name).index(source.name) :]
                _report_cycle(f"parts.{min(circle)}", "Parts", circle, evaluation)
                lost.update(circle)
            else:
                visit(source, (*path, part.name))
            if source is None or source.spec is None:
                lost.add(part.name)
                return
            part.spec, part.mirrored = source.spec, source.mirrored ^ (part.op == "mirror")
        ordered[part.name] = part

    for part in parts.values():
        visit(part, ())
    return list(ordered.values())


def place(part: DraftPart, source: DraftPart, evaluation: Evaluation) -> None:
    """Set the rest pose of a derived part whose source is placed, and S of a mirrored one."""
    assert isinstance(part.form, DerivedPart)
    derivation, where = part.form.derive, f"{part.where}.derive"
    if isinstance(derivation, MirrorDerivation):
        point = evaluation.triple(derivation.plane.point, f"{where}.plane", "point")
        normal = evaluation.triple(derivation.plane.normal, f"{where}.plane", "normal")
        if math.hypot(*normal) < _NORMAL_ZERO:
            message, hint = (
                "The plane's normal (0, 0, 0) has no direction.",
                "Give a direction, such as [1, 0, 0] to mirror left and right.",
            )
            evaluation.report("E_AXIS_ZERO", f"{where}.plane.normal", message, hint)
        elif source.T is not None and math.isfinite(sum(point) + sum(normal)):
            T = source.T
            part.T = T
            part.S = T.inverse().matrix @ Plane(np.array(point), np.array(normal)).matrix @ T.matrix
        return
    moves_by = derivation.move if isinstance(derivation, RigidDerivation) else derivation.step
    step = evaluation.pose(moves_by, f"{where}.{'move' if isinstance(derivation, RigidDerivation) else 'step'}")
    if step is not None and source.T is not None:
        part.T = source.T
        for _ in range(part.copy or 1):
            part.T = step @ part.T


def inherit(part: DraftPart, source: DraftPart) -> None:
    """Give a derived part the connectors of its source: reflected by a mirror, else the same."""
    if part.op != "mirror":
        part.connectors = dict(source.connectors)
    elif part.S is not None:
        part.connectors = {name: connector.mirrored(part.S) for name, connector in source.connectors.items()}


# ---------------------------------------------------------------- joints


@dataclass(frozen=True)
class JointLine:
    """A joint together with the one that states its type and limits.

    Attributes:
        name: Its name.
        where: Its path in the plan.
        form: Its form in the plan.
        root: The joint at the root of its derivation: itself if it is not derived.
        mirrored: Whether an odd number of mirrors lies between `root` and this joint.
    """

    name: str
    where: str
    form: JointSpec | DerivedJoint
    root: JointSpec
    mirrored: bool

    @property
    def ends(self) -> tuple[End, End]:
        """Part and connector names of the parent's and the child's side."""
        (parent, parent_connector), (child, child_connector) = self.form.parent.split("."), self.form.child.split(".")
        return (parent, parent_connector), (child, child_connector)


def trace_joints(plan: AssemblyPlan, parts: Mapping[str, DraftPart], evaluation: Evaluation) -> list[JointLine]:
    """Return the joints that have a type, in the order in which they are declared; derived ones are checked against their source."""
    forms = {joint.name: joint for joint in reversed(plan.joints)}  # of two with the same name, the first counts
    lines: dict[str, JointLine | None] = {}

    def visit(name: str, path: tuple[str, ...]) -> JointLine | None:
        if name in lines:
            return lines[name]
        form, where = forms[name], f"joints.{name}"
        line: JointLine | None = None
        if not isinstance(form, DerivedJoint):
            line = JointLine(name, where, form, form, mirrored=False)
        elif form.derive.source not in forms:
            _report_unknown(where, form.derive.source, forms, "joint", evaluation)
        elif form.derive.source in (*path, name):
            circle = (*path, name)[(*path, name).index(form.derive.source) :]
            _report_cycle(f"joints.{min(circle)}", "Joints", circle, evaluation)
            lines.update(dict.fromkeys(circle))
        else:
            source = visit(form.derive.source, (*path, name))
            if source is not None:
                line = JointLine(name, where, form, source.root, mirrored=source.mirrored ^ (form.derive.op == "mirror"))
                _check_image(form, source, parts, evaluation)
        lines.setdefault(name, line)
        return lines[name]

    found = (visit(name, ()) for name in dict.fromkeys(joint.name for joint in plan.joints))
    return [line for line in found if line is not None]


def _check_image(form: DerivedJoint, source: JointLine, parts: Mapping[str, DraftPart], evaluation: Evaluation) -> None:
    """Report a derived joint whose child is not the image of its source's child by the same operation."""
    child_name, connector = form.child.split(".")
    source_name, source_connector = source.form.child.split(".")
    child, original = parts.get(child_name), parts.get(source_name)
    if child is None or original is None or child.spec is None or original.spec is None:
        return
    mirrors, op = child.mirrored ^ original.mirrored, form.derive.op
    is_image = child.spec is original.spec and child is not original and mirrors == (op == "mirror")
    if is_image and connector == source_connector:
        return
    images = [
        part.name
        for part in parts.values()
        if part.spec is original.spec and part is not original and (part.mirrored ^ original.mirrored) == (op == "mirror")
    ]
    hint = "Declare the joint in full, with its own type and limits."
    if is_image:
        hint = f"Set child to {child_name}.{source_connector}, or declare the joint in full."
    elif child.spec is original.spec and child is not original:
        hint = f"Set op to {'mirror' if mirrors else 'rigid'!r}: that is how {child_name} derives from {source_name}."
    elif images:
        hint = f"Set child to {images[0]}.{source_connector}, or declare the joint in full."
    message = f"{form.child} is not the {'mirror' if op == 'mirror' else 'rigid'} image of {source.form.child}, the child of {source.name}."
    evaluation.report("E_DERIVE_JOINT", f"joints.{form.name}.child", message, hint, parts=(child_name, source_name))


def _report_unknown(where: str, source: str, known: Iterable[str], kind: str, evaluation: Evaluation) -> None:
    names = list(known)
    hint = f"{did_you_mean(source, names).strip()} Known: {', '.join(names)}.".strip()
    evaluation.report("E_DERIVE_UNKNOWN", f"{where}.derive.from", f"There is no {kind} {source!r} to derive from.", hint)


def _report_cycle(where: str, kind: str, circle: tuple[str, ...], evaluation: Evaluation) -> None:
    message = f"{kind} derive from each other: {' -> '.join((*circle, circle[0]))}."
    evaluation.report("E_DERIVE_CYCLE", f"{where}.derive.from", message, f"Define one of {', '.join(circle)} on its own.")
