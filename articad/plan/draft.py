"""The draft of a plan: every number, frame and joint computed as far as possible, and every fault found on the way."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from functools import cached_property

import numpy as np

from articad.connectors import SE3, Mate
from articad.errors import PlanError, did_you_mean
from articad.findings import Findings
from articad.kinematics.graph import JointGraph
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.tree import KinematicTree
from articad.plan.couplings import TiedCoordinate, couple
from articad.plan.derive import DraftPart, expand, trace, trace_joints
from articad.plan.evaluation import Evaluation
from articad.plan.motions import FitNumbers, JointNumbers, checked_fit, motion
from articad.plan.placing import Placing
from articad.plan.schema import AssemblyPlan, MaterialSpec, PartSpec

_IDENTITY = SE3.identity()
_WHOLE_TOLERANCE = 1e-9  # a computed count that differs from a whole number only by rounding is that number
_SIGNED_PERMUTATION = 1e-9  # largest distance of a reflection's entries from 0 and ±1 at which a bounding box keeps its sides


class Draft:
    """A plan whose numbers are being computed.

    Args:
        plan: The plan.
        overrides: Values that replace those of parameters.

    Attributes:
        evaluation: Its numbers.
        parts: By name, without those whose derivation has no root.
        lines: Joints with a type.
        motions: Joint name -> motion, for joints with valid numbers.
        joints: Finished joints, in the order in which they are declared.
        parent_joints: Part -> the joint that carries it in the spanning tree.
        auto_joints: Joint -> the part that it places (`rest_pose: "auto"`).
    """

    def __init__(self, plan: AssemblyPlan, overrides: Mapping[str, float] | None = None) -> None:
        self.plan, self.overrides = plan, dict(overrides or {})
        self.evaluation = Evaluation(plan, self.overrides)
        self.evaluation.check_parameters()
        expanded = expand(plan, self.evaluation)
        self.part_names = [part.name for part in expanded]
        self.parts = {part.name: part for part in reversed(expanded)}  # of two with the same name, the first counts
        self.parts = {name: self.parts[name] for name in self.part_names}
        in_order = trace(self.parts, self.evaluation)
        self.lines = trace_joints(plan, self.parts, self.evaluation)
        self.motions: dict[str, JointNumbers] = {}
        self.fits: dict[str, FitNumbers] = {}
        self.materials: dict[str, tuple[MaterialSpec, float, float]] = {}
        self.dimensions: dict[str, dict[str, float | int]] = {}
        self.envelopes: dict[str, tuple[float, float, float]] = {}
        self.joints: list[Joint] = []
        self.couplings: list[Coupling] = []
        self.waivers: list[tuple[tuple[str, str], float, str]] = []
        self.parent_joints: dict[str, str] = {}
        self._read_materials()
        self._read_parts()
        self._read_motions()
        tree = self._structure()
        placing = Placing(self.parts, in_order, self.lines, self.motions, plan.ground, tree, self.evaluation)
        placing.place_parts()
        placing.settle_frames()
        self.auto_joints = placing.auto_joints
        self._make_joints()
        self._read_couplings()
        self._read_waivers()

    def findings(self) -> Findings:
        """Return all faults, including those of the joint graph."""
        return Findings([*self.evaluation.findings, *self.graph_findings])

    # ---------------------------------------------------------------- numbers

    def _read_materials(self) -> None:
        self._report_repeated("materials", [material.name for material in self.plan.materials])
        for form in self.plan.materials:
            where = f"materials.{form.name}"
            density = self.evaluation.number(form.density_kg_m3, where, "density_kg_m3")
            friction = self.evaluation.number(form.friction, where, "friction")
            if density <= 0.0:
                message = f"{form.name} has a density of {density:.6g} kg/m³."
                self.evaluation.report(
                    "E_DENSITY", f"{where}.density_kg_m3", message, "Give kg/m³: steel 7850, oak 700, ABS 1050.", value=density
                )
            if friction < 0.0:
                message = f"{form.name} has a friction of {friction:.6g}."
                self.evaluation.report(
                    "E_FRICTION", f"{where}.friction", message, "Give a coefficient of at least 0, such as 0.6.", value=friction
                )
            self.materials.setdefault(form.name, (form, density, friction))

    def _read_parts(self) -> None:
        alone = len(self.parts) == 1
        for form in self.plan.parts:
            part = self.parts.get(form.name)
            if not isinstance(form, PartSpec) or part is None or part.form is not form:
                continue
            where = part.where
            if form.material not in self.materials:
                known = list(self.materials)
                hint = f"{did_you_mean(form.material, known).strip()} Declared: {', '.join(known) or 'none'}.".strip()
                message = f"Part {form.name!r} names material {form.material!r}, which is not declared."
                self.evaluation.report("E_MATERIAL_UNKNOWN", f"{where}.material", message, hint, parts=(form.name,))
            self._report_repeated(f"{where}.connectors", [connector.name for connector in form.connectors])
            if not form.connectors and not alone:
                hint = "Declare a connector where a joint is to hold it, with a joint that uses it."
                self.evaluation.report(
                    "E_NO_CONNECTORS", f"{where}.connectors", f"Part {form.name!r} has no connector.", hint, parts=(form.name,)
                )
            self.dimensions[form.name] = self._read_dimensions(form, where)
            if form.envelope_mm is not None:
                self._read_envelope(form, where)

    def _read_dimensions(self, form: PartSpec, where: str) -> dict[str, float | int]:
        values: dict[str, float | int] = {}
        for name, number in form.dimensions.items():
            value = self.evaluation.number(number, f"{where}.dimensions", name)
            if name.endswith("_count") and not math.isnan(value):
                if abs(value - round(value)) > _WHOLE_TOLERANCE:
                    hint = f"Give {round(value)}, or rename it without _count."
                    message = f"{name} is {value:.6g}, not a whole number."
                    self.evaluation.report("E_COUNT", f"{where}.dimensions.{name}", message, hint, value=value, parts=(form.name,))
                value = round(value)
            values[name] = value
        return values

    def _read_envelope(self, form: PartSpec, where: str) -> None:
        assert form.envelope_mm is not None
        sides = self.evaluation.triple(form.envelope_mm, where, "envelope_mm")
        for index, side in enumerate(sides):
            if side <= 0.0:
                message = f"Side {'xyz'[index]} of the expected bounding box is {side:.6g} mm."
                path = f"{where}.envelope_mm[{index}]"
                self.evaluation.report("E_ENVELOPE_VALUE", path, message, "Give three positive lengths in mm.", value=side, unit="mm")
        self.envelopes[form.name] = sides

    def _read_motions(self) -> None:
        self._report_repeated("couplings", [coupling.name for coupling in self.plan.couplings])
        read: dict[str, JointNumbers | None] = {}
        for line in self.lines:
            root = line.root.name
            if root not in read:
                read[root] = motion(line.root, self.evaluation)
                if line.root.fit is not None:
                    self.fits[root] = checked_fit(line.root.fit, f"joints.{root}.fit", self.evaluation, moves=line.root.type != "fixed")
            known = read[root]
            if known is not None:
                self.motions[line.name] = known.mirrored() if line.mirrored else known
        for line in self.lines:
            if line.root.name in self.fits:
                self.fits[line.name] = self.fits[line.root.name]

    def _report_repeated(self, where: str, names: list[str]) -> None:
        for name, count in Counter(names).items():
            if count > 1:
                kind = where.rsplit(".", maxsplit=1)[-1]
                hint = "Rename all but one."
                self.evaluation.report("E_DUP_NAME", f"{where}.{name}", f"{count} {kind} are called {name!r}.", hint, value=count)

    # ---------------------------------------------------------------- structure

    @cached_property
    def graph(self) -> JointGraph:
        """The joint graph made from names alone: frames and numbers may still be invalid."""
        limits = JointLimits()
        by_name = {line.name: line for line in self.lines}
        joints = []
        for form in self.plan.joints:
            line = by_name.get(form.name)
            (parent, parent_connector), (child, child_connector) = form.parent.split("."), form.child.split(".")
            joint_type = JointType(line.root.type) if line else JointType.REVOLUTE  # broken derivations still connect
            joints.append(
                Joint(
                    name=form.name,
                    type=joint_type,
                    parent=parent,
                    child=child,
                    parent_connector=parent_connector,
                    child_connector=child_connector,
                    T_parent_connector=_IDENTITY,
                    T_child_connector=_IDENTITY,
                    limits=limits,
                    rest=(),
                    driver=getattr(form, "driver", False),
                )
            )
        return JointGraph(self.part_names, self.plan.ground, joints)

    @cached_property
    def graph_findings(self) -> Findings:
        """Faults in the names of parts and joints and in their connections."""
        return self.graph.findings()

    def _structure(self) -> KinematicTree | None:
        self._check_connectors()
        try:
            tree, _ = self.graph.spanning_tree()
        except PlanError:
            return None
        self.parent_joints = {edge.part: edge.joint.name for edge in tree.edges}
        return tree

    def _check_connectors(self) -> None:
        """Report references to connectors that their part does not declare."""
        for form in self.plan.joints:
            for side, reference in (("parent", form.parent), ("child", form.child)):
                part_name, connector = reference.split(".")
                part = self.parts.get(part_name)
                if part is None or part.spec is None:
                    continue
                known = [spec.name for spec in part.connector_specs]
                if connector not in known:
                    hint = f"{did_you_mean(connector, known).strip()} Connectors of {part_name}: {', '.join(known)}.".strip()
                    if not known:
                        hint = f"Declare connector {connector!r} on {part_name}, which has none."
                    message = f"Joint {form.name!r} names connector {connector!r}, which part {part_name!r} does not have."
                    self.evaluation.report("E_CONNECTOR_UNKNOWN", f"joints.{form.name}.{side}", message, hint, parts=(part_name,))

    # ---------------------------------------------------------------- joints, couplings, waivers

    def _make_joints(self) -> None:
        for line in self.lines:
            known = self.motions.get(line.name)
            (parent, parent_connector), (child, child_connector) = line.ends
            C_p, C_c = (
                self.parts[part].connectors.get(connector) if part in self.parts else None
                for part, connector in ((parent, parent_connector), (child, child_connector))
            )
            if known is None or C_p is None or C_c is None:
                continue
            self.joints.append(
                Joint(
                    name=line.name,
                    type=known.type,
                    parent=parent,
                    child=child,
                    parent_connector=parent_connector,
                    child_connector=child_connector,
                    T_parent_connector=C_p.frame,
                    T_child_connector=C_c.frame,
                    limits=known.limits,
                    rest=known.rest,
                    mate=Mate(line.root.mate),
                    lead=known.lead,
                    driver=getattr(line.form, "driver", False),
                    effort=known.effort,
                    velocity=known.velocity,
                    fastening=line.root.fastening,
                )
            )

    def _read_couplings(self) -> None:
        if not self.plan.couplings:
            return
        coordinates: dict[str, TiedCoordinate] = {}
        for joint in self.joints:
            if joint.type.quaternion is not None:
                continue
            T = self.parts[joint.parent].T
            axis = None if T is None else T.rotate(joint.T_parent_connector.z_axis)
            for column, coordinate in zip(joint.columns, joint.type.coordinates, strict=True):
                coordinates[column.name] = TiedCoordinate(column.name, joint.name, joint.type, coordinate, column.unit, column.rest, axis)
        types = {line.name: JointType(line.root.type) for line in self.lines}
        for form in self.plan.couplings:
            row = couple(form, coordinates, types, self.evaluation)
            if row is not None:
                self.couplings.append(row)

    def _read_waivers(self) -> None:
        for index, form in enumerate(self.plan.allow):
            where, (a, b) = f"allow[{index}]", form.parts
            for name in dict.fromkeys(form.parts):
                if name not in self.parts:
                    hint = f"{did_you_mean(name, self.parts).strip()} Parts: {', '.join(self.parts)}.".strip()
                    self.evaluation.report(
                        "E_PART_UNKNOWN", f"{where}.parts", f"The waiver names part {name!r}, which is not declared.", hint
                    )
            if a == b:
                self.evaluation.report(
                    "E_ALLOW", f"{where}.parts", f"The waiver names {a!r} twice.", "Name two different parts.", parts=(a,)
                )
            depth = self.evaluation.number(form.max_depth_mm, where, "max_depth_mm")
            if depth <= 0.0:
                hint = "Give the largest depth in mm that is accepted, such as 0.05."
                self.evaluation.report(
                    "E_ALLOW", f"{where}.max_depth_mm", f"The depth is {depth:.6g} mm.", hint, value=depth, limit=0.0, unit="mm"
                )
            if not form.reason.strip():
                self.evaluation.report("E_ALLOW", f"{where}.reason", "The waiver gives no reason.", "Say why this overlap is meant.")
            self.waivers.append((form.parts, depth, form.reason))

    # ---------------------------------------------------------------- what images inherit

    def color(self, part: DraftPart) -> str | None:
        """Return the colour that a part states, else that of its sources."""
        if part.form.color is not None:
            return part.form.color.lower()
        return None if part.source is None else self.color(self.parts[part.source])

    def envelope(self, part: DraftPart) -> tuple[float, float, float] | None:
        """Return the expected bounding box in the part's frame; None if it is not stated, or if an oblique mirror changes it."""
        if part.source is None:
            return self.envelopes.get(part.name)
        sides = self.envelope(self.parts[part.source])
        if sides is None or part.S is None:
            return sides
        entries = np.abs(part.S[:3, :3])
        if (np.minimum(entries, np.abs(entries - 1.0)) > _SIGNED_PERMUTATION).any():
            return None
        x, y, z = (float(side) for side in np.round(entries) @ sides)  # a plane at 45° exchanges two sides
        return x, y, z
