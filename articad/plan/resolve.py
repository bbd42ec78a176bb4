"""Resolving: converts a plan with names and expressions to parts, frames and joints with numbers.

`Draft` computes a whole plan and continues after every fault, so that all are found at once. `resolve` returns the result if there was
no fault.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal, Self

from articad.arrays import FloatArray
from articad.connectors import SE3, Connector
from articad.errors import PlanError
from articad.findings import Findings
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.mechanism import Mechanism
from articad.plan.derive import Operation
from articad.plan.draft import Draft
from articad.plan.fit_names import PRINTED_MM, named_gap, nominal_in
from articad.plan.joint_forms import Contact
from articad.plan.schema import AssemblyPlan, KernelName, PartSpec

Side = Literal["parent", "child"]


@dataclass(frozen=True)
class Material:
    """The material of a part.

    Attributes:
        name: As in the plan.
        density: kg/m³.
        color: "#rrggbb".
        friction: Coefficient.
    """

    name: str
    density: float
    color: str
    friction: float


@dataclass(frozen=True)
class Fit:
    """The clearance between the two parts of a joint.

    Attributes:
        gap_min: Smallest distance of the surfaces over the whole motion [mm]; if they may touch, the smallest play. None: not checked.
        gap_max: Largest play at rest [mm]: half the difference of diameters of a hole and its pin, regardless of their offset. None: not
            checked.
        within: Only surface closer than this to the joint's axis counts [mm]; None: all of it.
        contact: "allowed", "required", "forbidden"; None: not checked.
        name: Where the gap comes from, such as "H7/g6", "sliding", or None.
        nominal: Nominal diameter of a named fit [mm]. An ISO 286 fit without one has no gap until the bore is measured (`sized`).
    """

    gap_min: float | None = None
    gap_max: float | None = None
    within: float | None = None
    contact: Contact | None = None
    name: str | None = None
    nominal: float | None = None

    @classmethod
    def named(cls, name: str, nominal: float | None = None, *, within: float | None = None, contact: Contact = "allowed") -> Self:
        """Return a fit by its name.

        Args:
            name: An ISO 286 fit such as "H7/g6" or "25 H7/g6", or "loose", "sliding" or "press" for printed parts.
            nominal: Nominal diameter [mm]. Without it, the fit is measured against that of the bore.
            within: Only surface closer than this to the joint's axis counts [mm]; None: all of it.
            contact: "allowed" (a pin may touch its bore), "required" or "forbidden"; None: not checked.

        Raises:
            PlanError: If there is no such fit, or if name and `nominal` state different diameters.

        Example:
            >>> Fit.named("H7/g6", 25).gap_min
            0.0035
        """
        stated = nominal_in(name)
        if stated is not None and nominal is not None and stated != nominal:
            raise PlanError(f"The fit {name!r} states a diameter other than {nominal:.6g} mm.")
        fit = cls(None, None, within, contact, name, stated if nominal is None else nominal)
        return fit if fit.nominal is None and name not in PRINTED_MM else fit.sized(fit.nominal)

    def sized(self, nominal: float | None) -> Self:
        """Return a named fit with the gap that its name stands for at a nominal diameter [mm]; any other fit as it is.

        Raises:
            PlanError: If ISO 286 has no such fit at this diameter.
        """
        if self.name is None:
            return self
        gap = named_gap(self.name, nominal)
        return replace(self, gap_min=gap.least, gap_max=gap.largest, nominal=nominal)


@dataclass(frozen=True)
class Waiver:
    """An intended overlap.

    Attributes:
        parts: The two parts.
        max_depth: Depth up to which it is waived [mm].
        reason: Why.
    """

    parts: tuple[str, str]
    max_depth: float
    reason: str


@dataclass(frozen=True, eq=False)
class Derivation:
    """How a part is derived from another.

    Attributes:
        source: Name of that part, which may be derived itself.
        op: mirror, rigid or pattern.
        S: Reflection `(4, 4)` in the source's part frame; None unless mirrored.
    """

    source: str
    op: Operation
    S: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class ResolvedPart:
    """A part with its numbers.

    Attributes:
        name: Its name; copies of a pattern are numbered.
        description: Its shape, for the author of its script.
        role: What it is for.
        orientation: Which way is up and front in its own frame.
        material: Its material.
        color: Its own colour, else its material's.
        dimensions: Numbers of its script: mm, degrees (`_deg`), whole numbers (`_count`).
        envelope: Expected bounding box `(3,)` [mm] in the part's frame, or None.
        T_rest: T_assembly_part at rest.
        connectors: By name, in the part's frame.
        derivation: How it is derived; None if a script builds it.
        kernel: The kernel that the plan requires for it, or None.
        parent_joint: The joint to its parent in the spanning tree; None for the ground.
        spec: The plan's form of the part that a script builds.
    """

    name: str
    description: str
    role: str
    orientation: str
    material: Material
    color: str
    dimensions: Mapping[str, float | int]
    envelope: tuple[float, float, float] | None
    T_rest: SE3
    connectors: Mapping[str, Connector]
    derivation: Derivation | None
    kernel: KernelName | None
    parent_joint: str | None
    spec: PartSpec

    @property
    def environment(self) -> bool:
        """Whether it belongs to the environment, which is checked against but not exported."""
        return self.spec.environment


@dataclass(frozen=True, eq=False)
class ResolvedPlan:
    """A plan with its numbers.

    Attributes:
        plan: The plan.
        overrides: Parameters with values other than the plan's.
        parameters: All parameters: mm, degrees or plain.
        parts: By name, in order of declaration, patterns expanded.
        joints: In the order in which they are declared.
        couplings: Rows q_b - k q_a - c = 0.
        fits: By joint.
        waivers: Intended overlaps.
        materials: By name.
        ground: The part that does not move.
        findings: Warnings and notes.
    """

    plan: AssemblyPlan
    overrides: Mapping[str, float]
    parameters: Mapping[str, float]
    parts: Mapping[str, ResolvedPart]
    joints: tuple[Joint, ...]
    couplings: tuple[Coupling, ...]
    fits: Mapping[str, Fit]
    waivers: tuple[Waiver, ...]
    materials: Mapping[str, Material]
    ground: str
    findings: Findings = field(default_factory=Findings)

    def product(self) -> ResolvedPlan:
        """Return the plan without the parts of the environment and the joints that fix them."""
        inside = {name: part for name, part in self.parts.items() if not part.environment}
        if len(inside) == len(self.parts):
            return self
        joints = tuple(joint for joint in self.joints if joint.child in inside)
        held = {joint.name for joint in joints}
        sources = {each.name: getattr(each, "derive", None) for each in self.plan.parts}
        outside = {part.spec.name for part in self.parts.values() if part.environment}

        def is_outside(name: str) -> bool:
            derived = sources.get(name)
            return name in outside or (derived is not None and is_outside(derived.source))

        plan = self.plan.model_copy(
            update={
                "parts": tuple(each for each in self.plan.parts if not is_outside(each.name)),
                "joints": tuple(each for each in self.plan.joints if each.name in held),
                "allow": tuple(each for each in self.plan.allow if set(each.parts) <= inside.keys()),
            }
        )
        waivers = tuple(waiver for waiver in self.waivers if set(waiver.parts) <= inside.keys())
        fits = {name: fit for name, fit in self.fits.items() if name in held}
        return replace(self, plan=plan, parts=inside, joints=joints, fits=fits, waivers=waivers)

    @cached_property
    def joints_at(self) -> Mapping[tuple[str, str], tuple[tuple[Joint, Side], ...]]:
        """The joints at each (part, connector) and the side of the joint there, in the order in which they are declared."""
        found: dict[tuple[str, str], tuple[tuple[Joint, Side], ...]] = {}
        for joint in self.joints:
            sides: tuple[tuple[tuple[str, str], Side], ...] = (
                ((joint.parent, joint.parent_connector), "parent"),
                ((joint.child, joint.child_connector), "child"),
            )
            for end, side in sides:
                found[end] = (*found.get(end, ()), (joint, side))
        return found

    @cached_property
    def mechanism(self) -> Mechanism:
        """The mechanism of parts and joints, made at the first access.

        Raises:
            PlanError: If the joints do not form a mechanism.
        """
        return Mechanism(tuple(self.parts), self.ground, self.joints, self.couplings, self.parts[self.ground].T_rest)


def resolve(plan: AssemblyPlan, /, **parameters: float) -> ResolvedPlan:
    """Compute every number, frame and joint of a plan.

    Args:
        plan: The plan.
        **parameters: Values that replace those of parameters: mm, degrees.

    Raises:
        PlanError: With all findings, if a number, name, axis or derivation is wrong. Rest poses that do not meet are not an error here:
            `check_plan` reports them, and `admitted` refuses them before anything is built.
    """
    draft = Draft(plan, parameters)
    findings = draft.findings()
    if not findings.ok:
        raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
    return resolved_from(draft, findings)


def resolved_from(draft: Draft, findings: Findings) -> ResolvedPlan:
    """Return the result of a draft without errors."""
    materials = {name: Material(name, density, form.color.lower(), friction) for name, (form, density, friction) in draft.materials.items()}
    parts: dict[str, ResolvedPart] = {}
    for name, part in draft.parts.items():
        spec = part.spec
        assert spec is not None
        assert part.T is not None
        material = materials[spec.material]
        parts[name] = ResolvedPart(
            name=name,
            description=part.form.description or spec.description,
            role=spec.role,
            orientation=spec.orientation,
            material=material,
            color=draft.color(part) or material.color,
            dimensions=draft.dimensions[spec.name],
            envelope=draft.envelope(part),
            T_rest=part.T,
            connectors=part.connectors,
            derivation=None if part.source is None or part.op is None else Derivation(part.source, part.op, part.S),
            kernel=spec.kernel,
            parent_joint=draft.parent_joints.get(name),
            spec=spec,
        )
    return ResolvedPlan(
        plan=draft.plan,
        overrides=draft.overrides,
        parameters=draft.evaluation.values,
        parts=parts,
        joints=tuple(draft.joints),
        couplings=tuple(draft.couplings),
        fits={name: Fit(*numbers) for name, numbers in draft.fits.items()},
        waivers=tuple(Waiver(parts, depth, reason) for parts, depth, reason in draft.waivers),
        materials=materials,
        ground=draft.plan.ground,
        findings=findings,
    )
