"""The plan: what a person or a model writes, and `plan.json` stores (`articad.plan/1`).

Reading a plan checks only its form. `articad.plan.resolve` computes its numbers, and `articad.plan.check` checks them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import Discriminator, Field, Tag

from articad.plan import reading, writing
from articad.plan.fields import Color, Name, NamePair, Number, PlanObject, Text, Truth, Vector, Whole
from articad.plan.joint_forms import (
    AnyJoint,
    BallSpec,
    BeltSpec,
    CouplingSpec,
    CylindricalSpec,
    DerivedJoint,
    FitSpec,
    FixedSpec,
    FreeSpec,
    GearSpec,
    JointForm,
    JointSpec,
    LinearSpec,
    PlanarSpec,
    RackSpec,
    RevoluteSpec,
    ScrewCouplingSpec,
    ScrewSpec,
    SliderSpec,
    UniversalSpec,
)

SCHEMA = "articad.plan/1"
PLAN_FILE = "plan.json"

KernelName = Literal["build123d", "freecad"]
ConnectorKind = Literal[
    "hinge_axis", "slide_axis", "shaft_axis", "bore_axis", "ball_centre", "mount_face", "gear_axis", "thread_axis", "frame"
]

TURNING_KINDS: Final = ("hinge_axis", "shaft_axis", "bore_axis", "gear_axis")
"""Kinds of connectors about whose axis parts turn."""


class Parameter(PlanObject):
    """A named number that expressions use."""

    name: Name
    value: Number
    unit: Literal["mm", "deg", "1"] = "mm"
    min: Number | None = None
    max: Number | None = None
    description: Text = ""


class MaterialSpec(PlanObject):
    """What parts are made of."""

    name: Name
    density_kg_m3: Number
    color: Color
    friction: Number = 0.6


class Pose(PlanObject):
    """A rigid motion: p becomes R(p - about) + about + at."""

    at: Vector = Field((0.0, 0.0, 0.0), description="Shift in mm")
    about: Vector = Field((0.0, 0.0, 0.0), description="A point of the axis, in mm")
    axis: Vector = (0.0, 0.0, 1.0)
    angle_deg: Number = 0.0


class ConnectorSpec(PlanObject):
    """A named frame on a part, where a joint attaches."""

    name: Name
    o: Vector = Field(description="Origin in mm")
    z: Vector = Field(description="The joint's axis, any length")
    x: Vector | None = Field(
        None, description="Zero of the angle, at right angles to z; left out: chosen so that nothing is turned at rest"
    )
    frame: Literal["part", "assembly"] = Field("part", description="Whose frame o, z and x are given in (assembly: at rest)")
    kind: ConnectorKind = "frame"
    label: Text = Field(description="For whoever builds the part: which feature is here")


def _rest_pose_tag(value: Any) -> str:
    return "auto" if isinstance(value, str) else "pose"


RestPose = Annotated[Annotated[Pose, Tag("pose")] | Annotated[Literal["auto"], Tag("auto")], Discriminator(_rest_pose_tag)]


class PartSpec(PlanObject):
    """A part that a script builds."""

    name: Name
    material: Name
    role: Text = Field("", description="What it is for")
    description: Text = Field(description="Its shape, in the part's own frame, in terms of the named dimensions")
    orientation: Text = Field("", description="Which way is up and front in its own frame")
    dimensions: dict[Name, Number] = Field(
        default_factory=dict, description="Every number the script needs, in mm; *_deg in degrees; *_count whole numbers"
    )
    envelope_mm: Vector | None = Field(None, description="Expected bounding box, within 2 %")
    rest_pose: RestPose = Field(Pose(), description="Places the part's frame in the assembly at rest; auto: by its joint")
    connectors: tuple[ConnectorSpec, ...] = ()
    environment: Truth = Field(
        default=False, description="true: a floor, a wall, room for a hand: checked against, not exported, without mass"
    )
    color: Color | None = None
    kernel: KernelName | None = None


class MirrorPlane(PlanObject):
    """A plane in the assembly's frame."""

    point: Vector
    normal: Vector


class MirrorDerivation(PlanObject):
    """The mirror image of a part."""

    source: Name = Field(alias="from")
    op: Literal["mirror"]
    plane: MirrorPlane


class RigidDerivation(PlanObject):
    """The same part elsewhere."""

    source: Name = Field(alias="from")
    op: Literal["rigid"]
    move: Pose = Field(description="In the assembly's frame, after the source's rest pose")


class PatternDerivation(PlanObject):
    """Parts NAME_1 ... NAME_count, the i-th moved by step i times."""

    source: Name = Field(alias="from")
    op: Literal["pattern"]
    count: Number
    step: Pose


class DerivedPart(PlanObject):
    """A part with the geometry of another: no script of its own."""

    name: Name
    description: Text = ""
    color: Color | None = None
    derive: Annotated[MirrorDerivation | RigidDerivation | PatternDerivation, Field(discriminator="op")]


def _part_tag(value: Any) -> str:
    derived = "derive" in value if isinstance(value, dict) else isinstance(value, DerivedPart)
    return "derived" if derived else "part"


AnyPart = Annotated[Annotated[PartSpec, Tag("part")] | Annotated[DerivedPart, Tag("derived")], Discriminator(_part_tag)]


class Allow(PlanObject):
    """An overlap that is meant."""

    parts: NamePair
    max_depth_mm: Number
    reason: Text


class AssemblyPlan(PlanObject):
    """A whole plan: parts with connectors, and the joints between them.

    Attributes:
        form: The form's version, `schema` in JSON.
        ground: The part that does not move.
        freedoms: How many independent motions the assembly is meant to have.
        tree: True asserts that the joints close no loop.
        assumptions: What the request left open and how it was read.
    """

    form: Literal["articad.plan/1"] = Field(alias="schema")
    name: Name
    description: Text = ""
    ground: Name = Field(description="The part that does not move")
    freedoms: Whole = Field(description="How many independent motions the assembly has")
    tree: Truth = Field(default=False, description="true asserts that the joints close no loop")
    kernel: KernelName = "build123d"
    parameters: tuple[Parameter, ...] = ()
    materials: tuple[MaterialSpec, ...]
    parts: tuple[AnyPart, ...]
    joints: tuple[AnyJoint, ...]
    couplings: tuple[CouplingSpec, ...] = ()
    allow: tuple[Allow, ...] = ()
    assumptions: tuple[Text, ...] = Field((), description="What the request left open and how it was read, one sentence each")

    @classmethod
    def load(cls, path: str | Path) -> AssemblyPlan:
        """Read a plan from its file, or from the folder that holds `plan.json`.

        Raises:
            PlanError: With a finding for every fault of the form (E_SCHEMA, E_NAME, E_NONFINITE …) at its path.
            ReadError: If there is no such file.
        """
        return reading.load(cls, Path(path), PLAN_FILE)

    @classmethod
    def loads(cls, text: str | bytes) -> AssemblyPlan:
        """Read a plan from JSON text; NaN, Infinity and repeated keys are refused.

        Raises:
            PlanError: As for `load`.
        """
        return reading.loads(cls, text)

    @classmethod
    def from_json(cls, document: Any) -> AssemblyPlan:
        """Return the plan of a JSON document that is already in memory.

        Raises:
            PlanError: As for `load`.
        """
        return reading.from_json(cls, document)

    def to_json(self) -> dict[str, Any]:
        """Return the JSON document: default values left out, whole numbers without a decimal point."""
        return writing.to_json(self)

    def dumps(self) -> str:
        """Return the canonical text: two plans are equal exactly if their texts are."""
        return writing.dumps(self)

    def save(self, path: str | Path) -> Path:
        """Write the canonical text to a file, or to `plan.json` in an existing folder; the file is replaced atomically.

        Returns:
            The file written.
        """
        return writing.save(self, Path(path), PLAN_FILE)


__all__ = [
    "PLAN_FILE",
    "SCHEMA",
    "Allow",
    "AnyJoint",
    "AnyPart",
    "AssemblyPlan",
    "BallSpec",
    "BeltSpec",
    "ConnectorKind",
    "ConnectorSpec",
    "CouplingSpec",
    "CylindricalSpec",
    "DerivedJoint",
    "DerivedPart",
    "FitSpec",
    "FixedSpec",
    "FreeSpec",
    "GearSpec",
    "JointForm",
    "JointSpec",
    "KernelName",
    "LinearSpec",
    "MaterialSpec",
    "MirrorDerivation",
    "MirrorPlane",
    "Parameter",
    "PartSpec",
    "PatternDerivation",
    "PlanarSpec",
    "Pose",
    "RackSpec",
    "RevoluteSpec",
    "RigidDerivation",
    "ScrewCouplingSpec",
    "ScrewSpec",
    "SliderSpec",
    "UniversalSpec",
]
